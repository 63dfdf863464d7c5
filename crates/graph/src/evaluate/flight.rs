//! What is being computed at the moment: no key is computed by two threads at the same time.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::evaluate::memo::Entry;
use crate::value::{ContentHash, KeyHasherBuilder};

/// Keys that are being computed, each with the steps that wait for it. A waiting step holds no thread: it is parked,
/// and whoever computes the key ends it as well.
///
/// Steps of bodies wait for each other in the same way. None waits for itself: a body is computed by steps of its own
/// graph, and no graph contains itself.
#[derive(Debug)]
pub(crate) struct Flights<T>(Mutex<HashMap<ContentHash, Vec<T>, KeyHasherBuilder>>);

impl<T> Default for Flights<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

/// What a step that wants a key has to do.
pub(crate) enum Boarding {
    /// Nothing: the memo has it.
    Remembered(Arc<Entry>),
    /// Nothing: it is parked.
    Parked,
    /// Compute it, put the result into the memo, and then land.
    Computes,
}

impl<T> Flights<T> {
    /// `remembered` asks the memo.
    pub(crate) fn board(&self, key: ContentHash, step: T, remembered: impl FnOnce() -> Option<Arc<Entry>>) -> Boarding {
        let mut flights = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(parked) = flights.get_mut(&key) {
            parked.push(step);
            return Boarding::Parked;
        }
        // Asked with the flights locked: results enter the memo before their flight lands, so none is missed.
        if let Some(entry) = remembered() {
            return Boarding::Remembered(entry);
        }
        flights.insert(key, Vec::new());
        Boarding::Computes
    }

    /// The steps that were parked for the key.
    pub(crate) fn land(&self, key: ContentHash) -> Vec<T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&key).unwrap_or_default()
    }
}
