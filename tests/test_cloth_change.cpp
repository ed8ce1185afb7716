// ./cloth --at: changes of a scene while it runs.
#include <gtest/gtest.h>

#include "lab/live/Live.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "tests/ClothProgram.hpp"

using namespace lab;

namespace {

const std::string net = "--sheet 'nodes 8 8' --pin 'x 0' --headless ";

TEST_F(ClothProgram, ChangesASceneAsTheLibraryDoes) {
  const std::vector<std::string> changes = {
      "0.1 grab 63 1 1 0.5",  "0.1 cut 27 28 35 36", "0.15 gravity 0 0 -3",
      "0.15 compare rk4 0.5", "0.17 pin 20",         "0.17 release"};
  Model m;
  m.sheets = {{.nodes = {8, 8}}};
  m.pins = {{0, {}, {}, {}, {}}};
  m.t_end = 0.2, m.at = changes;
  Live live(m);
  while (live.step()) {
  }
  std::ostringstream nodes;
  write_nodes(nodes, mesh_left(live.scene().cloth(), live.scene().mesh()));
  std::string list;
  for (const std::string& change : changes)
    list += (list.empty() ? "'" : ", '") + change + "'";
  Result r = run(net + "--t-end 0.2 --csv " + path("e.csv") + " --out " +
                 path("end.nodes") + " --config " +
                 file("s.toml", "at = [" + list + "]\n"));
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(has(r.out, "64 nodes and 208 edges left"));
  EXPECT_EQ(contents(path("end.nodes")), nodes.str());
  EXPECT_EQ(rows(dir / "e.csv").back()[9], 208);
  r = run(net + "--t-end 0.002 --at '0.001 gravity 3' --at '0.0021 pin 5'");
  EXPECT_EQ(r.status, 0);
  EXPECT_EQ(r.err, "cloth: warning: 1 change would come after the end\n");
}

TEST_F(ClothProgram, KnowsTheStiffestStretchBeforeItStarts) {
  const auto limit = [this](const std::string& options) {
    const std::string out = run(net + "--t-end 0.01 " + options).out;
    const std::string before = "of the stability limit (";
    return std::stod("0" + out.substr(out.find(before) + before.size()));
  };
  const std::string soft = "--at '0.002 stiffness 25' ";
  EXPECT_EQ(limit(soft), limit(""));
  EXPECT_EQ(limit(soft + "--at '0.004 stiffness 1600'"),
            limit("--stiffness 1600"));
  EXPECT_TRUE(has(run(net + "--t-end 0.01 --at '0.004 stiffness 1600'").out,
                  ", symplectic-euler) from t = 0.004 s on"));
  // A step that is chosen is chosen anew.
  const Result r = run(net +
                       "--gravity 0 --t-end 0.2 --dt auto --method verlet "
                       "--at '0.1 stiffness 10000' --csv " +
                       path("e.csv") + " --every 1");
  EXPECT_EQ(r.status, 0) << r.err;
  const auto all = rows(dir / "e.csv");
  const double last = all.back()[0] - all[all.size() - 2][0];
  EXPECT_LT(last, limit("--method verlet --stiffness 10000"));
}

TEST_F(ClothProgram, CountsEnergyByTheForcesOfItsTime) {
  const Result r = run(net +
                       "--t-end 0.4 --method verlet --measure energy "
                       "--at '0.2 gravity -5' --csv " +
                       path("e.csv"));
  EXPECT_EQ(r.status, 0) << r.err;
  const auto last = rows(dir / "e.csv").back();
  EXPECT_GT(last[3], 0) << "below 0 it weighs upwards";
  EXPECT_NEAR(last[12], 0, 1e-3) << "the balance";
  EXPECT_NEAR(last[4], last[1] + last[2] + last[3], 1e-5);
  EXPECT_TRUE(has(r.out, "energy: "));
}

TEST_F(ClothProgram, GoesOnAfterChangesToTheSameBits) {
  const std::string scene =
      net +
      "--dt 0.00390625 --method verlet --at '0.03125 unpin 3' "
      "--at '0.0625 stiffness 300' --at '0.0625 cut 27 28' "
      "--at '0.125 gravity 3' ";
  const auto end = [this](const std::string& options) {
    const Result r = run(options + " --out " + path("end.net"));
    EXPECT_EQ(r.status, 0) << r.err;
    return contents(path("end.net"));
  };
  const std::string right = end(scene + "--t-end 0.25");
  for (const char* when : {"0.046875", "0.0625", "0.09375", "0.1875"}) {
    end(scene + "--t-end " + when + " --checkpoint " + path("c"));
    EXPECT_EQ(end("--headless --t-end 0.25 --restart " + path("c")), right)
        << when;
  }
  const Result r =
      run("--headless --t-end 0.25 --at '0.03125 unpin 4' "
          "--restart " +
          path("c"));
  EXPECT_EQ(r.err,
            "cloth: --at does not begin with the changes that were made "
            "until the checkpoint\n");
}

TEST_F(ClothProgram, RefusesChangesThatCantBe) {
  EXPECT_EQ(run("--config " +
                file("s.toml", "sheet = 'nodes 3 3'\nat = '3 gravitas'\n"))
                .err,
            path("s.toml") +
                ":2: --at \"3 gravitas\": 'gravitas' is not a request: did "
                "you mean gravity?\n");
  EXPECT_EQ(
      run(net + "--at '1 pin 3' --checkpoint " + path("c")).err,
      "cloth: --at has pin, which --checkpoint and --restart do not keep: "
      "expected cut, drag, gravity, method, stiffness or unpin\n");
  EXPECT_EQ(run(net + "--at '1 gravity 3' --tolerance 1e-6").status, 2);
  EXPECT_EQ(files(), std::vector<std::string>{"s.toml"});
}

}  // namespace
