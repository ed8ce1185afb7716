#pragma once
/** @file OutputFile.hpp
 * OutputFile: a file that is written whole or not at all. */
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace CME212 {

/** A file that appears under its name, whole, when commit() is called; until
 * then it grows beside it as FILE.part, and is gone if commit() never comes.
 * What is no regular file (a pipe, /dev/null) is written directly. */
class OutputFile {
 public:
  /** @param file  path to write
   * Throws std::runtime_error "FILE: why" if it can't be written there. */
  explicit OutputFile(const std::string& file) : file_(file), part_(file) {
    namespace fs = std::filesystem;
    std::error_code none;
    if (fs::is_directory(file, none)) fail("a directory");
    if (!fs::exists(file, none) || fs::is_regular_file(file, none)) {
      // Replace what a link points to, not the link.
      if (fs::exists(file, none)) file_ = fs::canonical(file).string();
      part_ = file_ + ".part";
    }
    errno = 0;
    out_.open(part_, std::ios::binary);
    if (!out_) fail(std::strerror(errno));
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    out_.close();
    std::error_code none;
    if (part_ != file_) std::filesystem::remove(part_, none);
  }

  /** Where to write. */
  std::ostream& stream() { return out_; }
  /** Path of the file that grows, for a library that opens it itself. */
  const std::string& part() const { return part_; }

  /** Close the file and give it its name.
   * Throws std::runtime_error "FILE: why" if anything could not be written,
   * and then what was there before is untouched. */
  void commit() {
    errno = 0;
    out_.close();
    if (!out_) fail(errno ? std::strerror(errno) : "not all was written");
    if (part_ == file_) return;
    std::error_code error;
    std::filesystem::rename(part_, file_, error);
    if (error) fail(error.message());
  }

 private:
  std::string file_, part_;
  std::ofstream out_;

  [[noreturn]] void fail(const std::string& why) {
    throw std::runtime_error(file_ + ": can't be written (" + why + ")");
  }
};

}  // namespace CME212
