//! Added mass and radiation damping of a chain of modules over the frequency.
//!
//! Knows the shapes and the order of a table's matrices. Does not know where they come from, nor whether they are physics.

use super::scales::{FREEDOMS_PER_MODULE, Scales};
use crate::input::InvalidInput;
use nalgebra::DMatrix;

/// A matrix over the freedoms of all modules.
pub type FreedomMatrix = DMatrix<f64>;

/// Added mass A(w) and radiation damping B(w) of `modules` modules.
///
/// The order of rows and columns is heave, pitch, roll of module 1, then of module 2, ..., each about the point (x_c, 0, 0) of
/// its module (heave along +z, rotations about +y and +x). Units: A `[kg, kg m, kg m^2]`, B `[N s/m, N s, N s m]` by pairs
/// of freedoms. Neither hangs on the sign of the time in e^(i w t).
#[derive(Debug, Clone, PartialEq)]
pub struct RadiationTable {
    modules: usize,
    omega_rad_s: Vec<f64>,
    added_mass: Vec<DMatrix<f64>>,
    radiation_damping: Vec<DMatrix<f64>>,
    infinite: Option<DMatrix<f64>>,
}

impl RadiationTable {
    /// A square matrix over the freedoms of all modules from its rows one after the other.
    pub fn matrix(order: usize, rows: &[f64]) -> FreedomMatrix {
        DMatrix::from_row_slice(order, order, rows)
    }

    /// A table of matrices of order `3 modules` at the rising frequencies `omega_rad_s` `[rad/s]`, which may begin with 0;
    /// `infinite` is the added mass at infinite frequency, where it is known.
    ///
    /// Entries of matrices may be NaN: [`Check`](super::Check) refuses them with their number.
    ///
    /// # Errors
    /// [`InvalidInput`] on `modules`, `omega_rad_s`, `added_mass`, `radiation_damping` or `infinite`: no module, no frequency,
    /// frequencies that are negative, not finite or do not rise, a matrix that is missing or has another order.
    pub fn new(
        modules: usize,
        omega_rad_s: Vec<f64>,
        added_mass: Vec<DMatrix<f64>>,
        radiation_damping: Vec<DMatrix<f64>>,
        infinite: Option<DMatrix<f64>>,
    ) -> Result<Self, InvalidInput> {
        if modules == 0 {
            return Err(InvalidInput::new("modules", modules, "at least 1"));
        }
        if omega_rad_s.is_empty() {
            return Err(InvalidInput::new("omega_rad_s", 0_usize, "at least 1 frequency"));
        }
        let mut least = 0.0;
        for (i, &omega) in omega_rad_s.iter().enumerate() {
            let rises = if i == 0 { omega >= 0.0 } else { omega > least };
            if !(omega.is_finite() && rises) {
                let allowed = "finite frequencies of at least 0 that rise";
                return Err(InvalidInput::new(format!("omega_rad_s[{i}]"), omega, allowed));
            }
            least = omega;
        }
        let order = FREEDOMS_PER_MODULE * modules;
        for (key, matrices) in [("added_mass", &added_mass), ("radiation_damping", &radiation_damping)] {
            if matrices.len() != omega_rad_s.len() {
                let allowed = format!("a matrix for each of {} frequencies", omega_rad_s.len());
                return Err(InvalidInput::new(key, matrices.len(), allowed));
            }
            for (i, matrix) in matrices.iter().enumerate() {
                square(&format!("{key}[{i}]"), matrix, order)?;
            }
        }
        if let Some(matrix) = &infinite {
            square("infinite", matrix, order)?;
        }
        Ok(Self {
            modules,
            omega_rad_s,
            added_mass,
            radiation_damping,
            infinite,
        })
    }

    /// The number of modules.
    pub fn modules(&self) -> usize {
        self.modules
    }

    /// The number of freedoms, the order of the matrices: three for each module.
    pub fn freedoms(&self) -> usize {
        FREEDOMS_PER_MODULE * self.modules
    }

    /// The frequencies w `[rad/s]`, rising.
    pub fn omega_rad_s(&self) -> &[f64] {
        &self.omega_rad_s
    }

    /// A(w), a matrix for each frequency.
    pub fn added_mass(&self) -> &[DMatrix<f64>] {
        &self.added_mass
    }

    /// B(w), a matrix for each frequency.
    pub fn radiation_damping(&self) -> &[DMatrix<f64>] {
        &self.radiation_damping
    }

    /// The added mass at infinite frequency that came with the table.
    pub fn infinite(&self) -> Option<&DMatrix<f64>> {
        self.infinite.as_ref()
    }

    /// How many of the frequencies are at most `to_rad_s` `[rad/s]`.
    pub fn used(&self, to_rad_s: f64) -> usize {
        self.omega_rad_s.partition_point(|&omega| omega <= to_rad_s)
    }

    /// How many entries of the first `used` pairs of matrices, and of the one at infinity, are not finite numbers.
    pub fn not_numbers(&self, used: usize) -> usize {
        let pairs = self.added_mass[..used].iter().chain(&self.radiation_damping[..used]);
        let entries = pairs.chain(&self.infinite).flat_map(|matrix| matrix.iter());
        entries.filter(|entry| !entry.is_finite()).count()
    }

    /// The table with each matrix X replaced by `(X + X^T) / 2`, then, where the modules' lengths are mirror-equal, by the mean
    /// of itself and its [mirror image](Scales::mirrored).
    ///
    /// # Errors
    /// [`InvalidInput`] on `length_m` where `scales` are of another number of modules.
    pub fn symmetrised(&self, scales: &Scales) -> Result<Self, InvalidInput> {
        self.fits(scales)?;
        let mean = |matrix: &DMatrix<f64>| {
            let x = (matrix + matrix.transpose()) / 2.0;
            if scales.mirror_equal() {
                (&x + scales.mirrored(&x)) / 2.0
            } else {
                x
            }
        };
        Ok(Self {
            modules: self.modules,
            omega_rad_s: self.omega_rad_s.clone(),
            added_mass: self.added_mass.iter().map(mean).collect(),
            radiation_damping: self.radiation_damping.iter().map(mean).collect(),
            infinite: self.infinite.as_ref().map(mean),
        })
    }

    /// Refuses scales of another number of modules.
    pub(super) fn fits(&self, scales: &Scales) -> Result<(), InvalidInput> {
        let lengths = scales.length_m().len();
        if lengths == self.modules {
            Ok(())
        } else {
            let allowed = format!("a length for each of {} modules", self.modules);
            Err(InvalidInput::new("length_m", lengths, allowed))
        }
    }
}

/// The sum of a matrix over all pairs of heaves: what the whole chain has when it heaves as one body.
pub fn total_heave(matrix: &DMatrix<f64>) -> f64 {
    let heaves = || (0..matrix.nrows()).step_by(FREEDOMS_PER_MODULE);
    heaves().map(|i| heaves().map(|j| matrix[(i, j)]).sum::<f64>()).sum()
}

/// Refuses a matrix that is not square of an order.
fn square(key: &str, matrix: &DMatrix<f64>, order: usize) -> Result<(), InvalidInput> {
    if matrix.shape() == (order, order) {
        Ok(())
    } else {
        let found = format!("{} x {}", matrix.nrows(), matrix.ncols());
        Err(InvalidInput::new(key, found, format!("{order} x {order}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(order: usize) -> DMatrix<f64> {
        DMatrix::from_fn(order, order, |i, j| ((i * 13 + j * 5) % 11) as f64)
    }

    #[test]
    fn what_has_the_wrong_shape_or_order_is_refused() {
        let (x, y) = (matrix(6), matrix(5));
        let two = |x: &DMatrix<f64>, y: &DMatrix<f64>| vec![x.clone(), y.clone()];
        let new = |w: &[f64], a, b, inf| RadiationTable::new(2, w.to_vec(), a, b, inf);
        let key = |refused: Result<RadiationTable, InvalidInput>| refused.unwrap_err().key;
        assert!(new(&[0.0, 1.0], two(&x, &x), two(&x, &x), None).is_ok());
        assert_eq!(key(new(&[1.0, 1.0], two(&x, &x), two(&x, &x), None)), "omega_rad_s[1]");
        assert_eq!(key(new(&[-1.0, 1.0], two(&x, &x), two(&x, &x), None)), "omega_rad_s[0]");
        assert_eq!(
            key(new(&[0.0, f64::INFINITY], two(&x, &x), two(&x, &x), None)),
            "omega_rad_s[1]"
        );
        assert_eq!(key(new(&[], Vec::new(), Vec::new(), None)), "omega_rad_s");
        assert_eq!(key(new(&[0.0, 1.0], vec![x.clone()], two(&x, &x), None)), "added_mass");
        assert_eq!(
            key(new(&[0.0, 1.0], two(&x, &x), two(&x, &y), None)),
            "radiation_damping[1]"
        );
        assert_eq!(
            key(new(&[0.0, 1.0], two(&x, &x), two(&x, &x), Some(y.clone()))),
            "infinite"
        );
        assert_eq!(
            key(RadiationTable::new(0, vec![1.0], vec![x.clone()], vec![x], None)),
            "modules"
        );
    }

    #[test]
    fn a_symmetrised_table_is_its_own_transpose_and_mirror() {
        let (equal, unequal) = (
            Scales::new(&[4.0, 4.0], 3.0).unwrap(),
            Scales::new(&[4.0, 5.0], 3.0).unwrap(),
        );
        let table = RadiationTable::new(2, vec![1.0], vec![matrix(6)], vec![matrix(6) * 2.0], None).unwrap();
        let once = table.symmetrised(&equal).unwrap();
        let a = &once.added_mass()[0];
        assert_eq!((a.transpose(), equal.mirrored(a)), (a.clone(), a.clone()));
        assert_eq!(once.symmetrised(&equal).unwrap(), once);
        // lengths that differ have no mirror
        let once = table.symmetrised(&unequal).unwrap();
        let a = &once.added_mass()[0];
        assert_eq!(a.transpose(), a.clone());
        assert_ne!(unequal.mirrored(a), a.clone());
        assert_eq!(
            table.symmetrised(&Scales::new(&[4.0], 3.0).unwrap()).unwrap_err().key,
            "length_m"
        );
    }

    #[test]
    fn totals_and_counts() {
        let mut a = matrix(6);
        assert_eq!(total_heave(&a), a[(0, 0)] + a[(0, 3)] + a[(3, 0)] + a[(3, 3)]);
        a[(2, 3)] = f64::NAN;
        let table =
            RadiationTable::new(2, vec![0.0, 5.0], vec![matrix(6), a], vec![matrix(6), matrix(6)], None).unwrap();
        assert_eq!(
            (
                table.used(4.9),
                table.used(5.0),
                table.not_numbers(1),
                table.not_numbers(2)
            ),
            (1, 2, 0, 1)
        );
    }
}
