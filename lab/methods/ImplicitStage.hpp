#pragma once
/** @file ImplicitStage.hpp
 * ImplicitStage: the equation of one stage of an implicit method, solved by
 * Newton's method and conjugate gradients. */
#include <string_view>
#include <vector>

#include "lab/fast/FlatFlow.hpp"
#include "lab/methods/Method.hpp"
#include "lab/methods/SparseCholesky.hpp"

namespace lab {

namespace implicit_detail {

/** Call force.add_stiffness(). Throws std::invalid_argument with the name of
 * @a method if the force does not know its stiffness. */
void add_stiffness(std::string_view method, const ForcePlan& force,
                   const Cloth& g, const StiffnessVisitor& use);

double dot_product(const std::vector<Point>& a, const std::vector<Point>& b);

/** @a B without negative stiffness. */
Stiffness clamped(const Stiffness& B);
Matrix3 full_matrix(const Stiffness& B);

/** Mark, by node id, the nodes that forces do not move: held and removed. */
void find_fixed(const Cloth& g, const ConstraintPlan& constraint,
                std::vector<char>& fixed);

/** The preconditioner of the conjugate gradient method: the diagonal blocks of
 * A, its Cholesky factor, or (automatic) what is less work: see ImplicitStage.
 */
enum class LinearSolver { automatic, gradients, cholesky };

/** How a stage estimates its error: see ImplicitStage::solve_newton(). */
struct LocalError {
  double scale = 0;    ///< the error over the deviation from guess
  bool first = false;  ///< true if guess is of order 0, else 1
};

/** The equation of all implicit steps here: find w [m/s] with
 *   M (w - q) = s (F(y) - c w),   y = p + s w,
 * for given p [m], q [m/s] and s [s]; c is the drag by node, F the other
 * forces. The solution is a stationary point of the objective
 *   (w - q) M (w - q)/2 + s c w w/2 + V(y) [J],   V the energy of F.
 * The Jacobian with respect to w, A = M + s c + s^2 H with the stiffness H at
 * y, is applied spring by spring. Linear systems are solved by conjugate
 * gradients (CG). If it is less work, a sparse factor of A preconditions them:
 * on a taut, stiff cloth CG takes about s omega products; a factor costs as
 * much as 60 (25 x 25 nodes) to 230 (100 x 100). Work is counted, not timed, so
 * every machine decides alike. The factor's pattern is kept until the springs'
 * ends or the fixed nodes change; finding it allocates.
 * Compressed springs can make A indefinite: then CG stops early, or negative
 * stiffness is taken as 0 (J. Teran et al., SCA 2005, 181), as it always is in
 * the factor. The residual is not affected.
 *
 * Fixed nodes have q = w = 0, and p = x: held ones are at their places at the
 * time of the stage. One serves all steps of a method, so that it keeps its
 * memory. */
class ImplicitStage {
 public:
  /** @param tolerance > 0   @param max_iterations   see the solvers
   * @param share Newton's method may leave this share of the local error */
  ImplicitStage(double tolerance, int max_iterations, double share = 0)
      : tolerance_(tolerance), max_iterations_(max_iterations), share_(share) {}
  void use(LinearSolver solver) { solver_ = solver; }
  const Work& work() const { return work_; }

  /** Begin a step of @a g from @a t by @a dt [s]: find the fixed nodes, put
   * held ones to their places, set p = x, q = w = guess = v. The arguments must
   * stay until the next begin().  @param method its name, for errors
   * @return this */
  ImplicitStage& begin(std::string_view method, double t, double dt, Cloth& g,
                       const ForcePlan& force,
                       const ConstraintPlan& constraint);

  std::vector<Point> p, q, w;  ///< by node id; at first x, v, v
  /** w extrapolated from past accelerations; by node id. */
  std::vector<Point> guess;

  bool fixed(unsigned i) const { return fixed_[i]; }

  /** One Newton step from the positions of the cloth, for the stage at @a t.
   * The linear system, without negative stiffness, is solved until its residual
   * has fallen by the factor tolerance from that of w = q. So the error is that
   * of accelerations wrong by a share of tolerance, however small the step.
   * @post the positions are p + s w */
  void solve_linearized(double t, double s);

  /** Newton's method with a line search, for the stage at @a t, started from
   * @a w or from the positions of the cloth, whichever has the lower objective.
   * @post the positions are p + s w, and the RMS over the nodes of D^-1 r/s, r
   * the residual and D the diagonal blocks of A, is at most tolerance [m/s^2],
   * share times the local error, or round_off(). Such a residual acts like an
   * error of the acceleration: while s omega is small, it moves the cloth by at
   * most tolerance T^2/2 in a time T, with any number of steps. Without fixed
   * nodes the sum of r is 0: linear momentum is conserved to round-off.
   * Throws StepError.
   *
   * The local error [m/s^2], in the norm of the residual, is
   *   error.scale d,   d = RMS(D^-1 M (w - guess))/s,
   * the embedded formula, if guess is of order 1: then d is a second
   * difference. If guess is of order 0, q + s a with the acceleration a at the
   * start, d is only a first difference. But |a'|^2 <= |a| |a''| in the mean
   * square (Hardy, Littlewood, Polya, Inequalities, chapter 7), so
   *   error.scale d min(1, d/RMS(D^-1 M a))
   * exceeds the error by at most a small factor. */
  void solve_newton(double t, double s, const LocalError& error = {});

  /** s (F - c w) - M (w - q) [kg m/s] by node id, for the stage at @a t; the
   * caller may overwrite it.  @post the positions are p + s w */
  std::vector<Point>& residual(double t, double s);
  /** Set the positions to p + s w. */
  void move(double s);
  /** End the step: set the velocities to w, apply the constraint.
   * @return the time at its end */
  double finish();

  /** Factor A at the present positions, without negative stiffness.
   * Throws StepError. */
  void factorize(double s);
  /** Replace @a b, by node id, by the solution z of A z = b, with z = 0 at
   * fixed nodes.  @pre factorize() in this step */
  void solve_factored(std::vector<Point>& b);

 private:
  struct Block {  // of s^2 H, between nodes i and j
    unsigned i, j;
    Stiffness B;
  };
  FlatFlow flow_;
  std::vector<char> fixed_;
  std::vector<Block> blocks_;
  std::vector<Matrix3> diagonal_blocks_;  // of A, inverted
  std::vector<double> diagonal_;          // m + s c [kg]
  std::vector<Point> residual_, step_, rest_, z_, direction_, product_;
  LinearSolver solver_ = LinearSolver::automatic;
  SparseCholesky factor_;  // of A without negative stiffness
  std::vector<SparseCholesky::Pair> pairs_;
  bool factored_ = false;  // whether factor_ is the factor of this A
  bool tight_ = false;     // whether an earlier A of this step was factored
  double contrast_ = 0;    // of D and M: about 1 + (s omega)^2
  double tolerance_;
  int max_iterations_;
  double share_;
  std::string_view method_;
  double dt_ = 0;  // of the whole step [s]
  Work work_;
  double end_ = 0;  // [s]
  Cloth* g_ = nullptr;
  const ForcePlan* force_ = nullptr;
  const ConstraintPlan* constraint_ = nullptr;

  struct Objective {
    double inertia, energy;  // [J]
    double value() const { return inertia + energy; }
  };

  [[noreturn]] void fail(const char* what, int iterations, double residual,
                         double enough, const char* unit) const;
  void hold(double t);
  void find_w(double s, std::vector<Point>& now) const;
  void advance(double a);
  void find_residual(double t, double s);
  void assemble(double s);
  void multiply(const std::vector<Point>& from, std::vector<Point>& to,
                bool clamp) const;
  void precondition(const std::vector<Point>& from,
                    std::vector<Point>& to) const;
  double round_off(double s) const;
  double filtered(double s, const std::vector<Point>& from);
  double allowed(double s, const LocalError& error);
  void balance(double s);
  double factor_work();
  double patience(double relative);
  bool factor();
  void apply(const std::vector<Point>& from, std::vector<Point>& to);
  bool solve(double relative, bool clamp);
  Objective objective(double s) const;
  Objective choose_start(double s);
  bool search(double t, double s, Objective& here, bool close);
};

/** End a step: apply the constraint, set held velocities.  @return @a end */
double finish(Cloth& g, double end, const ConstraintPlan& constraint);

}  // namespace implicit_detail

}  // namespace lab
