//! What is read of every lane after a step: peaks with their times; roll, trim and edges with their places.
//!
//! Knows the observed rows. Does not know how the motion came about.

use super::basis::{BridgeOperator, Observed};
use super::connectors::Connectors;
use super::corners::{CornerView, Corners, ROUNDING_M};
use super::energy::Energy;
use super::lane::Lane;
use super::lane_array::LaneArray;
use super::lane_group::LaneGroups;
use super::modes::Modes;
use super::panel::{MOST_LANES, lanes_mut};
use super::placed::Placed;
use super::residual::Residual;
use super::step_constants::StepConstants;
use super::vector::Ops;
use super::wheel_lines::DeckNode;
use crate::response::{EnergySummary, ForcePeaks, JointPeaks, Peak};
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Running extremes of every lane.
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    rows: Observed,
    per_joint: usize,
    joint_connectors: usize,
    /// Largest values, downward and upward of each position, then pushing and pulling of each joint's sum and each
    /// connector; and when.
    value: LaneArray,
    time: LaneArray,
    /// Time of the step `[s]`.
    now: LaneArray,
    /// Corners of decks and bottoms.
    pub(super) corners: Corners,
    /// When and where edges, roll and trim were largest and an axle's force was smallest, in each lane.
    pub(super) placed: Vec<Placed>,
    /// `[q; s]`, observed rows, edges inside one module, now; corners as they were looked at last.
    motion: LaneArray,
    observed: LaneArray,
    inside: LaneArray,
    /// How far the edges inside each module may be off the straight line between its corners `[m]`.
    off: LaneArray,
    /// Downward forces on the deck, added without their signs `[N]`.
    load: LaneArray,
}

impl Envelope {
    pub(super) fn new(operator: &BridgeOperator, lanes: usize) -> Self {
        let of = |rows: usize| LaneArray::new(rows, lanes);
        let (rows, sizes) = (operator.rows, &operator.sizes);
        let (joints, modules) = (sizes.modules - 1, &operator.of_modules);
        let peaks = 2 * (rows.positions + joints + sizes.joint_connectors);
        Self {
            rows,
            per_joint: sizes.joint_connectors.checked_div(joints).unwrap_or(0),
            joint_connectors: sizes.joint_connectors,
            value: of(peaks),
            time: of(peaks),
            now: of(1),
            corners: Corners::new(operator, lanes),
            placed: vec![Placed::default(); lanes],
            motion: of(sizes.modes + sizes.connectors),
            observed: of(sizes.observed),
            inside: of(modules.iter().map(|module| module.inside.len()).max().unwrap_or(0)),
            off: of(sizes.modules),
            load: of(1),
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> impl Iterator<Item = &mut LaneArray> {
        [&mut self.value, &mut self.time]
            .into_iter()
            .chain(self.corners.carried())
    }

    /// Number of rows that were read in the step.
    pub(super) fn rows_read(&self) -> usize {
        let Observed {
            positions,
            corners,
            bottom_corners,
            places,
            springs,
            ..
        } = self.rows;
        let of_module = (corners + bottom_corners) / self.modules();
        positions + places + springs + of_module * self.corners.now.len()
    }

    /// Number of modules.
    pub(super) fn modules(&self) -> usize {
        self.off.rows()
    }

    /// Deflection of a position now, positive downward `[m]`.
    pub(super) fn position_m(&self, index: usize, lane: usize) -> f64 {
        // nothing is 0, not -0
        0.0 - self.observed.at(index, lane)
    }

    /// Deflection of a place now, positive downward `[m]`.
    pub(super) fn place_m(&self, index: usize, lane: usize) -> f64 {
        let first = self.observed.rows() - self.rows.springs - self.rows.places;
        0.0 - self.observed.at(first + index, lane)
    }

    /// Deflection of a corner of a module's deck now, positive downward `[m]`.
    pub(super) fn corner_m(&self, index: usize, lane: usize) -> f64 {
        0.0 - self
            .observed
            .at(self.rows.positions + index * self.rows.edges / 2, lane)
    }

    /// Motion of a spring of a bank now, along its sense `[m]`.
    pub(super) fn spring_m(&self, index: usize, lane: usize) -> f64 {
        self.observed.at(self.observed.rows() - self.rows.springs + index, lane)
    }

    /// Reads the rows after a step.
    #[inline(always)]
    pub(super) fn update<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        constants: &StepConstants,
        (modes, residual, connectors, energy): (&Modes, &Residual, &Connectors, &Energy),
        (groups, lanes): (&LaneGroups, &[Lane]),
    ) {
        self.now.write_row(lanes.iter().map(|lane| lane.time_s));
        self.motion.join([&modes.q, &residual.followed_force.x]);
        self.read_followed(o, constants, (residual, connectors.count()));
        self.update_peaks(o, connectors);
        let before = self.corners.largest::<S>();
        let view = CornerView {
            panels: &constants.panels.corners,
            motion: &self.motion,
            residual,
            links: connectors.count(),
            all: lanes.iter().any(Lane::asks_for_corners),
        };
        self.corners.advance(o, energy.moved.vectors::<S>()[0], &view);
        bound_edges(o, operator, energy, (groups, lanes), [&mut self.off, &mut self.load]);
        self.corners.look(o, &view, &self.off, &mut self.observed);
        self.corners
            .note(o, before, (&mut self.placed, &self.now), &self.observed);
        for i in 0..self.corners.now.len() {
            let module = self.corners.now[i];
            self.update_edges(o, operator, constants, (groups, lanes), module);
        }
    }

    /// Reads the rows that are looked at in every step: positions, places and springs of banks.
    #[inline(always)]
    fn read_followed<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants, (residual, links): (&Residual, usize)) {
        let (observed, motion) = (self.observed.vectors_mut::<S>(), self.motion.vectors::<S>());
        let beside = &residual.load_residual.x.vectors::<S>()[links..];
        let last = observed.len() - self.rows.springs - self.rows.places;
        for (first, panel) in [(0, &constants.panels.positions), (last, &constants.panels.beside)] {
            let rows = &mut observed[first..][..panel.rows()];
            panel.multiply(o, motion, rows);
            for (z, r) in rows.iter_mut().zip(&beside[first..]) {
                *z = o.add(*z, *r);
            }
        }
    }

    /// Peaks of positions, joints and connectors.
    #[inline(always)]
    fn update_peaks<S: Simd>(&mut self, o: Ops<S>, connectors: &Connectors) {
        let mut peaks = Peaks::<S> {
            o,
            now: self.now.vectors::<S>()[0],
            value: self.value.vectors_mut::<S>(),
            time: self.time.vectors_mut::<S>(),
            row: 0,
        };
        for &z in &self.observed.vectors::<S>()[..self.rows.positions] {
            peaks.update_both(z);
        }
        let forces = &connectors.by_law().vectors::<S>()[..self.joint_connectors];
        let per_joint = self.per_joint.max(1);
        if connectors.any_rest {
            let rest = &connectors.rest.vectors::<S>()[..self.joint_connectors];
            for (joint, rest) in forces.chunks_exact(per_joint).zip(rest.chunks_exact(per_joint)) {
                let mut sum = o.splat(0.0);
                for i in 0..joint.len() {
                    sum = o.add(sum, o.add(joint[i], rest[i]));
                }
                peaks.update_both(sum);
                for i in 0..joint.len() {
                    peaks.update_both(o.add(joint[i], rest[i]));
                }
            }
            return;
        }
        let joints = forces.chunks_exact(per_joint).enumerate();
        // without any force none is larger than before
        let mut active = connectors.active().iter().peekable();
        for (number, joint) in joints {
            let mut is_active = connectors.dashpots.any;
            while active.next_if(|link| **link < per_joint * (number + 1)).is_some() {
                is_active = true;
            }
            if !is_active {
                peaks.row += 2 * (1 + per_joint);
                continue;
            }
            let mut sum = o.splat(0.0);
            for &force in joint {
                sum = o.add(sum, force);
            }
            peaks.update_both(sum);
            for &force in joint {
                peaks.update_both(force);
            }
        }
    }

    /// Edges inside a module whose corners were looked at, in the lanes where one may be lower than any edge before.
    #[inline(always)]
    fn update_edges<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        constants: &StepConstants,
        (groups, each): (&LaneGroups, &[Lane]),
        module: usize,
    ) {
        let down = self.corners.most_down(o, module, &constants.panels.corners[module]);
        let lowest = o.add(down, self.off.vectors::<S>()[module]);
        let edge = self.corners.edge.vectors::<S>()[0];
        if o.0.first_true_m64s(o.0.greater_than_f64s(lowest, edge)) >= S::F64_LANES {
            return;
        }
        let of_module = &operator.of_modules[module];
        let rows = of_module.inside.len();
        let inside = &mut self.inside.vectors_mut::<S>()[..rows];
        constants.panels.inside[module].multiply(o, self.motion.vectors::<S>(), inside);
        // with modes and links known, the load may add what its largest influence says
        let of_load = o.mul(o.splat(operator.inside_bounds[module][2]), self.load.vectors::<S>()[0]);
        let edges = self.rows.edges;
        let corners = &self.observed.vectors::<S>()[self.rows.positions + 2 * edges * module..][..2 * edges];
        let mut lowest = o.splat(f64::NEG_INFINITY);
        for (i, off) in inside.iter().enumerate() {
            let (place, side) = (o.splat(of_module.places[i / edges]), i % edges);
            let straight = o.fma(place, o.sub(corners[edges + side], corners[side]), corners[side]);
            lowest = o.max(lowest, o.sub(of_load, o.add(straight, *off)));
        }
        let lowest = o.add(lowest, o.splat(ROUNDING_M));
        let mut lowests = [0.0; MOST_LANES];
        lanes_mut::<S>(&mut lowests)[0] = lowest;
        for (lane, of) in each.iter().enumerate() {
            if lowests[lane] > self.corners.edge.at(0, lane) {
                self.update_edge(operator, module, lane, (groups, of));
            }
        }
    }

    /// Stations of the edges of one module in one lane.
    #[inline(always)]
    fn update_edge(
        &mut self,
        operator: &BridgeOperator,
        module: usize,
        lane: usize,
        (groups, of): (&LaneGroups, &Lane),
    ) {
        let (Some(crossing), sizes) = (&of.crossing, &operator.sizes) else {
            return;
        };
        let edges = self.rows.edges;
        let corner = |i: usize| self.observed.at(self.rows.positions + 2 * edges * module + i, lane);
        let of_module = &operator.of_modules[module];
        let first = sizes.followed() + of_module.inside.start;
        let (wheels, group) = (&crossing.wheels, &groups.all()[of.group]);
        for i in 0..of_module.inside.len() {
            let (place, side) = (of_module.places[i / edges], i % edges);
            let straight = (1.0 - place) * corner(side) + place * corner(edges + side);
            let mut z = straight + self.inside.at(i, lane);
            for weight in &group.weights {
                let force = weight.share * group.load_in(weight.vehicle, lane);
                let influence = &wheels.weights[weight.line].influence;
                z -= force * influence[weight.station * wheels.influence_width + first + i];
            }
            for &(line, station, force) in &of.rider_forces {
                z -= force * wheels.influence(DeckNode { line, station })[first + i];
            }
            let edge = self.corners.edge.at_mut(0, lane);
            *edge = edge.max(-z);
            self.placed[lane].edge.take(-z, of.time_s, of_module.nearer[i / edges]);
        }
    }

    /// What a lane's crossing leaves behind, peaks in the order of positions and joints.
    pub(super) fn peaks(&self, lane: usize, energy: EnergySummary) -> LanePeaks {
        let at = |row: usize| Peak {
            value: self.value.at(row, lane),
            time_s: self.time.at(row, lane),
        };
        let forces = |row: usize| ForcePeaks {
            compression: at(row),
            tension: at(row + 1),
        };
        let [corner_m, bottom_m] = self.corners.beyond_least_m(lane);
        LanePeaks {
            positions: (0..self.rows.positions).map(|i| [at(2 * i), at(2 * i + 1)]).collect(),
            forces: (self.rows.positions..self.value.rows() / 2)
                .map(|i| forces(2 * i))
                .collect(),
            corner_m,
            bottom_m,
            placed: self.placed[lane],
            energy,
        }
    }
}

/// How far the edges inside each module may be off the straight line between its corners, by no more than Cauchy and Schwarz
/// allow: `(row u)^2 <= (sum of phi^2 / omega^2) (sum of omega^2 q^2)` for the modes, R and s in their place for what the
/// connectors add, the load times its largest influence for the rest, which follows the load at once.
#[inline(always)]
fn bound_edges<S: Simd>(
    o: Ops<S>,
    operator: &BridgeOperator,
    energy: &Energy,
    (groups, each): (&LaneGroups, &[Lane]),
    [off, load]: [&mut LaneArray; 2],
) {
    let riding = |of: &Lane| of.rider_forces.iter().map(|(.., force)| force.abs()).sum();
    load.write_row(each.iter().map(riding));
    for group in groups.all() {
        let Some(crossing) = &each[group.base + group.first()].crossing else {
            continue;
        };
        for forces in group.weights.chunk_by(|a, b| a.vehicle == b.vehicle) {
            let mut share = 0.0;
            for of in forces {
                // a line of the weights stands for all lines with the same points
                share += crossing.wheels.weights[of.line].lines.len() as f64 * of.share;
            }
            for lane in group.numbers() {
                *load.at_mut(0, lane) += share * group.load_in(forces[0].vehicle, lane);
            }
        }
    }
    let modal = o.0.sqrt_f64s(energy.modal_strain.vectors::<S>()[0]);
    let residual = energy.residual_strain.vectors::<S>()[0];
    let residual = o.0.sqrt_f64s(o.max(residual, o.splat(0.0)));
    let load = load.vectors::<S>()[0];
    for (off, bound) in off.vectors_mut::<S>().iter_mut().zip(&operator.inside_bounds) {
        let [of_modes, of_residual, of_load] = [o.splat(bound[0]), o.splat(bound[1]), o.splat(bound[2])];
        *off = o.fma(of_modes, modal, o.fma(of_residual, residual, o.mul(of_load, load)));
    }
}

/// Peaks of all rows, to be raised one after the other.
struct Peaks<'a, S: Simd> {
    o: Ops<S>,
    now: S::f64s,
    value: &'a mut [S::f64s],
    time: &'a mut [S::f64s],
    row: usize,
}

impl<S: Simd> Peaks<'_, S> {
    /// Takes the next row's value where it is larger than all before.
    #[inline(always)]
    fn update_max(&mut self, value: S::f64s) {
        let (best, time) = (&mut self.value[self.row], &mut self.time[self.row]);
        let larger = self.o.0.greater_than_f64s(value, *best);
        *best = self.o.0.select_f64s(larger, value, *best);
        *time = self.o.0.select_f64s(larger, self.now, *time);
        self.row += 1;
    }

    /// The next two rows: one for the value's other sense, one for its own.
    #[inline(always)]
    fn update_both(&mut self, value: S::f64s) {
        self.update_max(self.o.neg(value));
        self.update_max(value);
    }
}

/// What a lane's crossing leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LanePeaks {
    /// Downward and upward of each position `[m]`.
    pub positions: Vec<[Peak; 2]>,
    /// Of each joint the sum, then each connector `[N]`.
    pub forces: Vec<ForcePeaks>,
    /// Largest downward deflection of the deck's corners alone, less what a module's freeboard is above the least `[m]`.
    pub corner_m: f64,
    /// Largest height of a bottom corner, less what a module's draft is above the least `[m]`; 0 where none is followed.
    pub bottom_m: f64,
    /// Edges, roll, trim and contact force with time and place.
    pub placed: Placed,
    /// The energy balance.
    pub energy: EnergySummary,
}

impl LanePeaks {
    /// Peaks of the joints 2 to modules with their connectors at `y_m`.
    pub(crate) fn joints(&self, y_m: &[f64]) -> Vec<JointPeaks> {
        (2..)
            .zip(self.forces.chunks_exact(1 + y_m.len()))
            .map(|(joint, forces)| JointPeaks {
                joint,
                sum: forces[0],
                connectors: y_m.iter().copied().zip(forces[1..].iter().copied()).collect(),
            })
            .collect()
    }
}
