'use strict';
// A page of the site: its charts, its live figures, its list of contents.

const site = new URL('.', document.currentScript.src);
const unpacked = base64 => new Response(new Blob([Uint8Array.from(
  atob(base64), c => c.charCodeAt(0))]).stream().pipeThrough(
  new DecompressionStream('gzip')));

// Beside the text the list is open; above it, on a small screen, closed.
const contents = document.getElementById('contents');
const narrow = matchMedia('(max-width: 900px)');
const fold = () => { contents.open = !narrow.matches; };
narrow.addEventListener('change', fold), fold();
contents.querySelector('[aria-current]')?.scrollIntoView({block: 'nearest'});

for (const image of document.querySelectorAll('[data-gz]')) {
  unpacked(image.dataset.gz).arrayBuffer().then(text => {
    image.src = URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'}));
  });
}

// Search: the sections with words that begin with all of those asked for.
document.querySelector('.home').insertAdjacentHTML('afterend', `<search>
  <input type="search" aria-label="Search, key /" placeholder="Search (/)">
  <p role="status"></p><ul></ul></search>`);
const input = document.querySelector('search input');
const [told, found] = [input.nextElementSibling, input.parentElement.lastChild];
let sections;
function look() {
  const words = input.value.toLowerCase().match(/[a-z_0-9]{2,}/g) ?? [];
  const worth = ([, title, text]) => words.reduce((sum, word) => sum + (
    ` ${title.toLowerCase()}`.includes(` ${word}`) ? 9 : ` ${text} `.includes(
      ` ${word} `) ? 2 : ` ${text}`.includes(` ${word}`) ? 1 : -1e3), 0);
  const all = words.length && sections ? sections.map(s => [worth(s), s])
    .filter(([a]) => a > 0).sort(([a], [b]) => b - a) : [];
  told.textContent = !words.length || !sections ? ''
    : `${all.length || 'No'} section${all.length === 1 ? '' : 's'}`;
  found.replaceChildren(...all.slice(0, 12).map(([, [file, title]]) => {
    const line = document.createElement('li');
    const link = line.appendChild(document.createElement('a'));
    link.href = new URL(file, site), link.textContent = title;
    return line;
  }));
}
input.oninput = look;
input.addEventListener('focus', () => {
  const script = document.createElement('script');
  script.src = new URL('sections.js', site);
  script.onload = async () => {
    sections = await unpacked(self.sections).json(), look();
  };
  document.head.append(script);
}, {once: true});
addEventListener('keydown', e => {
  const links = [input, ...found.querySelectorAll('a')];
  const at = links.indexOf(document.activeElement);
  const step = {ArrowDown: 1, ArrowUp: -1}[e.key];
  if (at >= 0 && step) links[at + step]?.focus();
  else if (e.key === '/' && !e.target.matches('input, select')) input.focus();
  else if (at === 0 && e.key === 'Enter') links[1]?.click();
  else if (at >= 0 && e.key === 'Escape')
    input.value = '', look(), input.focus();
  else return;
  e.preventDefault();
});

// On a phone a table of sentences is a list of cells, each with the name of its
// column. Keys scroll elements that are wider than the page.
for (const {tHead, tBodies} of document.querySelectorAll('.wide table'))
  for (const {cells} of tBodies[0].rows)
    [...cells].slice(1).forEach((cell, k) => {
      cell.dataset.of = tHead?.rows[0].cells[k + 1]?.innerText ?? '';
    });
const scroll = () => {
  for (const wide of document.querySelectorAll('.wide')) {
    wide.classList.remove('list');
    wide.classList.toggle('list', innerWidth <= 480 && [
      ...wide.querySelectorAll('tr')].some(row => row.offsetHeight > 170));
  }
  for (const e of document.querySelectorAll('.wide, pre, main p, main li'))
    if (e.scrollWidth > e.clientWidth) e.tabIndex = 0;
    else e.removeAttribute('tabindex');
};
addEventListener('resize', scroll), scroll();

// How another page shows the same figure.
function embedding(name) {
  const address = new URL('embed.html', document.currentScript.src);
  address.search = `scene=${name}&controls=none`;
  const details = document.createElement('details');
  details.className = 'embed';
  details.innerHTML = '<summary>Embed this figure</summary><pre></pre>';
  details.querySelector('pre').textContent = `<iframe src="${address}" ` +
    'title="A cloth of masses and springs" width="640" height="400"></iframe>';
  return details;
}

// A figure, and below it the lines that the chosen mistake changes.
for (const element of document.querySelectorAll('.live')) {
  const name = element.dataset.scene;
  const shown = figure(element, self.scenes[name]);
  const edits = document.querySelectorAll(`.edit[data-of="${name}"]`);
  const choose = k => edits.forEach(edit => {
    edit.hidden = edit.dataset.name !== shown.names[k];
  });
  element.querySelectorAll('.switch button').forEach((button, k) =>
    button.addEventListener('click', () => choose(k)));
  choose(shown.choice);

  if (name === 'drag') shown.hint();
  ([...edits].at(-1) ?? element).after(embedding(name));
}
