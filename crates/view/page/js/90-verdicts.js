// What the comparison with a reference found, and where the numbers come from.
(page => {
  'use strict';
  const { data } = page,
    { el, section, field, select, scroller } = page.dom;
  const ROLES = [
    ['hold', 'Must hold'],
    ['expected-fail', 'Known to fall short'],
    ['record', 'Recorded only'],
  ];
  const COLUMNS = [
    ['statement', 'statement'],
    ['word', 'verdict'],
    ['expected', 'expected'],
    ['found', 'found'],
    ['deviation', 'deviation'],
    ['margin', 'margin'],
    ['note', 'note'],
  ];

  /** The sign of a line's tone: the word says it too, not the colour alone. */
  const SIGN = { good: '\u2713', bad: '\u2717', plain: '\u2022' };

  function verdicts() {
    const { verdicts: v } = data;
    if (!v) return null;
    const used = COLUMNS.filter(([key]) => key === 'statement' || key === 'word' || v.lines.some(line => line[key]));
    const bad = v.lines.filter(line => line.tone === 'bad').length,
      kinds = [...new Map(v.lines.map(line => [line.verdict, line.word]))];
    const table = el(
      'table',
      { class: 'rows verdicts' },
      el('caption', { class: 'unseen' }, 'Verdicts of the comparison'),
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          used.map(([, title]) => el('th', { scope: 'col' }, title)),
        ),
      ),
    );
    const said = el('p', { class: 'count', role: 'status' });

    function draw(filter) {
      table.querySelectorAll('tbody').forEach(body => body.remove());
      const lines = v.lines.filter(line => filter === '' || line.verdict === filter);
      const roles = [
        ...ROLES,
        ...[...new Set(lines.map(l => l.role))].filter(r => !ROLES.some(([k]) => k === r)).map(r => [r, r]),
      ];
      for (const [role, title] of roles) {
        const group = lines.filter(line => line.role === role);
        if (!group.length) continue;
        table.append(
          el(
            'tbody',
            { 'data-role': role },
            el(
              'tr',
              { class: 'group' },
              el('th', { scope: 'rowgroup', colspan: used.length }, `${title} (${group.length})`),
            ),
            group.map(line =>
              el(
                'tr',
                { 'data-id': line.id },
                used.map(([key], i) =>
                  el(
                    i ? 'td' : 'th',
                    { scope: i ? null : 'row', class: key === 'word' ? `verdict ${line.tone}` : null },
                    key === 'word' && el('span', { class: 'sign', 'aria-hidden': 'true' }, SIGN[line.tone]),
                    i
                      ? (line[key] ?? '')
                      : [line.statement || line.id, line.statement && el('span', { class: 'id' }, line.id)],
                  ),
                ),
              ),
            ),
          ),
        );
      }
      said.textContent = lines.length ? `${lines.length} of ${v.lines.length} checks` : 'No check is of this kind.';
    }
    const show = select([['', 'all'], ...kinds], '', draw);
    show.id = 'verdict-filter';
    draw('');
    return section(
      'verdicts',
      'Comparison with the reference',
      el('p', { class: 'sub' }, v.source),
      el(
        'p',
        { class: `lead ${v.good ? 'good' : 'bad'}` },
        (v.good
          ? 'Nothing falls short that should hold'
          : `${bad} ${bad === 1 ? 'check is' : 'checks are'} not as it should be`) + (v.tally ? `: ${v.tally}.` : '.'),
      ),
      el('div', { class: 'controls' }, field('Show', show), said),
      scroller('Verdicts of the comparison', table),
    );
  }

  function provenance() {
    const { version, commit } = data.program,
      list = [...(data.provenance ?? [])];
    if (!list.some(p => /^program$/i.test(p.label)))
      list.unshift({ label: 'program', value: `pontoon ${version}${commit ? ` (${commit})` : ''}` });
    return section(
      'provenance',
      'Provenance',
      el(
        'dl',
        { class: 'pairs' },
        list.map(p => el('div', {}, el('dt', {}, p.label), el('dd', { class: 'mono' }, p.value))),
      ),
    );
  }

  page.verdicts = verdicts;
  page.provenance = provenance;
})((globalThis.pontoon ??= {}));
