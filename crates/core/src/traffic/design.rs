//! Traffic as a study writes it: a list of vehicles, or a column of equal ones, on a road.
//!
//! Knows keys, ranges, and what is taken from the study where an entry says nothing. Does not know how vehicles move the bridge.

use super::{Drive, Driven, Traffic};
use crate::input::{Found, InvalidInput, Problem, not_negative, positive};
use crate::road::{Road, RoadDesign, Ways};
use crate::vehicle::{Vehicle, VehicleDesign};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// One vehicle of a traffic.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrafficEntry {
    /// The vehicle, or the path of its file; the study's where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<VehicleOrFile>")]
    pub vehicle: Option<VehicleDesign>,
    /// Its weight, to which all its masses, springs and dampers are scaled `[N]`; its own where absent, or the axis `load_n`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_n: Option<f64>,
    /// Its speed `[m/s]`; that of the axis `speed_m_s` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// When its front is at the end of the bridge that it comes from `[s]`; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_time_s: Option<f64>,
    /// Distance of its head behind the tail of the vehicle before it in the list, when it is at the end of the bridge `[m]`; in place
    /// of `start_time_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub behind_m: Option<f64>,
    /// Place of its centre line across the bridge `[m]`; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_m: Option<f64>,
    /// 1 from the left end to the right, which it is where absent, -1 from the right to the left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1, max = 1))]
    pub direction: Option<i8>,
    /// Acceleration from the end of the bridge on, or of braking to `stop_x_m` `[m/s^2]`; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration_m_s2: Option<f64>,
    /// Where its front comes to a stop `[m]`; it drives on where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop_x_m: Option<f64>,
}

/// What a spacing is measured from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpacingFrom {
    /// From the tail of a vehicle to the head of the next, outer ends of their patches.
    #[default]
    TailToHead,
    /// From centre to centre.
    Centre,
}

/// Equal vehicles one behind the other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnDesign {
    /// The vehicle, or the path of its file; the study's where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<VehicleOrFile>")]
    pub vehicle: Option<VehicleDesign>,
    /// How many.
    #[schemars(range(min = 1, max = 200))]
    pub count: usize,
    /// Their spacing `[m]`.
    pub spacing_m: f64,
    /// What the spacing is measured from.
    #[serde(default)]
    pub spacing_from: SpacingFrom,
    /// Weight of each `[N]`; its own where absent, or the axis `load_n`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_n: Option<f64>,
    /// Speed of all `[m/s]`; that of the axis `speed_m_s` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Place of their centre line across the bridge `[m]`; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_m: Option<f64>,
    /// 1 from the left end to the right, which it is where absent, -1 from the right to the left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -1, max = 1))]
    pub direction: Option<i8>,
}

/// A vehicle as it is written, or the path of the file that holds it, relative to the study file.
#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code)]
pub enum VehicleOrFile {
    /// The path of a vehicle file.
    File(String),
    /// The vehicle itself.
    Vehicle(VehicleDesign),
}

/// All that drives over a bridge, and on which road: a list, a column, or the study's single vehicle.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrafficDesign {
    /// Vehicles, in the order of their numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 200))]
    pub traffic: Option<Vec<TrafficEntry>>,
    /// A column of equal vehicles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<ColumnDesign>,
    /// How uneven the road is; level where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness: Option<RoadDesign>,
}

/// Most vehicles at once.
const MOST_VEHICLES: usize = 200;

/// What a study says of its vehicle beside the traffic.
#[derive(Debug, Clone, Copy)]
pub struct StudyVehicle<'a> {
    /// The vehicle.
    pub design: &'a VehicleDesign,
    /// Its weight `[N]`, where that is said.
    pub load_n: Option<f64>,
    /// Its speed `[m/s]`, where that is said.
    pub speed_m_s: Option<f64>,
}

/// The deck that vehicles drive over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deck {
    /// Its length `[m]`.
    pub length_m: f64,
    /// Its breadth `[m]`.
    pub breadth_m: f64,
}

impl TrafficDesign {
    /// Whether one vehicle crosses as the study itself says.
    pub fn is_single(&self) -> bool {
        self.traffic.is_none() && self.column.is_none()
    }

    /// The traffic on a deck; of what it says nothing the study's vehicle, weight and speed.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key: of an entry what may not be, a weight or speed that nobody says, both a list and a column,
    /// vehicles that run into each other with place and time, a road for wheels without springs.
    pub fn traffic(&self, study: StudyVehicle<'_>, deck: Deck) -> Result<Traffic, InvalidInput> {
        self.traffic_on(study, deck, |design, ways| design.road(ways).map(Arc::new))
    }

    /// As [`Self::traffic`], on roads that are made or were made before.
    ///
    /// # Errors
    /// As there.
    pub fn traffic_on(
        &self,
        study: StudyVehicle<'_>,
        deck: Deck,
        make_road: impl FnOnce(&RoadDesign, &Ways<'_>) -> Result<Arc<Road>, InvalidInput>,
    ) -> Result<Traffic, InvalidInput> {
        let vehicles = match (&self.traffic, &self.column) {
            (Some(_), Some(_)) => {
                let refused = InvalidInput::new("column", "a column beside a traffic", "one of the two");
                return Err(refused.because(Problem::Misplaced));
            }
            (Some(entries), None) => listed(entries, study, deck)?,
            (None, Some(column)) => column.vehicles(study, deck).map_err(|e| e.under("column"))?,
            (None, None) => {
                let vehicle = Arc::new(study.design.check(deck.breadth_m).map_err(|e| e.under("vehicle"))?);
                let speed_m_s = said("speed_m_s", None, study.speed_m_s)?;
                vec![Driven {
                    load_n: weight_n(&vehicle, None, study.load_n)?,
                    vehicle,
                    drive: Drive::steady(speed_m_s),
                }]
            }
        };
        let mut traffic = Traffic { vehicles, road: None };
        if let Some(met) = traffic.collision(deck.length_m) {
            let [one, other] = met.vehicles.map(|number| number + 1);
            let found = format!(
                "vehicles {one} and {other} in one place of a lane, {:.2} m at {:.2} s",
                met.x_m, met.time_s
            );
            let key = if self.column.is_some() {
                "column.spacing_m"
            } else {
                "traffic"
            };
            let refused = InvalidInput::new(key, found, "vehicles that keep apart while they are on the bridge");
            return Err(refused.because(Problem::Conflict));
        }
        if let Some(roughness) = &self.roughness {
            let road = road(roughness, &traffic, deck, make_road);
            traffic.road = Some(road.map_err(|e| e.under("roughness"))?);
        }
        Ok(traffic)
    }
}

/// The road under the wheels of a traffic, all of which have springs.
fn road(
    design: &RoadDesign,
    traffic: &Traffic,
    deck: Deck,
    make_road: impl FnOnce(&RoadDesign, &Ways<'_>) -> Result<Arc<Road>, InvalidInput>,
) -> Result<Arc<Road>, InvalidInput> {
    let vehicles = || traffic.vehicles.iter().map(|driven| &driven.vehicle);
    if let Some(number) = vehicles().position(|vehicle| vehicle.patches.iter().any(|patch| patch.rigid > 0.0)) {
        let found = format!(
            "vehicle {}, of which a mass lies on the road without a spring",
            number + 1
        );
        let refused = InvalidInput::new("", found, "vehicles on springs alone: a mass without one would jump");
        return Err(refused.because(Problem::Conflict));
    }
    let mut y_m: Vec<f64> = vehicles()
        .flat_map(|vehicle| vehicle.patches.iter().map(|patch| patch.y_m))
        .collect();
    y_m.sort_by(f64::total_cmp);
    y_m.dedup();
    let length_m = |vehicle: &Arc<Vehicle>| {
        let [rear, front] = vehicle.reach_m();
        front - rear
    };
    let beyond_m = vehicles().map(length_m).fold(0.0, f64::max);
    let ways = Ways {
        length_m: deck.length_m,
        beyond_m,
        y_m: &y_m,
    };
    make_road(design, &ways)
}

/// A number that an entry says, or the study.
fn said(key: &str, own: Option<f64>, of_study: Option<f64>) -> Result<f64, InvalidInput> {
    match own.or(of_study) {
        Some(value) => positive(key, value),
        None => Err(InvalidInput::new(key, Found::Nothing, "a finite number above 0").because(Problem::Missing)),
    }
}

/// Weight of a vehicle: what is said, or its own.
fn weight_n(vehicle: &Vehicle, own: Option<f64>, of_study: Option<f64>) -> Result<f64, InvalidInput> {
    said("load_n", own, of_study.or(vehicle.weight_n))
}

/// Whether a direction is backward.
fn is_backward(direction: Option<i8>) -> Result<bool, InvalidInput> {
    match direction {
        None | Some(1) => Ok(false),
        Some(-1) => Ok(true),
        Some(other) => Err(InvalidInput::new("direction", f64::from(other), "1 or -1")),
    }
}

/// A vehicle in its lane.
fn placed(design: &VehicleDesign, y_m: Option<f64>, backward: bool, deck: Deck) -> Result<Arc<Vehicle>, InvalidInput> {
    let vehicle = design.check(deck.breadth_m).map_err(|e| e.under("vehicle"))?;
    Ok(Arc::new(vehicle.in_lane(
        y_m.unwrap_or(0.0),
        backward,
        deck.breadth_m,
    )?))
}

fn listed(entries: &[TrafficEntry], study: StudyVehicle<'_>, deck: Deck) -> Result<Vec<Driven>, InvalidInput> {
    if entries.is_empty() || entries.len() > MOST_VEHICLES {
        let found = match entries.len() {
            0 => "an empty list".to_owned(),
            many => format!("{many} vehicles"),
        };
        return Err(InvalidInput::new(
            "traffic",
            found,
            format!("1 to {MOST_VEHICLES} vehicles"),
        ));
    }
    let mut vehicles: Vec<Driven> = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        let driven = entry.driven(vehicles.last(), study, deck);
        vehicles.push(driven.map_err(|e| e.under(&format!("traffic[{number}]")))?);
    }
    Ok(vehicles)
}

impl TrafficEntry {
    fn driven(&self, before: Option<&Driven>, study: StudyVehicle<'_>, deck: Deck) -> Result<Driven, InvalidInput> {
        let backward = is_backward(self.direction)?;
        let vehicle = placed(self.vehicle.as_ref().unwrap_or(study.design), self.y_m, backward, deck)?;
        let mut drive = Drive {
            speed_m_s: said("speed_m_s", self.speed_m_s, study.speed_m_s)?,
            backward,
            start_s: self.start_time_s.unwrap_or(0.0),
            acceleration_m_s2: self.acceleration_m_s2.unwrap_or(0.0),
            stop_way_m: self
                .stop_x_m
                .map(|x_m| if backward { deck.length_m - x_m } else { x_m }),
        };
        if !drive.start_s.is_finite() {
            return Err(InvalidInput::new("start_time_s", drive.start_s, "a finite number"));
        }
        drive.check(deck.length_m, vehicle.behind_m())?;
        if let Some(behind_m) = self.behind_m {
            drive.start_s = self.start_behind_s(behind_m, before, &vehicle, backward)?;
        }
        Ok(Driven {
            load_n: weight_n(&vehicle, self.load_n, study.load_n)?,
            vehicle,
            drive,
        })
    }

    /// When the head is so far behind the tail of the vehicle before.
    fn start_behind_s(
        &self,
        behind_m: f64,
        before: Option<&Driven>,
        vehicle: &Vehicle,
        backward: bool,
    ) -> Result<f64, InvalidInput> {
        not_negative("behind_m", behind_m)?;
        let misplaced =
            |allowed: &str| Err(InvalidInput::new("behind_m", behind_m, allowed).because(Problem::Misplaced));
        if self.start_time_s.is_some() {
            return misplaced("behind_m or start_time_s, one of the two");
        }
        let Some(before) = before.filter(|before| before.drive.backward == backward) else {
            return misplaced("a vehicle before it in the list that drives the same way");
        };
        let way_m = behind_m - before.vehicle.reach_m()[0] + vehicle.reach_m()[1];
        let conflict = || {
            let allowed = "a distance that the vehicle before it comes to";
            InvalidInput::new("behind_m", behind_m, allowed).because(Problem::Conflict)
        };
        before.drive.reaches_s(way_m).ok_or_else(conflict)
    }
}

impl ColumnDesign {
    fn vehicles(&self, study: StudyVehicle<'_>, deck: Deck) -> Result<Vec<Driven>, InvalidInput> {
        if !(1..=MOST_VEHICLES).contains(&self.count) {
            let allowed = format!("a whole number from 1 to {MOST_VEHICLES}");
            return Err(InvalidInput::new("count", self.count, allowed));
        }
        not_negative("spacing_m", self.spacing_m)?;
        let backward = is_backward(self.direction)?;
        let vehicle = placed(self.vehicle.as_ref().unwrap_or(study.design), self.y_m, backward, deck)?;
        let speed_m_s = said("speed_m_s", self.speed_m_s, study.speed_m_s)?;
        let load_n = weight_n(&vehicle, self.load_n, study.load_n)?;
        let [rear, front] = vehicle.reach_m();
        let apart_m = match self.spacing_from {
            SpacingFrom::TailToHead => self.spacing_m + front - rear,
            SpacingFrom::Centre => self.spacing_m,
        };
        let driven = |number: usize| Driven {
            vehicle: Arc::clone(&vehicle),
            load_n,
            drive: Drive {
                start_s: number as f64 * apart_m / speed_m_s,
                backward,
                ..Drive::steady(speed_m_s)
            },
        };
        Ok((0..self.count).map(driven).collect())
    }
}
