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

/// New names of ports by their old ones.
type Renames = Vec<(String, String)>;

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
        let restoring = self.fit_ports(catalogue, id, body, &kind);
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

    /// Puts a body that was checked into a node, and takes out what no longer fits its ports. Gives the edits that bring
    /// that back.
    fn fit_ports(&mut self, catalogue: &Catalogue, id: NodeId, body: Arc<Body>, kind: &Arc<NodeKind>) -> Vec<Edit> {
        let mut restoring = Vec::new();
        let sources: Vec<(String, Source)> = match self.node(id) {
            Some(node) => node.sources().map(|(input, source)| (input.to_owned(), source.clone())).collect(),
            None => Vec::new(),
        };
        for (input, source) in sources {
            let spec = kind.find_input(&input);
            let given = match &source {
                Source::Literal { literal, .. } => {
                    let fits = spec.filter(|spec| spec.refuses(literal).is_none());
                    let kept = fits.map(|spec| Source::literal(spec.normal(literal.clone())));
                    if kept.as_ref() != Some(&source) {
                        self.put(id, &input, kept);
                        restoring.push(Edit::restoring(id, &input, Some(source)));
                    }
                    continue;
                }
                Source::Link(link) => {
                    let from = self.node(link.node).and_then(|node| node.kind());
                    from.and_then(|kind| kind.find_output(&link.output)).map(|(_, output)| output.wire)
                }
                Source::Parameter(name) => self.parameter(name).map(|parameter| parameter.wire()),
                Source::Unread(_) => continue,
            };
            let fits = spec.is_some_and(|spec| given.is_none_or(|given| catalogue.fits(given, spec.wire)));
            if !fits {
                self.put(id, &input, None);
                restoring.push(Edit::restoring(id, &input, Some(source)));
            }
        }
        for outgoing in NodeRecord::outgoing_of(self, id) {
            let given = kind.find_output(&outgoing.output).map(|(_, output)| output.wire);
            let wanted = self.node(outgoing.to).and_then(|node| Some(node.kind()?.find_input(&outgoing.input)?.wire));
            let fits = given.is_some_and(|given| wanted.is_none_or(|wanted| catalogue.fits(given, wanted)));
            if !fits {
                let was = self.put(outgoing.to, &outgoing.input, None);
                restoring.push(Edit::restoring(outgoing.to, &outgoing.input, was));
            }
        }
        for output in &mut self.outputs {
            if let OutputSource::Link(link) = &output.from
                && link.node == id
                && kind.find_output(&link.output).is_none()
            {
                let (name, was) = (output.name.clone(), Box::new(output.clone()));
                output.from = OutputSource::Nothing;
                restoring.push(Edit::ChangeOutput { name, output: was });
            }
        }
        if let Some(node) = self.nodes.get_mut(&id) {
            node.body = Some(body);
            node.set_kind(Some(kind.clone()));
        }
        self.touch(id);
        restoring
    }

    pub(super) fn apply_within(&mut self, catalogue: &Catalogue, id: NodeId, edit: &Edit) -> Result<Edit, EditError> {
        let node = self.node(id).ok_or(GraphError::NoSuchNode)?;
        let name = node.name.clone();
        let (Some(body), Some(_)) = (&node.body, &node.kind) else { return Err(BodyError::NoBody(name).into()) };
        if let BodySource::File(file) = body.source() {
            return Err(BodyError::NotEmbedded { node: name, file: file.clone() }.into());
        }
        let mut graph = body.graph().cloned().unwrap_or_default();
        let inverse = graph
            .apply(catalogue, edit)
            .map_err(|error| EditError::Within { node: name.clone(), error: Box::new(error) })?;
        let (inputs, outputs) = renames(edit);
        let repeat = renamed(body.repeat(), &inputs, &outputs);
        let body = body.with_graph(graph)?.repeated(repeat);
        let kind = body.kind(catalogue, &node.kind_name)?;
        let mut held: BTreeSet<&str> = node.sources().map(|(input, _)| input).collect();
        for (old, new) in &inputs {
            if held.remove(old.as_str()) && !held.insert(new) {
                return Err(EditError::InputTaken { from: old.clone(), to: name, input: new.clone() });
            }
        }
        self.rename_ports(id, &inputs, &outputs);
        let restoring = self.fit_ports(catalogue, id, Arc::new(body), &kind);
        Ok(with_restoring(Edit::Within { node: id, edit: Box::new(inverse) }, restoring))
    }

    /// Lets what is linked to the ports of a node follow their new names.
    fn rename_ports(&mut self, id: NodeId, inputs: &Renames, outputs: &Renames) {
        for (old, new) in inputs {
            if let Some(source) = self.node(id).and_then(|node| node.source(old)).cloned() {
                self.put(id, old, None);
                self.put(id, new, Some(source));
            }
        }
        for (old, new) in outputs {
            for outgoing in NodeRecord::outgoing_of(self, id).into_iter().filter(|link| link.output == *old) {
                let link = Link { node: id, output: new.clone() };
                self.put(outgoing.to, &outgoing.input, Some(Source::Link(link)));
            }
            for output in &mut self.outputs {
                if let OutputSource::Link(link) = &mut output.from
                    && link.node == id
                    && link.output == *old
                {
                    link.output.clone_from(new);
                }
            }
        }
    }
}

/// The parameters and outputs that an edit gives other names.
fn renames(edit: &Edit) -> (Renames, Renames) {
    match edit {
        Edit::ChangeParameter { name, parameter } if name != parameter.name() => {
            (vec![(name.clone(), parameter.name().to_owned())], Vec::new())
        }
        Edit::ChangeOutput { name, output } if name != output.name() => {
            (Vec::new(), vec![(name.clone(), output.name().to_owned())])
        }
        Edit::Several(edits) => {
            edits.iter().map(renames).fold(Default::default(), |mut all: (Renames, Renames), one| {
                all.0.extend(one.0);
                all.1.extend(one.1);
                all
            })
        }
        _ => (Vec::new(), Vec::new()),
    }
}

fn renamed(repeat: &Repeat, parameters: &Renames, outputs: &Renames) -> Repeat {
    let new = |name: &String, renames: &Renames| {
        renames.iter().fold(name.clone(), |name, (old, new)| if name == *old { new.clone() } else { name })
    };
    match repeat {
        Repeat::Each(parameter) => Repeat::Each(new(parameter, parameters)),
        Repeat::FeedBack(pairs) => {
            let pairs = pairs.iter().map(|(parameter, output)| (new(parameter, parameters), new(output, outputs)));
            Repeat::FeedBack(pairs.collect::<BTreeMap<_, _>>())
        }
        other => other.clone(),
    }
}
