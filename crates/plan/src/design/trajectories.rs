//! Trajectories of Morris: walks over a grid of levels, each step of which changes one coordinate.
//!
//! Knows levels, steps and seeds. Does not know axes or values. The numbers of a seed never change.

use super::sampling::{below, key};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;

/// One step of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrajectoryStep {
    /// The place of the factor that changes, among those of its block.
    pub factor: usize,
    /// Whether it goes up; down otherwise.
    pub up: bool,
}

/// A walk of as many steps as there are coordinates, each of which changes once.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Trajectory {
    /// The level of each coordinate at the first point.
    pub(super) start: Vec<usize>,
    /// The steps in order.
    pub(super) steps: Vec<TrajectoryStep>,
}

/// The trajectories of a seed, one after the other (Morris, Factorial sampling plans for preliminary computational
/// experiments, Technometrics 33, 1991): a coordinate goes from one of the lower half of `levels` levels to the one
/// `levels / 2` above it, or back, so that each level is as likely. Verified by `each_level_is_as_likely`.
///
/// More trajectories of a seed begin with those of fewer. A coordinate's levels follow from its name alone.
pub(super) struct Trajectories {
    levels: usize,
    /// One a coordinate.
    random: Vec<Pcg64>,
    /// Draws the order of steps.
    order: Pcg64,
    /// The coordinates in the order of the alphabet.
    sorted: Vec<usize>,
}

impl Trajectories {
    /// Of coordinates of these names, on an even number of levels.
    pub(super) fn new(names: &[&str], levels: usize, seed: u64) -> Self {
        let mut sorted: Vec<usize> = (0..names.len()).collect();
        sorted.sort_by_key(|&coordinate| names[coordinate]);
        let random = names.iter().map(|name| Pcg64::from_seed(key("morris", seed, name)));
        Self {
            levels,
            random: random.collect(),
            order: Pcg64::from_seed(key("order of morris", seed, "")),
            sorted,
        }
    }
}

impl Iterator for Trajectories {
    type Item = Trajectory;

    fn next(&mut self) -> Option<Trajectory> {
        let half = self.levels / 2;
        let drawn = self.random.iter_mut();
        let drawn: Vec<(usize, bool)> = drawn
            .map(|random| (below(random, half), below(random, 2) == 1))
            .collect();
        let mut order = self.sorted.clone();
        for last in (1..order.len()).rev() {
            order.swap(last, below(&mut self.order, last + 1));
        }
        let step = |factor: usize| TrajectoryStep {
            factor,
            up: drawn[factor].1,
        };
        Some(Trajectory {
            start: drawn
                .iter()
                .map(|&(low, up)| if up { low } else { low + half })
                .collect(),
            steps: order.into_iter().map(step).collect(),
        })
    }
}

/// The points of trajectories, one after the other.
pub(super) struct MorrisWalk {
    walks: Trajectories,
    walk: Trajectory,
    /// The level of each coordinate at the point under way.
    at: Vec<usize>,
}

impl MorrisWalk {
    /// Before the first trajectory of a seed.
    pub(super) fn new(names: &[&str], levels: usize, seed: u64) -> Self {
        Self {
            walks: Trajectories::new(names, levels, seed),
            walk: Trajectory::default(),
            at: Vec::new(),
        }
    }

    /// Goes to a point; to be asked point by point.
    pub(super) fn go_to(&mut self, number: usize) -> Option<()> {
        let point = number % (self.walks.random.len() + 1);
        if point == 0 {
            self.walk = self.walks.next()?;
            self.at.clone_from(&self.walk.start);
            return Some(());
        }
        let step = self.walk.steps.get(point - 1)?;
        let (level, half) = (&mut self.at[step.factor], self.walks.levels / 2);
        *level = if step.up { *level + half } else { *level - half };
        Some(())
    }

    /// The coordinate at the point under way: the same number for the same level.
    pub(super) fn share(&self, coordinate: usize) -> f64 {
        self.at[coordinate] as f64 / (self.walks.levels - 1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trajectories_of_a_seed_never_change() {
        let step = |step: &TrajectoryStep| format!(" {}{}", if step.up { '+' } else { '-' }, step.factor);
        let told = Trajectories::new(&["b", "a", "c"], 4, 1).take(2);
        let told = told.map(|walk| format!("{:?}{}", walk.start, walk.steps.iter().map(step).collect::<String>()));
        assert_eq!(told.collect::<Vec<_>>(), WRITTEN_DOWN);
    }

    /// Written down once: no later version of this program may give others.
    const WRITTEN_DOWN: [&str; 2] = ["[2, 3, 1] -0 -1 +2", "[0, 1, 2] -2 +0 +1"];

    #[test]
    fn each_level_is_as_likely() {
        for levels in [2, 4, 6] {
            let mut counts = vec![0_usize; levels];
            for walk in Trajectories::new(&["x", "y"], levels, 3).take(3000) {
                let mut now = walk.start.clone();
                counts[now[0]] += 1;
                for step in &walk.steps {
                    let half = levels / 2;
                    now[step.factor] = if step.up {
                        now[step.factor] + half
                    } else {
                        now[step.factor] - half
                    };
                }
                assert!(now.iter().all(|&level| level < levels), "{walk:?}");
                counts[now[0]] += 1;
            }
            let even = 6000 / levels;
            assert!(counts.iter().all(|n| n.abs_diff(even) < even / 8), "{counts:?}");
        }
    }

    #[test]
    fn each_coordinate_changes_once_in_any_order() {
        let mut first = [0; 3];
        for walk in Trajectories::new(&["x", "y", "z"], 4, 5).take(3000) {
            let mut changed: Vec<usize> = walk.steps.iter().map(|step| step.factor).collect();
            first[changed[0]] += 1;
            changed.sort_unstable();
            assert_eq!(changed, [0, 1, 2]);
        }
        assert!(first.iter().all(|n| (900..1100).contains(n)), "{first:?}");
    }

    #[test]
    fn a_coordinate_follows_from_its_name() {
        let of = |names: &[&str], at: usize| -> Vec<usize> {
            Trajectories::new(names, 8, 2)
                .take(50)
                .map(|walk| walk.start[at])
                .collect()
        };
        assert_eq!(of(&["x", "y"], 1), of(&["y", "z"], 0));
        assert_ne!(of(&["x", "y"], 0), of(&["x", "y"], 1));
    }
}
