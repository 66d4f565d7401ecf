//! Conversion of the sensor's steps of disparity to millimetres.
//!
//! Needed only for libraries that do not convert themselves, such as those that play recorded sessions. The sensor compares
//! the dots it sees with those of a reference plane at z₀. Dots at z appear shifted, measured on that plane, by b·(1 -
//! z₀/z), where b is the distance between projector and camera. libfreenect inverts this in `freenect_raw_to_mm`. Each
//! Kinect has its own z₀, b and pixel size; the values below are those that libfreenect used before it read them from the
//! device (commit 05cadba). The only difference: we round instead of truncating.

/// Number of 11-bit values.
const NUM_STEPS: u16 = 1 << 11;
/// The step that means no reading.
const NO_READING: u16 = NUM_STEPS - 1;
/// Distance between projector and camera, cm.
const BASELINE_CM: f64 = 7.5;
/// Distance of the reference plane, cm.
const REFERENCE_DISTANCE_CM: f64 = 120.0;
/// Size of a pixel on the reference plane, in a picture 1280 pixels wide, cm.
const PIXEL_SIZE_CM: f64 = 0.1042;
/// Disparity of the reference plane, pixels.
const REFERENCE_DISPARITY_PIXELS: f64 = 200.0 + 0.375;
/// Steps per pixel.
const STEPS_PER_PIXEL: f64 = 4.0;
/// Range of libfreenect's own millimetres.
const MAX_DEPTH_MM: f64 = 10_000.0;

/// Focal length of the depth camera for those values, in pixels of a frame 640 wide: 575.8.
pub(super) const FOCAL_LENGTH_PIXELS: f64 = REFERENCE_DISTANCE_CM / (2.0 * PIXEL_SIZE_CM);

/// Returns the millimetres of every step; 0 means no reading.
pub(super) fn millimetres_by_step() -> Vec<u16> {
    (0..NUM_STEPS).map(millimetres).collect()
}

fn millimetres(step: u16) -> u16 {
    let shift = (f64::from(step) / STEPS_PER_PIXEL - REFERENCE_DISPARITY_PIXELS) * PIXEL_SIZE_CM;
    let distance_mm = 10.0 * BASELINE_CM * REFERENCE_DISTANCE_CM / (BASELINE_CM - shift);
    if step == NO_READING || !(distance_mm > 0.0 && distance_mm < MAX_DEPTH_MM) {
        return 0;
    }
    distance_mm.round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_plane_is_where_it_is_and_a_step_grows_with_the_square_of_the_distance() {
        let table = millimetres_by_step();
        // The plane is at step 801.5.
        assert!((1196..=1200).contains(&table[801]) && (1200..=1204).contains(&table[802]));
        assert!(table[300..1000].is_sorted());
        // b·z₀ = z²·step, so 4.2 mm at 1.2 m and 16.7 mm at 2.4 m.
        let near = table[803] - table[801];
        let far_step = table.iter().position(|&mm| mm > 2400).unwrap();
        let far = table[far_step + 1] - table[far_step - 1];
        assert!(
            (8..=9).contains(&near) && (33..=34).contains(&far),
            "{near} {far}"
        );
    }

    #[test]
    fn what_is_beyond_all_reach_is_no_reading() {
        let table = millimetres_by_step();
        assert_eq!(table[2047], 0);
        // Beyond the step of infinite distance the formula becomes negative.
        assert!(table[1090..].iter().all(|&mm| mm == 0));
        assert!(table.iter().all(|&mm| mm < 10_000));
        assert!((FOCAL_LENGTH_PIXELS - 575.8).abs() < 0.05);
    }
}
