//! Aligns two clouds of the same part that share no point, without an initial pose.
#![expect(clippy::print_stdout, reason = "it shows what it finds")]

use std::error::Error;

use nalgebra::{Isometry3, Vector3};
use partsight::{PartKind, PartModel, PoseMethod, Side, align};

fn main() -> Result<(), Box<dyn Error>> {
    let model = PartModel::new(PartKind::Fender, Side::Left, 0);
    let sample = |seed| {
        model
            .mesh()
            .sample_evenly(5_000, seed)
            .ok_or("a mesh without area")
    };
    let (target, mut source) = (sample(1)?, sample(2)?);
    let source_from_target =
        Isometry3::new(Vector3::new(0.3, -0.2, 1.0), Vector3::new(0.4, 1.9, -0.7));
    for p in &mut source.points {
        *p = (source_from_target * p.cast::<f64>()).cast();
    }
    let pose = align(&source, &target, PoseMethod::Global, None)?;
    // The identity if the pose is right.
    let off = pose.target_from_source * source_from_target;
    println!(
        "{:.2} mm rms; off the truth by {:.2} mm and {:.3}°",
        pose.fit.rms_m * 1e3,
        off.translation.vector.norm() * 1e3,
        off.rotation.angle().to_degrees()
    );
    if let Some(warning) = pose.doubt() {
        println!("warning: {warning}");
    }
    Ok(())
}
