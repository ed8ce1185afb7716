/** @file test_util.cpp
 * CME212/Util.hpp, Point.hpp, Color.hpp and BoundingBox.hpp. */
#include <gtest/gtest.h>

#include "CME212/BoundingBox.hpp"
#include "CME212/Color.hpp"
#include "CME212/Point.hpp"
#include "CME212/Util.hpp"
#include "tests/TestFolder.hpp"

namespace {

/** A student's class with two operators of its own. */
class Version : private totally_ordered<Version> {
 public:
  explicit Version(int n) : n_(n) {}
  bool operator==(const Version& v) const { return n_ == v.n_; }
  bool operator<(const Version& v) const { return n_ < v.n_; }

 private:
  int n_;
};

// ------------------------------------------------------------- CME212/Util.hpp

TEST(Util, RandomNumbersLieWhereTheyShould) {
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    double u = CME212::random(), v = CME212::random(-2, 5);
    ASSERT_TRUE(0 <= u && u < 1);
    ASSERT_TRUE(-2 <= v && v < 5);
    sum += v;
  }
  EXPECT_NEAR(sum / 10000, 1.5, 0.1);  // five standard deviations
  EXPECT_EQ(CME212::random(3, 3), 3);
}

TEST(Util, GetlineParsedSkipsBlankLinesAndComments) {
  std::istringstream file(
      "# nodes\n0 0 0\n\n   \n\t\n1\t2 3\r\n  # indented\n"
      "-1e-3 +2 .5 # behind\n\n#");
  Point p;
  std::vector<Point> points;
  while (CME212::getline_parsed(file, p)) points.push_back(p);
  EXPECT_EQ(points, (std::vector<Point>{Point(0), Point(1, 2, 3),
                                        Point(-1e-3, 2, .5)}));
}

TEST(Util, GetlineParsedReadsArrays) {
  std::istringstream file("0 1 2 3\n# four\n4 5 6 7");
  std::array<int, 4> t;
  std::vector<std::array<int, 4>> tets;
  while (CME212::getline_parsed(file, t)) tets.push_back(t);
  ASSERT_EQ(tets.size(), 2u);
  EXPECT_EQ(tets[1], (std::array<int, 4>{4, 5, 6, 7}));
}

TEST(Util, GetlineParsedFailsOnJunk) {
  for (std::string junk : {"1 2", "1 2 x", "x", "1,2,3"}) {
    std::istringstream file("0 0 0\n" + junk + "\n5 5 5\n");
    Point p;
    int read = 0;
    while (CME212::getline_parsed(file, p)) ++read;
    EXPECT_EQ(read, 1) << junk;
    EXPECT_TRUE(file.fail());
  }
  std::istringstream file("1 2 3\n");
  std::array<int, 4> t;
  EXPECT_FALSE(CME212::getline_parsed(file, t));
  std::ifstream missing("/no/such/file");
  Point p;
  EXPECT_FALSE(CME212::getline_parsed(missing, p));
}

TEST(Util, TotallyOrderedGivesTheOtherOperators) {
  Version one(1), two(2);
  EXPECT_TRUE(one != two && !(one != one));
  EXPECT_TRUE(two > one && !(one > two) && !(one > one));
  EXPECT_TRUE(one <= two && one <= one && !(two <= one));
  EXPECT_TRUE(two >= one && one >= one && !(one >= two));
}

// ------------------------------------------------------------ CME212/Point.hpp

TEST(PointTest, Arithmetic) {
  const Point a(1, 2, 3), b(4, -5, 6);
  const std::vector<std::pair<Point, Point>> all = {
      {a + b, {5, -3, 9}}, {a - b, {-3, 7, -3}},  {a * b, {4, -10, 18}},
      {+a, {1, 2, 3}},     {b / a, {4, -2.5, 2}}, {-a, {-1, -2, -3}},
      {2 * a, {2, 4, 6}},  {a * 2, {2, 4, 6}},    {a / 2, {.5, 1, 1.5}},
      {a + 1, {2, 3, 4}},  {1 + a, {2, 3, 4}},    {a - 1, {0, 1, 2}},
      {1 - a, {0, -1, -2}}};
  for (std::size_t k = 0; k < all.size(); ++k)
    EXPECT_EQ(all[k].first, all[k].second) << k;
  Point c = a;
  ((c += b) -= Point(1)) *= 2;
  EXPECT_EQ(c /= Point(2, 1, 1), Point(4, -8, 16));
  ((c *= Point(1, 2, 3)) /= 4) += 1;
  EXPECT_EQ(c -= 2, Point(0, -5, 11));
  EXPECT_TRUE(a != b && !(a == b));
}

TEST(PointTest, ProductsAndNorms) {
  const Point x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), a(1, 2, 3), b(4, -5, 6);
  EXPECT_TRUE(cross(x, y) == z && cross(y, z) == x && cross(z, x) == y);
  EXPECT_EQ(cross(a, b), Point(27, 6, -13));
  EXPECT_EQ(dot(a, b), 12);
  EXPECT_EQ(inner_prod(a, b), 12);
  const Point c(2, -3, 6);
  EXPECT_EQ((std::vector{norm(c), norm_2(c), normSq(c), norm_1(c), norm_inf(c),
                         norm(Point())}),
            (std::vector<double>{7, 7, 49, 11, 6, 0}));
}

TEST(PointTest, Elements) {
  EXPECT_EQ(Point(4), Point(4, 4, 4));
  EXPECT_EQ(Point(), Point(0));
  Point a(1, 2, 3);
  const Point& readable = a;
  EXPECT_EQ(a.size(), 3u);
  a[1] = 7;
  EXPECT_EQ(readable[0] + readable[1] + readable[2], 11);
  EXPECT_EQ(std::vector<double>(a.begin(), a.end()),
            (std::vector<double>{1, 7, 3}));
  // By other names.
  EXPECT_EQ(readable.elem[2u], 3);
  EXPECT_EQ(&a.elem[0], &a.x);
  EXPECT_EQ(&a.elem[2l], &a.z);
  EXPECT_EQ(readable.elem + 1, &a.y);
  for (double& x : a.elem) x += 1;
  EXPECT_EQ(a, Point(2, 8, 4));
  EXPECT_EQ(a.data(), &a.x);
  EXPECT_EQ(readable.data()[1], 8);
  a.front() = 5;
  a.back() = 6;
  EXPECT_EQ(a, Point(5, 8, 6));
  EXPECT_EQ(readable.front() + readable.back(), 11);
  EXPECT_EQ(readable.cend() - a.cbegin(), 3);
  EXPECT_EQ(*a.cbegin(), 5);
  // Each of many Points has its own; elem takes no memory.
  std::vector<Point> points(4, a);
  points[2].elem[0] = 0;
  EXPECT_EQ(points[1].x + points[2].x + points[3].x, 10);
  static_assert(sizeof(Point) == 3 * sizeof(double));
  static_assert(std::is_trivially_copyable_v<Point>);
}

TEST(PointTest, WorksInConstantExpressions) {
  constexpr Point a(1, 2, 3);
  constexpr Point b = 2 * a + cross(a, Point(1));
  static_assert(b == Point(1, 6, 5) && b != a && b[1] == 6 && b.back() == 5);
  double Point::*along = &Point::y;
  EXPECT_EQ(a.*along, 2);
}

TEST(PointTest, Streams) {
  std::stringstream s;
  s << Point(1, -2.5, 3);
  EXPECT_EQ(s.str(), "1 -2.5 3");
  Point p;
  EXPECT_TRUE(s >> p);
  EXPECT_EQ(p, Point(1, -2.5, 3));
  std::istringstream bad("1 two 3");
  EXPECT_FALSE(bad >> p);
}

// ---------------------------------------- CME212/Color.hpp and BoundingBox.hpp

void expect_color(CME212::Color c, float r, float g, float b) {
  EXPECT_NEAR(c.r, r, 1e-6);
  EXPECT_NEAR(c.g, g, 1e-6);
  EXPECT_NEAR(c.b, b, 1e-6);
}

TEST(Color, FromRgbAndHueSaturationValue) {
  expect_color(CME212::Color::make_rgb(0.1, 0.2, 0.3), 0.1, 0.2, 0.3);
  auto hue = [](double h) { return CME212::Color::make_hsv(h, 1, 1); };
  expect_color(hue(0), 1, 0, 0);
  expect_color(hue(1. / 12), 1, 0.5, 0);
  expect_color(hue(1. / 6), 1, 1, 0);
  expect_color(hue(1. / 3), 0, 1, 0);
  expect_color(hue(1. / 2), 0, 1, 1);
  expect_color(hue(2. / 3), 0, 0, 1);
  expect_color(hue(5. / 6), 1, 0, 1);
  expect_color(hue(1), 1, 0, 0);
  expect_color(CME212::Color::make_hsv(0.3, 0, 0.7), 0.7, 0.7, 0.7);
  expect_color(CME212::Color::make_hsv(0.3, 1, 0), 0, 0, 0);
  expect_color(CME212::Color::make_hsv(2. / 3, 0.5, 0.8), 0.4, 0.4, 0.8);
}

TEST(Color, HeatGoesFromVioletOverGreenToRed) {
  auto cold = CME212::Color::make_heat(0), hot = CME212::Color::make_heat(1);
  expect_color(cold, 0.68, 0, 1);  // hue 0.78
  expect_color(hot, 1, 0.12, 0);   // hue 0.02
  auto middle = CME212::Color::make_heat((0.78 - 1. / 3) / 0.76);
  expect_color(middle, 0, 1, 0);
  for (int i = 0; i <= 1000; ++i) {
    auto c = CME212::Color::make_heat(i / 1000.f);
    EXPECT_EQ(std::max({c.r, c.g, c.b}), 1);
    EXPECT_EQ(std::min({c.r, c.g, c.b}), 0);
  }
}

/** "EMPTY MIN | MAX | CENTER | DIAGONAL" of @a box. */
std::string text_of(const Box3D& box) {
  std::ostringstream text;
  text << box.empty() << ' ' << box.min() << " | " << box.max() << " | "
       << box.center() << " | " << box.diagonal();
  return text.str();
}
TEST(BoundingBox, HoldsItsPoints) {
  CME212::BoundingBox box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.center(), Point());
  EXPECT_EQ(box.diagonal(), 0);
  box |= Point(1, 2, 3);
  EXPECT_EQ(text_of(box), "0 1 2 3 | 1 2 3 | 1 2 3 | 0");
  box |= Point(3, -2, 7);
  box |= Point(2, 0, 4);
  EXPECT_EQ(text_of(box), "0 1 -2 3 | 3 2 7 | 2 0 5 | 6");
  EXPECT_EQ(text_of(Box3D(Point(4))), "0 4 4 4 | 4 4 4 | 4 4 4 | 0");
  EXPECT_EQ(text_of({Point(1, 6, 2), Point(3, 4, 1)}),
            "0 1 4 1 | 3 6 2 | 2 5 1.5 | 3");
}

TEST(BoundingBox, ContainsPointsAndBoxes) {
  const Box3D box(Point(0), Point(1, 2, 3)), empty;
  for (const Point& p : {Point(0), Point(1, 2, 3), Point(0.5, 1, 2)})
    EXPECT_TRUE(box.contains(p)) << p;
  for (int i = 0; i < 3; ++i)
    for (double outside : {-0.01, 3.01, std::nan("")}) {
      Point p(0.5);
      p[i] = outside;
      EXPECT_FALSE(box.contains(p)) << p;
    }
  for (const Box3D& b : {box, Box3D(Point(0, 0, 1), Point(1)), empty})
    EXPECT_TRUE(box.contains(b));
  for (const Box3D& b :
       {Box3D(Point(0.5), Point(1.5)), Box3D(Point(-0.5), Point(0.5))})
    EXPECT_FALSE(box.contains(b));
  EXPECT_FALSE(empty.contains(Point(0)) || empty.contains(box) ||
               Box3D(Point(0.5)).contains(box));
  EXPECT_TRUE(empty.contains(empty));
}

TEST(BoundingBox, LeavesPointsOutThatAreNotFinite) {
  const double inf = std::numeric_limits<double>::infinity();
  CME212::BoundingBox box;
  box |= Point(0, inf, 0);
  box |= Point(0, 0, std::nan(""));
  box |= Point(-inf, inf, 0);
  EXPECT_TRUE(box.empty());
  box |= Point(1);
  EXPECT_EQ(box.max(), Point(1));
}

}  // namespace
