//! Decisions in words an artist understands.

use super::AxisSource;
use crate::curve::Curve;
use glam::DVec3;
use std::fmt;

/// One thing that was decided about the curves. Its [`Display`](fmt::Display) is a plain sentence; lengths are metres,
/// angles radians.
#[derive(Clone, Debug, PartialEq)]
pub enum Decision {
    /// Two curves that cross were cut into four rails.
    Cut {
        /// What the two curves are called.
        curves: [String; 2],
        /// Where they meet now.
        at: DVec3,
        /// Distance between them before.
        gap: f64,
    },
    /// The rails run to one point.
    Apex {
        /// The point.
        at: DVec3,
        /// How far the farthest rail end was moved.
        moved: f64,
    },
    /// Nothing but the first open curve says which way rails run.
    RunAsDrawn {
        /// What that curve is called.
        curve: String,
    },
    /// The rails run the other way, as asked for.
    RunReversed,
    /// Rails and closed curves were put the other way around in the end, so that faces look inwards.
    Inwards,
    /// The axis about which rails are ordered.
    Axis {
        /// Unit vector along the rails.
        axis: DVec3,
        /// What it was taken from.
        source: AxisSource,
    },
    /// The seam direction lies along the axis, and another one was used.
    SeamReplaced {
        /// The direction given.
        seam: DVec3,
        /// The direction used.
        used: DVec3,
    },
    /// Which curve is a rail.
    Rail {
        /// Its place, counted from 0.
        rail: usize,
        /// What the curve is called.
        curve: String,
        /// Whether it runs against the direction in which it was drawn.
        flipped: bool,
        /// Its angle from the seam direction, counter-clockwise, 0 to 2 pi.
        angle: f64,
        /// Whether its place was pinned.
        pinned: bool,
    },
    /// How a closed curve was turned.
    Closed {
        /// What the curve is called.
        curve: String,
        /// Whether it was reversed.
        reversed: bool,
        /// How far its first point moved along it, the shorter way.
        moved: f64,
    },
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cut { curves: [first, second], at, gap } => {
                write!(f, "{first} and {second} were cut where they meet, at {}", place(*at))?;
                if *gap > 0.0 { write!(f, ", and joined over a gap of {}", metres(*gap)) } else { Ok(()) }
            }
            Self::Apex { at, moved } => {
                write!(f, "all rails meet at {}", place(*at))?;
                if *moved > 0.0 {
                    write!(f, "; their ends were moved there by up to {}", metres(*moved))
                } else {
                    Ok(())
                }
            }
            Self::RunAsDrawn { curve } => write!(f, "rails run as {curve} was drawn"),
            Self::RunReversed => write!(f, "rails run the other way, as asked for"),
            Self::Inwards => {
                write!(f, "faces look inwards, as asked for: behind rail 0 the rails come in the opposite order")
            }
            Self::Axis { axis, source } => {
                let source = match source {
                    AxisSource::Rails => "from the starts of the rails to their ends",
                    AxisSource::ClosedCurve => "square to the first closed curve, for the rails spread out flat",
                    AxisSource::Plane => "square to the starts of the rails, for these spread out flat",
                };
                write!(f, "the axis points {source}: {}", place(*axis))
            }
            Self::SeamReplaced { seam, used } => {
                write!(f, "the seam direction {} lies along the axis, so {} was used", place(*seam), place(*used))
            }
            Self::Rail { rail, curve, flipped, angle, pinned } => {
                let pinned = if *pinned { ", pinned" } else { "" };
                let flipped = if *flipped { ", flipped" } else { "" };
                let degrees = angle.to_degrees().round() % 360.0;
                write!(f, "rail {rail} is {curve}{pinned}{flipped}, at {degrees} degrees from the seam")
            }
            Self::Closed { curve, reversed, moved } => {
                let reversed = if *reversed { "reversed to run counter-clockwise" } else { "runs counter-clockwise" };
                write!(f, "{curve}: {reversed}, ")?;
                if *moved > 0.0 {
                    write!(f, "start moved {} to rail 0", metres(*moved))
                } else {
                    write!(f, "start already at rail 0")
                }
            }
        }
    }
}

/// What a curve is called in messages: its name, or its number among the open or closed ones.
pub(super) fn label(curve: &Curve, kind: &str, number: usize) -> String {
    match (curve.name(), kind) {
        ("", _) => format!("{kind} curve {number}"),
        (name, "closed") => format!("closed curve \"{name}\""),
        (name, _) => format!("curve \"{name}\""),
    }
}

/// Metres with three significant digits, down to the micrometre.
pub(crate) fn metres(length: f64) -> String {
    let decimals = (2.0 - length.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{length:.decimals$} m")
}

/// Names with commas and an "and".
pub(super) fn listed(names: &[String]) -> String {
    match names {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A point to the millimetre.
pub(crate) fn place(p: DVec3) -> String {
    // Adding zero turns -0.000 into 0.000.
    let rounded = (p * 1000.0).round() / 1000.0 + DVec3::ZERO;
    format!("({:.3}, {:.3}, {:.3})", rounded.x, rounded.y, rounded.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decisions_read_as_sentences() {
        let rail = Decision::Rail {
            rail: 2,
            curve: "curve \"left-side\"".into(),
            flipped: true,
            angle: 93.2_f64.to_radians(),
            pinned: false,
        };
        assert_eq!(rail.to_string(), "rail 2 is curve \"left-side\", flipped, at 93 degrees from the seam");
        let hem = Decision::Closed { curve: "closed curve \"hem\"".into(), reversed: true, moved: 0.3141 };
        assert_eq!(
            hem.to_string(),
            "closed curve \"hem\": reversed to run counter-clockwise, start moved 0.314 m to rail 0"
        );
        let cut = Decision::Cut { curves: ["a".into(), "b".into()], at: DVec3::new(0.0, 1.7, -0.0001), gap: 0.002 };
        assert_eq!(
            cut.to_string(),
            "a and b were cut where they meet, at (0.000, 1.700, 0.000), and joined over a gap of 0.00200 m"
        );
    }

    #[test]
    fn numbers_and_lists_are_short() {
        assert_eq!(
            [metres(0.0), metres(12.345), metres(1234.5), metres(3e-9)],
            ["0.000000 m", "12.3 m", "1234 m", "0.000000 m"]
        );
        let names: Vec<String> = ["a", "b", "c"].map(String::from).into();
        assert_eq!(
            [listed(&names), listed(&names[..2]), listed(&names[..1]), listed(&[])],
            ["a, b and c", "a and b", "a", "none"]
        );
    }
}
