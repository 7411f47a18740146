// The page by keyboard alone: everything that can be worked is reached by Tab, has a name, shows its focus, and works.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, sample } from './browser.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

const where = page =>
  page.evaluate(() => {
    const e = document.activeElement,
      style = getComputedStyle(e);
    return {
      tag: e.tagName,
      id: e.id,
      cls: String(e.className),
      ring: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2,
      name: e.getAttribute('aria-label') ?? (e.labels?.length ? e.labels[0].textContent : e.textContent.trim()),
      seen: e.getBoundingClientRect().width > 0,
      key: [...document.querySelectorAll('*')].indexOf(e),
    };
  });

test('Tab reaches all there is, each with a name and a ring', () =>
  on(sample('crossing'), {}, async page => {
    const wanted = await page.evaluate(() =>
      [...document.querySelectorAll('a[href], button:not(:disabled), select, input, summary, [tabindex="0"]')]
        .filter(e => e.checkVisibility())
        .map(e => [...document.querySelectorAll('*')].indexOf(e)),
    );
    const reached = new Map();
    for (let i = 0; i < wanted.length + 5; i++) {
      await page.keyboard.press('Tab');
      const at = await where(page);
      if (at.tag === 'BODY') break;
      assert.ok(at.name, `${at.tag}#${at.id} has no name`);
      assert.ok(at.ring, `${at.tag}#${at.id}.${at.cls} shows no focus`);
      reached.set(at.key, at);
    }
    assert.deepEqual(
      wanted.filter(k => !reached.has(k)),
      [],
    );
  }));

test('the skip link leads to the report', () =>
  on(sample('crossing'), {}, async page => {
    await page.keyboard.press('Tab');
    assert.match((await where(page)).cls, /skip/);
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'main');
  }));

test('a chart is read and its job picked without a pointer', () =>
  on(sample('crossing'), { motion: 'reduce' }, async page => {
    const said = () => page.textContent('#speed-1 .readout');
    await page.focus('#speed-1 .plot');
    const first = await said();
    assert.match(first, /speed 3.*: peak deflection 0\.\d{4}.*job \d+/);
    await page.keyboard.press('ArrowRight');
    const second = await said();
    assert.match(second, /speed 7/);
    await page.keyboard.press('ArrowDown');
    assert.notEqual(await said(), second);
    const job = Number(/job (\d+)/.exec(await said())[1]);
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => globalThis.pontoon.picked), job);
    assert.equal(await page.textContent('#crossing-title'), `Crossing of job ${job}`);
  }));

test('the crossing is worked by keys', () =>
  on(sample('crossing'), {}, async page => {
    const frame = () => page.$eval('svg.bridge', n => Number(n.dataset.frame));
    await page.focus('#play');
    await page.keyboard.press('Space');
    await page.waitForTimeout(250);
    await page.keyboard.press('Space');
    const at = await frame();
    await page.focus('#scrub');
    await page.keyboard.press('Home');
    assert.equal(await frame(), 0);
    await page.keyboard.press('ArrowRight');
    assert.equal(await frame(), 1);
    assert.ok(at > 0);
    assert.match(await page.getAttribute('#scrub', 'aria-valuetext'), / s$/);
  }));

test('headers sort by Enter, the numbers of a chart open as a table', () =>
  on(sample('crossing'), {}, async page => {
    await page.focus('#jobs thead th:nth-child(6) button');
    await page.keyboard.press('Enter');
    assert.equal(await page.getAttribute('#jobs thead th:nth-child(6)', 'aria-sort'), 'ascending');
    await page.focus('#speed-1 summary');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#speed-1 .numbers table');
    assert.deepEqual(await page.$$eval('#speed-1 .numbers tbody th', all => all.map(t => t.textContent)), [
      '3',
      '7',
      '10',
      '15',
    ]);
  }));
