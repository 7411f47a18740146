//! The track: how a point of the deck moves with the deck's nodes.
//!
//! Knows bilinear deck influence and its slope. Does not know weights or time.

use super::Bridge;
use super::module_place::ModulePlace;
use crate::fem::SparseRow;

/// The deck's nodes as columns, line after line across: column `line * stations + station`, stations from left to right,
/// both sides of a joint.
#[derive(Debug, Clone)]
pub struct Track {
    /// Dof of the bridge behind each column: the node's z.
    dofs: Vec<usize>,
    modules: Vec<TrackModule>,
    /// Length of the modules where all have one `[m]`.
    common_length_m: Option<f64>,
    length_m: f64,
    stations: usize,
    lines_y: Vec<f64>,
}

/// The stations of a module.
#[derive(Debug, Clone)]
struct TrackModule {
    /// Place of its left end, and its length `[m]`.
    left_m: f64,
    length_m: f64,
    /// The first of its stations.
    first: usize,
    /// Places of its stations from its left end `[m]`.
    lines_x: Vec<f64>,
}

impl Track {
    /// The track of a bridge.
    pub fn new(bridge: &Bridge) -> Self {
        let lines_y = bridge.lines_y.clone();
        let stations = || bridge.deck_z.iter().flatten();
        let dofs = (0..lines_y.len())
            .flat_map(|line| stations().map(move |across| across[line]))
            .collect();
        let mut stations = 0;
        let module = |of: &ModulePlace| {
            stations += of.lines_x.len();
            TrackModule {
                left_m: of.left_m,
                length_m: of.length_m,
                first: stations - of.lines_x.len(),
                lines_x: of.lines_x.clone(),
            }
        };
        let modules: Vec<TrackModule> = bridge.modules.iter().map(module).collect();
        let common_m = modules[0].length_m;
        let alike = modules
            .iter()
            .all(|module| module.length_m.to_bits() == common_m.to_bits());
        Self {
            dofs,
            modules,
            common_length_m: alike.then_some(common_m),
            length_m: bridge.design().length_m(),
            stations,
            lines_y,
        }
    }

    /// Length of the bridge `[m]`.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Number of lines across.
    pub fn lines(&self) -> usize {
        self.lines_y.len()
    }

    /// Columns of a line.
    pub(crate) fn stations(&self) -> usize {
        self.stations
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.dofs.len()
    }

    /// Dof of the bridge behind a column.
    #[inline]
    pub fn dof(&self, column: usize) -> usize {
        self.dofs[column]
    }

    /// The deck's z at `(x, y)` in terms of the columns; none off the bridge.
    pub fn row(&self, x_m: f64, y_m: f64) -> Option<SparseRow> {
        self.cell(x_m).map(|cell| self.row_in(cell, y_m))
    }

    /// The deck's z at a place in a cell and at y.
    pub(crate) fn row_in(&self, cell: DeckCell, y_m: f64) -> SparseRow {
        self.on_lines(cell.station, y_m, (1.0 - cell.fraction, cell.fraction))
    }

    /// Its derivative along x `[1/m]`; none off the bridge.
    pub(crate) fn slope_row(&self, x_m: f64, y_m: f64) -> Option<SparseRow> {
        self.cell(x_m).map(|cell| self.slope_row_in(cell, y_m))
    }

    /// That derivative in a cell and at y.
    pub(crate) fn slope_row_in(&self, cell: DeckCell, y_m: f64) -> SparseRow {
        self.on_lines(cell.station, y_m, (-1.0 / cell.length_m, 1.0 / cell.length_m))
    }

    /// Factors of a station and the next, on the lines beside y.
    fn on_lines(&self, station: usize, y_m: f64, (a, b): (f64, f64)) -> SparseRow {
        let mut entries = Vec::with_capacity(4);
        for (line, across) in self.across(y_m) {
            // a wheel on a line needs that line alone
            if across != 0.0 {
                let first = line * self.stations() + station;
                entries.extend([(first, a * across), (first + 1, b * across)]);
            }
        }
        SparseRow(entries)
    }

    /// The interval between two stations that holds `x_m`; none off the bridge.
    #[inline(always)]
    pub(crate) fn cell(&self, x_m: f64) -> Option<DeckCell> {
        if !(0.0..=self.length_m()).contains(&x_m) {
            return None;
        }
        let at = match self.common_length_m {
            Some(length_m) => (x_m / length_m) as usize,
            None => self.modules.partition_point(|module| module.left_m <= x_m) - 1,
        };
        let module = &self.modules[at.min(self.modules.len() - 1)];
        Some(module.cell(x_m - module.left_m))
    }

    /// As [`Self::cell`], at a joint the end of the module on the left.
    #[inline(always)]
    pub(crate) fn cell_before(&self, x_m: f64) -> Option<DeckCell> {
        let cell = self.cell(x_m)?;
        if cell.in_module_m > 0.0 || cell.station == 0 {
            return Some(cell);
        }
        let at = self.modules.partition_point(|module| module.first < cell.station) - 1;
        let module = &self.modules[at];
        Some(module.cell(module.length_m))
    }

    /// The two lines beside `y_m` with their shares.
    pub fn across(&self, y_m: f64) -> [(usize, f64); 2] {
        let (iy, t, _) = interval(&self.lines_y, y_m);
        [(iy, 1.0 - t), (iy + 1, t)]
    }

    /// Shortest distance between stations of a module `[m]`.
    pub(crate) fn shortest_m(&self) -> f64 {
        let modules = self.modules.iter();
        let lengths = modules.flat_map(|module| module.lines_x.windows(2).map(|w| w[1] - w[0]));
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Most stations that a module has.
    pub(crate) fn most_stations(&self) -> usize {
        self.modules
            .iter()
            .map(|module| module.lines_x.len())
            .max()
            .unwrap_or(0)
    }

    /// Length of the shortest module `[m]`.
    pub(crate) fn shortest_module_m(&self) -> f64 {
        let lengths = self.modules.iter().map(|module| module.length_m);
        lengths.fold(f64::INFINITY, f64::min)
    }
}

impl TrackModule {
    /// The interval between two stations that holds a place of the module.
    #[inline(always)]
    fn cell(&self, in_module_m: f64) -> DeckCell {
        let (ix, fraction, length_m) = interval(&self.lines_x, in_module_m);
        DeckCell {
            station: self.first + ix,
            fraction,
            length_m,
            in_module_m,
            module_m: self.length_m,
        }
    }
}

/// A place between a station and the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DeckCell {
    /// The station on the left.
    pub station: usize,
    /// Where between it and the next, 0 to 1.
    pub fraction: f64,
    /// Their distance `[m]`.
    pub length_m: f64,
    /// Distance of the place from the left end of its module `[m]`.
    pub in_module_m: f64,
    /// Length of that module `[m]`.
    pub module_m: f64,
}

impl DeckCell {
    /// Both stations with their shares.
    #[inline(always)]
    pub(crate) fn shares(&self) -> [(usize, f64); 2] {
        [(self.station, 1.0 - self.fraction), (self.station + 1, self.fraction)]
    }
}

/// The interval of `lines` that holds `at`, the place in it from 0 to 1, and its length; the outermost interval outside.
#[inline(always)]
fn interval(lines: &[f64], at: f64) -> (usize, f64, f64) {
    let i = lines[1..].partition_point(|line| *line < at).min(lines.len() - 2);
    let length = lines[i + 1] - lines[i];
    let place = ((at - lines[i]) / length).clamp(0.0, 1.0);
    let snapped = if place < 1e-9 {
        0.0
    } else if place > 1.0 - 1e-9 {
        1.0
    } else {
        place
    };
    (i, snapped, length)
}
