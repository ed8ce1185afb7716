#pragma once
/** @file SceneFailure.hpp
 * Why a scene failed, and what works instead. */
#include "lab/scenes/Scene.hpp"

namespace lab {

/** Find out why @a scene failed, and what works: run it anew by up to 10 other
 * methods and steps, each until t_end or for Scene::trial_work; and those that
 * do not fail by half of the step, too.  @pre !scene.failure().empty()
 * Throws what the recipe throws; Interrupted. */
Diagnosis diagnose(const Scene& scene);

}  // namespace lab
