//! The modules' lengths as a file writes them: one number, or a list.
//!
//! Knows both forms. Does not know what a length is asked for.

use schemars::JsonSchema;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// Lengths of the modules `[m]`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ModuleLengths {
    /// All have this one.
    Same(f64),
    /// Each has its own, from the first module on.
    Each(Vec<f64>),
}

impl ModuleLengths {
    /// The length of a module, by its number from 0; none of one that a list does not have.
    pub fn of(&self, module: usize) -> Option<f64> {
        match self {
            Self::Same(length) => Some(*length),
            Self::Each(lengths) => lengths.get(module).copied(),
        }
    }
}

impl<'de> Deserialize<'de> for ModuleLengths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LengthsVisitor;

        impl<'de> Visitor<'de> for LengthsVisitor {
            type Value = ModuleLengths;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or a list of one for each module")
            }

            fn visit_f64<E: Error>(self, length: f64) -> Result<ModuleLengths, E> {
                Ok(ModuleLengths::Same(length))
            }

            fn visit_u64<E: Error>(self, length: u64) -> Result<ModuleLengths, E> {
                Ok(ModuleLengths::Same(length as f64))
            }

            fn visit_i64<E: Error>(self, length: i64) -> Result<ModuleLengths, E> {
                Ok(ModuleLengths::Same(length as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<ModuleLengths, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(ModuleLengths::Each)
            }
        }

        deserializer.deserialize_any(LengthsVisitor)
    }
}
