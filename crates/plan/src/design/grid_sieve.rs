//! The conditions on a grid, by the places of values: each is tried once on each value, or pair of values, that it speaks of.
//!
//! Knows which combinations pass. Does not know what a condition says.

use super::condition::Test;
use super::values::Values;

/// Which points of a grid meet its conditions.
#[derive(Debug)]
pub(super) struct GridSieve {
    /// Number of values of each axis.
    sizes: Vec<usize>,
    /// Each condition on one axis or on two.
    conditions: Vec<Tried>,
}

/// A condition, tried.
#[derive(Debug)]
struct Tried {
    /// The axes that it speaks of, at most two; the second one's values lie side by side.
    axes: Vec<usize>,
    /// Whether it is met, for each value or pair of values.
    met: Vec<bool>,
}

impl GridSieve {
    /// Tries the conditions on the values of a grid.
    pub(super) fn new(values: &[Values], tests: &[Test]) -> Self {
        let parts = tests.iter().flat_map(Test::parts);
        let conditions = parts.map(|part| Tried::new(values, &part)).collect();
        Self {
            sizes: values.iter().map(Values::len).collect(),
            conditions,
        }
    }

    /// Whether a point passes, by its number: the first axis changes slowest.
    pub(super) fn passes(&self, number: usize) -> bool {
        let place = |axis: usize| {
            let behind: usize = self.sizes[axis + 1..].iter().product();
            number / behind % self.sizes[axis]
        };
        self.conditions.iter().all(|tried| {
            let at = tried
                .axes
                .iter()
                .fold(0, |at, &axis| at * self.sizes[axis] + place(axis));
            tried.met[at]
        })
    }
}

impl Tried {
    fn new(values: &[Values], part: &Test) -> Self {
        let axes = part.axes();
        let many: usize = axes.iter().map(|&axis| values[axis].len()).product();
        let met = (0..many).map(|number| {
            part.met(|axis| {
                let behind: usize = axes
                    .iter()
                    .skip_while(|of| **of != axis)
                    .skip(1)
                    .map(|&of| values[of].len())
                    .product();
                values[axis].at(number / behind % values[axis].len())
            })
        });
        Self {
            met: met.collect(),
            axes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::axes::Axis;
    use super::super::condition::Conditions;
    use super::*;
    use crate::input::Cell;
    use proptest::prelude::*;
    use serde_json::{Value, json};
    use std::path::Path;

    fn values(list: &Value) -> Values {
        Values::read(Path::new("s.json"), "x", list).unwrap()
    }

    proptest! {
        /// A grid of three axes under conditions on one axis, on two, and on one with itself: the sieve passes what the
        /// conditions say of the point's values.
        #[test]
        fn the_sieve_is_the_conditions(
            a in prop::collection::vec(0_i32..6, 1..5),
            b in prop::collection::vec(0_i32..6, 1..5),
            c in prop::collection::vec(0_i32..6, 1..4),
            from in 0_i32..4,
        ) {
            let lists = [json!(a), json!(b), json!(c)].map(|list| values(&list));
            let names = ["speed_m_s", "load_n", "gap_tension_m"];
            let axes: Vec<Axis> =
                names.iter().map(|name| Axis::read(Path::new("s.json"), "x", name, &[]).unwrap()).collect();
            let conditions: Conditions = serde_json::from_value(json!({
                "gap_tension_m": { "at_least": "speed_m_s", "below": "load_n" },
                "load_n": { "from": from, "at_least": "load_n" },
                "speed_m_s": [0, 1, 2, 5]
            })).unwrap();
            let tests = conditions.on(&axes);
            let sieve = GridSieve::new(&lists, &tests);
            let mut number = 0;
            for &x in &a {
                for &y in &b {
                    for &z in &c {
                        let point = [x, y, z].map(|value| Cell::written(f64::from(value)));
                        let met = tests.iter().all(|test| test.met(|axis| point[axis].borrowed()));
                        prop_assert_eq!(sieve.passes(number), met, "{} {} {}", x, y, z);
                        number += 1;
                    }
                }
            }
        }
    }
}
