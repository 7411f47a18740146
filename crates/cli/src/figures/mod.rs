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
//! Knows paper. Does not know results: `pontoon_study::figures` has the numbers.

mod captions;
mod legend;
mod letters;
mod page;
mod panel;
mod pen;
mod scale;
mod style;

use anyhow::{Context, Result};
use letters::Letters;
use pontoon_study::figures::Figures;
use pontoon_study::tables::Folder;
use serde_json::json;
use std::path::Path;

/// The file of captions, and that of the numbers plotted.
const CAPTIONS: &str = "figures.md";
const NUMBERS: &str = "figures.json";

/// Writes figures into a folder: of each NAME.svg and NAME.png, of all `figures.md`, their captions, and `figures.json`, the
/// numbers plotted. Each file is replaced whole; other files of the folder are left alone. Returns the names of the files.
///
/// # Errors
/// What the system says of the folder or of a file.
pub fn write(figures: &Figures, folder: &Path) -> Result<Vec<String>> {
    let folder = Folder::create(folder)?;
    let letters = Letters::new();
    let mut files = Vec::new();
    let mut file = |name: String, bytes: &[u8]| {
        folder.write(&name, |out| out.write_all(bytes))?;
        files.push(name);
        Ok::<(), anyhow::Error>(())
    };
    for figure in &figures.figures {
        let svg = page::svg(figure, &letters).with_context(|| figure.name.clone())?;
        let png = letters.png(&svg).with_context(|| figure.name.clone())?;
        file(format!("{}.svg", figure.name), svg.as_bytes())?;
        file(format!("{}.png", figure.name), &png)?;
    }
    file(CAPTIONS.to_owned(), captions::markdown(figures).as_bytes())?;
    file(NUMBERS.to_owned(), format!("{:#}\n", json!(figures)).as_bytes())?;
    Ok(files)
}
