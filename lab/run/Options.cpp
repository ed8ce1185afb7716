/** @file Options.cpp
 * The options of ./cloth: their names, groups and help. */
#include "lab/run/Options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <span>
#include <sstream>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "CME212/Util.hpp"
#include "CME212/viewer/Image.hpp"
#include "lab/Nearest.hpp"
#include "lab/methods/Costs.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Checkpoint.hpp"
#include "lab/scenes/SceneFile.hpp"

namespace lab {
namespace {

constexpr const char* version = "1.0.0";

constexpr const char* head =
    R"(Simulates a cloth of masses and springs: that of two files, or a scene.

  ./cloth data/grid2.nodes data/grid2.tets --dt auto
  ./cloth --config data/scenes/drape.toml --strain --csv energies.csv
  ./cloth --config data/scenes/drape.toml --advise --tolerance 0.02

Usage: cloth [OPTIONS] [NODES TETS])";

/** The options of the help, in its order. */
struct Group {
  const char* name;
  std::vector<const char*> options;
};
const std::vector<Group> groups = {
    {"Scene",
     {"config", "nodes", "tets", "sheet", "edges", "pin", "plane", "sphere",
      "tear", "tear-strain", "self-collision", "gravity", "t-end", "view"}},
    {"Material",
     {"stiffness", "modulus", "density", "damping", "drag", "region"}},
    {"Method and step", {"method", "dt", "threads"}},
    {"Output",
     {"headless", "window", "paused", "speed", "strain", "screenshot", "at",
      "record", "slow-motion", "csv", "every", "out", "vtp", "obj", "ply",
      "frame-rate", "quiet"}},
    {"Interrupted runs", {"checkpoint", "every-seconds", "restart"}},
    {"Changes while it runs", {"record-input", "replay"}},
    {"Advice",
     {"measure", "tolerance", "advise", "advise-budget", "auto",
      "write-config"}},
    {"Other", {"dump-config", "list-methods", "version", "help"}}};

/** @a text in lines of at most @a width characters, where words allow. */
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width)
      lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

/** Help in groups, of no more than 80 columns. */
class Help : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string /*name*/,
                        CLI::AppFormatMode /*mode*/) const override {
    std::string text = app->get_description() + '\n';
    for (const Group& g : groups) {
      text += std::string("\n") + g.name + ":\n";
      for (const char* name : g.options)
        text += make_option(app->get_option(std::string("--") + name), false);
    }
    return text;
  }
  std::string make_option(const CLI::Option* o, bool) const override {
    constexpr std::size_t column = 28, width = 80;
    std::string text = "  " + o->get_name(false, true), type;
    if (o->get_type_size() != 0) {
      type = ' ' + o->get_type_name();
      const std::string usual = o->get_default_str();
      if (!usual.empty() && usual != "[]") type += '=' + usual;
    }
    text += type;
    text += text.size() < column - 1 ? std::string(column - text.size(), ' ')
                                     : '\n' + std::string(column, ' ');
    const auto lines = wrapped(o->get_description(), width - column);
    for (std::size_t k = 0; k < lines.size(); ++k)
      text += (k ? std::string(column, ' ') : "") + lines[k] + '\n';
    return text;
  }
};

/** Throws SceneError: an option that can't be used. */
void check(Options& o) {
  using CME212::short_text;
  auto require = [](bool ok, const char* option, double value,
                    const char* expected) {
    if (!ok)
      throw SceneError(option,
                       "is " + short_text(value) + ", expected " + expected);
  };
  require(o.speed >= 0, "speed", o.speed, "0 or more");
  require(o.slow_motion >= 1 && o.slow_motion <= 100, "slow-motion",
          o.slow_motion, "a factor of 1 to 100");
  auto require_ending = [](const char* option, const std::string& file,
                           std::span<const std::string_view> endings) {
    if (file.empty() ||
        std::ranges::count(endings, CME212::ending_of(file)) > 0)
      return;
    std::string known;
    for (std::string_view e : endings)
      known += (known.empty()         ? ""
                : e == endings.back() ? " or "
                                      : ", ") +
               std::string(e);
    throw SceneError(option,
                     "is " + file + ", expected a name that ends in " + known);
  };
  require_ending("screenshot", o.screenshot, CME212::picture_endings);
  require_ending("record", o.video, CME212::film_endings);
  if (CME212::ending_of(o.out) == ".tets")
    throw SceneError("out", "is " + o.out +
                                ", expected a name of points: quads go beside "
                                "FILE.nodes, into FILE.tets");
  require(o.frame_rate > 0 && std::isfinite(o.frame_rate), "frame-rate",
          o.frame_rate, "more than 0 frames a second");
  require(o.advise_budget >= 0, "advise-budget", o.advise_budget,
          "seconds, 0 or more");
  require(o.every_seconds >= 0, "every-seconds", o.every_seconds, "0 or more");
  require(o.every > 0, "every", double(o.every), "a number of steps, 1 up");
  require(o.at < 0 || o.at <= o.model.t_end, "at", o.at,
          "a time up to --t-end");
  if (!o.restart.empty() && (o.advise || o.automatic))
    throw SceneError("restart",
                     "does not go with --advise and --auto: the scene of a "
                     "checkpoint is one that was advised already");
  if (!o.replay.empty())
    for (const auto& [option, given] :
         {std::pair("config", !o.config.empty()),
          std::pair("restart", !o.restart.empty()),
          std::pair("checkpoint", !o.checkpoint.empty()),
          std::pair("csv", !o.csv.empty()), std::pair("vtp", !o.vtp.empty()),
          std::pair("obj", !o.obj.empty()), std::pair("ply", !o.ply.empty()),
          std::pair("at", o.at >= 0), std::pair("window", o.window),
          std::pair("advise", o.asks_advice())})
      if (given)
        throw SceneError("replay",
                         std::string("does not go with --") + option +
                             ", but with --out, --screenshot of the end, "
                             "--record and --record-input");
  if (!o.record_input.empty() && o.replay.empty() &&
      (o.headless || o.pictures()))
    throw SceneError("record-input",
                     "needs a window, where something can be asked for");
  if (!o.record_input.empty() && o.replay.empty() && o.is_fixed())
    throw SceneError("record-input",
                     "does not go with --csv, --vtp, --obj, --ply, "
                     "--checkpoint and --restart: such a run has no panels");
  if (o.window && (o.headless || o.pictures()))
    throw SceneError("window",
                     "does not go with --headless, --screenshot and --record");
}

/** As "42 / 249", or "1" of a method with a limit; "" if never measured. */
std::string cost_of(std::string_view method) {
  using CME212::short_text;
  const auto rounded = [](double a) {
    return short_text(a < 10 ? std::round(10 * a) / 10 : std::round(a));
  };
  for (const MethodCost& c : method_costs)
    if (c.method == method)
      return rounded(c.at_limit) +
             (c.at_ten > 0 ? " / " + rounded(c.at_ten) : "");
  return "";
}

/** Print name, order, cost, limit and advice of every method. */
void list_methods() {
  std::printf(
      "cost: of a step, in steps of verlet; at verlet's limit / at 10 times "
      "that,\n      25 x 25 nodes, solves included (make method-costs)\n"
      "dt omega <: the stability limit without drag; omega: the cloth's "
      "largest\n            frequency [rad/s]\n\n"
      "drag that is not linear in the velocity lowers all splittings, from "
      "verlet to\nsrkn11b, to order 1\n\n"
      "%-18s %5s %9s %10s  %s\n",
      "method", "order", "cost", "dt omega <", "good for");
  for (const MethodEntry& m : methods) {
    std::printf("%-18s %5d %9s ", m.info.name, m.info.order,
                cost_of(m.info.name).c_str());
    if (m.info.limit == no_limit)
      std::printf("%10s", "any");
    else
      std::printf("%10.4g", m.info.limit);
    int indent = 2;
    for (const std::string& text :
         {std::string(m.info.good_for),
          std::string("fails with: ") + m.info.fails_when})
      for (const std::string& line : wrapped(text, 33)) {
        std::printf("%*s%s\n", indent, "", line.c_str());
        indent = 47;
      }
  }
}

/** A run is asked for a tolerance: let a method with error control keep it, if
 * the scene names one or leaves the choice to us.
 * @param given whether the option of a name is given, in a file or here */
void control_error(Model& m, const std::function<bool(const char*)>& given) {
  if (!given("--method") && !given("--dt"))
    m.method = find_method(Dop853::info.name);
  if (!m.method->info.adaptive) return;
  // Steps end where rows and frames are looked at, not where errors do.
  if (!given("--dt") && m.t_end > 0) m.step.dt = std::min(1 / 30., m.t_end);
  m.step.tolerance = tolerance_share * m.tolerance;
}

/** Give @a app all options, which go to @a o and @a scene. */
void add_options(CLI::App& app, Options& o, SceneOptions& scene) {
  app.option_defaults()->always_capture_default();
  scene.add_to(app);
  app.add_flag("--headless", o.headless, "open no window");
  app.add_flag("--window", o.window,
               "require a window: without a display, exit with 4");
  app.add_flag("--paused", o.paused,
               "in a window: wait for space or n at first");
  app.add_option("--speed", o.speed,
                 "in a window: simulated seconds a second, at most; 0: as fast "
                 "as it goes");
  app.add_flag("--strain", o.strain,
               "color the nodes by their springs' strain");
  takes_file(
      app.add_option("--screenshot", o.screenshot,
                     "draw a picture, without a window; the format by its "
                     "ending: .png, .bmp or .ppm"));
  app.add_option("--at", o.at, "time of the screenshot [s]; negative: the end");
  takes_file(app.add_option(
      "--record", o.video,
      "draw a film of 30 frames a second, without a window; the format by "
      "its ending: .mp4, .mkv, .webm or .gif"));
  app.add_option("--slow-motion", o.slow_motion,
                 "of --record: how many times slower contact and tearing are");
  takes_file(app.add_option("--csv", o.csv,
                            "write energies [J] and center of mass [m]"));
  app.add_option("--every", o.every, "steps between two rows of --csv");
  takes_file(app.add_option("--out", o.out,
                            "write the cloth at the end, as NODES with "
                            "velocities, and as TETS beside them"));
  takes_file(app.add_option("--vtp", o.vtp,
                            "write frames of all that is known for ParaView, "
                            "and frames.pvd with their times"))
      ->type_name("FOLDER");
  takes_file(app.add_option("--obj", o.obj,
                            "write frames of points and quads for Blender"))
      ->type_name("FOLDER");
  takes_file(
      app.add_option("--ply", o.ply, "the same with velocities and strains"))
      ->type_name("FOLDER");
  app.add_option("--frame-rate", o.frame_rate,
                 "frames of these a second of simulated time [1/s]");
  takes_file(app.add_option(
      "--checkpoint", o.checkpoint,
      "write now and then, and at the end, all that --restart needs"));
  app.add_option("--every-seconds", o.every_seconds,
                 "seconds of the clock between two checkpoints; 0: every step");
  takes_file(app.add_option(
      "--restart", o.restart,
      "go on from a checkpoint, to the same bits as without; its scene need "
      "not be given; --csv goes on if it holds the rows so far"));
  takes_file(app.add_option("--record-input", o.record_input,
                            "in a window: write the scene and all that is "
                            "asked of it, for --replay"));
  takes_file(app.add_option(
      "--replay", o.replay,
      "run what --record-input wrote again, without a window, to the same "
      "bits; with --out, --screenshot of its end and --record"));
  app.add_option("--threads", o.threads,
                 "threads for a large cloth; 0: one a processor. They change "
                 "no result")
      ->check(CLI::Range(0, 1024).description(""));
  app.add_flag("--quiet", o.quiet, "print nothing but errors");
}

/** Say what is wrong with a command line.  @return the exit status */
int report(const CLI::App& app, const CLI::ParseError& e) {
  if (e.get_exit_code() == 0) return app.exit(e);
  std::string message = e.what();
  std::vector<std::string> names;
  for (const Group& g : groups)
    for (const char* name : g.options)
      names.push_back(std::string("--") + name);
  for (std::string word : app.remaining()) {
    word = word.substr(0, word.find('='));
    if (!word.starts_with("-") || std::ranges::count(names, word)) continue;
    const std::string meant = did_you_mean(word, names);
    message = word + " is no option" + (meant.empty() ? ": see --help" : meant);
    break;
  }
  std::cerr << "cloth: " << message << '\n';
  return 2;
}

}  // namespace

int parse(int argc, char** argv, Options& o) {
  std::string& file = o.config;
  bool dump = false;
  std::vector<std::string> in_file;
  double kept_tolerance = 0;  // of a checkpoint's steps
  SceneOptions scene;
  CLI::App first;  // finds the scene file
  first.set_help_flag();
  first.allow_extras();
  takes_file(first.add_option("--config", file));
  takes_file(first.add_option("--restart", o.restart));
  try {
    first.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return report(first, e);
  }
  if (!file.empty() || !o.restart.empty()) {
    CLI::App app;
    add_options(app, o, scene);
    auto take = [&] {
      if (!file.empty())
        for (const CLI::Option* option : app.get_options())
          if (option->count() > 0) in_file.push_back(option->get_name());
      o.model = scene.model();
      check(o);
    };
    if (!file.empty()) {
      scene.read(app, file, take);
    } else {
      const std::string from = o.restart;
      const SavedScene saved = scene_in_checkpoint(from);
      scene.read_text(app, from, saved.name, saved.text, take);
      kept_tolerance = saved.step_tolerance;
    }
  }

  CLI::App app(head, "cloth");
  app.formatter(std::make_shared<Help>());
  app.set_help_flag("-h,--help", "print this, and end");
  add_options(app, o, scene);
  takes_file(
      app.add_option("--config", file, "read options from a file: a scene"));
  app.add_flag("--dump-config", dump, "print the scene as a file, and end");
  app.add_flag("--advise", o.advise,
               "find out by short runs which parts, grid, method and step the "
               "measure needs to its tolerance; print it, and end");
  app.add_option("--advise-budget", o.advise_budget,
                 "seconds that finding out may take, counted in work; 0: the "
                 "larger of 2 and what the run takes");
  app.add_flag("--auto", o.automatic, "run what --advise would advise");
  takes_file(app.add_option("--write-config", o.advised,
                            "write the scene that is advised to this file"));
  app.set_version_flag("--version", std::string("cloth ") + version,
                       "print the version, and end");
  app.add_flag_callback(
      "--list-methods",
      [] {
        list_methods();
        throw CLI::Success();
      },
      "print the table of methods, and end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return report(app, e);
  }
  if (!o.replay.empty())
    for (const std::string& key : scene_keys())
      if (app.count("--" + key) > 0)
        throw SceneError("replay", "does not go with --" + key +
                                       ": a recording has its own scene");
  scene.overridden_by(app);
  o.origins = scene.origins();
  o.model = scene.model();
  o.model.step.tolerance = kept_tolerance;
  const auto given = [&](const char* name) {
    return app.count(name) > 0 || std::ranges::count(in_file, name) > 0;
  };
  if (given("--tolerance") && !o.asks_advice()) {
    control_error(o.model, given);
    if (app.count("--tolerance") > 0 && o.model.step.tolerance == 0 && !o.quiet)
      std::cerr << "cloth: warning: --tolerance has no effect on "
                << o.model.method->info.name
                << ", which does not control its error: leave --dt and "
                   "--method away, or take --method dop853\n";
  }
  check(o);
  if (o.replay.empty()) check_has_cloth(o.model);
  if (!dump) return -1;
  std::cout << to_scene_file(o.model);
  return 0;
}

}  // namespace lab
