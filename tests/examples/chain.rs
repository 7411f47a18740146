//! Prints the crossings of the plane chain `tests/data/chain.json` as one JSON document: `chain [time step in s]`.
//!
//! Knows its one argument. Does not know what other codes answer.

#![allow(clippy::expect_used)]

use pontoon_tests::chain::Chain;

fn main() {
    let time_step_s = std::env::args()
        .nth(1)
        .map_or(0.0025, |word| word.parse().expect("a time step in s"));
    let chain = Chain::read();
    println!("{}", chain.report(time_step_s, &chain.cross(time_step_s)));
}
