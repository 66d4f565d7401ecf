// Shades each pixel by how far it lies behind its neighbours; see eye_dome.rs for the method and its source.

@group(1) @binding(0) var colour: texture_2d<f32>;
@group(1) @binding(1) var closeness: texture_2d<f32>;

// Neighbours on two rings: x and y in logical pixels, and weight. The near ring shades edges, the far one broad shapes. Listed
// as constants because computing sines per pixel costs more than all the rest.
const NUM_NEIGHBOURS: i32 = 12;
const NEIGHBOURS = array(
    vec3(1.06, 1.06, 0.150),
    vec3(-1.06, 1.06, 0.150),
    vec3(-1.06, -1.06, 0.150),
    vec3(1.06, -1.06, 0.150),
    vec3(5.00, 0.00, 0.050),
    vec3(3.54, 3.54, 0.050),
    vec3(0.00, 5.00, 0.050),
    vec3(-3.54, 3.54, 0.050),
    vec3(-5.00, 0.00, 0.050),
    vec3(-3.54, -3.54, 0.050),
    vec3(-0.00, -5.00, 0.050),
    vec3(3.54, -3.54, 0.050),
);

// Shade per share of the depth; tuned by eye on a simulated Kinect frame.
const GAIN: f32 = 85.0;
// Range of depth differences that count, as a share of the neighbour's depth. Below it is sensor noise; above it (20 mm at 1
// m) a neighbour further in front counts no more, so that all edges look alike.
const STEP_RANGE: vec2<f32> = vec2(0.003, 0.02);

// Direction towards the light in the view (x right, y down, z away): from the upper left, over the viewer's shoulder.
const LIGHT: vec3<f32> = vec3(-0.42, -0.58, -0.70);
// Brightness of a surface that faces away from the light.
const AMBIENT: f32 = 0.5;
// Cosine up to which a surface has full brightness (turned by 37° from the light): colours of a scale stay readable.
const FULL_LIGHT: f32 = 0.8;

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
    let flat_colour = textureLoad(colour, pixel, 0);
    // The fourth component is the share of the shading that the point takes.
    let strength = view.eye_dome * flat_colour.a;
    if strength <= 0.0 {
        return vec4(flat_colour.rgb, 1.0);
    }
    let closer_by = 1.0 / own;
    var behind = 0.0;
    // Least squares for the slope of near / z, over neighbours on the same surface.
    var moments = vec3(1e-6, 0.0, 1e-6);
    var products = vec2(0.0);
    var neighbours = NEIGHBOURS;
    for (var i = 0; i < NUM_NEIGHBOURS; i++) {
        let neighbour = neighbours[i];
        let step = round(neighbour.xy * view.pixels_per_point);
        let theirs = textureLoad(closeness, pixel + vec2<i32>(step), 0).r;
        if theirs > 0.0 {
            // A ratio of near / z is a ratio of depths; the near plane cancels.
            let front = theirs * closer_by - 1.0;
            behind += neighbour.z * clamp(front - STEP_RANGE.x, 0.0, STEP_RANGE.y);
            if abs(front) < STEP_RANGE.y {
                moments += vec3(step.x * step.x, step.x * step.y, step.y * step.y);
                products += step * (theirs - own);
            }
        }
    }
    let occlusion = exp(-strength * GAIN * behind);
    let light = mix(1.0, brightness(at.xy, own, moments, products), min(strength, 1.0));
    return vec4(flat_colour.rgb * occlusion * light, 1.0);
}

// For a plane n · p = 1, 1 / z is n.x u + n.y v + n.z with image coordinates (u, v): the slope gives the normal.
fn brightness(at: vec2<f32>, own: f32, moments: vec3<f32>, products: vec2<f32>) -> f32 {
    let determinant = moments.x * moments.z - moments.y * moments.y;
    let slope = vec2(
        moments.z * products.x - moments.y * products.y,
        moments.x * products.y - moments.y * products.x,
    ) / max(determinant, 1e-6);
    let uv = (at - 0.5 * view.size) / view.focal;
    let across = slope * view.focal;
    let normal = -normalize(vec3(across, own - dot(across, uv)));
    return mix(AMBIENT, 1.0, clamp(dot(normal, LIGHT) / FULL_LIGHT, 0.0, 1.0));
}
