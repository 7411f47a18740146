//! Natural frequencies and named shapes.
//!
//! Knows how a shape is told from another by where its kinetic energy is. Does not know how the bridge was built.

mod wet;

use super::AnalysisError;
use crate::bridge::{Bridge, ModulePlace};
use crate::fem::{EigenPairs, SparseRow, SymmetricMatrix, lowest_modes_unless};
pub use crate::scheme::Rayleigh;
use crate::stop::Stop;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// One named mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Natural frequency `[Hz]`.
    pub frequency_hz: f64,
    /// Name of the shape: `heave`, `pitch`, `roll`, `surge`, `sway`, `yaw`, or `vertical bending n`, `torsion n`,
    /// `horizontal bending n`, `axial n`, `local n`, numbered by frequency within their family.
    pub name: String,
    /// Damping by radiated waves at this frequency as a share of critical damping; none in water without memory.
    pub radiation_ratio: Option<f64>,
    /// Share of the kinetic energy in the sections' vertical motion.
    pub vertical_share: f64,
    /// Share in the sections' roll.
    pub torsion_share: f64,
    /// Share in the sections' lateral motion at mid-depth.
    pub horizontal_share: f64,
    /// Share in the sections' motion along the bridge.
    pub axial_share: f64,
}

/// Shift of the eigenproblem `[1/s^2]`: the square of 0.1 Hz, below the 0.3 Hz at which bridges heave.
const SHIFT: f64 = 0.4;

/// Motions of a floating bridge that nothing restores: surge, sway and yaw.
const UNRESTORED: usize = 3;

/// Below this frequency a mode is a motion that nothing restores `[Hz]`.
const RIGID_BELOW_HZ: f64 = 1e-3;

/// A family's share of the kinetic energy below which a shape is local to plates. Shapes of the whole bridge have above
/// 0.9 in the family that they are named after.
const LOCAL_BELOW: f64 = 0.5;

/// Share of a profile that must be rigid for the shape to be called rigid.
const RIGID_SHARE: f64 = 0.95;

/// Share of a profile that must be rigid in water with memory, whose mass is less at the ends: what heaves bends there.
const RIGID_SHARE_IN_WAVES: f64 = 0.6;

/// The lowest `count` modes with the linear connection (both trusses of a connector at work), and their shapes.
///
/// # Errors
/// [`AnalysisError::Factor`].
pub fn modes(bridge: &Bridge, count: usize) -> Result<(Vec<Mode>, EigenPairs), AnalysisError> {
    modes_unless(bridge, count, Stop::never())
}

fn modes_unless(bridge: &Bridge, count: usize, stop: Stop<'_>) -> Result<(Vec<Mode>, EigenPairs), AnalysisError> {
    // fewer would be mixtures of the motions that nothing restores
    let searched = match &bridge.waves {
        None => count.max(UNRESTORED + 1),
        Some(_) => (count + wet::MORE).min(bridge.dofs()),
    };
    let mut pairs = lowest_modes_unless(&linear_stiffness(bridge)?, &bridge.m, searched, SHIFT, stop)?;
    name_unrestored(bridge, &mut pairs);
    let mut names = ShapeNames {
        count: BTreeMap::new(),
        rigid_share: if bridge.waves.is_some() {
            RIGID_SHARE_IN_WAVES
        } else {
            RIGID_SHARE
        },
    };
    let named = (0..pairs.lambda.len()).map(|j| {
        let shape: Vec<f64> = pairs.shapes.col(j).iter().copied().collect();
        let frequency_hz = pairs.lambda[j].max(0.0).sqrt() / (2.0 * PI);
        let motion = ShapeMotion::of(bridge, &shape);
        Mode {
            frequency_hz,
            name: names.next(&motion, frequency_hz < RIGID_BELOW_HZ),
            radiation_ratio: None,
            vertical_share: motion.vertical.share,
            torsion_share: motion.torsion.share,
            horizontal_share: motion.horizontal.share,
            axial_share: motion.axial.share,
        }
    });
    let mut modes: Vec<Mode> = named.collect();
    if let Some(waves) = &bridge.waves {
        // a mode keeps its name while its frequency is taken anew
        let found = wet::in_waves(waves, &mut pairs);
        let of = |wet: &wet::WetMode| Mode {
            frequency_hz: wet.frequency_hz,
            radiation_ratio: Some(wet.radiation_ratio),
            ..modes[wet.from].clone()
        };
        modes = found.iter().map(of).collect();
    }
    modes.truncate(count);
    pairs.lambda.truncate(count);
    let kept = pairs.lambda.len();
    pairs.shapes = pairs.shapes.subcols(0, kept).to_owned();
    Ok((modes, pairs))
}

/// Corners of a module in the order of [`shapes`].
pub const CORNERS: usize = 8;

/// A named mode and the motion of the corners of the modules.
pub type Shape = (Mode, Vec<[f64; 3]>);

/// The lowest `count` modes as [`modes`] finds them, each with the motion `[along, across, up]` of the corners of its
/// modules: module after module, of each the bottom's corners and then the deck's, in the order left end at -y, right end
/// at -y, right end at +y, left end at +y. The largest component of a shape is 1. Verified by `tests/solvers/shapes.rs`.
///
/// # Errors
/// [`AnalysisError::Factor`].
pub fn shapes(bridge: &Bridge, count: usize) -> Result<Vec<Shape>, AnalysisError> {
    let (modes, pairs) = modes(bridge, count)?;
    let of = |(j, mode): (usize, Mode)| {
        let shape: Vec<f64> = pairs.shapes.col(j).iter().copied().collect();
        let motion = |rows: &[SparseRow; 3]| [0, 1, 2].map(|direction: usize| rows[direction].dot(&shape));
        (mode, largest_made_one(bridge.corners.iter().map(motion).collect()))
    };
    Ok(modes.into_iter().enumerate().map(of).collect())
}

/// A shape with its largest component, the first of equals, made 1; one that does not move is left as it is.
pub fn largest_made_one(mut motion: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let larger = |most: f64, &x: &f64| if x.abs() > most.abs() { x } else { most };
    let largest = motion.iter().flatten().fold(0.0, larger);
    if largest != 0.0 {
        motion.iter_mut().flatten().for_each(|x| *x /= largest);
    }
    motion
}

/// Motions that nothing restores share one eigenvalue, so that any mixture of them is a mode: where there are three they
/// are turned into surge, sway and yaw.
fn name_unrestored(bridge: &Bridge, pairs: &mut EigenPairs) {
    let below = (2.0 * PI * RIGID_BELOW_HZ).powi(2);
    let unrestored = pairs.lambda.iter().take_while(|lambda| lambda.abs() <= below).count();
    if unrestored != UNRESTORED {
        return;
    }
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for motion in &bridge.horizontal_rigid {
        let mut shape = motion.clone();
        for other in &basis {
            let along = bridge.m.form(other, &shape);
            shape.iter_mut().zip(other).for_each(|(s, o)| *s -= along * o);
        }
        let norm = bridge.m.form(&shape, &shape).sqrt();
        shape.iter_mut().for_each(|s| *s /= norm);
        basis.push(shape);
    }
    for (j, shape) in basis.iter().enumerate() {
        pairs.lambda[j] = 0.0;
        for (i, s) in shape.iter().enumerate() {
            pairs.shapes[(i, j)] = *s;
        }
    }
}

/// K with the linear connection: `K + sum of 2 k b b^T`.
/// Equation (M1).
pub(super) fn linear_stiffness(bridge: &Bridge) -> Result<SymmetricMatrix, AnalysisError> {
    let k = 2.0 * bridge.design().connectors.stiffness_n_m;
    let mut entries: Vec<_> = bridge.k.entries().collect();
    for connector in &bridge.links[..bridge.joint_connectors] {
        for &(i, a) in &connector.row.0 {
            entries.extend(connector.row.0.iter().map(|&(j, b)| (i, j, k * a * b)));
        }
    }
    Ok(SymmetricMatrix::from_entries(bridge.dofs(), &entries)?)
}

/// `a, b` that give `ratio` of critical damping at two frequencies [31-33]:
/// `ratio = a omega / 2 + b / (2 omega)` at both.
/// Equation (M2).
pub fn rayleigh(ratio: f64, frequencies_hz: [f64; 2]) -> Rayleigh {
    let [w1, w2] = frequencies_hz.map(|f| 2.0 * PI * f);
    let a = 2.0 * ratio / (w1 + w2);
    Rayleigh::new(a, a * w1 * w2)
}

/// How many of the lowest modes are searched for the bending modes, in turn: plates of a fine mesh may have many shapes of
/// their own below them.
const SEARCHED: [usize; 3] = [16, 64, 192];

/// The first two vertical bending frequencies of the linearly connected bridge floating free `[Hz]`.
///
/// # Errors
/// [`AnalysisError::ModeMissing`] where the lowest modes hold no two, as for a single module.
pub fn bending_frequencies_hz(free: &Bridge, stop: Stop<'_>) -> Result<[f64; 2], AnalysisError> {
    let mut missing = Err(AnalysisError::ModeMissing {
        name: "vertical bending 1".to_owned(),
        searched: 0,
    });
    for searched in SEARCHED.map(|count| count.min(free.dofs())) {
        let (modes, _) = modes_unless(free, searched, stop)?;
        let find = |n: usize| {
            let name = format!("vertical bending {n}");
            let mode = modes.iter().find(|m| m.name == name).map(|m| m.frequency_hz);
            mode.ok_or(AnalysisError::ModeMissing { name, searched })
        };
        match find(1).and_then(|first| Ok([first, find(2)?])) {
            Ok(frequencies_hz) => return Ok(frequencies_hz),
            error => missing = error,
        }
    }
    missing
}

/// Names in order of frequency.
struct ShapeNames {
    count: BTreeMap<&'static str, usize>,
    /// Share of a profile that must be rigid for the shape to be called rigid.
    rigid_share: f64,
}

impl ShapeNames {
    fn next(&mut self, motion: &ShapeMotion, unrestored: bool) -> String {
        let families = [
            ("vertical bending", &motion.vertical, Some(("heave", "pitch"))),
            ("torsion", &motion.torsion, Some(("roll", "torsion"))),
            ("horizontal bending", &motion.horizontal, Some(("sway", "yaw"))),
            ("axial", &motion.axial, Some(("surge", "axial"))),
        ];
        let mut best = families[0];
        for family in &families[1..] {
            if family.1.share > best.1.share {
                best = *family;
            }
        }
        let (family, profile, rigid) = best;
        if profile.share < LOCAL_BELOW && !unrestored {
            return self.number("local");
        }
        if let Some((even, odd)) = rigid {
            if profile.even > self.rigid_share || (unrestored && profile.even >= profile.odd) {
                return even.to_owned();
            }
            let tilts = family != "torsion" && family != "axial";
            if tilts && (profile.even + profile.odd > self.rigid_share || unrestored) {
                return odd.to_owned();
            }
        }
        self.number(family)
    }

    fn number(&mut self, family: &'static str) -> String {
        let n = self.count.entry(family).or_insert(0);
        *n += 1;
        format!("{family} {n}")
    }
}

/// A motion of the sections along the bridge: its share of the kinetic energy, and how much of it is constant (`even`)
/// and linear (`odd`) in x.
#[derive(Debug, Clone, Copy, Default)]
struct Profile {
    share: f64,
    even: f64,
    odd: f64,
}

/// The four motions of the sections in a shape of unit modal mass.
#[derive(Debug, Clone, Copy, Default)]
struct ShapeMotion {
    vertical: Profile,
    torsion: Profile,
    horizontal: Profile,
    axial: Profile,
}

impl ShapeMotion {
    fn of(bridge: &Bridge, shape: &[f64]) -> Self {
        let (mut z, mut roll) = (Vec::new(), Vec::new());
        for (x, across) in &bridge.sections {
            let values: Vec<(f64, f64)> = across.iter().map(|(y, row)| (*y, row.dot(shape))).collect();
            z.push((*x, values.iter().map(|v| v.1).sum::<f64>() / values.len() as f64));
            roll.push((
                *x,
                values.iter().map(|(y, z)| y * z).sum::<f64>() / values.iter().map(|(y, _)| y * y).sum::<f64>(),
            ));
        }
        let hinges = bridge.hinge_lines.chunks_exact(2).zip(&bridge.modules);
        let (mut x, mut y, mut first) = (Vec::new(), Vec::new(), 0);
        for (ends, module) in hinges {
            let last = first + module.lines_x.len() - 1;
            for (((place, along, across), station), depth_m) in ends.iter().zip([first, last]).zip(module.depths_m) {
                // the roll there takes the lateral motion from the hinges to mid-depth
                let roll = roll[station].1;
                y.push((*place, across.dot(shape) - 0.5 * depth_m * roll));
                x.push((*place, along.dot(shape)));
            }
            first = last + 1;
        }
        let length = bridge.design().length_m();
        let stations = |module: &ModulePlace| module.lines_x.len();
        let inertias = |per_module: fn(&ModulePlace) -> usize, inertia: fn(&ModulePlace) -> f64| -> Vec<(f64, usize)> {
            bridge
                .modules
                .iter()
                .map(|module| (inertia(module), per_module(module)))
                .collect()
        };
        let structure = inertias(|_| 2, |module| module.structural_mass_kg_m);
        let afloat: Vec<(f64, usize)> = bridge.modules.iter().flat_map(ModulePlace::afloat_kg_m).collect();
        Self {
            vertical: Profile::new(&afloat, &z, length),
            torsion: Profile::new(&inertias(stations, |module| module.roll_inertia_kg_m), &roll, length),
            horizontal: Profile::new(&structure, &y, length),
            axial: Profile::new(&structure, &x, length),
        }
    }
}

impl Profile {
    /// Of values along x; two values at one x are the two sides of a joint. `modules` are the inertia per metre of each
    /// module and how many of the values are its.
    fn new(modules: &[(f64, usize)], values: &[(f64, f64)], length: f64) -> Self {
        let (mut square, mut mean, mut tilt) = (0.0, 0.0, 0.0);
        let mut of_values = modules
            .iter()
            .flat_map(|&(inertia, count)| std::iter::repeat_n(inertia, count));
        // modules of one inertia side by side are one sum
        let (mut share, mut inertia, mut own) = (0.0, of_values.next().unwrap_or(0.0), 0.0);
        for (w, next) in values.windows(2).zip(of_values) {
            let [(xa, a), (xb, b)] = [w[0], w[1]];
            let dx = xb - xa;
            let of_interval = dx * (a * a + a * b + b * b) / 3.0;
            if next != inertia {
                share += inertia * own;
                (inertia, own) = (next, 0.0);
            }
            own += of_interval;
            square += of_interval;
            mean += dx * (a + b) / 2.0;
            let [ta, tb] = [xa, xb].map(|x| 2.0 * x / length - 1.0);
            tilt += dx * (2.0 * (ta * a + tb * b) + ta * b + tb * a) / 6.0;
        }
        if square <= 0.0 {
            return Self::default();
        }
        // the integral of t^2 over the bridge is length / 3
        Self {
            share: share + inertia * own,
            even: mean * mean / (length * square),
            odd: 3.0 * tilt * tilt / (length * square),
        }
    }
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;
    use crate::bridge::{BridgeDesign, Ends, Model, PreparedModule};

    /// Roll, heave and pitch of a module that is wet in part are motions of its sections, so that the largest shares are 1 within 4 %,
    /// what plates of the coarse mesh move by themselves. Twin: water counted under the whole.
    #[test]
    fn added_mass_counts_in_the_wet_part_alone() {
        let text = include_str!("../../../../studies/bridges/smoke.json");
        let mut design: BridgeDesign = serde_json::from_str(text).expect("a design");
        (design.modules, design.wet_to_m) = (1, Some(3.35));
        let module = PreparedModule::new(&design, Model::SuperElement).expect("a module");
        let mut bridge = Bridge::new(&design, &module, Ends::Free).expect("a bridge");
        let miss = |bridge: &Bridge| {
            let (modes, _) = modes(bridge, 6).expect("modes");
            let share = modes.iter().map(|mode| mode.vertical_share).fold(0.0, f64::max);
            (share - 1.0).abs()
        };
        let right = miss(&bridge);
        bridge.modules[0].wet_m = None;
        let wrong = miss(&bridge);
        assert!(right <= 4e-2 && wrong > 4e-2, "{right:e} {wrong:e}");
    }

    #[test]
    fn the_largest_component_becomes_one_whatever_its_sign() {
        let found = largest_made_one(vec![[1.0, -4.0, 2.0], [0.0, 4.0, 0.0]]);
        assert_eq!(found, [[-0.25, 1.0, -0.5], [0.0, -1.0, 0.0]]);
        assert_eq!(largest_made_one(vec![[0.0; 3]]), [[0.0; 3]]);
    }
}
