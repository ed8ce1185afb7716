/** @file runner.cpp
 * main() of a test program for the grader:  PROGRAM TASK IN OUT PAGE CRASHING
 * QUESTIONS REPLIES  Runs the functions of TASK that are linked in, then those
 * again that draw numbers, from a seed that the grader sends by IN once main()
 * has begun. It writes to the descriptor OUT how they ended, and what they
 * answer with the usual numbers and with those drawn: the submission, with
 * which a test shares its process, could change its verdict, but who can't
 * compute the answers can't forge them. Whether they are right is known to the
 * grader alone, who has those of the solution. PAGE is memory shared with the
 * grader; it keeps what was done last, also when the program crashes or is
 * ended. CRASHING are aspects that no test is to look at: see probes() in
 * check.hpp. QUESTIONS and REPLIES lead to law.cpp, or are -1.
 *
 * Compiled apart from the submission: its macros reach nothing here. */
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "../asked/law.hpp"

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
int out = -1, questions = -1, replies = -1;
kit::Draw* draw = nullptr;  // in the second run
bool draws = false;         // the present test has drawn a number
using Answers = std::map<std::string, std::string>;
Answers answers, usual;  // "tolerance\tnumber number ..."
unsigned long checks = 0;
unsigned crashing = 0;  // aspects that probes() has nobody look at
std::string test;       // the name of the present one
bool has_failed = false;
int misses = 0;

// Any text as one line of ASCII.
std::string plain(std::string_view text) {
  std::string s;
  for (char c : text.substr(0, longest))
    s += c == '\n' ? ' ' : c < ' ' || c > '~' ? '?' : c;
  return s;
}

void send(const std::string& line) {
  const std::string all = line + '\n';
  for (std::size_t at = 0; at < all.size();) {
    const ssize_t n = write(out, all.data() + at, all.size() - at);
    if (n <= 0) _exit(3);
    at += std::size_t(n);
  }
}

// The place of a text on the page: half of it each.
void keep(int place, const std::string& text) {
  if (!page || has_failed) return;
  char* const to = page + std::size_t(place) * page_size / 2;
  const std::size_t n = std::min(text.size(), page_size / 2 - 1);
  std::memcpy(to, text.data(), n);
  to[n] = '\0';
}

void send(const char* kind, const Answers& all) {
  for (const auto& [what, numbers] : all)
    send(kind + ('\t' + plain(what)) + '\t' + numbers);
}

// Only the first failure counts; it is sent at once, as the submission may
// catch what is thrown next, or crash where the test goes on.
void failed(const std::string& expected, const std::string& got) {
  if (has_failed) return;
  has_failed = true;
  send("failed\t" + plain(expected) + '\t' + plain(got));
  send("usual", usual);
}

/** Run a function: what fails with drawn numbers ends the program. */
void run(const Test& one) {
  keep(0, test = one.name);
  keep(1, "");
  try {
    one.run();
  } catch (const kit::Failure&) {  // no other: its trace says where it was
    failed("no exception", "one of the tests' own");  // if it is a forged one
  }
  if (has_failed && draw) _exit(1);
}

}  // namespace

namespace kit {
Registered::Registered(const char* id, const char* name, void (*run)()) {
  tests().push_back({id, name, run});
}
void did(std::string text) {
  if (draw) text += "; numbers are drawn anew, as the public ones had passed";
  keep(1, plain(text));
}
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
void miss(std::string expected, std::string got) {
  failed(expected, got);
  if (++misses == 10000) _exit(1);  // in a loop that has no end
}

double drawn(double usual, double least, double most) {
  draws = true;
  return draw ? (*draw)(least, most) : usual;
}
Reply told(const Question& question) {
  Reply reply;
  if (write(questions, &question, sizeof question) != sizeof question ||
      read(replies, &reply, sizeof reply) != sizeof reply)
    _exit(3);
  return reply;
}
void answer(const std::string& what, double number, double tolerance) {
  char text[40];
  auto put = [&text](double a) {
    return std::string(text, std::to_chars(text, text + sizeof text, a).ptr);
  };
  for (Answers* to : {&answers, draw ? nullptr : &usual}) {
    if (!to) continue;
    std::string& all = (*to)[what];
    all += all.empty() ? put(tolerance) + '\t' : " ";
    all += put(number);
  }
}
}  // namespace kit

int main(int count, char** arg) {
  if (count != 8) return 2;
  const std::string id = arg[1];
  crashing = unsigned(std::atoi(arg[5]));
  out = std::atoi(arg[3]);
  void* const map = mmap(nullptr, page_size, PROT_READ | PROT_WRITE, MAP_SHARED,
                         std::atoi(arg[4]), 0);
  if (map == MAP_FAILED) return 2;
  page = static_cast<char*>(map);
  if (write(out, "begun\n", 6) != 6) return 2;
  const int in = std::atoi(arg[2]);
  unsigned char word[kit::Draw::secret];
  questions = std::atoi(arg[6]), replies = std::atoi(arg[7]);
  if (read(in, word, sizeof word) != sizeof word) return 2;
  close(in);

  // By name, whatever the order in which files were linked. A "?" begins the
  // id of what is run with drawn numbers alone.
  std::size_t ran = 0;
  std::vector<Test> again;
  for (const Test& one : tests()) {
    if (one.id == '?' + id) again.push_back(one);
    if (one.id != id) continue;
    ++ran;
    draws = false;
    const auto before = answers;
    run(one);
    if (draws) again.push_back(one), answers = before;
  }
  send("usual", usual);
  if (has_failed) _exit(1);
  for (const Test& one : again) {
    kit::Draw of_test(word, one.name);
    draw = &of_test;
    run(one);
  }
  send("answer", answers);
  send("passed\t" + std::to_string(ran) + '\t' + std::to_string(checks));
  _exit(0);
}
