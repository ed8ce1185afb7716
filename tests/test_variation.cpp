// Measure.hpp, Variation.hpp: what a scene is asked, and which of its parts the
// answer needs: for each file in data/scenes/ all that it names, and nothing
// more.
//
// lab/scenes/needs.csv is compared with what is measured here, and written by
//   WRITE_TABLE=build/needs.csv build/test_variation --gtest_filter='*Need*'
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <tuple>

#include "lab/advice/Variation.hpp"
#include "lab/fast/Energy.hpp"
#include "lab/fast/ForcePlan.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/scenes/StoredScenes.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Trial.hpp"
#include "tests/Built.hpp"
#include "tests/ReadParts.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace {

Model verlet_with(const std::string& sheet) {
  Model m = with_sheet(sheet);
  m.method = &table::verlet;
  return m;
}

/** The sum of all nodes' c [kg/s]. */
double drag_of(const Model& m, const Cloth& g) {
  const CombinedForces force = force_of(m, mesh_of(m), g);
  const ForcePlan plan = force;
  double sum = 0;
  for (Node n : g.nodes()) sum += plan.drag()[n.id()];
  return sum;
}

// -------------------------------------------------------------------- Answers

TEST(Answers, DistanceIsALengthAndForPositionsTheRootOfTheMeanSquare) {
  EXPECT_EQ(distance({1, 2, 3}, {1, 5, 7}, Measure::com), 5);
  EXPECT_EQ(distance({-3}, {1}, Measure::energy), 4);
  EXPECT_EQ(distance({1, 2, 3}, {1, 2, 3}, Measure::com), 0);
  // Four places, one of which is 5 m off.
  Answer a(12), b(12);
  b[4] = 3, b[5] = -4;
  EXPECT_EQ(distance(a, b, Measure::positions), 2.5);
}

TEST(Answers, OfAClothOfThreeNodes) {
  const Model m = verlet_with("");
  Cloth g;
  const Node a = g.add_node(Point(0, 0, 1), {Point(3, 0, 4), 2});
  const Node b = g.add_node(Point(0, 0, -2), {Point(), 1});
  const Node c = g.add_node(Point(4, 0, -2), {Point(), 1});
  g.add_edge(a, b, {10, 2});  // 3 m long
  g.add_edge(b, c, {10, 5});  // 4 m long
  g.add_edge(c, a, {0, 0});   // no spring
  EXPECT_EQ(answer(m, g, Measure::com), (Answer{1, 0, -0.5}));
  const double kinetic = 25, elastic = 5 + 5, height = 2 * 1 - 2 - 2;
  EXPECT_NEAR(answer(m, g, Measure::energy)[0],
              kinetic + elastic + grav * height, 1e-13);
  EXPECT_EQ(answer(m, g, Measure::max_stretch), (Answer{0.5}));
  EXPECT_EQ(answer(m, g, Measure::drape_height), (Answer{-2}));
  Model moon = m;
  moon.gravity = 1.62;
  EXPECT_NEAR(answer(moon, g, Measure::energy)[0],
              kinetic + elastic + 1.62 * height, 1e-13);
}

TEST(Answers, StretchIsNeverNegativeAndAnEmptyClothIsFlat) {
  const Model m = verlet_with("");
  Cloth g;
  EXPECT_EQ(answer(m, g, Measure::drape_height), (Answer{0}));
  EXPECT_EQ(answer(m, g, Measure::max_stretch), (Answer{0}));
  const Node a = g.add_node(Point(0, 0, 3)), b = g.add_node(Point(1, 0, 5));
  g.add_edge(a, b, {1, 9});
  EXPECT_EQ(answer(m, g, Measure::max_stretch), (Answer{0}));
  EXPECT_EQ(answer(m, g, Measure::drape_height), (Answer{3}));
}

/** Build @a m and lay it as a saddle over its sheets, each (s, t) of [0, 1]^2
 * at (s, 2 t, s t + number of the sheet). */
Answer positions_on_a_saddle(const Model& m) {
  Cloth g = built(m);
  unsigned k = 0;
  for (std::size_t number = 0; number < m.sheets.size(); ++number) {
    const auto [n, p] = m.sheets[number].nodes;
    for (unsigned i = 0; i < n; ++i)
      for (unsigned j = 0; j < p; ++j) {
        const double s = i / double(n - 1), t = j / double(p - 1);
        g.node(k++).position() = Point(s, 2 * t, s * t + double(number));
      }
  }
  return answer(m, g, Measure::positions);
}

TEST(Answers, PositionsAreOfTheSamePlacesOnAllGrids) {
  Model coarse = verlet_with("nodes 2 3"), fine = verlet_with("nodes 20 6");
  const Answer a = positions_on_a_saddle(coarse);
  ASSERT_EQ(a.size(), 3u * 9 * 9);
  EXPECT_EQ(Point(a[3], a[4], a[5]), Point(0, 0.25, 0));
  EXPECT_EQ(Point(a[240], a[241], a[242]), Point(1, 2, 1));
  EXPECT_LT(distance(a, positions_on_a_saddle(fine), Measure::positions),
            1e-15);
  coarse.sheets.push_back(read_sheet("at 0 0 9 nodes 4 4"));
  fine.sheets.push_back(read_sheet("at 0 0 9 nodes 2 9"));
  const Answer b = positions_on_a_saddle(coarse);
  ASSERT_EQ(b.size(), 2 * a.size());
  EXPECT_EQ(b[3 * 81 + 2], 1);  // the second sheet's corner
  EXPECT_LT(distance(b, positions_on_a_saddle(fine), Measure::positions),
            1e-15);
}

/** The drape height of a sheet of @a n x @a p nodes at heights z(s, t), where
 * (s, t) of [0, 1]^2 is the place on the sheet. */
double drape_height(unsigned n, unsigned p,
                    const std::function<double(double, double)>& z) {
  const Model m =
      verlet_with("nodes " + std::to_string(n) + ' ' + std::to_string(p));
  Cloth g = built(m);
  unsigned k = 0;
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < p; ++j) {
      const double s = i / double(n - 1), t = j / double(p - 1);
      g.node(k++).position() = Point(s, t, z(s, t));
    }
  return answer(m, g, Measure::drape_height)[0];
}

TEST(Answers, TheLowestPointOfAParaboloidIsTheSameOnAllGrids) {
  // Lowest where 2 (s - 0.47) + 0.3 t = 0 and 4 (t - 0.52) + 0.3 s = 0.
  auto bowl = [](double s, double t) {
    return (s - 0.47) * (s - 0.47) + 2 * (t - 0.52) * (t - 0.52) + 0.3 * s * t;
  };
  const double s = (0.94 * 4 - 0.3 * 2.08) / (8 - 0.09),
               t = (2.08 - 0.3 * s) / 4;
  for (unsigned n : {4u, 5u, 8u, 25u})
    for (unsigned p : {4u, 7u, 40u})
      EXPECT_NEAR(drape_height(n, p, bowl), bowl(s, t), 1e-13) << n << ' ' << p;
  // At a border, and in a corner of a sheet of one cell.
  EXPECT_NEAR(
      drape_height(
          6, 9, [](double u, double v) { return u + (v - 0.3) * (v - 0.3); }),
      0, 1e-13);
  EXPECT_EQ(drape_height(2, 2, [](double u, double v) { return 1 - u * v; }),
            0);
}

TEST(Answers, OfATornClothTheLowestNodeCounts) {
  for (bool tears : {false, true}) {
    Model m = verlet_with("nodes 3 3");
    if (tears) m.tear_strain = 0.5;
    Cloth g = built(m);
    for (unsigned k = 0; k < 9; ++k) g.node(k).position().z = k / 3 == 2;
    g.node(4).position().z = -0.1;  // beside 0 and 1: lower between the nodes
    const double lowest = answer(m, g, Measure::drape_height)[0];
    EXPECT_TRUE(tears ? lowest == -0.1 : lowest < -0.2) << lowest;
    g.remove_node(g.node(8));
    EXPECT_EQ(answer(m, g, Measure::drape_height)[0], -0.1);
  }
}

TEST(Answers, TheLowestPointIsNotBelowAFloor) {
  // Flat up to s = 0.5, lifted from there on.
  for (unsigned n : {5u, 6u, 7u, 12u})
    EXPECT_EQ(drape_height(n, n,
                           [](double s, double) {
                             return s <= 0.5 ? -1 : -1 + (s - 0.5) * (s - 0.5);
                           }),
              -1)
        << n;
  // A ridge between two valleys: the lower one counts.
  EXPECT_NEAR(drape_height(
                  81, 5, [](double s, double) { return std::cos(12 * s) - s; }),
              std::cos(12 * 0.792351) - 0.792351, 5e-5);
}

TEST(Answers, PositionsOfAMeshAreItsNodes) {
  Model m;
  m.nodes = "data/grid0.nodes", m.tets = "data/grid0.tets";
  Cloth g = built(m);
  const Answer a = answer(m, g, Measure::positions);
  ASSERT_EQ(a.size(), 75u);
  for (unsigned i = 0; i < 25; ++i)
    EXPECT_EQ(Point(a[3 * i], a[3 * i + 1], a[3 * i + 2]),
              g.node(i).position());
}

TEST(Answers, AClothThatTearsKeepsNoPositions) {
  for (const Quantity& q : std::span(quantities).first(Measure::pin_force)) {
    Model m = verlet_with("nodes 3 3");
    m.measure = read_measure(q.name);
    const bool positions = m.measure == Measure::positions;
    EXPECT_NO_THROW(check_question(m));
    Model ball = m, strain = m;
    ball.tears = {read_tear("radius 0.1")};
    strain.tear_strain = 0.1;
    for (const Model& torn : {ball, strain})
      if (positions)
        EXPECT_THROW(check_question(torn), SceneError);
      else
        EXPECT_NO_THROW(check_question(torn)) << q.name;
  }
}

// ----------------------------------------------------------------------- Runs

TEST(TryOut, EndsAtTheEnd) {
  Model m = verlet_with("nodes 3 3");  // falls
  auto steps = [&m](double dt, double t_end) {
    m.step.dt = dt, m.t_end = t_end;
    const Trial t = try_out(m);
    EXPECT_TRUE(t.ok()) << t.failure.value_or("");
    EXPECT_NEAR(t.answer[2], -0.5 * grav * t_end * t_end, 1e-13);
    EXPECT_NEAR(t.dt * double(t.steps), t_end, 1e-14);
    EXPECT_LE(t.dt, dt * (1 + 1e-11));
    // 12 sides, 8 diagonals; the first force is that at the start.
    EXPECT_EQ(t.work, 20. * double(t.steps + 1));
    return t.steps;
  };
  EXPECT_EQ(steps(0.03, 0.1), 4);
  EXPECT_EQ(steps(0.025, 0.1), 4);
  EXPECT_EQ(steps(0.0249, 0.1), 5);
  // A quotient that is rounded up: 7.000000000000001.
  EXPECT_EQ(steps(0.01, 0.07), 7);
  m.t_end = 0;
  EXPECT_EQ(try_out(m).steps, 0);
  EXPECT_LT(distance(try_out(m).answer, {0.5, 0.5, 0}, Measure::com), 1e-15);
}

TEST(TryOut, ChoosesItsStepAsTheSceneDoes) {
  Model m = verlet_with("nodes 5 5");
  m.step = {.rule = StepRule::safe};
  m.t_end = 0.1;
  const double chosen = Scene(m).dt();
  const Trial t = try_out(m);
  EXPECT_EQ(t.steps, std::ceil(m.t_end / chosen));
  EXPECT_EQ(t.dt, m.t_end / double(t.steps));
}

TEST(TryOut, SaysWhyItFailed) {
  Model m = verlet_with("nodes 20 20");
  m.pins = {read_pin("x 0")};
  m.step.dt = 0.02, m.t_end = 2;
  const Trial t = try_out(m);
  EXPECT_FALSE(t.ok());
  EXPECT_TRUE(begins(t.failure.value_or(""), "diverged in step"));
  EXPECT_TRUE(t.answer.empty());
}

// ----------------------------------------------------------------- Variations

TEST(Refined, IsTheSameCloth) {
  Model m = verlet_with("at 1 2 3 u 2 0 0 v 0 0.5 0 nodes 5 4");
  m.sheets.push_back(read_sheet("nodes 3 3"));
  m.material.density = 0.3;
  for (bool per_area : {true, false}) {
    if (per_area)
      m.material.drag = 2;
    else
      m.material.drag.reset(), m.damping = 0.01;
    Cloth g = built(m);
    const double drag = drag_of(m, g);
    for (double factor : {0.1, 0.5, 1., 1.5, 2., 3.}) {
      const Model r = refined(m, factor);
      Cloth f = built(r);
      EXPECT_NEAR(total_mass(f), total_mass(g), 1e-14);
      EXPECT_NEAR(drag_of(r, f), drag, 1e-14);
      EXPECT_LT(norm(center_of_mass(f) - center_of_mass(g)), 1e-14);
    }
  }
  auto nodes = [&m](double factor) {
    return refined(m, factor).sheets[0].nodes;
  };
  using Nodes = std::array<unsigned, 2>;
  EXPECT_EQ(nodes(2), (Nodes{9, 7}));
  EXPECT_EQ(nodes(1), (Nodes{5, 4}));
  EXPECT_EQ(nodes(0.75), (Nodes{4, 3}));
  EXPECT_EQ(nodes(0.01), (Nodes{3, 3}));  // never less than 2 x 2 cells
  m.sheets = {m.sheets[0], m.sheets[0]};
  const Model own = refined(m, {{2, 1}, {0.5, 3}});
  EXPECT_EQ(own.sheets[0].nodes, (Nodes{9, 4}));
  EXPECT_EQ(own.sheets[1].nodes, (Nodes{3, 10}));
}

/** The answers on grids of 8, 16 and 32 cells along each side. */
std::vector<Answer> on_three_grids(Model m, Measure measure) {
  m.measure = measure;
  std::vector<Answer> at;
  for (unsigned nodes : {9, 17, 33}) {
    m.sheets = {{.nodes = {nodes, nodes}}};
    at.push_back(try_out(m).answer);
  }
  return at;
}

// test_compose has the smooth case, order 2. A membrane let go flat gets a kink
// that runs in from the rim.
TEST(Refining, ConvergesAtOrderOneWhereTheClothHasKinks) {
  Model m = load_model("data/scenes/membrane.toml");
  m.t_end = 0.1;
  const auto at = on_three_grids(m, Measure::positions);
  EXPECT_NEAR(std::log2(distance(at[0], at[1], Measure::positions) /
                        distance(at[1], at[2], Measure::positions)),
              1, 0.1);
}

// All of the weight hangs by one node, whatever the grid: the force stays, the
// width that bears it halves.
TEST(Refining, NeverGivesTheStretchAtAPinnedCorner) {
  Model m = load_model("data/scenes/hanging-sheet.toml");
  m.damping = 0;
  m.material.density = 1;
  m.material.modulus = 100;
  m.material.drag = 1;
  const auto at = on_three_grids(m, Measure::max_stretch);
  EXPECT_NEAR(at[0][0], 0.28, 0.01);
  EXPECT_NEAR(at[1][0], 0.46, 0.01);
  EXPECT_NEAR(at[2][0], 0.80, 0.01);
}

TEST(Variation, KnowsTheShortestSide) {
  EXPECT_NEAR(shortest_side(verlet_with("u 3 0 0 nodes 4 6")), 0.2, 1e-15);
  EXPECT_NEAR(shortest_side(verlet_with("v 0 30 0 nodes 4 6")), 1 / 3., 1e-15);
}

/** @a m without the friction of @a part. */
Model smooth(const Model& m, const std::string& part) {
  const auto without = without_all(m, {"friction of " + part});
  EXPECT_TRUE(without) << part;
  return without.value_or(m);
}

TEST(Variation, LeavesOutFriction) {
  Model m = verlet_with("nodes 5 5");
  for (auto [text, words, left] :
       {std::tuple("friction 0.5", ": friction 0.5", ""),
        {"at 0 0 1 friction 0.5", ": at 0 0 1 friction 0.5", "at 0 0 1"},
        {"friction  1e-1 at 0 0 1", ": at 0 0 1 friction 0.1", "at 0 0 1"}}) {
    m.planes = {read_plane(text)};
    EXPECT_EQ(to_words(smooth(m, std::string("plane") + words).planes[0]),
              left);
  }
  m.spheres = {read_sphere("radius 1\tfriction 0.5\tat 0 0 1")};
  const Model without = smooth(m, "sphere: at 0 0 1 radius 1 friction 0.5");
  EXPECT_EQ(to_words(without.spheres[0]), "at 0 0 1 radius 1");
  m.spheres.clear();
  m.planes = {read_plane("at 0 0 1"), read_plane("friction 0")};
  EXPECT_FALSE(without_all(m, {"friction of plane: at 0 0 1"}));
  EXPECT_FALSE(without_all(m, {"friction of plane"}));
  m.planes = {read_plane("normal 0 1 0 friction 0.5 velocity 0 1 0 until 2")};
  const Wall w =
      smooth(m, "plane: normal 0 1 0 friction 0.5 velocity 0 1 0 until 2")
          .planes[0];
  EXPECT_EQ(w.friction, 0);
  EXPECT_EQ(w.motion.until, 2);
  EXPECT_EQ(w.normal, Point(0, 1, 0));
}

// A part that is all default has its key as its name.
TEST(Variation, NamesADefaultPartByItsKey) {
  const std::vector<Variation> all = without_parts(assignment_scene());
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[2].part, "pin: x 0 y 0 z 0");
  EXPECT_EQ(all[4].part, "plane");
  EXPECT_EQ(all[5].part, "tear");
}

/** A scene that names everything. */
Model full_scene() {
  Model m = verlet_with("nodes 5 5");
  m.edges = {.diagonals = true, .bend = true};
  m.material.density = 1;
  m.material.modulus = 100;
  m.material.drag = 1;
  m.pins = {read_pin("x 0"), read_pin("x 1 velocity 0 0 1")};
  m.planes = {read_plane("friction 0.5")};
  m.spheres = {read_sphere("radius 0.1")};
  m.tears = {read_tear("radius 0.2")};
  m.tear_strain = 0.5;
  m.self_collision = read_self_collision("thickness 0.1 friction 0.2");
  return m;
}

TEST(Variation, DropsEachPartInTurnAndNothingElse) {
  const Model m = full_scene();
  // What differs in the scene file: the line without the part.
  const std::map<std::string, std::string> expected = {
      {"edges: diagonals", "edges = \"sides bend\""},
      {"edges: bend", "edges = \"sides diagonals\""},
      {"gravity", "gravity = 0"},
      {"drag", "drag = 0"},
      {"pin: x 0", "pin = [\"x 1 velocity 0 0 1\"]"},
      {"pin: x 1 velocity 0 0 1", "pin = [\"x 0\"]"},
      {"plane: friction 0.5", ""},
      {"friction of plane: friction 0.5", "plane = [\"\"]"},
      {"sphere: radius 0.1", ""},
      {"tear: radius 0.2", ""},
      {"tear-strain", ""},
      {"self-collision", ""},
      {"friction of self-collision", "self-collision = \"thickness 0.1\""}};
  auto lines = [](const Model& a) {
    std::istringstream in(to_scene_file(a));
    std::set<std::string> all;
    for (std::string line; std::getline(in, line);)
      if (line[0] != '#') all.insert(line);
    return all;
  };
  const auto before = lines(m);
  std::set<std::string> parts;
  for (const Variation& v : without_parts(m)) {
    EXPECT_TRUE(parts.insert(v.part).second);
    ASSERT_TRUE(expected.count(v.part)) << v.part;
    const auto after = lines(v.model);
    std::vector<std::string> gone, come;
    std::ranges::set_difference(before, after, std::back_inserter(gone));
    std::ranges::set_difference(after, before, std::back_inserter(come));
    EXPECT_EQ(gone.size(), 1u) << v.part;
    const std::string line = expected.at(v.part);
    EXPECT_EQ(come, line.empty() ? std::vector<std::string>()
                                 : std::vector<std::string>{line});
  }
  EXPECT_EQ(parts.size(), expected.size());
}

TEST(Variation, KeepsTheGravityOfAnEnergy) {
  Model m = verlet_with("nodes 5 5");
  auto drops = [&m] {
    return 1 ==
           std::ranges::count(without_parts(m), "gravity", &Variation::part);
  };
  EXPECT_TRUE(drops());
  m.measure = Measure::energy;
  EXPECT_FALSE(drops());
}

TEST(Variation, DropsNothingThatIsNotThere) {
  Model m = verlet_with("nodes 5 5");
  m.edges.diagonals = false;
  m.gravity = 0;
  m.material.drag = 0;
  EXPECT_TRUE(without_parts(m).empty());
  m.material.drag.reset();
  EXPECT_TRUE(without_parts(m).empty());
  m.damping = 1;
  ASSERT_EQ(without_parts(m).size(), 1u);
  EXPECT_EQ(without_parts(m)[0].model.damping, 0);
}

// ----------------------------------------------------------------------- Need

/** The names of the files in data/scenes/: those of the assignment, whose mesh
 * is open, or those with a mesh. */
std::vector<std::string> scene_names(bool open = false) {
  std::vector<std::string> names;
  for (const StoredScene& s : stored_scenes())
    if (s.model().sheets.empty() == open) names.push_back(s.name);
  return names;
}

TEST(ThePageOfScenes, NamesEveryKeyAndScene) {
  const std::string page = CME212::contents("lab/scenes/README.md");
  for (const std::string& name : scene_keys())
    EXPECT_TRUE(has(page, "| `" + name + "` |")) << name;
  EXPECT_EQ(scene_names(true).size(), 5u);
  for (const std::string& name : scene_names(true))
    EXPECT_TRUE(has(page, "](../../data/scenes/" + name + ".toml)")) << name;
  for (const std::string& name : scene_names()) {
    EXPECT_TRUE(has(page, "\n### `" + name + "`\n")) << name;
    EXPECT_TRUE(
        std::filesystem::exists("docs/pictures/scene-" + name + ".png"));
  }
}

/** @a m with each refinement that it could have next: diagonals, a grid of
 * twice as many cells along each side, half the step, and self-collision with a
 * thickness that lets no node through a quad of squares. */
std::vector<Variation> with_more_parts(const Model& m) {
  std::vector<Variation> all;
  auto add = [&](const std::string& part, auto change) {
    all.push_back({part, m});
    change(all.back().model);
  };
  if (!m.edges.diagonals)
    add("edges: diagonals", [](Model& x) { x.edges.diagonals = true; });
  add("finer grid", [](Model& x) { x = refined(x, 2); });
  add("half the step", [](Model& x) { x.step = {.dt = step_of(x) / 2}; });
  if (!m.self_collision)
    add("self-collision", [](Model& x) {
      x.self_collision = Distance{.thickness = 0.75 * shortest_side(x)};
    });
  return all;
}

class Need : public ::testing::TestWithParam<std::string> {};

// Each with room: a scene whose need hangs by a hair is a scene to be improved.
TEST_P(Need, IsWhatTheSceneNamesAndNothingMore) {
  constexpr double room = 1.15;
  const Model m = load_model("data/scenes/" + GetParam() + ".toml");
  check_question(m);
  const Measure what = m.measure;
  const Trial base = try_out(m);
  ASSERT_TRUE(base.ok()) << base.failure.value_or("");

  const std::string needs = CME212::contents("lab/scenes/needs.csv");
  const char* table = std::getenv("WRITE_TABLE");
  std::ofstream out;
  if (table) out.open(table, std::ios::app);
  auto variations = without_parts(m);
  const std::size_t dropped = variations.size();
  std::ranges::copy(with_more_parts(m), std::back_inserter(variations));
  for (const Variation& v : variations) {
    const bool is_dropped = &v < &variations[dropped];
    const Trial t = try_out(v.model);
    const double change = t.ok() ? distance(base.answer, t.answer, what)
                                 : std::numeric_limits<double>::infinity();
    if (is_dropped)
      EXPECT_GT(change, room * m.tolerance) << "is not needed: " << v.part;
    else
      EXPECT_LT(change, m.tolerance / room) << "is needed: " << v.part;

    const std::string key =
        GetParam() + (is_dropped ? ",without " : ",with ") + v.part + ',';
    out << key << std::setprecision(2) << change << ',' << m.tolerance << ','
        << unit_of(what) << '\n';
    const auto at = needs.find('\n' + key);
    EXPECT_NE(at, std::string::npos) << "needs.csv has no row " << key;
    if (at == std::string::npos) continue;
    char* end = nullptr;
    const double said = std::strtod(needs.c_str() + at + 1 + key.size(), &end);
    EXPECT_NEAR(said, change, 0.05 * change + 1e-6) << key;
    EXPECT_EQ(std::strtod(end + 1, nullptr), m.tolerance) << key;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Need, ::testing::ValuesIn(scene_names()),
                         [](const auto& scene) {
                           return test_name(scene.param);
                         });

}  // namespace
