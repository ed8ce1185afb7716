// The thread that computes one cloth; cloth.cpp documents each call. The page
// asks for a frame and waits for it, so that it notices a step that never ends.

let run = 0;                   // how many were started
let failure = '';              // why it does not go on

const names = ['kinetic', 'elastic', 'height', 'nodes', 'edges', 'time',
  'steps', 'gainAt', 'failedNode'];
function readings() {
  const at = call('readings');
  if (at === undefined) return null;
  const all = copy(Float64Array, at, names.length);
  return Object.fromEntries(names.map((name, k) => [name, all[k]]));
}

// A fault of WebAssembly in the words of C++.
const faults = [
  [/unreachable/, 'the program ended: abort(), or a return is missing'],
  [/call stack|too much recursion/, 'a function calls itself without end'],
  [/out of bounds|out-of-bounds/, 'it used memory that it does not have: an ' +
    'index beyond the end, or a node that was removed'],
  [/bad_alloc/, 'no memory is left: something grows without end'],
];
// Where it happened: the innermost function that is of no library and not of
// cloth.cpp. Browsers write `at cloth.wasm.NAME(...) (wasm:` or `NAME(...)@`.
function placeOf(error) {
  for (const line of String(error?.stack).split('\n')) {
    const name = /^\s*(?:at )?(?:cloth\.wasm\.)?(.+?)(?: \(wasm:|@)/.exec(line);
    const plain = name?.[1].replace(/<[^()]*>|\(.*/gs, '').split(' ').pop();
    if (plain && !/std::|web::|^(page_|_|operator|end$|wasm-f)/.test(plain))
      return `, in ${plain}()`;
  }
  return '';
}
function fail() {
  const said = text(wasm.page_thrown()).replace(/^.*\/c\+\+\/.* failed: /, '');
  const words = faults.find(([found]) => found.test(said || broken));
  failure = (words && (!said || words[0].test('bad_alloc')) ? words[1]
    : said || broken).trim();
  if (!/:\d+: /.test(failure)) failure += placeOf(fault);
}

// A node is more than 20 m away, or its place is not a number.
function fall() {
  const {gainAt, failedNode, time} = readings(), at = a => Number(a.toFixed(4));
  failure = gainAt >= 0
    ? `diverged: at t = ${at(gainAt)} s it gains energy from nothing`
    : `at t = ${at(time)} s node ${failedNode} is more than 20 m away, or ` +
      'its position is not a number';
}

// Steps until `time` [s], or as many as fit in `budget` [ms].
function advance(time, budget) {
  const until = performance.now() + budget;
  let now = readings()?.time;
  while (!failure && now < time && performance.now() < until) {
    const before = now;
    now = call('step');
    if (broken) fail();
    else if (!(now > before)) failure = `the step returned the time ${now} s, `
      + `expected more than ${before} s: t + dt`;
    else if (readings().failedNode >= 0) fall();
  }
}

function frame() {
  const r = broken ? null : readings();
  const reply = {kind: 'frame', run, failure, readings: r};
  if (wasm.page_slots(0)) Object.assign(reply, drawn(0));
  postMessage(reply, reply.points ? [reply.points.buffer] : []);
}

const handlers = {
  async start({bytes, stage, side, dt, chain, number}) {
    module ??= await WebAssembly.compile(bytes);
    await instantiate();
    run = number, broken = failure = '', versions = [-1, -1];
    call('start', stage, side, dt, chain);
    if (broken) fail();
    postMessage({kind: 'started', run, stages: wasm.page_stages()});
    frame();
  },
  // One frame: until this time [s].
  frame(time) { advance(time, 12), frame(); },
  // 'grab 17 0.1 0.2 0.3', 'set_step 0.001', 'stroke ...'
  ask(line) {
    const [name, ...values] = line.split(' ');
    if (failure) return;
    if (call(name, ...values.map(Number)) > 0)
      postMessage({kind: 'uncut', run});
    if (broken) fail();
  },
  // For the test: after so many steps, all positions by index.
  positions(steps) {
    for (let k = 0; k < steps && !broken; ++k) call('step');
    if (broken) fail();
    const all = copy(Float64Array, wasm.page_positions(0),
      3 * wasm.page_nodes());
    postMessage({kind: 'positions', all, failure}, [all.buffer]);
  },
};
