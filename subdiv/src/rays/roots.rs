//! Sign changes of a univariate Bernstein polynomial on [0, 1].
//!
//! It has as many roots as its coefficients have sign changes, or an even number fewer: intervals
//! are halved until they have one or none. Zero counts as positive, so that a root at the end of
//! two intervals is found in one of them.

/// Work space, and what was found last.
#[derive(Debug, Default)]
pub(super) struct Roots {
    /// Coefficients of the intervals to look at, one after the other.
    open: Vec<f64>,
    /// Those intervals, the first one last.
    spans: Vec<[f64; 2]>,
    halves: [Vec<f64>; 2],
    line: Vec<f64>,
    found: Vec<f64>,
}

/// Intervals narrower than this are not cut any more: two roots so near to each other are one
/// place where the sign stays.
const NARROWEST: f64 = 1e-13;

impl Roots {
    /// The places where the sign changes, ascending.
    pub(super) fn of(&mut self, coefficients: &[f64]) -> &[f64] {
        self.found.clear();
        if sign_changes(coefficients) == 0 {
            return &self.found;
        }
        let length = coefficients.len();
        self.open.clear();
        self.open.extend_from_slice(coefficients);
        self.spans.clear();
        self.spans.push([0.0, 1.0]);
        while let Some([from, to]) = self.spans.pop() {
            let start = self.open.len() - length;
            let own = &self.open[start..];
            match sign_changes(own) {
                0 => self.open.truncate(start),
                1 => {
                    let part = root(own, &mut self.line);
                    self.found.push(from + (to - from) * part);
                    self.open.truncate(start);
                }
                _ if to - from < NARROWEST => {
                    if is_negative(own[0]) != is_negative(own[length - 1]) {
                        self.found.push(0.5 * (from + to));
                    }
                    self.open.truncate(start);
                }
                _ => {
                    let middle = 0.5 * (from + to);
                    halve(own, &mut self.halves);
                    self.open.truncate(start);
                    self.open.extend_from_slice(&self.halves[1]);
                    self.open.extend_from_slice(&self.halves[0]);
                    self.spans.push([middle, to]);
                    self.spans.push([from, middle]);
                }
            }
        }
        &self.found
    }
}

/// Zero counts as positive.
pub(super) fn is_negative(value: f64) -> bool {
    value < 0.0
}

fn sign_changes(coefficients: &[f64]) -> usize {
    let pairs = coefficients.windows(2);
    pairs
        .filter(|pair| is_negative(pair[0]) != is_negative(pair[1]))
        .count()
}

/// De Casteljau at the middle.
fn halve(coefficients: &[f64], [low, high]: &mut [Vec<f64>; 2]) {
    low.clear();
    high.clear();
    high.extend_from_slice(coefficients);
    for left in (0..coefficients.len()).rev() {
        low.push(high[0]);
        for at in 0..left {
            high[at] = 0.5 * (high[at] + high[at + 1]);
        }
    }
}

/// Value at a parameter, by de Casteljau.
fn value(coefficients: &[f64], t: f64, line: &mut Vec<f64>) -> f64 {
    line.clear();
    line.extend_from_slice(coefficients);
    for left in (1..line.len()).rev() {
        for at in 0..left {
            line[at] += t * (line[at + 1] - line[at]);
        }
    }
    line[0]
}

/// The only root on [0, 1] of a polynomial whose ends differ in sign.
///
/// The secant with one end's value halved when the other end moves twice (Illinois), and a
/// bisection in every third step, for roots that are nearly multiple.
fn root(coefficients: &[f64], line: &mut Vec<f64>) -> f64 {
    const STEPS: usize = 160;
    let first_is_negative = is_negative(coefficients[0]);
    let mut low = (0.0, coefficients[0]);
    let mut high = (1.0, coefficients[coefficients.len() - 1]);
    let mut moved_low = None;
    for step in 0..STEPS {
        if high.0 - low.0 <= NARROWEST {
            break;
        }
        let secant = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
        let between = secant > low.0 && secant < high.0;
        let t = if between && step % 3 != 2 {
            secant
        } else {
            0.5 * (low.0 + high.0)
        };
        let here = value(coefficients, t, line);
        if is_negative(here) == first_is_negative {
            low = (t, here);
            if moved_low == Some(true) {
                high.1 *= 0.5;
            }
            moved_low = Some(true);
        } else {
            high = (t, here);
            if moved_low == Some(false) {
                low.1 *= 0.5;
            }
            moved_low = Some(false);
        }
    }
    0.5 * (low.0 + high.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Π (t − root), in Bernstein form: a factor turns b into ((n−i)·(−r)·b_i + i·(1−r)·b_(i−1))/n.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let mut b = vec![1.0];
        for root in roots {
            let n = b.len() as f64;
            let mut next = vec![0.0; b.len() + 1];
            for (i, coefficient) in b.iter().enumerate() {
                next[i] -= (n - i as f64) / n * root * coefficient;
                next[i + 1] += (i as f64 + 1.0) / n * (1.0 - root) * coefficient;
            }
            b = next;
        }
        b
    }

    proptest! {
        #[test]
        fn roots_that_were_put_in_are_found(
            inside in proptest::collection::vec(0.001..0.999f64, 0..5),
            outside in proptest::collection::vec(1.5..9.0f64, 0..4),
        ) {
            let mut expected = inside.clone();
            expected.sort_by(f64::total_cmp);
            let apart = expected.windows(2).all(|pair| pair[1] - pair[0] > 0.01);
            prop_assume!(apart);
            let all: Vec<f64> = inside.into_iter().chain(outside).collect();
            let mut roots = Roots::default();
            let found = roots.of(&with_roots(&all));
            prop_assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(expected) {
                // A relative error of 1e-15 in the coefficients, over slopes above 1e-8.
                prop_assert!((a - b).abs() < 1e-7, "{a} {b}");
            }
        }
    }

    #[test]
    fn touching_is_no_change_and_ends_count_once() {
        let mut roots = Roots::default();
        assert!(roots.of(&with_roots(&[0.5, 0.5])).is_empty());
        // Rounded, the polynomial may really have two roots there.
        assert!(roots.of(&with_roots(&[0.3, 0.3])).len().is_multiple_of(2));
        assert_eq!(roots.of(&with_roots(&[0.5, 0.5, 0.5])).len(), 1);
        assert!(roots.of(&[0.0, 0.0, 0.0]).is_empty());
        // Negative before, zero at 1: the change belongs to this interval or to the next one.
        let ends = roots.of(&[-1.0, 0.0]).len() + roots.of(&[0.0, 1.0]).len();
        assert_eq!(ends, 1);
        let ends = roots.of(&[1.0, 0.0]).len() + roots.of(&[0.0, -1.0]).len();
        assert_eq!(ends, 1);
    }
}
