//! The added mass at infinite frequency that belongs to a kernel.
//!
//! Knows a kernel's transfer function and a table's added mass. Does not know what their difference is used for.

use super::{Kernel, RadiationTable, Scales, Window};
use crate::input::InvalidInput;
use nalgebra::DMatrix;

/// The band over which the added mass at infinite frequency is averaged `[rad/s]`: where a bridge moves.
const INFINITE_FROM_TO_RAD_S: [f64; 2] = [1.4, 3.0];

/// The added mass at infinite frequency by Kramers and Kronig at each frequency w of a table in `[from, to]` `[rad/s]`:
/// w and `A(w) - Im K(i w) / w`, which is one matrix at all w where A and B are of one water. A is symmetrised.
///
/// # Errors
/// [`InvalidInput`] on `length_m` where the scales are of another chain.
pub fn kramers_kronig(
    kernel: &Kernel,
    table: &RadiationTable,
    scales: &Scales,
    window: Window,
    from_to_rad_s: [f64; 2],
) -> Result<Vec<(f64, DMatrix<f64>)>, InvalidInput> {
    let table = table.symmetrised(scales)?;
    let [from, to] = from_to_rad_s;
    let all = table.omega_rad_s().iter().zip(table.added_mass());
    let within = all.filter(|&(&omega, _)| omega > 0.0 && omega >= from && omega <= to);
    let constants = within.map(|(&omega, a)| (omega, a - kernel.transfer(omega, window).map(|k| k.im / omega)));
    Ok(constants.collect())
}

/// The added mass at infinite frequency that makes `A(w)` of this kernel right where a bridge moves: the mean of
/// [`kramers_kronig`](fn@kramers_kronig) over the table's frequencies of 1.4 to 3 rad/s, `[kg, kg m, kg m^2]` by pairs.
///
/// # Errors
/// [`InvalidInput`] on `omega_rad_s` where the table has none there, on `length_m` as above.
pub fn added_mass_infinite(
    kernel: &Kernel,
    table: &RadiationTable,
    scales: &Scales,
    window: Window,
) -> Result<DMatrix<f64>, InvalidInput> {
    let constants = kramers_kronig(kernel, table, scales, window, INFINITE_FROM_TO_RAD_S)?;
    if constants.is_empty() {
        return Err(InvalidInput::new(
            "omega_rad_s",
            0_usize,
            "at least 1 frequency from 1.4 to 3 rad/s",
        ));
    }
    let count = constants.len() as f64;
    let zero = DMatrix::zeros(kernel.freedoms(), kernel.freedoms());
    Ok(constants.into_iter().fold(zero, |sum, (_, a)| sum + a) / count)
}

#[cfg(test)]
mod tests {
    use super::super::Band;
    use super::super::fixture::{heaving_box, made_up};
    use super::super::table::total_heave;
    use super::*;

    #[test]
    fn two_boxes_have_one_added_mass_at_infinity_at_all_frequencies() {
        // k(0) and the mean of the constants per metre, by a separate program in Python over all 45 freedoms
        for (place, k0, infinite) in [(0, 46.19e3, 16.25e3), (1, 68.65e3, 27.00e3)] {
            let figures = |factor: f64| {
                let (table, scales) = heaving_box(place, factor);
                let kernel = Kernel::new(&table, &scales, Band::default()).unwrap();
                let constants = kramers_kronig(&kernel, &table, &scales, Window::TRANSFER, [1.2, 3.25]).unwrap();
                assert_eq!(constants.len(), 11);
                let mut totals: Vec<f64> = constants.iter().map(|(_, a)| total_heave(a) / infinite).collect();
                totals.sort_by(f64::total_cmp);
                let mean = total_heave(&added_mass_infinite(&kernel, &table, &scales, Window::TRANSFER).unwrap());
                // with and without the lowest, that of 1.4 rad/s
                let spreads = [totals[10] - totals[1], totals[10] - totals[0]];
                (
                    (total_heave(&kernel.at(0.0)) / k0 - 1.0).abs(),
                    (mean / infinite - 1.0).abs(),
                    spreads,
                )
            };
            let (of_k0, of_mass, spreads) = figures(1.0);
            assert!(of_k0 < 1e-3 && of_mass < 1e-3, "{of_k0} {of_mass}");
            assert!(spreads[0] < 0.0055 && spreads[1] < 0.007, "{spreads:?}");
            let (of_k0, of_mass, spreads) = figures(0.95);
            assert!(
                of_k0 > 0.04 && of_mass > 5e-3 && spreads[1] > 0.01,
                "{of_k0} {of_mass} {spreads:?}"
            );
        }
    }

    #[test]
    fn a_table_without_frequencies_in_the_middle_is_refused() {
        let made_up = made_up();
        let kernel = Kernel::new(&made_up.table(), &made_up.scales, Band::default()).unwrap();
        let (a, b) = (made_up.a[..6].to_vec(), made_up.b[..6].to_vec());
        let low = RadiationTable::new(2, made_up.omega[..6].to_vec(), a, b, None).unwrap();
        let refused = added_mass_infinite(&kernel, &low, &made_up.scales, Window::STATES).unwrap_err();
        assert_eq!(refused.key, "omega_rad_s");
    }
}
