// A chart of lines and dots from series of points, on Observable Plot's axes. Knows points and looks; knows no bridge.
(page => {
  'use strict';
  const { el, svg } = page.dom,
    { numbers } = page;
  const SYMBOLS = ['circle', 'square', 'triangle', 'diamond', 'star', 'wye', 'cross', 'hexagon'];
  const DASHES = ['none', '7 3', '2 3', '9 3 2 3', '12 4', '4 2', '1 3', '6 2 1 2 1 2'];
  const SHAPES = {
    circle: d3.symbolCircle,
    square: d3.symbolSquare,
    triangle: d3.symbolTriangle,
    diamond: d3.symbolDiamond,
    star: d3.symbolStar,
    wye: d3.symbolWye,
    cross: d3.symbolCross,
    times: d3.symbolTimes,
  };

  /** Colour, symbol and dash of series `i` of `n`: eight that differ in all three, else a ramp. */
  function look(i, n) {
    if (n <= 8) return { color: `var(--line-${i + 1})`, symbol: SYMBOLS[i], dash: DASHES[i] };
    const share = Math.round((100 * i) / (n - 1));
    return {
      color: `color-mix(in oklch, var(--ramp-b) ${share}%, var(--ramp-a))`,
      symbol: SYMBOLS[i % 8],
      dash: 'none',
    };
  }

  const shape = (symbol, size) => d3.symbol(SHAPES[symbol] ?? d3.symbolCircle, size)();

  /** A legend: the line with its symbol, then its name. */
  function legend(series, marks, of) {
    const item = (label, swatch) =>
      el(
        'li',
        {},
        svg('svg', { width: 34, height: 14, viewBox: '-17 -7 34 14', 'aria-hidden': 'true' }, swatch),
        label,
      );
    const items = series
      .filter(s => s.label)
      .map(s =>
        item(s.label, [
          svg('line', {
            x1: -16,
            x2: 16,
            y1: 0,
            y2: 0,
            stroke: s.color,
            'stroke-width': 2,
            'stroke-dasharray': s.dash,
          }),
          s.symbol && svg('path', { d: shape(s.symbol, 42), fill: s.color }),
        ]),
      );
    for (const label of new Set(marks.map(m => m.label)))
      items.push(
        item(label, svg('path', { d: shape('times', 60), stroke: 'var(--ink)', 'stroke-width': 2, fill: 'none' })),
      );
    if (of) items.unshift(el('li', { class: 'of' }, `${of}:`));
    return items.length > (series.length > 1 ? 0 : 1) || marks.length ? el('ul', {}, items) : [];
  }

  function extent(values, zero) {
    let [low, high] = d3.extent(values);
    if (low === undefined) [low, high] = [0, 1];
    if (zero) {
      low = Math.min(low, 0);
      high = Math.max(high, 0);
    }
    if (low === high) {
      const d = Math.abs(low) * 0.2 || 1;
      return zero ? [low, low + d] : [low - d, low + d];
    }
    const pad = (high - low) * 0.04;
    return [zero && low === 0 ? 0 : low - pad, zero && high === 0 ? 0 : high + pad];
  }

  /** Plot puts its lines on the middle of a pixel where pixels are coarse; so does what is drawn beside them. */
  const OFFSET = devicePixelRatio > 1 ? 0 : 0.5;
  /** Beyond so many points lines are drawn without dots: they would be a smear. */
  const MOST_DOTS = 900;

  /**
   * Draws `series` ({ key, label, color, symbol, dash, area, dots, points: [{ x, y, text, job }] }) and `marks` ({ x or null, y, label, text, color })
   * over axes x and y ({ title, factor, reverse, zero, ticks }). Values are in the data's units; the axes multiply by their factor.
   */
  function lines({ width, height = 320, x, y, series, marks = [] }) {
    const fx = x.factor ?? 1,
      fy = y.factor ?? 1;
    const all = [...series.flatMap(s => s.points), ...marks];
    const xs = extent(
      all
        .map(p => p.x)
        .filter(v => v !== null && Number.isFinite(v))
        .map(v => v * fx),
      x.zero,
    );
    const ys = extent(
      all
        .map(p => p.y)
        .filter(Number.isFinite)
        .map(v => v * fy),
      y.zero ?? true,
    );
    const layers = [Plot.ruleY(ys[0] <= 0 && ys[1] >= 0 ? [0] : [], { className: 'zero' })];
    const at = { x: p => p.x * fx, y: p => p.y * fy };
    if (all.length > MOST_DOTS) series = series.map(s => ({ ...s, dots: false }));
    layers.push((index, scales) =>
      svg(
        'g',
        { transform: `translate(${OFFSET},${OFFSET})` },
        series.map(s => [area(s, at, scales), line(s, at, scales), dots(s, at, scales)]),
      ),
    );
    const level = marks.filter(m => m.x === null),
      placed = marks.filter(m => m.x !== null);
    if (level.length)
      layers.push(
        Plot.ruleY(level, {
          y: at.y,
          stroke: m => m.color ?? 'var(--ink)',
          strokeDasharray: '2 4',
          strokeWidth: 1.5,
          className: 'mark-rules',
        }),
      );
    if (placed.length)
      layers.push(
        Plot.dot(placed, {
          ...at,
          stroke: m => m.color ?? 'var(--ink)',
          symbol: 'times',
          r: 5,
          strokeWidth: 2.2,
          className: 'mark-dots',
        }),
      );
    const across = Math.max(3, Math.round(width / 90));
    const node = Plot.plot({
      width,
      height,
      marginLeft: 62,
      marginBottom: 44,
      marginTop: 26,
      marginRight: 16,
      style: { fontSize: '12px', fontFamily: 'inherit', background: 'none', overflow: 'visible' },
      x: {
        domain: xs,
        label: numbers.fit(x.title, width - 90),
        labelAnchor: 'center',
        labelArrow: 'none',
        ticks: across,
        tickFormat: numbers.ticks(...xs, across),
      },
      y: {
        domain: y.reverse ? [ys[1], ys[0]] : ys,
        label: numbers.fit(y.title, width - 20),
        labelArrow: 'none',
        grid: true,
        ticks: 6,
        tickFormat: numbers.ticks(...ys, 6),
      },
      marks: layers,
    });
    node.style.maxWidth = '100%';
    const sx = node.scale('x'),
      sy = node.scale('y');
    const px = v => sx.apply(v * fx),
      py = v => sy.apply(v * fy);
    const groups = spots(series, placed, level, px, py);
    return { node, groups, scales: { x: sx, y: sy } };
  }

  // A layer of Plot's for each series would take ten times as long as one that draws them all.
  const whole = p => Number.isFinite(p.y);
  const area = (s, at, scales) =>
    s.area &&
    svg('path', {
      class: 'series-area',
      fill: s.color,
      'fill-opacity': 0.12,
      d: d3
        .area(
          p => scales.x(at.x(p)),
          scales.y(0),
          p => scales.y(at.y(p)),
        )
        .defined(whole)(s.points),
    });
  const line = (s, at, scales) =>
    svg(
      'g',
      { class: 'series-line', 'data-series': s.key },
      svg('path', {
        fill: 'none',
        stroke: s.color,
        'stroke-width': s.thin ? 1.2 : 2,
        'stroke-dasharray': s.dash,
        'stroke-linejoin': 'round',
        d:
          d3
            .line(
              p => scales.x(at.x(p)),
              p => scales.y(at.y(p)),
            )
            .defined(whole)(s.points) ?? '',
      }),
    );
  function dots(s, at, scales) {
    if (s.dots === false) return null;
    const d = shape(s.symbol ?? 'circle', s.points.length > 60 ? 14 : 50);
    return svg(
      'g',
      { class: 'series-dots', 'data-series': s.key, fill: s.color },
      s.points.filter(whole).map(p =>
        svg('path', {
          d,
          transform: `translate(${scales.x(at.x(p)).toFixed(3)},${scales.y(at.y(p)).toFixed(3)})`,
          'data-x': p.x,
          'data-y': p.y,
          'data-job': p.job,
        }),
      ),
    );
  }

  /** The points of each series, then the experiment's, in pixels. */
  function spots(series, placed, level, px, py) {
    const groups = series.map(s =>
      s.points.filter(whole).map(p => ({ px: px(p.x), py: py(p.y), job: p.job, text: p.text })),
    );
    if (placed.length)
      groups.push(placed.map(m => ({ px: px(m.x), py: py(m.y), text: m.text })).sort((a, b) => a.px - b.px));
    if (level.length) groups.push(level.map(m => ({ px: 70, py: py(m.y), text: m.text })));
    return groups;
  }

  page.lines = lines;
  page.look = look;
  page.legend = legend;
})((globalThis.pontoon ??= {}));
