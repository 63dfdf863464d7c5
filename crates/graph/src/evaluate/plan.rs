//! From the targets upwards: which nodes are answered at once, and which must run.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;

use crate::catalogue::{Catalogue, ConvertFn};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::{CancelToken, Failure};
use crate::graph::{Graph, Node, NodeId, Source};
use crate::node_kind::NodeKind;
use crate::ports::{NodeError, Ports};
use crate::value::{ContentHash, KeyHasherBuilder, Value};

/// Where an input's value comes from.
pub(crate) enum Supply {
    /// Nothing; the input is optional.
    Nothing,
    /// A literal or default.
    Value(Value),
    /// An output of a scheduled node.
    Scheduled { step: usize, output: usize, conversion: Option<Arc<ConvertFn>> },
    /// An output that is known already.
    Known { entry: Arc<Entry>, output: usize, conversion: Option<Arc<ConvertFn>> },
}

/// A node that may have to run.
pub(crate) struct Step {
    pub(crate) node: NodeId,
    pub(crate) kind: Arc<NodeKind>,
    pub(crate) supplies: Vec<Supply>,
    /// Steps that take a value from this one, one entry per step.
    pub(crate) dependents: Vec<usize>,
    /// Steps that it takes values from, each once.
    pub(crate) sources: Vec<usize>,
    /// Whether its values are wanted after the evaluation.
    pub(crate) is_target: bool,
}

/// What the plan found out about a node.
#[derive(Clone)]
pub(crate) enum Found {
    /// The memo knows it.
    Known(ContentHash, Arc<Entry>),
    /// It may have to run.
    Scheduled(usize),
    /// It can't run.
    Failed(Failure),
    /// Nodes before it can't run.
    Waiting(Vec<String>),
}

/// The steps in an order in which each comes behind those it depends on, and what was found without running.
#[derive(Default)]
pub(crate) struct Plan {
    pub(crate) steps: Vec<Step>,
    pub(crate) found: HashMap<NodeId, Found, KeyHasherBuilder>,
    /// The nodes of `found`, in the order in which they were looked at.
    pub(crate) order: Vec<NodeId>,
}

pub(crate) struct Planner<'a> {
    pub(crate) catalogue: &'a Catalogue,
    pub(crate) graph: &'a Graph,
    pub(crate) memo: &'a Memo,
    pub(crate) base: &'a Path,
    pub(crate) cancel: &'a CancelToken,
}

impl Planner<'_> {
    /// `key_of` gives the memo key of a node that did not change since its last evaluation.
    pub(crate) fn plan(&self, targets: &[NodeId], key_of: impl Fn(NodeId) -> Option<ContentHash>) -> Plan {
        let mut plan = Plan::default();
        // An explicit stack: a chain of 100 000 nodes must not overflow the thread's.
        let mut stack: Vec<(NodeId, bool)> = targets.iter().rev().map(|t| (*t, false)).collect();
        while let Some((id, inputs_done)) = stack.pop() {
            if plan.found.contains_key(&id) {
                continue;
            }
            let Some(node) = self.graph.node(id) else { continue };
            if !inputs_done {
                if let Some((key, entry)) = key_of(id).and_then(|key| Some((key, self.memo.get(key)?))) {
                    plan.note(id, Found::Known(key, entry));
                    continue;
                }
                stack.push((id, true));
                // Reversed, because the last one in is the first one out: inputs are looked at in their order.
                for source in node.inputs.values().rev() {
                    if let Source::Link(link) = source
                        && !plan.found.contains_key(&link.node)
                    {
                        stack.push((link.node, false));
                    }
                }
                continue;
            }
            let found = self.look_at(&mut plan, id, node);
            plan.note(id, found);
        }
        for target in targets {
            if let Some(Found::Scheduled(step)) = plan.found.get(target) {
                plan.steps[*step].is_target = true;
            }
        }
        plan
    }

    fn look_at(&self, plan: &mut Plan, id: NodeId, node: &Node) -> Found {
        let Some(kind) = &node.kind else {
            let hint = self.catalogue.suggest(&node.kind_name);
            let hint = hint.map(|s| format!(" Did you mean \"{s}\"?")).unwrap_or_default();
            return Found::Failed(Failure {
                port: None,
                message: format!("the kind \"{}\" is unknown to this version.{hint}", node.kind_name),
            });
        };
        let supplies = match self.supplies(plan, node, kind) {
            Ok(supplies) => supplies,
            Err(found) => return found,
        };
        let mut sources: Vec<usize> = supplies
            .iter()
            .filter_map(|s| if let Supply::Scheduled { step, .. } = s { Some(*step) } else { None })
            .collect();
        sources.sort_unstable();
        sources.dedup();
        if sources.is_empty() {
            let inputs = gather(kind, &supplies, |_, _| None);
            let key = inputs.and_then(|inputs| key(kind, &inputs, self.base, self.cancel));
            match key {
                Err(failure) => return Found::Failed(failure),
                Ok(Some(key)) => {
                    if let Some(entry) = self.memo.get(key) {
                        return Found::Known(key, entry);
                    }
                }
                Ok(None) => {}
            }
        }
        let step = plan.steps.len();
        for source in &sources {
            plan.steps[*source].dependents.push(step);
        }
        plan.steps.push(Step {
            node: id,
            kind: kind.clone(),
            supplies,
            dependents: Vec::new(),
            sources,
            is_target: false,
        });
        Found::Scheduled(step)
    }

    fn supplies(&self, plan: &Plan, node: &Node, kind: &NodeKind) -> Result<Vec<Supply>, Found> {
        let mut supplies = Vec::with_capacity(kind.inputs().len());
        let mut waiting = Vec::new();
        for spec in kind.inputs() {
            let fail = |message: String| Found::Failed(Failure { port: Some(spec.name.clone()), message });
            let supply = match node.inputs.get(&spec.name) {
                Some(Source::Literal { value, .. }) => Supply::Value(value.clone()),
                Some(Source::Unread(_)) => {
                    return Err(fail("the file holds something here that could not be understood".to_owned()));
                }
                Some(Source::Link(link)) => {
                    let Some(source) = self.graph.node(link.node) else {
                        return Err(fail("it is linked to a node that is gone".to_owned()));
                    };
                    let Some(found) = plan.found.get(&link.node) else {
                        return Err(fail(format!("\"{}\" could not be reached", source.name)));
                    };
                    if let Found::Failed(_) | Found::Waiting(_) = found {
                        blame(&mut waiting, found, &source.name);
                        continue;
                    }
                    let output = source.kind.as_ref().and_then(|k| k.find_output(&link.output));
                    let Some((output, output_spec)) = output else {
                        return Err(fail(format!("\"{}\" has no output \"{}\"", source.name, link.output)));
                    };
                    let conversion =
                        if output_spec.wire == spec.wire {
                            None
                        } else {
                            let found = self.catalogue.find_conversion(output_spec.wire, spec.wire);
                            Some(found.cloned().ok_or_else(|| {
                                fail(format!("it takes {}, and {} arrives", spec.wire, output_spec.wire))
                            })?)
                        };
                    match found {
                        Found::Known(_, entry) if entry.result.is_err() => {
                            blame(&mut waiting, found, &source.name);
                            continue;
                        }
                        Found::Known(_, entry) => Supply::Known { entry: entry.clone(), output, conversion },
                        Found::Scheduled(step) => Supply::Scheduled { step: *step, output, conversion },
                        Found::Failed(_) | Found::Waiting(_) => continue,
                    }
                }
                None => match &spec.default_value {
                    Some(value) => Supply::Value(value.clone()),
                    None if spec.optional => Supply::Nothing,
                    None => {
                        return Err(fail(format!("nothing is connected: link an output that gives {}", spec.wire)));
                    }
                },
            };
            supplies.push(supply);
        }
        if waiting.is_empty() { Ok(supplies) } else { Err(Found::Waiting(waiting)) }
    }
}

impl Plan {
    fn note(&mut self, id: NodeId, found: Found) {
        self.found.insert(id, found);
        self.order.push(id);
    }
}

/// Adds the nodes that are to blame for a missing input, each once.
fn blame(waiting: &mut Vec<String>, found: &Found, name: &str) {
    match found {
        Found::Waiting(on) => on.iter().for_each(|name| blame_name(waiting, name)),
        _ => blame_name(waiting, name),
    }
}

pub(crate) fn blame_name(waiting: &mut Vec<String>, name: &str) {
    if !waiting.iter().any(|n| n == name) {
        waiting.push(name.to_owned());
    }
}

/// The values of all inputs, converted and checked. `scheduled` gives the values of steps.
pub(crate) fn gather(
    kind: &NodeKind,
    supplies: &[Supply],
    scheduled: impl Fn(usize, usize) -> Option<Value>,
) -> Result<Vec<Option<Value>>, Failure> {
    let mut inputs = Vec::with_capacity(supplies.len());
    for (spec, supply) in kind.inputs().iter().zip(supplies) {
        let fail = |message: String| Failure { port: Some(spec.name.clone()), message };
        let (value, conversion) = match supply {
            Supply::Nothing => {
                inputs.push(None);
                continue;
            }
            Supply::Value(value) => {
                inputs.push(Some(value.clone()));
                continue;
            }
            Supply::Scheduled { step, output, conversion } => (scheduled(*step, *output), conversion),
            Supply::Known { entry, output, conversion } => {
                (entry.result.as_ref().ok().and_then(|values| values.get(*output).cloned()), conversion)
            }
        };
        let Some(mut value) = value else {
            return Err(fail("its value was not there in time; this is a mistake in the engine".to_owned()));
        };
        if let Some(conversion) = conversion {
            value = conversion(&value).map_err(fail)?;
        }
        if let Some(reason) = spec.refuses_value(&value) {
            return Err(fail(reason));
        }
        inputs.push(Some(value));
    }
    Ok(inputs)
}

/// What the result depends on: kind, version, every input's content, and the kind's fingerprint. `None` where the
/// evaluation was cancelled meanwhile.
pub(crate) fn key(
    kind: &NodeKind,
    inputs: &[Option<Value>],
    base: &Path,
    cancel: &CancelToken,
) -> Result<Option<ContentHash>, Failure> {
    let mut bytes = Vec::with_capacity(kind.name().len() + 32 + 17 * inputs.len());
    bytes.extend_from_slice(kind.name().as_bytes());
    bytes.push(0);
    bytes.extend_from_slice(&kind.version().to_le_bytes());
    for input in inputs {
        match input {
            Some(value) => {
                bytes.push(1);
                bytes.extend_from_slice(&value.hash().0.to_le_bytes());
            }
            None => bytes.push(0),
        }
    }
    if let Some(fingerprint) = kind.fingerprint_fn() {
        let go_on = |_| !cancel.is_cancelled();
        let ports = Ports::new(kind, inputs, base, &go_on);
        match catch_unwind(AssertUnwindSafe(|| fingerprint(&ports))) {
            // It may have stopped halfway.
            _ if cancel.is_cancelled() => return Ok(None),
            Ok(Ok(hash)) => bytes.extend_from_slice(&hash.0.to_le_bytes()),
            Ok(Err(NodeError::Cancelled)) => return Ok(None),
            Ok(Err(NodeError::Failed { input, message })) => return Err(failure(kind, input, message)),
            Err(panic) => return Err(failure(kind, None, panic_message(kind, panic.as_ref()))),
        }
    }
    Ok(Some(crate::ContentHasher::of_bytes(&bytes)))
}

pub(crate) fn failure(kind: &NodeKind, input: Option<usize>, message: String) -> Failure {
    Failure { port: input.and_then(|i| kind.inputs().get(i)).map(|spec| spec.name.clone()), message }
}

pub(crate) fn panic_message(kind: &NodeKind, panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    format!("the node kind \"{}\" broke down ({text}); this is a mistake in the kind, please report it", kind.name())
}
