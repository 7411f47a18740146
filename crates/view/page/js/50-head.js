// The top of the page: what was asked, with which settings, what a reader must know first, the largest values, what failed.
(page => {
  'use strict';
  const { data, numbers } = page,
    { el, section, button } = page.dom;
  const KINDS = { crossing: 'Crossings', static: 'Static cases', modes: 'Natural modes', rating: 'Ratings' };

  function tally() {
    const { total, ok, failed, missing } = data.jobs,
      parts = [`${numbers.count(ok)} of ${numbers.count(total)} ${total === 1 ? 'job' : 'jobs'} done`];
    if (failed) parts.push(`${numbers.count(failed)} failed`);
    if (missing) parts.push(`${numbers.count(missing)} missing`);
    return parts.join(', ');
  }

  function head() {
    const { study } = data;
    document.title = `${study.name} \u2013 pontoon report`;
    return el(
      'header',
      { class: 'top' },
      el('p', { class: 'kind' }, `${KINDS[study.kind] ?? study.kind} \u00b7 ${tally()}`),
      el('h1', {}, study.name),
      study.question && el('p', { class: 'question' }, study.question),
      (data.notes ?? []).length > 0 &&
        el(
          'ul',
          { class: 'notes', role: 'list', 'aria-label': 'Notes' },
          data.notes.map(note => el('li', { class: 'note' }, note)),
        ),
    );
  }

  /** A button that names a job and picks it. */
  const jobButton = job =>
    button(`job ${job}`, () => page.pick(job, 'card'), { class: 'job', 'aria-label': `Pick job ${job}` });

  function cards() {
    if (!(data.cards ?? []).length) return null;
    return section(
      'summary',
      'Largest values',
      el(
        'ul',
        { class: 'cards', role: 'list' },
        data.cards.map(card => {
          const shown = numbers.unit(card.unit, Math.abs(card.value ?? 0));
          return el(
            'li',
            { class: 'card', 'data-measure': card.measure },
            el('h3', {}, card.label),
            el(
              'p',
              { class: 'value', 'data-value': card.value },
              numbers.digits(card.value * shown.factor),
              shown.unit && el('span', { class: 'unit' }, shown.unit),
            ),
            card.where && el('p', { class: 'where' }, card.where),
            el(
              'p',
              { class: 'axes' },
              card.job !== null && card.job !== undefined && jobButton(card.job),
              card.axes && ` ${card.axes}`,
            ),
          );
        }),
      ),
    );
  }

  const capital = text => text.slice(0, 1).toUpperCase() + text.slice(1);

  /** A few values in a row, their unit once; what has no value comes last. */
  function few(axis, at) {
    const { unit } = page.axes.shown(at),
      some = axis.values.map((v, i) => (v === null ? null : page.axes.tick(at, i))).filter(v => v !== null);
    return (
      some.join(', ') +
      (unit && some.length ? numbers.THIN + unit : '') +
      (some.length < axis.values.length
        ? `${some.length ? ', ' : ''}${page.axes.name(at, axis.values.indexOf(null))}`
        : '')
    );
  }

  function settings() {
    const list = [...(data.study.settings ?? [])];
    for (const axis of data.axes ?? []) {
      const at = data.axes.indexOf(axis),
        there = axis.values.map((v, i) => (v === null ? -1 : i)).filter(i => i >= 0),
        n = there.length;
      if (axis.values.length < 1) continue;
      const text =
        axis.values.length === 1
          ? page.axes.name(at, 0)
          : n <= 8
            ? few(axis, at)
            : `${numbers.count(n)} ${axis.bins ? 'ranges' : 'values'}, ${page.axes.name(at, there[0])} to ${page.axes.name(at, there[n - 1])}${n < axis.values.length ? ', and none' : ''}`;
      list.push({ label: axis.label, value: text });
    }
    if (!list.length) return null;
    return section(
      'settings',
      'Settings',
      el(
        'dl',
        { class: 'pairs' },
        list.map(s => el('div', {}, el('dt', {}, capital(s.label)), el('dd', {}, s.value))),
      ),
    );
  }

  function failures() {
    if (!(data.failures ?? []).length) return null;
    return section(
      'failures',
      'Failed jobs',
      page.dom.scroller(
        'Failed jobs by cause',
        el(
          'table',
          { class: 'plain' },
          el(
            'thead',
            {},
            el(
              'tr',
              {},
              ['jobs', 'kind', 'reason', 'for example'].map(h => el('th', { scope: 'col' }, h)),
            ),
          ),
          el(
            'tbody',
            {},
            data.failures.map(f =>
              el(
                'tr',
                {},
                el('td', { class: 'number' }, numbers.count(f.count)),
                el('td', {}, (f.kind ?? '').replaceAll('_', ' ')),
                el('td', {}, f.reason),
                el('td', {}, jobButton(f.job)),
              ),
            ),
          ),
        ),
      ),
    );
  }

  page.head = { head, cards, settings, failures, jobButton };
})((globalThis.pontoon ??= {}));
