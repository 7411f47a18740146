//! The captions' file, in Markdown.
//!
//! Knows what Markdown would read as its own. Does not know figures.

use crate::figures::Figures;
use pontoon_results::labels::printable;

/// The captions of all figures, and what none holds.
pub(super) fn markdown(figures: &Figures) -> String {
    let mut text = format!("# Figures of {}\n", escaped(&figures.study));
    if let Some(reference) = &figures.reference {
        text += &format!("\nReference: {}\n", escaped(reference));
    }
    for figure in &figures.figures {
        let name = &figure.name;
        text += &format!(
            "\n## {}\n\n![]({name}.svg)\n\n{}\n",
            escaped(name),
            escaped(&figure.caption)
        );
    }
    if !figures.left_out.is_empty() {
        text += "\n## Left out\n\n";
        text.extend(figures.left_out.iter().map(|line| format!("- {}\n", escaped(line))));
    }
    text
}

/// Words that Markdown shows as they are.
fn escaped(text: &str) -> String {
    const READ: &str = "\\`*_[]<>#|~&!";
    let shown = |c: char| READ.contains(c).then_some('\\').into_iter().chain([c]);
    printable(text).chars().flat_map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_names_is_shown_and_not_read() {
        assert_eq!(escaped("a<b>_*[x](y)\n"), "a\\<b\\>\\_\\*\\[x\\](y) ");
    }
}
