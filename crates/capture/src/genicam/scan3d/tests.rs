use super::*;
use geometry::error::Advice as _;

/// The nodes of a camera of depth and points.
fn camera() -> Scan3d {
    let text = |text: &str| Some(text.to_owned());
    let nodes = |scale, offset, invalid| AxisNodes {
        scale: Some(scale),
        offset: Some(offset),
        invalid,
    };
    Scan3d {
        output_mode: text("CalibratedABC_Grid"),
        coordinate_system: text("Cartesian"),
        reference: text("Anchor"),
        distance_unit: text("Millimeter"),
        axes: [
            nodes(1.0, 0.0, None),
            nodes(1.0, 0.0, None),
            nodes(0.25, 100.0, Some(65535.0)),
        ],
        focal_length: Some(500.5),
        aspect_ratio: None,
        principal_point: [Some(1.0), Some(0.5)],
        size: [Some(3.0), Some(2.0)],
        region_offset: [Some(0.0), None],
        is_reversed: [Some(false), None],
    }
}

fn decoder(nodes: &Scan3d, format: GenicamFormat) -> Decoder {
    let (decoder, warnings) = nodes.decoder(format, None).expect("readable");
    assert_eq!(warnings, []);
    decoder
}

fn part(width: usize, height: usize, row_padding: usize, bytes: &[u8]) -> Part<'_> {
    Part {
        width,
        height,
        row_padding,
        bytes,
    }
}

#[test]
fn depths_are_those_of_scale_and_offset_to_half_a_unit() {
    let values = [0_u16, 1, 4000, 40_000, 65_534, 65_535];
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    for (scale, offset) in [(0.25, 0.0), (0.25, 100.0), (0.25, -50.0), (-0.02, 3000.0)] {
        let mut nodes = camera();
        nodes.axes[2].scale = Some(scale);
        nodes.axes[2].offset = Some(offset);
        let image = decoder(&nodes, GenicamFormat::Coord3dC16).image(part(3, 2, 0, &bytes));
        let Ok(Image::Depth(frame)) = image else {
            panic!("{image:?}")
        };
        let camera = frame.intrinsics;
        assert_eq!((camera.width, camera.height), (3, 2));
        assert!((camera.fx - 500.5).abs() < 1e-9 && (camera.cx - 1.0).abs() < 1e-9);
        // 0 never is a reading; 65535 is the camera's invalid value.
        assert_eq!((frame.depth[0], frame.depth[5]), (0, 0));
        for (value, &depth) in values.iter().zip(&frame.depth).skip(1).take(4) {
            let expected = (f64::from(*value) * scale + offset) * 0.001;
            let found = f64::from(depth) * frame.metres_per_unit;
            if expected <= 0.0 {
                assert_eq!(depth, 0, "behind the camera");
            } else {
                let error = (found - expected).abs();
                assert!(error <= 0.5001 * frame.metres_per_unit, "{value}: {error}");
            }
        }
        if offset == 0.0 {
            assert_eq!(frame.depth[..5], values[..5]);
            assert!((frame.metres_per_unit - 0.000_25).abs() < 1e-15);
        }
    }
}

#[test]
fn points_keep_rows_and_columns_and_padding_is_no_point() {
    let invalid = [1.0, 2.0, 65_535.0];
    let rows: [[[f32; 3]; 2]; 2] = [
        [[0.0, -20.0, 3600.0], invalid],
        [[0.0; 3], [f32::NAN, 1.0, 2.0]],
    ];
    let mut bytes = Vec::new();
    for row in rows {
        bytes.extend(
            row.as_flattened()
                .iter()
                .flat_map(|value| value.to_le_bytes()),
        );
        bytes.extend([0xFF; 5]);
    }
    let mut nodes = camera();
    let image = decoder(&nodes, GenicamFormat::Coord3dAbc32f).image(part(2, 2, 5, &bytes));
    let Ok(Image::Cloud(cloud)) = image else {
        panic!("{image:?}")
    };
    let grid = Grid {
        width: 2,
        height: 2,
    };
    assert_eq!((cloud.grid, cloud.points.len()), (Some(grid), 4));
    assert_eq!(cloud.num_finite(), 1);
    let expected = Point3::new(0.0, -0.02, 1.0);
    assert!((cloud.points[0] - expected).norm() < 1e-6);

    nodes.output_mode = Some(POINT_CLOUD.into());
    let image = decoder(&nodes, GenicamFormat::Coord3dAbc32f).image(part(2, 2, 5, &bytes));
    let Ok(Image::Cloud(cloud)) = image else {
        panic!("{image:?}")
    };
    assert_eq!((cloud.grid, cloud.points.len()), (None, 1));
}

#[test]
fn a_picture_with_fewer_bytes_or_another_size_is_an_error() {
    let decoder = decoder(&camera(), GenicamFormat::Coord3dC16);
    for (width, height, row_padding, num_bytes) in [
        (3, 2, 0, 11),
        (3, 2, 4, 15),
        (3, 0, 0, 12),
        (0, 2, 0, 12),
        (2, 2, 0, 12),
        (usize::MAX, usize::MAX, usize::MAX, 12),
    ] {
        let bytes = vec![1; num_bytes];
        let image = decoder.image(part(width, height, row_padding, &bytes));
        assert!(image.is_err(), "{width}×{height}: {image:?}");
    }
    assert!(decoder.image(part(3, 2, 4, &[1; 16])).is_ok());
}

#[test]
fn what_is_no_depth_along_the_axis_in_a_known_unit_is_refused() {
    type Change = fn(&mut Scan3d);
    let changes: [(Change, &str); 14] = [
        (|c| c.output_mode = Some("DisparityC".into()), "DisparityC"),
        (|c| c.output_mode = Some("RectifiedC".into()), "RectifiedC"),
        (
            |c| c.coordinate_system = Some("Spherical".into()),
            "Spherical",
        ),
        (|c| c.reference = Some("Transformed".into()), "Transformed"),
        (|c| c.distance_unit = Some("Pixel".into()), "Pixel"),
        (|c| c.axes[2].scale = None, "Scan3dCoordinateScale"),
        (|c| c.axes[2].scale = Some(0.0), "Scan3dCoordinateScale"),
        (|c| c.axes[2].offset = Some(-1e6), "Scan3dCoordinateScale"),
        (|c| c.focal_length = None, "Scan3dFocalLength"),
        (|c| c.focal_length = Some(0.0), "fx"),
        (|c| c.is_reversed[0] = Some(true), "ReverseX"),
        (|c| c.is_reversed[1] = Some(true), "ReverseY"),
        (|c| c.region_offset[0] = Some(16.0), "OffsetX"),
        (|c| c.region_offset[1] = Some(8.0), "OffsetY"),
    ];
    for (change, words) in changes {
        let mut nodes = camera();
        change(&mut nodes);
        let error = nodes.decoder(GenicamFormat::Coord3dC16, None);
        let error = error.err().expect(words);
        assert!(error.to_string().contains(words), "{error}");
    }
    let error = camera().decoder(GenicamFormat::Mono16, None);
    assert!(error.is_err(), "grey values without a scale");
}

#[test]
fn a_file_takes_the_place_of_what_the_camera_says_of_its_depth() {
    let mut nodes = Scan3d::default();
    nodes.axes[2].invalid = Some(7.0);
    let file = DepthCamera {
        metres_per_unit: 0.002,
        ..camera().camera().expect("reported")
    };
    let (decoder, warnings) = nodes
        .decoder(GenicamFormat::Coord3dC16, Some(file))
        .expect("the file has all");
    assert_eq!(warnings, []);
    let image = decoder.image(part(3, 2, 0, &[7, 0, 8, 0, 9, 0, 0, 1, 0, 0, 1, 0]));
    let Ok(Image::Depth(frame)) = image else {
        panic!("{image:?}")
    };
    assert_eq!(frame.depth, [0, 8, 9, 256, 0, 1]);
    assert!((frame.metres_per_unit - 0.002).abs() < 1e-15);
}

#[test]
fn a_reversed_depth_image_needs_a_file_that_says_so() {
    let mut nodes = camera();
    nodes.is_reversed[0] = Some(true);
    let file = camera().camera().expect("reported");
    let mirrored = DepthCamera {
        stored: StoredOrientation {
            is_mirrored: true,
            ..StoredOrientation::default()
        },
        ..file
    };
    for format in [GenicamFormat::Coord3dC16, GenicamFormat::Mono16] {
        let error = nodes.decoder(format, Some(file)).err().expect("reversed");
        assert!(error.to_string().contains("ReverseX"), "{error}");
        assert!(error.advice().contains("ReverseX to false"));
        let (decoder, _) = nodes.decoder(format, Some(mirrored)).expect("reported");
        let values = [1_u16, 2, 3, 4, 5, 6].map(u16::to_le_bytes);
        let image = decoder.image(part(3, 2, 0, values.as_flattened()));
        let Ok(Image::Depth(frame)) = image else {
            panic!("{image:?}")
        };
        assert!(frame.depth[0] > frame.depth[2], "{:?}", frame.depth);
    }
    // Points have x and y of their own, whatever their order.
    assert!(nodes.decoder(GenicamFormat::Coord3dAbc32f, None).is_ok());
}

#[test]
fn rows_have_the_focal_length_of_columns_times_the_aspect_ratio() {
    let mut nodes = camera();
    nodes.aspect_ratio = Some(1.5);
    let lens = nodes.camera().expect("reported").intrinsics;
    assert!((lens.fx - 500.5).abs() < 1e-9 && (lens.fy - 750.75).abs() < 1e-9);
}

#[test]
fn a_camera_without_a_unit_is_taken_for_one_of_millimetres_and_says_so() {
    let mut nodes = camera();
    nodes.distance_unit = None;
    let (_, warnings) = nodes
        .decoder(GenicamFormat::Coord3dAbc32f, None)
        .expect("readable");
    assert_eq!(warnings, [CaptureWarning::AssumedUnit]);
}
