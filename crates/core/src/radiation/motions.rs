//! Groups of motions of a chain that do not drive each other through the water.
//!
//! Knows modules in a row that hinge at their ends, and their mirror. Does not know kernels.

use super::{FREEDOMS_PER_MODULE, Scales};
use nalgebra::DMatrix;

/// Orthonormal bases of groups of motions, in [scaled](Scales) freedoms: a column a motion; each with whether its motions are
/// rolls.
///
/// The groups are heave with pitch, and roll: the hull is symmetric about y = 0. Heave and pitch are those of modules whose
/// bottoms meet at the N + 1 joints, of heights h_j: `heave_m = (h_m + h_(m+1)) / 2`, `pitch_m = (h_m - h_(m+1)) / L_m`. What
/// breaks the bottom line at a joint is not among them. Roll is each module's own. Where the lengths are mirror-equal each
/// group is split into motions that the mirror x -> -x keeps and motions that it turns.
pub(super) fn groups(scales: &Scales) -> Vec<(bool, DMatrix<f64>)> {
    let modules = scales.length_m().len();
    let rms_m = scales.rms_m();
    let mut heights = DMatrix::zeros(scales.freedoms(), modules + 1);
    let mut rolls = DMatrix::zeros(scales.freedoms(), modules);
    for (m, length_m) in scales.length_m().iter().enumerate() {
        let heave = FREEDOMS_PER_MODULE * m;
        for (joint, sign) in [(m, 1.0), (m + 1, -1.0)] {
            heights[(heave, joint)] = 0.5;
            heights[(heave + 1, joint)] = sign / length_m * rms_m[heave + 1];
        }
        rolls[(heave + 2, m)] = 1.0;
    }
    let parts = [(false, heights), (true, rolls)]
        .into_iter()
        .flat_map(|(rolls, motions)| {
            if scales.mirror_equal() {
                vec![(rolls, paired(&motions, 1.0)), (rolls, paired(&motions, -1.0))]
            } else {
                vec![(rolls, motions)]
            }
        });
    parts
        .filter(|(_, motions)| motions.ncols() > 0)
        .map(|(rolls, motions)| (rolls, motions.qr().q()))
        .collect()
}

/// Each column with `sign` times the one that takes its place in the mirror; the middle one goes with the sign +.
fn paired(motions: &DMatrix<f64>, sign: f64) -> DMatrix<f64> {
    let count = motions.ncols();
    let columns = if sign > 0.0 { count.div_ceil(2) } else { count / 2 };
    DMatrix::from_fn(motions.nrows(), columns, |i, j| {
        motions[(i, j)] + sign * motions[(i, count - 1 - j)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_orthonormal_and_keep_or_turn_in_the_mirror() {
        let scales = Scales::new(&[4.0, 6.0, 6.0, 4.0], 3.0).unwrap();
        let groups: Vec<_> = groups(&scales).into_iter().map(|(_, basis)| basis).collect();
        let sizes: Vec<usize> = groups.iter().map(DMatrix::ncols).collect();
        assert_eq!(sizes, [3, 2, 2, 2]);
        let all = DMatrix::from_fn(12, 9, |i, j| {
            let group = [0, 0, 0, 1, 1, 2, 2, 3, 3][j];
            groups[group][(i, j - [0, 3, 5, 7][group])]
        });
        assert!((all.transpose() * &all - DMatrix::identity(9, 9)).amax() < 1e-14);
        for (group, sign) in groups.iter().zip([1.0, -1.0, 1.0, -1.0]) {
            let outer = group * group.transpose();
            assert!((scales.mirrored(&outer) - &outer).amax() < 1e-14);
            // a motion's image: the mirror acts on rows alone
            for motion in group.column_iter() {
                for (i, &value) in motion.iter().enumerate() {
                    let turned = if i % 3 == 1 { -1.0 } else { 1.0 };
                    assert!((motion[9 - i / 3 * 3 + i % 3] * turned - sign * value).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn rigid_heave_and_pitch_of_the_whole_chain_are_among_them() {
        let scales = Scales::new(&[4.0, 5.0, 3.0], 3.0).unwrap();
        let groups: Vec<_> = groups(&scales).into_iter().map(|(_, basis)| basis).collect();
        assert_eq!(groups.iter().map(DMatrix::ncols).collect::<Vec<_>>(), [4, 3]);
        let centres = [2.0, 6.5, 10.5];
        // rotation about +y: z falls with x
        let left = |sign: f64| {
            let rigid = DMatrix::from_fn(9, 1, |i, _| match i % 3 {
                0 => -centres[i / 3],
                1 => sign * scales.rms_m()[i],
                _ => 0.0,
            });
            (&rigid - &groups[0] * (groups[0].transpose() * &rigid)).norm()
        };
        assert!(left(1.0) < 1e-13);
        assert!(left(0.95) > 1e-3);
        assert!(left(-1.0) > 0.1);
    }
}
