/** @file runner.cpp
 * main() of a test program for the grader:  PROGRAM TASK IN OUT PAGE CRASHING
 * Runs the functions of TASK that are linked in, and says on the descriptor OUT
 * how they ended: lines that begin with the word which the grader sends by IN
 * once main() has begun. PAGE is memory shared with the grader; it keeps what
 * was done last, also when the program crashes or is ended. CRASHING are
 * aspects that no test is to look at: see probes() in check.hpp.
 *
 * Compiled apart from the submission: its macros reach nothing here. */
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "check.hpp"

namespace {

struct Test {
  const char *id, *name;
  void (*run)();
};
// Built when first asked for, as tests register before main().
std::vector<Test>& tests() {
  static auto* all = new std::vector<Test>;
  return *all;
}

constexpr std::size_t page_size = 4096;
constexpr std::size_t longest = 2000;  // characters of a text

char* page = nullptr;  // "name aspect\0did\0"
int out = -1;
char word[65];
unsigned long checks = 0;
unsigned crashing = 0;  // aspects that probes() has nobody look at
std::string test;       // the name of the present one
bool has_failed = false;

// Any text as one line of ASCII.
std::string plain(std::string_view text) {
  std::string s;
  for (char c : text.substr(0, longest))
    s += c == '\n' ? ' ' : c < ' ' || c > '~' ? '?' : c;
  return s;
}

void send(const std::string& line) {
  const std::string all = std::string(word) + '\t' + line + '\n';
  for (std::size_t at = 0; at < all.size();) {
    const ssize_t n = write(out, all.data() + at, all.size() - at);
    if (n <= 0) _exit(3);
    at += std::size_t(n);
  }
}

// The place of a text on the page: half of it each.
void keep(int place, const std::string& text) {
  if (!page) return;
  char* const to = page + std::size_t(place) * page_size / 2;
  const std::size_t n = std::min(text.size(), page_size / 2 - 1);
  std::memcpy(to, text.data(), n);
  to[n] = '\0';
}

// Only the first failure counts; it is sent at once, as the submission may
// catch what is thrown next.
void failed(const std::string& expected, const std::string& got) {
  if (has_failed) return;
  has_failed = true;
  send("failed\t" + plain(expected) + '\t' + plain(got));
}

// How a function ended that threw something.
void say_what_was_thrown() {
  try {
    throw;
  } catch (const kit::Failure&) {
  } catch (const std::exception& e) {
    failed("no exception", std::string("one that says: ") + e.what());
  } catch (...) {
    failed("no exception", "one of an unusual type");
  }
}

}  // namespace

namespace kit {
Registered::Registered(const char* id, const char* name, void (*run)()) {
  tests().push_back({id, name, run});
}
void did(std::string text) { keep(1, plain(text)); }
void checked() { ++checks; }
bool probes(unsigned aspect) {
  if (aspect & crashing) return false;
  keep(0, test + (aspect ? ' ' + std::to_string(aspect) : std::string()));
  return true;
}
void fail(std::string expected, std::string got) {
  failed(expected, got);
  throw Failure{"", expected, got};
}
}  // namespace kit

int main(int count, char** arg) {
  if (count != 6) return 2;
  const std::string id = arg[1];
  crashing = unsigned(std::atoi(arg[5]));
  out = std::atoi(arg[3]);
  void* const map = mmap(nullptr, page_size, PROT_READ | PROT_WRITE, MAP_SHARED,
                         std::atoi(arg[4]), 0);
  if (map == MAP_FAILED) return 2;
  page = static_cast<char*>(map);
  if (write(out, "begun\n", 6) != 6) return 2;
  const int in = std::atoi(arg[2]);
  if (read(in, word, sizeof word - 1) != sizeof word - 1) return 2;
  close(in);

  // By name, whatever the order in which files were linked.
  std::vector<Test> mine;
  for (const Test& test : tests())
    if (id == test.id) mine.push_back(test);
  std::size_t ran = 0;
  for (const Test& one : mine) {
    keep(0, test = one.name);
    keep(1, "");
    try {
      one.run();
    } catch (...) {
      say_what_was_thrown();
    }
    if (has_failed) _exit(1);
    ++ran;
  }
  send("passed\t" + std::to_string(ran) + '\t' + std::to_string(checks));
  _exit(0);
}
