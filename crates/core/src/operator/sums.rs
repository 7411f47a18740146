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
