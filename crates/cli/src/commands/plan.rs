//! `pontoon plan`: what would run.

use crate::Ending;
use crate::args::{Common, Format, PlanArguments};
use crate::words;
use anyhow::Result;
use pontoon_study::Study;
use pontoon_study::plan::Plan;
use serde_json::json;

/// Checks every job and says what would run.
pub fn plan(arguments: &PlanArguments, common: Common) -> Result<Ending> {
    let study = Study::open(&arguments.study)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let plan = Plan::new(&study, threads)?;
    words::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(plan)),
        _ => text(&plan, threads),
    })?;
    Ok(Ending::Good)
}

fn text(plan: &Plan, threads: usize) -> String {
    let merged = plan.points - plan.jobs;
    let merged = if merged > 0 {
        format!(" ({merged} equal points merged)")
    } else {
        String::new()
    };
    format!(
        "study             {}\njobs              {}{merged}\ndistinct bridges  {}\ncondensations     {}\nsteps             {}\nexpected time     about {} on {threads} threads\n",
        plan.study,
        plan.jobs,
        plan.distinct_bridges,
        plan.condensations,
        plan.steps,
        words::duration(plan.expected_seconds),
    )
}
