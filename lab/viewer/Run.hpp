#pragma once
/** @file Run.hpp
 * Run: a scene taken to its end, with all that is written about it. */
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include <unistd.h>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/methods/Verlet.hpp"
#include "lab/scenes/Scene.hpp"
#include "lab/stability/StepLimit.hpp"

namespace lab {

/** What a run is asked for; see mass_spring --help. */
struct Options {
  Model model;
  double at = -1;  // time of the screenshot [s]; the end if negative
  double speed = 1;
  long long every = 10;
  int threads = 0;  // of the sweeps; 0: as many as there are processors
  bool headless = false, window = false, paused = false, strain = false;
  bool quiet = false;
  bool advise = false, automatic = false;
  std::string screenshot, video, csv, out;
  std::string advised;  // file for the advised scene

  bool pictures() const { return !screenshot.empty() || !video.empty(); }
};

/** Tells how far a run is: a bar on a terminal, else a line now and then;
 * nothing if it is done within a second. */
class Progress {
 public:
  explicit Progress(const Options& o)
      : on_(!o.quiet), bar_(isatty(STDERR_FILENO)), t_end_(o.model.t_end) {}

  void show(long long steps, double t) {
    if (!on_ || !(t > 0)) return;
    const double now = clock_.seconds();
    if (now < next_) return;
    next_ = now + (bar_ ? 0.1 : 5.0);
    const double part = std::min(1.0, t / t_end_);
    std::ostringstream line;
    if (bar_) {
      auto filled = static_cast<std::size_t>(30 * part);
      line << "\r[" << std::string(filled, '#') << std::string(30 - filled, ' ')
           << "] ";
    }
    line << "t = " << CME212::short_text(t) << " of "
         << CME212::short_text(t_end_) << " s, "
         << CME212::short_text(std::round(double(steps) / now)) << " steps/s, "
         << CME212::short_text(std::ceil(now / part - now)) << " s left"
         << (bar_ ? "   " : "\n");
    std::cerr << line.str() << std::flush;
  }
  void end() {
    if (on_ && bar_) std::cerr << '\r' << std::string(76, ' ') << '\r';
  }
  double seconds() const { return clock_.seconds(); }

 private:
  bool on_, bar_;
  double t_end_;
  double next_ = 1;  // when to show again [s]
  CME212::Clock clock_;
};

/** One run of a scene with all that is written about it. */
class Run {
 public:
  /** Output files are opened now, so that a wrong path ends the run before it
   * starts. Throws std::runtime_error. */
  Run(Scene& scene, const Options& o) : scene_(scene), o_(o), progress_(o) {
    if (!o.csv.empty()) csv_.emplace(o.csv);
    if (!o.out.empty()) out_.emplace(o.out);
    start();
  }

  /** Back to t = 0. */
  void restart() {
    scene_.restart();
    told_ = false;
    start();
  }

  bool done() const { return scene_.done(o_.model.t_end); }

  /** Check the present state, which is to be shown; tell if it is not good. */
  void check() {
    scene_.check();
    tell_failure();
  }

  /** One step. What is written down is checked. A failure is told at once.
   * @pre !done() */
  void advance() {
    scene_.step();
    look();
  }
  /** Step until done(), with a call of @a after() after each step. */
  void to_end(const std::function<void()>& after = [] {}) {
    scene_.run_to(o_.model.t_end, [&] {
      look();
      after();
    });
  }

  /** Say how long the step is and how long it may be. */
  void announce() const {
    if (o_.quiet) return;
    using CME212::short_text;
    const MethodInfo& method = scene_.method();
    const double dt = scene_.dt(), limit = scene_.safe_limit();
    const bool sharp = scene_.step_rule() == StepRule::sharp;
    std::ostringstream out;
    out.precision(3);
    out << "dt = " << dt << " s";
    if (sharp) {
      out << " at first: at most " << sharp_share << " of the limit of "
          << method.name << " in the present shape, and " << limit
          << " s, that in any shape";
    } else if (limit == no_limit) {
      const double verlet = scene_.safe_limit(entry_of<Verlet>());
      out << ": " << method.name << " has no limit";
      if (std::isfinite(verlet))
        out << "; this is " << dt / verlet << " times that of verlet here, "
            << verlet << " s";
    } else if (limit > 0) {
      out << ": " << dt / limit << " of the limit of " << method.name
          << " here, " << limit << " s";
    } else {
      out << ": no step is stable with " << method.name << " and no drag";
    }
    std::cout << out.str() << '\n';
    warn_of_fast_balls();
    if (dt <= limit || sharp) return;
    out.str("mass_spring: warning: ");
    out.seekp(0, std::ios::end);
    if (limit > 0)
      out << "dt is beyond the limit, so this may blow up; --dt "
          << safe_share * limit << " or --dt auto does not";
    else
      out << "this blows up; --method verlet --dt auto does not";
    std::cerr << out.str() << '\n';
  }

  /** Write the files and the last line.  @return the exit status
   * Throws std::runtime_error if a file can't be written. */
  int finish() {
    progress_.end();
    if (csv_) {
      csv_->stream() << "t,kinetic,elastic,gravitational,total,com_x,com_y,"
                        "com_z,nodes,edges\n"
                     << rows_;
      csv_->commit();
    }
    if (out_) {
      for (Node n : scene_.cloth().nodes()) {
        Point p = n.position();
        out_->stream() << CME212::to_text(p.x) << ' ' << CME212::to_text(p.y)
                       << ' ' << CME212::to_text(p.z) << '\n';
      }
      out_->commit();
    }
    if (!o_.quiet) print_summary();
    return scene_.failure().empty() ? 0 : 3;
  }

 private:
  Scene& scene_;
  const Options& o_;
  Progress progress_;
  std::optional<CME212::OutputFile> csv_, out_;
  std::string rows_;
  long long last_row_ = -1;
  double seconds_ = 0;  // until the last step
  bool warned_ = false, told_ = false;

  /** After a step. */
  void look() {
    if (done() || (csv_ && scene_.steps() % o_.every == 0)) scene_.check();
    seconds_ = progress_.seconds();
    tell_failure();
    if (scene_.steps() % o_.every == 0 || done()) add_row();
    if (!warned_ && scene_.watched().count() > 0) warn_of_missed();
    progress_.show(scene_.steps(), scene_.time());
  }

  struct Energies {
    double kinetic, elastic, gravitational;
    double total() const { return kinetic + elastic + gravitational; }
  };
  Energies energies() const {
    const Cloth& g = scene_.cloth();
    return {kinetic_energy(g), elastic_energy(g),
            gravitational_energy(g, o_.model.gravity)};
  }

  void start() {
    progress_ = Progress(o_);
    rows_.clear();
    seconds_ = 0;
    last_row_ = -1;
    add_row();
  }

  void add_row() {
    if (!csv_ || scene_.steps() == last_row_) return;
    last_row_ = scene_.steps();
    Energies e = energies();
    Point c = center_of_mass(scene_.cloth());
    for (double a : std::initializer_list<double>{scene_.time(), e.kinetic,
                                                  e.elastic, e.gravitational,
                                                  e.total(), c.x, c.y, c.z})
      rows_ += CME212::to_text(a) + ',';
    rows_ += std::to_string(scene_.cloth().num_nodes()) + ',' +
             std::to_string(scene_.cloth().num_edges()) + '\n';
  }

  void tell_failure() {
    if (told_ || scene_.failure().empty()) return;
    told_ = true;
    progress_.end();
    std::cerr << "mass_spring: " << scene_.failure() << '\n';
  }

  /** A ball that jumps over nodes pushes none of them. */
  void warn_of_fast_balls() const {
    for (const Obstacle& o : scene_.recipe().obstacles) {
      const double way = norm(o.motion.velocity) * scene_.dt();
      if (o.kind == Obstacle::Kind::ball && way > o.radius / 2)
        std::cerr << "mass_spring: warning: --sphere moves " << way
                  << " m a step, which is more than half of its radius, "
                  << o.radius << " m: it may jump over nodes; a smaller dt "
                  << "catches them: " << o.radius / 2 / norm(o.motion.velocity)
                  << " s\n";
    }
  }

  void warn_of_missed() {
    warned_ = true;
    if (o_.quiet) return;
    const auto& missed = scene_.watched().first();
    std::cerr << "mass_spring: warning: node " << missed.node << " went "
              << missed.length << " m in the step to t = " << scene_.time()
              << " s and would have passed through an obstacle; it was put on "
                 "its surface. A smaller dt sees it: "
              << scene_.dt() *
                     std::min(0.5, scene_.watched().thinnest() / missed.length)
              << " s\n";
  }

  void print_summary() const {
    Energies e = energies();
    std::cout << scene_.recipe().name << ": " << scene_.steps()
              << " steps to t = " << scene_.time() << " s in " << seconds_
              << " s; energy " << e.total() << " J = " << e.kinetic
              << " kinetic + " << e.elastic << " elastic + " << e.gravitational
              << " gravitational; " << scene_.cloth().num_nodes()
              << " nodes and " << scene_.cloth().num_edges() << " edges left\n";
  }
};

}  // namespace lab
