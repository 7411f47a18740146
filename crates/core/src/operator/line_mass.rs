//! Point masses on a line of the deck, as masses of its stations.
//!
//! Knows the line's piecewise-linear rows. Does not know where the line is or what rides on it.

/// Mass matrix of the points on a line: tridiagonal, as each point moves with two stations. Its factors `M = V D V^T` are as
/// many masses D as stations, each on a row of two entries, which stand for any number of points exactly.
#[derive(Debug, Default)]
pub(super) struct LineMass {
    /// Diagonal, then D, and the entry to the next station.
    entries: Vec<[f64; 2]>,
}

impl LineMass {
    /// No point.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.entries.clear();
    }

    /// Number of stations.
    #[inline(always)]
    pub(super) fn stations(&self) -> usize {
        self.entries.len()
    }

    /// Adds a point mass between a station and the next, at a fraction of their distance.
    #[inline(always)]
    pub(super) fn add(&mut self, station: usize, fraction: f64, mass_kg: f64) {
        while self.entries.len() < station + 2 {
            self.entries.push([0.0; 2]);
        }
        let s = fraction;
        self.entries[station][0] += mass_kg * (1.0 - s) * (1.0 - s);
        self.entries[station][1] += mass_kg * s * (1.0 - s);
        self.entries[station + 1][0] += mass_kg * s * s;
    }

    /// The mass of a station and the entry that M has to the next; stations in their order, each once. The station's column
    /// of V is 1 at the station, and that entry over the mass at the next.
    #[inline(always)]
    pub(super) fn factor(&mut self, station: usize) -> [f64; 2] {
        let [whole, next] = self.entries[station];
        let mut taken = 0.0;
        if station > 0 {
            let [before, coupling] = self.entries[station - 1];
            taken = if before > 0.0 {
                coupling * coupling / before
            } else {
                0.0
            };
        }
        let left = whole - taken;
        // fewer points than stations: what is left is rounding
        let mass_kg = if left > 1e-12 * whole { left } else { 0.0 };
        self.entries[station][0] = mass_kg;
        [mass_kg, next]
    }
}

#[cfg(test)]
mod tests {
    use super::LineMass;
    use nalgebra::{DMatrix, DVector};

    /// Largest difference between `V D V^T` and the sum of `m r r^T` over the points, in which `factor` multiplies the first
    /// mass.
    fn apart(points: &[(usize, f64, f64)], factor: f64) -> f64 {
        let stations = points.iter().map(|p| p.0 + 2).max().unwrap_or(0);
        let (mut sum, mut line) = (DMatrix::zeros(stations, stations), LineMass::default());
        for (number, &(station, s, mass_kg)) in points.iter().enumerate() {
            let mut row = DVector::zeros(stations);
            (row[station], row[station + 1]) = (1.0 - s, s);
            let by = if number == 0 { factor } else { 1.0 };
            sum += &row * row.transpose() * mass_kg * by;
            line.add(station, s, mass_kg);
        }
        assert_eq!(line.stations(), stations);
        let mut product = DMatrix::zeros(stations, stations);
        for station in 0..stations {
            let [mass_kg, next] = line.factor(station);
            if mass_kg > 0.0 {
                let mut column = DVector::zeros(stations);
                column[station] = 1.0;
                if next != 0.0 {
                    column[station + 1] = next / mass_kg;
                }
                product += &column * column.transpose() * mass_kg;
            }
        }
        (sum - product).amax()
    }

    /// Fewer points than stations, more, on a station, and with a station between that carries none; 1e-12 of the masses is
    /// rounding. A mass that is 5 % off is found.
    #[test]
    fn factors_give_the_mass_matrix_of_the_points() {
        let lines: [&[(usize, f64, f64)]; 5] = [
            &[(0, 0.25, 10.0)],
            &[(0, 0.0, 10.0), (0, 1.0, 20.0)],
            &[
                (0, 0.1, 5.0),
                (0, 0.6, 7.0),
                (0, 0.9, 9.0),
                (1, 0.4, 2.0),
                (2, 0.7, 3.0),
            ],
            &[(0, 0.3, 4.0), (3, 0.2, 6.0)],
            &[],
        ];
        for points in lines {
            let off = apart(points, 1.0);
            assert!(off < 1e-11, "{points:?}: {off:e} kg");
            assert!(points.is_empty() || apart(points, 1.05) > 0.05, "a wrong mass passes");
        }
    }
}
