//! Tests of the fit: closed forms, bounds, undetermined directions, a certified reference.

use super::*;

pub(super) fn parameter(name: &str, start: f64, lower: f64, upper: f64) -> Parameter {
    Parameter {
        name: name.to_owned(),
        start,
        lower,
        upper,
    }
}

pub(super) fn central() -> Settings {
    Settings {
        differences: Differences::Central,
        ..Settings::default()
    }
}

/// A model of one point made one of batches.
pub(super) fn each(
    model: impl Fn(&[f64]) -> Result<Vec<f64>, ModelError> + Sync,
) -> impl Fn(&[Vec<f64>]) -> Answers + Sync {
    move |points| points.iter().map(|point| model(point)).collect()
}
pub(super) type Answers = Vec<Result<Vec<f64>, ModelError>>;

pub(super) fn best(fit: &Fit) -> Vec<f64> {
    fit.parameters.iter().map(|p| p.best).collect()
}

pub(super) fn is_close(found: f64, wanted: f64, relative: f64) -> bool {
    (found - wanted).abs() <= relative * wanted.abs()
}

const LINE: [(f64, f64); 5] = [(0.0, 1.1), (1.0, 2.9), (2.0, 5.2), (3.0, 6.8), (4.0, 9.1)];

pub(super) fn line(x: &[f64]) -> Result<Vec<f64>, ModelError> {
    Ok(LINE.iter().map(|(at, y)| y - x[0] - x[1] * at).collect())
}

pub(super) fn line_parameters() -> [Parameter; 2] {
    [
        parameter("intercept", 0.0, -10.0, 10.0),
        parameter("slope", 0.0, -5.0, 5.0),
    ]
}

/// Closed form: slope = sxy / sxx, covariance = `s^2 [[1/n + mean^2 / sxx, -mean / sxx], [.., 1 / sxx]]`.
#[test]
fn line_has_its_closed_form_solution_and_covariance() {
    let fit = fit(&line_parameters(), &each(line), &Settings::default()).unwrap();
    let (n, mean, sxx) = (5.0, 2.0, 10.0);
    let mean_y = LINE.iter().map(|p| p.1).sum::<f64>() / n;
    let slope = LINE.iter().map(|p| (p.0 - mean) * p.1).sum::<f64>() / sxx;
    let intercept = mean_y - slope * mean;
    let sum = LINE
        .iter()
        .map(|p| (p.1 - intercept - slope * p.0).powi(2))
        .sum::<f64>();
    let variance = sum / 3.0;
    let errors = [
        (variance * (1.0 / n + mean * mean / sxx)).sqrt(),
        (variance / sxx).sqrt(),
    ];

    assert!(fit.ending.converged(), "{}", fit.ending.text());
    let off_by = |wanted: [f64; 2], relative| best(&fit).iter().zip(wanted).all(|(x, w)| is_close(*x, w, relative));
    assert!(off_by([intercept, slope], 1e-6), "{:?}", best(&fit));
    assert!(!off_by([intercept * 1.05, slope * 1.05], 1e-6));
    assert!(is_close(fit.sum_of_squares_best, sum, 1e-9));
    assert_eq!(fit.error_scale.variance(), fit.sum_of_squares_best / 3.0);
    for (found, wanted) in fit.parameters.iter().zip(errors) {
        assert!(
            is_close(found.standard_error.unwrap(), wanted, 1e-9),
            "{found:?} {wanted}"
        );
    }
    let correlation = -mean / sxx / ((1.0 / n + mean * mean / sxx) / sxx).sqrt();
    assert!(is_close(fit.correlation[0][1].unwrap(), correlation, 1e-9));
    assert_eq!(fit.correlation[0][0], Some(1.0));
    for (row, (at, _)) in fit.jacobian.iter().zip(LINE) {
        assert!((row[0] + 1.0).abs() < 1e-9 && (row[1] + at).abs() < 1e-9, "{row:?}");
    }
    assert!(fit.undetermined.is_empty() && fit.failed.is_empty());
    assert_eq!(fit.sum_of_squares_start, LINE.iter().map(|p| p.1 * p.1).sum::<f64>());
}

const MISRA_X: [f64; 14] = [
    77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0,
];
const MISRA_Y: [f64; 14] = [
    10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78,
];

fn misra(factor: f64) -> impl Fn(&[Vec<f64>]) -> Answers + Sync {
    each(move |b| {
        Ok(MISRA_X
            .iter()
            .zip(MISRA_Y)
            .map(|(x, y)| y - b[0] * (1.0 - (-factor * b[1] * x).exp()))
            .collect())
    })
}

/// NIST StRD, Misra1a: certified values and standard deviations, from both of its starts.
#[test]
fn misra1a_is_reproduced_to_six_digits() {
    let settings = Settings {
        difference_share: 1e-4,
        tolerance: 1e-10,
        ..central()
    };
    let certified = [(238.94212918, 2.7070075241), (5.5015643181e-4, 7.2668688436e-6)];
    for start in [[500.0, 1e-4], [250.0, 5e-4]] {
        let parameters = [
            parameter("b1", start[0], 100.0, 600.0),
            parameter("b2", start[1], 5e-5, 2e-3),
        ];
        let fit = fit(&parameters, &misra(1.0), &settings).unwrap();
        assert!(fit.ending.converged(), "{}", fit.ending.text());
        for (found, (value, deviation)) in fit.parameters.iter().zip(certified) {
            assert!(is_close(found.best, value, 1e-6), "{found:?}");
            assert!(is_close(found.standard_error.unwrap(), deviation, 1e-6), "{found:?}");
        }
        assert!(is_close(fit.sum_of_squares_best, 1.2455138894e-1, 1e-9));
        let wrong = super::fit(&parameters, &misra(1.05), &settings).unwrap();
        assert!(!is_close(wrong.parameters[1].best, certified[1].0, 1e-6));
    }
}

/// The settings that a person gets without asking: coarser, but good to a hundredth of a standard deviation.
#[test]
fn misra1a_is_close_by_forward_differences() {
    let parameters = [parameter("b1", 500.0, 100.0, 600.0), parameter("b2", 1e-4, 5e-5, 2e-3)];
    let fit = fit(&parameters, &misra(1.0), &Settings::default()).unwrap();
    assert!(fit.ending.converged());
    assert!((fit.parameters[0].best - 238.94212918).abs() < 0.01 * 2.7070075241);
    assert!(is_close(fit.parameters[0].standard_error.unwrap(), 2.7070075241, 0.01));
}

pub(super) fn rosenbrock(x: &[f64]) -> Result<Vec<f64>, ModelError> {
    Ok(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]])
}

#[test]
fn rosenbrock_ends_in_its_valley() {
    let parameters = [parameter("x", -1.2, -2.0, 2.0), parameter("y", 1.0, -2.0, 2.0)];
    let fit = fit(&parameters, &each(rosenbrock), &Settings::default()).unwrap();
    assert!(fit.ending.converged());
    assert!(best(&fit).iter().all(|x| is_close(*x, 1.0, 1e-5)));
    assert_eq!(fit.error_scale, ErrorScale::Assumed);
}

/// Powell's singular function: the Jacobian loses rank at the solution (0, 0, 0, 0).
#[test]
fn powell_singular_comes_down_although_its_jacobian_loses_rank() {
    let model = each(|x| {
        let (a, b) = (x[1] - 2.0 * x[2], x[0] - x[3]);
        Ok(vec![
            x[0] + 10.0 * x[1],
            5f64.sqrt() * (x[2] - x[3]),
            a * a,
            10f64.sqrt() * b * b,
        ])
    });
    let start = [3.0, -1.0, 0.0, 1.0];
    let parameters: Vec<Parameter> = start
        .iter()
        .zip(["a", "b", "c", "d"])
        .map(|(&x, name)| parameter(name, x, -4.0, 5.0))
        .collect();
    let fit = fit(&parameters, &model, &central()).unwrap();
    assert!(is_close(fit.sum_of_squares_start, 215.0, 1e-14));
    assert!(fit.ending.converged() && fit.sum_of_squares_best < 1e-8);
    assert_eq!(fit.undetermined.len(), 2);
}

/// Only a + b is seen: the direction (1, -1) / sqrt 2 is undetermined, c is not touched by that.
#[test]
fn correlated_pair_is_undetermined_and_leaves_the_third_alone() {
    let model = each(|x| Ok(LINE.iter().map(|(at, y)| y - (x[0] + x[1]) - x[2] * at).collect()));
    let parameters = [
        parameter("a", 1.0, -10.0, 10.0),
        parameter("b", 2.0, -10.0, 10.0),
        parameter("c", 0.0, -5.0, 5.0),
    ];
    let fit = fit(&parameters, &model, &Settings::default()).unwrap();
    assert!(fit.ending.converged());
    let [direction] = fit.undetermined.as_slice() else {
        panic!("{:?}", fit.undetermined)
    };
    let names: Vec<usize> = direction.components.iter().map(|c| c.parameter).collect();
    assert!(names == [0, 1] || names == [1, 0], "{direction:?}");
    assert!(
        direction
            .components
            .iter()
            .all(|c| is_close(c.component.abs(), 0.5f64.sqrt(), 1e-6))
    );
    assert!(direction.components[0].component * direction.components[1].component < 0.0);
    assert!(direction.share_of_largest < 1e-9);
    assert!(fit.parameters[0].standard_error.is_none() && fit.parameters[1].standard_error.is_none());
    assert!(fit.correlation[0][2].is_none() && fit.correlation[2][2] == Some(1.0));
    let one_less_free = fit.sum_of_squares_best / 2.0 / 10.0;
    assert!(is_close(
        fit.parameters[2].standard_error.unwrap(),
        one_less_free.sqrt(),
        1e-6
    ));
}

/// The residuals do see b, but so weakly that its standard error would be wider than its bounds.
#[test]
fn parameter_whose_error_is_wider_than_its_bounds_is_undetermined() {
    let bounds = |width: f64| [parameter("a", 0.1, -2.0, 2.0), parameter("b", 0.0, -width, width)];
    let model = each(|x| Ok(vec![x[0] - 1.0, x[0] + 1.0, 0.01 * x[1] - 0.5, 0.01 * x[1] + 0.5]));
    let share = Settings {
        undetermined_share: 1e-6,
        ..Settings::default()
    };
    let narrow = fit(&bounds(1.0), &model, &share).unwrap();
    assert_eq!(narrow.undetermined.len(), 1);
    assert_eq!(narrow.undetermined[0].components[0].parameter, 1);
    assert!(narrow.parameters[0].standard_error.is_some() && narrow.parameters[1].standard_error.is_none());
    let wide = fit(&bounds(1000.0), &model, &share).unwrap();
    assert!(wide.undetermined.is_empty() && wide.parameters[1].standard_error.is_some());
}

#[test]
fn fewer_residuals_than_parameters_leave_directions_undetermined() {
    let parameters: Vec<Parameter> = ["a", "b", "c"]
        .iter()
        .map(|name| parameter(name, 0.5, 0.0, 4.0))
        .collect();
    let fit = fit(
        &parameters,
        &each(|x| Ok(vec![x[0] + x[1] + x[2] - 3.0])),
        &Settings::default(),
    )
    .unwrap();
    assert!(fit.ending.converged() && fit.sum_of_squares_best < 1e-9);
    assert_eq!(fit.error_scale, ErrorScale::Assumed);
    assert_eq!((fit.singular_values.len(), fit.undetermined.len()), (3, 2));
    assert!(fit.parameters.iter().all(|p| p.standard_error.is_none()));
}

#[test]
fn limit_of_evaluations_holds_but_for_the_closing_jacobian() {
    let parameters = [parameter("x", -1.2, -2.0, 2.0), parameter("y", 1.0, -2.0, 2.0)];
    for evaluations_limit in 1..20 {
        let settings = Settings {
            evaluations_limit,
            ..Settings::default()
        };
        let fit = fit(&parameters, &each(rosenbrock), &settings).unwrap();
        assert_eq!(fit.ending, StopReason::EvaluationsLimit);
        assert!(fit.evaluations <= evaluations_limit + 2 && fit.sum_of_squares_best <= fit.sum_of_squares_start);
    }
}

#[test]
fn same_input_gives_the_same_bits() {
    let parameters = [parameter("b1", 500.0, 100.0, 600.0), parameter("b2", 1e-4, 5e-5, 2e-3)];
    let run = || format!("{:?}", fit(&parameters, &misra(1.0), &Settings::default()).unwrap());
    assert_eq!(run(), run());
}
