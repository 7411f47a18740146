// The frame of a chart: caption, legend, drawing at the width there is, a readout under pointer and keyboard, numbers as a table.
// Knows points in pixels; knows nothing of what they mean.
(page => {
  'use strict';
  const { el, svg, id } = page.dom;
  const figures = new Set();

  /** Steps among groups of points: along a group, or to the nearest point of the next group. */
  function walker(groups) {
    const list = groups.filter(group => group.length);
    const nearest = (group, px) => group.reduce((best, p) => (Math.abs(p.px - px) < Math.abs(best.px - px) ? p : best));
    const find = point => list.findIndex(group => group.includes(point));
    return {
      first: () => list[0]?.[0] ?? null,
      at(px, py) {
        let best = null,
          least = Infinity;
        for (const group of list)
          for (const p of group) {
            const d = (p.px - px) ** 2 + (p.py - py) ** 2;
            if (d < least) {
              least = d;
              best = p;
            }
          }
        return best;
      },
      step(point, dx, dy) {
        const g = find(point);
        if (g < 0) return this.first();
        if (dx) return list[g][Math.min(list[g].length - 1, Math.max(0, list[g].indexOf(point) + dx))];
        return nearest(list[Math.min(list.length - 1, Math.max(0, g + dy))], point.px);
      },
    };
  }

  const KEYS = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, -1],
    ArrowDown: [0, 1],
    Home: [-1e9, 0],
    End: [1e9, 0],
    PageUp: [-10, 0],
    PageDown: [10, 0],
  };

  /**
   * A chart. `draw(width)` answers { node (an SVG), walk (see walker) or groups, legend, empty (why nothing is drawn),
   * table: () => [head, ...rows] }. A point has px, py, text() and, where it has one, job.
   */
  function figure(key, { title, label, draw, hint }) {
    const caption = el('figcaption', { id: `${key}-caption` }, title),
      note = el('p', { class: 'sub' });
    const legend = el('div', { class: 'legend' }),
      readout = el('output', { class: 'readout', id: id('readout') });
    const plot = el('div', {
      class: 'plot',
      tabindex: '0',
      role: 'application',
      'aria-roledescription': 'chart',
      'aria-label': label ?? title,
      'aria-describedby': readout.id,
    });
    const numbers = el('details', { class: 'numbers' }, el('summary', {}, 'Numbers of this chart'));
    const node = el('figure', { class: 'chart', id: key }, caption, note, legend, plot, readout, numbers);
    const idle = hint ?? 'Point at the chart, or focus it and use the arrow keys, to read a value.';
    let now = null,
      current = null,
      cursor = null,
      width = 0;

    function show(point) {
      current = point;
      cursor?.remove();
      cursor = null;
      readout.textContent = point ? point.text() : idle;
      readout.classList.toggle('idle', !point);
      if (!point || !now?.node) return;
      cursor = point.w
        ? svg('rect', {
            class: 'cursor',
            x: point.px - point.w / 2,
            y: point.py - point.h / 2,
            width: point.w,
            height: point.h,
          })
        : svg('circle', { class: 'cursor', cx: point.px, cy: point.py, r: 7 });
      now.node.append(cursor);
    }

    function redraw() {
      width = page.dom.room(plot);
      if (!width) return;
      now = draw(width);
      now.walk ??= walker(now.groups ?? []);
      caption.textContent = now.title ?? title;
      note.textContent = now.note ?? '';
      note.hidden = !now.note;
      legend.replaceChildren(...[now.legend ?? []].flat());
      plot.replaceChildren(now.empty ? el('p', { class: 'empty' }, now.empty) : now.node);
      now.node?.setAttribute('aria-hidden', 'true');
      numbers.hidden = !now.table;
      if (numbers.open) tabulate();
      show(null);
      readout.hidden = !!now.empty;
    }

    function tabulate() {
      const [head, ...rows] = now?.table?.() ?? [[]];
      const body = rows.slice(0, 400).map(row =>
        el(
          'tr',
          {},
          row.map((v, i) => el(i ? 'td' : 'th', i ? {} : { scope: 'row' }, String(v))),
        ),
      );
      numbers.querySelector('.scroll')?.remove();
      numbers.append(
        page.dom.scroller(
          `Numbers: ${title}`,
          el(
            'table',
            { class: 'plain' },
            el(
              'thead',
              {},
              el(
                'tr',
                {},
                head.map(h => el('th', { scope: 'col' }, h)),
              ),
            ),
            el('tbody', {}, body),
          ),
        ),
      );
    }
    numbers.addEventListener('toggle', () => numbers.open && tabulate());

    function place(event) {
      const box = now?.node?.getBoundingClientRect();
      if (!box || now.empty) return null;
      const [, , w, h] = (now.node.getAttribute('viewBox') ?? `0 0 ${box.width} ${box.height}`).split(' ').map(Number);
      return now.walk.at(((event.clientX - box.left) * w) / box.width, ((event.clientY - box.top) * h) / box.height);
    }
    plot.addEventListener('pointermove', event => {
      const p = place(event);
      if (p !== current) show(p);
    });
    plot.addEventListener('pointerleave', () => document.activeElement !== plot && show(null));
    plot.addEventListener('click', event => {
      const p = place(event);
      if (p?.job !== undefined && p.job !== null) page.pick(p.job, 'chart');
    });
    plot.addEventListener('focus', () => current || show(now && !now.empty ? now.walk.first() : null));
    plot.addEventListener('blur', () => show(null));
    plot.addEventListener('keydown', event => {
      if (!now || now.empty || event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === 'Enter' && current?.job !== undefined && current?.job !== null)
        return page.pick(current.job, 'chart');
      const move = KEYS[event.key];
      if (!move) return;
      event.preventDefault();
      show(current ? now.walk.step(current, ...move) : now.walk.first());
    });
    page.dom.resized(plot, () => Math.abs(page.dom.room(plot) - width) > 1 && redraw());
    const out = {
      node,
      redraw,
      get now() {
        return now;
      },
    };
    figures.add(out);
    return out;
  }

  page.figure = figure;
  page.figures = figures;
})((globalThis.pontoon ??= {}));
