// Runs of ./cloth that go on from a checkpoint. With the same bits and rows
// after a signal or a kill: tests/crossings, promise restart.
#include <gtest/gtest.h>

#include "tests/ClothProgram.hpp"

namespace {

TEST_F(ClothProgram, WritesTheRowsFromTheCheckpointOnInANewTable) {
  const std::string on = "--headless --restart " + path("c") + " --t-end 0.2";
  success(
      "--sheet 'nodes 12 12' --pin 'y 0' --method verlet --headless --t-end "
      "0.1 --checkpoint " +
      path("c") + " --csv " + path("a.csv"));
  EXPECT_TRUE(has(success(on + " --csv " + path("a.csv")).out,
                  path("c") + ": continues at t = "));
  success(on + " --csv " + path("n.csv"));
  const auto all = rows(dir / "a.csv"), later = rows(dir / "n.csv");
  ASSERT_LT(later.size(), all.size());
  ASSERT_GE(later.size(), 9u);
  for (std::size_t k = 1; k <= 9; ++k)
    EXPECT_EQ(later[later.size() - k], all[all.size() - k]);
  // A file of another run is left alone.
  const std::string other = file("other.csv", "mine\n");
  EXPECT_TRUE(begins(
      refusal(on + " --csv " + other),
      "cloth: " + other +
          ": its first rows are not those of the run until the checkpoint "));
  EXPECT_EQ(contents(other), "mine\n");
}

TEST_F(ClothProgram, RefusesCheckpointsThatCantBe) {
  const std::string scene = "--sheet 'nodes 5 5' --headless --t-end 0.1 ";
  EXPECT_EQ(run(scene + "--checkpoint " + path("c")).status, 0);
  const std::string c = path("c");
  EXPECT_EQ(refusal(scene + "--dt 0.002 --restart " + c),
            "cloth: --restart belongs to another scene: it has dt = \"0.001\", "
            "expected dt = \"0.002\"\n");
  EXPECT_EQ(run(scene + "--restart " + c).status, 0);  // to where it is
  EXPECT_EQ(refusal("--headless --t-end 0.05 --restart " + c),
            "cloth: --t-end is 0.05, but " + c +
                " was saved at t = 0.1 s, expected at least that\n");
  EXPECT_EQ(refusal("--restart " + file("no", "text")),
            "cloth: " + path("no") + ": is not a checkpoint\n");
  EXPECT_EQ(refusal("--restart " + path("none")),
            path("none") +
                ": can't be opened (No such file or directory), expected a "
                "checkpoint\n");
  EXPECT_EQ(refusal(scene + "--restart ''"),
            "cloth: --restart: is empty, expected a file name\n");
  EXPECT_EQ(refusal(scene + "--checkpoint " + c + " --csv " + c),
            "cloth: --checkpoint is " + c +
                ", which --csv also writes, expected another file\n");
  EXPECT_TRUE(begins(refusal("--auto --restart " + c),
                     "cloth: --restart cannot be combined"));
  EXPECT_EQ(refusal(scene + "--every-seconds -1"),
            "cloth: --every-seconds is -1, expected 0 or more\n");
  // A mesh that has changed since.
  const std::string nodes = file("n", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string mesh = nodes + ' ' + file("t", "0 1 2 3\n");
  EXPECT_EQ(run(mesh + " --headless --t-end 0.1 --checkpoint " + c).status, 0);
  const std::string moved = path("n2") + ' ' + path("t");
  fs::rename(nodes, path("n2"));
  EXPECT_EQ(run(moved + " --headless --t-end 0.2 --restart " + c).err, "");
  file("n", "0 0 0\n1 0 0\n0 1 0\n1 1 0.001\n");
  EXPECT_EQ(refusal("--headless --restart " + c),
            "cloth: --restart belongs to another cloth: the mesh files or the "
            "program changed\n");
}

}  // namespace
