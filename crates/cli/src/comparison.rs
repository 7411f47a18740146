//! A comparison as text, JSON, Markdown, JUnit XML.
//!
//! Knows how lines are written down. Does not know how they came about.

use crate::args::Format;
use crate::terminal::{BAD, FAINT, GOOD, HEAD, NOTABLE, TextStyle};
use crate::text;
use anstyle::Style;
use anyhow::Result;
use pontoon_judge::compare::{CheckResult, Comparison, Verdict};
use pontoon_plan::input::Cell;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use serde_json::{Value, json};
use unicode_width::UnicodeWidthStr;

const COLUMNS: [&str; 7] = ["check", "expected", "got", "deviation", "margin", "verdict", "remark"];

fn cells(line: &CheckResult) -> [String; 7] {
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
pub(crate) fn written(compared: &Comparison, format: Format) -> Result<String> {
    Ok(match format {
        Format::Text => text(compared, TextStyle::of_results()),
        Format::Json => format!("{:#}\n", object(compared)),
        Format::Markdown => markdown(compared),
        Format::Junit => junit(compared)?,
    })
}

/// Verdicts in the order in which people read them: what asks for something is the last, beside the counts.
const ORDER: [Verdict; 5] = [
    Verdict::Record,
    Verdict::Holds,
    Verdict::ExpectedFail,
    Verdict::NowHolds,
    Verdict::FallsShort,
];

/// An aligned line a check with its verdict first, those of one verdict together, and the counts. Where lines are too long
/// for a terminal, a check has several.
pub(crate) fn text(compared: &Comparison, text_style: TextStyle) -> String {
    let lines: Vec<&CheckResult> = ORDER
        .iter()
        .flat_map(|&verdict| compared.lines.iter().filter(move |line| line.verdict == verdict))
        .collect();
    let rows: Vec<Vec<String>> = lines.iter().map(|line| verdict_first(line)).collect();
    let heads = ["verdict", "check", "expected", "got", "deviation", "margin", "remark"].map(str::to_owned);
    let table = text::table(&heads, &right(&heads, rows, &[4, 5]));
    let fits = text_style
        .width
        .is_none_or(|width| table.lines().all(|line| line.width() <= width));
    let checks = if fits {
        let mut written = table.lines();
        let head = text_style.painted(HEAD, written.next().unwrap_or_default()) + "\n";
        let painted = written.zip(&lines).map(|(text, line)| {
            let (verdict, rest) = text.split_at(line.verdict.word().len().min(text.len()));
            format!("{}{rest}\n", text_style.painted(style(line.verdict), verdict))
        });
        head + &painted.collect::<String>()
    } else {
        let longest = lines.iter().map(|line| line.verdict.word().len()).max().unwrap_or(0);
        lines.iter().map(|line| several(line, longest, text_style)).collect()
    };
    let Comparison { results, with, .. } = compared;
    let held = format!("{results} against {with}: {}", compared.tally());
    let held = text::wrapped(&text::printable(&held), text_style.width.unwrap_or(usize::MAX), 2);
    let short = format!("{} fall short", compared.count(Verdict::FallsShort));
    let held = if compared.good() {
        held
    } else {
        held.replacen(&short, &text_style.painted(BAD, &short), 1)
    };
    format!("{checks}\n{held}")
}

fn verdict_first(line: &CheckResult) -> Vec<String> {
    let [check, expected, got, deviation, margin, verdict, remark] = cells(line);
    vec![verdict, check, expected, got, deviation, margin, remark]
}

/// Rows as cells, some columns to the right.
fn right(heads: &[String], rows: Vec<Vec<String>>, columns: &[usize]) -> Vec<Vec<Cell<'static>>> {
    let width = |i: usize| {
        let longest = rows.iter().map(|row| row[i].width()).max().unwrap_or(0);
        longest.max(heads[i].width())
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let cell = |(i, text): (usize, String)| {
        if columns.contains(&i) {
            Cell::Word(text::padded(&text, widths[i], true).into())
        } else {
            Cell::Word(text.into())
        }
    };
    rows.into_iter()
        .map(|row| row.into_iter().enumerate().map(cell).collect())
        .collect()
}

/// A check over several lines, behind a verdict of at most `longest` characters.
fn several(line: &CheckResult, longest: usize, text_style: TextStyle) -> String {
    let [check, expected, got, deviation, margin, verdict, remark] = cells(line);
    let width = text_style.width.unwrap_or(usize::MAX);
    let told = [
        ("expected", expected),
        ("got", got),
        ("deviation", deviation),
        ("margin", margin),
    ];
    let told = told
        .iter()
        .filter(|(_, value)| value != "-")
        .map(|(name, value)| format!("{name} {value}"));
    let told: Vec<String> = told.chain(Some(remark)).map(|entry| text::printable(&entry)).collect();
    let indent = if 4 * (longest + 2) > width { 2 } else { longest + 2 };
    let verdict_wide = format!("{verdict:<longest$}  ");
    let head = text::listed(&verdict_wide, Some(text::printable(&check)).iter(), width, indent);
    let head = head.replacen(&verdict, &text_style.painted(style(line.verdict), &verdict), 1);
    head + &text::listed(&" ".repeat(indent), told.iter(), width, indent)
}

fn style(verdict: Verdict) -> Style {
    match verdict {
        Verdict::Holds => GOOD,
        Verdict::FallsShort => BAD,
        Verdict::NowHolds => NOTABLE,
        Verdict::ExpectedFail | Verdict::Record => FAINT,
    }
}

/// A comparison as a JSON object, with its lines and whether nothing falls short.
pub(crate) fn object(compared: &Comparison) -> Value {
    let mut object = json!(compared);
    object["good"] = compared.good().into();
    object
}

/// A table whose text cannot leave its cell.
fn markdown(compared: &Comparison) -> String {
    let escaped = |text: &str| {
        text::printable(text)
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
pub(crate) fn tell_changes(compared: &Comparison) {
    for note in &compared.notes {
        text::note(&format!("changed: {note}"));
    }
    for line in compared.lines.iter().filter(|line| line.verdict == Verdict::NowHolds) {
        text::note(&format!(
            "changed: '{}' was expected to fail and holds now ({})",
            line.id,
            line.got()
        ));
    }
}
