//! Arithmetic on vectors of lanes, by methods that are always inlined: a closure that is not would leave the instructions
//! behind that the lanes run on.
//!
//! Knows a vector and the operations on it. Does not know what the numbers mean.

use pulp::Simd;

/// The operations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ops<S>(pub S);

impl<S: Simd> Ops<S> {
    #[inline(always)]
    pub(super) fn splat(self, x: f64) -> S::f64s {
        self.0.splat_f64s(x)
    }

    #[inline(always)]
    pub(super) fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.add_f64s(a, b)
    }

    #[inline(always)]
    pub(super) fn sub(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.sub_f64s(a, b)
    }

    #[inline(always)]
    pub(super) fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.mul_f64s(a, b)
    }

    /// `a b + c`, rounded once.
    #[inline(always)]
    pub(super) fn fma(self, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
        self.0.mul_add_f64s(a, b, c)
    }

    /// `c - a b`, rounded once.
    #[inline(always)]
    pub(super) fn less(self, c: S::f64s, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.negate_mul_add_f64s(a, b, c)
    }

    #[inline(always)]
    pub(super) fn neg(self, a: S::f64s) -> S::f64s {
        self.0.neg_f64s(a)
    }

    #[inline(always)]
    pub(super) fn abs(self, a: S::f64s) -> S::f64s {
        self.0.abs_f64s(a)
    }

    #[inline(always)]
    pub(super) fn max(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.max_f64s(a, b)
    }
}

/// A weighted mean of new and old.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mean<S: Simd> {
    pub new: S::f64s,
    pub old: S::f64s,
}

impl<S: Simd> Mean<S> {
    /// Weights `1 - alpha` and alpha.
    #[inline(always)]
    pub(super) fn of(ops: Ops<S>, alpha: f64) -> Self {
        Self {
            new: ops.splat(1.0 - alpha),
            old: ops.splat(alpha),
        }
    }

    #[inline(always)]
    pub(super) fn at(self, ops: Ops<S>, new: S::f64s, old: S::f64s) -> S::f64s {
        ops.fma(self.new, new, ops.mul(self.old, old))
    }
}

/// Newmark's update from the change d of what is integrated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Newmark<S: Simd> {
    c_v: S::f64s,
    v_v: S::f64s,
    v_a: S::f64s,
    c_a: S::f64s,
    a_v: S::f64s,
    a_a: S::f64s,
}

impl<S: Simd> Newmark<S> {
    #[inline(always)]
    pub(super) fn of(ops: Ops<S>, s: &crate::scheme::Scheme) -> Self {
        Self {
            c_v: ops.splat(s.c_v),
            v_v: ops.splat(s.v_v),
            v_a: ops.splat(s.v_a),
            c_a: ops.splat(s.c_a),
            a_v: ops.splat(s.a_v),
            a_a: ops.splat(s.a_a),
        }
    }

    /// New velocity.
    #[inline(always)]
    pub(super) fn velocity(&self, ops: Ops<S>, d: S::f64s, v: S::f64s, a: S::f64s) -> S::f64s {
        ops.fma(self.c_v, d, ops.fma(self.v_v, v, ops.mul(self.v_a, a)))
    }

    /// New acceleration.
    #[inline(always)]
    pub(super) fn acceleration(&self, ops: Ops<S>, d: S::f64s, v: S::f64s, a: S::f64s) -> S::f64s {
        ops.fma(self.c_a, d, ops.fma(self.a_v, v, ops.mul(self.a_a, a)))
    }
}
