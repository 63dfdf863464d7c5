//! Parameters: what a graph as a whole takes, each driving any number of inputs.

use crate::literal::{Literal, LiteralKind};
use crate::port::{InputSpec, OptionSpec, Range, Unit};
use crate::value::{Value, WireType};

/// A value of the whole graph with a name, ranges and a description. Inputs that refer to it hold what it holds; where
/// the graph is the body of a node, it is an input of that node.
///
/// ```
/// use maquette_graph::{Literal, Parameter};
/// let stiffness = Parameter::new("stiffness", Literal::Number(0.8)).range(0.0, 10.0).describe("How stiff the seams are.");
/// assert_eq!((stiffness.name(), stiffness.wire().name()), ("stiffness", "number"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub(crate) spec: InputSpec,
    /// Fields of the file that this version does not know: name and text, kept as they were.
    pub(crate) unknown_fields: Vec<(String, String)>,
}

impl Parameter {
    /// A parameter that holds a value; its type is that of the value.
    pub fn new(name: impl Into<String>, value: Literal) -> Self {
        let wire = value.to_value().wire();
        Self::required(name, wire).value_of(Some(value))
    }

    /// A parameter that holds nothing: who uses the graph must link something, of any type.
    pub fn required(name: impl Into<String>, wire: WireType) -> Self {
        let spec = InputSpec {
            name: name.into(),
            description: String::new(),
            wire,
            default: None,
            default_value: None,
            optional: false,
            unit: Unit::None,
            range: None,
            soft_range: None,
            options: Vec::new(),
            extensions: Vec::new(),
        };
        Self { spec, unknown_fields: Vec::new() }
    }

    /// A parameter that may hold nothing: inputs that refer to it are then at their defaults.
    pub fn optional(name: impl Into<String>, wire: WireType) -> Self {
        let mut parameter = Self::required(name, wire);
        parameter.spec.optional = true;
        parameter
    }

    /// A parameter that declares what an input declares, under another name.
    pub fn of_input(name: impl Into<String>, input: &InputSpec) -> Self {
        Self { spec: InputSpec { name: name.into(), ..input.clone() }, unknown_fields: Vec::new() }
    }

    /// With one line on what it is for.
    #[must_use]
    pub fn describe(mut self, description: impl Into<String>) -> Self {
        self.spec.description = description.into();
        self
    }

    /// With what a number measures.
    #[must_use]
    pub fn unit(mut self, unit: Unit) -> Self {
        self.spec.unit = unit;
        self
    }

    /// With a hard range: values outside are refused. The ranges of the inputs that it drives hold too.
    #[must_use]
    pub fn range(mut self, min: f64, max: f64) -> Self {
        self.spec.range = Some(Range { min, max });
        self
    }

    /// With what a slider offers.
    #[must_use]
    pub fn soft_range(mut self, min: f64, max: f64) -> Self {
        self.spec.soft_range = Some(Range { min, max });
        self
    }

    /// With one more option of a choice.
    #[must_use]
    pub fn option(mut self, name: impl Into<String>, description: impl Into<String>) -> Self {
        self.spec.options.push(OptionSpec { name: name.into(), description: description.into() });
        self
    }

    /// Holding this value, or nothing. A whole number for a parameter of type number becomes a number.
    #[must_use]
    pub(crate) fn value_of(mut self, value: Option<Literal>) -> Self {
        let value = value.map(|literal| self.spec.normal(literal));
        self.spec.default_value = value.as_ref().map(Literal::to_value);
        self.spec.default = value;
        self
    }

    /// Name, unique among the parameters of its graph.
    pub fn name(&self) -> &str {
        &self.spec.name
    }

    /// One line on what it is for; may be empty.
    pub fn description(&self) -> &str {
        &self.spec.description
    }

    /// Type of the wire.
    pub fn wire(&self) -> WireType {
        self.spec.wire
    }

    /// What it holds.
    pub fn value(&self) -> Option<&Literal> {
        self.spec.default.as_ref()
    }

    /// Everything it declares, as an input declares it; its value stands as the default.
    pub fn spec(&self) -> &InputSpec {
        &self.spec
    }

    /// Fields of the file that this version does not know: name and text.
    pub fn unknown_fields(&self) -> impl ExactSizeIterator<Item = (&str, &str)> {
        self.unknown_fields.iter().map(|(name, text)| (name.as_str(), text.as_str()))
    }

    pub(crate) fn hashed(&self) -> Option<&Value> {
        self.spec.default_value.as_ref()
    }

    /// Says what is wrong with it by itself; `None` where it is fine.
    pub(crate) fn flaw(&self) -> Option<String> {
        for (what, range) in [("range", self.spec.range), ("soft_range", self.spec.soft_range)] {
            if let Some(Range { min, max }) = range
                && !(min.is_finite() && max.is_finite() && min <= max)
            {
                return Some(format!(
                    "the {what} {min:?} to {max:?} is not one: give two numbers, the smaller one first"
                ));
            }
        }
        let numeric = matches!(LiteralKind::of_wire(self.spec.wire), Some(LiteralKind::Number | LiteralKind::Integer));
        if !numeric && (self.spec.range.is_some() || self.spec.soft_range.is_some()) {
            return Some(format!("a {} has no range", self.spec.wire));
        }
        self.spec.default.as_ref().and_then(|value| self.spec.refuses(value))
    }
}
