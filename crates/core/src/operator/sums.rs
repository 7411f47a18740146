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

#[cfg(test)]
mod tests {
    use super::add_to;

    /// `1 + 2 x 0.5`.
    #[test]
    fn weighted_numbers_are_added() {
        let mut sum = [1.0, 3.0];
        add_to(&mut sum, 2.0, &[0.5]);
        assert_eq!(sum, [2.0, 3.0]);
    }
}
