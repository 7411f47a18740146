//! Modes in water whose added mass changes with the frequency.
//!
//! Knows modes with the added mass at infinite frequency. Does not know how they were found or what they are called.

use crate::bridge::BridgeWaves;
use crate::fem::EigenPairs;
use crate::radiation::FreedomMatrix;
use faer::Mat;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::f64::consts::PI;

/// Modes that are searched beyond those asked for, as the shapes that make up the others.
pub(super) const MORE: usize = 30;

/// Times that a frequency is taken anew at most, and when it is found, as a share.
const ROUNDS: usize = 60;
const FOUND: f64 = 1e-10;

/// A mode in its own water.
#[derive(Debug, Clone)]
pub(super) struct WetMode {
    /// Its place among the modes with the added mass at infinite frequency.
    pub from: usize,
    pub frequency_hz: f64,
    /// Damping by waves, a share of critical damping.
    pub radiation_ratio: f64,
}

/// Turns modes with the added mass at infinite frequency into modes with that of their own frequency, made up of the former:
/// `K phi = w^2 (M + G^T (A(w) - A_inf) G) phi`, w taken anew until it is its own. Gives the damping by waves of each as a share of
/// critical damping, `phi^T G^T B(w) G phi / (2 w)`. Modes that nothing restores stay as they are; the others are ordered anew.
/// Equation (W8).
pub(super) fn in_waves(waves: &BridgeWaves, pairs: &mut EigenPairs) -> Vec<WetMode> {
    let count = pairs.lambda.len();
    let motions = DMatrix::from_fn(waves.motions.len(), count, |freedom, k| {
        let row = &waves.motions[freedom].0;
        row.iter().map(|&(i, g)| g * pairs.shapes[(i, k)]).sum::<f64>()
    });
    let on_modes = |x: &FreedomMatrix| motions.transpose() * x * &motions;
    let mut found: Vec<(f64, DVector<f64>, WetMode)> = Vec::with_capacity(count);
    for k in 0..count {
        let mut shape = DVector::from_fn(count, |i, _| if i == k { 1.0 } else { 0.0 });
        let (mut lambda, mut ratio) = (pairs.lambda[k], 0.0);
        for _ in 0..ROUNDS {
            if lambda <= LEAST {
                break;
            }
            let omega = lambda.sqrt();
            let [mass, damping] = waves.radiation.at(omega);
            let more = on_modes(&(mass - waves.radiation.infinite()));
            let (next, turned) = nearest(&pairs.lambda, &more, &shape);
            ratio = shape_form(&on_modes(&damping), &turned) / (2.0 * next.max(LEAST).sqrt());
            shape = turned;
            let settled = (next - lambda).abs() <= FOUND * lambda;
            // the mean keeps a frequency from going to and fro
            lambda = if settled { next } else { 0.5 * (next + lambda) };
            if settled {
                break;
            }
        }
        let mode = WetMode {
            from: k,
            frequency_hz: lambda.max(0.0).sqrt() / (2.0 * PI),
            // above the kernel's last frequency it is rounding
            radiation_ratio: if ratio > NO_DAMPING { ratio } else { 0.0 },
        };
        found.push((lambda, shape, mode));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let rows = pairs.shapes.nrows();
    let mut shapes = Mat::zeros(rows, count);
    for (k, (_, shape, _)) in found.iter().enumerate() {
        for i in 0..rows {
            shapes[(i, k)] = (0..count).map(|j| pairs.shapes[(i, j)] * shape[j]).sum();
        }
    }
    pairs.shapes = shapes;
    pairs.lambda = found.iter().map(|of| of.0).collect();
    found.into_iter().map(|of| of.2).collect()
}

/// Ratio of critical damping below which waves take nothing.
const NO_DAMPING: f64 = 1e-6;

/// Below this a mode is a motion that nothing restores `[1/s^2]`.
const LEAST: f64 = 1e-4;

fn shape_form(x: &DMatrix<f64>, shape: &DVector<f64>) -> f64 {
    (x * shape).dot(shape)
}

/// The pair of `Lambda phi = lambda (1 + more) phi` whose shape is nearest to one, `phi^T (1 + more) phi = 1`.
fn nearest(lambda: &[f64], more: &DMatrix<f64>, shape: &DVector<f64>) -> (f64, DVector<f64>) {
    let count = lambda.len();
    let mass = DMatrix::identity(count, count) + more;
    let Some(factor) = mass.clone().cholesky() else {
        return (
            shape_form(&DMatrix::from_diagonal(&DVector::from_column_slice(lambda)), shape),
            shape.clone(),
        );
    };
    // L^-1 Lambda L^-T
    let mut whitened = DMatrix::from_diagonal(&DVector::from_column_slice(lambda));
    factor.l().solve_lower_triangular_mut(&mut whitened);
    let mut whitened = whitened.transpose();
    factor.l().solve_lower_triangular_mut(&mut whitened);
    let eigen = SymmetricEigen::new(whitened);
    let along = factor.l().transpose() * shape;
    let alike = |j: usize| eigen.eigenvectors.column(j).dot(&along).abs();
    let best = (0..count).max_by(|&a, &b| alike(a).total_cmp(&alike(b))).unwrap_or(0);
    let mut turned = eigen.eigenvectors.column(best).into_owned();
    factor.l().tr_solve_lower_triangular_mut(&mut turned);
    (eigen.eigenvalues[best], turned)
}
