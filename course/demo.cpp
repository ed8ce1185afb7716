/** @file demo.cpp
 * What `make demo` leaves without a display: stage tear on data/grid2, with the
 * program's step of 0.001 s, as the film demo/tear.mp4 and the picture
 * demo/tear.png of its end. Exit status: 0 done, 2 an error. */
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include "CME212/SDLViewer.hpp"
#include "CME212/Util.hpp"
#include "CME212/viewer/Image.hpp"
#include "mass_spring.hpp"

int main() try {
  constexpr int width = 800, height = 600;  // [pixels]
  constexpr double rate = 30, dt = 0.001;   // [1/s], [s]
  constexpr double t_end = 1.2;             // [s]; by then it has torn
  // While nodes are removed, and so long after [s], time is slower.
  constexpr double slow = 8, slow_seconds = 0.08;
  constexpr double title = 0.4;  // until then [s]

  Cloth g;
  const auto points = load_points("data/grid2.nodes");
  const auto quads = load_quads("data/grid2.tets", points.size());
  build_cloth(g, points, quads, MeshSprings::diagonals);
  const auto force = make_combined_force(GravityForce(), MassSpringForce());
  const auto constraint = make_combined_constraints(
      PinConstraint(g), PlaneConstraint(), TearConstraint());

  CME212::SDLViewer viewer(
      {.width = width, .height = height, .offscreen = true});
  viewer.set_look({.wires = false});
  viewer.add_faces(g, quads);
  viewer.add_sphere(Ball().center, Ball().radius);
  viewer.add_plane(PlaneConstraint().z);
  viewer.set_view(Point(1, -0.8, 0.4),
                  {Point(0, -0.4, PlaneConstraint().z), Point(1, 0.6, 0)});

  std::filesystem::create_directories("demo");
  CME212::Video film("demo/tear.mp4", width, height, rate);
  CME212::Image picture;
  const auto show = [&](double t) {
    viewer.draw_graph(g);
    viewer.set_label("t = " + CME212::short_text(t) + " s");
    film.add(picture = viewer.snapshot());
  };
  viewer.set_message(
      {"A ball tears a cloth", std::to_string(g.num_nodes()) + " nodes, " +
                                   std::to_string(g.num_edges()) + " springs"},
      CME212::Color(0.7f));

  double next = 0, slow_until = 0;  // [s]
  auto nodes = g.num_nodes();
  for (double t = 0; t < t_end;) {
    if (t > next - dt / 2) {
      show(t);
      if (t > title) viewer.set_message({});
      if (g.num_nodes() < nodes) slow_until = t + slow_seconds;
      nodes = g.num_nodes();
      next += 1 / (t < slow_until ? slow * rate : rate);
    }
    t = symp_euler_step(g, t, dt, force, constraint);
  }
  film.finish();
  CME212::write_png("demo/tear.png", picture);
  std::cout << "no display: see demo/tear.png and demo/tear.mp4\n";
} catch (const std::exception& e) {
  std::cerr << "demo: " << e.what() << '\n';
  return 2;
}
