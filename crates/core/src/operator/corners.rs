//! Corners of the decks and bottoms of all modules: largest deflection, roll and trim, how far decks sink and bottoms rise.
//!
//! Knows how far a corner may have moved since it was looked at. Does not know how the motion came about.
//!
//! The corners of a module are looked at only where one of them may be beyond everything before it (O11). The path p of a lane is
//! the sum over its steps of `sqrt(sum of (omega^2 + 1) d^2 + g sum of ds^2)`. Modes and links move a row by at most
//! `N (p - p_0)`, `N^2 = sum of phi^2 / (omega^2 + 1) + sum of R^2 / g` (Cauchy and Schwarz). How far deck loads beside the modes
//! move it is known.

use super::basis::{BridgeOperator, Observed};
use super::corner_panel::{CornerPanel, CornerRows, MOST_CORNERS};
use super::lane_array::LaneArray;
use super::placed::Placed;
use super::residual::Residual;
use super::vector::Ops;
use crate::response::DeadState;
use crate::scheme::Arithmetic;
use pulp::Simd;

/// What rounding may do to a corner `[m]`: far more than it does.
pub(super) const ROUNDING_M: f64 = 1e-9;

/// Largest values of the corners of every lane.
#[derive(Debug, Clone)]
pub(super) struct Corners {
    rows: Observed,
    breadth_m: f64,
    /// Half of one over the length of each module `[1/m]`.
    half_per_m: Vec<f64>,
    /// Of each module how much its freeboard and its draft are above the least `[m]`.
    beyond_m: Vec<[f64; 2]>,
    /// Largest downward deflection of corners and edges, roll and trim.
    pub(super) edge: LaneArray,
    roll: LaneArray,
    trim: LaneArray,
    /// Largest corner deflection and height of a bottom corner, less what freeboard and draft are above the least.
    deck: LaneArray,
    bottom: LaneArray,
    /// How far the corners of decks, then of bottoms, have risen against the water at rest `[m]`, and in which lanes they have.
    risen: LaneArray,
    from_rest: Vec<bool>,
    /// The path of the modes and links, and of each module what loads beside the modes add to it.
    path: LaneArray,
    beside: LaneArray,
    /// Of each module its path when it was looked at, up to which it need not be looked at again, and its largest deflection then.
    looked: LaneArray,
    until: LaneArray,
    down: LaneArray,
    /// Modules looked at in the step.
    pub(super) now: Vec<usize>,
    /// Corners of one lane.
    of_lane: Vec<f64>,
}

/// What the corners are looked at with.
pub(super) struct CornerView<'a> {
    pub panels: &'a [CornerPanel],
    /// `[q; s]`.
    pub motion: &'a LaneArray,
    pub residual: &'a Residual,
    /// Number of links.
    pub links: usize,
    /// Whether they are all asked for.
    pub all: bool,
}

impl Corners {
    pub(super) fn new(operator: &BridgeOperator, lanes: usize) -> Self {
        let of = |rows: usize| LaneArray::new(rows, lanes);
        let (rows, modules) = (operator.rows, &operator.of_modules);
        let mut until = of(modules.len());
        (0..lanes).for_each(|lane| until.lane_mut(lane).for_each(|path| *path = f64::INFINITY));
        Self {
            rows,
            breadth_m: operator.breadth_m,
            half_per_m: modules.iter().map(|module| 0.5 / module.length_m).collect(),
            beyond_m: modules
                .iter()
                .map(|module| [module.freeboard_beyond_m, module.draft_beyond_m])
                .collect(),
            edge: of(1),
            roll: of(1),
            trim: of(1),
            deck: of(1),
            bottom: of(1),
            risen: of(rows.corners + rows.bottom_corners),
            from_rest: vec![false; lanes],
            path: of(1),
            beside: of(modules.len()),
            looked: of(modules.len()),
            until,
            down: of(modules.len()),
            now: Vec::with_capacity(modules.len()),
            of_lane: vec![0.0; 4 * modules.len()],
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 10] {
        [
            &mut self.edge,
            &mut self.roll,
            &mut self.trim,
            &mut self.deck,
            &mut self.bottom,
            &mut self.path,
            &mut self.beside,
            &mut self.looked,
            &mut self.until,
            &mut self.down,
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

    /// Nothing crosses in a lane.
    pub(super) fn end(&mut self, lane: usize) {
        self.until.lane_mut(lane).for_each(|path| *path = f64::INFINITY);
    }

    /// Largest corner deflection and height of a bottom corner in a lane, less what freeboard and draft are above the least `[m]`.
    pub(super) fn beyond_least_m(&self, lane: usize) -> [f64; 2] {
        [self.deck.at(0, lane), self.bottom.at(0, lane)]
    }

    /// A bound of the largest deflection of a module's corners in each lane now `[m]`; where it was looked at, that.
    #[inline(always)]
    pub(super) fn most_down<S: Simd>(&self, o: Ops<S>, module: usize, of: &CornerPanel) -> S::f64s {
        let here = o.add(self.path.vectors::<S>()[0], self.beside.vectors::<S>()[module]);
        let moved = o.sub(here, self.looked.vectors::<S>()[module]);
        o.fma(o.splat(1.0 / of.down), moved, self.down.vectors::<S>()[module])
    }

    /// Takes the step: its path, and what loads beside the modes add to that of each module.
    #[inline(always)]
    pub(super) fn advance<S: Simd>(&mut self, o: Ops<S>, square: S::f64s, view: &CornerView<'_>) {
        let path = &mut self.path.vectors_mut::<S>()[0];
        *path = o.add(*path, o.0.sqrt_f64s(square));
        let changes = &view.residual.observed_changes().vectors::<S>()[view.links..];
        let beside = self.beside.vectors_mut::<S>();
        for (module, (beside, of)) in beside.iter_mut().zip(view.panels).enumerate() {
            let rows = CornerRows::of(&self.rows, module);
            let mut most = o.splat(0.0);
            for change in &changes[rows.deck..][..rows.of_deck] {
                most = o.max(most, o.abs(*change));
            }
            for change in &changes[rows.bottom..][..rows.of_bottom] {
                most = o.max(most, o.abs(*change));
            }
            *beside = o.fma(o.splat(of.beside), most, *beside);
        }
    }

    /// Looks at the corners of modules where one may be beyond everything before, or an edge inside them, which is off the straight
    /// line between them by no more than `off_m` of each module; leaves their deflections in the observed rows.
    #[inline(always)]
    pub(super) fn look<S: Simd>(
        &mut self,
        o: Ops<S>,
        view: &CornerView<'_>,
        off_m: &LaneArray,
        observed: &mut LaneArray,
    ) {
        self.now.clear();
        for (module, of) in view.panels.iter().enumerate() {
            let here = o.add(self.path.vectors::<S>()[0], self.beside.vectors::<S>()[module]);
            let due = o.0.greater_than_or_equal_f64s(here, self.until.vectors::<S>()[module]);
            let lowest = o.add(self.most_down(o, module, of), off_m.vectors::<S>()[module]);
            let lower = o.0.greater_than_f64s(lowest, self.edge.vectors::<S>()[0]);
            if o.0.first_true_m64s(o.0.or_m64s(due, lower)) >= S::F64_LANES && !view.all {
                continue;
            }
            self.now.push(module);
            let rows = CornerRows::of(&self.rows, module);
            let mut z = [o.splat(0.0); MOST_CORNERS];
            let z = &mut z[..rows.of_deck + rows.of_bottom];
            of.panel.multiply(o, view.motion.vectors::<S>(), z);
            let (deck, bottom) = z.split_at_mut(rows.of_deck);
            let beside = &view.residual.load_residual.x.vectors::<S>()[view.links..];
            let observed = observed.vectors_mut::<S>();
            for (rows, z) in [(rows.deck, &mut *deck), (rows.bottom, &mut *bottom)] {
                for (i, z) in z.iter_mut().enumerate() {
                    *z = o.add(*z, beside[rows + i]);
                    observed[rows + i] = *z;
                }
            }
            match (self.from_rest.contains(&true), self.rows.edges) {
                (true, _) => self.take::<S, true, 2>(o, (module, of), deck, bottom),
                (false, 1) => self.take::<S, false, 1>(o, (module, of), deck, bottom),
                (false, _) => self.take::<S, false, 2>(o, (module, of), deck, bottom),
            }
        }
    }

    /// The corners of one module; `FROM_REST` where a lane has a dead state, `EDGES` the corners of an end.
    #[inline(always)]
    fn take<S: Simd, const FROM_REST: bool, const EDGES: usize>(
        &mut self,
        o: Ops<S>,
        (module, of): (usize, &CornerPanel),
        ends: &[S::f64s],
        bottom: &[S::f64s],
    ) {
        let [freeboard, draft] = self.beyond_m[module];
        let (freeboard, draft) = (o.splat(freeboard), o.splat(draft));
        let risen = self.risen.vectors::<S>();
        let mut roll_now = o.splat(0.0);
        let mut down = o.neg(ends[0]);
        for end in ends.chunks_exact(EDGES) {
            if EDGES == 2 {
                let roll = o.abs(o.mul(o.sub(end[1], end[0]), o.splat(1.0 / self.breadth_m)));
                roll_now = o.max(roll_now, roll);
            }
            for &z in end {
                down = o.max(down, o.neg(z));
            }
        }
        let (left, right) = (o.add(ends[0], ends[EDGES - 1]), o.add(ends[EDGES], ends[2 * EDGES - 1]));
        let rise = o.sub(right, left);
        let trim_now = o.abs(o.mul(rise, o.splat(self.half_per_m[module])));
        let mut under = down;
        if FROM_REST {
            under = o.splat(f64::NEG_INFINITY);
            for (z, risen) in ends.iter().zip(&risen[2 * EDGES * module..]) {
                under = o.max(under, o.neg(o.add(*z, *risen)));
            }
        }
        let under = o.sub(under, freeboard);
        let mut until = raise(o, &mut self.edge, down, of.down);
        until = o.0.min_f64s(until, raise(o, &mut self.deck, under, of.down));
        until = o.0.min_f64s(until, raise(o, &mut self.trim, trim_now, of.trim));
        if EDGES == 2 {
            until = o.0.min_f64s(until, raise(o, &mut self.roll, roll_now, of.roll));
        }
        if !bottom.is_empty() {
            let mut height = o.splat(f64::NEG_INFINITY);
            for (i, &z) in bottom.iter().enumerate() {
                let z = if FROM_REST {
                    o.add(z, risen[self.rows.corners + 2 * EDGES * module + i])
                } else {
                    z
                };
                height = o.max(height, o.sub(z, draft));
            }
            until = o.0.min_f64s(until, raise(o, &mut self.bottom, height, of.bottom));
        }
        let here = o.add(self.path.vectors::<S>()[0], self.beside.vectors::<S>()[module]);
        self.down.vectors_mut::<S>()[module] = down;
        self.looked.vectors_mut::<S>()[module] = here;
        // free lanes are never due
        let (never, before) = (o.splat(f64::INFINITY), &mut self.until.vectors_mut::<S>()[module]);
        *before =
            o.0.select_f64s(o.0.equal_f64s(*before, never), never, o.add(here, until));
    }

    /// Corners of one lane that were looked at in the step, module after module, left and right end, right and left edge; 0 of others,
    /// which are no larger than everything before.
    fn looked_at(&mut self, lane: usize, observed: &LaneArray) -> &[f64] {
        self.of_lane.fill(0.0);
        for &module in &self.now {
            let rows = CornerRows::of(&self.rows, module);
            for (i, z) in self.of_lane[4 * module..][..4].iter_mut().enumerate() {
                // a corner of one side stands for those of both edges
                *z = observed.at(rows.deck + i * self.rows.edges / 2, lane);
            }
        }
        &self.of_lane
    }

    /// The largest edge, roll and trim in each lane.
    #[inline(always)]
    pub(super) fn largest<S: Simd>(&self) -> [S::f64s; 3] {
        [
            self.edge.vectors::<S>()[0],
            self.roll.vectors::<S>()[0],
            self.trim.vectors::<S>()[0],
        ]
    }

    /// Notes when and where corners, roll and trim are larger than `before` the step, in the lanes where they are.
    #[inline(always)]
    pub(super) fn note<S: Simd>(
        &mut self,
        o: Ops<S>,
        before: [S::f64s; 3],
        (placed, times_s): (&mut [Placed], &LaneArray),
        observed: &LaneArray,
    ) {
        let now = self.largest::<S>();
        for i in 0..now.len() {
            if o.0.first_true_m64s(o.0.greater_than_f64s(now[i], before[i])) < S::F64_LANES {
                self.note_lanes(placed, times_s, observed);
                return;
            }
        }
    }

    /// As [`Self::note`].
    #[inline(never)]
    fn note_lanes(&mut self, placed: &mut [Placed], times_s: &LaneArray, observed: &LaneArray) {
        let per_breadth = 1.0 / self.breadth_m;
        for (lane, placed) in placed.iter_mut().enumerate() {
            let time_s = times_s.at(0, lane);
            let is_larger = [
                self.edge.at(0, lane) > placed.edge.value,
                self.roll.at(0, lane) > placed.roll.value,
                self.trim.at(0, lane) > placed.trim.value,
            ];
            if !is_larger.contains(&true) {
                continue;
            }
            let corners = self.looked_at(lane, observed);
            if is_larger[0] {
                placed.note_edge(time_s, corners);
            }
            if is_larger[1] {
                placed.note_roll(time_s, corners, per_breadth);
            }
            if is_larger[2] {
                let corners = std::mem::take(&mut self.of_lane);
                placed.note_trim(time_s, &corners, &self.half_per_m);
                self.of_lane = corners;
            }
        }
    }
}

/// Raises the largest value of each lane where it is now larger; the path on which it cannot rise again, which is so long for 1.
#[inline(always)]
fn raise<S: Simd>(o: Ops<S>, largest: &mut LaneArray, now: S::f64s, path: f64) -> S::f64s {
    let most = &mut largest.vectors_mut::<S>()[0];
    *most = o.max(*most, now);
    o.mul(o.splat(path), o.sub(o.sub(*most, now), o.splat(ROUNDING_M)))
}
