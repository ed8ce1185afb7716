#include "lab/scenes/Net.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "CME212/Util.hpp"

namespace lab {

namespace {
std::string no_node(unsigned i, std::size_t num_points) {
  return i < num_points ? "" : "there is no node " + std::to_string(i);
}
std::string not_finite(const Point& p) {
  return is_finite(p) ? "" : "is not finite";
}
}  // namespace

std::string error_in(const Spring& s, std::size_t num_points) {
  const auto is = [](const char* name, double a) {
    return name + (" is " + CME212::short_text(a)) + ", expected 0 or more";
  };
  for (unsigned i : {s.i, s.j})
    if (i >= num_points) return no_node(i, num_points);
  if (s.i == s.j) return "joins node " + std::to_string(s.i) + " to itself";
  if (!std::isfinite(s.K)) return is("K", s.K);
  return std::isfinite(s.L) ? "" : is("L", s.L);
}

void check(const Net& net) {
  const std::size_t n = net.points.size();
  const auto each = [n](const char* name, const auto& all, auto error_of,
                        bool by_node = false) {
    if (by_node && !all.empty() && all.size() != n)
      throw std::invalid_argument(
          name + (": has " + std::to_string(all.size())) +
          " values, expected one for each of " + CME212::count_of(n, "node"));
    for (std::size_t k = 0; k < all.size(); ++k)
      if (const std::string error = error_of(all[k]); !error.empty())
        throw std::invalid_argument(name + ('[' + std::to_string(k)) +
                                    "]: " + error);
  };
  each("points", net.points, not_finite);
  each("velocities", net.velocities, not_finite, true);
  each(
      "masses", net.masses,
      [](double m) {
        return m > 0 && std::isfinite(m) ? "" : "is not more than 0";
      },
      true);
  const auto in_net = [n](unsigned i) { return no_node(i, n); };
  each("held", net.held, in_net);
  each("quads", net.quads, [&](const Quad& q) {
    for (unsigned i : q)
      if (i >= n) return in_net(i);
    for (unsigned k : {0u, 1u, 2u})
      for (unsigned other = k + 1; other < 4; ++other)
        if (q[k] == q[other] && !(k == 1 && other == 3))
          return "node " + std::to_string(q[k]) + " comes twice";
    return std::string();
  });
  each("springs", net.springs, [n](const Spring& s) { return error_in(s, n); });
}

}  // namespace lab
