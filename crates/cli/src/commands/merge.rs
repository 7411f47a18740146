//! `pontoon merge`: shards to the results of the whole study.

use super::run::answer;
use crate::args::{Common, MergeArguments};
use crate::exit_status::ExitStatus;
use crate::progress::ProgressDisplay;
use crate::signals::Signals;
use crate::watching::Watching;
use anyhow::Result;
use pontoon_study::sweep::{Merged, SweepSetting, merge as merge_shards};

/// Puts shards together.
pub(crate) fn merge(arguments: &MergeArguments, common: Common) -> Result<ExitStatus> {
    let signals = Signals::listen()?;
    let merged = Merged::of(&arguments.folders)?;
    let setting = SweepSetting {
        out: arguments.out.clone(),
        any_instructions: arguments.any_instructions,
        commit: crate::commit::COMMIT.map(str::to_owned),
        ..SweepSetting::default()
    };
    let watching = Watching::new(ProgressDisplay::fitting(common.quiet), &signals, None);
    let swept = merge_shards(&merged, &arguments.folders, &setting, &signals.stop, &watching);
    watching.finish();
    answer(&merged.study, &swept?, &arguments.out, None, common)
}
