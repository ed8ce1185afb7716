#include <cmath>
#include <utility>

#include "lab/advice/Grids.hpp"

namespace lab {

namespace {
/** 1, 1.5, 2, 3, 4, 6 ..., and down from 1. */
double power(int level) {
  const int two = int(std::floor(level / 2.));
  return std::pow(2, two) * (level - 2 * two == 1 ? 1.5 : 1);
}
}  // namespace

/** Grids of @a cells, or so many times a power of 2 or 1.5 times that, along
 * the shortest side, whose cells keep the shape that they have in the scene:
 * springs along oblong cells are another material. So another number of cells
 * near that may be taken. Even numbers are preferred: the answers of odd and
 * even ones may lie on different sides of the limit. Along the short side of no
 * sheet are more than @a most_ratio times the cells of another. */
void GridStudy::make_levels(double cells, double most_ratio) {
  constexpr double near = 1.25, odd = 0.02;
  levels_.clear();
  int level = 0;
  while (cells * power(level - 1) > 1.6) --level;
  std::vector<double> before(q_.scene.sheets.size(), 1);  // along short sides
  for (std::size_t nodes = 0; double(nodes) <= 4 * most_nodes_; ++level) {
    Sides sides;
    std::vector<double> now = before;
    bool keeps = true;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto& nodes_of_sides = q_.scene.sheets[k].nodes;
      const auto [u, v] = nodes_of_sides;
      const unsigned small = u == 1 || (v > 1 && v < u);
      const double n = nodes_of_sides[small] - 1.,
                   ratio = (nodes_of_sides[1 - small] - 1.) / n,  // 0: a rope
          wanted = std::min(n / shortest_, most_ratio) * cells * power(level);
      double best = infinite;
      std::array<double, 2> side = {1, 1};
      for (double a = std::max(before[k] + 1, std::ceil(wanted / near));
           a <= near * wanted; ++a) {
        const double b = std::round(ratio * a),
                     oblong = ratio > 0 ? std::abs(b / (ratio * a) - 1) : 0,
                     cost = oblong + odd * (std::fmod(a, 2) + std::fmod(b, 2) +
                                            std::abs(std::log(a / wanted)));
        if (cost >= best) continue;
        best = cost, now[k] = a;
        side[small] = a / n;
        if (ratio > 0) side[1 - small] = b / (ratio * n);
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

Sides GridStudy::sides_of(int level) const {
  if (q_.from_files()) return {};
  Sides s = levels_[std::size_t(std::max(0, level))];
  for (auto& sheet : s)
    for (double& side : sheet) side *= power(std::min(0, level));
  return s;
}

double GridStudy::factor(int level) const {
  if (q_.from_files()) return power(level);
  auto cells = [](const Model& m) {
    double all = 0;
    for (const Sheet& s : m.sheets)
      all += std::max(1., s.nodes[0] - 1.) * std::max(1., s.nodes[1] - 1.);
    return all;
  };
  const bool ropes = std::ranges::all_of(q_.scene.sheets, [](const Sheet& s) {
    return s.nodes[0] == 1 || s.nodes[1] == 1;
  });
  return std::pow(cells(on_level(level)) / cells(q_.scene), ropes ? 1 : 0.5);
}

std::vector<GridStudy::Grid> GridStudy::starts() const {
  if (q_.from_files()) return {{{}, Effect(grids().limit().size()), 0}};
  auto meets = [this](std::size_t k) {
    return accepts(error_of(grids()[k].trial));
  };
  std::vector<Grid> all;
  for (std::size_t k = 0; k < grids().size(); ++k) {
    std::size_t twice = k;
    while (twice + 1 < grids().size() &&
           grids()[twice].factor < 1.9 * grids()[k].factor)
      ++twice;
    if (meets(k) && meets(twice))
      all.push_back({sides_of(grids()[k].level),
                     Effect(grids()[k].trial.answer, grids().limit()),
                     grids()[k].work, grids()[k].level});
  }
  return all;
}

/** This grid with the error by its pilot, if that meets the tolerance and takes
 * less than @a most_work. */
std::optional<GridStudy::Grid> GridStudy::that_meets(const Sides& s,
                                                     double most_work) {
  double finest = 1e-9;
  for (const auto& sheet : s) finest = std::max({finest, sheet[0], sheet[1]});
  const Model m = pilot(on_grid(s), finest);
  const auto costs = costs_of(m);
  const double work = costs ? costs->of_run(m) : infinite;
  if (!(work < most_work) || !q_.pilots.affords(work, "coarser grids", 0.3))
    return {};
  const Trial t =
      q_.pilots.run(m, std::to_string(nodes_of(m)) + " nodes", work);
  if (!accepts(error_of(t))) return {};
  return Grid{s, Effect(t.answer, grids().limit()), work};
}

/** The finest level with two cells along the side u (0) or v (1) of each
 * sheet. */
int GridStudy::lowest(unsigned side) const {
  auto thin = [side](const Sheet& s) { return s.nodes[side] <= 3; };
  int level = 0;
  while (!std::ranges::all_of(on_level(level).sheets, thin)) --level;
  return level;
}

std::vector<GridStudy::Grid> GridStudy::frontier(const Grid& start) {
  std::vector<Grid> all = {start};
  if (q_.from_files()) return all;
  auto look_at = [&](const Sides& s) {
    if (const auto grid = that_meets(s, start.work)) all.push_back(*grid);
  };
  // Of other levels along u and v: fewer cells along one side, maybe more along
  // the other one; or between two levels, an odd number.
  for (int u = lowest(0); u <= grids().back().level; ++u)
    for (int v = lowest(1); v <= grids().back().level; ++v) {
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
  std::ranges::stable_sort(all, {}, &Grid::work);
  auto cheapest = all;
  cheapest.resize(std::min<std::size_t>(all.size(), 2));
  for (const Grid& grid : cheapest) thin(grid, all);
  return all;
}

/** Add to @a all grids like @a grid with fewer cells along one side of one
 * sheet more each time, as long as that meets the tolerance and is cheaper. */
void GridStudy::thin(Grid grid, std::vector<Grid>& all) {
  for (std::size_t k = 0; k < grid.sides.size(); ++k)
    for (unsigned along : {0, 1}) {
      const double whole = q_.scene.sheets[k].nodes[along] - 1.;
      double now = on_grid(grid.sides).sheets[k].nodes[along] - 1.;
      bool found = false;
      auto meets_with = [&](double cells) {
        Sides fewer = grid.sides;
        fewer[k][along] = cells / whole;
        const auto cheaper = that_meets(fewer, grid.work);
        if (cheaper) grid = *cheaper, now = cells, found = true;
        return cheaper.has_value();
      };
      // First a side on which nothing depends.
      if (now > 2 && !meets_with(2))
        while (now > 3 && meets_with(std::floor(0.85 * now))) {
        }
      if (found) all.push_back(grid);
    }
}

}  // namespace lab
