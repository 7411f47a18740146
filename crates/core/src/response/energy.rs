//! The energy balance of a crossing.
//!
//! Knows the sums and how far they are from closing. Does not know the scheme that produced the increments.

/// Energies of one step `[J]`, by the scheme's own increments.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StepEnergies {
    /// Kinetic energy at its end, `1/2 v^T M v`.
    pub kinetic: f64,
    /// Strain energy of structure and water at its end, `1/2 u^T K u`.
    pub strain: f64,
    /// Strain energy of the connectors at its end.
    pub connectors: f64,
    /// What masses and springs of vehicles have taken up since the start.
    pub vehicles: f64,
    /// Dissipated by Rayleigh damping over it.
    pub rayleigh: f64,
    /// Taken by waves of water with memory over it; waves that come back give.
    pub radiated: f64,
    /// Dissipated by dashpots of connectors and dampers of vehicles over it.
    pub dashpots: f64,
    /// Dissipated by the scheme over it.
    pub numerical: f64,
    /// Work over it of the contact forces of rigid vehicles on the deck, and of gravity and drive on vehicles with springs.
    pub work: f64,
}

/// `kinetic + strain + connectors + vehicles + rayleigh + radiated + dashpots + numerical = work`, kept step by step: the dissipations,
/// what waves take and the work `integral of p du` are sums since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyBalance {
    rayleigh: f64,
    radiated: f64,
    dashpots: f64,
    numerical: f64,
    work: f64,
    least_radiated: f64,
    largest_work: f64,
    largest_gap: f64,
    largest_numerical: f64,
}

/// What a crossing reports of its balance.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergySummary {
    /// Largest `|kinetic + strain + connectors + vehicles + rayleigh + radiated + dashpots + numerical - work|` over the largest `|work|`.
    pub energy_residual: f64,
    /// Largest numerical dissipation over the largest `|work|`.
    pub numerical_dissipation: f64,
    /// What waves of water with memory have taken at the end `[J]`; 0 of other waters.
    pub radiated_j: f64,
    /// The least of what they had taken at any time `[J]`, 0 or below.
    pub least_radiated_j: f64,
}

impl EnergyBalance {
    /// Takes a step.
    /// Equation (R1).
    pub fn take(&mut self, step: &StepEnergies) {
        self.rayleigh += step.rayleigh;
        self.radiated += step.radiated;
        self.least_radiated = self.least_radiated.min(self.radiated);
        self.dashpots += step.dashpots;
        self.numerical += step.numerical;
        self.work += step.work;
        let stored = step.kinetic + step.strain + step.connectors + step.vehicles;
        let gap = stored + self.rayleigh + self.radiated + self.dashpots + self.numerical - self.work;
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
            radiated_j: self.radiated,
            least_radiated_j: self.least_radiated,
        }
    }
}
