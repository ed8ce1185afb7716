/** @file frame_rate.cpp
 * How often a cloth of 10,000 nodes is drawn beside its simulation, which has a
 * thread of its own, and what a frame takes: frame_rate [SECONDS], each. It
 * draws 1024 x 768 pixels as a window does, but shows none. */
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <thread>
#include <vector>

#include "CME212/SDLViewer.hpp"
#include "CME212/Util.hpp"
#include "mass_spring.hpp"

namespace {

/** Processor time of all threads but this one [s]. */
double others() {
  auto seconds_of = [](clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  };
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID) -
         seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

void measure(const char* name, const CME212::Look& look, double seconds) {
  const auto points = grid_points(100);
  const auto quads = grid_quads(100);
  Cloth g;
  build_cloth(g, points, quads, MeshSprings::diagonals);
  CME212::SDLViewer::Options options;
  options.offscreen = true;
  CME212::SDLViewer viewer(options);
  viewer.add_sphere(Point(0.5, 0.5, -0.5), 0.15);
  viewer.add_plane(-0.75);
  viewer.set_look(look);
  // The scene is built once; each frame changes positions.
  std::map<Node, unsigned> nodes;
  std::vector<std::array<Node, 4>> faces;
  for (const Quad& q : quads)
    faces.push_back({g.node(q[0]), g.node(q[1]), g.node(q[2]), g.node(q[3])});
  auto white = [](Node) { return CME212::Color(1); };
  viewer.add_nodes(g.node_begin(), g.node_end(), white, nodes);
  viewer.add_faces(faces.begin(), faces.end(), nodes);
  viewer.add_edges(g.edge_begin(), g.edge_end(), nodes);
  const auto force = make_combined_force(GravityForce(), MassSpringForce());
  const auto constraint = make_combined_constraints(
      PinConstraint(g), PlaneConstraint(), SphereConstraint());
  int frames = 0, steps = 0;
  double used = 0, took = 0;
  std::thread simulation([&] {
    CME212::sleep(0.3);  // while shaders are compiled
    CME212::Clock clock;
    const double before = others();
    for (double t = 0; clock.seconds() < seconds; ++steps) {
      t = symp_euler_step(g, t, 0.0005, force, constraint);
      if (!viewer.wants_frame()) continue;
      viewer.add_nodes(g.node_begin(), g.node_end(), white, nodes);
      ++frames;
    }
    took = clock.seconds();
    used = others() - before;
    viewer.close();
  });
  viewer.event_loop();
  simulation.join();
  std::printf(
      "%-24s %6.1f frames/s %8.2f ms of processor a frame %8.0f steps/s\n",
      name, frames / took, 1000 * used / frames, steps / took);
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 5;
  using Nodes = CME212::Look::Nodes;
  measure("wires and nodes", {.faces = false, .nodes = Nodes::all}, seconds);
  measure("wires", {.faces = false}, seconds);
  measure("faces and shadow", {.wires = false}, seconds);
}
