//! Numbers as text that loses nothing.

use std::fmt;

/// Shortest decimal that reads back to the same number; exponents only where they are shorter.
pub(super) struct Decimal(pub(super) f64);

impl fmt::Display for Decimal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Adding zero turns −0 into 0.
        let number = self.0 + 0.0;
        let magnitude = number.abs();
        if magnitude == 0.0 || (1e-5..1e16).contains(&magnitude) {
            write!(formatter, "{number}")
        } else {
            write!(formatter, "{number:e}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_without_negative_zero() {
        let shown = [-0.0, 0.1, 1e16, 1e-6, -123.456, 5e-324].map(|x| Decimal(x).to_string());
        assert_eq!(shown, ["0", "0.1", "1e16", "1e-6", "-123.456", "5e-324"]);
    }
}
