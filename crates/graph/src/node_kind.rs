//! How a node is declared: a plain function behind typed ports.

use std::fmt;
use std::marker::PhantomData;
use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::examination::Examination;
use crate::former_names::FormerNames;
use crate::literal::{Choice, Colour, FilePath, Literal, Strokes, Vector};
use crate::port::{InputSpec, OptionSpec, OutputSpec, Range, Unit};
use crate::ports::{NodeError, Ports};
use crate::report::{Column, FigureHandle, FigureSpec, TableHandle, TableSpec};
use crate::value::{ContentHash, Wire, WireType};

/// Handle of an input that always has a value. Reading it as another type does not compile.
pub struct Input<T> {
    pub(crate) index: usize,
    wire: PhantomData<fn() -> T>,
}

/// Handle of an input that may be left unconnected.
pub struct OptionalInput<T> {
    pub(crate) index: usize,
    wire: PhantomData<fn() -> T>,
}

/// Handle of an output.
pub struct Output<T> {
    pub(crate) index: usize,
    wire: PhantomData<fn() -> T>,
}

/// Handle of an input that holds one of the options of `E`.
pub struct ChoiceInput<E> {
    pub(crate) index: usize,
    options: PhantomData<fn() -> E>,
}

macro_rules! copyable_handle {
    ($($handle:ident),*) => {$(
        impl<T> Clone for $handle<T> {
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<T> Copy for $handle<T> {}
    )*};
}
copyable_handle!(Input, OptionalInput, Output, ChoiceInput);

/// Options of a choice as an enum, so that the node's `match` is checked by the compiler.
pub trait Choices: Copy + 'static {
    /// Each option with its name in files and one line on what it does. The first one is the default.
    const OPTIONS: &'static [(Self, &'static str, &'static str)];
}

type EvaluateFn = dyn Fn(&mut Ports<'_>) -> Result<(), NodeError> + Send + Sync;
type ExamineFn = dyn Fn(&mut Examination<'_>) -> Result<(), NodeError> + Send + Sync;

/// A kind of node: its ports and what it does.
#[derive(Clone)]
pub struct NodeKind {
    name: String,
    version: u32,
    category: String,
    description: String,
    reference: String,
    pub(crate) inputs: Vec<InputSpec>,
    pub(crate) outputs: Vec<OutputSpec>,
    is_result: bool,
    evaluate: Option<Arc<EvaluateFn>>,
    examine: Option<Arc<ExamineFn>>,
    pub(crate) figures: Vec<FigureSpec>,
    pub(crate) tables: Vec<TableSpec>,
    /// Indices of the inputs whose files it reads.
    file_inputs: Vec<usize>,
    pub(crate) former: FormerNames,
    /// Which input a muted node passes on at an output, where it is not the first one of that type.
    pub(crate) passes: Vec<(usize, usize)>,
    /// Of a kind with a body: the hash of that body.
    pub(crate) content: Option<ContentHash>,
}

impl fmt::Debug for NodeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "NodeKind({} v{})", self.name, self.version)
    }
}

impl NodeKind {
    /// Begins a declaration.
    ///
    /// `version` goes up when the same inputs give another result, so that remembered results are not mistaken for
    /// new ones. `category` is where palettes show it.
    pub fn declare(
        name: impl Into<String>,
        version: u32,
        category: impl Into<String>,
        description: impl Into<String>,
    ) -> Self {
        Self {
            name: name.into(),
            version,
            category: category.into(),
            description: description.into(),
            reference: String::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            is_result: false,
            evaluate: None,
            examine: None,
            figures: Vec::new(),
            tables: Vec::new(),
            file_inputs: Vec::new(),
            former: FormerNames::default(),
            passes: Vec::new(),
            content: None,
        }
    }

    /// States where the method comes from: a section or equation of a publication.
    pub fn reference(&mut self, reference: impl Into<String>) {
        self.reference = reference.into();
    }

    /// Marks the node as a result of the graph: what `run` evaluates and writes when nothing else is asked for.
    pub fn is_result(&mut self) {
        self.is_result = true;
    }

    fn push_input(&mut self, spec: InputSpec) -> usize {
        let default_value = spec.default.as_ref().map(Literal::to_value);
        self.inputs.push(InputSpec { default_value, ..spec });
        self.inputs.len() - 1
    }

    fn input_spec<T: Wire>(name: &str, description: &str) -> InputSpec {
        InputSpec {
            name: name.to_owned(),
            description: description.to_owned(),
            wire: WireType::of::<T>(),
            default: None,
            default_value: None,
            optional: false,
            unit: Unit::None,
            range: None,
            soft_range: None,
            options: Vec::new(),
            extensions: Vec::new(),
        }
    }

    fn with_default<T: Wire>(&mut self, name: &str, default: Literal, description: &str) -> Input<T> {
        let spec = InputSpec { default: Some(default), ..Self::input_spec::<T>(name, description) };
        Input { index: self.push_input(spec), wire: PhantomData }
    }

    fn ranged(&mut self, name: &str, default: f64, range: RangeInclusive<f64>, unit: Unit, text: &str) -> Input<f64> {
        let input = self.with_default(name, Literal::Number(default), text);
        let spec = &mut self.inputs[input.index];
        spec.unit = unit;
        spec.range = Some(Range { min: *range.start(), max: *range.end() });
        input
    }

    /// Declares an input that must be linked.
    pub fn input<T: Wire>(&mut self, name: &str, description: &str) -> Input<T> {
        Input { index: self.push_input(Self::input_spec::<T>(name, description)), wire: PhantomData }
    }

    /// Declares an input that may be left unconnected.
    pub fn optional<T: Wire>(&mut self, name: &str, description: &str) -> OptionalInput<T> {
        let spec = InputSpec { optional: true, ..Self::input_spec::<T>(name, description) };
        OptionalInput { index: self.push_input(spec), wire: PhantomData }
    }

    /// Declares a plain number with its hard range.
    pub fn number(&mut self, name: &str, default: f64, range: RangeInclusive<f64>, description: &str) -> Input<f64> {
        self.ranged(name, default, range, Unit::None, description)
    }

    /// Declares a length in metres with its hard range.
    pub fn length(&mut self, name: &str, default: f64, range: RangeInclusive<f64>, description: &str) -> Input<f64> {
        self.ranged(name, default, range, Unit::Length, description)
    }

    /// Declares an angle in degrees with its hard range.
    pub fn angle(&mut self, name: &str, default: f64, range: RangeInclusive<f64>, description: &str) -> Input<f64> {
        self.ranged(name, default, range, Unit::Angle, description)
    }

    /// Declares a whole number with its hard range.
    #[expect(clippy::cast_precision_loss, reason = "ranges end far below 2^53")]
    pub fn integer(&mut self, name: &str, default: i64, range: RangeInclusive<i64>, description: &str) -> Input<i64> {
        let input = self.with_default(name, Literal::Integer(default), description);
        self.inputs[input.index].range = Some(Range { min: *range.start() as f64, max: *range.end() as f64 });
        input
    }

    /// Narrows what a slider offers for a number; the hard range stays.
    pub fn soft_range<T>(&mut self, input: Input<T>, range: RangeInclusive<f64>) {
        self.inputs[input.index].soft_range = Some(Range { min: *range.start(), max: *range.end() });
    }

    /// Declares a yes or no.
    pub fn boolean(&mut self, name: &str, default: bool, description: &str) -> Input<bool> {
        self.with_default(name, Literal::Boolean(default), description)
    }

    /// Declares a text.
    pub fn text(&mut self, name: &str, default: &str, description: &str) -> Input<String> {
        self.with_default(name, Literal::Text(default.to_owned()), description)
    }

    /// Declares three numbers.
    pub fn vector(&mut self, name: &str, default: [f64; 3], unit: Unit, description: &str) -> Input<Vector> {
        let input = self.with_default(name, Literal::Vector(default), description);
        self.inputs[input.index].unit = unit;
        input
    }

    /// Declares a colour.
    pub fn colour(&mut self, name: &str, default: [f64; 4], description: &str) -> Input<Colour> {
        self.with_default(name, Literal::Colour(default), description)
    }

    /// Declares sketched strokes, none by default.
    pub fn strokes(&mut self, name: &str, description: &str) -> Input<Strokes> {
        self.with_default(name, Literal::Strokes(Vec::new()), description)
    }

    /// Declares a file to read, with the extensions a dialog offers.
    pub fn file(&mut self, name: &str, extensions: &[&str], description: &str) -> Input<FilePath> {
        let input = self.with_default(name, Literal::File(String::new()), description);
        self.inputs[input.index].extensions = extensions.iter().map(|e| (*e).to_owned()).collect();
        input
    }

    /// Declares a choice; the first option is the default.
    pub fn choice<E: Choices>(&mut self, name: &str, description: &str) -> ChoiceInput<E> {
        let options: Vec<_> = E::OPTIONS
            .iter()
            .map(|(_, name, text)| OptionSpec { name: (*name).to_owned(), description: (*text).to_owned() })
            .collect();
        let default = options.first().map(|o| Literal::Choice(o.name.clone()));
        let spec = InputSpec { default, options, ..Self::input_spec::<Choice>(name, description) };
        ChoiceInput { index: self.push_input(spec), options: PhantomData }
    }

    /// Declares an output.
    pub fn output<T: Wire>(&mut self, name: &str, description: &str) -> Output<T> {
        self.outputs.push(OutputSpec {
            name: name.to_owned(),
            description: description.to_owned(),
            wire: WireType::of::<T>(),
        });
        Output { index: self.outputs.len() - 1, wire: PhantomData }
    }

    /// Declares a number that the node measures and reports with [`Ports::figure`], so that it is documented and can
    /// gate a build. It need not be measured in every run.
    pub fn figure(&mut self, name: &str, unit: Unit, description: &str) -> FigureHandle {
        self.figures.push(FigureSpec { name: name.to_owned(), unit, description: description.to_owned() });
        FigureHandle { index: self.figures.len() - 1 }
    }

    /// Declares a table that the node reports with [`Ports::table`]: names and units of its columns, the first of
    /// which labels the rows.
    pub fn table(&mut self, name: &str, columns: &[(&str, Unit)], description: &str) -> TableHandle {
        let column = |(name, unit): &(&str, Unit)| Column { name: (*name).to_owned(), unit: *unit };
        let columns = columns.iter().map(column).collect();
        self.tables.push(TableSpec { name: name.to_owned(), columns, description: description.to_owned() });
        TableHandle { index: self.tables.len() - 1 }
    }

    /// States how to measure what costs too much for every evaluation. It runs on the outputs, only where
    /// [`crate::Request::examine`] asks for it, and is remembered with them. It must depend on the outputs alone.
    pub fn examine(&mut self, run: impl Fn(&mut Examination<'_>) -> Result<(), NodeError> + Send + Sync + 'static) {
        self.examine = Some(Arc::new(run));
    }

    /// States what the node does. The function must depend on its inputs alone (and on the files that
    /// [`NodeKind::reads_file`] declares), and write every output.
    pub fn evaluate(&mut self, run: impl Fn(&mut Ports<'_>) -> Result<(), NodeError> + Send + Sync + 'static) {
        self.evaluate = Some(Arc::new(run));
    }

    /// States that the node reads the file at this input, with [`Ports::file`]: its result then depends on the
    /// content of the file too, and the node runs again when that changes.
    pub fn reads_file(&mut self, input: Input<FilePath>) {
        if !self.file_inputs.contains(&input.index) {
            self.file_inputs.push(input.index);
        }
    }

    /// Name, as written in files.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Goes up when the same inputs give another result.
    pub fn version(&self) -> u32 {
        self.version
    }

    /// Where palettes show it.
    pub fn category(&self) -> &str {
        &self.category
    }

    /// One line on what it does.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Where the method comes from; may be empty.
    pub fn reference_text(&self) -> &str {
        &self.reference
    }

    /// Whether the node is a result of the graph.
    pub fn gives_result(&self) -> bool {
        self.is_result
    }

    /// The inputs in order.
    pub fn inputs(&self) -> &[InputSpec] {
        &self.inputs
    }

    /// The outputs in order.
    pub fn outputs(&self) -> &[OutputSpec] {
        &self.outputs
    }

    /// The figures it measures, in order.
    pub fn figures(&self) -> &[FigureSpec] {
        &self.figures
    }

    /// The tables it measures, in order.
    pub fn tables(&self) -> &[TableSpec] {
        &self.tables
    }

    /// The input of that name.
    pub fn find_input(&self, name: &str) -> Option<&InputSpec> {
        self.inputs.iter().find(|i| i.name == name)
    }

    /// The output of that name, with its place.
    pub fn find_output(&self, name: &str) -> Option<(usize, &OutputSpec)> {
        self.outputs.iter().enumerate().find(|(_, o)| o.name == name)
    }

    /// Whether its nodes have a body: a graph that they evaluate.
    pub fn has_body(&self) -> bool {
        self.content.is_some()
    }

    pub(crate) fn evaluate_fn(&self) -> Option<&EvaluateFn> {
        self.evaluate.as_deref()
    }

    /// Whether it measures something on request only ([`NodeKind::examine`]).
    pub fn has_examination(&self) -> bool {
        self.examine.is_some()
    }

    pub(crate) fn examine_fn(&self) -> Option<&ExamineFn> {
        self.examine.as_deref()
    }

    /// The same kind doing something else: for watching it run. Never taken for an equal kind.
    pub(crate) fn doing(
        &self,
        run: impl Fn(&Self, &mut Ports<'_>) -> Result<(), NodeError> + Send + Sync + 'static,
    ) -> Self {
        let original = self.clone();
        let evaluate: Arc<EvaluateFn> = Arc::new(move |ports: &mut Ports<'_>| run(&original, ports));
        Self { evaluate: Some(evaluate), version: u32::MAX, ..self.clone() }
    }

    pub(crate) fn file_inputs(&self) -> &[usize] {
        &self.file_inputs
    }
}
