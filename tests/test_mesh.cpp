// Mesh.hpp and lab/scenes/MeshFile.hpp: what is read, what is refused and with
// which words, and grids.
#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "CME212/Mesh.hpp"
#include "lab/scenes/MeshFile.hpp"

namespace {

/** what() of the InputError that @a read throws, or "" */
template <typename F>
std::string error_of(F read) {
  try {
    read();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}
std::string point_error(std::string_view text) {
  return error_of([&] { parse_points(text, "f.nodes"); });
}
std::string quad_error(std::string_view text, std::size_t num_points = 9) {
  return error_of([&] { parse_quads(text, "f.tets", num_points); });
}

const std::string three = ", expected three finite coordinates 'x y z' [m]";
const std::string four = ", expected four different node indices from 0 to 8";

TEST(ParsePoints, TakesNumbersAsOnePointALine) {
  auto p = parse_points("0 1 2\n-0.5 1e-3 +4\n", "f");
  ASSERT_EQ(p.size(), 2u);
  EXPECT_EQ(p[0], Point(0, 1, 2));
  EXPECT_EQ(p[1], Point(-0.5, 0.001, 4));
}

TEST(ParsePoints, SkipsBlankLinesCommentsAndAnyBlanks) {
  auto p = parse_points("# x y z\n\n \t \n\t1\t2  3 \n  # end\n4 5 6", "f");
  ASSERT_EQ(p.size(), 2u);
  EXPECT_EQ(p[0], Point(1, 2, 3));
  EXPECT_EQ(p[1], Point(4, 5, 6));
}

TEST(ParsePoints, TakesTheLineEndsOfAllSystemsAndCountsThemOnce) {
  EXPECT_EQ(parse_points("1 2 3\r\n4 5 6\r\n", "f").size(), 2u);
  EXPECT_EQ(parse_points("1 2 3\r4 5 6\r", "f").size(), 2u);
  EXPECT_EQ(parse_points("\xEF\xBB\xBF"
                         "1 2 3",
                         "f")
                .size(),
            1u);
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
  EXPECT_EQ(point_error("1\n"), "f.nodes:1: 1 value in the line" + three);
  EXPECT_EQ(point_error("1 2 3 4\n"),
            "f.nodes:1: 4 values in the line" + three);
  EXPECT_EQ(point_error("0 0 0\n\n1 2x 3"),
            "f.nodes:3: '2x' is not a number" + three);
  EXPECT_EQ(point_error("1 2,5 3"), "f.nodes:1: '2,5' is not a number" + three);
  EXPECT_EQ(point_error("+-1 2 3"), "f.nodes:1: '+-1' is not a number" + three);
  EXPECT_EQ(point_error("1 nan 3"),
            "f.nodes:1: a coordinate is not finite" + three);
  EXPECT_EQ(point_error("1 2 -inf"),
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
  std::string error =
      point_error(std::string("\x7f"
                              "ELF\0\1\2\n",
                              8));
  EXPECT_EQ(error,
            "f.nodes:1: '?ELF?"
            "?"
            "?' is not a number" +
                three);
  error = point_error(std::string(1000, 'a'));
  EXPECT_EQ(error, "f.nodes:1: '" + std::string(24, 'a') +
                       "...' is not a number" + three);
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
    return error_of([&] { lab::parse_nodes(text, "f.nodes"); });
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

TEST(Load, SaysWhyAFileCantBeRead) {
  EXPECT_EQ(error_of([] { load_points("/no/such.nodes"); }),
            "/no/such.nodes: can't be opened (No such file or directory), "
            "expected a file of points");
  EXPECT_EQ(error_of([] { load_quads("/", 4); }),
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
template <typename T>
static void same_as_from_chars(const std::string& word) {
  const char *first = word.data(), *last = first + word.size();
  T a = 7, b = 7;
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
  for (const std::string& word : words) {
    same_as_from_chars<double>(word);
    same_as_from_chars<float>(word);
  }
}

}  // namespace
