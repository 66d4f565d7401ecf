//! The textures that one view is drawn into before egui shows the result.

use eframe::wgpu;

use super::pass;

/// Colours as in egui: sRGB values, stored unconverted.
pub(super) const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// near / z as a colour target: not every backend lets a shader read a depth buffer.
pub(super) const CLOSENESS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Format of the depth test's buffer.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The render targets of one view, all of one size.
pub(super) struct Targets {
    /// Width and height, physical pixels, at least 1.
    pub(super) size: [u32; 2],
    /// Colours of the points, not yet shaded.
    pub(super) colour: wgpu::TextureView,
    /// near / z of the points, 0 where there are none.
    pub(super) closeness: wgpu::TextureView,
    /// Buffer of the depth test.
    pub(super) depth: wgpu::TextureView,
    /// The finished picture, and its texture to read it back.
    pub(super) picture: wgpu::TextureView,
    pub(super) picture_texture: wgpu::Texture,
    /// Binds `colour` and `closeness`.
    pub(super) unshaded_group: wgpu::BindGroup,
    /// Binds `closeness`.
    pub(super) closeness_group: wgpu::BindGroup,
}

/// Layouts of the bind groups in [`Targets`].
pub(super) struct TargetLayouts {
    pub(super) unshaded: wgpu::BindGroupLayout,
    pub(super) closeness: wgpu::BindGroupLayout,
}

impl TargetLayouts {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        Self {
            unshaded: pass::layout(device, "unshaded view", &[pass::PICTURE, pass::PICTURE]),
            closeness: pass::layout(device, "view closeness", &[pass::PICTURE]),
        }
    }
}

impl Targets {
    pub(super) fn new(device: &wgpu::Device, layouts: &TargetLayouts, size: [u32; 2]) -> Self {
        let texture = |label, format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let colour = view(&texture("view colour", COLOUR_FORMAT, read));
        let closeness = view(&texture("view closeness", CLOSENESS_FORMAT, read));
        let depth = view(&texture(
            "view depth",
            DEPTH_FORMAT,
            wgpu::TextureUsages::empty(),
        ));
        let picture_texture = texture(
            "view picture",
            COLOUR_FORMAT,
            read | wgpu::TextureUsages::COPY_SRC,
        );
        let bound = wgpu::BindingResource::TextureView;
        Self {
            unshaded_group: pass::bind(
                device,
                "unshaded view",
                &layouts.unshaded,
                &[bound(&colour), bound(&closeness)],
            ),
            closeness_group: pass::bind(
                device,
                "view closeness",
                &layouts.closeness,
                &[bound(&closeness)],
            ),
            size,
            colour,
            closeness,
            depth,
            picture: view(&picture_texture),
            picture_texture,
        }
    }
}
