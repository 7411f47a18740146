//! All rows of one job.
//!
//! Knows which numbers a job leaves and that a number is either there or null. Does not know tables. A record can be
//! written and read back without loss, so that a journal can stand between the jobs and the tables.

use super::extreme::Extreme;
use super::failure::Failure;
use super::limit_rows::{LimitRow, governing, limit_rows_of_none};
use super::quantities::SECTION_QUANTITIES;
use super::rest_rows::{DeadRow, FreeboardRow, freeboard_rows_of_none};
use super::vehicle_rows::{BodyRow, WheelRow, vehicle_rows_of_none};
use pontoon_plan::job::Job;
use serde::{Deserialize, Serialize};

/// All rows of one job.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct JobRecord {
    /// The job's number: no part of what is kept of it, as a study that grows numbers its jobs anew.
    #[serde(skip)]
    pub job: usize,
    /// Why it failed; null where it did not.
    pub failure: Option<Failure>,
    /// Why it failed at its own time step, of a job that came to its end at half of it.
    pub retried: Option<Failure>,
    /// Its row of the table of jobs; all null where it failed.
    pub summary: Summary,
    /// Its rows of the table of positions.
    pub positions: Vec<PositionRow>,
    /// Its rows of the table of connectors: of each joint the sum, then each connector.
    pub connectors: Vec<ConnectorRow>,
    /// Its histories.
    pub histories: HistoryRows,
    /// Its rows of the table of modes.
    pub modes: Vec<ModeRow>,
    /// Its rows of the table of pins.
    pub pins: Vec<PinRow>,
    /// Its rows of the table of section forces.
    pub sections: Vec<SectionRow>,
    /// Its rows of the table of places.
    pub places: Vec<PlaceRow>,
    /// Its rows of the table of what is at peaks.
    pub at_peaks: Vec<AtPeakRow>,
    /// Its rows of the table of banks.
    pub banks: Vec<BankRow>,
    /// Its rows of the table of what is at rest.
    pub dead: Vec<DeadRow>,
    /// Its rows of the table of freeboards.
    pub freeboards: Vec<FreeboardRow>,
    /// Its rows of the table of wheels.
    pub wheels: Vec<WheelRow>,
    /// Its rows of the table of bodies.
    pub bodies: Vec<BodyRow>,
    /// Its rows of the table of limits.
    pub limits: Vec<LimitRow>,
}

/// A job's row of the table of jobs, names as there.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Largest value of the axis searched that is below the first that fails, or the smallest above it.
    pub rated_value: Option<f64>,
    /// The first value that fails.
    pub first_failure: Option<f64>,
    /// The farthest value of the ladder that passes.
    pub largest_pass: Option<f64>,
    /// Whether nothing beyond the first failure passes.
    pub monotone: Option<bool>,
    /// Crossings that the rating took.
    pub crossings: Option<usize>,
    /// How far a ten-thousandth of the load moves the utilisation of the reported pair, as a share of it.
    pub spread: Option<f64>,
    /// Whether that is beyond two hundredths.
    pub chaotic: Option<bool>,
    /// Largest utilisation of any limit; of a rating that of the rated value.
    pub utilisation: Option<f64>,
    /// The limit of which most is used up; of a rating at the first failure.
    pub governing_limit: Option<String>,
    /// Position, joint, module or axle of its demand.
    pub governing_place: Option<usize>,
    /// When `[s]`.
    pub governing_time_s: Option<f64>,
    /// Largest trim of a module `[rad]`.
    pub peak_trim_rad: Option<f64>,
    /// Largest deflection of any position `[m]`.
    pub peak_deflection_m: Option<f64>,
    /// Its position.
    pub peak_deflection_position: Option<usize>,
    /// Its time `[s]`.
    pub peak_deflection_time_s: Option<f64>,
    /// Largest uplift of any position `[m]`.
    pub peak_uplift_m: Option<f64>,
    /// Its position.
    pub peak_uplift_position: Option<usize>,
    /// Its time `[s]`.
    pub peak_uplift_time_s: Option<f64>,
    /// Largest compression of any joint, its connectors added `[N]`.
    pub peak_compression_n: Option<f64>,
    /// Its joint.
    pub peak_compression_joint: Option<usize>,
    /// Largest tension of any joint, its connectors added `[N]`.
    pub peak_tension_n: Option<f64>,
    /// Its joint.
    pub peak_tension_joint: Option<usize>,
    /// Largest resultant of any pin `[N]`; null where pins are not recorded.
    pub peak_pin_n: Option<f64>,
    /// Its joint.
    pub peak_pin_joint: Option<usize>,
    /// Largest angle of any joint, either sense `[rad]`; null where sections are not recorded.
    pub peak_angle_rad: Option<f64>,
    /// Its joint.
    pub peak_angle_joint: Option<usize>,
    /// Largest bending moment of any joint, either sense `[N m]`; null where sections are not recorded.
    pub peak_bending_nm: Option<f64>,
    /// Its joint.
    pub peak_bending_joint: Option<usize>,
    /// Largest deflection of the deck's edges `[m]`.
    pub peak_edge_deflection_m: Option<f64>,
    /// Largest roll of a module end `[rad]`.
    pub peak_roll_rad: Option<f64>,
    /// Largest deflection of the same load creeping over the bridge `[m]`; null where supports and hinges leave the bridge
    /// free to move horizontally, so that it has no static case.
    pub static_peak_deflection_m: Option<f64>,
    /// `peak_deflection_m` over `static_peak_deflection_m`.
    pub dynamic_amplification: Option<f64>,
    /// Structural mass of a module, of a job that asks for modes `[kg]`.
    pub structural_mass_kg: Option<f64>,
    /// Length over which a static load presses the bridge down `[m]`.
    pub influential_length_m: Option<f64>,
    /// Smallest freeboard of any corner of a module's deck `[m]`; null where freeboards are not recorded.
    pub least_freeboard_m: Option<f64>,
    /// Its module.
    pub least_freeboard_module: Option<usize>,
    /// Whether a module's bottom rose above the water.
    pub bottom_emerged: Option<bool>,
    /// Whether a module's deck went below the water.
    pub deck_submerged: Option<bool>,
    /// For how long any wheel on springs had left the deck `[s]`; null where there is none.
    pub contact_lost_s: Option<f64>,
    /// Smallest contact force of an axle, once its points have settled on their modules `[N]`; null where none ever has.
    pub min_contact_force_n: Option<f64>,
    /// Whether the time step is too long for the patches of a vehicle with inertia; null where the program found the step.
    pub step_warning: Option<bool>,
    /// Time step that the program has found for the job, where it was to find one `[s]`.
    pub time_step_s: Option<f64>,
    /// Time steps.
    pub steps: Option<usize>,
    /// Newton solutions.
    pub newton_iterations: Option<usize>,
    /// Trusses that opened or closed.
    pub contact_switches: Option<usize>,
    /// Largest gap of the energy balance over the load's work.
    pub energy_residual: Option<f64>,
    /// Largest numerical dissipation over the load's work.
    pub numerical_dissipation: Option<f64>,
    /// What waves of water with memory have taken at the end `[J]`; null in other waters.
    pub radiated_energy_j: Option<f64>,
    /// The least of what they had taken at any time `[J]`.
    pub least_radiated_energy_j: Option<f64>,
    /// How far the operator's largest deflection is off, as a share of the reference solver's; of jobs solved again.
    pub verify_deflection: Option<f64>,
    /// How far the largest compression is off, as a share of the job's largest joint force.
    pub verify_compression: Option<f64>,
    /// How far the largest tension is off, as a share of that force.
    pub verify_tension: Option<f64>,
    /// How far the smallest contact force of an axle is off, as a share of the vehicle's weight.
    pub verify_contact: Option<f64>,
    /// Whether all are within their tolerances.
    pub verify_held: Option<bool>,
}

/// A row of the table of positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PositionRow {
    /// Position number.
    pub position: usize,
    /// Its place `[m]`.
    pub x_m: f64,
    /// Largest deflection `[m]`.
    pub deflection: Extreme,
    /// Largest uplift `[m]`.
    pub uplift: Extreme,
    /// Deflection of a static job, positive downward `[m]`.
    pub static_deflection_m: Option<f64>,
    /// Largest static deflection under the load of a crossing, creeping over the bridge `[m]`.
    pub static_peak_deflection_m: Option<f64>,
}

/// A row of the table of connectors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConnectorRow {
    /// Position number of the joint.
    pub joint: usize,
    /// Place across `[m]`; null for the joint's sum.
    pub y_m: Option<f64>,
    /// Largest compression `[N]`.
    pub compression: Extreme,
    /// Largest tension `[N]`.
    pub tension: Extreme,
}

impl ConnectorRow {
    /// The row of a static force, tension positive.
    pub fn force(joint: usize, y_m: Option<f64>, force_n: f64) -> Self {
        let (compression, tension) = (
            Extreme::timeless((0.0 - force_n).max(0.0)),
            Extreme::timeless(force_n.max(0.0)),
        );
        Self {
            joint,
            y_m,
            compression,
            tension,
        }
    }
}

/// A row of the table of pins.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PinRow {
    /// Position number of the joint.
    pub joint: usize,
    /// Place across `[m]`; null for the joint's sum.
    pub y_m: Option<f64>,
    /// Largest force against each axis and along it, x, y and z, on the module left of the joint `[N]`.
    pub components: [[Extreme; 2]; 3],
    /// Largest resultant `[N]`.
    pub resultant: Extreme,
}

/// A row of the table of section forces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SectionRow {
    /// Position number of the joint.
    pub joint: usize,
    /// Which section force, or the angle, by its word.
    pub quantity: String,
    /// Largest against its sense, and with it.
    pub sides: [Extreme; 2],
}

/// A row of the table of places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceRow {
    /// The place `[m]`.
    pub x_m: f64,
    /// Largest deflection `[m]`.
    pub deflection: Extreme,
    /// Largest uplift `[m]`.
    pub uplift: Extreme,
    /// Deflection of a static job, positive downward `[m]`.
    pub static_deflection_m: Option<f64>,
}

/// A row of the table of banks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BankRow {
    /// The bank, from 0 in the order of the bridge file.
    pub bank: usize,
    /// Place across `[m]`; null for the bank's sum.
    pub y_m: Option<f64>,
    /// Largest force on the bridge along the bank's sense, and against it `[N]`.
    pub toward: Extreme,
    /// Against it: of springs that hold both ways.
    pub away: Extreme,
}

/// The rows of the banks of a job that failed.
fn bank_rows_of_none(job: &Job) -> Vec<BankRow> {
    let design = &job.shared.bridge.design;
    let row = |bank: usize, y_m: Option<f64>| BankRow {
        bank,
        y_m,
        toward: Extreme::default(),
        away: Extreme::default(),
    };
    let of_bank = |(bank, spec)| {
        let places = design.bank_places_y_m(spec).into_iter().map(Some);
        std::iter::once(None).chain(places).map(move |y_m| row(bank, y_m))
    };
    design.banks.iter().enumerate().flat_map(of_bank).collect()
}

/// Where and what a recorded number is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NumberPlace {
    /// Its word, which has its unit.
    pub quantity: String,
    /// Position or joint; null of a place.
    pub position: Option<usize>,
    /// Vehicle, from 1, of what is of a vehicle.
    pub vehicle: Option<usize>,
    /// Axle, from 1, of a wheel.
    pub axle: Option<usize>,
    /// Place along `[m]`, where it is of a place.
    pub x_m: Option<f64>,
    /// Place across of a connector or pin `[m]`.
    pub y_m: Option<f64>,
}

/// A row of the table of what is at peaks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AtPeakRow {
    /// Column of the peak.
    pub at_peak_of: String,
    /// Position or joint that was asked for; null where the largest of all was.
    pub peak_at: Option<usize>,
    /// When the value holds `[s]`.
    pub time_s: f64,
    /// What it is.
    pub of: NumberPlace,
    /// The value, in the unit of its quantity.
    pub value: f64,
}

/// One mode; the shares are those of its kinetic energy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeRow {
    /// Its number, from 1.
    pub number: usize,
    /// Natural frequency `[Hz]`.
    pub frequency_hz: f64,
    /// Name of its shape.
    pub shape: String,
    /// Damping by radiated waves, a share of critical damping.
    pub radiation_ratio: Option<f64>,
    /// Vertical share.
    pub vertical_share: f64,
    /// Share of torsion.
    pub torsion_share: f64,
    /// Horizontal share.
    pub horizontal_share: f64,
    /// Share along the bridge.
    pub axial_share: f64,
}

/// A job's histories.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct HistoryRows {
    /// The times `[s]`.
    pub time_s: Vec<f64>,
    /// Instants of the balance of the same steps `[s]`; empty where no series is of them.
    pub balance_time_s: Vec<f64>,
    /// The histories.
    pub series: Vec<HistorySeries>,
}

/// A history.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HistorySeries {
    /// What it is of.
    pub of: NumberPlace,
    /// Whether its times are instants of the balance.
    pub of_balance: bool,
    /// A value for each time.
    pub values: Vec<f64>,
}

impl HistoryRows {
    /// Bytes of its numbers.
    pub fn bytes(&self) -> usize {
        let values: usize = self.series.iter().map(|series| series.values.len()).sum();
        8 * (values + self.time_s.len() + self.balance_time_s.len())
    }
}

/// The rows of the pins of a job that failed; none where pins are not recorded.
fn pin_rows_of_none(job: &Job) -> Vec<PinRow> {
    let design = &job.shared.bridge.design;
    let joints = (2..=design.modules).filter(|_| job.shared.record.pins);
    let row = |joint: usize, y_m: Option<f64>| PinRow {
        joint,
        y_m,
        components: [[Extreme::default(); 2]; 3],
        resultant: Extreme::default(),
    };
    joints
        .flat_map(|joint| {
            let places = design.hinges_of(joint).y_m.iter().copied().map(Some).chain([None]);
            places.map(move |y_m| row(joint, y_m))
        })
        .collect()
}

/// The rows of the section forces of a job that failed; none where they are not recorded.
fn section_rows_of_none(job: &Job) -> Vec<SectionRow> {
    let joints = (2..=job.shared.bridge.design.modules).filter(|_| job.shared.record.sections);
    let row = |joint: usize, quantity: &str| SectionRow {
        joint,
        quantity: quantity.to_owned(),
        sides: [Extreme::default(); 2],
    };
    joints
        .flat_map(|joint| SECTION_QUANTITIES.map(|quantity| row(joint, quantity)))
        .collect()
}

impl JobRecord {
    /// The record of a job that failed: the rows of a job that did not, their numbers null.
    pub fn failed(job: &Job, failure: Failure) -> Self {
        let design = &job.shared.bridge.design;
        let none = Extreme::default();
        let positions = (1..=design.positions()).map(|position| PositionRow {
            position,
            x_m: design.position_x_m(position),
            deflection: none,
            uplift: none,
            static_deflection_m: None,
            static_peak_deflection_m: None,
        });
        let across = || std::iter::once(None).chain(design.connectors.y_m.iter().copied().map(Some));
        let connectors = (2..=design.modules).flat_map(|joint| {
            across().map(move |y_m| ConnectorRow {
                joint,
                y_m,
                compression: none,
                tension: none,
            })
        });
        let places = job.shared.record.places_x_m.iter().map(|&x_m| PlaceRow {
            x_m,
            deflection: none,
            uplift: none,
            static_deflection_m: None,
        });
        let (wheels, bodies) = vehicle_rows_of_none(job);
        Self {
            job: job.number,
            failure: Some(failure),
            retried: None,
            summary: Summary::default(),
            positions: positions.collect(),
            connectors: connectors.collect(),
            histories: HistoryRows::default(),
            modes: Vec::new(),
            pins: pin_rows_of_none(job),
            sections: section_rows_of_none(job),
            places: places.collect(),
            at_peaks: Vec::new(),
            banks: bank_rows_of_none(job),
            dead: Vec::new(),
            freeboards: freeboard_rows_of_none(job),
            wheels,
            bodies,
            limits: limit_rows_of_none(job),
        }
    }
}

impl Summary {
    /// Fills in the peaks of pins and joints, where these are recorded (the first of equals; no place where the peak is zero).
    pub fn take_joint_peaks(&mut self, pins: &[PinRow], sections: &[SectionRow]) {
        let largest = |rows: &mut dyn Iterator<Item = (usize, Option<f64>)>| {
            let mut best: (Option<usize>, Option<f64>) = (None, None);
            for (joint, value) in rows {
                if value > best.1 {
                    best = (Some(joint).filter(|_| value > Some(0.0)), value);
                }
            }
            best
        };
        let each = pins.iter().filter(|pin| pin.y_m.is_some());
        let found = largest(&mut each.map(|pin| (pin.joint, pin.resultant.value)));
        (self.peak_pin_joint, self.peak_pin_n) = found;
        let of = |quantity: &'static str| {
            let rows = sections.iter().filter(move |row| row.quantity == quantity);
            rows.flat_map(|row| row.sides.map(|side| (row.joint, side.value)))
        };
        (self.peak_angle_joint, self.peak_angle_rad) = largest(&mut of("angle_rad"));
        (self.peak_bending_joint, self.peak_bending_nm) = largest(&mut of("bending_nm"));
    }

    /// Fills in what governs, where limits are stated.
    pub fn take_limits(&mut self, limits: &[LimitRow]) {
        if let Some(row) = governing(limits) {
            self.utilisation = row.utilisation;
            self.take_governing(row);
        }
    }

    /// Fills in which limit governs, and where and when.
    pub fn take_governing(&mut self, row: &LimitRow) {
        self.governing_limit = Some(row.limit.clone());
        (self.governing_place, self.governing_time_s) = (row.place, row.demand.time_s);
    }

    /// Fills in the smallest freeboard, where these are recorded (the first of equals).
    pub fn take_freeboards(&mut self, freeboards: &[FreeboardRow]) {
        for row in freeboards {
            let Some(board_m) = row.least.value else { continue };
            if self.least_freeboard_m.is_none_or(|least_m| board_m < least_m) {
                (self.least_freeboard_m, self.least_freeboard_module) = (Some(board_m), Some(row.module));
            }
        }
    }

    /// Fills in the peaks of the whole bridge from the rows of its positions and joints (the first of equals; no place
    /// where the peak is zero).
    pub fn take_peaks(&mut self, positions: &[PositionRow], connectors: &[ConnectorRow]) {
        let place = |rows: &mut dyn Iterator<Item = (usize, Extreme)>| {
            let mut best = (
                None,
                Extreme {
                    value: Some(0.0),
                    time_s: None,
                },
            );
            for (place, extreme) in rows {
                if extreme.value > best.1.value {
                    best = (Some(place), extreme);
                }
            }
            best
        };
        let (at, peak) = place(&mut positions.iter().map(|p| (p.position, p.deflection)));
        (
            self.peak_deflection_m,
            self.peak_deflection_position,
            self.peak_deflection_time_s,
        ) = (peak.value, at, peak.time_s);
        let (at, peak) = place(&mut positions.iter().map(|p| (p.position, p.uplift)));
        (self.peak_uplift_m, self.peak_uplift_position, self.peak_uplift_time_s) = (peak.value, at, peak.time_s);
        let sums = || connectors.iter().filter(|c| c.y_m.is_none());
        let (at, peak) = place(&mut sums().map(|c| (c.joint, c.compression)));
        (self.peak_compression_n, self.peak_compression_joint) = (peak.value, at);
        let (at, peak) = place(&mut sums().map(|c| (c.joint, c.tension)));
        (self.peak_tension_n, self.peak_tension_joint) = (peak.value, at);
    }
}

#[cfg(test)]
mod tests;
