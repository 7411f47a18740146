//! Rows of pins and section forces, from the peaks of a crossing or the forces at rest.
//!
//! Knows what of them is rounding. Does not know how they were found.

use super::quantity_words::quantity_word;
use pontoon_core::response::{ForcePeaks, Peak, PinPeaks, Quantity, SECTIONS, Section, SectionPeaks, resultant_n};
use pontoon_plan::job::Job;
use pontoon_results::{Extreme, PinRow, SectionRow};

/// Share of the largest pin force below which a force is rounding, and a moment with a lever of 1 m. A load in the middle has no
/// force across; what rounding leaves of it, and when, hangs on the machine.
const ROUNDING: f64 = 1e-9;

/// What of the joints of a job is rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounding {
    largest_n: f64,
}

impl Rounding {
    /// Of a crossing.
    pub(super) fn of_peaks(pins: &[PinPeaks]) -> Self {
        let resultants = pins.iter().map(|pin| pin.extremes.resultant.value);
        Self {
            largest_n: resultants.fold(0.0, f64::max),
        }
    }

    /// At rest.
    pub(super) fn of_forces(pins_n: &[[f64; 3]]) -> Self {
        Self {
            largest_n: pins_n.iter().map(|force| resultant_n(*force)).fold(0.0, f64::max),
        }
    }

    /// Of one section force; no angle is rounding that a joint has at all.
    fn of_section(self, of: Section) -> Self {
        if of == Section::Angle {
            Self { largest_n: 0.0 }
        } else {
            self
        }
    }

    fn is_rounding(self, value: f64) -> bool {
        value < ROUNDING * self.largest_n
    }

    fn peak(self, peak: Peak) -> Extreme {
        if self.is_rounding(peak.value) {
            Extreme::timeless(0.0)
        } else {
            Extreme::at(peak.value, peak.time_s)
        }
    }

    fn peaks(self, peaks: ForcePeaks) -> [Extreme; 2] {
        [peaks.compression, peaks.tension].map(|peak| self.peak(peak))
    }

    /// A number at rest against its sense and with it.
    fn sides(self, number: f64) -> [Extreme; 2] {
        let side = |side: f64| if self.is_rounding(side) { 0.0 } else { side.max(0.0) };
        [0.0 - number, number].map(|of| Extreme::timeless(side(of)))
    }

    /// The row of a pin or of a joint's sum.
    pub(super) fn pin_row(self, peaks: &PinPeaks) -> PinRow {
        PinRow {
            joint: peaks.joint,
            y_m: peaks.y_m,
            components: peaks.extremes.components.map(|axis| self.peaks(axis)),
            resultant: self.peak(peaks.extremes.resultant),
        }
    }

    /// The row of a section force or angle.
    pub(super) fn section_row(self, peaks: &SectionPeaks) -> SectionRow {
        SectionRow {
            joint: peaks.joint,
            quantity: quantity_word(Quantity::Section(peaks.of)).to_owned(),
            sides: self.of_section(peaks.of).peaks(peaks.peaks),
        }
    }

    /// The rows of pins at rest, joint after joint, and of each joint's sum.
    pub(super) fn static_pin_rows(self, job: &Job, forces_n: &[[f64; 3]]) -> Vec<PinRow> {
        let design = &job.shared.bridge.design;
        let row = |joint: usize, y_m: Option<f64>, force_n: [f64; 3]| PinRow {
            joint,
            y_m,
            components: force_n.map(|force| self.sides(force)),
            resultant: Extreme::timeless(resultant_n(force_n)),
        };
        let (mut forces, mut rows) = (forces_n.iter().copied(), Vec::new());
        for joint in 2..=design.modules {
            let mut sum = [0.0; 3];
            for (&y_m, force) in design.hinges_of(joint).y_m.iter().zip(&mut forces) {
                (0..3).for_each(|axis| sum[axis] += force[axis]);
                rows.push(row(joint, Some(y_m), force));
            }
            rows.push(row(joint, None, sum));
        }
        rows
    }

    /// The rows of angles and section forces at rest, joint after joint.
    pub(super) fn static_section_rows(self, sections: &[[f64; SECTIONS]]) -> Vec<SectionRow> {
        let row = |joint: usize, (of, value): (Section, f64)| SectionRow {
            joint,
            quantity: quantity_word(Quantity::Section(of)).to_owned(),
            sides: self.of_section(of).sides(value),
        };
        let joints = (2..).zip(sections);
        let of_joint = |(joint, values): (usize, &[f64; SECTIONS])| {
            let each = Section::ALL.into_iter().zip(*values);
            each.map(move |of| row(joint, of))
        };
        joints.flat_map(of_joint).collect()
    }
}
