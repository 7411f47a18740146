//! How lines are told apart: by colour, by dashes and by markers, so that print without colour tells them apart too.
//!
//! Knows shapes. Does not know what they stand for.

/// Sizes of letters `[pt]`.
pub(super) const SMALL: f64 = 7.0;
pub(super) const LARGE: f64 = 8.0;

/// Radius of a line's marker, of a mark `[pt]`.
pub(super) const MARKER: f64 = 2.2;
pub(super) const MARK: f64 = 4.2;

/// A style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Style {
    /// Its colour: of Okabe and Ito's, which differ for colour-blind eyes and, in grey, in lightness.
    pub colour: &'static str,
    /// Lengths of dashes and gaps `[pt]`; empty where it is drawn through.
    pub dashes: &'static str,
    /// Its width `[pt]`.
    pub width: f64,
    /// Its marker.
    pub marker: Option<Marker>,
}

/// A marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Marker {
    /// A filled circle.
    Disc,
    /// An open square.
    Square,
    /// An open triangle.
    Triangle,
    /// An open diamond.
    Diamond,
    /// An upright cross.
    Plus,
    /// An oblique cross.
    Cross,
}

const fn style(colour: &'static str, dashes: &'static str, marker: Marker) -> Style {
    Style {
        colour,
        dashes,
        width: 0.9,
        marker: Some(marker),
    }
}

/// The first is of what others are compared with.
const STYLES: [Style; 7] = [
    Style {
        colour: "#999999",
        dashes: "",
        width: 1.6,
        marker: None,
    },
    style("#000000", "", Marker::Disc),
    style("#0072b2", "4.5 2", Marker::Square),
    style("#d55e00", "1.2 1.4", Marker::Triangle),
    style("#007a5a", "6 1.6 1.2 1.6", Marker::Diamond),
    style("#aa4499", "9 2.5", Marker::Plus),
    style("#6b4a00", "4.5 1.4 1.2 1.4 1.2 1.4", Marker::Cross),
];

/// The style of a number.
pub(super) fn of(number: usize) -> Style {
    match number {
        0 => STYLES[0],
        n => STYLES[1 + (n - 1) % (STYLES.len() - 1)],
    }
}

impl Marker {
    /// Its outline around the origin, of a radius; and whether it is filled with its colour (else with white, but for crosses).
    pub(super) fn path(self, r: f64) -> (Vec<Vec<[f64; 2]>>, Fill) {
        let d = r * std::f64::consts::FRAC_1_SQRT_2;
        match self {
            Self::Disc => (Vec::new(), Fill::Colour),
            Self::Square => (vec![vec![[-d, -d], [d, -d], [d, d], [-d, d]]], Fill::White),
            Self::Triangle => (
                vec![vec![[0.0, -r], [0.9 * r, 0.7 * r], [-0.9 * r, 0.7 * r]]],
                Fill::White,
            ),
            Self::Diamond => (vec![vec![[0.0, -r], [r, 0.0], [0.0, r], [-r, 0.0]]], Fill::White),
            Self::Plus => (vec![vec![[-r, 0.0], [r, 0.0]], vec![[0.0, -r], [0.0, r]]], Fill::None),
            Self::Cross => (vec![vec![[-d, -d], [d, d]], vec![[-d, d], [d, -d]]], Fill::None),
        }
    }
}

/// With what a marker is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fill {
    /// With its own colour.
    Colour,
    /// With white.
    White,
    /// With nothing.
    None,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_styles_have_the_same_dashes_or_the_same_marker() {
        let all: Vec<Style> = (0..STYLES.len()).map(of).collect();
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                assert!(a.marker != b.marker && a.colour != b.colour && (a.dashes, a.width) != (b.dashes, b.width));
            }
        }
        assert_eq!(of(STYLES.len()), of(1));
    }
}
