#pragma once
/** @file Equilibrium.hpp
 * Equilibrium: the state in which a cloth hangs or lies still, and the slow
 * oscillations about it. docs/rest.md has the derivation. */
#include <array>
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/SparseCholesky.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** What Equilibrium::find() reached. */
struct Rest {
  double residual = 0;  ///< [N]: the norm of what obstacles leave of all forces
  double load = 0;      ///< [N]: weight and loads, or else all forces at first
  double floor = 0;     ///< [N]: the round-off of the residual
  double shift = 0;     ///< [1/s^2] that the last matrix needed: see find()
  int factors = 0;      ///< Cholesky factors
  static constexpr double share = 1e-10;  ///< of the load
  bool found() const { return residual <= std::max(share * load, floor); }
};

/** A free oscillation, without drag. */
struct Mode {
  double square;             ///< omega^2 [1/s^2]; negative: it grows
  std::vector<Point> shape;  ///< by node id [kg^(-1/2)]; shape M shape = 1
};

/** A minimum of the potential energy: springs, weight, wind. Held nodes stay.
 * A node in an obstacle is put to the surface, where it slides without friction
 * while the surface has to push it: so the rest is one for any friction.
 *
 * Newton's method; each matrix is H + shift M without the directions into
 * obstacles. If that is not positive definite, negative stiffness counts as 0.
 * A step is kept if the energy falls. From a saddle it goes on downhill, but
 * not along an axis that symmetry leaves at rest. Source: J. Nocedal, S.
 * Wright, Numerical Optimization, Springer 2006, 3.4 and 16.7. */
class Equilibrium {
 public:
  /** Keeps references to @a m and @a g. Obstacles of @a m are those at t = 0.
   * @pre the force knows its stiffness, no node was removed */
  Equilibrium(const Model& m, Cloth& g, const ForcePlan& force,
              const ConstraintPlan& constraint);

  /** Put the cloth to rest.
   * @post found(); positions are those at rest, velocities 0
   * Throws std::runtime_error: a part that nothing holds falls without end, or
   * no rest is found with @a most factors; Interrupted
   * Complexity: factors, each as SparseCholesky::factorize() */
  Rest find(int most = 1000);

  /** The @a count lowest modes about the present state, fewer if there are not
   * so many. They are found by block Lanczos of (H + s M)^-1, to 1e-9 of
   * omega^2 + s, where s is 0 if H is positive definite.
   * @param along the axes along which nodes may move: all, or symmetry leaves
   *   the others at rest
   * Complexity: about 100 solves; memory 150 vectors */
  std::vector<Mode> modes(unsigned count, const std::array<bool, 3>& along = {
                                              true, true, true});

  /** |omega^2| below this is 0 to round-off [1/s^2].  @pre modes() */
  double zero() const { return 1e-14 * top_; }

 private:
  struct Block {  // of H, between nodes i and j
    unsigned i, j;
    Stiffness B;
  };
  struct Surface {  // at a node
    Point out;
    double curvature;  // [1/m]
    std::size_t number;
    double press = 0;  // [N]
  };
  const Model& m_;
  Cloth& g_;
  ForcePlan force_;
  FlatFlow flow_;
  double size_ = 0;  // of all coordinates [m]
  std::vector<char> fixed_;
  std::vector<std::vector<Surface>> touched_;  // by node id, those that push
  std::vector<Matrix3> free_;  // by node id: onto the directions left to it
  std::vector<Point> left_;    // by node id: the residual [N]
  std::vector<Block> blocks_;
  std::vector<SparseCholesky::Pair> pairs_;
  SparseCholesky factor_;
  Rest rest_;
  double top_ = 0;  // a bound of omega^2 [1/s^2]

  template <typename Use>
  void each_surface(const Point& p, Use use) const;
  void project();
  void find_contacts();
  void check_falls() const;
  void descend(double shift, int most);
  bool leave_saddle(const std::vector<Point>& start, int most);
  double share_without_jump(const std::vector<Point>& way) const;
  void assemble();
  bool factor(double shift, bool clamp);
  bool try_step(const std::vector<Point>& way, double a, double& energy);
};

}  // namespace lab
