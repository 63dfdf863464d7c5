//! Steps whose kind has a body: they end when the runs of that body do.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crate::body::{Body, COUNT, Repeat};
use crate::evaluate::call;
use crate::evaluate::evaluator::announce;
use crate::evaluate::inputs::{FileContent, Key};
use crate::evaluate::memo::Entry;
use crate::evaluate::plan::{Found, Planner, Step};
use crate::evaluate::run::{Ended, Led, Run, Runner, locked};
use crate::evaluate::{EventKind, Failure};
use crate::graph::{Graph, NodeId, Source};
use crate::node_kind::NodeKind;
use crate::ports::NodeError;
use crate::report::Report;
use crate::value::Value;

/// A step whose body is being evaluated.
pub(crate) struct Composite<'a> {
    run: Arc<Run<'a>>,
    step: usize,
    body: Arc<Body>,
    key: Key,
    inputs: Vec<Option<Value>>,
    begun: Instant,
    times: Mutex<Times>,
}

/// The times that the body is evaluated.
#[derive(Default)]
struct Times {
    /// Items of a list, one a time.
    items: Option<Vec<Value>>,
    total: usize,
    next: usize,
    running: usize,
    ended: usize,
    gave: Vec<Option<Gave>>,
    /// What is fed back the next time, by parameter.
    fed: BTreeMap<String, Value>,
    /// Whether no further time begins.
    stopped: bool,
}

/// What one time gave.
struct Gave {
    values: Result<Vec<Value>, Stop>,
    report: Report,
    files: Vec<FileContent>,
}

enum Stop {
    Failed(Failure),
    Cancelled,
}

impl Gave {
    fn failed(failure: Failure) -> Self {
        Self { values: Err(Stop::Failed(failure)), report: Report::default(), files: Vec::new() }
    }
}

fn plain(message: impl Into<String>) -> Failure {
    Failure { port: None, message: message.into() }
}

fn at(port: &str, message: impl Into<String>) -> Failure {
    Failure { port: Some(port.to_owned()), message: message.into() }
}

/// What the inputs of a node give to the graph within it, by the names of its parameters.
pub(crate) fn given_to(kind: &NodeKind, inputs: &[Option<Value>]) -> BTreeMap<String, Value> {
    let inputs = kind.inputs().iter().zip(inputs);
    inputs.filter_map(|(spec, value)| Some((spec.name.clone(), value.clone()?))).collect()
}

/// Lists are split and joined by functions of the catalogue; a panic in one is a failure of the step.
fn caught<T>(step: &Step, run: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    call::caught(&step.kind, || Ok(run())).unwrap_or_else(|error| {
        Err(plain(match error {
            NodeError::Failed { message, .. } => message,
            NodeError::Cancelled => "it was stopped".to_owned(),
        }))
    })
}

impl<'a> Composite<'a> {
    pub(crate) fn new(
        run: Arc<Run<'a>>,
        step: usize,
        body: Arc<Body>,
        key: Key,
        inputs: Vec<Option<Value>>,
    ) -> Arc<Self> {
        Arc::new(Self { run, step, body, key, inputs, begun: Instant::now(), times: Mutex::default() })
    }

    fn step(&self) -> &Step {
        &self.run.plan.steps[self.step]
    }

    fn input(&self, name: &str) -> Option<&Value> {
        let place = self.step().kind.inputs().iter().position(|spec| spec.name == name)?;
        self.inputs.get(place)?.as_ref()
    }

    fn is_repeated(&self) -> bool {
        *self.body.repeat() != Repeat::Once
    }
}

impl<'a> Runner<'a> {
    /// Begins to evaluate a body.
    pub(crate) fn begin(&self, composite: Arc<Composite<'a>>, led: &mut Led<'a>) {
        match caught(composite.step(), || self.count(&composite)) {
            Ok((total, items)) => {
                let mut times = locked(&composite.times);
                times.total = total;
                times.items = items;
                times.gave.resize_with(total, || None);
            }
            Err(failure) => return self.fail(&composite, failure, led),
        }
        self.advance(&composite, led);
    }

    /// How often the body is evaluated, and for which items.
    fn count(&self, composite: &Composite<'a>) -> Result<(usize, Option<Vec<Value>>), Failure> {
        match composite.body.repeat() {
            Repeat::Once => Ok((1, None)),
            Repeat::Times | Repeat::FeedBack(_) => {
                let count = composite.input(COUNT).and_then(|value| value.get::<i64>().copied()).unwrap_or(0);
                Ok((usize::try_from(count).unwrap_or(0), None))
            }
            Repeat::Each(parameter) => {
                let graph = composite.body.graph();
                let item = graph.and_then(|graph| graph.parameter(parameter)).map(|parameter| parameter.wire());
                let list = item.and_then(|item| self.catalogue.list_of(item));
                let missing = || at(parameter, "there is no list of what it takes; this is a mistake in the engine");
                let (list, value) = list.zip(composite.input(parameter)).ok_or_else(missing)?;
                let items = (list.split)(value).map_err(|reason| at(parameter, reason))?;
                Ok((items.len(), Some(items)))
            }
        }
    }

    /// Begins as many times as there is room for, or ends the step where none is left.
    fn advance(&self, composite: &Arc<Composite<'a>>, led: &mut Led<'a>) {
        loop {
            let mut times = locked(&composite.times);
            times.stopped |= self.cancel.is_cancelled();
            let width = if matches!(composite.body.repeat(), Repeat::FeedBack(_)) { 1 } else { self.width };
            let is_over = times.stopped || times.next == times.total;
            if !is_over && times.running < width {
                let index = times.next;
                times.next += 1;
                times.running += 1;
                let item = times.items.as_ref().and_then(|items| items.get(index).cloned());
                let fed = times.fed.clone();
                drop(times);
                let begun = self.begin_time(composite, index, item, fed);
                match begun {
                    Ok(run) => led.started.push(run),
                    Err(failure) => {
                        let mut times = locked(&composite.times);
                        times.gave[index] = Some(Gave::failed(failure));
                        times.running -= 1;
                        times.stopped = true;
                    }
                }
            } else {
                // Only one thread sees the last one end.
                let concludes = is_over && times.running == 0 && times.gave.len() == times.total;
                if concludes {
                    let gave = std::mem::take(&mut times.gave);
                    // Nobody concludes again, and nobody begins.
                    times.total = usize::MAX;
                    times.stopped = true;
                    drop(times);
                    self.conclude(composite, gave, led);
                }
                return;
            }
        }
    }

    /// Plans the body for one time.
    fn begin_time(
        &self,
        composite: &Arc<Composite<'a>>,
        index: usize,
        item: Option<Value>,
        fed: BTreeMap<String, Value>,
    ) -> Result<Arc<Run<'a>>, Failure> {
        let step = composite.step();
        let graph = composite.body.shared_graph().ok_or_else(|| plain("its body is not there"))?.clone();
        let outer = &composite.run.place;
        let time = composite.is_repeated().then_some(index);
        let given = given_to(&step.kind, &composite.inputs);
        let mut place = outer.of_body(step.node, &composite.body, graph.clone(), time, given);
        if let (Repeat::Each(parameter), Some(item)) = (composite.body.repeat(), item) {
            if let Some(reason) = graph.parameter(parameter).and_then(|p| p.spec().refuses_value(&item)) {
                return Err(at(parameter, format!("at index {index}: {reason}")));
            }
            place.given.insert(parameter.clone(), item);
        }
        place.given.extend(fed);
        let mut targets: Vec<NodeId> = graph.outputs().filter_map(|output| Some(output.link()?.node)).collect();
        targets.sort_unstable();
        targets.dedup();
        let disk = self.disk(&place);
        let planner = Planner { catalogue: self.catalogue, place: &place, memo: self.memo, disk };
        let plan = planner.plan(&targets, |_| None);
        if !plan.order.is_empty() {
            let mut planned = locked(&self.planned);
            *planned += plan.order.len();
            outer.emit(self.events, step.node, EventKind::Planned(*planned));
        }
        announce(self.events, &place, &plan);
        Ok(Run::new(place, plan, Some((composite.clone(), index))))
    }

    /// Takes what one time gave, where the run was one of a body.
    pub(crate) fn run_is_over(&self, run: &Arc<Run<'a>>, led: &mut Led<'a>) {
        let Some((composite, index)) = &run.within else { return };
        let mut gave = gather(composite, run, *index);
        let fed = match (&gave.values, composite.body.repeat()) {
            (Ok(values), Repeat::FeedBack(pairs)) => match self.feed(composite, pairs, values) {
                Ok(fed) => fed,
                Err(failure) => {
                    gave.values = Err(Stop::Failed(failure));
                    BTreeMap::new()
                }
            },
            _ => BTreeMap::new(),
        };
        let mut times = locked(&composite.times);
        times.stopped |= gave.values.is_err();
        if matches!(composite.body.repeat(), Repeat::FeedBack(_)) && gave.values.is_ok() && index + 1 < times.total {
            // Only what the last time gave is wanted.
            gave.values = Ok(Vec::new());
        }
        if gave.values.is_ok() {
            times.ended += 1;
            if times.total > 1 {
                #[expect(clippy::cast_precision_loss, reason = "a list of so many items would not fit into memory")]
                let done = times.ended as f64 / times.total as f64;
                // Before it counts as ended, so that the end of the step comes behind.
                composite.run.place.emit(self.events, composite.step().node, EventKind::Progress(done));
            }
        }
        times.gave[*index] = Some(gave);
        times.fed = fed;
        times.running -= 1;
        drop(times);
        self.advance(composite, led);
    }

    /// What the next time gets.
    fn feed(
        &self,
        composite: &Composite<'a>,
        pairs: &BTreeMap<String, String>,
        values: &[Value],
    ) -> Result<BTreeMap<String, Value>, Failure> {
        let mut fed = BTreeMap::new();
        for (parameter, output) in pairs {
            let value = composite.step().kind.find_output(output).and_then(|(place, _)| values.get(place));
            let spec = composite.body.graph().and_then(|graph| graph.parameter(parameter)).map(|p| p.spec());
            let Some((value, spec)) = value.zip(spec) else { continue };
            let value = match self.catalogue.find_conversion(value.wire(), spec.wire) {
                Some(convert) if value.wire() != spec.wire => {
                    convert(value).map_err(|reason| at(parameter, format!("what is fed back: {reason}")))?
                }
                _ => value.clone(),
            };
            if let Some(reason) = spec.refuses_value(&value) {
                return Err(at(parameter, format!("what is fed back: {reason}")));
            }
            fed.insert(parameter.clone(), value);
        }
        Ok(fed)
    }

    fn fail(&self, composite: &Composite<'a>, failure: Failure, led: &mut Led<'a>) {
        let duration = composite.begun.elapsed();
        // Not remembered: what failed within is, as far as it may be.
        let ended = Ended::Failed { key: None, failure, duration, ran: true };
        self.land(&composite.run, composite.step, ended, Some(composite.key.hash), led);
    }

    fn conclude(&self, composite: &Composite<'a>, gave: Vec<Option<Gave>>, led: &mut Led<'a>) {
        let mut report = Report::default();
        let mut files = Vec::new();
        let mut times = Vec::with_capacity(gave.len());
        let mut cancelled = false;
        for time in gave {
            match time {
                None => cancelled = true,
                Some(Gave { values: Err(Stop::Cancelled), .. }) => cancelled = true,
                // The first one in order: all before it ended.
                Some(Gave { values: Err(Stop::Failed(failure)), .. }) => return self.fail(composite, failure, led),
                Some(Gave { values: Ok(values), report: said, files: read }) => {
                    report.append(said);
                    files.extend(read);
                    times.push(values);
                }
            }
        }
        if cancelled {
            return self.land(&composite.run, composite.step, Ended::Cancelled, Some(composite.key.hash), led);
        }
        let values = match caught(composite.step(), || self.outputs(composite, &times)) {
            Ok(values) => values,
            Err(failure) => return self.fail(composite, failure, led),
        };
        files.sort();
        files.dedup();
        let files = if files.is_empty() { None } else { Some(files.into()) };
        let duration = composite.begun.elapsed();
        let entry =
            Arc::new(Entry { result: Ok(values.into()), report: self.shared(report.bounded()), duration, files });
        let key = Key { hash: composite.key.hash, files: entry.files.clone() };
        self.memo.insert(key.hash, entry.clone());
        let ended = Ended::of(key, &entry, true);
        self.land(&composite.run, composite.step, ended, Some(composite.key.hash), led);
    }

    /// What the step gives, from what each time gave.
    fn outputs(&self, composite: &Composite<'a>, times: &[Vec<Value>]) -> Result<Vec<Value>, Failure> {
        let (body, kind) = (&composite.body, &composite.step().kind);
        let mistake = || plain("an output is missing; this is a mistake in the engine");
        let mut values = Vec::with_capacity(kind.outputs().len());
        for (place, spec) in kind.outputs().iter().enumerate() {
            let value = match body.repeat() {
                Repeat::Once => times.last().and_then(|values| values.get(place)).cloned().ok_or_else(mistake)?,
                Repeat::FeedBack(pairs) => match times.last() {
                    Some(values) => values.get(place).cloned().ok_or_else(mistake)?,
                    // Nothing was done, so what was to be changed is as it came.
                    None => {
                        let parameter =
                            pairs.iter().find(|(_, output)| **output == spec.name).map(|(parameter, _)| parameter);
                        let unchanged = parameter.and_then(|parameter| composite.input(parameter));
                        let unchanged = unchanged.filter(|value| value.wire() == spec.wire).cloned();
                        unchanged.ok_or_else(|| {
                            let name = &spec.name;
                            at(
                                COUNT,
                                format!(
                                    "nothing is made 0 times: \"{name}\" has no value to begin with; give 1 or more"
                                ),
                            )
                        })?
                    }
                },
                Repeat::Times | Repeat::Each(_) => {
                    let each: Option<Vec<Value>> = times.iter().map(|values| values.get(place).cloned()).collect();
                    let wire = body.graph().and_then(|graph| graph.output_wire(graph.output(&spec.name)?));
                    let collection = wire.and_then(|wire| self.catalogue.collection_of(wire)).ok_or_else(mistake)?;
                    (collection.join)(&each.ok_or_else(mistake)?)
                        .map_err(|reason| plain(format!("output \"{}\" can't be collected: {reason}", spec.name)))?
                }
            };
            values.push(value);
        }
        Ok(values)
    }
}

/// What the run of a body gave.
fn gather(composite: &Composite<'_>, run: &Run<'_>, index: usize) -> Gave {
    let graph = run.place.graph();
    let prefix = if composite.is_repeated() { format!("{index}/") } else { String::new() };
    let mut gave = Gave { values: Ok(Vec::new()), report: Report::default(), files: Vec::new() };
    let mut cancelled = false;
    let mut failures: Vec<(NodeId, Failure)> = Vec::new();
    let mut looked_at = run.plan.order.clone();
    looked_at.sort_unstable();
    for id in looked_at {
        let ended = match run.plan.found.get(&id) {
            Some(Found::Known(key, entry)) => Ended::of(key.clone(), entry, false),
            Some(Found::Scheduled(step)) => run.ended(*step),
            Some(Found::Failed(failure)) => {
                Ended::Failed { key: None, failure: failure.clone(), duration: Duration::ZERO, ran: false }
            }
            Some(Found::Waiting(on)) => Ended::Waiting(on.clone()),
            None => continue,
        };
        match ended {
            Ended::Done { key, report, .. } => {
                gave.files.extend(key.files.iter().flat_map(|files| files.iter().cloned()));
                let name = graph.node(id).map_or("", |node| node.name());
                gave.report.absorb(&format!("{prefix}{name}"), name, &report);
            }
            Ended::Failed { failure, .. } => failures.push((id, failure)),
            Ended::Waiting(_) => {}
            Ended::Cancelled => cancelled = true,
        }
    }
    gave.report = gave.report.bounded();
    if let Some((id, failure)) = failures.first() {
        let more = failures.len() - 1;
        let at = composite.is_repeated().then_some(index);
        gave.values = Err(Stop::Failed(inside(composite, graph, *id, failure, at, more)));
    } else if cancelled {
        gave.values = Err(Stop::Cancelled);
    } else {
        gave.values = values(composite, run, graph).map_err(Stop::Failed);
    }
    gave
}

/// The outputs, in the order of the kind.
fn values(composite: &Composite<'_>, run: &Run<'_>, graph: &Graph) -> Result<Vec<Value>, Failure> {
    let kind = &composite.step().kind;
    let mut values = Vec::with_capacity(kind.outputs().len());
    for spec in kind.outputs() {
        let link = graph.output(&spec.name).and_then(|output| output.link());
        let node = link.and_then(|link| graph.node(link.node));
        let place = link.zip(node).and_then(|(link, node)| Some(node.acting_kind()?.find_output(&link.output)?.0));
        let entry = link.and_then(|link| match run.plan.found.get(&link.node)? {
            Found::Known(_, entry) => entry.result.as_ref().ok().cloned(),
            Found::Scheduled(step) => match run.ended(*step) {
                Ended::Done { values, .. } => values,
                _ => None,
            },
            _ => None,
        });
        let value = entry.zip(place).and_then(|(values, place)| values.get(place).cloned());
        values.push(value.ok_or_else(|| match node {
            Some(node) if node.is_muted() => {
                let (output, name) = (&spec.name, node.name());
                plain(format!(
                    "output \"{output}\" comes from \"{name}\", which is muted and has nothing to pass on there"
                ))
            }
            _ => plain(format!("its output \"{}\" has no value", spec.name)),
        })?);
    }
    Ok(values)
}

/// A failure within, as that of the node whose body it is. It is laid at the input that the failed one got its value from.
fn inside(
    composite: &Composite<'_>,
    graph: &Graph,
    id: NodeId,
    failure: &Failure,
    index: Option<usize>,
    more: usize,
) -> Failure {
    let node = graph.node(id);
    let name = node.map_or("", |node| node.name());
    let port = failure.port.as_ref().and_then(|port| match node?.source(port)? {
        Source::Parameter(parameter) => composite.step().kind.find_input(parameter).map(|spec| spec.name.clone()),
        _ => None,
    });
    let mut message = index.map(|index| format!("at index {index}, ")).unwrap_or_default();
    message.push_str(&format!("inside {name:?}"));
    if let Some(port) = &failure.port {
        message.push_str(&format!(", input {port:?}"));
    }
    let nested = failure.message.starts_with("inside \"") || failure.message.starts_with("at index ");
    message.push_str(if nested { ", " } else { ": " });
    message.push_str(&failure.message);
    if more > 0 {
        message.push_str(&format!("; and {more} more failed inside"));
    }
    Failure { port, message }
}
