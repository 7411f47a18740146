//! Arithmetic on vectors of lanes, by methods that are always inlined: a closure that is not would leave the instructions
//! behind that the lanes run on.
//!
//! Knows a vector and the operations on it. Does not know what the numbers mean.

use crate::scheme::Arithmetic;
use pulp::Simd;

/// The operations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ops<S>(pub S);

impl<S: Simd> Ops<S> {
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

    // the library's own are not always inlined

    #[inline(always)]
    pub(super) fn neg(self, a: S::f64s) -> S::f64s {
        self.0.xor_f64s(a, self.0.splat_f64s(-0.0))
    }

    #[inline(always)]
    pub(super) fn abs(self, a: S::f64s) -> S::f64s {
        self.0.and_f64s(a, self.0.splat_f64s(f64::from_bits(!(1 << 63))))
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

impl<S: Simd> Arithmetic for Ops<S> {
    type Number = S::f64s;

    #[inline(always)]
    fn splat(self, x: f64) -> S::f64s {
        self.0.splat_f64s(x)
    }

    #[inline(always)]
    fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.add_f64s(a, b)
    }

    #[inline(always)]
    fn combined(self, a: [S::f64s; 3], x: [S::f64s; 3]) -> S::f64s {
        self.fma(a[0], x[0], self.fma(a[1], x[1], self.mul(a[2], x[2])))
    }

    #[inline(always)]
    fn followed(self, rho: S::f64s, f: S::f64s, a: [S::f64s; 2], x: [S::f64s; 3]) -> S::f64s {
        let rest = self.fma(a[0], x[1], self.fma(a[1], x[2], x[0]));
        self.mul(rho, self.sub(f, rest))
    }
}
