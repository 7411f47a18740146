// Opens pages in Chromium: from a file, with every request and every word on the console counted. Also the list of pages to test:
// made-up ones, and the program's own where the variable PONTOON_REPORTS names a folder of them.
import { strict as assert } from 'node:assert';
import { chromium } from 'playwright-core';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { build } from './build.mjs';
import { samples } from './sample.mjs';

const SWITCHES = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
const folder = mkdtempSync(join(tmpdir(), 'pontoon-page-'));
let browser;

/** Starts the browser for a test file; answers what stops it. */
export async function launch() {
  browser = await chromium.launch({
    executablePath: process.env.PONTOON_CHROMIUM ?? '/usr/bin/chromium',
    args: SWITCHES,
  });
  return async () => {
    await browser.close();
    rmSync(folder, { recursive: true, force: true });
  };
}

const made = new Map();
/** A made-up page: its file and its data. */
export function sample(name) {
  if (!made.has(name)) {
    const data = samples[name](),
      file = join(folder, `${name}.html`);
    writeFileSync(file, build(data));
    made.set(name, { name, file, data });
  }
  return made.get(name);
}

/** The program's own reports. */
export function reports() {
  const from = process.env.PONTOON_REPORTS;
  if (!from) return [];
  return readdirSync(from)
    .filter(f => f.endsWith('.html'))
    .sort()
    .map(f => {
      const file = join(from, f),
        text = readFileSync(file, 'utf8');
      return {
        name: basename(f, '.html'),
        file,
        data: JSON.parse(/<script type="application\/json" id="data">([^]*?)<\/script>/.exec(text)[1]),
        real: true,
      };
    });
}

/** All pages: the made-up ones of these names, then the program's own that `fits`. */
export const pages = (names, fits = () => true) => [...names.map(sample), ...reports().filter(r => fits(r.data))];

/** Opens a page. `problems` gathers what the console said and what failed, `requests` every address asked for after the page's own. */
export async function open(which, { width = 1280, height = 900, scheme = 'light', motion = 'no-preference' } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, reducedMotion: motion });
  const page = await context.newPage(),
    problems = [],
    requests = [],
    address = pathToFileURL(which.file).href;
  page.on('console', message => problems.push(`${message.type()}: ${message.text()}`));
  // what the browser tells the page alone, as of sizes that change while they are told
  await page.addInitScript(() => addEventListener('error', event => console.error(`told: ${event.message}`)));
  page.on('pageerror', error => problems.push(`error: ${error.stack}`));
  context.on('request', request => {
    if (request.url() !== address && !request.url().startsWith('data:')) requests.push(request.url());
  });
  await context.route(/^(?!file:|data:)/, route => route.abort());
  await page.goto(address);
  await page.waitForFunction(() => globalThis.pontoon?.ready === true, undefined, { timeout: 20000 });
  await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
  return { page, problems, requests, close: () => context.close() };
}

/** What a page shows that comes from a server whose policy lets no script run. */
export async function shownWithoutScripts(which) {
  const context = await browser.newContext(),
    page = await context.newPage();
  const headers = {
    'content-type': 'text/html; charset=utf-8',
    'content-security-policy': "default-src 'none'; style-src 'unsafe-inline'; script-src 'self'",
  };
  await context.route(/^http/, route => route.fulfill({ headers, body: readFileSync(which.file) }));
  try {
    await page.goto('http://report.test/');
    assert.equal(await page.evaluate(() => globalThis.pontoon), undefined);
    return await page.evaluate(() => document.body.innerText);
  } finally {
    await context.close();
  }
}

/** Runs a test on a page of its own and closes it. */
export async function on(which, options, test) {
  const opened = await open(which, options);
  try {
    await test(opened.page, opened);
  } finally {
    await opened.close();
  }
}
