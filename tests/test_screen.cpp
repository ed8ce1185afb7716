// lab/viewer/Screen.hpp: one picture of each scene of the assignment at
// a fixed step against the committed one in tests/pictures, of half the size.
// After a change that is meant to be seen: make pictures, look at them, commit
// them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "CME212/viewer/Image.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Scene.hpp"
#include "lab/viewer/Screen.hpp"
#include "tests/ReadPng.hpp"

using namespace lab;

namespace {

using CME212::Image;

struct Frame {
  const char* name;
  int steps;
};
const Frame frames[] = {{"problem1", 600},
                        {"diagonals", 600},
                        {"forces", 700},
                        {"constraints", 450},
                        {"tear", 600}};

/** A scene of the assignment on grid1. */
Model model_of(const std::string& name, double dt = 0.001) {
  Model m = load_open_model("data/scenes/" + name + ".toml");
  m.nodes = "data/grid1.nodes", m.tets = "data/grid1.tets";
  m.step.dt = dt;
  return m;
}

/** What @a screen shows, by way of a file. */
Image picture_of(Screen& screen) {
  auto file = std::filesystem::temp_directory_path() /
              ("mass_spring_" + std::to_string(getpid()) + ".png");
  screen.save_picture(file);
  Image image = read_png(file);
  std::filesystem::remove(file);
  return image;
}

/** The scene after so many steps, and its picture. */
class Picture : public ::testing::TestWithParam<Frame> {
 protected:
  const std::unique_ptr<Screen> screen = Screen::open(Screen::Kind::pictures);

  Image draw() {
    screen->show(scene);
    return picture_of(*screen);
  }
  Scene scene{model_of(GetParam().name)};

  void SetUp() override {
    for (int n = 0; n < GetParam().steps; ++n) ASSERT_TRUE(scene.step());
  }
};

/** @a image at half its size: the mean of each 2 x 2 pixels. */
Image half(const Image& image) {
  Image small(image.width / 2, image.height / 2);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const auto* upper = image.pixel(2 * x, 2 * y);
      const auto* lower = image.pixel(2 * x, 2 * y + 1);
      for (int c = 0; c < 3; ++c)
        small.pixel(x, y)[c] =
            (upper[c] + upper[c + 3] + lower[c] + lower[c + 3] + 2) / 4;
    }
  return small;
}

/** Number of pixels that differ by more than round-off in the colors. */
int difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) return 1 << 30;
  int count = 0;
  for (std::size_t k = 0; k < a.rgb.size(); k += 3) {
    int most = 0;
    for (std::size_t c = k; c < k + 3; ++c)
      most = std::max(most, std::abs(int(a.rgb[c]) - int(b.rgb[c])));
    count += most > 8;
  }
  return count;
}
constexpr int tolerance = 2;  // pixels; the same scene gives the same ones

void expect_committed(const std::string& name, const Image& image) {
  const std::string committed = "tests/pictures/" + name + ".png";
  if (std::getenv("WRITE_PICTURES")) CME212::write_png(committed, half(image));
  int differs = difference(half(image), read_png(committed));
  if (differs > tolerance) CME212::write_png("build/" + name + ".png", image);
  EXPECT_LE(differs, tolerance)
      << "see build/" << name << ".png beside " << committed;
}

TEST_P(Picture, IsTheCommittedOne) {
  expect_committed(GetParam().name, draw());
}
INSTANTIATE_TEST_SUITE_P(Stages, Picture, ::testing::ValuesIn(frames),
                         [](const auto& f) { return f.param.name; });

// A run that fails shows where and why, on its last good state.
TEST(Failure, IsMarkedAndExplainedAsInTheCommittedPicture) {
  const auto screen = Screen::open(Screen::Kind::pictures);
  Scene scene(model_of("problem1", 0.0034));
  screen->show(scene);
  const Image start = picture_of(*screen);
  while (scene.step()) ASSERT_LT(scene.steps(), 1000);
  screen->show(scene);
  expect_committed("fail-path", picture_of(*screen));
  scene.restart();
  screen->show(scene);
  EXPECT_EQ(picture_of(*screen), start);
}

// Cloth stretched by 4 % is red, shrunk by 4 % blue; the scale ends at 5 %.
TEST(Screen, ColorsTellSlackFromTaut) {
  const auto screen = Screen::open(Screen::Kind::pictures);
  screen->show_strain(true);
  Scene scene(model_of("forces"));
  // The red of all pixels without the blue; left of the scale.
  auto red_less_blue = [&](double factor) {
    for (Node n : scene.cloth().nodes()) n.position() *= factor;
    screen->show(scene);
    const Image image = picture_of(*screen);
    long sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width * 3 / 4; ++x)
        sum += image.pixel(x, y)[0] - image.pixel(x, y)[2];
    return double(sum);
  };
  const double rest = red_less_blue(1);
  EXPECT_GT(red_less_blue(1.04), rest + 5e5);
  EXPECT_LT(red_less_blue(0.96 / 1.04), rest - 5e5);
}

// The tolerance is so small that the loss of an edge or of a node is seen.
class Damage : public Picture {};
INSTANTIATE_TEST_SUITE_P(Tear, Damage, ::testing::Values(frames[4]));

TEST_P(Damage, OfOneEdgeOrNodeIsSeen) {
  EXPECT_EQ(difference(draw(), draw()), 0);
  Cloth& g = scene.cloth();
  // Removed, with what is left of it afterwards.
  auto expect_seen = [&](auto remove) {
    Image before = half(draw());
    remove();
    EXPECT_GT(difference(before, half(draw())), tolerance);
  };
  for (unsigned k = 0; k < 5; ++k) {
    Node n = g.node(60 + 100 * k);
    expect_seen([&] { g.remove_edge(*n.edge_begin()); });
    expect_seen([&] { g.remove_node(n); });
  }
}

}  // namespace
