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

  // What write() wrote; what is missing or makes no sense is left out.
  // @return {start, log, calls, camera, speed}: start has what is known
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
    for (const name of ['share', 'rivalShare']) number(name, 0.001, 1000);
    number('K', 0.01, 1e6), number('drag', 0, 100), number('gravity', 0, 100);
    const read = {start, log: [], calls: 0};
    if (start.side) start.side = Math.round(start.side);
    const steps = Number(all.get('steps'));
    if (steps > 0 && steps <= 1e6) read.calls = Math.floor(steps);
    for (const event of (all.get('log') || '').split('~').filter(Boolean)) {
      const [at, name, ...values] = event.split('_');
      const numbers = values.map(Number);
      if (/^(method|share|K|drag|gravity|compare|grab|move|release|pin|cut)$/
        .test(name) && Number(at) >= 0 && numbers.every(Number.isFinite))
        read.log.push([Number(at), name, ...numbers]);
    }
    const camera = (all.get('camera') || '').split('_').map(Number);
    if (camera.length === 3 && camera.every(Number.isFinite))
      read.camera = camera;
    const speed = Number(all.get('speed'));
    if (speed > 0 && speed <= 4) read.speed = speed;
    return read;
  },
};
