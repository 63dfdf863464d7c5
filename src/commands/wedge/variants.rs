//! Which values are put together: all with all, some in step, or a sample.

use std::collections::{BTreeMap, BTreeSet};

use crate::commands::overrides::Place;

use super::values::{SAMPLE_GRAIN, Spread, Value, Vary};

/// More variants than these are probably a mistake.
pub(super) const MANY: usize = 100_000;
/// More than these are not made at all.
const MOST: usize = 10_000_000;
/// Samples that the sequence can give.
const MOST_SAMPLES: u32 = 1 << 16;
/// Addresses that the sequence can give samples for.
const MOST_DIMENSIONS: usize = 256;

/// An address and the values it takes.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub(super) address: String,
    pub(super) place: Place,
    pub(super) values: Vec<Value>,
}

/// How variants are made of values.
#[derive(Clone, Debug, Default)]
pub(super) struct Combining<'a> {
    /// Addresses that vary in step, one list each; `*` alone means all.
    pub(super) zip: &'a [String],
    /// Number of samples in place of all combinations, and the seed.
    pub(super) samples: Option<(u32, u32)>,
    /// Whether more than [`MANY`] variants are meant.
    pub(super) many: bool,
}

/// The variants of a wedge in the order they were asked for: the last address varies fastest.
#[derive(Clone, Debug)]
pub(super) struct Variants {
    pub(super) axes: Vec<Axis>,
    /// The axes that vary in step, all others alone; each group is combined with each other one.
    pub(super) groups: Vec<Vec<usize>>,
    /// Which value of each axis a variant has.
    rows: Vec<Vec<u32>>,
    /// Samples that came out like others and were left out.
    pub(super) repeated: usize,
}

impl Variants {
    /// Puts values together.
    pub(super) fn new(varies: Vec<Vary>, combining: &Combining<'_>) -> Result<Self, Vec<String>> {
        let mut seen = BTreeSet::new();
        if let Some(twice) = varies.iter().find(|vary| !seen.insert(vary.address.as_str())) {
            return Err(vec![format!("error: --vary {} is given twice: put all its values into one", twice.address)]);
        }
        match combining.samples {
            Some((count, seed)) => sampled(varies, count, seed).map_err(|error| vec![error]),
            None => combined(varies, combining),
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Which value of each axis a variant has.
    pub(super) fn choice(&self, variant: usize) -> impl Iterator<Item = usize> {
        self.rows[variant].iter().map(|value| *value as usize)
    }

    /// The value of each axis in a variant.
    pub(super) fn values(&self, variant: usize) -> impl Iterator<Item = (&Axis, &Value)> {
        self.axes.iter().zip(&self.rows[variant]).map(|(axis, value)| (axis, &axis.values[*value as usize]))
    }

    /// A variant in words.
    pub(super) fn describe(&self, variant: usize) -> String {
        let values = self.values(variant).map(|(axis, value)| format!("{}={}", axis.address, value.text));
        values.collect::<Vec<_>>().join(" ")
    }

    /// The order in which least is computed again: what costs most after a change varies slowest. `costs` has one
    /// figure an axis.
    pub(super) fn cheapest_order(&self, costs: &[usize]) -> Vec<usize> {
        let mut slowest_first: Vec<usize> = (0..self.axes.len()).collect();
        slowest_first.sort_by_key(|axis| std::cmp::Reverse(costs.get(*axis).copied().unwrap_or_default()));
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_by_cached_key(|variant| {
            slowest_first.iter().map(|axis| self.rows[*variant][*axis]).collect::<Vec<u32>>()
        });
        order
    }

    /// After how many variants the values that vary fastest begin anew, where variants are all combinations of several
    /// groups: those of the last group, of the last two, and so on.
    pub(super) fn periods(&self) -> Vec<usize> {
        let lengths = self.groups.iter().skip(1).rev().map(|group| self.axes[group[0]].values.len());
        lengths
            .scan(1, |period, length| {
                *period *= length;
                Some(*period)
            })
            .collect()
    }
}

fn combined(varies: Vec<Vary>, combining: &Combining<'_>) -> Result<Variants, Vec<String>> {
    let mut wrong = Vec::new();
    let mut axes = Vec::new();
    for Vary { address, place, spread } in varies {
        match spread {
            Spread::Values(values) => axes.push(Axis { address, place, values }),
            Spread::Between(_) => wrong.push(format!(
                "error: --vary {address}: say how many values, such as 0.1..10:7, or take a sample of all ranges with \
                 --samples"
            )),
        }
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let groups = groups(&axes, combining.zip).map_err(|error| vec![error])?;
    let lengths: Vec<usize> = groups.iter().map(|group| axes[group[0]].values.len()).collect();
    let total = lengths.iter().try_fold(1_usize, |total, length| total.checked_mul(*length));
    let total = total.filter(|total| *total <= if combining.many { MOST } else { MANY }).ok_or_else(|| {
        let product = lengths.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ");
        let remedy = if combining.many {
            format!("{MOST} are the most; give fewer values")
        } else {
            format!("give fewer values, take --samples, or say --many where more than {MANY} are meant")
        };
        vec![format!("error: {product} combinations are too many: {remedy}")]
    })?;
    let rows = (0..total).map(|variant| {
        let mut row = vec![0; axes.len()];
        let mut rest = variant;
        for (group, length) in groups.iter().zip(&lengths).rev() {
            group.iter().for_each(|axis| row[*axis] = (rest % length) as u32);
            rest /= length;
        }
        row
    });
    let rows = rows.collect();
    Ok(Variants { axes, groups, rows, repeated: 0 })
}

/// The axes in groups that vary in step, in the order of their first axes.
fn groups(axes: &[Axis], zip: &[String]) -> Result<Vec<Vec<usize>>, String> {
    let mut leader: Vec<usize> = (0..axes.len()).collect();
    for list in zip {
        let members: Vec<usize> = if list == "*" {
            (0..axes.len()).collect()
        } else {
            let find = |address: &str| {
                axes.iter().position(|axis| axis.address == address).ok_or_else(|| {
                    let known = axes.iter().map(|axis| axis.address.as_str()).collect::<Vec<_>>().join(", ");
                    format!("error: --zip={list}: \"{address}\" is not varied; there is {known}")
                })
            };
            list.split(',').map(|address| find(address.trim())).collect::<Result<_, _>>()?
        };
        let Some((&first, others)) = members.split_first().filter(|(_, others)| !others.is_empty()) else {
            return Err(format!(
                "error: --zip={list}: it takes two addresses that vary together, such as --zip=a.x,b.y"
            ));
        };
        for &axis in others {
            if axis == first || leader[axis] != axis || leader[first] != first {
                return Err(format!("error: --zip={list}: \"{}\" is there twice", axes[axis].address));
            }
            let (one, other) = (&axes[first], &axes[axis]);
            if one.values.len() != other.values.len() {
                return Err(format!(
                    "error: --zip={list}: {} has {} values and {} has {}; give both as many",
                    one.address,
                    one.values.len(),
                    other.address,
                    other.values.len()
                ));
            }
        }
        let lowest = members.iter().copied().min().unwrap_or(first);
        members.iter().for_each(|axis| leader[*axis] = lowest);
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (axis, leader) in leader.into_iter().enumerate() {
        groups.entry(leader).or_default().push(axis);
    }
    Ok(groups.into_values().collect())
}

/// Points of an Owen-scrambled Sobol sequence (Burley 2020, "Practical Hash-based Owen Scrambling"): each prefix of it
/// fills the ranges evenly, so more samples of the same seed only add to those that are there.
fn sampled(varies: Vec<Vary>, count: u32, seed: u32) -> Result<Variants, String> {
    if !(1..=MOST_SAMPLES).contains(&count) {
        return Err(format!("error: --samples {count}: give 1 to {MOST_SAMPLES}"));
    }
    if varies.len() > MOST_DIMENSIONS {
        return Err(format!("error: {} addresses are varied, and {MOST_DIMENSIONS} can be sampled", varies.len()));
    }
    let mut axes = Vec::new();
    let mut columns: Vec<Vec<u32>> = Vec::new();
    for (dimension, Vary { address, place, spread }) in varies.into_iter().enumerate() {
        let share = |sample: u32| f64::from(sobol_burley::sample(sample, dimension as u32, seed));
        let (values, column) = match spread {
            Spread::Values(values) => {
                let length = values.len();
                let column = (0..count).map(|sample| ((share(sample) * length as f64) as usize).min(length - 1) as u32);
                (values, column.collect())
            }
            Spread::Between(between) => {
                let (mut values, mut known, mut column) = (Vec::<Value>::new(), BTreeMap::new(), Vec::new());
                for value in (0..count).map(|sample| between.at(share(sample), SAMPLE_GRAIN)) {
                    let index = *known.entry(value.text.clone()).or_insert_with(|| {
                        values.push(value);
                        values.len() - 1
                    });
                    column.push(index as u32);
                }
                (values, column)
            }
        };
        axes.push(Axis { address, place, values });
        columns.push(column);
    }
    let mut seen = BTreeSet::new();
    let rows = (0..count as usize).map(|sample| columns.iter().map(|column| column[sample]).collect::<Vec<u32>>());
    let rows: Vec<Vec<u32>> = rows.filter(|row| seen.insert(row.clone())).collect();
    let repeated = count as usize - rows.len();
    Ok(Variants { groups: vec![(0..axes.len()).collect()], axes, rows, repeated })
}

#[cfg(test)]
mod tests {
    use maquette_graph::{Catalogue, Graph, NodeKind};

    use super::*;

    fn variants(varies: &[&str], combining: &Combining<'_>) -> Result<Variants, Vec<String>> {
        let mut node = NodeKind::declare("gauge", 1, "test", "Holds numbers.");
        node.number("x", 0.0, -1e9..=1e9, "A number.");
        node.number("y", 0.0, -1e9..=1e9, "A number.");
        node.integer("n", 0, -1000..=1000, "A whole number.");
        let out = node.output::<f64>("number", "A number.");
        node.evaluate(move |ports| {
            ports.write(out, 0.0);
            Ok(())
        });
        let mut catalogue = Catalogue::new();
        catalogue.register(node).unwrap();
        let mut graph = Graph::new();
        graph.add(&catalogue, "gauge", "g").unwrap();
        let varies = varies.iter().map(|text| Vary::parse(&mut graph, text).unwrap()).collect();
        Variants::new(varies, combining)
    }

    fn described(variants: &Variants) -> Vec<String> {
        (0..variants.len()).map(|variant| variants.describe(variant).replace("g.", "")).collect()
    }

    #[test]
    fn the_last_address_varies_fastest() {
        let variants = variants(&["g.x=1,2", "g.n=1..3"], &Combining::default()).unwrap();
        assert_eq!(described(&variants), ["x=1 n=1", "x=1 n=2", "x=1 n=3", "x=2 n=1", "x=2 n=2", "x=2 n=3"]);
        assert_eq!(variants.periods(), [3]);
        // What costs most varies slowest, whatever was asked for.
        assert_eq!(variants.cheapest_order(&[1, 5]), [0, 3, 1, 4, 2, 5]);
        assert_eq!(variants.cheapest_order(&[5, 1]), [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn what_is_zipped_varies_together_and_is_combined_with_the_rest() {
        let zip = ["g.x,g.n".to_owned()];
        let combining = Combining { zip: &zip, ..Default::default() };
        let variants = variants(&["g.x=1,2", "g.y=5,6", "g.n=8,9"], &combining).unwrap();
        assert_eq!(described(&variants), ["x=1 y=5 n=8", "x=1 y=6 n=8", "x=2 y=5 n=9", "x=2 y=6 n=9"]);
        assert_eq!(variants.groups, [vec![0, 2], vec![1]]);
    }

    #[test]
    fn all_are_zipped_where_none_is_named() {
        let zip = ["*".to_owned()];
        let combining = Combining { zip: &zip, ..Default::default() };
        assert_eq!(described(&variants(&["g.x=1,2", "g.y=5,6"], &combining).unwrap()), ["x=1 y=5", "x=2 y=6"]);
    }

    #[test]
    fn samples_fill_each_range_evenly_and_more_of_them_only_add() {
        let sample = |count, seed| {
            let combining = Combining { samples: Some((count, seed)), ..Default::default() };
            described(&variants(&["g.x=0..1", "g.y=0..8", "g.n=0..3"], &combining).unwrap())
        };
        let (few, many) = (sample(16, 7), sample(64, 7));
        assert_eq!(few[..], many[..16]);
        assert_ne!(few, sample(16, 8));
        let numbers = |place: usize| {
            let field = move |text: &String| text.split([' ', '=']).nth(place * 2 + 1).unwrap().parse::<f64>().unwrap();
            many.iter().map(field).collect::<Vec<f64>>()
        };
        // Sixty-four points of the sequence have one in each of sixty-four equal parts of each range.
        for (place, end) in [(0, 1.0), (1, 8.0)] {
            let parts: BTreeSet<usize> = numbers(place).iter().map(|x| (x / end * 64.0) as usize).collect();
            assert_eq!(parts.len(), 64);
        }
        for whole in 0..4 {
            assert_eq!(numbers(2).iter().filter(|n| **n == f64::from(whole)).count(), 16);
        }
    }

    #[test]
    fn samples_that_repeat_are_left_out() {
        let combining = Combining { samples: Some((40, 1)), ..Default::default() };
        let variants = variants(&["g.n=1..3", "g.x=1,2"], &combining).unwrap();
        assert_eq!((variants.len(), variants.repeated), (6, 34));
    }

    #[test]
    fn what_cannot_be_put_together_is_said() {
        let zip = |list: &str| [list.to_owned()];
        let said = |varies: &[&str], combining: &Combining<'_>| variants(varies, combining).unwrap_err().join("\n");
        let plain = Combining::default();
        assert!(said(&["g.x=1,2", "g.x=3,4"], &plain).contains("--vary g.x is given twice"));
        assert!(said(&["g.x=1..2"], &plain).contains("--vary g.x: say how many values"));
        let large = ["g.x=0..1:1000", "g.y=0..1:1000"];
        assert!(said(&large, &plain).contains("1000 x 1000 combinations are too many"), "{}", said(&large, &plain));
        let many = Combining { many: true, ..Default::default() };
        assert_eq!(variants(&large, &many).unwrap().len(), 1_000_000);
        for (list, expected) in [
            ("g.x,g.n", "g.x has 2 values and g.n has 3; give both as many"),
            ("g.x", "two addresses"),
            ("g.x,g.q", "\"g.q\" is not varied; there is g.x, g.n"),
            ("g.x,g.x", "\"g.x\" is there twice"),
        ] {
            let zip = zip(list);
            let combining = Combining { zip: &zip, ..Default::default() };
            let error = said(&["g.x=1,2", "g.n=1..3"], &combining);
            assert!(error.contains(expected), "{error}");
        }
        let none = Combining { samples: Some((0, 0)), ..Default::default() };
        assert!(said(&["g.x=1..2"], &none).contains("give 1 to 65536"));
    }
}
