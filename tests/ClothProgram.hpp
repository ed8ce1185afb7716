#pragma once
/** @file ClothProgram.hpp
 * What tests of ./cloth need: to run it, and to look at what it left. */
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
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

  /** Run it. Words of @a arguments: as in a shell. */
  Result run(const std::string& arguments) {
    return folder.run(CME212::program("cloth", "build/") + " " + arguments);
  }
  /** Start it; what it says goes where run() has it. */
  pid_t start(const std::string& arguments) {
    const std::string command = "exec " + CME212::program("cloth", "build/") +
                                ' ' + arguments + " >" + folder / "out" +
                                " 2>" + folder / "err";
    const pid_t child = fork();
    if (child == 0) {
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    return child;
  }
  /** Of a program that ended with @a status, as waitpid() gives it. */
  Result result_of(int status) {
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status),
            contents(dir / "out"), contents(dir / "err")};
  }
  /** Start it, and send it @a signals: the first when it catches it and has run
   * for a while, the next ones 0.2 s later each.
   * @return as run(); its status is 1000 + a signal that ended it at once */
  Result interrupt(const std::string& arguments, std::vector<int> signals) {
    const pid_t child = start(arguments);
    int status = 0;
    bool ended = false;
    while (!ended && !catches(child, signals[0])) {
      usleep(1000);
      ended = waitpid(child, &status, WNOHANG) == child;
    }
    usleep(50000);
    for (int signal : signals) {
      kill(child, signal);
      if (signals.size() > 1) usleep(200000);
    }
    if (!ended) waitpid(child, &status, 0);
    return result_of(status);
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
  /** Start it, and kill it after so many microseconds; as interrupt(). */
  Result kill_after(unsigned wait, const std::string& arguments) {
    const pid_t child = start(arguments);
    usleep(wait);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return result_of(status);
  }
  /** Does a process catch a signal now? */
  static bool catches(pid_t process, int signal) {
    const std::string status =
        contents("/proc/" + std::to_string(process) + "/status");
    const auto at = status.find("SigCgt:");
    return at != std::string::npos &&
           (std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1)) %
               2;
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
