//! An operator as plain numbers, for keeping.
//!
//! Knows the order of its parts. Does not know files.

use super::basis::{BridgeOperator, Observed, Sizes};
use super::cutoff::Cutoff;
use crate::bridge::{Bridge, Track};
use nalgebra::DMatrix;

/// What the numbers of an operator, or of anything else that this crate computes, belong to: a hash of the crate's sources.
pub const SOURCES: &str = env!("PONTOON_CORE_SOURCES");

/// Numbers of an operator in a fixed order: counts, then reals.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatorParts {
    /// Counts.
    pub counts: Vec<u64>,
    /// Reals.
    pub numbers: Vec<f64>,
}

/// Takes numbers off the front.
struct Reader<'a>(&'a [f64]);

impl Reader<'_> {
    fn list(&mut self, n: usize) -> Option<Vec<f64>> {
        let (own, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(own.to_vec())
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> Option<DMatrix<f64>> {
        Some(DMatrix::from_vec(rows, columns, self.list(rows * columns)?))
    }
}

impl BridgeOperator {
    /// Its numbers.
    pub fn parts(&self) -> OperatorParts {
        let (s, r) = (&self.sizes, &self.rows);
        let counts = [
            s.modes,
            s.connectors,
            s.observed,
            s.inside,
            s.modules,
            r.positions,
            r.corners,
            r.bottom_corners,
            self.near,
        ];
        let cutoff = [
            self.cutoff.frequency_hz,
            self.cutoff.tolerance,
            self.cutoff.error,
            self.breadth_m,
        ];
        let lists: [&[f64]; 11] = [
            &cutoff,
            &self.omega2,
            self.b.as_slice(),
            self.r_bb.as_slice(),
            self.v.as_slice(),
            self.r_vb.as_slice(),
            self.inside.as_slice(),
            self.r_inside_b.as_slice(),
            &self.places,
            &self.deck,
            &self.r_deck,
        ];
        let bounds = self.inside_bounds.iter().flatten().copied();
        OperatorParts {
            counts: counts.map(|n| n as u64).to_vec(),
            numbers: lists.concat().into_iter().chain(bounds).collect(),
        }
    }

    /// The operator of `bridge` from its numbers; none where they do not fit the bridge.
    pub fn from_parts(bridge: &Bridge, parts: &OperatorParts) -> Option<Self> {
        let counts: Vec<usize> = parts
            .counts
            .iter()
            .map(|&n| usize::try_from(n).ok())
            .collect::<Option<_>>()?;
        let &[
            modes,
            connectors,
            observed,
            inside,
            modules,
            positions,
            corners,
            bottom_corners,
            near,
        ] = &counts[..]
        else {
            return None;
        };
        let (track, design) = (Track::new(bridge), bridge.design());
        let sizes = Sizes {
            modes,
            connectors,
            observed,
            inside,
            modules,
        };
        let fits = modules == design.modules
            && connectors == bridge.connectors.len()
            && positions == bridge.positions.len()
            && corners == bridge.deck_corners.len()
            && observed == positions + corners + bottom_corners
            && near == track.stations() / modules
            && modes <= bridge.dofs();
        if !fits {
            return None;
        }
        let mut r = Reader(&parts.numbers);
        let nodes = track.lines() * track.stations();
        let &[frequency_hz, tolerance, error, breadth_m] = &r.list(4)?[..] else {
            return None;
        };
        let operator = Self {
            sizes,
            rows: Observed {
                positions,
                corners,
                bottom_corners,
            },
            cutoff: Cutoff {
                modes,
                frequency_hz,
                tolerance,
                error,
            },
            omega2: r.list(modes)?,
            b: r.matrix(connectors, modes)?,
            r_bb: r.matrix(connectors, connectors)?,
            v: r.matrix(observed, modes)?,
            r_vb: r.matrix(observed, connectors)?,
            inside: r.matrix(inside * modules, modes)?,
            r_inside_b: r.matrix(inside * modules, connectors)?,
            places: r.list(inside / 2)?,
            deck: r.list(nodes * sizes.reach())?,
            r_deck: r.list(nodes * track.lines() * (2 * near + 1))?,
            inside_bounds: r.list(3 * modules)?.as_chunks().0.to_vec(),
            near,
            track,
            breadth_m,
        };
        r.0.is_empty().then_some(operator)
    }
}
