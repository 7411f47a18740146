//! Two rigid modules on water: equilibrium at the joint and the frequencies of the floating pair, by hand.
//!
//! Sketch: two rigid modules of length L, mass mu and water k a metre, hinged at the bottom, a connector of K_c in all d above
//! the hinge. Held at the outer ends, the joint sinks by w under P there: the water gives `2 k L/3 w` (twice the third of a
//! triangle), the connector shortens by `g w`, `g = 2 d/L`:
//! open `w = P / (2 k L/3)` while `g w` is below the gap, else `w = (P + g K_c gap) / (2 k L/3 + g^2 K_c)` and
//! `N = -K_c (g w - gap)`.
//!
//! Floating free, the motion is `w + theta_1 s` and `w + theta_2 s`. Water and mass are alike along the pair, so that heave and
//! pitch have `omega^2 = k/mu`. The fold `theta_2 = -theta_1 = theta` that is orthogonal to heave, `w = -theta L/2`, has a mass
//! of `2 mu (L^3/3 - L^3/4) = mu L^3/6` and stretches the linear connector by `2 d theta`:
//! `omega^2 = k/mu + 24 d^2 K_c / (mu L^3)`.
//!
//! L = 6.7 m, d = 1.07 m, mu = 1013 + 11,135 kg/m, k = 60.5 kN/m^2, K_c = 47.4 MN/m a sense, gap 5.5 mm.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::Model;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;
use std::f64::consts::PI;

/// EI of the modules `[N m^2]`; stiffer ones lose the water in the rounding of K.
const EI: f64 = 1e14;

#[derive(Debug, Clone, Copy)]
struct Pair {
    length_m: f64,
    depth_m: f64,
    mass_kg_m: f64,
    added_mass_kg_m: f64,
    water_n_m2: f64,
    connectors_n_m: f64,
    gap_m: f64,
}

const PAIR: Pair = Pair {
    length_m: 6.7,
    depth_m: 1.07,
    mass_kg_m: 1013.0,
    added_mass_kg_m: 11_135.0,
    water_n_m2: 60_500.0,
    connectors_n_m: 4.74e7,
    gap_m: 0.0055,
};

impl Pair {
    /// Deflection of the joint `[m]` and force of its connectors `[N]` under a load there.
    fn statics(&self, load_n: f64) -> [f64; 2] {
        let (water, g) = (
            2.0 * self.water_n_m2 * self.length_m / 3.0,
            2.0 * self.depth_m / self.length_m,
        );
        let open = load_n / water;
        if g * open < self.gap_m {
            return [open, 0.0];
        }
        // with what the modules bend under N d at their ends: 1.3e-6 of the deflection
        let k = 1.0 / (1.0 / self.connectors_n_m + 2.0 * self.depth_m.powi(2) * self.length_m / (3.0 * EI));
        let w = (load_n + g * k * self.gap_m) / (water + g * g * k);
        [w, -k * (g * w - self.gap_m)]
    }

    /// Heave, pitch and fold with the linear connection, both senses at work `[Hz]`.
    fn frequencies_hz(&self) -> [f64; 3] {
        let mu = self.mass_kg_m + self.added_mass_kg_m;
        let floating = self.water_n_m2 / mu;
        let fold = floating + 24.0 * self.depth_m.powi(2) * 2.0 * self.connectors_n_m / (mu * self.length_m.powi(3));
        [floating, floating, fold].map(|lambda| lambda.sqrt() / (2.0 * PI))
    }

    fn ready(&self) -> (BeamModule, Ready) {
        let mut module = BeamModule::slender(self.length_m, 2, EI, self.mass_kg_m, 1.0);
        module.depth_m = self.depth_m;
        let d = module.design(2, self.water_n_m2, self.added_mass_kg_m, 0.5 * self.connectors_n_m);
        let ready = module.ready(&d, Model::Full);
        (module, ready)
    }
}

/// A coefficient of the pair, changed.
type Change = (&'static str, fn(&mut Pair));

const CHANGES: [Change; 4] = [
    ("p_b", |p| p.water_n_m2 *= 1.05),
    ("hinge offset", |p| p.depth_m *= 1.05),
    ("connector", |p| p.connectors_n_m *= 1.05),
    ("gap", |p| p.gap_m *= 1.05),
];

fn changed(change: fn(&mut Pair)) -> Pair {
    let mut pair = PAIR;
    change(&mut pair);
    pair
}

/// 4 kN leave the gap open (14.8 mm and 4.7 mm of it), 100 kN close it. 1e-6: K's rounding, 3e-7; what the modules bend is
/// reckoned with. Twins: p_b open; p_b, hinge offset, connector and gap closed.
#[test]
fn joint_sinks_as_by_hand() {
    let (module, ready) = PAIR.ready();
    let solver = ready.statics(&module.axle(0.0, 1, Inertia::None));
    let engine = |load_n: f64| {
        let case = ready.case(gaps(0.02, PAIR.gap_m), load_n, PAIR.length_m);
        let r = solver.solve(&case).expect("solved");
        [r.deflection_m[1], r.joints[0].sum_n]
    };
    let open = engine(4e3);
    let off = |pair: Pair| miss(open[0], pair.statics(4e3)[0]);
    held("open, p_b", 1e-6, off(PAIR), off(changed(CHANGES[0].1)));
    assert!(
        open[1] == 0.0 && PAIR.statics(4e3)[1] == 0.0,
        "an open gap carries nothing"
    );
    let closed = engine(1e5);
    let off = |pair: Pair, n: usize| miss(closed[n], pair.statics(1e5)[n]);
    for (name, change) in CHANGES {
        held(
            &format!("closed, deflection, {name}"),
            1e-6,
            off(PAIR, 0),
            off(changed(change), 0),
        );
        held(
            &format!("closed, force, {name}"),
            1e-6,
            off(PAIR, 1),
            off(changed(change), 1),
        );
    }
}

/// Heave, pitch and the fold of the free pair, by their names. 5e-6: modules of this EI bend under the connector, 3e-6 of the
/// fold (ten times as much with a tenth of it). Twins: p_b, m_a, mass; of the fold also hinge offset and connector.
#[test]
fn floating_pair_sounds_as_by_hand() {
    let modes = PAIR.ready().1.modes(9);
    // of one frequency, so that any mixture of the two is a mode and may have either name
    let rigid: Vec<f64> = modes
        .iter()
        .filter(|m| ["heave", "pitch"].contains(&m.name.as_str()))
        .map(|m| m.frequency_hz)
        .collect();
    assert_eq!(rigid.len(), 2, "heave and pitch");
    let found = [rigid[0], rigid[1], frequency_hz(&modes, "vertical bending 1")];
    let masses: [Change; 2] = [
        ("m_a", |p| p.added_mass_kg_m *= 1.05),
        ("mass", |p| p.mass_kg_m *= 1.05),
    ];
    for (n, of) in ["heave", "pitch", "fold"].iter().enumerate() {
        let off = |pair: Pair| miss(found[n], pair.frequencies_hz()[n]);
        for (name, change) in CHANGES.into_iter().take(if n == 2 { 3 } else { 1 }).chain(masses) {
            held(&format!("{of}, {name}"), 5e-6, off(PAIR), off(changed(change)));
        }
    }
}
