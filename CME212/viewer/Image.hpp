#pragma once
/** @file Image.hpp
 * Image: a picture in memory; PNG files; Video: a film from pictures.
 *
 * A file appears only when it is complete, see OutputFile. An error is a
 * std::runtime_error "FILE: reason". */
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace CME212 {

class OutputFile;

/** A picture: rows from the top, each pixel as red, green, blue in 0...255.
 * Invariant: rgb.size() == 3 width height */
struct Image {
  int width = 0, height = 0;  // [pixels]
  std::vector<std::uint8_t> rgb;

  Image() = default;
  /** A black picture. */
  Image(int w, int h)
      : width(w), height(h), rgb(3 * std::size_t(w) * std::size_t(h)) {}

  /** The three bytes of the pixel in column @a x, row @a y from the top. */
  const std::uint8_t* pixel(int x, int y) const {
    assert(0 <= x && x < width && 0 <= y && y < height);
    return rgb.data() + 3 * (std::size_t(y) * width + x);
  }
  std::uint8_t* pixel(int x, int y) {
    return const_cast<std::uint8_t*>(std::as_const(*this).pixel(x, y));
  }

  bool operator==(const Image&) const = default;
};

/** The formats of films, by the ending of a name. */
inline constexpr std::array<std::string_view, 2> film_endings = {".mp4",
                                                                 ".gif"};

/** Write @a image to the file @a path as PNG.
 * Throws std::runtime_error "path: reason"; then @a path is as it was. */
void write_png(const std::string& path, const Image& image);

/** A film: FILE.mp4, or in the format of another ending of film_endings. It is
 * encoded by the program ffmpeg.
 *
 * It appears by finish(); without that, the destructor leaves nothing behind.
 * One thread at a time. */
class Video {
 public:
  /** Begin the film @a path; it is an mp4 if its ending is not known.
   * @param width,height Size of all pictures [pixels]; a film has even sizes,
   *                     an odd last column or row is left out of it
   * @param rate         Pictures a second [1/s], usually 25 to 60
   * @pre width, height >= 2 and rate > 0
   * Throws std::runtime_error "path: reason" if it can't be written there, or
   * no ffmpeg is on the PATH. */
  Video(const std::string& path, int width, int height, double rate = 30);
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;
  ~Video();

  /** Add the next picture.  @pre not finished; it has the film's size
   * Throws std::runtime_error with ffmpeg's message if that gave up, or with
   * the reason for which it does not take the picture. */
  void add(const Image& image);

  /** Complete the film.
   * @post The file exists. An older one is replaced.
   * Throws std::runtime_error as add(), and if there is no picture. A second
   * call does nothing. */
  void finish();

  /** Number of pictures so far. */
  int frames() const { return frames_; }

 private:
  std::string path_;
  int width_, height_;
  std::unique_ptr<OutputFile> file_;  // null: finished
  int frames_ = 0;
  int child_ = -1;  // ffmpeg, while it runs
  int input_ = -1;  // our end of its input
  int said_ = -1;   // our end of its standard error

  void start_ffmpeg(double rate);
  void send_all(const std::vector<std::uint8_t>& bytes);
  void wait_for_ffmpeg();
  void close_input();
};

}  // namespace CME212
