//! What is added to exponentials so that they take energy at every frequency.
//!
//! Knows where they give energy. Does not know where they come from.

use super::exponentials::{Exponentials, middle, sampled};
use super::state_step::exponential;
use nalgebra::{Complex, DMatrix, SymmetricEigen};

/// Poles of the filters `[1/s]`: below 2 rad/s and above 6 rad/s exponentials of few states ripple about damping that is almost 0.
/// A dashpot for all frequencies would damp the fast motions of joints as well, and change their forces by 0.4 %.
const FILTERS_1_S: [[f64; 2]; 4] = [[-0.4, 0.3], [-0.35, 1.3], [-0.8, 7.3], [-1.5, 9.0]];

/// Times that filters are raised at most.
const ROUNDS: usize = 200;

/// A filter on the motions of a group: it adds `D Re e^(s t)` to their kernel.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    /// s `[1/s]`.
    pub pole_1_s: Complex<f64>,
    /// D `[N/m]`, symmetric and without eigenvalues below 0.
    pub stiffness_n_m: DMatrix<f64>,
}

impl Filter {
    /// What it adds to the kernel `[N/m]`.
    pub(super) fn at(&self, t_s: f64) -> DMatrix<f64> {
        &self.stiffness_n_m * exponential(self.pole_1_s * t_s).re
    }
}

/// The filters that make Re K(i w) have no eigenvalue below 0 at the frequencies sampled: where it is lowest the filter that helps
/// most there is raised by what is missing in each direction, again and again.
pub(super) fn filters(of: &Exponentials) -> Vec<Filter> {
    let motions = of.shapes.nrows();
    let poles: Vec<Complex<f64>> = FILTERS_1_S.iter().map(|&[re, im]| Complex::new(re, im)).collect();
    let mut filters: Vec<DMatrix<f64>> = vec![DMatrix::zeros(motions, motions); poles.len()];
    let mut sums: Vec<(f64, DMatrix<f64>, f64)> = sampled(1)
        .map(|w| {
            let taking = of.taking(w);
            let least = taking.symmetric_eigenvalues().min();
            (w, taking, least)
        })
        .collect();
    for _ in 0..ROUNDS {
        let lowest = sums.iter().min_by(|a, b| a.2.total_cmp(&b.2));
        let Some((w, taking, _)) = lowest.filter(|lowest| lowest.2 < 0.0) else {
            break;
        };
        let helps = |pole: &Complex<f64>| middle(*pole, *w).re;
        let best = (0..poles.len()).max_by(|&a, &b| helps(&poles[a]).total_cmp(&helps(&poles[b])));
        let Some(best) = best else { break };
        let mut eigen = SymmetricEigen::new(taking.clone());
        eigen
            .eigenvalues
            .apply(|value| *value = (-*value).max(0.0) / helps(&poles[best]));
        let more = eigen.recompose();
        for (w, taking, least) in &mut sums {
            *taking += &more * middle(poles[best], *w).re;
            // what lay above 0 can only have risen
            if *least < 0.0 {
                *least = taking.symmetric_eigenvalues().min();
            }
        }
        filters[best] += more;
    }
    let of = |(pole_1_s, stiffness_n_m)| Filter {
        pole_1_s,
        stiffness_n_m,
    };
    let all = poles.into_iter().zip(filters).map(of);
    all.filter(|filter| filter.stiffness_n_m.amax() > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two motions whose exponentials give energy at all frequencies above 2.3 rad/s in one direction, `Re K` of the other being large.
    fn giving() -> Exponentials {
        let c = Complex::new;
        Exponentials {
            poles_1_s: vec![c(-0.3, 2.0), c(-0.4, 7.0)],
            shapes: DMatrix::from_column_slice(2, 2, &[c(3.0, 0.0), c(2.0, 0.0), c(0.0, 0.2), c(0.0, -0.1)]),
        }
    }

    /// The least eigenvalue of Re K(i w) over the frequencies, with filters of which `factor` is taken.
    fn least(factor: f64) -> f64 {
        let of = giving();
        let filters = filters(&of);
        let at = |w: f64| {
            let own = filters
                .iter()
                .map(|filter| &filter.stiffness_n_m * middle(filter.pole_1_s, w).re);
            own.fold(of.taking(w), |sum, own| sum + own * factor)
                .symmetric_eigenvalues()
                .min()
        };
        sampled(1).map(at).fold(f64::INFINITY, f64::min)
    }

    /// Rounding of entries near 10; filters 5 % weaker leave a twentieth of what was below 0.
    #[test]
    fn filters_leave_no_eigenvalue_below_zero() {
        assert!(least(0.0) < -0.05, "{}", least(0.0));
        assert!(least(1.0) > -1e-12, "{:e}", least(1.0));
        assert!(least(0.95) < -1e-4, "{:e}", least(0.95));
    }

    #[test]
    fn passive_exponentials_need_no_filters() {
        let of = Exponentials {
            poles_1_s: vec![Complex::new(-1.0, 0.0)],
            shapes: DMatrix::from_element(1, 1, Complex::new(2.0, 0.0)),
        };
        assert_eq!(filters(&of), []);
    }
}
