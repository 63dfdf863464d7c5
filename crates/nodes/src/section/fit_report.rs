//! **Fit report**: how well sections fit the curves they were made from, or others.
//! Reference: thesis 3.10 to 3.13.

use maquette_geometry::trigonometric::{Errors, Tolerances};
use maquette_graph::{AtPort, NodeKind, Unit};

use crate::fitting::{fit_row, fit_table};
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "fit-report",
        1,
        "section",
        "How well sections fit: errors, harmonics and the worst place of each, to look at or to gate a build.",
    );
    node.reference("thesis 3.10-3.13");
    let sections = node.input::<wire::EllipticSections>("sections", "The sections.");
    let curves = node.optional::<wire::Curves>(
        "curves",
        "Curves to measure them against, in the same order, by nearest points both ways; without them, the errors of the \
         fit count, between points of equal angle.",
    );
    let mean = node.number("mean-error", 0.01, 0.0..=1.0, "Mean error allowed, as a share of a section's diagonal.");
    node.soft_range(mean, 0.001..=0.05);
    let maximum =
        node.number("max-error", 0.025, 0.0..=1.0, "Largest error allowed, as a share of a section's diagonal.");
    node.soft_range(maximum, 0.002..=0.1);
    let distance =
        node.length("largest-distance", 0.0, 0.0..=1e3, "Besides, the largest distance allowed; 0 is no limit.");
    node.soft_range(distance, 0.0..=0.02);
    let passed =
        node.output::<wire::EllipticSections>("sections", "The same sections, with the errors that were found.");
    let figure_mean =
        node.figure("mean", Unit::None, "Largest mean error of a section (E_a), a share of its diagonal.");
    let figure_max = node.figure("max", Unit::None, "Largest error of any section (E_m), a share of its diagonal.");
    let figure_distance = node.figure("largest-distance", Unit::Length, "Largest distance of any section.");
    let harmonics = node.figure("harmonics", Unit::None, "Most harmonics of any segment.");
    let met = node.figure("met", Unit::None, "1 where every section is within what is allowed, else 0.");
    let table = fit_table(&mut node);
    node.evaluate(move |ports| {
        let given = &ports.read(sections).0;
        if given.is_empty() {
            return Err("there is no section: fit one").at(sections);
        }
        let measured = match ports.read_optional(curves) {
            None if given.iter().all(|named| named.fit.is_none()) => {
                return Err("none of the sections was fitted to a curve: connect the curves to measure them against")
                    .at(sections);
            }
            None => given.to_vec(),
            Some(curves_given) => {
                let (found, wanted) = (curves_given.0.len(), given.len());
                if found != wanted {
                    let message =
                        format!("{found} curve(s) arrive for {wanted} section(s): give one for each, in order");
                    return Err(message).at(curves);
                }
                let mut measured = Vec::with_capacity(wanted);
                for (k, (named, curve)) in given.iter().zip(&curves_given.0).enumerate() {
                    #[expect(clippy::cast_precision_loss, reason = "counts far below 2^53")]
                    ports.progress(k as f64 / wanted as f64)?;
                    let found = named.section.compare(curve);
                    let fit = wire::SectionFit {
                        mean: found.errors.mean,
                        maximum: found.errors.maximum,
                        diagonal: found.diagonal,
                        met: false,
                        worst: found.worst.point,
                        worst_angle: found.worst.angle,
                        worst_distance: found.worst.distance,
                    };
                    measured.push(wire::NamedSection { fit: Some(fit), ..named.clone() });
                }
                measured
            }
        };
        let tolerances = Tolerances { mean: ports.value(mean), maximum: ports.value(maximum) };
        let limit = Some(ports.value(distance)).filter(|limit| *limit > 0.0).unwrap_or(f64::INFINITY);
        let mut judged = measured;
        for fit in judged.iter_mut().filter_map(|named| named.fit.as_mut()) {
            let errors = Errors { mean: fit.mean, maximum: fit.maximum };
            fit.met = tolerances.met_by(errors) && fit.worst_distance <= limit;
        }
        let fits = || judged.iter().filter_map(|named| named.fit.as_ref());
        let largest = |value: &dyn Fn(&wire::SectionFit) -> f64| fits().map(value).fold(0.0, f64::max);
        ports.figure(figure_mean, largest(&|fit| fit.mean));
        ports.figure(figure_max, largest(&|fit| fit.maximum));
        ports.figure(figure_distance, largest(&|fit| fit.worst_distance));
        let most = judged.iter().map(|named| named.section.harmonics()).max().unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "at most 100")]
        ports.figure(harmonics, most as f64);
        ports.figure(met, if fits().all(|fit| fit.met) { 1.0 } else { 0.0 });
        let missed: Vec<&str> = judged
            .iter()
            .filter(|named| named.fit.as_ref().is_some_and(|fit| !fit.met))
            .map(|n| n.name.as_str())
            .collect();
        if !missed.is_empty() {
            ports.note(format!("not within what is allowed: {}", missed.join(", ")));
        }
        ports.table(table, judged.iter().map(fit_row).collect());
        ports.write(passed, wire::EllipticSections::new(judged));
        Ok(())
    });
    node
}
