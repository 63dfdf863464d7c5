//! Sections and surfaces that are series, as plain data.

use std::sync::Arc;

use maquette_geometry::surface::analytic::AnalyticSurface;
use maquette_geometry::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
use maquette_graph::freeze::{Freeze, Frozen, ThawError};

use super::{no_value, optional, points, thawed_points};
use crate::wire::{self, NamedSection, SectionFit};

fn numbers<const N: usize>(frozen: &Frozen) -> Result<[f64; N], ThawError> {
    frozen.numbers()?.try_into().map_err(|_| no_value(format!("{N} numbers are wanted")))
}

fn one_point(frozen: &Frozen) -> Result<glam::DVec3, ThawError> {
    match thawed_points(frozen)?.as_slice() {
        [point] => Ok(*point),
        _ => Err(no_value("one point is wanted")),
    }
}

fn freeze_section(section: &EllipticSection) -> Frozen {
    let segment = |segment: &EllipticSegment| {
        Frozen::record([
            ("range", Frozen::Numbers(vec![segment.from, segment.to])),
            ("local", Frozen::Boolean(segment.local)),
            ("coefficients", points(segment.series.coefficients())),
        ])
    };
    let frame = section.frame();
    Frozen::record([
        ("frame", points(&[frame.origin, frame.e1, frame.e2, frame.normal])),
        ("closed", Frozen::Boolean(section.is_closed())),
        ("segments", Frozen::List(section.segments().iter().map(segment).collect())),
    ])
}

fn thaw_section(frozen: &Frozen) -> Result<EllipticSection, ThawError> {
    let segment = |frozen: &Frozen| {
        let [from, to] = numbers(frozen.field("range")?)?;
        let series = Series::new(thawed_points(frozen.field("coefficients")?)?).map_err(no_value)?;
        Ok(EllipticSegment { from, to, local: frozen.field("local")?.boolean()?, series })
    };
    let [origin, e1, e2, normal] = thawed_points(frozen.field("frame")?)?
        .try_into()
        .map_err(|_| no_value("a frame has an origin and three directions"))?;
    let segments = frozen.field("segments")?.list()?.iter().map(segment).collect::<Result<_, ThawError>>()?;
    let frame = PlaneFrame { origin, e1, e2, normal };
    EllipticSection::new(frame, frozen.field("closed")?.boolean()?, segments).map_err(no_value)
}

fn freeze_fit(fit: &SectionFit) -> Frozen {
    Frozen::record([
        ("errors", Frozen::Numbers(vec![fit.mean, fit.maximum])),
        ("diagonal", Frozen::Number(fit.diagonal)),
        ("met", Frozen::Boolean(fit.met)),
        ("worst", points(&[fit.worst])),
        ("worst-angle-and-distance", Frozen::Numbers(vec![fit.worst_angle, fit.worst_distance])),
    ])
}

fn thaw_fit(frozen: &Frozen) -> Result<SectionFit, ThawError> {
    let [mean, maximum] = numbers(frozen.field("errors")?)?;
    let [worst_angle, worst_distance] = numbers(frozen.field("worst-angle-and-distance")?)?;
    Ok(SectionFit {
        mean,
        maximum,
        diagonal: frozen.field("diagonal")?.number()?,
        met: frozen.field("met")?.boolean()?,
        worst: one_point(frozen.field("worst")?)?,
        worst_angle,
        worst_distance,
    })
}

impl Freeze for wire::EllipticSections {
    fn freeze(&self) -> Frozen {
        let named = |named: &NamedSection| {
            Frozen::record([
                ("name", Frozen::text(&named.name)),
                ("section", freeze_section(&named.section)),
                ("fit", named.fit.as_ref().map_or(Frozen::Nothing, freeze_fit)),
            ])
        };
        Frozen::List(self.0.iter().map(named).collect())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        let named = |frozen: &Frozen| {
            Ok(NamedSection {
                name: frozen.field("name")?.as_text()?.to_owned(),
                section: thaw_section(frozen.field("section")?)?,
                fit: optional(frozen.field("fit")?, thaw_fit)?,
            })
        };
        frozen.list()?.iter().map(named).collect::<Result<_, ThawError>>().map(Self::new)
    }
}

impl Freeze for wire::CrossSections {
    fn freeze(&self) -> Frozen {
        match self {
            Self::Points(points) => Frozen::record([("points", points.freeze())]),
            Self::Series(series) => Frozen::record([("series", series.freeze())]),
        }
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        match frozen.field("points") {
            Ok(points) => wire::Sections::thaw(points).map(Self::Points),
            Err(_) => wire::EllipticSections::thaw(frozen.field("series")?).map(Self::Series),
        }
    }
}

impl Freeze for wire::Surface {
    fn freeze(&self) -> Frozen {
        match self {
            Self::Series(parts) => {
                let parts = parts.iter().map(|part| Frozen::Numbers(part.numbers()));
                Frozen::record([("series", Frozen::List(parts.collect()))])
            }
            Self::Points(points) => Frozen::record([("points", wire::Sections((**points).clone()).freeze())]),
        }
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        if let Ok(points) = frozen.field("points") {
            return Ok(Self::Points(Arc::new(wire::Sections::thaw(points)?.0)));
        }
        let part = |part: &Frozen| AnalyticSurface::from_numbers(part.numbers()?).map_err(no_value);
        frozen.field("series")?.list()?.iter().map(part).collect::<Result<_, _>>().map(Self::Series)
    }
}
