//! `pontoon report`: results as a page, and as figures for papers.

use crate::args::{Common, Format, ReportArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use pontoon_journal::place::{Folder, FolderError};
use pontoon_judge::compare::{Comparison, against_reference};
use pontoon_judge::reference::Reference;
use pontoon_plan::input::Refusal;
use pontoon_results::{PAGE, labels, replaceable};
use pontoon_study::run::Cache;
use pontoon_view::figures::{Figures, marks};
use pontoon_view::report::{OpenedResults, Report, ReportSetting};
use pontoon_view::{drawing, page};
use serde_json::json;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Shapes that a page animates, from the lowest.
const MODES: usize = 16;

/// Bytes of a file in which it shows whether it is a page.
const HEAD: usize = 4096;

/// Writes figures where they are asked for, and a page unless they alone are.
pub(crate) fn report(arguments: &ReportArguments, common: Common) -> Result<ExitStatus> {
    match &arguments.figures {
        Some(folder) => {
            let drawn = draw(arguments, folder, common)?;
            match arguments.out {
                Some(_) => Ok(page_of(arguments, common)?.and(drawn)),
                None => Ok(drawn),
            }
        }
        None => page_of(arguments, common),
    }
}

/// Opens results and draws their figures.
fn draw(arguments: &ReportArguments, folder: &Path, common: Common) -> Result<ExitStatus> {
    let OpenedResults { results, notes, .. } = OpenedResults::open(&arguments.results, true)?;
    let reference = arguments.with.as_deref().map(Reference::open).transpose()?;
    let compared = reference
        .as_ref()
        .map(|reference| against_reference(&results, reference))
        .transpose()?;
    let made = Figures::of(&results, reference.as_ref())?;
    let files = drawing::write(&made, folder)?;
    let paths: Vec<String> = files
        .iter()
        .map(|file| folder.join(file).display().to_string())
        .collect();
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!({ "files": paths, "left_out": made.left_out })),
        _ => paths.iter().map(|path| format!("{path}\n")).collect(),
    })?;
    if !common.quiet {
        notes.iter().for_each(|note| text::note(note));
        for line in &made.left_out {
            text::note(&format!("left out: {line}"));
        }
    }
    let failed = (0..results.jobs().rows()).any(|row| results.is_failed(row));
    let good = compared.as_ref().is_none_or(Comparison::good) && !failed;
    Ok(if good { ExitStatus::Good } else { ExitStatus::Short })
}

/// Opens results, gathers what a page tells of them and writes it.
fn page_of(arguments: &ReportArguments, common: Common) -> Result<ExitStatus> {
    let out = page_file(arguments)?;
    let found = OpenedResults::open(&arguments.results, arguments.with.is_some())?;
    let reference = arguments.with.as_deref().map(Reference::open).transpose()?;
    let judged = match &reference {
        Some(reference) => Some((
            against_reference(&found.results, reference)?,
            marks(&found.results, reference)?,
        )),
        None => None,
    };
    let (compared, marks) = judged.unzip();
    let setting = ReportSetting {
        plays: usize::from(arguments.plays),
        modes: MODES,
        cache: Cache::of_user(),
        commit: crate::commit::COMMIT.map(str::to_owned),
    };
    let report = Report::new(found, compared.as_ref(), marks.unwrap_or_default(), &setting)?;
    let bytes = write(&report, &out)?;
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", object(&report, compared.as_ref(), &out, bytes)),
        _ => text(&report, compared.as_ref(), &out, bytes),
    })?;
    if !common.quiet {
        report.notes.iter().for_each(|note| text::note(note));
    }
    let good = compared.as_ref().is_none_or(Comparison::good) && report.jobs.failed == 0;
    Ok(if good { ExitStatus::Good } else { ExitStatus::Short })
}

/// The page's file.
fn page_file(arguments: &ReportArguments) -> Result<PathBuf, Refusal> {
    let asked = arguments.out.clone().unwrap_or_else(|| arguments.results.join(PAGE));
    replaceable(&asked, "a page of `pontoon report`", |bytes| {
        let head = &bytes[..bytes.len().min(HEAD)];
        head.windows(page::MARK.len())
            .any(|window| window == page::MARK.as_bytes())
    })
}

/// Writes the page whole or not at all; its size in bytes.
fn write(report: &Report, out: &Path) -> Result<u64, FolderError> {
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    Folder::create(folder.unwrap_or(Path::new(".")))?.write(&name, |to| {
        let mut to = BufWriter::new(to);
        page::write(report, &mut to)?;
        to.flush()
    })?;
    let size = out.metadata().map(|data| data.len());
    Ok(size.unwrap_or_default())
}

fn text(report: &Report, compared: Option<&Comparison>, out: &Path, bytes: u64) -> String {
    let jobs = report.jobs;
    let count = |n: usize, what: &str| match n {
        0 => String::new(),
        n => format!(", {n} {what}"),
    };
    let mut text = format!(
        "jobs {}{}{}; {} to play, {}\n",
        jobs.total,
        count(jobs.failed, "failed"),
        count(jobs.missing, "missing"),
        labels::counted(report.plays.len(), "crossing"),
        labels::counted(report.modes.iter().map(|set| set.list.len()).sum(), "mode shape"),
    );
    if let Some(compared) = compared {
        text += &format!("{}\n", compared.tally());
    }
    text + &format!("page of {:.1} MB in {}\n", 1e-6 * bytes as f64, out.display())
}

fn object(report: &Report, compared: Option<&Comparison>, out: &Path, bytes: u64) -> serde_json::Value {
    json!({
        "study": report.study.name,
        "page": out.display().to_string(),
        "bytes": bytes,
        "jobs": report.jobs,
        "plays": report.plays.len(),
        "notes": report.notes,
        "good": compared.map(Comparison::good),
    })
}
