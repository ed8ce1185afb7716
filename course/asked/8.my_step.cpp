/** @file 8.my_step.cpp
 * Where two nets end, drawn at random and run in turn. The solution answers
 * with a finer run, and with half the error of symplectic Euler as tolerance:
 * course/kit/ranking.py ranks a class by the distance from these answers. */
#include "asked.hpp"

ASKED("8.my_step", my_step_asked) {
  const Trial first(drawn), second(drawn);
  if constexpr (answers_all) {
    for (const Trial* trial : {&first, &second}) {
      const Bodies exact = trial->exact(8000);
      for (int i = 0; i < Trial::size; ++i)
        answer(trial == &first ? "first" : "second", exact.x[i],
               trial->error_of_euler(exact) / 2);
    }
    return;
  }
  const int steps = steps_of(first, Trial::forces);
  const long most = long(Trial::forces) * Trial::size;
  TrialRun one(first, most), other(second, most);
  for (int step = 0; step < steps; ++step) {
    one.step(Trial::seconds / steps);
    other.step(Trial::seconds / steps);
  }
  for (int i = 0; i < Trial::size; ++i) {
    answer("first", one.at(i));
    answer("second", other.at(i));
  }
  answer("forces", double(one.asked) / Trial::size);
}
