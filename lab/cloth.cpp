/** @file cloth.cpp
 * The laboratory's program: ./cloth [options] NODES TETS, or --config SCENE;
 * see
 * --help.
 *
 * Exit status: 0 done; 2 an input or an option that can't be used, or an
 * output that can't be written; 3 the run diverged; 4 no display. */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "lab/advice/Advise.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/viewer/Run.hpp"
#include "lab/viewer/Screen.hpp"

using CME212::short_text;
using namespace lab;

namespace {

constexpr const char* version = "1.0.0";

/** Throws SceneError: an option that can't be used. */
void check(Options& o) {
  auto require = [](bool ok, const char* option, double value,
                    const char* expected) {
    if (!ok)
      throw SceneError(option,
                       "is " + short_text(value) + ", expected " + expected);
  };
  require(o.speed >= 0, "speed", o.speed, "0 or more");
  require(o.every > 0, "every", double(o.every), "a number of steps, 1 up");
  require(o.at < 0 || o.at <= o.model.t_end, "at", o.at,
          "a time up to --t-end");
  if (o.window && (o.headless || o.pictures()))
    throw SceneError("window",
                     "does not go with --headless, --screenshot and --record");
}

/** Print name, order, cost, limit and advice of every method. */
void list_methods() {
  std::printf("%-18s %5s %6s %9s  %s\n", "method", "order", "sweeps",
              "dt omega<", "good for; fails when");
  for (const MethodEntry& m : methods) {
    std::printf("%-18s %5d %6d ", m.info.name, m.info.order, m.info.sweeps);
    if (m.info.limit == no_limit)
      std::printf("%9s", "any");
    else
      std::printf("%9.4g", m.info.limit);
    std::printf("  %s;\n%42s%s\n", m.info.good_for, "", m.info.fails_when);
  }
}

/** Give @a app all options, which go to @a o and @a scene. */
void add_options(CLI::App& app, Options& o, SceneOptions& scene) {
  app.option_defaults()->always_capture_default();
  scene.add_to(app);
  app.add_flag("--headless", o.headless, "open no window");
  app.add_flag("--window", o.window,
               "insist on a window: without a display, exit with 4");
  app.add_flag("--paused", o.paused,
               "in a window: wait for space or n at first");
  app.add_option("--speed", o.speed,
                 "in a window: at most so many simulated seconds a second; 0 "
                 "as fast as it goes");
  app.add_flag("--strain", o.strain,
               "color the nodes by their springs' strain");
  app.add_option("--screenshot", o.screenshot,
                 "draw a picture FILE.png, without a window")
      ->type_name("FILE");
  app.add_option("--at", o.at, "time of the screenshot [s]; negative: the end");
  app.add_option("--record", o.video,
                 "draw a film FILE.mp4 of 30 frames a second, without a window")
      ->type_name("FILE");
  app.add_option("--csv", o.csv, "write energies [J] and center of mass [m]")
      ->type_name("FILE");
  app.add_option("--every", o.every, "steps between two rows of --csv");
  app.add_option("--out", o.out, "write the positions at the end, as NODES")
      ->type_name("FILE");
  app.add_option("--threads", o.threads,
                 "threads of a large cloth's sweeps; 0: one a processor. They "
                 "change no result")
      ->check(CLI::Range(0, 1024));
  app.add_flag("--quiet", o.quiet, "print nothing but errors");
}

/** Read the scene file, if there is one, and then the command line, which wins.
 * @return the exit status to end with, or -1
 * Throws SceneError, SceneFileError */
int parse(int argc, char** argv, Options& o) {
  std::string file;
  bool dump = false;
  SceneOptions scene;
  CLI::App first;  // finds the scene file
  first.set_help_flag();
  first.allow_extras();
  first.add_option("--config", file);
  try {
    first.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return first.exit(e) == 0 ? 0 : 2;
  }
  if (!file.empty()) {
    CLI::App app;
    app.set_config("--config");
    add_options(app, o, scene);
    scene.read(app, file, [&] {
      o.model = scene.model();
      check(o);
    });
  }

  CLI::App app(std::string("Simulates a cloth of masses and springs: that of "
                           "NODES and TETS, or of a scene."),
               "cloth");
  add_options(app, o, scene);
  app.add_option("--config", file, "read options from a file: a scene")
      ->type_name("FILE");
  app.add_flag("--dump-config", dump, "print the scene as a file, and end");
  app.add_flag("--advise", o.advise,
               "find out which parts, grid, method and step the measure needs "
               "to its tolerance, by short runs; print it, and end");
  app.add_flag("--auto", o.automatic, "run what --advise would advise");
  app.add_option("--write-config", o.advised,
                 "write the scene that is advised to this file")
      ->type_name("FILE");
  app.set_version_flag("--version", std::string("cloth ") + version +
                                        ", Cholesky by " +
                                        SparseCholesky::back_end);
  app.add_flag_callback(
      "--list-methods",
      [] {
        list_methods();
        throw CLI::Success();
      },
      "print the table of methods");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  o.model = scene.model();
  check(o);
  check_has_cloth(o.model);
  if (!dump) return -1;
  std::cout << to_scene_file(o.model);
  return 0;
}

/** Print what a scene of parts is asked, and what this run answers; but for
 * positions, which are many: --out writes them. */
void print_answer(const Scene& scene, const Model& m) {
  if (m.measure == Measure::positions) return;
  std::cout << name_of(m.measure) << ':';
  for (double a : answer(m, scene.cloth())) std::cout << ' ' << a;
  std::cout << ' ' << unit_of(m.measure) << '\n';
}

/** Run without a window; draw if pictures are wanted.  @return exit status */
int run_headless(Scene& scene, Run& run, const Options& o) {
  if (!o.pictures()) {
    run.to_end();
    return run.finish();
  }
  Screen screen(Screen::Kind::pictures);
  screen.show_strain(o.strain);
  if (!o.video.empty()) screen.start_film(o.video);
  const double frame_time = 1.0 / Screen::frames_per_second;
  long long frames = 0;
  bool shot = o.screenshot.empty();
  auto draw = [&] {
    // Half a step early is as good as half a step late.
    const double now = scene.time() + scene.dt() / 2;
    bool frame = !o.video.empty() && now >= double(frames) * frame_time;
    bool picture = !shot && (run.done() || (o.at >= 0 && now >= o.at));
    if (frame || picture) run.check();
    const bool failed = !scene.failure().empty();
    if (failed) frame = !o.video.empty(), picture = !shot;
    if (frame || picture) screen.show(scene);
    // A film of a failure ends with time to read why.
    const double until = failed ? double(frames + 59) * frame_time : now;
    while (frame && until >= double(frames) * frame_time)
      screen.add_to_film(), ++frames;
    if (picture) screen.save_picture(o.screenshot), shot = true;
  };
  draw();
  run.to_end(draw);
  if (!o.video.empty()) {
    std::string film = screen.end_film();
    if (!o.quiet) std::cout << "film: " << film << '\n';
  }
  if (!o.screenshot.empty() && !o.quiet)
    std::cout << "picture: " << o.screenshot << '\n';
  return run.finish();
}

/** Run in a window: the simulation in a thread of its own, at most o.speed
 * times as fast as the clock. A run that failed stays on the screen until it
 * is restarted or the window is closed.  @return exit status */
int run_in_window(Scene& scene, Run& run, const Options& o, Screen& screen) {
  screen.show_strain(o.strain);
  screen.set_paused(o.paused);
  screen.show(scene);
  std::exception_ptr error;
  std::thread simulation([&] {
    try {
      CME212::Clock clock;
      double ahead = 0;  // simulated before the clock started [s]
      while (!screen.closed()) {
        if (screen.take_restart()) {
          run.restart();
          screen.show(scene);
        }
        if (run.done()) {
          if (screen.coloring_changed()) screen.show(scene);
          CME212::sleep(0.01);
          continue;
        }
        if (!screen.wait_while_paused(scene)) continue;
        run.advance();
        if (screen.wants_frame() || run.done()) {
          run.check();
          screen.show(scene);
        }
        if (o.speed > 0) {
          double early = (scene.time() - ahead) / o.speed - clock.seconds();
          if (early > 0 && early < 1)
            CME212::sleep(early);
          else if (early != 0)  // late, paused or restarted: count anew
            clock.start(), ahead = scene.time();
        }
      }
    } catch (...) {
      error = std::current_exception();
      screen.close();
    }
  });
  screen.event_loop();
  simulation.join();
  if (error) std::rethrow_exception(error);
  return run.finish();
}

/** Take the advice on the scene of @a o: print it, write it, or put it into
 * o.model.  @return the exit status to end with, or -1 */
int take_advice(Options& o) {
  std::optional<CME212::OutputFile> file;
  if (!o.advised.empty()) file.emplace(o.advised);
  const Advice advice = advise(o.model);
  if (!o.quiet) std::cout << in_words(advice);
  if (!advice.refusal.empty()) {
    if (o.quiet) std::cerr << "cloth: no advice: " << advice.refusal << '\n';
    return 2;
  }
  if (file) {
    file->stream() << to_scene_file(advice.model);
    file->commit();
  }
  o.model = advice.model;
  return o.automatic ? -1 : 0;
}

/** Load, choose how to run, run.  @return exit status */
int run(Options o) {
  Sweep::set_threads(o.threads);
  if (o.advise || o.automatic || !o.advised.empty())
    if (int status = take_advice(o); status >= 0) return status;
  const Model& m = o.model;
  Recipe recipe = recipe_of(m);
  std::unique_ptr<Screen> window;
  if (!o.headless && !o.pictures()) {
    if (Screen::has_display() || o.window) {
      window = std::make_unique<Screen>(Screen::Kind::window);
    } else if (Screen::can_draw) {
      std::filesystem::create_directories("demo");
      o.screenshot = "demo/" + recipe.name + ".png";
      o.video = "demo/" + recipe.name + ".mp4";
      if (!o.quiet)
        std::cout << "no display: running without a window; a picture and a "
                     "film go to the folder demo\n";
    }
  }
  // Wrong paths shall end the run before it starts.
  for (const std::string& file : {o.screenshot, o.video})
    if (!file.empty()) CME212::OutputFile try_it(file);
  Scene scene(std::move(recipe), m.step, *m.method);
  Run run(scene, o);
  if (!o.quiet)
    std::cout << scene.cloth().num_nodes() << " nodes, "
              << scene.cloth().num_edges() << " edges\n";
  run.announce();
  const int status = window ? run_in_window(scene, run, o, *window)
                            : run_headless(scene, run, o);
  if (status == 0 && !o.quiet) print_answer(scene, m);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  try {
    int status = parse(argc, argv, o);
    return status >= 0 ? status : run(o);
  } catch (const NoDisplay& e) {
    std::cerr << "cloth: " << e.what() << '\n';
    return 4;
  } catch (const InputError& e) {
    std::cerr << e.what() << '\n';
    return 2;
  } catch (const SceneFileError& e) {
    std::cerr << e.what() << '\n';
    return 2;
  } catch (const std::exception& e) {
    std::cerr << "cloth: " << e.what() << '\n';
    return 2;
  }
}
