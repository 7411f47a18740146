// How the page is laid out: nothing runs over or out at 360, 768 and 1280 pixels, text stands out in both colour schemes, paper gets everything at rest.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, sample } from './browser.mjs';
import { EACH_KIND } from './sample.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

/** Blocks that cross each other, text that leaves its box, blocks that leave the window. */
const faults = page =>
  page.evaluate(() => {
    const out = [],
      name = e =>
        `${e.tagName.toLowerCase()}${e.id ? '#' + e.id : ''}${typeof e.className === 'string' && e.className ? '.' + e.className.split(' ')[0] : ''} "${e.textContent.trim().slice(0, 24)}"`;
    const seen = e => e.checkVisibility?.({ visibilityProperty: true }) ?? true;
    const scrolls = e => e.closest('.scroll');
    if (document.documentElement.scrollWidth > innerWidth)
      out.push(`the page is ${document.documentElement.scrollWidth} wide in ${innerWidth}`);
    for (const parent of document.querySelectorAll(
      'body, .layout, main, section, header, .side, .cards, .card, .pairs, .pairs > div, .controls, .field, .chart, .pair, .crossing, .between, .buttons, .live, .live > div, .pager, .table, .stage, .legend, .legend ul, .notes',
    )) {
      const children = [...parent.children].filter(
        e =>
          seen(e) &&
          !['absolute', 'fixed'].includes(getComputedStyle(e).position) &&
          getComputedStyle(e).display !== 'contents' &&
          e.getBoundingClientRect().width > 0 &&
          !e.matches('script, option'),
      );
      for (let i = 0; i < children.length; i++)
        for (let j = i + 1; j < children.length; j++) {
          const a = children[i].getBoundingClientRect(),
            b = children[j].getBoundingClientRect();
          const w = Math.min(a.right, b.right) - Math.max(a.left, b.left),
            h = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
          if (w > 1 && h > 1 && !['text', 'line', 'rect', 'path', 'g'].includes(children[i].tagName))
            out.push(`${name(children[i])} and ${name(children[j])} cross by ${w.toFixed()} x ${h.toFixed()}`);
        }
    }
    for (const e of document.querySelectorAll(
      'h1, h2, h3, p, dt, dd, li, label, button, summary, figcaption, output, a, code, td, th',
    )) {
      if (!seen(e) || e.matches('.skip, .unseen')) continue;
      if (e.clientWidth && e.scrollWidth > e.clientWidth + 1 && !e.querySelector('select, input'))
        out.push(`${name(e)}: text is ${e.scrollWidth} wide in ${e.clientWidth}`);
      const box = e.getBoundingClientRect();
      if (!scrolls(e) && (box.right > innerWidth + 1 || box.left < -1))
        out.push(`${name(e)} leaves the window: ${box.left.toFixed()} to ${box.right.toFixed()}`);
    }
    // Texts of a drawing: inside it, and no two of a kind over each other.
    for (const svg of document.querySelectorAll('main svg')) {
      if (!seen(svg)) continue;
      const frame = svg.getBoundingClientRect(),
        texts = [...svg.querySelectorAll('text')].filter(t => t.textContent.trim());
      const boxes = texts.map(t => t.getBoundingClientRect());
      boxes.forEach((a, i) => {
        if (a.left < frame.left - 22 || a.right > Math.min(innerWidth, frame.right + 22))
          out.push(
            `text "${texts[i].textContent}" leaves its drawing by ${(frame.left - a.left).toFixed()} / ${(a.right - frame.right).toFixed()}`,
          );
        for (let j = i + 1; j < boxes.length; j++) {
          const b = boxes[j],
            w = Math.min(a.right, b.right) - Math.max(a.left, b.left),
            h = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
          if (w > 1 && h > 3)
            out.push(
              `texts "${texts[i].textContent}" and "${texts[j].textContent}" of ${svg.getAttribute('class') ?? svg.closest('figure')?.id} cross by ${w.toFixed()} x ${h.toFixed()}`,
            );
        }
      });
    }
    return out.slice(0, 12);
  });

for (const which of pages(['big', 'wide', ...EACH_KIND])) {
  for (const width of [360, 768, 1280]) {
    test(`${which.name} at ${width} pixels`, () =>
      on(which, { width, scheme: width === 768 ? 'dark' : 'light' }, async page => {
        assert.deepEqual(await faults(page), []);
        if (await page.$('#jobs .pick')) {
          await page.click('#jobs .pick >> nth=0');
          await page.evaluate(() => {
            const b = document.querySelector('#play');
            if (b?.textContent === 'Pause') b.click();
          });
          assert.deepEqual(await faults(page), []);
        }
      }));
  }
}

test('a block that is too wide, and one that covers another, would be seen', () =>
  on(sample('crossing'), { width: 360 }, async page => {
    await page.evaluate(() => {
      document.querySelector('.question').style.width = '500px';
      document.querySelector('.kind').style.marginBottom = '-20px';
    });
    const found = (await faults(page)).join('\n');
    assert.match(found, /leaves the window/);
    assert.match(found, /cross by/);
  }));

/** Contrast of every element that holds text itself, by the formula of WCAG 2, against the first opaque ground behind it. */
const contrast = page =>
  page.evaluate(() => {
    const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
    const rgba = text => {
      canvas.clearRect(0, 0, 1, 1);
      canvas.fillStyle = text;
      canvas.fillRect(0, 0, 1, 1);
      return [...canvas.getImageData(0, 0, 1, 1).data];
    };
    const light = ([r, g, b]) =>
      [r, g, b]
        .map(v => v / 255)
        .map(v => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
        .reduce((s, v, i) => s + v * [0.2126, 0.7152, 0.0722][i], 0);
    const ground = e => {
      for (let n = e; n; n = n.parentElement) {
        const c = rgba(getComputedStyle(n).backgroundColor);
        if (c[3] > 250) return c;
      }
      return [255, 255, 255, 255];
    };
    const out = [];
    let count = 0;
    for (const e of document.querySelectorAll('body *')) {
      if (
        !e.checkVisibility() ||
        ![...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()) ||
        e.matches('script, style, option, :disabled, .skip')
      )
        continue;
      const style = getComputedStyle(e),
        ink = rgba(e instanceof SVGElement && style.fill !== 'none' ? style.fill : style.color),
        a = light(ink),
        b = light(ground(e)),
        ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      count++;
      if (ratio < 4.5)
        out.push(
          `${e.tagName} ${e.getAttribute('class') ?? ''} "${e.textContent.trim().slice(0, 20)}": ${ratio.toFixed(2)}`,
        );
    }
    return { count, out: [...new Set(out)] };
  });
for (const name of ['crossing', 'classes', 'drawn'])
  for (const scheme of ['light', 'dark']) {
    test(`${name}, ${scheme}: text has a contrast of 4.5 or more`, () =>
      on(sample(name), { scheme }, async page => {
        const { count, out } = await contrast(page);
        assert.ok(count > 200);
        assert.deepEqual(out, []);
      }));
  }
test("the colour scheme can be chosen against the system's", () =>
  on(sample('crossing'), { scheme: 'light' }, async page => {
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor),
      was = await ground();
    await page.selectOption('#scheme', 'dark');
    assert.notEqual(await ground(), was);
    assert.deepEqual((await contrast(page)).out, []);
    await page.selectOption('#scheme', '');
    assert.equal(await ground(), was);
  }));

for (const which of pages(['crossing', 'natural', 'allFailed', 'big', 'classes', 'drawn', 'rating'])) {
  test(`${which.name} on paper`, () =>
    on(which, { width: 1280, scheme: 'dark' }, async page => {
      const play = (which.data.plays ?? []).at(-1);
      if (play) await page.selectOption('#play-job', String(play.job));
      const sections = await page.$$eval('main section', all => all.map(s => s.id));
      await page.setViewportSize({ width: 688, height: 1000 });
      await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
      await page.waitForTimeout(150);
      assert.equal(await page.evaluate(() => getComputedStyle(document.querySelector('h1')).color), 'rgb(0, 0, 0)');
      assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), 'rgb(255, 255, 255)');
      assert.equal(await page.isVisible('nav'), false);
      for (const id of sections) assert.ok((await page.locator(`#${id}`).boundingBox()).height > 20, id);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'wider than the paper');
      const out = await page.$$eval(
        'main svg',
        all => all.filter(s => s.checkVisibility() && s.getBoundingClientRect().right > innerWidth + 1).length,
      );
      assert.equal(out, 0, 'a drawing leaves the paper');
      if (play) {
        const frame = await page.$eval('svg.bridge', n => Number(n.dataset.frame)),
          { list } = await import('./expect.mjs'),
          w = list(play.deflection_m),
          P = (play.bridge ?? which.data.bridge).position_x_m.length;
        const most = w.reduce((a, v) => Math.max(a, v), -Infinity);
        assert.equal(frame, Math.floor(w.indexOf(most) / P), 'the frame of the peak');
        await page.waitForTimeout(120);
        assert.equal(await page.$eval('svg.bridge', n => Number(n.dataset.frame)), frame, 'at rest');
      }
      const pdf = await page.pdf({ format: 'A4', printBackground: true });
      assert.ok(pdf.length > 10000 && pdf.subarray(0, 5).toString() === '%PDF-');
      await page.emulateMedia({ media: 'screen' });
    }));
}
