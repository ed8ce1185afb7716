#include "lab/methods/StiffSplit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include "lab/fast/GraphArrays.hpp"

namespace lab {

namespace {

/** 1/m [1/kg] by node id; 0 for held nodes. */
std::vector<double> inverse_masses(const Cloth& g,
                                   const ConstraintPlan& constraint) {
  std::vector<double> w(arrays(g).node_slots());
  for (unsigned i = 0; i < w.size(); ++i)
    if (arrays(g).node_in_use(i))
      w[i] = 1 / double(arrays(g).node_values()[i].mass);
  constraint.each_held(g, [&w](Node n) { w[n.id()] = 0; });
  return w;
}

/** Springs of omega_e^2 in [2^k, 2^(k + 1)). */
struct Octave {
  double count = 0, top = 0;  // top: the largest omega_e [1/s]
};
constexpr int octaves = 400, lowest = -octaves / 2;
int octave_of(double omega2) {
  return std::clamp(std::ilogb(omega2) - lowest, 0, octaves - 1);
}

/** The first octave that is stiff; `octaves` if there is none. */
int first_stiff(const std::array<Octave, octaves>& of, double edges) {
  double top = 0;
  for (const Octave& o : of) top = std::max(top, o.top);
  double least = top * edges / 2, stiff = edges, soft_top = 0;
  int best = octaves;
  for (int k = 0; k < octaves; ++k) {
    const double cost = soft_top * (edges + cost_of_filter(stiff)) +
                        top * inner_steps_at_limit * cost_of_inner_step(stiff);
    if (stiff < edges && stiff > 0 && cost <= least) best = k, least = cost;
    stiff -= of[std::size_t(k)].count;
    soft_top = std::max(soft_top, of[std::size_t(k)].top);
  }
  return best;
}

}  // namespace

StiffSplit split_springs(const Cloth& g, int multiplicity,
                         const ConstraintPlan& constraint) {
  StiffSplit split;
  if (multiplicity == 0) return split;
  const std::vector<double> w = inverse_masses(g, constraint);
  const auto ends = arrays(g).edge_ends();
  const auto values = arrays(g).edge_values();
  const auto omega2 = [&](unsigned e) {
    if (!arrays(g).edge_in_use(e)) return 0.;
    const auto [i, j] = ends[e];
    return multiplicity * double(values[e].K) * (w[i] + w[j]);
  };
  std::array<Octave, octaves> of = {};
  double edges = 0;
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e) {
    const double a = omega2(e);
    if (!(a > 0)) continue;
    Octave& o = of[std::size_t(octave_of(a))];
    ++edges, ++o.count;
    o.top = std::max(o.top, std::sqrt(a));
  }
  const int first = first_stiff(of, edges);
  if (first == octaves) return split;
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e)
    if (const double a = omega2(e); a > 0 && octave_of(a) >= first) {
      split.springs.push_back({e, 0, 0});
      split.nodes.insert(split.nodes.end(), ends[e].begin(), ends[e].end());
    }
  std::ranges::sort(split.nodes);
  split.nodes.erase(std::unique(split.nodes.begin(), split.nodes.end()),
                    split.nodes.end());
  for (auto& [e, i, j] : split.springs)
    i = split.find(ends[e][0]), j = split.find(ends[e][1]);
  std::vector<double> sum(split.nodes.size());  // of K/m [1/s^2]
  for (const auto& [e, i, j] : split.springs) {
    const double K = multiplicity * double(values[e].K);
    sum[i] += K * w[ends[e][0]], sum[j] += K * w[ends[e][1]];
  }
  for (const auto& [e, i, j] : split.springs)
    split.omega = std::max(split.omega, std::sqrt(sum[i] + sum[j]));
  return split;
}

namespace {

class SoftStiffness final : public SweptForce {
 public:
  SoftStiffness(const Cloth& g, const ForcePlan& force,
                const ConstraintPlan& constraint)
      : force_(force) {
    for (const auto& s : split_springs(g, force.springs(), constraint).springs)
      stiff_.push_back(arrays(g).edge_ends()[s.edge]);
    std::ranges::sort(stiff_);
  }
  void add_to(const Part&, double, std::span<Point>) const override {}
  bool add_stiffness(const Cloth& g,
                     const StiffnessVisitor& use) const override {
    return force_.add_stiffness(
        g, [&](unsigned i, unsigned j, const Stiffness& B) {
          if (!std::ranges::binary_search(stiff_, std::array{i, j}))
            use(i, j, B);
        });
  }
  void add_slack(const Cloth& g, const StiffnessVisitor& use) const override {
    force_.add_slack(g, use);
  }

 private:
  ForcePlan force_;
  std::vector<std::array<unsigned, 2>> stiff_;  // ends, sorted
};

}  // namespace

ForcePlan soft_stiffness(const Cloth& g, const ForcePlan& force,
                         const ConstraintPlan& constraint) {
  return SoftStiffness(g, force, constraint);
}

}  // namespace lab
