#include "lab/stepping/Checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "CME212/Mesh.hpp"
#include "CME212/OutputFile.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stability/Guard.hpp"

namespace lab {

namespace {

constexpr const char* magic = "mass_spring checkpoint ";
constexpr int version = 15;

std::string first_line() { return magic + std::to_string(version) + '\n'; }

std::string bytes_of(std::uint64_t number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
std::uint64_t number_in(const std::string& bytes, std::size_t at) {
  std::uint64_t number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

template <typename T>
std::string_view bytes_of(std::span<T> list) {
  return {reinterpret_cast<const char*>(list.data()), list.size_bytes()};
}

/** The lines of a scene file that change the steps of a run. */
std::vector<std::string> relevant_lines(const std::string& scene) {
  Model none;
  const auto fields = fields_of(none);
  std::vector<std::string> lines;
  std::istringstream in(scene);
  for (std::string line; std::getline(in, line);) {
    const std::string key = line.substr(0, line.find(' '));
    // Files may have moved; checksum_of() compares their contents.
    const auto f = std::ranges::find(fields, key, &Field::name);
    if (f != fields.end() && f->role != Role::asked && f->role != Role::mesh)
      lines.push_back(line);
  }
  return lines;
}

}  // namespace

std::uint64_t crc64(std::string_view bytes, std::uint64_t before) {
  static constexpr auto table = [] {
    std::array<std::uint64_t, 256> all{};
    for (std::uint64_t i = 0; i < 256; ++i) {
      std::uint64_t c = i;
      for (int bit = 0; bit < 8; ++bit)
        c = (c >> 1) ^ (c % 2 ? 0xC96C5795D7870F42 : 0);
      all[i] = c;
    }
    return all;
  }();
  std::uint64_t c = ~before;
  for (char byte : bytes)
    c = table[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
  return ~c;
}

std::uint64_t checksum_of(const Cloth& g) {
  std::uint64_t sum = 0;
  for (std::string_view part :
       {bytes_of(arrays(g).positions()), bytes_of(arrays(g).node_values()),
        bytes_of(arrays(g).edge_ends()), bytes_of(arrays(g).edge_values())})
    sum = crc64(part, sum);
  return sum;
}

void write_checkpoint(const std::string& file, const Archive& saved) {
  CME212::OutputFile out(file);
  const std::string head = first_line() + bytes_of(saved.bytes().size());
  out.stream() << head << saved.bytes()
               << bytes_of(crc64(saved.bytes(), crc64(head)));
  out.commit(true);
}

Archive read_checkpoint(const std::string& file) {
  auto fail = [&file](const std::string& why) {
    throw std::runtime_error(file + ": " + why);
  };
  const std::string all = mesh_detail::read_file(file, "a checkpoint");
  if (all.empty()) fail("nothing in the file, expected a checkpoint");
  if (!all.starts_with(magic)) fail("is not a checkpoint");
  const std::string line = all.substr(0, all.find('\n') + 1),
                    head = first_line();
  if (line != head)
    fail("is a \"" +
         line.substr(0, std::min<std::size_t>(line.find('\n'), 80)) +
         "\", expected \"" + head.substr(0, head.size() - 1) + '"');
  const std::size_t start = head.size() + 8;
  if (all.size() < start + 8) fail("ends too early");
  const std::uint64_t length = number_in(all, head.size());
  if (all.size() - start - 8 < length)
    fail("ends too early: it has " + std::to_string(all.size() - start - 8) +
         " bytes of " + std::to_string(length));
  if (all.size() - start - 8 > length) fail("has data after its end");
  const std::size_t end = start + length;
  if (number_in(all, end) != crc64(std::string_view(all).substr(0, end)))
    fail("is damaged: its checksum is wrong");
  return Archive(all.substr(start, length));
}

SavedScene scene_in_checkpoint(const std::string& file) {
  Archive a = read_checkpoint(file);
  SavedScene scene;
  a(scene.name)(scene.text)(scene.step_tolerance);
  return scene;
}

void archive_scene(Archive& a, const Model& m, const Cloth& g) {
  std::string name = m.name, scene = to_scene_file(m);
  const std::uint64_t here = checksum_of(g);
  std::uint64_t cloth = here;
  double tolerance = m.step.tolerance;
  a(name)(scene)(tolerance)(cloth);
  if (!a.loads()) return;
  if (tolerance != m.step.tolerance)
    throw SceneError("restart", "has inner steps of another tolerance");
  const auto there = relevant_lines(scene);
  const auto now = relevant_lines(to_scene_file(m));
  auto quoted = [](const auto& lines, std::size_t k) {
    return k < lines.size() ? lines[k] : "nothing";
  };
  for (std::size_t k = 0; k < std::max(there.size(), now.size()); ++k)
    if (quoted(there, k) != quoted(now, k))
      throw SceneError("restart", "belongs to another scene: it has " +
                                      quoted(there, k) + ", expected " +
                                      quoted(now, k));
  if (cloth != here)
    throw SceneError(
        "restart",
        "belongs to another cloth: the mesh files or the program changed");
}

void archive_cloth(Archive& a, Cloth& g) {
  auto require = [](bool ok) {
    if (!ok) throw std::runtime_error("belongs to another cloth");
  };
  std::vector<char> nodes, edges;  // by id: whether it is in use
  std::vector<unsigned> node_ids, edge_ids, lists;  // by index; at all nodes
  auto each_edge_at = [&g](unsigned id, auto use) {
    for (const auto& to : arrays(g).neighbors(id)) use(to.edge);
  };
  for (unsigned i = 0; i < arrays(g).node_slots(); ++i) {
    nodes.push_back(arrays(g).node_in_use(i));
    each_edge_at(i, [&](unsigned e) { lists.push_back(e); });
  }
  for (unsigned e = 0; e < arrays(g).edge_slots(); ++e)
    edges.push_back(arrays(g).edge_in_use(e));
  for (Node n : g.nodes()) node_ids.push_back(n.id());
  for (Edge e : g.edges()) edge_ids.push_back(e.id());
  a(nodes)(edges)(node_ids)(edge_ids)(lists);
  if (a.loads()) {
    require(nodes.size() == arrays(g).node_slots() &&
            edges.size() == arrays(g).edge_slots());
    for (unsigned e = 0; e < edges.size(); ++e)
      if (!edges[e]) g.remove_edge(arrays(g).edge_with_id(e));
    for (unsigned i = 0; i < nodes.size(); ++i)
      if (!nodes[i]) g.remove_node(arrays(g).node_with_id(i));
    auto require_each_once = [&require](const auto& ids, std::size_t size,
                                        std::size_t slots, auto there) {
      require(ids.size() == size);
      std::vector<char> seen(slots);
      for (unsigned id : ids) {
        require(id < slots && there(id) && !seen[id]);
        seen[id] = true;
      }
    };
    require_each_once(node_ids, g.num_nodes(), nodes.size(),
                      [&g](unsigned id) { return arrays(g).node_in_use(id); });
    require_each_once(edge_ids, g.num_edges(), edges.size(),
                      [&g](unsigned id) { return arrays(g).edge_in_use(id); });
    std::size_t at = 0;
    for (unsigned i = 0; i < nodes.size(); ++i) {
      std::vector<unsigned> now;
      each_edge_at(i, [&](unsigned e) { now.push_back(e); });
      require(lists.size() - at >= now.size());
      const std::span ids(lists.data() + at, now.size());
      at += now.size();
      if (std::ranges::equal(ids, now)) continue;
      require(std::ranges::is_permutation(ids, now));
      arrays(g).reorder_edges(arrays(g).node_with_id(i), ids);
    }
    if (g.num_nodes() < arrays(g).node_slots())
      arrays(g).reindex_nodes(node_ids);
    if (g.num_edges() < arrays(g).edge_slots())
      arrays(g).reindex_edges(edge_ids);
  }
  a(arrays(g).positions())(arrays(g).node_values());
  a.require(are_nodes(arrays(g).positions(), arrays(g).node_values()));
}

}  // namespace lab
