//! The parts that hang before a followed source, side by side or one after the other: one inspection of each is written.

use std::time::Duration;

use super::{
    entry::NewEntry,
    hung::{HungId, HungRows},
};
use inspection::pipeline::{
    Inspection, Recipe, Verdict,
    live::{FrameRole, HungFrame, HungParts, LiveVerdict, MotionState, spots_of},
};
use stages::scene::SceneCloud;

/// The rows of every spot where a part hangs or hung. A spot that is empty again serves the next part.
#[derive(Debug)]
pub struct HungSpots<E = NewEntry> {
    spots: Vec<Spot<E>>,
    /// The last frame shows something somewhere.
    shows_part: bool,
    /// True if something moves in the last frame.
    is_moving: bool,
    /// Names of the parts that had a verdict that counts and left their spots since something has moved.
    leaving: Vec<String>,
}

#[derive(Debug)]
struct Spot<E> {
    rows: HungRows<E>,
    /// A frame by itself accepted the part that is there now.
    was_accepted: bool,
    /// The last frame shows something there.
    is_seen: bool,
    /// The name of the part there once its verdict counts.
    counted: Option<String>,
    /// What is held for it shows a part on its way out, whose verdict counted at another spot.
    is_leaving: bool,
}

/// The part at every spot at a moment, to tell which parts a frame shows that was inspected beside those of [`HungSpots::see`].
#[derive(Clone, Debug)]
pub struct SpotIds(Vec<(HungParts, HungId)>);

impl SpotIds {
    /// The parts of a frame by itself.
    pub fn of_frame(scene: &SceneCloud, parts: &[(&Inspection, &HungId)]) -> Self {
        let spot = |(inspection, id): &(&Inspection, &HungId)| {
            let mut spot = HungParts::default();
            spot.see(&HungFrame {
                scene,
                at: Duration::ZERO,
                inspection,
                verdict: &LiveVerdict::Open,
                middle: None,
                inputs: "",
            });
            (spot, (*id).clone())
        };
        Self(parts.iter().map(spot).collect())
    }

    /// The parts that a frame shows, inspected with this recipe.
    pub fn of(&self, found: &[Inspection], scene: &SceneCloud, recipe: &Recipe) -> Vec<HungId> {
        let known: Vec<&HungParts> = self.0.iter().map(|(parts, _)| parts).collect();
        let found: Vec<&Inspection> = found.iter().collect();
        let spots = spots_of(&known, &found, scene, MotionState::Watching, recipe);
        let ids = spots.into_iter().map(|spot| {
            let known = spot.and_then(|spot| self.0.get(spot));
            known.map_or_else(HungId::new, |(_, id)| id.clone())
        });
        ids.collect()
    }

    /// The part at every spot.
    pub fn all(&self) -> impl Iterator<Item = &HungId> {
        self.0.iter().map(|(_, id)| id)
    }
}

impl<E> Default for Spot<E> {
    fn default() -> Self {
        Self {
            rows: HungRows::default(),
            was_accepted: false,
            is_seen: false,
            counted: None,
            is_leaving: false,
        }
    }
}

impl<E> Default for HungSpots<E> {
    fn default() -> Self {
        Self {
            spots: vec![Spot::default()],
            shows_part: false,
            is_moving: false,
            leaving: Vec::new(),
        }
    }
}

impl<E> HungSpots<E> {
    /// Returns for every spot which part of a frame is there, as an index into `found`; `None` if the frame shows none there. Pass
    /// each spot to [`see`](Self::see) then. `found` is what [`run_all`](inspection::pipeline::run_all) found, with the frame's
    /// own verdicts.
    pub fn of_frame(
        &mut self,
        found: &[Inspection],
        scene: &SceneCloud,
        stillness: MotionState,
        recipe: &Recipe,
    ) -> Vec<Option<usize>> {
        let found: Vec<&Inspection> = found.iter().collect();
        self.shows_part = found.iter().any(|part| shows_something(part));
        let assigned = self.assign(&found, scene, stillness, recipe);
        let index_at = |spot| assigned.iter().position(|assigned| *assigned == Some(spot));
        let at_spots = (0..self.spots.len()).map(index_at).collect();
        self.is_moving = stillness == MotionState::Moving;
        if !self.is_moving {
            self.leaving.clear();
        }
        for (spot, index) in self.spots.iter_mut().zip(&at_spots) {
            let index: &Option<usize> = index;
            if self.is_moving && index.is_none() {
                self.leaving.extend(spot.counted.take());
            }
            // What hangs still is no part on its way out.
            spot.is_leaving &= self.is_moving || index.is_none();
            let is_accepted = index.is_some_and(|index| found[index].verdict.is_accepted());
            spot.was_accepted = is_accepted || (spot.was_accepted && !spot.rows.is_empty());
        }
        at_spots
    }

    /// The spot of each part of a frame.
    fn assign(
        &mut self,
        found: &[&Inspection],
        scene: &SceneCloud,
        stillness: MotionState,
        recipe: &Recipe,
    ) -> Vec<Option<usize>> {
        let known: Vec<_> = self.spots.iter().map(|spot| spot.rows.parts()).collect();
        let spots = spots_of(&known, found, scene, stillness, recipe);
        let num = spots.iter().flatten().max().map_or(0, |last| last + 1);
        while self.spots.len() < num {
            self.spots.push(Spot::default());
        }
        spots
    }

    /// As [`HungRows::role_of`], of what a frame shows at a spot.
    pub fn role_of(&self, spot: usize, frame: &HungFrame<'_>) -> FrameRole {
        self.spots[spot].rows.role_of(frame)
    }

    /// As [`HungRows::see`], of what a frame shows at a spot. Beside others, something that no frame accepted was no part when it
    /// has left.
    pub fn see(&mut self, spot: usize, frame: &HungFrame<'_>) -> (Option<E>, FrameRole) {
        let is_part = self.is_part(spot);
        let shown = &mut self.spots[spot];
        shown.is_seen = shows_something(frame.inspection);
        let may_move = frame.verdict.counted().is_none();
        if !shown.is_seen && self.shows_part && may_move && shown.rows.parts().is_passing() {
            // It may come into sight again among what moves there.
            return (None, FrameRole::Nothing);
        }
        let was_leaving = shown.is_leaving;
        let (left, role) = shown.rows.see(frame);
        let name = frame.inspection.verdict.guess();
        match role {
            FrameRole::Best => {
                let has_left = |name: &str| self.leaving.iter().any(|left| left == name);
                shown.is_leaving = self.is_moving && name.is_some_and(has_left);
                shown.counted = None;
            }
            FrameRole::First | FrameRole::Again => {
                shown.is_leaving = false;
                shown.counted = name.map(str::to_owned);
            }
            FrameRole::Nothing => {}
        }
        (left.filter(|_| is_part && !was_leaving), role)
    }

    fn is_part(&self, spot: usize) -> bool {
        let Spot {
            was_accepted,
            is_seen,
            ..
        } = self.spots[spot];
        let mut others = (0..self.spots.len()).filter(|other| *other != spot);
        was_accepted || is_seen || others.all(|other| self.spots[other].rows.is_empty())
    }

    /// The rows of a spot.
    pub fn at(&mut self, spot: usize) -> &mut HungRows<E> {
        &mut self.spots[spot].rows
    }

    /// The parts that a frame shows which was inspected beside those of [`see`](Self::see), and taken about when the last of those
    /// was: each as [`HungRows::id_of_frame`].
    pub fn ids_of(
        &mut self,
        found: &[&Inspection],
        scene: &SceneCloud,
        recipe: &Recipe,
    ) -> Vec<HungId> {
        let assigned = self.assign(found, scene, MotionState::Watching, recipe);
        let ids = assigned.iter().zip(found).map(|(spot, inspection)| {
            let shows_part = shows_something(inspection);
            match spot {
                Some(spot) => self.spots[*spot].rows.id_of_frame(shows_part),
                None => HungId::new(),
            }
        });
        ids.collect()
    }

    /// The part at every spot now, each as [`HungRows::id_of_frame`]; without `shows_part`, a frame shows a part where that last
    /// seen did.
    pub fn ids(&self, shows_part: Option<bool>) -> SpotIds {
        let spots = self.spots.iter().map(|spot| {
            let shows_part = shows_part.unwrap_or(spot.is_seen);
            let id = spot.rows.id_of_frame(shows_part);
            (spot.rows.parts().clone(), id)
        });
        SpotIds(spots.collect())
    }

    /// As [`HungRows::take_best`], of every spot.
    pub fn take_best(&mut self) -> Vec<E> {
        let mut best = Vec::new();
        for spot in 0..self.spots.len() {
            let is_part = self.is_part(spot);
            let is_leaving = self.spots[spot].is_leaving;
            let held = self.at(spot).take_best();
            best.extend(held.filter(|_| is_part && !is_leaving));
        }
        best
    }

    /// Ends the source. Returns the held inspections of parts whose verdict does not count yet.
    pub fn end(&mut self) -> Vec<E> {
        let best = self.take_best();
        for spot in &mut self.spots {
            spot.rows.end();
        }
        best
    }
}

/// True if it shows something, enrolled or not.
fn shows_something(inspection: &Inspection) -> bool {
    matches!(inspection.verdict, Verdict::Part { .. })
}
