/** @file make_grid.cpp
 * Writes a square cloth: ./make_grid SIDE BASE makes BASE.nodes and BASE.tets,
 * SIDE x SIDE nodes over the unit square, x in the outer loop and y in the
 * inner one. Format: docs/data.md.
 *
 *   ./make_grid 5 data/grid0        25 nodes, 16 quads
 *   ./make_grid 1000 data/grid4     1,000,000 nodes, 998,001 quads */
#include <charconv>
#include <cstdlib>
#include <iostream>
#include <string>

#include "CME212/OutputFile.hpp"

namespace {

/** The shortest text that reads back as @a a. */
std::string shortest(double a) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, a).ptr};
}

/** Write @a side^2 points: i/(side - 1), j/(side - 1), 0. */
void write_points(std::ostream& out, unsigned side) {
  for (unsigned i = 0; i < side; ++i) {
    std::string x = shortest(i / double(side - 1));
    for (unsigned j = 0; j < side; ++j)
      out << x << ' ' << shortest(j / double(side - 1)) << " 0\n";
  }
}

/** Write the (side - 1)^2 quads: a corner, its y, x and xy neighbors. */
void write_quads(std::ostream& out, unsigned side) {
  for (unsigned i = 0; i + 1 < side; ++i)
    for (unsigned j = 0; j + 1 < side; ++j) {
      unsigned n = i * side + j;
      out << n << ' ' << n + 1 << ' ' << n + side << ' ' << n + side + 1
          << '\n';
    }
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
    write_points(nodes.stream(), side);
    write_quads(tets.stream(), side);
    nodes.commit();
    tets.commit();
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
