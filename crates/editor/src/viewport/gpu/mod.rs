//! Draws pictures with the graphics card: each into a texture of its own with depth, which is then put onto the window. A
//! picture that looks as before is not drawn again.

mod buffers;
mod pipelines;

use std::collections::BTreeMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::wgpu;
use egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};

use self::buffers::{LineBuffer, Uploaded};
use self::pipelines::{Blit, COLOUR, DEPTH, ScenePipelines};
use super::picture::{LineSource, Picture, ViewUniform};

/// How far edges come in front of the surface they lie on, in depth.
const WIRE_FORWARD: f32 = 2e-4;
/// The same for curves, which lie over edges.
const LINE_FORWARD: f32 = 5e-4;

/// What the shaders know of one thing that is drawn.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct DrawUniform {
    colour: [f32; 4],
    numbers: [f32; 4],
}

/// The textures of a view and what they hold.
struct Target {
    size: [u32; 2],
    samples: u32,
    drawn: Option<u64>,
    picture: wgpu::TextureView,
    multisampled: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    blit: wgpu::BindGroup,
}

/// Everything that lives on the graphics card.
struct Gpu {
    uniform_layout: wgpu::BindGroupLayout,
    blit: Blit,
    pipelines: BTreeMap<u32, ScenePipelines>,
    targets: BTreeMap<u64, Target>,
    uploaded: BTreeMap<u64, Uploaded>,
    /// Distance of two uniforms in a buffer.
    stride: u64,
}

/// Makes ready what all views share. Without a call to it, views stay empty.
pub(crate) fn install(state: &RenderState) {
    let draw_size = size_of::<DrawUniform>() as u64;
    let alignment = u64::from(state.device.limits().min_uniform_buffer_offset_alignment).max(1);
    let gpu = Gpu {
        uniform_layout: pipelines::uniform_layout(&state.device, draw_size),
        blit: Blit::new(&state.device, state.target_format),
        pipelines: BTreeMap::new(),
        targets: BTreeMap::new(),
        uploaded: BTreeMap::new(),
        stride: draw_size.next_multiple_of(alignment),
    };
    state.renderer.write().callback_resources.insert(gpu);
}

/// A picture on its way to the window.
pub(crate) struct PaintPicture(pub(crate) Arc<Picture>);

impl CallbackTrait for PaintPicture {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(gpu) = resources.get_mut::<Gpu>() {
            gpu.draw(device, queue, encoder, &self.0);
        }
        Vec::new()
    }

    fn paint(&self, _: egui::PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        if let Some(gpu) = resources.get::<Gpu>()
            && let Some(target) = gpu.targets.get(&self.0.view)
        {
            pass.set_pipeline(&gpu.blit.pipeline);
            pass.set_bind_group(0, &target.blit, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// One draw call: which uniform, and what.
enum Call<'a> {
    Surface(&'a Uploaded),
    Lines { buffer: &'a LineBuffer, range: std::ops::Range<u32>, on_top: bool },
}

impl Gpu {
    fn draw(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        picture: &Picture,
    ) {
        self.uploaded.retain(|_, uploaded| uploaded.source.strong_count() > 0);
        let key = picture.key();
        let fits = |target: &Target| target.size == picture.size && target.samples == picture.samples;
        if !self.targets.get(&picture.view).is_some_and(fits) {
            self.targets.insert(picture.view, Target::new(device, &self.blit, picture));
        }
        if self.targets.get(&picture.view).is_some_and(|target| target.drawn == Some(key)) {
            return;
        }
        let drawables = picture.surfaces.iter().map(|surface| &surface.drawable);
        let of_lines = picture.lines.iter().filter_map(|line| match &line.source {
            LineSource::Drawable(drawable, _) => Some(drawable),
            LineSource::Own(_) => None,
        });
        for drawable in drawables.chain(of_lines) {
            self.uploaded.entry(drawable.id).or_insert_with(|| Uploaded::new(device, drawable));
        }
        let layout = &self.uniform_layout;
        let pipelines = self
            .pipelines
            .entry(picture.samples)
            .or_insert_with(|| ScenePipelines::new(device, layout, picture.samples));
        let own = picture.lines.iter().map(|line| match &line.source {
            LineSource::Own(segments) => LineBuffer::new(device, segments),
            LineSource::Drawable(..) => None,
        });
        let own = own.collect::<Vec<_>>();
        let calls = calls(picture, &self.uploaded, &own);
        let uniforms = Uniforms::new(device, queue, layout, picture, &calls, self.stride);
        let Some(target) = self.targets.get_mut(&picture.view) else { return };
        let (view, resolve_target) = match &target.multisampled {
            Some(multisampled) => (multisampled, Some(&target.picture)),
            None => (&target.picture, None),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("view"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    // What is behind the scene is the window's: its colour, and reference pictures.
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &target.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        for (index, (_, call)) in calls.iter().enumerate() {
            let offset = u32::try_from(index as u64 * self.stride).unwrap_or(0);
            pass.set_bind_group(0, &uniforms.group, &[offset]);
            match call {
                Call::Surface(uploaded) => {
                    let Some(surface) = &uploaded.surface else { continue };
                    pass.set_pipeline(&pipelines.surface);
                    pass.set_vertex_buffer(0, surface.vertices.slice(..));
                    pass.set_index_buffer(surface.indices.slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..surface.index_count, 0, 0..1);
                }
                Call::Lines { buffer, range, on_top } => {
                    pass.set_pipeline(if *on_top { &pipelines.line_on_top } else { &pipelines.line });
                    pass.set_vertex_buffer(0, buffer.buffer.slice(..));
                    pass.draw(0..6, range.clone());
                }
            }
        }
        drop(pass);
        target.drawn = Some(key);
    }
}

/// What is drawn, in its order: surfaces, their edges, then lines.
fn calls<'a>(
    picture: &Picture,
    uploaded: &'a BTreeMap<u64, Uploaded>,
    own: &'a [Option<LineBuffer>],
) -> Vec<(DrawUniform, Call<'a>)> {
    let mut calls = Vec::new();
    let mut wires = Vec::new();
    for surface in &picture.surfaces {
        let Some(there) = uploaded.get(&surface.drawable.id) else { continue };
        let scale = surface.drawable.surface.as_ref().map_or(1.0, |surface| surface.curvature_scale);
        let forward = if surface.forward { 0.5 * WIRE_FORWARD } else { 0.0 };
        let numbers = [0.0, forward, scale, surface.mark];
        calls.push((DrawUniform { colour: surface.colour, numbers }, Call::Surface(there)));
        if let (Some(colour), Some(buffer)) = (surface.wire, there.surface.as_ref().and_then(|s| s.wire.as_ref())) {
            let uniform = DrawUniform { colour, numbers: [1.0, WIRE_FORWARD, 0.0, 0.0] };
            wires.push((uniform, Call::Lines { buffer, range: 0..buffer.count, on_top: false }));
        }
    }
    calls.extend(wires);
    for (line, own) in picture.lines.iter().zip(own) {
        let (buffer, range) = match &line.source {
            LineSource::Own(_) => match own {
                Some(buffer) => (buffer, 0..buffer.count),
                None => continue,
            },
            LineSource::Drawable(drawable, role) => {
                let Some(there) = uploaded.get(&drawable.id) else { continue };
                match &there.lines {
                    Some(buffer) => (buffer, there.range(*role)),
                    None => continue,
                }
            }
        };
        if !range.is_empty() {
            let uniform = DrawUniform { colour: line.colour, numbers: [line.width, LINE_FORWARD, 0.0, 0.0] };
            calls.push((uniform, Call::Lines { buffer, range, on_top: line.on_top }));
        }
    }
    calls
}

/// The uniforms of one drawing.
struct Uniforms {
    group: wgpu::BindGroup,
}

impl Uniforms {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layout: &wgpu::BindGroupLayout,
        picture: &Picture,
        calls: &[(DrawUniform, Call<'_>)],
        stride: u64,
    ) -> Self {
        let buffer = |label, size| {
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let view = buffer("view", size_of::<ViewUniform>() as u64);
        queue.write_buffer(&view, 0, bytemuck::bytes_of(&picture.uniform));
        let draws = buffer("draws", stride * (calls.len() as u64).max(1));
        let mut bytes = vec![0_u8; usize::try_from(stride).unwrap_or(256) * calls.len().max(1)];
        for (index, (uniform, _)) in calls.iter().enumerate() {
            let begin = index * usize::try_from(stride).unwrap_or(256);
            let uniform = bytemuck::bytes_of(uniform);
            bytes[begin..begin + uniform.len()].copy_from_slice(uniform);
        }
        queue.write_buffer(&draws, 0, &bytes);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &draws,
                        offset: 0,
                        size: std::num::NonZeroU64::new(size_of::<DrawUniform>() as u64),
                    }),
                },
            ],
        });
        Self { group }
    }
}

impl Target {
    fn new(device: &wgpu::Device, blit: &Blit, picture: &Picture) -> Self {
        let texture = |label, format, samples, usage| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: picture.size[0], height: picture.size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let none = wgpu::TextureUsages::empty();
        let shown = texture("picture", COLOUR, 1, wgpu::TextureUsages::TEXTURE_BINDING);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("blit"),
            layout: &blit.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&shown) }],
        });
        Self {
            size: picture.size,
            samples: picture.samples,
            drawn: None,
            multisampled: (picture.samples > 1).then(|| texture("samples", COLOUR, picture.samples, none)),
            depth: texture("depth", DEPTH, picture.samples, none),
            picture: shown,
            blit: group,
        }
    }
}

/// Whether the graphics card can smooth edges.
pub(crate) fn can_multisample(state: &RenderState) -> bool {
    let flags = |format| state.adapter.get_texture_format_features(format).flags;
    [COLOUR, DEPTH].into_iter().all(|format| flags(format).sample_count_supported(4))
}
