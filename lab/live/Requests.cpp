/** @file Requests.cpp
 * The table of requests: what a line of text asks of a live scene. A new one is
 * an entry of make_requests(); of a scene alone, of scene_requests(). */
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stepping/Changes.hpp"

namespace lab {

namespace {

struct Share {
  double of_unit;
};
/** Live::most_rivals of them. */
template <typename T>
struct AtMost {
  std::vector<T> values;
};

void read(Line& in, Share& s) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  s.of_unit = in.number("a positive multiple of the stability limit", least);
}
template <typename T>
void read(Line& in, AtMost<T>& all) {
  read(in, all.values);
  if (all.values.size() > Live::most_rivals)
    in.fail("names " + std::to_string(all.values.size()) +
            " methods, expected at most 3");
}

}  // namespace

static void read(Line& in, Live::Lane& lane) {
  Share share;
  read(in, lane.method), read(in, share);
  lane.share = share.of_unit;
}

const Requests<Live>& Live::requests() {
  static const Requests<Live> table = make_requests();
  return table;
}

Requests<Live> Live::make_requests() {
  Requests<Live> table;
  constexpr auto plain = Requests<Live>::plain,
                 override = Requests<Live>::override,
                 expand = Requests<Live>::expand;
  // A request of a scene is made to all; but "method" comes next.
  for (const auto& r : scene_requests().all) {
    const auto run = [&r](Line& in, Live* live) {
      if (!live) return r.run(in, nullptr);
      const auto ask = [&](Scene& s) {
        Line words = in;
        r.run(words, &s);
      };
      if (r.parameter)
        for (Side* side : live->sides()) ask(*side->scene);
      else
        live->each_running(ask);
      live->fit_steps();
    };
    if (r.name != "method")
      table.all.push_back(
          {r.name, Requests<Live>::Kind(r.kind), run, r.parameter});
  }
  // From now on by this method; the step stays.
  table.on("method", plain, [](Live& live, const MethodEntry* m) {
    live.scene().take_method(*m);
    live.main_->mark();
    live.tune();
  });
  // From now on by steps of this share of RunReadings::dt_unit.
  table.on("step", override, [](Live& live, Share share) {
    TimeStep step = live.scene().stepper().time_step();
    step.dt = share.of_unit * live.main_->dt_unit;
    step.rule = StepRule::fixed;
    live.set_step(live.main_->method(), step);
  });
  // Pull a node towards a point; move that point; let the node go.
  table.on("grab", plain, [](Live& live, unsigned node, Point target) {
    live.each_running(
        [&](Scene& s) { s.grab(live.scene().id_of(node), target); });
    live.main_->mark();
  });
  table.on("move", override, [](Live& live, Point target) {
    live.each_running([&](Scene& s) {
      if (s.hand()) s.move_hand(target);
    });
  });
  table.on("release", plain, [](Live& live) {
    live.each_running([](Scene& s) { s.release(); });
    live.main_->mark();
  });
  // Remove the edges that a stroke of rays crosses.
  table.on("stroke", expand, [](Live& live, std::vector<Ray> rays) {
    std::string cut = "cut";
    for (const auto& [i, j] : crossed_edges(live.scene().cloth(), rays))
      cut += request_word(live.number_of(i)) + request_word(live.number_of(j));
    if (cut != "cut") live.apply(cut);
  });
  // Hold a node where it is, or let it go.
  table.on("toggle", expand, [](Live& live, unsigned node) {
    const bool held = live.main_->scene->is_pinned(live.scene().id_of(node));
    live.apply(request(held ? "unpin" : "pin", node));
  });
  // Run copies of the present state beside it, up to three, by other methods,
  // each with steps of a share of its RunReadings::dt_unit; without any, end
  // it.
  table.on("compare", plain, [](Live& live, AtMost<Lane> rivals) {
    live.compare(rivals.values);
  });
  // The same, with the steps by which each works as much as the main run.
  table.on("race", expand, [](Live& live, AtMost<const MethodEntry*> methods) {
    if (!live.main_->runs()) return;
    std::string compare = "compare";
    for (const Lane& lane : live.at_equal_work(methods.values))
      compare +=
          request_word(lane.method->info.name) + request_word(lane.share);
    live.apply(compare);
  });
  return table;
}

void Live::apply(const std::string& text) {
  if (const auto error = error_in(text); !error.empty())
    throw std::invalid_argument(error);
  Line in(text);
  const auto& request = *requests().find(in);
  if (request.kind != Requests<Live>::expand) {
    // A guard that looks now may find a failure that it would find later.
    each_running([](Scene& scene) { scene.stepper().settle(); });
    recording_ += std::to_string(calls_) + ' ' + text + '\n';
  }
  request.run(in, this);
}

std::string Live::error_in(std::string_view request) {
  return requests().error_in(request);
}
bool Live::overrides(std::string_view request) {
  Line in(request);
  const auto* found = requests().find(in);
  return found && found->kind == Requests<Live>::override;
}
std::vector<std::pair<std::string_view, double>> Live::parameters(Model m) {
  std::vector<std::pair<std::string_view, double>> all;
  for (const auto& r : requests().all)
    if (r.parameter) all.emplace_back(r.name, r.parameter(m));
  return all;
}

}  // namespace lab
