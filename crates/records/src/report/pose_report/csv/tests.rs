use std::fs;

use super::{
    super::tests::{door, empty, old, refused, reported, robot},
    *,
};
use stages::pose::ScaleEstimate;

fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).expect("a file");
    assert!(text.ends_with('\n'));
    text.lines().map(cells).collect()
}

/// Splits a line into cells according to RFC 4180.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        let last = cells.len() - 1;
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cells[last].push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            letter => cells[last].push(letter),
        }
    }
    cells
}

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("poses.csv");
    (folder, path)
}

#[test]
fn the_last_cells_say_what_is_wrong_with_a_part_that_was_accepted() {
    let (_folder, path) = folder();
    let mut inspection = door().inspection.clone();
    let Some(Ok(pose)) = &mut inspection.pose else {
        panic!("a pose");
    };
    pose.scale = Some(ScaleEstimate {
        scale: 1.05,
        deviation: 0.005,
    });
    let robot = robot();
    let doubted = door().doubted(
        &inspection,
        [Some(&robot), None],
        &[old(), old()],
        Convention::Kuka,
    );
    for report in [
        door().report(Some(&robot), Convention::Kuka),
        reported(),
        doubted,
    ] {
        append_csv(&path, &report).expect("appended");
    }
    let last: Vec<[String; 3]> = rows(&path)
        .into_iter()
        .map(|row| row[row.len() - 3..].to_vec().try_into().expect("three"))
        .collect();
    let expected = [
        ["reported_as", "off_scale", "robot_doubts"],
        ["", "", ""],
        ["back_door", "", ""],
        ["", "1.05", "old old"],
    ];
    assert_eq!(last, expected);
}

#[test]
fn rows_share_one_line_of_names_and_numbers_come_back() {
    let (_folder, path) = folder();
    let robot = robot();
    let report = door().report(Some(&robot), Convention::UniversalRobots);
    append_csv(&path, &report).expect("appended");
    append_csv(
        &path,
        &refused().report(Some(&robot), Convention::UniversalRobots),
    )
    .expect("appended");
    append_csv(&path, &empty().report(None, Convention::UniversalRobots)).expect("appended");
    let rows = rows(&path);
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let cell = |row: usize, name: &str| {
        let column = rows[0].iter().position(|column| column == name);
        rows[row][column.unwrap_or_else(|| panic!("no column {name}"))].as_str()
    };
    assert_eq!(cell(1, "scene"), "shift 2/door, left.pcd");
    assert_eq!(cell(1, "part"), "front_door");
    assert_eq!(cell(1, "seen_by"), "simulation");
    let block = report.robot.robot_offset.as_ref().expect("an offset");
    for value in &block.in_convention.values {
        let name = format!(
            "robot_offset_universal-robots_{}_{}",
            value.name,
            value.unit.symbol()
        );
        let read: f64 = cell(1, &name).parse().expect("a number");
        assert_eq!(read.to_bits(), value.value.to_bits(), "{name}");
    }
    // A refused part has no pose numbers at all.
    assert_eq!(cell(2, "accepted"), "false");
    for row in [2, 3] {
        for (column, value) in rows[0].iter().zip(&rows[row]) {
            let is_pose = ["camera_from_part", "robot_from_part", "robot_offset_"]
                .iter()
                .any(|name| column.starts_with(name));
            assert!(!is_pose || value.is_empty(), "{column}: {value}");
        }
    }
    assert!(cell(2, "robot_unavailable").contains("not accepted"));
}

#[test]
fn wherever_a_row_was_cut_off_every_whole_row_stays_and_the_next_one_fits() {
    let (_folder, path) = folder();
    let report = door().report(None, Convention::Kuka);
    append_csv(&path, &report).expect("appended");
    let header = fs::read(&path)
        .expect("a file")
        .iter()
        .position(|byte| *byte == b'\n')
        .expect("a line")
        + 1;
    append_csv(&path, &report).expect("appended");
    let whole = fs::read(&path).expect("a file");
    let row = (whole.len() - header) / 2;
    let aside = path.with_extension("csv.unfinished");
    for length in 0..=whole.len() {
        fs::write(&path, &whole[..length]).expect("cut");
        let appended = append_csv(&path, &report).expect("appended");
        let num_whole = length.saturating_sub(header) / row;
        let expected = &whole[..header + num_whole * row];
        let now = fs::read(&path).expect("a file");
        assert_eq!(&now[..expected.len()], expected, "cut at {length}");
        assert_eq!(now.len(), expected.len() + row, "cut at {length}");
        let cut = length.saturating_sub(header + num_whole * row);
        if length > header && cut > 0 {
            assert_eq!(appended, Some(aside.clone()), "cut at {length}");
            let kept = fs::read(&aside).expect("set aside");
            assert_eq!(&kept[..cut], &whole[header + num_whole * row..length]);
            fs::remove_file(&aside).expect("removed");
        } else {
            assert_eq!(appended, None, "cut at {length}");
        }
    }
}

#[test]
fn another_table_is_refused_and_left_as_it_is() {
    let (_folder, path) = folder();
    append_csv(&path, &door().report(None, Convention::Kuka)).expect("appended");
    let before = fs::read(&path).expect("a file");
    let refused = append_csv(&path, &door().report(None, Convention::Abb)).expect_err("refused");
    assert!(
        refused
            .to_string()
            .ends_with("its columns are not those of a pose report in ABB q1 q2 q3 q4")
    );
    assert!(refused.advice().contains("another file"));
    assert_eq!(fs::read(&path).expect("a file"), before);
    fs::write(&path, "my own notes").expect("written");
    append_csv(&path, &door().report(None, Convention::Abb)).expect_err("refused");
    assert_eq!(fs::read(&path).expect("a file"), b"my own notes");
    let missing = path.with_file_name("missing").join("poses.csv");
    let error = append_csv(&missing, &door().report(None, Convention::Abb)).expect_err("no folder");
    assert!(
        error.to_string().contains("the folder does not exist"),
        "{error}"
    );
}

#[test]
fn many_at_once_leave_whole_rows() {
    let (_folder, path) = folder();
    let report = door().report(None, Convention::Kuka);
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for _ in 0..10 {
                    append_csv(&path, &report).expect("appended");
                }
            });
        }
    });
    let rows = rows(&path);
    assert_eq!(rows.len(), 81);
    assert!(rows[1..].iter().all(|row| *row == rows[1]));
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_table_has_whole_rows_alone() {
    use files::disk::faults::{Writer, with_advice};

    let report = door().report(Some(&robot()), Convention::Kuka);
    let table = |folder: &Path| folder.join("poses.csv");
    // A new table, a growing one, and one with an incomplete last row of a killed program.
    for (number, begin) in ["", "whole", "half"].into_iter().enumerate() {
        // The process to be killed identifies its case by the folder alone.
        let is_mine = |folder: &Path| folder.join(number.to_string()).exists();
        Writer {
            test: "report::pose_report::csv::tests::whichever_call_fails_a_table_has_whole_rows_alone",
            prepare: &|folder| {
                fs::write(folder.join(number.to_string()), "").expect("written");
                if !begin.is_empty() {
                    append_csv(&table(folder), &report).expect("appended");
                }
                if begin == "half" {
                    let text = fs::read_to_string(table(folder)).expect("read");
                    fs::write(table(folder), text + "half a ro").expect("written");
                }
            },
            write: &|folder| {
                if !is_mine(folder) {
                    return Ok(());
                }
                let appended = append_csv(&table(folder), &report);
                appended.map(|_| ()).map_err(|error| with_advice(&error))
            },
            state: &|folder| {
                let text = fs::read_to_string(table(folder)).unwrap_or_default();
                let (whole, _) = text.rsplit_once('\n').unwrap_or_default();
                let rows: Vec<_> = whole.lines().map(cells).collect();
                assert!(rows.iter().all(|row| row.len() == rows[0].len()));
                format!("{} rows", rows.len().saturating_sub(1))
            },
            between: &[],
        }
        .fails_at_every_call();
    }
}
