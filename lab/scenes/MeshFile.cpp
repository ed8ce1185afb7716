#include "lab/scenes/MeshFile.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "CME212/Util.hpp"

namespace lab {

Net parse_nodes(std::string_view text, const std::string& file) {
  const std::string three = "three finite coordinates 'x y z' [m]";
  const std::string six =
      "six finite numbers 'x y z vx vy vz' [m, m/s], as in the first line";
  Net mesh;
  std::size_t columns = 0;  // of all lines; 0: not known yet
  auto expected = [&] {
    return columns == 0   ? three + ", and three of a velocity [m/s] or none"
           : columns == 3 ? three
                          : six;
  };
  const std::size_t lines =
      mesh_detail::for_each_line(text, [&](auto& words, std::size_t line) {
        try {
          std::array<double, 6> row{};
          for (std::size_t k = 0; k < std::min(row.size(), words.size()); ++k) {
            row[k] = mesh_detail::parse_number<double>(words[k], "a number");
            if (!std::isfinite(row[k]))
              throw std::runtime_error(k < 3 ? "a coordinate is not finite"
                                             : "a velocity is not finite");
          }
          const std::size_t n = words.size();
          if (columns == 0 ? n != 3 && n != 6 : n != columns)
            throw std::runtime_error(CME212::count_of(n, "value") +
                                     " in the line");
          columns = n;
          mesh.points.push_back({row[0], row[1], row[2]});
          if (n == 6) mesh.velocities.push_back({row[3], row[4], row[5]});
        } catch (const std::runtime_error& e) {
          throw InputError(file, line, e.what() + (", expected " + expected()));
        }
      });
  if (columns == 0)
    throw InputError(file, lines,
                     "nothing in the file, expected " + expected());
  return mesh;
}

Net load_mesh(const std::string& nodes, const std::string& tets) {
  const auto read = [](const std::string& file, const char* expected) {
    return mesh_detail::read_file(file, expected);
  };
  Net mesh = parse_nodes(read(nodes, "a file of points"), nodes);
  mesh.quads =
      parse_quads(read(tets, "a file of quads"), tets, mesh.points.size());
  return mesh;
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
  if (nodes.empty() || fs::is_other(file, none)) return "";
  if (file.extension() == ".nodes") return file.replace_extension(".tets");
  return nodes + ".tets";
}

std::string absolute(const std::string& file) {
  return std::filesystem::absolute(file).string();
}

}  // namespace lab
