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
use pontoon_study::run::{Cache, Failures, JobRecord, Outcome, RunError, Setting, run as run_jobs};
use pontoon_study::tables::{Folder, Manifest, Moment, Results, SummaryTable, Writer, check_own};
use pontoon_study::{Refusal, Study};
use serde::ser::{Serialize, Serializer};
use serde_json::{Map, Value};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Rows of the summary that are written on standard output for people; all are in summary.csv.
const ROWS_SHOWN: usize = 200;

/// What could not be done where a table fails.
const NOT_WRITTEN: &str = "results not written";

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
    let mut tables = Writer::begin(&study, &jobs, &folder).context(NOT_WRITTEN)?;
    let setting = Setting {
        threads: arguments.threads.map_or(0, usize::from),
        cache: Cache::of_user(),
        ..Setting::default()
    };
    let mut sink = |records: Vec<JobRecord>| tables.append(&records);
    let ran = run_jobs(&study, &jobs, setting, &shown, &mut sink);
    shown.finish();
    let outcome = ran.map_err(|error| match error {
        RunError::Sink(error) => anyhow::Error::new(error).context(NOT_WRITTEN),
        RunError::Pool(error) => error.into(),
    })?;
    let manifest = Manifest::new(&study, &jobs, &outcome, started, Moment::now());
    let summary = tables.finish(manifest).context(NOT_WRITTEN)?;
    failures(&outcome.failures);
    if outcome.operators.replaced > 0 {
        words::note("an operator in the cache was damaged or of another version: built again and replaced");
    }
    let beyond = outcome.verification.beyond;
    if beyond > 0 {
        let of = outcome.verification.jobs;
        words::note(&format!(
            "{beyond} of {of} jobs solved again are beyond a tolerance of analysis.verify: see the column verify_held of jobs.parquet"
        ));
    }
    let compared = match &reference {
        Some(reference) => Some(against_reference(&Results::read(&out)?, reference)?),
        None => None,
    };
    match (common.format, &compared) {
        (Format::Json, _) => words::results(|to| write_object(to, &study, &summary, &outcome, &out, compared.as_ref())),
        (Format::Markdown | Format::Junit, Some(compared)) => {
            words::result(&comparison::written(compared, common.format)?)
        }
        (_, Some(compared)) => words::result(&format!(
            "{}\n{}",
            text(&summary, &outcome, &out),
            comparison::text(compared)
        )),
        (_, None) => words::result(&text(&summary, &outcome, &out)),
    }?;
    if let Some(compared) = &compared {
        comparison::tell_changes(compared);
    }
    let good = compared.as_ref().is_none_or(Comparison::good);
    Ok(if outcome.failures.count == 0 && beyond == 0 && good {
        Ending::Good
    } else {
        Ending::Short
    })
}

fn failures(failures: &Failures) {
    for (job, reason) in &failures.first {
        words::note(&format!("job {job} failed: {reason}"));
    }
    match failures.count - failures.first.len() {
        0 => {}
        more => words::note(&format!("and {more} more: see the column reason of jobs.parquet")),
    }
}

fn text(summary: &SummaryTable<'_>, outcome: &Outcome, out: &Path) -> String {
    let counts = format!(
        "jobs {}, failed {}; condensations {}, offline part {}, jobs {} on {} threads\nresults in {}\n",
        outcome.jobs,
        outcome.failures.count,
        outcome.condensations,
        words::duration(outcome.offline_s),
        words::duration(outcome.jobs_s),
        outcome.threads,
        out.display()
    );
    let shown: Vec<Vec<Value>> = summary.rows().take(ROWS_SHOWN).collect();
    let more = match summary.len() - shown.len() {
        0 => String::new(),
        more => format!("and {more} more rows: see summary.csv\n"),
    };
    format!("{}{more}\n{counts}", words::table(summary.columns(), &shown))
}

/// What a run says in JSON; the rows of its summary are made as they are written.
#[derive(serde::Serialize)]
struct Object<'a> {
    study: &'a str,
    results: String,
    jobs: usize,
    failed: usize,
    condensations: usize,
    threads: usize,
    offline_s: f64,
    jobs_s: f64,
    summary: Rows<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    comparison: Option<Value>,
}

struct Rows<'a>(&'a SummaryTable<'a>);

impl Serialize for Rows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let columns = self.0.columns();
        let row = |cells: Vec<Value>| columns.iter().cloned().zip(cells).collect::<Map<_, _>>();
        serializer.collect_seq(self.0.rows().map(row))
    }
}

fn write_object(
    mut to: &mut dyn Write,
    study: &Study,
    summary: &SummaryTable<'_>,
    outcome: &Outcome,
    out: &Path,
    compared: Option<&Comparison>,
) -> io::Result<()> {
    let object = Object {
        study: &study.spec.name,
        results: out.display().to_string(),
        jobs: outcome.jobs,
        failed: outcome.failures.count,
        condensations: outcome.condensations,
        threads: outcome.threads,
        offline_s: outcome.offline_s,
        jobs_s: outcome.jobs_s,
        summary: Rows(summary),
        comparison: compared.map(comparison::object),
    };
    serde_json::to_writer_pretty(&mut to, &object)?;
    writeln!(to)
}
