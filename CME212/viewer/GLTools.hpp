#pragma once
/** @file GLTools.hpp
 * OpenGL objects as C++ classes: GLProgram, a pair of shaders; GLMesh, vertices
 * and indices in graphics memory; GLFrame, a picture there.
 *
 * Make and use each with the same OpenGL context current, so on one thread. It
 * owns what they make, and frees it when it is destroyed. */
#define GL_GLEXT_PROTOTYPES
#include <SDL_opengl.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

#include "CME212/Color.hpp"
#include "CME212/Point.hpp"
#include "CME212/viewer/GLCamera.hpp"
#include "CME212/viewer/Image.hpp"

namespace CME212 {

/** A linked pair of shaders. */
class GLProgram {
 public:
  using Texts = std::initializer_list<const char*>;
  /** @param vertex,fragment The text of each, in parts
   * Throws std::runtime_error with the compiler's message. */
  GLProgram(Texts vertex, Texts fragment) {
    attach(GL_VERTEX_SHADER, vertex);
    attach(GL_FRAGMENT_SHADER, fragment);
    glLinkProgram(id_);
    GLint ok = 0;
    glGetProgramiv(id_, GL_LINK_STATUS, &ok);
    if (!ok) throw std::runtime_error("OpenGL: a program does not link");
  }

  void use() const { glUseProgram(id_); }
  // These set variables of the program in use; unknown names are ignored.
  void set(const char* name, const GLCamera::Matrix& m) const {
    glUniformMatrix4fv(at(name), 1, GL_FALSE, m.data());
  }
  void set(const char* name, float x) const { glUniform1f(at(name), x); }
  void set(const char* name, float x, float y) const {
    glUniform2f(at(name), x, y);
  }
  void set(const char* name, const Point& p) const {
    glUniform3f(at(name), float(p.x), float(p.y), float(p.z));
  }
  void set(const char* name, const Color& c) const {
    glUniform3f(at(name), c.r, c.g, c.b);
  }

 private:
  GLuint id_ = glCreateProgram();

  GLint at(const char* name) const { return glGetUniformLocation(id_, name); }
  void attach(GLenum kind, Texts texts) const {
    std::vector<const char*> all{"#version 330 core\n"};
    all.insert(all.end(), texts);
    GLuint shader = glCreateShader(kind);
    glShaderSource(shader, GLsizei(all.size()), all.data(), nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    char log[1000] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    glAttachShader(id_, shader);
    glDeleteShader(shader);
    if (!ok) throw std::runtime_error(std::string("OpenGL: ") + log);
  }
};

/** Vertices, and indices that form primitives; both change often. */
class GLMesh {
 public:
  GLMesh() {
    glGenVertexArrays(1, &array_);
    glGenBuffers(2, buffers_);
    bind();
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
  }

  void bind() const {
    glBindVertexArray(array_);
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  }
  /** Replace the contents. The driver gives each upload memory of its own
   * (orphaning), so it never waits for a frame that is still drawn. */
  template <typename T>
  void set_vertices(const std::vector<T>& v) {
    bind();
    stream(GL_ARRAY_BUFFER, v);
  }
  template <typename T>
  void set_indices(const std::vector<T>& v) {
    bind();
    stream(GL_ELEMENT_ARRAY_BUFFER, v);
    count_ = GLsizei(v.size() * sizeof(T) / sizeof(std::uint32_t));
  }
  /** Draw by index: all, or @a count indices from the one of @a first on.
   * @pre bind() */
  void draw(GLenum kind) const { draw(kind, 0, count_); }
  void draw(GLenum kind, GLsizei first, GLsizei count) const {
    glDrawElements(kind, count, GL_UNSIGNED_INT,
                   reinterpret_cast<void*>(first * sizeof(std::uint32_t)));
  }

 private:
  GLuint array_ = 0, buffers_[2] = {};
  GLsizei count_ = 0;

  template <typename T>
  static void stream(GLenum target, const std::vector<T>& v) {
    auto bytes = GLsizeiptr(v.size() * sizeof(T));
    glBufferData(target, bytes, nullptr, GL_STREAM_DRAW);
    if (bytes > 0) glBufferSubData(target, 0, bytes, v.data());
  }
};

/** A picture in the graphics memory, smoothed by several samples a pixel. */
class GLFrame {
 public:
  /** @param samples A pixel; less if the driver has less, 0 for none
   * Throws std::runtime_error if the driver can't. */
  GLFrame(int width, int height, int samples = 4)
      : width_(width), height_(height) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    glGenFramebuffers(2, frames_);
    glGenRenderbuffers(3, stores_);
    attach(frames_[0], GL_COLOR_ATTACHMENT0, stores_[0], GL_RGBA8,
           std::min(samples, most));
    attach(frames_[0], GL_DEPTH_ATTACHMENT, stores_[1], GL_DEPTH_COMPONENT24,
           std::min(samples, most));
    attach(frames_[1], GL_COLOR_ATTACHMENT0, stores_[2], GL_RGBA8, 0);
    for (GLuint frame : frames_) {
      glBindFramebuffer(GL_FRAMEBUFFER, frame);
      if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("OpenGL: no frame buffer of this size");
    }
  }

  /** Draw into this from now on, until read(). */
  void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, frames_[0]); }

  /** The picture. From now on, draw into the window again. */
  Image read() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frames_[0]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frames_[1]);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, frames_[1]);
    Image bottom_up(width_, height_), image(width_, height_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE,
                 bottom_up.rgb.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (int y = 0; y < height_; ++y)
      std::copy_n(bottom_up.pixel(0, y), 3 * width_,
                  image.pixel(0, height_ - 1 - y));
    return image;
  }

 private:
  int width_, height_;
  GLuint frames_[2] = {}, stores_[3] = {};

  void attach(GLuint frame, GLenum as, GLuint store, GLenum format,
              int samples) const {
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glBindRenderbuffer(GL_RENDERBUFFER, store);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width_,
                                     height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, as, GL_RENDERBUFFER, store);
  }
};

}  // namespace CME212
