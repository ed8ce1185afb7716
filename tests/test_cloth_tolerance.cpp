// Error control: what is left at the end of a run when its positions are asked
// for to a tolerance, and how ./cloth takes one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "lab/charts/Problem.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/RungeKutta.hpp"
#include "tests/ClothProgram.hpp"

using namespace lab;

namespace {

/** The smooth problems of the charts. */
class Smooth : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Problems, Smooth,
                         ::testing::Values("chain", "curtain", "grid0", "grid1",
                                           "grid1-short", "stiff"),
                         [](const auto& info) {
                           return test_name(info.param);
                         });

TEST_P(Smooth, EndsWithinTheTolerance) {
  const std::vector<Problem> all = make_problems();
  const Problem& p = *std::ranges::find(all, GetParam(), &Problem::name);
  const Reference right = reference(p, p.exact ? 16 : 1.5);
  for (double tolerance : {1e-3, 1e-5, 1e-7}) {
    if (tolerance < 100 * right.floor) continue;
    Rkn64 method(tolerance_share * tolerance);
    const Outcome out = run(p, method, 1);
    ASSERT_TRUE(out.ok()) << out.reason;
    const double error = distance(p, out.end, right.end);
    std::printf("%s to %.0e m: %.1e m, %lld evaluations\n", p.name.c_str(),
                tolerance, error, out.sweeps);
    EXPECT_LT(error, tolerance);
  }
}

using Tolerance = ClothProgram;

TEST_F(Tolerance, ChoosesTheMethodUnlessOneIsGiven) {
  const std::string sheet =
      "--sheet 'at 0 0 0 nodes 6 6' --pin 'x 0' --t-end 0.4 --headless ";
  const auto at_end = [this](const std::string& options) {
    success(options + "--out " + path("end.nodes"));
    return CME212::contents(path("end.nodes"));
  };
  const Result r = run(sheet + "--tolerance 1e-6");
  EXPECT_EQ(r.err, "");
  EXPECT_TRUE(has(r.out,
                  "rkn64 chooses its inner steps by their error, below "
                  "2.5e-07 m per inner step, for 1e-06 m at the end"));
  EXPECT_EQ(at_end(sheet + "--tolerance 1e-6 "),
            at_end(sheet + "--method rkn64 --dt 0.03333333333333333 "
                           "--tolerance 1e-6 "));
  // One that has no error control is taken as it is.
  EXPECT_EQ(at_end(sheet + "--tolerance 1e-6 --method verlet --dt 0.002 "),
            at_end(sheet + "--method verlet --dt 0.002 "));
  EXPECT_TRUE(has(run(sheet + "--tolerance 1e-3 --method rkn64").out,
                  "positions to 0.001 m: kept; measured error"));
  const std::string differs =
      sheet + "--density 0.3 --damping 0.01 --tolerance 1e-3 --verbose ";
  const Result kept = success(differs);
  EXPECT_TRUE(has(kept.out, "a step of verlet"));
  EXPECT_TRUE(has(kept.out, "positions to 0.001 m: kept; "));
  EXPECT_EQ(refusal(differs + "--method rkn64"),
            "cloth: rkn64: drag over mass differs from node to node, expected "
            "the same at all: use rk4, or verlet with --dt auto\n");
}

TEST_F(Tolerance, OneThatNoStepMeetsIsDiagnosedAsSuch) {
  const std::string sheet =
      "--sheet 'at 0 0 0 nodes 6 6' --pin 'x 0' --t-end 0.1 --headless "
      "--tolerance 1e-30 ";
  const Result r = run(sheet);
  EXPECT_EQ(r.status, 3);
  // The cure works if it is typed in.
  const std::size_t end = r.err.find(" works: a trial");
  ASSERT_NE(end, std::string::npos) << r.err;
  const std::size_t begin = r.err.rfind(": --", end) + 2;
  const std::string cure = r.err.substr(begin, end - begin);
  EXPECT_TRUE(begins(cure, "--method verlet --dt ")) << r.err;
  EXPECT_EQ(run(sheet + cure).status, 0) << cure;
}

TEST_F(Tolerance, WarnsBelowTheRoundOffOfPositions) {
  const std::string sheet =
      "--pin 'x 0' --t-end 1e-3 --headless --sheet 'nodes 6 6 at 0 0 ";
  const std::string text = "below the round-off of positions";
  const auto warns = [&](const std::string& more) {
    return run(sheet + more).err.find(text) != std::string::npos;
  };
  EXPECT_TRUE(warns("0' --tolerance 1e-16"));
  EXPECT_FALSE(warns("0' --tolerance 1e-14"));
  EXPECT_TRUE(warns("100' --tolerance 1e-14"));
  EXPECT_FALSE(warns("0' --tolerance 1e-16 --method verlet --dt 1e-3"));
}

TEST_F(Tolerance, NeedsNoStepForAShortRun) {
  const std::string sheet =
      "--sheet 'nodes 6 6' --pin 'x 0' --headless --t-end 1e-4 ";
  for (const char* more : {"", "--tolerance 1e-6", "--method verlet"}) {
    const Result r = success(sheet + more);
    EXPECT_TRUE(has(r.out, " m at t = 0.0001 s\n"));
  }
  EXPECT_NE(refusal(sheet + "--dt 0.002"), "");
}

/** A fall from rest by symplectic Euler is speed a step before it is height. */
TEST_F(Tolerance, OfChosenStepsIsNotBrokenByTheFirstOnes) {
  for (const char* t : {"1e-4", "0.005", "0.01", "0.02", "0.05"})
    EXPECT_EQ(run("--sheet 'nodes 6 6' --dt auto --headless --t-end " +
                  std::string(t))
                  .err,
              "")
        << t;
}

TEST_F(Tolerance, WarnsWhereMotionIsNotSmooth) {
  const std::string sheet =
      "--sheet 'at 0 0 0 nodes 6 6' --t-end 0.1 --headless --tolerance 1e-3 "
      "--method rkn64 ";
  for (const char* part : {"--plane 'at 0 0 -1'", "--tear-strain 3",
                           "--sphere 'at 0.5 0.5 -3 radius 0.5'"})
    EXPECT_TRUE(
        has(run(sheet + part).err,
            "does not control the error where nodes touch or edges break"))
        << part;
  EXPECT_EQ(
      run("--sheet 'nodes 6 6' --t-end 0.1 --headless --tolerance 1e-3 "
          "--method verlet --dt 0.001")
          .err,
      "cloth: warning: --tolerance has no effect on verlet, which does not "
      "control its error: omit --dt and --method, or use --method rkn64\n");
}

}  // namespace
