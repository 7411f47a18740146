//! The manifest: what ran, where, when, and what it cost. All that changes from run to run stands here.
//!
//! Knows the clock and the machine's name. Does not know the tables' content.

use super::files::MANIFEST;
use super::moment::Moment;
use super::parquet::TableProvenance;
use crate::{BridgeReport, OperatorCounts, Outcome, Verification};
use pontoon_journal::document_file;
use pontoon_journal::place::hash_of;
use pontoon_plan::input::{Document, Refusal};
use pontoon_plan::job::{Doubts, Job};
use pontoon_plan::study_file::{Kind, ModelSpec, Study};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A process that worked on a study, for the manifest.
#[derive(Debug, Clone, Serialize)]
pub struct SessionNote {
    /// When it began (UTC).
    pub started: String,
    /// When it ended (UTC); null where it did not come to its own end.
    pub finished: Option<String>,
    /// Name of the machine.
    pub host: String,
    /// Threads.
    pub threads: usize,
    /// Version of the program.
    pub version: String,
    /// Commit of the program's sources, where it was built from one.
    pub commit: Option<String>,
    /// The share of the jobs; null where all were asked for.
    pub shard: Option<String>,
    /// Records that it left.
    pub records: usize,
    /// `complete`, `interrupted`, `died`, or why it could not go on.
    pub ended: String,
}

/// Where a document stands beside the tables.
#[derive(Debug, Clone, Serialize)]
pub struct DocumentPlace {
    /// Its file, in the folder of results.
    pub file: String,
    /// Bytes of it.
    pub bytes: usize,
}

impl DocumentPlace {
    fn of(document: &Document) -> Self {
        Self {
            file: document_file(&document.hash()),
            bytes: document.text().len(),
        }
    }
}

/// What `manifest.json` holds.
#[derive(Debug, Clone, Serialize)]
pub struct Manifest {
    /// Version of the program.
    pub version: &'static str,
    /// Commit of its sources, where it was built from one.
    pub commit: Option<String>,
    /// Name of the study.
    pub name: String,
    /// What the study asks of the bridge.
    pub kind: Kind,
    /// Hash of the study's document on one line.
    pub study_blake3: String,
    /// Hash of the bridge's document, before the axes, on one line.
    pub bridge_blake3: String,
    /// Where these documents stand.
    pub documents: BTreeMap<&'static str, DocumentPlace>,
    /// Seeds of the designs, in the order of the study's file.
    pub seeds: Vec<u64>,
    /// Jobs.
    pub jobs: usize,
    /// Jobs that failed.
    pub failed: usize,
    /// Points of the designs that were equal to an earlier one.
    pub merged: usize,
    /// Numbers of the study that look as if they were in another unit, in words.
    pub notes: Vec<String>,
    /// Bridges whose documents differ after the axes.
    pub distinct_bridges: usize,
    /// Modules whose condensation differs: the connectors' gaps and stiffness, draft and freeboard are no part of it.
    pub distinct_modules: usize,
    /// Condensations that ran.
    pub condensations: usize,
    /// Where operators came from.
    pub operators: OperatorCounts,
    /// What was prepared of each bridge and model.
    pub bridges: Vec<BridgeReport>,
    /// Jobs solved again by the reference solver, and how far the operator is off; null where none was.
    pub verification: Option<Verification>,
    /// Instructions that crossings by the operator ran on; several, with `; ` between them, where shards of such were merged.
    pub instruction_path: String,
    /// Name of the machine.
    pub host: String,
    /// Threads used.
    pub threads: usize,
    /// Processes that worked on the study before this one.
    pub sessions: Vec<SessionNote>,
    /// Jobs that this process ran, the others being recorded before.
    pub ran: usize,
    /// When the run began (UTC).
    pub started: String,
    /// When the last job was done (UTC).
    pub finished: String,
    /// Wall time of what jobs share: finite elements, condensation, assembly, factors, static peaks `[s]`.
    pub offline_s: f64,
    /// Wall time of the jobs, the writing of their rows included `[s]`.
    pub jobs_s: f64,
    /// The blake3 hash of each table's file, filled in as the tables are written.
    pub tables: BTreeMap<String, String>,
}

impl Manifest {
    /// The manifest of a run.
    pub fn new(
        study: &Study,
        jobs: &[Job],
        outcome: &Outcome,
        started: Moment,
        finished: Moment,
        provenance: &TableProvenance,
    ) -> Self {
        let preparation = &outcome.preparation;
        let condensed = jobs.iter().filter(|job| job.model() == ModelSpec::SuperElement);
        Self {
            version: crate::VERSION,
            commit: provenance.commit.clone(),
            name: study.name.clone(),
            kind: study.analysis.kind(),
            study_blake3: study.document.hash(),
            bridge_blake3: study.bridge.document.hash(),
            documents: BTreeMap::from([
                ("study", DocumentPlace::of(&study.document)),
                ("bridge", DocumentPlace::of(&study.bridge.document)),
            ]),
            seeds: study.seeds.clone(),
            jobs: jobs.len(),
            failed: outcome.failures.count,
            merged: study.points() - jobs.len(),
            notes: Doubts::of(jobs).notes(),
            distinct_bridges: jobs
                .iter()
                .map(|job| job.shared.bridge.id)
                .collect::<BTreeSet<_>>()
                .len(),
            distinct_modules: condensed
                .flat_map(|job| &job.shared.bridge.module_keys)
                .collect::<BTreeSet<_>>()
                .len(),
            condensations: preparation.condensations,
            operators: preparation.operators,
            bridges: preparation.bridges.clone(),
            verification: Some(outcome.verification).filter(|v| v.jobs > 0),
            instruction_path: provenance.instruction_paths.join("; "),
            sessions: Vec::new(),
            ran: outcome.ran,
            host: pontoon_journal::host(),
            threads: outcome.threads,
            started: started.text(),
            finished: finished.text(),
            offline_s: outcome.offline_s,
            jobs_s: outcome.jobs_s,
            tables: BTreeMap::new(),
        }
    }

    /// Its text.
    pub(super) fn text(&self) -> String {
        let value = pontoon_plan::input::to_value(self);
        format!("{value:#}\n")
    }
}

/// Whether a folder holds the whole results of a study's jobs, so many of them failed, as this program would write them.
pub(super) fn is_whole(
    folder: &Path,
    study: &Study,
    (jobs, failed): (usize, usize),
    tables: &[String],
    provenance: &TableProvenance,
) -> bool {
    let told = std::fs::read(folder.join(MANIFEST)).ok();
    let Some(told) = told.and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok()) else {
        return false;
    };
    let now = [
        ("version", crate::VERSION.into()),
        ("commit", provenance.commit.clone().into()),
        ("instruction_path", provenance.instruction_paths.join("; ").into()),
        ("study_blake3", study.document.hash().into()),
        ("bridge_blake3", study.bridge.document.hash().into()),
        ("jobs", Value::from(jobs)),
        ("failed", Value::from(failed)),
    ];
    let hashes = told["tables"].as_object();
    let whole =
        |name: &String| hash_of(&folder.join(name)).is_ok_and(|hash| told["tables"][name].as_str() == Some(&hash));
    now.iter().all(|(key, value)| told[*key] == *value)
        && hashes.is_some_and(|hashes| hashes.len() == tables.len())
        && tables.iter().all(whole)
}

/// Refuses a folder that holds the results of a study of another name.
///
/// # Errors
/// [`Refusal`] on the manifest found there.
pub fn check_own(folder: &Path, name: &str) -> Result<(), Refusal> {
    let file = folder.join(MANIFEST);
    let manifest: Option<Value> = std::fs::read(&file)
        .ok()
        .and_then(|bytes| serde_json::from_slice(&bytes).ok());
    match manifest.as_ref().and_then(|manifest| manifest["name"].as_str()) {
        Some(other) if other != name => {
            let allowed = format!("a folder without results, or with those of '{name}'; --fresh moves them aside");
            let found = format!("results of the study '{other}'");
            Err(Refusal::new(&file, "name", found, allowed))
        }
        _ => Ok(()),
    }
}
