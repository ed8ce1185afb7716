/** @file page_positions.cpp
 * The native positions, which the page must have to the bit:
 *   page_positions SCENE.toml GRID STEPS [METHOD DT]...
 * For each method the positions of all nodes of the grid after so many steps of
 * DT [s], as doubles, by id. */
#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Scene.hpp"

int main(int argc, char** argv) {
  if (argc < 4 || argc % 2 != 0) {
    std::cerr << "usage: page_positions SCENE.toml GRID STEPS [METHOD DT]...\n";
    return 2;
  }
  for (int k = 4; k < argc; k += 2) {
    lab::Model m = lab::load_open_model(argv[1]);
    m.nodes = argv[2] + std::string(".nodes");
    m.tets = argv[2] + std::string(".tets");
    m.method = lab::find_method(argv[k]);
    m.t_end = lab::no_limit;
    m.step.dt = std::atof(argv[k + 1]);
    lab::Scene scene(m);
    for (int left = std::atoi(argv[3]); left > 0; --left) scene.step();
    const auto all = arrays(std::as_const(scene).cloth()).positions();
    std::cout.write(reinterpret_cast<const char*>(all.data()),
                    std::streamsize(all.size_bytes()));
  }
}
