//! `pontoon plan`: what would run.

use crate::args::{Common, Format, PlanArguments};
use crate::exit_status::ExitStatus;
use crate::terminal::{BAD, TextStyle};
use crate::{axes, text};
use anyhow::Result;
use pontoon_plan::job::Plan;
use pontoon_plan::study_file::Study;
use pontoon_results::labels;
use pontoon_study::run::Cache;
use pontoon_study::sweep::{Forecast, RecordedJobs, forecast};
use serde_json::json;
use std::path::PathBuf;
use unicode_width::UnicodeWidthStr;

/// Checks every job and says what would run, how long it takes, and what of it is done.
pub(crate) fn plan(arguments: &PlanArguments, common: Common) -> Result<ExitStatus> {
    let study = Study::open(&arguments.study)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let default_out = || PathBuf::from("results").join(&study.name);
    let out = arguments.out.clone().unwrap_or_else(default_out);
    let style = TextStyle::of_results();
    let lines = Lines::of(&study, style);
    let mut written = Ok(());
    let forecast = forecast(&study, &out, threads, Cache::of_user().as_ref(), |plan, found| {
        if !common.quiet {
            plan.notes.iter().for_each(|note| text::note(note));
        }
        if common.format != Format::Json {
            written = text::result(&lines.planned(plan, found, &out.display().to_string()));
        }
    })?;
    written?;
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(forecast)),
        _ => lines.line("expected time", &expected(&forecast)),
    })?;
    Ok(ExitStatus::Good)
}

/// The longest of the names that are told of every study.
const LONGEST: &str = "distinct bridges";

/// What is told of a study, in lines of one width.
struct Lines {
    study: String,
    axes: Vec<(String, String)>,
    style: TextStyle,
    width: usize,
    /// Columns of the names.
    names: usize,
}

impl Lines {
    fn of(study: &Study, style: TextStyle) -> Self {
        let axes: Vec<(String, String)> = axes::of(study)
            .into_iter()
            .map(|(name, told)| (format!("  {name}"), told))
            .collect();
        let names = axes.iter().map(|(name, _)| name.width()).chain([LONGEST.len()]);
        Self {
            study: study.name.clone(),
            names: names.max().unwrap_or(0) + 2,
            width: style.width.unwrap_or(usize::MAX),
            axes,
            style,
        }
    }

    fn line(&self, name: &str, told: &str) -> String {
        // beside each other where there is room
        let indent = if 2 * self.names > self.width { 4 } else { self.names };
        let line = text::padded(name, self.names, false) + told;
        text::wrapped(&text::printable(&line), self.width, indent)
    }

    /// What would run, and what is there of it.
    fn planned(&self, plan: &Plan, found: Option<&RecordedJobs>, out: &str) -> String {
        let merged = match plan.points - plan.jobs {
            0 => String::new(),
            merged => format!(
                " ({} equal {} merged)",
                text::grouped(merged as u64),
                labels::plural("point", merged)
            ),
        };
        let mut text = self.line("study", &self.study);
        text += &self.line("jobs", &(text::grouped(plan.jobs as u64) + &merged));
        for (name, told) in &self.axes {
            text += &self.line(name, told);
        }
        text.push('\n');
        text += &self.line(LONGEST, &text::grouped(plan.distinct_bridges as u64));
        text += &self.line("condensations", &text::grouped(plan.condensations as u64));
        text += &self.line("steps", &text::grouped(plan.steps));
        text.push('\n');
        if let Some(found) = found {
            let failed = format!("{} failed", found.failed);
            let told = format!("{} ({failed}), missing {}, in {out}", found.done, found.missing);
            let told = self.line("done", &told);
            text += &match found.failed {
                0 => told,
                _ => told.replacen(&failed, &self.style.painted(BAD, &failed), 1),
            };
            for why in &found.refused {
                text += &self.style.painted(BAD, &self.line("no use", why));
            }
        }
        text
    }
}

/// How long it takes.
fn expected(forecast: &Forecast) -> String {
    match forecast.expected_seconds {
        Some(seconds) => format!(
            "about {} on {}, {} tried",
            text::duration(seconds),
            labels::counted(forecast.threads, "thread"),
            labels::counted(forecast.tried, "job")
        ),
        None if forecast.time_not_probed => "time not probed: a job was not prepared within 10 s".to_owned(),
        None => "not known: the jobs that were tried failed, or are too long to try".to_owned(),
    }
}
