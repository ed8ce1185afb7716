// Export.hpp and --out: what other programs read, read again by other code.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <sstream>

#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Export.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/ReadParts.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;
using CME212::contents;

namespace {

// ------------------------------------------------- A small reader of VTP files

struct Element {
  std::string tag;
  std::map<std::string, std::string> attributes;
  std::string text;
};

/** The elements of an XML file in their order, each with its attributes and
 * what stands before the next tag. Fails unless all tags are closed. */
std::vector<Element> parse_xml(const std::string& xml) {
  std::vector<Element> all;
  std::vector<std::string> open;
  std::size_t at = 0;
  while ((at = xml.find('<', at)) != std::string::npos) {
    const auto end = xml.find('>', at);
    std::string tag = xml.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag[0] == '?') continue;
    if (tag[0] == '/') {
      EXPECT_TRUE(!open.empty() && open.back() == tag.substr(1)) << tag;
      if (!open.empty()) open.pop_back();
      continue;
    }
    std::istringstream in(tag);
    Element e;
    in >> e.tag;
    if (tag.back() != '/') open.push_back(e.tag);
    for (std::string name; in >> std::ws && std::getline(in, name, '=');) {
      std::string value;
      if (in.get() != '"') break;
      std::getline(in, value, '"');
      e.attributes[name] = value;
    }
    e.text = xml.substr(at, xml.find('<', at) - at);
    all.push_back(e);
  }
  EXPECT_TRUE(open.empty());
  return all;
}

std::string from_base64(const std::string& text) {
  std::string bytes;
  unsigned value = 0;
  int bits = 0;
  for (char c : text) {
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (digit < 0) break;
    value = value << 6 | unsigned(digit), bits += 6;
    if (bits >= 8) bits -= 8, bytes += char(value >> bits & 255);
  }
  return bytes;
}

template <typename T>
std::vector<double> numbers(const std::string& bytes) {
  std::vector<double> all;
  for (std::size_t k = 0; k + sizeof(T) <= bytes.size(); k += sizeof(T)) {
    T a;
    std::memcpy(&a, bytes.data() + k, sizeof a);
    all.push_back(double(a));
  }
  return all;
}

/** The arrays of a VTP file, by "Section/Name". */
std::map<std::string, std::vector<double>> arrays_of(const std::string& vtp) {
  std::map<std::string, std::vector<double>> all;
  std::string section;
  for (const Element& e : parse_xml(vtp)) {
    if (e.tag != "DataArray") {
      section = e.tag;
      continue;
    }
    auto attribute = [&](const char* name) { return e.attributes.at(name); };
    auto& values = all[section + '/' + attribute("Name")];
    if (attribute("format") == "ascii") {
      values = {std::stod(e.text)};
      continue;
    }
    EXPECT_EQ(attribute("format"), "binary");
    const std::string bytes = from_base64(e.text), type = attribute("type");
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), 8);
    EXPECT_EQ(size, bytes.size() - 8);
    const std::string data = bytes.substr(8);
    values = type == "Float64"   ? numbers<double>(data)
             : type == "Float32" ? numbers<float>(data)
             : type == "UInt8"   ? numbers<std::uint8_t>(data)
             : type == "Int32"   ? numbers<std::int32_t>(data)
                                 : numbers<std::uint32_t>(data);
  }
  return all;
}

// ---------------------------------------------------------------------- Scenes

/** A sheet of 2 m x 1 m, 3 x 2 cells, in the plane z = 0, held at a corner. */
Model small_model() {
  Model m = with_sheet("u 2 0 0 nodes 4 3 velocity 0 0 -1");
  m.pins = {read_pin("x 0 y 0")};
  m.damping = 0.25;
  return m;
}

TEST(Frame, HasTheStateOfTheScene) {
  Scene scene(small_model());
  Node n = scene.cloth().node(4);  // at (2/3, 0.5, 0)
  n.position().z = 0.5;
  const Frame f = frame_of(scene, nullptr);
  ASSERT_EQ(f.places.size(), 12u);
  EXPECT_EQ(f.places[4], n.position());
  EXPECT_EQ(f.quads, grid_quads(4, 3));
  EXPECT_EQ(f.springs.size(), scene.cloth().num_edges());
  EXPECT_EQ(f.there, std::vector<char>(12, 1));
  EXPECT_EQ(f.pinned[0], 1);
  EXPECT_EQ(std::count(f.pinned.begin(), f.pinned.end(), 1), 1);
  EXPECT_EQ(f.velocities[0], Point());
  EXPECT_EQ(f.velocities[4], Point(0, 0, -1));
  EXPECT_NEAR(f.masses[4], 1 / 12., 1e-15);
  // Weight, drag and the springs of the node, by hand.
  Point force(0, 0, -9.81 / 12 + 0.25);
  double strain = 0;
  for (Edge e : n.edges()) {
    const Point u = e.node2().position() - n.position();
    force += 100 * (norm(u) - e.value().L) / norm(u) * u;
    strain += norm(u) / e.value().L - 1;
  }
  EXPECT_LT(norm(f.forces[4] - force), 1e-12);
  EXPECT_NEAR(f.strains[4], strain / n.degree(), 1e-15);
  EXPECT_GT(f.strains[4], 0.1);
}

// Without a node, and without a side between two that are left.
TEST(Frame, OfATornClothHasWhatIsLeftOfItAndAllPlaces) {
  Scene scene(small_model());
  Cloth& g = scene.cloth();
  g.node(0).position().z = 0.25;
  const Frame before = frame_of(scene, nullptr);
  EXPECT_EQ(before.places[0], Point(0, 0, 0.25));
  const Node last = g.node(11);
  g.remove_node(g.node(0));
  EXPECT_EQ(g.remove_edge(last, g.node(8)), 1u);
  const Frame f = frame_of(scene, &before);
  EXPECT_EQ(f.there[0], 0);
  EXPECT_EQ(f.there[11], 1);
  EXPECT_EQ(f.places, before.places);
  EXPECT_EQ(f.quads,
            (std::vector<Quad>{
                {1, 2, 4, 5}, {3, 4, 6, 7}, {4, 5, 7, 8}, {6, 7, 9, 10}}));
  EXPECT_EQ(f.springs.size(), before.springs.size() - 4);
  for (auto [a, b] : f.springs) EXPECT_TRUE(a > 0 && b > 0 && a < 12 && b < 12);
}

TEST(Vtp, SaysAllThatIsLeft) {
  Scene scene(small_model());
  const Frame before = frame_of(scene, nullptr);
  scene.cloth().node(4).position().z = 0.5;
  scene.cloth().remove_node(scene.cloth().node(0));
  Frame f = frame_of(scene, &before);
  f.time = 0.1;
  auto a = arrays_of(to_file(f, FrameFormat::vtp));
  EXPECT_EQ(a["FieldData/TimeValue"], std::vector<double>{0.1});
  ASSERT_EQ(a["Points/points"].size(), 3u * 11);
  const auto& node = a["PointData/node"];
  ASSERT_EQ(node.size(), 11u);
  for (unsigned k = 0; k < 11; ++k) {
    const auto i = unsigned(node[k]);
    EXPECT_EQ(i, k + 1);
    for (unsigned d = 0; d < 3; ++d) {
      EXPECT_EQ(a["Points/points"][3 * k + d], f.places[i][d]);
      EXPECT_EQ(a["PointData/velocity"][3 * k + d], float(f.velocities[i][d]));
      EXPECT_EQ(a["PointData/force"][3 * k + d], float(f.forces[i][d]));
    }
    EXPECT_EQ(a["PointData/mass"][k], float(f.masses[i]));
    EXPECT_EQ(a["PointData/strain"][k], float(f.strains[i]));
    EXPECT_EQ(a["PointData/pinned"][k], f.pinned[i]);
  }
  const auto& lines = a["Lines/connectivity"];
  const auto& polys = a["Polys/connectivity"];
  ASSERT_EQ(lines.size(), 2 * f.springs.size());
  ASSERT_EQ(polys.size(), 4 * f.quads.size());
  EXPECT_EQ(a["Lines/offsets"].back(), lines.size());
  EXPECT_EQ(a["Polys/offsets"].front(), 4);
  EXPECT_EQ(a["Polys/offsets"].size(), f.quads.size());
  const auto& strain = a["CellData/strain"];
  ASSERT_EQ(strain.size(), f.springs.size() + f.quads.size());
  std::map<std::pair<double, double>, double> of_ends;
  for (std::size_t s = 0; s < f.springs.size(); ++s) {
    EXPECT_EQ(node[std::size_t(lines[2 * s])], f.springs[s][0]);
    EXPECT_EQ(node[std::size_t(lines[2 * s + 1])], f.springs[s][1]);
    EXPECT_EQ(strain[s], float(f.spring_strains[s]));
    of_ends[{lines[2 * s], lines[2 * s + 1]}] = strain[s];
    of_ends[{lines[2 * s + 1], lines[2 * s]}] = strain[s];
  }
  // A quad goes around along its four sides, and has the mean of their strains.
  for (std::size_t q = 0; q < f.quads.size(); ++q) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::pair side{polys[4 * q + k], polys[4 * q + (k + 1) % 4]};
      ASSERT_TRUE(of_ends.count(side));
      sum += of_ends[side];
    }
    EXPECT_NEAR(strain[f.springs.size() + q], sum / 4, 1e-7);
  }
}

TEST(Ply, KeepsTheOrderOfItsPoints) {
  Scene scene(small_model());
  const Frame before = frame_of(scene, nullptr);
  scene.cloth().node(4).position() = Point(0.1, 0.25, 0.5);
  scene.cloth().remove_node(scene.cloth().node(0));
  const Frame f = frame_of(scene, &before);
  EXPECT_EQ(f.places[0], Point());  // gone; where it was last
  const std::string ply = to_file(f, FrameFormat::ply);
  EXPECT_TRUE(has(ply, "element vertex 12\n"));
  EXPECT_TRUE(has(ply, "element face 5\n"));
  const auto body = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size() - body, 12u * 7 * 4 + 5u * (1 + 4 * 4));
  const auto floats = numbers<float>(ply.substr(body, 12 * 7 * 4));
  for (unsigned i = 0; i < 12; ++i) {
    for (unsigned d = 0; d < 3; ++d) {
      EXPECT_EQ(floats[7 * i + d], float(f.places[i][d]));
      EXPECT_EQ(floats[7 * i + 3 + d], float(f.velocities[i][d]));
    }
    EXPECT_EQ(floats[7 * i + 6], float(f.strains[i]));
  }
  const std::string face = ply.substr(body + 12 * 7 * 4, 17);
  EXPECT_EQ(face[0], 4);
  EXPECT_EQ(numbers<std::int32_t>(face.substr(1)),
            (std::vector<double>{1, 4, 5, 2}));
}

// --------------------------------------------------------------------- Folders

TEST(Export, WritesFramesWithTheirTimes) {
  const CME212::TestFolder folder;
  Model m = small_model();
  m.step = {.dt = 0.004};
  Scene scene(m);
  Export frames({{FrameFormat::vtp, folder / "vtp"},
                 {FrameFormat::ply, folder / "ply"},
                 {FrameFormat::ply, ""}},
                30, scene);
  auto look = [&] {
    if (frames.due(scene) || scene.done(0.2)) frames.add(scene);
  };
  look();
  EXPECT_TRUE(scene.run_to(0.2, look));
  EXPECT_EQ(frames.finish(),
            (std::vector<std::string>{"7 frames .vtp in " + folder / "vtp",
                                      "7 frames .ply in " + folder / "ply"}));
  std::vector<double> times;
  for (const Element& e : parse_xml(contents(folder / "vtp/frames.pvd")))
    if (e.tag == "DataSet") {
      times.push_back(std::stod(e.attributes.at("timestep")));
      const auto a =
          arrays_of(contents(folder / ("vtp/" + e.attributes.at("file"))));
      EXPECT_EQ(a.at("FieldData/TimeValue")[0], times.back());
    }
  // The steps next to 0, 1/30, 2/30, ... s
  const std::vector<double> expected = {0,     0.032, 0.068, 0.1,
                                        0.132, 0.168, 0.2};
  ASSERT_EQ(times.size(), expected.size());
  for (std::size_t k = 0; k < times.size(); ++k)
    EXPECT_NEAR(times[k], expected[k], 1e-12);
}

// A run that takes steps back: its notes are those of the states that stay,
// in their order, and the last one is read at the end.
TEST(Settled, ReadsTheStatesThatStay) {
  Model m = small_model();
  m.method = &table::verlet, m.step.rule = StepRule::safe;
  m.sheets = {{.nodes = {20, 20}}}, m.gravity = 100, m.damping = 0;
  m.pins = {Pin{0, 0, {}, {}, {}}, Pin{1, 0, {}, {}, {}}};
  Scene scene(m);
  std::vector<double> times;
  Settled<double> notes(scene.stepper(), [&](double t) { times.push_back(t); });
  EXPECT_TRUE(notes.empty());
  notes.add(scene.time());
  while (!scene.done(5)) {
    scene.step(5);
    notes.add(scene.time());
  }
  EXPECT_GT(scene.control()->report().taken_back, 0);
  EXPECT_LT(times.size(), std::size_t(scene.steps()));
  EXPECT_EQ(*notes.back(), 5);
  notes.finish();
  EXPECT_EQ(notes.back(), nullptr);
  EXPECT_EQ(times.size(), std::size_t(scene.steps()) + 1);
  EXPECT_TRUE(std::ranges::is_sorted(times, std::less_equal()));
}

TEST(Export, BeginsAnewWithTheRun) {
  const CME212::TestFolder folder;
  Scene scene(small_model());
  Export frames({{FrameFormat::ply, folder / "ply"}}, 30, scene);
  frames.add(scene);
  for (int k = 0; k < 3; ++k) scene.step(), frames.add(scene);
  EXPECT_EQ(frames.finish()[0].substr(0, 2), "4 ");
  scene.restart();
  frames.restart();
  frames.add(scene);
  EXPECT_EQ(frames.finish()[0].substr(0, 2), "1 ");
  EXPECT_FALSE(std::filesystem::exists(folder / "ply/frame_000001.ply"));
}

TEST(Export, LeavesOtherFilesAlone) {
  const CME212::TestFolder folder;
  std::filesystem::create_directory(folder / "mine");
  std::ofstream(folder / "mine/frame_000000.vtp") << "mine";
  std::ofstream(folder / "file") << "mine";
  auto error = [&](const std::string& name) {
    return error_of([&] { FrameFolder(folder / name, FrameFormat::vtp); });
  };
  EXPECT_TRUE(has(error("mine"), ": has files in it"));
  EXPECT_EQ(contents(folder / "mine/frame_000000.vtp"), "mine");
  EXPECT_TRUE(begins(error("file"), folder / "file" + ": can't be "));
  EXPECT_TRUE(
      begins(error("no/where"), folder / "no/where" + ": can't be made ("));
  EXPECT_EQ(error("new"), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));  // nothing was written
}

TEST(Export, DoesNotMixItsFramesWithThoseOfAnotherRun) {
  const CME212::TestFolder folder;
  Scene scene(small_model());
  const std::string name = folder / "ply";
  Export one({{FrameFormat::ply, name}}, 30, scene);
  Export other({{FrameFormat::ply, name}}, 30, scene);  // empty still
  one.add(scene);
  one.finish();
  other.add(scene);
  EXPECT_EQ(error_of([&] { other.finish(); }),
            name + "/frame_000000.ply: another run writes frames there");
}

// --------------------------------------------------------------- The mesh left

TEST(MeshLeft, IsReadBackAsTheSameCloth) {
  const CME212::TestFolder folder;
  Scene scene(small_model());
  Cloth& g = scene.cloth();
  ASSERT_TRUE(scene.run_to(0.1));
  g.remove_node(g.node(0));
  const Net left = mesh_left(g, scene.mesh());
  std::ofstream nodes(folder / "end.nodes"), tets(folder / "end.tets");
  write_nodes(nodes, left), write_quads(tets, left);
  nodes.close(), tets.close();
  const auto again = load_mesh(folder / "end.nodes", folder / "end.tets");
  EXPECT_TRUE(again == left);
  ASSERT_EQ(again.points.size(), 11u);
  ASSERT_EQ(again.quads.size(), 5u);
  // In the order of the mesh, whatever indices the nodes have now.
  for (unsigned i = 0; i < 11; ++i) {
    const Node n = arrays(g).node_with_id(scene.mesh().ids[i + 1]);
    EXPECT_EQ(again.points[i], n.position());
    EXPECT_EQ(again.velocities[i], n.value().vel);
  }
  Model next = small_model();
  next.sheets.clear(), next.pins.clear();
  next.nodes = folder / "end.nodes", next.tets = folder / "end.tets";
  Scene cloth(next);
  EXPECT_EQ(cloth.cloth().num_nodes(), g.num_nodes());
  // But for the diagonal of the quad that is gone.
  EXPECT_EQ(cloth.cloth().num_edges(), g.num_edges() - 1);
  EXPECT_TRUE(mesh_left(cloth.cloth(), cloth.mesh()) == left);
}

}  // namespace
