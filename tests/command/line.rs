//! A line that carries parts past the camera.

use std::fs;

use crate::workplace::Workplace;

/// The value of a key of a TOML file.
fn number(text: &str, key: &str) -> f64 {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
    line.expect(key).parse().expect("a number")
}

/// Simulates the frames of a passing part in a folder `passing`, and returns the part's name and the frames.
fn passing(shop: &Workplace) -> (String, Vec<String>) {
    let made = shop.accepted(&["simulate", "--line", "passing"]);
    let next = made
        .out
        .split("partsight ")
        .nth(1)
        .expect("what to do next");
    let part = next.split_whitespace().nth(2).expect("the part").to_owned();
    let frames = (1..=12).map(|k| format!("passing/frame-{k:02}.png"));
    (part, frames.collect())
}

#[test]
fn a_line_is_calibrated_from_frames_and_counts_and_refused_with_what_to_do() {
    let shop = Workplace::new();
    let (part, frames) = passing(&shop);
    let with = |counts: &str, more: &[&str]| {
        let mut args = vec!["calibrate", "line", &part];
        args.extend(frames.iter().map(String::as_str));
        args.extend(["--counts", counts]);
        args.extend(more);
        shop.run(&args)
    };
    let ran = with("passing/counts.csv", &[]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    assert!(ran.out.contains("mm for each count"), "{}", ran.out);
    let text = fs::read_to_string(shop.path("line.toml")).expect("written");
    // The simulated encoder counts a tenth of a millimetre.
    let per_count = number(&text, "mm_per_count");
    let bound = number(&text, "scale_bound_percent");
    assert!(
        (per_count / 0.1 - 1.0).abs() < 0.02 && bound < 2.0,
        "{text}"
    );

    assert!(number(&text, "delay_bound_ms") == 0.0, "{text}");

    let written = fs::read_to_string(shop.path("passing/counts.csv")).expect("counts");
    let counts: Vec<String> = (written.lines())
        .filter(|line| !line.starts_with('#'))
        .map(|line| format!("{}; 7\n", line.split(';').next().expect("a name")))
        .collect();
    let counts = counts.concat();
    shop.write("still.csv", &counts);
    let ran = with("still.csv", &["--out", "none.toml"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(
        ran.err.contains("do not change") && ran.err.contains("to do"),
        "{}",
        ran.err
    );
    assert!(!shop.path("none.toml").exists());
    shop.write("few.csv", "frame-01.png; 1\n");
    let ran = with("few.csv", &[]);
    assert!(
        ran.code == 2 && ran.err.contains("no count of frame-02.png"),
        "{}",
        ran.err
    );
    shop.write("bad.csv", "frame-01.png; 1.5\n");
    let ran = with("bad.csv", &[]);
    assert!(
        ran.code == 2 && ran.err.contains("is no count of an encoder"),
        "{}",
        ran.err
    );

    // A file that was edited is not used.
    shop.write(
        "edited.toml",
        &text.replace("counter_bits = 32", "counter_bits = 16"),
    );
    let source = ["--source", "simulated:conveyor", "--frames", "1"];
    let args = [&["inspect"], &source[..], &["--line", "edited.toml"]].concat();
    let ran = shop.run(&args);
    assert!(
        ran.code == 2 && ran.err.contains("its checksum does not match"),
        "{}",
        ran.err
    );
}

#[test]
fn frames_after_a_stop_tell_how_late_the_camera_delivers() {
    let shop = Workplace::new();
    let (part, frames) = passing(&shop);
    let written = fs::read_to_string(shop.path("passing/counts.csv")).expect("counts");
    // The same, as if the last three frames showed the part after a stop at 100 mm/s, and the others came 80 ms late.
    let rows: Vec<(&str, i64)> = (written.lines())
        .filter_map(|line| line.split_once(';'))
        .filter_map(|(name, count)| Some((name, count.trim().parse().ok()?)))
        .collect();
    assert_eq!(rows.len(), 12, "{written}");
    let forward = (rows[11].1 - rows[0].1).signum();
    let late = rows[..9].iter().map(|(name, count)| {
        let count = count + 80 * forward;
        format!("{name}; {count}\n")
    });
    let stop = |counts: [i64; 3]| {
        let rows = rows[9..].iter().zip(counts);
        let rows = rows.map(|((name, _), count)| format!("{name}; {count}\n"));
        late.clone().chain(rows).collect::<String>()
    };
    shop.write("late.csv", &stop([rows[9].1, rows[10].1, rows[11].1]));
    let stopped = |counts: &str, out: &str| {
        let mut args = vec!["calibrate", "line", &part];
        args.extend(frames[..9].iter().map(String::as_str));
        for frame in &frames[9..] {
            args.extend(["--stop", frame.as_str()]);
        }
        args.extend(["--speed", "100", "--counts", counts, "--out", out]);
        shop.run(&args)
    };
    let moving = stopped("late.csv", "none.toml");
    assert_eq!(moving.code, 2, "{}", moving.out);
    assert!(
        moving.err.contains("the line was not stopped"),
        "{}",
        moving.err
    );
    // One frame at rest, three times.
    for k in [10, 11] {
        let bytes = fs::read(shop.path(&frames[9])).expect("a frame");
        fs::write(shop.path(&frames[k]), bytes).expect("written");
    }
    shop.write("late.csv", &stop([rows[9].1; 3]));
    let measured = stopped("late.csv", "late.toml");
    assert_eq!(measured.code, 0, "{}", measured.err);
    assert!(measured.out.contains("ms late, within"), "{}", measured.out);
    let late = fs::read_to_string(shop.path("late.toml")).expect("written");
    let (delay, bound) = (number(&late, "delay_ms"), number(&late, "delay_bound_ms"));
    assert!(bound > 1.0 && bound < 150.0, "{late}");
    assert!((delay - 80.0).abs() <= bound, "{late}");
}
