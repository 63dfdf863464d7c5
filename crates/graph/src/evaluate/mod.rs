//! Evaluation: pulled from the nodes asked for, memoised by content, parallel, cancellable.
//!
//! 1. *Sync*: what changed since the last evaluation, and everything behind it, becomes stale ([`evaluator`]).
//! 2. *Plan*: from the targets upwards, stale nodes are scheduled; a node whose inputs are all known is looked up in
//!    the memo at once, so that undo and redo never reach step 3 ([`plan`]).
//! 3. *Run*: scheduled nodes run as soon as their inputs are there; each first asks the memo, because an upstream
//!    node may have recomputed an equal result ([`run`]).

mod cancel;
mod evaluation;
mod evaluator;
mod event;
mod memo;
mod plan;
mod run;

pub use cancel::CancelToken;
pub use evaluation::{Evaluation, Failure, Outcome, OutcomeState};
pub use evaluator::{Evaluator, EvaluatorOptions, Request};
pub use event::{Event, EventKind, EventLog, Events};
