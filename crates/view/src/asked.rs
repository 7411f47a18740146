//! What a study asks of limits, in words.
//!
//! Knows limits and searches. Does not know results.

use pontoon_plan::input::Cell;
use pontoon_plan::study_file::Study;
use pontoon_results::labels;

/// The limits of the study's bridge; none where no limits are stated.
pub fn limits(study: &Study) -> Option<String> {
    let allowed = study.limits.as_ref()?.of(&study.bridge.design).ok()?;
    let one = |of: &pontoon_plan::study_file::Allowed| {
        let word = of.limit.word();
        let beside = match of.beside {
            0.0 => String::new(),
            beside => format!(", of which {} at rest", labels::value(word, &Cell::Number(beside))),
        };
        let least = if of.limit.is_floor() { "at least " } else { "" };
        format!(
            "{} {least}{}{beside}",
            labels::label(word),
            labels::value(word, &Cell::Number(of.allowed))
        )
    };
    Some(allowed.iter().map(one).collect::<Vec<_>>().join("; "))
}

/// What a rating is of; none of another study.
pub fn search(study: &Study) -> Option<String> {
    let find = study.find.as_ref()?;
    let [from, to] = find
        .between()
        .map(|end| labels::value(&find.axis.name, &Cell::Number(end)));
    let sense = if find.is_largest { "largest" } else { "smallest" };
    Some(format!(
        "{sense} {} from {from} to {to} at which all limits hold",
        labels::label(&find.axis.name)
    ))
}

/// The columns whose numbers are values of the axis that is searched.
const OF_SEARCH: [&str; 3] = ["rated_value", "first_failure", "largest_pass"];

/// The unit of a column that its registry does not know: that of the axis that is searched.
pub(crate) fn searched_unit(study: Option<&Study>, column: &str) -> Option<&'static str> {
    let find = study?.find.as_ref()?;
    OF_SEARCH.contains(&column).then(|| labels::unit(&find.axis.name))
}
