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

  /** A scale for strain: 0 blue (slack) over green to 1 yellow (taut). The
   * luminance grows with @a v, so that it reads the same to the colour-blind
   * and in a grey print; the dark end stays visible on a dark ground.
   * @pre 0 <= v <= 1
   * Source: viridis (S. van der Walt and N. Smith, 2015, CC0) at 1/2, 3/4 and
   * 1, below that a lighter blue than its own; linear in between. */
  static constexpr Color make_strain(float v) {
    assert(0 <= v && v <= 1);
    constexpr Color at[] = {{0.290f, 0.440f, 0.760f},
                            {0.129f, 0.569f, 0.549f},
                            {0.369f, 0.788f, 0.384f},
                            {0.992f, 0.906f, 0.145f}};
    int i = v < 1 ? int(3 * v) : 2;
    float to = std::clamp(3 * v - float(i), 0.0f, 1.0f);
    return {std::lerp(at[i].r, at[i + 1].r, to),
            std::lerp(at[i].g, at[i + 1].g, to),
            std::lerp(at[i].b, at[i + 1].b, to)};
  }

  /** For marks: magenta, which no scale, cloth or obstacle has. Its luminance
   * is between cloth and ground, so draw it with a dark rim for the
   * colour-blind. */
  static constexpr Color make_mark() { return {1.0f, 0.25f, 0.7f}; }

  /** Relative luminance, 0 black to 1 white (ITU-R BT.709, sRGB). */
  float luminance() const {
    auto linear = [](float c) {
      return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
    };
    return 0.2126f * linear(r) + 0.7152f * linear(g) + 0.0722f * linear(b);
  }
};

}  // namespace CME212
