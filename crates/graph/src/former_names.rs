//! What a kind, its ports and its options were called before, and what their defaults were: with it, old files load.

use std::collections::BTreeMap;

use crate::body::BodySource;
use crate::graph::Graph;
use crate::literal::Literal;
use crate::node_kind::{ChoiceInput, Choices, Input, NodeKind, OptionalInput, Output};
use crate::port::{InputSpec, OutputSpec};

/// Everything that was different once.
#[derive(Clone, Debug, Default)]
pub(crate) struct FormerNames {
    kind: Vec<String>,
    /// Former name and index.
    inputs: Vec<(String, usize)>,
    outputs: Vec<(String, usize)>,
    /// Index of the input, former name, name.
    options: Vec<(usize, String, String)>,
    defaults: Vec<FormerDefault>,
}

/// A default that a kind had up to one of its versions.
#[derive(Clone, Debug)]
pub(crate) struct FormerDefault {
    /// Index of the input.
    pub(crate) input: usize,
    /// The last version of the kind that had it.
    pub(crate) until: u32,
    pub(crate) literal: Literal,
}

/// Handle of an input of any sort.
pub trait InputHandle: sealed::Sealed {
    #[doc(hidden)]
    fn index(&self) -> usize;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! input_handle {
    ($($handle:ident),*) => {$(
        impl<T> sealed::Sealed for $handle<T> {}
        impl<T> InputHandle for $handle<T> {
            fn index(&self) -> usize {
                self.index
            }
        }
    )*};
}
input_handle!(Input, OptionalInput, ChoiceInput);

impl NodeKind {
    /// States a name that the kind had before. Files that say it are read, with a note, and saved under the new name.
    pub fn formerly(&mut self, name: impl Into<String>) {
        self.former.kind.push(name.into());
    }

    /// As [`NodeKind::formerly`] for an input.
    pub fn input_formerly(&mut self, input: impl InputHandle, name: impl Into<String>) {
        self.former.inputs.push((name.into(), input.index()));
    }

    /// As [`NodeKind::formerly`] for an output, which links name.
    pub fn output_formerly<T>(&mut self, output: Output<T>, name: impl Into<String>) {
        self.former.outputs.push((name.into(), output.index));
    }

    /// As [`NodeKind::formerly`] for one of the options of a choice.
    pub fn option_formerly<E: Choices>(
        &mut self,
        input: ChoiceInput<E>,
        option: impl Into<String>,
        name: impl Into<String>,
    ) {
        self.former.options.push((input.index, name.into(), option.into()));
    }

    /// States the default that an input had up to a version of the kind. A file holds no defaults, so that one written
    /// then would silently mean another thing now: it is read with the former default at that input, and a note. From
    /// the first such statement on, files say which version of the kind they were written with.
    pub fn default_until(&mut self, version: u32, input: impl InputHandle, literal: Literal) {
        self.former.defaults.push(FormerDefault { input: input.index(), until: version, literal });
    }

    /// The input of that name, or the one that had that name before.
    pub fn current_input(&self, name: &str) -> Option<&InputSpec> {
        let former = || self.former.inputs.iter().find(|(former, _)| former == name);
        self.find_input(name).or_else(|| self.inputs().get(former()?.1))
    }

    /// The output of that name, or the one that had that name before.
    pub fn current_output(&self, name: &str) -> Option<&OutputSpec> {
        let former = || self.former.outputs.iter().find(|(former, _)| former == name);
        self.find_output(name).map(|(_, output)| output).or_else(|| self.outputs().get(former()?.1))
    }

    /// The option of an input that had that name before.
    pub(crate) fn option_now(&self, input: &str, former: &str) -> Option<&str> {
        let index = self.inputs().iter().position(|spec| spec.name == input)?;
        let found = self.former.options.iter().find(|(at, name, _)| *at == index && name == former);
        found.map(|(_, _, option)| option.as_str())
    }

    /// Names that the kind had before.
    pub(crate) fn former_kind_names(&self) -> &[String] {
        &self.former.kind
    }

    /// Defaults that the kind had before, the oldest of each input first.
    pub(crate) fn former_defaults(&self) -> &[FormerDefault] {
        &self.former.defaults
    }

    /// Says what is wrong with what is stated about former times: the name in question and why.
    pub(crate) fn bad_former_name(&self) -> Option<(String, String)> {
        let former = &self.former;
        let taken = |name: &str| Some((name.to_owned(), "something has that name now".to_owned()));
        if let Some((name, _)) = former.inputs.iter().find(|(name, _)| self.find_input(name).is_some()) {
            return taken(name);
        }
        if let Some((name, _)) = former.outputs.iter().find(|(name, _)| self.find_output(name).is_some()) {
            return taken(name);
        }
        for (index, name, option) in &former.options {
            let options = self.inputs().get(*index).map(|spec| spec.options.as_slice()).unwrap_or_default();
            if options.iter().any(|o| o.name == *name) {
                return taken(name);
            }
            if !options.iter().any(|o| o.name == *option) {
                return Some((option.clone(), "there is no such option".to_owned()));
            }
        }
        for FormerDefault { input, until, literal } in &former.defaults {
            let Some(spec) = self.inputs().get(*input) else { continue };
            if let Some(reason) = spec.refuses(literal) {
                return Some((spec.name.clone(), format!("its former default does not fit: {reason}")));
            }
            if *until >= self.version() {
                let version = self.version();
                return Some((
                    spec.name.clone(),
                    format!("a former default ends before version {version} of the kind"),
                ));
            }
        }
        None
    }
}

impl Graph {
    /// The versions of the kinds of its nodes, of those whose defaults were other ones before, and of those that are
    /// unknown.
    pub(crate) fn kind_versions(&self) -> BTreeMap<String, u32> {
        let kinds = self.nodes.values().filter_map(|node| node.kind.as_ref());
        let changed = kinds.filter(|kind| !kind.former_defaults().is_empty());
        let known = changed.map(|kind| (kind.name().to_owned(), kind.version()));
        let mut versions: BTreeMap<String, u32> = self.unknown_kinds.clone().into_iter().chain(known).collect();
        // What is embedded is written into the same file.
        for body in self.nodes.values().filter_map(|node| node.body()) {
            if let (BodySource::Embedded, Some(graph)) = (body.source(), body.graph()) {
                versions.extend(graph.kind_versions());
            }
        }
        versions
    }
}
