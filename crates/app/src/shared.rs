//! What several workspaces draw: the frame of a side panel, the thumbnails of the library, the menu of a scene's true label, and
//! the curve of a run of visual servoing.

use std::{collections::BTreeSet, sync::Arc};

use egui::{
    Color32, ColorImage, Context, Frame, Margin, Painter, Rect, Sense, TextureHandle,
    TextureOptions, Ui, WidgetInfo, pos2, vec2,
};
use image::RgbaImage;

use geometry::units::{Metres, Radians};
use inspection::library::{PartMeta, Truth};
use records::history::ServoSample;
use shell::inspection::library_cache::LibraryView;
use ui::{
    language::text,
    plot::FallingCurve,
    theme::{Theme, space},
    widgets::{fitted, menu_list},
};

/// Textures of the enrolled parts' thumbnails, made once per library.
#[derive(Default)]
pub(crate) struct Thumbnails(Option<(Arc<LibraryView>, Vec<Option<TextureHandle>>)>);

impl Thumbnails {
    /// Uploads the thumbnails of another library.
    pub(crate) fn make(&mut self, ctx: &Context, library: &Arc<LibraryView>) {
        let made = self.0.as_ref();
        if made.is_some_and(|(of, _)| Arc::ptr_eq(of, library)) {
            return;
        }
        let all = library.thumbnails.iter().map(|thumbnail| {
            let thumbnail = thumbnail.as_ref()?;
            Some(thumbnail_texture(ctx, "enrolled part", thumbnail))
        });
        self.0 = Some((Arc::clone(library), all.collect()));
    }

    /// Texture of the enrolled part at this index.
    pub(crate) fn of_part(&self, index: usize) -> Option<&TextureHandle> {
        self.0.as_ref()?.1.get(index)?.as_ref()
    }
}

/// Uploads a thumbnail.
pub(crate) fn thumbnail_texture(ctx: &Context, name: &str, image: &RgbaImage) -> TextureHandle {
    let size = [image.width() as usize, image.height() as usize];
    let image = ColorImage::from_rgba_unmultiplied(size, image.as_raw());
    ctx.load_texture(name, image, TextureOptions::LINEAR)
}

/// Draws a picture as large as the rectangle allows.
pub(crate) fn paint_fitted(painter: &Painter, texture: &TextureHandle, rect: Rect) {
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let at = fitted(rect, texture.aspect_ratio());
    painter.image(texture.id(), at, whole, Color32::WHITE);
}

/// The frame of a part of a side panel, with this room above and below what is in it, logical pixels.
pub(crate) fn panel_frame(theme: &Theme, top: i8, bottom: i8) -> Frame {
    Frame::new().fill(theme.panel).inner_margin(Margin {
        left: 16,
        right: 14,
        top,
        bottom,
    })
}

/// Returns the title of a true label; of `None`, that it is not set.
pub(crate) fn truth_title(truth: Option<&Truth>, library: &LibraryView) -> String {
    match truth {
        None => text!("shell-truth-not-set"),
        Some(Truth::NotEnrolled) => text!("shell-truth-not-enrolled"),
        Some(Truth::Nothing) => text!("shell-truth-nothing"),
        Some(Truth::Part(name)) => library.title_of(name).to_owned(),
    }
}

/// Draws the entries: `first` at the top, so that they are visible however many parts there are, then every enrolled part.
/// Calls `choose` with the pressed one.
pub(crate) fn truth_entries(
    ui: &mut Ui,
    chosen: Option<&Truth>,
    first: &[Option<Truth>],
    library: &LibraryView,
    mut choose: impl FnMut(Option<Truth>),
) {
    let mut entry = |ui: &mut Ui, truth: Option<Truth>| {
        let title = truth_title(truth.as_ref(), library);
        let response = ui.selectable_label(chosen == truth.as_ref(), &title);
        // Other lists contain the same part names.
        response.widget_info(|| {
            let label = text!("shell-actual-part", part = &title);
            WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        if response.clicked() {
            choose(truth);
            ui.close();
        }
    };
    ui.set_min_width(220.0);
    menu_list(ui, |ui| {
        for truth in first {
            entry(ui, truth.clone());
        }
        ui.separator();
        // A part may have several references, of which a verdict names the part.
        let mut seen = BTreeSet::new();
        for part in library.parts.iter().map(PartMeta::part_name) {
            if seen.insert(part) {
                entry(ui, Some(Truth::Part(part.as_str().to_owned())));
            }
        }
    });
}

/// Draws what was left of the error over time, as shift and as angle: side by side in a wide place and one below the other in a
/// narrow one.
pub(crate) fn servo_curve(
    ui: &mut Ui,
    curve: &[ServoSample],
    (tolerance_m, tolerance_rad): (f64, f64),
    height: f32,
) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let gap = space::SMALL;
    let [first, second] = if size.x > 1.5 * height {
        let middle = rect.center().x;
        [
            Rect::from_min_max(rect.min, pos2(middle - gap / 2.0, rect.bottom())),
            Rect::from_min_max(pos2(middle + gap / 2.0, rect.top()), rect.max),
        ]
    } else {
        let middle = rect.center().y;
        [
            Rect::from_min_max(rect.min, pos2(rect.right(), middle - gap / 2.0)),
            Rect::from_min_max(pos2(rect.left(), middle + gap / 2.0), rect.max),
        ]
    };
    let shifts = points(curve, |sample| Some(Metres(sample.error_m?).mm()));
    let turns = points(curve, |sample| Some(Radians(sample.error_rad?).degrees()));
    let limit_name = text!("servoing-tolerance");
    for (place, title, points, limit, unit, colour) in [
        (
            first,
            text!("servoing-shift-left"),
            shifts,
            Metres(tolerance_m).mm(),
            "mm",
            theme.first_series,
        ),
        (
            second,
            text!("servoing-turn-left"),
            turns,
            Radians(tolerance_rad).degrees(),
            "°",
            theme.second_series,
        ),
    ] {
        let curve = FallingCurve {
            title: &title,
            points: &points,
            limit: (limit, &limit_name),
            unit,
            colour,
        };
        curve.show(ui, place);
    }
}

fn points(curve: &[ServoSample], of: impl Fn(&ServoSample) -> Option<f64>) -> Vec<[f64; 2]> {
    let values = curve
        .iter()
        .filter_map(|sample| Some([sample.at_s, of(sample)?]));
    values.collect()
}
