#pragma once
/** @file Color.hpp
 * Color: red, green and blue in [0, 1]. */
#include <algorithm>
#include <cassert>
#include <cmath>

namespace CME212 {

/** A colour of three floats.  Invariant: each lies in [0, 1]. */
struct Color {
  float r = 0, g = 0, b = 0;

  /** Black. */
  constexpr Color() = default;
  /** A grey.  @pre 0 <= v <= 1; 0 is black */
  constexpr Color(float v) : Color(v, v, v) {}
  /** @pre 0 <= r, g, b <= 1 */
  constexpr Color(float r_, float g_, float b_) : r(r_), g(g_), b(b_) {
    assert(0 <= r && r <= 1 && 0 <= g && g <= 1 && 0 <= b && b <= 1);
  }

  /** @pre 0 <= r, g, b <= 1 */
  static constexpr Color make_rgb(float r, float g, float b) {
    return {r, g, b};
  }

  /** From hue, saturation and value.
   * @param h 0 red, 1/6 yellow, 1/3 green, 1/2 cyan, 2/3 blue, 5/6 magenta,
   *          1 red again
   * @param s 0 grey, 1 saturated    @param v 0 black, 1 bright
   * @pre 0 <= h, s, v <= 1
   * Source: A. R. Smith, Color gamut transform pairs, SIGGRAPH 1978. */
  static Color make_hsv(float h, float s, float v) {
    assert(0 <= h && h <= 1 && 0 <= s && s <= 1 && 0 <= v && v <= 1);
    // Each channel is a trapezoid over the hue circle, a third apart.
    auto channel = [&](float shift) {
      float k = std::fmod(shift + 6 * h, 6.0f);
      float fall = std::clamp(std::min(k, 4 - k), 0.0f, 1.0f);
      return std::clamp(v - v * s * fall, 0.0f, 1.0f);
    };
    return {channel(5), channel(3), channel(1)};
  }

  /** The course's heat scale: 0 violet (cold) to 1 red (hot), saturated.
   * @pre 0 <= v <= 1 */
  static Color make_heat(float v) {
    assert(0 <= v && v <= 1);
    return make_hsv(0.78f - 0.76f * v, 1, 1);
  }

  /** A diverging scale for strain: -1 blue (slack), 0 light gray (at rest), +1
   * red (taut). Both arms darken alike, and color-blind people can tell blue
   * from red.  @pre -1 <= v <= 1 */
  static constexpr Color make_strain(float v) {
    assert(-1 <= v && v <= 1);
    constexpr Color slack[] = {
        {0.93f}, {0.52f, 0.74f, 0.93f}, {0.10f, 0.42f, 0.84f}};
    constexpr Color taut[] = {
        {0.93f}, {0.97f, 0.68f, 0.50f}, {0.83f, 0.18f, 0.13f}};
    const auto& at = v < 0 ? slack : taut;
    const float x = 2 * (v < 0 ? -v : v);
    const int i = x < 1 ? 0 : 1;
    const float to = x - float(i);
    return {std::lerp(at[i].r, at[i + 1].r, to),
            std::lerp(at[i].g, at[i + 1].g, to),
            std::lerp(at[i].b, at[i + 1].b, to)};
  }

  /** For marks: magenta, which no scale, cloth or obstacle has. Its luminance
   * is between cloth and ground, so draw it with a dark rim for the
   * colour-blind. */
  static constexpr Color make_mark() { return {1.0f, 0.25f, 0.7f}; }

  bool operator==(const Color&) const = default;
};

}  // namespace CME212
