/** @file test_panels.cpp
 * Tests of what a user does in a window with panels:
 * CME212/viewer/MouseTool.hpp, SDLViewer::set_panels() and set_touch();
 * lab/viewer/Plot.hpp, and each control of lab/viewer/Panel.hpp, moved by the
 * mouse. They need no display. */
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "CME212/SDLViewer.hpp"
#include "CME212/Util.hpp"
#include "CME212/viewer/GLOverlay.hpp"  // Dear ImGui, to draw a panel
#include "CME212/viewer/Image.hpp"
#include "CME212/viewer/MouseTool.hpp"
#include "CME212/viewer/SDLWindow.hpp"  // SDL, to push its events
#include "Graph.hpp"
#include "lab/live/Live.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/viewer/Plot.hpp"
#include "lab/viewer/Screen.hpp"

namespace {

using namespace CME212;
using Kind = Touch::Kind;

// ----------------------------------------------------------------- MouseTool

BoundingBox unit_box() {
  return (BoundingBox() |= Point(-1, -1, -1)) |= Point(1, 1, 1);
}
/** Of what a viewer of this size shows that looks along y at the unit box. */
Picture front_picture(double width, double height, double hidden = 0) {
  Picture p{{}, width, height};
  p.camera.set_hidden_left(hidden / width);
  p.camera.look_from(Point(0, -1, 0));
  p.camera.fit(unit_box(), p.aspect());
  return p;
}
SceneData points(const std::vector<Point>& at) {
  SceneData s;
  for (const Point& p : at) s.nodes.emplace_back(p, Color(1));
  return s;
}

TEST(MouseTool, PlacesAndPointsAreInverse) {
  for (double hidden : {0.0, 250.0})
    for (double width : {640.0, 300.0}) {
      const Picture p = front_picture(width, 480, hidden / 2);
      for (Point at : {Point(0.3, 0.2, -0.6), Point(-1, 0.9, 1)}) {
        const Point q = p.place_of(at);
        EXPECT_LT(norm(p.point_at(q.x, q.y, q.z) - at), 1e-12);
        // All of the box is right of what hides the left.
        EXPECT_GT(q.x, hidden / 2);
        EXPECT_LT(q.x, width);
      }
      EXPECT_NEAR(p.place_of(p.camera.center()).x, (width + hidden / 2) / 2,
                  1e-9);
      // A length across the line of sight is as long as it is drawn.
      const Point a = p.place_of(Point(0, 0, 0)),
                  b = p.place_of(Point(0.1, 0, 0));
      EXPECT_NEAR(b.x - a.x, p.pixels(0.1, a.z), 1e-9);
    }
}

TEST(MouseTool, MeansTheNearestNodeThatIsSeen) {
  const Picture p = front_picture(600, 600);
  MouseTool hand;
  SceneData s = points({{0, 0, 0}, {0.5, 0, 0}, {0, 0.8, 0.01}, {0, 30, -6}});
  hand.look(s, true);
  auto at = [&](const Point& where, double dx = 0) {
    const Point q = p.place_of(where);
    return hand.node_at(p, q.x + dx, q.y, 12);
  };
  EXPECT_EQ(at({0.5, 0, 0}), 1u);
  EXPECT_EQ(at({0.5, 0, 0}, 11), 1u);
  EXPECT_FALSE(at({0.5, 0, 0}, 13));
  // With edges it is meant from 0.6 of one on; what lies in front wins.
  s.edges = {{0, 1}, {0, 2}};
  hand.look(s, true);
  EXPECT_EQ(at({0.26, 0, 0}), 1u);
  EXPECT_EQ(at({0.01, 0, 0}), 0u);
  EXPECT_EQ(at({0, 30, -6}), 3u);  // far away, but nothing else is there
  s.spheres.push_back({Point(0, -0.5, 0), 0.2});
  hand.look(s, false);
  EXPECT_FALSE(at({0, 0, 0}));
  EXPECT_EQ(at({0.5, 0, 0}), 1u);
  // Behind the eye, or no number: not meant.
  hand.look(points({{0, -1000, 0}, {std::nan(""), 0, 0}}), false);
  EXPECT_FALSE(at({0, 0, 0}));
}

TEST(MouseTool, TakesANodeAlongInThePlaneOfThePicture) {
  const Picture p = front_picture(600, 600);
  MouseTool hand;
  hand.look(points({{0.25, 0.5, 0}}), true);
  const Point q = p.place_of(Point(0.25, 0.5, 0));
  EXPECT_FALSE(hand.grab(p, q.x + 50, q.y, 12));
  const auto grab = hand.grab(p, q.x, q.y, 12);
  ASSERT_TRUE(grab && hand.holds());
  EXPECT_EQ(grab->kind, Kind::grab);
  EXPECT_LT(norm(grab->at - Point(0.25, 0.5, 0)), 1e-6);
  const Point to = p.place_of(Point(-0.5, 0.5, 0.75));  // y is the depth
  const Touch move = hand.move(p, to.x, to.y);
  EXPECT_EQ(move.kind, Kind::move);
  EXPECT_LT(norm(move.at - Point(-0.5, 0.5, 0.75)), 1e-6);
  EXPECT_EQ(hand.release().kind, Kind::release);
  EXPECT_FALSE(hand.holds());
  // A node that is gone can't be held.
  hand.grab(p, q.x, q.y, 12);
  hand.look(SceneData(), true);
  EXPECT_FALSE(hand.holds());
}

TEST(MouseTool, CutsThroughAllThatItsStrokeCovers) {
  const Picture p = front_picture(600, 600);
  MouseTool hand;
  hand.start_cut(300, 100);
  const Touch t = hand.cut(p, 300, 500);  // downwards
  EXPECT_EQ(t.kind, Kind::cut);
  EXPECT_EQ(hand.stroke().size(), 2u);
  EXPECT_LT(norm(t.at - p.camera.eye()), 1e-12);
  // The triangle lies in the plane x = 0, and reaches behind the scene.
  for (const Point& q : {t.from, t.to}) {
    EXPECT_NEAR(q.x, 0, 1e-9);
    EXPECT_GT(q.y, 10);
  }
  EXPECT_GT(t.from.z, 0);
  EXPECT_LT(t.to.z, 0);
  hand.end_cut();
  EXPECT_FALSE(hand.cuts());
}

// -------------------------------------------------------------- In a window

/** Pushes into SDL's queue what a user does. */
struct Mouse {
  static void button(int x, int y, bool down, Uint8 which = SDL_BUTTON_LEFT) {
    SDL_Event e{};
    e.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
    e.button.x = x, e.button.y = y;
    e.button.button = which;
    SDL_PushEvent(&e);
  }
  static void move(int x, int y, bool pressed = false) {
    SDL_Event e{};
    e.type = SDL_MOUSEMOTION;
    e.motion.x = x, e.motion.y = y;
    e.motion.xrel = 10;
    e.motion.state = pressed ? SDL_BUTTON_LMASK : 0;
    SDL_PushEvent(&e);
  }
  static void click(int x, int y) {
    move(x, y), button(x, y, true), button(x, y, false);
  }
  static void drag(int x, int y, int to_x, int to_y) {
    move(x, y), button(x, y, true);
    move(to_x, to_y, true), button(to_x, to_y, false);
  }
  static void key(SDL_Keycode sym, bool down = true) {
    SDL_Event e{};
    e.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    e.key.keysym.sym = sym;
    e.key.keysym.scancode = SDL_GetScancodeFromKey(sym);
    if (down && sym == SDLK_LCTRL) e.key.keysym.mod = KMOD_LCTRL;
    SDL_PushEvent(&e);
  }
  /** Ask for a frame. */
  static void expose() {
    SDL_Event e{};
    e.type = SDL_WINDOWEVENT;
    e.window.event = SDL_WINDOWEVENT_EXPOSED;
    SDL_PushEvent(&e);
  }
  static void type(char c) {
    SDL_Event e{};
    e.type = SDL_TEXTINPUT;
    e.text.text[0] = c;
    SDL_PushEvent(&e);
  }
};

bool soon(const std::function<bool()>& done) {
  for (Clock clock; !done(); CME212::sleep(0.002))
    if (clock.seconds() > 60) return false;
  return true;
}

constexpr int panel_width = 100;

/** A viewer of 400 x 300 with a panel of 100 x 300, four nodes, and all that a
 * program is told. */
struct PanelProgram {
  SDLViewer viewer{{400, 300, "test_panels", true}};
  std::atomic<int> frames = 0, clicks = 0, value = 0;
  std::atomic<float> font = 0;
  std::mutex mutex;
  std::vector<Touch> touches;

  PanelProgram() {
    Graph<int, int> g;
    for (Point p : {Point(-0.5, 0, -0.5), Point(0.5, 0, -0.5),
                    Point(-0.5, 0, 0.5), Point(0.5, 0, 0.5)})
      g.add_node(p);
    viewer.draw_graph(g);
    viewer.set_view(Point(0, -1, 0), unit_box());
    viewer.set_panels([this] { return panel(); });
    viewer.set_touch([this](const Touch& t) {
      std::lock_guard lock(mutex);
      touches.push_back(t);
    });
  }
  double panel() {
    ++frames;
    font = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({panel_width, 300});
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::SetCursorScreenPos({10, 10});
    if (ImGui::Button("click", {80, 30})) ++clicks;
    ImGui::SetCursorScreenPos({10, 60});
    int v = value;
    ImGui::SetNextItemWidth(80);
    if (ImGui::SliderInt("##value", &v, 0, 99)) value = v;
    ImGui::End();
    return panel_width;
  }
  std::vector<Touch> told() {
    std::lock_guard lock(mutex);
    return touches;
  }
  /** Where a node is drawn. */
  static Point place_of(unsigned node) {
    return front_picture(400, 300, panel_width)
        .place_of(Point(node % 2 ? 0.5 : -0.5, 0, node / 2 ? 0.5 : -0.5));
  }
  /** Serve the window here while @a user acts in another thread. */
  void serve(const std::function<void()>& user) {
    std::thread thread([&] {
      EXPECT_TRUE(soon([&] { return frames > 0; }));
      user();
      viewer.close();
    });
    viewer.event_loop();
    thread.join();
  }
};

TEST(PanelsThreads, TakeTheMouseFirst) {
  PanelProgram p;
  const Image before = p.viewer.snapshot();
  p.serve([&] {
    Mouse::click(50, 25);
    EXPECT_TRUE(soon([&] { return p.clicks == 1; }));
    for (int k = 0; k < 3; ++k) Mouse::click(50, 25);  // all at once
    EXPECT_TRUE(soon([&] { return p.clicks == 4; }));
    Mouse::drag(15, 68, 300, 68);  // and out of the panel
    EXPECT_TRUE(soon([&] { return p.value == 99; }));
  });
  EXPECT_TRUE(p.told().empty());
  EXPECT_EQ(p.viewer.snapshot(), before);  // nothing turned; no panel
}

TEST(PanelsThreads, TouchesReachTheProgram) {
  PanelProgram p;
  const Image before = p.viewer.snapshot();
  const Point q = PanelProgram::place_of(3);
  const int x = int(q.x), y = int(q.y);
  p.serve([&] {
    Mouse::drag(x, y, x + 40, y);
    EXPECT_TRUE(soon([&] { return p.told().size() == 3; }));
    Mouse::move(x, y);
    Mouse::key(SDLK_p);
    EXPECT_TRUE(soon([&] { return p.told().size() == 4; }));
    Mouse::key(SDLK_LCTRL);
    Mouse::drag(x - 40, y, x + 40, y);
    Mouse::key(SDLK_LCTRL, false);
    EXPECT_TRUE(soon([&] { return p.told().size() == 5; }));
  });
  const auto told = p.told();
  ASSERT_EQ(told.size(), 5u);
  const Kind kinds[] = {Kind::grab, Kind::move, Kind::release, Kind::pin,
                        Kind::cut};
  for (int k = 0; k < 5; ++k) EXPECT_EQ(told[k].kind, kinds[k]) << k;
  EXPECT_EQ(told[0].node, 3u);
  EXPECT_EQ(told[3].node, 3u);
  EXPECT_NEAR(told[1].at.x - told[0].at.x,
              40 / front_picture(400, 300, panel_width).pixels(1, q.z), 1e-6);
  EXPECT_EQ(p.viewer.snapshot(), before);  // nothing turned
}

TEST(PanelsThreads, EmptySpaceTurnsTheView) {
  PanelProgram p;
  const Image before = p.viewer.snapshot();
  p.serve([&] {
    const int frames = p.frames;
    Mouse::drag(250, 150, 290, 150);
    EXPECT_TRUE(soon([&] { return p.frames > frames + 3; }));
  });
  EXPECT_TRUE(p.told().empty());
  EXPECT_NE(p.viewer.snapshot(), before);
}

TEST(PanelsThreads, KeysSizeAndHideThemButNotWhileTyping) {
  PanelProgram p;
  p.serve([&] {
    const float size = p.font;
    Mouse::type('+');
    EXPECT_TRUE(soon([&] { return p.font > size; }));
    Mouse::type('-');
    EXPECT_TRUE(soon([&] { return p.font == size; }));
    // Ctrl-click: the number is typed.
    Mouse::key(SDLK_LCTRL);
    Mouse::click(50, 68);
    Mouse::key(SDLK_LCTRL, false);
    int frames = p.frames;
    EXPECT_TRUE(soon([&] { return p.frames > frames + 4; }));
    Mouse::key(SDLK_q);
    Mouse::type('4'), Mouse::type('2');
    Mouse::key(SDLK_RETURN), Mouse::key(SDLK_RETURN, false);
    EXPECT_TRUE(soon([&] { return p.value == 42; }));
    EXPECT_FALSE(p.viewer.closed());
    frames = p.frames;
    Mouse::click(300, 150);
    EXPECT_TRUE(soon([&] { return p.frames > frames + 3; }));
    const Look look = p.viewer.look();
    Mouse::key(SDLK_TAB), Mouse::key(SDLK_d);
    EXPECT_TRUE(soon([&] { return p.viewer.look() != look; }));
    frames = p.frames;             // hidden before the look changed
    for (int k = 0; k < 2; ++k) {  // at the second frame the first is drawn
      p.viewer.draw_graph(Graph<int, int>());
      EXPECT_TRUE(soon([&] { return p.viewer.wants_frame(); }));
    }
    EXPECT_EQ(p.frames, frames);
    Mouse::key(SDLK_TAB);
    EXPECT_TRUE(soon([&] { return p.frames > frames; }));
  });
}

TEST(PanelsThreads, AProgramWakesAPausedSimulation) {
  PanelProgram p;
  p.viewer.set_paused(true);
  p.viewer.wake();
  EXPECT_FALSE(p.viewer.wait_while_paused());
  std::atomic<int> woken = 0, steps = 0;
  std::thread simulation([&] {
    while (!p.viewer.closed()) ++(p.viewer.wait_while_paused() ? steps : woken);
  });
  p.serve([&] {
    p.viewer.wake();
    EXPECT_TRUE(soon([&] { return woken == 1; }));
    EXPECT_EQ(steps, 0);
    p.viewer.step_once();
    EXPECT_TRUE(soon([&] { return steps == 1; }));
    EXPECT_TRUE(p.viewer.paused());
  });
  simulation.join();
}

// --------------------------------------------------------------------- Plots

TEST(Plot, TicksAreRoundAndFewEnough) {
  using lab::axis_ticks, lab::tick_text;
  EXPECT_EQ(axis_ticks(0, 1, 5, false),
            (std::vector<double>{0, 0.2, 0.2 * 2, 0.2 * 3, 0.8, 1}));
  for (double low : {-3.3, 0.0, 997.0})
    for (double span : {1e-5, 0.7, 1.0, 33.0, 1e9})
      for (int most : {2, 5, 9}) {
        const auto ticks = axis_ticks(low, low + span, most, false);
        EXPECT_LE(ticks.size(), most + 1u);
        EXPECT_GE(ticks.size(), most / 3 + 0u);
        for (double t : ticks) EXPECT_TRUE(low <= t && t <= low + span);
      }
  EXPECT_EQ(axis_ticks(0.05, 20, 4, true), (std::vector<double>{0.1, 1, 10}));
  EXPECT_LE(axis_ticks(1e-16, 1, 4, true).size(), 5u);
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(4, 2), "4");
  EXPECT_EQ(tick_text(-0.0, 5), "0");
  EXPECT_EQ(tick_text(0, 1e-7), "0");
  EXPECT_EQ(tick_text(2e-7, 1e-7), "2e-07");
}

TEST(Plot, RangesLeaveGapsAway) {
  const float nan = std::nanf("");
  const std::vector<float> a{1, nan, 3}, b{0, -2, 2}, flat{5, 5}, none{nan};
  const auto range = [](const std::vector<float>& v, bool log) {
    const lab::Curve curve{"", 0, v};
    return lab::axis_range({&curve, 1}, log);
  };
  EXPECT_NEAR(range(a, false)[0], 0.88, 1e-6);
  EXPECT_NEAR(range(a, false)[1], 3.12, 1e-6);
  EXPECT_EQ(range(b, true), (std::array{1.0, 10.0}));
  EXPECT_LT(range(flat, false)[0], 5);
  EXPECT_GT(range(flat, false)[1], 5);
  EXPECT_EQ(range(none, false), (std::array{0.0, 1.0}));
}

// -------------------------------------------------------- The learning viewer

/** A window on a small hanging sheet, in memory, and its simulation. */
struct LiveWindow {
  std::unique_ptr<lab::Screen> screen =
      lab::Screen::open(lab::Screen::Kind::pictures);  // 1024 x 768
  struct Seen {
    lab::Model model;
    lab::Readings now;
    std::vector<bool> pinned;
  };

  explicit LiveWindow(bool paused = true) {
    screen->open_panels(0);
    screen->set_paused(paused);
  }
  static lab::Model sheet() {
    lab::Model m;
    m.sheets = {{.u = Point(1, 0, 0), .v = Point(0, 0, 1), .nodes = {5, 5}}};
    m.pins.push_back({0, 0, 1, {}});
    m.view = lab::Box{Point(-0.2, 0, -0.2), Point(1.2, 0, 1.2)};
    m.step.dt = 0.001;
    m.t_end = 1e6;
    return m;
  }
  /** Where a point [m] of the sheet is drawn. */
  static std::array<int, 2> at(const Point& p) {
    Picture picture{{}, 1024, 768};
    picture.camera.set_hidden_left(300 / 1024.0);
    picture.camera.look_from(Point(1, -0.8, 0.4));
    picture.camera.fit(
        (BoundingBox() |= Point(-0.2, 0, -0.2)) |= Point(1.2, 0, 1.2),
        picture.aspect());
    const Point q = picture.place_of(p);
    return {int(q.x), int(q.y)};
  }
  Seen seen() {
    std::lock_guard lock(mutex_);
    return seen_;
  }
  bool sees(const std::function<bool(const Seen&)>& what) {
    return soon([&] { return what(seen()); });
  }
  /** Where a control is, once it is drawn. */
  std::array<int, 2> find(const std::string& control) {
    std::array<double, 2> p{}, last{};
    const bool there = soon([&] {
      Mouse::expose();
      CME212::sleep(0.02);
      last = std::exchange(p, screen->place_of(control));
      return p[0] > 0 && p == last;
    });
    EXPECT_TRUE(there) << control;
    return {int(p[0]), int(p[1])};
  }
  void click(const std::string& control) {
    const auto [x, y] = find(control);
    Mouse::click(x, y);
  }
  /** Close a part of the panel: what is @a below moves up. */
  void fold(const std::string& part, const std::string& below) {
    const int y = find(below)[1];
    click(part);
    EXPECT_TRUE(soon([&] {
      Mouse::expose();
      CME212::sleep(0.02);
      return screen->place_of(below)[1] < y - 1;
    }));
  }
  /** Drag a slider to its end. */
  void slide(const std::string& control, bool to_right) {
    const auto [x, y] = find(control);
    Mouse::drag(x - 30, y, to_right ? x + 250 : x - 250, y);
  }
  void run(const std::function<void()>& user) {
    lab::Live live(sheet());
    std::thread simulation([&] {
      const auto show = [&] {
        screen->show(live);
        std::lock_guard lock(mutex_);
        seen_ = {live.model(), live.readings(), {}};
        for (unsigned k = 0; k < seen_.now.nodes; ++k)
          seen_.pinned.push_back(live.scene().is_pinned(k));
      };
      show();
      while (!screen->closed()) {
        if (screen->serve(live)) show();
        if (screen->take_restart()) live.apply("restart"), show();
        if (!screen->wait_while_paused(show)) continue;
        if (live.done()) continue;
        live.step(), show();
      }
    });
    std::thread thread([&] {
      user();
      screen->close();
    });
    screen->event_loop();
    simulation.join();
    thread.join();
  }

 private:
  std::mutex mutex_;
  Seen seen_;
};

// A step beyond the limit is told where nothing moves for it.
TEST(LiveThreads, AWarningMovesNoControl) {
  LiveWindow w(true);
  w.run([&] {
    const int before = w.find("K [N/m]")[1];
    w.slide("dt / limit", true);
    EXPECT_TRUE(w.sees([](const LiveWindow::Seen& s) {
      return s.now.dt > 2 * s.now.safe_limit;
    }));
    EXPECT_EQ(w.find("K [N/m]")[1], before);
  });
}

TEST(LiveThreads, TheCureOfAFailureIsOneClick) {
  LiveWindow w(false);
  w.run([&] {
    w.slide("dt / limit", true);
    EXPECT_TRUE(w.sees(
        [](const LiveWindow::Seen& s) { return !s.now.failure.empty(); }));
    w.click("apply the cure");
    EXPECT_TRUE(w.sees([](const LiveWindow::Seen& s) {
      return s.now.failure.empty() && s.now.dt < s.now.safe_limit;
    }));
  });
}

TEST(LiveThreads, EachControlChangesTheSimulation) {
  LiveWindow w;
  using Seen = LiveWindow::Seen;
  w.run([&] {
    w.click("step");
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.now.steps == 1; }));
    w.click("method");
    w.click("method/rk4");
    EXPECT_TRUE(w.sees([](const Seen& s) {
      return s.model.method->info.name == std::string("rk4") &&
             s.now.method == std::string("rk4");
    }));
    w.slide("dt / limit", true);
    EXPECT_TRUE(w.sees([](const Seen& s) {
      return std::abs(s.now.dt / s.now.dt_unit - 10) < 1e-9;
    }));
    w.slide("dt / limit", false);
    EXPECT_TRUE(w.sees([](const Seen& s) {
      return std::abs(s.now.dt / s.now.dt_unit - 0.01) < 1e-9;
    }));
    w.slide("K [N/m]", true);
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.model.stiffness == 1e5; }));
    w.slide("drag [kg/s]", true);
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.model.damping == 1; }));
    w.slide("g [m/s^2]", false);
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.model.gravity == -20; }));
    EXPECT_EQ(w.screen->speed(), 0);
    w.slide("time scale", false);
    EXPECT_TRUE(soon([&] { return w.screen->speed() == 0.01; }));
    w.click("step");
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.now.steps == 2; }));
    w.click("restart");
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.now.time == 0; }));
    w.click("play");
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.now.steps > 20; }));
  });
}

TEST(LiveThreads, AMethodOfTheProgramStaysInTheList) {
  lab::MethodEntry own = *lab::find_method("verlet");
  own.info.name = "yours";
  lab::own_method = &own;
  LiveWindow w;
  using Seen = LiveWindow::Seen;
  w.run([&] {
    for (const char* name : {"rk4", "yours"}) {
      w.click("method");
      w.click(std::string("method/") + name);
      EXPECT_TRUE(w.sees([name](const Seen& s) {
        return s.model.method->info.name == std::string(name) &&
               s.now.method == std::string(name);
      }));
    }
  });
  lab::own_method = nullptr;
}

TEST(LiveThreads, TwoMethodsAreCompared) {
  LiveWindow w;
  using Seen = LiveWindow::Seen;
  w.run([&] {
    w.fold("Numbers", "Plots"), w.fold("Plots", "Two methods");
    w.click("Two methods");
    w.click("second");
    w.click("second/pefrl");
    w.click("equal work");
    w.click("compare");
    EXPECT_TRUE(w.sees([](const Seen& s) {
      return s.now.comparison &&
             s.now.comparison->rival.method == std::string("pefrl") &&
             s.now.comparison->equal_work;
    }));
    w.click("side by side");
    w.click("equal time");
    EXPECT_TRUE(w.sees([](const Seen& s) {
      return s.now.comparison && !s.now.comparison->equal_work;
    }));
    w.slide("its dt / limit", false);
    EXPECT_TRUE(w.sees([](const Seen& s) {
      const auto& c = s.now.comparison;
      return c && c->rival.dt < 0.02 * c->rival.dt_unit;
    }));
    w.click("step");
    EXPECT_TRUE(w.sees([](const Seen& s) {
      return s.now.comparison && s.now.comparison->apart.largest > 0;
    }));
    w.click("stop comparing");
    EXPECT_TRUE(w.sees([](const Seen& s) { return !s.now.comparison; }));
  });
}

TEST(LiveThreads, ScenesAreChosenAndBroken) {
  LiveWindow w;
  using Seen = LiveWindow::Seen;
  w.run([&] {
    w.fold("Numbers", "Plots"), w.fold("Plots", "Two methods");
    w.click("Scenes, and how to break them");
    w.click("scene");
    w.click("scene/drape");
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.model.name == "drape"; }));
    for (const lab::StoredScene& b : lab::failing_scenes()) {
      w.click(b.name);
      EXPECT_TRUE(w.sees([&](const Seen& s) { return s.model.name == b.name; }))
          << b.name;
    }
  });
}

TEST(LiveThreads, TheMousePullsCutsAndPinsTheCloth) {
  LiveWindow w;
  using Seen = LiveWindow::Seen;
  w.run([&] {
    w.find("play");
    const auto [x, y] = LiveWindow::at(Point(1, 0, 0));
    Mouse::move(x, y);
    Mouse::key(SDLK_p);
    const auto pins = [](const Seen& s) {
      return std::count(s.pinned.begin(), s.pinned.end(), true);
    };
    EXPECT_TRUE(w.sees([&](const Seen& s) { return pins(s) == 2; }));
    Mouse::key(SDLK_p, false);
    Mouse::key(SDLK_p);
    EXPECT_TRUE(w.sees([&](const Seen& s) { return pins(s) == 1; }));
    Mouse::move(x, y), Mouse::button(x, y, true);
    EXPECT_TRUE(w.sees([](const Seen& s) { return s.now.grabbed; }));
    Mouse::move(x + 60, y, true);
    Mouse::button(x + 60, y, false);
    EXPECT_TRUE(w.sees([](const Seen& s) { return !s.now.grabbed; }));
    // Between the first two columns of nodes: 5 sides and 8 diagonals.
    const unsigned edges = w.seen().now.edges;
    const auto [x0, y0] = LiveWindow::at(Point(0.125, 0, -0.1));
    const auto [x1, y1] = LiveWindow::at(Point(0.125, 0, 1.1));
    Mouse::key(SDLK_LCTRL);
    Mouse::drag(x0, y0, x1, y1);
    Mouse::key(SDLK_LCTRL, false);
    EXPECT_TRUE(
        w.sees([&](const Seen& s) { return s.now.edges == edges - 13; }));
  });
}

}  // namespace
