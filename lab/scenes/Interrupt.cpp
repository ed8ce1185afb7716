#include "lab/scenes/Interrupt.hpp"

#include <atomic>
#include <initializer_list>

#include <signal.h>

namespace lab {

namespace {

// For a handler like a volatile sig_atomic_t, and for other threads, too.
std::atomic<int> number = 0;
static_assert(std::atomic<int>::is_always_lock_free);

}  // namespace

extern "C" {
// A second one of another kind finds this handler, too, and shall end at once.
static void note_interrupt(int signal) {
  if (number.exchange(signal) != 0) raise(signal);
}
}

void catch_interrupts() {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = note_interrupt;
    action.sa_flags = SA_RESTART | int(SA_RESETHAND);
    sigaction(signal, &action, nullptr);
  }
}

int interrupted() { return number; }
void forget_interrupts() { number = 0; }

const char* name_of_interrupt() {
  switch (number) {
    case 0:
      return "";
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    default:
      return "SIGHUP";
  }
}

void end_if_interrupted() {
  if (number != 0) throw Interrupted();
}

}  // namespace lab
