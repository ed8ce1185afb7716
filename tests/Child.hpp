#pragma once
/** @file Child.hpp
 * A child process of a test. It starts with default signals, however the test
 * was started (nohup, the background of a shell), and ends: by itself, with the
 * test, or at a time limit. */
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

namespace CME212 {

class Child {
 public:
  static constexpr int time_limit = 120;  // [s]

  /** Start a command of the shell. Its standard input is empty. */
  explicit Child(const std::string& command, int limit = time_limit)
      : Child(
            command,
            [&command] {
              execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
              _exit(127);
            },
            limit) {}
  /** Start a copy of this process, which calls @a body and ends with 0. */
  Child(std::string name, const std::function<void()>& body,
        int limit = time_limit)
      : name_(std::move(name)), limit_(limit), end_(now() + limit) {
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error(name_ + ": can't be started");
    setpgid(pid_, 0);  // here and there: whoever comes first
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE})
      ::signal(signal, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    body();
    _exit(0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (!ended()) end_now();
  }

  /** Its number, also that of its process group. */
  pid_t pid() const { return pid_; }
  void signal(int number) {
    if (!ended()) kill(pid_, number);
  }

  /** Wait until @a holds(), which is asked again and again, or until the child
   * has ended.  @return does it hold?
   * Throws std::runtime_error at the time limit: then the child is killed. */
  bool until(const std::function<bool()>& holds) {
    while (!holds()) {
      if (ended()) return holds();
      if (now() >= end_) {
        end_now();
        throw std::runtime_error(name_ + ": ended after " +
                                 std::to_string(limit_) +
                                 " s, the time limit of a test");
      }
      usleep(1000);
    }
    return true;
  }
  /** Wait for its end.  @return as waitpid() gives it.  Throws as until() */
  int wait() {
    until([this] { return ended(); });
    return status_;
  }

 private:
  std::string name_;
  int limit_, status_ = 0;
  time_t end_;  // of now()
  pid_t pid_ = -1;
  bool ended_ = false;

  static time_t now() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec;
  }
  bool ended() {
    ended_ = ended_ || waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  /** With all that it started. */
  void end_now() {
    kill(-pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
    ended_ = true;
  }
};

}  // namespace CME212
