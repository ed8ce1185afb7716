#include "lab/live/Recording.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "CME212/Util.hpp"
#include "lab/live/Line.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/SceneFile.hpp"

namespace lab {

namespace {

/** Append line @a number to @a text, behind as many line ends as that takes. */
void put_line(std::string& text, std::size_t number, std::string_view line) {
  const auto lines = std::size_t(std::ranges::count(text, '\n'));
  text.append(number - 1 - lines, '\n').append(line);
}
std::string_view join(const std::vector<std::string_view>& words) {
  const char* const first = words.front().data();
  return {first,
          std::size_t(words.back().data() - first) + words.back().size()};
}
bool is_scene(const std::string& request) {
  return Line(request).word("") == "scene";
}

}  // namespace

std::string scene_request(const Model& m, std::uint64_t cloth) {
  std::string all = "scene " + std::to_string(cloth) +
                    request_word(m.step.tolerance) + ' ' +
                    in_quotes(is_utf8(m.name) ? m.name : "scene");
  std::istringstream in(to_scene_file(m));
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with('#')) all += "\n| " + line;
  return all;
}

SceneRequest read_scene(const std::string& request, const std::string& file,
                        std::size_t line) {
  SceneRequest scene;
  std::string name, text;  // text has line ends as file has, for messages
  double tolerance = 0;
  mesh_detail::for_each_line(request, [&](auto& words, std::size_t number) {
    Line in(join(words));
    in.word("");  // "scene", or a bar
    if (number > 1) return put_line(text, line + number - 1, in.rest());
    scene.cloth = in.number<std::uint64_t>("a checksum");
    tolerance = in.number("a tolerance, 0 m or more", 0.);
    if (in.at_end()) in.word("text");
    if (!in.error().empty()) throw InputError(file, line, in.error());
    std::string key;
    put_line(key, line, "name = " + std::string(in.rest()));
    each_key_value(key, file, [&](const KeyValue& found, std::size_t) {
      name = found.values.at(0);
    });
  });
  try {
    scene.model = read_model(file, name, text);
  } catch (const SceneFileError& e) {
    const std::string what = e.what(), whole = file + ": ";
    if (!what.starts_with(whole)) throw;
    throw InputError(file, line, what.substr(whole.size()));
  }
  scene.model.step.tolerance = tolerance;
  return scene;
}

Replay::Replay(const std::string& file) : file_(file) {
  const std::string text = mesh_detail::read_file(file, "a recording");
  if (text.substr(0, text.find_first_of("\r\n")) != recording_begin)
    throw InputError(file, 1,
                     std::string("expected \"") + recording_begin +
                         "\", the first line of a recording");
  const auto ended = [this] {
    return !requests_.empty() && requests_.back().request == "end";
  };
  const auto add = [&](auto& words, std::size_t number) {
    if (number == 1) return;
    const auto check = [&](const std::string& error) {
      if (!error.empty()) throw InputError(file, number, error);
    };
    if (ended()) check("comes after \"end\", expected no more lines");
    if (words[0] == "|") {
      if (requests_.empty() || !is_scene(requests_.back().request))
        check("begins with | but does not follow a scene, expected a request");
      Timed& scene = requests_.back();
      return put_line(scene.request, number - scene.line + 1, join(words));
    }
    Line in(join(words));
    const auto calls = in.number<long long>("a number of steps");
    const long long before = requests_.empty() ? 0 : requests_.back().calls;
    if (calls < before)
      in.fail(std::to_string(calls) + " comes after " + std::to_string(before) +
              ", expected " + std::to_string(before) + " or more");
    if (in.at_end()) in.word("a request");
    check(in.error());
    const std::string request(in.rest());
    if (requests_.empty() && (calls != 0 || !is_scene(request)))
      check("begins with " + mesh_detail::quoted(words[1]) +
            ", expected \"0 scene\"");
    if (request != "end") check(Live::error_in(request));
    requests_.push_back({calls, number, request});
  };
  const std::size_t last_line = mesh_detail::for_each_line(text, add);
  if (!ended())
    throw InputError(file, last_line,
                     "ends too early, expected a line \"N end\"");
  for (Timed& t : requests_)
    if (is_scene(t.request)) {  // from now on names of files are absolute
      const SceneRequest scene = read_scene(t.request, file, t.line);
      t.request = scene_request(scene.model, scene.cloth);
    }
  apply(requests_.front());
}

/** Throws InputError, with the line of a request that can't be met. */
void Replay::apply(const Timed& t) {
  try {
    if (live_) return live_->apply(t.request);
    SceneRequest scene = read_scene(t.request);
    live_ = std::make_unique<Live>(std::move(scene.model), scene.cloth);
  } catch (const SceneError& e) {
    throw InputError(file_, t.line, e.what());
  } catch (const std::invalid_argument& e) {
    throw InputError(file_, t.line, e.what());
  }
}

bool Replay::step() {
  for (; requests_[next_].calls <= live_->calls(); ++next_) {
    if (next_ == requests()) return false;
    apply(requests_[next_]);
  }
  if (live_->done())
    throw InputError(file_, requests_[next_].line,
                     "the scene ended after " +
                         CME212::count_of(std::size_t(live_->calls()), "step") +
                         ", expected no request later than that");
  live_->step();
  return true;
}

}  // namespace lab
