#pragma once
/** @file Stability.hpp
 * How long a step may be, and what happened when it was too long: the limits of
 * the methods, and DivergenceGuard. */
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "CME212/BoundingBox.hpp"
#include "CME212/Util.hpp"
#include "Integrator.hpp"
#include "Spectrum.hpp"

// --------------------------------------------------------------------- Limits

/** The larger size of the eigenvalues of the matrix (a b; c d). */
inline double spectral_radius(double a, double b, double c, double d) {
  const double half = (a + d) / 2, det = a * d - b * c;
  const double root = half * half - det;
  return root > 0 ? std::abs(half) + std::sqrt(root) : std::sqrt(det);
}

/** By what factor a step of @a method makes an oscillator grow, x'' + gamma x'
 * + omega^2 x = 0, when it is repeated: the spectral radius of the step's
 * matrix. Found by stepping a mass on a spring of rest length 0, which is
 * exactly linear, from two states.
 * @param dt [s] > 0   @param omega [1/s] > 0   @param gamma [1/s] >= 0
 * Throws what the method throws. */
inline double amplification(Method& method, double dt, double omega,
                            double gamma = 0) {
  Cloth g;
  g.add_node(Point());
  Node mass = g.add_node(Point(1, 0, 0));
  g.add_edge(g.node(0), mass, {Real(omega * omega), 0});
  auto force = make_combined_force(MassSpringForce(), DampingForce(gamma));
  const std::array wall = {g.node(0)};
  PinConstraint pin(wall);
  auto image = [&](double x, double v) {  // of (x, v/omega)
    mass.position() = Point(x, 0, 0);
    mass.value().vel = Point(v * omega, 0, 0);
    method.restart();
    method.step(g, 0, dt, force, pin);
    return std::array<double, 2>{mass.position().x, mass.value().vel.x / omega};
  };
  const auto [xx, vx] = image(1, 0);
  const auto [xv, vv] = image(0, 1);
  return spectral_radius(xx, xv, vx, vv);
}

/** The largest step [s] with which @a method stays bounded on all frequencies
 * up to @a omega [1/s], with a drag of @a gamma = c/m [1/s]; no_limit if all
 * do. Without drag info.limit/omega. Drag that is treated exactly does not
 * lower that; drag as a force does: symplectic Euler needs (dt omega)^2 + 2 dt
 * gamma < 4, forward Euler dt < gamma/omega^2. So the limit is the smaller one
 * of that without drag and of what amplification() says with it. */
inline double step_limit(const MethodEntry& method, double omega,
                         double gamma = 0) {
  const MethodInfo& info = method.info;
  if (info.limit == no_limit || info.adaptive || !(omega > 0)) return no_limit;
  double high = (info.limit > 0 ? info.limit : 2) / omega;
  if (!(gamma > 0)) return info.limit > 0 ? high : 0;
  auto made = method.make();
  constexpr double round_off =
      std::max(1e-12, 10. * std::numeric_limits<Real>::epsilon());
  auto stable = [&](double dt) {
    return amplification(*made, dt, omega, gamma) <= 1 + round_off;
  };
  if (info.limit > 0 && stable(high * (1 - 1e-6))) return high;
  double low = 0;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

/** The largest c/m [1/s] of a cloth with drag @a c [kg/s]. */
inline double largest_gamma(const Cloth& g, double c) {
  double least = no_limit;
  for (Node n : g.nodes()) least = std::min<double>(least, n.value().mass);
  return c / least;
}

/** The share of a safe limit that `--dt auto` takes, and of a sharp one.
 *
 * The safe limit is that of a cloth swinging about any one shape. A cloth
 * without drag that is thrown about violently, springs passing through length
 * 0, also gains energy from changing its shape near the limit: of 1,000 random
 * scenes by Verlet none at 0.8 of it, and of every method none at 0.6
 * (SafeStep.NeverDivergesInRandomScenes). A cloth let go at rest, as the
 * assignment's, can do with 1. The sharp share also covers what SharpOmega
 * misses. */
inline constexpr double safe_share = 0.6, sharp_share = 0.9;

// ---------------------------------------------------------------------- Guard

/** Watches the energy of a run and keeps the last state that was good.
 *
 * Gravity and springs can't raise the energy of a cloth; a method that is
 * unstable does so without bound. A state is good while it is finite and
 *   kinetic + elastic + gravitational energy
 *     <=  total energy at the start + 3 S,
 * S = kinetic and elastic energy at the start + total weight times the
 * diagonal of the cloth + the energy of all springs stretched by 10 %. The
 * margin is for what a stable method does: its energy swings, and a constraint
 * that moves a node stretches springs. */
class DivergenceGuard {
 public:
  /** @param g The cloth at the start   @param gravity [m/s^2] */
  DivergenceGuard(const Cloth& g, double gravity) : gravity_(gravity) {
    CME212::BoundingBox box;
    for (Node n : g.nodes()) box |= n.position();
    if (!box.empty()) top_ = box.max().z;
    double size = box.diagonal() > 0 ? box.diagonal() : 1;
    double start = kinetic_energy(g) + elastic_energy(g);
    double scale = start + total_mass(g) * std::abs(gravity) * size;
    for (Edge e : g.edges())
      scale += spring_energy(1.1 * e.value().L, e.value());
    limit_ = start + heights_energy(g) + 3 * scale;
    keep(g);
  }

  /** True if the state of @a g is good; then it is kept. Elastic energy, which
   * costs a sweep over the springs, is looked at in every fourth call.
   * O(N + springs/4) */
  bool accept(const Cloth& g) {
    if (!good(g, ++checks_ % 4 == 0)) return false;
    keep(g);
    return true;
  }
  /** True if the state of @a g is good.
   * @param elastic whether elastic energy counts */
  bool good(const Cloth& g, bool elastic = true) const {
    double energy = kinetic_energy(g) + heights_energy(g);
    if (elastic) energy += elastic_energy(g);
    return energy <= limit_;  // not so if it is NaN
  }
  void keep(const Cloth& g) {
    auto x = g.positions();
    auto v = g.node_values();
    position_.assign(x.begin(), x.end());
    value_.assign(v.begin(), v.end());
  }

  /** Give @a g the positions and velocities of the last good state. Nodes added
   * since stay as they are, nodes removed since stay removed. */
  void restore(Cloth& g) const {
    for (Node n : g.nodes()) {
      if (n.id() >= position_.size()) continue;
      n.position() = position_[n.id()];
      n.value() = value_[n.id()];
    }
  }

 private:
  double gravity_, top_ = 0, limit_ = 0;
  long checks_ = 0;
  std::vector<Point> position_;
  std::vector<NodeData> value_;

  /** Gravitational energy [J], zero at the top of the cloth at the start, so
   * that removing a node that hangs below takes little energy away. */
  double heights_energy(const Cloth& g) const {
    return gravitational_energy(g, gravity_) - total_mass(g) * gravity_ * top_;
  }
};

/** The place where the state of a cloth is worst: the first node that is not
 * finite, or else the fastest one, and the most stretched spring there. */
struct WorstPlace {
  Node node;          ///< not valid if the cloth has none
  Edge spring;        ///< not valid if the node has none
  double speed = 0;   ///< of the node [m/s]; infinite if it has no number
  double length = 0;  ///< of the spring [m]; the same

  explicit WorstPlace(const Cloth& g) {
    double highest = -1;
    for (Node n : g.nodes()) {
      double v = norm(n.value().vel);
      if (!std::isfinite(v + norm(n.position()))) v = no_limit;
      if (v > highest) highest = v, node = n;
    }
    if (!g.has_node(node)) return;
    speed = highest;
    double longest = -1;
    for (Edge e : node.edges())
      if (double l = e.length(); !(l <= longest)) longest = l, spring = e;
    if (g.has_edge(spring))
      length = std::isfinite(longest) ? longest : no_limit;
  }

  std::string text(const Cloth& g) const {
    if (!g.has_node(node)) return "no node is left";
    std::ostringstream out;
    out << "node " << node.index();
    if (std::isfinite(speed))
      out << " moves at " << speed << " m/s";
    else
      out << " has a position or a velocity that is not finite";
    if (!g.has_edge(spring)) return out.str();
    out << ", its spring to node " << spring.node2().index() << " is ";
    if (!std::isfinite(length))
      out << "beyond all bounds";
    else if (double L = spring.value().L; L > 0)
      out << length / L << " times its rest length of " << L << " m";
    else
      out << length << " m long";
    return out.str();
  }
};

/** Why a run with this step failed, and what would do instead; in words.
 * @param sharp the limit [s] of the method in the last good shape
 * @param safe its limit in any shape   @param verlet that of Verlet */
inline std::string why_it_failed(const MethodInfo& info, double dt,
                                 double sharp, double safe, double verlet) {
  std::ostringstream out;
  out.precision(3);
  auto instead = [&](double limit) {
    out << "--dt " << safe_share * limit << " or --dt auto works";
  };
  if (info.limit == no_limit || info.limit == 0 || info.adaptive) {
    out << info.name << " fails with: " << info.fails_when;
    if (std::isfinite(verlet)) {
      out << " (dt is " << dt / verlet << " times verlet's limit); --method "
          << "verlet with ";
      instead(verlet);
    }
  } else if (dt > 0.97 * sharp || dt > safe) {
    const double limit = dt > 0.97 * sharp ? sharp : safe;
    out << "dt is " << dt / limit << " times the limit of " << info.name << ", "
        << limit << " s" << (limit == sharp ? " in this shape" : "")
        << ": the fastest waves in the springs grow in every step; ";
    instead(safe);
  } else {
    out << "not the springs: dt is " << dt / safe << " of the limit of "
        << info.name
        << "; look at what moves nodes besides, and at: " << info.fails_when;
  }
  return out.str();
}
