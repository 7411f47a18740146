//! The numbers of some columns of the table of jobs, as records come: no table is made.
//!
//! Knows which columns hold numbers. Does not know who asks for them.

use super::layout::Layout;
use super::table::TableName;
use crate::JobRecord;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use std::collections::BTreeMap;

/// Numbers of some columns of the table of jobs.
#[derive(Debug)]
pub struct JobNumbers {
    layout: Layout,
    names: Vec<String>,
    /// Of each name the numbers of jobs in their order, no number as nan, yes as 1 and no as 0.
    pub numbers: Vec<Vec<f64>>,
    /// Why jobs failed, by their number.
    pub failures: BTreeMap<usize, String>,
}

/// A name that is no column of numbers.
#[derive(Debug, PartialEq, Eq)]
pub struct NoNumbers {
    /// Its place among the names.
    pub place: usize,
    /// The columns that hold numbers.
    pub known: Vec<String>,
}

impl JobNumbers {
    /// None yet, of a study with all its jobs, for columns by their `names`.
    ///
    /// # Errors
    /// [`NoNumbers`] of the first name that is no column of numbers.
    pub fn begin(study: &Study, jobs: &[Job], names: &[String]) -> Result<Self, NoNumbers> {
        let mut begun = Self {
            layout: Layout::new(study, jobs),
            names: names.to_vec(),
            numbers: vec![Vec::new(); names.len()],
            failures: BTreeMap::new(),
        };
        match begun.extend(&[], &[]) {
            None => Ok(begun),
            Some(place) => Err(NoNumbers {
                place,
                known: begun.known(),
            }),
        }
    }

    /// Appends the numbers of the next jobs.
    pub fn append(&mut self, jobs: &[Job], records: &[JobRecord]) {
        self.extend(jobs, records);
        let failed = records
            .iter()
            .filter_map(|record| Some((record, record.failure.as_ref()?)));
        self.failures
            .extend(failed.map(|(record, failure)| (record.job, failure.text.clone())));
    }

    /// Appends numbers; the place of the first name that has none, before which it ends.
    fn extend(&mut self, jobs: &[Job], records: &[JobRecord]) -> Option<usize> {
        let wanted = |name: &str| self.names.iter().any(|asked| asked == name);
        let columns = self.layout.some_columns(TableName::Jobs, jobs, records, &wanted);
        self.names.iter().zip(&mut self.numbers).position(|(asked, numbers)| {
            let column = columns.0.iter().find(|(name, _)| name == asked);
            match column.and_then(|(_, cells)| cells.numbers()) {
                Some(of_jobs) => {
                    numbers.extend(of_jobs);
                    false
                }
                None => true,
            }
        })
    }

    /// The columns that hold numbers.
    fn known(&self) -> Vec<String> {
        let columns = self.layout.some_columns(TableName::Jobs, &[], &[], &|_| true);
        let numeric = columns.0.into_iter().filter(|(_, cells)| cells.numbers().is_some());
        numeric.map(|(name, _)| name).collect()
    }
}
