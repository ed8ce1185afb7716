#include <algorithm>
#include <cmath>
#include <utility>

#include "lab/advice/Grids.hpp"
#include "lab/stepping/Trial.hpp"

namespace lab {

namespace {

class SheetGrids : public GridStudy {
 public:
  explicit SheetGrids(Question& q)
      : GridStudy(q, {5, 3, 0, false, "grid", "a finer grid", "on finer grids",
                      "a grid of "}) {
    for (const Sheet& s : q.scene.sheets)
      for (unsigned n : s.nodes)
        if (n > 1) shortest_ = std::min(shortest_, n - 1.);
    make_levels(2);
    auto some = [this] { return std::min(3, int(levels_.size()) - 1); };
    if (choose_pilots(some())) return;
    make_levels(shortest_);  // a pin lies between the nodes of other grids
    choose_pilots(some());
  }

  Sides sides_of(int level) const override {
    Sides s = levels_[std::size_t(std::max(0, level))];
    for (auto& sheet : s)
      for (double& side : sheet) side *= power(std::min(0, level));
    return s;
  }
  double factor(int level) const override { return factor_of(on_level(level)); }

  bool may_go_on(bool found) const override {
    const double next = 3 * runs().back().work;
    return !found || (!is_certain() &&
                      double(nodes_of(on_level(level_))) <= most_nodes_ &&
                      next <= std::max(q_.rules.patience, 0.3 * q_.own_work) &&
                      next <= 0.5 * q_.pilots.left());
  }

  double factor_of(const Model& m) const override {
    bool ropes = true;
    auto count = [&ropes](const Model& m) {
      double all = 0;
      for (const Sheet& s : m.sheets) {
        const auto [u, v] = s.nodes;
        all += std::max(1., u - 1.) * std::max(1., v - 1.);
        ropes = ropes && (u == 1 || v == 1);
      }
      return all;
    };
    const double more = count(m) / count(q_.scene);
    return ropes ? more : std::sqrt(more);
  }

  std::vector<Grid> starts() const override {
    auto meets = [this](std::size_t k) {
      return accepts(error_of(grids()[k].trial));
    };
    std::vector<Grid> all;
    for (std::size_t k = 0; k < runs().size(); ++k) {
      std::size_t twice = k;
      while (twice + 1 < runs().size() &&
             grids()[twice].factor < 1.9 * grids()[k].factor)
        ++twice;
      if (meets(k) && meets(twice))
        all.push_back({sides_of(runs()[k].level),
                       Effect(grids()[k].trial.answer, grids().limit()),
                       runs()[k].level});
    }
    return all;
  }

  std::vector<Grid> frontier(const Grid& start) override;

 private:
  double shortest_ = infinite;  // cells along the shortest side of the scene
  std::vector<Sides> levels_;   // the coarsest first

  void make_levels(double cells);
  /** The finest level with two cells along the side u (0) or v (1) of each
   * sheet. */
  int lowest(unsigned side) const {
    auto thin = [side](const Sheet& s) { return s.nodes[side] <= 3; };
    int level = 0;
    while (!std::ranges::all_of(on_level(level).sheets, thin)) --level;
    return level;
  }
  /** Add to @a all grids like @a s, whose pilot takes @a work, with fewer cells
   * along one side of one sheet more each time, as long as that meets the
   * tolerance and is cheaper. */
  void thin(Sides s, double work, std::vector<Grid>& all);
  std::string finest() const override {
    return "on " + std::to_string(grids().back().nodes) + " nodes";
  }
};

/** Grids of @a cells, or so many times a power of 2 or 1.5 times that, along
 * the shortest side, whose cells keep the shape that they have in the scene:
 * springs along oblong cells are another material. So another number of cells
 * near that may be taken. Even numbers are preferred: the answers of odd and
 * even ones may lie on different sides of the limit. */
void SheetGrids::make_levels(double cells) {
  constexpr double near = 1.25, odd = 0.02;
  levels_.clear();
  int level = 0;
  while (cells * power(level - 1) > 1.6) --level;
  std::vector<double> before(q_.scene.sheets.size(),
                             1);  // along the short side
  for (std::size_t nodes = 0; double(nodes) <= 4 * most_nodes_; ++level) {
    Sides sides;
    std::vector<double> now = before;
    bool keeps = true;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const std::array<double, 2> n = {q_.scene.sheets[k].nodes[0] - 1.,
                                       q_.scene.sheets[k].nodes[1] - 1.};
      const bool rope = n[0] == 0 || n[1] == 0;
      const unsigned small = rope ? n[0] == 0 : n[1] < n[0];
      const double wanted = n[small] / shortest_ * cells * power(level);
      double best = infinite;
      std::array<double, 2> side = {1, 1};
      for (double a = std::max(before[k] + 1, std::ceil(wanted / near));
           a <= near * wanted; ++a) {
        const double b = std::round(n[1 - small] * a / n[small]),
                     oblong =
                         rope ? 0
                              : std::abs(b * n[small] / (n[1 - small] * a) - 1),
                     cost = oblong + odd * (std::fmod(a, 2) + std::fmod(b, 2) +
                                            std::abs(std::log(a / wanted)));
        if (cost >= best) continue;
        best = cost, now[k] = a;
        side[small] = a / n[small];
        if (!rope) side[1 - small] = b / n[1 - small];
      }
      // With 3 cells along both sides, only odd numbers are near.
      keeps = keeps && now[k] > before[k] && (now[k] != 3 || best < 2 * odd);
      sides.push_back(side);
    }
    if (!keeps) continue;
    before = now;
    levels_.push_back(sides);
    nodes = nodes_of(on_grid(sides));
  }
}

std::vector<GridStudy::Grid> SheetGrids::frontier(const Grid& start) {
  std::vector<std::pair<double, Grid>> all;
  double most = infinite, work = 0;
  auto look_at = [&](const Sides& s) {
    if (const auto grid = that_meets(s, most, work))
      all.push_back({work, *grid});
  };
  look_at(start.sides);
  most = work;
  // Of other levels along u and v: fewer cells along one side, maybe more along
  // the other one; or between two levels, an odd number.
  for (int u = lowest(0); u <= runs().back().level; ++u)
    for (int v = lowest(1); v <= runs().back().level; ++v) {
      Sides s = sides_of(u), along_v = sides_of(v);
      for (std::size_t k = 0; k < s.size(); ++k) s[k][1] = along_v[k][1];
      look_at(s);
    }
  if (start.level > 0) {
    Sides s = start.sides, coarser = sides_of(start.level - 1);
    for (std::size_t k = 0; k < s.size(); ++k)
      for (unsigned along : {0, 1}) (s[k][along] += coarser[k][along]) /= 2;
    look_at(s);
  }
  std::ranges::stable_sort(all, {}, &std::pair<double, Grid>::first);
  std::vector<Grid> found;
  for (const auto& [cost, grid] : all) found.push_back(grid);
  for (std::size_t k = 0; k < std::min<std::size_t>(all.size(), 2); ++k)
    thin(all[k].second.sides, all[k].first, found);
  return found;
}

void SheetGrids::thin(Sides s, double work, std::vector<Grid>& all) {
  double less = 0;
  for (std::size_t k = 0; k < s.size(); ++k)
    for (unsigned along : {0, 1}) {
      const double whole = q_.scene.sheets[k].nodes[along] - 1.;
      double now = on_grid(s).sheets[k].nodes[along] - 1.;
      std::optional<Grid> found;
      auto with = [&](double cells) {
        Sides fewer = s;
        fewer[k][along] = cells / whole;
        const auto grid = that_meets(fewer, work, less);
        if (grid) s = fewer, now = cells, work = less, found = grid;
        return grid.has_value();
      };
      // First a side on which nothing depends.
      if (now > 2 && !with(2))
        while (now > 3 && with(std::floor(0.85 * now))) {
        }
      if (found) all.push_back(*found);
    }
}

/** A mesh from files is never refined: its "grids" are runs by smaller steps.
 * Its own error is unknown. */
class MeshSteps : public GridStudy {
 public:
  explicit MeshSteps(Question& q)
      : GridStudy(q, {3, 1, 8, true, "step", "smaller steps",
                      "by smaller steps", "the mesh of "}) {
    choose_pilots(0);
    most_nodes_ = infinite;
    q.pilots.allow(kind().runs * q.own_work);
    pilot_.step = {.dt = step_of(pilot(q.scene, 1))};
  }

  bool may_go_on(bool found) const override { return !found && !is_certain(); }
  double factor_of(const Model& m) const override {
    return runs().empty() ? 1 : step_of(runs()[0].model) / step_of(m);
  }
  std::vector<Grid> starts() const override {
    return {{{}, Effect(grids().limit().size())}};
  }
  std::vector<Grid> frontier(const Grid& start) override { return {start}; }

 private:
  std::string finest() const override { return "by the smallest step"; }
};

}  // namespace

std::unique_ptr<GridStudy> study_grids(Question& q) {
  if (q.scene.sheets.empty()) return std::make_unique<MeshSteps>(q);
  return std::make_unique<SheetGrids>(q);
}

}  // namespace lab
