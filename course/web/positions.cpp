/** @file positions.cpp
 * The native positions, which a page must have to the bit: the assignment's
 * program, which at its end writes the positions of all nodes by index, as
 * doubles, to the file that the environment variable POSITIONS names. */
#include <cstdlib>
#include <fstream>

#include "CME212/SDLViewer.hpp"
#include "CME212/viewer/NoViewer.hpp"
#include "mass_spring.hpp"

namespace CME212 {

/** A viewer of the program that writes its last frame. */
struct Positions : NoViewer {
  explicit Positions(const Options&) : NoViewer(Films()) {}
  template <typename G>
  void draw_graph(const G& g) {
    std::ofstream out(std::getenv("POSITIONS"), std::ios::binary);
    for (unsigned i = 0; i < g.num_nodes(); ++i) {
      const Point p = g.node(i).position();
      out.write(reinterpret_cast<const char*>(&p), sizeof p);
    }
  }
};

}  // namespace CME212

// The program as it is, but for this name.
#define SDLViewer Positions
#include "mass_spring.cpp"
