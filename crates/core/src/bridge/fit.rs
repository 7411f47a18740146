//! Whether a module's grid serves a bridge's design.
//!
//! Knows that no hinge, connector or end may be dropped for want of a line. Does not know what is done with the lines.

use super::BridgeDesign;
use crate::input::{InvalidInput, SAME_PLACE_M, bound};
use crate::module::Grid;

/// Refuses a grid that does not span the design's module, from 0 to its length and half its breadth to either side, or has
/// no line along where the wet part begins or ends or no line across at a hinge or a connector.
pub(super) fn check_fit(design: &BridgeDesign, grid: &Grid) -> Result<(), InvalidInput> {
    let (length, half) = (design.module.length_m, 0.5 * design.module.breadth_m);
    for (key, lines, from, to) in [("grid.x", &grid.x, 0.0, length), ("grid.y", &grid.y, -half, half)] {
        let ends = (lines.first().copied(), lines.last().copied());
        let fits = |end: Option<f64>, place: f64| end.is_some_and(|end| (end - place).abs() <= SAME_PLACE_M);
        if !(fits(ends.0, from) && fits(ends.1, to)) {
            let found = lines.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
            return Err(InvalidInput::new(
                key,
                found,
                format!("lines from {} to {}", bound(from), bound(to)),
            ));
        }
    }
    for (key, place) in [("wet_from_m", design.wet_from_m), ("wet_to_m", design.wet_to_m)] {
        if let Some(x_m) = place.filter(|&x_m| grid.x_line(x_m).is_none()) {
            let allowed = "the place of a line along of the module's mesh";
            return Err(InvalidInput::new(key, x_m, allowed));
        }
    }
    let banks = design.banks.iter().enumerate();
    let banks = banks.map(|(i, bank)| (format!("banks[{i}].y_m"), design.bank_places_y_m(bank)));
    let joints = [
        ("hinges.y_m".to_owned(), design.hinge_lines_y_m()),
        ("connectors.y_m".to_owned(), design.connectors.y_m.clone()),
    ];
    for (key, places) in joints.into_iter().chain(banks) {
        if let Some(i) = places.iter().position(|&y| grid.y_line(y).is_none()) {
            let allowed = "the place of a line across of the module's mesh";
            return Err(InvalidInput::new(format!("{key}[{i}]"), places[i], allowed));
        }
    }
    Ok(())
}
