//! Grids over time as numbered files and their collection.
//!
//! Knows names. Does not know what a grid shows.

use super::vtk::{VtkGrid, VtkStep, write_collection};
use super::whole::WholeFolder;
use super::{ExportError, Part};
use std::io::Write;

/// A series under way.
#[derive(Debug)]
pub(super) struct Series {
    name: &'static str,
    shows: String,
    digits: usize,
    steps: Vec<VtkStep>,
    size: [usize; 2],
}

impl Series {
    /// A series of a name, of at most `most` grids.
    pub(super) fn new(name: &'static str, shows: impl Into<String>, most: usize) -> Self {
        Self {
            name,
            shows: shows.into(),
            digits: most.to_string().len().max(3),
            steps: Vec::new(),
            size: [0, 0],
        }
    }

    /// Writes the next grid, of a time `[s]` or a number.
    ///
    /// # Errors
    /// [`ExportError::Folder`].
    pub(super) fn write(
        &mut self,
        folder: &mut WholeFolder,
        time: f64,
        name: &str,
        grid: &VtkGrid,
    ) -> Result<(), ExportError> {
        if self.steps.is_empty() {
            self.size = [grid.points(), grid.cells()];
        }
        let (number, digits) = (self.steps.len() + 1, self.digits);
        let file = format!("{}-{number:0digits$}.vtu", self.name);
        folder.write(&file, |out: &mut dyn Write| grid.write(out))?;
        self.steps.push(VtkStep {
            time,
            name: name.to_owned(),
            file,
        });
        Ok(())
    }

    /// Writes the collection: the file to open.
    ///
    /// # Errors
    /// [`ExportError::Folder`].
    pub(super) fn finish(self, folder: &mut WholeFolder, peak_deflection_m: Option<f64>) -> Result<Part, ExportError> {
        let file = format!("{}.pvd", self.name);
        let remark = format!(" pontoon {}: {} ", pontoon_results::VERSION, self.shows);
        folder.write(&file, |out| write_collection(&self.steps, &remark, out))?;
        Ok(Part {
            file,
            shows: self.shows,
            instants: self.steps.len(),
            points: self.size[0],
            cells: self.size[1],
            peak_deflection_m,
        })
    }
}
