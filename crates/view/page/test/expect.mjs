// What a page should show, worked out from its data by other code than the page's own: Node's buffers and plain loops.

const READ = {
  f32: ['readFloatLE', 4],
  u32: ['readUInt32LE', 4],
  u16: ['readUInt16LE', 2],
  i16: ['readInt16LE', 2],
  u8: ['readUInt8', 1],
};

/** A packed array as a list of numbers. */
export function list(packed) {
  if (!packed || Array.isArray(packed)) return packed ?? [];
  const kind = Object.keys(READ).find(k => k in packed),
    [read, width] = READ[kind],
    bytes = Buffer.from(packed[kind], 'base64');
  const out = [];
  for (let at = 0; at < bytes.length; at += width) out.push(bytes[read](at) * (packed.scale ?? 1));
  return out;
}

/** The cells as objects: { at: [index an axis], max, min: [a measure], jobs, failed, best: [job a measure] }. */
export function cells(data) {
  if (!known.has(data.cells)) known.set(data.cells, unpack(data));
  return known.get(data.cells);
}
const known = new WeakMap();

function unpack(data) {
  const axis = data.cells.axis.map(list),
    max = data.cells.max.map(list),
    min = data.cells.min.map(list),
    best = data.cells.at.map(list),
    jobs = list(data.cells.jobs),
    failed = list(data.cells.failed);
  return Array.from({ length: data.cells.count }, (_, c) => ({
    at: axis.map(a => a[c]),
    max: max.map(m => m[c]),
    min: min.map(m => m[c]),
    best: best.map(m => m[c]),
    jobs: jobs[c],
    failed: failed[c],
  }));
}

/** The largest of a measure for each value of axis `x`, a list for each value of axis `line` (-1: one line), over cells that meet `fixed`. */
export function curves(data, x, line, measure, fixed) {
  const out = new Map();
  for (const cell of cells(data)) {
    if ([...fixed].some(([a, i]) => cell.at[a] !== i)) continue;
    const key = line < 0 ? 'all' : String(cell.at[line]),
      value = cell.max[measure],
      place = data.axes[x].values[cell.at[x]];
    if (Number.isNaN(value) || place === null) continue;
    if (!out.has(key)) out.set(key, new Map());
    out.get(key).set(place, Math.max(value, out.get(key).get(place) ?? -Infinity));
  }
  return new Map([...out].map(([key, points]) => [key, [...points].sort((a, b) => a[0] - b[0])]));
}

/** A number as the page writes it: "1,317", a true minus sign. */
export const parse = text =>
  Number(
    text
      .replace(/,/g, '')
      .replace('\u2212', '-')
      .replace(
        /\u00b710([\u207b\u2070\u00b9\u00b2\u00b3\u2074-\u2079]+)/,
        (_, e) =>
          'e' +
          [...e]
            .map(c =>
              c === '\u207b' ? '-' : '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'.indexOf(c),
            )
            .join(''),
      ),
  );

/** From pixels to values, by the axis's own ticks alone. */
export function ruler(ticks) {
  const a = ticks[0],
    b = ticks.at(-1),
    slope = (b.value - a.value) / (b.px - a.px);
  return { value: px => a.value + (px - a.px) * slope, pixel: Math.abs(slope) };
}

/** The factor from a data unit to the one that stands in an axis's title. */
export function factor(title, unit) {
  const shown = /\(([^()]*)\)\s*$/.exec(title)?.[1] ?? '';
  const known = {
    'm>mm': 1e3,
    'N>kN': 1e-3,
    'rad>mrad': 1e3,
    's>ms': 1e3,
    'N>GN': 1e-9,
    'Pa>kPa': 1e-3,
    'Pa>MPa': 1e-6,
    'Pa>GPa': 1e-9,
    'Pa/m>kPa/m': 1e-3,
  };
  if (shown === (unit ?? '') || !unit) return 1;
  return known[`${unit}>${shown}`] ?? NaN;
}
