//! Which axes vary: the one place that finds it.
//!
//! Knows cells as they come, a million of them at no more than one kept. Does not know what is made of it.

use pontoon_plan::input::Cell;

/// What was seen of an axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Seen {
    first: Option<Cell<'static>>,
    several: bool,
    empty: usize,
    cells: usize,
}

impl Seen {
    /// What is seen of some cells.
    pub fn of<'a>(cells: impl IntoIterator<Item = Cell<'a>>) -> Self {
        let mut seen = Self::default();
        cells.into_iter().for_each(|cell| seen.take(&cell));
        seen
    }

    /// Takes the next cell.
    pub fn take(&mut self, cell: &Cell<'_>) {
        self.cells += 1;
        match &self.first {
            _ if cell.is_nothing() => self.empty += 1,
            None => self.first = Some(cell.owned()),
            Some(first) => self.several |= first != cell,
        }
    }

    /// Whether there are several values; nothing, where the axis has no meaning, is none.
    pub fn has_several(&self) -> bool {
        self.several
    }

    /// Whether there are several values, or some cells hold nothing and others do not.
    pub fn varies(&self) -> bool {
        self.several || (self.first.is_some() && self.empty > 0)
    }

    /// The one value, where there are not several.
    pub fn only(&self) -> Option<&Cell<'static>> {
        self.first.as_ref().filter(|_| !self.several)
    }

    /// Whether every cell holds something, and there is one.
    pub fn is_whole(&self) -> bool {
        self.empty == 0 && self.cells > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_no_second_value_but_a_difference() {
        let seen = |cells: &[Cell<'static>]| Seen::of(cells.iter().cloned());
        let (three, four, nothing) = (Cell::Whole(3), Cell::Number(4.0), Cell::Nothing);
        let one = seen(&[three.clone(), Cell::Number(3.0)]);
        assert!(!one.varies() && one.is_whole() && one.only() == Some(&three));
        let some = seen(&[nothing.clone(), three.clone()]);
        assert!(some.varies() && !some.has_several() && !some.is_whole() && some.only() == Some(&three));
        let several = seen(&[three, four]);
        assert!(several.varies() && several.has_several() && several.only().is_none());
        let none = seen(&[nothing]);
        assert!(!none.varies() && none.only().is_none() && !seen(&[]).is_whole());
    }
}
