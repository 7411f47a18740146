//! Designs from outside: what a study may say, what comes of it, what is refused.

use super::refusals::{refused, study};
use crate::stage::{Stage, stderr, stdout};
use serde_json::{Value, json};
use std::fs;

/// A study of these designs.
fn stage(designs: Value) -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = designs;
    stage
}

/// What `plan` says of these designs.
fn plan(designs: Value) -> Value {
    let output = stage(designs)
        .write()
        .pontoon(&["plan", "study.json", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// The refusal of one design at a key below it.
fn bad(design: Value, key: &str, found: &str, allowed: &str) {
    let message = format!("design[0]{key}: found {found}, allowed: {allowed}");
    study("", "design", json!([design]), &[&message]);
}

#[test]
fn numbers_that_are_two_jobs_are_two_for_conditions_and_read_otherwise() {
    let generated = json!({ "grid": { "speed_m_s": { "linspace": [0.1, 0.4, 4] }, "load_n": 1e5 } });
    let written = json!({ "grid": { "speed_m_s": [0.1, 0.2, 0.3, 0.4], "load_n": 1e5 } });
    assert_eq!(plan(json!([generated, written]))["jobs"], 4);
    let close =
        json!({ "cases": [{ "speed_m_s": 5, "load_n": 1e5 }, { "speed_m_s": 5.000000000000001, "load_n": 1e5 }] });
    let output = stage(json!([close])).write().pontoon(&["plan", "study.json"]);
    let text = stdout(&output);
    assert!(text.contains("  speed_m_s       5, 5.000000000000001\n"), "{text}");
    let mut left = close;
    left["where"] = json!({ "speed_m_s": 5 });
    assert_eq!(plan(json!([left]))["jobs"], 1);
}

#[test]
fn every_form_is_planned_with_its_points_and_its_jobs() {
    let ranges = json!({ "connection": "nonlinear", "gap_tension_m": [0, 0.03], "gap_compression_m": [0, 0.01],
                         "speed_m_s": [5, 15], "load_n": 1e5 });
    let gaps = json!({ "gap_tension_m": { "at_least": "gap_compression_m" } });
    let four = json!({ "linspace": [0, 0.03, 4] });
    for (design, points, jobs) in [
        (
            json!({ "zip": { "speed_m_s": [5, 10, 15], "load_n": { "linspace": [1e5, 2e5, 3] } } }),
            3,
            3,
        ),
        (
            json!({ "latin_hypercube": { "count": 20, "seed": 1, "ranges": ranges } }),
            20,
            20,
        ),
        (json!({ "sobol": { "count": 32, "seed": 1, "ranges": ranges } }), 32, 32),
        (
            json!({ "saltelli": { "count": 8, "seed": 1, "ranges": ranges } }),
            40,
            40,
        ),
        (
            json!({ "saltelli": { "count": 8, "seed": 1, "ranges": ranges, "second_order": true } }),
            64,
            64,
        ),
        // two levels of three axes have eight points
        (
            json!({ "morris": { "trajectories": 50, "levels": 2, "seed": 1, "ranges": ranges } }),
            200,
            8,
        ),
        (
            json!({ "grid": { "gap_tension_m": four, "gap_compression_m": four, "speed_m_s": 5, "load_n": 1e5 },
                    "where": gaps }),
            10,
            10,
        ),
        (
            json!({ "grid": { "connection": "linear", "gap_tension_m": four, "speed_m_s": 5, "load_n": 1e5 } }),
            4,
            1,
        ),
    ] {
        let told = plan(json!([design]));
        assert_eq!(
            (&told["points"], &told["jobs"]),
            (&json!(points), &json!(jobs)),
            "{design}"
        );
    }
}

#[test]
fn axes_of_every_form_are_columns() {
    let sampled = |count: usize| {
        json!({ "count": count, "seed": 2, "ranges": { "connection": "linear", "speed_m_s": [14, 15], "load_n": 1e5,
                "analysis.tail_s": [0.1, 0.2] } })
    };
    let stage = stage(json!([
        { "zip": { "connection": "linear", "speed_m_s": [14, 15], "load_n": 1e5, "vehicle.footprint_length_m": [3, 4] } },
        { "latin_hypercube": sampled(2) },
        { "sobol": sampled(2) },
    ]));
    stage.ran("r");
    let column = |name: &str| -> Vec<f64> {
        let column = stage.numbers("r/jobs.parquet", name);
        column.into_iter().map(Option::unwrap).collect()
    };
    let (speeds, tails) = (column("speed_m_s"), column("analysis.tail_s"));
    assert_eq!(speeds.len(), 6);
    assert_eq!((speeds[0], speeds[1]), (14.0, 15.0));
    assert_eq!(column("vehicle.footprint_length_m"), [3.0, 4.0, 3.35, 3.35, 3.35, 3.35]);
    assert_eq!((tails[0], tails[1]), (2.0, 2.0));
    for pair in [2..4, 4..6] {
        let mut drawn = speeds[pair.clone()].to_vec();
        drawn.sort_by(f64::total_cmp);
        assert!(14.0 < drawn[0] && drawn[0] < 14.5 && 14.5 < drawn[1] && drawn[1] < 15.0);
        assert!(tails[pair].iter().all(|tail| (0.1..=0.2).contains(tail)), "{tails:?}");
    }
}

#[test]
fn the_schema_tells_every_form_and_every_key() {
    let output = Stage::new().pontoon(&["schema", "study"]);
    let schema: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let defs = &schema["$defs"];
    let described = |of: &Value, key: &str| {
        let text = of["properties"][key]["description"].as_str();
        assert!(text.is_some_and(|text| text.ends_with('.')), "{key}: {of}");
    };
    let forms = [
        ("grid", "Axes"),
        ("zip", "Axes"),
        ("cases", "Case"),
        ("latin_hypercube", "SampleSpec"),
        ("sobol", "SampleSpec"),
        ("saltelli", "SaltelliSpec"),
        ("morris", "MorrisSpec"),
    ];
    for (form, shape) in forms {
        described(&defs["Design"], form);
        let said = defs["Design"]["properties"][form].to_string();
        assert!(said.contains(&format!("#/$defs/{shape}\"")), "{form}: {said}");
    }
    described(&defs["Design"], "where");
    assert_eq!(
        defs["Design"]["oneOf"],
        json!(forms.map(|(form, _)| json!({ "required": [form] })))
    );
    for key in ["count", "seed", "ranges"] {
        described(&defs["SampleSpec"], key);
    }
    for key in ["count", "seed", "ranges", "second_order"] {
        described(&defs["SaltelliSpec"], key);
    }
    for key in ["trajectories", "levels", "seed", "ranges"] {
        described(&defs["MorrisSpec"], key);
    }
    assert_eq!(defs["MorrisSpec"]["properties"]["levels"]["multipleOf"], json!(2));
    assert_eq!(defs["SampleSpec"]["required"], json!(["count", "seed", "ranges"]));
    assert_eq!(defs["SampleSpec"]["properties"]["count"]["maximum"], json!(10_000_000));
    let bounds = &defs["Conditions"]["additionalProperties"]["anyOf"][2];
    for key in ["from", "to", "at_least", "at_most", "above", "below"] {
        described(bounds, key);
    }
    for shape in ["Axes", "Case", "Ranges"] {
        let names = defs[shape]["properties"].as_object().unwrap();
        assert!(
            names.contains_key("speed_m_s") && names.contains_key("load_x_m"),
            "{shape}"
        );
        assert!(
            defs[shape]["patternProperties"]
                .to_string()
                .contains("bridge|vehicle|analysis")
        );
        assert_eq!(defs[shape]["additionalProperties"], json!(false));
    }
}

#[test]
fn designs_of_no_form_or_of_two() {
    let one = "exactly one of grid, zip, cases, latin_hypercube, sobol, saltelli, morris";
    bad(json!({}), "", "none of them", one);
    bad(json!({ "grid": {}, "zip": {} }), "", "grid and zip", one);
    study(
        "",
        "design",
        json!([{ "latin_hypercub": {} }]),
        &[
            "design[0].latin_hypercub: found unknown key",
            "nearest known: latin_hypercube",
        ],
    );
}

#[test]
fn zips_of_unequal_lengths() {
    bad(
        json!({ "zip": { "speed_m_s": [5, 10, 15], "load_n": [1e5, 2e5] } }),
        ".zip.load_n",
        "2 values",
        "3 values, as many as speed_m_s has, or one",
    );
}

#[test]
fn samples_that_cannot_be_drawn() {
    let form =
        |form: &str, count: Value, ranges: Value| json!({ form: { "count": count, "seed": 1, "ranges": ranges } });
    let speed = json!({ "speed_m_s": [5, 10], "load_n": 1e5 });
    for name in ["latin_hypercube", "sobol"] {
        bad(
            form(name, json!(1_000_000_000_000_u64), speed.clone()),
            &format!(".{name}.count"),
            "1000000000000",
            "a whole number from 1 to 10000000",
        );
        bad(
            form(name, json!(0), speed.clone()),
            &format!(".{name}.count"),
            "0",
            "a whole number from 1 to 10000000",
        );
        bad(
            form(name, json!(5), json!({ "speed_m_s": 5, "load_n": 1e5 })),
            &format!(".{name}.ranges"),
            "no range",
            "at least one axis with a range [from, to]",
        );
        bad(
            form(name, json!(5), json!({ "speed_m_s": [10, 5], "load_n": 1e5 })),
            &format!(".{name}.ranges.speed_m_s"),
            "[10,5]",
            "[from, to], two numbers with from below to, {\"whole\": [from, to]}, {\"values\": [...]}, or one number or word",
        );
        bad(
            form(
                name,
                json!(5),
                json!({ "connection": ["linear", "nonlinear"], "speed_m_s": [5, 10] }),
            ),
            &format!(".{name}.ranges.connection"),
            "[\"linear\",\"nonlinear\"]",
            "linear or nonlinear, the same for all points",
        );
        // what a point itself may not be
        let message = format!("design[0].{name}.ranges.load_n: missing key `load_n` (required)");
        let of_speed = form(name, json!(5), json!({ "speed_m_s": [5, 10] }));
        study("", "design", json!([of_speed]), &[&message]);
        bad(
            form(
                name,
                json!(5),
                json!({ "connection": "linaer", "speed_m_s": [5, 10], "load_n": 1e5 }),
            ),
            &format!(".{name}.ranges.connection"),
            "unknown \"linaer\" (nearest known: linear)",
            "linear, nonlinear",
        );
        study(
            "",
            "design",
            json!([form(name, json!(5), json!({ "speed_m_s": [-10, -5], "load_n": 1e5 }))]),
            &[
                &format!("design[0].{name}.ranges.speed_m_s: found -"),
                "a finite number above 0",
            ],
        );
        study(
            "",
            "design",
            json!([form(name, json!(5), json!({ "sped_m_s": [5, 10], "load_n": 1e5 }))]),
            &[
                &format!("design[0].{name}.ranges.sped_m_s: "),
                "nearest known: speed_m_s",
            ],
        );
    }
    let many: serde_json::Map<_, _> = (0..101).map(|i| (format!("bridge.x{i}"), json!([0, 1]))).collect();
    bad(
        form("sobol", json!(5), many.into()),
        ".sobol.ranges",
        "101 ranges",
        "at most 100 ranges",
    );
}

#[test]
fn conditions_that_cannot_be_met_or_understood() {
    let grid = |condition: Value| json!({ "grid": { "speed_m_s": [5, 10], "load_n": 1e5 }, "where": condition });
    bad(
        grid(json!({ "speed_m_s": { "from": 11 } })),
        ".where",
        "conditions under which no point is left",
        "conditions that at least one of the 2 points meets",
    );
    bad(
        grid(json!({ "sped_m_s": 5 })),
        ".where.sped_m_s",
        "unknown key `sped_m_s` (nearest known: speed_m_s)",
        "speed_m_s, load_n",
    );
    bad(
        grid(json!({ "speed_m_s": { "below": "load" } })),
        ".where.speed_m_s.below",
        "unknown \"load\" (nearest known: load_n)",
        "speed_m_s, load_n",
    );
    bad(
        grid(json!({ "speed_m_s": { "belo": "load_n" } })),
        ".where.speed_m_s.belo",
        "unknown key `belo` (nearest known: below)",
        "from, to, at_least, at_most, above, below",
    );
    bad(
        grid(json!({ "speed_m_s": { "at_least": 5 } })),
        ".where.speed_m_s",
        "5 as at_least",
        "the name of another axis (the keys of numbers are from and to)",
    );
}

#[test]
fn sizes_beyond_reason_are_refused_at_once() {
    let long = |count: f64| json!({ "linspace": [1, 2, count] });
    bad(
        json!({ "grid": { "speed_m_s": long(1e9), "load_n": 1e5 } }),
        ".grid.speed_m_s.linspace",
        "1000000000, as the count",
        "a whole count from 2 to 10000000",
    );
    bad(
        json!({ "zip": { "speed_m_s": { "geomspace": [1, 2, 1e300] }, "load_n": 1e5 } }),
        ".zip.speed_m_s.geomspace",
        "1e+300, as the count",
        "a whole count from 2 to 10000000",
    );
    let axes: serde_json::Map<_, _> = (0..40).map(|i| (format!("bridge.x{i}"), long(1e7))).collect();
    study(
        "",
        "design",
        json!([{ "grid": axes, "where": { "bridge.x0": 5 } }]),
        &["design: found 1.0e280 points, allowed: at most 10000000 points"],
    );
    let deep = format!("bridge.{}", vec!["a"; 100_000].join("."));
    study(
        "",
        "design",
        json!([{ "grid": { deep: [1] } }]),
        &[
            "design[0].grid.bridge.a.a",
            "allowed: a short name or the path of a value",
        ],
    );
}

#[test]
fn numbers_beyond_counting_and_documents_beyond_depth() {
    let written = |design: &str| {
        let stage = stage(json!("DESIGN"));
        let text = fs::read_to_string(stage.write().path("study.json")).unwrap();
        fs::write(stage.path("study.json"), text.replace("\"DESIGN\"", design)).unwrap();
        stage
    };
    for (design, key) in [
        (
            r#"[{"grid": {"speed_m_s": {"linspace": [1, 1e999, 3]}}}]"#,
            "grid.speed_m_s.linspace[1]",
        ),
        (r#"[{"zip": {"load_n": [1, -1e999]}}]"#, "zip.load_n[1]"),
        (
            r#"[{"sobol": {"ranges": {"load_n": [1, 1e999]}}}]"#,
            "sobol.ranges.load_n[1]",
        ),
        (r#"[{"latin_hypercube": {"count": 1e999}}]"#, "latin_hypercube.count"),
        (r#"[{"where": {"load_n": {"from": -1e999}}}]"#, "where.load_n.from"),
    ] {
        refused(
            &written(design),
            &[
                &format!("study.json: design[0].{key}: found "),
                "1e999",
                "allowed: a finite number",
            ],
        );
    }
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    refused(
        &written(&deep),
        &[
            "study.json: found lists and objects nested too deep",
            "allowed: at most 127 levels",
        ],
    );
}
