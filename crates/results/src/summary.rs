//! The summary: peaks against speed, a row a speed for each combination of the other axes; of a study of modes a row a mode.
//!
//! Knows the order of rows and how a cell is written. Keeps of a job what its row holds beside the axes, which the job has.
//! Does not know terminals.

use super::exceedance::{Exceedance, ExceedanceCounts};
use crate::JobRecord;
use crate::registry::{Column, ColumnSource};
use pontoon_plan::input::Cell;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::{Kind, Study};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::{self, Write};

/// The summary of a study. Its rows are made as they are asked for: a million of them are no matter.
#[derive(Debug, Clone)]
pub struct SummaryTable<'a> {
    columns: Vec<String>,
    axes: Vec<String>,
    jobs: &'a [Job],
    outcomes: Outcomes,
    /// Places in `outcomes`, in the order of rows.
    order: Vec<usize>,
    exceedances: Vec<Exceedance>,
    doubtful: DoubtfulRatings,
}

/// Ratings that need a second look.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DoubtfulRatings {
    /// Those of which a value beyond the first failure passes.
    pub not_monotone: usize,
    /// Those that a ten-thousandth of the load moves by more than 2 %.
    pub chaotic: usize,
}

/// What the rows hold beside the axes, in the order of jobs.
#[derive(Debug, Clone)]
enum Outcomes {
    /// Columns, and their numbers of each job, one job after the other; not a number where there is none.
    Peaks(Vec<&'static Column>, Vec<f64>),
    /// Of each mode its job, number, frequency `[Hz]` and shape.
    Modes(Vec<(usize, usize, f64, String)>),
}

const MODES: [&str; 3] = ["number", "frequency_hz", "shape"];
/// The axis that rows follow within a combination of the others.
const AGAINST: &str = "speed_m_s";

/// The summary under way.
#[derive(Debug)]
pub(super) struct SummaryLines<'a> {
    axes: Vec<String>,
    jobs: &'a [Job],
    outcomes: Outcomes,
    exceedances: ExceedanceCounts,
    doubtful: DoubtfulRatings,
    taken: usize,
}

impl<'a> SummaryLines<'a> {
    /// Nothing yet of a study with all its jobs.
    pub(super) fn new(study: &Study, jobs: &'a [Job]) -> Self {
        Self {
            axes: study.axis_columns(),
            jobs,
            outcomes: match study.analysis.kind() {
                Kind::Modes => Outcomes::Modes(Vec::new()),
                kind => {
                    let columns: Vec<_> = Column::of_summary(kind, study.limits.is_some()).collect();
                    let room = jobs.len() * columns.len();
                    Outcomes::Peaks(columns, Vec::with_capacity(room))
                }
            },
            exceedances: ExceedanceCounts::new(&study.document.value()),
            doubtful: DoubtfulRatings::default(),
            taken: 0,
        }
    }

    /// Takes what it needs of the records of the next jobs.
    pub(super) fn append(&mut self, records: &[JobRecord]) {
        match &mut self.outcomes {
            Outcomes::Peaks(columns, peaks) => {
                let of = |record, column: &Column| match column.source {
                    ColumnSource::Job(of) => of(record).number().unwrap_or(f64::NAN),
                    _ => f64::NAN,
                };
                for record in records {
                    peaks.extend(columns.iter().map(|column| of(record, column)));
                }
            }
            Outcomes::Modes(modes) => {
                for (job, record) in (self.taken..).zip(records) {
                    let of_job = record.modes.iter();
                    modes.extend(of_job.map(|m| (job, m.number, m.frequency_hz, m.shape.clone())));
                }
            }
        }
        for row in records.iter().flat_map(|record| &record.limits) {
            self.exceedances.take(&row.limit, row.utilisation);
        }
        for summary in records.iter().map(|record| &record.summary) {
            self.doubtful.not_monotone += usize::from(summary.monotone == Some(false));
            self.doubtful.chaotic += usize::from(summary.chaotic == Some(true));
        }
        self.taken += records.len();
    }

    /// The summary of a run: combinations of the other axes in the order of their first job, speeds increasing; modes as
    /// they are. A job that failed has empty peaks.
    pub(super) fn summary(self) -> SummaryTable<'a> {
        let (axes, order, more): (_, _, Vec<&str>) = match &self.outcomes {
            Outcomes::Peaks(columns, peaks) => {
                let (against, others): (Vec<String>, Vec<String>) =
                    self.axes.into_iter().partition(|name| name == AGAINST);
                let columns: Vec<&str> = columns.iter().map(|column| column.name).collect();
                let order = against_speed(&self.jobs[..peaks.len() / columns.len()], &others, &against);
                ([others, against].concat(), order, columns)
            }
            Outcomes::Modes(modes) => (self.axes, (0..modes.len()).collect(), MODES.to_vec()),
        };
        let more = more.iter().map(|name| (*name).to_owned());
        SummaryTable {
            columns: axes.iter().cloned().chain(more).collect(),
            axes,
            jobs: self.jobs,
            outcomes: self.outcomes,
            order,
            exceedances: self.exceedances.exceedances(),
            doubtful: self.doubtful,
        }
    }
}

/// Places of jobs: combinations of `others` in the order of their first job, `against` increasing.
fn against_speed(jobs: &[Job], others: &[String], against: &[String]) -> Vec<usize> {
    // half a hash stands for the combination, which may be long and of which there may be as many as jobs
    let mut groups: HashMap<[u8; 16], u32> = HashMap::new();
    let mut keys: Vec<(u32, f64)> = Vec::with_capacity(jobs.len());
    let mut text = String::new();
    for job in jobs {
        text.clear();
        for name in others {
            // to a string, which takes whatever is written
            let _ = write!(text, "{},", job.column(name));
        }
        let next = u32::try_from(groups.len()).unwrap_or(u32::MAX);
        let mut hash = [0; 16];
        hash.copy_from_slice(&blake3::hash(text.as_bytes()).as_bytes()[..16]);
        let group = *groups.entry(hash).or_insert(next);
        let speed = against.first().and_then(|name| job.column(name).number());
        keys.push((group, speed.unwrap_or_default()));
    }
    drop(groups);
    let mut order: Vec<usize> = (0..jobs.len()).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (keys[a], keys[b]);
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    order
}

impl SummaryTable<'_> {
    /// Names of the columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// How often each limit is exceeded; nothing where no limits were stated or no point was drawn at random.
    pub fn exceedances(&self) -> &[Exceedance] {
        &self.exceedances
    }

    /// Ratings that need a second look.
    pub fn doubtful(&self) -> DoubtfulRatings {
        self.doubtful
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The rows.
    pub fn rows(&self) -> impl Iterator<Item = Vec<Cell<'_>>> {
        self.order.iter().map(|&place| self.row(place))
    }

    fn row(&self, place: usize) -> Vec<Cell<'_>> {
        let (job, outcomes): (usize, Vec<Cell<'_>>) = match &self.outcomes {
            Outcomes::Peaks(columns, peaks) => {
                let count = columns.len();
                let own = &peaks[place * count..(place + 1) * count];
                let cell = |x: &f64| Some(*x).filter(|x| !x.is_nan()).into();
                (place, own.iter().map(cell).collect())
            }
            Outcomes::Modes(modes) => {
                let (job, number, frequency_hz, shape) = &modes[place];
                (
                    *job,
                    vec![(*number).into(), (*frequency_hz).into(), shape.as_str().into()],
                )
            }
        };
        let axes = self.axes.iter().map(|name| self.jobs[job].column(name));
        axes.chain(outcomes).collect()
    }

    /// Writes the table as CSV.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_csv(&self, to: impl Write) -> io::Result<()> {
        let mut to = csv::Writer::from_writer(to);
        to.write_record(&self.columns)?;
        for row in self.rows() {
            to.write_record(row.iter().map(Cell::text))?;
        }
        to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn csv_leaves_nulls_empty_and_quotes_lists() {
        let mut lines = csv::Writer::from_writer(Vec::new());
        for row in [
            [json!("linear"), json!([-1.4, 1.4]), json!(0.25)],
            [json!("linear"), json!([1]), json!(null)],
        ] {
            lines
                .write_record(row.iter().map(|value| Cell::of(value).text()))
                .unwrap();
        }
        assert_eq!(
            String::from_utf8(lines.into_inner().unwrap()).unwrap(),
            "linear,\"[-1.4,1.4]\",0.25\nlinear,[1],\n"
        );
    }
}
