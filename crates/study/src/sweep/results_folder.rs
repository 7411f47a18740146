//! A folder of results taken for a study.
//!
//! Knows the lock, the journal and what makes a folder another study's. Does not run anything.

use super::archive::archive;
use super::fingerprint::binding;
use super::{SweepError, SweepSetting, Watcher};
use pontoon_journal::place::Folder;
use pontoon_journal::{Binding, Damage, FOLDER, JournalIndex, Lock, Session, SessionEnd};
use pontoon_plan::input::Refusal;
use pontoon_plan::study_file::Study;
use pontoon_results::{OwnFiles, Preparation, SessionNote};
use std::collections::BTreeSet;
use std::path::Path;

/// A folder of results that is this process's own.
#[derive(Debug)]
pub(super) struct ResultsFolder {
    pub folder: Folder,
    pub index: JournalIndex,
    pub binding: Binding,
    _lock: Lock,
}

impl ResultsFolder {
    /// Takes the folder: makes it where it is missing, locks it, reads its journal, and refuses what is another study's.
    pub(super) fn take(study: &Study, setting: &SweepSetting, watcher: &dyn Watcher) -> Result<Self, SweepError> {
        check_folder(&setting.out)?;
        if !setting.fresh {
            pontoon_results::check_own(&setting.out, &study.name)?;
        }
        let binding = binding(study, setting.shard);
        // a folder that no run has ever taken is left as it is where it is refused
        if !setting.fresh && !Lock::is_known(&setting.out) {
            check_use(&JournalIndex::read(&setting.out)?, &binding, setting)?;
        }
        let folder = Folder::create(&setting.out)?;
        let lock = Lock::take(&setting.out)?;
        let mut index = JournalIndex::read(&setting.out);
        if setting.fresh {
            if let Some(to) = archive(&setting.out, index.as_ref().ok())? {
                watcher.note(&format!("older results are now in {}", to.display()));
            }
            index = JournalIndex::read(&setting.out);
        }
        let index = index?;
        check_use(&index, &binding, setting)?;
        Ok(Self {
            folder,
            index,
            binding,
            _lock: lock,
        })
    }

    /// Whether the last process that worked here had this study and was asked for the same.
    pub(super) fn is_of(&self, study: &Study) -> bool {
        self.index.newest().is_some_and(|(then, session)| {
            then.shard == self.binding.shard
                && session.study_blake3 == study.document.hash()
                && session.bridge_blake3 == study.bridge.document.hash()
        })
    }

    /// Reads the journal again.
    pub(super) fn read_again(&mut self) -> Result<(), SweepError> {
        self.index = JournalIndex::read(self.folder.path())?;
        Ok(())
    }

    /// Instruction paths that records were computed on, `own` among them where this process computes any.
    pub(super) fn instruction_paths(&self, own: bool) -> Vec<String> {
        let own = own.then_some(&self.binding.instruction_path);
        instruction_paths(&self.index)
            .chain(own)
            .cloned()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect()
    }

    /// What jobs share, as earlier processes prepared it.
    pub(super) fn preparations(&self) -> impl Iterator<Item = Preparation> {
        preparations(&self.index)
    }

    /// The processes that worked on the study before.
    pub(super) fn sessions(&self) -> Vec<SessionNote> {
        sessions(&self.index)
    }
}

/// What the records of a journal are bound to.
pub(super) fn bindings(index: &JournalIndex) -> impl Iterator<Item = &Binding> {
    index.files.iter().filter_map(|written| written.binding.as_ref())
}

/// Instruction paths that a journal's records were computed on.
pub(super) fn instruction_paths(index: &JournalIndex) -> impl Iterator<Item = &String> {
    let with_records = index.files.iter().filter(|written| written.records > 0);
    with_records
        .filter_map(|written| written.binding.as_ref())
        .map(|binding| &binding.instruction_path)
}

pub(super) fn preparations(index: &JournalIndex) -> impl Iterator<Item = Preparation> {
    let prepared = index.files.iter().flat_map(|written| &written.prepared);
    prepared.filter_map(|value| serde_json::from_value(value.clone()).ok())
}

pub(super) fn sessions(index: &JournalIndex) -> Vec<SessionNote> {
    let note =
        |(session, ending, shard, records): (&Session, Option<&SessionEnd>, Option<&String>, usize)| SessionNote {
            started: session.started.clone(),
            finished: ending.map(|ending| ending.finished.clone()),
            host: session.host.clone(),
            threads: session.threads,
            version: session.version.clone(),
            commit: session.commit.clone(),
            shard: shard.cloned(),
            records,
            ended: ending.map_or_else(|| "died".to_owned(), |ending| ending.how.clone()),
        };
    let known = index.files.iter().filter_map(|written| {
        let (binding, session) = (written.binding.as_ref()?, written.session.as_ref()?);
        Some((
            session,
            written.ending.as_ref(),
            binding.shard.as_ref(),
            written.records,
        ))
    });
    known.map(note).collect()
}

/// Refuses what is there and is no folder.
pub(super) fn check_folder(path: &Path) -> Result<(), Refusal> {
    if path.exists() && !path.is_dir() {
        return Err(Refusal::new(path, "", "a file", "a folder of results"));
    }
    Ok(())
}

/// Tells what was passed over in a journal.
pub(super) fn tell_damage(index: &JournalIndex, tell: impl Fn(&str)) {
    for (path, damage) in index.damages() {
        tell(&words(path, damage));
    }
    for written in index.files.iter().filter(|written| written.binding.is_none()) {
        let path = written.path.display();
        tell(&format!("{path}: begins with no whole frame; nothing of it is used"));
    }
}

/// Refuses what a folder holds and is of no use to a study.
fn check_use(index: &JournalIndex, now: &Binding, setting: &SweepSetting) -> Result<(), Refusal> {
    check(index, now, setting)?;
    if index.files.is_empty() {
        refuse_without_journal(&setting.out)?;
    }
    Ok(())
}

/// Refuses a journal whose records are of no use to a study.
fn check(index: &JournalIndex, now: &Binding, setting: &SweepSetting) -> Result<(), Refusal> {
    for written in &index.files {
        let Some(then) = &written.binding else { continue };
        let refuse = |key: &str, found: String, allowed: &str| Err(Refusal::new(&written.path, key, found, allowed));
        let differences = then.differences(now);
        if !differences.is_empty() {
            return refuse(
                "",
                format!("records of another study or program ({})", differences.join("; ")),
                "the study that these results are of with jobs added or left out; --fresh moves them aside and begins anew",
            );
        }
        if let (Some(then), now) = (&then.shard, &now.shard)
            && setting.shard.is_some()
            && Some(then) != now.as_ref()
        {
            let allowed = format!("{then}, a folder a share");
            return refuse(
                "shard",
                setting.shard.map(|s| s.to_string()).unwrap_or_default(),
                &allowed,
            );
        }
        if written.records > 0 && then.instruction_path != now.instruction_path && !setting.any_instructions {
            return refuse(
                "instruction_path",
                format!("records computed on {}", then.instruction_path),
                &format!("{} as this machine has it, or --any-instructions", now.instruction_path),
            );
        }
    }
    Ok(())
}

/// Refuses a folder that holds tables and no journal: they would be replaced by a run that knows nothing of them.
fn refuse_without_journal(folder: &Path) -> Result<(), Refusal> {
    let Some(file) = OwnFiles::in_folder(folder).into_iter().next() else {
        return Ok(());
    };
    let found = format!("results without the {FOLDER} that they were made from");
    Err(Refusal::new(
        &file,
        "",
        found,
        "a folder without results, or with its journal; --fresh moves them aside and begins anew",
    ))
}

fn words(path: &Path, damage: &Damage) -> String {
    let what = match (damage.tail, damage.zero) {
        (true, true) => "zeros at its end",
        (true, false) => "torn at its end",
        (false, _) => "damaged",
    };
    format!(
        "{}: {what}, {} bytes from byte {} are passed over; jobs that stood there alone run again",
        path.display(),
        damage.bytes,
        damage.from
    )
}
