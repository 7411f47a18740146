//! What a page tells of results: aggregates of all jobs, rows of some, crossings to be played, shapes, verdicts.
//!
//! Knows what is worth showing and how much of it fits a page. Does not know how it is drawn: the form of the data is in
//! `crates/view/page/README.md`.
//!
//! | module | charter |
//! |---|---|
//! | `open` | what a folder holds: whole tables, or what a journal has so far |
//! | `settings` | what a study was run with, in words |
//! | `axes` | axes and their bins |
//! | `cells` | all jobs in aggregate |
//! | `against` | the largest of each measure against one axis, for a page without its script |
//! | `headline` | the largest of each measure; why jobs failed |
//! | `rows` | jobs that are listed, their profiles, the envelope of all |
//! | `histories` | recorded histories, thinned |
//! | `playback` | crossings solved once more, to be played |
//! | `shapes` | mode shapes |
//! | `verdicts` | a comparison |
//! | `packed` | numbers as bytes |

mod against;
mod axes;
mod cells;
mod headline;
mod histories;
mod open;
mod packed;
mod playback;
mod rows;
mod settings;
mod shapes;
mod verdicts;

pub use against::AgainstTable;
pub use axes::{AxisKind, PageAxis};
pub use cells::{PageCells, PageMeasure};
pub use headline::{FailureNote, PageCard};
pub use histories::HistoryLine;
pub use open::OpenedResults;
pub use packed::{Packed, Scaled};
pub use playback::{AxlePatch, Play, PlayedVehicle};
pub use rows::{ColumnData, JobRows, PageEnvelope, PageProfile, RowColumn, WordList};
pub use shapes::{ModeLine, ModeSet, ModeShape};
pub use verdicts::{Tone, VerdictLine, Verdicts};

use crate::asked;
use crate::class_table::ClassTable;
use crate::figures::{Chart, ReferenceMark};
use pontoon_core::bridge::{BankSpec, BridgeDesign, Direction, Toward};
use pontoon_core::connector::ConnectorLaw;
use pontoon_core::module::Outline;
use pontoon_judge::compare::Comparison;
use pontoon_plan::input::Cell;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::{Kind, Study};
use pontoon_results::{Exceedance, Results, ResultsError, Seen, Table, TableName};
use pontoon_study::run::Cache;
use serde::Serialize;
use std::collections::HashSet;

/// A label and what it says.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Item {
    /// What it is of.
    pub label: String,
    /// What it is.
    pub value: String,
}

impl Item {
    /// A label with its value.
    pub fn new(label: impl Into<String>, value: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            value: value.into(),
        }
    }
}

/// How much a report takes.
#[derive(Debug)]
pub struct ReportSetting {
    /// Crossings that can be played, at most.
    pub plays: usize,
    /// Mode shapes.
    pub modes: usize,
    /// Where operators are kept from run to run.
    pub cache: Option<Cache>,
    /// Commit of the program's sources, where it was built from one.
    pub commit: Option<String>,
}

/// The program that made a page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Program {
    /// Its version.
    pub version: &'static str,
    /// Commit of its sources.
    pub commit: Option<String>,
}

/// The study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyNote {
    /// Its name.
    pub name: String,
    /// What it asks.
    pub question: Option<String>,
    /// What kind it is.
    pub kind: Kind,
    /// What it was run with.
    pub settings: Vec<Item>,
}

impl StudyNote {
    fn new(results: &Results, study: Option<&Study>) -> Self {
        Self {
            name: results.name.clone(),
            question: study.and_then(|study| study.question.clone()),
            kind: results.kind(),
            settings: study.map(settings::settings).unwrap_or_default(),
        }
    }
}

/// The bridge's measures, of the first job.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BridgeNote {
    /// Number of modules.
    pub modules: usize,
    /// Length of a module `[m]`, of the shortest where they are not alike.
    pub module_length_m: f64,
    /// Its breadth `[m]`.
    pub breadth_m: f64,
    /// Its depth `[m]`, of the deepest where they are not alike.
    pub depth_m: f64,
    /// Heights of each module's bottom at its left and right end, then of its deck, above the bottom of the bridge's left end
    /// `[m]`, where modules are not alike or slope.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub module_heights_m: Vec<[f64; 4]>,
    /// How deep it floats `[m]`, where the bridge says so.
    pub draft_m: Option<f64>,
    /// How much the river has risen `[m]`.
    #[serde(skip_serializing_if = "is_zero")]
    pub water_level_m: f64,
    /// Places of the positions `[m]`.
    pub position_x_m: Vec<f64>,
    /// Numbers of the joints.
    pub joints: Vec<usize>,
    /// Those whose couplings are open: no connector pulls.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub open_joints: Vec<usize>,
    /// Those whose connectors are lost: none pulls or pushes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lost_joints: Vec<usize>,
    /// Banks that press upward.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub banks: Vec<BankNote>,
}

// serde asks for a reference
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

/// A bank that presses upward, as a page draws it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BankNote {
    /// Its number, from 0.
    pub bank: usize,
    /// Its position.
    pub position: usize,
    /// How far under the bridge it stands `[m]`.
    pub clearance_m: f64,
}

impl BridgeNote {
    fn of(job: &Job) -> Self {
        let design = &job.shared.bridge.design;
        let (depth_m, draft_m) = design.deepest_m();
        Self {
            modules: design.modules,
            module_length_m: design.shortest_module_m(),
            breadth_m: design.module.breadth_m,
            depth_m,
            module_heights_m: heights_m(design),
            draft_m,
            water_level_m: design.risen_m(),
            position_x_m: (1..=design.positions())
                .map(|position| design.position_x_m(position))
                .collect(),
            joints: (2..=design.modules).collect(),
            open_joints: joints_whose(job, |[pulls, pushes]| !pulls && pushes),
            lost_joints: joints_whose(job, |[pulls, pushes]| !pulls && !pushes),
            banks: design
                .banks
                .iter()
                .enumerate()
                .filter_map(|of| bank_note(design, of))
                .collect(),
        }
    }
}

/// Heights of each module's corners above the bottom of the bridge's left end `[m]`: the bottom's, then the deck's; none where all
/// modules are one box.
fn heights_m(design: &BridgeDesign) -> Vec<[f64; 4]> {
    let of_module = |(base_m, outline): (f64, Outline)| {
        let ([a, b], [c, d]) = (outline.bottom_m, outline.deck_m);
        [a, b, c, d].map(|height_m| base_m + height_m)
    };
    let heights: Vec<_> = design
        .bases_m()
        .into_iter()
        .zip(design.outlines())
        .map(of_module)
        .collect();
    let box_m = [0.0, 0.0, design.module.depth_m, design.module.depth_m];
    if heights.iter().all(|of| *of == box_m) {
        return Vec::new();
    }
    heights
}

/// A bank as a page draws it; none of one that does not press upward.
fn bank_note(design: &BridgeDesign, (bank, spec): (usize, &BankSpec)) -> Option<BankNote> {
    let upward = spec.direction == Direction::Z && spec.toward != Some(Toward::Minus);
    upward.then(|| BankNote {
        bank,
        position: spec.position(design.modules),
        clearance_m: spec.clearance_m,
    })
}

/// The joints of a job of whose connectors it holds whether any pulls and whether any pushes.
fn joints_whose(job: &Job, holds: impl Fn([bool; 2]) -> bool) -> Vec<usize> {
    let (design, own) = (&job.shared.bridge.design, job.own_laws());
    let places = design.connectors.y_m.len();
    let works = |place: usize| match own.iter().find(|(of, _)| *of == place) {
        None => [true; 2],
        Some((_, ConnectorLaw::Linear { stiffness_n_m, .. })) => [*stiffness_n_m > 0.0; 2],
        Some((_, ConnectorLaw::Gaps { tension, compression })) => [tension, compression].map(|t| t.stiffness_n_m > 0.0),
    };
    let of_joint = |joint: usize| {
        let each = ((joint - 2) * places..(joint - 1) * places).map(works);
        each.fold([false; 2], |[a, b], [c, d]| [a || c, b || d])
    };
    (2..=design.modules).filter(|joint| holds(of_joint(*joint))).collect()
}

/// A point of a reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageMark {
    /// The point.
    #[serde(flatten)]
    pub mark: ReferenceMark,
    /// The measure whose chart it is drawn in.
    pub measure: String,
}

impl From<ReferenceMark> for PageMark {
    fn from(mark: ReferenceMark) -> Self {
        let measure = mark.column.clone();
        Self { mark, measure }
    }
}

/// How many jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct JobCounts {
    /// Of the study.
    pub total: usize,
    /// That did not fail.
    pub ok: usize,
    /// That failed.
    pub failed: usize,
    /// That no row is there of.
    pub missing: usize,
}

impl JobCounts {
    fn new(results: &Results, missing: usize) -> Self {
        let rows = results.jobs().rows();
        let failed = (0..rows).filter(|&row| results.is_failed(row)).count();
        Self {
            total: rows + missing,
            ok: rows - failed,
            failed,
            missing,
        }
    }
}

/// All that a page carries.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Form of the data.
    pub format: u32,
    /// Who made it.
    pub program: Program,
    /// Of which study.
    pub study: StudyNote,
    /// The bridge; null where this program cannot read the study.
    pub bridge: Option<BridgeNote>,
    /// How many jobs.
    pub jobs: JobCounts,
    /// What a reader must know.
    pub notes: Vec<String>,
    /// The axes.
    pub axes: Vec<PageAxis>,
    /// The measures.
    pub measures: Vec<PageMeasure>,
    /// All jobs in aggregate.
    pub cells: PageCells,
    /// The largest of each measure against one axis, which stands in the page's markup.
    #[serde(skip)]
    pub against: AgainstTable,
    /// The largest of each measure.
    pub cards: Vec<PageCard>,
    /// Which vehicle may cross how, where the study asks that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub classes: Option<ClassTable>,
    /// Which share of jobs exceeds each limit, where points were drawn at random.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub exceedance: Vec<Exceedance>,
    /// Why jobs failed.
    pub failures: Vec<FailureNote>,
    /// Points of an experiment, and what checks expect.
    pub marks: Vec<PageMark>,
    /// Largest values along the bridge.
    pub envelope: Option<PageEnvelope>,
    /// Jobs that are listed.
    pub rows: JobRows,
    /// Recorded histories.
    pub histories: Vec<HistoryLine>,
    /// Crossings to be played.
    pub plays: Vec<Play>,
    /// Mode shapes.
    pub modes: Vec<ModeSet>,
    /// A study of modes as a table.
    pub mode_table: Vec<ModeLine>,
    /// The results held against a reference.
    pub verdicts: Option<Verdicts>,
    /// Where the numbers come from.
    pub provenance: Vec<Item>,
}

/// The number of a row's job as a page carries it.
fn job(results: &Results, row: usize) -> u32 {
    u32::try_from(results.job_of_row(row)).unwrap_or(u32::MAX)
}

impl Report {
    /// What there is to tell of results, held against a reference where there is a comparison. Solves some crossings once
    /// more on the current pool, so that they can be played.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`] where a table cannot be scanned.
    pub fn new(
        mut found: OpenedResults,
        compared: Option<&Comparison>,
        marks: Vec<ReferenceMark>,
        setting: &ReportSetting,
    ) -> Result<Self, ResultsError> {
        let all = found.jobs();
        let OpenedResults {
            results,
            study,
            missing,
            mut notes,
            provenance,
        } = found;
        let jobs = results.jobs();
        let names = axes_shown(&results);
        let (axes, of_words) = axes_of(jobs, &names, &mut notes);
        let row_label = |row: usize| headline::axes_in_words(jobs, &of_words, row);
        let measures = cells::measures(jobs, study.as_ref());
        let chosen = rows::chosen(&results, &measures);
        let (mut rows, envelope) = JobRows::new(&results, &names, &measures, &chosen, &mut notes)?;
        for column in &mut rows.columns {
            column.unit = asked::searched_unit(study.as_ref(), &column.name).unwrap_or(column.unit);
        }
        let wanted: HashSet<u32> = chosen.0.iter().map(|&row| job(&results, row)).collect();
        let (histories, recorded) = histories::histories(&results, &wanted, &row_label)?;
        if histories.len() < recorded {
            let shown = histories.len();
            notes.push(format!("{shown} of {recorded} recorded histories are shown."));
        }
        let played = match &study {
            Some(study) if !all.is_empty() => {
                let of = (measures.as_slice(), chosen.0.as_slice());
                playback::plays(study, &all, &results, of, setting.plays, setting.cache.as_ref())
            }
            _ => playback::Played::default(),
        };
        notes.extend(played.notes);
        let (modes, without) = shapes::mode_sets(&all, &results, &row_label, setting.modes);
        notes.extend(without);
        let (failures, causes) = headline::failures(&results);
        if failures.len() < causes {
            notes.push(format!("{} of {causes} causes of failures are listed.", failures.len()));
        }
        notes.extend(undrawn(&marks, jobs));
        Ok(Self {
            format: 1,
            program: Program {
                version: pontoon_results::VERSION,
                commit: setting.commit.clone(),
            },
            study: StudyNote::new(&results, study.as_ref()),
            bridge: all.first().map(BridgeNote::of),
            jobs: JobCounts::new(&results, missing),
            cells: PageCells::new(&results, &axes, &measures),
            against: AgainstTable::new(&results, &axes, &measures),
            classes: ClassTable::of(&results),
            exceedance: match results.documents.study() {
                Ok(study) => Exceedance::of(&results, &study.value())?,
                Err(_) => Vec::new(),
            },
            cards: headline::cards(&results, &measures, study.as_ref(), &row_label),
            failures,
            marks: marks.into_iter().map(PageMark::from).collect(),
            envelope,
            rows,
            histories,
            plays: played.plays,
            modes,
            mode_table: shapes::mode_table(&results, &row_label),
            verdicts: compared.map(Verdicts::new),
            provenance,
            notes,
            axes,
            measures,
        })
    }
}

/// The axes of results, without the load's place where its position says that.
fn axes_shown(results: &Results) -> Vec<String> {
    let jobs = results.jobs();
    let cells = |name: &str| {
        (0..jobs.rows())
            .map(move |row| jobs.cell(name, row))
            .collect::<Vec<_>>()
    };
    let mut names = results.axes();
    if Seen::of(cells("load_position")).is_whole() {
        names.retain(|name| name != "load_x_m");
    }
    names
}

/// The axes with their bins, and the names of those that say which job it is: those that vary, or all where none does. A note
/// tells where bins hold several values.
fn axes_of(jobs: &Table, names: &[String], notes: &mut Vec<String>) -> (Vec<PageAxis>, Vec<String>) {
    let cells = |name: &String| {
        (0..jobs.rows())
            .map(|row| jobs.cell(name, row))
            .collect::<Vec<Cell<'_>>>()
    };
    let mut axes: Vec<PageAxis> = names.iter().map(|name| PageAxis::new(name, &cells(name))).collect();
    let varying = axes.iter().filter(|axis| !axis.constant);
    let varying: Vec<String> = varying.map(|axis| axis.name.clone()).collect();
    if cells::coarsen(&mut axes, jobs.rows()) {
        notes.push(format!(
            "All {} jobs in aggregate: neighbouring values of some axes are put together, and of each range the largest and smallest are shown.",
            jobs.rows()
        ));
    }
    let of_words = if varying.is_empty() { names.to_vec() } else { varying };
    (axes, of_words)
}

/// What is to be said of points that no chart shows: those of one position or joint against speed, as the charts show the
/// largest of the bridge, and those of no job.
fn undrawn(marks: &[ReferenceMark], jobs: &Table) -> Vec<String> {
    let ids = |list: Vec<&ReferenceMark>| {
        let mut ids: Vec<&str> = list.iter().map(|mark| mark.id.as_str()).collect();
        ids.dedup();
        ids.join(", ")
    };
    let alone = |mark: &&ReferenceMark| mark.chart == Chart::Speed && mark.table != TableName::Jobs;
    let nobodys = |mark: &&ReferenceMark| !alone(mark) && !(0..jobs.rows()).any(|row| mark.belongs_to(jobs, row));
    let note_of =
        |list: Vec<&ReferenceMark>, why: &str| (!list.is_empty()).then(|| format!("Not drawn, {why}: {}.", ids(list)));
    let of_one = note_of(
        marks.iter().filter(alone).collect(),
        "as charts against speed show the largest of the bridge",
    );
    let of_none = note_of(marks.iter().filter(nobodys).collect(), "as no job has their axes");
    of_one.into_iter().chain(of_none).collect()
}
