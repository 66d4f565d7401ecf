// Shades each pixel by how far it lies behind its neighbours; see eye_dome.rs for the method and its source.

@group(1) @binding(0) var colour: texture_2d<f32>;
@group(1) @binding(1) var closeness: texture_2d<f32>;

// Neighbours on two rings, as x and y in logical pixels and weight: the near ring draws edges, the far one gives broad
// shapes. Written out, because sines for each pixel cost more than all the rest.
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

// Shade per share of the depth: by eye, on a simulated Kinect frame.
const GAIN: f32 = 85.0;
// A neighbour this far in front (as a share of its depth: 20 mm at 1 m) counts no more than one further still:
// an edge is an edge. Below the first value it is the sensor's noise.
const STEP_RANGE: vec2<f32> = vec2(0.003, 0.02);

// Towards the light, in the view: x right, y down, z away. From the upper left, over the viewer's shoulder.
const LIGHT: vec3<f32> = vec3(-0.42, -0.58, -0.70);
// Brightness of a surface that faces away from the light.
const AMBIENT: f32 = 0.5;
// One that faces the light, or is turned from it by up to 37°, has full brightness: colours on a scale stay readable.
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
    // The fourth says how much of the shading the point takes.
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
            // near / z: the ratio is that of the depths, and the near plane drops out.
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

// For a plane n · p = 1, 1 / z is n.x u + n.y v + n.z with (u, v) the place in the picture: the slope is the normal.
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
