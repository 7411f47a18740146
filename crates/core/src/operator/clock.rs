//! Where the time of a step goes: its parts, and who looks at a clock between them.
//!
//! Knows names of parts. Does not know a clock: nothing of the mechanics does.

/// A part of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StepPart {
    /// Weights at their places, as modes, connectors and observed rows see them.
    Loads,
    /// Modes: prediction and correction, products with connectors included.
    Modes,
    /// Water with memory: its states and its forces on the modes.
    Waves,
    /// What the modes leave out: prediction and correction.
    Residual,
    /// Reading a lane's numbers from between the others', and writing them back.
    GatherAndScatter,
    /// Masses that ride along: their rows, their part of the small system, their forces.
    RidingMasses,
    /// The small system of each lane.
    Contact,
    /// The balance of energy.
    Accounting,
    /// Observed rows and their extremes.
    ObservedRows,
}

impl StepPart {
    /// All parts.
    pub const ALL: [Self; 9] = [
        Self::Loads,
        Self::Modes,
        Self::Waves,
        Self::Residual,
        Self::GatherAndScatter,
        Self::RidingMasses,
        Self::Contact,
        Self::Accounting,
        Self::ObservedRows,
    ];
}

/// Looks at a clock between the parts of a step.
pub trait StepClock {
    /// A step begins.
    fn begin(&mut self);

    /// What was done since the last call is of a part, which took so many floating-point operations in one lane, or in each of
    /// them; a fused multiply-add is two. Comparisons, copies and looking things up are none.
    fn lap(&mut self, part: StepPart, flop: impl FnOnce() -> f64);
}

/// Nobody looks.
impl StepClock for () {
    #[inline(always)]
    fn begin(&mut self) {}

    #[inline(always)]
    fn lap(&mut self, _: StepPart, _: impl FnOnce() -> f64) {}
}
