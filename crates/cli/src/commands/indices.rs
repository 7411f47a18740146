//! `pontoon indices`: which axes an output hangs on.

use crate::args::{Common, Format, IndicesArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use pontoon_results::{DesignIndices, FactorIndices, Indices, OutputIndices, Resampling, Results, TableName, labels};
use serde_json::json;
use unicode_width::UnicodeWidthStr;

/// Computes the indices and prints them.
pub(crate) fn indices(arguments: &IndicesArguments, common: Common) -> Result<ExitStatus> {
    let results = Results::read_some(&arguments.results, &[TableName::Jobs])?;
    let resampling = Resampling {
        resamples: usize::from(arguments.resamples),
        seed: arguments.seed as u64,
    };
    let found = Indices::of(&results, &arguments.of, resampling)?;
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!(found)),
        _ => found
            .designs
            .iter()
            .map(|design| of_design(design, resampling))
            .collect::<String>(),
    })?;
    Ok(if found.has_failed() {
        ExitStatus::Short
    } else {
        ExitStatus::Good
    })
}

fn of_design(design: &DesignIndices, resampling: Resampling) -> String {
    let mut told = format!(
        "{}: {} groups of {} points, {}; intervals from {} resamples, seed {}\n",
        text::printable(&design.design),
        text::grouped(design.groups as u64),
        design.points,
        labels::counted(design.factors.len(), "factor"),
        resampling.resamples,
        resampling.seed
    );
    if design.failed > 0 {
        told += &format!("{} with a failed job\n", labels::counted(design.failed, "group"));
    }
    for output in &design.outputs {
        told += &format!("\n{}\n{}", heading(output, design.groups), of_output(output));
    }
    told + "\n"
}

/// The output and how many groups it has.
fn heading(output: &OutputIndices, groups: usize) -> String {
    let used = text::grouped((groups - output.left_out) as u64);
    let of = text::grouped(groups as u64);
    format!("{}: {used} of {of} groups, {} left out", output.column, output.left_out)
}

fn of_output(output: &OutputIndices) -> String {
    match &output.indices {
        None => "no indices: too few groups, or the same number everywhere\n".to_owned(),
        Some(FactorIndices::Sobol { factors, pairs }) => {
            let rows = factors.iter().map(|of| {
                let index = &of.index;
                let numbers = [index.s1, index.s1_conf, index.st, index.st_conf];
                (of.axis.clone(), numbers.map(share).to_vec())
            });
            let told = table(&["factor", "s1", "s1_conf", "st", "st_conf"], &rows.collect::<Vec<_>>());
            if pairs.is_empty() {
                return told;
            }
            let rows = pairs.iter().map(|of| {
                let numbers = [of.index.s2, of.index.s2_conf];
                (of.axes.join(" x "), numbers.map(share).to_vec())
            });
            told + &table(&["pair", "s2", "s2_conf"], &rows.collect::<Vec<_>>())
        }
        Some(FactorIndices::Morris { factors }) => {
            let rows = factors.iter().map(|of| {
                let index = &of.index;
                let numbers = [
                    Some(index.mu),
                    Some(index.mu_star),
                    Some(index.mu_star_conf),
                    index.sigma,
                ];
                let digits = |x: f64| labels::all_digits(x, 4);
                let told = numbers.map(|x| x.map_or_else(|| "-".to_owned(), digits));
                (of.axis.clone(), told.to_vec())
            });
            table(
                &["factor", "mu", "mu_star", "mu_star_conf", "sigma"],
                &rows.collect::<Vec<_>>(),
            )
        }
    }
}

/// A share to four decimals, nought without a sign.
fn share(x: f64) -> String {
    format!("{:.4}", (x * 1e4).round() / 1e4 + 0.0)
}

/// Lines of a name and numbers under their heads, numbers to the right.
fn table(heads: &[&str], rows: &[(String, Vec<String>)]) -> String {
    let [name, of_numbers @ ..] = heads else {
        return String::new();
    };
    let widest = |cells: &mut dyn Iterator<Item = &str>| cells.map(UnicodeWidthStr::width).max().unwrap_or(0);
    let first = widest(&mut rows.iter().map(|(name, _)| name.as_str()).chain([*name]));
    let width = |i: usize| {
        widest(
            &mut rows
                .iter()
                .map(|(_, numbers)| numbers[i].as_str())
                .chain([of_numbers[i]]),
        )
    };
    let widths: Vec<usize> = (0..of_numbers.len()).map(width).collect();
    let line = |name: &str, numbers: &mut dyn Iterator<Item = &str>| {
        let cells = numbers
            .zip(&widths)
            .map(|(number, &width)| format!("  {}", text::padded(number, width, true)));
        format!("{}{}\n", text::padded(name, first, false), cells.collect::<String>())
    };
    let lines = rows
        .iter()
        .map(|(name, numbers)| line(name, &mut numbers.iter().map(String::as_str)));
    line(name, &mut of_numbers.iter().copied()) + &lines.collect::<String>()
}
