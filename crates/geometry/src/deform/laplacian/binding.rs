//! A mesh bound to its handles: both systems factored, to be solved wherever the handles go.

use std::sync::{Arc, OnceLock};

use glam::{DMat3, DVec3};

use super::error::{BindError, DeformError, REGION};
use super::handle::{HandleTransform, Holds};
use super::implicit::Implicit;
use super::influence::Influence;
use super::options::{BindOptions, BindReport, DeformOptions, Deformed, Features, Handle, Passes};
use super::patch::{Holder, Patch};
use super::polar::{nearest_rotation, uniform_scale};
use super::reconstruct::Reconstruct;
use super::repeat::Repeated;
use super::stencil::Gradients;
use super::well_posed;
use super::winding::Winding;
use crate::linear_solver::LinearSolverError;
use crate::mesh::select::Selection;
use crate::mesh::{Mesh, measure};

/// Angle between two handles' rotations, radians, from which on they are interpolated: near 180 degrees the first system
/// finds gradients that flatten.
const WINDING: f64 = 175.0 * std::f64::consts::PI / 180.0;

/// Passes of the second system behind interpolated rotations, which know nothing of where the handles went.
const PASSES_AFTER_WINDING: usize = 4;

/// A mesh bound to its handles. What it costs is settled by the region: the rest of the mesh is only copied.
#[derive(Debug)]
pub struct Binding {
    mesh: Arc<Mesh>,
    /// Vertices and kind of each handle; contested ones are in the last only.
    handles: Vec<(Vec<u32>, Holds)>,
    patch: Patch,
    /// None where no vertex is free.
    systems: Option<Systems>,
    /// Made when handles first wind.
    winding: OnceLock<Result<Winding, LinearSolverError>>,
    diagonal: f64,
    report: BindReport,
}

#[derive(Debug)]
struct Systems {
    implicit: Implicit,
    reconstruct: Reconstruct,
    /// What handles do by the first system, made when they first move; None where solving each time is cheaper.
    influence: OnceLock<Option<Result<Influence, DeformError>>>,
}

impl Binding {
    /// Binds a mesh: assembles and factors both systems.
    ///
    /// Free to move are the vertices of `region` (those with a weight of 0.5 or more; all of them without a region), but
    /// for those whose position a handle holds; vertices of no polygon never are. All others stay where they are and hold
    /// what is free as a handle does that is not moved. Where handles overlap, the last one has the vertices.
    ///
    /// `progress` is called with the fraction done; binding stops where it answers `false`.
    ///
    /// # Errors
    /// [`BindError`] for selections of another mesh, handles without vertices, a region that is not a 2-manifold or that
    /// has no area somewhere, and parts of it with too little held: each connected part needs a position and a gradient,
    /// or four positions that are not in one plane.
    pub fn new(
        mesh: Arc<Mesh>,
        region: Option<&Selection>,
        handles: &[Handle<'_>],
        options: &BindOptions,
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Self, BindError> {
        let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(BindError::Stopped) };
        go_on(0.0)?;
        let vertices = mesh.positions().len();
        let fits = |selection: &Selection, what: &dyn Fn() -> String| match selection.weights().len() {
            found if found == vertices => Ok(()),
            found => Err(BindError::WrongSelection { what: what(), found, vertices }),
        };
        if let Some(region) = region {
            fits(region, &|| REGION.to_owned())?;
        }
        let mut owner = vec![usize::MAX; vertices];
        let mut contested = 0;
        for (index, handle) in handles.iter().enumerate() {
            fits(handle.selection, &|| format!("selection of handle {index}"))?;
            let chosen = handle.selection.vertices();
            if chosen.is_empty() {
                return Err(BindError::EmptyHandle { handle: index });
            }
            for vertex in chosen {
                contested += usize::from(owner[vertex as usize] != usize::MAX);
                owner[vertex as usize] = index;
            }
        }
        let mut lists: Vec<(Vec<u32>, Holds)> = handles.iter().map(|h| (Vec::new(), h.holds)).collect();
        for (vertex, index) in owner.iter().enumerate() {
            if let Some((list, _)) = lists.get_mut(*index) {
                list.push(vertex as u32);
            }
        }
        go_on(0.02)?;
        let in_region = |vertex: usize| region.is_none_or(|r| r.contains(vertex));
        let patch = Patch::new(&mesh, &in_region, &lists)?;
        well_posed::check(&patch)?;
        go_on(0.1)?;
        let mut report = BindReport { free: patch.free, contested, ..BindReport::default() };
        let systems = if patch.free == 0 {
            None
        } else {
            let (weights, areas) = patch.weights();
            let gradients = Gradients::new(&patch)?;
            let part = |from: f64, to: f64| move |done: f64| progress(from + (to - from) * done);
            let implicit = Implicit::new(&patch, gradients, &weights, &areas, &part(0.15, 0.8))?;
            let reconstruct = Reconstruct::new(&patch, options.reconstruction, &weights, &areas, &part(0.8, 1.0))?;
            (report.degenerate, report.widened) = implicit.degenerate();
            report.factor_bytes = implicit.bytes() + reconstruct.bytes();
            report.influence_bytes = Influence::bytes(&patch, &implicit, handles.len()).unwrap_or(0);
            Some(Systems { implicit, reconstruct, influence: OnceLock::new() })
        };
        let diagonal = measure::points_diagonal(&patch.points);
        Ok(Self { mesh, handles: lists, patch, systems, winding: OnceLock::new(), diagonal, report })
    }

    /// What binding found.
    pub fn report(&self) -> BindReport {
        self.report
    }

    /// The mesh that is bound.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// Positions of all vertices for one transform a handle, by the first system alone: quick, for as long as a handle is
    /// dragged; large turns shear. Handles that wind turn by the shorter way round.
    ///
    /// With up to 16 handles, the first call solves for what each handle does, and those after it only add up.
    ///
    /// # Errors
    /// [`DeformError`] for another number of transforms, and for those that are not finite, mirror or flatten.
    pub fn drag(&self, transforms: &[HandleTransform]) -> Result<Vec<DVec3>, DeformError> {
        let moved = self.moved(transforms)?;
        let Some(systems) = &self.systems else { return Ok(self.positions(transforms, &[])) };
        let displacements = self.implicitly(systems, transforms, &moved)?;
        let prescribed = |vertex: usize| moved.gradient(&self.patch, vertex) - DMat3::IDENTITY;
        let points = systems.implicit.undisplace(&self.patch, &displacements, &prescribed);
        Ok(self.positions(transforms, &points))
    }

    /// Positions of all vertices for one transform a handle, whose Laplacian coordinates are those of the mesh at rest,
    /// not turned along: plain Laplacian editing, by the second system alone. Detail keeps its direction where the surface
    /// turns, and bends collapse; this is there to be compared with.
    ///
    /// # Errors
    /// [`DeformError`] as [`Binding::drag`].
    pub fn without_turning(&self, transforms: &[HandleTransform]) -> Result<Vec<DVec3>, DeformError> {
        self.moved(transforms)?;
        let Some(systems) = &self.systems else { return Ok(self.positions(transforms, &[])) };
        let mut displacements = self.held(transforms);
        let still = vec![DMat3::IDENTITY; self.patch.len()];
        systems.reconstruct.solve(&self.patch, &still, &mut displacements)?;
        let points: Vec<DVec3> = self.patch.points.iter().zip(&displacements).map(|(p, u)| *p + *u).collect();
        Ok(self.positions(transforms, &points))
    }

    /// The mesh for one transform a handle. Normals turn along; one that would look away from its polygon becomes the
    /// polygon's.
    ///
    /// `progress` is called with the fraction done.
    ///
    /// # Errors
    /// [`DeformError`] as [`Binding::drag`], and [`DeformError::Stopped`] where `progress` answers `false`.
    pub fn deform(
        &self,
        transforms: &[HandleTransform],
        options: &DeformOptions,
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Deformed, DeformError> {
        let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(DeformError::Stopped) };
        go_on(0.0)?;
        let moved = self.moved(transforms)?;
        let Some(systems) = &self.systems else {
            let mesh = self.finished(transforms, &[], &[])?;
            return Ok(Deformed { mesh, passes: 0, last_move: 0.0, wound: false });
        };
        let patch = &self.patch;
        let wound = self.winds(transforms);
        let scales = match options.features {
            Features::Keep => false,
            Features::Scale => true,
            Features::Automatic => !transforms.iter().all(HandleTransform::is_rigid),
        };
        let prescribed = |vertex: usize| moved.gradient(patch, vertex);
        let gradients = if wound {
            self.interpolated(transforms, &moved)?
        } else {
            let displacements = self.implicitly(systems, transforms, &moved)?;
            let less = |vertex: usize| prescribed(vertex) - DMat3::IDENTITY;
            let mut gradients = systems.implicit.gradients(&displacements, &less);
            gradients.iter_mut().for_each(|m| *m += DMat3::IDENTITY);
            gradients
        };
        go_on(0.4)?;
        let scale_of: Vec<f64> =
            if scales { gradients.iter().map(|m| uniform_scale(*m)).collect() } else { Vec::new() };
        let scale = |vertex: usize| if scales { scale_of[vertex] } else { 1.0 };
        let turned = without_shear(patch, gradients, &scale);
        go_on(0.5)?;
        let mut displacements = self.held(transforms);
        systems.reconstruct.solve(patch, &turned, &mut displacements)?;

        let (tolerance, most) = match options.passes {
            Passes::Once => (0.0, if wound { PASSES_AFTER_WINDING } else { 1 }),
            // Coordinates alone hold few turns together: repeated long enough, what was wound unwinds.
            Passes::Converged { tolerance, most } if wound && !systems.reconstruct.lowers_energy() => {
                (tolerance, most.clamp(1, PASSES_AFTER_WINDING))
            }
            Passes::Converged { tolerance, most } => (tolerance, most.max(1)),
        };
        let pass = |displacements: &mut [DVec3]| {
            let mut turned = systems.reconstruct.rotations(patch, displacements, &prescribed);
            let energy = systems.reconstruct.energy(patch, &turned, displacements);
            for (vertex, turn) in turned.iter_mut().enumerate().filter(|(v, _)| patch.gradient[*v].is_none()) {
                *turn *= scale(vertex);
            }
            systems.reconstruct.solve(patch, &turned, displacements).map(|()| energy)
        };
        // Only edges have an energy that every plain pass lowers, by which a guess is judged.
        let guesses =
            matches!(options.passes, Passes::Converged { .. }) && systems.reconstruct.lowers_energy() && !scales;
        let mut repeated = Repeated::new(tolerance * self.diagonal, most, guesses);
        repeated.run(&mut displacements, patch.free, &pass, &|fraction| go_on(0.5 + 0.5 * fraction))?;
        let last_move = if self.diagonal > 0.0 { repeated.last_move / self.diagonal } else { 0.0 };
        let passes = repeated.passes;
        let points: Vec<DVec3> = patch.points.iter().zip(&displacements).map(|(p, u)| *p + *u).collect();
        // Only normals ask how the surface turned in the end.
        let turns = match self.mesh.normals() {
            Some(_) => systems.reconstruct.rotations(patch, &displacements, &prescribed),
            None => Vec::new(),
        };
        let mesh = self.finished(transforms, &points, &turns)?;
        Ok(Deformed { mesh, passes, last_move, wound })
    }

    fn moved(&self, transforms: &[HandleTransform]) -> Result<Moved, DeformError> {
        if transforms.len() != self.handles.len() {
            return Err(DeformError::WrongCount { found: transforms.len(), handles: self.handles.len() });
        }
        for (handle, transform) in transforms.iter().enumerate() {
            transform.check().map_err(|source| DeformError::Handle { handle, source })?;
        }
        Ok(Moved { linear: transforms.iter().map(HandleTransform::linear).collect() })
    }

    /// Displacements of the patch by the first system.
    fn implicitly(
        &self,
        systems: &Systems,
        transforms: &[HandleTransform],
        moved: &Moved,
    ) -> Result<Vec<DVec3>, DeformError> {
        let Systems { implicit, influence, .. } = systems;
        let (patch, handles) = (&self.patch, self.handles.len());
        let mut displacements = self.held(transforms);
        let made = influence.get_or_init(|| {
            Influence::bytes(patch, implicit, handles).map(|_| Influence::new(patch, implicit, handles))
        });
        match made {
            Some(Ok(influence)) => {
                let shift_of = |handle: usize, point: DVec3| transforms[handle].apply(point) - point;
                influence.apply(&moved.linear, &shift_of, &mut displacements);
                if !displacements.iter().all(|u| u.is_finite()) {
                    return Err(DeformError::Overflow);
                }
            }
            Some(Err(error)) => return Err(error.clone()),
            None => {
                let prescribed = |vertex: usize| moved.gradient(patch, vertex) - DMat3::IDENTITY;
                implicit.solve(patch, &mut displacements, &prescribed)?;
            }
        }
        Ok(displacements)
    }

    /// Displacements of the held vertices of the patch; 0 for the free ones.
    fn held(&self, transforms: &[HandleTransform]) -> Vec<DVec3> {
        let of = |(vertex, point): (usize, &DVec3)| match self.patch.position[vertex] {
            Some(Holder::Handle(handle)) => transforms[handle].apply(*point) - *point,
            Some(Holder::Still) | None => DVec3::ZERO,
        };
        self.patch.points.iter().enumerate().map(of).collect()
    }

    /// Whether two of those that hold gradients turn by about 180 degrees or more against each other.
    fn winds(&self, transforms: &[HandleTransform]) -> bool {
        let mut holders = vec![false; self.handles.len()];
        let mut turns = Vec::new();
        for holder in self.patch.gradient.iter().flatten() {
            match holder {
                Holder::Still if turns.is_empty() => turns.push(DVec3::ZERO),
                Holder::Still => {}
                Holder::Handle(handle) => holders[*handle] = true,
            }
        }
        turns.extend(transforms.iter().zip(&holders).filter(|(_, h)| **h).map(|(t, _)| t.rotation_vector()));
        turns.iter().enumerate().any(|(i, a)| turns[..i].iter().any(|b| a.distance(*b) > WINDING))
    }

    fn interpolated(&self, transforms: &[HandleTransform], moved: &Moved) -> Result<Vec<DMat3>, DeformError> {
        let Some(systems) = &self.systems else { return Ok(Vec::new()) };
        let made = self.winding.get_or_init(|| Winding::new(&self.patch, systems.reconstruct.weights()));
        let winding = made.as_ref().map_err(|error| DeformError::Solver(error.clone()))?;
        let held = |vertex: usize| match self.patch.gradient[vertex] {
            Some(Holder::Handle(handle)) => {
                let transform = &transforms[handle];
                (transform.rotation_vector(), transform.stretch().determinant().cbrt())
            }
            Some(Holder::Still) | None => (DVec3::ZERO, 1.0),
        };
        winding.gradients(&self.patch, &held, &|vertex| moved.gradient(&self.patch, vertex))
    }

    /// Positions of all vertices of the mesh, those of the patch given; without them only handles move.
    fn positions(&self, transforms: &[HandleTransform], patch: &[DVec3]) -> Vec<DVec3> {
        let mut positions = self.mesh.positions().to_vec();
        for ((vertices, holds), transform) in self.handles.iter().zip(transforms) {
            if *holds != Holds::Gradient {
                for vertex in vertices {
                    let position = &mut positions[*vertex as usize];
                    *position = transform.apply(*position);
                }
            }
        }
        for (vertex, point) in self.patch.vertices.iter().zip(patch).take(self.patch.free) {
            positions[*vertex as usize] = *point;
        }
        positions
    }

    fn finished(
        &self,
        transforms: &[HandleTransform],
        points: &[DVec3],
        rotations: &[DMat3],
    ) -> Result<Mesh, DeformError> {
        let positions = self.positions(transforms, points);
        let normals = self.mesh.normals().map(|normals| {
            let mut turns = vec![None; positions.len()];
            for ((vertices, holds), transform) in self.handles.iter().zip(transforms) {
                let turn = transform.linear().inverse().transpose();
                if *holds != Holds::Gradient {
                    vertices.iter().for_each(|v| turns[*v as usize] = Some(turn));
                }
            }
            for (vertex, turn) in self.patch.vertices.iter().zip(rotations).take(self.patch.free) {
                turns[*vertex as usize] = Some(*turn);
            }
            let corners = self.mesh.corners().iter().zip(normals);
            let mut turned: Vec<DVec3> =
                corners.map(|(v, n)| turns[*v as usize].map_or(*n, |turn| (turn * *n).normalize_or(*n))).collect();
            // Where a bend crowds the surface, a polygon may lie back farther than the vertex turned: it lends its own.
            for (polygon, corners) in self.mesh.polygons().enumerate() {
                if corners.iter().any(|v| turns[*v as usize].is_some()) {
                    let own = measure::vector_area(corners.iter().map(|v| positions[*v as usize]));
                    for corner in self.mesh.corner_range(polygon) {
                        if turned[corner].dot(own) <= 0.0 {
                            turned[corner] = own.normalize_or(turned[corner]);
                        }
                    }
                }
            }
            turned
        });
        self.mesh.with_positions(positions, normals).map_err(|_| DeformError::Overflow)
    }
}

/// What the handles prescribe.
struct Moved {
    linear: Vec<DMat3>,
}

impl Moved {
    /// The prescribed gradient at a vertex of the patch; the identity where none is.
    fn gradient(&self, patch: &Patch, vertex: usize) -> DMat3 {
        match patch.gradient[vertex] {
            Some(Holder::Handle(handle)) => self.linear[handle],
            Some(Holder::Still) | None => DMat3::IDENTITY,
        }
    }
}

/// Rotations times scales in place of the gradients that are not prescribed (2.4.4).
fn without_shear(patch: &Patch, gradients: Vec<DMat3>, scale: &(dyn Fn(usize) -> f64 + Sync)) -> Vec<DMat3> {
    use rayon::prelude::*;
    let of = |(vertex, gradient): (usize, DMat3)| {
        if patch.gradient[vertex].is_some() || patch.ring[vertex] > 1 {
            return gradient;
        }
        nearest_rotation(gradient) * scale(vertex)
    };
    gradients.into_par_iter().enumerate().with_min_len(256).map(of).collect()
}
