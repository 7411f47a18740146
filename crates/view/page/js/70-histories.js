// Histories of the jobs that recorded them: one chart a quantity, a line a position, of the job that is chosen here or picked anywhere.
(page => {
  'use strict';
  const { data, numbers, array } = page,
    { el, section, field, select } = page.dom;
  const TITLES = {
    deflection_m: ['Deflection', 'deflection, downward', true],
    force_n: ['Connector force', 'force of a joint, tension upward', false],
    pin_x_n: ['Pin force along the bridge', 'force on the module on the left, toward the right end upward', false],
    pin_y_n: ['Pin force across', 'force on the module on the left, toward +y upward', false],
    pin_z_n: ['Vertical pin force', 'force on the module on the left, upward', false],
    angle_rad: ['Joint angle', 'angle, open at the deck upward', false],
    axial_n: ['Axial force', 'axial force, tension upward', false],
    shear_y_n: ['Shear across', 'shear across', false],
    shear_z_n: ['Vertical shear', 'shear, upward on the part on the left', false],
    torsion_nm: ['Torsion', 'torsion', false],
    bending_nm: ['Bending moment', 'bending moment, deck compressed upward', false],
    wheel_n: ['Wheel force', 'force of a wheel on the deck', false],
    bounce_m: ['Bounce', 'bounce of the body, upward', false],
    pitch_rad: ['Pitch', 'pitch, front of the body upward', false],
    roll_rad: ['Roll', 'roll, left side of the body upward', false],
    lateral_bending_nm: ['Lateral bending moment', 'bending moment about the vertical', false],
  };

  function histories() {
    const list = data.histories ?? [];
    if (!list.length) return null;
    const jobs = [...new Map(list.map(h => [h.job, h.axes])).entries()],
      quantities = [...new Set(list.map(h => h.quantity))];
    let job = jobs[0][0];
    const said = el('p', { class: 'sub', role: 'status' });
    const charts = quantities.map(quantity =>
      page.figure(`history-${quantity.replace(/[^a-z0-9]/gi, '-')}`, {
        title: `${TITLES[quantity]?.[0] ?? quantity} over time`,
        draw: width => draw(job, quantity, width),
      }),
    );
    const pick = select(
      jobs.map(([n, axes]) => [String(n), `job ${n}: ${axes}`]),
      String(job),
      v => {
        job = Number(v);
        said.textContent = '';
        charts.forEach(c => c.redraw());
      },
    );
    pick.id = 'history-job';
    page.onPick(n => {
      if (!jobs.some(([j]) => j === n)) {
        said.textContent = `Job ${n} has no history on this page; job ${job} is shown.`;
        return;
      }
      job = n;
      pick.value = String(n);
      said.textContent = '';
      charts.forEach(c => c.redraw());
    });
    const wide = field('Job', pick);
    wide.classList.add('wide');
    return section(
      'histories',
      'Histories',
      el('div', { class: 'controls' }, wide),
      said,
      charts.map(c => c.node),
    );
  }

  function draw(job, quantity, width) {
    const mine = data.histories.filter(h => h.job === job && h.quantity === quantity),
      [, axis, reverse] = TITLES[quantity] ?? [quantity, quantity, false];
    if (!mine.length) return { empty: `Job ${job} did not record this.` };
    const series = mine.map((h, i) => {
      const time = array(h.time_s),
        value = array(h.value);
      return {
        key: h.place,
        label: h.place,
        ...page.look(i, mine.length),
        symbol: null,
        dots: false,
        thin: true,
        points: Array.from(time, (t, k) => ({
          x: t,
          y: value[k],
          text: () => `${h.place} at ${numbers.quantity(t, 's')}: ${numbers.quantity(value[k], h.unit)}`,
        })),
      };
    });
    let most = 0;
    for (const s of series) for (const p of s.points) most = Math.max(most, Math.abs(p.y) || 0);
    const at = page.rowOf(job),
      unit = numbers.unit(mine[0].unit, most);
    const marks = (data.marks ?? [])
      .filter(
        m =>
          m.chart === 'history' &&
          (m.measure === quantity || m.measure === `peak_${quantity}`) &&
          mine.some(h => m.position === null || m.position === undefined || h.position === m.position) &&
          (at < 0 || page.axes.fitsRow(m, at)),
      )
      .map(m => ({ ...m, text: () => `${m.label}: ${numbers.quantity(m.y, mine[0].unit)}` }));
    const out = page.lines({
      width,
      height: 260,
      series,
      marks,
      x: { title: 'time (s)' },
      y: { title: numbers.axisTitle(axis, unit.unit), factor: unit.factor, reverse },
    });
    return {
      ...out,
      note: mine.length > 1 ? mine[0].axes : `${mine[0].place}: ${mine[0].axes}`,
      legend: page.legend(series, marks),
    };
  }

  page.histories = histories;
})((globalThis.pontoon ??= {}));
