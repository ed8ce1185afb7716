#pragma once
/** @file NoViewer.hpp
 * NoViewer: the members of SDLViewer, without a window: they do nothing. */
#include <map>
#include <string>
#include <vector>

#include "CME212/viewer/NoDisplay.hpp"

namespace CME212 {

/** The viewer of programs built with VIEWER=0, where none can be made; and the
 * base of the viewer with which the course tests programs. */
class NoViewer {
 public:
  struct Options {
    std::string picture = {};
  };
  /** Throws NoDisplay, see end_by_no_display(). */
  NoViewer() {
    end_by_no_display();
    throw NoDisplay("built without a window");
  }
  explicit NoViewer(const Options&) : NoViewer() {}

  template <typename G>
  std::map<typename G::node_type, unsigned> empty_node_map(const G&) const {
    return {};
  }
  template <typename... T>
  void add_nodes(T&&...) {}
  template <typename... T>
  void add_edges(const T&...) {}
  template <typename G>
  void draw_graph(const G&) {}
  template <typename G>
  void draw_graph_nodes(const G&) {}
  template <typename... T>
  void add_faces(const T&...) {}
  template <typename... T>
  void add_sphere(const T&...) {}
  template <typename... T>
  void add_plane(const T&...) {}
  template <typename... T>
  void set_view(const T&...) {}
  template <typename T>
  void set_label(const T&) {}
  void set_message(const std::vector<std::string>&) {}
  void clear() {}
  void clear_shapes() {}
  void center_view() {}
  void launch() {}
  void close() {}
  bool closed() const { return true; }
  bool in_window() const { return false; }
  bool wants_frame() const { return false; }
  template <typename... Show>
  bool wait_while_paused(const Show&...) {
    return true;
  }
  void event_loop() {}
  void write_picture() {}

 protected:
  struct Films {};
  explicit NoViewer(Films) {}
};

}  // namespace CME212
