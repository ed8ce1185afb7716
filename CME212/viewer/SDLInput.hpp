#pragma once
/** @file SDLInput.hpp
 * SDLInput: gives Dear ImGui the events of SDL. */
#include <SDL.h>
#include <imgui.h>

#include <deque>
#include <utility>
#include <vector>

namespace CME212 {

/** Gives Dear ImGui the user's input, with each press or release of a button or
 * key in a separate frame. So a program that draws slowly loses none of them,
 * and each has the mouse position of its time. */
class SDLInput {
 public:
  /** Tell Dear ImGui which keys edit text.
   * @pre A context of Dear ImGui is current, here and in feed(). */
  static void name_keys() {
    auto& io = ImGui::GetIO();
    for (auto [key, code] : {std::pair(ImGuiKey_Tab, SDL_SCANCODE_TAB),
                             {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
                             {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
                             {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
                             {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
                             {ImGuiKey_Home, SDL_SCANCODE_HOME},
                             {ImGuiKey_End, SDL_SCANCODE_END},
                             {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
                             {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
                             {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
                             {ImGuiKey_KeyPadEnter, SDL_SCANCODE_KP_ENTER},
                             {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
                             {ImGuiKey_A, SDL_SCANCODE_A}})
      io.KeyMap[key] = code;
  }

  void add(const SDL_Event& e) { waiting_.push_back(e); }
  /** True if some input is left for the next frame. */
  bool waits() const { return !waiting_.empty(); }

  /** Give all input before the next press or release, or else that one.
   * @param pixels To a unit of the mouse
   * @return what was given */
  std::vector<SDL_Event> feed(double pixels) {
    std::vector<SDL_Event> given;
    while (!waiting_.empty()) {
      const SDL_Event e = waiting_.front();
      if (presses(e) && !given.empty()) break;
      waiting_.pop_front();
      given.push_back(e);
      give(e, pixels);
      if (presses(e)) break;
    }
    return given;
  }

 private:
  std::deque<SDL_Event> waiting_;

  static bool presses(const SDL_Event& e) {
    return e.type == SDL_MOUSEBUTTONDOWN || e.type == SDL_MOUSEBUTTONUP ||
           e.type == SDL_KEYDOWN || e.type == SDL_KEYUP;
  }
  static void give(const SDL_Event& e, double pixels) {
    auto& io = ImGui::GetIO();
    switch (e.type) {
      case SDL_MOUSEMOTION:
        io.MousePos = place(e.motion, pixels);
        return;
      case SDL_MOUSEBUTTONDOWN:
      case SDL_MOUSEBUTTONUP: {
        io.MousePos = place(e.button, pixels);
        const int button = e.button.button == SDL_BUTTON_LEFT    ? 0
                           : e.button.button == SDL_BUTTON_RIGHT ? 1
                                                                 : 2;
        io.MouseDown[button] = e.type == SDL_MOUSEBUTTONDOWN;
        return;
      }
      case SDL_MOUSEWHEEL:
        io.MouseWheel += e.wheel.preciseY;
        return;
      case SDL_TEXTINPUT:
        io.AddInputCharactersUTF8(e.text.text);
        return;
      case SDL_KEYDOWN:
      case SDL_KEYUP:
        if (const int code = e.key.keysym.scancode; code < 512)
          io.KeysDown[code] = e.type == SDL_KEYDOWN;
        io.KeyCtrl = e.key.keysym.mod & KMOD_CTRL;
        io.KeyShift = e.key.keysym.mod & KMOD_SHIFT;
        io.KeyAlt = e.key.keysym.mod & KMOD_ALT;
        return;
      case SDL_WINDOWEVENT:
        if (e.window.event == SDL_WINDOWEVENT_LEAVE)
          io.MousePos = ImVec2(-1e9f, -1e9f);
        return;
    }
  }
  template <typename E>
  static ImVec2 place(const E& e, double pixels) {
    return {float(e.x * pixels), float(e.y * pixels)};
  }
};

}  // namespace CME212
