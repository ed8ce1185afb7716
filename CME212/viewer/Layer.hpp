#pragma once
/** @file Layer.hpp
 * Layer: text and boxes over a picture, drawn by the processor. */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "CME212/Color.hpp"

namespace CME212 {

/** An alphabet of strokes: text needs no font file and has the same pixels
 * everywhere. */
namespace letters {

/** The strokes of a letter, of ' ' to '~'. A point is two hexadecimal digits,
 * x and y, where y is 3 on the base line, a at the top of an x, d at that of a
 * capital. A stroke starts at its first point and ends at its last one; the
 * points between pull it (a quadratic B-spline), and a corner is two equal
 * points. */
inline constexpr std::array<const char*, 95> strokes = {
    "", "0d07 0304", "0d0a 2d2a", "133d 436d 0666 1a7a",
    "6b6c0c0868640405 3e32", "7d13 0b09393d0d0b 555383875755",
    "731a1d5d5a08035378", "0d0a", "2e0b0421", "0e2b2401", "2d27 0c48 4c08",
    "3a34 0767", "1401", "0747", "0304", "024d",
    // 0 to 9
    "0803535d0d08", "0b3d3d33 1353", "0b0d5d59030353", "0b0d5d5828 2858530305",
    "434d4d060656", "5d0d0d08085a530305", "5b5d0d0353590906", "0d5d5d13",
    "0b0d5d58080b 050858530305", "0503535d0d07575a",
    // : to @
    "0304 090a", "1401 191a", "6a070764", "0969 0565", "0a676704",
    "0b0d5d592826 2324", "6765353a6a67 6a64949d0d026273",
    // A to Z
    "034d4d83 1676", "030d 0d3d5d583808 083868633303", "7b7d0d037375",
    "030d 0d3d7d733303", "5d0d0d030353 0848", "5d0d0d03 0848",
    "7b7d0d037378787848", "030d 737d 0878", "030d", "4d46430305",
    "030d 6d07 2963", "0d030353", "030d0d46468d8d83", "030d0d73737d",
    "0803737d0d08", "030d 0d3d6d673707", "0803737d0d08 4672",
    "030d 0d3d6d673707 3763", "6b6d0d0868630305", "0d6d 3d33", "0d070373777d",
    "0d43438d", "0d23235d5d8383ad", "037d 0d73", "0d48488d 4843",
    "0d6d6d030363",
    // [ to `
    "2e0e0e010121", "0d42", "0e2e2e212101", "0a3d3d6a", "0161", "0d2b",
    // a to z
    "090a5a5753 572707035355", "0d03 0703535a0a07", "595a0a035354",
    "5d53 0703535a0a07", "0757575a0a035354", "4d1d1a13 0a3a",
    "0703535a0a07 5a52500001", "0d03 060a5a5753", "0a03 0c0d", "2a222000 2c2d",
    "0d03 5a05 2753", "0d050323", "0a03 060a4a4743 464a8a8783",
    "0a03 060a5a5753", "0703535a0a07", "0a00 0703535a0a07", "5a50 0703535a0a07",
    "0a03 060a3a", "595a0a0756530304", "1d151333 0a3a", "0a06035357 5a53",
    "0a33336a", "0a23234a4a63638a", "035a 0a53", "0a33 6a20", "0a5a5a030353",
    // { to ~
    "3e1e180707161131", "0e01", "0e2e283737262101", "06284668"};

/** Space at each side of a letter. */
inline constexpr double bearing = 1.7;

/** A straight piece of a stroke, and its end. */
struct Piece {
  double x0, y0, x1, y1;
};

/** The strokes of @a c; any other sign than those above is a question mark. */
inline std::string_view strokes_of(char c) {
  return strokes[c >= ' ' && c <= '~' ? std::size_t(c - ' ') : '?' - ' '];
}
inline int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

/** From one letter to the next, in units of which ten are a capital's height.
 */
inline double advance(char c) {
  int right = 1, at = 0;
  for (char d : strokes_of(c))
    if (d == ' ')
      at = 0;
    else if (at++ % 2 == 0)
      right = std::max(right, digit(d));
  return right + 2 * bearing;
}

/** The pieces of @a c, y upwards from the base line, in those units. */
inline std::vector<Piece> pieces(char c) {
  std::vector<Piece> all;
  std::string_view left = strokes_of(c);
  while (!left.empty()) {
    const auto stroke = left.substr(0, left.find(' '));
    left.remove_prefix(std::min(stroke.size() + 1, left.size()));
    const auto n = stroke.size() / 2;
    using P = std::array<double, 2>;
    const auto point = [&](std::size_t k) {
      return P{digit(stroke[2 * k]) + bearing, digit(stroke[2 * k + 1]) - 3.0};
    };
    P from = point(0);
    const auto line = [&](const P& to) {
      all.push_back({from[0], from[1], to[0], to[1]}), from = to;
    };
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const P a = from, b = point(k), next = point(k + 1);
      const P c =
          k + 2 < n ? P{(b[0] + next[0]) / 2, (b[1] + next[1]) / 2} : next;
      const double turn = std::abs((b[0] - a[0]) * (c[1] - b[1]) -
                                   (b[1] - a[1]) * (c[0] - b[0]));
      const int parts = turn > 0 ? 6 : 1;
      for (int i = 1; i <= parts; ++i) {
        const double t = double(i) / parts, s = 1 - t;
        line({s * s * a[0] + 2 * s * t * b[0] + t * t * c[0],
              s * s * a[1] + 2 * s * t * b[1] + t * t * c[1]});
      }
    }
    if (n == 2) line(point(1));
  }
  return all;
}

}  // namespace letters

/** A picture to be laid over another one. Lengths in pixels, y downwards. */
class Layer {
 public:
  /** A color and its opacity. */
  struct Ink {
    Color color = Color(1);
    double alpha = 1;
  };

  /** Make it @a width x @a height, and clear. */
  void start(int width, int height) {
    width_ = width, height_ = height;
    rgba_.assign(std::size_t(width) * height, {});
  }
  int width() const { return width_; }
  int height() const { return height_; }
  /** Rows from the top; red, green, blue, each times alpha, and alpha. */
  const std::vector<std::array<std::uint8_t, 4>>& rgba() const { return rgba_; }

  void box(double x0, double y0, double x1, double y1, Ink ink) {
    cover(x0, y0, x1, y1, ink, [=](double x, double y) {
      return std::min({x - x0, x1 - x, y - y0, y1 - y});
    });
  }

  /** The width of a line of text whose letters are @a size high, as fonts
   * count: a capital's height is 0.73 of it. */
  static double width(std::string_view text, double size) {
    double sum = 0;
    for (char c : text) sum += std::round(unit(size) * letters::advance(c));
    return sum;
  }

  /** Write a line with its top left corner at (x, y), and a dark rim that
   * keeps it readable on any picture. */
  void write(double x, double y, double size, Ink ink, std::string_view text) {
    const double u = unit(size), half = std::max(0.55, 0.05 * size);
    // The base line and the top of an x are in the middle of a row of pixels.
    const double base = std::round(y + 0.95 * size) + 0.5;
    const double x_height = std::round(7 * u), capital = std::round(10 * u);
    const auto height = [&](double h) {
      return h <= 0   ? h * u
             : h <= 7 ? h * x_height / 7
                      : x_height + (h - 7) * (capital - x_height) / 3;
    };
    const double rim = std::max(1.2, 0.09 * size);
    for (const bool dark : {true, false}) {
      double left = std::round(x);
      for (char c : text) {
        auto pieces = letters::pieces(c);
        for (auto& p : pieces)
          p = {left + p.x0 * u, base - height(p.y0), left + p.x1 * u,
               base - height(p.y1)};
        if (dark)
          strokes(pieces, half + rim, {Color(0.03f), 0.75 * ink.alpha});
        else
          strokes(pieces, half, ink);
        left += std::round(u * letters::advance(c));
      }
    }
  }

  /** Straight pieces with round ends, @a half on each side. */
  void strokes(const std::vector<letters::Piece>& pieces, double half,
               Ink ink) {
    if (pieces.empty()) return;
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const auto& p : pieces) {
      x0 = std::min({x0, p.x0, p.x1}), x1 = std::max({x1, p.x0, p.x1});
      y0 = std::min({y0, p.y0, p.y1}), y1 = std::max({y1, p.y0, p.y1});
    }
    cover(x0 - half, y0 - half, x1 + half, y1 + half, ink,
          [&](double x, double y) {
            double least = 1e18;
            for (const auto& p : pieces) {
              const double dx = p.x1 - p.x0, dy = p.y1 - p.y0;
              const double length = dx * dx + dy * dy;
              const double at =
                  length > 0
                      ? std::clamp(((x - p.x0) * dx + (y - p.y0) * dy) / length,
                                   0., 1.)
                      : 0;
              const double ex = p.x0 + at * dx - x, ey = p.y0 + at * dy - y;
              least = std::min(least, ex * ex + ey * ey);
            }
            return half - std::sqrt(least);
          });
  }

 private:
  int width_ = 0, height_ = 0;
  std::vector<std::array<std::uint8_t, 4>> rgba_;

  static double unit(double size) { return 0.073 * size; }

  /** Blend @a ink over the pixels of a box, where @a inside(x, y), the distance
   * to the rim, is positive inside. */
  template <typename F>
  void cover(double x0, double y0, double x1, double y1, Ink ink, F inside) {
    const int left = int(std::max(std::floor(x0) - 1, 0.)),
              right = int(std::min(std::ceil(x1) + 1, double(width_))),
              top = int(std::max(std::floor(y0) - 1, 0.)),
              bottom = int(std::min(std::ceil(y1) + 1, double(height_)));
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const double a =
            ink.alpha * std::clamp(inside(x + 0.5, y + 0.5) + 0.5, 0., 1.);
        if (a <= 0) continue;
        auto& p = rgba_[std::size_t(y) * width_ + x];
        const double over[] = {ink.color.r * a, ink.color.g * a,
                               ink.color.b * a, a};
        for (unsigned k = 0; k < 4; ++k)
          p[k] = std::uint8_t(std::lround(255 * over[k] + (1 - a) * p[k]));
      }
  }
};

}  // namespace CME212
