//! Lengths that make heave, pitch and roll comparable, and the mirror image of a chain.
//!
//! Knows the modules' lengths and their breadth. Does not know what a matrix of the chain means.

use crate::input::{InvalidInput, positive};
use nalgebra::DMatrix;

/// Heave, pitch and roll.
pub const FREEDOMS_PER_MODULE: usize = 3;

/// Relative difference of two lengths that are one length.
const SAME_LENGTH: f64 = 1e-9;

/// The rms lengths of a chain's freedoms.
///
/// The scaled freedoms are y = D r with D = diag(1, L_m / sqrt 12, B / sqrt 12, ...): the rms vertical displacement of a
/// rectangle of length L_m and breadth B in heave, pitch and roll, all in `[m]`. A matrix of forces X in the freedoms r is
/// D^-1 X D^-1 in y.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    length_m: Vec<f64>,
    rms_m: Vec<f64>,
}

impl Scales {
    /// The scales of modules of `length_m[m]` `[m]`, from the first to the last, that are `breadth_m` wide at the waterline.
    ///
    /// # Errors
    /// [`InvalidInput`] on `length_m` or `breadth_m`: no module, or what is not a finite number above zero.
    pub fn new(length_m: &[f64], breadth_m: f64) -> Result<Self, InvalidInput> {
        if length_m.is_empty() {
            return Err(InvalidInput::new(
                "length_m",
                0_usize,
                "a length for each module, at least 1",
            ));
        }
        positive("breadth_m", breadth_m)?;
        let mut rms_m = Vec::with_capacity(FREEDOMS_PER_MODULE * length_m.len());
        for (m, &length_m) in length_m.iter().enumerate() {
            positive(&format!("length_m[{m}]"), length_m)?;
            rms_m.extend([1.0, length_m / 12_f64.sqrt(), breadth_m / 12_f64.sqrt()]);
        }
        let length_m = length_m.to_vec();
        Ok(Self { length_m, rms_m })
    }

    /// Lengths of the modules `[m]`, from the first to the last.
    pub fn length_m(&self) -> &[f64] {
        &self.length_m
    }

    /// The diagonal of D: 1 `[-]` for a heave, `[m/rad]` for a pitch and a roll. Three for each module.
    pub fn rms_m(&self) -> &[f64] {
        &self.rms_m
    }

    /// The number of freedoms, three for each module.
    pub fn freedoms(&self) -> usize {
        self.rms_m.len()
    }

    /// D^-1 X D^-1 of a matrix X of the freedoms r.
    pub fn scaled(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] / (self.rms_m[i] * self.rms_m[j])
        })
    }

    /// D X D of a matrix X of the scaled freedoms y.
    pub fn unscaled(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * (self.rms_m[i] * self.rms_m[j])
        })
    }

    /// Whether the chain's lengths read the same from both ends (to 1e-9 of each).
    pub fn mirror_equal(&self) -> bool {
        let pairs = self.length_m.iter().zip(self.length_m.iter().rev());
        pairs.into_iter().all(|(a, b)| (a - b).abs() <= SAME_LENGTH * a)
    }

    /// The matrix of the chain that is mirrored, x -> -x: modules in reverse, heave and roll keep their sign, pitch changes it.
    pub fn mirrored(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            let ((i, a), (j, b)) = (self.image(i), self.image(j));
            a * b * matrix[(i, j)]
        })
    }

    /// The freedom that takes the place of another in the mirror, and its sign.
    fn image(&self, freedom: usize) -> (usize, f64) {
        let (module, kind) = (freedom / FREEDOMS_PER_MODULE, freedom % FREEDOMS_PER_MODULE);
        let other = self.length_m.len() - 1 - module;
        (FREEDOMS_PER_MODULE * other + kind, if kind == 1 { -1.0 } else { 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rms_lengths_are_those_of_a_rectangle() {
        let scales = Scales::new(&[6.0, 3.0], 12_f64.sqrt()).unwrap();
        // the rms of x over a length of 6 is sqrt(6^2/12)
        let n = 2_000_000;
        let rms = (0..n)
            .map(|i| (6.0 * ((i as f64 + 0.5) / n as f64 - 0.5)).powi(2))
            .sum::<f64>()
            / n as f64;
        assert!((scales.rms_m()[1] - rms.sqrt()).abs() < 1e-9);
        assert!((scales.rms_m()[1] * 1.05 - rms.sqrt()).abs() > 1e-2);
        assert_eq!(
            (scales.rms_m()[0], scales.rms_m()[2], scales.rms_m()[4] * 2.0),
            (1.0, 1.0, scales.rms_m()[1])
        );
        let x = DMatrix::from_fn(6, 6, |i, j| (i * 7 + j) as f64);
        assert!((scales.unscaled(&scales.scaled(&x)) - x).amax() < 1e-13);
    }

    #[test]
    fn the_mirror_turns_the_chain_and_the_pitch() {
        let scales = Scales::new(&[5.0, 7.0, 5.0], 2.0).unwrap();
        assert!(scales.mirror_equal());
        assert!(!Scales::new(&[5.0, 7.0, 5.1], 2.0).unwrap().mirror_equal());
        let x = DMatrix::from_fn(9, 9, |i, j| (i * 10 + j) as f64);
        let m = scales.mirrored(&x);
        // heave 1 - pitch 1 becomes heave 3 - pitch 3, turned; roll 1 - roll 2 becomes roll 3 - roll 2
        assert_eq!((m[(0, 1)], m[(2, 5)], m[(1, 7)]), (-x[(6, 7)], x[(8, 5)], x[(7, 1)]));
        assert_eq!(scales.mirrored(&m), x);
    }

    #[test]
    fn what_is_no_length_is_refused() {
        assert_eq!(Scales::new(&[], 1.0).unwrap_err().key, "length_m");
        assert_eq!(Scales::new(&[1.0, 0.0], 1.0).unwrap_err().key, "length_m[1]");
        assert_eq!(Scales::new(&[1.0], f64::NAN).unwrap_err().key, "breadth_m");
    }
}
