// Heat maps: a measure over any two axes of the design, the others on stops.
(page => {
  'use strict';
  const { data, numbers, axes, cells } = page,
    { el, section, field, select } = page.dom;

  function heat() {
    const varying = cells.varying();
    if (!data.cells?.count || !data.measures.length || varying.length < 2) return null;
    const several = i => data.axes[i].values.filter(v => v !== null).length > 1;
    const rank = ['gap_tension_m', 'speed_m_s', 'load_position', 'load_x_m', 'gap_compression_m', 'load_n']
      .map(cells.axis)
      .filter(i => varying.includes(i))
      .sort((a, b) => several(b) - several(a));
    const [x, y] = [...rank, ...varying.filter(i => !rank.includes(i))];
    const state = {
      x: y,
      y: x,
      measure: cells.first(['rated_value', 'peak_deflection_m']),
      statistic: 'max',
      own: false,
      fixed: cells.usual(),
    };
    const controls = el('div', { class: 'controls' }),
      stops = el('div', { class: 'controls stops' });
    const chart = page.figure('heat-map', {
      title: '',
      label: 'Heat map',
      draw: width => draw(state, width),
      hint: 'Point at a cell, or focus the map and use the arrow keys, to read it; click or Enter picks its job.',
    });

    function rebuild() {
      const focus = document.activeElement?.dataset?.role,
        role = (node, name) => {
          node.dataset.role = name;
          return node;
        };
      const pairs = varying.map(i => [String(i), data.axes[i].label]);
      const change = (key, other) => v => {
        const before = state[key];
        state[key] = Number(v);
        if (state[key] === state[other]) state[other] = before;
        rebuild();
        chart.redraw();
      };
      const own = el('input', {
        type: 'checkbox',
        checked: state.own,
        onchange: () => {
          state.own = own.checked;
          chart.redraw();
        },
      });
      controls.replaceChildren(
        field('Across', role(select(pairs, String(state.x), change('x', 'y')), 'heat-x')),
        field('Up', role(select(pairs, String(state.y), change('y', 'x')), 'heat-y')),
        field(
          'Measure',
          role(
            select(
              data.measures.map((m, i) => [String(i), m.label]),
              String(state.measure),
              v => {
                state.measure = Number(v);
                chart.redraw();
              },
            ),
            'heat-measure',
          ),
        ),
        field(
          'Of several jobs',
          role(
            select(
              [
                ['max', 'the largest'],
                ['min', 'the smallest'],
              ],
              state.statistic,
              v => {
                state.statistic = v;
                chart.redraw();
              },
            ),
            'heat-statistic',
          ),
        ),
        el('label', { class: 'check' }, role(own, 'heat-own'), 'colours span this view alone'),
      );
      const free = varying.filter(i => i !== state.x && i !== state.y);
      stops.replaceChildren(
        ...free.map(a =>
          axes.stop(a, state.fixed.get(a) ?? null, i => {
            if (i === null) state.fixed.delete(a);
            else state.fixed.set(a, i);
            chart.redraw();
          }),
        ),
      );
      stops.hidden = !free.length;
      if (focus) controls.querySelector(`[data-role="${focus}"]`)?.focus();
    }
    rebuild();
    return section('heat', 'Heat map', controls, stops, chart.node);
  }

  function draw(state, width) {
    const { x, y, measure: m, statistic } = state,
      measure = data.measures[m],
      fixed = new Map([...state.fixed].filter(([a]) => a !== x && a !== y));
    const part = cells.slice([y, x], fixed, m, statistic),
      nx = data.axes[x].values.length,
      ny = data.axes[y].values.length;
    const title = `${measure.label[0].toUpperCase()}${measure.label.slice(1)} over ${data.axes[x].label} and ${data.axes[y].label}`,
      note = axes.choice(fixed, [x, y]).replaceAll(axes.ALL, statistic === 'max' ? axes.ALL : 'all (smallest)');
    const here = part.value.filter(v => !Number.isNaN(v)),
      range = state.own && here.length ? d3.extent(here) : cells.range(m, statistic);
    if (!here.length || !range)
      return {
        title,
        note,
        empty: part.failed.some(n => n > 0)
          ? 'Every job of this choice failed.'
          : 'No job has this combination: choose other stops.',
      };
    const scale = page.heat.colours(range),
      unit = numbers.unit(measure.unit, Math.max(Math.abs(range[0]), Math.abs(range[1])));
    const cell = (i, j) => {
      const c = j * nx + i,
        v = part.value[c],
        job = part.at[c],
        many = part.jobs[c];
      const where = `${data.axes[x].label} ${axes.name(x, i)}, ${data.axes[y].label} ${axes.name(y, j)}: `;
      const value = !many
        ? 'no job'
        : Number.isNaN(v)
          ? part.failed[c] === many
            ? `${many === 1 ? 'the job' : `all ${many} jobs`} failed`
            : 'no value'
          : `${measure.label} ${numbers.quantity(v, measure.unit)}${job === page.NONE.u32 ? '' : `, job ${job}`}`;
      return {
        job: job === page.NONE.u32 ? null : job,
        text: () =>
          where +
          value +
          (many > 1 && !Number.isNaN(v)
            ? ` (${statistic === 'max' ? 'largest' : 'smallest'} of ${numbers.count(many)} jobs)`
            : '') +
          (part.failed[c] && part.failed[c] < many ? `; ${part.failed[c]} failed` : ''),
      };
    };
    const names = (a, n) => d3.range(n).map(i => axes.tick(a, i));
    const height = Math.min(520, Math.max(220, 74 + ny * Math.min(48, 420 / Math.min(ny, 12))));
    const out = page.grid({
      width,
      height,
      scale,
      cell,
      value: part.value,
      jobs: part.jobs,
      x: { title: axes.title(x), names: names(x, nx) },
      y: { title: axes.title(y), names: names(y, ny) },
    });
    out.node.setAttribute('data-low', scale.low);
    out.node.setAttribute('data-high', scale.high);
    return {
      ...out,
      title,
      note,
      legend: [
        page.heat.strip(scale, numbers.axisTitle(measure.label, unit.unit), v => numbers.digits(v * unit.factor, 3)),
        el(
          'ul',
          { class: 'keys' },
          el('li', {}, el('span', { class: 'swatch nothing' }), 'no job'),
          part.failed.some(n => n > 0) && el('li', {}, el('span', { class: 'swatch failed' }), 'failed'),
        ),
      ],
      table:
        nx * ny > 2500
          ? null
          : () => [
              [`${axes.title(y)} \\ ${axes.title(x)}`, ...names(x, nx)],
              ...d3
                .range(ny)
                .map(j => [
                  axes.tick(y, j),
                  ...d3.range(nx).map(i => numbers.digits(part.value[j * nx + i] * unit.factor)),
                ]),
            ],
    };
  }

  page.heatmap = heat;
})((globalThis.pontoon ??= {}));
