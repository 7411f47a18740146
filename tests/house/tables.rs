//! Tests of tables that are written as their rows come.

use crate::stage::Frame;
use pontoon_journal::place::Folder;
use pontoon_plan::input::Cell;
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::{Kind, Study};
use pontoon_results::{
    Failure, FailureKind, JobNumbers, JobRecord, Manifest, MemoryTables, ModeRow, Moment, Outcome, Results, Table,
    TableName, TableProvenance, TableWriter,
};
use pontoon_study::run::{Batch, CancelToken, Setting, Silent, run};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A study on the smoke study's bridge with its jobs.
fn study(kind: &str, design: Value) -> (Study, Vec<Job>) {
    let dir = tempfile::tempdir().unwrap();
    let smoke = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json");
    let mut bridge: Value = serde_json::from_str(&fs::read_to_string(smoke).unwrap()).unwrap();
    bridge.as_object_mut().unwrap().remove("source");
    fs::write(dir.path().join("b.json"), bridge.to_string()).unwrap();
    let histories = json!({ "histories": { "positions": [2], "joints": [3] } });
    let (analysis, record) = match kind {
        "modes" => (json!({ "kind": kind, "count": 8 }), json!({})),
        "static" => (json!({ "kind": kind }), json!({})),
        _ => (json!({ "kind": kind, "time_step_s": 0.05, "tail_s": 1.0 }), histories),
    };
    let study = json!({ "name": "s", "bridge": "b.json", "analysis": analysis, "design": design, "record": record });
    fs::write(dir.path().join("study.json"), study.to_string()).unwrap();
    let study = Study::open(dir.path()).unwrap();
    let jobs = Jobs::new(&study).collect::<Result<_, _>>().unwrap();
    (study, jobs)
}

/// Crossings whose first ones leave an axis of words empty, and whose speeds come back to a combination later.
fn crossings() -> (Study, Vec<Job>) {
    let plain = json!({ "connection": "linear", "speed_m_s": [20, 15], "load_n": [1e5, 2e5] });
    let more = json!({ "gap_tension_m": [0.0, 0.028], "speed_m_s": [12, 10], "load_n": 1e5, "bridge.source": "a, b",
                       "vehicle.track_y_m": [[-1.0, 1.0]] });
    let again = json!({ "connection": "linear", "speed_m_s": 10, "load_n": 2e5 });
    study(
        "crossing",
        json!([{ "grid": plain }, { "grid": more }, { "cases": [again] }]),
    )
}

/// The records of a study, the last but one made to fail.
fn records(study: &Study, jobs: &[Job]) -> (Vec<JobRecord>, Outcome) {
    let mut all = Vec::new();
    let mut sink = |records| {
        all.extend(records);
        Ok::<(), std::io::Error>(())
    };
    let outcome = run(
        study,
        jobs,
        Setting::default(),
        &CancelToken::default(),
        &Silent,
        Some(&mut sink),
    )
    .unwrap();
    let place = all.len() - 2;
    all[place] = JobRecord::failed(&jobs[place], failure());
    (all, outcome)
}

fn failure() -> Failure {
    Failure::new(FailureKind::NotFinite, "why")
}

fn begun<'a>(of: &'a (Study, Vec<Job>), folder: &'a Folder) -> TableWriter<'a> {
    TableWriter::begin(&of.0, &of.1, folder, &TableProvenance::default()).unwrap()
}

fn manifest((study, jobs): &(Study, Vec<Job>), outcome: &Outcome) -> Manifest {
    Manifest::new(
        study,
        jobs,
        outcome,
        Moment::now(),
        Moment::now(),
        &TableProvenance::default(),
    )
}

fn read(folder: &Folder, name: TableName) -> Frame {
    Frame::read(&folder.path().join(name.file()))
}

/// The summary as it is defined, all records at hand.
fn summary_csv(study: &Study, jobs: &[Job], records: &[JobRecord]) -> String {
    let quoted = |text: String| {
        if text.contains(',') {
            format!("\"{}\"", text.replace('"', "\"\""))
        } else {
            text
        }
    };
    let cell = |cell: Cell<'_>| quoted(cell.text());
    let others: Vec<String> = study.axis_columns().into_iter().filter(|a| a != "speed_m_s").collect();
    type Rows = Vec<(f64, Vec<String>)>;
    let mut groups: Vec<(Vec<String>, Rows)> = Vec::new();
    for (job, record) in jobs.iter().zip(records) {
        let group: Vec<String> = others.iter().map(|name| cell(job.column(name))).collect();
        let s = &record.summary;
        let peaks = [
            s.peak_deflection_m,
            s.peak_uplift_m,
            s.peak_compression_n,
            s.peak_tension_n,
        ];
        let speed = (study.analysis.kind() == Kind::Crossing).then(|| job.column("speed_m_s"));
        let at = speed.as_ref().and_then(Cell::number).unwrap_or_default();
        let row = speed.into_iter().chain(peaks.map(Cell::from)).map(cell).collect();
        match groups.iter_mut().find(|(known, _)| *known == group) {
            Some((_, rows)) => rows.push((at, row)),
            None => groups.push((group, vec![(at, row)])),
        }
    }
    let mut text = String::new();
    for (group, mut rows) in groups {
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, row) in rows {
            text += &([group.clone(), row].concat().join(",") + "\n");
        }
    }
    text
}

#[test]
fn numbers_of_jobs_are_those_of_their_table() {
    let places = json!([{ "grid": { "load_position": [1, 2, 3], "load_n": [1e5, 2e5] } }]);
    for of in [crossings(), study("static", places)] {
        let (study, jobs) = (&of.0, &of.1);
        let (records, _) = records(study, jobs);
        let mut tables = MemoryTables::begin(study, jobs).unwrap();
        tables.append(jobs, &records).unwrap();
        let table = tables.finish().remove(&TableName::Jobs).unwrap();
        let names = table.names().filter(|name| table.numbers(name).is_some());
        let mut names: Vec<String> = names.map(str::to_owned).collect();
        let known = names.clone();
        // in any order, and twice
        names.reverse();
        names.push("job".to_owned());
        let mut numbers = JobNumbers::begin(study, jobs, &names).unwrap();
        for (jobs, records) in jobs.chunks(2).zip(records.chunks(2)) {
            numbers.append(jobs, records);
        }
        for (name, found) in names.iter().zip(&numbers.numbers) {
            let bits = |of: &[f64]| of.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
            assert_eq!(bits(found), bits(&table.numbers(name).unwrap()), "{name}");
        }
        assert_eq!(numbers.failures, [(jobs.len() - 2, "why".to_owned())].into());
        for (place, name) in [(1, "status"), (0, "reason"), (1, "peak_deflection")] {
            let mut asked = vec!["steps".to_owned(), "job".to_owned()];
            asked[place] = name.to_owned();
            let none = JobNumbers::begin(study, jobs, &asked).unwrap_err();
            assert_eq!((none.place, &none.known), (place, &known), "{name}");
        }
    }
}

#[test]
fn tables_are_the_same_however_their_rows_come() {
    let places = json!([{ "grid": { "load_position": [1, 2, 3], "load_n": [1e5, 2e5] } }]);
    for of in [crossings(), study("static", places)] {
        let (study, jobs) = (&of.0, &of.1);
        let (records, outcome) = records(study, jobs);
        let whole = Results::of_records(study, jobs, &records, Path::new("r"));
        let (mut hashes, mut at_once) = (Vec::new(), Vec::new());
        for (size, several) in [(records.len(), false), (1, true), (2, true)] {
            let dir = tempfile::tempdir().unwrap();
            let folder = Folder::create(dir.path()).unwrap();
            let mut writer = begun(&of, &folder);
            records.chunks(size).for_each(|batch| writer.append(batch).unwrap());
            let summary = writer.finish(manifest(&of, &outcome)).unwrap();
            let left = TableName::ALL
                .into_iter()
                .filter(|name| dir.path().join(name.file()).exists());
            let frames: Vec<(TableName, Frame)> = left.map(|name| (name, read(&folder, name))).collect();
            assert!(frames.len() > 2, "only {} tables", frames.len());
            for (name, frame) in &frames {
                // whole numbers are whole, others are not
                assert!(frame.column("job").unwrap().i64().is_some(), "{name:?}");
                for (column, whole) in [
                    ("steps", true),
                    ("joint", true),
                    ("position", true),
                    ("x_m", false),
                    ("value", false),
                ] {
                    let Some(column) = frame.column(column) else { continue };
                    assert_eq!(
                        (column.i64().is_some(), column.f64().is_some()),
                        (whole, !whole),
                        "{name:?}"
                    );
                }
            }
            if at_once.is_empty() {
                at_once = frames;
            } else {
                assert_eq!(frames.len(), at_once.len());
                for ((name, found), (_, expected)) in frames.iter().zip(&at_once) {
                    assert!(found.same_cells(expected), "{name:?} in batches of {size}");
                }
            }
            let results = Results::read(dir.path()).unwrap();
            for name in TableName::ALL {
                assert_eq!(results.table(name), whole.table(name), "{name:?} in batches of {size}");
            }
            let csv = fs::read_to_string(dir.path().join("summary.csv")).unwrap();
            let (head, rows) = csv.split_once('\n').unwrap();
            assert_eq!(head, summary.columns().join(","));
            assert_eq!(rows, summary_csv(study, jobs, &records));
            assert_eq!(summary.len(), jobs.len());
            assert!(!fs::read_dir(dir.path()).unwrap().any(|entry| {
                let name = entry.unwrap().file_name();
                name.to_string_lossy().contains("partial")
            }));
            if several {
                let positions = fs::read(dir.path().join("positions.parquet")).unwrap();
                hashes.push((size, blake3::hash(&positions)));
            }
        }
        assert_ne!(hashes[0].1, hashes[1].1, "row groups follow batches");
    }
}

#[test]
fn batches_on_one_and_three_threads_write_the_same_bytes() {
    let of = crossings();
    let bytes = [1, 3].map(|threads| {
        let dir = tempfile::tempdir().unwrap();
        let folder = Folder::create(dir.path()).unwrap();
        let mut writer = begun(&of, &folder);
        let batch = Batch {
            most_jobs: 2,
            ..Batch::default()
        };
        let mut sink = |records: Vec<JobRecord>| writer.append(&records);
        let outcome = run(
            &of.0,
            &of.1,
            Setting {
                threads,
                batch,
                ..Setting::default()
            },
            &CancelToken::default(),
            &Silent,
            Some(&mut sink),
        )
        .unwrap();
        let manifest = manifest(&of, &outcome);
        writer.finish(manifest).unwrap();
        let files =
            ["jobs", "positions", "connectors", "histories"].map(|name| dir.path().join(format!("{name}.parquet")));
        let csv = dir.path().join("summary.csv");
        files
            .into_iter()
            .chain([csv])
            .map(|file| fs::read(file).unwrap())
            .collect::<Vec<_>>()
    });
    assert!(bytes[0] == bytes[1]);
}

#[test]
fn an_axis_keeps_its_type_where_a_batch_does_not_show_it() {
    let of = crossings();
    let (records, outcome) = records(&of.0, &of.1);
    let empty =
        of.1.iter()
            .take_while(|job| job.column("bridge.source").is_nothing())
            .count();
    assert_eq!(empty, 4);
    let dir = tempfile::tempdir().unwrap();
    let folder = Folder::create(dir.path()).unwrap();
    let mut writer = begun(&of, &folder);
    for batch in [&records[..empty], &records[empty..]] {
        writer.append(batch).unwrap();
    }
    writer.finish(manifest(&of, &outcome)).unwrap();
    let jobs = read(&folder, TableName::Jobs);
    assert!(jobs.column("bridge.source").unwrap().str().is_some());
}

#[test]
fn a_table_without_rows_is_a_table() {
    let of = crossings();
    let (_, outcome) = records(&of.0, &of.1);
    let dir = tempfile::tempdir().unwrap();
    let folder = Folder::create(dir.path()).unwrap();
    let mut writer = begun(&of, &folder);
    for job in &of.1 {
        // a job that failed has no histories
        writer.append(&[JobRecord::failed(job, failure())]).unwrap();
    }
    writer.append(&[]).unwrap();
    writer.finish(manifest(&of, &outcome)).unwrap();
    let histories = read(&folder, TableName::Histories);
    assert_eq!((histories.height(), histories.names().len()), (0, 5));
    assert!(histories.column("value").unwrap().f64().is_some());
    let results = Results::read(dir.path()).unwrap();
    assert_eq!(results.table(TableName::Histories).map(Table::rows), Some(0));
    assert_eq!(results.jobs().rows(), of.1.len());
}

/// Equal cells have one number, in the order of their first row; empty ones none.
#[test]
fn the_distinct_cells_of_a_column_are_numbered() {
    let of = crossings();
    let (records, _) = records(&of.0, &of.1);
    let results = Results::of_records(&of.0, &of.1, &records, Path::new("r"));
    let jobs = results.jobs();
    for axis in results.axes() {
        let codes = jobs.codes(&axis);
        let cells: Vec<Cell<'_>> = (0..jobs.rows()).map(|row| jobs.cell(&axis, row)).collect();
        let mut known: Vec<&Cell<'_>> = Vec::new();
        for (cell, code) in cells.iter().zip(&codes) {
            if !cell.is_nothing() && !known.contains(&cell) {
                known.push(cell);
            }
            assert_eq!(*code, known.iter().position(|k| *k == cell).map(|k| k as u32), "{axis}");
        }
    }
    assert_eq!(
        jobs.codes("connection")[..5],
        [Some(0), Some(0), Some(0), Some(0), Some(1)]
    );
    assert_eq!(jobs.codes("gap_tension_m")[..5], [None, None, None, None, Some(0)]);
    assert_eq!(jobs.codes("nothing"), vec![None; jobs.rows()]);
}

/// A row's job is its number and not its row, and a job that failed is known as such.
#[test]
fn rows_have_the_numbers_of_their_jobs_and_say_who_failed() {
    let of = crossings();
    let (mut records, _) = records(&of.0, &of.1);
    records.remove(0);
    let jobs = &of.1[1..];
    let results = Results::of_records(&of.0, jobs, &records, Path::new("r"));
    assert_eq!(results.kind(), Kind::Crossing);
    let failed = records.len() - 2;
    for row in 0..jobs.len() {
        assert_eq!(results.job_of_row(row), row as u64 + 1);
        assert_eq!(results.row_of_job(row as u64 + 1), Some(row));
        assert_eq!(results.is_failed(row), row == failed);
    }
}

#[test]
fn modes_have_a_row_each_in_the_table_and_in_the_summary() {
    let of = study("modes", json!([{ "grid": { "bridge.modules": [2, 3] } }]));
    let (mut records, outcome) = records(&of.0, &of.1);
    assert!(records[0].modes.is_empty());
    records[0].modes = records[1].modes[..3].to_vec();
    let dir = tempfile::tempdir().unwrap();
    let folder = Folder::create(dir.path()).unwrap();
    let mut writer = begun(&of, &folder);
    records.chunks(1).for_each(|batch| writer.append(batch).unwrap());
    let summary = writer.finish(manifest(&of, &outcome)).unwrap();
    assert_eq!(summary.columns(), ["bridge.modules", "number", "frequency_hz", "shape"]);
    let found: Vec<Vec<Cell<'_>>> = summary.rows().collect();
    fn row(modules: usize, mode: &ModeRow) -> Vec<Cell<'_>> {
        vec![
            modules.into(),
            mode.number.into(),
            mode.frequency_hz.into(),
            mode.shape.as_str().into(),
        ]
    }
    let expected = records[0].modes.iter().map(|m| row(2, m));
    let expected: Vec<_> = expected.chain(records[1].modes.iter().map(|m| row(3, m))).collect();
    assert_eq!(found, expected);
    assert_eq!(read(&folder, TableName::Modes).height(), 3 + 8);
}

#[test]
fn tables_that_are_not_finished_leave_the_old_results() {
    let of = crossings();
    let (records, outcome) = records(&of.0, &of.1);
    let dir = tempfile::tempdir().unwrap();
    let folder = Folder::create(dir.path()).unwrap();
    let mut writer = begun(&of, &folder);
    writer.append(&records).unwrap();
    writer.finish(manifest(&of, &outcome)).unwrap();
    let names = || {
        let entries = fs::read_dir(dir.path()).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    let whole = names();
    let mut writer = begun(&of, &folder);
    writer.append(&records[..2]).unwrap();
    assert_eq!(names().len(), whole.len() + 4);
    drop(writer);
    assert_eq!(names(), whole);
    Results::read(dir.path()).unwrap();
}
