#include "lab/scenes/Fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <type_traits>

#include "CME212/Util.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/Line.hpp"
#include "lab/scenes/Measure.hpp"

namespace lab {

std::vector<Field> fields_of(Model& m) {
  using enum Role;
  constexpr auto scene = "Scene", material = "Material",
                 step = "Method and step", advice = "Advice";
  constexpr auto not_negative = Word::Range::not_negative,
                 positive = Word::Range::positive;
  return {
      {"nodes", mesh, scene, &m.nodes,
       "file of points 'x y z' [m], or 'x y z vx vy vz' [m/s]"},
      {"tets", mesh, scene, &m.tets,
       "file of quads, four node indices each; .tris: triangles, .edges: "
       "springs"},
      {"net", mesh, scene, &m.net,
       "one file instead: .net (nodes, springs, faces: data/README.md), .obj, "
       ".off, .ply or .stl; --net may be omitted"},
      {"sheet", cloth, scene, &m.sheets,
       "a grid of nodes instead of files; may be repeated: at X Y Z u X Y Z v "
       "X Y Z [m] nodes N M velocity X Y Z [m/s] (corner, two sides, numbers "
       "of nodes along them, initial velocity)"},
      {"edges", cloth, scene, &m.edges,
       "kinds of springs: sides, diagonals, bend; after each, if wanted, its "
       "own K [N/m]"},
      {"stiffness", number, material, &m.stiffness, "K of every edge [N/m]",
       "a spring constant [N/m], 0 or more", not_negative},
      {"modulus", cloth, material, &m.material.modulus,
       "instead of stiffness: force per width and strain [N/m]",
       "a force per width [N/m], 0 or more", not_negative, "stiffness"},
      {"rest-length", number, material, &m.rest_length,
       "of every spring, as a factor of its length at the start, or of that in "
       "the net",
       "a factor, 0 or more", not_negative},
      {"density", cloth, material, &m.material.density,
       "mass per area [kg/m^2], instead of a total of 1 kg",
       "a mass per area [kg/m^2], more than 0", positive},
      {"damping", number, material, &m.damping,
       "drag coefficient c of every node [kg/s] (1/N is moderate)",
       "a drag coefficient [kg/s], 0 or more", not_negative},
      {"drag", cloth, material, &m.material.drag,
       "instead of damping: drag per area [kg/(s m^2)]",
       "a drag per area [kg/(s m^2)], 0 or more", not_negative, "damping"},
      {"wind", acts, scene, &m.wind,
       "the air by which drag acts moves: velocity X Y Z [m/s]"},
      {"region", acts, material, &m.regions,
       "another material in a box: from X Y Z to X Y Z [m] mass-factor F "
       "stiffness-factor F, for the mass of nodes and K of edges in it"},
      {"gravity", number, scene, &m.gravity,
       "acceleration of free fall [m/s^2]: a number acts down, along -z; or a "
       "vector, '0 -9.81 0'"},
      {"pin", acts, scene, &m.pins,
       "hold the nodes that start at x X y Y z Z [m] (at least one of these), "
       "or move them: velocity X Y Z [m/s] turn X Y Z [rad/s] about X Y Z [m] "
       "until T [s]"},
      {"plane", contact, scene, &m.planes,
       "a floor or wall: at X Y Z [m] normal X Y Z friction F velocity X Y Z "
       "[m/s] until T [s]"},
      {"sphere", contact, scene, &m.spheres,
       "a ball: at X Y Z radius R [m] friction F velocity X Y Z [m/s] until T "
       "[s]"},
      {"tear", contact, scene, &m.tears,
       "a ball that removes the nodes that touch it: at X Y Z radius R [m]"},
      {"tear-strain", contact, scene, &m.tear_strain,
       "an edge breaks at this strain, l/L - 1", "a strain above 0", positive},
      {"self-collision", contact, scene, &m.self_collision,
       "nodes without a common edge stay apart: thickness D [m] friction F"},
      {"from-rest", number, scene, &m.from_rest,
       "begin in the equilibrium of the cloth, at rest", "true or false"},
      {"t-end", asked, scene, &m.t_end, "time at which the run ends [s]",
       "a time [s], 0 or more", not_negative},
      {"at", asked, scene, &m.at,
       "change the scene at a time [s], as '0.2 unpin 0', '1 stiffness 400' or "
       "'0.5 cut 40 41': see lab/README.md",
       "a time [s] and a change"},
      {"dt", Role::method, step, &m.step,
       "step [s]; the last steps may be shorter; auto: starts with 0.6 of the "
       "limit of small oscillations in every configuration, and is adapted to "
       "the energy balance; auto:sharp: starts with 0.9 of the limit in the "
       "present configuration; auto:G, auto:sharp:G: tolerated gain of energy, "
       "as a share of the energy of motion (0.1)"},
      {"method", Role::method, step, &m.method,
       "name of a method: see --list-methods"},
      {"measure", asked, advice, &m.measure,
       "the quantity asked for at the end of the run: com [x|y|z], "
       "drape-height, point u U v V [sheet N] [x|y|z], distance, positions "
       "[m], "
       "energy, kinetic-energy, elastic-energy, lost-energy [J], max-stretch, "
       "stretch-at, pin-force [x X] [y Y] [z Z], contact-force, tension I J, "
       "max-tension [N], tear-time "
       "[s], torn-edges, torn-nodes; or over time: max, min, mean or period "
       "NAME, first or last NAME above X: see lab/scenes/README.md"},
      {"tolerance",
       asked,
       advice,
       &m.tolerance,
       "error allowed in the measure, in its unit; for advice also P%: of the "
       "change since t = 0, or of a stretch, force or time itself; without "
       "--method and --dt a run uses rkn64 and bounds the error of the "
       "positions by it [m]",
       "more than 0",
       positive,
       {},
       &m.percent},
      {"view", asked, scene, &m.view,
       "the box to look at: from X Y Z to X Y Z [m]"}};
}

// -------------------------------------------------------- Reading and writing

namespace {

template <typename T>
concept List = requires(T a) {
  a.emplace_back();
};
template <typename T>
concept Optional = requires(T a) {
  a.emplace();
};

template <typename T>
void read(const Field& f, const std::string& text, T& a) {
  if constexpr (List<T>) {
    read(f, text, a.emplace_back());
  } else if constexpr (Optional<T>) {
    if (!text.empty()) read(f, text, a.emplace());
  } else if constexpr (std::is_same_v<T, double>) {
    char* end = nullptr;
    a = std::strtod(text.c_str(), &end);
    if (f.percent && (*f.percent = *end == '%')) ++end;
    if (text.empty() || *end != '\0' || !std::isfinite(a) ||
        (f.range != Word::Range::any && a < 0) ||
        (f.range == Word::Range::positive && a == 0))
      throw SceneError(f.name, printable(text), f.expected);
  } else if constexpr (std::is_same_v<T, bool>) {
    a = text == "true";
    if (!a && text != "false")
      throw SceneError(f.name, printable(text), f.expected);
  } else if constexpr (std::is_same_v<T, std::string>) {
    a = text;
    if (a.empty())
      throw SceneError(f.name, std::string("is empty, expected ") +
                                   (*f.expected ? f.expected : "a file name"));
    if (!is_utf8(a))
      throw SceneError(f.name, printable(a),
                       "a name in UTF-8, as scene files are");
  } else if constexpr (std::is_same_v<T, Gravity>) {
    Line in(text);
    a = read_gravity(in), in.end();
    if (!in.error().empty())
      throw SceneError(f.name, printable(text), gravity_expected);
  } else if constexpr (std::is_same_v<T, TimeStep>) {
    a = read_time_step(text);
  } else if constexpr (std::is_same_v<T, Measure>) {
    a = read_measure(text);
  } else if constexpr (std::is_same_v<T, const MethodEntry*>) {
    a = read_method(text);
  } else {
    a = read_part<T>(text);
  }
}

template <typename T>
void write(const T& a, std::vector<std::string>& values) {
  if constexpr (List<T>) {
    for (const auto& one : a) write(one, values);
  } else if constexpr (Optional<T>) {
    if (a) write(*a, values);
  } else if constexpr (std::is_same_v<T, double>) {
    values.push_back(CME212::exact_text(a));
  } else if constexpr (std::is_same_v<T, bool>) {
    if (a) values.push_back("true");
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (!a.empty()) values.push_back(a);
  } else if constexpr (std::is_same_v<T, Measure>) {
    values.push_back(name_of(a));
  } else if constexpr (std::is_same_v<T, const MethodEntry*>) {
    values.emplace_back(a->info.name);
  } else {
    values.push_back(to_words(a));
  }
}

}  // namespace

const char* Field::type() const {
  if (std::holds_alternative<std::string*>(member)) return "FILE";
  if (std::holds_alternative<TimeStep*>(member))
    return "FLOAT|auto[:sharp][:G]";
  if (std::holds_alternative<Gravity*>(member)) return "FLOAT|VECTOR";
  return std::holds_alternative<double*>(member) ||
                 std::holds_alternative<std::optional<double>*>(member)
             ? "FLOAT"
             : "TEXT";
}
bool Field::repeats() const {
  return std::visit(
      [](auto* a) { return List<std::remove_pointer_t<decltype(a)>>; }, member);
}
std::vector<std::string> Field::values() const {
  std::vector<std::string> all;
  std::visit([&all](const auto* a) { write(*a, all); }, member);
  if (percent && *percent) all[0] += '%';
  return all;
}

bool set_field(Model& m, std::string_view name,
               const std::vector<std::string>& values) {
  const auto all = fields_of(m);
  const auto field = std::ranges::find(all, name, &Field::name);
  if (field == all.end()) return false;
  const auto clear = [](auto* a) {
    using T = std::remove_pointer_t<decltype(a)>;
    if constexpr (List<T> || Optional<T>) *a = T();
  };
  for (const Field& f : all)
    if (f.name == name || f.instead_of == name) std::visit(clear, f.member);
  std::string all_words;  // [0, 0, -9.81] is the vector "0 0 -9.81"
  for (const std::string& value : values)
    all_words += (all_words.empty() ? "" : " ") + value;
  const auto take = [&](const std::string& value) {
    std::visit([&](auto* a) { read(*field, value, *a); }, field->member);
  };
  if (field->repeats())
    std::ranges::for_each(values, take);
  else
    take(all_words);
  return true;
}

void check_step(Model& m) {
  // A default that is too long is no error of the user.
  double& dt = m.step.dt;
  const bool fixed = m.step.fixed();
  if (fixed && dt == TimeStep().dt && m.t_end > 0) dt = std::min(dt, m.t_end);
  if (fixed && dt > m.t_end && m.t_end > 0)
    throw SceneError("dt", CME212::short_text(dt), "at most --t-end");
  if (fixed && !(m.t_end / dt < 1e15))
    throw SceneError("t-end", CME212::short_text(m.t_end),
                     "fewer than 1e15 steps of --dt");
}

Model checked(Model m) {
  check_step(m);
  if (m.tets.empty() && m.net.empty() && !m.nodes.ends_with(".nodes"))
    m.net = std::exchange(m.nodes, "");
  if (const bool files = !m.nodes.empty() || !m.tets.empty();
      !m.sheets.empty() && (files || !m.net.empty()))
    throw SceneError("sheet", files ? "cannot be combined with NODES and TETS"
                                    : "cannot be combined with --net");
  else if (files && !m.net.empty())
    throw SceneError("net", "cannot be combined with NODES and TETS");
  if (m.wind && m.material.drag.value_or(m.damping) == 0)
    throw SceneError("wind", "acts by drag: expected --drag or --damping, too");
  if (m.from_rest && m.self_collision)
    throw SceneError("from-rest",
                     "cannot be combined with --self-collision: it lets a "
                     "cloth pass through itself");
  return m;
}

// ---------------------------------------------------------- What a Model names

bool Model::names_parts() const {
  Model m = *this, none;
  const auto all = fields_of(m), usual = fields_of(none);
  return std::ranges::any_of(all, [&](const Field& f) {
    const bool is_part = f.role == Role::cloth || f.role == Role::acts ||
                         f.role == Role::contact;
    return is_part && f.values() != usual[std::size_t(&f - &all[0])].values();
  });
}
bool Model::has_contact() const {
  Model m = *this;
  return std::ranges::any_of(fields_of(m), [](const Field& f) {
    return f.role == Role::contact && !f.values().empty();
  });
}

}  // namespace lab
