//! What a study keeps of each job beyond its peaks.
//!
//! Knows which numbers a bridge has to record. Does not know tables.

use crate::input::{FoundValue, Refusal, RefusalKind};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::response::{Axis, PeakOf, Record, Section, Subject, WatchedPeak};
use pontoon_core::traffic::Traffic;
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::path::Path;

/// What to keep of each job beyond its peaks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordSpec {
    /// Histories of crossings.
    #[serde(default)]
    pub histories: HistoriesSpec,
    /// Whether to write the table of positions.
    #[serde(default = "yes")]
    pub positions: bool,
    /// Whether to write the table of connectors.
    #[serde(default = "yes")]
    pub connectors: bool,
    /// Whether to write the table of pins: a step then costs more.
    #[serde(default)]
    pub pins: bool,
    /// Whether to write the table of section forces and angles of joints: a step then costs more.
    #[serde(default)]
    pub sections: bool,
    /// Whether to write the table of freeboards at the corners of modules' decks.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub freeboards: bool,
    /// Places along the bridge whose deflection is followed, for the table of places `[m]`.
    #[serde(default)]
    pub places_x_m: Vec<f64>,
    /// Peaks of crossings at whose instant everything else is wanted, for the table of that.
    #[serde(default)]
    pub at_peak_of: Vec<PeakSpec>,
}

/// Whose histories to keep.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HistoriesSpec {
    /// Position numbers, 1 to modules + 1: deflection.
    #[serde(default)]
    pub positions: Vec<usize>,
    /// Joint numbers, 2 to modules: force.
    #[serde(default)]
    pub joints: Vec<usize>,
    /// Places of `record.places_x_m`: deflection.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places_x_m: Vec<f64>,
    /// Joint numbers: force of each pin, along, across and up.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<usize>,
    /// Joint numbers: angle and section forces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sections: Vec<usize>,
    /// Numbers of vehicles on springs, from 1: force of each wheel and motion of the body.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vehicles: Vec<usize>,
}

/// A peak at whose instant everything else is wanted: its column, or its column at a position or joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum PeakSpec {
    /// The largest of the whole bridge.
    Column(PeakColumn),
    /// The largest at one place.
    At(PeakAt),
}

/// A peak at one place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PeakAt {
    /// Its column.
    pub column: PeakColumn,
    /// Position of a deflection or uplift.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<usize>,
    /// Joint of a force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint: Option<usize>,
}

/// Peaks that may be named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PeakColumn {
    /// Deflection of a position.
    PeakDeflectionM,
    /// Uplift of a position.
    PeakUpliftM,
    /// Compression of a joint, its connectors added.
    PeakCompressionN,
    /// Tension of a joint, its connectors added.
    PeakTensionN,
    /// Resultant of a pin.
    PeakPinN,
}

impl<'de> Deserialize<'de> for PeakSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PeakVisitor)
    }
}

/// Reads a peak, so that what is wrong is told as of a column or of a document.
struct PeakVisitor;

impl<'de> Visitor<'de> for PeakVisitor {
    type Value = PeakSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a column of peaks, or a document with column and position or joint")
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<PeakSpec, E> {
        PeakColumn::deserialize(StrDeserializer::new(word)).map(PeakSpec::Column)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<PeakSpec, A::Error> {
        PeakAt::deserialize(MapAccessDeserializer::new(map)).map(PeakSpec::At)
    }
}

impl PeakColumn {
    /// All of them.
    const ALL: [Self; 5] = [
        Self::PeakDeflectionM,
        Self::PeakUpliftM,
        Self::PeakCompressionN,
        Self::PeakTensionN,
        Self::PeakPinN,
    ];

    /// Their names in files and tables, in the order of the list.
    pub const WORDS: [&'static str; 5] = [
        "peak_deflection_m",
        "peak_uplift_m",
        "peak_compression_n",
        "peak_tension_n",
        "peak_pin_n",
    ];

    /// Its name in files and tables.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// What the mechanics calls it.
    pub fn of(self) -> PeakOf {
        match self {
            Self::PeakDeflectionM => PeakOf::Deflection,
            Self::PeakUpliftM => PeakOf::Uplift,
            Self::PeakCompressionN => PeakOf::Compression,
            Self::PeakTensionN => PeakOf::Tension,
            Self::PeakPinN => PeakOf::Pin,
        }
    }

    /// The name of what the mechanics calls it.
    pub fn word_of(of: PeakOf) -> &'static str {
        let named = Self::ALL.into_iter().find(|column| column.of() == of);
        named.map_or("", Self::word)
    }

    /// Whether it is one of positions and not of joints.
    fn is_of_positions(self) -> bool {
        matches!(self, Self::PeakDeflectionM | Self::PeakUpliftM)
    }
}

impl PeakSpec {
    /// As the mechanics takes it.
    fn watched(self) -> WatchedPeak {
        match self {
            Self::Column(column) => WatchedPeak {
                of: column.of(),
                number: None,
            },
            Self::At(at) => WatchedPeak {
                of: at.column.of(),
                number: at.position.or(at.joint),
            },
        }
    }
}

fn yes() -> bool {
    true
}

impl Default for RecordSpec {
    fn default() -> Self {
        Self {
            histories: HistoriesSpec::default(),
            positions: true,
            connectors: true,
            pins: false,
            sections: false,
            freeboards: false,
            places_x_m: Vec::new(),
            at_peak_of: Vec::new(),
        }
    }
}

impl HistoriesSpec {
    /// Whether any history is asked for.
    pub fn asked(&self) -> bool {
        let joints = [&self.joints, &self.pins, &self.sections];
        let vehicles = &self.vehicles;
        let lists = joints.into_iter().chain([&self.positions, vehicles]);
        !(self.places_x_m.is_empty() && lists.into_iter().all(Vec::is_empty))
    }

    /// How many series they are, on a bridge.
    pub fn series(&self, design: &BridgeDesign) -> usize {
        let pins: usize = self.pins.iter().map(|joint| design.hinges_of(*joint).y_m.len()).sum();
        let sections = Section::ALL.len() * self.sections.len();
        self.positions.len() + self.joints.len() + self.places_x_m.len() + Axis::ALL.len() * pins + sections
    }
}

/// Places closer than this are one `[m]`.
const ONE_PLACE_M: f64 = 1e-9;

impl RecordSpec {
    /// What is recorded of a crossing of a bridge under a traffic, as the mechanics takes it.
    pub fn of_crossing(&self, design: &BridgeDesign, traffic: &Traffic) -> Record {
        let mut record = self.of_bridge(design);
        for &number in &self.histories.vehicles {
            let vehicle = number - 1;
            let Some(driven) = traffic.vehicles.get(vehicle) else {
                continue;
            };
            let wheels = 0..driven.vehicle.patches.len();
            record
                .more
                .extend(wheels.map(|wheel| Subject::Wheel { vehicle, wheel }));
            let body = driven.vehicle.springs.iter().flat_map(|springs| &springs.body);
            record
                .more
                .extend(body.map(|&(motion, _)| Subject::Body { vehicle, motion }));
        }
        record
    }

    /// What is recorded of the bridge itself.
    pub fn of_bridge(&self, design: &BridgeDesign) -> Record {
        let histories = &self.histories;
        let at = |x_m: &f64| {
            self.places_x_m
                .iter()
                .position(|place| (place - x_m).abs() < ONE_PLACE_M)
        };
        let mut more: Vec<Subject> = histories.places_x_m.iter().filter_map(at).map(Subject::Place).collect();
        for &joint in &histories.pins {
            let pins = 0..design.hinges_of(joint).y_m.len();
            more.extend(pins.flat_map(|index| Axis::ALL.map(|axis| Subject::Pin { joint, index, axis })));
        }
        for &joint in &histories.sections {
            more.extend(Section::ALL.map(|of| Subject::Section { joint, of }));
        }
        Record {
            positions: histories.positions.clone(),
            joints: histories.joints.clone(),
            more,
            places_x_m: self.places_x_m.clone(),
            pins: self.pins,
            sections: self.sections,
            corners: self.freeboards,
            at_peaks: self.at_peak_of.iter().map(|peak| peak.watched()).collect(),
        }
    }

    /// Refuses what a bridge does not have, and what is asked for twice.
    ///
    /// # Errors
    /// [`Refusal`] with the key's path.
    pub(crate) fn check(&self, file: &Path, design: &BridgeDesign) -> Result<(), Refusal> {
        let modules = design.modules;
        let histories = &self.histories;
        for (of, list, from, to) in [
            ("positions", &histories.positions, 1, modules + 1),
            ("joints", &histories.joints, 2, modules),
            ("pins", &histories.pins, 2, modules),
            ("sections", &histories.sections, 2, modules),
        ] {
            for (i, &number) in list.iter().enumerate() {
                let key = format!("record.histories.{of}[{i}]");
                check_number(file, &key, number, (from, to))?;
                if list[..i].contains(&number) {
                    return Err(Refusal::new(file, key, number, "each number once").because(RefusalKind::Repeated));
                }
            }
        }
        if self.freeboards && design.freeboards_m().iter().all(Option::is_none) {
            let found = FoundValue::value(true).which("with no module that has a freeboard_m");
            let refused = Refusal::new(
                file,
                "record.freeboards",
                found,
                "freeboard_m of the bridge, or of its kinds",
            );
            return Err(refused.because(RefusalKind::Conflict));
        }
        self.check_places(file, design.length_m())?;
        self.check_peaks(file, design)
    }

    /// Refuses vehicles that a traffic does not have, those without springs, and one twice.
    ///
    /// # Errors
    /// [`Refusal`] at `record.histories.vehicles`.
    pub(crate) fn check_vehicles(&self, file: &Path, traffic: &Traffic) -> Result<(), Refusal> {
        let list = &self.histories.vehicles;
        for (i, &number) in list.iter().enumerate() {
            let key = format!("record.histories.vehicles[{i}]");
            let count = traffic.vehicles.len();
            if !(1..=count).contains(&number) {
                return Err(Refusal::new(file, key, number, format!("a number from 1 to {count}")));
            }
            if traffic.vehicles[number - 1].vehicle.springs.is_none() {
                let found = FoundValue::value(number).which("which is a vehicle without springs");
                let refused = Refusal::new(file, key, found, "a vehicle on springs");
                return Err(refused.because(RefusalKind::Conflict));
            }
            if list[..i].contains(&number) {
                return Err(Refusal::new(file, key, number, "each vehicle once").because(RefusalKind::Repeated));
            }
        }
        Ok(())
    }

    /// Refuses places off the bridge, one twice, and histories of others.
    fn check_places(&self, file: &Path, length_m: f64) -> Result<(), Refusal> {
        let known = |list: &[f64], x_m: f64| list.iter().any(|place| (place - x_m).abs() < ONE_PLACE_M);
        for (i, &x_m) in self.places_x_m.iter().enumerate() {
            let key = format!("record.places_x_m[{i}]");
            if !(0.0..=length_m).contains(&x_m) {
                return Err(Refusal::new(
                    file,
                    key,
                    x_m,
                    format!("0 to {length_m}, the bridge's length in m"),
                ));
            }
            if known(&self.places_x_m[..i], x_m) {
                return Err(Refusal::new(file, key, x_m, "each place once").because(RefusalKind::Repeated));
            }
        }
        let of_histories = &self.histories.places_x_m;
        for (i, &x_m) in of_histories.iter().enumerate() {
            let key = format!("record.histories.places_x_m[{i}]");
            if !known(&self.places_x_m, x_m) {
                return Err(Refusal::new(file, key, x_m, "a place of record.places_x_m"));
            }
            if known(&of_histories[..i], x_m) {
                return Err(Refusal::new(file, key, x_m, "each place once").because(RefusalKind::Repeated));
            }
        }
        Ok(())
    }

    /// Refuses peaks of what there is not, one twice, and one of pins that are not recorded.
    fn check_peaks(&self, file: &Path, design: &BridgeDesign) -> Result<(), Refusal> {
        let (modules, pins) = (design.modules, self.of_bridge(design).needs_pins());
        for (i, &peak) in self.at_peak_of.iter().enumerate() {
            let key = format!("record.at_peak_of[{i}]");
            let column = match peak {
                PeakSpec::Column(column) => column,
                PeakSpec::At(at) => {
                    let (own, of, other, from) = if at.column.is_of_positions() {
                        ("position", at.position, at.joint.map(|joint| ("joint", joint)), 1)
                    } else {
                        ("joint", at.joint, at.position.map(|position| ("position", position)), 2)
                    };
                    if let Some((name, found)) = other {
                        let refused = Refusal::new(file, format!("{key}.{name}"), found, own);
                        return Err(refused.because(RefusalKind::Misplaced));
                    }
                    if let Some(number) = of {
                        let to = if from == 1 { modules + 1 } else { modules };
                        check_number(file, &format!("{key}.{own}"), number, (from, to))?;
                    }
                    at.column
                }
            };
            if column == PeakColumn::PeakPinN && !pins {
                let found = FoundValue::value(column.word()).which("without record.pins");
                let refused = Refusal::new(file, key, found, "record.pins true beside it");
                return Err(refused.because(RefusalKind::Conflict));
            }
            if self.at_peak_of[..i]
                .iter()
                .any(|before| before.watched() == peak.watched())
            {
                let found = FoundValue::value(column.word());
                return Err(Refusal::new(file, key, found, "each peak once").because(RefusalKind::Repeated));
            }
        }
        Ok(())
    }
}

/// Refuses a position or joint that the bridge does not have.
fn check_number(file: &Path, key: &str, number: usize, (from, to): (usize, usize)) -> Result<(), Refusal> {
    if (from..=to).contains(&number) {
        return Ok(());
    }
    let allowed = if from > to {
        "none: the bridge has no joint".to_owned()
    } else {
        format!("{from} to {to}")
    };
    Err(Refusal::new(file, key, number, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_written_by_its_word() {
        for column in PeakColumn::ALL {
            assert_eq!(serde_json::to_value(column).unwrap(), column.word());
            assert_eq!(PeakColumn::word_of(column.of()), column.word());
        }
    }
}
