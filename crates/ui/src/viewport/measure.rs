//! Measures the distance between two picked points, and its components along the axes of the world.

use egui::{Align2, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2 as ScreenVec};
use glam::Vec3;

use super::{
    camera::ViewCamera,
    navigation::vec2,
    style::{Role, ViewStyle},
};
use crate::language::text;
use geometry::units::Metres;

/// Up to two picked points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    points: [Option<Vec3>; 2],
}

impl Measurement {
    /// Adds a point; a third one starts over.
    pub fn add(&mut self, point: Vec3) {
        self.points = match self.points {
            [Some(first), None] => [Some(first), Some(point)],
            _ => [Some(point), None],
        };
    }

    /// The distance, once both points are set.
    pub fn distance(&self) -> Option<Metres> {
        let [Some(a), Some(b)] = self.points else {
            return None;
        };
        Some(Metres(f64::from(a.distance(b))))
    }

    /// Formats the distance from the first point to the second, with its components on a second line.
    fn words(&self) -> Option<String> {
        let [Some(a), Some(b)] = self.points else {
            return None;
        };
        let axes = [("X", b.x - a.x), ("Y", b.y - a.y), ("Z", b.z - a.z)];
        let along = axes.map(|(axis, metres)| {
            let mm = Metres(f64::from(metres)).mm();
            // No sign on a value shown as zero.
            let mm = if mm.abs() < 0.05 { 0.0 } else { mm };
            format!("Δ{axis} {mm:+.1}")
                .replace("+0.0", "0.0")
                .replace('-', "\u{2212}")
        });
        Some(format!("{}\n{} mm", self.distance()?, along.join("  ")))
    }

    /// Tells the user which point to pick next; nothing once both are set.
    pub(super) fn next_step(&self) -> Option<String> {
        match self.points {
            [None, _] => Some(text!("view-measure-first")),
            [Some(_), None] => Some(text!("view-measure-second")),
            [Some(_), Some(_)] => None,
        }
    }

    /// Draws points, line and distance over the view.
    pub(super) fn ui(&self, painter: &Painter, rect: Rect, camera: &ViewCamera, style: &ViewStyle) {
        let colours = &style.colours;
        let stroke = Stroke::new(2.0, colours.role(Role::Measure).colour);
        let seen = self.points.map(|point| on_screen(point?, rect, camera));
        if let [Some(a), Some(b)] = seen {
            painter.line_segment(
                [a, b],
                Stroke::new(4.0, colours.background.gamma_multiply(0.6)),
            );
            painter.line_segment([a, b], stroke);
        }
        for at in seen.into_iter().flatten() {
            painter.circle(at, 4.0, colours.background, stroke);
        }
        if let ([Some(a), Some(b)], Some(words)) = (seen, self.words()) {
            plate(painter, a + (b - a) / 2.0, &words, style, Anchor::Middle);
        }
    }
}

/// Position of a text plate relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Centred on it.
    Middle,
    /// To its right.
    Right,
}

/// Draws text on a plate of the background colour, so that it is readable over any points.
pub(super) fn plate(painter: &Painter, at: Pos2, text: &str, style: &ViewStyle, anchor: Anchor) {
    let colours = &style.colours;
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(13.0), colours.text);
    let size = galley.size() + ScreenVec::new(12.0, 6.0);
    let rect = match anchor {
        Anchor::Middle => Align2::CENTER_CENTER.anchor_size(at, size),
        Anchor::Right => Align2::LEFT_CENTER.anchor_size(at + ScreenVec::new(8.0, 0.0), size),
    };
    // The end of the text stays inside the view.
    let beyond = (rect.right() - painter.clip_rect().right()).max(0.0);
    let rect = rect.translate(ScreenVec::new(-beyond, 0.0));
    painter.rect(
        rect,
        4.0,
        colours.background.gamma_multiply(0.85),
        Stroke::new(1.0, colours.weak_text.gamma_multiply(0.4)),
        StrokeKind::Inside,
    );
    painter.add(Shape::galley(
        rect.min + ScreenVec::new(6.0, 3.0),
        galley,
        colours.text,
    ));
}

/// Projects a world point to the window, if it lies inside the view.
pub(super) fn on_screen(point: Vec3, rect: Rect, camera: &ViewCamera) -> Option<Pos2> {
    let seen = camera.screen_from_world(point, vec2(rect.size()))?;
    let at = rect.min + ScreenVec::new(seen.x, seen.y);
    rect.contains(at).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_points_give_a_distance_and_a_third_begins_anew() {
        let mut measure = Measurement::default();
        measure.add(Vec3::ZERO);
        assert_eq!(measure.distance(), None);
        assert!(
            measure
                .next_step()
                .is_some_and(|next| next.contains("second"))
        );
        measure.add(Vec3::new(0.3, 0.4, 0.0));
        let distance = measure.distance().expect("two points");
        assert!((distance.mm() - 500.0).abs() < 1e-3);
        assert_eq!(measure.next_step(), None);
        let words = "500.0 mm\nΔX +300.0  ΔY +400.0  ΔZ 0.0 mm";
        assert_eq!(measure.words().as_deref(), Some(words));
        measure.add(Vec3::ONE);
        assert_eq!(measure.distance(), None);
        measure.add(Vec3::new(0.5, 1.0, 1.2));
        let words = "538.5 mm\nΔX \u{2212}500.0  ΔY 0.0  ΔZ +200.0 mm";
        assert_eq!(measure.words().as_deref(), Some(words));
    }
}
