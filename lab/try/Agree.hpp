#pragma once
/** @file Agree.hpp
 * Where a step does what its table of coefficients says, and where it does not.
 */
#include <map>

#include "lab/try/World.hpp"

namespace probe {

inline Numbers table;                        // of the step
void advance(World& w, double t, double h);  // one step: probe.cpp

/** A step by its table of coefficients, which table.py describes: n stages,
 * then tau, c, b, B (n numbers each), a, w (n x n, by rows), C, V. */
inline void by_table(World& w, const Numbers& table, double t, double h) {
  const auto n = std::size_t(table[0]);
  const double *tau = &table[1], *c = tau + n, *b = c + n, *B = b + n;
  const double *a = B + n, *W = a + n * n, *last = W + n * n;
  const Numbers start = state(w);
  std::vector<std::vector<Point>> acc;  // of each stage so far [m/s^2]
  auto move = [&](double drift, const double* x, double speed,
                  const double* v) {
    for (Node node : nodes(w.g)) {
      const double* s = &start[6 * node.index()];
      const Point v0(s[3], s[4], s[5]);
      Point x1 = Point(s[0], s[1], s[2]) + drift * h * v0, v1 = speed * v0;
      for (std::size_t j = 0; j < acc.size(); ++j) {
        x1 += h * h * x[j] * acc[j][node.index()];
        v1 += h * v[j] * acc[j][node.index()];
      }
      node.position() = x1, node.value().vel = v1;
    }
  };
  for (std::size_t s = 0; s < n; ++s) {
    move(c[s], a + s * n, 1, W + s * n);
    std::vector<Point> now;
    for (Node node : nodes(w.g))
      now.push_back(w.force(node, t + tau[s] * h) / node.value().mass);
    acc.push_back(now);
  }
  move(last[0], B, last[1], b);
}

/** Does a step from the state of @a w equal one by the table? @a w goes on by
 * the step. @param off if given: gets the nodes that differ */
inline bool agrees(World& w, double t, double h,
                   std::vector<unsigned>* off = nullptr) {
  const Numbers begin = state(w);
  advance(w, t, h);
  const Numbers own = state(w);
  set_state(w, begin);
  by_table(w, table, t, h);
  const Numbers due = state(w);
  set_state(w, own);
  double change[2] = {}, size[2] = {1, 1};  // of positions, of velocities
  for (std::size_t k = 0; k < due.size(); ++k) {
    double &most = change[k / 3 % 2], &all = size[k / 3 % 2];
    most = std::max(most, std::abs(due[k] - begin[k]));
    all = std::max(all, std::abs(begin[k]));
  }
  for (std::size_t k = 0; k < due.size(); ++k) {
    const bool finite = std::isfinite(own[k]) || std::isfinite(due[k]);
    const auto i = k / 3 % 2;
    if (finite &&
        !(std::abs(own[k] - due[k]) <= 1e-8 * change[i] + 1e-12 * size[i])) {
      if (!off) return false;
      off->push_back(unsigned(k / 6));
    }
  }
  return !off || off->empty();
}

/** Two masses that move together, on a spring that pulls a little. */
inline const std::map<std::string, double> usual = {
    {"speed", .1},   {"force", 1e-4}, {"length", .3001}, {"K", 4},
    {"dt", 1. / 64}, {"mass", 1},     {"nodes", 2},      {"t", .5},
    {"x", .3},       {"y", .3},       {"z", .3},         {"-x", .3},
    {"-y", .3},      {"-z", .3}};
inline void pair_of(World& w, std::map<std::string, double> is) {
  const auto place = [&](const std::string& d) { return is[d] - is["-" + d]; };
  const Point at(place("x"), place("y"), place("z")), along(.6, .48, .64);
  if (place("x") + place("y") + place("z") < 0) is["speed"] *= -1;
  w.add(at, is["speed"] * along, .5 * is["mass"]);
  w.add(at + is["length"] * along, is["speed"] * along, is["mass"]);
  w.spring(0, 1, is["K"], .3);
  for (int k = 2; k < is["nodes"]; ++k)
    w.add(Point(k, 1, 0), Point(0, .1, 0), 1);
  w.extra = [f = is["force"]](Node, double) { return Point(f, f, f); };
}
inline bool agrees_at(const std::map<std::string, double>& is) {
  World w;
  pair_of(w, is);
  return agrees(w, is.at("t"), is.at("dt"));
}
/** Are factors rounded to float? Then the velocities of most of 16 masses miss
 * the table's by up to 1e-7 of their change, some above and some below. */
inline bool rounds() {
  int above = 0, below = 0;
  for (int k = 1; k <= 16; ++k) {
    World own, due;
    auto is = usual;
    is["mass"] = 1 + k / 17.;
    pair_of(own, is), pair_of(due, is);
    const double begin = state(own)[9];
    advance(own, is["t"], is["dt"]), by_table(due, table, is["t"], is["dt"]);
    const double end = state(due)[9];
    const double off = (state(own)[9] - end) / (end - begin);
    if (!(std::abs(off) < 1e-7)) return false;
    above += off > 1e-9, below += off < -1e-9;
  }
  return above && below && above + below > 8;
}
/** Writes "WHAT value more dt" for the first value, from the usual one to @a
 * to, with which the step differs from its table. */
inline void sweep(const std::string& what, double to,
                  std::map<std::string, double> is = usual) {
  const auto agrees_with = [&](double x) {
    return is[what] = x, agrees_at(is);
  };
  const double ratio = to > is[what] ? 1.5 : 1 / 1.5;
  for (double good = is[what]; (good < to) == (ratio > 1); good *= ratio) {
    double bad = good * ratio;
    if (agrees_with(bad)) continue;
    while (std::abs(bad / good - 1) > 1e-6) {
      const double middle = (good + bad) / 2;
      (agrees_with(middle) ? good : bad) = middle;
    }
    return put(what, {bad, double(ratio > 1), is["dt"]});
  }
}

inline void agree() {
  constexpr double h = 1. / 64;
  World own = forced(), other = forced();
  for (World* w : {&own, &other})
    for (Node n : nodes(w->g)) n.value().vel /= 8;
  for (int k = 0; k < 3; ++k) {
    advance(own, .25 + k * h, h);
    by_table(other, table, .25 + k * h, h);
  }
  put("slow", state(own)), put("slow", state(other));
  if (agrees_at(usual)) put("usual", {});
  if (rounds()) put("rounds", {});
  for (const auto& [name, value] : usual) sweep(name, 1000);
  for (const char* name : {"speed", "force", "length", "K", "dt", "mass"})
    sweep(name, 1e-7);
  auto shorter = usual;
  shorter["dt"] /= 2;
  if (agrees_at(shorter)) sweep("speed", 1000, shorter);
  World space;  // the points of a grid
  for (int k = 0; k < 25 * 25 * 25; ++k)
    space.add(.08 * Point(k % 25, k / 25 % 25, k / 625) - Point(.99, .99, .99),
              Point(.1, .1, .1), 1);
  const Numbers at = positions(space);
  std::vector<unsigned> off;
  if (!agrees(space, 0, .01, &off)) {
    Numbers mean(3);
    for (unsigned i : off)
      for (unsigned d = 0; d < 3; ++d)
        mean[d] += at[3 * i + d] / double(off.size());
    put("place", mean);
  }
  const double safe = 2 / std::sqrt(12 * 100 * 625);  // Verlet's
  for (const double share : {.25, 1., 1.9}) {
    World w = grid1();
    w.walls = {0, 600};
    for (int k = 0; k * share * safe <= .25 && energy(w) < 1; ++k)
      if (!agrees(w, k * share * safe, share * safe)) {
        put("grid1", {share * safe, k * share * safe});
        break;
      }
  }
  World far = tangle();
  constexpr double step = .25 * 2 / 5.4;
  // A motion that grows is compared while both ways can be computed.
  auto is_small = [&far] {
    const Numbers s = state(far);
    return std::all_of(s.begin(), s.end(),
                       [](double x) { return std::abs(x) < 1e100; });
  };
  for (int k = 0; k < 20000 && is_small(); ++k)
    if (!agrees(far, k * step, step)) {
      put("far", {k * step});
      break;
    }
}

}  // namespace probe
