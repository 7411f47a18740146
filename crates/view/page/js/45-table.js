// A table of many rows: sorted by its headers, filtered, a page at a time, a row picked by click or Enter. Knows columns; knows no bridge.
(page => {
  'use strict';
  const { el, field, select, button, scroller, id } = page.dom,
    { numbers } = page;
  const SIZES = [10, 25, 50, 100];
  // As many columns as a sheet of paper takes; style.css leaves the others out there.
  const MOST_ON_PAPER = 12;

  /**
   * `columns`: { name, label, unit, kind, value(row), write(row), title }. The first is the row's header. `pick(row)` makes rows
   * pickable and the header a button. `options.size` rows are shown at a time.
   */
  function table(label, count, columns, { pick, size = 10, placeholder, sort = null } = {}) {
    const state = { text: '', sort, down: false, page: 0, size };
    let shown = [],
      marked = -1,
      paper = false;
    const plainText = new Map();
    const words = row => {
      if (!plainText.has(row))
        plainText.set(
          row,
          columns
            .map(c => `${c.write(row)} ${c.kind === 'word' ? '' : (c.value(row) ?? '')}`)
            .join(' ')
            .toLowerCase(),
        );
      return plainText.get(row);
    };

    const body = el('tbody'),
      said = el('p', { class: 'count', role: 'status' }),
      error = el('p', { class: 'error', id: id('error'), role: 'alert' });
    const heads = columns.map((c, i) =>
      el(
        'th',
        { scope: 'col', class: c.kind === 'number' && i > 0 ? 'number' : null, 'aria-sort': 'none' },
        el(
          'button',
          { type: 'button', class: 'sort', title: c.title ?? c.name, onclick: () => order(c) },
          el('span', {}, c.label),
          c.unit && el('span', { class: 'unit' }, c.unit),
        ),
      ),
    );
    const grid = el(
      'table',
      { class: `rows ${columns.length > MOST_ON_PAPER ? 'many' : ''}` },
      el('caption', { class: 'unseen' }, label),
      el('thead', {}, el('tr', {}, heads)),
      body,
    );
    const input = el('input', {
      type: 'search',
      placeholder,
      autocomplete: 'off',
      spellcheck: 'false',
      'aria-describedby': error.id,
      oninput: () => {
        state.text = input.value;
        state.page = 0;
        update();
      },
    });
    const back = button('Previous', () => turn(-1)),
      on = button('Next', () => turn(1));
    const sizes = select(
      SIZES.map(n => [String(n), String(n)]),
      String(size),
      v => {
        state.size = Number(v);
        state.page = 0;
        draw();
      },
    );
    const filterField = field('Filter', input);
    filterField.classList.add('wide');
    const node = el(
      'div',
      { class: 'table' },
      el('div', { class: 'controls' }, filterField, field('Rows at a time', sizes)),
      error,
      scroller(`${label}, table`, grid),
      el('div', { class: 'pager' }, said, el('div', { class: 'buttons' }, back, on)),
    );

    function order(column) {
      state.down = state.sort === column.name ? !state.down : column.kind === 'number' && !column.input;
      state.sort = column.name;
      state.page = 0;
      update();
    }

    /** Rows that pass the filter, in order. Nulls come last either way; equal ones stay in the order of the jobs. */
    function update() {
      const { test, error: wrong } = page.filter.compile(state.text, columns, words);
      error.textContent = wrong ?? '';
      error.hidden = !wrong;
      input.setAttribute('aria-invalid', String(!!wrong));
      shown = [];
      for (let row = 0; row < count; row++) if (test(row)) shown.push(row);
      const column = columns.find(c => c.name === state.sort);
      if (column) {
        const sign = state.down ? -1 : 1,
          keys = new Map(shown.map(row => [row, column.value(row)]));
        shown.sort((a, b) => {
          const x = keys.get(a),
            y = keys.get(b);
          if (x === null || y === null) return (x === null) - (y === null) || a - b;
          return (x < y ? -sign : x > y ? sign : 0) || a - b;
        });
      }
      columns.forEach((c, i) =>
        heads[i].setAttribute('aria-sort', c.name !== state.sort ? 'none' : state.down ? 'descending' : 'ascending'),
      );
      draw();
    }

    function draw() {
      const step = paper ? 60 : state.size,
        last = Math.max(0, Math.ceil(shown.length / step) - 1);
      const at = paper ? 0 : (state.page = Math.min(last, Math.max(0, state.page)));
      const rows = shown.slice(at * step, (at + 1) * step);
      body.replaceChildren(...rows.map(line));
      said.textContent = shown.length
        ? `${numbers.count(at * step + 1)} to ${numbers.count(at * step + rows.length)} of ${numbers.count(shown.length)}${shown.length < count ? ` (filtered from ${numbers.count(count)})` : ''}`
        : `None of ${numbers.count(count)} rows meets the filter`;
      if (paper && columns.length > MOST_ON_PAPER)
        said.textContent += `; ${MOST_ON_PAPER} of ${columns.length} columns`;
      back.disabled = at === 0;
      on.disabled = at >= last;
    }

    function line(row) {
      const cells = columns.map((c, i) => {
        const text = c.write(row),
          bad = c.bad?.(row);
        if (i === 0)
          return el(
            'th',
            { scope: 'row' },
            pick
              ? el(
                  'button',
                  {
                    type: 'button',
                    class: 'pick',
                    'aria-pressed': String(row === marked),
                    'aria-label': `${c.label} ${text}`,
                  },
                  text,
                )
              : text,
          );
        return el(
          'td',
          {
            class:
              [c.kind === 'number' ? 'number' : text.length > 24 ? 'long' : '', bad ? 'bad' : ''].join(' ').trim() ||
              null,
          },
          text,
        );
      });
      return el(
        'tr',
        { 'data-row': row, class: row === marked ? 'picked' : null, onclick: pick && (() => pick(row)) },
        cells,
      );
    }

    function turn(by) {
      state.page += by;
      draw();
    }
    body.addEventListener('keydown', event => {
      const at = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (!at || !event.target.matches('.pick')) return;
      event.preventDefault();
      const list = [...body.querySelectorAll('.pick')],
        next = list[list.indexOf(event.target) + at];
      if (next) next.focus();
    });

    page.paper.push({
      freeze() {
        paper = true;
        draw();
      },
      thaw() {
        paper = false;
        draw();
      },
    });
    update();
    return {
      node,
      input,
      /** Marks a row as the picked one; turns to its page where it is not in sight. */
      mark(row, reveal) {
        marked = row;
        const place = shown.indexOf(row);
        if (reveal && place >= 0) state.page = Math.floor(place / state.size);
        if (reveal && place >= 0 && !body.querySelector(`tr[data-row="${row}"]`)) return draw();
        for (const tr of body.children) {
          const on = Number(tr.dataset.row) === row;
          tr.classList.toggle('picked', on);
          tr.querySelector('.pick')?.setAttribute('aria-pressed', String(on));
        }
      },
    };
  }

  page.table = table;
})((globalThis.pontoon ??= {}));
