// Declarations shared by all shaders of one view. The Rust side is `ViewUniform` in uniform.rs.

const SCALE_STOPS: i32 = 7;
const NUM_ROLES: u32 = 17u;

struct View {
    // Size of the target, physical pixels.
    size: vec2<f32>,
    // Height at the low and the high end of the height scale, metres.
    height_range: vec2<f32>,
    // Physical pixels per logical pixel.
    pixels_per_point: f32,
    // Focal length: physical pixels per metre at a distance of one metre.
    focal: f32,
    // Distance of the near plane, metres; the depth is near / z.
    near: f32,
    // Strength of the eye-dome lighting, 0 is off.
    eye_dome: f32,
    // Deviation at the ends of the deviation scale, metres.
    deviation_range: f32,
    // Opacity of a line behind a surface.
    hidden_line_opacity: f32,
    padding: vec2<f32>,
    background: vec4<f32>,
    // Per role: red, green, blue, weight.
    roles: array<vec4<f32>, NUM_ROLES>,
    height_scale: array<vec4<f32>, SCALE_STOPS>,
    deviation_scale: array<vec4<f32>, SCALE_STOPS>,
}

@group(0) @binding(0) var<uniform> view: View;
