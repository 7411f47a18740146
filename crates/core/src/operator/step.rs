//! The step of all lanes (V1), (O6), (O7), (O4), (C1), (R1).
//!
//! Knows the order of the parts, the same for every lane whatever is beside it. Does not know when a crossing ends.

use super::basis::BridgeOperator;
use super::clock::{StepClock, StepPart};
use super::crossings::Crossings;
use super::step_constants::StepConstants;
use super::vector::Ops;
use pulp::{Arch, Simd, WithSimd};

/// One step of all lanes that are at work, each to the time it was placed at.
struct Step<'a, C> {
    operator: &'a BridgeOperator,
    constants: &'a StepConstants,
    newton_limit: usize,
    crossings: &'a mut Crossings,
    clock: &'a mut C,
}

/// Steps every lane at work to where [`Crossings::place`] has put it. A lane whose contact does not settle stands as before
/// and says so by [`Crossings::unsettled`].
pub(crate) fn step<C: StepClock>(
    crossings: &mut Crossings,
    operator: &BridgeOperator,
    constants: &StepConstants,
    newton_limit: usize,
    clock: &mut C,
) {
    Arch::new().dispatch(Step {
        operator,
        constants,
        newton_limit,
        crossings,
        clock,
    });
}

impl<C: StepClock> WithSimd for Step<'_, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (o, operator, constants) = (Ops(simd), self.operator, self.constants);
        let (c, clock) = (self.crossings, self.clock);
        clock.begin();
        c.place_loads(o, operator); // (V1)
        clock.lap(StepPart::Loads, || c.flop_of_loads());
        if let Some(waves) = &mut c.waves {
            waves.predict(o, constants); // (W7)
            clock.lap(StepPart::Waves, || 0.0);
        }
        let masses = c.any_mass();
        let waves = c.waves.as_ref().map(|waves| &waves.modal);
        c.modes.predict(o, constants, (&c.loads, waves), masses); // (O6)
        clock.lap(StepPart::Modes, || c.modes.flop_of_prediction());
        c.residual.predict(o, constants, &c.loads, &c.connectors); // (O7)
        c.connectors.predict(o, constants, &c.modes.d, c.residual.changes()); // (O4)
        clock.lap(StepPart::Residual, || c.residual.flop_of_prediction(c.modes.count()));
        let unsettled = c.solve_contact(o, (operator, constants, self.newton_limit), clock); // (C1), (C2)
        let terms = c.correct(o, operator, constants, clock); // (O6), (O7)
        let ridden = c.lanes.iter().map(|lane| lane.ridden);
        c.energy
            .take_rides(c.lanes.iter().any(|lane| !lane.rides.is_empty()), ridden);
        c.energy.account(o, constants, &terms, c.connectors.energy(o)); // (R1)
        clock.lap(StepPart::Accounting, || 2.0 * c.connectors.count() as f64);
        c.update_envelope(o, operator, constants);
        c.update_pins(o, operator, constants); // (O9)
        clock.lap(StepPart::ObservedRows, || c.flop_of_observed());
        c.restore_all(unsettled);
    }
}
