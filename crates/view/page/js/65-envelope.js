// The envelope along the bridge: the deepest and highest line of all jobs, the picked job's own, the measured profile; below it that of the joints' forces.
(page => {
  'use strict';
  const { data, numbers, array, row } = page,
    { section } = page.dom;
  const most = lists =>
    lists.reduce((a, list) => list.reduce((b, v) => (Number.isNaN(v) ? b : Math.max(b, Math.abs(v))), a), 0);

  function envelope() {
    if (!data.envelope) return null;
    const charts = [
      page.figure('envelope-deflection', { title: 'Deflection and uplift along the bridge', draw: deflection }),
      page.figure('envelope-force', { title: 'Connector forces along the bridge', draw: force }),
    ];
    page.onPick(() => charts.forEach(chart => chart.redraw()));
    return section(
      'envelope',
      data.study.kind === 'static' ? 'Deflected line and envelope' : 'Envelope along the bridge',
      charts.map(c => c.node),
    );
  }

  const own = (key, width) => {
    const at = page.picked === null ? -1 : page.rowOf(page.picked),
      packed = data.rows?.profile?.[key];
    if (at < 0 || !packed) return null;
    const values = row(packed, at, width);
    return values.some(v => !Number.isNaN(v)) ? values : null;
  };

  /** A series over places; `sign` -1 draws what counts upward below zero. */
  function series(key, label, xs, values, sign, style, say) {
    return {
      key,
      label,
      ...style,
      points: Array.from(values, (v, i) => ({ x: xs[i], y: sign * v, job: undefined, text: () => say(i, v) })),
    };
  }

  function deflection(width) {
    // Of jobs with more and with fewer modules it is the longest bridge; profiles are as wide.
    const { envelope: all } = data,
      xs = all.x_m,
      n = xs.length;
    const say = what => (i, v) =>
      `position ${i + 1}, x ${numbers.quantity(xs[i], 'm')}: ${what} ${numbers.quantity(v, 'm')}`;
    const list = [],
      job = page.picked;
    list.push(
      series(
        'deflection',
        'deflection, all jobs',
        xs,
        array(all.deflection_m),
        1,
        { color: 'var(--envelope)', dash: 'none', area: true, dots: false, symbol: null },
        say('largest deflection of all jobs'),
      ),
    );
    list.push(
      series(
        'uplift',
        'uplift, all jobs',
        xs,
        array(all.uplift_m),
        -1,
        { color: 'var(--envelope)', dash: '6 3', area: true, dots: false, symbol: null },
        say('largest uplift of all jobs'),
      ),
    );
    const down = own('deflection_m', n),
      up = own('uplift_m', n),
      line = own('signed_m', n);
    if (down)
      list.push(
        series(
          'job-deflection',
          `deflection, job ${job}`,
          xs,
          down,
          1,
          { color: 'var(--job)', dash: 'none', symbol: 'circle' },
          say(`job ${job}: deflection`),
        ),
      );
    if (up)
      list.push(
        series(
          'job-uplift',
          `uplift, job ${job}`,
          xs,
          up,
          -1,
          { color: 'var(--job)', dash: '6 3', symbol: 'square' },
          say(`job ${job}: uplift`),
        ),
      );
    if (line)
      list.push(
        series(
          'job-line',
          `deflected line, job ${job}`,
          xs,
          line,
          1,
          { color: 'var(--line-3)', dash: '2 3', symbol: 'diamond' },
          say(`job ${job}: deflected line`),
        ),
      );
    const at = job === null ? -1 : page.rowOf(job);
    const marks = (data.marks ?? [])
      .filter(m => m.chart === 'profile' && !m.measure.endsWith('_n') && (at < 0 || page.axes.fitsRow(m, at)))
      .map(m => ({
        ...m,
        y: m.measure === 'peak_uplift_m' ? -m.y : m.y,
        text: () =>
          `${m.label}${m.x === null ? '' : `, x ${numbers.quantity(m.x, 'm')}`}: ${numbers.quantity(m.y, 'm')}`,
      }));
    if (!list.length) return { empty: 'No job has a profile: pick one that did not fail.' };
    const unit = numbers.unit('m', most(list.map(s => s.points.map(p => p.y)))),
      out = page.lines({
        width,
        height: 300,
        series: list,
        marks,
        x: { title: 'along the bridge (m)' },
        y: { title: `deflection, downward (${unit.unit})`, factor: unit.factor, reverse: true },
      });
    return {
      ...out,
      note: job === null || at < 0 ? 'Uplift is drawn upward.' : `Uplift is drawn upward. Job ${job} is picked.`,
      legend: page.legend(list, marks),
      table: table('x (m)', xs, list, unit, 1),
    };
  }

  function force(width) {
    const { envelope: all } = data,
      xs = all.joint_x_m,
      n = xs.length;
    if (!n) return { empty: 'A bridge of one module has no joints.' };
    const say = what => (i, v) =>
      `joint ${i + 2}, x ${numbers.quantity(xs[i], 'm')}: ${what} ${numbers.quantity(v, 'N')}`;
    const list = [],
      job = page.picked;
    list.push(
      series(
        'compression',
        'compression, all jobs',
        xs,
        array(all.compression_n),
        -1,
        { color: 'var(--compression)', dash: 'none', symbol: null, dots: false, area: true },
        say('largest compression of all jobs'),
      ),
    );
    list.push(
      series(
        'tension',
        'tension, all jobs',
        xs,
        array(all.tension_n),
        1,
        { color: 'var(--tension)', dash: '6 3', symbol: null, dots: false, area: true },
        say('largest tension of all jobs'),
      ),
    );
    const push = own('compression_n', n),
      pull = own('tension_n', n);
    if (push)
      list.push(
        series(
          'job-compression',
          `compression, job ${job}`,
          xs,
          push,
          -1,
          { color: 'var(--job)', dash: 'none', symbol: 'circle' },
          say(`job ${job}: compression`),
        ),
      );
    if (pull)
      list.push(
        series(
          'job-tension',
          `tension, job ${job}`,
          xs,
          pull,
          1,
          { color: 'var(--job)', dash: '6 3', symbol: 'square' },
          say(`job ${job}: tension`),
        ),
      );
    if (!list.length) return { empty: 'No job has a profile: pick one that did not fail.' };
    const marks = (data.marks ?? [])
      .filter(
        m =>
          m.chart === 'profile' &&
          m.measure.endsWith('_n') &&
          page.axes.fitsRow(m, job === null ? -1 : page.rowOf(job)),
      )
      .map(m => ({
        ...m,
        y: m.measure.includes('compression') ? -m.y : m.y,
        text: () => `${m.label}: ${numbers.quantity(m.y, 'N')}`,
      }));
    const unit = numbers.unit('N', most(list.map(s => s.points.map(p => p.y)))),
      out = page.lines({
        width,
        height: 280,
        series: list,
        marks,
        x: { title: 'along the bridge (m)' },
        y: { title: `force of a joint, tension upward (${unit.unit})`, factor: unit.factor },
      });
    return {
      ...out,
      note: 'All connectors of a joint added; compression is drawn downward.',
      legend: page.legend(list, marks),
      table: table('x (m)', xs, list, unit, 1),
    };
  }

  const table = (head, xs, list, unit) => () => [
    [head, ...list.map(s => s.label)],
    ...Array.from(xs, (x, i) => [
      numbers.digits(x),
      ...list.map(s => numbers.digits(Math.abs(s.points[i].y) * unit.factor)),
    ]),
  ];

  page.envelope = envelope;
})((globalThis.pontoon ??= {}));
