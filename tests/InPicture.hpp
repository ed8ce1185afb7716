#pragma once
/** @file InPicture.hpp
 * Where a point of the scene lies in the picture of a GLCamera. */
#include "CME212/viewer/GLCamera.hpp"

namespace CME212 {

/** The place of @a p in the picture: x right and y up, in [-1, 1] if it is in
 * the picture; z is its distance from the eye's plane. */
inline Point project(const GLCamera& c, const Point& p, double aspect) {
  const Point d = p - c.eye();
  const double depth = -dot(d, c.backward());
  const double high = GLCamera::half_height(aspect);
  return {dot(d, c.right()) / (depth * high * aspect),
          dot(d, c.up()) / (depth * high), depth};
}

}  // namespace CME212
