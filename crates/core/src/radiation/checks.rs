//! Checks that tell whether a radiation table can be believed, and how far it is from what would be refused.
//!
//! Knows what symmetry, passivity and causality ask of A and B. Does not know who accepts a check that fails.

use super::table::total_heave;
use super::{Band, Kernel, RadiationTable, Scales, Window, added_mass_infinite, kramers_kronig};
use crate::input::InvalidInput;
use nalgebra::DMatrix;

/// The band over which A and B must be of one water `[rad/s]`.
const KRAMERS_KRONIG_FROM_TO_RAD_S: [f64; 2] = [1.2, 3.25];

/// What is checked. Matrices are taken in [scaled](Scales) freedoms, over the used band.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CheckName {
    /// How many entries of the table are no numbers, that at infinity included.
    NotNumbers,
    /// The last frequency that is used `[rad/s]`.
    LastUsed,
    /// `max |A - A^T| / max |A|`, the largest of all frequencies.
    AddedMassAsymmetry,
    /// `max |B - B^T| / max |B|`, the largest of all frequencies above 0.
    DampingAsymmetry,
    /// `max |X - mirror of X| / max |X|` of A and B made symmetric, the largest of all frequencies. Only for chains whose
    /// lengths are mirror-equal.
    Mirror,
    /// The least eigenvalue of B made symmetric over its largest, the least of all frequencies above 0: below 0 where a
    /// motion would take energy from still water.
    LeastDamping,
    /// `(max - min) / |mean|` of the total heave of `A(w) - Im K(i w) / w` over 1.2 to 3.25 rad/s: 0 where A and B are of one
    /// causal water (Kramers and Kronig).
    KramersKronig,
    /// The total heave of the added mass at infinite frequency that is used `[kg]`.
    TotalHeaveInfinite,
    /// `|used / given - 1|` of the total heave of the added mass at infinite frequency. Only for tables that give one.
    InfiniteOfTable,
}

/// A bound of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// What lies above is beyond the limit.
    AtMost(f64),
    /// What lies below is beyond the limit.
    AtLeast(f64),
}

impl Limit {
    /// Whether a figure keeps the limit. NaN does not.
    pub fn keeps(self, figure: f64) -> bool {
        match self {
            Self::AtMost(limit) => figure <= limit,
            Self::AtLeast(limit) => figure >= limit,
        }
    }
}

/// What came of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// The figure is usual.
    Holds,
    /// The figure is not usual, and not refused.
    Warns,
    /// The figure is beyond the limit, or there is none.
    Refused,
}

impl CheckName {
    /// All checks.
    pub const ALL: [Self; 9] = [
        Self::NotNumbers,
        Self::LastUsed,
        Self::AddedMassAsymmetry,
        Self::DampingAsymmetry,
        Self::Mirror,
        Self::LeastDamping,
        Self::KramersKronig,
        Self::TotalHeaveInfinite,
        Self::InfiniteOfTable,
    ];

    /// The check's name in files and messages.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::NotNumbers => "not_numbers",
            Self::LastUsed => "last_used_rad_s",
            Self::AddedMassAsymmetry => "added_mass_asymmetry",
            Self::DampingAsymmetry => "damping_asymmetry",
            Self::Mirror => "mirror",
            Self::LeastDamping => "least_damping",
            Self::KramersKronig => "kramers_kronig",
            Self::TotalHeaveInfinite => "total_heave_infinite_kg",
            Self::InfiniteOfTable => "infinite_of_table",
        }
    }

    /// The limit beyond which a table is refused.
    ///
    /// A boundary-element table of good settings has asymmetries to 2e-3 (A) and 5e-3 (B), a mirror error of rounding, a least
    /// eigenvalue of B of -3e-5 of the largest and a Kramers-Kronig spread of 0.6 %. Wrong settings are off by tens of per cent.
    /// The used copies are averaged over transpose and mirror, so what is averaged away is bounded alike.
    pub fn refuses(self) -> Option<Limit> {
        match self {
            Self::NotNumbers => Some(Limit::AtMost(0.0)),
            Self::LastUsed => Some(Limit::AtLeast(4.0)),
            Self::AddedMassAsymmetry | Self::DampingAsymmetry | Self::Mirror => Some(Limit::AtMost(0.02)),
            Self::LeastDamping => Some(Limit::AtLeast(-0.01)),
            Self::KramersKronig => Some(Limit::AtMost(0.03)),
            Self::TotalHeaveInfinite => Some(Limit::AtLeast(0.0)),
            Self::InfiniteOfTable => None,
        }
    }

    /// The limit beyond which a table warns: beyond what good settings give.
    pub fn warns(self) -> Option<Limit> {
        match self {
            Self::NotNumbers | Self::TotalHeaveInfinite => None,
            Self::LastUsed => Some(Limit::AtLeast(5.0)),
            Self::AddedMassAsymmetry | Self::DampingAsymmetry | Self::Mirror => Some(Limit::AtMost(0.01)),
            Self::LeastDamping => Some(Limit::AtLeast(-0.001)),
            Self::KramersKronig => Some(Limit::AtMost(0.01)),
            Self::InfiniteOfTable => Some(Limit::AtMost(0.05)),
        }
    }
}

/// A check of a table: its name and its figure, with the unit that the name tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Check {
    /// What was checked.
    pub name: CheckName,
    /// What was found. NaN where the table allows no figure.
    pub figure: f64,
}

impl Check {
    /// What comes of the figure.
    pub fn outcome(&self) -> Outcome {
        let keeps = |limit: Option<Limit>| limit.is_none_or(|limit| limit.keeps(self.figure));
        if self.figure.is_nan() || !keeps(self.name.refuses()) {
            Outcome::Refused
        } else if keeps(self.name.warns()) {
            Outcome::Holds
        } else {
            Outcome::Warns
        }
    }

    /// All checks of a table in a band, in the order of [`CheckName`]. `kernel` is the table's own in that band; without one
    /// there is no figure of what hangs on it.
    ///
    /// # Errors
    /// [`InvalidInput`] on `length_m` where the scales are of another chain.
    pub fn all(
        table: &RadiationTable,
        scales: &Scales,
        band: Band,
        kernel: Option<&Kernel>,
    ) -> Result<Vec<Self>, InvalidInput> {
        table.fits(scales)?;
        let used = table.used(band.usable_to_rad_s);
        let omega_rad_s = &table.omega_rad_s()[..used];
        let scaled =
            |matrices: &[DMatrix<f64>]| -> Vec<_> { matrices[..used].iter().map(|x| scales.scaled(x)).collect() };
        let (a, mut b) = (scaled(table.added_mass()), scaled(table.radiation_damping()));
        if omega_rad_s.first() == Some(&0.0) {
            b.remove(0);
        }
        let infinite = kernel.and_then(|kernel| added_mass_infinite(kernel, table, scales, Window::TRANSFER).ok());
        let total = infinite.as_ref().map_or(f64::NAN, total_heave);
        let mut checks = Vec::new();
        let mut add = |name, figure| checks.push(Self { name, figure });
        add(CheckName::NotNumbers, table.not_numbers(used) as f64);
        add(CheckName::LastUsed, omega_rad_s.last().copied().unwrap_or(f64::NAN));
        add(CheckName::AddedMassAsymmetry, largest(&a, asymmetry));
        add(CheckName::DampingAsymmetry, largest(&b, asymmetry));
        if scales.mirror_equal() {
            let error = |x: &DMatrix<f64>| {
                let x = symmetric(x);
                share((&x - scales.mirrored(&x)).amax(), x.amax())
            };
            add(CheckName::Mirror, worse(largest(&a, error), largest(&b, error)));
        }
        add(CheckName::LeastDamping, -largest(&b, |x| -least_over_largest(x)));
        add(CheckName::KramersKronig, spread(table, scales, kernel)?);
        add(CheckName::TotalHeaveInfinite, total);
        if let Some(given) = table.infinite() {
            add(CheckName::InfiniteOfTable, (total / total_heave(given) - 1.0).abs());
        }
        Ok(checks)
    }
}

/// The larger of two figures, NaN where one is.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The largest figure of matrices; NaN where one is, and where there is no matrix.
fn largest(matrices: &[DMatrix<f64>], figure: impl Fn(&DMatrix<f64>) -> f64) -> f64 {
    matrices.iter().map(figure).reduce(worse).unwrap_or(f64::NAN)
}

/// `part / whole`, 0 where both are 0.
fn share(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

fn symmetric(x: &DMatrix<f64>) -> DMatrix<f64> {
    (x + x.transpose()) / 2.0
}

fn finite(x: &DMatrix<f64>) -> bool {
    x.iter().all(|entry| entry.is_finite())
}

fn asymmetry(x: &DMatrix<f64>) -> f64 {
    if finite(x) {
        share((x - x.transpose()).amax(), x.amax())
    } else {
        f64::NAN
    }
}

/// The least eigenvalue over the largest of one sign or the other; NaN where entries are no numbers.
fn least_over_largest(x: &DMatrix<f64>) -> f64 {
    if !finite(x) {
        return f64::NAN;
    }
    let eigenvalues = symmetric(x).symmetric_eigenvalues();
    share(eigenvalues.min(), eigenvalues.amax())
}

/// The spread of the total heave of the constants of Kramers and Kronig; NaN without a kernel or with fewer than two of them.
fn spread(table: &RadiationTable, scales: &Scales, kernel: Option<&Kernel>) -> Result<f64, InvalidInput> {
    let Some(kernel) = kernel else { return Ok(f64::NAN) };
    let constants = kramers_kronig(kernel, table, scales, Window::TRANSFER, KRAMERS_KRONIG_FROM_TO_RAD_S)?;
    if constants.len() < 2 || constants.iter().any(|(_, a)| !finite(a)) {
        return Ok(f64::NAN);
    }
    let totals: Vec<f64> = constants.iter().map(|(_, a)| total_heave(a)).collect();
    let mean = totals.iter().sum::<f64>() / totals.len() as f64;
    let [least, most] = totals
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], &total| {
            [least.min(total), most.max(total)]
        });
    Ok(share(most - least, mean.abs()))
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{MadeUp, heaving_box, made_up};
    use super::*;

    fn all(table: &RadiationTable, scales: &Scales) -> Vec<Check> {
        let kernel = Kernel::new(table, scales, Band::default()).ok();
        Check::all(table, scales, Band::default(), kernel.as_ref()).unwrap()
    }

    /// The check of a name of a table that is made up, then changed.
    fn changed(name: CheckName, change: impl Fn(&mut MadeUp)) -> (f64, Outcome) {
        let mut made_up = made_up();
        change(&mut made_up);
        let checks = all(&made_up.table(), &made_up.scales);
        let check = checks.iter().find(|check| check.name == name).unwrap();
        (check.figure, check.outcome())
    }

    fn scale(matrices: &mut [DMatrix<f64>], factor: f64) {
        for matrix in matrices {
            *matrix *= factor;
        }
    }

    #[test]
    fn all_hold_of_one_causal_symmetric_passive_water() {
        let made_up = made_up();
        let checks = all(&made_up.table(), &made_up.scales);
        assert_eq!(checks.len(), 9);
        for check in checks {
            assert_eq!(check.outcome(), Outcome::Holds, "{check:?}");
        }
    }

    #[test]
    fn a_matrix_that_is_not_its_transpose_is_refused() {
        let skewed = |x: &mut DMatrix<f64>, by: f64| {
            let largest = x.amax();
            let scaled = if x[(3, 0)] > 0.0 { by } else { -by };
            x[(0, 3)] += scaled * largest;
        };
        let of_a = |by: f64| changed(CheckName::AddedMassAsymmetry, |m| skewed(&mut m.a[7], by));
        let of_b = |by: f64| changed(CheckName::DampingAsymmetry, |m| skewed(&mut m.b[7], by));
        for (figure, outcome) in [of_a(0.05), of_b(0.05)] {
            assert!(figure > 0.02 && outcome == Outcome::Refused, "{figure} {outcome:?}");
        }
        assert!(of_a(0.001).1 == Outcome::Holds && of_b(0.001).1 == Outcome::Holds);
        // beyond the used band nothing is asked
        assert_eq!(
            changed(CheckName::AddedMassAsymmetry, |m| skewed(&mut m.a[30], 0.5)).1,
            Outcome::Holds
        );
    }

    #[test]
    fn a_chain_that_differs_from_its_mirror_is_refused() {
        let (figure, outcome) = changed(CheckName::Mirror, |m| m.a[3][(0, 0)] *= 1.05);
        assert!(figure > 0.02 && outcome == Outcome::Refused, "{figure}");
        let mut made_up = made_up();
        made_up.scales = Scales::new(&[4.0, 4.1], 3.0).unwrap();
        let checks = all(&made_up.table(), &made_up.scales);
        assert!(checks.iter().all(|check| check.name != CheckName::Mirror));
    }

    #[test]
    fn damping_below_zero_is_refused() {
        let at = |ratio: f64| changed(CheckName::LeastDamping, |m| m.set_least_damping(2.0, ratio));
        for (ratio, expected) in [
            (-0.012, Outcome::Refused),
            (-0.008, Outcome::Warns),
            (-0.0005, Outcome::Holds),
        ] {
            let (figure, outcome) = at(ratio);
            assert!((figure - ratio).abs() < 1e-9, "{figure}");
            assert_eq!(outcome, expected);
        }
    }

    #[test]
    fn damping_that_is_not_of_the_added_mass_shows_in_the_constants() {
        let (five, outcome) = changed(CheckName::KramersKronig, |m| scale(&mut m.b, 1.05));
        assert!(five > 0.01 && outcome == Outcome::Warns, "{five}");
        assert_eq!(
            changed(CheckName::KramersKronig, |m| scale(&mut m.b, 1.2)).1,
            Outcome::Refused
        );
        for place in [0, 1] {
            let outcome = |factor: f64| {
                let (table, scales) = heaving_box(place, factor);
                let checks = all(&table, &scales);
                let check = checks
                    .iter()
                    .find(|check| check.name == CheckName::KramersKronig)
                    .unwrap();
                (check.figure, check.outcome())
            };
            let (figure, holds) = outcome(1.0);
            assert!(figure < 0.007 && holds == Outcome::Holds, "{figure}");
            assert_eq!([0.95, 1.05].map(|factor| outcome(factor).1), [Outcome::Warns; 2]);
            assert_eq!(outcome(1.2).1, Outcome::Refused);
        }
    }

    #[test]
    fn short_bands_negative_masses_and_other_infinities() {
        let cut = |to: f64| {
            changed(CheckName::LastUsed, |m| {
                let n = m.place(to) + 1;
                m.omega.truncate(n);
                m.a.truncate(n);
                m.b.truncate(n);
            })
        };
        assert_eq!([3.8, 4.4].map(|to| cut(to).1), [Outcome::Refused, Outcome::Warns]);
        let light = |m: &mut MadeUp| {
            let residue = &m.residue * 1.3;
            m.a.iter_mut().for_each(|a| *a -= &residue);
        };
        let (total, outcome) = changed(CheckName::TotalHeaveInfinite, light);
        assert!(total < 0.0 && outcome == Outcome::Refused, "{total}");
        let (off, outcome) = changed(CheckName::InfiniteOfTable, |m| m.infinite /= 1.06);
        assert!((off - 0.06).abs() < 1e-3 && outcome == Outcome::Warns, "{off}");
    }

    #[test]
    fn what_is_no_number_is_counted_and_leaves_no_figure() {
        let hole = |m: &mut MadeUp| m.b[4][(1, 2)] = f64::NAN;
        assert_eq!(changed(CheckName::NotNumbers, hole), (1.0, Outcome::Refused));
        for name in [
            CheckName::DampingAsymmetry,
            CheckName::LeastDamping,
            CheckName::KramersKronig,
        ] {
            let (figure, outcome) = changed(name, hole);
            assert!(figure.is_nan() && outcome == Outcome::Refused, "{name:?}");
        }
        assert_eq!(changed(CheckName::AddedMassAsymmetry, hole).1, Outcome::Holds);
    }
}
