// Made-up data by the page's contract: shaped like a bridge's answers, random enough that no two marks coincide.
// Knows the contract alone; the tests that use it must hold for real reports too.

const base64 = array => Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString('base64');
export const f32 = values => ({ f32: base64(Float32Array.from(values, v => (v === null ? NaN : v))) });
const u8 = values => ({ u8: base64(Uint8Array.from(values)) });
const u16 = values => ({ u16: base64(Uint16Array.from(values)) });
const u32 = values => ({ u32: base64(Uint32Array.from(values)) });
const i16 = (values, scale) => ({ scale, i16: base64(Int16Array.from(values, v => Math.round(v / scale))) });
const words = values => {
  const list = [...new Set(values.filter(v => v !== null))];
  return { words: list, index: u16(values.map(v => (v === null ? 65535 : list.indexOf(v)))) };
};

/** A repeatable stream of numbers in [0, 1). */
const random = seed => () => {
  seed = (seed + 0x6d2b79f5) | 0;
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
};

const MODULES = 15,
  LENGTH = 6.7;
const bridge = {
  modules: MODULES,
  module_length_m: LENGTH,
  breadth_m: 8.082,
  depth_m: 1.07,
  position_x_m: Array.from({ length: MODULES + 1 }, (_, i) => i * LENGTH),
  joints: Array.from({ length: MODULES - 1 }, (_, i) => i + 2),
};

const AXES = {
  connection: { name: 'connection', label: 'connection', unit: '', kind: 'word' },
  gap_tension_m: { name: 'gap_tension_m', label: 'tension gap', unit: 'm', kind: 'number' },
  gap_compression_m: { name: 'gap_compression_m', label: 'compression gap', unit: 'm', kind: 'number' },
  speed_m_s: { name: 'speed_m_s', label: 'speed', unit: 'm/s', kind: 'number' },
  load_n: { name: 'load_n', label: 'load', unit: 'N', kind: 'number' },
  vehicle: { name: 'vehicle', label: 'vehicle', unit: '', kind: 'word' },
  crossing_type: { name: 'crossing_type', label: 'crossing type', unit: '', kind: 'word' },
};
const MEASURES = {
  peak_deflection_m: ['peak deflection', 'm'],
  peak_uplift_m: ['peak uplift', 'm'],
  peak_compression_n: ['peak compression', 'N'],
  peak_tension_n: ['peak tension', 'N'],
  dynamic_amplification: ['dynamic amplification', ''],
  influential_length_m: ['influential length', 'm'],
  utilisation: ['utilisation', ''],
  rated_value: ['rated value', ''],
};
const measures = names => names.map(name => ({ name, label: MEASURES[name][0], unit: MEASURES[name][1] }));

/** A job's answers from its axes: monotonic in load, humped in speed, deeper with gaps. */
function answer(job, draw) {
  const gap = (job.gap_tension_m ?? 0) + (job.gap_compression_m ?? 0),
    v = job.speed_m_s ?? 5,
    load = job.load_n / 230300;
  const hump = 1 + 0.5 / (1 + ((v - 15) / 4) ** 2);
  const depth = load * (0.14 + 4 * gap) * hump * (1 + 0.03 * draw());
  return {
    peak_deflection_m: depth,
    peak_uplift_m: depth * 0.6 * (hump - 0.95),
    peak_compression_n: load * 7e5 * hump * (1 - 8 * gap) * (1 + 0.05 * draw()),
    peak_tension_n: load * 2e5 * hump * (1 + 0.1 * draw()),
    dynamic_amplification: hump * (1 + 0.02 * draw()),
    influential_length_m: 20 + 200 * gap + draw(),
    utilisation: depth / 0.25,
    rated_value: (353725.99 * (1 - 5 * gap)) / hump,
  };
}

/** Aggregates, rows, envelope of a list of jobs. */
function study(kind, name, jobs, axisNames, measureNames, options = {}) {
  const draw = random(7);
  const failed = job => (options.failed ?? []).includes(job.job);
  jobs.forEach((job, i) => (job.job = i));
  jobs.forEach(job => (job.answers = failed(job) ? null : answer(job, draw)));
  const axes = axisNames.map(axis => {
    const base = { ...AXES[axis] },
      values = [...new Set(jobs.map(j => j[axis] ?? null))];
    values.sort((a, b) => (a === null ? 1 : b === null ? -1 : a < b ? -1 : 1));
    return { ...base, values, bins: null, constant: values.length < 2, ...(options.axis?.[axis] ?? {}) };
  });
  const where = axes.map(axis => new Map(axis.values.map((v, i) => [v, i])));
  const cells = new Map();
  for (const job of jobs) {
    const at = axes.map((axis, a) => where[a].get(job[axis.name] ?? null)),
      key = at.join();
    if (!cells.has(key)) cells.set(key, { at, jobs: [] });
    cells.get(key).jobs.push(job);
  }
  const list = [...cells.values()],
    good = cell => cell.jobs.filter(j => j.answers);
  const best = (cell, m, sign) =>
    good(cell).reduce((a, j) => (!a || sign * j.answers[m] > sign * a.answers[m] ? j : a), null);
  const rows = options.rows ? jobs.filter(j => options.rows(j)) : jobs;
  const profile = (job, x) =>
    job.answers &&
    job.answers.peak_deflection_m *
      (0.6 + 0.4 * Math.sin((Math.PI * x) / 50) ** 2) *
      Math.sin((Math.PI * (x + 3)) / 106.5) ** 0.3;
  const force = (job, joint, measure) =>
    job.answers && job.answers[measure] * Math.sin((Math.PI * (joint - 1)) / MODULES) ** 0.5;
  const over = (items, f) =>
    jobs.filter(j => j.answers).length
      ? items.map(item => Math.max(...rows.filter(j => j.answers).map(j => f(j, item))))
      : null;
  const deflection = over(bridge.position_x_m, profile),
    ok = jobs.filter(j => j.answers).length;
  const top = measureNames
    .slice(0, 4)
    .map(m => ({ m, job: best({ jobs }, m, 1) }))
    .filter(c => c.job);
  const nameAxes = job =>
    axisNames
      .filter(a => job[a] !== undefined && job[a] !== null)
      .map(a => `${AXES[a].label} ${job[a]}${AXES[a].unit && ' ' + AXES[a].unit}`)
      .join(', ');
  return {
    format: 1,
    program: { version: '0.1.0', commit: 'b3c1f00' },
    study: {
      name,
      question: 'How deep does the bridge go, and how hard are its connectors hit?',
      kind,
      settings: [
        { label: 'Bridge', value: '15 modules of 6.7 m, 8.08 m wide, 1.07 m deep' },
        { label: 'Vehicle', value: 'one footprint of 3.35 m, wheels at -1.4 m and 1.4 m' },
        { label: 'Solver', value: 'operator, super-element, time step 0.01 s' },
      ],
    },
    bridge,
    jobs: { total: jobs.length, ok, failed: jobs.length - ok, missing: 0 },
    notes: [],
    axes,
    measures: measures(measureNames),
    cells: {
      count: list.length,
      axis: axes.map((_, a) => u16(list.map(c => c.at[a]))),
      jobs: u32(list.map(c => c.jobs.length)),
      failed: u32(list.map(c => c.jobs.length - good(c).length)),
      max: measureNames.map(m => f32(list.map(c => best(c, m, 1)?.answers[m] ?? null))),
      min: measureNames.map(m => f32(list.map(c => best(c, m, -1)?.answers[m] ?? null))),
      at: measureNames.map(m => u32(list.map(c => best(c, m, 1)?.job ?? 4294967295))),
    },
    cards: top.map(({ m, job }) => ({
      measure: m,
      label: MEASURES[m][0].replace('peak', 'largest'),
      value: job.answers[m],
      unit: MEASURES[m][1],
      where: 'position 14 at 6.3 s',
      job: job.job,
      axes: nameAxes(job),
    })),
    failures:
      ok < jobs.length
        ? [
            {
              count: jobs.length - ok,
              job: jobs.find(failed).job,
              kind: 'contact_not_settled',
              reason: 'contacts did not settle at 3.21 s in 40 iterations',
            },
          ]
        : [],
    marks: [],
    envelope: deflection && {
      x_m: bridge.position_x_m,
      deflection_m: f32(deflection),
      uplift_m: f32(deflection.map(v => v * 0.4)),
      joint_x_m: bridge.joints.map(j => bridge.position_x_m[j - 1]),
      compression_n: f32(over(bridge.joints, (j, n) => force(j, n, 'peak_compression_n'))),
      tension_n: f32(over(bridge.joints, (j, n) => force(j, n, 'peak_tension_n'))),
    },
    rows: {
      count: rows.length,
      note:
        rows.length === jobs.length
          ? `all ${jobs.length} jobs`
          : `${rows.length} of ${jobs.length} jobs: the largest, the failed and an even sample`,
      columns: [
        ...axes.map(axis => ({
          name: axis.name,
          label: axis.label,
          unit: axis.unit,
          kind: axis.kind,
          data:
            axis.kind === 'number'
              ? f32(rows.map(j => j[axis.name] ?? null))
              : words(rows.map(j => j[axis.name] ?? null)),
        })),
        ...measureNames.map(m => ({
          name: m,
          label: MEASURES[m][0],
          unit: MEASURES[m][1],
          kind: 'number',
          data: f32(rows.map(j => j.answers?.[m] ?? null)),
        })),
        ...(options.more?.(rows) ?? []),
      ],
      job: u32(rows.map(j => j.job)),
      ok: u8(rows.map(j => (j.answers ? 1 : 0))),
      reason: words(rows.map(j => (j.answers ? null : 'contacts did not settle at 3.21 s in 40 iterations'))),
      profile:
        options.profile === false
          ? null
          : {
              deflection_m: f32(rows.flatMap(j => bridge.position_x_m.map(x => profile(j, x)))),
              uplift_m: f32(rows.flatMap(j => bridge.position_x_m.map(x => profile(j, x) && 0.4 * profile(j, x)))),
              compression_n: f32(rows.flatMap(j => bridge.joints.map(n => force(j, n, 'peak_compression_n')))),
              tension_n: f32(rows.flatMap(j => bridge.joints.map(n => force(j, n, 'peak_tension_n')))),
              signed_m:
                kind === 'static'
                  ? f32(
                      rows.flatMap(j =>
                        bridge.position_x_m.map(x => j.answers && profile(j, x) * Math.cos((x - 50) / 18)),
                      ),
                    )
                  : null,
            },
    },
    histories:
      kind === 'crossing'
        ? rows
            .filter(j => j.answers)
            .slice(0, 6)
            .flatMap(j => history(j, nameAxes(j)))
        : [],
    plays:
      kind === 'crossing' || kind === 'rating'
        ? rows
            .filter(j => j.answers)
            .slice(0, options.plays ?? 12)
            .map(play)
        : [],
    modes: [{ label: 'floating free', list: modes() }],
    verdicts: null,
    provenance: [
      { label: 'study hash', value: '5f0c7d1f9f0f2f8b1a6e' },
      { label: 'bridge hash', value: 'a81d6d20f1c09f3aa0c3' },
      { label: 'program', value: 'pontoon 0.1.0 (b3c1f00)' },
      { label: 'ran', value: '2026-11-20 10:12:03 to 10:12:05 UTC on 2 threads' },
    ],
  };
}

function history(job, axes) {
  const time = Array.from({ length: 400 }, (_, i) => i * 0.05),
    v = job.speed_m_s;
  const bump = t =>
    job.answers.peak_deflection_m * Math.exp(-(((v * t - 40.2) / 12) ** 2)) * (1 + 0.1 * Math.sin(5 * t));
  return [
    {
      job: job.job,
      axes,
      position: 7,
      place: 'position 7',
      quantity: 'deflection_m',
      unit: 'm',
      time_s: f32(time),
      value: f32(time.map(bump)),
    },
    {
      job: job.job,
      axes,
      position: 7,
      place: 'joint 7',
      quantity: 'force_n',
      unit: 'N',
      time_s: f32(time),
      value: f32(time.map(t => -bump(t) * 4e6 + 1e5 * Math.sin(4 * t))),
    },
  ];
}

function play(job) {
  const F = 140,
    v = job.speed_m_s,
    end = (15 * LENGTH + 20) / v,
    time = Array.from({ length: F }, (_, i) => (i * end) / (F - 1));
  const front = time.map(t => v * t),
    w = job.answers.peak_deflection_m,
    depth = (x, f) => w * Math.exp(-(((x - f + 3) / 11) ** 2)) - 0.25 * w * Math.exp(-(((x - f - 22) / 10) ** 2));
  const forces = front.flatMap(f =>
    bridge.joints.map(n => {
      const x = bridge.position_x_m[n - 1],
        d = Math.abs(x - f + 3);
      return d < 12
        ? -job.answers.peak_compression_n * (1 - d / 12)
        : d < 24
          ? job.answers.peak_tension_n * (1 - Math.abs(d - 18) / 6)
          : 0;
    }),
  );
  return {
    job: job.job,
    frames: F,
    time_s: f32(time),
    vehicles: [
      {
        front_x_m: f32(front),
        axles: [{ behind_front_m: 0, share: 1, patch_length_m: 3.35 }],
        load_n: job.load_n,
      },
      // another one comes from the right end, half as fast
      {
        front_x_m: f32(front.map(x => 15 * LENGTH - 0.5 * x)),
        backward: true,
        axles: [
          { behind_front_m: 0, share: 0.4, patch_length_m: 0.3 },
          { behind_front_m: 4.5, share: 0.6, patch_length_m: 0.3 },
        ],
        load_n: job.load_n,
      },
    ],
    deflection_m: i16(
      front.flatMap(f => bridge.position_x_m.map(x => depth(x, f))),
      w / 32000,
    ),
    force_n: i16(forces, 50),
    state: u8(forces.map((f, i) => (f < -1 ? (i % 37 === 0 ? 3 : 1) : f > 1 ? 2 : 0))),
  };
}

function modes() {
  const shapes = [
    ['heave', () => 1],
    ['pitch', s => 2 * s - 1],
    ['roll', null],
    ['vertical bending 1', s => Math.cos(2 * Math.PI * s)],
    ['torsion 1', null],
    ['vertical bending 2', s => Math.cos(3 * Math.PI * s)],
  ];
  return shapes.map(([shape, f], n) => {
    const motion = [];
    for (let m = 0; m < MODULES; m++)
      for (let c = 0; c < 8; c++) {
        const s = (m + (c % 4 === 1 || c % 4 === 2 ? 1 : 0)) / MODULES,
          side = c % 4 === 2 || c % 4 === 3 ? 1 : -1;
        motion.push(0, 0, f ? f(s) : side * (shape === 'roll' ? 1 : Math.cos(Math.PI * s)));
      }
    return { number: n + 1, frequency_hz: 0.28 + 0.09 * n * n ** 0.5, shape, motion: f32(motion) };
  });
}

const product = axes =>
  Object.entries(axes).reduce(
    (list, [name, values]) => list.flatMap(job => values.map(v => ({ ...job, [name]: v }))),
    [{}],
  );
const CROSSING = ['connection', 'gap_tension_m', 'gap_compression_m', 'speed_m_s', 'load_n'];
const PEAKS = ['peak_deflection_m', 'peak_uplift_m', 'peak_compression_n', 'peak_tension_n', 'dynamic_amplification'];

/** The paper's 21 crossings: linear and four settings of the gaps, four speeds, and the test run. One job failed. */
export function crossing() {
  const gaps = [
      [0.028, 0.0055],
      [0.028, 0],
      [0.005, 0.0055],
      [0, 0.0055],
    ],
    speed = [3, 7, 10, 15];
  const jobs = [
    ...product({ connection: ['linear'], speed_m_s: speed, load_n: [230300] }),
    ...gaps.flatMap(([t, c]) =>
      product({
        connection: ['nonlinear'],
        gap_tension_m: [t],
        gap_compression_m: [c],
        speed_m_s: speed,
        load_n: [230300],
      }),
    ),
    { connection: 'nonlinear', gap_tension_m: 0.028, gap_compression_m: 0.0055, speed_m_s: 6.09, load_n: 132300 },
  ];
  const data = study('crossing', 'fu2005', jobs, CROSSING, PEAKS, { failed: [9] });
  data.plays[2].bridge = {
    ...bridge,
    open_joints: [3, 4],
    lost_joints: [7],
    banks: [{ bank: 0, position: 1, clearance_m: 0.05 }],
  };
  // it starts from its dead state, the river 3 cm higher
  data.plays[3].bridge = { ...bridge, draft_m: 0.2, water_level_m: 0.03 };
  data.plays[3].rest_m = bridge.position_x_m.map((_, i) => 0.01 + 0.002 * i);
  // a ramp that falls to its right end: its bottom as deep as it goes, its deck half as high
  data.plays[1].bridge = {
    ...bridge,
    module_heights_m: bridge.position_x_m
      .slice(1)
      .map((_, i) => (i === MODULES - 1 ? [0, -0.4, 1.07, 0.6] : [0, 0, 1.07, 1.07])),
  };
  data.notes = ['The reference was measured on a model at 1 : 10.'];
  data.marks = [
    ...speed.map((x, i) => ({
      id: `fig14-${i}`,
      chart: 'speed',
      measure: 'peak_deflection_m',
      x,
      y: 0.19 + 0.03 * i,
      label: 'measured',
      position: 7,
      axes: { connection: 'nonlinear', gap_tension_m: 0.028, gap_compression_m: 0.0055 },
    })),
    ...[2, 5, 7, 9, 12].map((p, i) => ({
      id: `fig11-${i}`,
      chart: 'profile',
      measure: 'peak_deflection_m',
      x: (p - 1) * LENGTH,
      y: 0.15 + 0.02 * i,
      label: 'measured profile',
      position: p,
      axes: {},
    })),
    {
      id: 'fig10',
      chart: 'history',
      measure: 'deflection_m',
      x: null,
      y: 0.12,
      label: 'measured hump',
      position: 7,
      axes: {},
    },
  ];
  data.verdicts = {
    source: 'Fu, Cui, Chen, Wang: Marine Structures 18 (2005) 85-107',
    good: false,
    lines: [
      {
        id: 'hump',
        statement: 'The hump at 15 m/s is 1.5 times that at 3 m/s',
        role: 'hold',
        verdict: 'holds',
        word: 'holds',
        tone: 'good',
        expected: '1.5 within 3 %',
        found: '1.49',
        deviation: '-0.7 %',
        margin: '2.3 %',
        note: '',
      },
      {
        id: 'growth',
        statement: 'Deflection grows with the tension gap at every speed',
        role: 'hold',
        verdict: 'falls-short',
        word: 'FALLS SHORT',
        tone: 'bad',
        expected: 'a larger value at each of 4 speeds',
        found: '3 of 4',
        deviation: '',
        margin: '',
        note: 'at 7 m/s it falls by 0.3 %',
      },
      {
        id: 'largest',
        statement: 'The largest deflection is at position 7',
        role: 'expected-fail',
        verdict: 'expected-fail',
        word: 'fails as expected',
        tone: 'plain',
        expected: 'position 7',
        found: 'position 14',
        deviation: '',
        margin: '',
        note: 'the far end goes down at 15 m/s',
      },
      {
        id: 'test-run',
        statement: '',
        role: 'record',
        verdict: 'record',
        word: 'record',
        tone: 'plain',
        expected: '0.12',
        found: '0.1196',
        deviation: '-0.3 %',
        margin: '',
        note: '',
      },
    ],
  };
  return data;
}

/** As large as a page may be: 40,000 cells, 2,000 rows of 40,000 jobs. */
export function big() {
  const line = (n, a, b) => Array.from({ length: n }, (_, i) => +(a + ((b - a) * i) / (n - 1)).toFixed(5));
  const jobs = product({
    connection: ['nonlinear'],
    gap_tension_m: line(10, 0, 0.04),
    gap_compression_m: line(10, 0, 0.02),
    speed_m_s: line(40, 2, 20),
    load_n: line(10, 5e4, 6e5),
  });
  const data = study('crossing', 'gaps-times-speed', jobs, CROSSING, PEAKS, {
    failed: [77, 5003],
    rows: j => j.job % 20 === 0 || j.job === 77,
    profile: undefined,
    plays: 12,
  });
  data.notes = [];
  return data;
}

/** Two axes of 200 values: the largest heat map that 40,000 cells allow. */
export function wide() {
  const line = (n, a, b) => Array.from({ length: n }, (_, i) => +(a + ((b - a) * i) / (n - 1)).toFixed(5));
  const jobs = product({ speed_m_s: line(200, 2, 20), load_n: line(200, 5e4, 6e5) });
  return study('crossing', 'wide', jobs, ['speed_m_s', 'load_n'], PEAKS, { rows: j => j.job % 20 === 0, plays: 2 });
}

export function still() {
  const jobs = product({ connection: ['linear'], load_x_m: [10, 30, 50.25], load_n: [1e5, 2e5] });
  AXES.load_x_m = { name: 'load_x_m', label: 'place of the load', unit: 'm', kind: 'number' };
  return study(
    'static',
    'fig09_static',
    jobs,
    ['connection', 'load_x_m', 'load_n'],
    ['peak_deflection_m', 'peak_uplift_m', 'peak_compression_n', 'peak_tension_n', 'influential_length_m'],
    { failed: [5] },
  );
}

export function natural() {
  const data = study('modes', 'table1', [{ load_n: 1 }, { load_n: 2 }], ['connection'], []);
  const list = modes();
  return {
    ...data,
    study: { ...data.study, question: 'Which frequencies has the bridge of the paper?' },
    envelope: null,
    cards: [],
    rows: {
      ...data.rows,
      profile: null,
      columns: [{ name: 'bridge.modules', label: 'modules', unit: '', kind: 'number', data: f32([15, 7]) }],
    },
    mode_table: [0, 1].flatMap(job =>
      list.map(m => ({
        job,
        axes: `modules ${job ? 7 : 15}`,
        number: m.number,
        frequency_hz: m.frequency_hz * (1 + job),
        shape: m.shape,
      })),
    ),
    modes: [
      { label: 'floating free', list },
      {
        label: 'one module',
        list: list
          .slice(0, 3)
          .map(m => ({ ...m, motion: f32(Array.from({ length: 24 }, (_, i) => (i % 3 === 2 ? 1 : 0))) })),
      },
    ],
  };
}

export function allFailed() {
  const data = study(
    'crossing',
    'all-failed',
    product({ speed_m_s: [3, 7], load_n: [230300] }),
    ['speed_m_s', 'load_n'],
    PEAKS,
    { failed: [0, 1] },
  );
  return { ...data, notes: ['All 2 jobs failed: there is nothing to draw'], envelope: null, modes: [] };
}
export const oneJob = () =>
  study('crossing', 'one-job', product({ speed_m_s: [6.09], load_n: [132300] }), ['speed_m_s', 'load_n'], PEAKS);
export const oneAxis = () =>
  study(
    'crossing',
    'one-axis',
    product({ speed_m_s: [3, 7, 10, 15], load_n: [230300] }),
    ['speed_m_s', 'load_n'],
    PEAKS,
  );

const LIMITS = [
  ['edge_sinkage_m', 16],
  ['joint_compression_n', 14],
  ['trim_rad', 15],
  ['axle_contact_n', 5],
];

/** Which vehicle may cross how: one crossing failed, one was not asked for, one is a hair beyond its limit. */
export function classes() {
  const vehicles = { mlc40_wheeled: 3.4e5, mlc60_tracked: 5.4e5, mlc80_tracked: 7.1e5 };
  const types = [
    ['normal', 2],
    ['normal', 6],
    ['caution', 3.6],
    ['risk', 1.3],
  ];
  const jobs = Object.entries(vehicles).flatMap(([vehicle, load_n]) =>
    product({ vehicle: [`../../rating/vehicles/${vehicle}.json`], gap_tension_m: [0, 0.028] }).flatMap(job =>
      types.map(([crossing_type, speed_m_s]) => ({
        ...job,
        connection: 'nonlinear',
        gap_compression_m: 0.0055,
        crossing_type,
        speed_m_s,
        load_n: load_n / 3,
      })),
    ),
  );
  jobs.pop();
  const axes = [...CROSSING, 'vehicle', 'crossing_type'];
  const data = study('crossing', 'rating_classes', jobs, axes, ['utilisation', ...PEAKS], { failed: [6] });
  const cell = (job, i) => ({
    job: job.job,
    utilisation: !job.answers ? null : i === 9 ? 1.0004 : i === 10 ? 1 : job.answers.utilisation,
    limit: job.answers ? LIMITS[i % 4][0] : null,
    place: !job.answers || i === 3 ? null : 1 + (i % LIMITS[i % 4][1]),
  });
  const cells = jobs.map(cell);
  data.classes = {
    names: ['vehicle', 'tension gap'],
    heads: types.map(([type, speed]) => `${type} ${speed} m/s`),
    rows: Object.keys(vehicles).flatMap((vehicle, v) =>
      ['0', '0.028'].map((gap, g) => ({
        names: [vehicle, gap],
        cells: types.map((_, t) => cells[8 * v + 4 * g + t] ?? null),
      })),
    ),
  };
  return data;
}

/** Points drawn at random: how often limits are exceeded. */
export function drawn() {
  const next = random(3);
  const jobs = Array.from({ length: 40 }, () => ({ speed_m_s: 2 + 6 * next(), load_n: 1e5 + 3.5e5 * next() }));
  const data = study('crossing', 'drawn', jobs, ['speed_m_s', 'load_n'], ['utilisation', ...PEAKS], { failed: [4, 8] });
  const exceedance = (limit, exceeded, low, high) => ({
    limit,
    exceeded,
    jobs: 38,
    failed: 2,
    share: exceeded / 38,
    interval: [low, high],
  });
  data.exceedance = [
    exceedance('edge_sinkage_m', 15, 0.2402, 0.5662),
    exceedance('joint_tension_n', 0, 0, 0.0925),
    exceedance('axle_contact_n', 1, 0.0007, 0.1381),
  ];
  return data;
}

/** Rated values over speed and gaps; one bracket passes as a whole. */
export function rating() {
  const jobs = product({ gap_tension_m: [0, 0.014, 0.028], gap_compression_m: [0, 0.0055], speed_m_s: [2, 5, 10] });
  jobs.forEach(job => (job.load_n = 230300));
  const number = (name, label, unit, value) => rows => ({
    name,
    label,
    unit,
    kind: 'number',
    data: f32(rows.map((job, i) => (job.answers ? value(job, i) : null))),
  });
  const columns = [
    number('first_failure', 'first failure', '', job => 1.002 * job.answers.rated_value),
    number('monotone', 'monotone', '', (_, i) => (i % 3 ? 1 : 0)),
    number('crossings', 'crossings', '', (_, i) => 155 + i),
    number('governing_place', 'governing place', '', (_, i) => 2 + (i % 13)),
  ];
  return study(
    'rating',
    'rating',
    jobs,
    ['gap_tension_m', 'gap_compression_m', 'speed_m_s'],
    ['rated_value', 'utilisation', ...PEAKS.slice(0, 4)],
    { failed: [5], more: rows => columns.map(column => column(rows)) },
  );
}

const EVIL = '</script><img src=x onerror="globalThis.hurt=1"><b>&amp;{{script}}$&';
/** Every string is full of markup. */
export function markup() {
  const data = crossing();
  const spoil = v => (typeof v === 'string' ? v + EVIL : v);
  data.study.name = EVIL;
  data.study.question = EVIL;
  data.notes = [EVIL, 'long'.repeat(80)];
  data.provenance.forEach(p => (p.value = spoil(p.value)));
  data.study.settings.forEach(p => {
    p.value = spoil(p.value);
    p.label = spoil(p.label);
  });
  data.axes.forEach(a => (a.label = spoil(a.label)));
  data.measures.forEach(m => (m.label = spoil(m.label)));
  data.cards.forEach(c => {
    c.where = spoil(c.where);
    c.axes = spoil(c.axes);
    c.label = spoil(c.label);
  });
  data.failures.forEach(f => (f.reason = spoil(f.reason)));
  data.marks.forEach(m => (m.label = spoil(m.label)));
  data.rows.columns.forEach(c => (c.label = spoil(c.label)));
  data.rows.reason.words = data.rows.reason.words.map(spoil);
  data.rows.columns[0].data.words = data.rows.columns[0].data.words.map(spoil);
  data.axes[0].values = data.axes[0].values.map(spoil);
  data.histories.forEach(h => (h.axes = spoil(h.axes)));
  data.modes.forEach(m => {
    m.label = spoil(m.label);
    m.list.forEach(x => (x.shape = spoil(x.shape)));
  });
  data.verdicts.lines.forEach(l => {
    l.statement = spoil(l.statement);
    l.note = spoil(l.note);
  });
  data.verdicts.source = EVIL;
  data.classes = {
    names: [EVIL, 'gap'],
    heads: [EVIL],
    rows: [{ names: [EVIL, EVIL], cells: [{ job: 3, utilisation: 0.5, limit: EVIL, place: 2 }] }],
  };
  data.exceedance = [{ limit: EVIL, exceeded: 1, jobs: 9, failed: 0, share: 1 / 9, interval: [0.0028, 0.4825] }];
  return data;
}

/** Results of a study that the program cannot read any more: no bridge, nothing that was solved again. */
export function unread() {
  const data = crossing();
  data.notes = ['This program cannot read the study any more: crossings and shapes are left out.'];
  return {
    ...data,
    bridge: null,
    study: { ...data.study, settings: [] },
    plays: [],
    modes: [],
    marks: data.marks.filter(m => m.chart !== 'history'),
  };
}

/** A run that is not done. */
export function half() {
  const data = crossing();
  data.jobs = { total: 42, ok: 20, failed: 1, missing: 21 };
  data.notes = [
    '21 of 42 jobs are missing: the run is not done. `pontoon run` goes on with it.',
    'The tables are not written yet: this page is made from the journal.',
  ];
  return { ...data, verdicts: null, histories: [], modes: [] };
}

/** The samples of which every part of a page is seen once: what holds for each page is held on them. */
export const EACH_KIND = [
  'crossing',
  'still',
  'natural',
  'allFailed',
  'oneJob',
  'half',
  'markup',
  'classes',
  'drawn',
  'rating',
];

export const samples = {
  crossing,
  big,
  wide,
  still,
  natural,
  allFailed,
  oneJob,
  oneAxis,
  markup,
  half,
  unread,
  classes,
  drawn,
  rating,
};
