//! Symmetric matrices as lists of their upper triangles, row by row.
//!
//! Knows where an entry stands. Does not know what the entries mean.

/// Number of entries of the upper triangle of a matrix of an order.
pub fn triangle_length(order: usize) -> usize {
    order * (order + 1) / 2
}

/// The whole matrix, row by row, of an upper triangle; entries that the list does not have are 0.
pub fn full(order: usize, triangle: &[f64]) -> Vec<f64> {
    let mut whole = vec![0.0; order * order];
    let places = (0..order).flat_map(|i| (i..order).map(move |j| (i, j)));
    for ((i, j), &entry) in places.zip(triangle) {
        whole[i * order + j] = entry;
        whole[j * order + i] = entry;
    }
    whole
}

/// The upper triangle of the symmetric part of a whole matrix.
pub fn symmetric_part(order: usize, whole: &[f64]) -> Vec<f64> {
    let places = (0..order).flat_map(|i| (i..order).map(move |j| (i, j)));
    places
        .map(|(i, j)| (whole[i * order + j] + whole[j * order + i]) / 2.0)
        .collect()
}

/// The largest difference between an entry and its mirror image over the largest entry, each entry over the lengths of its two
/// freedoms; 0 of a matrix of zeros.
pub fn asymmetry(lengths: &[f64], whole: &[f64]) -> f64 {
    let order = lengths.len();
    let (mut difference, mut largest) = (0.0_f64, 0.0_f64);
    for i in 0..order {
        for j in 0..order {
            let scale = lengths[i] * lengths[j];
            let (entry, image) = (whole[i * order + j], whole[j * order + i]);
            difference = difference.max((entry - image).abs() / scale);
            largest = largest.max(entry.abs() / scale);
        }
    }
    if largest > 0.0 { difference / largest } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_the_matrix_and_the_matrix_is_the_triangle() {
        let triangle: Vec<f64> = (1..=6).map(f64::from).collect();
        let whole = full(3, &triangle);
        assert_eq!(whole, [1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0]);
        assert_eq!(symmetric_part(3, &whole), triangle);
        assert_eq!(triangle_length(45), 1035);
    }

    #[test]
    fn asymmetry_is_over_the_largest_entry_in_one_unit() {
        assert_eq!(asymmetry(&[1.0, 1.0], &[4.0, 1.0, 3.0, 2.0]), 0.5);
        // pitch over a length of 2 m: entries 4, 0.5, 1.5, 0.5
        assert_eq!(asymmetry(&[1.0, 2.0], &[4.0, 1.0, 3.0, 2.0]), 0.25);
        assert_eq!(asymmetry(&[1.0, 1.0], &[0.0; 4]), 0.0);
    }
}
