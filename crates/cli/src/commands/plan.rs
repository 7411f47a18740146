//! `pontoon plan`: what would run.

use crate::args::{Common, Format, PlanArguments};
use crate::exit_status::ExitStatus;
use crate::terminal::{BAD, TextStyle};
use crate::{axes, text};
use anyhow::Result;
use pontoon_plan::study_file::Study;
use pontoon_results::labels;
use pontoon_study::run::Cache;
use pontoon_study::sweep::{Forecast, forecast};
use serde_json::json;
use std::path::PathBuf;
use unicode_width::UnicodeWidthStr;

/// Checks every job and says what would run, how long it takes, and what of it is done.
pub(crate) fn plan(arguments: &PlanArguments, common: Common) -> Result<ExitStatus> {
    let study = Study::open(&arguments.study)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let default_out = || PathBuf::from("results").join(&study.name);
    let out = arguments.out.clone().unwrap_or_else(default_out);
    let forecast = forecast(&study, &out, threads, Cache::of_user().as_ref())?;
    if !common.quiet {
        forecast.plan.notes.iter().for_each(|note| text::note(note));
    }
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(forecast)),
        _ => text(&study, &forecast, &out.display().to_string(), TextStyle::of_results()),
    })?;
    Ok(ExitStatus::Good)
}

/// The longest of the names that are told of every study.
const LONGEST: &str = "distinct bridges";

/// What would run, what is there of it, what the rest takes.
fn text(study: &Study, forecast: &Forecast, out: &str, text_style: TextStyle) -> String {
    let plan = &forecast.plan;
    let width = text_style.width.unwrap_or(usize::MAX);
    let axes: Vec<(String, String)> = axes::of(study)
        .into_iter()
        .map(|(name, told)| (format!("  {name}"), told))
        .collect();
    let names = axes.iter().map(|(name, _)| name.width()).chain([LONGEST.len()]);
    let names = names.max().unwrap_or(0) + 2;
    let line = |name: &str, told: &str| {
        // beside each other where there is room
        let indent = if 2 * names > width { 4 } else { names };
        text::wrapped(
            &text::printable(&(text::padded(name, names, false) + told)),
            width,
            indent,
        )
    };
    let merged = match plan.points - plan.jobs {
        0 => String::new(),
        merged => format!(
            " ({} equal {} merged)",
            text::grouped(merged as u64),
            labels::plural("point", merged)
        ),
    };
    let time = match forecast.expected_seconds {
        Some(seconds) => format!(
            "about {} on {}, {} tried",
            text::duration(seconds),
            labels::counted(forecast.threads, "thread"),
            labels::counted(forecast.tried, "job")
        ),
        None => "not known: the jobs that were tried failed, or are too long to try".to_owned(),
    };
    let mut text = line("study", &plan.study);
    text += &line("jobs", &(text::grouped(plan.jobs as u64) + &merged));
    for (name, told) in &axes {
        text += &line(name, told);
    }
    text.push('\n');
    text += &line(LONGEST, &text::grouped(plan.distinct_bridges as u64));
    text += &line("condensations", &text::grouped(plan.condensations as u64));
    text += &line("steps", &text::grouped(plan.steps));
    text.push('\n');
    if let Some(found) = &forecast.found {
        let failed = format!("{} failed", found.failed);
        let told = format!("{} ({failed}), missing {}, in {out}", found.done, found.missing);
        let told = line("done", &told);
        text += &match found.failed {
            0 => told,
            _ => told.replacen(&failed, &text_style.painted(BAD, &failed), 1),
        };
        for why in &found.refused {
            text += &text_style.painted(BAD, &line("no use", why));
        }
    }
    text + &line("expected time", &time)
}
