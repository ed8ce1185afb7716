#include "lab/scenes/MeshFile.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "CME212/MeshFaults.hpp"
#include "CME212/Util.hpp"
#include "lab/scenes/NetFile.hpp"
#include "lab/scenes/NetParsing.hpp"

namespace lab {

Net parse_nodes(std::string_view text, const std::string& file) {
  using namespace net_parsing;
  Net mesh;
  std::size_t columns = 0;  // of all lines; 0: not known yet
  const auto use = [&](net_parsing::Words w) {
    const std::size_t n = w.size();
    if (columns == 0 ? n != 3 && n != 6 : n != columns)
      fail(CME212::count_of(n, "value") + " in the line");
    mesh.points.push_back(point(w, 0));
    if (n == 6) mesh.velocities.push_back(point(w, 3));
    columns = n;
  };
  const auto expected = [&]() -> std::string {
    return columns == 6
               ? "six finite numbers 'x y z vx vy vz' [m, m/s], as in the "
                 "first line"
               : std::string("three finite coordinates 'x y z' [m]") +
                     (columns == 0 ? ", and three of a velocity [m/s] or none"
                                   : "");
  };
  const std::size_t lines = each_line(text, file, use, expected);
  if (columns == 0)
    throw InputError(file, lines,
                     "nothing in the file, expected " + expected());
  return mesh;
}

namespace {

/** The cells in @a file. Indices from 1 to the number of points start at 1. */
template <std::size_t N>
std::vector<std::array<unsigned, N>> load_cells(const std::string& file,
                                                Net& net) {
  const auto text =
      mesh_detail::read_file(file, N == 4   ? "a file of quads"
                                   : N == 3 ? "a file of triangles"
                                            : "a file of edges");
  const std::size_t n = net.points.size();
  try {
    return parse_cells<N>(text, file, n);
  } catch (const InputError&) {
    std::vector<std::array<unsigned, N>> cells;
    try {
      cells = parse_cells<N>(text, file, n + 1);
    } catch (const InputError&) {
    }
    bool from_1 = !cells.empty();
    for (auto& cell : cells)
      for (unsigned& i : cell) from_1 &= i-- > 0;
    if (!from_1) throw;
    net.notes.push_back("the indices in " + file +
                        " start at 1, expected 0: "
                        "1 is subtracted from all");
    return cells;
  }
}

/** Note that @a n of these are listed more often than they count. */
void note_once(Net& net, std::size_t n, const char* what, const char* how) {
  if (n > 0)
    net.notes.push_back(CME212::count_of(n, what) + (n == 1 ? " is" : " are") +
                        " listed " + how + ": each counts once");
}

}  // namespace

Net load_mesh(const std::string& nodes, const std::string& cells) {
  Net net;
  if (cells.empty())
    net = parse_net(mesh_detail::read_file(nodes, "a mesh or a net"), nodes);
  else
    net = parse_nodes(mesh_detail::read_file(nodes, "a file of points"), nodes);
  if (CME212::ending_of(cells) == ".edges") {
    for (auto [i, j] : load_cells<2>(cells, net)) net.springs.push_back({i, j});
  } else if (CME212::ending_of(cells) == ".tris") {
    for (auto [a, b, c] : load_cells<3>(cells, net))
      net.quads.push_back(face_around(a, b, c));
  } else if (!cells.empty()) {
    net.quads = load_cells<4>(cells, net);
    if (num_around(net.points, net.quads) > net.quads.size() / 2) {
      for (Quad& q : net.quads) q = face_around(q[0], q[1], q[2], q[3]);
      net.notes.push_back("the quads in " + cells +
                          " list their corners around, as a b d c: taken as "
                          "a b c d, with the sides ab, ac, bd and cd");
    }
  }
  const auto again = repeated(net.quads);
  for (unsigned k : again) net.quads[k][1] = net.quads[k][0];
  std::erase_if(net.quads, [](const Quad& q) { return q[1] == q[0]; });
  note_once(net, again.size(), "face", "twice");
  join_ends(net);
  return net;
}

void join_ends(Net& net) {
  std::vector<Spring> forward;
  for (const Spring& s : net.springs)
    if (s.i < s.j) forward.push_back(s);
  std::ranges::sort(forward);
  const auto n = std::erase_if(net.springs, [&](const Spring& s) {
    return std::ranges::binary_search(forward,
                                      Spring{s.j, s.i, s.K, s.L, s.acts});
  });
  note_once(net, n, "spring", "from both ends");
}

bool needs_net(const std::string& nodes, const std::string& cells) {
  return (cells.empty() && !nodes.empty()) ||
         CME212::ending_of(cells) == ".tris" ||
         CME212::ending_of(cells) == ".edges";
}

void write_nodes(std::ostream& out, const Net& mesh) {
  auto write = [&out](const Point& p) {
    out << CME212::to_text(p.x) << ' ' << CME212::to_text(p.y) << ' '
        << CME212::to_text(p.z);
  };
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    write(mesh.points[i]);
    if (!mesh.velocities.empty()) out << ' ', write(mesh.velocities[i]);
    out << '\n';
  }
}

void write_quads(std::ostream& out, const Net& mesh) {
  for (const Quad& q : mesh.quads)
    out << q[0] << ' ' << q[1] << ' ' << q[2] << ' ' << q[3] << '\n';
}

std::string quads_beside(const std::string& nodes) {
  namespace fs = std::filesystem;
  fs::path file(nodes);
  std::error_code none;
  if (nodes.empty() || fs::is_other(file, none) ||
      CME212::ending_of(nodes) == ".net")
    return "";
  if (file.extension() == ".nodes") return file.replace_extension(".tets");
  return nodes + ".tets";
}

std::string absolute(const std::string& file) {
  return std::filesystem::absolute(file).string();
}

}  // namespace lab
