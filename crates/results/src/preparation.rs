//! What jobs share, as a run prepared it: what manifests and pages tell of modules, operators and bridges.
//!
//! Knows counts and what a bridge came to. Does not know how any of it is prepared.

use serde::{Deserialize, Serialize};

/// What jobs share, as it was prepared.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Preparation {
    /// Modules condensed.
    pub condensations: usize,
    /// Where operators came from.
    pub operators: OperatorCounts,
    /// What was prepared of each bridge.
    pub bridges: Vec<BridgeReport>,
}

impl Preparation {
    /// Takes what another run prepared.
    pub fn add(&mut self, other: Self) {
        self.condensations += other.condensations;
        self.operators.built += other.operators.built;
        self.operators.from_cache += other.operators.from_cache;
        self.operators.replaced += other.operators.replaced;
        for bridge in other.bridges {
            if !self.bridges.contains(&bridge) {
                self.bridges.push(bridge);
            }
        }
    }
}

/// Where the operators of a run came from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OperatorCounts {
    /// Built from the bridge's matrices.
    pub built: usize,
    /// Read from the cache.
    pub from_cache: usize,
    /// Of those built, the ones whose file in the cache was damaged or of another form.
    pub replaced: usize,
}

/// What was prepared of one bridge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BridgeReport {
    /// Hash of the bridge's document after the axes.
    pub blake3: String,
    /// Its name.
    pub name: String,
    /// Model of its modules.
    pub model: String,
    /// Number of modules.
    pub modules: usize,
    /// Degrees of freedom of one module's finite elements, the largest's where modules are not alike.
    pub module_full_dofs: Option<usize>,
    /// Degrees of freedom of one module as it is assembled, the largest's.
    pub module_dofs: Option<usize>,
    /// Structural mass of one module, the mean of modules that are not alike `[kg]`.
    pub structural_mass_kg: Option<f64>,
    /// Degrees of freedom of the bridge on its supports.
    pub dofs: Option<usize>,
    /// Frequencies at which the damping ratio holds `[Hz]`.
    pub damping_frequencies_hz: Option<[f64; 2]>,
    /// Stiffness-proportional damping `[s]`.
    pub damping_stiffness_s: Option<f64>,
    /// Mass-proportional damping `[1/s]`.
    pub damping_mass_1_s: Option<f64>,
    /// Operator of its crossings: modes kept.
    pub operator_modes: Option<usize>,
    /// Frequency of the highest `[Hz]`.
    pub operator_cutoff_hz: Option<f64>,
    /// Error allowed: the largest share by which the flexibility of a connector or deck node at 5 Hz may be off.
    pub operator_tolerance: Option<f64>,
    /// Error left: the largest share by which that flexibility is off.
    pub operator_error: Option<f64>,
    /// Modes of one side of it, on which crossings are solved that are their own mirror images; absent where it is not its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub one_side_modes: Option<usize>,
    /// Its water with memory; absent in other waters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub water: Option<WaterReport>,
}

/// What is told of water with memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WaterReport {
    /// Its name.
    pub name: String,
    /// Its file, as the bridge names it.
    pub file: String,
    /// Hash of its file.
    pub blake3: String,
    /// Depth `[m]`; null where it is deep.
    pub depth_m: Option<f64>,
    /// Added mass at infinite frequency, heave of the whole bridge, per length `[kg/m]`.
    pub infinite_heave_kg_m: Option<f64>,
    /// Memory at 0 s, heave of the whole bridge, per length `[N/m per m]`.
    pub memory_heave_n_m2: Option<f64>,
    /// Checks that refuse the water and were accepted, with their figures.
    pub accepted: Vec<(String, Option<f64>)>,
    /// Real states of the memory in the operator.
    pub states: Option<usize>,
    /// The rms error of the kernel by its states, a share of the kernel's rms.
    pub kernel_error: Option<f64>,
    /// The least eigenvalue of Re K over the largest, before it is lifted to 0.
    pub passivity: Option<f64>,
}
