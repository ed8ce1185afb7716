/** @file make_grid.cpp
 * Writes a square cloth: ./make_grid SIDE BASE makes BASE.nodes and BASE.tets,
 * SIDE x SIDE nodes over the unit square, x in the outer loop and y in the
 * inner one. Format: data/README.md.
 *
 *   ./make_grid 5 data/grid0        25 nodes, 16 quads
 *   ./make_grid 1000 data/grid4     1,000,000 nodes, 998,001 quads */
#include <charconv>
#include <cstdlib>
#include <iostream>
#include <string>

#include "CME212/Mesh.hpp"
#include "CME212/OutputFile.hpp"

namespace {

/** The shortest text that reads back as @a a. */
std::string shortest(double a) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, a).ptr};
}

}  // namespace

int main(int argc, char** argv) {
  unsigned side = 0;
  if (argc == 3) {
    std::string text = argv[1];
    auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), side);
    if (error != std::errc() || *end != '\0') side = 0;
  }
  if (side < 2 || side > 30000) {
    std::cerr << "usage: make_grid SIDE BASE\n"
                 "writes BASE.nodes and BASE.tets, SIDE x SIDE nodes, "
                 "SIDE from 2 to 30000\n";
    return 2;
  }
  try {
    std::string base = argv[2];
    CME212::OutputFile nodes(base + ".nodes"), tets(base + ".tets");
    for (const Point& p : grid_points(side))
      nodes.stream() << shortest(p.x) << ' ' << shortest(p.y) << ' '
                     << shortest(p.z) << '\n';
    for (const Quad& q : grid_quads(side))
      tets.stream() << q[0] << ' ' << q[1] << ' ' << q[2] << ' ' << q[3]
                    << '\n';
    nodes.commit();
    tets.commit();
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
