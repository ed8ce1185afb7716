#pragma once
/** @file HandForce.hpp
 * HandForce: the force by which a user drags one node of a cloth. */
#include <algorithm>
#include <span>

#include "CME212/PageData.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab {

/** A spring of rest length 0 from a node to a target, with a bounded force:
 * f = k d with d = target - x, cut off at |f| = most.
 *
 * Its stiffness never exceeds k, so it raises omega^2 of the cloth by at most
 * k/m (Weyl). add_stiffness() omits it: it is small beside the springs, and a
 * Newton iteration converges without it. */
class HandForce : public SweptForce {
 public:
  /** @param node its id   @param k [N/m] >= 0   @param most [N] >= 0 */
  HandForce(unsigned node, const Point& target, double k, double most)
      : node_(node), target_(target), k_(k), most_(most) {}
  unsigned node() const { return node_; }
  const Point& target() const { return target_; }
  double stiffness() const { return k_; }
  double most() const { return most_; }
  /** Move the target between two steps.  @param target [m] */
  void move(const Point& target) { target_ = target; }

  /** The force [N] at @a x [m]. */
  Point pull(const Point& x) const {
    return CME212::hand_pull(k_, target_ - x, most_);
  }
  Point operator()(Node n, double /*t*/) const override {
    return n.id() == node_ ? pull(n.position()) : Point();
  }
  void add_to(const Part& part, double /*t*/,
              std::span<Point> f) const override {
    if (part.first <= node_ && node_ < part.last &&
        arrays(part.g).node_in_use(node_))
      f[node_ - part.first] += pull(arrays(part.g).positions()[node_]);
  }
  /** k d^2/2 up to the cut-off, linear in d beyond it [J]. */
  double energy(const Cloth& g) const override {
    if (!arrays(g).node_in_use(node_)) return 0;
    const double d = norm(target_ - arrays(g).positions()[node_]);
    const double reach = k_ > 0 ? std::min(d, most_ / k_) : 0;
    return k_ * reach * (d - reach / 2);
  }
  bool add_stiffness(const Cloth&, const StiffnessVisitor&) const override {
    return true;
  }
  std::optional<int> spring_multiplicity() const override { return 0; }

 private:
  unsigned node_;
  Point target_;
  double k_, most_;
};

}  // namespace lab
