//! How a view looks: what decides the colour of a point, the colours by role, sizes and shading.

use egui::Color32;

use crate::{
    language::text,
    theme::{ThemeChoice, rgb},
};
use geometry::units::Metres;
use stages::segment::PointLabel;

/// Number of colours of a scale, evenly spaced from its low end to its high end.
pub const SCALE_STOPS: usize = 7;

/// What a point or line stands for. Decides its colour; stored per point as one byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Role {
    /// Any other surface: neither background nor part.
    Rest,
    /// The part.
    Part,
    /// First background plane, usually the wall.
    Plane0,
    /// Second background plane, usually the floor.
    Plane1,
    /// Third background plane.
    Plane2,
    /// Any further background plane.
    Plane3,
    /// An enrolled part that the scene is compared with.
    Reference,
    /// A cloud being aligned to the reference.
    Moving,
    /// The x axis of a coordinate frame.
    AxisX,
    /// The y axis of a coordinate frame.
    AxisY,
    /// The z axis of a coordinate frame.
    AxisZ,
    /// The depth camera.
    Frustum,
    /// The outline of the part.
    Contour,
    /// The spray nozzle and its stand-off.
    Nozzle,
    /// A measured distance.
    Measure,
    /// Surface that no shot of a scan has seen.
    Unseen,
    /// Surface that only one shot of a scan has seen.
    SeenOnce,
}

impl Role {
    /// All roles, in the order of their discriminants.
    pub const ALL: [Self; 17] = [
        Self::Rest,
        Self::Part,
        Self::Plane0,
        Self::Plane1,
        Self::Plane2,
        Self::Plane3,
        Self::Reference,
        Self::Moving,
        Self::AxisX,
        Self::AxisY,
        Self::AxisZ,
        Self::Frustum,
        Self::Contour,
        Self::Nozzle,
        Self::Measure,
        Self::Unseen,
        Self::SeenOnce,
    ];

    /// Returns the role for a segmentation label.
    pub fn of(label: PointLabel) -> Self {
        match label {
            PointLabel::NoReading | PointLabel::Rest => Self::Rest,
            PointLabel::Part => Self::Part,
            PointLabel::Background(0) => Self::Plane0,
            PointLabel::Background(1) => Self::Plane1,
            PointLabel::Background(2) => Self::Plane2,
            PointLabel::Background(_) => Self::Plane3,
        }
    }
}

/// What decides the colour of a point. Changing it uploads nothing to the GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Colouring {
    /// The role: part, background planes, rest.
    #[default]
    Segment,
    /// The height; background planes keep their own colour.
    Height,
    /// The signed deviation from the reference; points without one keep the colour of their role, dimmed.
    Deviation,
    /// One colour for all points, with background planes dimmed; only the shading shows the shape.
    Plain,
}

impl Colouring {
    /// All colourings, in the order of their discriminants.
    pub const ALL: [Self; 4] = [Self::Segment, Self::Height, Self::Deviation, Self::Plain];

    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::Segment => text!("view-segments"),
            Self::Height => text!("view-height"),
            Self::Deviation => text!("view-deviation"),
            Self::Plain => text!("view-plain"),
        }
    }
}

/// Where the colour scale is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// In the corner, while points are coloured by a scale.
    #[default]
    Shown,
    /// Like `Shown`, but lower: a row of controls is at the top.
    BelowControls,
}

/// What the deviations of a point set measure; selects the scale's colours and labels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ScaleWords {
    /// Distances from the reference.
    #[default]
    Deviation,
    /// Film thicknesses, stored times 1000 because a set keeps whole micrometres.
    Film {
        /// Thickness at the middle of the scale.
        target: Metres,
        /// Difference from the middle to either end.
        range: Metres,
    },
}

/// Everything about the look of a view. Cheap to build every frame; the view is redrawn only when it differs.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewStyle {
    /// Colours of the theme.
    pub colours: ViewColours,
    /// Colouring of the point sets that do not set their own.
    pub colouring: Colouring,
    /// Base diameter of a point, multiplied by its role's weight; at least 1.5 pixels on the screen.
    pub point_size: Metres,
    /// Strength of the eye-dome lighting, 0 (off) to 2. Raising it deepens edges and noise alike.
    pub eye_dome: f32,
    /// Deviation at the ends of the scale, above 0. Larger ones get the end colour.
    pub deviation_range: Metres,
    /// Factor from metres, unit symbol and decimals of the lengths at the scale.
    pub length_axis: (f64, &'static str, usize),
    /// What the deviations measure.
    pub scale_words: ScaleWords,
    /// Where the colour scale is drawn.
    pub legend: Legend,
}

impl ViewStyle {
    /// Returns the default style with the given colours.
    pub fn new(colours: ViewColours) -> Self {
        Self {
            colours,
            colouring: Colouring::default(),
            // About the point spacing of a depth camera on a part: surfaces look closed at any zoom.
            point_size: Metres::from_mm(4.0),
            eye_dome: 1.0,
            deviation_range: Metres::from_mm(5.0),
            length_axis: (1000.0, "mm", 0),
            scale_words: ScaleWords::default(),
            legend: Legend::default(),
        }
    }
}

/// The look of one role.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoleColour {
    /// Colour of points and lines of the role.
    pub colour: Color32,
    /// Factor on the diameter of points; 0 hides them. For lines, the opacity.
    pub weight: f32,
}

/// The colours of a view, by role.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewColours {
    /// Background of the view.
    pub background: Color32,
    /// Text on the view.
    pub text: Color32,
    /// Less important text on the view.
    pub weak_text: Color32,
    /// One per [`Role`], in the order of their discriminants.
    pub roles: [RoleColour; Role::ALL.len()],
    /// Height scale, from low to high.
    pub height_scale: [Color32; SCALE_STOPS],
    /// Diverging deviation scale: below the reference, zero in the middle, above the reference.
    pub deviation_scale: [Color32; SCALE_STOPS],
    /// Diverging film scale: too thin, right in the middle, too thick.
    pub film_scale: [Color32; SCALE_STOPS],
}

impl ViewColours {
    /// Returns the colours for a dark window.
    pub fn dark() -> Self {
        Self::of(ThemeChoice::Dark)
    }

    /// Returns the colours for a light window.
    pub fn light() -> Self {
        Self::of(ThemeChoice::Light)
    }

    /// Returns the colours for a window with this theme. Each is given for dark windows, then for light ones.
    pub fn of(theme: ThemeChoice) -> Self {
        let colour = |dark: u32, light: u32| match theme {
            ThemeChoice::Dark => rgb(dark),
            ThemeChoice::Light => rgb(light),
        };
        let role = |dark, light, weight| RoleColour {
            colour: colour(dark, light),
            weight,
        };
        let scale = |dark: [u32; SCALE_STOPS], light: [u32; SCALE_STOPS]| match theme {
            ThemeChoice::Dark => dark.map(rgb),
            ThemeChoice::Light => light.map(rgb),
        };
        Self {
            background: colour(0x0c_0d10, 0xf6_f7f9),
            text: colour(0xe8_eaed, 0x1b_1e23),
            weak_text: colour(0x9a_a0a8, 0x5a_616b),
            roles: [
                role(0xa3_abb8, 0x8d_95a3, 1.0),
                role(0x4f_c4b2, 0x1d_a08c, 1.0),
                role(0x2f_3b5c, 0xcc_d6ec, 1.2),
                role(0x5c_4728, 0xe6_d3b4, 1.2),
                role(0x4b_3558, 0xd9_c8e4, 1.2),
                role(0x3a_4c31, 0xc9_d9bf, 1.2),
                role(0x8d_97a8, 0x7c_8696, 1.0),
                role(0xe3_a73f, 0xd0_8a1c, 1.0),
                role(0xe8_6a5c, 0xc9_3c2e, 1.0),
                role(0x5b_c46c, 0x2a_9440, 1.0),
                role(0x5a_97e8, 0x2b_6cc9, 1.0),
                role(0x8b_94a3, 0x5a_616b, 0.55),
                role(0xe8_eaed, 0x1b_1e23, 0.9),
                role(0xf0_f2f5, 0x1b_1e23, 1.0),
                role(0xff_d866, 0xb3_0f6a, 1.0),
                role(0xff_9d3c, 0xd0_5a00, 1.3),
                role(0xb7_a6f2, 0x6b_4fd0, 1.1),
            ],
            height_scale: scale(
                [
                    0x3b_3f8c, 0x3b_6fb0, 0x3a_9db0, 0x4f_c4a0, 0x93_d67c, 0xd9_e06a, 0xfb_f3a0,
                ],
                [
                    0x31_357d, 0x2f_62a6, 0x2a_8ca6, 0x35_ad86, 0x74_bb57, 0xb9_b93a, 0xdc_a92a,
                ],
            ),
            deviation_scale: scale(
                [
                    0x3a_62d8, 0x3f_8fdc, 0x4f_bcc9, 0xb9_c9bd, 0xdd_c565, 0xe5_9440, 0xdf_5a35,
                ],
                [
                    0x22_46b8, 0x2f_7cc7, 0x4f_a9b5, 0xa3_ada3, 0xcf_aa3a, 0xd6_7a22, 0xc2_3f1c,
                ],
            ),
            film_scale: scale(
                [
                    0x3f_5fe0, 0x3f_8fdc, 0x45_b5a8, 0x5b_c46c, 0xb5_cf5a, 0xe5_a040, 0xdf_5a35,
                ],
                [
                    0x22_46b8, 0x2f_7cc7, 0x2a_9c8f, 0x2a_9440, 0x8a_a52e, 0xd6_8a22, 0xc2_3f1c,
                ],
            ),
        }
    }

    /// Returns the scale for what the deviations measure.
    pub(super) fn deviations(&self, words: ScaleWords) -> &[Color32; SCALE_STOPS] {
        match words {
            ScaleWords::Deviation => &self.deviation_scale,
            ScaleWords::Film { .. } => &self.film_scale,
        }
    }

    /// Returns the look of a role.
    pub fn role(&self, role: Role) -> RoleColour {
        self.roles[role as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roles_number_finds_the_role_again() {
        for (number, role) in Role::ALL.iter().enumerate() {
            assert_eq!(*role as usize, number);
        }
        for (number, colouring) in Colouring::ALL.iter().enumerate() {
            assert_eq!(*colouring as usize, number);
        }
    }
}
