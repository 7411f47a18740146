// A heat map of two band axes. Cells of one colour are one path; very many cells are one picture, so that forty thousand are drawn at once. Knows bands and values; knows no bridge.
(page => {
  'use strict';
  const { svg } = page.dom;
  const LEVELS = 96;
  // Beyond so many cells they are pixels of one picture: as paths they would take a browser longer than a tenth of a second.
  const MOST_PATHS = 3000;

  /** Sequential where values have one sign, diverging about zero where they have two. */
  function colours([low, high]) {
    if (low < 0 && high > 0) {
      const most = Math.max(-low, high);
      return { low: -most, high: most, of: t => d3.interpolatePuOr(1 - t), diverging: true };
    }
    if (low === high) {
      const d = Math.abs(low) * 0.05 || 1;
      [low, high] = [low - d, high + d];
    }
    return { low, high, of: d3.interpolateViridis, diverging: false };
  }
  const level = (scale, v) =>
    Math.min(LEVELS - 1, Math.max(0, Math.floor(((v - scale.low) / (scale.high - scale.low)) * LEVELS)));
  const fill = (scale, l) => d3.color(scale.of((l + 0.5) / LEVELS)).formatHex();

  /** Every k-th of n names, so that each has `room` pixels of `space`. */
  const thin = (n, space, room) => {
    const k = Math.max(1, Math.ceil((n * room) / space));
    return d3.range(0, n, k);
  };

  const cross = (x, y, w, h) => {
    const [a, b] = [w.toFixed(2), h.toFixed(2)];
    return `M${x.toFixed(2)} ${y.toFixed(2)}l${a} ${b}m0 -${b}l-${a} ${b}`;
  };

  /** Draws `value` (row-major, y by x; NaN = nothing) over names of bands; `jobs` tells a cell that failed from one that is not there. */
  function grid({ width, height, x, y, value, jobs, scale, cell }) {
    const nx = x.names.length,
      ny = y.names.length;
    const longest = names => Math.max(...names.map(n => n.length));
    const left = Math.min(width * 0.35, 34 + 7 * Math.min(20, longest(y.names)));
    const short = text => (text.length > 20 ? text.slice(0, 19) + '\u2026' : text);
    const room = Math.min(20, longest(x.names)) * 7 + 12;
    const picture = (index, scales, channels, dimensions) => {
      const canvas = document.createElement('canvas'),
        w = dimensions.width - dimensions.marginLeft - dimensions.marginRight,
        h = dimensions.height - dimensions.marginTop - dimensions.marginBottom;
      [canvas.width, canvas.height] = [nx, ny];
      const context = canvas.getContext('2d'),
        image = context.createImageData(nx, ny),
        rgb = d3.range(LEVELS).map(l => d3.rgb(fill(scale, l))),
        place = { x: dimensions.marginLeft, y: dimensions.marginTop, width: w, height: h };
      const failed = [],
        cw = w / nx,
        ch = h / ny;
      for (let j = 0, c = 0; j < ny; j++)
        for (let i = 0; i < nx; i++, c++) {
          if (Number.isNaN(value[c])) {
            if (jobs[c]) failed.push(cross(place.x + i * cw, place.y + (ny - 1 - j) * ch, cw, ch));
            continue;
          }
          const { r, g, b } = rgb[level(scale, value[c])];
          image.data.set([r, g, b, 255], ((ny - 1 - j) * nx + i) * 4);
        }
      context.putImageData(image, 0, 0);
      return svg(
        'g',
        { class: 'heat' },
        svg('rect', { class: 'nothing', ...place }),
        svg('image', { ...place, href: canvas.toDataURL(), preserveAspectRatio: 'none' }),
        failed.length > 0 && svg('path', { class: 'failed', d: failed.join('') }),
      );
    };
    const paths = (index, scales, channels, dimensions) => {
      const bx = scales.x,
        by = scales.y,
        w = dimensions.width - dimensions.marginLeft - dimensions.marginRight,
        h = dimensions.height - dimensions.marginTop - dimensions.marginBottom;
      const cw = bx.bandwidth ? bx.bandwidth() : w / nx,
        ch = by.bandwidth ? by.bandwidth() : h / ny;
      const parts = Array.from({ length: LEVELS }, () => []),
        failed = [];
      const left = d3.range(nx).map(i => +bx(i).toFixed(2)),
        top = d3.range(ny).map(j => +by(j).toFixed(2));
      for (let j = 0, c = 0; j < ny; j++)
        for (let i = 0; i < nx; i++, c++) {
          const v = value[c],
            d = `M${left[i]} ${top[j]}h${cw.toFixed(2)}v${ch.toFixed(2)}h-${cw.toFixed(2)}z`;
          if (!Number.isNaN(v)) parts[level(scale, v)].push(d);
          else if (jobs[c]) failed.push(cross(left[i], top[j], cw, ch));
        }
      return svg(
        'g',
        { class: 'heat' },
        svg('rect', { class: 'nothing', x: dimensions.marginLeft, y: dimensions.marginTop, width: w, height: h }),
        parts.map((d, l) => d.length > 0 && svg('path', { d: d.join(''), fill: fill(scale, l), 'data-level': l })),
        failed.length > 0 && svg('path', { class: 'failed', d: failed.join('') }),
      );
    };
    const node = Plot.plot({
      width,
      height,
      marginLeft: left,
      marginBottom: 48,
      marginTop: 26,
      marginRight: 14,
      style: { fontSize: '12px', fontFamily: 'inherit', background: 'none' },
      x: {
        type: 'band',
        domain: d3.range(nx),
        padding: 0,
        round: false,
        label: page.numbers.fit(x.title, width - left - 20),
        labelAnchor: 'center',
        labelArrow: 'none',
        ticks: thin(nx, width - left - 14, room),
        tickFormat: i => short(x.names[i]),
        tickSize: 4,
      },
      y: {
        type: 'band',
        domain: d3.range(ny).reverse(),
        padding: 0,
        round: false,
        label: page.numbers.fit(y.title, height - 74),
        labelArrow: 'none',
        ticks: thin(ny, height - 74, 16),
        tickFormat: i => short(y.names[i]),
        tickSize: 4,
      },
      marks: [nx * ny > MOST_PATHS ? picture : paths],
    });
    node.style.maxWidth = '100%';
    const sx = node.scale('x'),
      sy = node.scale('y'),
      w = sx.bandwidth,
      h = sy.bandwidth,
      x0 = sx.apply(0),
      y0 = sy.apply(ny - 1);
    const point = (i, j) => ({ i, j, w, h, px: sx.apply(i) + w / 2, py: sy.apply(j) + h / 2, ...cell(i, j) });
    const clamp = (v, n) => Math.min(n - 1, Math.max(0, v));
    const walk = {
      first: () => point(0, 0),
      at: (px, py) => {
        const i = Math.floor((px - x0) / w),
          j = ny - 1 - Math.floor((py - y0) / h);
        return i < 0 || j < 0 || i >= nx || j >= ny ? null : point(i, j);
      },
      step: (p, dx, dy) => point(clamp(p.i + dx, nx), clamp(p.j - dy, ny)),
    };
    return { node, walk };
  }

  /** The scale of colours as a strip with its numbers. */
  function strip(scale, title, write) {
    const width = 260,
      step = width / LEVELS,
      at = v => ((v - scale.low) / (scale.high - scale.low)) * width;
    let ticks = d3.scaleLinear([scale.low, scale.high], [0, width]).ticks(4);
    // long numbers would run into each other: every other one is left out
    const longest = Math.max(...ticks.map(t => write(t).length));
    while (ticks.length > 2 && at(ticks[1]) - at(ticks[0]) < 7 * longest + 6)
      ticks = ticks.filter((_, i) => i % 2 === 0);
    return svg(
      'svg',
      {
        class: 'strip',
        width: width + 40,
        height: 46,
        viewBox: `-20 0 ${width + 40} 46`,
        role: 'img',
        'aria-label': `${title}: ${write(scale.low)} to ${write(scale.high)}`,
      },
      svg('text', { x: 0, y: 11 }, page.numbers.fit(title, width)),
      d3
        .range(LEVELS)
        .map(l => svg('rect', { x: l * step, y: 16, width: step + 0.4, height: 10, fill: fill(scale, l) })),
      ticks.map(t => [
        svg('line', { x1: at(t), x2: at(t), y1: 26, y2: 30 }),
        svg('text', { x: at(t), y: 42, 'text-anchor': 'middle' }, write(t)),
      ]),
    );
  }

  page.grid = grid;
  page.heat = { colours, strip, level, LEVELS };
})((globalThis.pontoon ??= {}));
