// The largest pages answer within 100 ms: from the event to the next frame's end, the median of each kind of interaction.
import { strict as assert } from 'node:assert';
import { cpus, loadavg } from 'node:os';
import { after, before, test } from 'node:test';
import { launch, on, pages } from './browser.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

const LIMIT_MS = 100;

const busy = () => loadavg()[0] > cpus().length;

/**
 * Times of an interaction, sorted: its event, its handlers, layout and the frame that follows; and the processor's time of the
 * page's thread in it, which other programs on the machine do not lengthen.
 */
async function times(page, client, selector, values, event, property = 'value') {
  const walls = [],
    ticks = [];
  const spent = async () =>
    (await client.send('Performance.getMetrics')).metrics.find(m => m.name === 'TaskDuration').value * 1000;
  for (const value of values) {
    const before = await spent();
    const wall = await page.evaluate(
      async ([selector, value, event, property]) => {
        const node = document.querySelector(selector);
        if (!node) return null;
        await new Promise(done => requestAnimationFrame(() => setTimeout(done, 30)));
        const from = performance.now();
        if (event === 'click') node.click();
        else {
          node[property] = value;
          node.dispatchEvent(new Event(event, { bubbles: true }));
        }
        document.body.getBoundingClientRect();
        await new Promise(done =>
          requestAnimationFrame(() => {
            const channel = new MessageChannel();
            channel.port1.onmessage = done;
            channel.port2.postMessage(0);
          }),
        );
        return performance.now() - from;
      },
      [selector, value, event, property],
    );
    if (wall === null) return null;
    walls.push(wall);
    ticks.push((await spent()) - before);
  }
  const sorted = list => list.sort((a, b) => a - b),
    middle = list => sorted(list)[Math.floor(list.length / 2)];
  return { wall: middle(walls), worst: walls.at(-1), thread: middle(ticks) };
}

for (const which of pages(['big', 'wide'], data => (data.cells?.count ?? 0) >= 5000)) {
  test(`${which.name}: every interaction within ${LIMIT_MS} ms`, () =>
    on(which, {}, async page => {
      await page.waitForTimeout(500);
      const stop = (await page.$('#speed .stops input')) ? '#speed .stops input' : null,
        heatStop = (await page.$('#heat .stops input')) ? '#heat .stops input' : null;
      const kinds = [
        stop && ['a stop of the lines', stop, ['1', '3', '5', '2', '0'], 'input'],
        ['the measure of the lines', '[data-role="speed-measure-0"]', ['1', '2', '3', '1', '0'], 'change'],
        [
          'the axis of the lines',
          '[data-role="speed-line"]',
          ['-1', ...(await page.$$eval('[data-role="speed-line"] option', all => all.slice(1, 5).map(o => o.value)))],
          'change',
        ],
        heatStop && ['a stop of the heat map', heatStop, ['1', '3', '5', '2', '0'], 'input'],
        ['the measure of the heat map', '[data-role="heat-measure"]', ['1', '2', '3', '1', '0'], 'change'],
        [
          'the axis of the heat map',
          '[data-role="heat-x"]',
          await page.$$eval('[data-role="heat-x"] option', all => all.slice(0, 5).map(o => o.value)),
          'change',
        ],
        ['sorting', '#jobs thead th:nth-child(5) button', [1, 2, 3, 4, 5], 'click'],
        ['filtering', '#jobs input[type="search"]', ['speed_m_s>10', 'speed_m_s>10 load_n<2e5', '', '15', ''], 'input'],
        ['turning a page', '#jobs .pager button:last-child', [1, 2, 3, 4, 5], 'click'],
        ['picking a job', '#jobs tbody tr:nth-child(2) .pick', [1, 2, 3, 4, 5], 'click'],
        ['a frame of the crossing', '#scrub', [3, 30, 60, 90, 12], 'input'],
      ].filter(Boolean);
      const slow = [];
      const client = await page.context().newCDPSession(page);
      await client.send('Performance.enable', { timeDomain: 'threadTicks' });
      for (const [name, ...how] of kinds) {
        // Where something else holds the processor for a moment, once more; where it never rests, the thread's own time decides.
        let best = null;
        for (let round = 0; round < 3 && (best === null || best.wall > LIMIT_MS); round++) {
          const now = await times(page, client, ...how);
          if (now && (!best || now.wall < best.wall)) best = now;
        }
        if (!best) continue;
        console.log(
          `# ${which.name}: ${name}: median ${best.wall.toFixed(0)} ms, worst ${best.worst.toFixed(0)} ms, of the page's thread ${best.thread.toFixed(0)} ms`,
        );
        if (best.wall > LIMIT_MS && !(busy() && best.thread <= LIMIT_MS))
          slow.push(`${name}: ${best.wall.toFixed(0)} ms, of the page's thread ${best.thread.toFixed(0)} ms`);
      }
      assert.deepEqual(slow, []);
    }));
}
