//! From the targets upwards: which nodes are answered at once, and which must run.

use std::collections::HashMap;
use std::collections::hash_map::Entry as Slot;
use std::sync::Arc;

use crate::body::Body;
use crate::catalogue::{Catalogue, ConvertFn};
use crate::evaluate::Failure;
use crate::evaluate::blame::Blame;
use crate::evaluate::inputs::{Disk, Key, Supply, gather, key, key_of_kind};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::place::Place;
use crate::graph::{Node, NodeId, Source};
use crate::node_kind::NodeKind;
use crate::port::InputSpec;
use crate::value::{ContentHash, ContentHasher, KeyHasherBuilder, WireType};

/// A node that may have to run.
pub(crate) struct Step {
    pub(crate) node: NodeId,
    pub(crate) kind: Arc<NodeKind>,
    /// What it evaluates, where its kind has a body.
    pub(crate) body: Option<Arc<Body>>,
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
    pub(crate) place: &'a Place<'a>,
    pub(crate) memo: &'a Memo,
    pub(crate) disk: Disk<'a>,
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
            let Some(node) = self.place.graph().node(id) else { continue };
            if !inputs_done {
                let known = key_of(id).and_then(|mut key| Some((self.disk.remembered(self.memo, &mut key)?, key)));
                if let Some((entry, key)) = known {
                    plan.note(id, Found::Known(key, entry));
                    continue;
                }
                stack.push((id, true));
                // Reversed, because the last one in is the first one out: inputs are looked at in their order.
                for source in node.active_sources().rev() {
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
        let Some(kind) = node.acting_kind() else { return Found::Failed(self.unknown_kind(node)) };
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
                    match inputs.and_then(|inputs| key(kind, &inputs, self.disk)) {
                        Err(failure) => return Found::Failed(failure),
                        Ok(mut key) => {
                            if let Some(entry) = self.disk.remembered(self.memo, &mut key) {
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
            body: node.body.clone().filter(|_| kind.has_body()),
            supplies,
            dependents: Vec::new(),
            sources,
            twin_of,
            is_target: false,
        });
        Found::Scheduled(step)
    }

    fn unknown_kind(&self, node: &Node) -> Failure {
        let message = match node.body.as_ref().map(|body| body.kind(self.catalogue, &node.kind_name)) {
            Some(Err(error)) => error.to_string(),
            _ if self.catalogue.kind(&node.kind_name).is_some_and(|kind| kind.has_body()) => {
                "its body could not be understood: correct it in the file".to_owned()
            }
            _ => {
                let hint = self.catalogue.suggest(&node.kind_name);
                let hint = hint.map(|s| format!(" Did you mean \"{s}\"?")).unwrap_or_default();
                format!("the kind {:?} is unknown to this version.{hint}", node.kind_name)
            }
        };
        Failure { port: None, message }
    }

    /// Where the values of the inputs come from. What is said here must not depend on what the memo remembers.
    pub(crate) fn supplies(&self, plan: &Plan, node: &Node, kind: &NodeKind) -> Result<Vec<Supply>, Failure> {
        let mut supplies = Vec::with_capacity(kind.inputs().len());
        for spec in kind.inputs() {
            let fail = |message: String| Failure { port: Some(spec.name.clone()), message };
            let supply = match node.inputs.get(&spec.name) {
                Some(Source::Literal { value, .. }) => Supply::Value(self.place.spelled(value)),
                Some(Source::Parameter(name)) => match self.place.given.get(name) {
                    Some(value) => {
                        let conversion = self.conversion(value.wire(), spec.wire).map_err(fail)?;
                        Supply::Given { value: value.clone(), conversion }
                    }
                    None => self.nothing(spec, Some(name)).map_err(fail)?,
                },
                Some(Source::Unread(_)) => {
                    return Err(fail("the file holds something here that could not be understood".to_owned()));
                }
                Some(Source::Link(link)) => {
                    let Some(source) = self.place.graph().node(link.node) else {
                        return Err(fail("it is linked to a node that is gone".to_owned()));
                    };
                    let Some(found) = plan.found.get(&link.node) else {
                        return Err(fail(format!("{:?} could not be reached", source.name)));
                    };
                    let Some(source_kind) = source.acting_kind() else {
                        supplies.push(Supply::Missing(vec![link.node]));
                        continue;
                    };
                    let Some((output, output_spec)) = source_kind.find_output(&link.output) else {
                        let (name, output) = (&source.name, &link.output);
                        return Err(fail(if source.muted {
                            format!(
                                "{name:?} is muted and has nothing to pass on at {output:?}: unmute it, or link another"
                            )
                        } else {
                            format!("{name:?} has no output {output:?}")
                        }));
                    };
                    let conversion = self.conversion(output_spec.wire, spec.wire).map_err(fail)?;
                    match found {
                        Found::Known(_, entry) if entry.result.is_ok() => {
                            Supply::Known { entry: entry.clone(), output, conversion }
                        }
                        Found::Scheduled(step) => Supply::Scheduled { step: *step, output, conversion },
                        Found::Known(..) | Found::Failed(_) => Supply::Missing(vec![link.node]),
                        Found::Waiting(on) => Supply::Missing(on.clone()),
                    }
                }
                None => self.nothing(spec, None).map_err(fail)?,
            };
            supplies.push(supply);
        }
        Ok(supplies)
    }
}

impl Planner<'_> {
    fn conversion(&self, from: WireType, to: WireType) -> Result<Option<Arc<ConvertFn>>, String> {
        if from == to {
            return Ok(None);
        }
        let found = self.catalogue.find_conversion(from, to);
        found.cloned().map(Some).ok_or_else(|| format!("it takes {to}, and {from} arrives"))
    }

    /// What an input gets where nothing of its own is there, or the parameter there holds nothing.
    fn nothing(&self, spec: &InputSpec, parameter: Option<&str>) -> Result<Supply, String> {
        match (&spec.default_value, parameter) {
            (Some(value), _) => Ok(Supply::Value(self.place.spelled(value))),
            (None, _) if spec.optional => Ok(Supply::Nothing),
            (None, None) => Err(format!("nothing is connected: link an output that gives {}", spec.wire)),
            (None, Some(name)) => Err(format!("the parameter \"{name}\" holds nothing, and {} is needed", spec.wire)),
        }
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
                Supply::Value(value) | Supply::Given { value, .. } => {
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
