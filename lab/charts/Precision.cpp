#include "lab/charts/Precision.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "lab/charts/Report.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/Spectrum.hpp"

namespace lab {

void write_ends(const std::vector<Problem>& problems, std::ostream& out) {
  for (const Problem& p : problems) {
    Start start(p);
    const double omega = omega_safe(start.cloth, start.force, start.constraint);
    for (const auto& method : {entry_of<Verlet>(), entry_of<Srkn11b>()})
      for (double finer : {2, 8, 32}) {
        const auto steps = static_cast<long long>(
            std::ceil(p.t_end * omega / method.info.limit * finer));
        const Outcome r = run(p, *method.make(), steps);
        if (!r.ok()) throw std::runtime_error(p.name + ": " + r.reason);
        out << p.name << ' ' << method.info.name << ' ' << steps;
        out.precision(std::numeric_limits<double>::max_digits10);
        out << ' ' << r.end.energy << ' ' << r.end.center;
        if (p.norm == Norm::positions)
          for (const Point& x : r.end.positions) out << ' ' << x;
        out << '\n';
      }
  }
}

std::vector<Compared> compare_ends(const std::vector<Problem>& problems,
                                   const std::string& text,
                                   const std::string& file) {
  std::vector<Compared> all;
  std::istringstream lines(text);
  long number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream in(line);
    Compared c;
    End there;
    in >> c.scene >> c.method >> c.steps >> there.energy >> there.center;
    const auto p = std::ranges::find(problems, c.scene, &Problem::name);
    const MethodEntry* method = find_method(c.method);
    if (!in || p == problems.end() || !method || c.steps < 1)
      throw InputError(file, number, "no end of a run, expected one by --ends");
    for (Point x; in >> x;) there.positions.push_back(x);
    const End here = run(*p, *method->make(), c.steps).end;
    if (p->norm == Norm::positions &&
        there.positions.size() != here.positions.size())
      throw InputError(file, number,
                       std::to_string(there.positions.size()) +
                           " positions, expected " +
                           std::to_string(here.positions.size()));
    c.norm = p->norm, c.dt = p->t_end / double(c.steps);
    c.distance = distance(*p, there, here);
    all.push_back(c);
  }
  return all;
}

void write_compared(const std::vector<Compared>& all, std::ostream& out) {
  std::map<std::string, double> floor;
  for (const Compared& c : all) {
    double& least = floor.try_emplace(c.scene, c.distance).first->second;
    least = std::min(least, c.distance);
  }
  report::write_head(out,
                     "how far single precision ends from double; columns: "
                     "lab/charts/README.md");
  for (const auto& [scene, least] : floor) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1g m", least);
    out << "# single precision floor " << scene << ": " << text << '\n';
  }
  out << "scene,method,dt [s],steps,distance [m],norm\n";
  for (const Compared& c : all)
    out << c.scene << ',' << c.method << ',' << report::cell(c.dt) << ','
        << c.steps << ',' << report::cell(c.distance) << ',' << name_of(c.norm)
        << '\n';
}

}  // namespace lab
