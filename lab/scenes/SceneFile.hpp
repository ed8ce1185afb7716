#pragma once
/** @file SceneFile.hpp
 * A Model as options and as a file of options: the one table of their names,
 * and how such a file is read and written. docs/scenes.md */
#include <cmath>
#include <cstddef>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** Call @a use(name, member, what it is) for each option of a scene.
 * @tparam M Model, or const Model */
template <typename M, typename Use>
void each_option(M& m, Use use) {
  use("nodes", m.nodes, "file of points 'x y z' [m]");
  use("tets", m.tets, "file of quads, four node indices each");
  use("sheet", m.sheets,
      "a grid instead of files, any number: at X Y Z u X Y Z v X Y Z [m] nodes "
      "N M: a corner, two sides, nodes along them");
  use("edges", m.edges, "springs: sides, and diagonals and bend if named");
  use("stiffness", m.with.stiffness, "K of every edge [N/m]");
  use("modulus", m.material.modulus,
      "instead of it: force per width and strain [N/m]");
  use("density", m.material.density,
      "mass per area [kg/m^2], instead of 1 kg in all");
  use("damping", m.with.damping,
      "drag coefficient c of every node [kg/s] (1/N is moderate)");
  use("drag", m.material.drag, "instead of it: drag per area [kg/(s m^2)]");
  use("gravity", m.with.gravity, "acceleration of free fall [m/s^2]");
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
      "step [s]; auto: 0.6 of the limit that holds in every shape; "
      "auto:sharp: 0.9 of the limit in the present shape, looked at again "
      "every 100 steps, and at most the former limit");
  use("method", m.method, "name of a method: see --list-methods");
  use("measure", m.measure,
      "what is asked, at the end: com [m], energy [J], positions [m], "
      "max-stretch, drape-height [m]");
  use("tolerance", m.tolerance, "how exactly, in the measure's unit");
}

/** Give @a app the options of a scene, which go to @a m; their defaults are
 * what @a m holds now. */
inline void add_model_options(CLI::App& app, Model& m) {
  each_option(m,
              [&app](const std::string& name, auto& member, const char* help) {
                using T = std::remove_reference_t<decltype(member)>;
                std::string names = "--" + name;
                if (name == "nodes") names += ",NODES";
                if (name == "tets") names += ",TETS";
                CLI::Option* option = app.add_option(names, member, help);
                if constexpr (std::is_same_v<T, std::vector<std::string>>)
                  option->allow_extra_args(false);  // what follows may be NODES
                if (name == "dt") option->type_name("FLOAT|auto|auto:sharp");
              });
  app.get_option("--modulus")->excludes(app.get_option("--stiffness"));
  app.get_option("--drag")->excludes(app.get_option("--damping"));
}

/** Throws SceneError: a value out of range, parts that contradict each other.
 * Sets m.with.dt and rule from m.dt. */
inline void check_model(Model& m) {
  using CME212::short_text;
  auto require = [](bool ok, const char* option, double value,
                    const std::string& expected) {
    if (!ok)
      throw SceneError(option,
                       "is " + short_text(value) + ", expected " + expected);
  };
  auto not_negative = [](double a) { return a >= 0 && std::isfinite(a); };
  auto positive = [](double a) { return a > 0 && std::isfinite(a); };
  if (m.dt == "auto" || m.dt == "auto:sharp") {
    m.with.rule = m.dt == "auto" ? StepRule::safe : StepRule::sharp;
  } else {
    char* end = nullptr;
    m.with.rule = StepRule::fixed;
    m.with.dt = std::strtod(m.dt.c_str(), &end);
    if (m.dt.empty() || *end != '\0' || !positive(m.with.dt))
      throw SceneError("dt", "is " + m.dt +
                                 ", expected a positive time [s], auto or "
                                 "auto:sharp");
  }
  const bool fixed = m.with.rule == StepRule::fixed;
  require(not_negative(m.t_end), "t-end", m.t_end, "a time [s], 0 or more");
  require(!fixed || m.with.dt <= m.t_end || m.t_end == 0, "dt", m.with.dt,
          "at most --t-end");
  require(!fixed || m.t_end / m.with.dt < 1e15, "t-end", m.t_end,
          "fewer than 1e15 steps of --dt");
  require(not_negative(m.with.damping), "damping", m.with.damping,
          "a drag coefficient [kg/s], 0 or more");
  require(not_negative(m.with.stiffness), "stiffness", m.with.stiffness,
          "a spring constant [N/m], 0 or more");
  require(std::isfinite(m.with.gravity), "gravity", m.with.gravity,
          "an acceleration [m/s^2]");
  const Material& material = m.material;
  if (material.modulus)
    require(not_negative(*material.modulus), "modulus", *material.modulus,
            "a force per width [N/m], 0 or more");
  if (material.density)
    require(positive(*material.density), "density", *material.density,
            "a mass per area [kg/m^2], more than 0");
  if (material.drag)
    require(not_negative(*material.drag), "drag", *material.drag,
            "a drag per area [kg/(s m^2)], 0 or more");
  if (m.tear_strain)
    require(positive(*m.tear_strain), "tear-strain", *m.tear_strain,
            "a strain above that at the start, 0");
  require(positive(m.tolerance), "tolerance", m.tolerance, "more than 0");
  if (!find_method(m.method))
    throw SceneError("method",
                     "is " + m.method + ", expected a name of --list-methods");
  read_measure(m.measure);
  read_edges(m.edges);
  for (const auto& text : m.sheets) read_sheet(text);
  for (const auto& text : m.pins) read_pin(text);
  for (const auto& text : m.planes) read_plane(text);
  for (const auto& text : m.spheres) read_sphere(text);
  for (const auto& text : m.tears) read_tear(text);
  if (!m.self_collision.empty()) read_self_collision(m.self_collision);
  if (!m.sheets.empty() && !(m.nodes.empty() && m.tets.empty()))
    throw SceneError("sheet", "and files of a mesh: expected one of them");
}

/** Throws SceneError unless @a m has a cloth: a scene file may leave it to the
 * command line. */
inline void check_has_cloth(const Model& m) {
  if (m.sheets.empty() && (m.nodes.empty() || m.tets.empty()))
    throw SceneError(m.nodes.empty() ? "nodes" : "tets",
                     "is missing: expected files NODES and TETS, or --sheet");
}

// ---------------------------------------------------------------------- Files

/** A scene file that makes no sense: "FILE:LINE: what is wrong". */
struct SceneFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace scene_file_detail {

/** The line on which each key of a scene file stands.
 * Throws SceneFileError: a line that is not KEY = VALUE, a value that is not
 * closed, a key twice, or one that is no option of @a app. */
inline std::map<std::string, int> lines_of_keys(const CLI::App& app,
                                                const std::string& file,
                                                const std::string& text) {
  std::map<std::string, int> line_of;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    auto fail = [&](const std::string& what) {
      throw SceneFileError(file + ':' + std::to_string(number) + ": " + what);
    };
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const auto equals = line.find('=');
    if (equals == std::string::npos || equals == first)
      fail("\"" + line + "\", expected KEY = VALUE");
    const auto last = line.find_last_not_of(" \t", equals - 1);
    const std::string key = line.substr(first, last - first + 1);
    if (!app.get_option_no_throw("--" + key) || key == "config" ||
        key == "help" || key == "version")
      fail("unknown key " + key);
    if (!line_of.emplace(key, number).second)
      fail(key + " for the second time, first on line " +
           std::to_string(line_of[key]));
    int open = 0;
    bool in_string = false, value = false;
    for (char c : line.substr(equals + 1)) {
      if (c == '"') in_string = !in_string, value = true;
      if (in_string) continue;
      if (c == '#') break;
      open += (c == '[') - (c == ']');
      value = value || (c != ' ' && c != '\t' && c != '\r');
    }
    if (in_string || open != 0)
      fail(key + " has a value that is not closed on its line");
    if (!value) fail(key + " has no value");
  }
  return line_of;
}

}  // namespace scene_file_detail

/** Set the options of @a app from a scene file, and then call @a check(), which
 * may throw SceneError.
 * Throws SceneFileError: a file that can't be read, a wrong line, an unknown
 * key, a value of a wrong type, and what check() threw, all with file and line.
 */
template <typename Check>
void read_scene_file(CLI::App& app, const std::string& file, Check check) {
  std::string text;
  try {
    text = mesh_detail::read_file(file, "a scene file");
  } catch (const InputError& e) {
    throw SceneFileError(e.what());
  }
  const auto line_of = scene_file_detail::lines_of_keys(app, file, text);
  // Which line a message is about: that of the first option that it names.
  auto place = [&](const std::string& message) {
    const auto dashes = message.find("--");
    if (dashes == std::string::npos) return file + ": ";
    const auto name = dashes + 2;
    const auto end =
        message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", name);
    auto it = line_of.find(message.substr(name, end - name));
    if (it == line_of.end()) return file + ": ";
    return file + ':' + std::to_string(it->second) + ": ";
  };
  try {
    std::istringstream in(text);
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.parse_from_stream(in);
    check();
  } catch (const CLI::ParseError& e) {
    throw SceneFileError(place(e.what()) + e.what());
  } catch (const SceneError& e) {
    throw SceneFileError(place(e.what()) + e.what());
  }
}

/** The scene of a file.  Throws SceneFileError */
inline Model load_model(const std::string& file) {
  Model m;
  CLI::App app;
  app.set_config("--config");
  add_model_options(app, m);
  read_scene_file(app, file, [&] {
    check_model(m);
    check_has_cloth(m);
  });
  return m;
}

/** @a m as a scene file: what each key means as a comment, and then what it is
 * set to. What is not named is left out. */
inline std::string to_scene_file(const Model& m) {
  std::ostringstream out;
  auto quoted = [](const std::string& s) { return '"' + s + '"'; };
  each_option(m, [&](const std::string& name, const auto& member,
                     const std::string& help) {
    using T = std::remove_cvref_t<decltype(member)>;
    std::string value;
    if constexpr (std::is_same_v<T, double>) {
      value = CME212::exact_text(member);
    } else if constexpr (std::is_same_v<T, std::optional<double>>) {
      if (member) value = CME212::exact_text(*member);
    } else if constexpr (std::is_same_v<T, std::string>) {
      if (!member.empty()) value = quoted(member);
    } else {
      for (const std::string& s : member)
        value += (value.empty() ? "[" : ", ") + quoted(s);
      if (!value.empty()) value += ']';
    }
    if (name == "stiffness" && m.material.modulus) return;
    if (name == "damping" && m.material.drag) return;
    if (!value.empty())
      out << "# " << help << '\n' << name << " = " << value << '\n';
  });
  return out.str();
}

}  // namespace lab
