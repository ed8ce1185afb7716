/** @file Image.cpp
 * PNG files by libpng; films by the program ffmpeg. */
#include "CME212/viewer/Image.hpp"

#include <fcntl.h>
#include <png.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "CME212/OutputFile.hpp"

extern char** environ;

namespace CME212 {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw std::runtime_error(path + ": " + reason);
}
std::string reason(int error) { return std::system_category().message(error); }

/** libpng's description of an RGB picture; frees what libpng allocated. */
struct Png : png_image {
  Png() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~Png() { png_image_free(this); }
  Png(const Png&) = delete;
  Png& operator=(const Png&) = delete;
};

}  // namespace

void write_png(const std::string& path, const Image& image) {
  OutputFile file(path);
  Png png;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<char> bytes(size);
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(),
                                 0, nullptr))
    fail(path, png.message);
  file.stream().write(bytes.data(), std::streamsize(size));
  file.commit();
}

Image read_png(const std::string& path) {
  Png png;
  if (!png_image_begin_read_from_file(&png, path.c_str()))
    fail(path, png.message);
  png.format = PNG_FORMAT_RGB;
  Image image(int(png.width), int(png.height));
  const png_color black{};
  if (!png_image_finish_read(&png, &black, image.rgb.data(), 0, nullptr))
    fail(path, png.message);
  return image;
}

// ---------------------------------------------------------------------- Video

Video::Video(const std::string& path, int width, int height, double rate)
    : path_(path), width_(width), height_(height) {
  assert(width >= 2 && height >= 2 && rate > 0);
  file_ = std::make_unique<OutputFile>(path);
  if (start_ffmpeg(rate)) return;
  file_.reset();
  make_folder();
}

Video::~Video() {
  close_input();
  if (said_ >= 0) close(said_);
  if (child_ >= 0) {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  std::error_code ignored;
  if (!scratch_.empty()) std::filesystem::remove_all(scratch_, ignored);
}

void Video::add(const Image& image) {
  assert(!finished_ && image.width == width_ && image.height == height_);
  if (file_) {
    send_all(image.rgb);
  } else {
    char name[32];
    std::snprintf(name, sizeof name, "/frame_%06d.png", frames_);
    write_png(scratch_ + name, image);
  }
  ++frames_;
}

void Video::finish() {
  if (finished_) return;
  if (frames_ == 0) fail(path_, "a film of no pictures");
  if (file_) {
    wait_for_ffmpeg();
    file_->commit();
  } else {
    put_folder_in_place();
  }
  finished_ = true;
}

std::string Video::wrote() const {
  return file_ ? path_ : finished_ ? folder_ + '/' : "";
}

/** The folder of a film without ffmpeg; a number may follow. */
std::string Video::folder() const {
  std::filesystem::path stem(path_);
  return stem.replace_extension().string() + "_frames";
}

/** Make a folder for the pictures, under a temporary name. */
void Video::make_folder() {
  for (int k = 0; scratch_.empty(); ++k) {
    const std::string name = folder() + '.' + std::to_string(getpid()) + '-' +
                             std::to_string(k) + ".part";
    if (mkdir(name.c_str(), 0777) == 0)
      scratch_ = name;
    else if (errno != EEXIST)
      fail(folder(), reason(errno));
  }
}

/** Start ffmpeg.  @return false if there is none. */
bool Video::start_ffmpeg(double rate) {
  const std::string size =
      std::to_string(width_) + "x" + std::to_string(height_);
  const std::string fps = std::to_string(rate);
  const std::string to = "file:" + file_->part();  // a ":" in it is no URL
  std::vector<const char*> args{"ffmpeg", "-loglevel", "error", "-y",
                                // the input
                                "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
                                size.c_str(), "-r", fps.c_str(), "-i",
                                "pipe:0"};
  // the output: plays everywhere, without visible loss
  auto add = [&args](std::initializer_list<const char*> more) {
    args.insert(args.end(), more);
  };
  const std::string ending = ending_of(path_);
  if (ending == ".gif")
    add({"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"});
  else
    add({"-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p"});
  if (ending == ".webm")
    add({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-cpu-used", "4",
         "-f", "webm"});
  else if (ending == ".mkv")
    add({"-c:v", "libx264", "-preset", "veryfast", "-crf", "21", "-f",
         "matroska"});
  else if (ending != ".gif")
    add({"-c:v", "libx264", "-preset", "veryfast", "-crf", "21", "-movflags",
         "+faststart", "-f", "mp4"});
  add({to.c_str(), nullptr});

  // A socket, not a pipe: once ffmpeg is gone, send() returns an error where
  // write() would raise a signal. Its messages go through a pipe, not a file,
  // as the disk may be full; what does not fit into the pipe is lost.
  int ends[2], said[2];
  if (pipe2(said, O_CLOEXEC | O_NONBLOCK) ||
      socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends))
    fail(path_, reason(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, said[1], 2);
  if (const auto film = file_->descriptor())  // so that it is inherited
    posix_spawn_file_actions_adddup2(&actions, *film, *film);
  // Ctrl-C at a terminal must only reach this program, which ends the film.
  posix_spawnattr_t own_group;
  posix_spawnattr_init(&own_group);
  posix_spawnattr_setflags(&own_group, POSIX_SPAWN_SETPGROUP);
  int error = posix_spawnp(&child_, args[0], &actions, &own_group,
                           const_cast<char* const*>(args.data()), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&own_group);
  close(ends[1]), close(said[1]);
  input_ = ends[0], said_ = said[0];
  if (error == 0) return true;
  child_ = -1;
  close_input();
  return false;
}

void Video::send_all(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    ssize_t n =
        send(input_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (n >= 0) {
      at += std::size_t(n);
    } else if (errno != EINTR) {
      int error = errno;
      wait_for_ffmpeg();  // throws, if ffmpeg says why
      fail(path_, reason(error));
    }
  }
}

void Video::wait_for_ffmpeg() {
  close_input();
  if (child_ < 0) fail(path_, "ffmpeg failed before");
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  // On a full disk its exit status may be 0: only its message tells.
  std::string said(500, '\0');
  said.resize(
      std::size_t(std::max<ssize_t>(0, read(said_, said.data(), said.size()))));
  if (said.empty() && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  // The first line is the cause.
  fail(path_, "ffmpeg failed: " + said.substr(0, said.find('\n')));
}

void Video::close_input() {
  if (input_ >= 0) close(input_);
  input_ = -1;
}

/** Rename the folder to FILE_frames, or, if that exists and is not an empty
 * folder, to FILE_frames-2, or the next name that is free. */
void Video::put_folder_in_place() {
  folder_ = folder();
  for (int k = 2; std::rename(scratch_.c_str(), folder_.c_str()) != 0; ++k) {
    if (errno != ENOTEMPTY && errno != EEXIST && errno != ENOTDIR)
      fail(folder_, reason(errno));
    folder_ = folder() + '-' + std::to_string(k);
  }
  scratch_.clear();
}

}  // namespace CME212
