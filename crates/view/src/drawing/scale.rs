//! An axis as it is drawn: which numbers stand at it, and where a value lies.
//!
//! Knows numbers. Does not know what they count.

/// Steps between ticks, within a power of ten.
const STEPS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// A share of a step within which a number is one with a tick.
const ON_TICK: f64 = 1e-9;

/// An axis from one value to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    /// Its least value.
    pub from: f64,
    /// Its largest value.
    pub to: f64,
    /// From tick to tick.
    pub step: f64,
}

impl Scale {
    /// An axis that reaches over some values with about so many steps, and ends at ticks or half-way between them.
    pub(super) fn round(values: impl Iterator<Item = f64>, steps: f64) -> Self {
        let exact = Self::exact(values, steps);
        let half = 0.5 * exact.step;
        Self {
            from: (exact.from / half + ON_TICK).floor() * half,
            to: (exact.to / half - ON_TICK).ceil() * half,
            step: exact.step,
        }
    }

    /// An axis that ends at the least and the largest of some values; about so many steps.
    pub(super) fn exact(values: impl Iterator<Item = f64>, steps: f64) -> Self {
        let (mut from, mut to) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        if from > to {
            (from, to) = (0.0, 1.0);
        }
        if to - from <= ON_TICK * from.abs().max(to.abs()) {
            let half = if from == 0.0 { 0.5 } else { 0.5 * from.abs() };
            (from, to) = (from - half, to + half);
        }
        let rough = (to - from) / steps;
        let power = 10f64.powf(rough.log10().floor());
        let step = STEPS
            .iter()
            .map(|s| s * power)
            .find(|step| *step >= rough * (1.0 - ON_TICK));
        Self {
            from,
            to,
            step: step.unwrap_or(10.0 * power),
        }
    }

    /// The axis with a share of its length before and behind.
    pub(super) fn padded(self, share: f64) -> Self {
        let more = share * (self.to - self.from);
        Self {
            from: self.from - more,
            to: self.to + more,
            ..self
        }
    }

    /// Its ticks.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let first = (self.from / self.step - ON_TICK).ceil();
        let last = (self.to / self.step + ON_TICK).floor();
        let count = (last - first).clamp(-1.0, 100.0) as i64;
        (0..=count).map(|i| (first + i as f64) * self.step).collect()
    }

    /// A tick in digits, with the minus sign that print has.
    pub(super) fn text(&self, tick: f64) -> String {
        let decimals = usize::try_from(-(self.step.log10() + ON_TICK).floor() as i64)
            .unwrap_or(0)
            .min(12);
        let text = format!(
            "{:.decimals$}",
            if tick.abs() < ON_TICK * self.step { 0.0 } else { tick }
        );
        text.replace('-', "\u{2212}")
    }

    /// Which share of the axis lies before a value.
    pub(super) fn share(&self, value: f64) -> f64 {
        (value - self.from) / (self.to - self.from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(scale: Scale) -> Vec<String> {
        scale.ticks().iter().map(|tick| scale.text(*tick)).collect()
    }

    #[test]
    fn rounded_axes_end_at_ticks_that_read_well() {
        let scale = Scale::round([-3.7, 21.9].into_iter(), 6.0);
        assert_eq!((scale.from, scale.to, scale.step), (-5.0, 22.5, 5.0));
        assert_eq!(texts(scale), ["\u{2212}5", "0", "5", "10", "15", "20"]);
        assert_eq!(
            texts(Scale::round([0.0, 0.3].into_iter(), 3.0)),
            ["0.0", "0.1", "0.2", "0.3"]
        );
    }

    #[test]
    fn exact_axes_end_where_the_values_do() {
        let scale = Scale::exact([0.0, 100.5].into_iter(), 5.0);
        assert_eq!((scale.from, scale.to), (0.0, 100.5));
        assert_eq!(texts(scale), ["0", "50", "100"]);
    }

    #[test]
    fn one_value_and_no_value_make_an_axis_too() {
        for values in [vec![], vec![0.0], vec![7.0, 7.0], vec![-1e-300], vec![1e300]] {
            let scale = Scale::round(values.iter().copied(), 5.0);
            assert!(
                scale.to > scale.from && scale.ticks().len() >= 2,
                "{values:?} {scale:?}"
            );
            assert!(
                values.iter().all(|v| (0.0..=1.0).contains(&scale.share(*v))),
                "{values:?} {scale:?}"
            );
        }
    }
}
