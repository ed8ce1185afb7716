'use strict';
// When a run fails, the page shows the motion beyond the failure, the reason
// and the cure, and goes on from the last good state.

const playback = 2000;  // [ms], of the motion beyond a failure
const inMs = seconds => `${shortNumber(1e3 * seconds)} ms`;
// The words of ./cloth, whose options are sliders here.
const inPage = words => words.replace(/^diverged: /, '')
  .replace(/--method (\S+) --dt (\S+)/g,
    (_, method, dt) => `${method} with a step of ${inMs(dt)}`)
  .replace(/--dt (\S+)/g, (_, dt) => `a step of ${inMs(dt)}`)
  .replace(/^[a-z]/, letter => letter.toUpperCase());

class FailurePicture extends Picture {
  constructor(...all) {
    super(...all);
    Object.assign(this, {failed: false, why: '', cure: null,
      broken: false,         // no request can make it go on
      beyond: null});        // the motion after a failure: frames, since when
    this.find('.fault').insertAdjacentHTML('beforeend', `<p class="place"></p>
      <button class="cure" hidden></button>
      <button class="dismiss" aria-label="Close">&times;</button>`);
    const close = () => this.showFailure(null);
    this.find('.dismiss').onclick = close;
    this.find('.cure').onclick = () => this.applyCure();
    addEventListener('keydown', e => { if (e.key === 'Escape') close(); });
  }
  get isMoving() {
    return this.isRunning || this.beyond?.drawn !== undefined;
  }
  // After a failure: show it again.
  play() {
    if (this.beyond) this.beyond.from = undefined, this.changed();
    else if (this.failed) this.restart();
    else super.play();
  }
  setPlaying(on) {
    super.setPlaying(on);
    if (this.beyond) setText(this.find('.play'), 'Replay');
  }

  forget() {
    this.failed = this.broken = false, this.why = '', this.cure = null;
    this.say('.busy', ''), this.say('.says', '');
    this.beyond = null, clearTimeout(this.lookingBeyond);
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

  // The motion beyond a failure: its steps, whose mesh is null if it stays.
  showBeyond(frames) {
    if (!this.failed || frames.length < 2) return;
    let side = this.sides[0];
    for (const frame of frames) {
      frame.isNew = !!frame.mesh;
      side = frame.side = {...side, ...frame.mesh, points: frame.points,
        failedNode: -1};
    }
    this.beyond = {frames}, this.setPlaying(false), this.changed();
  }
  // The sides to draw at a time [ms]. After a failure that is the motion beyond
  // it, interpolated linearly between two steps.
  sidesAt(now) {
    const {beyond, sides} = this;
    if (!beyond) return sides;
    beyond.from ??= isStill() && !beyond.seen ? now - playback : now;
    beyond.seen = true;
    const {frames} = beyond, last = frames.length - 1;
    const at = Math.min(1, (now - beyond.from) / playback) * last;
    const k = Math.min(Math.floor(at), last - 1);
    if (at >= last) {
      this.say('.busy', '');
      if (beyond.drawn !== undefined) this.view.setSide(0, sides[0]);
      beyond.drawn = undefined;
      return sides;
    }
    this.say('.busy', `beyond the failure, ${shortNumber(playback / 1e3 /
      (frames[last].time - frames[0].time), 2)} times slower`);
    const {side} = frames[k], next = frames[k + 1];
    const shown = {...side, points: next.isNew ? side.points : side.points.map(
      (a, i) => a + (at - k) * (next.points[i] - a))};
    this.view.setSide(0, shown, beyond.drawn !== k), beyond.drawn = k;
    this.changed();
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
    this.say('.fault p', inPage([cause, remedy].filter(Boolean).join('; ')));
    setText(this.find('.place'), place);
  }
}
