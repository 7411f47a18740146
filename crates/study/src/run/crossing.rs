//! A crossing job to its record.

use super::bench::Bench;
use super::record::{ConnectorRow, HistoryRows, JobRecord, PositionRow, Summary};
use crate::plan::Job;
use pontoon_core::analysis::crossing::Crossing;
use pontoon_core::response::{CrossingResponse, Quantity, Record};

/// Solves the crossing of a job.
pub(super) fn solve(job: &Job, speed_m_s: f64, record: Record, bench: &Bench) -> Result<JobRecord, String> {
    let crossing = Crossing {
        connection: job.connection,
        connector_stiffness_n_m: job.bridge.design.connectors.stiffness_n_m,
        load_n: job.load_n,
        speed_m_s,
        tail_s: job.analysis.spec.tail_s.unwrap_or_default(),
        record,
    };
    let response = bench
        .crossing(job)?
        .solve(&job.vehicle.vehicle, &crossing)
        .map_err(|e| e.to_string())?;
    let static_peaks_m = bench.creeping_peaks_m(job)?;
    Ok(rows(job.number, response, static_peaks_m.as_deref().map(Vec::as_slice)))
}

fn rows(job: usize, response: CrossingResponse, static_peaks_m: Option<&[f64]>) -> JobRecord {
    let static_peak_m = static_peaks_m.map(|peaks| peaks.iter().copied().fold(0.0, f64::max));
    let positions: Vec<PositionRow> = response
        .positions
        .iter()
        .enumerate()
        .map(|(i, p)| PositionRow {
            position: p.position,
            x_m: p.x_m,
            deflection: p.deflection.into(),
            uplift: p.uplift.into(),
            static_deflection_m: None,
            static_peak_deflection_m: static_peaks_m.map(|peaks| peaks[i]),
        })
        .collect();
    let mut connectors = Vec::new();
    for joint in &response.joints {
        connectors.push(ConnectorRow::peaks(joint.joint, None, &joint.sum));
        connectors.extend(
            joint
                .connectors
                .iter()
                .map(|(y_m, peaks)| ConnectorRow::peaks(joint.joint, Some(*y_m), peaks)),
        );
    }
    let mut summary = Summary {
        peak_edge_deflection_m: Some(response.peak_edge_deflection_m),
        peak_roll_rad: Some(response.peak_roll_rad),
        static_peak_deflection_m: static_peak_m,
        bottom_emerged: response.bottom_emerged,
        deck_submerged: response.deck_submerged,
        min_contact_force_n: Some(response.min_contact_force_n).filter(|force| force.is_finite()),
        steps: Some(response.statistics.steps),
        newton_iterations: Some(response.statistics.newton_iterations),
        contact_switches: Some(response.statistics.contact_switches),
        energy_residual: Some(response.energy.energy_residual),
        numerical_dissipation: Some(response.energy.numerical_dissipation),
        ..Summary::default()
    };
    summary.take_peaks(&positions, &connectors);
    summary.dynamic_amplification = summary
        .peak_deflection_m
        .zip(static_peak_m.filter(|&peak| peak > 0.0))
        .map(|(moving, creeping)| moving / creeping);
    let series = response.histories.into_iter().map(|history| {
        let quantity = match history.quantity {
            Quantity::Deflection => "deflection_m",
            Quantity::Force => "force_n",
        };
        (quantity.to_owned(), history.position, history.values)
    });
    let histories = HistoryRows {
        time_s: response.history_time_s,
        series: series.collect(),
    };
    JobRecord {
        job,
        reason: None,
        summary,
        positions,
        connectors,
        histories,
        modes: Vec::new(),
    }
}
