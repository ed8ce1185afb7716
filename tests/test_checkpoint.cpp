/** @file test_checkpoint.cpp
 * A run that goes on from what another saved: the same bits, or an error. */
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "lab/fast/Archive.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/run/Run.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Checkpoint.hpp"
#include "lab/stepping/Scene.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace fs = std::filesystem;

namespace {

TEST(Archive, GivesBackWhatItTook) {
  bool yes = true;
  double pi = 3.25;
  std::vector<Point> points = {Point(1, 2, 3), Point(4, 5, 6)}, none;
  std::string text = "a\0b";
  auto archive = [&](Archive& a) {
    a(yes)(pi)(points)(none)(text)(std::span(points));
  };
  Archive out;
  archive(out);
  yes = false, pi = 0, text.clear(), none = points, points[1] = Point();
  Archive in(out.bytes());
  archive(in);
  EXPECT_TRUE(in.loads() && in.at_end() && yes);
  EXPECT_EQ(pi, 3.25);
  EXPECT_EQ(points, (std::vector{Point(1, 2, 3), Point(4, 5, 6)}));
  EXPECT_EQ(none, std::vector<Point>{});
  EXPECT_EQ(text, "a\0b");
  // Whatever is missing, it says so; and takes no memory for what is not there.
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    Archive half(out.bytes().substr(0, size));
    EXPECT_THROW(archive(half), std::runtime_error) << size;
  }
  std::string huge = out.bytes();
  huge.replace(1 + sizeof pi, 8, 8, '\xff');  // the length of points
  Archive wrong(huge);
  EXPECT_THROW(archive(wrong), std::runtime_error);
}

/** A cloth that moves, with drag, held at one side and pulled at another. */
Model moving_cloth() {
  Model m;
  m.sheets.resize(1);
  m.sheets[0].u = Point(1.1, 0, 0.3);
  m.sheets[0].nodes = {7, 6};
  m.damping = 0.1;
  m.pins.resize(2);
  m.pins[0].x = 0, m.pins[1].x = 1.1;
  m.pins[1].motion = {Point(0.2, 0.1, 0), 0.05};
  m.planes.resize(1);
  m.planes[0].at = Point(0, 0, -0.02);
  return m;
}

// --------------------------------------------------------------------- Scene

/** Scenes that keep something, or lose something. */
std::vector<Model> scenes() {
  std::vector<Model> all;
  Model tears = assignment_scene();
  tears.sheets.resize(1);
  tears.sheets[0].nodes = {8, 8};
  tears.sheets[0].velocity = Point(0, 0, -2);
  tears.tear_strain = 0.2;
  tears.damping = 0.02;
  all.push_back(tears);
  Model pushed = moving_cloth();
  pushed.planes[0].motion = {Point(0, 0, 0.3), 0.1};
  pushed.spheres.resize(1);
  pushed.spheres[0].ball = {Point(0.5, 0.5, -0.15), 0.1};
  pushed.tears = {{Point(0.9, 0.5, 0.2), 0.12}};
  pushed.self_collision = Distance{0.03, 0.1};
  all.push_back(pushed);
  return all;
}

struct State {
  std::vector<Point> x, v;  // by index
  double t;
  unsigned edges;
  EnergyFlow flow;
};
State state_of(const Scene& s) {
  State all{{}, {}, s.time(), s.cloth().num_edges(), s.flow()};
  for (Node n : s.cloth().nodes())
    all.x.push_back(n.position()), all.v.push_back(n.value().vel);
  return all;
}
void expect_same(const State& a, const State& b, const std::string& where) {
  EXPECT_EQ(a.t, b.t) << where;
  EXPECT_EQ(a.edges, b.edges) << where;
  EXPECT_EQ(a.x, b.x) << where;
  EXPECT_EQ(a.v, b.v) << where;
  EXPECT_EQ(a.flow.work, b.flow.work) << where;
  EXPECT_EQ(a.flow.removed, b.flow.removed) << where;
}
std::string saved(Scene& scene) {
  Archive a;
  scene.archive(a);
  return a.bytes();
}
/** @a scene, which is as it was made, from what was saved. */
void load(Scene& scene, const std::string& bytes) {
  Archive a(bytes);
  scene.archive(a);
  EXPECT_TRUE(a.at_end());
  scene.cloth().check_invariants();
}

// Saved at some steps and loaded into another scene each time, a run is the
// same as one in a piece: by every method, torn and not.
TEST(SavedScene, GoesOnToTheSameBitsByEveryMethod) {
  unsigned torn = 0;
  for (const Model& model : scenes())
    for (const MethodEntry& m : methods) {
      const std::string where = std::string(m.info.name) + " of scene " +
                                std::to_string(model.planes.size());
      Model each = model;
      each.method = &m;
      each.step.dt = 0.002;
      Scene whole(each);
      whole.run_to(0.25);
      torn += whole.cloth().num_edges() < arrays(whole.cloth()).edge_slots();
      std::unique_ptr<Scene> part = std::make_unique<Scene>(each);
      int until = 1;
      while (!part->done(0.25)) {
        part->step(0.25);
        if (part->steps() < until) continue;
        until += 23;
        const std::string bytes = saved(*part);
        part = std::make_unique<Scene>(each);
        load(*part, bytes);
        EXPECT_TRUE(saved(*part) == bytes) << where;
      }
      EXPECT_EQ(text_of(part->failure()), text_of(whole.failure()));
      expect_same(state_of(*part), state_of(whole), where);
    }
  EXPECT_GT(torn, methods.size());
}

TEST(SavedScene, GoesOnWithChosenStepsAndFailsAlike) {
  for (const char* dt : {"auto:0.02", "auto:sharp", "0.05"}) {
    for (Model m : scenes()) {
      m.method = &table::verlet;
      m.step = read_time_step(dt);
      Scene whole(m), first(m), second(m);
      whole.run_to(2);
      for (int k = 0; k < 40 && !first.done(2); ++k) first.step(2);
      if (!first.failure()) {
        load(second, saved(first));
        first.run_to(2);
        second.run_to(2);
        EXPECT_EQ(text_of(second.failure()), text_of(whole.failure())) << dt;
        expect_same(state_of(second), state_of(whole), dt);
      }
      EXPECT_EQ(text_of(first.failure()), text_of(whole.failure())) << dt;
      expect_same(state_of(first), state_of(whole), dt);
    }
  }
}

// ---------------------------------------------------------------------- File

TEST(Checkpoint, HasTheChecksumOfTheStandard) {
  EXPECT_EQ(crc64(""), 0u);
  EXPECT_EQ(crc64("123456789"), 0x995DC9BBDF1939FA);
  EXPECT_EQ(crc64("6789", crc64("12345")), 0x995DC9BBDF1939FA);
}

TEST(Checkpoint, IsRefusedWithAnyBitFlippedAndCutAnywhere) {
  const CME212::TestFolder folder;
  const std::string file = folder / "c";
  Scene scene(scenes()[0]);
  Archive a;
  archive_scene(a, scenes()[0], scene.cloth());
  scene.archive(a);
  write_checkpoint(file, a);
  EXPECT_EQ(read_checkpoint(file).bytes(), a.bytes());
  const std::string good = CME212::contents(file);
  auto error_with = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return ::error_of([&] { read_checkpoint(file); });
  };
  std::mt19937 random(1);
  for (int k = 0; k < 500; ++k) {
    std::string bad = good;
    // The first bytes, the last ones, and any.
    const std::size_t at = k < 60    ? std::size_t(k)
                           : k < 100 ? good.size() - std::size_t(k - 59)
                                     : random() % good.size();
    bad[at] = char(bad[at] ^ (1 << random() % 8));
    EXPECT_TRUE(begins(error_with(bad), file + ": ")) << at;
    const std::size_t cut = k < 60 ? std::size_t(k) : random() % good.size();
    EXPECT_TRUE(begins(error_with(good.substr(0, cut)), file + ": ")) << cut;
  }
  EXPECT_EQ(error_with(good + "x"), file + ": has data after its end");
  EXPECT_EQ(error_with(""), file +
                                ": nothing in the file, expected a "
                                "checkpoint");
  EXPECT_EQ(error_with("0 0 0\n"), file + ": is not a checkpoint");
  std::string older = good;
  older.replace(good.find_first_of("0123456789"), 2, "8");
  EXPECT_TRUE(
      begins(error_with(older), file + ": is a \"mass_spring checkpoint 8"));
  EXPECT_EQ(error_with(good.substr(0, good.size() - 3)),
            file + ": ends too early: it has " +
                std::to_string(a.bytes().size() - 3) + " bytes of " +
                std::to_string(a.bytes().size()));
  fs::remove(file);
  EXPECT_EQ(::error_of([&] { read_checkpoint(file); }),
            file +
                ": can't be opened (No such file or directory), expected a "
                "checkpoint");
}

// Words and bytes of a checkpoint that are others, with the checksum of that:
// it is refused, or the run goes on and fails or ends.
TEST(Checkpoint, ThatIsForgedIsRefusedOrGoesOn) {
  const CME212::TestFolder folder;
  const double huge = 1e300, nan = std::nan(""), inf = HUGE_VAL, minus = -1;
  std::vector<std::uint64_t> words = {0, 2, ~0ull, 1ull << 63, 1ull << 62};
  for (double a : {huge, nan, inf, minus, 1e-300})
    words.push_back(std::bit_cast<std::uint64_t>(a));
  constexpr int count = 8;  // of each
  std::mt19937_64 random(1);
  int refused = 0, went_on = 0;
  for (Model m : scenes())
    for (const char* dt : {"0.002", "auto", "auto:sharp"})
      for (const MethodEntry& method : methods) {
        m.sheets[0].nodes = {4, 4};
        m.method = &method, m.step = read_time_step(dt);
        m.t_end = 0.3;
        Options o;
        o.model = m, o.quiet = true, o.checkpoint = folder / "c", o.every = 3;
        o.csv = folder / "e.csv";
        try {
          Scene scene(m);
          lab::Run run(scene, o);
          while (scene.steps() < 50 && !run.done()) run.advance(1);
          if (scene.failure().has_value()) continue;
          run.finish();
        } catch (const std::invalid_argument&) {  // not with this step
          continue;
        }
        const std::string good = CME212::contents(o.checkpoint);
        o.restart = std::exchange(o.checkpoint, "");
        const auto head = good.find('\n') + 9, end = good.size() - 8;
        for (int k = 0; k < count; ++k) {
          std::string bad = good;
          const std::size_t at = head + random() % (end - head - 8);
          if (k % 3 == 0)
            bad[at] = char(random());
          else
            std::memcpy(&bad[at - (at - end) % 8],
                        &words[random() % words.size()], 8);
          const std::uint64_t sum = crc64(bad.substr(0, end));
          std::memcpy(&bad[end], &sum, 8);
          std::ofstream(o.restart, std::ios::binary) << bad;
          Scene scene(m);
          try {
            lab::Run run(scene, o);
            scene.cloth().check_invariants();
            for (int step = 0; step < 40 && !run.done(); ++step) run.advance();
            run.check();
          } catch (const SceneError&) {
            ++refused;
            continue;
          } catch (const std::runtime_error& e) {
            EXPECT_TRUE(has(e.what(), ": "));
            ++refused;
            continue;
          } catch (const std::invalid_argument& e) {
            // Other masses: the method can't do it.
            EXPECT_EQ(std::string(e.what()).find("rkn64: drag over mass"), 0);
            ++refused;
            continue;
          }
          ++went_on;
          ASSERT_TRUE(std::isfinite(energies(scene.cloth(), 1).total()));
          ASSERT_TRUE(std::isfinite(scene.time()));
          ASSERT_GT(scene.dt(), 0);
        }
      }
  EXPECT_GT(refused, 5 * count);
  EXPECT_GT(went_on, 10 * count);
  RecordProperty("refused", refused), RecordProperty("went_on", went_on);
}

TEST(Checkpoint, IsOfOneScene) {
  const Model m = scenes()[0];
  Scene scene(m);
  Archive out;
  archive_scene(out, m, scene.cloth());
  auto error_of = [&](const Model& other) {
    Scene s(other);
    return ::error_of([&] {
      Archive in(out.bytes());
      archive_scene(in, other, s.cloth());
    });
  };
  Model other = m;
  other.t_end = 7, other.tolerance = 0.5;
  EXPECT_EQ(error_of(other), "");
  other.step.dt = 0.002;
  EXPECT_EQ(error_of(other),
            "--restart belongs to another scene: it has dt = \"0.001\", "
            "expected dt = \"0.002\"");
  other = m;
  other.tears.clear();
  EXPECT_TRUE(begins(error_of(other),
                     "--restart belongs to another scene: it has tear"));
  // A damaged file with a right checksum causes no crash either.
  for (const Model& model : scenes()) {
    Scene s(model);
    s.run_to(0.1);
    const std::string bytes = saved(s);
    for (std::size_t size = 0; size < bytes.size(); size += bytes.size() / 50) {
      Scene fresh(model);
      Archive half(bytes.substr(0, size));
      EXPECT_THROW(fresh.archive(half), std::runtime_error) << size;
    }
    Model finer = model;
    finer.sheets[0].nodes = {9, 9};
    Scene foreign(finer);
    Archive in(bytes);
    EXPECT_THROW(foreign.archive(in), std::runtime_error);
  }
}

}  // namespace
