//! What people see: the end of a run, a plan, a comparison; on a terminal, on a narrow one, in a pipe.

use crate::stage::{Stage, stderr, stdout};
use serde_json::json;
use std::path::Path;
use std::process::{Command, Stdio};

/// What the program writes on a terminal of so many columns, without what moves the cursor; none where there is no `script`
/// (util-linux) to make a terminal.
fn on_terminal(stage: &Stage, columns: usize, environment: &str, words: &str) -> Option<String> {
    let program = env!("CARGO_BIN_EXE_pontoon");
    let command = format!(
        "cd '{}' && stty rows 50 cols {columns} && {environment} PONTOON_CACHE_DIR= TERM=xterm '{program}' {words}",
        stage.path("").display()
    );
    let output = Command::new("script")
        .args(["-qec", &command, "/dev/null"])
        .env_remove("NO_COLOR")
        .stdin(Stdio::null())
        .output()
        .ok()?;
    let text = stdout(&output).replace('\r', "");
    assert!(!text.contains("stty:"), "{text}");
    Some(text)
}

/// A run of the smoke study with what it says.
fn ran() -> (Stage, String) {
    let stage = Stage::new();
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = stderr(&output);
    let last = told.lines().last().unwrap();
    assert!(
        last.starts_with("6/6 jobs, 0 failed, ") && last.ends_with("0.0 s left"),
        "{told}"
    );
    assert!(last.contains(" jobs/s, "), "{told}");
    (stage, stdout(&output))
}

#[test]
fn a_run_ends_with_peaks_against_speed_and_where_the_largest_are() {
    let (stage, text) = ran();
    let begins = "\
peak deflection [m] against speed [m/s]
throughout: compression gap 0.0055 m, load 100000 N

            tension
                gap
connection      [m]       5      10
linear        -      0.0266  0.0337
nonlinear     0.028  0.0840  0.0978*
nonlinear     0      0.0762  0.0944

largest deflection   0.0978 m  speed 10 m/s, connection nonlinear, tension gap 0.028 m
";
    assert!(text.starts_with(begins), "{text}");
    assert!(
        text.contains("\njobs 6, failed 0; ") && text.ends_with("results in r\n"),
        "{text}"
    );
    assert!(!text.contains('\u{1b}'), "{text:?}");
    // what was there before is told of as such
    let output = stage.pontoon(&["run", "study.json", "--out", "r"]);
    assert!(
        stdout(&output).contains("\njobs 6 (6 recorded before), failed 0; "),
        "{}",
        stdout(&output)
    );
}

#[test]
fn a_run_that_goes_on_counts_what_was_there() {
    let (mut stage, _) = ran();
    stage.study["design"][0]["grid"]["speed_m_s"] = json!([5, 10, 12]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r"]);
    let told = stderr(&output);
    assert!(told.contains("\n6/9 jobs (6 before), 0 failed\n"), "{told}");
    assert!(told.contains("\n9/9 jobs (6 before), 0 failed, "), "{told}");
    assert!(stderr(&stage.pontoon(&["run", "study.json", "--out", "r", "--quiet"])).is_empty());
}

#[test]
fn failed_jobs_are_in_the_table_and_in_the_lines() {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "analysis.newton_limit": [1, 30], "analysis.bisection_limit": 0, "load_n": 2e5, "speed_m_s": [15, 16]
    } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r"]);
    let (text, told) = (stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("4/4 jobs, 2 failed, "), "{told}");
    let row = text.lines().find(|line| line.trim_start().starts_with("1 ")).unwrap();
    assert_eq!(row.matches("failed").count(), 2, "{text}");
}

#[test]
fn static_cases_and_modes_have_their_own_tables() {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["record"] = json!({});
    stage.study["design"] =
        json!([{ "grid": { "connection": ["linear", "nonlinear"], "load_position": [1, 2, 3], "load_n": 1e5 } }]);
    let text = stdout(&stage.write().pontoon(&["run", "study.json", "--out", "r"]));
    assert!(
        text.starts_with("peak deflection [m] against load position\n"),
        "{text}"
    );
    assert!(text.contains("\nconnection       1       2       3\nlinear "), "{text}");
    stage.study["analysis"] = json!({ "kind": "modes", "count": 7 });
    stage.study["design"] = json!([{ "grid": { "analysis.model": ["full", "super-element"] } }]);
    stage.study.as_object_mut().unwrap().remove("vehicle");
    let output = stage.write().pontoon(&["run", "study.json", "--out", "m"]);
    let text = stdout(&output);
    assert!(
        text.starts_with("natural frequencies [Hz]\n\nmodel "),
        "{text}{}",
        stderr(&output)
    );
    assert!(
        text.contains("\nheave ") && text.lines().filter(|line| line.starts_with("pitch ")).count() == 1,
        "{text}"
    );
}

#[test]
fn a_plan_tells_the_axes_and_what_is_done_of_them() {
    let (stage, _) = ran();
    let text = stdout(&stage.pontoon(&["plan", "study.json", "--out", "r"]));
    let begins = "\
study                smoke
jobs                 6 (2 equal points merged)
  connection         linear, nonlinear
  gap_tension_m      0, 0.028
  gap_compression_m  0.0055
  speed_m_s          5, 10
  load_n             100000

distinct bridges     1
condensations        1
steps                1,641

done                 6 (0 failed), missing 0, in r
expected time        ";
    assert!(text.starts_with(begins), "{text}");
}

#[test]
fn long_axes_are_told_by_their_ends() {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "speed_m_s": { "linspace": [5, 10, 11] }, "load_n": [3e5, 1e5], "vehicle.track_y_m": [[-1, 1], [0, 2]]
    } }]);
    let text = stdout(&stage.write().pontoon(&["plan", "study.json"]));
    for line in [
        "\n  speed_m_s          5 to 10, 11 values\n",
        "\n  load_n             100000, 300000\n",
        "\n  vehicle.track_y_m  [-1,1], [0,2]\n",
    ] {
        assert!(text.contains(line), "{text}");
    }
}

/// Three checks of the smoke results: one holds, one falls short, one is a record.
fn checked() -> Stage {
    let (stage, _) = ran();
    let column = json!({ "select": { "table": "jobs", "column": "peak_deflection_m", "reduce": "max" } });
    let bound = |id: &str, at_most: f64| json!({ "id": id, "bound": { "of": column, "at_most": at_most } });
    let mut record = bound("recorded", 1.0);
    record["role"] = "record".into();
    stage.json(
        "reference.json",
        &crate::stage::reference(&json!([bound("short", 0.01), bound("good", 1.0), record])),
    );
    stage
}

const COMPARE: &str = "compare r --with reference.json";

#[test]
fn a_comparison_begins_with_verdicts_and_ends_with_what_falls_short_and_the_counts() {
    let stage = checked();
    let text = stdout(&stage.pontoon(&COMPARE.split(' ').collect::<Vec<_>>()));
    let first: Vec<&str> = text.lines().map(|line| line.split("  ").next().unwrap()).collect();
    assert_eq!(first[..4], ["verdict", "record", "holds", "FALLS SHORT"], "{text}");
    let counts = "smoke against expected: 1 hold, 1 fall short, 0 fail as expected, 0 changed, 1 recorded";
    assert_eq!(first[4..], ["", counts], "{text}");
    assert!(!text.contains('\u{1b}'), "{text:?}");
}

#[test]
fn a_terminal_has_colours_unless_they_are_not_wanted() {
    let stage = checked();
    let Some(text) = on_terminal(&stage, 120, "", COMPARE) else {
        return;
    };
    let (good, bad) = ("\u{1b}[32mholds\u{1b}[0m", "\u{1b}[1m\u{1b}[31mFALLS SHORT\u{1b}[0m");
    assert!(text.contains(good) && text.contains(bad), "{text:?}");
    for environment in ["NO_COLOR=1", "TERM=dumb; TERM=dumb"] {
        let text = on_terminal(&stage, 120, environment, COMPARE).unwrap();
        assert_eq!(text.contains('\u{1b}'), environment.starts_with("TERM"), "{text:?}");
    }
    let error = on_terminal(&stage, 80, "", "plan reference.json").unwrap();
    assert!(
        error.starts_with("\u{1b}[1m\u{1b}[31mpontoon:\u{1b}[0m reference.json: "),
        "{error:?}"
    );
    let error = on_terminal(&stage, 80, "NO_COLOR=1", "plan reference.json").unwrap();
    assert!(
        error.starts_with("pontoon: reference.json: ") && !error.contains('\u{1b}'),
        "{error:?}"
    );
}

#[test]
fn nothing_is_wider_than_a_narrow_terminal() {
    let stage = checked();
    for columns in [40, 60, 80] {
        for words in [
            COMPARE,
            "run study.json --out r -q",
            "plan study.json --out r",
            "modes bridge.json --count 7",
        ] {
            let Some(text) = on_terminal(&stage, columns, "NO_COLOR=1", words) else {
                return;
            };
            let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(
                (10..=columns).contains(&longest),
                "{words}, {columns}: {longest}\n{text}"
            );
        }
    }
    let text = on_terminal(&stage, 40, "NO_COLOR=1", COMPARE).unwrap();
    assert!(
        text.contains("\nFALLS SHORT  short\n  expected <= 0.01, got 0.0978"),
        "{text}"
    );
}

#[test]
fn progress_on_a_terminal_is_a_bar_that_goes_away() {
    let stage = Stage::new();
    stage.write();
    let Some(text) = on_terminal(&stage, 100, "NO_COLOR=1", "run study.json --out r") else {
        return;
    };
    assert!(
        text.contains("6/6 jobs, 0 failed, ") || text.contains("0/6 jobs, 0 failed"),
        "{text:?}"
    );
    assert!(!text.contains("\nrunning jobs\n"), "{text:?}");
    let text = on_terminal(&stage, 100, "NO_COLOR=1", "run study.json --out q --quiet").unwrap();
    assert!(text.starts_with("peak deflection [m] against speed"), "{text:?}");
    assert!(Path::new(&stage.path("q/summary.csv")).is_file());
}
