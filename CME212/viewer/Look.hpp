#pragma once
/** @file Look.hpp
 * How a viewer shows a cloth. */
#include "CME212/Point.hpp"

namespace CME212 {

/** Which parts of a cloth are drawn. */
struct Look {
  bool faces = true, wires = true;
  bool nodes = false;  ///< also those in a face; all others always are
  bool operator==(const Look&) const = default;
};

/** A line [m] drawn on top of everything else; a ring if both ends coincide. */
struct Mark {
  Point from, to;
};

/** The scale of strain, which colors by Color::make_strain. */
struct StrainScale {
  double limit = 1;  ///< [%]; its ends are +limit (taut) and -limit (slack)
  bool above = false, below = false;  ///< some values are beyond that end
  bool operator==(const StrainScale&) const = default;
};

}  // namespace CME212
