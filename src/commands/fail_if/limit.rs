//! A limit as it is written: `NODE.figure > 0.01`, `max(NODE.table.column) >= 3`, `warnings`.

use std::fmt;

/// When a number fails the run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Limit {
    /// As it was given.
    text: String,
    /// What the rows of a column are made into; each row is judged where there is none.
    pub(super) aggregate: Option<Aggregate>,
    /// `figure`, `NODE.figure`, `table.column` or `NODE.table.column`.
    pub(super) path: String,
    comparison: Comparison,
    bound: f64,
}

/// One number of many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aggregate {
    Max,
    Min,
    Mean,
    Sum,
    Count,
}

const AGGREGATES: [(&str, Aggregate); 5] = [
    ("max", Aggregate::Max),
    ("min", Aggregate::Min),
    ("mean", Aggregate::Mean),
    ("sum", Aggregate::Sum),
    ("count", Aggregate::Count),
];

impl Aggregate {
    /// The number; NaN where it has none, so that no limit is kept.
    #[expect(clippy::cast_precision_loss, reason = "counts of rows")]
    pub(super) fn of(self, numbers: &[f64]) -> f64 {
        let extreme = |of: fn(f64, f64) -> f64| {
            // `max` and `min` pass over what is not a number.
            if numbers.iter().any(|n| n.is_nan()) {
                f64::NAN
            } else {
                numbers.iter().copied().reduce(of).unwrap_or(f64::NAN)
            }
        };
        match self {
            Self::Max => extreme(f64::max),
            Self::Min => extreme(f64::min),
            Self::Mean => numbers.iter().sum::<f64>() / numbers.len() as f64,
            Self::Sum => numbers.iter().sum(),
            Self::Count => numbers.len() as f64,
        }
    }

    pub(super) fn name(self) -> &'static str {
        AGGREGATES.iter().find(|(_, aggregate)| *aggregate == self).map_or("", |(name, _)| name)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    Above,
    AtLeast,
    Below,
    AtMost,
}

/// The longer signs first, because the shorter ones begin them.
const SIGNS: [(&str, Comparison); 4] =
    [(">=", Comparison::AtLeast), ("<=", Comparison::AtMost), (">", Comparison::Above), ("<", Comparison::Below)];

/// What counts as a figure of every node: how many warnings it gave.
pub(super) const WARNINGS: &str = "warnings";

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Limit {
    /// Reads `NODE.figure > NUMBER` and what else may be limited, with `>`, `>=`, `<` or `<=`. Warnings need no number:
    /// any of them fails.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let fail = |reason: &str| {
            format!(
                "--fail-if '{text}': {reason}; write it as 'NODE.figure > 0.01', 'NODE.table.column > 0.01', \
                 'max(table.column) > 0.01' or 'warnings'"
            )
        };
        let sign = SIGNS
            .iter()
            .filter_map(|(sign, comparison)| Some((text.find(sign)?, *sign, *comparison)))
            .min_by_key(|(at, sign, _)| (*at, std::cmp::Reverse(sign.len())));
        let (address, comparison, bound) = match sign {
            Some((at, sign, comparison)) => {
                let bound = text[at + sign.len()..].trim();
                let number: f64 = bound.parse().map_err(|_| fail(&format!("\"{bound}\" is not a number")))?;
                (text[..at].trim(), comparison, number)
            }
            None if text.trim().rsplit('.').next().map(str::trim) == Some(WARNINGS) => {
                (text.trim(), Comparison::Above, 0.0)
            }
            None => return Err(fail("there is no >, >=, < or <=")),
        };
        if bound.is_nan() {
            return Err(fail("NaN can't be a limit"));
        }
        let (aggregate, path) = aggregated(address);
        let pieces: Vec<&str> = path.split('.').map(str::trim).collect();
        if pieces.iter().any(|piece| piece.is_empty()) {
            return Err(fail("the name of a figure is missing"));
        }
        Ok(Self { text: text.to_owned(), aggregate, path: pieces.join("."), comparison, bound })
    }

    /// Whether a number fails the run. What is not a number keeps no limit.
    pub(super) fn fails(&self, value: f64) -> bool {
        value.is_nan()
            || match self.comparison {
                Comparison::Above => value > self.bound,
                Comparison::AtLeast => value >= self.bound,
                Comparison::Below => value < self.bound,
                Comparison::AtMost => value <= self.bound,
            }
    }

    /// Whether this is about a figure, or a column where `name` is `table.column`, of that node.
    pub(super) fn is_about(&self, node: &str, name: &str) -> bool {
        self.path == name
            || self.path.strip_suffix(name).and_then(|rest| rest.strip_suffix('.')).is_some_and(|named| named == node)
    }
}

fn aggregated(address: &str) -> (Option<Aggregate>, &str) {
    let inside = |name: &str| address.strip_prefix(name)?.trim_start().strip_prefix('(')?.strip_suffix(')');
    AGGREGATES
        .iter()
        .find_map(|(name, aggregate)| inside(name).map(|path| (Some(*aggregate), path)))
        .unwrap_or((None, address))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_limit_is_refused() {
        for text in
            ["gap", "gap > wide", "> 3", ".gap > 1", "node. > 1", "gap = 3", "gap > NaN", "", "gap >> 1", "max() > 1"]
        {
            let error = Limit::parse(text).unwrap_err();
            assert!(error.contains("write it as 'NODE.figure > 0.01'"), "{text}: {error}");
        }
    }

    #[test]
    fn aggregates_of_nothing_and_of_nan_keep_no_limit() {
        for (aggregate, of_three, of_none) in [
            (Aggregate::Max, 5.0, f64::NAN),
            (Aggregate::Min, 1.0, f64::NAN),
            (Aggregate::Mean, 3.0, f64::NAN),
            (Aggregate::Sum, 9.0, 0.0),
            (Aggregate::Count, 3.0, 0.0),
        ] {
            assert_eq!(aggregate.of(&[3.0, 1.0, 5.0]), of_three, "{aggregate:?}");
            assert_eq!(aggregate.of(&[]).is_nan(), of_none.is_nan(), "{aggregate:?}");
            assert!(of_none.is_nan() || aggregate.of(&[]) == of_none, "{aggregate:?}");
            if aggregate != Aggregate::Count {
                assert!(aggregate.of(&[1.0, f64::NAN, 2.0]).is_nan() && aggregate.of(&[f64::NAN, 1.0]).is_nan());
            }
        }
    }

    #[test]
    fn a_path_is_about_a_node_of_its_name_or_any() {
        let about = |text: &str, node: &str, name: &str| Limit::parse(text).unwrap().is_about(node, name);
        assert!(about("gap > 1", "left arm", "gap") && about(" left arm . gap>1", "left arm", "gap"));
        assert!(!about("right arm.gap > 1", "left arm", "gap") && !about("gap > 1", "left arm", "largest-gap"));
        assert!(about("fit.error > 1", "arm", "fit.error") && about("arm.fit.error > 1", "arm", "fit.error"));
        assert!(about("max( arm.fit.error ) > 1", "arm", "fit.error") && about("a.b.gap > 1", "a.b", "gap"));
        assert!(about("warnings", "arm", "warnings") && about("arm.warnings", "arm", "warnings"));
    }
}
