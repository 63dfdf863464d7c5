//! `--vary ADDRESS=VALUES`: what an input is varied over.
//!
//! | written | meaning |
//! |---|---|
//! | `0.8,1,1.2` | these values |
//! | `0.1..10:7` | seven numbers from 0.1 to 10 in equal steps, both ends included, rounded to a thousandth of a step |
//! | `0.1..10:7:log` | the same in equal ratios |
//! | `2..5` | whole numbers: all from 2 to 5 |
//! | `0.1..10`, `0.1..10:log` | with `--samples`: anywhere between |
//! | `*` | every option of a choice, or false and true |
//! | `(0,1,0),(0,2,0)` | vectors and colours: brackets around each |

use maquette_graph::{Graph, Literal, LiteralKind};

use crate::commands::overrides::Place;

/// Most values of one address.
const MOST_VALUES: usize = 100_000;

/// To which share of a step the numbers of a range are rounded.
const GRAIN: f64 = 1e-3;
/// To which share of a range its samples are rounded.
pub(super) const SAMPLE_GRAIN: f64 = 1e-6;

/// A value that an address takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Value {
    /// As it is written and shown.
    pub(super) text: String,
    pub(super) literal: Literal,
}

/// What an address is varied over.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Spread {
    /// These values.
    Values(Vec<Value>),
    /// Anywhere between two numbers, both included.
    Between(Between),
}

/// A range that is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Between {
    from: f64,
    to: f64,
    /// Whether equal ratios count the same, in place of equal steps.
    log: bool,
    whole: bool,
}

/// One `--vary`.
#[derive(Clone, Debug)]
pub(super) struct Vary {
    pub(super) address: String,
    pub(super) place: Place,
    pub(super) spread: Spread,
}

impl Vary {
    /// Reads `ADDRESS=VALUES`; every value is tried at its place in `graph`, which keeps the last of them.
    pub(super) fn parse(graph: &mut Graph, text: &str) -> Result<Self, String> {
        let fail = |reason: String| format!("--vary {text}: {reason}");
        let (address, values) = text
            .split_once('=')
            .ok_or_else(|| fail("write it as NODE.PORT=0.8,1,1.2 or NODE.PORT=0.1..10:7".into()))?;
        let place = Place::find(graph, address).map_err(fail)?;
        let spread = spread(&place, values.trim()).map_err(fail)?;
        let tried = match &spread {
            Spread::Values(values) => values.iter().map(|value| value.literal.clone()).collect(),
            Spread::Between(between) => vec![between.at(0.0, 1.0).literal, between.at(1.0, 1.0).literal],
        };
        for literal in tried {
            place.set(graph, literal).map_err(fail)?;
        }
        Ok(Self { address: address.to_owned(), place, spread })
    }
}

impl Between {
    /// The number at a share of the way, 0 to 1; whole numbers all get the same share. It is rounded to `grain` of the
    /// way: nobody wants to read 1.7499999999999998, and what is shown is what is set.
    pub(super) fn at(&self, share: f64, grain: f64) -> Value {
        let Self { from, to, log, whole } = *self;
        if whole {
            let (low, high) = (from.min(to), from.max(to));
            let value = (low + (share * (high - low + 1.0)).floor()).min(high);
            return integer(value);
        }
        // The ends are exact.
        if share == 0.0 || share == 1.0 {
            return number(if share == 0.0 { from } else { to });
        }
        let (value, way) = if log {
            let value = from * (to / from).powf(share);
            (value, value * (to / from).ln())
        } else {
            (from + (to - from) * share, to - from)
        };
        let decimals = (-(way.abs() * grain).log10()).ceil().clamp(0.0, 300.0) as usize;
        number(format!("{value:.decimals$}").parse().unwrap_or(value))
    }
}

fn number(value: f64) -> Value {
    // Not the zero with a sign.
    let value = if value == 0.0 { 0.0 } else { value };
    Value { text: value.to_string(), literal: Literal::Number(value) }
}

/// A whole number, far below 2^53.
fn integer(value: f64) -> Value {
    let value = value as i64;
    Value { text: value.to_string(), literal: Literal::Integer(value) }
}

fn spread(place: &Place, text: &str) -> Result<Spread, String> {
    let numeric = matches!(place.wanted, LiteralKind::Number | LiteralKind::Integer);
    if text == "*"
        && let Some(values) = all_options(place)
    {
        return Ok(Spread::Values(values));
    }
    let mut values: Vec<Value> = Vec::new();
    let pieces = pieces(text);
    for piece in &pieces {
        let more = if numeric && piece.contains("..") {
            let range = Range::parse(piece, place.wanted == LiteralKind::Integer)?;
            match range.values()? {
                Some(values) => values,
                None if pieces.len() == 1 => return Ok(Spread::Between(range.between)),
                None => return Err(format!("{piece}: say how many values, such as {piece}:5")),
            }
        } else {
            vec![one(place, piece, pieces.len())?]
        };
        values.extend(more);
        if values.len() > MOST_VALUES {
            return Err(format!("these are more than {MOST_VALUES} values"));
        }
    }
    let key = |value: &Value| format!("{:?}", value.literal);
    let mut sorted: Vec<(String, &str)> = values.iter().map(|value| (key(value), value.text.as_str())).collect();
    sorted.sort();
    match sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        Some(pair) => Err(format!("{} is there twice", pair[0].1)),
        None => Ok(Spread::Values(values)),
    }
}

fn all_options(place: &Place) -> Option<Vec<Value>> {
    match place.wanted {
        LiteralKind::Choice => {
            let value = |name: &String| Value { text: name.clone(), literal: Literal::Choice(name.clone()) };
            Some(place.options.iter().map(value).collect())
        }
        LiteralKind::Boolean => {
            Some([false, true].map(|flag| Value { text: flag.to_string(), literal: Literal::Boolean(flag) }).into())
        }
        _ => None,
    }
}

/// A single value.
fn one(place: &Place, piece: &str, pieces: usize) -> Result<Value, String> {
    let bracketed = piece.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).map(str::trim);
    let several = matches!(place.wanted, LiteralKind::Vector | LiteralKind::Colour);
    let text = if several { bracketed.unwrap_or(piece) } else { piece };
    if text.is_empty() {
        return Err("a value is missing between the commas".to_owned());
    }
    let literal = place.read(text).map_err(|reason| {
        if several && bracketed.is_none() && pieces > 1 {
            format!("{reason}; put brackets around each value, such as (0,1,0),(0,2,0)")
        } else {
            reason
        }
    })?;
    // A whole number at a number's input is that number; one too large to be exact is refused where it is put.
    let literal = match literal {
        Literal::Integer(whole) if place.wanted == LiteralKind::Number && whole.unsigned_abs() <= 1 << 53 => {
            Literal::Number(whole as f64)
        }
        other => other,
    };
    Ok(Value { text: text.to_owned(), literal })
}

/// What stands between commas, where these are not inside brackets or quotes.
fn pieces(text: &str) -> Vec<&str> {
    let (mut pieces, mut first, mut depth, mut quoted) = (Vec::new(), 0, 0_usize, false);
    for (at, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '(' | '[' if !quoted => depth += 1,
            ')' | ']' if !quoted => depth = depth.saturating_sub(1),
            ',' if !quoted && depth == 0 => {
                pieces.push(text[first..at].trim());
                first = at + 1;
            }
            _ => {}
        }
    }
    pieces.push(text[first..].trim());
    pieces
}

/// `FROM..TO`, `FROM..TO:COUNT`, either with `:log` behind.
struct Range {
    between: Between,
    count: Option<usize>,
}

impl Range {
    fn parse(text: &str, whole: bool) -> Result<Self, String> {
        let how = if whole { "2..5 or 0..100:5" } else { "0.1..10:7 or 0.1..10:7:log" };
        let fail = |reason: String| format!("{text}: {reason}; write a range as {how}");
        let (ends, rest) = text.split_once(':').map_or((text, None), |(ends, rest)| (ends, Some(rest)));
        let (rest, log) = match rest {
            Some("log") => (None, true),
            Some(rest) => rest.strip_suffix(":log").map_or((Some(rest), false), |rest| (Some(rest), true)),
            None => (None, false),
        };
        let count = match rest.map(str::trim) {
            None => None,
            Some(count) => Some(
                count
                    .parse::<usize>()
                    .map_err(|_| fail(format!("\"{count}\" is not a number of values or \"log\"")))?,
            ),
        };
        let (from, to) = ends.split_once("..").ok_or_else(|| fail("there is no ..".to_owned()))?;
        if to.starts_with('=') {
            return Err(fail("both ends are included; leave out the =".to_owned()));
        }
        let end = |end: &str| {
            let end = end.trim();
            let value: f64 = end.parse().map_err(|_| fail(format!("\"{end}\" is not a number")))?;
            if !value.is_finite() {
                return Err(fail(format!("{end} is no end of a range")));
            }
            if whole && (value.fract() != 0.0 || value.abs() > 9e15) {
                return Err(fail(format!("\"{end}\" is not a whole number")));
            }
            Ok(value)
        };
        let between = Between { from: end(from)?, to: end(to)?, log, whole };
        if log && (between.from <= 0.0 || between.to <= 0.0) {
            return Err(fail("equal ratios need two ends above zero".to_owned()));
        }
        if log && whole && count.is_none() {
            return Err(fail("say how many whole numbers".to_owned()));
        }
        if between.from == between.to {
            return Err(fail("both ends are the same".to_owned()));
        }
        match count {
            Some(0 | 1) => Err(fail("a range has two values at least".to_owned())),
            Some(count) if count > MOST_VALUES => Err(fail(format!("{count} values are more than {MOST_VALUES}"))),
            _ => Ok(Self { between, count }),
        }
    }

    /// Its values; `None` where it does not say how many.
    fn values(&self) -> Result<Option<Vec<Value>>, String> {
        let Between { from, to, log, whole } = self.between;
        let count = match self.count {
            Some(count) => count,
            None if whole => {
                let count = (to - from).abs() + 1.0;
                if count > MOST_VALUES as f64 {
                    return Err(format!("{from}..{to} are {count} values: say how many, such as {from}..{to}:5"));
                }
                count as usize
            }
            None => return Ok(None),
        };
        let exact = Between { from, to, log, whole: false };
        let steps = (count - 1) as f64;
        let real = (0..count).map(|index| exact.at(index as f64 / steps, GRAIN / steps));
        if !whole {
            return Ok(Some(real.collect()));
        }
        let rounded = |value: Value| match value.literal {
            Literal::Number(number) => integer(number.round()),
            _ => value,
        };
        let values: Vec<Value> = real.map(rounded).collect();
        if values.windows(2).any(|pair| pair[0] == pair[1]) {
            let most = (to - from).abs() + 1.0;
            let so = if log { ", fewer in equal ratios".to_owned() } else { format!(": {most} at most") };
            return Err(format!("there are not {count} whole numbers from {from} to {to}{so}"));
        }
        Ok(Some(values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vary(text: &str) -> Result<Vary, String> {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        graph.add(&catalogue, "resample", "even").unwrap();
        graph.add(&catalogue, "detail-generator", "body").unwrap();
        graph.add(&catalogue, "transform", "moved").unwrap();
        graph.add(&catalogue, "mesh-out", "out").unwrap();
        graph.add(&catalogue, "mirror", "both").unwrap();
        graph.add(&catalogue, "import-curves", "file").unwrap();
        Vary::parse(&mut graph, text)
    }

    fn texts(text: &str) -> Vec<String> {
        match vary(text).unwrap().spread {
            Spread::Values(values) => values.into_iter().map(|value| value.text).collect(),
            Spread::Between(between) => vec![format!("{between:?}")],
        }
    }

    #[test]
    fn ranges_hold_both_ends_and_readable_numbers_between() {
        assert_eq!(texts("body.k_s=0.1..0.8:8"), ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8"]);
        assert_eq!(texts("body.k_s=0.01..100:5:log"), ["0.01", "0.1", "1", "10", "100"]);
        assert_eq!(texts("body.k_s=3..1:3"), ["3", "2", "1"]);
        assert_eq!(texts("body.k_s=0..1:7"), ["0", "0.1667", "0.3333", "0.5", "0.6667", "0.8333", "1"]);
        assert_eq!(texts("body.k_s=0.2..5:4:log"), ["0.2", "0.5848", "1.71", "5"]);
        assert_eq!(texts("body.k_b=1..2:2,5"), ["1", "2", "5"]);
    }

    #[test]
    fn whole_numbers_stay_whole() {
        assert_eq!(texts("even.count=4..7"), ["4", "5", "6", "7"]);
        assert_eq!(texts("even.count=7..4"), ["7", "6", "5", "4"]);
        assert_eq!(texts("even.count=10..20:3"), ["10", "15", "20"]);
        assert_eq!(texts("even.count=10..1000:3:log"), ["10", "100", "1000"]);
        let Spread::Values(values) = vary("even.count=4,8").unwrap().spread else { panic!("values") };
        assert_eq!(values[0].literal, Literal::Integer(4));
    }

    #[test]
    fn lists_follow_the_type_of_the_port() {
        assert_eq!(texts("both.axis=*"), ["x", "y", "z"]);
        assert_eq!(texts("both.keep=*"), ["false", "true"]);
        assert_eq!(texts("both.axis=x, z"), ["x", "z"]);
        assert_eq!(texts("moved.rotate=(0,1,0),(0, 2,0)"), ["0,1,0", "0, 2,0"]);
        assert_eq!(texts("out.colour=(1,0.5,0),(0,0.5,0,1)"), ["1,0.5,0", "0,0.5,0,1"]);
        assert_eq!(texts("file.file=../a.json,b.json"), ["../a.json", "b.json"]);
    }

    #[test]
    fn sampled_ranges_give_each_whole_number_the_same_share() {
        let Spread::Between(between) = vary("body.k_s=1..100:log").unwrap().spread else { panic!("a range") };
        assert_eq!([0.0, 0.5, 1.0].map(|share| between.at(share, 1e-6).text), ["1", "10", "100"]);
        assert_eq!(between.at(0.3, 1e-3).text, "3.98");
        let whole = Between { from: 3.0, to: 5.0, log: false, whole: true };
        assert_eq!([0.0, 0.33, 0.34, 0.66, 0.67, 1.0].map(|s| whole.at(s, 1e-6).text), ["3", "3", "4", "4", "5", "5"]);
    }

    #[test]
    fn what_is_wrong_is_said_with_the_remedy() {
        for (text, said) in [
            ("body.k_s", "write it as NODE.PORT="),
            ("bodi.k_s=1,2", "did you mean \"body\"?"),
            ("body.k_t=1,2", "no input \"k_t\""),
            ("body.rails=1,2", "from a link"),
            ("body.k_s=1..:3", "\"\" is not a number; write a range as 0.1..10:7"),
            ("body.k_s=1..2:1", "two values at least"),
            ("body.k_s=1..2:x", "\"x\" is not a number of values"),
            ("body.k_s=1..=2:4", "both ends are included"),
            ("body.k_s=0..2:4:log", "above zero"),
            ("body.k_s=1..1:4", "both ends are the same"),
            ("body.k_s=1..inf:4", "no end of a range"),
            ("body.k_s=1,1.0", "1 is there twice"),
            ("body.k_s=1,,2", "a value is missing"),
            ("body.k_s=", "a value is missing"),
            ("body.k_s=1,1..2", "say how many values, such as 1..2:5"),
            ("body.k_s=-5,1", "out of range"),
            ("even.count=1..3:7", "there are not 7 whole numbers from 1 to 3: 3 at most"),
            ("even.count=1.5..3", "\"1.5\" is not a whole number"),
            ("even.count=1.5,3", "not a whole number"),
            ("both.axis=x,q", "\"q\" is not an option: choose one of x, y, z"),
            ("moved.rotate=0,1,0", "put brackets around each value"),
        ] {
            let error = vary(text).unwrap_err();
            assert!(error.starts_with(&format!("--vary {text}: ")) && error.contains(said), "{text}: {error}");
        }
    }
}
