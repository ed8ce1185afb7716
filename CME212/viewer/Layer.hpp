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
#include "CME212/viewer/Letters.hpp"

namespace CME212 {

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
