'use strict';
// When a run fails, the page shows the motion beyond the failure, the reason
// and the cure, and goes on from the last good state.

const playback = 3000;  // [ms], of the motion beyond a failure, and
const pause = 800;      // [ms] until it is shown again
const strains = ['strain 2 %', '45 %'];
const ways = ['moves one way', 'the other way'];
const inMs = seconds => `${shortNumber(1e3 * seconds)} ms`;

class FailurePicture extends Picture {
  constructor(...all) {
    super(...all);
    Object.assign(this, {failed: false, why: '', cure: null,
      broken: false,         // no request can make it go on
      beyond: null,          // the motion after a failure: frames, since when
      camera: null});        // as it was before a failure
    this.find('.fault').insertAdjacentHTML('beforeend', `<p class="place"></p>
      <button class="cure" hidden></button>
      <button class="dismiss" aria-label="Close">&times;</button>`);
    const close = () => this.showFailure(null);
    this.find('.dismiss').onclick = close;
    this.find('.cure').onclick = () => this.applyCure();
    addEventListener('keydown', e => { if (e.key === 'Escape') close(); });
  }
  get isMoving() {
    return this.isRunning || !!this.beyond?.moves && !this.timeline.past;
  }
  // After a failure: show it again.
  play() {
    if (this.failed && !this.beyond) return this.restart();
    if (!this.failed) return super.play();
    this.beyond.from = undefined, this.beyond.moves = true, this.changed();
  }
  setPlaying(on) {
    super.setPlaying(on);
    if (this.beyond && !this.timeline.past)
      setText(this.find('.play'), 'Replay');
  }
  // Show the strain of a state before the failure, or the failure again.
  lookBack(isBack) {
    if (!this.beyond) return;
    this.beyond.drawn = undefined, this.say('.busy', '');
    setText(this.find('.play'), isBack ? 'Play' : 'Replay');
    this.setLegend(...isBack ? strains : ways);
  }

  forget() {
    this.failed = this.broken = false, this.why = '', this.cure = null;
    this.say('.busy', ''), this.say('.says', '');
    this.beyond = null, clearTimeout(this.lookingBeyond);
    this.setLegend(...strains);
    if (this.camera) Object.assign(this.view.camera, this.camera);
    this.camera = null;
    this.showFailure(null), this.setPlaying(this.playing);
  }
  // From the last good state.
  goOn() {
    if (!this.failed) return;
    for (const plot of Object.values(plots)) plot.goOn();
    this.forget(), this.setPlaying(true);
  }
  fail({broken, readings}) {
    this.failed = true, this.broken = broken, this.setPlaying(false);
    this.find('.hint')?.remove();
    for (const plot of Object.values(plots))
      plot.good = readings ? readings.main.time : Infinity;
    this.showFailure({...this.sides[0].failure,
      remedy: 'looking for the cause ...'});
    // A slider that moves on may end it; meanwhile the thread has no time.
    this.lookingBeyond = setTimeout(() => {
      if (!broken) this.worker.postMessage(['beyond']);
      this.worker.postMessage(['explain']);
    }, 300);
  }
  applyCure() {
    const {method, share} = this.cure, s = this.settings;
    this.goOn(), s.method = method, s.share = share;
    this.ask(...requestOf('method')), this.ask(...requestOf('share'));
    showControls();
  }

  setLegend(...ends) {
    this.element.querySelectorAll('.strain span').forEach(
      (end, k) => setText(end, ends[k]));
  }

  // The motion beyond a failure: its steps, whose mesh is null if it stays.
  // Those in which nothing is seen to move are left out. Colors tell which way
  // a node moves: like the one that moves most, or the other way.
  showBeyond(frames) {
    if (!this.failed || frames.length < 2) return;
    let side = this.sides[0];
    for (const frame of frames) {
      frame.isNew = !!frame.mesh;
      side = frame.side = {...side, ...frame.mesh, hasGhost: true};
    }
    const start = frames[0].points;
    const last = frames.at(-1).points, way = last.map((a, i) => a - start[i]);
    const at = i => [...way.subarray(i, i + 3)];
    let most = 0, along = [0, 0, 1];
    for (let i = 0; i < way.length; i += 4) {
      const size = last[i + 3] > 0 ? Math.hypot(...at(i)) : 0;
      if (size > most) most = size, along = at(i).map(a => a / size);
    }
    for (const {points} of frames) {
      const moves = points.filter((_, i) => i % 4 === 3).map((_, n) => Vec.dot(
        along, [0, 1, 2].map(k => points[4 * n + k] - start[4 * n + k])));
      const largest = moves.reduce((a, b) => Math.max(a, Math.abs(b)), 1e-12);
      moves.forEach((a, n) => points[4 * n + 3] = 0.235 * (1 + Math.sign(a) *
        Math.sqrt(Math.abs(a) / largest)));
      points.largest = largest;
    }
    const first = frames.findIndex(f => f.points.largest > 0.002);
    frames.splice(1, Math.max(0, Math.min(first - 2, frames.length - 2)));
    this.beyond = {frames, moves: !isStill(), isNew: true};
    this.setPlaying(false), this.fitCamera(), this.changed();
    this.setLegend(...ways);
  }
  // Look obliquely at the last good state: at what moves then, and around it.
  fitCamera() {
    const {view, beyond} = this, {camera} = view;
    this.camera ??= {...camera};
    const {points, side} = beyond.frames[0], last = beyond.frames.at(-1).points;
    const at = i => [...points.subarray(4 * i, 4 * i + 3)];
    const ends = [...new Set(side.lines)], size = i => last[4 * i + 3] > 0
      ? Math.hypot(...[0, 1, 2].map(k => last[4 * i + k] - points[4 * i + k]))
      : 0;
    const worst = ends.reduce((a, b) => size(b) > size(a) ? b : a);
    // At least half of the cloth, which is about 1 m wide.
    const all = ends.filter(i => size(i) > 0.2 * size(worst) ||
      Math.hypot(...Vec.sub(at(i), at(worst))) < 0.35).map(at);
    const normal = [0, 0, 0], t = side.triangles;
    for (let k = 0; k < t.length; k += 3) {
      const [a, b, c] = [at(t[k]), at(t[k + 1]), at(t[k + 2])];
      Vec.cross(Vec.sub(b, a), Vec.sub(c, a)).forEach(
        (n, i) => normal[i] += n);
    }
    const {clientWidth, clientHeight} = this.canvas;
    const [columns, rows] = View.grid(this.sides.length);
    camera.lookObliquely(all, normal,
      clientWidth / columns / (clientHeight / rows));
  }
  // The sides to draw at a time [ms]. After a failure that is the motion beyond
  // it, interpolated linearly between two steps, over and over, in front of the
  // last good state. If nothing is to move by itself, its middle.
  sidesAt(now) {
    const {beyond, sides} = this;
    if (!beyond || this.timeline.past) return sides;
    beyond.from ??= now;
    let passed = beyond.moves ? now - beyond.from : playback / 2;
    if (passed > playback + pause) {
      passed = 0, beyond.from = now, beyond.moves = !isStill();
    }
    const {frames} = beyond, last = frames.length - 1;
    const at = Math.min(1, passed / playback) * last;
    const k = Math.min(Math.floor(at), last - 1);
    const {side, points} = frames[k], next = frames[k + 1];
    const shown = {...side, points: next.isNew ? points : points.map(
      (a, i) => a + (at - k) * (next.points[i] - a))};
    this.view.setSide(0, shown, beyond.drawn !== k), beyond.drawn = k;
    if (beyond.isNew) {
      this.view.ghost.setMesh(frames[0].side.triangles, frames[0].side.lines);
      this.view.ghost.setPoints(frames[0].points), beyond.isNew = false;
    }
    const slower = playback / 1e3 / (frames[last].time - frames[0].time);
    this.say('.busy',
      `beyond the failure, ${shortNumber(slower, 2)} times slower`);
    if (beyond.moves) this.changed();
    return [shown, ...sides.slice(1)];
  }

  // Cause, remedy and place; null hides them.
  showFailure(failure) {
    const {cure} = this, share = cure && shortNumber(cure.share);
    this.find('.cure').hidden = !cure;
    setText(this.find('.cure'), cure && cure.method !== this.settings.method
      ? `Apply the cure: ${cure.method}, dt / limit ${share}`
      : `Apply the cure: dt / limit ${share}`);
    const {cause = '', remedy = '', place = ''} = failure ?? {};
    this.say('.fault b', cause);
    setText(this.find('.fault span'),
      remedy && remedy[0].toUpperCase() + remedy.slice(1));
    setText(this.find('.place'), place);
  }
}
