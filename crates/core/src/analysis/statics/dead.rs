//! The dead state: the equilibrium that a bridge finds under its dead load, without a vehicle.
//!
//! Knows which forces act and that what nothing linear holds is held by links alone. Does not know vehicles or motion.

use super::{Rest, StaticSolver, brought_on};
use crate::analysis::{AnalysisError, DeadFault};
use crate::bridge::{Acting, Bridge, BridgeDesign, HeldDof, LinkPlace, ModulePlace, PinPlace, SpringPlace};
use crate::connector::{Connection, OwnLaws};
use crate::contact::{ContactSolution, LinkLaw};
use crate::fem::SparseRow;
use crate::response::{DeadState, Equilibrium, ModuleAtRest};
use std::sync::Arc;

/// The laws under which a bridge rests, and its river.
#[derive(Debug, Clone, PartialEq)]
pub struct DeadCase {
    /// How the connectors work.
    pub connection: Connection,
    /// Stiffness of one truss `[N/m]`.
    pub connector_stiffness_n_m: f64,
    /// Connectors that have laws of their own in place of these.
    pub own_laws: OwnLaws,
    /// How much the river has risen `[m]`.
    pub water_level_m: f64,
}

impl DeadCase {
    /// That of a bridge's design, with laws as [`BridgeDesign::own_laws`] has them.
    pub fn new(design: &BridgeDesign, connection: Connection, own_laws: OwnLaws) -> Self {
        Self {
            connection,
            connector_stiffness_n_m: design.connectors.stiffness_n_m,
            own_laws,
            water_level_m: design.risen_m(),
        }
    }
}

/// Solves `K u_0 + B^T N(B u_0) = f_dead`; none where no dead load acts and no link presses by itself.
///
/// # Errors
/// [`AnalysisError::NoDeadState`] where the contact does not settle, nothing holds the bridge or a deck lies under water.
/// Equation (D1).
pub(super) fn dead_state(solver: &StaticSolver, case: &DeadCase) -> Result<Option<Arc<DeadState>>, AnalysisError> {
    let bridge = &*solver.bridge;
    let laws = LinkLaw::connectors(
        bridge.links.len(),
        case.connector_stiffness_n_m,
        case.connection,
        &case.own_laws,
    );
    let level_m = case.water_level_m;
    if bridge.dead_n[0].0.is_empty() && level_m == 0.0 && laws.iter().all(|law| law.force(0.0) == 0.0) {
        return Ok(None);
    }
    let mut u_free = vec![0.0; bridge.dofs()];
    for (factor, row) in [1.0, level_m].into_iter().zip(&bridge.dead_n) {
        row.add_to(factor, &mut u_free);
    }
    solver.flexibility.solve(&mut u_free);
    let unsettled = |iterations| AnalysisError::NoDeadState(DeadFault::NotSettled { iterations });
    let (contact, u) = solver
        .held(&u_free, |e_free| {
            brought_on(solver.flexibility.among_connectors(), &laws, None, e_free).map_err(unsettled)
        })?
        .ok_or(AnalysisError::NoDeadState(DeadFault::NotHeld))?;
    let state = told(bridge, level_m, &contact, u);
    check_afloat(bridge, &state)?;
    Ok(Some(Arc::new(state)))
}

/// What there is to tell of a dead state.
fn told(bridge: &Bridge, level_m: f64, contact: &ContactSolution, u: Vec<f64>) -> DeadState {
    let at = |[lies, water]: [f64; 2]| lies + level_m * water;
    let pin = |pin: &PinPlace| {
        pin.rows.each_ref().map(|row| {
            row.force_n(&Acting {
                elastic: &u,
                ..Acting::default()
            }) - at(row.dead_n)
        })
    };
    let pins_n: Vec<[f64; 3]> = bridge.pins.iter().map(pin).collect();
    let reading = Rest {
        bridge,
        u: &u,
        contact,
        pins_n: &pins_n,
        dead: None,
    };
    let parts = bridge.bank_parts().into_iter();
    let banks = parts
        .map(|part| (part.bank, part.y_m, part.force_n(&reading)))
        .collect();
    let risen = |rows: &[SparseRow]| rows.iter().map(|row| row.dot(&u) - level_m).collect();
    DeadState {
        elongations_m: contact.elongations.clone(),
        forces_n: contact.forces.clone(),
        springs_m: bridge.springs.iter().map(|spring| spring.row.dot(&u)).collect(),
        // nothing is 0, not -0
        deflection_m: bridge.positions.iter().map(|row| 0.0 - row.dot(&u)).collect(),
        deck_corners_m: risen(&bridge.deck_corners),
        bottom_corners_m: risen(&bridge.bottom_corners),
        modules: modules_at_rest(bridge, &u),
        banks,
        equilibrium: dead_equilibrium(bridge, level_m, contact, &u),
        pins_n,
        displacements: u,
    }
}

/// Resultants of what acts on the bridge at rest.
fn dead_equilibrium(bridge: &Bridge, level_m: f64, contact: &ContactSolution, u: &[f64]) -> Equilibrium {
    let mut result = Equilibrium {
        load: bridge.dead_resultants,
        ..Equilibrium::default()
    };
    for (i, water) in result.water.iter_mut().enumerate() {
        *water = bridge.water[i].dot(u) + level_m * bridge.risen_water[i] + bridge.dry_water[i];
    }
    add_holding(bridge, &mut result, u, &contact.forces, |held| {
        held.dead_n[0] + level_m * held.dead_n[1]
    });
    result
}

/// Adds what supports and banks do in a motion `u` with forces of links; `dead_n` is the dead load on a held dof.
pub(super) fn add_holding(
    bridge: &Bridge,
    to: &mut Equilibrium,
    u: &[f64],
    forces_n: &[f64],
    dead_n: impl Fn(&HeldDof) -> f64,
) {
    for held in bridge.held.iter().filter(|held| held.vertical) {
        super::add_force(&mut to.supports, held.row.dot(u) - dead_n(held), held.x_m, held.y_m);
    }
    let links = bridge.links.iter().zip(forces_n);
    for (at, force) in links.filter_map(|(link, force)| Some((bridge.vertical_bank(link.place)?, *force))) {
        super::add_force(&mut to.banks, 0.0 - at.sense * force, at.x_m, at.y_m);
    }
    for spring in &bridge.springs {
        let SpringPlace { bank, y_m, .. } = *spring;
        if let Some(at) = bridge.vertical_bank(LinkPlace::Bank { bank, y_m }) {
            let force = spring.stiffness_n_m * spring.row.dot(u);
            super::add_force(&mut to.banks, 0.0 - at.sense * force, at.x_m, at.y_m);
        }
    }
}

/// Each module's sinkage, trim and heel, from the corners of its deck.
fn modules_at_rest(bridge: &Bridge, u: &[f64]) -> Vec<ModuleAtRest> {
    let breadth_m = bridge.design().module.breadth_m;
    let corners = bridge.deck_corners.chunks_exact(4);
    let of_module = |(module, corners): (&ModulePlace, &[SparseRow])| {
        let z: Vec<f64> = corners.iter().map(|row| row.dot(u)).collect();
        let mean = |[a, b]: [usize; 2]| 0.5 * (z[a] + z[b]);
        ModuleAtRest {
            sinkage_m: 0.0 - 0.25 * z.iter().sum::<f64>(),
            trim_rad: (mean([2, 3]) - mean([0, 1])) / module.length_m,
            heel_rad: (mean([1, 3]) - mean([0, 2])) / breadth_m,
        }
    };
    bridge.modules.iter().zip(corners).map(of_module).collect()
}

/// Refuses a rest in which a corner of a deck lies under water: linear water would hold what has sunk.
fn check_afloat(bridge: &Bridge, state: &DeadState) -> Result<(), AnalysisError> {
    for (number, (module, corners)) in (1..).zip(bridge.modules.iter().zip(state.deck_corners_m.chunks_exact(4))) {
        let Some(freeboard_m) = module.freeboard_m else {
            continue;
        };
        let lowest_m = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let under_m = -(freeboard_m + lowest_m);
        if under_m > 0.0 {
            return Err(AnalysisError::NoDeadState(DeadFault::Sinks {
                module: number,
                under_m,
            }));
        }
    }
    Ok(())
}
