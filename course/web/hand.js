'use strict';
// Mouse, fingers and keys over the picture: they grab, cut, pin and turn.

class Hand {
  // @param page a Picture
  constructor(page, canvas) {
    this.page = page, this.canvas = canvas;
    this.pointers = new Map();
    this.grabbed = null;   // {node, at, target}: at as it was grabbed
    this.moved = false;    // the target, since it was last told
    this.cross = [0, 0];   // of the keyboard, in pane 0, each -1 to 1
    const beside = what => canvas.parentElement.querySelector(what);
    this.line = beside('.stroke polyline');
    const on = (name, use) => canvas.addEventListener(name, use);
    on('pointerdown', e => this.down(e));
    on('pointermove', e => this.move(e));
    on('pointerup', e => this.up(e)), on('pointercancel', e => this.up(e));
    on('contextmenu', e => e.preventDefault());
    on('wheel', e => {
      e.preventDefault();
      page.view.camera.zoomBy(Math.exp(-0.0012 * e.deltaY)), page.changed();
    });
    on('keydown', e => this.key(e));
    const cross = beside('.cross');
    on('focus', () => cross.hidden = !canvas.matches(':focus-visible'));
    on('blur', () => cross.hidden = true);
  }

  // The pane under (x, y) of the window [CSS pixels]: its number, its camera's
  // frame, and the place in it, from -1 to 1.
  locate(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const [columns, rows] = View.grid(this.page.sides.length);
    const width = box.width / columns, height = box.height / rows;
    const at = (a, count) => Math.max(0, Math.min(count - 1, Math.floor(a)));
    const column = at((x - box.left) / width, columns);
    const row = at((y - box.top) / height, rows);
    return {pane: row * columns + column,
      frame: this.page.view.camera.frame(width / height),
      x: 2 * (x - box.left - column * width) / width - 1,
      y: 1 - 2 * (y - box.top - row * height) / height,
      half: [width / 2, height / 2]};
  }
  rayAt(place) {
    return this.page.view.camera.ray(place.frame, place.x, place.y).flat()
      .map(rounded);
  }

  // The node nearest to a place of the screen, within some pixels; or -1.
  nodeAt(place, reach) {
    const side = this.page.sides[place.pane];
    if (!side) return -1;
    const {camera} = this.page.view;
    let best = -1, least = reach * reach, seen = new Uint8Array(
      side.points.length / 4);
    for (const i of side.lines) {
      if (seen[i]) continue;
      seen[i] = 1;
      const p = side.points.subarray(4 * i, 4 * i + 3);
      const [x, y, depth] = camera.place(place.frame, p);
      const dx = (x - place.x) * place.half[0],
        dy = (y - place.y) * place.half[1];
      // In front counts for some pixels.
      const far = 12 * (depth - place.frame.distance) / camera.radius;
      const score = dx * dx + dy * dy;
      if (score < reach * reach && score + far < least)
        best = i, least = score + far;
    }
    return best;
  }

  grab(node, place) {
    const side = this.page.sides[place.pane];
    const at = [...side.points.subarray(4 * node, 4 * node + 3)];
    this.grabbed = {node, at, target: at.map(rounded)};
    this.page.ask('grab', node, ...this.grabbed.target);
  }
  pullTo(place) {
    const {grabbed} = this;
    grabbed.target = this.page.view.camera.pointBeside(place.frame, grabbed.at,
      place.x, place.y).map(rounded);
    this.moved = true, this.page.changed();
  }
  // Before each frame: where the hand is now.
  tell() {
    if (this.grabbed && this.moved)
      this.page.ask('move', ...this.grabbed.target);
    this.moved = false;
  }
  release() {
    if (!this.grabbed) return;
    this.tell(), this.grabbed = null, this.page.ask('release');
  }

  down(e) {
    this.canvas.setPointerCapture(e.pointerId);
    const place = this.locate(e.clientX, e.clientY);
    const pointer = {x: e.clientX, y: e.clientY, what: 'turn'};
    this.pointers.set(e.pointerId, pointer);
    if (this.pointers.size > 1) {  // two fingers: turn and zoom
      this.release(), this.line.setAttribute('points', '');
      for (const p of this.pointers.values()) p.what = 'turn';
      return;
    }
    const tool = e.button === 2 || e.shiftKey ? 'cut'
      : e.ctrlKey || e.metaKey ? 'pin' : this.page.tool;
    const reach = e.pointerType === 'touch' ? 34 : 22;
    const node = this.nodeAt(place, reach);
    if (tool === 'cut') {
      pointer.what = 'cut', pointer.ray = this.rayAt(place);
      pointer.pane = place.pane, pointer.trail = [];
      this.mark(pointer, e);
    } else if (tool === 'pin' && node >= 0) {
      pointer.what = 'none', this.page.ask('toggle', node);
    } else if (tool === 'grab' && node >= 0) {
      pointer.what = 'grab', this.grab(node, place);
    }
  }
  mark(pointer, e) {
    const box = this.canvas.getBoundingClientRect();
    pointer.trail.push(`${e.clientX - box.left},${e.clientY - box.top}`);
    this.line.setAttribute('points', pointer.trail.slice(-60).join(' '));
  }
  move(e) {
    const pointer = this.pointers.get(e.pointerId);
    if (!pointer) return;
    const {camera} = this.page.view;
    const dx = e.clientX - pointer.x, dy = e.clientY - pointer.y;
    if (this.pointers.size > 1) {
      const gap = () => {
        const [a, b] = [...this.pointers.values()];
        return Math.hypot(a.x - b.x, a.y - b.y) || 1;
      };
      const before = gap();
      pointer.x = e.clientX, pointer.y = e.clientY;
      camera.zoomBy(gap() / before);
      camera.turn(dx * 0.004, dy * 0.004);
      return this.page.changed();
    }
    const place = this.locate(e.clientX, e.clientY);
    if (pointer.what === 'grab') this.pullTo(place);
    if (pointer.what === 'cut' && Math.hypot(dx, dy) >= 4) {
      if (place.pane === pointer.pane) {
        const ray = this.rayAt(place);
        this.page.ask('stroke', ...pointer.ray, ...ray);
        pointer.ray = ray;
      }
      this.mark(pointer, e);
    }
    if (pointer.what === 'turn')
      camera.turn(dx * 0.008, dy * 0.008), this.page.changed();
    if (pointer.what !== 'cut' || Math.hypot(dx, dy) >= 4)
      pointer.x = e.clientX, pointer.y = e.clientY;
  }
  up(e) {
    const pointer = this.pointers.get(e.pointerId);
    this.pointers.delete(e.pointerId);
    if (!pointer) return;
    if (pointer.what === 'grab') this.release();
    this.line.setAttribute('points', '');
  }

  // The place of the cross, which stays in the middle of pane 0.
  crossPlace() {
    const box = this.canvas.getBoundingClientRect();
    const [columns, rows] = View.grid(this.page.sides.length);
    return this.locate(box.left + box.width / columns / 2,
      box.top + box.height / rows / 2);
  }
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const {camera} = this.page.view;
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1],
      ArrowDown: [0, -1]};
    const place = this.crossPlace(), name = e.key.toLowerCase();
    if (arrows[e.key] && this.grabbed) {
      const [right, up] = arrows[e.key], g = this.grabbed;
      const way = 0.06 * camera.radius;
      g.target = Vec.add(Vec.add(g.target, place.frame.right, way * right),
        place.frame.up, way * up).map(rounded);
      this.moved = true;
    } else if (arrows[e.key]) {
      camera.turn(-0.12 * arrows[e.key][0], 0.12 * arrows[e.key][1]);
    } else if (name === '+' || name === '=') {
      camera.zoomBy(1.15);
    } else if (name === '-') {
      camera.zoomBy(1 / 1.15);
    } else if (name === 'g') {
      const node = this.nodeAt(place, 1e4);
      if (this.grabbed) this.release();
      else if (node >= 0) this.grab(node, place);
    } else if (name === 'p') {
      const node = this.nodeAt(place, 1e4);
      if (node >= 0) this.page.ask('toggle', node);
    } else if (name === 'x') {
      // A stroke across the steepest edge of the node next to the cross.
      const node = this.nodeAt(place, 1e4);
      if (node < 0) return;
      const {lines, points} = this.page.sides[0];
      const seen = i =>
        camera.place(place.frame, points.subarray(4 * i, 4 * i + 3));
      const [x, y] = seen(node);
      let rise = 0;
      lines.forEach((end, k) => {
        const dy = end === node ? seen(lines[k ^ 1])[1] - y : 0;
        if (Math.abs(dy) > Math.abs(rise)) rise = dy;
      });
      const ends = [-1, 1].map(k =>
        this.rayAt({...place, x: x + 0.3 * k, y: y + 0.4 * rise}));
      this.page.ask('stroke', ...ends[0], ...ends[1]);
    } else {
      return;
    }
    e.preventDefault(), this.page.changed();
  }
}

// A length [m], rounded as a link stores it; 0 in place of -0.
const rounded = a => Number(a.toFixed(4)) + 0;
