// A scene from a file, by another method than the one that it names.
#include <iostream>
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Trial.hpp"
int main() {
  lab::Model model = lab::load_model("data/scenes/drape.toml");
  model.method = &lab::table::pefrl;
  lab::Scene scene(model);
  if (!scene.run_to(model.t_end)) {
    std::cerr << scene.explanation().text() << '\n';
    return 3;
  }
  const auto height =
      lab::answer(model, scene.cloth(), lab::Measure::drape_height);
  std::cout << scene.method().name << ": " << scene.steps() << " steps, "
            << scene.evaluations() << " force evaluations; the lowest point is "
            << "at z = " << height[0] << " m\n";
}
