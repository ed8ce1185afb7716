#include "lab/scenes/NetFile.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "CME212/MeshFaults.hpp"
#include "lab/scenes/NetParsing.hpp"

namespace lab {

namespace net_parsing {
namespace {

// ------------------------------------------------------------------------ net

void parse_net_lines(std::string_view text, const std::string& file,
                     Builder& b) {
  struct Form {
    const char *name, *expected;
  };
  constexpr Form forms[] = {
      {"node",
       "'node x y z' [m], then 'mass m' [kg], 'velocity x y z' [m/s] "
       "or 'held'"},
      {"spring",
       "'spring i j', nodes of lines above, then K [N/m], then the "
       "rest length [m], each also behind its name, 'K' or 'L', then 'cable' "
       "or 'strut'"},
      {"face", "'face i j k', its nodes around, of lines above"},
      {"load", "'load i x y z', a node of a line above and a force [N]"},
      {"bare-faces", "'bare-faces' alone"}};
  const Form* form = nullptr;
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
        if (w.size() < 3)
          fail(CME212::count_of(w.size() - 1, "value") + " in the line");
        b.spring(whole(w[1]), whole(w[2]));
        Spring& s = net.springs.back();
        const auto set = [&](double& a, std::string_view word) {
          if (a >= 0) fail(quoted(word) + " in the line");
          if ((a = number(word)) < 0) fail(quoted(word) + " is below 0");
        };
        for (std::size_t k = 3; k < w.size(); ++k)
          if (w[k] == "cable" || w[k] == "strut")
            s.acts = w[k] == "cable" ? Acts::pulls : Acts::pushes;
          else if ((w[k] == "K" || w[k] == "L") && k + 1 < w.size())
            set(w[k] == "K" ? s.K : s.L, w[k + 1]), ++k;
          else
            set(s.K < 0 ? s.K : s.L, w[k]);
        break;
      }
      case 2: {
        std::vector<long long> nodes;
        for (auto word : w.subspan(1)) nodes.push_back(whole(word));
        b.face(nodes);
        break;
      }
      case 3:
        if (w.size() != 5)
          fail(CME212::count_of(w.size() - 1, "value") + " in the line");
        net.loads.push_back({b.index(whole(w[1])), point(w, 2)});
        break;
      default:
        if (w.size() > 1) fail(quoted(w[1]) + " in the line");
        net.bare_faces = true;
    }
  };
  each_line(text, file, use, [&]() -> std::string {
    return form != std::end(forms)
               ? form->expected
               : "a line of node, spring, face, load or bare-faces";
  });
  if (!net.velocities.empty()) net.velocities.resize(net.points.size());
  if (!net.masses.empty()) net.masses.resize(net.points.size());
  for (double& m : net.masses)
    if (m == 0) m = 1 / double(net.points.size());
}

// ------------------------------------------------------------------------ obj

void parse_obj(std::string_view text, const std::string& file, Builder& b) {
  // Lines that hold no shape.
  constexpr std::string_view others[] = {
      "vt", "vn", "g", "s", "o", "mg", "usemtl", "mtllib", "usemap", "maplib"};
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
    const bool is_line = w[0] == "l";
    if (w[0] == "v") {
      b.net.points.push_back(point(w, 1));
    } else if (is_line || w[0] == "f" || w[0] == "fo") {  // fo: a name of old
      for (auto word : w.subspan(1)) nodes.push_back(node(word));
      if (!is_line) b.face(nodes);
      for (std::size_t k = 1; is_line && k < nodes.size(); ++k)
        b.spring(nodes[k - 1], nodes[k]);
    } else if (std::ranges::count(others, w[0]) == 0) {
      b.skip(quoted(w[0]));
    }
  };
  each_line(text, file, use, [] {
    return std::string(
        "'v x y z', and faces 'f i j k' of lines above, from 1 on");
  });
}

// ------------------------------------------------------------------------ off

void parse_off(std::string_view text, const std::string& file, Builder& b) {
  long long left[2] = {-1, -1};  // points and faces
  const auto use = [&](Words w) {
    std::vector<std::string_view> words(w.begin(), w.end());
    if (const auto mark = w[0].find("OFF"); left[0] < 0 && mark < w[0].npos) {
      if (w[0].substr(0, mark).find_first_not_of("STCN") < mark)
        fail(quoted(w[0]) + " begins the file");
      words[0].remove_prefix(mark + 3);
      if (words[0].empty()) words.erase(words.begin());
      w = words;
    }
    if (w.empty()) return;
    if (left[0] < 0) {
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
      "'OFF', the numbers of nodes and faces, as many lines 'x y z' and '3 i j "
      "k'";
  each_line(text, file, use, [&] { return expected; });
  if (left[0] != 0 || left[1] != 0)
    throw InputError(file, 0, "ends early, expected " + expected);
}

}  // namespace

// -------------------------------------------------------------------- Builder

void Builder::weld(bool says_so) {
  std::vector<unsigned> now = first_at_place(net.points);
  std::vector<Point> points, velocities;
  for (unsigned i = 0; i < now.size(); ++i) {
    const bool stays = now[i] == i;
    now[i] = stays ? unsigned(points.size()) : now[now[i]];
    if (!stays) continue;
    points.push_back(net.points[i]);
    if (!net.velocities.empty()) velocities.push_back(net.velocities[i]);
  }
  const std::size_t before = now.size(), gone = before - points.size();
  if (gone == 0) return;
  for (unsigned& c : corners_) c = now[c];
  for (Spring& s : net.springs) s.i = now[s.i], s.j = now[s.j];
  std::erase_if(net.springs, [](const Spring& s) { return s.i == s.j; });
  net.points = std::move(points), net.velocities = std::move(velocities);
  if (says_so)
    net.notes.push_back(
        std::to_string(gone) + " of " + CME212::count_of(before, "node") +
        " lie at the same point as another one, to 1e-6 of the size, as where "
        "an export splits seams: they are one node now, and indices are those "
        "of " +
        CME212::count_of(net.points.size(), "node"));
}

Net Builder::made() && {
  std::size_t flat = 0, fans = 0;
  const auto p = [&](unsigned i) { return net.points[i]; };
  for (std::span<const unsigned> rest(corners_); std::size_t size : sizes_) {
    std::vector<unsigned> c;  // corners, without one that follows itself
    for (unsigned i : rest.first(size))
      if (c.empty() || c.back() != i) c.push_back(i);
    rest = rest.subspan(size);
    while (c.size() > 1 && c.back() == c[0]) c.pop_back();
    const std::size_t n = c.size(), before = net.quads.size();
    if (n == 4 && c[0] != c[2] && c[1] != c[3]) {
      net.quads.push_back(face_around(c[0], c[1], c[2], c[3]));
      continue;
    }
    // A fan of triangles, from the corner that gives it the least area: that
    // of the face, if its other corners can be seen from there.
    const auto fan = [&](std::size_t from, auto use) {
      for (std::size_t k = 1; k + 1 < n; ++k)
        use(c[from], c[(from + k) % n], c[(from + k + 1) % n]);
    };
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t from = 0; n > 4 && from < std::min<std::size_t>(n, 64);
         ++from) {
      double area = 0;
      fan(from, [&](unsigned i, unsigned j, unsigned k) {
        area += norm(cross(p(j) - p(i), p(k) - p(i)));
      });
      if (area < least * (1 - 1e-9)) least = area, best = from;
    }
    fan(best, [&](unsigned i, unsigned j, unsigned k) {
      if (i != j && i != k) net.quads.push_back(face_around(i, j, k));
    });
    flat += net.quads.size() == before, fans += n > 4;
  }
  const auto say = [&](std::size_t n, const char* what, const char* now) {
    if (n > 0)
      net.notes.push_back(CME212::count_of(n, "face") + what +
                          (n == 1 ? ": it is " : ": they are ") + now);
  };
  say(flat, " with fewer than three different corners", "left out");
  say(fans, " with more than four corners", "read as triangles in a fan");
  if (!skipped.empty()) net.notes.push_back(skipped);
  return std::move(net);
}

}  // namespace net_parsing

// -------------------------------------------------------------------- Formats

Net parse_net(std::string_view text, const std::string& file) {
  using namespace net_parsing;
  struct Format {
    const char* ending;
    void (*parse)(std::string_view, const std::string&, Builder&);
    bool welds = true, says_so = true;
  };
  constexpr Format formats[] = {{".net", parse_net_lines, false},
                                {".obj", parse_obj},
                                {".off", parse_off},
                                {".ply", parse_ply},
                                {".stl", parse_stl, true, false}};
  const std::string ending = CME212::ending_of(file);
  const auto format = std::ranges::find(formats, ending, &Format::ending);
  if (format == std::end(formats)) {
    std::string known;
    for (const Format& f : formats)
      known += (known.empty() ? "" : ", ") + std::string(f.ending);
    throw InputError(file, 0,
                     "expected a name that ends in one of " + known +
                         (ending == ".vtp" ? "; ParaView writes .ply: File, "
                                             "Save Data"
                                           : ""));
  }
  Builder b;
  format->parse(text, file, b);
  if (format->welds) b.weld(format->says_so);
  const std::size_t n = b.net.points.size();
  Net net = std::move(b).made();
  if (!net.quads.empty() || !net.springs.empty()) return net;
  if (!format->welds && n > 0) return net;
  throw InputError(
      file, 0,
      "has " + (n == 0 ? "no node" : CME212::count_of(n, "node")) +
          (n == 0 ? "" : ", but no face and no line between them") +
          (b.skipped.empty() ? "" : "; ") + b.skipped +
          ", expected a mesh or a net");
}

void write_net(std::ostream& out, const Net& net) {
  const auto write = [&out](const std::string& name, const Point& p) {
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
    if (s.L >= 0) out << (s.K < 0 ? " L " : " ") << CME212::to_text(s.L);
    if (s.acts != Acts::both)
      out << (s.acts == Acts::pulls ? " cable" : " strut");
    out << '\n';
  }
  for (const Quad& q : net.quads) {
    out << "face " << q[0] << ' ' << q[2] << ' ' << q[3];
    if (!is_triangle(q)) out << ' ' << q[1];
    out << '\n';
  }
  for (const Load& a : net.loads)
    write("load " + std::to_string(a.node), a.force), out << '\n';
  if (net.bare_faces) out << "bare-faces\n";
}

}  // namespace lab
