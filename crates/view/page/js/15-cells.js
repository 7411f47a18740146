// Slices of the aggregate: cells of all jobs, gathered over the axes that a chart does not show. Draws nothing.
(page => {
  'use strict';
  const { data, array, NONE } = page;
  const cells = data.cells;

  const axis = name => (data.axes ?? []).findIndex(a => a.name === name);
  const measure = name => (data.measures ?? []).findIndex(m => m.name === name);

  /** The first of some measures that there is, else `otherwise`. */
  const first = (names, otherwise = 0) => names.map(measure).find(m => m >= 0) ?? otherwise;

  /**
   * The largest (or smallest) value of a measure for each combination of values of the axes `keys`, over the cells that
   * meet `fixed` (axis -> index of a value; what is not in it is free). Row-major over `keys`.
   */
  function slice(keys, fixed, measureAt, statistic = 'max') {
    const sizes = keys.map(k => data.axes[k].values.length),
      size = sizes.reduce((a, b) => a * b, 1);
    const value = new Float64Array(size).fill(NaN),
      at = new Uint32Array(size).fill(NONE.u32),
      jobs = new Uint32Array(size),
      failed = new Uint32Array(size);
    const source = array(cells[statistic][measureAt]),
      winner = array(cells.at[measureAt]);
    const index = keys.map(k => array(cells.axis[k])),
      tests = [...fixed].filter(([a]) => !keys.includes(a)).map(([a, i]) => [array(cells.axis[a]), i]);
    const n = array(cells.jobs),
      bad = array(cells.failed),
      sign = statistic === 'max' ? 1 : -1;
    each: for (let c = 0; c < cells.count; c++) {
      for (const [axisOf, wanted] of tests) if (axisOf[c] !== wanted) continue each;
      let place = 0;
      for (let k = 0; k < index.length; k++) place = place * sizes[k] + index[k][c];
      jobs[place] += n[c];
      failed[place] += bad[c];
      const v = source[c];
      if (!Number.isNaN(v) && !(sign * v <= sign * value[place])) {
        value[place] = v;
        if (statistic === 'max') at[place] = winner[c];
      }
    }
    return { value, at, jobs, failed, sizes };
  }

  /** The least and the largest value of a measure in all cells. */
  function range(measureAt, statistic = 'max') {
    let low = Infinity,
      high = -Infinity;
    for (const v of array(cells[statistic][measureAt]))
      if (!Number.isNaN(v)) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
    return low <= high ? [low, high] : null;
  }

  /** Axes that take more than one value. */
  const varying = () => (data.axes ?? []).map((_, i) => i).filter(i => data.axes[i].values.length > 1);

  /**
   * Stops to begin with: the value of an axis that nine cells of ten have; a lone job with another load is not drawn among them.
   * Of ratings the commonest value of each axis: the largest of several rated values is safe for one of them alone.
   */
  function usual() {
    const out = new Map();
    for (const a of varying()) {
      const tally = new Uint32Array(data.axes[a].values.length);
      for (const i of array(cells.axis[a])) tally[i]++;
      const most = tally.indexOf(Math.max(...tally));
      if (data.study.kind === 'rating' || tally[most] >= 0.9 * cells.count) out.set(a, most);
    }
    return out;
  }

  page.cells = { usual, axis, measure, first, slice, range, varying };
})((globalThis.pontoon ??= {}));
