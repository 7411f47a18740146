// Axes of the design as words and controls: a value's name, a stop for each value and one for all. Draws no chart.
(page => {
  'use strict';
  const { data, numbers } = page,
    { el, field, select } = page.dom;
  const units = new Map();

  /** The unit an axis is shown in. */
  function shown(at) {
    if (!units.has(at)) {
      const axis = data.axes[at],
        most = axis.kind === 'number' ? Math.max(0, ...axis.values.filter(v => v !== null).map(Math.abs)) : 0;
      units.set(at, numbers.unit(axis.unit, most));
    }
    return units.get(at);
  }

  // A linear connection has no gap.
  const NOTHING = { gap_tension_m: 'linear', gap_compression_m: 'linear' };
  const nothing = at => NOTHING[data.axes[at].name] ?? 'none';
  const bare = (at, value) =>
    value === null
      ? nothing(at)
      : data.axes[at].kind === 'word'
        ? String(value)
        : numbers.plain(value * shown(at).factor);

  /** An end or the middle of a range: no finer than a range is. */
  const edge = (at, value) => bare(at, Number(value.toPrecision(4)));

  /** The number of a value for a tick: without its unit. */
  const tick = (at, index) => (data.axes[at].bins?.[index] ? edge : bare)(at, data.axes[at].values[index]);

  /** A value in full: with its unit, as a range where values were binned. */
  function name(at, index) {
    const axis = data.axes[at],
      value = axis.values[index],
      unit = shown(at).unit,
      bin = axis.bins?.[index];
    if (value === null) return nothing(at);
    const text = bin && bin[0] < bin[1] ? `${edge(at, bin[0])} to ${edge(at, bin[1])}` : bare(at, value);
    return unit ? text + numbers.THIN + unit : text;
  }

  const title = at => numbers.axisTitle(data.axes[at].label, shown(at).unit);
  const ALL = 'all (largest)';

  /** A control for the axis that no chart axis shows: "all", then each value. Calls `change(index or null)`. */
  function stop(at, value, change) {
    const axis = data.axes[at],
      n = axis.values.length;
    if (axis.kind === 'word' || n <= 2) {
      const node = select(
        [['', ALL], ...axis.values.map((_, i) => [String(i), name(at, i)])],
        value === null ? '' : String(value),
        v => change(v === '' ? null : Number(v)),
      );
      node.dataset.axis = axis.name;
      return field(axis.label, node);
    }
    const text = i => (i === 0 ? ALL : name(at, i - 1));
    const output = el('output', {}, text(value === null ? 0 : value + 1));
    const node = el('input', {
      type: 'range',
      min: 0,
      max: n,
      step: 1,
      'data-axis': axis.name,
      oninput: () => {
        const i = Number(node.value);
        output.textContent = text(i);
        node.setAttribute('aria-valuetext', text(i));
        change(i === 0 ? null : i - 1);
      },
    });
    node.value = value === null ? 0 : value + 1;
    node.setAttribute('aria-valuetext', text(Number(node.value)));
    return field(axis.label, node, output);
  }

  /** What a choice of stops says in words. */
  function choice(fixed, except) {
    const parts = page.cells
      .varying()
      .filter(a => !except.includes(a))
      .map(a => `${data.axes[a].label}: ${fixed.has(a) ? name(a, fixed.get(a)) : ALL}`);
    return parts.join('; ');
  }

  // Lists stand as text in the rows.
  const text = v => (Array.isArray(v) ? JSON.stringify(v) : v);
  const same = (a, b) =>
    a === b ||
    (typeof a === 'number' && typeof b === 'number' && Math.abs(a - b) <= 1e-6 * Math.max(Math.abs(a), Math.abs(b)));
  const near = (a, b) => same(text(a), text(b));
  /** The index of a value on an axis as an experiment's mark names it, or -1. */
  const find = (at, value) =>
    data.axes[at].values.findIndex(
      (v, i) =>
        near(v, value) ||
        (typeof value === 'number' &&
          data.axes[at].bins &&
          data.axes[at].bins[i] &&
          value >= data.axes[at].bins[i][0] &&
          value <= data.axes[at].bins[i][1]),
    );

  /** Whether an experiment's mark belongs to a choice of stops. */
  const fits = (mark, fixed) =>
    Object.entries(mark.axes ?? {}).every(([key, value]) => {
      const at = page.cells.axis(key);
      return at < 0 || !fixed.has(at) || find(at, value) === fixed.get(at);
    });

  /** Whether it belongs to a job of the rows. */
  const fitsRow = (mark, row) =>
    row >= 0 &&
    Object.entries(mark.axes ?? {}).every(([key, value]) => {
      const column = data.rows.columns.find(c => c.name === key);
      return !column || near(page.cell(column, row), value);
    });

  page.axes = { shown, tick, name, title, stop, choice, find, fits, fitsRow, near, ALL };
})((globalThis.pontoon ??= {}));
