//! A verdict in the operator's words: why a part is not accepted, and what an operator can do about it.

use inspection::pipeline::Verdict;
use shell::{inspection::inspected::Inspected, session::Session};
use texts::{Described as _, Message};
use ui::language::{Language, text};

/// Returns why a part is not accepted, or there is none, with the titles of the parts; `None` if it is accepted.
pub(super) fn why_not(inspected: &Inspected) -> Option<Message> {
    let title_of = |name: &str| inspected.library.title_of(name).to_owned();
    let verdict = &inspected.inspection.verdict;
    if let Verdict::NoPart(why) = verdict {
        return Some(why.message());
    }
    // Of a mirror image, the part that it is the image of.
    let nearest = verdict.guess().unwrap_or_default();
    let why = verdict.rejected()?.message().with("nearest", nearest);
    Some(why.with_titles(title_of))
}

/// States why a part is not accepted, or there is none, without figures, which are for the engineer.
pub(super) fn in_short(why: &Message) -> String {
    of_operator(why, "short").unwrap_or_default()
}

/// States what an operator can do about it, if only to call the engineer.
pub(super) fn next_step(why: &Message, session: &Session) -> String {
    if let Some(step) = of_operator(why, "step") {
        let otherwise = of_operator(why, "otherwise").unwrap_or_default();
        return in_lines(step, session, otherwise);
    }
    of_operator(why, "next").unwrap_or_else(|| why.advice(Language::current()))
}

fn of_operator(why: &Message, attribute: &str) -> Option<String> {
    why.attribute(Language::current(), attribute)
}

/// Puts sentences into lines: a step, how this source is inspected again, and what to do if that does not help.
fn in_lines(step: String, session: &Session, otherwise: String) -> String {
    let again = if session.is_watching() {
        text!("operator-next-file")
    } else if session.is_live() {
        // Live inspects again by itself.
        String::new()
    } else if session.source.followed().is_none() {
        text!("operator-then-open")
    } else {
        text!("operator-then-capture")
    };
    let mut lines = vec![step, again, otherwise];
    lines.retain(|line| !line.is_empty());
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::pipeline::{Rejection, Unrecognisable};
    use shell::session::Source;
    use stages::segment::NoPart;

    #[test]
    fn the_advice_fits_the_source() {
        let why = Unrecognisable::NoPart(NoPart::TooFewPoints {
            found: 0,
            needed: 100,
        })
        .message();
        let mut session = Session::default();
        let advice = next_step(&why, &session);
        assert!(
            advice.contains("\nThen press Capture\nIf it persists"),
            "{advice}"
        );
        let file = Source::File("door.pcd".into());
        let source = std::mem::replace(&mut session.source, file);
        let advice = next_step(&why, &session);
        assert!(
            advice.contains("\nThen open the new capture\nIf it persists"),
            "{advice}"
        );
        session.source = source;
        // Capture would end Live, which inspects again by itself.
        session.live.is_on = true;
        let advice = next_step(&why, &session);
        assert_eq!(advice.lines().count(), 2, "{advice}");
        session.source = Source::Camera(Box::new("watch:captures".parse().expect("a source")));
        let advice = next_step(&why, &session);
        assert!(
            advice.contains("The next file") && !advice.contains("Capture"),
            "{advice}"
        );
    }

    #[test]
    fn both_are_advised_to_do_the_same_about_an_uncertain_pose() {
        let why = Rejection::AmbiguousPose {
            part: "grille".into(),
            margin: 0.43,
            threshold: 0.6,
        };
        let operator = next_step(&why.message(), &Session::default());
        let engineer = why.message().advice(Language::current());
        for advice in [operator, engineer] {
            let has = |words| advice.contains(words);
            assert!(
                has("Turn the part") && has("a corner or another edge"),
                "{advice}"
            );
        }
    }
}
