#include "lab/scenes/SceneFile.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <type_traits>

#include <CLI/CLI.hpp>

#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"
#include "lab/Interrupt.hpp"
#include "lab/Nearest.hpp"
#include "lab/methods/Method.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

using CME212::short_text;

/** A Model in words; an empty string is what is not there. */
struct SceneOptions::Text {
  using List = std::vector<std::string>;
  std::string name, nodes, tets;
  List sheets;
  std::string edges;
  double stiffness, gravity, damping;
  std::optional<double> modulus, density, drag;
  List regions, pins, planes, spheres, tears;
  std::optional<double> tear_strain;
  std::string self_collision;
  double t_end;
  std::string dt, method, measure;
  double tolerance;
  std::string view;

  explicit Text(const Model& m)
      : name(m.name),
        nodes(m.nodes),
        tets(m.tets),
        sheets(words(m.sheets)),
        edges(to_words(m.edges)),
        stiffness(m.stiffness),
        gravity(m.gravity),
        damping(m.damping),
        modulus(m.material.modulus),
        density(m.material.density),
        drag(m.material.drag),
        regions(words(m.regions)),
        pins(words(m.pins)),
        planes(words(m.planes)),
        spheres(words(m.spheres)),
        tears(words(m.tears)),
        tear_strain(m.tear_strain),
        self_collision(words(m.self_collision)),
        t_end(m.t_end),
        dt(to_words(m.step)),
        method(m.method->info.name),
        measure(name_of(m.measure)),
        tolerance(m.tolerance),
        view(words(m.view)) {}

  Model model() const;

 private:
  template <typename Part>
  static List words(const std::vector<Part>& parts) {
    List all;
    for (const Part& p : parts) all.push_back(to_words(p));
    return all;
  }
  template <typename Part>
  static std::string words(const std::optional<Part>& part) {
    return part ? to_words(*part) : "";
  }
};

namespace {

/** Call @a use(name, member, what it is) for each option of a scene.
 * @tparam T SceneOptions::Text, or const */
template <typename T, typename Use>
void each_option(T& m, Use use) {
  use("nodes", m.nodes,
      "file of points 'x y z' [m], or 'x y z vx vy vz' [m/s]");
  use("tets", m.tets, "file of quads, four node indices each");
  use("sheet", m.sheets,
      "a grid instead of files, any number: at X Y Z u X Y Z v X Y Z [m] nodes "
      "N M velocity X Y Z [m/s]: a corner, two sides, nodes along them, how it "
      "moves at first");
  use("edges", m.edges, "springs: sides, and diagonals and bend if named");
  use("stiffness", m.stiffness, "K of every edge [N/m]");
  use("modulus", m.modulus, "instead of it: force per width and strain [N/m]");
  use("density", m.density, "mass per area [kg/m^2], instead of 1 kg in all");
  use("damping", m.damping,
      "drag coefficient c of every node [kg/s] (1/N is moderate)");
  use("drag", m.drag, "instead of it: drag per area [kg/(s m^2)]");
  use("region", m.regions,
      "another material in a box: from X Y Z to X Y Z [m] mass-factor F "
      "stiffness-factor F: of nodes in it, of edges with both ends in it");
  use("gravity", m.gravity, "acceleration of free fall [m/s^2]");
  use("pin", m.pins,
      "hold the nodes that start at x X y Y z Z [m] (one of them or more), or "
      "move them: velocity X Y Z [m/s] until T [s]");
  use("plane", m.planes,
      "a floor or wall: at X Y Z [m] normal X Y Z friction F velocity X Y Z "
      "[m/s] until T [s]");
  use("sphere", m.spheres,
      "a ball: at X Y Z radius R [m] friction F velocity X Y Z [m/s] until T "
      "[s]");
  use("tear", m.tears,
      "a ball that removes what touches it: at X Y Z radius R [m]");
  use("tear-strain", m.tear_strain, "an edge breaks at this strain, l/L - 1");
  use("self-collision", m.self_collision,
      "nodes without a common edge stay apart: thickness D [m] friction F");
  use("t-end", m.t_end, "time to reach [s], in steps of dt");
  use("dt", m.dt,
      "step [s], the last ones shorter; auto: first 0.6 of the stability limit "
      "that holds in every configuration, then as the energy balance allows; "
      "auto:sharp: first 0.9 of that in the present one; auto:G, "
      "auto:sharp:G: it gains at most that share of the energy of motion "
      "(0.1)");
  use("method", m.method, "name of a method: see --list-methods");
  use("measure", m.measure,
      "what is asked, at the end: com [m], energy [J], positions [m], "
      "max-stretch, drape-height [m]");
  use("tolerance", m.tolerance,
      "how exactly, in the measure's unit; a run without --method and --dt "
      "keeps the positions to it [m] by dop853");
  use("view", m.view, "the box to look at: from X Y Z to X Y Z [m]");
}

template <typename Part>
std::vector<Part> all_of(const std::vector<std::string>& texts,
                         Part (*read)(const std::string&)) {
  std::vector<Part> all;
  for (const std::string& text : texts) all.push_back(read(text));
  return all;
}

}  // namespace

Model SceneOptions::Text::model() const {
  auto require = [](bool ok, const char* option, double value,
                    const std::string& expected) {
    if (!ok)
      throw SceneError(option,
                       "is " + short_text(value) + ", expected " + expected);
  };
  auto not_negative = [](double a) { return a >= 0 && std::isfinite(a); };
  auto positive = [](double a) { return a > 0 && std::isfinite(a); };
  Model m;
  m.name = name;
  m.step = read_time_step(dt);
  const bool fixed = m.step.fixed();
  require(not_negative(t_end), "t-end", t_end, "a time [s], 0 or more");
  // The step that nobody asked for is none to complain about.
  if (dt == to_words(TimeStep{}) && t_end > 0)
    m.step.dt = std::min(m.step.dt, t_end);
  require(!fixed || m.step.dt <= t_end || t_end == 0, "dt", m.step.dt,
          "at most --t-end");
  require(!fixed || t_end / m.step.dt < 1e15, "t-end", t_end,
          "fewer than 1e15 steps of --dt");
  m.t_end = t_end;
  require(not_negative(damping), "damping", damping,
          "a drag coefficient [kg/s], 0 or more");
  require(not_negative(stiffness), "stiffness", stiffness,
          "a spring constant [N/m], 0 or more");
  require(std::isfinite(gravity), "gravity", gravity,
          "an acceleration [m/s^2]");
  m.damping = damping, m.stiffness = stiffness, m.gravity = gravity;
  if (modulus)
    require(not_negative(*modulus), "modulus", *modulus,
            "a force per width [N/m], 0 or more");
  if (density)
    require(positive(*density), "density", *density,
            "a mass per area [kg/m^2], more than 0");
  if (drag)
    require(not_negative(*drag), "drag", *drag,
            "a drag per area [kg/(s m^2)], 0 or more");
  m.material = {density, modulus, drag};
  if (tear_strain)
    require(positive(*tear_strain), "tear-strain", *tear_strain,
            "a strain above that at the start, 0");
  m.tear_strain = tear_strain;
  require(positive(tolerance), "tolerance", tolerance, "more than 0");
  m.tolerance = tolerance;
  m.method = read_method(method);
  m.measure = read_measure(measure);
  m.edges = read_edges(edges);
  m.sheets = all_of(sheets, read_sheet);
  m.regions = all_of(regions, read_region);
  m.pins = all_of(pins, read_pin);
  m.planes = all_of(planes, read_plane);
  m.spheres = all_of(spheres, read_sphere);
  m.tears = all_of(tears, read_tear);
  if (!self_collision.empty())
    m.self_collision = read_self_collision(self_collision);
  if (!view.empty()) m.view = read_view(view);
  m.nodes = nodes, m.tets = tets;
  if (!sheets.empty() && !(nodes.empty() && tets.empty()))
    throw SceneError("sheet", "and files of a mesh: expected one of them");
  return or_assignment(m);
}

CLI::Option* takes_file(CLI::Option* option) {
  return option->type_name("FILE")->check([](const std::string& name) {
    if (name.empty()) return std::string("is empty, expected a file");
    if (!name.starts_with("--")) return std::string();
    return "is " + name + ", expected a file; one of that name is ./" + name;
  });
}

SceneOptions::SceneOptions() : text_(std::make_unique<Text>(Model())) {}
SceneOptions::~SceneOptions() = default;
Model SceneOptions::model() const { return text_->model(); }

void SceneOptions::add_to(CLI::App& app) {
  each_option(*text_,
              [&app](const std::string& name, auto& member, const char* help) {
                using T = std::remove_reference_t<decltype(member)>;
                std::string names = "--" + name;
                if (name == "nodes") names += ",NODES";
                if (name == "tets") names += ",TETS";
                CLI::Option* option = app.add_option(names, member, help);
                if constexpr (std::is_same_v<T, Text::List>)
                  option->allow_extra_args(false);  // what follows may be NODES
                if (name == "nodes" || name == "tets") takes_file(option);
                if (name == "dt") option->type_name("FLOAT|auto[:sharp][:G]");
              });
  CLI::Option* stiffness = app.get_option("--stiffness");
  CLI::Option* damping = app.get_option("--damping");
  app.get_option("--modulus")->excludes(stiffness);
  app.get_option("--drag")->excludes(damping);
  // A file's modulus gives way to the command line's stiffness.
  stiffness->each([this](const std::string&) { text_->modulus.reset(); });
  damping->each([this](const std::string&) { text_->drag.reset(); });
}

// -------------------------------------------------------------------- Reading

namespace {

/** @a name, a file name in the scene file @a scene, as the program opens it:
 * relative to the folder of the scene. */
std::string beside(const std::string& scene, const std::string& name) {
  if (name.empty()) return name;
  return (std::filesystem::path(scene).parent_path() / name).string();
}

Model load(const std::string& file,
           const std::function<void(const Model&)>& check) {
  SceneOptions options;
  CLI::App app;
  options.add_to(app);
  options.read(app, file, [&] { check(options.model()); });
  return options.model();
}

}  // namespace

void SceneOptions::read(CLI::App& app, const std::string& file,
                        const std::function<void()>& check) {
  std::string text;
  try {
    text = mesh_detail::read_file(file, "a scene file", end_if_interrupted);
  } catch (const InputError& e) {
    throw SceneFileError(e.what());
  }
  read_text(app, file, std::filesystem::path(file).stem().string(), text,
            check);
}

void SceneOptions::read_text(CLI::App& app, const std::string& file,
                             const std::string& name, const std::string& text,
                             const std::function<void()>& check) {
  text_->name = name;
  origins_ = {file, {}};
  try {
    auto use = [&](const KeyValue& found, std::size_t line) {
      const std::string& key = found.key;
      auto fail = [&](const std::string& what) {
        throw InputError(file, line, what);
      };
      CLI::Option* option = app.get_option_no_throw("--" + key);
      if (!option || key == "help")
        fail("unknown key " + printable(key) + did_you_mean(key, scene_keys()));
      const auto [first, is_new] = origins_.line_of.emplace(key, line);
      if (!is_new)
        fail(key + " for the second time, first on line " +
             std::to_string(first->second));
      const std::string type = option->get_type_name();
      const bool is_file = type == "FILE" || type == "FOLDER";
      for (const std::string& value : found.values)
        option->add_result(is_file ? beside(file, value) : value);
    };
    each_key_value(text, file, use);
    app.parse(std::vector<std::string>());
    check();
  } catch (const InputError& e) {
    throw SceneFileError(e.what());
  } catch (const CLI::ParseError& e) {
    throw SceneFileError(origins_.of(e.what(), file + ": ") + e.what());
  } catch (const SceneError& e) {
    throw SceneFileError(origins_.of(e.what(), file + ": ") + e.what());
  }
}

void SceneOptions::overridden_by(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    if (option->count() > 0 && !option->get_lnames().empty())
      origins_.line_of.erase(option->get_lnames().front());
}

std::string Origins::of(const std::string& message,
                        const std::string& otherwise) const {
  const auto dashes = message.find("--");
  if (dashes == std::string::npos) return otherwise;
  const auto name = dashes + 2;
  const auto end =
      message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", name);
  auto it = line_of.find(message.substr(name, end - name));
  if (it == line_of.end()) return otherwise;
  return file + ':' + std::to_string(it->second) + ": ";
}

void check_has_cloth(const Model& m) {
  if (m.sheets.empty() && (m.nodes.empty() || m.tets.empty()))
    throw SceneError(m.nodes.empty() ? "nodes" : "tets",
                     "is missing: expected files NODES and TETS, or --sheet");
}

Model load_model(const std::string& file) {
  return load(file, check_has_cloth);
}
Model load_open_model(const std::string& file) {
  return load(file, [](const Model&) {});
}
Model read_model(const std::string& file, const std::string& name,
                 const std::string& text) {
  SceneOptions options;
  CLI::App app;
  options.add_to(app);
  options.read_text(app, file, name, text,
                    [&] { check_has_cloth(options.model()); });
  return options.model();
}

// ------------------------------------------------------------------- Printing

std::string to_scene_file(const Model& m) {
  std::ostringstream out;
  const SceneOptions::Text text(m);
  each_option(text, [&](const std::string& name, const auto& member,
                        const std::string& help) {
    using T = std::remove_cvref_t<decltype(member)>;
    std::string value;
    if constexpr (std::is_same_v<T, double>) {
      value = CME212::exact_text(member);
    } else if constexpr (std::is_same_v<T, std::optional<double>>) {
      if (member) value = CME212::exact_text(*member);
    } else if constexpr (std::is_same_v<T, std::string>) {
      const bool is_file = name == "nodes" || name == "tets";
      if (!member.empty())
        value = in_quotes(is_file ? std::filesystem::absolute(member).string()
                                  : member);
    } else {
      for (const std::string& s : member)
        value += (value.empty() ? "[" : ", ") + in_quotes(s);
      if (!value.empty()) value += ']';
    }
    if (name == "stiffness" && m.material.modulus) return;
    if (name == "damping" && m.material.drag) return;
    if (!value.empty())
      out << "# " << help << '\n' << name << " = " << value << '\n';
  });
  return out.str();
}

std::vector<std::string> scene_keys() {
  std::vector<std::string> names;
  const SceneOptions::Text text{Model()};
  each_option(text, [&](const char* name, const auto&, const char*) {
    names.emplace_back(name);
  });
  return names;
}

}  // namespace lab
