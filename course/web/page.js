'use strict';
// make web: the controls of a page with one cloth.

const $ = id => document.getElementById(id);
const {Plot, shortNumber, setText, stages} = figure;
const {stage} = document.body.dataset;
const page = figure($('stage'), {wasm: ['cloth'], whole: true,
  stage: stages[stage] ? stage : 'problem1'});
const plot = new Plot($('energy'), $('energy-title'));

// A slider whose places are logarithmic.
function slider(id, low, high, show, use) {
  const input = $(id), output = input.parentElement.querySelector('output');
  const value = () =>
    Number((low * (high / low) ** (input.value / 1000)).toPrecision(2));
  const tell = () => {
    output.textContent = show(value());
    input.setAttribute('aria-valuetext', output.textContent);
  };
  Object.assign(input, {min: 0, max: 1000, step: 1});
  input.value = Math.round(1000 * Math.log(page[id] / low) /
    Math.log(high / low));
  input.oninput = () => { tell(), use(value()); };
  tell();
}
slider('dt', 1e-4, 1e-2, a => `${shortNumber(1e3 * a)} ms`,
  dt => page.setStep(dt));
slider('speed', 0.01, 1, a => `${shortNumber(a)} s/s`,
  speed => { page.speed = speed; });

function restart() { plot.clear(), page.restart(); }
$('stages').append(...Object.entries(stages).map(
  ([name, {title}]) => new Option(title, name)));
$('stages').value = page.stage;
$('stages').onchange = e => { page.stage = e.target.value, restart(); };
$('grid').onchange = e => { page.grid = Number(e.target.value), restart(); };
page.on('.restart', restart);
addEventListener('keydown', e => {
  if (e.target.matches('select, input') || e.ctrlKey || e.metaKey) return;
  const name = e.key.toLowerCase();
  if (e.key === ' ' && e.target.matches('button')) return;
  if (e.key === ' ') page.find('.play').click();
  else if (name === 'r') restart();
  else if (name === 'n') page.oneStep();
  else return;
  e.preventDefault();
});

let drawnAt = 0;
page.onframe = cloth => {
  const r = cloth.readings;
  // Code of section 5 and later that is not there yet.
  if (cloth.stages)
    [...$('stages').options].forEach((option, k) => {
      option.disabled = k >= cloth.stages;
    });
  if (!r || !page.style) return;
  plot.add(r.time, [r.kinetic, r.elastic, r.height,
    r.kinetic + r.elastic + r.height]);
  const now = performance.now();
  if (page.playing && !cloth.failure && now - drawnAt < 250) return;
  drawnAt = now;
  const [blue, orange, green, dark] = page.style.series;
  plot.draw('Energy [J]', [['kinetic', blue], ['elastic', orange],
    ['height', green], ['total', dark]], false, page.style);
  const rows = [['time', `${r.time.toFixed(3)} s`], ['steps', r.steps],
    ['nodes, springs', `${r.nodes}, ${r.edges}`],
    ['energy', `${shortNumber(r.kinetic + r.elastic + r.height)} J`]];
  const table = $('numbers');
  rows.forEach((row, k) => {
    const line = table.rows[k] || table.insertRow();
    row.forEach((text, c) =>
      setText(line.cells[c] || line.insertCell(), String(text)));
  });
};
