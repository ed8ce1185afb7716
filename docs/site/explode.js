'use strict';
// Why does my cloth explode? A figure with a slider for its step, and the map
// of what a step does to a swing of frequency omega.

const K = 100;  // [N/m], of every spring
const most = 2.6;  // of h omega, in the map
const growth = a => {  // of one step of symplectic Euler, a = h omega
  const c = a * a / 2 - 1;
  return a <= 2 ? 1 : c + Math.sqrt(c * c - 1);
};

// The highest frequency [1/s] of springs at the places where they are: the
// power method on H/m, a few products a frame, from the vector of the last.
class Highest {
  constructor() { this.vector = []; }
  of({points, lines, pins}, length) {
    const count = points.length / 4, held = new Set(pins);
    if (this.vector.length !== 3 * count)
      this.vector = Float64Array.from({length: 3 * count},
        (_, k) => Math.sin(7 * k * k + 1));
    let square = 0;
    for (let round = 0; round < 12; ++round) {
      const v = this.vector, w = new Float64Array(v.length);
      for (let k = 0; k < lines.length; k += 2) {
        const [a, b] = [lines[k], lines[k + 1]], u = [0, 0, 0];
        let l = 0, along = 0;
        for (let i = 0; i < 3; ++i)
          u[i] = points[4 * b + i] - points[4 * a + i];
        l = Math.hypot(...u);
        for (let i = 0; i < 3; ++i)
          along += u[i] / l * (v[3 * b + i] - v[3 * a + i]);
        const across = Math.max(0, 1 - length / l);
        for (let i = 0; i < 3; ++i) {
          const d = v[3 * b + i] - v[3 * a + i], n = u[i] / l * along;
          const f = K * (n + across * (d - n));
          w[3 * b + i] += f, w[3 * a + i] -= f;
        }
      }
      for (const p of held) w.fill(0, 3 * p, 3 * p + 3);
      square = Math.hypot(...w) / Math.hypot(...v);
      this.vector = w.map(x => x / Math.hypot(...w));
    }
    return Math.sqrt(square * count);  // a node has 1/count kg
  }
}

// The map: |lambda| of a step against h omega.
function mapOf() {
  const x = a => 40 + 300 / most * a, y = g => 150 - 32 * Math.min(g, 4.4);
  let curve = '';
  for (let a = 0; a <= most; a += 0.02)
    curve += (curve ? 'L' : 'M') +
      `${x(a).toFixed(1)} ${y(growth(a)).toFixed(1)}`;
  const box = document.createElement('div');
  box.className = 'map';
  box.innerHTML = `<svg viewBox="0 0 350 186" role="img"
      aria-label="The factor of a step: 1 up to h omega = 2, then it rises">
    <rect class="beyond" x="${x(2)}" y="6" width="${x(most) - x(2)}"
      height="144"/>
    <path class="axis" d="M40 6V150H340"/>
    <path class="curve" d="${curve}"/>
    <circle r="7"/>
    ${[0, 1, 2].map(a => `<text x="${x(a)}" y="166">${a}</text>`).join('')}
    ${[1, 2, 3, 4].map(g =>
    `<text x="30" y="${y(g) + 4}">${g}</text>`).join('')}
    <text x="190" y="182">h &#969;</text>
    <text x="48" y="16" class="start">|&#955;|, the factor of a step</text>
  </svg>`;
  const point = box.querySelector('circle');
  return {box, move(a) {
    point.setAttribute('cx', x(Math.min(a, most)));
    point.setAttribute('cy', y(growth(a)));
    point.classList.toggle('bad', a > 2);
  }};
}

// A figure, its slider and its map.
class Explosion {
  constructor(element) {
    const {highest, ...options} = scenes[element.dataset.scene];
    const place = document.createElement('div'), below =
      document.createElement('div');
    below.className = 'look below';
    below.innerHTML = `<label class="slider"><span>step h</span>
      <input type="range" min="0.2" max="1.3" step="0.005"><output></output>
      </label><p class="words" aria-live="off"></p>`;
    this.map = mapOf(), below.append(this.map.box);
    element.append(place, below);
    this.limit = 2 / highest, this.highest = new Highest();
    this.words = below.querySelector('.words');
    this.slider = below.querySelector('input');
    this.slider.value = options.dt / this.limit;
    this.output = below.querySelector('output');
    this.slider.oninput = () => this.choose();
    this.figure = figure(place, {wasm: ['right'], stage: 'problem1',
      ...options});
    this.figure.onframe = cloth => this.took(cloth);
    this.omega = highest, this.choose();
  }
  choose() {
    this.dt = Number((this.slider.value * this.limit).toPrecision(3));
    this.output.textContent = `${this.dt} s`;
    this.slider.setAttribute('aria-valuetext', `${this.dt} seconds`);
    this.figure.setStep(this.dt), this.show();
    const [cloth] = this.figure.cloths;
    if (cloth.failure || cloth.readings?.gainAt >= 0) this.figure.restart();
  }
  took({readings, side, failure}) {
    if (!side?.points || failure || readings.gainAt >= 0) return;
    const [a, b] = side.lines, p = side.points;
    if (readings.steps === 0) this.length = Math.hypot(
      p[4 * a] - p[4 * b], p[4 * a + 1] - p[4 * b + 1],
      p[4 * a + 2] - p[4 * b + 2]);
    if (this.length) this.omega = this.highest.of(side, this.length);
    this.show();
  }
  show() {
    const a = this.dt * this.omega, factor = growth(a);
    this.map.move(a);
    this.words.textContent = `h \u03c9 = ${a.toFixed(2)}: ` + (a <= 2
      ? 'nothing grows'
      : `each step makes the fastest swing ${factor.toFixed(2)} times larger`);
    this.words.classList.toggle('bad', a > 2);
  }
}
for (const element of document.querySelectorAll('.explode'))
  element.explosion = new Explosion(element);
