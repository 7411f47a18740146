// Mode shapes: the modules' boxes in an oblique view, moving to and fro. Knows corners and motions; solves nothing.
(page => {
  'use strict';
  const { data, numbers, array } = page,
    { el, svg, section, field, select, button, animation, motionless } = page.dom;
  const FACES = [
    ['end', [0, 4, 7, 3]],
    ['side', [0, 1, 5, 4]],
    ['deck', [4, 5, 6, 7]],
    ['end', [1, 2, 6, 5]],
  ];

  function modes() {
    const sets = (data.modes ?? []).filter(set => set.list.length);
    if (!sets.length) return null;
    const { bridge } = data;
    let set = sets[0],
      mode = set.list[0],
      amplitude = 1,
      phase = 1,
      clock = 0,
      width = 0,
      kept = 0;
    const stage = el('div', { class: 'stage modes-stage' }),
      said = el('p', { class: 'sub', role: 'status' });
    const body = el('tbody'),
      table = el(
        'table',
        { class: 'rows modes-list' },
        el('caption', { class: 'unseen' }, 'Natural frequencies'),
        el(
          'thead',
          {},
          el(
            'tr',
            {},
            el('th', { scope: 'col' }, 'mode'),
            el('th', { scope: 'col', class: 'number' }, 'frequency', el('span', { class: 'unit' }, 'Hz')),
            el('th', { scope: 'col' }, 'shape'),
          ),
        ),
        body,
      );
    const run = button('Play', () => (motion.running ? pause() : start()), { class: 'primary', id: 'mode-play' });
    const size = el('input', {
      type: 'range',
      min: 0,
      max: 3,
      step: 0.1,
      id: 'mode-amplitude',
      oninput: () => {
        amplitude = Number(size.value);
        draw();
      },
    });
    size.value = 1;
    const choose = select(
      sets.map((s, i) => [String(i), s.label]),
      '0',
      v => {
        set = sets[Number(v)];
        list();
        pick(set.list[0]);
      },
    );
    const modesOf = field('Modes of', choose);
    modesOf.classList.add('wide');
    const controls = el(
      'div',
      { class: 'controls' },
      el('div', { class: 'buttons' }, run),
      sets.length > 1 && modesOf,
      field('Amplitude', size),
    );
    const motion = animation(passed => {
      clock += passed;
      phase = Math.cos(clock / 450);
      draw();
    });
    function start() {
      motion.start();
      run.textContent = 'Pause';
    }
    function pause() {
      motion.stop();
      run.textContent = 'Play';
    }

    function list() {
      body.replaceChildren(
        ...set.list.map(m =>
          el(
            'tr',
            { onclick: () => pick(m, true), class: m === mode ? 'picked' : null },
            el(
              'th',
              { scope: 'row' },
              el(
                'button',
                { type: 'button', class: 'pick', 'aria-pressed': String(m === mode), 'aria-label': `Mode ${m.number}` },
                String(m.number),
              ),
            ),
            el('td', { class: 'number' }, m.frequency_hz.toFixed(4)),
            el('td', {}, m.shape),
          ),
        ),
      );
    }

    function pick(next, byHand) {
      const focused = body.contains(document.activeElement);
      mode = next;
      phase = 1;
      clock = 0;
      list();
      if (focused) body.querySelector('[aria-pressed="true"]')?.focus();
      said.textContent = `${set.label}: mode ${mode.number}, ${mode.frequency_hz.toFixed(4)} Hz, ${mode.shape}`;
      build();
      if (byHand && !motionless.matches) start();
    }

    let faces = [],
      view = {};
    /** Where so many modules end along the bridge; of another number of modules than the bridge has they are alike. */
    const end = n => {
      const xs = bridge.position_x_m;
      return array(mode.motion).length / 24 === xs.length - 1 ? xs[n] : bridge.module_length_m * n;
    };
    /** Height of a module's corner: bottom at the left and the right end, then deck. */
    const height = (m, c) => {
      const right = c % 4 === 1 || c % 4 === 2 ? 1 : 0;
      return (bridge.module_heights_m?.[m] ?? [0, 0, bridge.depth_m, bridge.depth_m])[(c >= 4 ? 2 : 0) + right];
    };
    /** The boxes' rest position, right to left and far to near, so that the near ones cover. */
    function build() {
      width = page.dom.room(stage) || 800;
      // A set of modes may be of another bridge of the study: its motion says how many modules it has.
      const modules = array(mode.motion).length / 24,
        L = end(modules),
        reach = 0.055 * L,
        heights = (bridge.module_heights_m ?? []).flat(),
        low = Math.min(0, ...heights),
        high = Math.max(bridge.depth_m, ...heights) - low;
      const s = Math.min(
        (width - 20) / (L + 0.55 * bridge.breadth_m + 2 * reach),
        300 / (2.1 * reach + 2 * high + 0.45 * bridge.breadth_m),
      );
      const tall = (2.1 * reach + high * 2 + 0.45 * bridge.breadth_m) * s + 20;
      view = {
        s,
        reach,
        X: (x, y) => 10 + (reach + x + 0.55 * y) * s,
        Y: (y, z) => tall - 10 - reach * s - (z - 1.6 * low + 0.45 * y) * s,
      };
      faces = [];
      const nodes = [];
      for (let m = 0; m < modules; m++)
        for (const [kind, corners] of FACES) {
          const node = svg('polygon', { class: `box ${kind}`, 'data-module': m + 1 });
          faces.push({ m, corners, kind, node });
          nodes.push(node);
        }
      const flat = (y, z) =>
        [
          [0, y],
          [L, y],
        ].map(([x, b]) => `${view.X(x, b).toFixed(1)},${view.Y(b, z).toFixed(1)}`);
      const outline = svg('polygon', {
        class: 'rest',
        points: [...flat(0, 0), ...flat(bridge.breadth_m, 0).reverse()].join(' '),
      });
      stage.replaceChildren(
        svg(
          'svg',
          {
            class: 'boxes',
            viewBox: `0 0 ${width} ${tall}`,
            width,
            height: tall,
            role: 'img',
            'aria-label': `Mode shape: ${mode.shape}`,
          },
          outline,
          nodes,
        ),
      );
      draw();
    }

    function draw() {
      const motion = array(mode.motion),
        { X, Y, reach } = view,
        scale = reach * amplitude * phase,
        B = bridge.breadth_m;
      const corner = (m, c) => {
        const k = (m * 8 + c) * 3,
          x = end(m + (c % 4 === 1 || c % 4 === 2 ? 1 : 0)),
          y = c % 4 >= 2 ? B : 0,
          z = height(m, c) * 1.6;
        const px = x + scale * motion[k],
          py = y + scale * motion[k + 1],
          pz = z + scale * motion[k + 2];
        return `${X(px, py).toFixed(1)},${Y(py, pz).toFixed(1)}`;
      };
      for (const face of faces) {
        face.node.setAttribute('points', face.corners.map(c => corner(face.m, c)).join(' '));
        if (face.kind === 'deck') {
          const lift = (phase * face.corners.reduce((a, c) => a + motion[(face.m * 8 + c) * 3 + 2], 0)) / 4;
          face.node.style.fill = `color-mix(in srgb, var(--${lift < 0 ? 'tension' : 'compression'}) ${Math.round(Math.min(1, Math.abs(lift)) * 85)}%, var(--deck))`;
        }
      }
    }

    page.paper.push({
      freeze() {
        kept = phase;
        pause();
        phase = 1;
        build();
      },
      thaw() {
        phase = kept;
        build();
      },
    });
    document.addEventListener('visibilitychange', () => document.hidden && pause());
    page.dom.resized(stage, () => Math.abs(page.dom.room(stage) - width) > 1 && build());
    list();
    pick(mode);
    return section(
      'modes',
      'Mode shapes',
      said,
      stage,
      el(
        'p',
        { class: 'sub' },
        'Oblique view; the largest motion is drawn as a twentieth of the length, the depth 1.6 times. Decks that rise are blue, decks that sink orange.',
      ),
      controls,
      page.dom.scroller('Modes to choose from', table),
    );
  }

  page.modes = modes;
})((globalThis.pontoon ??= {}));
