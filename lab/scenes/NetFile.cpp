#include "lab/scenes/NetFile.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "lab/scenes/NetParsing.hpp"

namespace lab {

namespace net_parsing {
namespace {

// ------------------------------------------------------------------------ net

Net parse_net_lines(std::string_view text, const std::string& file) {
  struct Form {
    const char *name, *expected;
  };
  constexpr Form forms[] = {
      {"node",
       "'node x y z' [m], then 'mass m' [kg], 'velocity x y z' [m/s] "
       "or 'held'"},
      {"spring",
       "'spring i j', nodes of lines above, then K [N/m], then the "
       "rest length [m]"},
      {"face",
       "'face i j k' or 'face i j k l', different nodes of lines above"},
      {"bare-faces", "'bare-faces' alone"}};
  const Form* form = nullptr;
  Builder b;
  Net& net = b.net;
  const auto use = [&](Words w) {
    form = std::ranges::find(forms, w[0], &Form::name);
    if (form == std::end(forms)) fail(quoted(w[0]) + " begins the line");
    switch (form - forms) {
      case 0: {
        net.points.push_back(point(w, 1));
        for (std::size_t k = 4; k < w.size(); ++k) {
          const auto i = net.points.size() - 1;
          if (w[k] == "held") {
            net.held.push_back(unsigned(i));
          } else if (w[k] == "mass" && k + 1 < w.size()) {
            net.masses.resize(i + 1);
            net.masses[i] = number(w[++k]);
            if (!(net.masses[i] > 0)) fail("a mass that is not above 0");
          } else if (w[k] == "velocity") {
            net.velocities.resize(i + 1);
            net.velocities[i] = point(w, k + 1);
            k += 3;
          } else {
            fail(quoted(w[k]) + " in the line");
          }
        }
        break;
      }
      case 1: {
        if (w.size() < 3 || w.size() > 5)
          fail(CME212::count_of(w.size() - 1, "value") + " in the line");
        const auto value = [&](std::size_t k) {
          const double a = k < w.size() ? number(w[k]) : -1;
          if (k < w.size() && a < 0) fail(quoted(w[k]) + " is below 0");
          return a;
        };
        b.spring(whole(w[1]), whole(w[2]), value(3), value(4));
        break;
      }
      case 2: {
        std::vector<long long> nodes;
        for (auto word : w.subspan(1)) nodes.push_back(whole(word));
        b.face(nodes);
        break;
      }
      default:
        if (w.size() > 1) fail(quoted(w[1]) + " in the line");
        net.bare_faces = true;
    }
  };
  each_line(text, file, use, [&]() -> std::string {
    return form != std::end(forms)
               ? form->expected
               : "a line of node, spring, face or bare-faces";
  });
  if (!net.velocities.empty()) net.velocities.resize(net.points.size());
  if (!net.masses.empty()) net.masses.resize(net.points.size());
  for (double& m : net.masses)
    if (m == 0) m = 1 / double(net.points.size());
  return std::move(net);
}

// ------------------------------------------------------------------------ obj

Net parse_obj(std::string_view text, const std::string& file) {
  Builder b;
  b.first = 1;
  const auto use = [&](Words w) {
    // "7", "7/1", "7//2", "-1/1/1": the node is the first; from 1, or from the
    // last one backwards.
    const auto node = [&b](std::string_view word) {
      const auto n = (long long)b.net.points.size();
      const long long i = whole(word.substr(0, word.find('/')));
      if (i == 0 || i < -n) fail("there is no node " + std::to_string(i));
      return i > 0 ? i - 1 : n + i;
    };
    std::vector<long long> nodes;
    if (w[0] == "v") {
      b.net.points.push_back(point(w, 1));
    } else if (w[0] == "f" || w[0] == "l") {
      for (auto word : w.subspan(1)) nodes.push_back(node(word));
      if (w[0] == "f") b.face(nodes);
      for (std::size_t k = 1; w[0] == "l" && k < nodes.size(); ++k)
        b.spring(nodes[k - 1], nodes[k]);
    }
  };
  each_line(text, file, use, [] {
    return "'v x y z', and " + corners + " of lines above, from 1 on";
  });
  return std::move(b.net);
}

// ------------------------------------------------------------------------ off

Net parse_off(std::string_view text, const std::string& file) {
  Builder b;
  long long left[2] = {-1, -1};  // points and faces
  const auto use = [&](Words w) {
    if (left[0] < 0) {
      if (w[0].ends_with("OFF")) w = w.subspan(1);
      if (w.empty()) return;
      if (w.size() < 2) fail("one number in the line");
      for (int k : {0, 1})
        if ((left[k] = whole(w[k])) < 0) fail("a number below 0");
    } else if (left[0] > 0) {
      b.net.points.push_back(point(w, 0)), --left[0];
    } else if (left[1] > 0) {
      const auto n = std::size_t(std::max(0LL, whole(w[0])));
      if (w.size() < n + 1) fail(CME212::count_of(w.size() - 1, "node"));
      std::vector<long long> nodes;
      for (auto word : w.subspan(1, n)) nodes.push_back(whole(word));
      n == 2 ? b.spring(nodes[0], nodes[1]) : b.face(nodes);
      --left[1];
    } else {
      fail("more lines than that");
    }
  };
  const std::string expected =
      "'OFF', the numbers of nodes and faces, as many lines 'x y z', and " +
      corners + " as '3 i j k' or '4 i j k l'";
  each_line(text, file, use, [&] { return expected; });
  if (left[0] != 0 || left[1] != 0)
    throw InputError(file, 0, "ends early, expected " + expected);
  return std::move(b.net);
}

// ------------------------------------------------------------------- Formats

/** Make nodes at the same place one node, and drop faces that then have no
 * area.
 * @return how many nodes are gone */
std::size_t weld(Net& net) {
  std::map<std::array<double, 3>, unsigned> at;
  std::vector<unsigned> now;
  std::vector<Point> points, velocities;
  for (const Point& p : net.points) {
    const auto [it, is_new] =
        at.try_emplace({p.x, p.y, p.z}, unsigned(points.size()));
    now.push_back(it->second);
    if (!is_new) continue;
    points.push_back(p);
    if (!net.velocities.empty())
      velocities.push_back(net.velocities[now.size() - 1]);
  }
  if (points.size() == now.size()) return 0;
  std::vector<Quad> quads;
  for (const Quad& q : net.quads) {
    std::vector<unsigned> around;
    for (unsigned k : {0u, 2u, 3u, 1u})
      if (std::ranges::count(around, now[q[k]]) == 0)
        around.push_back(now[q[k]]);
    if (around.size() > 2)
      quads.push_back(face_around(around[0], around[1], around[2],
                                  around[around.size() - 1]));
  }
  for (Spring& s : net.springs) s.i = now[s.i], s.j = now[s.j];
  std::erase_if(net.springs, [](const Spring& s) { return s.i == s.j; });
  net.points = std::move(points), net.velocities = std::move(velocities);
  net.quads = std::move(quads);
  return now.size() - net.points.size();
}

}  // namespace
}  // namespace net_parsing

Net parse_net(std::string_view text, const std::string& file) {
  using namespace net_parsing;
  struct Format {
    const char* ending;
    Net (*parse)(std::string_view, const std::string&);
    enum { as_it_is, seams, triangles } nodes;  // of which it repeats some
  };
  constexpr Format formats[] = {{".net", parse_net_lines, Format::as_it_is},
                                {".obj", parse_obj, Format::seams},
                                {".off", parse_off, Format::seams},
                                {".ply", parse_ply, Format::seams},
                                {".stl", parse_stl, Format::triangles}};
  const std::string ending = CME212::ending_of(file);
  std::string known;
  for (const Format& f : formats) {
    known += (known.empty() ? "" : ", ") + std::string(f.ending);
    if (ending != f.ending) continue;
    Net net = f.parse(text, file);
    if (net.points.empty())
      throw InputError(file, 0, "has no node, expected a mesh or a net");
    if (f.nodes == Format::as_it_is) return net;
    const std::size_t before = net.points.size(), gone = weld(net);
    if (f.nodes == Format::seams && gone > 0)
      net.notes.push_back(
          std::to_string(gone) + " of " + CME212::count_of(before, "node") +
          " lie at the same point as another one, as where an export splits "
          "seams: they are one node now, and indices are those of " +
          CME212::count_of(net.points.size(), "node"));
    return net;
  }
  throw InputError(file, 0,
                   "expected a name that ends in one of " + known +
                       (ending == ".vtp" ? "; ParaView writes .ply: File, "
                                           "Save Data"
                                         : ""));
}

void write_net(std::ostream& out, const Net& net) {
  const auto write = [&out](const char* name, const Point& p) {
    out << name << ' ' << CME212::to_text(p.x) << ' ' << CME212::to_text(p.y)
        << ' ' << CME212::to_text(p.z);
  };
  std::vector<char> held(net.points.size());
  for (unsigned i : net.held) held[i] = 1;
  for (std::size_t i = 0; i < net.points.size(); ++i) {
    write("node", net.points[i]);
    if (!net.masses.empty()) out << " mass " << CME212::to_text(net.masses[i]);
    if (!net.velocities.empty() && net.velocities[i] != Point())
      write(" velocity", net.velocities[i]);
    out << (held[i] ? " held\n" : "\n");
  }
  for (const Spring& s : net.springs) {
    out << "spring " << s.i << ' ' << s.j;
    if (s.K >= 0) out << ' ' << CME212::to_text(s.K);
    if (s.K >= 0 && s.L >= 0) out << ' ' << CME212::to_text(s.L);
    out << '\n';
  }
  for (const Quad& q : net.quads) {
    out << "face " << q[0] << ' ' << q[2] << ' ' << q[3];
    if (!is_triangle(q)) out << ' ' << q[1];
    out << '\n';
  }
  if (net.bare_faces) out << "bare-faces\n";
}

}  // namespace lab
