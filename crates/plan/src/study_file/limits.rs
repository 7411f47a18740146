//! Limit states: how far a bridge may go in a crossing.
//!
//! Knows which numbers may have a limit, and what a bridge must tell for it. Does not know how a number came about.

use pontoon_core::bridge::BridgeDesign;
use pontoon_core::input::{InvalidInput, Problem, not_negative, positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Limits of a study, each above 0; a crossing passes where none is exceeded.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitsSpec {
    /// Largest sinkage of the deck's edges: `peak_edge_deflection_m`, what the bridge sinks at rest where it has a dead load, and
    /// `static_trim_m` `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edge_sinkage_m: Option<f64>,
    /// In place of `edge_sinkage_m`: the least freeboard of the bridge's modules less this margin, at least 0 `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freeboard_margin_m: Option<f64>,
    /// Sinkage of an edge at rest that the bridge file does not know, added to `edge_sinkage_m`; 0 where absent `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_trim_m: Option<f64>,
    /// Largest uplift of a position, `peak_uplift_m` `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uplift_m: Option<f64>,
    /// In place of `uplift_m`: the draft of the bridge less this margin, at least 0 `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draft_margin_m: Option<f64>,
    /// Largest compression of a joint, its connectors added, `peak_compression_n` `[N]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_compression_n: Option<f64>,
    /// Largest tension of a joint, its connectors added, `peak_tension_n` `[N]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_tension_n: Option<f64>,
    /// Largest compression of a single connector `[N]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connector_compression_n: Option<f64>,
    /// Largest tension of a single connector `[N]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connector_tension_n: Option<f64>,
    /// Largest resultant of a pin, `peak_pin_n` `[N]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pin_force_n: Option<f64>,
    /// Largest angle of a joint, either sense, `peak_angle_rad` `[rad]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_angle_rad: Option<f64>,
    /// Largest roll of a module end, `peak_roll_rad` `[rad]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll_rad: Option<f64>,
    /// Largest trim of a module, either sense, `peak_trim_rad` `[rad]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trim_rad: Option<f64>,
    /// Smallest contact force of an axle that still passes, `min_contact_force_n` `[N]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axle_contact_n: Option<f64>,
}

/// A limit state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Limit {
    EdgeSinkage,
    Uplift,
    JointCompression,
    JointTension,
    ConnectorCompression,
    ConnectorTension,
    PinForce,
    JointAngle,
    Roll,
    Trim,
    AxleContact,
}

impl Limit {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::EdgeSinkage,
        Self::Uplift,
        Self::JointCompression,
        Self::JointTension,
        Self::ConnectorCompression,
        Self::ConnectorTension,
        Self::PinForce,
        Self::JointAngle,
        Self::Roll,
        Self::Trim,
        Self::AxleContact,
    ];

    /// Their names in files and tables, in the order of the list.
    pub const WORDS: [&'static str; 11] = [
        "edge_sinkage_m",
        "uplift_m",
        "joint_compression_n",
        "joint_tension_n",
        "connector_compression_n",
        "connector_tension_n",
        "pin_force_n",
        "joint_angle_rad",
        "roll_rad",
        "trim_rad",
        "axle_contact_n",
    ];

    /// Its name in files and tables.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// What its place is the number of.
    pub fn place(self) -> &'static str {
        match self {
            Self::EdgeSinkage | Self::Uplift | Self::Roll => "position",
            Self::Trim => "module",
            Self::AxleContact => "axle",
            _ => "joint",
        }
    }

    /// Whether only a bridge of several modules has it.
    fn is_of_joints(self) -> bool {
        self.place() == "joint"
    }

    /// Whether it bounds from below.
    pub fn is_floor(self) -> bool {
        self == Self::AxleContact
    }
}

/// A limit as a bridge has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowed {
    /// Which.
    pub limit: Limit,
    /// How much is allowed, in its unit.
    pub allowed: f64,
    /// What is added to what a crossing shows.
    pub beside: f64,
}

/// Largest utilisation of a limit from below, which no force has that has gone.
const GONE: f64 = 1000.0;

impl Allowed {
    /// How much of the limit a value uses up: 1 at the limit, more beyond it. Of a limit from below what is allowed over what is
    /// there.
    pub fn utilisation(&self, value: f64) -> f64 {
        if !self.limit.is_floor() {
            return value / self.allowed;
        }
        if value * GONE <= self.allowed {
            GONE
        } else {
            self.allowed / value
        }
    }
}

impl LimitsSpec {
    fn stated(&self) -> [Option<f64>; 11] {
        [
            self.edge_sinkage_m,
            self.uplift_m,
            self.joint_compression_n,
            self.joint_tension_n,
            self.connector_compression_n,
            self.connector_tension_n,
            self.pin_force_n,
            self.joint_angle_rad,
            self.roll_rad,
            self.trim_rad,
            self.axle_contact_n,
        ]
    }

    /// Whether a limit is stated, by a margin too.
    pub fn has(&self, limit: Limit) -> bool {
        let by_margin = match limit {
            Limit::EdgeSinkage => self.freeboard_margin_m,
            Limit::Uplift => self.draft_margin_m,
            _ => None,
        };
        self.stated()[limit as usize].or(by_margin).is_some()
    }

    /// The limits of a bridge, in the order of [`Limit::ALL`].
    ///
    /// # Errors
    /// [`InvalidInput`] with the key: none, a number that is not above 0, a limit stated twice, one that the bridge cannot have.
    pub fn of(&self, design: &BridgeDesign) -> Result<Vec<Allowed>, InvalidInput> {
        let least = |list: &[Option<f64>]| list.iter().copied().collect::<Option<Vec<f64>>>();
        let lowest = |list: Vec<f64>| list.into_iter().fold(f64::INFINITY, f64::min);
        let edge = less_margin(
            ("edge_sinkage_m", self.edge_sinkage_m),
            ("freeboard_margin_m", self.freeboard_margin_m),
            ("freeboard_m", least(&design.freeboards_m()).map(lowest)),
        )?;
        let uplift = less_margin(
            ("uplift_m", self.uplift_m),
            ("draft_margin_m", self.draft_margin_m),
            ("draft_m", least(&design.drafts_m()).map(lowest)),
        )?;
        let beside = not_negative("static_trim_m", self.static_trim_m.unwrap_or(0.0))?;
        if self.static_trim_m.is_some() && edge.is_none() {
            let refused = InvalidInput::new(
                "static_trim_m",
                beside,
                "none without edge_sinkage_m or freeboard_margin_m",
            );
            return Err(refused.because(Problem::Misplaced));
        }
        let mut list = Vec::new();
        for (limit, stated) in Limit::ALL.into_iter().zip(self.stated()) {
            let (allowed, beside) = match limit {
                Limit::EdgeSinkage => (edge, beside),
                Limit::Uplift => (uplift, 0.0),
                _ => (stated, 0.0),
            };
            let Some(allowed) = allowed else { continue };
            positive(limit.word(), allowed)?;
            if limit.is_of_joints() && design.modules < 2 {
                let found = "a limit of joints";
                let refused = InvalidInput::new(limit.word(), found, "none: the bridge of one module has no joint");
                return Err(refused.because(Problem::Conflict));
            }
            list.push(Allowed { limit, allowed, beside });
        }
        if list.is_empty() {
            let allowed = format!(
                "at least one of {}, freeboard_margin_m, draft_margin_m",
                Limit::WORDS.join(", ")
            );
            return Err(InvalidInput::new("", "no limit", allowed).because(Problem::Missing));
        }
        Ok(list)
    }
}

/// What is stated, or a height of the bridge less a margin.
fn less_margin(
    (key, stated): (&str, Option<f64>),
    (margin_key, margin_m): (&str, Option<f64>),
    (height_key, height_m): (&str, Option<f64>),
) -> Result<Option<f64>, InvalidInput> {
    let Some(margin_m) = margin_m else { return Ok(stated) };
    not_negative(margin_key, margin_m)?;
    if stated.is_some() {
        let refused = InvalidInput::new(margin_key, margin_m, format!("none beside {key}"));
        return Err(refused.because(Problem::Misplaced));
    }
    let Some(height_m) = height_m else {
        let found = format!("a margin of {margin_m} of a bridge without {height_key}");
        let refused = InvalidInput::new(
            margin_key,
            found,
            format!("{height_key} of the bridge and of all its kinds, or {key}"),
        );
        return Err(refused.because(Problem::Conflict));
    };
    if margin_m >= height_m {
        let refused = InvalidInput::new(
            margin_key,
            margin_m,
            format!("below {height_m}, the {height_key} of the bridge"),
        );
        return Err(refused.because(Problem::Conflict));
    }
    Ok(Some(height_m - margin_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_written_by_its_word() {
        for (limit, word) in Limit::ALL.into_iter().zip(Limit::WORDS) {
            let spec: LimitsSpec = serde_json::from_value(serde_json::json!({ word: 2.0 })).unwrap();
            assert!(spec.has(limit) && limit.word() == word);
        }
    }

    #[test]
    fn utilisation_is_one_at_the_limit() {
        let of = |limit, allowed| Allowed {
            limit,
            allowed,
            beside: 0.0,
        };
        assert!((of(Limit::Roll, 0.02).utilisation(0.03) - 1.5).abs() < 1e-12);
        let contact = of(Limit::AxleContact, 5e3);
        assert!((contact.utilisation(5e3) - 1.0).abs() < 1e-12 && contact.utilisation(1e4) < 1.0);
        assert!(contact.utilisation(-1e4) == GONE && contact.utilisation(0.0) == GONE);
    }
}
