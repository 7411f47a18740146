//! What weighs on a bridge before any vehicle comes: ballast, dry parts, a risen river.
//!
//! Knows which forces these are and where they act. Does not know what the bridge does under them.

use super::BridgeDesign;
use super::ballast::BallastSpec;
use super::modules::Modules;
use super::prepared::{X, Y, Z};
use super::row::Row;
use crate::fem::SparseRow;
use crate::vehicle::GRAVITY_M_S2;

/// A mass on a bridge: its motion along, across and up.
#[derive(Debug, Clone)]
pub(super) struct PointMass {
    pub mass_kg: f64,
    /// The module, from 0.
    module: usize,
    /// Rows by the module's dofs, and by those of the bridge.
    own: [SparseRow; 3],
    pub rows: [SparseRow; 3],
}

/// Forces on a bridge at rest: those of what lies on it and, beside, of a river that has risen by 1 m.
#[derive(Debug, Clone)]
pub(super) struct DeadLoads {
    /// Of each module by its own dofs, upward `[N]`: what lies there, then the water.
    own: Vec<[SparseRow; 2]>,
    /// Resultants on the bridge of what lies there: force up, moments about x and about y through its left end.
    pub resultants: [f64; 3],
    /// Those of the water that has risen by 1 m.
    pub risen_water: [f64; 3],
    /// Those of the water that dry weights bring about beside what the kept dofs tell.
    pub dry_water: [f64; 3],
    masses: Vec<PointMass>,
}

impl DeadLoads {
    /// Those of a bridge.
    pub(super) fn new(design: &BridgeDesign, modules: &Modules<'_>, row: &Row<'_>) -> Self {
        let masses: Vec<PointMass> = design
            .dead
            .ballast
            .iter()
            .map(|of| point_mass(of, modules, row))
            .collect();
        let mut resultants = [0.0; 3];
        for of in &design.dead.ballast {
            let x_m = modules.left_m(of.module - 1) + of.x_m;
            let force = -of.weight_n;
            resultants[0] += force;
            resultants[1] += of.y_m * force;
            resultants[2] -= x_m * force;
        }
        let mut dry_water = [0.0; 3];
        for (j, module) in modules.each().enumerate() {
            add(&mut resultants, module.dry_resultants(), modules.left_m(j));
            add(&mut dry_water, module.dry_water, modules.left_m(j));
        }
        let of_module = |j: usize| {
            let here = masses.iter().filter(|mass| mass.module == j);
            let ballast = here.map(|mass| (-mass.mass_kg * GRAVITY_M_S2, &mass.own[Z]));
            let dry = std::iter::once((1.0, modules.module(j).dry_weight()));
            let lies = SparseRow::combine(&ballast.chain(dry).collect::<Vec<_>>());
            // water that rises by h presses as on a module that sinks by h
            let water = SparseRow::combine(&[(-1.0, &modules.module(j).water[0])]);
            [lies, water]
        };
        Self {
            own: (0..modules.len()).map(of_module).collect(),
            resultants,
            risen_water: risen_water(modules),
            dry_water,
            masses,
        }
    }

    /// The masses.
    pub(super) fn masses(&self) -> &[PointMass] {
        &self.masses
    }

    /// Upward force by the dofs of the bridge `[N]`: what lies there, then the water.
    pub(super) fn on_bridge(&self, row: &Row<'_>) -> [SparseRow; 2] {
        [0, 1].map(|which| {
            let rows: Vec<SparseRow> = (0..)
                .zip(&self.own)
                .map(|(j, own)| row.global(j, &own[which]))
                .collect();
            SparseRow::combine(&rows.iter().map(|row| (1.0, row)).collect::<Vec<_>>())
        })
    }

    /// Upward force on a dof of a module `[N]`: what lies there, then the water.
    pub(super) fn at(&self, module: usize, dof: usize) -> [f64; 2] {
        let entry = |row: &SparseRow| row.0.iter().filter(|(i, _)| *i == dof).map(|(_, v)| v).sum();
        self.own[module].each_ref().map(entry)
    }

    /// What the masses of a module add to the row of its mass matrix at a dof, by the dofs of the bridge.
    pub(super) fn mass_row(&self, module: usize, dof: usize) -> SparseRow {
        let here = self.masses.iter().filter(|mass| mass.module == module);
        let parts = here.flat_map(|mass| {
            (0..3).map(|d| {
                let own: f64 = mass.own[d].0.iter().filter(|(i, _)| *i == dof).map(|(_, v)| v).sum();
                (mass.mass_kg * own, &mass.rows[d])
            })
        });
        SparseRow::combine(&parts.filter(|(factor, _)| *factor != 0.0).collect::<Vec<_>>())
    }
}

/// Resultants of the water on a bridge that has sunk by 1 m, on its supports too.
fn risen_water(modules: &Modules<'_>) -> [f64; 3] {
    let mut total = [0.0; 3];
    for (j, module) in modules.each().enumerate() {
        let own = module.water.each_ref().map(|row| -row.dot(&module.afloat));
        add(&mut total, own, modules.left_m(j));
    }
    total
}

/// Adds resultants about a module's left end to those about the bridge's.
fn add(to: &mut [f64; 3], [up, about_x, about_y]: [f64; 3], left_m: f64) {
    to[0] += up;
    to[1] += about_x;
    to[2] += about_y - left_m * up;
}

/// A ballast on the deck, linear between the nodes around it.
fn point_mass(of: &BallastSpec, modules: &Modules<'_>, row: &Row<'_>) -> PointMass {
    let (j, module) = (of.module - 1, modules.module(of.module - 1));
    let grid = &module.grid;
    let nodes: Vec<(f64, usize, usize)> = shares(&grid.x, of.x_m)
        .into_iter()
        .flat_map(|(a, ix)| shares(&grid.y, of.y_m).map(|(b, iy)| (a * b, ix, iy)))
        .filter(|(share, ..)| *share != 0.0)
        .collect();
    let own = [X, Y, Z].map(|direction| {
        let rows: Vec<(f64, SparseRow)> = nodes
            .iter()
            .map(|&(share, ix, iy)| (share, module.row(grid.deck(ix, iy), direction)))
            .collect();
        SparseRow::combine(&rows.iter().map(|(share, row)| (*share, row)).collect::<Vec<_>>())
    });
    PointMass {
        mass_kg: of.weight_n / GRAVITY_M_S2,
        module: j,
        rows: own.each_ref().map(|own| row.global(j, own)),
        own,
    }
}

/// The two lines around a place, each with its share.
fn shares(lines: &[f64], place: f64) -> [(f64, usize); 2] {
    let right = lines.partition_point(|line| *line <= place).clamp(1, lines.len() - 1);
    let [from, to] = [lines[right - 1], lines[right]];
    let share = ((place - from) / (to - from)).clamp(0.0, 1.0);
    [(1.0 - share, right - 1), (share, right)]
}
