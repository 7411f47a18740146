//! Results held against references and older results; a bridge's numbers identified from them.
//!
//! | module | charter |
//! |---|---|
//! | [`quantity`] | quantities of a reference, and their values on results |
//! | [`checks`] | the kinds of checks, a file each |
//! | [`mod@reference`] | the reference file: checks with their source |
//! | [`compare`] | results held against a reference, or against older results |
//! | [`calibrate`] | a bridge's numbers identified from the checks of references |
//! | [`schema`] | the JSON Schema of references and parameters |
//!
//! Knows what a check asks and when it falls short. Does not know how a verdict is shown.

pub mod calibrate;
pub mod checks;
pub mod compare;
pub mod quantity;
pub mod reference;
pub mod schema;
