#include "lab/rest/Equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Eigenvalues>

#include "CME212/Util.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/ImplicitStage.hpp"
#include "lab/scenes/Interrupt.hpp"

namespace lab {

namespace {

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 all;
  for (int c = 0; c < 3; ++c) all.column[c] = times(a, b.column[c]);
  return all;
}
void add(Matrix3& to, double a, const Matrix3& b) {
  for (int c = 0; c < 3; ++c) to.column[c] += a * b.column[c];
}
Point apply(const Matrix3& a, const Point& x) {
  return point(times(a, four(x)));
}

}  // namespace

Equilibrium::Equilibrium(const Model& m, Cloth& g, const ForcePlan& force,
                         const ConstraintPlan& constraint)
    : m_(m), g_(g), force_(force) {
  implicit_detail::find_fixed(g, constraint, fixed_);
  for (Node n : g.nodes()) size_ = std::max(size_, norm(n.position()));
  for (const Wall& w : m.planes) size_ = std::max(size_, norm(w.at));
  for (const Solid& s : m.spheres)
    size_ = std::max(size_, norm(s.ball.center) + s.ball.radius);
  free_.resize(fixed_.size());
  touched_.resize(fixed_.size());
  left_.resize(fixed_.size());
}

/** Call use(number, depth, out, curvature) for each obstacle. If that moves
 * @a p, the next one sees it there. */
template <typename Use>
void Equilibrium::each_surface(const Point& p, Use use) const {
  std::size_t k = 0;
  for (const Wall& w : m_.planes) use(k++, w.depth(p), w.out(), 0.);
  for (const Solid& s : m_.spheres) {
    const Point arm = p - s.ball.center;
    const double r = norm(arm);
    use(k++, s.depth(p), r > 0 ? arm / r : Point(0, 0, 1), 1 / s.ball.radius);
  }
}

/** Put nodes inside obstacles, and those that these push, to the surfaces. */
void Equilibrium::project() {
  auto x = arrays(g_).positions();
  for (unsigned i = 0; i < fixed_.size(); ++i)
    for (int round = 0; round < 20 && !fixed_[i]; ++round) {
      double most = 0;
      each_surface(
          x[i], [&](std::size_t k, double depth, const Point& out, double) {
            const bool on =
                std::ranges::count(touched_[i], k, &Surface::number) > 0;
            if (!(depth > 0 || on)) return;
            x[i] += depth * out;
            most = std::max(most, std::abs(depth));
          });
      if (most <= 1e-15 * size_) break;
    }
}

/** Find the residual, and the surfaces that push. */
void Equilibrium::find_contacts() {
  flow_.accelerate(g_, 0, force_, true);
  const auto node = arrays(g_).node_values();
  const auto x = arrays(g_).positions();
  for (unsigned i = 0; i < fixed_.size(); ++i) {
    auto& all = touched_[i];
    all.clear();
    free_[i] = Matrix3(), add_identity(free_[i], 1);
    left_[i] = fixed_[i] ? Point() : node[i].mass * flow_.acceleration(i);
    if (fixed_[i]) continue;
    each_surface(x[i], [&](std::size_t k, double depth, const Point& out,
                           double curvature) {
      if (std::abs(depth) <= 1e-9 * size_) all.push_back({out, curvature, k});
    });
    // Projected Gauss-Seidel: presses >= 0 that leave least of the force.
    double most = norm(left_[i]);
    for (int round = 0; round < 100 && most > 0; ++round) {
      most = 0;
      for (Surface& s : all) {
        const double change = std::max(-s.press, -dot(left_[i], s.out));
        s.press += change;
        left_[i] += change * s.out;
        most = std::max(most, std::abs(change));
      }
    }
    std::erase_if(all, [](const Surface& s) { return !(s.press > 0); });
    std::vector<Point> basis;
    for (const Surface& s : all) {
      Point n = s.out;
      for (const Point& b : basis) n -= dot(b, n) * b;
      if (norm(n) < 1e-6) continue;
      n /= norm(n), basis.push_back(n);
      for (int c = 0; c < 3; ++c) free_[i].column[c] -= n[c] * four(n);
    }
  }
  rest_.residual = std::sqrt(implicit_detail::dot_product(left_, left_));
}

/** Throws std::runtime_error: a node far away from where all nodes were. */
void Equilibrium::check_falls() const {
  for (Node n : g_.nodes())
    if (!fixed_[n.id()] && !(norm(n.position()) < 100 * size_))
      throw std::runtime_error("no rest: nothing holds node " +
                               std::to_string(n.index()) +
                               ", which falls without end");
}

/** The springs at the present positions; the floor of the residual. */
void Equilibrium::assemble() {
  blocks_.clear(), pairs_.clear();
  std::vector<double> sum(fixed_.size());
  implicit_detail::add_stiffness(
      "rest", force_, g_, [&](unsigned i, unsigned j, const Stiffness& B) {
        if (fixed_[i] && fixed_[j]) return;
        blocks_.push_back({i, j, B});
        if (!fixed_[i] && !fixed_[j]) pairs_.push_back({i, j});
        const double K = std::max({B.along, B.across, -B.across});
        sum[i] += K, sum[j] += K;
      });
  const auto x = arrays(g_).positions();
  const auto node = arrays(g_).node_values();
  double floor = 0;
  top_ = 0;
  for (unsigned i = 0; i < fixed_.size(); ++i) {
    if (fixed_[i]) continue;
    floor += sum[i] * sum[i] * normSq(x[i]);
    for (const Surface& s : touched_[i]) sum[i] += s.press * s.curvature;
    top_ = std::max(top_, 2 * sum[i] / node[i].mass);
  }
  if (top_ == 0) top_ = 1;  // free nodes without any spring
  rest_.floor = 2 * std::numeric_limits<double>::epsilon() * std::sqrt(floor);
}

/** Factor H + @a shift M.  @pre assemble(), find_contacts()
 * @return false if it is not positive definite */
bool Equilibrium::factor(double shift, bool clamp) {
  constexpr auto any = std::numeric_limits<int>::max();
  if (!factor_.analyze(unsigned(fixed_.size()), pairs_, any)) return false;
  const auto node = arrays(g_).node_values();
  std::vector<Matrix3> sum(fixed_.size());
  factor_.clear();
  std::size_t pair = 0;
  for (const Block& b : blocks_) {
    const Matrix3 full = implicit_detail::full_matrix(
        clamp ? implicit_detail::clamped(b.B) : b.B);
    lab::add(sum[b.i], full), lab::add(sum[b.j], full);
    if (fixed_[b.i] || fixed_[b.j]) continue;
    Matrix3 beside = product(product(free_[b.i], full), free_[b.j]);
    for (Four& c : beside.column) c = -c;
    factor_.add(pair++, beside);
  }
  for (unsigned i = 0; i < fixed_.size(); ++i) {
    double curved = 0, size = 0;
    for (const Surface& s : touched_[i]) curved += s.press * s.curvature;
    for (int c = 0; c < 3; ++c) size += sum[i].column[c][c];
    size = size > 0 ? size : 1;
    if (fixed_[i]) sum[i] = Matrix3();
    Matrix3 entry = product(product(free_[i], sum[i]), free_[i]);
    if (!fixed_[i])
      add(entry, shift * node[i].mass - (clamp ? 0 : curved) - size, free_[i]);
    add_identity(entry, size);
    factor_.add_diagonal(i, entry);
  }
  ++rest_.factors;
  return factor_.factorize();
}

/** Move by @a a times @a way if @a energy falls by a share of what its slope
 * predicts (Armijo's rule); where round-off hides that, if the residual falls.
 * @return false if not; then nothing has changed */
bool Equilibrium::try_step(const std::vector<Point>& way, double a,
                           double& energy) {
  auto x = arrays(g_).positions();
  const std::vector<Point> before(x.begin(), x.end());
  const double slope = a * implicit_detail::dot_product(left_, way);
  const double residual = rest_.residual;
  const double hidden = 1e-11 * (std::abs(energy) + rest_.load * size_);
  const bool close = slope <= hidden;
  for (unsigned i = 0; i < way.size(); ++i) x[i] += a * way[i];
  project();
  const double now = force_.energy(g_);
  if (now <= energy + (close ? hidden : -1e-4 * slope)) {
    find_contacts();
    if (!close || rest_.residual < residual) return energy = now, true;
  }
  std::ranges::copy(before, x.begin());
  find_contacts();
  return false;
}

/** The share of @a way, at most 1, with which no node can pass through a ball:
 * it moves by half a radius, or by its distance from the surface. */
double Equilibrium::share_without_jump(const std::vector<Point>& way) const {
  double share = 1;
  const auto x = arrays(g_).positions();
  for (const Solid& s : m_.spheres)
    for (unsigned i = 0; i < way.size(); ++i) {
      const double most = std::max(s.ball.radius / 2, -s.depth(x[i]));
      if (norm(way[i]) * share > most) share = most / norm(way[i]);
    }
  return share;
}

Rest Equilibrium::find(int most) {
  rest_ = {};
  for (Node n : g_.nodes()) n.value().vel = Point();
  project();
  find_contacts();
  double pull = 0;  // the largest acceleration [m/s^2]
  for (Node n : g_.nodes()) {
    if (fixed_[n.id()]) continue;
    const double m = n.value().mass;
    rest_.load += m * force_.gravity().size();
    rest_.load += norm(force_.potential().load(n));
    pull = std::max(pull, norm(left_[n.id()]) / m);
  }
  if (rest_.load == 0) rest_.load = rest_.residual;
  const auto x = arrays(g_).positions();
  const std::vector<Point> start(x.begin(), x.end());
  descend(pull / size_, most);
  while (rest_.factors > 0 && rest_.factors < most &&
         leave_saddle(start, most)) {
  }
  if (!rest_.found())
    throw std::runtime_error(
        "no rest: after " + std::to_string(rest_.factors) +
        " Cholesky factors " + CME212::short_text(rest_.residual) +
        " N are left of " + CME212::short_text(rest_.load) +
        " N; let the cloth swing out instead, with --drag and a long --t-end");
  return rest_;
}

/** Newton's method, until it has found a rest or gets no further. */
void Equilibrium::descend(double shift, int most) {
  double energy = force_.energy(g_);
  assemble();
  std::vector<Point> way;
  while (!rest_.found() && rest_.factors < most && shift < 1e6 * top_) {
    end_if_interrupted();
    const double least = 1e-12 * top_;
    bool good = factor(shift, false);
    if (!good) good = factor(std::max(shift, least), true);
    way = left_;
    if (good) factor_.solve(way);
    const double first = share_without_jump(way);
    double a = first;
    while (good && a > 0.01 * first && !try_step(way, a, energy)) a /= 4;
    rest_.shift = shift;
    if (good && a == 1)
      shift = shift < least ? 0 : shift / 10;
    else if (!good || a < 0.01 * first)
      shift = std::max(16 * shift, least);
    check_falls();
    assemble();
  }
}

/** If the present state is a saddle, go on from beside it. Axes along which no
 * node has moved from @a start stay so, as in motion.
 * @return false if it is none */
bool Equilibrium::leave_saddle(const std::vector<Point>& start, int most) {
  const auto x = arrays(g_).positions();
  std::array<bool, 3> moved = {};
  for (unsigned i = 0; i < start.size(); ++i)
    for (unsigned c = 0; c < 3; ++c) moved[c] |= x[i][c] != start[i][c];
  const auto lowest = modes(1, moved);
  if (lowest.empty() || lowest[0].square >= -zero()) return false;
  const std::vector<Point>& shape = lowest[0].shape;
  double longest = 0;
  for (const Point& p : shape) longest = std::max(longest, norm(p));
  for (unsigned i = 0; i < start.size(); ++i)
    x[i] += (1e-4 * size_ / longest) * shape[i];
  project();
  find_contacts();
  descend(-2 * lowest[0].square, most);
  return true;
}

std::vector<Mode> Equilibrium::modes(unsigned count,
                                     const std::array<bool, 3>& along) {
  find_contacts();
  assemble();
  double s = 0;
  while (!factor(s, false)) s = s > 0 ? 10 * s : 1e-13 * top_;
  const auto n = unsigned(fixed_.size());
  const auto node = arrays(g_).node_values();
  const Eigen::Index most = 3 * n, block = count + 2;
  std::vector<Point> b(n);
  // y = M^(1/2) P (H + s M)^-1 P M^(1/2) y, P the free directions
  const auto into = [&](const auto& y) {
    for (unsigned i = 0; i < n; ++i)
      b[i] = fixed_[i] ? Point()
                       : apply(free_[i],
                               std::sqrt(node[i].mass) *
                                   Point(y[3 * i], y[3 * i + 1], y[3 * i + 2]));
  };
  const auto out_of = [&](auto y, double power) {
    for (unsigned i = 0; i < n; ++i) {
      const Point p =
          fixed_[i] ? Point()
                    : apply(free_[i], std::pow(node[i].mass, power) * b[i]);
      for (unsigned c = 0; c < 3; ++c) y[3 * i + c] = p[c];
    }
  };
  CME212::default_generator.seed(1);
  Eigen::MatrixXd V(most, 0), T(0, 0), W(most, block);
  for (Eigen::Index k = 0; k < block; ++k) {
    for (Point& p : b)
      for (unsigned c = 0; c < 3; ++c) p[c] = along[c] * CME212::random(-1, 1);
    out_of(W.col(k), 0);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
  Eigen::VectorXd before;
  for (int round = 0; round < 30; ++round) {
    end_if_interrupted();
    const Eigen::Index old = V.cols();
    for (Eigen::Index k = 0; k < W.cols(); ++k) {
      Eigen::VectorXd w = W.col(k);
      const double size = w.norm();
      for (int twice = 0; twice < 2; ++twice)
        w -= V * (V.transpose() * w).eval();
      if (!(w.norm() > 1e-10 * size)) continue;
      V.conservativeResize(Eigen::NoChange, V.cols() + 1);
      V.col(V.cols() - 1) = w / w.norm();
    }
    if (V.cols() == old) break;
    W.resize(most, V.cols() - old);
    for (Eigen::Index k = 0; k < W.cols(); ++k) {
      into(V.col(old + k));
      factor_.solve(b);
      out_of(W.col(k), 0.5);
    }
    T.conservativeResize(V.cols(), V.cols());
    T.bottomRows(W.cols()) = W.transpose() * V;  // the triangle that is read
    ritz.compute(T);
    const Eigen::VectorXd now =
        ritz.eigenvalues().tail(std::min<Eigen::Index>(count, T.cols()));
    if (before.size() == now.size() &&
        (now - before).cwiseAbs().maxCoeff() <= 1e-10 * now.maxCoeff() &&
        ((now - before).array().abs() <= 1e-9 * now.array()).all())
      break;
    before = now;
  }
  std::vector<Mode> all;
  for (Eigen::Index k = T.cols(); k-- > 0 && all.size() < count;) {
    const double theta = ritz.eigenvalues()[k];
    if (!(theta > 0)) break;
    const Eigen::VectorXd y = V * ritz.eigenvectors().col(k);
    Mode mode = {1 / theta - s, std::vector<Point>(n)};
    for (unsigned i = 0; i < n; ++i)
      if (!fixed_[i])
        mode.shape[i] = Point(y[3 * i], y[3 * i + 1], y[3 * i + 2]) /
                        std::sqrt(node[i].mass);
    all.push_back(std::move(mode));
  }
  return all;
}

}  // namespace lab
