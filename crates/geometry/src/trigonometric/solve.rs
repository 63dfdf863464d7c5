//! One section from its samples: how many harmonics, and which.

use super::composite::{Layout, Problem, Solved};
use super::error::FitError;
use super::least_squares::Nested;
use super::options::{LocalAngles, Solution};
use super::order_search::{Errors, Tolerances, smallest_harmonics};
use super::samples::Samples;
use super::section::EllipticSegment;
use super::series::{Series, SeriesError};
use glam::DVec3;
use nalgebra::DMatrix;

/// Harmonics factored at first: the greater of the two with which the search begins.
const PROBED: usize = 10;

/// Condition number, as estimated, beyond which no more harmonics are tried: coefficients then are so large that half of
/// the digits go.
const WORST_CONDITION: f64 = 1e8;
/// Share of its error before one harmonic more, above which that harmonic hardly helped a segment.
const STALLED: f64 = 0.7;

/// A curve with the angles of its samples.
pub(super) struct Prepared {
    pub(super) samples: Samples,
    pub(super) angles: Vec<f64>,
    /// Offsets of the samples from the origin of the frame, as shares of the diagonal.
    pub(super) right: DMatrix<f64>,
    pub(super) tolerances: Tolerances,
    /// Turn at each sample, where corners matter.
    pub(super) turns: Vec<f64>,
}

/// How many harmonics each segment gets.
#[derive(Clone, Debug)]
pub(super) enum Goal {
    Smallest { most: usize },
    Given(Vec<usize>),
}

/// How a section is solved.
#[derive(Clone, Copy)]
pub(super) struct Method {
    pub(super) solution: Solution,
    pub(super) local_angles: LocalAngles,
}

/// A solved section in units of its diagonal about the origin of its frame.
pub(super) struct Outcome {
    pub(super) solved: Solved,
    pub(super) harmonics: Vec<usize>,
    pub(super) met: bool,
}

impl Outcome {
    pub(super) fn local(&self) -> Vec<bool> {
        self.solved.segments.iter().map(|segment| segment.local).collect()
    }
}

/// Errors of some distances, themselves in units of the diagonal.
pub(super) fn errors(distances: impl ExactSizeIterator<Item = f64>) -> Errors {
    let count = distances.len().max(1);
    let (sum, maximum) = distances.fold((0.0, 0.0), |(s, m): (f64, f64), d| (s + d, m.max(d)));
    Errors { mean: sum / count as f64, maximum }
}

/// Solves a section. `local` forces the choice of local angles.
pub(super) fn solve(
    prepared: &Prepared,
    layout: &Layout,
    goal: &Goal,
    method: Method,
    local: Option<&[bool]>,
) -> Result<Outcome, FitError> {
    let section = Section::new(prepared, layout, method, local);
    section.check(goal)?;
    let solved = if layout.count() == 1 && layout.joins[0].is_none() {
        section.single(goal)
    } else if method.solution == Solution::InTurn && layout.count() > 1 {
        return section.in_turn(goal);
    } else {
        section.together(goal)
    };
    solved.map_err(|source| section.not_finite(source))
}

struct Section<'a> {
    prepared: &'a Prepared,
    layout: &'a Layout,
    method: Method,
    local: Option<&'a [bool]>,
    samples: Vec<Vec<(usize, f64)>>,
}

impl<'a> Section<'a> {
    fn new(prepared: &'a Prepared, layout: &'a Layout, method: Method, local: Option<&'a [bool]>) -> Self {
        Self { prepared, layout, method, local, samples: layout.assign(&prepared.angles) }
    }

    fn name(&self) -> String {
        self.prepared.samples.name.clone()
    }

    fn not_finite(&self, source: SeriesError) -> FitError {
        FitError::NotFinite { curve: self.name(), source }
    }

    fn problem(&self) -> Problem<'_> {
        Problem { layout: self.layout, samples: &self.samples, right: &self.prepared.right }
    }

    fn is_local(&self, segment: usize, harmonics: usize) -> bool {
        match self.local {
            Some(local) => local[segment],
            None => self.layout.local(segment, harmonics, self.method.local_angles),
        }
    }

    /// Most harmonics the search tries in a segment: beyond a quarter of the samples a series may swing between them,
    /// and where the basis is too ill-conditioned, joints are met only to the rounding of huge coefficients.
    fn most(&self, segment: usize, most: usize) -> usize {
        let fewest = self.layout.fewest_harmonics(segment);
        let most = most.min((self.samples[segment].len().saturating_sub(1)) / 4);
        let usable = |j: &usize| self.layout.condition(segment, *j, self.is_local(segment, *j)) <= WORST_CONDITION;
        (fewest..=most).rev().find(usable).unwrap_or(fewest)
    }

    fn check(&self, goal: &Goal) -> Result<(), FitError> {
        for segment in 0..self.layout.count() {
            let points = self.samples[segment].len();
            let needed = self.layout.fewest_harmonics(segment);
            // Each harmonic that ties fix needs no sample.
            let unknowns = |harmonics: usize| 2 * harmonics + 1;
            let ties = if self.layout.joins.iter().any(Option::is_some) { 2 * needed - 1 } else { 0 };
            match goal {
                Goal::Given(harmonics) if harmonics[segment] < needed => {
                    return Err(FitError::TooFewHarmonics { segment, harmonics: harmonics[segment], needed });
                }
                Goal::Given(harmonics) if unknowns(harmonics[segment]) > points + ties => {
                    return Err(FitError::TooManyHarmonics {
                        curve: self.name(),
                        harmonics: harmonics[segment],
                        unknowns: unknowns(harmonics[segment]),
                        points,
                        most: (points + ties).saturating_sub(1) / 2,
                    });
                }
                Goal::Smallest { most } if needed > (*most).max(1) => {
                    return Err(FitError::TooFewHarmonics { segment, harmonics: *most, needed });
                }
                Goal::Smallest { .. } if unknowns(needed) > points => {
                    let (from, to) = (self.layout.ends[segment], self.layout.ends[segment + 1]);
                    let (curve, needed) = (self.name(), unknowns(needed));
                    return Err(FitError::SegmentTooShort { curve, from, to, points, needed });
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// One series: the factorization of the most harmonics serves all others.
    fn single(&self, goal: &Goal) -> Result<Outcome, SeriesError> {
        let most = match goal {
            Goal::Given(harmonics) => harmonics[0],
            Goal::Smallest { most } => self.most(0, *most),
        };
        let (angles, right) = (&self.prepared.angles, &self.prepared.right);
        let mut nested = Nested::new(angles, most.min(PROBED), right.clone());
        let mut solved = |harmonics: usize| {
            if harmonics > nested.most() {
                nested = Nested::new(angles, most, right.clone());
            }
            let solution = nested.solve(harmonics);
            let residuals = nested.residuals(&solution);
            let distances: Vec<f64> = residuals.row_iter().map(|row| row.norm()).collect();
            (solution, distances)
        };
        let tolerances = self.prepared.tolerances;
        let harmonics = match goal {
            Goal::Given(harmonics) => harmonics[0],
            Goal::Smallest { .. } => {
                smallest_harmonics(tolerances, most, |j| errors(solved(j).1.into_iter())).harmonics
            }
        };
        let (solution, distances) = solved(harmonics);
        let (from, to) = (self.layout.ends[0], self.layout.ends[1]);
        let series = super::composite::series(&solution)?;
        let met = tolerances.met_by(errors(distances.iter().copied()));
        let segments = vec![EllipticSegment { from, to, local: false, series }];
        Ok(Outcome { solved: Solved { segments, distances }, harmonics: vec![harmonics], met })
    }

    /// All segments in one problem. The search starts from the fewest harmonics and raises those of every segment that
    /// does not meet the tolerances by itself (and of its neighbours, where that hardly helps), then lowers each while all still do.
    fn together(&self, goal: &Goal) -> Result<Outcome, SeriesError> {
        let problem = self.problem();
        let solved = |harmonics: &[usize]| {
            let local: Vec<bool> = harmonics.iter().enumerate().map(|(s, j)| self.is_local(s, *j)).collect();
            problem.together(harmonics, &local)
        };
        let most = match goal {
            Goal::Given(harmonics) => {
                let solved = solved(harmonics)?;
                let met = self.met(&solved);
                return Ok(Outcome { solved, harmonics: harmonics.clone(), met });
            }
            Goal::Smallest { most } => *most,
        };
        let mut harmonics: Vec<usize> =
            (0..self.layout.count()).map(|s| self.layout.fewest_harmonics(s).max(2).min(self.most(s, most))).collect();
        let mut best = solved(&harmonics)?;
        let mut before = vec![f64::INFINITY; self.layout.count()];
        loop {
            let shares = self.shares(&best);
            let mut raised = vec![false; shares.len()];
            for (segment, share) in shares.iter().enumerate().filter(|(_, share)| **share > 1.0) {
                raised[segment] = true;
                // What more harmonics of its own hardly help is held off by its neighbours, through the joints.
                if *share > STALLED * before[segment] {
                    let count = shares.len();
                    raised[(segment + 1) % count] |= self.layout.closed || segment + 1 < count;
                    raised[(segment + count - 1) % count] |= self.layout.closed || segment > 0;
                }
            }
            let mut more = harmonics.clone();
            for (segment, harmonics) in more.iter_mut().enumerate().filter(|(segment, _)| raised[*segment]) {
                *harmonics = (*harmonics + 1).min(self.most(segment, most));
            }
            if more == harmonics {
                break;
            }
            (harmonics, before) = (more, shares);
            best = solved(&harmonics)?;
        }
        let met = self.met(&best);
        for segment in 0..self.layout.count() {
            while met && harmonics[segment] > self.layout.fewest_harmonics(segment) {
                let mut fewer = harmonics.clone();
                fewer[segment] -= 1;
                let tried = solved(&fewer)?;
                if !self.met(&tried) {
                    break;
                }
                (harmonics, best) = (fewer, tried);
            }
        }
        Ok(Outcome { solved: best, harmonics, met })
    }

    /// Errors of each segment by itself, as the larger share of its tolerance: at most 1 where it meets both.
    fn shares(&self, solved: &Solved) -> Vec<f64> {
        let tolerances = self.prepared.tolerances;
        let share = |samples: &Vec<(usize, f64)>| {
            let errors = errors(samples.iter().map(|(i, _)| solved.distances[*i]));
            (errors.mean / tolerances.mean).max(errors.maximum / tolerances.maximum)
        };
        self.samples.iter().map(share).collect()
    }

    fn met(&self, solved: &Solved) -> bool {
        self.shares(solved).into_iter().all(|share| share <= 1.0)
    }

    /// The first segment freely, each next tied to the one before, the last of a closed section to the first as well.
    fn in_turn(&self, goal: &Goal) -> Result<Outcome, FitError> {
        let problem = self.problem();
        let count = self.layout.count();
        let mut segments: Vec<EllipticSegment> = Vec::with_capacity(count);
        let mut harmonics = Vec::with_capacity(count);
        for segment in 0..count {
            let before = segment.checked_sub(1).map(|b| &segments[b]);
            let behind = if self.layout.closed && segment + 1 == count { segments.first() } else { None };
            let (mut j, most) = match goal {
                Goal::Given(harmonics) => (harmonics[segment], harmonics[segment]),
                Goal::Smallest { most } => (self.layout.fewest_harmonics(segment), self.most(segment, *most)),
            };
            let solved = loop {
                let found = problem
                    .tied(segment, j, self.is_local(segment, j), before, behind)
                    .map_err(|source| self.not_finite(source))?;
                let met = |distances: &Vec<f64>| self.prepared.tolerances.met_by(errors(distances.iter().copied()));
                match found {
                    Some((solved, distances)) if j >= most || met(&distances) => break solved,
                    None if j >= most => return Err(FitError::Contradiction { curve: self.name(), segment }),
                    _ => j += 1,
                }
            };
            segments.push(solved);
            harmonics.push(j);
        }
        let solved = problem.measured(segments);
        let met = self.met(&solved);
        Ok(Outcome { solved, harmonics, met })
    }
}

/// A segment moved from units of the diagonal about the origin of the frame to its place.
pub(super) fn placed(segment: EllipticSegment, origin: DVec3, diagonal: f64) -> Result<EllipticSegment, SeriesError> {
    let mut coefficients: Vec<DVec3> = segment.series.coefficients().iter().map(|c| *c * diagonal).collect();
    if let Some(constant) = coefficients.first_mut() {
        *constant += origin;
    }
    Ok(EllipticSegment { series: Series::new(coefficients)?, ..segment })
}
