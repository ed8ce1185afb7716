#pragma once
/** @file LoadForce.hpp
 * LoadForce and WindForce: constant forces on nodes. */
#include <utility>
#include <vector>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** A constant force F on each node, of energy -F . x. Potential counts it. */
class LoadForce : public SweptForce {
 public:
  /** @param force by node id [N]; nodes that are added later have none */
  explicit LoadForce(std::vector<Point> force) : force_(std::move(force)) {}
  Point operator()(Node n, double /*t*/) const override {
    return n.id() < force_.size() ? force_[n.id()] : Point();
  }
  double energy(const Cloth& g) const override {
    double sum = 0;
    for (Node n : g.nodes()) sum -= dot((*this)(n, 0), n.position());
    return sum;
  }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;
  }
  std::optional<int> spring_multiplicity() const override { return 0; }

 protected:
  std::vector<Point> force_;
};

/** What moving air adds to drag: the constant part c w of -c (v - w). The
 * ledger of drag counts its work. */
class WindForce : public LoadForce {
 public:
  /** @param c by node id [kg/s]   @param wind w [m/s] */
  WindForce(const std::vector<double>& c, const Point& wind) : LoadForce({}) {
    for (double each : c) force_.push_back(each * wind);
  }
};

}  // namespace lab
