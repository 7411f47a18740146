//! Joints as a bridge file writes them: hinges, connectors, and what single joints have of their own.
//!
//! Knows joints by their numbers and what each one's entries come to. Does not know what a job adds to that.

use crate::connector::{Connection, ConnectorLaw, EndStop, OwnLaws, Truss};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M, apart, not_negative, positive, within};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// Hinges of a joint: at each place the three translations of the two bottom nodes are tied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinges {
    /// Places across `[m]`.
    pub y_m: Vec<f64>,
}

/// Connectors of a joint: at each place one tension and one compression truss along x between the two deck nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Connectors {
    /// Places across `[m]`.
    pub y_m: Vec<f64>,
    /// Stiffness of one truss `[N/m]`.
    pub stiffness_n_m: f64,
    /// Elongation at which the tension truss begins to pull `[m]`, unless the study says otherwise.
    pub gap_tension_m: f64,
    /// Shortening at which the compression truss begins to push `[m]`, unless the study says otherwise.
    pub gap_compression_m: f64,
    /// Coefficient of the dashpot of one truss, which acts while the truss does `[N s/m]`; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_n_s_m: Option<f64>,
}

/// Entries of single joints in the order of the file; where two name one joint and one key, the later one counts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Joints(pub Vec<(JointRange, JointSpec)>);

/// Joints by number, from 2 to the number of modules, both ends included: `"7"` or `"3..14"`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JointRange {
    /// The first joint.
    pub first: usize,
    /// The last joint.
    pub last: usize,
}

/// What joints have of their own.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSpec {
    /// What their connectors have in place of the bridge's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connectors: Option<JointConnectors>,
    /// Their hinges in place of the bridge's; a place that is left out is a lost pin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hinges: Option<Hinges>,
}

/// What the connectors of a joint have in place of the bridge's.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointConnectors {
    /// Which connectors of the joint: their places across `[m]`, of `connectors.y_m`; all where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_y_m: Option<Vec<f64>>,
    /// Whether they are lost: they neither pull nor push.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost: Option<bool>,
    /// Whether the tension truss is there; `false` is an open coupling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension: Option<bool>,
    /// Whether the compression truss is there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compression: Option<bool>,
    /// Stiffness of one truss `[N/m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m: Option<f64>,
    /// Elongation at which the tension truss begins to pull `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap_tension_m: Option<f64>,
    /// Shortening at which the compression truss begins to push `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap_compression_m: Option<f64>,
    /// Coefficient of the dashpot of one truss `[N s/m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_n_s_m: Option<f64>,
    /// The second branch of the tension truss, which is then a buffer before a stop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop_tension: Option<StopSpec>,
    /// The second branch of the compression truss, which is then a buffer before a stop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop_compression: Option<StopSpec>,
}

/// A second branch of a truss.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StopSpec {
    /// Elongation or shortening at which it begins `[m]`, beyond the gap of the truss.
    pub gap_m: f64,
    /// Stiffness from there on, buffer and stop together `[N/m]`.
    pub stiffness_n_m: f64,
}

/// What a job says of the gaps of a joint: from the nominal ones (tension, compression) those that it has `[m]`.
pub type JointGaps<'a> = dyn Fn(usize, [f64; 2]) -> [f64; 2] + 'a;

impl JointRange {
    /// Reads a number or a range of numbers.
    fn parse(text: &str) -> Option<Self> {
        let number = |text: &str| text.parse().ok().filter(|n: &usize| n.to_string() == text);
        match text.split_once("..") {
            None => number(text).map(|n| Self { first: n, last: n }),
            Some((first, last)) => Some(Self {
                first: number(first)?,
                last: number(last)?,
            }),
        }
    }

    fn has(self, joint: usize) -> bool {
        (self.first..=self.last).contains(&joint)
    }
}

impl fmt::Display for JointRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.first == self.last {
            write!(f, "{}", self.first)
        } else {
            write!(f, "{}..{}", self.first, self.last)
        }
    }
}

impl Joints {
    /// Whether no joint has anything of its own.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Of so many modules the joints whose hinges differ from the bridge's `common` ones, one entry each: all that the
    /// structure depends on.
    #[must_use]
    pub fn structure(&self, modules: usize, common: &Hinges) -> Self {
        let own = |joint: usize| {
            let hinges = self.hinges_of(joint, common);
            (hinges != common).then(|| {
                let spec = JointSpec {
                    connectors: None,
                    hinges: Some(hinges.clone()),
                };
                (
                    JointRange {
                        first: joint,
                        last: joint,
                    },
                    spec,
                )
            })
        };
        if self.is_empty() {
            return Self::default();
        }
        Self((2..=modules).filter_map(own).collect())
    }

    /// The hinges of a joint: the last of its own, or the bridge's `common` ones.
    pub(super) fn hinges_of<'a>(&'a self, joint: usize, common: &'a Hinges) -> &'a Hinges {
        let mut own = self.of(joint).filter_map(|(_, spec)| spec.hinges.as_ref());
        own.next_back().unwrap_or(common)
    }

    /// Places across that some joint has a hinge at `[m]`: those of the bridge, then others in the order of joints.
    pub(super) fn hinge_lines_y_m(&self, common: &Hinges) -> Vec<f64> {
        let mut lines = common.y_m.clone();
        for (_, spec) in &self.0 {
            for &y_m in spec.hinges.iter().flat_map(|hinges| &hinges.y_m) {
                if !lines.iter().any(|line| (line - y_m).abs() <= SAME_PLACE_M) {
                    lines.push(y_m);
                }
            }
        }
        lines
    }

    /// The gaps (tension, compression) of a connector before a job's wear `[m]`: its own, or those of the job.
    pub(super) fn nominal_gaps_m(&self, joint: usize, y_m: f64, of_job: [f64; 2]) -> [f64; 2] {
        Own::of(self, joint, y_m).gaps_m(of_job)
    }

    /// The connectors whose laws differ from that of the connection.
    pub(super) fn own_laws(
        &self,
        modules: usize,
        connectors: &Connectors,
        connection: Connection,
        worn: Option<&JointGaps<'_>>,
    ) -> Result<OwnLaws, InvalidInput> {
        if self.is_empty() && worn.is_none() && connectors.damping_n_s_m.is_none() {
            return Ok(OwnLaws::default());
        }
        let common = ConnectorLaw::new(connectors.stiffness_n_m, connection);
        let places = (2..=modules).flat_map(|joint| connectors.y_m.iter().map(move |&y_m| (joint, y_m)));
        let mut laws = Vec::new();
        for (place, (joint, y_m)) in places.enumerate() {
            let law = Own::of(self, joint, y_m).law(joint, connectors, connection, worn)?;
            if law != common {
                laws.push((place, law));
            }
        }
        Ok(laws.into())
    }

    /// The entries that name a joint, each with its path.
    fn of(&self, joint: usize) -> impl DoubleEndedIterator<Item = (String, &JointSpec)> {
        let named = self.0.iter().filter(move |(range, _)| range.has(joint));
        named.map(|(range, spec)| (format!("joints[{range}]"), spec))
    }

    /// Refuses joints that do not exist and numbers that describe none.
    pub(super) fn check(&self, modules: usize, half: f64, connectors: &Connectors) -> Result<(), InvalidInput> {
        for (range, spec) in &self.0 {
            let key = format!("joints[{range}]");
            let JointRange { first, last } = *range;
            if first > last {
                let allowed = format!("the lower number first: \"{last}..{first}\"");
                return Err(InvalidInput::new(key, "a range backwards", allowed));
            }
            if first < 2 || last > modules {
                let allowed = match modules {
                    1 => "none: a bridge of one module has no joint".to_owned(),
                    _ => format!("joints from 2 to {modules}, the number of modules"),
                };
                return Err(InvalidInput::new(
                    key,
                    format!("joint {}", if first < 2 { first } else { last }),
                    allowed,
                ));
            }
            if let Some(hinges) = &spec.hinges {
                places("hinges.y_m", &hinges.y_m, half).map_err(|e| e.under(&key))?;
            }
            if let Some(own) = &spec.connectors {
                let of = format!("{key}.connectors");
                own.check(&connectors.y_m).map_err(|e| e.under(&of))?;
            }
        }
        Ok(())
    }
}

/// Refuses an empty list of places across, one off the module, and one that is given twice.
pub(super) fn places(key: &str, y: &[f64], half: f64) -> Result<(), InvalidInput> {
    if y.is_empty() {
        return Err(InvalidInput::new(key, "an empty list", "at least one place across"));
    }
    for (i, &y) in y.iter().enumerate() {
        within(&format!("{key}[{i}]"), y, -half, half)?;
    }
    apart(key, y)
}

impl Connectors {
    pub(super) fn check(&self, half: f64) -> Result<(), InvalidInput> {
        places("y_m", &self.y_m, half)?;
        positive("stiffness_n_m", self.stiffness_n_m)?;
        not_negative("gap_tension_m", self.gap_tension_m)?;
        not_negative("gap_compression_m", self.gap_compression_m)?;
        not_negative("damping_n_s_m", self.damping_n_s_m.unwrap_or(0.0))?;
        Ok(())
    }
}

impl JointConnectors {
    fn check(&self, places: &[f64]) -> Result<(), InvalidInput> {
        for (i, &y_m) in self.at_y_m.iter().flatten().enumerate() {
            if !places.iter().any(|place| (place - y_m).abs() <= SAME_PLACE_M) {
                let known = places.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
                let allowed = format!("a place of connectors.y_m: {known}");
                return Err(InvalidInput::new(format!("at_y_m[{i}]"), y_m, allowed));
            }
        }
        if let Some(stiffness) = self.stiffness_n_m {
            positive("stiffness_n_m", stiffness)?;
        }
        for (key, value) in [
            ("gap_tension_m", self.gap_tension_m),
            ("gap_compression_m", self.gap_compression_m),
            ("damping_n_s_m", self.damping_n_s_m),
        ] {
            not_negative(key, value.unwrap_or(0.0))?;
        }
        for (key, stop) in [
            ("stop_tension", self.stop_tension),
            ("stop_compression", self.stop_compression),
        ] {
            if let Some(stop) = stop {
                positive("gap_m", stop.gap_m).map_err(|e| e.under(key))?;
                positive("stiffness_n_m", stop.stiffness_n_m).map_err(|e| e.under(key))?;
            }
        }
        Ok(())
    }

    fn is_at(&self, y_m: f64) -> bool {
        let at = |places: &Vec<f64>| places.iter().any(|place| (place - y_m).abs() <= SAME_PLACE_M);
        self.at_y_m.as_ref().is_none_or(at)
    }
}

/// What a connector has of its own, of all entries that name it, with the path of the entry that set a stop.
#[derive(Default)]
struct Own {
    connectors: JointConnectors,
    stops: [String; 2],
}

impl Own {
    fn of(joints: &Joints, joint: usize, y_m: f64) -> Self {
        let mut own = Self::default();
        for (path, spec) in joints.of(joint) {
            if let Some(of) = spec.connectors.as_ref().filter(|of| of.is_at(y_m)) {
                own.take(&path, of);
            }
        }
        own
    }

    fn take(&mut self, path: &str, of: &JointConnectors) {
        let own = &mut self.connectors;
        own.lost = of.lost.or(own.lost);
        own.tension = of.tension.or(own.tension);
        own.compression = of.compression.or(own.compression);
        own.stiffness_n_m = of.stiffness_n_m.or(own.stiffness_n_m);
        own.gap_tension_m = of.gap_tension_m.or(own.gap_tension_m);
        own.gap_compression_m = of.gap_compression_m.or(own.gap_compression_m);
        own.damping_n_s_m = of.damping_n_s_m.or(own.damping_n_s_m);
        for (own, of, at, key) in [
            (&mut own.stop_tension, of.stop_tension, 0, "stop_tension"),
            (&mut own.stop_compression, of.stop_compression, 1, "stop_compression"),
        ] {
            if of.is_some() {
                *own = of;
                self.stops[at] = format!("{path}.connectors.{key}");
            }
        }
    }

    /// The trusses that are there: in tension, in compression.
    fn senses(&self) -> [bool; 2] {
        let lost = self.connectors.lost == Some(true);
        [self.connectors.tension, self.connectors.compression].map(|there| !lost && there != Some(false))
    }

    fn gaps_m(&self, of_job: [f64; 2]) -> [f64; 2] {
        [
            self.connectors.gap_tension_m.unwrap_or(of_job[0]),
            self.connectors.gap_compression_m.unwrap_or(of_job[1]),
        ]
    }

    /// The law of the connector, whose stiffness and damping are the `common` ones where it has none of its own.
    fn law(
        &self,
        joint: usize,
        common: &Connectors,
        connection: Connection,
        worn: Option<&JointGaps<'_>>,
    ) -> Result<ConnectorLaw, InvalidInput> {
        let stiffness_n_m = self.connectors.stiffness_n_m.unwrap_or(common.stiffness_n_m);
        let damping_n_s_m = self.connectors.damping_n_s_m.or(common.damping_n_s_m).unwrap_or(0.0);
        let of_job = match connection {
            Connection::Linear => {
                let there = self.senses().iter().filter(|there| **there).count();
                let share = 0.5 * there as f64;
                return Ok(ConnectorLaw::Linear {
                    stiffness_n_m: share * stiffness_n_m,
                    damping_n_s_m: share * damping_n_s_m,
                });
            }
            Connection::Nonlinear {
                gap_tension_m,
                gap_compression_m,
            } => [gap_tension_m, gap_compression_m],
        };
        let nominal = self.gaps_m(of_job);
        let [tension_m, compression_m] = worn.map_or(nominal, |worn| worn(joint, nominal));
        Ok(ConnectorLaw::Gaps {
            tension: self.truss(0, [stiffness_n_m, damping_n_s_m], tension_m)?,
            compression: self.truss(1, [stiffness_n_m, damping_n_s_m], compression_m)?,
        })
    }

    /// One truss of a connector with gaps, of a stiffness and a damping.
    fn truss(&self, sense: usize, of_truss: [f64; 2], gap_m: f64) -> Result<Truss, InvalidInput> {
        let stop = [self.connectors.stop_tension, self.connectors.stop_compression][sense];
        if let Some(stop) = stop.filter(|stop| stop.gap_m <= gap_m) {
            let allowed = format!("above {gap_m}, the gap of the truss before it");
            let key = format!("{}.gap_m", self.stops[sense]);
            return Err(InvalidInput::new(key, stop.gap_m, allowed).because(Problem::Conflict));
        }
        let [stiffness_n_m, damping_n_s_m] = if self.senses()[sense] { of_truss } else { [0.0; 2] };
        Ok(Truss {
            stiffness_n_m,
            gap_m,
            damping_n_s_m,
            stop: stop.map(|stop| EndStop {
                stiffness_n_m: stop.stiffness_n_m,
                gap_m: stop.gap_m,
            }),
        })
    }
}

impl Serialize for Joints {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(range, spec)| (range.to_string(), spec)))
    }
}

impl<'de> Deserialize<'de> for Joints {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = Joints;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of joints by number")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Joints, A::Error> {
                let mut entries = Vec::new();
                while let Some(key) = map.next_key::<String>()? {
                    let range = JointRange::parse(&key).ok_or_else(|| {
                        Error::invalid_value(Unexpected::Str(&key), &"a joint as \"7\" or joints as \"3..14\"")
                    })?;
                    entries.push((range, map.next_value()?));
                }
                Ok(Joints(entries))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

impl JsonSchema for Joints {
    fn schema_name() -> Cow<'static, str> {
        "Joints".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let spec = generator.subschema_for::<JointSpec>();
        json_schema!({
            "description": "What single joints have of their own, by number from 2 to modules: `7` or `3..14`, both ends \
                            included. Where two entries name one joint and one key, the later one counts.",
            "type": "object",
            "patternProperties": { r"^[1-9][0-9]*(\.\.[1-9][0-9]*)?$": spec },
            "additionalProperties": false
        })
    }
}
