#pragma once
/** @file NoViewer.hpp
 * NoViewer: the members of SDLViewer, without a window: they do nothing. */
#include <string>
#include <vector>

#include "CME212/viewer/NoDisplay.hpp"
#include "CME212/viewer/SceneBuilder.hpp"

namespace CME212 {

/** The viewer of programs built with VIEWER=0, where none can be made; and the
 * base of the viewer with which the course tests programs. */
class NoViewer : public SceneBuilder {
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

  template <typename... T>
  void set_view(const T&...) {}
  template <typename T>
  void set_label(const T&) {}
  void set_message(const std::vector<std::string>&) {}
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
