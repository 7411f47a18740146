//! Mechanics of nonlinearly connected floating bridges: numbers in, numbers out. No files, no clock, no threads, no
//! randomness.
//!
//! The floors of the house, each knowing only those below it:
//!
//! | floor | module | charter |
//! |---|---|---|
//! | 0 | [`conventions`], [`input`], [`response`], [`stop`] | axes, units, signs; what a refused number looks like; whether to stop; peaks, histories and the energy balance, data that every floor above fills |
//! | 1 | [`fem`], `scheme` | shells, beams, assembly, factorisation, eigenvalues; constants of time integration; have never heard of a bridge |
//! | 2 | [`module`], [`water`], [`radiation`], [`superelement`] | the pontoon's geometry to finite elements, hydrostatics and added mass, radiated waves, condensation |
//! | 3 | [`connector`], [`vehicle`], [`road`], [`traffic`], [`bridge`] | the gap law, the wheels, what they drive on and how, and the one place where they all meet |
//! | 4 | `riding`, `flexibility`, `contact`, [`operator`] | vehicles on springs in a step, the factorised bridge at its places, active-set Newton, the reduced bridge in lanes |
//! | 5 | [`analysis`] | modes, statics, crossings |

pub mod analysis;
pub mod bridge;
pub mod connector;
mod contact;
pub mod conventions;
pub mod fem;
mod flexibility;
pub mod input;
pub mod module;
pub mod operator;
pub mod radiation;
pub mod response;
mod riding;
pub mod road;
mod scheme;
pub mod stop;
pub mod superelement;
pub mod traffic;
pub mod vehicle;
pub mod water;
