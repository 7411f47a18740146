//! Mode shapes: a file a mode, each with its frequency and name.
//!
//! Knows how a shape is scaled. Does not know how it is found.

use super::pictures::Pictures;
use super::ready::Ready;
use super::series::Series;
use super::subject::{ModesWanted, Stresses, Subject};
use super::vtk::{Array, Counter, VtkValues};
use super::whole::WholeFolder;
use super::{ExportError, Part, check_size};
use pontoon_core::analysis::modes::{largest_made_one, modes};
use pontoon_core::bridge::{Ends, Model};
use pontoon_results::labels;

/// Largest component of a shape's displacement.
const LARGEST: f64 = 1.0;

/// Writes the lowest modes with the linear connection, as `pontoon modes` numbers and names them.
///
/// # Errors
/// [`ExportError`].
pub(super) fn write(
    subject: &Subject,
    wanted: &ModesWanted,
    folder: &mut WholeFolder,
    note: &dyn Fn(&str),
) -> Result<Part, ExportError> {
    let ends = if wanted.supports { Ends::Supported } else { Ends::Free };
    let ready = Ready::new(&subject.design, wanted.model, ends, Stresses::Unwanted)?;
    let pictures = Pictures::of(&ready);
    let count = wanted.count.min(ready.bridge.dofs());
    let mut size = Counter::default();
    let at_rest = vec![[0.0; 3]; ready.meshed.nodes_m.len()];
    // counting cannot fail
    let _ = pictures
        .mesh(&at_rest, None, fields(1, 1.0, "vertical bending 1"))
        .write(&mut size);
    let files = count as u64;
    check_size(
        subject,
        ("--count", labels::counted(count, "mode")),
        [files, files * size.0],
        note,
    )?;
    let (found, pairs) = modes(&ready.bridge, count)?;
    let shows = format!(
        "mode shapes of the {} model {}, largest component {LARGEST}",
        match wanted.model {
            Model::Full => "full",
            Model::SuperElement => "super-element",
        },
        if wanted.supports {
            "on its supports"
        } else {
            "floating free"
        },
    );
    let mut series = Series::new("modes", shows, count);
    for (j, mode) in found.iter().enumerate() {
        let shape: Vec<f64> = pairs.shapes.col(j).iter().copied().collect();
        let displacement = largest_made_one(ready.meshed.displacement_m(&shape));
        let grid = pictures.mesh(&displacement, None, fields(j + 1, mode.frequency_hz, &mode.name));
        let name = format!("{}, {:.4} Hz", mode.name, mode.frequency_hz);
        series.write(folder, (j + 1) as f64, &name, &grid)?;
    }
    series.finish(folder, None)
}

fn fields(number: usize, frequency_hz: f64, shape: &str) -> Vec<Array> {
    vec![
        Array::new("number", VtkValues::I32(vec![number as i32])),
        Array::new("frequency_hz", VtkValues::F64(vec![frequency_hz])),
        Array::new("largest_component", VtkValues::F64(vec![LARGEST])),
        Array::text("shape", shape),
    ]
}
