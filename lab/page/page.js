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
      settings: {scene: 'forces', side: 25, method: 'verlet', share: 0.5,
        rival: '', rivalShare: 0.5, drag: 0.003},  // and others of the scene
      speed: 1,              // simulated seconds a second, at most
      isWaiting: true, readings: null, calls: 0, frames: 0, errors: [],
      run: 0, asked: 0,      // runs and requests; the worker counts them, too
    });
    this.find('.busy').setAttribute('role', 'status');
    this.say('.busy', 'loading');
    this.canvas.setAttribute('aria-describedby', 'keys');
    this.use('grab');
    // In a frame of another page: index.html?controls=none#scene=drape
    if (new URLSearchParams(location.search).get('controls') === 'none')
      document.body.className = 'bare';
  }
  async ready() {
    this.worker = startThread($('worker').textContent, this, replies,
      text => this.errors.push(text));
    const bytes = await unpacked($('wasm').textContent);
    this.worker.postMessage(['module', bytes], [bytes]);
  }
  // A request of lab/live/Requests.cpp.
  ask(...words) {
    this.worker.postMessage(['ask', words.join(' ')]);
    ++this.asked, this.wanted = true;
  }
  start(lines = startLines(), end = 0) {
    for (const plot of Object.values(plots)) plot.clear();
    this.forget(), this.tasks.cancel();
    this.hand.release();
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
  showNumbers() { showNumbers(), showLimits(); }
  // Look at the room that the scene names; else at the cloth, and below it.
  frameScene() {
    if (this.framed || !this.sides.length) return;
    this.framed = true;
    const all = [...this.room];
    if (!all.length)
      for (const i of this.sides[0].lines) {
        const p = [...this.sides[0].points.subarray(4 * i, 4 * i + 3)];
        all.push(p, Vec.add(p, [0, 0, -0.35]));
      }
    this.view.camera.lookAt(all);
  }
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
  speed: {...byPower(0.01, 1), show: a => `${shortNumber(a)} s/s`},
};
const scene = () => named(page.about.scenes, page.settings.scene);

function showControls() {
  const s = page.settings;
  if (![...$('side').options].some(o => Number(o.value) === s.side))
    $('side').append(new Option(`${s.side} x ${s.side}`, s.side));
  for (const name of ['scene', 'side', 'method', 'rival'])
    $(name).value = s[name];
  for (const [name, slider] of Object.entries(sliders)) {
    const value = name === 'speed' ? page.speed : s[name];
    if (value !== undefined) showSlider($(name), slider, value);
  }  // undefined until the first frame
  const m = named(page.about.methods, s.method);
  $('about').textContent = `Order ${m.order}, ${m.sweeps} force evaluation` +
    `${m.sweeps === 1 ? '' : 's'} a step. Good for: ${m.goodFor}. Fails: ` +
    `${m.failsWhen}.`;
  $('side').disabled = scene().fails;
  $('rivalShare').parentElement.hidden = !s.rival;
  $('distance-figure').hidden = !s.rival;
  showLimits();
  page.changed();
}

// Once no request is on its way, the settings are those of the run. K and drag
// change the limit, but dt stays; so dt / limit changes.
function followRun({asked, readings}) {
  if (asked !== page.asked || !readings) return;
  const {main, rival} = readings, s = page.settings, before = {...s};
  Object.assign(s, readings.parameters, {method: main.method,
    rival: rival ? rival.method : ''});
  for (const [name, run] of [['share', main], ['rivalShare', rival]]) {
    const share = run && Number((run.dt / run.unit).toPrecision(3));
    if (run && Math.abs(share / s[name] - 1) >= 0.01) s[name] = share;
  }
  if (Object.keys(s).some(name => s[name] !== before[name])) showControls();
}

// The step is red where it is beyond the limit of the method.
function showLimits() {
  const r = page.readings;
  for (const [name, run] of [['share', r && r.main],
    ['rivalShare', r && r.rival]]) {
    const share = page.settings[name];
    const beyond = !!run && run.safe !== null && share * run.unit > run.safe;
    $(name).parentElement.classList.toggle('beyond', beyond);
  }
  if (!r) return;
  const {dt, safe, sharp, unit} = r.main;
  setText($('limits'), `dt = ${inMs(dt)}. ` + (safe === null
    ? `Without a limit: 1 is that of Verlet, ${inMs(unit)}.`
    : safe === 0 ? `No step is stable: 1 is Verlet's limit, ${inMs(unit)}.`
      : `Stable in any shape up to ${inMs(safe)}` +
        (sharp ? `, in this one up to ${inMs(sharp)}.` : '.')));
}

// The request by which the run gets what a control shows.
function requestOf(name) {
  const s = page.settings;
  return name === 'share' ? ['step', s.share]
    : name === 'rival' || name === 'rivalShare'
      ? ['compare', s.rival, s.rivalShare] : [name, s[name]];
}
// The requests at the start of a scene that make it match the controls. Its
// parameters are in the settings once they are known.
function startLines() {
  const s = page.settings, names = Object.keys(sliders).filter(
    name => name in s && !name.endsWith('hare'));
  if (scene().fails && !names.length) return [];  // as its file says
  return ['method', ...names, 'share', ...s.rival ? ['rival'] : []].map(
    name => [0, requestOf(name).join(' ')]);
}

// The next scene has its own.
function forgetParameters() {
  for (const key of Object.keys(page.readings?.parameters || {}))
    delete page.settings[key];
}
function loadScene(name) {
  const s = page.settings, failed = scene().fails;
  s.scene = name;
  forgetParameters();
  if (scene().fails) s.rival = '';
  else if (failed) s.method = 'verlet', s.share = 0.5;
  page.start(), page.setPlaying(!isStill());
}

// Change a setting. A failed run goes on from its last good state, if it can.
function change(name, value) {
  page.settings[name] = value;
  if (page.broken) {
    page.restart();
  } else if (name === 'rival' || name === 'rivalShare' && page.calls === 0) {
    page.start();  // both from the same start
  } else {
    page.goOn(), page.ask(...requestOf(name));
    if (name === 'method') page.ask(...requestOf('share'));
  }
  showControls();
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
  $('rival').append(new Option('nothing', ''));
  for (const name of ['method', 'rival'])
    $(name).append(...methods.map(m => new Option(m.name)));
  $('scene').onchange = e => loadScene(e.target.value);
  $('side').onchange = e => {
    page.settings.side = Number(e.target.value), page.start();
  };
  for (const name of ['method', 'rival'])
    $(name).onchange = e => change(name, e.target.value);
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
  const [blue, orange, , dark] = page.style.series;
  const {main, rival} = r;
  if (rival) {
    plots.energy.draw('Energy drift [J]',
      [[main.method, blue], [rival.method, orange]], false, page.style);
    plots.distance.draw('Distance\u00a0[m]', [['apart', dark],
      [`${main.method} to exact`, blue], [`${rival.method} to exact`, orange]],
    true, page.style);
  } else {
    drawEnergy(plots.energy, page.style);
  }
  const rows = [['time', `${main.time.toFixed(3)} s`],
    ['steps', main.steps], ['nodes, springs', `${r.nodes}, ${r.edges}`],
    ['energy drift', `${shortNumber(main.drift)} J`],
    ['force evaluations', main.evaluations]];
  if (r.measure)
    rows.push([r.measure,
      [...r.answer.map(a => shortNumber(a)), r.unit].join(' ')]);
  if (r.tornNodes || r.tornEdges)
    rows.push(['torn nodes, springs', `${r.tornNodes}, ${r.tornEdges}`]);
  if (rival)
    rows.push(['force evaluations beside', rival.evaluations],
      ['distance of the two', `${shortNumber(r.apart)} m`]);
  fillTable($('numbers'), rows);
}

const tellLeftOut = () => page.say('.says',
  'Ignored the parts of this link that are not valid; the run may differ.');

const replies = {
  about(data) {
    page.about = data.about, page.tasks = new Tasks();
    makeControls();
    const read = Link.read(location.hash, page.about);
    Object.assign(page.settings, read.start);
    if (read.speed) page.speed = read.speed;
    if (read.camera)
      page.view.camera.set(...read.camera);
    page.setPlaying(!read.end && !isStill());
    page.start(location.hash ? read.lines : startLines(), read.end);
    if (read.leftOut) tellLeftOut();
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
    page.readings = data.readings;
    const {main, rival} = data.readings ?? {};
    page.show(data.sides.map(({mesh, ...side}, k) => {
      const run = rival && [main, rival][k];
      return {...page.sides[k], ...side, ...mesh, isNew: !!mesh,
        name: run?.method, words: run && `dt = ${inMs(run.dt)}${
          side.failure?.diverged ? ', diverged'
            : side.failure ? ', refused' : ''}`};
    }));
    if (!data.broken) followRun(data);
    if (!data.failed && data.readings?.missed && !page.find('.says').innerText)
      page.say('.says', `Warning: ${inPage(data.readings.missed)}.`);
    page.frameScene(), remember();
    if (data.failed && !page.failed && !page.wanted) page.fail(data);
    page.tasks.look(main?.time, page.failed);
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
    history.replaceState(null, '', hash);
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
  const {main, rival} = r;
  plots.energy.add(main.time, rival ? [main.drift, rival.drift]
    : [main.kinetic, main.elastic, main.height, main.total]);
  if (rival)
    plots.distance.add(main.time, [r.apart, r.error, r.rivalError]);
}
