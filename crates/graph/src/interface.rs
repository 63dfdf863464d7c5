//! What a graph takes and gives as a whole: its parameters and its outputs.

use crate::catalogue::{Catalogue, closest};
use crate::graph::{Graph, GraphError, Link, NodeId, Source, did_you_mean, valid_name};
use crate::literal::Literal;
use crate::parameter::Parameter;
use crate::value::WireType;

/// What a graph gives where it is the body of a node: one output of one of its nodes, under a name of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct GraphOutput {
    pub(crate) name: String,
    pub(crate) description: String,
    pub(crate) from: OutputSource,
    /// Fields of the file that this version does not know: name and text, kept as they were.
    pub(crate) unknown_fields: Vec<(String, String)>,
}

/// Where an output of a graph comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OutputSource {
    /// An output of a node.
    Link(Link),
    /// Nothing: the node that it came from is gone.
    Nothing,
    /// Text of a file that could not be understood, kept so that saving loses nothing.
    Unread(String),
}

impl GraphOutput {
    /// An output that comes from a node's output.
    pub fn new(name: impl Into<String>, from: NodeId, output: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            description: String::new(),
            from: OutputSource::Link(Link { node: from, output: output.into() }),
            unknown_fields: Vec::new(),
        }
    }

    /// With one line on what comes out.
    #[must_use]
    pub fn describe(mut self, description: impl Into<String>) -> Self {
        self.description = description.into();
        self
    }

    /// Name, unique among the outputs of its graph.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One line on what comes out; may be empty.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Where it comes from.
    pub fn source(&self) -> &OutputSource {
        &self.from
    }

    /// The node's output that it comes from.
    pub fn link(&self) -> Option<&Link> {
        if let OutputSource::Link(link) = &self.from { Some(link) } else { None }
    }
}

/// Why the parameters or outputs of a graph can't be changed so. The graph is as it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InterfaceError {
    /// No parameter of that name.
    #[error("the graph has no parameter \"{name}\"{}", did_you_mean(.suggestion.as_deref()))]
    NoSuchParameter {
        /// The name.
        name: String,
        /// A parameter of a similar name.
        suggestion: Option<String>,
    },
    /// No output of that name.
    #[error("the graph has no output \"{0}\"")]
    NoSuchOutput(String),
    /// The name is taken.
    #[error("{what} named \"{name}\" is already there: choose another name")]
    Duplicate {
        /// A parameter or an output.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// The name can't be written in a file.
    #[error("\"{0}\" can't be its name: use letters, digits, spaces, '-' and '_', at most 200 characters")]
    BadName(String),
    /// Its value or its range does not fit.
    #[error("parameter \"{name}\": {reason}")]
    BadParameter {
        /// The parameter.
        name: String,
        /// Why.
        reason: String,
    },
    /// The types differ and no conversion is lossless.
    #[error(
        "the parameter \"{parameter}\" gives {found}, but \"{to}\" takes {wanted}: no conversion between them keeps \
         everything"
    )]
    WrongType {
        /// The parameter.
        parameter: String,
        /// Its type.
        found: &'static str,
        /// Node and input.
        to: String,
        /// Type of the input.
        wanted: &'static str,
    },
    /// A node or its port is not there.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// The node that an output is to come from has no such output.
    #[error("node \"{node}\" has no output \"{output}\"")]
    NoSuchSource {
        /// The node.
        node: String,
        /// The output asked for.
        output: String,
    },
}

impl Graph {
    /// The parameters in their order.
    pub fn parameters(&self) -> impl ExactSizeIterator<Item = &Parameter> {
        self.parameters.iter()
    }

    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|parameter| parameter.name() == name)
    }

    /// The parameter whose name is most like a misspelt one.
    pub fn suggest_parameter(&self, name: &str) -> Option<&str> {
        closest(name, self.parameters.iter().map(Parameter::name))
    }

    /// The outputs in their order.
    pub fn outputs(&self) -> impl ExactSizeIterator<Item = &GraphOutput> {
        self.outputs.iter()
    }

    /// The output of that name.
    pub fn output(&self, name: &str) -> Option<&GraphOutput> {
        self.outputs.iter().find(|output| output.name == name)
    }

    /// Type of what an output of the graph gives; `None` where it comes from nothing, or from an unknown kind.
    pub fn output_wire(&self, output: &GraphOutput) -> Option<WireType> {
        let link = output.link()?;
        Some(self.node(link.node)?.kind()?.find_output(&link.output)?.1.wire)
    }

    /// The inputs that hold a parameter: node and name of the input, in the order of the graph.
    pub fn uses(&self, parameter: &str) -> Vec<(NodeId, String)> {
        let uses = self.nodes().flat_map(|(id, node)| {
            let inputs = node.sources().filter(|(_, s)| matches!(s, Source::Parameter(name) if name == parameter));
            inputs.map(move |(input, _)| (id, input.to_owned()))
        });
        uses.collect()
    }

    pub(crate) fn parameter_index(&self, name: &str) -> Result<usize, InterfaceError> {
        self.parameters.iter().position(|parameter| parameter.name() == name).ok_or_else(|| {
            let suggestion = self.suggest_parameter(name).map(str::to_owned);
            InterfaceError::NoSuchParameter { name: name.to_owned(), suggestion }
        })
    }

    pub(crate) fn output_index(&self, name: &str) -> Result<usize, InterfaceError> {
        let place = self.outputs.iter().position(|output| output.name == name);
        place.ok_or_else(|| InterfaceError::NoSuchOutput(name.to_owned()))
    }

    /// Says why a parameter can't be added, in place of the one named `instead`.
    pub(crate) fn check_parameter(&self, parameter: &Parameter, instead: Option<&str>) -> Result<(), InterfaceError> {
        let name = parameter.name();
        if !valid_name(name) {
            return Err(InterfaceError::BadName(name.to_owned()));
        }
        if instead != Some(name) && self.parameter(name).is_some() {
            return Err(InterfaceError::Duplicate { what: "a parameter", name: name.to_owned() });
        }
        match parameter.flaw() {
            Some(reason) => Err(InterfaceError::BadParameter { name: name.to_owned(), reason }),
            None => Ok(()),
        }
    }

    /// Says why an output can't be added, in place of the one named `instead`.
    pub(crate) fn check_output(&self, output: &GraphOutput, instead: Option<&str>) -> Result<(), InterfaceError> {
        let name = &output.name;
        if !valid_name(name) {
            return Err(InterfaceError::BadName(name.clone()));
        }
        if instead != Some(name) && self.output(name).is_some() {
            return Err(InterfaceError::Duplicate { what: "an output", name: name.clone() });
        }
        let Some(link) = output.link() else { return Ok(()) };
        let node = self.node(link.node).ok_or(GraphError::NoSuchNode)?;
        match node.kind().map(|kind| kind.find_output(&link.output)) {
            Some(None) => {
                Err(InterfaceError::NoSuchSource { node: node.name().to_owned(), output: link.output.clone() })
            }
            _ => Ok(()),
        }
    }

    /// Declares a parameter behind those that are there.
    ///
    /// # Errors
    /// A name that is taken or can't be written, a value that does not fit.
    pub fn add_parameter(&mut self, parameter: Parameter) -> Result<(), InterfaceError> {
        self.check_parameter(&parameter, None)?;
        self.parameters.push(parameter);
        self.touch_all();
        Ok(())
    }

    /// Declares an output behind those that are there.
    ///
    /// # Errors
    /// A name that is taken or can't be written, a node or output that is not there.
    pub fn add_output(&mut self, output: GraphOutput) -> Result<(), InterfaceError> {
        self.check_output(&output, None)?;
        self.outputs.push(output);
        self.touch_all();
        Ok(())
    }

    /// Puts a value at a parameter. Only nodes that use it are evaluated again.
    ///
    /// # Errors
    /// No such parameter, a value that does not fit.
    pub fn set_parameter(&mut self, name: &str, literal: Literal) -> Result<(), InterfaceError> {
        self.replace_parameter_value(name, Some(literal)).map(drop)
    }

    /// As [`Graph::set_parameter`]; gives the value that was there.
    pub(crate) fn replace_parameter_value(
        &mut self,
        name: &str,
        literal: Option<Literal>,
    ) -> Result<Option<Literal>, InterfaceError> {
        let index = self.parameter_index(name)?;
        let parameter = &self.parameters[index];
        if let Some(reason) = literal.as_ref().and_then(|literal| parameter.spec.refuses(literal)) {
            return Err(InterfaceError::BadParameter { name: name.to_owned(), reason });
        }
        let was = parameter.value().cloned();
        self.parameters[index] = parameter.clone().value_of(literal);
        self.touch_uses(name);
        Ok(was)
    }

    /// Marks all that a parameter drives as changed.
    pub(crate) fn touch_uses(&mut self, parameter: &str) {
        for (node, _) in self.uses(parameter) {
            self.touch(node);
        }
        self.touch_all();
    }

    /// Says why an input can't hold a parameter.
    ///
    /// # Errors
    /// No such parameter, node or input; types that don't fit.
    pub fn check_use(
        &self,
        catalogue: &Catalogue,
        node: NodeId,
        input: &str,
        parameter: &str,
    ) -> Result<(), InterfaceError> {
        let given = self.parameters[self.parameter_index(parameter)?].wire();
        let target = self.node(node).ok_or(GraphError::NoSuchNode)?;
        let Some(kind) = target.kind() else { return Ok(()) };
        let wanted = kind.find_input(input).ok_or_else(|| self.no_such_input(target, kind, input))?.wire;
        if catalogue.fits(given, wanted) {
            return Ok(());
        }
        Err(InterfaceError::WrongType {
            parameter: parameter.to_owned(),
            found: given.name(),
            to: format!("{}.{input}", target.name()),
            wanted: wanted.name(),
        })
    }

    /// Lets a parameter drive an input, in place of whatever was there.
    ///
    /// # Errors
    /// As [`Graph::check_use`]; the graph is then as it was.
    pub fn use_parameter(
        &mut self,
        catalogue: &Catalogue,
        node: NodeId,
        input: &str,
        parameter: &str,
    ) -> Result<(), InterfaceError> {
        self.replace_by_parameter(catalogue, node, input, parameter).map(drop)
    }

    /// As [`Graph::use_parameter`]; gives what was there.
    pub(crate) fn replace_by_parameter(
        &mut self,
        catalogue: &Catalogue,
        node: NodeId,
        input: &str,
        parameter: &str,
    ) -> Result<Option<Source>, InterfaceError> {
        self.check_use(catalogue, node, input, parameter)?;
        Ok(self.put(node, input, Some(Source::Parameter(parameter.to_owned()))))
    }
}
