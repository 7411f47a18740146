//! Conventions that hold everywhere (documentation only).
//!
//! **Axes.** x along the bridge from its left end, y across from the centre line, z up from the bottom plate, whose
//! still-water position is z = 0. Displacements are small and counted from the static equilibrium of the unloaded bridge.
//!
//! **Units.** SI: m, N, kg, s, Pa, Hz, rad. A name that a person types or reads ends in its unit.
//!
//! **Signs.** Deflection counts downward, uplift upward, both positive. Tension of a connector is positive, so is its
//! elongation `e`, the motion along x of the right deck node less the left one's. Gaps are positive lengths.
//!
//! **Numbers.** Positions are the module ends, 1 to modules + 1; position p lies at `(p - 1)` module lengths. A joint has
//! the number of its position, 2 to modules. A position's deflection is that of the bottom's centre line.
//!
//! **Time.** The vehicle's front is at x = 0 at t = 0; a single footprint's front is its centre. A crossing starts at rest
//! at the time step before the first point reaches the bridge and ends a tail after the last point has left.
//!
//! **Matrices.** `M u'' + C u' + K u = f - B^T N(B u)`: K and M hold structure and water but no connectors; B has a row for
//! each connector; `C = a K + b M`. Ties and supports are exact: dofs are shared or left out, nothing is penalised.
//!
//! **Threads.** Nothing in this crate starts one. All prepared bridges and solvers are shared read-only.
