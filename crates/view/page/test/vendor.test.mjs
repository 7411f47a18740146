// The chart library is the package's own, byte for byte, and the page's code is small.
import { strict as assert } from 'node:assert';
import { readFileSync, statSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { order } from './build.mjs';

const folder = fileURLToPath(new URL('..', import.meta.url));
const COPIES = {
  'vendor/d3.min.js': 'd3/dist/d3.min.js',
  'vendor/d3.LICENSE': 'd3/LICENSE',
  'vendor/plot.umd.min.js': '@observablehq/plot/dist/plot.umd.min.js',
  'vendor/plot.LICENSE': '@observablehq/plot/LICENSE',
};

for (const [copy, original] of Object.entries(COPIES)) {
  test(`${copy} is ${original} of npm`, () =>
    assert.ok(
      readFileSync(folder + copy).equals(readFileSync(`${folder}node_modules/${original}`)),
      'run scripts/vendor-page',
    ));
}

test('all that every page carries is below 700 kB', () => {
  const size = [...order(), 'page.html', 'style.css'].reduce((sum, name) => sum + statSync(folder + name).size, 0);
  console.log(`# page without data: ${(size / 1000).toFixed(0)} kB`);
  assert.ok(size < 700000, `${size} bytes`);
});

test('no script can end the element that it stands in', () => {
  for (const name of order()) assert.ok(!/<\/script|<!--/i.test(readFileSync(folder + name, 'utf8')), name);
});
