//! The same surface from fewer numbers: less harmonics, or less sections.

use glam::DVec3;

use super::angles::Angles;
use super::blend::Along;
use super::error::SurfaceError;
use super::solve::EndRows;
use super::surface::{AnalyticSurface, Plan, distances};

impl AnalyticSurface {
    /// The surface with its harmonics above `harmonics` left out of every section, which is the series of that many
    /// harmonics nearest to each in the mean square over v. Surfaces that share a section still do, with the same
    /// tangents there. Unchanged where it has no more.
    ///
    /// # Errors
    /// [`SurfaceError::OutOfRange`] for 0 harmonics; [`SurfaceError::SeveralPieces`] where the surface is open or of
    /// several patches.
    pub fn with_harmonics(&self, harmonics: usize) -> Result<Self, SurfaceError> {
        if harmonics == 0 {
            let most = self.harmonics();
            return Err(SurfaceError::OutOfRange { what: "harmonics", asked: 0, least: 1, most });
        }
        if harmonics >= self.harmonics() {
            return Ok(self.clone());
        }
        let angles = self.angles();
        let [piece] = angles.pieces[..] else { return Err(SurfaceError::SeveralPieces) };
        if !angles.closed || piece.local {
            return Err(SurfaceError::SeveralPieces);
        }
        let (lanes, kept) = (angles.lanes(), 2 * harmonics + 1);
        let shorter = |rows: &[DVec3]| rows.chunks_exact(lanes).flat_map(|row| row[..kept].iter().copied()).collect();
        let pieces = vec![super::Piece { harmonics, ..piece }];
        Self::solved(Plan {
            angles: Angles { pieces, closed: true },
            sections: shorter(self.section_rows()),
            knots: self.section_parameters().to_vec(),
            ends: self.end_rows().each_ref().map(|end| EndRows {
                slope: end.slope.as_deref().map(shorter),
                second: end.second.as_deref().map(shorter),
                natural: end.natural,
            }),
            polynomial: matches!(self.along(), Along::Polynomial { .. }),
            warnings: self.warnings().to_vec(),
        })
    }

    /// The surface through `count` of its sections, the first and the last among them, at the same u, with the same
    /// blend and derivatives at the ends. Sections inside that are poles stay. Unchanged where it has no more.
    ///
    /// One section after the other is left out: the one that the cubic through the next two on each side meets best, in
    /// the mean square over v.
    ///
    /// # Errors
    /// [`SurfaceError::OutOfRange`] where fewer are asked for than have to stay; others where those that stay make no
    /// surface.
    pub fn with_sections(&self, count: usize) -> Result<Self, SurfaceError> {
        let knots = self.section_parameters();
        let all = knots.len();
        let fixed = |k: usize| k == 0 || k + 1 == all || self.is_pole(k);
        let least = (0..all).filter(|k| fixed(*k)).count();
        if count < least {
            return Err(SurfaceError::OutOfRange { what: "sections", asked: count, least, most: all });
        }
        if count >= all {
            return Ok(self.clone());
        }
        let angles = self.angles();
        let lanes = angles.lanes();
        let row = |k: usize| &self.section_rows()[k * lanes..(k + 1) * lanes];
        let mut kept: Vec<usize> = (0..all).collect();
        while kept.len() > count {
            let candidates = (1..kept.len() - 1).filter(|place| !fixed(kept[*place]));
            let loss = |place: usize| {
                let from = place.saturating_sub(2);
                let others: Vec<usize> =
                    (from..(place + 3).min(kept.len())).filter(|k| *k != place).map(|k| kept[k]).collect();
                let mut missed = row(kept[place]).to_vec();
                let u = knots[kept[place]];
                for k in &others {
                    let weight: f64 = others
                        .iter()
                        .filter(|other| *other != k)
                        .map(|other| (u - knots[*other]) / (knots[*k] - knots[*other]))
                        .product();
                    missed.iter_mut().zip(row(*k)).for_each(|(sum, c)| *sum -= weight * *c);
                }
                angles.root_mean_square(&missed)
            };
            let losses = candidates.map(|place| (place, loss(place)));
            let Some((place, _)) = losses.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            kept.remove(place);
        }
        let sections: Vec<DVec3> = kept.iter().flat_map(|k| row(*k).iter().copied()).collect();
        distances(angles, &sections)?;
        Self::solved(Plan {
            angles: angles.clone(),
            sections,
            knots: kept.iter().map(|k| knots[*k]).collect(),
            ends: self.end_rows().clone(),
            polynomial: matches!(self.along(), Along::Polynomial { .. }),
            warnings: Vec::new(),
        })
    }
}
