#pragma once
/** @file Drag.hpp
 * Linear drag with a coefficient for each node. */
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mass_spring.hpp"

namespace lab {

/** Linear drag f = -c v, with c by node id. Nodes that are added later have
 * none. Splitting methods solve it exactly, as they do a DampingForce. */
class NodeDrag : public ZeroForce {
 public:
  /** @param c [kg/s] by node id, each >= 0 */
  explicit NodeDrag(std::vector<double> c) : c_(std::move(c)) {
    for ([[maybe_unused]] double each : c_) assert(each >= 0);
  }
  const std::vector<double>& coefficients() const { return c_; }
  Point operator()(Node n, double /*t*/) const override {
    return n.id() < c_.size() ? -c_[n.id()] * n.value().vel : Point();
  }

 private:
  std::vector<double> c_;
};

/** All linear drag of a force: drag[id] is the c [kg/s] of a node in -c v. */
class Drag {
 public:
  /** @param c that of every node [kg/s]. Implicit: a number is a drag. */
  Drag(double c = 0) : same_(c) {}  // NOLINT
  void add(double c) { same_ += c; }
  void add(const NodeDrag& d) {
    const auto& c = d.coefficients();
    by_id_.resize(std::max(by_id_.size(), c.size()));
    for (std::size_t i = 0; i < c.size(); ++i) by_id_[i] += c[i];
  }

  double operator[](unsigned id) const {
    return id < by_id_.size() ? same_ + by_id_[id] : same_;
  }
  /** True if no node has any. */
  bool none() const { return same_ == 0 && by_id_.empty(); }
  bool operator==(const Drag&) const = default;

  /** The power that it takes from @a g in air of velocity @a wind [m/s], the
   * sum of c (v - wind) . v [W].  O(N) */
  double power(const Cloth& g, const Point& wind = Point()) const {
    double sum = 0;
    for (Node n : g.nodes()) {
      const Point& v = n.value().vel;
      sum += (*this)[n.id()] * dot(v - wind, v);
    }
    return sum;
  }

 private:
  double same_;
  std::vector<double> by_id_;
};

/** The flow of x' = v, m v' = -c v over a time h, solved exactly: x += way v,
 * v *= decay. */
struct DragFlow {
  double way, decay;
  /** @param gamma c/m >= 0 [1/s]   @param h [s]; may be < 0 */
  DragFlow(double gamma, double h)
      : way(gamma > 0 ? -std::expm1(-gamma * h) / gamma : h),
        decay(std::exp(-gamma * h)) {}
  /** Most nodes have the same c/m, but for round-off. */
  static bool is_same(double gamma, double other) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    return !(std::abs(gamma - other) > rounding * other);
  }
};

}  // namespace lab
