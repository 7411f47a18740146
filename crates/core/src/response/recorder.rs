//! What is recorded of a crossing beside the peaks that every crossing leaves: places, section forces, histories, and the
//! whole response at the instant of a peak.
//!
//! Knows what was asked for. Does not know which solver steps, nor what a number means to a table.

use super::histories::{Histories, History};
use super::peaks::{BankPeaks, ForcePeaks, Peak, PlacePeaks, SectionPeaks, resultant_n};
use super::rides::{MotionPeaks, RidePart, RideWatch, WheelPeaks};
use super::subject::{Axis, BankPart, JointParts, Reading, Section, Subject, read};

/// What to record of a crossing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// Positions whose deflection is kept as a history, 1 to modules + 1.
    pub positions: Vec<usize>,
    /// Joints whose force is kept as a history, 2 to modules.
    pub joints: Vec<usize>,
    /// Histories of anything else.
    pub more: Vec<Subject>,
    /// Places along the bridge whose deflection is followed `[m]`.
    pub places_x_m: Vec<f64>,
    /// Whether forces of pins are wanted.
    pub pins: bool,
    /// Whether section forces and angles of joints are wanted.
    pub sections: bool,
    /// Whether the lowest place of each corner of the modules' decks is wanted.
    pub corners: bool,
    /// Peaks at whose instant everything else is wanted.
    pub at_peaks: Vec<WatchedPeak>,
}

/// A peak at whose instant everything else is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WatchedPeak {
    /// What is largest then.
    pub of: PeakOf,
    /// Position or joint; the largest of all where absent.
    pub number: Option<usize>,
}

/// What may be watched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PeakOf {
    /// Deflection of a position.
    Deflection,
    /// Uplift of a position.
    Uplift,
    /// Compression of a joint, its connectors added.
    Compression,
    /// Tension of a joint, its connectors added.
    Tension,
    /// Resultant of a pin.
    Pin,
}

impl Record {
    /// Whether pins are followed.
    pub fn needs_pins(&self) -> bool {
        self.pins || self.sections || self.more.iter().any(|subject| subject.is_of_balance())
    }

    /// What histories are kept of: positions, then joints, then the rest.
    pub fn histories(&self) -> Vec<Subject> {
        let positions = self.positions.iter().map(|&position| Subject::Position(position));
        let joints = self.joints.iter().map(|&joint| Subject::Joint(joint));
        positions.chain(joints).chain(self.more.iter().copied()).collect()
    }

    /// All that is told of the instant of a peak.
    fn told(&self, positions: usize, joints: &[JointParts]) -> Vec<Subject> {
        let mut told: Vec<Subject> = (1..=positions).map(Subject::Position).collect();
        told.extend((0..self.places_x_m.len()).map(Subject::Place));
        for parts in joints {
            let (joint, connectors) = (parts.joint, 0..parts.connectors_y_m.len());
            told.push(Subject::Joint(joint));
            told.extend(connectors.map(|index| Subject::Connector { joint, index }));
            if self.pins {
                let pins = 0..parts.pins_y_m.len();
                told.extend(pins.flat_map(|index| Axis::ALL.map(|axis| Subject::Pin { joint, index, axis })));
            }
            if self.sections {
                told.extend(Section::ALL.map(|of| Subject::Section { joint, of }));
            }
        }
        told
    }
}

/// The response at the instant of a peak.
#[derive(Debug, Clone, PartialEq)]
pub struct AtPeak {
    /// The peak.
    pub peak: WatchedPeak,
    /// Its value; 0 never occurred.
    pub largest: f64,
    /// End of the step in which it occurred `[s]`.
    pub time_s: f64,
    /// Instant of that step's balance, of pins and section forces `[s]`.
    pub balance_s: f64,
    /// The numbers of everything then; none where the peak never occurred.
    pub numbers: Vec<(Subject, f64)>,
}

/// What was recorded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recorded {
    /// Peaks of each place.
    pub places: Vec<PlacePeaks>,
    /// Peaks of banks: of each bank's sum, then of each place.
    pub banks: Vec<BankPeaks>,
    /// Extremes of the wheels of vehicles on springs, vehicle after vehicle.
    pub wheels: Vec<WheelPeaks>,
    /// Extremes of their bodies' motion.
    pub motions: Vec<MotionPeaks>,
    /// For how long any wheel on springs had left the deck `[s]`; none where there is no such wheel.
    pub contact_lost_s: Option<f64>,
    /// Largest deflection of each corner of the modules' decks, see [`super::DeadState::deck_corners_m`]; none where nobody asks.
    pub corners: Vec<Peak>,
    /// Peaks of angles and section forces, joint after joint.
    pub sections: Vec<SectionPeaks>,
    /// Times of the histories `[s]`; empty where none was asked for.
    pub history_time_s: Vec<f64>,
    /// Instants of the balance of the same steps `[s]`.
    pub balance_time_s: Vec<f64>,
    /// The histories, positions before joints.
    pub histories: Vec<History>,
    /// The response at instants of peaks.
    pub at_peaks: Vec<AtPeak>,
}

/// Records a crossing step by step.
#[derive(Debug, Clone)]
pub(crate) struct Recorder {
    joints: Vec<JointParts>,
    banks: Vec<BankPart>,
    told: Vec<Subject>,
    positions: usize,
    rides: RideWatch,
    recorded: Recorded,
    histories: Histories,
}

impl Recorder {
    /// Begins to record at a time, on a bridge of so many positions, joints and banks under vehicles on springs.
    pub(crate) fn new(
        positions: usize,
        (joints, banks): (Vec<JointParts>, Vec<BankPart>),
        (rides, from_s): (Vec<RidePart>, f64),
        record: &Record,
    ) -> Self {
        let place = |&x_m: &f64| PlacePeaks {
            x_m,
            deflection: Peak::default(),
            uplift: Peak::default(),
        };
        let of_joint = |parts: &JointParts| {
            let joint = parts.joint;
            Section::ALL.map(|of| SectionPeaks {
                joint,
                of,
                peaks: ForcePeaks::default(),
            })
        };
        let sections = joints.iter().filter(|_| record.sections).flat_map(of_joint);
        let at_peak = |&peak: &WatchedPeak| AtPeak {
            peak,
            largest: 0.0,
            time_s: 0.0,
            balance_s: 0.0,
            numbers: Vec::new(),
        };
        Self {
            told: if record.at_peaks.is_empty() {
                Vec::new()
            } else {
                record.told(positions, &joints)
            },
            positions,
            rides: RideWatch::new(rides, from_s),
            histories: Histories::new(record.histories()),
            recorded: Recorded {
                banks: bank_peaks(&banks),
                places: record.places_x_m.iter().map(place).collect(),
                sections: sections.collect(),
                corners: vec![Peak::default(); if record.corners { 4 * (positions - 1) } else { 0 }],
                at_peaks: record.at_peaks.iter().map(at_peak).collect(),
                ..Recorded::default()
            },
            joints,
            banks,
        }
    }

    /// Has room for the histories of so many steps and the beginning.
    pub(crate) fn expect(&mut self, steps: usize) {
        self.histories.expect(steps + 1);
    }

    /// Takes note of peaks after a step, be it whole or a part of one.
    #[inline]
    pub(crate) fn take(&mut self, reading: &impl Reading) {
        let Recorded {
            places,
            sections,
            at_peaks,
            banks,
            corners,
            ..
        } = &mut self.recorded;
        let unread = places.is_empty() && sections.is_empty() && at_peaks.is_empty();
        if unread && banks.is_empty() && corners.is_empty() && self.rides.is_empty() {
            return;
        }
        let [now_s, balance_s] = reading.times_s();
        if !self.rides.is_empty() {
            self.rides.take(
                now_s,
                |vehicle| reading.ride(vehicle),
                |vehicle, wheel| reading.is_on(vehicle, wheel),
            );
        }
        take_banks(&self.banks, banks, reading);
        for (index, corner) in corners.iter_mut().enumerate() {
            corner.take(reading.corner_m(index), now_s);
        }
        for (index, place) in places.iter_mut().enumerate() {
            let down = reading.place_m(index);
            place.deflection.take(down, now_s);
            place.uplift.take(-down, now_s);
        }
        for (peaks, parts) in sections.chunks_exact_mut(Section::ALL.len()).zip(&self.joints) {
            for (peaks, value) in peaks.iter_mut().zip(parts.sections(reading)) {
                let time_s = if peaks.of == Section::Angle { now_s } else { balance_s };
                peaks.peaks.take(value, time_s);
            }
        }
        for at in at_peaks {
            let value = watched(at.peak, self.positions, &self.joints, reading);
            if value > at.largest {
                (at.largest, at.time_s, at.balance_s) = (value, now_s, balance_s);
                let number = |&subject: &Subject| (subject, read(subject, &self.joints, reading));
                at.numbers = self.told.iter().map(number).collect();
            }
        }
    }

    /// Records the histories after a whole step, or at the beginning.
    pub(crate) fn note(&mut self, reading: &impl Reading) {
        if self.histories.subjects.is_empty() {
            return;
        }
        let recorded = &mut self.recorded;
        let [now_s, balance_s] = reading.times_s();
        recorded.history_time_s.push(now_s);
        recorded.balance_time_s.push(balance_s);
        let joints = &self.joints;
        self.histories.write(|subject| read(subject, joints, reading));
    }

    /// What was recorded.
    pub(crate) fn finish(&mut self) -> Recorded {
        let (mut recorded, rides) = (std::mem::take(&mut self.recorded), std::mem::take(&mut self.rides));
        recorded.histories = std::mem::take(&mut self.histories).finish();
        recorded.contact_lost_s = (!rides.is_empty()).then_some(rides.lost_s);
        (recorded.wheels, recorded.motions) = (rides.wheels, rides.motions);
        recorded
    }
}

/// Peaks of banks before anything occurred: of each bank's sum, then of each place.
fn bank_peaks(parts: &[BankPart]) -> Vec<BankPeaks> {
    let of_bank = |of: &[BankPart]| -> Vec<BankPeaks> {
        let places = of.iter().map(|part| Some(part.y_m));
        let rows = std::iter::once(None).chain(places);
        let row = |y_m: Option<f64>| BankPeaks {
            bank: of[0].bank,
            y_m,
            force: ForcePeaks::default(),
        };
        rows.map(row).collect()
    };
    parts.chunk_by(|a, b| a.bank == b.bank).flat_map(of_bank).collect()
}

/// Raises the peaks of banks.
fn take_banks(parts: &[BankPart], peaks: &mut [BankPeaks], reading: &impl Reading) {
    let [now_s, _] = reading.times_s();
    let mut rows = peaks.iter_mut();
    for of in parts.chunk_by(|a, b| a.bank == b.bank) {
        let Some(sum) = rows.next() else { return };
        let mut total = 0.0;
        for (part, peaks) in of.iter().zip(&mut rows) {
            let force = part.force_n(reading);
            total += force;
            peaks.force.take(force, now_s);
        }
        sum.force.take(total, now_s);
    }
}

/// The value of what is watched, of all numbers the largest where none is named.
fn watched(peak: WatchedPeak, positions: usize, joints: &[JointParts], reading: &impl Reading) -> f64 {
    let largest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
    let numbered = |number: usize| peak.number.is_none_or(|only| only == number);
    let joints = || joints.iter().filter(|parts| numbered(parts.joint));
    let heights = || {
        (0..positions)
            .filter(|i| numbered(i + 1))
            .map(|i| reading.position_m(i))
    };
    let forces = || joints().map(|parts| parts.force_n(reading));
    match peak.of {
        PeakOf::Deflection => largest(&mut heights()),
        PeakOf::Uplift => largest(&mut heights().map(|down| -down)),
        PeakOf::Compression => largest(&mut forces().map(|force| -force)),
        PeakOf::Tension => largest(&mut forces()),
        PeakOf::Pin => {
            let pins = joints().flat_map(|parts| parts.first_pin..parts.first_pin + parts.pins_y_m.len());
            largest(&mut pins.map(|pin| resultant_n(reading.pin_n(pin))))
        }
    }
}
