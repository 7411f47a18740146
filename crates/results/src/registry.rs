//! The columns of all tables, one entry each: name, unit, label, what it is, where its cells come from, who shows it.
//!
//! Tables, the report, figures, the terminal and the book's tables read this list. Knows columns and records. Does not know how a
//! number came about, nor which rows there are.
//!
//! | module | charter |
//! |---|---|
//! | `column` | what is told of a column, and how an entry is written |

mod column;

pub use column::{Card, Column, ColumnRole, Curve, Digits, SpeedFigure, When};
pub(crate) use column::{ColumnSource, HistorySample, JointRow, RowOf};

use crate::FailureKind;
use crate::arrays::CellKind;
use crate::quantities::{DEAD_QUANTITIES, QUANTITIES, SECTION_QUANTITIES};
use crate::record::JobRecord;
use CellKind::{Counts, Flags, Numbers, Texts, Words};
use column::{
    at_peak, at_rest, centimetres, kilonewtons, measure, of_bank, of_body, of_connector, of_freeboard, of_job,
    of_joint, of_limit, of_mode, of_pin, of_place, of_position, of_record, of_sample, of_section, of_wheel, peak_card,
    plain_card,
};
use pontoon_plan::design::NAMED_AXES;
use pontoon_plan::input::Cell;
use pontoon_plan::job::BODY_QUANTITIES;
use pontoon_plan::study_file::{Limit, PeakColumn};
use serde_json::{Value, json};
use std::borrow::Cow;

fn status(record: &JobRecord) -> Cell<'_> {
    if record.failure.is_none() { "ok" } else { "failed" }.into()
}

fn reason(record: &JobRecord) -> Cell<'_> {
    match (&record.failure, &record.retried) {
        (Some(failure), _) => failure.text.as_str().into(),
        (None, Some(retried)) => {
            let text = format!("at half the time step; at its own: {}", retried.text);
            Cell::Word(Cow::Owned(text))
        }
        (None, None) if record.summary.steps.is_some() && record.summary.min_contact_force_n.is_none() => {
            "min_contact_force_n is null: no axle has been on its modules for 50 ms".into()
        }
        (None, None) => Cell::Nothing,
    }
}

/// The columns of the table of jobs that hang on the same load creeping over the bridge.
pub const STATIC_PEAK_COLUMNS: [&str; 2] = ["static_peak_deflection_m", "dynamic_amplification"];

/// The columns of all tables in their order; those of the axes stand behind the state of the jobs.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    of_record("job", Counts, ("job", "number of the job, from 0"), |r| r.job.into()).role(ColumnRole::Key),
    of_record("status", Words(&["ok", "failed"]), ("status", "what became of the job"), status).role(ColumnRole::State),
    of_record("reason", Texts, ("reason", "why the job failed, or a remark"), reason).role(ColumnRole::State),
    of_record("failure", Words(&FailureKind::WORDS), ("failure", "the kind of the failure"), |r| r.failure.as_ref().map(|failure| failure.kind.word()).into()).role(ColumnRole::State),
    of_job("rated_value", Numbers, ("rated value", "the last value of the axis that is searched, in its unit, before the first at which a crossing exceeds a limit"), |r| r.summary.rated_value.into()).when(When::Rating).role(ColumnRole::Measure).in_summary()
        .card(plain_card("largest rated value")),
    of_job("first_failure", Numbers, ("first failure", "the first value at which a crossing exceeds a limit"), |r| r.summary.first_failure.into()).when(When::Rating).role(ColumnRole::Listed).in_summary(),
    of_job("largest_pass", Numbers, ("largest pass", "the farthest value of the ladder at which a crossing keeps all limits where it lies beyond the first failure, else the rated value"), |r| r.summary.largest_pass.into()).when(When::Rating).role(ColumnRole::Listed),
    of_job("monotone", Flags, ("monotone", "whether no value of the ladder beyond the first failure passes; null where one of them could not be solved and none passes"), |r| r.summary.monotone.into()).when(When::Rating).role(ColumnRole::Listed),
    of_job("crossings", Counts, ("crossings", "crossings that the rating took"), |r| r.summary.crossings.into()).when(When::Rating).role(ColumnRole::Listed),
    of_job("spread", Numbers, ("spread", "by how much a ten-thousandth more or less load moves the utilisation of the rated value or of the first failure, as a share of it, the larger of both"), |r| r.summary.spread.into()).when(When::Rating).role(ColumnRole::Listed),
    of_job("chaotic", Flags, ("chaotic", "whether the spread is above 0.02"), |r| r.summary.chaotic.into()).when(When::Rating).role(ColumnRole::Listed),
    of_job("utilisation", Numbers, ("utilisation", "largest demand over what is allowed, of all limits; of a rating that of the rated value"), |r| r.summary.utilisation.into()).when(When::Limits).role(ColumnRole::Measure).drawn().in_summary()
        .card(peak_card("largest utilisation", ("place", "governing_place"), Some("governing_time_s"))),
    of_job("governing_limit", Words(&Limit::WORDS), ("governing limit", "the limit of which most is used up; of a rating the one that the first failure exceeds"), |r| r.summary.governing_limit.as_deref().into()).when(When::Limits).role(ColumnRole::Listed),
    of_job("governing_place", Counts, ("governing place", "where: the position of an edge, an uplift or a roll, the module of a trim, the joint of a force or angle, the axle of a contact force"), |r| r.summary.governing_place.into()).when(When::Limits).role(ColumnRole::Listed),
    of_job("governing_time_s", Numbers, ("governing time", "when"), |r| r.summary.governing_time_s.into()).unit("s").when(When::Limits).role(ColumnRole::Listed),
    measure("peak_deflection_m", "peak deflection", "largest deflection of any position", |r| r.summary.peak_deflection_m.into()).metres().drawn().in_summary()
        .card(peak_card("largest deflection", ("position", "peak_deflection_position"), Some("peak_deflection_time_s")))
        .curve(centimetres("Peak deflection")),
    of_job("peak_deflection_position", Counts, ("peak deflection position", "its position"), |r| r.summary.peak_deflection_position.into()).role(ColumnRole::Listed),
    of_job("peak_deflection_time_s", Numbers, ("peak deflection time", "its time"), |r| r.summary.peak_deflection_time_s.into()).unit("s").role(ColumnRole::Listed),
    measure("peak_uplift_m", "peak uplift", "largest uplift of any position", |r| r.summary.peak_uplift_m.into()).metres().drawn().in_summary()
        .card(peak_card("largest uplift", ("position", "peak_uplift_position"), Some("peak_uplift_time_s")))
        .curve(centimetres("Peak uplift")),
    of_job("peak_uplift_position", Counts, ("peak uplift position", "its position"), |r| r.summary.peak_uplift_position.into()).role(ColumnRole::Listed),
    of_job("peak_uplift_time_s", Numbers, ("peak uplift time", "its time"), |r| r.summary.peak_uplift_time_s.into()).unit("s"),
    measure("peak_compression_n", "peak compression", "largest compression of any joint, its connectors added", |r| r.summary.peak_compression_n.into()).newtons().drawn().in_summary()
        .card(peak_card("largest compression", ("joint", "peak_compression_joint"), None))
        .curve(kilonewtons("Peak compression of a joint")),
    of_job("peak_compression_joint", Counts, ("peak compression joint", "its joint"), |r| r.summary.peak_compression_joint.into()).role(ColumnRole::Listed),
    measure("peak_tension_n", "peak tension", "largest tension of any joint, its connectors added", |r| r.summary.peak_tension_n.into()).newtons().drawn().in_summary()
        .card(peak_card("largest tension", ("joint", "peak_tension_joint"), None))
        .curve(kilonewtons("Peak tension of a joint")),
    of_job("peak_tension_joint", Counts, ("peak tension joint", "its joint"), |r| r.summary.peak_tension_joint.into()).role(ColumnRole::Listed),
    measure("peak_pin_n", "peak pin force", "largest resultant of any pin", |r| r.summary.peak_pin_n.into()).newtons().drawn().when(When::Pins)
        .card(peak_card("largest pin force", ("joint", "peak_pin_joint"), None))
        .curve(kilonewtons("Peak force of a pin")),
    of_job("peak_pin_joint", Counts, ("peak pin joint", "its joint"), |r| r.summary.peak_pin_joint.into()).role(ColumnRole::Listed).when(When::Pins),
    measure("peak_angle_rad", "peak joint angle", "largest angle of any joint, either sense", |r| r.summary.peak_angle_rad.into()).unit("rad").when(When::Sections),
    of_job("peak_angle_joint", Counts, ("peak angle joint", "its joint"), |r| r.summary.peak_angle_joint.into()).when(When::Sections),
    measure("peak_bending_nm", "peak bending moment", "largest bending moment of any joint, either sense", |r| r.summary.peak_bending_nm.into()).unit("N m").when(When::Sections),
    of_job("peak_bending_joint", Counts, ("peak bending joint", "its joint"), |r| r.summary.peak_bending_joint.into()).when(When::Sections),
    measure("peak_edge_deflection_m", "peak edge deflection", "largest deflection of the deck's edges", |r| r.summary.peak_edge_deflection_m.into()).metres().drawn(),
    measure("peak_roll_rad", "peak roll", "largest roll of a module end", |r| r.summary.peak_roll_rad.into()).unit("rad"),
    of_job("peak_trim_rad", Numbers, ("peak trim", "largest trim of a module, either sense"), |r| r.summary.peak_trim_rad.into()).unit("rad").when(When::Crossing),
    measure("static_peak_deflection_m", "static peak deflection", "largest static deflection of any position while the same weight moves slowly over the bridge, without inertia, over the job's connection and gaps", |r| r.summary.static_peak_deflection_m.into()).metres().drawn(),
    measure("dynamic_amplification", "dynamic amplification", "peak deflection over static peak deflection", |r| r.summary.dynamic_amplification.into()).drawn()
        .card(plain_card("largest dynamic amplification")),
    measure("influential_length_m", "influential length", "length over which a static load presses the bridge down; null in crossings", |r| r.summary.influential_length_m.into()).unit("m")
        .card(plain_card("longest influential length")),
    of_job("least_freeboard_m", Numbers, ("least freeboard", "smallest height of any corner of a module's deck above the water"), |r| r.summary.least_freeboard_m.into()).unit("m").role(ColumnRole::Listed).when(When::Freeboards),
    of_job("least_freeboard_module", Counts, ("least freeboard module", "its module"), |r| r.summary.least_freeboard_module.into()).when(When::Freeboards),
    of_job("bottom_emerged", Flags, ("bottom emerged", "whether a corner of a module's bottom rose above the water; null unless the bridge has `draft_m`"), |r| r.summary.bottom_emerged.into()),
    of_job("deck_submerged", Flags, ("deck submerged", "whether a corner of a module's deck went below the water; null unless the bridge has `freeboard_m`"), |r| r.summary.deck_submerged.into()),
    of_job("contact_lost_s", Numbers, ("contact lost", "for how long any wheel on springs, all its points on the bridge, had left the deck"), |r| r.summary.contact_lost_s.into()).unit("s").when(When::Springs).role(ColumnRole::Listed),
    of_job("min_contact_force_n", Numbers, ("smallest contact force", "smallest contact force of an axle, from 50 ms after its last point came onto a module; below zero it would have lifted off; with gaps impacts make it depend on the time step; null where no axle has been on its modules so long"), |r| r.summary.min_contact_force_n.into()).unit("N").role(ColumnRole::Listed),
    of_job("step_warning", Flags, ("step warning", "whether the vehicle goes more than half of its shortest patch in a time step, so that peaks may be far too large; vehicles with inertia and a stated time step"), |r| r.summary.step_warning.into()).role(ColumnRole::Listed),
    of_job("time_step_s", Numbers, ("time step", "time step found for the job"), |r| r.summary.time_step_s.into()).unit("s").when(When::AutoTimeStep).role(ColumnRole::Listed),
    of_job("steps", Counts, ("steps", "time steps"), |r| r.summary.steps.into()).role(ColumnRole::Listed),
    of_job("newton_iterations", Counts, ("newton iterations", "Newton solutions"), |r| r.summary.newton_iterations.into()),
    of_job("contact_switches", Counts, ("contact switches", "trusses that opened or closed"), |r| r.summary.contact_switches.into()).role(ColumnRole::Listed),
    of_job("energy_residual", Numbers, ("energy residual", "largest error of the energy balance, a share of the load's work"), |r| r.summary.energy_residual.into()).role(ColumnRole::Listed),
    of_job("numerical_dissipation", Numbers, ("numerical dissipation", "largest numerical dissipation, a share of the load's work"), |r| r.summary.numerical_dissipation.into()).role(ColumnRole::Listed),
    of_job("radiated_energy_j", Numbers, ("radiated energy", "what waves have taken of the bridge's motion by the end of the crossing; null in water without memory"), |r| r.summary.radiated_energy_j.into()).unit("J").role(ColumnRole::Listed).when(When::Waves),
    of_job("least_radiated_energy_j", Numbers, ("least radiated energy", "the least that waves had taken at any time, 0 where they have never given more than they took"), |r| r.summary.least_radiated_energy_j.into()).unit("J").when(When::Waves),
    of_job("verify_deflection", Numbers, ("verify deflection", "how far the operator's largest deflection is off, a share of the reference solver's"), |r| r.summary.verify_deflection.into()).when(When::Verify).role(ColumnRole::Listed),
    of_job("verify_compression", Numbers, ("verify compression", "how far the operator's largest compression is off, a share of the job's largest joint force"), |r| r.summary.verify_compression.into()).when(When::Verify),
    of_job("verify_tension", Numbers, ("verify tension", "how far the operator's largest tension is off, a share of the job's largest joint force"), |r| r.summary.verify_tension.into()).when(When::Verify),
    of_job("verify_contact", Numbers, ("verify contact", "how far the smallest contact force of an axle is off, as a share of the vehicle's weight; judged with a linear connection only"), |r| r.summary.verify_contact.into()).when(When::Verify),
    of_job("verify_held", Flags, ("verify held", "whether all are within their tolerances"), |r| r.summary.verify_held.into()).when(When::Verify),
    measure("structural_mass_kg", "structural mass", "structural mass of a module, of modules that are not alike the mean", |r| r.summary.structural_mass_kg.into()).unit("kg").when(When::Modes),

    of_position("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_position("position", Counts, ("position", "number of the module end, from 1 at x = 0"), |r| r.row.position.into()).role(ColumnRole::Key),
    of_position("x_m", Numbers, ("x", "its place along the bridge"), |r| r.row.x_m.into()).unit("m"),
    of_position("peak_deflection_m", Numbers, ("peak deflection", "largest deflection"), |r| r.row.deflection.value.into()).metres().drawn(),
    of_position("peak_deflection_time_s", Numbers, ("peak deflection time", "its time"), |r| r.row.deflection.time_s.into()).unit("s"),
    of_position("peak_uplift_m", Numbers, ("peak uplift", "largest uplift"), |r| r.row.uplift.value.into()).metres().drawn(),
    of_position("peak_uplift_time_s", Numbers, ("peak uplift time", "its time"), |r| r.row.uplift.time_s.into()).unit("s"),
    of_position("deflection_m", Numbers, ("deflection", "deflection of a static case, positive downward"), |r| r.row.static_deflection_m.into()).metres().when(When::Static).drawn(),
    of_position("static_peak_deflection_m", Numbers, ("static peak deflection", "largest static deflection while the same weight moves slowly over the bridge"), |r| r.row.static_peak_deflection_m.into()).metres().when(When::Crossing),

    of_connector("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_connector("joint", Counts, ("joint", "number of the joint, from 2: joint k lies at position k"), |r| r.row.joint.into()).role(ColumnRole::Key),
    of_connector("y_m", Numbers, ("y", "place of the connector across; null in a joint's row, which adds its connectors"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_connector("peak_compression_n", Numbers, ("peak compression", "largest compression"), |r| r.row.compression.value.into()).newtons().drawn(),
    of_connector("peak_compression_time_s", Numbers, ("peak compression time", "its time"), |r| r.row.compression.time_s.into()).unit("s"),
    of_connector("peak_tension_n", Numbers, ("peak tension", "largest tension"), |r| r.row.tension.value.into()).newtons().drawn(),
    of_connector("peak_tension_time_s", Numbers, ("peak tension time", "its time"), |r| r.row.tension.time_s.into()).unit("s"),

    of_sample("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_sample("time_s", Numbers, ("time", "time, at 0 of which the front of a single vehicle passes x = 0, or x = L where it comes from there; below zero before; forces of pins and sections hold a part of a time step before the others"), |r| r.time_s.into()).unit("s").role(ColumnRole::Key),
    of_sample("quantity", Words(&QUANTITIES), ("quantity", "what the history is of: deflection positive downward, force tension positive"), |r| r.of.quantity.as_str().into()).role(ColumnRole::Key),
    of_sample("position", Counts, ("position", "position of a deflection, joint of a force; null of a place"), |r| r.of.position.into()).role(ColumnRole::Key),
    of_sample("x_m", Numbers, ("x", "place along the bridge, of the deflection of a place"), |r| r.of.x_m.into()).unit("m").role(ColumnRole::Key).when(When::PlaceHistories),
    of_sample("y_m", Numbers, ("y", "place across, of the force of a pin or wheel"), |r| r.of.y_m.into()).unit("m").role(ColumnRole::Key).when(When::PinHistories),
    of_sample("vehicle", Counts, ("vehicle", "number of the vehicle, from 1, of what is of a vehicle"), |r| r.of.vehicle.into()).role(ColumnRole::Key).when(When::VehicleHistories),
    of_sample("axle", Counts, ("axle", "number of the axle, from 1 at the front, of the force of a wheel"), |r| r.of.axle.into()).role(ColumnRole::Key).when(When::VehicleHistories),
    of_sample("value", Numbers, ("value", "the quantity, in its unit"), |r| r.value.into()),

    of_mode("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_mode("number", Counts, ("number", "number of the mode, from 1"), |r| r.row.number.into()).role(ColumnRole::Key),
    of_mode("frequency_hz", Numbers, ("frequency", "natural frequency"), |r| r.row.frequency_hz.into()).unit("Hz").decimals(5),
    of_mode("shape", Texts, ("shape", "name of the shape"), |r| r.row.shape.as_str().into()),
    of_mode("radiation_ratio", Numbers, ("radiation ratio", "damping by radiated waves at this frequency, a share of critical damping; null in water without memory"), |r| r.row.radiation_ratio.into()).decimals(4).when(When::ModesInWaves),
    of_mode("vertical_share", Numbers, ("vertical share", "vertical share of the kinetic energy"), |r| r.row.vertical_share.into()).decimals(4),
    of_mode("torsion_share", Numbers, ("torsion share", "share of torsion"), |r| r.row.torsion_share.into()).decimals(4),
    of_mode("horizontal_share", Numbers, ("horizontal share", "horizontal share"), |r| r.row.horizontal_share.into()).decimals(4),
    of_mode("axial_share", Numbers, ("axial share", "share along the bridge"), |r| r.row.axial_share.into()).decimals(4),

    of_joint("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_joint("joint", Counts, ("joint", "number of the joint, from 2"), |r| r.joint.into()).role(ColumnRole::Key),
    of_joint("gap_tension_m", Numbers, ("tension gap", "tension gap of its first connector, wear included"), |r| r.gaps_m[0].into()).unit("m"),
    of_joint("gap_compression_m", Numbers, ("compression gap", "compression gap of its first connector, wear included"), |r| r.gaps_m[1].into()).unit("m"),

    of_pin("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_pin("joint", Counts, ("joint", "number of the joint, from 2"), |r| r.row.joint.into()).role(ColumnRole::Key),
    of_pin("y_m", Numbers, ("y", "place of the pin across; null in a joint's row, which adds its pins"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_pin("peak_minus_x_n", Numbers, ("peak force, against x", "largest force of the pin on the module left of the joint, toward the left end of the bridge"), |r| r.row.components[0][0].value.into()).newtons(),
    of_pin("peak_minus_x_time_s", Numbers, ("peak force, against x, time", "its time"), |r| r.row.components[0][0].time_s.into()).unit("s"),
    of_pin("peak_plus_x_n", Numbers, ("peak force, along x", "largest force of the pin on the module left of the joint, toward its right end"), |r| r.row.components[0][1].value.into()).newtons(),
    of_pin("peak_plus_x_time_s", Numbers, ("peak force, along x, time", "its time"), |r| r.row.components[0][1].time_s.into()).unit("s"),
    of_pin("peak_minus_y_n", Numbers, ("peak force, against y", "largest force of the pin on the module left of the joint, across, against y"), |r| r.row.components[1][0].value.into()).newtons(),
    of_pin("peak_minus_y_time_s", Numbers, ("peak force, against y, time", "its time"), |r| r.row.components[1][0].time_s.into()).unit("s"),
    of_pin("peak_plus_y_n", Numbers, ("peak force, along y", "largest force of the pin on the module left of the joint, across, along y"), |r| r.row.components[1][1].value.into()).newtons(),
    of_pin("peak_plus_y_time_s", Numbers, ("peak force, along y, time", "its time"), |r| r.row.components[1][1].time_s.into()).unit("s"),
    of_pin("peak_minus_z_n", Numbers, ("peak force, against z", "largest force of the pin on the module left of the joint, downward"), |r| r.row.components[2][0].value.into()).newtons(),
    of_pin("peak_minus_z_time_s", Numbers, ("peak force, against z, time", "its time"), |r| r.row.components[2][0].time_s.into()).unit("s"),
    of_pin("peak_plus_z_n", Numbers, ("peak force, along z", "largest force of the pin on the module left of the joint, upward"), |r| r.row.components[2][1].value.into()).newtons(),
    of_pin("peak_plus_z_time_s", Numbers, ("peak force, along z, time", "its time"), |r| r.row.components[2][1].time_s.into()).unit("s"),
    of_pin("peak_resultant_n", Numbers, ("peak resultant", "largest resultant"), |r| r.row.resultant.value.into()).newtons(),
    of_pin("peak_resultant_time_s", Numbers, ("peak resultant time", "its time"), |r| r.row.resultant.time_s.into()).unit("s"),

    of_section("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_section("joint", Counts, ("joint", "number of the joint, from 2"), |r| r.row.joint.into()).role(ColumnRole::Key),
    of_section("quantity", Words(&SECTION_QUANTITIES), ("quantity", "which number of the joint: its angle, positive where it opens at the deck; forces of the right part on the left one, moments about the centre of the hinge line"), |r| r.row.quantity.as_str().into()).role(ColumnRole::Key),
    of_section("peak_minus", Numbers, ("peak, against its sense", "largest value against its sense, in the unit of the quantity: joint closed at the deck, compression, hogging"), |r| r.row.sides[0].value.into()),
    of_section("peak_minus_time_s", Numbers, ("peak, against its sense, time", "its time"), |r| r.row.sides[0].time_s.into()).unit("s"),
    of_section("peak_plus", Numbers, ("peak, with its sense", "largest value with its sense, in the unit of the quantity: joint open at the deck, tension, sagging"), |r| r.row.sides[1].value.into()),
    of_section("peak_plus_time_s", Numbers, ("peak, with its sense, time", "its time"), |r| r.row.sides[1].time_s.into()).unit("s"),

    of_place("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_place("x_m", Numbers, ("x", "the place along the bridge"), |r| r.row.x_m.into()).unit("m").role(ColumnRole::Key),
    of_place("peak_deflection_m", Numbers, ("peak deflection", "largest deflection"), |r| r.row.deflection.value.into()).metres(),
    of_place("peak_deflection_time_s", Numbers, ("peak deflection time", "its time"), |r| r.row.deflection.time_s.into()).unit("s"),
    of_place("peak_uplift_m", Numbers, ("peak uplift", "largest uplift"), |r| r.row.uplift.value.into()).metres(),
    of_place("peak_uplift_time_s", Numbers, ("peak uplift time", "its time"), |r| r.row.uplift.time_s.into()).unit("s"),
    of_place("deflection_m", Numbers, ("deflection", "deflection of a static case, positive downward"), |r| r.row.static_deflection_m.into()).metres().when(When::Static),

    at_peak("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    at_peak("at_peak_of", Words(&PeakColumn::WORDS), ("at peak of", "the peak at whose instant the value holds"), |r| r.row.at_peak_of.as_str().into()).role(ColumnRole::Key),
    at_peak("peak_at", Counts, ("peak at", "position or joint of that peak where one was named; null where it is the largest of all"), |r| r.row.peak_at.into()).role(ColumnRole::Key),
    at_peak("time_s", Numbers, ("time", "when the value holds; of pins and sections a part of a time step before the others"), |r| r.row.time_s.into()).unit("s"),
    at_peak("quantity", Words(&QUANTITIES), ("quantity", "what the value is, with its unit"), |r| r.row.of.quantity.as_str().into()).role(ColumnRole::Key),
    at_peak("position", Counts, ("position", "position of a deflection, joint of all else; null of a place"), |r| r.row.of.position.into()).role(ColumnRole::Key),
    at_peak("x_m", Numbers, ("x", "place along the bridge, of the deflection of a place"), |r| r.row.of.x_m.into()).unit("m").role(ColumnRole::Key),
    at_peak("y_m", Numbers, ("y", "place across, of the force of a connector or pin"), |r| r.row.of.y_m.into()).unit("m").role(ColumnRole::Key),
    at_peak("value", Numbers, ("value", "the quantity, in its unit"), |r| r.row.value.into()),

    of_bank("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_bank("bank", Counts, ("bank", "number of the bank, from 0 in the order of the bridge file"), |r| r.row.bank.into()).role(ColumnRole::Key),
    of_bank("y_m", Numbers, ("y", "place across; null in a bank's row, which adds its places"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_bank("peak_toward_n", Numbers, ("peak reaction", "largest force on the bridge along the bank's sense"), |r| r.row.toward.value.into()).newtons(),
    of_bank("peak_toward_time_s", Numbers, ("peak reaction time", "its time"), |r| r.row.toward.time_s.into()).unit("s"),
    of_bank("peak_away_n", Numbers, ("peak reaction, against its sense", "largest force against the bank's sense, of a spring that holds both ways"), |r| r.row.away.value.into()).newtons(),
    of_bank("peak_away_time_s", Numbers, ("peak reaction, against its sense, time", "its time"), |r| r.row.away.time_s.into()).unit("s"),

    at_rest("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    at_rest("quantity", Words(&DEAD_QUANTITIES), ("quantity", "what the value is, with its unit: deflections and sinkages downward, forces of joints and connectors in tension, reactions of banks along their sense; trim positive where a module's right end is higher, heel where its side of higher y is"), |r| r.row.quantity.as_str().into()).role(ColumnRole::Key),
    at_rest("position", Counts, ("position", "position of a deflection or freeboard, joint of a force"), |r| r.row.position.into()).role(ColumnRole::Key),
    at_rest("module", Counts, ("module", "number of the module, from 1, of its sinkage, trim, heel and freeboard"), |r| r.row.module.into()).role(ColumnRole::Key),
    at_rest("bank", Counts, ("bank", "number of the bank, from 0, of a reaction"), |r| r.row.bank.into()).role(ColumnRole::Key),
    at_rest("y_m", Numbers, ("y", "place across, of a connector, a bank's place or a deck's edge; null of a sum"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    at_rest("value", Numbers, ("value", "the quantity, in its unit"), |r| r.row.value.into()),

    of_freeboard("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_freeboard("module", Counts, ("module", "number of the module, from 1"), |r| r.row.module.into()).role(ColumnRole::Key),
    of_freeboard("position", Counts, ("position", "position of its end"), |r| r.row.position.into()).role(ColumnRole::Key),
    of_freeboard("y_m", Numbers, ("y", "place across of the deck's edge"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_freeboard("least_freeboard_m", Numbers, ("least freeboard", "smallest height of that corner of the deck above the water; below 0 under it"), |r| r.row.least.value.into()).unit("m"),
    of_freeboard("least_freeboard_time_s", Numbers, ("least freeboard time", "its time; null of a static case"), |r| r.row.least.time_s.into()).unit("s"),

    of_wheel("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_wheel("vehicle", Counts, ("vehicle", "number of the vehicle, from 1 in the order of the traffic"), |r| r.row.vehicle.into()).role(ColumnRole::Key),
    of_wheel("axle", Counts, ("axle", "number of the axle, from 1 at the front"), |r| r.row.axle.into()).role(ColumnRole::Key),
    of_wheel("y_m", Numbers, ("y", "place of the wheel across"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_wheel("peak_wheel_n", Numbers, ("largest wheel force", "largest force of the wheel on the deck, all its points on the bridge"), |r| r.row.largest.value.into()).newtons(),
    of_wheel("peak_wheel_time_s", Numbers, ("largest wheel force time", "its time"), |r| r.row.largest.time_s.into()).unit("s"),
    of_wheel("least_wheel_n", Numbers, ("smallest wheel force", "smallest force of the wheel on the deck, all its points on the bridge; 0 where it has left the deck"), |r| r.row.least.value.into()).newtons(),
    of_wheel("least_wheel_time_s", Numbers, ("smallest wheel force time", "its time"), |r| r.row.least.time_s.into()).unit("s"),
    of_wheel("contact_lost_s", Numbers, ("contact lost", "for how long it had left the deck, all its points on the bridge"), |r| r.row.lost_s.into()).unit("s"),

    of_limit("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_limit("limit", Words(&Limit::WORDS), ("limit", "which limit, with its unit"), |r| r.row.limit.as_str().into()).role(ColumnRole::Key),
    of_limit("demand", Numbers, ("demand", "what the crossing asks, in the unit of the limit; of a rating at the first failure"), |r| r.row.demand.value.into()),
    of_limit("allowed", Numbers, ("allowed", "what is allowed"), |r| r.row.allowed.into()),
    of_limit("utilisation", Numbers, ("utilisation", "demand over what is allowed; of a limit from below what is allowed over the demand, 1000 at most"), |r| r.row.utilisation.into()),
    of_limit("place", Counts, ("place", "position, module, joint or axle of the demand"), |r| r.row.place.into()),
    of_limit("time_s", Numbers, ("time", "when"), |r| r.row.demand.time_s.into()).unit("s"),

    of_body("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_body("vehicle", Counts, ("vehicle", "number of the vehicle, from 1 in the order of the traffic"), |r| r.row.vehicle.into()).role(ColumnRole::Key),
    of_body("quantity", Words(&BODY_QUANTITIES), ("quantity", "which motion of the body from rest on a level road: its centre up, its front up, its left side up"), |r| r.row.quantity.as_str().into()).role(ColumnRole::Key),
    of_body("peak_up", Numbers, ("peak, upward", "largest value upward, in the unit of the quantity, a wheel of the vehicle on the bridge"), |r| r.row.sides[0].value.into()),
    of_body("peak_up_time_s", Numbers, ("peak, upward, time", "its time"), |r| r.row.sides[0].time_s.into()).unit("s"),
    of_body("peak_down", Numbers, ("peak, downward", "largest value downward"), |r| r.row.sides[1].value.into()),
    of_body("peak_down_time_s", Numbers, ("peak, downward, time", "its time"), |r| r.row.sides[1].time_s.into()).unit("s"),
    of_body("peak_acceleration", Numbers, ("peak acceleration", "largest acceleration, either sense, in the unit of the quantity a second squared"), |r| r.row.acceleration.value.into()),
    of_body("peak_acceleration_time_s", Numbers, ("peak acceleration time", "its time"), |r| r.row.acceleration.time_s.into()).unit("s"),
];

/// The columns of all tables and the axes that have a name of their own, in their order.
pub fn registered() -> Value {
    json!({ "columns": COLUMNS, "axes": NAMED_AXES })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TableName;

    #[test]
    fn each_column_stands_once_and_ends_in_its_unit() {
        for (i, column) in COLUMNS.iter().enumerate() {
            let twice = COLUMNS[..i]
                .iter()
                .any(|other| (other.table, other.name) == (column.table, column.name));
            assert!(!twice, "{column:?}");
            let suffix = column.unit.to_lowercase().replace('/', "_").replace(' ', "");
            assert!(
                suffix.is_empty() || column.name.ends_with(&format!("_{suffix}")),
                "{column:?}"
            );
        }
    }

    #[test]
    fn each_number_of_a_job_has_its_column() {
        let summary = serde_json::to_value(crate::Summary::default()).unwrap();
        for name in summary.as_object().unwrap().keys() {
            assert!(Column::of(TableName::Jobs, name).is_some(), "{name}");
        }
    }

    #[test]
    fn what_a_card_names_is_a_column_of_jobs() {
        let cards = COLUMNS.iter().filter_map(|column| column.card);
        for name in cards
            .flat_map(|card| [card.place.map(|(_, column)| column), card.time])
            .flatten()
        {
            assert!(Column::of(TableName::Jobs, name).is_some(), "{name}");
        }
    }
}
