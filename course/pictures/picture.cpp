/** @file picture.cpp
 * The assignment's program, which draws its end into a picture:
 *   picture NODES TETS DT T_END
 * with OUT, TITLE, WIDTH and HEIGHT [pixels] in the environment. It shows the
 * room from the cloth's first place down to z = LOW [m]. draw.py builds it in
 * front of mass_spring.cpp as that is, or with a mistake put into it. */
#include <cstdio>
#include <cstdlib>
#include <string>

#include "CME212/SDLViewer.hpp"

namespace CME212 {

/** The program's viewer, always without a window. */
class Panel : public SDLViewer {
 public:
  explicit Panel(const Options&)
      : SDLViewer({.width = number("WIDTH"),
                   .height = number("HEIGHT"),
                   .offscreen = true,
                   .picture = std::getenv("OUT")}) {
    set_view(Point(1, -0.8, 0.4),
             {Point(0, -0.4, std::atof(std::getenv("LOW"))), Point(1, 0.8, 0)});
  }
  void set_label(double t) {
    char label[64];
    std::snprintf(label, sizeof label, "   t = %.3f s", t);
    SDLViewer::set_label(std::getenv("TITLE") + std::string(label));
  }

 private:
  static int number(const char* name) { return std::atoi(std::getenv(name)); }
};

}  // namespace CME212

// The program as it is, but for this name.
#define SDLViewer Panel
#include "mass_spring.cpp"
