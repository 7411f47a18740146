//! A load that creeps over the bridge: the largest static deflections over all its places.
//!
//! Knows what a vehicle of unit weight at each place does to connectors and positions, which is all that its cases share.
//! Does not know the bridge's dofs.

use super::{NEWTON_LIMIT, StaticCase, brought_on};
use crate::analysis::AnalysisError;
use crate::bridge::{Bridge, BridgeDesign, Heading, Load};
use crate::contact::{WarmContact, rest_force_n};
use crate::flexibility::Flexibility;
use crate::module::ModuleDesign;
use crate::vehicle::Vehicle;
use nalgebra::DMatrix;

/// One vehicle on one bridge, made ready for cases of any connection and weight. Shared read-only between jobs and threads.
#[derive(Debug, Clone)]
pub struct CreepingLoad {
    /// Places of the vehicle's centre `[m]`.
    places_m: Vec<f64>,
    /// Of a vehicle of weight 1 N at each place: shortening of each connector and below them deflection of each position,
    /// no connector at work `[m/N]`.
    unit: DMatrix<f64>,
    /// Flexibility among the connectors `[m/N]`.
    among: DMatrix<f64>,
    /// What each position sees of unit forces at the connectors, positions x connectors `[m/N]`.
    positions: DMatrix<f64>,
}

impl CreepingLoad {
    /// Folds the track's `influence` on connectors and positions into places a quarter of an element apart.
    pub(super) fn new(bridge: &Bridge, flexibility: &Flexibility, influence: &DMatrix<f64>, vehicle: &Vehicle) -> Self {
        let design = bridge.design();
        let places_m = places_m(design);
        let weight_alone = vehicle.standing();
        let mut unit = DMatrix::zeros(influence.nrows(), places_m.len());
        for (&x, mut unit) in places_m.iter().zip(unit.column_iter_mut()) {
            let load = Load::new(
                flexibility.track(),
                &weight_alone,
                1.0,
                Heading::standing(x - vehicle.centre_ahead_m()),
            );
            for &(column, force) in &load.weight.0 {
                unit.axpy(force, &influence.column(column), 1.0);
            }
        }
        let seen: Vec<f64> = bridge
            .positions
            .iter()
            .flat_map(|row| flexibility.observe_connectors(row))
            .collect();
        Self {
            places_m,
            unit,
            among: flexibility.among_connectors().clone(),
            positions: DMatrix::from_row_slice(bridge.positions.len(), bridge.links.len(), &seen),
        }
    }

    /// Largest static deflection of each position over all places `[m]`; `load_x_m` of the case is not used. The contact at
    /// each place starts from the states at the place before: the law nowhere falls and the flexibility is positive, so
    /// that there is one solution and any start that settles has found it.
    ///
    /// # Errors
    /// [`AnalysisError::StaticNotConverged`].
    ///
    /// Verified by `tests/limits/creeping.rs`.
    pub fn peaks_m(&self, case: &StaticCase) -> Result<Vec<f64>, AnalysisError> {
        self.peaks_within(case, NEWTON_LIMIT)
    }

    /// The peaks, the load brought on in parts wherever `limit` Newton solutions from the last place do not settle.
    fn peaks_within(&self, case: &StaticCase, limit: usize) -> Result<Vec<f64>, AnalysisError> {
        let nc = self.among.nrows();
        let laws = case.laws(nc);
        let dead = case.dead.as_deref();
        let mut contact = WarmContact::new(&self.among, laws.clone(), dead);
        let mut e_free = vec![0.0; nc];
        let mut deflections = vec![0.0; self.positions.nrows()];
        let mut peaks = vec![0.0_f64; self.positions.nrows()];
        for (&x, unit) in self.places_m.iter().zip(self.unit.column_iter()) {
            let (shortenings, direct) = unit.as_slice().split_at(nc);
            scale(&mut e_free, -case.load_n, shortenings);
            scale(&mut deflections, case.load_n, direct);
            if contact.solve(&e_free, limit).is_err() {
                let unsettled = |iterations| AnalysisError::StaticNotConverged {
                    iterations,
                    load_x_m: x,
                };
                contact.restart(&brought_on(&self.among, &laws, dead, &e_free).map_err(unsettled)?);
            }
            for (i, (force, seen)) in contact.forces().iter().zip(self.positions.column_iter()).enumerate() {
                let force = force - rest_force_n(dead, i);
                if force != 0.0 {
                    for (w, s) in deflections.iter_mut().zip(seen.iter()) {
                        *w += force * s;
                    }
                }
            }
            for (peak, &w) in peaks.iter_mut().zip(&deflections) {
                *peak = peak.max(w);
            }
        }
        Ok(peaks)
    }
}

/// `to := factor * from`.
fn scale(to: &mut [f64], factor: f64, from: &[f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = factor * from;
    }
}

/// Places a quarter of an element apart `[m]`: of modules that are not alike a quarter of each one's own.
fn places_m(design: &BridgeDesign) -> Vec<f64> {
    let boxes = design.boxes();
    let parts = |module: &ModuleDesign| 4 * module.mesh.elements_along;
    let alike =
        |a: &ModuleDesign, b: &ModuleDesign| a.length_m.to_bits() == b.length_m.to_bits() && parts(a) == parts(b);
    if boxes.windows(2).all(|pair| alike(pair[0], pair[1])) {
        let last: usize = boxes.iter().map(|module| parts(module)).sum();
        let length_m = design.length_m();
        return (0..=last).map(|place| length_m * place as f64 / last as f64).collect();
    }
    let ends_m = design.positions_m();
    let of_module = |(ends, module): (&[f64], &&ModuleDesign)| {
        let (left_m, step_m, parts) = (ends[0], (ends[1] - ends[0]) / parts(module) as f64, parts(module));
        (0..parts)
            .map(move |place| left_m + step_m * place as f64)
            .collect::<Vec<_>>()
    };
    let places = ends_m.windows(2).zip(&boxes).flat_map(of_module);
    places.chain(ends_m.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use crate::analysis::statics::{StaticCase, StaticSolver};
    use crate::bridge::{Bridge, Ends, Model, PreparedModule};
    use crate::connector::Connection;
    use crate::vehicle::VehicleDesign;
    use std::sync::Arc;

    /// With one Newton solution allowed from the place before, every change of a state is found with the load brought on in
    /// parts; the answer is the same to rounding.
    #[test]
    fn load_brought_on_in_parts_finds_the_same() {
        let text = include_str!("../../../../../studies/bridges/smoke.json");
        let design = serde_json::from_str(text).expect("a design");
        let module = PreparedModule::new(&design, Model::SuperElement).expect("a module");
        let bridge = Arc::new(Bridge::new(&design, &module, Ends::Supported).expect("a bridge"));
        let vehicle = VehicleDesign::default()
            .check(design.module.breadth_m)
            .expect("a vehicle");
        let load = StaticSolver::new(&bridge).expect("statics").creeping(&vehicle);
        let case = |factor: f64| StaticCase {
            connection: Connection::Nonlinear {
                gap_tension_m: 0.001,
                gap_compression_m: 0.0005,
            },
            connector_stiffness_n_m: factor * design.connectors.stiffness_n_m,
            own_laws: [].into(),
            load_n: 230_300.0,
            load_x_m: 0.0,
            places_x_m: Vec::new(),
            dead: None,
        };
        let apart = |factor: f64| {
            let [warm, cold] =
                [load.peaks_m(&case(1.0)), load.peaks_within(&case(factor), 1)].map(|p| p.expect("solved"));
            warm.iter().zip(&cold).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(apart(1.0) < 1e-13, "{:e} m apart", apart(1.0));
        assert!(apart(1.05) > 1e-13, "trusses of the wrong stiffness pass");
    }
}
