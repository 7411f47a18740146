//! The page of a report: template, style, script and data in one file, and what it says where its script may not run.
//!
//! Knows where in the template each belongs and that no text of the data may end its element. Does not know what the data
//! says: `crates/view/page/README.md` tells.

mod still;

use crate::report::Report;
use std::io::{self, Write};

const TEMPLATE: &str = include_str!("../page/page.html");
const STYLE: &str = include_str!("../page/style.css");
const SCRIPT: &str = include_str!(concat!(env!("OUT_DIR"), "/page.js"));

/// What every page of this program begins with, and nothing else should.
pub const MARK: &str = "<title>pontoon report</title>";

/// Writes the page of a report.
///
/// # Errors
/// What the writer says.
pub fn write(report: &Report, to: &mut dyn Write) -> io::Result<()> {
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once("{{") {
        to.write_all(before.as_bytes())?;
        let (place, after) = after.split_once("}}").unwrap_or((after, ""));
        match place {
            "style" => to.write_all(STYLE.as_bytes())?,
            "script" => to.write_all(SCRIPT.as_bytes())?,
            "still" => still::write(report, to)?,
            "data" => serde_json::to_writer(Escaping(to), report)?,
            other => return Err(io::Error::other(format!("no place {other} in a page"))),
        }
        rest = after;
    }
    to.write_all(rest.as_bytes())
}

/// Passes JSON on with every character escaped that could end the element that it stands in: all of them occur within
/// strings alone.
struct Escaping<'a>(&'a mut dyn Write);

impl Write for Escaping<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut rest = bytes;
        while let Some(at) = rest.iter().position(|byte| matches!(byte, b'<' | b'>' | b'&')) {
            self.0.write_all(&rest[..at])?;
            write!(self.0, "\\u{:04x}", rest[at])?;
            rest = &rest[at + 1..];
        }
        self.0.write_all(rest)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_of_the_data_ends_its_element() {
        let mut written = Vec::new();
        serde_json::to_writer(Escaping(&mut written), &["</script><b>&", "plain"]).unwrap();
        let text = String::from_utf8(written).unwrap();
        assert_eq!(text, r#"["\u003c/script\u003e\u003cb\u003e\u0026","plain"]"#);
        let back: Vec<String> = serde_json::from_str(&text).unwrap();
        assert_eq!(back, ["</script><b>&", "plain"]);
    }

    #[test]
    fn the_template_has_its_places_and_its_mark() {
        for place in ["{{style}}", "{{still}}", "{{script}}", "{{data}}", MARK] {
            assert_eq!(TEMPLATE.matches(place).count(), 1, "{place}");
        }
        assert!(!SCRIPT.contains("</script"));
    }
}
