//! What a study's records are bound to, and a study from a journal alone.
//!
//! Knows which of a study's numbers are no part of a job's key but of every record. Does not know files of journals.

use super::{SweepError, SweepSetting};
use crate::run::instruction_path;
use pontoon_journal::{Binding, FORM, JournalError, JournalIndex, Session, document_file, read_document};
use pontoon_plan::input::{Document, Refusal, canonical_text, to_value};
use pontoon_plan::job::Shard;
use pontoon_plan::study_file::{Study, filled_vehicle};
use pontoon_results::Moment;
use std::path::Path;

/// What the records of a study are bound to.
pub(super) fn binding(study: &Study, shard: Option<Shard>) -> Binding {
    let written = &study.vehicle;
    let vehicle = filled_vehicle(written).map_or_else(|_| to_value(written), |filled| to_value(&filled));
    Binding {
        form: FORM,
        name: study.name.clone(),
        numerics: numerics(),
        instruction_path: instruction_path().to_owned(),
        shard: shard.map(|shard| shard.to_string()),
        bridge: to_value(&study.bridge.design.without_words()),
        vehicle,
        analysis: to_value(&study.analysis.written()),
        record: to_value(&*study.record),
    }
}

/// What tells a study and its bridge from any other that computes other numbers or leaves other rows: their words are no part
/// of it.
pub(super) fn hash_of_computed(study: &Study) -> String {
    let bridge = to_value(&study.bridge.design.without_words());
    let both = canonical_text(&study.computed()) + &canonical_text(&bridge);
    blake3::hash(both.as_bytes()).to_hex().to_string()
}

/// This program's version and numerics key, as a journal has them.
fn numerics() -> String {
    format!("{} {}", pontoon_results::VERSION, crate::NUMERICS)
}

/// Refuses a journal whose records another program wrote: their form may be another.
///
/// # Errors
/// [`Refusal`] of the file.
pub(super) fn check_program(index: &JournalIndex) -> Result<(), Refusal> {
    let own = numerics();
    for written in &index.files {
        let bound = written.binding.as_ref();
        if let Some(then) = bound.filter(|then| written.records > 0 && then.numerics != own) {
            let found = format!("records of another program ({} then, {own} now)", then.numerics);
            let allowed = "records of this program: run the study again with --fresh";
            return Err(Refusal::new(&written.path, "", found, allowed));
        }
    }
    Ok(())
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
        host: pontoon_journal::host(),
        process: std::process::id(),
        version: pontoon_results::VERSION.to_owned(),
        commit: setting.commit.clone(),
        threads,
        jobs,
        known,
        apart,
        study_blake3: study.document.hash(),
        bridge_blake3: study.bridge.document.hash(),
        waters: study
            .bridge
            .waters()
            .into_iter()
            .map(|water| (water.file, water.blake3))
            .collect(),
    }
}

/// The study that a session worked on, from its documents in the folder.
///
/// # Errors
/// [`SweepError::Refused`] where this program cannot read it any more; [`SweepError::Journal`] where a document is not there.
pub(super) fn study_of(session: &Session, folder: &Path) -> Result<Study, SweepError> {
    let document = |hash: &str| read_document(folder, hash).map(Document::of_canonical);
    let file = folder.join(document_file(&session.study_blake3));
    let (study, bridge) = (document(&session.study_blake3)?, document(&session.bridge_blake3)?);
    let waters = session
        .waters
        .iter()
        .map(|(file, hash)| Ok((file.clone(), document(hash)?)));
    let waters: Vec<(String, Document)> = waters.collect::<Result<_, JournalError>>()?;
    Ok(Study::of_documents(&file, study, bridge)?.in_waters(waters)?)
}
