// ./cloth --at: changes of a scene while it runs.
#include <gtest/gtest.h>

#include "lab/live/Live.hpp"
#include "tests/ClothProgram.hpp"

using namespace lab;

namespace {

const std::string net = "--sheet 'nodes 8 8' --pin 'x 0' --headless ";

TEST_F(ClothProgram, MakesEachChangeAtItsTime) {
  const std::vector<std::string> changes = {
      "0.1004 cut 27 28 35 36", "0.15 gravity 0 0 -3", "0.15 pin 20",
      "0.17 unpin 20", "0.18 method rk4"};
  std::string list;
  for (const std::string& change : changes)
    list += (list.empty() ? "'" : ", '") + change + "'";
  Result r =
      run(net + "--t-end 0.2 --csv " + path("e.csv") + " --every 1 --config " +
          file("s.toml", "at = [" + list + "]\n"));
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_TRUE(has(r.out, "64 nodes and 208 edges left"));
  double before = 0;
  for (const auto& row : rows(dir / "e.csv")) {
    EXPECT_EQ(row[9], row[0] <= 0.1004 ? 210 : 208) << "edges";
    EXPECT_FALSE(before < 0.1004 && row[0] > 0.1004) << "a step ends there";
    before = row[0];
  }
  // From Python and with Live, too: all step a Scene.
  Model m;
  m.sheets = {{.nodes = {8, 8}}};
  m.pins = {{0, {}, {}, {}, {}}};
  m.t_end = 0.2, m.at = changes;
  Live live(m);
  while (live.step()) {
  }
  const auto last = rows(dir / "e.csv").back();
  EXPECT_EQ(energies(live.scene().cloth(), 3).total(), last[4]);
  EXPECT_EQ(live.readings().method, "rk4");
  EXPECT_EQ(live.scene().changes_left(), 0u);
  r = success(net + "--t-end 0.002 --at '0.001 gravity 3' --at '0.0021 pin 5'");
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
  success(net +
          "--gravity 0 --t-end 0.2 --dt auto --method verlet "
          "--at '0.1 stiffness 10000' --csv " +
          path("e.csv") + " --every 1");
  const auto all = rows(dir / "e.csv");
  const double last = all.back()[0] - all[all.size() - 2][0];
  EXPECT_LT(last, limit("--method verlet --stiffness 10000"));
}

TEST_F(ClothProgram, GoesOnWithTheChangesThatWereMade) {
  success(net + "--at '0.03125 unpin 3' --t-end 0.05 --checkpoint " +
          path("c"));
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
  EXPECT_EQ(run(net + "--at '1 pin 3' --advise").err,
            "cloth: --at has pin, which is of one grid or one method: with "
            "advice expected gravity or stiffness\n");
  EXPECT_EQ(files(), std::vector<std::string>{"s.toml"});
}

}  // namespace
