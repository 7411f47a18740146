//! Which plate of the box a shell is part of.
//!
//! Knows the box's planes. Does not know how a plate is meshed.

use super::ModuleDesign;
use crate::input::SAME_PLACE_M;
use nalgebra::Vector3;

/// A plate of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Plate {
    /// The deck.
    Deck,
    /// The bottom, which the water wets.
    Bottom,
    /// One of the two sides.
    Side,
    /// One of the two end walls.
    End,
    /// A wall inside, along the bridge.
    LongitudinalWall,
    /// A wall inside, across the bridge.
    TransverseWall,
    /// None of them: a shell of a mesh that is no box.
    Other,
}

impl Plate {
    /// All plates.
    pub const ALL: [Self; 7] = [
        Self::Deck,
        Self::Bottom,
        Self::Side,
        Self::End,
        Self::LongitudinalWall,
        Self::TransverseWall,
        Self::Other,
    ];

    /// Its name in words.
    pub fn word(self) -> &'static str {
        match self {
            Self::Deck => "deck",
            Self::Bottom => "bottom",
            Self::Side => "side",
            Self::End => "end wall",
            Self::LongitudinalWall => "longitudinal wall",
            Self::TransverseWall => "transverse wall",
            Self::Other => "other",
        }
    }

    /// The plate of the plane in which four `corners` `[m, of the module]` lie. A wall that a design puts in the plane of a
    /// side or an end is that side or end.
    pub fn of(design: &ModuleDesign, corners: [Vector3<f64>; 4]) -> Self {
        let plane = |direction: usize| {
            let at = corners[0][direction];
            let same = corners.iter().all(|c| (c[direction] - at).abs() <= SAME_PLACE_M);
            same.then_some(at)
        };
        let is = |at: f64, place: f64| (at - place).abs() <= SAME_PLACE_M;
        match (plane(0), plane(1), plane(2)) {
            (.., Some(z)) if is(z, 0.0) => Self::Bottom,
            (.., Some(z)) if is(z, design.depth_m) => Self::Deck,
            (_, Some(y), _) if is(y.abs(), 0.5 * design.breadth_m) => Self::Side,
            (_, Some(_), _) => Self::LongitudinalWall,
            (Some(x), ..) if is(x, 0.0) || is(x, design.length_m) => Self::End,
            (Some(_), ..) => Self::TransverseWall,
            _ => Self::Other,
        }
    }
}
