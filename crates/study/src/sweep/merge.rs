//! Shards put together.
//!
//! Knows that shards are journals of one study whose records do not contradict each other, and that together they hold every
//! job. The merged folder is one that the whole study could have been run into: its journal holds the shards' files, and a
//! study that has grown goes on from there.

use super::ending::ending;
use super::fingerprint::{binding, hash_of_computed, session};
use super::results_folder::{check_folder, instruction_paths, preparations, sessions, tell_damage};
use super::status::study_of_index;
use super::{SweepError, SweepSetting, Swept, Watcher};
use crate::run::{CancelToken, ResumeIndex, Setting, record_key, run};
use pontoon_journal::place::{Folder, HiddenFile, hash_of, sync_folder};
use pontoon_journal::{EXTENSION, FOLDER, JournalError, JournalIndex, JournalWriter, Lock, Session, fault};
use pontoon_plan::input::Refusal;
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::Study;
use pontoon_results::{JobRecord, Manifest, Moment, TableProvenance, TableWriter};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Shards as they were found.
#[derive(Debug)]
pub struct Merged {
    /// The study that they are of.
    pub study: Study,
    /// Its jobs.
    pub jobs: Vec<Job>,
}

impl Merged {
    /// The study of shards, from their journals.
    ///
    /// # Errors
    /// [`SweepError::Refused`] of folders that are of different studies.
    pub fn of(folders: &[PathBuf]) -> Result<Self, SweepError> {
        let mut first: Option<(PathBuf, String)> = None;
        let (mut study, mut known_hashes) = (None, BTreeSet::new());
        for folder in folders {
            check_folder(folder)?;
            let index = JournalIndex::read(folder)?;
            // documents that were read once need not be read again, large as they may be
            let hashes = |(_, session): (_, &Session)| (session.study_blake3.clone(), session.bridge_blake3.clone());
            if index
                .newest()
                .is_some_and(|newest| !known_hashes.insert(hashes(newest)))
            {
                continue;
            }
            let (of_folder, ..) = study_of_index(&index, folder)?;
            let hash = hash_of_computed(&of_folder);
            match &first {
                None => {
                    first = Some((folder.clone(), hash));
                    study = Some(of_folder);
                }
                Some((_, known)) if *known == hash => {}
                Some((other, _)) => {
                    let allowed = format!("the study of {}", other.display());
                    return Err(Refusal::new(folder, "", "a shard of another study", allowed).into());
                }
            }
        }
        let Some(study) = study else {
            return Err(Refusal::new(Path::new("merge"), "", "no folder", "the folders of all shards").into());
        };
        let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>()?;
        Ok(Self { study, jobs })
    }
}

/// Puts shards together: their journals into the journal of `setting.out`, their records into its tables.
///
/// # Errors
/// Bytes of memory that merging takes for each job: its entry in the index of its shard and of all, its place among them and
/// its line of the summary.
const BYTES_A_JOB: u64 = 320;

/// Refuses shards whose index would not fit into memory.
fn check_memory(jobs: usize, folders: &[PathBuf], out: &Path) -> Result<(), Refusal> {
    match pontoon_results::too_large(BYTES_A_JOB * jobs as u64) {
        None => Ok(()),
        Some(needs) => {
            let found = format!("{jobs} jobs in {} shards, which need {needs}", folders.len());
            Err(Refusal::new(
                out,
                "",
                found,
                "what fits into memory: a machine with more of it",
            ))
        }
    }
}

/// [`SweepError::Refused`] of shards that do not belong together, contradict each other or leave jobs out.
pub fn merge<'a>(
    merged: &'a Merged,
    folders: &[PathBuf],
    setting: &SweepSetting,
    cancel: &CancelToken,
    watcher: &dyn Watcher,
) -> Result<Swept<'a>, SweepError> {
    let Merged { study, jobs } = merged;
    pontoon_results::check_own(&setting.out, &study.name)?;
    let started = Moment::now();
    check_distinct(folders, &setting.out)?;
    check_folder(&setting.out)?;
    // shards stand still while they are read
    let _locks = folders
        .iter()
        .map(|folder| Lock::take(folder))
        .collect::<Result<Vec<_>, _>>()?;
    watcher.stage("checking shards");
    check_memory(jobs.len(), folders, &setting.out)?;
    let now = binding(study, None);
    // what the folder of the results holds already counts like a shard
    let old = setting.out.join(FOLDER).exists().then(|| setting.out.clone());
    let folders: Vec<PathBuf> = old.into_iter().chain(folders.iter().cloned()).collect();
    let mut indexes = Vec::new();
    for folder in &folders {
        let index = JournalIndex::read(folder)?;
        for written in &index.files {
            let differences = written.binding.as_ref().map(|then| then.differences(&now));
            let differences = differences.unwrap_or_default();
            if !differences.is_empty() {
                let found = format!("records of another study or program ({})", differences.join("; "));
                let allowed = "shards of one study by one version of the program";
                return Err(Refusal::new(&written.path, "", found, allowed).into());
            }
        }
        tell_damage(&index, |what| watcher.warn(what));
        indexes.push(index);
    }
    let paths: BTreeSet<String> = indexes.iter().flat_map(instruction_paths).cloned().collect();
    let paths: Vec<String> = paths.into_iter().collect();
    if paths.len() > 1 && !setting.any_instructions {
        let found = format!("shards computed on {}", paths.join(" and "));
        return Err(Refusal::new(
            &folders[0],
            "instruction_path",
            found,
            "one path, or --any-instructions",
        )
        .into());
    }
    let folders = folders.as_slice();
    check_complete(jobs, &indexes, folders)?;
    check_consistent(&indexes, folders)?;
    let folder = Folder::create(&setting.out)?;
    let _lock = Lock::take(&setting.out)?;
    pontoon_results::keep_documents(&setting.out, study)?;
    watcher.stage("journals");
    for source in folders.iter().filter(|source| **source != setting.out) {
        copy_journal(source, &setting.out)?;
    }
    let index = JournalIndex::read(&setting.out)?;
    let resume_index = ResumeIndex::new(&index, jobs);
    if resume_index.known() < jobs.len() {
        let found = format!(
            "{} of {} jobs after the shards were copied",
            resume_index.known(),
            jobs.len()
        );
        return Err(Refusal::new(&setting.out, "", found, "all jobs").into());
    }
    let provenance = TableProvenance {
        commit: setting.commit.clone(),
        instruction_paths: paths,
    };
    let mut tables = TableWriter::begin(study, jobs, &folder, &provenance)?;
    let mut sink = |records: Vec<JobRecord>| tables.append(&records);
    let run_setting = Setting {
        threads: setting.threads,
        batch: setting.batch,
        resume_index: Some(resume_index),
        ..Setting::default()
    };
    let mut outcome = run(study, jobs, run_setting, cancel, watcher, Some(&mut sink)).map_err(SweepError::from)?;
    for before in preparations(&index) {
        outcome.preparation.add(before);
    }
    let mut manifest = Manifest::new(study, jobs, &outcome, started, Moment::now(), &provenance);
    manifest.sessions = sessions(&index);
    // the journal's last word is the whole study's
    let asked = session(study, setting, setting.threads, jobs.len(), jobs.len(), false);
    let last =
        JournalIndex::newest(&index).filter(|(then, of)| then.shard.is_none() && of.study_blake3 == asked.study_blake3);
    if last.is_none() {
        let writer = JournalWriter::begin(&setting.out, &now, &asked, outcome.failures.count)?;
        writer.end(&ending("complete".to_owned(), 0.0, 0.0))?;
    }
    let summary = tables.finish(manifest)?;
    Ok(Swept {
        outcome,
        summary: Some(summary),
        jobs: jobs.len(),
    })
}

/// Refuses a folder that is given twice.
fn check_distinct(folders: &[PathBuf], out: &Path) -> Result<(), Refusal> {
    let real = |folder: &Path| fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    let all: Vec<PathBuf> = folders.iter().map(|folder| real(folder)).collect();
    for (i, folder) in folders.iter().enumerate() {
        if all[..i].contains(&all[i]) {
            return Err(Refusal::new(
                folder,
                "",
                "a shard that is given twice",
                "each shard once",
            ));
        }
        if all[i] == real(out) {
            return Err(Refusal::new(
                folder,
                "",
                "a shard as the folder of results",
                "a folder of its own (--out)",
            ));
        }
    }
    Ok(())
}

/// Refuses shards that leave jobs out.
fn check_complete(jobs: &[Job], indexes: &[JournalIndex], folders: &[PathBuf]) -> Result<(), Refusal> {
    let mut missing = Vec::new();
    let mut count = 0;
    for job in jobs {
        let key = record_key(job);
        if !indexes.iter().any(|index| index.find(&key).is_some()) {
            count += 1;
            if missing.len() < 5 {
                missing.push(job.number.to_string());
            }
        }
    }
    if count == 0 {
        return Ok(());
    }
    let found = format!(
        "{count} of {} jobs in no shard (the first: {})",
        jobs.len(),
        missing.join(", ")
    );
    let allowed = "shards that are run to their end, all of them";
    Err(Refusal::new(
        folders.first().map_or(Path::new(""), PathBuf::as_path),
        "",
        found,
        allowed,
    ))
}

/// Refuses shards whose records of one job differ.
fn check_consistent(indexes: &[JournalIndex], folders: &[PathBuf]) -> Result<(), SweepError> {
    for (i, index) in indexes.iter().enumerate() {
        for entry in index.entries() {
            for (earlier, other) in indexes[..i].iter().enumerate() {
                let Some(same) = other.find(&entry.key) else { continue };
                // one that failed may have been tried again
                if entry.failed || same.failed {
                    continue;
                }
                if index.record(entry.place)?.left != other.record(same.place)?.left {
                    let found = format!(
                        "a record of job key {} that is not the one of {}",
                        entry.key,
                        folders[earlier].display()
                    );
                    return Err(Refusal::new(&folders[i], "", found, "records of one job that are equal").into());
                }
            }
        }
    }
    Ok(())
}

/// Copies the files of a journal that another does not have, each whole or not at all.
fn copy_journal(from: &Path, to: &Path) -> Result<(), SweepError> {
    let (from, to) = (from.join(FOLDER), to.join(FOLDER));
    let error = |path: &Path, cause: io::Error| JournalError::Io {
        path: path.to_owned(),
        cause,
    };
    fs::create_dir_all(&to).map_err(|cause| error(&to, cause))?;
    for entry in fs::read_dir(&from).map_err(|cause| error(&from, cause))? {
        let source = entry.map_err(|cause| error(&from, cause))?.path();
        if source.extension().is_none_or(|e| e != EXTENSION) {
            continue;
        }
        let target = to.join(source.file_name().unwrap_or_default());
        if same_content(&source, &target) {
            continue;
        }
        let copy = || {
            fault::at("merge.copy")?;
            let hidden = HiddenFile::begin(&target)?;
            io::copy(&mut File::open(&source)?, &mut hidden.file())?;
            hidden.file().sync_all()?;
            fault::at("merge.rename")?;
            hidden.put()
        };
        copy().map_err(|cause| error(&target, cause))?;
    }
    sync_folder(&to).map_err(|cause| error(&to, cause))?;
    Ok(())
}

fn same_content(a: &Path, b: &Path) -> bool {
    let length = |path: &Path| fs::metadata(path).map(|m| m.len()).ok();
    length(b).is_some() && length(a) == length(b) && hash_of(a).ok() == hash_of(b).ok()
}
