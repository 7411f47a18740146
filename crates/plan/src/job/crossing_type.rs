//! Types of crossings as public manuals tell them apart: which spacing, speed and lane vehicles keep.
//!
//! Knows their numbers. Does not know what a crossing does to a bridge.

use crate::design::CROSSING_TYPES;
use pontoon_core::traffic::{ColumnDesign, SpacingFrom};
use pontoon_core::vehicle::Vehicle;

/// A type of crossing, after public manuals of military bridging.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CrossingType {
    /// A column 30.5 m apart, at the speed of the study and in the lane of the vehicle.
    Normal,
    /// A column 45.7 m apart on the centre line, at 3.6 m/s.
    Caution,
    /// One vehicle on the centre line, at 1.3 m/s.
    Risk,
}

impl CrossingType {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Normal, Self::Caution, Self::Risk];

    /// Their names, in the order of the list.
    pub const WORDS: [&'static str; 3] = CROSSING_TYPES;

    /// Its name.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// The type of a name.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|of| of.word() == word)
    }

    /// Its speed `[m/s]`; none where the study says it.
    pub fn speed_m_s(self) -> Option<f64> {
        match self {
            Self::Normal => None,
            Self::Caution => Some(3.6),
            Self::Risk => Some(1.3),
        }
    }

    /// Distance from tail to head `[m]`; none where one vehicle drives alone.
    fn spacing_m(self) -> Option<f64> {
        match self {
            Self::Normal => Some(30.5),
            Self::Caution => Some(45.7),
            Self::Risk => None,
        }
    }

    /// Its column of a vehicle: one more than the bridge can hold at once, so that it is full before the first has left and is so
    /// again after it.
    pub(super) fn column(self, vehicle: &Vehicle, length_m: f64) -> ColumnDesign {
        let [rear, front] = vehicle.reach_m();
        let spacing_m = self.spacing_m();
        let at_once = |spacing_m: f64| ((length_m + front - rear) / (spacing_m + front - rear)).ceil() as usize;
        let across = || vehicle.patches.iter().map(|patch| patch.y_m);
        let middle_m = 0.5 * (across().fold(f64::INFINITY, f64::min) + across().fold(f64::NEG_INFINITY, f64::max));
        ColumnDesign {
            vehicle: None,
            count: spacing_m.map_or(1, |spacing_m| 1 + at_once(spacing_m)),
            spacing_m: spacing_m.unwrap_or(1.0),
            spacing_from: SpacingFrom::TailToHead,
            load_n: None,
            speed_m_s: None,
            y_m: Some(-middle_m).filter(|_| self != Self::Normal),
            direction: None,
        }
    }
}
