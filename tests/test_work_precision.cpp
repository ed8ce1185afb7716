// Problem.hpp and work_precision: exact solutions and references, the counting
// of force evaluations, and the CSV. Build the program first: make
// work_precision.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "CME212/Util.hpp"
#include "lab/charts/Problem.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/methods/Splitting.hpp"
#include "lab/stability/Spectrum.hpp"
#include "tests/SweptForces.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace fs = std::filesystem;

namespace {

Problem problem(const std::string& name) {
  for (Problem& p : make_problems())
    if (p.name == name) return p;
  throw std::runtime_error("no problem " + name);
}

double distance(std::span<const Point> a, std::span<const Point> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += normSq(a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

// A free fall; half of the speed at the floor is lost along it, too; then
// friction of a half of the weight.
TEST(Problem, ASlidingClothStopsWhereFrictionHasIt) {
  const Problem p = problem("slide");
  const Outcome out = run(p, *table::verlet.make(), 8000);
  ASSERT_TRUE(out.ok()) << out.reason;
  const double fall = std::sqrt(2 * 0.05 / grav), v = 1 - grav * fall / 2;
  EXPECT_NEAR(out.end.center.x, 0.5 + fall + v * v / grav, 2e-4);
  EXPECT_NEAR(out.end.energy, 0, 1e-3);
}

TEST(Problem, ExactSolutionsStartAsTheClothAndObeyItsForces) {
  for (const char* name : {"chain", "curtain"}) {
    Problem p = problem(name);
    Start s(p);
    ASSERT_EQ(p.exact(0).size(), arrays(s.cloth).node_slots());
    EXPECT_LT(distance(p.exact(0), arrays(s.cloth).positions()), 1e-15) << name;
    // Its second difference in time is the acceleration, also on the way.
    constexpr double t = 0.3, h = 1e-5;
    auto before = p.exact(t - h), now = p.exact(t), after = p.exact(t + h);
    std::copy(now.begin(), now.end(), arrays(s.cloth).positions().begin());
    auto f = swept_forces(s.cloth, s.force);
    s.constraint.each_held(s.cloth, [&f](Node n) { f[n.id()] = Point(); });
    for (unsigned i = 0; i < now.size(); ++i) {
      Point a = (after[i] - 2 * now[i] + before[i]) / (h * h);
      EXPECT_LT(norm(a - f[i] / arrays(s.cloth).node_values()[i].mass), 1e-3)
          << name << " node " << i;
    }
  }
}

// The two of a reference, run here: so far is the one from the other.
TEST(Problem, ReferencesAreOfTwoMethodsOfDifferentOrderAndStep) {
  Problem drape = problem("drape"), tear = problem("tear");
  for (Problem* p : {&drape, &tear})
    p->mesh = grid_problem("", "", 0, 9).mesh, p->damping = 1 / 81.;
  for (const Problem& p : {problem("grid0"), drape, tear}) {
    const Reference r = reference(p, 4);
    std::istringstream made(r.made);
    std::string name[2], word;
    long long steps[2];
    made >> name[0] >> steps[0] >> word >> name[1] >> steps[1] >> word;
    ASSERT_TRUE(made.good() || made.eof()) << r.made;
    const MethodEntry *one = find_method(name[0]), *two = find_method(name[1]);
    ASSERT_TRUE(one && two) << r.made;
    EXPECT_NE(one->info.order, two->info.order) << r.made;
    EXPECT_NE(steps[0], steps[1]) << r.made;
    Outcome a = run(p, *one->make(), steps[0]),
            b = run(p, *two->make(), steps[1]);
    EXPECT_EQ(distance(p, a.end, r.end), 0) << r.made;
    EXPECT_EQ(distance(p, a.end, b.end), r.floor) << r.made;
    EXPECT_LT(r.floor, 1e-4) << r.made;
  }
}
TEST(Problem, ReferencesKnowTheWholeEnd) {
  for (const char* name : {"chain", "curtain"}) {
    Problem p = problem(name);
    const Reference r = reference(p, 2);
    EXPECT_TRUE(begins(r.made, "exact, srkn11b "));
    Srkn11b method;
    Start s(p);
    const End end = run(p, method,
                        std::lround(16 * p.t_end *
                                    omega_safe(s.cloth, s.force, s.constraint) /
                                    Srkn11b::info.limit))
                        .end;
    EXPECT_LT(norm(r.end.center - end.center), 1e-10) << name;
    EXPECT_NEAR(r.end.energy, end.energy, 1e-8) << name;
  }
}

// A method that keeps its last force takes one sweep more in its first step.
TEST(Problem, CountsTheSweepsThatMethodsDeclare) {
  const std::set<std::string> keeps = {"verlet", "mollified-impulse", "srkn11b",
                                       "rkn64"};
  // What they take depends on the force; see their MethodInfo.
  const std::set<std::string> newton = {"implicit-midpoint", "tr-bdf2"};
  Problem p = problem("grid0");
  p.t_end = 0.02;
  for (const MethodEntry& m : methods) {
    const std::string name(m.info.name);
    constexpr long long steps = 10;
    auto method = m.make();
    method->set_tolerance(no_limit);
    Outcome out = run(p, *method, steps);
    ASSERT_TRUE(out.ok()) << name << ": " << out.reason;
    EXPECT_EQ(out.steps, steps) << name;
    if (newton.contains(name))
      EXPECT_GE(out.sweeps, steps * m.info.sweeps) << name;
    else
      EXPECT_EQ(out.sweeps, steps * m.info.sweeps + keeps.contains(name))
          << name;
  }
}

TEST(Problem, SaysWhyARunFailed) {
  Problem p = problem("grid0");
  Verlet verlet;
  Outcome out = run(p, verlet, 100);  // dt is 4 times the limit
  EXPECT_EQ(out.status, Outcome::Status::diverged);
  EXPECT_TRUE(begins(out.reason, "energy out of bounds at t = "));
  EXPECT_LT(out.steps, 100);
  out = run(p, verlet, 100, false);  // the energy at the end says it
  EXPECT_EQ(out.status, Outcome::Status::diverged);
  EXPECT_EQ(out.steps, 100);
}

// ---------------------------------------------------------------- The program

using CME212::contents;

class WorkPrecision : public ::testing::Test {
 protected:
  const CME212::TestFolder folder;
  const fs::path& dir = folder.path();

  /** @return the exit status */
  int run_program(const std::string& arguments) {
    return folder.run("${BUILD:-build}/work_precision " + arguments).status;
  }
  std::string err() { return contents(dir / "err"); }
  std::string printed() { return contents(dir / "out"); }
  std::string csv() { return (dir / "w.csv").string(); }

  using Row = std::map<std::string, std::string>;  // by head of the column
  std::vector<Row> rows() {
    std::istringstream in(contents(csv()));
    std::vector<std::string> head;
    std::vector<Row> all;
    for (std::string line, cell; std::getline(in, line);) {
      if (line[0] == '#') continue;
      std::vector<std::string> cells;
      std::istringstream words(line + ",");
      while (std::getline(words, cell, ',')) cells.push_back(cell);
      if (head.empty()) {
        head = cells;
        continue;
      }
      EXPECT_EQ(cells.size(), head.size()) << line;
      Row& row = all.emplace_back();
      for (std::size_t k = 0; k < std::min(cells.size(), head.size()); ++k)
        row[head[k]] = cells[k];
    }
    return all;
  }
};

TEST_F(WorkPrecision, WritesATableThatIsWholeAndTrue) {
  ASSERT_EQ(run_program("--quick --repeats 3 --scenes chain --methods "
                        "forward-euler,verlet,rkn64 --out " +
                        csv()),
            0)
      << err();
  EXPECT_TRUE(has(contents(csv()), "# reference chain: exact, srkn11b "));
  std::set<std::string> seen;
  for (Row& row : rows()) {
    const bool ok = row["status"] == "ok";
    seen.insert(row["method"] + " " + row["status"]);
    EXPECT_EQ(row["scene"], "chain");
    EXPECT_EQ(row["reason"].empty(), ok);
    EXPECT_NE(row["dt [s]"].empty(), row["tolerance [m]"].empty());
    for (const char* c : {"seconds_min [s]", "seconds_median [s]", "error [m]"})
      EXPECT_EQ(row[c].empty(), !ok) << c;
    for (auto& [column, cell] : row) {
      if (column == "scene" || column == "method" || column == "norm" ||
          column == "status" || column == "reason" || cell.empty())
        continue;
      std::size_t end = 0;
      EXPECT_TRUE(std::isfinite(std::stod(cell, &end))) << column;
      EXPECT_EQ(end, cell.size()) << column << " " << cell;
    }
  }
  EXPECT_EQ(seen, (std::set<std::string>{"forward-euler diverged",
                                         "forward-euler ok", "verlet diverged",
                                         "verlet ok", "rkn64 ok"}));

  // The columns, computed once more here.
  const Problem p = problem("chain");
  const double floor = reference(p, 8).floor;
  std::map<std::string, std::vector<Row>> of;
  auto number = [](Row& row, const char* head) { return std::stod(row[head]); };
  for (Row& row : rows()) {
    EXPECT_NEAR(number(row, "floor [m]") / floor, 1, 1e-5);
    if (row["status"] == "ok") {
      EXPECT_GT(number(row, "seconds_min [s]"), 0);
      EXPECT_LE(number(row, "seconds_min [s]"),
                number(row, "seconds_median [s]"));
    }
    if (row["tolerance [m]"].empty()) {
      EXPECT_NEAR(number(row, "dt [s]") * number(row, "steps"), 0.8, 1e-5);
    }
    of[row["method"]].push_back(row);
  }
  for (Row& row : of["forward-euler"]) {
    EXPECT_EQ(row["dt/limit"], "");
    EXPECT_EQ(row["sweeps"], row["steps"]);
  }
  // Twice the largest stable step, that step, and each half of the last one.
  double share = 2;
  for (Row& row : of["verlet"]) {
    EXPECT_LE(number(row, "dt/limit"), share);
    EXPECT_GT(number(row, "dt/limit"), 0.9 * share);
    share /= 2;
    if (row["status"] != "ok") continue;
    const auto steps = std::stoll(row["steps"]);
    EXPECT_EQ(number(row, "sweeps"), double(steps + 1));
    Verlet verlet;
    double error = distance(p.exact(0.8), run(p, verlet, steps).end.positions);
    EXPECT_NEAR(number(row, "error [m]") / error, 1, 1e-5);
  }
  EXPECT_GT(of["verlet"].size(), 2u);
  // A tenth of the tolerance each time, and nothing beyond ten floors.
  auto& adaptive = of["rkn64"];
  for (std::size_t k = 0; k < adaptive.size(); ++k) {
    EXPECT_NEAR(number(adaptive[k], "tolerance [m]") * std::pow(10, 2 + k), 1,
                1e-5);
    if (k + 1 < adaptive.size()) {
      EXPECT_GT(number(adaptive[k], "error [m]"), 10 * floor);
    }
  }
}

TEST_F(WorkPrecision, RefinesTheGridTheStepOrBoth) {
  ASSERT_EQ(run_program("--grid-refinement --quick --quiet --out " + csv()), 0)
      << err();
  std::map<std::string, std::vector<double>> error, dt;
  for (Row& row : rows()) {
    error[row["refined"]].push_back(std::stod(row["error [m]"]));
    dt[row["refined"]].push_back(std::stod(row["dt [s]"]));
    EXPECT_NEAR((std::stod(row["sweeps"]) - 1) * dt[row["refined"]].back(),
                0.25, 1e-5);
  }
  for (const char* refined : {"grid", "both"}) {
    auto& e = error[refined];
    ASSERT_EQ(e.size(), 3u);
    EXPECT_GT(e[0], 2 * e[1]);
    EXPECT_GT(e[1], 2 * e[2]);
  }
  EXPECT_EQ(error["grid"].back(), error["both"].back());
  EXPECT_NEAR(error["step"].back() / error["step"].front(), 1, 1e-3);
  EXPECT_EQ(dt["grid"].front(), dt["grid"].back());
  for (const char* refined : {"step", "both"})
    EXPECT_NEAR(dt[refined].front() / dt[refined].back(), 4, 0.1);
}

TEST_F(WorkPrecision, RefusesWhatCantBeAndLeavesNoFile) {
  auto refused = [this](const std::string& arguments, const char* message) {
    EXPECT_EQ(run_program(arguments + " --out " + csv()), 2) << arguments;
    EXPECT_TRUE(has(err(), message));
    EXPECT_FALSE(fs::exists(csv()) || fs::exists(csv() + ".part"));
  };
  refused("--scenes nowhere", "--scenes: nowhere not in {chain,curtain,grid0");
  refused("--methods verlet,magic", "--methods: magic not in {");
  refused("--repeats 0", "--repeats: Value 0 not in range");
  EXPECT_TRUE(has(err(), "1000"));  // the bound
  EXPECT_EQ(run_program("--quick --scenes chain --out no/such"), 2);
}

}  // namespace
