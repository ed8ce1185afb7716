#pragma once
/** @file SceneFailure.hpp
 * Finds out why a scene failed, and a cure that works. */
#include "lab/scenes/Scene.hpp"

namespace lab {

/** Find out why @a scene failed, and a cure: run it with other methods and
 * steps, each to t_end or for Scene::trial_work. Trials that do not fail are
 * repeated with half the step.  @pre !scene.failure().empty()
 * Throws what the recipe throws; Interrupted. */
Diagnosis diagnose(const Scene& scene);

}  // namespace lab
