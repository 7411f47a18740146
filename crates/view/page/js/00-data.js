// The embedded data: parses it, unpacks its arrays when they are asked for. Knows the contract; draws nothing.
(page => {
  'use strict';
  const WIDTH = {
    u8: [Uint8Array, 1],
    u16: [Uint16Array, 2],
    i16: [Int16Array, 2],
    u32: [Uint32Array, 4],
    f32: [Float32Array, 4],
  };
  const NONE = { u16: 65535, u32: 4294967295 };
  const unpacked = new WeakMap();

  function bytes(text) {
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
    const raw = atob(text),
      out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return out;
  }

  /** A packed array as a typed one; what is not packed comes back as it is. Unpacked once. */
  function array(packed) {
    if (!packed || Array.isArray(packed)) return packed ?? [];
    if (unpacked.has(packed)) return unpacked.get(packed);
    const kind = Object.keys(WIDTH).find(key => key in packed);
    const [Type, width] = WIDTH[kind],
      raw = bytes(packed[kind]);
    let out = new Type(raw.buffer, raw.byteOffset, raw.byteLength / width);
    if ('scale' in packed) out = Float64Array.from(out, v => v * packed.scale);
    unpacked.set(packed, out);
    return out;
  }

  /** Row `at` of a row-major matrix of `width` columns. */
  const row = (packed, at, width) => array(packed).subarray(at * width, (at + 1) * width);

  page.data = JSON.parse(document.getElementById('data').textContent);
  page.array = array;
  page.row = row;
  page.NONE = NONE;

  /** The value of a rows' column at a row: a number, a word, or null. */
  page.cell = (column, at) => {
    if (column.data.words) {
      const index = array(column.data.index)[at];
      return index === NONE.u16 ? null : column.data.words[index];
    }
    const value = array(column.data)[at];
    return Number.isNaN(value) ? null : value;
  };

  /** Why row `at` failed, or null. */
  page.reason = at => {
    const { words, index } = page.data.rows.reason;
    return array(index)[at] === NONE.u16 ? null : (words[array(index)[at]] ?? null);
  };

  let places;
  /** The row of a job on this page, or -1. */
  page.rowOf = job => {
    places ??= new Map(Array.from(array(page.data.rows.job), (number, at) => [number, at]));
    return places.get(job) ?? -1;
  };

  // The picked job: one for the whole page.
  const listeners = [];
  page.picked = null;
  page.onPick = listener => void listeners.push(listener);
  page.pick = (job, by) => {
    page.picked = job;
    listeners.forEach(listener => listener(job, by));
  };
})((globalThis.pontoon ??= {}));
