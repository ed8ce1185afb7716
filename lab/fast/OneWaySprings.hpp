#pragma once
/** @file OneWaySprings.hpp
 * OneWaySprings: springs of which some are cables or struts. */
#include <utility>
#include <vector>

#include "lab/fast/ForcePlan.hpp"

namespace lab {

/** MassSpringForce for a cloth with springs that act one way only. It is swept
 * node by node, not by the kernels, which know none: a scene without such
 * springs has a MassSpringForce, its speed and its bits. */
class OneWaySprings : public SweptForce {
 public:
  /** @param acts by edge id; edges that are added later pull and push */
  explicit OneWaySprings(std::vector<Acts> acts) : acts_(std::move(acts)) {}
  Acts way(unsigned edge) const {
    return edge < acts_.size() ? acts_[edge] : Acts::both;
  }
  /** Does a spring of this id and of length @a l [m] not act? */
  bool is_slack(unsigned edge, double l, const EdgeData& s) const {
    return int(way(edge)) * (l - s.L) < 0;
  }
  /** spring_force() of the spring of this id: zero if it is slack. */
  Point pull(unsigned edge, const Point& u, const EdgeData& s) const {
    return is_slack(edge, norm(u), s) ? Point() : spring_force(u, s);
  }

  Point operator()(Node n, double t) const override;
  void add_to(const Part& part, double t, std::span<Point> f) const override;
  double energy(const Cloth& g) const override;
  /** Of each edge, in the order of their ids; 0 of slack ones. */
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override;
  std::optional<int> spring_multiplicity() const override { return 1; }
  void add_slack(const Cloth& g, const StiffnessVisitor& use) const override;

 private:
  std::vector<Acts> acts_;

  template <typename Use>
  void each(const Cloth& g, Use use) const;
};

}  // namespace lab
