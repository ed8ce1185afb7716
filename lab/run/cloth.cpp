/** @file cloth.cpp
 * The laboratory's program: ./cloth [OPTIONS] NODES TETS, or --config SCENE;
 * see --help.
 *
 * Exit status: 0 done; 2 an input or an option that can't be used, or an
 * output that can't be written; 3 the run failed: it diverged, or it could not
 * keep what it was asked to keep; 4 no display; 128 + N signal N ended it: 130
 * Ctrl-C, 143 SIGTERM, 129 SIGHUP. */
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "lab/advice/Advise.hpp"
#include "lab/fast/Lanes.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Film.hpp"
#include "lab/run/Options.hpp"
#include "lab/run/Progress.hpp"
#include "lab/run/Run.hpp"
#include "lab/run/Terminal.hpp"
#include "lab/run/Window.hpp"
#include "lab/scenes/Interrupt.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Accuracy.hpp"
#include "lab/stepping/RestReport.hpp"
#include "lab/stepping/Trial.hpp"
#include "lab/viewer/Screen.hpp"

using namespace lab;

namespace {

/** Print the measure of the scene and its value in this run. Positions are not
 * printed, as there are many: --out writes them. */
void print_answer(const Run& run, const Scene& scene, const Model& m) {
  if (m.measure.quantity == Measure::positions) return;
  const Answer answer = run.answer();
  std::cout << name_of(m.measure) << ':';
  for (double a : answer) std::cout << ' ' << a;
  const std::string unit = unit_of(m.measure);
  std::cout << (unit.empty() ? "" : " ") << (answer.empty() ? "none" : unit)
            << (m.measure.over_time() ? " until t = " : " at t = ")
            << scene.time() << " s\n";
}

/** Take the advice on the scene of @a o: print it, write it, or put it into
 * o.model.  @return the exit status to end with, or -1 */
int take_advice(Options& o) {
  Progress progress(o.quiet);
  AdviceRules rules;
  rules.budget = o.advise_work;
  rules.keeps_method = o.keeps_method, rules.keeps_step = o.keeps_step;
  rules.tell = std::bind_front(&Progress::tell, &progress);
  // The budget counts on one thread; a team that other programs keep waiting
  // takes many times as long.
  Sweep::set_threads(std::max(1, o.threads));
  const Advice advice =
      o.assess ? assess(o.model, rules) : advise(o.model, rules);
  Sweep::set_threads(o.threads);
  progress.end();
  if (!o.quiet) std::cout << in_words(advice);
  if (!o.json.empty()) CME212::write_file(o.json, as_json(advice));
  if (advice.own && !o.automatic) return 0;
  if (!advice.refusal.empty()) {
    if (o.quiet) std::cerr << "cloth: no advice: " << advice.refusal << '\n';
    return 2;
  }
  if (!o.advised.empty())
    CME212::write_file(o.advised, to_scene_file(advice.model));
  o.model = advice.model;
  o.rest = !advice.at_rest.empty();
  return o.automatic ? -1 : 0;
}

/** Measure the error of the run of @a o, and set the inner steps of o.model
 * that keep its tolerance; if the method is free and can't use the drag,
 * Verlet's.  Throws as find_accuracy() */
Accuracy measure_accuracy(Options& o) {
  Progress progress(o.quiet);
  const auto find = [&] {
    return find_accuracy(o.model, o.model.tolerance,
                         std::bind_front(&Progress::tell, &progress));
  };
  Accuracy found;
  try {
    found = find();
  } catch (const std::invalid_argument&) {
    if (!o.chooses_method) throw;
    o.model.method = &table::verlet, o.model.step = {};
    found = find();
  }
  progress.end();
  o.model.step = found.step;
  return found;
}

/** Say whether the tolerance was kept by a run that ended with @a status.
 * @return the exit status: 3 if it was not */
int tell_accuracy(const Accuracy& a, int status, bool quiet) {
  if (a.kept()) {
    if (!quiet && status == 0) say(std::cout, a.text());
    return status;
  }
  say(std::cerr, "cloth: " + a.text());
  return status == 0 ? 3 : status;
}

/** Before a run starts: check that all outputs can be written, that no two go
 * to one file, and that none replaces a file that the run reads. But --out may
 * replace the mesh, --write-config the scene, and --checkpoint the file of
 * --restart.
 * Throws std::runtime_error, SceneError */
void check_outputs(const Options& o) {
  using Pair = std::pair<std::string, std::string>;
  std::map<std::string, const char*> option_of, input_of;
  for (const auto& [option, file] :
       {std::pair("nodes", o.model.nodes), std::pair("tets", o.model.tets),
        std::pair("net", o.model.net), std::pair("config", o.config),
        std::pair("restart", o.restart)})
    if (!file.empty()) input_of.emplace(CME212::output_target(file), option);
  const std::set<Pair> follow = {{"out", "nodes"},
                                 {"out", "tets"},
                                 {"out", "net"},
                                 {"write-config", "config"},
                                 {"checkpoint", "restart"}};
  for (const auto& [option, file] :
       {std::pair("vtp", o.vtp), std::pair("ply", o.ply),
        std::pair("csv", o.csv), std::pair("out", o.out),
        std::pair("out", quads_beside(o.out)),
        std::pair("screenshot", o.screenshot), std::pair("record", o.video),
        std::pair("write-config", o.advised), std::pair("json", o.json),
        std::pair("checkpoint", o.checkpoint)}) {
    if (file.empty()) continue;
    const std::string name = option;
    const bool is_folder = name == "vtp" || name == "ply";
    // Opening a pipe waits for its reader; and many may write to a device.
    if (!is_folder && std::filesystem::is_other(file)) continue;
    try {
      if (is_folder)
        FrameFolder try_it(file, FrameFormat::vtp);
      else
        CME212::OutputFile try_it(file);
    } catch (const std::runtime_error& e) {
      const std::string place = o.origins.of("--" + name, "");
      if (place.empty()) throw;
      throw SceneFileError(place + e.what());
    }
    const std::string target = CME212::output_target(file);
    const auto input = input_of.find(target);
    if (input != input_of.end() && !follow.contains({option, input->second}))
      throw SceneError(option, "is " + file + ", which --" + input->second +
                                   " reads, expected another file");
    const auto [other, is_new] = option_of.emplace(target, option);
    if (!is_new)
      throw SceneError(option, "is " + file + ", which --" + other->second +
                                   " also writes, expected another file");
  }
}

/** Load, choose how to run, run.  @return exit status */
int run(Options o) {
  catch_interrupts();
  check_outputs(o);
  lanes::cpu = lanes::fastest_cpu();
  Sweep::set_threads(o.threads);
  if (o.asks_advice())
    if (int status = take_advice(o); status >= 0) return status;
  if (!o.asks_advice() && !o.advised.empty())
    return CME212::write_file(o.advised, to_scene_file(o.model, o.unnamed)), 0;
  const Model& m = o.model;
  const bool shows = !o.headless && !o.pictures();
  const bool in_window = shows && (o.window || Screen::has_display());
  std::optional<Accuracy> accuracy;
  if (o.bounds_error && o.restart.empty()) accuracy = measure_accuracy(o);
  Scene scene(m);
  std::unique_ptr<Screen> window;
  if (in_window) {
    window = Screen::open(Screen::Kind::window);
  } else if (shows && Screen::can_draw()) {
    std::filesystem::create_directories("demo");
    o.screenshot = "demo/" + m.name + ".png";
    o.video = "demo/" + m.name + ".mp4";
    if (!o.quiet)
      say(std::cout,
          "no display: running without a window; a picture and a film go to "
          "the folder demo");
    check_outputs(o);
  }
  Run run(scene, o);
  if (!o.quiet)
    std::cout << scene.cloth().num_nodes() << " nodes, "
              << scene.cloth().num_edges() << " edges\n";
  if (!o.rest)
    run.announce();
  else if (!o.quiet)
    say(std::cout, RestReport(scene).text());
  if (window) {
    window->show_strain(o.strain);
    window->set_paused(o.paused);
    show_in_window(run, *window, o.speed);
    run.check();
  } else if (o.pictures()) {
    Film film(scene, run, o);
    film.draw();
    run.to_end([&] { film.draw(); });
    film.finish();
  } else {
    run.to_end();
  }
  int status = run.finish();
  if (scene.done(m.t_end) && status == 0 && !o.quiet)
    print_answer(run, scene, m);
  if (accuracy) status = tell_accuracy(*accuracy, status, o.quiet);
  return status;
}

/** If a whole file of the mesh is wrong: the line of the scene file that names
 * it, as "FILE:LINE: ". Else "".  @param what the error */
std::string place_of(const Options& o, const std::string& what) {
  for (const auto& [option, file] :
       {std::pair("--nodes", o.model.nodes), std::pair("--tets", o.model.tets),
        std::pair("--net", o.model.net)})
    if (what.starts_with(file + ": ")) return o.origins.of(option, "");
  return "";
}

/** @return @a status; or 2 if not all could be written to the standard output
 */
int after_output(int status) {
  errno = 0;
  if (std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout))
    return status;
  std::cerr << "cloth: the standard output can't be written ("
            << (errno ? std::strerror(errno) : "it is incomplete") << ")\n";
  return status == 0 ? 2 : status;
}

/** Open /dev/null on those of the standard descriptors that are closed; else
 * the next file opened would get what is printed. It is opened for reading, so
 * writing to it remains an error. */
void hold_standard_descriptors() {
  for (int d : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(d, F_GETFD) < 0) open("/dev/null", O_RDONLY);  // the lowest free
}

}  // namespace

int main(int argc, char** argv) {
  hold_standard_descriptors();
  Options o;
  try {
    int status = parse(argc, argv, o);
    return after_output(status >= 0 ? status : run(o));
  } catch (const Interrupted&) {
    std::cerr << "cloth: " << name_of_interrupt() << " ended the "
              << (o.asks_advice()  ? "advice"
                  : o.bounds_error ? "measurement of the error"
                                   : "reading")
              << "; nothing was kept\n";
    return 128 + interrupted();
  } catch (const NoDisplay& e) {
    std::cerr << "cloth: " << e.what() << '\n';
    return 4;
  } catch (const InputError& e) {
    std::cerr << place_of(o, e.what()) << e.what() << '\n';
    return 2;
  } catch (const SceneFileError& e) {
    std::cerr << e.what() << '\n';
    return 2;
  } catch (const SceneError& e) {
    std::cerr << o.origins.of(e.what(), "cloth: ") << e.what() << '\n';
    if (argc == 1)
      std::cerr << "begin with: ./cloth --sheet 'nodes 30 30' --pin 'x 0'; "
                   "all options: ./cloth --help\n";
    return 2;
  } catch (const std::invalid_argument& e) {  // a method that can't do it
    std::cerr << o.origins.of("--method", o.origins.of("--dt", "cloth: "))
              << e.what() << '\n';
    return 2;
  } catch (const std::bad_alloc&) {
    std::cerr << "cloth: out of memory: expected a cloth of fewer nodes, or "
                 "more memory\n";
    return 2;
  } catch (const std::exception& e) {
    std::cerr << "cloth: " << e.what() << '\n';
    return interrupted() ? 128 + interrupted() : 2;
  }
}
