'use strict';
// What each page has: a picture of cloths, the thread that computes them,
// sliders, keys and a table of numbers.

// The picture: its camera, its hand, and when it is drawn again. What is made
// of it gives `sides`, what to draw, and ask(...words), requests of the hand.
class Picture {
  constructor() { this.sides = [], this.dirty = true; }

  // Draw into a canvas, with the colors of an element.  Throws if the browser
  // has no WebGL 2 or no WebAssembly.
  open(canvas, element) {
    this.view = new View(canvas);
    if (!self.WebAssembly || !self.DecompressionStream)
      throw new Error('no WebAssembly');
    this.hand = new Hand(this, canvas);
    const color = () => {
      Object.assign(this, looksOf(element)), this.changed();
    };
    color();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change',
      color);
    new ResizeObserver(() => this.changed()).observe(canvas);
  }
  changed() { this.dirty = true; }
  // Seconds since the last call, or since `last` was cleared; at most 0.05.
  passed(now) {
    const seconds = Math.min(0.05, (now - (this.last ?? now)) / 1e3);
    this.last = now;
    return seconds;
  }
  sidesAt() { return this.sides; }
  // Draw, if something has changed.  @return whether it did
  paint(now, moving) {
    this.dirty = this.view.pace.frame(now, moving) || this.dirty;
    if (!this.dirty || !this.sides.length) return false;
    this.dirty = false;
    this.view.draw(this.sidesAt(now), this.theme, this.hand.grabbed);
    return true;
  }
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
// @param use called with each new value
function makeSlider(input, slider, use, step = 1) {
  Object.assign(input, {min: 0, max: 1000, step});
  input.oninput = () => {
    const value = slider.value(Number(input.value) / 1000);
    use(value), tellValue(input, slider.show(value));
  };
}

// Space, N and R: actions by key, unless a control needs the key.
function onKeys(actions) {
  addEventListener('keydown', e => {
    if (e.target.matches('select, input') || e.ctrlKey || e.metaKey) return;
    const action = actions[e.key.toLowerCase()];
    if (!action || (e.key === ' ' && e.target.matches('button'))) return;
    e.preventDefault(), action();
  });
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
