//! A vehicle on springs at one instant, to be read.
//!
//! Knows its numbers. Does not know who asks.

/// How a body moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BodyMotion {
    /// Its centre up from rest on a level road `[m]`.
    Bounce,
    /// Its front up `[rad]`.
    Pitch,
    /// Its left side up `[rad]`.
    Roll,
}

/// A vehicle on springs at the end of a step, to be read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RideReading<'a> {
    /// Force of each wheel `[N]`, at the weight that its springs are given for.
    pub wheels_n: &'a [f64],
    /// What these are multiplied by.
    pub scale: f64,
    /// The motions of its body, each with its place in the state.
    pub body: &'a [(BodyMotion, usize)],
    /// State, rest on a level road and acceleration of each motion.
    pub state: &'a [f64],
    pub rest: &'a [f64],
    pub accelerations: &'a [f64],
    /// Where one side stands for the vehicle, of each of its wheels the one of the side and its share of the force.
    pub of_side: Option<&'a [(usize, f64)]>,
}

impl RideReading<'_> {
    /// Force of a wheel `[N]`.
    pub(crate) fn wheel_n(&self, wheel: usize) -> f64 {
        let (wheel, share) = self.of_side.map_or((wheel, 1.0), |wheels| wheels[wheel]);
        share * self.scale * self.wheels_n.get(wheel).copied().unwrap_or(0.0)
    }

    /// How far a body is from rest on a level road; 0 where it does not move so.
    pub(crate) fn moved(&self, motion: BodyMotion) -> f64 {
        let of_body = self.body.iter().find(|(of, _)| *of == motion);
        of_body.map_or(0.0, |&(_, place)| self.state[place] - self.rest[place])
    }
}
