// The filter of a table: words that a row must contain, and conditions on columns such as `speed_m_s>10`. Knows columns; draws nothing.
(page => {
  'use strict';
  const TERM = /^(.*?[^<>=!~])(<=|>=|!=|<|>|=)(.+)$/;
  const FACTORS = {
    '': 1,
    m: 1,
    N: 1,
    s: 1,
    Pa: 1,
    rad: 1,
    kg: 1,
    Hz: 1,
    'm/s': 1,
    'N/m': 1,
    'kg/m': 1,
    'Pa/m': 1,
    'kPa/m': 1e3,
    mm: 1e-3,
    cm: 1e-2,
    kN: 1e3,
    MN: 1e6,
    GN: 1e9,
    ms: 1e-3,
    kPa: 1e3,
    MPa: 1e6,
    GPa: 1e9,
    mrad: 1e-3,
  };
  const TEST = {
    '<': (a, b) => a < b,
    '>': (a, b) => a > b,
    '<=': (a, b) => a <= b,
    '>=': (a, b) => a >= b,
    '=': page.axes.near,
    '!=': (a, b) => !page.axes.near(a, b),
  };
  // A value of 32 bits is not the number that was typed: 0.1 is met by 0.10000000149.
  const slack = {
    '<=': (a, b) => a < b || page.axes.near(a, b),
    '>=': (a, b) => a > b || page.axes.near(a, b),
    '<': (a, b) => a < b && !page.axes.near(a, b),
    '>': (a, b) => a > b && !page.axes.near(a, b),
  };

  /** A number as a person types it: 200000, 200,000, 200kN, 28mm, 2e5; null where it is none, or its unit is not known. */
  function number(text) {
    const match = /^([-\u2212+]?[\d.,]+(?:e[-+]?\d+)?)\s*([a-zA-Z/]*)$/i.exec(text.trim());
    if (!match) return null;
    const value = Number(match[1].replace(/,/g, '').replace('\u2212', '-'));
    return Number.isFinite(value) && Object.hasOwn(FACTORS, match[2]) ? value * FACTORS[match[2]] : null;
  }

  /** The pieces of a filter: cut at spaces, but not beside an operator nor within quotes. */
  const UNITS = Object.keys(FACTORS)
    .filter(Boolean)
    .sort((a, b) => b.length - a.length)
    .join('|');
  const pieces = text =>
    text
      .replace(/\s*(<=|>=|!=|<|>|=)\s*/g, '$1')
      .replace(new RegExp(`([<>=][-\u2212+\\d.,eE]+)\\s+(${UNITS})(?=\\s|$)`, 'g'), '$1$2')
      .match(/(?:[^\s"]+|"[^"]*")+/g) ?? [];

  /**
   * Compiles a filter over columns ({ name, label, kind, value(row) }). Answers { test(row), error }. All pieces must hold.
   */
  function compile(text, columns, words) {
    const tests = [];
    let error = null;
    for (const piece of pieces(text)) {
      const match = TERM.exec(piece);
      if (!match) {
        const wanted = piece.replace(/"/g, '').toLowerCase();
        tests.push(row => words(row).includes(wanted));
        continue;
      }
      const [, key, sign, raw] = match,
        low = key.replace(/"/g, '').toLowerCase(),
        wanted = raw.replace(/"/g, '');
      const column =
        columns.find(c => c.name.toLowerCase() === low) ??
        columns.find(c => c.label.toLowerCase() === low) ??
        columns.find(c => c.name.toLowerCase().startsWith(low)) ??
        columns.find(c => c.name.toLowerCase().includes(low));
      if (!column) {
        error ??= `There is no column "${key}". Columns are ${columns.map(c => c.name).join(', ')}.`;
        continue;
      }
      if (column.kind === 'word') {
        const same = row => String(column.value(row) ?? '').toLowerCase() === wanted.toLowerCase();
        if (sign === '=' || sign === '!=') tests.push(row => same(row) === (sign === '='));
        else error ??= `"${column.name}" is a word: it can only be = or !=.`;
        continue;
      }
      const limit = number(wanted);
      if (limit === null) {
        error ??= `"${wanted}" is no number with a unit that is known here (${Object.keys(FACTORS).filter(Boolean).join(', ')}).`;
        continue;
      }
      const holds = slack[sign] ?? TEST[sign];
      tests.push(row => {
        const v = column.value(row);
        return v !== null && holds(v, limit);
      });
    }
    return { error, test: row => tests.every(test => test(row)) };
  }

  page.filter = { compile, number };
})((globalThis.pontoon ??= {}));
