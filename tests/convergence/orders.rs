//! Convergence by its measured order: the time step, the mesh.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::connector::Connection;
use pontoon_core::module::{LongitudinalWalls, Stiffeners, TransverseWalls};
use pontoon_core::response::{Quantity, Record};
use pontoon_core::vehicle::{Axle, Body, Inertia, Vehicle, VehicleDesign};
use pontoon_tests::*;

/// Orders between neighbours of a list of errors, each at half the size of the one before.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|w| (w[0] / w[1]).log2()).collect()
}

/// Order 2 before any contact changes, slope within 0.2, errors against a step sixteen times finer. The load must be
/// smooth between steps for that: modules a thousand times stiffer, so that the deck is straight between joints, one axle
/// of points, and a speed at which it meets joints at whole steps of all lengths. Twin: an exact solution under a load
/// 5 % wrong, towards which no error falls.
#[test]
fn time_integration_is_of_second_order() {
    let ready = Ready::new(&with_e(&design("smoke"), 1e3), Model::SuperElement);
    let point = |inertia: Inertia| axles(&[(0.0, 1.0, 0.0)], inertia, 1);
    for (what, vehicle) in [
        ("weight", point(Inertia::None)),
        ("mass", point(Inertia::Local)),
        ("quarter car", quarter_car()),
    ] {
        let run = |h: f64, load_n: f64| -> Vec<f64> {
            // 1.6 s from joint to joint
            let mut crossing = ready.crossing(Connection::Linear, load_n, 6.7 / 1.6);
            crossing.record = Record {
                positions: vec![2, 3],
                joints: vec![],
                ..Record::default()
            };
            let solver = ready.crossings(&vehicle, &settings(ready.rayleigh(), h, 0.9));
            let r = solver.solve(&crossing).expect("solved");
            // every 0.1 s from t = 0, which is not where the motion starts
            let every = (0.1 / h).round() as usize;
            let before = r.recorded.history_time_s.iter().filter(|&&t| t < -0.5 * h).count();
            let of = |position| {
                history(&r, Quantity::Deflection, position)
                    .iter()
                    .skip(before)
                    .step_by(every)
                    .copied()
            };
            of(2).chain(of(3)).collect()
        };
        let steps = [0.02, 0.01, 0.005].map(|h| run(h, PAPER_LOAD_N));
        let errors = |load_n: f64| {
            let exact = run(0.005 / 16.0, load_n);
            steps.each_ref().map(|step| apart(step, &exact))
        };
        println!("{what}: {:?}", orders(&errors(PAPER_LOAD_N)));
        let off = |load_n: f64| largest(orders(&errors(load_n)).iter().map(|order| (order - 2.0).abs()));
        held(
            &format!("order in time, {what}"),
            0.2,
            off(PAPER_LOAD_N),
            off(1.05 * PAPER_LOAD_N),
        );
    }
}

/// A body on a suspension over an axle on its tyre, a point on each of two tracks. The tyre has no damper: its force would jump where
/// the slope of the deck does.
fn quarter_car() -> Vehicle {
    let axle = Axle {
        track_y_m: vec![-1.4, 1.4],
        unsprung_mass_kg: Some(3000.0),
        tyre_stiffness_n_m: Some(1e6),
        suspension_stiffness_n_m: Some(1e6),
        suspension_damping_n_s_m: Some(4e4),
        ..Axle::default()
    };
    let body = Body {
        mass_kg: 20_000.0,
        behind_front_m: 0.0,
        pitch_inertia_kg_m2: None,
        roll_inertia_kg_m2: None,
        height_m: None,
    };
    let design = VehicleDesign {
        axles: Some(vec![axle]),
        body: Some(body),
        ..VehicleDesign::default()
    };
    design.check(8.082).expect("a vehicle")
}

/// A box of thick plates without walls or stiffeners, almost without water: its shapes span many elements.
fn thick_box(parts: usize, e: f64) -> BridgeDesign {
    with(&with_e(&design("smoke"), e), |d| {
        d.modules = 1;
        d.added_mass_kg_m = Some(1.0);
        let m = &mut d.module;
        for thickness in [
            &mut m.deck_thickness_m,
            &mut m.bottom_thickness_m,
            &mut m.side_thickness_m,
            &mut m.end_thickness_m,
        ] {
            *thickness = 0.03;
        }
        m.longitudinal_walls = LongitudinalWalls::default();
        m.transverse_walls = TransverseWalls::default();
        m.stiffeners = Stiffeners::default();
        m.mesh.elements_along = 4 * parts;
        m.mesh.elements_between_lines = parts;
        m.mesh.elements_over_depth = parts;
    })
}

/// Order 2 of bilinear elements: from mesh to mesh of half the size the change falls to a quarter, within a tenth, since the
/// coarsest of the three has some eight elements a half wave. The frequencies fall. Twin: E on the middle mesh.
#[test]
fn elastic_modes_converge_with_the_square_of_the_mesh() {
    let hz = |parts: usize, e: f64| {
        let modes = Ready::new(&thick_box(parts, e), Model::Full).modes(12);
        ["vertical bending 1", "torsion 1"].map(|name| frequency_hz(&modes, name))
    };
    let [coarse, middle, fine, soft] = [(2, 1.0), (4, 1.0), (8, 1.0), (4, 0.95)].map(|(parts, e)| hz(parts, e));
    for mode in 0..2 {
        assert!(
            coarse[mode] > middle[mode] && middle[mode] > fine[mode],
            "falling to the limit"
        );
        let off = |middle: f64| ((coarse[mode] - middle) / (middle - fine[mode]) / 4.0 - 1.0).abs();
        held("order of the mesh", 0.1, off(middle[mode]), off(soft[mode]));
    }
}
