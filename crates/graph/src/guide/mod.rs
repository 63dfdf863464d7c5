//! The engine chapter by chapter: what to use when, what is promised, and what is not.
//!
//! | chapter | for |
//! |---|---|
//! | [`choosing`] | finding the type that does what you want |
//! | [`nodes`] | declaring wire types and node kinds |
//! | [`evaluating`] | results, events, progress, stopping |
//! | [`reports`] | notes, warnings, figures, tables, examinations |
//! | [`testing`] | one node alone, golden files, what re-ran |
//! | [`promises`] | determinism, caching, threads, memory, panics: what holds and what does not |
//!
//! Each is shown as a whole by a file in `examples/`: `cargo run -p maquette-graph --example declare_and_evaluate`.

#[doc = include_str!("choosing.md")]
pub mod choosing {}

#[doc = include_str!("nodes.md")]
pub mod nodes {}

#[doc = include_str!("evaluating.md")]
pub mod evaluating {}

#[doc = include_str!("reports.md")]
pub mod reports {}

#[doc = include_str!("testing.md")]
pub mod testing {}

#[doc = include_str!("promises.md")]
pub mod promises {}
