#pragma once
/** @file GLOverlay.hpp
 * GLOverlay: text and a color scale over a picture, by Dear ImGui. */
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "CME212/Color.hpp"
#include "CME212/viewer/Look.hpp"
#include "CME212/viewer/SDLInput.hpp"

namespace CME212 {

/** What to write over a picture; an empty text is not drawn. */
struct OverlayText {
  std::string label;              // large, top left
  std::string state;              // below it
  std::vector<std::string> help;  // lines, bottom left
  // Paragraphs in a panel above; the first and the last matter most.
  std::vector<std::string> message;
  std::vector<std::string> card;  // lines, bottom left, the first one large
  bool has_scale = false;         // draw scale at the right
  ColorScale scale;
  // What the mouse does [pixels]:
  std::optional<std::array<float, 2>> ring;
  std::vector<std::array<float, 2>> line;
};

/** Draws an OverlayText, and lets a program draw panels of its own: start(),
 * perhaps open() and then panels, finish().
 * Use: as GLScene, with one OpenGL context current. Without open() the same
 * text always gives the same pixels. */
class GLOverlay {
 public:
  SDLInput input;  ///< what the user does, for panels

  /** Throws std::runtime_error if Dear ImGui does not start. */
  GLOverlay() {
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr;  // writes no file
    SDLInput::name_keys();
    if (!ImGui_ImplOpenGL3_Init("#version 330")) {
      ImGui::DestroyContext(context_);
      throw std::runtime_error("Dear ImGui does not start");
    }
  }
  GLOverlay(const GLOverlay&) = delete;
  GLOverlay& operator=(const GLOverlay&) = delete;
  ~GLOverlay() {
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(context_);
  }

  /** Begin a picture of @a width x @a height pixels.
   * @param scale Size of everything, 1 on a plain screen */
  void start(int width, int height, double scale) {
    ImGui::SetCurrentContext(context_);
    set_font(scale);
    ImGui::GetIO().DisplaySize = ImVec2(float(width), float(height));
    ImGui::GetIO().DeltaTime = 1.0f / 60;
    ImGui_ImplOpenGL3_NewFrame();
    unit_ = float(scale);
    is_open_ = false;
  }
  /** Let panels be drawn until finish().
   * @param pixels To a unit of the mouse
   * @return events that panels were given now  @pre start() */
  std::vector<SDL_Event> open(double pixels) {
    const auto events = input.feed(pixels);
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<float> since = now - last_open_;
    last_open_ = now;
    ImGui::GetIO().DeltaTime = std::clamp(since.count(), 0.001f, 1.0f);
    ImGui::NewFrame();
    is_open_ = true;
    return events;
  }
  /** Draw @a text, right of the panels at the @a left [pixels], and them over
   * it.  @pre start() */
  void finish(const OverlayText& text, double left) {
    if (!is_open_) ImGui::NewFrame();
    const auto& size = ImGui::GetIO().DisplaySize;
    list_ = ImGui::GetBackgroundDrawList();
    const float margin = 16 * unit_;
    const float from = float(left) + margin, to = size.x - margin;
    float y = margin;
    y += write(from, y, large, bright, text.label);
    write(from, y, medium, dim, text.state);
    y = size.y - margin;
    for (auto line = text.help.rbegin(); line != text.help.rend(); ++line) {
      y -= text_height(small, *line, to - from);
      write(from, y, small, dim, *line, to - from);
    }
    if (!text.message.empty())
      draw_message(text.message, from, to,
                   text.help.empty() ? y : y - 8 * unit_);
    if (!text.card.empty()) draw_card(text.card, from, size.y - margin);
    if (text.has_scale) draw_scale(text.scale, to, margin);
    draw_mouse(text);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }

  /** True if the mouse is on a panel, or was pressed there. True if the user
   * types into a panel. */
  bool panels_want_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
  bool panels_want_keys() const {
    ImGui::SetCurrentContext(context_);
    return ImGui::GetIO().WantTextInput;
  }

 private:
  static constexpr ImU32 bright = IM_COL32(240, 243, 248, 255);
  static constexpr ImU32 dim = IM_COL32(165, 175, 190, 255);
  enum Size { large, medium, small };
  static constexpr float points[] = {20, 15, 14};  // of each Size

  ImGuiContext* context_ = ImGui::CreateContext();
  std::chrono::steady_clock::time_point last_open_;
  bool is_open_ = false;
  double font_scale_ = 0;  // the scale of the present letters
  // From start() to finish():
  ImDrawList* list_ = nullptr;
  float unit_ = 1;  // [pixels]

  /** Letters are made at the size at which they are drawn, so they are sharp:
   * DejaVu Sans where Debian has it, otherwise Dear ImGui's own. */
  void set_font(double scale) {
    if (scale == font_scale_) return;
    font_scale_ = scale;
    static const ImWchar letters[] = {0x20,   0xff,   0x370,  0x3ff, 0x2010,
                                      0x209f, 0x2190, 0x22ff, 0};
    const char* file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    std::FILE* there = std::fopen(file, "rb");
    if (there) std::fclose(there);
    for (float size : points) {
      ImFontConfig config;
      config.SizePixels = std::round(size * float(scale));
      if (there)
        atlas.AddFontFromFileTTF(file, config.SizePixels, &config, letters);
      else
        atlas.AddFontDefault(&config);
    }
    ImGui::GetIO().FontDefault = atlas.Fonts[small];
    ImGui::GetStyle() = ImGuiStyle();
    ImGui::GetStyle().ScaleAllSizes(float(scale));
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  static ImFont* font(Size size) { return ImGui::GetIO().Fonts->Fonts[size]; }

  /** Write a text with its top left corner at (x, y), in one line or, if
   * @a wrap > 0, in lines of at most that width [pixels].
   * @return the height it takes [pixels] */
  float write(float x, float y, Size size, ImU32 color, const std::string& text,
              float wrap = 0) const {
    if (text.empty()) return 0;
    ImFont* f = font(size);
    const char* end = text.data() + text.size();
    float shadow = std::max(1.0f, std::round(unit_));
    for (float shift : {shadow, 0.0f})
      list_->AddText(
          f, f->FontSize, {std::round(x) + shift, std::round(y) + shift},
          shift > 0 ? IM_COL32(0, 0, 0, 200) : color, text.data(), end, wrap);
    return text_height(size, text, wrap);
  }
  static float text_height(Size size, const std::string& text, float wrap) {
    ImFont* f = font(size);
    return 0.35f * f->FontSize + f->CalcTextSizeA(f->FontSize, 1e9f, wrap,
                                                  text.data(),
                                                  text.data() + text.size())
                                     .y;
  }
  static float text_width(Size size, const std::string& text) {
    ImFont* f = font(size);
    return f
        ->CalcTextSizeA(f->FontSize, 1e9f, 0, text.data(),
                        text.data() + text.size())
        .x;
  }
  static std::string number(double v, const std::string& unit) {
    char s[40];
    std::snprintf(s, sizeof s, "%.3g", v);
    return s + (unit.empty() ? "" : " " + unit);
  }

  /** The panel from @a left to @a right and up from @a bottom. */
  void draw_message(const std::vector<std::string>& paragraphs, float left,
                    float right, float bottom) const {
    const float pad = 10 * unit_, bar = 5 * unit_;
    const float wrap = right - left - bar - 2 * pad;
    float y = bottom - 2 * pad;
    for (const auto& p : paragraphs) y -= text_height(medium, p, wrap);
    const Color c = Color::make_mark();
    const ImU32 mark = ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1});
    list_->AddRectFilled({left, y}, {right, bottom}, IM_COL32(8, 10, 14, 190));
    list_->AddRectFilled({left, y}, {left + bar, bottom}, mark);
    y += pad;
    for (const auto& p : paragraphs) {
      const bool matters =
          &p == &paragraphs.front() || &p == &paragraphs.back();
      y += write(left + bar + pad, y, medium, matters ? bright : dim, p, wrap);
    }
  }

  /** Lines on a veil, right of @a left and up from @a bottom. */
  void draw_card(const std::vector<std::string>& lines, float left,
                 float bottom) const {
    auto style = [&](const std::string& s) {
      return &s == &lines.front() ? large : medium;
    };
    const float pad = 12 * unit_;
    float wide = 0, high = 0;
    for (const auto& s : lines) {
      wide = std::max(wide, text_width(style(s), s));
      high += text_height(style(s), s, 0);
    }
    float y = bottom - high - pad;
    list_->AddRectFilled({left, y - pad}, {left + wide + 2 * pad, bottom},
                         IM_COL32(8, 10, 14, 190), 8 * unit_);
    for (const auto& s : lines)
      y += write(left + pad, y, style(s), style(s) == large ? bright : dim, s);
  }

  /** A ring around a node, and the line from it to the mouse or of a cut. */
  void draw_mouse(const OverlayText& text) const {
    for (const auto& [color, width] :
         {std::pair(IM_COL32(0, 0, 0, 160), 4 * unit_), {bright, 2 * unit_}}) {
      std::vector<ImVec2> line;
      for (const auto& [x, y] : text.line) line.emplace_back(x, y);
      list_->AddPolyline(line.data(), int(line.size()), color, 0, width);
      if (text.ring)
        list_->AddCircle({(*text.ring)[0], (*text.ring)[1]}, 9 * unit_, color,
                         0, width);
    }
  }

  /** The scale, with its top right corner at (right, top). */
  void draw_scale(const ColorScale& scale, float right, float top) const {
    constexpr int bands = 32;
    const float width = 16 * unit_, height = 160 * unit_;
    write(right - text_width(medium, scale.title), top, medium, bright,
          scale.title);
    top += 28 * unit_;
    const float left = right - width, step = height / bands;
    for (int i = 0; i < bands; ++i) {
      float y = top + float(i) * step;
      ImU32 upper = color(1 - 2 * float(i) / bands);
      ImU32 lower = color(1 - 2 * float(i + 1) / bands);
      list_->AddRectFilledMultiColor({left, y}, {right, y + step}, upper, upper,
                                     lower, lower);
    }
    const std::string high = number(scale.limit, scale.unit);
    const std::string labels[] = {
        "taut  " + ((scale.above ? "> " : "") + high), "at rest  0",
        "slack  " + ((scale.below ? "< -" : "-") + high)};
    for (int i = 0; i <= 2; ++i) {
      float y = top + height * float(i) / 2;
      list_->AddLine({left - 4 * unit_, y}, {left, y}, dim, unit_);
      write(left - 8 * unit_ - text_width(small, labels[i]), y - 8 * unit_,
            small, bright, labels[i]);
    }
  }
  static ImU32 color(float v) {
    Color c = Color::make_strain(std::clamp(v, -1.0f, 1.0f));
    return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1});
  }
};

}  // namespace CME212
