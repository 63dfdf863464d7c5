//! What a view is to show, as plain data: the graphics card draws it when it differs from what is there.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::drawable::{Drawable, LineRole, Segment};

use super::camera::{Camera, ViewSize};

/// How surfaces are looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shading {
    /// In their colours under soft light.
    #[default]
    Shaded,
    /// As a ball of clay.
    Matcap,
    /// Coloured by the direction of the normal; back faces red.
    Normals,
    /// Reflected stripes, which break where the surface is not smooth.
    Zebra,
    /// Bulges red, hollows blue.
    Curvature,
    /// Pale, with its outline coloured by how far it is from the sketches of the view.
    Silhouette,
    /// Flat faces with their edges: the mesh as it is written.
    Facets,
}

impl Shading {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 7] =
        [Self::Shaded, Self::Matcap, Self::Normals, Self::Zebra, Self::Curvature, Self::Silhouette, Self::Facets];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "Shaded",
            Self::Matcap => "Matcap",
            Self::Normals => "Normals",
            Self::Zebra => "Zebra",
            Self::Curvature => "Curvature",
            Self::Silhouette => "Silhouette",
            Self::Facets => "Facets",
        }
    }

    /// One line on what it is good for.
    pub fn description(self) -> &'static str {
        match self {
            Self::Shaded => "In their colours under soft light",
            Self::Matcap => "As clay under a window: shows forms",
            Self::Normals => "Coloured by direction; back faces are red",
            Self::Zebra => "Reflected stripes: where they break, the surface is not smooth",
            Self::Curvature => "Mean curvature: bulges red, hollows blue",
            Self::Silhouette => "The outline in each view, coloured by its distance from what was sketched there",
            Self::Facets => "Flat faces with their edges: the mesh as it is written",
        }
    }
}

/// A surface and how it is drawn.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceDraw {
    pub(crate) drawable: Arc<Drawable>,
    pub(crate) colour: [f32; 4],
    /// Colour of its edges; `None` where they are not drawn.
    pub(crate) wire: Option<[f32; 4]>,
    /// How strongly it is marked as selected, 0 to 1.
    pub(crate) mark: f32,
    /// Whether it lies over another surface at the same place.
    pub(crate) forward: bool,
}

/// Where lines come from.
#[derive(Clone, Debug)]
pub(crate) enum LineSource {
    /// Those of a drawable in one role.
    Drawable(Arc<Drawable>, LineRole),
    /// Lines of this picture alone.
    Own(Vec<Segment>),
}

/// Lines and how they are drawn.
#[derive(Clone, Debug)]
pub(crate) struct LineDraw {
    pub(crate) source: LineSource,
    pub(crate) colour: [f32; 4],
    /// Pixels.
    pub(crate) width: f32,
    /// Whether surfaces don't hide them.
    pub(crate) on_top: bool,
}

/// What the shaders know of a view.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct ViewUniform {
    view_projection: [[f32; 4]; 4],
    right: [f32; 4],
    up: [f32; 4],
    back: [f32; 4],
    eye: [f32; 4],
    size_shading: [f32; 4],
}

impl ViewUniform {
    #[expect(clippy::cast_precision_loss, reason = "sizes of windows")]
    pub(crate) fn new(camera: &Camera, size: ViewSize, pixels: [u32; 2], shading: Shading) -> Self {
        let [right, up, back] = camera.frame().map(|axis| axis.as_vec3().extend(0.0).to_array());
        let parallel = if camera.is_parallel() { 1.0 } else { 0.0 };
        Self {
            view_projection: camera.view_projection(size).as_mat4().to_cols_array_2d(),
            right,
            up,
            back,
            eye: camera.eye().as_vec3().extend(1.0).to_array(),
            size_shading: [pixels[0] as f32, pixels[1] as f32, f32::from(shading as u8), parallel],
        }
    }
}

/// Everything one view shows.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    /// The view it belongs to.
    pub(crate) view: u64,
    /// Pixels, neither zero.
    pub(crate) size: [u32; 2],
    pub(crate) uniform: ViewUniform,
    /// 4 for smooth edges, 1 for speed.
    pub(crate) samples: u32,
    pub(crate) surfaces: Vec<SurfaceDraw>,
    /// Drawn in this order.
    pub(crate) lines: Vec<LineDraw>,
}

impl Picture {
    /// A number that is the same for pictures that look alike.
    pub(crate) fn key(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.size.hash(&mut hasher);
        self.samples.hash(&mut hasher);
        hasher.write(bytemuck::bytes_of(&self.uniform));
        for surface in &self.surfaces {
            surface.drawable.id.hash(&mut hasher);
            hasher.write(bytemuck::bytes_of(&surface.colour));
            surface.wire.is_some().hash(&mut hasher);
            hasher.write(bytemuck::bytes_of(&surface.wire.unwrap_or_default()));
            surface.mark.to_bits().hash(&mut hasher);
            surface.forward.hash(&mut hasher);
        }
        for line in &self.lines {
            match &line.source {
                LineSource::Drawable(drawable, role) => (drawable.id, *role as u8).hash(&mut hasher),
                LineSource::Own(segments) => {
                    segments.len().hash(&mut hasher);
                    hasher.write(bytemuck::cast_slice(segments));
                }
            }
            hasher.write(bytemuck::bytes_of(&line.colour));
            line.width.to_bits().hash(&mut hasher);
            line.on_top.hash(&mut hasher);
        }
        hasher.finish()
    }
}
