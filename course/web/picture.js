'use strict';
// What each page and figure has: a picture of cloths, the thread that computes
// them, sliders and a table of numbers.

// What each button does.
const buttons = {
  play: 'Play or pause (space)', step: 'One step (N)',
  restart: 'From the start (R)', grab: 'Drag the cloth; beside it: turn',
  cut: 'Cut with a stroke (or Shift and drag)',
  pin: 'Pin a node, or let go of it (or Ctrl and click)',
  turn: 'Turn; two fingers or the wheel zoom',
};
const markup = `<div class="picture">
    <canvas tabindex="0" role="application" aria-roledescription="cloth"
      aria-label="The cloth: G grabs, X cuts, arrows turn and pull"></canvas>
    <svg class="stroke" aria-hidden="true"><polyline/></svg>
    <div class="cross" aria-hidden="true" hidden></div>
    ${'<div class="name" hidden><span></span><small></small></div>'.repeat(4)}
    <div class="busy"></div>
    <div class="strain"><span>strain 2 %</span> <i></i>
      <span>45 %</span></div>
  </div>
  <section class="fault" aria-label="What happened" hidden>
    <p role="alert"><b></b> <span></span></p></section>
  <p class="says" role="status" hidden></p>
  <div class="tools" role="toolbar" aria-label="Run and tools">
    <span class="switch" role="group" aria-label="Which code runs"></span>
  </div>`;

// A picture of cloths in an element: its camera, its hand, its buttons, and
// when it is computed and drawn. What is derived from it has ready(), called
// once it is seen; ask(...words), requests of the hand; start(); isRunning,
// isWaiting, and askFrames(seconds).
class Picture {
  // @param names of its buttons   @param whole it is a page: it has all keys,
  // fingers and the wheel
  constructor(element, names, whole) {
    Object.assign(this, {element, whole, sides: [], dirty: true, numbersAt: 0,
      playing: false, wanted: true});
    const still = document.createElement('div');
    still.className = 'still', still.append(...element.childNodes);
    element.innerHTML = markup, element.append(still);
    element.classList.add('look', 'figure');
    this.canvas = this.find('canvas');
    for (const name of names) this.makeButton(name);
    new IntersectionObserver(([entry]) => this.see(entry.isIntersecting),
      {threshold: 0.25}).observe(this.find('.picture'));
    if (whole) this.listen();
  }
  find(what) { return this.element.querySelector(what); }
  makeButton(name) {
    const button = document.createElement('button');
    const isTool = Object.keys(buttons).indexOf(name) > 2;
    button.textContent = name[0].toUpperCase() + name.slice(1);
    button.title = buttons[name], button.className = name;
    if (isTool) button.dataset.tool = name, button.ariaPressed = false;
    button.onclick = () => isTool
      ? this.use(this.tool === name ? 'grab' : name) : this[name]();
    this.find('.tools').append(button);
  }
  play() { this.setPlaying(!this.playing); }
  step() { this.setPlaying(false), this.stepping = this.wanted = true; }
  restart() { this.start(), this.setPlaying(true); }
  setPlaying(on) {
    this.playing = on, this.last = undefined;
    setText(this.find('.play'), on ? 'Pause' : 'Play');
  }
  get tool() { return this.canvas.dataset.tool ?? 'grab'; }
  use(tool) {
    this.canvas.dataset.tool = tool;
    for (const button of this.element.querySelectorAll('button[data-tool]'))
      button.ariaPressed = button.dataset.tool === tool;
  }
  // Space plays, N steps, R restarts, unless a control needs the key.
  listen() {
    const keys = {' ': '.play', n: '.step', r: '.restart'};
    addEventListener('keydown', e => {
      if (e.target.matches('select, input') || e.ctrlKey || e.metaKey) return;
      const button = keys[e.key.toLowerCase()];
      if (!button || (e.key === ' ' && e.target.matches('button'))) return;
      e.preventDefault(), this.find(button).click();
    });
  }

  // It starts when it is first seen, and runs only while it is seen.
  see(isSeen) {
    this.seen = isSeen, this.last = undefined;
    if (isSeen && (this.view || this.open())) this.loop();
  }
  // @return whether the browser can draw and compute it
  open() {
    try {
      this.view = new View(this.canvas);
      if (!self.WebAssembly || !self.DecompressionStream)
        throw new Error('no WebAssembly');
    } catch {
      this.element.classList.add('cannot');
      return false;
    }
    this.hand = new Hand(this, this.canvas);
    const color = () => {
      Object.assign(this, looksOf(this.element)), this.changed();
    };
    color();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change',
      color);
    new ResizeObserver(() => this.changed()).observe(this.canvas);
    if (!this.whole) this.letScroll();
    this.canvas.addEventListener('webglcontextlost', e => e.preventDefault());
    this.canvas.addEventListener('webglcontextrestored', () => {
      const {camera, obstacles} = this.view;
      this.view = Object.assign(new View(this.canvas), {camera, obstacles});
      this.show(this.sides.map(side => ({...side, isNew: true})));
    });
    this.ready();
    return true;
  }
  // A finger beside the cloth, and the wheel, scroll the page.
  letScroll() {
    this.canvas.style.touchAction = 'pan-y';
    this.canvas.addEventListener('touchstart', e => {
      const {clientX, clientY} = e.touches[0];
      const place = this.hand.locate(clientX, clientY);
      if (this.tool === 'cut' || this.hand.nodeAt(place, 34) >= 0)
        e.preventDefault();
    }, {passive: false});
    this.canvas.addEventListener('wheel', e => {
      if (!e.ctrlKey) e.stopImmediatePropagation();
    }, {capture: true});
  }

  changed() { this.dirty = true; }
  // Show these, one a pane: {points, lines, triangles, pins, failedNode,
  // isNew: whether its mesh is another one, name, words}
  show(sides) {
    this.sides = sides, this.changed();
    sides.forEach((side, k) => this.view.setSide(k, side, side.isNew));
    const {classList} = this.find('.picture');
    classList.toggle('two', sides.length > 1);
    classList.toggle('four', sides.length > 2);
    this.element.querySelectorAll('.name').forEach((label, k) => {
      label.hidden = !sides[k]?.name;
      setText(label.children[0], sides[k]?.name ?? '');
      setText(label.children[1], sides[k]?.words ?? '');
    });
  }
  // Say that the cloth can be dragged, until a hand does anything.
  hint() {
    const hint = document.createElement('p');
    hint.className = 'hint', hint.textContent = 'Drag me';
    hint.ariaHidden = true;
    this.find('.picture').append(hint);
    const end = () => hint.remove();
    for (const name of ['pointerdown', 'keydown'])
      this.element.addEventListener(name, end, {once: true});
  }
  // Words in a place that is hidden without any: '.fault b', '.says', '.busy'.
  say(place, words) {
    setText(this.find(place), words);
    (this.find(place).closest('.fault') ?? this.find(place)).hidden = !words;
  }

  loop() {
    if (this.looping) return;
    this.looping = true;
    const next = now => {
      this.looping = this.seen;
      if (this.seen) requestAnimationFrame(next), this.tick(now);
    };
    requestAnimationFrame(next);
  }
  tick(now) {
    // Seconds since the last frame, or since `last` was cleared.
    const passed = Math.min(0.05, (now - (this.last ?? now)) / 1e3);
    if (!this.isWaiting) {
      this.last = now;
      if (this.isRunning || this.wanted) {
        this.hand.tell(), this.askFrames(passed);
        this.wanted = this.stepping = false;
      }
    }
    this.wanted ||= this.hand.moved;
    this.paint(now, this.isMoving);
  }
  get isMoving() { return this.isRunning; }
  // Draw at a time [ms], if something has changed. While it moves, numbers and
  // curves change four times a second.
  paint(now, moving) {
    this.dirty = this.view.pace.frame(now, moving) || this.dirty;
    if (!this.dirty || !this.sides.length) return;
    this.dirty = false;
    this.view.draw(this.sidesAt(now), this.theme, this.hand.grabbed);
    this.drawn?.();
    if (moving && now - this.numbersAt < 250) return;
    this.numbersAt = now, this.showNumbers?.();
  }
  sidesAt() { return this.sides; }
}

// Start a thread. Its messages are {kind, run?, ...}: replies[kind] gets those
// of the present run, owner.run.
function startThread(source, owner, replies, fail) {
  const blob = new Blob([source], {type: 'text/javascript'});
  // A page opened as a file must not load another file.
  const worker = new Worker(URL.createObjectURL(blob));
  worker.onmessage = ({data}) => {
    if ((data.run ?? owner.run) === owner.run) replies[data.kind](data);
  };
  worker.onerror = e => fail(e.message);
  return worker;
}

const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
// The bytes that `text` has, packed by gzip and base64.
const unpacked = text => new Response(new Blob([bytesOf(text)]).stream()
  .pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();

// A slider has value(place), place(value), places from 0 to 1, and show(value).
const byPower = (low, high, digits = 3) => ({
  value: s => Number((low * (high / low) ** s).toPrecision(digits)),
  place: a => Math.log(a / low) / Math.log(high / low),
});
function tellValue(input, text) {
  setText(input.parentElement.querySelector('output'), text);
  input.setAttribute('aria-valuetext', text);
}
function showSlider(input, slider, value) {
  input.value = Math.round(1000 * slider.place(value));
  tellValue(input, slider.show(value));
}
// Make a label's element, which has `data-slider`, the slider of this id.
// @param use called with each new value
function makeSlider(id, slider, use, step = 1) {
  const label = document.querySelector(`[data-slider=${id}]`);
  label.className = 'slider';
  label.innerHTML = `<span>${label.textContent}</span>
    <input type="range" id="${id}" min="0" max="1000" step="${step}">
    <output></output>`;
  const input = label.querySelector('input');
  input.oninput = () => {
    const value = slider.value(Number(input.value) / 1000);
    use(value), tellValue(input, slider.show(value));
  };
  return input;
}

// Show rows [name, value] in a table; cells that stay are not laid out again.
function fillTable(table, rows) {
  while (table.rows.length > rows.length) table.deleteRow(-1);
  rows.forEach((row, k) => {
    const line = table.rows[k] || table.insertRow();
    row.forEach((text, c) =>
      setText(line.cells[c] || line.insertCell(), String(text)));
  });
}

function drawEnergy(plot, style) {
  const [blue, orange, green, dark] = style.series;
  plot.draw('Energy [J]', [['kinetic', blue], ['elastic', orange],
    ['height', green], ['total', dark]], false, style);
}
