//! The designs of a study with their axes read.
//!
//! Knows what makes a design one that can be expanded: names, forms and sizes. Does not know what a point means.

use super::axes::{Axis, AxisValues, JobAxis, NamedAxis, Root, Varies, check_apart};
use super::cases::{CaseRun, Cases};
use super::condition::{Conditions, Test};
use super::forms::{AxisMap, Design, Form, SampleSpec};
use super::points::{PointSource, RandomSample, SampledAxis, count_met, values};
use super::sampling::SobolPoints;
use super::values::{MOST_POINTS, Values, numbers};
use crate::input::{Cell, DocumentPath, FoundValue, Refusal, RefusalKind};
use serde_json::Value;
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// Most parts of all ranges of a Latin hypercube, whose orders take four bytes a part.
const MOST_PARTS: usize = 100_000_000;

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

    /// A point made again from its number and values.
    pub fn point<'a>(&'a self, number: usize, values: &'a [Cell<'a>]) -> DesignPoint<'a> {
        DesignPoint {
            block: self,
            number,
            values: values.to_vec(),
            searched: None,
        }
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
                self.check_even(&block)?;
                Ok(vec![block])
            }
            Form::Cases(cases) => self.cases(&format!("{key}.cases"), cases),
            Form::LatinHypercube(spec) => {
                let key = format!("{key}.latin_hypercube");
                let (axes, sample) = self.sample(&key, spec)?;
                let ranges = sample.drawn.iter().filter(|drawn| drawn.is_range()).count();
                if sample.count > MOST_PARTS / ranges {
                    let found = format!("{} points of {ranges} ranges", sample.count);
                    let allowed = format!("at most {} points of so many ranges", MOST_PARTS / ranges);
                    return self.refuse(format!("{key}.count"), found, allowed);
                }
                let key = format!("{key}.ranges");
                Ok(vec![Block::new(
                    self.file,
                    key,
                    axes,
                    PointSource::LatinHypercube(sample),
                )?])
            }
            Form::Sobol(spec) => {
                let (axes, sample) = self.sample(&format!("{key}.sobol"), spec)?;
                let key = format!("{key}.sobol.ranges");
                let dimensions = sample.drawn.iter().filter(|drawn| drawn.is_range()).count();
                if dimensions > SobolPoints::MOST_DIMENSIONS {
                    let allowed = format!("at most {} ranges", SobolPoints::MOST_DIMENSIONS);
                    return self.refuse(key, format!("{dimensions} ranges"), allowed);
                }
                Ok(vec![Block::new(self.file, key, axes, PointSource::Sobol(sample))?])
            }
        }
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

    /// Refuses axes of a zip that have unequal numbers of values.
    fn check_even(&self, block: &Block) -> Result<(), Refusal> {
        let PointSource::Zip(values) = &block.source else {
            return Ok(());
        };
        let mut several = block.axes.iter().zip(values).filter(|(_, values)| values.len() > 1);
        let Some((first, of_first)) = several.next() else {
            return Ok(());
        };
        match several.find(|(_, values)| values.len() != of_first.len()) {
            None => Ok(()),
            Some((axis, values)) => {
                let found = format!("{} values", values.len());
                let allowed = format!("{} values, as many as {} has, or one", of_first.len(), first.name);
                self.refuse(format!("{}.{}", block.key, axis.name), found, allowed)
            }
        }
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

    /// The axes of a sample and what they are drawn from; `key` is where its count stands.
    fn sample(&self, key: &str, spec: &SampleSpec) -> Result<(Vec<Axis>, RandomSample), Refusal> {
        if !(1..=MOST_POINTS).contains(&spec.count) {
            let allowed = format!("a whole number from 1 to {MOST_POINTS}");
            return self.refuse(format!("{key}.count"), spec.count, allowed);
        }
        let key = format!("{key}.ranges");
        let axis = |(name, written): (&String, &Value)| {
            let at = format!("{key}.{name}");
            let axis = Axis::read(self.file, &at, name, self.known)?;
            Ok((axis, self.drawn(&at, name, written)?))
        };
        let read = spec.ranges.0.iter().map(axis).collect::<Result<Vec<_>, _>>()?;
        let (axes, drawn): (_, Vec<SampledAxis>) = read.into_iter().unzip();
        if !drawn.iter().any(SampledAxis::is_range) {
            let refused = Refusal::new(
                self.file,
                key,
                "no range",
                "at least one axis with a range [from, to], whole or values",
            );
            return Err(refused.because(RefusalKind::Missing));
        }
        let sample = RandomSample {
            count: spec.count,
            seed: spec.seed,
            drawn,
        };
        Ok((axes, sample))
    }

    fn drawn(&self, key: &str, name: &str, written: &Value) -> Result<SampledAxis, Refusal> {
        let allowed = "[from, to], two numbers with from below to, {\"whole\": [from, to]}, {\"values\": [...]}, or one number or word";
        let counts = || matches!(NamedAxis::of(name).map(|axis| axis.values), Some(AxisValues::Counts));
        match written {
            Value::Number(_) | Value::String(_) | Value::Bool(_) => {
                Ok(SampledAxis::Constant(Cell::from(written).canonical()))
            }
            Value::Object(map) if map.len() == 1 => match map.iter().next() {
                Some((form, ends)) if form == "whole" => self.whole(&format!("{key}.whole"), ends),
                Some((form, Value::Array(list))) if form == "values" && !list.is_empty() => {
                    Ok(SampledAxis::OneOf(list.iter().map(Cell::from).collect()))
                }
                Some((form, list)) if form == "values" => {
                    self.refuse(format!("{key}.values"), list, "a list of at least one value")
                }
                Some((form, _)) => {
                    let known = ["whole", "values"].map(str::to_owned);
                    Err(Refusal::unknown_key(self.file, format!("{key}.{form}"), form, &known))
                }
                None => self.refuse(key, written, allowed),
            },
            Value::Array(_) if counts() => self.whole(key, written),
            _ if name == "connection" => self.refuse(key, written, "linear or nonlinear, the same for all points"),
            Value::Array(ends) => match (
                ends.as_slice(),
                ends.iter().map(Value::as_f64).collect::<Vec<_>>().as_slice(),
            ) {
                ([_, _], &[Some(from), Some(to)]) if from < to && (to - from).is_finite() => {
                    Ok(SampledAxis::Range(from, to))
                }
                ([_, _], &[Some(from), Some(to)]) if from < to => self.refuse(
                    key,
                    format!("from {from:e} to {to:e}"),
                    "ends that are not so far apart",
                ),
                _ => self.refuse(key, written, allowed),
            },
            _ => self.refuse(key, written, allowed),
        }
    }

    /// The whole numbers of `[from, to]`, both included.
    fn whole(&self, key: &str, ends: &Value) -> Result<SampledAxis, Refusal> {
        // beyond these, numbers of a file are no longer each a number of their own
        const MOST: f64 = 9e15;
        match numbers(ends) {
            Some([from, to]) if from < to && [from, to].iter().all(|end| end.fract() == 0.0 && end.abs() <= MOST) => {
                Ok(SampledAxis::Whole(from as i64, to as i64))
            }
            _ => self.refuse(key, ends, "[from, to], two whole numbers with from below to"),
        }
    }

    /// What conditions leave of the blocks of a design; `key` is where the conditions stand.
    fn met(&self, key: &str, conditions: &Conditions, blocks: Vec<Block>) -> Result<Vec<Block>, Refusal> {
        if conditions.is_empty() {
            return Ok(blocks);
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
