//! Banks: springs between a bridge and the ground, as a bridge file writes them: ramps on a bank, abutments, guys.
//!
//! Knows which springs stand at which nodes and what law each has. Does not know contact or time.

use super::supports::{Direction, Supports};
use crate::connector::{ConnectorLaw, Truss};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M, apart, not_negative, positive};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::StrDeserializer;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::fmt;

/// A spring between the bottom of a module's end and the ground, shared evenly by its places across.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BankSpec {
    /// Where along the bridge.
    pub at: BankPlace,
    /// Direction of the spring.
    pub direction: Direction,
    /// Stiffness of all its places together `[N/m]`.
    pub stiffness_n_m: f64,
    /// Whether it acts in one sense alone, toward `toward`; `false` is a spring that holds both ways.
    #[serde(default = "yes")]
    pub one_sided: bool,
    /// Sense of the force on the bridge; where absent up, and along the bridge from the end towards its middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub toward: Option<Toward>,
    /// Way of the bridge against that sense before it acts `[m]`: the clearance of a bank, the slack of a cable.
    #[serde(default)]
    pub clearance_m: f64,
    /// Force with which it presses where the bridge has not moved `[N]`; in place of a clearance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preload_n: Option<f64>,
    /// Coefficient of a dashpot beside it, which acts while it does `[N s/m]`.
    #[serde(default)]
    pub damping_n_s_m: f64,
    /// Places across `[m]`; where absent all lines of the bottom edge for z, the hinge places for x and y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_m: Option<Vec<f64>>,
}

/// Where a bank is along the bridge: an end, or a position by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum BankPlace {
    /// An end.
    End(BridgeEnd),
    /// A position, 1 to modules + 1.
    Position(usize),
}

/// An end of the bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BridgeEnd {
    /// At x = 0.
    Left,
    /// The other one.
    Right,
}

/// Sense of a force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Toward {
    /// Along the axis of the direction.
    #[serde(rename = "+")]
    Plus,
    /// Against it.
    #[serde(rename = "-")]
    Minus,
}

/// The spring at one place across of a bank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BankSpring {
    /// The bank, from 0 in the order of the file.
    pub bank: usize,
    /// Its position, from 1.
    pub position: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Direction and sense of the force on the bridge.
    pub direction: Direction,
    pub sign: f64,
    /// Its share of the bank's stiffness `[N/m]`.
    pub stiffness_n_m: f64,
    /// Whether it acts in one sense alone.
    pub one_sided: bool,
}

fn yes() -> bool {
    true
}

impl<'de> Deserialize<'de> for BankPlace {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PlaceVisitor;

        impl Visitor<'_> for PlaceVisitor {
            type Value = BankPlace;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"left\", \"right\" or the number of a position")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<BankPlace, E> {
                BridgeEnd::deserialize(StrDeserializer::new(word)).map(BankPlace::End)
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<BankPlace, E> {
                Ok(BankPlace::Position(usize::try_from(number).unwrap_or(usize::MAX)))
            }
        }

        deserializer.deserialize_any(PlaceVisitor)
    }
}

impl JsonSchema for BankPlace {
    fn schema_name() -> Cow<'static, str> {
        "BankPlace".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "enum": ["left", "right"] }, { "type": "integer", "minimum": 1 }] })
    }
}

impl BankSpec {
    /// The bank as far as the structure depends on it: the law of one that acts in one sense alone is a job's.
    #[must_use]
    pub fn structure(&self) -> Self {
        let mut of = self.clone();
        if of.one_sided {
            of.stiffness_n_m = 1.0;
            of.clearance_m = 0.0;
            of.preload_n = None;
            of.damping_n_s_m = 0.0;
        }
        of
    }

    /// Places across of its springs `[m]`, on a bridge with such hinge places; `edge_y_m` gives the lines of a bottom edge.
    pub(super) fn places_y_m(&self, hinges_y_m: &[f64], edge_y_m: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
        match (&self.y_m, self.direction) {
            (Some(y_m), _) => y_m.clone(),
            (None, Direction::Z) => edge_y_m(),
            (None, _) => hinges_y_m.to_vec(),
        }
    }

    /// Its position on a bridge of so many modules, from 1.
    pub fn position(&self, modules: usize) -> usize {
        match self.at {
            BankPlace::End(BridgeEnd::Left) => 1,
            BankPlace::End(BridgeEnd::Right) => modules + 1,
            BankPlace::Position(position) => position,
        }
    }

    /// Sense of its force on the bridge, 1 along its direction and -1 against it.
    pub(super) fn sense(&self, modules: usize) -> f64 {
        self.sign(modules).unwrap_or(1.0)
    }

    /// Its sense, where it has one.
    fn sign(&self, modules: usize) -> Option<f64> {
        let given = self.toward.map(|toward| match toward {
            Toward::Plus => 1.0,
            Toward::Minus => -1.0,
        });
        given.or_else(|| match (self.direction, self.position(modules)) {
            (Direction::Z, _) => Some(1.0),
            (Direction::X, 1) => Some(1.0),
            (Direction::X, position) if position == modules + 1 => Some(-1.0),
            _ => (!self.one_sided).then_some(1.0),
        })
    }

    /// Refuses a bank that a bridge cannot have.
    fn check(&self, room: &BankRoom<'_>) -> Result<(), InvalidInput> {
        let modules = room.modules;
        if !(1..=modules + 1).contains(&self.position(modules)) {
            let allowed = format!("\"left\", \"right\" or a position from 1 to {}", modules + 1);
            return Err(InvalidInput::new("at", self.position(modules), allowed));
        }
        positive("stiffness_n_m", self.stiffness_n_m)?;
        not_negative("clearance_m", self.clearance_m)?;
        not_negative("damping_n_s_m", self.damping_n_s_m)?;
        let preload_n = not_negative("preload_n", self.preload_n.unwrap_or(0.0))?;
        if preload_n > 0.0 && self.clearance_m > 0.0 {
            let allowed = "none beside a clearance";
            return Err(InvalidInput::new("preload_n", preload_n, allowed).because(Problem::Conflict));
        }
        if !self.one_sided {
            for (key, value) in [
                ("clearance_m", self.clearance_m),
                ("preload_n", preload_n),
                ("damping_n_s_m", self.damping_n_s_m),
            ] {
                if value > 0.0 {
                    let allowed = "0 of a spring that holds both ways";
                    return Err(InvalidInput::new(key, value, allowed).because(Problem::Conflict));
                }
            }
        }
        if self.sign(modules).is_none() {
            let allowed = "\"+\" or \"-\", as the place does not say which sense it is";
            return Err(InvalidInput::new("toward", "neither", allowed).because(Problem::Missing));
        }
        let supports = room.supports;
        let held = match self.position(modules) {
            1 => ("left", supports.left.contains(&self.direction)),
            position if position == modules + 1 => ("right", supports.right.contains(&self.direction)),
            _ => ("", false),
        };
        if held.1 {
            let found = format!("{:?}", self.direction).to_lowercase();
            let allowed = format!("a direction that supports.{} does not hold", held.0);
            return Err(InvalidInput::new("direction", found, allowed).because(Problem::Conflict));
        }
        self.check_places(room)
    }

    /// Refuses places across where no node can take the spring.
    fn check_places(&self, room: &BankRoom<'_>) -> Result<(), InvalidInput> {
        let Some(y_m) = &self.y_m else { return Ok(()) };
        if y_m.is_empty() {
            return Err(InvalidInput::new("y_m", "an empty list", "at least one place across"));
        }
        apart("y_m", y_m)?;
        let known = self.known_places(room);
        for (i, y) in y_m.iter().enumerate() {
            if !known.iter().any(|place| (place - y).abs() <= SAME_PLACE_M) {
                let known = known.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
                let allowed = format!("a place of hinges, for z also of connectors or an edge: {known}");
                return Err(InvalidInput::new(format!("y_m[{i}]"), *y, allowed));
            }
        }
        Ok(())
    }

    fn known_places(&self, room: &BankRoom<'_>) -> Vec<f64> {
        let mut known = room.hinges_y_m.clone();
        if self.direction == Direction::Z {
            let half = room.half_breadth_m;
            known.extend(room.connectors_y_m.iter().copied().chain([-half, half]));
        }
        known.sort_by(f64::total_cmp);
        known.dedup_by(|a, b| (*a - *b).abs() <= SAME_PLACE_M);
        known
    }
}

/// What of a bridge decides whether a bank fits it.
pub(super) struct BankRoom<'a> {
    pub modules: usize,
    pub supports: &'a Supports,
    /// Lines of hinges across, and places of connectors `[m]`.
    pub hinges_y_m: Vec<f64>,
    pub connectors_y_m: &'a [f64],
    /// Half of the modules' breadth `[m]`.
    pub half_breadth_m: f64,
}

/// Refuses banks that a bridge cannot have.
///
/// # Errors
/// [`InvalidInput`] with the key's path.
pub(super) fn check_banks(banks: &[BankSpec], room: &BankRoom<'_>) -> Result<(), InvalidInput> {
    for (i, bank) in banks.iter().enumerate() {
        bank.check(room).map_err(|e| e.under(&format!("banks[{i}]")))?;
    }
    Ok(())
}

/// The springs of all banks of a bridge of so many modules, bank after bank, at the places across that `places_y_m` gives `[m]`.
pub(super) fn bank_springs(
    banks: &[BankSpec],
    modules: usize,
    places_y_m: impl Fn(&BankSpec) -> Vec<f64>,
) -> Vec<BankSpring> {
    let of_bank = |(bank, spec): (usize, &BankSpec)| {
        let places = places_y_m(spec);
        let share = 1.0 / places.len() as f64;
        let spring = |y_m: f64| BankSpring {
            bank,
            position: spec.position(modules),
            y_m,
            direction: spec.direction,
            sign: spec.sense(modules),
            stiffness_n_m: share * spec.stiffness_n_m,
            one_sided: spec.one_sided,
        };
        places.into_iter().map(spring).collect::<Vec<_>>()
    };
    banks.iter().enumerate().flat_map(of_bank).collect()
}

/// The law of a bank's spring: it pushes once the bridge has gone the clearance against its sense, under a preload before that.
/// Of a place with so much of the bank.
/// Equation (J8).
pub(super) fn bank_law(spec: &BankSpec, share: f64) -> ConnectorLaw {
    let none = Truss {
        stiffness_n_m: 0.0,
        gap_m: 0.0,
        damping_n_s_m: 0.0,
        stop: None,
    };
    ConnectorLaw::Gaps {
        tension: none,
        compression: Truss {
            stiffness_n_m: share * spec.stiffness_n_m,
            gap_m: spec.clearance_m - spec.preload_n.unwrap_or(0.0) / spec.stiffness_n_m,
            damping_n_s_m: share * spec.damping_n_s_m,
            stop: None,
        },
    }
}
