//! Values as plain data.

use serde::Deserialize;

use crate::value::{Value, Wire};

/// Plain data that a value becomes in a golden file.
///
/// Numbers are compared within the tolerance, points by their distance, everything else exactly.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub enum Frozen {
    /// A number.
    Number(f64),
    /// A list of numbers.
    Numbers(Vec<f64>),
    /// A list of points, metres.
    Points(Vec<[f64; 3]>),
    /// Whole numbers, indices, counts.
    Integers(Vec<i64>),
    /// Yes or no.
    Boolean(bool),
    /// A text.
    Text(String),
    /// Bytes that are no text, as base64.
    Bytes(String),
    /// Nothing, where something is optional.
    Nothing,
    /// Several things in order.
    List(Vec<Frozen>),
    /// Several things by name.
    Record(Vec<(String, Frozen)>),
}

impl Frozen {
    /// Things by name.
    pub fn record<const N: usize>(fields: [(&str, Self); N]) -> Self {
        Self::Record(fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
    }

    /// A text.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// What it is, for messages.
    pub(crate) fn noun(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Numbers(_) => "numbers",
            Self::Points(_) => "points",
            Self::Integers(_) => "whole numbers",
            Self::Boolean(_) => "a yes or no",
            Self::Text(_) => "a text",
            Self::Bytes(_) => "bytes",
            Self::Nothing => "nothing",
            Self::List(_) => "a list",
            Self::Record(_) => "a record",
        }
    }

    /// The field of that name.
    ///
    /// # Errors
    /// There is none, or this is no record.
    pub fn field(&self, name: &str) -> Result<&Self, ThawError> {
        match self {
            Self::Record(fields) => fields
                .iter()
                .find_map(|(field, value)| (field == name).then_some(value))
                .ok_or_else(|| ThawError(format!("the field \"{name}\" is missing"))),
            other => {
                Err(ThawError(format!("it holds {} in place of a record with the field \"{name}\"", other.noun())))
            }
        }
    }

    /// The parts of a list.
    ///
    /// # Errors
    /// This is no list.
    pub fn list(&self) -> Result<&[Self], ThawError> {
        if let Self::List(parts) = self { Ok(parts) } else { Err(self.instead_of("a list")) }
    }

    /// The points.
    ///
    /// # Errors
    /// These are no points.
    pub fn points(&self) -> Result<&[[f64; 3]], ThawError> {
        if let Self::Points(points) = self { Ok(points) } else { Err(self.instead_of("points")) }
    }

    /// The numbers.
    ///
    /// # Errors
    /// These are no numbers.
    pub fn numbers(&self) -> Result<&[f64], ThawError> {
        if let Self::Numbers(numbers) = self { Ok(numbers) } else { Err(self.instead_of("numbers")) }
    }

    /// The number.
    ///
    /// # Errors
    /// This is no number.
    pub fn number(&self) -> Result<f64, ThawError> {
        if let Self::Number(number) = self { Ok(*number) } else { Err(self.instead_of("a number")) }
    }

    /// The whole numbers.
    ///
    /// # Errors
    /// These are none.
    pub fn integers(&self) -> Result<&[i64], ThawError> {
        if let Self::Integers(integers) = self { Ok(integers) } else { Err(self.instead_of("whole numbers")) }
    }

    /// The flag.
    ///
    /// # Errors
    /// This is no yes or no.
    pub fn boolean(&self) -> Result<bool, ThawError> {
        if let Self::Boolean(flag) = self { Ok(*flag) } else { Err(self.instead_of("true or false")) }
    }

    /// The text.
    ///
    /// # Errors
    /// This is no text.
    pub fn as_text(&self) -> Result<&str, ThawError> {
        if let Self::Text(text) = self { Ok(text) } else { Err(self.instead_of("a text")) }
    }

    fn instead_of(&self, expected: &str) -> ThawError {
        ThawError(format!("it holds {} in place of {expected}", self.noun()))
    }
}

/// Plain data that makes no value of a type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ThawError(pub String);

/// A wire type that golden files can hold. `thaw` of `freeze` must give an equal value.
///
/// ```
/// use maquette_graph::freeze::{Freeze, Frozen, ThawError};
/// use maquette_graph::{Catalogue, ContentHasher, Value, Wire};
///
/// #[derive(Clone, PartialEq, Debug)]
/// struct Samples(Vec<f64>);
///
/// impl Wire for Samples {
///     const NAME: &'static str = "samples";
///     const DESCRIPTION: &'static str = "Measured numbers.";
///     fn hash_content(&self, hasher: &mut ContentHasher) {
///         hasher.numbers(&self.0);
///     }
///     fn byte_size(&self) -> usize {
///         size_of_val(self.0.as_slice())
///     }
///     fn summary(&self) -> String {
///         format!("{} samples", self.0.len())
///     }
/// }
///
/// impl Freeze for Samples {
///     fn freeze(&self) -> Frozen {
///         Frozen::Numbers(self.0.clone())
///     }
///     fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
///         frozen.numbers().map(|numbers| Self(numbers.to_vec()))
///     }
/// }
///
/// let mut catalogue = Catalogue::new();
/// catalogue.freezable::<Samples>();
/// let samples = Samples(vec![0.5, 1.5]);
/// assert_eq!(Samples::thaw(&samples.freeze()), Ok(samples));
/// ```
pub trait Freeze: Wire + Sized {
    /// The value as plain data.
    fn freeze(&self) -> Frozen;

    /// The value that plain data describes.
    ///
    /// # Errors
    /// What is wrong with the data.
    fn thaw(frozen: &Frozen) -> Result<Self, ThawError>;
}

/// [`Freeze`] of a type known at run time only.
#[derive(Clone, Copy)]
pub(crate) struct Freezer {
    pub(crate) freeze: fn(&Value) -> Option<Frozen>,
    pub(crate) thaw: fn(&Frozen) -> Result<Value, ThawError>,
}

impl Freezer {
    pub(crate) fn of<T: Freeze>() -> Self {
        Self { freeze: |value| value.get::<T>().map(T::freeze), thaw: |frozen| T::thaw(frozen).map(Value::new) }
    }
}
