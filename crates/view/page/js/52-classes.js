// Which vehicle may cross how: vehicles against types of crossing, a crossing a cell. Knows no vehicle and no type.
(page => {
  'use strict';
  const { data, numbers, limits } = page,
    { el, section, scroller } = page.dom;

  // What may come of a crossing: its sign, its word and, for the legend, what it means. Colour is never alone.
  const OUTCOMES = {
    passes: ['\u2713', 'passes', 'all limits hold'],
    exceeds: ['\u2717', 'exceeds a limit', 'the crossing is not allowed'],
    failed: ['?', 'failed', 'the program could not solve the crossing'],
    none: ['\u2013', 'not asked', 'the study has no such crossing'],
  };
  const outcome = cell =>
    !cell ? 'none' : cell.utilisation === null ? 'failed' : cell.utilisation <= 1 ? 'passes' : 'exceeds';

  /** Two decimals, and as many more as tell what exceeds its limit from what is at it. */
  function write(utilisation) {
    if (utilisation >= 100) return numbers.digits(utilisation, 3);
    let decimals = 2;
    while (utilisation > 1 && decimals < 8 && Number(utilisation.toFixed(decimals)) === 1) decimals++;
    return utilisation.toFixed(decimals);
  }

  const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

  /** The button of the next crossing in a direction, or nothing. */
  function next(button, [dx, dy]) {
    const cell = button.closest('td'),
      at = cell.cellIndex,
      step = td => (dx > 0 ? td.nextElementSibling : td.previousElementSibling),
      line = tr => (dy > 0 ? tr.nextElementSibling : tr.previousElementSibling);
    for (
      let td = dx ? step(cell) : line(cell.parentElement)?.cells[at];
      td;
      td = dx ? step(td) : line(td.parentElement)?.cells[at]
    ) {
      const found = td.querySelector('button');
      if (found) return found;
    }
    return null;
  }

  function classes() {
    const table = data.classes;
    // What a rating tells is of the values that it found to pass: none of them would exceed a limit.
    if (!table?.rows.length || data.study.kind === 'rating') return null;
    const all = table.rows.flatMap(row => row.cells.map(outcome)),
      count = which => all.filter(one => one === which).length,
      asked = all.length - count('none');
    const buttons = new Map();

    function cellOf(cell) {
      const of = outcome(cell),
        [sign, word] = OUTCOMES[of],
        mark = el('span', { class: 'sign', 'aria-hidden': 'true' }, sign);
      if (!cell) return el('td', { class: of }, mark, el('span', { class: 'unseen' }, word));
      const button = el(
        'button',
        { type: 'button', class: 'crosses', 'aria-pressed': 'false' },
        mark,
        of === 'failed'
          ? el('span', { class: 'used' }, word)
          : [
              el('span', { class: 'used' }, write(cell.utilisation)),
              el('span', { class: 'unseen' }, ` ${word}: `),
              cell.limit && el('span', { class: 'where' }, limits.where(cell.limit, cell.place)),
            ],
      );
      buttons.set(cell.job, button);
      return el(
        'td',
        { class: of, 'data-job': cell.job, title: `job ${cell.job}`, onclick: () => page.pick(cell.job, 'cell') },
        button,
      );
    }

    let before = null;
    const lines = table.rows.map(row => {
      const begins = before !== null && before !== row.names[0];
      before = row.names[0];
      return el(
        'tr',
        { class: begins && table.names.length > 1 ? 'begins' : null },
        row.names.map(name => el('th', { scope: 'row' }, name)),
        row.cells.map(cellOf),
      );
    });
    const grid = el(
      'table',
      { class: 'classes' },
      el('caption', {}, `Utilisation of the limit that governs, and where. Study ${data.study.name}.`),
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          [...table.names, ...table.heads].map(head => el('th', { scope: 'col' }, head)),
        ),
      ),
      el('tbody', {}, lines),
    );
    grid.addEventListener('keydown', event => {
      const step = STEPS[event.key];
      if (!step || !event.target.matches('.crosses') || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      next(event.target, step)?.focus();
    });

    let pressed = null;
    page.onPick(job => {
      pressed?.setAttribute('aria-pressed', 'false');
      pressed = buttons.get(job) ?? null;
      pressed?.setAttribute('aria-pressed', 'true');
    });

    const parts = [`${numbers.count(count('passes'))} of ${numbers.count(asked)} crossings pass`];
    if (count('exceeds')) parts.push(`${numbers.count(count('exceeds'))} exceed a limit`);
    if (count('failed')) parts.push(`${numbers.count(count('failed'))} failed`);
    const used = Object.keys(OUTCOMES).filter(of => of === 'passes' || of === 'exceeds' || count(of));
    return section(
      'classes',
      'Classes',
      el('p', { class: 'lead' }, `${parts.join(', ')}.`),
      el(
        'p',
        { class: 'sub' },
        'A cell is a crossing. Its number is the utilisation: the demand over what the limit allows, 1 at the limit. ',
        'The words name the limit of which most is used up, and where.',
        el('span', { class: 'screen' }, ' Pick a cell to see its job; the arrow keys move among cells.'),
      ),
      el(
        'ul',
        { class: 'legend', role: 'list', 'aria-label': 'Signs' },
        used.map(of => {
          const [sign, word, meaning] = OUTCOMES[of];
          return el(
            'li',
            {},
            el('span', { class: `key ${of}`, 'aria-hidden': 'true' }, el('span', { class: 'sign' }, sign)),
            `${word}: ${meaning}`,
          );
        }),
      ),
      scroller('Classes, table', grid),
    );
  }

  page.classes = classes;
})((globalThis.pontoon ??= {}));
