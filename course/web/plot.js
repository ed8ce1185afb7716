'use strict';
// Curves over time in a small canvas.

class Plot {
  constructor(canvas, title) {
    this.canvas = canvas, this.title = title;
    this.clear();
  }
  // good: from this time on [s] the run is known to have failed; at: marked
  clear() {
    this.times = [], this.rows = [], this.good = Infinity, this.at = undefined;
  }
  // Continue from the last good state.
  goOn() {
    while (this.times.length && this.times.at(-1) > this.good)
      this.times.pop(), this.rows.pop();
    this.good = Infinity;
  }

  // Add the values of all curves at a time [s]; a value may be NaN.
  add(time, row) {
    const {times} = this;
    if (times.length && time <= times[times.length - 1]) return;
    times.push(time), this.rows.push(row);
    if (times.length > 1200) {  // every other one: the whole run stays
      this.times = times.filter((_, k) => k % 2);
      this.rows = this.rows.filter((_, k) => k % 2);
    }
  }

  // @param curves [name, color] for each value   @param log by powers of ten
  draw(name, curves, log, style) {
    this.title.innerHTML = [name, ...curves.map(([what, color], k) =>
      `<b style="color:${color}"><i>${dashes[k][0]}</i> ${what}</b>`)]
      .join(' ');
    const {canvas, times, rows} = this;
    canvas.setAttribute('aria-label', `${name} over ${
      shortNumber(times.at(-1) ?? 0)} s; now ${curves.map(([what], k) =>
      `${what} ${shortNumber(rows.at(-1)?.[k])}`).join(', ')}`);
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width) return;
    canvas.width = width * ratio, canvas.height = height * ratio;
    const g = canvas.getContext('2d');
    g.scale(ratio, ratio);
    g.font = '11px system-ui, "DejaVu Sans", sans-serif';
    const value = a => log ? (a > 1e-12 ? Math.log10(a) : NaN) : a;
    // Values after a failure may leave the picture; the rest stays visible.
    let low = Infinity, high = -Infinity;
    rows.forEach((row, k) => {
      if (k > 0 && times[k] > this.good) return;
      for (const a of row.map(value))
        if (Number.isFinite(a))
          low = Math.min(low, a), high = Math.max(high, a);
    });
    if (this.good < Infinity && !log) high += 0.5 * (high - low) + 1e-6;
    if (!(low <= high)) low = log ? -6 : 0, high = log ? 0 : 1;
    if (log) low = Math.floor(Math.max(low, high - 8)), high = Math.ceil(high);
    if (high - low < 1e-9) high += 0.5, low -= 0.5;
    const left = 52, right = width - 6, top = 8, bottom = height - 18;
    const y = a => bottom - (a - low) / (high - low) * (bottom - top);
    const end = Math.max(times[times.length - 1] || 0, 1);
    const x = t => left + t / end * (right - left);
    g.strokeStyle = style.edge, g.fillStyle = style.dim, g.lineWidth = 1;
    g.textBaseline = 'middle', g.textAlign = 'right';
    for (const tick of ticks(low, high, log ? 1 : 0)) {
      g.beginPath(), g.moveTo(left, y(tick)), g.lineTo(right, y(tick));
      g.stroke();
      g.fillText(log ? '1e' + tick : shortNumber(tick), left - 5, y(tick));
    }
    g.textAlign = 'right', g.textBaseline = 'top';
    g.fillText(shortNumber(end) + ' s', right, bottom + 4);
    g.textAlign = 'left', g.fillText('0', left, bottom + 4);
    if (this.at !== undefined) g.fillRect(x(this.at), top, 1, bottom - top);
    g.lineWidth = 1.8, g.lineJoin = 'round';
    curves.forEach(([, color], k) => {
      g.strokeStyle = color, g.setLineDash(dashes[k][1]), g.beginPath();
      let down = false;
      rows.forEach((row, i) => {
        const a = value(row[k]);
        if (!Number.isFinite(a)) { down = false; return; }
        const to = [x(times[i]), Math.min(bottom, Math.max(top, y(a)))];
        down ? g.lineTo(...to) : g.moveTo(...to);
        down = true;
      });
      g.stroke();
    });
  }
}

// Dashes distinguish curves without colors: as text, and on the canvas.
const dashes = [['\u2014', []], ['- -', [6, 4]], ['\u00b7\u00b7\u00b7', [2, 3]],
  ['-\u00b7-', [8, 3, 2, 3]]];

// Round numbers between low and high, at most five.
function ticks(low, high, least) {
  let step = 10 ** Math.floor(Math.log10((high - low) / 2));
  for (const factor of [2, 2.5, 2])
    if ((high - low) / step > 4) step *= factor;
  step = Math.max(step, least);
  if (least) step = Math.ceil(step);
  const all = [];
  for (let a = Math.ceil(low / step - 1e-9) * step; a <= high + 1e-9 * step;
    a += step)
    all.push(Math.abs(a) < 1e-9 * step ? 0 : a);
  return all;
}

// Three digits are enough for a reader.
function shortNumber(a, digits = 3) {
  if (a === null || a === undefined || Number.isNaN(a)) return 'none';
  if (a === 0) return '0';
  const size = Math.abs(a);
  if (size >= 1e5 || size < 1e-3) return a.toExponential(digits - 1);
  return String(Number(a.toPrecision(digits)));
}
