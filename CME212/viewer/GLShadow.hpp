#pragma once
/** @file GLShadow.hpp
 * The light of a scene: a distant lamp, and the shadow map, which says where
 * its light falls. */
#include <cmath>

#include "CME212/Point.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/GLTools.hpp"

namespace CME212 {

namespace shaders {

/** For shaders, in front of their own text. */
constexpr const char* light_source = R"(
  uniform vec3 to_light;  // of length 1, in the world
  uniform mat4 to_map;    // world to the shadow map
  uniform sampler2DShadow shadow_map;
  uniform float blur;     // of a shadow's rim, in parts of the map

  const vec3 sides[] = vec3[](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0),
                              vec3(0, -1, 0));
  /** Share of the lamp's light that reaches a place of the world: percentage
   * closer filtering. Most places are all light or all shadow: four taps. */
  float lit(vec3 place) {
    vec3 p = 0.5 * (to_map * vec4(place, 1)).xyz + 0.5;
    p.z = min(p.z, 1);  // what is beyond the map is below all that is in it
    float sum = 0;
    for (int i = 0; i < 4; ++i)
      sum += texture(shadow_map,
                     p + blur * vec3(i % 2 * 2 - 1, i / 2 * 2 - 1, 0));
    if (sum == 0 || sum == 4) return sum / 4;
    for (int i = 0; i < 4; ++i)  // the middle counts four times, sides twice
      sum += 2 * texture(shadow_map, p + blur * sides[i]);
    return (sum + 4 * texture(shadow_map, p)) / 16;
  }
)";
constexpr const char* caster_vertex = R"(
  layout(location = 0) in vec3 at;
  uniform mat4 to_map;
  uniform vec3 center;
  uniform float radius;  // center and radius of a ball; 0 and 1 of the cloth
  void main() { gl_Position = to_map * vec4(center + radius * at, 1); })";
constexpr const char* caster_fragment = "void main() {}";

}  // namespace shaders

/** Depths as the lamp sees them. Fixed in the world for as long as the camera
 * looks at the same box: so shadows don't flicker. */
class GLShadow {
 public:
  /** The direction of the lamp: high and to the left, if one looks along +y. */
  static Point to_light() { return Point(-0.35, -0.4, 0.85) / 1.0025; }

  /** At right angles to it and to each other. */
  static Point across() {
    return Point(0.85, 0, 0.35) / std::hypot(0.85, 0.35);
  }
  static Point along() { return cross(to_light(), across()); }

  GLShadow() {
    glGenFramebuffers(1, &frame_);
    glGenTextures(1, &map_);
    glBindTexture(GL_TEXTURE_2D, map_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0,
                 GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
    for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_BORDER);
    const float bright[] = {1, 1, 1, 1};  // outside there is no shadow
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, bright);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE,
                    GL_COMPARE_REF_TO_TEXTURE);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                           map_, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);  // the window's
  }

  /** Make the map of what @a cast(const GLProgram&) draws, which sets "center"
   * and "radius" of the program in use. Keeps the frame buffer, not the
   * viewport. */
  template <typename F>
  void make(const GLCamera& camera, F cast) {
    // Twice the space that the camera shows, as folds fly about.
    const double half = camera.extent();
    to_map_ = GLCamera::along(
        {across() / half, along() / half, -to_light() / (3 * half)},
        camera.center());
    GLint before = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glViewport(0, 0, size, size);
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    // A surface at a grazing angle to the light must not shade itself.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(2.5f, 4);
    caster_.use();
    caster_.set("to_map", to_map_);
    cast(caster_);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glBindFramebuffer(GL_FRAMEBUFFER, GLuint(before));
  }

  /** Set the light of @a p, the program in use. */
  void use(const GLProgram& p) const {
    glBindTexture(GL_TEXTURE_2D, map_);
    p.set("to_light", to_light());
    p.set("to_map", to_map_);
    p.set("blur", 2.0f / size);
  }

 private:
  static constexpr int size = 512;  // of the map [texels]
  GLuint frame_ = 0, map_ = 0;
  GLCamera::Matrix to_map_{};
  GLProgram caster_{{shaders::caster_vertex}, {shaders::caster_fragment}};
};

}  // namespace CME212
