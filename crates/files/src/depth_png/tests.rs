use super::*;
use crate::{FileContent, crc32, open, read_depths};
use geometry::distortion::Distortion;
use geometry::error::Advice as _;
use geometry::fixtures::small_frame;

fn frame() -> DepthFrame {
    DepthFrame {
        intrinsics: Intrinsics {
            width: 3,
            height: 2,
            fx: 500.0,
            fy: 501.5,
            cx: 1.0,
            cy: 0.5,
            distortion: Distortion::NONE,
        },
        metres_per_unit: 0.001,
        depth: vec![0, 1, 256, 1000, 65_535, 700],
        is_simulated: false,
    }
}

#[test]
fn a_frame_survives_being_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    for is_simulated in [false, true] {
        let frame = DepthFrame {
            is_simulated,
            ..frame()
        };
        write_depth_png(&path, &frame).unwrap();
        assert_eq!(open(&path).unwrap(), FileContent::Depth(frame));
    }
}

#[test]
fn missing_intrinsics_are_asked_for_with_an_example_that_works() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    write_depth_png(&path, &frame()).unwrap();
    std::fs::remove_file(intrinsics_path(&path)).unwrap();
    let error = open(&path).unwrap_err();
    assert!(matches!(error, FileError::MissingIntrinsics { .. }));
    let advice = error.advice();
    let example = advice.get(advice.find('{').unwrap()..).unwrap();
    let parsed: DepthCamera = serde_json::from_str(example).unwrap();
    assert_eq!(parsed.intrinsics, Intrinsics::KINECT);
}

#[test]
fn intrinsics_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    write_depth_png(&path, &frame()).unwrap();
    let json = intrinsics_path(&path);
    let good = std::fs::read_to_string(&json).unwrap();
    for (from, to) in [
        ("500.0", "0.0"),
        ("501.5", "-1.0"),
        ("0.001", "0"),
        ("\"width\": 3", "\"width\": 4"),
        ("\"fx\"", "\"focal\""),
        ("0.5", "1e999"),
        ("{", ""),
    ] {
        let bad = good.replacen(from, to, 1);
        assert_ne!(bad, good);
        std::fs::write(&json, bad).unwrap();
        let error = open(&path).unwrap_err();
        assert!(
            matches!(error, FileError::BadIntrinsics { .. }),
            "{from} -> {to}: {error}"
        );
    }
}

#[test]
fn the_images_of_a_folder_may_share_a_camera() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    write_depth_png(&path, &frame()).unwrap();
    let shared = folder.path().join(FOLDER_CAMERA);
    std::fs::rename(intrinsics_path(&path), &shared).unwrap();
    assert_eq!(open(&path).unwrap(), FileContent::Depth(frame()));
    let mut other = DepthCamera::from_frame(&frame());
    other.intrinsics.fx = 600.0;
    write_camera(&intrinsics_path(&path), &other).unwrap();
    let FileContent::Depth(own) = open(&path).unwrap() else {
        panic!("a depth image");
    };
    assert_eq!(DepthCamera::from_frame(&own), other);
}

#[test]
fn other_kinds_of_png_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    for (kind, num_bytes, word) in [
        (ExtendedColorType::L8, 1, "8 bits"),
        (ExtendedColorType::Rgb8, 3, "colour"),
        (ExtendedColorType::Rgb16, 6, "16-bit colour"),
    ] {
        let mut png = Vec::new();
        PngEncoder::new(&mut png)
            .write_image(&vec![9; num_bytes], 1, 1, kind)
            .unwrap();
        std::fs::write(&path, png).unwrap();
        let error = open(&path).unwrap_err();
        assert!(
            matches!(&error, FileError::WrongPngKind { found, .. } if found.contains(word)),
            "{error}"
        );
    }
}

#[test]
fn a_frame_without_a_reading_has_no_points() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    write_depth_png(
        &path,
        &DepthFrame {
            depth: vec![0; 6],
            ..frame()
        },
    )
    .unwrap();
    assert!(matches!(
        open(&path),
        Err(FileError::NoPoints { found: 6, .. })
    ));
}

#[test]
fn an_image_larger_than_its_bytes_could_hold_takes_no_memory() {
    // A correct header of 7000×7000 pixels before the data of six.
    let png = with_header(|header| {
        header[..4].copy_from_slice(&7000_u32.to_be_bytes());
        header[4..8].copy_from_slice(&7000_u32.to_be_bytes());
    });
    assert!(matches!(decoded(&png), Err(FileError::Truncated { .. })));
}

/// A PNG of six pixels with a changed header and the checksum to match.
fn with_header(change: impl FnOnce(&mut [u8])) -> Vec<u8> {
    let mut png = Vec::new();
    PngEncoder::new(&mut png)
        .write_image(&[0; 12], 3, 2, ExtendedColorType::L16)
        .unwrap();
    change(&mut png[16..29]);
    let checksum = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    png
}

fn decoded(png: &[u8]) -> Result<((usize, usize), Vec<u16>), FileError> {
    decode(Source {
        path: Path::new("test.png"),
        bytes: png,
    })
}

#[test]
fn a_size_beyond_all_cameras_is_too_large_as_in_other_formats() {
    let png = with_header(|header| {
        header[..4].copy_from_slice(&(1_u32 << 16).to_be_bytes());
        header[4..8].copy_from_slice(&(1_u32 << 15).to_be_bytes());
    });
    assert!(matches!(
        decoded(&png),
        Err(FileError::TooLarge { what: "pixels", found, .. }) if found == 1 << 31
    ));
}

#[test]
fn a_palette_is_named_and_a_cut_image_invents_no_number() {
    let palette = with_header(|header| header[8..10].copy_from_slice(&[8, PALETTE]));
    let error = decoded(&palette).unwrap_err();
    assert!(
        error.to_string().contains("an 8-bit PNG with a palette"),
        "{error}"
    );
    let whole = with_header(|_| {});
    for length in [9, 20, whole.len() - 20] {
        let error = decoded(&whole[..length]).unwrap_err();
        assert!(
            error.to_string().contains("expected the end of the"),
            "{error}"
        );
    }
}

#[test]
fn a_camera_is_no_capture_and_nothing_else_is_overwritten_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    write_depth_png(&path, &frame()).unwrap();
    let json = intrinsics_path(&path);
    let error = open(&json).unwrap_err();
    assert!(matches!(&error, FileError::IsIntrinsics { image, .. } if *image == path));
    let shared = folder.path().join(FOLDER_CAMERA);
    std::fs::copy(&json, &shared).unwrap();
    let error = open(&shared).unwrap_err();
    let all = folder.path().join("*.png");
    assert!(matches!(&error, FileError::IsIntrinsics { image, .. } if *image == all));
    write_depth_png(&path, &frame()).expect("a camera may be replaced by a camera");
    std::fs::write(&json, "{\"shift\": 3}").unwrap();
    let error = write_depth_png(&path, &frame()).unwrap_err();
    assert!(matches!(error, FileError::ForeignSidecar { .. }));
    assert_eq!(std::fs::read_to_string(&json).unwrap(), "{\"shift\": 3}");
}

#[test]
fn a_lens_that_folds_inside_the_picture_is_refused_with_advice() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    let mut frame = frame();
    frame.intrinsics = Intrinsics {
        width: 3,
        height: 2,
        fx: 2.0,
        fy: 2.0,
        ..frame.intrinsics
    };
    write_depth_png(&path, &frame).unwrap();
    assert!(open(&path).is_ok());
    frame.intrinsics.distortion.k1 = -0.5;
    write_depth_png(&path, &frame).unwrap();
    let error = open(&path).unwrap_err();
    assert!(
        matches!(error, FileError::FoldingDistortion { .. }),
        "{error}"
    );
    assert!(error.to_string().contains("folds") && error.advice().contains("k1"));
}

#[test]
fn a_distorted_frame_survives_being_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.png");
    let mut frame = frame();
    frame.intrinsics.distortion = Distortion {
        k1: 5.210_000_000_000_001,
        k4: 5.55,
        p2: 1.0 / 3e4,
        ..Distortion::NONE
    };
    write_depth_png(&path, &frame).unwrap();
    assert_eq!(open(&path).unwrap(), FileContent::Depth(frame));
}

#[test]
fn a_line_of_pixels_takes_no_memory_and_what_is_no_png_is_named() {
    let path = Path::new("line.png");
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".to_vec();
    bytes.extend(1_u32.to_be_bytes());
    bytes.extend(50_000_000_u32.to_be_bytes());
    bytes.extend([16, 0, 0, 0, 0]);
    let error = read_depths(path, &bytes).unwrap_err();
    assert!(
        error.to_string().contains("50000000 pixels along one side"),
        "{error}"
    );
    for (bytes, expected) in [
        (&b"1 2 3\n4 5 6\n"[..], "XYZ text"),
        (b"\xff\xd8\xff\xe0\0\x10JFIF", "a JPEG picture"),
        (b"ply\nformat ascii 1.0\n", "a PLY"),
    ] {
        let error = read_depths(path, bytes).unwrap_err();
        assert!(matches!(error, FileError::WrongPngKind { .. }), "{error}");
        assert!(error.to_string().contains(expected), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_depth_image_never_has_the_camera_of_another() {
    use crate::disk::faults::{Writer, with_advice};

    let frame = |fx: f64, depth: u16| {
        let mut frame = small_frame(6, (0..24).map(|i| depth + i));
        frame.intrinsics.fx = fx;
        frame
    };
    Writer {
        test: "depth_png::tests::whichever_call_fails_a_depth_image_never_has_the_camera_of_another",
        prepare: &|folder| {
            write_depth_png(&folder.join("depth.png"), &frame(500.0, 900)).unwrap();
        },
        write: &|folder| {
            let written = write_depth_png(&folder.join("depth.png"), &frame(600.0, 1900));
            written.map_err(|error| with_advice(&error))
        },
        state: &|folder| match crate::open(&folder.join("depth.png")) {
            Ok(FileContent::Depth(frame)) => {
                format!("fx {}, depth {}", frame.intrinsics.fx, frame.depth[0])
            }
            Ok(_) => "something else".into(),
            Err(FileError::NotFound { .. }) => "none".into(),
            Err(error) => error.to_string(),
        },
        between: &["none"],
    }
    .fails_at_every_call();
}
