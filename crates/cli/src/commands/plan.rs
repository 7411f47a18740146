//! `pontoon plan`: what would run.

use crate::Ending;
use crate::args::{Common, Format, PlanArguments};
use crate::words;
use anyhow::Result;
use pontoon_study::Study;
use pontoon_study::run::Cache;
use pontoon_study::sweep::{Forecast, forecast};
use serde_json::json;
use std::path::PathBuf;

/// Checks every job and says what would run, how long it takes, and what of it is done.
pub fn plan(arguments: &PlanArguments, common: Common) -> Result<Ending> {
    let study = Study::open(&arguments.study)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let default_out = || PathBuf::from("results").join(&study.spec.name);
    let out = arguments.out.clone().unwrap_or_else(default_out);
    let forecast = forecast(&study, &out, threads, Cache::of_user().as_ref())?;
    words::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(forecast)),
        _ => text(&forecast, &out.display().to_string()),
    })?;
    Ok(Ending::Good)
}

fn text(forecast: &Forecast, out: &str) -> String {
    let plan = &forecast.plan;
    let merged = plan.points - plan.jobs;
    let merged = if merged > 0 {
        format!(" ({merged} equal points merged)")
    } else {
        String::new()
    };
    let time = match forecast.expected_seconds {
        Some(seconds) => format!(
            "about {} on {} threads, {} jobs tried",
            words::duration(seconds),
            forecast.threads,
            forecast.tried
        ),
        None => "not known: the jobs that were tried failed, or are too long to try".to_owned(),
    };
    let mut text = format!(
        "study             {}\njobs              {}{merged}\ndistinct bridges  {}\ncondensations     {}\nsteps             {}\n",
        plan.study, plan.jobs, plan.distinct_bridges, plan.condensations, plan.steps,
    );
    if let Some(found) = &forecast.found {
        text += &format!(
            "done              {} ({} failed), missing {}, in {out}\n",
            found.done, found.failed, found.missing
        );
        for why in &found.refused {
            text += &format!("no use            {why}\n");
        }
    }
    text + &format!("expected time     {time}\n")
}
