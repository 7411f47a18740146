//! `pontoon run`: a study to its tables.

use crate::Ending;
use crate::args::{Common, Format, RunArguments};
use crate::comparison;
use crate::progress::Shown;
use crate::words;
use anyhow::{Context, Result};
use pontoon_study::compare::{Comparison, against_reference};
use pontoon_study::plan::{Job, Jobs};
use pontoon_study::reference::Reference;
use pontoon_study::run::{Outcome, run as run_jobs};
use pontoon_study::tables::{Folder, Manifest, Moment, Results, SummaryTable, check_own, write};
use pontoon_study::{Refusal, Study};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// Rows of the summary that are written on standard output for people; all are in summary.csv.
const ROWS_SHOWN: usize = 200;

/// Failed jobs that are written out on standard error; all are in the table.
const FAILURES_SHOWN: usize = 10;

/// Checks every job, runs them, writes the tables, prints the summary and, where asked, holds the results against a
/// reference.
pub fn run(arguments: &RunArguments, common: Common) -> Result<Ending> {
    let study = Study::open(&arguments.study)?;
    let reference = arguments.with.as_deref().map(Reference::open).transpose()?;
    if let Some(reference) = &reference {
        // before anything runs
        reference.study_of(&study.spec.name, &study.file)?;
    }
    let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>()?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("results").join(&study.spec.name));
    check_own(&out, &study.spec.name)?;
    let folder = Folder::create(&out).context("no folder for the results")?;
    let started = Moment::now();
    let shown = Shown::fitting(common.quiet);
    let outcome = run_jobs(&study, &jobs, arguments.threads.map_or(0, usize::from), &shown)?;
    shown.finish();
    let manifest = Manifest::new(&study, &jobs, &outcome, started, Moment::now());
    let summary = write(&study, &jobs, &outcome, manifest, &folder).context("results not written")?;
    failures(&outcome);
    let compared = match &reference {
        Some(reference) => Some(against_reference(&Results::read(&out)?, reference)?),
        None => None,
    };
    words::result(&match (common.format, &compared) {
        (Format::Json, _) => object(&study, &summary, &outcome, &out, compared.as_ref()),
        (Format::Markdown | Format::Junit, Some(compared)) => comparison::written(compared, common.format)?,
        (_, Some(compared)) => format!("{}\n{}", text(&summary, &outcome, &out), comparison::text(compared)),
        (_, None) => text(&summary, &outcome, &out),
    })?;
    if let Some(compared) = &compared {
        comparison::tell_changes(compared);
    }
    let good = compared.as_ref().is_none_or(Comparison::good);
    Ok(if outcome.failed() == 0 && good {
        Ending::Good
    } else {
        Ending::Short
    })
}

fn failures(outcome: &Outcome) {
    let failed = outcome
        .records
        .iter()
        .filter_map(|r| r.reason.as_ref().map(|reason| (r.job, reason)));
    for (job, reason) in failed.take(FAILURES_SHOWN) {
        words::note(&format!("job {job} failed: {reason}"));
    }
    if let Some(more) = outcome.failed().checked_sub(FAILURES_SHOWN).filter(|more| *more > 0) {
        words::note(&format!("and {more} more: see the column reason of jobs.parquet"));
    }
}

fn text(summary: &SummaryTable, outcome: &Outcome, out: &Path) -> String {
    let counts = format!(
        "jobs {}, failed {}; condensations {}, offline part {}, jobs {} on {} threads\nresults in {}\n",
        outcome.records.len(),
        outcome.failed(),
        outcome.condensations,
        words::duration(outcome.offline_s),
        words::duration(outcome.jobs_s),
        outcome.threads,
        out.display()
    );
    let shown = &summary.rows[..summary.rows.len().min(ROWS_SHOWN)];
    let more = match summary.rows.len() - shown.len() {
        0 => String::new(),
        more => format!("and {more} more rows: see summary.csv\n"),
    };
    format!("{}{more}\n{counts}", words::table(&summary.columns, shown))
}

fn object(
    study: &Study,
    summary: &SummaryTable,
    outcome: &Outcome,
    out: &Path,
    compared: Option<&Comparison>,
) -> String {
    let row = |cells: &Vec<Value>| -> Value {
        summary
            .columns
            .iter()
            .cloned()
            .zip(cells.iter().cloned())
            .collect::<Map<_, _>>()
            .into()
    };
    let mut object = json!({
        "study": study.spec.name,
        "results": out.display().to_string(),
        "jobs": outcome.records.len(),
        "failed": outcome.failed(),
        "condensations": outcome.condensations,
        "threads": outcome.threads,
        "offline_s": outcome.offline_s,
        "jobs_s": outcome.jobs_s,
        "summary": summary.rows.iter().map(row).collect::<Vec<_>>(),
    });
    if let Some(compared) = compared {
        object["comparison"] = comparison::object(compared);
    }
    format!("{object:#}\n")
}
