//! A largest value with its time.
//!
//! Knows that nothing occurred where the value is zero. Does not know what it is of.

use serde::{Deserialize, Serialize};

/// A largest value with its time; the time is null where the value is zero, for nothing occurred then, and in a static
/// case.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// The value; null where the job failed.
    pub value: Option<f64>,
    /// Its time `[s]`.
    pub time_s: Option<f64>,
}

impl Extreme {
    /// A value with its time; none where the value is zero.
    pub fn at(value: f64, time_s: f64) -> Self {
        Self {
            value: Some(value),
            time_s: (value > 0.0).then_some(time_s),
        }
    }

    /// A value without a time.
    pub fn timeless(value: f64) -> Self {
        Self {
            value: Some(value),
            time_s: None,
        }
    }
}
