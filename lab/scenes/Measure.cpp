#include "lab/scenes/Measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/OneWaySprings.hpp"

namespace lab {

double distance(const Answer& a, const Answer& b, const Measure& measure) {
  assert(a.size() == b.size());
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  if (measure.quantity == Measure::positions) sum /= double(a.size()) / 3;
  return std::sqrt(sum);
}

namespace {

/** Sampled places on each sheet, along u and along v. */
constexpr int samples = 9;

/** The position of the place (s, t) of [0, 1]^2 on a sheet whose first node has
 * index @a first: bilinear between its four nodes. */
Point position_on(const Cloth& g, const Sheet& sheet, unsigned first, double s,
                  double t) {
  const unsigned n = sheet.nodes[0], m = sheet.nodes[1];
  const double a = s * (n - 1), b = t * (m - 1);
  const unsigned i = std::min(unsigned(a), n - 2),
                 j = std::min(unsigned(b), m - 2);
  const double p = a - i, q = b - j;
  auto at = [&](unsigned di, unsigned dj) {
    return g.node(first + (i + (n > 1 ? di : 0)) * m + j + (m > 1 ? dj : 0))
        .position();
  };
  return (1 - p) * ((1 - q) * at(0, 0) + q * at(0, 1)) +
         p * ((1 - q) * at(1, 0) + q * at(1, 1));
}

/** The first index of the sheet of number @a k of @a m, or all nodes. */
unsigned first_index(const Model& m, std::size_t k) {
  unsigned first = 0;
  for (const Sheet& s : std::span(m.sheets).first(k))
    first += s.nodes[0] * s.nodes[1];
  return first;
}

Answer positions(const Measured& now, const Measure&) {
  const Model& m = now.model;
  const Cloth& g = now.cloth;
  Answer all;
  auto add = [&](const Point& p) {
    all.insert(all.end(), {double(p.x), double(p.y), double(p.z)});
  };
  if (m.sheets.empty())
    for (Node n : g.nodes()) add(n.position());
  for (std::size_t k = 0; k < m.sheets.size(); ++k)
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j)
        add(position_on(g, m.sheets[k], first_index(m, k),
                        i / double(samples - 1), j / double(samples - 1)));
  return all;
}

/** The curvature between two points of a line, per cell squared: of the second
 * differences at both ends the smaller one, 0 if their signs differ. A sheet
 * that lies on a floor up to a node gets no dip beside it. */
double curvature(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a ? *a : b.value_or(0);
  return *a * *b <= 0 ? 0 : std::abs(*a) < std::abs(*b) ? *a : *b;
}

/** Where the parabola of curvature @a c from @a a at 0 to @a b at 1 is lowest,
 * in [0, 1]. */
double lowest_at(double a, double b, double c) {
  return c > 0 ? std::clamp(0.5 - (b - a) / c, 0.0, 1.0) : b < a ? 1 : 0;
}

/** The lowest height of a sheet's surface [m]: in the cells around its lowest
 * node, quadratic along each grid line (ENO interpolation: Harten, Engquist,
 * Osher, Chakravarthy, J. Comput. Phys. 71, 1987).
 * @param first index of the sheet's first node */
double lowest_height(const Cloth& g, const Sheet& sheet, unsigned first) {
  const int n = int(sheet.nodes[0]), m = int(sheet.nodes[1]);
  auto z = [&](int i, int j) {
    return double(g.node(first + unsigned(i * m + j)).position().z);
  };
  int i = 0, j = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < m; ++b)
      if (z(a, b) < z(i, j)) i = a, j = b;
  // The second difference along u, (1, 0), or along v, (0, 1).
  auto bend = [&](int a, int b, int u, int v) -> std::optional<double> {
    if (a < u || a > n - 1 - u || b < v || b > m - 1 - v) return {};
    return z(a - u, b - v) - 2 * z(a, b) + z(a + u, b + v);
  };
  double lowest = z(i, j);
  for (int di : {-1, 1})
    for (int dj : {-1, 1}) {
      const int a = i + di, b = j + dj;
      if (a < 0 || a >= n || b < 0 || b >= m) continue;
      const double cu = curvature(bend(i, j, 1, 0), bend(a, j, 1, 0)),
                   cv = curvature(bend(i, j, 0, 1), bend(i, b, 0, 1));
      // Lowest along u and along v in turn: this converges quickly, as the
      // cell's twist is small against its curvatures.
      double s = 0, t = 0;
      for (int k = 0; k < 8; ++k) {
        s = lowest_at(std::lerp(z(i, j), z(i, b), t),
                      std::lerp(z(a, j), z(a, b), t), cu);
        t = lowest_at(std::lerp(z(i, j), z(a, j), s),
                      std::lerp(z(i, b), z(a, b), s), cv);
      }
      lowest =
          std::min(lowest, std::lerp(std::lerp(z(i, j), z(a, j), s),
                                     std::lerp(z(i, b), z(a, b), s), t) -
                               cu * s * (1 - s) / 2 - cv * t * (1 - t) / 2);
    }
  return lowest;
}

/** The lowest height of @a g [m]; 0 if it has no nodes. Of a mesh from files,
 * and of a cloth that may have torn, the height of the lowest node. */
Answer lowest_height(const Measured& now, const Measure&) {
  const Model& m = now.model;
  const Cloth& g = now.cloth;
  if (g.num_nodes() == 0) return {0};
  double lowest = std::numeric_limits<double>::infinity();
  const std::size_t sheets = m.sheets.size();
  if (first_index(m, sheets) != g.num_nodes() || m.tear_strain)
    for (Node n : g.nodes()) lowest = std::min(lowest, double(n.position().z));
  else
    for (std::size_t k = 0; k < sheets; ++k)
      lowest =
          std::min(lowest, lowest_height(g, m.sheets[k], first_index(m, k)));
  return {lowest};
}

/** @a p, or its component that @a what names. */
Answer components(const Point& p, const Measure& what) {
  Answer all;
  for (std::size_t k = 0; k < 3; ++k)
    if (what.has(k)) all.push_back(double(p[k]));
  return all;
}

Answer stretch(const Measured& now, const Measure&) {
  double most = 0;
  for (Edge e : now.cloth.edges()) most = std::max(most, strain_of(e));
  return {most};
}

/** The stretch of a sheet at a place: of its two directions the larger, linear
 * between the centers of cells. As a cell's is a central difference, the error
 * is O(cell^2), also at the sides. */
Answer stretch_at(const Measured& now, const Measure& what) {
  const auto k = std::size_t(what.place.sheet) - 1;
  const Sheet& sheet = now.model.sheets[k];
  const unsigned first = first_index(now.model, k);
  double most = -1;
  for (std::size_t d : {0, 1}) {
    const unsigned cells = sheet.nodes[d] - 1;
    const double rest =
        norm(d == 0 ? sheet.u : sheet.v) * now.model.rest_length / cells;
    if (!(rest > 0) || cells == 0) continue;  // a rope has one direction
    auto of_cell = [&](unsigned i) {
      std::array a = {what.place.u, what.place.v}, b = a;
      a[d] = double(i) / cells, b[d] = (i + 1.) / cells;
      return norm(position_on(now.cloth, sheet, first, b[0], b[1]) -
                  position_on(now.cloth, sheet, first, a[0], a[1])) /
                 rest -
             1;
    };
    const double at = (d == 0 ? what.place.u : what.place.v) * cells - 0.5;
    const unsigned i = unsigned(std::clamp(at, 0., std::max(0., cells - 2.)));
    most = std::max(most, cells == 1
                              ? of_cell(0)
                              : std::lerp(of_cell(i), of_cell(i + 1), at - i));
  }
  return {most};
}

/** What stores the energy of @a now. */
Potential potential(const Measured& now) {
  return now.force ? ForcePlan(*now.force).potential()
                   : Potential(now.model.gravity);
}

double torn_edges(const Cloth& g) {
  return double(arrays(g).edge_slots() - g.num_edges());
}
double torn_nodes(const Cloth& g) {
  return double(arrays(g).node_slots() - g.num_nodes());
}

/** The force [N] of @a e by K and L on its node1(). */
Point spring_force_of(const Measured& now, Edge e) {
  const Point u = e.node2().position() - e.node1().position();
  for (const auto& part : now.force->parts)
    if (auto one_way = dynamic_cast<const OneWaySprings*>(part.get()))
      return one_way->pull(e.id(), u, e.value());
  return spring_force(u, e.value());
}

/** The same, as it acted. */
Point pull_of(const Measured& now, Edge e) {
  if (e.id() >= now.pulls.size()) return spring_force_of(now, e);
  const bool first = e.node1().id() == arrays(now.cloth).edge_ends()[e.id()][0];
  return (first ? 1 : -1) * now.pulls[e.id()];
}

/** The force that acted on @a n [N].  O(its springs) */
Point force_on(const Measured& now, Node n) {
  Point f = (*now.force)(n, now.time);
  for (Edge e : n.edges()) {
    if (e.id() >= now.pulls.size()) continue;
    f -= spring_force_of(now, e);
    f += pull_of(now, e);
  }
  return f;
}

/** The tension of @a e [N], below 0 if it pushes. */
double tension_of(const Measured& now, Edge e) {
  const Point u = e.node2().position() - e.node1().position();
  return u == Point() ? 0 : dot(pull_of(now, e), u) / norm(u);
}

Answer tension(const Measured& now, const Measure& what) {
  const auto [i, j] = what.between;
  const Cloth& g = now.cloth;
  if (std::max(i, j) < g.num_nodes())
    for (Edge e : g.node(i).edges())
      if (e.node2() == g.node(j)) return {tension_of(now, e)};
  if (torn_edges(g) > 0) return {0};
  throw SceneError("measure",
                   "is " + name_of(what) + ", which no spring joins");
}

Answer max_tension(const Measured& now, const Measure&) {
  double most = 0;
  for (Edge e : now.cloth.edges()) most = std::max(most, tension_of(now, e));
  return {most};
}

/** The sum of all forces on the held nodes that @a what names [N], each node
 * once: what the pins carry, as held nodes do not accelerate.
 * O(springs at them) */
Answer pin_force(const Measured& now, const Measure& what) {
  const Cloth& g = now.cloth;
  std::vector<unsigned> ids;
  for (const HeldNodes& h : *now.held)
    for (const auto& [id, place] : h.nodes)
      if (what.pin.distance(0, place) < Pin::near) ids.push_back(id);
  if (ids.empty())
    throw SceneError("measure",
                     "is " + name_of(what) + ", where no pin holds a node");
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  Point sum;
  for (unsigned id : ids)
    if (arrays(g).node_in_use(id))
      sum += force_on(now, arrays(g).node_with_id(id));
  return {norm(sum)};
}

/** The surfaces that one node touches. */
class Touched {
 public:
  void clear() { all_.clear(); }
  bool empty() const { return all_.empty(); }
  /** Add the surface if @a depth [m] is round-off of lengths of @a size. */
  void add(double depth, double size, const Point& out, const Point& velocity) {
    if (std::abs(depth) <= 1e-9 * size) all_.push_back({out, velocity});
  }
  /** The force by which the surfaces carry a node [N]: the sum of a out with
   * a >= 0 that leaves least of @a f, the force on it, by projected
   * Gauss-Seidel. So a surface counts once, however often it is named.
   * @param v velocity of the node: a method adds the inward part in a step,
   * and the surface takes it, so its drag, @a c times it, is no load */
  Point carry(Point f, Point v, double c) {
    constexpr int rounds = 100;
    for (const Surface& s : all_) {
      const double in = std::max(0., -dot(v - s.velocity, s.out));
      v += in * s.out;
      f -= c * in * s.out;
    }
    Point sum;
    double most = norm(f);
    for (int k = 0; k < rounds && most > 1e-12 * norm(f - sum); ++k) {
      most = 0;
      for (Surface& s : all_) {
        const double change = std::max(-s.force, -dot(f + sum, s.out));
        s.force += change;
        sum += change * s.out;
        most = std::max(most, std::abs(change));
      }
    }
    return sum;
  }

 private:
  struct Surface {
    Point out, velocity;
    double force = 0;  // along out [N]
  };
  std::vector<Surface> all_;
};

/** The size of the sum of the forces by which nodes that touch obstacles press
 * on them [N]: what these carry if the nodes rest on them; the impulse of an
 * impact is no part of it. Obstacles do not act on held nodes.
 * O(nodes * (obstacles + pins)) */
Answer contact_force(const Measured& now, const Measure&) {
  const ForcePlan plan = *now.force;
  const auto is_held = [&now](unsigned id) {
    return std::ranges::any_of(*now.held, [id](const HeldNodes& h) {
      return std::ranges::binary_search(h.nodes, id, {}, &HeldNodes::Held::id);
    });
  };
  double size = 0;
  for (Node n : now.cloth.nodes()) size = std::max(size, norm(n.position()));
  Point sum;
  Touched touched;
  for (Node n : now.cloth.nodes()) {
    touched.clear();
    const Point& p = n.position();
    for (const Wall& w : now.model.planes) {
      const Point way = w.motion.way(now.time);
      touched.add(w.depth(p - way), size + norm(w.at + way), w.out(),
                  w.motion.velocity_at(now.time));
    }
    for (const Solid& s : now.model.spheres) {
      const Point way = s.motion.way(now.time), arm = p - way - s.ball.center;
      touched.add(s.depth(p - way), size + s.ball.radius,
                  arm / std::max(norm(arm), 1e-300),
                  s.motion.velocity_at(now.time));
    }
    if (!touched.empty() && !is_held(n.id()))
      sum +=
          touched.carry(force_on(now, n), n.value().vel, plan.drag()[n.id()]);
  }
  return {norm(sum)};
}

/** The one number that @a of finds of the cloth alone. */
template <double (*of)(const Cloth&)>
Answer of_cloth(const Measured& now, const Measure&) {
  return {of(now.cloth)};
}

Answer tear_time(const Measured& now, const Measure&) {
  const bool torn = torn_nodes(now.cloth) + torn_edges(now.cloth) > 0;
  return {torn ? now.time : std::numeric_limits<double>::infinity()};
}

Point position_of(const Measured& now, const SheetPlace& p) {
  const auto k = std::size_t(p.sheet) - 1;
  return position_on(now.cloth, now.model.sheets[k], first_index(now.model, k),
                     p.u, p.v);
}

}  // namespace

const std::array<Quantity, 18> quantities = {{
    {"com", "m",
     [](const Measured& now, const Measure& what) {
       return components(center_of_mass(now.cloth), what);
     }},
    {"energy", "J",
     [](const Measured& now, const Measure&) {
       const Cloth& g = now.cloth;
       const Potential stored = potential(now);
       return Answer{kinetic_energy(g) + stored.elastic_energy(g) +
                     stored.gravitational_energy(g)};
     }},
    {"positions", "m", positions},
    {"max-stretch", "", stretch},
    {"drape-height", "m", lowest_height},
    {"kinetic-energy", "J", of_cloth<kinetic_energy>},
    {"elastic-energy", "J",
     [](const Measured& now, const Measure&) {
       return Answer{potential(now).elastic_energy(now.cloth)};
     }},
    {"lost-energy", "J",
     [](const Measured& now, const Measure&) { return Answer{now.lost}; }},
    {"pin-force", "N", pin_force},
    {"contact-force", "N", contact_force},
    {"tension", "N", tension},
    {"max-tension", "N", max_tension},
    {"torn-edges", "", of_cloth<torn_edges>},
    {"torn-nodes", "", of_cloth<torn_nodes>},
    {"tear-time", "s", tear_time},
    {"point", "m",
     [](const Measured& now, const Measure& what) {
       return components(position_of(now, what.place), what);
     }},
    {"distance", "m",
     [](const Measured& now, const Measure& what) {
       return Answer{
           norm(position_of(now, what.place) - position_of(now, what.to))};
     }},
    {"stretch-at", "", stretch_at},
}};

std::string columns_of(const Measure& m) {
  if (m.quantity <= Measure::positions || m.quantity == Measure::tear_time ||
      m.quantity == Measure::kinetic_energy ||
      m.quantity == Measure::elastic_energy)
    return "";
  std::string name = quantities[m.quantity].name, all;
  std::ranges::replace(name, '-', '_');
  if (m.quantity != Measure::point) return ',' + name;
  for (std::size_t k = 0; k < 3; ++k)
    if (m.has(k)) all += ',' + name + '_' + "xyz"[k];
  return all;
}

const char* unit_of(const Measure& m) {
  return m.is_time() ? "s" : quantities[m.quantity].unit;
}

double strain_of(Edge e) {
  const double L = e.value().L;
  return L > 0 ? e.length() / L - 1 : 0;
}
double strain_at(Node n) {
  double sum = 0;
  for (Edge e : n.edges()) sum += strain_of(e);
  return n.degree() > 0 ? sum / n.degree() : 0;
}

Answer answer(const Model& m, const Cloth& g, const Measure& what) {
  assert(what.quantity < Measure::lost_energy);
  return quantities[what.quantity].read({m, g}, what);
}

namespace {
/** What @a m lacks for an answer; or empty. */
std::string lacks(const Model& m, const Measure& what) {
  const bool tears = !m.tears.empty() || m.tear_strain;
  const double sheets = what.quantity == Measure::distance
                            ? std::max(what.place.sheet, what.to.sheet)
                            : what.place.sheet;
  if (what.has_place() && double(m.sheets.size()) < sheets)
    return "names a sheet that the scene does not have";
  if (tears && (what.has_place() || what.quantity == Measure::positions ||
                what.quantity == Measure::tension))
    return "cannot be compared in a cloth that tears";
  if ((what.quantity == Measure::tear_time || what.counts()) && !tears)
    return "needs --tear or --tear-strain";
  if ((what.quantity == Measure::tension ||
       what.quantity == Measure::max_tension) &&
      !m.sheets.empty())
    return "depends on the grid of a sheet, whose springs stand for cloth";
  if (what.quantity == Measure::contact_force && m.planes.empty() &&
      m.spheres.empty())
    return "needs --plane or --sphere";
  return "";
}
}  // namespace

bool can_answer(const Model& m, const Measure& what) {
  return lacks(m, what).empty();
}

void check_question(const Model& m) {
  if (const std::string why = lacks(m, m.measure); !why.empty())
    throw SceneError("measure", "is " + name_of(m.measure) + ", which " + why +
                                    ": expected another measure");
}

}  // namespace lab
