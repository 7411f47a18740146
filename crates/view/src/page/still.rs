//! What a page says in its markup, until its script puts the whole report in its place.
//!
//! Knows that a server may forbid scripts, and that no text of the data is markup. Does not know how the report is drawn.

use crate::class_table::ClassTable;
use crate::report::Report;
use pontoon_plan::input::Cell;
use pontoon_results::labels;
use std::fmt::{self, Display};
use std::io::{self, Write};

/// Most rows of a table of modes.
const MOST_MODES: usize = 60;
/// Most characters of what a study asks.
const MOST_ASKED: usize = 2000;

/// What a reader must know first.
pub(super) const SENTENCE: &str = "This page needs scripts for its figures and for its other tables. They do not run here: they are \
    switched off, or the server forbids them. Saved to a file and opened from there, the page shows all.";

/// A text in which no character is markup.
struct Text<'a>(&'a str);

impl Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rest = self.0;
        while let Some(at) = rest.find(['<', '>', '&', '"', '\'']) {
            f.write_str(&rest[..at])?;
            write!(f, "&#{};", rest.as_bytes()[at])?;
            rest = &rest[at + 1..];
        }
        f.write_str(rest)
    }
}

/// Writes the report's first part as markup.
pub(super) fn write(report: &Report, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "<main id=\"main\" tabindex=\"-1\">")?;
    writeln!(to, "<h1>{}</h1>", Text(&report.study.name))?;
    if let Some(question) = &report.study.question {
        let end = question
            .char_indices()
            .nth(MOST_ASKED)
            .map_or(question.len(), |(at, _)| at);
        writeln!(to, "<p class=\"question\">{}</p>", Text(&question[..end]))?;
    }
    writeln!(to, "<p class=\"note\">{SENTENCE}</p>")?;
    let jobs = &report.jobs;
    writeln!(
        to,
        "<p>{} of {} jobs done, {} failed, {} missing</p>",
        jobs.ok, jobs.total, jobs.failed, jobs.missing
    )?;
    for note in &report.notes {
        writeln!(to, "<p>{}</p>", Text(note))?;
    }
    classes(report, to)?;
    cards(report, to)?;
    against(report, to)?;
    modes(report, to)?;
    writeln!(to, "</main>")
}

fn classes(report: &Report, to: &mut dyn Write) -> io::Result<()> {
    let Some(classes) = &report.classes else {
        return Ok(());
    };
    writeln!(to, "<h2>Classes</h2>")?;
    writeln!(to, "<p>{}</p>", Text(ClassTable::LEGEND))?;
    let head: Vec<&str> = classes.names.iter().chain(&classes.heads).map(String::as_str).collect();
    table(to, &head, classes.lines())
}

fn cards(report: &Report, to: &mut dyn Write) -> io::Result<()> {
    if report.cards.is_empty() {
        return Ok(());
    }
    writeln!(to, "<h2>Largest values</h2>")?;
    let lines = report.cards.iter().map(|card| {
        let value = labels::value_in(card.unit, card.value);
        let job = card.job.map(|job| format!("job {job}")).unwrap_or_default();
        vec![card.label.to_owned(), value, card.place.clone(), job, card.axes.clone()]
    });
    table(to, &["measure", "value", "where", "job", "of"], lines)
}

fn against(report: &Report, to: &mut dyn Write) -> io::Result<()> {
    let table_of = &report.against;
    let Some(axis) = table_of.axis.as_deref().filter(|_| !report.measures.is_empty()) else {
        return Ok(());
    };
    writeln!(to, "<h2>Largest values against {}</h2>", Text(axis))?;
    let head: Vec<&str> = std::iter::once(axis)
        .chain(report.measures.iter().map(|measure| measure.label))
        .collect();
    let lines = table_of.rows.iter();
    table(
        to,
        &head,
        lines.map(|(bin, values)| [std::slice::from_ref(bin), values].concat()),
    )
}

fn modes(report: &Report, to: &mut dyn Write) -> io::Result<()> {
    if report.mode_table.is_empty() {
        return Ok(());
    }
    writeln!(to, "<h2>Natural frequencies</h2>")?;
    let lines = report.mode_table.iter().take(MOST_MODES).map(|mode| {
        let frequency = labels::value("frequency_hz", &Cell::Number(mode.frequency_hz));
        vec![
            mode.job.to_string(),
            mode.axes.clone(),
            mode.number.to_string(),
            frequency,
            mode.shape.clone(),
        ]
    });
    table(to, &["job", "of", "mode", "frequency", "shape"], lines)
}

fn table(to: &mut dyn Write, head: &[&str], lines: impl Iterator<Item = Vec<String>>) -> io::Result<()> {
    write!(to, "<div class=\"scroll\"><table class=\"plain\"><thead><tr>")?;
    head.iter()
        .try_for_each(|name| write!(to, "<th scope=\"col\">{}</th>", Text(name)))?;
    writeln!(to, "</tr></thead><tbody>")?;
    for line in lines {
        write!(to, "<tr>")?;
        line.iter().try_for_each(|cell| write!(to, "<td>{}</td>", Text(cell)))?;
        writeln!(to, "</tr>")?;
    }
    writeln!(to, "</tbody></table></div>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_is_markup() {
        let said = Text("</main><b a=\"1\">ü & 'x'").to_string();
        assert_eq!(said, "&#60;/main&#62;&#60;b a=&#34;1&#34;&#62;ü &#38; &#39;x&#39;");
    }
}
