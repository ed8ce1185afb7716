// Feeds the parsers of Mesh.hpp, MeshFile.hpp and NetFile.hpp with whatever
// libFuzzer thinks of. The first byte of an input chooses the parser, the rest
// is the file.
//   make fuzz RUNS=1000000      starts from the inputs in tools/corpus
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/NetFile.hpp"

namespace {

void require(bool ok) {
  if (!ok) std::abort();
}

/** Accepted numbers are in range and survive writing and reading. */
void check_points(std::string_view text) {
  auto points = parse_points(text, "f");
  require(!points.empty());
  std::string again;
  for (Point p : points) {
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (double a : p) again += CME212::to_text(a) + ' ';
    again += '\n';
  }
  require(parse_points(again, "f") == points);
}

void check_nodes(std::string_view text) {
  const auto mesh = lab::parse_nodes(text, "f");
  require(!mesh.points.empty());
  require(mesh.velocities.empty() ||
          mesh.velocities.size() == mesh.points.size());
  std::ostringstream again;
  lab::write_nodes(again, mesh);
  const auto same = lab::parse_nodes(again.str(), "f");
  require(same.points == mesh.points && same.velocities == mesh.velocities);
}

void check_quads(std::string_view text) {
  constexpr std::size_t num_points = 1000;
  auto quads = parse_quads(text, "f", num_points);
  require(!quads.empty());
  std::string again;
  for (Quad q : quads) {
    for (unsigned k = 0; k < 4; ++k) {
      require(q[k] < num_points && q[k] != q[(k + 1) % 4]);
      again += std::to_string(q[k]) + ' ';
    }
    require(q[0] != q[2] && q[1] != q[3]);
    again += '\n';
  }
  require(parse_quads(again, "f", num_points) == quads);
}

/** Accepted nets can be built, and survive writing and reading; messages name
 * the file. */
void check_net(std::string_view text, const std::string& file) try {
  const lab::Net net = lab::parse_net(text, file);
  std::ostringstream once, twice;
  lab::write_net(once, net);
  lab::write_net(twice, lab::parse_net(once.str(), "f.net"));
  require(once.str() == twice.str());
} catch (const InputError& e) {
  const std::string_view what = e.what();
  require(what.starts_with(file + ':') && what.size() < 400);
  for (char c : what) require(' ' <= c && c <= '~');
}

/** A message is "f:LINE: words" in one printable line; of an empty file it has
 * no line to name. */
void check_message(std::string_view what) {
  require(what.starts_with("f:") && what.size() < 200);
  if (!what.starts_with("f: nothing in the file")) {
    std::size_t colon = what.find(':', 2);
    require(colon != std::string_view::npos && colon > 2);
    for (char c : what.substr(2, colon - 2)) require('0' <= c && c <= '9');
  }
  for (char c : what) require(' ' <= c && c <= '~');
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  if (size == 0) return 0;
  std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const char* const nets[] = {"f.net", "f.obj", "f.off", "f.ply", "f.stl"};
    data[0] >= 251     ? check_net(text, nets[data[0] - 251])
    : data[0] % 4 == 2 ? check_nodes(text)
    : data[0] % 2 == 0 ? check_points(text)
                       : check_quads(text);
  } catch (const InputError& e) {
    check_message(e.what());
  }
  return 0;
}
