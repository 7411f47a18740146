//! Figures for papers: SVG, and PNG of the same SVG, with their captions and the numbers plotted.
//!
//! | module | charter |
//! |---|---|
//! | `page` | a figure laid out: panels in a grid, the legend below |
//! | `panel` | axes, and what is between them |
//! | `legend` | which line is which |
//! | `scale` | ticks |
//! | `style` | colours, dashes, markers |
//! | `pen` | elements of an SVG |
//! | `letters` | the one font, and pixels |
//! | `captions` | the captions' file |
//!
//! Knows paper. Does not know results: [`crate::figures`] has the numbers.

mod captions;
mod legend;
mod letters;
mod page;
mod panel;
mod pen;
mod scale;
mod style;

use crate::figures::Figures;
use letters::{Letters, PixelsError};
use pontoon_journal::place::{Folder, FolderError};
use pontoon_plan::input::Refusal;
use pontoon_results::replaceable;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use thiserror::Error;

/// Why figures were not written.
#[derive(Debug, Error)]
pub enum DrawingError {
    /// The folder holds something else.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A file could not be written.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A figure could not be drawn.
    #[error("{name}: {cause}")]
    Figure {
        /// Its name.
        name: String,
        /// Why.
        cause: PixelsError,
    },
}

/// The file of captions, and that of the numbers plotted.
const CAPTIONS: &str = "figures.md";
const NUMBERS: &str = "figures.json";

/// Writes figures into a folder: of each NAME.svg and NAME.png, of all `figures.md`, their captions, and `figures.json`, the
/// numbers plotted. Each file is replaced whole; what earlier figures left in the folder and these do not is removed; other
/// files are left alone. Returns the names of the files.
///
/// # Errors
/// [`Refusal`] where a file stands under one of these names that is no earlier figure; what the system says of the folder or of
/// a file.
pub fn write(figures: &Figures, folder: &Path) -> Result<Vec<String>, DrawingError> {
    let earlier = of_earlier(folder);
    let letters = Letters::new();
    let numbers = format!("{:#}\n", json!(figures)).into_bytes();
    // the list first: whatever becomes of the process, the folder says what in it is figures
    let mut files = vec![(NUMBERS.to_owned(), numbers)];
    for figure in &figures.figures {
        let error = |cause| DrawingError::Figure {
            name: figure.name.clone(),
            cause,
        };
        let svg = page::svg(figure, &letters).map_err(|cause| error(cause.into()))?;
        let png = letters.png(&svg).map_err(error)?;
        files.push((format!("{}.svg", figure.name), svg.into_bytes()));
        files.push((format!("{}.png", figure.name), png));
    }
    files.push((CAPTIONS.to_owned(), captions::markdown(figures).into_bytes()));
    for (name, _) in &files {
        replaceable(&folder.join(name), "one of earlier figures", |_| earlier.contains(name))?;
    }
    let folder = Folder::create(folder)?;
    for name in earlier.iter().filter(|old| !files.iter().any(|(name, _)| name == *old)) {
        folder.remove(name)?;
    }
    for (name, bytes) in &files {
        folder.write(name, |out| out.write_all(bytes))?;
    }
    files.rotate_left(1);
    Ok(files.into_iter().map(|(name, _)| name).collect())
}

/// The files that earlier figures left in a folder: its `figures.json` names them.
fn of_earlier(folder: &Path) -> Vec<String> {
    let numbers = fs::read(folder.join(NUMBERS)).ok();
    let numbers: Option<Value> = numbers.and_then(|bytes| serde_json::from_slice(&bytes).ok());
    let Some(figures) = numbers.as_ref().and_then(|numbers| numbers["figures"].as_array()) else {
        return Vec::new();
    };
    let names = figures.iter().filter_map(|figure| figure["name"].as_str());
    let pictures = names.flat_map(|name| ["svg", "png"].map(|kind| format!("{name}.{kind}")));
    // a name in that file is no path out of the folder
    let within = pictures.filter(|name| !name.contains(['/', '\\']));
    within.chain([CAPTIONS.to_owned(), NUMBERS.to_owned()]).collect()
}
