//! Results by the hash of what they depend on, within a budget of bytes.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use lru::LruCache;

use crate::evaluate::Failure;
use crate::evaluate::inputs::FileContent;
use crate::report::Report;
use crate::value::{ContentHash, KeyHasherBuilder, Value};

/// What a run gave.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) result: Result<Arc<[Value]>, Failure>,
    pub(crate) report: Arc<Report>,
    pub(crate) duration: Duration,
    /// The files that were read within a body: the entry answers only while they are what they were.
    pub(crate) files: Option<Arc<[FileContent]>>,
}

impl Entry {
    fn byte_size(&self) -> usize {
        // The map's own cost for an entry counts too, or a million tiny results would cost nothing.
        let values = self.result.as_ref().map_or(0, |values| values.iter().map(Value::byte_size).sum());
        values + self.report.byte_size() + size_of::<Self>() + 128
    }
}

/// Entries by key; the least recently used go first when the budget is exceeded.
#[derive(Debug)]
pub(crate) struct Memo {
    inner: Mutex<Inner>,
    budget: usize,
}

#[derive(Debug)]
struct Inner {
    entries: LruCache<ContentHash, Arc<Entry>, KeyHasherBuilder>,
    bytes: usize,
}

impl Memo {
    pub(crate) fn new(budget: usize) -> Self {
        Self {
            inner: Mutex::new(Inner {
                entries: LruCache::unbounded_with_hasher(KeyHasherBuilder::default()),
                bytes: 0,
            }),
            budget,
        }
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // Nothing below can panic halfway through a change, so a poisoned lock still guards a whole memo.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn get(&self, key: ContentHash) -> Option<Arc<Entry>> {
        self.lock().entries.get(&key).cloned()
    }

    pub(crate) fn insert(&self, key: ContentHash, entry: Arc<Entry>) {
        let size = entry.byte_size();
        if size > self.budget {
            return;
        }
        let mut inner = self.lock();
        inner.bytes += size;
        if let Some(replaced) = inner.entries.put(key, entry) {
            inner.bytes -= replaced.byte_size();
        }
        while inner.bytes > self.budget {
            let Some((_, evicted)) = inner.entries.pop_lru() else { break };
            inner.bytes -= evicted.byte_size();
        }
    }

    pub(crate) fn byte_size(&self) -> usize {
        self.lock().bytes
    }

    pub(crate) fn clear(&self) {
        let mut inner = self.lock();
        inner.entries.clear();
        inner.bytes = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(bytes: usize) -> Arc<Entry> {
        let text = "x".repeat(bytes);
        Arc::new(Entry {
            result: Ok(vec![Value::new(text)].into()),
            report: Arc::default(),
            duration: Duration::ZERO,
            files: None,
        })
    }

    #[test]
    fn the_least_recently_used_go_first_and_the_budget_holds() {
        let memo = Memo::new(5_000);
        for key in 0..3 {
            memo.insert(ContentHash(key), entry(1_000));
        }
        assert!(memo.get(ContentHash(0)).is_some());
        for key in 3..5 {
            memo.insert(ContentHash(key), entry(1_000));
        }
        assert!(memo.byte_size() <= 5_000);
        assert!(memo.get(ContentHash(0)).is_some(), "used a moment ago");
        assert!(memo.get(ContentHash(1)).is_none(), "used longest ago");
    }

    #[test]
    fn what_exceeds_the_budget_alone_is_not_remembered_and_evicts_nothing() {
        let memo = Memo::new(5_000);
        memo.insert(ContentHash(0), entry(1_000));
        memo.insert(ContentHash(1), entry(10_000));
        assert!(memo.get(ContentHash(0)).is_some());
        assert!(memo.get(ContentHash(1)).is_none());
    }

    #[test]
    fn replacing_an_entry_does_not_count_twice() {
        let memo = Memo::new(50_000);
        memo.insert(ContentHash(0), entry(1_000));
        let once = memo.byte_size();
        memo.insert(ContentHash(0), entry(1_000));
        assert_eq!(memo.byte_size(), once);
    }
}
