//! `pontoon water`: added mass and radiation damping read, checked and written as a water file.

use crate::args::{Common, Format};
use crate::exit_status::ExitStatus;
use crate::text;
use crate::water_arguments::WaterArguments;
use anyhow::Result;
use pontoon_journal::place::Folder;
use pontoon_plan::input::{Cell, Document, Refusal};
use pontoon_plan::study_file::{BridgeFile, read_bridge};
use pontoon_plan::water_file::{JudgedCheck, JudgedWater, ModuleLengths, WaterFile};
use pontoon_results::{labels, replaceable};
use pontoon_water::{BemModes, Options, Reading, WaterDepth, WaterFacts};
use serde_json::json;
use std::path::Path;

/// Lengths that differ by no more are equal `[m]`: rounding of the places of ends.
const EQUAL_LENGTHS_M: f64 = 1e-9;

/// Reads, checks, prints and, where asked, writes.
pub(crate) fn water(arguments: &WaterArguments, common: Common) -> Result<ExitStatus> {
    let bridge = arguments.bridge.as_deref().map(read_bridge).transpose()?;
    let reading = pontoon_water::read(&arguments.file, &options(arguments, bridge.as_ref()))?;
    let judged = JudgedWater::of(
        &arguments.file,
        &reading.water,
        bridge.as_ref().map(|bridge| &bridge.design),
    )?;
    let refused = judged.is_refused();
    let out = arguments.out.as_deref().filter(|_| !refused);
    if let Some(out) = out {
        write(out, &reading.water)?;
    }
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", object(&reading, &judged, out)),
        _ => text(&reading, &judged, out),
    })?;
    if !common.quiet {
        reading.notes.iter().for_each(|note| text::note(note));
    }
    if refused && arguments.out.is_some() {
        text::note("not written: a check refuses the water");
    }
    Ok(if refused { ExitStatus::Short } else { ExitStatus::Good })
}

/// What the reader is told beside the file; lengths are those of the bridge where there is one.
fn options(arguments: &WaterArguments, bridge: Option<&BridgeFile>) -> Options {
    let of_bridge = bridge.map(|bridge| {
        let design = &bridge.design;
        let ends_m: Vec<f64> = (1..=design.modules + 1).map(|end| design.position_x_m(end)).collect();
        let lengths_m: Vec<f64> = ends_m.windows(2).map(|ends| ends[1] - ends[0]).collect();
        let only_m = design.module.length_m;
        match lengths_m
            .iter()
            .all(|length_m| (length_m - only_m).abs() < EQUAL_LENGTHS_M)
        {
            true => ModuleLengths::Same(only_m),
            false => ModuleLengths::Each(lengths_m),
        }
    });
    let depth = match (arguments.deep, arguments.depth_m) {
        (true, _) => Some(WaterDepth::Deep),
        (false, depth_m) => depth_m.map(WaterDepth::Metres),
    };
    Options {
        facts: WaterFacts {
            name: arguments.name.clone(),
            hull: arguments.hull.clone(),
            module_length_m: arguments.module_length_m.map(ModuleLengths::Same).or(of_bridge),
            waterline_breadth_m: arguments.waterline_breadth_m,
            draught_m: arguments.draught_m,
            depth,
            density_kg_m3: arguments.density_kg_m3,
            gravity_m_s2: arguments.gravity_m_s2,
        },
        modules: bridge.map(|bridge| bridge.design.modules),
        note: None,
        usable_to_rad_s: arguments.usable_to_rad_s,
        modes: match arguments.modes.as_slice() {
            [] => BemModes::Bodies,
            listed => BemModes::Listed(listed.iter().map(|&mode| usize::from(mode)).collect()),
        },
        length_scale_m: arguments.length_scale_m,
    }
}

/// Writes a water file whole or not at all, over nothing but a water file.
fn write(out: &Path, water: &WaterFile) -> Result<()> {
    let place = replaceable(out, "a water file", |bytes| {
        let text = String::from_utf8_lossy(bytes);
        Document::parse(out, &text).is_ok_and(|document| WaterFile::of(out, &document).is_ok())
    })?;
    let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty());
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let text = water.text();
    Folder::create(folder.unwrap_or(Path::new(".")))?.write(&name, |file| file.write_all(text.as_bytes()))?;
    // what was written reads back
    let written: Result<WaterFile, Refusal> = WaterFile::open(&place);
    written.map(drop).map_err(Into::into)
}

fn object(reading: &Reading, judged: &JudgedWater, out: Option<&Path>) -> serde_json::Value {
    let water = &reading.water;
    json!({
        "water": water.name,
        "format": reading.format.to_string(),
        "modules": water.modules,
        "frequencies": water.omega_rad_s.len(),
        "depth_m": water.depth_m,
        "judged": judged,
        "notes": reading.notes,
        "out": out.map(|out| out.display().to_string()),
    })
}

fn text(reading: &Reading, judged: &JudgedWater, out: Option<&Path>) -> String {
    let water = &reading.water;
    let depth = water
        .depth_m
        .map_or("deep".to_owned(), |depth_m| format!("{depth_m} m deep"));
    let span = match (water.omega_rad_s.first(), water.omega_rad_s.last()) {
        (Some(first), Some(last)) => format!(", {first} to {last} rad/s"),
        _ => String::new(),
    };
    let head = format!(
        "{}: {}, {}, {}{span}, {depth}\n\n",
        text::printable(&water.name),
        reading.format,
        labels::counted(water.modules, "module"),
        match water.omega_rad_s.len() {
            1 => "1 frequency".to_owned(),
            several => format!("{several} frequencies"),
        },
    );
    let columns = ["check", "figure", "usual", "allowed", "outcome"].map(str::to_owned);
    let rows: Vec<Vec<Cell<'_>>> = judged.checks.iter().map(row).collect();
    let told = |what: &str, value: Option<f64>, unit: &str| {
        value.map_or(String::new(), |value| {
            format!("{what}: {} {unit}\n", labels::all_digits(value, 4))
        })
    };
    let left: Vec<String> = judged
        .memory_left
        .iter()
        .map(|share| format!("{:.2} %", 100.0 * share))
        .collect();
    let left = match left.as_slice() {
        [] => String::new(),
        some => format!("memory left after 5, 10 and 20 s: {}\n", some.join(", ")),
    };
    format!(
        "{head}{}\n{}{}{left}{}",
        text::table(&columns, &rows),
        told(
            "added mass at infinite frequency, heave of all",
            judged.infinite_heave_kg_m,
            "kg/m"
        ),
        told("memory at 0 s, heave of all", judged.memory_heave_n_m2, "N/m per m"),
        out.map_or(String::new(), |out| format!("water file in {}\n", out.display())),
    )
}

fn row(check: &JudgedCheck) -> Vec<Cell<'_>> {
    let figure = check
        .figure
        .map(|figure| Cell::Word(labels::all_digits(figure, 3).into()));
    vec![
        check.check.into(),
        figure.unwrap_or_default(),
        check.usual.as_deref().into(),
        check.allowed.as_deref().into(),
        check.outcome.into(),
    ]
}
