//! How far frozen values are apart.

use std::fmt;

use serde::Deserialize;

use super::Frozen;

/// How far two numbers may be apart and still count as equal: the larger of both.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// In the unit of the number, metres for points.
    pub absolute: f64,
    /// As a share of the number's size; for points, of their distance from the origin.
    pub relative: f64,
}

impl Default for Tolerance {
    /// A nanometre, and 1e-9 of the size: far above rounding, far below what anybody sees.
    fn default() -> Self {
        Self { absolute: 1e-9, relative: 1e-9 }
    }
}

impl Tolerance {
    fn allows(&self, apart: f64, size: f64) -> bool {
        apart <= self.absolute.max(self.relative * size)
    }
}

/// A place at which a value is not what it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The output and the place in it, such as `curves[2].points[17]`.
    pub place: String,
    /// What is different, and how far.
    pub what: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.what)
    }
}

/// Collects what differs between what was and what is.
pub(super) fn compare(place: &str, was: &Frozen, is: &Frozen, tolerance: Tolerance, found: &mut Vec<Difference>) {
    use Frozen as F;
    let mut differs = |what: String| found.push(Difference { place: place.to_owned(), what });
    match (was, is) {
        (F::Number(a), F::Number(b)) => {
            if let Some(what) = numbers_differ(*a, *b, tolerance) {
                differs(what);
            }
        }
        (F::Numbers(a), F::Numbers(b)) => {
            worst(place, a, b, found, |a, b| numbers_differ(*a, *b, tolerance).map(|what| ((a - b).abs(), what)));
        }
        (F::Points(a), F::Points(b)) => worst(place, a, b, found, |a, b| points_differ(a, b, tolerance)),
        (F::Integers(a), F::Integers(b)) => {
            worst(place, a, b, found, |a, b| {
                (a != b).then(|| (a.abs_diff(*b) as f64, format!("it was {a} and is {b}")))
            });
        }
        (F::List(a), F::List(b)) if a.len() == b.len() => {
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                compare(&format!("{place}[{index}]"), a, b, tolerance, found);
            }
        }
        (F::List(a), F::List(b)) => differs(format!("there were {} and are {}", a.len(), b.len())),
        (F::Record(a), F::Record(b)) if a.iter().map(|(n, _)| n).eq(b.iter().map(|(n, _)| n)) => {
            for ((name, a), (_, b)) in a.iter().zip(b) {
                compare(&format!("{place}.{name}"), a, b, tolerance, found);
            }
        }
        (F::Text(a), F::Text(b)) if a != b => differs(format!("it was {a:?} and is {b:?}")),
        (a, b) if a == b => {}
        (F::Boolean(a), F::Boolean(b)) => differs(format!("it was {a} and is {b}")),
        (a, b) => differs(format!("it was {} and is {}", described(a), described(b))),
    }
}

fn described(frozen: &Frozen) -> String {
    match frozen {
        Frozen::Record(fields) => {
            let names: Vec<_> = fields.iter().map(|(name, _)| name.as_str()).collect();
            format!("a record of {}", names.join(", "))
        }
        other => other.noun().to_owned(),
    }
}

fn numbers_differ(a: f64, b: f64, tolerance: Tolerance) -> Option<String> {
    let equal = a == b || (a.is_nan() && b.is_nan()) || tolerance.allows((a - b).abs(), a.abs());
    (!equal).then(|| format!("it was {a} and is {b}, {:.3e} apart", (a - b).abs()))
}

fn points_differ(a: &[f64; 3], b: &[f64; 3], tolerance: Tolerance) -> Option<(f64, String)> {
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let apart = length([a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
    (!tolerance.allows(apart, length(*a))).then(|| (apart, format!("it was {a:?} and is {b:?}, {apart:.3e} m apart")))
}

/// One difference for a whole list: the farthest, with the number of the others.
fn worst<T>(
    place: &str,
    was: &[T],
    is: &[T],
    found: &mut Vec<Difference>,
    differ: impl Fn(&T, &T) -> Option<(f64, String)>,
) {
    if was.len() != is.len() {
        let what = format!("there were {} and are {}", was.len(), is.len());
        found.push(Difference { place: place.to_owned(), what });
        return;
    }
    let differing: Vec<_> = was
        .iter()
        .zip(is)
        .enumerate()
        .filter_map(|(index, (a, b))| differ(a, b).map(|(far, what)| (index, far, what)))
        .collect();
    // What is not a number is farther than anything.
    let far = |far: f64| if far.is_nan() { f64::INFINITY } else { far };
    let Some((index, _, what)) = differing.iter().rev().max_by(|a, b| far(a.1).total_cmp(&far(b.1))) else { return };
    let others = differing.len() - 1;
    let others = if others > 0 { format!("; {others} others differ less") } else { String::new() };
    found.push(Difference { place: format!("{place}[{index}]"), what: format!("{what}{others}") });
}
