#pragma once
/** @file OutputFile.hpp
 * OutputFile: a file that is written whole or not at all. */
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <signal.h>
#include <sys/select.h>
#include <sys/stat.h>
#include <unistd.h>

namespace CME212 {

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
 * then it is FILE.PID-K.part in the same folder. The destructor removes that;
 * only a program that is killed leaves it behind. If several writers write one
 * file, the last commit() wins.
 *
 * A replaced file keeps its permissions; a new one follows the umask. If the
 * name is a symbolic link, its target is replaced. Other hard links keep the
 * old content. A pipe or a device is written directly. */
class OutputFile {
 public:
  /** @param file  path to write
   * Throws std::runtime_error "FILE: why" if it can't be written there; also if
   * it has no name, is a folder, is read-only, or is the standard output or
   * error of this program. */
  explicit OutputFile(const std::string& file) : file_(file), part_(file) {
    if (file.empty()) throw std::runtime_error("an output file has no name");
    struct stat old = {};
    const bool exists = stat(file.c_str(), &old) == 0;
    if (!exists && errno != ENOENT) fail(std::strerror(errno));
    if (exists && S_ISDIR(old.st_mode)) fail("a directory");
    if (!exists || S_ISREG(old.st_mode)) {
      if (exists) check_may_be_replaced(old);
      target_ = output_target(file);
      make_part();
      if (exists) chmod(part_.c_str(), old.st_mode & 07777);
    }
    const int reader = S_ISFIFO(old.st_mode) ? await_reader() : -1;
    errno = 0;
    out_.open(part_, std::ios::binary);
    const int error = errno;
    if (reader >= 0) close(reader);
    if (!out_) remove_part(), fail(std::strerror(error));
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() { remove_part(); }

  /** Where to write. */
  std::ostream& stream() { return out_; }
  /** The path of the unfinished file, for another program that writes it. */
  const std::string& part() const { return part_; }

  /** Close the file and give it its name.
   * @param to_disk wait until it is on the disk, so it survives a power cut
   * Throws std::runtime_error "FILE: why" if anything could not be written; an
   * old file is then unchanged. */
  void commit(bool to_disk = false) {
    errno = 0;
    out_.close();
    if (!out_) fail(errno ? std::strerror(errno) : "not all was written");
    if (target_.empty()) return;
    if (to_disk) {
      const int part = open(part_.c_str(), O_WRONLY | O_CLOEXEC);
      const bool synced = part >= 0 && fsync(part) == 0;
      const int error = errno;
      if (part >= 0) close(part);
      if (!synced) fail(std::strerror(error));
    }
    if (std::rename(part_.c_str(), target_.c_str()) != 0)
      fail(std::strerror(errno));
    target_.clear();
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
  std::string target_;  // what commit() replaces; empty: nothing
  std::string part_;    // what is written
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

  /** Open the pipe as soon as a program reads it; a signal ends the wait. */
  int await_reader() const {
    constexpr timespec time = {0, 20'000'000};
    sigset_t all, before;
    sigfillset(&all);  // blocked but in pselect(): none comes unseen
    pthread_sigmask(SIG_BLOCK, &all, &before);
    int pipe = -1, wait = 0;
    while ((pipe = open(part_.c_str(), O_WRONLY | O_NONBLOCK)) < 0 &&
           errno == ENXIO && wait == 0)
      wait = pselect(0, nullptr, nullptr, nullptr, &time, &before);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (pipe < 0) fail("no program reads it");
    return pipe;
  }

  /** Make the part, of a name that no other writer has. */
  void make_part() {
    static std::atomic<unsigned> count = 0;
    const std::filesystem::path target(target_);
    const std::string stem = target.filename().string().substr(0, 200);
    for (int part = -1; part < 0;) {
      part_ = target.parent_path() / (stem + '.' + std::to_string(getpid()) +
                                      '-' + std::to_string(count++) + ".part");
      part = open(part_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
      if (part < 0 && errno != EEXIST) fail(std::strerror(errno));
      if (part >= 0) close(part);
    }
  }
  void remove_part() {
    out_.close();
    if (!target_.empty()) unlink(part_.c_str());
  }
};

/** Write a file whole or not at all.  Throws as OutputFile */
inline void write_file(const std::string& file, const std::string& text) {
  OutputFile out(file);
  out.stream() << text;
  out.commit();
}

}  // namespace CME212
