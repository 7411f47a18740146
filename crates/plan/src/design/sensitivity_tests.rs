//! Designs of Saltelli and Morris as they are written, against the points they come to.

use super::*;
use crate::input::Refusal;
use serde_json::{Value, json};
use std::path::Path;

fn read(design: Value) -> Result<Block, Refusal> {
    let file = Path::new("study.json");
    let designs: Vec<Design> = crate::input::typed_value(file, "design", &json!([design]))?;
    Ok(Block::read(file, &designs, &[])?.remove(0))
}

/// The points of one design as numbers.
fn points(design: Value) -> Vec<Vec<f64>> {
    let block = read(design).unwrap();
    let number = |(_, cell): (&Axis, &crate::input::Cell<'_>)| cell.number().unwrap();
    let found: Vec<Vec<f64>> = block
        .points()
        .map(|point| point.values().map(number).collect())
        .collect();
    assert_eq!(found.len(), block.len());
    found
}

/// Expects the refusal of a design at a key below it, with what was found and what is allowed.
fn is_refused(design: Value, key: &str, found: &str, allowed: &str) {
    let e = read(design).unwrap_err();
    assert_eq!(e.path, format!("design[0]{key}"), "{e}");
    assert!(e.fault().contains(found) && e.allowed.contains(allowed), "{e}");
}

fn saltelli(more: &Value) -> Value {
    let mut spec = json!({ "count": 8, "seed": 3, "ranges": { "speed_m_s": [2, 20], "load_n": 1e5, "gap_tension_m": [0, 0.04],
                           "bridge.modules": { "whole": [2, 9] } } });
    spec.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    json!({ "saltelli": spec })
}

fn morris(more: &Value) -> Value {
    let mut spec = json!({ "trajectories": 10, "seed": 3, "ranges": { "speed_m_s": [2, 20], "load_n": 1e5,
                           "gap_tension_m": [0, 0.03] } });
    spec.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    json!({ "morris": spec })
}

/// The places of the drawn axes in a point of [`saltelli`].
const DRAWN: [usize; 3] = [0, 2, 3];

#[test]
fn a_row_is_a_then_a_with_one_factor_of_b_then_b() {
    let found = points(saltelli(&json!({})));
    assert_eq!(found.len(), 8 * 5);
    for row in found.chunks(5) {
        let (a, b) = (&row[0], &row[4]);
        assert!(DRAWN.iter().any(|&axis| a[axis] != b[axis]), "{row:?}");
        assert!(row.iter().all(|point| point[1] == 1e5), "{row:?}");
        for (factor, &axis) in DRAWN.iter().enumerate() {
            for &other in &DRAWN {
                let of = if other == axis { b } else { a };
                // bit for bit: the study merges equal points
                assert_eq!(row[factor + 1][other].to_bits(), of[other].to_bits(), "{row:?}");
            }
        }
    }
}

#[test]
fn pairs_have_b_with_one_factor_of_a_too() {
    let (with, without) = (
        points(saltelli(&json!({ "second_order": true }))),
        points(saltelli(&json!({}))),
    );
    assert_eq!(with.len(), 8 * 8);
    for (row, fewer) in with.chunks(8).zip(without.chunks(5)) {
        assert_eq!((&row[..4], &row[7]), (&fewer[..4], &fewer[4]));
        let (a, b) = (&row[0], &row[7]);
        for (factor, &axis) in DRAWN.iter().enumerate() {
            for &other in &DRAWN {
                let of = if other == axis { a } else { b };
                assert_eq!(row[factor + 4][other].to_bits(), of[other].to_bits(), "{row:?}");
            }
        }
    }
}

#[test]
fn sample_a_is_that_of_sobol_and_more_rows_begin_with_fewer() {
    let ranges = json!({ "speed_m_s": [2, 20], "load_n": 1e5, "gap_tension_m": [0, 0.04] });
    let sobol = points(json!({ "sobol": { "count": 16, "seed": 3, "ranges": ranges } }));
    let of = |count: usize| points(saltelli(&json!({ "count": count, "ranges": ranges })));
    let (few, many) = (of(8), of(16));
    assert_eq!(many[..few.len()], few);
    assert!(many.chunks(4).map(|row| &row[0]).eq(&sobol));
}

#[test]
fn the_order_of_ranges_does_not_change_rows_or_trajectories() {
    let orders = [
        json!({ "speed_m_s": [2, 20], "load_n": [1, 9] }),
        json!({ "load_n": [1, 9], "speed_m_s": [2, 20] }),
    ];
    let swapped = |mut point: Vec<f64>| {
        point.reverse();
        point
    };
    for form in [saltelli, morris] {
        let [one, other] = orders
            .each_ref()
            .map(|ranges| points(form(&json!({ "ranges": ranges }))));
        let other: Vec<Vec<f64>> = other.into_iter().map(swapped).collect();
        if form(&json!({}))["morris"].is_null() {
            for (one, other) in one.chunks(4).zip(other.chunks(4)) {
                assert_eq!(
                    [&one[0], &one[1], &one[2], &one[3]],
                    [&other[0], &other[2], &other[1], &other[3]]
                );
            }
        } else {
            assert_eq!(one, other);
        }
    }
}

#[test]
fn points_of_a_trajectory_differ_in_one_factor_by_two_thirds_of_its_range() {
    let design = morris(&json!({}));
    let found = points(design.clone());
    let steps: Vec<Vec<TrajectoryStep>> = read(design).unwrap().trajectories().collect();
    assert_eq!((found.len(), steps.len()), (10 * 3, 10));
    let levels = [[2.0, 8.0, 14.0, 20.0], [0.0, 0.01, 0.02, 0.03]];
    for (walk, steps) in found.chunks(3).zip(steps) {
        for point in walk {
            assert!(
                levels[0].contains(&point[0]) && levels[1].contains(&point[2]),
                "{point:?}"
            );
        }
        for (pair, step) in walk.windows(2).zip(steps) {
            let (axis, delta) = [(0, 12.0), (2, 0.02)][step.factor];
            let change = if step.up { delta } else { -delta };
            assert!((pair[1][axis] - pair[0][axis] - change).abs() < 1e-12, "{pair:?}");
            assert_eq!(pair[0][2 - axis], pair[1][2 - axis]);
        }
    }
    let longer = points(morris(&json!({ "trajectories": 12 })));
    assert_eq!(longer[..found.len()], found);
}

#[test]
fn whole_numbers_and_words_are_factors_of_trajectories() {
    let ranges = json!({ "speed_m_s": 5, "bridge.modules": { "whole": [2, 3] }, "load_n": { "values": [1, 5, 7] } });
    let block = read(morris(&json!({ "ranges": ranges }))).unwrap();
    let names: Vec<&str> = block.factors().iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["bridge.modules", "load_n"]);
    let found = points(morris(&json!({ "ranges": ranges })));
    for pair in found
        .windows(2)
        .enumerate()
        .filter(|(i, _)| i % 3 != 2)
        .map(|(_, pair)| pair)
    {
        let changed = (0..3).filter(|&axis| pair[0][axis] != pair[1][axis]).count();
        assert_eq!(changed, 1, "{pair:?}");
    }
}

#[test]
fn groups_are_told() {
    let of = |design: Value| read(design).unwrap().groups();
    let told = of(saltelli(&json!({ "second_order": true })));
    assert_eq!(
        told,
        Some(PointGroups::Saltelli {
            groups: 8,
            second_order: true
        })
    );
    assert_eq!(
        of(morris(&json!({}))),
        Some(PointGroups::Morris { groups: 10, levels: 4 })
    );
    let grid = read(json!({ "grid": { "load_n": [1, 2] } })).unwrap();
    assert!(grid.groups().is_none() && grid.factors().is_empty() && grid.trajectories().next().is_none());
}

#[test]
fn what_is_no_design_of_either_is_refused_by_key() {
    let counts = "a whole number from 2 to 10000000";
    is_refused(saltelli(&json!({ "count": 1 })), ".saltelli.count", "1", counts);
    is_refused(
        morris(&json!({ "trajectories": 1 })),
        ".morris.trajectories",
        "1",
        counts,
    );
    for levels in [0, 3, 1002] {
        let design = morris(&json!({ "levels": levels }));
        is_refused(
            design,
            ".morris.levels",
            &levels.to_string(),
            "an even number from 2 to 1000",
        );
    }
    let constant = json!({ "ranges": { "load_n": 1 } });
    is_refused(saltelli(&constant), ".saltelli.ranges", "no range", "at least one axis");
    is_refused(morris(&constant), ".morris.ranges", "no range", "at least one axis");
    let many: serde_json::Map<_, _> = (0..51).map(|i| (format!("bridge.a.b{i}"), json!([0, 1]))).collect();
    let many = json!({ "ranges": many });
    is_refused(saltelli(&many), ".saltelli.ranges", "51 ranges", "at most 50 ranges");
    assert_eq!(read(morris(&many)).unwrap().len(), 520);
    is_refused(
        saltelli(&json!({ "counts": 1 })),
        ".saltelli.counts",
        "unknown key",
        "second_order",
    );
    for (design, form) in [(saltelli(&json!({})), "saltelli"), (morris(&json!({})), "morris")] {
        let mut design = design;
        design["where"] = json!({ "speed_m_s": { "from": 5 } });
        is_refused(design, ".where", &format!("conditions beside {form}"), "none: a");
    }
    let e = read(saltelli(&json!({ "count": 5_000_000 }))).unwrap_err();
    assert_eq!(
        (e.path.as_str(), &*e.fault()),
        ("design", "found 25000000 points"),
        "{e}"
    );
}
