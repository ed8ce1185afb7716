#pragma once
/** @file GLShaders.hpp
 * The shaders of GLScene; those with lit() come after light_source. */

namespace CME212 {

namespace shaders {

/** Faces, lit from both sides; a little light comes through from behind. Light
 * is computed at nodes, of which there are fewer than pixels. */
constexpr const char* face_vertex = R"(
  layout(location = 0) in vec3 at;
  layout(location = 1) in vec3 color;
  layout(location = 2) in vec4 normal;  // of the front
  uniform mat4 view, projection;
  uniform vec3 front_dye, back_dye;
  uniform vec3 to_eye;     // from the middle of the picture, of length 1
  uniform float nearer;    // factor of the distance
  out vec3 front, back;
  void main() {
    vec3 n = normal.xyz;
    float d = dot(n, to_light);
    float lamp = 0.4 * abs(d) * lit(at + 0.004 * sign(d) * n);
    float through = 0.2 * abs(d);
    float around = 0.5 + 0.2 * abs(dot(n, to_eye));
    float sky = 0.08 * n.z;
    front = color * front_dye * (around + sky + (d > 0 ? lamp : through));
    back = color * back_dye * (around - sky + (d < 0 ? lamp : through));
    vec4 eye = view * vec4(at, 1);
    eye.xyz *= nearer;
    gl_Position = projection * eye;
  })";
constexpr const char* face_fragment = R"(
  in vec3 front, back;
  out vec4 color;
  void main() { color = vec4(gl_FrontFacing ? front : back, 1); })";

/** Edges and nodes. They are drawn a little nearer to the eye, nodes most, so
 * that a surface does not hide what lies on it. */
constexpr const char* cloth_vertex = R"(
  layout(location = 0) in vec3 at;
  layout(location = 1) in vec3 color_in;
  layout(location = 2) in vec4 normal_in;  // w: is in a face
  uniform mat4 view, projection;
  uniform vec3 fade_to, size;  // of a node: at distance 1, least, most
  uniform vec2 range;          // distances between which a wire fades
  uniform float tint;          // 1: the node's color; 0: fade_to
  uniform float nearer;        // factor of the distance
  uniform float show, ink;     // of what is in a face: is it drawn, how dark
  out vec4 shade;
  flat out float radius;
  void main() {
    vec4 eye = view * vec4(at, 1);
    float fade = clamp((-eye.z - range.x) / (range.y - range.x), 0, 1);
    shade = vec4(mix(fade_to, color_in, tint * (1 - 0.35 * fade)), 1);
    if (normal_in.w > 0 && ink > 0) shade = vec4(0.3 * color_in, ink);
    eye.xyz *= nearer;
    gl_Position = projection * eye;
    if (show < 1 && normal_in.w > 0)
      gl_Position = vec4(2, 2, 2, 1);  // out of the picture
    gl_PointSize = clamp(size.x / -eye.z, size.y, size.z) + 1;  // soft rim
    radius = gl_PointSize / 2;
  })";
constexpr const char* node_fragment = R"(
  in vec4 shade;
  flat in float radius;
  out vec4 color;
  void main() {
    float inside = radius * (1 - length(2 * gl_PointCoord - 1));
    if (inside < 0.1) discard;
    color = vec4(shade.rgb, min(inside, 1));
  })";
constexpr const char* edge_fragment = R"(
  in vec4 shade;
  out vec4 color;
  void main() { color = shade; })";
/** The unit sphere, placed in the world; the lamp's light at its vertices. */
constexpr const char* sphere_vertex = R"(
  layout(location = 0) in vec3 at;
  uniform mat4 view, projection;
  uniform vec3 center;
  uniform float radius;
  out vec3 normal;
  out float light;
  void main() {
    vec3 place = center + radius * at;
    float d = dot(at, to_light);
    light = 0.54 + 0.08 * at.z + (d > 0 ? 0.52 * d * lit(place) : 0.0);
    normal = mat3(view) * at;
    gl_Position = projection * (view * vec4(place, 1));
  })";
constexpr const char* sphere_fragment = R"(
  in vec3 normal;
  in float light;
  uniform vec3 paint;
  out vec4 color;
  void main() {
    float front = abs(normalize(normal).z);
    color = vec4(paint * (light + 0.22 * front) + 0.08 * pow(1 - front, 3), 1);
  })";

/** In front of a fragment shader: the color behind all, by its height. */
constexpr const char* backdrop = R"(
  uniform vec3 above, below;
  uniform float height;  // of the picture [pixels]
  out vec4 color;
  vec3 backdrop() { return mix(below, above, gl_FragCoord.y / height); }
)";
/** The whole picture. */
constexpr const char* backdrop_vertex = R"(
  void main() {
    vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2);
    gl_Position = vec4(2 * corner - 1, 0, 1);
  })";
constexpr const char* backdrop_fragment = R"(
  void main() { color = vec4(backdrop(), 1); })";

/** The unit disc, placed in the world; at its rim it fades to the backdrop. */
constexpr const char* plane_vertex = R"(
  layout(location = 0) in vec3 at;
  uniform mat4 view, projection;
  uniform vec3 center;
  uniform float radius;
  out vec2 local;
  out vec3 place;
  void main() {
    local = at.xy;
    place = center + radius * at;
    gl_Position = projection * (view * vec4(place, 1));
  })";
constexpr const char* plane_fragment = R"(
  in vec2 local;
  in vec3 place;
  uniform float dark;  // how dark a shadow is; 0: there is none
  void main() {
    const vec3 paint = vec3(0.44, 0.45, 0.48);
    vec2 p = local * 10, width = fwidth(p);  // lines from center to rim
    vec2 line = 1 - clamp(abs(fract(p + 0.5) - 0.5) / width, 0, 1);
    float rim = max(1 - dot(local, local), 0);
    float light = 0.68 + 0.12 * max(line.x, line.y);
    float shade = dark > 0 ? dark * sqrt(rim) * (1 - lit(place)) : 0.0;
    color = vec4(mix(backdrop(), paint * light, 0.9 * sqrt(rim)), 1);
    color.rgb *= 1 - shade;
  })";

/** A picture over the whole one, its rows from the top. */
constexpr const char* overlay_fragment = R"(
  uniform sampler2D layer;
  uniform float height;
  out vec4 color;
  void main() {
    color = texelFetch(layer, ivec2(gl_FragCoord.x, height - gl_FragCoord.y),
                       0);
  })";

}  // namespace shaders

}  // namespace CME212
