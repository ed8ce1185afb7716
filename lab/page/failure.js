'use strict';
// When a run fails, the page shows the motion beyond the failure, the reason
// and the cure, and goes on from the last good state.

const playback = 2000;  // [ms], of the motion beyond a failure

function forget() {
  page.failed = page.broken = false, page.why = '', page.cure = null;
  if (page.beyond) setText($('busy'), '');
  page.beyond = null, clearTimeout(page.lookingBeyond), showFailure(null);
}
// From the last good state.
function goOn() {
  if (!page.failed) return;
  for (const plot of Object.values(plots)) plot.goOn();
  forget(), setPlaying(true);
}
function fail({broken, readings}) {
  page.failed = true, page.broken = broken, setPlaying(false);
  for (const plot of Object.values(plots))
    plot.good = readings ? readings.main.time : Infinity;
  showFailure({...page.sides[0].failure, remedy: 'looking for the cause ...'});
  // A slider that moves on may end it; meanwhile the thread has no time.
  page.lookingBeyond = setTimeout(() => {
    if (!broken) page.worker.postMessage(['beyond']);
    page.worker.postMessage(['explain']);
  }, 300);
}
function applyCure() {
  const {method, share} = page.cure, s = page.settings;
  goOn(), s.method = method, s.share = share;
  page.ask(...requestOf('method')), page.ask(...requestOf('share'));
  showControls();
}

// The sides to draw at a time [ms]. After a failure that is the motion beyond
// it, interpolated linearly between two steps.
function sidesAt(now) {
  const {beyond} = page;
  if (!beyond) return page.sides;
  beyond.from ??= isStill() && !beyond.seen ? now - playback : now;
  beyond.seen = true;
  const {frames} = beyond, last = frames.length - 1;
  const at = Math.min(1, (now - beyond.from) / playback) * last;
  const k = Math.min(Math.floor(at), last - 1);
  if (at >= last) {
    setText($('busy'), '');
    if (beyond.drawn !== undefined) page.view.setSide(0, page.sides[0]);
    beyond.drawn = undefined;
    return page.sides;
  }
  setText($('busy'), `beyond the failure, ${shortNumber(Number((playback / 1e3 /
    (frames[last].time - frames[0].time)).toPrecision(2)))} times slower`);
  const {points} = frames[k], next = frames[k + 1].points;
  const side = {...page.sides[0], ...frames[k].mesh, failedNode: -1,
    points: frames[k + 1].newMesh ? points : points.map(
      (a, i) => a + (at - k) * (next[i] - a))};
  page.view.setSide(0, side, beyond.drawn !== k), beyond.drawn = k;
  page.changed();
  return [side, ...page.sides.slice(1)];
}

// Cause, remedy and place in the words of ./cloth, whose options are sliders
// here; null hides them.
function showFailure(failure) {
  const {cure} = page, share = cure && shortNumber(cure.share);
  $('cure').hidden = !cure;
  setText($('cure'), cure && cure.method !== page.settings.method
    ? `Apply the cure: ${cure.method}, dt / limit ${share}`
    : `Apply the cure: dt / limit ${share}`);
  $('failure').hidden = !failure;
  const {title, diverged, cause = '', remedy = '', place = ''} = failure ?? {};
  $('failure').querySelector('h2').textContent =
    title ?? (diverged ? 'It diverged' : 'It failed');
  setText($('words'), [cause, remedy].filter(Boolean).join('; ')
    .replace(/--dt (\S+)/g, 'dt = $1 s')
    .replace(/--method (\S+)/g, 'method $1'));
  setText($('place'), place);
}
