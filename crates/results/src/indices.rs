//! Indices of sensitivity of results: of each design of Saltelli or Morris, of each output that is asked for.
//!
//! Knows how the rows of jobs are put back in the order of a design's points, and which groups of points are left out: those
//! with a failed job or an empty cell. Does not know the estimators.

use super::elementary_effects::{MorrisIndex, MorrisOutputs};
use super::registry::{Column, ColumnRole};
use super::resampling::Resampling;
use super::results::Results;
use super::results_error::ResultsError;
use super::sobol_indices::{PairIndex, SaltelliOutputs, SobolIndex};
use super::table::{ColumnKind, TableName};
use pontoon_plan::design::{Block, PointGroups};
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use pontoon_plan::job::PointJobs;
use pontoon_plan::study_file::Study;
use serde::Serialize;

/// Indices of sensitivity of results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indices {
    /// How intervals were found.
    #[serde(flatten)]
    pub resampling: Resampling,
    /// Of each design of Saltelli or Morris, in the order of the study's file.
    pub designs: Vec<DesignIndices>,
}

/// Indices of one design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignIndices {
    /// Where it stands in the study file.
    pub design: String,
    /// Groups of its points: rows of the base sample, or trajectories.
    pub groups: usize,
    /// Points of a group.
    pub points: usize,
    /// Groups with a point whose job failed, which no output has.
    pub failed: usize,
    /// The axes that are drawn.
    pub factors: Vec<String>,
    /// Of each output.
    pub outputs: Vec<OutputIndices>,
}

/// Indices of one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutputIndices {
    /// Its column of the table of jobs.
    pub column: String,
    /// Groups that are left out: a job of them failed, or has no number there.
    pub left_out: usize,
    /// The indices; nothing where too few groups are left or the output is the same everywhere.
    pub indices: Option<FactorIndices>,
}

/// Indices of the factors of a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FactorIndices {
    /// Of a design of Saltelli.
    Sobol {
        /// Of each factor.
        factors: Vec<FactorIndex<SobolIndex>>,
        /// Of each pair of factors, where the design has points for them.
        pairs: Vec<FactorPair>,
    },
    /// Of a design of Morris.
    Morris {
        /// Of each factor.
        factors: Vec<FactorIndex<MorrisIndex>>,
    },
}

/// What is found of an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FactorIndex<T> {
    /// The axis.
    pub axis: String,
    /// What is found.
    #[serde(flatten)]
    pub index: T,
}

/// What is found of two axes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FactorPair {
    /// The axes.
    pub axes: [String; 2],
    /// What is found.
    #[serde(flatten)]
    pub index: PairIndex,
}

impl Indices {
    /// Of results: of the columns of jobs that are asked for, of all measures that hold numbers where none is.
    ///
    /// # Errors
    /// [`ResultsError::Refused`] of a study without such a design, of a column that is none of numbers, of the results of a
    /// part of a study; [`ResultsError::Damaged`] where rows are not those of the points of their study.
    pub fn of(results: &Results, columns: &[String], resampling: Resampling) -> Result<Self, ResultsError> {
        let file = results.place.join(super::files::MANIFEST);
        let documents = &results.documents;
        let study = Study::of_documents(&file, documents.study()?.clone(), documents.bridge()?.clone())?;
        if study.blocks.iter().all(|block| block.groups().is_none()) {
            let refused = Refusal::new(
                &file,
                "design",
                "neither saltelli nor morris",
                "a study with a design of either",
            );
            return Err(refused.because(RefusalKind::Missing).into());
        }
        let columns = columns_of(results, columns)?;
        let rows = rows_of_points(results, &study)?;
        let (mut designs, mut before) = (Vec::new(), 0);
        for block in &study.blocks {
            let of_block = &rows[before..before + block.len()];
            before += block.len();
            if let Some(groups) = block.groups() {
                designs.push(of_design(results, block, groups, of_block, &columns, resampling));
            }
        }
        Ok(Self { resampling, designs })
    }

    /// Whether a job failed that an index needs.
    pub fn has_failed(&self) -> bool {
        self.designs.iter().any(|design| design.failed > 0)
    }
}

/// The columns that are asked for, or all measures that hold numbers.
fn columns_of(results: &Results, asked: &[String]) -> Result<Vec<String>, Refusal> {
    let jobs = results.jobs();
    let registered =
        |name: &&str| Column::of(TableName::Jobs, name).is_some_and(|column| column.role != ColumnRole::Key);
    let known = jobs.names().filter(registered).filter(|name| jobs.is_number(name));
    let known: Vec<String> = known.map(str::to_owned).collect();
    if let Some(other) = asked.iter().find(|name| !known.contains(name)) {
        let file = results.place.join(TableName::Jobs.file());
        return Err(match jobs.has(other) {
            true => {
                let found = FoundValue::value(other.as_str()).which("which is no output of numbers");
                Refusal::new(&file, "--of", found, known.join(", "))
            }
            false => Refusal::unknown(&file, "--of", other, &known),
        });
    }
    if !asked.is_empty() {
        return Ok(asked.to_vec());
    }
    let is_measure = |name: &String| {
        let column = Column::of(TableName::Jobs, name);
        column.is_some_and(|column| column.role == ColumnRole::Measure) && jobs.kind(name) == Some(ColumnKind::Numbers)
    };
    Ok(known.into_iter().filter(is_measure).collect())
}

/// The row of each point of a study, which may be that of an equal one.
fn rows_of_points(results: &Results, study: &Study) -> Result<Vec<usize>, ResultsError> {
    let table = results.jobs();
    let damaged = |found: String| ResultsError::Damaged {
        file: results.place.join(TableName::Jobs.file()),
        found,
    };
    let axes = study.axis_columns();
    let (mut rows, mut jobs) = (Vec::with_capacity(study.points()), 0);
    for job in PointJobs::new(study) {
        let job = job?;
        let Some(row) = results.row_of_job(job.number as u64) else {
            return Err(damaged(format!(
                "no row of job {}, which a point of its study has",
                job.number
            )));
        };
        rows.push(row);
        // the row is that of the first of equal points
        if job.number == jobs {
            jobs += 1;
            let differs = |axis: &&String| {
                let both = job.column(axis).number().zip(table.number(axis, row));
                both.is_some_and(|(of_point, of_row)| of_point != of_row)
            };
            if let Some(axis) = axes.iter().find(differs) {
                let found = format!("a row of job {row} whose {axis} is not that of its point");
                return Err(damaged(found));
            }
        }
    }
    Ok(rows)
}

/// Indices of a design whose points have these rows.
fn of_design(
    results: &Results,
    block: &Block,
    groups: PointGroups,
    rows: &[usize],
    columns: &[String],
    resampling: Resampling,
) -> DesignIndices {
    let factors: Vec<String> = block.factors().iter().map(|axis| axis.name.clone()).collect();
    let (PointGroups::Saltelli { groups: count, .. } | PointGroups::Morris { groups: count, .. }) = groups;
    let points = rows.len() / count;
    let named = |place: usize| factors[place].clone();
    let of_output = |column: &String| {
        let output = |&row: &usize| Some(row).filter(|&row| !results.is_failed(row));
        let outputs = |group: &[usize]| -> Vec<Option<f64>> {
            let rows = group.iter().map(output);
            rows.map(|row| results.jobs().number(column, row?)).collect()
        };
        let (mut left_out, groups_of_rows) = (0, rows.chunks(points));
        let indices = match groups {
            PointGroups::Saltelli { second_order, .. } => {
                let mut all = SaltelliOutputs::new(factors.len(), second_order);
                groups_of_rows.for_each(|group| left_out += usize::from(!all.take(&outputs(group))));
                all.indices(resampling).map(|(of_factors, pairs)| FactorIndices::Sobol {
                    factors: with_names(&factors, of_factors),
                    pairs: pairs
                        .into_iter()
                        .map(|index| FactorPair {
                            axes: index.factors.map(named),
                            index,
                        })
                        .collect(),
                })
            }
            PointGroups::Morris { levels, .. } => {
                let mut all = MorrisOutputs::new(factors.len(), levels);
                for (group, steps) in groups_of_rows.zip(block.trajectories()) {
                    left_out += usize::from(!all.take(&steps, &outputs(group)));
                }
                all.indices(resampling).map(|of_factors| FactorIndices::Morris {
                    factors: with_names(&factors, of_factors),
                })
            }
        };
        OutputIndices {
            column: column.clone(),
            left_out,
            indices,
        }
    };
    let has_failed = |group: &&[usize]| group.iter().any(|&row| results.is_failed(row));
    DesignIndices {
        design: block.key().trim_end_matches(".ranges").to_owned(),
        groups: count,
        points,
        failed: rows.chunks(points).filter(has_failed).count(),
        outputs: columns.iter().map(of_output).collect(),
        factors,
    }
}

fn with_names<T>(names: &[String], found: Vec<T>) -> Vec<FactorIndex<T>> {
    let named = names.iter().zip(found).map(|(name, index)| FactorIndex {
        axis: name.clone(),
        index,
    });
    named.collect()
}
