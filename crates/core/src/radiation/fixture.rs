//! Made-up tables with closed forms, and the heave of two boxes in deep water, for tests.
//!
//! Knows numbers. Does not know what is tested with them.

use super::{Band, Kernel, Radiation, RadiationTable, Scales};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::PI;

/// Heave of a box as one body, per metre of its length of 100.5 m, fresh water, infinite depth: w `[rad/s]`, then A `[kg/m]` and
/// B `[N s/m^2]` of the box of 6.17 x 0.164 m (breadth, draught), then of the box of 8.082 x 0.125 m. Capytaine 3.0.0, 2192 cells,
/// two Gauss points a side, Rankine part apart.
pub(super) const BOXES: [[f64; 5]; 22] = [
    [0.0, 48041.4515584231, 0.0, 77280.65933250893, 0.0],
    [
        0.2,
        51852.51850219061,
        1443.133069257351,
        83285.09801213277,
        2437.0791797401193,
    ],
    [
        0.4,
        47060.901057798845,
        8535.35922325689,
        74457.3167163381,
        13834.409026006346,
    ],
    [
        0.6,
        32838.9783662847,
        16263.144644462673,
        51908.39674117268,
        25695.729777656565,
    ],
    [
        0.8,
        23755.065284893793,
        17842.471563161358,
        37540.65990893584,
        28173.131466237086,
    ],
    [
        1.0,
        20514.47681143855,
        19466.49409154068,
        32407.32834109715,
        30132.793451007117,
    ],
    [
        1.2,
        17782.3172651433,
        20283.904854626468,
        28372.27712271967,
        31137.254886016934,
    ],
    [
        1.4,
        16042.190847842116,
        20756.222670024727,
        25859.931841385216,
        31532.18006598297,
    ],
    [
        1.6,
        14838.701605727305,
        20822.304649066133,
        24165.959928856988,
        31367.75643069307,
    ],
    [
        1.8,
        13987.520879475755,
        20600.450705206335,
        23008.95076368001,
        30814.588384308307,
    ],
    [
        2.0,
        13388.243186708602,
        20158.631431624483,
        22228.0767638029,
        29969.539657748388,
    ],
    [
        2.2,
        12967.5618693689,
        19525.992478397617,
        21695.82171860227,
        28891.084327860342,
    ],
    [
        2.4,
        12682.965357116687,
        18753.07340379842,
        21357.05930124621,
        27636.75748406546,
    ],
    [
        2.6,
        12499.909234509814,
        17864.00748231407,
        21153.485239077243,
        26241.642712316156,
    ],
    [
        2.8,
        12393.162461985876,
        16880.903435570293,
        21040.86242845416,
        24733.403709814273,
    ],
    [
        3.0,
        12343.156013226957,
        15827.698480018658,
        20997.240203951744,
        23145.584506274394,
    ],
    [
        3.25,
        12336.753045894247,
        14437.532059810697,
        20985.894054247932,
        21072.4198586318,
    ],
    [
        3.5,
        12372.066228108846,
        13021.295775099363,
        20981.3217340754,
        18947.75353986043,
    ],
    [
        3.75,
        12416.852862965681,
        11547.949136850935,
        20950.507552112667,
        16785.500315092337,
    ],
    [
        4.0,
        12480.77732845469,
        10173.795874461677,
        20889.07199090812,
        14611.025587629101,
    ],
    [
        4.5,
        12465.762057785376,
        7455.194907597822,
        20448.821808926437,
        10669.460338601937,
    ],
    [
        5.0,
        11996.715899153063,
        4822.534037228412,
        19021.566326870634,
        6564.392979546599,
    ],
];

/// A at infinite frequency of the two boxes `[kg/m]`.
pub(super) const BOXES_INFINITE: [f64; 2] = [15988.229759582995, 26464.184071439875];

/// The box of this place in [`BOXES`], as a chain of one module of 1 m that only heaves; B times `factor`.
pub(super) fn heaving_box(place: usize, factor: f64) -> (RadiationTable, Scales) {
    let heave = |x: f64| {
        let mut matrix = DMatrix::zeros(3, 3);
        matrix[(0, 0)] = x;
        matrix
    };
    let column = |column: usize, factor: f64| BOXES.iter().map(|row| heave(factor * row[column])).collect();
    let omega = BOXES.iter().map(|row| row[0]).collect();
    let infinite = Some(heave(BOXES_INFINITE[place]));
    let (a, b) = (column(1 + 2 * place, 1.0), column(2 + 2 * place, factor));
    let table = RadiationTable::new(1, omega, a, b, infinite).unwrap();
    (table, Scales::new(&[1.0], 1.0).unwrap())
}

/// The exponent of [`bell`] `[s^2]`.
const A: f64 = 0.5;

/// The exponent of the damping of [`chain_water`] `[s^2]`: it is largest at 2.2 rad/s.
const OF_CHAIN: f64 = 0.2;

/// The damping `w^2 e^(-a w^2)`, and its `A(w) - A_inf = (1 - 2 y D(y)) / sqrt(pi a)` with y = sqrt(a) w and Dawson's integral D.
pub(super) fn bell(omega: f64) -> (f64, f64) {
    bell_of(A, omega)
}

/// The damping `w^2 e^(-a w^2)` of an exponent a `[s^2]`, and its added mass, see [`bell`].
fn bell_of(a: f64, omega: f64) -> (f64, f64) {
    let y = a.sqrt() * omega;
    let (n, mut dawson) = (2000, 0.0);
    for i in 0..n {
        let t = y * (f64::from(i) + 0.5) / f64::from(n);
        dawson += (t * t - y * y).exp() * y / f64::from(n);
    }
    (
        omega * omega * (-a * omega * omega).exp(),
        (1.0 - 2.0 * y * dawson) / (PI * a).sqrt(),
    )
}

/// The kernel of [`bell`], `(1/(2 a) - t^2/(4 a^2)) e^(-t^2/(4 a)) / sqrt(pi a)`.
pub(super) fn bell_kernel(t: f64) -> f64 {
    (0.5 / A - t * t / (4.0 * A * A)) * (-t * t / (4.0 * A)).exp() / (PI * A).sqrt()
}

/// What a made-up table is made of: `B(w) = R b(w)`, `A(w) = A_inf + R a(w)` with b and a of [`bell`].
pub(super) struct MadeUp {
    pub omega: Vec<f64>,
    pub a: Vec<DMatrix<f64>>,
    pub b: Vec<DMatrix<f64>>,
    pub residue: DMatrix<f64>,
    pub infinite: DMatrix<f64>,
    pub scales: Scales,
}

/// A chain of two modules with all freedoms coupled, as physics would have it.
pub(super) fn made_up() -> MadeUp {
    let scales = Scales::new(&[4.0, 4.0], 3.0).unwrap();
    let v = DMatrix::from_fn(6, 6, |i, j| {
        1.0 / (1.0 + i as f64 + 2.0 * j as f64) + if i == j { 1.0 } else { 0.0 }
    });
    let v = &v * v.transpose();
    let residue = scales.unscaled(&((&v + scales.mirrored(&v)) / 2.0));
    let infinite = &residue * 1.2;
    let omega: Vec<f64> = (0..=32).map(|i| 0.2 * f64::from(i)).collect();
    let a = omega.iter().map(|&w| &infinite + &residue * bell(w).1).collect();
    let b = omega.iter().map(|&w| &residue * bell(w).0).collect();
    MadeUp {
        omega,
        a,
        b,
        residue,
        infinite,
        scales,
    }
}

impl MadeUp {
    /// The place of a frequency.
    pub(super) fn place(&self, omega: f64) -> usize {
        self.omega.iter().position(|w| (w - omega).abs() < 1e-9).unwrap()
    }

    /// As a table, with the added mass at infinity.
    pub(super) fn table(&self) -> RadiationTable {
        let (a, b) = (self.a.clone(), self.b.clone());
        RadiationTable::new(2, self.omega.clone(), a, b, Some(self.infinite.clone())).unwrap()
    }

    /// Changes B at a frequency so that its least eigenvalue is `ratio` of the largest, in scaled freedoms.
    pub(super) fn set_least_damping(&mut self, omega: f64, ratio: f64) {
        let place = self.place(omega);
        let mut eigen = SymmetricEigen::new(self.scales.scaled(&self.b[place]));
        let least = eigen.eigenvalues.imin();
        eigen.eigenvalues[least] = ratio * eigen.eigenvalues.max();
        self.b[place] = self.scales.unscaled(&eigen.recompose());
    }
}

/// The water of a chain of equal modules that is made up: each drives its neighbours, heave and pitch each other, about as much as a
/// box of 6 m in deep water; damping times `factor`, the added mass left as it is.
pub(crate) fn chain_water(modules: usize, length_m: f64, breadth_m: f64, factor: f64) -> Radiation {
    let scales = Scales::new(&vec![length_m; modules], breadth_m).unwrap();
    let n = 3 * modules;
    let v = DMatrix::from_fn(n, n, |i, j| match (i / 3).abs_diff(j / 3) {
        _ if (i % 3 == 2) != (j % 3 == 2) => 0.0,
        0 if i == j => 1.0,
        1 => 0.3 / (1.0 + (i % 3).abs_diff(j % 3) as f64),
        _ => 0.0,
    });
    let v = &v * v.transpose();
    let residue = scales.unscaled(&((&v + scales.mirrored(&v)) / 2.0)) * (6e3 * length_m);
    let infinite = &residue * 2.2;
    let omega: Vec<f64> = (0..=25).map(|i| 0.2 * f64::from(i)).collect();
    let a = omega
        .iter()
        .map(|&w| &infinite + &residue * bell_of(OF_CHAIN, w).1)
        .collect();
    let b = omega
        .iter()
        .map(|&w| &residue * (factor * bell_of(OF_CHAIN, w).0))
        .collect();
    let table = RadiationTable::new(modules, omega, a, b, None).unwrap();
    let kernel = Kernel::new(&table, &scales, Band::default()).unwrap();
    Radiation::new(kernel, &table, scales, format!("chain {factor}")).unwrap()
}
