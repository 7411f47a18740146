// The bridge from the side at one instant: modules, water, vehicle, joints by their state, forces as bars. Knows one play; keeps no time.
(page => {
  'use strict';
  const { data, numbers, array } = page,
    { svg, el } = page.dom;
  const STATES = ['open', 'compression', 'tension', 'both'],
    WORDS = ['open', 'compression', 'tension', 'compression and tension'];
  // Open: a ring. Compression: arrow heads that meet. Tension: arrow heads that part. Both: a diamond.
  const GLYPHS = [
    'M0 -.8a.8 .8 0 1 0 .01 0z',
    'M-1 -.8L0 0L-1 .8zM1 -.8L0 0L1 .8z',
    'M-.1 -.8L-1.1 0L-.1 .8zM.1 -.8L1.1 0L.1 .8z',
    'M0 -1L1 0L0 1L-1 0z',
  ];
  const glyph = (state, size) =>
    GLYPHS[state]
      .replace(/-?\d*\.\d+|-?\d+/g, n => +(n * size).toFixed(2))
      .replace(/a([\d.]+) ([\d.]+) 0 1 0/, 'a$1 $2 0 1 0');

  const ring = size => `M0 ${-0.75 * size}a${0.75 * size} ${0.75 * size} 0 1 1 -0.01 0z`;
  const path = (state, size) => (state === 0 ? ring(size) : glyph(state, size));

  // What a joint has not got: a bar that is broken over it where nothing pulls, a cross where nothing pulls or pushes.
  const WANTING = { uncoupled: 'M-1.5 -2.2V-1.5H-.5M.5 -1.5H1.5V-2.2', lost: 'M-1.1 -1.1L1.1 1.1M-1.1 1.1L1.1 -1.1' },
    SAID = { uncoupled: 'coupling open: pushes only', lost: 'connectors lost' };
  const mark = (kind, size) => WANTING[kind].replace(/-?\d*\.\d+|-?\d+/g, n => +(n * size).toFixed(2));

  /** A bank that presses upward: a plate where the bridge meets it, a spring, the ground. */
  const spring = (x, y, bank) =>
    svg('path', {
      class: 'spring',
      'data-bank': bank,
      d: `M${(x - 6).toFixed(2)} ${y.toFixed(2)}h12m-6 0l4 2l-8 3l8 3l-8 3l4 2m-8 0h16`,
    });

  /** The states that a play has, and the three that any may have; what joints have not got, where one has not. */
  function legend(state, wanting) {
    const shown = state.includes(3) ? STATES : STATES.slice(0, 3);
    const kinds = Object.keys(WANTING).filter(kind => wanting.includes(kind));
    return el(
      'ul',
      { class: 'legend joints' },
      shown.map((s, i) =>
        el(
          'li',
          {},
          svg(
            'svg',
            { width: 18, height: 14, viewBox: '-9 -7 18 14', 'aria-hidden': 'true' },
            svg('path', { class: `joint ${s}`, d: path(i, 5.5) }),
          ),
          i === 0 ? 'joint open' : `in ${WORDS[i]}`,
        ),
      ),
      kinds.map(kind =>
        el(
          'li',
          {},
          svg(
            'svg',
            { width: 18, height: 14, viewBox: '-9 -9 18 14', 'aria-hidden': 'true' },
            svg('path', { class: `wanting ${kind}`, d: mark(kind, 3.5) }),
          ),
          SAID[kind],
        ),
      ),
    );
  }

  /** Places between: the value of `list` at row `f` (a fraction of a frame), column `i` of `n`. */
  function between(list, f, i, n) {
    const a = Math.floor(f),
      t = f - a,
      v = list[a * n + i];
    return t > 0 ? v + t * (list[(a + 1) * n + i] - v) : v;
  }

  function scene(play, stage, exaggeration) {
    const bridge = play.bridge ?? data.bridge,
      xs = bridge.position_x_m,
      P = xs.length,
      J = bridge.joints.length,
      length = xs[P - 1],
      module = bridge.module_length_m;
    const wanting = bridge.joints.map(joint =>
      bridge.lost_joints?.includes(joint) ? 'lost' : bridge.open_joints?.includes(joint) ? 'uncoupled' : '',
    );
    const banks = bridge.banks ?? [];
    const moved = array(play.deflection_m),
      w = play.rest_m ? moved.map((v, k) => v + play.rest_m[k % P]) : moved,
      river = bridge.water_level_m ?? 0,
      force = array(play.force_n),
      state = array(play.state),
      vehicles = play.vehicles.map(v => ({ ...v, front: array(v.front_x_m), sense: v.backward ? -1 : 1 }));
    const down = w.reduce((a, v) => Math.max(a, v), 0),
      up = w.reduce((a, v) => Math.max(a, -v), 0),
      most = force.reduce((a, v) => Math.max(a, Math.abs(v)), 0);
    const tall = Math.max(1, Math.round((0.024 * length) / bridge.depth_m));
    // of each module the heights of its bottom at the left and the right end, then of its deck
    const level = [0, 0, bridge.depth_m, bridge.depth_m],
      heights = d3.range(P - 1).map(i => bridge.module_heights_m?.[i] ?? level),
      low = Math.min(0, ...heights.flat()),
      high = Math.max(...heights.flat());
    /** Height of the bottom at a position. */
    const bottomAt = p => (p < P - 1 ? heights[p][0] : heights[p - 1][1]);
    /** Height of the lower deck at a position. */
    const deckAt = p => Math.min(p > 0 ? heights[p - 1][3] : Infinity, p < P - 1 ? heights[p][2] : Infinity);
    let part = {},
      width = 0,
      s = 1,
      E = exaggeration,
      left = 0,
      base = 0,
      thick = 0,
      px = 0,
      bars = 0;
    const X = x => left + x * s,
      names = ['time', 'front axle', 'deepest', 'highest', 'largest compression', 'largest tension'];

    function rebuild(by) {
      E = by;
      width = page.dom.room(stage) || 800;
      left = Math.max(30, 0.045 * width);
      s = (width - 2 * left) / length;
      thick = Math.max(7, bridge.depth_m * tall * s);
      px = thick / bridge.depth_m;
      const head = Math.max(18, 0.03 * width) + 12,
        top = head + up * E * s;
      base = top + high * px;
      const floor = base - low * px + Math.max(down * E * s, 0.03 * width) + 8,
        ruler = floor + 14,
        barTop = ruler + 44,
        reach = 34;
      bars = barTop + reach + 6;
      const height = bars + reach + 22,
        water = base - (bridge.draft_m > 0 ? bridge.draft_m / bridge.depth_m : 0.5) * thick - river * E * s;
      const ticks = d3
        .scaleLinear([0, length], [0, 1])
        .ticks(Math.max(3, Math.round(width / 110)))
        .filter(t => t <= length);
      const size = Math.max(3, Math.min(6.5, 0.3 * module * s));
      const bar = d3.tickStep(0, Math.max(down, 1e-6), 2);
      part = {
        modules: d3.range(P - 1).map(i => svg('polygon', { class: 'module', 'data-module': i + 1 })),
        joints: d3.range(J).map(j => svg('path', { class: 'joint', 'data-joint': bridge.joints[j] })),
        wanting: d3
          .range(J)
          .filter(j => wanting[j])
          .map(j => ({
            j,
            node: svg('path', {
              class: `wanting ${wanting[j]}`,
              'data-joint': bridge.joints[j],
              d: mark(wanting[j], size),
            }),
          })),
        forces: d3
          .range(J)
          .map(j =>
            svg('rect', { class: 'force', 'data-joint': bridge.joints[j], width: Math.max(2, 0.45 * module * s) }),
          ),
        wheels: vehicles.map((v, k) =>
          v.axles.map(a => svg('line', { class: 'wheel', 'data-vehicle': k, 'data-behind': a.behind_front_m })),
        ),
        bodies: vehicles.map(() => svg('path', { class: 'vehicle' })),
        size,
      };
      const node = svg(
        'svg',
        {
          class: 'bridge',
          viewBox: `0 0 ${width} ${height}`,
          width,
          height,
          role: 'img',
          'aria-label': 'The bridge from the side',
          'aria-describedby': 'crossing-readout',
          'data-px-m': s,
          'data-left': left,
          'data-base': base,
          'data-scale': E,
        },
        svg('rect', { class: 'water', x: 0, y: water, width, height: floor - water }),
        svg('line', { class: 'waterline', x1: 0, x2: width, y1: water, y2: water }),
        svg('line', { class: 'rest', x1: X(0), x2: X(length), y1: base, y2: base }),
        [
          [0, X(0), deckAt(0)],
          [X(length), width, deckAt(P - 1)],
        ].map(([a, b, z]) => svg('line', { class: 'bank', x1: a, x2: b, y1: base - z * px, y2: base - z * px })),
        banks.map(b =>
          spring(X(xs[b.position - 1]), base - bottomAt(b.position - 1) * px + b.clearance_m * E * s, b.bank),
        ),
        part.modules,
        part.bodies,
        part.wheels.flat(),
        part.joints,
        part.wanting.map(w => w.node),
        svg(
          'g',
          { class: 'ruler' },
          svg('line', { x1: X(0), x2: X(length), y1: ruler, y2: ruler }),
          ticks.map(t => [
            svg('line', { x1: X(t), x2: X(t), y1: ruler, y2: ruler + 5 }),
            svg(
              'text',
              { x: X(t), y: ruler + 18, 'text-anchor': 'middle' },
              t === ticks.at(-1) ? `${numbers.plain(t)} m` : numbers.plain(t),
            ),
          ]),
        ),
        down > 0 &&
          svg(
            'g',
            { class: 'ruler measure' },
            svg('line', { x1: 6, x2: 6, y1: base, y2: base + bar * E * s }),
            svg('line', { x1: 2, x2: 10, y1: base, y2: base }),
            svg('line', { x1: 2, x2: 10, y1: base + bar * E * s, y2: base + bar * E * s }),
            svg(
              'text',
              { transform: `translate(22,${base + (bar * E * s) / 2}) rotate(-90)`, 'text-anchor': 'middle' },
              `${numbers.plain(bar)} m`,
            ),
          ),
        J > 0 &&
          svg(
            'g',
            { class: 'ruler' },
            svg('line', { x1: X(0), x2: X(length), y1: bars, y2: bars }),
            svg('text', { x: 2, y: bars - reach - 6 }, `tension, bar to ${numbers.quantity(most, 'N', 3)}`),
            svg('text', { x: 2, y: bars + reach + 16 }, 'compression'),
          ),
        part.forces,
      );
      part.reach = reach;
      stage.replaceChildren(
        node,
        legend(state, wanting),
        el(
          'p',
          { class: 'sub scale' },
          `Displacements are drawn ${E} ${E === 1 ? 'time' : 'times'} as large as they are, the depth of the modules ${tall === 1 ? 'as it is' : `${tall} times`}. ${bridge.draft_m > 0 ? 'The water line is that of modules that float by themselves.' : 'The water line is drawn at half the depth.'}${play.rest_m ? ' The dashed line is where they would float; the bridge starts from its dead state.' : ''}`,
        ),
      );
      part.node = node;
    }

    /** Where the deck is drawn under x: the module's own line; off the bridge that of its end at rest. */
    function deckY(f, x) {
      if (x <= xs[0]) return base - heights[0][2] * px;
      if (x >= length) return base - heights[P - 2][3] * px;
      let i = 0;
      while (i < P - 2 && xs[i + 1] <= x) i++;
      const t = (x - xs[i]) / (xs[i + 1] - xs[i]),
        sink = between(w, f, i, P) * (1 - t) + between(w, f, i + 1, P) * t;
      return base - (heights[i][2] * (1 - t) + heights[i][3] * t) * px + sink * E * s;
    }

    function draw(f, time) {
      const at = i => base + between(w, f, i, P) * E * s,
        whole = Math.floor(f),
        x0 = between(vehicles[0].front, f, 0, 1);
      part.modules.forEach((node, i) => {
        const a = at(i),
          b = at(i + 1),
          [z0, z1, d0, d1] = heights[i],
          lean = (b - a) / (xs[i + 1] - xs[i]);
        node.setAttribute(
          'points',
          [
            [X(xs[i]) + lean * z0, a - z0 * px],
            [X(xs[i + 1]) + lean * z1, b - z1 * px],
            [X(xs[i + 1]) + lean * d1, b - d1 * px],
            [X(xs[i]) + lean * d0, a - d0 * px],
          ]
            .map(p => p.map(v => v.toFixed(2)).join())
            .join(' '),
        );
      });
      let push = -1,
        pull = -1;
      part.joints.forEach((node, j) => {
        const p = bridge.joints[j] - 1,
          k = state[whole * J + j] & 3,
          F = between(force, f, j, J),
          y = at(p) - deckAt(p) * px,
          pixels = most > 0 ? (Math.abs(F) / most) * part.reach : 0;
        node.setAttribute('class', `joint ${STATES[k]}`);
        node.setAttribute('d', path(k, part.size));
        node.setAttribute('transform', `translate(${X(xs[p]).toFixed(2)},${y.toFixed(2)})`);
        const bar = part.forces[j],
          wide = Number(bar.getAttribute('width'));
        bar.setAttribute('class', `force ${F < 0 ? 'compression' : 'tension'}`);
        bar.setAttribute('x', (X(xs[p]) - wide / 2).toFixed(2));
        bar.setAttribute('y', (F < 0 ? bars : bars - pixels).toFixed(2));
        bar.setAttribute('height', pixels.toFixed(2));
        if (F < 0 && (push < 0 || F < between(force, f, push, J))) push = j;
        if (F > 0 && (pull < 0 || F > between(force, f, pull, J))) pull = j;
      });
      for (const { j, node } of part.wanting) {
        const p = bridge.joints[j] - 1;
        node.setAttribute('transform', `translate(${X(xs[p]).toFixed(2)},${(at(p) - deckAt(p) * px).toFixed(2)})`);
      }
      vehicles.forEach((vehicle, k) => {
        const at = between(vehicle.front, f, 0, 1);
        let from = Infinity,
          to = -Infinity,
          high = -Infinity;
        vehicle.axles.forEach((axle, i) => {
          const x = at - vehicle.sense * axle.behind_front_m,
            half = axle.patch_length_m / 2,
            y = deckY(f, x) - 2.5;
          const line = part.wheels[k][i];
          line.setAttribute('x1', X(x - half).toFixed(2));
          line.setAttribute('x2', Math.max(X(x + half), X(x - half) + 3).toFixed(2));
          line.setAttribute('y1', (deckY(f, x - half) - 2.5).toFixed(2));
          line.setAttribute('y2', (deckY(f, x + half) - 2.5).toFixed(2));
          from = Math.min(from, X(x - half));
          to = Math.max(to, X(x + half));
          high = Math.max(high, -y);
        });
        // the cab is at the end that drives ahead
        const tall = Math.max(12, 0.02 * width),
          y = -high - 3,
          ahead = vehicle.sense > 0,
          tail = ahead ? from : to,
          head = ahead ? Math.max(to, from + 8) : Math.min(from, to - 8),
          cab = head - vehicle.sense * Math.min(tall, Math.abs(head - tail) * 0.35);
        part.bodies[k].setAttribute(
          'd',
          `M${tail.toFixed(2)} ${y.toFixed(2)}V${(y - tall * 0.7).toFixed(2)}H${cab.toFixed(2)}V${(y - tall).toFixed(2)}H${((head + cab) / 2).toFixed(2)}L${head.toFixed(2)} ${(y - tall * 0.5).toFixed(2)}V${y.toFixed(2)}z`,
        );
      });
      part.node.setAttribute('data-frame', f);
      part.node.setAttribute('data-time', time);
      part.node.setAttribute('data-front', x0);
      let deep = 0,
        high2 = 0;
      for (let i = 1; i < P; i++) {
        const v = between(moved, f, i, P);
        if (v > between(moved, f, deep, P)) deep = i;
        if (v < between(moved, f, high2, P)) high2 = i;
      }
      const wd = between(moved, f, deep, P),
        wu = -between(moved, f, high2, P),
        N = j => numbers.quantity(Math.abs(between(force, f, j, J)), 'N', 4);
      return [
        `${time.toFixed(2)} s`,
        `${x0.toFixed(1)} m`,
        wd > 0 ? `${wd.toFixed(4)} m at position ${deep + 1}` : 'none',
        wu > 5e-5 ? `${wu.toFixed(4)} m at position ${high2 + 1}` : 'none',
        push < 0 ? 'none' : `${N(push)} at joint ${bridge.joints[push]}`,
        pull < 0 ? 'none' : `${N(pull)} at joint ${bridge.joints[pull]}`,
      ];
    }

    rebuild(exaggeration);
    return { draw, rebuild, names, resized: () => Math.abs(page.dom.room(stage) - width) > 1 };
  }

  page.bridgeScene = scene;
})((globalThis.pontoon ??= {}));
