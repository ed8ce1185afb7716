'use strict';
// A page of the site: its charts, its live figures, its list of contents.

// Beside the text the list is open; above it, on a small screen, closed.
const contents = document.getElementById('contents');
const narrow = matchMedia('(max-width: 900px)');
const fold = () => { contents.open = !narrow.matches; };
narrow.addEventListener('change', fold), fold();
contents.querySelector('[aria-current]')?.scrollIntoView({block: 'nearest'});

for (const image of document.querySelectorAll('[data-gz]')) {
  const bytes = Uint8Array.from(atob(image.dataset.gz), c => c.charCodeAt(0));
  const chart = new Response(new Blob([bytes]).stream().pipeThrough(
    new DecompressionStream('gzip')));
  chart.arrayBuffer().then(text => {
    image.src = URL.createObjectURL(new Blob([text], {type: 'image/svg+xml'}));
  });
}

// Keys scroll elements that are wider than the page.
const scroll = () => {
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
