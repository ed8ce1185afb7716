#pragma once
/** @file ForcePlan.hpp
 * ForcePlan: how the laboratory evaluates a force of the course. The one place
 * that recognises GravityForce, MassSpringForce, DampingForce, NodeDrag and
 * CombinedForces; any other force is called node by node. */
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "lab/fast/Drag.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Recognise.hpp"

namespace lab {

/** A part of a cloth, for a sweep: the nodes with ids in [first, last). */
struct Part {
  const Cloth& g;
  unsigned first, last;
};

/** Called with the ids of two nodes and the stiffness between them. */
using StiffnessVisitor =
    std::function<void(unsigned i, unsigned j, const Stiffness& B)>;

/** A force with functions that methods use besides its call: for speed, and for
 * implicit methods. Only the laboratory uses it. */
class SweptForce : public ZeroForce {
 public:
  /** Add the force on each node of @a part to @a f: that on the node with id i
   * to f[i - part.first]. Equal to the call node by node, to round-off. Entries
   * of ids not in use are ignored. Threads may evaluate several parts at once.
   * Complexity: O(nodes + edges at them) */
  virtual void add_to(const Part& part, double t, std::span<Point> f) const {
    for (unsigned i = part.first; i < part.last; ++i)
      if (arrays(part.g).node_in_use(i))
        f[i - part.first] += (*this)(arrays(part.g).node_with_id(i), t);
  }
  /** False if it is no force on any node: then add_to() need not be called. */
  virtual bool acts() const { return true; }
  /** The energy [J] whose negative gradient the force is; 0 if it has none. */
  virtual double energy(const Cloth& /*g*/) const { return 0; }
  /** Call @a use(i, j, B) for each pair of nodes between which there is a force
   * that depends on x_j - x_i, at the positions that @a g has now.
   * @return false if the force does not know its stiffness; then the calls of
   *         @a use are to be ignored
   * Complexity: O(nodes + edges) */
  virtual bool add_stiffness(const Cloth& /*g*/,
                             const StiffnessVisitor& /*use*/) const {
    return false;
  }
  /** How many times the force contains the springs of the edges; nullopt if it
   * reads positions of other nodes in any other way. */
  virtual std::optional<int> spring_multiplicity() const {
    return std::nullopt;
  }
  /** Call @a use as add_stiffness() for the pairs that have none now, but may
   * get it in a step: with what it is then. Bounds of steps count it. */
  virtual void add_slack(const Cloth& /*g*/,
                         const StiffnessVisitor& /*use*/) const {}
};

class LoadForce;
class OneWaySprings;

/** What stores the energy of a cloth besides its motion. */
struct Potential {
  Gravity gravity;
  std::shared_ptr<const OneWaySprings> one_way = {};  ///< null: no such springs
  std::shared_ptr<const LoadForce> loads = {};        ///< null: none
  // Implicit: gravity alone, and springs that pull and push.
  Potential(double g = grav) : gravity(g) {}   // NOLINT
  Potential(const Gravity& a) : gravity(a) {}  // NOLINT
  /** The energy of all springs [J].  O(number of edges) */
  double elastic_energy(const Cloth& g) const;
  /** That of weight and loads [J], zero at the origin.  O(N) */
  double gravitational_energy(const Cloth& g) const;
  /** The load on @a n [N]. */
  Point load(const Node& n) const;
};

/** The course's function for forces of which one is swept: such a force stays
 * swept instead of becoming a call. */
template <typename... Fs>
requires(std::derived_from<Fs, SweptForce> || ...)  //
    CombinedForces make_combined_force(Fs... fs) {
  return CombinedForces(CombinedForces::List{
      shared_as<ZeroForce, FunctionForce>(std::move(fs))...});
}

/** The terms of a force: weight and springs by kernels, others by SweptForce or
 * by call, in their order; and the sum of all linear drag.
 *
 * It is made once for many steps. A ForcePlan shares the parts of a
 * CombinedForces; any other force that is passed by reference must outlive it.
 */
class ForcePlan {
 public:
  /** O(terms). Implicit, so that a force can be handed to a method. */
  template <IsA<ZeroForce> F>
  ForcePlan(F&& force) {  // NOLINT
    add(term_of<ZeroForce, FunctionForce>(std::forward<F>(force)));
  }

  /** Add its swept forces and calls to @a f, as SweptForce::add_to(); and tell
   * whether any of them act. */
  void add_others(const Part& part, double t, std::span<Point> f) const;
  bool has_others() const;
  /** The number of evaluations; methods call count_evaluation() each time. */
  long long evaluations() const { return evaluations_; }
  void count_evaluation() const { ++evaluations_; }
  /** The sum of all terms GravityForce and SidewaysForce. */
  const Gravity& gravity() const { return potential_.gravity; }
  /** That, and the terms OneWaySprings and LoadForce. */
  const Potential& potential() const { return potential_; }
  /** The energy [J] of weight, springs, and swept forces that have one. */
  double energy(const Cloth& g) const;
  /** The sum of its terms -c v: drag()[id] is the c [kg/s] of a node. */
  const Drag& drag() const { return drag_; }
  /** The stiffness of all terms: as SweptForce::add_stiffness(); false if there
   * is a term by call. With drag() it is the derivative of the force with
   * respect to the state. */
  bool add_stiffness(const Cloth& g, const StiffnessVisitor& use) const;
  /** As SweptForce::add_slack(). */
  void add_slack(const Cloth& g, const StiffnessVisitor& use) const;
  /** How many times it contains the springs of the edges; nullopt if it reads
   * positions of other nodes in any other way. If not nullopt, no direction
   * between two nodes is stiffer than that many K, and the force on a node may
   * be evaluated as soon as its neighbors have moved. */
  std::optional<int> spring_multiplicity() const;
  /** The number of its MassSpringForce terms. */
  int springs() const { return springs_; }

 private:
  struct Other {
    std::shared_ptr<const ZeroForce> force;
    const SweptForce* swept;  // the same; null: it is called
    bool acts() const { return !swept || swept->acts(); }
  };
  Potential potential_ = 0.;
  int springs_ = 0;
  std::vector<Other> others_;  // in their order
  Drag drag_;
  mutable long long evaluations_ = 0;

  void add(std::shared_ptr<const ZeroForce> force);
};

}  // namespace lab
