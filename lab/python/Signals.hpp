#pragma once
/** @file Signals.hpp
 * Computing without the GIL, which Ctrl-C ends. */
#include <unistd.h>

#include <array>
#include <csignal>
#include <mutex>
#include <optional>
#include <utility>

#include <pybind11/pybind11.h>

#include "lab/scenes/Interrupt.hpp"

namespace lab {

namespace py = pybind11;

/** While one lives, in any thread, Ctrl-C and SIGTERM only end computations of
 * C++: all that run. The last one restores Python's handlers and sends the
 * signal again. */
class CatchSignals {
 public:
  CatchSignals() {
    const std::lock_guard lock(mutex_);
    if (count_++ > 0) return;
    for (auto& [signal, action] : before_) sigaction(signal, nullptr, &action);
    catch_interrupts();
  }
  ~CatchSignals() {
    const std::lock_guard lock(mutex_);
    if (--count_ > 0) return;
    const int signal = interrupted();
    forget_interrupts();
    for (auto& [one, action] : before_) sigaction(one, &action, nullptr);
    if (signal != 0) kill(getpid(), signal);
  }
  CatchSignals(const CatchSignals&) = delete;
  CatchSignals& operator=(const CatchSignals&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int count_ = 0;
  static inline std::array<std::pair<int, struct sigaction>, 3> before_ = {
      {{SIGINT, {}}, {SIGTERM, {}}, {SIGHUP, {}}}};
};

/** Call @a compute without the GIL. After a signal, which Python handles, this
 * is a KeyboardInterrupt. */
template <typename F>
auto without_gil(F compute) {
  std::optional<decltype(compute())> result;
  {
    py::gil_scoped_release released;
    CatchSignals caught;
    try {
      result = compute();
    } catch (const Interrupted&) {
    }
  }
  if (result) return std::move(*result);
  if (PyErr_CheckSignals() == 0) PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

}  // namespace lab
