//! One 3-D view per method, all with the same camera.

use std::sync::Arc;

use egui::{Align2, Rect, RichText, Ui, UiBuilder, Vec2, pos2, vec2};

use super::{
    pair::Pair,
    playback::MethodComparison,
    plot,
    state::AlignState,
    track::{MethodRun, Track, doubted, in_the_window},
};
use geometry::units::Metres;
use shell::session::{Session, ThemeChoice};
use stages::pose::PoseMethod;
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    viewport::{
        Role, RoleColour, ViewCamera, ViewColours, ViewDirection, ViewError, ViewScene, ViewStyle,
        Viewport, ViewportGpu, scene::mat4,
    },
};

/// Height of the text above a wide and a narrow view, logical pixels.
const HEAD: [f32; 2] = [66.0, 98.0];
/// Width below which a view's figures take two lines, logical pixels.
const TWO_LINE_WIDTH_PX: f32 = 300.0;
/// Point size. Reference clouds are thinned to 8 mm: they look closed from afar, and the other cloud still shows
/// between.
const POINT: Metres = Metres(0.0075);

/// Relative point size of the source: smaller than the target's, so that neither hides the other where they coincide.
const SOURCE_WEIGHT: f32 = 0.6;

/// The views and their shared camera.
pub(super) struct LinkedViews {
    views: Vec<View>,
    camera: ViewCamera,
    has_focus: bool,
    /// The pair shown.
    shows: Option<Arc<Pair>>,
    /// Size of a view when they were fitted, logical pixels.
    size: Vec2,
}

struct View {
    method: PoseMethod,
    viewport: Viewport,
    scene: ViewScene,
}

impl LinkedViews {
    pub(super) fn new(gpu: &Result<ViewportGpu, ViewError>) -> Self {
        let view = |method| View {
            method,
            viewport: Viewport::new(gpu.clone()),
            scene: ViewScene::default(),
        };
        Self {
            views: PoseMethod::ALL.into_iter().map(view).collect(),
            camera: ViewCamera::default(),
            has_focus: false,
            shows: None,
            size: Vec2::ZERO,
        }
    }

    /// True while one of the views has the key focus.
    pub(super) fn has_focus(&self) -> bool {
        self.has_focus
    }

    pub(super) fn ui(&mut self, ui: &mut Ui, align: &AlignState, session: &Session) {
        let theme = Theme::of(ui);
        self.has_focus = false;
        let Some(shown) = &align.shown else {
            empty(ui, align, session);
            return;
        };
        let all = ui.available_rect_before_wrap();
        ui.allocate_rect(all, egui::Sense::hover());
        let width = all.width() / self.views.len() as f32;
        self.put_in(shown, vec2(width, all.height() - head(width)));
        for (index, view) in self.views.iter_mut().enumerate() {
            let left = all.left() + index as f32 * width;
            let rect = Rect::from_min_size(pos2(left, all.top()), vec2(width, all.height()));
            let cell = rect.shrink2(vec2(1.0, 0.0));
            let builder = UiBuilder::new().max_rect(cell).id_salt(index);
            ui.scope_builder(builder, |ui| {
                ui.set_clip_rect(cell.intersect(ui.clip_rect()));
                self.has_focus |= view.ui(ui, shown, &mut self.camera, align, session);
            });
            if index > 0 {
                ui.painter().vline(left, all.y_range(), theme.edge_stroke());
            }
        }
        if align.is_pair_at_work() && align.coming.is_some() {
            let at = all.center_bottom() - vec2(0.0, 12.0);
            let text = text!("align-previous-result");
            ui.painter().text(
                at,
                Align2::CENTER_BOTTOM,
                text,
                font::body_strong(),
                theme.warning,
            );
        }
    }

    /// Turns all views and fits them.
    pub(super) fn look(&mut self, direction: ViewDirection) {
        direction.apply(&mut self.camera);
    }

    /// Shows a new pair; its points are shared, not copied. In a window of another size, the views are fitted again, unless a
    /// person has turned them.
    fn put_in(&mut self, shown: &MethodComparison, size: Vec2) {
        let pair = &shown.pair;
        let known = self.shows.as_ref();
        let is_new = known.is_none_or(|known| !Arc::ptr_eq(known, pair));
        let is_resized = std::mem::replace(&mut self.size, size) != size;
        let is_to_fit = is_new || is_resized && self.camera.is_fitted();
        if !is_to_fit {
            return;
        }
        if is_new {
            for view in &mut self.views {
                // Smaller points first, so that both clouds show where they coincide.
                view.scene.points = vec![pair.source_points.clone(), pair.target_points.clone()];
            }
            self.shows = Some(Arc::clone(pair));
        }
        // Fit to the target alone: from T1 the source starts far off.
        let target = ViewScene {
            points: vec![pair.target_points.clone()],
            ..ViewScene::default()
        };
        if let Some(bounds) = target.bounds() {
            self.camera.fit(&bounds, glam::vec2(size.x, size.y));
        }
    }
}

impl View {
    /// Draws the view; returns true if it has the key focus.
    fn ui(
        &mut self,
        ui: &mut Ui,
        shown: &MethodComparison,
        camera: &mut ViewCamera,
        align: &AlignState,
        session: &Session,
    ) -> bool {
        let theme = Theme::of(ui);
        let run = shown.runs.iter().find(|run| run.method == self.method);
        let all = ui.available_rect_before_wrap();
        let split = all.top() + head(all.width());
        let head = Rect::from_min_max(all.min, pos2(all.right(), split));
        ui.painter().rect_filled(all, 0.0, theme.canvas);
        let builder = UiBuilder::new().max_rect(head.shrink2(vec2(space::MEDIUM, space::SMALL)));
        ui.scope_builder(builder, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            ui.spacing_mut().interact_size.y = 0.0;
            let title = RichText::new(plot::method_title(self.method)).font(font::body_strong());
            ui.label(title.color(plot::method_colour(self.method, theme)));
            match run {
                Some(run) => heading(ui, run, session),
                None if align.is_pair_at_work() => weak(ui, &text!("align-at-work")),
                None => weak(ui, &text!("align-not-run")),
            }
        });
        let body = Rect::from_min_max(pos2(all.left(), split), all.max);
        match run.map(|run| &run.track) {
            Some(Err(error)) => {
                let problem = in_the_window(error);
                words(
                    ui,
                    body,
                    &[
                        (&problem.what, theme.text),
                        (&problem.advice, theme.warning),
                    ],
                );
                false
            }
            Some(Ok(track)) => {
                let index = align.iteration.round() as usize;
                if let Some(source) = self.scene.points.first_mut() {
                    source.world_from_set = mat4(&track.pose_at(index));
                }
                let has_focus = self.view(ui, body, camera, session.theme);
                below(ui, body, track, index);
                has_focus
            }
            None => {
                if let Some(source) = self.scene.points.first_mut() {
                    source.world_from_set = glam::Mat4::IDENTITY;
                }
                self.view(ui, body, camera, session.theme)
            }
        }
    }

    fn view(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        camera: &mut ViewCamera,
        theme: ThemeChoice,
    ) -> bool {
        let label = text!("align-view-of", method = plot::method_title(self.method));
        let style = style(self.method, theme);
        let builder = UiBuilder::new().max_rect(rect);
        ui.scope_builder(builder, |ui| {
            let seen = self.viewport.ui(ui, &label, camera, &self.scene, &style);
            seen.response.has_focus()
        })
        .inner
    }
}

/// Height of the text above a view of this width, logical pixels.
fn head(width: f32) -> f32 {
    HEAD[usize::from(width < TWO_LINE_WIDTH_PX)]
}

fn style(method: PoseMethod, choice: ThemeChoice) -> ViewStyle {
    let mut colours = ViewColours::of(choice);
    // The source has the colour of its method's curve.
    colours.roles[Role::Moving as usize] = RoleColour {
        colour: plot::method_colour(method, choice.colours()),
        weight: SOURCE_WEIGHT,
    };
    ViewStyle {
        point_size: POINT,
        ..ViewStyle::new(colours)
    }
}

fn weak(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).small().weak());
}

/// Draws how a method stopped, and its figures.
fn heading(ui: &mut Ui, run: &MethodRun, session: &Session) {
    let theme = Theme::of(ui);
    let ms = format!("{:.0}", run.time.as_secs_f64() * 1000.0);
    match &run.track {
        Ok(track) => {
            let [ending, says] = track.ending();
            let ending = RichText::new(ending).small();
            if track.doubts.is_empty() {
                ui.label(ending).on_hover_text(says);
            } else {
                ui.label(ending.color(theme.warning))
                    .on_hover_text(format!("{says}\n{}", doubts(track)));
            }
            let rms = session.units.length(track.fit.rms_m);
            let overlap = format!("{:.0}", track.fit.overlap * 100.0);
            let e = scientific(track.end_e_m2());
            let figures = text!(
                "align-figures",
                e = e,
                rms = rms,
                overlap = overlap,
                time = ms,
            );
            weak(ui, &figures);
        }
        Err(_) => weak(ui, &text!("align-no-pose-figures", time = ms)),
    }
}

/// Returns the doubts about the final pose, with what to do.
fn doubts(track: &Track) -> String {
    let lines = track.doubts.iter().map(|doubt| doubted(doubt, track));
    let lines = lines.flat_map(|doubt| [doubt.what, doubt.advice]);
    lines.collect::<Vec<_>>().join("\n")
}

/// Draws over the view which iteration is shown, and doubts about the final pose.
fn below(ui: &Ui, rect: Rect, track: &Track, index: usize) {
    let theme = Theme::of(ui);
    let last = track.poses.len().saturating_sub(1);
    let index = index.min(last);
    let painter = ui.painter_at(rect);
    let e = track.e_m2.get(index).copied().unwrap_or(f64::NAN);
    let text = if index == last {
        text!("align-end", count = last)
    } else {
        text!(
            "align-iteration-e",
            iteration = index,
            last = last,
            e = scientific(e)
        )
    };
    let at = rect.left_bottom() + vec2(space::MEDIUM, -space::MEDIUM);
    let written = painter.text(
        at,
        Align2::LEFT_BOTTOM,
        text,
        font::small(),
        theme.weak_text,
    );
    if index == last && !track.doubts.is_empty() {
        let width = rect.width() - 2.0 * space::MEDIUM;
        let galley = painter.layout(doubts(track), font::small(), theme.warning, width);
        let at = written.left_top() - vec2(0.0, galley.size().y + 4.0);
        let plate = Rect::from_min_size(at, galley.size()).expand(4.0);
        painter.rect_filled(plate, ROUNDING, theme.panel);
        painter.galley(at, galley, theme.warning);
    }
}

/// Draws the area before the first result.
fn empty(ui: &mut Ui, align: &AlignState, session: &Session) {
    let theme = Theme::of(ui);
    let rect = ui.available_rect_before_wrap();
    ui.painter().rect_filled(rect, 0.0, theme.canvas);
    let choice = align.choice(session);
    let (what, advice) = if align.is_pair_at_work() {
        (text!("align-aligning-now"), String::new())
    } else {
        let advice = match choice {
            Ok(_) => text!("align-nothing-aligned-advice"),
            Err(missing) => missing,
        };
        (text!("align-nothing-aligned"), advice)
    };
    words(ui, rect, &[(&what, theme.text), (&advice, theme.weak_text)]);
}

/// Draws paragraphs in the middle of the area of a view.
fn words(ui: &mut Ui, rect: Rect, paragraphs: &[(&str, egui::Color32)]) {
    let inside = rect.shrink(space::LARGE);
    let layout = egui::Layout::top_down(egui::Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(inside).layout(layout), |ui| {
        ui.add_space((inside.height() / 2.0 - 40.0).max(0.0));
        for (text, colour) in paragraphs {
            ui.label(RichText::new(*text).font(font::body()).color(*colour));
        }
    });
}

/// Formats a number as "2.0 × 10⁻³".
pub(super) fn scientific(value: f64) -> String {
    let written = format!("{value:.1e}");
    let Some((digits, power)) = written.split_once('e') else {
        return written;
    };
    let raised = power.chars().map(|c| match c {
        '-' => '\u{207b}',
        '0' => '\u{2070}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        other => char::from_u32(0x2070 + other.to_digit(10).unwrap_or(0)).unwrap_or(other),
    });
    format!("{digits} × 10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::scientific;

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(scientific(2.04e-3), "2.0 × 10⁻³");
        assert_eq!(scientific(4.6e-17), "4.6 × 10⁻¹⁷");
        assert_eq!(scientific(0.0), "0.0 × 10⁰");
    }
}
