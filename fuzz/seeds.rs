//! Small seed files, made by the program's own writers: `seeds FOLDER` fills `FOLDER/<target>`.

use std::{env, fs, path::Path, time::Duration};

use nalgebra::{Point3, Unit, Vector3};
use partsight::{
    CellSetup, DepthFrame, Grid, Intrinsics, LibraryFolder, Metres, PartKind, PointCloud, Radians,
    RigidTransform, Side,
    capture::{NextCapture, Recorder},
    files::{crc32, save_cloud, write_depth_png},
    geometry::rigid::row_major,
    open_source,
    paint::built_in_coat,
    pipeline::RecipeFile,
    robot::{
        arm::{Arm, GUN_RADIUS_M, Obstacles, PlacedArm},
        calibration::{CameraPlace, CellCalibration, Origin},
        line::{Counter, LineCalibration},
    },
    simulated_frame,
};
use serve::{ByteOrder, Request, binary_request};
use servo::simulated::{ArmDynamics, SimulatedArm, SimulatedController, StreamProtocol};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const STL: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const OBJ: &str = "# made by hand\n\no part\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf -3 -2 -1\n";
const GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"Door"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
        {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]}"#;

pub(crate) fn main() -> Outcome {
    let root = env::args_os().nth(1).ok_or("which folder?")?;
    fill(Path::new(&root))
}

/// Writes the seeds of each target into a folder of its own.
pub(crate) fn fill(root: &Path) -> Outcome {
    for (target, fill) in [
        ("open", open as fn(&Path) -> Outcome),
        ("texts", texts),
        ("requests", requests),
        ("streams", streams),
        ("inspect", inspect),
    ] {
        let folder = root.join(target);
        fs::create_dir_all(&folder)?;
        fill(&folder)?;
    }
    Ok(())
}

fn open(folder: &Path) -> Outcome {
    let cloud = PointCloud {
        points: (0..24)
            .map(|i| Point3::new((i % 6) as f32 * 0.1, (i / 6) as f32 * 0.1, 1.0))
            .collect(),
        colours: Some(vec![[1, 2, 3]; 24]),
        labels: Some((0..24).collect()),
        grid: Some(Grid {
            width: 6,
            height: 4,
        }),
        ..PointCloud::default()
    };
    for name in ["cloud.pcd", "cloud.ply", "cloud.xyz"] {
        save_cloud(&folder.join(name), &cloud)?;
    }
    write_depth_png(&folder.join("depth.png"), &small_depth())?;
    // The same points as the Point Cloud Library and scanners store them, and formats that are only read.
    let header = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n";
    fs::write(
        folder.join("ascii.pcd"),
        format!("{header}DATA ascii\n1 2 3 0\nnan 5 6 7\n"),
    )?;
    let mut packed = format!("{header}DATA binary_compressed\n").into_bytes();
    // 32 bytes as one literal run of LZF.
    packed.extend(33_u32.to_le_bytes());
    packed.extend(32_u32.to_le_bytes());
    packed.push(31);
    packed.extend([0x3f; 32]);
    fs::write(folder.join("packed.pcd"), packed)?;
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
               element face 2\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 1\n1 0 1\n1 1 1\n0 1 1\n3 0 1 2\n3 0 2 3\n";
    for (name, text) in [
        ("mesh.ply", ply),
        ("part.stl", STL),
        ("part.obj", OBJ),
        ("part.gltf", GLTF),
        (
            "table.csv",
            "\"X [m]\";\"Y [m]\";\"Z [m]\"\n0,1;0,2;1,5\n0,3;0,4;1,6\n",
        ),
    ] {
        fs::write(folder.join(name), text)?;
    }
    let mut stl = b"in binary".to_vec();
    stl.resize(80, b' ');
    stl.extend(1_u32.to_le_bytes());
    let corners = [
        0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0,
    ];
    stl.extend(corners.iter().flat_map(|number| number.to_le_bytes()));
    stl.extend([0, 0]);
    fs::write(folder.join("binary.stl"), stl)?;
    Ok(())
}

fn small_depth() -> DepthFrame {
    DepthFrame {
        intrinsics: Intrinsics {
            width: 6,
            height: 4,
            ..Intrinsics::KINECT
        },
        metres_per_unit: 0.001,
        depth: (900..924).collect(),
        is_simulated: false,
    }
}

fn texts(folder: &Path) -> Outcome {
    let place = RigidTransform::translation(0.1, 0.2, 1.3);
    let cameras = [
        CameraPlace::Fixed {
            robot_from_camera: place,
        },
        CameraPlace::OnFlange {
            flange_from_camera: place,
            capture_pose: Some(place),
        },
    ];
    for (number, camera) in cameras.into_iter().enumerate() {
        let calibration = CellCalibration {
            name: "cell".into(),
            notes: "north".into(),
            camera,
            origin: Origin::ByHand,
            made_at: jiff::Timestamp::UNIX_EPOCH,
        };
        calibration.save(&folder.join(format!("calibration{number}")))?;
    }
    let line = LineCalibration {
        direction: Unit::new_normalize(Vector3::new(-1.0, 0.0, 0.1)),
        direction_bound: Radians(0.001),
        way_per_count: Metres(0.0001),
        scale_bound: 0.002,
        counter: Counter::Bits16,
        residual: Metres(0.001),
        num_poses: 12,
        way: Metres(0.6),
        part: "fender".into(),
        made_at: jiff::Timestamp::UNIX_EPOCH,
        slip: 0.005,
        exposure: 0.03,
        delay: 0.08,
        delay_bound: 0.02,
    };
    line.save(&folder.join("line"))?;
    let beside = tempfile::tempdir()?;
    let image = beside.path().join("depth.png");
    write_depth_png(&image, &small_depth())?;
    fs::copy(image.with_extension("json"), folder.join("camera"))?;
    let recording = beside.path().join("recording");
    let mut source = open_source(&"simulated:fender".parse()?)?;
    let mut recorder = Recorder::create(&recording, "seed", "simulated", true)?;
    if let NextCapture::Captured(captured) = source.next(Duration::from_secs(60))? {
        recorder.write(&captured)?;
    }
    fs::copy(recording.join("recording.jsonl"), folder.join("recording"))?;
    fs::write(
        folder.join("recipe"),
        RecipeFile::built_in().text() + "\"rank.top\" = \"3\"\n",
    )?;
    let numbers = format!("{:?}", row_major(&place));
    for (name, text) in [
        ("nozzle", "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n12.5,-40,1141,0,0,2\n".to_owned()),
        ("surface", "x_m;y_m;z_m;normal_x;normal_y;normal_z;stand_off_mm\n0,1;0,2;1,3;0;0;-1;120\n".to_owned()),
        ("pairs", "# robot: kuka\n# camera: rotation-vector\np1 1450.5 -310 890.5 10 20 30 0.1 -0.03 1.2 0 0 0.5\n".to_owned()),
        ("pairs-json", r#"{"robot":"kuka","camera":"rotation-vector","pairs":[{"name":"p1","robot":[1450.5,-310,890.5,10,20,30],"camera":[0.1,-0.03,1.2,0,0,0.5]}]}"#.to_owned()),
        ("arm", "# robot: fanuc\ncapture, X, Y, Z, W, P, R\na.pcd, 1000, 0, 0, 0, 0, 90\n".to_owned()),
        ("frame-poses", format!(r#"{{"frames":{{"a.png":{{"world_from_camera":{numbers}}},"b.png":{{"robot_from_flange":{numbers}}}}}}}"#)),
        ("coat", built_in_coat("primer").ok_or("no primer")?.text()),
        ("stripe", "offset_mm,thickness_um\n-50,3\n0,40\n50,3\n".to_owned()),
        ("arm-model", "name = \"Cell 3\"\nlengths_mm = [150, -200, 0, 505, 760, 795, 100]\noffsets_deg = [0, 0, -90, 0, 0, 180]\nsigns = [1, 1, -1, -1, -1, -1]\nlimits_deg = [[-180, 180], [-105, 155], [-86, 160], [-200, 200], [-155, 150], [-455, 455]]\nspeeds_deg_s = [210, 210, 265, 420, 420, 885]\naccelerations_deg_s2 = [600, 600, 700, 1500, 1500, 2500]\n[rail]\ndirection = [0, 1, 0]\nfrom_mm = -2000\nto_mm = 2000\nspeed_mm_s = 1000\nacceleration_mm_s2 = 2000\n".to_owned()),
        ("obstacles", "floor_mm = -600\n[[box]]\nname = \"hanger\"\ncentre_mm = [1200, 0, 1900]\nsize_mm = [1500, 100, 100]\nangles_deg = [0, 0, 30]\n".to_owned()),
        ("rack", "schema_version = 1\nname = \"rack A\"\nframe = \"base\"\n[[volume]]\ncentre_mm = [0, 100, 2200]\nsize_mm = [2400, 1800, 900]\nangles_deg = [0, 0, 5]\n[[place]]\nname = \"left hook\"\ncentre_mm = [-600, 0, 2200]\nsize_mm = [300, 300, 300]\nmax_turn_deg = [10, 180, 10]\nparts = [{ name = \"fender\", angles_deg = [180, 0, 5] }, { name = \"grille\" }]\n".to_owned()),
        ("counts", "# frame; count\nframe-01.png; 40211\nframe-02.png; -40893\n".to_owned()),
        ("orders", "order;serial;parts\n4711;;fender|grille\n4711;TL-1;left hook=fender\n".to_owned()),
        ("sequence", "# timestamp filename\n1305031102.160400 depth/0.png\n".to_owned()),
    ] {
        fs::write(folder.join(name), text)?;
    }
    Ok(())
}

/// Requests of robots in every protocol.
fn requests(folder: &Path) -> Outcome {
    for (name, text) in [
        ("trigger", "TRIGGER\r\nTRIGGER 3 5\nTRIGGER 1=3 2=5\n"),
        ("order", "TRIGGER ORDER=\"A 17\" SERIAL=TL-1 ENC=7\n"),
        (
            "count",
            "TRIGGER ENC=123456@40\n<Robot><Request>TRIGGER</Request><Count Age=\"40\">7</Count></Robot>",
        ),
        (
            "eki-count",
            "<Robot><Request>TRIGGER</Request><Count Age=\"40\">-7</Count></Robot>",
        ),
        ("path", "STATUS\nLAST\nPATH 12 41\nPART 2\n"),
        (
            "servo",
            "SERVO 3 1450 -310 890 10 20 30\nSERVO START 3 1450 -310 890 1 0 0 0\n",
        ),
        ("servo-ur", "SERVO 3 p[1.45, -0.31, 0.89, 0.1, 0.2, 0.3]\n"),
        (
            "eki",
            "<Robot><Request>TRIGGER</Request><Point>0</Point><Expected>2=3 5</Expected></Robot>",
        ),
        (
            "eki-servo",
            "<Robot><Request>SERVO</Request><Expected>3</Expected><Start>1</Start><Pose X=\"1450\" Y=\"-310\" Z=\"890\" A=\"10\" B=\"20\" C=\"30\"></Pose></Robot>",
        ),
    ] {
        fs::write(folder.join(name), text)?;
    }
    for (order, name) in [(ByteOrder::Little, "little"), (ByteOrder::Big, "big")] {
        let wanted = Request::path(12, 41);
        fs::write(folder.join(name), binary_request(&wanted, order))?;
        let number = |little: &[u8]| -> Vec<u8> {
            let mut bytes = little.to_vec();
            if order == ByteOrder::Big {
                bytes.reverse();
            }
            bytes
        };
        let mut frame = b"PSRQ".to_vec();
        for short in [1_u16, 76, 6, 1] {
            frame.extend(number(&short.to_le_bytes()));
        }
        frame.extend(number(&3_u32.to_le_bytes()));
        for real in [1450.0_f64, -310.0, 890.0, 1.0, 0.0, 0.0, 0.0] {
            frame.extend(number(&real.to_le_bytes()));
        }
        frame.extend(number(&crc32(&frame).to_le_bytes()));
        fs::write(folder.join(format!("{name}-servo")), frame)?;
    }
    Ok(())
}

/// What controllers send from the opening of the connection to the first report, with the arm at several places.
fn streams(folder: &Path) -> Outcome {
    let placed = PlacedArm {
        arm: Arm::named("irb4600")?,
        robot_from_base: RigidTransform::identity(),
        flange_from_nozzle: RigidTransform::translation(0.0, 0.0, 0.2),
        gun_radius: GUN_RADIUS_M,
        obstacles: Obstacles::default(),
    };
    let places = [
        [0.2, 0.3, 0.1, 0.3, 0.7, -0.2],
        [0.0, 0.4, 0.2, 0.0, -1.5, 0.0],
        [-0.8, 0.1, 0.3, -0.2, 0.9, 2.0],
    ];
    for (number, joints) in places.into_iter().enumerate() {
        for protocol in StreamProtocol::ALL {
            let arm = SimulatedArm::new(placed.clone(), joints, ArmDynamics::default());
            let arm = arm.ok_or("the joints are not finite")?;
            let mut controller = SimulatedController::new(arm, placed.clone(), protocol);
            let mut stream = protocol.stream(&placed);
            let mut sent = Vec::new();
            loop {
                let request = stream.requests();
                if request.is_empty() {
                    break;
                }
                let answer = controller.take(&request)?;
                stream.receive(&answer)?;
                sent.extend(answer);
            }
            sent.extend(controller.report());
            fs::write(folder.join(format!("{}-{number}", protocol.name())), sent)?;
        }
    }
    Ok(())
}

/// Writes the width of the picture, then coordinates in tenths of a millimetre: simulated frames with fewer pixels,
/// and whole reference clouds with fewer points.
fn inspect(folder: &Path) -> Outcome {
    let coordinates = |points: &[Point3<f32>]| -> Vec<u8> {
        let numbers = points.iter().flat_map(|point| [point.x, point.y, point.z]);
        numbers
            .flat_map(|metres| ((metres * 10_000.0) as i16).to_le_bytes())
            .collect()
    };
    for (part, step) in [
        (PartKind::Fender, 8),
        (PartKind::FrontDoor, 5),
        (PartKind::Grille, 4),
    ] {
        let frame = simulated_frame(&CellSetup::with_part(part, Side::Left, 0, 1)).frame;
        let Intrinsics {
            width,
            height,
            fx,
            fy,
            cx,
            cy,
            ..
        } = frame.intrinsics;
        let mut points = Vec::new();
        for row in (0..height).step_by(step) {
            for column in (0..width).step_by(step) {
                let z = f64::from(frame.depth[row * width + column]) * frame.metres_per_unit;
                let (x, y) = ((column as f64 - cx) / fx * z, (row as f64 - cy) / fy * z);
                points.push(Point3::new(x as f32, y as f32, z as f32));
            }
        }
        let mut bytes = vec![width.div_ceil(step) as u8];
        bytes.extend(coordinates(&points));
        fs::write(folder.join(format!("frame-{part:?}")), bytes)?;
    }
    let library = LibraryFolder::open("reference_parts".as_ref())?
        .load(&Default::default())?
        .library;
    for reference in &library.references {
        let points = &reference.cloud.points;
        let few: Vec<Point3<f32>> = points
            .iter()
            .step_by(points.len().div_ceil(1500))
            .copied()
            .collect();
        let mut bytes = vec![0];
        bytes.extend(coordinates(&few));
        fs::write(folder.join(format!("part-{}", reference.name)), bytes)?;
    }
    Ok(())
}
