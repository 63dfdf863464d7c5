//! **Fit sections**: curves become trigonometric series: generalized ellipses, or composite segments of them.
//! Reference: thesis 3.1, 3.2, appendices E and F.

use maquette_geometry::trigonometric::{
    FitError, FitOptions, Fitted, Harmonics, LocalAngles, Sampling, Split, Start, Tolerances, fit_sections_while,
};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::fitting::{AnglesChoice, ContinuityChoice, SolutionChoice, fit_row, fit_table, joints as joints_of};
use crate::wire;

#[derive(Clone, Copy)]
struct StartChoice(Start);

impl Choices for StartChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Start::Ray), "ray", "on one side of all sections, wherever the curves begin"),
        (Self(Start::FirstPoint), "first-point", "at the first points, where these correspond"),
    ];
}

#[derive(Clone, Copy)]
struct SamplingChoice(Sampling);

impl Choices for SamplingChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Sampling::Even), "even", "points even in arc length, so that dense places don't count more"),
        (Self(Sampling::AsGiven), "as-given", "the points of the curves"),
    ];
}

#[derive(Clone, Copy, PartialEq)]
enum SplitChoice {
    None,
    Corners,
    Automatic,
    Given,
}

impl Choices for SplitChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::None, "none", "one series"),
        (Self::Corners, "corners", "at corners, which stay sharp"),
        (Self::Automatic, "automatic", "only where segment-harmonics don't meet the tolerances, at the worst places"),
        (Self::Given, "given", "at the joints given"),
    ];
}

#[derive(Clone, Copy)]
struct LocalChoice(LocalAngles);

impl Choices for LocalChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(LocalAngles::Auto), "auto", "where the section's angle would be ill-conditioned: short segments"),
        (Self(LocalAngles::Never), "never", "as the thesis has it"),
        (Self(LocalAngles::Always), "always", "in every segment"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "fit-sections",
        1,
        "section",
        "Makes curves trigonometric series: generalized ellipses, or segments of them joined with continuity.",
    );
    node.reference("thesis 3.1 (3.1-3.13) and 3.2 (3.14-3.42), appendices E and F; least squares by QR");
    let curves = node.input::<wire::Curves>("curves", "Curves in the order of the stack: all closed, or all open.");
    let harmonics = node.integer(
        "harmonics",
        0,
        0..=100,
        "Harmonics J of every segment; 0 is the fewest that meet the tolerances.",
    );
    node.soft_range(harmonics, 0.0..=15.0);
    let most = node.integer("most-harmonics", 30, 1..=100, "Most harmonics tried, where harmonics is 0.");
    let mean = node.number("mean-error", 0.01, 1e-12..=1.0, "Mean error allowed, as a share of a section's diagonal.");
    node.soft_range(mean, 0.001..=0.05);
    let maximum =
        node.number("max-error", 0.025, 1e-12..=1.0, "Largest error allowed, as a share of a section's diagonal.");
    node.soft_range(maximum, 0.002..=0.1);
    let distance =
        node.length("largest-distance", 0.0, 0.0..=1e3, "Besides, the largest distance allowed; 0 is no limit.");
    node.soft_range(distance, 0.0..=0.02);
    let angles = node.choice::<AnglesChoice>("angles", "How angles are given to the points of closed curves.");
    let start = node.choice::<StartChoice>("start", "Where arc-length angles begin.");
    let sampling = node.choice::<SamplingChoice>("sampling", "Which points are fitted.");
    let split = node.choice::<SplitChoice>("split", "Where sections are split into segments.");
    let corner = node.angle("corner-angle", 60.0, 1.0..=180.0, "A turn sharper than this is a corner.");
    let segment_harmonics =
        node.integer("segment-harmonics", 8, 1..=100, "Harmonics beyond which an automatic split divides a segment.");
    node.soft_range(segment_harmonics, 2.0..=15.0);
    let joints = node.text(
        "joints",
        "",
        "Angles of given joints in degrees, with commas between them: 45, 180:C0, 300. 0 to 180 on open curves.",
    );
    let continuity = node.choice::<ContinuityChoice>("continuity", "How segments meet where nothing else is said.");
    let solution = node.choice::<SolutionChoice>("solution", "In what order the segments of a section are fitted.");
    let local = node.choice::<LocalChoice>("local-angles", "Whether segments count an angle of their own.");
    let common = node.boolean("common-harmonics", false, "All sections get as many harmonics as the one with most.");
    let fitted = node.output::<wire::EllipticSections>("sections", "The sections; equal angles correspond.");
    let figure_mean =
        node.figure("mean", Unit::None, "Largest mean error of a section (E_a), a share of its diagonal.");
    let figure_max = node.figure("max", Unit::None, "Largest error of any section (E_m), a share of its diagonal.");
    let figure_distance = node.figure("largest-distance", Unit::Length, "Largest distance of any section.");
    let mean_harmonics = node.figure("mean-harmonics", Unit::None, "Mean number of harmonics of a segment.");
    let most_harmonics = node.figure("most-harmonics", Unit::None, "Most harmonics of a segment.");
    let constants = node.figure("constants", Unit::None, "Numbers that determine the sections.");
    let table = fit_table(&mut node);
    node.evaluate(move |ports| {
        let how = ports.choice(continuity).0;
        let split_choice = ports.choice(split);
        let fixed = ports.count(harmonics);
        let options = FitOptions {
            harmonics: match fixed {
                0 => Harmonics::Smallest { most: ports.count(most) },
                fixed => Harmonics::Fixed(fixed),
            },
            tolerances: Tolerances { mean: ports.value(mean), maximum: ports.value(maximum) },
            largest_distance: Some(ports.value(distance)).filter(|distance| *distance > 0.0),
            angles: ports.choice(angles).0,
            start: ports.choice(start).0,
            sampling: ports.choice(sampling).0,
            split: match split_choice {
                SplitChoice::None => Split::None,
                SplitChoice::Corners => Split::Corners { angle: ports.value(corner).to_radians() },
                SplitChoice::Automatic => Split::Automatic {
                    most: ports.count(segment_harmonics),
                    corner_angle: ports.value(corner).to_radians(),
                },
                SplitChoice::Given => match joints_of(ports.read(joints).as_str(), how).at(joints)? {
                    none if none.is_empty() => {
                        return Err("no joint is given: write angles in degrees, such as 45, 180:C0").at(joints);
                    }
                    given => Split::At(given),
                },
            },
            continuity: how,
            solution: ports.choice(solution).0,
            local_angles: ports.choice(local).0,
            common_harmonics: ports.value(common),
            about: None,
        };
        let drawn = &ports.read(curves).0;
        use FitError as E;
        let stack = match fit_sections_while(drawn, &options, &ports.progress_callback()) {
            Err(E::Stopped) => Err(NodeError::Cancelled),
            Err(error @ (E::PolarOpen { .. } | E::NotStarShaped { .. })) => Err(error).at(angles),
            Err(error @ E::TooManyHarmonics { .. }) => Err(error).at(harmonics),
            Err(error @ E::TooFewHarmonics { .. }) => match split_choice {
                _ if fixed > 0 => Err(error).at(harmonics),
                SplitChoice::Automatic if ports.count(segment_harmonics) < ports.count(most) => {
                    Err(error).at(segment_harmonics)
                }
                _ => Err(error).at(most),
            },
            Err(error @ (E::JointOutside { .. } | E::JointsCoincide { .. })) => Err(error).at(joints),
            Err(error @ E::SegmentTooShort { .. }) if split_choice == SplitChoice::Given => Err(error).at(joints),
            Err(error @ E::SegmentTooShort { .. }) => Err(error).at(split),
            Err(error @ E::Contradiction { .. }) => Err(error).at(solution),
            stack => stack.at(curves),
        };
        let stack = stack?;
        ports.note(format!(
            "angles by {}",
            if stack.angles == maquette_geometry::trigonometric::Angles::Polar { "polar angle" } else { "arc length" }
        ));
        if !stack.joints.is_empty() {
            let joint = |joint: &maquette_geometry::trigonometric::Joint| {
                format!("{:.1} ({:?})", joint.angle.to_degrees(), joint.continuity)
            };
            let all: Vec<String> = stack.joints.iter().map(joint).collect();
            ports.note(format!("segments meet at {} degrees", all.join(", ")));
        }
        let reversed: Vec<&str> =
            drawn.iter().zip(&stack.sections).filter(|(_, s)| s.report.reversed).map(|(c, _)| c.name()).collect();
        if !reversed.is_empty() {
            ports.note(format!("reversed to run as the others do: {}", reversed.join(", ")));
        }
        let reports = || stack.sections.iter().map(|fitted| &fitted.report);
        reports().flat_map(|report| &report.warnings).for_each(|warning| ports.warn(warning));
        let largest = |value: &dyn Fn(&Fitted) -> f64| stack.sections.iter().map(value).fold(0.0, f64::max);
        ports.figure(figure_mean, largest(&|fitted| fitted.report.errors.mean));
        ports.figure(figure_max, largest(&|fitted| fitted.report.errors.maximum));
        ports.figure(figure_distance, stack.largest_distance());
        let counts: Vec<usize> = reports().flat_map(|report| report.harmonics.iter().copied()).collect();
        let found = drawn.iter().zip(&stack.sections);
        let sections = wire::EllipticSections::new(
            found.map(|(curve, fitted)| wire::NamedSection::fitted(curve.name(), fitted)).collect(),
        );
        #[expect(clippy::cast_precision_loss, reason = "counts far below 2^53")]
        {
            ports.figure(mean_harmonics, counts.iter().sum::<usize>() as f64 / counts.len() as f64);
            ports.figure(most_harmonics, counts.iter().copied().max().unwrap_or(0) as f64);
            ports.figure(constants, sections.constants() as f64);
        }
        ports.table(table, sections.0.iter().map(fit_row).collect());
        ports.write(fitted, sections);
        Ok(())
    });
    node
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use maquette_geometry::curve::Curve;
    use maquette_graph::Literal;
    use maquette_graph::harness::{Harness, TrialError};
    use std::f64::consts::TAU;

    use crate::wire;

    /// Rounded squares, one above the other; the second one runs the other way.
    fn squares(count: usize, points: usize) -> wire::Curves {
        let square = |k: usize| {
            let at = |i: usize| {
                let angle = TAU * i as f64 / points as f64;
                let radius = (angle.cos().powi(8) + angle.sin().powi(8)).powf(-0.125);
                DVec3::new(radius * angle.cos(), 0.3 * k as f64, -radius * angle.sin())
            };
            Curve::new(format!("square {k}"), (0..points).map(at).collect(), true).unwrap()
        };
        let turned = |(k, curve): (usize, Curve)| if k == 1 { curve.reversed() } else { curve };
        wire::Curves((0..count).map(square).enumerate().map(turned).collect())
    }

    #[test]
    fn fewest_harmonics_and_what_is_said_of_them() {
        let kind = super::kind();
        let trial = Harness::new(&kind).give("curves", squares(3, 200)).run().unwrap();
        let sections = trial.value::<wire::EllipticSections>("sections").unwrap();
        assert_eq!(sections.0[2].name, "square 2");
        let figure = |name: &str| trial.report.figure(name).unwrap().value;
        assert!(figure("mean") <= 0.01 && figure("max") <= 0.025 && figure("max") > figure("mean"));
        assert_eq!(figure("most-harmonics"), figure("mean-harmonics"));
        assert_eq!(figure("constants"), 3.0 * 3.0 * (2.0 * figure("most-harmonics") + 1.0));
        assert_eq!(trial.report.notes, ["angles by polar angle", "reversed to run as the others do: square 1"]);
        assert_eq!(trial.report.table("sections").unwrap().rows.len(), 3);
        assert!(trial.report.warnings.is_empty(), "{:?}", trial.report.warnings);
    }

    #[test]
    fn given_joints_and_a_limit_on_the_distance() {
        let kind = super::kind();
        let run = |joints: &str| {
            let text = |text: &str| Literal::Text(text.to_owned());
            let choice = |name: &str| Literal::Choice(name.to_owned());
            Harness::new(&kind)
                .give("curves", squares(2, 300))
                .set("split", choice("given"))
                .set("joints", text(joints))
                .set("largest-distance", Literal::Number(0.004))
                .run()
        };
        let trial = run("45, 135:C2, 225, 315").unwrap();
        assert_eq!(trial.value::<wire::EllipticSections>("sections").unwrap().0[0].section.segments().len(), 4);
        assert!(trial.report.figure("largest-distance").unwrap().value <= 0.004);
        assert_eq!(trial.report.notes[1], "segments meet at 45.0 (C1), 135.0 (C2), 225.0 (C1), 315.0 (C1) degrees");
        for (joints, said) in [("", "no joint is given"), ("45 135", "is no joint"), ("45, 405", "both at the angle")] {
            let Err(TrialError::Failed(failure)) = run(joints) else { panic!("{joints}") };
            assert!(failure.message.contains(said), "{failure}");
            assert_eq!(failure.port.as_deref(), Some("joints"));
        }
    }
}
