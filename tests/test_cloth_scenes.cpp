// Scenes of ./cloth as its user meets them: files and options of a scene, what
// is asked of it, and advice.
#include <gtest/gtest.h>

#include "lab/advice/Advice.hpp"
#include "tests/ClothProgram.hpp"

namespace {

const std::string sheet = "--sheet 'nodes 9 9' --headless --t-end 0.01 ";

/** Is @a name a scene of the assignment? These leave the mesh open. */
bool is_stage(const std::string& name) {
  return std::ranges::find(stages, name) != stages.end();
}
std::string mesh_for(const std::string& name) {
  return is_stage(name) ? " data/grid1.nodes data/grid1.tets " : "";
}

TEST_F(ClothProgram, RunsEveryShippedScene) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("data/scenes")) {
    if (entry.is_directory()) continue;  // failures
    const std::string scene = entry.path().string();
    const std::string name = entry.path().stem().string();
    Result r = success("--config " + scene + mesh_for(name) +
                       " --headless --t-end 0.02");
    EXPECT_EQ(r.err, "") << scene;
    EXPECT_TRUE(has(r.out, "\n" + name + ": "));
    if (is_stage(name))
      EXPECT_TRUE(has(r.out, "dt = 0.001 s: "));
    else
      EXPECT_TRUE(r.out.find(": 60 % of the stability limit (") !=
                      std::string::npos ||
                  r.out.find(" has no stability limit") != std::string::npos)
          << r.out;
    ++count;
  }
  EXPECT_GE(count, 9 + 5);
}

TEST_F(ClothProgram, TheCommandLineWinsOverTheFile) {
  std::string scene = file("scene.toml",
                           "sheet = \"nodes 5 5\"\npin = \"x 0\"\n"
                           "modulus = 100\ndrag = 1\nt-end = 0.1\n");
  auto dump = [&](const std::string& options) {
    return '\n' +
           success("--config " + scene + " " + options + " --dump-config").out;
  };
  auto has_line = [](const std::string& text, const std::string& line) {
    return text.find("\n" + line + "\n") != std::string::npos;
  };
  std::string text = dump("");
  for (const char* line : {"sheet = [\"nodes 5 5\"]", "pin = [\"x 0\"]",
                           "modulus = 100", "drag = 1", "t-end = 0.1"})
    EXPECT_TRUE(has_line(text, line)) << line << text;
  EXPECT_FALSE(has(text, "stiffness ="));
  text = dump("--pin 'y 0' --pin 'y 1' --stiffness 7 --damping 0.5 --t-end 2");
  for (const char* line :
       {"sheet = [\"nodes 5 5\"]", "pin = [\"y 0\", \"y 1\"]", "stiffness = 7",
        "damping = 0.5", "t-end = 2"})
    EXPECT_TRUE(has_line(text, line)) << line << text;
  EXPECT_FALSE(has(text, "modulus ="));
  EXPECT_FALSE(has(text, "drag ="));
  EXPECT_TRUE(
      has(run("--config " + scene + " --headless --t-end 0.2 --dt 0.01").out,
          "scene: 20 steps"));
}

TEST_F(ClothProgram, RefusesScenesThatCantBe) {
  auto complaint = [&](const std::string& more) {
    return refusal(sheet + more);
  };
  EXPECT_EQ(run(sheet).status, 0);
  EXPECT_EQ(complaint(grid0),
            "cloth: --sheet cannot be combined with NODES and TETS\n");
  EXPECT_EQ(complaint("--pin 'x 0' --pin 'x 0.3'"),
            "cloth: --pin \"x 0.3\" holds no node: the nearest is node 18 at "
            "0.25 0 0\n");
  EXPECT_NE(complaint("--modulus 1 --stiffness 1"), "");
  EXPECT_NE(complaint("--drag 1 --damping 1"), "");
  EXPECT_NE(complaint("--sheet"), "");
}

TEST_F(ClothProgram, AdvisesAndRunsWhatItAdvises) {
  const std::string scene =
      "--sheet 'u 1 0 0 v 0 0 -1 nodes 6 6' --pin 'z 0' --plane 'at 0 0 -9' "
      "--t-end 0.1 --tolerance 0.01 --headless ";
  Result r = success(scene + "--advise --write-config " + path("a.toml"));
  EXPECT_TRUE(begins(r.out, "advice: "));  // the answer first
  EXPECT_TRUE(has(r.out, " dropped\n"));
  // Its command runs as it stands: without a warning, a window or a film.
  const auto line = r.out.find("./cloth ") + 8;
  const Result pasted =
      success(r.out.substr(line, r.out.find('\n', line) - line));
  EXPECT_EQ(pasted.err, "");
  EXPECT_FALSE(has(pasted.out, "no display"));
  const std::string advised = contents(dir / "a.toml");
  EXPECT_TRUE(has(advised, "pin = [\"z 0\"]"));
  EXPECT_FALSE(has(advised, "plane = "));
  EXPECT_EQ(run("--headless --config " + path("a.toml")).status, 0);
  EXPECT_TRUE(has(success(scene + "--auto").out, "scene: "));
  r = run(grid0 + "--advise");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(begins(r.out, "no advice: "));
  EXPECT_TRUE(
      begins(run(grid0 + "--advise --quiet").err, "cloth: no advice: "));
  EXPECT_EQ(run(scene + "--advise --advise-work -1").status, 2);
  // A budget that allows nothing: said at once.
  r = run(scene + "--advise --advise-work 1");
  EXPECT_TRUE(
      begins(r.out, "no advice: the budget ended before the first grid"));
  r = run(scene + "--advise --advise-work 300");
  EXPECT_TRUE(has(r.out, "of a budget of 3e+02"));
  r = run(scene + "--tear-strain 1 --measure positions --advise");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(has(r.err, "--measure is positions"));
}

TEST_F(ClothProgram, AdviceKeepsTheMethodAndStepOfTheCommand) {
  const std::string scene =
      "--sheet 'u 1 0 0 v 0 0 -1' --pin 'z 0' --t-end 0.1 --tolerance 0.01 "
      "--advise ";
  const auto out = [&](const std::string& more) {
    return success(scene + more).out;
  };
  EXPECT_TRUE(has(out("--method pefrl"), " --method pefrl "));
  EXPECT_TRUE(has(out("--dt 0.002"), " --dt 0.002 "));
  EXPECT_TRUE(has(out("--method symplectic-euler --dt 0.002"),
                  "nodes, symplectic-euler, dt 0.002 s"));
}

// A default written in words: nobody would type ''.
TEST_F(ClothProgram, AdvisedCommandNamesItsSheet) {
  lab::Model m;
  m.sheets.resize(1), m.planes.resize(1), m.spheres.resize(1);
  const std::string options = lab::as_options(m);
  EXPECT_FALSE(has(options, "''"));
  EXPECT_TRUE(has(options, "--sheet 'nodes 20 20'"));
}

TEST_F(ClothProgram, WriteConfigAloneAsksNothing) {
  const std::string scene = "--sheet 'nodes 4 4' --pin 'x 0' --t-end 0.1 ";
  const Result r = success(scene + "--write-config " + path("a.toml"));
  EXPECT_EQ(r.out + r.err, "");
  EXPECT_EQ(contents(dir / "a.toml"), run(scene + "--dump-config").out);
}

TEST_F(ClothProgram, AdviceSaysWhatIsTrivial) {
  const std::string swing =
      "--sheet 'u 1 0 0 v 0 0 -1 nodes 9 9' --pin 'z 0' --t-end 0.1 --advise ";
  const auto trivial = [&](const std::string& question) {
    return run(swing + question).out.find("  trivial: ") != std::string::npos;
  };
  EXPECT_TRUE(trivial("--measure energy --tolerance 0.001"));
  EXPECT_FALSE(
      trivial("--measure energy --density 1 --drag 1 "
              "--tolerance 0.001"));
  EXPECT_TRUE(trivial("--tolerance 0.5"));  // it falls by millimeters
  EXPECT_FALSE(trivial("--tolerance 0.001"));
}

}  // namespace
