// Peaks against speed (or any other number of the design): a line for each value of an axis, the others on stops, the experiment's points.
(page => {
  'use strict';
  const { data, numbers, axes, cells } = page,
    { el, section, field, select } = page.dom;

  function speed() {
    const numeric = data.axes
        .map((_, i) => i)
        .filter(i => data.axes[i].kind === 'number' && data.axes[i].values.some(v => v !== null)),
      several = i => data.axes[i].values.filter(v => v !== null).length > 1;
    if (!data.cells?.count || !data.measures.length || !numeric.length) return null;
    const varying = cells.varying(),
      prefer = names => names.map(cells.axis).find(i => varying.includes(i));
    const x =
      prefer(['speed_m_s', 'load_position', 'load_x_m']) ??
      numeric.find(several) ??
      numeric.find(i => varying.includes(i)) ??
      Math.max(cells.axis('speed_m_s'), numeric[0]);
    const others = varying.filter(i => i !== x);
    // Where a design is drawn at random lines of ranges zigzag, and lines of values hold a point each: one line to begin with.
    const filled = i => data.cells.count >= 2 * data.axes[i].values.length;
    const line = [prefer(['gap_tension_m', 'load_n', 'gap_compression_m']), ...others].find(
      i => i !== undefined && i !== x && others.includes(i) && filled(i) && !(data.axes[i].bins && data.axes[x].bins),
    );
    const rated = cells.measure('rated_value') >= 0,
      first = cells.first([rated ? 'rated_value' : 'peak_deflection_m']),
      second = cells.first([rated ? 'peak_deflection_m' : 'peak_compression_n'], Math.min(1, data.measures.length - 1));
    const state = { x, line: line ?? -1, fixed: cells.usual(), measures: [first, second] };
    const controls = el('div', { class: 'controls' }),
      stops = el('div', { class: 'controls stops' });
    const charts = state.measures.map((_, side) =>
      page.figure(`speed-${side + 1}`, {
        title: '',
        label: side ? 'Second chart' : 'First chart',
        draw: width => draw(state, side, width),
        hint: 'Point at the chart, or focus it and use the arrow keys, to read a value; click or Enter picks its job.',
      }),
    );
    const redraw = () => charts.forEach(chart => chart.redraw());

    function rebuild() {
      if (state.line === state.x) state.line = varying.find(i => i !== state.x) ?? -1;
      const free = varying.filter(i => i !== state.x && i !== state.line);
      const pairs = list => list.map(i => [String(i), data.axes[i].label]);
      const focus = document.activeElement?.dataset?.role;
      const role = (node, name) => {
        node.dataset.role = name;
        return node;
      };
      controls.replaceChildren(
        field(
          'Against',
          role(
            select(pairs(numeric.filter(i => varying.includes(i) || i === state.x)), String(state.x), v => {
              state.x = Number(v);
              rebuild();
              redraw();
            }),
            'speed-x',
          ),
        ),
        field(
          'A line for each',
          role(
            select(
              [['-1', 'nothing: one line'], ...pairs(varying.filter(i => i !== state.x))],
              String(state.line),
              v => {
                state.line = Number(v);
                rebuild();
                redraw();
              },
            ),
            'speed-line',
          ),
        ),
        ...state.measures.map((m, side) =>
          field(
            side ? 'Second chart' : 'First chart',
            role(
              select(
                data.measures.map((o, i) => [String(i), o.label]),
                String(m),
                v => {
                  state.measures[side] = Number(v);
                  charts[side].redraw();
                },
              ),
              `speed-measure-${side}`,
            ),
          ),
        ),
      );
      stops.replaceChildren(
        ...free.map(a =>
          axes.stop(a, state.fixed.get(a) ?? null, i => {
            if (i === null) state.fixed.delete(a);
            else state.fixed.set(a, i);
            redraw();
          }),
        ),
      );
      stops.hidden = free.length === 0;
      if (focus) controls.querySelector(`[data-role="${focus}"]`)?.focus();
    }
    rebuild();
    return section(
      'speed',
      `${rated ? 'Rated values' : 'Peaks'} against ${data.axes[x].label}`,
      controls,
      stops,
      el(
        'div',
        { class: 'pair' },
        charts.map(c => c.node),
      ),
    );
  }

  /** More lines than an eye can tell apart are thinned evenly, the first and the last kept. */
  const MOST_LINES = 24;
  const thin = list =>
    list.length <= MOST_LINES
      ? list
      : d3.range(MOST_LINES).map(i => list[Math.round((i * (list.length - 1)) / (MOST_LINES - 1))]);

  function draw(state, side, width) {
    const m = state.measures[side],
      measure = data.measures[m],
      { x, line } = state;
    const fixed = new Map([...state.fixed].filter(([a]) => a !== x && a !== line));
    const unit = numbers.unit(measure.unit, cells.range(m)?.reduce((a, b) => Math.max(a, Math.abs(b)), 0) ?? 0),
      factorX = axes.shown(x).factor;
    const part = cells.slice(line < 0 ? [x] : [line, x], fixed, m),
      nx = data.axes[x].values.length,
      nl = line < 0 ? 1 : data.axes[line].values.length;
    const series = [];
    for (let l = 0; l < nl; l++) {
      const points = data.axes[x].values
        .map((value, i) => ({ value, at: l * nx + i, i }))
        .filter(p => p.value !== null && !Number.isNaN(part.value[p.at]))
        .map(p => ({
          x: p.value,
          y: part.value[p.at],
          job: part.at[p.at] === page.NONE.u32 ? null : part.at[p.at],
          text: () =>
            `${data.axes[x].label} ${axes.name(x, p.i)}${line < 0 ? '' : `, ${data.axes[line].label} ${axes.name(line, l)}`}: ${measure.label} ${numbers.quantity(part.value[p.at], measure.unit)}, job ${part.at[p.at]}${part.jobs[p.at] > 1 ? ` (largest of ${numbers.count(part.jobs[p.at])} jobs)` : ''}${part.failed[p.at] ? `; ${part.failed[p.at]} failed` : ''}`,
        }));
      if (points.length)
        series.push({
          key: line < 0 ? 'all' : String(l),
          at: l,
          label: line < 0 ? '' : `${axes.name(line, l)}`,
          points,
        });
    }
    const drawn = thin(series);
    if (drawn.length < series.length) series.splice(0, series.length, ...drawn);
    series.forEach((s, i) => Object.assign(s, page.look(i, series.length)));
    const title = `${measure.label[0].toUpperCase()}${measure.label.slice(1)} against ${data.axes[x].label}`,
      note = [axes.choice(fixed, [x, line]), nl > MOST_LINES && `${series.length} of ${nl} lines are drawn`]
        .filter(Boolean)
        .join('; ');
    if (!series.length)
      return {
        title,
        note,
        empty: part.failed.some(n => n > 0)
          ? 'Every job of this choice failed.'
          : 'No job has this combination: choose other stops.',
      };
    const marks =
      data.axes[x].name === 'speed_m_s'
        ? (data.marks ?? [])
            .filter(
              k =>
                k.chart === 'speed' &&
                (k.table ?? 'jobs') === 'jobs' &&
                k.measure === measure.name &&
                axes.fits(k, fixed),
            )
            .map(k => {
              const of =
                line < 0
                  ? null
                  : series.find(
                      s =>
                        k.axes?.[data.axes[line].name] !== undefined &&
                        axes.find(line, k.axes[data.axes[line].name]) === s.at,
                    );
              return {
                ...k,
                color: of?.color,
                text: () =>
                  `${k.label}${k.position ? ` at position ${k.position}` : ''}${k.x === null ? '' : `, ${numbers.quantity(k.x, data.axes[x].unit)}`}: ${numbers.quantity(k.y, measure.unit)}`,
              };
            })
        : [];
    const out = page.lines({
      width,
      series,
      marks,
      x: { title: axes.title(x), factor: factorX },
      y: { title: numbers.axisTitle(measure.label, unit.unit), factor: unit.factor },
    });
    return {
      ...out,
      title,
      note,
      legend: page.legend(series, marks, line < 0 ? null : data.axes[line].label),
      table: () => [
        [axes.title(x), ...series.map(s => s.label || measure.label)],
        ...[...new Set(series.flatMap(s => s.points.map(p => p.x)))]
          .sort((a, b) => a - b)
          .map(v => [
            numbers.plain(v * factorX),
            ...series.map(s => numbers.digits((s.points.find(p => p.x === v)?.y ?? NaN) * unit.factor)),
          ]),
      ],
    };
  }

  page.speed = speed;
})((globalThis.pontoon ??= {}));
