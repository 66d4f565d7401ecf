// Lines of a width in pixels: one instance per segment, widened on the screen, smooth at the edge, faint where hidden.

// The Rust side is `LinesUniform` in lines.rs.
struct Lines {
    clip_from_set: mat4x4<f32>,
}

@group(1) @binding(0) var<uniform> lines: Lines;
@group(2) @binding(0) var closeness: texture_2d<f32>;

// The Rust side is `GpuSegment` in lines.rs.
struct GpuSegment {
    @location(0) start: vec3<f32>,
    // Logical pixels.
    @location(1) width: f32,
    @location(2) end: vec3<f32>,
    // Low 8 bits: role. Bit 8: dashed.
    @location(3) role_and_stroke: u32,
}

struct Corner {
    @builtin(position) clip: vec4<f32>,
    // Position in physical pixels along the segment from its start, and across it.
    @location(0) at: vec2<f32>,
    @location(1) @interpolate(flat) length: f32,
    @location(2) @interpolate(flat) half_width: f32,
    @location(3) @interpolate(flat) role_and_stroke: u32,
}

const DASHED: u32 = 256u;
// Logical pixels from dash to dash.
const DASH_PERIOD: f32 = 14.0;
const DASH_SHARE: f32 = 0.57;
// A line may lie this share of its depth behind a surface without being hidden, so that lines on a surface show.
const ON_SURFACE: f32 = 0.012;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32, segment: GpuSegment) -> Corner {
    var corner: Corner;
    corner.role_and_stroke = segment.role_and_stroke;
    corner.clip = vec4(0.0, 0.0, 2.0, 1.0);
    var start = lines.clip_from_set * vec4(segment.start, 1.0);
    var end = lines.clip_from_set * vec4(segment.end, 1.0);
    if start.w <= view.near && end.w <= view.near {
        return corner;
    }
    // Clip an end behind the eye to the near plane.
    if start.w < view.near {
        start = mix(start, end, (view.near - start.w) / (end.w - start.w));
    } else if end.w < view.near {
        end = mix(end, start, (view.near - end.w) / (start.w - end.w));
    }
    let half_size = 0.5 * view.size;
    let a = start.xy / start.w * half_size;
    let b = end.xy / end.w * half_size;
    let length = distance(a, b);
    var along = vec2(1.0, 0.0);
    if length > 1e-4 {
        along = (b - a) / length;
    }
    let across = vec2(-along.y, along.x);
    corner.half_width = 0.5 * max(segment.width * view.pixels_per_point, 1.0);
    corner.length = length;
    // One pixel more on every side for the smooth edge.
    let reach = corner.half_width + 1.0;
    let side = f32(index & 1u) * 2.0 - 1.0;
    let is_end = f32(index >> 1u);
    corner.at = vec2(mix(-reach, length + reach, is_end), side * reach);
    let pixel = a + along * corner.at.x + across * corner.at.y;
    // near / w is linear on the screen, so w can be 1 from here on.
    let depth = mix(start.z / start.w, end.z / end.w, is_end);
    corner.clip = vec4(pixel / half_size, depth, 1.0);
    return corner;
}

@fragment
fn fragment_main(corner: Corner) -> @location(0) vec4<f32> {
    let role = view.roles[min(corner.role_and_stroke & 0xffu, NUM_ROLES - 1u)];
    let along = clamp(corner.at.x, 0.0, corner.length);
    let off_line = distance(corner.at, vec2(along, 0.0));
    var opacity = role.w * clamp(corner.half_width + 0.5 - off_line, 0.0, 1.0);
    if (corner.role_and_stroke & DASHED) != 0u {
        let phase = fract(corner.at.x / (DASH_PERIOD * view.pixels_per_point));
        opacity *= step(phase, DASH_SHARE);
    }
    let surface = textureLoad(closeness, vec2<i32>(corner.clip.xy), 0).r;
    if corner.clip.z < surface * (1.0 - ON_SURFACE) {
        opacity *= view.hidden_line_opacity;
    }
    return vec4(role.rgb * opacity, opacity);
}
