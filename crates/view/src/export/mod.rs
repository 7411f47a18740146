//! What a bridge does as grids for ParaView: mode shapes, a static case, a crossing.
//!
//! | file | charter |
//! |---|---|
//! | `subject` | what is exported: a bridge file or a job of results, and what is asked of it |
//! | `ready` | the bridge and its mesh made ready, a job's solver |
//! | `pictures` | a state of the bridge as grids: mesh, joints, vehicle |
//! | `stresses` | stresses as arrays of the mesh, and their envelope |
//! | `series` | grids over time as numbered files and their collection |
//! | `modes`, `loaded` | the parts: mode shapes; static case and crossing |
//! | `vtk` | the words of the format; here, beside the other files of results, for the program itself writes words to people alone |
//! | `whole` | a folder that is there whole or not at all |
//!
//! Knows what is written and in which units. Does not know how a solver works, and prints nothing.
//!
//! A crossing is solved again by the reference solver on the job's own model, whatever solver its study ran: it has all dofs
//! of that model at every step, and the super-element's own recovery leads from them to every node without a further
//! approximation. The operator's modes and residuals would give the same within what the operator promises (0.5 % in
//! deflection), and not the whole field. Lengths of mesh and displacement and stresses are in single
//! precision, forces in double.

mod loaded;
mod modes;
mod pictures;
mod ready;
mod series;
mod stresses;
mod subject;
mod vtk;
mod whole;

use pontoon_core::analysis::AnalysisError;
use pontoon_core::bridge::BridgeError;
use pontoon_journal::place::FolderError;
use pontoon_plan::input::Refusal;
use pontoon_results::ResultsError;
use serde::Serialize;
use serde_json::{Value, json};
use std::path::Path;
use subject::Stresses;
use subject::Subject;
use thiserror::Error;
use whole::WholeFolder;

/// What is asked of a source.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// How many modes, 0: none; absent: what the study asks for, else 20.
    pub count: Option<usize>,
    /// Whether the modes are those of the bridge on its supports.
    pub supports: bool,
    /// A static case.
    pub load: Option<LoadRequest>,
    /// Number of the job, of results; absent: the one with the largest deflection.
    pub job: Option<usize>,
    /// Time steps from one instant of a crossing to the next; absent: as many as give about 20 instants a second.
    pub every: Option<usize>,
    /// Whether stresses of the static case and the crossing are written too.
    pub stresses: bool,
}

/// A static case that is asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LoadRequest {
    /// Weight of the vehicle `[N]`.
    pub load_n: f64,
    /// Place of its centre `[m]`.
    pub load_x_m: Option<f64>,
    /// Position of its centre, in place of `load_x_m`.
    pub load_position: Option<usize>,
    /// Whether both trusses of a connector are at work at once.
    pub linear: bool,
    /// Tension gap; absent: the bridge's `[m]`.
    pub gap_tension_m: Option<f64>,
    /// Compression gap; absent: the bridge's `[m]`.
    pub gap_compression_m: Option<f64>,
}

/// Why nothing was exported.
#[derive(Debug, Error)]
pub enum ExportError {
    /// What was asked for was refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The results cannot be read.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The bridge could not be built.
    #[error(transparent)]
    Bridge(#[from] BridgeError),
    /// It gave no answer.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// A file could not be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// What was exported.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exported {
    /// The parts in the order of their names.
    pub parts: Vec<Part>,
    /// Files of the folder.
    pub files: usize,
}

/// A series that was written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Part {
    /// The file to open.
    pub file: String,
    /// What it shows.
    pub shows: String,
    /// Its instants or modes.
    pub instants: usize,
    /// Points of its first grid.
    pub points: usize,
    /// Cells of its first grid.
    pub cells: usize,
    /// Largest deflection of the positions in it `[m]`, of a static case and a crossing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_deflection_m: Option<f64>,
}

/// Writes what is asked of `source`, a bridge file or a folder of results, as VTK XML into the folder `to`, which is there whole
/// afterwards or as it was before. `note` is told what is about to be written.
///
/// # Errors
/// [`ExportError`].
pub fn export(source: &Path, to: &Path, request: &Request, note: &dyn Fn(&str)) -> Result<Exported, ExportError> {
    let subject = Subject::read(source, request)?;
    let mut folder = WholeFolder::begin(to)?;
    let mut parts = Vec::new();
    if let Some(crossing) = &subject.crossing {
        parts.extend(loaded::crossing(&subject, crossing, &mut folder, note)?);
    }
    if let Some(case) = &subject.statics {
        parts.extend(loaded::statics(&subject, case, &mut folder)?);
    }
    if let Some(wanted) = &subject.modes {
        parts.push(modes::write(&subject, wanted, &mut folder, note)?);
    }
    parts.sort_by(|a, b| a.file.cmp(&b.file));
    let files = folder.place(contents(&subject, &parts))?;
    Ok(Exported { parts, files })
}

/// What the folder says of itself.
fn contents(subject: &Subject, parts: &[Part]) -> Value {
    let numbered = |words: &[&str]| -> Value {
        let entry = |(number, word): (usize, &&str)| (number.to_string(), Value::from(*word));
        Value::Object(words.iter().enumerate().map(entry).collect())
    };
    let mut contents = json!({
        "program_version": pontoon_results::VERSION,
        "source": subject.words,
        "parts": parts,
        "arrays": {
            "displacement": "from the unloaded bridge, x along, y across, z up [m]; of modes scaled so that the largest component is 1",
            "plate": numbered(&pictures::plates()),
            "thickness_m": "of the plate; 0 of a beam",
            "module": "from 1, from the left end",
            "link": numbered(&pictures::LINKS),
            "state": numbered(&pictures::STATES),
            "force_n": "along the bridge, tension positive [N]",
            "force_on_left_n": "of a connector or hinge on the module left of it [N]",
            "elongation_m": "of a connector; 0 of a hinge [m]",
            "joint": "its position number, 2 to modules",
            "contact_force_n": "of a point of the vehicle on the deck, weight and inertia, downward [N]",
            "on_bridge": numbered(&["off the bridge", "on the bridge"]),
        },
    });
    if subject.stresses == Stresses::Wanted {
        contents["stresses"] = stresses::words();
    }
    contents
}

/// Most files and bytes of a series; ParaView reads every file's head before it shows anything.
const MOST_FILES: usize = 30_000;
const MOST_BYTES: u64 = 20_000_000_000;

/// Says how large a series will be, and refuses one that is larger than anybody can want.
fn check_size(
    subject: &Subject,
    (key, found): (&str, String),
    [files, bytes]: [u64; 2],
    note: &dyn Fn(&str),
) -> Result<(), ExportError> {
    let size = format!("{files} files of {:.1} MB in all", bytes as f64 / 1e6);
    if files > MOST_FILES as u64 || bytes > MOST_BYTES {
        let allowed = format!("at most {MOST_FILES} files and {} GB", MOST_BYTES / 1_000_000_000);
        return Err(Refusal::new(&subject.source, key, format!("{found}: {size}"), allowed).into());
    }
    note(&format!("{found}: {size}"));
    Ok(())
}
