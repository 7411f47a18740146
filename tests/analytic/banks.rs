//! Bridges on one-sided banks: a beam on water and a rigid raft by hand, and a stiff bank that hammers.
//!
//! Sketch: a half-endless beam EI on k a metre with its free end at x = 0, P at x = a, `beta = (k / 4EI)^(1/4)`. The end sinks by
//! `w_free = (2 P beta / k) e^(-beta a) cos(beta a)` and by `2 beta / k` for each newton on itself (M. Hetenyi: Beams on Elastic
//! Foundation, University of Michigan Press, 1946, ch. II). A bank of stiffness k_b there, g below the bridge, pushes up with
//! `N = (w_free - g) / (1/k_b + 2 beta / k)` where that is positive; at g = 0 it lets go at `a = pi / 2 beta`. A cable of slack g that
//! holds the end down pulls with `N = (-w_free - g) / (1/k_b + 2 beta / k)` where that is positive.
//!
//! A rigid raft of length L on k a metre, P and the bank at its left end: its middle rises by w0 and its right end by `theta L/2`
//! more, `[k L + k_b, -k_b L/2; -k_b L/2, k L^3/12 + k_b L^2/4] [w0; theta] = [-P; P L/2]`.
//!
//! EI = 2.4e9 N m^2, k = 60.5 kN/m^2, beta = 0.0501 1/m, P = 230.3 kN, k_b = 10 MN/m: the chain of `tests/data/chain.json` without
//! joints. 200 m of beam, 10/beta: what its right end sends back is e^-18.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::statics::{DeadCase, StaticSolver};
use pontoon_core::bridge::{BankPlace, BankSpec, BridgeEnd, Direction, Model, Supports, Toward};
use pontoon_core::connector::Connection;
use pontoon_core::response::StaticResponse;
use pontoon_core::vehicle::Inertia;
use pontoon_plan::input::Document;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::chain_answer::answer;
use pontoon_tests::chain_scenario::ChainScenario;
use pontoon_tests::*;
use serde_json::json;
use std::array::from_fn;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

/// A beam on water with something that stands at its left end.
#[derive(Debug, Clone, Copy)]
struct OnBank {
    length_m: f64,
    ei_n_m2: f64,
    water_n_m2: f64,
    bank_n_m: f64,
    clearance_m: f64,
    toward: Toward,
}

const BEAM: OnBank = OnBank {
    length_m: 200.0,
    ei_n_m2: 2.4e9,
    water_n_m2: 60_500.0,
    bank_n_m: 1e7,
    clearance_m: 0.0,
    toward: Toward::Plus,
};

const LOAD_N: f64 = PAPER_LOAD_N;

/// A coefficient, changed.
type Change = (&'static str, fn(&mut OnBank));

const CHANGES: [Change; 4] = [
    ("p_b", |b| b.water_n_m2 *= 1.05),
    ("E", |b| b.ei_n_m2 *= 1.05),
    ("bank", |b| b.bank_n_m *= 1.05),
    ("clearance", |b| b.clearance_m *= 1.05),
];

impl OnBank {
    fn changed(mut self, change: fn(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    fn beta(&self) -> f64 {
        (self.water_n_m2 / (4.0 * self.ei_n_m2)).powf(0.25)
    }

    /// How far the end of the half-endless beam would sink under P at a distance `[m]`.
    fn free_m(&self, a_m: f64) -> f64 {
        let s = self.beta() * a_m;
        2.0 * LOAD_N * self.beta() / self.water_n_m2 * (-s).exp() * s.cos()
    }

    /// Force of bank or cable `[N]`.
    fn by_hand_n(&self, a_m: f64) -> f64 {
        let way = match self.toward {
            Toward::Plus => self.free_m(a_m),
            Toward::Minus => -self.free_m(a_m),
        };
        ((way - self.clearance_m) / (1.0 / self.bank_n_m + 2.0 * self.beta() / self.water_n_m2)).max(0.0)
    }

    /// The beam as one module of so many elements, under P at a distance from its left end.
    fn solver(&self, elements: usize) -> impl Fn(f64) -> StaticResponse {
        let module = BeamModule::slender(self.length_m, elements, self.ei_n_m2, 1000.0, 1e4);
        let design = with(&module.design(1, self.water_n_m2, 0.0, 1.0), |d| {
            d.supports = Supports {
                left: vec![Direction::X, Direction::Y],
                right: vec![Direction::Y],
            };
            d.banks = vec![BankSpec {
                at: BankPlace::End(BridgeEnd::Left),
                direction: Direction::Z,
                stiffness_n_m: self.bank_n_m,
                one_sided: true,
                toward: Some(self.toward),
                clearance_m: self.clearance_m.max(0.0),
                // a clearance below 0 is a preload
                preload_n: (self.clearance_m < 0.0).then_some(-self.clearance_m * self.bank_n_m),
                damping_n_s_m: 0.0,
                y_m: Some(module.lines().to_vec()),
            }];
        });
        let ready = module.ready(&design, Model::Full);
        let solver = ready.statics(&module.axle(0.0, 1, Inertia::None));
        let own_laws = ready.design.own_laws(Connection::Linear, None).expect("laws");
        let dead = StaticSolver::new(&ready.bridge)
            .expect("statics")
            .dead_state(&DeadCase {
                connection: Connection::Linear,
                connector_stiffness_n_m: 0.0,
                own_laws: own_laws.clone(),
                water_level_m: 0.0,
            });
        let dead = dead.expect("a dead state");
        move |a_m: f64| {
            let mut case = ready.case(Connection::Linear, LOAD_N, a_m);
            case.own_laws = own_laws.clone();
            case.dead = dead.clone();
            solver.solve(&case).expect("solved")
        }
    }

    /// Forces of the bank `[N]`.
    fn forces_n(&self, elements: usize, places_m: &[f64]) -> Vec<f64> {
        let solver = self.solver(elements);
        places_m.iter().map(|a| reaction_n(&solver(*a))).collect()
    }
}

fn reaction_n(r: &StaticResponse) -> f64 {
    r.banks.iter().map(|of| of.2).sum()
}

/// Distances of the load from the end `[m]`; nodes stand there in every mesh.
const PLACES_M: [f64; 5] = [0.0, 5.0, 10.0, 30.0, 40.0];

/// A bank below the end, at once, 5 mm away and pressed 10 mm up: forces under P at five distances, over the largest. 2e-4: water shared by bilinear
/// shapes over elements of `beta h = 0.06` is of order 2 in it and takes 1.0e-4 (below). Twins: p_b, E, bank, and of the bank away
/// its clearance, of the pressed one its preload.
#[test]
fn a_bank_pushes_the_end_of_a_beam_on_water() {
    assert!((BEAM.beta() - 0.0501).abs() < 1e-5, "beta of these numbers");
    for (clearance_m, changes) in [(0.0, 3), (0.005, 4), (-0.010, 4)] {
        let beam = OnBank { clearance_m, ..BEAM };
        let found = beam.forces_n(160, &PLACES_M);
        let off = |of: OnBank| apart(&found, &PLACES_M.map(|a| of.by_hand_n(a)));
        for (name, change) in &CHANGES[..changes] {
            held(
                &format!("bank {clearance_m} m below, {name}"),
                2e-4,
                off(beam),
                off(beam.changed(*change)),
            );
        }
        assert!(
            clearance_m < 0.0 || found[4] == 0.0,
            "a bank that the end has left pushes {} N",
            found[4]
        );
    }
}

/// The order in space of that: 2 in the forces, elements of 5, 2.5 and 1.25 m. Slope within 0.05. Twin: E, towards which no error
/// falls.
#[test]
fn forces_of_a_bank_are_of_second_order() {
    let of_meshes = [40, 80, 160].map(|elements| BEAM.forces_n(elements, &PLACES_M));
    let off = |of: OnBank| {
        let errors = of_meshes
            .each_ref()
            .map(|found| apart(found, &PLACES_M.map(|a| of.by_hand_n(a))));
        println!("errors {errors:?}");
        largest(errors.windows(2).map(|w| ((w[0] / w[1]).log2() - 2.0).abs()))
    };
    held("order of a bank", 0.05, off(BEAM), off(BEAM.changed(CHANGES[1].1)));
}

/// Where the load lifts the end off its bank: `pi / 2 beta` = 31.35 m, halved in to 1 mm. 1e-3: elements of 1.25 m, order 2. Twins:
/// p_b and E, a fourth root of which is 1.2 %.
#[test]
fn the_end_leaves_its_bank_a_quarter_wave_from_the_load() {
    let solver = BEAM.solver(160);
    let (mut on, mut off) = (20.0, 40.0);
    while off - on > 1e-3 {
        let middle = 0.5 * (on + off);
        match reaction_n(&solver(middle)) > 0.0 {
            true => on = middle,
            false => off = middle,
        }
    }
    println!("leaves at {on} m");
    let missed = |of: OnBank| miss(on, FRAC_PI_2 / of.beta());
    for (name, change) in &CHANGES[..2] {
        held(
            &format!("place of the load, {name}"),
            1e-3,
            missed(BEAM),
            missed(BEAM.changed(*change)),
        );
    }
}

/// P 40 m away: the end rises by 21.6 mm off its bank; a cable that holds it down, taut and 5 mm slack, pulls, and does not under P
/// at the end. These are small differences of the beam, so elements of 2 and 1 m are extrapolated by their order, 2; 1e-4 is what
/// order 4 leaves of `beta h = 0.1`. Twins: p_b and E, of the cable also its stiffness and its slack.
#[test]
fn a_cable_holds_the_end_down() {
    let at_40_m = |of: &OnBank| -> [f64; 2] {
        let [coarse, fine] = [100, 200].map(|elements| {
            let solver = of.solver(elements);
            let none = reaction_n(&solver(0.0));
            assert!(of.toward == Toward::Plus || none == 0.0, "a slack cable pulls {none} N");
            let r = solver(40.0);
            [reaction_n(&r), -r.deflection_m[0]]
        });
        from_fn(|i| (4.0 * fine[i] - coarse[i]) / 3.0)
    };
    let [pushed, risen] = at_40_m(&BEAM);
    assert!(pushed == 0.0, "a bank that the end has left pushes {pushed} N");
    for (name, change) in &CHANGES[..2] {
        let off = |of: OnBank| miss(risen, -of.free_m(40.0));
        held(
            &format!("the end rises, {name}"),
            1e-4,
            off(BEAM),
            off(BEAM.changed(*change)),
        );
    }
    for (clearance_m, changes) in [(0.0, 3), (0.005, 4)] {
        let cable = OnBank {
            clearance_m,
            toward: Toward::Minus,
            ..BEAM
        };
        let [pulled, _] = at_40_m(&cable);
        let off = |of: OnBank| miss(pulled, of.by_hand_n(40.0));
        for (name, change) in &CHANGES[..changes] {
            held(
                &format!("cable {clearance_m} m slack, {name}"),
                1e-4,
                off(cable),
                off(cable.changed(*change)),
            );
        }
    }
}

/// Reaction `[N]` and deflections of the ends `[m]` of the rigid raft.
fn raft_by_hand(raft: OnBank) -> [f64; 3] {
    let (k, k_b, l) = (raft.water_n_m2, raft.bank_n_m, raft.length_m);
    let (a, b, d) = (
        k * l + k_b,
        -0.5 * k_b * l,
        k * l.powi(3) / 12.0 + 0.25 * k_b * l.powi(2),
    );
    let (force, moment) = (-LOAD_N, 0.5 * LOAD_N * l);
    let determinant = a * d - b * b;
    let (w0, theta) = (
        (force * d - b * moment) / determinant,
        (a * moment - b * force) / determinant,
    );
    let [left, right] = [-0.5, 0.5].map(|side| -(w0 + side * l * theta));
    [k_b * left, left, right]
}

/// The rigid raft by two elements: the bank's force and the ends. EI of 1e14 N m^2: what a raft of it bends is a tenth of what one of
/// 1e13 does, which is 1.1e-4 of the force and 1.1e-3 of the ends, and K's rounding is as large; more EI would have more of that.
/// Twins: p_b, bank.
#[test]
fn a_rigid_raft_turns_about_its_bank() {
    let raft = |ei_n_m2: f64| OnBank {
        length_m: 100.5,
        ei_n_m2,
        ..BEAM
    };
    let off = |found: &StaticResponse, of: OnBank| {
        let [force, left, right] = raft_by_hand(of);
        [
            miss(reaction_n(found), force),
            apart(&found.deflection_m, &[left, right]),
        ]
    };
    let [soft, stiff, rigid] = [1e12, 1e13, 1e14].map(|ei| raft(ei).solver(2)(0.0));
    let [soft, stiff] = [soft, stiff].map(|found| off(&found, raft(1.0)));
    for (name, change) in [CHANGES[0], CHANGES[2]] {
        let [right, wrong] = [raft(1.0), raft(1.0).changed(change)].map(|of| off(&rigid, of));
        held(&format!("force of the raft's bank, {name}"), 5e-5, right[0], wrong[0]);
        held(&format!("ends of the raft, {name}"), 3e-4, right[1], wrong[1]);
    }
    for n in 0..2 {
        let falls = soft[n] / stiff[n];
        assert!(
            (8.0..12.0).contains(&falls),
            "ten times the EI leaves 1/{falls} of the bending"
        );
    }
}

/// Largest force of the left bank `[N]` while 230.3 kN cross six modules of the plane chain at 3 m/s, on banks of 1e9 N/m.
fn hammered_n(damping_n_s_m: f64, time_step_s: f64) -> f64 {
    let bank = |end: &str| json!({ "at": end, "direction": "z", "stiffness_n_m": 1e9, "damping_n_s_m": damping_n_s_m });
    let asked = json!({ "modules": 6, "banks": [bank("left"), bank("right")], "speed_m_s": 3,
                        "analysis": { "time_step_s": time_step_s, "tail_s": 0 } });
    let document = Document::of_canonical(asked.to_string());
    let scenario = ChainScenario::of(Path::new("scenario.json"), &document, None).expect("a scenario");
    let answer = answer(&scenario).expect("an answer");
    answer["banks"][0]["peak_toward_n"].as_f64().expect("a force")
}

/// A stiff bank is hammered, with a dashpot and without. The free end of a half-endless beam answers a force of frequency omega
/// with the dynamic stiffness `EI kappa^3 (i - 1) / 2`, `kappa = (mu omega^2 / EI)^(1/4)`: with a mass `m = mu / 2 kappa`, and with
/// waves that it sends away. On the bank this mass has `kappa = (2 k_b / EI)^(1/3)` and `omega = kappa^2 sqrt(EI / mu)`, so that a
/// contact lasts `pi / omega` = 8.0 ms. The dashpot is a fifth of the critical `2 sqrt(k_b m)`; from a half on its jump at the touch
/// would be the largest force.
///
/// 1 % between steps of a sixth and a twelfth of a contact: six steps cut the top of an arc by `(pi/12)^2 / 2` = 3.4 % at worst, by
/// a third of that on average. Twin: steps of 5 and 2.5 ms, which do not resolve the contact. The dashpot lowers the force by more
/// than a tenth.
#[test]
fn the_force_of_a_hammered_bank_converges_once_steps_resolve_a_contact() {
    let (ei, mu, k_b) = (2.4e9_f64, 1013.0 + 11_135.0, 1e9_f64);
    let kappa = (2.0 * k_b / ei).cbrt();
    let contact_s = PI / (kappa.powi(2) * (ei / mu).sqrt());
    assert!((contact_s - 0.008).abs() < 1e-4, "a contact of {contact_s} s");
    let dashpot = 0.2 * 2.0 * (k_b * mu / (2.0 * kappa)).sqrt();
    assert!((dashpot - 1.016e6).abs() < 1e3, "{dashpot} N s/m");
    let steps = [0.005, 0.0025, 0.00125, 0.000625];
    let [bare, damped] = [0.0, dashpot].map(|c| {
        let forces = on_two_threads(&steps, |step| hammered_n(c, *step));
        println!("{c:.0} N s/m, steps of 5 to 0.625 ms: {forces:.0?} N");
        let what = format!("a sixth of a contact, {c:.0} N s/m");
        held(&what, 1e-2, miss(forces[2], forces[3]), miss(forces[0], forces[1]));
        forces[3]
    });
    assert!(damped < 0.9 * bare, "the dashpot leaves {damped} of {bare} N");
}
