//! What a 3-D view of a scan shows besides its points: cameras, surface that only one shot or no shot sees, and what the
//! colours mean.

use egui::Color32;

use geometry::units::Metres;
use shell::inspection::scan::{FusedShots, ScanFigure};
use ui::{
    language::text,
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

    /// What its colours mean.
    pub(crate) fn colour_keys(&self, colours: &ViewColours) -> Vec<(Color32, String)> {
        let mut keys = Vec::new();
        if self.unseen_points().is_some() {
            let text = match self.unseen {
                Some((_, share)) => text!("shots-not-seen", share = percent(share)),
                None => text!("shots-unseen", share = percent(self.figure().open_share)),
            };
            keys.push((colours.role(Role::Unseen).colour, text));
        }
        if let Some(shot) = self.looked_at
            && let Some(row) = self.fused.rows.get(shot)
        {
            let text = text!(
                "shots-seen-by-one",
                shot = shot + 1,
                share = percent(row.only)
            );
            keys.push((colours.role(Role::SeenOnce).colour, text));
        }
        keys
    }
}
