/** @file adviser_suite.cpp
 * How often --advise is right: random scenes, each with its advice, the true
 * error of the advised run, and the best choice in hindsight.
 *
 *   build/adviser_suite --scenes 100 --out lab/advice/results/adviser.csv
 *   build/adviser_suite --scenes 40 --price --out lab/advice/results/price.csv
 *
 * The reference is the limit of grids of 1, 2 and 4 times as many cells as the
 * advised one, or as 40 if it has fewer, by srkn6b. Cost is counted in spring
 * evaluations. With --price the scenes are refined until a run takes more than
 * two seconds, and the time of the advice, with the default budget of ./cloth,
 * is compared with that of the run. Exit status: 0 done; 1 less is right than
 * was wanted; 2 bad option, or an output that can't be written. */
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <string>

#include <CLI/CLI.hpp>

#include "CME212/OutputFile.hpp"
#include "lab/advice/Advise.hpp"
#include "lab/advice/Variation.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stability/StepLimit.hpp"

using namespace lab;

namespace {

/** A random scene: the same on every machine for the same number. */
Model random_scene(unsigned number) {
  std::mt19937 random(number);
  auto pick = [&](int n) { return int(random() % unsigned(n)); };
  auto between = [&](double low, double high) {
    return low + (high - low) * (random() / 4294967296.0);
  };
  auto log_between = [&](double low, double high) {
    return low * std::pow(high / low, random() / 4294967296.0);
  };
  auto text = [](double a) { return CME212::two_digits(a); };
  Model m;
  const int hangs = pick(4);  // how it is held
  const double width = between(0.5, 2), height = between(0.5, 2);
  const std::string nodes = " nodes 11 11";
  if (hangs < 2)
    m.sheets = {
        read_sheet("u " + text(width) + " 0 0 v 0 0 -" + text(height) + nodes)};
  else
    m.sheets = {read_sheet("u " + text(width) + " 0 0 v 0 " + text(height) +
                           " 0" + nodes)};
  auto pin = [&m](const std::string& words) {
    m.pins.push_back(read_pin(words));
  };
  pin(hangs == 0 ? "z 0" : "x 0");
  if (hangs == 1 || hangs == 2) pin("x " + text(width));
  if (hangs == 2) pin("y 0"), pin("y " + text(height));
  m.edges.diagonals = pick(2);
  m.material.density = log_between(0.2, 2);
  m.material.modulus = log_between(1, 1e4);  // four decades
  if (pick(2)) m.material.drag = *m.material.density * log_between(0.1, 10);
  // Time for waves to cross the cloth up to four times.
  const double wave = std::sqrt(*m.material.density / *m.material.modulus) *
                      std::max(width, height);
  m.t_end = std::min(wave * between(0.5, 4), 1.0);
  if (pick(4) == 0) m.planes = {read_plane("at 0 0 " + text(-height - 0.01))};
  // Further parts, each in one scene of eight.
  auto sometimes = [&] { return pick(8) == 0; };
  const bool lies = hangs >= 2;
  if (lies && sometimes())
    m.planes.push_back(read_plane("at 0 0 -0.05 normal 0.3 0 1 friction 0.4"));
  if (lies && sometimes())
    m.spheres = {read_sphere("at " + text(width / 2) + ' ' + text(height / 2) +
                             " -0.35 radius 0.3 friction 0.3")};
  if (lies && sometimes())
    m.spheres.push_back(read_sphere("at " + text(width / 2) + ' ' +
                                    text(height / 2) +
                                    " -0.4 radius 0.3 velocity 0 0 0.5"));
  if (sometimes()) pin("x 0 velocity -0.2 0 0.1 until 0.2");
  if (sometimes()) m.edges.bend = true;
  if (sometimes()) m.sheets[0].velocity = Point(0, 0.5, 0.3);
  if (sometimes()) m.tear_strain = between(0.05, 0.5);
  if (lies && sometimes())
    m.tears = {read_tear("at " + text(width / 2) + ' ' + text(height / 2) +
                         " -0.25 radius 0.2")};
  if (lies && sometimes())
    m.planes.push_back(read_plane("at 0 0 -0.2 velocity 0 0 0.4 until 0.3"));
  if (sometimes())
    m.regions = {read_region("from 0 " + text(-height) + ' ' + text(-height) +
                             " to " + text(0.21 * width) + ' ' + text(height) +
                             ' ' + text(height) + " stiffness-factor 100")};
  m = as_pilot(m);
  // Without drag the energy is conserved on any grid: no question.
  if (m.material.drag && pick(2)) m.measure = Measure::energy;
  m.tolerance = 1;
  // Tolerance: 0.5 % to 5 % of the way of the center of mass, or of the work of
  // gravity on that way.
  Model com = m, start = m;
  com.measure = start.measure = Measure::com;
  start.t_end = 0;
  const double way =
      distance(try_out(com).answer, try_out(start).answer, Measure::com);
  const double unit = m.measure == Measure::com
                          ? 1
                          : *m.material.density * width * height * grav;
  m.tolerance = way * unit * log_between(5e-3, 5e-2);
  return m;
}

/** The further parts of @a m, as words. */
std::string kinds_of(const Model& m) {
  std::string all;
  auto add = [&](bool is_there, const char* kind) {
    if (is_there) all += std::string(all.empty() ? "" : " ") + kind;
  };
  bool incline = false, friction = false, moving = false;
  for (const Wall& w : m.planes) {
    incline |= w.out().z < 0.99;
    friction |= w.friction > 0;
    moving |= w.motion != Motion();
  }
  for (const Solid& s : m.spheres) {
    friction |= s.friction > 0;
    moving |= s.motion != Motion();
  }
  add(incline, "incline");
  add(!m.spheres.empty(), "ball");
  add(friction, "friction");
  add(moving, "moving-obstacle");
  add(std::ranges::any_of(m.pins,
                          [](const Pin& p) { return p.motion != Motion(); }),
      "moving-pin");
  add(!m.tears.empty(), "tearing-ball");
  add(m.tear_strain.has_value(), "tearing");
  add(m.edges.bend, "bend");
  add(norm(m.sheets[0].velocity) > 0, "velocity");
  add(!m.regions.empty(), "stiff-part");
  return all;
}

/** The result of a scene. */
struct Row {
  std::string refusal;
  std::string method;
  double predicted = 0, uncertainty = 0, real = 0;  // errors
  double half = 0, finer = 0;  // errors by half the step; on twice the cells
  double chosen = 0, best = 0, fragile = 0;  // counted work
  double spent = 0;                          // [s], by the advice
  double seconds = 0;                        // of the advised run
};

double cells(const Model& m) { return m.sheets[0].nodes[0] - 1; }

/** The limit of the answer on finer grids than that of @a advised. */
Answer truth(const Model& scene, const Model& advised) {
  const double factor = std::max(40., cells(advised)) / cells(scene);
  Refinement grids(scene.measure);
  for (int finer : {1, 2, 4}) {
    Model m = refined(scene, factor * finer);
    m.method = find_method("srkn6b");
    m.step = {.rule = StepRule::safe};
    grids.add({factor * finer, 0, 0, try_out(m)});
  }
  return grids.limit();
}

/** The error of @a m; infinite if it fails. */
double error_of(const Model& m, const Answer& right) {
  const Trial t = try_out(m);
  return t.ok() ? distance(t.answer, right, m.measure)
                : std::numeric_limits<double>::infinity();
}

/** @a scene without each combination of the parts that, left out alone, change
 * the answer by less than the tolerance. Parts that change nothing are always
 * left out; of the others, the four that change least are considered. */
std::vector<Model> without_sets(const Model& scene) {
  const Answer all = try_out(scene).answer;
  std::vector<std::pair<double, std::string>> parts;
  for (const Variation& v : without_parts(scene))
    if (const Trial t = try_out(as_pilot(v.model)); t.ok())
      if (const double d = distance(t.answer, all, scene.measure);
          d <= scene.tolerance)
        parts.emplace_back(d, v.part);
  std::ranges::stable_sort(parts);
  std::vector<std::string> none, some;
  for (const auto& [change, part] : parts)
    (change == 0 ? none : some).push_back(part);
  some.resize(std::min<std::size_t>(some.size(), 4));
  std::vector<Model> sets;
  for (unsigned set = 0; set < 1u << some.size(); ++set) {
    std::vector<std::string> removed = none;
    for (unsigned k = 0; k < some.size(); ++k)
      if (set >> k & 1) removed.push_back(some[k]);
    if (const auto m = without_all(scene, removed)) sets.push_back(*m);
  }
  return sets;
}

/** The least work, at most @a chosen, of all combinations of parts, grid,
 * method and step that meet the tolerance. @a reliably: half of the step and
 * twice the cells must meet it, too. */
double best_in_hindsight(const Model& scene, const std::vector<Model>& ways,
                         const Answer& right, double chosen, bool reliably) {
  double best = chosen;
  auto meets = [&](const Model& m) {
    return error_of(m, right) <= scene.tolerance;
  };
  for (const Model& way : ways)
    for (double factor = 0.5;; factor *= std::sqrt(2.)) {
      Model m = as_pilot(refined(way, factor));
      const StepCosts costs(m);
      bool tried = false;
      for (auto [method, share] :
           {std::pair<const char*, double>{"verlet", 0.9},
            {"verlet", 0.64},
            {"verlet", 0.45},
            {"symplectic-euler", 0.9},
            {"symplectic-euler", 0.64},
            {"symplectic-euler", 0.45},
            {"pefrl", 1.3},
            {"srkn6b", 2.2},
            {"respa", 0.9},
            {"respa", 0.45},
            {"implicit-midpoint", 30},
            {"tr-bdf2", 30},
            {"tr-bdf2", 100},
            {"tr-bdf2", 400}}) {
        m.method = find_method(method);
        const bool multirate = m.method->info.multirate;
        m.step = {.dt =
                      share * (multirate ? costs.multirate() : costs.verlet())};
        if (multirate && m.step.dt < costs.verlet()) continue;  // it is Verlet
        const double work = costs.of_run(m);
        if (work >= best) continue;
        tried = true;
        Model smaller = m, finer = refined(way, 2 * factor);
        smaller.step.dt /= 2;
        finer.method = m.method;
        finer.step = {.dt = m.step.dt / 2};
        if (meets(m) && (!reliably || (meets(smaller) && meets(finer))))
          best = work;
      }
      if (!tried) break;  // finer grids take even more
    }
  return best;
}

Row look_at(const Model& scene) {
  Row row;
  AdviceRules rules;
  rules.most_nodes = 27000;  // so that the reference takes little time
  const Advice a = advise(scene, rules);
  row.refusal = a.refusal;
  row.spent = a.spent;
  if (!a.refusal.empty()) return row;
  const Trial t = try_out(a.model);
  const Answer right = truth(scene, a.model);
  row.method = a.model.method->info.name;
  row.predicted = a.error, row.uncertainty = a.uncertainty;
  row.real = error_of(a.model, right);
  Model again = a.model;
  again.step = {.dt = step_of(a.model) / 2};
  row.half = error_of(again, right);
  row.finer = error_of(refined(again, 2), right);
  row.chosen = a.work;
  row.seconds = t.seconds;
  const std::vector<Model> ways = without_sets(scene);
  row.best = best_in_hindsight(scene, ways, right, row.chosen, true);
  row.fragile = best_in_hindsight(scene, ways, right, row.best, false);
  return row;
}

/** @a scene refined until a run takes at least @a work. */
Model long_run(Model scene, double work) {
  const Model first = scene;
  for (double finer = 2; work_of_run(scene) < work; finer *= std::sqrt(2.))
    scene = refined(first, finer);
  return scene;
}

/** The cost of advice where a run takes more than two seconds. */
int look_at_prices(unsigned first, unsigned scenes, std::ostream& csv) {
  constexpr double two_seconds = 2;
  csv << "scene,nodes,run work,run [s],advice work,advice [s],refusal\n";
  std::vector<double> shares;
  for (unsigned k = first; k < first + scenes; ++k) {
    const Model start = random_scene(k);
    const double rate = measured_rate(start);
    Model m = long_run(start, 1.5 * two_seconds * rate);
    const CME212::Clock clock;
    const Trial t = try_out(m);
    const double run = clock.seconds();
    const Advice a = advise(m, rules_of(m, 0));
    if (!t.ok() || run < two_seconds) continue;
    csv << k << ',' << mesh_of(m).points.size() << ',' << work_of_run(m) << ','
        << run << ',' << a.spent_work << ',' << a.spent << ",\"" << a.refusal
        << "\"\n";
    shares.push_back(a.spent / run);
  }
  std::ranges::sort(shares);
  if (shares.empty()) return 1;
  const double median = shares[shares.size() / 2];
  std::cout << shares.size() << " runs of more than 2 s: advice takes "
            << CME212::two_digits(median) << " of their time in the median, "
            << CME212::two_digits(shares.back()) << " at most\n";
  return median > 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How often --advise is right, on random scenes.",
               "adviser_suite");
  unsigned scenes = 100, first = 1;
  double want_met = 0, want_cheap = 0;
  std::string out;
  bool price = false;
  app.add_flag("--price", price,
               "measure the cost of advice where a run takes long");
  app.add_option("--scenes", scenes, "how many")->capture_default_str();
  app.add_option("--first", first, "number of the first one")
      ->capture_default_str();
  app.add_option("--want-met", want_met,
                 "percent of the advice that has to meet the tolerance")
      ->check(CLI::Range(0, 100));
  app.add_option("--want-cheap", want_cheap,
                 "percent that may cost 1.5 times the best choice at most")
      ->check(CLI::Range(0, 100));
  app.add_option("--out", out, "write the table to this file")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    Sweep::set_threads(1);
    CME212::OutputFile file(out);
    if (price) {
      const int status = look_at_prices(first, scenes, file.stream());
      file.commit();
      return status;
    }
    file.stream() << "scene,measure,tolerance,method,predicted,doubt,real,work,"
                     "best work,"
                     "lucky work,advice [s],run [s],half step,twice the "
                     "cells,kinds,refusal\n";
    unsigned advised = 0, met = 0, robust = 0, within = 0, cheap = 0;
    for (unsigned k = first; k < first + scenes; ++k) {
      const Model m = random_scene(k);
      const Row r = look_at(m);
      file.stream() << k << ',' << name_of(m.measure) << ',' << m.tolerance
                    << ',' << r.method << ',' << r.predicted << ','
                    << r.uncertainty << ',' << r.real << ',' << r.chosen << ','
                    << r.best << ',' << r.fragile << ',' << r.spent << ','
                    << r.seconds << ',' << r.half << ',' << r.finer << ','
                    << kinds_of(m) << ",\"" << r.refusal << "\"\n";
      if (!r.refusal.empty()) continue;
      ++advised;
      met += r.real <= m.tolerance;
      robust += std::max({r.real, r.half, r.finer}) <= m.tolerance;
      within += std::abs(r.real - r.predicted) <= r.uncertainty;
      cheap += r.chosen <= 1.5 * r.best;
    }
    file.commit();
    std::cout << scenes << " scenes, " << advised << " with advice: " << met
              << " meet the tolerance, " << robust
              << " also by half the step and on twice the cells; the real "
                 "error of "
              << within << " is within the uncertainty, " << cheap
              << " cost at most 1.5 times the best choice in hindsight\n";
    return met * 100 < want_met * advised || cheap * 100 < want_cheap * advised;
  } catch (const std::exception& e) {
    std::cerr << "adviser_suite: " << e.what() << '\n';
    return 2;
  }
}
