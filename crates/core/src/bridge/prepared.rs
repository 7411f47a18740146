//! A module made ready for a row of its like: structure, water and, where asked, condensation.
//!
//! Knows which nodes carry hinges, connectors, wheels, supports and water. Does not know neighbours.

use super::dry::{dry_weight, resultants};
use super::fit::check_fit;
use super::{BridgeDesign, BridgeError, Model};
use crate::fem::{FemError, MassKind, Mesh, NodeId, SparseRow, SymmetricMatrix, assemble};
use crate::module::{Grid, ModuleMesh};
use crate::superelement::SuperElement;
use crate::water::{WaterDistribution, spread};
use faer::{Mat, MatRef};
use nalgebra::Matrix3;
use std::collections::BTreeSet;

/// Translation along the bridge, across it, and up, as directions of a node's dofs.
pub(super) const X: usize = 0;
pub(super) const Y: usize = 1;
pub(super) const Z: usize = 2;

/// The two ends of a module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// A module made ready for assembly: its matrices and what is needed to place it in a row. Built once for a design and
/// shared by all modules and all jobs.
#[derive(Debug)]
pub struct PreparedModule {
    pub(super) model: Model,
    pub(super) grid: Grid,
    /// Its nodes, shells and beams.
    pub(super) mesh: Mesh,
    /// Structure and water.
    pub(super) k: SymmetricMatrix,
    /// Structure and water, but for water with memory.
    pub(super) m: SymmetricMatrix,
    /// What the water's springs have of `k`.
    pub(super) k_water: SymmetricMatrix,
    /// Heave, pitch and roll of its wet bottom about the middle of its length, by the dofs.
    pub(super) motions: [SparseRow; 3],
    /// For each dof of the full module its place among the dofs of `k`, where it is one.
    direct: Vec<Option<usize>>,
    condensed: Option<SuperElement>,
    /// Resultants of the water's force on the module for unit dofs: up, about x, about y (through the module's left
    /// end, centre line).
    pub(super) water: [SparseRow; 3],
    /// Where it goes when the water rises by 1 m: a unit heave.
    pub(super) afloat: Vec<f64>,
    /// Weight of the part that no water carries, a load by the dofs (up) `[N]`, see [`PreparedModule::dry_weight`].
    pub(super) dry_weight: SparseRow,
    dry_resultants: [f64; 3],
    /// Resultants of the water that this weight brings about beside what the kept dofs tell.
    pub(super) dry_water: [f64; 3],
    /// Surge, sway and yaw about the left end's centre: motions against which neither plates nor water do anything.
    pub(super) horizontal_rigid: [Vec<f64>; 3],
    structural_mass_kg: f64,
    roll_inertia_kg_m2: f64,
    full_dofs: usize,
}

impl PreparedModule {
    /// Meshes the design's box and goes on as [`PreparedModule::from_mesh`].
    ///
    /// # Errors
    /// [`BridgeError`].
    pub fn new(design: &BridgeDesign, model: Model) -> Result<Self, BridgeError> {
        design.check()?;
        Self::from_mesh(design, design.module_mesh(), model)
    }

    /// Prepares the modules of a bridge, those of each of its [`BridgeDesign::variants`] once.
    ///
    /// # Errors
    /// [`BridgeError`].
    pub fn of_kinds(design: &BridgeDesign, model: Model) -> Result<Vec<Self>, BridgeError> {
        design.check()?;
        design
            .variants()
            .designs
            .iter()
            .map(|of_kind| Self::new(of_kind, model))
            .collect()
    }

    /// Takes any mesh for the module, adds the water and, for the super-element, condenses it.
    ///
    /// `k = k_structure + k_b`, `m = m_structure + m_a` as for the box (`crate::water::spread` over the cells of the grid's
    /// bottom, p_b and m_a the design's), so that beams in place of plates meet the same bridge, statics and crossings. Of
    /// the design's module only length, breadth and depth count here `[m]`, and `mesh.elements_along` for the places of
    /// [`crate::analysis::statics::StaticSolver::creeping_peak_m`]. The grid spans that length and breadth, bottom nodes lie
    /// at the heights of [`Outline`](crate::module::Outline), as deck nodes do, a line along is where the wet part begins or ends, and a
    /// line across where a hinge or a connector is.
    ///
    /// # Errors
    /// [`BridgeError::Design`] where the design, the grid or their fit is refused, [`BridgeError::Fem`] where an element is
    /// degenerate or the mesh leaves a mechanism to condense. Verified by `tests/limits/given_mesh.rs` and
    /// `tests/analytic/beam_module.rs`.
    pub fn from_mesh(design: &BridgeDesign, meshed: ModuleMesh, model: Model) -> Result<Self, BridgeError> {
        design.check()?;
        let outline = design.module.outline();
        meshed.check(&outline)?;
        check_fit(design, &meshed.grid)?;
        let (grid, mesh) = (meshed.grid, meshed.mesh);
        let Afloat { k, m, mass, water } = Afloat::new(design, &grid, &mesh)?;
        let heave = heave(&mesh);
        let structural_mass_kg = mass.form(&heave, &heave);
        let roll = roll(&mesh, outline.middle_m());
        let roll_inertia_kg_m2 = m.form(&roll, &roll);
        let reduced = match model {
            Model::Full => Reduced::not_at_all(k, m),
            Model::SuperElement => Reduced::to_masters(design, &grid, &k, &m)?,
        };
        let full_dofs = mesh.dofs();
        let k_water = reduced.matrix(&water.k)?;
        let motions = wet_motions(design, &grid, &mesh).map(|motion| reduced.force(motion));
        let totals = water.resultants(&mesh);
        let water = totals.clone().map(|total| reduced.force(total));
        let afloat = reduced.afloat(&heave, &water[0]);
        let weight = dry_weight(design, &mesh)?;
        let dry_water = match (&reduced.condensed, &weight) {
            (Some(condensed), Some(load)) => {
                let Afloat { k, .. } = Afloat::new(design, &grid, &mesh)?;
                let moved = condensed.static_remainder(&k, load)?;
                totals.map(|total| total.iter().zip(&moved).map(|(force, u)| force * u).sum())
            }
            _ => [0.0; 3],
        };
        let dry_resultants = weight.as_ref().map_or([0.0; 3], |load| resultants(load, &mesh));
        let dry_weight = weight.map_or_else(SparseRow::default, |load| reduced.force(load));
        let horizontal_rigid = horizontal_rigid(&mesh).map(|motion| reduced.motion(&motion));
        let Reduced {
            k,
            m,
            direct,
            condensed,
        } = reduced;
        Ok(Self {
            model,
            grid,
            mesh,
            k,
            m,
            k_water,
            motions,
            direct,
            condensed,
            water,
            afloat,
            dry_weight,
            dry_resultants,
            dry_water,
            horizontal_rigid,
            structural_mass_kg,
            roll_inertia_kg_m2,
            full_dofs,
        })
    }

    /// Weight of what stands beside the wet part of the bottom, as a load by the dofs, up `[N or N m]`; empty where nothing is
    /// dry. Verified by `crates/core/src/bridge/ramps.rs`.
    /// Equation (W3).
    pub fn dry_weight(&self) -> &SparseRow {
        &self.dry_weight
    }

    /// Resultants of that weight about the left end's centre: up `[N]`, about x and about y `[N m]`.
    pub fn dry_resultants(&self) -> [f64; 3] {
        self.dry_resultants
    }

    /// `r^T M r` of a unit heave, structure alone `[kg]`.
    pub fn structural_mass_kg(&self) -> f64 {
        self.structural_mass_kg
    }

    /// Inertia of a unit roll about the axis at the mean height of its corners, water included `[kg m^2]`.
    pub(crate) fn roll_inertia_kg_m2(&self) -> f64 {
        self.roll_inertia_kg_m2
    }

    /// Degrees of freedom.
    pub fn dofs(&self) -> usize {
        self.k.order()
    }

    /// Degrees of freedom before condensation.
    pub fn full_dofs(&self) -> usize {
        self.full_dofs
    }

    /// Place of a node's translation among the dofs, where it is one of them.
    pub(super) fn dof(&self, node: NodeId, direction: usize) -> Option<usize> {
        self.direct[node.dof(direction)]
    }

    /// The transformation to all dofs of the finite elements, where the module is condensed.
    pub(super) fn transformation(&self) -> Option<MatRef<'_, f64>> {
        self.condensed.as_ref().map(|c| c.transformation.as_ref())
    }

    /// What the inertia of a condensed module's inner dofs adds to their motion, see [`SuperElement::inertial_correction`];
    /// none where nothing is condensed. `design` is the one that it was prepared from.
    ///
    /// # Errors
    /// [`FemError`] as [`PreparedModule::from_mesh`].
    pub(super) fn inertial_correction(&self, design: &BridgeDesign) -> Result<Option<Mat<f64>>, FemError> {
        let Some(condensed) = &self.condensed else {
            return Ok(None);
        };
        let Afloat { k, m, .. } = Afloat::new(design, &self.grid, &self.mesh)?;
        condensed.inertial_correction(&k, &m).map(Some)
    }

    /// A node's translation in terms of the dofs: itself, or a row of the transformation.
    pub(super) fn row(&self, node: NodeId, direction: usize) -> SparseRow {
        match (self.dof(node, direction), &self.condensed) {
            (Some(dof), _) => SparseRow(vec![(dof, 1.0)]),
            (None, Some(c)) => {
                let i = node.dof(direction);
                SparseRow(
                    (0..c.transformation.ncols())
                        .map(|j| (j, c.transformation[(i, j)]))
                        .collect(),
                )
            }
            (None, None) => SparseRow::default(),
        }
    }

    /// Place of a translation at the bottom of an end, at a place across, among the dofs; where it is one of them.
    pub(super) fn end_dof(&self, side: Side, y_m: f64, direction: usize) -> Option<usize> {
        let node = self.grid.bottom(self.end_line(side), self.grid.y_line(y_m)?);
        self.dof(node, direction)
    }

    /// Line along the module of one of its ends.
    pub(super) fn end_line(&self, side: Side) -> usize {
        match side {
            Side::Left => 0,
            Side::Right => self.grid.x.len() - 1,
        }
    }
}

/// The matrices of a module before anything is condensed.
struct Afloat {
    /// Structure and water.
    k: SymmetricMatrix,
    /// Structure and water.
    m: SymmetricMatrix,
    /// Structure alone.
    mass: SymmetricMatrix,
    water: Water,
}

impl Afloat {
    fn new(design: &BridgeDesign, grid: &Grid, mesh: &Mesh) -> Result<Self, FemError> {
        let (structure, mass) = assemble(mesh, MassKind::Consistent)?;
        let water = Water::under(design, grid, mesh.dofs())?;
        let k = SymmetricMatrix::combine(&[(1.0, &structure), (1.0, &water.k)])?;
        let m = SymmetricMatrix::combine(&[(1.0, &mass), (1.0, &water.m)])?;
        Ok(Self { k, m, mass, water })
    }
}

/// What the water adds to a module's matrices: it acts on z of the bottom alone.
struct Water {
    /// `k_b` `[N/m]`.
    k: SymmetricMatrix,
    /// `m_a` `[kg]`.
    m: SymmetricMatrix,
}

impl Water {
    /// Spreads the design's p_b and m_a over the wet part of the bottom of a module of `n` dofs.
    fn under(design: &BridgeDesign, grid: &Grid, n: usize) -> Result<Self, FemError> {
        let (wet_m, m_a_area) = (design.wet_m(), design.m_a() / design.module.breadth_m);
        let on_z = |entries: Vec<(NodeId, NodeId, f64)>| {
            let entries: Vec<_> = entries.iter().map(|(a, b, v)| (a.dof(Z), b.dof(Z), *v)).collect();
            SymmetricMatrix::from_entries(n, &entries)
        };
        Ok(Self {
            k: on_z(spread(grid, wet_m, design.p_b(), design.water_distribution))?,
            m: on_z(spread(grid, wet_m, m_a_area, design.water_distribution))?,
        })
    }

    /// Gives the resultants of [`PreparedModule::water`] by the dofs of the full module.
    fn resultants(&self, mesh: &Mesh) -> [Vec<f64>; 3] {
        // water pushes down on a module that rises: force -k_b u at each node
        [|_: f64, _: f64| 1.0, |_, y| y, |x: f64, _| -x].map(|arm: fn(f64, f64) -> f64| {
            let mut total = vec![0.0; mesh.dofs()];
            for (i, j, v) in self.k.entries() {
                let place = mesh.nodes[i / 6];
                total[j] -= v * arm(place.x, place.y);
            }
            total
        })
    }
}

/// The matrices that a module contributes, and how they lie among the dofs of the full module.
struct Reduced {
    k: SymmetricMatrix,
    m: SymmetricMatrix,
    /// Where each dof of the full module lies in `k` and `m`; none of a dof that is condensed.
    direct: Vec<Option<usize>>,
    condensed: Option<SuperElement>,
}

impl Reduced {
    /// Keeps every dof.
    fn not_at_all(k: SymmetricMatrix, m: SymmetricMatrix) -> Self {
        Self {
            direct: (0..k.order()).map(Some).collect(),
            condensed: None,
            k,
            m,
        }
    }

    /// Condenses a module to its masters and the design's fixed-master modes.
    fn to_masters(
        design: &BridgeDesign,
        grid: &Grid,
        k: &SymmetricMatrix,
        m: &SymmetricMatrix,
    ) -> Result<Self, FemError> {
        let masters = masters(design, grid);
        let condensed = SuperElement::condense(k, m, &masters, design.condensation.fixed_master_modes)?;
        let mut direct = vec![None; k.order()];
        for (place, &dof) in condensed.masters.iter().enumerate() {
            direct[dof] = Some(place);
        }
        Ok(Self {
            k: condensed.k.clone(),
            m: condensed.m.clone(),
            direct,
            condensed: Some(condensed),
        })
    }

    /// Takes a matrix of the full module over to the dofs that are kept, `T^T A T`.
    fn matrix(&self, a: &SymmetricMatrix) -> Result<SymmetricMatrix, FemError> {
        match &self.condensed {
            None => Ok(a.clone()),
            Some(condensed) => condensed.congruent(a),
        }
    }

    /// Takes a force by the dofs of the full module over to those that are kept.
    fn force(&self, total: Vec<f64>) -> SparseRow {
        match &self.condensed {
            None => SparseRow(total.into_iter().enumerate().filter(|e| e.1 != 0.0).collect()),
            Some(c) => {
                let t = &c.transformation;
                let column = |j: usize| total.iter().enumerate().map(|(i, v)| v * t[(i, j)]).sum::<f64>();
                SparseRow((0..t.ncols()).map(|j| (j, column(j))).collect())
            }
        }
    }

    /// Takes the heave by which the module follows a rise of the water of 1 m over to the dofs that are kept; `water` is its
    /// resultant upward. The forces on inner nodes move the fixed-master modes.
    fn afloat(&self, heave: &[f64], water: &SparseRow) -> Vec<f64> {
        let mut own = self.motion(heave);
        if let Some(condensed) = &self.condensed {
            for &(mode, force) in water.0.iter().filter(|(dof, _)| *dof >= condensed.masters.len()) {
                let stiffness = self
                    .k
                    .column(mode)
                    .filter(|(i, _)| *i == mode)
                    .map(|(_, k)| k)
                    .sum::<f64>();
                own[mode] = -force / stiffness;
            }
        }
        own
    }

    /// Takes a motion of the full module over to the dofs that are kept; fixed-master modes rest.
    fn motion(&self, motion: &[f64]) -> Vec<f64> {
        let mut own = vec![0.0; self.k.order()];
        for (i, place) in self.direct.iter().enumerate() {
            if let Some(place) = *place {
                own[place] = motion[i];
            }
        }
        own
    }
}

/// Rows that read heave, pitch and roll off the z of a module's wet bottom, `(Phi^T S Phi)^-1 Phi^T S`: the rigid motion nearest to
/// it, by the area's consistent matrix S. Phi is 1, `x_c - x` and y, about the middle of the length x_c. A module that is dry has none.
/// Equation (W4).
fn wet_motions(design: &BridgeDesign, grid: &Grid, mesh: &Mesh) -> [Vec<f64>; 3] {
    let middle_m = 0.5 * design.module.length_m;
    let shape = |node: NodeId| [1.0, middle_m - mesh.nodes[node.0].x, mesh.nodes[node.0].y];
    let area = spread(grid, design.wet_m(), 1.0, WaterDistribution::Consistent);
    let mut phi_s = [(); 3].map(|()| vec![0.0; mesh.dofs()]);
    let mut among = Matrix3::<f64>::zeros();
    for &(a, b, s) in &area {
        let (of_a, of_b) = (shape(a), shape(b));
        for i in 0..3 {
            phi_s[i][b.dof(Z)] += of_a[i] * s;
            for j in 0..3 {
                among[(i, j)] += of_a[i] * s * of_b[j];
            }
        }
    }
    let Some(inverse) = among.try_inverse() else {
        return [(); 3].map(|()| vec![0.0; mesh.dofs()]);
    };
    [0, 1, 2].map(|i| {
        let of_dof = |dof: usize| (0..3).map(|j| inverse[(i, j)] * phi_s[j][dof]).sum();
        (0..mesh.dofs()).map(of_dof).collect()
    })
}

/// Gives a unit heave of all nodes.
fn heave(mesh: &Mesh) -> Vec<f64> {
    (0..mesh.dofs()).map(|i| if i % 6 == Z { 1.0 } else { 0.0 }).collect()
}

/// Gives a unit roll of all nodes about the axis at a height `[m]`.
fn roll(mesh: &Mesh, middle_m: f64) -> Vec<f64> {
    (0..mesh.dofs())
        .map(|i| match (mesh.nodes[i / 6], i % 6) {
            (p, Z) => p.y,
            (p, Y) => middle_m - p.z,
            (_, 3) => 1.0,
            _ => 0.0,
        })
        .collect()
}

/// Gives unit surge, sway and yaw of all nodes about the left end's centre.
fn horizontal_rigid(mesh: &Mesh) -> [Vec<f64>; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|[surge, sway, yaw]| {
        (0..mesh.dofs())
            .map(|i| match (mesh.nodes[i / 6], i % 6) {
                (p, X) => surge - yaw * p.y,
                (p, Y) => sway + yaw * p.x,
                (_, 5) => yaw,
                _ => 0.0,
            })
            .collect()
    })
}

/// Masters of a module: hinges, connectors, the deck's z, z of the ends' bottom edges, and where asked of all bottom nodes.
fn masters(design: &BridgeDesign, grid: &Grid) -> Vec<usize> {
    let (nx, ny) = (grid.x.len(), grid.y.len());
    let mut masters = BTreeSet::new();
    for ix in [0, nx - 1] {
        for iy in design.hinge_lines_y_m().iter().filter_map(|&y| grid.y_line(y)) {
            masters.extend([X, Y, Z].map(|d| grid.bottom(ix, iy).dof(d)));
        }
        for iy in design.connectors.y_m.iter().filter_map(|&y| grid.y_line(y)) {
            masters.insert(grid.deck(ix, iy).dof(X));
            if design.condensation.end_masters {
                masters.insert(grid.bottom(ix, iy).dof(X));
            }
        }
    }
    for ix in 0..nx {
        for iy in 0..ny {
            masters.insert(grid.deck(ix, iy).dof(Z));
            if design.condensation.bottom_masters || ix == 0 || ix == nx - 1 {
                masters.insert(grid.bottom(ix, iy).dof(Z));
            }
        }
    }
    masters.into_iter().collect()
}
