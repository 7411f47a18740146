//! What records are bound to, and who wrote them.
//!
//! Knows what must be the same for a record to be of use, and how to say what is not. Does not know files.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What the records of a journal's file are bound to: where any of it differs they are another study's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Binding {
    /// Form of the journal.
    pub form: u32,
    /// Name of the study.
    pub name: String,
    /// What the program's mechanics come to.
    pub numerics: String,
    /// Instructions that crossings by the operator ran on.
    pub instruction_path: String,
    /// The share of the study's jobs that was asked for, `K/N`; none where all were.
    pub shard: Option<String>,
    /// The bridge before axes, defaults filled in, without the words from which nothing is computed.
    pub bridge: Value,
    /// The vehicle before axes, defaults filled in.
    pub vehicle: Value,
    /// The analysis before axes, defaults filled in.
    pub analysis: Value,
    /// What is kept of each job.
    pub record: Value,
}

/// A process at work on a journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Session {
    /// When it began (UTC).
    pub started: String,
    /// Name of the machine.
    pub host: String,
    /// Number of the process.
    pub process: u32,
    /// Version of the program.
    pub version: String,
    /// Commit of the program's sources, where it was built from one.
    pub commit: Option<String>,
    /// Threads.
    pub threads: usize,
    /// Jobs of the study, or of the share asked for.
    pub jobs: usize,
    /// Those that were recorded before.
    pub known: usize,
    /// Whether jobs were solved one by one, apart, because processes had died with them.
    #[serde(default)]
    pub apart: bool,
    /// Hash of the study's document, under which its text stands beside the journal.
    pub study_blake3: String,
    /// Hash of the bridge's document.
    pub bridge_blake3: String,
    /// Water files that its bridges name, with the hashes of their documents.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub waters: Vec<(String, String)>,
}

/// How a process ended by itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionEnd {
    /// When (UTC).
    pub finished: String,
    /// `complete`, `interrupted` or why it could not go on.
    pub how: String,
    /// Wall time of what jobs share `[s]`.
    pub offline_s: f64,
    /// Wall time of the jobs `[s]`.
    pub jobs_s: f64,
}

/// Most differences that are told.
const MOST_TOLD: usize = 5;

impl Binding {
    /// What differs from `now`, each as `key: then, now`; instruction paths and shards are told apart by others. Nothing
    /// where the records of one are of use to the other.
    pub fn differences(&self, now: &Self) -> Vec<String> {
        let mut told = Vec::new();
        let mut words = |key: &str, then: &str, now: &str| {
            if then != now {
                told.push(format!("{key}: {then} then, {now} now"));
            }
        };
        words("name", &self.name, &now.name);
        words("the program's numerics", &self.numerics, &now.numerics);
        for (key, then, now) in [
            ("bridge", &self.bridge, &now.bridge),
            ("vehicle", &self.vehicle, &now.vehicle),
            ("analysis", &self.analysis, &now.analysis),
            ("record", &self.record, &now.record),
        ] {
            differ(key, then, now, &mut told);
        }
        if told.len() > MOST_TOLD {
            let more = told.len() - MOST_TOLD;
            told.truncate(MOST_TOLD);
            told.push(format!("and {more} more"));
        }
        told
    }
}

/// The values at which two documents differ.
fn differ(key: &str, then: &Value, now: &Value, told: &mut Vec<String>) {
    match (then, now) {
        (Value::Object(a), Value::Object(b)) => {
            let only_now = b.iter().filter(|(name, _)| !a.contains_key(*name));
            for name in a.keys().chain(only_now.map(|(name, _)| name)) {
                let of = |map: &serde_json::Map<String, Value>| map.get(name).cloned().unwrap_or_default();
                differ(&format!("{key}.{name}"), &of(a), &of(b), told);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                differ(&format!("{key}[{i}]"), a, b, told);
            }
        }
        _ if same(then, now) => {}
        _ => told.push(format!("{key}: {then} then, {now} now")),
    }
}

/// Whether two values are equal, numbers whatever their form: 2 is 2.0.
fn same(then: &Value, now: &Value) -> bool {
    then == now || (then.is_f64() || now.is_f64()) && then.as_f64().is_some() && then.as_f64() == now.as_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn differences_are_told_by_key() {
        let then = json!({ "a": { "b": [1, 2.0] }, "c": "x", "same": 1 });
        let now = json!({ "a": { "b": [1, 3] }, "d": true, "same": 1.0 });
        let mut told = Vec::new();
        differ("bridge", &then, &now, &mut told);
        assert_eq!(
            told,
            [
                "bridge.a.b[1]: 2.0 then, 3 now",
                "bridge.c: \"x\" then, null now",
                "bridge.d: null then, true now"
            ]
        );
    }
}
