//! The prepared modules of a row: which stands where.
//!
//! Knows the place of each module along the bridge and that neighbours share their lines across. Does not know dofs of the
//! bridge.

use super::fit::check_fit;
use super::prepared::{PreparedModule, Side};
use super::{BridgeDesign, BridgeError, Model};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M};
use crate::module::Grid;
use std::borrow::Borrow;

/// Prepared modules side by side.
pub(super) struct Modules<'a> {
    /// Each variant once.
    pub(super) variants: Vec<&'a PreparedModule>,
    /// The design of each variant.
    pub(super) designs: Vec<BridgeDesign>,
    /// Of each module its variant.
    pub(super) of_module: Vec<usize>,
    /// Place of each position `[m]`: the left ends, and the right end of the last module.
    positions_m: Vec<f64>,
}

impl<'a> Modules<'a> {
    /// The modules of a bridge; `prepared` are those of its variants.
    ///
    /// # Errors
    /// [`BridgeError::Design`] where a module does not serve its design or its neighbours.
    pub(super) fn new<M: Borrow<PreparedModule>>(
        design: &BridgeDesign,
        prepared: &'a [M],
    ) -> Result<Self, BridgeError> {
        let of = design.variants();
        if prepared.len() != of.designs.len() {
            let (found, needed) = (prepared.len(), of.designs.len());
            let allowed = format!("{needed}, one of each kind that differs");
            let refused = InvalidInput::new("modules", format!("{found} prepared modules"), allowed);
            return Err(refused.because(Problem::Conflict).into());
        }
        let variants: Vec<&PreparedModule> = prepared.iter().map(Borrow::borrow).collect();
        for ((design, module), key) in of.designs.iter().zip(&variants).zip(&of.keys) {
            check_fit(design, &module.grid).map_err(|e| e.within_kind(key))?;
            check_lines(&variants[0].grid, &module.grid).map_err(|e| e.within_kind(key))?;
        }
        Ok(Self {
            variants,
            designs: of.designs,
            of_module: of.of_module,
            positions_m: design.positions_m(),
        })
    }

    /// Number of modules.
    pub(super) fn len(&self) -> usize {
        self.of_module.len()
    }

    /// A module, from 0.
    pub(super) fn module(&self, j: usize) -> &'a PreparedModule {
        self.variants[self.of_module[j]]
    }

    /// The grid of a module.
    pub(super) fn grid(&self, j: usize) -> &'a Grid {
        &self.module(j).grid
    }

    /// All modules from left to right.
    pub(super) fn each(&self) -> impl Iterator<Item = &'a PreparedModule> {
        self.of_module.iter().map(|&of| self.variants[of])
    }

    /// Lines across, which all modules have.
    pub(super) fn lines_y(&self) -> &'a [f64] {
        &self.variants[0].grid.y
    }

    /// Place of a module's left end `[m]`.
    pub(super) fn left_m(&self, j: usize) -> f64 {
        self.positions_m[j]
    }

    /// Depth of a module at an end `[m]`.
    pub(super) fn depth_m(&self, j: usize, side: Side) -> f64 {
        self.design(j).module.outline().depths_m()[side as usize]
    }

    /// The design of a module.
    pub(super) fn design(&self, j: usize) -> &BridgeDesign {
        &self.designs[self.of_module[j]]
    }

    /// Which matrices the modules contribute.
    pub(super) fn model(&self) -> Model {
        self.variants[0].model
    }
}

/// Refuses a grid whose lines across are not those of another.
fn check_lines(first: &Grid, grid: &Grid) -> Result<(), InvalidInput> {
    let same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_PLACE_M;
    if first.y.len() == grid.y.len() && first.y.iter().zip(&grid.y).all(same) {
        return Ok(());
    }
    let [found, allowed] = [grid, first].map(|grid| grid.y.iter().map(f64::to_string).collect::<Vec<_>>().join(", "));
    Err(InvalidInput::new(
        "grid.y",
        found,
        format!("the lines across of the first module: {allowed}"),
    ))
}
