//! The energy balance of a crossing.
//!
//! Knows the sums and how far they are from closing. Does not know the scheme that produced the increments.

/// Running energies [J], each by the scheme's own increments.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyBalance {
    /// Kinetic energy now, `1/2 v^T M v`.
    pub kinetic: f64,
    /// Strain energy of structure and water now, `1/2 u^T K u`.
    pub strain: f64,
    /// Strain energy of the connectors now.
    pub connectors: f64,
    /// Dissipated by Rayleigh damping so far.
    pub rayleigh: f64,
    /// Dissipated by the scheme so far.
    pub numerical: f64,
    /// Work of the contact forces on the deck so far, `integral of p du`.
    pub work: f64,
    /// Largest `|work|` so far.
    largest_work: f64,
    /// Largest `|left - right|` so far.
    largest_gap: f64,
    /// Largest `|numerical|` so far.
    largest_numerical: f64,
}

/// What a crossing reports of its balance.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergySummary {
    /// Largest `|kinetic + strain + connectors + rayleigh + numerical - work|` over the largest `|work|`.
    pub energy_residual: f64,
    /// Largest numerical dissipation over the largest `|work|`.
    pub numerical_dissipation: f64,
}

impl EnergyBalance {
    /// Takes note of the balance after a step.
    pub fn close(&mut self) {
        let gap = self.kinetic + self.strain + self.connectors + self.rayleigh + self.numerical - self.work;
        self.largest_gap = self.largest_gap.max(gap.abs());
        self.largest_work = self.largest_work.max(self.work.abs());
        self.largest_numerical = self.largest_numerical.max(self.numerical.abs());
    }

    /// The summary so far; zeros where no work was done.
    pub fn summary(&self) -> EnergySummary {
        if self.largest_work == 0.0 {
            return EnergySummary::default();
        }
        EnergySummary {
            energy_residual: self.largest_gap / self.largest_work,
            numerical_dissipation: self.largest_numerical / self.largest_work,
        }
    }
}
