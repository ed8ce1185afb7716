/** @file test_child.cpp
 * Tests of Child: how a child process of a test starts, and that it ends. */
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "tests/TestFolder.hpp"

namespace {

using CME212::Child;
using CME212::contents;

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE};

TEST(AChild, StartsWithDefaultSignals) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  sighandler_t handlers[5];
  for (int k = 0; k < 5; ++k) handlers[k] = std::signal(signals[k], SIG_IGN);
  const std::string said = CME212::output_of("cat /proc/self/status");
  for (int k = 0; k < 5; ++k) std::signal(signals[k], handlers[k]);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  for (const char* key : {"SigIgn:\t", "SigBlk:\t"}) {
    const auto at = said.find(key);
    ASSERT_NE(at, said.npos);
    const auto mask = std::stoull(said.substr(at + 8), nullptr, 16);
    for (int signal : signals) EXPECT_EQ(mask >> (signal - 1) & 1, 0u) << key;
  }
}

TEST(AChild, EndsWithAllThatItStartedAtTheTimeLimit) {
  const CME212::TestFolder folder;
  const std::string command =
      "sleep 1000 & echo $! >" + folder / "pid" + "; wait";
  std::string pid;
  {
    Child child(command);
    child.until([&] { return contents(folder / "pid").ends_with('\n'); });
    pid = contents(folder / "pid");
  }
  // A process that has ended may be there until it is waited for.
  Child gone("while kill -0 " + pid.substr(0, pid.size() - 1) +
             " && ! grep -q 'State:.Z' /proc/" + pid.substr(0, pid.size() - 1) +
             "/status; do :; done 2>/dev/null");
  EXPECT_EQ(gone.wait(), 0);
  EXPECT_EQ(CME212::error_of([] { Child("sleep 1000", 0).wait(); }),
            "sleep 1000: ended after 0 s, the time limit of a test");
}

TEST(AChild, EndsByItselfOrByASignal) {
  EXPECT_EQ(WEXITSTATUS(Child("exit 3").wait()), 3);
  EXPECT_EQ(WEXITSTATUS(Child("read line").wait()), 1);  // there is no input
  Child child("sleep 1000");
  child.signal(SIGTERM);
  EXPECT_EQ(WTERMSIG(child.wait()), SIGTERM);
  child.signal(SIGTERM);  // it is no more
  EXPECT_FALSE(child.until([] { return false; }));
}

}  // namespace
