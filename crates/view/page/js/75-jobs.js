// The job browser: the rows that this page carries, and above them the crossing of the one that is picked.
(page => {
  'use strict';
  const { data, numbers, array } = page,
    { el, section } = page.dom;

  function columns() {
    const rows = data.rows,
      all = array(rows.job),
      ok = array(rows.ok),
      inputs = new Set(data.axes.map(a => a.name));
    const list = [
      {
        name: 'job',
        label: 'job',
        unit: '',
        kind: 'number',
        input: true,
        value: row => all[row],
        write: row => String(all[row]),
      },
    ];
    if (data.jobs.failed)
      list.push({
        name: 'status',
        label: 'status',
        unit: '',
        kind: 'word',
        value: row => (ok[row] ? 'ok' : 'failed'),
        write: row => (ok[row] ? 'ok' : 'failed'),
        bad: row => !ok[row],
      });
    for (const c of rows.columns) {
      if (c.kind === 'word') {
        list.push({
          name: c.name,
          label: c.label,
          unit: '',
          kind: 'word',
          value: row => page.cell(c, row),
          write: row => page.cell(c, row) ?? '\u2013',
        });
        continue;
      }
      const values = array(c.data),
        style = numbers.column(
          Array.from(values).filter(v => !Number.isNaN(v)),
          c.unit,
        ),
        input = inputs.has(c.name);
      const value = row => (Number.isNaN(values[row]) ? null : values[row]);
      list.push({
        name: c.name,
        label: c.label,
        unit: style.unit,
        kind: 'number',
        input,
        value,
        write: row =>
          value(row) === null ? '\u2013' : input ? numbers.plain(value(row) * style.factor) : style.write(value(row)),
        title: `${c.name}: sort`,
      });
    }
    if (array(rows.ok).some(v => !v))
      list.push({
        name: 'reason',
        label: 'reason',
        unit: '',
        kind: 'word',
        value: row => page.reason(row),
        write: row => page.reason(row) ?? '',
      });
    return list;
  }

  function jobs() {
    if (!data.rows?.count) return null;
    const list = columns(),
      numeric = list.find(c => c.name === 'speed_m_s') ?? list.find(c => c.kind === 'number' && c.name !== 'job');
    const numbersOf = array(data.rows.job);
    const table = page.table('Jobs', data.rows.count, list, {
      pick: data.study.kind === 'modes' ? null : row => page.pick(numbersOf[row], 'table'),
      placeholder: numeric ? `words, or ${numeric.name}>10` : 'words',
    });
    const view = page.crossing();
    page.onPick((job, by) => {
      table.mark(page.rowOf(job), by !== 'table');
      if (by === 'chart' || by === 'card' || by === 'cell')
        node.scrollIntoView({ behavior: page.dom.motionless.matches ? 'auto' : 'smooth', block: 'start' });
      else if (by === 'table' && view && view.node.getBoundingClientRect().top < 0)
        view.node.scrollIntoView({ block: 'start' });
    });
    const names = el(
      'details',
      { class: 'help' },
      el('summary', {}, 'How to filter'),
      el(
        'p',
        {},
        'Words must be in the row; conditions compare a column: ',
        el('code', {}, numeric ? `${numeric.name}>10` : 'job<10'),
        ', with <, >, <=, >=, = or !=. Units may follow a number (',
        el('code', {}, '28mm'),
        ', ',
        el('code', {}, '200kN'),
        '), else it is in m, s, N. All must hold. Columns: ',
        list.map((c, i) => [i ? ', ' : '', el('code', {}, c.name)]),
        '.',
      ),
    );
    const node = section(
      'jobs',
      'Job browser',
      el(
        'p',
        { class: 'sub' },
        `The table holds ${data.rows.note}.`,
        {
          crossing: ' Pick a job to see its crossing.',
          rating: ' Pick a job to see its crossing at the rated value.',
          static: ' Pick a job to see its line above.',
        }[data.study.kind],
      ),
      view?.node,
      table.node,
      names,
    );
    return node;
  }

  /** The frequencies of a modes study, a row a mode. */
  function frequencies() {
    const list = data.mode_table ?? [];
    if (!list.length) return null;
    const word = (name, label) => ({
      name,
      label,
      unit: '',
      kind: 'word',
      value: r => list[r][name],
      write: r => list[r][name] ?? '\u2013',
    });
    const integer = (name, label) => ({
      name,
      label,
      unit: '',
      kind: 'number',
      input: true,
      value: r => list[r][name],
      write: r => String(list[r][name]),
    });
    const table = page.table(
      'Frequencies of the jobs',
      list.length,
      [
        integer('job', 'job'),
        word('axes', 'bridge'),
        integer('number', 'mode'),
        {
          name: 'frequency_hz',
          label: 'frequency',
          unit: 'Hz',
          kind: 'number',
          value: r => list[r].frequency_hz,
          write: r => list[r].frequency_hz.toFixed(4),
        },
        word('shape', 'shape'),
      ],
      { size: 25, placeholder: 'words, or frequency_hz<1' },
    );
    return section('frequencies', 'Natural frequencies', table.node);
  }

  page.jobs = jobs;
  page.frequencies = frequencies;
})((globalThis.pontoon ??= {}));
