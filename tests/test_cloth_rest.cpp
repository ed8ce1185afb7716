// ./cloth --rest and --from-rest.
#include <gtest/gtest.h>

#include "tests/ClothProgram.hpp"
#include "tests/Says.hpp"

namespace {

const std::string sheet = "--sheet 'nodes 6 6' --pin 'x 0 y 0' --headless ";

TEST_F(ClothProgram, RestSaysWhatItFinds) {
  const std::string more = sheet +
                           "--pin 'x 1 y 0' --rest --measure max-stretch "
                           "--csv " +
                           path("e.csv") + " --out " + path("end.net");
  const std::string out = success(more).out;
  for (const char* part : {"at rest: ", "stable: ", "pin x 0 y 0: ", " -4.90",
                           "lowest frequencies [Hz]: 0.", "verlet 0.0",
                           "damped by", "max-stretch: 0."})
    EXPECT_TRUE(has(out, part));
  EXPECT_FALSE(has(out, "half of dt"));
  const auto all = rows(dir / "e.csv");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0][1], 0) << "kinetic energy";
  // The file is at rest.
  EXPECT_TRUE(has(success(path("end.net") + " --rest").out,
                  "after 0 Cholesky factors"));
  EXPECT_EQ(success(more + " --quiet").out, "");
}

TEST_F(ClothProgram, RestNamesWhatMovesFreely) {
  const std::string net = file("a.net",
                               "node 0 0 0 held\nnode 0 0 -1\nnode 1 0 -1\n"
                               "node 2 0 0 held\nspring 0 1\nspring 2 3\n");
  EXPECT_TRUE(has(success(net + " --gravity 0 --rest").out,
                  "no energy holds nodes 1 and 2, which may move freely"));
  EXPECT_TRUE(has(success(file("up.net",
                               "node 0 0 0 held\nnode 0 0 1\n"
                               "spring 0 1\n") +
                          " --rest")
                      .out,
                  "unstable: a motion of node 1 grows e times every 0.3"));
}

TEST_F(ClothProgram, RestRefusesWhatMoves) {
  for (const auto& [options, why] :
       {std::pair("--at '1 unpin 0'", "--rest cannot be combined with --at"),
        {"--advise", "--rest cannot be combined with --advise"},
        {"--pin 'x 1 velocity 1 0 0'", "that of moving pins or obstacles"},
        {"--tear-strain 1", "that of a cloth that tears"},
        {"--self-collision 'thickness 0.1'", "with --self-collision"},
        {"--measure 'max com z'", "--rest cannot be asked for a measure over"}})
    EXPECT_TRUE(has(refusal(sheet + "--rest " + options), why));
  EXPECT_EQ(
      run("--sheet 'nodes 3 3' --gravity 1 --rest --sphere 'at 9 9 9'").err,
      "cloth: no rest: nothing holds node 0, which falls without end\n");
  EXPECT_TRUE(has(refusal(sheet + "--from-rest --self-collision 'thickness "
                                  "0.1'"),
                  "--from-rest cannot be combined with --self-collision"));
}

TEST_F(ClothProgram, FromRestIsTrueOrFalse) {
  EXPECT_TRUE(has(success(sheet + "--dump-config --config " +
                          file("s.toml", "from-rest = true\n"))
                      .out,
                  "from-rest = \"true\""));
  EXPECT_TRUE(has(refusal(sheet + "--from-rest=maybe"), "expected true or"));
}

}  // namespace
