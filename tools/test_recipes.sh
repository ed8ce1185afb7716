#!/usr/bin/env bash
# Follow the recipes of docs/CONTRIBUTING.md in a copy of the tree: add a
# method, a force, a constraint, a scene, a part of a scene, a control and a
# chart; count the files that each takes; build once, and test each.
set -euo pipefail
cd "$(dirname "$0")/.."

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
export GIT_AUTHOR_NAME=T GIT_AUTHOR_EMAIL=t@example.org
export GIT_COMMITTER_NAME=T GIT_COMMITTER_EMAIL=t@example.org
git ls-files -co --exclude-standard | sort -u |
  while IFS= read -r file; do [ ! -f "$file" ] || echo "$file"; done |
  tar cf - -T - | tar xf - -C "$tmp"
cd "$tmp"
commit() { git add -A && git commit -qm "$1"; }
git init -q && commit start

passed=0 failed=0
ok() {  # NAME COMMAND...
  if "${@:2}"; then
    passed=$((passed + 1)); echo "ok    $1"
  else
    failed=$((failed + 1)); echo "FAIL  $1"
  fi
}
# Insert the standard input behind (or with -b before) the first line of FILE
# that has TEXT.
insert() {  # [-b] FILE TEXT
  local before=0 line
  [ "$1" != -b ] || { before=1; shift; }
  line=$(grep -nF -m 1 -- "$2" "$1" | cut -d: -f1) ||
    { echo "$1 has no line with $2: the recipe is out of date"; exit 1; }
  sed -i "$((line - before))r /dev/stdin" "$1"
}
takes() {  # NAME MOST: so many files were changed or added since the last one
  local files
  files=$(git status --porcelain -uall | wc -l)
  git status --porcelain -uall | sed 's/^/      /'
  ok "$1 takes $files files, at most $2" [ "$files" -le "$2" ]
  commit "$1"
}

# ---- A method: five Verlet steps, by M. Suzuki, Phys. Lett. A 146 (1990) 319
cat >lab/methods/Suzuki4.hpp <<'END'
#pragma once
#include <array>

#include "lab/methods/Splitting.hpp"

namespace lab {

struct Suzuki4Scheme {
  static constexpr MethodInfo info = {
      "suzuki4", 4, 5, 2.7210, "Suzuki 1990", "a recipe", "nothing"};
  static constexpr bool kicks_first = true;
  static constexpr double s = 0.4144907717943757;  // 1/(4 - 4^(1/3))
  static constexpr double r = 1 - 4 * s;
  static constexpr std::array steps = {s / 2,       s, s, s, (s + r) / 2, r,
                                       (s + r) / 2, s, s, s, s / 2};
};
extern template class Splitting<Suzuki4Scheme>;
using Suzuki4 = Splitting<Suzuki4Scheme>;

}  // namespace lab
END
sed -i 's/"lab\/methods\/Yoshida4.hpp"/"lab\/methods\/Suzuki4.hpp"\n#include &/
  s/entry_of<Yoshida4>(),/& entry_of<Suzuki4>(),/' lab/methods/Methods.hpp
sed -i 's/#include "lab\/methods\/Yoshida4.hpp"/&\n#include "lab\/methods\/Suzuki4.hpp"/
  s/template class Splitting<Yoshida4Scheme>;/&\ntemplate class Splitting<Suzuki4Scheme>;/' \
  lab/methods/Splitting.cpp
echo 'suzuki4,#56B4E9,splitting,5' >>lab/charts/methods.csv
takes method 4

# ---- A force of the assignment: f = m a
insert -b mass_spring.hpp '/** Linear drag' <<'END'
/** The same acceleration for each node: f = m a [N]. */
class PushForce : public ZeroForce {
 public:
  explicit PushForce(const Point& a) : a_(a) {}
  Point operator()(Node n, double /*t*/) const override {
    return n.value().mass * a_;
  }

 private:
  Point a_;  // [m/s^2]
};

END
takes force 1

# ---- A constraint of the assignment
insert -b mass_spring.hpp '/** Keeps nodes at rest' <<'END'
/** @post no node is above z = height [m]. */
class CeilingConstraint : public ZeroConstraint {
 public:
  explicit CeilingConstraint(double height) : height_(height) {}
  void operator()(Cloth& g, double /*t*/) const override {
    for (Node n : g.nodes())
      if (n.position().z > height_) {
        n.position().z = height_;
        n.value().vel.z = 0;
      }
  }

 private:
  double height_;
};

END
takes constraint 1

# ---- A scene
cat >data/scenes/flag.toml <<'END'
# A flag falls.
sheet = ["nodes 9 7"]
pin = ["x 0"]
t-end = 0.1
method = "verlet"
END
printf '\n## flag\n\nA flag falls.\n' >>lab/scenes/README.md
takes scene 2

# ---- A part of a scene: an upright tube that no node leaves
insert -b lab/scenes/Model.hpp '/** Nodes without a common edge keep' <<'END'
/** An upright tube that no node leaves. */
struct Tube {
  Point at = Point();  ///< on its axis [m]
  double radius = 1;   ///< [m]
};

END
insert lab/scenes/Model.hpp 'std::vector<Ball> tears;' <<<'  std::vector<Tube> tubes;'
insert lab/scenes/Words.hpp 'Words words_of(Ball&);' <<<'Words words_of(Tube&);'
sed -i 's/std::vector<Ball>\*>/std::vector<Ball>*, std::vector<Tube>*>/' lab/scenes/Words.hpp
insert -b lab/scenes/Words.cpp 'Words words_of(Distance& d)' <<'END'
Words words_of(Tube& t) {
  return {"tube", {{"at", &t.at}, {"radius", &t.radius, positive}}};
}
END
insert -b lab/scenes/Fields.cpp '{"tear-strain", contact' <<'END'
      {"tube", contact, scene, &m.tubes,
       "an upright tube that no node leaves: at X Y Z radius R [m]"},
END
insert -b lab/scenes/Compose.cpp 'CombinedConstraints constraint_of(const Model& m, const Cloth& g,' <<'END'
namespace {
class TubeConstraint : public NodewiseConstraint {
 public:
  explicit TubeConstraint(const Tube& t) : t_(t) {}
  void project(Cloth& g, double, unsigned first, unsigned last) const override {
    const auto off = [this](const Point& p) {
      return Point(p.x - t_.at.x, p.y - t_.at.y, 0);
    };
    for_each_violating(
        g, first, last,
        [&](const Point& p) { return norm(off(p)) > t_.radius; },
        [&](Node n) {
          const Point d = off(n.position());
          n.position() += (t_.radius / norm(d) - 1) * d;
          n.value().vel -= dot(n.value().vel, d) / normSq(d) * d;
        });
  }

 private:
  Tube t_;
};
}  // namespace

END
insert lab/scenes/Compose.cpp 'for (const Ball& b : m.tears) add(' <<'END'
  for (const Tube& t : m.tubes) add(TubeConstraint(t));
END
takes "part of a scene" 5

# ---- A control: half as stiff
insert -b lab/live/Requests.cpp '// Load the scene that scene_request() wrote.' <<'END'
  on("soften", plain, [](Live& live) {
    live.model_.stiffness /= 2;
    live.change_forces();
  });
END
insert -b lab/viewer/Panel.cpp 'double g = m.gravity;' <<'END'
  if (button("soften", 0)) ask("soften");
END
takes "control" 3

# ---- A chart
printf '# steps that the recipe made\nstep,height\n1,0.5\n2,0.25\n' >lab/charts/results/recipe.csv
cat >lab/charts/recipe.gp <<'END'
key = 0
key_is_method = 0
height = 470
load 'lab/charts/style.gp'
eval headline('A recipe halves its height', 'What the recipe made.')
set xlabel 'step [1]'
set ylabel 'height [m]'
plot csv using 1:2 with linespoints notitle
END
insert lab/charts/draw.py 'CHARTS = {' <<'END'
    "recipe": ("charts", "recipe.csv", "charts/recipe.gp"),
END
takes chart 3

# ---- Each does what it should
cat >tests/test_recipes.cpp <<'END'
#include <gtest/gtest.h>

#include <cmath>

#include "lab/charts/Problem.hpp"
#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Scene.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/scenes/StoredScenes.hpp"

using namespace lab;

TEST(Method, HasItsOrderAndItsLimit) {
  const MethodEntry* m = find_method("suzuki4");
  ASSERT_NE(m, nullptr);
  const Problem chain = chain_problem("chain", "", 0.8);
  const End exact = reference(chain).end;
  const auto error = [&](int steps) {
    return distance(chain, run(chain, *m->make(), steps).end, exact);
  };
  EXPECT_NEAR(std::log2(error(800) / error(1600)), m->info.order, 0.1);
  const Chain one{.n = 1, .modes = {{1, 0.01}}};
  const auto holds = [&](double share) {
    const double dt = share * m->info.limit / one.omega(1);
    return run(chain_problem("one", "", 5000 * dt, one), *m->make(), 5000).ok();
  };
  EXPECT_TRUE(holds(0.99));
  EXPECT_FALSE(holds(1.01));
}
TEST(Force, MovesTheCenterOfMass) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals);
  const Point a(0, 2, 0), before = center_of_mass(g);
  const auto force = make_combined_force(MassSpringForce(), PushForce(a));
  Verlet verlet;
  for (int k = 0; k < 100; ++k) verlet(g, k * 1e-3, 1e-3, force);
  EXPECT_NEAR(norm(center_of_mass(g) - before - 0.005 * a), 0, 1e-12);
}
TEST(Constraint, HoldsAndChangesNothingTheSecondTime) {
  Cloth g;
  build_cloth(g, grid_points(5), grid_quads(5), MeshSprings::diagonals);
  for (Node n : g.nodes()) n.position().z = 0.1 * n.position().x;
  CeilingConstraint ceiling(0.05);
  const Point first = g.node(0).position();
  ceiling(g, 0);
  const std::vector<Point> once(g.positions().begin(), g.positions().end());
  ceiling(g, 0);
  for (Node n : g.nodes()) EXPECT_LE(n.position().z, 0.05);
  for (Node n : g.nodes()) EXPECT_EQ(n.position(), once[n.id()]);
  EXPECT_EQ(g.node(0).position(), first);
}
TEST(StoredScene, Runs) {
  Model m = stored_scene("flag").model();
  EXPECT_TRUE(Scene(m).run_to(m.t_end));
}
TEST(Part, IsReadWrittenAndKept) {
  const std::string text =
      "sheet = 'nodes 9 9 velocity 3 0 0'\ntube = 'at 0.5 0.5 0 radius 0.8'\n"
      "t-end = 0.2\nmethod = 'verlet'\n";
  const Model m = read_model("tube.toml", "tube", text);
  EXPECT_EQ(to_scene_file(read_model("again", "tube", to_scene_file(m))),
            to_scene_file(m));
  EXPECT_TRUE(m.has_contact() && m.names_parts());
  Scene scene(m);
  ASSERT_TRUE(scene.run_to(m.t_end)) << scene.failure();
  double most = 0;
  for (Node n : scene.cloth().nodes()) {
    const Point p = n.position();
    most = std::max<double>(most, std::hypot(p.x - 0.5, p.y - 0.5));
  }
  EXPECT_NEAR(most, 0.8, 1e-12);  // thrown against it
}
TEST(Control, HalvesTheStiffness) {
  Live live(stored_scene("flag").model()), same(live.model());
  live.apply("soften");
  EXPECT_EQ(live.model().stiffness, same.model().stiffness / 2);
  for (int k = 0; k < 50; ++k) live.step(), same.step();
  EXPECT_LT(center_of_mass(live.scene().cloth()).z,
            center_of_mass(same.scene().cloth()).z);
  EXPECT_THROW(live.apply("soften 2"), std::invalid_argument);
}
END
# By the faster compiler; without window and OpenMP, as no other check does it.
built() {
  local make=(make --no-print-directory -j"${JOBS:-2}" UNITY=1 FAST=1 SPEED=-O0
    CXX=clang++ CXXFLAGS='-Werror -g0')
  "${make[@]}" VIEWER=0 OPENMP=0 build/test_recipes build/cloth mass_spring &&
    "${make[@]}" B=build/window build/window/lab/viewer/Panel.o
}
ok "all of it builds" built
for test in Method Force Constraint StoredScene Part Control; do
  ok "its test: $test" build/test_recipes --gtest_brief=1 --gtest_filter="$test.*"
done
lists() { [[ $(build/cloth --list-methods) == *suzuki4* && $(build/cloth --help) == *--tube* ]]; }
ok "./cloth lists the method and the part" lists
draws() { python3 lab/charts/draw.py recipe --to build && [ -s build/recipe.svg ]; }
ok "the chart is drawn" draws

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
