// What is drawn in a chart, read back from its SVG: pixels of ticks, dots, vertices, cells. Trusts no attribute that the page's code set as data.
import { parse } from './expect.mjs';

/** Ticks with their values, titles, dots and vertices of each series, the experiment's marks. */
export async function chart(page, id) {
  const raw = await page.evaluate(key => {
    const node = document.querySelector(`#${key} .plot > svg`);
    if (!node) return null;
    const origin = node.getScreenCTM().inverse();
    const spot = e => {
      const m = origin.multiply(e.getScreenCTM());
      return { px: m.e + Number(e.getAttribute('cx') ?? 0), py: m.f + Number(e.getAttribute('cy') ?? 0) };
    };
    const ticks = axis =>
      [...node.querySelectorAll(`[aria-label="${axis}-axis tick label"] text`)].map(t => ({
        text: t.textContent,
        ...spot(t),
      }));
    const title = axis => node.querySelector(`[aria-label="${axis}-axis label"]`)?.textContent ?? '';
    const pathPoints = path => {
      const m = origin.multiply(path.getScreenCTM());
      return [...path.getAttribute('d').matchAll(/[ML]([-\d.e]+),([-\d.e]+)/g)].map(k => ({
        px: +k[1] * m.a + m.e,
        py: +k[2] * m.d + m.f,
      }));
    };
    return {
      x: ticks('x'),
      y: ticks('y'),
      titleX: title('x'),
      titleY: title('y'),
      series: [...node.querySelectorAll('.series-line')].map(g => ({
        key: g.dataset.series,
        line: [...g.querySelectorAll('path')].flatMap(pathPoints),
      })),
      dots: Object.fromEntries(
        [...node.querySelectorAll('.series-dots')].map(g => [g.dataset.series, [...g.children].map(spot)]),
      ),
      marks: [...node.querySelectorAll('.mark-dots > *')].map(spot),
      rules: [...node.querySelectorAll('.mark-rules line')].map(l => ({
        py: origin.multiply(l.getScreenCTM()).f + Number(l.getAttribute('y1')),
      })),
    };
  }, id);
  if (!raw) return null;
  // A tick's text stands beside its place; the tick mark itself is where it is.
  const marks = await page.evaluate(key => {
    const node = document.querySelector(`#${key} .plot > svg`),
      origin = node.getScreenCTM().inverse();
    return Object.fromEntries(
      ['x', 'y'].map(axis => [
        axis,
        [...node.querySelectorAll(`[aria-label="${axis}-axis tick"] path`)].map(p => {
          const m = origin.multiply(p.getScreenCTM());
          return axis === 'x' ? m.e : m.f;
        }),
      ]),
    );
  }, id);
  for (const axis of ['x', 'y'])
    raw[axis] = raw[axis].map((t, i) => ({ text: t.text, value: parse(t.text), px: marks[axis][i] }));
  return raw;
}

/** The cells of a heat map: { left, top, width, height, fill } of each sub-path; ticks; the colours of its legend. */
export function heat(page, id = 'heat-map') {
  return page.evaluate(async key => {
    const node = document.querySelector(`#${key} .plot > svg`);
    if (!node) return null;
    const cells = [],
      picture = node.querySelector('.heat image');
    if (picture) {
      const image = new Image(),
        canvas = document.createElement('canvas').getContext('2d'),
        [x, y, w, h] = ['x', 'y', 'width', 'height'].map(n => Number(picture.getAttribute(n)));
      image.src = picture.getAttribute('href');
      await image.decode();
      [canvas.canvas.width, canvas.canvas.height] = [image.width, image.height];
      canvas.drawImage(image, 0, 0);
      const { data } = canvas.getImageData(0, 0, image.width, image.height),
        hex = v => v.toString(16).padStart(2, '0'),
        cw = w / image.width,
        ch = h / image.height;
      for (let j = 0, k = 0; j < image.height; j++)
        for (let i = 0; i < image.width; i++, k += 4)
          if (data[k + 3] === 255)
            cells.push({
              left: x + i * cw,
              top: y + j * ch,
              width: cw,
              height: ch,
              fill: `#${hex(data[k])}${hex(data[k + 1])}${hex(data[k + 2])}`,
            });
    }
    for (const path of node.querySelectorAll('.heat path[fill]')) {
      for (const m of path.getAttribute('d').matchAll(/M([-\d.]+) ([-\d.]+)h([-\d.]+)v([-\d.]+)h[-\d.]+z/g))
        cells.push({ left: +m[1], top: +m[2], width: +m[3], height: +m[4], fill: path.getAttribute('fill') });
    }
    const box = node.querySelector('.heat .nothing');
    return {
      cells,
      box: Object.fromEntries(['x', 'y', 'width', 'height'].map(n => [n, Number(box.getAttribute(n))])),
      crosses: (node.querySelector('.heat .failed')?.getAttribute('d').match(/M/g) ?? []).length,
      x: [...node.querySelectorAll('[aria-label="x-axis tick label"] text')].map(t => t.textContent),
      y: [...node.querySelectorAll('[aria-label="y-axis tick label"] text')].map(t => t.textContent),
      strip: [...document.querySelectorAll(`#${key} .strip rect`)].map(r => r.getAttribute('fill')),
      numbers: [...document.querySelectorAll(`#${key} .strip text[text-anchor]`)].map(t => ({
        text: t.textContent,
        px: Number(t.getAttribute('x')),
      })),
      stripWidth: (() => {
        const all = [...document.querySelectorAll(`#${key} .strip rect`)],
          a = all.at(-1),
          b = all[0];
        return Number(a.getAttribute('x')) + Number(all[1].getAttribute('x')) - Number(b.getAttribute('x'));
      })(),
      title: document.querySelector(`#${key} .strip text`).textContent,
    };
  }, id);
}
