//! Tests of the fit where the model fails, or where the input is refused.

use super::tests::{best, each, is_close, line, line_parameters, parameter};
use super::*;

/// The residuals flatten away from the minimum at 1, so that steps overshoot, down to where the model fails, x < 0.5.
#[test]
fn failures_beyond_the_minimum_are_listed_and_do_not_keep_from_it() {
    let model = each(|x| {
        if x[0] < 0.5 {
            return Err(ModelError(format!("no answer at {}", x[0])));
        }
        Ok(vec![(3.0 * (x[0] - 1.0)).atan(), 0.3 * (x[1] - 2.0 * x[0])])
    });
    for start in [2.0, 2.5, 3.0, 4.0] {
        let parameters = [parameter("x", start, -5.0, 5.0), parameter("y", 3.0, -5.0, 5.0)];
        let fit = fit(&parameters, &model, &Settings::default()).unwrap();
        assert!(fit.ending.converged(), "{}", fit.ending.text());
        assert!(is_close(fit.parameters[0].best, 1.0, 1e-5) && is_close(fit.parameters[1].best, 2.0, 1e-5));
        assert!(!fit.failed.is_empty() && fit.failed.iter().all(|point| point.parameters[0] < 0.5));
        assert!(
            fit.failed
                .iter()
                .all(|point| point.reason == format!("no answer at {}", point.parameters[0]))
        );
    }
}

/// The model fails for 1.4 < x < 1.6, between the starts and the minimum at 1. A search gets across if its step is long
/// enough, else it stops at the edge: never does it claim to have converged there.
#[test]
fn gap_is_crossed_or_said_to_stop_the_search() {
    let model = each(|x| {
        let z = x[0] - 1.0;
        if (0.4..0.6).contains(&z) {
            Err("gap".into())
        } else {
            Ok(vec![z * (1.0 + z * z), 1.0])
        }
    });
    let (mut crossed, mut stopped) = (0, 0);
    for k in 0..40 {
        let fit = fit(
            &[parameter("x", 1.65 + 0.05 * f64::from(k), -1.0, 5.0)],
            &model,
            &Settings::default(),
        )
        .unwrap();
        match fit.ending {
            StopReason::StoppedByFailures => stopped += 1,
            _ => crossed += 1,
        }
        assert_eq!(
            fit.ending.converged(),
            is_close(fit.parameters[0].best, 1.0, 1e-3),
            "{:?}",
            fit.ending
        );
        assert!(fit.ending.converged() || !fit.failed.is_empty());
    }
    assert!(crossed > 0 && stopped > 0);
}

/// The minimum lies in a region of failure: the search stops at its edge, and says that it has not converged.
#[test]
fn minimum_in_a_region_of_failure_is_no_convergence() {
    let model = each(|x| {
        if x[0] < 1.0 {
            Err("too soft".into())
        } else {
            Ok(vec![x[0], 1.0])
        }
    });
    let fit = fit(&[parameter("x", 3.0, -5.0, 5.0)], &model, &Settings::default()).unwrap();
    assert_eq!(fit.ending, StopReason::StoppedByFailures);
    assert!((1.0..1.1).contains(&fit.parameters[0].best), "{:?}", best(&fit));
    assert!(fit.failed.iter().any(|point| point.purpose == Purpose::Trial));
}

#[test]
fn failed_difference_takes_the_other_side_and_two_failures_are_said() {
    let upper_fails = each(|x| {
        if x[0] > 0.0 {
            Err("above".into())
        } else {
            Ok(vec![x[0] + 1.0, 1.0])
        }
    });
    let one = [parameter("x", 0.0, -4.0, 4.0)];
    let fit_one = fit(&one, &upper_fails, &Settings::default()).unwrap();
    assert_eq!(fit_one.failed[0].purpose, Purpose::Difference(0));
    assert!(is_close(fit_one.parameters[0].best, -1.0, 1e-5) && fit_one.ending.converged());

    let alone = each(|x| {
        if x[1] == 0.5 {
            Ok(vec![x[0] - 1.0, 1.0])
        } else {
            Err("only there".into())
        }
    });
    let two = [parameter("x", 0.0, -4.0, 4.0), parameter("y", 0.5, 0.0, 1.0)];
    let fit_two = fit(&two, &alone, &Settings::default()).unwrap();
    assert_eq!(fit_two.ending, StopReason::Blind);
    assert!(fit_two.parameters[0].has_derivative && !fit_two.parameters[1].has_derivative);
    assert!(is_close(fit_two.parameters[0].best, 1.0, 1e-5), "{:?}", best(&fit_two));
    assert_eq!(fit_two.parameters[1].standard_error, None);
    assert!(fit_two.jacobian.iter().all(|row| row[1] == 0.0));
}

#[test]
fn bad_input_is_refused_with_its_numbers() {
    let ask = |parameters: &[Parameter], settings: &Settings| fit(parameters, &each(line), settings).unwrap_err();
    let settings = Settings::default();
    assert_eq!(ask(&[], &settings), FitError::NoParameters);
    let outside = ask(&[parameter("x", 2.0, 0.0, 1.0)], &settings);
    assert_eq!(
        outside,
        FitError::OutsideBounds {
            name: "x".to_owned(),
            start: 2.0,
            lower: 0.0,
            upper: 1.0
        }
    );
    assert_eq!(
        outside.to_string(),
        "parameter `x` starts at 2, outside its bounds 0 to 1"
    );
    for (lower, upper) in [(1.0, 0.0), (0.0, 0.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        assert!(matches!(
            ask(&[parameter("x", 0.0, lower, upper)], &settings),
            FitError::Bounds { .. }
        ));
    }
    assert!(matches!(
        ask(&[parameter("x", f64::NAN, 0.0, 1.0)], &settings),
        FitError::OutsideBounds { .. }
    ));
    for wrong in [
        Settings {
            difference_share: 0.0,
            ..settings
        },
        Settings {
            difference_share: 0.3,
            ..settings
        },
        Settings {
            tolerance: 0.0,
            ..settings
        },
        Settings {
            undetermined_share: f64::NAN,
            ..settings
        },
        Settings {
            evaluations_limit: 0,
            ..settings
        },
    ] {
        assert!(matches!(ask(&line_parameters(), &wrong), FitError::Setting { .. }));
    }
}

#[test]
fn unusable_answers_are_failures() {
    let ask = |model: &ModelFn<'_>| fit(&[parameter("x", 1.0, 0.0, 4.0)], model, &Settings::default());
    let reason = |fit: Result<Fit, FitError>| match fit {
        Err(FitError::Start { reason, .. }) => reason,
        other => panic!("{other:?}"),
    };
    assert_eq!(reason(ask(&each(|_| Err("no bridge".into())))), "no bridge");
    assert_eq!(reason(ask(&each(|_| Ok(vec![1.0, f64::NAN])))), "residual 1 is NaN");
    assert_eq!(reason(ask(&|_| Vec::new())), "no answer for point 0 of 1");
    assert_eq!(ask(&each(|_| Ok(Vec::new()))), Err(FitError::NoResiduals));
    let other_count = ask(&each(|x| Ok(vec![x[0]; if x[0] == 1.0 { 2 } else { 3 }]))).unwrap();
    assert_eq!(other_count.failed[0].reason, "3 residuals where 2 came before");
    assert_eq!(
        ask(&each(|_| Ok(vec![1.0, 2.0]))).unwrap().ending,
        StopReason::NoInfluence
    );
    assert_eq!(
        ask(&each(|_| Ok(vec![0.0, 0.0]))).unwrap().ending,
        StopReason::ResidualsZero
    );
}
