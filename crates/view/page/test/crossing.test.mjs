// The crossing and the mode shapes: what is drawn at an instant is what the data says of it, and it moves only when it should.
import { strict as assert } from 'node:assert';
import { after, before, test } from 'node:test';
import { launch, on, pages, sample } from './browser.mjs';
import { list } from './expect.mjs';

let stop;
before(async () => {
  stop = await launch();
});
after(() => stop());

/** The drawing in pixels: bottom corners of the modules, joints, bars, wheels. The ruler and the dashed line at rest give the scales. */
const drawing = page =>
  page.evaluate(() => {
    const node = document.querySelector('svg.bridge'),
      number = (e, n) => Number(e.getAttribute(n)),
      ruler = node.querySelector('.ruler line');
    const at = e => {
      const [, x, y] = /translate\(([-\d.]+),([-\d.]+)\)/.exec(e.getAttribute('transform'));
      return [Number(x), Number(y)];
    };
    return {
      rest: number(node.querySelector('.rest'), 'y1'),
      left: number(ruler, 'x1'),
      right: number(ruler, 'x2'),
      time: Number(node.dataset.time),
      bank: number(node.querySelector('.bank'), 'y1'),
      modules: [...node.querySelectorAll('.module')].map(m =>
        m
          .getAttribute('points')
          .split(' ')
          .map(p => p.split(',').map(Number)),
      ),
      joints: [...node.querySelectorAll('path.joint')].map(j => ({
        joint: Number(j.dataset.joint),
        state: j.getAttribute('class').replace('joint ', ''),
        at: at(j),
        d: j.getAttribute('d'),
      })),
      bars: [...node.querySelectorAll('rect.force')].map(b => ({
        kind: b.getAttribute('class').replace('force ', ''),
        height: number(b, 'height'),
        top: number(b, 'y'),
      })),
      wheels: [...node.querySelectorAll('.wheel')].map(w => ({
        vehicle: Number(w.dataset.vehicle),
        behind: Number(w.dataset.behind),
        wide: number(w, 'x2') - number(w, 'x1'),
        middle: (number(w, 'x1') + number(w, 'x2')) / 2,
      })),
      readout: [...document.querySelectorAll('#crossing-readout dd')].map(d => d.textContent),
      note: document.querySelector('.stage .scale').textContent,
      exaggeration: Number(document.querySelector('#play-scale').value),
    };
  });
const STATES = ['open', 'compression', 'tension', 'both'];
const scrub = (page, frame) =>
  page.$eval(
    '#scrub',
    (node, f) => {
      node.value = f;
      node.dispatchEvent(new Event('input', { bubbles: true }));
    },
    frame,
  );

/** Holds a drawing against frame `f` of a play. */
function check(data, play, f, d) {
  const bridge = play.bridge ?? data.bridge,
    xs = bridge.position_x_m,
    P = xs.length,
    J = bridge.joints.length,
    length = xs.at(-1),
    s = (d.right - d.left) / length;
  const moved = list(play.deflection_m).slice(f * P, (f + 1) * P),
    w = Array.from(moved, (v, i) => v + (play.rest_m?.[i] ?? 0)),
    force = list(play.force_n),
    F = force.slice(f * J, (f + 1) * J),
    state = list(play.state).slice(f * J, (f + 1) * J),
    t = list(play.time_s)[f];
  assert.ok(Math.abs(d.time - t) < 1e-9 && d.readout[0] === `${t.toFixed(2)} s`, 'time');
  // Points are written with two decimals.
  d.modules.forEach((points, i) =>
    [
      [0, i],
      [1, i + 1],
    ].forEach(([c, p]) => {
      assert.ok(
        Math.abs(points[c][1] - d.rest - w[p] * d.exaggeration * s) < 0.011,
        `module ${i + 1}: end ${p + 1} is at ${points[c][1] - d.rest} px`,
      );
      assert.ok(Math.abs(points[c][0] - d.left - xs[p] * s) < 0.011, `module ${i + 1}: x`);
    }),
  );
  d.joints.forEach((joint, j) => {
    assert.equal(joint.joint, bridge.joints[j]);
    assert.equal(joint.state, STATES[state[j] & 3], `joint ${joint.joint}`);
    const p = joint.joint - 1;
    assert.ok(
      Math.abs(joint.at[0] - d.left - xs[p] * s) < 0.011 &&
        Math.abs(joint.at[1] - d.bank - w[p] * d.exaggeration * s) < 0.011,
      `place of joint ${joint.joint}`,
    );
  });
  const most = force.reduce((a, v) => Math.max(a, Math.abs(v)), 0);
  d.bars.forEach((bar, j) => {
    assert.ok(Math.abs(bar.height - (most ? (34 * Math.abs(F[j])) / most : 0)) < 0.011, `bar ${j}`);
    if (Math.abs(F[j]) > 0) assert.equal(bar.kind, F[j] < 0 ? 'compression' : 'tension');
  });
  assert.equal(
    d.wheels.length,
    play.vehicles.reduce((sum, vehicle) => sum + vehicle.axles.length, 0),
  );
  d.wheels.forEach(wheel => {
    const vehicle = play.vehicles[wheel.vehicle],
      axle = vehicle.axles.find(a => a.behind_front_m === wheel.behind),
      x = list(vehicle.front_x_m)[f] - (vehicle.backward ? -1 : 1) * axle.behind_front_m;
    // a short patch is drawn from its left end, three pixels wide
    const middle = x * s + Math.max(0, 1.5 - (axle.patch_length_m * s) / 2);
    assert.ok(Math.abs(wheel.middle - d.left - middle) < 0.02, 'place of an axle');
  });
}

for (const which of pages(['crossing', 'oneJob', 'big'], data => (data.plays ?? []).length > 0)) {
  test(`${which.name}: the drawing is the data at every instant looked at`, () =>
    on(which, {}, async page => {
      const { data } = which;
      for (const play of [data.plays[0], data.plays.at(-1)]) {
        await page.selectOption('#play-job', String(play.job));
        for (const f of [
          0,
          1,
          Math.floor(play.frames / 3),
          Math.floor(play.frames / 2),
          play.frames - 2,
          play.frames - 1,
        ]) {
          await scrub(page, f);
          check(data, play, f, await drawing(page));
        }
        for (const scale of ['1', '5', '50']) {
          await page.selectOption('#play-scale', scale);
          const d = await drawing(page);
          assert.ok(d.note.includes(`drawn ${scale} time`));
          check(data, play, play.frames - 1, d);
        }
      }
    }));
}

test('a deflection five per cent off, a state or a place that is wrong would be seen', () =>
  on(sample('crossing'), {}, async page => {
    const { data } = sample('crossing'),
      play = data.plays[0],
      f = 60;
    await page.selectOption('#play-job', String(play.job));
    await scrub(page, f);
    const d = await drawing(page);
    const wrong = change => {
      const p = structuredClone(play);
      change(p);
      return () => check(data, p, f, d);
    };
    assert.throws(
      wrong(p => {
        p.deflection_m.scale *= 1.05;
      }),
      /module/,
    );
    assert.throws(
      wrong(p => {
        p.state = list(p.state).map(s => (s + 1) % 3);
      }),
    );
    assert.throws(
      wrong(p => {
        p.vehicles[0].front_x_m = list(p.vehicles[0].front_x_m).map(x => x * 1.05);
      }),
      /axle/,
    );
  }));

test('joints differ in shape, not in colour alone', () =>
  on(sample('crossing'), {}, async page => {
    const paths = await page.$$eval('.legend.joints path', all =>
      all.map(p => [p.getAttribute('d'), getComputedStyle(p).fill]),
    );
    assert.equal(new Set(paths.map(p => p[0])).size, 4);
    assert.equal(new Set(paths.map(p => p[1])).size, 4);
  }));

test('open and lost couplings are marked at their joints and said', () =>
  on(sample('crossing'), {}, async page => {
    assert.equal(await page.$$eval('.wanting', all => all.length), 0, 'a whole bridge has no mark');
    await page.selectOption('#play-job', String(sample('crossing').data.plays[2].job));
    // picking plays: marks and joints are read at one instant
    const { marks, places } = await page.$eval('svg.bridge', node => ({
      marks: [...node.querySelectorAll('.wanting')].map(m => [
        Number(m.dataset.joint),
        m.getAttribute('class'),
        m.getAttribute('transform'),
      ]),
      places: Object.fromEntries(
        [...node.querySelectorAll('path.joint')].map(j => [j.dataset.joint, j.getAttribute('transform')]),
      ),
    }));
    const expected = ['3 uncoupled', '4 uncoupled', '7 lost'];
    assert.deepEqual(
      marks.map(([joint, kind]) => `${joint} ${kind.replace('wanting ', '')}`),
      expected,
    );
    for (const [joint, , place] of marks) assert.equal(place, places[joint]);
    const said = await page.$$eval('.legend.joints li', all => all.map(li => li.textContent));
    assert.deepEqual(said.slice(-2), ['coupling open: pushes only', 'connectors lost']);
  }));

test('a bank stands under the end of the bridge that it carries', () =>
  on(sample('crossing'), {}, async page => {
    assert.equal(await page.$$eval('.spring', all => all.length), 0, 'a bridge without banks has none');
    await page.selectOption('#play-job', String(sample('crossing').data.plays[2].job));
    const { banks, left, base, px, scale } = await page.$eval('svg.bridge', node => ({
      banks: [...node.querySelectorAll('.spring')].map(b => [Number(b.dataset.bank), b.getAttribute('d')]),
      left: Number(node.dataset.left),
      base: Number(node.dataset.base),
      px: Number(node.dataset.pxM),
      scale: Number(node.dataset.scale),
    }));
    assert.equal(banks.length, 1);
    const [x, y] = banks[0][1].slice(1).split('h')[0].split(' ').map(Number);
    assert.ok(Math.abs(x + 6 - left) < 0.02, 'under the left end');
    assert.ok(Math.abs(y - (base + 0.05 * scale * px)) < 0.02, 'its clearance below the bridge');
  }));

test('a bridge with a dead load starts from its dead state, in the river where it has risen', () =>
  on(sample('crossing'), {}, async page => {
    const play = sample('crossing').data.plays[3];
    await page.selectOption('#play-job', String(play.job));
    await scrub(page, 0);
    const now = await drawing(page),
      { px, scale, water } = await page.$eval('svg.bridge', node => ({
        px: Number(node.dataset.pxM),
        scale: Number(node.dataset.scale),
        water: Number(node.querySelector('.waterline').getAttribute('y1')),
      }));
    const tall = now.modules[0][0][1] - now.modules[0][3][1];
    assert.ok(Math.abs(now.rest - water - ((0.2 / 1.07) * tall + 0.03 * scale * px)) < 0.05, 'the river');
    check(sample('crossing').data, play, 0, now);
  }));

test('modules that slope are drawn with the heights of their corners, and the bank beyond them at their deck', () =>
  on(sample('crossing'), {}, async page => {
    await page.selectOption('#play-job', String(sample('crossing').data.plays[1].job));
    await scrub(page, 0);
    const now = await drawing(page);
    const tall = now.modules[0][0][1] - now.modules[0][3][1];
    const [bottomLeft, bottomRight, deckRight, deckLeft] = now.modules.at(-1).map(([, y]) => (now.rest - y) / tall);
    for (const [drawn, height] of [
      [bottomLeft, 0],
      [bottomRight, -0.4],
      [deckRight, 0.6],
      [deckLeft, 1.07],
    ])
      assert.ok(Math.abs(drawn - height / 1.07) < 0.01, `${drawn} of ${height}`);
    const banks = await page.$$eval('.bank', all => all.map(b => Number(b.getAttribute('y1'))));
    assert.ok(Math.abs((now.rest - banks[0]) / tall - 1) < 0.01);
    assert.ok(Math.abs((now.rest - banks[1]) / tall - 0.6 / 1.07) < 0.01);
  }));

test('it plays, pauses, steps, runs at the speed that is chosen and ends', () =>
  on(sample('crossing'), {}, async page => {
    const frame = () => page.$eval('svg.bridge', n => Number(n.dataset.frame)),
      time = () => page.$eval('svg.bridge', n => Number(n.dataset.time));
    assert.equal(await page.textContent('#play'), 'Play', 'nothing moves before it is asked to');
    await page.selectOption('#play-job', '3');
    assert.equal(await page.textContent('#play'), 'Pause', 'picking plays');
    const [a, at] = [await time(), Date.now()];
    await page.waitForTimeout(600);
    const b = await time(),
      passed = (Date.now() - at) / 1000;
    assert.ok(b > a && b - a < 2 * passed + 0.2, `as fast as the truck: ${b - a} s in ${passed} s`);
    await page.click('#play');
    const still = await frame();
    await page.waitForTimeout(150);
    assert.equal(await frame(), still);
    await page.click('#step-on');
    assert.equal(await frame(), Math.floor(still) + 1);
    await page.click('#step-back');
    assert.equal(await frame(), Math.floor(still));
    await page.selectOption('#play-speed', '4');
    await page.click('#play');
    await page.waitForFunction(() => document.querySelector('#play').textContent === 'Play', undefined, {
      timeout: 15000,
    });
    assert.equal(await frame(), sample('crossing').data.plays.find(p => p.job === 3).frames - 1);
  }));

test('mode shapes move when asked to, and are drawn as the data says', () =>
  on(sample('natural'), {}, async page => {
    const { list: modes } = sample('natural').data.modes[0],
      { bridge } = sample('natural').data;
    const deck = () =>
      page.$$eval('.box.deck', all =>
        all.map(p =>
          p
            .getAttribute('points')
            .split(' ')
            .map(q => q.split(',').map(Number)),
        ),
      );
    const flat = async () => {
      await page.$eval('#mode-amplitude', n => {
        n.value = 0;
        n.dispatchEvent(new Event('input'));
      });
      const d = await deck();
      await page.$eval('#mode-amplitude', n => {
        n.value = 1;
        n.dispatchEvent(new Event('input'));
      });
      return d;
    };
    for (const n of [0, 2, 3, 4]) {
      await page.emulateMedia({ reducedMotion: 'reduce' });
      await page.click(`#modes tbody tr:nth-child(${n + 1}) .pick`);
      const motion = list(modes[n].motion),
        up = await deck(),
        rest = await flat();
      let unit = null;
      for (let m = 0; m < bridge.modules; m++)
        for (let c = 0; c < 4; c++) {
          const z = motion[(m * 8 + 4 + c) * 3 + 2],
            moved = rest[m][c][1] - up[m][c][1];
          if (Math.abs(z) > 0.5) {
            unit ??= moved / z;
            assert.ok(Math.abs(moved - z * unit) < 0.5, `mode ${n + 1}, module ${m + 1}`);
          }
        }
      assert.ok(unit > 5, 'upward is up');
    }
    await page.selectOption('#modes .controls select', '1');
    assert.equal((await deck()).length, 1, 'a bridge of one module in the same study');
    await page.selectOption('#modes .controls select', '0');
    await page.emulateMedia({ reducedMotion: 'no-preference' });
    const before = JSON.stringify(await deck());
    await page.click('#mode-play');
    await page.waitForTimeout(300);
    assert.notEqual(JSON.stringify(await deck()), before);
  }));

test('reduced motion: picking does not play', () =>
  on(sample('crossing'), { motion: 'reduce' }, async page => {
    await page.selectOption('#play-job', '3');
    assert.equal(await page.textContent('#play'), 'Play');
    const frame = await page.$eval('svg.bridge', n => n.dataset.frame);
    await page.waitForTimeout(200);
    assert.equal(await page.$eval('svg.bridge', n => n.dataset.frame), frame);
    await page.click('#modes tbody tr:nth-child(4) .pick');
    assert.equal(await page.textContent('#mode-play'), 'Play');
  }));
