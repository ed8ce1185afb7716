#include "lab/methods/LaplacianFactor.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/ImplicitStage.hpp"

namespace lab {

/** True if key_ is still right: compares arrays, without asking the forces.
 * @post held_ are the held nodes */
bool LaplacianFactor::unchanged(const Cloth& g, Scales scales,
                                const ForcePlan& force,
                                const ConstraintPlan& constraint) {
  held_.clear();
  constraint.each_held(g, [this](Node n) { held_.push_back(n.id()); });
  if (scales != key_.scales || !source_.springs ||
      force.spring_multiplicity() != source_.springs || &g != source_.cloth ||
      arrays(g).version() != source_.version || held_ != source_.held)
    return false;
  const Drag& c = force.drag();
  auto node = arrays(g).node_values();
  auto spring = arrays(g).edge_values();
  bool same = true;
  for (unsigned i = 0; i < node.size(); ++i)
    same &= node[i].mass + scales.drag * c[i] == key_.diagonal[i];
  for (unsigned e = 0; e < spring.size(); ++e)
    same &= spring[e].K == source_.K[e];
  return same;
}

void LaplacianFactor::find(std::string_view method, const Cloth& g,
                           Scales scales, const ForcePlan& force,
                           const ConstraintPlan& constraint) {
  if (unchanged(g, scales, force, constraint)) return;
  source_ = {force.spring_multiplicity(), &g, arrays(g).version(), held_, {}};
  for (const EdgeData& spring : arrays(g).edge_values())
    source_.K.push_back(spring.K);
  next_.scales = scales;
  implicit_detail::find_fixed(g, constraint, next_.fixed);
  next_.diagonal.clear();
  const Drag& c = force.drag();
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i)
    next_.diagonal.push_back(arrays(g).node_values()[i].mass +
                             scales.drag * c[i]);
  next_.springs.clear();
  implicit_detail::add_stiffness(
      method, force, g, [this](unsigned i, unsigned j, const Stiffness& B) {
        double K = std::max({0.0, B.along, B.across});
        if (K > 0) next_.springs.push_back({i, j, K});
      });
  if (next_ == key_) return;
  std::swap(key_, next_);
  if (factorize()) return;
  key_ = {}, source_ = {};
  throw StepError(std::string(method) +
                  ": the matrix of masses and springs can't be factored; "
                  "shorter steps may help");
}

/** Factor the matrix of key_. Its rows are node ids, so fixed nodes have rows,
 * too: those of the unit matrix.  @return false if it can't be factored */
bool LaplacianFactor::factorize() {
  ++factorizations_;
  constexpr std::size_t most = 100'000'000;  // entries, of 24 bytes
  const double b = key_.scales.springs;
  const auto& fixed = key_.fixed;
  const auto rows = unsigned(fixed.size());
  std::vector<SparseCholesky<double>::Pair> pairs;
  for (const auto& [i, j, K] : key_.springs)
    if (!fixed[i] && !fixed[j]) pairs.push_back({i, j});
  if (!factor_.analyze(rows, pairs, most)) return false;
  factor_.clear();
  for (unsigned i = 0; i < rows; ++i)
    factor_.add_diagonal(i, fixed[i] ? 1 : key_.diagonal[i]);
  std::size_t pair = 0;
  for (const auto& [i, j, K] : key_.springs) {
    if (!fixed[i]) factor_.add_diagonal(i, b * K);
    if (!fixed[j]) factor_.add_diagonal(j, b * K);
    if (!fixed[i] && !fixed[j]) factor_.add(pair++, -b * K);
  }
  return factor_.factorize();
}

void LaplacianFactor::solve(std::span<Point> f) {
  factor_.solve(f.first(factor_.rows()));
  for (unsigned i = 0; i < key_.fixed.size(); ++i)
    if (key_.fixed[i]) f[i] = Point();
}

}  // namespace lab
