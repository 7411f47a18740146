//! Peaks with place and time.
//!
//! Knows how a running extreme is kept. Does not know where the numbers come from.

/// A largest value and when it occurred. Starts from zero: a value that never rose above zero leaves `value = 0`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Peak {
    /// The largest value so far, at least 0.
    pub value: f64,
    /// When it occurred `[s]`.
    pub time_s: f64,
}

impl Peak {
    /// Takes `value` at `time_s` where it is larger than all before.
    #[inline]
    pub fn take(&mut self, value: f64, time_s: f64) {
        if value > self.value {
            *self = Self { value, time_s };
        }
    }
}

/// A largest value, when it occurred and where. Starts from zero, as [`Peak`] does. Verified by `tests/solvers/placed.rs`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PlacedPeak {
    /// The largest value so far, at least 0.
    pub value: f64,
    /// When it first occurred `[s]`.
    pub time_s: f64,
    /// Number of the place where it did, from 1; 0 while the value is 0.
    pub at: usize,
}

impl PlacedPeak {
    /// Takes `value` at `time_s` at the place `at` where it is larger than all before: of equals the first.
    #[inline]
    pub fn take(&mut self, value: f64, time_s: f64, at: usize) {
        if value > self.value {
            *self = Self { value, time_s, at };
        }
    }
}

/// An axle of a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxlePlace {
    /// The vehicle, from 1 in the order of the traffic.
    pub vehicle: usize,
    /// Its axle, from 1.
    pub axle: usize,
}

/// The smallest contact force of an axle, when it occurred and of which axle. Verified by `tests/solvers/placed.rs`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastContact {
    /// The smallest force so far, infinite while no axle's has settled `[N]`; below zero a rigid axle would have lifted off.
    pub force_n: f64,
    /// When it first occurred `[s]`.
    pub time_s: f64,
    /// The axle; none while no axle's force has settled.
    pub axle: Option<AxlePlace>,
}

impl Default for LeastContact {
    fn default() -> Self {
        Self {
            force_n: f64::INFINITY,
            time_s: 0.0,
            axle: None,
        }
    }
}

impl LeastContact {
    /// Takes the force of an axle at `time_s` where it is smaller than all before: of equals the first.
    #[inline]
    pub fn take(&mut self, force_n: f64, time_s: f64, axle: impl FnOnce() -> AxlePlace) {
        if force_n < self.force_n {
            *self = Self {
                force_n,
                time_s,
                axle: Some(axle()),
            };
        }
    }
}

/// Peaks of a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionPeaks {
    /// Position number, from 1.
    pub position: usize,
    /// Its place along the bridge `[m]`.
    pub x_m: f64,
    /// Downward `[m]`.
    pub deflection: Peak,
    /// Upward `[m]`.
    pub uplift: Peak,
}

/// Peaks of a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacePeaks {
    /// The place along the bridge `[m]`.
    pub x_m: f64,
    /// Downward `[m]`.
    pub deflection: Peak,
    /// Upward `[m]`.
    pub uplift: Peak,
}

/// Peaks of the force of a bank on the bridge, or of its spring at one place `[N]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BankPeaks {
    /// The bank, from 0 in the order of the bridge file.
    pub bank: usize,
    /// Place across `[m]`; none of the bank's sum.
    pub y_m: Option<f64>,
    /// Against its sense (as compression) and along it (as tension).
    pub force: ForcePeaks,
}

/// Peaks of a section force or of the angle of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPeaks {
    /// Number of the joint, 2 to modules.
    pub joint: usize,
    /// Which one.
    pub of: super::Section,
    /// Largest negative (as compression) and positive value (as tension) in its unit.
    pub peaks: ForcePeaks,
}

/// Peaks of a force, both as positive numbers `[N]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ForcePeaks {
    /// Largest compression.
    pub compression: Peak,
    /// Largest tension.
    pub tension: Peak,
}

impl ForcePeaks {
    /// Takes a force (tension positive) at `time_s`.
    #[inline]
    pub fn take(&mut self, force_n: f64, time_s: f64) {
        self.compression.take(-force_n, time_s);
        self.tension.take(force_n, time_s);
    }
}

/// Peaks of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPeaks {
    /// Position number of the joint, 2 to modules.
    pub joint: usize,
    /// Peaks of the sum over its connectors.
    pub sum: ForcePeaks,
    /// Each connector's place across `[m]` and its own peaks.
    pub connectors: Vec<(f64, ForcePeaks)>,
}

/// Forces of a joint in a static case, tension positive `[N]`.
#[derive(Debug, Clone, PartialEq)]
pub struct JointForces {
    /// Position number of the joint, 2 to modules.
    pub joint: usize,
    /// Sum over its connectors.
    pub sum_n: f64,
    /// Each connector's place across `[m]` and its force.
    pub connectors: Vec<(f64, f64)>,
}

/// Extremes of the force of a pin on the module left of it `[N]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PinExtremes {
    /// Along, across and up: largest against the axis (as compression) and with it (as tension).
    pub components: [ForcePeaks; 3],
    /// Largest resultant.
    pub resultant: Peak,
}

impl PinExtremes {
    /// Takes a force at `time_s`.
    #[inline]
    pub fn take(&mut self, force_n: [f64; 3], time_s: f64) {
        for (peaks, force) in self.components.iter_mut().zip(force_n) {
            peaks.take(force, time_s);
        }
        self.resultant.take(resultant_n(force_n), time_s);
    }
}

/// Extremes of a pin, or of all pins of a joint together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinPeaks {
    /// Number of the joint, 2 to modules.
    pub joint: usize,
    /// Place across `[m]`; none of the joint's sum.
    pub y_m: Option<f64>,
    /// Its extremes.
    pub extremes: PinExtremes,
}

/// The length of a force `[N]`.
pub fn resultant_n([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{AxlePlace, LeastContact, PlacedPeak};

    /// Nothing below zero counts, and of equals the first.
    #[test]
    fn first_of_equals_is_kept() {
        let mut peak = PlacedPeak::default();
        peak.take(-1.0, 0.1, 7);
        assert_eq!(peak, PlacedPeak::default());
        for (value, time_s, at) in [
            (1.0, 0.2, 3),
            (2.0, 0.3, 4),
            (2.0, 0.3, 5),
            (2.0, 0.4, 1),
            (1.5, 0.5, 2),
        ] {
            peak.take(value, time_s, at);
        }
        let expected = PlacedPeak {
            value: 2.0,
            time_s: 0.3,
            at: 4,
        };
        assert_eq!(peak, expected);
    }

    /// Below zero counts as well, and of equals the first.
    #[test]
    fn least_force_is_kept() {
        let mut least = LeastContact::default();
        let place = |axle: usize| AxlePlace { vehicle: 1, axle };
        for (force_n, time_s, axle) in [
            (5.0, 0.1, 1),
            (-1.0, 0.2, 2),
            (-1.0, 0.2, 3),
            (-1.0, 0.3, 1),
            (0.0, 0.4, 2),
        ] {
            least.take(force_n, time_s, || place(axle));
        }
        assert_eq!((least.force_n, least.time_s, least.axle), (-1.0, 0.2, Some(place(2))));
    }
}
