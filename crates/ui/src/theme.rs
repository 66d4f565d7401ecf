//! All colours, spacing and fonts of the window, by purpose. Nothing else names a colour.

use std::sync::Arc;

use crate::language::text;
use egui::{
    Color32, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Margin, Stroke, Style,
    TextStyle, Visuals, style::WidgetVisuals,
};

/// Light or dark colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThemeChoice {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

impl ThemeChoice {
    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::Dark => text!("shell-dark"),
            Self::Light => text!("shell-light"),
        }
    }

    /// Returns the other choice.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Dark,
        }
    }

    /// Returns its colours.
    pub fn colours(self) -> &'static Theme {
        match self {
            Self::Dark => &DARK,
            Self::Light => &LIGHT,
        }
    }
}

/// Colours by role.
#[derive(Clone, Debug, PartialEq)]
pub struct Theme {
    /// Background of the 3-D view and the pictures.
    pub canvas: Color32,
    /// Background of bars and cards.
    pub panel: Color32,
    /// Controls at rest.
    pub control: Color32,
    /// Controls under the pointer.
    pub control_hovered: Color32,
    /// Edges between panels and around controls.
    pub edge: Color32,
    /// The empty part of a bar.
    pub track: Color32,
    /// Text.
    pub text: Color32,
    /// Less important text.
    pub weak_text: Color32,
    /// The most used control, and the selection.
    pub accent: Color32,
    /// Text on the accent.
    pub on_accent: Color32,
    /// An accepted verdict.
    pub accepted: Color32,
    /// A verdict that is not accepted.
    pub rejected: Color32,
    /// Background of an accepted verdict across the window.
    pub accepted_back: Color32,
    /// Background of a rejected verdict across the window.
    pub rejected_back: Color32,
    /// Something that needs attention.
    pub warning: Color32,
    /// The scene's curve or outline.
    pub first_series: Color32,
    /// The second curve of the scene.
    pub second_series: Color32,
    /// Curve or outline that the scene is compared with.
    pub reference_series: Color32,
}

const DARK: Theme = Theme {
    canvas: rgb(0x0c_0d10),
    panel: rgb(0x16_191e),
    control: rgb(0x20_242b),
    control_hovered: rgb(0x2c_323b),
    edge: rgb(0x31_373f),
    track: rgb(0x2a_2f37),
    text: rgb(0xe8_eaed),
    weak_text: rgb(0x9a_a1ab),
    accent: rgb(0x4f_c4b2),
    on_accent: rgb(0x08_1a17),
    accepted: rgb(0x5b_c46c),
    rejected: rgb(0xf0_7d6d),
    accepted_back: rgb(0x15_3a22),
    rejected_back: rgb(0x41_1d1a),
    warning: rgb(0xe8_b04d),
    first_series: rgb(0x4f_c4b2),
    second_series: rgb(0xe3_a73f),
    reference_series: rgb(0xb7_a6f2),
};

const LIGHT: Theme = Theme {
    canvas: rgb(0xf6_f7f9),
    panel: rgb(0xff_ffff),
    control: rgb(0xee_f0f3),
    control_hovered: rgb(0xe0_e4e9),
    edge: rgb(0xcd_d2d9),
    track: rgb(0xdd_e1e6),
    text: rgb(0x1b_1e23),
    weak_text: rgb(0x57_5e68),
    accent: rgb(0x0b_6e60),
    on_accent: rgb(0xff_ffff),
    accepted: rgb(0x1a_7431),
    rejected: rgb(0xb3_2d1f),
    accepted_back: rgb(0xdf_f3e3),
    rejected_back: rgb(0xfb_e5e1),
    warning: rgb(0x8a_5a00),
    first_series: rgb(0x0b_7a6b),
    second_series: rgb(0x98_6100),
    reference_series: rgb(0x5b_44b8),
};

/// Makes a colour from `0xRRGGBB`.
pub(super) const fn rgb(hex: u32) -> Color32 {
    let [_, red, green, blue] = hex.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

/// Distances, logical pixels.
pub mod space {
    /// Between related items.
    pub const SMALL: f32 = 6.0;
    /// Between items.
    pub const MEDIUM: f32 = 10.0;
    /// Between groups.
    pub const LARGE: f32 = 18.0;
    /// Smallest side of anything that can be pressed, for use with gloves.
    pub const TARGET: f32 = 36.0;
    /// Height of the top bar.
    pub const TOP_BAR: f32 = 52.0;
    /// Width of the rail.
    pub const RAIL: f32 = 64.0;
}

/// Corner radius of controls and pictures.
pub const ROUNDING: CornerRadius = CornerRadius::same(5);

/// Font family of emphasised text.
fn strong_family() -> FontFamily {
    FontFamily::Name("strong".into())
}

/// Fonts by role.
pub mod font {
    use super::{FontFamily, FontId, strong_family};

    /// The name of the part.
    pub fn title() -> FontId {
        FontId::new(27.0, strong_family())
    }
    /// The name of the part, readable from three metres, largest first.
    pub fn far_names() -> [FontId; 4] {
        [48.0, 42.0, 36.0, 30.0].map(|size| FontId::new(size, strong_family()))
    }
    /// The verdict, readable from three metres.
    pub fn far_verdict() -> FontId {
        FontId::new(26.0, strong_family())
    }
    /// The reason for not accepting, readable from three metres.
    pub fn far_reason() -> FontId {
        FontId::new(18.0, strong_family())
    }
    /// The name of the part across the window, largest first.
    pub fn banner_names() -> [FontId; 5] {
        [76.0, 64.0, 52.0, 42.0, 32.0].map(|size| FontId::new(size, strong_family()))
    }
    /// The verdict across the window.
    pub fn banner_word() -> FontId {
        FontId::new(40.0, strong_family())
    }
    /// The reason across the window.
    pub fn banner_reason() -> FontId {
        FontId::new(22.0, FontFamily::Proportional)
    }
    /// What to do next, in the operator's view.
    pub fn next_step() -> FontId {
        FontId::new(26.0, strong_family())
    }
    /// Lists and long sentences of the operator's view.
    pub fn far_list() -> FontId {
        FontId::new(18.0, FontFamily::Proportional)
    }
    /// The verdict in a list, and the headings of an enlarged stage.
    pub fn verdict() -> FontId {
        FontId::new(16.5, strong_family())
    }
    /// Headings of groups.
    pub fn heading() -> FontId {
        FontId::new(12.0, strong_family())
    }
    /// Normal text.
    pub fn body() -> FontId {
        FontId::new(14.0, FontFamily::Proportional)
    }
    /// Emphasised text.
    pub fn body_strong() -> FontId {
        FontId::new(14.0, strong_family())
    }
    /// Captions.
    pub fn small() -> FontId {
        FontId::new(12.0, FontFamily::Proportional)
    }
    /// Axis labels of small pictures.
    pub fn scale() -> FontId {
        FontId::new(10.0, FontFamily::Proportional)
    }
}

impl Theme {
    /// Returns the colours of the window that is being drawn.
    pub fn of(ctx: &egui::Context) -> &'static Self {
        match ctx.theme() {
            egui::Theme::Dark => &DARK,
            egui::Theme::Light => &LIGHT,
        }
    }

    /// Returns the stroke of edges between panels.
    pub fn edge_stroke(&self) -> Stroke {
        Stroke::new(1.0, self.edge)
    }

    fn visuals(&self, theme: egui::Theme) -> Visuals {
        let mut visuals = theme.default_visuals();
        let control = |fill: Color32, edge: Color32| WidgetVisuals {
            bg_fill: fill,
            weak_bg_fill: fill,
            bg_stroke: Stroke::new(1.0, edge),
            corner_radius: ROUNDING,
            fg_stroke: Stroke::new(1.0, self.text),
            expansion: 0.0,
        };
        visuals.weak_text_color = Some(self.weak_text);
        visuals.panel_fill = self.panel;
        visuals.window_fill = self.panel;
        visuals.window_stroke = self.edge_stroke();
        visuals.extreme_bg_color = self.canvas;
        visuals.faint_bg_color = self.control;
        visuals.widgets.noninteractive = control(self.panel, self.edge);
        visuals.widgets.inactive = control(self.control, self.edge);
        visuals.widgets.hovered = control(self.control_hovered, self.accent);
        visuals.widgets.active = control(self.control_hovered, self.text);
        visuals.widgets.open = control(self.control_hovered, self.accent);
        visuals.selection.bg_fill = self.accent;
        visuals.selection.stroke = Stroke::new(1.0, self.on_accent);
        visuals.hyperlink_color = self.accent;
        visuals.warn_fg_color = self.warning;
        visuals.error_fg_color = self.rejected;
        visuals
    }

    /// Applies the theme to a window. Cheap, but only called when the choice changes.
    pub fn install(choice: ThemeChoice, ctx: &egui::Context) {
        let egui_theme = match choice {
            ThemeChoice::Dark => egui::Theme::Dark,
            ThemeChoice::Light => egui::Theme::Light,
        };
        ctx.set_theme(egui_theme);
        let mut style = Style {
            visuals: choice.colours().visuals(egui_theme),
            ..Style::default()
        };
        style.text_styles = [
            (TextStyle::Small, font::small()),
            (TextStyle::Body, font::body()),
            (TextStyle::Button, font::body()),
            (TextStyle::Heading, font::verdict()),
            (TextStyle::Monospace, FontId::monospace(13.0)),
        ]
        .into();
        style.spacing.interact_size.y = space::TARGET;
        style.spacing.button_padding = egui::vec2(12.0, 6.0);
        style.spacing.item_spacing = egui::vec2(space::SMALL, space::SMALL);
        style.spacing.menu_margin = Margin::same(6);
        ctx.set_style_of(egui_theme, style);
    }

    /// Installs the embedded fonts, with egui's own as fallbacks for missing glyphs.
    pub fn install_fonts(ctx: &egui::Context) {
        let mut fonts = FontDefinitions::default();
        let regular = include_bytes!("../../../assets/fonts/Inter-Regular.otf");
        let strong = include_bytes!("../../../assets/fonts/Inter-SemiBold.otf");
        for (name, bytes) in [("Inter", &regular[..]), ("Inter SemiBold", &strong[..])] {
            fonts
                .font_data
                .insert(name.into(), Arc::new(FontData::from_owned(bytes.to_vec())));
        }
        // For Chinese in any language: titles of parts may be written in it.
        let chinese = include_bytes!("../../../assets/fonts/NotoSansSC-Subset.otf");
        let chinese_name = "Noto Sans SC";
        fonts.font_data.insert(
            chinese_name.into(),
            Arc::new(FontData::from_static(chinese)),
        );
        let fallbacks = fonts.families.get(&FontFamily::Proportional).cloned();
        let with_fallbacks = |name: &str| {
            let fallbacks = fallbacks.iter().flatten().cloned();
            [name.to_owned(), chinese_name.to_owned()]
                .into_iter()
                .chain(fallbacks)
                .collect()
        };
        fonts
            .families
            .insert(FontFamily::Proportional, with_fallbacks("Inter"));
        fonts
            .families
            .insert(strong_family(), with_fallbacks("Inter SemiBold"));
        if let Some(monospace) = fonts.families.get_mut(&FontFamily::Monospace) {
            monospace.push(chinese_name.to_owned());
        }
        ctx.set_fonts(fonts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance according to WCAG 2.1.
    fn luminance(colour: Color32) -> f64 {
        let linear = |channel: u8| {
            let c = f64::from(channel) / 255.0;
            if c <= 0.040_45 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn text_stands_out_from_whatever_it_is_written_on() {
        for choice in [ThemeChoice::Dark, ThemeChoice::Light] {
            let theme = choice.colours();
            let Theme { canvas, panel, .. } = *theme;
            let (control, hovered) = (theme.control, theme.control_hovered);
            let (good, bad) = (theme.accepted_back, theme.rejected_back);
            let pairs = [
                (
                    "text",
                    theme.text,
                    vec![canvas, panel, control, hovered, good, bad],
                ),
                ("weak", theme.weak_text, vec![canvas, panel, control]),
                ("on accent", theme.on_accent, vec![theme.accent]),
                ("accent", theme.accent, vec![panel, canvas]),
                ("accepted", theme.accepted, vec![panel, canvas, good]),
                ("rejected", theme.rejected, vec![panel, canvas, bad]),
                ("warning", theme.warning, vec![panel, canvas, control]),
                ("first", theme.first_series, vec![canvas]),
                ("second", theme.second_series, vec![canvas]),
                ("reference", theme.reference_series, vec![canvas]),
            ];
            for (role, colour, backgrounds) in pairs {
                for background in backgrounds {
                    let ratio = contrast(colour, background);
                    assert!(
                        ratio >= 4.5,
                        "{choice:?}: {role} on {background:?}: {ratio:.2}"
                    );
                }
            }
        }
    }
}
