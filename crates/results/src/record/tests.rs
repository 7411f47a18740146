//! Records: their peaks, and that they are read back whole.
//!
//! Knows records by hand. Does not know tables.

use super::*;
use crate::FailureKind;

fn row(joint: usize, y_m: Option<f64>, force_n: f64) -> ConnectorRow {
    ConnectorRow::force(joint, y_m, force_n)
}

#[test]
fn peaks_of_the_bridge_are_those_of_sums_and_the_first_of_equals() {
    let connectors = [
        row(2, None, -5.0),
        row(2, Some(1.0), -9.0),
        row(3, None, -5.0),
        row(4, None, 0.0),
    ];
    let mut summary = Summary::default();
    summary.take_peaks(&[], &connectors);
    assert_eq!(
        (summary.peak_compression_n, summary.peak_compression_joint),
        (Some(5.0), Some(2))
    );
    assert_eq!((summary.peak_tension_n, summary.peak_tension_joint), (Some(0.0), None));
}

#[test]
fn a_peak_of_zero_has_no_time() {
    let none = Extreme {
        value: Some(0.0),
        time_s: None,
    };
    assert_eq!(Extreme::at(0.0, 0.0), none);
    assert_eq!(Extreme::at(0.1, 2.0).time_s, Some(2.0));
}

#[test]
fn a_record_is_read_back_without_loss() {
    let extreme = Extreme {
        value: Some(0.1 + 0.2),
        time_s: Some(1.0 / 3.0),
    };
    let record = JobRecord {
        job: 0,
        failure: Some(Failure::new(FailureKind::NotFinite, "why").with("time_s", 0.1)),
        retried: None,
        summary: Summary {
            peak_deflection_m: Some(1e-300),
            ..Summary::default()
        },
        positions: vec![PositionRow {
            position: 1,
            x_m: 0.0,
            deflection: extreme,
            uplift: extreme,
            static_deflection_m: None,
            static_peak_deflection_m: Some(0.1),
        }],
        connectors: vec![row(2, None, -5.0)],
        histories: HistoryRows {
            time_s: vec![0.1],
            balance_time_s: vec![0.05],
            series: vec![HistorySeries {
                of: NumberPlace {
                    quantity: "pin_x_n".to_owned(),
                    position: Some(7),
                    vehicle: None,
                    axle: None,
                    x_m: None,
                    y_m: Some(0.5),
                },
                of_balance: true,
                values: vec![0.7],
            }],
        },
        ..JobRecord::default()
    };
    let bytes = postcard::to_allocvec(&record).unwrap();
    assert_eq!(postcard::from_bytes::<JobRecord>(&bytes).unwrap(), record);
    // whatever its number was
    let numbered = JobRecord { job: 3, ..record };
    assert_eq!(postcard::to_allocvec(&numbered).unwrap(), bytes);
}
