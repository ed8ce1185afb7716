#pragma once
/** @file SDLViewer.hpp
 * A viewer for the tests of whole programs: it shows nothing, and keeps what it
 * was given to draw, see film.hpp. */

// A program that lies beside the real header would find that one first. So it
// is read here, once, under another name.
#if __has_include("mass_spring.hpp")
#define SDLViewer WindowedViewer
#include_next "CME212/SDLViewer.hpp"
#undef SDLViewer
#endif

#include "../../film.hpp"
#include "CME212/viewer/NoViewer.hpp"

namespace CME212 {

class SDLViewer : public NoViewer {
 public:
  struct Options {
    int width = 1024, height = 768;
    std::string title;
    bool offscreen = false, restarts = false, colors = false;
    std::string picture;
  };
  SDLViewer() : NoViewer(Films()) {}
  explicit SDLViewer(const Options&) : SDLViewer() {}
  SDLViewer(const SDLViewer&) = delete;
  static bool has_display() { return false; }
  bool in_window() const { return true; }  // it may be closed, as a window

  /** Colors, positions and a map of nodes may follow. */
  template <typename It, typename... More>
  void add_nodes(It first, It last, More&&...) {
    kit::film_nodes(first, last);
  }
  template <typename It, typename Map>
  void add_edges(It first, It last, const Map&) {
    kit::film_edges(first, last);
  }
  template <typename G>
  void draw_graph(G& g) {
    draw_graph_nodes(g);
    if (!kit::film().edges.empty()) return;  // the first ones are kept
    std::vector<std::decay_t<decltype(g.edge(0))>> edges;
    for (decltype(g.num_edges()) i = 0; i < g.num_edges(); ++i)
      edges.push_back(g.edge(i));
    kit::film_edges(edges.begin(), edges.end());
  }
  template <typename G>
  void draw_graph_nodes(G& g) {
    std::vector<std::decay_t<decltype(g.node(0))>> nodes;
    for (decltype(g.num_nodes()) i = 0; i < g.num_nodes(); ++i)
      nodes.push_back(g.node(i));
    kit::film_nodes(nodes.begin(), nodes.end());
  }

  template <typename... T>
  void add_faces(const T&...) {}
  template <typename T>
  void set_label(const T& label) {
    if constexpr (std::is_arithmetic_v<T>) {
      std::lock_guard lock(kit::film().mutex);
      kit::film().t = double(label);
    }
  }
  bool closed() const {
    std::lock_guard lock(kit::film().mutex);
    return kit::film().ended;
  }
  bool wants_frame() const { return true; }
  template <typename... Show>
  bool wait_while_paused(const Show&...) {
    return !closed();
  }
  /** Until the threads that draw have ended, or enough was seen. */
  void event_loop() {
    kit::Film& f = kit::film();
    std::unique_lock lock(f.mutex);
    using std::chrono::seconds;
    f.news.wait_for(lock, seconds(2), [&f] { return f.drew || f.ended; });
    f.news.wait_for(lock, seconds(60),
                    [&f] { return f.ended || f.drawing == 0; });
  }
};

}  // namespace CME212
