//! An operator's numbers in their order, and the operator of a bridge from them.
//!
//! Knows which list is followed by which. Does not know files.

use super::basis::{BridgeOperator, Observed, Sizes, operated_modules};
use super::cutoff::Cutoff;
use super::persist::NumberReader;
use super::pin_rows::{PinRows, pin_places};
use super::waves::OperatorWaves;
use crate::bridge::{Bridge, Track};

/// Numbers of an operator in a fixed order: counts, then reals.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatorParts {
    /// Counts.
    pub counts: Vec<u64>,
    /// Reals.
    pub numbers: Vec<f64>,
}

impl OperatorParts {
    /// Those of an operator.
    pub fn of(of: &BridgeOperator) -> Self {
        let (s, r) = (&of.sizes, &of.rows);
        let counts = [
            s.modes,
            s.connectors,
            s.observed,
            s.inside,
            s.modules,
            r.positions,
            r.corners,
            r.bottom_corners,
            of.near,
            s.pins,
            r.places,
            r.springs,
        ];
        let cutoff = [
            of.cutoff.frequency_hz,
            of.cutoff.tolerance,
            of.cutoff.error,
            of.breadth_m,
        ];
        let lists: [&[f64]; 15] = [
            &cutoff,
            &of.omega2,
            &of.omega2_water,
            of.b.as_slice(),
            of.r_bb.as_slice(),
            of.v.as_slice(),
            of.r_vb.as_slice(),
            of.inside.as_slice(),
            of.r_inside_b.as_slice(),
            &of.deck,
            &of.r_deck,
            of.pins.stiffness.as_slice(),
            of.pins.mass.as_slice(),
            of.pins.connectors.as_slice(),
            of.pins.water.as_slice(),
        ];
        let bounds = of.inside_bounds.iter().flatten().copied();
        let waves = || of.waves.iter();
        Self {
            counts: counts
                .iter()
                .map(|&n| n as u64)
                .chain(waves().flat_map(OperatorWaves::counts))
                .collect(),
            numbers: (lists.concat().into_iter().chain(bounds))
                .chain(waves().flat_map(OperatorWaves::numbers))
                .collect(),
        }
    }

    /// The operator of `bridge` from its numbers; none where they do not fit the bridge.
    pub fn operator(&self, bridge: &Bridge) -> Option<BridgeOperator> {
        let parts = self;
        let (mut sizes, rows, near, of_waves) = counts(parts)?;
        sizes.joint_connectors = bridge.joint_connectors;
        let track = Track::new(bridge);
        let of_modules = operated_modules(bridge);
        let inside = of_modules.last().map_or(0, |module| module.inside.end);
        if !fits(bridge, &sizes, &rows) || near != track.most_stations() || sizes.inside != inside {
            return None;
        }
        let Sizes {
            modes,
            connectors,
            observed,
            ..
        } = sizes;
        let nodes = track.lines() * track.stations();
        let mut r = NumberReader::new(&parts.numbers);
        let &[frequency_hz, tolerance, error, breadth_m] = &r.list(4)?[..] else {
            return None;
        };
        let operator = BridgeOperator {
            sizes,
            rows,
            cutoff: Cutoff {
                modes,
                frequency_hz,
                tolerance,
                error,
            },
            omega2: r.list(modes)?,
            omega2_water: r.list(modes)?,
            b: r.matrix(connectors, modes)?,
            r_bb: r.matrix(connectors, connectors)?,
            v: r.matrix(observed, modes)?,
            r_vb: r.matrix(observed, connectors)?,
            inside: r.matrix(inside, modes)?,
            r_inside_b: r.matrix(inside, connectors)?,
            of_modules,
            deck: r.list(nodes * sizes.influence())?,
            r_deck: r.list(nodes * track.lines() * (2 * near + 1))?,
            pins: PinRows {
                places: if sizes.pins == 0 {
                    Vec::new()
                } else {
                    pin_places(bridge)
                },
                stiffness: r.matrix(sizes.pins, modes)?,
                mass: r.matrix(sizes.pins, modes)?,
                connectors: r.matrix(sizes.pins, connectors)?,
                water: r.matrix(sizes.pins, modes)?,
            },
            inside_bounds: r.list(3 * sizes.modules)?.as_chunks().0.to_vec(),
            waves: match &bridge.waves {
                Some(_) => Some(OperatorWaves::read(&of_waves, [modes, sizes.pins], &mut r)?),
                None => None,
            },
            near,
            track,
            breadth_m,
        };
        r.is_empty().then_some(operator)
    }
}

/// The counts of an operator's numbers, and how many stations are near.
fn counts(parts: &OperatorParts) -> Option<(Sizes, Observed, usize, Vec<usize>)> {
    let counts = parts.counts.iter().map(|&n| usize::try_from(n).ok());
    let counts: Vec<usize> = counts.collect::<Option<_>>()?;
    let (own, of_waves) = counts.split_at_checked(12)?;
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
        pins,
        places,
        springs,
    ] = own
    else {
        return None;
    };
    let sizes = Sizes {
        modes,
        connectors,
        joint_connectors: connectors,
        observed,
        inside,
        modules,
        pins,
    };
    let rows = Observed {
        positions,
        edges: 2,
        corners,
        bottom_corners,
        places,
        springs,
    };
    Some((sizes, rows, near, of_waves.to_vec()))
}

/// Whether counts are those of a bridge.
fn fits(bridge: &Bridge, sizes: &Sizes, rows: &Observed) -> bool {
    sizes.modules == bridge.design().modules
        && sizes.connectors == bridge.links.len()
        && rows.positions == bridge.positions.len()
        && rows.corners == bridge.deck_corners.len()
        && sizes.observed == rows.positions + rows.corners + rows.bottom_corners + rows.places + rows.springs
        && sizes.modes <= bridge.dofs()
        && (sizes.pins == 0 || sizes.pins == 3 * bridge.pins.len())
}
