'use strict';
// The thread that computes. It holds the one scene, in WebAssembly: Page.hpp
// says what each call does. Requests are lines of text: lab/live/Requests.cpp.
// A run is repeated by its requests, each after the same number of steps.

let wasm, module, about;       // exports; compiled; page_about()
let calls;                     // steps of this run
let run = 0, asked = 0;        // how many were started; requests taken
let broken = '';               // what was thrown, until the next start
let versions = [-1, -1];       // of the meshes that were sent
let sharpAt = 0, explained = false, readings = null;
let newest = 0;                // number of the last run that the page asked for

const text = at => {
  const bytes = new Uint8Array(wasm.memory.buffer, at);
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
};
const copy = (Type, at, n) => new Type(wasm.memory.buffer, at, n).slice();

// No file and no environment: success with nothing in it, or "bad descriptor".
const nothing = (...sizes) => {
  const view = new DataView(wasm.memory.buffer);
  for (const at of sizes) view.setUint32(at, 0, true);
  return 0;
};
const wasi = {
  environ_get: () => 0, environ_sizes_get: nothing,
  fd_close: () => 8, fd_seek: () => 8, fd_write: () => 8,
  proc_exit: status => { throw new Error('exit ' + status); },
};

async function instantiate() {
  const made = await WebAssembly.instantiate(module,
    {wasi_snapshot_preview1: wasi});
  wasm = made.exports;
  wasm._initialize();
}

// Call of a page_ function. What throws traps: then the instance is used only
// to draw what it has, until the next start makes another one.
function call(name, ...values) {
  const stack = wasm.__stack_pointer.value;
  try {
    return wasm['page_' + name](...values);
  } catch (error) {
    wasm.__stack_pointer.value = stack;
    broken = text(wasm.page_thrown()) || String(error);
    return undefined;
  }
}

// @return what is wrong with the request; '' if nothing
function request(line) {
  explained = false;
  const bytes = new TextEncoder().encode(line + '\0');
  const at = call('room', bytes.length);
  new Uint8Array(wasm.memory.buffer, at, bytes.length).set(bytes);
  const wrong = call('request', at);
  return wrong === undefined ? '' : text(wrong);
}

// Steps until `time` [s], or as many as fit in `budget` [ms].
// @return the time reached
function advance(time, budget) {
  const until = performance.now() + budget;
  let now = -1;
  while (!broken && performance.now() < until) {
    const next = call('step');
    if (next === undefined || next === now) break;  // it failed
    ++calls, now = next;
    if (now >= time) break;
  }
  return now;
}

// Run a scene through its requests `lines`, [steps before it, text], and to
// `end` steps, until the page asks for another run than `mine`.
// @return whether all lines made sense, and 150 readings at most
async function repeat({scene, side, lines, end}, mine) {
  ++run, calls = 0, broken = '', explained = false;
  call('load', scene, side);
  const history = [], every = Math.ceil(end / 150);
  let until = performance.now(), leftOut = false;
  // Now and then, say how far it is and let messages come in.
  const goesOn = async () => {
    if (end && performance.now() > until) {
      postMessage({kind: 'repeating', run, part: calls / end});
      await new Promise(resolve => setTimeout(resolve));
      until = performance.now() + 100;
    }
    return mine === newest && !broken;
  };
  const runTo = async at => {
    while (calls < at && await goesOn()) {
      call('step');
      if (++calls % every || broken || failureOf(0)) continue;
      history.push(JSON.parse(text(call('readings', 0))));
    }
  };
  for (const [at, line] of lines) {
    await runTo(at);
    if (!await goesOn()) break;
    if (request(line)) leftOut = true;
  }
  await runTo(end);
  return {history, leftOut};
}

// ------------------------------------------------------------------ To be seen

function failureOf(side) {
  if (side === 0 && broken) return broken;
  return wasm.page_slots(side) ? text(wasm.page_failure(side)) : '';
}

function frame() {
  if (!broken) call('check');
  const sides = [], parts = [];
  for (const side of [0, 1]) {
    const slots = wasm.page_slots(side);
    if (!slots) { versions[side] = -1; continue; }
    const points = copy(Float32Array, wasm.page_points(side), 4 * slots);
    const s = {points, mesh: null, failure: failureOf(side),
      failedNode: wasm.page_failed_node(side)};
    const version = wasm.page_version(side);
    if (version !== versions[side]) {
      versions[side] = version;
      const at = wasm.page_mesh(side);
      const [lines, triangles, pins] = copy(Uint32Array, at, 3);
      const all = copy(Uint32Array, at + 12, 2 * lines + 3 * triangles + pins);
      s.mesh = {lines: all.slice(0, 2 * lines),
        triangles: all.slice(2 * lines, 2 * lines + 3 * triangles),
        pins: all.slice(2 * lines + 3 * triangles)};
      parts.push(s.mesh.lines.buffer, s.mesh.triangles.buffer,
        s.mesh.pins.buffer);
    }
    parts.push(points.buffer);
    sides.push(s);
  }
  const failed = broken || (sides[0] && sides[0].failure);
  const sharp = performance.now() - sharpAt > 250;
  if (sharp) sharpAt = performance.now();
  if (!failed) readings = JSON.parse(text(wasm.page_readings(sharp ? 1 : 0)));
  const good = failed && !broken ? call('step') : Infinity;  // [s]
  postMessage({kind: 'frame', run, asked, sides, readings, calls, good,
    failed: !!failed}, parts);
  if (failed && !explained) setTimeout(explain, 0);
}

// Why it failed and what works: it is found by trying, which takes a while.
function explain() {
  explained = true;
  if (broken) return postMessage({kind: 'why', run, why: broken, readings});
  const short = failureOf(0), at = call('readings', 1);
  if (at !== undefined) readings = JSON.parse(text(at));
  // A trial of what might work may throw: then nothing works that is known.
  const why = at === undefined ? short : readings.main.failure;
  postMessage({kind: 'why', run, why, readings, asked});
}

function setting() {
  versions = [-1, -1];
  postMessage({kind: 'setting', setting: JSON.parse(text(call('setting')))});
  frame();
}

const handlers = {
  async module(bytes) {
    module = await WebAssembly.compile(bytes);
    await instantiate();
    about = JSON.parse(text(call('about')));
    postMessage({kind: 'about', about});
  },
  async run(what, mine) {
    if (broken) await instantiate();
    postMessage({kind: 'history', ...await repeat(what, mine), run});
    setting();
  },
  ask(line) {
    ++asked;
    const wrong = broken ? '' : request(line);
    if (wrong) throw new Error(`${line}: ${wrong}`);
  },
  // One frame: simulated time [s] to pass, or -1: one step.
  frame(seconds) {
    const budget = 12;  // [ms]: the rest of a frame is for the drawing
    if (seconds < 0) advance(0, budget);
    else if (seconds > 0 && readings)
      advance(readings.main.time + seconds, budget);
    frame();
  },
  link: () => postMessage({kind: 'link', recording: text(call('recording'))}),
  // For the test: after so many steps, all positions.
  positions(steps) {
    for (let k = 0; k < steps; ++k) call('step'), ++calls;
    const n = wasm.page_slots(0);
    const all = copy(Float64Array, wasm.page_positions(0), 3 * n);
    const {dt} = JSON.parse(text(call('readings', 0))).main;
    postMessage({kind: 'positions', all, dt, broken}, [all.buffer]);
  },
};
// One message at a time, also while a handler waits.
let last = Promise.resolve();
onmessage = ({data: [name, value]}) => {
  const number = name === 'run' ? ++newest : newest;
  last = last.then(() => handlers[name](value, number)).catch(
    error => postMessage({kind: 'error', text: String(error.stack || error)}));
};
