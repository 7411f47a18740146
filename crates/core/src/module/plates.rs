//! Which plate of the box a shell is part of.
//!
//! Knows the box's planes. Does not know how a plate is meshed.

use super::{ModuleDesign, Outline};
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
        let outline = design.outline();
        let lies = |height: fn(&Outline, f64) -> f64| corners.iter().all(|c| is(c.z, height(&outline, c.x)));
        if lies(Outline::bottom_at_m) {
            return Self::Bottom;
        }
        if lies(Outline::deck_at_m) {
            return Self::Deck;
        }
        match (plane(0), plane(1)) {
            (_, Some(y)) if is(y.abs(), 0.5 * design.breadth_m) => Self::Side,
            (_, Some(_)) => Self::LongitudinalWall,
            (Some(x), _) if is(x, 0.0) || is(x, design.length_m) => Self::End,
            (Some(_), _) => Self::TransverseWall,
            _ => Self::Other,
        }
    }
}
