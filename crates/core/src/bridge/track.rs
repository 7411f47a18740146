//! The track: how a point of the deck moves with the dofs along the wheels' lines.
//!
//! Knows bilinear deck influence and its slope. Does not know weights or time.

use super::Bridge;
use crate::fem::SparseRow;

/// The deck's z along the mesh lines that some wheel needs, numbered as columns 0, 1, ...
#[derive(Debug, Clone)]
pub struct Track {
    /// Dof of the bridge behind each column.
    pub dofs: Vec<usize>,
    modules: usize,
    module_length_m: f64,
    lines_x: Vec<f64>,
    /// For each place across asked for: the two neighbouring used lines and the second one's weight.
    places: Vec<(f64, usize, usize, f64)>,
    used: usize,
}

impl Track {
    /// The track for wheels at the places across `y_m` [m].
    pub fn new(bridge: &Bridge, y_m: impl IntoIterator<Item = f64>) -> Self {
        let lines = &bridge.lines_y;
        let mut places: Vec<(f64, usize, usize, f64)> = Vec::new();
        for y in y_m {
            if places.iter().any(|p| p.0 == y) {
                continue;
            }
            let cell = lines.windows(2).position(|w| y <= w[1]).unwrap_or(lines.len() - 2);
            let weight = ((y - lines[cell]) / (lines[cell + 1] - lines[cell])).clamp(0.0, 1.0);
            // a wheel on a line needs that line alone
            let (a, b) = if weight < 1e-9 {
                (cell, cell)
            } else if weight > 1.0 - 1e-9 {
                (cell + 1, cell + 1)
            } else {
                (cell, cell + 1)
            };
            places.push((y, a, b, if a == b { 0.0 } else { weight }));
        }
        let mut used: Vec<usize> = places.iter().flat_map(|p| [p.1, p.2]).collect();
        used.sort_unstable();
        used.dedup();
        for place in &mut places {
            place.1 = used.binary_search(&place.1).unwrap_or(0);
            place.2 = used.binary_search(&place.2).unwrap_or(0);
        }
        let dofs = bridge
            .deck_z
            .iter()
            .flatten()
            .flat_map(|line| used.iter().map(|&iy| line[iy]))
            .collect();
        Self {
            dofs,
            modules: bridge.deck_z.len(),
            module_length_m: bridge.design().module.length_m,
            lines_x: bridge.lines_x.clone(),
            places,
            used: used.len(),
        }
    }

    /// The deck's z at `(x, y)` in terms of the columns; none off the bridge. `y` is one of the places asked for.
    pub fn row(&self, x_m: f64, y_m: f64) -> Option<SparseRow> {
        self.interpolate(x_m, y_m, |s, _| (1.0 - s, s))
    }

    /// Its derivative along x [1/m].
    pub fn slope_row(&self, x_m: f64, y_m: f64) -> Option<SparseRow> {
        self.interpolate(x_m, y_m, |_, length| (-1.0 / length, 1.0 / length))
    }

    fn interpolate(&self, x_m: f64, y_m: f64, along: impl Fn(f64, f64) -> (f64, f64)) -> Option<SparseRow> {
        let end = self.modules as f64 * self.module_length_m;
        if !(0.0..=end).contains(&x_m) {
            return None;
        }
        let module = ((x_m / self.module_length_m) as usize).min(self.modules - 1);
        let local = x_m - module as f64 * self.module_length_m;
        let lines = &self.lines_x;
        let cell = lines.windows(2).position(|w| local <= w[1]).unwrap_or(lines.len() - 2);
        let length = lines[cell + 1] - lines[cell];
        let (a, b) = along((local - lines[cell]) / length, length);
        let &(_, left, right, weight) = self.places.iter().find(|p| p.0 == y_m)?;
        let column = |ix: usize, line: usize| (module * lines.len() + ix) * self.used + line;
        let mut entries = Vec::with_capacity(4);
        for (ix, c) in [(cell, a), (cell + 1, b)] {
            entries.push((column(ix, left), c * (1.0 - weight)));
            if right != left {
                entries.push((column(ix, right), c * weight));
            }
        }
        Some(SparseRow::from_entries(entries))
    }
}
