//! What is being computed at the moment: no key is computed by two threads at the same time.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::evaluate::memo::{Entry, Memo};
use crate::value::{ContentHash, KeyHasherBuilder};

/// Keys that are being computed, each with the steps that wait for it. A waiting step holds no thread: it is parked,
/// and whoever computes the key ends it as well.
#[derive(Debug, Default)]
pub(crate) struct Flights(Mutex<HashMap<ContentHash, Vec<usize>, KeyHasherBuilder>>);

/// What a step that wants a key has to do.
pub(crate) enum Boarding {
    /// Nothing: the memo has it.
    Remembered(Arc<Entry>),
    /// Nothing: it is parked.
    Parked,
    /// Compute it, put the result into the memo, and then land.
    Computes,
}

impl Flights {
    pub(crate) fn board(&self, key: ContentHash, step: usize, memo: &Memo) -> Boarding {
        let mut flights = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(parked) = flights.get_mut(&key) {
            parked.push(step);
            return Boarding::Parked;
        }
        // Asked with the flights locked: results enter the memo before their flight lands, so none is missed.
        if let Some(entry) = memo.get(key) {
            return Boarding::Remembered(entry);
        }
        flights.insert(key, Vec::new());
        Boarding::Computes
    }

    /// The steps that were parked for the key.
    pub(crate) fn land(&self, key: ContentHash) -> Vec<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&key).unwrap_or_default()
    }
}
