// What limits make of a page: the table of classes, how often limits are exceeded, ratings.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, sample } from './browser.mjs';
import { parse } from './expect.mjs';
import { chart } from './geometry.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

// A limit's words and what its place is the number of, as a reader says them.
const WORDS = {
  edge_sinkage_m: place => `edge sinkage${place ? `, position ${place}` : ''}`,
  uplift_m: place => `uplift${place ? `, position ${place}` : ''}`,
  joint_compression_n: place => (place ? `compression, joint ${place}` : 'joint compression'),
  joint_tension_n: place => (place ? `tension, joint ${place}` : 'joint tension'),
  connector_compression_n: place => `connector compression${place ? `, joint ${place}` : ''}`,
  connector_tension_n: place => `connector tension${place ? `, joint ${place}` : ''}`,
  pin_force_n: place => `pin force${place ? `, joint ${place}` : ''}`,
  joint_angle_rad: place => (place ? `angle, joint ${place}` : 'joint angle'),
  roll_rad: place => `roll${place ? `, position ${place}` : ''}`,
  trim_rad: place => `trim${place ? `, module ${place}` : ''}`,
  axle_contact_n: place => (place ? `contact, axle ${place}` : 'axle contact'),
};

/** The table as it stands: heads, and of each row its names and cells. */
const shown = page =>
  page.$eval('#classes table', table => ({
    caption: table.caption.textContent,
    heads: [...table.tHead.rows[0].cells].map(c => [c.tagName, c.scope, c.textContent]),
    rows: [...table.tBodies[0].rows].map(row => ({
      names: [...row.cells].filter(c => c.scope === 'row').map(c => c.textContent),
      cells: [...row.cells]
        .filter(c => c.tagName === 'TD')
        .map(c => ({
          job: c.dataset.job === undefined ? null : Number(c.dataset.job),
          sign: c.querySelector('.sign').textContent,
          used: c.querySelector('.used')?.textContent ?? null,
          where: c.querySelector('.where')?.textContent ?? null,
          said: c.querySelector('.unseen')?.textContent ?? '',
          ground: getComputedStyle(c).backgroundColor,
        })),
    })),
  }));

const classed = data => !!data.classes && data.study.kind !== 'rating';
for (const which of pages(['classes'], classed)) {
  test(`${which.name}: the table of classes says what the data says, by signs and words`, () =>
    on(which, {}, async page => {
      const { classes } = which.data,
        table = await shown(page),
        grounds = { '\u2713': new Set(), '\u2717': new Set() };
      assert.ok(table.caption.includes(which.data.study.name));
      assert.deepEqual(
        table.heads,
        [...classes.names, ...classes.heads].map(head => ['TH', 'col', head]),
      );
      assert.equal(table.rows.length, classes.rows.length);
      let passing = 0;
      for (const [r, row] of classes.rows.entries()) {
        assert.deepEqual(table.rows[r].names, row.names);
        assert.equal(table.rows[r].cells.length, row.cells.length);
        for (const [c, cell] of row.cells.entries()) {
          const seen = table.rows[r].cells[c],
            what = `${row.names.join(' ')}, ${classes.heads[c]}`;
          assert.equal(seen.job, cell ? cell.job : null, what);
          if (!cell) {
            assert.equal(seen.sign + seen.said, '\u2013not asked', what);
            continue;
          }
          if (cell.utilisation === null) {
            assert.deepEqual([seen.sign, seen.used, seen.where], ['?', 'failed', null], what);
            continue;
          }
          const passes = cell.utilisation <= 1;
          passing += passes;
          assert.equal(seen.sign, passes ? '\u2713' : '\u2717', what);
          assert.match(seen.said, passes ? /passes/ : /exceeds a limit/, what);
          grounds[seen.sign].add(seen.ground);
          assert.ok(Math.abs(parse(seen.used) - cell.utilisation) <= 0.005 * Math.max(1, cell.utilisation / 100), what);
          assert.equal(parse(seen.used) <= 1, passes, `${what}: the number says what the sign says`);
          assert.equal(seen.where, WORDS[cell.limit](cell.place), what);
        }
      }
      assert.ok((await page.textContent('#classes .lead')).startsWith(`${passing} of `));
      for (const one of grounds['\u2713']) assert.ok(!grounds['\u2717'].has(one), 'colours differ as signs do');
    }));

  test(`${which.name}: the table comes first, with its own entry in the contents, and on paper on a sheet of its own`, () =>
    on(which, {}, async page => {
      assert.equal(await page.$eval('main > section', s => s.id), 'classes');
      assert.equal(await page.getAttribute('.toc a', 'href'), '#classes');
      await page.emulateMedia({ media: 'print' });
      const breaks = await page.$eval('#classes', s => {
        const style = getComputedStyle(s);
        return [style.breakBefore, style.breakAfter];
      });
      assert.deepEqual(breaks, ['page', 'page']);
    }));
}

test('the legend names every sign in words', () =>
  on(sample('classes'), {}, async page => {
    const said = await page.$$eval('#classes .legend li', all => all.map(li => li.textContent));
    assert.deepEqual(
      said.map(text => [text.slice(0, 1), text.slice(1).split(':')[0]]),
      [
        ['\u2713', 'passes'],
        ['\u2717', 'exceeds a limit'],
        ['?', 'failed'],
        ['\u2013', 'not asked'],
      ],
    );
    assert.match(
      await page.textContent('#classes .lead'),
      /^\d+ of 23 crossings pass, \d+ exceed a limit, 1 failed\.$/,
    );
  }));

test('click and Enter on a cell pick its job; arrows move among cells', () =>
  on(sample('classes'), { motion: 'reduce' }, async page => {
    const picked = () => page.evaluate(() => globalThis.pontoon.picked),
      at = () => page.evaluate(() => Number(document.activeElement.closest('td')?.dataset.job)),
      pressed = () =>
        page.$$eval('#classes [aria-pressed="true"]', all => all.map(b => Number(b.closest('td').dataset.job)));
    await page.click('#classes td[data-job="5"]');
    assert.equal(await picked(), 5);
    assert.deepEqual(await pressed(), [5]);
    assert.equal(await page.textContent('#crossing-title'), 'Crossing of job 5');
    assert.ok(
      await page.$eval('#jobs', s => s.getBoundingClientRect().top < innerHeight),
      'the job browser comes into sight',
    );
    await page.focus('#classes td[data-job="5"] button');
    await page.keyboard.press('ArrowRight');
    assert.equal(await at(), 6);
    await page.keyboard.press('ArrowDown');
    assert.equal(await at(), 10);
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('ArrowUp');
    assert.equal(await at(), 5);
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Enter');
    assert.equal(await picked(), 6);
    assert.deepEqual(await pressed(), [6]);
    assert.match(await page.textContent('.crossing .empty'), /failed/);
    await page.focus('#classes td[data-job="22"] button');
    await page.keyboard.press('ArrowRight');
    assert.equal(await at(), 22, 'no crossing is beyond');
  }));

for (const which of pages(['drawn'], data => (data.exceedance ?? []).length > 0)) {
  test(`${which.name}: how often limits are exceeded, in numbers and as bars`, () =>
    on(which, {}, async page => {
      const { exceedance } = which.data;
      const lines = await page.$$eval('#exceedance tbody tr', all =>
        all.map(tr => {
          const number = (node, key) => Number(node.getAttribute(key)),
            band = tr.querySelector('.band'),
            track = tr.querySelector('.track'),
            along = x => (x - number(track, 'x1')) / (number(track, 'x2') - number(track, 'x1'));
          return {
            text: [...tr.cells].map(c => c.textContent),
            low: along(number(band, 'x')),
            high: along(number(band, 'x') + number(band, 'width')),
            share: along(number(tr.querySelector('.share'), 'cx')),
          };
        }),
      );
      const most = parse(/0 to ([^ ]+) %/.exec(await page.textContent('#exceedance thead th:nth-child(5)'))[1]) / 100,
        near = (a, b, what) => assert.ok(Math.abs(a - b) < 1e-6, `${what}: ${a} and ${b}`),
        percent = text => parse(text.replace(/[^\d.\u2212]+$/, '')) / 100,
        told = (a, b, what) => assert.ok(Math.abs(a - b) <= 0.005 * b + 1e-12, `${what}: ${a} and ${b}`);
      assert.equal(lines.length, exceedance.length);
      for (const [i, of] of exceedance.entries()) {
        const { text, low, high, share } = lines[i];
        assert.equal(text[0], WORDS[of.limit](null));
        assert.equal(text[1], `${of.exceeded} of ${of.jobs} jobs`);
        told(percent(text[2]), of.share, of.limit);
        text[3].split(' to ').forEach((end, e) => told(percent(end), of.interval[e], `${of.limit}, interval`));
        near(low * most, of.interval[0], of.limit);
        near(high * most, of.interval[1], of.limit);
        near(share * most, of.share, of.limit);
        if (exceedance.some(e => e.failed)) assert.equal(text[5], String(of.failed));
      }
      assert.equal(
        (await page.textContent('#exceedance .sub')).includes('Failed jobs do not count'),
        exceedance.some(e => e.failed > 0),
      );
    }));
}

test('nothing of limits is on a page without them', () =>
  on(sample('crossing'), {}, async page => {
    assert.equal(await page.$('#classes'), null);
    assert.equal(await page.$('#exceedance'), null);
  }));

test('a rating shows its rated values, of one job each, and plays the crossing of one', () =>
  on(sample('rating'), { motion: 'reduce' }, async page => {
    assert.match(await page.textContent('.kind'), /^Ratings/);
    assert.equal(await page.textContent('#speed-title'), 'Rated values against speed');
    assert.equal((await chart(page, 'speed-1')).titleY, 'rated value');
    assert.match(await page.textContent('#heat-map figcaption'), /^Rated value over/);
    // the largest of several rated values is safe for one of them alone: no stop begins on all
    for (const id of ['speed', 'heat'])
      assert.deepEqual(await page.$$eval(`#${id} .stops select`, all => all.map(c => [c.dataset.axis, c.value])), [
        ['gap_compression_m', '0'],
      ]);
    await page.click('#jobs .pick >> nth=4');
    assert.equal(await page.textContent('#crossing-title'), 'Crossing of job 4 at its rated value');
    assert.match(await page.textContent('.crossing .sub'), /rated value \d{3},\d{3}$/);
    await page.click('#jobs .pick >> nth=5');
    assert.equal(await page.textContent('#crossing-title'), 'Crossing of job 5');
    assert.match(await page.textContent('.crossing .empty'), /Job 5 failed/);
    const first = await page.$$eval('#jobs tbody tr:first-child td', all => all.map(c => c.textContent));
    assert.ok(first.includes('155'), `a count has no decimals: ${first}`);
  }));

test('a rating has no table of classes: its values are those that pass', async () => {
  const { build } = await import('./build.mjs'),
    { writeFileSync } = await import('node:fs');
  const { file } = sample('rating'),
    of = { name: 'rated-classes', file: file.replace('rating.html', 'rated-classes.html') };
  writeFileSync(of.file, build({ ...sample('rating').data, classes: sample('classes').data.classes }));
  await on(of, {}, async page => assert.equal(await page.$('#classes'), null));
});
