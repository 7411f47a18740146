//! Figures of results: what a paper would draw, as numbers.
//!
//! | module | charter |
//! |---|---|
//! | `marks` | points of a reference that are drawn beside results |
//! | `figure` | a figure as numbers: panels of lines, marks and moments, with units |
//! | `figure_context` | what is known of the jobs before any figure |
//! | `series_group` | jobs that differ in one axis, to be lines of one figure |
//! | `panels` | a group split by speed; captions |
//! | `profiles` | along the bridge: deflected lines, envelopes |
//! | `histories` | against time |
//! | `speeds` | peaks against speed |
//! | `modes` | natural frequencies by shape |
//!
//! Knows which curves belong together, their units and their legends. Does not know how a figure is drawn or where it
//! is written.

mod figure;
mod figure_context;
mod histories;
mod marks;
mod modes;
mod panels;
mod profiles;
mod series_group;
mod speeds;

pub use figure::{Figure, FigureAxis, FigureLine, FigureMoment, FigurePanel, PlottedMark};
pub use marks::{Chart, Origin, ReferenceMark, marks};

use figure_context::FigureContext;
use pontoon_judge::reference::Reference;
use pontoon_plan::input::Refusal;
use pontoon_plan::study_file::Kind;
use pontoon_results::{Results, labels};
use serde::Serialize;

/// Figures of one study.
const MOST_FIGURES: usize = 40;

/// The figures of results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// Name of the study.
    pub study: String,
    /// Name and source of the reference.
    pub reference: Option<String>,
    /// The figures; no two of one name.
    pub figures: Vec<Figure>,
    /// What no figure holds, in words.
    pub left_out: Vec<String>,
}

impl Figures {
    /// The figures of results, with the points of a reference.
    ///
    /// Static studies: deflected lines. Crossings: histories where they were recorded, peaks against speed, envelopes. Modes:
    /// frequencies. A figure is of jobs that differ in one axis alone, or of all jobs where they are few.
    ///
    /// # Errors
    /// [`Refusal`] where no job has results, where the reference belongs to another study, or where it names an axis that the
    /// study does not have.
    pub fn of(results: &Results, reference: Option<&Reference>) -> Result<Self, Refusal> {
        let marks = match reference {
            Some(reference) => {
                reference.study_of(&results.name, &results.place)?;
                marks(results, reference)?
            }
            None => Vec::new(),
        };
        let mut context = FigureContext::new(results, marks);
        if context.rows.is_empty() {
            let found = match results.jobs().rows() {
                0 => "no jobs".to_owned(),
                1 => "one job, which failed".to_owned(),
                failed => format!("{failed} jobs, all of which failed"),
            };
            return Err(Refusal::new(
                &results.place,
                "",
                found,
                "at least one job with results to draw",
            ));
        }
        let mut figures = match results.kind() {
            Kind::Static => profiles::deflected(&mut context),
            Kind::Modes => modes::frequencies(&mut context, reference),
            Kind::Crossing | Kind::Rating => {
                let [of_bridge, of_vehicles] = histories::histories(&mut context);
                let mut figures = of_bridge;
                figures.extend(speeds::speeds(&mut context));
                figures.extend(profiles::envelopes(&mut context));
                // wheels are many: they give way to all else where figures are too many
                figures.extend(of_vehicles);
                figures
            }
        };
        figures.retain(|figure| !figure.is_empty());
        if figures.len() > MOST_FIGURES {
            let names: Vec<&str> = figures[MOST_FIGURES..]
                .iter()
                .map(|figure| figure.name.as_str())
                .collect();
            context.left_out.push(format!(
                "{}: {}",
                labels::counted(names.len(), "figure"),
                names.join(", ")
            ));
            figures.truncate(MOST_FIGURES);
        }
        let mut left_out = context.left_out.clone();
        left_out.extend(figures.iter().flat_map(|figure| figure.left_out.iter().cloned()));
        left_out.extend(undrawn(&context, &figures));
        let mut seen = std::collections::BTreeSet::new();
        left_out.retain(|line| seen.insert(line.clone()));
        distinct(&mut figures);
        Ok(Self {
            study: results.name.clone(),
            reference: reference.map(|reference| format!("{}: {}", reference.name, reference.source)),
            figures,
            left_out,
        })
    }
}

/// Measurements that no figure holds.
fn undrawn(context: &FigureContext<'_>, figures: &[Figure]) -> Vec<String> {
    let drawn = |id: &str| {
        let mut marks = figures
            .iter()
            .flat_map(|figure| &figure.panels)
            .flat_map(|panel| &panel.marks);
        marks.any(|mark| mark.id == id)
    };
    let measured = context
        .marks
        .iter()
        .filter(|mark| mark.origin == Origin::Measured && !drawn(&mark.id));
    measured
        .map(|mark| format!("measured '{}': no figure has its place and conditions", mark.id))
        .collect()
}

/// Gives figures of one name numbers: names that differ in what a file's name cannot hold.
fn distinct(figures: &mut [Figure]) {
    for i in 1..figures.len() {
        let (before, rest) = figures.split_at_mut(i);
        let taken = |name: &str| before.iter().any(|other| other.name.eq_ignore_ascii_case(name));
        let base = rest[0].name.clone();
        let mut number = 2;
        while taken(&rest[0].name) {
            rest[0].name = format!("{base}-{number}");
            number += 1;
        }
    }
}
