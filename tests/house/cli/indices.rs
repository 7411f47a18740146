//! Designs of Saltelli and Morris, and `pontoon indices`, from a study to its indices.

use super::refusals::study;
use crate::stage::{Stage, is_refused, stderr, stdout};
use serde_json::{Value, json};
use std::fs;

/// The smoke bridge under crossings at the points of some designs.
fn stage(designs: Value) -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": 0.02, "tail_s": 1.0 });
    stage.study["record"] = json!({});
    stage.study["design"] = designs;
    stage
}

fn ranges() -> Value {
    json!({ "speed_m_s": [4, 16], "load_n": [1e5, 3e5], "gap_tension_m": 0.02 })
}

fn saltelli(second_order: bool) -> Value {
    json!({ "saltelli": { "count": 16, "seed": 1, "ranges": ranges(), "second_order": second_order } })
}

/// So many levels that no two points are equal.
fn morris() -> Value {
    json!({ "morris": { "trajectories": 6, "levels": 100, "seed": 1, "ranges": ranges() } })
}

/// The object of `pontoon indices` of the results in `r`, with its exit status.
fn indices(stage: &Stage, words: &[&str]) -> (Option<i32>, Value) {
    let output = stage.pontoon(&[&["indices", "r", "--format", "json"], words].concat());
    let text = stdout(&output);
    let found = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}{}", stderr(&output)));
    (output.status.code(), found)
}

const OF: [&str; 2] = ["--of", "peak_deflection_m"];

fn numbers(factors: &Value, key: &str) -> Vec<f64> {
    let factors = factors.as_array().unwrap().iter();
    factors.map(|factor| factor[key].as_f64().unwrap()).collect()
}

/// First orders and totals of groups of four outputs, A, AB of two factors and B, by the formulas with no normalisation but the mean.
fn by_hand(groups: &[&[f64]]) -> ([f64; 2], [f64; 2]) {
    let all: Vec<f64> = groups.iter().flat_map(|group| group.iter().copied()).collect();
    let centre = all.iter().sum::<f64>() / all.len() as f64;
    let mean = |of: &dyn Fn(&[f64]) -> f64| groups.iter().map(|group| of(group)).sum::<f64>() / groups.len() as f64;
    let of_both = mean(&|y| 0.5 * (y[0] + y[3]));
    let variance = mean(&|y| 0.5 * ((y[0] - of_both).powi(2) + (y[3] - of_both).powi(2)));
    let s1 = [1, 2].map(|ab| mean(&|y| (y[3] - centre) * (y[ab] - y[0])) / variance);
    let st = [1, 2].map(|ab| 0.5 * mean(&|y| (y[0] - y[ab]).powi(2)) / variance);
    (s1, st)
}

fn assert_near(found: &[f64], expected: &[f64]) {
    let near = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() < 1e-11 * b.abs().max(1.0));
    assert!(near && found.len() == expected.len(), "{found:?} {expected:?}");
}

#[test]
fn rows_stand_as_the_designs_say_and_indices_are_those_of_the_rows() {
    let stage = stage(json!([saltelli(false), morris()]));
    stage.ran("r");
    let (status, found) = indices(&stage, &OF);
    assert_eq!(status, Some(0));
    let y: Vec<f64> = stage
        .numbers("r/jobs.parquet", "peak_deflection_m")
        .into_iter()
        .map(Option::unwrap)
        .collect();
    let speed = stage.numbers("r/jobs.parquet", "speed_m_s");
    let load = stage.numbers("r/jobs.parquet", "load_n");
    for row in (0..64).step_by(4) {
        let point = |at: usize| (speed[row + at], load[row + at]);
        let (a, b) = (point(0), point(3));
        assert_eq!((point(1), point(2)), ((b.0, a.1), (a.0, b.1)));
    }
    let of_saltelli = &found["designs"][0];
    assert_eq!(of_saltelli["design"], "design[0].saltelli");
    assert_eq!(of_saltelli["factors"], json!(["speed_m_s", "load_n"]));
    assert_eq!(
        (&of_saltelli["groups"], &of_saltelli["points"]),
        (&json!(16), &json!(4))
    );
    let factors = &of_saltelli["outputs"][0]["indices"]["sobol"]["factors"];
    let (s1, st) = by_hand(&y[..64].chunks(4).collect::<Vec<_>>());
    assert_near(&numbers(factors, "s1"), &s1);
    assert_near(&numbers(factors, "st"), &st);
    // the bridge is nearly linear in the load: it has most of the variance
    assert!(
        st[1] > 0.5 && numbers(factors, "st_conf").iter().all(|conf| *conf > 0.0),
        "{st:?}"
    );
    let of_morris = &found["designs"][1];
    let effects: Vec<(f64, f64)> = (64..82)
        .step_by(3)
        .map(|row| {
            let effect = |axis: &[Option<f64>]| {
                let at = (row..row + 2).find(|&at| axis[at] != axis[at + 1]).unwrap();
                (y[at + 1] - y[at]) * (axis[at + 1].unwrap() - axis[at].unwrap()).signum() * 1.98
            };
            (effect(&speed), effect(&load))
        })
        .collect();
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| effects.iter().map(of).sum::<f64>() / 6.0;
    let mu = [mean(&|e| e.0), mean(&|e| e.1)];
    let sigma = [mean(&|e| (e.0 - mu[0]).powi(2)), mean(&|e| (e.1 - mu[1]).powi(2))].map(|v| (1.2 * v).sqrt());
    let factors = &of_morris["outputs"][0]["indices"]["morris"]["factors"];
    assert_near(&numbers(factors, "mu"), &mu);
    assert_near(
        &numbers(factors, "mu_star"),
        &[mean(&|e| e.0.abs()), mean(&|e| e.1.abs())],
    );
    assert_near(&numbers(factors, "sigma"), &sigma);
}

#[test]
fn all_measures_are_told_in_a_table_and_seeds_move_intervals_alone() {
    let stage = stage(json!([saltelli(true), morris()]));
    stage.ran("r");
    let told = stdout(&stage.pontoon(&["indices", "r"]));
    let begins = "design[0].saltelli: 16 groups of 6 points, 2 factors; intervals from 1000 resamples, seed 1\n\n\
                  peak_deflection_m: 16 of 16 groups, 0 left out\n\
                  factor";
    assert!(told.starts_with(begins), "{told}");
    for word in [
        "s1_conf",
        "speed_m_s x load_n",
        "mu_star_conf",
        "design[1].morris: 6 groups of 3 points",
        "dynamic_amplification: ",
    ] {
        assert!(told.contains(word), "no {word}: {told}");
    }
    // columns without a number are no outputs unless asked for
    assert!(!told.contains("influential_length_m"), "{told}");
    let (_, empty) = indices(&stage, &["--of", "influential_length_m"]);
    let output = &empty["designs"][0]["outputs"][0];
    assert_eq!((&output["left_out"], &output["indices"]), (&json!(16), &Value::Null));
    let told = stdout(&stage.pontoon(&["indices", "r", "--of", "influential_length_m"]));
    assert!(
        told.contains("influential_length_m: 0 of 16 groups, 16 left out\nno indices: "),
        "{told}"
    );
    let factors = |words: &[&str]| {
        let (_, found) = indices(&stage, &[&OF, words].concat());
        let of = |design: usize, form: &str| found["designs"][design]["outputs"][0]["indices"][form].clone();
        (of(0, "sobol"), of(1, "morris"))
    };
    let (one, other) = (
        factors(&["--seed", "1"]),
        factors(&["--seed", "2", "--resamples", "50"]),
    );
    assert_eq!(one, factors(&[]));
    for key in ["s1", "st"] {
        assert_eq!(numbers(&one.0["factors"], key), numbers(&other.0["factors"], key));
    }
    for key in ["s1_conf", "st_conf"] {
        assert_ne!(numbers(&one.0["factors"], key), numbers(&other.0["factors"], key));
    }
    assert_eq!(one.0["pairs"][0]["axes"], json!(["speed_m_s", "load_n"]));
    assert_eq!(one.0["pairs"][0]["s2"], other.0["pairs"][0]["s2"]);
    assert_ne!(one.1, other.1);
}

/// A row of the base sample with a failed job is left out with all of its points, and so is a trajectory: the indices are those of
/// the others.
#[test]
fn groups_with_failed_jobs_are_left_out_and_counted() {
    let mut stage = stage(json!([saltelli(false), morris()]));
    // a slow crossing takes more steps
    stage.study["analysis"]["step_limit"] = json!(180);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let y = stage.numbers("r/jobs.parquet", "peak_deflection_m");
    let (status, found) = indices(&stage, &OF);
    assert_eq!(status, Some(1));
    let whole: Vec<Vec<f64>> = y[..64]
        .chunks(4)
        .filter_map(|group| group.iter().copied().collect())
        .collect();
    assert!((4..16).contains(&whole.len()), "{}", whole.len());
    let of_saltelli = &found["designs"][0];
    let output = &of_saltelli["outputs"][0];
    assert_eq!(of_saltelli["failed"], json!(16 - whole.len()));
    assert_eq!(output["left_out"], json!(16 - whole.len()));
    let (s1, st) = by_hand(&whole.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let factors = &output["indices"]["sobol"]["factors"];
    assert_near(&numbers(factors, "s1"), &s1);
    assert_near(&numbers(factors, "st"), &st);
    let of_morris = &found["designs"][1];
    let left_out = y[64..]
        .chunks(3)
        .filter(|walk| walk.iter().any(Option::is_none))
        .count();
    assert!((1..6).contains(&left_out), "{left_out}");
    assert_eq!(of_morris["outputs"][0]["left_out"], json!(left_out));
    let told = stdout(&stage.pontoon(&["indices", "r"]));
    assert!(
        told.contains(&format!("\n{} groups with a failed job\n", 16 - whole.len())),
        "{told}"
    );
    assert!(
        told.contains(&format!(
            "peak_tension_n: {} of 16 groups, {} left out",
            whole.len(),
            16 - whole.len()
        )),
        "{told}"
    );
}

/// Points that are equal are one job with one row; their indices are found all the same. A gap has no effect where the connection is
/// linear, so that it has no share at all.
#[test]
fn equal_points_share_a_row() {
    let ranges = json!({ "connection": "linear", "gap_tension_m": [0, 0.03], "load_n": [1e5, 3e5], "speed_m_s": 8 });
    let mut stage = stage(json!([
        { "cases": [{ "connection": "linear", "load_n": 1e5, "speed_m_s": 8 }] },
        { "saltelli": { "count": 8, "seed": 1, "ranges": ranges } },
        { "morris": { "trajectories": 8, "seed": 1, "ranges": ranges } },
    ]));
    stage.study["vehicle"]["inertia"] = json!("none");
    stage.ran("r");
    // one case, of each row A and B, and four levels less the load of the case
    assert_eq!(stage.table("r/jobs.parquet").height(), 1 + 16 + 3);
    let (status, found) = indices(&stage, &OF);
    assert_eq!(status, Some(0));
    let sobol = &found["designs"][0]["outputs"][0]["indices"]["sobol"]["factors"];
    assert_eq!(
        (sobol[0]["s1"].as_f64(), sobol[0]["st"].as_f64()),
        (Some(0.0), Some(0.0))
    );
    let morris = &found["designs"][1]["outputs"][0]["indices"]["morris"]["factors"];
    assert_eq!(morris[0]["mu_star"].as_f64(), Some(0.0));
    // without the vehicle's mass the bridge is linear: the effect of the load is the deflection of 200 kN
    let y = stage.numbers("r/jobs.parquet", "peak_deflection_m")[0].unwrap();
    let (mu, sigma) = (morris[1]["mu"].as_f64().unwrap(), morris[1]["sigma"].as_f64().unwrap());
    assert!(
        (mu / (2.0 * y) - 1.0).abs() < 1e-9 && sigma < 1e-9 * mu,
        "{mu} {sigma} {y}"
    );
    assert!((mu / (2.1 * y) - 1.0).abs() > 1e-9);
}

#[test]
fn ratings_have_indices_of_what_is_rated() {
    let mut stage = stage(
        json!([{ "morris": { "trajectories": 2, "seed": 2, "ranges": { "speed_m_s": [4, 8], "gap_tension_m": [0, 0.03] } } }]),
    );
    stage.study["analysis"]["kind"] = json!("rating");
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.15 });
    stage.study["find"] = json!({ "largest": "load_n", "between": [5e4, 4e5], "ladder_ratio": 1.2 });
    stage.ran("r");
    let (status, found) = indices(&stage, &[]);
    let output = &found["designs"][0]["outputs"][0];
    assert_eq!(
        (status, &output["column"], &output["left_out"]),
        (Some(0), &json!("rated_value"), &json!(0))
    );
}

#[test]
fn results_that_have_no_indices_are_refused() {
    let mut stage = stage(json!([{ "grid": { "load_n": [1e5, 2e5], "speed_m_s": 10 } }]));
    stage.ran("r");
    let of = |stage: &Stage, words: &[&str]| stage.pontoon(&[&["indices", "r"], words].concat());
    is_refused(
        &of(&stage, &[]),
        &[
            "r/manifest.json: design: found neither saltelli nor morris",
            "allowed: a study with a design of either",
        ],
    );
    is_refused(
        &stage.pontoon(&["indices", "nowhere"]),
        &["nowhere: found no such folder"],
    );
    stage.study["design"] = json!([saltelli(false)]);
    stage
        .write()
        .pontoon(&["run", "study.json", "--out", "r", "--quiet", "--fresh"]);
    is_refused(
        &of(&stage, &["--of", "peak_deflection"]),
        &[
            "--of: found unknown \"peak_deflection\" (nearest known: peak_deflection_m)",
            "peak_compression_n",
        ],
    );
    is_refused(
        &of(&stage, &["--of", "speed_m_s"]),
        &[
            "--of: found \"speed_m_s\", which is no output of numbers",
            "peak_deflection_m, ",
        ],
    );
    for words in [["--resamples", "1"], ["--seed", "-1"]] {
        assert_eq!(of(&stage, &words).status.code(), Some(2), "{words:?}");
    }
}

/// Rows under the documents of another study, which has as many points.
#[test]
fn rows_of_another_study_are_told() {
    let mut stage = stage(json!([saltelli(false)]));
    stage.ran("r");
    stage.study["design"][0]["saltelli"]["seed"] = json!(2);
    stage.ran("other");
    let (mut manifest, other) = (stage.manifest("r"), stage.manifest("other"));
    let file = other["documents"]["study"]["file"].as_str().unwrap();
    fs::copy(stage.path("other").join(file), stage.path("r").join(file)).unwrap();
    manifest["study_blake3"] = other["study_blake3"].clone();
    manifest["documents"] = other["documents"].clone();
    stage.json("r/manifest.json", &manifest);
    let output = stage.pontoon(&["indices", "r"]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(
        told.contains("a row of job 0 whose speed_m_s is not that of its point"),
        "{told}"
    );
}

#[test]
fn designs_that_no_index_comes_from_are_refused_at_their_key() {
    let bad = |design: Value, key: &str, found: &str, allowed: &str| {
        let message = format!("design[0]{key}: found {found}, allowed: {allowed}");
        study("", "design", json!([design]), &[&message]);
    };
    let with = |mut design: Value, form: &str, key: &str, value: Value| {
        design[form][key] = value;
        design
    };
    let counts = "a whole number from 2 to 10000000";
    bad(
        with(saltelli(false), "saltelli", "count", json!(1)),
        ".saltelli.count",
        "1",
        counts,
    );
    bad(
        with(morris(), "morris", "trajectories", json!(0)),
        ".morris.trajectories",
        "0",
        counts,
    );
    let even = "an even number from 2 to 1000";
    bad(
        with(morris(), "morris", "levels", json!(5)),
        ".morris.levels",
        "5",
        even,
    );
    bad(
        with(morris(), "morris", "levels", json!(1002)),
        ".morris.levels",
        "1002",
        even,
    );
    let constant = json!({ "speed_m_s": 5, "load_n": 1e5 });
    let range = "at least one axis with a range [from, to], whole or values";
    for (design, form) in [(saltelli(false), "saltelli"), (morris(), "morris")] {
        bad(
            with(design.clone(), form, "ranges", constant.clone()),
            &format!(".{form}.ranges"),
            "no range",
            range,
        );
        let mut under_conditions = design;
        under_conditions["where"] = json!({ "speed_m_s": { "from": 5 } });
        let whole = if form == "morris" {
            "a trajectory"
        } else {
            "a row of the base sample"
        };
        bad(
            under_conditions,
            ".where",
            &format!("conditions beside {form}"),
            &format!("none: {whole} is of use only with all of its points"),
        );
    }
    let many: serde_json::Map<_, _> = (0..51).map(|i| (format!("bridge.x{i}"), json!([0, 1]))).collect();
    bad(
        with(saltelli(false), "saltelli", "ranges", many.into()),
        ".saltelli.ranges",
        "51 ranges",
        "at most 50 ranges",
    );
    study(
        "",
        "design",
        json!([with(saltelli(false), "saltelli", "second_orders", json!(true))]),
        &[
            "design[0].saltelli.second_orders: found unknown key",
            "nearest known: second_order",
        ],
    );
    study(
        "",
        "design",
        json!([with(saltelli(false), "saltelli", "count", json!(4_000_000))]),
        &["design: found 16000000 points, allowed: at most 10000000 points"],
    );
}
