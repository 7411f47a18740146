//! A refusal of a file shows its place: file, line, column, the line and a mark under what was refused.

use crate::stage::{Stage, one_message, stderr, stdout};
use std::fs;

const STUDY: &str = r#"{
  "name": "smoke",
  "bridge": "bridge.json",
  "vehicle": { "footprint_length_m": 3.35, "track_y_m": [-1.4, 1.4], "inertia": "local" },
  "analysis": { "kind": "crossing", "time_step_s": 0.02, "tail_s": 2.0 },
  "design": [
    { "grid": { "gap_tension_m": [0.028, 0.0], "gap_compression_m": 0.0055,
                "speed_m_s": [5, 10], "load_n": 100000 } }
  ]
}
"#;

/// A stage whose study is a text.
fn stage(study: &str) -> Stage {
    let stage = Stage::new();
    stage.write();
    fs::write(stage.path("study.json"), study).unwrap();
    stage
}

/// What is told after the message when a study is planned.
fn place(stage: &Stage) -> String {
    let output = stage.pontoon(&["plan", "study.json"]);
    let told = stderr(&output);
    assert_eq!(
        (output.status.code(), stdout(&output).as_str()),
        (Some(2), ""),
        "{told}"
    );
    told[one_message(&told).len() + 1..].to_owned()
}

/// Changes a text of the study and expects a place.
fn shows(from: &str, to: &str, expected: &str) {
    let study = STUDY.replacen(from, to, 1);
    assert_ne!(study, STUDY);
    assert_eq!(place(&stage(&study)), expected.trim_start_matches('\n'), "{to}");
}

#[test]
fn the_study_itself_is_accepted() {
    assert_eq!(stage(STUDY).pontoon(&["plan", "study.json"]).status.code(), Some(0));
}

#[test]
fn an_unknown_key_is_marked_with_the_nearest() {
    shows(
        "footprint_length_m",
        "foot_length_m",
        r#"
 --> study.json:4:16
  |
4 |   "vehicle": { "foot_length_m": 3.35, "track_y_m": [-1.4, 1.4], "inertia": "local" },
  |                ^^^^^^^^^^^^^^^ nearest known: footprint_length_m
"#,
    );
    shows(
        "speed_m_s",
        "sped_m_s",
        r#"
 --> study.json:8:17
  |
8 |                 "sped_m_s": [5, 10], "load_n": 100000 } }
  |                 ^^^^^^^^^^ nearest known: speed_m_s
"#,
    );
}

#[test]
fn a_wrong_value_is_marked_with_what_is_allowed() {
    shows(
        "[5, 10]",
        "[5, -10.0]",
        r#"
 --> study.json:8:34
  |
8 |                 "speed_m_s": [5, -10.0], "load_n": 100000 } }
  |                                  ^^^^^ allowed: a finite number above 0
"#,
    );
    shows(
        "\"crossing\"",
        "\"crosing\"",
        r#"
 --> study.json:5:25
  |
5 |   "analysis": { "kind": "crosing", "time_step_s": 0.02, "tail_s": 2.0 },
  |                         ^^^^^^^^^ nearest known: crossing
"#,
    );
    shows(
        "0.02",
        "\"soon\"",
        r#"
 --> study.json:5:52
  |
5 |   "analysis": { "kind": "crossing", "time_step_s": "soon", "tail_s": 2.0 },
  |                                                    ^^^^^^ allowed: a number of seconds or "auto"
"#,
    );
}

#[test]
fn what_lacks_a_key_is_marked() {
    shows(
        "\"kind\": \"crossing\", ",
        "",
        r#"
 --> study.json:5:3
  |
5 |   "analysis": { "time_step_s": 0.02, "tail_s": 2.0 },
  |   ^^^^^^^^^^^^^ kind is missing
"#,
    );
    shows(
        "\"name\": \"smoke\",\n  ",
        "",
        r#"
 --> study.json:1:1
  |
1 | {
  | ^ name is missing
"#,
    );
    shows(
        "\"speed_m_s\": [5, 10], ",
        "",
        r#"
 --> study.json:7:7
  |
7 |     { "grid": { "gap_tension_m": [0.028, 0.0], "gap_compression_m": 0.0055,
  |       ^^^^^^^^^ speed_m_s is missing
"#,
    );
}

#[test]
fn a_text_that_is_no_json_is_marked_where_it_ceases_to_be() {
    shows(
        "2.0 },",
        "2.0 }",
        r#"
 --> study.json:6:3
  |
6 |   "design": [
  |   ^ expected `,` or `}`
"#,
    );
    shows(
        "2.0",
        "NaN",
        r#"
 --> study.json:5:68
  |
5 |   "analysis": { "kind": "crossing", "time_step_s": 0.02, "tail_s": NaN },
  |                                                                    ^^^ allowed: a finite number
"#,
    );
    let cut = &STUDY[..STUDY.find("\"kind\"").unwrap()];
    assert_eq!(
        place(&stage(cut)),
        " --> study.json:5:16\n  |\n5 |   \"analysis\": {\n  |                ^ EOF while parsing an object\n"
    );
}

#[test]
fn a_key_written_twice_is_marked_twice() {
    shows(
        "\"analysis\"",
        "\"name\": \"again\",\n  \"analysis\"",
        r#"
 --> study.json:5:3
  |
2 |   "name": "smoke",
  |   ------ first here
...
5 |   "name": "again",
  |   ^^^^^^ again here
"#,
    );
}

#[test]
fn an_axis_that_makes_the_bridge_wrong_is_marked_in_the_study() {
    shows(
        "\"load_n\"",
        "\"bridge.modules\": [3, 0], \"load_n\"",
        r#"
 --> study.json:8:61
  |
8 |                 "speed_m_s": [5, 10], "bridge.modules": [3, 0], "load_n": 100000 } }
  |                                                             ^ allowed: a whole number from 1 to 500
"#,
    );
    shows(
        "\"load_n\"",
        "\"vehicle.track_y_m\": [[-1.4, 1.4],\n      [-5, 1]], \"load_n\"",
        r#"
 --> study.json:9:8
  |
9 |       [-5, 1]], "load_n": 100000 } }
  |        ^^ allowed: a number from -4.041 to 4.041
"#,
    );
}

#[test]
fn a_wrong_number_of_the_bridge_is_marked_in_the_bridge() {
    let stage = stage(STUDY);
    let bridge = fs::read_to_string(stage.path("bridge.json")).unwrap();
    let changed = bridge.replacen("\"breadth_m\": 8.082", "\"breadth_m\": -8.082", 1);
    assert_ne!(changed, bridge);
    fs::write(stage.path("bridge.json"), changed).unwrap();
    let told = place(&stage);
    let (head, rest) = told.split_once('\n').unwrap();
    assert!(head.starts_with(" --> bridge.json:7:18"), "{told}");
    assert!(
        rest.contains(
            "\n7 |     \"breadth_m\": -8.082,\n  |                  ^^^^^^ allowed: a finite number above 0\n"
        ),
        "{told}"
    );
}

#[test]
fn tabs_line_ends_marks_and_characters_of_many_bytes_do_not_move_the_mark() {
    // a tab is shown as four blanks and counted as one character
    let windows = STUDY
        .replace("  \"", "\t\"")
        .replace('\n', "\r\n")
        .replace("tail_s", "t\u{e4}il_s");
    assert_eq!(
        place(&stage(&windows)),
        " --> study.json:5:57\n  |\n5 |     \"analysis\": { \"kind\": \"crossing\", \"time_step_s\": 0.02, \"t\u{e4}il_s\": 2.0 },\n  |                                                            ^^^^^^^^ nearest known: tail_s\n"
    );
    let wide = r#"{ "name": "日本", "bridge": "bridge.json", "analysys": {} }"#;
    assert_eq!(
        place(&stage(wide)),
        " --> study.json:1:42\n  |\n1 | { \"name\": \"日本\", \"bridge\": \"bridge.json\", \"analysys\": {} }\n  |                                            ^^^^^^^^^^ nearest known: analysis\n"
    );
    // what an editor writes before a text is no part of its first line
    let marked = place(&stage(&format!("\u{feff}{}", wide)));
    assert!(marked.starts_with(" --> study.json:1:42\n"), "{marked}");
}

#[test]
fn a_long_line_is_cut_to_what_is_round_the_mark() {
    let cases = vec![r#"{"speed_m_s": 5, "load_n": 1e5}"#; 3000].join(",");
    let line =
        STUDY
            .replace('\n', " ")
            .replacen("\"design\": [", &format!("\"design\": [{{\"cases\": [{cases}]}},"), 1);
    let line = line.replacen("100000", "\"much\"", 1);
    let told = place(&stage(&line));
    assert!(told.lines().all(|line| line.chars().count() <= 160), "{told}");
    assert!(
        told.contains("\"load_n\": \"much\"") && told.contains("^^^^^^ allowed: a number"),
        "{told}"
    );
    let column = line.find("\"much\"").unwrap() + 1;
    assert!(told.starts_with(&format!(" --> study.json:1:{column}\n")), "{told}");
}

#[test]
fn what_a_terminal_would_obey_is_not_written() {
    let told = place(&stage(&STUDY.replacen("\"inertia\"", "\"\\u001b[31m\u{202e}\"", 1)));
    assert!(told.contains("\"\\u001b[31m"), "{told:?}");
    let output = stage(&STUDY.replacen("\"inertia\"", "\"\\u001b[31m\\nx\"", 1)).pontoon(&["plan", "study.json"]);
    let told = stderr(&output) + &told;
    assert!(!told.contains(['\u{1b}', '\u{202e}', '\r']), "{told:?}");
}

#[test]
fn programs_are_told_the_message_alone_and_the_quiet_all_of_it() {
    let stage = stage(&STUDY.replacen("inertia", "inertai", 1));
    let told = |words: &[&str]| stderr(&stage.pontoon(words));
    let whole = told(&["plan", "study.json"]);
    assert_eq!(
        told(&["plan", "study.json", "--format", "json"]),
        format!("{}\n", one_message(&whole))
    );
    assert_eq!(told(&["run", "study.json", "--quiet"]), whole);
    assert_eq!(whole.lines().count(), 5, "{whole}");
    assert!(whole.is_ascii(), "{whole}");
}

#[test]
fn files_that_are_none_of_a_person_have_no_place() {
    let stage = stage(STUDY);
    let folder = stage.pontoon(&["plan", "nowhere"]);
    assert_eq!(stderr(&folder).lines().count(), 1, "{}", stderr(&folder));
    fs::write(stage.path("study.json"), "").unwrap();
    assert_eq!(place(&stage), "");
    fs::write(stage.path("study.json"), b"\xff\xfe{}").unwrap();
    assert_eq!(place(&stage), "");
}
