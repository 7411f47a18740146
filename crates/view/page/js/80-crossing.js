// The crossing of the picked job: time, buttons and words around the drawing of 78-bridge.js.
(page => {
  'use strict';
  const { data, numbers, array } = page,
    { el, field, select, button, animation, motionless } = page.dom;
  const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4],
    SCALES = [0.001, 0.01, 0.1, 1, 2, 5, 10, 20, 50, 100, 200, 500];

  /** The frame in which the bridge is deepest. */
  function peakFrame(play) {
    const w = array(play.deflection_m),
      width = (play.bridge ?? data.bridge).position_x_m.length;
    let best = 0;
    for (let i = 0; i < w.length; i++) if (w[i] > w[best]) best = i;
    return Math.floor(best / width);
  }

  /** The rated value of a row in words, where it has one. */
  function ratedOf(row) {
    const column = data.rows.columns.find(c => c.name === 'rated_value'),
      value = column ? page.cell(column, row) : null;
    return value === null ? [] : [`${column.label} ${numbers.quantity(value, column.unit)}`];
  }

  function crossing() {
    const plays = data.plays ?? [],
      rating = data.study.kind === 'rating';
    if (data.study.kind !== 'crossing' && !rating) return null;
    const title = el('h3', { id: 'crossing-title' }, 'Crossing'),
      axes = el('p', { class: 'sub' }),
      why = el('p', { class: 'empty', role: 'status' });
    const stage = el('div', { class: 'stage' }),
      readout = el('dl', { class: 'live', 'aria-live': 'polite', id: 'crossing-readout' });
    const run = button('Play', () => (motion.running ? pause() : start()), { class: 'primary', id: 'play' });
    const scrub = el('input', {
      type: 'range',
      id: 'scrub',
      min: 0,
      step: 1,
      oninput: () => {
        pause();
        show(Number(scrub.value));
      },
    });
    const speed = select(
      SPEEDS.map(s => [String(s), s === 1 ? 'as it is' : `${s} times`]),
      '1',
      () => {},
    );
    const scale = select(
      SCALES.map(s => [String(s), `${s} times`]),
      '20',
      () => {
        scene?.rebuild(Number(scale.value));
        show(frame);
      },
    );
    speed.id = 'play-speed';
    scale.id = 'play-scale';
    const choose = select(
      [['', 'choose'], ...plays.map(p => [String(p.job), `job ${p.job}`])],
      '',
      v => v !== '' && page.pick(Number(v), 'list'),
    );
    choose.id = 'play-job';
    const scrubField = field('Time', scrub);
    scrubField.classList.add('wide');
    const controls = el(
      'div',
      { class: 'controls player' },
      el(
        'div',
        { class: 'buttons' },
        run,
        button('\u2039 Back', () => step(-1), { title: 'one frame back', id: 'step-back' }),
        button('On \u203a', () => step(1), { title: 'one frame on', id: 'step-on' }),
      ),
      scrubField,
      field('Speed', speed),
      field('Exaggeration', scale),
    );
    const body = el('div', {}, stage, readout, controls);
    const node = el(
      'div',
      { class: 'crossing', role: 'group', 'aria-labelledby': 'crossing-title' },
      el('div', { class: 'between' }, title, plays.length > 0 && field('Crossings on this page', choose)),
      axes,
      why,
      body,
    );

    let play = null,
      scene = null,
      frame = 0,
      peak = 0,
      time = null,
      kept = 0;
    const motion = animation(passed => {
      const last = play.frames - 1,
        now = at(frame) + (passed / 1000) * Number(speed.value);
      if (now >= time[last]) {
        show(last);
        pause();
        return;
      }
      let i = Math.floor(frame);
      while (i < last - 1 && time[i + 1] <= now) i++;
      show(i + (now - time[i]) / (time[i + 1] - time[i]));
    });
    const at = f => {
      const i = Math.min(play.frames - 1, Math.floor(f)),
        j = Math.min(play.frames - 1, i + 1);
      return time[i] + (f - i) * (time[j] - time[i]);
    };

    function start() {
      if (!play || play.frames < 2) return;
      if (frame >= play.frames - 1) frame = 0;
      readout.setAttribute('aria-live', 'off');
      motion.start();
      run.textContent = 'Pause';
    }
    function pause() {
      motion.stop();
      readout.setAttribute('aria-live', 'polite');
      run.textContent = 'Play';
    }
    function step(by) {
      pause();
      if (play) show(Math.min(play.frames - 1, Math.max(0, (by > 0 ? Math.floor(frame) : Math.ceil(frame)) + by)));
    }

    function show(f) {
      frame = f;
      if (!play || !scene) return;
      const said = scene.draw(f, at(f));
      scrub.value = Math.floor(f);
      scrub.setAttribute('aria-valuetext', `${numbers.digits(at(f), 3)} s`);
      [...readout.querySelectorAll('dd')].forEach((dd, i) => (dd.textContent = said[i]));
    }

    function load(job, by) {
      pause();
      play = plays.find(p => p.job === job) ?? null;
      const row = page.rowOf(job);
      title.textContent = `Crossing of job ${job}${rating && play ? ' at its rated value' : ''}`;
      choose.value = play ? String(job) : '';
      axes.textContent =
        row < 0
          ? ''
          : data.axes
              .map((axis, i) => [axis, i, data.rows.columns.find(c => c.name === axis.name)])
              .filter(([, , c]) => c && page.cell(c, row) !== null)
              .map(([axis, i, c]) => {
                const v = page.cell(c, row),
                  u = page.axes.shown(i);
                return `${axis.label} ${typeof v === 'number' ? numbers.plain(v * u.factor) + (u.unit && numbers.THIN + u.unit) : v}`;
              })
              .concat(ratedOf(row))
              .join(', ');
      body.hidden = !play;
      why.hidden = !!play;
      if (!play) {
        const reason =
          row >= 0 && !array(data.rows.ok)[row]
            ? `Job ${job} failed: ${page.reason(row) ?? 'no reason is known'}.`
            : row < 0
              ? `Job ${job} is not among the rows of this page.`
              : `This page carries the motion of ${plays.length} ${plays.length === 1 ? 'job' : 'jobs'}; that of job ${job} is not among them.`;
        why.textContent = `No crossing to play. ${reason}`;
        scene = null;
        return;
      }
      time = array(play.time_s);
      peak = peakFrame(play);
      scrub.max = play.frames - 1;
      const deepest = array(play.deflection_m).reduce((a, v) => Math.max(a, Math.abs(v)), 0),
        length = (play.bridge ?? data.bridge).position_x_m.at(-1) || 1;
      if (deepest > 0)
        scale.value = String(
          SCALES.filter(s => s * deepest <= Math.max(0.1 * length, (70 * length) / (stage.clientWidth || 800))).at(
            -1,
          ) ?? SCALES[0],
        );
      scene = page.bridgeScene(play, stage, Number(scale.value));
      readout.replaceChildren(...scene.names.flatMap(name => el('div', {}, el('dt', {}, name), el('dd'))));
      const alive = by !== 'start' && !motionless.matches;
      show(alive ? 0 : peak);
      if (alive) start();
    }

    if (!plays.length) {
      why.textContent = 'No job of this page has a crossing to play.';
      body.hidden = true;
    }
    page.onPick(load);
    const rescale = () => {
      if (scene?.resized()) {
        scene.rebuild(Number(scale.value));
        show(frame);
      }
    };
    page.dom.resized(stage, rescale);
    document.addEventListener('visibilitychange', () => document.hidden && pause());
    page.paper.push({
      freeze() {
        kept = frame;
        pause();
        rescale();
        if (play) show(peak);
      },
      thaw() {
        rescale();
        if (play) show(kept);
      },
    });
    return { node };
  }

  page.crossing = crossing;
})((globalThis.pontoon ??= {}));
