//! References that are refused: status 2, one message with file, key path, found and allowed, and nothing written.

use crate::stage::{Stage, is_refused, reference, stderr};
use serde_json::{Value, json};
use std::fs;

/// Results of crossings in `r`, of modes in `m`.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.ran("r");
    let crossing = stage.study.clone();
    stage.study = json!({ "name": "modes", "bridge": "bridge.json", "analysis": { "kind": "modes", "count": 8 },
                          "design": [{ "grid": { "analysis.model": ["super-element"] } }] });
    stage.ran("m");
    stage.study = crossing;
    stage.write();
    stage
}

fn of() -> Value {
    json!({ "select": { "table": "jobs", "column": "peak_deflection_m" } })
}

fn value() -> Value {
    json!({ "of": of(), "expected": 1, "relative_tolerance": 0.1 })
}

fn refuse(stage: &Stage, results: &str, document: &Value, parts: &[&str]) {
    stage.json("reference.json", document);
    let before = stage.names();
    let output = stage.pontoon(&["compare", results, "--with", "reference.json"]);
    is_refused(&output, &[&["reference.json: "], parts].concat());
    assert_eq!(stage.names(), before);
}

/// A check that is refused, alone in its reference; an id is given to it.
fn check(stage: &Stage, results: &str, check: &Value, parts: &[&str]) {
    let mut check = check.clone();
    if check.get("id").is_none() {
        check["id"] = "a".into();
    }
    refuse(stage, results, &reference(&json!([check])), parts);
}

#[test]
fn names_that_the_results_do_not_have() {
    let stage = stage();
    let select =
        |select: Value| json!({ "value": { "of": { "select": select }, "expected": 1, "relative_tolerance": 0.1 } });
    for (results, made, parts) in [
        (
            "r",
            select(json!({ "table": "job", "column": "x_m" })),
            &[
                "checks[0].value.of.select.table: found unknown \"job\"",
                "nearest known: jobs",
            ][..],
        ),
        (
            "r",
            select(json!({ "table": "modes", "column": "frequency_hz" })),
            &[
                "select.table: found \"modes\", which the results do not hold",
                "jobs, positions, connectors, histories",
            ],
        ),
        (
            "r",
            select(json!({ "table": "jobs", "column": "peak_deflecton_m" })),
            &["checks[0].value.of.select.column: ", "nearest known: peak_deflection_m"],
        ),
        (
            "r",
            select(json!({ "table": "jobs", "column": "connection" })),
            &["select.column: found \"connection\", a column of words"],
        ),
        (
            "r",
            select(json!({ "table": "jobs", "column": "steps", "where": { "sped_m_s": 5 } })),
            &["checks[0].value.of.select.where.sped_m_s: ", "nearest known: speed_m_s"],
        ),
        (
            "r",
            json!({ "where": { "conection": "linear" }, "value": value() }),
            &["checks[0].where.conection: ", "nearest known: connection"],
        ),
        (
            "r",
            json!({ "where": { "connection": "nonlinera" }, "value": value() }),
            &[
                "checks[0].where.connection: found unknown \"nonlinera\"",
                "nearest known: nonlinear",
            ],
        ),
        (
            "r",
            json!({ "where": { "connection": ["linear", "nonlinera"] }, "value": value() }),
            &["nearest known: nonlinear"],
        ),
        (
            "r",
            json!({ "where": { "status": "oky" }, "value": value() }),
            &["nearest known: ok"],
        ),
        (
            "r",
            json!({ "where": { "job": 6 }, "value": value() }),
            &["checks[0].where.job: found 6, which is no job, allowed: 0 to 5"],
        ),
        (
            "r",
            json!({ "each": ["speed_m_s", "sped_m_s"], "value": value() }),
            &["checks[0].each[1]: ", "nearest known: speed_m_s"],
        ),
        (
            "r",
            json!({ "each": ["speed_m_s"], "where": { "speed_m_s": 99, "conection": 1 }, "value": value() }),
            &["checks[0].where.conection: "],
        ),
        (
            "r",
            json!({ "trend": { "of": of(), "along": "sped_m_s", "trend": "rises" } }),
            &["checks[0].trend.along: ", "nearest known: speed_m_s"],
        ),
        (
            "r",
            json!({ "trend": { "of": of(), "along": "connection", "trend": "rises" } }),
            &["checks[0].trend.along: found \"connection\", a column of words"],
        ),
        (
            "r",
            json!({ "where": { "speed_m_s": 99 }, "trend": { "of": { "ratio": [of(), { "select": { "table": "jobs", "column": "stepps" } }] }, "along": "speed_m_s", "trend": "rises" } }),
            &["checks[0].trend.of.ratio[1].select.column: ", "nearest known: steps"],
        ),
        (
            "r",
            json!({ "curve": { "table": "positions", "column": "peak", "against": "x_m", "points": [[0, 1]], "relative_tolerance": 0.1 } }),
            &["checks[0].curve.column: "],
        ),
        (
            "r",
            json!({ "curve": { "table": "positions", "column": "x_m", "against": "y_m", "points": [[0, 1]], "relative_tolerance": 0.1 } }),
            &["checks[0].curve.against: ", "nearest known: x_m"],
        ),
        (
            "r",
            json!({ "bound": { "of": { "history": { "quantity": "deflection", "position": 2, "reduce": "max" } }, "at_least": 0 } }),
            &["checks[0].bound.of.history.quantity: ", "nearest known: deflection_m"],
        ),
        (
            "r",
            json!({ "mode": { "shape": "heave", "expected_hz": 1, "relative_tolerance": 0.1 } }),
            &["checks[0].mode: found \"modes\", which the results do not hold"],
        ),
        (
            "m",
            json!({ "mode": { "shape": "torison 1", "expected_hz": 1, "relative_tolerance": 0.1 } }),
            &["checks[0].mode.shape: ", "nearest known: torsion 1"],
        ),
        (
            "m",
            json!({ "bound": { "of": { "history": { "quantity": "force_n", "position": 2, "reduce": "max" } }, "at_least": 0 } }),
            &["checks[0].bound.of.history: found \"histories\", which the results do not hold"],
        ),
    ] {
        check(&stage, results, &made, parts);
    }
}

#[test]
fn numbers_for_words_and_words_for_numbers() {
    let stage = stage();
    for (filter, parts) in [
        (
            json!({ "speed_m_s": "fast" }),
            &["checks[0].where.speed_m_s: found \"fast\", allowed: numbers"][..],
        ),
        (
            json!({ "speed_m_s": [5, true] }),
            &["where.speed_m_s: found true, allowed: numbers"],
        ),
        (
            json!({ "connection": 1 }),
            &["where.connection: found 1, allowed: words"],
        ),
        (
            json!({ "connection": { "to": 1 } }),
            &["where.connection: found a range, allowed: words"],
        ),
        (
            json!({ "speed_m_s": { "from": 7, "to": 3 } }),
            &["where.speed_m_s: found a range from 7 to 3"],
        ),
        (
            json!({ "speed_m_s": { "form": 7 } }),
            &["where.speed_m_s.form: ", "nearest known: from"],
        ),
        (
            json!({ "speed_m_s": { "from": "x" } }),
            &["where.speed_m_s: found \"x\" as from, allowed: a number"],
        ),
        (json!({ "speed_m_s": {} }), &["where.speed_m_s: found an empty object"]),
        (json!({ "speed_m_s": [] }), &["where.speed_m_s: found an empty list"]),
        (
            json!({ "speed_m_s": [[5]] }),
            &["where.speed_m_s: found a list in a list"],
        ),
        (json!([5]), &["checks[0].where: found a list, allowed: an object"]),
    ] {
        check(&stage, "r", &json!({ "where": filter, "value": value() }), parts);
    }
}

#[test]
fn what_can_be_no_check_whatever_the_results() {
    let stage = stage();
    let with = |key: &str, found: Value| {
        let mut check = json!({ "value": value() });
        *check
            .pointer_mut("/value")
            .unwrap()
            .as_object_mut()
            .unwrap()
            .entry(key)
            .or_insert(Value::Null) = found;
        check
    };
    let bare = json!({ "of": of(), "expected": 1 });
    for (made, parts) in [
        (
            with("relative_tolerance", json!(-0.1)),
            &["checks[0].value.relative_tolerance: found -0.1"][..],
        ),
        (
            with("absolute_tolerance", json!(-1e-9)),
            &["checks[0].value.absolute_tolerance: "],
        ),
        (json!({ "value": bare }), &["checks[0].value: found no tolerance"]),
        (json!({ "role": "hold", "value": bare }), &["found no tolerance"]),
        (
            json!({ "role": "expected-fail", "value": bare }),
            &["found no tolerance"],
        ),
        (
            json!({ "role": "record", "value": with("relative_tolerance", json!(-1))["value"] }),
            &["relative_tolerance: found -1"],
        ),
        (
            json!({ "mode": { "shape": "heave", "expected_hz": 1 } }),
            &["checks[0].mode: found no tolerance"],
        ),
        (
            json!({ "mode": { "shape": "heave", "expected_hz": 0, "relative_tolerance": 0.1 } }),
            &["checks[0].mode.expected_hz: found 0"],
        ),
        (
            json!({}),
            &[
                "checks[0]: found nothing to check",
                "exactly one of value, bound, trend, mode, curve, measured",
            ],
        ),
        (
            json!({ "value": value(), "bound": { "of": of(), "at_least": 0 } }),
            &["checks[0]: found 2 things to check"],
        ),
        (json!({ "bound": { "of": of() } }), &["checks[0].bound: found no bound"]),
        (
            json!({ "bound": { "of": of(), "above": 2, "below": 1 } }),
            &["checks[0].bound.above: found 2"],
        ),
        (
            json!({ "bound": { "of": of(), "above": 2, "at_least": 1 } }),
            &["checks[0].bound: found at_least and above, allowed: one of the two"],
        ),
        (
            json!({ "bound": { "of": { "difference": [{ "number": 1 }, { "number": 2 }] }, "at_least": 0 } }),
            &["checks[0].bound.of: found numbers alone"],
        ),
        (
            json!({ "value": { "of": of() } }),
            &["checks[0].value.expected: missing key `expected`"],
        ),
        (
            json!({ "bound": { "of": of(), "at_least": 2, "at_most": 1 } }),
            &["checks[0].bound.at_least: found 2"],
        ),
        (
            json!({ "trend": { "of": of(), "along": "speed_m_s", "trend": "flat" } }),
            &["checks[0].trend.within: missing key `within`"],
        ),
        (
            json!({ "trend": { "of": of(), "along": "speed_m_s", "trend": "rises", "within": 0.1 } }),
            &["checks[0].trend.within: found 0.1"],
        ),
        (
            json!({ "trend": { "of": of(), "along": "speed_m_s", "trend": "rise" } }),
            &["checks[0].trend.trend: ", "nearest known: rises"],
        ),
        (
            json!({ "measured": { "of": of(), "value": 1 } }),
            &["checks[0].measured.uncertainty: missing key `uncertainty`"],
        ),
        (
            json!({ "measured": { "of": of(), "value": 1, "uncertainty": -1 } }),
            &["checks[0].measured.uncertainty: found -1"],
        ),
        (
            json!({ "curve": { "table": "positions", "column": "x_m", "against": "x_m", "points": [], "relative_tolerance": 0.1 } }),
            &["checks[0].curve.points: found an empty list"],
        ),
        (
            json!({ "curve": { "table": "positions", "column": "x_m", "against": "x_m", "points": [[1, 0], [1, 1]], "relative_tolerance": 0.1 } }),
            &["checks[0].curve.points[1][0]: found 1, allowed: above 1"],
        ),
        (
            json!({ "curve": { "table": "positions", "column": "x_m", "against": "x_m", "points": [[1, 0, 0]], "relative_tolerance": 0.1 } }),
            &["checks[0].curve.points[0]: found a list of length 3"],
        ),
        (
            json!({ "role": "expected_fail", "value": value() }),
            &["checks[0].role: ", "nearest known: expected-fail"],
        ),
        (
            json!({ "id": " ", "value": value() }),
            &["checks[0].id: found an empty id"],
        ),
        (json!({ "id": 7, "value": value() }), &["checks[0].id: found 7"]),
        (
            json!({ "each": "speed_m_s", "value": value() }),
            &["checks[0].each: found \"speed_m_s\", allowed: a list"],
        ),
        (
            json!({ "valeu": value() }),
            &["checks[0].valeu: found unknown key `valeu`", "nearest known: value"],
        ),
        (
            with("expcted", json!(1)),
            &["checks[0].value.expcted: ", "nearest known: expected"],
        ),
        (
            with("expected", json!("x")),
            &["checks[0].value.expected: found \"x\", allowed: a number"],
        ),
        (
            with("expected", json!(null)),
            &["checks[0].value.expected: missing key `expected`"],
        ),
        (with("of", json!(7)), &["checks[0].value.of: found 7"]),
        (with("of", json!({})), &["checks[0].value.of: found an object"]),
        (
            with("of", json!({ "slect": {} })),
            &[
                "checks[0].value.of.slect: found unknown key `slect`",
                "nearest known: select",
            ],
        ),
        (
            with("of", json!({ "largest": [] })),
            &["checks[0].value.of: found an empty list"],
        ),
        (
            with("of", json!({ "ratio": [of()] })),
            &["checks[0].value.of.ratio: found a list of length 1, allowed: a list of length 2"],
        ),
        (
            with("of", json!({ "ratio": [of(), { "smallest": [] }] })),
            &["checks[0].value.of.ratio[1]: found an empty list"],
        ),
        (
            with(
                "of",
                json!({ "select": { "table": "jobs", "column": "steps", "reduse": "max" } }),
            ),
            &["checks[0].value.of.select.reduse: ", "nearest known: reduce"],
        ),
        (
            with(
                "of",
                json!({ "select": { "table": "jobs", "column": "steps", "reduce": "maximum" } }),
            ),
            &["checks[0].value.of.select.reduce: ", "nearest known: max"],
        ),
        (
            with(
                "of",
                json!({ "history": { "quantity": "force_n", "position": 2, "reduce": "maxx" } }),
            ),
            &["checks[0].value.of.history.reduce: ", "nearest known: max"],
        ),
        (
            with(
                "of",
                json!({ "history": { "quantity": "force_n", "position": -2, "reduce": "max" } }),
            ),
            &["checks[0].value.of.history.position: found -2"],
        ),
        (
            with(
                "of",
                json!({ "history": { "quantity": "force_n", "position": 1e300, "reduce": "max" } }),
            ),
            &["checks[0].value.of.history.position: "],
        ),
        (
            with(
                "of",
                json!({ "history": { "quantity": "force_n", "position": 2, "reduce": "max", "from": { "centre_past": 1 } } }),
            ),
            &[
                "checks[0].value.of.history.from.centre_past: ",
                "nearest known: centre_past_m",
            ],
        ),
    ] {
        check(&stage, "r", &made, parts);
    }
}

#[test]
fn references_as_a_whole() {
    let stage = stage();
    let good = json!({ "id": "a", "value": value() });
    for (document, parts) in [
        (reference(&json!([])), &["checks: found an empty list"][..]),
        (reference(&json!([good, good])), &["checks[1].id: found \"a\" twice"]),
        (reference(&json!({})), &["checks: found an object, allowed: a list"]),
        (
            json!({ "name": "x", "checks": [good] }),
            &["source: missing key `source`"],
        ),
        (
            json!({ "name": "x", "source": "y", "checks": [good], "not": 1 }),
            &["not: found unknown key `not`"],
        ),
        (json!([]), &["found "]),
    ] {
        refuse(&stage, "r", &document, parts);
    }
    for (text, parts) in [
        ("", "found an empty file"),
        ("not json", "allowed: JSON"),
        (
            r#"{"name": "x", "source": "y", "name": "z"}"#,
            "the key `name` twice (line 1, column 30)",
        ),
        (
            r#"{"name": "x", "source": "y", "checks": [{"id": "a", "value": {"expected": NaN}}]}"#,
            "checks[0].value.expected: found NaN",
        ),
        (
            r#"{"name": "x", "source": "y", "checks": [{"id": "a", "value": {"expected": -1e999}}]}"#,
            "checks[0].value.expected: found -1e999",
        ),
    ] {
        fs::write(stage.path("reference.json"), text).unwrap();
        let output = stage.pontoon(&["compare", "r", "--with", "reference.json"]);
        is_refused(&output, &["reference.json: ", parts]);
    }
    fs::write(stage.path("reference.json"), [0xff, 0xfe, 0]).unwrap();
    is_refused(
        &stage.pontoon(&["compare", "r", "--with", "reference.json"]),
        &["reference.json: "],
    );
}

#[test]
fn files_and_folders_that_are_not_what_they_should_be() {
    let stage = stage();
    let mut document = reference(&json!([{ "id": "a", "value": value() }]));
    document["study"] = "study.json".into();
    stage.json("reference.json", &document);
    let compare = |results: &str, with: &str| stage.pontoon(&["compare", results, "--with", with]);
    is_refused(
        &compare("m", "reference.json"),
        &["m: found results of the study 'modes'", "'smoke'"],
    );
    is_refused(
        &compare("nowhere", "reference.json"),
        &["nowhere: found no such folder"],
    );
    fs::create_dir(stage.path("empty")).unwrap();
    is_refused(
        &compare("empty", "reference.json"),
        &["empty: found no results: manifest.json is missing"],
    );
    is_refused(&compare("r", "empty"), &["empty: found no results"]);
    is_refused(&compare("r", "nowhere.json"), &["nowhere.json: found no readable file"]);
    is_refused(
        &compare("reference.json", "reference.json"),
        &["reference.json: found "],
    );
    let with_tolerance = ["compare", "r", "--with", "reference.json", "--tolerance", "t.json"];
    is_refused(
        &stage.pontoon(&with_tolerance),
        &["t.json: found --tolerance with a reference"],
    );
    document["study"] = "gone.json".into();
    stage.json("reference.json", &document);
    is_refused(&compare("r", "reference.json"), &["gone.json: found no readable file"]);
    assert_eq!(stage.pontoon(&["compare", "r"]).status.code(), Some(2));
}

/// Results that the study or its bridge has outlived are told apart from fresh ones.
#[test]
fn results_of_an_earlier_state_of_the_study_are_told() {
    let mut stage = Stage::new();
    stage.write();
    stage.ran("r");
    let mut made = reference(&json!([{ "id": "a", "bound": { "of": of(), "at_least": 0 } }]));
    made["study"] = "study.json".into();
    stage.json("reference.json", &made);
    let told = |stage: &Stage| stderr(&stage.pontoon(&["compare", "r", "--with", "reference.json"]));
    assert_eq!(told(&stage), "");
    stage.bridge["hydrostatic_stiffness_pa_m"] = json!(7000);
    stage.write();
    assert_eq!(
        told(&stage),
        "changed: the bridge has changed since these results: run it again\n"
    );
}
