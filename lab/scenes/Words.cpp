#include "lab/scenes/Words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <type_traits>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Line.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/Nearest.hpp"

namespace lab {

using CME212::exact_text;
using CME212::short_text;
using enum Word::Range;
using enum Word::Need;

// --------------------------------------------------------- The words of a part

namespace {
Word velocity(Motion& m) {
  const bool ends = m.until != Motion().until && m.turn == Point();
  return {"velocity", &m.velocity, any, ends ? word : none};
}
Word until(Motion& m) { return {"until", &m.until, not_negative}; }
}  // namespace

Words words_of(Edges& e) {
  return {"edges",
          {{"sides", &e.sides, not_negative, word},
           {"diagonals", &e.diagonals, not_negative},
           {"bend", &e.bend, not_negative}}};
}
Words words_of(Sheet& s) {
  const bool has_area = norm(cross(s.u, s.v)) > 0;
  return {"sheet",
          {{"at", &s.at},
           {"u", &s.u},
           {"v", &s.v},
           {"nodes", &s.nodes},
           {"velocity", &s.velocity}},
          has_area ? nullptr : "has parallel sides u and v"};
}
Words words_of(Region& r) {
  return {"region",
          {{"from", &r.box.from, any, word},
           {"to", &r.box.to, any, word},
           {"mass-factor", &r.mass, positive, some},
           {"stiffness-factor", &r.stiffness, not_negative, some}}};
}
Words words_of(Pin& p) {
  return {"pin",
          {{"x", &p.x, any, some},
           {"y", &p.y, any, some},
           {"z", &p.z, any, some},
           {"node", &p.node, not_negative, some},
           velocity(p.motion),
           {"turn", &p.motion.turn},
           {"about", &p.motion.about},
           until(p.motion)}};
}
Words words_of(Wind& w) {
  return {"wind", {{"velocity", &w.velocity, any, word}}};
}
Words words_of(Wall& w) {
  return {"plane",
          {{"at", &w.at},
           {"normal", &w.normal},
           {"friction", &w.friction, not_negative},
           velocity(w.motion),
           until(w.motion)},
          norm(w.normal) > 0 ? nullptr : "has a normal of length 0"};
}
Words words_of(Solid& s) {
  return {"sphere",
          {{"at", &s.ball.center},
           {"radius", &s.ball.radius, positive},
           {"friction", &s.friction, not_negative},
           velocity(s.motion),
           until(s.motion)}};
}
Words words_of(Ball& b) {
  return {"tear", {{"at", &b.center}, {"radius", &b.radius, positive}}};
}
Words words_of(Distance& d) {
  return {"self-collision",
          {{"thickness", &d.thickness, positive, word},
           {"friction", &d.friction, not_negative}}};
}
Words words_of(Measure& m) {
  Words all = {"measure", {}};
  auto take = [&all](std::initializer_list<Word> words) {
    all.all.insert(all.all.end(), words);
  };
  auto place = [&](SheetPlace& p, const char* u, const char* v,
                   const char* sheet) {
    take({{u, &p.u, not_negative},
          {v, &p.v, not_negative},
          {sheet, &p.sheet, positive}});
    if (p.u > 1 || p.v > 1 || p.sheet != std::floor(p.sheet))
      all.wrong = "has no place on a sheet, expected u and v from 0 to 1";
  };
  if (m.quantity == Measure::pin_force)
    take({{"x", &m.pin.x}, {"y", &m.pin.y}, {"z", &m.pin.z}});
  if (m.quantity == Measure::tension)
    take({{"between", &m.between, not_negative, word}});
  if (m.has_place()) place(m.place, "u", "v", "sheet");
  if (m.quantity == Measure::distance) place(m.to, "to-u", "to-v", "to-sheet");
  if (m.quantity == Measure::point || m.quantity == Measure::com) {
    for (std::size_t k = 0; k < 3; ++k) take({{&"x\0y\0z"[2 * k], &m.only[k]}});
    const auto components = std::ranges::count(m.only, true);
    if (components > 1 || (components == 0 && m.over != Measure::at_end))
      all.wrong = "has no single component, expected one of x, y, z";
  }
  if (m.over == Measure::mean) take({{"from", &m.from, not_negative}});
  if (m.over == Measure::first || m.over == Measure::last) {
    take({{"above", &m.above, any, some}, {"below", &m.below, any, some}});
    if (m.above && m.below) all.wrong = "has two levels, expected one";
  }
  return all;
}
Words words_of(Box& v) {
  return {"view",
          {{"from", &v.from, any, word}, {"to", &v.to, any, word}},
          v.from == v.to ? "is an empty box" : nullptr};
}

// -------------------------------------------------------------------- Reading

namespace {

using Numbers = std::vector<double>;

/** How many numbers follow the word, at most. */
std::size_t numbers_after(const Word& w) {
  constexpr std::size_t counts[] = {0, 1, 1, 3, 2, 1};  // of each kind
  return counts[w.member.index()];
}

/** Call @a use(number) for each number of @a w; an optional one is set. */
template <typename Use>
void each_number(const Word& w, Use use) {
  if (auto* a = std::get_if<double*>(&w.member)) use(**a);
  if (auto* a = std::get_if<std::optional<double>*>(&w.member))
    use((*a)->has_value() ? ***a : (*a)->emplace());
  if (auto* a = std::get_if<SpringKind*>(&w.member))
    if ((*a)->K) use(*(*a)->K);
  if (auto* p = std::get_if<Point*>(&w.member))
    for (double& a : **p) use(a);
  if (auto* n = std::get_if<std::array<unsigned, 2>*>(&w.member))
    for (unsigned& a : **n) use(a);
}

/** The condition that the number @a a of a word violates; or null. */
const char* unmet(const Word& w, double a) {
  if (std::holds_alternative<std::array<unsigned, 2>*>(w.member)) {
    const bool index = w.range == not_negative;
    if (a == std::floor(a) && a >= !index && a <= (index ? 4e9 : 10000))
      return nullptr;
    return index ? "the index of a node" : "1 to 10000";
  }
  if (w.range == positive && !(a > 0)) return "more than 0";
  return w.range == not_negative && !(a >= 0) ? "at least 0" : nullptr;
}

}  // namespace

void read_words(const std::string& text, const std::function<Words()>& words) {
  const auto [option, allowed, _] = words();
  auto fail = [&, &of = option](const std::string& what) {
    throw SceneError(of, '"' + text + "\" " + what);
  };
  std::string names, some_names;
  for (const Word& w : allowed) {
    names.append(names.empty() ? "" : ", ").append(w.name);
    if (w.need == some)
      some_names.append(some_names.empty() ? "" : ", ").append(w.name);
  }
  std::map<std::string, Numbers> found;
  std::istringstream in(text);
  Numbers* numbers = nullptr;
  for (std::string next; in >> next;) {
    if (std::ranges::count(allowed, next, &Word::name)) {
      if (found.count(next)) fail("has " + next + " twice");
      numbers = &found[next];
      continue;
    }
    char* end = nullptr;
    const double value = std::strtod(next.c_str(), &end);
    if (!numbers && allowed.size() == 1) numbers = &found[allowed[0].name];
    if (*end != '\0' || !std::isfinite(value) || !numbers)
      fail("has \"" + next + "\", expected " +
           (numbers ? "a number or one of " : "one of ") + names);
    numbers->push_back(value);
  }
  bool has_some = some_names.empty();
  for (const Word& w : allowed) {
    const auto it = found.find(w.name);
    if (auto* there = std::get_if<bool*>(&w.member))
      **there = it != found.end();
    auto* kind = std::get_if<SpringKind*>(&w.member);
    if (kind) **kind = it != found.end();
    if (it == found.end()) continue;
    const std::string name = std::string(" ") + w.name;
    const std::size_t n = it->second.size();
    if (kind && n > 0) (*kind)->K = 0;
    if (n != numbers_after(w) && !(kind && n == 0))
      fail("has " + std::to_string(n) + (n == 1 ? " number" : " numbers") +
           " after" + name + ", expected " + std::to_string(numbers_after(w)));
    for (double a : it->second)
      if (const char* expected = unmet(w, a))
        fail("has" + name + ' ' + short_text(a) + ", expected " + expected);
    each_number(w, [next = it->second.begin()](auto& a) mutable {
      a = std::remove_reference_t<decltype(a)>(*next++);
    });
    has_some = has_some || w.need == some;
  }
  const Words now = words();  // what is needed may depend on what was read
  for (const Word& w : now.all)
    if (w.need == word && !found.count(w.name))
      fail(std::string("has no ") + w.name);
  if (!has_some) fail("has none of " + some_names);
  if (now.wrong) fail(now.wrong);
}

namespace {
/** The words before a quantity, in the order of Measure::Over. */
constexpr std::array<const char*, 7> overs = {"",      "max",  "min",   "mean",
                                              "first", "last", "period"};
/** The name of @a q after one of them: the largest stretch is "max stretch". */
std::string over_time(const Quantity& q) {
  return q.name == std::string("max-stretch") ? "stretch" : q.name;
}
}  // namespace

Measure read_measure(const std::string& text) {
  std::istringstream in(text);
  Measure m;
  std::string first, name, words, names;
  in >> first;
  const auto over = std::ranges::find(overs, first);
  if (over != overs.end()) m.over = Measure::Over(over - overs.begin());
  if (m.over == Measure::at_end)
    name = first;
  else
    in >> name;
  std::vector<std::string> known;
  for (const Quantity& q : quantities) {
    known.push_back(m.over == Measure::at_end ? q.name : over_time(q));
    names += (names.empty() ? "" : ", ") + known.back();
  }
  const auto found = std::ranges::find(known, name);
  if (found == known.end())
    throw SceneError("measure", text,
                     "one of " + names +
                         ", or one after max, min, mean, first, last or "
                         "period" +
                         did_you_mean(name, known));
  m.quantity = Measure::Quantity(found - known.begin());
  std::getline(in, words);
  if (words_of(m).all.empty() && !words.empty())
    throw SceneError("measure", text, "nothing after " + name);
  read_words(words, [&m] { return words_of(m); });
  if (m.over != Measure::at_end &&
      (m.quantity == Measure::positions || m.quantity == Measure::tear_time))
    throw SceneError("measure", text, name + " alone");
  return m;
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
    throw SceneError("dt", text,
                     "a positive time [s] or auto[:sharp][:G] with G in (0, "
                     "1], the energy gain tolerated, as auto:0.02");
  return step;
}

namespace {
/** Other names in use: of the same method, or of one to take instead. */
constexpr struct {
  const char *name, *method;
  bool same;
} other_names[] = {{"explicit-euler", "forward-euler", true},
                   {"semi-implicit-euler", "symplectic-euler", true},
                   {"euler-cromer", "symplectic-euler", true},
                   {"velocity-verlet", "verlet", true},
                   {"stormer-verlet", "verlet", true},
                   {"leapfrog", "verlet", true},
                   {"runge-kutta", "rk4", true},
                   {"backward-euler", "implicit-euler", true},
                   {"euler", "symplectic-euler", false},
                   {"yoshida4", "pefrl", false},
                   {"forest-ruth", "pefrl", false},
                   {"heun", "rk4", false},
                   {"rk2", "rk4", false},
                   {"rk45", "rkn64", false},
                   {"dopri5", "rkn64", false},
                   {"midpoint", "implicit-midpoint", false},
                   {"newmark", "implicit-midpoint", false},
                   {"trapezoidal", "implicit-midpoint", false},
                   {"crank-nicolson", "implicit-midpoint", false},
                   {"bdf2", "tr-bdf2", false},
                   {"generalized-alpha", "tr-bdf2", false},
                   {"projective-dynamics", "implicit-euler", false},
                   {"fast-mass-spring", "implicit-euler", false},
                   {"pbd", "xpbd", false}};
}  // namespace

const MethodEntry* method_named(std::string_view name, std::string& hint) {
  if (const MethodEntry* method = find_method(name)) return method;
  std::string lower = CME212::lower_case(std::string(name));
  for (char& c : lower)
    if (c == '_' || c == ' ') c = '-';
  std::vector<std::string_view> names;
  for (const MethodEntry& m : methods) names.push_back(m.info.name);
  for (const auto& other : other_names) {
    if (name == other.name && other.same) return find_method(other.method);
    if (lower == other.name) lower = other.method;
    names.push_back(other.same ? other.name : other.method);
  }
  hint = did_you_mean(lower, names);
  return nullptr;
}
const MethodEntry* read_method(const std::string& text) {
  std::string hint;
  if (const MethodEntry* method = method_named(text, hint)) return method;
  throw SceneError("method", text, "a name of --list-methods" + hint);
}

// -------------------------------------------------------------------- Writing

namespace {

/** A word and its numbers; "" if it is not there. */
std::string text_of(const Word& w) {
  if (auto* there = std::get_if<bool*>(&w.member); there && !**there) return "";
  if (auto* kind = std::get_if<SpringKind*>(&w.member); kind && !**kind)
    return "";
  if (auto* a = std::get_if<std::optional<double>*>(&w.member); a && !**a)
    return "";
  std::string text = w.name;
  each_number(w, [&text](const auto& a) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, a).ptr;
    text.append(" ").append(digits, end);
  });
  return text;
}

}  // namespace

std::string written(const Words& words, const Words& usual) {
  std::string all, last;
  bool has_some = false;
  for (std::size_t k = 0; k < words.all.size(); ++k) {
    const Word& w = words.all[k];
    const std::string text = text_of(w);
    if (text.empty()) continue;
    if (w.need == some) last = ' ' + text;
    if (w.need != word && !std::holds_alternative<bool*>(w.member) &&
        !std::holds_alternative<SpringKind*>(w.member) &&
        text == text_of(usual.all[k]))
      continue;
    all += ' ' + text;
    has_some = has_some || w.need == some;
  }
  if (!has_some) all += last;
  return all.substr(all.empty() ? 0 : 1);
}

std::string name_of(const Measure& m) {
  const Quantity& q = quantities[m.quantity];
  Measure now = m, usual = m.quantity;
  usual.over = m.over;
  const std::string words = written(words_of(now), words_of(usual));
  return (m.over ? overs[m.over] + (' ' + over_time(q)) : q.name) +
         (words.empty() ? "" : ' ' + words);
}

std::string short_text(const Point& p) {
  return short_text(p.x) + ' ' + short_text(p.y) + ' ' + short_text(p.z);
}

std::string to_words(const TimeStep& s) {
  if (s.fixed()) return exact_text(s.dt);
  return std::string(s.rule == StepRule::sharp ? "auto:sharp" : "auto") +
         (s.gain == TimeStep().gain ? "" : ':' + exact_text(s.gain));
}

std::string to_words(const Gravity& gravity) {
  const Point& a = gravity.a;
  return gravity.is_down()
             ? exact_text(gravity.size())
             : exact_text(a.x) + ' ' + exact_text(a.y) + ' ' + exact_text(a.z);
}

Gravity read_gravity(Line& in) {
  const double x = in.number(gravity_expected);
  if (in.at_end()) return x;
  const double y = in.number(gravity_expected);
  return Gravity(Point(x, y, in.number(gravity_expected)));
}

}  // namespace lab
