// Mesh.hpp and lab/scenes/MeshFile.hpp: what is read, what is refused and with
// which words, and grids.
#include <gtest/gtest.h>

#include <bit>
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

std::string point_error(std::string_view text) {
  return error_of<InputError>([&] { parse_points(text, "f.nodes"); });
}
std::string quad_error(std::string_view text, std::size_t num_points = 9) {
  return error_of<InputError>([&] { parse_quads(text, "f.tets", num_points); });
}

const std::string three = ", expected three finite coordinates 'x y z' [m]";
const std::string four = ", expected four different node indices from 0 to 8";

TEST(ParsePoints, SkipsBlankLinesCommentsAndAnyBlanks) {
  auto p = parse_points("# x y z\n\n \t \n\t1\t2  3 \n  # end\n4 5 6", "f");
  ASSERT_EQ(p.size(), 2u);
  EXPECT_EQ(p[0], Point(1, 2, 3));
  EXPECT_EQ(p[1], Point(4, 5, 6));
}

TEST(ParsePoints, TakesTheLineEndsOfAllSystemsAndCountsThemOnce) {
  EXPECT_EQ(parse_points("1 2 3\r\n4 5 6\r\n", "f").size(), 2u);
  EXPECT_EQ(parse_points("1 2 3\r4 5 6\r", "f").size(), 2u);
  EXPECT_EQ(parse_points("\xEF\xBB\xBF 1 2 3", "f").size(), 1u);
  EXPECT_EQ(point_error("1 2 3\r\n\r\nx 0 0\r\n"),
            "f.nodes:3: 'x' is not a number" + three);
}

TEST(ParsePoints, ReadsBackEveryDoubleExactly) {
  double third = 1.0 / 3, tiny = 4.9406564584124654e-324;
  auto p = parse_points("0.33333333333333331 4.9406564584124654e-324 0", "f");
  EXPECT_EQ(p[0], Point(third, tiny, 0));
}

TEST(ParsePoints, RefusesEachWrongLineWithItsNumber) {
  EXPECT_EQ(point_error("1 2\n"), "f.nodes:1: 2 values in the line" + three);
  EXPECT_EQ(point_error("1 2 3 4\n"),
            "f.nodes:1: 4 values in the line" + three);
  EXPECT_EQ(point_error("0 0 0\n\n1 2x 3"),
            "f.nodes:3: '2x' is not a number" + three);
  EXPECT_EQ(point_error("1 2,5 3"), "f.nodes:1: '2,5' is not a number" + three);
  EXPECT_EQ(point_error("+-1 2 3"), "f.nodes:1: '+-1' is not a number" + three);
  EXPECT_EQ(point_error("1 nan 3"),
            "f.nodes:1: a coordinate is not finite" + three);
  EXPECT_EQ(point_error("1 2 1e999"),
            "f.nodes:1: '1e999' is out of range" + three);
}

TEST(ParsePoints, RefusesAFileWithoutPoints) {
  EXPECT_EQ(point_error(""), "f.nodes: nothing in the file" + three);
  EXPECT_EQ(point_error("# only\n\n"),
            "f.nodes:2: nothing in the file" + three);
}

TEST(ParsePoints, ShowsBinaryInputAsPlainText) {
  const std::string elf("\x7f\x45LF\0\1\2\n", 8);
  EXPECT_TRUE(point_error(elf).starts_with("f.nodes:1: '?ELF?"));
  EXPECT_EQ(
      point_error(std::string(1000, 'a')),
      "f.nodes:1: '" + std::string(24, 'a') + "...' is not a number" + three);
}

TEST(ParseNodes, TakesVelocitiesInAllLinesOrInNone) {
  auto mesh = lab::parse_nodes("0 1 2\n3 4 5\n", "f");
  EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_TRUE(mesh.velocities.empty());
  mesh = lab::parse_nodes("# p v\n0 1 2 .5 0 -1\n\n3 4 5 0 0 0\n", "f");
  EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(mesh.velocities, (std::vector<Point>{{0.5, 0, -1}, {0, 0, 0}}));
}
TEST(ParseNodes, RefusesEachWrongLineWithItsNumber) {
  auto error = [](std::string_view text) {
    return error_of<InputError>([&] { lab::parse_nodes(text, "f.nodes"); });
  };
  const std::string either = three + ", and three of a velocity [m/s] or none";
  const std::string six =
      ", expected six finite numbers 'x y z vx vy vz' [m, m/s], as in the "
      "first line";
  EXPECT_EQ(error("1 2 3 4 5 6"), "");
  EXPECT_EQ(error("1 2"), "f.nodes:1: 2 values in the line" + either);
  EXPECT_EQ(error("1 2 3 4"), "f.nodes:1: 4 values in the line" + either);
  EXPECT_EQ(error("1 2 3 4 5 6 7"), "f.nodes:1: 7 values in the line" + either);
  EXPECT_EQ(error("1 2 3\n1 2 3 4 5 6"),
            "f.nodes:2: 6 values in the line" + three);
  EXPECT_EQ(error("1 2 3 4 5 6\n\n1 2 3"),
            "f.nodes:3: 3 values in the line" + six);
  EXPECT_EQ(error("1 2 3 4 nan 6"),
            "f.nodes:1: a velocity is not finite" + either);
  EXPECT_EQ(error("1 2 3 4 5 6\n1 2 3 4 x 6"),
            "f.nodes:2: 'x' is not a number" + six);
  EXPECT_EQ(error("# none\n"), "f.nodes:1: nothing in the file" + either);
}

TEST(ParseQuads, TakesFourIndicesALine) {
  auto q = parse_quads("0 1 2 3\n# c\n8 7 6 5\n", "f", 9);
  ASSERT_EQ(q.size(), 2u);
  EXPECT_EQ(q[1], (Quad{8, 7, 6, 5}));
}

TEST(ParseQuads, RefusesEachWrongLineWithItsNumber) {
  EXPECT_EQ(quad_error("0 1 2\n"), "f.tets:1: 3 values in the line" + four);
  EXPECT_EQ(quad_error("0 1 2 3 4\n"), "f.tets:1: 5 values in the line" + four);
  EXPECT_EQ(quad_error("0 1 2 8"), "");
  EXPECT_EQ(quad_error("0 1 2 3\n0 1 2 9"),
            "f.tets:2: there is no node 9" + four);
  EXPECT_EQ(quad_error("0 1 2 -1"), "f.tets:1: there is no node -1" + four);
  EXPECT_EQ(quad_error("0 1 2 1"), "f.tets:1: node 1 comes twice" + four);
  EXPECT_EQ(quad_error("0 1 2 1.5"),
            "f.tets:1: '1.5' is not a whole number" + four);
  EXPECT_EQ(quad_error("0 1 2 99999999999999999999"),
            "f.tets:1: '99999999999999999999' is out of range" + four);
  EXPECT_EQ(quad_error("0 1 2 4294967296"),
            "f.tets:1: there is no node 4294967296" + four);
  EXPECT_EQ(quad_error(""), "f.tets: nothing in the file" + four);
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
  struct {
    const char* file;
    std::string text, shape;
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
       "6 2 0: 0-1-2-3 1-4-5-2"},
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
  for (const auto& c : cases)
    EXPECT_EQ(shape(lab::parse_net(c.text, c.file)), c.shape) << c.text;
  EXPECT_EQ(lab::parse_net(cases[9].text, "a.ply").points[2],
            Point(2, 2 / 3., 0));
  EXPECT_EQ(lab::parse_net(cases[3].text, "a.obj").notes.size(), 1u);
}

TEST(ParseNet, TakesWhatASpringSystemIs) {
  const std::string text =
      "# a weight below a held node, and a thread\n"
      "node 0 0 0 held\nnode 0 0 -0.5 mass 2 velocity 0 0 1\nnode 1 0 0\n"
      "node 1 1 0\nspring 0 1 50 0.4\nspring 1 2 8\nspring 0 2\n"
      "face 0 1 2\nface 0 2 3 1\nbare-faces\n";
  const lab::Net net = lab::parse_net(text, "a.net");
  EXPECT_EQ(shape(net), "4 2 3: 0-1-2 0-2-3-1");
  EXPECT_EQ(net.held, std::vector<unsigned>{0});
  EXPECT_EQ(net.masses, (std::vector<double>{0.25, 2, 0.25, 0.25}));
  EXPECT_EQ(net.velocities[1], Point(0, 0, 1));
  EXPECT_EQ(net.springs[0].L, 0.4);
  EXPECT_LT(net.springs[1].L, 0);
  EXPECT_LT(net.springs[2].K, 0);
  EXPECT_TRUE(net.bare_faces);
  std::ostringstream text_again;
  lab::write_net(text_again, net);
  const lab::Net again = lab::parse_net(text_again.str(), "b.net");
  EXPECT_EQ(shape(again), shape(net));
  EXPECT_EQ(again.held, net.held);
  EXPECT_EQ(again.masses, net.masses);
  EXPECT_EQ(again.velocities, net.velocities);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(again.springs[k].K < 0, net.springs[k].K < 0);
    EXPECT_EQ(again.springs[k].L < 0, net.springs[k].L < 0);
  }
  EXPECT_EQ(again.springs[0].L, 0.4);
  EXPECT_TRUE(again.bare_faces);
}

TEST(ParseNet, RefusesEachWrongLine) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 2\n",
                    node = "node 0 0 0\nnode 1 0 0\n";
  struct {
    const char* file;
    std::string text, error;
  } const cases[] = {
      {"a.obj", v + "f 1 2 3 4 5\n", "a.obj:6: a face of 5 corners, expected "},
      {"a.obj", v + "f 1 2 6\n", "a.obj:6: there is no node 6, expected "},
      {"a.obj", v + "f 1 2 0\n", "a.obj:6: there is no node 0, expected "},
      {"a.obj", v + "f 1 2 2\n", "a.obj:6: node 2 comes twice, expected "},
      {"a.obj", v + "f 1 2 -6\n", "a.obj:6: there is no node -6, expected "},
      {"a.obj", "v 0 0\n", "a.obj:1: 2 coordinates, expected 'v x y z'"},
      {"a.obj", "# no node\n", "a.obj: has no node, expected "},
      {"a.off", "OFF\n3 1 0\n0 0 0\n", "a.off: ends early, expected 'OFF'"},
      {"a.off", "OFF\n1 0 0\n0 0 0\n1 1 1\n", "a.off:4: more lines than that"},
      {"a.off", "OFF\n-1 0 0\n", "a.off:2: a number below 0, expected 'OFF'"},
      {"a.stl", "solid a\nvertex 0 0 0\n", "a.stl: ends early, expected an "},
      {"a.stl", "nothing\n", "a.stl:1: 'nothing' begins the file, expected "},
      {"a.ply", "plot\n", "a.ply: has no header, expected "},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
       "end_header\n1\n",
       "a.ply:7: 'vertex' 1: the file ends early, expected "},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
       "end_header\n1\n2\n",
       "a.ply:6: more data, expected "},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement "
       "face 1\nproperty list uchar float vertex_index\nend_header\n1\n"
       "3 0 0.5 2\n",
       "a.ply:9: 'face' 0: there is no node 0.5, expected "},
      {"a.ply", "ply\nformat binary\nend_header\n",
       "a.ply:2: 'binary' is no format, expected "},
      {"a.net", "node 0 0\n", "a.net:1: 2 coordinates, expected 'node x y z'"},
      {"a.net", "node 0 0 0 fixed\n",
       "a.net:1: 'fixed' in the line, expected "},
      {"a.net", "node 0 0 0 mass 0\n", "a.net:1: a mass that is not above 0"},
      {"a.net", node + "spring 0 2\n",
       "a.net:3: there is no node 2, expected "},
      {"a.net", node + "spring 1 1\n", "a.net:3: joins node 1 to itself"},
      {"a.net", node + "spring 0 1 -4\n",
       "a.net:3: '-4' is below 0, expected "},
      {"a.net", node + "spring 0 1 nan\n", "a.net:3: a number is not finite"},
      {"a.net", node + "rope 0 1\n", "a.net:3: 'rope' begins the line, "},
      {"a.xyz", "", "a.xyz: expected a name that ends in one of .net, .obj"},
      {"a.vtp", "",
       "a.vtp: expected a name that ends in one of .net, .obj, .off, .ply, "
       ".stl; ParaView writes .ply: File, Save Data"}};
  for (const auto& c : cases)
    EXPECT_EQ(error_of<InputError>([&] {
                lab::parse_net(c.text, c.file);
              }).substr(0, c.error.size()),
              c.error);
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
  EXPECT_EQ(load("a.edges", "0 2\n2 3\n"), "4 0 2:");
  EXPECT_THROW(load("a.edges", "0 4\n"), InputError);
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
  EXPECT_EQ(fault(points, around),
            "4 of 4 quads list the corners around, as a b d c");
  // A trapezoid: the areas between its pairs of corners are 4 and 2.
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

TEST(Grid, HasXOutsideAndYInsideOverTheUnitSquare) {
  auto p = grid_points(5);
  ASSERT_EQ(p.size(), 25u);
  EXPECT_EQ(p[0], Point(0, 0, 0));
  EXPECT_EQ(p[1], Point(0, 0.25, 0));
  EXPECT_EQ(p[5], Point(0.25, 0, 0));
  EXPECT_EQ(p[24], Point(1, 1, 0));
  auto q = grid_quads(5);
  ASSERT_EQ(q.size(), 16u);
  EXPECT_EQ(q[0], (Quad{0, 1, 5, 6}));
  EXPECT_EQ(q[15], (Quad{18, 19, 23, 24}));
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
