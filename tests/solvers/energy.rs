//! The energy balance of crossings: that it closes, that nothing hides in the scheme's dissipation, and that a wrong sum
//! would show.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, EnergyBalance, StepEnergies};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::*;
use std::sync::OnceLock;

fn smoke() -> &'static Ready {
    static READY: OnceLock<Ready> = OnceLock::new();
    READY.get_or_init(|| Ready::new(&design("smoke"), Model::SuperElement))
}

/// Gaps narrow enough that all connectors of the short bridge work.
const NARROW: Connection = gaps(0.001, 0.0005);

const INERTIAS: [Inertia; 3] = [Inertia::None, Inertia::Local, Inertia::Convective];

fn cross(inertia: Inertia, connection: Connection, rayleigh: Rayleigh, h: f64, rho: f64) -> CrossingResponse {
    let vehicle = footprint(&[-1.4, 1.4], inertia);
    let solver = smoke().crossings(&vehicle, &settings(rayleigh, h, rho));
    solver
        .solve(&smoke().crossing(connection, PAPER_LOAD_N, 8.0))
        .expect("solved")
}

/// 1e-9: the increments are the equations of motion times the step, so that what is left is their rounding, 1e-13. The
/// scheme dissipates, but less than the 5 % allowed; contacts switch where there are gaps and nowhere else. The twin
/// is the balance's own, below.
#[test]
fn balance_closes_for_every_inertia_and_connection() {
    for inertia in INERTIAS {
        for connection in [Connection::Linear, NARROW] {
            let r = cross(inertia, connection, smoke().rayleigh(), 0.01, 0.9);
            let (residual, numerical) = (r.energy.energy_residual, r.energy.numerical_dissipation);
            println!("{inertia:?} {connection:?}: residual {residual:.1e}, numerical {numerical:.1e}");
            assert!(
                residual <= 1e-9 && numerical <= 0.05,
                "residual {residual:e}, numerical {numerical:e}"
            );
            assert!(numerical > 1e-5, "a scheme of radius 0.9 dissipates");
            assert_eq!(r.statistics.contact_switches > 0, connection == NARROW);
        }
    }
}

/// The trapezoidal rule on a linear bridge conserves `1/2 v M v + 1/2 u K u` to rounding: with radius 1 no dissipation is
/// left for the scheme, whatever the Rayleigh damping, 1e-9. So the energies are those of the matrices that moved the
/// bridge, which the residual alone does not show. Twin: a radius of 0.95.
#[test]
fn trapezoidal_rule_conserves_energy() {
    for inertia in INERTIAS {
        for rayleigh in [Rayleigh::new(0.0, 0.0), smoke().rayleigh()] {
            let numerical = |rho: f64| {
                cross(inertia, Connection::Linear, rayleigh, 0.01, rho)
                    .energy
                    .numerical_dissipation
            };
            held(
                &format!("{inertia:?}, a = {:.3}", rayleigh.a),
                1e-9,
                numerical(1.0),
                numerical(0.95),
            );
        }
    }
}

/// With gaps the trapezoidal rule dissipates or gains only in steps in which a connector meets or leaves its gap, by the
/// square of the step: 2e-5 of the work at 5 ms. Twin: a radius of 0.95.
#[test]
fn contact_switches_alone_cost_next_to_nothing() {
    for inertia in INERTIAS {
        let numerical = |rho: f64| {
            cross(inertia, NARROW, smoke().rayleigh(), 0.005, rho)
                .energy
                .numerical_dissipation
        };
        held(&format!("{inertia:?}, gaps"), 2e-5, numerical(1.0), numerical(0.95));
    }
}

/// A balance that closes reports nothing, 1e-15; one whose Rayleigh sum is 5 % wrong reports that share, and it keeps the
/// worst of all steps and the largest work.
#[test]
fn wrong_sum_shows_in_the_summary() {
    let summary = |factor: f64| {
        let mut balance = EnergyBalance::default();
        balance.take(&StepEnergies {
            kinetic: 1.0,
            strain: 1.0,
            connectors: 0.25,
            vehicles: 0.25,
            rayleigh: factor * 3.0,
            radiated: factor * 1.0,
            dashpots: 1.0,
            numerical: 0.5,
            work: 8.0,
        });
        balance.take(&StepEnergies {
            rayleigh: 3.5 - factor * 4.0,
            work: -3.0,
            ..StepEnergies::default()
        });
        balance.summary()
    };
    held(
        "summary",
        1e-15,
        summary(1.0).energy_residual,
        summary(1.05).energy_residual,
    );
    assert!(
        (summary(1.05).energy_residual - 0.2 / 8.0).abs() < 1e-15,
        "over the largest work"
    );
    assert!(
        (summary(1.0).numerical_dissipation - 0.5 / 8.0).abs() < 1e-15,
        "over the largest work"
    );
}
