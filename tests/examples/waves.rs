//! What crossings cost in water with memory beside the paper's water: scripts/bench-waves.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::OperatorSolver;
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::operated::operator;
use pontoon_tests::waves::in_water_of;
use pontoon_tests::{PAPER_GAPS, PAPER_LOAD_N, Ready, SingleCrossing, design, footprint, settings, solve_side_by_side};
use std::path::Path;
use std::time::Instant;

/// Crossings of a run, 5 to 15 m/s, and alternating runs of which the least counts.
const CROSSINGS: u32 = 64;
const RUNS: usize = 7;

/// The solver of a bridge, as studies use it.
fn solver(design: &BridgeDesign) -> OperatorSolver {
    let started = Instant::now();
    let ready = Ready::new(design, Model::SuperElement);
    let operator = operator(&ready, 6e-4);
    let (modes, took) = (operator.cutoff().modes, started.elapsed());
    match operator.wave_states() {
        None => println!("paper's water: {modes} modes, prepared in {took:.1?}"),
        Some(states) => println!(
            "waves: {modes} modes, {} states, kernel within {:.2} %, prepared in {took:.1?}",
            states.real_states,
            100.0 * states.kernel_error
        ),
    }
    let settings = settings(Rayleigh::of_structure(0.02, 1.0), 0.01, 0.9);
    OperatorSolver::new(&ready.bridge, &operator, &settings)
}

fn main() {
    let design = design("fu2005");
    let water = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/waters/fu2005_deep.json");
    let solvers = [&design, &in_water_of(&design, &water)].map(solver);
    let crossing = |i: u32| SingleCrossing {
        connection: PAPER_GAPS,
        connector_stiffness_n_m: design.connectors.stiffness_n_m,
        own_laws: [].into(),
        load_n: PAPER_LOAD_N,
        speed_m_s: 5.0 + 10.0 * f64::from(i) / f64::from(CROSSINGS),
        tail_s: 6.0,
        record: pontoon_core::response::Record::default(),
        dead: None,
    };
    let crossings: Vec<SingleCrossing> = (0..CROSSINGS).map(crossing).collect();
    for (what, tracks, inertia) in [
        ("weight", [-1.4, 1.4], Inertia::None),
        ("riding masses", [-1.4, 1.4], Inertia::Local),
        ("weight, off the centre line", [-0.4, 2.4], Inertia::None),
        ("riding masses, off the centre line", [-0.4, 2.4], Inertia::Local),
    ] {
        let vehicle = footprint(&tracks, inertia);
        let asked: Vec<_> = crossings.iter().map(|crossing| (&vehicle, crossing)).collect();
        let mut least = [f64::INFINITY; 2];
        for _ in 0..RUNS {
            for (least, solver) in least.iter_mut().zip(&solvers) {
                let started = Instant::now();
                let solved = solve_side_by_side(solver, &asked, 0);
                assert!(solved.iter().all(Result::is_ok));
                *least = least.min(started.elapsed().as_secs_f64());
            }
        }
        let [paper, waves] = least.map(|seconds| 1e3 * seconds / f64::from(CROSSINGS));
        println!(
            "{what}: {paper:.2} ms a crossing, in waves {waves:.2} ms, ratio {:.3}",
            waves / paper
        );
    }
}
