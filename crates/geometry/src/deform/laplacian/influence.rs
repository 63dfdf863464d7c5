//! What each handle does to the free vertices by the first system, solved once: dragging then only adds up.

use std::mem::size_of;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::error::DeformError;
use super::implicit::Implicit;
use super::patch::{Holder, Patch};

/// Most handles whose influence is solved for: beyond, one solve a frame is cheaper than all of these before the first.
const MOST_HANDLES: usize = 16;

/// The displacements of the free vertices as a function of how the handles move.
///
/// The first system is linear, and its right-hand side knows each handle by the twelve numbers of its affine map less the
/// identity: `u = (A - 1) (p - c) + s`, with the shift `s` of a fixed point `c`. All three coordinates have the same
/// matrix, so that four fields a handle say all: those that `x`, `y`, `z` of `p - c` bring about, and that of 1.
#[derive(Debug)]
pub(super) struct Influence {
    /// The fixed point: in the middle, so that far from the origin nothing cancels.
    centre: DVec3,
    /// By handle.
    fields: Vec<Field>,
}

/// By free vertex: metres, and without unit.
type Field = Vec<(DVec3, f64)>;

impl Influence {
    /// The bytes it takes, where it pays: for few handles, whose fields take no more room than the factor.
    pub fn bytes(patch: &Patch, implicit: &Implicit, handles: usize) -> Option<usize> {
        let bytes = handles * patch.free * size_of::<(DVec3, f64)>();
        ((1..=MOST_HANDLES).contains(&handles) && bytes <= implicit.bytes()).then_some(bytes)
    }

    pub fn new(patch: &Patch, implicit: &Implicit, handles: usize) -> Result<Self, DeformError> {
        let centre = patch.points.iter().sum::<DVec3>() / patch.points.len().max(1) as f64;
        let is = |holder: &Option<Holder>, handle: usize| *holder == Some(Holder::Handle(handle));
        // A field of vectors for the linear part of each handle; those of the shifts, numbers, three in one.
        let shifts = handles.div_ceil(3);
        let mut problems: Vec<Vec<DVec3>> = Vec::with_capacity(handles + shifts);
        for handle in 0..handles {
            let of =
                |(holder, p): (&Option<Holder>, &DVec3)| if is(holder, handle) { *p - centre } else { DVec3::ZERO };
            problems.push(patch.position.iter().zip(&patch.points).map(of).collect());
        }
        for first in (0..handles).step_by(3) {
            let of = |holder: &Option<Holder>| DVec3::from([0, 1, 2].map(|k| f64::from(is(holder, first + k))));
            problems.push(patch.position.iter().map(of).collect());
        }
        let prescribed = |problem: usize, vertex: usize| {
            if problem < handles && is(&patch.gradient[vertex], problem) { DMat3::IDENTITY } else { DMat3::ZERO }
        };
        implicit.solve_all(patch, &mut problems, &prescribed)?;
        let (linear, shift) = problems.split_at(handles);
        let fields = (0..handles)
            .map(|handle| {
                let numbers = shift[handle / 3][..patch.free].iter().map(|s| s[handle % 3]);
                linear[handle][..patch.free].iter().copied().zip(numbers).collect()
            })
            .collect();
        Ok(Self { centre, fields })
    }

    /// Displacements of the free vertices, put in their places, where the handles map by `linear` and shift the centre by
    /// what `shift_of` gives for it.
    pub fn apply(&self, linear: &[DMat3], shift_of: &dyn Fn(usize, DVec3) -> DVec3, displacements: &mut [DVec3]) {
        let moved: Vec<(DMat3, DVec3, &Field)> = (0..self.fields.len())
            .map(|handle| (linear[handle] - DMat3::IDENTITY, shift_of(handle, self.centre), &self.fields[handle]))
            .filter(|(linear, shift, _)| *linear != DMat3::ZERO || *shift != DVec3::ZERO)
            .collect();
        let of = |(vertex, displacement): (usize, &mut DVec3)| {
            let parts = moved.iter().map(|(linear, shift, field)| {
                let (vector, number) = field[vertex];
                *linear * vector + *shift * number
            });
            *displacement = parts.sum();
        };
        let free = self.fields.first().map_or(0, Vec::len);
        displacements[..free].par_iter_mut().enumerate().with_min_len(4096).for_each(of);
    }
}
