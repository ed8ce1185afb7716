#pragma once
/** @file OutputFile.hpp
 * OutputFile: a file that is written whole or not at all. */
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace CME212 {

/** Open /dev/null on those of the standard descriptors that are closed; else
 * the next file opened would get what is printed. It is opened for reading, so
 * writing to it remains an error.  @return true */
inline bool hold_standard_descriptors() {
  for (int d : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(d, F_GETFD) < 0) open("/dev/null", O_RDONLY);  // the lowest free
  return true;
}
/** Runs before main() in each program that has an OutputFile. */
inline const bool standard_descriptors_held = hold_standard_descriptors();

/** The path that @a file leads to by symbolic links, whether or not there is a
 * file. Hard links have different targets.
 * Throws std::runtime_error: links in a circle. */
inline std::string output_target(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code none;
  fs::path path(file);
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, none)); ++links) {
    if (links == 40)
      throw std::runtime_error(file + ": can't be written (" +
                               std::strerror(ELOOP) + ")");
    path = path.parent_path() / fs::read_symlink(path, none);
  }
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, none), none);
  return (whole.empty() ? path : whole).string();
}

/** A file that appears under its name when it is complete, by commit(). Until
 * then it has no name, in the same folder, so a program that stops early leaves
 * nothing behind. (If the file system can't do that, its name is
 * NAME.PID-K.part; only SIGKILL leaves that behind.) If several writers write
 * one file, the last commit() wins.
 *
 * A replaced file keeps its permissions and, if the system allows, its owner; a
 * new file follows the umask. If the name is a symbolic link, its target is
 * replaced. Other hard links keep the old content.
 *
 * What is not a regular file (a pipe, /dev/null) is written directly. */
class OutputFile {
 public:
  enum class Scratch { unnamed, named };

  /** @param file  path to write   @param scratch named: see above
   * Throws std::runtime_error "FILE: why" if it can't be written there; also if
   * it has no name, is a folder, is read-only, or is the standard output or
   * error of this program. */
  explicit OutputFile(const std::string& file,
                      Scratch scratch = Scratch::unnamed)
      : file_(file) {
    if (file.empty()) throw std::runtime_error("an output file has no name");
    struct stat old = {};
    const bool exists = stat(file.c_str(), &old) == 0;
    if (!exists && errno != ENOENT) fail(std::strerror(errno));
    if (exists && S_ISDIR(old.st_mode)) fail("a directory");
    if (exists && !S_ISREG(old.st_mode)) {
      part_ = file;
    } else {
      if (exists) check_may_be_replaced(old);
      target_ = output_target(file);
      if (scratch == Scratch::named || !open_unnamed()) open_named();
      if (exists) look_like(old);
    }
    errno = 0;
    out_.open(part_, std::ios::binary);
    if (!out_) fail(std::strerror(errno));
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    out_.close();
    if (!name_.empty()) unlink(name_.c_str());
    if (scratch_ >= 0) close(scratch_);
  }

  /** Where to write. */
  std::ostream& stream() { return out_; }
  /** The path of the unfinished file, for another program that writes it. That
   * program must inherit descriptor(), if there is one. */
  const std::string& part() const { return part_; }
  std::optional<int> descriptor() const {
    return scratch_ < 0 ? std::nullopt : std::optional(scratch_);
  }

  /** Close the file and give it its name.
   * @param to_disk wait until it is on the disk, so it survives a power cut
   * Throws std::runtime_error "FILE: why" if anything could not be written; an
   * old file is then unchanged. */
  void commit(bool to_disk = false) {
    errno = 0;
    out_.close();
    if (!out_) fail(errno ? std::strerror(errno) : "not all was written");
    if (target_.empty()) return;
    if (to_disk && fsync(scratch_) != 0) fail(std::strerror(errno));
    if (name_.empty())
      take_name([this](const char* name) {
        return linkat(AT_FDCWD, part_.c_str(), AT_FDCWD, name,
                      AT_SYMLINK_FOLLOW) == 0;
      });
    if (std::rename(name_.c_str(), target_.c_str()) != 0)
      fail(std::strerror(errno));
    name_.clear();
  }

  /** Put a copy of what was written so far in place, and go on.
   * Throws as commit().  O(bytes so far) */
  void commit_copy() {
    out_.flush();
    if (target_.empty() || out_.tellp() == std::streampos(0)) return;
    OutputFile copy(file_);
    copy.out_ << std::ifstream(part_, std::ios::binary).rdbuf();
    if (!out_) copy.out_.setstate(std::ios::failbit);
    copy.commit();
  }

 private:
  std::string file_;    // as it was given
  std::string target_;  // what is replaced; empty: file_ is written directly
  std::string name_;    // of the scratch file, while it has one
  std::string part_;    // how it is opened
  int scratch_ = -1;    // a descriptor of it
  std::ofstream out_;

  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(file_ + ": can't be written (" + why + ")");
  }

  void check_may_be_replaced(const struct stat& old) const {
    // Root may write everything, but a read-only file was meant to stay.
    if ((old.st_mode & 0222) == 0 || access(file_.c_str(), W_OK) != 0)
      fail(std::strerror(EACCES));
    for (int own : {STDOUT_FILENO, STDERR_FILENO}) {
      struct stat used = {};
      if (fstat(own, &used) == 0 && used.st_dev == old.st_dev &&
          used.st_ino == old.st_ino)
        fail(own == STDOUT_FILENO ? "the standard output goes there"
                                  : "the standard error goes there");
    }
  }

  bool open_unnamed() {
#ifdef O_TMPFILE
    const std::string folder =
        std::filesystem::path(target_).parent_path().string();
    scratch_ = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (scratch_ < 0) return false;
    part_ = "/proc/self/fd/" + std::to_string(scratch_);
    if (access(part_.c_str(), W_OK) == 0) return true;
    close(scratch_);
#endif
    return false;
  }

  void open_named() {
    take_name([this](const char* name) {
      scratch_ = open(name, O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
      return scratch_ >= 0;
    });
    part_ = name_;
  }

  /** Set name_ to one beside the target with which @a make succeeds: it fails
   * with EEXIST if something has that name. */
  template <typename Make>
  void take_name(Make make) {
    static std::atomic<unsigned> count = 0;
    const std::filesystem::path target(target_);
    const std::string stem = target.filename().string().substr(0, 200);
    for (;;) {
      const std::string name =
          target.parent_path() / (stem + '.' + std::to_string(getpid()) + '-' +
                                  std::to_string(count++) + ".part");
      if (make(name.c_str())) {
        name_ = name;
        return;
      }
      if (errno != EEXIST) fail(std::strerror(errno));
    }
  }

  /** Give the scratch file the owner and the permissions of the old one. */
  void look_like(const struct stat& old) const {
    struct stat now = {};
    if (fstat(scratch_, &now) != 0) fail(std::strerror(errno));
    if ((now.st_uid != old.st_uid || now.st_gid != old.st_gid) &&
        fchown(scratch_, old.st_uid, old.st_gid) != 0 &&
        fchown(scratch_, uid_t(-1), old.st_gid) != 0) {
      // Then it stays ours.
    }
    if (fchmod(scratch_, old.st_mode & 07777) != 0) fail(std::strerror(errno));
  }
};

}  // namespace CME212
