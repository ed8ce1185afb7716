'use strict';
// make web: the controls of a page with one cloth.

const $ = id => document.getElementById(id);
const {Plot, shortNumber, stages, byPower, showSlider, makeSlider, fillTable,
  drawEnergy} = figure;
const {stage} = document.body.dataset;
const page = figure($('stage'), {wasm: ['cloth'], whole: true,
  stage: stages[stage] ? stage : 'problem1'});
const plot = new Plot($('energy'), $('energy-title'));

for (const [id, slider, use] of [
  ['dt', {...byPower(1e-4, 1e-2, 2), show: a => `${shortNumber(1e3 * a)} ms`},
    dt => page.setStep(dt)],
  ['speed', {...byPower(0.01, 1, 2), show: a => `${shortNumber(a)} s/s`},
    speed => { page.speed = speed; }]])
  showSlider(makeSlider(id, slider, use), slider, page[id]);

$('stages').append(...Object.entries(stages).map(
  ([name, {title}]) => new Option(title, name)));
$('stages').value = page.stage;
$('stages').onchange = e => { page.stage = e.target.value, page.restart(); };
$('grid').onchange = e => {
  page.grid = Number(e.target.value), page.restart();
};

page.onstart = () => plot.clear();
page.onframe = ({stages: count, readings: r}) => {
  // Code of section 5 and later that is not there yet.
  if (count)
    [...$('stages').options].forEach((option, k) => {
      option.disabled = k >= count;
    });
  if (r) plot.add(r.time, [r.kinetic, r.elastic, r.height,
    r.kinetic + r.elastic + r.height]);
};
page.showNumbers = () => {
  const r = page.cloths[0].readings;
  if (!r) return;
  drawEnergy(plot, page.style);
  fillTable($('numbers'), [['time', `${r.time.toFixed(3)} s`],
    ['steps', r.steps], ['nodes, springs', `${r.nodes}, ${r.edges}`],
    ['energy', `${shortNumber(r.kinetic + r.elastic + r.height)} J`]]);
};
