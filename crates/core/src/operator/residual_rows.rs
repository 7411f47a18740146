//! What the modes leave out: residual flexibilities between rows of the bridge (O3).
//!
//! Knows rows, modes and a factor. Does not know which rows are connectors and which are looked at.
//!
//! Work is cut into blocks of one size on any number of threads, so that these do not change a bit.

use super::columns::{ColumnSolver, SOLVED_AT_ONCE};
use crate::bridge::Track;
use crate::fem::{FemError, SparseRow, go_on};
use crate::stop::Stop;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, Par};
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Rows with their values on the modes and their flexibility.
pub(super) struct ResidualRows<'a> {
    rows: Vec<SparseRow>,
    /// Their values on the modes.
    pub(super) phi: DMatrix<f64>,
    /// `K^-1` of each.
    solved: Columns,
    /// lambda of the modes with the shift of K.
    shifted: Vec<f64>,
    shapes: &'a Mat<f64>,
    stop: Stop<'a>,
}

impl<'a> ResidualRows<'a> {
    /// Rows on the modes `shapes` of eigenvalues lambda; `solver` is that of K with a shift.
    ///
    /// # Errors
    /// [`FemError::Stopped`], as of everything here that may fail.
    pub(super) fn new(
        solver: &ColumnSolver<'_>,
        rows: Vec<SparseRow>,
        (lambda, shift): (&[f64], f64),
        shapes: &'a Mat<f64>,
        stop: Stop<'a>,
    ) -> Result<Self, FemError> {
        Ok(Self {
            phi: DMatrix::from_fn(rows.len(), lambda.len(), |i, k| dot(&rows[i], shapes, k)),
            solved: Columns::solved(solver, &rows)?,
            rows,
            shifted: lambda.iter().map(|lambda| lambda + shift).collect(),
            shapes,
            stop,
        })
    }

    /// R between a row with its values `own` on the modes and these from `first` on, as many as `r` has room for.
    fn between(&self, row: &SparseRow, own: &[f64], first: usize, r: &mut [f64]) {
        Arch::new().dispatch(SumsOfModes(self, own, first, r));
        for (j, r) in (first..).zip(r) {
            *r = row.dot(self.solved.column(j)) - *r;
        }
    }

    /// What the modes have: `sum of own phi / (lambda + shift)`.
    #[inline(always)]
    fn of_modes(&self, own: &[f64], first: usize, sums: &mut [f64]) {
        let (rows, many) = (self.rows.len(), sums.len());
        sums.fill(-0.0);
        for (k, (own, shifted)) in own.iter().zip(&self.shifted).enumerate() {
            let phi = &self.phi.as_slice()[k * rows + first..][..many];
            for (sum, phi) in sums.iter_mut().zip(phi) {
                *sum += own * phi / shifted;
            }
        }
    }

    /// R of the rows of one range with those of another, the latter's in a row each.
    pub(super) fn among(&self, first: usize, count: usize, of: usize, many: usize) -> DMatrix<f64> {
        let row = |i: usize| {
            let own: Vec<f64> = self.phi.row(first + i).iter().copied().collect();
            let mut r = vec![0.0; many];
            self.between(&self.rows[first + i], &own, of, &mut r);
            r
        };
        let rows: Vec<Vec<f64>> = (0..count).into_par_iter().map(row).collect();
        DMatrix::from_fn(count, many, |i, j| rows[i][j])
    }

    /// R of these rows with the first so many of another list.
    pub(super) fn seen_by(&self, others: &ResidualRows<'_>, many: usize) -> DMatrix<f64> {
        let row = |i: usize| {
            let own: Vec<f64> = self.phi.row(i).iter().copied().collect();
            let mut r = vec![0.0; many];
            others.between(&self.rows[i], &own, 0, &mut r);
            r
        };
        let rows: Vec<Vec<f64>> = (0..self.rows.len()).into_par_iter().map(row).collect();
        DMatrix::from_fn(self.rows.len(), many, |i, j| rows[i][j])
    }

    /// R of a row with itself.
    pub(super) fn own(&self, i: usize) -> f64 {
        self.among(i, 1, i, 1)[(0, 0)]
    }

    /// For each track column its influence: `phi`, then R with all rows.
    pub(super) fn deck(&self, track: &Track) -> Result<Vec<f64>, FemError> {
        let (m, many) = (self.shifted.len(), self.rows.len());
        let (width, scaled) = (m + many, self.scaled_modes());
        let mut deck = vec![0.0; track.columns() * width];
        let blocks = deck.par_chunks_mut(width.max(1) * BLOCK).enumerate();
        blocks.try_for_each(|(block, of_block)| {
            go_on(self.stop)?;
            let node = |c: usize| track.dof(block * BLOCK + c);
            for (c, influence) in of_block.chunks_exact_mut(width).enumerate() {
                let (phi, sums) = influence.split_at_mut(m);
                for (k, phi) in phi.iter_mut().enumerate() {
                    *phi = self.shapes[(node(c), k)];
                }
                if scaled.is_none() {
                    Arch::new().dispatch(SumsOfModes(self, phi, 0, sums));
                }
            }
            if let Some(scaled) = &scaled {
                sum_all_modes(scaled, of_block, width);
            }
            // column by column: neighbouring nodes stand close together in it
            for j in 0..many {
                let column = self.solved.column(j);
                for (c, influence) in of_block.chunks_exact_mut(width).enumerate() {
                    influence[m + j] = column[node(c)] - influence[m + j];
                }
            }
            Ok(())
        })?;
        Ok(deck)
    }

    /// `phi / (lambda + shift)`, rows x modes; none where so few modes are summed one by one.
    fn scaled_modes(&self) -> Option<Mat<f64>> {
        let entry = |i: usize, k: usize| self.phi[(i, k)] / self.shifted[k];
        let m = self.shifted.len();
        (m > ONE_BY_ONE).then(|| Mat::from_fn(self.rows.len(), m, entry))
    }
}

/// The sums of influences over all modes, put behind their values on these.
fn sum_all_modes(scaled: &Mat<f64>, influences: &mut [f64], width: usize) {
    let (m, count) = (scaled.ncols(), influences.len() / width);
    let (own, sums) = MatMut::from_column_major_slice_mut(influences, width, count).split_at_row_mut(m);
    matmul(sums, Accum::Replace, scaled.as_ref(), own.as_ref(), 1.0, Par::Seq);
}

/// R among the deck's nodes: for each column `lines * (2 near + 1)` numbers.
pub(super) fn residual_of_deck(
    solver: &ColumnSolver<'_>,
    track: &Track,
    shapes: &Mat<f64>,
    (lambda, shift): (&[f64], f64),
    near: usize,
) -> Result<Vec<f64>, FemError> {
    let (lines, stations, width) = (track.lines(), track.stations(), 2 * near + 1);
    let mut all = vec![0.0; lines * stations * lines * width];
    // phi / sqrt(lambda + shift), mode after mode
    let nodes = lines * stations;
    let mut scaled = vec![0.0; lambda.len() * nodes];
    scaled
        .par_chunks_mut(nodes.max(1))
        .enumerate()
        .for_each(|(k, of_mode)| {
            let root = (lambda[k] + shift).sqrt();
            for (c, scaled) in of_mode.iter_mut().enumerate() {
                *scaled = shapes[(track.dof(c), k)] / root;
            }
        });
    let of_line = stations * lines * width;
    let blocks = all.chunks_exact_mut(of_line.max(1)).enumerate().flat_map(|(line, r)| {
        let blocks = r.chunks_mut(SOLVED_AT_ONCE * lines * width).enumerate();
        blocks.map(move |(block, r)| (line, block * SOLVED_AT_ONCE, r))
    });
    let blocks: Vec<(usize, usize, &mut [f64])> = blocks.collect();
    blocks
        .into_par_iter()
        .with_max_len(1)
        .try_for_each(|(line, station, of_block)| {
            let many = of_block.len() / (lines * width);
            let unit = |s: usize| SparseRow(vec![(track.dof(line * stations + s), 1.0)]);
            let rows: Vec<SparseRow> = (station..station + many).map(unit).collect();
            solver.read(&rows, |solved| {
                let columns = solved.chunks_exact(solver.order());
                for ((s, whole), of_node) in (station..).zip(columns).zip(of_block.chunks_exact_mut(lines * width)) {
                    let (first, end) = (s.saturating_sub(near), (s + near + 1).min(stations));
                    for (other_line, r) in of_node.chunks_exact_mut(width).enumerate() {
                        let (r, other) = (&mut r[first + near - s..][..end - first], other_line * stations + first);
                        Arch::new().dispatch(ProductsOfModes {
                            scaled: &scaled,
                            nodes,
                            own: line * stations + s,
                            other,
                            sums: r,
                        });
                        for (t, r) in (other..).zip(r) {
                            *r = whole[track.dof(t)] - *r;
                        }
                    }
                }
            })
        })?;
    Ok(all)
}

/// [`ResidualRows::of_modes`] with the machine's vectors; a closure would leave their instructions behind.
struct SumsOfModes<'a>(&'a ResidualRows<'a>, &'a [f64], usize, &'a mut [f64]);

impl WithSimd for SumsOfModes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.of_modes(self.1, self.2, self.3);
    }
}

/// Sums over the modes of the products of a node with those from another on, modes after each other with `nodes` numbers
/// each.
struct ProductsOfModes<'a> {
    scaled: &'a [f64],
    nodes: usize,
    own: usize,
    other: usize,
    sums: &'a mut [f64],
}

impl WithSimd for ProductsOfModes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let many = self.sums.len();
        self.sums.fill(-0.0);
        for of_mode in self.scaled.chunks_exact(self.nodes) {
            let own = of_mode[self.own];
            for (sum, b) in self.sums.iter_mut().zip(&of_mode[self.other..][..many]) {
                *sum += own * b;
            }
        }
    }
}

/// Most modes that are summed one by one. The many of a long bridge are one product of matrices, ten times as fast; the
/// numbers of bridges that have no more hang on the order of this sum.
const ONE_BY_ONE: usize = 128;

/// Influences that are computed at once.
const BLOCK: usize = 128;

/// Columns side by side.
pub(super) struct Columns {
    numbers: Vec<f64>,
    order: usize,
}

impl Columns {
    /// `A^-1 r^T` of each row.
    pub(super) fn solved(solver: &ColumnSolver<'_>, rows: &[SparseRow]) -> Result<Self, FemError> {
        let order = solver.order();
        let mut numbers = vec![0.0; order * rows.len()];
        let blocks = numbers.par_chunks_mut(order.max(1) * SOLVED_AT_ONCE);
        blocks
            .zip(rows.par_chunks(SOLVED_AT_ONCE))
            .try_for_each(|(block, rows)| solver.write(rows, block))?;
        Ok(Self { numbers, order })
    }

    /// A column.
    pub(super) fn column(&self, j: usize) -> &[f64] {
        &self.numbers[j * self.order..][..self.order]
    }
}

/// A row on a mode.
pub(super) fn dot(row: &SparseRow, shapes: &Mat<f64>, k: usize) -> f64 {
    row.0.iter().map(|&(i, v)| v * shapes[(i, k)]).sum()
}
