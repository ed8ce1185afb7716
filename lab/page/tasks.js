'use strict';
// An invitation: guesses whether a cloth holds, each of which its run answers.

const tasks = [
  {method: 'verlet', share: 1.3, asks: 'a step of 1.3 times its limit',
    why: 'Beyond the limit the fastest wave of the springs grows in every ' +
      'step, as soon as the cloth has the shape for it.'},
  {method: 'verlet', share: 1.05, asks: 'only 1.05 times its limit',
    why: 'The limit counts for every shape. This cloth, in its own, may go a ' +
      'little beyond: the second number below the slider.'},
  {method: 'implicit-euler', share: 20, asks: '20 times Verlet\u2019s limit',
    why: 'Implicit Euler has no limit. It pays by damping: this cloth falls ' +
      'too softly.'},
  {method: 'implicit-midpoint', share: 20, asks: '20 times Verlet\u2019s limit',
    why: 'It has no limit for small swings either, and damps nothing: once ' +
      'the cloth buckles, the fast waves grow.'},
];
const lasts = 3;  // [s], what counts as holding

class Tasks {
  constructor() {
    this.number = this.right = 0, this.guess = null;
    for (const name of ['holds', 'explodes'])
      $(name).onclick = () => this.take(name);
    $('next').onclick = () => {
      this.number = (this.number + 1) % tasks.length;
      if (this.number === 0) this.right = 0;
      this.ask();
    };
    this.ask();
  }
  say(words, done) {
    setText($('task'), words);
    $('holds').hidden = $('explodes').hidden = done || !!this.guess;
    $('next').hidden = !done;
    setText($('next'), this.number + 1 < tasks.length ? 'Next' : 'Once more');
  }
  ask() {
    const {method, asks} = tasks[this.number];
    this.guess = null;
    this.say(`${this.number ? '' : 'Drag the cloth. Then guess: '}${
      this.number + 1} of ${tasks.length}: does it hold for ${lasts} s by ${
      method} with ${asks}?`);
  }
  // Run the cloth of the task.
  take(guess) {
    const {method, share} = tasks[this.number];
    forgetParameters();
    page.speed = 1;
    Object.assign(page.settings, {scene: 'forces', side: 25, drag: 0.003,
      rival: '', method, share});
    page.restart(), this.guess = guess;
    this.say(`You say that it ${guess}. Let us see ...`);
  }
  // Another run was started, or this one is at a time [s], or failed.
  cancel() { if (this.guess) this.ask(); }
  look(time, failed) {
    if (!this.guess || !failed && !(time >= lasts)) return;
    const found = failed ? 'explodes' : 'holds';
    const isRight = found === this.guess;
    this.right += isRight, this.guess = null;
    this.say(`${isRight ? 'Right' : 'No'}: it ${found}. ${
      tasks[this.number].why} (${this.right} of ${this.number + 1} right)`,
    true);
  }
}
