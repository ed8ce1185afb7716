#pragma once
/** @file ForcePlan.hpp
 * ForcePlan: how the laboratory evaluates a force of the course. The one place
 * that recognises GravityForce, MassSpringForce, DampingForce and
 * CombinedForces; any other force is called node by node. */
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <typeinfo>
#include <utility>
#include <vector>

#include "lab/fast/Energy.hpp"
#include "lab/fast/Kernels.hpp"

namespace lab {

/** A part of a cloth, for a sweep: the nodes with ids in [first, last). */
struct Part {
  const Cloth& g;
  const ClothStencil& stencil;  ///< of g
  unsigned first, last;         ///< first a multiple of ClothStencil::width
};

/** Called with the ids of two nodes and the stiffness between them. */
using StiffnessVisitor =
    std::function<void(unsigned i, unsigned j, const Stiffness& B)>;

/** A force that knows more than its call. Only the laboratory uses it: methods
 * get faster by it, and implicit methods possible. */
class SweptForce : public ZeroForce {
 public:
  /** Add the force on each node of @a part to @a f: that on the node of id i to
   * f[i - part.first]. Equal to the call node by node, to round-off. What is
   * added at an id not in use does not count. Threads may evaluate several
   * parts at once.
   * @pre @a f has room for whole blocks of the stencil
   * Complexity: O(nodes + edges at them) */
  virtual void add_to(const Part& part, double t, std::span<Point> f) const {
    for (unsigned i = part.first; i < part.last; ++i)
      if (part.g.node_in_use(i))
        f[i - part.first] += (*this)(part.g.node_with_id(i), t);
  }
  /** The energy [J] whose negative gradient the force is; 0 if it has none. */
  virtual double energy(const Cloth& /*g*/) const { return 0; }
  /** Call @a use(i, j, B) for each pair of nodes between which there is a force
   * that depends on x_j - x_i, at the positions that @a g has now.
   * @return false if the force does not know its stiffness; then what @a use
   *         was called with does not count
   * Complexity: O(nodes + edges) */
  virtual bool add_stiffness(const Cloth& /*g*/,
                             const StiffnessVisitor& /*use*/) const {
    return false;
  }
  /** Number of times the edge springs occur in it, if nothing else depends on
   * positions; else nullopt. */
  virtual std::optional<int> spring_multiplicity() const {
    return std::nullopt;
  }
};

/** The terms of a force, in their order: weight, springs and linear drag by
 * kernels, the others by SweptForce or by call.
 *
 * It is made once for many steps. A ForcePlan shares the parts of a
 * CombinedForces; any other force must outlive it. */
class ForcePlan {
 public:
  /** O(terms). Implicit, so that a force can be handed to a method. */
  ForcePlan(const ZeroForce& force) {  // NOLINT
    add(std::shared_ptr<const ZeroForce>(std::shared_ptr<void>(), &force));
  }

  /** The force on each node of @a part is added to @a f: as
   * SweptForce::add_to(). */
  void add_to(const Part& part, double t, std::span<Point> f) const {
    for (const Term& term : terms_) switch (term.kind) {
        case Kind::weight:
          add_weight(part, term.factor, f);
          break;
        case Kind::springs:
          add_springs(part, f);
          break;
        case Kind::drag:
          add_drag(part, term.factor, f);
          break;
        case Kind::swept:
          static_cast<const SweptForce&>(*term.force).add_to(part, t, f);
          break;
        case Kind::call:
          add_calls(part, *term.force, t, f);
      }
  }
  /** The energy [J] of weight and springs, and of swept forces that have one.
   */
  double energy(const Cloth& g) const {
    double sum = 0;
    for (const Term& term : terms_) switch (term.kind) {
        case Kind::weight:
          sum += gravitational_energy(g, term.factor);
          break;
        case Kind::springs:
          sum += elastic_energy(g);
          break;
        case Kind::swept:
          sum += static_cast<const SweptForce&>(*term.force).energy(g);
          break;
        case Kind::drag:
        case Kind::call:
          break;
      }
    return sum;
  }

  /** c [kg/s] of the term -c v; 0 if there is none. */
  double drag() const {
    double sum = 0;
    for (const Term& term : terms_)
      if (term.kind == Kind::drag) sum += term.factor;
    return sum;
  }

  /** The stiffness of all terms: as SweptForce::add_stiffness(); false if there
   * is a term by call. Together with drag() it is how the force changes with
   * the state. */
  bool add_stiffness(const Cloth& g, const StiffnessVisitor& use) const {
    for (const Term& term : terms_) switch (term.kind) {
        case Kind::springs:
          add_spring_stiffness(g, use);
          break;
        case Kind::swept:
          if (!static_cast<const SweptForce&>(*term.force)
                   .add_stiffness(g, use))
            return false;
          break;
        case Kind::call:
          return false;
        case Kind::weight:
        case Kind::drag:
          break;  // they do not depend on positions
      }
    return true;
  }

  /** Number of times the edge springs occur, if nothing else depends on
   * positions; else nullopt. Then no direction between two nodes is stiffer
   * than that many K, and a node's force may be evaluated as soon as its
   * neighbors have moved. */
  std::optional<int> spring_multiplicity() const {
    int sum = 0;
    for (const Term& term : terms_) {
      if (term.kind == Kind::call) return std::nullopt;
      if (term.kind == Kind::springs) ++sum;
      if (term.kind != Kind::swept) continue;
      const auto some =
          static_cast<const SweptForce&>(*term.force).spring_multiplicity();
      if (!some) return std::nullopt;
      sum += *some;
    }
    return sum;
  }

 private:
  enum class Kind { weight, springs, drag, swept, call };
  struct Term {
    Kind kind;
    double factor;  // of weight: gravity [m/s^2]; of drag: c [kg/s]
    std::shared_ptr<const ZeroForce> force;  // of swept and call
  };
  std::vector<Term> terms_;

  /** Exact types: a child may have another call. */
  void add(std::shared_ptr<const ZeroForce> force) {
    const ZeroForce& f = *force;
    const auto& type = typeid(f);
    if (type == typeid(CombinedForces)) {
      for (const auto& part : static_cast<const CombinedForces&>(f).parts())
        add(part);
    } else if (type == typeid(GravityForce)) {
      const double g = static_cast<const GravityForce&>(f).gravity();
      terms_.push_back({Kind::weight, g, nullptr});
    } else if (type == typeid(MassSpringForce)) {
      terms_.push_back({Kind::springs, 0, nullptr});
    } else if (type == typeid(DampingForce)) {
      const double c = static_cast<const DampingForce&>(f).coefficient();
      terms_.push_back({Kind::drag, c, nullptr});
    } else if (dynamic_cast<const SweptForce*>(&f)) {
      terms_.push_back({Kind::swept, 0, std::move(force)});
    } else if (type != typeid(ZeroForce)) {
      terms_.push_back({Kind::call, 0, std::move(force)});
    }
  }

  static void add_weight(const Part& part, double gravity, std::span<Point> f) {
    const NodeData* node = &part.g.node_values()[part.first];
    const unsigned count = part.last - part.first;
    const unsigned blocks = count / lanes::width;
    lanes::run<kernels::Weight>(node, f.data(), blocks, Real(gravity));
    for (unsigned k = blocks * lanes::width; k < count; ++k)
      f[k].z -= node[k].mass * Real(gravity);
  }

  /** What of a cache one core can count on [bytes]. Measured: README.md */
  static constexpr std::size_t cache = 2 << 20;

  static void add_springs(const Part& part, std::span<Point> f) {
    constexpr unsigned width = ClothStencil::width;
    auto sweep = [&]<bool prefetch>(std::bool_constant<prefetch>) {
      lanes::run<kernels::SpringSweep<prefetch>>(
          part.stencil, part.g.positions().data(), part.g.edge_values().data(),
          part.first / width, (part.last + width - 1) / width, f.data());
    };
    const bool is_large = part.g.edge_slots() * sizeof(EdgeData) > cache;
    if (is_large && 2 * part.stencil.num_gathered() > part.stencil.num_rows())
      sweep(std::true_type());
    else
      sweep(std::false_type());
  }

  static void add_drag(const Part& part, double c, std::span<Point> f) {
    const NodeData* node = &part.g.node_values()[part.first];
    for (unsigned k = 0; k < part.last - part.first; ++k)
      f[k] -= c * node[k].vel;
  }

  /** By one thread at a time: a functor of the assignment may keep a state. */
  static void add_calls(const Part& part, const ZeroForce& force, double t,
                        std::span<Point> f) {
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    for (unsigned i = part.first; i < part.last; ++i)
      if (part.g.node_in_use(i))
        f[i - part.first] += force(part.g.node_with_id(i), t);
  }

  /** One call an edge, in the order of their ids. */
  static void add_spring_stiffness(const Cloth& g,
                                   const StiffnessVisitor& use) {
    const auto x = g.positions();
    for (unsigned e = 0; e < g.edge_slots(); ++e) {
      if (!g.edge_in_use(e)) continue;
      const auto [i, j] = g.edge_ends()[e];
      use(i, j, spring_stiffness(x[j] - x[i], g.edge_values()[e]));
    }
  }
};

}  // namespace lab
