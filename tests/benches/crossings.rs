//! Crossings on the default bridge: through the operator, alone and with every lane full, and by the reference solver.
//!
//! Knows the paper's crossing at 15 m/s; the counter's items are its time steps, so that items a second are steps a second.
//! `cargo bench --profile quick --workspace --bench crossings`; no test runs it.

#![allow(missing_docs, clippy::expect_used)]

use divan::Bencher;
use divan::counter::ItemsCount;
use pontoon_core::analysis::crossing::CrossingSolver;
use pontoon_core::operator::InstructionPath;
use pontoon_core::response::Record;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::scenario::{Scenario, vehicle};
use pontoon_tests::{SolvesSingle, solve_side_by_side};
use std::sync::LazyLock;

static SCENARIO: LazyLock<Scenario> = LazyLock::new(Scenario::new);
const SPEED_M_S: f64 = 15.0;

fn main() {
    divan::main();
}

#[divan::bench(args = [Inertia::None, Inertia::Local], sample_count = 50)]
fn operator_lone(bencher: Bencher<'_, '_>, inertia: &Inertia) {
    let (vehicle, crossing) = (vehicle(*inertia), SCENARIO.crossing(SPEED_M_S, Record::default()));
    let solve = || SCENARIO.solver.solve_single(&vehicle, &crossing).expect("a crossing");
    bencher
        .counter(ItemsCount::new(SCENARIO.steps(&vehicle, &crossing)))
        .bench_local(solve);
}

#[divan::bench(args = [Inertia::None, Inertia::Local], sample_count = 50)]
fn operator_full_lanes(bencher: Bencher<'_, '_>, inertia: &Inertia) {
    let (vehicle, crossing) = (vehicle(*inertia), SCENARIO.crossing(SPEED_M_S, Record::default()));
    let jobs = vec![(&vehicle, &crossing); 4 * InstructionPath::of_this_machine().lanes];
    let solve = || solve_side_by_side(&SCENARIO.solver, &jobs, 0);
    let steps = jobs.len() * SCENARIO.steps(&vehicle, &crossing);
    bencher.counter(ItemsCount::new(steps)).bench_local(solve);
}

#[divan::bench(args = [Inertia::None, Inertia::Local], sample_count = 3)]
fn reference(bencher: Bencher<'_, '_>, inertia: &Inertia) {
    let (vehicle, crossing) = (vehicle(*inertia), SCENARIO.crossing(SPEED_M_S, Record::default()));
    let solver = CrossingSolver::new(&SCENARIO.ready.bridge, &SCENARIO.settings).expect("factors");
    let solve = || solver.solve_single(&vehicle, &crossing).expect("a crossing");
    bencher
        .counter(ItemsCount::new(SCENARIO.steps(&vehicle, &crossing)))
        .bench_local(solve);
}
