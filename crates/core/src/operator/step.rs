//! The step of all lanes: advance the uncoupled modes, form the trial elongations, settle connectors and riding masses
//! together, add their effect, account.
//!
//! Knows the arithmetic of a step, the same for every lane whatever is beside it. Does not know when a crossing ends.

use super::basis::BridgeOperator;
use super::beside::Pressing;
use super::lane::Lane;
use super::lanes::{Lanes, Saved, scatter, spread};
use super::level::Level;
use super::panel::{lanes, lanes_mut};
use super::vector::{Mean, Newmark, Ops};
use pulp::{Arch, Simd, WithSimd};

/// One step of all lanes that are at work, each to the time it was placed at.
struct Step<'a> {
    operator: &'a BridgeOperator,
    level: &'a Level,
    newton_limit: usize,
    lanes: &'a mut Lanes,
}

/// Steps every lane at work to where [`Lanes::place`] has put it. A lane whose contact does not settle stands as before
/// and says so by [`Lanes::unsettled`].
pub(crate) fn step(lanes: &mut Lanes, operator: &BridgeOperator, level: &Level, newton_limit: usize) {
    Arch::new().dispatch(Step {
        operator,
        level,
        newton_limit,
        lanes,
    });
}

impl WithSimd for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            operator,
            level,
            newton_limit,
            lanes: all,
        } = self;
        let o = Ops(simd);
        let masses = all.any_mass();
        for lane in 0..S::F64_LANES {
            all.weigh(operator, lane);
        }
        predict(all, o, level, masses);
        let mut unsettled: Option<Vec<(usize, Saved)>> = None;
        for lane in 0..S::F64_LANES {
            if !settle(all, operator, level, newton_limit, lane) {
                let saved = all.save(lane);
                unsettled.get_or_insert_default().push((lane, saved));
            }
        }
        correct(all, o, level, &operator.omega2);
        all.watch
            .read(o, operator, level, &all.motion, &mut all.scratch, &all.lanes);
        for (lane, saved) in unsettled.into_iter().flatten() {
            all.restore(lane, &saved);
        }
    }
}

/// The step without new connector and inertia forces: `d` of modes, of what they leave out, trial elongations.
#[inline(always)]
fn predict<S: Simd>(crossings: &mut Lanes, o: Ops<S>, level: &Level, masses: bool) {
    let (old, now) = (&crossings.motion, &mut crossings.scratch);
    let s = &level.scheme;
    let (m, nc) = (level.c.len(), level.modal.nrows());
    let (f, newmark) = (Mean::<S>::of(o, s.alpha_f), Newmark::<S>::of(o, s));
    let m_old = o.splat(s.alpha_m);

    // modes
    let all = m + old.r[0].len() / S::F64_LANES;
    let (w_now, w_old, inertia) = (
        &lanes::<S>(&now.weights)[..all],
        &lanes::<S>(&old.weights)[..all],
        &lanes::<S>(&old.inertia)[..all],
    );
    let (on_q, on_v, on_a, c) = (&level.on_q[..m], &level.on_v[..m], &level.on_a[..m], &level.c[..m]);
    let (q, v, a) = (
        &lanes::<S>(&old.q)[..m],
        &lanes::<S>(&old.v)[..m],
        &lanes::<S>(&old.a)[..m],
    );
    let contact = &lanes::<S>(&old.contact)[..m];
    let [free_q, free_v, free_a] = &mut now.free;
    let free_q = &mut lanes_mut::<S>(free_q)[..m];
    let free_v = &mut lanes_mut::<S>(free_v)[..m];
    let free_a = &mut lanes_mut::<S>(free_a)[..m];
    let d = &mut lanes_mut::<S>(&mut now.d)[..m];
    for k in 0..m {
        // downward forces of the vehicle that do not wait for the new instant
        let down = o.fma(m_old, inertia[k], f.at(o, w_now[k], w_old[k]));
        let force = o.fma(f.old, contact[k], down);
        let from_a = o.mul(o.splat(on_a[k]), a[k]);
        let motion = o.fma(o.splat(on_q[k]), q[k], o.fma(o.splat(on_v[k]), v[k], from_a));
        d[k] = o.less(motion, o.splat(c[k]), force);
    }
    if masses {
        for k in 0..m {
            free_q[k] = o.add(q[k], d[k]);
            free_v[k] = newmark.velocity(o, d[k], v[k], a[k]);
            free_a[k] = newmark.acceleration(o, d[k], v[k], a[k]);
        }
    }

    // what the modes leave out
    let follow = Follow::<S>::of(o, level);
    let (n, rn) = (lanes::<S>(&old.n), lanes::<S>(&old.rn));
    let (ds, dsigma, dr) = (
        lanes_mut::<S>(&mut now.ds),
        lanes_mut::<S>(&mut now.dsigma),
        lanes_mut::<S>(&mut now.dr),
    );
    let (s0, s1, s2) = (lanes::<S>(&old.s[0]), lanes::<S>(&old.s[1]), lanes::<S>(&old.s[2]));
    let (t0, t1, t2) = (
        lanes::<S>(&old.sigma[0]),
        lanes::<S>(&old.sigma[1]),
        lanes::<S>(&old.sigma[2]),
    );
    for i in 0..nc {
        ds[i] = follow.change(o, o.mul(f.old, n[i]), s0[i], s1[i], s2[i]);
        dsigma[i] = follow.change(o, o.mul(f.old, rn[i]), t0[i], t1[i], t2[i]);
    }
    let (r0, r1, r2) = (lanes::<S>(&old.r[0]), lanes::<S>(&old.r[1]), lanes::<S>(&old.r[2]));
    for (i, dr) in dr.iter_mut().enumerate() {
        let down = o.fma(m_old, inertia[m + i], f.at(o, w_now[m + i], w_old[m + i]));
        *dr = follow.change(o, o.neg(down), r0[i], r1[i], r2[i]);
    }

    // trial elongations
    let (e_free, e) = (lanes_mut::<S>(&mut now.e), lanes::<S>(&old.e));
    level.panels.b.multiply(o, d, e_free);
    for i in 0..nc {
        e_free[i] = o.add(e[i], o.add(e_free[i], o.sub(dr[i], dsigma[i])));
    }
}

/// Connectors and riding masses of one lane, together; leaves its forces. Whether they settled.
#[inline(always)]
fn settle(crossings: &mut Lanes, operator: &BridgeOperator, level: &Level, newton_limit: usize, lane: usize) -> bool {
    let width = crossings.width;
    let (now, m) = (&mut crossings.scratch, level.c.len());
    let Lane {
        passage: Some(passage),
        front_x_m,
        small,
        riders,
        weights,
        masses,
        statistics,
        unsettled,
        axles,
        inertia,
        ..
    } = &mut crossings.lanes[lane]
    else {
        return true;
    };
    let (wheels, ride, law) = (&*passage.wheels, &*passage.ride, &passage.law);
    riders.place(wheels, &operator.track, passage.load_n, *front_x_m);
    if riders.count() > 0 {
        if !riders.symmetric() {
            gather(&now.free[0], &mut now.lane_free.q, lane, width);
            gather(&now.free[1], &mut now.lane_free.v, lane, width);
        }
        gather(&now.free[2], &mut now.lane_free.a, lane, width);
        gather(&crossings.motion.n, &mut now.lane_n, lane, width);
    }
    let pressing = Pressing {
        weights,
        masses,
        n: &now.lane_n,
    };
    riders.follow(wheels, level, m, pressing);
    riders.couple(wheels, ride, level, m, passage.speed_m_s, &now.lane_free);
    gather(&now.e, &mut small.e, lane, width);
    let weight = 1.0 - level.scheme.alpha_f;
    match small.solve(law, &level.among, weight, riders, newton_limit) {
        Ok((iterations, switches)) => {
            *unsettled = None;
            statistics.steps += 1;
            statistics.newton_iterations += iterations;
            statistics.contact_switches += switches;
        }
        Err(stuck) => {
            *unsettled = Some(stuck);
            riders.unfollow();
            return false;
        }
    }
    scatter(&small.e, &mut now.e, lane, width);
    for (to, scaled) in now.n.chunks_exact_mut(width).zip(&small.forces) {
        to[lane] = scaled / weight;
    }
    inertia.fill(0.0);
    masses.clear();
    if riders.count() > 0 {
        riders.add_inertia(ride, level, &small.riders, &small.forces, inertia);
        let unscale = 1.0 / (1.0 - level.scheme.alpha_m);
        riders.on_nodes(&small.riders, unscale, masses);
        spread(&wheels.masses, wheels.width, masses, &mut now.inertia, lane, width);
        gather(&now.n, &mut now.lane_n, lane, width);
        riders.lead(wheels, level, m, masses, &now.lane_n);
    }
    crossings.watch.note_axles(lane, axles, inertia);
    true
}

/// Adds the effect of the forces found, and accounts: each term of the balance at alpha times the step's motion. What a
/// term gives beyond the change of its energy is numerical dissipation.
#[inline(always)]
fn correct<S: Simd>(crossings: &mut Lanes, o: Ops<S>, level: &Level, omega2: &[f64]) {
    let (old, now) = (&mut crossings.motion, &mut crossings.scratch);
    let s = &level.scheme;
    let (m, nc) = (level.c.len(), level.modal.nrows());
    let (f, newmark) = (Mean::<S>::of(o, s.alpha_f), Newmark::<S>::of(o, s));
    let by_m = Mean::<S>::of(o, s.alpha_m);
    let zero = o.splat(0.0);

    // connectors that pull or push in any lane
    now.active.clear();
    for (i, n) in lanes::<S>(&now.n).iter().enumerate() {
        if o.0.first_true_m64s(o.0.not_m64s(o.0.equal_f64s(*n, zero))) < S::F64_LANES {
            now.active.push(i);
        }
    }
    level
        .panels
        .b_t
        .multiply_listed(o, &now.active, lanes::<S>(&now.n), lanes_mut::<S>(&mut now.contact));
    level
        .panels
        .r_bb
        .multiply_listed(o, &now.active, lanes::<S>(&now.n), lanes_mut::<S>(&mut now.rn));

    // modes
    let (mut inertia, mut stiffness, mut damping_m, mut damping_k) = (zero, zero, zero, zero);
    let (mut kinetic, mut strain, mut work) = (zero, zero, zero);
    let all = m + old.r[0].len() / S::F64_LANES;
    let (w_now, w_old) = (&lanes::<S>(&now.weights)[..all], &lanes::<S>(&old.weights)[..all]);
    let (i_now, i_old) = (&lanes::<S>(&now.inertia)[..all], &lanes::<S>(&old.inertia)[..all]);
    let (omega2, c) = (&omega2[..m], &level.c[..m]);
    let q = &mut lanes_mut::<S>(&mut old.q)[..m];
    let v = &mut lanes_mut::<S>(&mut old.v)[..m];
    let a = &mut lanes_mut::<S>(&mut old.a)[..m];
    let (contact, d_free) = (&lanes::<S>(&now.contact)[..m], &lanes::<S>(&now.d)[..m]);
    for k in 0..m {
        let w2 = o.splat(omega2[k]);
        let force = o.fma(f.new, contact[k], o.mul(by_m.new, i_now[k]));
        let d = o.less(d_free[k], o.splat(c[k]), force);
        let q_new = o.add(q[k], d);
        let v_new = newmark.velocity(o, d, v[k], a[k]);
        let a_new = newmark.acceleration(o, d, v[k], a[k]);
        let (v_alpha, w2_d) = (f.at(o, v_new, v[k]), o.mul(w2, d));
        kinetic = o.fma(v_new, v_new, kinetic);
        strain = o.fma(o.mul(w2, q_new), q_new, strain);
        inertia = o.fma(d, by_m.at(o, a_new, a[k]), inertia);
        stiffness = o.fma(w2_d, f.at(o, q_new, q[k]), stiffness);
        damping_m = o.fma(d, v_alpha, damping_m);
        damping_k = o.fma(w2_d, v_alpha, damping_k);
        work = o.less(
            work,
            d,
            o.add(f.at(o, w_now[k], w_old[k]), by_m.at(o, i_now[k], i_old[k])),
        );
        (q[k], v[k], a[k]) = (q_new, v_new, a_new);
    }
    lanes_mut::<S>(&mut now.modal_strain)[0] = strain;

    // what the modes leave out, whose energy is 1/2 s^T R s - s^T r but for that of the deck under the wheels alone
    let rho = o.splat(level.rho);
    let (rho_f, rho_m) = (o.mul(rho, f.new), o.mul(rho, by_m.new));
    let (mut springs, mut residual) = (zero, zero);
    let (n_new, n_old, rn_new) = (lanes::<S>(&now.n), lanes::<S>(&old.n), lanes::<S>(&now.rn));
    let (ds, dsigma, dr) = (lanes::<S>(&now.ds), lanes::<S>(&now.dsigma), lanes::<S>(&now.dr));
    let [s0, s1, s2] = &mut old.s;
    let (s0, s1, s2) = (lanes_mut::<S>(s0), lanes_mut::<S>(s1), lanes_mut::<S>(s2));
    let [t0, t1, t2] = &mut old.sigma;
    let (t0, t1, t2) = (lanes_mut::<S>(t0), lanes_mut::<S>(t1), lanes_mut::<S>(t2));
    let [r0, r1, r2] = &mut old.r;
    let (r0, r1, r2) = (lanes_mut::<S>(r0), lanes_mut::<S>(r1), lanes_mut::<S>(r2));
    let (e, e_new) = (lanes_mut::<S>(&mut old.e), lanes::<S>(&now.e));
    for i in 0..nc {
        let ds = o.fma(rho_f, n_new[i], ds[i]);
        let dsigma = o.fma(rho_f, rn_new[i], dsigma[i]);
        let dr = o.less(dr[i], rho_m, i_now[m + i]);
        let (s_old, r_old) = ([s0[i], s1[i]], [r0[i], r1[i]]);
        advance(o, &newmark, ds, &mut s0[i], &mut s1[i], &mut s2[i]);
        advance(o, &newmark, dsigma, &mut t0[i], &mut t1[i], &mut t2[i]);
        advance(o, &newmark, dr, &mut r0[i], &mut r1[i], &mut r2[i]);
        let moved = o.sub(dsigma, dr);
        stiffness = o.fma(
            f.at(o, s0[i], s_old[0]),
            moved,
            o.less(stiffness, f.at(o, r0[i], r_old[0]), ds),
        );
        damping_k = o.fma(
            f.at(o, s1[i], s_old[1]),
            moved,
            o.less(damping_k, f.at(o, r1[i], r_old[1]), ds),
        );
        residual = o.fma(s0[i], t0[i], residual);
        strain = o.fma(s0[i], o.sub(o.sub(t0[i], r0[i]), r0[i]), strain);
        let down = o.add(
            f.at(o, w_now[m + i], w_old[m + i]),
            by_m.at(o, i_now[m + i], i_old[m + i]),
        );
        work = o.fma(ds, down, work);
        springs = o.fma(o.sub(e_new[i], e[i]), f.at(o, n_new[i], n_old[i]), springs);
        e[i] = e_new[i];
    }
    for i in nc..r0.len() {
        let dr = o.less(dr[i], rho_m, i_now[m + i]);
        advance(o, &newmark, dr, &mut r0[i], &mut r1[i], &mut r2[i]);
    }
    lanes_mut::<S>(&mut now.residual_strain)[0] = residual;
    let half = o.splat(0.5);
    (kinetic, strain) = (o.mul(half, kinetic), o.mul(half, strain));

    std::mem::swap(&mut old.n, &mut now.n);
    std::mem::swap(&mut old.rn, &mut now.rn);
    std::mem::swap(&mut old.contact, &mut now.contact);
    std::mem::swap(&mut old.weights, &mut now.weights);
    std::mem::swap(&mut old.inertia, &mut now.inertia);

    let springs_now = spring_energy(crossings, o);
    let old = &mut crossings.motion;
    let before = o.add(
        o.add(lanes::<S>(&old.kinetic)[0], lanes::<S>(&old.strain)[0]),
        lanes::<S>(&old.springs)[0],
    );
    let stored = o.add(o.add(kinetic, strain), springs_now);
    let numerical = o.sub(o.add(o.add(inertia, stiffness), springs), o.sub(stored, before));
    let rayleigh = o.fma(
        o.splat(level.rayleigh.a),
        damping_k,
        o.mul(o.splat(level.rayleigh.b), damping_m),
    );
    lanes_mut::<S>(&mut old.kinetic)[0] = kinetic;
    lanes_mut::<S>(&mut old.strain)[0] = strain;
    lanes_mut::<S>(&mut old.springs)[0] = springs_now;
    crossings.watch.note_energies(o, stored, rayleigh, numerical, work);
}

/// Strain energy of the connectors, `1/2 N^2 / k` of the line at work: those that are not open have one slope in a lane,
/// that of one truss or of both.
#[inline(always)]
fn spring_energy<S: Simd>(crossings: &Lanes, o: Ops<S>) -> S::f64s {
    let mut squares = o.splat(0.0);
    for n in lanes::<S>(&crossings.motion.n) {
        squares = o.fma(*n, *n, squares);
    }
    o.mul(squares, lanes::<S>(&crossings.half_compliance)[0])
}

/// What the modes leave out, without mass: `d = rho (f - x_0 - on_s1 x'_0 - on_s2 x''_0)`.
struct Follow<S: Simd> {
    rho: S::f64s,
    on_s1: S::f64s,
    on_s2: S::f64s,
}

impl<S: Simd> Follow<S> {
    #[inline(always)]
    fn of(o: Ops<S>, level: &Level) -> Self {
        Self {
            rho: o.splat(level.rho),
            on_s1: o.splat(level.on_s1),
            on_s2: o.splat(level.on_s2),
        }
    }

    #[inline(always)]
    fn change(&self, o: Ops<S>, force: S::f64s, x: S::f64s, x1: S::f64s, x2: S::f64s) -> S::f64s {
        let rest = o.fma(self.on_s1, x1, o.fma(self.on_s2, x2, x));
        o.mul(self.rho, o.sub(force, rest))
    }
}

/// `x, x', x''` to the step's end.
#[inline(always)]
fn advance<S: Simd>(o: Ops<S>, by: &Newmark<S>, d: S::f64s, x: &mut S::f64s, x1: &mut S::f64s, x2: &mut S::f64s) {
    let (v, a) = (*x1, *x2);
    *x = o.add(*x, d);
    *x1 = by.velocity(o, d, v, a);
    *x2 = by.acceleration(o, d, v, a);
}

/// Reads a lane's numbers from between those of the others.
#[inline(always)]
fn gather(from: &[f64], to: &mut [f64], lane: usize, width: usize) {
    for (to, x) in to.iter_mut().zip(from.chunks_exact(width)) {
        *to = x[lane];
    }
}
