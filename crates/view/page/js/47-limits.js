// Limits in words: what is bounded, and what its place is the number of. Knows the words of limits; draws nothing.
(page => {
  'use strict';
  const LIMITS = {
    edge_sinkage_m: ['edge sinkage', 'position'],
    uplift_m: ['uplift', 'position'],
    joint_compression_n: ['joint compression', 'joint'],
    joint_tension_n: ['joint tension', 'joint'],
    connector_compression_n: ['connector compression', 'joint'],
    connector_tension_n: ['connector tension', 'joint'],
    pin_force_n: ['pin force', 'joint'],
    joint_angle_rad: ['joint angle', 'joint'],
    roll_rad: ['roll', 'position'],
    trim_rad: ['trim', 'module'],
    axle_contact_n: ['axle contact', 'axle'],
  };
  const of = limit => LIMITS[limit] ?? [limit.replaceAll('_', ' '), 'place'];

  /** A limit in full. */
  const name = limit => of(limit)[0];

  /** A limit and where it governs. What the place says is not said twice: "compression, joint 15". */
  function where(limit, place) {
    const [words, of_what] = of(limit);
    if (place === null || place === undefined) return words;
    const short = words.startsWith(`${of_what} `) ? words.slice(of_what.length + 1) : words;
    return `${short}, ${of_what} ${place}`;
  }

  page.limits = { name, where };
})((globalThis.pontoon ??= {}));
