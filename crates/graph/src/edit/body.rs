//! Edits of the graphs within nodes.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::body::{Body, BodyError, BodySource, Repeat};
use crate::catalogue::Catalogue;
use crate::edit::interface::with_restoring;
use crate::edit::{Edit, EditError, NodeRecord};
use crate::graph::{Graph, GraphError, Link, NodeId, Source};
use crate::interface::OutputSource;
use crate::node_kind::NodeKind;

/// What becomes of the ports of a node when the graph within changes: their new names by their old ones, `None` for those
/// that go.
#[derive(Default)]
struct Ports(BTreeMap<String, Option<String>>);

impl Ports {
    fn of<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        Self(names.map(|name| (name.to_owned(), Some(name.to_owned()))).collect())
    }

    fn follow(&mut self, name: &str, becomes: Option<&str>) {
        for now in self.0.values_mut().filter(|now| now.as_deref() == Some(name)) {
            *now = becomes.map(str::to_owned);
        }
    }

    /// The name of a port after the change; `None` where it is gone. What is no port keeps its name.
    fn after<'a>(&'a self, name: &'a str) -> Option<&'a str> {
        self.0.get(name).map_or(Some(name), Option::as_deref)
    }

    /// The name that a port had before the change.
    fn before<'a>(&'a self, name: &'a str) -> &'a str {
        self.0.iter().find(|(_, now)| now.as_deref() == Some(name)).map_or(name, |(before, _)| before)
    }
}

impl Graph {
    pub(super) fn replace_body(
        &mut self,
        catalogue: &Catalogue,
        id: NodeId,
        body: Arc<Body>,
    ) -> Result<Edit, EditError> {
        let node = self.node(id).ok_or(GraphError::NoSuchNode)?;
        let was = node.body.clone().ok_or_else(|| BodyError::NoBody(node.name.clone()))?;
        let kind = body.kind(catalogue, &node.kind_name)?;
        let was_unusable = node.kind.is_none();
        if was_unusable {
            // The way back is to a placeholder, which only a whole node can be.
            return self.replace_placeholder(catalogue, id, body);
        }
        let restoring = self.fit_ports(catalogue, id, body, &kind, &Ports::default(), &Ports::default());
        Ok(with_restoring(Edit::SetBody { node: id, body: was }, restoring))
    }

    /// Gives a node that could not be used a body; its inverse brings the whole node back.
    fn replace_placeholder(&mut self, catalogue: &Catalogue, id: NodeId, body: Arc<Body>) -> Result<Edit, EditError> {
        let before = self.take(id)?;
        let mut record = NodeRecord::of_taken(id, before);
        let back = Edit::AddNode(Box::new(record.clone()));
        let inputs = std::mem::take(&mut record.inputs);
        let (outgoing, promoted) = (std::mem::take(&mut record.outgoing), std::mem::take(&mut record.promoted));
        record.placeholder = false;
        record.body = Some(body);
        record.unknown_fields.retain(|(field, _)| !matches!(field.as_str(), "body" | "each" | "feed_back"));
        let mut done = match self.apply(catalogue, &Edit::AddNode(Box::new(record))) {
            Ok(inverse) => vec![inverse],
            Err(error) => {
                self.take_back(catalogue, &[back]);
                return Err(error);
            }
        };
        // What fits stays.
        for (input, source) in inputs {
            done.extend(self.apply(catalogue, &Edit::restoring(id, &input, Some(source))).ok());
        }
        for link in outgoing {
            done.extend(self.apply(catalogue, &Edit::connect(id, link.output, link.to, link.input)).ok());
        }
        for (name, output) in promoted {
            let linked = self.output(&name).cloned().map(|found| {
                let from = OutputSource::Link(Link { node: id, output: output.clone() });
                crate::GraphOutput { from, ..found }
            });
            if let Some(output) = linked {
                done.extend(self.apply(catalogue, &Edit::ChangeOutput { name, output: Box::new(output) }).ok());
            }
        }
        done.reverse();
        done.push(back);
        Ok(Edit::Several(done))
    }

    /// Puts a body that was checked into a node. What is linked to its ports follows their new names; what no longer fits is
    /// taken out. Gives the edits that bring that back, once the ports have their old names.
    fn fit_ports(
        &mut self,
        catalogue: &Catalogue,
        id: NodeId,
        body: Arc<Body>,
        kind: &Arc<NodeKind>,
        inputs: &Ports,
        outputs: &Ports,
    ) -> Vec<Edit> {
        let mut restoring = Vec::new();
        let sources: Vec<(String, Source)> = match self.node(id) {
            Some(node) => node.sources().map(|(input, source)| (input.to_owned(), source.clone())).collect(),
            None => Vec::new(),
        };
        // All are taken before any is put, because names may be swapped.
        let renamed: Vec<_> = sources.iter().filter(|(input, _)| inputs.after(input) != Some(input.as_str())).collect();
        for (input, _) in &renamed {
            self.put(id, input, None);
        }
        for (input, source) in &renamed {
            if let Some(new) = inputs.after(input) {
                self.put(id, new, Some(source.clone()));
            }
        }
        for (input, source) in sources {
            let kept = inputs.after(&input).and_then(|new| {
                let kept = self.fitting(catalogue, kind, new, &source)?;
                Some((new, kept))
            });
            match kept {
                Some((_, kept)) if kept == source => {}
                Some((new, kept)) => {
                    self.put(id, new, Some(kept));
                    restoring.push(Edit::restoring(id, &input, Some(source)));
                }
                None => {
                    if let Some(new) = inputs.after(&input) {
                        self.put(id, new, None);
                    }
                    restoring.push(Edit::restoring(id, &input, Some(source)));
                }
            }
        }
        for outgoing in NodeRecord::outgoing_of(self, id) {
            let after = outputs.after(&outgoing.output);
            let given = after.and_then(|after| kind.find_output(after)).map(|(_, output)| output.wire);
            let wanted = self.node(outgoing.to).and_then(|node| Some(node.kind()?.find_input(&outgoing.input)?.wire));
            match after.filter(|_| given.is_some_and(|given| wanted.is_none_or(|wanted| catalogue.fits(given, wanted))))
            {
                Some(after) if after == outgoing.output => {}
                Some(after) => {
                    let link = Link { node: id, output: after.to_owned() };
                    self.put(outgoing.to, &outgoing.input, Some(Source::Link(link)));
                }
                None => {
                    let was = self.put(outgoing.to, &outgoing.input, None);
                    restoring.push(Edit::restoring(outgoing.to, &outgoing.input, was));
                }
            }
        }
        for output in &mut self.outputs {
            let was = output.clone();
            if let OutputSource::Link(link) = &mut output.from
                && link.node == id
            {
                match outputs.after(&link.output).filter(|after| kind.find_output(after).is_some()) {
                    Some(after) => link.output = after.to_owned(),
                    None => {
                        output.from = OutputSource::Nothing;
                        restoring.push(Edit::ChangeOutput { name: was.name.clone(), output: Box::new(was) });
                    }
                }
            }
        }
        if let Some(node) = self.nodes.get_mut(&id) {
            node.body = Some(body);
            node.set_kind(Some(kind.clone()));
        }
        self.touch(id);
        restoring
    }

    /// What an input of a kind keeps of what it held; `None` for nothing.
    fn fitting(&self, catalogue: &Catalogue, kind: &NodeKind, input: &str, source: &Source) -> Option<Source> {
        let spec = kind.find_input(input);
        let given = match source {
            Source::Unread(_) => return Some(source.clone()),
            Source::Literal { literal, .. } => {
                let spec = spec.filter(|spec| spec.refuses(literal).is_none())?;
                return Some(Source::literal(spec.normal(literal.clone())));
            }
            Source::Link(link) => {
                let from = self.node(link.node).and_then(|node| node.kind());
                from.and_then(|kind| kind.find_output(&link.output)).map(|(_, output)| output.wire)
            }
            Source::Parameter(name) => self.parameter(name).map(|parameter| parameter.wire()),
        };
        let wanted = spec?.wire;
        given.is_none_or(|given| catalogue.fits(given, wanted)).then(|| source.clone())
    }

    pub(super) fn apply_within(&mut self, catalogue: &Catalogue, id: NodeId, edit: &Edit) -> Result<Edit, EditError> {
        let node = self.node(id).ok_or(GraphError::NoSuchNode)?;
        let name = node.name.clone();
        let Some(body) = &node.body else { return Err(BodyError::NoBody(name).into()) };
        if let BodySource::File(file) = body.source() {
            return Err(BodyError::NotEmbedded { node: name, file: file.clone() }.into());
        }
        if node.kind.is_none() {
            // As it is, it can't be used, and says why.
            body.kind(catalogue, &node.kind_name)?;
            return Err(BodyError::NoBody(name).into());
        }
        let mut graph = body.graph().cloned().unwrap_or_default();
        let mut inputs = Ports::of(graph.parameters().map(|parameter| parameter.name()));
        let mut outputs = Ports::of(graph.outputs().map(|output| output.name()));
        follow(edit, &mut inputs, &mut outputs);
        let inverse = graph
            .apply(catalogue, edit)
            .map_err(|error| EditError::Within { node: name.clone(), error: Box::new(error) })?;
        let repeat = renamed(body.repeat(), &inputs, &outputs);
        let body = body.with_graph(graph)?.repeated(repeat);
        let kind = body.kind(catalogue, &node.kind_name)?;
        let mut held = BTreeSet::new();
        for (input, _) in node.sources() {
            if let Some(new) = inputs.after(input).filter(|new| !held.insert(new.to_owned())) {
                let from = inputs.before(new).to_owned();
                return Err(EditError::InputTaken { from, to: name, input: new.to_owned() });
            }
        }
        let restoring = self.fit_ports(catalogue, id, Arc::new(body), &kind, &inputs, &outputs);
        Ok(with_restoring(Edit::Within { node: id, edit: Box::new(inverse) }, restoring))
    }
}

/// Follows the ports through an edit of the graph within.
fn follow(edit: &Edit, inputs: &mut Ports, outputs: &mut Ports) {
    match edit {
        Edit::ChangeParameter { name, parameter } => inputs.follow(name, Some(parameter.name())),
        Edit::RemoveParameter(name) => inputs.follow(name, None),
        Edit::ChangeOutput { name, output } => outputs.follow(name, Some(output.name())),
        Edit::RemoveOutput(name) => outputs.follow(name, None),
        Edit::Several(edits) => edits.iter().for_each(|edit| follow(edit, inputs, outputs)),
        _ => {}
    }
}

fn renamed(repeat: &Repeat, inputs: &Ports, outputs: &Ports) -> Repeat {
    let parameter = |name: &str| inputs.after(name).unwrap_or(name).to_owned();
    let output = |name: &str| outputs.after(name).unwrap_or(name).to_owned();
    match repeat {
        Repeat::Each(name) => Repeat::Each(parameter(name)),
        Repeat::FeedBack(pairs) => Repeat::FeedBack(pairs.iter().map(|(p, o)| (parameter(p), output(o))).collect()),
        other => other.clone(),
    }
}
