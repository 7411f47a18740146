//! The numbers of all lanes, rows of lanes side by side: those carried from step to step and those of the step under way.
//!
//! Knows how many rows there are of each. Does not know how they come about.

use super::basis::Sizes;
use super::riders::Free;

/// Numbers that a lane carries from step to step: for each row one a lane, side by side.
#[derive(Debug, Clone, Default)]
pub(super) struct Motion {
    /// Modes: `q, q', q''`, the modal forces of the connectors.
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    pub contact: Vec<f64>,
    /// Downward weights and inertia forces as modes, connectors and observed rows see them.
    pub weights: Vec<f64>,
    pub inertia: Vec<f64>,
    /// Connector forces as what the modes leave out has followed them, `s, s', s''`, and `R_BB` times these.
    pub s: [Vec<f64>; 3],
    pub sigma: [Vec<f64>; 3],
    /// Displacements of connectors and observed rows by deck loads, beside the modes, and their derivatives.
    pub r: [Vec<f64>; 3],
    /// Connectors: force N, `R_BB N`, elongation.
    pub n: Vec<f64>,
    pub rn: Vec<f64>,
    pub e: Vec<f64>,
    /// Energies at the end of the step `[J]`: kinetic, strain, connectors.
    pub kinetic: Vec<f64>,
    pub strain: Vec<f64>,
    pub springs: Vec<f64>,
}

impl Motion {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let of = |rows: usize| vec![0.0; rows * lanes];
        let (m, nc, nv) = (sizes.modes, sizes.connectors, sizes.observed);
        Self {
            q: of(m),
            v: of(m),
            a: of(m),
            contact: of(m),
            weights: of(sizes.followed()),
            inertia: of(sizes.followed()),
            s: [(); 3].map(|()| of(nc)),
            sigma: [(); 3].map(|()| of(nc)),
            r: [(); 3].map(|()| of(nc + nv)),
            n: of(nc),
            rn: of(nc),
            e: of(nc),
            kinetic: of(1),
            strain: of(1),
            springs: of(1),
        }
    }

    /// All of them, in the order in which a lane is saved.
    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let Self {
            q,
            v,
            a,
            contact,
            weights,
            inertia,
            s,
            sigma,
            r,
            n,
            rn,
            e,
            kinetic,
            strain,
            springs,
        } = self;
        [q, v, a, contact, weights, inertia, n, rn, e, kinetic, strain, springs]
            .into_iter()
            .chain(s)
            .chain(sigma)
            .chain(r)
    }
}

/// Numbers of the step under way.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub weights: Vec<f64>,
    pub inertia: Vec<f64>,
    pub contact: Vec<f64>,
    pub d: Vec<f64>,
    pub ds: Vec<f64>,
    pub dsigma: Vec<f64>,
    pub dr: Vec<f64>,
    pub n: Vec<f64>,
    pub rn: Vec<f64>,
    pub e: Vec<f64>,
    /// Free motion of the modes.
    pub free: [Vec<f64>; 3],
    /// `[q; s]`, observed rows.
    pub x: Vec<f64>,
    pub w: Vec<f64>,
    pub inside: Vec<f64>,
    /// `sum of omega^2 q^2`, `s^T R s`.
    pub modal_strain: Vec<f64>,
    pub residual_strain: Vec<f64>,
    pub lane_free: Free,
    /// One lane's connector forces.
    pub lane_n: Vec<f64>,
    pub active: Vec<usize>,
}

impl Scratch {
    /// Zeros for `width` lanes.
    pub(super) fn new(sizes: &Sizes, width: usize) -> Self {
        let of = |rows: usize| vec![0.0; rows * width];
        let (m, nc, nv) = (sizes.modes, sizes.connectors, sizes.observed);
        Self {
            weights: of(sizes.followed()),
            inertia: of(sizes.followed()),
            contact: of(m),
            d: of(m),
            ds: of(nc),
            dsigma: of(nc),
            dr: of(nc + nv),
            n: of(nc),
            rn: of(nc),
            e: of(nc),
            free: [(); 3].map(|()| of(m)),
            x: of(m + nc),
            w: of(nv),
            inside: of(sizes.inside),
            modal_strain: of(1),
            residual_strain: of(1),
            lane_free: Free {
                q: vec![0.0; m],
                v: vec![0.0; m],
                a: vec![0.0; m],
            },
            lane_n: vec![0.0; nc],
            active: Vec::with_capacity(nc),
        }
    }
}
