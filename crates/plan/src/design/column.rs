//! Values one after the other: of an axis that is listed, or of an axis of cases.
//!
//! Knows that most are numbers, which take eight bytes each. Does not know what they mean.

use crate::input::Cell;

/// Whole numbers below this are numbers without loss.
const LARGEST_WHOLE: u64 = 9_000_000_000_000_000;

/// Values one after the other.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ValueColumn {
    /// Numbers alone; whole ones are written whole.
    Numbers(Vec<f64>),
    /// Whatever they are.
    Cells(Vec<Cell<'static>>),
}

impl Default for ValueColumn {
    fn default() -> Self {
        Self::Numbers(Vec::new())
    }
}

impl ValueColumn {
    /// Number of values.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Cells(cells) => cells.len(),
        }
    }

    /// Appends a value.
    pub(super) fn push(&mut self, cell: Cell<'static>) {
        let cell = cell.canonical();
        let number = match cell {
            Cell::Number(x) => Some(x),
            // a larger one is not the same as a number
            Cell::Whole(whole) if whole.unsigned_abs() < LARGEST_WHOLE => Some(whole as f64),
            _ => None,
        };
        match (&mut *self, number) {
            (Self::Numbers(numbers), Some(x)) => numbers.push(x),
            (Self::Numbers(numbers), None) => {
                let mut cells: Vec<Cell<'static>> = numbers.iter().map(|x| Cell::written(*x)).collect();
                cells.push(cell);
                *self = Self::Cells(cells);
            }
            (Self::Cells(cells), _) => cells.push(cell),
        }
    }

    /// The value at a place below the number of values.
    pub(super) fn at(&self, place: usize) -> Cell<'_> {
        match self {
            Self::Numbers(numbers) => Cell::written(numbers[place]),
            Self::Cells(cells) => cells[place].borrowed(),
        }
    }
}

impl FromIterator<Cell<'static>> for ValueColumn {
    fn from_iter<I: IntoIterator<Item = Cell<'static>>>(cells: I) -> Self {
        let mut column = Self::default();
        cells.into_iter().for_each(|cell| column.push(cell));
        column
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_given_back_as_they_were_put_in() {
        let numbers = [Cell::Whole(3), Cell::Number(0.5), Cell::Whole(-2)];
        let mixed = [
            Cell::Whole(3),
            Cell::Nothing,
            Cell::Number(0.5),
            Cell::Word("a".into()),
            Cell::Whole(i64::MAX),
        ];
        for cells in [&numbers[..], &mixed[..]] {
            let column: ValueColumn = cells.iter().cloned().collect();
            assert_eq!(column.len(), cells.len());
            for (place, cell) in cells.iter().enumerate() {
                assert_eq!(column.at(place).to_string(), cell.to_string());
            }
        }
        assert!(matches!(numbers.into_iter().collect(), ValueColumn::Numbers(_)));
    }
}
