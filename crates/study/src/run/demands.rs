//! What a crossing asks of limits: largest demand, place and time of each.
//!
//! Knows which number of a response a limit bounds. Does not know how a crossing is solved.

use pontoon_core::response::{CrossingResponse, DeadState, PlacedPeak, Record};
use pontoon_plan::study_file::{Allowed, Limit};
use pontoon_results::{ConnectorRow, Extreme, LimitRow, PinRow, PositionRow, SectionRow};

/// What is known of a crossing.
pub(super) struct Demands<'a> {
    pub(super) positions: &'a [PositionRow],
    pub(super) connectors: &'a [ConnectorRow],
    pub(super) pins: &'a [PinRow],
    pub(super) sections: &'a [SectionRow],
    pub(super) response: &'a CrossingResponse,
    pub(super) dead: Option<&'a DeadState>,
}

/// Adds what limits need to what is recorded.
pub(super) fn record_for(limits: &[Allowed], record: &mut Record) {
    let has = |limit: Limit| limits.iter().any(|of| of.limit == limit);
    record.pins |= has(Limit::PinForce);
    record.sections |= has(Limit::JointAngle);
}

impl Demands<'_> {
    /// The rows of the table of limits.
    pub(super) fn limit_rows(&self, limits: &[Allowed]) -> Vec<LimitRow> {
        limits.iter().map(|of| self.row(of)).collect()
    }

    fn row(&self, of: &Allowed) -> LimitRow {
        let (place, found) = self.demand(of.limit);
        // all masses stand before their demand is told: one sinkage is added to the other
        let beside = of.beside
            + if of.limit == Limit::EdgeSinkage {
                self.sunk_m()
            } else {
                0.0
            };
        let demand = Extreme {
            value: found.value.map(|value| value + beside),
            ..found
        };
        LimitRow {
            limit: of.limit.word().to_owned(),
            demand,
            allowed: of.allowed,
            utilisation: demand.value.map(|value| of.utilisation(value)),
            place,
        }
    }

    /// How far the lowest corner of a deck has sunk at rest `[m]`; 0 of a bridge without a dead load.
    fn sunk_m(&self) -> f64 {
        let corners = self.dead.iter().flat_map(|dead| &dead.deck_corners_m);
        corners.fold(0.0, |most: f64, risen_m| most.max(-risen_m))
    }

    fn demand(&self, limit: Limit) -> (Option<usize>, Extreme) {
        let sums = || self.connectors.iter().filter(|row| row.y_m.is_none());
        let singles = || self.connectors.iter().filter(|row| row.y_m.is_some());
        let at = |peak: PlacedPeak| (Some(peak.at).filter(|at| *at > 0), Extreme::at(peak.value, peak.time_s));
        match limit {
            Limit::EdgeSinkage => at(self.response.peak_edge),
            Limit::Roll => at(self.response.peak_roll),
            Limit::Trim => at(self.response.peak_trim),
            Limit::Uplift => largest(self.positions.iter().map(|row| (row.position, row.uplift))),
            Limit::JointCompression => largest(sums().map(|row| (row.joint, row.compression))),
            Limit::JointTension => largest(sums().map(|row| (row.joint, row.tension))),
            Limit::ConnectorCompression => largest(singles().map(|row| (row.joint, row.compression))),
            Limit::ConnectorTension => largest(singles().map(|row| (row.joint, row.tension))),
            Limit::PinForce => {
                let each = self.pins.iter().filter(|row| row.y_m.is_some());
                largest(each.map(|row| (row.joint, row.resultant)))
            }
            Limit::JointAngle => {
                let angles = self.sections.iter().filter(|row| row.quantity == "angle_rad");
                largest(angles.flat_map(|row| row.sides.map(|side| (row.joint, side))))
            }
            Limit::AxleContact => {
                let least = self.response.least_contact;
                let force = Extreme {
                    value: Some(least.force_n).filter(|force| force.is_finite()),
                    time_s: Some(least.time_s).filter(|_| least.axle.is_some()),
                };
                (least.axle.map(|of| of.axle), force)
            }
        }
    }
}

/// The largest of some values, the first of equals, and its place; no place where it is zero.
fn largest(rows: impl Iterator<Item = (usize, Extreme)>) -> (Option<usize>, Extreme) {
    let none = Extreme {
        value: Some(0.0),
        time_s: None,
    };
    rows.fold((None, none), |most, (place, found)| {
        if found.value > most.1.value {
            (Some(place), found)
        } else {
            most
        }
    })
}
