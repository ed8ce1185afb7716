// The thread that computes. It holds the one scene, in WebAssembly: Page.hpp
// says what each call does. Requests are lines of text: lab/live/Requests.cpp.
// A run is repeated by its requests, each after the same number of steps.

let about;                     // page_about()
let calls;                     // steps of this run
let run = 0, asked = 0;        // how many were started; requests taken
let sharpAt = 0, readings = null;
const shown = [];              // whether the failure of a side is

// @return the error in the request; '' if there is none
function request(line) {
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
// @return whether a line was not valid, and 150 readings at most
async function repeat({scene, side, lines, end}, mine) {
  ++run, calls = 0, broken = '';
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

// --------------------------------------------------------------------- Frames

function failureOf(side) {
  if (side === 0 && broken) return {cause: broken};
  return wasm.page_slots(side) ? JSON.parse(text(wasm.page_failure(side)))
    : null;
}

function frame() {
  if (!broken) call('check');
  const failed = !!failureOf(0), sides = [];
  for (const side of [0, 1, 2, 3]) {
    const failure = failureOf(side);
    if (side && failure && !failed && !shown[side]) beyond(side);
    shown[side] = !!failure;
    if (wasm.page_slots(side))
      sides.push({...drawn(side), failure,
        failedNode: wasm.page_failed_node(side)});
    else versions[side] = -1;
  }
  const sharp = failed || performance.now() - sharpAt > 250;
  if (sharp) sharpAt = performance.now();
  if (!broken) readings = JSON.parse(text(wasm.page_readings(sharp ? 1 : 0)));
  postMessage({kind: 'frame', run, asked, sides, readings, calls, failed,
    broken: !!broken}, sides.map(s => s.points.buffer));
}

// ----------------------------------------------------------------- A failure

// The steps after a side's last good state, without the guard that stops it,
// until a node is far from there: as many as fit in three seconds. From then on
// the side is drawn as it is while its nodes are still near.
// @return points and mesh of each step
function beyond(side) {
  const far = 0.6, near = 0.2;  // [m]
  const frames = [], until = performance.now() + 3000;
  let shown = 0, moved = 0, time = -1;
  versions[side] = -1;
  for (let k = 0; moved < far && performance.now() < until; ++k) {
    const next = call('beyond', side, k);
    if (next === undefined || next === time) break;  // it can't go on
    time = next, frames.push({time, ...drawn(side)});
    moved = largestMove(frames[0].points, frames[k].points);
    if (moved < near) shown = k;
  }
  if (!broken) call('beyond', side, shown);
  versions[side] = -1;
  return frames;
}
// The largest distance of a node between both [m], if both have it.
function largestMove(from, to) {
  let most = 0;
  for (let i = 0; i < to.length; i += 4) {
    const size = Math.hypot(to[i], to[i + 1], to[i + 2]);
    if (size > 0) most = Math.max(most, Math.hypot(to[i] - from[i],
      to[i + 1] - from[i + 1], to[i + 2] - from[i + 2]));
  }
  return most;
}

function setting() {
  versions = [-1, -1, -1, -1];
  postMessage({kind: 'setting', run,
    setting: JSON.parse(text(call('setting')))});
  frame();
}

const handlers = {
  async module(bytes) {
    module = await WebAssembly.compile(bytes);
    await instantiate();
    about = JSON.parse(text(call('about')));
    postMessage({kind: 'about', about});
  },
  // Without lines: those of the present run.
  async start(what, mine) {
    what.lines ??= text(call('recording')).split('\n').map(
      line => /^(\d+) (.*)/.exec(line)?.slice(1)).filter(
      line => line && line[1] !== 'end' && line[0] <= what.end);
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
  // After a failure: the motion beyond it.
  beyond() {
    if (!failureOf(0) || broken) return;
    postMessage({kind: 'beyond', run, asked, frames: beyond(0)}), frame();
  },
  // Why it failed and what works: found by trial, which takes a while.
  explain() {
    const failure = failureOf(0);
    if (!failure) return;
    const at = broken ? undefined : call('explain');
    // A trial may throw: then no cure is known.
    const {cure, ...why} = {...failure, cure: null,
      ...at === undefined ? {} : JSON.parse(text(at))};
    postMessage({kind: 'why', run, asked, why, cure, broken: !!broken});
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
