//! The first and the last rail of a sheet, where another surface lies beyond them.

use glam::DVec3;

use super::feet::{Feet, Which};
use super::neighbour::{Across, Edge, Neighbour, end_slopes, in_plane};
use super::{GenerateError, Weights};
use crate::beam::OpenCardinals;
use crate::curve::Curve;

/// An outermost rail.
#[derive(Clone, Debug)]
pub(super) struct Side<'a> {
    pub(super) rail: &'a Curve,
    /// Arc lengths at which it meets the profiles.
    pub(super) crossings: &'a [f64],
    pub(super) neighbour: Neighbour<'a>,
    /// Whether it is the last one.
    pub(super) end: bool,
}

impl Side<'_> {
    /// Turns the field beside the rail so that the surface leaves the rail in the neighbour's direction.
    ///
    /// The field gets what its derivative across the rail lacks, times `t (1-t)^2` of its share `t`: that moves neither
    /// the rail nor the next one nor the slope there. What it lacks at the profiles, and its change there, is taken out
    /// by the cardinal functions, so that profiles and their tangents stay as they are: the joint is smooth at the
    /// corners where profiles and tangents given there lie in the neighbour's tangent plane.
    ///
    /// `columns` are the rail's column and the number of intervals to the next rail; `held` the sections of the profiles.
    pub(super) fn continue_neighbour(
        &self,
        rows: &mut [Vec<DVec3>],
        columns: (usize, usize),
        held: &[usize],
        functions: &OpenCardinals,
        warnings: &mut Vec<String>,
    ) -> Result<(), GenerateError> {
        let (column, count) = columns;
        let at = |j: usize| if self.end { column - j } else { column + j };
        // Derivatives across the field, away from the rail.
        let field = |row: &[DVec3]| -> Vec<DVec3> { (0..=count).map(|j| row[at(j)]).collect() };
        let profiles: Vec<Vec<DVec3>> = held.iter().map(|section| field(&rows[*section])).collect();
        let feet = Feet {
            points: profiles.iter().map(|profile| profile[0]).collect(),
            offsets: self.crossings.to_vec(),
            origin: 0.0,
            gaps: Vec::new(),
        };
        let edge = Edge::new(self.neighbour, self.rail, Which::Start, &feet, (Across::Profile, &profiles), warnings)?;
        let mut span = 0;
        let (mut lacks, mut axes) = (Vec::with_capacity(rows.len()), Vec::with_capacity(rows.len()));
        for (i, row) in rows.iter().enumerate() {
            while i > held[span + 1] {
                span += 1;
            }
            let field = field(row);
            let share = (i - held[span]) as f64 / (held[span + 1] - held[span]) as f64;
            let offset = self.crossings[span] * (1.0 - share) + self.crossings[span + 1] * share;
            let wanted = edge.tangent([span, span + 1], Weights::Smooth.at(share), offset, &field)?;
            lacks.push(wanted - end_slopes(&field)[0]);
            axes.push(edge.axes(offset, field[0])?);
        }
        // What is to stay at the profiles: first as far as it lies in the tangent plane, taken along with the plane, so
        // that the joint stays smooth between them; then the rest, which is small where all tangents fit.
        let last = rows.len() - 1;
        let mut rest = lacks;
        for in_the_plane in [true, false] {
            let slopes = end_slopes(&rest);
            let at_profiles = held.iter().map(|section| (*section, rest[*section]));
            let known: Vec<(usize, DVec3)> = at_profiles.chain([(0, slopes[0]), (last, slopes[1])]).collect();
            for (function, (section, value)) in functions.positions().iter().chain(functions.tangents()).zip(known) {
                let [a, b] = in_plane(value, axes[section]);
                for ((lack, weight), [along, across]) in rest.iter_mut().zip(function).zip(&axes) {
                    let there = if in_the_plane { *along * a + *across * b } else { value };
                    *lack -= there * *weight;
                }
            }
        }
        for section in held {
            rest[*section] = DVec3::ZERO;
        }
        for (row, lack) in rows.iter_mut().zip(rest) {
            for j in 1..count {
                let t = j as f64 / count as f64;
                row[at(j)] += lack * (t * (1.0 - t) * (1.0 - t));
            }
        }
        Ok(())
    }
}
