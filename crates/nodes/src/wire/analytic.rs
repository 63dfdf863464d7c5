//! Wire types of sections and surfaces that are series.

use std::sync::Arc;

use maquette_geometry::sections;
use maquette_geometry::surface::analytic::AnalyticSurface;
use maquette_geometry::trigonometric::{EllipticSection, FitReport, Fitted};
use maquette_graph::{ContentHasher, Wire};

use super::{Sections, count, hash_points};

/// How well a section fits the curve it was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionFit {
    /// Mean distance between curve and section at the same angle, as a share of the diagonal (thesis 3.12, E_a).
    pub mean: f64,
    /// Largest such distance, as a share of the diagonal (thesis 3.13, E_m).
    pub maximum: f64,
    /// Diagonal of the box around the curve in the section's frame, metres.
    pub diagonal: f64,
    /// Whether the tolerances are met.
    pub met: bool,
    /// The point of the curve that is farthest from the section, metres.
    pub worst: glam::DVec3,
    /// Its angle, radians.
    pub worst_angle: f64,
    /// Its distance, metres.
    pub worst_distance: f64,
}

impl From<&FitReport> for SectionFit {
    fn from(report: &FitReport) -> Self {
        Self {
            mean: report.errors.mean,
            maximum: report.errors.maximum,
            diagonal: report.diagonal,
            met: report.met,
            worst: report.worst.point,
            worst_angle: report.worst.angle,
            worst_distance: report.worst.distance,
        }
    }
}

/// A section of a stack that is made of series.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedSection {
    /// The name of the curve it comes from, or where it was made.
    pub name: String,
    /// The section.
    pub section: EllipticSection,
    /// How well it fits; none where it is no fit but exact.
    pub fit: Option<SectionFit>,
}

impl NamedSection {
    /// A section that was fitted to a curve of that name.
    pub fn fitted(name: &str, fitted: &Fitted) -> Self {
        Self { name: name.to_owned(), section: fitted.section.clone(), fit: Some(SectionFit::from(&fitted.report)) }
    }
}

/// A stack of cross-sections as trigonometric series. Equal angles are the same place in all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct EllipticSections(pub Arc<Vec<NamedSection>>);

impl EllipticSections {
    /// Wraps sections in order.
    pub fn new(sections: Vec<NamedSection>) -> Self {
        Self(Arc::new(sections))
    }

    /// The sections alone, as surfaces take them.
    pub fn sections(&self) -> Vec<EllipticSection> {
        self.0.iter().map(|named| named.section.clone()).collect()
    }

    /// Stored constants of all sections.
    pub fn constants(&self) -> usize {
        self.0.iter().map(|named| named.section.constants()).sum()
    }
}

/// What a surface is made through: points, or series.
#[derive(Clone, Debug, PartialEq)]
pub enum CrossSections {
    /// Sections of corresponding points.
    Points(Sections),
    /// Sections that are series.
    Series(EllipticSections),
}

/// A surface through cross-sections.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// Through series, exact everywhere: one part, or several end to end that share their sections.
    Series(Vec<AnalyticSurface>),
    /// Through sections of points, as a mesh skins them.
    Points(Arc<sections::Sections>),
}

impl Surface {
    /// The parts end to end.
    ///
    /// # Errors
    /// A surface through points has none; the message says what to do.
    pub fn series(&self) -> Result<&[AnalyticSurface], String> {
        match self {
            Self::Series(parts) => Ok(parts),
            Self::Points(_) => {
                Err("this surface goes through sections of points and is known at its mesh only: put a \
                                    `fit-sections` node before it to make it exact everywhere"
                    .to_owned())
            }
        }
    }
}

fn hash_section(hasher: &mut ContentHasher, section: &EllipticSection) {
    let frame = section.frame();
    hash_points(hasher, &[frame.origin, frame.e1, frame.e2]);
    hasher.integer(u64::from(section.is_closed()));
    hasher.integer(section.segments().len() as u64);
    for segment in section.segments() {
        hasher.numbers(&[segment.from, segment.to]);
        hasher.integer(u64::from(segment.local));
        hasher.integer(segment.series.coefficients().len() as u64);
        hash_points(hasher, segment.series.coefficients());
    }
}

fn hash_sections(hasher: &mut ContentHasher, sections: &[NamedSection]) {
    hasher.integer(sections.len() as u64);
    for named in sections {
        hasher.text(&named.name);
        hash_section(hasher, &named.section);
        match &named.fit {
            None => hasher.integer(u64::MAX),
            Some(fit) => {
                hasher.integer(u64::from(fit.met));
                hash_points(hasher, &[fit.worst]);
                hasher.numbers(&[fit.mean, fit.maximum, fit.diagonal, fit.worst_angle, fit.worst_distance]);
            }
        }
    }
}

fn sections_bytes(sections: &[NamedSection]) -> usize {
    sections.iter().map(|named| size_of_val(named) + 8 * named.section.constants() + named.name.len()).sum()
}

impl Wire for EllipticSections {
    const NAME: &'static str = "elliptic-sections";
    const DESCRIPTION: &'static str =
        "A stack of cross-sections as trigonometric series (generalized ellipses, or segments of them): thesis 3.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hash_sections(hasher, &self.0);
    }

    fn byte_size(&self) -> usize {
        sections_bytes(&self.0)
    }

    fn summary(&self) -> String {
        format!("{}, {}", count(self.0.len(), "section", "sections"), count(self.constants(), "constant", "constants"))
    }
}

impl Wire for CrossSections {
    const NAME: &'static str = "cross-sections";
    const DESCRIPTION: &'static str =
        "What a surface goes through: sections of points, or sections that are trigonometric series.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        match self {
            Self::Points(points) => {
                hasher.integer(0);
                points.hash_content(hasher);
            }
            Self::Series(series) => {
                hasher.integer(1);
                series.hash_content(hasher);
            }
        }
    }

    fn byte_size(&self) -> usize {
        match self {
            Self::Points(points) => points.byte_size(),
            Self::Series(series) => series.byte_size(),
        }
    }

    fn summary(&self) -> String {
        match self {
            Self::Points(points) => points.summary(),
            Self::Series(series) => series.summary(),
        }
    }
}

impl Wire for Surface {
    const NAME: &'static str = "surface";
    const DESCRIPTION: &'static str =
        "A surface through cross-sections, one part or several end to end; `tessellate` makes it a mesh.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        match self {
            Self::Series(parts) => {
                hasher.integer(parts.len() as u64);
                for part in parts {
                    let numbers = part.numbers();
                    hasher.integer(numbers.len() as u64);
                    hasher.numbers(&numbers);
                }
            }
            Self::Points(points) => {
                hasher.integer(u64::MAX);
                Sections((**points).clone()).hash_content(hasher);
            }
        }
    }

    fn byte_size(&self) -> usize {
        match self {
            Self::Series(parts) => parts.iter().map(AnalyticSurface::bytes).sum(),
            Self::Points(points) => size_of_val(points.points()),
        }
    }

    fn summary(&self) -> String {
        match self {
            Self::Series(parts) => {
                let constants: usize = parts.iter().map(AnalyticSurface::constants).sum();
                let sections: usize = parts.iter().map(|part| part.section_parameters().len()).sum();
                let sections = count(sections, "section", "sections");
                format!(
                    "{}, {sections}, {}",
                    count(parts.len(), "part", "parts"),
                    count(constants, "constant", "constants")
                )
            }
            Self::Points(points) => {
                format!("through {}", count(points.len(), "section of points", "sections of points"))
            }
        }
    }
}
