//! What the Jacobian at the best point says of the parameters: standard errors, correlation, undetermined directions.
//!
//! With the parameters in widths between their bounds and the singular value decomposition `J = U diag(w) V^T`,
//!
//! ```text
//! covariance = s^2 (J^T J)^-1 = s^2 sum_k v_k v_k^T / w_k^2,    s^2 = sum of squares / (n - p)
//! ```
//!
//! (Bjorck, Numerical Methods for Least Squares Problems, 1996, chapters 1 and 9; Press et al., Numerical Recipes, 3rd
//! ed., 15.4.2 and 15.6; scaled by s^2 as lmfit does, "scale_covar"). A direction `v_k` is undetermined if `w_k` is
//! below a share of the largest, or if its own standard error `s / w_k` is wider than the bounds are apart. One below the
//! share, which differences cannot tell from zero, is left out of the sum (as Numerical Recipes 15.4.2 does), and a
//! parameter with a part in it gets no standard error; nor does one whose error is wider than its bounds are apart. n
//! residuals, p parameters not held at a bound; for n <= p there is no s^2, and 1 is taken: residuals scaled by true
//! deviations.
//!
//! Knows columns of numbers. Does not know the model, the search, or the parameters' units.

use nalgebra::DMatrix;

/// A parameter is part of an undetermined direction if its component is this large; the components' squares sum to 1.
const PART: f64 = 0.01;

/// Variance of a scaled residual that standard errors are built on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorScale {
    /// Estimated from the residuals at the best point: `s^2 = sum of squares / (n - p)`.
    Estimated {
        /// s^2.
        variance: f64,
        /// n - p.
        degrees_of_freedom: usize,
    },
    /// No more residuals than free parameters: 1, as if the residuals were scaled by their true standard deviations.
    Assumed,
}

impl ErrorScale {
    /// Takes s^2 from the sum of squares of `count` residuals and the number of free parameters.
    fn of(count: usize, free: usize, sum_of_squares: f64) -> Self {
        match count.checked_sub(free) {
            None | Some(0) => Self::Assumed,
            Some(degrees_of_freedom) => Self::Estimated {
                variance: sum_of_squares / degrees_of_freedom as f64,
                degrees_of_freedom,
            },
        }
    }

    /// s^2.
    pub fn variance(self) -> f64 {
        match self {
            Self::Estimated { variance, .. } => variance,
            Self::Assumed => 1.0,
        }
    }
}

/// Share of a parameter in a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// Index of the parameter.
    pub parameter: usize,
    /// Its component, in widths between its bounds; the largest of a direction is positive.
    pub component: f64,
}

/// A direction in the space of the parameters in widths between their bounds, of length 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterDirection {
    /// Singular value: norm of the change of the residuals for a step of length 1.
    pub singular_value: f64,
    /// Its share of the largest singular value; zero if all are.
    pub share_of_largest: f64,
    /// Parameters with a part of 0.01 or more, the largest part first.
    pub components: Vec<Component>,
}

/// Statistics of the free parameters, in widths between their bounds.
pub(super) struct FitStatistics {
    /// Standard errors; `None` for a parameter that is part of an undetermined direction.
    pub standard_errors: Vec<Option<f64>>,
    /// Correlation; `None` where one of the two has no standard error, or where it is zero.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Where s^2 is from.
    pub error_scale: ErrorScale,
    /// Singular values, descending.
    pub singular_values: Vec<f64>,
    /// Directions that are undetermined, the best determined first.
    pub undetermined: Vec<ParameterDirection>,
}

/// Statistics from the Jacobian's `columns` (one for each free parameter, in the order of `indices`, each with one
/// entry for each of the `count` residuals) and the sum of squares.
pub(super) fn statistics(
    columns: &[&[f64]],
    indices: &[usize],
    count: usize,
    sum_of_squares: f64,
    undetermined_share: f64,
) -> FitStatistics {
    let free = columns.len();
    let error_scale = ErrorScale::of(count, free, sum_of_squares);
    let (singular_values, directions) = decomposition(columns, count);
    let largest = singular_values.first().copied().unwrap_or(0.0);
    let deviation = error_scale.variance().sqrt();

    let mut covariance = Covariance::zero(free);
    let mut undetermined = Vec::new();
    for (&w, v) in singular_values.iter().zip(&directions) {
        let part: Vec<usize> = (0..free).filter(|&k| v[k].abs() >= PART).collect();
        let is_null = w <= undetermined_share * largest;
        if is_null {
            covariance.leave_out(&part);
        } else {
            covariance.add(w, v, deviation);
        }
        if is_null || deviation > w {
            undetermined.push(direction(w, largest, v, part, indices));
        }
    }
    let standard_errors = covariance.standard_errors();
    FitStatistics {
        correlation: covariance.correlation(&standard_errors),
        standard_errors,
        error_scale,
        singular_values,
        undetermined,
    }
}

/// Covariance of the free parameters, summed over directions.
struct Covariance {
    sum: Vec<Vec<f64>>,
    /// False for a parameter with a part in a direction that was left out.
    has_error: Vec<bool>,
}

impl Covariance {
    /// Begins the sum for as many free parameters.
    fn zero(free: usize) -> Self {
        Self {
            sum: vec![vec![0.0; free]; free],
            has_error: vec![true; free],
        }
    }

    /// Adds the direction `v` of singular value `w`; `deviation` is s.
    fn add(&mut self, w: f64, v: &[f64], deviation: f64) {
        for (i, row) in self.sum.iter_mut().enumerate() {
            for (j, sum) in row.iter_mut().enumerate() {
                *sum += (deviation * v[i] / w) * (deviation * v[j] / w);
            }
        }
    }

    /// Leaves out a direction that the parameters of `part` have a part in.
    fn leave_out(&mut self, part: &[usize]) {
        part.iter().for_each(|&k| self.has_error[k] = false);
    }

    /// Gives [`FitStatistics::standard_errors`].
    fn standard_errors(&self) -> Vec<Option<f64>> {
        (0..self.sum.len())
            .map(|k| Some(self.sum[k][k].sqrt()).filter(|error| self.has_error[k] && *error <= 1.0))
            .collect()
    }

    /// Gives [`FitStatistics::correlation`].
    fn correlation(&self, standard_errors: &[Option<f64>]) -> Vec<Vec<Option<f64>>> {
        let correlation = |i: usize, j: usize| {
            let product = standard_errors[i]? * standard_errors[j]?;
            (product > 0.0).then(|| {
                if i == j {
                    1.0
                } else {
                    (self.sum[i][j] / product).clamp(-1.0, 1.0)
                }
            })
        };
        let free = self.sum.len();
        (0..free)
            .map(|i| (0..free).map(|j| correlation(i, j)).collect())
            .collect()
    }
}

/// Singular values, descending, and the right singular vectors; as many as columns, however few the rows are.
fn decomposition(columns: &[&[f64]], count: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let free = columns.len();
    if free == 0 {
        return (Vec::new(), Vec::new());
    }
    let rows = count.max(free);
    let matrix = DMatrix::from_fn(rows, free, |row, k| columns[k].get(row).copied().unwrap_or(0.0));
    let decomposed = matrix.svd(false, true);
    let values = decomposed.singular_values.iter().copied().collect();
    let vectors = decomposed
        .v_t
        .map(|v_t| v_t.row_iter().map(|row| row.iter().copied().collect()).collect());
    (values, vectors.unwrap_or_default())
}

fn direction(w: f64, largest: f64, v: &[f64], mut part: Vec<usize>, indices: &[usize]) -> ParameterDirection {
    part.sort_by(|&a, &b| v[b].abs().total_cmp(&v[a].abs()));
    let sign = part.first().map_or(1.0, |&k| v[k].signum());
    ParameterDirection {
        singular_value: w,
        share_of_largest: if largest > 0.0 { w / largest } else { 0.0 },
        components: part
            .into_iter()
            .map(|k| Component {
                parameter: indices[k],
                component: sign * v[k],
            })
            .collect(),
    }
}
