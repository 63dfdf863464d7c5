//! A small catalogue of node kinds and a rig to wire and evaluate them by name.

#![allow(dead_code, reason = "each test file uses its part of the kinds")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use maquette_graph::{
    AtPort, Catalogue, Choices, ContentHasher, Evaluation, Evaluator, EvaluatorOptions, EventLog, Graph, Literal,
    NodeId, NodeKind, OutcomeState, Request, Unit, Wire,
};

/// How a result is rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    Down,
    Up,
}

impl Choices for Rounding {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] =
        &[(Self::Down, "down", "Towards minus infinity."), (Self::Up, "up", "Towards plus infinity.")];
}

/// A list of numbers that nothing can be spelled as.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples(pub Vec<f64>);

impl Wire for Samples {
    const NAME: &'static str = "samples";
    const DESCRIPTION: &'static str = "Numbers.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.numbers(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    fn summary(&self) -> String {
        format!("{} samples", self.0.len())
    }
}

/// Counts how many blocks are alive, and how many were at most.
#[derive(Debug, Default)]
pub struct Living {
    pub now: AtomicUsize,
    pub most: AtomicUsize,
}

/// A big value that tells when it is dropped.
pub struct Block {
    tag: f64,
    living: Arc<Living>,
}

impl Block {
    pub const BYTES: usize = 1_000_000;

    pub fn new(tag: f64, living: &Arc<Living>) -> Self {
        let now = 1 + living.now.fetch_add(1, Ordering::SeqCst);
        living.most.fetch_max(now, Ordering::SeqCst);
        Self { tag, living: living.clone() }
    }
}

impl Drop for Block {
    fn drop(&mut self) {
        self.living.now.fetch_sub(1, Ordering::SeqCst);
    }
}

impl Wire for Block {
    const NAME: &'static str = "block";
    const DESCRIPTION: &'static str = "Something big.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.number(self.tag);
    }

    fn byte_size(&self) -> usize {
        Self::BYTES
    }

    fn summary(&self) -> String {
        format!("block {}", self.tag)
    }
}

/// Declares a kind in one expression.
pub fn kind(name: &str, declare: impl FnOnce(&mut NodeKind)) -> NodeKind {
    let mut node = NodeKind::declare(name, 1, "test", "A kind for tests.");
    declare(&mut node);
    node
}

fn add() -> NodeKind {
    kind("add", |node| {
        let a = node.number("a", 0.0, -1e9..=1e9, "One term.");
        let b = node.number("b", 0.0, -1e9..=1e9, "The other term.");
        let sum = node.output::<f64>("sum", "Both together.");
        node.evaluate(move |ports| {
            let total = ports.value(a) + ports.value(b);
            ports.write(sum, total);
            Ok(())
        });
    })
}

fn sign() -> NodeKind {
    kind("sign", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Any number.");
        let positive = node.output::<bool>("positive", "Whether it is above zero.");
        let text = node.output::<String>("text", "The same in words.");
        node.evaluate(move |ports| {
            let is_positive = ports.value(number) > 0.0;
            ports.write(positive, is_positive);
            ports.write(text, if is_positive { "positive" } else { "not positive" }.to_owned());
            Ok(())
        });
    })
}

fn spell() -> NodeKind {
    kind("spell", |node| {
        let flag = node.boolean("flag", false, "What to spell out.");
        let text = node.output::<String>("text", "The words.");
        node.evaluate(move |ports| {
            let words = format!("it is {}", ports.value(flag));
            ports.write(text, words);
            Ok(())
        });
    })
}

fn count() -> NodeKind {
    kind("count", |node| {
        let count = node.integer("count", 1, 0..=100, "A count.");
        let text = node.text("text", "", "What to repeat.");
        let number = node.output::<i64>("count", "The same count.");
        let repeated = node.output::<String>("text", "The text, so often.");
        node.evaluate(move |ports| {
            let times = ports.count(count);
            ports.write(number, ports.value(count));
            let long = ports.read(text).repeat(times);
            ports.write(repeated, long);
            Ok(())
        });
    })
}

fn whole() -> NodeKind {
    kind("whole", |node| {
        let base = node.integer("base", 0, i64::MIN..=i64::MAX, "Any whole number.");
        let out = node.output::<i64>("integer", "The same.");
        node.evaluate(move |ports| {
            ports.write(out, ports.value(base));
            Ok(())
        });
    })
}

fn root() -> NodeKind {
    kind("root", |node| {
        let number = node.number("number", 1.0, -1e9..=1e9, "What to take the root of.");
        let root = node.output::<f64>("root", "Its square root.");
        node.evaluate(move |ports| {
            let value = ports.value(number);
            let positive =
                if value < 0.0 { Err(format!("{value} has no real root: give 0 or more")) } else { Ok(value) };
            let result = positive.at(number)?.sqrt();
            ports.write(root, result);
            Ok(())
        });
    })
}

fn panics() -> NodeKind {
    kind("panics", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Anything.");
        let out = node.output::<f64>("number", "Never.");
        node.evaluate(move |ports| {
            assert!(ports.value(number) > 1.0, "index {} is wrong", ports.value(number));
            ports.write(out, 1.0);
            Ok(())
        });
    })
}

fn forgetful() -> NodeKind {
    kind("forgetful", |node| {
        let first = node.output::<f64>("first", "Written.");
        node.output::<f64>("second", "Forgotten.");
        node.output::<f64>("third", "Forgotten as well.");
        node.evaluate(move |ports| {
            ports.write(first, 1.0);
            Ok(())
        });
    })
}

fn idle() -> NodeKind {
    kind("idle", |node| {
        node.output::<f64>("number", "Never.");
    })
}

fn samples() -> NodeKind {
    kind("samples", |node| {
        let count = node.integer("count", 3, 0..=1_000_000, "How many.");
        let out = node.output::<Samples>("samples", "0, 1, 2, ...");
        node.evaluate(move |ports| {
            let list = (0..u32::try_from(ports.count(count)).unwrap_or(0)).map(f64::from).collect();
            ports.write(out, Samples(list));
            Ok(())
        });
    })
}

fn measure() -> NodeKind {
    kind("measure", |node| {
        let samples = node.input::<Samples>("samples", "What to measure.");
        let offset = node.optional::<f64>("offset", "Added, where connected.");
        let total = node.output::<f64>("total", "The sum.");
        let found = node.figure("samples", Unit::Length, "The sum of the samples.");
        node.evaluate(move |ports| {
            let sum: f64 = ports.read(samples).0.iter().sum();
            let offset = ports.read_optional(offset).copied();
            if offset.is_none() {
                ports.note("no offset");
            }
            ports.figure(found, sum);
            ports.write(total, sum + offset.unwrap_or(0.0));
            Ok(())
        });
    })
}

fn read_file() -> NodeKind {
    kind("read-file", |node| {
        let file = node.file("file", &["txt"], "What to read.");
        let text = node.output::<String>("text", "Its content.");
        node.reads_file(file);
        node.evaluate(move |ports| {
            let bytes = ports.file(file)?;
            ports.write(text, String::from_utf8_lossy(&bytes).into_owned());
            Ok(())
        });
    })
}

/// An input of every type that can be spelled out.
fn everything() -> NodeKind {
    kind("everything", |node| {
        node.is_result();
        let number = node.number("number", 0.5, f64::MIN..=f64::MAX, "A number.");
        node.length("length", 1.0, 0.001..=10.0, "A length.");
        node.integer("integer", 0, i64::MIN..=i64::MAX, "A whole number.");
        node.boolean("boolean", false, "Yes or no.");
        node.text("text", "", "A text.");
        node.choice::<Rounding>("choice", "An option.");
        node.vector("vector", [0.0; 3], Unit::Length, "A vector.");
        node.colour("colour", [1.0; 4], "A colour.");
        node.file("file", &["txt"], "A file.");
        node.strokes("strokes", "Strokes.");
        node.optional::<Samples>("samples", "Samples.");
        let same = node.output::<f64>("number", "The number.");
        let none = node.output::<i64>("integer", "Zero.");
        node.evaluate(move |ports| {
            ports.write(same, ports.value(number));
            ports.write(none, 0);
            Ok(())
        });
    })
}

/// All of the above.
pub fn catalogue() -> Catalogue {
    let mut catalogue = Catalogue::new();
    let kinds = [
        add(),
        sign(),
        spell(),
        count(),
        whole(),
        root(),
        panics(),
        forgetful(),
        idle(),
        samples(),
        measure(),
        read_file(),
        everything(),
    ];
    for kind in kinds {
        catalogue.register(kind).unwrap();
    }
    catalogue
}

/// A graph with its catalogue and evaluator, wired by names.
pub struct Rig {
    pub catalogue: Catalogue,
    pub graph: Graph,
    pub evaluator: Evaluator,
    /// What happened in the last evaluation.
    pub log: Vec<String>,
}

impl Default for Rig {
    fn default() -> Self {
        Self::with_threads(1)
    }
}

impl Rig {
    pub fn with_threads(threads: usize) -> Self {
        Self::with_options(&EvaluatorOptions { threads, ..EvaluatorOptions::default() })
    }

    pub fn with_options(options: &EvaluatorOptions) -> Self {
        Self { catalogue: catalogue(), graph: Graph::new(), evaluator: Evaluator::new(options), log: Vec::new() }
    }

    pub fn register(&mut self, kind: NodeKind) {
        self.catalogue.register(kind).unwrap();
    }

    pub fn id(&self, name: &str) -> NodeId {
        self.graph.find(name).unwrap_or_else(|| panic!("no node \"{name}\""))
    }

    pub fn add(&mut self, kind: &str, name: &str) -> NodeId {
        self.graph.add(&self.catalogue, kind, name).unwrap()
    }

    /// `link("a.sum", "b.a")`
    pub fn link(&mut self, from: &str, to: &str) {
        self.try_link(from, to).unwrap();
    }

    pub fn try_link(&mut self, from: &str, to: &str) -> Result<(), maquette_graph::ConnectError> {
        let (from, output) = from.split_once('.').unwrap();
        let (to, input) = to.split_once('.').unwrap();
        let (from, to) = (self.id(from), self.id(to));
        self.graph.connect(&self.catalogue, from, output, to, input)
    }

    pub fn set(&mut self, input: &str, number: f64) {
        self.put(input, Literal::Number(number));
    }

    pub fn put(&mut self, input: &str, literal: Literal) {
        let (node, input) = input.split_once('.').unwrap();
        self.graph.set(self.id(node), input, literal).unwrap();
    }

    pub fn evaluate(&mut self, targets: &[&str]) -> Evaluation {
        let ids: Vec<_> = targets.iter().map(|name| self.id(name)).collect();
        self.request(Request::nodes(&ids))
    }

    pub fn request(&mut self, request: Request<'_>) -> Evaluation {
        let log = EventLog::default();
        let evaluation = self.evaluator.evaluate(&self.catalogue, &self.graph, &request.events(&log));
        self.log = log.take();
        evaluation
    }

    /// Evaluates and gives the names of the nodes that ran to their end.
    pub fn ran(&mut self, targets: &[&str]) -> Vec<String> {
        self.evaluate(targets);
        self.log.iter().filter_map(|line| line.strip_prefix("finished ").map(str::to_owned)).collect()
    }

    /// A number at an output, such as "a.sum".
    pub fn number(&mut self, output: &str) -> Option<f64> {
        let (node, output) = output.split_once('.').unwrap();
        let evaluation = self.evaluate(&[node]);
        evaluation.value::<f64>(self.id(node), output).copied()
    }

    /// A chain of additions `n0 -> n1 -> ...`, each adding 1.
    pub fn chain(&mut self, length: usize) -> Vec<NodeId> {
        let ids: Vec<_> = (0..length).map(|i| self.add("add", &format!("n{i}"))).collect();
        for (i, id) in ids.iter().enumerate() {
            self.graph.set(*id, "b", Literal::Number(1.0)).unwrap();
            if i > 0 {
                self.graph.connect(&self.catalogue, ids[i - 1], "sum", *id, "a").unwrap();
            }
        }
        ids
    }
}

/// The state of a node, as text without times.
pub fn state(evaluation: &Evaluation, node: NodeId) -> String {
    match evaluation.outcome(node).map(|outcome| &outcome.state) {
        None => "not looked at".to_owned(),
        Some(OutcomeState::Done { values, .. }) => {
            let values = values.as_ref().map(|v| v.iter().map(|v| v.summary()).collect::<Vec<_>>().join(", "));
            values.map_or_else(|| "done".to_owned(), |values| format!("done: {values}"))
        }
        Some(OutcomeState::Failed(failure)) => format!("failed: {failure}"),
        Some(OutcomeState::Waiting(on)) => format!("waiting on {}", on.join(", ")),
        Some(OutcomeState::Cancelled) => "cancelled".to_owned(),
    }
}
