//! From the targets upwards: which nodes are answered at once, and which must run.

use std::collections::HashMap;
use std::collections::hash_map::Entry as Slot;
use std::path::Path;
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::evaluate::Failure;
use crate::evaluate::blame::Blame;
use crate::evaluate::file_cache::FileCache;
use crate::evaluate::inputs::{Key, Supply, gather, key, key_of_kind};
use crate::evaluate::memo::{Entry, Memo};
use crate::graph::{Graph, Node, NodeId, Source};
use crate::node_kind::NodeKind;
use crate::value::{ContentHash, ContentHasher, KeyHasherBuilder};

/// A node that may have to run.
pub(crate) struct Step {
    pub(crate) node: NodeId,
    pub(crate) kind: Arc<NodeKind>,
    pub(crate) supplies: Vec<Supply>,
    /// Steps that take a value from this one, one entry per step.
    pub(crate) dependents: Vec<usize>,
    /// Steps that it takes values from, each once.
    pub(crate) sources: Vec<usize>,
    /// The first step of an equal kind with equal supplies, whose result is this one's too; one of `sources`.
    pub(crate) twin_of: Option<usize>,
    /// Whether its values are wanted after the evaluation.
    pub(crate) is_target: bool,
}

/// What the plan found out about a node.
#[derive(Clone)]
pub(crate) enum Found {
    /// The memo knows it.
    Known(Key, Arc<Entry>),
    /// It may have to run, or waits for nodes that do.
    Scheduled(usize),
    /// It can't run.
    Failed(Failure),
    /// These nodes failed before it, and no others will.
    Waiting(Vec<NodeId>),
}

/// The steps in an order in which each comes behind those it depends on, and what was found without running.
#[derive(Default)]
pub(crate) struct Plan {
    pub(crate) steps: Vec<Step>,
    pub(crate) found: HashMap<NodeId, Found, KeyHasherBuilder>,
    /// The nodes of `found`, in the order in which they were looked at.
    pub(crate) order: Vec<NodeId>,
    /// The first step of each kind with certain supplies.
    numbering: HashMap<ContentHash, usize, KeyHasherBuilder>,
}

pub(crate) struct Planner<'a> {
    pub(crate) catalogue: &'a Catalogue,
    pub(crate) graph: &'a Graph,
    pub(crate) memo: &'a Memo,
    pub(crate) base: &'a Path,
    pub(crate) files: &'a FileCache,
}

impl Planner<'_> {
    /// `key_of` gives the memo key of a node that did not change since its last evaluation.
    pub(crate) fn plan(&self, targets: &[NodeId], key_of: impl Fn(NodeId) -> Option<Key>) -> Plan {
        let mut plan = Plan::default();
        // An explicit stack: a chain of 100 000 nodes must not overflow the thread's.
        let mut stack: Vec<(NodeId, bool)> = targets.iter().rev().map(|t| (*t, false)).collect();
        while let Some((id, inputs_done)) = stack.pop() {
            if plan.found.contains_key(&id) {
                continue;
            }
            let Some(node) = self.graph.node(id) else { continue };
            if !inputs_done {
                if let Some((key, entry)) = key_of(id).and_then(|key| self.memo.get(key.hash).map(|entry| (key, entry)))
                {
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
                message: format!("the kind {:?} is unknown to this version.{hint}", node.kind_name),
            });
        };
        let supplies = match self.supplies(plan, node, kind) {
            Ok(supplies) => supplies,
            Err(failure) => return Found::Failed(failure),
        };
        let mut sources: Vec<usize> = supplies.iter().filter_map(Supply::step).collect();
        sources.sort_unstable();
        sources.dedup();
        let mut blame = Blame::default();
        for supply in &supplies {
            if let Supply::Missing(nodes) = supply {
                blame.add(nodes);
            }
        }
        let twin_of = match blame.into_nodes() {
            // Until every source has ended, it is not known which others are to blame.
            Some(_) if !sources.is_empty() => None,
            Some(blamed) => return Found::Waiting(blamed),
            None => {
                let number = if sources.is_empty() {
                    let inputs = gather(kind, &supplies, |_, _| None);
                    match inputs.and_then(|inputs| key(kind, &inputs, self.base, self.files)) {
                        Err(failure) => return Found::Failed(failure),
                        Ok(key) => {
                            if let Some(entry) = self.memo.get(key.hash) {
                                return Found::Known(key, entry);
                            }
                            key.hash
                        }
                    }
                } else {
                    plan.number(kind, &supplies)
                };
                match plan.numbering.entry(number) {
                    Slot::Occupied(first) => Some(*first.get()),
                    Slot::Vacant(free) => {
                        free.insert(plan.steps.len());
                        None
                    }
                }
            }
        };
        sources.extend(twin_of);
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
            twin_of,
            is_target: false,
        });
        Found::Scheduled(step)
    }

    /// Where the values of the inputs come from. What is said here must not depend on what the memo remembers.
    fn supplies(&self, plan: &Plan, node: &Node, kind: &NodeKind) -> Result<Vec<Supply>, Failure> {
        let mut supplies = Vec::with_capacity(kind.inputs().len());
        for spec in kind.inputs() {
            let fail = |message: String| Failure { port: Some(spec.name.clone()), message };
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
                        return Err(fail(format!("{:?} could not be reached", source.name)));
                    };
                    let Some(source_kind) = &source.kind else {
                        supplies.push(Supply::Missing(vec![link.node]));
                        continue;
                    };
                    let Some((output, output_spec)) = source_kind.find_output(&link.output) else {
                        return Err(fail(format!("{:?} has no output {:?}", source.name, link.output)));
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
                        Found::Known(_, entry) if entry.result.is_ok() => {
                            Supply::Known { entry: entry.clone(), output, conversion }
                        }
                        Found::Scheduled(step) => Supply::Scheduled { step: *step, output, conversion },
                        Found::Known(..) | Found::Failed(_) => Supply::Missing(vec![link.node]),
                        Found::Waiting(on) => Supply::Missing(on.clone()),
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
        Ok(supplies)
    }
}

impl Plan {
    fn note(&mut self, id: NodeId, found: Found) {
        self.found.insert(id, found);
        self.order.push(id);
    }

    /// Equal for steps whose results must be equal: the same kind, and supplies from equal steps or of equal values.
    fn number(&self, kind: &NodeKind, supplies: &[Supply]) -> ContentHash {
        let mut bytes = key_of_kind(kind, supplies.len());
        // No key of a node begins so: its first byte here says whether there is an input.
        bytes.push(u8::MAX);
        for supply in supplies {
            match supply {
                Supply::Nothing | Supply::Missing(_) => bytes.push(0),
                Supply::Value(value) => {
                    bytes.push(1);
                    bytes.extend_from_slice(&value.hash().0.to_le_bytes());
                }
                Supply::Known { entry, output, .. } => {
                    bytes.push(1);
                    if let Some(value) = entry.result.as_ref().ok().and_then(|values| values.get(*output)) {
                        bytes.extend_from_slice(&value.hash().0.to_le_bytes());
                    }
                }
                Supply::Scheduled { step, output, .. } => {
                    bytes.push(2);
                    let first = self.steps[*step].twin_of.unwrap_or(*step);
                    bytes.extend_from_slice(&(first as u64).to_le_bytes());
                    bytes.extend_from_slice(&(*output as u64).to_le_bytes());
                }
            }
        }
        ContentHasher::of_bytes(&bytes)
    }
}
