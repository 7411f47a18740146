//! Single points as they are written: the `cases` of a design.
//!
//! Knows that cases of a study mostly name the same axes in the same order: those are kept as columns, eight bytes a number,
//! so that a file of a hundred megabytes is read in little more than its text takes. Does not know what an axis may be called.

use super::column::ValueColumn;
use crate::input::Cell;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::Value;
use std::fmt;
use std::sync::Arc;

/// Cases in the order of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cases {
    pub(super) runs: Vec<CaseRun>,
}

/// Cases one after the other that name the same axes in the same order.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct CaseRun {
    /// The place of the first among all cases of the design.
    pub(super) first: usize,
    /// Number of cases.
    pub(super) count: usize,
    /// Names of the axes.
    pub(super) names: Vec<String>,
    /// The values of each axis.
    pub(super) columns: Arc<Vec<ValueColumn>>,
}

impl Cases {
    /// Appends a case; `names` are its axes where they are not those of the case before.
    fn push(&mut self, names: Option<Vec<String>>, values: &mut Vec<Cell<'static>>) {
        let first = self.runs.last().map_or(0, |run| run.first + run.count);
        if names.is_some() || self.runs.is_empty() {
            let names = names.unwrap_or_default();
            self.runs.push(CaseRun {
                first,
                count: 0,
                columns: Arc::new(vec![ValueColumn::default(); names.len()]),
                names,
            });
        }
        if let Some(run) = self.runs.last_mut() {
            run.count += 1;
            for (column, value) in Arc::make_mut(&mut run.columns).iter_mut().zip(values.drain(..)) {
                column.push(value);
            }
        }
    }
}

impl<'de> Deserialize<'de> for Cases {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(CasesVisitor)
    }
}

struct CasesVisitor;

impl<'de> Visitor<'de> for CasesVisitor {
    type Value = Cases;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of cases")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Cases, A::Error> {
        let (mut cases, mut values) = (Cases::default(), Vec::new());
        while seq
            .next_element_seed(NextCase {
                cases: &mut cases,
                values: &mut values,
            })?
            .is_some()
        {}
        Ok(cases)
    }
}

/// The next case, to be appended to those before.
struct NextCase<'a> {
    cases: &'a mut Cases,
    values: &'a mut Vec<Cell<'static>>,
}

impl<'de> DeserializeSeed<'de> for NextCase<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for NextCase<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of axes")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        self.values.clear();
        let known: &[String] = self.cases.runs.last().map_or(&[], |run| &run.names);
        let mut own: Option<Vec<String>> = None;
        loop {
            let place = self.values.len();
            let expected = known.get(place).filter(|_| own.is_none()).map(String::as_str);
            match map.next_key_seed(NextName(expected))? {
                None => break,
                Some(None) => {}
                Some(Some(other)) => own.get_or_insert_with(|| known[..place].to_vec()).push(other),
            }
            self.values.push(map.next_value::<CaseCell>()?.0);
        }
        if own.is_none() && self.values.len() < known.len() {
            own = Some(known[..self.values.len()].to_vec());
        }
        self.cases.push(own, self.values);
        Ok(())
    }
}

/// The name of an axis: nothing where it is the expected one.
struct NextName<'a>(Option<&'a str>);

impl<'de> DeserializeSeed<'de> for NextName<'_> {
    type Value = Option<String>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl Visitor<'_> for NextName<'_> {
    type Value = Option<String>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of an axis")
    }

    fn visit_str<E>(self, name: &str) -> Result<Self::Value, E> {
        Ok((self.0 != Some(name)).then(|| name.to_owned()))
    }
}

/// The value of an axis.
struct CaseCell(Cell<'static>);

impl<'de> Deserialize<'de> for CaseCell {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(CellVisitor).map(Self)
    }
}

struct CellVisitor;

impl<'de> Visitor<'de> for CellVisitor {
    type Value = Cell<'static>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(Cell::Nothing)
    }

    fn visit_bool<E>(self, yes: bool) -> Result<Self::Value, E> {
        Ok(Cell::Flag(yes))
    }

    fn visit_i64<E>(self, x: i64) -> Result<Self::Value, E> {
        Ok(Cell::Whole(x))
    }

    fn visit_u64<E>(self, x: u64) -> Result<Self::Value, E> {
        Ok(i64::try_from(x).map_or(Cell::Number(x as f64), Cell::Whole))
    }

    fn visit_f64<E>(self, x: f64) -> Result<Self::Value, E> {
        Ok(Cell::Number(x))
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<Self::Value, E> {
        Ok(Cell::Word(word.to_owned().into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
        let list = Value::deserialize(SeqAccessDeserializer::new(seq))?;
        Ok(Cell::Tree(Arc::new(list)))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        let object = Value::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Cell::Tree(Arc::new(object)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::typed_value;
    use serde_json::json;
    use std::path::Path;

    /// Each case as names and values.
    fn read(written: &Value) -> Vec<Vec<(String, Value)>> {
        let cases: Cases = typed_value(Path::new("study.json"), "", written).unwrap();
        let case = |run: &CaseRun, i: usize| -> Vec<(String, Value)> {
            let names = run.names.iter().cloned();
            names
                .zip(run.columns.iter().map(|column| column.at(i).value()))
                .collect()
        };
        let of_run = |run: &CaseRun| (0..run.count).map(|i| case(run, i)).collect::<Vec<_>>();
        cases.runs.iter().flat_map(of_run).collect()
    }

    #[test]
    fn cases_are_read_as_they_are_written_whatever_axes_they_name() {
        let written = json!([
            {"a": 1, "b": "x"}, {"a": 2.5, "b": "y"}, {"b": "z", "a": 3}, {"a": 4}, {}, {"c": [1, {"d": 2}]}, {"a": 5, "c": null}
        ]);
        let expected: Vec<Vec<(String, Value)>> = written
            .as_array()
            .unwrap()
            .iter()
            .map(|case| case.as_object().unwrap().clone().into_iter().collect())
            .collect();
        assert_eq!(read(&written), expected);
    }

    #[test]
    fn cases_of_the_same_axes_are_one_run() {
        let written = json!([{"a": 1, "b": 2}, {"a": 3, "b": 4}, {"a": 5}, {"a": 6}]);
        let cases: Cases = typed_value(Path::new("study.json"), "", &written).unwrap();
        let runs: Vec<(usize, usize)> = cases.runs.iter().map(|run| (run.first, run.count)).collect();
        assert_eq!(runs, [(0, 2), (2, 2)]);
    }

    #[test]
    fn what_is_no_case_is_refused_with_its_place() {
        let e = typed_value::<Cases>(Path::new("study.json"), "cases", &json!([{"a": 1}, 7])).unwrap_err();
        assert_eq!((e.path.as_str(), e.allowed.as_str()), ("cases[1]", "an object"), "{e}");
    }
}
