//! Wear: how the gaps of joints scatter about their nominal values.
//!
//! Knows the numbers of a seed. Does not know which gaps a job has.

use pontoon_core::input::{InvalidInput, Problem, not_negative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// By how much the gaps of each joint differ from their nominal values, drawn joint by joint from the seed of a job.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WearSpec {
    /// Of the tension gap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap_tension_m: Option<ScatterSpec>,
    /// Of the compression gap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap_compression_m: Option<ScatterSpec>,
}

/// `gap = nominal + s x`, x drawn for each joint; a gap below 0 is 0. Exactly one of the two.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScatterSpec {
    /// Standard deviation s, x of the normal distribution `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<f64>,
    /// Most wear s, x evenly spread over 0 to 1 `[m]`; below 0 for gaps that get smaller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform: Option<f64>,
}

/// The gaps in the order of [`WearSpec`], by their keys.
const WORN_GAPS: [&str; 2] = ["gap_tension_m", "gap_compression_m"];

impl WearSpec {
    /// The scatter of both gaps.
    fn scatters(&self) -> [Option<ScatterSpec>; 2] {
        [self.gap_tension_m, self.gap_compression_m]
    }

    /// Refuses a scatter of none or two distributions, and a standard deviation below 0.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check(&self) -> Result<(), InvalidInput> {
        for (key, scatter) in WORN_GAPS.into_iter().zip(self.scatters()) {
            let Some(scatter) = scatter else { continue };
            let (found, problem) = match (scatter.normal, scatter.uniform) {
                (Some(normal), None) => {
                    not_negative(&format!("{key}.normal"), normal)?;
                    continue;
                }
                (None, Some(_)) => continue,
                (Some(_), Some(_)) => ("both", Problem::Misplaced),
                (None, None) => ("neither", Problem::Missing),
            };
            return Err(InvalidInput::new(key, found, "either normal or uniform").because(problem));
        }
        Ok(())
    }

    /// Refuses wear that would make a nominal gap (tension, compression) smaller than nothing `[m]`.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check_against(&self, nominal_m: [f64; 2]) -> Result<(), InvalidInput> {
        for ((key, scatter), gap) in WORN_GAPS.into_iter().zip(self.scatters()).zip(nominal_m) {
            if let Some(wear) = scatter.and_then(|scatter| scatter.uniform).filter(|wear| -wear > gap) {
                let allowed = format!("at least {}, which leaves nothing of the smallest gap of {gap}", -gap);
                let refused = InvalidInput::new(format!("{key}.uniform"), wear, allowed);
                return Err(refused.because(Problem::Conflict));
            }
        }
        Ok(())
    }

    /// The gaps (tension, compression) of a joint on the bridge of a seed `[m]`. The numbers of a seed never change: they rest
    /// on the blake3 hash of seed, gap and joint.
    pub fn worn_m(&self, seed: u64, joint: usize, nominal_m: [f64; 2]) -> [f64; 2] {
        let mut gaps = nominal_m;
        for ((key, scatter), gap) in WORN_GAPS.into_iter().zip(self.scatters()).zip(&mut gaps) {
            let Some(scatter) = scatter else { continue };
            let wear = match (scatter.normal, scatter.uniform) {
                (Some(deviation), _) => deviation * normal(uniform(seed, key, joint)),
                (None, most) => most.unwrap_or_default() * uniform(seed, key, joint)[0],
            };
            *gap = (*gap + wear).max(0.0);
        }
        gaps
    }
}

/// Two numbers between 0 and 1 of a gap, neither of them reached.
fn uniform(seed: u64, gap: &str, joint: usize) -> [f64; 2] {
    let hash = blake3::hash(format!("wear {seed} {gap} {joint}").as_bytes());
    let (words, _) = hash.as_bytes().as_chunks::<8>();
    [words[0], words[1]].map(|word| ((u64::from_le_bytes(word) >> 12) as f64 + 0.5) / (1_u64 << 52) as f64)
}

/// A number of the normal distribution from two that are evenly spread, after Box and Muller (1958).
fn normal([a, b]: [f64; 2]) -> f64 {
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn scatter(normal: Option<f64>, uniform: Option<f64>) -> Option<ScatterSpec> {
        Some(ScatterSpec { normal, uniform })
    }

    /// Written down once: no later version of this program may give others, but for the last bits of a logarithm.
    #[test]
    fn numbers_of_a_seed_never_change() {
        let wear = WearSpec {
            gap_tension_m: scatter(None, Some(1.0)),
            gap_compression_m: scatter(Some(1.0), None),
        };
        for (seed, joint, expected) in DRAWN {
            let found = wear.worn_m(seed, joint, [0.0, 10.0]);
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{seed} {joint}: {found:?}");
            }
        }
    }

    const DRAWN: [(u64, usize, [f64; 2]); 3] = [
        (1, 2, [0.3592614965167219, 10.190548825351609]),
        (1, 3, [0.38878932473616723, 9.767650220174444]),
        (2, 2, [0.6958023779593615, 9.39290589414605]),
    ];

    /// Mean and deviation of many draws: normal 0 and 1, uniform 1/2 and 1/sqrt(12), each within four standard errors of
    /// 20,000; a twin of 5 % too much scatter is outside. Two gaps of a joint and two joints are not alike.
    #[test]
    fn scatter_is_that_of_its_distribution() {
        let moments = |of: &dyn Fn(u64) -> f64| {
            let n = 20_000;
            let values: Vec<f64> = (0..n).map(of).collect();
            let mean = values.iter().sum::<f64>() / n as f64;
            let square = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n as f64;
            [mean, square.sqrt()]
        };
        let wear = |normal: f64, uniform: f64| WearSpec {
            gap_tension_m: scatter(Some(normal), None),
            gap_compression_m: scatter(None, Some(uniform)),
        };
        let drawn = |wear: WearSpec, which: usize| moments(&|seed| wear.worn_m(seed, 7, [50.0, 50.0])[which] - 50.0);
        let holds = |found: [f64; 2], expected: [f64; 2]| (0..2).all(|i| (found[i] - expected[i]).abs() < 0.028);
        assert!(holds(drawn(wear(1.0, 1.0), 0), [0.0, 1.0]));
        assert!(!holds(drawn(wear(1.05, 1.0), 0), [0.0, 1.0]));
        let [mean, deviation] = drawn(wear(1.0, 1.0), 1);
        assert!(
            (mean - 0.5).abs() < 0.0082 && (deviation - 12_f64.sqrt().recip()).abs() < 0.004,
            "{mean} {deviation}"
        );
        let both = moments(&|seed| {
            let [a, b] = wear(1.0, 1.0).worn_m(seed, 7, [50.0, 50.0]);
            (a - 50.0) * (b - 50.5)
        });
        let neighbours = moments(&|seed| {
            let of = |joint| wear(1.0, 1.0).worn_m(seed, joint, [50.0, 50.0])[0] - 50.0;
            of(7) * of(8)
        });
        assert!(
            both[0].abs() < 0.01 && neighbours[0].abs() < 0.03,
            "{both:?} {neighbours:?}"
        );
    }

    #[test]
    fn no_gap_is_below_nothing() {
        let wear = WearSpec {
            gap_tension_m: scatter(Some(1.0), None),
            gap_compression_m: scatter(None, Some(-0.01)),
        };
        let least = (0..1000)
            .map(|seed| wear.worn_m(seed, 2, [0.001, 0.01])[0])
            .fold(1.0, f64::min);
        assert_eq!(least, 0.0);
        assert_eq!(wear.check_against([0.0, 0.01]), Ok(()));
        let refused = wear.check_against([0.0, 0.0099]).unwrap_err();
        assert_eq!(refused.key, "gap_compression_m.uniform");
    }

    #[test]
    fn a_scatter_has_one_distribution() {
        for (normal, uniform, key) in [
            (Some(1.0), Some(1.0), "gap_tension_m"),
            (None, None, "gap_tension_m"),
            (Some(-1.0), None, "gap_tension_m.normal"),
        ] {
            let wear = WearSpec {
                gap_tension_m: scatter(normal, uniform),
                gap_compression_m: None,
            };
            assert_eq!(wear.check().unwrap_err().key, key);
        }
    }
}
