/** @file Requests.cpp
 * The table of requests: what a line of text asks of a scene. A new one is an
 * entry of Live::Table::Table(). */
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "lab/live/Line.hpp"
#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Words.hpp"

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
using Ends = std::array<unsigned, 2>;

// read(in, value): the next words as a value of a request.
void read(Line& in, unsigned& node) {
  node = in.number<unsigned>("the number of a node");
}
void read(Line& in, Point& p) {
  for (int k = 0; k < 3; ++k) p[k] = in.number("three coordinates [m]");
}
void read(Line& in, Ends& edge) { read(in, edge[0]), read(in, edge[1]); }
void read(Line& in, Ray& r) { read(in, r.near), read(in, r.far); }
void read(Line& in, Share& s) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  s.of_unit = in.number("a positive multiple of the stability limit", least);
}
void read(Line& in, const MethodEntry*& method) {
  std::string hint;
  const std::string_view name = in.word("a method");
  method = method_named(name, hint);
  if (!method) in.fail(mesh_detail::quoted(name) + " is not a method" + hint);
}
void read(Line& in, Live::Lane& lane) {
  Share share;
  read(in, lane.method), read(in, share);
  lane.share = share.of_unit;
}
template <typename T>
void read(Line& in, std::vector<T>& all) {
  while (!in.at_end()) read(in, all.emplace_back());
}
template <typename T>
void read(Line& in, AtMost<T>& all) {
  read(in, all.values);
  if (all.values.size() > Live::most_rivals)
    in.fail("names " + std::to_string(all.values.size()) +
            " methods, expected at most 3");
}

}  // namespace

/** The table of requests: what a line of text means that starts with a name. */
struct Live::Table {
  enum Kind {
    plain,
    override,  // see Live::overrides()
    expand,    // recorded as the requests that it makes
  };
  struct Request {
    std::string_view name;
    Kind kind;
    /** Read what follows the name; if the scene is not null, change it.
     * @pre null, or the line makes sense */
    std::function<void(Line&, Live*)> run;
    double& (*parameter)(Model&) = nullptr;  // that it sets, if it sets one
  };
  std::vector<Request> all;

  Table();
  /** The one that the next word of @a in names; null if @a in fails. */
  static const Request* find(Line& in) {
    return in.one_of("a request", get().all, &Request::name);
  }
  static const Table& get() {
    static const Table table;
    return table;
  }
  /** A request whose values are of the types that @a apply takes. */
  void on(std::string_view name, Kind kind, auto apply) {
    add(name, kind, std::function(apply));
  }
  template <typename... Values>
  void add(std::string_view name, Kind kind,
           const std::function<void(Live&, Values...)>& apply) {
    const auto run = [apply](Line& in, Live* live) {
      std::tuple<Values...> values;
      std::apply([&](auto&... v) { (read(in, v), ...); }, values);
      in.end();
      if (live) std::apply([&](auto&... v) { apply(*live, v...); }, values);
    };
    all.push_back({name, kind, run});
  }
  /** A request that sets a number of the model, which is @a least or more. */
  void sets(std::string_view name, const char* expected, double least,
            double& (*parameter)(Model&)) {
    const auto run = [=](Line& in, Live* live) {
      double a = in.number(expected, least);
      if (name == "gravity" && !in.at_end()) {  // as a vector
        const double x = a, y = in.number(expected);
        a = -in.number(expected);
        if (x != 0 || y != 0)
          in.fail("acts along z: expected 0 0 and a number");
      }
      in.end();
      if (!live) return;
      Model m = live->model();
      parameter(m) = a, live->change_forces(m);
    };
    all.push_back({name, override, run, parameter});
  }
};

Live::Table::Table() {
  // From now on by this method; the step stays.
  on("method", plain,
     [](Live& live, const MethodEntry* m) { live.set_method(*m); });
  // From now on by steps of this share of RunReadings::dt_unit.
  on("step", override, [](Live& live, Share share) {
    TimeStep step = live.scene().stepper().time_step();
    step.dt = share.of_unit * live.main_->dt_unit;
    step.rule = StepRule::fixed;
    live.set_step(live.main_->method, step);
  });
  // K [N/m], or the modulus of a scene that has one; rest lengths stay.
  sets("stiffness", "0 N/m or more", 0, [](Model& m) -> double& {
    return m.material.modulus ? *m.material.modulus : m.stiffness;
  });
  // c of each node [kg/s]; or by area [kg/(s m^2)], if the scene has that.
  sets("drag", "0 or more", 0, [](Model& m) -> double& {
    return m.material.drag ? *m.material.drag : m.damping;
  });
  // g, or 0 0 -g [m/s^2]
  sets("gravity", "a number", -no_limit,
       [](Model& m) -> double& { return m.gravity; });
  // Pull a node towards a point; move that point; let the node go.
  on("grab", plain, [](Live& live, unsigned node, Point target) {
    live.each_running([&](Scene& s) { s.grab(live.id_of(node), target); });
    live.main_->mark();
  });
  on("move", override, [](Live& live, Point target) {
    live.each_running([&](Scene& s) {
      if (s.hand()) s.move_hand(target);
    });
  });
  on("release", plain, [](Live& live) {
    live.each_running([](Scene& s) { s.release(); });
    live.main_->mark();
  });
  // Remove edges, each by its ends; or all that a stroke of rays crosses.
  on("cut", plain, [](Live& live, std::vector<Ends> edges) {
    for (Ends& e : edges) e = {live.id_of(e[0]), live.id_of(e[1])};
    live.each_running([&](Scene& s) { s.cut(edges); });
  });
  on("stroke", expand, [](Live& live, std::vector<Ray> rays) {
    std::string cut = "cut";
    for (const auto& [i, j] : crossed_edges(live.scene().cloth(), rays))
      cut += request_word(live.number_of(i)) + request_word(live.number_of(j));
    if (cut != "cut") live.apply(cut);
  });
  // Hold a node where it is, at rest; let it go, whatever pin holds it; or
  // whichever of both changes something.
  on("pin", plain, [](Live& live, unsigned node) {
    live.each_running([&](Scene& s) { s.pin(live.id_of(node)); });
  });
  on("unpin", plain, [](Live& live, unsigned node) {
    live.each_running([&](Scene& s) { s.unpin(live.id_of(node)); });
    live.main_->mark();
    live.fit_step();
    live.tune();
  });
  on("toggle", expand, [](Live& live, unsigned node) {
    const bool held = live.main_->scene->is_pinned(live.id_of(node));
    live.apply(request(held ? "unpin" : "pin", node));
  });
  // Run copies of the present state beside it, up to three, by other methods,
  // each with steps of a share of its RunReadings::dt_unit; without any, end
  // it.
  on("compare", plain,
     [](Live& live, AtMost<Lane> rivals) { live.compare(rivals.values); });
  // The same, with the steps by which each works as much as the main run.
  on("race", expand, [](Live& live, AtMost<const MethodEntry*> methods) {
    if (!live.main_->runs()) return;
    std::string compare = "compare";
    for (const Lane& lane : live.at_equal_work(methods.values))
      compare +=
          request_word(lane.method->info.name) + request_word(lane.share);
    live.apply(compare);
  });
}

void Live::make(const std::string& text) {
  Line in(text);
  const Table::Request& request = *Table::find(in);
  // A guard that looks now may find a failure that it would find later.
  if (request.kind != Table::expand)
    each_running([](Scene& scene) { scene.settle(); });
  request.run(in, this);
}

void Live::apply(const std::string& text) {
  if (const auto error = error_in(text); !error.empty())
    throw std::invalid_argument(error);
  make(text);
  Line in(text);
  if (Table::find(in)->kind != Table::expand)
    recording_ += std::to_string(calls_) + ' ' + text + '\n';
}

std::string Live::error_in(std::string_view request) {
  Line in(request);
  if (const auto* found = Table::find(in)) found->run(in, nullptr);
  return in.error();
}
bool Live::overrides(std::string_view request) {
  Line in(request);
  const auto* found = Table::find(in);
  return found && found->kind == Table::override;
}
std::vector<std::pair<std::string_view, double>> Live::parameters(Model m) {
  std::vector<std::pair<std::string_view, double>> all;
  for (const auto& r : Table::get().all)
    if (r.parameter) all.emplace_back(r.name, r.parameter(m));
  return all;
}

}  // namespace lab
