#include "lab/stability/Diagnosis.hpp"

#include <cmath>
#include <sstream>

#include "CME212/Util.hpp"

namespace lab {

WorstPlace::WorstPlace(const Cloth& g) {
  double highest = -1;
  for (Node n : g.nodes()) {
    double v = norm(n.value().vel);
    if (!std::isfinite(v + norm(n.position()))) v = no_limit;
    if (v > highest) highest = v, node = n;
  }
  if (!g.has_node(node)) return;
  speed = highest;
  double longest = -1;
  for (Edge e : node.edges())
    if (double l = e.length(); !(l <= longest)) longest = l, spring = e;
  if (g.has_edge(spring)) length = std::isfinite(longest) ? longest : no_limit;
}

std::string WorstPlace::text(const Cloth& g) const {
  if (!g.has_node(node)) return "no node is left";
  std::ostringstream out;
  out << "node " << node.index();
  if (std::isfinite(speed))
    out << " moves at " << speed << " m/s";
  else
    out << " has a position or a velocity that is not finite";
  if (!g.has_edge(spring)) return out.str();
  out << ", its spring to node " << spring.node2().index() << " is ";
  if (!std::isfinite(length))
    out << "beyond all bounds";
  else if (double L = spring.value().L; L > 0)
    out << length / L << " times its rest length of " << L << " m";
  else
    out << length << " m long";
  return out.str();
}

std::string why_it_failed(const MethodInfo& info, double dt, double sharp,
                          double safe, double verlet) {
  std::ostringstream out;
  out.precision(3);
  auto instead = [&](double limit) {
    out << "--dt " << safe_share * limit << " or --dt auto works";
  };
  if (info.limit == no_limit || info.limit == 0 || info.adaptive) {
    out << info.name << " fails with: " << info.fails_when;
    if (std::isfinite(verlet)) {
      out << " (dt is " << dt / verlet << " times verlet's stability limit); "
          << "--method verlet with ";
      instead(verlet);
    }
  } else if (dt > 0.97 * sharp || dt > safe) {
    const double limit = dt > 0.97 * sharp ? sharp : safe;
    out << "dt is " << dt / limit << " times the stability limit (" << limit
        << " s" << (limit == sharp ? " in this configuration" : "") << ", "
        << info.name << "): the fastest waves in the springs grow in every "
        << "step; ";
    instead(safe);
  } else {
    out << "not the springs: dt is " << CME212::percent(dt / safe)
        << " of the stability limit (" << safe << " s, " << info.name
        << "); look at what else moves nodes, and at: " << info.fails_when;
  }
  return out.str();
}

}  // namespace lab
