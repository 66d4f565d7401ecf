use std::{fs, io::Write as _, path::Path};

use super::*;
use crate::source::Image;
use files::{depth_png::intrinsics_path, save_cloud, write_depth_png};
use geometry::{cloud::PointCloud, depth_frame::DepthFrame, fixtures::small_frame};

/// A folder that the test looks at explicitly, so that no test waits for a clock.
struct Bench {
    folder: tempfile::TempDir,
    source: WatchedFolder,
}

impl Bench {
    fn new(from: WatchedFrom) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let source = WatchedFolder::new(&WatchedSpec {
            folder: folder.path().join("scans"),
            from,
        });
        fs::create_dir(folder.path().join("scans")).unwrap();
        Self { folder, source }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("scans").join(name)
    }

    /// What a look yields: names of captures, and names with a mark for unreadable files.
    fn look(&mut self) -> Vec<String> {
        self.source.look().unwrap();
        let mut names = Vec::new();
        while let Some(path) = self.source.ready.pop_front() {
            match self.source.take(&path) {
                Some(NextCapture::Captured(captured)) => names.push(captured.name),
                Some(NextCapture::Skipped(skipped)) => names.push(format!("!{}", skipped.name)),
                _ => {}
            }
        }
        names
    }

    fn looks(&mut self, num: u32) -> Vec<String> {
        (0..num).flat_map(|_| self.look()).collect()
    }
}

fn cloud(x: f32) -> PointCloud {
    PointCloud::from_points([nalgebra::Point3::new(x, 0.0, 1.0)])
}

fn frame() -> DepthFrame {
    small_frame(2, [900, 901])
}

fn save(path: &Path, x: f32) {
    save_cloud(path, &cloud(x)).unwrap();
}

#[test]
fn a_file_is_taken_once_when_it_has_stopped_changing() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let path = bench.path("door.pcd");
    save(&path, 1.0);
    assert!(bench.look().is_empty(), "it may still be written");
    assert_eq!(bench.look(), ["door.pcd"]);
    assert!(bench.looks(20).is_empty());
}

#[test]
fn a_file_that_is_written_slowly_waits_until_it_is_whole() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let whole = bench.folder.path().join("whole.ply");
    save_cloud(
        &whole,
        &PointCloud::from_points((0..500).map(|k| nalgebra::Point3::new(k as f32, 0.0, 1.0))),
    )
    .unwrap();
    let bytes = fs::read(&whole).unwrap();
    let path = bench.path("slow.ply");
    let mut file = fs::File::create(&path).unwrap();
    let (most, last) = bytes.split_at(bytes.len() - 10);
    for piece in most.chunks(1000) {
        file.write_all(piece).unwrap();
        file.sync_all().unwrap();
        // Longer than two looks: it seems complete, and cannot be read.
        assert!(bench.looks(4).is_empty());
    }
    file.write_all(last).unwrap();
    drop(file);
    assert_eq!(bench.looks(3), ["slow.ply"]);
    assert!(bench.looks(MAX_UNREADABLE_LOOKS + 2).is_empty());
}

#[test]
fn a_capture_arrived_when_its_file_was_first_seen_with_its_time() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let path = bench.path("door.pcd");
    // The second file is a new one of the same name.
    for (x, seconds) in [(1.0, 10), (2.0, 20)] {
        save(&path, x);
        let file = fs::File::options().write(true).open(&path).unwrap();
        let written = std::time::UNIX_EPOCH + Duration::from_secs(seconds);
        file.set_modified(written).unwrap();
        let before = Instant::now();
        assert!(bench.look().is_empty(), "it may still be written");
        let after = Instant::now();
        let ready = (0..3).find_map(|_| {
            bench.source.look().unwrap();
            bench.source.ready.pop_front()
        });
        let ready = ready.expect("complete");
        let Some(NextCapture::Captured(captured)) = bench.source.take(&ready) else {
            panic!("a capture");
        };
        assert!((before..=after).contains(&captured.arrived), "{x}");
    }
}

#[test]
fn files_come_in_the_order_they_were_written() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let at = |seconds| std::time::UNIX_EPOCH + Duration::from_secs(seconds);
    for (name, seconds) in [
        ("b.pcd", 30),
        ("scan10.pcd", 20),
        ("scan9.pcd", 20),
        ("a.pcd", 40),
    ] {
        save(&bench.path(name), 1.0);
        let file = fs::File::options()
            .write(true)
            .open(bench.path(name))
            .unwrap();
        file.set_modified(at(seconds)).unwrap();
    }
    assert_eq!(
        bench.looks(2),
        ["scan9.pcd", "scan10.pcd", "b.pcd", "a.pcd"]
    );
}

#[test]
fn what_is_no_capture_is_left_alone_and_what_cannot_be_read_is_named_once() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    for name in ["log.txt", "scan.pcd.part", ".scan.pcd", "part.step"] {
        fs::write(bench.path(name), "not for us").unwrap();
    }
    image::GrayImage::new(2, 2)
        .save(bench.path("preview.png"))
        .unwrap();
    fs::create_dir(bench.path("folder.pcd")).unwrap();
    fs::write(bench.path("broken.pcd"), "# .PCD v0.7\nVERSION 0.7\n").unwrap();
    save(&bench.path("good.pcd"), 1.0);
    assert_eq!(
        bench.looks(2),
        ["good.pcd"],
        "nothing waits for a broken file"
    );
    assert_eq!(bench.looks(MAX_UNREADABLE_LOOKS), ["!broken.pcd"]);
    assert!(bench.looks(3 * MAX_UNREADABLE_LOOKS).is_empty());
    save(&bench.path("broken.pcd"), 2.0);
    assert_eq!(bench.looks(3), ["broken.pcd"], "mended, it is a capture");
}

#[test]
fn a_picture_without_depth_is_named_where_no_capture_has_come() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let picture = image::GrayImage::new(2, 2);
    picture.save(bench.path("photo.png")).unwrap();
    assert_eq!(bench.looks(2 * MAX_UNREADABLE_LOOKS), ["!photo.png"]);
}

#[test]
fn a_depth_image_waits_for_its_camera() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let aside = bench.folder.path().join("frame.png");
    write_depth_png(&aside, &frame()).unwrap();
    let path = bench.path("frame.png");
    fs::copy(&aside, &path).unwrap();
    assert!(bench.looks(5).is_empty());
    fs::copy(intrinsics_path(&aside), intrinsics_path(&path)).unwrap();
    assert_eq!(bench.looks(3), ["frame.png"]);
    assert!(bench.looks(2 * MAX_UNREADABLE_LOOKS).is_empty());
}

#[test]
fn a_renamed_file_and_one_that_is_written_again_are_new() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let aside = bench.path("latest.pcd.tmp");
    for round in 0..3 {
        // Every round has another size, like another scan.
        let points = (0..=round).map(|k| nalgebra::Point3::new(k as f32, 0.0, 1.0));
        let made = bench.folder.path().join("made.pcd");
        save_cloud(&made, &PointCloud::from_points(points)).unwrap();
        fs::copy(&made, &aside).unwrap();
        assert!(bench.looks(3).is_empty());
        fs::rename(&aside, bench.path("latest.pcd")).unwrap();
        assert_eq!(bench.looks(3), ["latest.pcd"], "round {round}");
    }
}

#[test]
fn beside_many_old_files_a_new_one_is_found_at_once_and_a_rewritten_one_in_its_turn() {
    const NUM_OLD: usize = 2 * MAX_RECHECKED + 500;
    let mut bench = Bench::new(WatchedFrom::Now);
    let made = bench.folder.path().join("made.xyz");
    let write = |path: &Path, num: usize| {
        fs::write(&made, "0 0 1\n".repeat(num)).unwrap();
        fs::copy(&made, path).unwrap();
    };
    for number in 0..NUM_OLD {
        fs::write(bench.path(&format!("old-{number}.xyz")), "0 0 1\n").unwrap();
    }
    assert_eq!(bench.source.look().unwrap(), NUM_OLD);
    for number in 0..3 {
        write(&bench.path(&format!("new-{number}.xyz")), 1);
        assert_eq!(bench.looks(2), [format!("new-{number}.xyz")]);
        let num_read = bench.source.look().unwrap();
        assert!(num_read <= MAX_RECHECKED, "{num_read}");
    }
    // The first time it waits for its turn, from then on it is looked at every time.
    let rewritten = bench.path("old-1700.xyz");
    write(&rewritten, 2);
    assert_eq!(bench.looks(5), ["old-1700.xyz"]);
    for num in 3..6 {
        write(&rewritten, num);
        assert_eq!(bench.looks(3), ["old-1700.xyz"]);
    }
    // A file that was away is another.
    for number in 0..3 {
        let name = format!("old-{number}.xyz");
        fs::remove_file(bench.path(&name)).unwrap();
        assert!(bench.look().is_empty());
        write(&bench.path(&name), 2);
        assert_eq!(bench.looks(3), [name]);
    }
}

#[test]
fn what_lay_there_before_is_taken_only_if_wanted() {
    for (from, expected) in [
        (WatchedFrom::Now, &[][..]),
        (WatchedFrom::All, &["old.pcd"]),
    ] {
        let mut bench = Bench::new(from);
        save(&bench.path("old.pcd"), 1.0);
        assert_eq!(bench.looks(3), expected);
        save(&bench.path("new.pcd"), 1.0);
        assert_eq!(bench.looks(3), ["new.pcd"]);
    }
}

#[test]
fn the_folder_may_vanish_and_come_back() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    save(&bench.path("one.pcd"), 1.0);
    assert_eq!(bench.looks(2), ["one.pcd"]);
    let (here, away) = (bench.path(""), bench.folder.path().join("unplugged"));
    fs::rename(&here, &away).unwrap();
    let gone = bench.source.look().unwrap_err();
    assert!(matches!(
        gone,
        CaptureError::FolderGone { may_come: true, .. }
    ));
    assert_eq!(gone.recovery(), crate::Recovery::AskAgain);
    // While a share is away, its mount point is an empty folder.
    fs::create_dir(&here).unwrap();
    assert!(bench.looks(2).is_empty());
    fs::remove_dir(&here).unwrap();
    save(&away.join("two.pcd"), 2.0);
    fs::rename(&away, &here).unwrap();
    assert_eq!(
        bench.looks(3),
        ["two.pcd"],
        "and the first one is not taken again"
    );
}

#[test]
fn a_file_that_vanished_before_it_was_read_is_taken_when_it_is_back() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    save(&bench.path("one.pcd"), 1.0);
    bench.source.look().unwrap();
    bench.source.look().unwrap();
    assert_eq!(bench.source.ready.len(), 1);
    let away = bench.folder.path().join("away.pcd");
    fs::rename(bench.path("one.pcd"), &away).unwrap();
    assert!(bench.looks(2).is_empty());
    fs::rename(&away, bench.path("one.pcd")).unwrap();
    assert_eq!(bench.looks(3), ["one.pcd"]);
}

#[test]
fn an_image_without_a_reading_is_a_capture_of_nothing() {
    let mut bench = Bench::new(WatchedFrom::Now);
    bench.look();
    let dark = DepthFrame {
        depth: vec![0, 0],
        ..frame()
    };
    write_depth_png(&bench.path("dark.png"), &dark).unwrap();
    bench.source.look().unwrap();
    bench.source.look().unwrap();
    let path = bench.source.ready.pop_front().expect("complete");
    let Some(NextCapture::Captured(captured)) = bench.source.take(&path) else {
        panic!("a capture");
    };
    assert_eq!(captured.image, Image::Cloud(PointCloud::default()));
}

#[test]
fn asked_for_a_capture_it_looks_by_itself() {
    let bench = Bench::new(WatchedFrom::All);
    save(&bench.path("one.pcd"), 1.0);
    let mut source = bench.source;
    let mut captured = None;
    for _ in 0..600 {
        match source.next(Duration::from_millis(50)).unwrap() {
            NextCapture::Captured(found) => {
                captured = Some(found.name);
                break;
            }
            NextCapture::NotYet => {}
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(captured.as_deref(), Some("one.pcd"));
}
