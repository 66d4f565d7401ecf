//! The documentation: links are valid, and the commands shown exist.

use std::{
    fs,
    path::{Path, PathBuf},
};

use clap::Parser as _;
use partsight::cli::Cli;

/// Every page with its text.
fn pages() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [
        "",
        "docs",
        "docs/guide",
        "assets",
        "reference_parts",
        "fuzz",
        "python",
    ];
    let entries = folders.map(|folder| fs::read_dir(root.join(folder)).expect("a folder"));
    let paths = entries.into_iter().flatten();
    let paths = paths.map(|entry| entry.expect("a file").path());
    let pages = paths.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let read = |path: PathBuf| (path.clone(), fs::read_to_string(path).expect("text"));
    pages.map(read).collect()
}

/// The anchor that web views of repositories give a heading.
fn anchor_of(heading: &str) -> String {
    let title = heading.trim_start_matches('#').trim().to_lowercase();
    let is_kept = |c: &char| c.is_alphanumeric() || matches!(c, '-' | '_');
    title.replace(' ', "-").chars().filter(is_kept).collect()
}

#[test]
fn every_relative_link_leads_to_a_file_and_a_heading() {
    let mut num_links = 0;
    for (page, text) in pages() {
        let prose: String = text.split("```").step_by(2).collect();
        let links = prose.split("](").skip(1);
        let links = links.filter_map(|rest| rest.split_once(')'));
        for (link, _) in links.filter(|(link, _)| !link.contains("://")) {
            num_links += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => page.clone(),
                file => page.with_file_name(file),
            };
            assert!(target.exists(), "{}: {link}", page.display());
            if !anchor.is_empty() {
                let text = fs::read_to_string(target).expect("text");
                let mut headings = text.lines().filter(|line| line.starts_with('#'));
                let is_there = headings.any(|heading| anchor_of(heading) == anchor);
                assert!(is_there, "{}: {link}", page.display());
            }
        }
    }
    assert!(num_links > 30, "{num_links} links");
}

/// The words of a command, without a comment after it.
fn words(line: &str) -> Vec<&str> {
    let line = line.split(" #").next().unwrap_or("");
    let pieces = line.split('"').enumerate();
    // Every second piece is quoted and is one word.
    let words = pieces.map(|(i, piece)| match i % 2 {
        0 => piece.split_whitespace().collect(),
        _ => vec![piece],
    });
    words.collect::<Vec<_>>().concat()
}

#[test]
fn every_command_in_a_block_of_shell_is_one() {
    let mut num_commands = 0;
    for (page, text) in pages() {
        let blocks = text.split("```sh\n").skip(1);
        let lines = blocks.flat_map(|block| block.split("```").next().unwrap_or("").lines());
        let commands = lines.flat_map(|line| line.split(" && "));
        for command in commands.filter(|line| line.starts_with("partsight ")) {
            num_commands += 1;
            if let Err(error) = Cli::try_parse_from(words(command)) {
                panic!("{}: {command}\n{error}", page.display());
            }
        }
    }
    assert!(num_commands > 40, "{num_commands} commands");
}

#[test]
fn an_example_of_the_robot_s_guide_makes_the_files_that_it_reads_or_names_the_example_that_does() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/robot.md");
    let text = fs::read_to_string(page).expect("text");
    let mut num_read = 0;
    for section in text.split("\n## ") {
        let (heading, _) = section.split_once('\n').unwrap_or((section, ""));
        let made_above = section.contains("of the [example above](#");
        let blocks = section.split("```sh\n").skip(1);
        let lines = blocks.flat_map(|block| block.split("```").next().unwrap_or("").lines());
        let mut made = Vec::new();
        for line in lines {
            let words = words(line);
            let mut former = "";
            for word in words {
                if matches!(former, "--out" | ">") {
                    made.push(word);
                } else if matches!(word, "cell.toml" | "fender.pcd" | "taught.csv") {
                    num_read += 1;
                    let is_known = made_above || made.contains(&word);
                    assert!(is_known, "{heading}: where does {word} come from? {line}");
                }
                former = word;
            }
        }
    }
    assert!(num_read > 5, "{num_read} files");
}
