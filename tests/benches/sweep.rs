//! A thousand crossings of a grid gap x gap x speed x load through the operator, on one thread and on two.
//!
//! Knows that threads share nothing but the solver. `cargo bench --profile quick --workspace --bench sweep`; no test runs it.

#![allow(missing_docs)]

use divan::Bencher;
use divan::counter::ItemsCount;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::scenario::{Scenario, vehicle};
use std::sync::LazyLock;

static SCENARIO: LazyLock<Scenario> = LazyLock::new(Scenario::new);

fn main() {
    divan::main();
}

/// The counter's items are time steps.
#[divan::bench(args = [1, 2], sample_count = 2, sample_size = 1)]
fn thousand_crossings(bencher: Bencher<'_, '_>, threads: usize) {
    let (vehicle, crossings) = (vehicle(Inertia::Local), SCENARIO.sweep([5, 5, 5, 8]));
    let steps: usize = crossings
        .iter()
        .map(|crossing| SCENARIO.steps(&vehicle, crossing))
        .sum();
    bencher
        .counter(ItemsCount::new(steps))
        .bench_local(|| SCENARIO.solve(&vehicle, &crossings, threads));
}
