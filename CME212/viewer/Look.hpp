#pragma once
/** @file Look.hpp
 * How a viewer shows a cloth. */
#include <string>

namespace CME212 {

/** What of a cloth is drawn. */
struct Look {
  enum class Nodes { none, lone, all };  ///< lone: those in no face
  bool faces = true, wires = true;
  Nodes nodes = Nodes::lone;
  bool pieces = false;  ///< each connected component in a color of its own
  bool operator==(const Look&) const = default;
};

/** The choice that comes after @a n, and after the last one the first. */
constexpr Look::Nodes next(Look::Nodes n) {
  return n == Look::Nodes::all ? Look::Nodes::none : Look::Nodes(int(n) + 1);
}

/** What the colors of Color::make_strain mean. */
struct ColorScale {
  std::string title = {};
  double limit = 1;  ///< value of its ends, +limit taut and -limit slack
  std::string unit = {};
  bool above = false, below = false;  ///< there are values beyond an end
};

}  // namespace CME212
