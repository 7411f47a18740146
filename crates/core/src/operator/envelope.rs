//! What is read of every lane after a step: peaks with their times; roll, trim and edges with their places.
//!
//! Knows the observed rows. Does not know how the motion came about.

use super::basis::{BridgeOperator, Observed, OperatedModule};
use super::connectors::Connectors;
use super::energy::Energy;
use super::lane::Lane;
use super::lane_array::LaneArray;
use super::lane_group::{LaneGroups, UnitForce};
use super::modes::Modes;
use super::panel::{MOST_LANES, lanes, lanes_mut};
use super::placed::Placed;
use super::residual::Residual;
use super::step_constants::StepConstants;
use super::vector::Ops;
use super::wheel_lines::DeckNode;
use crate::response::{DeadState, EnergySummary, ForcePeaks, JointPeaks, Peak};
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
    /// Largest downward deflection of corners and edges, height of bottom corners, roll; largest corner deflection.
    edge: LaneArray,
    corner: LaneArray,
    bottom: LaneArray,
    roll: LaneArray,
    /// Largest trim of a module.
    trim: LaneArray,
    /// When and where edges, roll and trim were largest and an axle's force was smallest, in each lane.
    pub(super) placed: Vec<Placed>,
    /// Largest deflection of each module's corners now.
    of_module: LaneArray,
    /// `[q; s]`, observed rows, edges inside one module, now.
    motion: LaneArray,
    observed: LaneArray,
    inside: LaneArray,
    breadth_m: f64,
    /// How far the corners of decks, then of bottoms, have risen against the water at rest `[m]`, and in which lanes they have.
    risen: LaneArray,
    from_rest: Vec<bool>,
    /// Of each module how much its freeboard and its draft are above the least `[m]`.
    beyond_m: Vec<[f64; 2]>,
    /// Half of one over the length of each module `[1/m]`.
    half_per_m: Vec<f64>,
    /// Corners of one lane.
    of_lane: Vec<f64>,
}

impl Envelope {
    pub(super) fn new(operator: &BridgeOperator, lanes: usize) -> Self {
        let of = |rows: usize| LaneArray::new(rows, lanes);
        let (rows, sizes) = (operator.rows, &operator.sizes);
        let (joints, modules) = (sizes.modules - 1, &operator.of_modules);
        let beyond_m = |module: &OperatedModule| [module.freeboard_beyond_m, module.draft_beyond_m];
        let peaks = 2 * (rows.positions + joints + sizes.joint_connectors);
        Self {
            rows,
            per_joint: sizes.joint_connectors.checked_div(joints).unwrap_or(0),
            joint_connectors: sizes.joint_connectors,
            value: of(peaks),
            time: of(peaks),
            now: of(1),
            edge: of(1),
            corner: of(1),
            bottom: of(1),
            roll: of(1),
            trim: of(1),
            placed: vec![Placed::default(); lanes],
            of_module: of(sizes.modules),
            motion: of(sizes.modes + sizes.connectors),
            observed: of(sizes.observed),
            inside: of(modules.iter().map(|module| module.inside.len()).max().unwrap_or(0)),
            breadth_m: operator.breadth_m,
            risen: of(rows.corners + rows.bottom_corners),
            from_rest: vec![false; lanes],
            beyond_m: modules.iter().map(beyond_m).collect(),
            half_per_m: modules.iter().map(|module| 0.5 / module.length_m).collect(),
            of_lane: vec![0.0; 2 / rows.edges * rows.corners],
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 7] {
        [
            &mut self.value,
            &mut self.time,
            &mut self.edge,
            &mut self.corner,
            &mut self.bottom,
            &mut self.roll,
            &mut self.trim,
        ]
    }

    /// Takes how a lane's bridge floats at rest.
    pub(super) fn take_rest(&mut self, lane: usize, dead: Option<&DeadState>) {
        self.from_rest[lane] = dead.is_some();
        self.risen.clear(lane);
        if let Some(dead) = dead {
            let corners = dead.deck_corners_m.iter().take(self.rows.corners);
            let corners = corners.chain(dead.bottom_corners_m.iter().take(self.rows.bottom_corners));
            self.risen.lane_mut(lane).zip(corners).for_each(|(to, z)| *to = *z);
        }
    }

    /// Number of observed rows.
    pub(super) fn observed_rows(&self) -> usize {
        self.observed.rows()
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
        let observed = self.observed.vectors_mut::<S>();
        constants.panels.v.multiply(o, self.motion.vectors::<S>(), observed);
        let beside = &residual.load_residual.x.vectors::<S>()[connectors.count()..];
        for (z, r) in observed.iter_mut().zip(beside) {
            *z = o.add(*z, *r);
        }
        self.update_peaks(o, connectors);
        let before = [&self.edge, &self.roll, &self.trim].map(|of| of.vectors::<S>()[0]);
        match (self.from_rest.contains(&true), self.rows.edges) {
            (true, _) => self.update_corners::<S, true, 2>(o),
            (false, 1) => self.update_corners::<S, false, 1>(o),
            (false, _) => self.update_corners::<S, false, 2>(o),
        }
        self.note_corners(o, before);
        self.update_edges(o, operator, constants, energy, (groups, lanes));
    }

    /// Peaks of positions, joints and connectors.
    #[inline(always)]
    fn update_peaks<S: Simd>(&mut self, o: Ops<S>, connectors: &Connectors) {
        let mut peaks = Peaks::<S> {
            o,
            now: self.now.vectors::<S>()[0],
            rows: self
                .value
                .vectors_mut::<S>()
                .iter_mut()
                .zip(self.time.vectors_mut::<S>()),
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
        for joint in forces.chunks_exact(per_joint) {
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

    /// Corners: module after module, left and right end, right and left edge; `FROM_REST` where a lane has a dead state, `EDGES`
    /// the corners of an end.
    #[inline(always)]
    fn update_corners<S: Simd, const FROM_REST: bool, const EDGES: usize>(&mut self, o: Ops<S>) {
        let Observed {
            positions,
            corners,
            bottom_corners,
            ..
        } = self.rows;
        let observed = self.observed.vectors::<S>();
        let per = o.splat(1.0 / self.breadth_m);
        let mut roll = self.roll.vectors::<S>()[0];
        let mut trim = self.trim.vectors::<S>()[0];
        let mut corner = self.corner.vectors::<S>()[0];
        let of_corners = observed[positions..][..corners].chunks_exact(2 * EDGES);
        let modules = self.of_module.vectors_mut::<S>().iter_mut().zip(&self.beyond_m);
        let of_corners = of_corners.zip(&self.half_per_m);
        let edge = &mut self.edge.vectors_mut::<S>()[0];
        let risen = self.risen.vectors::<S>();
        for (j, ((module, [freeboard, _]), (ends, half))) in modules.zip(of_corners).enumerate() {
            let mut down = o.neg(ends[0]);
            for end in ends.chunks_exact(EDGES) {
                if EDGES == 2 {
                    roll = o.max(roll, o.abs(o.mul(o.sub(end[1], end[0]), per)));
                }
                for &z in end {
                    down = o.max(down, o.neg(z));
                }
            }
            let sum = |end: usize| o.add(ends[end * EDGES], ends[end * EDGES + EDGES - 1]);
            let rise = o.sub(sum(1), sum(0));
            trim = o.max(trim, o.abs(o.mul(rise, o.splat(*half))));
            *module = down;
            *edge = o.max(*edge, down);
            let under = if FROM_REST {
                let corners = ends
                    .iter()
                    .zip(&risen[2 * EDGES * j..])
                    .map(|(z, risen)| o.neg(o.add(*z, *risen)));
                corners.fold(o.splat(f64::NEG_INFINITY), |lowest, corner| o.max(lowest, corner))
            } else {
                down
            };
            corner = o.max(corner, o.sub(under, o.splat(*freeboard)));
        }
        self.roll.vectors_mut::<S>()[0] = roll;
        self.trim.vectors_mut::<S>()[0] = trim;
        self.corner.vectors_mut::<S>()[0] = corner;
        let bottom = &mut self.bottom.vectors_mut::<S>()[0];
        let of_bottom = observed[positions + corners..][..bottom_corners].chunks_exact(2 * EDGES);
        for (j, ([_, draft], ends)) in self.beyond_m.iter().zip(of_bottom).enumerate() {
            let draft = o.splat(*draft);
            for (i, &z) in ends.iter().enumerate() {
                let z = if FROM_REST {
                    o.add(z, risen[corners + 2 * EDGES * j + i])
                } else {
                    z
                };
                *bottom = o.max(*bottom, o.sub(z, draft));
            }
        }
    }

    /// Notes when and where corners, roll and trim are larger than before the step, in the lanes where they are.
    #[inline(always)]
    fn note_corners<S: Simd>(&mut self, o: Ops<S>, before: [S::f64s; 3]) {
        let now = [&self.edge, &self.roll, &self.trim].map(|of| of.vectors::<S>()[0]);
        let larger = |i: usize| o.0.first_true_m64s(o.0.greater_than_f64s(now[i], before[i])) < S::F64_LANES;
        if larger(0) || larger(1) || larger(2) {
            self.note_lanes();
        }
    }

    /// As [`Self::note_corners`].
    #[inline(never)]
    fn note_lanes(&mut self) {
        let Observed {
            positions,
            corners,
            edges,
            ..
        } = self.rows;
        for (lane, placed) in self.placed.iter_mut().enumerate() {
            let time_s = self.now.at(0, lane);
            let is_larger = [
                self.edge.at(0, lane) > placed.edge.value,
                self.roll.at(0, lane) > placed.roll.value,
                self.trim.at(0, lane) > placed.trim.value,
            ];
            if !is_larger.contains(&true) {
                continue;
            }
            let own = self.observed.lane(lane).skip(positions).take(corners);
            // a corner of one side stands for those of both edges
            let own = own.flat_map(|z| std::iter::repeat_n(z, 2 / edges));
            self.of_lane.iter_mut().zip(own).for_each(|(to, z)| *to = z);
            if is_larger[0] {
                placed.note_edge(time_s, &self.of_lane);
            }
            if is_larger[1] {
                placed.note_roll(time_s, &self.of_lane, 1.0 / self.breadth_m);
            }
            if is_larger[2] {
                placed.note_trim(time_s, &self.of_lane, &self.half_per_m);
            }
        }
    }

    /// Edges inside the modules, where one may be lower than any edge before. A station is off the straight line between its
    /// module's corners by no more than Cauchy and Schwarz allow: `(row u)^2 <= (sum of phi^2 / omega^2) (sum of omega^2
    /// q^2)` for the modes, R and s in their place for what the connectors add, the load times its largest influence for the
    /// rest, which follows the load at once.
    #[inline(always)]
    fn update_edges<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        constants: &StepConstants,
        energy: &Energy,
        (groups, each): (&LaneGroups, &[Lane]),
    ) {
        let mut loads = [0.0; MOST_LANES];
        for (load, of) in loads.iter_mut().zip(each) {
            *load = of.rider_forces.iter().map(|(.., force)| force.abs()).sum();
        }
        for group in groups.all() {
            for lane in group.numbers() {
                let weight = |of: &UnitForce| of.share * group.load_in(of.vehicle, lane);
                loads[lane] += group.weights.iter().map(weight).sum::<f64>();
            }
        }
        let modal = o.0.sqrt_f64s(energy.modal_strain.vectors::<S>()[0]);
        let residual = energy.residual_strain.vectors::<S>()[0];
        let residual = o.0.sqrt_f64s(o.max(residual, o.splat(0.0)));
        let load = lanes::<S>(&loads)[0];
        for (module, bound) in operator.inside_bounds.iter().enumerate() {
            let [of_modes, of_residual, of_load] = [o.splat(bound[0]), o.splat(bound[1]), o.splat(bound[2])];
            let margin = o.fma(of_modes, modal, o.fma(of_residual, residual, o.mul(of_load, load)));
            let lowest = o.add(self.of_module.vectors::<S>()[module], margin);
            let lower = o.0.greater_than_f64s(lowest, self.edge.vectors::<S>()[0]);
            if o.0.first_true_m64s(lower) >= S::F64_LANES {
                continue;
            }
            let mut lowests = [0.0; MOST_LANES];
            lanes_mut::<S>(&mut lowests)[0] = lowest;
            let is_lower = |edge: &LaneArray, lane: usize| lowests[lane] > edge.at(0, lane);
            if (0..each.len()).any(|lane| each[lane].crossing.is_some() && is_lower(&self.edge, lane)) {
                let rows = operator.of_modules[module].inside.len();
                let inside = &mut self.inside.vectors_mut::<S>()[..rows];
                constants.panels.inside[module].multiply(o, self.motion.vectors::<S>(), inside);
            }
            for (lane, of) in each.iter().enumerate() {
                if is_lower(&self.edge, lane) {
                    self.update_edge(operator, module, lane, (groups, of));
                }
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
            let edge = self.edge.at_mut(0, lane);
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
        LanePeaks {
            positions: (0..self.rows.positions).map(|i| [at(2 * i), at(2 * i + 1)]).collect(),
            forces: (self.rows.positions..self.value.rows() / 2)
                .map(|i| forces(2 * i))
                .collect(),
            corner_m: self.corner.at(0, lane),
            bottom_m: self.bottom.at(0, lane),
            placed: self.placed[lane],
            energy,
        }
    }
}

/// Peaks of all rows, to be raised one after the other.
struct Peaks<'a, S: Simd> {
    o: Ops<S>,
    now: S::f64s,
    rows: std::iter::Zip<std::slice::IterMut<'a, S::f64s>, std::slice::IterMut<'a, S::f64s>>,
}

impl<S: Simd> Peaks<'_, S> {
    /// Takes the next row's value where it is larger than all before.
    #[inline(always)]
    fn update_max(&mut self, value: S::f64s) {
        if let Some((best, time)) = self.rows.next() {
            let larger = self.o.0.greater_than_f64s(value, *best);
            *best = self.o.0.select_f64s(larger, value, *best);
            *time = self.o.0.select_f64s(larger, self.now, *time);
        }
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
