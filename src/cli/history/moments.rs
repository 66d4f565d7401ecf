//! Days and times on the command line.

use jiff::{Span, Timestamp, Zoned, civil, tz::TimeZone};

/// Parses the beginning of a range.
pub(super) fn parse_since(text: &str) -> Result<Timestamp, String> {
    parse(text, &geometry::clock::zoned_now()).map(|[first, _]| first)
}

/// Parses the end of a range: the end of the day, or just after the given time.
pub(super) fn parse_until(text: &str) -> Result<Timestamp, String> {
    parse(text, &geometry::clock::zoned_now()).map(|[_, end]| end)
}

/// Returns the first time that is meant, and the first one after it that is not.
fn parse(text: &str, now: &Zoned) -> Result<[Timestamp; 2], String> {
    let zone = now.time_zone().clone();
    let day = match text.strip_suffix('d').map(str::parse::<u32>) {
        Some(Ok(days)) => now
            .date()
            .checked_sub(Span::new().days(days.min(36_500)))
            .ok(),
        _ if text == "today" => Some(now.date()),
        _ => text
            .parse::<civil::Date>()
            .ok()
            .filter(|_| !text.contains(['T', ' '])),
    };
    if let Some(day) = day {
        return of_day(day, &zone).ok_or_else(|| format!("no such day: {text}"));
    }
    let moment = text.parse::<Timestamp>().ok().or_else(|| {
        let here = text.parse::<civil::DateTime>().ok()?;
        Some(here.to_zoned(zone).ok()?.timestamp())
    });
    let moment = moment.ok_or_else(|| {
        "expected a day (2026-11-20), a moment (2026-11-20T14:00), today, or days back (7d)"
            .to_owned()
    })?;
    let next = moment.checked_add(jiff::SignedDuration::from_micros(1));
    Ok([moment, next.unwrap_or(moment)])
}

fn of_day(day: civil::Date, zone: &TimeZone) -> Option<[Timestamp; 2]> {
    let begin = |day: civil::Date| Some(day.to_zoned(zone.clone()).ok()?.timestamp());
    Some([begin(day)?, begin(day.tomorrow().ok()?)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> [String; 2] {
        let now: Zoned = "2026-11-21T15:30:00+01:00[Europe/Berlin]"
            .parse()
            .expect("a moment");
        parse(text, &now).expect(text).map(|at| at.to_string())
    }

    #[test]
    fn days_and_moments_are_those_of_the_clocks_here() {
        assert_eq!(
            parsed("today"),
            ["2026-11-20T23:00:00Z", "2026-11-21T23:00:00Z"]
        );
        assert_eq!(
            parsed("2026-11-20"),
            ["2026-11-19T23:00:00Z", "2026-11-20T23:00:00Z"]
        );
        assert_eq!(parsed("7d")[0], "2026-11-13T23:00:00Z");
        assert_eq!(parsed("2026-11-20T14:00")[0], "2026-11-20T13:00:00Z");
        assert_eq!(
            parsed("2026-11-20T14:00:00Z")[1],
            "2026-11-20T14:00:00.000001Z"
        );
        // The day on which daylight saving time ends has 25 hours.
        assert_eq!(
            parsed("2026-10-25"),
            ["2026-10-24T22:00:00Z", "2026-10-25T23:00:00Z"]
        );
    }

    #[test]
    fn nonsense_is_refused_with_what_is_expected() {
        let now = geometry::clock::zoned_now();
        for text in ["", "yesterday", "xd", "2026-13-01", "-3d"] {
            let refused = parse(text, &now).expect_err(text);
            assert!(refused.contains("2026-11-20"), "{refused}");
        }
    }
}
