//! What a 3-D view of a scan shows besides its points: cameras, surface that only one shot or no shot sees, and the legend.

use egui::{Align2, Color32, Painter, Pos2, Rect, vec2};

use geometry::units::Metres;
use shell::inspection::{fuse::FusedShots, scan_figure::ScanFigure};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font},
    viewport::{PointSet, Role, TextLabel, ViewColours, ViewScene},
};

/// Diameter of a scan's points: they are means over voxels of 4 mm, whose diagonal is longer.
pub(crate) const POINT_SIZE: Metres = Metres(0.006);

/// Formats a share as a percentage, so that a small one differs from none.
pub(super) fn percent(share: f64) -> String {
    match share * 100.0 {
        percent if percent > 0.0 && percent < 1.0 => "< 1 %".to_owned(),
        percent => format!("{percent:.0} %"),
    }
}

/// Overlay of the points of a scan.
pub(crate) struct Overlay<'a> {
    pub(crate) fused: &'a FusedShots,
    /// Surface of the recognised part that no shot has seen, and its share; `None` without a recognised part, and then the
    /// open outline is shown.
    pub(crate) unseen: Option<(&'a PointSet, f64)>,
    /// Index of the shot whose own surface is marked.
    pub(crate) looked_at: Option<usize>,
    /// Whether the cameras are drawn.
    pub(crate) has_cameras: bool,
    /// Whether unseen surface is drawn.
    pub(crate) has_unseen: bool,
}

impl Overlay<'_> {
    fn figure(&self) -> &ScanFigure {
        &self.fused.figure
    }

    fn unseen_points(&self) -> Option<&PointSet> {
        let points = match self.unseen {
            Some((points, _)) => Some(points),
            None => self.figure().open_band.as_ref(),
        };
        points.filter(|_| self.has_unseen)
    }

    fn own_points(&self) -> Option<&PointSet> {
        self.figure().only.get(self.looked_at?)?.as_ref()
    }

    /// Adds the overlay to a view that shows only the points of the scan.
    pub(crate) fn add_to(&self, scene: &mut ViewScene) {
        scene.points.extend(self.unseen_points().cloned());
        scene.points.extend(self.own_points().cloned());
        if !self.has_cameras {
            return;
        }
        for camera in &self.figure().cameras {
            scene.lines.push(camera.lines.clone());
            scene.labels.push(TextLabel {
                at: camera.at,
                text: format!("{}", camera.place + 1),
            });
        }
    }

    /// Returns the colours of the legend with their texts.
    fn entries(&self, colours: &ViewColours) -> Vec<(Color32, String)> {
        let mut entries = Vec::new();
        if self.unseen_points().is_some() {
            let text = match self.unseen {
                Some((_, share)) => text!("shots-not-seen", share = percent(share)),
                None => text!("shots-unseen", share = percent(self.figure().open_share)),
            };
            entries.push((colours.role(Role::Unseen).colour, text));
        }
        if let Some(place) = self.looked_at
            && let Some(row) = self.fused.rows.get(place)
        {
            let text = text!(
                "shots-seen-by-one",
                shot = place + 1,
                share = percent(row.only)
            );
            entries.push((colours.role(Role::SeenOnce).colour, text));
        }
        entries
    }

    /// Draws the legend with its lower left corner at `corner`.
    pub(crate) fn legend(
        &self,
        painter: &Painter,
        corner: Pos2,
        colours: &ViewColours,
        theme: &Theme,
    ) {
        const LINE: f32 = 20.0;
        const SQUARE: f32 = 11.0;
        let entries = self.entries(colours);
        let lines = entries.into_iter().map(|(colour, text)| {
            let galley = painter.layout_no_wrap(text, font::small(), theme.text);
            (colour, galley)
        });
        let lines: Vec<_> = lines.collect();
        if lines.is_empty() {
            return;
        }
        let width = lines.iter().map(|(_, text)| text.size().x);
        let width = width.fold(0.0, f32::max) + SQUARE + 24.0;
        let size = vec2(width, LINE * lines.len() as f32 + 6.0);
        let plate = Align2::LEFT_BOTTOM.anchor_size(corner, size);
        painter.rect_filled(plate, ROUNDING, theme.canvas.gamma_multiply(0.82));
        for (place, (colour, text)) in lines.into_iter().enumerate() {
            let middle = plate.top() + 3.0 + LINE * (place as f32 + 0.5);
            let at = Pos2::new(plate.left() + 8.0, middle);
            let square = Align2::LEFT_CENTER.anchor_size(at, vec2(SQUARE, SQUARE));
            painter.rect_filled(square, 2.0, colour);
            let left = Pos2::new(square.right() + 8.0, middle - text.size().y / 2.0);
            let place = Rect::from_min_size(left, text.size());
            painter.galley(place.min, text, theme.text);
        }
    }
}
