#pragma once
/** @file Plot.hpp
 * plot(): curves over time in a panel of Dear ImGui, with axes and units. */
#include <array>
#include <span>
#include <string>
#include <vector>

namespace lab {

/** A color as Dear ImGui has it: alpha, blue, green, red from the top. */
using PanelColor = unsigned;
/** Colors of curves, safe for color-blind readers (Okabe and Ito). */
namespace curve_colors {
constexpr PanelColor white = 0xfff0f0f0, sky = 0xffe9b456, orange = 0xff009fe6,
                     green = 0xff73b400, rose = 0xffb78fdd, red = 0xff4a4aff;
}

/** A curve; a value that is no number, or not above 0 where the scale is
 * logarithmic, is a gap. */
struct Curve {
  const char* name;
  PanelColor color;
  std::span<const float> values;
};

/** Marks of an axis from @a low to @a high: all multiples of 1, 2 or 5 times a
 * power of ten, at most @a most of them; where @a log, powers of ten.
 * @pre low < high, finite; above 0 where @a log; most > 0 */
std::vector<double> axis_ticks(double low, double high, int most, bool log);
/** As text, with as many digits as marks @a step apart need. */
std::string tick_text(double value, double step);

/** What an axis of @a curves spans: all values with a margin, or from a power
 * of ten to one above it. */
std::array<double, 2> axis_range(std::span<const Curve> curves, bool log);

/** Draw @a curves over @a times [s] (all of one length) over the full width of
 * the panel, @a height [pixels] high; their names stand below @a title, which
 * names the unit. */
void plot(const char* title, std::span<const float> times,
          std::span<const Curve> curves, float height, bool log = false);

}  // namespace lab
