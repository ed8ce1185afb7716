// ./cloth and the files that come from users and go to other programs: frames,
// clothes that are written and read again, scenes from elsewhere.
#include <gtest/gtest.h>

#include "tests/ClothProgram.hpp"

namespace {

const std::string torn =
    "--sheet 'nodes 9 9' --pin 'x 0' --tear 'at 0.7 0.5 -0.3 radius 0.2' "
    "--headless --t-end 0.5 ";

TEST_F(ClothProgram, WritesFramesOfAClothThatTears) {
  const Result r =
      success(torn + "--dt 0.003 --csv " + path("e.csv") + " --every 1 --vtp " +
              path("vtp") + " --ply " + path("ply"));
  for (const std::string kind : {"vtp", "ply"})
    EXPECT_TRUE(has(r.out, "16 frames ." + kind + " in " + path(kind) + '\n'));
  // Each frame is the state of a row of the table, of that time.
  std::istringstream pvd(contents(dir / "vtp/frames.pvd"));
  const auto table = rows(dir / "e.csv");
  int frames = 0;
  for (std::string line; std::getline(pvd, line);) {
    const auto at = line.find("timestep=\"");
    if (at == std::string::npos) continue;
    const double t = std::stod(line.substr(at + 10));
    const auto row = std::find_if(table.begin(), table.end(), [&](auto& row) {
      return std::abs(row[0] - t) < 1e-12;
    });
    ASSERT_NE(row, table.end()) << t;
    const auto name = line.find("file=\"") + 6;
    const std::string file =
        contents(dir / "vtp" / line.substr(name, line.find('"', name) - name));
    EXPECT_TRUE(has(file, "NumberOfPoints=\"" + std::to_string(int((*row)[8])) +
                              "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
                              std::to_string(int((*row)[9])) + '"'));
    ++frames;
  }
  EXPECT_EQ(frames, 16);
  EXPECT_LT(table.back()[8], 81);  // it tore
  EXPECT_TRUE(
      has(contents(dir / "ply/frame_000015.ply"), "element vertex 81\n"));
}

// A torn cloth, as a net, goes on as it was; frames are read, too.
TEST_F(ClothProgram, ReadsTheNetsAndTheFramesThatItWrites) {
  const Result whole =
      success(torn + "--out " + path("end.net") + " --ply " + path("ply"));
  const auto at = whole.out.find("nodes and ");
  const std::string edges = whole.out.substr(at + 10, 4);
  const std::string end =
      " --plane 'at 0 0 -9' --t-end 0 --headless --verbose --out ";
  Result r = success(path("end.net") + end + path("same.net"));
  EXPECT_EQ(r.err, "");
  EXPECT_TRUE(has(r.out, " nodes, " + edges));
  EXPECT_TRUE(has(r.out, "held by the net: 9 nodes"));
  EXPECT_EQ(contents(path("same.net")), contents(path("end.net")));
  r = run(path("ply/frame_000000.ply") + end + path("ply.net"));
  EXPECT_EQ(r.err, "");
  EXPECT_TRUE(has(r.out, "81 nodes, 272 edges"));
  EXPECT_EQ(refusal(path("end.net") + " --out " + path("end.nodes")),
            "cloth: --out is " + path("end.nodes") +
                ", expected a name that ends in .net: other files hold quads "
                "alone\n");
}

TEST_F(ClothProgram, ReadsMeshesOfOtherPrograms) {
  file("a.nodes", "0 0 0\n0 1 0\n1 0 0\n1 1 0\n");
  file("a.tris", "0 2 1\n1 2 3\n");
  file("a.tets", "0 1 3 2\n3 1 0 2\n");
  file("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n");
  file("a.toml", "net = 'a.obj'\npin = 'node 0'\n");
  file("a.edges", "0 1\n1 0\n1 3\n");
  const std::string short_run = " --headless --verbose --t-end 0.01";
  struct {
    std::string options;
    const char *out, *err;
  } const cases[] = {
      {path("a.nodes") + ' ' + path("a.tris"), "4 nodes, 5 edges", ""},
      {path("a.obj") + " --pin 'x 0'", "4 nodes, 6 edges", ""},
      {"--net " + path("a.obj") + " --density 3 --pin 'node 3'",
       ", 3 kg: 3 nodes moved", ""},
      {"--config " + path("a.toml"), "pin node 0: 1 node", ""},
      {path("a.nodes") + ' ' + path("a.tets") + " --density 3 --pin 'x 0'",
       ", 3 kg: 2 nodes moved", "their corners around, as a b d c: taken as"},
      {path("a.nodes") + ' ' + path("a.tets"), "4 nodes, 6 edges",
       "1 face is listed twice: each counts once"},
      {path("a.obj") + " --density 3", "", "nothing holds the cloth, and"},
      {path("a.nodes") + ' ' + path("a.edges") + " --pin 'x 0'",
       "springs, K 100 N/m: 2",
       "1 spring is listed from both ends: each counts"},
      {"--sheet 'nodes 3 3' --gravity -9.81",
       "gravity 9.81 m/s^2 down: 9 nodes", ""},
      {"--sheet 'nodes 3 3' --pin 'y 1' --gravity '3 -9 0'",
       "gravity 3 -9 0 m/s^2: 9 nodes", ""},
      {"--sheet 'nodes 75 1' --pin 'x 0'", "75 nodes, 74 edges", ""}};
  for (const auto& c : cases) {
    const Result r = success(c.options + short_run);
    EXPECT_TRUE(has(r.out, c.out)) << c.options;
    EXPECT_TRUE(has(r.err, c.err)) << c.options;
    EXPECT_EQ(r.err.empty(), !*c.err) << c.options << r.err;
  }
}

TEST_F(ClothProgram, RefusesFoldersThatAreInUse) {
  auto error = [&](const std::string& more) { return refusal(torn + more); };
  fs::create_directory(dir / "mine");
  file("mine/x", "mine");
  EXPECT_EQ(error("--vtp " + path("mine")),
            "cloth: " + path("mine") +
                ": has files in it, expected a new or an empty folder\n");
  EXPECT_EQ(error("--vtp " + path("new") + " --ply " + path("./new")),
            "cloth: --ply is " + path("./new") +
                ", which --vtp also writes, expected another file\n");
  EXPECT_NE(error("--out " + path("a.nodes") + " --csv " + path("a.tets")), "");
  EXPECT_EQ(error("--frame-rate 0 --vtp " + path("new")),
            "cloth: --frame-rate is 0, expected more than 0 frames a second\n");
  EXPECT_EQ(files(), std::vector<std::string>{"mine"});
}

// The line of a file, unless the command line has said something else since.
TEST_F(ClothProgram, SaysWhereASceneIsWrongAlsoWhenItIsFoundOutLate) {
  const std::string scene = file(
      "s.toml", "\xEF\xBB\xBFsheet = \"nodes 9 9\"\n# held\npin = \"x 0.3\"\n");
  const std::string run_it = "--config " + scene + " --headless --t-end 0 ";
  EXPECT_EQ(refusal(run_it),
            scene +
                ":3: --pin \"x 0.3\" holds no node: the nearest is node 18 "
                "at 0.25 0 0\n");
  EXPECT_EQ(run(run_it + "--pin 'x 0'").status, 0);
  file("s.toml", "sheet = \"nodes 9 9\"\nself-collision = \"thickness 0.3\"\n");
  EXPECT_TRUE(begins(refusal(run_it), scene + ":2: --self-collision has"));
  file("s.toml", "sheet = \"nodes 9 9\"\ndt = 0.1\n");
  EXPECT_EQ(run("--config " + scene + " --t-end 0.05").err,
            scene + ":2: --dt is 0.1, expected at most --t-end\n");
  file("s.toml", "sheet = \"nodes 9 9\"\ndt = \"auto\"\nstiffness = 0\n");
  EXPECT_TRUE(begins(run(run_it).err,
                     scene + ":2: symplectic-euler has no stability limit"));
  EXPECT_TRUE(
      begins(run(run_it + "--dt auto").err, "cloth: symplectic-euler has no "));
}

TEST_F(ClothProgram, SeeksTheFilesOfASceneBesideIt) {
  fs::create_directory(dir / "sub");
  file("sub/a.nodes", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  file("sub/a.tets", "0 1 2 3\n");
  const std::string scene =
      file("s.toml",
           "nodes = \"sub/a.nodes\"\ntets = \"sub/a.tets\"\n"
           "csv = \"e.csv\"\nheadless = true\nt-end = 0.01\n");
  success("--config " + scene);
  EXPECT_EQ(files(), (std::vector<std::string>{"e.csv", "s.toml", "sub"}));
  // On the command line it is relative to the working directory.
  EXPECT_EQ(run("--config " + scene + " --nodes sub/a.nodes").err,
            "sub/a.nodes: can't be opened (No such file or directory), "
            "expected a file of points\n");
  fs::remove(dir / "sub/a.tets");
  EXPECT_EQ(run("--config " + scene).err,
            scene + ":2: " + path("sub/a.tets") +
                ": can't be opened (No such file or directory), expected a "
                "file of quads\n");
  file("sub/a.tets", "0 1 2 4\n");
  EXPECT_TRUE(
      begins(run("--config " + scene).err, path("sub/a.tets") + ":1: "));
}

// Whatever the name of a folder holds, a dump says it.
TEST_F(ClothProgram, DumpsScenesThatCanBeReadBack) {
  const std::string odd = "a \"b\" \\ \xC3\xA9\n# [x]";
  fs::create_directory(dir / odd);
  file(odd + "/a.nodes", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  file(odd + "/a.tets", "0 1 2 3\n");
  const std::string quoted = "'" + path(odd) + "/a";
  const std::string dump =
      success(quoted + ".nodes' " + quoted +
              ".tets' --region 'from 0 0 0 to 1 0 0 mass-factor 3 "
              "stiffness-factor 2' --pin 'x 0' --dump-config")
          .out;
  const std::string scene = file("dump.toml", dump);
  EXPECT_EQ(run("--config " + scene + " --dump-config").out, dump);
  success("--config " + scene + " --headless --t-end 0.01");
}

TEST_F(ClothProgram, KnowsFormatsByTheEndingsOfNames) {
  auto error = [&](const std::string& more) { return refusal(torn + more); };
  EXPECT_EQ(error("--screenshot a.jpg"),
            "cloth: --screenshot is a.jpg, expected a name that ends in "
            ".png\n");
  EXPECT_EQ(error("--record png"),
            "cloth: --record is png, expected a name that ends in .mp4 "
            "or .gif\n");
  EXPECT_EQ(error("--out o.tets"),
            "cloth: --out is o.tets, expected a file of points, such as "
            "FILE.nodes: the quads go into FILE.tets\n");
}

// A frame for each 1/30 s from 0 to 0.2 s, and a ninth of all at the end; the
// sheet comes to the floor at 0.09 s, and stays slow for 0.08 s.
TEST_F(ClothProgram, FilmsMoveAndShowContactSlower) {
  if (!CME212::has_program("ffprobe")) GTEST_SKIP() << "no ffprobe";
  auto frames = [this](const std::string& options,
                       const std::string& scene =
                           "--sheet 'nodes 5 5' --plane 'at 0 0 -0.05' "
                           "--t-end 0.2") {
    const Result r = run(scene + " --record " + path("film.mp4") + options);
    EXPECT_EQ(r.status, options.find("--pin") < options.size() ? 3 : 0)
        << r.err;
    return std::stoi(
        CME212::output_of("ffprobe -v error -show_entries "
                          "stream=nb_frames -of csv=p=0 " +
                          path("film.mp4")));
  };
  EXPECT_EQ(frames(""), 7 + 1);
  EXPECT_NEAR(frames(" --slow-motion 4"), 7 + 1 + 3 * 30 * 0.08, 2);
  // A warning can be read.
  EXPECT_EQ(frames("", "--config data/scenes/failures/tunnel.toml"), 4 + 60);
  // Two seconds of the explosion, and two of the reason.
  EXPECT_GE(frames(" --pin 'x 0 y 0' --dt 0.04"), 60 + 60);
  // One that fails so fast that only the check before a picture finds it.
  EXPECT_GE(frames(" --pin 'x 0' --stiffness 1e6 --dt 0.01"), 60 + 60);
  EXPECT_EQ(frames(" --size 320x200"), 7 + 1);
  EXPECT_EQ(CME212::output_of("ffprobe -v error -show_entries "
                              "stream=width,height -of csv=p=0 " +
                              path("film.mp4")),
            "320,200\n");
  for (const std::string size : {"320", "320x201", "0x200", "320x200x", "axb"})
    EXPECT_EQ(run("--sheet 'nodes 5 5' --size " + size).err,
              "cloth: --size is " + size +
                  ", expected WIDTHxHEIGHT, even numbers of pixels from 64 to "
                  "8190\n");
  EXPECT_EQ(run("--sheet 'nodes 5 5' --slow-motion 0.5").err,
            "cloth: --slow-motion is 0.5, expected a factor of 1 to 100\n");
}

// By default, too, a step of a method with four evaluations costs four times.
TEST_F(ClothProgram, SaysWhatActsAndWhatItCosts) {
  const std::string scene =
      "--sheet 'nodes 5 5' --pin 'x 0' --plane 'at 0 0 -1' --damping 0.1 "
      "--region 'from 0 0 0 to 0.3 1 0 stiffness-factor 4' --headless "
      "--verbose "
      "--t-end 0.01 ";
  EXPECT_TRUE(has(run(scene).out,
                  "a step of symplectic-euler, order 1: 1 force evaluation\n"
                  "  cloth of 5 x 5 nodes, 1 kg: 20 nodes moved\n"
                  "  springs, K 100 to 400 N/m: 72 springs\n"
                  "  gravity 9.81 m/s^2 down: 25 nodes\n"
                  "  drag 0.1 kg/s a node: 25 nodes\n"
                  "  plane at 0 0 -1: 25 nodes\n"
                  "  pin x 0: 5 nodes\n"));
  const std::string rk4 = run(scene + "--method rk4").out;
  EXPECT_TRUE(has(rk4, ": 4 force evaluations\n"));
  EXPECT_TRUE(has(rk4, ": 4 times 72 springs\n"));
  EXPECT_TRUE(has(rk4, "plane at 0 0 -1: 25 nodes\n"));
  const std::string bare =
      run("--sheet 'nodes 5 5' --gravity 0 --headless --verbose --t-end 0.01")
          .out;
  for (const char* part : {"gravity", "drag", "plane", "pin", "tear"})
    EXPECT_FALSE(has(bare, "  " + std::string(part)));
  EXPECT_EQ(run(scene + "--quiet").out, "");
}

// 10^8 nodes need at least 36 GB; with 4 GB of addresses that is known at once.
TEST_F(ClothProgram, RefusesAClothThatNeedsMoreMemoryThanThereIs) {
  const Result r =
      folder.run("ulimit -v 4000000; " + CME212::program("cloth", "build/") +
                 " --sheet 'nodes 10000 10000' --headless");
  EXPECT_EQ(r.status, 2);
  EXPECT_TRUE(begins(r.err,
                     "cloth: --sheet gives 1e+08 nodes and 3.9994e+08 "
                     "springs, which need at least 37 GB of memory; "));
}

}  // namespace
