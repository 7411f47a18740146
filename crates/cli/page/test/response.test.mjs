// The largest pages answer within 100 ms: from the event to the next frame's end, the median of each kind of interaction.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages } from './browser.mjs';

let stop;
before(async () => { stop = await launch(); });
after(() => stop());

const LIMIT_MS = 100;

/** Times of an interaction: its event, its handlers, layout and the frame that follows. */
const times = (page, selector, values, event, property = 'value') => page.evaluate(async ([selector, values, event, property]) => {
  const out = [];
  for (const value of values) {
    const node = document.querySelector(selector);
    if (!node) return null;
    await new Promise(done => requestAnimationFrame(() => setTimeout(done, 30)));
    const from = performance.now();
    if (event === 'click') node.click(); else { node[property] = value; node.dispatchEvent(new Event(event, { bubbles: true })); }
    document.body.getBoundingClientRect();
    await new Promise(done => requestAnimationFrame(() => { const channel = new MessageChannel(); channel.port1.onmessage = done; channel.port2.postMessage(0); }));
    out.push(performance.now() - from);
  }
  return out.sort((a, b) => a - b);
}, [selector, values, event, property]);

for (const which of pages(['big', 'wide'], data => (data.cells?.count ?? 0) >= 5000)) {
  test(`${which.name}: every interaction within ${LIMIT_MS} ms`, () => on(which, {}, async page => {
    await page.waitForTimeout(500);
    const stop = (await page.$('#speed .stops input')) ? '#speed .stops input' : null, heatStop = (await page.$('#heat .stops input')) ? '#heat .stops input' : null;
    const kinds = [
      stop && ['a stop of the lines', stop, ['1', '3', '5', '2', '0'], 'input'], ['the measure of the lines', '[data-role="speed-measure-0"]', ['1', '2', '3', '1', '0'], 'change'],
      ['the axis of the lines', '[data-role="speed-line"]', ['-1', ...(await page.$$eval('[data-role="speed-line"] option', all => all.slice(1, 5).map(o => o.value)))], 'change'],
      heatStop && ['a stop of the heat map', heatStop, ['1', '3', '5', '2', '0'], 'input'], ['the measure of the heat map', '[data-role="heat-measure"]', ['1', '2', '3', '1', '0'], 'change'],
      ['the axis of the heat map', '[data-role="heat-x"]', await page.$$eval('[data-role="heat-x"] option', all => all.slice(0, 5).map(o => o.value)), 'change'],
      ['sorting', '#jobs thead th:nth-child(5) button', [1, 2, 3, 4, 5], 'click'], ['filtering', '#jobs input[type="search"]', ['speed_m_s>10', 'speed_m_s>10 load_n<2e5', '', '15', ''], 'input'],
      ['turning a page', '#jobs .pager button:last-child', [1, 2, 3, 4, 5], 'click'], ['picking a job', '#jobs tbody tr:nth-child(2) .pick', [1, 2, 3, 4, 5], 'click'], ['a frame of the crossing', '#scrub', [3, 30, 60, 90, 12], 'input'],
    ].filter(Boolean);
    const slow = [];
    for (const [name, ...how] of kinds) {
      const list = await times(page, ...how);
      if (!list) continue;
      const median = list[Math.floor(list.length / 2)];
      console.log(`# ${which.name}: ${name}: median ${median.toFixed(0)} ms, worst ${list.at(-1).toFixed(0)} ms`);
      if (median > LIMIT_MS) slow.push(`${name}: ${median.toFixed(0)} ms`);
    }
    assert.deepEqual(slow, []);
  }));
}
