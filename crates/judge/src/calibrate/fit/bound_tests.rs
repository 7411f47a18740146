//! Tests of the fit at its bounds.

use std::sync::Mutex;

use super::problem::outward_cosine;
use super::tests::{Answers, best, central, each, is_close, parameter, rosenbrock};
use super::*;

/// x <= 0.8 leaves the minimum at (0.8, 0.64), sum of squares 0.04.
#[test]
fn bound_active_at_the_solution_is_flagged_and_held_fixed() {
    for settings in [Settings::default(), central()] {
        let parameters = [parameter("x", -1.2, -2.0, 0.8), parameter("y", 1.0, -2.0, 2.0)];
        let fit = fit(&parameters, &each(rosenbrock), &settings).unwrap();
        assert!(fit.ending.converged(), "{}", fit.ending.text());
        assert_eq!(fit.parameters[0].best, 0.8);
        assert!(is_close(fit.parameters[1].best, 0.64, 1e-3), "{:?}", fit.parameters);
        assert!(is_close(fit.sum_of_squares_best, 0.04, 1e-3));
        assert_eq!(fit.parameters[0].at_bound, Some(Bound::Upper));
        assert_eq!(fit.parameters[0].standard_error, None);
        assert_eq!(fit.parameters[1].at_bound, None);
        assert!(is_close(
            fit.parameters[1].standard_error.unwrap(),
            fit.sum_of_squares_best.sqrt() / 10.0,
            1e-9
        ));
        assert_eq!(fit.correlation[0], [None, None]);
    }
}

#[test]
fn start_on_a_bound_is_left() {
    for start in [[-2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [2.0, -2.0]] {
        let parameters = [parameter("x", start[0], -2.0, 2.0), parameter("y", start[1], -2.0, 2.0)];
        let fit = fit(&parameters, &each(rosenbrock), &Settings::default()).unwrap();
        assert!(
            fit.ending.converged() && best(&fit).iter().all(|x| is_close(*x, 1.0, 1e-5)),
            "{:?}",
            best(&fit)
        );
        assert_eq!(fit.residuals_start, rosenbrock(&start).unwrap());
    }
}

#[test]
fn start_that_is_best_already_is_never_worsened() {
    let fit = fit(
        &[parameter("x", 0.0, 0.0, 1.0)],
        &each(|x| Ok(vec![x[0] + 1.0, 2.0])),
        &Settings::default(),
    )
    .unwrap();
    assert_eq!(
        (fit.parameters[0].best, fit.parameters[0].at_bound),
        (0.0, Some(Bound::Lower))
    );
    assert!(fit.ending.converged(), "{}", fit.ending.text());
    assert_eq!(fit.sum_of_squares_best, fit.sum_of_squares_start);
}

#[test]
fn jacobian_is_one_batch_and_no_point_is_outside_or_asked_twice() {
    for (settings, points) in [(Settings::default(), 2), (central(), 4)] {
        let asked = Mutex::new(Vec::<Vec<Vec<f64>>>::new());
        let model = |batch: &[Vec<f64>]| {
            asked.lock().unwrap().push(batch.to_vec());
            batch.iter().map(|x| rosenbrock(x)).collect::<Answers>()
        };
        let parameters = [parameter("x", -1.9999, -2.0, 0.8), parameter("y", 2.0, -2.0, 2.0)];
        let fit = fit(&parameters, &model, &settings).unwrap();
        let asked = asked.into_inner().unwrap();
        assert_eq!(asked[0].len(), 2, "the start on its bound, and moved inside");
        assert_eq!((asked[1].len(), asked[2].len()), (points, 1), "a Jacobian, a trial");
        let all: Vec<&Vec<f64>> = asked.iter().flatten().collect();
        assert_eq!(all.len(), fit.evaluations);
        for (k, x) in all.iter().enumerate() {
            assert!((-2.0..=0.8).contains(&x[0]) && (-2.0..=2.0).contains(&x[1]), "{x:?}");
            assert!(!all[..k].contains(x), "{x:?} asked twice");
        }
    }
}

/// A parameter on a bound that nothing pushes there is not held fixed: that it is undetermined comes out.
#[test]
fn parameter_without_influence_is_undetermined_wherever_it_starts() {
    for start in [0.0, 0.005, 0.5, 1.0] {
        let parameters = [parameter("x", 0.3, -2.0, 2.0), parameter("idle", start, 0.0, 1.0)];
        let fit = fit(
            &parameters,
            &each(|x| Ok(vec![x[0] - 1.0, x[0] - 1.2, 0.5])),
            &Settings::default(),
        )
        .unwrap();
        assert!(
            fit.ending.converged() && is_close(fit.parameters[0].best, 1.1, 1e-6),
            "{:?}",
            fit.parameters
        );
        assert_eq!(fit.undetermined.len(), 1);
        assert_eq!(
            fit.undetermined[0].components,
            [Component {
                parameter: 1,
                component: 1.0
            }]
        );
        assert!(fit.parameters[0].standard_error.is_some() && fit.parameters[1].standard_error.is_none());
    }
}

/// Uniform numbers between 0 and 1 from a linear congruential generator (Knuth's MMIX).
struct Uniform(u64);

impl Uniform {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Conditions of Kuhn and Tucker at the end of 300 random problems with 1 to 5 parameters, a third of which start on a
/// bound and half of which end on one: no parameter has a slope but one that is pushed onto its bound.
#[test]
fn random_problems_end_where_no_parameter_can_go_downhill() {
    // Large residuals and strong curvature make a few of them slow: the limit is not what is tested.
    let settings = Settings {
        evaluations_limit: 5000,
        ..central()
    };
    let mut uniform = Uniform(7);
    let (mut on_bounds, mut on_wrong_bounds) = (0, 0);
    for _ in 0..300 {
        let count = 1 + (uniform.next() * 5.0) as usize;
        let rows: Vec<Vec<f64>> = (0..count + 4)
            .map(|_| (0..=count).map(|_| uniform.next() * 2.0 - 1.0).collect())
            .collect();
        let parameters: Vec<Parameter> = (0..count)
            .map(|_| {
                let lower = -1.5 * uniform.next();
                let upper = lower + 0.2 + 2.0 * uniform.next();
                let start = (lower + (upper - lower) * (uniform.next() * 1.5 - 0.25)).clamp(lower, upper);
                parameter("", start, lower, upper)
            })
            .collect();
        let model = each(|x| {
            let residual = |row: &Vec<f64>| {
                let z: f64 = x.iter().zip(row).map(|(x, a)| a * x).sum();
                z + 0.3 * z * z + 0.2 * (3.0 * z).sin() - 2.0 * row[count]
            };
            Ok(rows.iter().map(residual).collect())
        });
        let fit = fit(&parameters, &model, &settings).unwrap();
        assert!(fit.ending.converged(), "{}", fit.ending.text());
        for (k, found) in fit.parameters.iter().enumerate() {
            let column: Vec<f64> = fit.jacobian.iter().map(|row| row[k]).collect();
            let outward = outward_cosine(&parameters[k], found.best, Some(&column), &fit.residuals_best);
            match found.at_bound {
                None => assert!(outward.abs() < 0.01, "{outward} {:?}", fit.parameters),
                Some(_) => assert!(outward > -0.01, "{outward} {:?}", fit.parameters),
            }
            on_bounds += usize::from(found.at_bound.is_some());
            on_wrong_bounds += usize::from(found.at_bound.is_some() && outward < 0.01);
        }
    }
    assert!(
        on_bounds > 300 && on_wrong_bounds < on_bounds / 20,
        "{on_bounds} {on_wrong_bounds}"
    );
}
