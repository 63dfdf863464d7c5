//! Drawables in the memory of the graphics card.

use std::ops::Range;
use std::sync::{Arc, Weak};

use eframe::wgpu;
use eframe::wgpu::util::DeviceExt as _;

use crate::drawable::{Drawable, LineRole, Segment};

/// Pieces of lines.
pub(super) struct LineBuffer {
    pub(super) buffer: wgpu::Buffer,
    pub(super) count: u32,
}

impl LineBuffer {
    /// `None` for no lines: a buffer is never empty.
    pub(super) fn new(device: &wgpu::Device, segments: &[Segment]) -> Option<Self> {
        let count = u32::try_from(segments.len()).ok().filter(|count| *count > 0)?;
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("lines"),
            contents: bytemuck::cast_slice(segments),
            usage: wgpu::BufferUsages::VERTEX,
        });
        Some(Self { buffer, count })
    }
}

/// A surface.
pub(super) struct SurfaceBuffer {
    pub(super) vertices: wgpu::Buffer,
    pub(super) indices: wgpu::Buffer,
    pub(super) index_count: u32,
    pub(super) wire: Option<LineBuffer>,
}

/// A drawable.
pub(super) struct Uploaded {
    /// Gone when nothing shows it any more.
    pub(super) source: Weak<Drawable>,
    pub(super) surface: Option<SurfaceBuffer>,
    pub(super) lines: Option<LineBuffer>,
    /// Where the lines of each role stand.
    roles: [Range<u32>; 3],
}

impl Uploaded {
    pub(super) fn new(device: &wgpu::Device, drawable: &Arc<Drawable>) -> Self {
        let init = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let surface = drawable.surface.as_ref().and_then(|surface| {
            let index_count = u32::try_from(surface.triangles.len() * 3).ok().filter(|count| *count > 0)?;
            Some(SurfaceBuffer {
                vertices: init("vertices", bytemuck::cast_slice(&surface.vertices), wgpu::BufferUsages::VERTEX),
                indices: init("indices", bytemuck::cast_slice(&surface.triangles), wgpu::BufferUsages::INDEX),
                index_count,
                wire: LineBuffer::new(device, &surface.wire),
            })
        });
        let mut segments = Vec::new();
        let roles = [LineRole::Curve, LineRole::Section, LineRole::Rail].map(|role| {
            let begin = segments.len();
            segments.extend(drawable.lines.iter().filter(|line| line.role == role).flat_map(|line| line.segments()));
            let place = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
            place(begin)..place(segments.len())
        });
        Self { source: Arc::downgrade(drawable), surface, lines: LineBuffer::new(device, &segments), roles }
    }

    /// Where its lines of a role stand in the buffer.
    pub(super) fn range(&self, role: LineRole) -> Range<u32> {
        match role {
            LineRole::Curve => self.roles[0].clone(),
            LineRole::Section => self.roles[1].clone(),
            LineRole::Rail => self.roles[2].clone(),
        }
    }
}
