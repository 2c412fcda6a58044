//! What the first traversal of a subtree decided, for the second one to follow.

use crate::walk::Pruning;

/// One decision for each simplex visited, in the order of the traversal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trail {
    words: Vec<u64>,
    len: usize,
    /// What was pruned, by the number of the decision; ascending.
    prunings: Vec<(usize, Pruning)>,
}

/// How far a trail has been followed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Step {
    decision: usize,
    pruning: usize,
}

impl Trail {
    /// Notes whether a simplex is bisected, and what was pruned there before.
    pub(crate) fn push(&mut self, bisect: bool, pruning: Pruning) {
        if self.len.is_multiple_of(64) {
            self.words.push(0);
        }
        self.words[self.len / 64] |= u64::from(bisect) << (self.len % 64);
        if !pruning.is_empty() {
            self.prunings.push((self.len, pruning));
        }
        self.len += 1;
    }

    /// The next decision; past the end, to accept what is there.
    pub(crate) fn follow(&self, step: &mut Step) -> (bool, Pruning) {
        let at = step.decision;
        step.decision += 1;
        let word = self.words.get(at / 64);
        let bisect = word.is_some_and(|word| word >> (at % 64) & 1 == 1);
        match self.prunings.get(step.pruning) {
            Some((known, pruning)) if *known == at => {
                step.pruning += 1;
                (bisect, *pruning)
            }
            _ => (bisect, Pruning::default()),
        }
    }
}
