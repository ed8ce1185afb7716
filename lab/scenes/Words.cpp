#include "lab/scenes/Words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string_view>

#include "CME212/Util.hpp"
#include "lab/Nearest.hpp"
#include "lab/methods/Methods.hpp"

namespace lab {

using CME212::exact_text;
using CME212::short_text;

Words::Words(std::string option, std::string text,
             std::initializer_list<Word> allowed)
    : option_(std::move(option)), text_(std::move(text)) {
  auto names = [&] {
    std::string all;
    for (const Word& w : allowed)
      all += (all.empty() ? "" : ", ") + std::string(w.name);
    return all;
  };
  std::istringstream in(text_);
  std::string word;
  std::vector<double>* numbers = nullptr;
  while (in >> word) {
    if (std::ranges::find(allowed, word, &Word::name) != allowed.end()) {
      if (found_.count(word)) fail("has " + word + " twice");
      numbers = &found_[word];
      continue;
    }
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value) || !numbers)
      fail("has \"" + word + "\", expected " +
           (numbers ? "a number or one of " : "one of ") + names());
    numbers->push_back(value);
  }
  for (const Word& w : allowed)
    if (auto it = found_.find(w.name);
        it != found_.end() && it->second.size() != w.numbers) {
      const std::size_t n = it->second.size();
      fail("has " + std::to_string(n) + (n == 1 ? " number" : " numbers") +
           " after " + w.name + ", expected " + std::to_string(w.numbers));
    }
}

double Words::number(const char* name, double otherwise) const {
  auto it = found_.find(name);
  return it == found_.end() ? otherwise : it->second[0];
}
Point Words::point(const char* name, const Point& otherwise) const {
  auto it = found_.find(name);
  if (it == found_.end()) return otherwise;
  return Point(it->second[0], it->second[1], it->second[2]);
}
double Words::above(const char* name, double low) const {
  require(name);
  const double value = number(name, 0);
  if (!(value > low)) fail_range(name, value, "more than", low);
  return value;
}
double Words::at_least(const char* name, double low, double otherwise) const {
  const double value = number(name, otherwise);
  if (!(value >= low)) fail_range(name, value, "at least", low);
  return value;
}
void Words::require(const char* name) const {
  if (!has(name)) fail(std::string("has no ") + name);
}
void Words::fail(const std::string& what) const {
  throw SceneError(option_, "\"" + text_ + "\" " + what);
}
void Words::fail_range(const char* name, double value, const char* relation,
                       double low) const {
  fail(std::string("has ") + name + ' ' + short_text(value) + ", expected " +
       relation + ' ' + short_text(low));
}

// -------------------------------------------------------------------- Reading

namespace {

Motion motion_of(const Words& w) {
  if (w.has("until")) w.require("velocity");
  return {w.point("velocity", Point()), w.at_least("until", 0, Motion().until)};
}
Ball ball_of(const Words& w) {
  Ball ball;
  ball.center = w.point("at", ball.center);
  if (w.has("radius")) ball.radius = w.above("radius", 0);
  return ball;
}
unsigned count_of(const Words& w, double n) {
  if (!(n >= 2 && n <= 10000 && n == std::floor(n)))
    w.fail("has nodes " + short_text(n) + ", expected 2 to 10000");
  return unsigned(n);
}

}  // namespace

Edges read_edges(const std::string& text) {
  const Words w("edges", text, {{"sides", 0}, {"diagonals", 0}, {"bend", 0}});
  w.require("sides");
  return {w.has("diagonals"), w.has("bend")};
}
Sheet read_sheet(const std::string& text) {
  const Words w("sheet", text,
                {{"at", 3}, {"u", 3}, {"v", 3}, {"nodes", 2}, {"velocity", 3}});
  Sheet s;
  s.at = w.point("at", s.at);
  s.u = w.point("u", s.u), s.v = w.point("v", s.v);
  if (w.has("nodes"))
    for (int k : {0, 1}) s.nodes[k] = count_of(w, w.numbers("nodes")[k]);
  if (!(norm(cross(s.u, s.v)) > 0)) w.fail("has sides u and v without an area");
  s.velocity = w.point("velocity", s.velocity);
  return s;
}
Region read_region(const std::string& text) {
  const Words w(
      "region", text,
      {{"from", 3}, {"to", 3}, {"mass-factor", 1}, {"stiffness-factor", 1}});
  w.require("from"), w.require("to");
  if (!w.has("mass-factor") && !w.has("stiffness-factor"))
    w.fail("has neither mass-factor nor stiffness-factor");
  Region r;
  r.box = {w.point("from", Point()), w.point("to", Point())};
  if (w.has("mass-factor")) r.mass = w.above("mass-factor", 0);
  r.stiffness = w.at_least("stiffness-factor", 0, r.stiffness);
  return r;
}
Pin read_pin(const std::string& text) {
  const Words w("pin", text,
                {{"x", 1}, {"y", 1}, {"z", 1}, {"velocity", 3}, {"until", 1}});
  Pin p;
  if (w.has("x")) p.x = w.number("x", 0);
  if (w.has("y")) p.y = w.number("y", 0);
  if (w.has("z")) p.z = w.number("z", 0);
  if (!p.x && !p.y && !p.z) w.fail("has none of x, y, z");
  p.motion = motion_of(w);
  return p;
}
Wall read_plane(const std::string& text) {
  const Words w("plane", text,
                {{"at", 3},
                 {"normal", 3},
                 {"friction", 1},
                 {"velocity", 3},
                 {"until", 1}});
  Wall p;
  p.at = w.point("at", p.at);
  p.normal = w.point("normal", p.normal);
  if (!(norm(p.normal) > 0)) w.fail("has a normal without a direction");
  p.friction = w.at_least("friction", 0, 0);
  p.motion = motion_of(w);
  return p;
}
Solid read_sphere(const std::string& text) {
  const Words w("sphere", text,
                {{"at", 3},
                 {"radius", 1},
                 {"friction", 1},
                 {"velocity", 3},
                 {"until", 1}});
  return {ball_of(w), w.at_least("friction", 0, 0), motion_of(w)};
}
Ball read_tear(const std::string& text) {
  return ball_of(Words("tear", text, {{"at", 3}, {"radius", 1}}));
}
Distance read_self_collision(const std::string& text) {
  const Words w("self-collision", text, {{"thickness", 1}, {"friction", 1}});
  return {w.above("thickness", 0), w.at_least("friction", 0, 0)};
}
Box read_view(const std::string& text) {
  const Words w("view", text, {{"from", 3}, {"to", 3}});
  w.require("from"), w.require("to");
  const Box v = {w.point("from", Point()), w.point("to", Point())};
  if (v.from == v.to) w.fail("is a box without a size");
  return v;
}
Measure read_measure(const std::string& text) {
  std::string names;
  for (std::size_t k = 0; k < measure_names.size(); ++k) {
    if (text == measure_names[k]) return Measure(k);
    names += std::string(k == 0 ? "" : ", ") + measure_names[k];
  }
  throw SceneError("measure", "is " + text + ", expected one of " + names +
                                  did_you_mean(text, measure_names));
}
TimeStep read_time_step(const std::string& text) {
  TimeStep step;
  double* number = &step.dt;
  std::string_view rest = text;
  const auto skip = [&rest](std::string_view word) {
    const bool there = rest.starts_with(word);
    if (there) rest.remove_prefix(word.size());
    return there;
  };
  if (skip("auto")) {
    step.rule = skip(":sharp") ? StepRule::sharp : StepRule::safe;
    if (rest.empty()) return step;
    number = skip(":") ? &step.gain : nullptr;
  }
  char* end = nullptr;
  if (number) *number = std::strtod(rest.data(), &end);
  if (rest.empty() || !end || *end != '\0' ||
      !(*number > 0 &&
        *number <= (step.fixed() ? std::numeric_limits<double>::max() : 1)))
    throw SceneError("dt", "is " + text +
                               ", expected a positive time [s], auto or "
                               "auto:sharp, or one of these and the share of "
                               "energy it may gain, of (0, 1]: auto:0.02");
  return step;
}
const MethodEntry* read_method(const std::string& text) {
  if (const MethodEntry* method = find_method(text)) return method;
  std::vector<std::string> names;
  for (const MethodEntry& m : methods) names.push_back(m.info.name);
  throw SceneError("method", "is " + text +
                                 ", expected a name of --list-methods" +
                                 did_you_mean(text, names));
}

// ------------------------------------------------------------------- Printing

namespace {

/** All digits of @a a that count. */
std::string digits(Real a) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, a).ptr};
}

/** Words, and the numbers that differ from their default. */
class Writer {
 public:
  Writer& word(const std::string& w) {
    text_ += (text_.empty() ? "" : " ") + w;
    return *this;
  }
  Writer& number(const char* name, double a, double otherwise) {
    if (a != otherwise) word(name).word(exact_text(a));
    return *this;
  }
  Writer& number(const char* name, const std::optional<double>& a) {
    if (a) word(name).word(exact_text(*a));
    return *this;
  }
  Writer& point(const char* name, const Point& p, const Point& otherwise) {
    return p == otherwise ? *this : point(name, p);
  }
  Writer& point(const char* name, const Point& p) {
    word(name);
    for (Real a : {p.x, p.y, p.z}) word(digits(a));
    return *this;
  }
  Writer& ball(const Ball& b) {
    return point("at", b.center, Ball().center)
        .number("radius", b.radius, Ball().radius);
  }
  Writer& motion(const Motion& m) {
    if (m == Motion()) return *this;  // `until` needs a velocity before it
    return point("velocity", m.velocity)
        .number("until", m.until, Motion().until);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::string to_words(const Edges& e) {
  return std::string("sides") + (e.diagonals ? " diagonals" : "") +
         (e.bend ? " bend" : "");
}
std::string to_words(const Sheet& s) {
  const Sheet otherwise;
  Writer w;
  w.point("at", s.at, otherwise.at).point("u", s.u, otherwise.u);
  w.point("v", s.v, otherwise.v);
  if (s.nodes != otherwise.nodes)
    w.word("nodes")
        .word(std::to_string(s.nodes[0]))
        .word(std::to_string(s.nodes[1]));
  return w.point("velocity", s.velocity, otherwise.velocity).text();
}
std::string to_words(const Region& r) {
  Writer w;
  w.point("from", r.box.from).point("to", r.box.to);
  w.number("mass-factor", r.mass, 1);
  if (r.stiffness != 1 || r.mass == 1)  // one of them is there
    w.number("stiffness-factor", r.stiffness);
  return w.text();
}
std::string to_words(const Pin& p) {
  return Writer()
      .number("x", p.x)
      .number("y", p.y)
      .number("z", p.z)
      .motion(p.motion)
      .text();
}
std::string to_words(const Wall& p) {
  return Writer()
      .point("at", p.at, Wall().at)
      .point("normal", p.normal, Wall().normal)
      .number("friction", p.friction, 0)
      .motion(p.motion)
      .text();
}
std::string to_words(const Solid& s) {
  return Writer()
      .ball(s.ball)
      .number("friction", s.friction, 0)
      .motion(s.motion)
      .text();
}
std::string to_words(const Ball& b) { return Writer().ball(b).text(); }
std::string to_words(const Distance& d) {
  return Writer()
      .number("thickness", d.thickness)
      .number("friction", d.friction, 0)
      .text();
}
std::string to_words(const Box& v) {
  return Writer().point("from", v.from).point("to", v.to).text();
}
std::string to_words(const TimeStep& s) {
  if (s.fixed()) return exact_text(s.dt);
  return std::string(s.rule == StepRule::sharp ? "auto:sharp" : "auto") +
         (s.gain == TimeStep().gain ? "" : ':' + exact_text(s.gain));
}

}  // namespace lab
