//! A folder with a study and its bridge, the program run in it, and what it left.

use crate::refusals;
use polars_arrow::array::{Array, BooleanArray, PrimitiveArray, Utf8ViewArray};
use polars_arrow::compute::concatenate::concatenate;
use polars_parquet::read::{BasicDecompressor, FileMetadata, PageReader, column_iter_to_arrays};
use polars_parquet::read::{infer_schema, read_metadata};
use serde_json::{Value, json};
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A table as its file has it.
pub(crate) struct Frame {
    /// What the file says of itself.
    pub metadata: FileMetadata,
    columns: Vec<(String, Box<dyn Array>)>,
}

/// A column of a table.
pub(crate) struct Column<'a>(&'a dyn Array);

impl Frame {
    /// Reads a file.
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let metadata = read_metadata(&mut Cursor::new(&bytes)).unwrap();
        let schema = infer_schema(&metadata).unwrap();
        let column = |field: &polars_arrow::datatypes::Field| {
            let mut parts = vec![polars_arrow::array::new_empty_array(field.dtype.clone())];
            for group in &metadata.row_groups {
                let chunk = group.columns_under_root_iter(&field.name).unwrap().next().unwrap();
                let range = chunk.byte_range();
                let bytes = bytes[range.start as usize..range.end as usize].to_vec();
                let pages = PageReader::new(Cursor::new(bytes.into()), chunk, Vec::new(), usize::MAX);
                let pages = vec![BasicDecompressor::new(pages, Vec::new())];
                let types = vec![&chunk.descriptor().descriptor.primitive_type];
                parts.extend(column_iter_to_arrays(pages, types, field.clone(), None).unwrap().0);
            }
            let parts: Vec<&dyn Array> = parts.iter().map(|part| &**part).collect();
            (field.name.to_string(), concatenate(&parts).unwrap())
        };
        let columns = schema.iter_values().map(column).collect();
        Self { metadata, columns }
    }

    /// Whether another table has the same columns, of the same types, with the same cells.
    pub(crate) fn same_cells(&self, other: &Self) -> bool {
        let mut pairs = self.columns.iter().zip(&other.columns);
        self.columns.len() == other.columns.len() && pairs.all(|(a, b)| a.0 == b.0 && a.1 == b.1)
    }

    /// Number of rows.
    pub(crate) fn height(&self) -> usize {
        self.columns[0].1.len()
    }

    /// Names of the columns.
    pub(crate) fn names(&self) -> Vec<String> {
        self.columns.iter().map(|(name, _)| name.clone()).collect()
    }

    /// A column.
    pub(crate) fn column(&self, name: &str) -> Option<Column<'_>> {
        let found = self.columns.iter().find(|(of, _)| of == name);
        found.map(|(_, array)| Column(&**array))
    }
}

impl<'a> Column<'a> {
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn null_count(&self) -> usize {
        self.0.null_count()
    }

    pub(crate) fn f64(&self) -> Option<Cells<f64>> {
        let array: &PrimitiveArray<f64> = self.0.as_any().downcast_ref()?;
        Some(Cells(array.iter().map(|cell| cell.copied()).collect()))
    }

    pub(crate) fn i64(&self) -> Option<Cells<i64>> {
        let array: &PrimitiveArray<i64> = self.0.as_any().downcast_ref()?;
        Some(Cells(array.iter().map(|cell| cell.copied()).collect()))
    }

    pub(crate) fn str(&self) -> Option<Cells<&'a str>> {
        let array: &'a Utf8ViewArray = self.0.as_any().downcast_ref()?;
        Some(Cells(array.iter().collect()))
    }

    /// Its numbers, whole or not; yes and no are one and nought.
    pub(crate) fn numbers(&self) -> Vec<Option<f64>> {
        if let Some(flags) = self.0.as_any().downcast_ref::<BooleanArray>() {
            return flags
                .iter()
                .map(|cell| cell.map(|yes| f64::from(u8::from(yes))))
                .collect();
        }
        let whole = self.i64().map(|Cells(cells)| cells.into_iter());
        let whole = whole.map(|cells| cells.map(|cell| cell.map(|cell| cell as f64)).collect());
        whole.unwrap_or_else(|| self.f64().unwrap().0)
    }
}

/// The cells of a column.
#[derive(Clone)]
pub(crate) struct Cells<T>(Vec<Option<T>>);

impl<T: Copy> Cells<T> {
    pub(crate) fn get(&self, row: usize) -> Option<T> {
        self.0[row]
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = Option<T>> + '_ {
        self.0.iter().copied()
    }
}

/// The folder; gone with the value.
pub(crate) struct Stage {
    dir: tempfile::TempDir,
    /// The study's document, to be changed before a run.
    pub study: Value,
    /// The bridge's document, to be changed before a run.
    pub bridge: Value,
}

fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

fn document(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

impl Stage {
    /// The smoke study with its bridge beside it.
    pub(crate) fn new() -> Self {
        let mut study = document(&studies().join("smoke/study.json"));
        study["bridge"] = "bridge.json".into();
        let bridge = document(&studies().join("bridges/smoke.json"));
        Self {
            dir: tempfile::tempdir().unwrap(),
            study,
            bridge,
        }
    }

    /// A file in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    /// Writes both documents.
    pub(crate) fn write(&self) -> &Self {
        fs::write(self.path("study.json"), format!("{:#}", self.study)).unwrap();
        fs::write(self.path("bridge.json"), format!("{:#}", self.bridge)).unwrap();
        self
    }

    /// Writes a document beside them.
    pub(crate) fn json(&self, name: &str, document: &Value) {
        fs::write(self.path(name), format!("{document:#}")).unwrap();
    }

    /// Writes the documents and runs the study into a folder, to its good end.
    pub(crate) fn ran(&self, out: &str) {
        let output = self.write().pontoon(&["run", "study.json", "--out", out, "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }

    /// Holds results against `reference.json` made of some checks; exit status and the lines of the comparison.
    pub(crate) fn held(&self, results: &str, checks: &Value) -> (Option<i32>, Vec<Value>) {
        self.json("reference.json", &reference(checks));
        self.compared(results, "reference.json")
    }

    /// Holds results against what has a name; exit status and the lines of the comparison.
    pub(crate) fn compared(&self, results: &str, with: &str) -> (Option<i32>, Vec<Value>) {
        let output = self.pontoon(&["compare", results, "--with", with, "--format", "json"]);
        let text = stdout(&output);
        let object: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}{}", stderr(&output)));
        assert_eq!(object["good"], json!(output.status.code() == Some(0)));
        (output.status.code(), object["lines"].as_array().unwrap().clone())
    }

    /// Runs the program in the folder.
    pub(crate) fn pontoon(&self, words: &[&str]) -> Output {
        // no cache but where a test says so
        self.pontoon_with(words, Path::new(""))
    }

    /// Runs the program in the folder with a cache in another.
    pub(crate) fn pontoon_with(&self, words: &[&str], cache: &Path) -> Output {
        let output = Command::new(env!("CARGO_BIN_EXE_pontoon"))
            .args(words)
            .env("PONTOON_CACHE_DIR", cache)
            .current_dir(self.dir.path())
            .output()
            .unwrap();
        refusals::listed(&output, self.dir.path());
        output
    }

    /// A table in a folder of results.
    pub(crate) fn table(&self, path: &str) -> Frame {
        Frame::read(&self.path(path))
    }

    /// A column of numbers of a table.
    pub(crate) fn numbers(&self, path: &str, column: &str) -> Vec<Option<f64>> {
        self.table(path).column(column).unwrap().numbers()
    }

    /// The names of everything in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.dir.path()).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The manifest of the results in a folder.
    pub(crate) fn manifest(&self, out: &str) -> Value {
        document(&self.path(out).join("manifest.json"))
    }
}

/// What a program wrote on standard output.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What a program wrote on standard error.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A reference of some checks.
pub(crate) fn reference(checks: &Value) -> Value {
    json!({ "name": "expected", "source": "the tables themselves", "checks": checks })
}

/// The one message of a refusal: the first line of what was told. What follows it, if anything does, is one place of a file.
pub(crate) fn one_message(told: &str) -> &str {
    let (message, place) = told.split_once('\n').unwrap();
    let begins = place.trim_start().starts_with("--> ");
    assert!(
        place.is_empty() || begins && place.matches("--> ").count() == 1,
        "{told}"
    );
    assert!(message.starts_with("pontoon: "), "{told}");
    message
}

/// Whether a message says what is missing, or what was found and what is allowed.
pub(crate) fn says_what_is_wrong(message: &str) -> bool {
    message.contains(": missing key `") || message.contains("found ") && message.contains("allowed: ")
}

/// An end with status 2 and one message that holds all parts; nothing on standard output.
pub(crate) fn is_refused(output: &Output, parts: &[&str]) {
    let told = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{parts:?}: {told}{}", stdout(output));
    let message = one_message(&told);
    assert!(says_what_is_wrong(message), "{message}");
    for part in parts {
        assert!(message.contains(part), "no '{part}' in: {message}");
    }
    assert_eq!(stdout(output), "", "{message}");
}
