//! The corners of one module as lanes read them, and how far they may move on a path (O11).
//!
//! Knows rows on modes and links. Does not know lanes' motion or what was largest.

use super::basis::{BridgeOperator, Observed};
use super::panel::Panel;

/// What rounding may do to a path, a share of it: far more than it does.
const ROUNDING: f64 = 1e-3;

/// Most corners of a module: of deck and bottom, two ends, two edges.
pub(super) const MOST_CORNERS: usize = 8;

/// The corners of a module in lanes: those of the deck, left and right end, right and left edge, then those of the bottom.
#[derive(Debug)]
pub(super) struct CornerPanel {
    /// `[V Phi, -R_VB]`.
    pub(super) panel: Panel,
    /// The path on which a deck corner, a bottom corner, roll and trim may change by 1 m or 1 rad.
    pub(super) down: f64,
    pub(super) bottom: f64,
    pub(super) roll: f64,
    pub(super) trim: f64,
    /// The path for 1 m that loads beside the modes move a corner.
    pub(super) beside: f64,
}

/// Where the corners of a module are among the observed rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct CornerRows {
    pub(super) deck: usize,
    pub(super) bottom: usize,
    /// How many corners deck and bottom have.
    pub(super) of_deck: usize,
    pub(super) of_bottom: usize,
}

impl CornerRows {
    #[inline(always)]
    pub(super) fn of(rows: &Observed, module: usize) -> Self {
        let of_deck = 2 * rows.edges;
        let deck = rows.positions + of_deck * module;
        // where no draft is given no bottom is followed
        let (bottom, of_bottom) = match rows.bottom_corners {
            0 => (deck, 0),
            _ => (deck + rows.corners, of_deck),
        };
        Self {
            deck,
            bottom,
            of_deck,
            of_bottom,
        }
    }

    fn list(self) -> Vec<usize> {
        let bottom = self.bottom..self.bottom + self.of_bottom;
        (self.deck..self.deck + self.of_deck).chain(bottom).collect()
    }
}

impl CornerPanel {
    /// The corners of a module; links count in the path with the weight g `[m/N]`.
    pub(super) fn new(o: &BridgeOperator, module: usize, link_weight: f64) -> Self {
        let (modes, links, of_end) = (o.sizes.modes, o.sizes.connectors, o.rows.edges);
        let (rows, length_m) = (CornerRows::of(&o.rows, module), o.of_modules[module].length_m);
        let own = rows.list();
        let entry = |row: usize, k: usize| {
            if k < modes {
                o.v[(row, k)]
            } else {
                -o.r_vb[(row, k - modes)]
            }
        };
        // the path on which the largest of sums of rows may change by 1
        let path = |sums: &mut dyn Iterator<Item = Vec<(usize, f64)>>| {
            let of_sum = |sum: Vec<(usize, f64)>| {
                let of = |k: usize| sum.iter().map(|&(row, w)| w * entry(row, k)).sum();
                reach(
                    &(0..modes + links).map(of).collect::<Vec<f64>>(),
                    &o.omega2,
                    link_weight,
                )
            };
            1.0 / sums.map(of_sum).fold(f64::MIN_POSITIVE, f64::max)
        };
        let (deck, under) = own.split_at(rows.of_deck);
        let single = |row: &usize| vec![(*row, 1.0)];
        let (per_breadth, per_length) = (1.0 / o.breadth_m, 1.0 / length_m);
        let across = |end: &[usize]| vec![(end[0], -per_breadth), (end[of_end - 1], per_breadth)];
        let (left, right) = deck.split_at(of_end);
        let mean = per_length / of_end as f64;
        let along = left
            .iter()
            .map(|&row| (row, -mean))
            .chain(right.iter().map(|&row| (row, mean)));
        let of = Self {
            panel: Panel::new(own.len(), modes + links, |i, k| entry(own[i], k)),
            down: path(&mut deck.iter().map(single)),
            bottom: path(&mut under.iter().map(single)),
            roll: path(&mut deck.chunks_exact(of_end).map(across)),
            trim: path(&mut std::iter::once(along.collect())),
            beside: 0.0,
        };
        let mut beside = of.down.max(2.0 * per_length * of.trim);
        if of_end == 2 {
            beside = beside.max(2.0 * per_breadth * of.roll);
        }
        if rows.of_bottom > 0 {
            beside = beside.max(of.bottom);
        }
        Self { beside, ..of }
    }
}

/// N of a row, what it may change by on a path of 1: its entries on modes, then on links (O11).
fn reach(row: &[f64], omega2: &[f64], link_weight: f64) -> f64 {
    let (modes, links) = row.split_at(omega2.len());
    let of_mode = |(phi, omega2): (&f64, &f64)| phi * phi / (omega2.max(0.0) + 1.0);
    let of_modes: f64 = modes.iter().zip(omega2).map(of_mode).sum();
    let of_links: f64 = links.iter().map(|r| r * r / link_weight).sum();
    (1.0 + ROUNDING) * (of_modes + of_links).sqrt()
}

#[cfg(test)]
mod tests {
    use super::reach;

    /// The motion that moves a row most on its path moves it by as much as is told, and no other moves it more. A row that is 5 %
    /// larger is moved by more.
    #[test]
    fn no_path_moves_a_row_farther() {
        let (omega2, link_weight) = ([0.0, 6.0, 40.0, 9e3], 3e-8);
        let row = [0.01, -0.02, 0.015, 0.3, 2e-9, -5e-9];
        let weight = |k: usize| omega2.get(k).map_or(link_weight, |omega2| omega2 + 1.0);
        let most: Vec<f64> = row.iter().enumerate().map(|(k, x)| x / weight(k)).collect();
        let other: Vec<f64> = (0..6)
            .map(|k| (2.3 * f64::from(k)).sin() / weight(k as usize).sqrt())
            .collect();
        let moved = |motion: &[f64], row: &[f64]| -> f64 {
            let path: f64 = motion.iter().enumerate().map(|(k, d)| weight(k) * d * d).sum();
            row.iter().zip(motion).map(|(x, d)| x * d).sum::<f64>().abs() / path.sqrt()
        };
        let told = reach(&row, &omega2, link_weight);
        assert!(moved(&most, &row) <= told && moved(&most, &row) > 0.998 * told);
        assert!(moved(&other, &row) < told);
        let larger = row.map(|x| 1.05 * x);
        assert!(moved(&most, &larger) > told, "a row 5 % larger passes");
    }
}
