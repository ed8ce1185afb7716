#pragma once
/** @file Image.hpp
 * Image: a picture in memory; PNG files; Video: a film from pictures.
 *
 * All that is written is written whole or not at all, see OutputFile. An error
 * is a std::runtime_error "FILE: reason". */
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
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

/** Write @a image to the file @a path, as PNG.
 * Throws std::runtime_error "path: reason"; then @a path is as it was. */
void write_png(const std::string& path, const Image& image);

/** Read the PNG file @a path; what is transparent becomes black.
 * Throws std::runtime_error "path: reason". */
Image read_png(const std::string& path);

/** A film: FILE.mp4 if there is an ffmpeg on the PATH, otherwise a folder
 * FILE_frames/ of pictures frame_000000.png, frame_000001.png, ... If there is
 * such a folder already, it is left alone: the new one is FILE_frames-2/, and
 * so on.
 *
 * Nothing has its name before finish(); a Video destroyed without it leaves
 * nothing. One thread at a time. */
class Video {
 public:
  /** Begin the film @a path, which should end in .mp4.
   * @param width,height Size of all pictures [pixels]; an mp4 has even sizes,
   *                     an odd last column or row is left out of it
   * @param rate         Pictures a second [1/s], usually 25 to 60
   * @pre width, height >= 2 and rate > 0
   * Throws std::runtime_error "path: reason" if it can't be written there. */
  Video(const std::string& path, int width, int height, double rate = 30);
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;
  ~Video();

  /** Add the next picture.  @pre not finished; it has the film's size
   * Throws std::runtime_error with ffmpeg's message if that gave up, or with
   * the reason for which the picture can't be written. */
  void add(const Image& image);

  /** Complete the film.
   * @post What wrote() says is there. An older file is replaced.
   * Throws std::runtime_error as add(), and if there is no picture. A second
   * call does nothing. */
  void finish();

  /** What finish() made: the .mp4 file, or the folder with a slash at the end.
   * Before, it knows no folder: then it is empty. */
  std::string wrote() const;
  /** Number of pictures so far. */
  int frames() const { return frames_; }

 private:
  struct Close {
    void operator()(std::FILE* f) const;
  };

  std::string path_;
  int width_, height_;
  std::unique_ptr<OutputFile> file_;  // none: it becomes a folder
  std::string scratch_, folder_;      // that folder, before and after finish()
  int frames_ = 0;
  bool finished_ = false;
  int child_ = -1;                             // ffmpeg, while it runs
  int input_ = -1;                             // our end of its input
  std::unique_ptr<std::FILE, Close> message_;  // its standard error

  std::string folder() const;
  void make_folder();
  bool start_ffmpeg(double rate);
  void send_all(const std::vector<std::uint8_t>& bytes);
  void wait_for_ffmpeg();
  void close_input();
  void put_folder_in_place();
};

}  // namespace CME212
