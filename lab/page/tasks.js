'use strict';
// Tasks for a class: a guess, answered by its run, or something to be done.

const lasts = 3;  // [s], what counts as holding
const holds = ['It holds', 'It explodes'];
const holding = ({time, failed}) => failed ? 1 : time >= lasts ? 0 : null;
// How many nodes the largest piece of a cloth has, and the second.
function pieces({lines}) {
  const up = new Map(), top = i => {
    while (up.get(i) !== i) up.set(i, up.get(up.get(i))), i = up.get(i);
    return i;
  };
  for (const i of lines) up.set(i, i);
  for (let k = 0; k < lines.length; k += 2)
    up.set(top(lines[k]), top(lines[k + 1]));
  const sizes = new Map();
  for (const i of up.keys()) sizes.set(top(i), (sizes.get(top(i)) ?? 0) + 1);
  return [...sizes.values(), 0].sort((a, b) => b - a);
}

// asks; settings of its run, from `usual`; why: told at the end.
// A guess has answers, and found(look): the right one, or null as yet.
// A deed has look(look): true once it is done, or a text: what was missed.
const tasks = [
  {asks: 'Verlet with a step of 1.3 times its limit: does it hold for 3 s?',
    settings: {share: 1.3}, answers: holds, found: holding,
    why: 'Beyond the limit the fastest wave of the springs grows in every ' +
      'step, as soon as the cloth has the shape for it.'},
  {asks: 'Verlet with only 1.05 times its limit?',
    settings: {share: 1.05}, answers: holds, found: holding,
    why: 'The limit is that of small swings about the worst shape. This ' +
      'cloth, in its own, may go beyond: the second number below the slider.'},
  {asks: 'Drag the cloth until a spring is a fifth longer than at rest.',
    settings: {},
    look: ({r, side: {points}}) => r.grabbed &&
      points.some((a, i) => i % 4 === 3 && a > 0.2),
    why: 'A spring pulls with K times its stretch: the redder, the harder.'},
  {asks: 'Find the step: keep this cloth alive for 3 s with at least 1.15 ' +
      'times the limit.',
    settings: {share: 1.3}, look: ({time, failed, share}) => time >= lasts &&
      !failed && (share >= 1.145 ||
      `It held, but with ${shortNumber(share)}. Restart.`),
    why: 'It ends near 1.2. A rule for the worst shape gives away a fifth ' +
      'here.'},
  {asks: 'K becomes four times as large. The largest stable step becomes ...',
    settings: {stiffness: 400, share: 0.4},
    answers: ['a quarter', 'half', 'the same'], found: () => 1,
    why: 'The limit is 2 / \u03c9, and \u03c9 grows as the root of K / m.'},
  {asks: 'Implicit Euler with 20 times Verlet\u2019s limit: does it hold?',
    settings: {method: 'implicit-euler', share: 20}, answers: holds,
    found: holding,
    why: 'Small swings have no limit with it. It pays by damping: ' +
      'this cloth falls too softly.'},
  {asks: 'Implicit midpoint with 20 times Verlet\u2019s limit?',
    settings: {method: 'implicit-midpoint', share: 20}, answers: holds,
    found: holding, why: 'It has no limit for small swings either, and damps ' +
      'nothing: once the cloth buckles, the fast waves grow.'},
  {asks: 'How slow is implicit Euler? Find the step with which the cloth, at ' +
      '0.8 s, swings 10 % (8 to 12) slower than by Verlet beside it.',
    settings: {method: 'implicit-euler', share: 1, rivals: ['verlet'],
      isEqual: false, rivalShare: 0.5},
    look: ({time, r, method}) => {
      if (time < 0.8 || method !== 'implicit-euler' || !r.rivals.length)
        return false;
      const less = 100 * (1 - Math.sqrt(
        r.main.kinetic / r.rivals[0].kinetic));
      return Math.abs(less - 10) <= 2 || `At 0.8 s it is ${
        shortNumber(less, 2)} % slower. Choose another step, and Restart.`;
    },
    why: 'Its damping grows with the step: an error that looks like physics.'},
  {asks: 'Soft springs, strong gravity, no drag, and Verlet at 0.9 of its ' +
      'limit: does it hold for 4 s?',
    settings: {stiffness: 30, gravity: 30, drag: 0, share: 0.9},
    answers: holds, found: ({time, failed}) => failed ? 1
      : time >= 4 ? 0 : null,
    why: 'The limit is one of small swings. Large ones change the ' +
      'springs\u2019 stiffness as they go, and feed fast waves below it. ' +
      'With half of this step the cloth holds.'},
  {asks: 'Four methods at equal work: whose error is least after 1 s?',
    settings: {share: 0.3, rivals: ['rk4', 'symplectic-euler', 'xpbd']},
    answers: ['verlet', 'rk4', 'symplectic-euler', 'xpbd'],
    found: ({time, r}) => {
      if (time < 1 || r.rivals.length < 3) return null;
      const errors = [r.error, ...r.rivals.map(a => a.error)];
      return errors.indexOf(Math.min(...errors));
    },
    why: 'An order is worth something only once the step is small enough for ' +
      'it: slow down, and look at the distances to the fine run.'},
  {asks: 'Keep this cloth alive for 3 s with at most 1,150 force evaluations ' +
      'of work: any method, any step.',
    settings: {share: 0.5}, look: ({time, failed, r}) => time >= lasts &&
      !failed && (r.main.work <= 1150 ||
      `It held, with ${shortNumber(r.main.work, 4)}. Restart with another.`),
    why: 'Alive is not right: race your choice with Verlet at half its limit.'},
  {asks: 'Cut the cloth into two pieces of 100 nodes or more.',
    settings: {}, tool: 'cut', look: ({r, side}) => r.tornEdges > 0 &&
      pieces(side)[1] >= 100,
    why: 'A cut removes springs, and nothing else: the forces on both rims ' +
      'change at once, the positions do not.'},
];

class Tasks {
  constructor() {
    this.done = new Set(), this.number = 0;
    tasks.forEach((task, k) => {
      task.tick = document.createElement('button');
      task.tick.onclick = () => this.choose(k);
      $('ticks').append(task.tick);
    });
    this.choose(0);
  }
  get task() { return tasks[this.number]; }
  choose(number) {
    this.number = number, this.guess = this.isOn = null;
    this.say(this.task.asks, this.task.answers ?? ['Begin']);
  }
  say(words, answers) {
    setText($('task'), `${this.number + 1}. ${words}`);
    $('answers').replaceChildren(...answers.map((text, k) => {
      const button = document.createElement('button');
      button.textContent = text, button.onclick = () => this.take(k, text);
      return button;
    }));
    tasks.forEach(({tick}, k) => {
      const done = this.done.has(k);
      setText(tick, done ? '\u2713' : String(k + 1));
      tick.ariaLabel = `Task ${k + 1}${done ? ', done' : ''}`;
      tick.setAttribute('aria-current', k === this.number);
    });
  }
  // Run the cloth of the task; or go on to the next one.
  take(answer, text) {
    if (text === 'Next') return this.choose((this.number + 1) % tasks.length);
    const {settings, tool = 'grab', answers, asks} = this.task;
    page.speed = 1, begin(settings);
    page.use(tool);
    this.isOn = true, this.guess = answers ? answer : null;
    this.say(answers ? `You say: ${text}. Let us see ...` : asks, []);
  }
  // Another run was started: a guess is about its own; a deed is tried again.
  cancel() { if (this.guess !== null) this.choose(this.number); }
  // After each frame.
  look(look) {
    if (!this.isOn) return;
    const {asks, answers, found, look: see, why} = this.task;
    if (answers) {
      const right = found(look);
      if (right === null) return;
      const isRight = right === this.guess;
      this.end(`${isRight ? 'Right' : 'No'}: ${answers[right]}. ${why}`);
    } else {
      const done = this.told !== page.run && see(look);
      if (done) this.told = page.run;  // once a run
      if (done === true) this.end(`Done. ${why}`);
      else if (done) setText($('task'), `${this.number + 1}. ${asks} ${done}`);
    }
  }
  end(words) {
    this.done.add(this.number), this.guess = this.isOn = null;
    this.say(words, ['Next']);
  }
}
