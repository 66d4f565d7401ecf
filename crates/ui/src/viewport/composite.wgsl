// Copies the finished picture into the window, pixel for pixel; each pixel of a coarse picture covers a square.

@group(0) @binding(0) var picture: texture_2d<f32>;
// The Rust side is `CompositeUniform` in composite.rs.
struct CompositeUniform {
    // Position of the picture's top left corner in the window, physical pixels.
    origin: vec2<i32>,
    // Side of a pixel of the picture, in pixels of the window.
    pixel_side: i32,
    padding: u32,
}
// True if the window takes linear values; the picture holds sRGB.
override is_linear: bool;
@group(0) @binding(1) var<uniform> placement: CompositeUniform;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let last = vec2<i32>(textureDimensions(picture)) - 1;
    let inside = vec2<i32>(floor(at.xy)) - placement.origin;
    let pixel = clamp(inside / max(placement.pixel_side, 1), vec2(0), last);
    let colour = textureLoad(picture, pixel, 0);
    if is_linear {
        let low = colour.rgb / 12.92;
        let high = pow((colour.rgb + 0.055) / 1.055, vec3(2.4));
        return vec4(select(high, low, colour.rgb <= vec3(0.04045)), 1.0);
    }
    return colour;
}
