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

TEST_F(ClothProgram, RefusesChangesThatCantBe) {
  EXPECT_EQ(run("--config " +
                file("s.toml", "sheet = 'nodes 3 3'\nat = '3 gravitas'\n"))
                .err,
            path("s.toml") +
                ":2: --at \"3 gravitas\": 'gravitas' is not a request: did "
                "you mean gravity?\n");
  EXPECT_EQ(run(net + "--at '1 gravity 3' --checkpoint " + path("c")).err,
            "cloth: --at cannot be combined with --checkpoint\n");
  EXPECT_EQ(run(net + "--at '1 gravity 3' --tolerance 1e-6").status, 2);
  EXPECT_EQ(files(), std::vector<std::string>{"s.toml"});
}

}  // namespace
