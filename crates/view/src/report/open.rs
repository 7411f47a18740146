//! What a folder holds: whole tables, or what a journal has so far.
//!
//! Knows what a reader must be told of a run that is not done. Does not know pages.

use super::Item;
use pontoon_plan::input::Refusal;
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::Study;
use pontoon_results::{Results, ResultsError, TableName};
use pontoon_study::sweep::{PartialResults, SweepError, partial_results};
use serde_json::Value;
use std::path::Path;

/// Results with what is known of the run that left them.
#[derive(Debug)]
pub struct OpenedResults {
    /// The tables.
    pub results: Results,
    /// The study, where this program can read it.
    pub study: Option<Study>,
    /// Jobs of the study that no row is there of.
    pub missing: usize,
    /// What a reader must know.
    pub notes: Vec<String>,
    /// Where the numbers come from.
    pub provenance: Vec<Item>,
}

/// Tables that a page has in memory where it need not have all.
const NEEDED: [TableName; 2] = [TableName::Jobs, TableName::Modes];

impl OpenedResults {
    /// Opens a folder of results; one without tables where it has a journal. `whole` reads every table into memory, as
    /// comparisons need them.
    ///
    /// # Errors
    /// [`ResultsError`]: a folder with neither, tables that are not whole.
    pub fn open(folder: &Path, whole: bool) -> Result<Self, ResultsError> {
        match Results::read_some(folder, if whole { &TableName::ALL } else { &NEEDED }) {
            Ok(results) => Self::of_results(results),
            Err(ResultsError::Refused(refused)) => match partial_results(folder) {
                Ok(found) => Ok(Self::of_journal(folder, found)),
                Err(SweepError::Refused(_)) => Err(refused.into()),
                Err(error) => Err(damaged(folder, error.to_string())),
            },
            Err(error) => Err(error),
        }
    }

    fn of_results(results: Results) -> Result<Self, ResultsError> {
        let file = results.place.join("manifest.json");
        let documents = &results.documents;
        let (study, bridge) = (documents.study()?.clone(), documents.bridge()?.clone());
        let waters = documents.waters()?;
        let read = Study::of_documents(&file, study, bridge).and_then(|study| study.in_waters(waters));
        let mut notes = Vec::new();
        let study = read.map_err(|refused| notes.push(unreadable(&refused))).ok();
        let of = |key: &str| match &results.manifest[key] {
            Value::Null => None,
            Value::String(text) => Some(text.clone()),
            other => Some(other.to_string()),
        };
        let item = |(label, key): (&str, &str)| Some(Item::new(label, of(key)?));
        let listed = [
            ("program", "version"),
            ("commit", "commit"),
            ("study, blake3", "study_blake3"),
            ("bridge, blake3", "bridge_blake3"),
            ("started", "started"),
            ("finished", "finished"),
            ("machine", "host"),
            ("threads", "threads"),
            ("instructions", "instruction_path"),
        ];
        let mut provenance: Vec<Item> = listed.into_iter().filter_map(item).collect();
        let sessions = results.manifest["sessions"].as_array().map_or(0, Vec::len);
        if sessions > 0 {
            provenance.push(Item::new("processes before", sessions.to_string()));
        }
        for table in results.manifest["tables"].as_object().into_iter().flatten() {
            provenance.push(Item::new(
                format!("{}, blake3", table.0),
                table.1.as_str().unwrap_or_default(),
            ));
        }
        Ok(Self {
            results,
            study,
            missing: 0,
            notes,
            provenance,
        })
    }

    fn of_journal(folder: &Path, found: PartialResults) -> Self {
        let PartialResults {
            study,
            jobs,
            records,
            of,
            shard,
            session,
        } = found;
        let results = Results::of_records(&study, &jobs, &records, folder);
        let share = shard.map(|shard| format!(" This folder is the share {shard} of them."));
        let known = jobs.len();
        let state = match known < of {
            true => "the run is not done, and this page shows what is there",
            false => "the tables are not there, and this page is made of the journal; the same run again writes them",
        };
        let note = format!(
            "{known} of {of} jobs are recorded: {state}.{}",
            share.unwrap_or_default()
        );
        let provenance = [
            ("program", Some(session.version)),
            ("commit", session.commit),
            ("study, blake3", Some(study.document.hash())),
            ("bridge, blake3", Some(study.bridge.document.hash())),
            ("last begun", Some(session.started)),
            ("machine", Some(session.host)),
            ("threads", Some(session.threads.to_string())),
        ];
        Self {
            results,
            missing: of - jobs.len(),
            notes: vec![note],
            provenance: provenance
                .into_iter()
                .filter_map(|(label, value)| Some(Item::new(label, value?)))
                .collect(),
            study: Some(study),
        }
    }

    /// The jobs of the study in the order of their numbers; none where this program cannot read the study.
    pub(super) fn jobs(&mut self) -> Vec<Job> {
        let Some(study) = &self.study else { return Vec::new() };
        match Jobs::new(study).collect::<Result<Vec<Job>, Refusal>>() {
            Ok(jobs) => jobs,
            Err(refused) => {
                self.notes.push(unreadable(&refused));
                Vec::new()
            }
        }
    }
}

fn unreadable(refused: &Refusal) -> String {
    format!("This program cannot read the study any more ({refused}): crossings and shapes are left out.")
}

fn damaged(folder: &Path, found: String) -> ResultsError {
    ResultsError::Damaged {
        file: folder.to_owned(),
        found,
    }
}
