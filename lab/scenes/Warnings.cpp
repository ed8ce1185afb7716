#include "lab/scenes/Warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "CME212/BoundingBox.hpp"
#include "CME212/MeshFaults.hpp"
#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

namespace {

using CME212::count_of;
using CME212::short_text, lab::short_text;
using Triangle = std::array<Point, 3>;

std::string it_or_them(std::size_t n) { return n == 1 ? "it" : "them"; }

/** The option that makes @a b, with its default values. */
std::string name_of(const std::string& option, const Ball& b) {
  return "--" + option + " \"at " + short_text(b.center) + " radius " +
         short_text(b.radius) + '"';
}

/** @a q as two triangles, divided by its shorter diagonal. Corner c has the
 * neighbors c ^ 1 and c ^ 2. */
std::array<Triangle, 2> halves(const Net& mesh, const Quad& q) {
  const auto p = [&](unsigned c) { return mesh.points[q[c]]; };
  if (norm(p(3) - p(0)) <= norm(p(2) - p(1)))
    return {{{p(0), p(3), p(1)}, {p(0), p(3), p(2)}}};
  return {{{p(1), p(2), p(0)}, {p(1), p(2), p(3)}}};
}

/** The largest distance of a point of @a t from its nearest corner [m]: the
 * circumradius if the circumcenter lies inside. Otherwise the farthest point
 * lies on the longest side, as far from one of its ends as from the third
 * corner. */
double opening(const Triangle& t) {
  std::array<double, 3> side;
  for (unsigned c : {0, 1, 2}) side[c] = norm(t[(c + 1) % 3] - t[(c + 2) % 3]);
  std::ranges::sort(side);
  const auto [a, b, c] = side;
  if (a == 0) return c / 2;
  const double cos_b = (a * a + c * c - b * b) / (2 * a * c);
  const double cos_a = (b * b + c * c - a * a) / (2 * b * c);
  if (a * a + b * b <= c * c) return std::max(a / (2 * cos_b), b / (2 * cos_a));
  return a / (2 * std::sqrt(std::max(0., 1 - cos_a * cos_a)));
}

class Finder {
 public:
  Finder(const Model& m, const Net& mesh, const Cloth& g, double dt)
      : m_(m), mesh_(mesh), g_(g), dt_(dt) {
    for (const Quad& q : mesh.quads) openings_.push_back(opening(mesh, q));
  }

  std::vector<std::string> all() {
    found_ = mesh_.notes;
    if (m_.sheets.size() != 1) faults_of_the_mesh();
    springs_of_no_length();
    nothing_held();
    without_effect();
    for (const Wall& w : m_.planes) below(w);
    for (const Solid& s : m_.spheres) {
      const std::string name = name_of("sphere", s.ball);
      inside(s.ball, name, true);
      fits_through(s.ball, name);
      too_fast(s);
    }
    for (const Ball& b : m_.tears) {
      const std::string name = name_of("tear", b);
      inside(b, name, false);
    }
    if (m_.self_collision) passes_itself(*m_.self_collision);
    if (m_.method->info.adaptive) not_smooth(), below_round_off();
    return found_;
  }

 private:
  const Model& m_;
  const Net& mesh_;
  const Cloth& g_;
  double dt_;
  std::vector<double> openings_;  // by quad [m]
  std::vector<std::string> found_;

  void add(const std::string& sentence) { found_.push_back(sentence); }
  /** Quads whose opening is wider than a ball of radius @a r [m], and the
   * widest. */
  struct Wide {
    std::size_t quads = 0;
    double most = 0;  // [m]
  };
  Wide wider_than(double r) const {
    Wide w;
    for (double a : openings_)
      if (a > r * (1 + 1e-6)) ++w.quads, w.most = std::max(w.most, a);
    return w;
  }
  std::string of_all(std::size_t quads) const {
    return std::to_string(quads) + " of " +
           count_of(mesh_.quads.size(), face_or_quad(mesh_.quads));
  }

  void faults_of_the_mesh() {
    std::vector<std::array<unsigned, 2>> springs;
    for (const Spring& spring : mesh_.springs)
      springs.push_back({spring.i, spring.j});
    std::ranges::move(mesh_faults(mesh_.points, mesh_.quads, springs),
                      std::back_inserter(found_));
    const double size = CME212::BoundingBox(mesh_.points).diagonal();
    if (m_.sheets.empty() && size > 50)
      add("the cloth is " + short_text(size) +
          " m large: if its file is in mm or cm, divide the coordinates by "
          "1000 or 100");
  }

  void springs_of_no_length() {
    std::size_t n = 0;
    Edge first;
    for (Edge e : g_.edges())
      if (e.value().L == 0 && e.length() == 0 && n++ == 0) first = e;
    if (n == 0) return;
    add(count_of(n, "spring") + (n == 1 ? " has" : " have") +
        " length 0: nodes " + std::to_string(first.node1().index()) + " and " +
        std::to_string(first.node2().index()) +
        " are at the same point, and no spring force keeps them apart; " +
        "make them one node");
  }

  void without_effect() {
    const Model usual;
    if (!mesh_.quads.empty() && !mesh_.bare_faces) return;
    const std::string changes_nothing = " changes nothing: ";
    if (to_words(m_.edges) != to_words(usual.edges))
      add("--edges" + changes_nothing + "no face gives springs");
    const auto has_K = [](const Spring& s) { return s.K >= 0; };
    const auto* const option = m_.material.modulus               ? "--modulus"
                               : m_.stiffness != usual.stiffness ? "--stiffness"
                                                                 : "";
    if (*option && std::ranges::all_of(mesh_.springs, has_K))
      add(option + changes_nothing + "each spring of the net has its own K");
  }

  void nothing_held() {
    const auto held = points_held(m_, mesh_);
    const auto none = [](const auto& nodes) { return nodes.empty(); };
    if (m_.sheets.empty() && m_.gravity != 0 && m_.planes.empty() &&
        m_.spheres.empty() && std::ranges::all_of(held, none))
      add("nothing holds the cloth, and nothing is below it: it falls; pin it, "
          "for example by --pin \"node 0\"");
    if (!m_.is_assignment()) return;
    for (std::size_t k = 0; k < m_.pins.size(); ++k)
      if (held[k].empty())
        add("no node lies at " + to_words(m_.pins[k]) +
            ", which the assignment's scene pins; pin this cloth, for example "
            "by --pin \"x 0\"");
  }

  void below(const Wall& w) {
    std::size_t n = 0;
    double deepest = 0;
    for (const Point& p : mesh_.points) {
      const double depth = w.depth(p);
      if (depth > 1e-9) ++n;
      deepest = std::max(deepest, depth);
    }
    if (n == 0) return;
    Wall lower = w;
    lower.at -= deepest * w.out();
    add(std::to_string(n) + " of " + count_of(mesh_.points.size(), "node") +
        (n == 1 ? " starts" : " start") + " below --plane \"" + to_words(w) +
        "\", up to " + short_text(deepest) + " m: the plane moves " +
        it_or_them(n) + " up at t = 0; to avoid that, put it at " +
        short_text(lower.at));
  }

  void inside(const Ball& b, const std::string& name, bool solid) {
    std::size_t n = 0;
    const auto is_inside = [&](const Point& p) {
      return norm(p - b.center) < b.radius * (1 - 1e-6);
    };
    for (const Point& p : mesh_.points) n += is_inside(p);
    if (n == 0) return;
    add(std::to_string(n) + " of " + count_of(mesh_.points.size(), "node") +
        (n == 1 ? " starts" : " start") + " inside " + name + ": " +
        (solid
             ? "the ball moves " + it_or_them(n) +
                   " to its surface at t = 0; move the ball"
             : "the first step removes " + it_or_them(n) + "; move the ball"));
  }

  void fits_through(const Ball& b, const std::string& name) {
    constexpr double stretched = 1.5;
    const Wide now = wider_than(b.radius);
    const Wide wide = now.quads > 0 ? now : wider_than(b.radius / stretched);
    if (wide.quads == 0) return;
    add(name + " fits through the openings of " + of_all(wide.quads) +
        (now.quads > 0 ? ""
                       : " where springs are stretched by " +
                             CME212::percent(b.radius / wide.most - 1)) +
        ": their middle is up to " + short_text(wide.most) +
        " m from the nearest node, and the ball only touches nodes; use a "
        "radius above " +
        short_text(stretched * wide.most) + " m, or a finer grid");
  }

  void passes_itself(const Distance& d) {
    const Wide wide = wider_than(d.thickness);
    if (wide.quads == 0) return;
    add("--self-collision \"" + to_words(d) + "\" does not close " +
        of_all(wide.quads) + ", where a node may be " + short_text(wide.most) +
        " m from the nearest one, so the cloth can pass through itself there; "
        "use a thickness above that, 0.71 times the side of a square");
  }

  /** A contact is a jump, which error control sees only after a step. */
  void not_smooth() {
    if (m_.has_contact())
      add(std::string(m_.method->info.name) +
          " does not control the error where nodes touch or edges break: there "
          "it has order 1 or 2, like every method; --method verlet --dt auto "
          "costs less");
  }

  /** Round-off errors do not fall with the step, so no step is accepted. */
  void below_round_off() {
    double size = 0;
    for (Node n : g_.nodes()) size = std::max(size, norm(n.position()));
    const double least = size * std::numeric_limits<double>::epsilon();
    if (m_.step.tolerance == 0 || m_.step.tolerance >= least) return;
    add(std::string(m_.method->info.name) + ": an inner step may err by " +
        short_text(m_.step.tolerance) +
        " m, below the round-off of positions, " + short_text(least) +
        " m: steps get tiny and may never end; use a larger --tolerance");
  }

  /** A ball that jumps over nodes pushes none of them. */
  void too_fast(const Solid& s) {
    const double speed = norm(s.motion.velocity), r = s.ball.radius;
    if (speed * dt_ <= r / 2) return;
    add("--sphere moves " + short_text(speed * dt_) +
        " m a step, more than half of its radius, " + short_text(r) +
        " m: nodes may tunnel through it; use --dt " +
        short_text(r / 2 / speed));
  }
};

}  // namespace

double opening(const Net& mesh, const Quad& q) {
  const auto [s, t] = halves(mesh, q);
  return std::max(opening(s), opening(t));
}

std::vector<std::string> warnings(const Model& m, const Net& mesh,
                                  const Cloth& g, double dt) {
  return Finder(m, mesh, g, dt).all();
}

}  // namespace lab
