//! `pontoon compare`: results held against a reference or against older results.

use crate::args::{Common, CompareArguments};
use crate::exit_status::ExitStatus;
use crate::{comparison, text};
use anyhow::Result;
use pontoon_judge::compare::{Tolerances, against_baseline, against_reference};
use pontoon_judge::reference::Reference;
use pontoon_plan::input::Refusal;
use pontoon_results::Results;

/// Compares and writes a line a check.
pub(crate) fn compare(arguments: &CompareArguments, common: Common) -> Result<ExitStatus> {
    let results = Results::read(&arguments.results)?;
    let older = arguments.with.is_dir() && !arguments.with.join("reference.json").is_file();
    let compared = if older {
        let tolerances = arguments.tolerance.as_deref().map(Tolerances::open).transpose()?;
        against_baseline(
            &results,
            &Results::read(&arguments.with)?,
            &tolerances.unwrap_or_default(),
        )?
    } else {
        if let Some(file) = &arguments.tolerance {
            let allowed = "no file of tolerances with a reference, which has its own";
            return Err(Refusal::new(file, "", "--tolerance with a reference", allowed).into());
        }
        against_reference(&results, &Reference::open(&arguments.with)?)?
    };
    text::result(&comparison::written(&compared, common.format)?)?;
    comparison::tell_changes(&compared);
    Ok(if compared.good() {
        ExitStatus::Good
    } else {
        ExitStatus::Short
    })
}
