// Mesh.hpp and lab/scenes/MeshFile.hpp: what is read, what is refused and with
// which words, and grids.
#include <gtest/gtest.h>

#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "CME212/Mesh.hpp"
#include "CME212/MeshFaults.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/NetFile.hpp"
#include "tests/TestFolder.hpp"

namespace {

/** What each text of @a all, read by @a read(), is refused for: its error
 * without the name of the file, or as much of it as is expected. */
void refuses(const auto& read,
             std::initializer_list<std::pair<std::string, std::string>> all) {
  for (const auto& [text, expected] : all) {
    const auto error = error_of<InputError>([&, &in = text] { read(in); });
    EXPECT_EQ(error.substr(0, 1 + expected.size()), "f" + expected) << text;
  }
}

const std::string three = ", expected three finite coordinates 'x y z' [m]";

TEST(ParsePoints, SkipsBlankLinesCommentsAndAnyBlanks) {
  const std::vector<Point> two = {{1, 2, 3}, {4, 5, 6}};
  for (const char* text :
       {"# x y z\n\n \t \n\t1\t2  3 \n  # end\n4 5 6", "1 2 3\r\n4 5 6\r\n",
        "1 2 3\r4 5 6\r", "\xEF\xBB\xBF 1 2 3\n4 5 6", "1 2 3# c \\\n4 5 6 #",
        "1 \\\n2\\\r\n3\n4 5 6\\"})
    EXPECT_EQ(parse_points(text, "f"), two) << text;
  EXPECT_EQ(parse_points("0.33333333333333331 4.9406564584124654e-324 0", "f"),
            std::vector{Point(1 / 3., 4.9406564584124654e-324, 0)});
}

TEST(ParsePoints, RefusesEachWrongLineWithItsNumber) {
  refuses([](auto& text) { parse_points(text, "f"); },
          {{"1 2\n", ":1: 2 values in the line" + three},
           {"1 2 3 4\n", ":1: 4 values in the line" + three},
           {"0 0 0\n\n1 2x 3", ":3: '2x' is not a number" + three},
           {"1 2 3\r\n\r\nx 0 0\r\n", ":3: 'x' is not a number" + three},
           {"1 2 \\\n3\n1 2,5 3", ":3: '2,5' is not a number" + three},
           {"+-1 2 3", ":1: '+-1' is not a number" + three},
           {"1 nan 3", ":1: a coordinate is not finite" + three},
           {"1 2 1e999", ":1: '1e999' is out of range" + three},
           {"", ": nothing in the file" + three},
           {"# only\n\n", ":2: nothing in the file" + three},
           {std::string("\x7f\x45LF\0\1\2\n", 8), ":1: '?ELF?"},
           {std::string(1000, 'a'),
            ":1: '" + std::string(24, 'a') + "...' is not a number" + three}});
}

TEST(ParseNodes, TakesVelocitiesInAllLinesOrInNone) {
  auto mesh = lab::parse_nodes("0 1 2\n3 4 5\n", "f");
  EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_TRUE(mesh.velocities.empty());
  mesh = lab::parse_nodes("# p v\n0 1 2 .5 0 -1\n\n3 4 5 0 0 0\n", "f");
  EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(mesh.velocities, (std::vector<Point>{{0.5, 0, -1}, {0, 0, 0}}));
  const std::string either = three + ", and three of a velocity [m/s] or none",
                    six =
                        ", expected six finite numbers 'x y z vx vy vz' [m, "
                        "m/s], as in the first line";
  refuses([](auto& text) { lab::parse_nodes(text, "f"); },
          {{"1 2", ":1: 2 values in the line" + either},
           {"1 2 3 4", ":1: 4 values in the line" + either},
           {"1 2 3 4 5 6 7", ":1: 7 values in the line" + either},
           {"1 2 3\n1 2 3 4 5 6", ":2: 6 values in the line" + three},
           {"1 2 3 4 5 6\n\n1 2 3", ":3: 3 values in the line" + six},
           {"1 2 3 4 nan 6", ":1: a number is not finite" + either},
           {"1 2 3 4 5 6\n1 2 3 4 x 6", ":2: 'x' is not a number" + six},
           {"# none\n", ":1: nothing in the file" + either}});
}

TEST(ParseQuads, TakesFourIndicesALine) {
  auto q = parse_quads("0 1 2 3\n# c\n8 7 6 5\n", "f", 9);
  ASSERT_EQ(q.size(), 2u);
  EXPECT_EQ(q[1], (Quad{8, 7, 6, 5}));
  const std::string four = ", expected four different node indices from 0 to 8",
                    most = "99999999999999999999";
  refuses([](auto& text) { parse_quads(text, "f", 9); },
          {{"0 1 2\n", ":1: 3 values in the line" + four},
           {"0 1 2 3 4\n", ":1: 5 values in the line" + four},
           {"0 1 2 8\n0 1 2 9", ":2: there is no node 9" + four},
           {"0 1 2 -1", ":1: there is no node -1" + four},
           {"0 1 2 1", ":1: node 1 comes twice" + four},
           {"0 1 2 1.5", ":1: '1.5' is not a whole number" + four},
           {"0 1 2 " + most, ":1: '" + most + "' is out of range" + four},
           {"0 1 2 4294967296", ":1: there is no node 4294967296" + four},
           {"", ": nothing in the file" + four}});
}

// --------------------------------------------------- Files of other programs

/** "NODES FACES SPRINGS: ", and the corners of the faces around each. */
std::string shape(const lab::Net& net) {
  std::string text = std::to_string(net.points.size()) + ' ' +
                     std::to_string(net.quads.size()) + ' ' +
                     std::to_string(net.springs.size()) + ':';
  for (const Quad& q : net.quads) {
    text += ' ' + std::to_string(q[0]) + '-' + std::to_string(q[2]) + '-' +
            std::to_string(q[3]);
    if (!lab::is_triangle(q)) text += '-' + std::to_string(q[1]);
  }
  return text;
}

template <typename T>
std::string bytes(std::initializer_list<T> all) {
  std::string text;
  for (T a : all) text.append(reinterpret_cast<const char*>(&a), sizeof a);
  return text;
}

TEST(ParseNet, TakesTheFilesOfOtherPrograms) {
  const std::string v4 = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const std::string off = "0 0 0\n1 0 0\n1 1 0 # c\n0 1 0\n";
  const std::string facets =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
      "vertex 1 1 0\nendloop\nendfacet\nfacet\nouter loop\nvertex -0 0 0\n"
      "vertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  const std::string ply_head =
      "element vertex 3\nproperty float x\nproperty double y\nproperty float "
      "z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty uchar "
      "red\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
      "end_header\n";
  std::string ply;
  for (double k : {0, 1, 2})
    ply += bytes({float(k)}) + bytes({k / 3}) + bytes({0.f});
  ply += bytes<std::uint8_t>({3}) + bytes({0, 1, 2}) +
         bytes<std::uint8_t>({9}) + bytes({0, 2});
  std::string stl = std::string(80, 's') + bytes<std::uint32_t>({1}) +
                    bytes<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}) + "  ";
  const char* const little = std::endian::native == std::endian::little
                                 ? "binary_little_endian"
                                 : "binary_big_endian";
  const std::string stl_2 =
      stl.substr(0, 80) + bytes<std::uint32_t>({2}) + stl.substr(84);
  const std::string faces_first =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int "
      "vertex_index\nelement vertex 3\nproperty float x\nproperty float y\n"
      "element camera 1\nproperty float focus\nelement tristrips 1\nproperty "
      "list int int vertex_indices\nend_header\n3 0 1 2\n0 0\n1 0\n0 1\n1\n";
  std::string capitals = facets;
  for (char& c : capitals) c = char(std::toupper(c));
  struct {
    const char* file;
    std::string text, shape, note = "";
  } const cases[] = {
      {"a.obj", "# x\nmtllib m\no c\n" + v4 + "vt 0 0\nf 1 2 3 4\n",
       "4 1 0: 0-1-2-3"},
      {"a.OBJ", v4 + "vn 0 0 1\r\nf 1/1/1 2/2/1 3/3/1\r\nf 1//1 3//1 4//1\r\n",
       "4 2 0: 0-1-2 0-2-3"},
      {"a.obj", v4 + "f -4 -3 -2\nl 1 2 3\nv 9 9 9\nf -5 -2 -1\n",
       "5 2 2: 0-1-2 0-3-4"},
      // The seam of two quads, split by an export; the last face has no area.
      {"a.obj",
       v4 + "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\n"
            "f 5 6 7 8\nf 2 5 1\n",
       "6 2 0: 0-1-2-3 1-4-5-2",
       "2 of 8 nodes lie at the same point as another one, to 1e-6 of the "
       "size"},
      // Apart by 0.9 of 1e-6 of the size are one node, by 1.1 are not.
      {"a.obj", v4 + "v 1 1.0000012 0\nv 1 1.0000016 0\nf 1 2 5\nf 1 2 6\n",
       "5 2 0: 0-1-2 0-1-4", "1 of 6 nodes lie"},
      {"a.obj", v4 + "fo 1 2 3# c\nf 1 3 \\\n4 # \\\np 1\nsurf 0 1\np 2\n",
       "4 2 0: 0-1-2 0-2-3", "not read: 'p', 'surf'"},
      // A fan from the corner that sees all others; a triangle of four corners.
      {"a.obj", v4 + "v .6 .5 0\nf 2 3 4 5 1\nf 1 2 2 3\nf 1 2 1 3\nf 2 2 2\n",
       "5 4 0: 4-0-1 4-1-2 4-2-3 0-1-2",
       "2 faces with fewer than three different corners: they are left out; 1 "
       "face with more than four corners: it is read as triangles in a fan"},
      {"a.OFF", "OFF4 1 0\n" + off + "4 0 1 2 3\n", "4 1 0: 0-1-2-3"},
      {"a.off", "COFF\n4 2 0\n" + off + "1 0\n3 0 1 2\n", "4 1 0: 0-1-2",
       "1 face with fewer than three different corners: it is left out"},
      {"a.ply", faces_first + "7 0 1 2 -1 2 1 0\n", "3 3 0: 0-1-2 0-1-2 2-1-0",
       "not read: 'camera'"},
      {"a.stl", capitals, "4 2 0: 0-1-2 0-2-3"},
      {"a.stl", stl + "tail", "3 1 0: 0-1-2",
       "not read: 4 bytes behind the last triangle"},
      {"a.off", "OFF\n4 2 0\n" + off + "3 0 1 2\n3 0 2 3 255 0 0\n",
       "4 2 0: 0-1-2 0-2-3"},
      {"a.off", "OFF 4 2 0\n" + off + "4 0 1 2 3\n2 0 2\n", "4 1 1: 0-1-2-3"},
      {"a.stl", facets, "4 2 0: 0-1-2 0-2-3"},
      {"a.stl", stl, "3 1 0: 0-1-2"},
      {"a.ply",
       "ply\nformat ascii 1.0\ncomment c\n" + ply_head +
           "0 0 0\n1 .1 0\n2 .4 0\n3 0 1 2 9\n0 2\n",
       "3 1 1: 0-1-2"},
      {"a.ply",
       std::string("ply\nformat ") + little + " 1.0\n" + ply_head + ply,
       "3 1 1: 0-1-2"}};
  for (const auto& c : cases) {
    const lab::Net net = lab::parse_net(c.text, c.file);
    EXPECT_EQ(shape(net), c.shape) << c.text;
    std::string notes;
    for (const std::string& note : net.notes) notes += note + "; ";
    EXPECT_TRUE(begins(notes, c.note)) << c.text;
    EXPECT_EQ(notes.empty(), c.note.empty()) << c.text << notes;
  }
  EXPECT_EQ(lab::parse_net(std::end(cases)[-1].text, "a.ply").points[2],
            Point(2, 2 / 3., 0));
  refuses([](auto& text) { lab::parse_net(text, "f.stl"); },
          {{stl_2, ".stl: announces 2 triangles, of which 1 is there, "},
           {facets.substr(0, 99), ".stl: ends early, behind 1 triangle, "}});
}

TEST(ParseNet, TakesWhatASpringSystemIs) {
  const std::string text =
      "# a weight below a held node, and a thread\n"
      "node 0 0 0 held\nnode 0 0 -0.5 mass 2 velocity 0 0 1\nnode 1 0 0\n"
      "node 1 1 0\nspring 0 1 50 0.4\nspring 1 2 8\nspring 0 2\n"
      "face 0 1 2\nface 0 2 3 1\nbare-faces\n"
      "spring 1 3 K 5 L 2 cable\nspring 2 3 strut L 0.5\nload 3 0 1 -2\n";
  const lab::Net net = lab::parse_net(text, "a.net");
  EXPECT_EQ(shape(net), "4 2 5: 0-1-2 0-2-3-1");
  EXPECT_EQ(net.springs[3], (lab::Spring{1, 3, 5, 2, lab::Acts::pulls}));
  EXPECT_EQ(net.springs[4], (lab::Spring{2, 3, -1, 0.5, lab::Acts::pushes}));
  EXPECT_EQ(net.loads, (std::vector<lab::Load>{{3, Point(0, 1, -2)}}));
  EXPECT_EQ(net.held, std::vector<unsigned>{0});
  EXPECT_EQ(net.masses, (std::vector<double>{0.25, 2, 0.25, 0.25}));
  EXPECT_EQ(net.velocities[1], Point(0, 0, 1));
  EXPECT_EQ(net.springs[0].L, 0.4);
  EXPECT_LT(net.springs[1].L, 0);
  EXPECT_LT(net.springs[2].K, 0);
  EXPECT_TRUE(net.bare_faces);
  std::ostringstream text_again;
  lab::write_net(text_again, net);
  EXPECT_TRUE(lab::parse_net(text_again.str(), "b.net") == net);
}

TEST(ParseNet, RefusesEachWrongLine) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 2\n",
                    node = "node 0 0 0\nnode 1 0 0\n", end = "end_header\n",
                    ply = "ply\nformat ascii 1.0\nelement vertex ";
  const auto as = [](std::string file) {
    return [=](const std::string& text) { lab::parse_net(text, file); };
  };
  refuses(as("f.obj"),
          {{v + "f 1 2 6\n", ".obj:6: there is no node 6, expected "},
           {v + "f 1 2 0\n", ".obj:6: there is no node 0, "},
           {v + "g a\ncurv 1 2\n",
            ".obj: has 5 nodes, but no face "
            "and no line between them; not read: 'curv', expected "},
           {v + "f 1 2 -6\n", ".obj:6: there is no node -6, "},
           {"v 0 0\n", ".obj:1: 2 coordinates, expected 'v x y z'"},
           {"# no node\n", ".obj: has no node, expected "}});
  refuses(as("f.off"),
          {{"4OFF\n1 0 0\n", ".off:1: '4OFF' begins the file, "},
           {"OFF\n3 1 0\n0 0 0\n", ".off: ends early, expected 'OFF'"},
           {"OFF\n1 0 0\n0 0 0\n1 1 1\n", ".off:4: more lines than"},
           {"OFF\n-1 0 0\n", ".off:2: a number below 0, expected "}});
  refuses(as("f.stl"), {{"nothing\n", ".stl:1: 'nothing' begins the file, "}});
  refuses(as("f.ply"),
          {{"plot\n", ".ply: has no header, expected "},
           {ply + "2\nproperty float x\n" + end + "1\n",
            ".ply:7: 'vertex' 1: the file ends early, expected "},
           {ply + "1\nproperty float x\n" + end + "1\n2\n",
            ".ply:6: more data, expected "},
           {ply +
                "1\nproperty float x\nelement face 1\nproperty list "
                "uchar float vertex_index\n" +
                end + "1\n3 0 0.5 2\n",
            ".ply:9: 'face' 0: there is no node 0.5, expected "},
           {"ply\nformat binary\n" + end,
            ".ply:2: 'binary' is no format, expected "}});
  refuses(as("f.net"),
          {{"node 0 0\n", ".net:1: 2 coordinates, expected 'node x"},
           {"node 0 0 0 fixed\n", ".net:1: 'fixed' in the line, "},
           {"node 0 0 0 mass 0\n", ".net:1: a mass that is not above"},
           {node + "spring 0 2\n", ".net:3: there is no node 2, "},
           {node + "spring 1 1\n", ".net:3: joins node 1 to itself"},
           {node + "spring 0 1 -4\n", ".net:3: '-4' is below 0, "},
           {node + "spring 0 1 nan\n", ".net:3: a number is not fin"},
           {node + "rope 0 1\n", ".net:3: 'rope' begins the line, "}});
  const std::string known =
      ": expected a name that ends in one of .net, .obj, .off, .ply, .stl";
  refuses(as("f.xyz"), {{"", ".xyz" + known}});
  refuses(as("f.vtp"),
          {{"", ".vtp" + known + "; ParaView writes .ply: File, Save Data"}});
}

TEST(LoadMesh, MendsWhatItCanAndSaysSo) {
  const CME212::TestFolder folder;
  const auto load = [&](const char* cells, const std::string& text) {
    std::ofstream(folder / "a.nodes") << "0 0 0\n0 1 0\n1 0 0\n1 1 0\n";
    std::ofstream(folder / cells) << text;
    lab::Net net = lab::load_mesh(folder / "a.nodes", folder / cells);
    return shape(net) + (net.notes.empty() ? "" : " !");
  };
  EXPECT_EQ(load("a.tets", "0 1 2 3\n"), "4 1 0: 0-2-3-1");
  EXPECT_EQ(load("a.tets", "0 1 3 2\n"), "4 1 0: 0-1-3-2 !");  // around
  EXPECT_EQ(load("a.tets", "1 2 3 4\n"), "4 1 0: 0-2-3-1 !");  // from 1
  EXPECT_EQ(load("a.tets", "0 1 2 3\n3 2 1 0\n"), "4 1 0: 0-2-3-1 !");
  EXPECT_EQ(load("a.tris", "0 2 1\n1 2 3\n"), "4 2 0: 0-2-1 1-2-3");
  EXPECT_EQ(load("a.edges", "0 2\n2 3\n0 2\n"), "4 0 3:");
  EXPECT_EQ(load("a.edges", "0 2\n2 3\n2 0\n3 2\n1 0\n"), "4 0 3: !");
  EXPECT_EQ(error_of([&] {
              load("a.edges", "0 1 7\n");
            }).substr((folder / "a.edges").size()),
            ":1: 3 values in the line, expected two different node indices "
            "from 0 to 3; a .net file has K and L, too");
  lab::Net net;
  net.springs = {{0, 1, 5, 1}, {1, 0, 5, 2}, {2, 1}, {1, 2}};
  lab::join_ends(net);
  EXPECT_EQ(net.springs,
            (std::vector<lab::Spring>{{0, 1, 5, 1}, {1, 0, 5, 2}, {1, 2}}));
  EXPECT_THROW(load("a.tris", "1 2 5\n"), InputError);
}

TEST(MeshFaults, AreNamedWithTheirNumber) {
  const auto points = grid_points(3);
  auto quads = grid_quads(3);
  EXPECT_EQ(mesh_faults(points, quads).size(), 0u);
  const auto fault = [](const auto& mesh, const auto& cells) {
    const auto all = mesh_faults(mesh, cells);
    EXPECT_EQ(all.size(), 1u);
    return all.empty() ? "" : all[0].substr(0, all[0].find(':'));
  };
  auto around = quads;
  for (Quad& q : around) std::swap(q[2], q[3]);
  EXPECT_EQ(fault(points, around), "4 of 4 quads have sides that cross");
  for (Quad& q : around) std::swap(q[1], q[2]);
  EXPECT_EQ(fault(points, around), "4 of 4 quads have sides that cross");
  // One corner bent inwards: no two of its sides cross, in any order.
  const std::vector<Point> dart = {
      {0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}};
  EXPECT_EQ(mesh_faults(dart, std::vector{Quad{0, 3, 1, 2}}).size(), 0u);
  const std::vector<Point> trapezoid = {
      {0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {2, 1, 0}};
  EXPECT_EQ(num_around(trapezoid, std::vector{Quad{0, 1, 2, 3}}), 0u);
  EXPECT_EQ(num_around(trapezoid, std::vector{Quad{0, 1, 3, 2}}), 1u);
  auto twice = quads;
  twice.push_back({quads[2][3], quads[2][1], quads[2][2], quads[2][0]});
  EXPECT_EQ(fault(points, twice), "1 face is listed twice, number 4");
  // Each quad with its own corners, one of them off by rounding.
  std::vector<Point> split;
  std::vector<Quad> own;
  for (const Quad& q : quads) {
    const auto k = unsigned(split.size());
    own.push_back({k, k + 1, k + 2, k + 3});
    for (unsigned i : q) split.push_back(points[i]);
  }
  split[1].x += 1e-8;
  EXPECT_EQ(fault(split, own),
            "7 pairs of nodes lie at the same point, nodes 1 and 4 first, and "
            "no spring joins them (an export that splits seams)");
  auto loose = points;
  loose.insert(loose.begin(), Point(5, 5, 5));
  for (Quad& q : quads)
    for (unsigned& i : q) ++i;
  EXPECT_EQ(fault(loose, quads), "1 of 10 nodes lies in no quad, node 0");
}

TEST(Load, SaysWhyAFileCantBeRead) {
  EXPECT_EQ(error_of<InputError>([] { load_points("/no/such.nodes"); }),
            "/no/such.nodes: can't be opened (No such file or directory), "
            "expected a file of points");
  EXPECT_EQ(error_of<InputError>([] { load_quads("/", 4); }),
            "/: a directory, expected a file of quads");
}

// Libraries without from_chars() of a real: the C library's gives the same.
static void same_as_from_chars(const std::string& word) {
  const char *first = word.data(), *last = first + word.size();
  double a = 7, b = 7;
  const auto wanted = std::from_chars(first, last, a);
  const auto got = mesh_detail::real_of_c(first, last, b);
  EXPECT_EQ(wanted.ec, got.ec) << "'" << word << "'";
  EXPECT_EQ(wanted.ptr - first, got.ptr - first) << "'" << word << "'";
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << "'" << word << "'";
}
TEST(Mesh, RealsOfTheCLibraryAreThoseOfFromChars) {
  std::vector<std::string> words = {
      "1",    "-1",  "+1",       "1e",     "1e+5",   "1e-400", "-1e400",
      "1e39", "inf", "INFINITY", "-nan",   "nan(",   ".5",     "5.",
      ".",    "-.",  "",         "--1",    "-+1",    "0x10",   "0X1p3",
      "1,5",  " 1",  "\f1",      "4e-320", "2e-324", "infx",   "0.1"};
  std::mt19937 dice(1);
  const std::string letters = "0123456789..eE+-xinf ";
  for (int k = 0; k < 20000; ++k) {
    std::string& word = words.emplace_back();
    for (auto n = dice() % 8; n; --n) word += letters[dice() % letters.size()];
    double any = std::bit_cast<double>(std::uint64_t(dice()) << 32 | dice());
    words.push_back(std::isfinite(any) ? CME212::short_text(any) : "1");
  }
  for (const std::string& word : words) same_as_from_chars(word);
}

}  // namespace
