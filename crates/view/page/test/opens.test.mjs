// Every kind of page opens from disk, says nothing on the console, asks for nothing, has no accessibility violation; text is text.
import AxeBuilder from 'axe-core';
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, reports, sample, shownWithoutScripts } from './browser.mjs';
import { EACH_KIND } from './sample.mjs';
import { SENTENCE } from './build.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

const NAMES = [
  'crossing',
  'big',
  'wide',
  'still',
  'natural',
  'allFailed',
  'oneJob',
  'oneAxis',
  'markup',
  'half',
  'classes',
  'drawn',
  'rating',
];
const ids = page => page.$$eval('main section', all => all.map(s => s.id));

for (const which of pages(NAMES)) {
  test(`${which.name} opens in silence`, () =>
    on(which, {}, async (page, { problems, requests }) => {
      assert.equal(await page.textContent('h1'), which.data.study.name);
      if (which.data.study.question) assert.equal(await page.textContent('.question'), which.data.study.question);
      assert.deepEqual(await page.$$eval('.note', all => all.map(n => n.textContent)), which.data.notes ?? []);
      await page.mouse.wheel(0, 4000);
      await page.waitForTimeout(100);
      assert.deepEqual(problems, []);
      assert.deepEqual(requests, []);
      assert.equal(
        await page.evaluate(
          () => document.body.innerText.includes('[object ') || /\bundefined\b|\bNaN\b/.test(document.body.innerText),
        ),
        false,
      );
      const broken = await page.$$eval(
        'nav a',
        all => all.filter(a => !document.querySelector(a.getAttribute('href'))).length,
      );
      assert.equal(broken, 0);
    }));
}

for (const which of pages(['crossing', 'natural', 'markup'])) {
  test(`${which.name} is no empty page where a policy forbids scripts`, async () => {
    const shown = await shownWithoutScripts(which);
    assert.ok(shown.includes(which.data.study.name), shown);
    assert.ok(shown.includes(SENTENCE), shown);
    for (const card of which.data.cards ?? []) assert.ok(shown.includes(card.label), `${card.label}: ${shown}`);
    if (which.real && which.data.cards.length) assert.ok(shown.includes('Largest values against'), shown);
    await on(which, {}, async page => {
      assert.equal(await page.evaluate(said => document.body.innerText.includes(said), SENTENCE), false);
    });
  });
}

for (const which of pages(['crossing', 'natural'])) {
  test(`${which.name} is silent while its window changes its width`, () =>
    on(which, {}, async (page, { problems }) => {
      for (const width of [1000, 700, 360, 1280]) {
        await page.setViewportSize({ width, height: 900 });
        await page.waitForTimeout(100);
      }
      assert.deepEqual(problems, []);
    }));
}

test('sizes that change while they are told would be seen', () =>
  on(sample('oneJob'), {}, async (page, { problems }) => {
    await page.evaluate(
      () =>
        new Promise(done => {
          const box = document.body.appendChild(document.createElement('div'));
          let width = 100;
          new ResizeObserver(() => (box.style.width = `${++width}px`)).observe(box);
          setTimeout(done, 200);
        }),
    );
    assert.ok(
      problems.some(p => /ResizeObserver loop/.test(p)),
      problems.join(),
    );
  }));

test('a request would be seen, and would not get out', () =>
  on(sample('oneJob'), {}, async (page, { problems }) => {
    const got = await page.evaluate(() =>
      fetch('http://example.invalid/').then(
        () => 'out',
        () => 'kept',
      ),
    );
    assert.equal(got, 'kept');
    assert.ok(
      problems.some(p => /Content Security Policy/i.test(p)),
      problems.join(),
    );
  }));

for (const which of pages(EACH_KIND)) {
  for (const scheme of ['light', 'dark']) {
    test(`${which.name}, ${scheme}: axe finds nothing`, () =>
      on(which, { scheme }, async page => {
        await page.evaluate(source => {
          const script = document.createElement('script');
          script.textContent = source;
          document.head.append(script);
        }, AxeBuilder.source);
        const found = await page.evaluate(() =>
          globalThis.axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'best-practice'] }),
        );
        assert.deepEqual(
          found.violations.map(
            v =>
              `${v.id}: ${v.nodes
                .slice(0, 3)
                .map(n => n.target.join(' ') + ' ' + (n.any[0]?.message ?? ''))
                .join(' | ')}`,
          ),
          [],
        );
      }));
  }
}

test('names full of markup stay text', () =>
  on(sample('markup'), {}, async page => {
    await page.click('#jobs .pick >> nth=4');
    await page.focus('#speed-1 .plot');
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.evaluate(() => globalThis.hurt), undefined);
    assert.equal(await page.$$eval('img, main b', all => all.length), 0);
    assert.ok((await page.textContent('#speed-1 .readout')).includes('<b>&amp;'));
  }));

test('each kind shows what fits it', async () => {
  const has = async name => {
    let list;
    await on(sample(name), {}, async page => {
      list = await ids(page);
    });
    return list;
  };
  assert.deepEqual(await has('crossing'), [
    'summary',
    'settings',
    'failures',
    'speed',
    'heat',
    'envelope',
    'histories',
    'jobs',
    'modes',
    'verdicts',
    'provenance',
  ]);
  assert.deepEqual(await has('still'), [
    'summary',
    'settings',
    'failures',
    'speed',
    'heat',
    'envelope',
    'jobs',
    'modes',
    'provenance',
  ]);
  assert.deepEqual(await has('unread'), [
    'summary',
    'settings',
    'failures',
    'speed',
    'heat',
    'envelope',
    'histories',
    'jobs',
    'verdicts',
    'provenance',
  ]);
  assert.deepEqual((await has('classes')).slice(0, 3), ['classes', 'summary', 'settings']);
  assert.deepEqual((await has('drawn')).slice(0, 3), ['summary', 'exceedance', 'settings']);
  assert.deepEqual(await has('natural'), ['settings', 'frequencies', 'jobs', 'modes', 'provenance']);
  assert.deepEqual(await has('allFailed'), ['nothing', 'settings', 'failures', 'jobs', 'provenance']);
  assert.deepEqual(await has('oneJob'), [
    'summary',
    'settings',
    'speed',
    'envelope',
    'histories',
    'jobs',
    'modes',
    'provenance',
  ]);
});

test("the program's own reports are among the pages where they are named", { skip: !process.env.PONTOON_REPORTS }, () =>
  assert.ok(reports().length > 0),
);
