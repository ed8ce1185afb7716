#pragma once
/** @file ClothProgram.hpp
 * What tests of ./cloth need: to run it, and to look at what it left. */
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/TestFolder.hpp"

namespace fs = std::filesystem;
using CME212::contents;
using Result = CME212::TestFolder::Result;

class ClothProgram : public ::testing::Test {
 protected:
  const CME212::TestFolder folder;
  const fs::path& dir = folder.path();

  /** Run it. Words of @a arguments: as in a shell. Its lines are joined(). */
  Result run(const std::string& arguments) {
    const Result r =
        folder.run(CME212::program("cloth", "build/") + " " + arguments);
    return {r.status, joined(r.out), joined(r.err)};
  }
  /** run() that ends with status 0. */
  Result success(const std::string& arguments) {
    const Result r = run(arguments);
    EXPECT_EQ(r.status, 0) << arguments << '\n' << r.err;
    return r;
  }
  /** The words with which it refuses @a arguments. */
  std::string refusal(const std::string& arguments) {
    const Result r = run(arguments);
    EXPECT_EQ(r.status, 2) << arguments;
    EXPECT_EQ(r.out, "") << arguments;
    return r.err;
  }
  /** Start it, after commands @a before; what it says goes where run() has it.
   */
  CME212::Child start(const std::string& arguments,
                      const std::string& before = "") {
    return CME212::Child(before + "exec " + CME212::program("cloth", "build/") +
                         ' ' + arguments + " >" + folder / "out" + " 2>" +
                         folder / "err");
  }
  /** The result of a program that ended with @a status of waitpid(). */
  Result result_of(int status) {
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status),
            joined(contents(dir / "out")), joined(contents(dir / "err"))};
  }
  /** Start it as start(), and send it @a signals: the first as soon as @a ready
   * holds, or else when it catches it; the next ones when it has caught the one
   * before and waits.
   * @return as run(); its status is 1000 + a signal that ended it at once */
  Result interrupt(const std::string& arguments,
                   const std::vector<int>& signals,
                   const std::function<bool()>& ready = nullptr,
                   const std::string& before = "") {
    CME212::Child child = start(arguments, before);
    child.until([&] { return ready ? ready() : catches(child, signals[0]); });
    for (int signal : signals) {
      const bool caught = catches(child, signal);
      child.signal(signal);
      if (!caught) continue;
      child.until([&] { return !catches(child, signal); });
      child.until([&] { return waits(child); });
    }
    return result_of(child.wait());
  }
  /** A file of this test with a content. */
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(dir / name, std::ios::binary) << text;
    return (dir / name).string();
  }
  std::string path(const std::string& name) { return folder / name; }
  /** What lies in the folder besides what run() put there. */
  std::vector<std::string> files() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(dir)) {
      std::string name = entry.path().filename();
      if (name != "out" && name != "err") names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  /** The system's entry @a key of a process, such as "SigCgt:"; a blank if it
   * has ended. */
  static std::string state(const CME212::Child& process,
                           const std::string& key) {
    const std::string all =
        contents("/proc/" + std::to_string(process.pid()) + "/status");
    const auto at = all.find(key);
    return at == all.npos ? " " : all.substr(at + key.size() + 1);
  }
  /** Does it wait for something, as a pipe that is full? */
  static bool waits(const CME212::Child& process) {
    return state(process, "State:")[0] == 'S';
  }
  /** Does a process catch a signal now? */
  static bool catches(const CME212::Child& process, int signal) {
    return std::strtoull(state(process, "SigCgt:").c_str(), nullptr, 16) >>
               (signal - 1) &
           1;
  }
  /** The numbers of a CSV file, without its head line. */
  static std::vector<std::vector<double>> rows(const fs::path& csv) {
    std::istringstream in(contents(csv));
    std::vector<std::vector<double>> all;
    std::string line, cell;
    std::getline(in, line);
    while (std::getline(in, line)) {
      auto& row = all.emplace_back();
      std::istringstream cells(line);
      while (std::getline(cells, cell, ',')) row.push_back(std::stod(cell));
    }
    return all;
  }
};

inline const std::vector<std::string> stages = {
    "problem1", "diagonals", "forces", "constraints", "tear"};
inline std::string stage(const std::string& name) {
  return "--config data/scenes/" + name + ".toml ";
}
inline const std::string grid0 = "data/grid0.nodes data/grid0.tets ";
inline const std::string grid3 = "data/grid3.nodes data/grid3.tets ";
