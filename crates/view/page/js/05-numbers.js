// Numbers as a reader wants them: a fitting unit, sensible digits. Knows units; knows no measure by name.
(page => {
  'use strict';
  const MINUS = '\u2212',
    THIN = '\u202f';
  const SMALLER = { m: [0.1, 1000, 'mm'], rad: [0.1, 1000, 'mrad'], s: [0.01, 1000, 'ms'] };
  const LARGER = {
    N: [
      [1e9, 1e-9, 'GN'],
      [1e3, 1e-3, 'kN'],
    ],
    'N m': [
      [1e6, 1e-6, 'MN m'],
      [1e3, 1e-3, 'kN m'],
    ],
    Pa: [
      [1e9, 1e-9, 'GPa'],
      [1e6, 1e-6, 'MPa'],
      [1e3, 1e-3, 'kPa'],
    ],
    'Pa/m': [[1e3, 1e-3, 'kPa/m']],
  };

  /** The unit in which values up to `most` are shown: what to multiply by, and its name. */
  function unit(name, most) {
    const small = SMALLER[name];
    if (small && most > 0 && most < small[0]) return { factor: small[1], unit: small[2] };
    const large = (LARGER[name] ?? []).find(([from]) => most >= from);
    return large ? { factor: large[1], unit: large[2] } : { factor: 1, unit: name ?? '' };
  }

  function group(text) {
    const [whole, part] = text.replace('-', '').split('.');
    const grouped = whole.replace(/\B(?=(\d{3})+$)/g, ',');
    return (text.startsWith('-') && Number(text) !== 0 ? MINUS : '') + grouped + (part ? '.' + part : '');
  }

  /** A result with `digits` significant digits, never as many as the number happens to have. */
  function digits(value, count = 4) {
    if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
    if (value === 0) return '0';
    const size = Math.floor(Math.log10(Math.abs(value)));
    if (size >= 7 || size < -4) {
      const [m, e] = value.toExponential(count - 1).split('e');
      return `${group(m)}\u00b7${'1' + '0'}${raised(Number(e))}`;
    }
    return group(value.toFixed(Math.max(0, count - 1 - size)));
  }
  const raised = n =>
    String(n).replace(/./g, c =>
      c === '-' ? '\u207b' : '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'[c],
    );

  /** An input as it was written: no digits that 32 bits invented, no zeros behind. */
  function plain(value) {
    if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e7 || size < 1e-4)) return digits(value, 4);
    return group(String(Number(value.toPrecision(6))));
  }

  /** A way to write a column of results: all with the same decimals, so that their points stand in a line; counts without any. */
  function column(values, name) {
    let most = 0;
    for (const value of values) if (Math.abs(value) > most) most = Math.abs(value);
    const shown = unit(name, most),
      top = most * shown.factor;
    const counts = !name && values.every(Number.isInteger),
      decimals = top > 0 && !counts ? Math.min(8, Math.max(0, 3 - Math.floor(Math.log10(top)))) : 0;
    const write = value => {
      if (value === null || Number.isNaN(value)) return '\u2013';
      return top >= 1e7 || top < 1e-4 ? digits(value * shown.factor) : group((value * shown.factor).toFixed(decimals));
    };
    return { ...shown, write, decimals };
  }

  /** A number with its unit. */
  const quantity = (value, name, count) => {
    const shown = unit(name, Math.abs(value ?? 0));
    return value === null || value === undefined || Number.isNaN(value)
      ? '\u2013'
      : digits(value * shown.factor, count) + (shown.unit && THIN + shown.unit);
  };

  const count = n => group(String(n));
  const axisTitle = (label, name) => (name ? `${label} (${name})` : label);

  /** An axis's title cut to a width, its unit kept. */
  function fit(title, width) {
    const most = Math.floor(width / 7),
      [, label, tail] = /^([^]*?)( \([^()]*\))?$/.exec(title);
    return title.length <= most
      ? title
      : `${label.slice(0, Math.max(4, most - (tail ?? '').length - 1))}\u2026${tail ?? ''}`;
  }

  /** A way to write the ticks of an axis: all with the decimals that their step needs, but for 0. */
  function ticks(low, high, count) {
    const step = d3.tickStep(Math.min(low, high), Math.max(low, high), count),
      decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return v => (v === 0 ? '0' : Math.abs(v) >= 1e7 || decimals > 6 ? digits(v, 4) : group(v.toFixed(decimals)));
  }

  page.numbers = { ticks, fit, unit, digits, plain, column, quantity, count, axisTitle, THIN };
})((globalThis.pontoon ??= {}));
