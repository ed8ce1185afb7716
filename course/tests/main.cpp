/** @file main.cpp
 * Runs the tests that are linked with it:
 *
 *   ./tests            all tasks, each in a process of its own: a crash or an
 *                      endless loop costs its own task only
 *   ./tests 3.1.position         this task
 *   ./tests 3.1.position here    in this process: for a debugger
 *
 * As the grader does, it looks away from an aspect (model.hpp) whose look
 * crashed: what earlier sections left broken costs no task of a later one.
 * A failure prints the task, the sentence of the specification that does not
 * hold, what was done, and what was expected. */
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>

#include "check.hpp"

namespace kit {
namespace {

struct Task {
  std::string id, title;
  int points;
  std::string says;
};
/** The tasks in the order of the course. */
std::vector<Task> tasks() {
  return {
#if __has_include("tasks.inc")
#define X(id, title, points, says) {id, title, points, says},
#include "tasks.inc"
#undef X
#endif
  };
}

struct Test {
  std::string id, name;
  void (*run)();
};
std::vector<Test>& tests() {
  static std::vector<Test> all;  // made when the first test registers
  return all;
}

// Exit codes of a child; no sanitizer and no exit() by accident has them.
const int has_passed = 90, has_failed = 91;
const unsigned seconds = 20;  // for a task; all of ours take less than 1

/** Read by the parent after a crash. */
struct Last {
  char did[400];    // the last DID()
  unsigned aspect;  // that is looked at, or 0
};
Last& last() {
  static void* const shared =
      mmap(nullptr, sizeof(Last), PROT_READ | PROT_WRITE,
           MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return *static_cast<Last*>(shared);
}
unsigned crashing = 0;  // aspects that no test looks at
int checks = 0;

/** The section of a task: "7.1" of "7.1.remove_node". */
std::string section(const std::string& id) {
  return id.substr(0, id.rfind('.'));
}

std::string heading(const Task& task, bool passed) {
  std::string points;
  if (task.points > 0)
    points = words("  ", passed ? task.points : 0, '/', task.points);
  return words(section(task.id), ' ', task.title, ": ",
               passed ? "passed" : "FAILED", points, '\n');
}

/** The sentence that does not hold, and what was done. */
void explain(const Task& task) {
  if (!task.says.empty())
    std::cout << "  Specification: \"" << task.says << "\"\n";
  if (*last().did) std::cout << "  Did: " << last().did << ".\n";
}

/** Run all tests of a task and say how they went.  @return true if well */
bool run(const Task& task) {
  std::string wrong;
  checks = 0;
  for (const Test& test : tests()) {
    if (test.id != task.id || !wrong.empty()) continue;
    did("");
    try {
      test.run();
    } catch (const Failure& f) {
      wrong = f.got.empty()
                  ? words("  Expected: ", f.expected, ".\n")
                  : words("  Expected ", f.expected, ", got ", f.got, ".\n");
    } catch (const std::exception& e) {
      wrong = words("  Expected no exception, got: ", e.what(), ".\n");
    } catch (...) {
      wrong = "  Expected no exception, got one.\n";
    }
  }
  if (wrong.empty() && checks == 0) wrong = "  Nothing was checked.\n";
  std::cout << heading(task, wrong.empty());
  if (wrong.empty()) return true;
  explain(task);
  std::cout << wrong;
  return false;
}

/** All that was written to @a file. */
std::string content(std::FILE* file) {
  std::string all;
  std::rewind(file);
  for (int c; (c = std::fgetc(file)) != EOF;) all += char(c);
  return all;
}

/** The lines of @a text, without those that came before: what a test looks away
 * from may fail at each look. */
std::string each_once(const std::string& text) {
  std::set<std::string> seen;
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);)
    if (seen.insert(line).second) all += line + '\n';
  return all;
}

/** " at FILE:LINE" of the first line in @a trace that is in this folder, where
 * the student's own files are, or nothing. */
std::string own_line(const std::string& trace) {
  const std::regex place(R"(([^\s:]+):(\d+)(:\d+)?(?=\s|: ))");
  namespace fs = std::filesystem;
  for (std::sregex_iterator it(trace.begin(), trace.end(), place), end;
       it != end; ++it)
    if (fs::path file = fs::path((*it)[1].str()).lexically_normal();
        fs::exists(file) &&
        fs::absolute(file).parent_path() == fs::current_path())
      return words(" at ", file.filename().string(), ':', (*it)[2].str());
  return "";
}

/** The same in a child. */
bool run_apart(const Task& task) {
  std::cout.flush();
  last().aspect = 0;
  std::FILE* const errors = std::tmpfile();
  pid_t child = fork();
  if (child == 0) {
    if (errors) dup2(fileno(errors), STDERR_FILENO);
    alarm(seconds);
    bool well = run(task);
    std::cout.flush();
    _exit(well ? has_passed : has_failed);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0) {
    std::cout << "can't start a process\n";
    return false;
  }
  std::string said = errors ? content(errors) : "";
  if (errors) std::fclose(errors);
  const int exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (exit != has_passed && exit != has_failed && last().aspect & ~crashing) {
    crashing |= last().aspect;
    return run_apart(task);
  }
  if (exit == has_passed) said = each_once(said);
  std::cerr << said;
  if (exit == has_passed || exit == has_failed) return exit == has_passed;
  std::cout << heading(task, false);
  explain(task);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    std::cout << "  It did not end within " << seconds << " s.\n";
  else
    std::cout << "  It crashed" << own_line(said)
              << "; the lines above say more. For a debugger, run it with the "
              << "arguments " << task.id << " here.\n";
  return false;
}

}  // namespace

Registered::Registered(const char* id, const char* name, void (*test)()) {
  tests().push_back({id, name, test});
}
void did(std::string what) {
  std::strncpy(last().did, what.c_str(), sizeof last().did - 1);
}
void fail(std::string expected, std::string got) {
  throw Failure{last().did, std::move(expected), std::move(got)};
}
void miss(std::string expected, std::string got) { fail(expected, got); }
void checked() { ++checks; }
double drawn(double usual, double, double) { return usual; }
void answer(const std::string&, double, double) {}
bool probes(unsigned aspect) {
  if (aspect & crashing) return false;
  last().aspect = aspect;
  return true;
}

}  // namespace kit

// Sanitizers name the line of an assertion that fails, too.
extern "C" const char* __asan_default_options() { return "handle_abort=1"; }
extern "C" const char* __ubsan_default_options() {
  return "print_stacktrace=1";
}

int main(int argc, char** argv) {
  using namespace kit;
  auto all = tasks();
  auto known = [&all](const std::string& id) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Task& task) { return task.id == id; });
  };
  for (const Test& test : tests())
    if (!known(test.id)) all.push_back({test.id, test.id, 0, ""});
  auto tested = [](const Task& task) {
    return std::any_of(tests().begin(), tests().end(),
                       [&](const Test& test) { return test.id == task.id; });
  };
  int ran = 0, failed = 0;
  for (const Task& task : all) {
    if (!tested(task) || (argc > 1 && task.id != argv[1])) continue;
    ++ran;
    crashing = 0;
    failed += !(argc > 2 ? run(task) : run_apart(task));
  }
  if (ran == 0) {
    std::cout << "no test of " << (argc > 1 ? argv[1] : "any task")
              << " is linked with this program\n";
    return 2;
  }
  return failed == 0 ? 0 : 1;
}
