/** @file Image.cpp
 * PNG files by libpng; films by the program ffmpeg. */
#include "CME212/viewer/Image.hpp"

#include <fcntl.h>
#include <png.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"

extern char** environ;

namespace CME212 {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw std::runtime_error(path + ": " + reason);
}
std::string reason(int error) { return std::system_category().message(error); }

#ifdef MSG_NOSIGNAL
constexpr int no_signal = MSG_NOSIGNAL;
#else
constexpr int no_signal = 0;
#endif

}  // namespace

void write_png(const std::string& path, const Image& image) {
  OutputFile file(path);
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
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

// ---------------------------------------------------------------------- Video

Video::Video(const std::string& path, int width, int height, double rate)
    : path_(path),
      width_(width),
      height_(height),
      file_(std::make_unique<OutputFile>(path)) {
  assert(width >= 2 && height >= 2 && rate > 0);
  start_ffmpeg(rate);
}

Video::~Video() {
  close_input();
  if (said_ >= 0) close(said_);
  if (child_ >= 0) {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
}

void Video::add(const Image& image) {
  assert(file_ && image.width == width_ && image.height == height_);
  send_all(image.rgb);
  ++frames_;
}

void Video::finish() {
  if (!file_) return;
  if (frames_ == 0) fail(path_, "a film of no pictures");
  wait_for_ffmpeg();
  file_->commit();
  file_.reset();
}

/** Throws std::runtime_error if there is none. */
void Video::start_ffmpeg(double rate) {
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
  if (ending_of(path_) == ".gif")
    add({"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"});
  else
    add({"-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p",
         "-c:v", "libx264", "-preset", "veryfast", "-crf", "21", "-movflags",
         "+faststart", "-f", "mp4"});
  add({to.c_str(), nullptr});

  // A socket, not a pipe: once ffmpeg is gone, send() returns an error where
  // write() would raise a signal. Its messages go through a pipe, not a file,
  // as the disk may be full; what does not fit into the pipe is lost.
  int ends[2], said[2];
  if (pipe(said) || socketpair(AF_UNIX, SOCK_STREAM, 0, ends))
    fail(path_, reason(errno));
  for (int end : {ends[0], ends[1], said[0], said[1]})
    fcntl(end, F_SETFD, FD_CLOEXEC);
  for (int end : said) fcntl(end, F_SETFL, O_NONBLOCK);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, said[1], 2);
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
#ifdef SO_NOSIGPIPE  // on macOS it is an option of the socket
  const int on = 1;
  setsockopt(input_, SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on);
#endif
  if (error == 0) return;
  close_input(), close(said_);  // as there is no destructor of this
  fail(path_, error == ENOENT ? "no film without ffmpeg, which `make deps` "
                                "installs"
                              : "ffmpeg does not start: " + reason(error));
}

void Video::send_all(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    ssize_t n = send(input_, bytes.data() + at, bytes.size() - at, no_signal);
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

}  // namespace CME212
