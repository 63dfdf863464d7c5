//! Evaluates nodes of the graph within a node, for those who look into it.

use crate::body::Repeat;
use crate::catalogue::Catalogue;
use crate::evaluate::composite::given_to;
use crate::evaluate::inputs::gather;
use crate::evaluate::place::Place;
use crate::evaluate::{Evaluation, Evaluator, Request};
use crate::graph::{Graph, NodeId, Source};

impl Evaluator {
    /// Evaluates the nodes of `request`, which are those of the graph within nodes: `path` leads there from `graph`, each node
    /// in the graph within the one before. Its parameters hold what they are given there; of a body that is repeated, what they
    /// are given the first time. Identities of the evaluation are those of the inner graph, names of events begin with the
    /// names of the path. What the nodes of the path take is evaluated too, and what was evaluated within them is remembered.
    ///
    /// `None` where the path leads nowhere, through a node that is muted or never runs, or what one takes is not there: it
    /// failed, or was stopped.
    pub fn evaluate_within(
        &mut self,
        catalogue: &Catalogue,
        graph: &Graph,
        path: &[NodeId],
        request: &Request<'_>,
    ) -> Option<Evaluation> {
        let mut place = Place::of_root(graph);
        for (depth, &id) in path.iter().enumerate() {
            let node = place.graph().node(id).filter(|node| !node.is_muted())?;
            let (kind, body) = (node.kind()?.clone(), node.body()?.clone());
            let sources: Vec<NodeId> = node
                .active_sources()
                .filter_map(|source| match source {
                    Source::Link(link) => Some(link.node),
                    _ => None,
                })
                .collect();
            let before = request.of_others(&sources);
            let reached = match depth {
                0 => self.evaluate(catalogue, graph, &before),
                _ => self.evaluate_apart(catalogue, place.clone(), &before),
            };
            if reached.cancelled {
                return None;
            }
            let planner = self.planner(catalogue, &place, request);
            let plan = planner.plan(&sources, |_| None);
            let supplies = planner.supplies(&plan, place.graph().node(id)?, &kind).ok()?;
            // Values of steps are none: what the node takes was evaluated just now.
            let inputs = gather(&kind, &supplies, |_, _| None).ok()?;
            let mut given = given_to(&kind, &inputs);
            if let Repeat::Each(parameter) = body.repeat() {
                let item = body.graph()?.parameter(parameter)?.wire();
                let items = (catalogue.list_of(item)?.split)(given.get(parameter)?).ok()?;
                given.insert(parameter.clone(), items.into_iter().next()?);
            }
            let time = (*body.repeat() != Repeat::Once).then_some(0);
            let inner = body.shared_graph()?.clone();
            place = place.of_body(id, &body, inner, time, given);
        }
        Some(self.evaluate_apart(catalogue, place, request))
    }
}
