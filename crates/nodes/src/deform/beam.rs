//! **Beam**: bends a curve as a beam.
//! Reference: thesis 5.5 and 6.5.

use glam::DVec3;
use maquette_geometry::beam::{BeamError, Stiffness};
use maquette_geometry::curve::{ArcLength, closest};
use maquette_geometry::deform::{BeamPin, BeamUnits, BendError, Bending, EndHold, PinGoal, PointLoad, bend};
use maquette_graph::{AtPort, Cell, Choices, NodeKind, Unit, Vector};

use crate::wire;

#[derive(Clone, Copy)]
struct Hold(EndHold);

impl Choices for Hold {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(EndHold::Clamped), "clamped", "place and direction stay"),
        (Self(EndHold::Pinned), "pinned", "the place stays, and the end turns"),
        (Self(EndHold::Free), "free", "nothing stays; with a pin at it, a pinned end"),
    ];
}

#[derive(Clone, Copy)]
enum Units {
    Plain,
    Physical,
}

impl Choices for Units {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Plain, "plain", "the thesis' numbers, over shares of the length from 0 to 1"),
        (Self::Physical, "physical", "k_b is EI in N m^2, k_s a tension in N, loads are N, and N/m where spread"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "beam",
        1,
        "deform",
        "Bends a curve as a beam that is held at points, pulled to places and loaded, and tells what holds it.",
    );
    node.reference("thesis 5.5, 6.5: k_b d'''' - k_s d'' = f");
    let rest = node.input::<wire::Curve>("rest", "The curve without any load, open or closed.");
    let pins = node.text(
        "pins",
        "",
        "Points that are held: share of the length and displacement x y z in metres, with semicolons between: 0.5 0 -0.01 \
         0; 1. Without a displacement the point stays.",
    );
    let arrows = node.optional::<wire::Curves>(
        "arrows",
        "Drawn pins: each begins nearest to the point of the curve that it pulls, and ends where that goes.",
    );
    let start = node.choice::<Hold>("start", "How the first end of an open curve is held.");
    let end = node.choice::<Hold>("end", "How its last end is held.");
    let loads = node.text(
        "loads",
        "",
        "Loads on points: share of the length and force x y z, with semicolons between: 0.5 0 -1 0.",
    );
    let spread = node.vector("spread-load", [0.0; 3], Unit::None, "A load spread evenly over the whole length.");
    let units = node.choice::<Units>("units", "What stiffness and forces are counted in.");
    let k_b = node.number("k_b", 0.5, 1e-9..=1e9, "Bending stiffness.");
    node.soft_range(k_b, 0.01..=10.0);
    let k_s = node.number("k_s", 1.4, 0.0..=1e9, "Stretching stiffness (tension): 0 for a ruler that nothing pulls.");
    node.soft_range(k_s, 0.0..=200.0);
    let intervals = node.integer(
        "intervals",
        200,
        4..=8190,
        "Equal intervals of the curve; pins stand at the points between them, and only these points come out.",
    );
    node.soft_range(intervals, 32.0..=1000.0);
    let curve = node.output::<wire::Curve>("curve", "The bent curve.");
    let even = node.output::<wire::Curve>("rest", "The curve at rest, point for point.");
    let farthest = node.figure("largest-displacement", Unit::Length, "How far the point moves that moves farthest.");
    let place = node.figure("displaced-most", Unit::None, "Share of the length at which that point lies.");
    let table = node.table(
        "supports",
        &[
            ("support", Unit::None),
            ("share", Unit::None),
            ("force-x", Unit::None),
            ("force-y", Unit::None),
            ("force-z", Unit::None),
            ("moment", Unit::None),
        ],
        "What holds the curve: the forces with which pins and held ends push it, and the size of the moment.",
    );
    node.evaluate(move |ports| {
        ports.progress(0.0)?;
        let line = &ports.read(rest).0;
        let mut names = Vec::new();
        let mut held = Vec::new();
        for entry in entries(ports.read(pins).as_str(), "pin", "0.5 0 -0.01 0").at(pins)? {
            names.push(format!("pin {}", held.len()));
            held.push(BeamPin { share: entry.share, goal: PinGoal::By(entry.vector.unwrap_or(DVec3::ZERO)) });
        }
        for arrow in ports.read_optional(arrows).map_or(&[][..], |arrows| &arrows.0) {
            names.push(format!("arrow \"{}\"", arrow.name()));
            let share = closest(line, arrow.start()).fraction;
            held.push(BeamPin { share, goal: PinGoal::To(arrow.end()) });
        }
        let mut weights = Vec::new();
        for entry in entries(ports.read(loads).as_str(), "load", "0.5 0 -1 0").at(loads)? {
            let Some(force) = entry.vector else {
                return Err("a load has no force: write its three numbers behind the share, such as 0.5 0 -1 0")
                    .at(loads);
            };
            weights.push(PointLoad { share: entry.share, force });
        }
        let units = match ports.choice(units) {
            Units::Plain => BeamUnits::Share(Stiffness::new(ports.value(k_b), ports.value(k_s)).at(k_s)?),
            Units::Physical => BeamUnits::Metres { bending: ports.value(k_b), tension: ports.value(k_s) },
        };
        let Vector(even_load) = *ports.read(spread);
        let bending = Bending {
            intervals: ports.count(intervals),
            units,
            ends: [ports.choice(start).0, ports.choice(end).0],
            pins: held,
            loads: weights,
            spread: DVec3::from(even_load),
        };
        let bent = match bend(line, &bending) {
            Err(error @ (BendError::Share { what: "load", .. } | BendError::NotFinite { what: "a load" })) => {
                Err(error).at(loads)
            }
            Err(error @ (BendError::Share { .. } | BendError::SamePlace { .. } | BendError::NotFinite { .. })) => {
                Err(error).at(pins)
            }
            Err(error @ BendError::Beam(BeamError::NoPin)) => Err(error).at(pins),
            Err(error @ BendError::Beam(BeamError::NotHeld | BeamError::Turns)) => Err(error).at(start),
            Err(error @ BendError::Beam(BeamError::TooFewNodes { .. } | BeamError::TooManyNodes { .. })) => {
                Err(error).at(intervals)
            }
            Err(error @ BendError::Stiffness(_)) => Err(error).at(k_s),
            bent => bent.at(rest),
        }?;
        let length = ArcLength::of(&bent.rest).length();
        if matches!(units, BeamUnits::Metres { .. }) && bent.largest_displacement > 0.1 * length {
            ports.warn(format!(
                "a point moves by {:.0} % of the length, and the equation holds for small displacements: see \
                 `beam-reference` for how far a beam bends that keeps its length",
                100.0 * bent.largest_displacement / length
            ));
        }
        let rows = bent.supports.iter().map(|support| -> Vec<Cell> {
            let name = match support.pin {
                Some(pin) => names[pin].clone(),
                None if support.node == 0 => "start".to_owned(),
                None => "end".to_owned(),
            };
            let [x, y, z] = support.force.to_array();
            let moment = support.moment.length();
            vec![name.into(), support.share.into(), x.into(), y.into(), z.into(), moment.into()]
        });
        ports.table(table, rows.collect());
        ports.figure(farthest, bent.largest_displacement);
        #[expect(clippy::cast_precision_loss, reason = "counts of points")]
        ports.figure(place, bent.displaced_most as f64 / bending.intervals as f64);
        for support in &bent.supports {
            let Some(pin) = support.pin else { continue };
            let moved = (support.share - bending.pins[pin].share).abs();
            // On a closed curve 1 is 0.
            if moved > 1e-9 && (1.0 - moved) > 1e-9 {
                ports.note(format!("{} holds the nearest point, at {:.6} of the length", names[pin], support.share));
            }
        }
        ports.write(curve, wire::Curve(bent.curve));
        ports.write(even, wire::Curve(bent.rest));
        Ok(())
    });
    node
}

/// A share of the length, with three numbers or without.
struct Entry {
    share: f64,
    vector: Option<DVec3>,
}

/// Entries such as `0.5 0 -0.01 0; 1`.
fn entries(text: &str, what: &str, example: &str) -> Result<Vec<Entry>, String> {
    let parts = text.split(';').map(str::trim).filter(|entry| !entry.is_empty());
    parts
        .map(|entry| {
            let numbers = entry.split_whitespace().map(|word| word.parse::<f64>().ok().filter(|n| n.is_finite()));
            match numbers.collect::<Option<Vec<_>>>().as_deref() {
                Some([share]) => Ok(Entry { share: *share, vector: None }),
                Some([share, x, y, z]) => Ok(Entry { share: *share, vector: Some(DVec3::new(*x, *y, *z)) }),
                _ => {
                    let shown: String = entry.chars().take(24).collect();
                    Err(format!("{shown:?} is no {what}: write a share of the length and x y z, such as {example}"))
                }
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_geometry::curve::Curve;
    use maquette_graph::Literal;
    use maquette_graph::harness::{Harness, Trial};

    fn line(name: &str, from: DVec3, to: DVec3) -> Curve {
        Curve::new(name, vec![from, to], false).unwrap()
    }

    fn ruler() -> wire::Curve {
        wire::Curve(line("ruler", DVec3::ZERO, DVec3::X * 0.3))
    }

    fn choice(name: &str) -> Literal {
        Literal::Choice(name.to_owned())
    }

    fn supports(trial: &Trial) -> Vec<Vec<Cell>> {
        trial.report.table("supports").unwrap().rows.clone()
    }

    #[test]
    fn written_and_drawn_pins_do_the_same() {
        let kind = kind();
        let run = || Harness::new(&kind).give("rest", ruler()).set("end", choice("free"));
        let written = run().set("pins", Literal::Text("1 0 -0.072 0; 0.5;".to_owned())).run().unwrap();
        let arrow = line("down", DVec3::new(0.3, 0.001, 0.0), DVec3::new(0.3, -0.072, 0.0));
        let drawn = run().give("arrows", wire::Curves(vec![arrow])).set("pins", Literal::Text("0.5".to_owned()));
        let drawn = drawn.run().unwrap();
        let curve = |trial: &Trial| trial.value::<wire::Curve>("curve").unwrap().0.points().to_vec();
        assert_eq!(curve(&written), curve(&drawn));
        assert_eq!(curve(&written)[200], DVec3::new(0.3, -0.072, 0.0));
        let names = |trial: &Trial| supports(trial).iter().map(|row| row[0].clone()).collect::<Vec<_>>();
        assert_eq!(names(&written), ["start", "pin 1", "pin 0"].map(Cell::from));
        assert_eq!(names(&drawn), ["start", "pin 0", "arrow \"down\""].map(Cell::from));
        assert!((written.report.figure("largest-displacement").unwrap().value - 0.072).abs() < 1e-15);
        assert!(written.report.notes.is_empty(), "{:?}", written.report.notes);
    }

    #[test]
    fn in_newtons_and_metres() {
        let kind = kind();
        let trial = Harness::new(&kind)
            .give("rest", ruler())
            .set("end", choice("free"))
            .set("units", choice("physical"))
            .set("k_b", Literal::Number(0.03))
            .set("k_s", Literal::Number(0.0))
            .set("loads", Literal::Text("1 0 -0.2 0".to_owned()))
            .run()
            .unwrap();
        // F L^3 / 3 EI is 6 cm, a fifth of the length.
        assert!((trial.report.figure("largest-displacement").unwrap().value - 0.06).abs() < 1e-5);
        assert!(trial.report.warnings[0].contains("20 % of the length"), "{:?}", trial.report.warnings);
        let rows = supports(&trial);
        let number = |cell: &Cell| if let Cell::Number(number) = cell { *number } else { f64::NAN };
        assert_eq!(rows.len(), 1);
        assert!((number(&rows[0][3]) - 0.2).abs() < 1e-8 && (number(&rows[0][5]) - 0.06).abs() < 1e-5, "{rows:?}");
    }

    #[test]
    fn a_pin_between_points_says_where_it_stands() {
        let kind = kind();
        let trial = Harness::new(&kind).give("rest", ruler()).set("pins", Literal::Text("0.333".to_owned())).run();
        assert_eq!(trial.unwrap().report.notes, ["pin 0 holds the nearest point, at 0.335000 of the length"]);
    }
}
