#pragma once
/** @file LaplacianFactor.hpp
 * LaplacianFactor: the Cholesky factor of masses and springs, kept as long as
 * neither changes. */
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lab/fast/ConstraintPlan.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/methods/SparseCholesky.hpp"

namespace lab {

/** Solves (M + a c + b L) x = f, where c is the drag by node and
 *   (L x)_i = sum over the springs at i of K (x_i - x_j).
 * No spring is stiffer than K in any direction, so b L bounds b times the
 * stiffness in every configuration. The N x N matrix of the nodes that are not
 * held is the same for x, y and z. Its factor is kept until a, b, a mass, a
 * spring's K or ends, or the held nodes change. */
class LaplacianFactor {
 public:
  struct Scales {
    double drag, springs;  ///< a [s] and b [s^2]
    bool operator==(const Scales&) const = default;
  };

  /** Make the factor that of @a g.  @param method its name, for errors
   * Throws StepError if the matrix can't be factored, std::invalid_argument if
   * @a force does not know its stiffness.
   * Complexity: O(N + springs) if nothing changed; else that of a factor. */
  void find(std::string_view method, const Cloth& g, Scales scales,
            const ForcePlan& force, const ConstraintPlan& constraint);
  /** Replace @a f, by node id, by the solution; 0 at held nodes.  @pre find()
   * Complexity: O(entries of the factor) */
  void solve(std::span<Point> f);
  /** How often the matrix was factored since this object was made. */
  int factorizations() const { return factorizations_; }

 private:
  /** All that the factor depends on. */
  struct Key {
    Scales scales = {};
    std::vector<char> fixed;       // by node id
    std::vector<double> diagonal;  // m + a c [kg], by node id
    struct Spring {
      unsigned i, j;
      double K;
      bool operator==(const Spring&) const = default;
    };
    std::vector<Spring> springs;
    bool operator==(const Key&) const = default;
  };
  Key key_, next_;
  /** The cloth that key_ was made from, if only edges are springs. */
  struct Source {
    std::optional<int> springs;  // nullopt: other forces have springs, too
    const Cloth* cloth = nullptr;
    std::uint64_t version = 0;
    std::vector<unsigned> held;  // their ids, in the constraint's order
    std::vector<double> K;       // [N/m], by edge id
  };
  Source source_;
  std::vector<unsigned> held_;
  int factorizations_ = 0;
  SparseCholesky<double> factor_;

  bool unchanged(const Cloth& g, Scales scales, const ForcePlan& force,
                 const ConstraintPlan& constraint);
  bool factorize();
};

}  // namespace lab
