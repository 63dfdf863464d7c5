//! Telling how far a reader is, and asking whether to go on.

use super::ReadError;

/// Counts work and asks every so often.
pub(super) struct Pace<'a> {
    progress: &'a dyn Fn(f64) -> bool,
    of: usize,
    next: usize,
    every: usize,
}

impl<'a> Pace<'a> {
    /// `of` units of work, asked about every `every` units: some milliseconds.
    pub(super) fn new(progress: &'a dyn Fn(f64) -> bool, of: usize, every: usize) -> Self {
        Self { progress, of, next: 0, every }
    }

    /// So many units are done.
    ///
    /// # Errors
    /// [`ReadError::Stopped`].
    pub(super) fn at(&mut self, done: usize) -> Result<(), ReadError> {
        if done < self.next {
            return Ok(());
        }
        self.next = done + self.every;
        if (self.progress)(done as f64 / self.of.max(1) as f64) { Ok(()) } else { Err(ReadError::Stopped) }
    }
}
