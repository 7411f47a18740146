//! Results to read: the tables of a run, from its folder or from its records.
//!
//! Knows how a folder proves that it holds one whole run: its manifest names each table's hash. Does not know what is
//! read of it.

use super::arrow::ArrowTable;
use super::documents::RunDocuments;
use super::files::MANIFEST;
use super::frame::{ArrowFrame, bytes_in_memory, read};
use super::layout::Layout;
use super::memory::too_large;
use super::registry::Column;
use super::results_error::ResultsError;
use super::table::{Table, TableName};
use crate::JobRecord;
use pontoon_journal::place::hash_of;
use pontoon_plan::input::Refusal;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::{Kind, Study};
use serde_json::Value;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs::File;
use std::io;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// The tables of one run.
#[derive(Debug, Clone)]
pub struct Results {
    /// Name of the study.
    pub name: String,
    /// Where they stand, for messages.
    pub place: PathBuf,
    /// The study and the bridge, read when they are asked for.
    pub documents: RunDocuments,
    /// What its manifest says; null of a run that has just ended, or has not.
    pub manifest: Value,
    kind: Kind,
    tables: BTreeMap<TableName, Table>,
    on_disk: BTreeMap<TableName, PathBuf>,
    jobs: Table,
    /// The number of the job in each row of the table of jobs.
    numbers: Vec<u64>,
    row_of_job: HashMap<u64, usize>,
}

/// Rows of a table that a scan has in memory at a time.
const SCANNED: usize = 1 << 18;

impl Results {
    /// Reads a folder of results with its documents.
    ///
    /// # Errors
    /// [`ResultsError::Refused`] where the folder holds no results, [`ResultsError::Damaged`] where they are not whole.
    pub fn read(folder: &Path) -> Result<Self, ResultsError> {
        let results = Self::read_some(folder, &TableName::ALL)?;
        // verdicts stand on them too
        results.documents.bridge_and_vehicle()?;
        Ok(results)
    }

    /// Reads a folder of results with some tables alone in memory, that of jobs always; the others are there to be scanned.
    ///
    /// # Errors
    /// As above.
    pub fn read_some(folder: &Path, wanted: &[TableName]) -> Result<Self, ResultsError> {
        let file = folder.join(MANIFEST);
        let damaged = |file: &Path, found: &str| ResultsError::Damaged {
            file: file.to_owned(),
            found: found.to_owned(),
        };
        if !file.is_file() {
            let found = if folder.is_dir() {
                "no results: manifest.json is missing"
            } else {
                "no such folder"
            };
            return Err(Refusal::new(folder, "", found, "a folder of results, as pontoon run leaves it").into());
        }
        let text = std::fs::read_to_string(&file).map_err(|e| damaged(&file, &e.to_string()))?;
        let manifest: Value = serde_json::from_str(&text).map_err(|e| damaged(&file, &format!("no JSON ({e})")))?;
        let name = manifest["name"]
            .as_str()
            .ok_or_else(|| damaged(&file, "no name of a study"))?;
        let hashes = manifest["tables"]
            .as_object()
            .ok_or_else(|| damaged(&file, "no hashes of its tables, as an earlier version left none"))?;
        let documents = RunDocuments::of_manifest(folder, &file, name, &manifest)?;
        let told = match &manifest["documents"] {
            Value::Null => &manifest["study"]["analysis"]["kind"],
            _ => &manifest["kind"],
        };
        let kind = match told.as_str() {
            Some("static") => Kind::Static,
            Some("modes") => Kind::Modes,
            Some("crossing") => Kind::Crossing,
            Some("rating") => Kind::Rating,
            _ => return Err(damaged(&file, "no kind of its study")),
        };
        let (mut tables, mut on_disk) = (BTreeMap::new(), BTreeMap::new());
        for table in TableName::ALL {
            let path = folder.join(table.file());
            match hashes.get(&table.file()).and_then(Value::as_str) {
                None if path.exists() => {
                    return Err(damaged(&path, "a table of another run: the manifest does not name it"));
                }
                None => {}
                Some(hash) => {
                    if hash_of(&path).map_err(|e| damaged(&path, &e.to_string()))? != hash {
                        return Err(damaged(&path, "not the bytes that the manifest names"));
                    }
                    if table == TableName::Jobs || wanted.contains(&table) {
                        check_memory(&path)?;
                        let read = read_table(&path).map_err(|e| damaged(&path, &e.to_string()))?;
                        tables.insert(table, read);
                    } else {
                        on_disk.insert(table, path);
                    }
                }
            }
        }
        let jobs = tables
            .remove(&TableName::Jobs)
            .ok_or_else(|| damaged(&file, "no table of jobs"))?;
        let jobs_file = folder.join(TableName::Jobs.file());
        if let Some(column) = ["job", "status", "reason"].into_iter().find(|column| !jobs.has(column)) {
            return Err(damaged(&jobs_file, &format!("no column {column}")));
        }
        let count = manifest["jobs"].as_u64();
        if count != Some(jobs.rows() as u64) {
            return Err(damaged(
                &file,
                &format!("{} rows of jobs where {count:?} ran", jobs.rows()),
            ));
        }
        let numbers =
            numbers_of(&jobs).ok_or_else(|| damaged(&jobs_file, "job numbers that are not whole or not unique"))?;
        Ok(Self {
            name: name.to_owned(),
            place: folder.to_owned(),
            documents,
            kind,
            manifest: manifest.clone(),
            tables,
            on_disk,
            jobs,
            row_of_job: numbers.iter().enumerate().map(|(row, n)| (*n, row)).collect(),
            numbers,
        })
    }

    /// The tables of records, without a file or a data frame: of a run that has just ended, or is not done.
    pub fn of_records(study: &Study, jobs: &[Job], records: &[JobRecord], place: &Path) -> Self {
        let layout = Layout::new(study, jobs);
        let mut tables: BTreeMap<TableName, Table> = layout
            .tables()
            .map(|name| (name, layout.table(name, jobs, records)))
            .collect();
        let job_table = tables.remove(&TableName::Jobs).unwrap_or_default();
        let numbers: Vec<u64> = records.iter().map(|record| record.job as u64).collect();
        Self {
            name: study.name.clone(),
            place: place.to_owned(),
            documents: RunDocuments::of_study(study),
            kind: study.analysis.kind(),
            manifest: Value::Null,
            on_disk: BTreeMap::new(),
            tables,
            jobs: job_table,
            row_of_job: numbers.iter().enumerate().map(|(row, n)| (*n, row)).collect(),
            numbers,
        }
    }

    /// The table of jobs.
    pub fn jobs(&self) -> &Table {
        &self.jobs
    }

    /// Hands on a table part by part in the order of its rows, of one on disk with some columns alone; nothing where the run
    /// left none.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub fn scan(&self, name: TableName, columns: &[&str], mut take: impl FnMut(&Table)) -> Result<(), ResultsError> {
        if let Some(table) = self.table(name) {
            take(table);
            return Ok(());
        }
        let Some(path) = self.on_disk.get(&name) else {
            return Ok(());
        };
        let mut start = 0;
        loop {
            let part = read_part(path, columns, start).map_err(|found| ResultsError::Damaged {
                file: path.clone(),
                found: found.to_string(),
            })?;
            if part.rows() == 0 {
                return Ok(());
            }
            take(&part);
            start += part.rows();
        }
    }

    /// A table, where the run left it and it was read.
    pub fn table(&self, name: TableName) -> Option<&Table> {
        match name {
            TableName::Jobs => Some(&self.jobs),
            other => self.tables.get(&other),
        }
    }

    /// Whether the run left a table.
    pub fn has_table(&self, name: TableName) -> bool {
        self.table(name).is_some() || self.on_disk.contains_key(&name)
    }

    /// A table of a folder as arrays; nothing where the run left none.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`], [`ResultsError::TooLarge`].
    pub fn arrays(&self, name: TableName) -> Result<Option<ArrowTable>, ResultsError> {
        let path = self.place.join(name.file());
        if !self.has_table(name) {
            return Ok(None);
        }
        check_memory(&path)?;
        let read = || read(&mut File::open(&path)?, None, &(0..usize::MAX));
        let read =
            catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| Err(io::Error::other("no readable Parquet file")));
        let parts = read.map_err(|found| ResultsError::Damaged {
            file: path.clone(),
            found: found.to_string(),
        })?;
        let empty = parts.first().map(ArrowFrame::without_rows).unwrap_or_default();
        Ok(Some(ArrowTable::new(empty, parts)))
    }

    /// The row of a job in the table of jobs.
    pub fn row_of_job(&self, job: u64) -> Option<usize> {
        self.row_of_job.get(&job).copied()
    }

    /// The number of the job in a row of the table of jobs, which each row has.
    pub fn job_of_row(&self, row: usize) -> u64 {
        self.numbers[row]
    }

    /// Whether the job in a row of the table of jobs has no results.
    pub fn is_failed(&self, row: usize) -> bool {
        let status = self
            .jobs
            .word_cells("status")
            .and_then(|words| words.get(row)?.as_deref());
        status != Some("ok")
    }

    /// What the study asks of the bridge.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The columns of the table of jobs that are axes.
    pub fn axes(&self) -> Vec<String> {
        let is_axis = |name: &&str| Column::of(TableName::Jobs, name).is_none();
        self.jobs.names().filter(is_axis).map(str::to_owned).collect()
    }
}

/// The number of the job in each row of the table of jobs; none where one is not whole, or stands twice.
fn numbers_of(jobs: &Table) -> Option<Vec<u64>> {
    let whole = |row| {
        let number = jobs.number("job", row).filter(|n| *n >= 0.0 && n.fract() == 0.0);
        number.map(|n| n as u64)
    };
    let numbers: Vec<u64> = (0..jobs.rows()).map(whole).collect::<Option<_>>()?;
    let distinct: HashSet<&u64> = numbers.iter().collect();
    (distinct.len() == numbers.len()).then_some(numbers)
}

/// Refuses a table that would not fit into memory, by what its footer says; one that cannot be read is told by who reads it.
fn check_memory(path: &Path) -> Result<(), ResultsError> {
    let needed = || bytes_in_memory(&mut File::open(path)?);
    let needed = catch_unwind(AssertUnwindSafe(needed)).ok().and_then(Result::ok);
    match needed.and_then(too_large) {
        None => Ok(()),
        Some(found) => Err(ResultsError::TooLarge {
            file: path.to_owned(),
            found,
        }),
    }
}

/// Reads a Parquet file; that the library panics over it is an error like any other.
fn read_table(path: &Path) -> io::Result<Table> {
    guarded(path, None, &(0..usize::MAX))
}

/// Reads some rows of some columns, of those that the file has.
fn read_part(path: &Path, columns: &[&str], start: usize) -> io::Result<Table> {
    guarded(path, Some(columns), &(start..start.saturating_add(SCANNED)))
}

fn guarded(path: &Path, columns: Option<&[&str]>, rows: &Range<usize>) -> io::Result<Table> {
    let read = || {
        let frames = read(&mut File::open(path)?, columns, rows)?;
        Table::from_frames(&frames)
    };
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| Err(io::Error::other("no readable Parquet file")))
}
