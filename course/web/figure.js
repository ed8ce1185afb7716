'use strict';
// A cloth in an element of a page, or several on one clock: README.md

const stages = {
  problem1: {title: '3.2 problem1', low: -1.25},
  diagonals: {title: '4.2 diagonals', low: -1.2},
  forces: {title: '5.2 forces', low: -1.2},
  constraints: {title: '6.2 constraints', low: -0.75, ball: true},
  tear: {title: '7.2 tear', low: -0.75, ball: true},
};
const patience = 10;  // [s], of a step that may never end

const markup = `<div class="picture">
    <canvas tabindex="0" role="application" aria-roledescription="cloth"
      aria-label="The cloth: G grabs, X cuts, arrows turn and pull"></canvas>
    <svg class="stroke" aria-hidden="true"><polyline/></svg>
    <div class="cross" aria-hidden="true" hidden></div>
    <div class="name" hidden><span></span><small></small></div>
    <div class="name" hidden><span></span><small></small></div>
    <div class="busy"></div>
    <div class="strain">strain 2 % <i></i> 45 %</div>
  </div>
  <p class="fault" role="alert" hidden></p>
  <p class="says" role="status" hidden></p>
  <div class="tools" role="toolbar" aria-label="Run and tools">
    <span class="switch" role="group" aria-label="Which code runs"></span>
    <button class="main play">Play</button>
    <button class="restart">Restart</button>
    <button class="cut" aria-pressed="false"
      title="Cut with a stroke (or Shift and drag)">Cut</button>
  </div>`;

// One cloth: the thread that computes it, and what it showed last.
class Cloth {
  constructor(figure, name) {
    this.figure = figure, this.name = name, this.run = 0;
  }
  async start(setting) {
    this.failure = this.note = '', this.readings = null, this.waiting = 1;
    this.ready = false, this.ticks = 0;
    const number = ++this.run;
    if (!this.worker) this.open();
    const bytes = await moduleOf(this.name);
    if (number === this.run)
      this.worker.postMessage(['start', {...setting, bytes, number}]);
  }
  open() {
    this.worker = startThread(workerSource, this, this,
      text => this.error({text}));
  }
  close() {
    this.worker?.terminate(), this.worker = null, ++this.run;
  }
  post(...message) { this.worker?.postMessage(message); }
  askFor(time) { this.waiting = 1, this.ticks = 0, this.post('frame', time); }
  // Each second, while the page waits for it.
  second() {
    if (!this.waiting || ++this.ticks < patience) return;
    this.close(), this.waiting = 0;
    this.failure = `one step takes more than ${patience} s: a loop in the ` +
      'code seems to have no end';
    this.figure.took(this);
  }
  get time() { return this.readings?.time ?? 0; }

  started({stages: count}) { this.stages = count, this.ready = true; }
  frame({failure, readings, points, mesh}) {
    this.waiting = 0, this.failure = failure;
    this.readings = readings || this.readings;
    // A cloth that explodes is drawn while it is near.
    const near = failure || this.readings.gainAt >= 0 ? 2.5 : 20;  // [m]
    const drawn = points && points.every((a, k) => k % 4 === 3 || a < near &&
      a > -near);
    if (mesh) this.side = {...this.side, ...mesh}, this.isNew = true;
    if (drawn) this.side = {...this.side, points};
    this.figure.took(this);
  }
  uncut() {
    this.note = 'remove_edge() did not remove the edge (7.1)';
    this.figure.took(this);
  }
  positions(data) { this.all = data; }
  error({text}) {
    this.waiting = 0, this.failure = text, console.error(text);
    this.figure.took(this);
  }
}

class Figure extends Picture {
  constructor(element, options) {
    super();
    Object.assign(this, {stage: 'problem1', grid: 25, chain: 0, dt: 0.001,
      speed: 1, end: Infinity, wasm: [], beside: false, whole: false,
      times: [], says: []}, options);
    this.names ??= this.wasm;
    this.element = element, this.clock = 0, this.panes = [];
    this.playing = false;
    const still = document.createElement('div');
    still.className = 'still', still.append(...element.childNodes);
    element.innerHTML = markup, element.append(still);
    element.classList.add('look', 'figure');
    this.canvas = this.find('canvas');
    this.cloths = this.wasm.map(name => new Cloth(this, name));
    this.choice = this.cloths.length - 1;
    this.makeTools();
    new IntersectionObserver(([entry]) => this.see(entry.isIntersecting),
      {threshold: 0.25}).observe(this.find('.picture'));
  }
  find(what) { return this.element.querySelector(what); }
  on(what, use) { this.find(what).onclick = () => use.call(this); }

  // It starts when it is first seen, and runs only while it is seen.
  see(isSeen) {
    this.seen = isSeen, this.last = undefined;
    if (!isSeen) return;
    if (!this.view) this.begin();
    else this.loop();
  }
  begin() {
    try {
      this.open(this.canvas, this.element);
    } catch {
      this.element.classList.add('cannot');
      return;
    }
    this.view.camera.set(-0.93, 0.32, 1);  // as the stills
    if (!this.whole) this.letScroll();
    this.canvas.addEventListener('webglcontextlost', e => e.preventDefault());
    this.canvas.addEventListener('webglcontextrestored', () => {
      const {camera, obstacles} = this.view;
      this.view = Object.assign(new View(this.canvas), {camera, obstacles});
      this.show(this.choice), this.changed();
    });
    setInterval(() => this.cloths.forEach(c => c.second()), 1000);
    this.start(), this.play(!isStill());
    this.loop();
  }
  // A finger beside the cloth, and the wheel, scroll the page.
  letScroll() {
    this.canvas.style.touchAction = 'pan-y';
    this.canvas.addEventListener('touchstart', e => {
      const {clientX, clientY} = e.touches[0];
      const place = this.hand.locate(clientX, clientY);
      if (this.hand.tool === 'cut' || this.hand.nodeAt(place, 34) >= 0)
        e.preventDefault();
    }, {passive: false});
    this.canvas.addEventListener('wheel', e => {
      if (!e.ctrlKey) e.stopImmediatePropagation();
    }, {capture: true});
  }

  makeTools() {
    this.on('.play', () => this.ended ? this.restart()
      : this.play(!this.playing));
    this.on('.restart', this.restart);
    this.on('.cut', () => this.cutOrGrab());
    if (this.cloths.length > 1)
      this.find('.switch').append(...this.names.map((name, k) => {
        const button = document.createElement('button');
        button.textContent = name, button.onclick = () => this.show(k);
        return button;
      }));
    this.show(this.choice);
  }
  cutOrGrab() {
    const tool = this.hand.tool === 'cut' ? 'grab' : 'cut';
    this.hand.tool = this.canvas.dataset.tool = tool;
    this.find('.cut').setAttribute('aria-pressed', tool === 'cut');
  }
  // Show a cloth; with `beside`, next to the first one.
  show(k) {
    this.choice = k;
    this.panes = this.beside && k > 0 ? [0, k] : [k];
    for (const c of this.cloths) c.isNew = true;
    [...this.find('.switch').children].forEach(
      (button, i) => button.setAttribute('aria-pressed', i === k));
    this.find('.picture').classList.toggle('two', this.panes.length > 1);
    const words = this.says[k] ?? '', {end} = this;
    [this.speed, this.end] = this.times[k] ?? [this.speed, end];
    setText(this.find('.says'), words), this.find('.says').hidden = !words;
    if (this.view && this.end !== end)
      this.start(), this.play(this.playing || !isStill());
    this.arrange();
  }
  play(on) {
    this.playing = on, this.last = undefined;
    setText(this.find('.play'), on ? 'Pause' : 'Play');
  }
  restart() { this.start(), this.play(true); }
  oneStep() { this.play(false), this.stepping = this.wanted = true; }

  start() {
    const {stage, grid: side, dt, chain, end} = this, {ball} = stages[stage];
    // A short fall is seen from nearer: g t^2/2.
    const low = Math.max(stages[stage].low, -0.3 - 5 * end * end);
    this.hand?.release();
    this.clock = 0, this.ended = 0, this.touched = false;
    for (const c of this.cloths)
      c.start({stage: Object.keys(stages).indexOf(stage), side, dt, chain});
    this.view.obstacles = !ball ? [] : [
      {kind: 'floor', at: [0.5, 0.5, -0.75]},
      {kind: 'ball', at: [0.5, 0.5, -0.5], radius: 0.15}];
    const box = [];
    for (const x of chain ? [-0.5, 0.5] : [-0.05, 1.05])
      for (const y of [-0.1, ball ? 1 : 0.8])
        for (const z of [low, 0]) box.push([x, y, z]);
    this.view.camera.lookAt(box);
  }
  setStep(dt) {
    this.dt = dt;
    for (const c of this.cloths) c.post('ask', `set_step ${dt}`);
  }

  // ---------------------------------------------------------- What Hand needs
  ask(name, ...values) {
    if (name === 'toggle') return;
    this.touched = true;
    for (const c of this.cloths) {
      const list = name === 'stroke' ? this.crossed(c, values) : values;
      const line = [name === 'stroke' ? 'cut' : name, ...list].join(' ');
      if (name !== 'stroke' || list.length) c.note = '', c.post('ask', line);
    }
    this.wanted = true;
  }
  // The ends of the edges of a cloth that a stroke from one line of sight to
  // another one crosses in the picture.
  crossed({side}, rays) {
    if (!side) return [];
    const {camera} = this.view, frame = camera.frame(1);
    const seen = p => camera.place(frame, p);
    const a = seen(rays.slice(0, 3)), b = seen(rays.slice(6, 9));
    const turn = (p, q, r) =>
      (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0;
    const {points, lines} = side, ends = [];
    for (let k = 0; k < lines.length; k += 2) {
      const [p, q] = [lines[k], lines[k + 1]].map(
        i => seen(points.subarray(4 * i, 4 * i + 3)));
      if (turn(a, b, p) !== turn(a, b, q) && turn(p, q, a) !== turn(p, q, b))
        ends.push(lines[k], lines[k + 1]);
    }
    return ends;
  }

  // ------------------------------------------------------------------ Frames
  took(cloth) {
    this.arrange(), this.changed();
    this.onframe?.(cloth);
  }
  // Put the chosen cloths into the panes.
  arrange() {
    const cloths = this.panes.map(k => this.cloths[k]);
    if (!this.view || cloths.some(c => !c.side?.points)) return;
    this.sides = cloths.map((c, pane) => {
      this.view.setSide(pane, c.side, c.isNew || c.pane !== pane);
      c.isNew = false, c.pane = pane;
      return {...c.side, failedNode: c.failure && c.readings
        ? c.readings.failedNode : -1};
    });
    const labels = this.element.querySelectorAll('.name');
    labels.forEach((label, pane) => {
      const c = cloths[pane], gain = c?.readings?.gainAt ?? -1;
      label.hidden = !c || this.cloths.length < 2;
      if (label.hidden) return;
      setText(label.children[0], this.names[this.panes[pane]]);
      setText(label.children[1], gain < 0 ? ''
        : `diverged at ${Number(gain.toFixed(4))} s: energy from nothing`);
    });
    const shown = cloths.at(-1), fault = this.find('.fault');
    const words = shown.failure || shown.note;
    fault.hidden = !words || !this.whole && shown.readings?.gainAt >= 0;
    setText(fault, words);
    const slower = shortNumber(Number((1 / this.speed).toPrecision(2)));
    const time = Math.max(...cloths.map(c => c.time));
    setText(this.find('.busy'), `t = ${time.toFixed(3)} s` +
      (this.speed < 1 && !this.whole ? `, ${slower} times slower` : ''));
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
    const runs = this.cloths.filter(c => !c.failure);
    if (!this.cloths.some(c => c.waiting)) this.advance(now, runs);
    this.wanted ||= this.hand.moved;
    this.paint(now, this.playing && runs.length > 0);
  }
  advance(now, runs) {
    const passed = this.passed(now);
    if (this.playing && (!runs.length || this.clock >= this.end))
      return this.atEnd(now);
    if (!this.playing && !this.wanted) return;
    this.hand.tell();
    // One clock: that of the slowest.
    const reached = Math.min(...runs.map(c => c.time));
    if (this.playing)
      this.clock = Math.min(this.clock, reached + 2 * this.dt) +
        passed * this.speed;
    if (this.stepping) this.clock = reached + this.dt;
    this.wanted = this.stepping = false;
    for (const c of runs) c.askFor(this.clock - this.dt / 2);
  }
  // A figure that nobody has touched runs again after a while.
  atEnd(now) {
    this.ended ||= now;
    if (this.whole || this.touched || isStill()) this.play(false);
    else if (now - this.ended > 1500) this.start();
  }
}

// ------------------------------------------------------------------- Modules

// Where this file is, and so NAME.js, each of which calls figure.add().
const folder = (document.currentScript?.src || '').replace(/[^/]*$/, '');
const packed = {}, asked = {};

async function moduleOf(name) {
  asked[name] ??= packed[name] ? Promise.resolve() : new Promise(
    (done, fail) => {
      const script = document.createElement('script');
      script.src = `${folder}${name}.js`;
      script.onload = done, script.onerror = () => fail(new Error(script.src));
      document.head.append(script);
    });
  await asked[name];
  const {text, base} = packed[name];
  const bytes = await unpacked(text);
  if (!base) return bytes;
  // web.py: the parts that it has from its base, by place, and its own.
  const from = await moduleOf(base);
  return new Blob(JSON.parse(new TextDecoder().decode(bytes)).map(part =>
    typeof part === 'string' ? bytesOf(part) : from.slice(...part)))
    .arrayBuffer();
}

// Make a figure in an element; README.md lists the options.
function figure(element, options) {
  if (!document.getElementById('look')) {
    const style = document.createElement('style');
    style.id = 'look', style.textContent = look;
    document.head.append(style);
  }
  return new Figure(element, options);
}
Object.assign(figure, {Plot, shortNumber, stages, byPower, showSlider,
  makeSlider, onKeys, fillTable, drawEnergy,
  add(name, text, base) { packed[name] = {text, base}; }});
self.figure = figure;
