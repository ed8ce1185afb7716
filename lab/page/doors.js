'use strict';
// An invitation: eight ways to begin, each a button with its picture, drawn by
// the engine from the run that the button starts.

const usual = {scene: 'forces', side: 25, method: 'verlet', share: 0.5,
  rivals: [], isEqual: true};
// settings; tool: of the hand; task: to begin with; at: steps of the picture
const doors = [
  {title: 'Hang', at: 420},
  {title: 'Fall', settings: {scene: 'constraints'}, at: 330},
  {title: 'Tear', settings: {scene: 'tear'}, at: 450},
  {title: 'Cut', settings: {scene: 'curtain'}, tool: 'cut', at: 150},
  {title: 'Break it', settings: {share: 1.3}, at: 300},
  {title: 'Too soft', settings: {method: 'implicit-euler', share: 20,
    rivals: ['verlet'], isEqual: false, rivalShare: 0.5}, at: 8},
  {title: 'Race', settings: {share: 0.3, rivals: ['rk4', 'symplectic-euler',
    'xpbd']}, at: 200},
  {title: 'Your step', at: 220, says: 'Write a step of your own: make web ' +
    'makes a page like this of your code, make try FILE=mine.hpp says what ' +
    'it is worth.'},
];

class Doors {
  constructor(bytes) {
    for (const door of doors) {
      door.button = document.createElement('button');
      door.button.innerHTML = '<canvas width="144" height="100" ' +
        `aria-hidden="true"></canvas><span>${door.title}</span>`;
      door.button.onclick = () => this.enter(door);
      $('doors').append(door.button);
    }
    this.bytes = bytes, this.run = 0;
  }
  enter({settings, tool = 'grab', says = ''}) {
    begin(settings);
    page.use(tool), page.say('.says', says);
    page.canvas.focus({preventScroll: true});
  }

  // One after the other, by a thread of its own that ends after the last.
  draw() {
    const view = new View(document.createElement('canvas'));
    const left = [...doors], replies = {
      about: () => next(), history() {}, repeating() {},
      error: ({text}) => page.errors.push(text),
      setting: ({setting}) => {
        view.obstacles = setting.obstacles, this.room = setting.room;
      },
      frame: ({sides, failed}) => {
        if (failed) return worker.postMessage(['beyond']);
        done(sides.map(({mesh, ...side}) => ({...side, ...mesh})));
      },
      beyond: ({frames}) => {
        const all = frames.map(({points, mesh}) => ({points, ...mesh}));
        const {points} = all[Math.floor(0.7 * all.length)];
        done([{...all[0], points}], 0.7);
      },
    };
    const worker = startThread($('worker').textContent, this, replies,
      text => page.errors.push(text));
    const done = (sides, pitch = 0.25) => {
      view.camera.pitch = pitch;
      this.paint(view, left.shift().button.firstChild, sides);
      left.length ? next() : worker.terminate();
    };
    const next = () => {
      const {settings, at} = left[0];
      const s = {...usual, ...settings, side: 15};
      ++this.run;
      worker.postMessage(['start', {side: s.side, end: at,
        lines: startLines(s).map(([, text]) => [0, text]),
        scene: page.about.scenes.findIndex(a => a.name === s.scene)}]);
    };
    worker.postMessage(['module', this.bytes], [this.bytes]);
  }
  paint(view, canvas, sides) {
    sides.forEach((side, k) => view.setSide(k, side));
    view.camera.lookAt(this.room.length ? this.room : spaceOf(sides[0]));
    view.camera.zoom = 1.15;
    view.size = [canvas.width, canvas.height];
    view.draw(sides, page.theme, null);
    canvas.getContext('2d').drawImage(view.canvas, 0, 0);
  }
}
