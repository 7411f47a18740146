//! The outline of a module from the side: heights of its deck and its bottom along it.
//!
//! Knows that both are plane between the ends. Does not know plates or neighbours.

/// Heights of deck and bottom over the length of a module, plane between its ends; from the bottom of its left end up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// Length along the bridge `[m]`.
    pub length_m: f64,
    /// Height of the bottom at the left and the right end `[m]`.
    pub bottom_m: [f64; 2],
    /// Height of the deck there `[m]`.
    pub deck_m: [f64; 2],
}

impl Outline {
    /// Height of the bottom at a place from the left end `[m]`: `z_b(x) = z_b(0) + (z_b(l) - z_b(0)) x / l`.
    /// Equation (E6).
    pub fn bottom_at_m(&self, x_m: f64) -> f64 {
        self.between(self.bottom_m, x_m)
    }

    /// Height of the deck at a place from the left end `[m]`, as [`Self::bottom_at_m`].
    pub fn deck_at_m(&self, x_m: f64) -> f64 {
        self.between(self.deck_m, x_m)
    }

    fn between(&self, [left, right]: [f64; 2], x_m: f64) -> f64 {
        left + (right - left) * (x_m / self.length_m)
    }

    /// Depth at the left and the right end `[m]`.
    pub fn depths_m(&self) -> [f64; 2] {
        [0, 1].map(|end| self.deck_m[end] - self.bottom_m[end])
    }

    /// The larger depth of its two ends `[m]`.
    pub fn largest_depth_m(&self) -> f64 {
        let [left, right] = self.depths_m();
        left.max(right)
    }

    /// Mean height of its four corners `[m]`.
    pub(crate) fn middle_m(&self) -> f64 {
        0.25 * self.bottom_m.iter().chain(&self.deck_m).sum::<f64>()
    }

    /// How far the bottom rises from the left end to the right one `[m]`.
    pub fn rise_m(&self) -> f64 {
        self.bottom_m[1] - self.bottom_m[0]
    }

    /// Whether deck and bottom are level.
    pub(crate) fn is_level(&self) -> bool {
        self.rise_m() == 0.0 && self.deck_m[0] == self.deck_m[1]
    }

    /// Its mirror image along x, ends exchanged, from the bottom of the new left end up.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let turned = |[left, right]: [f64; 2]| [right, left].map(|height| height - self.bottom_m[1]);
        Self {
            length_m: self.length_m,
            bottom_m: turned(self.bottom_m),
            deck_m: turned(self.deck_m),
        }
    }
}
