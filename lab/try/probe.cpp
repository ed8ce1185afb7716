/** @file probe.cpp
 * Runs a step that somebody has written, and writes numbers; judge.py says what
 * they mean. try.py compiles it, against the course's classes alone, with
 *   -DTRY_FILE='"mine.hpp"' -DTRY_STEP=my_step -DTRY_ARGUMENTS=5
 * (4: the step takes no constraint).
 *   probe PART DESCRIPTOR [NUMBER...]    PART: one of those in main(). NUMBER:
 *     the table of the step, for agree; steps of the only run of each problem,
 *     for chart
 * A line is a name and numbers. */
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "lab/try/Agree.hpp"
// The step comes last: it may use all headers above.
#include TRY_FILE
#ifdef TRY_UNDEFINED  // ends macros that would change what follows
#include TRY_UNDEFINED
#endif

namespace probe {

long long asked = 0;  // steps of each run; 0: of several runs

// ---- Steps

struct Acting {
  World& w;
  template <typename N>
  Point operator()(N n, double t) const {
    return ++w.calls, w.force(n, t);
  }
};
/** Drag apart, for steps that solve it: as WithDrag of methods.hpp. */
struct ActingApart {
  Acting others;
  double drag;
  template <typename N>
  Point operator()(N n, double t) const {
    return others(n, t) - drag * n.value().vel;
  }
};

/** One step by TRY_STEP. */
void advance(World& w, double t, double h) {
  auto hold = [&w](auto&, double at) { w.constrain(at); };
  auto by = [&](auto force) {
#if TRY_ARGUMENTS == 5
    return TRY_STEP(w.g, t, h, force, hold);
#else
    (void)hold;
    return TRY_STEP(w.g, t, h, force);
#endif
  };
  w.apart > 0 ? by(ActingApart{{w}, w.apart}) : by(Acting{w});
}
void run(World& w, double t, double h, long long steps) {
  for (long long k = 0; k < steps; ++k) advance(w, t + double(k) * h, h);
}

/** Runs of n, 2n, 4n, ... steps: "NAME steps calls positions...". */
void refine(const std::string& name, double t0, double t1, long long first,
            long long last, World (*make)()) {
  for (long long steps = first; steps <= last; steps *= 2) {
    World w = make();
    run(w, t0, (t1 - t0) / double(steps), steps);
    Numbers row = positions(w);
    row.insert(row.begin(), {double(steps), double(w.calls) / w.g.num_nodes()});
    put(name, row);
    if (w.calls > 6'000'000) break;  // an expensive step
  }
}

// ---- trace: when the step calls the force, and how it uses the result

/** Three free masses of 1/2, 1 and 2 kg. The force on all is 0; or, in turn,
 * 1, 3 and 7 N along y and z at one of the calls for each node: the step as a
 * table of coefficients. All of it by an eighth, and written eightfold: a step
 * may do something else above a speed. */
void trace() {
  unsigned calls = 0;  // for a node
  for (const double h : {.125, .25})
    for (int impulse = -1; impulse < int(std::min(calls, 48u)); ++impulse) {
      World w;
      for (unsigned i = 0; i < 3; ++i)
        w.add(Point(2 + i, 0, 0), Point(.125, 0, 0), .5 * (1 << i));
      int rows = 0;
      auto row = [&](const char* what, double n, double t) {
        if (++rows > 20000) return;  // it loops for ever
        Numbers numbers = {h, double(impulse), n, t};
        for (unsigned i = 0; i < 3 && i < w.g.num_nodes(); ++i) {
          const Point x = 8 * (w.g.node(i).position() - Point(2 + i, 0, 0));
          const Point v = 8 * w.g.node(i).value().vel;
          numbers.insert(numbers.end(), {x.x, x.y, v.x, v.y});
        }
        put(what, numbers);
      };
      std::vector<unsigned> called(3);
      w.extra = [&](Node n, double t) {
        const auto i = unsigned(std::log2(2 * n.value().mass));
        row("call", i, t);
        const double f =
            int(called[i]++) == impulse ? (2 * (1 << i) - 1) / 8. : 0;
        return Point(0, f, f);
      };
      w.hold = [&](GraphType&, double t) { row("hold", -1, t); };
      row("begin", -1, 3);
#if TRY_ARGUMENTS == 5
      const double end = TRY_STEP(w.g, 3., h, Acting{w},
                                  [&](auto&, double t) { w.constrain(t); });
#else
      const double end = TRY_STEP(w.g, 3., h, Acting{w});
#endif
      put("nodes", {double(w.g.num_nodes())});
      row("end", -1, end);
      const Numbers all = state(w);  // the first node's v along y and z
      put("along", {h, double(impulse), all[4], all[5]});
      calls = *std::max_element(called.begin(), called.end());
    }
}

// ---- same: the same run twice, and among others

void same() {
  World start = forced();
  put("tangle.begin", state(start));
  put("data", data(start));
  for (int time = 0; time < 3; ++time) {
    World w = forced(), other = oscillator(.5, 2, .5, 1);
    for (int k = 0; k < 3; ++k) {
      advance(w, .25 + k * .0625, .0625);
      if (time == 2) advance(other, 7, .125);  // a step that keeps something
    }
    put("tangle.end", state(w));
    put("data", data(w));
    run(other, 7, .125, time + 1);
    if (time == 1) run(w, 7, .125, 1);
  }
  // A stretched spring between nodes on which no force acts: who moves it?
  auto pair = [](double speed, double K, double L) {
    World w;
    w.add(Point(2, 0, 0), Point(), 1);
    w.add(Point(3, 0, 0), Point(speed, 0, 0), 3);
    if (L > 0) w.spring(0, 1, K, L);
    w.walls = {0, 1};
    return w;
  };
  for (const auto& [h, K, L] : {std::array{.125, 4., .7},
                                {.125, 16., .7},
                                {1. / 1024, 4., .7},
                                {1. / 1024, 16., .7},
                                {1. / 1024, 16., .95}}) {
    World w = pair(0, K, L);
    advance(w, 0, h);
    const Numbers x = positions(w);
    put("spring", {h, K, x[0] - 2, x[3] - 3, x[2], double(w.calls)});
  }
  // The nodes fly apart: who looks at K, who at the spring?
  for (const auto& [K, L] : {std::pair{4., 1.}, {16., 1.}, {4., 0.}}) {
    World w = pair(1, K, L);
    advance(w, 0, .125);
    put("reads", state(w));
  }
  // Steps of dt that differ by 1 %: do they end at different places?
  for (const double h : {.125, .12625, .01, .0101}) {
    World w = tangle();
    advance(w, 0, h);
    put("dt", state(w));
  }
}

// ---- order: problems with exact solutions, those of orders.py

void order() {
  constexpr long long most = 1 << 14;
  refine("chain", 0, 2.3, 4, most / 2, [] {
    World w;  // eight masses under tension between two walls
    for (unsigned j = 0; j < 10; ++j) {
      const double a = M_PI * j / 9;
      const double u = j % 9 ? .2 * std::sin(a) + .1 * std::sin(3 * a) : 0;
      w.add(Point(j + .5 + u, .5, 0), Point(), .25);
    }
    for (unsigned j = 0; j < 9; ++j) w.spring(j, j + 1, 1, .5);
    return pin(w, {0, 9}, true);
  });
  refine("kepler", 0, 3, 8, most, [] {
    World w;  // eccentricity 0.3, period 2 pi
    w.add(Point(.7, 0, 0), Point(0, std::sqrt(1.3 / .7), 0), .5);
    w.extra = [](Node n, double) {
      const double r = norm(n.position());
      return -n.value().mass / (r * r * r) * n.position();
    };
    return w;
  });
  refine("driven", .4, 2.4, 8, most, [] {
    World w = oscillator(2, 2, .5, .6);
    w.extra = [](Node n, double t) {
      return n.value().mass * Point(1.5 * std::cos(3 * t), 0, 0);
    };
    return w;
  });
  refine("drag", 0, 2, 8, most, [] {
    World w = oscillator(2, 2, .5, .6);
    w.gamma = .7;
    return w;
  });
  refine("apart", 0, 2, 8, most, [] {
    World w = oscillator(2, 2, .5, .6);
    w.apart = 1.4;
    return w;
  });
}

// ---- physics: what the step conserves

void physics() {
  constexpr double h = .125;
  World w = tangle();  // there and back, by -h, and with reversed velocities
  put("there", state(w));
  run(w, 0, h, 1), run(w, h, -h, 1);
  put("back", state(w));
  World reversed = tangle();
  for (int time = 0; time < 2; ++time) {
    run(reversed, 0, h, 1);
    for (Node n : nodes(reversed.g)) n.value().vel = -n.value().vel;
  }
  put("reversed", state(reversed));

  World moved = tangle();
  put_jacobian(moved, [&] { return advance(moved, 0, h), state(moved); });

  World far = tangle();  // a quarter of Verlet's limit, for long
  constexpr double step = .25 * 2 / 5.4;
  for (int k = 0; k < 20000; ++k) {
    if (k % 20 == 0) {
      Point p, l;
      for (Node n : nodes(far.g)) {
        p += n.value().mass * n.value().vel;
        l += n.value().mass * cross(n.position(), n.value().vel);
      }
      put("invariants", {k * step, energy(far), p.x, p.y, p.z, l.x, l.y, l.z});
    }
    advance(far, k * step, step);
  }
}

// ---- limits: the largest stable step

/** A step for x'' + gamma x' + omega^2 x = 0, dt = 1, as a matrix of x and
 * v/omega, by columns. */
void matrix(const char* name, double omega, double gamma) {
  Numbers row = {omega, gamma};
  for (int k = 0; k < 2; ++k) {
    World w = oscillator(.5, omega, k ? 0 : .5, k ? .5 * omega : 0);
    w.gamma = gamma;
    advance(w, 0, 1);
    const Node n = w.g.node(1);
    row.push_back(2 * n.position().x);
    row.push_back(2 * n.value().vel.x / omega);
  }
  put(name, row);
}

/** Does the cloth stay below 0.5 J for 0.25 s? It starts with 0 J. */
bool holds(double h, double gamma) {
  World w = grid1();
  w.gamma = gamma;
  for (int k = 0; k * h <= .25; ++k) {
    advance(w, k * h, h);
    if (!(energy(w) < .5)) return false;
  }
  return true;
}
/** The energy of such a run, "NAME t energy", until it has gained 50 J; then
 * the shape of the cloth. */
void tell(const char* name, double h) {
  World w = grid1();
  double e = 0;
  for (int k = 0; k * h <= .25 && e < 50; ++k) {
    advance(w, k * h, h);
    e = energy(w);
    if (k % std::max(1, int(.25 / h / 400)) == 0) put(name, {(k + 1) * h, e});
  }
  put(std::string("shape.") + name, positions(w));
}

void limits() {
  for (int k = 1; k <= 3000; ++k) matrix("line", k * .004, 0);
  for (const double drag : {.5, 1., 2.})
    for (int k = 1; k <= 600; ++k) matrix("drag", k * .01, drag);
  for (int j = 0; j <= 48; ++j)
    for (int k = 1; k <= 192; ++k) matrix("map", k * .0625, j * .125);
  const double safe = 2 / std::sqrt(12 * 100 * 625);  // Verlet's
  for (const double gamma : {0., 20.}) {
    double low = safe / 16, high = safe * 16;
    if (!holds(low, gamma)) high = low, low = 0;
    while (low > 0 && high / low > 1.01) {
      const double middle = std::sqrt(low * high);
      (holds(middle, gamma) ? low : high) = middle;
    }
    put("grid1", {gamma, low, high, safe});
    if (gamma > 0) continue;
    if (low > 0) tell("inside", low);
    if (high < safe * 16) tell("outside", high * 1.02);
  }
}

// ---- contact: pins that move, a floor, removal

/** Five free masses and springs. The node of mass 100, joined to none, goes in
 * the third step, at call @a removing of the constraint (0: it stays; -1: it
 * does, and is the last node). Writes "torn removing mass state", as an index
 * may change.
 * @return calls of the constraint in that step */
int torn(int removing) {
  World w;
  auto loose = [&] { w.add(Point(9, 9, 9), Point(0, 1, 0), 100); };
  const unsigned first = removing >= 0;
  if (first) loose();
  for (unsigned k = 0; k < 5; ++k) {
    const unsigned i = first ? k : 4 - k;
    w.add(Point(.3 * i, .2 + .1 * i * i, .1), Point(0, .1 * i, .2), 1 + i);
  }
  for (unsigned i = first; i < 4 + first; ++i) w.spring(i, i + 1, 20, .3);
  if (!first) loose();
  int step = 0, called = 0;
  w.hold = [&](GraphType& g, double) {
    if (step == 2 && ++called == removing)
      g.remove_node(*std::find_if(g.node_begin(), g.node_end(), [](Node n) {
        return n.value().mass == 100;
      }));
  };
  try {
    for (; step < 5; ++step) advance(w, step * .05, .05);
  } catch (...) {
    put("torn.throws", {double(removing)});
    return called;
  }
  const Numbers s = state(w);
  for (unsigned i = 0; i < w.g.num_nodes(); ++i) {
    Numbers row = {double(removing), w.g.node(i).value().mass};
    row.insert(row.end(), s.begin() + 6 * i, s.begin() + 6 * i + 6);
    put("torn", row);
  }
  return called;
}

void contact() {
  if (!constrained) return;
  double deepest = 0, off = 0;
  World w = falling();
  for (int k = 0; k < 40; ++k) {
    advance(w, k * .01, .01);
    for (Node n : nodes(w.g))
      deepest =
          std::max(deepest, .2 - norm(n.position() - Point(.5, .55, -.25)));
    off = std::max(off, norm(w.g.node(0).position()));
  }
  put("deepest", {deepest, off});
  refine("still", 0, .7, 16, 1 << 13, [] { return swinging(false); });
  refine("pins", 0, .7, 16, 1 << 13, [] { return swinging(true); });
  refine("ball", 0, .4, 64, 1 << 13, falling);
  torn(-1);
  const int last = torn(0);
  if (last > 0) torn(last);
  if (last > 1) torn(1);
}

// ---- chart: Chain and Curtain of lab/charts/Problems.cpp; and seconds

void chart() {
  const long long n = asked ? asked : 9, last = asked ? asked : 9 << 13;
  refine("chart.chain", 0, .8, n, last, [] {
    constexpr unsigned n = 20;
    World w;
    for (unsigned j = 0; j < n + 2; ++j) {
      double x = j / double(n + 1);
      if (j % (n + 1) > 0)
        for (const auto& [k, a] : {std::pair{1, .02}, {2, .01}, {5, .005}})
          x += a * std::sin(k * M_PI / (n + 1) * j);
      w.add(Point(x, 0, 0), Point(), 1. / n);
      if (j > 0) w.spring(j - 1, j, 100, .5 / (n + 1));
    }
    return pin(w, {0, n + 1}, false);
  });
  const long long m = asked ? asked : 40, end = asked ? asked : 40 << 7;
  refine("chart.curtain", 0, 1, m, end, [] {
    World w = cloth(16, true, false);
    std::vector<unsigned> top;
    for (unsigned i = 0; i < 16; ++i) top.push_back(16 * i);
    return pin(w, top, false);
  });
  // Processor time beside Verlet by loops of the same kind, in turns.
  World a = grid1(), b = grid1();
  std::clock_t own = 0, other = 0;
  for (int k = 0; k < 60; ++k) {
    const auto t0 = std::clock();
    run(a, k * 1e-3, 1e-4, 10);
    const auto t1 = std::clock();
    for (int i = 0; i < 10; ++i) verlet(b, k * 1e-3 + i * 1e-4, 1e-4);
    own += t1 - t0, other += std::clock() - t1;
  }
  put("times", {double(own), double(other)});
}

}  // namespace probe

int main(int count, char** words) {
  const std::map<std::string, void (*)()> parts = {
      {"trace", probe::trace},     {"same", probe::same},
      {"agree", probe::agree},     {"order", probe::order},
      {"physics", probe::physics}, {"limits", probe::limits},
      {"contact", probe::contact}, {"chart", probe::chart}};
  const auto part = parts.find(count > 2 ? words[1] : "");
  if (part == parts.end()) return 2;
  if (count > 3) probe::asked = std::atoll(words[3]);
  for (int k = 3; k < count; ++k) probe::table.push_back(std::atof(words[k]));
  probe::constrained = TRY_ARGUMENTS == 5;
  probe::out = fdopen(std::atoi(words[2]), "w");
  probe::put("begun", {});
  part->second();
  probe::put("done", {});
}
