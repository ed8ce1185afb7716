#pragma once
/** @file Screen.hpp
 * Screen: what mass_spring draws on: a window, or pictures in memory. */
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "Scene.hpp"

/** The largest |l/L - 1| of the springs at @a n: how near it is to tearing. */
inline double strain_at(const Node& n) {
  double strain = 0;
  for (Edge e : n.edges())
    if (double L = e.value().L; L > 0)
      strain = std::max(strain, std::abs(e.length() / L - 1));
  return strain;
}

#ifdef MASS_SPRING_VIEWER

#include "CME212/Image.hpp"
#include "CME212/SDLViewer.hpp"
using CME212::NoDisplay;

#else  // built with VIEWER=0

struct NoDisplay : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** Can't draw: every attempt throws NoDisplay. */
class Screen {
 public:
  enum class Kind { window, pictures };
  static constexpr bool can_draw = false;
  static constexpr double frames_per_second = 30;
  static bool has_display() { return false; }
  explicit Screen(Kind) {
    throw NoDisplay("built without a viewer (VIEWER=0), so it can't draw");
  }
  void show_strain(bool) {}
  void show(const Scene&) {}
  void start_film(const std::string&) {}
  void add_to_film() {}
  std::string end_film() { return {}; }
  void save_picture(const std::string&) {}
  void event_loop() {}
  void close() {}
  bool closed() const { return true; }
  bool take_restart() { return false; }
  bool wait_while_paused() { return false; }
  bool wants_frame() const { return false; }
};

#endif
