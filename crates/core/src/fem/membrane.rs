//! The membrane part of the shell: bilinear with incompatible modes, and a drilling stiffness that leaves it alone.
//!
//! Knows plane stress in the element's plane, dofs (u, v, theta_z) a node. Does not know bending.

use super::frame::{GAUSS_2X2, QuadFrame, ShapeAt};
use super::section::ShellSection;
use nalgebra::{SMatrix, SVector};

/// Membrane stiffness, dofs `(u, v, theta_z)` of the four nodes.
pub(super) type MembraneMatrix = SMatrix<f64, 12, 12>;

/// Share of the drilling penalty that is integrated in full, against the three hourglass patterns of theta_z which the
/// centre point cannot see. It stiffens in-plane bending by an eighth of its product with the square of an element's
/// aspect ratio (0.1 % at 30:1), and it is far above rounding.
const DRILLING_HOURGLASS: f64 = 1e-5;

/// `k_m = integral of B^T D B t dA` with the incompatible modes `1 - xi^2`, `1 - eta^2` of u and v (Wilson, Taylor:
/// Int. J. Numer. Meth. Engng 10, 1976, 1211-1219) condensed out; their derivatives are taken with the Jacobian of the
/// centre, so that constant stress passes the patch test on any quadrilateral. In-plane bending of a rectangle is
/// exact.
///
/// Drilling: `G t (theta_z - (v,x - u,y)/2)^2 / 2` (Hughes, Brezzi: Comput. Meth. Appl. Mech. Engng 72, 1989) at the
/// centre, where neither constant strain nor in-plane bending of a rectangle leaves anything.
pub(super) fn stiffness(frame: &QuadFrame, section: &ShellSection) -> MembraneMatrix {
    let Enriched { mut k, k_ua, k_aa } = Enriched::new(frame, section);
    if let Some(inverse) = k_aa.try_inverse() {
        k -= k_ua * inverse * k_ua.transpose();
    }
    k + drilling(frame, section, &frame.shape(0.0, 0.0))
}

/// `(eps_x, eps_y, gamma_xy)` at a point, of the nodal displacements and of the incompatible modes that follow them,
/// `B - B_a k_aa^-1 k_ua^T`.
/// Equation (G1).
pub(super) fn strain_at(frame: &QuadFrame, section: &ShellSection, xi: f64, eta: f64) -> SMatrix<f64, 3, 12> {
    let Enriched { k_ua, k_aa, .. } = Enriched::new(frame, section);
    let at = frame.shape(xi, eta);
    let mut b = strain(&at);
    if let Some(inverse) = k_aa.try_inverse() {
        b -= incompatible_strain(&frame.shape(0.0, 0.0), &at, xi, eta) * inverse * k_ua.transpose();
    }
    b
}

/// The membrane's stiffness before its incompatible modes are condensed, without drilling.
struct Enriched {
    k: MembraneMatrix,
    k_ua: SMatrix<f64, 12, 4>,
    k_aa: SMatrix<f64, 4, 4>,
}

impl Enriched {
    fn new(frame: &QuadFrame, section: &ShellSection) -> Self {
        let d = section.plane_stress() * section.thickness_m;
        let centre = frame.shape(0.0, 0.0);
        let mut own = Self {
            k: MembraneMatrix::zeros(),
            k_ua: SMatrix::zeros(),
            k_aa: SMatrix::zeros(),
        };
        for (xi, eta) in GAUSS_2X2 {
            let at = frame.shape(xi, eta);
            let b = strain(&at);
            let b_a = incompatible_strain(&centre, &at, xi, eta);
            own.k += b.transpose() * d * b * at.det;
            own.k_ua += b.transpose() * d * b_a * at.det;
            own.k_aa += b_a.transpose() * d * b_a * at.det;
        }
        own
    }
}

/// `(eps_x, eps_y, gamma_xy)` of the nodal displacements.
fn strain(at: &ShapeAt) -> SMatrix<f64, 3, 12> {
    let mut b = SMatrix::<f64, 3, 12>::zeros();
    for i in 0..4 {
        b[(0, 3 * i)] = at.dx[i];
        b[(1, 3 * i + 1)] = at.dy[i];
        b[(2, 3 * i)] = at.dy[i];
        b[(2, 3 * i + 1)] = at.dx[i];
    }
    b
}

/// `(eps_x, eps_y, gamma_xy)` of the incompatible modes `(u_1, v_1, u_2, v_2)`.
/// Equation (E2).
fn incompatible_strain(centre: &ShapeAt, at: &ShapeAt, xi: f64, eta: f64) -> SMatrix<f64, 3, 4> {
    let mut b = SMatrix::<f64, 3, 4>::zeros();
    let scale = centre.det / at.det;
    for (mode, column, slope) in [(0, 0, -2.0 * xi), (1, 1, -2.0 * eta)] {
        let dx = scale * centre.inverse[(0, column)] * slope;
        let dy = scale * centre.inverse[(1, column)] * slope;
        b[(0, 2 * mode)] = dx;
        b[(1, 2 * mode + 1)] = dy;
        b[(2, 2 * mode)] = dy;
        b[(2, 2 * mode + 1)] = dx;
    }
    b
}

/// Stiffness of rotations about the normal against the membrane. Equation (E3).
fn drilling(frame: &QuadFrame, section: &ShellSection, centre: &ShapeAt) -> MembraneMatrix {
    let g = section.shear_modulus_pa() * section.thickness_m;
    let row = |at: &ShapeAt| {
        let mut r = SVector::<f64, 12>::zeros();
        for i in 0..4 {
            r[3 * i] = 0.5 * at.dy[i];
            r[3 * i + 1] = -0.5 * at.dx[i];
            r[3 * i + 2] = at.n[i];
        }
        r
    };
    let r = row(centre);
    let mut k = r * r.transpose() * (g * frame.area() * (1.0 - DRILLING_HOURGLASS));
    for (xi, eta) in GAUSS_2X2 {
        let at = frame.shape(xi, eta);
        let r = row(&at);
        k += r * r.transpose() * (g * at.det * DRILLING_HOURGLASS);
    }
    k
}
