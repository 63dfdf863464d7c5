//! What a port declares: type, unit, ranges, default, description.

use std::fmt;

use crate::literal::{Colour, Literal, LiteralKind};
use crate::value::{Value, WireType};

/// What a number measures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// A plain number.
    #[default]
    None,
    /// Metres.
    Length,
    /// Degrees.
    Angle,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "",
            Self::Length => "m",
            Self::Angle => "degrees",
        })
    }
}

/// Smallest and largest value, both allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl Range {
    /// Whether a value lies in it.
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", self.min, self.max)
    }
}

/// One option of a choice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OptionSpec {
    /// Name, as written in files.
    pub name: String,
    /// One line on what it does.
    pub description: String,
}

/// An input of a node kind.
#[derive(Clone, Debug, PartialEq)]
pub struct InputSpec {
    /// Name, `kebab-case`, unique among the inputs of its kind.
    pub name: String,
    /// One line on what it is for.
    pub description: String,
    /// Type of the wire.
    pub wire: WireType,
    /// What it holds when nothing is set. Without a default it must be linked, unless it is optional.
    pub default: Option<Literal>,
    /// The default, hashed once.
    pub(crate) default_value: Option<Value>,
    /// Whether the node does without it.
    pub optional: bool,
    /// What a number measures.
    pub unit: Unit,
    /// Values outside are refused.
    pub range: Option<Range>,
    /// What a slider offers; values outside are allowed within `range`.
    pub soft_range: Option<Range>,
    /// Options of a choice.
    pub options: Vec<OptionSpec>,
    /// Extensions of a file, without the dot, for dialogs.
    pub extensions: Vec<String>,
}

impl InputSpec {
    /// Says why a literal can't stand at this input; `None` where it can.
    pub(crate) fn refuses(&self, literal: &Literal) -> Option<String> {
        let wanted = LiteralKind::of_wire(self.wire);
        let fits = wanted == Some(literal.kind())
            || matches!((wanted, literal), (Some(LiteralKind::Number), Literal::Integer(_)));
        if !fits {
            let mut reason = match wanted {
                Some(kind) => {
                    format!("it takes {} such as {}, not {}", kind.phrase(), kind.example(), spelled(literal))
                }
                None => format!("it takes {} from a link; a literal can't stand here", self.wire),
            };
            if let (Some(LiteralKind::Integer), Literal::Number(number)) = (wanted, literal)
                && number.fract() == 0.0
            {
                // 2^63, where the whole numbers end.
                let too_large = number.abs() >= 9_223_372_036_854_775_808.0;
                reason.push_str(if too_large { ": it is too large for one" } else { ": leave out the decimal point" });
            }
            return Some(reason);
        }
        if let (Some(LiteralKind::Number), Literal::Integer(integer)) = (wanted, literal)
            && let Err(reason) = exact_number(*integer)
        {
            return Some(reason);
        }
        literal.not_finite().or_else(|| self.refuses_value(&literal.to_value()))
    }

    /// A literal that fits, as it is kept: an integer at a number's input is that number, because it must hash like one.
    pub(crate) fn normal(&self, literal: Literal) -> Literal {
        match literal {
            #[expect(clippy::cast_precision_loss, reason = "what would be rounded does not fit")]
            Literal::Integer(integer) if self.wire == WireType::of::<f64>() => Literal::Number(integer as f64),
            other => other,
        }
    }

    /// Says why a value of the right type is out of range or no option; `None` where it is fine.
    pub(crate) fn refuses_value(&self, value: &Value) -> Option<String> {
        let unit = if self.unit == Unit::None { String::new() } else { format!(" {}", self.unit) };
        if let Some(range) = self.range {
            #[expect(clippy::cast_precision_loss, reason = "ranges end far below 2^53")]
            let number = value.get::<f64>().copied().or_else(|| value.get::<i64>().map(|i| *i as f64));
            if let Some(number) = number.filter(|n| !range.contains(*n)) {
                return Some(format!("{number}{unit} is out of range: give {range}{unit}"));
            }
        }
        if let Some(Colour(components)) = value.get::<Colour>() {
            let named = ["red", "green", "blue", "alpha"].into_iter().zip(components);
            if let Some((name, bad)) = named.into_iter().find(|(_, component)| !(0.0..=1.0).contains(*component)) {
                return Some(format!("{name} is {bad:?}, which is out of range: give 0 to 1 for each component"));
            }
        }
        if let Some(choice) = value.get::<crate::Choice>().filter(|c| !self.options.iter().any(|o| o.name == c.0)) {
            let options: Vec<_> = self.options.iter().map(|o| o.name.as_str()).collect();
            return Some(format!("\"{}\" is not an option: choose one of {}", choice.0, options.join(", ")));
        }
        None
    }
}

/// A whole number as a number.
///
/// # Errors
/// It would be rounded, in words for artists.
pub(crate) fn exact_number(integer: i64) -> Result<f64, String> {
    #[expect(clippy::cast_precision_loss, reason = "what would be lost is refused")]
    let number = integer as f64;
    // 2^53: beyond, neighbouring integers share a number.
    if integer.unsigned_abs() <= 1 << 53 {
        Ok(number)
    } else {
        Err(format!("{integer} is too large to become a number without loss"))
    }
}

/// A literal of the wrong kind, for messages.
fn spelled(literal: &Literal) -> String {
    match literal {
        Literal::Number(number) => format!("the number {number:?}"),
        Literal::Integer(integer) => format!("the whole number {integer}"),
        Literal::Boolean(flag) => flag.to_string(),
        other => other.kind().phrase().to_owned(),
    }
}

/// An output of a node kind.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSpec {
    /// Name, `kebab-case`, unique among the outputs of its kind.
    pub name: String,
    /// One line on what comes out.
    pub description: String,
    /// Type of the wire.
    pub wire: WireType,
}
