'use strict';
// Part of the thread that computes: the module of WebAssembly, calls of its
// page_ functions, and the points and meshes to draw.

let wasm, module;              // exports; compiled
let broken = '', fault;        // what ended a call, until the next start
let versions = [-1, -1, -1, -1];  // of the meshes that were sent

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

// Call a page_ function. A throw traps; after that the instance is used only
// to draw its last state, until the next start makes another one.
function call(name, ...values) {
  const stack = wasm.__stack_pointer.value;
  try {
    return wasm['page_' + name](...values);
  } catch (error) {
    wasm.__stack_pointer.value = stack;
    broken = text(wasm.page_thrown()) || String(error), fault = error;
    return undefined;
  }
}

// Points of a side, and its mesh if that has changed since the last call.
function drawn(side) {
  const points = copy(Float32Array, wasm.page_points(side),
    4 * wasm.page_slots(side));
  const version = wasm.page_version(side);
  if (version === versions[side]) return {points, mesh: null};
  versions[side] = version;
  const at = wasm.page_mesh(side);
  const [lines, triangles, pins] = copy(Uint32Array, at, 3);
  const all = copy(Uint32Array, at + 12, 2 * lines + 3 * triangles + pins);
  return {points, mesh: {lines: all.slice(0, 2 * lines),
    triangles: all.slice(2 * lines, 2 * lines + 3 * triangles),
    pins: all.slice(2 * lines + 3 * triangles)}};
}

// Messages [name, value] call handlers[name](value, number of starts), one at a
// time, also while a handler waits.
let newest = 0, last = Promise.resolve();
onmessage = ({data: [name, value]}) => {
  const number = name === 'start' ? ++newest : newest;
  last = last.then(() => handlers[name](value, number)).catch(
    error => postMessage({kind: 'error', text: String(error.stack || error)}));
};
