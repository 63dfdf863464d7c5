//! **Join surfaces**: surfaces that share sections become one chain, all their joints solved together.
//! Reference: thesis 4.5 to 4.11.

use maquette_geometry::surface::analytic::{
    AnalyticSurface, ChainOrderError, Side, SurfaceError, SurfaceOptions, chain, chain_order,
};
use maquette_geometry::trigonometric::EllipticSection;
use maquette_graph::{AtPort, NodeError, NodeKind, OptionalInput, Unit};

use crate::surfacing::{BlendChoice, EndChoice, JoinChoice, ParameterChoice, PoleChoice, blend_name};
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "join-surfaces",
        1,
        "surface",
        "Makes surfaces that share sections one chain of parts, solved together so that every joint is smooth.",
    );
    node.reference("thesis 4.5-4.11; the slopes at the joints are those of one C2 spline through all sections");
    let inputs: [OptionalInput<wire::Surface>; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"].map(|name| {
        node.optional(name, "A surface through series, one part or several; the order of the parts is found.")
    });
    let blend = node.choice::<BlendChoice>("blend", "The functions of u between the sections of each part.");
    let parameter = node.choice::<ParameterChoice>("parameter", "How the sections are spaced along u.");
    let continuity = node.choice::<JoinChoice>("continuity", "How the parts meet.");
    let pole = node.choice::<PoleChoice>("pole", "Shape where the first or last section of the chain is a point.");
    let start = node.choice::<EndChoice>("start", "How the chain begins.");
    let end = node.choice::<EndChoice>("end", "How the chain ends.");
    let joined = node.output::<wire::Surface>("surface", "The parts end to end, in the order of the chain.");
    let parts_found = node.figure("parts", Unit::None, "Parts of the chain.");
    let sections_found = node.figure("sections", Unit::None, "Sections of all parts, shared ones counted once.");
    let constants = node.figure("constants", Unit::None, "Numbers that determine the surface.");
    node.evaluate(move |ports| {
        // Each part with the input it comes from.
        let mut parts: Vec<(usize, Vec<EllipticSection>)> = Vec::new();
        for (index, input) in inputs.iter().enumerate() {
            let Some(surface) = ports.read_optional(*input) else { continue };
            for part in surface.series().at(*input)? {
                ports.progress(0.1)?;
                let lost = "a section of it has no finite numbers: make it anew";
                parts.push((index, sections(part).ok_or(lost).at(*input)?));
            }
        }
        if parts.is_empty() {
            return Err("no surface arrives: connect at least one").at(inputs[0]);
        }
        let name = |part: usize| {
            let input = parts[part].0;
            let place = parts[..part].iter().filter(|(other, _)| *other == input).count();
            let several = parts.iter().filter(|(other, _)| *other == input).count() > 1;
            let letter = char::from(b'a' + u8::try_from(input).unwrap_or(0));
            if several { format!("part {place} of \"{letter}\"") } else { format!("\"{letter}\"") }
        };
        let stacks: Vec<Vec<EllipticSection>> = parts.iter().map(|(_, stack)| stack.clone()).collect();
        let order = chain_order(&stacks).or_else(|error| {
            let (message, at) = told(&error, &name);
            Err(message).at(inputs[at.map_or(0, |part| parts[part].0)])
        })?;
        ports.progress(0.3)?;
        let ordered: Vec<Vec<EllipticSection>> = order.iter().map(|part| stacks[*part].clone()).collect();
        let options = SurfaceOptions {
            blend: ports.choice(blend).0,
            parameter: ports.choice(parameter).0,
            pole: ports.choice(pole).0,
            start: ports.choice(start).condition(),
            end: ports.choice(end).condition(),
        };
        let made = chain(&ordered, &options, ports.choice(continuity).0).or_else(|error| match error {
            SurfaceError::Part { part, error } => {
                let at = order[part];
                let message = format!("{}: {error}", name(at));
                match *error {
                    SurfaceError::TooManyForPolynomial { .. } => Err(message).at(blend),
                    _ => Err(message).at(inputs[parts[at].0]),
                }
            }
            SurfaceError::TooManyForPolynomial { .. } => Err(error).at(blend),
            error => Err(NodeError::new(error.to_string())),
        })?;
        ports.progress(0.9)?;
        let names: Vec<String> = order.iter().map(|part| name(*part)).collect();
        ports.note(format!("the chain runs through {}", names.join(", ")));
        for (part, surface) in made.iter().enumerate() {
            ports.note(format!("{}: blended by {}", names[part], blend_name(surface.blend())));
            surface.warnings().iter().for_each(|warning| ports.warn(format!("{}: {warning}", names[part])));
        }
        let shared = made.len() - 1;
        #[expect(clippy::cast_precision_loss, reason = "counts far below 2^53")]
        {
            ports.figure(parts_found, made.len() as f64);
            let all: usize = made.iter().map(|part| part.section_parameters().len()).sum();
            ports.figure(sections_found, (all - shared) as f64);
            ports.figure(constants, made.iter().map(AnalyticSurface::constants).sum::<usize>() as f64);
        }
        ports.write(joined, wire::Surface::Series(made));
        Ok(())
    });
    node
}

/// The sections that a surface goes through.
fn sections(surface: &AnalyticSurface) -> Option<Vec<EllipticSection>> {
    surface.section_parameters().iter().map(|u| surface.section_at(*u)).collect()
}

/// The error with the parts called by their inputs, and a part at fault.
fn told(error: &ChainOrderError, name: &dyn Fn(usize) -> String) -> (String, Option<usize>) {
    use ChainOrderError as E;
    match error {
        E::NoParts | E::Ring => (error.to_string(), None),
        E::TooFewSections { part, .. } => (error.to_string(), Some(*part)),
        E::Opposed { first, second, side } => {
            let how = if *side == Side::Start { "begin" } else { "end" };
            let said = format!(
                "{} and {} both {how} in the same section: run the sections of one of them the other way",
                name(*first),
                name(*second)
            );
            (said, Some(*second))
        }
        E::Forked { part, first, second } => {
            let said = format!(
                "{} and {} both follow {}: a chain goes on in one of them, leave the other out",
                name(*first),
                name(*second),
                name(*part)
            );
            (said, Some(*second))
        }
        E::Apart { first, second } => {
            let said = format!(
                "nothing begins where {} ends, and nothing ends where {} begins: let them share a section, fitted with \
                 the same options",
                name(*first),
                name(*second)
            );
            (said, Some(*second))
        }
    }
}
