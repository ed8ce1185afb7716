'use strict';
// A run of the page as the part of its address behind #: scene, size, camera,
// and the changes of it (lab/live/Live.hpp), with _ for a blank and ~ for the
// end of a line. Opened again, it is the same run, bit by bit.

const Link = {
  // @param recording Live::recording()
  write(recording, settings, camera, speed) {
    const all = new URLSearchParams();
    for (const name of ['scene', 'side']) all.set(name, settings[name]);
    all.set('speed', speed);
    all.set('camera', [camera.yaw, camera.pitch, camera.zoom].map(
      a => Number(a.toFixed(3))).join('_'));
    all.set('run', recording.trim().replaceAll('\n', '~')
      .replaceAll(' ', '_'));
    return '#' + all;
  },

  most: 1e6,  // steps, and the largest number of a request

  // Reads what write() wrote; ignores parts that are missing or not valid.
  // @return {start, lines, end, camera, speed, leftOut}: start has scene and
  // side, if known; end: number of steps; leftOut: a line was not valid
  read(hash, about) {
    const all = new URLSearchParams(hash.replace(/^#/, ''));
    const read = {start: {}, lines: [], end: 0, leftOut: false};
    if (about.scenes.some(s => s.name === all.get('scene')))
      read.start.scene = all.get('scene');
    const side = Math.round(Number(all.get('side')));
    if (side >= 2 && side <= 100) read.start.side = side;
    const lines = (all.get('run') || '0_step_0.5~0_end').split('~')
      .map(line => line.split('_'))
      .map(([at, ...words]) => [Number(at), words]);
    const [end, last] = lines.pop();
    if (last[0] === 'end' && end >= 0 && end <= Link.most)
      read.end = Math.floor(end);
    else read.leftOut = true;
    for (const [at, words] of lines) {
      if (at >= 0 && at <= read.end && words.every(
        word => !(Math.abs(word) > Link.most)))
        read.lines.push([at, words.join(' ')]);
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
