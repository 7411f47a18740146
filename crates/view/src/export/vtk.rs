//! Grids as VTK XML: what ParaView, pyvista and meshio read.
//!
//! Knows the words of the format: an unstructured grid (`.vtu`) with its arrays appended as raw little-endian bytes behind
//! 64-bit counts, and a collection of grids over time (`.pvd`). Does not know bridges, nor where a file goes.
//!
//! Text in a grid's fields is its UTF-8 bytes as UInt8: an array of type String would be natural, but not every reader has
//! it.

use quick_xml::Writer;
use quick_xml::events::BytesText;
use std::io::{self, Write};

/// A line of two points, a vertex of one, a quadrilateral of four: the format's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum CellType {
    /// One point.
    Vertex = 1,
    /// Two points.
    Line = 3,
    /// Four points in cyclic order.
    Quad = 9,
}

/// Numbers of an array.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum VtkValues {
    F32(Vec<f32>),
    F64(Vec<f64>),
    I32(Vec<i32>),
    U8(Vec<u8>),
}

impl VtkValues {
    fn word(&self) -> &'static str {
        match self {
            Self::F32(_) => "Float32",
            Self::F64(_) => "Float64",
            Self::I32(_) => "Int32",
            Self::U8(_) => "UInt8",
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::F32(list) => list.len(),
            Self::F64(list) => list.len(),
            Self::I32(list) => list.len(),
            Self::U8(list) => list.len(),
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::F32(list) => list.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::F64(list) => list.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::I32(list) => list.iter().flat_map(|x| x.to_le_bytes()).collect(),
            Self::U8(list) => list.clone(),
        }
    }

    fn size(&self) -> usize {
        self.len()
            * match self {
                Self::F64(_) => 8,
                Self::F32(_) | Self::I32(_) => 4,
                Self::U8(_) => 1,
            }
    }
}

/// A named array.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Array {
    name: &'static str,
    components: usize,
    values: VtkValues,
}

impl Array {
    /// One number a point, cell or field.
    pub(super) fn new(name: &'static str, values: VtkValues) -> Self {
        Self {
            name,
            components: 1,
            values,
        }
    }

    /// Vectors in single precision.
    pub(super) fn vectors(name: &'static str, vectors: &[[f64; 3]]) -> Self {
        Self {
            name,
            components: 3,
            values: VtkValues::F32(vectors.iter().flatten().map(|&x| x as f32).collect()),
        }
    }

    /// Its name.
    #[cfg(test)]
    pub(super) fn name(&self) -> &'static str {
        self.name
    }

    /// Number of its tuples.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.values.len() / self.components
    }

    /// A text as its UTF-8 bytes.
    pub(super) fn text(name: &'static str, text: &str) -> Self {
        Self::new(name, VtkValues::U8(text.as_bytes().to_vec()))
    }
}

/// An unstructured grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VtkGrid {
    points: Array,
    count: usize,
    connectivity: Vec<i32>,
    offsets: Vec<i32>,
    types: Vec<u8>,
    /// Arrays with an entry for each point.
    pub point_data: Vec<Array>,
    /// Arrays with an entry for each cell.
    pub cell_data: Vec<Array>,
    /// Arrays of the grid as a whole.
    pub field_data: Vec<Array>,
}

impl VtkGrid {
    /// Points `[m]` without cells.
    pub(super) fn new(points_m: &[[f64; 3]]) -> Self {
        Self {
            points: Array::vectors("points", points_m),
            count: points_m.len(),
            connectivity: Vec::new(),
            offsets: Vec::new(),
            types: Vec::new(),
            point_data: Vec::new(),
            cell_data: Vec::new(),
            field_data: Vec::new(),
        }
    }

    /// Adds a cell of some points.
    pub(super) fn cell(&mut self, kind: CellType, points: &[usize]) {
        self.connectivity.extend(points.iter().map(|&point| point as i32));
        self.offsets.push(self.connectivity.len() as i32);
        self.types.push(kind as u8);
    }

    /// Number of points.
    pub(super) fn points(&self) -> usize {
        self.count
    }

    /// Number of cells.
    pub(super) fn cells(&self) -> usize {
        self.types.len()
    }

    /// Writes the grid.
    ///
    /// # Errors
    /// The writer's.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let cells = [
            Array::new("connectivity", VtkValues::I32(self.connectivity.clone())),
            Array::new("offsets", VtkValues::I32(self.offsets.clone())),
            Array::new("types", VtkValues::U8(self.types.clone())),
        ];
        let points = std::slice::from_ref(&self.points);
        let (of_points, of_cells) = (self.count.to_string(), self.cells().to_string());
        let mut appended = Appended::default();
        let mut xml = Writer::new_with_indent(out, b' ', 2);
        let header = [
            ("type", "UnstructuredGrid"),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
            ("header_type", "UInt64"),
        ];
        let file = xml.create_element("VTKFile").with_attributes(header);
        file.write_inner_content(|xml| {
            let grid = xml.create_element("UnstructuredGrid");
            grid.write_inner_content(|xml| {
                appended.arrays(xml, "FieldData", &self.field_data)?;
                let counts = [
                    ("NumberOfPoints", of_points.as_str()),
                    ("NumberOfCells", of_cells.as_str()),
                ];
                let piece = xml.create_element("Piece").with_attributes(counts);
                piece.write_inner_content(|xml| {
                    appended.arrays(xml, "PointData", &self.point_data)?;
                    appended.arrays(xml, "CellData", &self.cell_data)?;
                    appended.arrays(xml, "Points", points)?;
                    appended.arrays(xml, "Cells", &cells)
                })?;
                Ok(())
            })?;
            let raw = xml.create_element("AppendedData").with_attribute(("encoding", "raw"));
            raw.write_inner_content(|xml| appended.write(xml.get_mut()))?;
            Ok(())
        })?;
        Ok(())
    }
}

/// What is appended to a file, and how far it reaches.
#[derive(Default)]
struct Appended<'a> {
    offset: usize,
    values: Vec<&'a VtkValues>,
}

impl<'a> Appended<'a> {
    /// The heads of some arrays under one element, which is left out where there are none.
    fn arrays(
        &mut self,
        xml: &mut Writer<&mut dyn Write>,
        element: &'static str,
        arrays: &'a [Array],
    ) -> io::Result<()> {
        if arrays.is_empty() {
            return Ok(());
        }
        xml.create_element(element).write_inner_content(|xml| {
            for array in arrays {
                let (components, offset) = (array.components.to_string(), self.offset.to_string());
                let tuples = array.values.len().to_string();
                let names = [("type", array.values.word()), ("Name", array.name)];
                let mut head = xml.create_element("DataArray").with_attributes(names);
                if array.components > 1 {
                    head = head.with_attribute(("NumberOfComponents", components.as_str()));
                }
                if element == "FieldData" {
                    head = head.with_attribute(("NumberOfTuples", tuples.as_str()));
                }
                head.with_attributes([("format", "appended"), ("offset", offset.as_str())])
                    .write_empty()?;
                self.offset += size_of::<u64>() + array.values.size();
                self.values.push(&array.values);
            }
            Ok(())
        })?;
        Ok(())
    }

    /// The bytes behind their sign.
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(b"_")?;
        for values in &self.values {
            let bytes = values.bytes();
            out.write_all(&(bytes.len() as u64).to_le_bytes())?;
            out.write_all(&bytes)?;
        }
        Ok(())
    }
}

/// One file of a collection.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VtkStep {
    /// Its time, or its number where there is none.
    pub time: f64,
    /// What it shows.
    pub name: String,
    /// The file.
    pub file: String,
}

/// Writes a collection.
///
/// # Errors
/// The writer's.
pub(super) fn write_collection(steps: &[VtkStep], remark: &str, out: &mut dyn Write) -> io::Result<()> {
    let mut xml = Writer::new_with_indent(out, b' ', 2);
    let header = [
        ("type", "Collection"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
    ];
    xml.write_event(quick_xml::events::Event::Comment(BytesText::new(remark)))?;
    xml.create_element("VTKFile")
        .with_attributes(header)
        .write_inner_content(|xml| {
            xml.create_element("Collection").write_inner_content(|xml| {
                for step in steps {
                    let time = step.time.to_string();
                    xml.create_element("DataSet")
                        .with_attributes([
                            ("timestep", time.as_str()),
                            ("part", "0"),
                            ("name", step.name.as_str()),
                            ("file", step.file.as_str()),
                        ])
                        .write_empty()?;
                }
                Ok(())
            })?;
            Ok(())
        })?;
    Ok(())
}

/// Counts bytes and keeps none.
#[derive(Debug, Default)]
pub(super) struct Counter(pub u64);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(grid: &VtkGrid) -> Vec<u8> {
        let mut bytes = Vec::new();
        grid.write(&mut bytes).unwrap();
        bytes
    }

    /// Every array stands where its offset says, behind its count of bytes.
    #[test]
    fn offsets_lead_to_the_bytes() {
        let mut grid = VtkGrid::new(&[[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]);
        grid.cell(CellType::Line, &[0, 1]);
        grid.cell_data.push(Array::new("force_n", VtkValues::F64(vec![-1.5])));
        grid.field_data.push(Array::text("shape", "heave"));
        let bytes = written(&grid);
        let mark = b"<AppendedData encoding=\"raw\">";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        let head = String::from_utf8(bytes[..at].to_vec()).unwrap();
        let start = at + bytes[at..].iter().position(|b| *b == b'_').unwrap() + 1;
        let offset = |name: &str| -> usize {
            let line = head.lines().find(|l| l.contains(&format!("Name=\"{name}\""))).unwrap();
            line.split("offset=\"")
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap()
                .parse()
                .unwrap()
        };
        let of = |name: &str| {
            let from = start + offset(name);
            let count = u64::from_le_bytes(bytes[from..from + 8].try_into().unwrap()) as usize;
            bytes[from + 8..from + 8 + count].to_vec()
        };
        assert_eq!(of("shape"), b"heave");
        assert_eq!(of("force_n"), (-1.5_f64).to_le_bytes());
        assert_eq!(of("types"), [3]);
        assert_eq!(of("connectivity"), [0, 0, 0, 0, 1, 0, 0, 0]);
        assert_eq!(of("points").len(), 24);
        let mut counter = Counter::default();
        grid.write(&mut counter).unwrap();
        assert_eq!(counter.0, bytes.len() as u64);
    }

    #[test]
    fn words_of_a_collection_cannot_be_markup() {
        let step = VtkStep {
            time: 0.25,
            name: "a<b & \"c\"".to_owned(),
            file: "x-0001.vtu".to_owned(),
        };
        let mut bytes = Vec::new();
        write_collection(&[step], "r", &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains("name=\"a&lt;b &amp; &quot;c&quot;\""), "{text}");
        assert!(text.contains("timestep=\"0.25\""), "{text}");
    }
}
