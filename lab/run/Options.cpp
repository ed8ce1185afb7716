/** @file Options.cpp
 * The options of ./cloth: their names, groups and help. */
#include "lab/run/Options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <span>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "CME212/Util.hpp"
#include "CME212/viewer/Image.hpp"
#include "lab/fast/Lanes.hpp"
#include "lab/fast/Version.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "lab/run/Terminal.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/Nearest.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Changes.hpp"
#include "lab/stepping/Checkpoint.hpp"
#include "lab/stepping/RestReport.hpp"

namespace lab {
namespace {

constexpr const char* head =
    R"(Simulates a cloth of masses and springs from mesh files or a scene.

  ./cloth data/grid2.nodes data/grid2.tets --dt auto
  ./cloth --config data/scenes/drape.toml --strain --csv energies.csv
  ./cloth --config data/scenes/drape.toml --advise --tolerance 0.02

Usage: cloth [OPTIONS] [NODES TETS | NET])";

/** The groups of the help, in its order. */
constexpr std::array groups = {"Scene",  "Material",         "Method and step",
                               "Output", "Interrupted runs", "Advice",
                               "Other"};

/** Help in groups, of no more than 80 columns. */
class Help : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string /*name*/,
                        CLI::AppFormatMode /*mode*/) const override {
    std::string text = app->get_description() + '\n';
    for (const char* group : groups) {
      text += std::string("\n") + group + ":\n";
      for (const CLI::Option* o : app->get_options())
        if (o->get_group() == group) text += make_option(o, false);
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

/** Of --rest: let the scene begin at rest and end there.
 * Throws SceneError: what is no matter of rest */
void begin_and_end_at_rest(Options& o) {
  Model& m = o.model;
  const auto refuse = [](bool wrong, const std::string& what) {
    if (wrong) throw SceneError("rest", "cannot be " + what);
  };
  refuse(o.asks_advice() || !o.restart.empty() || !o.checkpoint.empty() ||
             !o.video.empty() || o.window,
         "combined with --advise, --assess, --auto, --restart, --checkpoint, "
         "--record or --window: it makes no run");
  check_has_rest(m);
  refuse(m.measure.over_time(),
         "asked for a measure over time: expected one of a state");
  m.from_rest = true, m.t_end = 0, m.step = {};
  o.headless = true, o.bounds_error = false;
}

/** Throws SceneError: an option that can't be used. */
void check(Options& o) {
  auto require = [](bool ok, const char* option, double value,
                    const char* expected) {
    if (!ok) throw SceneError(option, CME212::short_text(value), expected);
  };
  require(o.speed >= 0, "speed", o.speed, "0 or more");
  require(o.slow_motion >= 1 && o.slow_motion <= 100, "slow-motion",
          o.slow_motion, "a factor of 1 to 100");
  auto require_ending = [](const char* option, const std::string& file,
                           std::span<const std::string_view> endings) {
    if (file.empty() ||
        std::ranges::count(endings, CME212::ending_of(file)) > 0)
      return;
    std::string known(endings.front());
    for (std::string_view e : endings.subspan(1))
      known += (e == endings.back() ? " or " : ", ") + std::string(e);
    throw SceneError(option, file, "a name that ends in " + known);
  };
  require_ending("screenshot", o.screenshot,
                 std::array{std::string_view(".png")});
  require_ending("record", o.video, CME212::film_endings);
  if (!o.size.empty()) {
    auto& [width, height] = o.pixels;
    char x = 0, more = 0;
    const int read =
        std::sscanf(o.size.c_str(), "%d%c%d%c", &width, &x, &height, &more);
    const auto is_good = [](int a) {
      return a % 2 == 0 && 64 <= a && a < 8192;
    };
    if (read != 3 || x != 'x' || !is_good(width) || !is_good(height))
      throw SceneError("size", o.size,
                       "WIDTHxHEIGHT, even numbers of pixels from 64 to 8190");
  }
  if (CME212::ending_of(o.out) == ".tets")
    throw SceneError("out", o.out,
                     "a file of points, such as FILE.nodes: the quads go into "
                     "FILE.tets");
  const Model& m = o.model;
  if (!o.out.empty() && CME212::ending_of(o.out) != ".net" &&
      (needs_net(m.net + m.nodes, m.tets) ||
       std::ranges::any_of(m.sheets, [](const Sheet& s) {
         return s.nodes[0] == 1 || s.nodes[1] == 1;
       })))
    throw SceneError("out", o.out,
                     "a name that ends in .net: other files hold quads alone");
  require(o.frame_rate > 0 && std::isfinite(o.frame_rate), "frame-rate",
          o.frame_rate, "more than 0 frames a second");
  require(o.advise_work >= 0 && std::isfinite(o.advise_work), "advise-work",
          o.advise_work, "spring evaluations, 0 or more");
  require(o.every_seconds >= 0, "every-seconds", o.every_seconds, "0 or more");
  require(o.every > 0, "every", double(o.every), "at least 1 step");
  require(o.at < 0 || o.at <= o.model.t_end, "screenshot-at", o.at,
          "a time up to --t-end");
  if (!o.restart.empty() && o.asks_advice())
    throw SceneError("restart",
                     "cannot be combined with --advise, --assess or --auto: "
                     "the scene of a checkpoint is fixed");
  if (!o.json.empty() && !o.asks_advice())
    throw SceneError("json", "needs --advise, --assess or --auto");
  read_changes(o.model.at);
  if (o.rest) begin_and_end_at_rest(o);
  if (o.window && (o.headless || o.pictures()))
    throw SceneError(
        "window",
        "cannot be combined with --headless, --screenshot or --record");
}

/** As "42 / 249", or "1" of a method with a limit. */
std::string text_of(const MethodInfo::Cost& cost) {
  using CME212::short_text;
  const auto rounded = [](double a) {
    return short_text(a < 10 ? std::round(10 * a) / 10 : std::round(a));
  };
  return rounded(cost.at_limit) +
         (cost.at_ten > 0 ? " / " + rounded(cost.at_ten) : "");
}

/** Print name, order, cost, limit and advice of every method. */
void list_methods() {
  std::printf(
      "cost: work of a step in verlet steps, at verlet's limit / at 10 times "
      "that,\n      25 x 25 nodes, linear solves included (make method-costs)\n"
      "dt omega <: the stability limit without drag; omega: the cloth's "
      "largest\n            frequency [rad/s]\n\n"
      "with drag that is not linear in the velocity all splitting methods, "
      "verlet to\nsrkn11b, have order 1\n\n"
      "%-18s %5s %9s %10s  %s\n",
      "method", "order", "cost", "dt omega <", "good for");
  for (const MethodEntry& m : methods) {
    std::printf("%-18s %5d %9s ", m.info.name.data(), m.info.order,
                text_of(m.info.cost).c_str());
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
  std::puts(
      "\nto look right at 60 frames a second, take verlet while a frame takes "
      "it less\nwork, else implicit-euler, or xpbd on nearly rigid cloth");
}

/** A run has a tolerance: set the method and the first steps by which to keep
 * it, unless the scene names a method or a step without error control.
 * @param given(NAME) true if the option NAME is given, in a file or here */
void control_error(Options& o, const std::function<bool(const char*)>& given) {
  Model& m = o.model;
  const bool free = !given("method") && !given("dt");
  // Where nodes touch, a method of high order costs more for the same error.
  if (free) m.method = m.has_contact() ? &table::verlet : &table::rkn64;
  o.chooses_method = free;
  o.bounds_error = free || m.method->info.adaptive;
  if (!m.method->info.adaptive) return;
  // Steps end where rows and frames are looked at, not where errors do.
  if (!given("dt") && m.t_end > 0) m.step.dt = std::min(1 / 30., m.t_end);
  m.step.tolerance = tolerance_share * m.tolerance;
}

/** Let @a option take the name of a file: neither an empty name, as of a
 * shell's variable that is not set, nor the next option, as if the name had
 * been forgotten.  @return it */
CLI::Option* takes_file(CLI::Option* option) {
  return option->type_name("FILE")->check([](const std::string& name) {
    if (name.empty()) return std::string("is empty, expected a file name");
    if (!name.starts_with("--")) return std::string();
    return "is " + name + ", expected a file name, such as ./" + name;
  });
}

CLI::Option* add_file(CLI::App& app, const char* name, std::string& file,
                      const char* help = "") {
  return takes_file(app.add_option(name, file, help));
}

/** Give @a app an option for each field of a scene; the defaults in the help
 * are those of @a m. */
void add_fields(CLI::App& app, Model& m) {
  for (const Field& f : fields_of(m)) {
    const bool is_file = f.role == Role::mesh;
    std::string name = std::string("--") + f.name;
    for (const char* file : {"nodes,NODES", "tets,TETS"})
      if (std::string(file).starts_with(f.name + std::string(",")))
        name = std::string("--") + file;  // may come without its name
    CLI::Option* option =
        std::holds_alternative<bool*>(f.member)
            ? app.add_flag(name, f.help)
            : app.add_option(
                  name, [](const CLI::results_t&) { return true; }, f.help);
    option->type_name(f.type())->group(f.group);
    if (is_file) takes_file(option);
    if (f.repeats())  // what follows a value may be NODES
      option->expected(1, CLI::detail::expected_max_vector_size)
          ->allow_extra_args(false);
    else if (const auto values = f.values(); !values.empty())
      option->default_str(values[0]);
    if (!f.instead_of.empty())
      option->excludes(app.get_option("--" + std::string(f.instead_of)));
  }
}

/** Give @a app the options of a run, which go to @a o. */
void add_run_options(CLI::App& app, Options& o) {
  app.option_defaults()->always_capture_default()->group("Output");
  app.add_flag("--headless", o.headless, "open no window");
  app.add_flag("--window", o.window,
               "require a window: exit with status 4 without a display");
  app.add_flag("--paused", o.paused,
               "in a window: start paused; space continues, n makes one step");
  app.add_option("--speed", o.speed,
                 "in a window: limit on simulated seconds per second; 0: none");
  app.add_flag("--strain", o.strain,
               "color the nodes by the mean strain of their springs");
  add_file(app, "--screenshot", o.screenshot,
           "draw a picture FILE.png without a window");
  app.add_option("--screenshot-at", o.at,
                 "time of the screenshot [s]; negative: the end");
  add_file(app, "--record", o.video,
           "draw a film of 30 frames per second without a window; the ending "
           "of FILE sets the format: .mp4 or .gif");
  app.add_option("--size", o.size,
                 "of --screenshot and --record: WIDTHxHEIGHT [pixels]");
  app.add_option("--slow-motion", o.slow_motion,
                 "of --record: slow contact and tearing down by this factor");
  add_file(app, "--csv", o.csv, "write energies [J] and center of mass [m]");
  app.add_option("--every", o.every, "steps between two rows of --csv");
  add_file(app, "--out", o.out,
           "write the final points and velocities as NODES, and the remaining "
           "quads as TETS beside it; or FILE.net, with all springs and masses");
  add_file(app, "--vtp", o.vtp,
           "write frames for ParaView with all data of nodes, springs and "
           "quads, and frames.pvd with their times")
      ->type_name("FOLDER");
  add_file(app, "--ply", o.ply,
           "write frames of points, with velocities and strains, and quads for "
           "Blender")
      ->type_name("FOLDER");
  app.add_option("--frame-rate", o.frame_rate,
                 "of --vtp and --ply: frames per simulated second [1/s]");
  app.add_flag("--rest", o.rest,
               "instead of a run find the equilibrium: print whether it is "
               "stable, forces at pins, frequencies and stable steps; write "
               "files of this state")
      ->group("Method and step");
  app.add_flag("--quiet", o.quiet, "print nothing but errors");
  app.add_flag("--verbose", o.verbose,
               "print, too, what acts on the cloth and what each part costs");
  app.option_defaults()->group("Interrupted runs");
  add_file(app, "--checkpoint", o.checkpoint,
           "save the run for --restart, regularly and at the end");
  app.add_option("--every-seconds", o.every_seconds,
                 "real time between two checkpoints [s]; 0: one in every step");
  add_file(app, "--restart", o.restart,
           "continue from a checkpoint, to the same bits as without the "
           "interruption; the scene may be omitted; --csv continues the file "
           "of that run");
  app.add_option("--threads", o.threads,
                 "threads for a large cloth, which change no result; 0: one "
                 "per processor")
      ->check(CLI::Range(0, 1024).description(""))
      ->group("Method and step");
}

/** Say what is wrong with a command line.  @return the exit status */
int report(const CLI::App& app, const CLI::ParseError& e) {
  if (e.get_exit_code() == 0) return app.exit(e);
  std::string message = e.what();
  std::vector<std::string> names, words;
  for (const CLI::Option* o : app.get_options()) names.push_back(o->get_name());
  if (!app.get_allow_extras()) words = app.remaining();
  for (std::string word : words) {
    word = word.substr(0, word.find('='));
    if (!word.starts_with("-") || std::ranges::count(names, word)) continue;
    const std::string meant = key_instead_of(word, names);
    message =
        word + " is not an option" + (meant.empty() ? ": see --help" : meant);
    break;
  }
  std::cerr << "cloth: " << message << '\n';
  return 2;
}

/** Read the scene file @a file with the options of a run in it: into @a m what
 * the file names, into @a o the options, and a scene to be checked. */
void read_file(const std::string& file, const std::string& text, Model& m,
               Options& o) {
  CLI::App app;
  add_run_options(app, o);
  const auto option_of_run = [&](const KeyValue& found) {
    CLI::Option* option = app.get_option_no_throw("--" + found.key);
    if (!option || found.key == "help") return false;
    const std::string type = option->get_type_name();
    const bool is_file = type == "FILE" || type == "FOLDER";
    for (const std::string& value : found.values)
      option->add_result(is_file ? beside(file, value) : value);
    return true;
  };
  const auto check_all = [&] {
    app.parse(std::vector<std::string>());
    o.model = checked(m);
    check(o);
  };
  o.origins = set_fields(m, file, text, check_all, option_of_run);
}

}  // namespace

int parse(int argc, char** argv, Options& o) {
  o.words.assign(argv, argv + argc);
  const std::string& file = o.config;
  bool dump = false;
  double kept_tolerance = 0;  // of a checkpoint's steps
  Model m;
  CLI::App first;  // finds the scene file
  first.set_help_flag();
  first.allow_extras();
  add_file(first, "--config", o.config);
  add_file(first, "--restart", o.restart);
  try {
    first.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return report(first, e);
  }
  if (!file.empty()) {
    m.name = scene_name(file);
    read_file(file, scene_text(file), m, o);
  } else if (const std::string from = o.restart; !from.empty()) {
    const SavedScene saved = scene_in_checkpoint(from);
    m.name = saved.name;
    read_file(from, saved.text, m, o);
    kept_tolerance = saved.step_tolerance;
  }

  CLI::App app(head, "cloth");
  app.formatter(std::make_shared<Help>());
  add_file(app, "--config", o.config, "read a scene and options from a file")
      ->group("Scene");
  add_fields(app, m);
  add_run_options(app, o);
  app.option_defaults()->group("Advice");
  app.add_flag("--advise", o.advise,
               "find by trial runs which parts, grid, method and step the "
               "measure needs to reach its tolerance; print them and exit");
  app.add_option("--advise-work", o.advise_work,
                 "spring evaluations that the trial runs may take; 0: the "
                 "larger of 4e8, a few seconds, and the work of one run, or of "
                 "24 for a mesh from files, eight for --assess");
  app.add_flag("--assess", o.assess,
               "find by trial runs how large the errors of this grid, step and "
               "method are, and the largest step that meets the tolerance")
      ->excludes("--advise");
  add_file(app, "--json", o.json, "write what --advise or --assess finds");
  app.add_flag("--auto", o.automatic, "run the scene that --advise recommends");
  add_file(app, "--write-config", o.advised,
           "write the scene, or with --advise or --auto the recommended one, "
           "to this file; without --auto, exit then");
  app.option_defaults()->group("Other");
  app.add_flag("--dump-config", dump, "print the scene as a file and exit");
  app.add_flag_callback(
      "--list-methods",
      [] {
        list_methods();
        throw CLI::Success();
      },
      "print the table of methods and exit");
  app.set_version_flag(
      "--version",
      [] {
        return std::string("cloth ") + version + ", kernels " +
               lanes::name_of(lanes::fastest_cpu());
      },
      "print the version and the fastest kernels here and exit");
  app.set_help_flag("-h,--help", "print this help and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return report(app, e);
  }
  const auto given = [&, in_file = o.origins.line_of](const char* name) {
    return app.count(std::string("--") + name) > 0 ||
           (!file.empty() && in_file.count(name) > 0);
  };
  // An option of the command line replaces that of the file.
  for (const CLI::Option* option : app.get_options())
    if (option->count() > 0)
      o.origins.line_of.erase(option->get_name().substr(2));
  for (const std::string& key : scene_keys())
    if (app.count("--" + key) > 0)
      set_field(m, key, app.get_option("--" + key)->results());
  o.model = checked(m);
  if (file.empty() && o.restart.empty()) o.model = or_assignment(o.model);
  o.keeps_method = app.count("--method") > 0;
  o.keeps_step = app.count("--dt") > 0 && o.model.step.fixed();
  o.model.step.tolerance = kept_tolerance;
  if (!given("tolerance")) o.unnamed = {"tolerance"};
  if (given("tolerance") && !o.asks_advice()) {
    if (o.model.percent)
      throw SceneError("tolerance",
                       "is " + CME212::short_text(o.model.tolerance) +
                           "%, which needs --advise, --assess or --auto: "
                           "expected an error of the positions [m]");
    control_error(o, given);
    if (o.chooses_method) o.unnamed = {"method", "dt"};
    if (app.count("--tolerance") > 0 && !o.bounds_error && !o.quiet)
      std::cerr << "cloth: warning: --tolerance has no effect on "
                << o.model.method->info.name
                << ", which does not control its error: omit --dt and "
                   "--method, or use --method rkn64\n";
  }
  check(o);
  check_has_cloth(o.model);
  if (!dump) return -1;
  std::cout << to_scene_file(o.model, o.unnamed);
  return 0;
}

}  // namespace lab
