//! What a study's records are bound to, and a study from a journal alone.
//!
//! Knows which of a study's numbers are no part of a job's key but of every record. Does not know files of journals.

use super::SweepSetting;
use crate::journal::{Binding, FORM, Session};
use crate::plan::Shard;
use crate::refusal::Refusal;
use crate::run::instruction_path;
use crate::spec::{Study, filled_vehicle, to_value};
use crate::tables::Moment;
use pontoon_core::operator::SOURCES;
use std::path::Path;

/// What the records of a study are bound to.
pub(super) fn binding(study: &Study, shard: Option<Shard>) -> Binding {
    let spec = &study.spec;
    let vehicle = filled_vehicle(&spec.vehicle).map_or_else(|_| to_value(&spec.vehicle), |filled| to_value(&filled));
    let analysis = spec.analysis.clone().checked();
    Binding {
        form: FORM,
        name: spec.name.clone(),
        numerics: format!("{} {SOURCES} {}", crate::VERSION, env!("PONTOON_RUN_SOURCES")),
        instruction_path: instruction_path().to_owned(),
        shard: shard.map(|shard| shard.to_string()),
        bridge: to_value(&study.bridge.design),
        vehicle,
        analysis: analysis.map_or_else(|_| to_value(&spec.analysis), |checked| to_value(&checked)),
        record: to_value(&spec.record),
    }
}

/// This process at work on a study.
pub(super) fn session(
    study: &Study,
    setting: &SweepSetting,
    threads: usize,
    jobs: usize,
    known: usize,
    apart: bool,
) -> Session {
    Session {
        started: Moment::now().text(),
        host: crate::journal::host(),
        process: std::process::id(),
        version: crate::VERSION.to_owned(),
        commit: setting.commit.clone(),
        threads,
        jobs,
        known,
        apart,
        study: study.document.clone(),
        bridge: study.bridge.document.clone(),
    }
}

/// The study that a session worked on; `folder` stands for its file in messages.
///
/// # Errors
/// [`Refusal`] where this program cannot read it any more.
pub(super) fn study_of(session: &Session, folder: &Path) -> Result<Study, Refusal> {
    Study::of_documents(
        &folder.join("study.json"),
        session.study.clone(),
        session.bridge.clone(),
    )
}
