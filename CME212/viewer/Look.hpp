#pragma once
/** @file Look.hpp
 * How a viewer shows a cloth. */
#include <string>

namespace CME212 {

/** Which parts of a cloth are drawn. */
struct Look {
  enum class Nodes { none, lone, all };  ///< lone: those in no face
  bool faces = true, wires = true;
  Nodes nodes = Nodes::lone;
  bool operator==(const Look&) const = default;
};

/** The next choice after @a n, in a circle. */
constexpr Look::Nodes next(Look::Nodes n) {
  return n == Look::Nodes::all ? Look::Nodes::none : Look::Nodes(int(n) + 1);
}

/** The scale of the colors of Color::make_strain. */
struct ColorScale {
  std::string title = {};
  double limit = 1;  ///< its ends are +limit (taut) and -limit (slack)
  std::string unit = {};
  bool above = false, below = false;  ///< some values are beyond that end
  bool operator==(const ColorScale&) const = default;
};

}  // namespace CME212
