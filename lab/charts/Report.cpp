#include "lab/charts/Report.hpp"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <thread>

#include "lab/fast/Lanes.hpp"

namespace lab::report {

namespace {

/** The first line that a command prints; "unknown" if there is none. */
std::string first_line_of(const char* command) {
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

}  // namespace

std::string machine() {
  return first_line_of(
             "awk -F': ' '/^model name/ {n = $2} /^cpu family/ {f = $2} "
             "/^$/ {print n \" (family \" f; exit}' /proc/cpuinfo") +
         ", " + lanes::name_of(lanes::best_cpu()) + "), " +
         std::to_string(std::thread::hardware_concurrency()) + " cores";
}

void write_head(std::ostream& out, const char* what) {
#ifdef __clang__
  const char* compiler = "clang " __clang_version__;
#else
  const char* compiler = "g++ " __VERSION__;
#endif
  out << "# " << what << "\n# machine: " << machine()
      << "\n# compiler: " << compiler << "\n# commit: "
      << first_line_of(
             "c=$(git describe --always 2>/dev/null) && "
             "if git diff --quiet HEAD -- . ':!*/results/*'; then echo \"$c\"; "
             "else echo \"after $c\"; fi")
      << '\n';
}

std::string cell(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '"' || c == '\n') c = ';';
  return text;
}

std::string cell(double a) {
  if (!std::isfinite(a)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", a);
  return text;
}

}  // namespace lab::report
