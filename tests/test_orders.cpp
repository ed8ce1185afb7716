// The order that each method declares, measured on cloths whose answer is
// known: the chain, the curtain, and the 5 x 5 cloth with drag; and the chain
// and the cloth with an end that moves. `make orders` prints the table of
// lab/methods/README.md, which each test compares.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/methods/ImplicitMethods.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/Spectrum.hpp"
#include "tests/MovingEnds.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

// Three decades of error at order p take a step 1000^(1/p) times smaller, so
// order 1 is measured over a shorter time. The ends: at multiples of a quarter
// of a mode's period, either what a method does to its amplitude or what it
// does to its phase can't be seen in its position, and another order shows.
// What swings most is 20 degrees off at least.
struct Course {
  Problem problem;   // its t_end is for order 2 and up
  double short_end;  // for order 1 [s]
};

const std::array<Course, 5>& courses() {
  static const std::array<Course, 5> all = {
      Course{chain_problem("chain", "8 masses between two walls", 0.305,
                           Chain{.n = 8}),
             0.12},
      Course{curtain_problem("curtain", "4 x 4 curtain let go", 0.224, 4),
             0.12},
      Course{grid_problem("grid0", "5 x 5 cloth with drag", 0.6, 5), 0.15},
      Course{pulled_chain(0.3), 0.12}, Course{moving_edge(0.4), 0.05}};
  return all;
}

/** dt omega of a method's longest step on each course: there the next term of
 * its error is small, and three decades lower round-off is. rk4 needs short
 * steps on linear springs, as their errors of
 * amplitude and phase are one order apart only; Newton's methods start at long
 * ones, as their tolerance adds up over many short ones. */
const std::map<std::string, std::array<double, 5>> first_steps = {
    {"forward-euler", {0.1, 0.1, 0.4, 0.1, 0.2}},
    {"symplectic-euler", {0.5, 0.5, 1, 0.5, 1}},
    {"verlet", {0.5, 0.5, 0.5, 0.5, 0.5}},
    {"mollified-impulse", {0.5, 0.5, 0.5, 0.5, 0.5}},
    {"pefrl", {1.2, 1.2, 1.2, 1.2, 1.2}},
    {"srkn11b", {1.8, 2.5, 2.8, 1.8, 2}},
    {"rk4", {0.09, 0.3, 0.8, 0.09, 0.3}},
    {"rkn64", {1, 1, 1.15, 1, 1}},
    {"implicit-euler", {0.2, 1, 2, 0.2, 0.8}},
    {"implicit-midpoint", {0.35, 0.5, 2, 0.35, 0.7}},
    {"tr-bdf2", {0.35, 0.5, 2, 0.35, 1}},
    {"xpbd", {0.5, 1, 2, 0.5, 1}}};

/** A method that makes exactly the steps that it is asked for, and solves its
 * linear systems so well that only the error of the step is seen. */
std::unique_ptr<Method> make(const MethodEntry& m) {
  const std::string_view name = m.info.name;
  if (name == ImplicitEuler::info.name)
    return std::make_unique<ImplicitEuler>(1e-12);
  auto method = m.make();
  method->set_tolerance(no_limit);
  return method;
}

/** The answer to @a p, which is one of courses(), computed once. */
const Reference& answer(const Problem& p) {
  static std::map<std::pair<std::string, double>, Reference> known;
  auto key = std::pair(p.name, p.t_end);
  if (auto it = known.find(key); it != known.end()) return it->second;
  // The exact ones to round-off of a few thousand steps.
  return known[key] = p.exact ? Reference{{p.exact(p.t_end), {}, 0}, 1e-14}
                              : reference(p, 32);
}

struct Measured {
  double slope, decades;
};
/** By the names of method and course. */
std::map<std::pair<std::string, std::string>, Measured> all_measured;

/** The fit to @a y over @a x.  @pre more than one x */
double slope_of(std::span<const double> x, std::span<const double> y) {
  double n = double(x.size()), mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    mean_x += x[k] / n, mean_y += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return xy / xx;
}

/** The slope that lab/methods/README.md gives for @a method on the course that
 * is number @a column of its table, from 0 on; 0 if none. */
double documented(const std::string& method, std::size_t column) {
  std::ifstream in("lab/methods/README.md");
  bool there = false;
  for (std::string line; std::getline(in, line);) {
    there |= line == "## Measured orders";
    std::array<double, 5> slopes{};
    if (there && line.starts_with("| " + method + " |") &&
        std::sscanf(line.c_str(),
                    "| %*s | %*d | %lf (%*f) | %lf (%*f) | %lf (%*f) | %lf "
                    "(%*f) | %lf",
                    &slopes[0], &slopes[1], &slopes[2], &slopes[3],
                    &slopes[4]) == 5)
      return slopes[column];
  }
  return 0;
}

class Order
    : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  /** Print what was measured as the table of lab/methods/README.md. */
  static void TearDownTestSuite() {
    std::printf("| method | order |");
    for (const Course& c : courses())
      std::printf(" %s |", c.problem.name.c_str());
    std::puts("\n|---|---|---|---|---|---|---|");
    for (const MethodEntry& m : methods) {
      std::printf("| %s | %d |", m.info.name.data(), m.info.order);
      for (const Course& c : courses())
        if (auto it =
                all_measured.find({std::string(m.info.name), c.problem.name});
            it != all_measured.end())
          std::printf(" %.2f (%.1f) |", it->second.slope, it->second.decades);
        else
          std::printf(" |");
      std::puts("");
    }
  }
};

// Six runs, each error a quarter of the last one: 4^5 = 1024. Each part of the
// way has the slope of the order, and so has all of it; no less, and no more.
TEST_P(Order, IsWhatTheMethodDeclares) {
  const auto& [name, course] = GetParam();
  const MethodEntry& method = *find_method(name);
  const int order = method.info.order;
  constexpr double within = 0.1;
  std::size_t column = 0;
  while (courses()[column].problem.name != course) ++column;
  Problem p = courses()[column].problem;
  if (order == 1) p.t_end = courses()[column].short_end;
  const Reference& right = answer(p);
  Start start(p);
  const double omega = omega_safe(start.cloth, start.force, start.constraint);
  const double first =
      std::ceil(p.t_end * omega / first_steps.at(name)[column]);
  constexpr std::size_t count = 6;
  std::array<double, count> x, y;  // ln dt, ln error
  for (std::size_t k = 0; k < count; ++k) {
    auto steps = std::llround(first * std::pow(4, double(k) / order));
    Outcome out = run(p, *make(method), steps);
    ASSERT_TRUE(out.ok()) << out.reason;
    const double error = distance(p, out.end, right.end);
    ASSERT_GT(error, 5 * right.floor) << steps << " steps";
    x[k] = std::log(p.t_end / double(steps));
    y[k] = std::log(error);
    if (k == 0) continue;
    EXPECT_NEAR((y[k] - y[k - 1]) / (x[k] - x[k - 1]), order, within)
        << "up to " << steps << " steps, error " << error << " m";
  }
  const Measured m = {slope_of(x, y), (y.front() - y.back()) / std::log(10)};
  EXPECT_NEAR(m.slope, order, within);
  EXPECT_GT(m.decades, 2.95);
  EXPECT_NEAR(m.slope, documented(name, column), 0.02) << "make orders";
  all_measured[{name, course}] = m;
}

/** The error of a run over a wall that stops half way. */
double error_over_a_kink(const MethodEntry& method, long long steps) {
  const Problem p = pulled_chain(0.4, 0.2);
  const Outcome out = run(p, *make(method), steps);
  EXPECT_TRUE(out.ok()) << out.reason;
  return distance(p, out.end, answer(p).end);
}

// A step over the time when a wall stops has an error of order 2. A step that
// ends there keeps the order of the method.
TEST(Kink, CostsNoOrderIfAStepEndsThere) {
  for (const MethodEntry& m : methods) {
    const std::string_view name = m.info.name;
    SCOPED_TRACE(name);
    const long long steps = m.info.order == 1 ? 1000 : 110;
    const double coarse = error_over_a_kink(m, steps);
    const double fine = error_over_a_kink(m, 2 * steps);
    EXPECT_NEAR(std::log2(coarse / fine), m.info.order, 0.35);
    if (m.info.order > 2) {
      EXPECT_GT(error_over_a_kink(m, 2 * steps + 1), 10 * fine);
    }
  }
}

std::vector<std::string> names_of_methods() {
  std::vector<std::string> names;
  for (const MethodEntry& m : methods) names.emplace_back(m.info.name);
  return names;
}
std::vector<std::string> names_of_courses() {
  std::vector<std::string> names;
  for (const Course& c : courses()) names.push_back(c.problem.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(
    Table, Order,
    ::testing::Combine(::testing::ValuesIn(names_of_methods()),
                       ::testing::ValuesIn(names_of_courses())),
    [](const auto& info) {
      return test_name(std::get<0>(info.param) + "_on_" +
                       std::get<1>(info.param));
    });

}  // namespace
