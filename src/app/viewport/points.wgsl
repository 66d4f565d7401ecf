// Points as camera-facing discs: one instance a point, four corners a quad, cut round in the fragment shader.

// The Rust side is `PointsUniform` in points.rs.
struct Points {
    clip_from_set: mat4x4<f32>,
    // Height above the camera's level = dot(height_from_set, vec4(position, 1)).
    height_from_set: vec4<f32>,
    // `Colouring` in style.rs.
    colouring: u32,
    // 0 pixels, 1 metres: `PointSize` in style.rs.
    size_unit: u32,
    // Diameter, physical pixels or metres.
    diameter: f32,
    padding: f32,
}

@group(1) @binding(0) var<uniform> points: Points;

const BY_SEGMENT: u32 = 0u;
const BY_HEIGHT: u32 = 1u;
const BY_DEVIATION: u32 = 2u;

const FIRST_PLANE: u32 = 2u;
const LAST_PLANE: u32 = 5u;

// The value of the upper 24 bits that says "no deviation".
const NO_DEVIATION: i32 = -8388608;

// Diameters on the screen, physical pixels: below one a point would flicker, above the last it hides the others.
const DIAMETER_RANGE: vec2<f32> = vec2(1.0, 64.0);

// Share of the background mixed into points that the scale does not speak of.
const DIMMED: f32 = 0.55;

// The Rust side is `GpuPoint` in points.rs.
struct GpuPoint {
    @location(0) position: vec3<f32>,
    // Low 8 bits: role. Upper 24, signed: deviation in micrometres.
    @location(1) role_and_deviation: u32,
}

struct Corner {
    @builtin(position) clip: vec4<f32>,
    // −1..1 from edge to edge of the quad.
    @location(0) offset: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32, point: GpuPoint) -> Corner {
    let role = min(point.role_and_deviation & 0xffu, NUM_ROLES - 1u);
    let clip = points.clip_from_set * vec4(point.position, 1.0);
    var diameter = points.diameter * view.roles[role].w;
    if points.size_unit == 1u {
        diameter *= view.focal / clip.w;
    }
    let offset = vec2(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    var corner: Corner;
    corner.offset = offset;
    corner.colour = colour_of(point, role);
    if diameter <= 0.0 || clip.w <= view.near {
        // Beyond the far side of clip space: nothing is drawn.
        corner.clip = vec4(0.0, 0.0, 2.0, 1.0);
    } else {
        let size = clamp(diameter, DIAMETER_RANGE.x, DIAMETER_RANGE.y);
        corner.clip = vec4(clip.xy + offset * size / view.size * clip.w, clip.zw);
    }
    return corner;
}

fn colour_of(point: GpuPoint, role: u32) -> vec3<f32> {
    let own = view.roles[role].rgb;
    let dimmed = mix(own, view.background.rgb, DIMMED);
    switch points.colouring {
        case BY_SEGMENT: {
            return own;
        }
        case BY_HEIGHT: {
            if role >= FIRST_PLANE && role <= LAST_PLANE {
                return dimmed;
            }
            let height = dot(points.height_from_set, vec4(point.position, 1.0));
            let span = max(view.height_range.y - view.height_range.x, 1e-6);
            return height_colour((height - view.height_range.x) / span);
        }
        case BY_DEVIATION: {
            let micrometres = bitcast<i32>(point.role_and_deviation) >> 8u;
            if micrometres == NO_DEVIATION {
                return dimmed;
            }
            let deviation = f32(micrometres) * 1e-6;
            return deviation_colour(0.5 + 0.5 * deviation / view.deviation_range);
        }
        default: {
            return view.roles[0].rgb;
        }
    }
}

fn height_colour(share: f32) -> vec3<f32> {
    let at = clamp(share, 0.0, 1.0) * f32(SCALE_STOPS - 1);
    let stop = min(i32(at), SCALE_STOPS - 2);
    return mix(view.height_scale[stop].rgb, view.height_scale[stop + 1].rgb, at - f32(stop));
}

fn deviation_colour(share: f32) -> vec3<f32> {
    let at = clamp(share, 0.0, 1.0) * f32(SCALE_STOPS - 1);
    let stop = min(i32(at), SCALE_STOPS - 2);
    return mix(view.deviation_scale[stop].rgb, view.deviation_scale[stop + 1].rgb, at - f32(stop));
}

struct Pixel {
    @location(0) colour: vec4<f32>,
    // near / z, for the passes that follow: 0 where there is nothing.
    @location(1) closeness: f32,
}

@fragment
fn fragment_main(corner: Corner) -> Pixel {
    if dot(corner.offset, corner.offset) > 1.0 {
        discard;
    }
    return Pixel(vec4(corner.colour, 1.0), corner.clip.z);
}
