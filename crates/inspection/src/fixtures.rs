//! What tests of this crate and of those above it build.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

use std::{fs, path::Path, sync::LazyLock};

use geometry::units::{Metres, Radians};
use stages::{
    contour::ContourError,
    fixtures::{FREEDOMS, pose_errors},
    pose::OffScale,
    project::ProjectError,
    reference::ReferenceParams,
    segment::NoPart,
    signature::SignatureError,
};

use crate::{
    library::{EnrolParams, Library, LibraryFolder, enrol_standard_parts},
    pipeline::{Rejection, Unrecognisable},
};

/// The folder of the eight shipped parts.
pub const SHIPPED_PARTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reference_parts");

/// The eight shipped parts, loaded once, with what is else built when a pose is first tried.
pub fn shipped_library() -> Library {
    static LOADED: LazyLock<Library> = LazyLock::new(|| {
        let folder = LibraryFolder::open(SHIPPED_PARTS.as_ref()).expect("the shipped parts");
        let load = folder.load(&ReferenceParams::default()).expect("loaded");
        for reference in &load.library.references {
            reference.prefetch();
            reference.borders();
        }
        load.library
    });
    LOADED.clone()
}

/// The eight parts of the simulated standard car, enrolled once.
pub fn standard_library() -> Library {
    static ENROLLED: LazyLock<Library> =
        LazyLock::new(|| enrol_standard_parts(&EnrolParams::default()).expect("eight parts"));
    ENROLLED.clone()
}

/// Copies the shipped parts into a new folder, for a test to change.
pub fn copy_library(to: &Path) {
    for part in fs::read_dir(SHIPPED_PARTS).expect("the shipped parts") {
        let from = part.expect("a part").path();
        if from.is_dir() {
            let name = from.file_name().expect("a name");
            copy_part(name.to_str().expect("a plain name"), to);
        }
    }
}

/// Copies a shipped part into a library.
pub fn copy_part(name: &str, library: &Path) {
    let to = library.join(name);
    fs::create_dir_all(&to).expect("made");
    for file in fs::read_dir(Path::new(SHIPPED_PARTS).join(name)).expect("listed") {
        let file = file.expect("a file").path();
        fs::copy(&file, to.join(file.file_name().expect("a name"))).expect("copied");
    }
}

/// Enrols a copy of a part of this library as another reference of it, without a title.
pub fn add_reference(library: &Path, part: &str, name: &str) {
    let (from, to) = (library.join(part), library.join(name));
    fs::create_dir(&to).expect("made");
    for file in ["cloud.ply", "signature.json", "thumbnail.png"] {
        fs::copy(from.join(file), to.join(file)).expect("copied");
    }
    let meta = fs::read_to_string(from.join("part.toml")).expect("read");
    let lines = meta.lines().map(|line| match line.split_once(" = ") {
        Some(("name", _)) => format!("name = \"{name}\"\npart = \"{part}\"\n"),
        Some(("title", _)) => String::new(),
        _ => format!("{line}\n"),
    });
    let lines: Vec<String> = lines.collect();
    fs::write(to.join("part.toml"), lines.concat()).expect("written");
}

/// Every rejection; those with several texts more than once.
pub fn rejections() -> Vec<Rejection> {
    let part = "Fender, left".to_owned();
    let (score, threshold, margin) = (0.456, 0.9, 0.125);
    let piece = |hidden, outside| Rejection::Piece {
        part: "Fender, left".into(),
        score,
        threshold,
        hidden,
        outside,
    };
    let mut all = vec![
        Rejection::LowScore {
            part: part.clone(),
            score,
            threshold,
        },
        piece(0.4, 0.0),
        piece(0.0, 0.4),
        piece(0.2, 0.2),
        Rejection::HardlySeen {
            part: part.clone(),
            score,
        },
        Rejection::AnotherModel {
            part: part.clone(),
            relief: Metres(0.0042),
            outline: Metres(0.0119),
            missing: 0.0123,
        },
        Rejection::AnotherMake {
            part: part.clone(),
            likeness: 0.7,
        },
        Rejection::AmbiguousPose {
            part: part.clone(),
            margin,
            threshold,
        },
        Rejection::Uncertain {
            part: part.clone(),
            shift: Metres(0.0213),
            limit: Metres(0.015),
            frames_disagree: false,
        },
        Rejection::Uncertain {
            part: part.clone(),
            shift: Metres(0.0213),
            limit: Metres(0.015),
            frames_disagree: true,
        },
        Rejection::Unknown {
            nearest: part.clone(),
            score,
        },
        Rejection::Mirrored {
            part: part.clone(),
            score,
        },
        Rejection::MirroredImage {
            part: part.clone(),
            score,
        },
        Rejection::OffScale {
            part: part.clone(),
            off: OffScale {
                is_larger: true,
                by: 0.05,
            },
        },
        Rejection::OtherHalf {
            part: part.clone(),
            score,
        },
        Rejection::SmallMargin {
            part: part.clone(),
            other: "Grille".into(),
            margin,
            threshold,
        },
        Rejection::Unconfirmed { part: part.clone() },
        Rejection::OutOfRange {
            part: part.clone(),
            depth: Metres(31.456),
        },
        Rejection::BehindCamera {
            part: part.clone(),
            share: 0.0321,
        },
        Rejection::SurplusBytes {
            part: part.clone(),
            num: 4096,
        },
    ];
    all.extend(FREEDOMS.map(|freedom| Rejection::Unconstrained {
        part: part.clone(),
        freedom,
    }));
    all.extend(rejections_of_frames(&part));
    all.extend(rejections_of_others(&part));
    all.extend(pose_errors().into_iter().map(Rejection::NoPose));
    all
}

/// Those of parts that are not expected, or hang where or as they may not.
fn rejections_of_others(part: &str) -> [Rejection; 7] {
    [
        Rejection::WrongPart {
            part: part.into(),
            expected: "Grille".into(),
        },
        Rejection::NotExpected { part: part.into() },
        Rejection::ExpectedElsewhere {
            part: part.into(),
            place: "right hook".into(),
            expected_at: "left hook".into(),
        },
        Rejection::CutByVolume { part: part.into() },
        Rejection::WrongPlace {
            part: part.into(),
            place: "left hook".into(),
        },
        Rejection::BesidePlaces {
            part: part.into(),
            place: "left hook".into(),
            distance: Metres(0.12),
        },
        Rejection::Turned {
            part: part.into(),
            place: "left hook".into(),
            turn: Radians(3.1),
            limit: Radians(0.35),
        },
    ]
}

/// Those that several frames give.
fn rejections_of_frames(part: &str) -> [Rejection; 7] {
    let [num_agreeing, num_frames, needed] = [2, 5, 4];
    [
        Rejection::NotSteady { part: part.into() },
        Rejection::Passing {
            part: part.into(),
            num_frames,
            needed,
        },
        Rejection::Smeared {
            part: part.into(),
            smear: Metres(0.0166),
            limit: Metres(0.012),
        },
        Rejection::FewFrames {
            part: part.into(),
            num_frames,
            needed,
        },
        Rejection::TooSlow {
            part: part.into(),
            num_inspected: num_agreeing,
            num_frames: 30,
        },
        Rejection::Undecided {
            part: part.into(),
            num_agreeing,
            num_frames,
            needed,
        },
        Rejection::PosesApart {
            part: part.into(),
            num_agreeing,
            num_frames,
            needed,
        },
    ]
}

/// Every unrecognisable scene except a fault of the program; those with several texts more than once.
pub fn unrecognisables() -> Vec<Unrecognisable> {
    let only_background = |knows_cell| {
        Unrecognisable::NoPart(NoPart::OnlyBackground {
            planes: 2,
            found: 0.0123,
            needed: 0.02,
            knows_cell,
        })
    };
    vec![
        NoPart::TooFewPoints {
            found: 12,
            needed: 200,
        }
        .into(),
        NoPart::TooWide { extent: 1234.5 }.into(),
        only_background(false),
        only_background(true),
        ProjectError::NoPlane {
            num_points: 5,
            width: 0.000_12,
        }
        .into(),
        ProjectError::TooLarge {
            found: 21.04,
            limit: 10.0,
        }
        .into(),
        ContourError::NoShape { num_set: 7 }.into(),
        SignatureError::NoOutline { num_points: 1 }.into(),
        Unrecognisable::EmptyLibrary,
    ]
}
