#include "lab/methods/ImplicitStage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"

namespace lab::implicit_detail {

namespace {

constexpr double few = 100;  // products before a factor is considered

/** The inverse of the positive definite @a a: by Cholesky, as a spring may be a
 * million times stiffer along than across; the triangle makes it symmetric. */
Matrix3 inverse(const Matrix3& a) {
  Matrix3 d = a;
  invert_factor(d, Matrix3());
  Matrix3 all;
  for (int c = 0; c < 3; ++c) all.column[c] = transposed_times(d, d.column[c]);
  return all;
}
double trace(const Matrix3& a) {
  return a.column[0][0] + a.column[1][1] + a.column[2][2];
}

template <typename Points>
double rms(const Cloth& g, const Points& a) {
  double sum = 0;
  for (const Point& point : a) sum += normSq(point);
  return std::sqrt(sum / std::max(1u, g.num_nodes()));
}

}  // namespace

double dot_product(const std::vector<Point>& a, const std::vector<Point>& b) {
  double sum = 0;
  for (unsigned i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

Stiffness clamped(const Stiffness& B) {
  return {B.direction, std::max(0.0, B.along), std::max(0.0, B.across)};
}
Matrix3 full_matrix(const Stiffness& B) {
  const Four n = four(B.direction);
  Matrix3 full;
  for (int c = 0; c < 3; ++c)
    full.column[c] = ((B.along - B.across) * n) * n[c];
  add_identity(full, B.across);
  return full;
}

void add_stiffness(std::string_view method, const ForcePlan& force,
                   const Cloth& g, const StiffnessVisitor& use) {
  if (!force.add_stiffness(g, use))
    throw std::invalid_argument(
        std::string(method) +
        ": the force, or a part of it, does not know its stiffness "
        "(SweptForce::add_stiffness); an explicit method does without");
}

void find_fixed(const Cloth& g, const ConstraintPlan& constraint,
                std::vector<char>& fixed) {
  fixed.assign(arrays(g).node_slots(), false);
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    fixed[i] = !arrays(g).node_in_use(i);
  constraint.each_held(g, [&fixed](Node n) { fixed[n.id()] = true; });
}

void ImplicitStage::fail(const char* what, int iterations, double residual,
                         double enough, const char* unit) const {
  using CME212::short_text;
  throw StepError(std::string(method_) + ": " + what + " is at a residual of " +
                  short_text(residual) + unit + " after " +
                  std::to_string(iterations) + " iterations, expected " +
                  short_text(enough) + unit + "; dt = " + short_text(dt_) +
                  " s");
}

ImplicitStage& ImplicitStage::begin(std::string_view method, double t,
                                    double dt, Cloth& g, const ForcePlan& force,
                                    const ConstraintPlan& constraint) {
  method_ = method, dt_ = dt, end_ = t + dt;
  g_ = &g, force_ = &force, constraint_ = &constraint;
  tight_ = false;
  find_fixed(g, constraint, fixed_);
  constraint.place_held_at_rest(g, t);
  const unsigned n = arrays(g).node_slots();
  p.assign(arrays(g).positions().begin(), arrays(g).positions().end());
  q.resize(n);
  for (unsigned i = 0; i < n; ++i) q[i] = arrays(g).node_values()[i].vel;
  guess = w = q;
  for (auto* a : {&residual_, &step_, &rest_, &z_, &direction_, &product_})
    a->resize(n);
  diagonal_blocks_.resize(n);
  return *this;
}

void ImplicitStage::hold(double t) {
  constraint_->each_place(*g_, t, [&](Node n, const Place& place) {
    n.position() = p[n.id()] = place.at;
    q[n.id()] = w[n.id()] = guess[n.id()] = Point();
  });
}

void ImplicitStage::solve_linearized(double t, double s) {
  hold(t);
  find_w(s, w);
  find_residual(t, s);
  assemble(s);
  for (unsigned i = 0; i < w.size(); ++i) direction_[i] = q[i] - w[i];
  multiply(direction_, product_, true);
  for (unsigned i = 0; i < w.size(); ++i) residual_[i] -= product_[i];
  w = q;
  solve(tolerance_, true);
  advance(1);
  move(s);
}

void ImplicitStage::solve_newton(double t, double s, const LocalError& error) {
  hold(t);
  Objective here = choose_start(s);
  double first = 0, before = 0;
  bool clamp = false;
  for (int iteration = 0;; ++iteration) {
    move(s);
    find_residual(t, s);
    if (iteration == 0) assemble(s);
    precondition(residual_, z_);
    const double left = rms(*g_, z_) / s;
    const double goal = allowed(s, error);
    if (left <= goal || left <= round_off(s)) return balance(s);
    if (iteration == max_iterations_ || !std::isfinite(left))
      fail("Newton's method", iteration, left, tolerance_, " m/s^2");
    // The faster Newton converges, the more accurate is the linear solve, but
    // not more than needed: forcing terms of S. Eisenstat, H. Walker, SIAM J.
    // Sci. Comput. 17 (1996) 16, choice 2.
    double enough = 0.01;
    if (iteration == 0) {
      // An upper bound of the residual at w = q.
      for (unsigned i = 0; i < w.size(); ++i) direction_[i] = w[i] - q[i];
      first = left + filtered(s, direction_);
    } else {
      assemble(s);
      const double fallen = left / before;
      enough = std::max(0.1 * fallen * std::sqrt(fallen), 0.3 * goal / left);
      enough = std::clamp(enough, 1e-12, 0.03);
    }
    before = left;
    ++work_.newton;
    if (clamp || !solve(enough, false)) solve(enough, true);
    const bool found = search(t, s, here, left < 0.01 * first);
    if (!found && clamp)
      fail("Newton's line search", iteration, left, tolerance_, " m/s^2");
    clamp = !found;  // A was nearly singular, so step_ was far too long
  }
}

/** RMS(D^-1 M from)/s [m/s^2], for @a from in [m/s]. */
double ImplicitStage::filtered(double s, const std::vector<Point>& from) {
  auto node = arrays(*g_).node_values();
  for (unsigned i = 0; i < from.size(); ++i)
    rest_[i] = fixed_[i] ? Point() : node[i].mass * from[i];
  precondition(rest_, z_);
  return rms(*g_, z_) / s;
}

/** The residual [m/s^2] to stop at, see solve_newton(). */
double ImplicitStage::allowed(double s, const LocalError& error) {
  if (error.scale == 0 || share_ == 0) return tolerance_;
  for (unsigned i = 0; i < w.size(); ++i) direction_[i] = w[i] - guess[i];
  double d = filtered(s, direction_);
  if (error.first) {
    for (unsigned i = 0; i < w.size(); ++i) direction_[i] = guess[i] - q[i];
    const double whole = filtered(s, direction_);
    if (d < whole) d *= d / whole;
  }
  return std::max(tolerance_, share_ * error.scale * d);
}

/** Without fixed nodes: shift w so that the sum of the residual is 0. That does
 * not change any spring. */
void ImplicitStage::balance(double s) {
  Point sum;
  double mass = 0;
  const Drag& c = force_->drag();
  auto node = arrays(*g_).node_values();
  for (unsigned i = 0; i < w.size(); ++i) {
    if (!arrays(*g_).node_in_use(i)) continue;
    if (fixed_[i]) return;
    sum += residual_[i];
    mass += node[i].mass + s * c[i];
  }
  if (mass == 0) return;
  for (unsigned i = 0; i < w.size(); ++i)
    if (!fixed_[i]) w[i] += sum / mass;
  move(s);
}

/** The w @a now of the present positions x = p + s w. */
void ImplicitStage::find_w(double s, std::vector<Point>& now) const {
  auto x = arrays(*g_).positions();
  for (unsigned i = 0; i < w.size(); ++i) now[i] = (x[i] - p[i]) / s;
}
void ImplicitStage::move(double s) {
  auto x = arrays(*g_).positions();
  for (unsigned i = 0; i < w.size(); ++i)
    if (!fixed_[i]) x[i] = p[i] + s * w[i];
}
/** w += a times the solution of the linear system. */
void ImplicitStage::advance(double a) {
  for (unsigned i = 0; i < w.size(); ++i) w[i] += a * step_[i];
}

std::vector<Point>& ImplicitStage::residual(double t, double s) {
  hold(t);
  move(s);
  find_residual(t, s);
  return residual_;
}
void ImplicitStage::find_residual(double t, double s) {
  flow_.accelerate(*g_, t, *force_, true);
  const Drag& c = force_->drag();
  auto node = arrays(*g_).node_values();
  for (unsigned i = 0; i < w.size(); ++i)
    residual_[i] =
        fixed_[i] ? Point()
                  : node[i].mass * (s * flow_.acceleration(i) - (w[i] - q[i])) -
                        s * c[i] * w[i];
}

/** The springs' blocks of A, and the inverses of its diagonal ones. */
void ImplicitStage::assemble(double s) {
  const Drag& c = force_->drag();
  auto node = arrays(*g_).node_values();
  diagonal_.resize(w.size());
  for (unsigned i = 0; i < w.size(); ++i) {
    diagonal_[i] = node[i].mass + s * c[i];
    diagonal_blocks_[i] = Matrix3();
    add_identity(diagonal_blocks_[i], diagonal_[i]);
  }
  blocks_.clear();
  factored_ = false;
  const double ss = s * s;
  add_stiffness(
      method_, *force_, *g_,
      [this, ss](unsigned i, unsigned j, const Stiffness& B) {
        const Stiffness b = {B.direction, ss * B.along, ss * B.across};
        blocks_.push_back({i, j, b});
        const Matrix3 full = full_matrix(clamped(b));
        add(diagonal_blocks_[i], full);
        add(diagonal_blocks_[j], full);
      });
  contrast_ = 1;
  for (unsigned i = 0; i < w.size(); ++i)
    if (!fixed_[i])
      contrast_ =
          std::max(contrast_, trace(diagonal_blocks_[i]) / diagonal_[i] - 2);
  for (Matrix3& d : diagonal_blocks_) d = inverse(d);
}

/** @a to = A @a from, without negative stiffness if @a clamp.  @pre @a from
 * is 0 at fixed nodes */
void ImplicitStage::multiply(const std::vector<Point>& from,
                             std::vector<Point>& to, bool clamp) const {
  for (unsigned i = 0; i < from.size(); ++i) to[i] = diagonal_[i] * from[i];
  for (const Block& b : blocks_) {
    const Stiffness B = clamp ? clamped(b.B) : b.B;
    Point f = B * (from[b.j] - from[b.i]);
    to[b.i] -= f;
    to[b.j] += f;
  }
  for (unsigned i = 0; i < to.size(); ++i)
    if (fixed_[i]) to[i] = Point();
}
/** @a to = D^-1 @a from. */
void ImplicitStage::precondition(const std::vector<Point>& from,
                                 std::vector<Point>& to) const {
  for (unsigned i = 0; i < from.size(); ++i)
    to[i] = point(times(diagonal_blocks_[i], four(from[i])));
}
/** The round-off in D^-1 r/s [m/s^2], RMS over the nodes: that of w through the
 * inertia, that of x through the springs' part of D. */
double ImplicitStage::round_off(double s) const {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  auto x = arrays(*g_).positions();
  double sum = 0;
  for (unsigned i = 0; i < w.size(); ++i) {
    if (fixed_[i]) continue;
    double share =
        std::clamp(3 - diagonal_[i] * trace(diagonal_blocks_[i]), 0., 3.);
    sum += normSq(w[i]) + share * share / (s * s) * normSq(x[i]);
  }
  return epsilon / s * std::sqrt(sum / std::max(1u, g_->num_nodes()));
}

/** The work of a factor of A, in products with A; infinite if it is too large.
 * Counted, with measured weights: a product of two blocks takes 0.7 times as
 * long as a spring in a product with A, a block in each of two solves 2 times.
 */
double ImplicitStage::factor_work() {
  constexpr std::size_t most = 10'000'000;  // blocks, of 100 bytes
  pairs_.clear();
  for (const Block& b : blocks_)
    if (!fixed_[b.i] && !fixed_[b.j]) pairs_.push_back({b.i, b.j});
  if (!factor_.analyze(unsigned(w.size()), pairs_, most)) return HUGE_VAL;
  return (0.7 * factor_.updates() + 4 * double(factor_.entries())) /
         double(blocks_.size() + 1);
}

/** The number of products of CG after which a factor is tried. CG takes about
 * sqrt(condition)/2 ln(2/relative) products; the root is s omega, but at most
 * twice the width of a sheet in nodes. If that is far more than the work of a
 * factor, the factor is made at once; else after as much work as its own, so
 * that both together take at most twice the lesser. */
double ImplicitStage::patience(double relative) {
  if (factored_ || solver_ == LinearSolver::gradients) return HUGE_VAL;
  if (tight_ || solver_ == LinearSolver::cholesky) return 0;
  const double expected =
      0.5 * std::log(2 / relative) *
      std::min(std::sqrt(contrast_), 2 * std::sqrt(double(w.size())));
  return expected < 2 * few || expected < 2 * factor_work() ? few : 0;
}

/** Factor A, without negative stiffness.
 * @return false if it can't be factored */
bool ImplicitStage::factor() {
  if (factor_work() == HUGE_VAL) return false;
  factor_.clear();
  Matrix3 full;
  for (unsigned i = 0; i < w.size(); ++i) {
    full = Matrix3();
    add_identity(full, fixed_[i] ? 1 : diagonal_[i]);
    factor_.add_diagonal(i, full);
  }
  std::size_t pair = 0;
  for (const Block& b : blocks_) {
    full = full_matrix(clamped(b.B));
    if (!fixed_[b.i]) factor_.add_diagonal(b.i, full);
    if (!fixed_[b.j]) factor_.add_diagonal(b.j, full);
    if (fixed_[b.i] || fixed_[b.j]) continue;
    for (Four& c : full.column) c = -c;
    factor_.add(pair++, full);
  }
  ++work_.factors;
  return factor_.factorize();
}

void ImplicitStage::factorize(double s) {
  assemble(s);
  if (!factor())
    throw StepError(std::string(method_) + ": no factor of " +
                    std::to_string(blocks_.size()) +
                    " stiff springs; dt = " + CME212::short_text(dt_) + " s");
}
void ImplicitStage::solve_factored(std::vector<Point>& b) {
  for (unsigned i = 0; i < b.size(); ++i)
    if (fixed_[i]) b[i] = Point();
  factor_.solve(b);
}

/** @a to = the inverse of the preconditioner times @a from. */
void ImplicitStage::apply(const std::vector<Point>& from,
                          std::vector<Point>& to) {
  if (!factored_) return precondition(from, to);
  to = from;
  factor_.solve(to);
}

/** Solve A step_ = residual_ by conjugate gradients until the residual r has
 * fallen by the factor @a relative in the norm sqrt(r P^-1 r). The
 * preconditioner P is D, or the factor of A without negative stiffness.
 * Without @a clamp, A may be indefinite: then step_ is the last iterate, which
 * is still a descent direction.
 * @return false if there is no iterate; never with @a clamp  Throws StepError.
 */
bool ImplicitStage::solve(double relative, bool clamp) {
  double tries = patience(relative);
  std::fill(step_.begin(), step_.end(), Point());
  rest_ = residual_;
  apply(rest_, z_);
  direction_ = z_;
  double size = dot_product(rest_, z_);
  const double start = size, enough = relative * relative * start;
  const int most = 1000 + 3 * int(w.size());
  for (int k = 0; !(size <= enough); ++k) {
    if (k == most || !std::isfinite(size))
      fail("the conjugate gradient method", k, std::sqrt(size / start),
           relative, " (relative)");
    if (k >= tries && tries > 0 && !tight_)
      tries = std::max(tries, factor_work());
    if (k >= tries) {
      tries = HUGE_VAL;
      factored_ = tight_ = factor();
      if (factored_) return solve(relative, clamp);
    }
    multiply(direction_, product_, clamp);
    ++work_.products;
    const double curvature = dot_product(direction_, product_);
    if (!clamp && curvature <= 0) return k > 0;
    const double a = size / curvature;
    for (unsigned i = 0; i < w.size(); ++i) {
      step_[i] += a * direction_[i];
      rest_[i] -= a * product_[i];
    }
    apply(rest_, z_);
    const double next = dot_product(rest_, z_);
    for (unsigned i = 0; i < w.size(); ++i)
      direction_[i] = z_[i] + (next / size) * direction_[i];
    size = next;
  }
  return true;
}

ImplicitStage::Objective ImplicitStage::objective(double s) const {
  auto node = arrays(*g_).node_values();
  const Drag& c = force_->drag();
  double sum = 0;
  for (unsigned i = 0; i < w.size(); ++i)
    if (!fixed_[i])
      sum += node[i].mass * normSq(w[i] - q[i]) + s * c[i] * normSq(w[i]);
  return {0.5 * sum, force_->energy(*g_)};
}

/** Keep w, or take that of the present positions, whichever has the lower
 * objective.  @return that objective */
ImplicitStage::Objective ImplicitStage::choose_start(double s) {
  find_w(s, rest_);
  std::swap(w, rest_);
  const Objective now = objective(s);
  std::swap(w, rest_);
  move(s);
  const Objective moved = objective(s);
  if (moved.value() < now.value()) return moved;
  std::swap(w, rest_);
  return now;
}

/** Add step_ times 1, 1/2, 1/4, ... to w until the objective has fallen from
 * @a here by 1e-4 of what its slope predicts (Armijo's rule). Round-off may
 * hide the fall: so the full step is taken if the predicted fall is below
 * round-off, and, @a close to the solution, if the slope at its end is a tenth
 * or less.
 * @return false if the objective does not fall; then w is as before, to
 * round-off */
bool ImplicitStage::search(double t, double s, Objective& here, bool close) {
  const double predicted = dot_product(residual_, step_);
  advance(1);
  if (predicted <= 1e-12 * (here.inertia + std::abs(here.energy))) return true;
  double a = 1;
  for (; a > 1e-9; a /= 2) {
    move(s);
    const Objective there = objective(s);
    bool good = there.value() <= here.value() - 1e-4 * a * predicted;
    if (!good && close && a == 1) {
      find_residual(t, s);
      good = std::abs(dot_product(residual_, step_)) <= 0.1 * predicted;
    }
    if (good) {
      here = there;
      return true;
    }
    advance(-a / 2);
  }
  advance(-a);
  return false;
}

double ImplicitStage::finish() {
  const auto node = arrays(*g_).node_values();
  for (unsigned i = 0; i < w.size(); ++i) node[i].vel = w[i];
  return implicit_detail::finish(*g_, end_, *constraint_);
}

double finish(Cloth& g, double end, const ConstraintPlan& constraint) {
  constraint(g, end);
  constraint.set_held_velocities(g, end);
  return end;
}

}  // namespace lab::implicit_detail
