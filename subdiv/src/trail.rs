//! What the first traversal of a subtree decided, for the second one to follow.

/// One decision for each simplex visited, in the order of the traversal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trail {
    words: Vec<u64>,
    len: usize,
}

impl Trail {
    /// Notes whether a simplex is bisected.
    pub(crate) fn push(&mut self, bisect: bool) {
        if self.len.is_multiple_of(64) {
            self.words.push(0);
        }
        self.words[self.len / 64] |= u64::from(bisect) << (self.len % 64);
        self.len += 1;
    }

    /// The decision number `at`; false past the end.
    #[must_use]
    pub(crate) fn get(&self, at: usize) -> bool {
        self.words
            .get(at / 64)
            .is_some_and(|word| word >> (at % 64) & 1 == 1)
    }
}
