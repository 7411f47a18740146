//! The designs of a study with their axes read.
//!
//! Knows what makes a design one that can be expanded: names, forms and sizes. Does not know what a point means.

use super::axes::{Axis, JobAxis, Root, Varies, check_apart};
use super::cases::{CaseRun, Cases};
use super::condition::{Conditions, Test};
use super::forms::{AxisMap, Design, Form};
use super::points::{PointSource, count_met, values};
use super::samples::SampleReader;
use super::trajectories::TrajectoryStep;
use super::values::{MOST_POINTS, Values};
use crate::input::{Cell, DocumentPath, FoundValue, Refusal, RefusalKind};
use serde_json::Value;
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// A design with its axes read, or those of its cases that name the same axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Where its axes stand in the study file; of cases the list that they stand in.
    key: String,
    /// Of cases the place of the first in their list.
    first_case: Option<usize>,
    /// Its axes in the order of the file.
    pub axes: Vec<Axis>,
    source: PointSource,
    tests: Vec<Test>,
    /// Number of its points that meet the conditions.
    count: usize,
    /// The axis along which a rating searches, which is none of its own.
    pub searched: Option<Axis>,
}

/// One point: a value for each axis of its block.
#[derive(Debug, Clone)]
pub struct DesignPoint<'a> {
    /// The block it is of.
    pub block: &'a Block,
    /// Its number among the points of the block, those included that conditions leave out.
    number: usize,
    values: Vec<Cell<'a>>,
    /// The value of the axis that is searched.
    searched: Option<Cell<'a>>,
}

impl<'a> DesignPoint<'a> {
    /// Where its axes stand in the study file.
    pub fn key(&self) -> Cow<'a, str> {
        match self.block.first_case {
            Some(first) => format!("{}[{}]", self.block.key, first + self.number).into(),
            None => self.block.key.as_str().into(),
        }
    }

    /// The axes with the point's values.
    pub fn values(&self) -> impl Iterator<Item = (&'a Axis, &Cell<'a>)> {
        let searched = self.block.searched.iter().zip(&self.searched);
        self.block.axes.iter().zip(&self.values).chain(searched)
    }

    /// Where an axis stands in the study file.
    pub fn path_of(&self, name: &str) -> String {
        match &self.block.searched {
            Some(axis) if axis.name == name => "find.between".to_owned(),
            _ => format!("{}.{name}", self.key()),
        }
    }

    /// The point at a value of the axis that is searched.
    #[must_use]
    pub fn at(&self, value: f64) -> Self {
        Self {
            searched: Some(value.into()),
            ..self.clone()
        }
    }

    /// Its number among the points of its block, and its values, to make it again.
    pub fn owned(&self) -> (usize, Vec<Cell<'static>>) {
        (
            self.number,
            self.values.iter().map(|value| value.clone().owned()).collect(),
        )
    }

    /// The value of an axis that sets a number or word of the job.
    pub fn of_job(&self, of: JobAxis) -> Option<&Cell<'a>> {
        let mut values = self.values();
        values
            .find(|(axis, _)| axis.varies == Varies::Job(of))
            .map(|(_, value)| value)
    }

    /// The axes that set a value of a document, by name and path, with the point's values.
    pub fn of_document(&self, root: Root) -> impl Iterator<Item = (&'a str, &'a DocumentPath, &Cell<'a>)> {
        self.values().filter_map(move |(axis, value)| match &axis.varies {
            Varies::Path(of, path) if *of == root => Some((axis.name.as_str(), path, value)),
            _ => None,
        })
    }
}

impl Block {
    /// Reads the designs of a study; `known` are the names to suggest for a name that is not known.
    ///
    /// # Errors
    /// [`Refusal`] of a design of no form or of several, an empty axis, an unknown name, a form that is none, more points
    /// than a study may have, conditions under which no point is left.
    pub fn read(file: &Path, designs: &[Design], known: &[String]) -> Result<Vec<Self>, Refusal> {
        if designs.is_empty() {
            let allowed = format!("at least one design: {}", Form::NAMES.join(", "));
            return Err(Refusal::new(file, "design", "an empty list", allowed));
        }
        let reader = DesignReader { file, known };
        let read = |(d, design)| reader.design(&format!("design[{d}]"), design);
        let read = (0..).zip(designs).map(read).collect::<Result<Vec<Vec<Self>>, _>>()?;
        // before conditions, which are tried on every point
        check_size(file, read.iter().flatten())?;
        let mut blocks = Vec::new();
        for (d, (design, of_design)) in designs.iter().zip(read).enumerate() {
            blocks.extend(reader.met(&format!("design[{d}].where"), &design.conditions, of_design)?);
        }
        Ok(blocks)
    }

    fn new(file: &Path, key: String, axes: Vec<Axis>, source: PointSource) -> Result<Self, Refusal> {
        check_apart(file, &key, &axes)?;
        let count = source.count().unwrap_or(usize::MAX);
        Ok(Self {
            key,
            first_case: None,
            axes,
            source,
            tests: Vec::new(),
            count,
            searched: None,
        })
    }

    /// The zip with other values of its first axes: of each axis a list.
    ///
    /// # Errors
    /// [`Refusal`] of a block that is no zip of so many axes or has conditions, of an empty list, and of lists of unequal
    /// lengths or more points than a study may have.
    pub fn with_lists(&self, file: &Path, lists: &[Vec<f64>]) -> Result<Self, Refusal> {
        let mut values = match &self.source {
            PointSource::Zip(values) if lists.len() <= values.len() && self.tests.is_empty() => values.clone(),
            _ => {
                let allowed = format!("a zip of at least {} axes, without conditions", lists.len());
                return Err(Refusal::new(file, &self.key, "another design", allowed));
            }
        };
        for ((axis, own), list) in self.axes.iter().zip(&mut values).zip(lists) {
            let cells = list.iter().map(|number| Cell::Number(*number));
            *own = Values::listed(file, &format!("{}.{}", self.key, axis.name), cells)?;
        }
        let block = Self::new(file, self.key.clone(), self.axes.clone(), PointSource::Zip(values))?;
        block.check_even(file)?;
        check_size(file, std::iter::once(&block))?;
        Ok(Self {
            searched: self.searched.clone(),
            ..block
        })
    }

    /// Refuses axes of a zip that have unequal numbers of values.
    fn check_even(&self, file: &Path) -> Result<(), Refusal> {
        let PointSource::Zip(values) = &self.source else {
            return Ok(());
        };
        let mut several = self.axes.iter().zip(values).filter(|(_, values)| values.len() > 1);
        let Some((first, of_first)) = several.next() else {
            return Ok(());
        };
        match several.find(|(_, values)| values.len() != of_first.len()) {
            None => Ok(()),
            Some((axis, values)) => {
                let found = format!("{} values", values.len());
                let allowed = format!("{} values, as many as {} has, or one", of_first.len(), first.name);
                Err(Refusal::new(
                    file,
                    format!("{}.{}", self.key, axis.name),
                    found,
                    allowed,
                ))
            }
        }
    }

    /// A point made again from its number and values.
    pub fn point<'a>(&'a self, number: usize, values: &'a [Cell<'a>]) -> DesignPoint<'a> {
        DesignPoint {
            block: self,
            number,
            values: values.to_vec(),
            searched: None,
        }
    }

    /// Where its axes stand in the study file; of cases the list that they stand in.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// How its points belong together; nothing where no indices can be made of them.
    pub fn groups(&self) -> Option<PointGroups> {
        match &self.source {
            PointSource::Saltelli(sample) => Some(PointGroups::Saltelli {
                groups: sample.count,
                second_order: sample.second_order,
            }),
            PointSource::Morris(sample) => Some(PointGroups::Morris {
                groups: sample.trajectories,
                levels: sample.levels,
            }),
            _ => None,
        }
    }

    /// The axes that are drawn, in the order of the file; none of a block whose axes are listed.
    pub fn factors(&self) -> Vec<&Axis> {
        let drawn = self.source.drawn();
        let factors = self.axes.iter().zip(drawn).filter(|(_, drawn)| drawn.is_range());
        factors.map(|(axis, _)| axis).collect()
    }

    /// The steps of each trajectory of Morris: point `i + 1` of a trajectory is point `i` after step `i`.
    pub fn trajectories(&self) -> impl Iterator<Item = Vec<TrajectoryStep>> {
        let walks = self.source.trajectories(&self.axes);
        walks.into_iter().flatten().map(|walk| walk.steps)
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is no point; never so for a block that was read.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The points in order: of a grid the first axis changes slowest. They are made one by one, so a long block costs
    /// nothing but, of a Latin hypercube, four bytes a point and range while it lasts.
    pub fn points(&self) -> impl Iterator<Item = DesignPoint<'_>> {
        let values = values(&self.axes, &self.source, &self.tests);
        values.map(move |(number, values)| DesignPoint {
            block: self,
            number,
            values,
            searched: None,
        })
    }
}

/// How the points of a block belong together where indices of sensitivity can be made of them, group after group. A factor
/// is an axis that is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointGroups {
    /// Of Saltelli: a group is a row of the base sample with the points made of it.
    Saltelli {
        /// Number of groups.
        groups: usize,
        /// Whether there are points for indices of pairs.
        second_order: bool,
    },
    /// Of Morris: a group is a trajectory.
    Morris {
        /// Number of groups.
        groups: usize,
        /// Levels of the grid.
        levels: usize,
    },
}

impl PointGroups {
    /// The form's key, and what a group is called.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Saltelli { .. } => ("saltelli", "a row of the base sample"),
            Self::Morris { .. } => ("morris", "a trajectory"),
        }
    }
}

/// Refuses designs that together have more points than a study may have.
fn check_size<'a>(file: &Path, blocks: impl Iterator<Item = &'a Block> + Clone) -> Result<(), Refusal> {
    let points = blocks
        .clone()
        .try_fold(0_usize, |sum, block| sum.checked_add(block.source.count()?));
    if points.is_some_and(|points| points <= MOST_POINTS) {
        return Ok(());
    }
    let size: f64 = blocks.map(|block| block.source.size()).sum();
    let found = if size < 1e15 {
        format!("{size} points")
    } else {
        format!("{size:.1e} points")
    };
    Err(Refusal::new(
        file,
        "design",
        found,
        format!("at most {MOST_POINTS} points"),
    ))
}

/// Reads designs of one file.
struct DesignReader<'a> {
    file: &'a Path,
    /// Names to suggest.
    known: &'a [String],
}

impl DesignReader<'_> {
    fn refuse<T>(
        &self,
        key: impl Into<String>,
        found: impl Into<FoundValue>,
        allowed: impl Into<String>,
    ) -> Result<T, Refusal> {
        Err(Refusal::new(self.file, key, found, allowed))
    }

    /// The blocks of a design, without its conditions.
    fn design(&self, key: &str, design: &Design) -> Result<Vec<Block>, Refusal> {
        let form = match design.form() {
            Ok(form) => form,
            Err(found) => {
                let (found, kind) = match found.as_slice() {
                    [] => ("none of them".to_owned(), RefusalKind::Missing),
                    several => (several.join(" and "), RefusalKind::Misplaced),
                };
                let allowed = format!("exactly one of {}", Form::NAMES.join(", "));
                return Err(Refusal::new(self.file, key, found, allowed).because(kind));
            }
        };
        match form {
            Form::Grid(map) => Ok(vec![self.listed(format!("{key}.grid"), map, PointSource::Grid)?]),
            Form::Zip(map) => {
                let block = self.listed(format!("{key}.zip"), map, PointSource::Zip)?;
                block.check_even(self.file)?;
                Ok(vec![block])
            }
            Form::Cases(cases) => self.cases(&format!("{key}.cases"), cases),
            Form::LatinHypercube(spec) => {
                self.drawn(&format!("{key}.latin_hypercube"), spec, SampleReader::latin_hypercube)
            }
            Form::Sobol(spec) => self.drawn(&format!("{key}.sobol"), spec, SampleReader::sobol),
            Form::Saltelli(spec) => self.drawn(&format!("{key}.saltelli"), spec, SampleReader::saltelli),
            Form::Morris(spec) => self.drawn(&format!("{key}.morris"), spec, SampleReader::morris),
        }
    }

    /// The block of a sample at `key`, by what reads it.
    fn drawn<'r, S>(
        &'r self,
        key: &str,
        spec: &S,
        read: impl FnOnce(&SampleReader<'r>, &str, &S) -> Result<(Vec<Axis>, PointSource), Refusal>,
    ) -> Result<Vec<Block>, Refusal> {
        let samples = SampleReader {
            file: self.file,
            known: self.known,
        };
        let (axes, source) = read(&samples, key, spec)?;
        Ok(vec![Block::new(self.file, format!("{key}.ranges"), axes, source)?])
    }

    /// A block of axes with their values.
    fn listed(&self, key: String, map: &AxisMap, source: fn(Vec<Values>) -> PointSource) -> Result<Block, Refusal> {
        let axis = |(name, written): (&String, &Value)| {
            let at = format!("{key}.{name}");
            let axis = Axis::read(self.file, &at, name, self.known)?;
            Ok((axis, Values::read(self.file, &at, written)?))
        };
        let read = map.0.iter().map(axis).collect::<Result<Vec<_>, _>>()?;
        let (axes, values) = read.into_iter().unzip();
        Block::new(self.file, key, axes, source(values))
    }

    fn cases(&self, key: &str, cases: &Cases) -> Result<Vec<Block>, Refusal> {
        if cases.runs.is_empty() {
            return self.refuse(key, "an empty list", "at least one case");
        }
        cases.runs.iter().map(|run| self.run_of_cases(key, run)).collect()
    }

    fn run_of_cases(&self, key: &str, run: &CaseRun) -> Result<Block, Refusal> {
        let first = format!("{key}[{}]", run.first);
        let axis = |name: &String| Axis::read(self.file, &format!("{first}.{name}"), name, self.known);
        let axes = run.names.iter().map(axis).collect::<Result<Vec<_>, _>>()?;
        let source = PointSource::Cases(Arc::clone(&run.columns), run.count);
        let block = Block::new(self.file, first, axes, source)?;
        Ok(Block {
            key: key.to_owned(),
            first_case: Some(run.first),
            ..block
        })
    }

    /// What conditions leave of the blocks of a design; `key` is where the conditions stand.
    fn met(&self, key: &str, conditions: &Conditions, blocks: Vec<Block>) -> Result<Vec<Block>, Refusal> {
        if conditions.is_empty() {
            return Ok(blocks);
        }
        if let Some(groups) = blocks.iter().find_map(Block::groups) {
            let (form, whole) = groups.words();
            let allowed = format!("none: {whole} is of use only with all of its points");
            let refused = Refusal::new(self.file, key, format!("conditions beside {form}"), allowed);
            return Err(refused.because(RefusalKind::Misplaced));
        }
        let mut axes: Vec<Axis> = Vec::new();
        for axis in blocks.iter().flat_map(|block| &block.axes) {
            if !axes.contains(axis) {
                axes.push(axis.clone());
            }
        }
        conditions.check(self.file, key, &axes)?;
        let all: usize = blocks.iter().map(Block::len).sum();
        let mut left = Vec::new();
        for mut block in blocks {
            block.tests = conditions.on(&block.axes);
            block.count = count_met(&block.axes, &block.source, &block.tests);
            left.extend(Some(block).filter(|block| !block.is_empty()));
        }
        if left.is_empty() {
            let allowed = match all {
                1 => "conditions that the one point meets".to_owned(),
                all => format!("conditions that at least one of the {all} points meets"),
            };
            return self.refuse(key, "conditions under which no point is left", allowed);
        }
        Ok(left)
    }
}
