//! A comparison as text, JSON, Markdown, JUnit XML.
//!
//! Knows how lines are written down. Does not know how they came about.

use crate::args::Format;
use crate::words;
use anyhow::Result;
use pontoon_study::compare::{Comparison, Line, Verdict};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use serde_json::{Value, json};

const COLUMNS: [&str; 7] = ["check", "expected", "got", "deviation", "margin", "verdict", "remark"];

fn cells(line: &Line) -> [String; 7] {
    [
        line.id.clone(),
        line.expected.clone(),
        line.got(),
        line.deviation(),
        line.margin(),
        line.verdict.word().to_owned(),
        line.remark(),
    ]
}

/// A comparison in a format.
pub fn written(compared: &Comparison, format: Format) -> Result<String> {
    Ok(match format {
        Format::Text => text(compared),
        Format::Json => format!("{:#}\n", object(compared)),
        Format::Markdown => markdown(compared),
        Format::Junit => junit(compared)?,
    })
}

/// An aligned line a check, and the counts.
pub fn text(compared: &Comparison) -> String {
    let rows: Vec<Vec<Value>> = compared
        .lines
        .iter()
        .map(|line| cells(line).map(Value::from).to_vec())
        .collect();
    let table = words::table(&COLUMNS.map(str::to_owned), &rows);
    let Comparison { results, with, .. } = compared;
    format!("{table}\n{results} against {with}: {}\n", compared.tally())
}

/// A comparison as a JSON object, with its lines and whether nothing falls short.
pub fn object(compared: &Comparison) -> Value {
    let mut object = json!(compared);
    object["good"] = compared.good().into();
    object
}

/// A table whose text cannot leave its cell.
fn markdown(compared: &Comparison) -> String {
    let escaped = |text: &str| {
        words::printable(text)
            .replace('\\', "\\\\")
            .replace('|', "\\|")
            .replace('<', "&lt;")
    };
    let row = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut out = format!(
        "### {} against {}\n\n",
        escaped(&compared.results),
        escaped(&compared.with)
    );
    out += &row(&COLUMNS.map(str::to_owned));
    out += "|---|---|---|---|---|---|---|\n";
    for line in &compared.lines {
        out += &row(&cells(line).map(|cell| escaped(&cell)));
    }
    out + &format!("\n{}\n", compared.tally())
}

/// A test case a check; an expected failure and a record are skipped with what they found.
fn junit(compared: &Comparison) -> Result<String> {
    let mut suite = TestSuite::new(compared.results.as_str());
    for line in &compared.lines {
        let told = format!(
            "expected {}, got {}, deviation {}; {}",
            line.expected,
            line.got(),
            line.deviation(),
            line.remark()
        );
        let status = match line.verdict {
            Verdict::Holds | Verdict::NowHolds => TestCaseStatus::success(),
            Verdict::FallsShort => {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message(told.as_str());
                status
            }
            Verdict::ExpectedFail | Verdict::Record => {
                let mut status = TestCaseStatus::skipped();
                status.set_message(format!("{}: {told}", line.verdict.word()));
                status
            }
        };
        let mut case = TestCase::new(line.id.as_str(), status);
        case.set_classname(compared.with.as_str());
        case.set_system_out(told.as_str());
        suite.add_test_case(case);
    }
    let mut report = Report::new("pontoon compare");
    report.add_test_suite(suite);
    Ok(report.to_string()?)
}

/// Says what has changed since the results, and which checks hold that were expected to fail.
pub fn tell_changes(compared: &Comparison) {
    for note in &compared.notes {
        words::note(&format!("changed: {note}"));
    }
    for line in compared.lines.iter().filter(|line| line.verdict == Verdict::NowHolds) {
        words::note(&format!(
            "changed: '{}' was expected to fail and holds now ({})",
            line.id,
            line.got()
        ));
    }
}
