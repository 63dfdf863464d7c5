//! Evaluation: pulled from the nodes asked for, memoised by content, parallel, cancellable.
//!
//! 1. *Sync*: what changed since the last evaluation, and everything behind it, becomes stale ([`evaluator`]).
//! 2. *Plan*: from the targets upwards, stale nodes are scheduled; a node whose inputs are all known is looked up in
//!    the memo at once, so that undo and redo never reach step 3 ([`plan`]).
//! 3. *Run*: scheduled nodes run as soon as their inputs are there; each first asks the memo, because an upstream
//!    node may have recomputed an equal result ([`run`]).
//!
//! A node with a body has a run of its own for that body (a `repeat` several), planned when its inputs are there
//! ([`composite`]). All runs share memo, files and threads; a step that waits for the run of its body holds no thread.
//!
//! Nothing is computed twice in one evaluation. Nodes of equal kinds and equal supplies are found equal while planning,
//! and all but the first take the result of the first, whatever the number of threads. Nodes whose inputs merely turn
//! out equal find the result in the memo, or, while it is being computed, wait for it ([`flight`]); which of them runs
//! then depends on who comes first, but not how many run, as long as the byte budget holds what an evaluation makes.

mod blame;
pub(crate) mod call;
mod cancel;
mod composite;
mod evaluation;
mod evaluator;
mod event;
mod examine;
mod file_cache;
mod flight;
pub(crate) mod inputs;
mod memo;
mod place;
mod plan;
mod run;
mod within;

pub use cancel::CancelToken;
pub use evaluation::{Evaluation, Failure, Outcome, OutcomeState};
pub use evaluator::{Evaluator, EvaluatorOptions, Request};
pub use event::{Event, EventKind, EventLog, Events};
