/** @file 8.my_step.cpp
 * Steps that the grader asks for beside tests/8.my_step.cpp: of two nets in
 * turn, whose springs only law.cpp knows: where they end. The solution answers
 * with a finer run, and with half the error of symplectic Euler as tolerance:
 * ranking.py ranks a class by the distance from these answers. */
#include "law.hpp"

namespace kit {
struct FarNet : Net {
  int number;
  explicit FarNet(int n) : number(n) {
    const Reply bodies = told({Question::body, number, 0, {}});
    const Reply places = told({Question::start, number, 0, {}});
    for (int i = 0; i < size; ++i) start.add(places.of[i], bodies.of[i].x);
    begin = bodies.of[0].y;
  }
  Point pin(int i, double t) const override {
    const Question question = {Question::pin, number, t, {}};
    if (!(question == pins_.question)) pins_ = {question, told(question)};
    return pins_.reply.of[i];
  }
  Point force(int i, double t, const Places& x) const override {
    Question question = {Question::force, number, t, {}};
    for (int k = 0; k < size; ++k) question.x[k] = x(k);
    // A force counts each time: the second of a node takes another question.
    if (!(question == forces_.question) || forces_.used[i])
      forces_ = {question, told(question)};
    forces_.used[i] = true;
    return forces_.reply.of[i];
  }

 private:
  /** The last question and its reply: nodes ask for the same in turn. */
  struct Last {
    Question question = {Question::body, -1, 0, {}};
    Reply reply = {};
    bool used[size] = {};
  };
  mutable Last pins_, forces_;
};
static void answer_exactly(const char* what, const Trial& trial) {
  const Bodies exact = trial.exact(2000);
  for (int i = 0; i < Net::size; ++i)
    answer(what, exact.x[i], trial.error_of_euler(exact) / 2);
}
}  // namespace kit

TASK("?8.my_step", far_nets) {
  if constexpr (answers_all) {
    const auto number = [](double least, double most) {
      return drawn(0, least, most);
    };
    const Trial first(number), second(number);
    answer_exactly("first", first);
    answer_exactly("second", second);
  } else {
    const FarNet first(0), second(1), tried(2);
    const int steps = steps_of(tried, Net::forces);
    TrialRun one(first), other(second);
    for (int step = 0; step < steps; ++step) {
      one.step(Net::seconds / steps);
      other.step(Net::seconds / steps);
    }
    for (int i = 0; i < Net::size; ++i) {
      answer("first", one.at(i));
      answer("second", other.at(i));
    }
  }
}
