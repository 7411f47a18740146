// Puts the page together: sections that have something to show, the table of contents, the colour scheme, what paper needs.
(page => {
  'use strict';
  const { data } = page,
    { el, field, select } = page.dom;

  function contents(sections) {
    const links = sections.map(s => el('li', {}, el('a', { href: `#${s.id}` }, s.querySelector('h2').textContent)));
    const scheme = select(
      [
        ['', 'as the system'],
        ['light', 'light'],
        ['dark', 'dark'],
      ],
      '',
      v => {
        if (v) document.documentElement.dataset.theme = v;
        else delete document.documentElement.dataset.theme;
      },
    );
    scheme.id = 'scheme';
    const list = el('details', { class: 'toc', open: true }, el('summary', {}, 'Contents'), el('ul', {}, links));
    if (matchMedia('(max-width: 1099px)').matches) list.open = false;
    const nav = el(
      'nav',
      { class: 'side', 'aria-label': 'Contents' },
      el('p', { class: 'brand' }, 'pontoon'),
      list,
      field('Colours', scheme),
    );
    const seen = new IntersectionObserver(
      entries =>
        entries.forEach(entry => {
          const link = links[sections.indexOf(entry.target)].firstChild;
          if (entry.isIntersecting) link.setAttribute('aria-current', 'true');
          else link.removeAttribute('aria-current');
        }),
      { rootMargin: '-20% 0px -60% 0px' },
    );
    sections.forEach(s => seen.observe(s));
    return nav;
  }

  function nothing() {
    if (data.study.kind === 'modes' || data.jobs.ok > 0) return null;
    return page.dom.section(
      'nothing',
      'No results',
      el(
        'p',
        { class: 'empty' },
        data.jobs.failed
          ? `All ${data.jobs.failed} jobs that ran failed: there is no chart to draw.`
          : 'No job is done yet: there is no chart to draw.',
      ),
    );
  }

  const some = data.jobs.ok > 0 && data.study.kind !== 'modes';
  const sections = [
    page.classes(),
    page.head.cards(),
    nothing(),
    page.exceedance(),
    page.head.settings(),
    page.head.failures(),
    some && page.speed(),
    some && page.heatmap(),
    some && page.envelope(),
    page.histories(),
    page.frequencies(),
    page.jobs(),
    page.modes(),
    page.verdicts(),
    page.provenance(),
  ].filter(Boolean);
  document
    .getElementById('page')
    .replaceChildren(
      el(
        'div',
        { class: 'layout' },
        contents(sections),
        el('main', { id: 'main', tabindex: '-1' }, page.head.head(), sections),
      ),
      el('footer', { class: 'foot' }, `pontoon ${data.program.version}`),
    );
  page.figures.forEach(figure => figure.redraw());

  // A first pick, so that nothing is empty: the deepest job that can be played, else the deepest with a row.
  const best = (data.cards ?? []).map(c => c.job).filter(job => job !== null && job !== undefined),
    played = new Set((data.plays ?? []).map(p => p.job));
  const first =
    best.find(job => played.has(job)) ?? data.plays?.[0]?.job ?? best.find(job => page.rowOf(job) >= 0) ?? null;
  if (first !== null) page.pick(first, 'start');

  // Paper: everything open and at rest.
  const PAPER = 660;
  let frozen = false;
  const freeze = () => {
    if (frozen) return;
    frozen = true;
    page.paperWidth = PAPER;
    page.figures.forEach(figure => figure.redraw());
    page.paper.forEach(p => p.freeze());
  };
  const thaw = () => {
    if (!frozen) return;
    frozen = false;
    page.paperWidth = null;
    page.figures.forEach(figure => figure.redraw());
    page.paper.forEach(p => p.thaw());
  };
  addEventListener('beforeprint', freeze);
  addEventListener('afterprint', thaw);
  matchMedia('print').addEventListener('change', event => (event.matches ? freeze() : thaw()));
  page.ready = true;
})((globalThis.pontoon ??= {}));
