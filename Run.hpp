#pragma once
/** @file Run.hpp
 * Run: a scene taken to its end, with all that is written about it. */
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include <unistd.h>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "Scene.hpp"

/** What a run is asked for; see mass_spring --help. */
struct Options {
  std::string nodes, tets;
  std::string method = "symplectic-euler";
  Parameters with;
  double t_end = 5;
  double at = -1;  // time of the screenshot [s]; the end if negative
  double speed = 1;
  long long every = 10;
  bool headless = false, window = false, paused = false, strain = false;
  bool quiet = false;
  std::string screenshot, video, csv, out;

  long long num_steps() const {
    // 5 / 0.001 is a little more than 5000 or a little less: neither may
    // cost a step.
    return static_cast<long long>(std::ceil(t_end / with.dt * (1 - 1e-12)));
  }
  bool pictures() const { return !screenshot.empty() || !video.empty(); }
};

/** Tells how far a run is: a bar on a terminal, else a line now and then;
 * nothing if it is done within a second. */
class Progress {
 public:
  Progress(const Options& o, long long total)
      : on_(!o.quiet),
        bar_(isatty(STDERR_FILENO)),
        t_end_(o.t_end),
        total_(total) {}

  void show(long long steps, double t) {
    if (!on_ || total_ == 0) return;
    if (clock_.seconds() < next_) return;
    next_ = clock_.seconds() + (bar_ ? 0.1 : 5.0);
    double rate = std::max(1.0, double(steps)) / clock_.seconds();
    std::ostringstream line;
    if (bar_) {
      auto filled = static_cast<std::size_t>(30 * steps / total_);
      line << "\r[" << std::string(filled, '#') << std::string(30 - filled, ' ')
           << "] ";
    }
    line << "t = " << CME212::short_text(t) << " of "
         << CME212::short_text(t_end_) << " s, "
         << CME212::short_text(std::round(rate)) << " steps/s, "
         << CME212::short_text(std::ceil(double(total_ - steps) / rate))
         << " s left" << (bar_ ? "   " : "\n");
    std::cerr << line.str() << std::flush;
  }
  void end() {
    if (on_ && bar_) std::cerr << '\r' << std::string(76, ' ') << '\r';
  }
  double seconds() const { return clock_.seconds(); }

 private:
  bool on_, bar_;
  double t_end_;
  long long total_;
  double next_ = 1;  // when to show again [s]
  CME212::Clock clock_;
};

/** One run of a scene with all that is written about it. */
class Run {
 public:
  /** Output files are opened now, so that a wrong path ends the run before it
   * starts. Throws std::runtime_error. */
  Run(Scene& scene, const Options& o)
      : scene_(scene), o_(o), progress_(o, o.num_steps()) {
    if (!o.csv.empty()) csv_.emplace(o.csv);
    if (!o.out.empty()) out_.emplace(o.out);
    start();
  }

  /** Back to t = 0. */
  void restart() {
    scene_.restart();
    start();
  }

  bool done() const {
    return scene_.steps() >= o_.num_steps() || !scene_.failure().empty();
  }

  /** One step.  @pre !done() */
  void advance() {
    scene_.step();
    seconds_ = progress_.seconds();
    if (scene_.steps() % o_.every == 0 || done()) add_row();
    progress_.show(scene_.steps(), scene_.time());
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
    if (scene_.failure().empty()) return 0;
    std::cerr << "mass_spring: " << scene_.failure() << '\n';
    return 3;
  }

 private:
  Scene& scene_;
  const Options& o_;
  Progress progress_;
  std::optional<CME212::OutputFile> csv_, out_;
  std::string rows_;
  long long last_row_ = -1;
  double seconds_ = 0;  // until the last step

  struct Energies {
    double kinetic, elastic, gravitational;
    double total() const { return kinetic + elastic + gravitational; }
  };
  Energies energies() const {
    const Cloth& g = scene_.cloth();
    return {kinetic_energy(g), elastic_energy(g),
            gravitational_energy(g, o_.with.gravity)};
  }

  void start() {
    progress_ = Progress(o_, o_.num_steps());
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
    for (double a : {scene_.time(), e.kinetic, e.elastic, e.gravitational,
                     e.total(), c.x, c.y, c.z})
      rows_ += CME212::to_text(a) + ',';
    rows_ += std::to_string(scene_.cloth().num_nodes()) + ',' +
             std::to_string(scene_.cloth().num_edges()) + '\n';
  }

  void print_summary() const {
    Energies e = energies();
    std::cout << name_of(scene_.stage()) << ": " << scene_.steps()
              << " steps to t = " << scene_.time() << " s in " << seconds_
              << " s; energy " << e.total() << " J = " << e.kinetic
              << " kinetic + " << e.elastic << " elastic + " << e.gravitational
              << " gravitational; " << scene_.cloth().num_nodes()
              << " nodes and " << scene_.cloth().num_edges() << " edges left\n";
  }
};
