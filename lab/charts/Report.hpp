#pragma once
/** @file Report.hpp
 * What the programs that measure have in common: where their numbers come from,
 * the cells of a CSV file, progress, and lists of names as options. */
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <unistd.h>

#include "CME212/Util.hpp"

namespace lab {

namespace report {

/** The first line that a command prints; "unknown" if there is none. */
inline std::string first_line_of(const char* command) {
  std::string line;
  if (FILE* pipe = popen(command, "r")) {
    char text[256];
    if (std::fgets(text, sizeof text, pipe)) line = text;
    pclose(pipe);
  }
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())))
    line.pop_back();
  return line.empty() ? "unknown" : line;
}

inline std::string machine() {
  return first_line_of("sed -n 's/^model name.*: //p' /proc/cpuinfo") + ", " +
         std::to_string(std::thread::hardware_concurrency()) + " cores";
}

inline void write_head(std::ostream& out, const char* what) {
#ifdef __clang__
  const char* compiler = "clang " __clang_version__;
#else
  const char* compiler = "g++ " __VERSION__;
#endif
  out << "# " << what << "\n# machine: " << machine()
      << "\n# compiler: " << compiler
      << "\n# commit: "
      // the charts being measured are not what is measured
      << first_line_of(
             "c=$(git describe --always 2>/dev/null) && "
             "if git diff --quiet HEAD -- . ':!charts'; then echo \"$c\"; "
             "else echo \"$c-dirty\"; fi")
      << '\n';
}

/** @a text as a cell: no comma, quote or end of line in it. */
inline std::string cell(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '"' || c == '\n') c = ';';
  return text;
}
/** @a a as a cell; empty if it is no number. */
inline std::string cell(double a) {
  if (!std::isfinite(a)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", a);
  return text;
}

/** Tells how far the work is: a bar on a terminal, else a line per part. */
class Progress {
 public:
  explicit Progress(bool quiet) : on_(!quiet), bar_(isatty(STDERR_FILENO)) {}
  /** @param done of all, from 0 to 1 */
  void show(const std::string& part, double done) {
    if (!on_ || (!bar_ && part == part_)) return;
    part_ = part;
    std::string line = "[" + std::string(std::size_t(30 * done), '#') +
                       std::string(30 - std::size_t(30 * done), ' ') + "] ";
    std::cerr << (bar_ ? "\r" + line : "") << part;
    if (done > 0)
      std::cerr << ", " << std::ceil(clock_.seconds() * (1 / done - 1))
                << " s left";
    std::cerr << (bar_ ? "          " : "\n") << std::flush;
  }
  void end() {
    if (on_ && bar_) std::cerr << '\r' << std::string(78, ' ') << '\r';
  }

 private:
  bool on_, bar_;
  std::string part_;
  CME212::Clock clock_;
};

/** The ones of @a all that are named, in the order of @a all; all if none is.
 * Throws std::runtime_error for another name. */
template <typename All, typename NameOf>
auto pick(const std::vector<std::string>& names, const All& all,
          const char* option, NameOf name_of) {
  std::vector<std::decay_t<decltype(all[0])>> chosen;
  for (const auto& a : all)
    if (names.empty() ||
        std::find(names.begin(), names.end(), name_of(a)) != names.end())
      chosen.push_back(a);
  for (const std::string& name : names)
    if (std::none_of(chosen.begin(), chosen.end(),
                     [&](const auto& a) { return name_of(a) == name; })) {
      std::string what = option;
      what.append(": there is no '").append(name).append("'; there are:");
      for (const auto& a : all) what.append(" ").append(name_of(a));
      throw std::runtime_error(what);
    }
  return chosen;
}

}  // namespace report

}  // namespace lab
