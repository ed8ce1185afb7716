#pragma once
/** @file TestFolder.hpp
 * What tests of files and programs need: a folder of their own, what is in a
 * file, and what a program says. */
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

#include "tests/Child.hpp"
#include "tests/Says.hpp"

namespace CME212 {

/** All of a file; nothing if it can't be read. */
inline std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/** How to call the program @a name: that in the folder which the environment's
 * BUILD names, or else the one in @a folder, "build/". */
inline std::string program(const std::string& name, const char* folder) {
  const char* build = std::getenv("BUILD");
  return (build ? build + std::string("/") : folder) + name;
}

/** A new folder, gone with all that is in it when this goes. */
class TestFolder {
 public:
  /** Throws std::filesystem::filesystem_error. */
  TestFolder() {
    std::string name = std::filesystem::temp_directory_path() / "test_XXXXXX";
    if (!mkdtemp(name.data()))
      throw std::filesystem::filesystem_error(
          "can't make a folder", name,
          std::error_code(errno, std::generic_category()));
    path_ = name;
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }
  /** The path of a file in it. */
  std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }

  /** How a program ended, and what it wrote. */
  struct Result {
    int status;  ///< -1: not by itself
    std::string out, err;
  };
  /** Run a command of the shell; its words are in the files out and err here.
   * Throws std::runtime_error: Child::time_limit ended it. */
  Result run(const std::string& command) const {
    const int status =
        Child(command + " >" + *this / "out" + " 2>" + *this / "err").wait();
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            contents(*this / "out"), contents(*this / "err")};
  }

 private:
  std::filesystem::path path_;
};

/** An environment variable, changed for one test; null: not set. */
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Environment() { set(old_ ? old_->c_str() : nullptr); }

 private:
  const char* name_;
  std::optional<std::string> old_;
  void set(const char* value) const {
    value ? setenv(name_, value, 1) : unsetenv(name_);
  }
};

/** What @a command prints. */
inline std::string output_of(const std::string& command) {
  return TestFolder().run(command).out;
}
inline bool has_program(const std::string& name) {
  return !output_of("command -v " + name).empty();
}

}  // namespace CME212
