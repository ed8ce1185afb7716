/** @file Panel.cpp */
#include "lab/viewer/Panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "lab/Interrupt.hpp"
#include "lab/live/Recording.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/StoredScenes.hpp"

namespace lab {
namespace {

constexpr std::size_t most_frames = 900;  // in plots
const ImVec4 red(1, 0.36f, 0.33f, 1), dim(0.65f, 0.69f, 0.75f, 1);

std::string text_of(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
/** dt as a share of a stability limit, in words. */
std::string share_text(double dt, double limit) {
  if (limit == no_limit) return "no limit";
  if (limit == 0) return "no step is stable";
  return text_of("%.3g", dt / limit);
}
/** True if theory says that the run blows up. */
bool is_beyond(const RunReadings& r) {
  return r.safe_limit != no_limit && r.dt >= r.safe_limit;
}
void write_red(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, red);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}
/** A row of a table: a name, and values in their colors. */
using Cell = std::pair<std::string, ImVec4>;
void row(const char* name, std::initializer_list<Cell> values) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextColored(dim, "%s", name);
  for (const auto& [text, color] : values) {
    ImGui::TableNextColumn();
    ImGui::TextColored(color, "%s", text.c_str());
  }
}
void row(const char* name, const std::string& value, bool bad = false) {
  row(name, {{value, bad ? red : ImGui::GetStyle().Colors[ImGuiCol_Text]}});
}

}  // namespace

Panel::Panel(RequestQueue& requests, CME212::SDLViewer& viewer, double speed)
    : requests_(requests),
      viewer_(viewer),
      speed_(speed),
      side_by_side_(own_method != nullptr),
      rival_(&table_entry<Verlet>) {}

// ------------------------------------------------- On the thread that steps

void Panel::tell(Live& live) {
  const bool sharp = !begun_ || sharp_clock_.seconds() > 0.25;
  if (sharp) sharp_clock_.start();
  Readings r = live.readings(sharp);
  const Scene& scene = live.scene();
  std::vector<std::string> cure;
  if (!r.failure.empty() && !interrupted())
    if (const auto& c = scene.diagnosis().cure)
      cure = {request("method", c->method.info.name),
              request("step", c->dt / dt_unit(scene, c->method))};
  std::lock_guard lock(mutex_);
  told_.cure = std::move(cure);
  if (!begun_) told_.first = live.model();
  if (!begun_ || r.time < rate_from_ || rate_clock_.seconds() > 0.5) {
    const double moved = r.time - rate_from_;
    told_.real_time = begun_ && moved > 0 ? moved / rate_clock_.seconds() : 0;
    rate_from_ = r.time;
    rate_clock_.start();
  }
  begun_ = true;
  told_.model = live.model();
  told_.now = std::move(r);
  remember(told_.now);
}

/** Append @a r to what is plotted. If its time is earlier than that of the last
 * frame, it replaces all frames from there on; but a failure leaves them. */
void Panel::remember(const Readings& r) {
  auto& past = told_.past;
  if (auto& times = past["t"]; !times.empty() && r.time <= times.back()) {
    if (float(r.time) == times.back() || !r.failure.empty()) return;
    const auto later = std::ranges::lower_bound(times, float(r.time));
    const auto left = std::size_t(later - times.begin());
    for (auto& [name, values] : past) values.resize(left);
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();  // a gap
  const auto share = [&](double limit) {
    return limit > 0 && limit != no_limit ? r.dt / limit : none;
  };
  const auto& c = r.comparison;
  for (const auto& [name, value] :
       {std::pair("t", r.time), std::pair("kinetic", r.energy.kinetic),
        std::pair("elastic", r.energy.elastic),
        std::pair("gravitational", r.energy.gravitational),
        std::pair("total", r.energy.total()), std::pair("limit", 1.),
        std::pair("safe", share(r.safe_limit)),
        std::pair("now (sharp)", share(r.sharp_limit)),
        std::pair("apart", c ? c->apart.rms : none),
        std::pair("error of the first", c ? c->error.rms : none),
        std::pair("of the second", c ? c->rival_error.rms : none)}) {
    auto& values = past[name];
    if (values.size() >= most_frames)
      values.erase(values.begin(), values.begin() + most_frames / 8);
    values.push_back(float(value));
  }
}

void Panel::refuse(const std::string& why) {
  std::lock_guard lock(mutex_);
  told_.refusal = why;
}

// ------------------------------------------------- On the thread that draws

std::array<double, 2> Panel::place_of(const std::string& control) const {
  std::lock_guard lock(mutex_);
  const auto at = places_.find(control);
  return at == places_.end() ? std::array{0.0, 0.0} : at->second;
}

/** Keep where the control that was drawn last is. */
void Panel::mark(const char* control) {
  if (!ImGui::IsItemVisible()) return;
  const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
  std::lock_guard lock(mutex_);
  places_[control] = {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

void Panel::ask(std::string request) {
  {
    std::lock_guard lock(mutex_);
    told_.refusal.clear();
  }
  requests_.push(std::move(request));
  viewer_.wake();
}

bool Panel::button(const char* label, float width) {
  const bool pressed = ImGui::Button(label, {width, 0});
  mark(label);
  return pressed;
}

bool Panel::slider(const char* label, double& value, double low, double high,
                   const char* format, bool log) {
  const bool moved = ImGui::SliderScalar(
      (std::string("##") + label).c_str(), ImGuiDataType_Double, &value, &low,
      &high, "",
      ImGuiSliderFlags_AlwaysClamp | (log ? ImGuiSliderFlags_Logarithmic : 0));
  mark(label);
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::TextUnformatted(label);  // the number beside, not under, the grab
  ImGui::SameLine(0, 6 * unit_);
  ImGui::TextUnformatted(text_of(format, value).c_str());
  return moved;
}

bool Panel::choose_method(const char* label, const MethodEntry*& method) {
  const MethodEntry* const before = method;
  const bool open =
      ImGui::BeginCombo(label, method->info.name, ImGuiComboFlags_HeightLarge);
  mark(label);
  if (!open) return false;
  const auto offer = [&](const MethodEntry& m) {
    const bool is_it = std::string(m.info.name) == method->info.name;
    if (ImGui::Selectable(m.info.name, is_it)) method = &m;
    mark((std::string(label) + '/' + m.info.name).c_str());
  };
  if (own_method) offer(*own_method);
  std::for_each(std::begin(methods), std::end(methods), offer);
  ImGui::EndCombo();
  return method != before;
}

double Panel::draw() {
  {
    std::lock_guard lock(mutex_);
    shown_ = told_;
    places_.clear();
  }
  unit_ = ImGui::GetFontSize() / 14;
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float width = std::min(300 * unit_, 0.46f * all.x);
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({width, all.y});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.05f, 0.06f, 0.08f, 0.94f});
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::PushItemWidth(-150 * unit_);
  draw_player();
  const auto section = [this](const char* title, bool open, auto draw_it) {
    const bool shown = ImGui::CollapsingHeader(
        title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    mark(title);
    if (shown) (this->*draw_it)();
  };
  section("Controls", true, &Panel::draw_controls);
  section("Numbers", true, &Panel::draw_numbers);
  section("Plots", true, &Panel::draw_plots);
  section("Two methods", false, &Panel::draw_comparison);
  section("Scenes, and how to break them", false, &Panel::draw_scenes);
  ImGui::PopItemWidth();
  ImGui::End();
  ImGui::PopStyleColor();
  return width;
}

void Panel::draw_player() {
  const Readings& r = shown_.now;
  const bool paused = viewer_.paused();
  const float third =
      (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) /
      3;
  if (ImGui::Button(paused ? "play###play" : "pause###play", {third, 0}))
    viewer_.set_paused(!paused);
  mark("play");
  ImGui::SameLine();
  if (button("step", third)) viewer_.step_once();
  ImGui::SameLine();
  if (button("restart", third)) ask("restart");
  ImGui::Text("t = %.3f s", r.time);
  ImGui::SameLine();
  if (!r.failure.empty()) {
    ImGui::TextColored(red, "it blew up");
    ImGui::SameLine();
    ImGui::BeginDisabled(shown_.cure.empty());
    if (ImGui::SmallButton("apply the cure"))  // no higher than the text
      for (const std::string& r : shown_.cure) ask(r);
    ImGui::EndDisabled();
    mark("apply the cure");
  } else {
    ImGui::TextColored(dim, "%s", paused ? "paused" : "");
  }
  if (!shown_.refusal.empty()) write_red(shown_.refusal);
}

void Panel::draw_controls() {
  const Readings& r = shown_.now;
  const Model& m = shown_.model;
  const MethodEntry* method = m.method;
  if (choose_method("method", method))
    ask(request("method", method->info.name));

  const bool beyond = is_beyond(r);
  double share = r.dt / r.dt_unit;
  if (beyond) {
    ImGui::PushStyleColor(ImGuiCol_FrameBg, {0.55f, 0.08f, 0.08f, 1});
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, {0.65f, 0.12f, 0.1f, 1});
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, {0.65f, 0.12f, 0.1f, 1});
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, red);
  }
  if (slider("dt / limit", share, 0.01, 10, "%.3f"))
    ask(request("step", share));
  if (beyond) ImGui::PopStyleColor(4);
  if (r.safe_limit == 0)
    ImGui::TextColored(red, "No step is stable (shares of verlet's)");
  else if (beyond)
    ImGui::TextColored(red, "Beyond the limit: expect divergence");
  else  // a line in any case, so that nothing moves below it
    ImGui::TextColored(dim, r.safe_limit == no_limit
                                ? "It has no limit: shares of verlet's"
                                : "Below the limit");

  double K = m.material.modulus.value_or(m.stiffness);
  if (slider(m.material.modulus ? "modulus" : "K [N/m]", K, 0.1, 1e5,
             m.material.modulus ? "%.3g N/m" : "%.3g"))
    ask(request("stiffness", K));
  double c = m.material.drag.value_or(m.damping);
  if (slider(m.material.drag ? "drag" : "drag [kg/s]", c, 0,
             m.material.drag ? 100 : 1,
             m.material.drag ? "%.3g kg/(s m^2)" : "%.5f"))
    ask(request("drag", c));
  double g = m.gravity;
  if (slider("g [m/s^2]", g, -20, 20, "%.2f", false))
    ask(request("gravity", g));
  double speed = speed_ > 0 ? speed_.load() : 10;
  if (slider("time scale", speed, 0.01, 10,
             speed_ > 0 ? "%.3g s/s" : "unbounded"))
    speed_ = speed;
}

void Panel::draw_numbers() {
  const Readings& r = shown_.now;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {4 * unit_, unit_ / 2});
  const bool shown = ImGui::BeginTable("numbers", 2);
  ImGui::PopStyleVar();
  if (!shown) return;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 0.9f);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.1f);
  row("method, order", std::string(r.method) + ", " + std::to_string(r.order));
  row("dt", text_of("%.4g s", r.dt));
  row("dt / limit, safe", share_text(r.dt, r.safe_limit), is_beyond(r));
  row("dt / limit, now", share_text(r.dt, r.sharp_limit),
      r.sharp_limit != no_limit && r.dt >= r.sharp_limit);
  row("kinetic", text_of("%.4g J", r.energy.kinetic));
  row("elastic", text_of("%.4g J", r.energy.elastic));
  row("gravitational", text_of("%.4g J", r.energy.gravitational));
  row("total", text_of("%.4g J", r.energy.total()));
  row("drift, contact", text_of("%+.3g J", r.drift));
  row("real-time factor", text_of("%.3g", shown_.real_time));
  row("nodes, edges", std::to_string(r.nodes) + ", " + std::to_string(r.edges));
  row("torn",
      std::to_string(r.torn_nodes) + ", " + std::to_string(r.torn_edges));
  row("touching", CME212::count_of(r.touching, "node"));
  row("force evaluations", text_of("%.4g a sim. s", r.evaluations_rate));
  ImGui::EndTable();
}

Curve Panel::curve(const char* name, PanelColor color) {
  return {name, color, shown_.past[name]};
}

void Panel::draw_plots() {
  using namespace curve_colors;
  // As high as leaves two closed sections in sight, if that is legible.
  const float lines = 4 * ImGui::GetTextLineHeightWithSpacing() +
                      2 * ImGui::GetFrameHeightWithSpacing() + 16 * unit_;
  const float height = std::clamp(
      (ImGui::GetContentRegionAvail().y - lines) / 2, 60 * unit_, 160 * unit_);
  const Curve energies[] = {curve("kinetic", orange), curve("elastic", sky),
                            curve("gravitational", green),
                            curve("total", white)};
  plot("Energy [J]", shown_.past["t"], energies, height);
  const Curve shares[] = {curve("limit", curve_colors::red),
                          curve("safe", orange), curve("now (sharp)", sky)};
  const auto [low, high] = axis_range(shares, false);
  plot("dt / limit [1]", shown_.past["t"], shares, height,
       high > 5 || low < 0.0);
}

void Panel::draw_comparison() {
  const auto& c = shown_.now.comparison;
  bool changed = choose_method("second", rival_);
  ImGui::BeginDisabled(equal_work_);
  changed |= slider("its dt / limit", rival_share_, 0.01, 10, "%.3f");
  ImGui::EndDisabled();
  for (const bool work : {false, true}) {
    const char* const label = work ? "equal work" : "equal time";
    if (work) ImGui::SameLine();
    if (ImGui::RadioButton(label, equal_work_ == work))
      equal_work_ = work, changed = true;
    mark(label);
  }
  const float half =
      (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (button(c ? "compare from here" : "compare", half) || (c && changed))
    ask(request("compare", rival_->info.name, rival_share_,
                equal_work_ ? "equal-work" : "equal-time"));
  ImGui::SameLine();
  bool beside = side_by_side_;
  if (ImGui::Checkbox("side by side", &beside)) {
    side_by_side_ = beside;
    viewer_.wake();
  }
  mark("side by side");
  if (!c) return;
  if (button("stop comparing", half)) ask("alone");

  const Readings& r = shown_.now;
  const ImVec4 second(1, 0.72f, 0.3f, 1);
  ImGui::TextUnformatted(r.method);
  ImGui::SameLine();
  ImGui::TextColored(second, "and %s", c->rival.method);
  if (ImGui::BeginTable("two", 3)) {
    const ImVec4 first = ImGui::GetStyle().Colors[ImGuiCol_Text];
    const auto three = [&](const char* name, const std::string& x,
                           const std::string& y) {
      row(name, {{x, first}, {y, second}});
    };
    const RunReadings& b = c->rival;
    three("dt [s]", text_of("%.3g", r.dt), text_of("%.3g", b.dt));
    three("dt / limit", share_text(r.dt, r.safe_limit),
          share_text(b.dt, b.safe_limit));
    three("evaluations", std::to_string(r.evaluations),
          std::to_string(b.evaluations));
    three("drift, contact [J]", text_of("%+.2g", r.drift),
          text_of("%+.2g", b.drift));
    three("error, rms [m]", text_of("%.2e", c->error.rms),
          text_of("%.2e", c->rival_error.rms));
    three("error, max [m]", text_of("%.2e", c->error.largest),
          text_of("%.2e", c->rival_error.largest));
    ImGui::EndTable();
  }
  if (!c->rival.failure.empty()) write_red(c->rival.failure);
  ImGui::TextWrapped(
      "apart: %.2e m rms, %.2e m at most. Errors are distances "
      "from %s at dt = %.2g s.",
      c->apart.rms, c->apart.largest, c->reference, c->reference_dt);
  using namespace curve_colors;
  const Curve distances[] = {curve("apart", rose),
                             curve("error of the first", white),
                             curve("of the second", orange)};
  plot("Distance, rms [m]", shown_.past["t"], distances, 130 * unit_, true);
}

void Panel::draw_scenes() {
  const bool open = ImGui::BeginCombo("scene", shown_.model.name.c_str(),
                                      ImGuiComboFlags_HeightLarge);
  mark("scene");
  if (open) {
    if (ImGui::Selectable("as it was started"))
      ask(scene_request(shown_.first));
    for (const StoredScene& scene : stored_scenes()) {
      if (ImGui::Selectable(scene.name, scene.name == shown_.model.name))
        load(scene.model());
      mark((std::string("scene/") + scene.name).c_str());
    }
    ImGui::EndCombo();
  }
  ImGui::TextColored(dim, "Break it:");
  for (const StoredScene& b : failing_scenes()) {
    if (ImGui::Button(b.title, {-1, 0})) ask(request("break", b.name));
    mark(b.name);
  }
}

/** Load @a m; if it leaves its mesh open it gets that of now, or grid1. */
void Panel::load(Model m) {
  if (m.nodes.empty() && m.sheets.empty()) {
    const bool has_files = !shown_.model.nodes.empty();
    m.nodes = has_files ? shown_.model.nodes : "data/grid1.nodes";
    m.tets = has_files ? shown_.model.tets : "data/grid1.tets";
  }
  ask(scene_request(m));
}

}  // namespace lab
