#pragma once
/** @file ImplicitStage.hpp
 * What the implicit methods share: the equation of one stage, solved by
 * Newton's method and conjugate gradients. */
#include <vector>

#include "lab/methods/FlatFlow.hpp"
#include "lab/methods/Method.hpp"
#include "lab/methods/SparseCholesky.hpp"

namespace lab {

namespace implicit_detail {

/** Call force.add_stiffness(), and throw std::invalid_argument in the name of
 * @a method if the force does not know its stiffness. */
void add_stiffness(const char* method, const ForcePlan& force, const Cloth& g,
                   const StiffnessVisitor& use);

/** The nodes that do not move in a step, by node id: held and removed ones. */
void find_fixed(const Cloth& g, const ConstraintPlan& constraint,
                std::vector<char>& fixed);

/** How a linear system is solved: by conjugate gradients, preconditioned by the
 * diagonal blocks of A or by its Cholesky factor; automatic takes what is less
 * work, see ImplicitStage. */
enum class LinearSolver { automatic, gradients, cholesky };

/** How a stage estimates its error: see ImplicitStage::solve_newton(). */
struct LocalError {
  double scale = 0;    ///< the error [m/s^2] over the deviation from guess
  bool first = false;  ///< whether guess is of order 0, not 1
};

/** The accuracy that a solver must reach, and the text of its errors. */
struct Goal {
  double tolerance;  ///< of the iteration that throws
  int max_iterations;
  const char* method = "";
  double dt = 0;  ///< of the whole step [s]
  [[noreturn]] void fail(const char* what, int iterations, double residual,
                         const char* unit) const;
};

/** The equation that all implicit steps here are made of: find w [m/s] with
 *   M (w - q) = s (F(y) - c w),   y = p + s w,
 * for given p [m], q [m/s] and s [s]; c is the drag by node, F the other
 * forces. It is where the objective (w - q) M (w - q)/2 + s c w w/2 + V(y) [J]
 * has no slope, V being the energy of F. The matrix of its derivative in w,
 *   A = M + s c + s^2 H,   H the stiffness at y,
 * is applied spring by spring. The linear system is solved by conjugate
 * gradients; where a sparse factor of A is less work, that preconditions them:
 * what is tight and stiff takes about s omega products, a factor as many as
 * some 60 (25 x 25 nodes) to 230 (100 x 100). Both are counted, so that each
 * machine decides alike. The factor's pattern is kept until the springs have
 * other ends or others are fixed; finding it allocates.
 * Compressed springs may keep A from being positive definite: then the linear
 * system is solved in part, or with their negative stiffness taken as 0 (J.
 * Teran et al., SCA 2005, 181), as in the factor always. No residual is changed
 * by that.
 * Fixed nodes have p = x and q = w = 0: hold() moves them to another x. */
class ImplicitStage {
 public:
  std::vector<Point> p, q, w;  // by node id
  /** What w would be if accelerations went on as in the past; by node id. */
  std::vector<Point> guess;

  /** @param tolerance > 0 and @param max_iterations: see the solvers
   * @param line_search whether Newton's method has one
   * @param share of the local error that Newton's method may leave, too */
  ImplicitStage(double tolerance, int max_iterations, bool line_search = true,
                double share = 0);

  /** Ready for a step of @a g from @a t by @a dt [s]: who is fixed, and p = x,
   * q = w = v.  @param method whose name errors give */
  void begin(const char* method, double t, double dt, Cloth& g,
             const ConstraintPlan& constraint);
  /** Put held nodes where they are at @a t, the time of the next solve.
   * @pre p, q, w and guess are set */
  void hold(Cloth& g, double t, const ConstraintPlan& constraint);
  bool fixed(unsigned i) const { return fixed_[i]; }
  const Work& work() const { return work_; }
  void use(LinearSolver solver) { solver_ = solver; }

  /** One Newton step from where @a g is, whatever is left over: the linear
   * system, without negative stiffness, is solved until its residual has fallen
   * by the factor tolerance from that of w = q. So what is left over does what
   * a wrong acceleration would, and small steps have no more of it.
   * @post g's positions are p + s w */
  void solve_linearized(Cloth& g, double t, double s, const ForcePlan& force);

  /** Newton's method with a line search, from @a w or from where @a g is: the
   * former is nearer, unless it stretches springs.
   * @post g's positions are p + s w, and the RMS over the nodes of D^-1 r/s, r
   * the residual and D the diagonal blocks of A, is at most tolerance [m/s^2],
   * share times the local error, or round_off(). Such a residual does what a
   * wrong acceleration would: while s omega is small, it moves the cloth by
   * tolerance T^2/2 at most in a time T, however many steps that takes. Without
   * fixed nodes the sum of r is 0: linear momentum is kept to round-off.
   * Throws StepError.
   *
   * The local error [m/s^2], in the norm of the residual, is
   *   error.scale d,   d = RMS(D^-1 M (w - guess))/s,
   * so d of a guess of order 1 is its second difference, the embedded formula.
   * A guess of order 0, q + s a for the acceleration a at the start, has a
   * first difference only; but |a'|^2 <= |a| |a''| in the mean square (Hardy,
   * Littlewood, Polya, Inequalities, chapter 7), so that
   *   error.scale d min(1, d/RMS(D^-1 M a))
   * does not exceed the error by more than a small factor. */
  void solve_newton(Cloth& g, double t, double s, const ForcePlan& force,
                    const LocalError& error = {});

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
  SparseCholesky<Matrix3> factor_;  // of A without negative stiffness
  std::vector<SparseCholesky<Matrix3>::Pair> pairs_;
  bool factored_ = false;  // whether factor_ is that of this A
  bool tight_ = false;     // whether this step needed a factor before
  double contrast_ = 0;    // of D and M: the square of s omega, and 1
  Goal goal_;
  bool line_search_;
  double share_;
  Work work_;

  struct Objective {
    double inertia, energy;  // [J]
    double value() const { return inertia + energy; }
  };

  void find_still(const Cloth& g, double s, std::vector<Point>& still) const;
  void move(Cloth& g, double s) const;
  void advance(double a);
  void find_residual(Cloth& g, double t, double s, const ForcePlan& force);
  void assemble(const Cloth& g, double s, const ForcePlan& force);
  void multiply(const std::vector<Point>& from, std::vector<Point>& to,
                bool clamp) const;
  void precondition(const std::vector<Point>& from,
                    std::vector<Point>& to) const;
  double round_off(const Cloth& g, double s) const;
  double filtered(const Cloth& g, double s, const std::vector<Point>& from);
  double allowed(const Cloth& g, double s, const LocalError& error);
  void balance(Cloth& g, double s, const ForcePlan& force);
  double factor_work();
  double patience(double relative);
  bool factor();
  void apply(const std::vector<Point>& from, std::vector<Point>& to);
  bool solve(double relative, bool clamp);
  Objective objective(const Cloth& g, double s, const ForcePlan& force) const;
  Objective choose_start(Cloth& g, double s, const ForcePlan& force);
  bool search(Cloth& g, double t, double s, const ForcePlan& force,
              Objective& here, bool close);
};

/** End of a step: the constraint at @a end, and the held nodes' velocities. */
double finish(Cloth& g, double end, const ConstraintPlan& constraint);

}  // namespace implicit_detail

}  // namespace lab
