//! Elementary effects: how far an output moves with a step of each factor, from the trajectories of Morris's design.
//!
//! Knows outputs trajectory by trajectory. Does not know tables or what a factor is.

use super::resampling::Resampling;
use pontoon_plan::design::TrajectoryStep;
use serde::Serialize;

/// What the effects of a factor come to, in the unit of the output: each is the change of the output over a step, made as
/// large as it would be over the whole range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MorrisIndex {
    /// Mean of the effects.
    pub mu: f64,
    /// Mean of their sizes.
    pub mu_star: f64,
    /// Half the width of the interval of `mu_star`.
    pub mu_star_conf: f64,
    /// Standard deviation of the effects: nought where the factor acts in a straight line and alone; nothing of one trajectory.
    pub sigma: Option<f64>,
}

/// The effects of Morris's trajectories.
#[derive(Debug, Clone)]
pub struct MorrisOutputs {
    factors: usize,
    /// A step as a share of the range.
    delta: f64,
    /// The effect of each factor, trajectory by trajectory.
    effects: Vec<f64>,
}

impl MorrisOutputs {
    /// The effects of no trajectory, of so many factors on so many levels.
    pub fn new(factors: usize, levels: usize) -> Self {
        Self {
            factors,
            delta: levels as f64 / (2 * (levels - 1)) as f64,
            effects: Vec::new(),
        }
    }

    /// Takes a trajectory whose outputs are all there; another is left out, and told by `false`.
    pub fn take(&mut self, steps: &[TrajectoryStep], outputs: &[Option<f64>]) -> bool {
        let whole: Option<Vec<f64>> = outputs.iter().copied().collect();
        let Some(outputs) = whole.filter(|outputs| outputs.len() == steps.len() + 1) else {
            return false;
        };
        let mut effects = vec![0.0; self.factors];
        for (step, pair) in steps.iter().zip(outputs.windows(2)) {
            let change = if step.up { pair[1] - pair[0] } else { pair[0] - pair[1] };
            effects[step.factor] = change / self.delta;
        }
        self.effects.extend(effects);
        true
    }

    /// Of each factor in its order, over the effects `e` of trajectories; nothing where there is none.
    ///
    /// `mu = mean(e)`, `sigma` their standard deviation with `n - 1` (Morris, Factorial sampling plans for preliminary
    /// computational experiments, Technometrics 33, 1991), `mu_star = mean(|e|)` (Campolongo, Cariboni, Saltelli, An effective
    /// screening design for sensitivity analysis of large models, Environ. Model. Softw. 22, 2007): (I4). As SALib's `analyze.morris`
    /// has them, which `scripts/indices` holds them against. Verified by `a_product_has_its_effects`.
    pub fn indices(&self, resampling: Resampling) -> Option<Vec<MorrisIndex>> {
        let walks: Vec<&[f64]> = self.effects.chunks(self.factors).collect();
        if walks.is_empty() {
            return None;
        }
        let count = walks.len() as f64;
        let mean = |of: &dyn Fn(&[f64]) -> f64| walks.iter().map(|walk| of(walk)).sum::<f64>() / count;
        let stars = |drawn: &[usize]| -> Vec<f64> {
            let star = |i: usize| drawn.iter().map(|&walk| walks[walk][i].abs()).sum::<f64>() / drawn.len() as f64;
            (0..self.factors).map(star).collect()
        };
        let conf = resampling.half_widths(walks.len(), stars);
        let of_factor = |i: usize| {
            let mu = mean(&|walk| walk[i]);
            let variance = mean(&|walk| (walk[i] - mu).powi(2)) * count / (count - 1.0);
            MorrisIndex {
                mu,
                mu_star: mean(&|walk| walk[i].abs()),
                mu_star_conf: conf[i],
                sigma: (walks.len() > 1).then(|| variance.sqrt()),
            }
        };
        Some((0..self.factors).map(of_factor).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn_block::drawn_block;
    use serde_json::json;

    const FEW: Resampling = Resampling {
        resamples: 100,
        seed: 1,
    };

    /// The effects of a function of three factors, each from 0 to 1 but for the last from 0 to 10.
    fn effects(trajectories: usize, levels: usize, f: impl Fn(&[f64]) -> f64) -> Vec<MorrisIndex> {
        let ranges = json!({ "bridge.x": [0, 1], "bridge.y": [0, 1], "bridge.z": [0, 10] });
        let design =
            json!({ "morris": { "trajectories": trajectories, "levels": levels, "seed": 1, "ranges": ranges } });
        let (block, points) = drawn_block(&design);
        let mut found = MorrisOutputs::new(3, levels);
        for (walk, steps) in points.chunks(4).zip(block.trajectories()) {
            assert!(found.take(&steps, &walk.iter().map(|x| Some(f(x))).collect::<Vec<_>>()));
        }
        found.indices(FEW).unwrap()
    }

    /// A straight line has the effects of its slopes, over the whole range of each factor, and no scatter. Rounding: 1e-12.
    #[test]
    fn a_straight_line_has_its_slopes() {
        for levels in [2, 4, 6] {
            let found = effects(10, levels, |x| 2.0 * x[0] - 3.0 * x[1] + 0.5 * x[2]);
            for (index, slope) in found.iter().zip([2.0_f64, -3.0, 5.0]) {
                assert!(
                    (index.mu - slope).abs() < 1e-12 && (index.mu_star - slope.abs()).abs() < 1e-12,
                    "{index:?}"
                );
                assert!(index.sigma.unwrap() < 1e-12 && index.mu_star_conf < 1e-12, "{index:?}");
                assert!((index.mu - 1.05 * slope).abs() > 1e-12);
            }
        }
    }

    /// Of `x y` and a square. The effects of `x` on `x y` are `y` on four even levels: mean 1/2, variance 5/36. Those of a square are 2/3
    /// and 4/3, each as likely: mean 1, variance 1/9. Of 4000 trajectories means are known to three standard errors, 0.018,
    /// and standard deviations to less. Twin: 5 % more.
    #[test]
    fn a_product_has_its_effects() {
        let found = effects(4000, 4, |x| x[0] * x[1] - (x[2] / 10.0).powi(2));
        let scatter = (5.0_f64 / 36.0).sqrt();
        for (index, (mu, sigma)) in found.iter().zip([(0.5, scatter), (0.5, scatter), (-1.0, 1.0 / 3.0)]) {
            let off = |share: f64| {
                (index.mu - share * mu)
                    .abs()
                    .max((index.sigma.unwrap() - share * sigma).abs())
            };
            assert!(off(1.0) < 0.018 && off(1.05) > 0.018, "{index:?}");
            assert!((index.mu_star - index.mu.abs()).abs() < 1e-12, "{index:?}");
            // the interval of a mean
            let width = 1.96 * sigma / 4000.0_f64.sqrt();
            assert!((index.mu_star_conf / width - 1.0).abs() < 0.25, "{index:?} {width}");
        }
    }

    #[test]
    fn trajectories_that_are_not_whole_are_left_out() {
        let steps = [TrajectoryStep { factor: 0, up: false }];
        let mut found = MorrisOutputs::new(1, 4);
        assert!(!found.take(&steps, &[Some(1.0), None]) && !found.take(&steps, &[Some(1.0)]));
        assert!(found.indices(FEW).is_none());
        assert!(found.take(&steps, &[Some(1.0), Some(3.0)]));
        let index = found.indices(FEW).unwrap()[0];
        assert!(
            (index.mu + 3.0).abs() < 1e-15 && (index.mu_star - 3.0).abs() < 1e-15,
            "{index:?}"
        );
        assert_eq!((index.sigma, index.mu_star_conf), (None, 0.0));
    }
}
