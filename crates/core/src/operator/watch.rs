//! What is read of every lane after a step: peaks with their times, roll, edges, axle forces, energies.
//!
//! Knows the observed rows. Does not know how the motion came about.

use super::basis::{BridgeOperator, Observed};
use super::lane::Lane;
use super::level::Level;
use super::motion::{Motion, Scratch};
use super::panel::{lanes, lanes_mut};
use super::vector::Ops;
use crate::response::{EnergySummary, ForcePeaks, JointPeaks, Peak};
use pulp::Simd;

/// More lanes than any vector has.
pub(super) const MOST_LANES: usize = 16;

/// Running extremes of every lane, rows of lanes side by side.
#[derive(Debug, Clone, Default)]
pub(super) struct Watch {
    rows: Observed,
    per_joint: usize,
    /// Largest values, downward and upward of each position, then pushing and pulling of each joint's sum and each
    /// connector; and when.
    value: Vec<f64>,
    time: Vec<f64>,
    /// Time of the step `[s]`.
    now: Vec<f64>,
    /// Largest downward deflection of corners and edges, height of bottom corners, roll; largest corner deflection.
    edge: Vec<f64>,
    corner: Vec<f64>,
    bottom: Vec<f64>,
    roll: Vec<f64>,
    /// Sums and extremes of the energy balance: rayleigh, numerical, work, largest work, largest gap, largest numerical.
    energy: Vec<f64>,
    contact: Vec<f64>,
    /// Largest deflection of each module's corners now.
    of_module: Vec<f64>,
    breadth_m: f64,
}

impl Watch {
    pub(super) fn new(operator: &BridgeOperator, width: usize) -> Self {
        let of = |rows: usize| vec![0.0; rows * width];
        let (rows, sizes) = (operator.rows, &operator.sizes);
        let joints = sizes.modules - 1;
        let peaks = 2 * (rows.positions + joints + sizes.connectors);
        Self {
            rows,
            per_joint: sizes.connectors.checked_div(joints).unwrap_or(0),
            value: of(peaks),
            time: of(peaks),
            now: of(1),
            edge: of(1),
            corner: of(1),
            bottom: of(1),
            roll: of(1),
            energy: of(6),
            contact: of(1),
            of_module: of(sizes.modules),
            breadth_m: operator.breadth_m,
        }
    }

    /// Numbers that a lane carries.
    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        [
            &mut self.value,
            &mut self.time,
            &mut self.edge,
            &mut self.corner,
            &mut self.bottom,
            &mut self.roll,
            &mut self.energy,
            &mut self.contact,
        ]
        .into_iter()
    }

    pub(super) fn begin(&mut self, lane: usize) {
        self.contact[lane] = f64::INFINITY;
    }

    /// Smallest force of an axle while it is whole on the bridge.
    #[inline(always)]
    pub(super) fn note_axles(&mut self, lane: usize, axles: &[(f64, bool)], inertia: &[f64]) {
        for (&(weight, whole), inertia) in axles.iter().zip(inertia) {
            if whole {
                self.contact[lane] = self.contact[lane].min(weight + inertia);
            }
        }
    }

    /// The step's part of the energy balance.
    #[inline(always)]
    pub(super) fn note_energies<S: Simd>(
        &mut self,
        o: Ops<S>,
        stored: S::f64s,
        rayleigh: S::f64s,
        numerical: S::f64s,
        work: S::f64s,
    ) {
        let sums = lanes_mut::<S>(&mut self.energy);
        sums[0] = o.add(sums[0], rayleigh);
        sums[1] = o.add(sums[1], numerical);
        sums[2] = o.add(sums[2], work);
        let gap = o.sub(o.add(stored, o.add(sums[0], sums[1])), sums[2]);
        sums[3] = o.max(sums[3], o.abs(sums[2]));
        sums[4] = o.max(sums[4], o.abs(gap));
        sums[5] = o.max(sums[5], o.abs(sums[1]));
    }

    /// Connectors of a joint.
    pub(super) fn per_joint(&self) -> usize {
        self.per_joint
    }

    /// Reads the rows after a step.
    #[inline(always)]
    pub(super) fn read<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        level: &Level,
        motion: &Motion,
        now: &mut Scratch,
        each: &[Lane],
    ) {
        let width = S::F64_LANES;
        let watch = &mut *self;
        for (lane, time) in watch.now.iter_mut().enumerate() {
            *time = each[lane].time_s;
        }
        let (m, nc) = (level.c.len(), level.modal.nrows());
        now.x[..m * width].copy_from_slice(&motion.q);
        now.x[m * width..].copy_from_slice(&motion.s[0]);
        let (x, w) = (lanes::<S>(&now.x), lanes_mut::<S>(&mut now.w));
        level.panels.v.multiply(o, x, w);
        for (w, r) in w.iter_mut().zip(&lanes::<S>(&motion.r[0])[nc..]) {
            *w = o.add(*w, *r);
        }
        let Observed {
            positions,
            corners,
            bottom_corners,
        } = watch.rows;
        let mut peaks = Peaks::<S> {
            o,
            now: lanes::<S>(&watch.now)[0],
            rows: lanes_mut::<S>(&mut watch.value)
                .iter_mut()
                .zip(lanes_mut::<S>(&mut watch.time)),
        };
        for &z in &w[..positions] {
            peaks.take_both(z);
        }
        for joint in lanes::<S>(&motion.n).chunks_exact(watch.per_joint.max(1)) {
            let mut sum = o.splat(0.0);
            for &force in joint {
                sum = o.add(sum, force);
            }
            peaks.take_both(sum);
            for &force in joint {
                peaks.take_both(force);
            }
        }
        // corners: module after module, left and right end, right and left edge
        let per = o.splat(1.0 / watch.breadth_m);
        let of_corners = &w[positions..][..corners];
        let mut roll = lanes::<S>(&watch.roll)[0];
        let mut corner = lanes::<S>(&watch.corner)[0];
        for (module, ends) in lanes_mut::<S>(&mut watch.of_module)
            .iter_mut()
            .zip(of_corners.chunks_exact(4))
        {
            let mut down = o.neg(ends[0]);
            for end in ends.chunks_exact(2) {
                roll = o.max(roll, o.abs(o.mul(o.sub(end[1], end[0]), per)));
                for &z in end {
                    down = o.max(down, o.neg(z));
                }
            }
            *module = down;
            corner = o.max(corner, down);
        }
        lanes_mut::<S>(&mut watch.roll)[0] = roll;
        lanes_mut::<S>(&mut watch.corner)[0] = corner;
        let edge = &mut lanes_mut::<S>(&mut watch.edge)[0];
        *edge = o.max(*edge, corner);
        let bottom = &mut lanes_mut::<S>(&mut watch.bottom)[0];
        for &z in &w[positions + corners..][..bottom_corners] {
            *bottom = o.max(*bottom, z);
        }
        self.read_inside(o, operator, level, now, each);
    }

    /// Edges inside the modules, where one may be lower than any edge before. A station is off the straight line between its
    /// module's corners by no more than Cauchy and Schwarz allow: `(row u)^2 <= (sum of phi^2 / omega^2) (sum of omega^2
    /// q^2)` for the modes, the same with R and s for what the connectors add, the load times its largest reach for the
    /// rest, which follows the load at once.
    #[inline(always)]
    fn read_inside<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        level: &Level,
        now: &mut Scratch,
        each: &[Lane],
    ) {
        let (width, sizes) = (S::F64_LANES, &operator.sizes);
        let watch = self;
        let mut loads = [0.0; MOST_LANES];
        for (load, of) in loads.iter_mut().zip(each) {
            for (.., force) in of.weights.iter().chain(&of.masses) {
                *load += force.abs();
            }
        }
        let [modal, residual] = [&now.modal_strain, &now.residual_strain].map(|x| lanes::<S>(x)[0]);
        let modal = o.0.sqrt_f64s(modal);
        let residual = o.0.sqrt_f64s(o.max(residual, o.splat(0.0)));
        let load = lanes::<S>(&loads)[0];
        for (module, bound) in operator.inside_bounds.iter().enumerate() {
            let [of_modes, of_residual, of_load] = [o.splat(bound[0]), o.splat(bound[1]), o.splat(bound[2])];
            let margin = o.fma(of_modes, modal, o.fma(of_residual, residual, o.mul(of_load, load)));
            let lowest = o.add(lanes::<S>(&watch.of_module)[module], margin);
            let lower = o.0.greater_than_f64s(lowest, lanes::<S>(&watch.edge)[0]);
            if o.0.first_true_m64s(lower) >= width {
                continue;
            }
            let mut lowests = [0.0; MOST_LANES];
            lanes_mut::<S>(&mut lowests)[0] = lowest;
            let mut computed = false;
            for (lane, of) in each.iter().enumerate() {
                let lower = lowests[lane] > watch.edge[lane];
                let (Some(passage), true) = (&of.passage, lower) else {
                    continue;
                };
                if !computed {
                    let off = lanes_mut::<S>(&mut now.inside);
                    level.panels.inside[module].multiply(o, lanes::<S>(&now.x), off);
                    computed = true;
                }
                let corners = &now.w[(watch.rows.positions + 4 * module) * width..];
                let first = sizes.followed() + module * sizes.inside;
                for i in 0..sizes.inside {
                    let (place, side) = (operator.places[i / 2], i % 2);
                    let straight =
                        (1.0 - place) * corners[side * width + lane] + place * corners[(2 + side) * width + lane];
                    let mut z = straight + now.inside[i * width + lane];
                    let wheels = &passage.wheels;
                    for (lines, forces) in [(&wheels.weights, &of.weights), (&wheels.masses, &of.masses)] {
                        for &(line, station, force) in forces {
                            z -= force * lines[line].reach(station, wheels.width)[first + i];
                        }
                    }
                    watch.edge[lane] = watch.edge[lane].max(-z);
                }
            }
        }
    }

    /// What a lane's crossing leaves behind, peaks in the order of positions and joints.
    pub(super) fn peaks(&self, lane: usize, width: usize) -> LanePeaks {
        let watch = self;
        let at = |row: usize| Peak {
            value: watch.value[row * width + lane],
            time_s: watch.time[row * width + lane],
        };
        let forces = |row: usize| ForcePeaks {
            compression: at(row),
            tension: at(row + 1),
        };
        let energy = |i: usize| watch.energy[i * width + lane];
        let per_work = |x: f64| if energy(3) == 0.0 { 0.0 } else { x / energy(3) };
        LanePeaks {
            positions: (0..watch.rows.positions).map(|i| [at(2 * i), at(2 * i + 1)]).collect(),
            forces: (watch.rows.positions..watch.value.len() / (2 * width))
                .map(|i| forces(2 * i))
                .collect(),
            edge_m: watch.edge[lane],
            corner_m: watch.corner[lane],
            bottom_m: watch.bottom[lane],
            roll_rad: watch.roll[lane],
            min_contact_force_n: watch.contact[lane],
            energy: EnergySummary {
                energy_residual: per_work(energy(4)),
                numerical_dissipation: per_work(energy(5)),
            },
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
    fn take(&mut self, value: S::f64s) {
        if let Some((best, time)) = self.rows.next() {
            let larger = self.o.0.greater_than_f64s(value, *best);
            *best = self.o.0.select_f64s(larger, value, *best);
            *time = self.o.0.select_f64s(larger, self.now, *time);
        }
    }

    /// The next two rows: one for the value's other sense, one for its own.
    #[inline(always)]
    fn take_both(&mut self, value: S::f64s) {
        self.take(self.o.neg(value));
        self.take(value);
    }
}

/// What a lane's crossing leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LanePeaks {
    /// Downward and upward of each position `[m]`.
    pub positions: Vec<[Peak; 2]>,
    /// Of each joint the sum, then each connector `[N]`.
    pub forces: Vec<ForcePeaks>,
    /// Largest downward deflection of the deck's edges, and of the deck's corners alone `[m]`.
    pub edge_m: f64,
    /// See `edge_m`.
    pub corner_m: f64,
    /// Largest height of a bottom corner `[m]`; 0 where none is followed.
    pub bottom_m: f64,
    /// Largest roll of a module end `[rad]`.
    pub roll_rad: f64,
    /// Smallest force of an axle `[N]`.
    pub min_contact_force_n: f64,
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
