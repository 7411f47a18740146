//! The step of all lanes (O5) to (O8), (C1), (R1), (R2).
//!
//! Knows the order of the parts, the same for every lane whatever is beside it. Does not know when a crossing ends.

use super::basis::BridgeOperator;
use super::crossings::{Crossings, Saved};
use super::energy::Terms;
use super::step_constants::StepConstants;
use super::vector::Ops;
use pulp::{Arch, Simd, WithSimd};

/// One step of all lanes that are at work, each to the time it was placed at.
struct Step<'a> {
    operator: &'a BridgeOperator,
    constants: &'a StepConstants,
    newton_limit: usize,
    crossings: &'a mut Crossings,
}

/// Steps every lane at work to where [`Crossings::place`] has put it. A lane whose contact does not settle stands as before
/// and says so by [`Crossings::unsettled`].
pub(crate) fn step(
    crossings: &mut Crossings,
    operator: &BridgeOperator,
    constants: &StepConstants,
    newton_limit: usize,
) {
    Arch::new().dispatch(Step {
        operator,
        constants,
        newton_limit,
        crossings,
    });
}

impl WithSimd for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (o, constants) = (Ops(simd), self.constants);
        let riding = self.crossings.any_mass();
        self.crossings.place_loads(self.operator);
        let unsettled = {
            let Crossings {
                modes,
                residual,
                connectors,
                loads,
                ..
            } = &mut *self.crossings;
            modes.predict(o, constants, loads, riding);
            residual.predict(o, constants, loads, connectors);
            connectors.try_elongations(o, constants, modes, residual);
            self.crossings
                .solve_contact(self.operator, constants, self.newton_limit)
        };
        let Crossings {
            modes,
            residual,
            connectors,
            loads,
            energy,
            envelope,
            lanes,
            ..
        } = &mut *self.crossings;
        let mut terms = Terms::new(o);
        connectors.apply(o, constants, modes);
        modes.correct(o, constants, &self.operator.omega2, loads, &mut terms);
        residual.correct(o, constants, loads, connectors, &mut terms);
        connectors.correct(o, constants, &mut terms);
        loads.end_step();
        energy.account(o, constants, &terms, connectors);
        envelope.update(
            o,
            self.operator,
            constants,
            (modes, residual, connectors, energy),
            lanes,
        );
        self.crossings.restore_all(unsettled);
    }
}

/// Lanes that did not settle, as they stood before the step.
pub(super) type Unsettled = Option<Vec<(usize, Saved)>>;
