//! The page of a report: its data are those of the tables, and a page is whole or not there.

use crate::stage::{Stage, is_refused, reference, stderr, stdout};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The data of a page, parsed as a browser does: up to the first end of its element.
fn data(page: &Path) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let begin = "<script type=\"application/json\" id=\"data\">";
    let from = text.find(begin).unwrap() + begin.len();
    let to = from + text[from..].find("</script").unwrap();
    serde_json::from_str(&text[from..to]).unwrap()
}

fn report(stage: &Stage, results: &str, more: &[&str]) -> Value {
    let words = [&["report", results, "--out", "page.html", "--format", "json"], more].concat();
    let output = stage.pontoon(&words);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let told: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(
        told["bytes"].as_u64(),
        Some(fs::metadata(stage.path("page.html")).unwrap().len())
    );
    data(&stage.path("page.html"))
}

fn bytes(packed: &Value, kind: &str) -> Vec<u8> {
    STANDARD
        .decode(packed[kind].as_str().unwrap_or_else(|| panic!("no {kind}: {packed}")))
        .unwrap()
}

/// Single precision; NaN is nothing.
fn f32s(packed: &Value) -> Vec<Option<f64>> {
    let all = bytes(packed, "f32");
    let of = |four: &[u8]| f64::from(f32::from_le_bytes(four.try_into().unwrap()));
    all.chunks(4).map(of).map(|x| Some(x).filter(|x| !x.is_nan())).collect()
}

fn u16s(packed: &Value) -> Vec<usize> {
    let all = bytes(packed, "u16");
    all.chunks(2)
        .map(|two| usize::from(u16::from_le_bytes(two.try_into().unwrap())))
        .collect()
}

fn u32s(packed: &Value) -> Vec<u32> {
    let all = bytes(packed, "u32");
    all.chunks(4)
        .map(|four| u32::from_le_bytes(four.try_into().unwrap()))
        .collect()
}

fn samples(packed: &Value) -> Vec<f64> {
    let scale = packed["scale"].as_f64().unwrap();
    let all = bytes(packed, "i16");
    all.chunks(2)
        .map(|two| scale * f64::from(i16::from_le_bytes(two.try_into().unwrap())))
        .collect()
}

fn single(x: Option<f64>) -> Option<f64> {
    x.map(|x| f64::from(x as f32))
}

fn index_of(data: &Value, list: &str, name: &str) -> usize {
    let all = data[list].as_array().unwrap();
    all.iter()
        .position(|one| one["name"] == name)
        .unwrap_or_else(|| panic!("no {name} in {list}"))
}

const MEASURES: [&str; 5] = [
    "peak_deflection_m",
    "peak_uplift_m",
    "peak_compression_n",
    "peak_tension_n",
    "dynamic_amplification",
];

#[test]
fn rows_cells_cards_and_profiles_are_those_of_the_tables() {
    let stage = Stage::new();
    stage.ran("r");
    let data = report(&stage, "r", &[]);
    assert_eq!(data["jobs"], json!({ "total": 6, "ok": 6, "failed": 0, "missing": 0 }));
    assert_eq!(data["study"]["kind"], "crossing");
    assert!(data["study"]["question"].as_str().unwrap().contains("plates"));
    let cells = &data["cells"];
    assert_eq!(u32s(&cells["jobs"]), [1; 6]);
    for name in MEASURES {
        let table = stage.numbers("r/jobs.parquet", name);
        let place = index_of(&data, "measures", name);
        // each cell has one job: its largest is its smallest is the table's
        for (cell, &job) in u32s(&cells["at"][place]).iter().enumerate() {
            let told = single(table[job as usize]);
            assert_eq!(f32s(&cells["max"][place])[cell], told, "{name} of job {job}");
            assert_eq!(f32s(&cells["min"][place])[cell], told, "{name} of job {job}");
        }
        let column = index_of(&data["rows"], "columns", name);
        let rows = f32s(&data["rows"]["columns"][column]["data"]);
        assert_eq!(rows, table.iter().copied().map(single).collect::<Vec<_>>(), "{name}");
        if let Some(card) = data["cards"]
            .as_array()
            .unwrap()
            .iter()
            .find(|card| card["measure"] == name)
        {
            let largest = table.iter().flatten().fold(0.0_f64, |most, x| most.max(*x));
            assert_eq!(card["value"].as_f64(), Some(largest), "{name}");
            assert_eq!(table[card["job"].as_u64().unwrap() as usize], Some(largest), "{name}");
        }
    }
    // axes of cells are those of their jobs
    let speeds = stage.numbers("r/jobs.parquet", "speed_m_s");
    let axis = index_of(&data, "axes", "speed_m_s");
    let of_axis = u16s(&cells["axis"][axis]);
    for (cell, &job) in u32s(&cells["at"][0]).iter().enumerate() {
        let value = data["axes"][axis]["values"][of_axis[cell]].as_f64();
        assert_eq!(value, speeds[job as usize]);
    }
    // a linear connection has no gap
    let gap = index_of(&data, "axes", "gap_tension_m");
    assert_eq!(data["axes"][gap]["values"], json!([0.0, 0.028, null]));
    let ends = stage.numbers("r/positions.parquet", "peak_deflection_m");
    let profile = f32s(&data["rows"]["profile"]["deflection_m"]);
    assert_eq!(profile, ends.iter().copied().map(single).collect::<Vec<_>>());
    let envelope = f32s(&data["envelope"]["deflection_m"]);
    for (place, most) in envelope.iter().enumerate() {
        let largest = ends
            .iter()
            .skip(place)
            .step_by(4)
            .flatten()
            .fold(0.0_f64, |most, x| most.max(*x));
        assert_eq!(*most, single(Some(largest)), "position {}", place + 1);
    }
    let (y, forces) = (
        stage.numbers("r/connectors.parquet", "y_m"),
        stage.numbers("r/connectors.parquet", "peak_compression_n"),
    );
    let sums: Vec<Option<f64>> = y
        .iter()
        .zip(&forces)
        .filter(|(y, _)| y.is_none())
        .map(|(_, f)| single(*f))
        .collect();
    assert_eq!(f32s(&data["rows"]["profile"]["compression_n"]), sums);
}

#[test]
fn crossings_that_are_played_reach_the_peaks_of_the_tables() {
    let stage = Stage::new();
    stage.ran("r");
    let data = report(&stage, "r", &[]);
    let plays = data["plays"].as_array().unwrap();
    assert_eq!(plays.len(), 6);
    assert!(data["notes"].as_array().unwrap().is_empty(), "{}", data["notes"]);
    let column = |name| stage.numbers("r/jobs.parquet", name);
    let (deflection, uplift) = (column("peak_deflection_m"), column("peak_uplift_m"));
    let (compression, tension) = (column("peak_compression_n"), column("peak_tension_n"));
    let speed = column("speed_m_s");
    for play in plays {
        let (job, frames) = (
            play["job"].as_u64().unwrap() as usize,
            play["frames"].as_u64().unwrap() as usize,
        );
        let (motion, force) = (samples(&play["deflection_m"]), samples(&play["force_n"]));
        assert_eq!((motion.len(), force.len()), (4 * frames, 2 * frames));
        let reach = |list: &[f64], sign: f64| list.iter().fold(0.0_f64, |most, x| most.max(sign * x));
        // half a step of the samples
        let near = |found: f64, told: Option<f64>, packed: &Value| {
            let off = (found - told.unwrap()).abs();
            assert!(
                off <= 0.51 * packed["scale"].as_f64().unwrap(),
                "job {job}: {found} for {told:?}"
            );
        };
        near(reach(&motion, 1.0), deflection[job], &play["deflection_m"]);
        near(reach(&motion, -1.0), uplift[job], &play["deflection_m"]);
        near(reach(&force, -1.0), compression[job], &play["force_n"]);
        near(reach(&force, 1.0), tension[job], &play["force_n"]);
        let states = bytes(&play["state"], "u8");
        for (state, force) in states.iter().zip(&force) {
            let scale = play["force_n"]["scale"].as_f64().unwrap();
            let by_sample = if *force < 0.0 { 1 } else { 2 };
            assert!(force.abs() <= scale || *state == by_sample, "{state} at {force} N");
        }
        for (time, front) in f32s(&play["time_s"]).iter().zip(f32s(&play["vehicles"][0]["front_x_m"])) {
            let expected = speed[job].unwrap() * time.unwrap();
            assert!((front.unwrap() - expected).abs() < 1e-4, "{front:?} m at {time:?} s");
        }
    }
    // job 2 has a wide tension gap and job 4 none: what is open in one pulls in the other
    let states = |job: usize| bytes(&plays[job]["state"], "u8");
    assert!(states(2).contains(&0) && states(4).contains(&2));
    assert!(!states(0)[10..].contains(&0), "a linear connection is never open");
}

#[test]
fn the_same_results_give_the_same_bytes_and_a_page_replaces_none_but_a_page() {
    let stage = Stage::new();
    stage.ran("r");
    let page = |words: &[&str]| {
        let output = stage.pontoon(&[&["report", "r"], words].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read(stage.path("r/report.html")).unwrap()
    };
    let first = page(&[]);
    assert_eq!(first, page(&["--quiet"]));
    assert_ne!(first, page(&["--plays", "2"]));
    fs::write(stage.path("notes.txt"), "mine").unwrap();
    for (out, found) in [
        ("notes.txt", "another file"),
        ("r/jobs.parquet", "another file"),
        ("r", "a folder"),
    ] {
        let before = fs::read(stage.path(out)).ok();
        is_refused(
            &stage.pontoon(&["report", "r", "--out", out]),
            &[out, found, "a page of `pontoon report`"],
        );
        assert_eq!(fs::read(stage.path(out)).ok(), before);
    }
    // a link leads to its page and stays a link; what is no file is not waited for
    std::os::unix::fs::symlink("r/report.html", stage.path("link.html")).unwrap();
    assert_eq!(
        stage.pontoon(&["report", "r", "--out", "link.html"]).status.code(),
        Some(0)
    );
    assert!(stage.path("link.html").is_symlink());
    assert_eq!(first, fs::read(stage.path("r/report.html")).unwrap());
    let made = std::process::Command::new("mkfifo")
        .arg(stage.path("pipe"))
        .status()
        .unwrap();
    assert!(made.success());
    is_refused(
        &stage.pontoon(&["report", "r", "--out", "pipe"]),
        &["pipe", "no regular file"],
    );
    // and results that are set aside take their page with them
    let again = stage.pontoon(&["run", "study.json", "--out", "moved", "--quiet"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    assert_eq!(stage.pontoon(&["report", "moved"]).status.code(), Some(0));
    let fresh = stage.pontoon(&["run", "study.json", "--out", "moved", "--quiet", "--fresh"]);
    assert_eq!(fresh.status.code(), Some(0), "{}", stderr(&fresh));
    assert!(!stage.path("moved/report.html").exists());
    // a page that cannot be written whole leaves the old one
    let old = fs::read(stage.path("r/report.html")).unwrap();
    fs::create_dir(stage.path("r/.report.html.partial")).unwrap();
    let output = stage.pontoon(&["report", "r"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert_eq!(fs::read(stage.path("r/report.html")).unwrap(), old);
}

#[test]
fn a_folder_without_results_is_refused() {
    let stage = Stage::new();
    fs::create_dir(stage.path("empty")).unwrap();
    is_refused(
        &stage.pontoon(&["report", "empty"]),
        &["empty", "manifest.json is missing"],
    );
    is_refused(&stage.pontoon(&["report", "nothing"]), &["nothing", "no such folder"]);
    stage.write();
    is_refused(&stage.pontoon(&["report", "study.json"]), &["study.json"]);
    assert!(!stage.path("empty/report.html").exists());
}

#[test]
fn names_full_of_markup_are_text() {
    let mut stage = Stage::new();
    let nasty = "</script><script>alert(1)</script><!-- & \u{2028} \"'";
    stage.study["question"] = nasty.into();
    stage.bridge["name"] = nasty.into();
    stage.ran("r");
    let mut held = reference(&json!([{ "id": nasty, "statement": nasty, "value": { "of":
        { "select": { "table": "jobs", "column": "peak_deflection_m", "reduce": "max" } }, "expected": 0.1, "relative_tolerance": 10 } }]));
    held["source"] = nasty.into();
    stage.json("reference.json", &held);
    let data = report(&stage, "r", &["--with", "reference.json"]);
    assert_eq!(data["study"]["question"], nasty);
    assert_eq!(
        (&data["verdicts"]["source"], &data["verdicts"]["lines"][0]["id"]),
        (&json!(nasty), &json!(nasty))
    );
    let text = fs::read_to_string(stage.path("page.html")).unwrap();
    assert!(!text.contains("<script>alert"));
    // it stands in the markup too, as text
    assert!(
        text[..text.find("id=\"data\"").unwrap()].contains("&#60;"),
        "{text:.9000}"
    );
    assert_eq!(
        text.matches("</script").count(),
        2,
        "one for the data and one for the script"
    );
}

#[test]
fn a_run_that_is_not_done_gives_a_page_that_says_so() {
    let stage = Stage::new();
    stage.ran("r");
    let whole = report(&stage, "r", &[]);
    // as a process leaves it that dies before its tables
    for name in [
        "manifest.json",
        "jobs.parquet",
        "positions.parquet",
        "connectors.parquet",
        "histories.parquet",
    ] {
        fs::remove_file(stage.path("r").join(name)).unwrap();
    }
    let data = report(&stage, "r", &[]);
    let note = data["notes"][0].as_str().unwrap();
    assert!(
        note.contains("6 of 6 jobs are recorded: the tables are not there"),
        "{note}"
    );
    for part in ["cells", "rows", "cards", "plays", "envelope", "histories"] {
        assert_eq!(data[part], whole[part], "{part}");
    }
    let output = stage.pontoon(&["run", "study.json", "--out", "share", "--shard", "1/2", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let data = report(&stage, "share", &[]);
    let jobs = &data["jobs"];
    assert_eq!(jobs["total"], 6);
    assert!(
        jobs["missing"].as_u64() > Some(0) && jobs["ok"].as_u64() > Some(0),
        "{jobs}"
    );
    assert!(
        data["notes"][0].as_str().unwrap().contains("share 1/2"),
        "{}",
        data["notes"]
    );
}

#[test]
fn only_failed_jobs_one_job_and_one_axis_are_told() {
    let mut stage = Stage::new();
    stage.study["analysis"]["step_limit"] = 1.into();
    let failed = |stage: &Stage| {
        let output = stage
            .write()
            .pontoon(&["run", "study.json", "--out", "r", "--quiet", "--fresh"]);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let output = stage.pontoon(&["report", "r", "--out", "page.html"]);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        data(&stage.path("page.html"))
    };
    let none = failed(&stage);
    assert_eq!(none["jobs"], json!({ "total": 6, "ok": 0, "failed": 6, "missing": 0 }));
    assert_eq!(
        (none["cards"].clone(), none["measures"].clone()),
        (json!([]), json!([]))
    );
    let listed: u64 = none["failures"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["count"].as_u64().unwrap())
        .sum();
    assert_eq!(listed, 6);
    assert_eq!(none["plays"], json!([]));
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": { "speed_m_s": 10, "load_n": 1e5 } }]);
    stage.ran("one");
    let one = report(&stage, "one", &[]);
    assert_eq!(one["cells"]["count"], 1);
    assert!(
        one["axes"]
            .as_array()
            .unwrap()
            .iter()
            .all(|axis| axis["constant"] == true)
    );
    assert!(
        one["cards"][0]["axes"].as_str().unwrap().contains("10 m/s"),
        "{}",
        one["cards"]
    );
}

#[test]
fn static_cases_have_their_line_and_modes_their_table() {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "grid": { "load_position": [2, 3], "load_n": 1e5 } }]);
    stage.study["record"] = json!({});
    stage.ran("s");
    let data = report(&stage, "s", &[]);
    let told = stage.numbers("s/positions.parquet", "deflection_m");
    let line = f32s(&data["rows"]["profile"]["signed_m"]);
    assert_eq!(line, told.iter().copied().map(single).collect::<Vec<_>>());
    assert!(line.iter().flatten().any(|x| *x > 0.01));
    index_of(&data, "measures", "influential_length_m");
    stage.study["analysis"] = json!({ "kind": "modes", "count": 6 });
    stage.study["design"] = json!([{ "grid": { "bridge.modules": [1, 3] } }]);
    stage.ran("m");
    let data = report(&stage, "m", &[]);
    let frequencies = stage.numbers("m/modes.parquet", "frequency_hz");
    let table = data["mode_table"].as_array().unwrap();
    let listed: Vec<Option<f64>> = table.iter().map(|row| row["frequency_hz"].as_f64()).collect();
    assert_eq!(listed, frequencies);
    for (set, modules) in data["modes"].as_array().unwrap().iter().zip([1, 3]) {
        for mode in set["list"].as_array().unwrap() {
            let motion = f32s(&mode["motion"]);
            let largest = motion.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert_eq!((motion.len(), largest), (modules * 8 * 3, 1.0));
        }
    }
}

#[test]
fn a_large_study_is_told_in_aggregate() {
    let mut stage = Stage::new();
    stage.study["vehicle"]["inertia"] = "none".into();
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": 0.05, "tail_s": 0.1 });
    stage.study["record"] = json!({});
    stage.study["design"] = json!([{ "latin_hypercube": { "count": 3000, "seed": 1, "ranges":
        { "gap_tension_m": [0.0, 0.04], "speed_m_s": [5, 20], "load_n": 1e5, "gap_compression_m": 0.0055 } } }]);
    stage.ran("r");
    let data = report(&stage, "r", &["--plays", "7"]);
    let (count, table) = (
        &data["cells"]["count"],
        stage.numbers("r/jobs.parquet", "peak_deflection_m"),
    );
    assert!(count.as_u64() < Some(3000), "{count}");
    assert_eq!(u32s(&data["cells"]["jobs"]).iter().sum::<u32>(), 3000);
    let rows = data["rows"]["count"].as_u64().unwrap();
    assert!((1_500..=2_000).contains(&rows), "{rows}");
    assert_eq!(data["plays"].as_array().unwrap().len(), 7);
    // the cells worked out anew from the ranges' edges: each holds its jobs, the largest of them, the smallest
    let (speed, gap) = (
        stage.numbers("r/jobs.parquet", "speed_m_s"),
        stage.numbers("r/jobs.parquet", "gap_tension_m"),
    );
    let bins = |name: &str| -> Vec<[f64; 2]> {
        let of = |bin: &Value| [0, 1].map(|end| bin[end].as_f64().unwrap());
        let axis = &data["axes"][index_of(&data, "axes", name)];
        axis["bins"].as_array().unwrap().iter().map(of).collect()
    };
    let place = |bins: &[[f64; 2]], x: f64| bins.iter().position(|bin| x < bin[1]).unwrap_or(bins.len() - 1);
    let (speeds, gaps) = (bins("speed_m_s"), bins("gap_tension_m"));
    let mut expected: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for job in 0..3000 {
        let key = (place(&gaps, gap[job].unwrap()), place(&speeds, speed[job].unwrap()));
        expected.entry(key).or_default().push(job);
    }
    let of_cell = |name: &str| u16s(&data["cells"]["axis"][index_of(&data, "axes", name)]);
    let (cell_speed, cell_gap) = (of_cell("speed_m_s"), of_cell("gap_tension_m"));
    let measure = index_of(&data, "measures", "peak_deflection_m");
    let numbers = |of: &str| f32s(&data["cells"][of][measure]);
    let (largest, smallest, at) = (numbers("max"), numbers("min"), u32s(&data["cells"]["at"][measure]));
    let (jobs, count) = (u32s(&data["cells"]["jobs"]), largest.len());
    assert_eq!(count, expected.len());
    for cell in 0..count {
        let own = &expected[&(cell_gap[cell], cell_speed[cell])];
        let values = || own.iter().filter_map(|&job| table[job]);
        assert_eq!(jobs[cell] as usize, own.len(), "cell {cell}");
        assert_eq!(largest[cell], single(values().reduce(f64::max)), "cell {cell}");
        assert_eq!(smallest[cell], single(values().reduce(f64::min)), "cell {cell}");
        assert_eq!(single(table[at[cell] as usize]), largest[cell], "cell {cell}");
    }
    // the job with the largest deflection of all is the first to be played
    let deepest = (0..3000)
        .max_by(|&a, &b| table[a].unwrap().total_cmp(&table[b].unwrap()))
        .unwrap();
    let one = report(&stage, "r", &["--plays", "1"]);
    assert_eq!(one["plays"].as_array().unwrap().len(), 1);
    assert_eq!(one["plays"][0]["job"], deepest);
}

#[test]
fn failed_jobs_are_in_their_cells_and_bridges_may_differ() {
    let mut stage = Stage::new();
    stage.study["analysis"]["step_limit"] = 200.into();
    stage.study["design"] = json!([{ "grid": { "bridge.modules": [2, 3], "speed_m_s": [4, 10, 20], "load_n": 1e5 } }]);
    stage.study["record"] = json!({});
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let data = report(&stage, "r", &[]);
    let (jobs, failed) = (u32s(&data["cells"]["jobs"]), u32s(&data["cells"]["failed"]));
    assert_eq!(jobs, [1; 6]);
    let told = data["jobs"]["failed"].as_u64().unwrap();
    assert!(told > 0 && told < 6, "{told}");
    assert_eq!(u64::from(failed.iter().sum::<u32>()), told);
    // their reasons differ in numbers alone
    assert_eq!(
        (
            data["failures"].as_array().unwrap().len(),
            &data["failures"][0]["count"]
        ),
        (1, &json!(told))
    );
    // profiles are as wide as the longest bridge, the shorter one's end in nothing
    let ends = stage.numbers("r/positions.parquet", "position");
    let of_job = stage.numbers("r/positions.parquet", "job");
    let deflection = stage.numbers("r/positions.parquet", "peak_deflection_m");
    let profile = f32s(&data["rows"]["profile"]["deflection_m"]);
    assert_eq!(profile.len(), 6 * 4);
    let mut expected = vec![None; 6 * 4];
    for ((job, end), value) in of_job.iter().zip(&ends).zip(&deflection) {
        expected[job.unwrap() as usize * 4 + end.unwrap() as usize - 1] = single(*value);
    }
    assert_eq!(profile, expected);
    for play in data["plays"].as_array().unwrap() {
        let modules = if play["job"].as_u64() < Some(3) { 2 } else { 3 };
        let own = if play["bridge"].is_null() {
            &data["bridge"]
        } else {
            &play["bridge"]
        };
        assert_eq!(own["modules"], modules, "{}", play["job"]);
        let frames = play["frames"].as_u64().unwrap() as usize;
        assert_eq!(samples(&play["deflection_m"]).len(), frames * (modules + 1));
    }
    // positions at different places make no line
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": 0.02, "tail_s": 1.0 });
    stage.study["design"] =
        json!([{ "grid": { "bridge.module.length_m": [6.7, 6.8], "speed_m_s": 20, "load_n": 1e5 } }]);
    stage.bridge["module"]["stiffeners"]["transverse_x_m"] = json!([0.0, 3.35]);
    stage.ran("s");
    let data = report(&stage, "s", &[]);
    assert!(data["envelope"].is_null() && data["rows"]["profile"].is_null());
    assert!(
        data["notes"][0].as_str().unwrap().contains("different places"),
        "{}",
        data["notes"]
    );
}

/// A server may forbid the page's script; what stands in the markup is then all there is.
#[test]
fn the_page_says_its_largest_values_without_its_script() {
    let mut stage = Stage::new();
    stage.study["design"] =
        json!([{ "grid": { "gap_tension_m": [0.0, 0.028], "speed_m_s": [5, 10], "load_n": [1e5, 2e5] } }]);
    stage.ran("r");
    let data = report(&stage, "r", &[]);
    let text = fs::read_to_string(stage.path("page.html")).unwrap();
    let markup = &text[text.find("<body>").unwrap()..text.find("id=\"data\"").unwrap()];
    assert!(markup.contains("This page needs scripts for its figures"), "{markup}");
    let cards = data["cards"].as_array().unwrap();
    assert!(!cards.is_empty());
    for card in cards {
        let label = card["label"].as_str().unwrap();
        assert!(markup.contains(&format!("<td>{label}</td>")), "{label}: {markup}");
    }
    let said = |speed: f64| {
        let (speeds, peaks) = (
            stage.numbers("r/jobs.parquet", "speed_m_s"),
            stage.numbers("r/jobs.parquet", "peak_deflection_m"),
        );
        let own = speeds.iter().zip(peaks).filter(|(own, _)| **own == Some(speed));
        let most = own.filter_map(|(_, peak)| peak).fold(0.0, f64::max);
        pontoon_results::labels::value("peak_deflection_m", &pontoon_plan::input::Cell::Number(most))
    };
    for speed in [5.0, 10.0] {
        let row = format!("<tr><td>{speed} m/s</td><td>{}</td>", said(speed));
        assert!(markup.contains(&row), "{row}: {markup}");
    }
}
