#pragma once
/** @file NoViewer.hpp
 * SDLViewer for programs that are built without a window, VIEWER=0: none can be
 * made, so its members are never called. */
#include <functional>
#include <string>
#include <vector>

#include "CME212/NoDisplay.hpp"
#include "CME212/Point.hpp"

namespace CME212 {

struct SDLViewer {
  /** Throws NoDisplay. */
  SDLViewer() { throw NoDisplay("built without a window"); }
  void add_sphere(const Point&, double) {}
  void add_plane(double) {}
  template <typename G, typename Quads>
  void add_faces(const G&, const Quads&) {}
  template <typename G>
  void draw_graph(const G&) {}
  void set_label(double) {}
  void set_message(const std::vector<std::string>&) {}
  bool wants_frame() const { return false; }
  bool wait_while_paused(const std::function<void()>&) { return true; }
  void event_loop() {}
};

}  // namespace CME212
