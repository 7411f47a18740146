//! The step of all lanes (V1), (O6), (O7), (O4), (C1), (R1).
//!
//! Knows the order of the parts, the same for every lane whatever is beside it. Does not know when a crossing ends.

use super::basis::BridgeOperator;
use super::crossings::Crossings;
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
        let (o, operator, constants) = (Ops(simd), self.operator, self.constants);
        let c = self.crossings;
        c.place_loads(operator); // (V1)
        c.modes.predict(o, constants, &c.loads, c.any_mass()); // (O6)
        c.residual.predict(o, constants, &c.loads, &c.connectors); // (O7)
        c.connectors.predict(o, constants, &c.modes.d, c.residual.changes()); // (O4)
        let unsettled = c.solve_contact(operator, constants, self.newton_limit); // (C1), (C2)
        let mut terms = Terms::new(o);
        c.connectors.apply(o, constants, &mut c.modes.contact_now);
        c.modes.correct(o, operator, constants, &c.loads, &mut terms); // (O6)
        c.residual.correct(o, constants, &c.loads, &c.connectors, &mut terms); // (O7)
        c.connectors.correct(o, constants, &mut terms);
        c.loads.end_step();
        c.energy.account(o, constants, &terms, c.connectors.energy(o)); // (R1)
        c.update_envelope(o, operator, constants);
        c.restore_all(unsettled);
    }
}
