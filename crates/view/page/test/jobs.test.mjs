// The job browser: order, filter, pages, picking; it holds what the rows hold.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, sample } from './browser.mjs';
import { list } from './expect.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

/** The rows of the data as objects of column -> number, word or null. */
function rows(data) {
  const job = list(data.rows.job),
    ok = list(data.rows.ok),
    columns = data.rows.columns.map(c => [
      c.name,
      c.data.words
        ? list(c.data.index).map(i => (i === 65535 ? null : c.data.words[i]))
        : list(c.data).map(v => (Number.isNaN(v) ? null : v)),
    ]);
  return job.map((j, r) => ({
    job: j,
    ok: ok[r],
    ...Object.fromEntries(columns.map(([name, values]) => [name, values[r]])),
  }));
}
const shown = page => page.$$eval('#jobs tbody th', all => all.map(b => Number(b.textContent)));
/** All pages of the table, from the first. */
async function all(page) {
  await page.selectOption('#jobs .table .controls select', '100');
  const out = await shown(page);
  while (await page.isEnabled('#jobs .pager button:last-child')) {
    await page.click('#jobs .pager button:last-child');
    out.push(...(await shown(page)));
  }
  return out;
}
const browsed = data => data.rows?.count > 0;
const pause = page =>
  page.evaluate(() => {
    const b = document.querySelector('#play');
    if (b?.textContent === 'Pause') b.click();
  });

for (const which of pages(['crossing', 'big', 'still', 'allFailed', 'natural'], browsed)) {
  test(`${which.name}: all rows are there, in order, once`, () =>
    on(which, {}, async page => {
      assert.deepEqual(
        await all(page),
        rows(which.data).map(r => r.job),
      );
      assert.ok((await page.textContent('#jobs > .sub')).includes(which.data.rows.note));
    }));
}

for (const which of pages(['crossing', 'big', 'still', 'rating'], browsed)) {
  test(`${which.name}: every column sorts, up and down, nulls last`, () =>
    on(which, {}, async page => {
      await page.selectOption('#jobs .table .controls select', '100');
      const data = rows(which.data),
        heads = await page.$$('#jobs .rows thead th');
      for (const [i, column] of which.data.rows.columns.entries()) {
        const at = heads.length - which.data.rows.columns.length - (list(which.data.rows.ok).some(v => !v) ? 1 : 0) + i;
        for (let turn = 0; turn < 2; turn++) {
          await heads[at].$('button').then(b => b.click());
          const direction = await heads[at].getAttribute('aria-sort');
          assert.match(direction, /^(ascending|descending)$/);
          const sign = direction === 'ascending' ? 1 : -1,
            key = column.name;
          const wanted = [...data]
            .sort(
              (a, b) =>
                (a[key] === null) - (b[key] === null) ||
                (a[key] === null ? 0 : sign * (a[key] < b[key] ? -1 : a[key] > b[key] ? 1 : 0)) ||
                data.indexOf(a) - data.indexOf(b),
            )
            .slice(0, 100)
            .map(r => r.job);
          assert.deepEqual(await shown(page), wanted, `${key} ${direction}`);
        }
        assert.equal(await page.$$eval('#jobs .rows thead th:not([aria-sort="none"])', h => h.length), 1);
      }
    }));
}

test('the filter takes words and conditions', () =>
  on(sample('crossing'), {}, async page => {
    const data = rows(sample('crossing').data),
      near = (a, b) => Math.abs(a - b) < 1e-6 * Math.abs(b);
    const cases = [
      ['speed_m_s>10', r => r.speed_m_s > 10],
      ['speed_m_s>=10', r => r.speed_m_s >= 10],
      ['speed_m_s > 5 nonlinear', r => r.speed_m_s > 5 && r.connection === 'nonlinear'],
      ['gap_tension_m=28mm', r => r.gap_tension_m !== null && near(r.gap_tension_m, 0.028)],
      ['gap_tension_m>0.005', r => r.gap_tension_m !== null && r.gap_tension_m > 0.0051],
      ['load_n<200kN', r => r.load_n < 200000],
      ['load_n=132,300', r => r.load_n === 132300],
      ['connection=linear', r => r.connection === 'linear'],
      ['connection!=linear', r => r.connection !== 'linear'],
      ['failed', r => !r.ok],
      ['status=ok', r => r.ok],
      ['"did not settle"', r => !r.ok],
      ['job<3', r => r.job < 3],
      ['peak_deflection_m>0.3 speed<=7', r => r.peak_deflection_m > 0.3 && r.speed_m_s <= 7],
      ['nobody', () => false],
    ];
    for (const [text, holds] of cases) {
      await page.fill('#jobs input[type="search"]', text);
      assert.deepEqual(
        await all(page),
        data.filter(holds).map(r => r.job),
        text,
      );
      assert.equal(await page.isVisible('#jobs .error'), false, text);
    }
    for (const [text, word] of [
      ['speeed>3', 'no column'],
      ['speed_m_s>fast', 'no number'],
      ['gap_tension_m>28um', 'no number'],
      ['connection>linear', 'a word'],
    ]) {
      await page.fill('#jobs input[type="search"]', text);
      assert.ok((await page.textContent('#jobs .error')).includes(word), text);
    }
  }));

test('click and Enter pick a job: row, crossing, envelope follow; the rest of the page too', () =>
  on(sample('crossing'), {}, async page => {
    await page.click('#jobs tbody tr[data-row="5"] td:nth-child(4)');
    await pause(page);
    assert.equal(await page.textContent('#crossing-title'), 'Crossing of job 5');
    assert.deepEqual(await page.$$eval('#jobs tr.picked', all => all.map(r => r.dataset.row)), ['5']);
    assert.ok((await page.textContent('#envelope-deflection .legend')).includes('job 5'));
    assert.equal(await page.inputValue('#history-job'), '5');
    await page.focus('#jobs tbody tr[data-row="5"] .pick');
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => globalThis.pontoon.picked), 4);
    await page.keyboard.press('ArrowUp');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), '3', 'the focus stays in the table');
    await page.click('.card:nth-child(3) .job');
    assert.equal(await page.evaluate(() => globalThis.pontoon.picked), sample('crossing').data.cards[2].job);
  }));

test('a job without a crossing says why', () =>
  on(sample('crossing'), {}, async page => {
    await page.click('#jobs tr[data-row="9"] .pick');
    assert.match(await page.textContent('.crossing .empty'), /failed: contacts did not settle/);
    await page.fill('#jobs input[type="search"]', 'job=20');
    await page.click('#jobs .pick');
    assert.match(
      await page.textContent('.crossing .empty'),
      /carries the motion of 12 jobs; that of job 20 is not among them/,
    );
    assert.equal(await page.isVisible('.stage svg.bridge'), false);
    await page.click('.card:nth-child(1) .job');
    assert.equal(await page.isVisible('.stage svg.bridge'), true);
  }));

test('frequencies and verdicts are shown and filtered', async () => {
  await on(sample('natural'), {}, async page => {
    const { data } = sample('natural');
    await page.fill('#frequencies input[type="search"]', 'frequency_hz<1 vertical');
    const wanted = data.mode_table.filter(m => m.frequency_hz < 1 && m.shape.includes('vertical'));
    assert.deepEqual(
      await page.$$eval('#frequencies tbody tr', all => all.map(r => [...r.children].map(c => c.textContent))),
      wanted.map(m => [String(m.job), m.axes, String(m.number), m.frequency_hz.toFixed(4), m.shape]),
    );
    await page.selectOption('#modes .controls select', '1');
    assert.equal(await page.$$eval('#modes tbody tr', all => all.length), data.modes[1].list.length);
  });
  await on(sample('crossing'), {}, async page => {
    const { lines } = sample('crossing').data.verdicts,
      ids = () => page.$$eval('#verdicts tr[data-id]', all => all.map(r => r.dataset.id));
    assert.deepEqual((await ids()).sort(), lines.map(l => l.id).sort());
    await page.selectOption('#verdict-filter', 'falls-short');
    assert.deepEqual(await ids(), ['growth']);
  });
});
