//! The grid of deck and bottom over a module's mesh, whatever the mesh is made of.
//!
//! Knows lines along and across and the two nodes at each crossing of them. Does not know what joins the nodes.

use super::Outline;
use crate::fem::{Mesh, NodeId};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M};

/// The structured grid of deck and bottom: a deck node and a bottom node at every crossing of a line along and a line
/// across.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Lines along the module, from 0 to the length `[m]`.
    pub x: Vec<f64>,
    /// Lines across, from minus to plus half the breadth `[m]`.
    pub y: Vec<f64>,
    pub(super) deck: Vec<NodeId>,
    pub(super) bottom: Vec<NodeId>,
}

impl Grid {
    /// A grid over nodes that a mesh already has.
    ///
    /// `x` and `y`: the places of the lines `[m]`, at least two each way, increasing. `deck`, `bottom`: the nodes at
    /// `(x[i], y[j])` at place `i y.len() + j`, each node once: `x.len() y.len()` of each. What lies between the nodes may be
    /// anything; wheels see the deck as bilinear between them, water the bottom as bilinear cells.
    ///
    /// # Errors
    /// [`InvalidInput`] on `x`, `y`, `deck` or `bottom`. Verified by `tests/limits/given_mesh.rs`.
    pub fn new(x: Vec<f64>, y: Vec<f64>, deck: Vec<NodeId>, bottom: Vec<NodeId>) -> Result<Self, InvalidInput> {
        let grid = Self { x, y, deck, bottom };
        grid.check()?;
        Ok(grid)
    }

    /// Refuses what is no grid.
    fn check(&self) -> Result<(), InvalidInput> {
        for (key, lines) in [("x", &self.x), ("y", &self.y)] {
            if lines.len() < 2 {
                let found = format!("{} lines", lines.len());
                return Err(InvalidInput::new(key, found, "at least two lines"));
            }
            for (i, w) in lines.windows(2).enumerate() {
                if !(w[0].is_finite() && w[1].is_finite() && w[1] - w[0] > SAME_PLACE_M) {
                    let allowed = format!("more than {SAME_PLACE_M} above {}", w[0]);
                    return Err(InvalidInput::new(format!("{key}[{}]", i + 1), w[1], allowed));
                }
            }
        }
        let crossings = self.x.len() * self.y.len();
        for (key, nodes) in [("deck", &self.deck), ("bottom", &self.bottom)] {
            if nodes.len() != crossings {
                let found = format!("{} nodes", nodes.len());
                return Err(InvalidInput::new(key, found, format!("{crossings}, one a crossing")));
            }
        }
        let mut nodes: Vec<NodeId> = self.deck.iter().chain(&self.bottom).copied().collect();
        nodes.sort_unstable();
        match nodes.windows(2).find(|w| w[0] == w[1]) {
            Some(twice) => {
                let found = format!("node {}", twice[0].0);
                Err(InvalidInput::new("deck, bottom", found, "each node once").because(Problem::Repeated))
            }
            None => Ok(()),
        }
    }

    /// Deck node at lines `ix`, `iy`.
    pub fn deck(&self, ix: usize, iy: usize) -> NodeId {
        self.deck[ix * self.y.len() + iy]
    }

    /// Bottom node at lines `ix`, `iy`.
    pub fn bottom(&self, ix: usize, iy: usize) -> NodeId {
        self.bottom[ix * self.y.len() + iy]
    }

    /// Number of the line across at `y_m`, where there is one.
    pub fn y_line(&self, y_m: f64) -> Option<usize> {
        line(&self.y, y_m)
    }

    /// Number of the line along at `x_m`, where there is one.
    pub fn x_line(&self, x_m: f64) -> Option<usize> {
        line(&self.x, x_m)
    }

    /// The centre line as lines across with their weights: the line at y = 0, or between its two neighbours where there is
    /// none.
    pub(crate) fn centre(&self) -> Vec<(f64, usize)> {
        if let Some(line) = self.y_line(0.0) {
            return vec![(1.0, line)];
        }
        let right = self.y.iter().position(|&y| y > 0.0).unwrap_or(self.y.len() - 1).max(1);
        let share = -self.y[right - 1] / (self.y[right] - self.y[right - 1]);
        vec![(1.0 - share, right - 1), (share, right)]
    }

    /// Bottom cells between two places along `[m]`, which are lines: their corner nodes in cyclic order and their area in
    /// plan `[m^2]`.
    pub(crate) fn bottom_cells(&self, [from_m, to_m]: [f64; 2]) -> impl Iterator<Item = ([NodeId; 4], f64)> + '_ {
        let middle_m = |i: usize| 0.5 * (self.x[i] + self.x[i + 1]);
        let within = move |(i, _): &(usize, usize)| middle_m(*i) > from_m && middle_m(*i) < to_m;
        cells(self.x.len(), self.y.len()).filter(within).map(|(i, j)| {
            let area = (self.x[i + 1] - self.x[i]) * (self.y[j + 1] - self.y[j]);
            (
                [
                    self.bottom(i, j),
                    self.bottom(i + 1, j),
                    self.bottom(i + 1, j + 1),
                    self.bottom(i, j + 1),
                ],
                area,
            )
        })
    }
}

/// A module's mesh and its grid.
#[derive(Debug, Clone, PartialEq)]
pub struct ModuleMesh {
    /// Nodes, shells, beams.
    pub mesh: Mesh,
    /// Deck and bottom.
    pub grid: Grid,
}

impl ModuleMesh {
    /// Refuses a mesh whose elements or grid name nodes that it does not have, and a grid that does not stand where its
    /// nodes are: bottom nodes at `(x[i], y[j])` at the height that the outline's bottom has there, deck nodes at that of its
    /// deck.
    ///
    /// # Errors
    /// [`InvalidInput`] with the element or the node.
    pub(crate) fn check(&self, outline: &Outline) -> Result<(), InvalidInput> {
        let Self { mesh, grid } = self;
        grid.check().map_err(|e| e.under("grid"))?;
        let count = mesh.nodes.len();
        let shells = mesh.shells.iter().map(|shell| ("shells", &shell.nodes[..]));
        let beams = mesh.beams.iter().map(|beam| ("beams", &beam.nodes[..]));
        let named = shells.enumerate().chain(beams.enumerate());
        let levels = [("grid.deck", &grid.deck), ("grid.bottom", &grid.bottom)];
        for (i, (key, nodes)) in named.chain(levels.iter().map(|(key, nodes)| (*key, &nodes[..])).enumerate()) {
            if let Some(node) = nodes.iter().find(|node| node.0 >= count) {
                let key = if key.starts_with("grid") {
                    key.to_owned()
                } else {
                    format!("{key}[{i}]")
                };
                return Err(InvalidInput::new(
                    key,
                    format!("node {}", node.0),
                    format!("one of {count} nodes"),
                ));
            }
        }
        let heights: [fn(&Outline, f64) -> f64; 2] = [Outline::deck_at_m, Outline::bottom_at_m];
        for ((key, nodes), height) in levels.iter().zip(heights) {
            for (i, &node) in nodes.iter().enumerate() {
                let (x, y) = (grid.x[i / grid.y.len()], grid.y[i % grid.y.len()]);
                let z = height(outline, x);
                let place = mesh.place(node);
                // a place that is not a number is no place either
                let there = [place.x - x, place.y - y, place.z - z]
                    .iter()
                    .all(|d| d.abs() <= SAME_PLACE_M);
                if !there {
                    let found = format!("node {} at ({}, {}, {})", node.0, place.x, place.y, place.z);
                    let allowed = format!("a node at ({x}, {y}, {z})");
                    return Err(InvalidInput::new(format!("{key}[{i}]"), found, allowed));
                }
            }
        }
        Ok(())
    }
}

pub(super) fn line(lines: &[f64], at: f64) -> Option<usize> {
    lines.iter().position(|&l| (l - at).abs() <= SAME_PLACE_M)
}

pub(super) fn cells(nx: usize, ny: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..nx - 1).flat_map(move |i| (0..ny - 1).map(move |j| (i, j)))
}
