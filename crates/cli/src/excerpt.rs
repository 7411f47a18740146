//! The place of a file that a refusal is about, with its line and a mark under it.
//!
//! Knows how a place is shown and what is said at it. Does not know how it is found in the text.

use crate::terminal::TextStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet, renderer::DecorStyle};
use pontoon_plan::input::{Mark, MarkKind, Refusal, RefusalKind, mark, without_mark};
use pontoon_results::labels::printable;
use std::fs;
use std::ops::Range;
use std::path::Path;

/// Largest file that is read again to show a place of it `[bytes]`.
const LARGEST: u64 = 1 << 26;
/// Longest label `[characters]`: what is longer is in the message above it.
const LONGEST_LABEL: usize = 72;
/// Characters of a line where the place does not say how many it has.
const WIDTH: usize = 120;

/// The place that a refusal is about, where it is one of a file that a person wrote. Ends in a line end.
pub(crate) fn excerpt(refusal: &Refusal, text_style: TextStyle) -> Option<String> {
    let text = text_of(&refusal.file)?;
    let mark = mark(&text, refusal)?;
    Some(shown(
        &refusal.file.display().to_string(),
        &text,
        &mark,
        &label(refusal, &mark.kind),
        text_style,
    ))
}

/// Where in a file something stands, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlaceInFile {
    /// Line and column where it begins.
    pub start: (usize, usize),
    /// Line and column behind its end.
    pub end: (usize, usize),
}

/// The place that a refusal is about, where it is one of a file that a person wrote.
pub fn place_in_file(refusal: &Refusal) -> Option<PlaceInFile> {
    let text = text_of(&refusal.file)?;
    let Range { start, end } = mark(&text, refusal)?.bytes;
    let place = |byte: usize| {
        let before = text.get(..byte)?;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        Some((before.matches('\n').count() + 1, column))
    };
    Some(PlaceInFile {
        start: place(start)?,
        end: place(end)?,
    })
}

/// The text of a file; none of what is no file of its own, of a manifest (which this program writes), and of one too large.
fn text_of(file: &Path) -> Option<String> {
    let known = fs::metadata(file).ok()?;
    let written_here = file.file_name().is_some_and(|name| name == "manifest.json");
    if !known.is_file() || known.len() > LARGEST || written_here {
        return None;
    }
    fs::read_to_string(file).ok().map(|text| without_mark(&text).to_owned())
}

/// What is said at the place.
fn label(refusal: &Refusal, kind: &MarkKind) -> String {
    let allowed = || match refusal.allowed.as_str() {
        "" => "not allowed".to_owned(),
        allowed => format!("allowed: {allowed}"),
    };
    let label = match kind {
        MarkKind::Fault(Some(message)) => message.clone(),
        MarkKind::Fault(None) => allowed(),
        MarkKind::Twice(_) => "again here".to_owned(),
        MarkKind::Around if refusal.kind == RefusalKind::Missing && refusal.found.is_nothing() => {
            format!("{} is missing", refusal.name())
        }
        MarkKind::Around if refusal.kind == RefusalKind::Missing => allowed(),
        MarkKind::Around => refusal.found.text(),
        MarkKind::Key | MarkKind::Value => match &refusal.nearest {
            Some(nearest) => format!("nearest known: {nearest}"),
            None => allowed(),
        },
    };
    let label = printable(&label);
    if label.chars().count() <= LONGEST_LABEL {
        return label;
    }
    match kind {
        MarkKind::Key | MarkKind::Value => "not allowed".to_owned(),
        _ => label.chars().take(LONGEST_LABEL - 3).collect::<String>() + "...",
    }
}

/// A place of a text.
fn shown(file: &str, text: &str, mark: &Mark, label: &str, text_style: TextStyle) -> String {
    let first = match &mark.kind {
        MarkKind::Twice(first) => Some(first.clone()),
        _ => None,
    };
    // the lines from the first mark to the last
    let begin = first.as_ref().map_or(mark.bytes.start, |first| first.start);
    let from = text[..begin].rfind('\n').map_or(0, |end| end + 1);
    let to = text[mark.bytes.end..]
        .find('\n')
        .map_or(text.len(), |end| mark.bytes.end + end);
    let within = |bytes: &Range<usize>| bytes.start - from..bytes.end - from;
    let mut snippet = Snippet::source(text[from..to].trim_end_matches('\r'))
        .line_start(1 + text[..from].matches('\n').count())
        .path(file)
        .annotation(AnnotationKind::Primary.span(within(&mark.bytes)).label(label));
    if let Some(first) = &first {
        snippet = snippet.annotation(AnnotationKind::Context.span(within(first)).label("first here"));
    }
    let renderer = if text_style.colour {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let renderer = renderer
        .term_width(text_style.width.unwrap_or(WIDTH))
        .decor_style(DecorStyle::Ascii);
    let report = &[Group::with_level(Level::ERROR).element(snippet)];
    let lines = renderer.render(report);
    lines.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}
