//! The operator of a bridge: modes and residual flexibilities, built once.
//!
//! Knows the bridge's matrices and rows. Does not know step lengths, vehicles or connector laws.

use super::columns::{ColumnSolver, SOLVED_AT_ONCE};
use super::cutoff::{Cutoff, CutoffJudge};
use super::pin_rows::{PinRows, pin_rows};
use super::residual_rows::{ResidualRows, dot, residual_of_deck};
use super::waves::{OperatorWaves, WaveStates};
use crate::bridge::{Bridge, ModulePlace, Track};
use crate::fem::{EigenPairs, Factor, FemError, ModeSearch, ONE_SEARCH, SparseRow, SymmetricMatrix};
use crate::radiation::RealisationError;
use crate::stop::Stop;
use faer::Mat;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::ops::Range;
use thiserror::Error;

/// Shift of eigenproblem and flexibilities `[1/s^2]`, the square of 0.1 Hz: a bridge that nothing holds along has an operator
/// as well. It changes residual flexibilities by less than `SHIFT / omega^2` of themselves, 1e-4 at 10 Hz.
const SHIFT: f64 = 0.4;

/// Fewest modes computed at first, and how many a module: most bridges need about this many.
const FIRST_MODES: usize = 64;
const FIRST_MODES_OF_MODULE: usize = 4;

/// Why a bridge has no operator.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum OperatorError {
    /// The bridge's matrices could not be factorised.
    #[error(transparent)]
    Factor(#[from] FemError),
    /// The water's memory has no states that could be used.
    #[error("water: {0}")]
    Waves(#[from] RealisationError),
}

/// What an operator follows beside positions, joints and corners.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Followed {
    /// Whether it knows the forces of pins; it is smaller without.
    pub pins: bool,
    /// Places along the bridge `[m]`.
    pub places_x_m: Vec<f64>,
}

/// Numbers of rows and columns that all parts share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Sizes {
    /// Modes m.
    pub modes: usize,
    /// Links: connectors, then springs of banks.
    pub connectors: usize,
    /// How many of these are connectors.
    pub joint_connectors: usize,
    /// Observed rows that are followed through every step.
    pub observed: usize,
    /// Stations of the deck's edges inside modules, of all modules.
    pub inside: usize,
    /// Modules.
    pub modules: usize,
    /// Rows of pins; none where they are not followed.
    pub pins: usize,
}

impl Sizes {
    /// Columns of a deck row: modes, connectors, observed rows, edges inside modules, pins.
    pub(super) fn influence(&self) -> usize {
        self.before_pins() + self.pins
    }

    /// Of these the ones before the pins.
    pub(super) fn before_pins(&self) -> usize {
        self.followed() + self.inside
    }

    /// Of these the ones that are followed through every step.
    pub(super) fn followed(&self) -> usize {
        self.modes + self.connectors + self.observed
    }
}

/// Where the observed rows stand among each other: positions, deck corners, bottom corners, places, springs of banks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Observed {
    pub positions: usize,
    /// Corners at each end of a module: 2, or 1 of one side, whose corners stand for those of both edges.
    pub edges: usize,
    pub corners: usize,
    pub bottom_corners: usize,
    pub places: usize,
    pub springs: usize,
}

/// What an operator knows of a module.
#[derive(Debug, Clone)]
pub(super) struct OperatedModule {
    /// Rows of its edges among those inside all modules.
    pub inside: Range<usize>,
    /// Place of each of its stations but those at its ends, 0 to 1, and the position of its nearer end.
    pub places: Vec<f64>,
    pub nearer: Vec<usize>,
    /// Length `[m]`.
    pub length_m: f64,
    /// How much its draft and its freeboard are above the least of a module `[m]`; without bound where it has none.
    pub draft_beyond_m: f64,
    pub freeboard_beyond_m: f64,
}

/// Modes of the connector-free bridge up to a cut-off and the residual flexibilities among connectors, deck and observed
/// rows. Independent of gaps, connector stiffness, damping, speed, load and vehicle; shared read-only.
///
/// `R_ab = a K^-1 b^T - sum of (a phi)(b phi) / omega^2` (O3).
/// Equation (O1).
#[derive(Debug, Clone)]
pub struct BridgeOperator {
    pub(super) sizes: Sizes,
    pub(super) rows: Observed,
    pub(super) cutoff: Cutoff,
    /// omega^2 of each mode, and what the water's springs have of it.
    pub(super) omega2: Vec<f64>,
    pub(super) omega2_water: Vec<f64>,
    /// `B Phi`, connectors x modes.
    pub(super) b: DMatrix<f64>,
    /// `R_BB`, symmetric to the last bit.
    pub(super) r_bb: DMatrix<f64>,
    /// `V Phi`, observed x modes.
    pub(super) v: DMatrix<f64>,
    /// `R_VB`, observed x connectors.
    pub(super) r_vb: DMatrix<f64>,
    /// Edges inside modules, measured from the straight line between the module's corners, on the modes.
    pub(super) inside: DMatrix<f64>,
    /// Residual of these edges with connectors, `R_DB`.
    pub(super) r_inside_b: DMatrix<f64>,
    /// For each module the largest `sqrt(sum of phi^2 / omega^2)`, `sqrt(R)` and influence of the deck on these rows.
    pub(super) inside_bounds: Vec<[f64; 3]>,
    /// Where each module's rows stand among these.
    pub(super) of_modules: Vec<OperatedModule>,
    /// The pins, where they are followed.
    pub(super) pins: PinRows,
    /// Water with memory, where the bridge has it.
    pub(super) waves: Option<OperatorWaves>,
    /// For each track column its influence: `phi`, `R_BL`, `R_VL`, residual at the edges inside modules, at the pins.
    pub(super) deck: Vec<f64>,
    /// Residual flexibility of the deck's nodes among each other, for each track column every line at the stations not
    /// farther than [`BridgeOperator::near`]; farther ones are left out.
    pub(super) r_deck: Vec<f64>,
    /// Most stations of a module.
    pub(super) near: usize,
    pub(super) track: Track,
    pub(super) breadth_m: f64,
}

impl BridgeOperator {
    /// Builds the operator; modes are added until the residual's dynamic part is within `tolerance` (see [`Cutoff`]), every
    /// mode there is where it is 0. Verified by `tests/solvers/operator.rs` and `tests/solvers/operator_accuracy.rs`.
    ///
    /// # Errors
    /// [`OperatorError::Factor`].
    pub fn new(bridge: &Bridge, tolerance: f64) -> Result<Self, OperatorError> {
        Self::new_unless(bridge, tolerance, &Followed::default(), Stop::never())
    }

    /// Builds the operator, with what is followed beside, unless a stop is asked for.
    ///
    /// # Errors
    /// As [`BridgeOperator::new`], and [`FemError::Stopped`].
    pub fn new_unless(
        bridge: &Bridge,
        tolerance: f64,
        followed: &Followed,
        stop: Stop<'_>,
    ) -> Result<Self, OperatorError> {
        let factor = Factor::new("K + s M of the operator", &shifted(bridge)?)?;
        let track = Track::new(bridge);
        let judged = judged_rows(bridge, &track);
        let solver = ColumnSolver::new(&factor, stop);
        let of_modules = FIRST_MODES_OF_MODULE * bridge.design().modules;
        let first = of_modules.clamp(FIRST_MODES, ONE_SEARCH).min(bridge.dofs());
        let (judge, search) = rayon::join(
            || judge(&solver, &judged, &bridge.m),
            || ModeSearch::new(&bridge.k, &bridge.m, first, SHIFT, stop),
        );
        let (mut judge, mut search) = (judge?, search?);
        loop {
            let pairs = search.pairs();
            judge.shapes = Mat::from_fn(judged.len(), pairs.lambda.len(), |i, k| {
                dot(&judged[i], &pairs.shapes, k)
            });
            match judge.fewest(pairs, SHIFT, tolerance) {
                Ok(cutoff) => return Self::of(bridge, track, &solver, (pairs, cutoff), followed, stop),
                // every mode there is: nothing is left out but rounding
                Err(cutoff) if pairs.lambda.len() >= bridge.dofs() => {
                    return Self::of(bridge, track, &solver, (pairs, cutoff), followed, stop);
                }
                Err(_) => search.extend()?,
            }
        }
    }

    /// The operator with the modes that a cut-off keeps.
    fn of(
        bridge: &Bridge,
        track: Track,
        solver: &ColumnSolver<'_>,
        (pairs, cutoff): (&EigenPairs, Cutoff),
        followed: &Followed,
        stop: Stop<'_>,
    ) -> Result<Self, OperatorError> {
        let (m, design, shapes) = (cutoff.modes, bridge.design(), &pairs.shapes);
        let lambda = &pairs.lambda[..m];
        let connectors: Vec<SparseRow> = bridge.links.iter().map(|c| c.row.clone()).collect();
        let (rows, observed) = observed(bridge, &followed.places_x_m);
        let of_modules = operated_modules(bridge);
        let inside = inside(bridge, &of_modules);
        let mut sizes = Sizes {
            modes: m,
            connectors: connectors.len(),
            joint_connectors: bridge.joint_connectors,
            observed: observed.len(),
            inside: inside.len(),
            modules: design.modules,
            pins: 0,
        };
        let (nc, nv, ni) = (connectors.len(), observed.len(), inside.len());
        let all = ResidualRows::new(
            solver,
            [connectors, observed, inside].concat(),
            (lambda, SHIFT),
            shapes,
            stop,
        )?;
        let mut deck = all.deck(&track)?;
        let inside_bounds = inside_bounds(&all, lambda, (&sizes, &of_modules), &deck);
        let mut pins = PinRows::default();
        if followed.pins {
            let (rows, of_deck) = pin_rows(bridge, solver, &track, (lambda, SHIFT), (shapes, &all), stop)?;
            let width = sizes.influence();
            sizes.pins = rows.stiffness.nrows();
            deck = beside(&deck, width, &of_deck, sizes.pins);
            pins = rows;
        }
        let waves = match &bridge.waves {
            Some(waves) => Some(OperatorWaves::new(bridge, waves, (shapes, m), followed.pins)?),
            None => None,
        };
        let near = track.most_stations();
        let r_bb = all.among(0, nc, 0, nc);
        Ok(Self {
            sizes,
            rows,
            cutoff,
            omega2: lambda.to_vec(),
            omega2_water: water_of_modes(bridge, shapes, m),
            waves,
            r_bb: DMatrix::from_fn(nc, nc, |i, j| r_bb[(i.min(j), i.max(j))]),
            r_vb: all.among(nc, nv, 0, nc),
            r_inside_b: all.among(nc + nv, ni, 0, nc),
            inside_bounds,
            pins,
            r_deck: residual_of_deck(solver, &track, shapes, (lambda, SHIFT), near)?,
            near,
            breadth_m: design.module.breadth_m,
            b: all.phi.rows(0, nc).into_owned(),
            v: all.phi.rows(nc, nv).into_owned(),
            inside: all.phi.rows(nc + nv, ni).into_owned(),
            of_modules,
            deck,
            track,
        })
    }

    /// What was left out.
    pub fn cutoff(&self) -> Cutoff {
        self.cutoff
    }

    /// The states of water with memory; none of other waters.
    pub fn wave_states(&self) -> Option<WaveStates> {
        self.waves.as_ref().map(OperatorWaves::told)
    }

    /// Number of modes.
    pub(crate) fn modes(&self) -> usize {
        self.sizes.modes
    }

    /// Number of connectors.
    pub(crate) fn connectors(&self) -> usize {
        self.sizes.connectors
    }

    /// R of two track columns.
    pub(super) fn residual(&self, column: usize, other: usize) -> f64 {
        let (lines, stations) = (self.track.lines(), self.track.stations());
        let (s, t) = (column % stations, other % stations);
        if s.abs_diff(t) > self.near {
            return 0.0;
        }
        self.r_deck[(column * lines + other / stations) * (2 * self.near + 1) + t + self.near - s]
    }

    /// The influence of a track column: `phi`, `R_BL`, `R_VL`, residual at the edges inside modules.
    pub(super) fn influence(&self, column: usize) -> &[f64] {
        let width = self.sizes.influence();
        &self.deck[column * width..][..width]
    }
}

/// What the water's springs have of omega^2 of the first `modes`, `phi^T K_w phi`.
fn water_of_modes(bridge: &Bridge, shapes: &Mat<f64>, modes: usize) -> Vec<f64> {
    let mut pressed = vec![0.0; bridge.dofs()];
    let of_mode = |k: usize| {
        let shape: Vec<f64> = shapes.col(k).iter().copied().collect();
        bridge.times_k_water.multiply(&shape, &mut pressed);
        shape.iter().zip(&pressed).map(|(u, f)| u * f).sum()
    };
    (0..modes).map(of_mode).collect()
}

/// Two tables side by side, of so many columns each.
fn beside(left: &[f64], width: usize, right: &[f64], more: usize) -> Vec<f64> {
    if more == 0 {
        return left.to_vec();
    }
    let rows = left.chunks_exact(width).zip(right.chunks_exact(more));
    rows.flat_map(|(left, right)| left.iter().chain(right))
        .copied()
        .collect()
}

/// Bounds of the edges inside each module, see [`BridgeOperator::inside_bounds`].
fn inside_bounds(
    all: &ResidualRows<'_>,
    lambda: &[f64],
    (sizes, modules): (&Sizes, &[OperatedModule]),
    deck: &[f64],
) -> Vec<[f64; 3]> {
    let first = sizes.connectors + sizes.observed;
    let modal = |i: usize| {
        let of_mode = |(k, lambda): (usize, &f64)| all.phi[(first + i, k)].powi(2) / lambda.max(1.0);
        lambda.iter().enumerate().map(of_mode).sum::<f64>()
    };
    let of_module = |module: &OperatedModule| {
        let own = module.inside.clone();
        let influence = deck
            .chunks_exact(sizes.influence())
            .flat_map(|r| &r[sizes.followed()..][own.clone()]);
        let residual = own.clone().map(|i| all.own(first + i));
        [
            own.clone().map(modal).fold(0.0, f64::max).sqrt(),
            residual.fold(0.0, f64::max).sqrt(),
            influence.fold(0.0, |most, r| r.abs().max(most)),
        ]
    };
    modules.iter().map(of_module).collect()
}

/// The rows that are followed through every step: positions, deck corners, where a draft is given bottom corners, places,
/// springs of banks.
fn observed(bridge: &Bridge, places_x_m: &[f64]) -> (Observed, Vec<SparseRow>) {
    let bottom: &[SparseRow] = if bridge.least_draft_m().is_some() {
        &bridge.bottom_corners
    } else {
        &[]
    };
    let rows = Observed {
        positions: bridge.positions.len(),
        edges: 2,
        corners: bridge.deck_corners.len(),
        bottom_corners: bottom.len(),
        places: places_x_m.len(),
        springs: bridge.springs.len(),
    };
    let springs: Vec<SparseRow> = bridge.springs.iter().map(|spring| spring.row.clone()).collect();
    let places: Vec<SparseRow> = places_x_m.iter().map(|&x_m| bridge.place(x_m)).collect();
    let parts: [&[SparseRow]; 5] = [&bridge.positions, &bridge.deck_corners, bottom, &places, &springs];
    (rows, parts.concat())
}

/// `K + SHIFT M`.
fn shifted(bridge: &Bridge) -> Result<SymmetricMatrix, FemError> {
    SymmetricMatrix::combine(&[(1.0, &bridge.k), (SHIFT, &bridge.m)])
}

/// The flexibilities of the judge's rows, which know no modes yet.
fn judge(solver: &ColumnSolver<'_>, rows: &[SparseRow], m: &SymmetricMatrix) -> Result<CutoffJudge, FemError> {
    let of_block = |rows: &[SparseRow]| {
        solver.read(rows, |columns| {
            let columns: Vec<&[f64]> = columns.chunks_exact(solver.order()).collect();
            let whole = rows.iter().zip(&columns).map(|(row, x)| row.dot(x));
            whole.zip(m.forms(&columns)).collect::<Vec<_>>()
        })
    };
    let blocks = rows.par_chunks(SOLVED_AT_ONCE).map(of_block);
    let blocks: Vec<Vec<(f64, f64)>> = blocks.collect::<Result<_, _>>()?;
    let (flexibility, dynamic) = blocks.into_iter().flatten().unzip();
    Ok(CutoffJudge {
        flexibility,
        dynamic,
        shapes: Mat::zeros(0, 0),
    })
}

/// Connectors, and the deck's nodes at every other station on edges and centre.
fn judged_rows(bridge: &Bridge, track: &Track) -> Vec<SparseRow> {
    let mut rows: Vec<SparseRow> = bridge.links.iter().map(|c| c.row.clone()).collect();
    let (lines, stations) = (track.lines(), track.stations());
    for line in [0, lines / 2, lines - 1] {
        let of_line = (0..stations).step_by(2).map(|s| track.dof(line * stations + s));
        rows.extend(of_line.map(|dof| SparseRow(vec![(dof, 1.0)])));
    }
    rows
}

/// Where the rows of each module stand, and what it has beyond other modules.
pub(super) fn operated_modules(bridge: &Bridge) -> Vec<OperatedModule> {
    let (draft_m, freeboard_m) = (bridge.least_draft_m(), bridge.least_freeboard_m());
    let beyond =
        |own: Option<f64>, least: Option<f64>| own.zip(least).map_or(f64::INFINITY, |(own, least)| own - least);
    let (mut end, mut station) = (0, 0);
    let module = |of: &ModulePlace| {
        let between = &of.lines_x[1..of.lines_x.len() - 1];
        let first = end;
        end += 2 * between.len();
        let own = &bridge.edges[2 * station..][..2 * of.lines_x.len()];
        station += of.lines_x.len();
        let nearer = own.chunks_exact(2).map(|edges| edges[0].0);
        OperatedModule {
            inside: first..end,
            places: between.iter().map(|x| x / of.length_m).collect(),
            nearer: nearer.skip(1).take(between.len()).collect(),
            length_m: of.length_m,
            draft_beyond_m: beyond(of.draft_m, draft_m),
            freeboard_beyond_m: beyond(of.freeboard_m, freeboard_m),
        }
    };
    bridge.modules.iter().map(module).collect()
}

/// Stations of the deck's edges inside modules, module after module, right and left edge in turn, each measured from the
/// straight line between its module's corners.
fn inside(bridge: &Bridge, modules: &[OperatedModule]) -> Vec<SparseRow> {
    let (mut rows, mut first) = (Vec::new(), 0);
    for module in modules {
        let last = module.places.len() + 1;
        for (ix, place) in (1..).zip(&module.places) {
            for side in 0..2 {
                let edge = |ix: usize| &bridge.edges[2 * (first + ix) + side].1;
                let straight = [(place - 1.0, edge(0)), (-place, edge(last)), (1.0, edge(ix))];
                rows.push(SparseRow::combine(&straight));
            }
        }
        first += last + 1;
    }
    rows
}
