//! Conventions of poses and numbers of parts for robots and other systems, as command line options.

use clap::Args;

use super::{
    console::{Advised as _, Console, advised_error},
    input::{Choice, choice, parse_convention},
};
use inspection::library::{GivenNumbers, LibraryLoad, LibraryPlace, PartNumbers};
use robot::{Convention, spray::off_the_part};
use serve::PoseKind;
use station::NumberedPart;
use texts::Message;

/// The numbers of poses and parts.
#[derive(Debug, Default, PartialEq, Eq, Args)]
pub(super) struct NumbersChoice {
    /// Convention of the poses; the protocols eki and urscript of serve have their own
    #[arg(long = "as", value_name = "CONVENTION", value_parser = parse_convention)]
    pub(super) convention: Option<Convention>,
    /// Which pose is given; default: robot-from-part
    #[arg(long, value_parser = choice(&POSES))]
    transform: Option<PoseKind>,
    /// The number by which robots know an enrolled part, from 1 to 9999; may be given several times. Without any, parts
    /// have the numbers that partsight library list shows; one without a number gets the next, and keeps it
    #[arg(long, value_name = "NAME=N", value_parser = parse_number)]
    number: Vec<PartNumber>,
}

#[rustfmt::skip]
const POSES: [Choice<PoseKind>; 2] = [
    ("robot-from-part", "Where the part is: for a path in the part's own frame", PoseKind::RobotFromPart),
    ("robot-offset", "How far it is from its standard position: for a path taught in the base frame", PoseKind::RobotOffset),
];

/// A part and its number for robots.
#[derive(Clone, Debug, PartialEq, Eq)]
struct PartNumber {
    name: String,
    number: u32,
}

fn parse_number(text: &str) -> Result<PartNumber, String> {
    let read = text.split_once('=').and_then(|(name, number)| {
        let number = number.parse::<u32>().ok();
        let number = number.filter(|number| (1..=9999).contains(number))?;
        let name = name.to_owned();
        Some(PartNumber { name, number })
    });
    read.ok_or_else(|| "expected NAME=N with a number from 1 to 9999, such as fender=3".into())
}

impl NumbersChoice {
    /// Returns which pose to give.
    pub(super) fn kind(&self) -> PoseKind {
        self.transform.unwrap_or_default()
    }

    /// Returns number and path of each reference, in the order of the library. Unless numbers are given, gives one to each
    /// part of the library that has none.
    pub(super) fn parts(
        &self,
        place: &LibraryPlace,
        load: &LibraryLoad,
        console: &Console,
    ) -> anyhow::Result<Vec<NumberedPart>> {
        let given = &self.number;
        let names = load.parts.iter().map(|part| part.name.as_str());
        let names: Vec<&str> = names.collect();
        for (i, PartNumber { name, number }) in given.iter().enumerate() {
            if !names.contains(&name.as_str()) {
                return Err(advised_error(
                    format!("--number {name}={number}: the library has no part {name}"),
                    format!("Give one of {}", names.join(", ")),
                ));
            }
            let is_same = |other: &PartNumber| other.name == *name || other.number == *number;
            if given[..i].iter().any(is_same) {
                return Err(advised_error(
                    format!("--number {name}={number}: the part or the number was already given"),
                    "Give each part one number of its own",
                ));
            }
        }
        let stored = if given.is_empty() {
            numbers_of(place, console)?
        } else {
            PartNumbers::default()
        };
        let parts = load.parts.iter().zip(&load.library.references);
        let parts = parts.map(|(meta, reference)| {
            let name = meta.name.as_str();
            let number = given.iter().find(|given| given.name == name);
            let number = number.map(|given| given.number);
            let path = place.spray_path(name).unwrap_or_else(|error| {
                console.warn(&format_args!("{name} has no spray path: {error}"), &error);
                None
            });
            let off = path.as_ref().and_then(|path| off_the_part(path, reference));
            if let Some(off) = &off {
                console.warn(&format_args!("robots get no path of {name}: {off}"), off);
            }
            NumberedPart {
                number: number.or_else(|| stored.number_of(&meta.name)).unwrap_or(0),
                path,
                off,
                is_simulated: meta.simulated,
            }
        });
        Ok(parts.collect())
    }
}

/// The numbers of the library's parts.
fn numbers_of(place: &LibraryPlace, console: &Console) -> anyhow::Result<PartNumbers> {
    let GivenNumbers { numbers, unstored } = place.give_numbers().advised()?;
    if let Some(error) = unstored {
        console.warn(
            &Message::new("numbers-not-stored").with("reason", &*error.to_string()),
            &error,
        );
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_belongs_to_a_name() {
        let read = parse_number("fender=3").expect("read");
        assert_eq!((read.name.as_str(), read.number), ("fender", 3));
        for text in [
            "fender",
            "fender=",
            "fender=0",
            "fender=10000",
            "3",
            "fender=x",
        ] {
            let error = parse_number(text).expect_err(text);
            assert!(error.contains("NAME=N"), "{error}");
        }
    }
}
