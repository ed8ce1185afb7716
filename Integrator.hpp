#pragma once
/** @file Integrator.hpp
 * Steps in time. Each takes the cloth from t to t + dt and returns t + dt. The
 * order within a step: positions, constraints, forces, velocities. */
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "Cloth.hpp"
#include "Constraint.hpp"
#include "Force.hpp"
#include "Sweep.hpp"

/** One step of symplectic Euler, as the assignment writes it down:
 *   x += dt v;   v += dt F(x, t) / m.
 * Nodes that lie exactly at a corner, (0,0,0) or (1,0,0), are skipped
 * (section 5.2): they do not move.
 * @param g  a graph whose node values have vel [m/s] and mass [kg]
 * @param t  time at the start of the step [s]   @param dt step [s]
 * @param force  Point(Node, double): the force [N] on a node at time t
 * @return t + dt
 * Complexity: a call of @a force for each node.
 * Order 1; bounded while dt omega < 2 for every frequency omega [1/s]. */
template <typename G, typename F>
double symp_euler_step(G& g, double t, double dt, F&& force) {
  for (auto n : g.nodes())
    if (!is_corner(n.position())) n.position() += dt * n.value().vel;
  for (auto n : g.nodes())
    if (!is_corner(n.position()))
      n.value().vel += (dt / n.value().mass) * force(n, t);
  return t + dt;
}

/** The same with a constraint (section 6.2), and no node is skipped:
 *   x += dt v;   constrain;   v += dt F(x, t) / m.
 * @param constraint  void(G&, double), called once; it may remove nodes */
template <typename G, typename F, typename C>
double symp_euler_step(G& g, double t, double dt, F&& force, C&& constraint) {
  for (auto n : g.nodes()) n.position() += dt * n.value().vel;
  constraint(g, t);
  for (auto n : g.nodes()) n.value().vel += (dt / n.value().mass) * force(n, t);
  stop_held(g, constraint);
  return t + dt;
}

/** What a method says about itself; the tests hold it to that. */
struct MethodInfo {
  const char* name;
  int order;     ///< error ~ dt^order
  int sweeps;    ///< force sweeps a step
  double limit;  ///< bounded while dt omega < limit, without drag
  const char* source;
  const char* good_for;
  const char* fails_when;
  bool adaptive = false;  ///< steps inside a step: dt does not bound them
};
inline constexpr double no_limit = std::numeric_limits<double>::infinity();

/** A method: takes a cloth from t to t + dt, as often as it is called.
 *
 * Its constraint is called once a step, when the positions have reached t +
 * dt, and before the force there is taken; held nodes stay at rest in between.
 * Or else, if it mends by node, part by part, each before a force sees it.
 * Nodes may be removed by it, and between steps. No allocation in a step, but
 * for the first one and when the cloth grew.
 *
 * A method may keep the force at the end of a step for the next one: whoever
 * moves nodes between two steps calls restart(). */
class Method {
 public:
  virtual ~Method() = default;

  /** One step from @a t by @a dt [s].  @return t + dt   @pre dt > 0
   * Throws StepError if the method can't make it; std::invalid_argument if it
   * can't do with this force. */
  virtual double step(Cloth& g, double t, double dt, const ZeroForce& force,
                      const ZeroConstraint& constraint) = 0;
  /** Forget what was kept from the last step. */
  virtual void restart() {}

  /** The call of symp_euler_step(): any force, any constraint. */
  template <typename F, typename C = ZeroConstraint>
  double operator()(Cloth& g, double t, double dt, F&& force,
                    C&& constraint = C()) {
    return step(g, t, dt, as<ZeroForce, FunctionForce>(force),
                as<ZeroConstraint, FunctionConstraint>(constraint));
  }

 private:
  /** @a x itself if it is a Base, else a Base that calls it. */
  template <typename Base, template <typename> class Adapter, typename T>
  static decltype(auto) as(T& x) {
    if constexpr (std::derived_from<std::remove_const_t<T>, Base>)
      return static_cast<const Base&>(x);
    else
      return Adapter([&x]<typename... Args>(Args&&... args) {
        return x(std::forward<Args>(args)...);
      });
  }
};

/** A method by its name: a line of the table in Methods.hpp. */
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<Method> (*make)();
};
template <typename M>
constexpr MethodEntry entry_of() {
  return {M::info, [] { return std::unique_ptr<Method>(new M()); }};
}

namespace integrator_detail {

/** x += h v for @a blocks of lanes::width nodes. */
struct DriftBlocks {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(Point* position,
                                                  const NodeData* node,
                                                  unsigned blocks, Real h) {
    using namespace lanes;
    constexpr int w = count_of<V>;
    for (unsigned i = 0; i < blocks * width; i += w) {
      Real* x = &position[i].x;
      const Real* v = &node[i].vel.x;
      const V v0 = load<V>(v), v1 = load<V>(v + w), v2 = load<V>(v + 2 * w),
              v3 = load<V>(v + 3 * w);
      store(x, load<V>(x) + h * without_fourth<0>(v0, v1));
      store(x + w, load<V>(x + w) + h * without_fourth<1>(v1, v2));
      store(x + 2 * w, load<V>(x + 2 * w) + h * without_fourth<2>(v2, v3));
    }
  }
};

/** v += h f/m for @a blocks of lanes::width nodes. */
struct KickBlocks {
  template <typename V>
  [[gnu::always_inline]] static inline void apply(NodeData* node,
                                                  const Point* force,
                                                  unsigned blocks, Real h) {
    using namespace lanes;
    constexpr int w = count_of<V>;
    for (unsigned i = 0; i < blocks * width; i += w) {
      Real* row = &node[i].vel.x;
      const Real* f = &force[i].x;
      const V f0 = load<V>(f), f1 = load<V>(f + w), f2 = load<V>(f + 2 * w);
      const V v0 = load<V>(row), v1 = load<V>(row + w),
              v2 = load<V>(row + 2 * w), v3 = load<V>(row + 3 * w);
      const V per_f = h / first_halves(masses(v0, v1), masses(v2, v3));
      store(row, v0 + spread<0>(per_f) * with_fourth<0>(f0, f1, f2));
      store(row + w, v1 + spread<1>(per_f) * with_fourth<1>(f0, f1, f2));
      store(row + 2 * w, v2 + spread<2>(per_f) * with_fourth<2>(f0, f1, f2));
      store(row + 3 * w, v3 + spread<3>(per_f) * with_fourth<3>(f0, f1, f2));
    }
  }

 private:
  /** The masses in two rows of v v v m v v v m ..., in the first half. */
  template <typename V>
  [[gnu::always_inline]] static inline V masses(const V& a, const V& b) {
    constexpr int w = lanes::count_of<V>;
    return lanes::shuffle(a, b,
                          [](int k) { return k < w / 2 ? 4 * k + 3 : 0; });
  }
  /** Part @a part of a0 a0 a0 0 a1 a1 a1 0 ... */
  template <int part, typename V>
  [[gnu::always_inline]] static inline V spread(const V& a) {
    constexpr int w = lanes::count_of<V>;
    return lanes::shuffle(a, V{}, [](int k) {
      const int place = part * w + k;
      return place % 4 < 3 ? place / 4 : w;
    });
  }
};

/** The flow of x' = v, m v' = -c v over @a h, solved exactly; h may be < 0. */
inline void drift(Cloth& g, const Part& part, double h, double c) {
  Point* x = g.positions().data();
  NodeData* node = g.node_values().data();
  unsigned i = part.first;
  if (c == 0) {
    const unsigned blocks = (part.last - part.first) / lanes::width;
    lanes::run<DriftBlocks>(x + i, node + i, blocks, Real(h));
    for (i += blocks * lanes::width; i < part.last; ++i)
      x[i] += h * node[i].vel;
    return;
  }
  double mass = 0, decay = 1, way = h;  // most nodes weigh the same
  for (; i < part.last; ++i) {
    if (node[i].mass != mass) {
      mass = node[i].mass;
      way = -std::expm1(-c / mass * h) * mass / c;
      decay = std::exp(-c / mass * h);
    }
    x[i] += way * node[i].vel;
    node[i].vel *= decay;
  }
}

/** v += h f / m.  @param f [N], that on part.first first */
inline void kick(Cloth& g, const Part& part, double h,
                 std::span<const Point> f) {
  NodeData* node = &g.node_values()[part.first];
  const unsigned count = part.last - part.first;
  const unsigned blocks = count / lanes::width;
  lanes::run<KickBlocks>(node, f.data(), blocks, Real(h));
  for (unsigned k = blocks * lanes::width; k < count; ++k)
    node[k].vel += (h / node[k].mass) * f[k];
}

/** Take linear drag, which drift() takes care of, out of @a f. */
inline void without_drag(const Part& part, const ZeroForce& force,
                         std::span<Point> f) {
  const double c = force.drag();
  if (c == 0) return;
  const NodeData* node = &part.g.node_values()[part.first];
  for (unsigned k = 0; k < part.last - part.first; ++k) f[k] += c * node[k].vel;
}

/** @a move(part) for all parts of @a g; then the constraint; then all forces
 * at time @a t, and @a use(part, forces on it). In one way through memory if
 * the constraint mends node by node.
 * @param f none, or a list for all forces, by node id */
template <typename Move, typename Use, typename... List>
void move_and_sweep(Sweep& sweep, Cloth& g, double t, const ZeroForce& force,
                    const ZeroConstraint& constraint, Move move, Use use,
                    List&... f) {
  if (constraint.by_node()) {
    auto move_and_mend = [&](const Part& part) {
      move(part);
      constraint.mend(g, t, part.first, part.last);
    };
    sweep.after(move_and_mend, g, t, force, f..., use);
  } else {
    sweep.parts(g, move);
    constraint(g, t);
    sweep(g, t, force, f..., use);
  }
}

/** All forces but linear drag into @a f, by node id. */
inline void sweep_without_drag(Sweep& sweep, const Cloth& g, double t,
                               const ZeroForce& force, std::vector<Point>& f) {
  sweep(g, t, force, f, [&](const Part& part, std::span<Point> here) {
    without_drag(part, force, here);
  });
}

}  // namespace integrator_detail

/** The assignment's step as a method, for speed: all forces in one sweep.
 * Equal to symp_euler_step() with a constraint, to round-off; like there, drag
 * is a force like others, and force and constraint are called with t. */
class SymplecticEuler : public Method {
 public:
  static constexpr MethodInfo info = {"symplectic-euler",
                                      1,
                                      1,
                                      2,
                                      "the assignment",
                                      "a first look; energy stays bounded",
                                      "accuracy counts: verlet costs the same"};

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    using namespace integrator_detail;
    move_and_sweep(
        sweep_, g, t, force, constraint,
        [&](const Part& part) { drift(g, part, dt, 0); },
        [&](const Part& part, std::span<const Point> f) {
          kick(g, part, dt, f);
        });
    stop_held(g, constraint);
    return t + dt;
  }

 private:
  Sweep sweep_;
};

/** A splitting method: A moves the positions (and lets drag slow the nodes
 * down, exactly), B kicks the velocities, in turn, by fractions of dt. Time
 * runs in A. Symmetric and symplectic (without drag), so energy is bounded and
 * a run can be taken back.
 *
 * @tparam Scheme has the fractions, `constexpr std::array steps`, kicks_first
 *         (whether they begin and end with B) and info. One that begins with B
 *         needs one sweep less: the last kick's force is the next first one's.
 */
template <typename Scheme>
class Splitting : public Method {
 public:
  static constexpr MethodInfo info = Scheme::info;

  double step(Cloth& g, double t, double dt, const ZeroForce& force,
              const ZeroConstraint& constraint) override {
    using namespace integrator_detail;
    constexpr auto& steps = Scheme::steps;
    constexpr std::size_t first_drift = Scheme::kicks_first ? 1 : 0;
    const double c = force.drag();
    if (Scheme::kicks_first) {
      const auto first_kick = [&](const Part& part, std::span<const Point> f) {
        kick(g, part, steps[0] * dt, f);
      };
      if (kept(g, t, dt))
        sweep_.parts(g, [&](const Part& part) {
          first_kick(part, std::span(force_).subspan(part.first));
        });
      else
        sweep_(g, t, force, force_, [&](const Part& part, std::span<Point> f) {
          without_drag(part, force, f);
          first_kick(part, f);
        });
      stop_held(g, constraint);
    }
    double now = t;
    for (std::size_t k = first_drift; k < steps.size(); k += 2) {
      const double h = steps[k] * dt;
      const auto move = [&](const Part& part) { drift(g, part, h, c); };
      const bool is_last = k + 2 >= steps.size();
      now = is_last ? t + dt : now + h;
      const ZeroConstraint none;  // but after the last drift
      const ZeroConstraint& now_holds = is_last ? constraint : none;
      if (k + 1 == steps.size()) {
        sweep_.parts(g, move);
        now_holds(g, now);
        break;
      }
      move_and_sweep(
          sweep_, g, now, force, now_holds, move,
          [&](const Part& part, std::span<Point> f) {
            without_drag(part, force, f);
            kick(g, part, steps[k + 1] * dt, f);
          },
          force_);
      stop_held(g, constraint);
    }
    if (Scheme::kicks_first)
      kept_for_ = &g, kept_version_ = g.version(), kept_time_ = t + dt;
    return t + dt;
  }
  void restart() override { kept_for_ = nullptr; }

 private:
  Sweep sweep_;
  std::vector<Point> force_;         // [N], by node id, without drag
  const Cloth* kept_for_ = nullptr;  // the cloth at whose state force_ is
  std::uint64_t kept_version_ = 0;
  double kept_time_ = 0;

  bool kept(const Cloth& g, double t, double dt) const {
    // A caller may add up its times or multiply them: that is the same time.
    return kept_for_ == &g && kept_version_ == g.version() &&
           std::abs(t - kept_time_) < 1e-6 * dt;
  }
};

/** Half a kick, a drift, half a kick. Symplectic Euler is this method with
 * half a kick missing at the start.
 * Source: L. Verlet, Phys. Rev. 159 (1967) 98. */
struct VerletScheme {
  static constexpr MethodInfo info = {
      "verlet",
      2,
      1,
      2,
      "Verlet 1967",
      "contact, tearing, tolerances down to 1e-3",
      "high accuracy is wanted; stiff cloth"};
  static constexpr bool kicks_first = true;
  static constexpr std::array steps = {0.5, 1.0, 0.5};
};
using Verlet = Splitting<VerletScheme>;

/** Three Verlet steps, the middle one backwards.
 * Source: H. Yoshida, Phys. Lett. A 150 (1990) 262; E. Forest, R. D. Ruth,
 * Physica D 43 (1990) 105. */
struct Yoshida4Scheme {
  static constexpr MethodInfo info = {
      "yoshida4",
      4,
      3,
      1.5734,
      "Yoshida 1990",
      "being well known",
      "pefrl is at hand: less error, longer steps"};
  static constexpr bool kicks_first = true;
  static constexpr double w1 = 1.3512071919596578;  // 1/(2 - 2^(1/3))
  static constexpr double w0 = 1 - 2 * w1;
  static constexpr std::array steps = {w1 / 2,        w1, (w0 + w1) / 2, w0,
                                       (w0 + w1) / 2, w1, w1 / 2};
};
using Yoshida4 = Splitting<Yoshida4Scheme>;

/** Source: I. P. Omelyan, I. M. Mryglod, R. Folk, Comput. Phys. Commun. 146
 * (2002) 188, "PEFRL". */
struct PefrlScheme {
  static constexpr MethodInfo info = {
      "pefrl",
      4,
      4,
      2.9894,
      "Omelyan, Mryglod, Folk 2002",
      "smooth motion, errors from 1e-3 to 1e-8",
      "contact and tearing: no better than verlet, and dearer"};
  static constexpr bool kicks_first = false;
  static constexpr double xi = 0.1786178958448091;
  static constexpr double lambda = -0.2123418310626054;
  static constexpr double chi = -0.06626458266981849;
  static constexpr std::array steps = {xi,     0.5 - lambda,       chi,
                                       lambda, 1 - 2 * (chi + xi), lambda,
                                       chi,    0.5 - lambda,       xi};
};
using Pefrl = Splitting<PefrlScheme>;

/** Runge-Kutta-Nystroem splitting of order 4 with 6 kicks.
 * Source: S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313. */
struct Srkn6bScheme {
  static constexpr MethodInfo info = {
      "srkn6b",
      4,
      6,
      5.0269,
      "Blanes, Moan 2002",
      "smooth motion, errors from 1e-5 to 1e-9",
      "contact and tearing; near dt omega = 3.16 without drag"};
  static constexpr bool kicks_first = true;
  static constexpr double b1 = .0829844064174052, a1 = .245298957184271,
                          b2 = .396309801498368, a2 = .604872665711080,
                          b3 = -.0390563049223486, a3 = 0.5 - a1 - a2,
                          b4 = 1 - 2 * (b1 + b2 + b3);
  static constexpr std::array steps = {b1, a1, b2, a2, b3, a3, b4,
                                       a3, b3, a2, b2, a1, b1};
};
using Srkn6b = Splitting<Srkn6bScheme>;

/** Runge-Kutta-Nystroem splitting of order 6 with 11 kicks. Source: as above.
 */
struct Srkn11bScheme {
  static constexpr MethodInfo info = {
      "srkn11b",
      6,
      11,
      9.0736,
      "Blanes, Moan 2002",
      "references: errors below 1e-8",
      "contact and tearing; near dt omega = pi, 2 pi without drag"};
  static constexpr bool kicks_first = true;
  static constexpr double b1 = .0414649985182624, b2 = .198128671918067,
                          b3 = -.0400061921041533, b4 = .0752539843015807,
                          b5 = -.0115113874206879,
                          b6 = 0.5 - (b1 + b2 + b3 + b4 + b5);
  static constexpr double a1 = .123229775946271, a2 = .290553797799558,
                          a3 = -.127049212625417, a4 = -.246331761062075,
                          a5 = .357208872795928,
                          a6 = 1 - 2 * (a1 + a2 + a3 + a4 + a5);
  static constexpr std::array steps = {b1, a1, b2, a2, b3, a3, b4, a4,
                                       b5, a5, b6, a6, b6, a5, b5, a4,
                                       b4, a3, b3, a2, b2, a1, b1};
};
using Srkn11b = Splitting<Srkn11bScheme>;
