// Shades each pixel by how far it lies behind its neighbours; see eye_dome.rs for the method and its source.

@group(1) @binding(0) var colour: texture_2d<f32>;
@group(1) @binding(1) var closeness: texture_2d<f32>;

// Neighbours on two rings: the near one draws edges, the far one gives broad shapes.
const NUM_DIRECTIONS: i32 = 8;
const RINGS: vec2<f32> = vec2(1.5, 4.0);
const RING_WEIGHTS: vec2<f32> = vec2(0.6, 0.4);

// Shade per unit of log2(depth), and how much of it may pile up: by eye, on a simulated Kinect frame.
const GAIN: f32 = 28.0;
// A neighbour this far in front (in log2 of depth, about 20 mm at 1 m) counts no more than one further still:
// an edge is an edge. Below the first value it is the sensor's noise.
const STEP_RANGE: vec2<f32> = vec2(0.0015, 0.03);

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle over the whole target.
    return vec4(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(at.xy);
    let own = textureLoad(closeness, pixel, 0).r;
    if own <= 0.0 {
        return vec4(view.background.rgb, 1.0);
    }
    let lit = textureLoad(colour, pixel, 0).rgb;
    if view.eye_dome <= 0.0 {
        return vec4(lit, 1.0);
    }
    let last = vec2<i32>(view.size) - 1;
    var behind = 0.0;
    for (var ring = 0; ring < 2; ring++) {
        for (var i = 0; i < NUM_DIRECTIONS; i++) {
            let angle = (f32(i) + 0.5 * f32(ring)) * 0.785398163;
            let step = vec2(cos(angle), sin(angle)) * RINGS[ring] * view.pixels_per_point;
            let beside = clamp(pixel + vec2<i32>(round(step)), vec2(0), last);
            let theirs = textureLoad(closeness, beside, 0).r;
            if theirs > own {
                // near / z: the ratio is that of the depths, and the near plane drops out.
                let front = log2(theirs / own);
                behind += RING_WEIGHTS[ring] * clamp(front - STEP_RANGE.x, 0.0, STEP_RANGE.y);
            }
        }
    }
    let shade = exp(-view.eye_dome * GAIN * behind / f32(NUM_DIRECTIONS));
    return vec4(lit * shade, 1.0);
}
