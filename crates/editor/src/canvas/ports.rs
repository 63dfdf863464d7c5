//! The ports of a node as the canvas shows them, for placeholders too.

use std::collections::BTreeSet;

use maquette_graph::{Graph, LiteralKind, Node, NodeId, Source, WireType};

/// A port. Its place in the list is its socket.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Port {
    pub(crate) name: String,
    /// `None` where the kind is unknown.
    pub(crate) wire: Option<WireType>,
    /// Its colour, in light and in dark.
    pub(crate) colours: [egui::Color32; 2],
    pub(crate) description: String,
    /// Whether the input is linked.
    pub(crate) linked: bool,
    /// Whether it can be typed, so that its row may be hidden.
    pub(crate) typed: bool,
    /// Whether nothing comes in although something must.
    pub(crate) missing: bool,
    /// Whether it is one of several that wait for a link, behind the first of its type.
    pub(crate) spare: bool,
}

/// The inputs of a node.
pub(crate) fn inputs(node: &Node) -> Vec<Port> {
    let linked = |name: &str| matches!(node.source(name), Some(Source::Link(_)));
    let Some(kind) = node.kind() else {
        let names = node.sources().map(|(name, _)| name);
        return names
            .map(|name| Port {
                name: name.to_owned(),
                wire: None,
                colours: both_colours(None),
                description: "an input of a kind that this version does not know".to_owned(),
                linked: linked(name),
                typed: !linked(name),
                missing: false,
                spare: false,
            })
            .collect();
    };
    let mut waiting: Vec<WireType> = Vec::new();
    let port = |input: &maquette_graph::InputSpec| {
        let free = input.optional && node.source(&input.name).is_none();
        let spare = free && waiting.contains(&input.wire);
        if free {
            waiting.push(input.wire);
        }
        let held = node.source(&input.name);
        Port {
            name: input.name.clone(),
            wire: Some(input.wire),
            colours: both_colours(Some(input.wire)),
            description: input.description.clone(),
            linked: matches!(held, Some(Source::Link(_))),
            typed: LiteralKind::of_wire(input.wire).is_some(),
            missing: held.is_none() && input.default.is_none() && !input.optional,
            spare,
        }
    };
    kind.inputs().iter().map(port).collect()
}

/// The outputs of a node: those of its kind, or, where that is unknown, those that are linked.
pub(crate) fn outputs(graph: &Graph, id: NodeId, node: &Node) -> Vec<Port> {
    let port = |name: String, wire, description: String| Port {
        name,
        wire,
        colours: both_colours(wire),
        description,
        linked: false,
        typed: false,
        missing: false,
        spare: false,
    };
    match node.kind() {
        Some(kind) => kind
            .outputs()
            .iter()
            .map(|output| port(output.name.clone(), Some(output.wire), output.description.clone()))
            .collect(),
        None => {
            let linked =
                graph.fed_by(id).into_iter().filter_map(|(to, input)| match graph.node(to)?.source(&input)? {
                    Source::Link(link) => Some(link.output.clone()),
                    _ => None,
                });
            let names: BTreeSet<String> = linked.collect();
            let description = "an output of a kind that this version does not know";
            names.into_iter().map(|name| port(name, None, description.to_owned())).collect()
        }
    }
}

/// Whether the row of an input is shown.
pub(crate) fn is_shown(port: &Port, expanded: bool) -> bool {
    expanded || port.linked || (!port.typed && !port.spare)
}

impl Port {
    /// Its colour, by its type.
    pub(crate) fn colour(&self, dark: bool) -> egui::Color32 {
        self.colours[usize::from(dark)]
    }
}

fn both_colours(wire: Option<WireType>) -> [egui::Color32; 2] {
    [false, true].map(|dark| wire_colour(wire, dark))
}

/// Colour of a type on the canvas: of the common ones by hand, of all others by their name, so that a new type has one too.
fn wire_colour(wire: Option<WireType>, dark: bool) -> egui::Color32 {
    let name = wire.map_or("", |wire| wire.name());
    let hue = match name {
        "" => return egui::Color32::GRAY,
        "curves" => 0.58,
        "curve" => 0.53,
        "sections" => 0.42,
        "mesh" => 0.08,
        "mesh-result" => 0.03,
        "curves-result" => 0.66,
        "number" | "integer" => 0.25,
        "vector" => 0.75,
        "colour" => 0.14,
        "strokes" => 0.88,
        other => f32::from(other.bytes().fold(7_u8, |hash, byte| hash.wrapping_mul(31).wrapping_add(byte))) / 256.0,
    };
    let (saturation, value) = if dark { (0.55, 0.92) } else { (0.75, 0.68) };
    egui::ecolor::Hsva::new(hue, saturation, value, 1.0).into()
}
