#pragma once
/** @file Changes.hpp
 * The changes that a scene makes of itself while it runs: Model::at. */
#include <string>
#include <vector>

#include "lab/scenes/Requests.hpp"

namespace lab {

class Scene;

/** What may be asked of a scene alone: of its forces, springs and pins. A node
 * is named by its number in the mesh, from 0. */
const Requests<Scene>& scene_requests();

/** A request that is made at some time. */
struct Change {
  double time;  ///< [s]
  std::string request;
  std::string_view name() const {
    return std::string_view(request).substr(0, request.find(' '));
  }
};
/** The changes in @a lines such as "0.5 gravity 3", in their order.
 * Throws SceneError: a line that makes no sense, or is earlier than the one
 * before it */
std::vector<Change> read_changes(const std::vector<std::string>& lines);

}  // namespace lab
