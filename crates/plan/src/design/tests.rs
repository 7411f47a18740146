//! Designs as they are written, against the points they come to.

use super::*;
use crate::input::Refusal;
use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::Path;

fn read(designs: Value) -> Result<Vec<Block>, Refusal> {
    let designs: Vec<Design> = crate::input::typed_value(Path::new("study.json"), "design", &designs)?;
    let mut known: Vec<String> = NAMED_AXES.iter().map(|axis| axis.name.to_owned()).collect();
    known.push("bridge.hydrostatic_stiffness_pa_m".to_owned());
    Block::read(Path::new("study.json"), &designs, &known)
}

fn points(designs: Value) -> Vec<Vec<Value>> {
    let blocks = read(designs).unwrap();
    let found: Vec<Vec<Value>> = blocks
        .iter()
        .flat_map(|b| b.points())
        .map(|p| p.values().map(|(_, cell)| cell.value()).collect())
        .collect();
    assert_eq!(found.len(), blocks.iter().map(Block::len).sum::<usize>());
    found
}

/// The points of one design as numbers.
fn numbers(design: Value) -> Vec<Vec<f64>> {
    let number = |value: &Value| value.as_f64().unwrap();
    let points = points(json!([design]));
    points.iter().map(|point| point.iter().map(number).collect()).collect()
}

fn refused(design: Value) -> Refusal {
    let shown = design.to_string();
    read(json!([design])).err().unwrap_or_else(|| panic!("{shown}"))
}

/// Expects the refusal of a design at a key below it, with what was found and what is allowed.
fn is_refused(design: Value, key: &str, found: &str, allowed: &str) {
    let e = refused(design);
    assert_eq!(e.path, format!("design[0]{key}"), "{e}");
    assert!(e.fault().contains(found) && e.allowed.contains(allowed), "{e}");
}

#[test]
fn the_first_axis_changes_slowest_and_designs_follow_each_other() {
    let found = points(json!([
        {"grid": {"speed_m_s": [1, 2], "load_n": [30, 10, 20]}},
        {"cases": [{"load_n": 5}]}
    ]));
    let expected = [[1, 30], [1, 10], [1, 20], [2, 30], [2, 10], [2, 20]];
    assert_eq!(found.len(), 7);
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found, &expected.map(Value::from));
    }
    assert_eq!(found[6], [json!(5)]);
}

#[test]
fn a_single_value_and_a_list_as_value_are_axes() {
    let found = points(json!([{"grid": {"connection": "linear", "vehicle.track_y_m": [[-1.4, 1.4], [1, 3]]}}]));
    assert_eq!(
        found,
        [[json!("linear"), json!([-1.4, 1.4])], [json!("linear"), json!([1, 3])]]
    );
}

#[test]
fn axes_of_a_zip_go_together_and_one_value_stands_for_all() {
    let zip = json!({"connection": "linear", "speed_m_s": [3, 1, 2], "load_n": {"linspace": [10, 30, 3]},
                     "vehicle.track_y_m": [[1]]});
    let expected = [(3, 10), (1, 20), (2, 30)].map(|(v, p)| [json!("linear"), json!(v), json!(p), json!([1])]);
    assert_eq!(points(json!([{ "zip": zip }])), expected);
    assert_eq!(points(json!([{"zip": {"load_n": 5}}])), [[json!(5)]]);
    let uneven = json!({"load_n": 5, "speed_m_s": [1, 2, 3], "gap_tension_m": [0, 0.01]});
    is_refused(
        json!({ "zip": uneven }),
        ".zip.gap_tension_m",
        "2 values",
        "3 values, as many as speed_m_s has, or one",
    );
}

#[test]
fn what_is_no_axis_is_refused_by_key() {
    for (grid, key) in [
        (json!({"speed_m_s": []}), ".grid.speed_m_s"),
        (json!({"speed_m_s": null}), ".grid.speed_m_s"),
        (json!({"speed_m_s": {"linspace": [1, 2]}}), ".grid.speed_m_s.linspace"),
        (
            json!({"speed_m_s": {"linspace": [1, 2, 1.5]}}),
            ".grid.speed_m_s.linspace",
        ),
        (
            json!({"speed_m_s": {"geomspace": [0, 2, 3]}}),
            ".grid.speed_m_s.geomspace",
        ),
        (
            json!({"speed_m_s": {"linspace": [1, 2, 1e9]}}),
            ".grid.speed_m_s.linspace",
        ),
        (json!({"analysis.kind": ["static"]}), ".grid.analysis.kind"),
        (
            json!({"bridge.connectors.gap_tension_m": [0], "gap_tension_m": [0]}),
            ".grid.gap_tension_m",
        ),
        (
            json!({"vehicle.track_y_m[0]": [1], "vehicle.track_y_m": [[1]]}),
            ".grid.vehicle.track_y_m",
        ),
        (json!({"bridge.a[": [1]}), ".grid.bridge.a["),
    ] {
        is_refused(json!({"zip": grid.clone()}), &key.replace("grid", "zip"), "", "");
        is_refused(json!({ "grid": grid }), key, "", "");
    }
    assert_eq!(read(json!([])).unwrap_err().path, "design");
    is_refused(json!({"cases": []}), ".cases", "an empty list", "at least one case");
}

#[test]
fn designs_beyond_counting_are_refused_at_once() {
    let million = json!({"linspace": [1, 2, 1_000_000]});
    let long = json!({"latin_hypercube": {"count": 6_000_000, "seed": 1, "ranges": {"speed_m_s": [1, 2]}}});
    let all = json!({"grid": {"speed_m_s": million, "load_n": million, "gap_tension_m": million, "load_x_m": million},
                     "where": {"speed_m_s": 0}});
    for (designs, found) in [
        (
            json!([{"grid": {"speed_m_s": million, "load_n": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]}}]),
            "11000000 points",
        ),
        (json!([all]), "1.0e24 points"),
        (json!([long, long]), "12000000 points"),
    ] {
        let e = read(designs).unwrap_err();
        assert_eq!(
            (e.path.as_str(), e.found.text().as_str(), e.allowed.as_str()),
            ("design", found, "at most 10000000 points"),
            "{e}"
        );
    }
}

#[test]
fn an_unknown_name_is_refused_with_the_nearest() {
    for (name, nearest) in [
        ("sped_m_s", "speed_m_s"),
        ("hydrostatic_stiffness_pa_m", "bridge.hydrostatic_stiffness_pa_m"),
        ("brige.hydrostatic_stiffness_pa_m", "bridge.hydrostatic_stiffness_pa_m"),
    ] {
        let sample = json!({"count": 2, "seed": 1, "ranges": {name: [1, 2]}});
        for design in [
            json!({"grid": {name: [1]}}),
            json!({"zip": {name: [1]}}),
            json!({"cases": [{name: 1}]}),
            json!({ "latin_hypercube": sample }),
            json!({ "sobol": sample }),
        ] {
            let e = refused(design);
            assert_eq!(e.nearest.as_deref(), Some(nearest), "{e}");
            assert!(e.path.ends_with(name), "{e}");
        }
    }
    let e = refused(json!({"grid": {"speed_m_s": {"linspce": [1, 2, 3]}}}));
    assert_eq!(e.nearest.as_deref(), Some("linspace"));
    let e = refused(json!({"gird": {}}));
    assert_eq!(
        (e.path.as_str(), e.nearest.as_deref()),
        ("design[0].gird", Some("grid"))
    );
}

#[test]
fn a_design_has_one_form() {
    let allowed = "exactly one of grid, zip, cases, latin_hypercube, sobol, saltelli, morris";
    is_refused(json!({}), "", "none of them", allowed);
    is_refused(json!({"grid": null}), "", "none of them", allowed);
    is_refused(json!({"where": {"load_n": 1}}), "", "none of them", allowed);
    is_refused(
        json!({"zip": {"load_n": 1}, "grid": {"load_n": 1}}),
        "",
        "grid and zip",
        allowed,
    );
}

#[test]
fn samples_draw_ranges_and_repeat_constants() {
    for form in ["latin_hypercube", "sobol"] {
        let ranges = json!({"connection": "linear", "speed_m_s": [2, 20], "load_n": 5e4, "gap_tension_m": [0, 0.04],
                            "analysis.supports": true});
        let design = json!({form: {"count": 100, "seed": 1, "ranges": ranges}});
        let found = points(json!([design]));
        assert_eq!(found.len(), 100);
        for point in &found {
            assert_eq!(
                (&point[0], &point[2], &point[4]),
                (&json!("linear"), &json!(50000), &json!(true))
            );
            let (speed, gap) = (point[1].as_f64().unwrap(), point[3].as_f64().unwrap());
            assert!(
                (2.0..=20.0).contains(&speed) && (0.0..=0.04).contains(&gap),
                "{point:?}"
            );
        }
        let names: Vec<String> = read(json!([design])).unwrap()[0]
            .axes
            .iter()
            .map(|axis| axis.name.clone())
            .collect();
        assert_eq!(
            names,
            [
                "connection",
                "speed_m_s",
                "load_n",
                "gap_tension_m",
                "analysis.supports"
            ]
        );
    }
}

#[test]
fn what_is_no_sample_is_refused_by_key() {
    for form in ["latin_hypercube", "sobol"] {
        let at = |count: Value, ranges: Value, key: &str, found: &str, allowed: &str| {
            let design = json!({form: {"count": count, "seed": 1, "ranges": ranges}});
            is_refused(design, &format!(".{form}.{key}"), found, allowed);
        };
        let ranges = json!({"speed_m_s": [2, 20]});
        let counts = "a whole number from 1 to 10000000";
        at(json!(0), ranges.clone(), "count", "0", counts);
        at(
            json!(1_000_000_000_000_u64),
            ranges.clone(),
            "count",
            "1000000000000",
            counts,
        );
        at(json!(1.5), ranges.clone(), "count", "1.5", "a whole number");
        at(json!(1e30), ranges, "count", "1e+30", "a whole number");
        at(json!(2), json!({}), "ranges", "no range", "at least one axis");
        at(
            json!(2),
            json!({"load_n": 1e5}),
            "ranges",
            "no range",
            "at least one axis",
        );
        at(json!(2), json!([]), "ranges", "a list", "an object");
        let pair = "two numbers with from below to";
        for (written, allowed) in [
            (json!([20, 2]), pair),
            (json!([2, 2]), pair),
            (json!([2]), pair),
            (json!([2, 3, 4]), pair),
            (json!([2, "20"]), pair),
            (json!([]), pair),
            (json!(null), pair),
            (json!({"from": 2, "to": 20}), pair),
            (json!([-1.7e308, 1.7e308]), "ends that are not so far apart"),
            (json!({"whole": [2, 2.5]}), "two whole numbers with from below to"),
            (json!({"whole": [3, 2]}), "two whole numbers with from below to"),
            (json!({"values": []}), "a list of at least one value"),
            (json!({"vales": [1]}), "whole, values"),
        ] {
            let inner = written.as_object().filter(|map| map.len() == 1);
            let inner = inner
                .and_then(|map| map.keys().next())
                .map_or(String::new(), |key| format!(".{key}"));
            at(
                json!(2),
                json!({"speed_m_s": written}),
                &format!("ranges.speed_m_s{inner}"),
                "",
                allowed,
            );
        }
        at(
            json!(2),
            json!({"connection": ["linear", "nonlinear"], "speed_m_s": [2, 20]}),
            "ranges.connection",
            "[\"linear\",\"nonlinear\"]",
            "linear or nonlinear, the same for all points",
        );
        at(
            json!(2),
            json!({"bridge.connectors.gap_tension_m": [0, 1], "gap_tension_m": [0, 1]}),
            "ranges.gap_tension_m",
            "an axis that sets what",
            "one of the two",
        );
        for (key, allowed) in [("seed", "a whole number of at least 0"), ("count", "a whole number")] {
            let mut design = json!({form: {"count": 2, "seed": 1, "ranges": {"load_n": [1, 2]}}});
            design[form][key] = json!(-1);
            is_refused(design, &format!(".{form}.{key}"), "-1", allowed);
        }
        let design = json!({form: {"count": 2, "ranges": {"load_n": [1, 2]}}});
        is_refused(design, &format!(".{form}.seed"), "missing key `seed` (required)", "");
    }
}

#[test]
fn sobol_points_have_a_limit_of_ranges() {
    let ranges = |n: usize| -> Value {
        let all = (0..n).map(|i| (format!("bridge.a.b{i}"), json!([0, 1])));
        json!({"sobol": {"count": 2, "seed": 1, "ranges": all.collect::<serde_json::Map<_, _>>()}})
    };
    assert_eq!(points(json!([ranges(100)]))[1].len(), 100);
    is_refused(ranges(101), ".sobol.ranges", "101 ranges", "at most 100 ranges");
}

#[test]
fn a_latin_hypercube_has_a_limit_of_points_and_ranges() {
    let ranges: serde_json::Map<_, _> = (0..11).map(|i| (format!("bridge.a.b{i}"), json!([0, 1]))).collect();
    let design = |count: usize| json!({"latin_hypercube": {"count": count, "seed": 1, "ranges": ranges}});
    is_refused(
        design(10_000_000),
        ".latin_hypercube.count",
        "10000000 points of 11 ranges",
        "at most 9090909 points of so many ranges",
    );
    assert_eq!(read(json!([design(9_090_909)])).unwrap()[0].len(), 9_090_909);
}

#[test]
fn a_longer_sobol_design_begins_with_the_points_of_a_shorter_one() {
    let design = |count: usize| json!({"sobol": {"count": count, "seed": 5, "ranges": {"speed_m_s": [2, 20], "load_n": [1, 9]}}});
    // beyond the 2^16 points of some generators
    let long = numbers(design(100_000));
    assert_eq!(long.len(), 100_000);
    for count in [1, 2, 63, 64, 1000] {
        assert_eq!(numbers(design(count)), long[..count]);
    }
    let mut parts: Vec<usize> = long[..65_536]
        .iter()
        .map(|p| ((p[0] - 2.0) / 18.0 * 65_536.0) as usize)
        .collect();
    parts.sort_unstable();
    assert_eq!(parts, (0..65_536).collect::<Vec<_>>());
}

#[test]
fn conditions_compare_axes_and_leave_the_others_out() {
    let gaps = json!([0, 0.005, 0.01]);
    let grid = json!({"gap_tension_m": gaps, "gap_compression_m": gaps});
    let met = |condition: Value| -> Vec<[usize; 2]> {
        let design = json!({"grid": grid, "where": condition});
        let place = |x: f64| (x / 0.005).round() as usize;
        numbers(design).iter().map(|p| [place(p[0]), place(p[1])]).collect()
    };
    let all = |holds: fn(usize, usize) -> bool| -> Vec<[usize; 2]> {
        let pairs = (0..3).flat_map(|a| (0..3).map(move |b| [a, b]));
        pairs.filter(|[a, b]| holds(*a, *b)).collect()
    };
    let other = "gap_compression_m";
    assert_eq!(met(json!({"gap_tension_m": {"at_least": other}})), all(|a, b| a >= b));
    assert_eq!(met(json!({"gap_tension_m": {"at_most": other}})), all(|a, b| a <= b));
    assert_eq!(met(json!({"gap_tension_m": {"above": other}})), all(|a, b| a > b));
    assert_eq!(met(json!({"gap_tension_m": {"below": other}})), all(|a, b| a < b));
    assert_eq!(
        met(json!({"gap_tension_m": {"above": other, "to": 0.005}, "gap_compression_m": [0, 7]})),
        [[1, 0]]
    );
    // by the path that the short name stands for
    assert_eq!(
        met(json!({"bridge.connectors.gap_tension_m": 0.01})),
        all(|a, _| a == 2)
    );
}

#[test]
fn cases_without_an_axis_of_a_condition_have_null_there() {
    let cases = json!([{"load_n": 1, "speed_m_s": 3}, {"load_n": 2}, {"load_n": 3, "speed_m_s": 5}]);
    let left = |condition: Value| -> Vec<Value> {
        let points = points(json!([{"cases": cases, "where": condition}]));
        points.into_iter().map(|mut point| point.remove(0)).collect()
    };
    assert_eq!(left(json!({"speed_m_s": {"from": 4}})), [3]);
    assert_eq!(left(json!({"speed_m_s": [3, null]})), [1, 2]);
    assert_eq!(left(json!({"speed_m_s": {"at_least": "load_n"}})), [1, 3]);
    let blocks = read(json!([{"cases": cases, "where": {"load_n": {"from": 3}}}])).unwrap();
    assert_eq!(blocks.len(), 1);
    let keys: Vec<_> = blocks[0].points().map(|point| point.key().into_owned()).collect();
    assert_eq!(keys, ["design[0].cases[2]"]);
}

#[test]
fn what_is_no_condition_is_refused_by_key() {
    let at = |condition: Value, key: &str, found: &str, allowed: &str| {
        let design = json!({"grid": {"speed_m_s": [1, 2], "load_n": [1, 2]}, "where": condition});
        is_refused(design, &format!(".where{key}"), found, allowed);
    };
    at(
        json!({"sped_m_s": 1}),
        ".sped_m_s",
        "unknown key `sped_m_s`",
        "speed_m_s, load_n",
    );
    at(
        json!({"gap_tension_m": 1}),
        ".gap_tension_m",
        "unknown",
        "speed_m_s, load_n",
    );
    at(
        json!({"speed_m_s": {"at_least": "lod_n"}}),
        ".speed_m_s.at_least",
        "unknown \"lod_n\"",
        "speed_m_s, load_n",
    );
    at(
        json!({"speed_m_s": {"at_lest": "load_n"}}),
        ".speed_m_s.at_lest",
        "unknown key `at_lest`",
        "at_least",
    );
    at(
        json!({"speed_m_s": {"above": 1}}),
        ".speed_m_s",
        "1 as above",
        "the name of another axis",
    );
    at(json!({"speed_m_s": []}), ".speed_m_s", "an empty list", "a value");
    at(
        json!({"speed_m_s": {"from": 2, "to": 1}}),
        ".speed_m_s",
        "a range from 2 to 1",
        "from at most to",
    );
    at(
        json!({"speed_m_s": 3}),
        "",
        "no point is left",
        "at least one of the 4 points",
    );
    at(
        json!({"speed_m_s": {"above": "speed_m_s"}}),
        "",
        "no point is left",
        "at least one of the 4 points",
    );
    let e = refused(json!({"grid": {"speed_m_s": [1, 2]}, "where": {"sped_m_s": 1}}));
    assert_eq!(e.nearest.as_deref(), Some("speed_m_s"));
}

/// A list of numbers as an axis, all different.
fn axis() -> impl Strategy<Value = Vec<i32>> {
    proptest::collection::hash_set(-50..50, 1..6).prop_map(|set| set.into_iter().collect())
}

proptest! {
    #[test]
    fn a_grid_has_every_combination_once_in_the_order_of_its_axes(axes in proptest::collection::vec(axis(), 1..4)) {
        let names = ["speed_m_s", "load_n", "gap_tension_m"];
        let grid: serde_json::Map<_, _> = names.iter().zip(&axes).map(|(n, a)| ((*n).to_owned(), json!(a))).collect();
        let mut expected: Vec<Vec<i32>> = vec![Vec::new()];
        for axis in &axes {
            expected = expected.iter().flat_map(|point| axis.iter().map(|x| [point.clone(), vec![*x]].concat())).collect();
        }
        let expected: Vec<Vec<f64>> = expected.into_iter().map(|p| p.into_iter().map(f64::from).collect()).collect();
        prop_assert_eq!(numbers(json!({ "grid": grid })), expected);
    }

    #[test]
    fn a_zip_pairs_values_by_their_places(pairs in proptest::collection::vec((-50..50, -50..50), 1..30), single in 1..9) {
        let (a, b): (Vec<i32>, Vec<i32>) = pairs.iter().copied().unzip();
        let found = numbers(json!({"zip": {"speed_m_s": a, "load_x_m": single, "load_n": b}}));
        let expected: Vec<Vec<f64>> = pairs.iter().map(|&(a, b)| [a, single, b].map(f64::from).to_vec()).collect();
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn a_latin_hypercube_hits_each_part_of_each_range_once(
        count in 1_usize..200, seed: u64, (low, wide) in (-100.0..100.0_f64, 0.5..100.0_f64),
    ) {
        let ranges = json!({"speed_m_s": [low, low + wide], "load_n": 7, "gap_tension_m": [0, 1]});
        let found = numbers(json!({"latin_hypercube": {"count": count, "seed": seed, "ranges": ranges}}));
        prop_assert_eq!(found.len(), count);
        for (axis, from, span) in [(0, low, low + wide - low), (2, 0.0, 1.0)] {
            let part = |p: &Vec<f64>| ((p[axis] - from) / span * count as f64) as usize;
            let mut parts: Vec<usize> = found.iter().map(part).collect();
            parts.sort_unstable();
            prop_assert_eq!(parts, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn samples_of_a_seed_are_the_same_and_of_another_seed_others(count in 4_usize..50, seed: u64) {
        for form in ["latin_hypercube", "sobol"] {
            let found = |seed: u64| {
                numbers(json!({form: {"count": count, "seed": seed, "ranges": {"speed_m_s": [2, 20], "load_n": [0, 9]}}}))
            };
            let first = found(seed);
            prop_assert_eq!(&first, &found(seed));
            let other = found(seed.wrapping_add(1));
            prop_assert!(first.iter().zip(&other).all(|(a, b)| a[0] != b[0] || a[1] != b[1]));
        }
    }

    #[test]
    fn the_axis_beside_another_does_not_change_it(count in 2_usize..50, seed: u64) {
        let found = |form: &str, ranges: Value| numbers(json!({form: {"count": count, "seed": seed, "ranges": ranges}}));
        // of a sequence, an axis that stands behind the other in the alphabet
        for (form, beside) in [("latin_hypercube", "load_n"), ("sobol", "vehicle.footprint_length_m")] {
            let (alone, both) = (
                found(form, json!({"speed_m_s": [2, 20]})),
                found(form, json!({"speed_m_s": [2, 20], beside: [0, 9]})),
            );
            prop_assert!(alone.iter().zip(&both).all(|(alone, both)| alone[0] == both[0]));
        }
    }

    #[test]
    fn the_order_of_ranges_does_not_change_the_points(count in 2_usize..50, seed: u64) {
        for form in ["latin_hypercube", "sobol"] {
            let found = |ranges: Value| numbers(json!({form: {"count": count, "seed": seed, "ranges": ranges}}));
            let first = found(json!({"speed_m_s": [2, 20], "load_n": [0, 9], "connection": 1, "gap_tension_m": [0, 1]}));
            let last = found(json!({"gap_tension_m": [0, 1], "load_n": [0, 9], "speed_m_s": [2, 20], "connection": 1}));
            for (a, b) in first.iter().zip(&last) {
                prop_assert_eq!([a[0], a[1], a[2], a[3]], [b[2], b[1], b[3], b[0]]);
            }
        }
    }

    #[test]
    fn whole_numbers_and_values_are_drawn_evenly(times in 1_usize..20, seed: u64) {
        for form in ["latin_hypercube", "sobol"] {
            // as many points as a power of two times the number of values
            let count = if form == "sobol" { 64 } else { 4 * times };
            let ranges = json!({"bridge.modules": {"whole": [3, 6]}, "load_position": [1, 4],
                                "connection": {"values": ["linear", "nonlinear", "nonlinear", "linear"]},
                                "speed_m_s": {"values": [5, 10, 12.5, 20]}});
            let found = points(json!([{form: {"count": count, "seed": seed, "ranges": ranges}}]));
            for (axis, value) in [(0, json!(3)), (0, json!(6)), (1, json!(1)), (1, json!(4)), (3, json!(12.5))] {
                let times = found.iter().filter(|point| point[axis] == value).count();
                prop_assert_eq!(times, count / 4, "{} {} {}", form, axis, value);
            }
            let linear = found.iter().filter(|point| point[2] == "linear").count();
            prop_assert_eq!(linear, count / 2);
        }
    }

    #[test]
    fn two_names_of_an_axis_draw_the_same_points(count in 2_usize..50, seed: u64) {
        for form in ["latin_hypercube", "sobol"] {
            let found = |gap: &str| {
                numbers(json!({form: {"count": count, "seed": seed, "ranges": {gap: [0, 1], "load_n": [0, 9]}}}))
            };
            prop_assert_eq!(found("gap_tension_m"), found("bridge.connectors.gap_tension_m"));
        }
    }

    #[test]
    fn conditions_hold_for_every_point_and_leave_no_other_out(
        from in 0..7, listed in proptest::collection::vec(0..5, 1..4), seed: u64,
        relation in prop_oneof![Just("at_least"), Just("at_most"), Just("above"), Just("below")],
    ) {
        let ten: Vec<i32> = (0..10).collect();
        let grid = json!({"grid": {"speed_m_s": ten, "load_n": ten, "load_x_m": [0, 1, 2, 3, 4]}});
        let ranges = json!({"speed_m_s": [0, 9], "load_n": [0, 9], "load_x_m": 1});
        let drawn = json!({"sobol": {"count": 500, "seed": seed, "ranges": ranges}});
        let listed = if listed.contains(&1) { listed } else { [listed, vec![1]].concat() };
        let conditions = json!({"speed_m_s": {relation: "load_n", "from": from}, "load_x_m": listed});
        for mut design in [grid, drawn] {
            let all = numbers(design.clone());
            design["where"] = conditions.clone();
            let meets = |p: &&Vec<f64>| {
                let stands = match relation {
                    "at_least" => p[0] >= p[1],
                    "at_most" => p[0] <= p[1],
                    "above" => p[0] > p[1],
                    _ => p[0] < p[1],
                };
                stands && p[0] >= f64::from(from) && listed.iter().any(|x| f64::from(*x) == p[2])
            };
            let expected: Vec<Vec<f64>> = all.iter().filter(meets).cloned().collect();
            prop_assert!(!expected.is_empty());
            prop_assert_eq!(numbers(design), expected);
        }
    }
}
