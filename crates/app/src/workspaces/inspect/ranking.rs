//! The ranking as a picture: a bar for every enrolled part, best first, with the threshold.

use std::sync::Arc;

use egui::{
    Color32, FontId, Galley, Painter, Rect, Stroke, pos2,
    text::{LayoutJob, TextWrapping},
};

use super::plots::{Pictures, PlotDetail};
use shell::inspection::figures::RankedPartFigure;
use ui::{language::text, theme::font, widgets::Scale};

/// Below this width of the ranking, logical pixels, names are above the bars.
const STACKED: f32 = 125.0;

impl Pictures<'_> {
    pub(super) fn ranking(
        &self,
        candidates: &[RankedPartFigure],
        painter: &Painter,
        rect: Rect,
        detail: PlotDetail,
    ) {
        let theme = self.theme;
        if rect.width() < STACKED {
            self.stacked_ranking(candidates, painter, rect);
            return;
        }
        let num_rows = candidates.len().min(match detail {
            PlotDetail::Small => 6,
            PlotDetail::Large => 16,
        });
        let row = (rect.height() / num_rows.max(1) as f32).min(40.0);
        let is_large = detail == PlotDetail::Large;
        let titles: Vec<_> = candidates
            .iter()
            .take(num_rows)
            .enumerate()
            .map(|(index, candidate)| {
                let (name, font) = if is_large {
                    (&candidate.title, font::body())
                } else {
                    (&candidate.short_title, font::scale())
                };
                let colour = self.text_colour(index);
                // Leave the bars their share beside a long name.
                elided(painter, name, font, colour, rect.width() * 0.56)
            })
            .collect();
        let widest = titles.iter().map(|title| title.size().x);
        let names = widest.fold(0.0, f32::max) + if is_large { 16.0 } else { 6.0 };
        let scores = candidates.iter().take(num_rows).filter(|_| is_large);
        let scores: Vec<_> = scores
            .map(|candidate| {
                let score = if candidate.is_examined {
                    format!("{:.2}", candidate.score)
                } else {
                    text!("inspect-not-examined")
                };
                painter.layout_no_wrap(score, font::body(), theme.text)
            })
            .collect();
        let widest = scores.iter().map(|score| score.size().x + 24.0);
        let values = widest.fold(0.0, f32::max);
        let bars = Scale::new([0.0, 1.0], [rect.left() + names, rect.right() - values]);
        for ((index, candidate), title) in candidates.iter().enumerate().zip(titles) {
            let middle = rect.top() + row * (index as f32 + 0.5);
            let colour = self.text_colour(index);
            let top = pos2(rect.left(), middle - title.size().y / 2.0);
            painter.galley(top, title, colour);
            let y = [middle - row * 0.3, middle + row * 0.3];
            let bar =
                |to: f32| Rect::from_min_max(pos2(bars.at(0.0), y[0]), pos2(bars.at(to), y[1]));
            painter.rect_filled(bar(1.0), 2.0, theme.track);
            painter.rect_filled(
                bar(candidate.score.clamp(0.0, 1.0)),
                2.0,
                self.bar_fill(index),
            );
            if let Some(score) = scores.get(index) {
                let size = score.size();
                let at = pos2(rect.right() - size.x, middle - size.y / 2.0);
                painter.galley_with_override_text_color(at, Arc::clone(score), colour);
            }
        }
        let threshold = bars.at(self.inspected.recipe.accept.min_score as f32);
        let bottom = rect.top() + row * num_rows as f32;
        painter.vline(threshold, rect.top()..=bottom, Stroke::new(1.0, theme.text));
    }

    /// Draws the first few of the ranking in little room, each name above its bar.
    fn stacked_ranking(&self, candidates: &[RankedPartFigure], painter: &Painter, rect: Rect) {
        const ROW: f32 = 22.0;
        const BAR: f32 = 6.0;
        let theme = self.theme;
        let num_rows = ((rect.height() / ROW) as usize).clamp(1, candidates.len());
        let row = rect.height() / num_rows as f32;
        let across = Scale::new([0.0, 1.0], [rect.left(), rect.right()]);
        for (index, candidate) in candidates.iter().take(num_rows).enumerate() {
            let colour = self.text_colour(index);
            let at = pos2(rect.left(), rect.top() + row * index as f32);
            let name = &candidate.short_title;
            let title = elided(painter, name, font::scale(), colour, rect.width());
            let y = at.y + title.size().y + 1.0;
            painter.galley(at, title, colour);
            let bar =
                |to: f32| Rect::from_min_max(pos2(rect.left(), y), pos2(across.at(to), y + BAR));
            painter.rect_filled(bar(1.0), 2.0, theme.track);
            let score = candidate.score.clamp(0.0, 1.0);
            painter.rect_filled(bar(score), 2.0, self.bar_fill(index));
            let threshold = across.at(self.inspected.recipe.accept.min_score as f32);
            painter.vline(threshold, y..=y + BAR, Stroke::new(1.0, theme.text));
        }
    }

    /// Colour of the texts at this index of the ranking.
    fn text_colour(&self, index: usize) -> Color32 {
        if index == self.state.candidate {
            self.theme.text
        } else {
            self.theme.weak_text
        }
    }

    /// Colour of the bar at this index of the ranking; the first one has that of the verdict.
    fn bar_fill(&self, index: usize) -> Color32 {
        if index > 0 {
            self.theme.weak_text.gamma_multiply(0.6)
        } else if self.inspected.is_open() {
            self.theme.warning
        } else if self.session.is_go(self.inspected) {
            self.theme.accepted
        } else if self.inspected.inspection.verdict.is_accepted()
            && self.session.shift.reported_as(self.inspected).is_none()
        {
            self.theme.text
        } else {
            self.theme.rejected
        }
    }
}

/// Lays out one line of text, elided if too long.
fn elided(painter: &Painter, text: &str, font: FontId, colour: Color32, width: f32) -> Arc<Galley> {
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, colour);
    job.wrap = TextWrapping::truncate_at_width(width);
    painter.layout_job(job)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspaces::inspect::InspectState;
    use inspection::{
        library::Truth,
        pipeline::{
            Rejection, Verdict,
            live::{LiveVerdict, MotionState},
        },
    };
    use shell::{
        inspection::{
            inspected::{Inspected, LiveFrameContext, inspected_cell},
            source::CellChoice,
        },
        session::Session,
    };
    use ui::{task::TaskRunner, theme::Theme};

    #[test]
    fn the_bar_of_the_best_part_is_red_only_once_a_verdict_counts_and_never_green_without_a_robot()
    {
        let theme = Theme::of(&egui::Context::default());
        let state = InspectState::new(&TaskRunner::without_threads());
        let mut session = Session::default();
        let fill = |inspected: &Inspected, session: &Session| {
            let pictures = Pictures {
                inspected,
                state: &state,
                session,
                theme,
                segmentation: None,
                binary: None,
            };
            pictures.bar_fill(0)
        };
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        // Simulated, and not calibrated.
        assert_eq!(fill(&inspected, &session), theme.text);
        session.shift.labelled = vec![(inspected.hung().clone(), Truth::NotEnrolled)];
        assert_eq!(fill(&inspected, &session), theme.rejected);
        session.shift.labelled = Vec::new();
        if let Verdict::Part { rejected, part, .. } = &mut inspected.inspection.verdict {
            *rejected = Some(Rejection::NotSteady { part: part.clone() });
        }
        assert_eq!(fill(&inspected, &session), theme.rejected);
        inspected.followed = Some(LiveFrameContext {
            stillness: MotionState::Moving,
            standing: LiveVerdict::Open,
        });
        assert_eq!(fill(&inspected, &session), theme.warning);
    }
}
