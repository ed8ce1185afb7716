// A sweep over steps: drift of the energy against dt, as CSV.
#include <iostream>
#include "lab/methods/Methods.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Scene.hpp"
int main() {
  lab::Model model = lab::load_open_model("data/scenes/diagonals.toml");
  model.nodes = "data/grid1.nodes", model.tets = "data/grid1.tets";
  model.t_end = 0.5;
  std::cout << "method,dt,evaluations,drift\n";  // [s], [1], [J]
  for (const char* name : {"symplectic-euler", "verlet", "pefrl"})
    for (double dt : {4e-3, 2e-3, 1e-3, 5e-4}) {
      model.method = lab::find_method(name);
      model.step.dt = dt;
      lab::Scene scene(model);
      scene.stepper().follow_drag();
      std::cout << name << ',' << dt << ',';
      if (scene.run_to(model.t_end)) {
        const auto now = lab::energies(scene.cloth(), model.gravity);
        std::cout << scene.evaluations() << ',' << scene.stepper().drift(now)
                  << '\n';
      } else {
        std::cout << scene.evaluations() << ",failed\n";
      }
    }
}
