//! The bending part of the shell: MITC4.
//!
//! Knows Reissner-Mindlin bending in the element's plane, dofs (w, theta_x, theta_y) a node. Does not know membrane
//! forces.

use super::frame::{GAUSS_2X2, QuadFrame, ShapeAt};
use super::section::ShellSection;
use nalgebra::{SMatrix, SVector};

/// Plate stiffness, dofs `(w, theta_x, theta_y)` of the four nodes.
pub(super) type PlateMatrix = SMatrix<f64, 12, 12>;

/// Shear correction factor of a homogeneous plate.
const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

/// `k_b = integral of (t^3/12) B_b^T D B_b + (5/6) G t B_s^T B_s dA`.
///
/// The normal turns by `beta_x = theta_y`, `beta_y = -theta_x`; curvatures come from the bilinear rotations, transverse
/// shear from the covariant strains tied at the mid-points of the sides (Bathe, Dvorkin: Int. J. Numer. Meth. Engng 21,
/// 1985, 367-383), which removes shear locking.
pub(super) fn stiffness(frame: &QuadFrame, section: &ShellSection) -> PlateMatrix {
    let t = section.thickness_m;
    let d = section.plane_stress() * (t.powi(3) / 12.0);
    let g = SHEAR_CORRECTION * section.shear_modulus_pa() * t;
    let tied = TiedShear::new(frame);
    let mut k = PlateMatrix::zeros();
    for (xi, eta) in GAUSS_2X2 {
        let at = frame.shape(xi, eta);
        let b = curvature(&at);
        k += b.transpose() * d * b * at.det;
        let s = tied.shear(&at, xi, eta);
        k += s.transpose() * s * (g * at.det);
    }
    k
}

/// `(kappa_x, kappa_y, kappa_xy) = (beta_x,x, beta_y,y, beta_x,y + beta_y,x)`.
/// Equation (E4).
pub(super) fn curvature(at: &ShapeAt) -> SMatrix<f64, 3, 12> {
    let mut b = SMatrix::<f64, 3, 12>::zeros();
    for i in 0..4 {
        b[(0, 3 * i + 2)] = at.dx[i];
        b[(1, 3 * i + 1)] = -at.dy[i];
        b[(2, 3 * i + 2)] = at.dy[i];
        b[(2, 3 * i + 1)] = -at.dx[i];
    }
    b
}

/// Covariant shear strains at the mid-points of the sides.
struct TiedShear {
    /// gamma_xi at eta = -1 and eta = +1.
    xi: [SVector<f64, 12>; 2],
    /// gamma_eta at xi = -1 and xi = +1.
    eta: [SVector<f64, 12>; 2],
}

impl TiedShear {
    fn new(frame: &QuadFrame) -> Self {
        let side = |a: usize, b: usize| {
            // gamma along the side a-b: w' + beta . tangent, per unit of the natural coordinate (half the side)
            let (dx, dy) = (0.5 * (frame.x[b] - frame.x[a]), 0.5 * (frame.y[b] - frame.y[a]));
            let mut g = SVector::<f64, 12>::zeros();
            for (node, w) in [(a, -0.5), (b, 0.5)] {
                g[3 * node] = w;
                g[3 * node + 1] = -0.5 * dy;
                g[3 * node + 2] = 0.5 * dx;
            }
            g
        };
        Self {
            xi: [side(0, 1), side(3, 2)],
            eta: [side(0, 3), side(1, 2)],
        }
    }

    /// `(gamma_x, gamma_y)` at a point: the tied covariant strains interpolated, then turned by the inverse Jacobian.
    fn shear(&self, at: &ShapeAt, xi: f64, eta: f64) -> SMatrix<f64, 2, 12> {
        let g_xi = self.xi[0] * (0.5 * (1.0 - eta)) + self.xi[1] * (0.5 * (1.0 + eta));
        let g_eta = self.eta[0] * (0.5 * (1.0 - xi)) + self.eta[1] * (0.5 * (1.0 + xi));
        let mut s = SMatrix::<f64, 2, 12>::zeros();
        s.set_row(0, &(g_xi * at.inverse[(0, 0)] + g_eta * at.inverse[(0, 1)]).transpose());
        s.set_row(1, &(g_xi * at.inverse[(1, 0)] + g_eta * at.inverse[(1, 1)]).transpose());
        s
    }
}
