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
    super(element, options.whole ? ['play', 'step', 'restart', 'cut']
      : ['play', 'restart', 'cut'], options.whole);
    Object.assign(this, {stage: 'problem1', grid: 25, chain: 0, dt: 0.001,
      speed: 1, end: Infinity, wasm: [], beside: false, times: [], says: []},
    options);
    this.names ??= this.wasm;
    this.clock = 0, this.panes = [];
    this.cloths = this.wasm.map(name => new Cloth(this, name));
    if (this.cloths.length > 1)
      this.find('.switch').append(...this.names.map((name, k) => {
        const button = document.createElement('button');
        button.textContent = name, button.onclick = () => this.choose(k);
        return button;
      }));
    this.choose(this.cloths.length - 1);
  }
  ready() {
    this.view.camera.set(-0.93, 0.32, 1);  // as the stills
    setInterval(() => this.cloths.forEach(c => c.second()), 1000);
    this.start(), this.setPlaying(!isStill());
  }
  // Show a cloth; with `beside`, next to the first one.
  choose(k) {
    this.choice = k;
    this.panes = this.beside && k > 0 ? [0, k] : [k];
    [...this.find('.switch').children].forEach(
      (button, i) => button.ariaPressed = i === k);
    const {end} = this;
    [this.speed, this.end] = this.times[k] ?? [this.speed, end];
    this.say('.says', this.says[k] ?? '');
    if (this.view && this.end !== end)
      this.start(), this.setPlaying(this.playing || !isStill());
    this.arrange();
  }
  play() { this.ended ? this.restart() : super.play(); }

  start() {
    const {stage, grid: side, dt, chain, end} = this, {ball} = stages[stage];
    // A short fall is seen from nearer: g t^2/2.
    const low = Math.max(stages[stage].low, -0.3 - 5 * end * end);
    this.hand?.release(), this.onstart?.();
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

  ask(name, ...values) {
    if (name === 'toggle') return;
    this.touched = this.wanted = true;
    for (const c of this.cloths)
      c.note = '', c.post('ask', [name, ...values].join(' '));
  }

  // ------------------------------------------------------------------ Frames
  took(cloth) {
    this.arrange();
    this.onframe?.(cloth);
  }
  // Put the chosen cloths into the panes.
  arrange() {
    const cloths = this.panes.map(k => this.cloths[k]);
    if (!this.view || cloths.some(c => !c.side?.points)) return;
    this.show(cloths.map((c, pane) => {
      const isNew = c.isNew || this.sides[pane]?.cloth !== c;
      const gain = c.readings?.gainAt ?? -1;
      c.isNew = false;
      return {...c.side, isNew, cloth: c,
        failedNode: c.failure && c.readings ? c.readings.failedNode : -1,
        name: this.cloths.length > 1 ? this.names[this.panes[pane]] : '',
        words: gain < 0 ? ''
          : `diverged at ${shortNumber(gain)} s: energy from nothing`};
    }));
    const shown = cloths.at(-1);
    this.say('.fault b', this.whole || !(shown.readings?.gainAt >= 0)
      ? shown.failure || shown.note : '');
    const slower = shortNumber(1 / this.speed, 2);
    const time = Math.max(...cloths.map(c => c.time));
    this.say('.busy', `t = ${time.toFixed(3)} s` +
      (this.speed < 1 && !this.whole ? `, ${slower} times slower` : ''));
  }

  get running() { return this.cloths.filter(c => !c.failure); }
  get isWaiting() { return this.cloths.some(c => c.waiting); }
  get isRunning() { return this.playing && this.running.length > 0; }
  tick(now) {
    if (this.playing && !this.isWaiting &&
      (!this.running.length || this.clock >= this.end)) this.atEnd(now);
    super.tick(now);
  }
  askFrames(passed) {
    // One clock: that of the slowest.
    const reached = Math.min(...this.running.map(c => c.time));
    if (this.playing)
      this.clock = Math.min(this.clock, reached + 2 * this.dt) +
        passed * this.speed;
    if (this.stepping) this.clock = reached + this.dt;
    for (const c of this.running) c.askFor(this.clock - this.dt / 2);
  }
  // A figure that nobody has touched runs again after a while.
  atEnd(now) {
    this.ended ||= now;
    if (this.whole || this.touched || isStill()) this.setPlaying(false);
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
  makeSlider, fillTable, drawEnergy,
  add(name, text, base) { packed[name] = {text, base}; }});
self.figure = figure;
