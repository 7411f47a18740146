//! Sums of products over one lane's numbers, in an order that is the same on every instruction path.
//!
//! Knows lists of numbers. Does not know what they mean.

/// `sum := sum + w x`.
#[inline(always)]
pub(super) fn add_to(sum: &mut [f64], w: f64, x: &[f64]) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum = w.mul_add(*x, *sum);
    }
}

/// Dot product in eight running sums, so that the order is one and the same on every path.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let mut sums = [0.0; 8];
    let (a8, a_rest) = a.as_chunks::<8>();
    let (b8, b_rest) = b.as_chunks::<8>();
    for (a, b) in a8.iter().zip(b8) {
        for i in 0..8 {
            sums[i] = f64::mul_add(a[i], b[i], sums[i]);
        }
    }
    let mut sum = ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    for (a, b) in a_rest.iter().zip(b_rest) {
        sum = a.mul_add(*b, sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::{add_to, dot};

    fn numbers(n: usize, phase: f64) -> Vec<f64> {
        (0..n).map(|i| (1.3 * i as f64 + phase).sin()).collect()
    }

    /// At every remainder by eight, and with lists of unequal length; 1e-14: rounding of 20 numbers below 1. A number that is
    /// 5 % off is found.
    #[test]
    fn dot_product_is_the_plain_one() {
        for n in 0..=20 {
            let (a, mut b) = (numbers(n, 0.2), numbers(n + 3, 1.1));
            let plain: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert!((dot(&a, &b) - plain).abs() < 1e-14, "{n} numbers");
            if n > 0 {
                b[0] *= 1.05;
                assert!((dot(&a, &b) - plain).abs() > 1e-3, "a wrong number passes");
            }
        }
    }

    /// `1 + 2 x 0.5`.
    #[test]
    fn weighted_numbers_are_added() {
        let mut sum = [1.0, 3.0];
        add_to(&mut sum, 2.0, &[0.5]);
        assert_eq!(sum, [2.0, 3.0]);
    }
}
