'use strict';
// The states that were shown: a slider shows an earlier one, and the run goes
// on from there. And what is shown as a picture or a film, to be saved.

class Timeline {
  constructor(page) {
    this.page = page, this.clear();
    page.find('.tools').insertAdjacentHTML('beforebegin', `<label
      class="time slider"><span>Time</span> <input type="range" id="time"
      min="0" max="0" value="0"> <output></output></label>`);
    this.input = $('time');
    this.input.oninput = () => this.show(Number(this.input.value));
  }
  // at: which one is shown, if that is not the last
  clear() {
    this.states = [], this.count = -1, this.stride = 1, this.at = null;
  }
  get past() { return this.states[this.at] ?? null; }
  get last() { return this.states.at(-1); }

  // Keep {sides, readings, calls}: of the whole run, in up to 60 MB, every
  // frame, every second one, every fourth one ..., and the last one.
  add(state) {
    const {states} = this;
    if (state.calls === this.last?.calls) states.pop();
    else if (this.count++ % this.stride) states.pop();
    states.push(state);
    const size = state.sides.reduce((a, {points}) => a + points.byteLength, 0);
    if (states.length <= Math.max(2, Math.min(600, 6e7 / size))) return;
    this.states = states.filter((_, k) =>
      k % 2 === 0 || k === states.length - 1);
    this.stride *= 2;
  }
  show(at) {
    const {page} = this, isLast = at >= this.states.length - 1;
    if (this.at === null && !isLast) page.hand.release();
    this.at = isLast ? null : at;
    if (page.playing) page.setPlaying(false);
    const {sides, readings} = this.past ?? this.last;
    page.readings = readings, page.lookBack(!isLast), page.wanted = isLast;
    page.show(sides.map(side => ({...side, isNew: true})));
    for (const plot of Object.values(plots))
      plot.at = isLast ? undefined : readings.main.time;
    this.tell();
  }
  tell() {
    const all = this.states.length - 1;
    this.input.max = all, this.input.value = this.at ?? all;
    const {time} = this.page.readings?.main ?? {time: 0};
    tellValue(this.input, `${time.toFixed(2)} s`);
  }
  // From the state that is shown, whose steps are repeated to the same bits.
  goOn() {
    const {page, past, at} = this;
    if (!past) return;
    this.at = null, this.states.length = at + 1;
    const {states, stride} = this;
    page.start(null, past.calls);
    Object.assign(this, {states, stride, count: stride * at});
    if (!page.hand.grabbed) page.ask('release');
  }
}

function save(blob, ending) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = `mass_spring-${page.settings.scene}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
}

class Camcorder {
  constructor() {
    $('picture').onclick = () => { this.isAsked = true, page.changed(); };
    $('film').onclick = () => this.recorder ? this.recorder.stop()
      : this.record();
  }
  // The picture with its words, and below it which run it shows.
  copy(to) {
    const {canvas, readings: {main}, failed, timeline} = page, bar = 30;
    const width = canvas.clientWidth & ~1, height = canvas.clientHeight & ~1;
    if (to.width !== width) to.width = width;
    if (to.height !== height + bar) to.height = height + bar;
    const g = to.getContext('2d'), css = getComputedStyle(page.element);
    g.fillStyle = css.backgroundColor, g.fillRect(0, 0, width, height + bar);
    g.drawImage(canvas, 0, 0, width, height);
    const {left, top} = canvas.getBoundingClientRect();
    const legend = page.find('.strain i').getBoundingClientRect();
    const x0 = legend.x - left, x1 = x0 + legend.width;
    g.fillStyle = g.createLinearGradient(x0, 0, x1, 0);
    [page.theme.cloth[0], page.theme.stretched].forEach((color, k) =>
      g.fillStyle.addColorStop(k, `rgb(${color.slice(0, 3).map(
        a => 255 * a)})`));
    g.fillRect(x0, legend.y - top, x1 - x0, legend.height);
    g.textBaseline = 'top';
    for (const e of page.element.querySelectorAll(
      '.name span, .name small, .busy, .strain span')) {
      const {x, y, width} = e.getBoundingClientRect(), s = getComputedStyle(e);
      g.fillStyle = s.color;
      g.font = `${s.fontWeight} ${s.fontSize} sans-serif`;
      if (width) g.fillText(e.innerText, x - left, y - top, width);
    }
    const words = failed && !timeline.past
      ? page.find('.fault b').innerText : scene().title;
    g.fillStyle = css.color, g.font = '14px sans-serif';
    g.fillText(`${main.method}, dt ${inMs(main.dt)}, t = ${
      main.time.toFixed(2)} s: ${words}`, 8, height + 8, width - 16);
  }
  // After the picture was drawn.
  drawn() {
    if (this.isAsked) {
      const to = document.createElement('canvas');
      this.isAsked = false, this.copy(to);
      to.toBlob(blob => save(blob, 'png'));
    }
    if (this.recorder) this.copy(this.canvas), page.changed();
  }
  // A film of what is shown, until the next click, for a minute at most.
  record() {
    const canvas = this.canvas = document.createElement('canvas');
    const kind = ['video/mp4', 'video/webm'].find(
      kind => self.MediaRecorder?.isTypeSupported(kind));
    const not = () => page.say('.says', 'This browser cannot record a film. ' +
      'Picture works, and so does the recorder of your screen.');
    if (!kind || !canvas.captureStream) return not();
    const parts = [];
    this.copy(canvas);
    this.recorder = new MediaRecorder(canvas.captureStream(30),
      {mimeType: kind, videoBitsPerSecond: 5e6});
    this.recorder.ondataavailable = ({data}) => parts.push(data);
    const end = setTimeout(() => this.recorder.stop(), 6e4);
    this.recorder.onstop = () => {
      clearTimeout(end), this.recorder = null;
      setText($('film'), 'Film');
      const film = new Blob(parts, {type: kind});
      film.size ? save(film, kind.slice(6)) : not();  // without an encoder
    };
    this.recorder.start(), setText($('film'), 'Stop film'), page.changed();
  }
}
