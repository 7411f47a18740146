// The heat map: every cell in its place with its colour, the legend's numbers, the readout under pointer and keyboard.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, sample } from './browser.mjs';
import { cells, factor, list, parse } from './expect.mjs';
import { heat } from './geometry.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

const state = (page, data) =>
  page
    .evaluate(() => {
      const value = role => document.querySelector(`#heat [data-role="${role}"]`).value;
      const stops = [...document.querySelectorAll('#heat .stops [data-axis]')].map(c => [
        c.dataset.axis,
        c.type === 'range' ? (Number(c.value) ? Number(c.value) - 1 : null) : c.value === '' ? null : Number(c.value),
      ]);
      return {
        x: Number(value('heat-x')),
        y: Number(value('heat-y')),
        m: Number(value('heat-measure')),
        statistic: value('heat-statistic'),
        stops,
      };
    })
    .then(s => ({
      ...s,
      fixed: new Map(
        s.stops.filter(([, i]) => i !== null).map(([name, i]) => [data.axes.findIndex(a => a.name === name), i]),
      ),
    }));

/** The largest or smallest of the cells that fall in each place; places where all failed. */
function wantedOf(data, s) {
  const sign = s.statistic === 'max' ? 1 : -1,
    wanted = new Map(),
    dead = new Set();
  for (const cell of cells(data)) {
    if ([...s.fixed].some(([a, i]) => cell.at[a] !== i)) continue;
    const key = `${cell.at[s.x]},${cell.at[s.y]}`,
      v = cell[s.statistic][s.m];
    if (Number.isNaN(v)) {
      dead.add(key);
      continue;
    }
    wanted.set(key, wanted.has(key) ? sign * Math.max(sign * v, sign * wanted.get(key)) : v);
  }
  return { wanted, dead: [...dead].filter(k => !wanted.has(k)) };
}

async function check(page, data) {
  const s = await state(page, data),
    { wanted, dead } = wantedOf(data, s),
    drawn = await heat(page);
  if (!drawn) {
    assert.equal(wanted.size, 0);
    return;
  }
  const nx = data.axes[s.x].values.length,
    ny = data.axes[s.y].values.length,
    f = factor(drawn.title, data.measures[s.m].unit);
  // Colour to value by the legend alone: its strip of colours and two of its numbers.
  const n = drawn.strip.length,
    [a, b] = [drawn.numbers[0], drawn.numbers.at(-1)],
    slope = (parse(b.text) - parse(a.text)) / (b.px - a.px),
    low = parse(a.text) - a.px * slope,
    step = (slope * drawn.stripWidth) / n;
  // The legend's numbers have three digits: half a unit of the third, at each end of the strip, on top of one level of colour.
  const slack = step + 0.01 * Math.max(Math.abs(parse(a.text)), Math.abs(parse(b.text)));
  assert.equal(drawn.cells.length, wanted.size, 'number of cells');
  assert.equal(drawn.crosses, dead.length, 'cells where all failed');
  const seen = new Set();
  for (const c of drawn.cells) {
    const i = ((c.left + c.width / 2 - drawn.box.x) / drawn.box.width) * nx - 0.5,
      j = ny - 0.5 - ((c.top + c.height / 2 - drawn.box.y) / drawn.box.height) * ny;
    // Coordinates carry two decimals: a hundredth of a pixel of cells that are pixels wide.
    assert.ok(
      Math.abs(i - Math.round(i)) < 0.02 && Math.abs(j - Math.round(j)) < 0.02,
      `a cell between places: ${i}, ${j}`,
    );
    const key = `${Math.round(i)},${Math.round(j)}`,
      at = drawn.strip.indexOf(c.fill);
    assert.ok(wanted.has(key) && !seen.has(key), `a cell where none should be: ${key}`);
    seen.add(key);
    assert.ok(at >= 0, `a colour that the legend does not have: ${c.fill}`);
    const shown = low + (at + 0.5) * step;
    assert.ok(
      Math.abs(shown - wanted.get(key) * f) <= slack,
      `cell ${key}: the colour says ${shown}, the data ${wanted.get(key) * f}`,
    );
  }
  return { s, wanted, drawn };
}

const mapped = data =>
  data.study.kind !== 'modes' && data.jobs.ok > 0 && data.axes.filter(a => a.values.length > 1).length > 1;
for (const which of pages(['crossing', 'big', 'still', 'wide', 'rating'], mapped)) {
  test(`${which.name}: cells are the aggregates, over any two axes`, () =>
    on(which, {}, async page => {
      const { data } = which;
      await check(page, data);
      for (const role of which.name === 'wide'
        ? ['heat-measure']
        : ['heat-x', 'heat-y', 'heat-measure', 'heat-statistic']) {
        const values = await page.$$eval(`#heat [data-role="${role}"] option`, all => all.map(o => o.value));
        for (const v of values.slice(0, which.name === 'wide' ? 2 : 5)) {
          await page.selectOption(`#heat [data-role="${role}"]`, v);
          await check(page, data);
        }
      }
      for (const name of await page.$$eval('#heat .stops [data-axis]', all => all.map(c => c.dataset.axis))) {
        const control = `#heat .stops [data-axis="${name}"]`;
        if (await page.$eval(control, c => c.type === 'range')) {
          await page.focus(control);
          for (const key of ['Home', 'ArrowRight', 'End']) {
            await page.keyboard.press(key);
            await check(page, data);
          }
        } else
          for (const option of ['', '0']) {
            await page.selectOption(control, option);
            await check(page, data);
          }
      }
      await page.check('#heat .check input');
      await check(page, data);
    }));
}

test('values five per cent off would be seen', () =>
  on(sample('crossing'), {}, async page => {
    const data = structuredClone(sample('crossing').data);
    data.cells.max[0] = list(data.cells.max[0]).map(v => v * 1.05);
    await assert.rejects(check(page, data), /the data/);
  }));

test('pointer and keyboard read the same cell, with its value and its job', () =>
  on(sample('crossing'), {}, async page => {
    const { data } = sample('crossing'),
      { s, drawn } = await check(page, data),
      map = page.locator('#heat-map .plot > svg');
    await map.scrollIntoViewIfNeeded();
    const box = await map.boundingBox();
    const nx = data.axes[s.x].values.length,
      ny = data.axes[s.y].values.length,
      i = nx - 1,
      j = ny - 1;
    await page.mouse.move(
      box.x + drawn.box.x + (drawn.box.width * (i + 0.5)) / nx,
      box.y + drawn.box.y + (drawn.box.height * 0.5) / ny,
    );
    const pointed = await page.textContent('#heat-map .readout');
    const best = cells(data)
      .filter(c => c.at[s.x] === i && c.at[s.y] === j && [...s.fixed].every(([a, k]) => c.at[a] === k))
      .reduce((a, c) => (c.max[s.m] > (a?.max[s.m] ?? -1) ? c : a), null);
    assert.ok(pointed.includes(best.max[s.m].toFixed(4)) && pointed.includes(`job ${best.best[s.m]}`), pointed);
    await page.mouse.move(0, 0);
    await page.focus('#heat-map .plot');
    await page.keyboard.press('End');
    for (let k = 1; k < ny; k++) await page.keyboard.press('ArrowUp');
    assert.equal(await page.textContent('#heat-map .readout'), pointed);
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => globalThis.pontoon.picked), best.best[s.m]);
  }));
