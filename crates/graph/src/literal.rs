//! What an input holds when nothing is linked to it: plain data that a file can spell out.

use serde::{Deserialize, Serialize};

use crate::value::{ContentHasher, Value, Wire, WireType};

/// One of the options that a port declares, by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice(pub String);

/// Three numbers: a position, a direction, an offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector(pub [f64; 3]);

/// Red, green, blue, alpha; sRGB, each 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub [f64; 4]);

/// Path of a file. Relative paths start at the folder of the graph's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePath(pub String);

/// A point of a stroke in the two coordinates of its view plane, with the pen's pressure where it was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePoint {
    /// First coordinate in the plane, metres.
    pub x: f64,
    /// Second coordinate in the plane, metres.
    pub y: f64,
    /// Pressure, 0 to 1.
    pub pressure: Option<f64>,
}

/// A stroke as it was drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// Name; may be empty.
    #[serde(default)]
    pub name: String,
    /// Whether the last point joins the first.
    #[serde(default)]
    pub closed: bool,
    /// The points in the order they were drawn.
    pub points: Vec<StrokePoint>,
}

/// Strokes drawn in one view plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strokes(pub Vec<Stroke>);

/// A value written out in place of a link.
#[derive(Clone, Debug, PartialEq)]
pub enum Literal {
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(i64),
    /// Yes or no.
    Boolean(bool),
    /// A text.
    Text(String),
    /// One of the options a port declares.
    Choice(String),
    /// Three numbers.
    Vector([f64; 3]),
    /// Red, green, blue, alpha; sRGB, each 0 to 1.
    Colour([f64; 4]),
    /// Sketched strokes.
    Strokes(Vec<Stroke>),
    /// Path of a file.
    File(String),
}

/// The kinds of literals, for messages and editors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are those of `Literal`, which says what they are")]
pub enum LiteralKind {
    Number,
    Integer,
    Boolean,
    Text,
    Choice,
    Vector,
    Colour,
    Strokes,
    File,
}

impl LiteralKind {
    /// The kind of literal that an input of this wire type holds; none where it can only be linked.
    pub fn of_wire(wire: WireType) -> Option<Self> {
        [
            (WireType::of::<f64>(), Self::Number),
            (WireType::of::<i64>(), Self::Integer),
            (WireType::of::<bool>(), Self::Boolean),
            (WireType::of::<String>(), Self::Text),
            (WireType::of::<Choice>(), Self::Choice),
            (WireType::of::<Vector>(), Self::Vector),
            (WireType::of::<Colour>(), Self::Colour),
            (WireType::of::<Strokes>(), Self::Strokes),
            (WireType::of::<FilePath>(), Self::File),
        ]
        .into_iter()
        .find_map(|(known, kind)| (known == wire).then_some(kind))
    }

    /// What such a literal is, with its article, for messages.
    pub(crate) fn phrase(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Integer => "a whole number",
            Self::Boolean => "a yes or no",
            Self::Text => "a text",
            Self::Choice => "a choice",
            Self::Vector => "a vector",
            Self::Colour => "a colour",
            Self::Strokes => "strokes",
            Self::File => "a file",
        }
    }

    /// How such a literal is written in a file.
    pub fn example(self) -> &'static str {
        match self {
            Self::Number => "0.5",
            Self::Integer => "64",
            Self::Boolean => "true",
            Self::Text => "Text(\"...\")",
            Self::Choice => "Choice(\"...\")",
            Self::Vector => "Vector(0.0, 1.0, 0.0)",
            Self::Colour => "Colour(0.8, 0.7, 0.6, 1.0)",
            Self::Strokes => "Strokes([(name: \"...\", closed: false, points: [(0.0, 0.0), (0.1, 0.2)])])",
            Self::File => "File(\"folder/file.json\")",
        }
    }
}

impl Literal {
    /// Its kind.
    pub fn kind(&self) -> LiteralKind {
        match self {
            Self::Number(_) => LiteralKind::Number,
            Self::Integer(_) => LiteralKind::Integer,
            Self::Boolean(_) => LiteralKind::Boolean,
            Self::Text(_) => LiteralKind::Text,
            Self::Choice(_) => LiteralKind::Choice,
            Self::Vector(_) => LiteralKind::Vector,
            Self::Colour(_) => LiteralKind::Colour,
            Self::Strokes(_) => LiteralKind::Strokes,
            Self::File(_) => LiteralKind::File,
        }
    }

    /// The value that travels along the wire.
    pub fn to_value(&self) -> Value {
        match self {
            Self::Number(number) => Value::new(*number),
            Self::Integer(integer) => Value::new(*integer),
            Self::Boolean(flag) => Value::new(*flag),
            Self::Text(text) => Value::new(text.clone()),
            Self::Choice(option) => Value::new(Choice(option.clone())),
            Self::Vector(vector) => Value::new(Vector(*vector)),
            Self::Colour(colour) => Value::new(Colour(*colour)),
            Self::Strokes(strokes) => Value::new(Strokes(strokes.clone())),
            Self::File(path) => Value::new(FilePath(path.clone())),
        }
    }

    /// Where a number in the literal is not finite: says which. `None` where all are finite.
    pub fn not_finite(&self) -> Option<String> {
        let component = |numbers: &[f64]| {
            numbers.iter().position(|n| !n.is_finite()).map(|index| format!("component {index} is not a finite number"))
        };
        match self {
            Self::Number(number) => (!number.is_finite()).then(|| "it is not a finite number".to_owned()),
            Self::Vector(vector) => component(vector),
            Self::Colour(colour) => component(colour),
            Self::Strokes(strokes) => strokes.iter().enumerate().find_map(|(index, stroke)| {
                let bad = |p: &StrokePoint| ![p.x, p.y, p.pressure.unwrap_or(0.0)].iter().all(|n| n.is_finite());
                stroke.points.iter().position(bad).map(|point| {
                    format!(
                        "stroke {index} \"{}\", point {point} has a coordinate that is not a finite number",
                        stroke.name
                    )
                })
            }),
            Self::Integer(_) | Self::Boolean(_) | Self::Text(_) | Self::Choice(_) | Self::File(_) => None,
        }
    }
}

impl Serialize for StrokePoint {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.pressure {
            Some(pressure) => (self.x, self.y, pressure).serialize(serializer),
            None => (self.x, self.y).serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for StrokePoint {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = StrokePoint;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a point (x, y) or (x, y, pressure)")
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut seq: A) -> Result<StrokePoint, A::Error> {
                let missing = |index| serde::de::Error::invalid_length(index, &self);
                let x = seq.next_element()?.ok_or_else(|| missing(0))?;
                let y = seq.next_element()?.ok_or_else(|| missing(1))?;
                Ok(StrokePoint { x, y, pressure: seq.next_element()? })
            }
        }
        deserializer.deserialize_tuple(3, Visitor)
    }
}

impl Wire for Choice {
    const NAME: &'static str = "choice";
    const DESCRIPTION: &'static str = "One of the options a port declares, by name.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.text(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>() + self.0.len()
    }

    fn summary(&self) -> String {
        self.0.clone()
    }
}

impl Wire for Vector {
    const NAME: &'static str = "vector";
    const DESCRIPTION: &'static str = "Three numbers: a position, a direction or an offset; +X left, +Y up, +Z front.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.numbers(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>()
    }

    fn summary(&self) -> String {
        let [x, y, z] = self.0;
        format!("({x}, {y}, {z})")
    }
}

impl Wire for Colour {
    const NAME: &'static str = "colour";
    const DESCRIPTION: &'static str = "Red, green, blue and alpha; sRGB, each from 0 to 1.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.numbers(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>()
    }

    fn summary(&self) -> String {
        let [r, g, b, a] = self.0;
        format!("({r}, {g}, {b}, {a})")
    }
}

impl Wire for FilePath {
    const NAME: &'static str = "file";
    const DESCRIPTION: &'static str = "Path of a file; relative paths start at the folder of the graph.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.text(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of::<Self>() + self.0.len()
    }

    fn summary(&self) -> String {
        self.0.clone()
    }
}

impl Wire for Strokes {
    const NAME: &'static str = "strokes";
    const DESCRIPTION: &'static str = "Strokes drawn in a view plane: points with optional pressure, open or closed.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.0.len() as u64);
        for stroke in &self.0 {
            hasher.text(&stroke.name);
            hasher.integer(u64::from(stroke.closed));
            hasher.integer(stroke.points.len() as u64);
            for point in &stroke.points {
                hasher.number(point.x);
                hasher.number(point.y);
                // A missing pressure is not a pressure of zero.
                hasher.number(point.pressure.unwrap_or(-1.0));
            }
        }
    }

    fn byte_size(&self) -> usize {
        self.0.iter().map(|s| size_of::<Stroke>() + s.name.len() + size_of_val(s.points.as_slice())).sum()
    }

    fn summary(&self) -> String {
        let points: usize = self.0.iter().map(|s| s.points.len()).sum();
        format!("{} strokes, {points} points", self.0.len())
    }
}
