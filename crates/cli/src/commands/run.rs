//! `pontoon run`: a study to its tables.

use crate::args::{Common, Format, RateArguments, RunArguments};
use crate::exit_status::ExitStatus;
use crate::progress::ProgressDisplay;
use crate::signals::Signals;
use crate::terminal::TextStyle;
use crate::watching::{StartedAgain, Watching};
use crate::{comparison, summary, text};
use anyhow::Result;
use pontoon_judge::compare::{Comparison, against_reference};
use pontoon_judge::reference::Reference;
use pontoon_plan::input::{Cell, Refusal};
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::Study;
use pontoon_results::{DoubtfulRatings, Exceedance, Failures, Outcome, Results, SummaryTable, labels};
use pontoon_study::run::Cache;
use pontoon_study::sweep::{ApartTask, SweepSetting, Swept, run_apart, sweep};
use pontoon_view::asked;
use serde::ser::{Serialize, Serializer};
use serde_json::Value;
use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Checks every job, runs what is missing, writes the tables, prints the summary and, where asked, holds the results against
/// a reference.
pub(crate) fn run(arguments: &RunArguments, common: Common, again: &[OsString]) -> Result<ExitStatus> {
    let signals = Signals::listen()?;
    let study = Study::open(&arguments.study)?;
    let reference = arguments.with.as_deref().map(Reference::open).transpose()?;
    if let Some(reference) = &reference {
        // before anything runs
        reference.study_of(&study.name, &study.file)?;
    }
    let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>()?;
    let setting = setting(arguments, &study);
    if let Some((of, numbers)) = &arguments.apart {
        end_with_standard_input();
        let task = match arguments.prepare_only {
            true => ApartTask::Prepare,
            false => ApartTask::Solve,
        };
        run_apart(&study, &jobs, (task, of, numbers), &setting, &signals.stop)?;
        return Ok(ExitStatus::Good);
    }
    let again = StartedAgain {
        program: again,
        study: arguments.study.clone(),
        out: setting.out.clone(),
    };
    let watching = Watching::new(ProgressDisplay::fitting(common.quiet), &signals, Some(again));
    let swept = sweep(&study, &jobs, &setting, &signals.stop, &watching);
    watching.finish();
    answer(&study, &swept?, &setting.out, reference.as_ref(), common)
}

/// Runs what is missing of a study for its table of classes; where its results are, and whether no job failed.
pub(super) fn sweep_of(
    study: &Study,
    jobs: &[Job],
    arguments: &RateArguments,
    common: Common,
) -> Result<(PathBuf, bool)> {
    let signals = Signals::listen()?;
    let setting = SweepSetting {
        fresh: arguments.fresh,
        ..setting_into(
            arguments.out.clone().unwrap_or_else(|| whole_results(study)),
            arguments.threads,
        )
    };
    let watching = Watching::new(ProgressDisplay::fitting(common.quiet), &signals, None);
    let swept = sweep(study, jobs, &setting, &signals.stop, &watching);
    watching.finish();
    let swept = swept?;
    failures(&swept.outcome.failures);
    Ok((setting.out.clone(), swept.outcome.failures.count == 0))
}

fn setting(arguments: &RunArguments, study: &Study) -> SweepSetting {
    let default_out = || {
        let whole = whole_results(study);
        match arguments.shard {
            Some(shard) => whole.join("shards").join(format!("{}-of-{}", shard.number, shard.of)),
            None => whole,
        }
    };
    SweepSetting {
        shard: arguments.shard,
        fresh: arguments.fresh,
        retry_failed: arguments.retry_failed,
        any_instructions: arguments.any_instructions,
        most_failures: arguments.max_failures,
        ..setting_into(arguments.out.clone().unwrap_or_else(default_out), arguments.threads)
    }
}

/// The folder of a study's whole results where none is named.
fn whole_results(study: &Study) -> PathBuf {
    PathBuf::from("results").join(&study.name)
}

/// The settings that every command has: this program's commit, the user's cache.
fn setting_into(out: PathBuf, threads: Option<u16>) -> SweepSetting {
    SweepSetting {
        out,
        threads: threads.map_or(0, usize::from),
        cache: Cache::of_user(),
        commit: crate::commit::COMMIT.map(str::to_owned),
        ..SweepSetting::default()
    }
}

/// Ends this process when its standard input does: whoever waits for it is gone then.
fn end_with_standard_input() {
    std::thread::spawn(|| {
        let mut rest = Vec::new();
        let _ = io::stdin().read_to_end(&mut rest);
        std::process::exit(3);
    });
}

/// Tells what a sweep left.
pub(super) fn answer(
    study: &Study,
    swept: &Swept<'_>,
    out: &Path,
    reference: Option<&Reference>,
    common: Common,
) -> Result<ExitStatus> {
    let outcome = &swept.outcome;
    failures(&outcome.failures);
    if outcome.preparation.operators.replaced > 0 {
        text::note("an operator in the cache was damaged or of another version: built again and replaced");
    }
    let beyond = outcome.verification.beyond;
    if beyond > 0 {
        let of = outcome.verification.jobs;
        text::note(&format!(
            "{beyond} of {of} jobs solved again are beyond a tolerance of analysis.verify: see the column verify_held of jobs.parquet"
        ));
    }
    let compared = match reference {
        Some(reference) => Some(against_reference(&Results::read(out)?, reference)?),
        None => None,
    };
    match (common.format, &compared) {
        (Format::Json, _) => text::results(|to| write_object(to, study, swept, out, compared.as_ref())),
        (Format::Markdown | Format::Junit, Some(compared)) => {
            text::result(&comparison::written(compared, common.format)?)
        }
        (_, Some(compared)) => text::result(&format!(
            "{}\n{}",
            text(study, swept, out),
            comparison::text(compared, TextStyle::of_results())
        )),
        (_, None) => text::result(&text(study, swept, out)),
    }?;
    if let Some(compared) = &compared {
        comparison::tell_changes(compared);
    }
    let good = compared.as_ref().is_none_or(Comparison::good);
    Ok(if outcome.failures.count == 0 && beyond == 0 && good {
        ExitStatus::Good
    } else {
        ExitStatus::Short
    })
}

fn failures(failures: &Failures) {
    for (job, reason) in &failures.first {
        text::note(&format!("job {job} failed: {reason}"));
    }
    if failures.count > failures.first.len() {
        text::note(&format!("{} jobs failed; by cause:", failures.count));
        for cause in &failures.causes {
            text::note(&format!(
                "  {} of {}, as job {}: {}",
                cause.count,
                cause.kind.word(),
                cause.job,
                cause.reason
            ));
        }
        text::note("see the columns failure and reason of jobs.parquet");
    }
}

fn text(study: &Study, swept: &Swept<'_>, out: &Path) -> String {
    let outcome = &swept.outcome;
    let text_style = TextStyle::of_results();
    let recorded = match outcome.jobs - outcome.ran {
        0 => String::new(),
        known => format!(" ({known} recorded before)"),
    };
    let counts = text::wrapped(
        &format!(
            "jobs {}{recorded}, failed {}; condensations {}, offline part {}, jobs {} on {}",
            outcome.jobs,
            outcome.failures.count,
            outcome.preparation.condensations,
            text::duration(outcome.offline_s),
            text::duration(outcome.jobs_s),
            labels::counted(outcome.threads, "thread"),
        ),
        text_style.width.unwrap_or(usize::MAX),
        2,
    );
    let Some(summary_table) = &swept.summary else {
        let of = swept.jobs;
        return format!(
            "{counts}a share of {} in {}: `pontoon merge` puts shares together\n",
            labels::counted(of, "job"),
            out.display()
        );
    };
    let table = summary::text(summary_table.columns(), || summary_table.rows(), text_style);
    let exceeded = exceeded(summary_table.exceedances()) + &doubted(summary_table.doubtful());
    let said = |what: &str, words: Option<String>| words.map_or(String::new(), |words| format!("{what}: {words}\n"));
    let asked = said("limits", asked::limits(study)) + &said("rated value", asked::search(study));
    format!("{asked}{table}\n{exceeded}{counts}results in {}\n", out.display())
}

/// How many ratings need a second look; nothing where none does.
fn doubted(doubtful: DoubtfulRatings) -> String {
    let line = |count: usize, what: &str| match count {
        0 => String::new(),
        _ => format!("{}: see jobs.parquet, {what}\n", labels::counted(count, "rating")),
    };
    let lines = line(
        doubtful.not_monotone,
        "column monotone: a value beyond the first failure passes, so that the response is not monotone",
    ) + &line(
        doubtful.chaotic,
        "column chaotic: a ten-thousandth of the load moves the utilisation by more than 2 %",
    );
    if lines.is_empty() { lines } else { lines + "\n" }
}

/// Which share of jobs exceeds each limit, a line each.
fn exceeded(exceedance: &[Exceedance]) -> String {
    let line = |of: &Exceedance| {
        let [low, high] = of.interval.map(|share| 100.0 * share);
        let failed = if of.failed == 0 {
            String::new()
        } else {
            format!("; {} failed", of.failed)
        };
        format!(
            "{} exceeded by {} of {} jobs, {:.2} % (95 % interval {low:.2} to {high:.2} %){failed}\n",
            of.limit,
            of.exceeded,
            of.jobs,
            100.0 * of.share
        )
    };
    let lines: String = exceedance.iter().map(line).collect();
    if lines.is_empty() { lines } else { format!("{lines}\n") }
}

/// What a run says in JSON; the rows of its summary are made as they are written.
#[derive(serde::Serialize)]
struct Object<'a> {
    study: &'a str,
    results: String,
    jobs: usize,
    ran: usize,
    failed: usize,
    condensations: usize,
    threads: usize,
    offline_s: f64,
    jobs_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<NamedRows<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    exceedance: &'a [Exceedance],
    #[serde(skip_serializing_if = "Option::is_none")]
    comparison: Option<Value>,
}

struct NamedRows<'a>(&'a SummaryTable<'a>);

impl Serialize for NamedRows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let columns = self.0.columns();
        serializer.collect_seq(self.0.rows().map(|cells| NamedCells { columns, cells }))
    }
}

struct NamedCells<'a> {
    columns: &'a [String],
    cells: Vec<Cell<'a>>,
}

impl Serialize for NamedCells<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.columns.iter().zip(&self.cells))
    }
}

fn write_object(
    mut to: &mut dyn Write,
    study: &Study,
    swept: &Swept<'_>,
    out: &Path,
    compared: Option<&Comparison>,
) -> io::Result<()> {
    let outcome: &Outcome = &swept.outcome;
    let object = Object {
        study: &study.name,
        results: out.display().to_string(),
        jobs: outcome.jobs,
        ran: outcome.ran,
        failed: outcome.failures.count,
        condensations: outcome.preparation.condensations,
        threads: outcome.threads,
        offline_s: outcome.offline_s,
        jobs_s: outcome.jobs_s,
        summary: swept.summary.as_ref().map(NamedRows),
        exceedance: swept.summary.as_ref().map_or(&[], SummaryTable::exceedances),
        comparison: compared.map(comparison::object),
    };
    serde_json::to_writer_pretty(&mut to, &object)?;
    writeln!(to)
}
