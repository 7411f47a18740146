//! The plane of a 4-node element: its local axes, the nodes' places in it, shape functions and quadrature.
//!
//! Knows the geometry that membrane and plate share. Does not know material.

use super::FemError;
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Natural coordinates of the four corners.
pub(super) const CORNERS: [(f64, f64); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];

/// Abscissa of the two-point Gauss rule.
const GAUSS_2: f64 = 0.577_350_269_189_625_8;

/// The four points of the 2 x 2 Gauss rule, each of weight 1.
pub(super) const GAUSS_2X2: [(f64, f64); 4] = [
    (-GAUSS_2, -GAUSS_2),
    (GAUSS_2, -GAUSS_2),
    (GAUSS_2, GAUSS_2),
    (-GAUSS_2, GAUSS_2),
];

/// A 4-node element seen in its mean plane.
///
/// Local z is normal to both diagonals, local x the projection of the line between the mid-points of the sides 4-1 and
/// 2-3. `warp` is each node's height above the mean plane: zero for a flat element, plus and minus one value else.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadFrame {
    /// Rows are the local axes.
    pub axes: Matrix3<f64>,
    /// Local x of the corners `[m]`.
    pub x: [f64; 4],
    /// Local y of the corners `[m]`.
    pub y: [f64; 4],
    /// Heights of the corners above the mean plane `[m]`.
    pub warp: [f64; 4],
}

/// Shape functions and their derivatives at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShapeAt {
    /// N_i.
    pub n: [f64; 4],
    /// dN_i/dx.
    pub dx: [f64; 4],
    /// dN_i/dy.
    pub dy: [f64; 4],
    /// Inverse of the Jacobian `[x,xi y,xi; x,eta y,eta]`.
    pub inverse: Matrix2<f64>,
    /// Determinant of the Jacobian.
    pub det: f64,
}

impl QuadFrame {
    /// The frame of element number `element` with the given corners.
    ///
    /// # Errors
    /// [`FemError::Degenerate`] where the corners span no area or a corner is not convex.
    pub fn new(element: usize, corners: &[Vector3<f64>; 4]) -> Result<Self, FemError> {
        let [p1, p2, p3, p4] = corners;
        let normal = (p3 - p1).cross(&(p4 - p2));
        let size = (p3 - p1).norm().max((p4 - p2).norm());
        let area = 0.5 * normal.norm();
        if !area.is_finite() || area <= 1e-12 * size * size {
            return Err(FemError::Degenerate {
                element,
                measure: "area",
                value: area,
            });
        }
        let e3 = normal.normalize();
        let along = (p2 + p3) - (p1 + p4);
        let e1 = (along - e3 * along.dot(&e3)).normalize();
        let e2 = e3.cross(&e1);
        let axes = Matrix3::from_rows(&[e1.transpose(), e2.transpose(), e3.transpose()]);
        let centre = (p1 + p2 + p3 + p4) / 4.0;
        let local: Vec<Vector3<f64>> = corners.iter().map(|p| axes * (p - centre)).collect();
        let pick = |k: usize| [local[0][k], local[1][k], local[2][k], local[3][k]];
        let frame = Self {
            axes,
            x: pick(0),
            y: pick(1),
            warp: pick(2),
        };
        for (xi, eta) in CORNERS {
            let det = frame.jacobian(xi, eta).determinant();
            if det <= 1e-12 * size * size {
                return Err(FemError::Degenerate {
                    element,
                    measure: "Jacobian at a corner",
                    value: det,
                });
            }
        }
        Ok(frame)
    }

    /// Area in the mean plane `[m^2]`.
    pub fn area(&self) -> f64 {
        GAUSS_2X2
            .iter()
            .map(|&(xi, eta)| self.jacobian(xi, eta).determinant())
            .sum()
    }

    /// `[x,xi y,xi; x,eta y,eta]` at a point.
    pub(super) fn jacobian(&self, xi: f64, eta: f64) -> Matrix2<f64> {
        let mut j = Matrix2::zeros();
        for (i, (a, b)) in CORNERS.iter().enumerate() {
            let (d_xi, d_eta) = (0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi));
            j += Matrix2::new(d_xi * self.x[i], d_xi * self.y[i], d_eta * self.x[i], d_eta * self.y[i]);
        }
        j
    }

    /// Bilinear shape functions `N_i = (1 + xi_i xi)(1 + eta_i eta)/4` at a point.
    /// Equation (E1).
    pub(super) fn shape(&self, xi: f64, eta: f64) -> ShapeAt {
        let jacobian = self.jacobian(xi, eta);
        let det = jacobian.determinant();
        let inverse = Matrix2::new(jacobian[(1, 1)], -jacobian[(0, 1)], -jacobian[(1, 0)], jacobian[(0, 0)]) / det;
        let mut at = ShapeAt {
            n: [0.0; 4],
            dx: [0.0; 4],
            dy: [0.0; 4],
            inverse,
            det,
        };
        for (i, (a, b)) in CORNERS.iter().enumerate() {
            let (d_xi, d_eta) = (0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi));
            at.n[i] = 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
            at.dx[i] = inverse[(0, 0)] * d_xi + inverse[(0, 1)] * d_eta;
            at.dy[i] = inverse[(1, 0)] * d_xi + inverse[(1, 1)] * d_eta;
        }
        at
    }
}
