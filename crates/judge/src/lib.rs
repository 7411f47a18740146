//! Results held against references and older results; a bridge's numbers identified from them.
//!
//! | module | charter |
//! |---|---|
//! | [`mod@reference`] | the reference file: checks with their source |
//! | [`compare`] | results held against a reference, or against older results |
//! | [`calibrate`] | a bridge's numbers identified from the checks of references |
//! | [`schema`] | the JSON Schema of references and parameters |
//!
//! Knows what a check asks and when it falls short. Does not know how a verdict is shown.

pub mod calibrate;
pub mod compare;
pub mod reference;
pub mod schema;
