// Elements. All text goes in as text: nothing here, or anywhere on the page, parses markup that came with the data.
(page => {
  'use strict';
  const SVG = 'http://www.w3.org/2000/svg';

  function fill(node, attributes, children) {
    for (const [name, value] of Object.entries(attributes ?? {})) {
      if (value === null || value === undefined || value === false) continue;
      if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
      else if (name === 'value' || name === 'checked') node[name] = value;
      else node.setAttribute(name, value === true ? '' : value);
    }
    node.append(...children.flat(Infinity).filter(child => child !== null && child !== undefined && child !== false));
    return node;
  }
  const el = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);
  const svg = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

  let serial = 0;
  const id = stem => `${stem}-${++serial}`;

  /** A labelled field: the label above what it labels. */
  function field(label, control, extra) {
    control.id ||= id('control');
    return el('div', { class: 'field' }, el('label', { for: control.id }, label), control, extra);
  }

  /** A select of [value, text] pairs. */
  function select(pairs, value, onchange) {
    const node = el(
      'select',
      { onchange: () => onchange(node.value) },
      pairs.map(([v, text]) => el('option', { value: v }, text)),
    );
    node.value = value;
    return node;
  }

  const button = (text, onclick, attributes) => el('button', { type: 'button', onclick, ...attributes }, text);

  /** A section with its heading, for the table of contents. */
  function section(key, title, ...children) {
    return el(
      'section',
      { id: key, 'aria-labelledby': `${key}-title` },
      el('h2', { id: `${key}-title` }, title),
      children,
    );
  }

  /** A box that scrolls by itself and can be reached with the keyboard. */
  const scroller = (label, ...children) =>
    el('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': label }, children);

  const motionless = matchMedia('(prefers-reduced-motion: reduce)');
  /** Calls `draw(ms since the last)` before each frame while it is running. */
  function animation(draw) {
    let handle = null,
      last = null;
    const tick = now => {
      handle = requestAnimationFrame(tick);
      draw(last === null ? 0 : now - last);
      last = now;
    };
    return {
      get running() {
        return handle !== null;
      },
      start() {
        if (handle === null) {
          last = null;
          handle = requestAnimationFrame(tick);
        }
      },
      stop() {
        if (handle !== null) cancelAnimationFrame(handle);
        handle = null;
      },
    };
  }

  // What must stand still on paper registers here, and what is drawn takes paper's width there; see 95-main.js.
  page.paper = [];
  page.paperWidth = null;
  const room = node => (node.clientWidth ? (page.paperWidth ?? node.clientWidth) : 0);
  /** Calls `act` in the frame after a node has changed its size: a size changed while sizes are told is an error of the page. */
  const resized = (node, act) => new ResizeObserver(() => requestAnimationFrame(act)).observe(node);

  page.dom = { el, svg, id, field, select, button, section, scroller, animation, motionless, room, resized };
})((globalThis.pontoon ??= {}));
