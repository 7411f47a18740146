//! `pontoon calibrate`: a bridge's numbers identified from references.

use crate::args::{CalibrateArguments, Common, Format};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::{Context, Result};
use pontoon_journal::place::Folder;
use pontoon_judge::calibrate::{Calibration, CalibrationTask, FittedCheck, Identified, Parameters};
use pontoon_judge::reference::Reference;
use pontoon_plan::input::{Cell, Refusal, pretty};
use pontoon_plan::study_file::{BridgeFile, read_bridge};
use pontoon_results::labels;
use pontoon_results::replaceable;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Fits, writes the bridge and says what was found.
pub(crate) fn calibrate(arguments: &CalibrateArguments, common: Common) -> Result<ExitStatus> {
    let bridge = read_bridge(&arguments.bridge)?;
    check_water_place(&bridge, &arguments.out)?;
    let references = arguments
        .with
        .iter()
        .map(|path| Reference::open(path))
        .collect::<Result<Vec<_>, _>>()?;
    let parameters = Parameters::open(&arguments.parameters)?;
    let out = file_of(&arguments.out, &arguments.bridge)?;
    let told = |candidates: usize, least: f64| {
        if !common.quiet {
            text::note(&format!(
                "{}, least sum of squares {least:.4}",
                labels::counted(candidates, "candidate")
            ));
        }
    };
    let task = CalibrationTask::new(&bridge, &references, &parameters, &told)?;
    let (folder, name) = place(&out)?;
    let found = task.fit(arguments.threads.map_or(0, usize::from))?;
    let written = pretty(&found.bridge);
    // what may have come there in the meantime
    file_of(&arguments.out, &arguments.bridge)?;
    folder
        .write(&name, |file| std::io::Write::write_all(file, written.as_bytes()))
        .context("bridge not written")?;
    for failed in &found.failed {
        text::note(&format!("failed inside the bounds: {failed}"));
    }
    for far in far_off(&found.checks) {
        text::note(&far);
    }
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(found)),
        _ => text(&found, &arguments.out),
    })?;
    Ok(if found.converged {
        ExitStatus::Good
    } else {
        ExitStatus::Short
    })
}

/// Refuses a file for the bridge found in another folder than that to which its water file is relative.
fn check_water_place(bridge: &BridgeFile, out: &Path) -> Result<(), Refusal> {
    let Some(water) = bridge
        .design
        .water
        .as_ref()
        .filter(|water| Path::new(&water.file).is_relative())
    else {
        return Ok(());
    };
    let folder = |file: &Path| {
        let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty());
        parent.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    if folder(out).is_some() && folder(out) == folder(&bridge.file) {
        return Ok(());
    }
    let allowed = format!(
        "a file in the folder of {}, to which its water {} is relative",
        bridge.file.display(),
        water.file
    );
    Err(Refusal::new(out, "", "a file in another folder", allowed))
}

/// The file for the bridge found: not the bridge that the fit starts from, and no file that another program or a person wrote.
fn file_of(out: &Path, start: &Path) -> Result<PathBuf, Refusal> {
    if out.exists() && out.canonicalize().ok() == start.canonicalize().ok() {
        let found = "the bridge that the fit starts from";
        return Err(Refusal::new(out, "", found, "another file for the bridge found"));
    }
    replaceable(out, "a bridge of `pontoon calibrate`", |bytes| {
        let document: Result<Value, _> = serde_json::from_slice(bytes);
        let program = document.ok().map(|bridge| bridge["provenance"]["program"].clone());
        program.is_some_and(|program| program.as_str().is_some_and(|program| program.starts_with(PROGRAM)))
    })
}

/// How the provenance of a bridge names this program.
const PROGRAM: &str = "pontoon calibrate";

/// The folder of a file, made where it is missing, and the file's name.
fn place(out: &Path) -> Result<(Folder, String)> {
    let folder = out.parent().filter(|parent| !parent.as_os_str().is_empty());
    let folder = Folder::create(folder.unwrap_or(Path::new("."))).context("no place for the bridge")?;
    Ok((
        folder,
        out.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    ))
}

/// Digits of a number that was fitted.
const FITTED: usize = 6;

fn number(x: f64) -> Cell<'static> {
    Cell::Word(labels::all_digits(x, FITTED).into())
}

fn columns(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn text(found: &Calibration, out: &Path) -> String {
    let all = found.parameters.iter().all(|p| p.standard_error.is_some());
    let undetermined = match found.undetermined.as_slice() {
        [] if all => "the data determine every parameter\n".to_owned(),
        list => list
            .iter()
            .map(|d| format!("the data do not determine {d}\n"))
            .collect(),
    };
    format!(
        "{}\n{}\n{}\n{undetermined}sum of squares {:.4} before, {:.4} after; {}, {} condensed, {} failed\n{}: {}\nbridge in {}\n",
        checks(&found.checks),
        parameters(&found.parameters),
        correlation(found),
        found.sum_of_squares_start,
        found.sum_of_squares_best,
        labels::counted(found.evaluations, "candidate"),
        labels::counted(found.condensations, "module"),
        labels::counted(found.failed.len(), "candidate"),
        if found.converged { "converged" } else { "not converged" },
        found.ending,
        out.display()
    )
}

/// Tolerances by which a check of the best fit may be off before that is told: a model that fits is off by one or two.
const FAR: f64 = 3.0;

/// The checks that the best fit still misses by many tolerances, the farthest first.
fn far_off(checks: &[FittedCheck]) -> Vec<String> {
    let mut far: Vec<&FittedCheck> = checks.iter().filter(|check| check.residual_after.abs() > FAR).collect();
    far.sort_by(|a, b| b.residual_after.abs().total_cmp(&a.residual_after.abs()));
    let told = |check: &&FittedCheck| {
        let times = labels::all_digits(check.residual_after.abs(), 2);
        format!(
            "the best fit misses {} by {times} tolerances: {} found, {} expected",
            check.id,
            labels::all_digits(check.after, FITTED),
            labels::all_digits(check.expected, FITTED)
        )
    };
    far.iter().map(told).collect()
}

/// A row a check: what it is off before and after.
fn checks(checks: &[FittedCheck]) -> String {
    let share = |x: f64| {
        let text = if x.abs() < 1e6 {
            format!("{x:+.3}")
        } else {
            format!("{x:+.3e}")
        };
        Cell::Word(text.into())
    };
    let row = |check: &FittedCheck| {
        let numbers = [check.expected, check.before, check.after].map(number);
        let residuals = [check.residual_before, check.residual_after].map(share);
        [
            vec![Cell::Word(check.id.clone().into())],
            numbers.to_vec(),
            residuals.to_vec(),
        ]
        .concat()
    };
    text::table(
        &columns(&["check", "expected", "before", "after", "off before", "off after"]),
        &checks.iter().map(row).collect::<Vec<_>>(),
    )
}

/// A row a parameter.
fn parameters(parameters: &[Identified]) -> String {
    let row = |p: &Identified| {
        let [lower, upper] = [p.lower, p.upper].map(|x| labels::all_digits(x, FITTED));
        vec![
            Cell::Word(p.name.clone().into()),
            number(p.start),
            number(p.found),
            p.standard_error.map_or(Cell::Nothing, number),
            Cell::Word(format!("{lower} to {upper}").into()),
            Cell::Word(p.remark.clone().unwrap_or_default().into()),
        ]
    };
    text::table(
        &columns(&["parameter", "start", "found", "standard error", "bounds", "remark"]),
        &parameters.iter().map(row).collect::<Vec<_>>(),
    )
}

/// How far each two parameters move together.
fn correlation(found: &Calibration) -> String {
    let names = (1..=found.parameters.len()).map(|i| format!("({i})"));
    let heads: Vec<String> = std::iter::once("correlation".to_owned()).chain(names).collect();
    let rows = found.correlation.iter().zip(&found.parameters).enumerate();
    let rows = rows.map(|(i, (row, p))| {
        let cells = row
            .iter()
            .map(|r| r.map_or(Cell::Nothing, |r| Cell::Word(format!("{r:+.2}").into())));
        let name = Cell::Word(format!("({}) {}", i + 1, p.name).into());
        std::iter::once(name).chain(cells).collect()
    });
    text::table(&heads, &rows.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_that_the_best_fit_misses_by_many_tolerances_are_told_the_farthest_first() {
        let check = |id: &str, after: f64| FittedCheck {
            id: id.to_owned(),
            expected: 1.0,
            tolerance: 0.1,
            before: 0.0,
            after,
            residual_before: -10.0,
            residual_after: (after - 1.0) / 0.1,
        };
        let told = far_off(&[check("near", 1.1), check("far", 1.5), check("farthest", -0.2)]);
        assert_eq!(
            told,
            [
                "the best fit misses farthest by 12 tolerances: -0.200000 found, 1.00000 expected",
                "the best fit misses far by 5.0 tolerances: 1.50000 found, 1.00000 expected",
            ]
        );
    }
}
