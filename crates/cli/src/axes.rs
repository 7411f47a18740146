//! The axes of a study for people: which values, or from where to where and how many.
//!
//! Knows designs as points. Does not know what the points lead to.

use pontoon_plan::input::Cell;
use pontoon_plan::study_file::Study;
use pontoon_results::labels;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Values that are told one by one.
const MOST_TOLD: usize = 6;

/// What is seen of an axis.
struct AxisSummary {
    name: String,
    /// The first of its values.
    first: Vec<Cell<'static>>,
    /// A number for each value.
    known: HashSet<u64>,
    /// The least and the largest, where all are numbers.
    range: Option<(f64, f64)>,
}

/// Each axis and its values, in the order of their first point.
pub(crate) fn of(study: &Study) -> Vec<(String, String)> {
    let mut axes: Vec<AxisSummary> = Vec::new();
    for block in &study.blocks {
        let places: Vec<usize> = block.axes.iter().map(|axis| place(&mut axes, &axis.name)).collect();
        for point in block.points() {
            places
                .iter()
                .zip(point.values())
                .for_each(|(&i, (_, value))| axes[i].see(value));
        }
    }
    axes.iter().map(|values| (values.name.clone(), values.told())).collect()
}

fn place(axes: &mut Vec<AxisSummary>, name: &str) -> usize {
    axes.iter().position(|values| values.name == name).unwrap_or_else(|| {
        axes.push(AxisSummary {
            name: name.to_owned(),
            first: Vec::new(),
            known: HashSet::new(),
            range: Some((f64::INFINITY, f64::NEG_INFINITY)),
        });
        axes.len() - 1
    })
}

impl AxisSummary {
    fn see(&mut self, value: &Cell<'_>) {
        let number = value.number();
        let mut hasher = DefaultHasher::new();
        value.hash(&mut hasher);
        if !self.known.insert(hasher.finish()) {
            return;
        }
        if self.first.len() < MOST_TOLD {
            self.first.push(value.owned());
        }
        let range = self.range.zip(number);
        self.range = range.map(|((from, to), x)| (from.min(x), to.max(x)));
    }

    fn told(&self) -> String {
        let mut first = self.first.clone();
        let left = self.known.len() - first.len();
        match self.range {
            Some((from, to)) if left > 0 => {
                let ends = labels::listed_apart(&[from, to].map(Cell::written).each_ref());
                return format!("{}, {} values", ends.join(" to "), self.known.len());
            }
            Some(_) => first.sort_by(|a, b| f64::total_cmp(&number(a), &number(b))),
            None => {}
        }
        let first = labels::listed_apart(&first.iter().collect::<Vec<_>>()).join(", ");
        if left > 0 {
            format!("{first}, and {left} more")
        } else {
            first
        }
    }
}

fn number(value: &Cell<'_>) -> f64 {
    value.number().unwrap_or_default()
}
