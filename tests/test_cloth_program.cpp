// ./cloth as its user meets it: the program is run, and its status, words and
// files are looked at. Its scenes: test_cloth_scenes.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lab/methods/Methods.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "tests/ClothProgram.hpp"

using namespace lab;

namespace {

/** The number that stands in @a text between @a before and @a after. */
double number(const std::string& text, const std::string& before,
              const std::string& after) {
  std::size_t at = text.find(before), end = 0;
  EXPECT_NE(at, std::string::npos) << before << "\n in: " << text;
  if (at == std::string::npos) return NAN;
  at += before.size();
  const double a = std::stod(text.substr(at), &end);
  EXPECT_EQ(text.substr(at + end, after.size()), after) << text;
  return a;
}

TEST_F(ClothProgram, Takes5000StepsFor5Seconds) {
  for (const char* dt : {"0.001", "0.0001", "0.003125"}) {
    std::string steps = std::to_string(std::lround(5 / std::stod(dt)));
    EXPECT_TRUE(has(success(grid0 + "--headless --dt " + dt).out,
                    "tear: " + steps + " steps to t = 5 s in "));
  }
  EXPECT_TRUE(has(run(grid0 + "--headless --t-end 0.0015").out, ": 2 steps"));
  EXPECT_TRUE(has(run(grid0 + "--headless --t-end 0").out, ": 0 steps"));
  EXPECT_TRUE(run("--version").out.starts_with("cloth 2.0.0, kernels "));
}

TEST_F(ClothProgram, WritesEnergiesThatAddUp) {
  Result r =
      success(stage("forces") + grid0 +
              "--headless --quiet --every 7 --t-end 1 --csv " + path("e.csv"));
  EXPECT_EQ(r.out + r.err, "");
  EXPECT_TRUE(begins(contents(dir / "e.csv"),
                     "t,kinetic,elastic,gravitational,"
                     "total,com_x,com_y,com_z,nodes,"
                     "edges,work,drag,balance,evaluations\n"));
  auto table = rows(dir / "e.csv");
  ASSERT_EQ(table.size(), 144u);  // steps 0, 7, ..., 994 and the last
  for (const auto& row : table) {
    ASSERT_EQ(row.size(), 14u);
    EXPECT_DOUBLE_EQ(row[1] + row[2] + row[3], row[4]);
    EXPECT_NEAR(row[4], 0, 0.1);                // J: no drag
    EXPECT_NEAR(row[3], 9.81 * row[7], 1e-12);  // 1 kg
    EXPECT_EQ(row[8], 25);
    EXPECT_EQ(row[9], 72);
    EXPECT_EQ(row[10], 0);  // nothing moves
    EXPECT_EQ(row[11], 0);
    EXPECT_NEAR(row[12], row[4], 1e-15);
    EXPECT_EQ(row[13], std::round(row[0] / 0.001));  // one a step
  }
  EXPECT_DOUBLE_EQ(table[1][0], 0.007);
  EXPECT_DOUBLE_EQ(table.back()[0], 1);
  EXPECT_LT(table.back()[7], -0.05);
}

TEST_F(ClothProgram, StopsWhenItDivergesAndLeavesTheLastGoodState) {
  Result r = run(grid3 + "--headless --every 1 --csv " + path("e.csv") +
                 " --out " + path("end.nodes"));
  EXPECT_EQ(r.status, 3);
  EXPECT_TRUE(has(r.err,
                  "\nplace: step 14 with dt = 0.001 s, method "
                  "symplectic-euler: node "));
  EXPECT_TRUE(has(r.err, "the last good state is that of t = 0.013 s\n"));
  EXPECT_GT(number(r.err, " moves at ", " m/s, its spring to node "), 5);
  const double rest = number(r.err, " times its rest length of ", " m; the");
  EXPECT_TRUE(rest == 0.0101 || rest == 0.0143) << rest;  // (sqrt(2))/99
  const double times =
      number(r.err, "cloth: diverged: dt is ", " times the stability limit (");
  const double limit =
      number(r.err, " times the stability limit (", " s, symplectic-euler): ");
  EXPECT_NEAR(times * limit, 0.001, 1e-5);
  EXPECT_NEAR(times, std::sqrt(3), 0.01);  // sqrt(12 K N)/2000
  EXPECT_EQ(parse_nodes(contents(dir / "end.nodes"), "end").points.size(),
            10000u);
  auto table = rows(dir / "e.csv");
  EXPECT_EQ(table.size(), 14u);
  for (const auto& row : table)
    for (double a : row) EXPECT_TRUE(std::isfinite(a));
  // The advice works.
  const std::string dt =
      std::to_string(number(r.err, "\ncure: --dt ", " works: a trial to t = "));
  EXPECT_EQ(run(grid3 + "--headless --t-end 0.2 --dt " + dt).status, 0);
  EXPECT_EQ(run(grid3 + "--headless --t-end 0.2 --dt auto").status, 0);
}

/** The command in what a failed run says: it can be pasted as it stands. */
std::string command_in(const std::string& said) {
  const std::size_t begin = said.find("\n    ");
  return begin == said.npos
             ? ""
             : said.substr(begin, said.find("\nplace: ") - begin);
}

TEST_F(ClothProgram, SaysCauseCureAndPlaceIn80Columns) {
  const std::string program = CME212::program("cloth", "build/") + ' ';
  const auto lines_of = [](const Result& r) {
    int lines = 0;
    std::istringstream in(r.out + r.err);
    for (std::string line; std::getline(in, line);) {
      EXPECT_LE(line.size(), 80u) << line;
      lines += !has(line, " steps/s, ");  // a slow run says how far it is
    }
    return lines;
  };
  for (const auto& entry : fs::directory_iterator("data/scenes/failures")) {
    const std::string name = entry.path().stem().string();
    const Result r =
        folder.run(program + "--headless --config " + entry.path().string());
    if (name == "tunnel") {
      EXPECT_EQ(r.status, 0);
      EXPECT_TRUE(has(joined(r.err), "would have tunnelled"));
      continue;
    }
    EXPECT_EQ(r.status, 3);
    EXPECT_LE(lines_of(r), 18) << r.err;
    EXPECT_TRUE(has('\n' + r.err, "\ncloth: diverged: ")) << name;
    EXPECT_LT(r.err.find("\ncure: --"), r.err.find("\n    ")) << name;
    EXPECT_LT(r.err.find("\n    "), r.err.find("\nplace: step ")) << name;
  }
  const std::string scene =
      "--sheet 'nodes 9 9' --dt=0.05 --pin 'x 0 y 0' --headless --t-end 0.5 "
      "--csv ";
  const Result sick = folder.run(program + scene + path("\"a b's\""));
  EXPECT_EQ(sick.status, 3) << sick.err;
  const Result again = folder.run(command_in(sick.err));
  EXPECT_EQ(again.status, 0) << command_in(sick.err) << again.err;
  EXPECT_EQ(files(), std::vector<std::string>{"a b's"});
  const Result healthy =
      folder.run(program + "--sheet 'nodes 9 9' --dt 0.0005 --headless");
  EXPECT_EQ(healthy.status, 0);
  EXPECT_LE(lines_of(healthy), 8) << healthy.out << healthy.err;
  const std::string all = run("--sheet 'nodes 3 3' --verbose --headless").out;
  EXPECT_TRUE(has(all, "\n  gravity 9.81 m/s^2 down: 9 nodes\n"));
}

TEST_F(ClothProgram, SaysHowLongTheStepIsAndMayBe) {
  auto out = [this](const std::string& options) {
    return run(grid0 + "--headless --t-end 0.1 " + options).out;
  };
  const std::string of = " % of the stability limit (";
  // grid0: omega = 162, so 2/omega = 0.0123 s
  std::string text = out("");
  const double limit = number(text, of, " s, symplectic-euler)\n");
  EXPECT_NEAR(limit, 0.0123, 0.0001);
  EXPECT_NEAR(number(text, "dt = 0.001 s: ", of), 0.1 / limit, 0.1);
  EXPECT_TRUE(has(out("--dt 0.01"), "dt = 0.01 s: 81 % of"));
  EXPECT_NEAR(number(out("--method rk4"), of, " s, rk4)\n"),
              limit * std::sqrt(2), 0.0002);
  text = out("--method tr-bdf2 --dt 0.05");
  EXPECT_NEAR(number(text, "tr-bdf2 has no stability limit; this is ",
                     " times the stability limit of verlet ("),
              0.05 / limit, 0.03);
  EXPECT_TRUE(has(out("--method forward-euler"), "no step is stable with"));
  EXPECT_TRUE(
      has(out("--stiffness 0"), ": symplectic-euler has no stability limit\n"));
  EXPECT_TRUE(has(out("--dt auto:sharp"),
                  " s at first; auto:sharp takes 90 % of the stability "
                  "limit in the present configuration, at most 0.0123 s"));
  // Drag as a force lowers the limit; treated exactly it does not.
  const std::string drag = "--damping 4 --dt 0.005 ";  // c/m = 100/s
  EXPECT_LT(number(out(drag), of, " s, symplectic-euler)\n"), 0.95 * limit);
  EXPECT_NEAR(number(out(drag + "--method verlet"), of, " s, verlet)\n"), limit,
              0.0001);
}

// Beyond the limit waves grow, but a run may be over before that shows.
TEST_F(ClothProgram, WarnsOfAStepOnlyWhereHalfOfItDiffers) {
  const std::string sheet =
      "--sheet 'nodes 9 9' --pin 'x 0' --headless --t-end ";
  EXPECT_EQ(run(sheet + "0.1 --method forward-euler --dt 1e-4").err, "");
  EXPECT_EQ(run(sheet + "0.1 --method verlet --dt 0.008").err, "");
  const std::string falls =
      "--sheet 'nodes 9 9 velocity 0 0 2' --pin 'x 0 y 0' "
      "--plane 'at 0 0 -0.3' --headless --t-end 1 ";
  const Result r = success(falls + "--method srkn11b --dt 0.02");
  EXPECT_TRUE(begins(r.err, "cloth: warning: half of dt gives "));
  EXPECT_TRUE(has(r.err, " works: a trial to t = 1 s passed"));
  EXPECT_TRUE(has(r.out, "\nhalf of dt: "));
  EXPECT_EQ(run(falls + "--method srkn11b --dt 0.02 --quiet").err, "");
}

TEST_F(ClothProgram, ChoosesItsStep) {
  for (const MethodEntry& m : methods) {
    const std::string method = std::string(" --method ").append(m.info.name);
    Result safe = run(grid0 + "--headless --dt auto --damping 0.04" + method);
    Result sharp =
        run(grid0 + "--headless --dt auto:sharp --damping 0.04" + method);
    if (m.info.limit == no_limit || m.info.adaptive) {
      EXPECT_EQ(safe.status, 2) << m.info.name;
      EXPECT_EQ(safe.err,
                m.info.adaptive
                    ? std::string("cloth: ").append(m.info.name) +
                          " chooses its inner steps by their error: omit --dt "
                          "and give --tolerance\n"
                    : std::string("cloth: ").append(m.info.name) +
                          " has no stability limit here, so no step can be "
                          "chosen: give --dt a number\n");
      EXPECT_EQ(sharp.status, 2) << m.info.name;
      continue;
    }
    EXPECT_EQ(safe.status, 0) << m.info.name << safe.err;
    EXPECT_EQ(sharp.status, 0) << m.info.name << sharp.err;
    auto steps = [](const Result& r) {
      return number(r.out, "\ntear: ", " steps to t = 5");
    };
    // It would damp the fastest waves more than the drag does.
    if (method == " --method rk4") continue;
    EXPECT_EQ(number(safe.out, " s: ", " % of the stability limit ("), 60);
    // Both are lengthened, as there is drag; one begins farther.
    EXPECT_LT(steps(sharp), steps(safe)) << m.info.name;
    EXPECT_GT(steps(sharp), 0.4 * steps(safe)) << m.info.name;
    EXPECT_LT(steps(safe), (m.info.order == 2 ? 0.8 : 1.3) * 5 /
                               number(safe.out, "\ndt = ", " s: "));
  }
  EXPECT_EQ(run(grid0 + "--headless --dt auto --method forward-euler").err,
            "cloth: forward-euler has no stable step, so no step can be "
            "chosen: give --dt a number\n");
  EXPECT_EQ(run(grid0 + "--headless --dt auto --stiffness 0").status, 2);
}

TEST_F(ClothProgram, RefusesOptionsThatCantBe) {
  for (const char* options :
       {"--dt x", "--t-end inf", "--damping -1", "--gravity nan", "--every 0",
        "--screenshot-at 6 --screenshot p.png", "--wind 'velocity 1 0 0'",
        "--no-such-option", "--dt 1e-300", "--dt 0.2 --t-end 0.1",
        "--method none", "--window --headless", "--csv", "--speed -1"}) {
    EXPECT_NE(refusal(grid0 + "--headless --out " + path("o") + " " + options),
              "");
    EXPECT_EQ(files(), std::vector<std::string>{}) << options;
  }
  EXPECT_NE(refusal("data/grid0.nodes"), "");
  EXPECT_EQ(
      refusal("--headless --dt nan " + grid0),
      "cloth: --dt is nan, expected a positive time [s] or auto[:sharp][:G] "
      "with G in (0, 1], the energy gain tolerated, as auto:0.02\n");
}

// ChoosesItsStep runs each of them.
TEST_F(ClothProgram, ListsEveryMethod) {
  Result list = success("--list-methods");
  EXPECT_TRUE(has(list.out, "60 frames a second, take verlet"));
  for (const MethodEntry& m : methods)
    EXPECT_TRUE(has(list.out, "\n" + std::string(m.info.name) + ' '));
}

// Newton gives up on a cloth that buckles at a step far too large.
TEST_F(ClothProgram, EndsWith3WhenAStepCantBeMade) {
  Result r =
      run("data/grid1.nodes data/grid1.tets --headless --method "
          "implicit-midpoint --dt 0.5 --stiffness 1e5");
  EXPECT_EQ(r.status, 3) << r.out << r.err;
  EXPECT_TRUE(
      has(r.err, "\nplace: step 1 with dt = 0.5 s, method implicit-midpoint"));
}

TEST_F(ClothProgram, RefusesOutputsThatCantBeBeforeItRuns) {
  for (const auto& [option, name] :
       {std::pair("--csv ", "no/such"), std::pair("--out ", "no/such"),
        std::pair("--screenshot ", "no/such.png"),
        std::pair("--record ", "no/such.mp4")}) {
    EXPECT_EQ(refusal(grid3 + "--headless " + option + path(name)),
              "cloth: " + path(name) +
                  ": can't be written (No such file or directory)\n");
    EXPECT_EQ(files(), std::vector<std::string>{});
  }
}

TEST_F(ClothProgram, KeepsTheOldFileWhenTheNewRunFails) {
  std::string kept = file("kept", "old");
  run("data/none data/none --headless --csv " + kept);
  run(grid0 + "--headless --dt 0 --csv " + kept);
  EXPECT_EQ(contents(kept), "old");
  run(grid0 + "--headless --t-end 0 --csv " + kept);
  EXPECT_NE(contents(kept), "old");
  EXPECT_EQ(run(grid0 + "--headless --out /dev/null").status, 0);
}

TEST_F(ClothProgram, ExplainsItsOptionsWithUnitsAndDefaults) {
  const Result r = folder.run(CME212::program("cloth", "build/") + " --help");
  EXPECT_TRUE(has(r.out, "--dt FLOAT|auto[:sharp][:G]=0.001"));
  // Each option once, in lines that fit a terminal.
  std::istringstream in(r.out);
  std::set<std::string> options;
  int examples = 0;
  for (std::string line; std::getline(in, line);) {
    EXPECT_LE(line.size(), 80u) << line;
    if (line.starts_with("  -")) {
      const std::string name = line.substr(2, line.find(' ', 2) - 2);
      EXPECT_TRUE(options.insert(name).second) << line;
    }
    // The examples are good; they are read only.
    if (!line.starts_with("  ./cloth ")) continue;
    ++examples;
    EXPECT_EQ(run(line.substr(10) + " --dump-config").status, 0) << line;
  }
  EXPECT_EQ(examples, 3);
  EXPECT_GT(options.size(), 40u);
  // It names what a scene file may: so no option is without a group.
  const std::string dump = run("--sheet 'nodes 3 3' --dump-config").out;
  std::istringstream keys(dump);
  for (std::string line; std::getline(keys, line);) {
    if (line.starts_with("#")) continue;
    EXPECT_TRUE(options.count("--" + line.substr(0, line.find(' ')))) << line;
  }
}

TEST_F(ClothProgram, NamesTheNearestOptionOfOneThatIsMisspelt) {
  EXPECT_EQ(refusal(grid0 + "--methd verlet"),
            "cloth: --methd is not an option: did you mean --method?\n");
  EXPECT_EQ(refusal("--t_end=3 " + grid0),
            "cloth: --t_end is not an option: did you mean --t-end?\n");
  EXPECT_EQ(
      refusal(grid0 + "--method verlt"),
      "cloth: --method is verlt, expected a name of --list-methods: did you "
      "mean verlet?\n");
  EXPECT_TRUE(has(refusal(grid0 + "--measure conm"), "did you mean com?\n"));
  EXPECT_EQ(refusal(grid0 + "--mass 3"),
            "cloth: --mass is not an option: expected density, or masses in a "
            ".net file\n");
}

// A remedy is one that was tried.
TEST_F(ClothProgram, TellsARemedyThatWorksWhereTheEnergyIsWrong) {
  const std::string net =
      "--sheet 'nodes 9 9 velocity 0 0 4' --pin 'x 0 y 0' "
      "--t-end 2 --headless ";
  for (const char* more : {"--plane 'at 0 0 -50' ", "--damping 1e-7 "}) {
    const Result r = run(net + more + "--method implicit-euler --dt 0.05");
    EXPECT_EQ(r.status, 3) << r.err;
    EXPECT_TRUE(has(r.err, "an error of the method has added "));
    const std::size_t end = r.err.find(" works: a trial");
    ASSERT_NE(end, r.err.npos) << r.err;
    const std::size_t begin = r.err.rfind(": --", end) + 2;
    EXPECT_FALSE(has(success(net + more + r.err.substr(begin, end - begin)).err,
                     "another energy"));
  }
}

TEST_F(ClothProgram, SaysNothingOfAnEnergyThatIsRoundOff) {
  const Result r =
      success("--sheet 'nodes 3 3' --stiffness 0 --headless --t-end 1");
  EXPECT_EQ(r.err, "");
  EXPECT_FALSE(has(r.out, "half of dt: energy")) << r.out;
}

// The side turns by 4 degrees in a step: the sum of its work is off, but half
// of the step gives the same energy and positions.
TEST_F(ClothProgram, BelievesHalfOfTheStepMoreThanSumsOfWork) {
  const std::string net =
      "--stiffness 300 --sheet 'nodes 9 12' --damping 2 --pin 'x 0 turn -3.3 "
      "-1.7 0 until 0.1' --t-end 0.9 --dt 0.018 --headless --method ";
  for (const char* more : {"", " --quiet"})
    EXPECT_EQ(run(net + "implicit-midpoint" + more).status, 0) << more;
}

TEST_F(ClothProgram, SaysIfMollifiedImpulseFindsNoStiffSprings) {
  const std::string net =
      "--sheet 'nodes 9 9' --t-end 0.01 --method mollified-impulse --headless ";
  const std::string words = "finds no stiff springs here";
  EXPECT_TRUE(has(run(net).err, words));
  EXPECT_FALSE(has(
      run(net + "--region 'from 0 0 0 to 0.01 1 0 stiffness-factor 1e4'").err,
      words));
}

}  // namespace
