//! The inspections that clients may ask for again, and their numbers.

use std::{
    collections::VecDeque,
    hash::{BuildHasher as _, RandomState},
    sync::{Arc, OnceLock},
};

use jiff::Timestamp;

use super::answer::{FrameParts, Inspected, MAX_COUNT, Problem};

/// Inspected frames that are kept for clients that name one by its number, such as after a lost connection.
const NUM_KEPT: usize = 16;

/// The last inspections of a server, and those that a client still holds.
#[derive(Debug)]
pub(super) struct Inspections {
    boot: u32,
    /// Number of the last part inspected; 0 before the first one.
    sequence: u32,
    /// The oldest first.
    kept: VecDeque<Arc<Inspected>>,
}

impl Inspections {
    /// Starts the numbering, with a new boot number.
    pub(super) fn start() -> Self {
        Self {
            boot: boot_number(geometry::clock::now()),
            sequence: 0,
            kept: VecDeque::new(),
        }
    }

    /// The present boot number, 1..=[`MAX_COUNT`].
    pub(super) fn boot(&self) -> u32 {
        self.boot
    }

    /// The last inspection, or one without a verdict if there is none.
    pub(super) fn last(&self) -> Arc<Inspected> {
        let none = || {
            Arc::new(Inspected {
                boot: self.boot,
                ..Inspected::default()
            })
        };
        self.kept.back().map_or_else(none, Arc::clone)
    }

    /// The frame with the part of this number, if it is still kept, and the part's place in it, from 0.
    pub(super) fn find(&self, sequence: u32) -> Option<(Arc<Inspected>, usize)> {
        let mut newest_first = self.kept.iter().rev();
        newest_first.find_map(|inspected| {
            let mut indices = 0..inspected.found.iter().count();
            let index = indices.find(|index| inspected.sequence_of(*index) == sequence)?;
            Some((Arc::clone(inspected), index))
        })
    }

    /// Numbers the parts of a frame that is not asked for again.
    pub(super) fn number(&mut self, found: FrameParts) -> Arc<Inspected> {
        let inspected = Arc::new(Inspected {
            sequence: self.sequence % MAX_COUNT + 1,
            boot: self.boot,
            found,
            revoked: OnceLock::new(),
        });
        self.sequence = inspected.sequence_of(inspected.found.others.len());
        inspected
    }

    /// Numbers the parts of the next frame, which becomes the last one.
    pub(super) fn add(&mut self, found: FrameParts) -> Arc<Inspected> {
        let inspected = self.number(found);
        self.kept.push_back(Arc::clone(&inspected));
        let mut num_surplus = self.kept.len().saturating_sub(NUM_KEPT);
        // What a client holds stays, so that it can be revoked.
        self.kept.retain(|kept| {
            let is_surplus = num_surplus > 0;
            num_surplus = num_surplus.saturating_sub(1);
            !is_surplus || Arc::strong_count(kept) > 1
        });
        inspected
    }

    /// Refuses every inspection so far that was accepted: their poses and paths do not go out any more.
    pub(super) fn revoke(&self, problem: &Problem) {
        for inspected in &self.kept {
            // The first reason stays.
            let _ = inspected.revoked.set(problem.clone());
        }
    }

    /// Draws a new boot number, because the meaning of poses has changed: every inspection so far is revoked and dropped.
    /// The numbers of inspections go on, so that none is used twice.
    pub(super) fn renew(&mut self) {
        self.revoke(&Problem::numbers_changed());
        self.kept.clear();
        let before = self.boot;
        while self.boot == before {
            self.boot = boot_number(geometry::clock::now());
        }
    }
}

/// The boot number of a start. Time alone would give cells that start together the same number, so it is hashed with keys that
/// the system draws at random: two starts have the same number once in 16 million.
fn boot_number(now: Timestamp) -> u32 {
    let hash = RandomState::new().hash_one(now.as_nanosecond());
    u32::try_from(hash % u64::from(MAX_COUNT)).unwrap_or(0) + 1
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::{Found, VerdictCode};

    fn accepted() -> FrameParts {
        let verdict = VerdictCode::Accepted;
        Found {
            verdict,
            ..Found::default()
        }
        .into()
    }

    /// A frame of this many parts.
    fn several(num: usize) -> FrameParts {
        let FrameParts { first, .. } = accepted();
        FrameParts {
            others: vec![first.clone(); num - 1],
            ..first.into()
        }
    }

    #[test]
    fn every_part_of_a_frame_has_a_number_of_its_own_that_leads_to_it() {
        let mut inspections = Inspections::start();
        assert_eq!(inspections.add(accepted()).sequence, 1);
        assert_eq!(inspections.add(several(3)).sequence, 2);
        assert_eq!(inspections.add(accepted()).sequence, 5);
        let found = |sequence| {
            inspections
                .find(sequence)
                .map(|(frame, index)| (frame.sequence, index))
        };
        let found_at = [1, 2, 3, 4, 5, 6].map(found);
        let expected = [(1, 0), (2, 0), (2, 1), (2, 2), (5, 0)].map(Some);
        assert_eq!(found_at[..5], expected);
        assert_eq!(found_at[5], None);
        // Numbers go on from one within a frame too.
        inspections.sequence = MAX_COUNT - 2;
        let last = inspections.add(several(3));
        assert_eq!(
            [0, 1, 2].map(|index| last.sequence_of(index)),
            [MAX_COUNT - 1, MAX_COUNT, 1]
        );
        assert_eq!(inspections.add(accepted()).sequence, 2);
    }

    #[test]
    fn sequence_numbers_go_on_from_one_and_never_reach_zero() {
        let mut inspections = Inspections::start();
        assert_eq!(inspections.last().sequence, 0);
        assert_eq!(inspections.add(accepted()).sequence, 1);
        assert_eq!(inspections.last().sequence, 1);
        inspections.sequence = MAX_COUNT - 1;
        assert_eq!(inspections.add(accepted()).sequence, MAX_COUNT);
        assert_eq!(inspections.add(accepted()).sequence, 1);
    }

    #[test]
    fn the_newest_are_kept_and_older_ones_while_a_client_holds_them() {
        let mut inspections = Inspections::start();
        let held = inspections.add(accepted());
        for _ in 0..3 * NUM_KEPT {
            inspections.add(accepted());
        }
        assert!(inspections.kept.len() <= NUM_KEPT + 1);
        assert!(inspections.find(1).is_some() && inspections.find(2).is_none());
        let last = inspections.last().sequence;
        assert!(inspections.find(last - NUM_KEPT as u32 + 2).is_some());
        inspections.revoke(&Problem::reported_wrong());
        assert!(held.revoked.get().is_some());
        drop(held);
        inspections.add(accepted());
        assert!(inspections.find(1).is_none());
        assert!(inspections.last().revoked.get().is_none());
    }

    #[test]
    fn once_poses_mean_something_else_the_boot_number_is_another_and_nothing_is_kept() {
        let mut inspections = Inspections::start();
        let held = inspections.add(accepted());
        let before = inspections.boot();
        inspections.renew();
        assert_ne!(inspections.boot(), before);
        assert_eq!(
            (held.boot, inspections.last().boot),
            (before, inspections.boot())
        );
        assert_eq!(inspections.last().sequence, 0);
        assert!(inspections.find(1).is_none());
        let why = held.revoked.get().expect("revoked");
        assert_eq!(why.reason, "numbers_changed");
        assert_eq!(inspections.add(accepted()).sequence, 2);
    }

    #[test]
    fn starts_at_the_same_moment_have_different_numbers_that_are_never_zero() {
        let now = Timestamp::from_second(1_800_000_000).expect("a time");
        let numbers: BTreeSet<u32> = (0..1000).map(|_| boot_number(now)).collect();
        // Of a thousand out of 16 million, hardly ever are two the same.
        assert!(numbers.len() > 990, "{}", numbers.len());
        assert!(
            numbers
                .iter()
                .all(|number| (1..=MAX_COUNT).contains(number))
        );
    }
}
