//! One side of a bridge that is its own mirror image across the centre line, under loads that are theirs.
//!
//! Knows which rows are images of each other, and makes an operator of the modes that are their own images. Does not know what
//! drives.
//!
//! A row of the side moves as each of its two images does, and its force is the sum of both (O10): one side has half of the modes,
//! links and observed rows of the bridge, and the same energies.

use super::basis::{BridgeOperator, Observed, OperatedModule, Sizes};
use super::pin_rows::PinRows;
use crate::contact::{Dashpot, LinkLaw};
use nalgebra::DMatrix;
use std::ops::Range;

/// How much of a mode may be what changes its sign in the mirror, or what keeps it, for the mode to be its own image or none:
/// rounding of its shape. A share of squares.
const OTHER_PARITY: f64 = 1e-12;

/// Modes that move no row by this share of what the largest mode does take no part: squares.
const STILL: f64 = 1e-20;

/// How far the flexibility between two links may be from that between their images, a share of the largest.
const OTHER_FLEXIBILITY: f64 = 1e-6;

/// One side of a bridge.
#[derive(Debug)]
pub(crate) struct SideBridge {
    pub(crate) operator: BridgeOperator,
    pub(crate) links: SideLinks,
}

/// The links of a side and those of the whole bridge.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SideLinks {
    /// Of each link of the side the two of the bridge; one twice that lies on the centre line.
    images: Vec<[usize; 2]>,
    /// Of each link of the bridge that of the side.
    of_link: Vec<usize>,
    /// Links of the side at a joint.
    per_joint: usize,
}

impl SideLinks {
    /// Of connectors that lie at `y_m` in each of so many joints; none where these places are not their own images.
    pub(crate) fn new(joints: usize, y_m: &[f64]) -> Option<Self> {
        let image = |y: f64| y_m.iter().position(|other| *other == -y);
        let in_joint: Vec<usize> = y_m.iter().map(|y| image(*y)).collect::<Option<_>>()?;
        let (mut images, mut of_link) = (Vec::new(), vec![0; joints * y_m.len()]);
        for joint in 0..joints {
            for (i, &other) in in_joint.iter().enumerate().filter(|(i, other)| *i <= **other) {
                let pair = [i, other].map(|i| joint * y_m.len() + i);
                pair.into_iter().for_each(|link| of_link[link] = images.len());
                images.push(pair);
            }
        }
        let per_joint = images.len().checked_div(joints).unwrap_or(0);
        Some(Self {
            images,
            of_link,
            per_joint,
        })
    }

    /// Links of the bridge.
    pub(crate) fn count(&self) -> usize {
        self.of_link.len()
    }

    /// The laws of the side's links from those of the bridge's; none where a link and its image have unlike laws.
    pub(crate) fn laws(&self, laws: &[LinkLaw]) -> Option<Vec<LinkLaw>> {
        let of_pair = |&[a, b]: &[usize; 2]| {
            let law = laws[a];
            (law == laws[b]).then(|| if a == b { law } else { law.doubled() })
        };
        self.images.iter().map(of_pair).collect()
    }

    /// The dashpots of the side's links; none where a link and its image have unlike ones.
    pub(crate) fn dashpots(&self, dashpots: &[Dashpot]) -> Option<Vec<Dashpot>> {
        let of = |link: usize| dashpots.iter().find(|dashpot| dashpot.link == link);
        let mut of_side = Vec::new();
        for (link, &[a, b]) in self.images.iter().enumerate() {
            match (of(a), of(b)) {
                (None, None) => {}
                (Some(one), Some(other)) if one.is_like(other) => {
                    of_side.push(if a == b { one.at(link) } else { one.at(link).doubled() });
                }
                _ => return None,
            }
        }
        Some(of_side)
    }

    /// The link of the side that stands for one of the bridge, and its share of the force.
    pub(crate) fn of(&self, link: usize) -> (usize, f64) {
        let of_side = self.of_link[link];
        let [a, b] = self.images[of_side];
        (of_side, if a == b { 1.0 } else { 0.5 })
    }

    /// The links of the side that stand for those of a joint, of which the first is given.
    #[inline]
    pub(crate) fn of_joint(&self, first: usize) -> Range<usize> {
        let start = self.of_link[first];
        start..start + self.per_joint
    }

    /// A link of the bridge for one of the side.
    pub(crate) fn whole(&self, link: usize) -> Option<usize> {
        self.images.get(link).map(|pair| pair[0])
    }
}

/// Rows of the bridge, of which a side has one of each two images.
struct Rows {
    /// The two images of each row that is kept.
    images: Vec<[usize; 2]>,
}

impl Rows {
    /// Rows whose images follow each other, after so many that are their own.
    fn beside(own: usize, pairs: usize) -> Self {
        let images = (0..own).map(|i| [i; 2]);
        Self {
            images: images
                .chain((0..pairs).map(|i| [own + 2 * i, own + 2 * i + 1]))
                .collect(),
        }
    }

    /// Means of the rows of a matrix over their images, in the columns that are kept.
    fn means(&self, of: &DMatrix<f64>, columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(self.images.len(), columns.len(), |i, k| {
            let [a, b] = self.images[i];
            0.5 * (of[(a, columns[k])] + of[(b, columns[k])])
        })
    }

    /// Means over the images of rows and of columns.
    fn means_among(&self, of: &DMatrix<f64>, columns: &Self) -> DMatrix<f64> {
        DMatrix::from_fn(self.images.len(), columns.images.len(), |i, j| {
            let ([a, b], [c, d]) = (self.images[i], columns.images[j]);
            0.25 * ((of[(a, c)] + of[(a, d)]) + (of[(b, c)] + of[(b, d)]))
        })
    }
}

/// A bridge with its mirror image.
struct Mirrored<'a> {
    whole: &'a BridgeOperator,
    links: &'a SideLinks,
}

/// One side of the bridge; none of a bridge that is not its own image: where a mode is neither its own image nor
/// its opposite, links answer otherwise than their images, or springs of banks are observed.
/// Equation (O10).
pub(crate) fn one_side(whole: &BridgeOperator, links: &SideLinks) -> Option<SideBridge> {
    Mirrored { whole, links }.side()
}

impl Mirrored<'_> {
    fn side(&self) -> Option<SideBridge> {
        let (whole, links) = (self.whole, self.links);
        let (sizes, rows) = (&whole.sizes, &whole.rows);
        if links.of_link.len() != sizes.connectors || rows.springs > 0 || !self.answers_alike() {
            return None;
        }
        let link_rows = Rows {
            images: links.images.clone(),
        };
        // positions and places lie on the centre line; corners come by two
        let corners = rows.corners + rows.bottom_corners;
        let mut observed = Rows::beside(rows.positions, corners / 2).images;
        observed.extend((0..rows.places).map(|i| [rows.positions + corners + i; 2]));
        let observed = Rows { images: observed };
        let inside = Rows::beside(0, sizes.inside / 2);
        // forces of both sides' pins are asked for
        let pins = Rows::beside(sizes.pins, 0);
        let modes = self.own_images(&link_rows, &observed, &inside)?;
        let side_sizes = Sizes {
            modes: modes.len(),
            connectors: link_rows.images.len(),
            joint_connectors: link_rows.images.len(),
            observed: observed.images.len(),
            inside: inside.images.len(),
            modules: sizes.modules,
            pins: sizes.pins,
        };
        let of_mode = |of: &[f64]| modes.iter().map(|&k| of[k]).collect();
        let of_module = |module: &OperatedModule| OperatedModule {
            inside: module.inside.start / 2..module.inside.end / 2,
            ..module.clone()
        };
        let r_bb = link_rows.means_among(&whole.r_bb, &link_rows);
        let n = r_bb.nrows();
        let operator = BridgeOperator {
            sizes: side_sizes,
            rows: Observed {
                corners: rows.corners / 2,
                bottom_corners: rows.bottom_corners / 2,
                edges: 1,
                ..*rows
            },
            cutoff: whole.cutoff,
            omega2: of_mode(&whole.omega2),
            omega2_water: of_mode(&whole.omega2_water),
            b: link_rows.means(&whole.b, &modes),
            r_bb: DMatrix::from_fn(n, n, |i, j| r_bb[(i.min(j), i.max(j))]),
            v: observed.means(&whole.v, &modes),
            r_vb: observed.means_among(&whole.r_vb, &link_rows),
            inside: inside.means(&whole.inside, &modes),
            r_inside_b: inside.means_among(&whole.r_inside_b, &link_rows),
            inside_bounds: whole.inside_bounds.clone(),
            of_modules: whole.of_modules.iter().map(of_module).collect(),
            pins: PinRows {
                places: whole.pins.places.clone(),
                stiffness: pins.means(&whole.pins.stiffness, &modes),
                mass: pins.means(&whole.pins.mass, &modes),
                connectors: pins.means_among(&whole.pins.connectors, &link_rows),
                water: pins.means(&whole.pins.water, &modes),
            },
            waves: whole.waves.as_ref().map(|waves| waves.of_side(&modes)),
            deck: self.side_deck(&modes, [&link_rows, &observed, &inside, &pins]),
            r_deck: self.side_residual(),
            near: whole.near,
            track: whole.track.clone(),
            breadth_m: whole.breadth_m,
        };
        Some(SideBridge {
            operator,
            links: links.clone(),
        })
    }

    /// Whether links answer links as their images do.
    fn answers_alike(&self) -> bool {
        let (whole, links) = (self.whole, self.links);
        let image = |link: usize| {
            let [a, b] = links.images[links.of_link[link]];
            if a == link { b } else { a }
        };
        let n = self.whole.sizes.connectors;
        let off = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let off = off.map(|(i, j)| (whole.r_bb[(i, j)] - whole.r_bb[(image(i), image(j))]).abs());
        off.fold(0.0, f64::max) <= OTHER_FLEXIBILITY * whole.r_bb.amax()
    }

    /// The modes that are their own images; none where one is neither that nor its opposite.
    fn own_images(&self, links: &Rows, observed: &Rows, inside: &Rows) -> Option<Vec<usize>> {
        let (m, stations, width) = (
            self.whole.sizes.modes,
            self.whole.track.stations(),
            self.whole.sizes.influence(),
        );
        // squares of what keeps its sign in the mirror and of what changes it
        let mut parities = vec![[0.0_f64; 2]; m];
        for (rows, of) in [
            (links, &self.whole.b),
            (observed, &self.whole.v),
            (inside, &self.whole.inside),
        ] {
            for &[a, b] in &rows.images {
                for (k, [same, other]) in parities.iter_mut().enumerate() {
                    *same += (of[(a, k)] + of[(b, k)]).powi(2);
                    *other += (of[(a, k)] - of[(b, k)]).powi(2);
                }
            }
        }
        for column in 0..self.whole.track.columns() {
            let of_image = self.image_of_column(column, stations) * width;
            let pairs = self.whole.deck[column * width..][..m]
                .iter()
                .zip(&self.whole.deck[of_image..][..m]);
            for ((a, b), [same, other]) in pairs.zip(&mut parities) {
                *same += (a + b).powi(2);
                *other += (a - b).powi(2);
            }
        }
        let most = parities.iter().map(|[same, other]| same + other).fold(0.0, f64::max);
        let mut own = Vec::new();
        for (k, [same, other]) in parities.into_iter().enumerate() {
            if same + other <= STILL * most || same <= OTHER_PARITY * other {
                continue;
            }
            if other > OTHER_PARITY * same {
                return None;
            }
            own.push(k);
        }
        Some(own)
    }

    /// The column of the deck that mirrors one.
    fn image_of_column(&self, column: usize, stations: usize) -> usize {
        (self.whole.track.lines() - 1 - column / stations) * stations + column % stations
    }

    /// The deck's influences, each the mean over a column and its image.
    fn side_deck(&self, modes: &[usize], rows: [&Rows; 4]) -> Vec<f64> {
        let (sizes, stations) = (&self.whole.sizes, self.whole.track.stations());
        let width = sizes.influence();
        let mut deck = Vec::new();
        for column in 0..self.whole.track.columns() {
            let [own, other] =
                [column, self.image_of_column(column, stations)].map(|c| &self.whole.deck[c * width..][..width]);
            deck.extend(modes.iter().map(|&k| 0.5 * (own[k] + other[k])));
            let mut first = self.whole.sizes.modes;
            for (rows, count) in rows
                .into_iter()
                .zip([sizes.connectors, sizes.observed, sizes.inside, sizes.pins])
            {
                let of_row = |&[a, b]: &[usize; 2]| {
                    let [a, b] = [first + a, first + b];
                    0.25 * ((own[a] + own[b]) + (other[a] + other[b]))
                };
                deck.extend(rows.images.iter().map(of_row));
                first += count;
            }
        }
        deck
    }

    /// The residual among the deck's nodes, each the mean over two columns and their images.
    fn side_residual(&self) -> Vec<f64> {
        let (lines, stations, width) = (
            self.whole.track.lines(),
            self.whole.track.stations(),
            2 * self.whole.near + 1,
        );
        let mut of_side = Vec::with_capacity(self.whole.r_deck.len());
        let of = |column: usize, line: usize| &self.whole.r_deck[(column * lines + line) * width..][..width];
        for column in 0..self.whole.track.columns() {
            let image = self.image_of_column(column, stations);
            for line in 0..lines {
                let other = lines - 1 - line;
                let parts = [of(column, line), of(column, other), of(image, line), of(image, other)];
                of_side.extend((0..width).map(|i| 0.25 * ((parts[0][i] + parts[1][i]) + (parts[2][i] + parts[3][i]))));
            }
        }
        of_side
    }
}
