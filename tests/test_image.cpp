/** @file test_image.cpp
 * Tests of Color, GLCamera, Image and Video, which need no display. */
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "CME212/Color.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/Image.hpp"
#include "tests/InPicture.hpp"
#include "tests/ReadPng.hpp"
#include "tests/TestFolder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace CME212;

std::size_t files_in(const TestFolder& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder.path()), {}));
}

// ---------------------------------------------------------- Color and camera

/** Relative luminance, 0 black to 1 white (ITU-R BT.709, sRGB). */
float luminance(const Color& a) {
  auto linear = [](float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
  };
  return 0.2126f * linear(a.r) + 0.7152f * linear(a.g) + 0.0722f * linear(a.b);
}

TEST(Color, StrainScaleDarkensFromRestToBothEnds) {
  for (float sign : {-1.0f, 1.0f}) {
    float before = luminance(Color::make_strain(0));
    for (int i = 1; i <= 1000; ++i) {
      const Color c = Color::make_strain(sign * float(i) / 1000);
      EXPECT_LT(luminance(c), before) << i;
      EXPECT_GT(sign * (c.r - c.b), 0) << i;  // red is taut, blue is slack
      before = luminance(c);
    }
  }
  EXPECT_NEAR(luminance(Color(1)), 1, 1e-6);
  EXPECT_EQ(luminance(Color(0)), 0);
}

TEST(GLCamera, ShowsTheClothUpright) {
  GLCamera c;
  auto x = [&](double px, double py, double pz) {
    return project(c, Point(px, py, pz), 1);
  };
  EXPECT_GT(x(0.5, 0.5, 0).y, x(0.5, 0.5, -1).y);  // z is up
  EXPECT_GT(x(1, 0, 0).x, x(0, 0, 0).x);           // x is to the right
  EXPECT_LT(x(0.5, 0, 0).z, x(0.5, 1, 0).z);       // y is away
  EXPECT_LT(x(0.5, 0, 0).y, x(0.5, 1, 0).y);       // and seen from above
  for (double px : {0.0, 1.0})
    for (double py : {0.0, 1.0})
      for (double pz : {-1.0, 0.0}) {
        EXPECT_LT(std::abs(x(px, py, pz).x), 1);
        EXPECT_LT(std::abs(x(px, py, pz).y), 1);
      }
}

TEST(GLCamera, FitTouchesTheMarginForEveryDirectionAndShape) {
  BoundingBox box = (BoundingBox() |= Point(-1, 2, 3)) |= Point(4, 2.5, 3.1);
  for (double aspect : {0.5, 1.0, 2.0})
    for (Point from : {Point(1, 0, 0), Point(0.3, -1, 0.5), Point(0, 0, 1)}) {
      GLCamera c;
      c.look_from(from);
      c.fit(box, aspect);
      double most = 0;
      for (int i = 0; i < 8; ++i) {
        Point p = project(
            c, Point(i & 1 ? -1 : 4, i & 2 ? 2 : 2.5, i & 4 ? 3 : 3.1), aspect);
        most = std::max({most, std::abs(p.x), std::abs(p.y)});
      }
      EXPECT_NEAR(most, 1 / 1.1, 1e-9);
    }
  GLCamera c, old;
  c.fit(BoundingBox(), 1);  // an empty box changes nothing
  EXPECT_EQ(c.eye(), old.eye());
  c.fit(BoundingBox() |= Point(7, 8, 9), 1);  // one point is in the middle
  EXPECT_NEAR(norm(project(c, Point(7, 8, 9), 1) - Point(0, 0, c.distance())),
              0, 1e-9);
}

TEST(GLCamera, Moves) {
  GLCamera c;
  const GLCamera old = c;
  c.zoom(2);
  EXPECT_DOUBLE_EQ(c.distance(), old.distance() / 2);
  c.zoom(1e9);
  EXPECT_GT(c.distance(), 0);
  c = old;
  c.rotate(0.3, 0);  // what is in front moves to the right
  Point front = old.center() + 0.1 * old.backward();
  EXPECT_GT(project(c, front, 1).x, project(old, front, 1).x);
  EXPECT_DOUBLE_EQ(c.distance(), old.distance());
  c.rotate(0, -9);  // stops above
  EXPECT_NEAR(norm(c.backward() - Point(0, 0, 1)), 0, 1e-12);
  EXPECT_NEAR(norm(c.up()), 1, 1e-12);
  c = old;
  c.pan(0.25, 0);  // by a quarter of the picture, that is 0.5 of [-1, 1]
  EXPECT_NEAR(project(c, old.center(), 1).x, 0.5, 1e-9);
}

// ----------------------------------------------------------- Image and Video

Image test_image(int width, int height, int seed = 0) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = std::uint8_t(i * i / 7 + 31 * std::size_t(seed));
  return image;
}

TEST(Image, SurvivesPng) {
  TestFolder folder;
  for (auto [w, h] : {std::array{1, 1}, {7, 5}, {640, 3}}) {
    Image image = test_image(w, h);
    write_png(folder / "a.png", image);
    EXPECT_EQ(read_png(folder / "a.png"), image);
  }
  // Rows of few colors are long matches, those of many have none.
  std::minstd_rand random(1);
  for (unsigned colors : {1, 2, 40, 256})
    for (int k = 0; k < 20; ++k) {
      Image image(1 + int(random() % 300), 1 + int(random() % 90));
      for (auto& c : image.rgb) c = std::uint8_t(random() % colors);
      write_png(folder / "a.png", image);
      EXPECT_EQ(read_png(folder / "a.png"), image) << colors << ' ' << k;
    }
  EXPECT_EQ(files_in(folder), 1u);  // nothing else is left
}

TEST(Image, SaysWhatIsWrong) {
  TestFolder folder;
  const std::string nowhere = folder / "none/a.png";
  const Image image = test_image(2, 2);
  for (auto& [file, f] : std::map<std::string, std::function<void()>>{
           {nowhere, [&] { write_png(nowhere, image); }},
           {folder / "", [&] { write_png(folder / "", image); }}})
    EXPECT_TRUE(begins(error_of(f), file + ": "));
  write_png(folder / "old.png", image);
  EXPECT_NE(error_of([&] { write_png(folder / "old.png", Image()); }), "");
  EXPECT_EQ(read_png(folder / "old.png"), image);
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(Names, HaveAnEnding) {
  EXPECT_EQ(ending_of("a.b/c.D.PnG"), ".png");
  EXPECT_EQ(ending_of("a.b/c"), "");
  EXPECT_EQ(ending_of("c."), ".");
}

TEST(Video, HasTheFormatOfItsEnding) {
  if (!has_program("ffprobe")) GTEST_SKIP() << "no ffprobe";
  TestFolder folder;
  const std::map<std::string_view, std::string> formats = {
      {".mp4", "h264\nmov,mp4,m4a,3gp,3g2,mj2\n"}, {".gif", "gif\ngif\n"}};
  for (std::string_view ending : film_endings) {
    const std::string file = folder / ("v" + std::string(ending));
    Video video(file, 64, 48, 25);
    for (int i = 0; i < 5; ++i) video.add(test_image(64, 48, i));
    video.finish();
    EXPECT_EQ(output_of("ffprobe -v error -show_entries "
                        "stream=codec_name:format=format_name -of "
                        "default=nk=1:nw=1 " +
                        file),
              formats.at(ending));
  }
}

TEST(Video, MakesAPlayableFile) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "no ffmpeg";
  TestFolder folder;
  // A name that a shell or ffmpeg itself might misread.
  const std::string file = folder / "-a 'b\"; $(touch c) e:f%d.mp4";
  Video video(file, 65, 48, 25);
  for (int i = 0; i < 10; ++i) video.add(test_image(65, 48, i));
  EXPECT_FALSE(fs::exists(file));
  video.finish();
  EXPECT_EQ(video.frames(), 10);
  EXPECT_EQ(files_in(folder), 1u);
  fs::rename(file, folder / "v.mp4");
  if (!has_program("ffprobe")) return;
  EXPECT_EQ(output_of("ffprobe -v error -count_frames -select_streams v "
                      "-show_entries stream=width,height,pix_fmt,r_frame_rate,"
                      "nb_read_frames -of csv=p=0 " +
                      (folder / "v.mp4")),
            "64,48,yuv420p,25/1,10\n");
}

TEST(Video, SaysWhatIsWrong) {
  TestFolder folder;
  EXPECT_TRUE(begins(error_of([&] { Video(folder / "none/v.mp4", 8, 6); }),
                     folder / "none/v.mp4: "));
  {
    Environment path("PATH", (folder / "none").c_str());
    EXPECT_EQ(error_of([&] { Video(folder / "v.mp4", 8, 6); }),
              folder / "v.mp4" +
                  ": no film without ffmpeg, which `make deps` installs");
  }
  EXPECT_EQ(files_in(folder), 0u);
  // An ffmpeg that complains and stops: an error, not a signal.
  std::ofstream(folder / "ffmpeg") << "#!/bin/sh\necho too bad >&2\nexit 3\n";
  fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
  Environment path("PATH", folder.path().c_str());
  Video video(folder / "v.mp4", 800, 600);
  std::string error = error_of([&] {
    for (int i = 0; i < 100; ++i) video.add(test_image(800, 600));
  });
  EXPECT_EQ(error, (folder / "v.mp4: ffmpeg failed: too bad"));
  EXPECT_NE(error_of([&] { video.finish(); }), "");
}

// As ffmpeg does on a full disk: half a film, words, and the status of success.
TEST(Video, KeepsTheOldFilmIfFfmpegOnlySaysThatItFailed) {
  TestFolder folder;
  std::ofstream(folder / "ffmpeg")
      << "#!/bin/sh\nfor to; do :; done\n/bin/cat >/dev/null\n"
         "echo half >\"${to#file:}\"\n"
         "echo 'No space left' >&2\necho 'No trailer' >&2\n";
  fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
  Environment path("PATH", folder.path().c_str());
  const std::string file = folder / "v.mp4";
  std::ofstream(file) << "a good film";
  {
    Video video(file, 64, 48);
    for (int i = 0; i < 5; ++i) video.add(test_image(64, 48, i));
    EXPECT_EQ(error_of([&] { video.finish(); }),
              file + ": ffmpeg failed: No space left");
    EXPECT_EQ(contents(file), "a good film");
  }
  EXPECT_EQ(files_in(folder), 2u);
}

TEST(Video, LeavesNothingIfNotFinished) {
  TestFolder folder;
  if (!has_program("ffmpeg")) GTEST_SKIP() << "no ffmpeg";
  Video(folder / "v.mp4", 8, 6).add(test_image(8, 6));
  EXPECT_EQ(files_in(folder), 0u);
}

}  // namespace
