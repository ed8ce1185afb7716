/** @file 8.my_step.cpp
 * A step of the student's own on a net with moving pins: what it calls and
 * returns, what it keeps, and its error beside that of symplectic Euler with as
 * many forces. */
#include "step.hpp"

namespace kit {

static Trial a_trial() {
  unsigned dice = 8;
  return Trial([&](double least, double most) {
    dice = dice * 1664525u + 1013904223u;
    const double quarter = (most - least) / 4;
    return least + quarter + 2 * quarter * dice / 4294967296.;
  });
}
/** A common cause of a wrong order or a large error. */
static const char* seen_in(const TrialRun& run) {
  return run.late ? "; at some calls of the force the pins were not where they "
                    "are at its time: does the constraint get the time that "
                    "the nodes have reached, and the force the same?"
                  : "";
}

}  // namespace kit

TASK("8.my_step", a_constrained_time) {
  const Trial trial = a_trial();
  TrialRun run(trial);
  const double t = run.t, dt = 0.01;
  DID("a net with two moving pins; one step of dt = 0.01 from t = ", t);
  run.step(dt);
  const double time_returned = run.t;
  CHECK_NEAR(time_returned, t + dt, 1e-12);
  const Point pin_at_last = run.at(0);
  CHECK_NEAR(pin_at_last, trial.pin(0, t + dt), 1e-12);
}

TASK("8.my_step", b_keeps_nothing) {
  const Trial trial = a_trial();
  TrialRun alone(trial), in_turn(trial), other(trial);
  const int steps = 10;
  DID("two runs from the same start: one at a time, then a step of each in ",
      "turn");
  other.step(0.03);
  for (int step = 0; step < steps; ++step) alone.step(0.01);
  for (int step = 0; step < steps; ++step) in_turn.step(0.01), other.step(0.03);
  const Point node_in_turn = in_turn.at(Trial::size - 1);
  CHECK_NEAR(node_in_turn, alone.at(Trial::size - 1), 1e-12);
}

TASK("8.my_step", c_less_error_than_symplectic_euler) {
  const Trial trial = a_trial();
  const int forces = Trial::forces, steps = steps_of(trial, forces);
  TrialRun run(trial, long(forces) * Trial::size);
  run.finish(steps);
  DID("a net with moving pins for 1 s: ", forces, " forces on each node make ",
      steps, " steps of yours", seen_in(run));
  const Bodies exact = trial.exact();
  const double error = run.error(exact);
  const double most = trial.error_of_euler(exact) / 2;
  CHECK(error <= most, words("an error of at most ", most, " m, half of that ",
                             "of symplectic Euler; yours is ", error, " m"));
}

TASK("8.my_step", d_order) {
  const Trial trial = a_trial();
  const Bodies exact = trial.exact();
  const int steps = steps_of(trial, Trial::forces / 4);
  TrialRun run(trial), half(trial);
  run.finish(steps);
  half.finish(2 * steps);
  DID("the same net by ", steps, " steps, then by twice as many", seen_in(run));
  const double before = run.error(exact), after = half.error(exact);
  CHECK(before >= 3 * after || after < 2e-6,
        words("half the step leaves about a quarter of the error, ", before,
              " m; yours leaves ", after, " m"));
}
