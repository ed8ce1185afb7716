/** @file cloth.cpp
 * The cloth of a Graph.hpp and a mass_spring.hpp for a web page: the stages of
 * mass_spring.cpp, on a grid. WebAssembly has C functions alone; a pointer that
 * one returns is valid until the next call. A throw ends its call: thrown.cpp.
 *
 * A slot is a node's index at the start, which it keeps. */
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "CME212/Energy.hpp"
#include "CME212/PageData.hpp"
#include "CME212/viewer/Faces.hpp"
#include "mass_spring.hpp"

#ifndef WEB_STAGES
#define WEB_STAGES 5  // 2: those that need no code of section 5 and later
#endif

namespace web {  // a student's names do not meet these

enum Stage { problem1, diagonals, forces, constraints, tear };

/** Half a metre down from a corner that is held. */
std::vector<Point> line_points(unsigned count) {
  std::vector<Point> points;
  for (unsigned i = 0; i < count; ++i)
    points.push_back(Point(0, 0, -0.5 * i / (count - 1)));
  return points;
}

template <typename G>
void cut_edge(G& g, const Node& a, const Node& b) {
  if constexpr (requires { g.remove_edge(a, b); }) g.remove_edge(a, b);
}

class Run {
 public:
  /** @param chain so many nodes, hanging in a line, in place of a grid; or 0
   * @pre stage < WEB_STAGES, side >= 2, dt > 0, chain != 1 */
  Run(Stage stage, unsigned side, double dt, unsigned chain)
      : dt_(dt),
        points_(chain > 0 ? line_points(chain) : grid_points(side)),
        quads_(chain > 0 ? std::vector<Quad>() : grid_quads(side)) {
    build_cloth(
        g, points_, quads_,
        stage == problem1 ? MeshSprings::plain : MeshSprings::diagonals);
    for (unsigned i = 1; i < chain; ++i) g.add_edge(g.node(i - 1), g.node(i));
    for (unsigned i = 0; i < num_nodes(); ++i) slots_.push_back(i);
    if (g.num_edges() > 0) length_ = CME212::length(*g.edge_begin());
    if (stage != problem1) length_ = 0;  // each has its own
    make_step(stage);
    // As in mass_spring.cpp; five seconds are its time.
    bound_ = CME212::divergence_energy(g, energies().total(), grav, dt, 5);
  }
  Run(const Run&) = delete;

  /** @return the time reached [s] */
  double step() {
    save_places();
    t_ = step_(t_);
    follow();
    ++steps_;
    if (gain_at_ < 0 && !(energies().total() <= bound_)) gain_at_ = t_;
    for (Node n : nodes(g))
      if (!(norm_inf(n.position()) < far)) failed_ = int(slots_[n.index()]);
    return t_;
  }
  /** Kinetic, elastic, potential energy [J], nodes, edges, time [s], steps,
   * the time [s] at which it gained energy from nothing or -1, the node that
   * is too far away or -1. */
  std::array<double, 9> readings() {
    const auto [kinetic, none, height] = energies();
    return {kinetic,
            CME212::elastic_energy(g, [this](Edge e) { return spring(e); }),
            height,
            double(num_nodes()),
            double(num_edges()),
            t_,
            double(steps_),
            gain_at_,
            double(failed_)};
  }

  void set_step(double dt) { dt_ = dt; }
  void grab(unsigned slot, const Point& target) {
    hand_ = int(slot), target_ = target;
  }
  void move_hand(const Point& target) { target_ = target; }
  void release() { hand_ = -1; }
  /** Remove the edges between two rays.
   * @return how many of them the student's remove_edge() left */
  unsigned cut(const CME212::Ray& from, const CME212::Ray& to) {
    std::vector<CME212::Ends> crossed;
    for (Edge e : edges(g))
      if (CME212::meets(e.node1().position(), e.node2().position(), from, to))
        crossed.push_back(
            {unsigned(e.node1().index()), unsigned(e.node2().index())});
    const unsigned before = num_edges();
    for (const auto [i, j] : crossed) cut_edge(g, g.node(i), g.node(j));
    return unsigned(crossed.size()) - (before - num_edges());
  }

  unsigned slots() const { return unsigned(points_.size()); }
  /** By index. */
  const std::vector<Point>& places() {
    save_places();
    return places_;
  }
  /** x y z [m] and the largest strain of a spring there, for each slot. */
  const std::vector<float>& drawn() {
    CME212::set_page_points(
        drawn_, points_.size(), nodes(g), edges(g),
        [this](const Node& n) { return slots_[n.index()]; },
        [this](Edge e) { return spring(e).L; });
    return drawn_;
  }
  /** Counts up when mesh() would be another one. */
  double version() {
    const std::array now = {num_nodes(), num_edges()};
    if (std::exchange(counts_, now) != now) ++version_;
    return version_;
  }
  /** The numbers of edges, triangles and pins; then the slots of each. */
  const std::vector<unsigned>& mesh() {
    std::vector<CME212::Ends> ends;
    for (Edge e : edges(g)) {
      const auto [low, high] =
          std::minmax({slots_[e.node1().index()], slots_[e.node2().index()]});
      ends.push_back({low, high});
    }
    std::vector<unsigned> pins;
    for (unsigned slot : slots_)
      if (is_corner(points_[slot])) pins.push_back(slot);
    mesh_ = CME212::page_mesh(
        ends, CME212::faces_left(quads_, ends, points_.size()), pins);
    return mesh_;
  }

 private:
  static constexpr double far = 20;  // [m]

  // A graph may count by another type.
  unsigned num_nodes() const { return unsigned(g.num_nodes()); }
  unsigned num_edges() const { return unsigned(g.num_edges()); }

  void make_step(Stage stage) {
    if (stage == problem1)
      step_ = stepped(Problem1Force(100, length_));
    else if (stage == diagonals)
      step_ = stepped(Problem1Force());
#if WEB_STAGES > 2
    const auto force = make_combined_force(GravityForce(), MassSpringForce());
    const auto on_ball = make_combined_constraints(
        PinConstraint(g), PlaneConstraint(), SphereConstraint());
    if (stage == forces)
      step_ = stepped(force);
    else if (stage == constraints)
      step_ = stepped(force, [on_ball] { return on_ball; });
    else if (stage == tear)
      // Made for each step: where a Node is an index, a removal moves it.
      step_ = stepped(force, [this] {
        return make_combined_constraints(PinConstraint(g), PlaneConstraint(),
                                         TearConstraint());
      });
#endif
  }
  /** The step with this force, and with the hand. */
  template <typename F>
  auto pulled(F force) {
    return [this, force = std::make_shared<F>(std::move(force))](auto n,
                                                                 double t) {
      Point f = (*force)(n, t);
      if (hand_ >= 0 && slots_[n.index()] == unsigned(hand_)) f += pull(n);
      return f;
    };
  }
  template <typename F>
  std::function<double(double)> stepped(F force) {
    return [this, f = pulled(std::move(force))](double t) {
      return symp_euler_step(g, t, dt_, f);
    };
  }
#if WEB_STAGES > 2
  /** @param make returns the constraint of the next step */
  template <typename F, typename Make>
  std::function<double(double)> stepped(F force, Make make) {
    return [this, f = pulled(std::move(force)), make](double t) {
      auto constraint = make();
      return symp_euler_step(g, t, dt_, f, [&](Cloth& cloth, double time) {
        save_places();
        constraint(cloth, time);
        follow();
      });
    };
  }
#endif
  /** An eighth of the springs' K, at most twice the weight of the cloth. */
  Point pull(Node n) const {
    double K = 0;
    for (Edge e : edges(n)) K += spring(e).K;
    const double most = 2 * grav;  // the cloth has 1 kg
    return CME212::hand_pull(K / 8, target_ - n.position(), most);
  }

  struct Spring {
    double K, L;
  };
  Spring spring(Edge e) const {
    if (length_ > 0) return {100, length_};
    return {double(e.value().K), double(e.value().L)};
  }
  /** Without that of springs. */
  CME212::Energies energies() const {
    return CME212::motion_energy(g, grav, is_corner);
  }

  int index_of(unsigned slot) const {
    const auto at = std::find(slots_.begin(), slots_.end(), slot);
    return at == slots_.end() ? -1 : int(at - slots_.begin());
  }
  void save_places() {
    places_.clear();
    for (Node n : nodes(g)) places_.push_back(n.position());
  }
  /** After a removal: find the slot of each node by its place before. A node
   * that has moved since gets the nearest place. A Node may be an index. */
  void follow() {
    if (num_nodes() == slots_.size()) return;
    std::multimap<std::array<double, 3>, unsigned> left;
    const auto key = [](const Point& p) { return std::array{p.x, p.y, p.z}; };
    for (unsigned i = 0; i < slots_.size(); ++i)
      left.emplace(key(places_[i]), slots_[i]);
    slots_.assign(num_nodes(), 0);
    std::vector<Node> moved;
    for (Node n : nodes(g)) {
      const auto at = left.find(key(n.position()));
      if (at == left.end()) {
        moved.push_back(n);
      } else {
        slots_[n.index()] = at->second;
        left.erase(at);
      }
    }
    for (Node n : moved) {
      const auto distance = [&](const auto& item) {
        return normSq(n.position() -
                      Point(item.first[0], item.first[1], item.first[2]));
      };
      const auto at = std::min_element(
          left.begin(), left.end(),
          [&](auto& a, auto& b) { return distance(a) < distance(b); });
      if (at == left.end()) return;  // a node was added
      slots_[n.index()] = at->second;
      left.erase(at);
    }
    save_places();
    if (hand_ >= 0 && index_of(unsigned(hand_)) < 0) release();
  }

  Cloth g;
  double t_ = 0, dt_;  // [s]
  double length_ = 0;  // rest length of all springs [m], or 0
  double bound_ = 0, gain_at_ = -1;
  unsigned steps_ = 0;
  int hand_ = -1, failed_ = -1;  // slots
  Point target_;
  std::vector<Point> points_, places_;
  std::vector<Quad> quads_;
  std::vector<unsigned> slots_, mesh_;  // slots_ by index
  std::vector<float> drawn_;
  std::array<unsigned, 2> counts_ = {};
  double version_ = 0;
  std::function<double(double)> step_;
};

std::unique_ptr<Run> run;

}  // namespace web

extern "C" {

using web::run;

unsigned page_stages() { return WEB_STAGES; }
void page_start(unsigned stage, unsigned side, double dt, unsigned chain) {
  run.reset();
  run = std::make_unique<web::Run>(web::Stage(stage), side, dt, chain);
}
double page_step() { return run->step(); }
void page_set_step(double dt) { run->set_step(dt); }
const double* page_readings() {
  static std::array<double, 9> all;
  all = run->readings();
  return all.data();
}

void page_grab(unsigned slot, double x, double y, double z) {
  run->grab(slot, Point(x, y, z));
}
void page_move(double x, double y, double z) { run->move_hand(Point(x, y, z)); }
void page_release() { run->release(); }
/** @param a, b the near and far end of a ray; c, d of another one */
unsigned page_stroke(double ax, double ay, double az, double bx, double by,
                     double bz, double cx, double cy, double cz, double dx,
                     double dy, double dz) {
  return run->cut({Point(ax, ay, az), Point(bx, by, bz)},
                  {Point(cx, cy, cz), Point(dx, dy, dz)});
}

unsigned page_nodes() { return unsigned(run->places().size()); }
unsigned page_slots(unsigned) { return run ? run->slots() : 0; }
const float* page_points(unsigned) { return run->drawn().data(); }
const double* page_positions(unsigned) { return &run->places().data()->x; }
double page_version(unsigned) { return run->version(); }
const unsigned* page_mesh(unsigned) { return run->mesh().data(); }
}
