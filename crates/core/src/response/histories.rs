//! Histories as they are written: a number for each of their subjects after every step.
//!
//! Knows subjects and steps. Does not know what reads the numbers.

use super::subject::Subject;

/// One recorded history.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// What was recorded.
    pub subject: Subject,
    /// A value for each entry of the response's `history_time_s`; of pins and section forces each of `balance_time_s`.
    pub values: Vec<f64>,
}

/// Most steps that there is room for from the beginning.
const MOST_EXPECTED: usize = 1 << 16;

/// Histories under way, one after the other, each with room for as many steps.
#[derive(Debug, Clone, Default)]
pub(super) struct Histories {
    pub(super) subjects: Vec<Subject>,
    numbers: Vec<f64>,
    /// Steps that there is room for, and that were written.
    room: usize,
    steps: usize,
}

impl Histories {
    /// Histories of subjects.
    pub(super) fn new(subjects: Vec<Subject>) -> Self {
        Self {
            subjects,
            ..Self::default()
        }
    }

    /// Has room for so many steps, or the first of very many.
    pub(super) fn expect(&mut self, steps: usize) {
        self.ensure_steps(steps.min(MOST_EXPECTED));
    }

    /// Has room for so many steps.
    fn ensure_steps(&mut self, steps: usize) {
        if steps <= self.room {
            return;
        }
        let mut numbers = vec![0.0; self.subjects.len() * steps];
        if self.room > 0 {
            let old = self.numbers.chunks_exact(self.room);
            for (to, from) in numbers.chunks_exact_mut(steps).zip(old) {
                to[..self.room].copy_from_slice(from);
            }
        }
        (self.numbers, self.room) = (numbers, steps);
    }

    /// Writes the number of each subject after a step.
    #[inline(always)]
    pub(super) fn write(&mut self, read: impl Fn(Subject) -> f64) {
        if self.steps == self.room {
            self.ensure_steps(2 * self.room + 16);
        }
        for (numbers, subject) in self.numbers.chunks_exact_mut(self.room).zip(&self.subjects) {
            numbers[self.steps] = read(*subject);
        }
        self.steps += 1;
    }

    /// Ends them.
    pub(super) fn finish(self) -> Vec<History> {
        let history = |(i, subject): (usize, &Subject)| History {
            subject: *subject,
            values: self.numbers[i * self.room..][..self.steps].to_vec(),
        };
        self.subjects.iter().enumerate().map(history).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Histories;
    use crate::response::Subject;

    /// As many numbers as steps, in their order, whether there was room for them or not.
    #[test]
    fn every_step_is_in_every_history() {
        for room in [0, 3, 40] {
            let mut of = Histories::new(vec![Subject::Position(1), Subject::Joint(2)]);
            of.expect(room);
            for step in 0..40 {
                let at = f64::from(step);
                of.write(|subject| if subject == Subject::Joint(2) { -at } else { at });
            }
            let done = of.finish();
            let numbers: Vec<f64> = (0..40).map(f64::from).collect();
            assert_eq!(done[0].values, numbers, "room {room}");
            assert_eq!(done[1].values, numbers.iter().map(|x| -x).collect::<Vec<_>>());
            assert_eq!(done[1].subject, Subject::Joint(2));
        }
        assert!(Histories::new(Vec::new()).finish().is_empty());
        let unwritten = Histories::new(vec![Subject::Position(1)]).finish();
        assert!(unwritten.len() == 1 && unwritten[0].values.is_empty());
    }
}
