/** @file contest.cpp
 * Runs a step on scenes that contest.py describes, and counts the forces that
 * it asks for. Built as probe.cpp:  contest run DESCRIPTOR  writes "begun",
 * reads the scenes from the standard input, closes that, and only then calls
 * the step. So the step can know nothing of a scene but what it is given. */
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "lab/try/World.hpp"
// The step, after all that it may use.
#include TRY_FILE

namespace probe {

/** By name the lines of a scene: "node x y z vx vy vz m", "spring i j K L",
 * "wind a omega" (m a cos(omega t) along y), "pin i x y z a omega" (it moves by
 * a sin(omega t) along x). */
using Scene = std::map<std::string, std::vector<Numbers>>;

/** A run of a scene by the step. */
class Run {
 public:
  /** @param hidden the edges say nothing of the springs */
  Run(const Scene& s, bool hidden)
      : s_(s), n_(unsigned(s.at("node").size())), seen_(n_), springs_(n_ * n_) {
    for (const Numbers& x : s.at("node"))
      w_.add(Point(x[0], x[1], x[2]), Point(x[3], x[4], x[5]), x[6]);
    for (const Numbers& e : s.at("spring")) {
      const auto i = unsigned(e[0]), j = unsigned(e[1]);
      w_.spring(i, j, hidden ? 0 : e[2], hidden ? 1 : e[3]);
      springs_[i * n_ + j] = springs_[j * n_ + i] = {e[2], e[3]};
    }
  }
  Run(const Run&) = delete;

  void step(double t, double h) {
    TRY_STEP(
        w_.g, t, h, [this](auto n, double at) { return force(n, at); },
        [this](auto& g, double at) { hold(g, at); });
  }
  /** Forces on all nodes. An answer as before, at the same place, is free. */
  double evaluations() const { return double(calls_) / n_; }
  Numbers end() { return w_.g.num_nodes() == n_ ? state(w_) : Numbers(); }

 private:
  struct Spring {
    double K = 0, L = 0;
  };
  const Scene& s_;
  World w_;
  unsigned n_;
  std::vector<std::pair<Point, Point>> seen_;  // place and force, of each node
  std::vector<Spring> springs_;                // between each two nodes
  long long calls_ = 0;

  Point force(Node n, double t) {
    const unsigned i = n.index();
    Point f(0, 0, -9.81 * n.value().mass);
    for (const Numbers& a : s_.at("wind"))
      f.y += n.value().mass * a[0] * std::cos(a[1] * t);
    for (auto e = n.edge_begin(); e != n.edge_end(); ++e) {
      const Point u = (*e).node2().position() - n.position();
      const Spring& s = springs_[i * n_ + (*e).node2().index()];
      f += s.K * (1 - s.L / norm(u)) * u;
    }
    if (const std::pair now(n.position(), f); !(seen_[i] == now))
      seen_[i] = now, ++calls_;
    return f;
  }
  void hold(GraphType& g, double t) {
    for (const Numbers& p : s_.at("pin")) {
      const double a = p[4], omega = p[5];
      Node n = g.node(unsigned(p[0]));
      n.position() = Point(p[1] + a * std::sin(omega * t), p[2], p[3]);
      n.value().vel = Point(a * omega * std::cos(omega * t), 0, 0);
    }
  }
};

/** @a n steps from @a t on. */
void steps(const Scene& s, bool hidden, double t, double h, int n) {
  Run r(s, hidden);
  for (int k = 0; k < n; ++k) r.step(t + k * h, h);
  put("steps", r.end());
}
/** To @a end by as many steps as @a most evaluations allow. */
void budget(const Scene& s, double end, double most) {
  for (double n = most, tries = 0; n >= 1 && tries < 20; ++tries) {
    Run r(s, false);
    double k = 0;  // the first force of all is not counted
    for (; k < n && r.evaluations() < most + 1.5; ++k)
      r.step(k * end / n, end / n);
    if (k == n && r.evaluations() < most + 1.5) {
      Numbers row = r.end();
      row.insert(row.begin(), {most, n, r.evaluations()});
      return put("budget", row);
    }
    n = std::min(n - 1, std::floor(k * most / r.evaluations()));
  }
  put("over", {most});
}

}  // namespace probe

int main(int, char** words) {
  using namespace probe;
  out = fdopen(std::atoi(words[2]), "w");
  put("begun", {});
  std::vector<std::pair<std::string, Numbers>> lines;
  char name[16];
  for (int count; std::scanf("%15s %d", name, &count) == 2;) {
    lines.emplace_back(name, count);
    for (double& x : lines.back().second)
      if (std::scanf("%lf", &x) != 1) return 2;
  }
  std::fclose(stdin), close(0);
  Scene s;
  for (const auto& [what, x] : lines)
    if (what == "scene")
      s = {{"node", {}}, {"spring", {}}, {"wind", {}}, {"pin", {}}};
    else if (what == "steps")
      steps(s, x[0], x[1], x[2], int(x[3]));
    else if (what == "budget")
      budget(s, x[0], x[1]);
    else
      s[what].push_back(x);
  put("done", {});
}
