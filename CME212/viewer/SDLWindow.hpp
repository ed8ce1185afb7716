#pragma once
/** @file SDLWindow.hpp
 * SDLWindow: a window, shown or not, that OpenGL draws into. */
#define SDL_DISABLE_IMMINTRIN_H  // unused here, and 100 MB for the compiler
#include <SDL.h>
#include <SDL_opengl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "CME212/viewer/NoDisplay.hpp"

namespace CME212 {

/** Starts SDL's video; the destructor ends it. */
class SDLVideo {
 public:
  /** @param offscreen Draw without any display, and without a window.
   * Throws NoDisplay with SDL's reason. */
  explicit SDLVideo(bool offscreen) {
    // By name: otherwise, if a display can't be opened, SDL silently takes a
    // driver that shows nothing.
    const bool mac = SDL_GetPlatform() == std::string("Mac OS X");
    const char* driver = "offscreen";
    if (!offscreen) driver = std::getenv("SDL_VIDEODRIVER");
    if (mac) driver = "cocoa";  // always there; it draws hidden windows, too
    if (!driver && std::getenv("WAYLAND_DISPLAY")) driver = "x11,wayland";
    if (!driver && std::getenv("DISPLAY")) driver = "x11";
    if (!driver) throw NoDisplay("neither DISPLAY nor WAYLAND_DISPLAY is set");
    SDL_SetHintWithPriority(SDL_HINT_VIDEODRIVER, driver, SDL_HINT_OVERRIDE);
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // Ctrl-C ends the program
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    // If the processor draws, half of its cores do; the rest simulates, which
    // waits for pictures but not for a window.
    const unsigned cores = std::thread::hardware_concurrency();
    setenv("LP_NUM_THREADS",
           std::to_string(std::max(offscreen ? cores : cores / 2, 1u)).c_str(),
           false);
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) throw NoDisplay(SDL_GetError());
  }
  SDLVideo(const SDLVideo&) = delete;
  SDLVideo& operator=(const SDLVideo&) = delete;
  ~SDLVideo() { SDL_QuitSubSystem(SDL_INIT_VIDEO); }

  /** True if a window can be seen. */
  bool has_display() const {
    const std::string driver = SDL_GetCurrentVideoDriver();
    return driver != "offscreen" && driver != "dummy";
  }
};

/** A window with an OpenGL 3.3 core context, hidden at first. Main thread. */
class SDLWindow {
 public:
  static constexpr std::array<int, 2> usual_size{1024, 768};

  /** @param width,height In the units of the desktop; 0: three quarters of the
   * screen, but at least usual_size. A window that is seen has no more than
   * fits.
   * Throws NoDisplay with SDL's reason. */
  SDLWindow(const std::string& title, int width, int height, bool offscreen)
      : video_(offscreen) {
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK,
                        SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 24);
    SDL_Rect room{};
    if (!offscreen) SDL_GetDisplayUsableBounds(0, &room);
    if (width == 0) {
      width = std::max(usual_size[0], room.w * 3 / 4);
      height = std::max(usual_size[1], room.h * 3 / 4);
    }
    if (room.w > 0)
      width = std::min(width, room.w), height = std::min(height, room.h);
    for (int samples : {4, 0}) {
      SDL_GL_SetAttribute(SDL_GL_MULTISAMPLEBUFFERS, samples > 0);
      SDL_GL_SetAttribute(SDL_GL_MULTISAMPLESAMPLES, samples);
      context_.reset();
      window_.reset(SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED,
                                     SDL_WINDOWPOS_CENTERED, width, height,
                                     SDL_WINDOW_OPENGL | SDL_WINDOW_HIDDEN |
                                         SDL_WINDOW_RESIZABLE |
                                         SDL_WINDOW_ALLOW_HIGHDPI));
      if (window_) context_.reset(SDL_GL_CreateContext(window_.get()));
      if (context_ && !is_software()) break;  // software is slow with samples
    }
    if (!context_) throw NoDisplay(SDL_GetError());
    SDL_GL_SetSwapInterval(1);
  }

  void set_title(const std::string& title) const {
    SDL_SetWindowTitle(window_.get(), title.c_str());
  }
  void show() const { SDL_ShowWindow(window_.get()); }
  void hide() const { SDL_HideWindow(window_.get()); }
  /** OpenGL calls go to this window from now on. */
  void make_current() const {
    SDL_GL_MakeCurrent(window_.get(), context_.get());
  }
  /** Show what was drawn. */
  void swap() const { SDL_GL_SwapWindow(window_.get()); }

  /** Width and height of what is drawn [pixels]. */
  std::array<int, 2> pixels() const {
    std::array<int, 2> size{};
    SDL_GL_GetDrawableSize(window_.get(), &size[0], &size[1]);
    return {std::max(size[0], 1), std::max(size[1], 1)};
  }
  /** Width and height in the units of the desktop and the mouse: less than
   * pixels() on a screen of high resolution. */
  std::array<int, 2> size() const {
    std::array<int, 2> size{};
    SDL_GetWindowSize(window_.get(), &size[0], &size[1]);
    return {std::max(size[0], 1), std::max(size[1], 1)};
  }
  bool minimized() const {
    return SDL_GetWindowFlags(window_.get()) & SDL_WINDOW_MINIMIZED;
  }

 private:
  struct Destroy {
    void operator()(SDL_Window* w) const { SDL_DestroyWindow(w); }
    void operator()(void* context) const { SDL_GL_DeleteContext(context); }
  };
  /** True if the processor draws, as there is no graphics card. */
  static bool is_software() {
    const auto* name = glGetString(GL_RENDERER);
    const std::string renderer(reinterpret_cast<const char*>(name));
    return renderer.find("llvmpipe") != renderer.npos ||
           renderer.find("softpipe") != renderer.npos;
  }

  SDLVideo video_;
  std::unique_ptr<SDL_Window, Destroy> window_;
  std::unique_ptr<void, Destroy> context_;
};

}  // namespace CME212
