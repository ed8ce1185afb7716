#pragma once
/** @file GLOverlay.hpp
 * GLOverlay: text and a color scale over a picture. */
#define GL_GLEXT_PROTOTYPES
#include <SDL_opengl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "CME212/Color.hpp"
#include "CME212/Util.hpp"
#include "CME212/viewer/GLShaders.hpp"
#include "CME212/viewer/GLTools.hpp"
#include "CME212/viewer/Layer.hpp"
#include "CME212/viewer/SceneBuilder.hpp"

namespace CME212 {

/** What to write over a picture; an empty text is not drawn. */
struct OverlayText {
  std::string label;              // top left
  std::vector<std::string> help;  // lines, bottom left
  // Paragraphs on a veil above; the first and the last matter most.
  std::vector<std::string> message;
  Color bar;  // at the left of the message
  std::vector<std::array<std::array<double, 2>, 2>> marks;  // ends [pixels]
  bool has_scale = false;  // draw scale at the right
  StrainScale scale;
  bool operator==(const OverlayText&) const = default;
};

/** Draws an OverlayText. The same text always gives the same pixels.
 * Use: as GLScene, with one OpenGL context current. */
class GLOverlay {
 public:
  GLOverlay() {
    glGenTextures(1, &texture_);
    glGenVertexArrays(1, &array_);
  }

  /** Draw @a text over a picture of @a width x @a height pixels.
   * @param scale Size of everything, 1 on a plain screen */
  void draw(const OverlayText& text, int width, int height, double scale) {
    glBindTexture(GL_TEXTURE_2D, texture_);
    if (text != text_ || scale != unit_ || width != layer_.width() ||
        height != layer_.height()) {
      text_ = text, unit_ = scale;
      layer_.start(width, height);
      lay_out();
      glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
      for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
      glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA,
                   GL_UNSIGNED_BYTE, layer_.rgba().data());
    }
    program_.use();
    program_.set("height", float(height));
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(array_);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glBindVertexArray(0);
    glDisable(GL_BLEND);
  }

 private:
  using Ink = Layer::Ink;
  static constexpr Ink bright{Color(0.94f, 0.95f, 0.97f), 1},
      dim{Color(0.70f, 0.74f, 0.80f), 1},
      veil{Color(0.03f, 0.04f, 0.05f), 0.75};
  static constexpr double large = 20, medium = 16, small = 15;  // of letters

  GLProgram program_{{shaders::backdrop_vertex}, {shaders::overlay_fragment}};
  GLuint texture_ = 0, array_ = 0;  // OpenGL draws nothing without an array
  Layer layer_;
  OverlayText text_;  // in layer_
  double unit_ = 0;   // [pixels]

  /** Write a line.  @return its height, with the space below [pixels] */
  double write(double x, double y, double size, Ink ink,
               const std::string& line) {
    layer_.write(x, y, size * unit_, ink, line);
    return row(size);
  }
  double row(double size) const { return std::round(1.35 * size * unit_); }
  double width_of(const std::string& line, double size) const {
    return Layer::width(line, size * unit_);
  }
  /** @a text in lines of at most @a width. */
  std::vector<std::string> wrapped(const std::string& text, double size,
                                   double width) const {
    std::vector<std::string> lines{""};
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      const auto longer = lines.back() + (lines.back().empty() ? "" : " ");
      if (!lines.back().empty() && width_of(longer + word, size) > width)
        lines.push_back(word);
      else
        lines.back() = longer + word;
    }
    return lines;
  }

  void lay_out() {
    const double margin = 16 * unit_, gap = 8 * unit_;
    for (const auto& [from, to] : text_.marks) draw_mark(from, to);
    write(margin, margin, large, bright, text_.label);
    double y = layer_.height() - margin;
    for (auto line = text_.help.rbegin(); line != text_.help.rend(); ++line)
      y -= row(small), write(margin, y, small, dim, *line);
    if (!text_.help.empty()) y -= gap;
    if (!text_.message.empty()) draw_message(margin, y);
    if (text_.has_scale) draw_scale(layer_.width() - margin, margin);
  }

  /** A thick line between two places, or a ring around one, with a dark rim. */
  void draw_mark(const std::array<double, 2>& from,
                 const std::array<double, 2>& to) {
    for (double a : {from[0], from[1], to[0], to[1]})
      if (!(std::abs(a) < 1e5)) return;  // far outside, or behind the eye
    std::vector<letters::Piece> pieces{{from[0], from[1], to[0], to[1]}};
    if (from == to) {
      pieces.clear();
      constexpr int sides = 32;
      const auto at = [&](int k) {
        const double turn = 2 * std::numbers::pi * k / sides;
        return std::array{from[0] + 17 * unit_ * std::cos(turn),
                          from[1] + 17 * unit_ * std::sin(turn)};
      };
      for (int k = 0; k < sides; ++k) {
        const auto a = at(k), b = at(k + 1);
        pieces.push_back({a[0], a[1], b[0], b[1]});
      }
    }
    layer_.strokes(pieces, 3.25 * unit_, {Color(), 1});
    layer_.strokes(pieces, 1.75 * unit_, {Color::make_mark(), 1});
  }

  /** The message over the full width, and up from @a bottom. */
  void draw_message(double margin, double bottom) {
    const double pad = 10 * unit_, bar = 5 * unit_;
    const double right = layer_.width() - margin;
    std::vector<std::pair<std::string, Ink>> lines;
    for (const auto& p : text_.message) {
      const bool matters = &p - &text_.message.front() < 2;
      for (auto& line : wrapped(p, medium, right - margin - bar - 2 * pad))
        lines.emplace_back(std::move(line), matters ? bright : dim);
    }
    const double top = bottom - 2 * pad - double(lines.size()) * row(medium);
    layer_.box(margin, top, right, bottom, veil);
    layer_.box(margin, top, margin + bar, bottom, {text_.bar, 1});
    double y = top + pad;
    for (const auto& [line, ink] : lines)
      y += write(margin + bar + pad, y, medium, ink, line);
  }

  /** The scale, with its top right corner at (right, top). */
  void draw_scale(double right, double top) {
    const auto write_left_of = [&](double x, double y, const std::string& s,
                                   double size) {
      write(x - width_of(s, size), y, size, bright, s);
    };
    write_left_of(right, top, "strain l/L - 1", medium);
    top = std::round(top + 32 * unit_);
    const double left = right - 16 * unit_;
    const int rows = int(160 * unit_);
    for (int i = 0; i < rows; ++i)
      layer_.box(left, top + i, right, top + i + 1,
                 {Color::make_strain(1 - (2 * i + 1) / float(rows)), 1});
    const std::string limit = short_text(text_.scale.limit) + " %";
    const std::string labels[] = {
        "taut  " + ((text_.scale.above ? "> " : "") + limit), "at rest  0",
        "slack  " + ((text_.scale.below ? "< -" : "-") + limit)};
    for (int i = 0; i <= 2; ++i) {
      const double y = top + rows * i / 2.0;
      layer_.box(left - 4 * unit_, y - 0.5, left, y + 0.5, dim);
      write_left_of(left - 8 * unit_, y - 9 * unit_, labels[i], small);
    }
  }
};

}  // namespace CME212
