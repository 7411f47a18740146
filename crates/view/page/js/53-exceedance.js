// How often limits are exceeded where the points of a study were drawn at random: counts, shares and their intervals.
(page => {
  'use strict';
  const { data, numbers, limits } = page,
    { el, svg, section, scroller } = page.dom;
  const WIDTH = 180,
    HEIGHT = 16,
    EDGE = 6;

  const percent = share => numbers.digits(100 * share, 3);

  /** The interval as a bar and the share as a dot, on a scale from nothing to `most`. */
  function bar({ share, interval: [low, high] }, most) {
    const x = v => EDGE + ((WIDTH - 2 * EDGE) * v) / most,
      middle = HEIGHT / 2;
    return svg(
      'svg',
      {
        class: 'interval',
        width: WIDTH,
        height: HEIGHT,
        viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
        'aria-hidden': 'true',
      },
      svg('line', { class: 'track', x1: x(0), x2: x(most), y1: middle, y2: middle }),
      svg('rect', { class: 'band', x: x(low), width: x(high) - x(low), y: middle - 4, height: 8 }),
      svg('circle', { class: 'share', cx: x(share), cy: middle, r: 4 }),
    );
  }

  function exceedance() {
    const list = data.exceedance ?? [];
    if (!list.length) return null;
    const most = Math.min(
        1,
        d3
          .scaleLinear([0, Math.max(...list.map(e => e.interval[1]))], [0, 1])
          .nice(4)
          .domain()[1],
      ),
      failed = list.some(e => e.failed);
    const heads = [
      'limit',
      'exceeded',
      'share',
      '95 % interval',
      `0 to ${numbers.plain(100 * most)} %`,
      failed && 'failed',
    ];
    return section(
      'exceedance',
      'How often limits are exceeded',
      el(
        'p',
        { class: 'sub' },
        'The points of the study were drawn at random. The share of jobs that exceed a limit estimates how often it is exceeded. ',
        'The interval holds the true share with 95 % confidence (Clopper and Pearson).',
        failed && ' Failed jobs do not count: nothing is known of them.',
      ),
      scroller(
        'How often limits are exceeded, table',
        el(
          'table',
          { class: 'plain exceedance' },
          el('caption', { class: 'unseen' }, 'How often limits are exceeded'),
          el(
            'thead',
            {},
            el(
              'tr',
              {},
              heads
                .filter(Boolean)
                .map((head, i) => el('th', { scope: 'col', class: i && i !== 4 ? 'number' : null }, head)),
            ),
          ),
          el(
            'tbody',
            {},
            list.map(e =>
              el(
                'tr',
                { 'data-limit': e.limit },
                el('th', { scope: 'row' }, limits.name(e.limit)),
                el('td', { class: 'number' }, `${numbers.count(e.exceeded)} of ${numbers.count(e.jobs)} jobs`),
                el('td', { class: 'number' }, `${percent(e.share)}${numbers.THIN}%`),
                el('td', { class: 'number' }, `${percent(e.interval[0])} to ${percent(e.interval[1])}${numbers.THIN}%`),
                el('td', {}, bar(e, most)),
                failed && el('td', { class: 'number' }, numbers.count(e.failed)),
              ),
            ),
          ),
        ),
      ),
    );
  }

  page.exceedance = exceedance;
})((globalThis.pontoon ??= {}));
