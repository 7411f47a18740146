// Lines against speed, envelopes, histories: what is drawn, read back by the axes' own ticks, is what the data says, mark for mark.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, sample } from './browser.mjs';
import { curves, factor, list, ruler } from './expect.mjs';
import { chart } from './geometry.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

// Half a pixel: paths are written with three decimals, ticks on exact places; a wrong point is many pixels off.
const PIXEL = 0.5;
const title = (drawn, axis) => drawn[axis === 'x' ? 'titleX' : 'titleY'];

/** Compares points in pixels with values in the data's units. */
function same(points, wanted, drawn, units, what) {
  assert.equal(points.length, wanted.length, `${what}: number of marks`);
  const x = ruler(drawn.x),
    y = ruler(drawn.y),
    fx = factor(title(drawn, 'x'), units[0]),
    fy = factor(title(drawn, 'y'), units[1]);
  points.forEach((p, i) => {
    const dx = Math.abs(x.value(p.px) - wanted[i][0] * fx) / x.pixel,
      dy = Math.abs(y.value(p.py) - wanted[i][1] * fy) / y.pixel;
    assert.ok(
      dx < PIXEL && dy < PIXEL,
      `${what}, mark ${i}: drawn at ${x.value(p.px)}, ${y.value(p.py)}; the data says ${wanted[i][0] * fx}, ${wanted[i][1] * fy}`,
    );
  });
}

/** The choice that the section's controls show: { x, line, measures, fixed }. */
const choice = (page, data, section) =>
  page
    .evaluate(key => {
      const value = role => Number(document.querySelector(`#${key} [data-role="${role}"]`)?.value);
      const stops = [...document.querySelectorAll(`#${key} .stops [data-axis]`)].map(c => [
        c.dataset.axis,
        c.type === 'range' ? (Number(c.value) ? Number(c.value) - 1 : null) : c.value === '' ? null : Number(c.value),
      ]);
      return {
        x: value('speed-x'),
        line: value('speed-line'),
        measures: [value('speed-measure-0'), value('speed-measure-1')],
        stops,
      };
    }, section)
    .then(c => ({
      ...c,
      fixed: new Map(
        c.stops.filter(([, i]) => i !== null).map(([name, i]) => [data.axes.findIndex(a => a.name === name), i]),
      ),
    }));

async function checkSpeed(page, data) {
  const state = await choice(page, data, 'speed');
  for (const side of [0, 1]) {
    const m = state.measures[side],
      wanted = curves(data, state.x, state.line, m, state.fixed),
      drawn = await chart(page, `speed-${side + 1}`);
    if (!drawn) {
      assert.equal(wanted.size, 0, 'a chart is left out though there are values');
      continue;
    }
    const keys = [...wanted.keys()].sort((a, b) => a - b);
    // More than 24 lines are thinned evenly.
    assert.deepEqual(
      drawn.series.map(s => s.key),
      keys.length <= 24 ? keys : Array.from({ length: 24 }, (_, i) => keys[Math.round((i * (keys.length - 1)) / 23)]),
    );
    const points = drawn.series.reduce((n, s) => n + wanted.get(s.key).length, 0);
    assert.equal(
      Object.keys(drawn.dots).length > 0,
      points + drawn.marks.length <= 900,
      'dots are drawn while they can be told apart',
    );
    const units = [data.axes[state.x].unit, data.measures[m].unit];
    for (const s of drawn.series) {
      if (drawn.dots[s.key]) same(drawn.dots[s.key], wanted.get(s.key), drawn, units, `dots of ${s.key}`);
      if (wanted.get(s.key).length > 1) same(s.line, wanted.get(s.key), drawn, units, `vertices of ${s.key}`);
    }
    const fits = mark =>
      Object.entries(mark.axes ?? {}).every(([name, v]) => {
        const a = data.axes.findIndex(x => x.name === name);
        if (a < 0 || !state.fixed.has(a)) return true;
        const there = data.axes[a].values[state.fixed.get(a)];
        return there === v || Math.abs(there - v) < 1e-6 * Math.abs(v);
      });
    const marks =
      data.axes[state.x].name === 'speed_m_s'
        ? (data.marks ?? []).filter(k => k.chart === 'speed' && k.measure === data.measures[m].name && fits(k))
        : [];
    same(
      drawn.marks,
      marks.filter(k => k.x !== null).map(k => [k.x, k.y]),
      drawn,
      units,
      'the experiment',
    );
  }
}

const charted = data =>
  data.study.kind !== 'modes' &&
  data.jobs.ok > 0 &&
  data.axes.some(a => a.kind === 'number' && a.values.some(v => v !== null));
for (const which of pages(['crossing', 'still', 'oneAxis', 'oneJob', 'big', 'wide', 'half', 'rating'], charted)) {
  test(`${which.name}: lines are the aggregates, for every choice`, () =>
    on(which, {}, async page => {
      const { data } = which;
      await checkSpeed(page, data);
      for (const role of ['speed-line', 'speed-x', 'speed-measure-0', 'speed-measure-1']) {
        const values = await page.$$eval(`#speed [data-role="${role}"] option`, all => all.map(o => o.value));
        for (const value of values.slice(0, 6)) {
          await page.selectOption(`#speed [data-role="${role}"]`, value);
          await checkSpeed(page, data);
        }
      }
      for (const name of await page.$$eval('#speed .stops [data-axis]', all => all.map(c => c.dataset.axis))) {
        const control = `#speed .stops [data-axis="${name}"]`;
        if (await page.$eval(control, c => c.type === 'range')) {
          await page.focus(control);
          await page.keyboard.press('Home');
          await checkSpeed(page, data);
          for (const key of ['ArrowRight', 'ArrowRight', 'End']) {
            await page.keyboard.press(key);
            await checkSpeed(page, data);
          }
        } else
          for (const option of ['', '0', '1']) {
            await page.selectOption(control, option);
            await checkSpeed(page, data);
          }
      }
    }));
}

test('points drawn at random begin as one line, a grid as several', async () => {
  const lines = async page => (await chart(page, 'speed-1')).series.length;
  await on(sample('drawn'), {}, async page => assert.equal(await lines(page), 1));
  await on(sample('crossing'), {}, async page => assert.ok((await lines(page)) > 1));
});

test('a chart five per cent off would be seen', () =>
  on(sample('crossing'), {}, async page => {
    const data = structuredClone(sample('crossing').data);
    data.cells.max[0] = list(data.cells.max[0]).map(v => v * 1.05);
    await assert.rejects(checkSpeed(page, data), /the data says/);
  }));

const matrix = (packed, row, width) => list(packed).slice(row * width, (row + 1) * width);
async function checkEnvelope(page, data, job) {
  const row = list(data.rows.job).indexOf(job),
    xs = data.envelope?.x_m ?? [],
    js = data.envelope?.joint_x_m ?? [],
    P = xs.length,
    J = js.length,
    ok = row >= 0 && list(data.rows.ok)[row];
  // A shorter bridge than the longest has nothing at the last places.
  const along = (xs, values, sign = 1) => values.map((v, i) => [xs[i], sign * v]).filter(([, v]) => !Number.isNaN(v));
  const wanted = { deflection: {}, force: {} };
  if (data.envelope) {
    Object.assign(wanted.deflection, {
      deflection: along(data.envelope.x_m, list(data.envelope.deflection_m)),
      uplift: along(data.envelope.x_m, list(data.envelope.uplift_m), -1),
    });
    if (J)
      Object.assign(wanted.force, {
        compression: along(data.envelope.joint_x_m, list(data.envelope.compression_n), -1),
        tension: along(data.envelope.joint_x_m, list(data.envelope.tension_n)),
      });
  }
  const p = data.envelope && data.rows.profile;
  if (p && ok) {
    Object.assign(wanted.deflection, {
      'job-deflection': along(xs, matrix(p.deflection_m, row, P)),
      'job-uplift': along(xs, matrix(p.uplift_m, row, P), -1),
    });
    if (p.signed_m) wanted.deflection['job-line'] = along(xs, matrix(p.signed_m, row, P));
    if (J)
      Object.assign(wanted.force, {
        'job-compression': along(js, matrix(p.compression_n, row, J), -1),
        'job-tension': along(js, matrix(p.tension_n, row, J)),
      });
  }
  for (const [key, unit] of [
    ['deflection', 'm'],
    ['force', 'N'],
  ]) {
    const drawn = await chart(page, `envelope-${key}`);
    if (!drawn) {
      assert.deepEqual(wanted[key], {});
      continue;
    }
    assert.deepEqual(drawn.series.map(s => s.key).sort(), Object.keys(wanted[key]).sort());
    for (const s of drawn.series) {
      same(s.line, wanted[key][s.key], drawn, ['m', unit], `${key}: ${s.key}`);
      if (drawn.dots[s.key])
        same(drawn.dots[s.key], wanted[key][s.key], drawn, ['m', unit], `${key}: dots of ${s.key}`);
    }
  }
}
const profiled = data => data.study.kind !== 'modes' && data.envelope && data.jobs.ok > 0;
for (const which of pages(['crossing', 'still', 'oneJob', 'big'], profiled)) {
  test(`${which.name}: envelope and the picked job's own`, () =>
    on(which, { motion: 'reduce' }, async page => {
      await checkEnvelope(page, which.data, await page.evaluate(() => globalThis.pontoon.picked));
      const buttons = await page.$$('#jobs .pick');
      for (const button of buttons.slice(0, 3)) {
        await button.click();
        await checkEnvelope(page, which.data, Number(await button.textContent()));
      }
    }));
}

test('the measured profile is drawn', () =>
  on(sample('crossing'), {}, async page => {
    const drawn = await chart(page, 'envelope-deflection'),
      marks = sample('crossing').data.marks.filter(m => m.chart === 'profile');
    same(
      drawn.marks,
      marks.map(m => [m.x, m.y]),
      drawn,
      ['m', 'm'],
      'the measured profile',
    );
  }));

for (const which of pages(['crossing', 'oneJob'], data => (data.histories ?? []).length > 0)) {
  test(`${which.name}: histories`, () =>
    on(which, { motion: 'reduce' }, async page => {
      const { data } = which;
      for (const job of [...new Set(data.histories.map(h => h.job))].slice(0, 3)) {
        await page.selectOption('#history-job', String(job));
        for (const quantity of new Set(data.histories.map(h => h.quantity))) {
          const mine = data.histories.filter(h => h.job === job && h.quantity === quantity),
            drawn = await chart(page, `history-${quantity.replace(/[^a-z0-9]/gi, '-')}`);
          if (!mine.length) {
            assert.equal(drawn, null);
            continue;
          }
          assert.equal(drawn.series.length, mine.length);
          mine.forEach((h, i) => {
            const value = list(h.value);
            same(
              drawn.series[i].line,
              list(h.time_s).map((t, k) => [t, value[k]]),
              drawn,
              ['s', h.unit],
              `${quantity} of job ${job}`,
            );
          });
        }
      }
    }));
}
