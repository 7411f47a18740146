//! The cubic spline through matrices over a frequency.
//!
//! Knows knots and values. Does not know what the matrices are.

use crate::input::InvalidInput;
use nalgebra::DMatrix;

/// The least number of knots.
const KNOTS: usize = 3;

/// A cubic spline with two continuous derivatives through a matrix at each knot.
///
/// At its left end the third derivative is continuous over the second knot (not-a-knot), at its right end the slope is 0
/// (clamped). Between knots, with t in 0..1 over a piece of width d, values y and slopes s at its ends, it is Hermite's cubic
/// `(1 + 2 t)(1 - t)^2 y0 + t (1 - t)^2 d s0 + t^2 (3 - 2 t) y1 + t^2 (t - 1) d s1`. Source: C. de Boor, A Practical Guide to
/// Splines (2001), ch. IV.
#[derive(Debug, Clone)]
pub struct MatrixSpline {
    knots: Vec<f64>,
    values: Vec<DMatrix<f64>>,
    slopes: Vec<DMatrix<f64>>,
}

impl MatrixSpline {
    /// The spline through `values[i]` at the rising `knots[i]`, at least three; all values have one shape.
    ///
    /// # Errors
    /// [`InvalidInput`] on `knots` or `values`.
    pub fn new(knots: Vec<f64>, values: Vec<DMatrix<f64>>) -> Result<Self, InvalidInput> {
        if knots.len() < KNOTS {
            return Err(InvalidInput::new("knots", knots.len(), format!("at least {KNOTS}")));
        }
        if let Some(i) = (1..knots.len()).find(|&i| !(knots[i - 1] < knots[i] && knots[i].is_finite())) {
            return Err(InvalidInput::new(
                format!("knots[{i}]"),
                knots[i],
                "finite numbers that rise",
            ));
        }
        let shape = values.first().map(DMatrix::shape);
        if values.len() != knots.len() || values.iter().any(|value| Some(value.shape()) != shape) {
            let allowed = format!("{} matrices of one shape", knots.len());
            return Err(InvalidInput::new("values", values.len(), allowed));
        }
        let slopes = slopes(&knots, &values);
        Ok(Self { knots, values, slopes })
    }

    /// The matrix at `x`. An `x` beyond the knots is taken at the nearest of them.
    pub fn at(&self, x: f64) -> DMatrix<f64> {
        let last = self.knots.len() - 1;
        let x = x.clamp(self.knots[0], self.knots[last]);
        let i = self.knots[1..last].partition_point(|&knot| knot <= x);
        let d = self.knots[i + 1] - self.knots[i];
        let t = (x - self.knots[i]) / d;
        let u = 1.0 - t;
        let (y0, y1) = ((1.0 + 2.0 * t) * u * u, t * t * (3.0 - 2.0 * t));
        let (s0, s1) = (t * u * u * d, -t * t * u * d);
        let (y, s) = (&self.values[i..], &self.slopes[i..]);
        &y[0] * y0 + &y[1] * y1 + &s[0] * s0 + &s[1] * s1
    }
}

/// Slopes at the knots. Row i says that the second derivative is continuous, `d_i s_(i-1) + 2 (d_(i-1) + d_i) s_i + d_(i-1) s_(i+1)
/// = 3 (d_i m_(i-1) + d_(i-1) m_i)` with the widths d and the chords' slopes m; the first row is that of not-a-knot. Elimination
/// without pivots: the first row leaves the second `d_0 + d_1` on its diagonal, all later rows dominate theirs.
fn slopes(knots: &[f64], values: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
    let n = knots.len();
    let d: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let m: Vec<DMatrix<f64>> = (0..n - 1).map(|i| (&values[i + 1] - &values[i]) / d[i]).collect();
    let two = d[0] + d[1];
    // row i: pivots[i] s_i + uppers[i] s_(i+1) = rights[i]
    let (mut pivots, mut uppers) = (vec![d[1]], vec![two]);
    let mut rights = vec![&m[0] * ((d[0] + 2.0 * two) * d[1] / two) + &m[1] * (d[0] * d[0] / two)];
    for i in 1..n - 1 {
        let right = &m[i - 1] * (3.0 * d[i]) + &m[i] * (3.0 * d[i - 1]);
        let factor = d[i] / pivots[i - 1];
        pivots.push(2.0 * (d[i - 1] + d[i]) - factor * uppers[i - 1]);
        uppers.push(d[i - 1]);
        rights.push(right - &rights[i - 1] * factor);
    }
    let mut slopes = vec![DMatrix::zeros(values[0].nrows(), values[0].ncols()); n];
    for i in (0..n - 1).rev() {
        slopes[i] = (&rights[i] - &slopes[i + 1] * uppers[i]) / pivots[i];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Knots, values, places, values there.
    type Case<'a> = (&'a [f64], &'a [[f64; 2]], &'a [f64], &'a [[f64; 2]]);

    fn scalar(x: f64) -> DMatrix<f64> {
        DMatrix::from_element(1, 1, x)
    }

    #[test]
    fn a_cubic_with_a_flat_end_is_its_own_spline() {
        let y = |x: f64| 2.0 - (x - 3.0).powi(2) + 0.7 * (x - 3.0).powi(3);
        let knots = vec![0.0, 0.2, 0.9, 1.0, 2.5, 3.0];
        let of = |factor: f64| {
            let values = knots
                .iter()
                .enumerate()
                .map(|(i, &x)| scalar(y(x) * if i == 3 { factor } else { 1.0 }));
            MatrixSpline::new(knots.clone(), values.collect()).unwrap()
        };
        let error = |spline: &MatrixSpline| {
            let places = (0..=300).map(|i| f64::from(i) * 0.01);
            places.map(|x| (spline.at(x)[(0, 0)] - y(x)).abs()).fold(0.0, f64::max)
        };
        assert!(error(&of(1.0)) < 1e-13, "{}", error(&of(1.0)));
        assert!(error(&of(1.05)) > 0.1);
        assert_eq!(of(1.0).at(4.0), scalar(2.0));
    }

    #[test]
    fn it_is_the_spline_of_scipy() {
        // SciPy 1.17.1, numpy.random.default_rng(22): CubicSpline(x, y, bc_type=('not-a-knot', 'clamped'))
        let cases: [Case; 2] = [
            (
                &[
                    0.5756294261983129,
                    1.2954199659380388,
                    2.3812549503084948,
                    2.985690790835654,
                    4.24574596940598,
                    5.53519245403235,
                    6.4198915227213105,
                ][..],
                &[
                    [1.262471915715962, -0.3554606257110515],
                    [-0.7009360866758073, 0.47211462069079746],
                    [1.214557665204409, 2.1555312784012925],
                    [0.8918114927656495, 1.5938426657452487],
                    [-0.4502915670052033, -0.8742169837210243],
                    [-1.7197732539160488, -1.1537025867459945],
                    [-0.36343371651604817, 0.1929947220841547],
                ][..],
                &[
                    0.9656530076062422,
                    1.670469285764009,
                    2.9881968326246726,
                    3.568894251841324,
                    4.477001566117873,
                    5.53343036371185,
                ][..],
                &[
                    [-0.4747959162720532, -0.09067262440702516],
                    [-0.1359427715444329, 1.2430611387081048],
                    [0.8892274288616361, 1.5896401825569229],
                    [0.3455172141362592, 0.44806770574757354],
                    [-0.835123992993085, -1.2007520663240037],
                    [-1.7216622997360371, -1.1564261904738553],
                ][..],
            ),
            (
                &[3.4091789104540924, 3.673490622788793, 5.183323002160759][..],
                &[
                    [1.8378244304667402, -0.5783508965433001],
                    [1.1887040918656822, 1.42327388117323],
                    [-2.324401356345807, 1.3509748934963017],
                ][..],
                &[
                    3.4559770880630096,
                    3.5637201390609885,
                    3.7387955877567602,
                    4.153549407187149,
                    4.387201761094629,
                    4.578072495987433,
                ][..],
                &[
                    [1.7367052387073119, -0.13733867615623843],
                    [1.4797936529998437, 0.731867619468359],
                    [1.0041533131143952, 1.7495223352799532],
                    [-0.2688272159563596, 2.6262559394851195],
                    [-0.9732417305273804, 2.474397095885193],
                    [-1.4855898136676027, 2.170830743291389],
                ][..],
            ),
        ];
        for (knots, values, places, expected) in cases {
            let of = |factor: f64| {
                let mut y: Vec<_> = values.iter().map(|y| DMatrix::from_row_slice(1, 2, y)).collect();
                y[1] *= factor;
                MatrixSpline::new(knots.to_vec(), y).unwrap()
            };
            let error = |spline: &MatrixSpline| {
                let errors = places
                    .iter()
                    .zip(expected)
                    .map(|(&x, y)| (spline.at(x) - DMatrix::from_row_slice(1, 2, y)).amax());
                errors.fold(0.0, f64::max)
            };
            assert!(error(&of(1.0)) < 1e-12, "{}", error(&of(1.0)));
            assert!(error(&of(1.05)) > 1e-3);
        }
    }

    #[test]
    fn what_is_no_spline_is_refused() {
        let key = |knots: &[f64], n: usize| MatrixSpline::new(knots.to_vec(), vec![scalar(1.0); n]).unwrap_err().key;
        assert_eq!(key(&[0.0, 1.0], 2), "knots");
        assert_eq!(key(&[0.0, 1.0, 1.0], 3), "knots[2]");
        assert_eq!(key(&[0.0, 1.0, 2.0], 2), "values");
    }
}
