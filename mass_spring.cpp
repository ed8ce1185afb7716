/** @file mass_spring.cpp
 * The assignment's program: ./mass_spring NODES TETS [DT [T_END]]
 * The stage is set when it is compiled: make mass_spring STAGE=forces.
 * Exit status: 0 done; 2 bad input; 3 the run diverged. */
#include <cmath>
#include <future>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "CME212/Energy.hpp"
#include "CME212/MeshFaults.hpp"
#include "CME212/SDLViewer.hpp"
#include "mass_spring.hpp"

/** The stages, at the end of sections 3.2, 4.2, 5.2, 6.2 and 7.2. */
enum class Stage { problem1, diagonals, forces, constraints, tear };
constexpr Stage stage = Stage::STAGE;  // a misspelt stage does not compile

/** The time [s] > 0 that the argument called @a name holds as @a text. */
double time_of(const char* text, const std::string& name) {
  char* end = nullptr;
  const double t = std::strtod(text, &end);
  if (*end == '\0' && t > 0 && std::isfinite(t)) return t;
  throw std::runtime_error(name + " is '" + text +
                           "', expected a time [s], more than 0");
}

int main(int argc, char** argv) try {
  if (argc < 3 || argc > 5)
    throw std::runtime_error("usage: ./mass_spring NODES TETS [DT [T_END]]");
  double dt = argc > 3 ? time_of(argv[3], "DT") : 0.001;
  const double t_end = argc > 4 ? time_of(argv[4], "T_END") : 5;
  if (dt > t_end || t_end / dt > 1e15)
    throw std::runtime_error("DT is " + CME212::short_text(dt) +
                             " s, expected at most T_END, and 1e15 steps");
  // Symplectic methods need equal steps: they end at T_END and are at most DT.
  const long long steps = std::ceil(t_end / dt * (1 - 1e-9));  // 1e-9: rounding
  dt = t_end / steps;

  Cloth g;
  const auto points = load_points(argv[1]);
  const auto quads = load_quads(argv[2], points.size());
  for (const auto& fault : mesh_faults(points, quads))
    std::cerr << "warning: " << fault << '\n';
  // BEGIN SOLUTION 4.2.build_cloth
  const auto springs =
      stage == Stage::problem1 ? MeshSprings::plain : MeshSprings::diagonals;
  // STUB const auto springs = MeshSprings::plain;
  // END SOLUTION
  build_cloth(g, points, quads, springs);
  std::cout << g.num_nodes() << " nodes, " << g.num_edges() << " edges, "
            << steps << " steps of " << dt << " s\n";

  const double L = g.num_edges() > 0 ? CME212::length(*g.edge_begin()) : 0;
  // BEGIN GUIDED
  const auto force = make_combined_force(GravityForce(), MassSpringForce());
  const auto on_ball = make_combined_constraints(
      PinConstraint(g), PlaneConstraint(), SphereConstraint());
  // BEGIN SOLUTION 7.2.program
  const auto torn = make_combined_constraints(
      PinConstraint(g), PlaneConstraint(), TearConstraint());
  // STUB const auto& torn = on_ball;  // as the stage before
  // END SOLUTION
  // END GUIDED
  const auto step = [&](double t) {
    if constexpr (stage == Stage::problem1)
      return symp_euler_step(g, t, dt, Problem1Force(100, L));
    // BEGIN GUIDED
    else if constexpr (stage == Stage::forces)
      return symp_euler_step(g, t, dt, force);
    else if constexpr (stage == Stage::constraints)
      return symp_euler_step(g, t, dt, force, on_ball);
    else if constexpr (stage == Stage::tear)
      return symp_euler_step(g, t, dt, force, torn);
    // END GUIDED
    else
      return symp_euler_step(g, t, dt, Problem1Force());
  };

  std::optional<CME212::SDLViewer> viewer;
  try {
    viewer.emplace(
        CME212::SDLViewer::Options{.picture = "build/mass_spring.png"});
    viewer->add_faces(g, quads);
    if (stage >= Stage::constraints) {
      viewer->add_sphere(Point(0.5, 0.5, -0.5), 0.15);
      viewer->add_plane(-0.75);
    }
  } catch (const CME212::NoDisplay& e) {
    std::cout << e.what() << "; running without a window\n";
  }

  const auto spring = [](Edge e) { return e.value(); };
  // A corner does not move; nor does its kinetic energy count.
  const auto energy = [&] {
    return CME212::motion_energy(g, grav, is_corner).total();
  };
  const double most =
      CME212::divergence_energy(g, energy(), grav, dt, t_end);  // [J]
  const double stable = CME212::stable_step(g, spring);         // [s]
  std::vector<std::string> failure;
  double next_line = 0;  // [s]
  CME212::Clock clock;
  // Returns false if the run has diverged, or the window was closed.
  const auto draw = [&](double t) {
    const auto show = [&] { viewer->draw_graph(g), viewer->set_label(t); };
    if (!(energy() <= most)) {  // also if it is NaN
      const std::string limit = CME212::short_text(stable);
      failure = {"diverged: at t = " + CME212::short_text(t) +
                     " s it gains energy from nothing",
                 "dt is " + CME212::short_text(dt) +
                     " s, 2/omega of this cloth about " + limit + " s" +
                     (dt > stable ? "; try" : "")};
      if (dt > stable)
        failure.push_back(std::string("  ") + argv[0] + ' ' + argv[1] + ' ' +
                          argv[2] + ' ' + limit +
                          (argc > 4 ? std::string(" ") + argv[4] : ""));
      for (const auto& line : failure) std::cerr << line << std::endl;
      if (viewer) show(), viewer->set_message(failure);
      return false;
    }
    if (t > next_line - dt / 2) {
      const double elastic = CME212::elastic_energy(g, spring);
      std::cout << "t = " << t << " s, energy " << energy() + elastic << " J, "
                << g.num_nodes() << " nodes" << std::endl;
      next_line += t_end / 10;
    }
    if (viewer && (viewer->wants_frame() || t > t_end - dt / 2)) show();
    if (!viewer || !viewer->in_window()) return true;
    CME212::sleep(dt - clock.seconds());  // at most as fast as real time
    clock.start();
    return viewer->wait_while_paused(show);
  };

  auto simulation = std::async(std::launch::async, [&] {
    double t = 0;
    for (auto left = steps; draw(t) && left > 0; --left) t = step(t);
  });
  if (viewer) viewer->event_loop();
  simulation.get();                     // throws what the simulation threw
  if (viewer) viewer->write_picture();  // where there is no window
  return failure.empty() ? 0 : 3;
} catch (const std::exception& e) {
  std::cerr << e.what() << '\n';
  return 2;
}
