//! Muted nodes: in place of its work, a node passes on what arrives at its inputs.

use crate::graph::{Node, Source};
use crate::node_kind::{Input, NodeKind, Output};
use crate::value::Wire;

impl NodeKind {
    /// States which input a muted node passes on at this output, where it is not the first one of the output's type.
    pub fn passes<T: Wire>(&mut self, output: Output<T>, input: Input<T>) {
        self.passes.retain(|(passing, _)| *passing != output.index);
        self.passes.push((output.index, input.index));
    }

    /// The input, by its place, that a muted node passes on at an output; `None` where it has none of that type.
    pub fn passed_on(&self, output: usize) -> Option<usize> {
        let declared = self.passes.iter().find(|(passing, _)| *passing == output).map(|(_, input)| *input);
        let wire = self.outputs().get(output)?.wire;
        declared.or_else(|| self.inputs().iter().position(|input| input.wire == wire))
    }

    /// What a muted node of this kind is: it takes only what it passes on, and gives only what it has to pass on.
    pub(crate) fn bypass(kind: &Self) -> Self {
        let passing: Vec<(usize, usize)> =
            (0..kind.outputs().len()).filter_map(|output| Some((output, kind.passed_on(output)?))).collect();
        let mut taken: Vec<usize> = passing.iter().map(|(_, input)| *input).collect();
        taken.sort_unstable();
        taken.dedup();
        let place = |input: usize| taken.iter().position(|place| *place == input).unwrap_or(0);
        let pairs: Vec<(usize, usize)> = passing.iter().enumerate().map(|(at, (_, i))| (place(*i), at)).collect();
        // The name tells apart what passes on in different ways.
        let order: String = pairs.iter().map(|(input, _)| format!(" {input}")).collect();
        let mut bypass = Self::declare(format!("muted{order}"), 1, kind.category(), "Passes its inputs on.");
        bypass.inputs = taken.iter().filter_map(|input| kind.inputs().get(*input).cloned()).collect();
        for input in &mut bypass.inputs {
            // Without a value there is nothing to pass on.
            input.optional = false;
        }
        bypass.outputs = passing.iter().filter_map(|(output, _)| kind.outputs().get(*output).cloned()).collect();
        bypass.evaluate(move |ports| {
            pairs.iter().for_each(|(input, output)| ports.pass(*input, *output));
            Ok(())
        });
        bypass
    }
}

impl Node {
    /// What its inputs hold, as far as it looks at them: all of them, or, while it is muted, those that it passes on.
    pub(crate) fn active_sources(&self) -> impl DoubleEndedIterator<Item = &Source> {
        let passing = self.bypass.as_ref().filter(|_| self.muted);
        let looks_at = move |name: &str| passing.is_none_or(|kind| kind.find_input(name).is_some());
        self.inputs.iter().filter(move |(name, _)| looks_at(name)).map(|(_, source)| source)
    }
}
