//! Helpers for the passes of the view: making a pipeline, a layout, a bind group or a uniform buffer.

use eframe::wgpu;

/// One pass: its shader with `vertex_main` and `fragment_main`, and what it reads and writes.
pub(super) struct PassSpec<'a> {
    pub(super) label: &'a str,
    pub(super) source: &'a str,
    /// Values for the shader's `override` declarations, by name.
    pub(super) constants: &'a [(&'a str, f64)],
    pub(super) layouts: &'a [&'a wgpu::BindGroupLayout],
    /// The per-instance buffer, if any.
    pub(super) instances: Option<wgpu::VertexBufferLayout<'a>>,
    pub(super) topology: wgpu::PrimitiveTopology,
    pub(super) targets: &'a [wgpu::ColorTargetState],
    pub(super) depth: Option<wgpu::DepthStencilState>,
}

pub(super) fn pipeline(device: &wgpu::Device, spec: &PassSpec<'_>) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(spec.label),
        source: wgpu::ShaderSource::Wgsl(spec.source.into()),
    });
    let layouts: Vec<_> = spec.layouts.iter().copied().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(spec.label),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let targets: Vec<_> = spec.targets.iter().cloned().map(Some).collect();
    let options = wgpu::PipelineCompilationOptions {
        constants: spec.constants,
        ..wgpu::PipelineCompilationOptions::default()
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(spec.label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex_main"),
            compilation_options: options.clone(),
            buffers: std::slice::from_ref(&spec.instances),
        },
        primitive: wgpu::PrimitiveState {
            topology: spec.topology,
            ..wgpu::PrimitiveState::default()
        },
        depth_stencil: spec.depth.clone(),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment_main"),
            compilation_options: options,
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Makes a bind group layout of uniforms and textures, numbered from 0.
pub(super) fn layout(
    device: &wgpu::Device,
    label: &str,
    entries: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = entries
        .iter()
        .zip(0..)
        .map(|(&ty, binding)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty,
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}

/// Binds resources in the order of a [`layout`].
pub(super) fn bind(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .zip(0..)
        .map(|(resource, binding)| wgpu::BindGroupEntry {
            binding,
            resource: resource.clone(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// A binding for one uniform struct.
pub(super) const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// A binding for a float texture that is read texel by texel.
pub(super) const PICTURE: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: false },
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};

/// A binding for an integer texture that is read texel by texel.
pub(super) const TABLE: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Uint,
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};

/// A uniform buffer and the bind group that holds it alone.
pub(super) struct Uniform {
    buffer: wgpu::Buffer,
    pub(super) group: wgpu::BindGroup,
}

impl Uniform {
    pub(super) fn new<T>(
        device: &wgpu::Device,
        label: &str,
        layout: &wgpu::BindGroupLayout,
    ) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: size_of::<T>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = bind(device, label, layout, &[buffer.as_entire_binding()]);
        Self { buffer, group }
    }

    pub(super) fn write<T: bytemuck::Pod>(&self, queue: &wgpu::Queue, value: &T) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(value));
    }
}
