#pragma once
/** @file WindForce.hpp
 * WindForce: what moving air adds to the drag of a cloth. */
#include <utility>
#include <vector>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** The constant part c w of drag -c (v - w) in air of velocity w. */
class WindForce : public SweptForce {
 public:
  /** @param c by node id [kg/s]   @param wind w [m/s] */
  WindForce(std::vector<double> c, const Point& wind)
      : c_(std::move(c)), wind_(wind) {}
  Point operator()(Node n, double /*t*/) const override {
    return n.id() < c_.size() ? c_[n.id()] * wind_ : Point();
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

 private:
  std::vector<double> c_;
  Point wind_;
};

}  // namespace lab
