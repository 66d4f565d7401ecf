// Points as camera-facing discs: three vertices per point, cut round in the fragment shader.

// The Rust side is `PointsUniform` in points.rs.
struct Points {
    clip_from_set: mat4x4<f32>,
    // Height above the camera = dot(height_from_set, vec4(position, 1)).
    height_from_set: vec4<f32>,
    // Metres.
    diameter: f32,
}

// `Colouring` in style.rs, one pipeline each. With a branch on a uniform, software Vulkan (Mesa 22) would recompile the shader
// for every picture and keep each copy.
override colouring: u32;

// Share of the shading that background planes take: they are flat, and shading shows little but noise on them.
const BACKGROUND_SHADING: f32 = 0.3;

@group(1) @binding(0) var<uniform> points: Points;

const BY_SEGMENT: u32 = 0u;
const BY_HEIGHT: u32 = 1u;
const BY_DEVIATION: u32 = 2u;

const FIRST_PLANE: u32 = 2u;
const LAST_PLANE: u32 = 5u;

// The value of the upper 24 bits for a point without deviation.
const NO_DEVIATION: i32 = -8388608;

// Limits of the diameter on the screen, physical pixels: smaller points flicker, larger ones hide the others.
const DIAMETER_RANGE: vec2<f32> = vec2(1.5, 64.0);

// Share of the background mixed into points that the scale does not apply to.
const DIMMED: f32 = 0.4;

// One texel per point, in rows. The Rust side is `GpuPoint` in points.rs.
@group(2) @binding(0) var texels: texture_2d<u32>;

// `ROW` in points.rs.
const ROW: u32 = 2048u;

struct Point {
    position: vec3<f32>,
    role: u32,
    // Micrometres.
    deviation: i32,
}

fn point_at(index: u32) -> Point {
    let texel = textureLoad(texels, vec2(index % ROW, index / ROW), 0);
    let role = min(texel.w & 0xffu, NUM_ROLES - 1u);
    return Point(bitcast<vec3<f32>>(texel.xyz), role, bitcast<i32>(texel.w) >> 8u);
}

// The smallest equilateral triangle around a disc of radius 1.
const CORNERS = array(vec2(0.0, 2.0), vec2(-1.7320508, -1.0), vec2(1.7320508, -1.0));

struct Corner {
    @builtin(position) clip: vec4<f32>,
    // Offset from the centre of the disc, whose edge is at 1.
    @location(0) offset: vec2<f32>,
    // The fourth component is the share of the shading that the point takes.
    @location(1) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Corner {
    let point = point_at(index / 3u);
    let clip = points.clip_from_set * vec4(point.position, 1.0);
    let diameter = view.roles[point.role].w
        * (points.diameter * view.focal / clip.w);
    var corners = CORNERS;
    let offset = corners[index % 3u];
    var corner: Corner;
    corner.offset = offset;
    if diameter <= 0.0 || clip.w <= view.near {
        // Outside clip space, so that nothing is drawn.
        corner.clip = vec4(0.0, 0.0, 2.0, 1.0);
        return corner;
    }
    let size = clamp(diameter, DIAMETER_RANGE.x, DIAMETER_RANGE.y);
    corner.clip = vec4(clip.xy + offset * size / view.size * clip.w, clip.zw);
    corner.colour = vec4(colour_of(point), select(1.0, BACKGROUND_SHADING, is_background(point.role)));
    return corner;
}

fn colour_of(point: Point) -> vec3<f32> {
    let own = view.roles[point.role].rgb;
    let dimmed = mix(own, view.background.rgb, DIMMED);
    switch colouring {
        case BY_SEGMENT: {
            return own;
        }
        case BY_HEIGHT: {
            if is_background(point.role) {
                return dimmed;
            }
            let height = dot(points.height_from_set, vec4(point.position, 1.0));
            let span = max(view.height_range.y - view.height_range.x, 1e-6);
            return height_colour((height - view.height_range.x) / span);
        }
        case BY_DEVIATION: {
            if point.deviation == NO_DEVIATION {
                return dimmed;
            }
            let deviation = f32(point.deviation) * 1e-6;
            return deviation_colour(0.5 + 0.5 * deviation / view.deviation_range);
        }
        default: {
            if is_background(point.role) {
                return dimmed;
            }
            return view.roles[0].rgb;
        }
    }
}

fn is_background(role: u32) -> bool {
    return role >= FIRST_PLANE && role <= LAST_PLANE;
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
    // near / z for the passes that follow, 0 where there is nothing.
    @location(1) closeness: f32,
}

@fragment
fn fragment_main(corner: Corner) -> Pixel {
    if dot(corner.offset, corner.offset) > 1.0 {
        discard;
    }
    return Pixel(corner.colour, corner.clip.z);
}
