/** @file Plot.cpp */
#include "lab/viewer/Plot.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace lab {

std::vector<double> axis_ticks(double low, double high, int most, bool log) {
  std::vector<double> ticks;
  if (log) {
    const int first = int(std::ceil(std::log10(low) - 1e-9));
    const int last = int(std::floor(std::log10(high) + 1e-9));
    const int by = std::max(1, (last - first) / most + 1);
    for (int k = first; k <= last; k += by) ticks.push_back(std::pow(10, k));
    return ticks;
  }
  double step = std::pow(10, std::floor(std::log10((high - low) / most)));
  for (double factor : {2.0, 2.5, 2.0})
    if ((high - low) / step > most) step *= factor;
  for (double k = std::ceil(low / step); k * step <= high; ++k)
    ticks.push_back(k * step);
  return ticks;
}

std::string tick_text(double value, double step) {
  if (value == 0 && step < 1e-4) return "0";
  char text[32];
  const double size = std::max(std::abs(value), step);
  if (value != 0 && (size >= 1e5 || step < 1e-4)) {
    std::snprintf(text, sizeof text, "%.3g", value);
  } else {
    const double digits = std::ceil(-std::log10(step) - 1e-9);
    std::snprintf(text, sizeof text, "%.*f", int(std::max(digits, 0.0)),
                  value + 0.0);  // never -0
  }
  return text;
}

/** A power of ten, short. */
static std::string power_text(double value) {
  const int k = int(std::lround(std::log10(value)));
  if (k < -2 || k > 3) return "1e" + std::to_string(k);
  return tick_text(value, value);
}

std::array<double, 2> axis_range(std::span<const Curve> curves, bool log) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Curve& c : curves)
    for (const double v : c.values)
      if (std::isfinite(v) && (!log || v > 0))
        low = std::min(low, v), high = std::max(high, v);
  if (low > high) return log ? std::array{0.1, 1.0} : std::array{0.0, 1.0};
  if (log)
    return {std::pow(10, std::floor(std::log10(low) - 0.01)),
            std::pow(10, std::ceil(std::log10(high) + 0.01))};
  const double margin =
      high > low ? 0.06 * (high - low) : std::max(0.1 * std::abs(low), 1e-6);
  return {low - margin, high + margin};
}

void plot(const char* title, std::span<const float> times,
          std::span<const Curve> curves, float height, bool log) {
  const float unit = ImGui::GetFontSize() / 14;
  ImGui::TextUnformatted(title);
  for (const Curve& c : curves) {
    if (&c != curves.data()) {
      ImGui::SameLine(0, 10 * unit);
      const float right =
          ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
      if (ImGui::GetCursorScreenPos().x + ImGui::CalcTextSize(c.name).x > right)
        ImGui::NewLine();
    }
    ImGui::PushStyleColor(ImGuiCol_Text, c.color);
    ImGui::TextUnformatted(c.name);
    ImGui::PopStyleColor();
  }

  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::Dummy({width, height});
  const float left = corner.x + 46 * unit, right = corner.x + width - 6 * unit;
  const float top = corner.y + 6 * unit, bottom = corner.y + height - 20 * unit;
  if (right - left < 20 * unit || bottom - top < 20 * unit) return;
  const auto [low, high] = axis_range(curves, log);
  const auto scaled = [log](double v) { return log ? std::log10(v) : v; };
  const auto y_of = [&, bottom_value = scaled(low),
                     span = scaled(high) - scaled(low)](double v) {
    return bottom - (bottom - top) * float((scaled(v) - bottom_value) / span);
  };
  const double first = times.empty() ? 0 : times.front();
  const double last =
      times.empty() || !(times.back() > first) ? first + 1 : times.back();
  const auto x_of = [&](double t) {
    return left + (right - left) * float((t - first) / (last - first));
  };

  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr PanelColor ground = 0xff140f0c, grid = 0xff3a3430,
                       text = 0xffbeafa5;
  list.AddRectFilled({left, top}, {right, bottom}, ground);
  const auto write = [&](const std::string& s, float x, float y, float align) {
    x -= align * ImGui::CalcTextSize(s.c_str()).x;
    list.AddText({x, y}, text, s.c_str());
  };
  const float half = ImGui::GetFontSize() / 2;
  const auto rows =
      axis_ticks(low, high, std::max(2, int((bottom - top) / (3 * half))), log);
  for (double v : rows) {
    const float y = std::round(y_of(v));
    list.AddLine({left, y}, {right, y}, grid, unit);
    write(log ? power_text(v)
              : tick_text(v, rows.size() > 1 ? rows[1] - rows[0] : high - low),
          left - 5 * unit, y - half, 1);
  }
  const auto columns = axis_ticks(
      first, last, std::max(2, int((right - left) / (60 * unit))), false);
  for (const double& t : columns) {
    const float x = std::round(x_of(t));
    list.AddLine({x, top}, {x, bottom}, grid, unit);
    const std::string s =
        tick_text(t, columns.size() > 1 ? columns[1] - columns[0] : last);
    const float room = right - ImGui::CalcTextSize((s + " s").c_str()).x / 2;
    if (x < room)
      write(&t == &columns.back() ? s + " s" : s, x, bottom + 3 * unit, 0.5f);
  }
  list.AddRect({left, top}, {right, bottom}, text, 0, 0, unit);

  list.PushClipRect({left, top}, {right, bottom}, true);
  std::vector<ImVec2> line;
  for (const Curve& c : curves) {
    const auto finish = [&] {
      list.AddPolyline(line.data(), int(line.size()), c.color, 0, 1.8f * unit);
      line.clear();
    };
    for (std::size_t i = 0; i < std::min(c.values.size(), times.size()); ++i) {
      const float v = c.values[i];
      if (std::isfinite(v) && (!log || v > 0))
        line.emplace_back(x_of(times[i]), y_of(v));
      else
        finish();
    }
    finish();
  }
  list.PopClipRect();
}

}  // namespace lab
