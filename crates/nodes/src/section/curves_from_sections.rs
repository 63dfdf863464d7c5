//! **Curves from sections**: the sections as curves, to look at them or to write them.
//! Reference: thesis Figures 6.2c, 6.3f.

use maquette_geometry::curve::Curve;
use maquette_geometry::sections::Sections;
use maquette_graph::{AtPort, Choices, NodeKind};

use crate::wire;

#[derive(Clone, Copy)]
enum Which {
    Sections,
    Rails,
}

impl Choices for Which {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Sections, "sections", "one curve a section, across"),
        (Self::Rails, "rails", "one curve a drawn rail, along, as the surface follows it"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node =
        NodeKind::declare("curves-from-sections", 1, "section", "The sections, or the rails along them, as curves.");
    node.reference("thesis Figures 6.2c and 6.3f");
    let sections = node.input::<wire::Sections>("sections", "The sections.");
    let which = node.choice::<Which>("which", "Which curves.");
    let every = node.integer("every", 1, 1..=65_536, "Take every n-th section only, and always the last.");
    node.soft_range(every, 1.0..=16.0);
    let curves = node.output::<wire::Curves>("curves", "The curves in order. Sections that are a point are left out.");
    node.evaluate(move |ports| {
        let stack = &ports.read(sections).0;
        let made: Box<dyn Iterator<Item = Made>> = match ports.choice(which) {
            Which::Sections => Box::new(across(stack, ports.count(every))),
            Which::Rails => Box::new(along(stack)),
        };
        let mut all = Vec::new();
        for curve in made {
            ports.progress(0.5)?;
            all.push(curve.at(sections)?);
        }
        ports.write(curves, wire::Curves(all));
        Ok(())
    });
    node
}

type Made = Result<Curve, maquette_geometry::curve::CurveError>;

fn across(stack: &Sections, every: usize) -> impl Iterator<Item = Made> {
    let last = stack.len() - 1;
    (0..stack.len())
        .filter(move |index| (index % every.max(1) == 0 || *index == last) && !stack.is_pole(*index))
        .map(|index| Curve::new(format!("section {index}"), stack.section(index).to_vec(), stack.is_closed()))
}

fn along(stack: &Sections) -> impl Iterator<Item = Made> {
    let rail = move |(number, node): (usize, &usize)| {
        Curve::new(format!("rail {number}"), stack.iter().map(|section| section[*node]).collect(), false)
    };
    stack.rails().iter().enumerate().map(rail)
}
