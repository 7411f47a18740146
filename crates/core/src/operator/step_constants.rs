//! What one step length makes of an operator.
//!
//! Knows the scheme, damping, and the small flexibilities of a step. Does not know gaps, speeds or loads.

use super::basis::{BridgeOperator, OperatedModule};
use super::corner_panel::CornerPanel;
use super::panel::Panel;
use super::waves::WaveConstants;
use crate::riding::RidingStep;
use crate::scheme::{Arithmetic, Rayleigh, Scheme};
use crate::vehicle::Springs;
use nalgebra::DMatrix;
use std::sync::Arc;

/// Constants of a step, one a mode where they are lists. With `d = q_1 - q_0`, a mode steps by
///
/// `d = on_q q_0 + on_v v_0 + on_a a_0 + c f`, `c = 1 / ((1 - alpha_m) c_a + (1 - alpha_f) (c_v (a omega^2 + b) + omega^2))`,
///
/// f the forces in the balance at alpha; what the modes leave out by the same rule without mass, stiffness 1 and damping a:
/// `ds = rho (f - s_0 - on_s1 s'_0 - on_s2 s''_0)`.
#[derive(Debug)]
pub(crate) struct StepConstants {
    pub(super) scheme: Scheme,
    pub(super) rayleigh: Rayleigh,
    pub(super) c: Vec<f64>,
    pub(super) on_q: Vec<f64>,
    pub(super) on_v: Vec<f64>,
    pub(super) on_a: Vec<f64>,
    pub(super) rho: f64,
    pub(super) on_s1: f64,
    pub(super) on_s2: f64,
    /// Compliance of a step among connectors, `B Phi c Phi^T B^T + rho R_BB` (O8).
    pub(super) connector_compliance: DMatrix<f64>,
    /// What a link counts for in the path of a lane, the mean of `R_BB` on its diagonal `[m/N]`.
    pub(super) link_weight: f64,
    /// Products with lanes.
    pub(super) panels: Panels,
    /// Water with memory, where the bridge has it.
    pub(super) waves: Option<WaveConstants>,
    /// What of `a omega^2` the water's springs have, one a mode; none where damping has all of it.
    pub(super) undamped: Option<Vec<f64>>,
}

/// What the modes leave out follows a force without mass (O7).
#[derive(Debug, Clone, Copy)]
pub(super) struct ResidualRule<A: Arithmetic> {
    rho: A::Number,
    on: [A::Number; 2],
}

impl<A: Arithmetic> ResidualRule<A> {
    /// The rule of a step length.
    #[inline(always)]
    pub(super) fn of(o: A, constants: &StepConstants) -> Self {
        Self {
            rho: o.splat(constants.rho),
            on: [o.splat(constants.on_s1), o.splat(constants.on_s2)],
        }
    }

    /// The change of x, x', x'' = `x` in a step under a force.
    #[inline(always)]
    pub(super) fn change(&self, o: A, force: A::Number, x: [A::Number; 3]) -> A::Number {
        o.followed(self.rho, force, self.on, x)
    }
}

/// The operator's matrices, laid out for lanes.
#[derive(Debug)]
pub(super) struct Panels {
    /// `B Phi`.
    pub b: Panel,
    /// Its transpose.
    pub b_t: Panel,
    /// `R_BB`.
    pub r_bb: Panel,
    /// `[V Phi, -R_VB]` of positions, of places and springs of banks, and of the corners of each module.
    pub positions: Panel,
    pub beside: Panel,
    pub corners: Vec<CornerPanel>,
    /// `[D Phi, -R_DB]` of the edges inside each module.
    pub inside: Vec<Panel>,
    /// Of the pins, and what of their stiffness damping has not.
    pub pins: Panel,
    pub pins_undamped: Option<Panel>,
}

impl StepConstants {
    /// The constants of steps of length `time_step_s` with a spectral radius and damping.
    pub(crate) fn new(operator: &BridgeOperator, time_step_s: f64, spectral_radius: f64, rayleigh: Rayleigh) -> Self {
        let s = Scheme::new(time_step_s, spectral_radius);
        let Rayleigh { a, b, .. } = rayleigh;
        let beyond_water = rayleigh.beyond_water();
        // of `a Phi^T K_w Phi` the diagonal
        let undamped: Option<Vec<f64>> =
            (beyond_water != 0.0).then(|| operator.omega2_water.iter().map(|w2| beyond_water * w2).collect());
        let damping: Vec<f64> = match &undamped {
            None => operator.omega2.iter().map(|w2| a * w2).collect(),
            Some(undamped) => operator
                .omega2
                .iter()
                .zip(undamped)
                .map(|(w2, of_water)| a * w2 - of_water)
                .collect(),
        };
        let (c_m, c_c, c_k) = s.effective();
        // the balance at alpha without d: velocity y_v = at_v v + at_a a, acceleration with the weights of M
        let (at_v, at_a) = ((1.0 - s.alpha_f) * s.v_v + s.alpha_f, (1.0 - s.alpha_f) * s.v_a);
        let m_v = (1.0 - s.alpha_m) * s.a_v + b * at_v;
        let m_a = (1.0 - s.alpha_m) * s.a_a + s.alpha_m + b * at_a;
        let each_mode = || operator.omega2.iter().zip(&damping);
        let c: Vec<f64> = each_mode()
            .map(|(w2, damping)| 1.0 / (c_m + c_c * (damping + b) + c_k * w2))
            .collect();
        let each = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            c.iter()
                .zip(each_mode())
                .map(|(c, (w2, damping))| -c * of(*w2, *damping))
                .collect()
        };
        let rho = 1.0 / (c_k + c_c * a);
        let nc = operator.sizes.connectors;
        let link_weight = match nc {
            0 => 1.0,
            _ => (operator.r_bb.trace() / nc as f64).max(f64::MIN_POSITIVE),
        };
        let b_phi = &operator.b;
        let modal = DMatrix::from_fn(nc, nc, |i, j| {
            let terms = c.iter().enumerate().map(|(k, c)| c * (b_phi[(i, k)] * b_phi[(j, k)]));
            terms.sum()
        });
        Self {
            scheme: s,
            rayleigh,
            on_q: each(&|w2, _| w2),
            on_v: each(&|_, damping| damping * at_v + m_v),
            on_a: each(&|_, damping| damping * at_a + m_a),
            rho,
            on_s1: a * at_v,
            on_s2: a * at_a,
            connector_compliance: &modal + rho * &operator.r_bb,
            c,
            panels: Panels::new(operator, beyond_water, link_weight),
            link_weight,
            waves: operator
                .waves
                .as_ref()
                .map(|waves| WaveConstants::new(waves, time_step_s)),
            undamped,
        }
    }
}

impl StepConstants {
    /// A vehicle's springs at this step length.
    pub(crate) fn riding(&self, springs: &Arc<Springs>) -> RidingStep {
        RidingStep::new(springs, self.scheme)
    }
}

impl Panels {
    fn new(o: &BridgeOperator, beyond_water: f64, link_weight: f64) -> Self {
        let (m, nc) = (o.sizes.modes, o.sizes.connectors);
        let beside = o.rows.places + o.rows.springs;
        let with_residual = |phi: &DMatrix<f64>, r: &DMatrix<f64>, from: usize, rows: usize| {
            Panel::new(rows, m + nc, |i, k| {
                if k < m {
                    phi[(from + i, k)]
                } else {
                    -r[(from + i, k - m)]
                }
            })
        };
        let of_module = |module: &OperatedModule| {
            let rows = &module.inside;
            with_residual(&o.inside, &o.r_inside_b, rows.start, rows.len())
        };
        Self {
            b: Panel::new(nc, m, |i, k| o.b[(i, k)]),
            b_t: Panel::new(m, nc, |k, i| o.b[(i, k)]),
            r_bb: Panel::new(nc, nc, |i, j| o.r_bb[(i, j)]),
            positions: with_residual(&o.v, &o.r_vb, 0, o.rows.positions),
            beside: with_residual(&o.v, &o.r_vb, o.sizes.observed - beside, beside),
            corners: (0..o.of_modules.len())
                .map(|module| CornerPanel::new(o, module, link_weight))
                .collect(),
            inside: o.of_modules.iter().map(of_module).collect(),
            pins: o.pins.panel(),
            pins_undamped: (beyond_water != 0.0).then(|| {
                let (rows, columns) = o.pins.water.shape();
                Panel::new(rows, columns, |i, k| beyond_water * o.pins.water[(i, k)])
            }),
        }
    }
}
