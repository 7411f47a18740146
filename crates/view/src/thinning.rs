//! A few places that stand for many.
//!
//! Knows lists of numbers. Does not know what is drawn of them.

/// Stretches of a history, of each of which its smallest and its largest value are kept.
const STRETCHES: usize = 400;

/// At most `most` places of a list of a length, evenly spread, with both ends.
pub(crate) fn spread(length: usize, most: usize) -> Vec<usize> {
    if length <= most {
        return (0..length).collect();
    }
    (0..most).map(|i| i * (length - 1) / (most - 1).max(1)).collect()
}

/// Places of a list that keep its first, its last, and the smallest and the largest of each stretch.
pub(crate) fn thinned(values: &[f64]) -> Vec<usize> {
    if values.len() <= 2 * STRETCHES {
        return (0..values.len()).collect();
    }
    let mut kept = vec![0, values.len() - 1];
    for stretch in 0..STRETCHES {
        let (from, to) = (
            stretch * values.len() / STRETCHES,
            (stretch + 1) * values.len() / STRETCHES,
        );
        let of = |i: &usize| values[*i];
        let by = |a: &usize, b: &usize| of(a).total_cmp(&of(b)).then(b.cmp(a));
        kept.extend((from..to).min_by(by));
        kept.extend((from..to).max_by(by));
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_lists_keep_their_ends_and_peaks() {
        let mut values: Vec<f64> = (0..5000).map(|i| f64::sin(0.01 * f64::from(i))).collect();
        values[1234] = 9.0;
        values[3333] = -9.0;
        let kept = thinned(&values);
        assert!(kept.len() <= 2 * STRETCHES + 2 && kept.windows(2).all(|w| w[0] < w[1]));
        assert!([0, 1234, 3333, 4999].iter().all(|place| kept.contains(place)));
        assert_eq!(thinned(&values[..10]).len(), 10);
    }

    #[test]
    fn places_are_spread_evenly_with_both_ends() {
        assert_eq!(spread(3, 4), [0, 1, 2]);
        assert_eq!(spread(20, 4), [0, 6, 12, 19]);
    }
}
