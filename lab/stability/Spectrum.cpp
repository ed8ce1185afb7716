#include "lab/stability/Spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include "lab/fast/GraphArrays.hpp"

namespace lab {

namespace spectrum_detail {

namespace {

/** A spring for omega_safe(): K alone, in a third of a Spring's memory. */
struct ScalarSpring {
  unsigned i, j;
  double K;
  ScalarSpring(unsigned near, unsigned far, const Stiffness& B)
      : i(near), j(far), K(Spring{near, far, B}.K()) {}
};

template <typename S>
void find(const Cloth& g, const ForcePlan& force, std::vector<S>& springs) {
  springs.clear();
  auto use = [&](unsigned i, unsigned j, const Stiffness& B) {
    springs.push_back(S{i, j, B});
  };
  if (force.add_stiffness(g, use)) return force.add_slack(g, use);
  springs.clear();
  ForcePlan(MassSpringForce()).add_stiffness(g, use);
}

}  // namespace

void find_springs(const Cloth& g, const ForcePlan& force,
                  std::vector<Spring>& springs) {
  find(g, force, springs);
}

void find_scales(const Cloth& g, const ConstraintPlan& constraint,
                 std::vector<double>& scale) {
  scale.assign(arrays(g).node_slots(), 0);
  auto node = arrays(g).node_values();
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    if (arrays(g).node_in_use(i)) scale[i] = 1 / std::sqrt(node[i].mass);
  constraint.each_held(g, [&](Node n) { scale[n.id()] = 0; });
}

namespace {

/** The Lanczos method's estimate of the largest eigenvalue: value is a lower
 * bound of it, and some eigenvalue lies within error of value. */
struct Ritz {
  double value = 0, error = 0;
  int products = 0;
};

/** The largest eigenvalue of a symmetric matrix A.
 * @param v start, not orthogonal to the eigenvector
 * @param multiply w = A v, as void(const VectorXd& v, VectorXd& w)
 * @param most products, at most   @param tolerance stop at this error/value
 * Without orthogonalization: copies of converged eigenvalues appear, but the
 * largest is right. Source: B. N. Parlett, The Symmetric Eigenvalue Problem,
 * 13.  Complexity: the products; memory: 3 vectors. */
template <typename Multiply>
Ritz lanczos(Eigen::VectorXd v, Multiply&& multiply, int most,
             double tolerance) {
  Ritz best;
  const double size = v.norm();
  if (!(size > 0)) return best;
  v /= size;
  Eigen::VectorXd before = Eigen::VectorXd::Zero(v.size()), w(v.size());
  std::vector<double> diagonal, beside;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> T;
  double b = 0;
  while (best.products < most) {
    multiply(v, w);
    ++best.products;
    const double a = v.dot(w);
    diagonal.push_back(a);
    w -= a * v + b * before;
    b = w.norm();
    const bool last = best.products == most || !(b > 1e-14 * std::abs(a));
    if (last || best.products % 5 == 0) {
      const auto k = Eigen::Index(diagonal.size());
      T.computeFromTridiagonal(
          Eigen::Map<Eigen::VectorXd>(diagonal.data(), k),
          Eigen::Map<Eigen::VectorXd>(beside.data(), k - 1));
      best.value = T.eigenvalues()[k - 1];
      best.error = b * std::abs(T.eigenvectors()(k - 1, k - 1));
      if (last || best.error <= tolerance * std::abs(best.value)) break;
    }
    beside.push_back(b);
    before.swap(v);
    v = w / b;
  }
  return best;
}

/** A start for lanczos(): random, the same in every run. v has @a dim entries
 * for each of @a scale; they are 0 where that is 0. */
Eigen::VectorXd random_start(const std::vector<double>& scale, unsigned dim) {
  std::mt19937 random(1);
  Eigen::VectorXd v(Eigen::Index(dim * scale.size()));
  for (Eigen::Index k = 0; k < v.size(); ++k)
    v[k] = scale[std::size_t(k) / dim] > 0
               ? double(random()) / double(random.max()) - 0.5
               : 0.0;
  return v;
}

}  // namespace

}  // namespace spectrum_detail

double omega_safe(const Cloth& g, const ForcePlan& force,
                  const ConstraintPlan& constraint) {
  using namespace spectrum_detail;
  std::vector<ScalarSpring> springs;
  std::vector<double> scale;
  find(g, force, springs);
  find_scales(g, constraint, scale);
  std::vector<double> u(scale.size());
  auto multiply = [&](const Eigen::VectorXd& v, Eigen::VectorXd& w) {
    w.setZero();
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = scale[i] * v[Eigen::Index(i)];
    for (const ScalarSpring& s : springs) {
      const double pull = s.K * (u[s.i] - u[s.j]);
      w[s.i] += scale[s.i] * pull;
      w[s.j] -= scale[s.j] * pull;
    }
  };
  Ritz top = lanczos(random_start(scale, 1), multiply, 200, 2e-3);
  return std::sqrt(std::max(0.0, top.value + top.error));
}

double SharpOmega::operator()(const Cloth& g, const ForcePlan& force,
                              const ConstraintPlan& constraint, int products) {
  using namespace spectrum_detail;
  find_springs(g, force, springs_);
  find_scales(g, constraint, scale_);
  auto multiply = [this](const Eigen::VectorXd& v, Eigen::VectorXd& w) {
    w.setZero();
    auto at = [&](unsigned i) {
      return scale_[i] * Point(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
    };
    for (const spectrum_detail::Spring& s : springs_) {
      const Point pull = s.B * (at(s.i) - at(s.j));
      for (unsigned k = 0; k < 3; ++k) {
        w[3 * s.i + k] += scale_[s.i] * pull[k];
        w[3 * s.j + k] -= scale_[s.j] * pull[k];
      }
    }
  };
  Ritz top = lanczos(random_start(scale_, 3), multiply, products, 1e-4);
  return std::sqrt(std::max(0.0, top.value));
}

}  // namespace lab
