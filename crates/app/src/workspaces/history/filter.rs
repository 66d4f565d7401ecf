//! The filter of the list as entered by a person.

use jiff::{Span, Timestamp, Zoned, civil};

use records::history::{Filter, StoredVerdict, VerdictFilter};
use shell::language::{accepted_or_not, searched_texts};
use ui::{
    language::{described, text},
    widgets::sentence,
};

/// The filter of the list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ListFilter {
    /// The days shown.
    pub days: DateRange,
    /// First and last day as entered, for [`DateRange::Typed`].
    pub typed: [String; 2],
    /// Only inspections recognised as this part.
    pub part: Option<String>,
    /// Only inspections with these verdicts.
    pub verdict: Option<VerdictFilter>,
    /// Words to find in the names of part, scene and source (as stored or as displayed), the remark and the true label.
    pub text: String,
}

/// The verdicts that can be chosen, in the order of the menu.
pub(super) const VERDICTS: [VerdictFilter; 4] = [
    VerdictFilter::Only(StoredVerdict::Accepted),
    VerdictFilter::NotAccepted,
    VerdictFilter::Only(StoredVerdict::Unknown),
    VerdictFilter::Only(StoredVerdict::NoPart),
];

/// Name of these verdicts for a person.
pub(super) fn verdict_title(filter: VerdictFilter) -> String {
    match filter {
        VerdictFilter::Only(verdict) => described(&verdict),
        VerdictFilter::NotAccepted => accepted_or_not(false),
    }
}

/// The days of the inspections shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DateRange {
    /// Every day.
    #[default]
    All,
    /// Today.
    Today,
    /// Today and the six days before.
    Week,
    /// Today and the 29 days before.
    Month,
    /// The days entered in [`ListFilter::typed`].
    Typed,
}

impl DateRange {
    /// Every choice, in the order of the menu.
    pub const ALL: [Self; 5] = [Self::All, Self::Today, Self::Week, Self::Month, Self::Typed];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::All => text!("history-days-all"),
            Self::Today => sentence(&text!("history-today")),
            Self::Week => text!("history-days-week"),
            Self::Month => text!("history-days-month"),
            Self::Typed => text!("history-days-typed"),
        }
    }
}

/// Reads a day as entered; `None` if empty.
pub(super) fn day_of(text: &str) -> Result<Option<civil::Date>, jiff::Error> {
    match text.trim() {
        "" => Ok(None),
        text => text.parse().map(Some),
    }
}

impl ListFilter {
    /// Returns the filter for the database, at this moment and in its time zone. An invalid day is ignored.
    pub(super) fn at(&self, now: &Zoned) -> Filter {
        let begin = |day: civil::Date| {
            let day = day.to_zoned(now.time_zone().clone());
            day.ok().map(|day| day.timestamp())
        };
        let days_before = |days: i64| now.date().checked_sub(Span::new().days(days)).ok();
        let typed = |index: usize| day_of(&self.typed[index]).ok().flatten();
        let (since, until): (Option<Timestamp>, Option<Timestamp>) = match self.days {
            DateRange::All => (None, None),
            DateRange::Today => (begin(now.date()), None),
            DateRange::Week => (days_before(6).and_then(begin), None),
            DateRange::Month => (days_before(29).and_then(begin), None),
            DateRange::Typed => (
                typed(0).and_then(begin),
                typed(1).and_then(|day| begin(day.tomorrow().ok()?)),
            ),
        };
        // Without words, keep the filter that matches everything.
        let shown = if self.text.trim().is_empty() {
            Vec::new()
        } else {
            searched_texts()
        };
        Filter {
            since,
            until,
            part: self.part.clone(),
            verdict: self.verdict,
            is_simulated: None,
            source: None,
            rack: None,
            order: None,
            serial: None,
            with_below: false,
            text: self.text.clone(),
            shown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ui::language::Language;

    #[test]
    fn days_begin_and_end_as_the_clocks_here_go() {
        let now: Zoned = "2026-11-21T15:30:00+01:00[Europe/Berlin]"
            .parse()
            .expect("a moment");
        let filter = |days, from: &str, to: &str| {
            let typed = [from.to_owned(), to.to_owned()];
            let filter = ListFilter {
                days,
                typed,
                ..ListFilter::default()
            };
            let Filter { since, until, .. } = filter.at(&now);
            [since, until].map(|at| at.map_or_else(String::new, |at| at.to_string()))
        };
        assert_eq!(filter(DateRange::All, "", ""), ["", ""]);
        assert_eq!(
            filter(DateRange::Today, "", ""),
            ["2026-11-20T23:00:00Z", ""]
        );
        assert_eq!(
            filter(DateRange::Week, "", ""),
            ["2026-11-14T23:00:00Z", ""]
        );
        assert_eq!(
            filter(DateRange::Typed, " 2026-11-01", "2026-11-02"),
            ["2026-10-31T23:00:00Z", "2026-11-02T23:00:00Z"]
        );
        assert_eq!(filter(DateRange::Typed, "", "2026-11-0"), ["", ""]);
        assert!(day_of("2026-11-0").is_err());
    }

    #[test]
    fn words_are_looked_for_as_the_window_shows_them_too() {
        let filter = |text: &str| {
            let filter = ListFilter {
                text: text.into(),
                ..ListFilter::default()
            };
            filter.at(&geometry::clock::zoned_now())
        };
        // Without words, it matches everything as quickly as before.
        assert_eq!(filter("  ").shown, Vec::<[String; 2]>::new());
        Language::German.make_current();
        let shown = filter("bild").shown;
        Language::English.make_current();
        for expected in [
            ["simuliertes bild ", "=simulated_frame "],
            [", simuliert", "=simulated"],
            [" aufnahmen", "=shots "],
            ["simulierte zelle", "\nsimulated cell"],
        ] {
            assert!(shown.iter().any(|both| *both == expected), "{shown:?}");
        }
    }
}
