'use strict';
// The whole state of the page as the part of its address behind #: the start,
// what was asked and after how many steps, the camera. Who opens it sees the
// same run, to the same bits.

const Link = {
  // @param link of the worker: {start, log, calls}
  write(link, about, camera, speed) {
    const {start, log, calls} = link;
    const all = new URLSearchParams();
    all.set('scene', about.scenes[start.scene].name);
    all.set('side', start.side);
    all.set('method', about.methods[start.method].name);
    for (const name of ['share', 'K', 'drag', 'gravity'])
      all.set(name, start[name]);
    if (start.rival >= 0) {
      all.set('rival', about.methods[start.rival].name);
      all.set('rivalShare', start.rivalShare);
    }
    all.set('speed', speed);
    all.set('camera', [camera.yaw, camera.pitch, camera.zoom].map(
      a => Number(a.toFixed(3))).join('_'));
    if (log.length) all.set('log', log.map(event => event.join('_')).join('~'));
    all.set('steps', calls);
    return '#' + all;
  },

  most: {steps: 1e6, node: 1e4 - 1},
  ranges: {share: [0.001, 1000], rivalShare: [0.001, 1000], K: [0.01, 1e6],
    drag: [0, 100], gravity: [0, 100]},

  // Whether this is a request that the page makes.
  canAsk(name, values, methods) {
    const within = (a, [low, high]) => a >= low && a <= high;
    const [first, second] = values, n = values.length;
    if (!values.every(Number.isFinite)) return false;
    if (name in Link.ranges) return n === 1 && within(first, Link.ranges[name]);
    const whole = Number.isInteger(first);
    switch (name) {
      case 'method': return n === 1 && whole && within(first, [0, methods - 1]);
      case 'compare': return n === 2 && whole &&
        within(first, [-1, methods - 1]) && within(second, Link.ranges.share);
      case 'grab': return n === 4 && whole &&
        within(first, [0, Link.most.node]);
      case 'pin': return n === 1 && whole && within(first, [0, Link.most.node]);
      case 'move': return n === 3;
      case 'release': return n === 0;
      case 'cut': return n === 12;
      default: return false;
    }
  },

  // What write() wrote; what is missing or makes no sense is left out.
  // @return {start, log, calls, camera, speed, leftOut}: start has what is
  // known; leftOut: a step or a request made no sense
  read(hash, about) {
    const all = new URLSearchParams(hash.replace(/^#/, ''));
    const start = {};
    const index = (list, name) => list.findIndex(a => a.name === name);
    const number = (name, least, most) => {
      const a = Number(all.get(name));
      if (all.has(name) && a >= least && a <= most) start[name] = a;
    };
    const choice = (name, list) => {
      const k = index(list, all.get(name));
      if (k >= 0) start[name] = k;
    };
    choice('scene', about.scenes);
    choice('method', about.methods), choice('rival', about.methods);
    number('side', 2, 100);
    for (const [name, range] of Object.entries(Link.ranges))
      number(name, ...range);
    const read = {start, log: [], calls: 0, leftOut: false};
    if (start.side) start.side = Math.round(start.side);
    const steps = Number(all.get('steps'));
    if (steps >= 0 && steps <= Link.most.steps) read.calls = Math.floor(steps);
    else read.leftOut = true;
    for (const event of (all.get('log') || '').split('~').filter(Boolean)) {
      const [at, name, ...values] = event.split('_');
      const numbers = values.map(Number), calls = Number(at);
      if (calls >= 0 && calls <= read.calls &&
        Link.canAsk(name, numbers, about.methods.length))
        read.log.push([calls, name, ...numbers]);
      else read.leftOut = true;
    }
    const camera = (all.get('camera') || '').split('_').map(Number);
    if (camera.length === 3 && camera.every(a => Math.abs(a) <= 1000))
      read.camera = camera;
    const speed = Number(all.get('speed'));
    if (speed > 0 && speed <= 4) read.speed = speed;
    return read;
  },
};
