//! Rows of a table as arrays of the table library, to Parquet files and back.
//!
//! Knows arrays and the format. Does not know what a column means, or of which type it may be.

use polars_arrow::array::{Array, new_empty_array};
use polars_arrow::datatypes::{ArrowSchema, Field};
use polars_arrow::record_batch::RecordBatch;
use polars_parquet::read::{
    BasicDecompressor, Filter, PageReader, RowGroupMetadata, column_iter_to_arrays, infer_schema, read_metadata,
};
use polars_parquet::write::{
    CompressionOptions, FileWriter, KeyValue, StatisticsOptions, Version, WriteOptions, get_dtype_encoding,
    row_group_iter, schema_to_metadata_key,
};
use rayon::prelude::*;
use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::sync::Arc;

/// The library's own choices of what it is given none for.
const OPTIONS: fn() -> WriteOptions = || WriteOptions {
    statistics: StatisticsOptions::default(),
    compression: CompressionOptions::Zstd(None),
    version: Version::V1,
    data_page_size: None,
};

/// Rows of a table: columns of equal length, each with its name.
#[derive(Debug, Clone, Default)]
pub(super) struct ArrowFrame(Vec<(String, Box<dyn Array>)>);

impl ArrowFrame {
    /// A frame of columns.
    ///
    /// # Errors
    /// Where they are not of equal length.
    pub(super) fn new(columns: Vec<(String, Box<dyn Array>)>) -> io::Result<Self> {
        let frame = Self(columns);
        if frame.0.iter().any(|(_, array)| array.len() != frame.rows()) {
            return Err(io::Error::other("columns of different lengths"));
        }
        Ok(frame)
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.0.first().map_or(0, |(_, array)| array.len())
    }

    /// The columns in their order.
    pub(super) fn columns(&self) -> impl Iterator<Item = (&str, &dyn Array)> {
        self.0.iter().map(|(name, array)| (name.as_str(), &**array))
    }

    /// The columns without rows.
    pub(super) fn without_rows(&self) -> Self {
        let none = |(name, array): &(String, Box<dyn Array>)| (name.clone(), new_empty_array(array.dtype().clone()));
        Self(self.0.iter().map(none).collect())
    }

    /// Names and types of the columns.
    #[cfg(test)]
    pub(super) fn types(&self) -> Vec<(&str, &polars_arrow::datatypes::ArrowDataType)> {
        self.columns().map(|(name, array)| (name, array.dtype())).collect()
    }

    fn schema(&self) -> ArrowSchema {
        let field = |(name, array): (&str, &dyn Array)| {
            let field = Field::new(name.into(), array.dtype().clone(), true);
            (field.name.clone(), field)
        };
        self.columns().map(field).collect()
    }

    fn part(&self, rows: &Range<usize>) -> Vec<Box<dyn Array>> {
        let part = |(_, array): (_, &dyn Array)| array.sliced(rows.start, rows.len());
        self.columns().map(part).collect()
    }
}

/// A file under way.
pub(super) struct FrameWriter<W: Write>(FileWriter<W>);

impl<W: Write> FrameWriter<W> {
    /// Begins a file of the columns of `empty`.
    pub(super) fn begin(to: W, empty: &ArrowFrame) -> io::Result<Self> {
        let writer = FileWriter::try_new(to, empty.schema(), OPTIONS());
        writer.map(Self).map_err(io::Error::other)
    }

    /// Writes some rows as a row group.
    pub(super) fn append(&mut self, frame: &ArrowFrame, rows: &Range<usize>) -> io::Result<()> {
        let schema = self.0.schema();
        let encodings = schema.iter_values().map(|field| get_dtype_encoding(&field.dtype));
        let (encodings, schema) = (encodings.collect(), Arc::new(schema.clone()));
        let batch = RecordBatch::try_new(rows.len(), schema, frame.part(rows)).map_err(io::Error::other)?;
        let fields = self.0.parquet_schema().fields().to_vec();
        let group = row_group_iter(batch, encodings, fields, OPTIONS());
        self.0.write(rows.len() as u64, group).map_err(io::Error::other)
    }

    /// Ends the file with what it says of itself.
    pub(super) fn end(mut self, metadata: &[(String, String)]) -> io::Result<()> {
        let pair = |(key, value): &(String, String)| KeyValue {
            key: key.clone(),
            value: Some(value.clone()),
        };
        let schema = schema_to_metadata_key(self.0.schema());
        let metadata = std::iter::once(schema).chain(metadata.iter().map(pair)).collect();
        self.0.end(Some(metadata)).map(|_| ()).map_err(io::Error::other)
    }
}

/// Reads rows of a file, as a frame for each row group that has any of them, or one without rows: of `columns` those that
/// the file has, or all.
pub(super) fn read(file: &mut File, columns: Option<&[&str]>, rows: &Range<usize>) -> io::Result<Vec<ArrowFrame>> {
    let metadata = read_metadata(file).map_err(io::Error::other)?;
    let schema = infer_schema(&metadata).map_err(io::Error::other)?;
    let fields: Vec<&Field> = match columns {
        Some(names) => names.iter().filter_map(|name| schema.get(name)).collect(),
        None => schema.iter_values().collect(),
    };
    let (mut frames, mut from) = (Vec::new(), 0);
    for group in &metadata.row_groups {
        let range = rows.start.max(from) - from..rows.end.clamp(from, from + group.num_rows()) - from;
        from += group.num_rows();
        if !range.is_empty() {
            frames.push(read_group(file, group, &fields, &range)?);
        }
    }
    if frames.is_empty() {
        let empty = |field: &&Field| (field.name.to_string(), new_empty_array(field.dtype.clone()));
        frames.push(ArrowFrame(fields.iter().map(empty).collect()));
    }
    Ok(frames)
}

/// Bytes that a file's rows take in memory: as arrays of the table library and as columns of this program.
pub(super) fn bytes_in_memory(file: &mut File) -> io::Result<u64> {
    let metadata = read_metadata(file).map_err(io::Error::other)?;
    let rows: usize = metadata.row_groups.iter().map(RowGroupMetadata::num_rows).sum();
    let columns = metadata.schema_descr.columns().len();
    Ok(2 * CELL_BYTES * (rows as u64) * columns as u64)
}

/// Bytes of a cell, numbers and words together: measured on tables of jobs, with what a report makes of them.
const CELL_BYTES: u64 = 20;

fn read_group(
    file: &mut File,
    group: &RowGroupMetadata,
    fields: &[&Field],
    rows: &Range<usize>,
) -> io::Result<ArrowFrame> {
    let mut chunks = Vec::new();
    for field in fields {
        let mut of = group.columns_under_root_iter(&field.name).into_iter().flatten();
        let chunk = of
            .next()
            .ok_or_else(|| io::Error::other(format!("no column {}", field.name)))?;
        let range = chunk.byte_range();
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(range.start))?;
        file.take(range.end - range.start).read_to_end(&mut bytes)?;
        chunks.push((field, chunk, bytes));
    }
    let columns = chunks.into_par_iter().map(|(field, chunk, bytes)| {
        let pages = PageReader::new(Cursor::new(bytes.into()), chunk, Vec::new(), usize::MAX);
        let pages = vec![BasicDecompressor::new(pages, Vec::new())];
        let types = vec![&chunk.descriptor().descriptor.primitive_type];
        let filter = Some(Filter::new_ranged(rows.start, rows.end));
        let (arrays, _) = column_iter_to_arrays(pages, types, (*field).clone(), filter).map_err(io::Error::other)?;
        match <[Box<dyn Array>; 1]>::try_from(arrays) {
            Ok([array]) => Ok((field.name.to_string(), array)),
            Err(_) => Err(io::Error::other(format!("column {} in pieces", field.name))),
        }
    });
    ArrowFrame::new(columns.collect::<io::Result<_>>()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use polars_arrow::array::{BooleanArray, PrimitiveArray, Utf8ViewArray};

    const ROWS: usize = 15;

    /// Fifteen rows of each type that tables have, some cells missing.
    fn whole() -> ArrowFrame {
        let there = |row: usize| row % 4 != 1;
        let numbers = (0..ROWS).map(|row| there(row).then_some(0.1 * row as f64));
        let counts = (0..ROWS).map(|row| there(row + 1).then_some(row as i64));
        let words: Vec<String> = (0..ROWS).map(|row| format!("word {}", row % 3)).collect();
        let words = words
            .iter()
            .enumerate()
            .map(|(row, word)| there(row + 2).then_some(word.as_str()));
        let flags = (0..ROWS).map(|row| there(row + 3).then_some(row % 2 == 0));
        ArrowFrame::new(vec![
            (
                "number".to_owned(),
                PrimitiveArray::<f64>::from(numbers.collect::<Vec<_>>()).boxed(),
            ),
            (
                "count".to_owned(),
                PrimitiveArray::<i64>::from(counts.collect::<Vec<_>>()).boxed(),
            ),
            (
                "word".to_owned(),
                Utf8ViewArray::from_slice(words.collect::<Vec<_>>()).boxed(),
            ),
            ("flag".to_owned(), BooleanArray::from(flags.collect::<Vec<_>>()).boxed()),
        ])
        .unwrap()
    }

    /// The frame in three row groups of five.
    fn written() -> File {
        let (mut file, frame) = (tempfile::tempfile().unwrap(), whole());
        let mut writer = FrameWriter::begin(&mut file, &frame).unwrap();
        for start in [0, 5, 10] {
            writer.append(&frame, &(start..start + 5)).unwrap();
        }
        writer.end(&[("key".to_owned(), "value".to_owned())]).unwrap();
        file
    }

    #[test]
    fn any_rows_of_any_columns_are_read_across_row_groups() {
        let (mut file, whole) = (written(), whole());
        for (start, end) in (0..=ROWS).flat_map(|start| (start..=ROWS + 2).map(move |end| (start, end))) {
            for columns in [None, Some(&["flag", "missing", "number"][..])] {
                let frames = read(&mut file, columns, &(start..end)).unwrap();
                let expected = whole.part(&(start..end.min(ROWS)));
                let names: Vec<&str> =
                    columns.map_or(vec!["number", "count", "word", "flag"], |_| vec!["flag", "number"]);
                let mut from = 0;
                for frame in &frames {
                    assert_eq!(frame.columns().map(|(name, _)| name).collect::<Vec<_>>(), names);
                    for (name, found) in frame.columns() {
                        let at = whole.columns().position(|(known, _)| known == name).unwrap();
                        assert_eq!(
                            found,
                            &*expected[at].sliced(from, frame.rows()),
                            "{name} in {start}..{end}"
                        );
                    }
                    from += frame.rows();
                }
                assert_eq!(from, end.min(ROWS) - start, "{start}..{end}");
            }
        }
    }

    #[test]
    fn columns_of_different_lengths_are_no_frame() {
        let column = |length: usize| PrimitiveArray::<f64>::from(vec![Some(0.0); length]).boxed();
        assert!(ArrowFrame::new(vec![("a".to_owned(), column(1)), ("b".to_owned(), column(2))]).is_err());
    }

    /// The system's own answer, through the library's words.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_as_the_system_tells_it() {
        use pontoon_journal::fault::Watched;
        let failure = Arc::default();
        let full = Watched {
            place: "tables.write",
            file: File::options().write(true).open("/dev/full").unwrap(),
            failure: Arc::clone(&failure),
        };
        let frame = whole();
        let mut writer = FrameWriter::begin(full, &frame).unwrap();
        assert!(writer.append(&frame, &(0..ROWS)).is_err());
        let (kind, text) = failure.get().unwrap();
        assert_eq!(*kind, io::ErrorKind::StorageFull);
        assert!(text.starts_with("No space left on device"), "{text}");
    }
}
