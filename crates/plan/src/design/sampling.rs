//! Numbers from 0 to 1 that fill a space evenly: parts that are hit once each, and Sobol' points.
//!
//! Knows seeds, counts and dimensions. Does not know axes. The numbers of a seed never change: they rest on the blake3
//! hash, the generator PCG64 and the direction numbers of Joe and Kuo (2008).

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sobol::Sobol;
use sobol::params::JoeKuoD6;
use sobol_burley::parts::owen_scramble_rev;

/// Places that a point may have within its part of a range, as a power of two: coarse enough for `part + place` to be
/// exact for as many parts as a design may have.
const PLACE_BITS: u32 = 26;

/// 32 bytes that look random and are equal for equal words.
pub(super) fn key(design: &str, seed: u64, of: &str) -> [u8; 32] {
    *blake3::hash(format!("{design} {seed} {of}").as_bytes()).as_bytes()
}

/// A number drawn evenly from 0 to `count - 1`.
pub(super) fn below(random: &mut Pcg64, count: usize) -> usize {
    // the upper half of the product is evenly spread
    ((u128::from(random.next_u64()) * count as u128) >> 64) as usize
}

/// One coordinate of a Latin hypercube of `count` points: each of as many equal parts of 0 to 1 is hit once, in an order
/// drawn at random and at a place drawn at random.
#[derive(Debug, Clone)]
pub(super) struct LatinHypercubeAxis {
    /// The part of each point.
    parts: Vec<u32>,
    random: Pcg64,
}

impl LatinHypercubeAxis {
    /// The coordinate of a name, which another coordinate beside it does not change.
    pub(super) fn new(count: usize, seed: u64, name: &str) -> Self {
        let mut random = Pcg64::from_seed(key("latin_hypercube", seed, name));
        let mut parts: Vec<u32> = (0..count as u32).collect();
        for last in (1..count).rev() {
            parts.swap(last, below(&mut random, last + 1));
        }
        Self { parts, random }
    }

    /// The coordinate of a point; to be asked point by point.
    pub(super) fn share(&mut self, point: usize) -> f64 {
        let place = (self.random.next_u64() >> (64 - PLACE_BITS)) as f64 + 0.5;
        let place = place / f64::from(1_u32 << PLACE_BITS);
        (f64::from(self.parts[point]) + place) / self.parts.len() as f64
    }
}

/// Points of the Sobol' sequence under Owen's nested scrambling, one after the other: in each coordinate the first `2^k`
/// points hit each of `2^k` equal parts of 0 to 1 once.
///
/// The digits are those of Joe and Kuo (Constructing Sobol sequences with better two-dimensional projections, SIAM J. Sci.
/// Comput. 30, 2008) by the crate `sobol`, which has 2^32 points of 32 bits; the scrambling is Burley's (Practical
/// hash-based Owen scrambling, JCGT 9, 2020) by the crate `sobol_burley`, whose own sequence ends at 2^16 points of 23 bits.
pub(super) struct SobolPoints {
    digits: Sobol<u32>,
    /// One a coordinate.
    scrambles: Vec<u32>,
}

impl SobolPoints {
    /// Most coordinates.
    pub(super) const MOST_DIMENSIONS: usize = 100;

    /// The sequence of a seed from its first point, for at most [`Self::MOST_DIMENSIONS`] coordinates. A coordinate does
    /// not depend on how many follow.
    pub(super) fn new(dimensions: usize, seed: u64) -> Self {
        let scramble = |dimension: usize| {
            let [a, b, c, d, ..] = key("sobol", seed, &dimension.to_string());
            u32::from_le_bytes([a, b, c, d])
        };
        Self {
            digits: Sobol::new(dimensions, &JoeKuoD6::minimal()),
            scrambles: (0..dimensions).map(scramble).collect(),
        }
    }
}

impl Iterator for SobolPoints {
    type Item = Vec<f64>;

    fn next(&mut self) -> Option<Self::Item> {
        let share = |(digits, &scramble): (u32, &u32)| {
            let scrambled = owen_scramble_rev(digits.reverse_bits(), scramble).reverse_bits();
            (f64::from(scrambled) + 0.5) / 2.0_f64.powi(32)
        };
        Some(
            self.digits
                .next()?
                .into_iter()
                .zip(&self.scrambles)
                .map(share)
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sobol_burley::parts::sobol_rev;

    /// The parts, of `count` equal ones, that some numbers from 0 to 1 are in, sorted.
    fn parts(shares: impl Iterator<Item = f64>, count: usize) -> Vec<usize> {
        let mut parts: Vec<usize> = shares.map(|s| (s * count as f64) as usize).collect();
        parts.sort_unstable();
        parts
    }

    fn strata(count: usize, seed: u64, name: &str) -> Vec<f64> {
        let mut strata = LatinHypercubeAxis::new(count, seed, name);
        (0..count).map(|i| strata.share(i)).collect()
    }

    #[test]
    fn numbers_of_a_seed_never_change() {
        assert_eq!(strata(4, 1, "speed_m_s"), STRATA);
        let points: Vec<Vec<f64>> = SobolPoints::new(2, 1).take(4).collect();
        assert_eq!(points, SOBOL);
    }

    /// Written down once: no later version of this program may give others.
    const STRATA: [f64; 4] = [
        0.5827750843018293,
        0.016617516055703163,
        0.47658791579306126,
        0.7642179932445288,
    ];
    const SOBOL: [[f64; 2]; 4] = [
        [0.9739417283562943, 0.04829837486613542],
        [0.1776068339822814, 0.9524286097148433],
        [0.3521200875984505, 0.4550401308806613],
        [0.73180451488588, 0.6973601268837228],
    ];

    #[test]
    fn the_largest_design_hits_each_part_once() {
        let count = super::super::values::MOST_POINTS;
        let mut strata = LatinHypercubeAxis::new(count, 7, "x");
        let mut hit = vec![false; count];
        for i in 0..count {
            let part = (strata.share(i) * count as f64) as usize;
            assert!(!std::mem::replace(&mut hit[part], true), "part {part} twice");
        }
    }

    #[test]
    fn an_order_is_any_order() {
        // the first of three parts is in each place about as often, over many seeds
        let mut places = [0; 3];
        for seed in 0..3000 {
            let order = strata(3, seed, "x");
            places[order.iter().position(|s| *s < 1.0 / 3.0).unwrap()] += 1;
        }
        assert!(places.iter().all(|n| (900..1100).contains(n)), "{places:?}");
    }

    #[test]
    fn both_libraries_have_the_same_digits() {
        for (i, digits) in (0_u32..).zip(Sobol::<u32>::new(100, &JoeKuoD6::minimal()).take(4096)) {
            // the one goes through the points of each power of two in the order of Gray's code
            let gray = i ^ (i >> 1);
            for (dimension, digits) in (0..).zip(digits) {
                let other = sobol_rev(gray.reverse_bits(), dimension).reverse_bits();
                assert_eq!(digits, other, "point {i}, dimension {dimension}");
            }
        }
    }

    #[test]
    fn two_coordinates_of_sobol_points_fill_every_box_of_a_square_once() {
        // the first two dimensions of 2^k points: one in each box of 2^a by 2^(k - a)
        let points: Vec<Vec<f64>> = SobolPoints::new(2, 3).take(64).collect();
        for a in 0..=6 {
            let (across, along) = (1 << a, 64 >> a);
            let boxes = points.iter().map(|p| {
                let place = |share: f64, count: usize| (share * count as f64) as usize;
                place(p[0], across) * along + place(p[1], along)
            });
            let mut boxes: Vec<usize> = boxes.collect();
            boxes.sort_unstable();
            assert_eq!(boxes, (0..64).collect::<Vec<_>>(), "2^{a}");
        }
    }

    #[test]
    fn scrambled_points_are_not_the_plain_ones_and_dimensions_are_not_alike() {
        let points: Vec<Vec<f64>> = SobolPoints::new(2, 0).take(256).collect();
        assert!(points.iter().all(|p| p.iter().all(|s| *s > 0.0 && *s < 1.0)));
        let mean = |f: &dyn Fn(&Vec<f64>) -> f64| points.iter().map(f).sum::<f64>() / 256.0;
        let both = mean(&|p| (p[0] - 0.5) * (p[1] - 0.5));
        assert!(both.abs() < 0.01, "{both}");
        assert_ne!(points[0], [0.5 / 2.0_f64.powi(32); 2]);
    }

    proptest! {
        #[test]
        fn each_part_is_hit_once(count in 1_usize..500, seed: u64) {
            let all: Vec<usize> = (0..count).collect();
            prop_assert_eq!(parts(strata(count, seed, "a").into_iter(), count), all);
        }

        #[test]
        fn the_same_seed_gives_the_same_points_and_another_others(count in 8_usize..100, seed: u64) {
            prop_assert_eq!(strata(count, seed, "a"), strata(count, seed, "a"));
            prop_assert_ne!(strata(count, seed, "a"), strata(count, seed, "b"));
            prop_assert_ne!(strata(count, seed, "a"), strata(count, seed ^ 1, "a"));
            let points = |seed| SobolPoints::new(3, seed).take(count).collect::<Vec<_>>();
            prop_assert_eq!(points(seed), points(seed));
            prop_assert_ne!(points(seed), points(seed ^ 1));
        }

        #[test]
        fn sobol_points_hit_each_part_of_each_coordinate_once(
            power in 0_u32..11, dimensions in 1_usize..20, seed: u64,
        ) {
            let count = 1_usize << power;
            let points: Vec<Vec<f64>> = SobolPoints::new(dimensions, seed).take(count).collect();
            let all: Vec<usize> = (0..count).collect();
            for dimension in 0..dimensions {
                prop_assert_eq!(&parts(points.iter().map(|p| p[dimension]), count), &all);
            }
        }

        #[test]
        fn a_coordinate_does_not_depend_on_those_behind_it(dimensions in 2_usize..10, seed: u64) {
            let few = SobolPoints::new(dimensions - 1, seed).take(50);
            let many = SobolPoints::new(dimensions, seed).take(50);
            for (few, many) in few.zip(many) {
                prop_assert_eq!(&few[..], &many[..dimensions - 1]);
            }
        }
    }
}
