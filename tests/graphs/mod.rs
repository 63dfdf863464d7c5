//! The saved graphs, loaded and evaluated as a program would.

use std::path::Path;

use maquette_graph::{Catalogue, Evaluation, Evaluator, Graph, NodeId, Request, file};

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
    #[allow(dead_code, reason = "not every test that loads graphs asks")]
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
                maquette_graph::OutcomeState::Done { report, .. } => {
                    assert_eq!(report.warnings, Vec::<String>::new(), "{}", outcome.name);
                }
                other => panic!("{}: {other:?}", outcome.name),
            }
        }
        evaluation
    }
}
