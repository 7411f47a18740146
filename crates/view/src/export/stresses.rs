//! Stresses of shells and forces of beams as arrays of the mesh's cells, and their envelope over a crossing.
//!
//! Knows which array says what, and keeps the largest of each shell. Does not know how a stress is found.

use super::vtk::{Array, VtkValues};
use pontoon_core::bridge::BridgeStresses;
use pontoon_core::fem::{BeamForces, ShellStress, von_mises_pa};
use serde_json::{Value, json};

/// A number of a shell's stress, under its name.
type OfShell = (&'static str, fn(&ShellStress) -> f64);

/// A number of a beam's forces, under its name.
type OfBeam = (&'static str, fn(&BeamForces) -> f64);

/// The arrays of shells.
const OF_SHELLS: [OfShell; 9] = [
    ("membrane_11_pa", |s| s.membrane_pa[0]),
    ("membrane_22_pa", |s| s.membrane_pa[1]),
    ("membrane_12_pa", |s| s.membrane_pa[2]),
    ("bending_11_pa", |s| s.bending_pa[0]),
    ("bending_22_pa", |s| s.bending_pa[1]),
    ("bending_12_pa", |s| s.bending_pa[2]),
    ("von_mises_top_pa", |s| von_mises_pa(s.top_pa())),
    ("von_mises_bottom_pa", |s| von_mises_pa(s.bottom_pa())),
    (VON_MISES, ShellStress::von_mises_pa),
];

/// The arrays of beams.
const OF_BEAMS: [OfBeam; 6] = [
    ("axial_force_n", |f| f.axial_n),
    ("shear_2_n", |f| f.shear_n[0]),
    ("shear_3_n", |f| f.shear_n[1]),
    ("torque_newton_m", |f| f.torque_newton_m),
    ("moment_2_newton_m", |f| f.bending_newton_m[0]),
    ("moment_3_newton_m", |f| f.bending_newton_m[1]),
];

/// The larger of both sides' von Mises stresses, and when it was largest.
const VON_MISES: &str = "von_mises_pa";
const VON_MISES_TIME: &str = "von_mises_time_s";

/// Arrays of the mesh's cells, shells before beams. A number of shells is 0 of a beam, and the other way round. Stresses are
/// in single precision, forces in double.
pub(super) fn arrays(stresses: &BridgeStresses) -> Vec<Array> {
    let (shells, beams) = (&stresses.shells, &stresses.beams);
    let of_shells = OF_SHELLS.map(|(name, of)| stress_array(name, shells.iter().map(of), beams.len()));
    let of_beams = OF_BEAMS.map(|(name, of)| {
        let own = beams.iter().map(of);
        Array::new(name, VtkValues::F64(shells.iter().map(|_| 0.0).chain(own).collect()))
    });
    of_shells.into_iter().chain(of_beams).collect()
}

fn stress_array(name: &'static str, of_shells: impl Iterator<Item = f64>, beams: usize) -> Array {
    let all = of_shells.chain(std::iter::repeat_n(0.0, beams));
    Array::new(name, VtkValues::F32(all.map(|x| x as f32).collect()))
}

/// The largest von Mises stress of each shell so far, and when it was.
#[derive(Debug, Default)]
pub(super) struct StressEnvelope {
    largest_pa: Vec<f64>,
    time_s: Vec<f64>,
    beams: usize,
    /// States that were looked at.
    states: usize,
}

impl StressEnvelope {
    /// Looks at the stresses of one time; of equal ones the first counts.
    pub(super) fn look_at(&mut self, time_s: f64, stresses: &BridgeStresses) {
        let now_pa = stresses.shells.iter().map(ShellStress::von_mises_pa);
        if self.states == 0 {
            self.largest_pa = now_pa.collect();
            self.time_s = vec![time_s; self.largest_pa.len()];
            self.beams = stresses.beams.len();
        } else {
            let kept = self.largest_pa.iter_mut().zip(&mut self.time_s);
            for ((largest_pa, at_s), now_pa) in kept.zip(now_pa) {
                if now_pa > *largest_pa {
                    (*largest_pa, *at_s) = (now_pa, time_s);
                }
            }
        }
        self.states += 1;
    }

    /// Number of states that were looked at.
    pub(super) fn states(&self) -> usize {
        self.states
    }

    /// Arrays of the mesh's cells, 0 of a beam.
    pub(super) fn arrays(&self) -> Vec<Array> {
        let times = self.time_s.iter().copied().chain(std::iter::repeat_n(0.0, self.beams));
        vec![
            stress_array(VON_MISES, self.largest_pa.iter().copied(), self.beams),
            Array::new(VON_MISES_TIME, VtkValues::F64(times.collect())),
        ]
    }
}

/// What the arrays say, for the folder's own words.
pub(super) fn words() -> Value {
    json!({
        "axes": "1 and 2 of a shell: x and y of deck and bottom, x and z of sides and longitudinal walls, y and z of end and transverse walls; \
                 its top is the side of the normal 1 x 2: up, to negative y, to positive x. \
                 1 of a beam along it, 2 up (of a post along x), 3 = 1 x 2",
        "membrane_11_pa, membrane_22_pa, membrane_12_pa": "stress in the mean plane at the centre of a shell, tension positive [Pa]",
        "bending_11_pa, bending_22_pa, bending_12_pa": "stress of bending at its top, the opposite at its bottom [Pa]",
        "von_mises_top_pa, von_mises_bottom_pa": "von Mises stress of membrane and bending together at top and bottom [Pa]",
        VON_MISES: "the larger of the two; in an envelope the largest over all time steps [Pa]",
        VON_MISES_TIME: "when it was largest [s]",
        "axial_force_n": "at the middle of a beam, tension positive [N]",
        "shear_2_n, shear_3_n": "forces at the middle of a beam along its axes 2 and 3, on the side of its second end [N]",
        "torque_newton_m, moment_2_newton_m, moment_3_newton_m": "moments at the middle of a beam about its axes 1, 2 and 3 [N m]",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniaxial(stresses_pa: &[f64]) -> BridgeStresses {
        let shell = |&pa: &f64| ShellStress {
            membrane_pa: [pa, 0.0, 0.0],
            bending_pa: [0.0; 3],
        };
        BridgeStresses {
            shells: stresses_pa.iter().map(shell).collect(),
            beams: vec![BeamForces::default()],
        }
    }

    #[test]
    fn an_envelope_keeps_the_first_of_the_largest_with_its_time() {
        let mut envelope = StressEnvelope::default();
        for (time_s, stresses_pa) in [
            (-0.5, [0.0, 0.0]),
            (1.0, [-3.0, 2.0]),
            (2.0, [3.0, -4.0]),
            (3.0, [1.0, 0.0]),
        ] {
            envelope.look_at(time_s, &uniaxial(&stresses_pa));
        }
        assert_eq!(
            (&envelope.largest_pa, &envelope.time_s),
            (&vec![3.0, 4.0], &vec![1.0, 2.0])
        );
        assert_eq!((envelope.states(), envelope.arrays().len()), (4, 2));
    }

    #[test]
    fn every_array_has_an_entry_for_each_cell_and_words() {
        let arrays = arrays(&uniaxial(&[1.0, 2.0, 3.0]));
        let words = words().to_string();
        for array in &arrays {
            assert_eq!(array.len(), 4, "{}", array.name());
            assert!(words.contains(array.name()), "{}", array.name());
        }
    }
}
