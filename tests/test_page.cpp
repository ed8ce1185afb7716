/** @file test_page.cpp
 * Tests of the functions that the web page calls, without a browser: lab/page.
 * test_page.py has the rest. */
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/page/Page.hpp"
#include "lab/page/PageScenes.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "tests/Says.hpp"

using namespace lab;

namespace {

unsigned number_of(const char* scene) {
  unsigned k = 0;
  while (std::string(page_scenes()[k]->name) != scene) ++k;
  return k;
}
/** The number that follows "name": in the readings, of side 0 first. */
double reading(const char* name) {
  const std::string all = page_readings(0),
                    key = '"' + std::string(name) + "\":";
  return std::stod(all.substr(all.find(key) + key.size()));
}
unsigned springs() { return page_mesh(0)[0]; }

TEST(PageScenes, HaveTheNodesAskedForAndNoEnd) {
  ASSERT_EQ(page_scenes().size(), 9 + failing_scenes().size());
  for (const StoredScene* s : page_scenes()) {
    Model file = s->model(), page = page_model(*s, 25);
    EXPECT_EQ(page.t_end, no_limit);
    if (always_fails(*s)) {
      page.t_end = file.t_end;
      EXPECT_EQ(to_scene_file(page), to_scene_file(file)) << s->name;
      continue;
    }
    ASSERT_EQ(page.sheets.size(), 1u) << s->name;
    EXPECT_EQ(page.sheets[0].nodes, (std::array{25u, 25u}));
    EXPECT_EQ(page.method, &table::verlet);
    EXPECT_TRUE(page.step.fixed());
    // All else is the file's.
    page.sheets = file.sheets, page.method = file.method;
    page.step = file.step, page.t_end = file.t_end;
    EXPECT_EQ(to_scene_file(page), to_scene_file(file)) << s->name;
  }
}

TEST(PageCalls, ReadTheMeasureOfTheScene) {
  page_load(number_of("membrane"), 9);
  for (int k = 0; k < 40; ++k) page_step();
  double lowest = 1;
  for (unsigned i = 0; i < page_slots(0); ++i)
    lowest = std::min(lowest, double(page_positions(0)[3 * i + 2]));
  const std::string all = page_readings(0),
                    key = R"("measure":"drape-height","unit":"m","answer":[)";
  ASSERT_TRUE(has(all, key));
  EXPECT_NEAR(std::stod(all.substr(all.find(key) + key.size())), lowest,
              0.01 * std::abs(lowest));
}

TEST(PageCalls, WhatIsDrawnIsTheCloth) {
  page_load(number_of("diagonals"), 5);
  // 2 n (n-1) sides, 2 (n-1)^2 diagonals; two triangles a quad; two corners.
  const unsigned* mesh = page_mesh(0);
  EXPECT_EQ(mesh[0], 2 * 5 * 4 + 2 * 4 * 4u);
  EXPECT_EQ(mesh[1], 2 * 4 * 4u);
  EXPECT_EQ(mesh[2], 2u);
  const float* points = page_points(0);
  for (unsigned i = 0; i < 25; ++i) {
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(points[4 * i + unsigned(k)],
                float(page_positions(0)[3 * i + unsigned(k)]));
    EXPECT_NEAR(points[4 * i + 3], 0, 1e-6);  // at rest
  }
}

TEST(PageCalls, AStrokeCutsAndAPinHolds) {
  page_load(number_of("problem1"), 5);
  const unsigned before = springs();
  const double version = page_version(0);
  EXPECT_EQ(page_version(0), version);
  // A plane at x = 0.1, which five sides cross.
  const std::string stroke = "stroke 0.1 -1 1.1 0.1 -1 -1 0.1 2 1.1 0.1 2 -1";
  char* const room = page_room(unsigned(stroke.size()) + 1);
  std::memcpy(room, stroke.c_str(), stroke.size() + 1);
  EXPECT_STREQ(page_request(room), "");
  EXPECT_EQ(springs(), before - 5);
  EXPECT_NE(page_version(0), version);
  page_request("toggle 12");
  EXPECT_EQ(page_mesh(0)[2], 3u);
  page_request("toggle 12");
  EXPECT_EQ(page_mesh(0)[2], 2u);
}

TEST(PageCalls, ARequestThatMakesNoSenseIsNotMade) {
  page_load(number_of("forces"), 5);
  const std::string before = page_recording();
  EXPECT_STREQ(page_request("gravitas 3"),
               "'gravitas' is not a request: did you mean gravity?");
  EXPECT_EQ(page_recording(), before);
  EXPECT_STREQ(page_request("gravity 3"), "");
  const std::string all = page_recording();
  EXPECT_EQ(all.substr(all.rfind("0 gravity")), "0 gravity 3\n0 end\n");
  EXPECT_EQ(reading("gravity"), 3);
}

/** The largest difference between what is drawn and the scene's own state,
 * which is the last good one [m]. */
double beyond() {
  double most = 0;
  const float* points = page_points(0);
  for (unsigned i = 0; i < page_slots(0); ++i)
    for (unsigned k = 0; k < 3; ++k) {
      const double here = page_positions(0)[3 * i + k];
      most = std::max(most, std::abs(double(points[4 * i + k]) - here));
    }
  return most;
}

/** All that the page says of a run of @a scene of up to 40 steps. */
std::string said_of(unsigned scene, const MethodEntry& method, double share) {
  page_load(scene, 5);
  for (const std::string& line : {"method " + std::string(method.info.name),
                                  "step " + CME212::short_text(share)}) {
    char* const room = page_room(unsigned(line.size()) + 1);
    std::memcpy(room, line.c_str(), line.size() + 1);
    page_request(room);
  }
  for (int k = 0; k < 40 && !page_check(); ++k) page_step();
  std::string all = page_readings(0);
  const std::size_t from = all.find("\"warning\":");
  all = all.substr(from, all.find_first_of(",}", from) - from);
  if (page_check()) all += page_failure(0), all += page_explain();
  return all;
}

TEST(PageCalls, NoTextNamesAnOptionOrANumberThatIsNone) {
  int failed = 0, scene = 0;
  for (const MethodEntry& method : methods)
    for (double share : {1.3, 100.}) {
      // Eight scenes whose grid is as small as is asked for.
      const std::string all = said_of(unsigned(scene++ % 8), method, share);
      SCOPED_TRACE(all);
      failed += has(all, "remedy");
      for (const char* none : {"--", "nan", "inf ", "none ms", "undefined"})
        EXPECT_FALSE(has(all, none)) << none;
    }
  EXPECT_GT(failed, 10);
}

TEST(PageCalls, AStepBeyondTheLimitFailsAndIsDrawnBeyond) {
  page_load(number_of("forces"), 5);
  page_request("step 0.9");
  for (int k = 0; k < 300; ++k) page_step();
  EXPECT_EQ(page_check(), 0);
  EXPECT_STREQ(page_failure(0), "null");
  EXPECT_EQ(page_failed_node(0), -1);
  page_load(number_of("forces"), 5);
  page_request("step 2");
  int failed = 0;
  for (int k = 0; k < 300 && !failed; ++k) page_step(), failed = page_check();
  ASSERT_EQ(failed, 1);
  EXPECT_TRUE(has(page_failure(0), "diverged"));
  EXPECT_GE(page_failed_node(0), 0);
  // The steps after it move the cloth further and further.
  EXPECT_LT(beyond(), 1e-6);
  const double time = page_beyond(0, 0), dt = reading("dt");
  unsigned steps = 0;
  for (double before = 0; before < 1; before = beyond()) {
    ++steps;
    EXPECT_NEAR(page_beyond(0, steps), time + steps * dt, 1e-9);
    ASSERT_LT(steps, 100u);
    if (steps > 3) {
      EXPECT_GT(beyond(), before) << steps;
    }
  }
  EXPECT_EQ(page_beyond(0, 0), time);
  EXPECT_LT(beyond(), 1e-6);
  // What fails is known before the reason, and the reason has a cure.
  EXPECT_NEAR(reading("dt") / reading("unit"), 2, 1e-9);
  page_beyond(0, 3);
  const std::string why = page_explain();
  EXPECT_TRUE(has(why, "works"));
  EXPECT_TRUE(has(why, "\"cure\":{\"method\":\"verlet\",\"share\":0."));
  // A change continues from the last good state.
  page_request("step 0.5");
  EXPECT_STREQ(page_failure(0), "null");
  EXPECT_LT(beyond(), 1e-6);
  EXPECT_GT(page_step(), time);
}

}  // namespace
