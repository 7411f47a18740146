//! The generalized-alpha family of time integration.
//!
//! Knows the constants of one step, derived once from the spectral radius. Does not know matrices or contact.

/// Constants of a step of length `h` (Chung, Hulbert: J. Appl. Mech. 60, 1993, 371-375): with the spectral radius
/// `rho` at infinite frequency
///
/// `alpha_m = (2 rho - 1)/(rho + 1)`, `alpha_f = rho/(rho + 1)`, `gamma = 1/2 - alpha_m + alpha_f`,
/// `beta = (1 - alpha_m + alpha_f)^2 / 4`.
///
/// The step reads, with `d = u_1 - u_0`,
///
/// `a_1 = c_a d + a_v v_0 + a_a a_0`, `v_1 = c_v d + v_v v_0 + v_a a_0`,
/// `M a_alpha + C v_alpha + K u_alpha = f_alpha`, `x_alpha = (1 - alpha) x_1 + alpha x_0`,
/// alpha_m for the acceleration, alpha_f for everything else. Newmark's trapezoidal rule is `rho = 1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scheme {
    /// Length of the step `[s]`.
    pub h: f64,
    /// Weight of the old acceleration.
    pub alpha_m: f64,
    /// Weight of the old velocity, displacement and force.
    pub alpha_f: f64,
    /// Newmark's gamma.
    pub gamma: f64,
    /// Newmark's beta.
    pub beta: f64,
    /// da_1/dd `[1/s^2]`.
    pub c_a: f64,
    /// da_1/dv_0 `[1/s]`.
    pub a_v: f64,
    /// da_1/da_0.
    pub a_a: f64,
    /// dv_1/dd `[1/s]`.
    pub c_v: f64,
    /// dv_1/dv_0.
    pub v_v: f64,
    /// dv_1/da_0 `[s]`.
    pub v_a: f64,
}

impl Scheme {
    /// The constants for a step `h` `[s]` and spectral radius `rho` from 0 to 1.
    /// Equation (T1).
    pub(crate) fn new(h: f64, rho: f64) -> Self {
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        let gamma = 0.5 - alpha_m + alpha_f;
        let beta = 0.25 * (1.0 - alpha_m + alpha_f).powi(2);
        Self {
            h,
            alpha_m,
            alpha_f,
            gamma,
            beta,
            c_a: 1.0 / (beta * h * h),
            a_v: -1.0 / (beta * h),
            a_a: 1.0 - 0.5 / beta,
            c_v: gamma / (beta * h),
            v_v: 1.0 - gamma / beta,
            v_a: h * (1.0 - 0.5 * gamma / beta),
        }
    }

    /// Factors of M, C and K in the matrix of the step.
    /// Equation (T4).
    pub(crate) fn effective(&self) -> (f64, f64, f64) {
        (
            (1.0 - self.alpha_m) * self.c_a,
            (1.0 - self.alpha_f) * self.c_v,
            1.0 - self.alpha_f,
        )
    }

    /// `(1 - alpha_m) new + alpha_m old`.
    #[inline]
    pub(crate) fn at_m(&self, new: f64, old: f64) -> f64 {
        (1.0 - self.alpha_m) * new + self.alpha_m * old
    }

    /// `(1 - alpha_f) new + alpha_f old`.
    #[inline]
    pub(crate) fn at_f(&self, new: f64, old: f64) -> f64 {
        (1.0 - self.alpha_f) * new + self.alpha_f * old
    }
}

/// What a step is computed in: numbers, or vectors of one number a lane.
pub(crate) trait Arithmetic: Copy {
    /// A number, or one a lane.
    type Number: Copy;

    /// A constant.
    fn splat(self, x: f64) -> Self::Number;

    /// `a + b`.
    fn add(self, a: Self::Number, b: Self::Number) -> Self::Number;

    /// `a_0 x_0 + a_1 x_1 + a_2 x_2`, summed and rounded in an order that is the arithmetic's own and always the same.
    fn combined(self, a: [Self::Number; 3], x: [Self::Number; 3]) -> Self::Number;

    /// `rho (f - x_0 - a_1 x_1 - a_2 x_2)`, in such an order too.
    fn followed(self, rho: Self::Number, f: Self::Number, a: [Self::Number; 2], x: [Self::Number; 3]) -> Self::Number;
}

/// Arithmetic of single numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scalar;

impl Arithmetic for Scalar {
    type Number = f64;

    #[inline(always)]
    fn splat(self, x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn add(self, a: f64, b: f64) -> f64 {
        a + b
    }

    #[inline(always)]
    fn combined(self, a: [f64; 3], x: [f64; 3]) -> f64 {
        a[0] * x[0] + a[1] * x[1] + a[2] * x[2]
    }

    #[inline(always)]
    fn followed(self, rho: f64, f: f64, a: [f64; 2], x: [f64; 3]) -> f64 {
        rho * (f - x[0] - a[0] * x[1] - a[1] * x[2])
    }
}

/// Newmark's update (T2): velocity and acceleration at the end of a step in which the displacement changes by d.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Newmark<A: Arithmetic> {
    on_velocity: [A::Number; 3],
    on_acceleration: [A::Number; 3],
}

impl<A: Arithmetic> Newmark<A> {
    /// The update of a scheme.
    #[inline(always)]
    pub(crate) fn of(o: A, s: &Scheme) -> Self {
        Self {
            on_velocity: [o.splat(s.c_v), o.splat(s.v_v), o.splat(s.v_a)],
            on_acceleration: [o.splat(s.c_a), o.splat(s.a_v), o.splat(s.a_a)],
        }
    }

    /// Displacement, velocity and acceleration at the end of the step.
    #[inline(always)]
    pub(crate) fn advance(&self, o: A, d: A::Number, [x, v, a]: [A::Number; 3]) -> [A::Number; 3] {
        [
            o.add(x, d),
            o.combined(self.on_velocity, [d, v, a]),
            o.combined(self.on_acceleration, [d, v, a]),
        ]
    }
}

/// Coefficients of proportional damping: Rayleigh's `C = a K + b M`, or that of the structure alone, `C = a (K - K_w) + b M` with the
/// water's springs K_w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rayleigh {
    /// Stiffness-proportional part `[s]`.
    pub a: f64,
    /// Mass-proportional part `[1/s]`.
    pub b: f64,
    /// Stiffness-proportional part that the water's springs have, a or 0 `[s]`.
    pub a_water: f64,
}

impl Rayleigh {
    /// `C = a K + b M`.
    pub const fn new(a: f64, b: f64) -> Self {
        Self { a, b, a_water: a }
    }

    /// Damping of the structure by `ratio` at `at_hz`, in proportion to the frequency: `C = a (K - K_w)`, `a = 2 ratio / (2 pi at_hz)`.
    /// Equation (T6).
    pub fn of_structure(ratio: f64, at_hz: f64) -> Self {
        Self {
            a: 2.0 * ratio / (2.0 * std::f64::consts::PI * at_hz),
            b: 0.0,
            a_water: 0.0,
        }
    }

    /// What `a K` has more of the water's springs than there is damping `[s]`.
    pub(crate) fn beyond_water(&self) -> f64 {
        self.a - self.a_water
    }
}
