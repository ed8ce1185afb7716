// The assignment's program as its user meets it, without a window: each stage
// is run, and its status and words are looked at. Build the stages first:
// make all VIEWER=0.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/TestFolder.hpp"

namespace {

namespace fs = std::filesystem;
using Result = CME212::TestFolder::Result;

const char* const stages[] = {"problem1", "diagonals", "forces", "constraints",
                              "tear"};
std::string grid(int n) {
  const std::string name = "data/grid" + std::to_string(n);
  return name + ".nodes " + name + ".tets ";
}

class Driver : public ::testing::Test {
 protected:
  const CME212::TestFolder folder;

  void SetUp() override {
    // Also one that was built with a viewer has nothing to open.
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    unsetenv("SDL_VIDEODRIVER");
    for (const char* stage : stages)
      ASSERT_TRUE(fs::exists(program(stage))) << "make all VIEWER=0";
  }
  static std::string program(const std::string& stage) {
    return CME212::program("mass_spring_" + stage, "./");
  }
  /** Run a stage. Words of @a arguments: as in a shell. */
  Result run(const std::string& arguments, const std::string& stage = "tear") {
    return folder.run("timeout 60 " + program(stage) + " " + arguments);
  }
  /** The words with which a stage refuses @a arguments. */
  std::string refusal(const std::string& arguments,
                      const std::string& stage = "tear") {
    const Result r = run(arguments, stage);
    EXPECT_EQ(r.status, 2) << arguments;
    EXPECT_EQ(r.out, "") << arguments;
    return r.err;
  }
  /** Run the first stage with a square of 1 kg that nothing holds. */
  Result run_loose(const std::string& times) {
    return run(file("n", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n") + " " +
                   file("t", "0 1 2 3\n") + " " + times,
               "problem1");
  }
  /** A file of this test with a content. */
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
};

/** The output of a run without a window. */
struct Lines {
  std::string size, display;  // the first two
  struct Line {
    double t, energy;
    unsigned nodes;
  };
  std::vector<Line> lines;

  explicit Lines(const std::string& text) {
    std::istringstream in(text);
    std::getline(in, size);
    std::getline(in, display);
    for (std::string line; std::getline(in, line);) {
      Line l{};
      int end = 0;
      EXPECT_EQ(std::sscanf(line.c_str(), "t = %lf s, energy %lf J, %u nodes%n",
                            &l.t, &l.energy, &l.nodes, &end),
                3)
          << line;
      EXPECT_EQ(std::size_t(end), line.size()) << line;
      lines.push_back(l);
    }
  }
};

TEST_F(Driver, RunsEveryStageToItsEnd) {
  for (const std::string stage : stages) {
    Result r = run(grid(0), stage);
    EXPECT_EQ(r.status, 0) << stage;
    EXPECT_EQ(r.err, "") << stage;
    const Lines said(r.out);
    EXPECT_EQ(said.size, std::string("25 nodes, ") +
                             (stage == "problem1" ? "40" : "72") +
                             " edges, 5000 steps of 0.001 s");
    EXPECT_EQ(said.display,
              "no display: built without a window; running without a window");
    ASSERT_EQ(said.lines.size(), 11u) << stage;  // every half second
    for (std::size_t k = 0; k < said.lines.size(); ++k) {
      EXPECT_NEAR(said.lines[k].t, 0.5 * double(k), 1e-6) << stage;
      // It starts at rest at z = 0; only contact takes energy away.
      EXPECT_LT(said.lines[k].energy, 0.1) << stage;
      EXPECT_GT(said.lines[k].energy, -9.81) << stage;
    }
    EXPECT_EQ(said.lines.front().energy, 0);
    EXPECT_EQ(said.lines.front().nodes, 25u);
    const bool free = stage != "constraints" && stage != "tear";
    EXPECT_EQ(said.lines.back().energy > -0.1, free) << stage;  // no drag
    EXPECT_EQ(said.lines.back().nodes < 25, stage == "tear") << stage;
  }
}

TEST_F(Driver, RefusesAStepBeyondTheEndAndOneTooShort) {
  for (const char* times : {"0.01 0.004", "1e-20", "6"})
    EXPECT_TRUE(has(refusal(grid(0) + times), "expected at most T_END"));
  EXPECT_EQ(run(grid(0) + "0.25 0.25").status, 0);  // one step
}

// In equal steps of at most DT, as many as that takes.
TEST_F(Driver, EndsAtTheEndThatIsAskedFor) {
  const struct {
    const char *times, *steps;
    double end;
  } cases[] = {{"0.3 0.5", "2 steps of 0.25 s", 0.5},
               {"0.3 0.3", "1 steps of 0.3 s", 0.3},
               {"0.007 0.05", "8 steps of 0.00625 s", 0.05},
               {"0.1 1.1", "11 steps of 0.1 s", 1.1}};  // 1.1 / 0.1 > 11
  for (const auto& [times, steps, end] : cases) {
    const Result r = run_loose(times);
    EXPECT_EQ(r.status, 0) << r.err;
    const Lines said(r.out);
    EXPECT_EQ(said.size, std::string("4 nodes, 4 edges, ") + steps);
    ASSERT_FALSE(said.lines.empty());
    EXPECT_NEAR(said.lines.back().t, end, 1e-6);
  }
}

// 1 kg falls freely: after n steps v = -n g dt and z = 1 - n (n - 1) g dt^2 /
// 2, so the energy has grown by n (g dt)^2 / 2; that is no divergence.
TEST_F(Driver, LetsALooseClothFallFreely) {
  for (const double dt : {0.001, 0.05, 5.0}) {
    const Result r = run_loose(std::to_string(dt));
    EXPECT_EQ(r.status, 0) << r.err;
    const double energy = 9.81 + 5 / dt * std::pow(9.81 * dt, 2) / 2;
    const auto lines = Lines(r.out).lines;
    ASSERT_FALSE(lines.empty());
    EXPECT_NEAR(lines.back().energy, energy, 1e-4 * energy);
  }
}

TEST_F(Driver, SaysHowItIsUsed) {
  for (const char* arguments : {"", "data/grid0.nodes", "a b 0.1 1 5"})
    EXPECT_EQ(refusal(arguments),
              "usage: ./mass_spring NODES TETS [DT [T_END]]\n");
  for (const char* number : {"0", "-1", "nan", "inf", "x", "0.001x", "''"}) {
    const std::string said = refusal(grid(0) + number);
    EXPECT_TRUE(begins(said, "DT is '"));
    EXPECT_TRUE(has(said, "', expected a time [s], more than 0\n"));
    EXPECT_TRUE(begins(refusal(grid(0) + "0.001 " + number), "T_END is '"));
  }
}

TEST_F(Driver, RefusesBadInputWithFileAndLine) {
  auto bad = [this](const std::string& nodes, const std::string& tets,
                    const std::string& message) {
    for (const char* stage : {"problem1", "tear"}) {
      const std::string said = refusal(nodes + " " + tets, stage);
      EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
      EXPECT_TRUE(begins(said, message));
      EXPECT_TRUE(has(said, ", expected "));
    }
  };
  const std::string nodes = file("n", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string tets = file("t", "0 1 2 3\n");
  auto points = [this](const char* text) { return file("bad", text); };
  const std::string at = folder / "bad:", none = folder / "none";
  bad(none, tets, none + ": can't be opened (No such file");
  bad(folder.path().string(), tets, folder.path().string() + ": a directory");
  bad(points("0 0 0\n0 x 0\n"), tets, at + "2: 'x' is not a number");
  bad(points("0 0 0 0\n"), tets, at + "1: 4 values in the line");
  bad(nodes, points("0 1 2 4\n"), at + "1: there is no node 4");
  bad(nodes, points("#\n0 1 2 -3\n"), at + "2: there is no node -3");
  EXPECT_EQ(run(nodes + " " + tets + " 0.001 0.01").status, 0);
}

// The usual step of 0.001 s is too long for grid3; others by little and by
// much, and in a run that ends before anything overflows.
TEST_F(Driver, StopsWhenItDivergesAndSaysWhenAndWhatHelps) {
  const struct {
    int n;
    const char* times;
    double latest;  // [s]
  } cases[] = {{3, "", 0.5},
               {1, "0.003 0.3", 0.3},
               {1, "0.003", 0.9},
               {0, "0.02 2", 2},
               {0, "0.2 5", 5}};
  for (const std::string stage : stages)
    for (const auto& [n, times, latest] : cases) {
      if (stage == "problem1" && n == 1 && latest == 0.3) continue;  // 0.4 s
      const Result r = run(grid(n) + times, stage);
      const std::string what = stage + " " + grid(n) + times;
      EXPECT_EQ(r.status, 3) << what;
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 3) << r.err;
      double t = 0;
      int end = 0;
      EXPECT_EQ(
          std::sscanf(r.err.c_str(), "diverged: at t = %lf s %n", &t, &end), 1)
          << what << r.err;
      EXPECT_GT(t, 0.01) << what;
      EXPECT_LE(t, latest) << what;
      double dt = 0, stable = 0;
      EXPECT_EQ(std::sscanf(r.err.c_str() + end,
                            "it gains energy from nothing\ndt is %lf s, "
                            "2/omega of this cloth about %lf s; try\n",
                            &dt, &stable),
                2)
          << what << r.err;
      EXPECT_LT(stable, dt) << what;
      const auto command = r.err.find("\n  ") + 3;
      EXPECT_EQ(folder.run("timeout 60 " + r.err.substr(command)).status, 0)
          << r.err;
      // Nothing that a reader could take for a result.
      for (const auto& line : Lines(r.out).lines)
        EXPECT_LT(std::abs(line.energy), 1000) << what;
    }
}

// Steps of 0.9 times those at which the first stage diverges: nothing stops.
TEST_F(Driver, LetsHealthyRunsEnd) {
  for (const std::string stage : stages)
    for (const char* times : {"0 0.013", "1 0.0023", "2 0.001 3", "3 0.0005 1"})
      EXPECT_EQ(run(grid(times[0] - '0') + (times + 2), stage).status, 0)
          << stage << " grid" << times;
}

}  // namespace
