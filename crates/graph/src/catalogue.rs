//! The node kinds, wire types and conversions that a graph may use.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::body::built_in;
use crate::freeze::{Freeze, Freezer};
use crate::list::{Collection, ListType};
use crate::literal::{Choice, Colour, FilePath, Strokes, Vector};
use crate::node_kind::NodeKind;
use crate::port::exact_number;
use crate::value::{Value, Wire, WireType};

pub(crate) type ConvertFn = dyn Fn(&Value) -> Result<Value, String> + Send + Sync;

/// An implicit conversion between two wire types.
#[derive(Clone)]
struct Conversion {
    from: WireType,
    to: WireType,
    convert: Arc<ConvertFn>,
}

/// Node kinds by name, wire types and conversions.
///
/// ```
/// use maquette_graph::{Catalogue, NodeKind};
/// let mut catalogue = Catalogue::new();
/// catalogue.register(NodeKind::declare("nothing", 1, "test", "Does nothing."))?;
/// assert!(catalogue.register(NodeKind::declare("nothing", 1, "test", "Again.")).is_err());
/// # Ok::<(), maquette_graph::CatalogueError>(())
/// ```
#[derive(Clone)]
pub struct Catalogue {
    kinds: BTreeMap<String, Arc<NodeKind>>,
    /// The names of kinds by those that they had before.
    former_names: BTreeMap<String, String>,
    wires: BTreeMap<&'static str, WireType>,
    conversions: Vec<Conversion>,
    pub(crate) lists: Vec<ListType>,
    pub(crate) collections: Vec<Collection>,
    freezers: BTreeMap<&'static str, (WireType, Freezer)>,
}

/// Why a declaration was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CatalogueError {
    /// Two kinds of one name.
    #[error("node kind \"{0}\" is registered twice")]
    DuplicateKind(String),
    /// Two ports of one name.
    #[error("node kind \"{kind}\" declares two {what} named \"{port}\"")]
    DuplicatePort {
        /// The kind.
        kind: String,
        /// Inputs, outputs, or figures and tables.
        what: &'static str,
        /// The name.
        port: String,
    },
    /// Two wire types of one name.
    #[error("two different wire types are named \"{0}\"")]
    DuplicateWire(String),
    /// A default outside its own range.
    #[error("node kind \"{kind}\", input \"{port}\": the default does not fit: {reason}")]
    BadDefault {
        /// The kind.
        kind: String,
        /// The input.
        port: String,
        /// Why.
        reason: String,
    },
    /// What is stated about former times can't be.
    #[error("node kind \"{kind}\" states something of \"{name}\" in former times: {reason}")]
    BadFormerName {
        /// The kind.
        kind: String,
        /// The name in question.
        name: String,
        /// Why.
        reason: String,
    },
    /// Two conversions for one pair.
    #[error("a conversion from {0} to {1} is declared twice")]
    DuplicateConversion(&'static str, &'static str),
    /// Two lists of, or ways to collect, one type.
    #[error("how values of type {0} are listed or collected is declared twice")]
    DuplicateList(&'static str),
}

impl Default for Catalogue {
    fn default() -> Self {
        Self::new()
    }
}

impl Catalogue {
    /// A catalogue with the built-in wire types and conversions, and no kinds but those that have a body, `graph` and
    /// `repeat`.
    pub fn new() -> Self {
        let kinds = built_in().into_iter().map(|kind| (kind.name().to_owned(), Arc::new(kind))).collect();
        let mut catalogue = Self {
            kinds,
            former_names: BTreeMap::new(),
            wires: BTreeMap::new(),
            conversions: Vec::new(),
            lists: Vec::new(),
            collections: Vec::new(),
            freezers: BTreeMap::new(),
        };
        let built_in = [
            WireType::of::<f64>(),
            WireType::of::<i64>(),
            WireType::of::<bool>(),
            WireType::of::<String>(),
            WireType::of::<Choice>(),
            WireType::of::<Vector>(),
            WireType::of::<Colour>(),
            WireType::of::<FilePath>(),
            WireType::of::<Strokes>(),
        ];
        catalogue.wires.extend(built_in.map(|wire| (wire.name(), wire)));
        catalogue.add_conversion::<i64, f64>(|integer| exact_number(*integer));
        catalogue.freezable::<f64>();
        catalogue.freezable::<i64>();
        catalogue.freezable::<bool>();
        catalogue.freezable::<String>();
        catalogue.freezable::<Choice>();
        catalogue.freezable::<Vector>();
        catalogue.freezable::<Colour>();
        catalogue.freezable::<FilePath>();
        catalogue.freezable::<Strokes>();
        catalogue
    }

    /// Lets golden files hold values of this type ([`crate::freeze`]).
    pub fn freezable<T: Freeze>(&mut self) {
        self.freezers.insert(T::NAME, (WireType::of::<T>(), Freezer::of::<T>()));
    }

    pub(crate) fn freezer(&self, wire: WireType) -> Option<Freezer> {
        self.freezers.get(wire.name()).filter(|(known, _)| *known == wire).map(|(_, freezer)| *freezer)
    }

    /// Whether golden files can hold values of this type.
    pub fn is_freezable(&self, wire: WireType) -> bool {
        self.freezer(wire).is_some()
    }

    /// Adds a node kind, and the wire types of its ports.
    ///
    /// # Errors
    /// A name that is taken, a default that does not fit.
    pub fn register(&mut self, kind: NodeKind) -> Result<(), CatalogueError> {
        let name = kind.name().to_owned();
        if self.kinds.contains_key(&name) || self.former_names.contains_key(&name) {
            return Err(CatalogueError::DuplicateKind(name));
        }
        let taken = |name: &&String| self.kinds.contains_key(*name) || self.former_names.contains_key(*name);
        if let Some(former) = kind.former_kind_names().iter().find(|former| taken(former) || **former == name) {
            return Err(CatalogueError::DuplicateKind(former.clone()));
        }
        if let Some((former, reason)) = kind.bad_former_name() {
            return Err(CatalogueError::BadFormerName { kind: name, name: former, reason });
        }
        let inputs: Vec<_> = kind.inputs().iter().map(|i| &i.name).collect();
        let outputs: Vec<_> = kind.outputs().iter().map(|o| &o.name).collect();
        let measured = kind.figures().iter().map(|f| &f.name).chain(kind.tables().iter().map(|t| &t.name)).collect();
        for (what, ports) in [("inputs", inputs), ("outputs", outputs), ("figures or tables", measured)] {
            if let Some(port) = ports.iter().enumerate().find_map(|(i, p)| ports[..i].contains(p).then_some(*p)) {
                return Err(CatalogueError::DuplicatePort { kind: name, what, port: port.clone() });
            }
        }
        for input in kind.inputs() {
            if let Some(reason) = input.default.as_ref().and_then(|d| input.refuses(d)) {
                return Err(CatalogueError::BadDefault { kind: name, port: input.name.clone(), reason });
            }
        }
        let wires = kind.inputs().iter().map(|i| i.wire).chain(kind.outputs().iter().map(|o| o.wire));
        for wire in wires {
            self.add_wire(wire)?;
        }
        self.former_names.extend(kind.former_kind_names().iter().map(|former| (former.clone(), name.clone())));
        self.kinds.insert(name, Arc::new(kind));
        Ok(())
    }

    pub(crate) fn add_wire(&mut self, wire: WireType) -> Result<(), CatalogueError> {
        if *self.wires.entry(wire.name()).or_insert(wire) == wire {
            Ok(())
        } else {
            Err(CatalogueError::DuplicateWire(wire.name().to_owned()))
        }
    }

    /// The wire type of that name.
    pub fn wire(&self, name: &str) -> Option<WireType> {
        self.wires.get(name).copied()
    }

    fn add_conversion<A: Wire, B: Wire>(
        &mut self,
        convert: impl Fn(&A) -> Result<B, String> + Send + Sync + 'static,
    ) -> bool {
        let (from, to) = (WireType::of::<A>(), WireType::of::<B>());
        if self.find_conversion(from, to).is_some() {
            return false;
        }
        let convert = Arc::new(move |value: &Value| match value.get::<A>() {
            Some(value) => convert(value).map(Value::new),
            None => Err(format!("a {} arrived where a {from} was expected", value.wire())),
        });
        self.conversions.push(Conversion { from, to, convert });
        true
    }

    /// Declares the implicit conversion from `A` to `B`. Only where nothing is lost; a value that would lose
    /// something is refused by the function, with the reason.
    ///
    /// # Errors
    /// The pair has one already.
    pub fn conversion<A: Wire, B: Wire>(
        &mut self,
        convert: impl Fn(&A) -> Result<B, String> + Send + Sync + 'static,
    ) -> Result<(), CatalogueError> {
        if self.add_conversion(convert) { Ok(()) } else { Err(CatalogueError::DuplicateConversion(A::NAME, B::NAME)) }
    }

    pub(crate) fn find_conversion(&self, from: WireType, to: WireType) -> Option<&Arc<ConvertFn>> {
        self.conversions.iter().find(|c| c.from == from && c.to == to).map(|c| &c.convert)
    }

    /// Whether a wire of type `from` may enter an input of type `to`.
    pub fn fits(&self, from: WireType, to: WireType) -> bool {
        from == to || self.find_conversion(from, to).is_some()
    }

    /// The implicit conversions, as pairs of types.
    pub fn conversions(&self) -> impl Iterator<Item = (WireType, WireType)> + '_ {
        self.conversions.iter().map(|c| (c.from, c.to))
    }

    /// The kind of that name.
    pub fn kind(&self, name: &str) -> Option<&Arc<NodeKind>> {
        self.kinds.get(name)
    }

    /// The name that a kind has now which had this one before.
    pub fn kind_now(&self, former: &str) -> Option<&str> {
        self.former_names.get(former).map(String::as_str)
    }

    /// All kinds by name.
    pub fn kinds(&self) -> impl ExactSizeIterator<Item = &Arc<NodeKind>> {
        self.kinds.values()
    }

    /// All wire types by name.
    pub fn wires(&self) -> impl ExactSizeIterator<Item = WireType> + '_ {
        self.wires.values().copied()
    }

    /// The kind whose name is most like a misspelt one.
    pub fn suggest(&self, name: &str) -> Option<&str> {
        closest(name, self.kinds.keys().map(String::as_str))
    }
}

/// Bytes of the longest name that others are compared with.
const LONGEST_COMPARED: usize = 80;

/// The candidate most like a misspelt name, where one is alike enough to be meant.
pub fn closest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    // Names are short; to compare two long texts takes the product of their lengths.
    let comparable = |text: &str| text.len() <= LONGEST_COMPARED;
    candidates
        .filter(|candidate| comparable(name) && comparable(candidate))
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
