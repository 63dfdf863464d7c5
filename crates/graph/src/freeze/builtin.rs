//! How the types of literals become plain data.

use super::frozen::{Freeze, Frozen, ThawError};
use crate::literal::{Choice, Colour, FilePath, Stroke, StrokePoint, Strokes, Vector};

impl Freeze for f64 {
    fn freeze(&self) -> Frozen {
        Frozen::Number(*self)
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        frozen.number()
    }
}

impl Freeze for i64 {
    fn freeze(&self) -> Frozen {
        Frozen::Integers(vec![*self])
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        match frozen.integers()? {
            [integer] => Ok(*integer),
            several => Err(ThawError(format!("it holds {} whole numbers in place of one", several.len()))),
        }
    }
}

impl Freeze for bool {
    fn freeze(&self) -> Frozen {
        Frozen::Boolean(*self)
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        frozen.boolean()
    }
}

macro_rules! texts {
    ($($text:ty: $read:expr, $make:expr);*) => {$(
        impl Freeze for $text {
            fn freeze(&self) -> Frozen {
                let read: fn(&Self) -> &String = $read;
                Frozen::text(read(self))
            }

            fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
                let make: fn(String) -> Self = $make;
                frozen.as_text().map(|text| make(text.to_owned()))
            }
        }
    )*};
}
texts!(String: |text| text, |text| text; Choice: |choice| &choice.0, Choice; FilePath: |path| &path.0, FilePath);

fn exactly<const N: usize>(frozen: &Frozen) -> Result<[f64; N], ThawError> {
    let numbers = frozen.numbers()?;
    numbers.try_into().map_err(|_| ThawError(format!("it holds {} numbers in place of {N}", numbers.len())))
}

impl Freeze for Vector {
    fn freeze(&self) -> Frozen {
        Frozen::Numbers(self.0.to_vec())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        exactly(frozen).map(Self)
    }
}

impl Freeze for Colour {
    fn freeze(&self) -> Frozen {
        Frozen::Numbers(self.0.to_vec())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        exactly(frozen).map(Self)
    }
}

impl Freeze for Strokes {
    fn freeze(&self) -> Frozen {
        let point = |p: &StrokePoint| Frozen::Numbers(std::iter::once(p.x).chain([p.y]).chain(p.pressure).collect());
        let stroke = |stroke: &Stroke| {
            Frozen::record([
                ("name", Frozen::text(&stroke.name)),
                ("closed", Frozen::Boolean(stroke.closed)),
                ("points", Frozen::List(stroke.points.iter().map(point).collect())),
            ])
        };
        Frozen::List(self.0.iter().map(stroke).collect())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let point = |frozen: &Frozen| match frozen.numbers()? {
            [x, y] => Ok(StrokePoint { x: *x, y: *y, pressure: None }),
            [x, y, pressure] => Ok(StrokePoint { x: *x, y: *y, pressure: Some(*pressure) }),
            other => Err(ThawError(format!("a point has {} numbers; give two, and the pressure", other.len()))),
        };
        let stroke = |frozen: &Frozen| {
            Ok(Stroke {
                name: frozen.field("name")?.as_text()?.to_owned(),
                closed: frozen.field("closed")?.boolean()?,
                points: frozen.field("points")?.list()?.iter().map(point).collect::<Result<_, _>>()?,
            })
        };
        frozen.list()?.iter().map(stroke).collect::<Result<_, _>>().map(Self)
    }
}
