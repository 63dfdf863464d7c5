//! The saved graphs, loaded and evaluated as a program would.
#![allow(dead_code, reason = "no test asks for everything")]

use std::path::Path;

use glam::DVec3;
use maquette_geometry::border::Border;
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::{Mesh, measure};
use maquette_geometry::sections::Sections;
use maquette_graph::{Catalogue, Evaluation, Evaluator, EventLog, Graph, NodeId, OutcomeState, Report, Request, file};
use maquette_nodes::wire;

/// A saved graph with the catalogue it was read with.
pub struct Saved {
    pub catalogue: Catalogue,
    pub graph: Graph,
}

impl Saved {
    /// Loads `graphs/NAME.ron`, which must be without a flaw.
    pub fn load(name: &str) -> Self {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let bytes = std::fs::read(format!("graphs/{name}.ron")).unwrap();
        let read = |path: &Path| std::fs::read(Path::new("graphs").join(path)).map_err(|error| error.to_string());
        let own = format!("{name}.ron");
        let loaded = file::from_bytes_with(&catalogue, &bytes, &file::Includes::new(&own, &read)).unwrap();
        assert_eq!(loaded.problems, [], "{name}");
        assert!(file::to_text(&loaded.graph).as_bytes() == bytes, "{name} is in the stable form");
        Self { catalogue, graph: loaded.graph }
    }

    pub fn node(&self, name: &str) -> NodeId {
        self.graph.find(name).unwrap_or_else(|| panic!("no node \"{name}\""))
    }

    /// Names of the results.
    pub fn results(&self) -> Vec<&str> {
        self.graph.results().iter().map(|id| self.graph.node(*id).unwrap().name()).collect()
    }

    pub fn request(targets: &[NodeId]) -> Request<'static> {
        Request::nodes(targets).base(Path::new("graphs"))
    }

    /// Evaluates these nodes; all must succeed without a warning.
    pub fn evaluate(&self, evaluator: &mut Evaluator, names: &[&str]) -> Evaluation {
        let targets: Vec<_> = names.iter().map(|name| self.node(name)).collect();
        let evaluation = evaluator.evaluate(&self.catalogue, &self.graph, &Self::request(&targets));
        for (_, outcome) in evaluation.outcomes() {
            match &outcome.state {
                OutcomeState::Done { report, .. } => {
                    assert_eq!(report.warnings, Vec::<String>::new(), "{}", outcome.name);
                }
                other => panic!("{}: {other:?}", outcome.name),
            }
        }
        evaluation
    }

    /// Evaluates all results; the names of the nodes that ran, sorted.
    pub fn ran(&self, evaluator: &mut Evaluator) -> Vec<String> {
        let log = EventLog::default();
        let request = Self::request(&self.graph.results()).events(&log);
        assert!(evaluator.evaluate(&self.catalogue, &self.graph, &request).is_complete());
        let mut names = log.take_ran();
        names.sort();
        names
    }

    /// What a node said beside its values.
    pub fn report<'a>(&self, evaluation: &'a Evaluation, node: &str) -> &'a Report {
        match &evaluation.outcome(self.node(node)).unwrap().state {
            OutcomeState::Done { report, .. } => report,
            other => panic!("{node}: {other:?}"),
        }
    }

    pub fn figure(&self, evaluation: &Evaluation, node: &str, name: &str) -> f64 {
        self.report(evaluation, node).figure(name).unwrap_or_else(|| panic!("{node}.{name}")).value
    }

    pub fn mesh<'a>(&self, evaluation: &'a Evaluation, node: &str, output: &str) -> &'a Mesh {
        &evaluation.value::<wire::Mesh>(self.node(node), output).unwrap().0
    }

    pub fn sections<'a>(&self, evaluation: &'a Evaluation, node: &str, output: &str) -> &'a Sections {
        &evaluation.value::<wire::Sections>(self.node(node), output).unwrap().0
    }

    pub fn curves<'a>(&self, evaluation: &'a Evaluation, node: &str, output: &str) -> &'a [Curve] {
        &evaluation.value::<wire::Curves>(self.node(node), output).unwrap().0
    }

    pub fn borders<'a>(&self, evaluation: &'a Evaluation, node: &str, output: &str) -> &'a [Border] {
        &evaluation.value::<wire::Borders>(self.node(node), output).unwrap().0
    }
}

/// Width, height and depth of a mesh, metres.
pub fn extent(mesh: &Mesh) -> DVec3 {
    let (low, high) = measure::bounds(mesh).unwrap();
    high - low
}
