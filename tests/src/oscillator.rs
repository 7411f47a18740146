//! One degree of freedom in closed form: `m u'' + c u' + k u = p + r t` from a given state.
//!
//! Knows the exact motion of a damped oscillator under a force linear in time. Does not know where the force comes from.

/// A damped oscillator, under-damped: mass `[kg]`, damping `[kg/s]`, stiffness `[N/m]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    /// m.
    pub mass: f64,
    /// c.
    pub damping: f64,
    /// k, above 0.
    pub stiffness: f64,
}

/// Place `[m]` and velocity `[m/s]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// u.
    pub u: f64,
    /// u'.
    pub v: f64,
}

impl Oscillator {
    /// The motion a time `t` after `from`, under the force `p + r t` `[N, N/s]`.
    ///
    /// With `u_p = (p + r t)/k - c r/k^2` the rest is free: `e^(-h t) (a cos w t + b sin w t)`, `h = c/2m`, `w^2 = k/m - h^2`.
    pub fn after(&self, t: f64, from: Motion, p: f64, r: f64) -> Motion {
        let Self {
            mass,
            damping,
            stiffness,
        } = *self;
        let half = 0.5 * damping / mass;
        let omega = (stiffness / mass - half * half).sqrt();
        let steady = |t: f64| (p + r * t) / stiffness - damping * r / (stiffness * stiffness);
        let a = from.u - steady(0.0);
        let b = (from.v - r / stiffness + half * a) / omega;
        let (sin, cos) = (omega * t).sin_cos();
        let decay = (-half * t).exp();
        Motion {
            u: steady(t) + decay * (a * cos + b * sin),
            v: r / stiffness + decay * ((omega * b - half * a) * cos - (omega * a + half * b) * sin),
        }
    }
}
