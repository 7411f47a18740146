//! `report --figures`: the numbers plotted, and what an SVG and its PNG show of them.

use crate::stage::{Frame, Stage, is_refused, reference, stderr, stdout};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn shipped(study: &str) -> String {
    format!("{}/../../studies/{study}", env!("CARGO_MANIFEST_DIR"))
}

/// Runs a shipped study into `r` and draws it into `f`; the numbers plotted.
fn drawn(stage: &Stage, study: &str) -> Value {
    let output = stage.pontoon(&["run", &shipped(study), "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    figures(stage, &["--with", &shipped(study)])
}

/// Draws the results in `r` into `f`; the numbers plotted.
fn figures(stage: &Stage, words: &[&str]) -> Value {
    let output = stage.pontoon(&[&["report", "r", "--figures", "f"], words].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for path in stdout(&output).lines() {
        assert!(stage.path(path).is_file(), "{path}");
    }
    serde_json::from_str(&fs::read_to_string(stage.path("f/figures.json")).unwrap()).unwrap()
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

fn figure<'a>(figures: &'a Value, name: &str) -> &'a Value {
    let found = list(&figures["figures"]).iter().find(|figure| figure["name"] == name);
    found.unwrap_or_else(|| panic!("no figure {name} in {:?}", names(figures)))
}

fn names(figures: &Value) -> Vec<&str> {
    list(&figures["figures"])
        .iter()
        .map(|figure| figure["name"].as_str().unwrap())
        .collect()
}

fn line<'a>(panel: &'a Value, label: &str) -> &'a Value {
    let found = list(&panel["lines"]).iter().find(|line| line["label"] == label);
    found.unwrap_or_else(|| panic!("no line {label}"))
}

fn points(line: &Value) -> Vec<[f64; 2]> {
    let number = |value: &Value| value.as_f64().unwrap();
    list(&line["points"])
        .iter()
        .map(|point| [number(&point[0]), number(&point[1])])
        .collect()
}

fn column(table: &Frame, name: &str) -> Vec<f64> {
    let numbers = table.column(name).unwrap().numbers().into_iter();
    numbers.map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// A line's value at a place, between its points.
fn at(points: &[[f64; 2]], x: f64) -> f64 {
    let pair = points.windows(2).find(|pair| pair[0][0] <= x && x <= pair[1][0]);
    let pair = pair.unwrap_or_else(|| panic!("nothing at {x}"));
    pair[0][1] + (pair[1][1] - pair[0][1]) * (x - pair[0][0]) / (pair[1][0] - pair[0][0]).max(f64::MIN_POSITIVE)
}

/// How far the lines of a study are from the golden ones, as a share of each line's largest, at most.
fn miss(figures: &Value, study: &str, factor: f64) -> f64 {
    let golden: Value = serde_json::from_str(include_str!("golden/figures.json")).unwrap();
    let of_study: Vec<&Value> = list(&golden).iter().filter(|line| line["study"] == study).collect();
    assert!(!of_study.is_empty(), "{study}");
    let misses = of_study.into_iter().flat_map(|expected| {
        let panel = expected["panel"].as_u64().unwrap() as usize;
        let name = expected["figure"].as_str().unwrap();
        let found = points(line(
            &figure(figures, name)["panels"][panel],
            expected["label"].as_str().unwrap(),
        ));
        let expected = points(expected);
        let largest = expected.iter().map(|[_, y]| y.abs()).fold(0.0, f64::max);
        expected
            .into_iter()
            .map(move |[x, y]| (at(&found, x) - factor * y).abs() / largest)
    });
    misses.fold(0.0, f64::max)
}

/// 1 %: half a time step is worth 0.3 % of a deflection, thinning less, and another machine's last bits much less; forces are
/// compared where nothing clatters, with the linear connection. Twin: 5 %.
fn is_golden(figures: &Value, study: &str) {
    let (right, wrong) = (miss(figures, study, 1.0), miss(figures, study, 1.05));
    assert!(right < 0.01 && wrong > 0.01, "{study}: {right} {wrong}");
}

/// The last bit of a product.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}

#[test]
fn static_figures_plot_the_table_of_positions_and_the_experiment() {
    let stage = Stage::new();
    let made = drawn(&stage, "fig09_static");
    is_golden(&made, "fig09_static");
    assert_eq!(
        names(&made),
        [
            "deflection-along-bridge-by-gap_tension_m",
            "deflection-along-bridge-by-gap_compression_m",
            "deflection-along-bridge"
        ]
    );
    let table = stage.table("r/positions.parquet");
    let [job, x, deflection] = ["job", "x_m", "deflection_m"].map(|name| column(&table, name));
    for figure in list(&made["figures"]) {
        let panel = &figure["panels"][0];
        assert_eq!((&panel["y"]["unit"], &panel["y"]["down"]), (&json!("cm"), &json!(true)));
        for line in list(&panel["lines"]) {
            let of = line["jobs"][0].as_f64().unwrap();
            let rows: Vec<usize> = (0..job.len()).filter(|row| job[*row] == of).collect();
            let points = points(line);
            assert_eq!(points.len(), rows.len());
            assert!(
                rows.iter()
                    .zip(&points)
                    .all(|(row, point)| point[0] == x[*row] && same(point[1], 100.0 * deflection[*row]))
            );
        }
        let measured: Vec<&Value> = list(&panel["marks"])
            .iter()
            .filter(|mark| mark["origin"] == "measured")
            .collect();
        assert_eq!(measured.len(), 1, "{figure}");
        let point = &measured[0]["point"];
        assert!(same(point[0].as_f64().unwrap(), 40.2) && same(point[1].as_f64().unwrap(), 21.0));
    }
    let labels = |name: &str| -> Vec<String> {
        let lines = list(&figure(&made, name)["panels"][0]["lines"]).iter();
        lines.map(|line| line["label"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(
        labels("deflection-along-bridge-by-gap_tension_m"),
        ["linear connection", "0 mm", "5 mm", "28 mm"]
    );
    assert_eq!(
        labels("deflection-along-bridge-by-gap_compression_m"),
        ["linear connection", "0 mm", "5.5 mm"]
    );
    assert_eq!(labels("deflection-along-bridge").len(), 5);
    assert_eq!(made["left_out"], json!([]));
    is_drawn(&stage, &made);
}

/// Every point is a row of the table, and a line has its history's peaks.
fn plots_histories(stage: &Stage, made: &Value, stem: &str, quantity: &str, factor: f64) -> usize {
    let table = stage.table("r/histories.parquet");
    let [job, time, value, position] = ["job", "time_s", "value", "position"].map(|name| column(&table, name));
    let words = table.column("quantity").unwrap().str().unwrap().clone();
    let mut lines = 0;
    for figure in list(&made["figures"])
        .iter()
        .filter(|figure| figure["name"].as_str().unwrap().starts_with(stem))
    {
        for line in list(&figure["panels"]).iter().flat_map(|panel| list(&panel["lines"])) {
            let of = line["jobs"][0].as_f64().unwrap();
            let meant = |row: &usize| job[*row] == of && words.get(*row) == Some(quantity) && position[*row] == 7.0;
            let rows: Vec<[f64; 2]> = (0..job.len())
                .filter(meant)
                .map(|row| [time[row], factor * value[row]])
                .collect();
            let points = points(line);
            let known: BTreeSet<u64> = rows.iter().map(|[t, _]| t.to_bits()).collect();
            assert!(points.iter().all(|[t, _]| known.contains(&t.to_bits())));
            assert!(
                points
                    .iter()
                    .all(|[t, y]| same(*y, at(&rows, *t)) || rows.iter().any(|[s, v]| s == t && same(*v, *y)))
            );
            let ends = |list: &[[f64; 2]]| {
                list.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [_, y]| {
                    [a.min(*y), b.max(*y)]
                })
            };
            let (kept, all) = (ends(&points), ends(&rows));
            assert!(same(kept[0], all[0]) && same(kept[1], all[1]), "{kept:?} {all:?}");
            lines += 1;
        }
    }
    lines
}

#[test]
fn histories_by_the_tension_gap_plot_the_table_of_histories() {
    let stage = Stage::new();
    let made = drawn(&stage, "fig12_14_gap_tension");
    is_golden(&made, "fig12_14_gap_tension");
    let by = figure(&made, "deflection-7-by-gap_tension_m");
    let titles: Vec<&str> = list(&by["panels"])
        .iter()
        .map(|panel| panel["title"].as_str().unwrap())
        .collect();
    assert_eq!(titles, ["3 m/s", "7 m/s", "10 m/s", "15 m/s"]);
    for (panel, speed_m_s) in list(&by["panels"]).iter().zip([3.0, 7.0, 10.0, 15.0]) {
        // the centre of a single axle without a body is at V t; position 7 is six modules from the beginning
        let arrival_s = panel["moments"][0]["x"].as_f64().unwrap();
        assert!((arrival_s - 6.0 * 6.7 / speed_m_s).abs() < 1e-9, "{arrival_s}");
    }
    assert_eq!(
        plots_histories(&stage, &made, "deflection-7", "deflection_m", 100.0),
        16
    );
    assert_eq!(plots_histories(&stage, &made, "force-7", "force_n", 1e-3), 16);
    let jobs = stage.table("r/jobs.parquet");
    let [speed, peak] = ["speed_m_s", "peak_compression_n"].map(|name| column(&jobs, name));
    let peaks = line(&figure(&made, "peak-force-by-gap_tension_m")["panels"][0], "28 mm");
    for (of, [x, y]) in list(&peaks["jobs"]).iter().zip(points(peaks)) {
        let row = of.as_u64().unwrap() as usize;
        assert!(x == speed[row] && same(y, 1e-3 * peak[row]));
    }
    is_drawn(&stage, &made);
}

#[test]
fn histories_by_the_compression_gap_and_of_one_run() {
    let stage = Stage::new();
    let made = drawn(&stage, "fig13_15_gap_compression");
    is_golden(&made, "fig13_15_gap_compression");
    assert_eq!(plots_histories(&stage, &made, "force-7", "force_n", 1e-3), 12);
    let stage = Stage::new();
    let made = drawn(&stage, "fig10_test_run");
    is_golden(&made, "fig10_test_run");
    assert_eq!(names(&made), ["deflection-7", "force-7", "envelope-along-bridge"]);
    assert_eq!(plots_histories(&stage, &made, "deflection-7", "deflection_m", 100.0), 1);
    is_drawn(&stage, &made);
}

/// Each SVG is XML that shows what its figure holds, each PNG has its size: 84 or 174 mm at 300 dpi.
fn is_drawn(stage: &Stage, made: &Value) {
    for figure in list(&made["figures"]) {
        let name = figure["name"].as_str().unwrap();
        let svg = fs::read_to_string(stage.path(&format!("f/{name}.svg"))).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap_or_else(|e| panic!("{name}: {e}"));
        let texts: BTreeSet<&str> = document
            .descendants()
            .filter(|node| node.has_tag_name("text"))
            .filter_map(|node| node.text())
            .collect();
        let panels = list(&figure["panels"]);
        for axis in panels.iter().flat_map(|panel| [&panel["x"], &panel["y"]]) {
            let words = format!(
                "{} ({})",
                axis["label"].as_str().unwrap(),
                axis["unit"].as_str().unwrap()
            );
            assert!(texts.contains(words.as_str()), "{name}: no '{words}' in {texts:?}");
        }
        for line in panels.iter().flat_map(|panel| list(&panel["lines"])) {
            let label = line["label"].as_str().unwrap();
            let cut = |text: &&str| {
                text.strip_suffix('\u{2026}')
                    .is_some_and(|begun| label.starts_with(begun))
            };
            assert!(
                texts.contains(label) || texts.iter().any(cut),
                "{name}: no '{label}' in {texts:?}"
            );
        }
        let of_class = |class: &str| -> usize {
            let groups = document
                .descendants()
                .filter(|node| node.attribute("class") == Some(class));
            groups
                .map(|group| group.children().filter(|node| node.is_element()).count())
                .sum()
        };
        let marks: usize = panels.iter().map(|panel| list(&panel["marks"]).len()).sum();
        assert_eq!(of_class("marks"), marks, "{name}");
        let joined = |panel: &Value| {
            list(&panel["lines"])
                .iter()
                .filter(|line| list(&line["points"]).len() > 1)
                .count()
        };
        let clipped = document
            .descendants()
            .filter(|node| node.attribute("clip-path").is_some());
        let drawn: usize = clipped
            .map(|group| group.children().filter(|node| node.has_tag_name("path")).count())
            .sum();
        assert_eq!(drawn, panels.iter().map(joined).sum::<usize>(), "{name}");
        let width_mm = if panels.len() == 1 { 84.0 } else { 174.0 };
        let decoder = png::Decoder::new(std::io::BufReader::new(
            fs::File::open(stage.path(&format!("f/{name}.png"))).unwrap(),
        ));
        let mut reader = decoder.read_info().unwrap();
        let (width, height) = (reader.info().width, reader.info().height);
        assert!(
            (f64::from(width) - width_mm / 25.4 * 300.0).abs() <= 1.0,
            "{name}: {width}"
        );
        assert_eq!(reader.info().pixel_dims.map(|dims| dims.xppu), Some(11811), "{name}");
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let dark = pixels
            .chunks(3)
            .filter(|rgb| rgb.iter().all(|value| *value < 128))
            .count();
        assert!(
            dark > 500 && dark < (width * height / 2) as usize,
            "{name}: {dark} dark pixels"
        );
    }
}

#[test]
fn the_same_results_give_the_same_bytes_and_other_files_stay() {
    let stage = Stage::new();
    stage.ran("r");
    fs::create_dir(stage.path("f")).unwrap();
    fs::write(stage.path("f/mine.txt"), "mine").unwrap();
    let made = figures(&stage, &[]);
    let output = stage.pontoon(&["report", "r", "--figures", "g", "--format", "json"]);
    let told: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let files = list(&told["files"]);
    assert_eq!(files.len(), 2 * names(&made).len() + 2);
    for file in files {
        let name = Path::new(file.as_str().unwrap()).file_name().unwrap().to_str().unwrap();
        let [f, g] = ["f", "g"].map(|folder| fs::read(stage.path(&format!("{folder}/{name}"))).unwrap());
        assert_eq!(f, g, "{name}");
    }
    assert_eq!(fs::read_to_string(stage.path("f/mine.txt")).unwrap(), "mine");
    // figures that the next ones do not have go with them
    let mut numbers: Value = serde_json::from_slice(&fs::read(stage.path("f/figures.json")).unwrap()).unwrap();
    let mut older = numbers["figures"][0].clone();
    older["name"] = "older".into();
    numbers["figures"].as_array_mut().unwrap().push(older);
    fs::write(stage.path("f/figures.json"), numbers.to_string()).unwrap();
    fs::write(stage.path("f/older.svg"), "of an earlier run").unwrap();
    figures(&stage, &[]);
    assert!(!stage.path("f/older.svg").exists() && stage.path("f/mine.txt").exists());
    // a file of somebody else's under one of their names stays
    fs::create_dir(stage.path("h")).unwrap();
    fs::write(stage.path("h/figures.json"), "mine").unwrap();
    is_refused(
        &stage.pontoon(&["report", "r", "--figures", "h"]),
        &["h/figures.json", "another file"],
    );
    assert_eq!(fs::read_to_string(stage.path("h/figures.json")).unwrap(), "mine");
    assert_eq!(fs::read_dir(stage.path("h")).unwrap().count(), 1);
    let hidden = fs::read_dir(stage.path("f"))
        .unwrap()
        .filter(|e| e.as_ref().unwrap().file_name().to_str().unwrap().starts_with('.'));
    assert_eq!(hidden.count(), 0);
}

#[test]
fn names_full_of_markup_are_words_in_every_file() {
    let stage = Stage::new();
    stage.ran("r");
    let mut checks = reference(
        &json!([{ "id": "</text><script>&", "role": "record", "where": { "connection": "linear", "speed_m_s": 5 },
        "value": { "of": { "select": { "table": "jobs", "column": "peak_deflection_m" } }, "expected": 0.05 } }]),
    );
    checks["name"] = "a<b>&\"'</svg>_*[x](y)".into();
    checks["measured"] = json!([{ "id": "</text><script>alert('1')</script>\u{1}]]>", "of": { "table": "histories", "column": "deflection_m" },
        "against": "time_s", "where": { "position": 2, "speed_m_s": 5 }, "points": [[1.0, 0.01], [1.5, 0.02]] }]);
    stage.json("reference.json", &checks);
    let made = figures(&stage, &["--with", "reference.json"]);
    is_drawn(&stage, &made);
    let svg = fs::read_to_string(stage.path("f/deflection-2-by-gap_tension_m.svg")).unwrap();
    assert!(!svg.contains("<script") && svg.contains("&lt;script&gt;"));
    let captions = fs::read_to_string(stage.path("f/figures.md")).unwrap();
    // a bracket that Markdown shows has a stroke before it
    assert!(
        captions.contains("\\<script\\>") && !captions.replace("\\<", "").contains('<'),
        "{captions}"
    );
    let marks = list(&figure(&made, "deflection-2-by-gap_tension_m")["panels"][0]["marks"]);
    assert_eq!(marks.len(), 2);
}

#[test]
fn one_job_and_no_histories_are_drawn_too() {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "cases": [{ "connection": "linear", "speed_m_s": 5, "load_n": 1e5 }] }]);
    stage.study.as_object_mut().unwrap().remove("record");
    stage.ran("r");
    let made = figures(&stage, &[]);
    assert_eq!(names(&made), ["envelope-along-bridge"]);
    is_drawn(&stage, &made);
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "cases": [{ "connection": "linear", "speed_m_s": 5, "load_n": 1e5 }] }]);
    stage.study["record"] = json!({ "positions": false });
    stage.ran("r");
    let made = figures(&stage, &[]);
    assert_eq!(names(&made), Vec::<&str>::new());
    assert!(
        fs::read_to_string(stage.path("f/figures.md"))
            .unwrap()
            .starts_with("# Figures of smoke")
    );
}

#[test]
fn many_jobs_that_have_nothing_alike_are_points() {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "latin_hypercube": { "count": 9, "seed": 1,
        "ranges": { "speed_m_s": [5, 10], "gap_tension_m": [0.0, 0.03], "load_n": [5e4, 1e5] } } }]);
    stage.study.as_object_mut().unwrap().remove("record");
    stage.ran("r");
    let made = figures(&stage, &[]);
    let panel = &figure(&made, "peak-deflection")["panels"][0];
    assert_eq!(points(&panel["lines"][0]).len(), 9);
    assert_eq!(panel["lines"][0]["joined"], json!(false));
    let left_out = made["left_out"].to_string();
    assert!(left_out.contains("9 combinations of"), "{left_out}");
}

#[test]
fn what_no_figure_holds_is_told_of_those_that_are_drawn() {
    let mut stage = Stage::new();
    let gaps: Vec<f64> = (0..8).map(|i| 0.004 * f64::from(i)).collect();
    stage.study["design"] = json!([{ "grid": { "gap_tension_m": gaps, "gap_compression_m": [0.0, 0.0055],
        "load_n": [5e4, 1e5], "speed_m_s": [6, 7, 8, 9, 10, 11, 12] } }]);
    stage.study["analysis"]["tail_s"] = json!(0.1);
    stage.study["record"] = json!({ "histories": { "positions": [1, 2, 3], "joints": [2, 3] } });
    stage.ran("r");
    let made = figures(&stage, &[]);
    assert_eq!(names(&made).len(), 40);
    let left_out: Vec<&str> = list(&made["left_out"])
        .iter()
        .map(|line| line.as_str().unwrap())
        .collect();
    assert!(left_out.contains(&"by tension gap: 2 of 8 values"), "{left_out:?}");
    // two loads are lines of their own
    assert!(
        !left_out
            .iter()
            .any(|line| line.contains("by load: ") && line.contains("values"))
    );
    let of_speeds = left_out.iter().filter_map(|line| line.strip_suffix(": 1 of 7 speeds"));
    let mut of_speeds = of_speeds.peekable();
    assert!(of_speeds.peek().is_some());
    of_speeds.for_each(|name| assert!(names(&made).contains(&name), "{name}"));
}

#[test]
fn names_are_short_enough_for_files_and_stay_distinct() {
    let mut stage = Stage::new();
    // lists whose words are alike over more than 60 letters
    let alike = [1.25, 1.375].map(|last| {
        json!([
            -1.2345678, -0.8345678, -0.4345678, 0.0345678, 0.4345678, 0.8345678, last
        ])
    });
    stage.study["design"] = json!([{ "grid": { "vehicle.track_y_m": alike, "bridge.connectors.y_m": alike, "load_n": [5e4, 1e5],
        "bridge.connectors.stiffness_n_m": [1e8, 2e8], "gap_tension_m": [0.0, 0.028],
        "gap_compression_m": [0.0, 0.0055], "speed_m_s": 10 } }]);
    stage.study["analysis"]["tail_s"] = json!(0.1);
    stage.study.as_object_mut().unwrap().remove("record");
    stage.ran("r");
    let made = figures(&stage, &[]);
    let (all, distinct) = (names(&made), names(&made).into_iter().collect::<BTreeSet<_>>());
    assert!(all.len() > 6 && distinct.len() == all.len(), "{all:?}");
    // a dot before and `.svg.partial` after it while it is being written
    assert!(all.iter().all(|name| name.len() <= 255 - 13), "{all:?}");
    assert!(
        all.iter().any(|name| name.len() > 190 && name.ends_with("-2")),
        "{all:?}"
    );
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let mut stage = Stage::new();
    is_refused(
        &stage.pontoon(&["report", "none", "--figures", "f"]),
        &["none: found no such folder"],
    );
    stage.ran("r");
    fs::create_dir(stage.path("empty")).unwrap();
    is_refused(
        &stage.pontoon(&["report", "empty", "--figures", "f"]),
        &["empty: found no results"],
    );
    let mut document = reference(
        &json!([{ "id": "a", "role": "record", "value": { "of": { "select": { "table": "jobs", "column": "steps", "reduce": "max" } } } }]),
    );
    let measured = |filter: Value| {
        json!([{ "id": "m", "of": { "table": "positions", "column": "peak_deflection_m" }, "against": "x_m",
        "where": filter, "points": [[6.7, 0.1]] }])
    };
    document["measured"] = measured(json!({ "gap_tenson_m": 0 }));
    stage.json("reference.json", &document);
    let words = ["report", "r", "--with", "reference.json", "--figures", "f"];
    is_refused(
        &stage.pontoon(&words),
        &[
            "reference.json: measured[0].where.gap_tenson_m",
            "nearest known: gap_tension_m",
        ],
    );
    document["measured"] = measured(json!({ "position": 2 }));
    stage.json("reference.json", &document);
    is_refused(&stage.pontoon(&words), &["reference.json: measured[0].where.position"]);
    assert!(!stage.path("f").exists());
    // conditions that no job has: nothing to draw it in, which is said
    document["measured"] = measured(json!({ "gap_tension_m": 0.5 }));
    stage.json("reference.json", &document);
    let output = stage.pontoon(&words);
    assert_eq!(output.status.code(), Some(0));
    assert!(
        stderr(&output).contains("left out: measured 'm'"),
        "{}",
        stderr(&output)
    );
    // a file in the folder's place
    fs::write(stage.path("file"), "mine").unwrap();
    let output = stage.pontoon(&["report", "r", "--figures", "file/f"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("file/f"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(stage.path("file")).unwrap(), "mine");
    // only failed jobs
    stage.study["design"] = json!([{ "grid": { "load_n": [1e305], "speed_m_s": 15 } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "bad", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    is_refused(
        &stage.pontoon(&["report", "bad", "--figures", "f"]),
        &["bad: found ", "failed"],
    );
}
