/** @file test_viewer.cpp
 * Tests of SDLViewer and SceneBuilder. They need no display; the last one makes
 * its own. Whole pictures: test_screen; keys in a window: tools/test_window.sh.
 */
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "CME212/Color.hpp"
#include "CME212/SFML_Viewer.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/Image.hpp"
#include "CME212/viewer/Layer.hpp"
#include "CME212/viewer/SDLWindow.hpp"  // SDL, to press its keys
#include "CME212/viewer/SceneBuilder.hpp"
#include "Graph.hpp"
#include "tests/ReadPng.hpp"
#include "tests/TestFolder.hpp"

namespace {

using namespace CME212;
using TestGraph = Graph<int, double>;
using Node = TestGraph::node_type;

/** A square net of n x n nodes in the unit square, with diagonals. */
void make_net(TestGraph& g, unsigned n) {
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j)
      g.add_node(Point(i / (n - 1.0), j / (n - 1.0), 0));
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j)
      for (auto [di, dj] : {std::array{1, 0}, {0, 1}, {1, 1}, {1, -1}})
        if (i + di < n && j + dj < n)
          g.add_edge(g.node(i * n + j), g.node((i + di) * n + j + dj));
}

/** Add all of @a g to a viewer or builder. */
template <typename V, typename Map>
void add_all(V& v, const TestGraph& g, Map& map) {
  v.add_nodes(g.node_begin(), g.node_end(), map);
  v.add_edges(g.edge_begin(), g.edge_end(), map);
}

/** Wait until @a done(). The limit is only there to end a test that hangs. */
bool eventually(const std::function<bool()>& done) {
  Clock clock;
  while (!done()) {
    if (clock.seconds() > 60) return false;
    CME212::sleep(0.001);
  }
  return true;
}

// -------------------------------------------------------------- SceneBuilder

/** A builder, and what a viewer would show of it. */
struct Shown : SceneBuilder {
  SceneData scene;
  bool edges_changed = false;
  /** Take over what is complete.  @return whether it is new */
  bool look() {
    bool is_new = false;
    take([&](const SceneData& s, bool e) {
      scene = s;
      edges_changed = e;
      is_new = true;
    });
    return is_new;
  }
};

TEST(SceneBuilder, NeverShowsHalfAScene) {
  TestGraph g;
  make_net(g, 3);
  Shown b;
  auto map = b.empty_node_map(g);
  add_all(b, g, map);
  EXPECT_TRUE(b.look() && b.edges_changed);
  EXPECT_EQ(b.scene.nodes.size(), 9u);
  EXPECT_EQ(b.scene.edges.size(), g.num_edges());

  b.clear();
  map.clear();
  EXPECT_FALSE(b.look());
  b.add_nodes(g.node_begin(), g.node_end(), map);
  EXPECT_FALSE(b.look());  // the program has edges: they will come
  b.add_nodes(g.node_begin(), g.node_end(), map);
  EXPECT_FALSE(b.look());
  b.add_edges(g.edge_begin(), g.edge_end(), map);
  EXPECT_TRUE(b.look());
  EXPECT_EQ(b.scene.nodes.size(), 9u);

  // Nodes that are known change at once, all together; the edges stay.
  auto up = [](Node n) { return n.position() + Point(0, 0, 1); };
  auto red = [](Node) { return Color(1, 0, 0); };
  b.add_nodes(g.node_begin(), g.node_end(), red, up, map);
  EXPECT_TRUE(b.look());
  EXPECT_FALSE(b.edges_changed);
  EXPECT_EQ(b.scene.nodes.size(), 9u);
  EXPECT_EQ(b.scene.edges.size(), g.num_edges());
  for (const auto& v : b.scene.nodes) {
    EXPECT_EQ(v.z, 1);
    EXPECT_EQ(v.rgba, (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
  }
}

TEST(SceneBuilder, ShowsNodesAtOnceInAProgramWithoutEdges) {
  TestGraph g;
  make_net(g, 2);
  Shown b;
  for (int frame = 0; frame < 2; ++frame) {
    b.clear();
    EXPECT_FALSE(b.look());
    auto map = b.empty_node_map(g);
    b.add_nodes(g.node_begin(), g.node_end(), map);
    EXPECT_TRUE(b.look());
    EXPECT_EQ(b.scene.nodes.size(), 4u);
  }
  // So does one that no longer draws them, from the second time on.
  b.draw_graph(g);
  EXPECT_TRUE(b.look());
  for (int frame = 0; frame < 3; ++frame) {
    b.clear();
    auto map = b.empty_node_map(g);
    b.add_nodes(g.node_begin(), g.node_end(), map);
    EXPECT_EQ(b.look(), frame > 0);
  }
  EXPECT_TRUE(b.scene.edges.empty());
}

TEST(SceneBuilder, LeavesOutEdgesWithoutEndsAndAddsNoneTwice) {
  TestGraph g;
  make_net(g, 3);
  Shown b;
  auto map = b.empty_node_map(g);
  auto half = g.node_begin() + 5;
  b.add_nodes(g.node_begin(), half, map);
  b.add_edges(g.edge_begin(), g.edge_end(), map);
  ASSERT_TRUE(b.look());
  std::size_t inside = 0;
  for (auto e : g.edges())
    inside += e.node1().index() < 5 && e.node2().index() < 5;
  EXPECT_EQ(b.scene.edges.size(), inside);
  // The rest comes later; of each edge there is one, whichever end is first.
  b.add_nodes(half, g.node_end(), map);
  for (auto n : g.nodes()) b.add_edges(n.edge_begin(), n.edge_end(), map);
  b.add_edges(g.edge_begin(), g.edge_end(), map);
  ASSERT_TRUE(b.look());
  EXPECT_EQ(b.scene.nodes.size(), 9u);
  EXPECT_EQ(b.scene.edges.size(), g.num_edges());
}

TEST(SceneBuilder, AMapThatWasNotClearedLeadsNowhereOutsideTheScene) {
  TestGraph g;
  make_net(g, 3);
  Shown b;
  auto map = b.empty_node_map(g);
  add_all(b, g, map);
  b.clear();
  b.add_edges(g.edge_begin(), g.edge_end(), map);
  ASSERT_TRUE(b.look());
  EXPECT_TRUE(b.scene.edges.empty());
  add_all(b, g, map);
  ASSERT_TRUE(b.look());
  for (auto ends : b.scene.edges) EXPECT_LT(ends[1], b.scene.nodes.size());
}

/** A graph of homework 0: no iterators, no values. */
struct PlainGraph {
  struct node_type {
    const PlainGraph* graph;
    std::size_t i;
    Point position() const { return graph->places[i]; }
    bool operator==(const node_type& n) const { return i == n.i; }
    bool operator<(const node_type& n) const { return i < n.i; }
  };
  struct edge_type {
    node_type a, b;
    node_type node1() const { return a; }
    node_type node2() const { return b; }
  };
  std::vector<Point> places;
  std::vector<std::array<std::size_t, 2>> ends;

  std::size_t num_nodes() const { return places.size(); }
  std::size_t num_edges() const { return ends.size(); }
  node_type node(std::size_t i) const { return {this, i}; }
  edge_type edge(std::size_t i) const {
    return {node(ends[i][0]), node(ends[i][1])};
  }
};

TEST(SceneBuilder, DrawsAWholeGraphInPlaceOfTheSceneBefore) {
  PlainGraph g{{Point(1), Point(2), Point(3)}, {{0, 1}, {2, 0}}};
  TestGraph net;
  make_net(net, 3);
  Shown b;
  b.draw_graph(net);
  ASSERT_TRUE(b.look());
  EXPECT_EQ(b.scene.nodes.size(), 9u);
  EXPECT_EQ(b.scene.edges.size(), net.num_edges());
  b.draw_graph(g);
  ASSERT_TRUE(b.look());
  ASSERT_EQ(b.scene.nodes.size(), 3u);
  EXPECT_EQ(b.scene.nodes[2].x, 3);
  EXPECT_EQ(b.scene.nodes[2].rgba,
            (std::array<std::uint8_t, 4>{255, 255, 255, 255}));
  EXPECT_EQ(b.scene.edges, (std::vector<SceneData::Ends>{{0, 1}, {0, 2}}));
  b.draw_graph_nodes(net);
  ASSERT_TRUE(b.look());
  EXPECT_EQ(b.scene.nodes.size(), 9u);
  EXPECT_TRUE(b.scene.edges.empty());
  b.draw_graph(PlainGraph());
  ASSERT_TRUE(b.look());
  EXPECT_TRUE(b.scene.nodes.empty());
}

// ------------------------------------------------------------------- Letters

TEST(Letters, AreAllDifferentAndInTheirPlace) {
  std::set<std::string_view> seen;
  for (char c = ' '; c <= '~'; ++c) {
    EXPECT_TRUE(seen.insert(letters::strokes_of(c)).second) << c;
    EXPECT_EQ(letters::pieces(c).empty(), c == ' ');
    for (const auto& p : letters::pieces(c))
      for (const auto& [x, y] : {std::pair(p.x0, p.y0), {p.x1, p.y1}}) {
        EXPECT_TRUE(letters::bearing <= x &&
                    x <= letters::advance(c) - letters::bearing)
            << c << x;
        EXPECT_TRUE(-3 <= y && y <= 11) << c << y;
      }
  }
  // A number that counts does not move what stands behind it.
  for (char c = '0'; c <= '9'; ++c)
    EXPECT_EQ(letters::advance(c), letters::advance('0')) << c;
  EXPECT_EQ(letters::strokes_of('\xe9'), letters::strokes_of('?'));
}

// ----------------------------------------------------------------- SDLViewer

SDLViewer::Options small() {
  return {400, 300, "test_viewer", true, true, true};
}

/** Number of pixels in which two pictures differ, in columns [x0, x1) and
 * rows [y0, y1) as fractions of the picture. */
int difference(const Image& a, const Image& b, double x0 = 0, double x1 = 1,
               double y0 = 0, double y1 = 1) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  int n = 0;
  for (int y = int(y0 * a.height); y < int(y1 * a.height); ++y)
    for (int x = int(x0 * a.width); x < int(x1 * a.width); ++x)
      n += !std::equal(a.pixel(x, y), a.pixel(x, y) + 3, b.pixel(x, y));
  return n;
}

TEST(SDLViewer, WritesLabelAndScale) {
  SDLViewer viewer(small());
  Image plain = viewer.snapshot();
  viewer.set_label("t = 3");
  Image labeled = viewer.snapshot();
  EXPECT_GT(difference(plain, labeled, 0, 0.5, 0, 0.2), 30);
  EXPECT_EQ(difference(plain, labeled, 0, 1, 0.2, 1), 0);
  viewer.set_scale({.limit = 0.5});
  EXPECT_EQ(viewer.snapshot(), labeled);  // not yet
  viewer.set_strain_colors(true);
  Image scaled = viewer.snapshot();
  EXPECT_GT(difference(scaled, labeled, 0.9, 1, 0, 0.6), 500);
  EXPECT_EQ(difference(scaled, labeled, 0, 0.6), 0);
  // Red above, blue below.
  int x = 400 - 16;
  const auto *high = scaled.pixel(x, 36), *low = scaled.pixel(x, 150);
  EXPECT_GT(high[0], high[2] + 100);
  EXPECT_GT(low[2], low[0] + 100);
  // An end says that there is more beyond it.
  viewer.set_scale({.limit = 0.5, .below = true});
  Image below = viewer.snapshot();
  EXPECT_GT(difference(below, scaled, 0.5, 1, 0.4, 0.6), 10);
  EXPECT_EQ(difference(below, scaled, 0, 1, 0, 0.4), 0);
}

TEST(SDLViewer, WritesAMessageAtTheBottom) {
  SDLViewer viewer(small());
  Image plain = viewer.snapshot();
  viewer.set_message({"diverged"});
  Image one = viewer.snapshot();
  EXPECT_GT(difference(plain, one, 0, 1, 0.8), 5000);
  EXPECT_EQ(difference(plain, one, 0, 1, 0, 0.8), 0);
  // Its bar has the color of marks.
  const auto* bar = one.pixel(14, 280);
  const Color mark = Color::make_mark();
  EXPECT_NEAR(bar[0], 255 * mark.r, 1);
  EXPECT_NEAR(bar[1], 255 * mark.g, 1);
  EXPECT_NEAR(bar[2], 255 * mark.b, 1);
  // A long paragraph is broken into lines; nothing leaves the box.
  std::string words;
  for (int k = 0; k < 40; ++k) words += "word ";
  viewer.set_message({words, "--dt auto works"});
  Image more = viewer.snapshot();
  EXPECT_GT(difference(plain, more, 0, 1, 0.5, 0.8), 5000);
  EXPECT_EQ(difference(plain, more, 0.98, 1), 0);
  viewer.set_message({});
  EXPECT_EQ(viewer.snapshot(), plain);
}

TEST(SDLViewer, MarksAreSeenThroughAllElse) {
  SDLViewer viewer(small());
  BoundingBox box = (BoundingBox() |= Point(-1)) |= Point(1);
  viewer.set_view(Point(0, -1, 0), box);
  viewer.add_sphere(Point(0, 0, 0), 0.7);
  Image ball = viewer.snapshot();
  auto magenta = [](const Image& p, int x, int y) {
    const auto* c = p.pixel(x, y);
    return c[0] > 240 && c[1] < 80 && c[2] > 150;
  };
  viewer.set_marks({{Point(-0.5, 0, 0), Point(0.5, 0, 0)}});
  Image line = viewer.snapshot();
  EXPECT_TRUE(magenta(line, 200, 150));  // behind the front of the ball
  EXPECT_GT(difference(ball, line), 200);
  EXPECT_EQ(difference(ball, line, 0, 1, 0, 0.45), 0);
  viewer.set_marks({{Point(), Point()}});
  Image ring = viewer.snapshot();
  EXPECT_FALSE(magenta(ring, 200, 150));  // what it is around stays visible
  EXPECT_TRUE(magenta(ring, 200, 150 + int(0.75 * 17)));
  // Behind the eye, or not a number: not drawn.
  for (Point p : {Point(0, -100, 0), Point(std::nan(""), 0, 0)}) {
    viewer.set_marks({{Point(), p}});
    EXPECT_EQ(viewer.snapshot(), ball);
  }
  viewer.set_marks({});
  EXPECT_EQ(viewer.snapshot(), ball);
}

TEST(SDLViewer, ShapesAndViews) {
  SDLViewer viewer(small());
  BoundingBox box = (BoundingBox() |= Point(-1)) |= Point(1);
  viewer.set_view(Point(0, -1, 0.2), box);
  Image empty = viewer.snapshot();
  viewer.add_sphere(Point(0, 0, 0), 0.5);
  Image ball = viewer.snapshot();
  EXPECT_GT(difference(empty, ball), 2000);
  viewer.add_plane(-0.5, 2, Point());
  EXPECT_GT(difference(viewer.snapshot(), ball), 2000);
  viewer.clear();  // keeps them
  EXPECT_GT(difference(empty, viewer.snapshot()), 2000);
  viewer.clear_shapes();
  EXPECT_EQ(viewer.snapshot(), empty);
  // A point that is no number does no harm.
  TestGraph g;
  g.add_node(Point(std::nan(""), 0, 0));
  g.add_node(Point(1e300, 0, 0));
  g.add_edge(g.node(0), g.node(1));
  auto map = viewer.empty_node_map(g);
  add_all(viewer, g, map);
  viewer.center_view();
  viewer.snapshot();
}

// Programs of students catch nothing.
TEST(SDLViewer, WithoutADisplayAProgramEndsWithStatus4) {
  Environment no_driver("SDL_VIDEODRIVER", nullptr);
  Environment no_wayland("WAYLAND_DISPLAY", nullptr);
  for (const char* display : {static_cast<const char*>(nullptr), ":987654"}) {
    Environment dead("DISPLAY", display);
    EXPECT_FALSE(SDLViewer::has_display());
    EXPECT_TRUE(
        begins(error_of<NoDisplay>([] { SDLViewer v; }), "no display: "));
  }
  Environment no_x("DISPLAY", nullptr);
  const auto program = []() noexcept { SDLViewer viewer; };
  EXPECT_EXIT(program(), testing::ExitedWithCode(4),
              "^no display: neither DISPLAY nor WAYLAND_DISPLAY is set\n$");
  // Any other error ends it as before.
  const auto fail = [] { throw std::runtime_error("other"); };
  const auto other = [&fail]() noexcept {
    SDLViewer viewer(small());
    fail();
  };
  EXPECT_EXIT(other(), testing::KilledBySignal(SIGABRT), "other");
}

TEST(SDLViewer, WithoutADisplayItDrawsAPicture) {
  Environment no_driver("SDL_VIDEODRIVER", nullptr);
  Environment no_wayland("WAYLAND_DISPLAY", nullptr);
  Environment no_x("DISPLAY", nullptr);
  const TestFolder folder;
  TestGraph g;
  make_net(g, 4);
  SDLViewer viewer(
      {.width = 400, .height = 300, .picture = folder / "a/b.png"});
  EXPECT_FALSE(viewer.in_window());
  viewer.event_loop();  // returns at once
  EXPECT_TRUE(viewer.wait_while_paused());
  viewer.draw_graph(g);
  testing::internal::CaptureStdout();
  viewer.write_picture();
  EXPECT_EQ(
      testing::internal::GetCapturedStdout(),
      "no display; a picture of the last state: " + folder / "a/b.png" + "\n");
  EXPECT_EQ(read_png(folder / "a/b.png"), viewer.snapshot());
}

void press(SDL_Keycode key, bool repeat = false) {
  SDL_Event e{};
  e.type = SDL_KEYDOWN;
  e.key.keysym.sym = key;
  e.key.repeat = repeat;
  SDL_PushEvent(&e);
}

/** A simulation that counts its steps, and what a user can tell it. */
struct Simulation {
  SDLViewer& viewer;
  TestGraph graph;
  std::atomic<int> steps = 0, shows = 0, restarts = 0;

  explicit Simulation(SDLViewer& v) : viewer(v) { make_net(graph, 8); }

  void show(bool anew) {
    static std::map<Node, unsigned> map;
    auto color = [&](Node n) {
      return viewer.strain_colors() ? Color::make_strain(float(n.position().x))
                                    : Color(1);
    };
    if (anew) {
      viewer.clear();
      map.clear();
    }
    viewer.add_nodes(graph.node_begin(), graph.node_end(), color, map);
    if (anew) viewer.add_edges(graph.edge_begin(), graph.edge_end(), map);
    viewer.set_label(steps.load());
    viewer.set_message({"stopped", "for a moment"});
    viewer.set_marks({{Point(), Point(double(steps % 2), 0, 0)}});
  }
  void run() {
    show(true);
    while (!viewer.closed()) {
      auto paused = [&] {
        show(steps % 2);
        ++shows;
      };
      if (!viewer.wait_while_paused(paused)) {
        restarts += viewer.take_restart();
        continue;
      }
      for (auto n : graph.nodes()) n.position().z -= 1e-6;
      ++steps;
      if (viewer.wants_frame()) show(steps % 3 == 0);
    }
  }
};

/** Press keys as a user does, and check their effects. */
void use(Simulation& s) {
  ASSERT_TRUE(eventually([&] { return s.steps > 3; }));
  press(SDLK_SPACE);
  ASSERT_TRUE(eventually([&] { return s.shows == 1; }));
  const int steps = s.steps;
  press(SDLK_n);
  ASSERT_TRUE(eventually([&] { return s.shows == 2; }));
  EXPECT_EQ(s.steps, steps + 1);
  press(SDLK_s);
  ASSERT_TRUE(eventually([&] { return s.shows == 3; }));
  EXPECT_TRUE(s.viewer.strain_colors());
  EXPECT_EQ(s.steps, steps + 1);
  press(SDLK_r);
  ASSERT_TRUE(eventually([&] { return s.restarts == 1 && s.shows == 4; }));
  EXPECT_EQ(s.steps, steps + 1);
  press(SDLK_SPACE);
  ASSERT_TRUE(eventually([&] { return s.steps > steps + 3; }));
  EXPECT_EQ(s.restarts, 1);
  EXPECT_FALSE(s.viewer.closed());
}

/** Run the viewer on this thread, a simulation and a user on two others. */
void run_with_user(SDLViewer& viewer, SDL_Keycode quit) {
  Simulation s(viewer);
  std::thread simulation([&] { s.run(); });
  std::thread user([&] {
    use(s);
    press(quit);
    if (!eventually([&] { return viewer.closed(); })) {
      ADD_FAILURE() << "does not close";
      viewer.close();
    }
  });
  viewer.event_loop();
  simulation.join();
  user.join();
  EXPECT_TRUE(viewer.closed());
  EXPECT_FALSE(viewer.wait_while_paused());  // nothing waits any more
}

TEST(SDLViewerThreads, KeysReachTheSimulation) {
  for (SDL_Keycode quit : {SDLK_q, SDLK_ESCAPE}) {
    SDLViewer viewer(small());
    run_with_user(viewer, quit);
  }
}

TEST(SDLViewerThreads, ClosesWhilePausedOrBeforeItOpens) {
  SDLViewer viewer(small());
  press(SDLK_SPACE);
  press(SDLK_SPACE, true);  // held down: counts once
  std::atomic<bool> waits = false;
  std::thread simulation([&] {
    while (viewer.wait_while_paused([&] { waits = true; })) {
    }
  });
  std::thread user([&] {
    EXPECT_TRUE(eventually([&] { return waits.load(); }));
    SDL_Event e{};
    e.type = SDL_QUIT;
    SDL_PushEvent(&e);
  });
  viewer.event_loop();
  simulation.join();
  user.join();

  SDLViewer closed(small());
  EXPECT_TRUE(closed.wait_while_paused());  // it is not
  closed.set_paused(true);
  closed.close();
  closed.event_loop();
  EXPECT_TRUE(closed.closed());
  EXPECT_FALSE(closed.wait_while_paused());
}

TEST(SDLViewerThreads, LaunchLeavesTheMainThreadToTheSimulation) {
  std::atomic<bool> closed = false;
  std::thread user;
  {
    SFML_Viewer viewer(small());
    viewer.snapshot();  // the window is used before, and made anew
    Simulation s(viewer);
    viewer.launch();
    user = std::thread([&] {
      use(s);
      viewer.close();
    });
    s.run();  // until it is closed
    EXPECT_TRUE(eventually([&] { return viewer.closed(); }));
    user.join();
  }
  {
    SFML_Viewer viewer(small());
    TestGraph g;
    make_net(g, 3);
    viewer.draw_graph(g);
    viewer.launch();
    EXPECT_TRUE(eventually([&] { return viewer.wants_frame(); }));
    user = std::thread([&] {
      CME212::sleep(0.1);
      closed = true;
      press(SDLK_q);
    });
  }  // waits for the user
  EXPECT_TRUE(closed);
  user.join();
}

// As the course's programs, which know of no restart and of no coloring.
TEST(SDLViewerThreads, KeysThatTheProgramDoesNotServeDoNothing) {
  SDLViewer viewer({400, 300, "test_viewer", true});
  press(SDLK_r);
  press(SDLK_s);
  press(SDLK_q);
  viewer.event_loop();
  EXPECT_FALSE(viewer.take_restart());
  EXPECT_FALSE(viewer.strain_colors());
}

/** The picture before and after the user did @a event, and quit. */
std::array<Image, 2> around(const SDL_Event& event) {
  TestGraph g;
  make_net(g, 3);
  SDLViewer viewer(small());
  auto map = viewer.empty_node_map(g);
  add_all(viewer, g, map);
  Image before = viewer.snapshot();
  SDL_Event copy = event;
  SDL_PushEvent(&copy);
  press(SDLK_q);
  viewer.event_loop();
  return {before, viewer.snapshot()};
}

TEST(SDLViewer, MouseAndCenterMoveTheCamera) {
  std::vector<SDL_Event> events(4, SDL_Event{});
  for (int i : {0, 1}) {
    events[i].type = SDL_MOUSEMOTION;
    events[i].motion.state = i ? SDL_BUTTON_RMASK : SDL_BUTTON_LMASK;
    events[i].motion.xrel = 40;
  }
  events[2].type = SDL_MOUSEWHEEL;
  events[2].wheel.preciseY = 2;
  events[3].type = SDL_KEYDOWN;
  events[3].key.keysym.sym = SDLK_c;
  for (const SDL_Event& e : events) {
    auto [before, after] = around(e);
    EXPECT_GT(difference(before, after), 500) << e.type;
  }
  SDL_Event nothing{};
  nothing.type = SDL_MOUSEMOTION;  // no button held
  nothing.motion.xrel = 40;
  auto [before, after] = around(nothing);
  EXPECT_EQ(before, after);
}

TEST(SDLViewer, KeysShowFacesWiresAndNodes) {
  TestGraph g;
  make_net(g, 9);
  auto after = [&](SDL_Keycode key, const Look& look = {}) {
    SDLViewer viewer(small());
    viewer.set_look(look);
    viewer.add_faces(g, grid_quads(9));
    viewer.draw_graph(g);
    press(key);
    press(SDLK_q);
    viewer.event_loop();
    return viewer.snapshot();
  };
  const Image before = after(SDLK_2);  // a key that does nothing
  const std::pair<SDL_Keycode, Look> looks[] = {{SDLK_f, {.faces = false}},
                                                {SDLK_w, {.wires = false}},
                                                {SDLK_d, {.nodes = true}}};
  for (const auto& [key, look] : looks) {
    const Image image = after(key);
    EXPECT_EQ(image, after(SDLK_2, look)) << char(key);
    EXPECT_GT(difference(image, before), 500) << char(key);
  }
}

// ------------------------------------------------------------- A real window

/** An X server of our own that shows nothing, as long as this lives. */
class XServer {
 public:
  explicit XServer(const std::string& size = "1280x1024")
      : server_("exec Xvfb -displayfd 1 -noreset -screen 0 " + size + "x24 >" +
                folder_ / "number" + " 2>/dev/null") {
    // It takes a free number and writes it when it is ready.
    server_.until([this] {
      display_ = ":" + contents(folder_ / "number");
      return display_.ends_with('\n');
    });
    display_.pop_back();
  }
  ~XServer() {
    server_.signal(SIGTERM);
    server_.wait();
  }
  /** As for DISPLAY. */
  const std::string& display() const { return display_; }

 private:
  std::string display_;
  const CME212::TestFolder folder_;
  CME212::Child server_;
};

TEST(SDLViewerWindow, FitsOnASmallScreen) {
  if (!has_program("Xvfb")) GTEST_SKIP() << "no Xvfb";
  XServer server("800x600");
  Environment display("DISPLAY", server.display().c_str());
  const CME212::SDLWindow window("small", 1024, 768, false);
  EXPECT_EQ(window.size(), (std::array{800, 600}));
}

}  // namespace
