//! Numbers as a page carries them: little-endian bytes in base64, under the name of their type.
//!
//! Knows bytes. Does not know what the numbers mean.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::ser::{Serialize, SerializeMap, Serializer};

/// A list of numbers of one type, `{ "f32": "<base64>" }`; a number that is not there is NaN or the type's largest.
#[derive(Debug, Clone, PartialEq)]
pub enum Packed {
    /// Single precision.
    F32(Vec<f32>),
    /// Bytes.
    U8(Vec<u8>),
    /// Indices.
    U16(Vec<u16>),
    /// Counts and numbers of jobs.
    U32(Vec<u32>),
    /// Samples, to be multiplied by a scale.
    I16(Vec<i16>),
}

impl Packed {
    /// Numbers of which some may not be there.
    pub fn numbers(list: impl IntoIterator<Item = Option<f64>>) -> Self {
        let single = |x: Option<f64>| x.map_or(f32::NAN, |x| x as f32);
        Self::F32(list.into_iter().map(single).collect())
    }

    /// Number of its numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(list) => list.len(),
            Self::U8(list) => list.len(),
            Self::U16(list) => list.len(),
            Self::U32(list) => list.len(),
            Self::I16(list) => list.len(),
        }
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn name_and_bytes(&self) -> (&'static str, Vec<u8>) {
        match self {
            Self::F32(list) => ("f32", list.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Self::U8(list) => ("u8", list.clone()),
            Self::U16(list) => ("u16", list.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Self::U32(list) => ("u32", list.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Self::I16(list) => ("i16", list.iter().flat_map(|x| x.to_le_bytes()).collect()),
        }
    }
}

impl Serialize for Packed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (name, bytes) = self.name_and_bytes();
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(name, &STANDARD.encode(bytes))?;
        map.end()
    }
}

/// Samples in sixteen bits with the scale that they are to be multiplied by.
#[derive(Debug, Clone, PartialEq)]
pub struct Scaled {
    /// What one step of a sample is.
    pub scale: f64,
    /// The samples.
    pub samples: Vec<i16>,
}

impl Scaled {
    /// Samples of a list: no value is off by more than half of `scale`, which is the largest magnitude over 32,000.
    pub fn new(values: &[f64]) -> Self {
        let largest = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let scale = if largest > 0.0 { largest / 32_000.0 } else { 1.0 };
        // within 32,000 by what the scale is
        let samples = values.iter().map(|x| (x / scale).round() as i16).collect();
        Self { scale, samples }
    }
}

impl Serialize for Scaled {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (name, bytes) = Packed::I16(self.samples.clone()).name_and_bytes();
        let mut map = serializer.serialize_map(Some(2))?;
        map.serialize_entry("scale", &self.scale)?;
        map.serialize_entry(name, &STANDARD.encode(bytes))?;
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_are_their_bytes() {
        // 1.0f32 is 00 00 80 3f
        assert_eq!(json!(Packed::F32(vec![1.0])), json!({ "f32": "AACAPw==" }));
        assert_eq!(json!(Packed::U16(vec![1, 65_535])), json!({ "u16": "AQD//w==" }));
        let Packed::F32(list) = Packed::numbers([None, Some(2.0)]) else {
            panic!("single precision")
        };
        assert!(list[0].is_nan() && list[1] == 2.0);
    }

    #[test]
    fn samples_are_off_by_half_a_step_at_most() {
        let values: Vec<f64> = (0..1000).map(|i| 0.3 * f64::sin(0.1 * f64::from(i))).collect();
        let scaled = Scaled::new(&values);
        for (value, sample) in values.iter().zip(&scaled.samples) {
            assert!((value - f64::from(*sample) * scaled.scale).abs() <= 0.500_001 * scaled.scale);
        }
        assert_eq!(Scaled::new(&[0.0, 0.0]).samples, [0, 0]);
    }
}
