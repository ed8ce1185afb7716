#include "lab/live/Recording.hpp"

#include <cmath>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "lab/Interrupt.hpp"
#include "lab/Nearest.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Checkpoint.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/SceneFile.hpp"

namespace lab {

namespace {

constexpr const char* first_line = "mass_spring input 1";
constexpr const char* bar = "| ";  // before a line of a scene file

// -------------------------------------------------------------------- Writing

std::string words(const Point& p) {
  std::string all;
  for (double a : {p.x, p.y, p.z}) all += ' ' + CME212::exact_text(a);
  return all;
}
std::string word(double a) { return ' ' + CME212::exact_text(a); }
std::string word(unsigned a) { return ' ' + std::to_string(a); }

/** The model as lines of a scene file, without its comments. */
std::string scene_lines(const Model& m) {
  std::istringstream in(to_scene_file(m));
  std::string all;
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with('#')) all += bar + line + '\n';
  return all;
}

struct ToWords {
  std::uint64_t cloth;

  std::string operator()(const SetMethod& r) const {
    return std::string("method ") + r.method->info.name;
  }
  std::string operator()(const SetStepShare& r) const {
    return "step" + word(r.share);
  }
  std::string operator()(const SetStiffness& r) const {
    return "stiffness" + word(r.K);
  }
  std::string operator()(const SetDrag& r) const { return "drag" + word(r.c); }
  std::string operator()(const SetGravity& r) const {
    return "gravity" + word(r.g);
  }
  std::string operator()(const LoadScene& r) const {
    std::string text = "scene " + std::to_string(cloth) +
                       word(r.model.step.tolerance) + ' ' +
                       in_quotes(r.model.name) + '\n' + scene_lines(r.model);
    text.pop_back();
    return text;
  }
  std::string operator()(const BreakIt& r) const {
    return std::string("break ") + r.failure->name;
  }
  std::string operator()(const Restart&) const { return "restart"; }
  std::string operator()(const Grab& r) const {
    return "grab" + word(r.node) + words(r.target);
  }
  std::string operator()(const MoveGrab& r) const {
    return "move" + words(r.target);
  }
  std::string operator()(const Release&) const { return "release"; }
  std::string operator()(const Cut& r) const {
    std::string text = "cut";
    for (const auto& [i, j] : r.edges) text += word(i) + word(j);
    return text;
  }
  std::string operator()(const PinNode& r) const {
    return "pin" + word(r.node);
  }
  std::string operator()(const UnpinNode& r) const {
    return "unpin" + word(r.node);
  }
  std::string operator()(const Compare& r) const {
    return std::string("compare ") + r.method->info.name + word(r.share) +
           (r.at == Compare::At::equal_time ? " equal-time" : " equal-work");
  }
  std::string operator()(const StopComparing&) const { return "alone"; }
};

// -------------------------------------------------------------------- Reading

/** One line of a recording, word by word. */
class Line {
 public:
  Line(const std::string& file, std::size_t number,
       std::span<const std::string_view> words)
      : file_(file), number_(number), words_(words) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_, number_, what);
  }
  bool at_end() const { return words_.empty(); }
  std::string_view word(const char* expected) {
    if (at_end()) fail(std::string("ends too early, expected ") + expected);
    const std::string_view word = words_.front();
    words_ = words_.subspan(1);
    return word;
  }
  template <typename T>
  T number(const char* expected) {
    try {
      const T a = mesh_detail::parse_number<T>(word(expected), expected);
      if (std::isfinite(double(a))) return a;
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error& e) {
      fail(e.what());
    }
    fail(std::string("is not finite, expected ") + expected);
  }
  double at_least(double least, const char* expected) {
    const double a = number<double>(expected);
    if (!(a >= least)) fail(CME212::short_text(a) + " is not " + expected);
    return a;
  }
  double above_zero(const char* expected) {
    const double a = number<double>(expected);
    if (!(a > 0)) fail(CME212::short_text(a) + " is not " + expected);
    return a;
  }
  unsigned node() { return number<unsigned>("the id of a node"); }
  Point point() {
    constexpr const char* expected = "three coordinates [m]";
    const double x = number<double>(expected), y = number<double>(expected);
    return Point(x, y, number<double>(expected));
  }
  /** One of the names of @a all, by @a name_of(). */
  template <typename All, typename Name>
  auto* one_of(const char* expected, const All& all, Name name_of) {
    const std::string_view name = word(expected);
    std::vector<std::string_view> names;
    for (const auto& a : all) {
      if (name_of(a) == name) return &a;
      names.push_back(name_of(a));
    }
    fail(mesh_detail::quoted(name) + " is no " + expected +
         did_you_mean(name, names));
  }
  const MethodEntry* method() {
    return one_of("method", methods, [](const MethodEntry& m) {
      return std::string_view(m.info.name);
    });
  }
  /** All that is left of the line, as it stands there. */
  std::string rest() {
    if (at_end()) word("text");
    const std::string_view first = words_.front(), last = words_.back();
    words_ = {};
    return {first.data(), last.data() + last.size()};
  }

 private:
  const std::string& file_;
  std::size_t number_;
  std::span<const std::string_view> words_;
};

/** What a line asks for, but for that of a scene. */
Request read_request(Line& in, std::string_view what) {
  if (what == "method") return SetMethod{in.method()};
  if (what == "step") return SetStepShare{in.above_zero("a share above 0")};
  if (what == "stiffness") return SetStiffness{in.at_least(0, "0 N/m or more")};
  if (what == "drag") return SetDrag{in.at_least(0, "0 or more")};
  if (what == "gravity") return SetGravity{in.number<double>("a number")};
  if (what == "break")
    return BreakIt{in.one_of("failure", breakages(), [](const Breakage& b) {
      return std::string_view(b.name);
    })};
  if (what == "restart") return Restart{};
  if (what == "grab") {
    const unsigned node = in.node();
    return Grab{node, in.point()};
  }
  if (what == "move") return MoveGrab{in.point()};
  if (what == "release") return Release{};
  if (what == "cut") {
    Cut cut;
    while (!in.at_end()) {
      const unsigned i = in.node();
      cut.edges.push_back({i, in.node()});
    }
    return cut;
  }
  if (what == "pin") return PinNode{in.node()};
  if (what == "unpin") return UnpinNode{in.node()};
  if (what == "compare") {
    const MethodEntry* method = in.method();
    const double share = in.above_zero("a share above 0");
    constexpr std::array<std::string_view, 2> at = {"equal-time", "equal-work"};
    const auto* found = in.one_of("equal-time or equal-work", at,
                                  [](auto name) { return name; });
    return Compare{method, share, Compare::At(found - at.data())};
  }
  if (what == "alone") return StopComparing{};
  constexpr std::array known = {
      "method", "step",    "stiffness", "drag",  "gravity", "scene",
      "break",  "restart", "grab",      "move",  "release", "cut",
      "pin",    "unpin",   "compare",   "alone", "end"};
  in.fail(mesh_detail::quoted(what) + " is no request" +
          did_you_mean(what, known));
}

}  // namespace

std::string begin_recording() { return std::string(first_line) + '\n'; }
std::string recorded(const Recorded& r) {
  return std::to_string(r.calls) + ' ' +
         std::visit(ToWords{r.cloth}, r.request) + '\n';
}
std::string end_recording(long long calls) {
  return std::to_string(calls) + " end\n";
}

void write_recording(const Live& live, const std::string& file) {
  CME212::OutputFile out(file);
  out.stream() << live.recording();
  out.commit();
}

Recording read_recording(const std::string& file) {
  const std::string text =
      mesh_detail::read_file(file, "a recording", end_if_interrupted);
  if (text.substr(0, text.find_first_of("\r\n")) != first_line)
    throw InputError(file, 1,
                     std::string("expected \"") + first_line +
                         "\", the first line of a recording");
  Recording all = {.file = file, .requests = {}};
  struct {
    std::string name, text;
    std::size_t lines = 0;  // of text
    double tolerance = 0;
    bool open = false;
  } scene;
  bool ended = false;
  // With as many lines before it as in this file, so that errors name its own.
  const auto close_scene = [&] {
    if (!std::exchange(scene.open, false)) return;
    try {
      Model m = read_model(file, scene.name, scene.text);
      m.step.tolerance = scene.tolerance;
      all.requests.back().request = LoadScene{std::move(m)};
    } catch (const SceneFileError& e) {
      const std::string_view what = e.what();
      const std::string whole = file + ": ";
      if (!what.starts_with(whole)) throw;
      throw InputError(file, all.requests.back().line,
                       std::string(what.substr(whole.size())));
    }
  };
  all.last_line =
      mesh_detail::for_each_line(text, [&](auto& words, std::size_t number) {
        Line in(file, number, words);
        if (number == 1) return;
        if (ended) in.fail("goes on behind the end, expected nothing");
        if (words[0] == "|") {
          if (!scene.open) in.fail("is no part of a scene, expected a request");
          in.word("|");
          for (; scene.lines < number - 1; ++scene.lines) scene.text += '\n';
          if (!in.at_end()) scene.text += in.rest();
          return;
        }
        close_scene();
        const auto calls = in.number<long long>("a number of steps");
        if (calls < all.calls)
          in.fail(std::to_string(calls) + " comes after " +
                  std::to_string(all.calls) + ", expected no smaller number");
        all.calls = calls;
        const std::string_view what = in.word("a request");
        if (all.requests.empty() && (what != "scene" || calls != 0))
          in.fail("begins with " + mesh_detail::quoted(what) +
                  ", expected 0 scene");
        if (what == "end") {
          ended = true;
        } else if (what == "scene") {
          all.requests.push_back({.calls = calls, .request = Restart{}});
          all.requests.back().cloth = in.number<std::uint64_t>("a checksum");
          scene.tolerance = in.at_least(0, "a tolerance, 0 m or more");
          each_key_value(std::string(number - 1, '\n') + "name = " + in.rest(),
                         file, [&](const KeyValue& found, std::size_t) {
                           scene.name = found.values.at(0);
                         });
          scene.text.clear(), scene.lines = 0, scene.open = true;
        } else {
          all.requests.push_back(
              {.calls = calls, .request = read_request(in, what)});
        }
        if (!all.requests.empty() && !ended) all.requests.back().line = number;
        if (!in.at_end())
          in.fail("goes on with " + mesh_detail::quoted(in.word("")) +
                  ", expected the end of the line");
      });
  if (!ended)
    throw InputError(file, all.last_line,
                     "ends too early, expected a line \"N end\"");
  return all;
}

Replay::Replay(const std::string& file) : recording_(read_recording(file)) {
  make(recording_.requests.at(0));
}

/** Make the request, or say in which line it is that can't be made. */
void Replay::make(const Recorded& r) {
  const auto* scene = std::get_if<LoadScene>(&r.request);
  try {
    if (live_)
      live_->apply(r.request);
    else
      live_ = std::make_unique<Live>(scene->model);
  } catch (const SceneError& e) {
    throw InputError(recording_.file, r.line, e.what());
  } catch (const std::invalid_argument& e) {
    throw InputError(recording_.file, r.line, e.what());
  }
  if (scene && r.cloth != 0 && checksum_of(live_->scene().cloth()) != r.cloth)
    throw InputError(recording_.file, r.line,
                     "is of another cloth: its files, or how the program makes "
                     "it, have changed");
}

bool Replay::step() {
  const auto& requests = recording_.requests;
  for (; next_ < requests.size() && requests[next_].calls <= live_->calls();
       ++next_)
    make(requests[next_]);
  if (live_->calls() == recording_.calls) return false;
  if (live_->done())
    throw InputError(
        recording_.file,
        next_ < requests.size() ? requests[next_].line : recording_.last_line,
        "the scene ended after " + std::to_string(live_->calls()) +
            " steps, expected no request later than that");
  live_->step();
  return true;
}

}  // namespace lab
