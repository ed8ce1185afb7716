'use strict';
// The page: its run, its controls, and the thread that computes.

const $ = id => document.getElementById(id);
const plots = {
  energy: new Plot($('energy'), $('energy-title')),
  distance: new Plot($('distance'), $('distance-title')),
};

class Laboratory extends FailurePicture {
  constructor() {
    super($('stage'), Object.keys(buttons), true);
    Object.assign(this, {
      about: null,           // scenes and methods
      settings: {...usual, rivalShare: 0.5, drag: 0.003},  // and of the scene
      speed: 1,              // simulated seconds a second, at most
      isWaiting: true, readings: null, calls: 0, frames: 0, errors: [],
      run: 0, asked: 0,      // runs and requests; the worker counts them, too
    });
    this.find('.busy').setAttribute('role', 'status');
    this.say('.busy', 'loading');
    this.canvas.setAttribute('aria-describedby', 'keys');
    addEventListener('keydown', e => {
      if (e.key.toLowerCase() === 'd' && !e.target.matches('select, input'))
        describe();
    });
    addEventListener('hashchange', () => openAddress());
    this.timeline = new Timeline(this), this.camcorder = new Camcorder();
    this.use('grab');
    // In a frame of another page: index.html?controls=none#scene=drape
    if (new URLSearchParams(location.search).get('controls') === 'none')
      document.body.className = 'bare';
  }
  async ready() {
    this.worker = startThread($('worker').textContent, this, replies,
      text => this.errors.push(text));
    const bytes = await unpacked($('wasm').textContent);
    this.doors = new Doors(bytes.slice());
    this.worker.postMessage(['module', bytes], [bytes]);
  }
  // A request of lab/live/Requests.cpp.
  ask(...words) {
    this.timeline.goOn();
    this.worker.postMessage(['ask', words.join(' ')]);
    ++this.asked, this.wanted = true;
  }
  // lines: null repeats the present run
  start(lines = startLines(), end = 0) {
    for (const plot of Object.values(plots)) plot.clear();
    this.timeline.clear(), this.forget(), this.tasks.cancel();
    if (lines) this.hand.release();
    const {scene, side} = this.settings;
    this.worker.postMessage(['start', {side, lines, end,
      scene: this.about.scenes.findIndex(a => a.name === scene)}]);
    ++this.run, this.isWaiting = true;
    showControls();
  }
  get isRunning() { return this.playing && !this.failed; }
  askFrames(passed) {
    this.worker.postMessage(['frame', this.stepping ? -1
      : this.isRunning ? Math.max(passed * this.speed, 1e-9) : 0]);
    this.isWaiting = true;
  }
  play() {
    if (!this.timeline.past) return super.play();
    this.timeline.goOn(), this.setPlaying(true);
  }
  step() { this.timeline.goOn(), super.step(); }
  drawn() { this.camcorder.drawn(); }
  showNumbers() { showNumbers(), showLimits(), this.timeline.tell(); }
  // Look at the room that the scene names; else at the cloth, and below it.
  frameScene() {
    if (this.framed || !this.sides.length) return;
    this.framed = true;
    this.view.camera.lookAt(
      this.room.length ? this.room : spaceOf(this.sides[0]));
  }
  setPlaying(on) {
    super.setPlaying(on);
    if (!on && this.readings) describe();
  }
}
// The points of a side, and how far they may fall.
function spaceOf({points, lines}) {
  return [...lines].flatMap(i => {
    const p = [...points.subarray(4 * i, 4 * i + 3)];
    return [p, Vec.add(p, [0, 0, -0.35])];
  });
}
const page = new Laboratory();

// -------------------------------------------------------------------- Controls

// Sliders by the names of their requests.
const fromZero = (high, power) => ({
  value: s => Number((high * s ** power).toPrecision(3)),
  place: a => (a / high) ** (1 / power),
});
const named = (all, name) => all.find(a => a.name === name);
const byArea = () => scene().byArea;
const sliders = {
  share: {...byPower(0.01, 100), show: a => shortNumber(a)},
  rivalShare: {...byPower(0.01, 100), show: a => shortNumber(a)},
  stiffness: {...byPower(1, 1e4), show: a => `${shortNumber(a)} N/m`},
  drag: {...fromZero(20, 4), show: a =>
    `${shortNumber(a)} ${byArea() ? 'kg/(s m\u00b2)' : 'kg/s'}`},
  gravity: {...fromZero(30, 1), show: a => `${shortNumber(a)} m/s\u00b2`},
  speed: {...byPower(0.01, 4), show: a => `${shortNumber(a)} s/s`},
};
const scene = (s = page.settings) => named(page.about.scenes, s.scene);
const rivalNames = ['rival0', 'rival1', 'rival2'];

function showControls() {
  const s = page.settings;
  if (![...$('side').options].some(o => Number(o.value) === s.side))
    $('side').append(new Option(`${s.side} x ${s.side}`, s.side));
  for (const name of ['scene', 'side', 'method']) $(name).value = s[name];
  rivalNames.forEach((name, k) => {
    $(name).value = s.rivals[k] ?? '';
    $(name).parentElement.hidden = k > s.rivals.length;
  });
  $('equal').checked = s.isEqual;
  for (const [name, slider] of Object.entries(sliders)) {
    const value = name === 'speed' ? page.speed : s[name];
    if (value !== undefined) showSlider($(name), slider, value);
  }  // undefined until the first frame
  const m = named(page.about.methods, s.method);
  $('about').textContent = `Order ${m.order}, ${m.sweeps} force evaluation` +
    `${m.sweeps === 1 ? '' : 's'} a step. Good for: ${m.goodFor}. Fails: ` +
    `${m.failsWhen}.`;
  $('side').disabled = scene().fails;
  $('race').hidden = scene().fails;
  $('rivalShare').parentElement.hidden = !s.rivals.length || s.isEqual;
  $('equal').parentElement.hidden = !s.rivals.length;
  $('distance-figure').hidden = !s.rivals.length;
  showLimits();
  page.changed();
}

// Once no request is on its way, the settings are those of the run. K and drag
// change the limit, but dt stays; so dt / limit changes.
function followRun({asked, readings}) {
  if (asked !== page.asked || !readings) return;
  const {main, rivals} = readings, s = page.settings, before = {...s};
  Object.assign(s, readings.parameters, {method: main.method});
  const names = rivals.map(rival => rival.method);
  if (names.join() !== s.rivals.join()) s.rivals = names;
  for (const [name, run] of [['share', main], ['rivalShare', rivals[0]]]) {
    const share = run && Number((run.dt / run.unit).toPrecision(3));
    if (run && Math.abs(share / s[name] - 1) >= 0.01) s[name] = share;
  }
  if (Object.keys(s).some(name => s[name] !== before[name])) showControls();
}

// The step is red where it is beyond the limit of the method.
function showLimits() {
  const r = page.readings;
  for (const [name, run] of [['share', r && r.main],
    ['rivalShare', r && r.rivals[0]]]) {
    const share = page.settings[name];
    const beyond = !!run && run.safe !== null && share * run.unit > run.safe;
    $(name).parentElement.classList.toggle('beyond', beyond);
  }
  if (!r) return;
  const {dt, safe, sharp, unit} = r.main;
  setText($('limits'), `dt = ${inMs(dt)}. ` + (safe === null
    ? `Without a limit: 1 is that of Verlet, ${inMs(unit)}.`
    : safe === 0 ? `No step is stable: 1 is Verlet's limit, ${inMs(unit)}.`
      : `Small swings hold, in any shape, up to ${inMs(safe)}` +
        (sharp ? `, in this one up to ${inMs(sharp)}.` : '.')));
}

// The request by which the run gets what a control shows.
function requestOf(name, s = page.settings) {
  return name === 'share' ? ['step', s.share]
    : name === 'rivals' && s.isEqual ? ['race', ...s.rivals]
      : name === 'rivals' || name === 'rivalShare' ? ['compare',
        ...s.rivals.flatMap(method => [method, s.rivalShare])]
        : [name, s[name]];
}
// The requests at the start of a scene that make it match the controls. Its
// parameters are in the settings once they are known.
function startLines(s = page.settings) {
  const names = Object.keys(sliders).filter(
    name => name in s && !name.endsWith('hare'));
  if (scene(s).fails && !names.length) return [];  // as its file says
  return ['method', ...names, 'share', ...s.rivals.length ? ['rivals'] : []]
    .map(name => [0, requestOf(name, s).join(' ')]);
}

// The next scene has its own.
function forgetParameters() {
  for (const key of Object.keys(page.readings?.parameters || {}))
    delete page.settings[key];
}
// Another run, by what differs from `usual`.
function begin(settings = {}) {
  forgetParameters(), page.find('.hint')?.remove();
  Object.assign(page.settings, usual, settings);
  if (page.settings.scene === 'forces') page.settings.drag ??= 0.003;
  page.start(), page.setPlaying(!isStill()), keepAddress(true);
}
function loadScene(name) {
  const {side, method, share, rivals} = page.settings, from = scene().fails;
  const keeps = !from && !named(page.about.scenes, name).fails;
  begin({scene: name, side, ...keeps ? {method, share, rivals} : {}});
}
// The address is the present start, for a reload. `isNew`: Back leads to the
// one before.
let keeping;
function keepAddress(isNew) {
  clearTimeout(keeping);
  const keep = () => {
    const lines = startLines().map(line => line.join(' ')).join('\n');
    const hash = Link.write(`${lines}\n0 end`, page.settings,
      page.camera ?? page.view.camera, page.speed);
    history[isNew ? 'pushState' : 'replaceState'](null, '', hash);
  };
  if (isNew) keep();
  else keeping = setTimeout(keep, 500);
}
// Run what the address says.
function openAddress() {
  const read = Link.read(location.hash, page.about);
  forgetParameters(), Object.assign(page.settings, usual, read.start);
  if (!location.hash) page.settings.drag = 0.003;
  if (read.speed) page.speed = read.speed;
  if (read.camera) page.view.camera.set(...read.camera);
  page.setPlaying(!read.end && !isStill());
  page.start(location.hash ? read.lines : startLines(), read.end);
  if (read.leftOut) tellLeftOut();
}

// Change a setting. A failed run goes on from its last good state, if it can.
function change(name, value) {
  page.settings[name] = value;
  if (page.broken) {
    page.restart();
  } else if (name === 'rivals' || name === 'isEqual' ||
      name === 'rivalShare' && page.calls === 0) {
    page.start();  // all from the same start
  } else {
    page.goOn(), page.ask(...requestOf(name));
    if (name === 'method') page.ask(...requestOf('share'));
  }
  keepAddress(), showControls();
}

function makeControls() {
  const {scenes, methods} = page.about;
  for (const fails of [false, true]) {
    const group = document.createElement('optgroup');
    group.label = fails ? 'Ways to break it' : 'Cloths';
    group.append(...scenes.filter(s => s.fails === fails).map(
      s => new Option(s.title, s.name)));
    $('scene').append(group);
  }
  for (const name of ['method', ...rivalNames]) {
    if (name !== 'method') $(name).append(new Option('nothing', ''));
    for (const label of new Set(methods.map(m => m.group))) {
      const group = document.createElement('optgroup');
      group.label = label;
      group.append(...methods.filter(m => m.group === label).map(
        m => new Option(m.name)));
      $(name).append(group);
    }
  }
  $('scene').onchange = e => loadScene(e.target.value);
  $('side').onchange = e => {
    page.settings.side = Number(e.target.value), page.start(), keepAddress();
  };
  $('method').onchange = e => change('method', e.target.value);
  for (const name of rivalNames)
    $(name).onchange = () => change('rivals', rivalNames.map(
      rival => $(rival).value).filter(Boolean));
  $('equal').onchange = e => change('isEqual', e.target.checked);
  for (const [name, slider] of Object.entries(sliders))
    makeSlider(name, slider, value => {
      if (name === 'speed') page.speed = value;
      else change(name, value);
    }, 5);
  $('link').onclick = () => page.worker.postMessage(['link']);
}

// ---------------------------------------------------------------------- Frames

function showNumbers() {
  const r = page.readings;
  if (!r) return;
  const {main, rivals} = r;
  if (rivals.length) {
    const curves = [main, ...rivals].map(
      ({method}, k) => [method, page.style.series[k]]);
    plots.energy.draw('Energy drift [J]', curves, false, page.style);
    plots.distance.draw('Distance to a fine run\u00a0[m]', curves, true,
      page.style);
  } else {
    drawEnergy(plots.energy, page.style);
  }
  const rows = [['time', `${main.time.toFixed(3)} s`],
    ['work', evaluations(main)]];
  if (r.measure)
    rows.push([r.measure,
      [...r.answer.map(a => shortNumber(a)), r.unit].join(' ')]);
  if (r.tornNodes || r.tornEdges)
    rows.push(['torn nodes, springs', `${r.tornNodes}, ${r.tornEdges}`]);
  fillTable($('numbers'), rows);
  fillTable($('more'), [['steps', main.steps],
    ['nodes, springs', `${r.nodes}, ${r.edges}`],
    ['energy drift', `${shortNumber(main.drift)} J`]]);
  if (scene().fails && $('side').selectedOptions[0]?.text !== `${r.nodes}`)
    $('side').append(new Option(r.nodes, 0)), $('side').value = 0;
}
const evaluations = ({work}) => `${work < 1e5 ? Math.round(work)
  : shortNumber(work)} force evaluations`;

// The state in words, for who does not see it.
function describe() {
  const {readings: r, sides, settings} = page;
  if (!r || !sides.length) return;
  const {points, lines, failure} = sides[0];
  let low = Infinity, strain = 0;
  for (const i of lines) {
    low = Math.min(low, points[4 * i + 2]);
    strain = Math.max(strain, points[4 * i + 3]);
  }
  setText($('spoken'), `${scene().title}, ${settings.method}, at ${
    r.main.time.toFixed(2)} seconds: ${failure ? `it failed: ${
    failure.cause}` : r.main.kinetic < 1e-3 ? 'it is at rest' :
    `it moves, with ${shortNumber(r.main.kinetic, 2)} joules`}; its lowest ` +
    `node is at a height of ${shortNumber(low, 2)} meters; the longest ` +
    `spring is stretched by ${shortNumber(100 * strain, 2)} percent.${
      r.tornEdges ? ` ${r.tornEdges} springs are torn.` : ''}`);
}

const tellLeftOut = () => page.say('.says',
  'Ignored the parts of this link that are not valid; the run may differ.');

const replies = {
  about(data) {
    page.about = data.about, page.tasks = new Tasks();
    makeControls(), openAddress();
    if (!location.hash) page.hint();
    // Once the first cloth has its thread.
    setTimeout(() => page.doors.draw(), 300);
  },
  setting({setting}) {
    page.view.obstacles = setting.obstacles;
    page.room = setting.room, page.framed = false;
  },
  frame(data) {
    page.isWaiting = false, page.calls = data.calls, ++page.frames;
    // A request on its way may make a failed run go on.
    if (data.failed && data.asked !== page.asked) page.wanted = true;
    if (page.beyond) page.beyond.drawn = undefined;
    else page.say('.busy', '');
    const {main, rivals = [], error} = data.readings ?? {};
    const {timeline} = page, before = timeline.last?.sides ?? [];
    const sides = data.sides.map(({mesh, ...side}, k) => {
      const run = rivals.length ? [{...main, error}, ...rivals][k] : null;
      return {...before[k], ...side, ...mesh, isNew: !!mesh,
        name: run?.method, words: run && `dt ${inMs(run.dt)}, ${
          side.failure?.diverged ? 'diverged' : side.failure ? 'refused'
            : `error ${shortNumber(1e3 * run.error, 2)} mm`}, work ${
          shortNumber(run.work)}`};
    });
    if (data.readings)
      timeline.add({sides, readings: data.readings, calls: data.calls});
    if (timeline.past) return;
    page.readings = data.readings, page.show(sides);
    if (!data.broken) followRun(data);
    if (!data.failed && data.readings?.warning && !page.find('.says').innerText)
      page.say('.says', `Warning: ${data.readings.warning}.`);
    page.frameScene(), remember();
    if (data.failed && !page.failed && !page.wanted) page.fail(data);
    if (data.readings && data.asked === page.asked)
      page.tasks.look({r: data.readings, time: main.time, failed: page.failed,
        share: main.dt / main.unit, method: main.method, side: page.sides[0]});
  },
  beyond({frames, asked}) {
    if (asked === page.asked) page.showBeyond(frames);
  },
  repeating({part}) {
    page.say('.busy',
      `repeating the link: ${Math.floor(100 * part)} %; Restart ends that`);
  },
  history({history, leftOut}) {
    for (const readings of history) page.readings = readings, remember();
    if (leftOut) tellLeftOut();
  },
  why({why, cure, broken, asked}) {
    if (!page.failed || asked !== page.asked) return;
    page.why = why, page.cure = cure, page.broken = broken;
    page.showFailure(why);
  },
  link({recording}) {
    const hash = Link.write(recording, page.settings,
      page.camera ?? page.view.camera, page.speed);
    clearTimeout(keeping), history.replaceState(null, '', hash);
    const done = text => {
      $('link').textContent = text;
      setTimeout(() => $('link').textContent = 'Copy link', 1500);
    };
    const copied = navigator.clipboard &&
      navigator.clipboard.writeText(location.href);
    if (copied) copied.then(() => done('Copied'), () => done('In the address'));
    else done('In the address');
  },
  positions(data) { page.positions = data; },
  error({text}) { page.errors.push(text), console.error(text); },
};

function remember() {
  const r = page.readings;
  if (!r) return;
  const {main, rivals} = r;
  plots.energy.add(main.time, rivals.length
    ? [main, ...rivals].map(run => run.drift)
    : [main.kinetic, main.elastic, main.height, main.total]);
  if (rivals.length)
    plots.distance.add(main.time, [r.error, ...rivals.map(run => run.error)]);
}
