//! Calls a node's function; a panic in it is a failure of the node.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::evaluate::inputs::FileBytes;
use crate::examination::Examination;
use crate::node_kind::NodeKind;
use crate::ports::{NodeError, Ports};
use crate::report::Report;
use crate::value::Value;

/// Runs a kind on these inputs, one entry each.
pub(crate) fn call(
    kind: &NodeKind,
    inputs: &[Option<Value>],
    files: &[FileBytes],
    base: &Path,
    progress: &(dyn Fn(f64) -> bool + Sync),
) -> Result<(Vec<Value>, Report), NodeError> {
    let Some(run) = kind.evaluate_fn() else {
        return Err(NodeError::new(format!("the node kind \"{}\" does not say what it does", kind.name())));
    };
    let mut ports = Ports::new(kind, inputs, files, base, progress);
    caught(kind, || run(&mut ports))?;
    ports.finish()
}

/// Examines the outputs of a kind; nothing where it has nothing to add.
pub(crate) fn examine(
    kind: &NodeKind,
    values: &[Value],
    progress: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Report, NodeError> {
    let Some(run) = kind.examine_fn() else { return Ok(Report::default()) };
    let mut examination = Examination::new(kind, values, progress);
    caught(kind, || run(&mut examination))?;
    examination.finish()
}

pub(crate) fn caught<T>(kind: &NodeKind, run: impl FnOnce() -> Result<T, NodeError>) -> Result<T, NodeError> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
        let name = kind.name();
        Err(NodeError::new(format!(
            "the node kind \"{name}\" broke down ({text}); this is a mistake in the kind, please report it"
        )))
    })
}
