#include <algorithm>
#include <cmath>
#include <utility>

#include "lab/advice/Grids.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

/** The coarsest level with two cells or less along the shortest side. */
int first_level(const Model& m) {
  double shortest = infinite;
  for (const Sheet& s : m.sheets)
    for (unsigned n : s.nodes) shortest = std::min(shortest, n - 1.);
  int level = 0;
  while (shortest * GridStudy::factor(level) > 2) --level;
  return level;
}

class SheetGrids : public GridStudy {
 public:
  explicit SheetGrids(Question& q)
      : GridStudy(q,
                  {5, 3, 0, false, "grid", "a finer grid", "on finer grids",
                   "a grid of "},
                  first_level(q.scene), first_level(q.scene) + 4) {}

  bool may_go_on(bool found) const override {
    const double next = 3 * runs().back().work;
    return !found || (!is_certain() &&
                      double(nodes_of(on_level(level_))) <= most_nodes_ &&
                      next <= std::max(q_.rules.patience, 0.3 * q_.own_work) &&
                      next <= 0.5 * q_.pilots.left());
  }

  double factor_of(const Model& m) const override {
    auto count = [](const Model& m) {
      double all = 0;
      for (const Sheet& s : m.sheets)
        all += double(s.nodes[0] - 1) * (s.nodes[1] - 1);
      return all;
    };
    return std::sqrt(count(m) / count(q_.scene));
  }

  std::vector<int> starts() const override {
    auto meets = [this](std::size_t k) {
      return accepts(error_of(grids()[k].trial));
    };
    std::vector<int> all;
    for (std::size_t k = 0; k < runs().size(); ++k) {
      const auto twice =
          std::ranges::find(runs(), runs()[k].level + 2, &Run::level);
      if (meets(k) &&
          (twice == runs().end() || meets(std::size_t(twice - runs().begin()))))
        all.push_back(runs()[k].level);
    }
    return all;
  }

  std::vector<Sides> frontier(int start) override;

 private:
  /** The cells of the largest sheet along u (0) or v (1). */
  double cells(double factor, unsigned side) const {
    double most = 2;
    for (const Sheet& s : q_.scene.sheets)
      most = std::max(most, std::round((s.nodes[side] - 1) * factor));
    return most;
  }
  /** True if the pilot on this grid meets the tolerance. */
  bool suffices(const Sides& s, double most_work, double& work) {
    return accepts(error_on(s, most_work, work));
  }
  /** @a s, whose pilot takes @a work, with fewer cells along one side of one
   * sheet more each time, as long as that meets the tolerance and is cheaper.
   */
  std::vector<Sides> thinned(Sides s, double work);
  std::string finest() const override {
    return "on " + std::to_string(grids().back().nodes) + " nodes";
  }
};

std::vector<Sides> SheetGrids::frontier(int start) {
  std::vector<std::pair<double, Sides>> all;
  double most = infinite;
  auto meets = [&](const Sides& s, double& work) {
    const bool ok = suffices(s, most, work);
    if (ok) all.push_back({work, s}), most = work;
    return ok;
  };
  double work = 0;
  meets(all_sides(factor(start), factor(start)), work);
  // Fewer cells along one side; more along the other one only if that is
  // needed and still cheaper.
  const int last = runs().back().level;
  for (unsigned side : {0, 1})
    for (int level = start - 1, other = start;
         other <= last && cells(factor(level + 1), side) > 2; --level) {
      if (cells(factor(level), side) == cells(factor(level + 1), side))
        continue;
      for (bool ok = false; !ok && other <= last;) {
        const double a = factor(level), b = factor(other);
        ok = meets(side == 0 ? all_sides(a, b) : all_sides(b, a), work);
        if (!ok && !(work < most)) other = last;
        if (!ok) ++other;
      }
    }
  std::ranges::stable_sort(all, {}, &std::pair<double, Sides>::first);
  std::vector<Sides> best;
  for (const auto& [cost, s] : all)
    if (best.size() < 3 && cost <= 1.6 * all[0].first) best.push_back(s);
  if (!best.empty()) {
    const auto thin = thinned(best[0], most);
    best.insert(best.begin(), thin.rbegin(), thin.rend());
  }
  return best;
}

std::vector<Sides> SheetGrids::thinned(Sides s, double work) {
  std::vector<Sides> found;
  double less = 0;
  for (std::size_t k = 0; k < s.size(); ++k)
    for (unsigned along : {0, 1}) {
      const Sides before = s;
      const double all = q_.scene.sheets[k].nodes[along] - 1.;
      double now = on_grid(s).sheets[k].nodes[along] - 1.;
      auto with = [&](double cells) {
        Sides fewer = s;
        fewer[k][along] = cells / all;
        if (!suffices(fewer, work, less)) return false;
        s = fewer, now = cells, work = less;
        return true;
      };
      // First a side on which nothing depends.
      if (now > 2 && !with(2))
        while (now > 3 && with(std::floor(0.85 * now))) {
        }
      if (s != before) found.push_back(s);
    }
  return found;
}

/** A mesh from files is never refined: its "grids" are runs by smaller steps.
 * Its own error is unknown. */
class MeshSteps : public GridStudy {
 public:
  explicit MeshSteps(Question& q)
      : GridStudy(q,
                  {3, 1, 8, true, "step", "smaller steps", "by smaller steps",
                   "the mesh of "},
                  0, 0) {
    most_nodes_ = infinite;
    q.pilots.allow(kind().runs * q.own_work);
    pilot_.step = {.dt = step_of(pilot(q.scene, 1))};
  }

  bool may_go_on(bool found) const override { return !found && !is_certain(); }
  double factor_of(const Model& m) const override {
    return runs().empty() ? 1 : step_of(runs()[0].model) / step_of(m);
  }
  std::vector<int> starts() const override { return {0}; }
  std::vector<Sides> frontier(int) override { return {{}}; }

 private:
  std::string finest() const override { return "by the smallest step"; }
};

}  // namespace

std::unique_ptr<GridStudy> study_grids(Question& q) {
  if (q.scene.sheets.empty()) return std::make_unique<MeshSteps>(q);
  return std::make_unique<SheetGrids>(q);
}

}  // namespace lab
