'use strict';
// Draws cloths by WebGL 2 and looks at them from a camera that turns about a
// point. Lengths in meters, z up; matrices by columns.

// Skip layout and paint for elements that did not change.
const setText = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};
// Does the person want nothing to move by itself?
const isStill = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

// The colors that look.css gives to an element: those of View and those of
// curves. The legend of the strain in the element gets them, too.
function looksOf(element) {
  const css = getComputedStyle(element);
  const textOf = name => css.getPropertyValue(name).trim();
  const four = name => textOf(name).split(' ').map(
    (a, k) => k < 3 ? Number(a) / 255 : Number(a));
  const hex = name => [...textOf(name).match(/[0-9a-f]{2}/gi).map(
    a => parseInt(a, 16) / 255), 1];
  const theme = {cloth: [0, 1, 2, 3].map(k => four(`--cloth${k}`)),
    stretched: four('--stretched'), wire: four('--wire'), pin: four('--pin'),
    hand: four('--hand'), ball: four('--ball'),
    floor: four('--floor'), bad: hex('--bad'), sky: hex('--sky')};
  const style = {edge: textOf('--edge'), dim: textOf('--dim'),
    series: [0, 1, 2, 3].map(k => textOf(`--series${k}`))};
  const mixed = name =>
    `rgb(${textOf(name).split(' ').slice(0, 3).join(' ')})`;
  element.querySelector('.strain i').style.background = 'linear-gradient(' +
    `90deg, ${mixed('--cloth0')}, ${mixed('--stretched')})`;
  return {theme, style};
}

const Vec = {
  sub: (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  add: (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]],
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0]],
};

class Camera {
  constructor() {
    this.yaw = -1.1, this.pitch = 0.25, this.zoom = 1;
    this.center = [0.5, 0.1, -0.5], this.radius = 1, this.points = [];
  }
  // Look at all of these points.
  lookAt(points) {
    this.points = points;
    const low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
    for (const p of points)
      for (let k = 0; k < 3; ++k)
        low[k] = Math.min(low[k], p[k]), high[k] = Math.max(high[k], p[k]);
    this.center = Vec.add(low, Vec.sub(high, low), 0.5);
    this.radius = 0.5 * Math.hypot(...Vec.sub(high, low));
  }
  // Look obliquely at what faces along `normal`, from near the side where it is
  // now, and as near as the points that it looks at fit into the picture.
  lookObliquely(points, normal, aspect) {
    this.lookAt(points), this.zoom = 1;
    const {yaw} = this, size = Math.hypot(...normal) || 1;
    let least = Infinity, best;
    for (let turn = -1.2; turn <= 1.2; turn += 0.3)
      for (let pitch = 0.15; pitch <= 1; pitch += 0.15) {
        this.yaw = yaw + turn, this.pitch = pitch;
        const facing = Vec.dot(this.frame(1).back, normal) / size;
        const cost = Math.abs(Math.abs(facing) - 0.75) +
          0.1 * Math.abs(turn) + 0.05 * pitch;
        if (cost < least) least = cost, best = [this.yaw, pitch];
      }
    [this.yaw, this.pitch] = best;
    const frame = this.frame(aspect);
    const most = Math.max(...points.map(p =>
      Math.max(...this.place(frame, p).slice(0, 2).map(Math.abs))));
    this.zoom = 0.85 / most, this.zoomBy(1);
  }
  turn(right, down) {
    this.yaw -= right;
    this.pitch = Math.max(-1.5, Math.min(1.5, this.pitch + down));
  }
  zoomBy(factor) {
    this.zoom = Math.max(0.2, Math.min(8, this.zoom * factor));
  }
  set(yaw, pitch, zoom) {
    this.yaw = yaw, this.pitch = pitch, this.zoom = zoom;
    this.turn(0, 0), this.zoomBy(1);  // within their limits
  }
  // Where it is, and its axes, for a picture of width / height = aspect.
  frame(aspect) {
    const c = Math.cos(this.pitch), s = Math.sin(this.pitch);
    const back = [c * Math.cos(this.yaw), c * Math.sin(this.yaw), s];
    const right = [-Math.sin(this.yaw), Math.cos(this.yaw), 0];
    const up = Vec.cross(back, right);
    const slope = 0.36;  // tangent of half of the angle of view
    const distance = this.fit(slope, aspect) / this.zoom;
    const eye = Vec.add(this.center, back, distance);
    return {eye, back, right, up, slope, distance, aspect};
  }
  // The distance at which all points fit into the picture, from any side.
  fit(slope, aspect) {
    let most = 0.1;
    for (const p of this.points) {
      const [x, y, z] = Vec.sub(p, this.center), flat = Math.hypot(x, y);
      most = Math.max(most, flat / (slope * aspect) + 0.5 * flat,
        1.3 * Math.abs(z) / slope + 0.5 * flat);
    }
    return most;
  }
  // From the world to the picture.
  matrix(f) {
    const near = f.distance / 50, far = f.distance + 40 * this.radius;
    const a = 1 / (f.slope * f.aspect), b = 1 / f.slope;
    const c = (far + near) / (near - far), d = 2 * far * near / (near - far);
    const row = v => [...v, -Vec.dot(v, f.eye)];
    const [x, y, z] = [row(f.right), row(f.up), row(f.back)];
    const m = new Float32Array(16);
    for (let k = 0; k < 4; ++k) {
      m[4 * k] = a * x[k], m[4 * k + 1] = b * y[k];
      m[4 * k + 2] = c * z[k] + (k === 3 ? d : 0), m[4 * k + 3] = -z[k];
    }
    return m;
  }
  // The line of sight through (x, y), each from -1 to 1: [near, far].
  ray(f, x, y) {
    const along = Vec.add(Vec.add(Vec.add([0, 0, 0], f.back, -1), f.right,
      x * f.slope * f.aspect), f.up, y * f.slope);
    return [Vec.add(f.eye, along, f.distance / 50),
      Vec.add(f.eye, along, f.distance + 8 * this.radius)];
  }
  // Where a point is in the picture, and how far away: [x, y, depth].
  place(f, p) {
    const d = Vec.sub(p, f.eye), depth = -Vec.dot(d, f.back);
    return [Vec.dot(d, f.right) / (depth * f.slope * f.aspect),
      Vec.dot(d, f.up) / (depth * f.slope), depth];
  }
  // The point at (x, y) in the plane through `p` that faces the camera.
  pointBeside(f, p, x, y) {
    const [near, far] = this.ray(f, x, y), along = Vec.sub(far, near);
    const share = Vec.dot(Vec.sub(p, near), f.back) / Vec.dot(along, f.back);
    return Vec.add(near, along, share);
  }
}

const vertexShader = `#version 300 es
uniform mat4 view;
uniform vec3 at;      // of a ball
uniform float scale;
uniform float size;   // of points [pixels]
layout(location = 0) in vec4 point;   // x y z, strain
layout(location = 1) in vec3 normal;
out vec3 place, out_normal;
out float strain;
void main() {
  place = at + scale * point.xyz;
  out_normal = normal;
  strain = point.w;
  gl_Position = view * vec4(place, 1);
  gl_PointSize = size;
}`;
const fragmentShader = `#version 300 es
precision highp float;
uniform vec3 eye;
uniform vec4 color, stretched;  // of the cloth at rest, and at most
uniform int kind;               // 0 flat, 1 lit, 2 point, 3 ring, 4 floor
uniform vec3 fog;               // of the floor: center x y, radius
in vec3 place, out_normal;
in float strain;
out vec4 pixel;
void main() {
  vec4 c = mix(color, stretched, smoothstep(0.02, 0.45, strain));
  if (kind == 1) {
    vec3 n = normalize(out_normal), look = normalize(eye - place);
    bool back = dot(n, look) < 0.0;
    if (back) n = -n;
    vec3 lamp = normalize(vec3(0.35, -0.5, 0.9));
    float light = 0.62 + 0.38 * dot(n, lamp);
    float shine = pow(max(dot(n, normalize(lamp + look)), 0.0), 40.0);
    c.rgb = c.rgb * light * (back ? 0.78 : 1.0) + 0.16 * shine;
  } else if (kind >= 2 && kind <= 3) {
    float r = length(2.0 * gl_PointCoord - 1.0);
    if (r > 1.0 || (kind == 3 && r < 0.8)) discard;
  } else if (kind == 4) {
    vec2 cell = abs(fract(place.xy * 4.0) - 0.5) / fwidth(place.xy * 4.0);
    float line = 1.0 - min(min(0.5 / fwidth(place.x * 4.0) - cell.x,
                               0.5 / fwidth(place.y * 4.0) - cell.y), 1.0);
    float far = length(place.xy - fog.xy) / fog.z;
    c.a *= (0.35 + 0.65 * clamp(line, 0.0, 1.0)) *
           (1.0 - smoothstep(0.5, 1.0, far));
  }
  pixel = vec4(c.rgb * c.a, c.a);
}`;

// Points and triangles of a ball of radius 1.
function ballMesh(rings = 24, sectors = 36) {
  const points = [], triangles = [];
  for (let i = 0; i <= rings; ++i)
    for (let j = 0; j <= sectors; ++j) {
      const a = Math.PI * i / rings, b = 2 * Math.PI * j / sectors;
      points.push(Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b),
        Math.cos(a), 0);
    }
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < sectors; ++j) {
      const k = i * (sectors + 1) + j, l = k + sectors + 1;
      triangles.push(k, l, k + 1, k + 1, l, l + 1);
    }
  return [new Float32Array(points), new Uint32Array(triangles)];
}

// The normals of all nodes, in n: the sum of those of the triangles there, by
// area.
function findNormals(points, triangles, n) {
  n.fill(0);
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [triangles[k], triangles[k + 1], triangles[k + 2]];
    const ux = points[4 * b] - points[4 * a],
      uy = points[4 * b + 1] - points[4 * a + 1],
      uz = points[4 * b + 2] - points[4 * a + 2],
      vx = points[4 * c] - points[4 * a],
      vy = points[4 * c + 1] - points[4 * a + 1],
      vz = points[4 * c + 2] - points[4 * a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (const i of [a, b, c])
      n[3 * i] += x, n[3 * i + 1] += y, n[3 * i + 2] += z;
  }
}

// A set of points on the graphics card, with its triangles and lines.
class Shape {
  constructor(gl) {
    this.gl = gl, this.array = gl.createVertexArray();
    this.points = gl.createBuffer(), this.normals = gl.createBuffer();
    this.faces = gl.createBuffer(), this.lines = gl.createBuffer();
    this.normal = new Float32Array();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.points);
    gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
    gl.enableVertexAttribArray(0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.normals);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 0);
    gl.enableVertexAttribArray(1);
  }
  setMesh(triangles, lines) {
    const {gl} = this;
    this.triangles = triangles, this.lineCount = lines.length;
    gl.bindVertexArray(this.array);
    const lists = [[this.faces, triangles], [this.lines, lines]];
    for (const [buffer, ids] of lists) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, ids, gl.STATIC_DRAW);
    }
  }
  setPoints(points) {
    const {gl} = this, size = points.length / 4 * 3;
    if (this.normal.length !== size) this.normal = new Float32Array(size);
    findNormals(points, this.triangles, this.normal);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.points);
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.normals);
    gl.bufferData(gl.ARRAY_BUFFER, this.normal, gl.DYNAMIC_DRAW);
  }
  draw(mode, buffer, count) {
    const {gl} = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.drawElements(mode, count, gl.UNSIGNED_INT, 0);
  }
  drawFaces() {
    this.draw(this.gl.TRIANGLES, this.faces, this.triangles.length);
  }
  drawLines() { this.draw(this.gl.LINES, this.lines, this.lineCount); }
}

// Chooses a resolution at which frames keep up with the screen: pixels of the
// picture per pixel of the screen. Without a graphics card the time of a frame
// is proportional to its pixels.
class Pace {
  constructor() {
    this.level = 0, this.patience = 4000;  // [ms] before it is sharper again
    this.begin(0);
  }
  static levels = [1, 0.8, 0.6];
  get sharpness() { return this.moving ? Pace.levels[this.level] : 1; }
  begin(now) { this.from = now, this.count = 0; }

  // A frame at a time [ms]; one that does not move is drawn sharp.
  // @return whether the picture must be drawn again
  frame(now, moving) {
    const turned = moving !== this.moving;
    if (turned || now - this.last > 500) this.begin(now);
    this.moving = moving, this.last = now;
    if (turned || !moving) return turned && this.level > 0;
    const passed = now - this.from, mean = passed / ++this.count;
    if (passed > 700 && mean > 19 && this.level + 1 < Pace.levels.length) {
      if (this.sharper) this.patience *= 4;  // it was sharp too briefly
      ++this.level, this.sharper = false, this.begin(now);
    } else if (passed > this.patience) {
      this.sharper = this.level > 0 && mean < 17.5;
      if (this.sharper) --this.level;
      this.begin(now);
    }
    return false;
  }
}

class View {
  // Throws if there is no WebGL 2.
  constructor(canvas) {
    const gl = canvas.getContext('webgl2',
      {alpha: false, antialias: !View.isSoftware()});
    if (!gl) throw new Error('no WebGL 2');
    this.gl = gl, this.canvas = canvas, this.camera = new Camera();
    this.pace = new Pace();
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertexShader],
      [gl.FRAGMENT_SHADER, fragmentShader]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source), gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
        throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program), gl.useProgram(program);
    this.at = new Proxy({}, {get: (known, name) =>
      known[name] ??= gl.getUniformLocation(program, name)});
    this.ball = new Shape(gl);
    const [points, triangles] = ballMesh();
    this.ball.setMesh(triangles, new Uint32Array());
    this.ball.setPoints(points);
    this.floor = new Shape(gl);
    this.floor.setMesh(new Uint32Array([0, 1, 2, 1, 3, 2]), new Uint32Array());
    this.floor.setPoints(new Float32Array(
      [-1, -1, 0, 0, 1, -1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0]));
    this.cloths = [0, 1, 2, 3].map(() => new Shape(gl));
    this.ghost = new Shape(gl);  // drawn through what it has been since
    this.marks = new Shape(gl);
    this.marks.setMesh(new Uint32Array(), new Uint32Array());
    this.obstacles = [];
  }

  // Does the processor draw? Smooth edges would take half of its time.
  static isSoftware() {
    const gl = document.createElement('canvas').getContext('webgl2');
    const names = gl && gl.getExtension('WEBGL_debug_renderer_info');
    return !!names && /swiftshader|llvmpipe|software/i.test(
      gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
  }

  // Set the points of a side, and its mesh if that is new.
  setSide(k, {points, triangles, lines}, isNew = true) {
    if (isNew) this.cloths[k].setMesh(triangles, lines);
    this.cloths[k].setPoints(points);
  }

  // Fit the picture to the canvas.  @return its panes, one a cloth:
  // [x, y, width, height] in pixels of the canvas, y up
  panes(count) {
    const {canvas} = this;
    const ratio = this.pace.sharpness *
      Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = this.size ?? // of a canvas that is in no page
      [canvas.clientWidth, canvas.clientHeight].map(
      a => Math.max(1, Math.round(a * ratio)));
    if (canvas.width !== w || canvas.height !== h)
      canvas.width = w, canvas.height = h;
    const [columns, rows] = View.grid(count);
    return [...Array(count).keys()].map(k => [
      Math.floor(w / columns) * (k % columns),
      Math.floor(h / rows) * (rows - 1 - Math.floor(k / columns)),
      Math.floor(w / columns), Math.floor(h / rows)]);
  }
  // Two beside each other, four in two rows: [columns, rows]
  static grid(count) { return [count > 1 ? 2 : 1, count > 2 ? 2 : 1]; }

  set(color, kind, stretched = color) {
    const {gl, at} = this;
    gl.uniform4fv(at.color, color), gl.uniform4fv(at.stretched, stretched);
    gl.uniform1i(at.kind, kind);
  }
  place(at, scale) {
    this.gl.uniform3fv(this.at.at, at), this.gl.uniform1f(this.at.scale, scale);
  }
  drawMarks(points, size, color, kind) {
    const {gl} = this;
    if (!points.length) return;
    this.marks.setPoints(new Float32Array(points.flatMap(p => [...p, 0])));
    gl.bindVertexArray(this.marks.array);
    gl.uniform1f(this.at.size, size), this.set(color, kind);
    gl.drawArrays(gl.POINTS, 0, points.length);
  }

  // Draw all sides, in the colors of a theme.
  draw(sides, theme, hand) {
    const {gl, camera} = this;
    const panes = this.panes(sides.length);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...theme.sky);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST), gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const ratio = this.canvas.width / (this.canvas.clientWidth ||
      this.canvas.width);
    sides.forEach((side, k) => {
      const pane = panes[k];
      gl.viewport(...pane);
      const frame = camera.frame(pane[2] / pane[3]);
      gl.uniformMatrix4fv(this.at.view, false, camera.matrix(frame));
      gl.uniform3fv(this.at.eye, frame.eye);
      for (const o of this.obstacles) {
        if (o.kind === 'floor') continue;
        this.place(o.at, 0.985 * o.radius);
        this.set(theme.ball, 1);
        this.ball.drawFaces();
      }
      this.place([0, 0, 0], 1);
      const cloth = this.cloths[k];
      gl.enable(gl.POLYGON_OFFSET_FILL), gl.polygonOffset(1, 2);
      this.set(theme.cloth[k], 1, theme.stretched);
      cloth.drawFaces();
      gl.disable(gl.POLYGON_OFFSET_FILL);
      const bare = !cloth.triangles.length;  // a chain
      const [r, g, b, opacity] = bare ? theme.pin
        : theme.wire;  // a line is a pixel wide
      this.set([r, g, b, opacity * this.pace.sharpness], 0), cloth.drawLines();
      if (side.hasGhost) {
        gl.depthMask(false);
        this.set([...theme.pin.slice(0, 3), 0.1], 0), this.ghost.drawFaces();
        this.set([...theme.pin.slice(0, 3), 0.2], 0), this.ghost.drawLines();
        gl.depthMask(true);
      }
      const at = i => [...side.points.subarray(4 * i, 4 * i + 3)];
      const marked = bare ? [...side.points.keys()].slice(0,
        side.points.length / 4) : [...side.pins];
      this.drawMarks(marked.map(at), (bare ? 16 : 9) * ratio, theme.pin, 2);
      const floor = this.obstacles.find(o => o.kind === 'floor');
      if (floor) {
        const far = 3 * camera.radius;
        gl.uniform3f(this.at.fog, camera.center[0], camera.center[1], far);
        this.place([camera.center[0], camera.center[1], floor.at[2] - 0.004],
          far);
        this.set(theme.floor, 4), this.floor.drawFaces();
        this.place([0, 0, 0], 1);
      }
      gl.disable(gl.DEPTH_TEST);
      if (hand) {
        this.drawMarks([hand.target], 14 * ratio, theme.hand, 3);
        this.drawMarks([at(hand.node)], 10 * ratio, theme.hand, 2);
      }
      if (side.failedNode >= 0)
        this.drawMarks([at(side.failedNode)], 56 * ratio, theme.bad, 3);
      gl.enable(gl.DEPTH_TEST);
    });
  }
}
