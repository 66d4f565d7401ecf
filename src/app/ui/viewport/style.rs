//! How a view looks: what decides the colour of a point, the colours by role, sizes and shading.

use egui::Color32;

use crate::app::language::text;
use crate::{stages::segment::PointLabel, units::Metres};

/// Colours of a scale, evenly spaced from its low end to its high end.
pub const SCALE_STOPS: usize = 7;

/// What a point or line stands for. Decides its colour; stored per point as one byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Role {
    /// Neither background nor part.
    Rest,
    /// The part.
    Part,
    /// First background plane, as a rule the wall.
    Plane0,
    /// Second background plane, as a rule the floor.
    Plane1,
    /// Third background plane.
    Plane2,
    /// Any further background plane.
    Plane3,
    /// An enrolled part that something is compared with.
    Reference,
    /// A cloud on its way to the reference.
    Moving,
    /// The x axis of a space.
    AxisX,
    /// The y axis of a space.
    AxisY,
    /// The z axis of a space.
    AxisZ,
    /// The depth camera.
    Frustum,
    /// The outline of the part.
    Contour,
    /// The spray nozzle and its stand-off.
    Nozzle,
    /// A measured distance.
    Measure,
    /// Surface that no shot of a scan shows.
    Unseen,
    /// Surface that one shot of a scan alone shows.
    SeenOnce,
}

impl Role {
    /// Every role, in the order of their numbers.
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

    /// The role of a point that segmentation labelled.
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

/// What decides the colour of a point. Changing it uploads nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Colouring {
    /// Its role: part, background planes, rest.
    #[default]
    Segment,
    /// How high it lies; background planes keep their own colour.
    Height,
    /// Its signed deviation from the reference; points without one keep the colour of their role, dimmed.
    Deviation,
    /// Nothing: one colour for all, so that only the shading tells the shape.
    Plain,
}

impl Colouring {
    /// Every colouring, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Segment, Self::Height, Self::Deviation, Self::Plain];

    /// What a person calls it.
    pub fn title(self) -> String {
        match self {
            Self::Segment => text!("view-segments"),
            Self::Height => text!("view-height"),
            Self::Deviation => text!("view-deviation"),
            Self::Plain => text!("view-plain"),
        }
    }
}

/// The diameter of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointSize {
    /// The same on the screen at any distance, logical pixels, 1..20.
    Pixels(f32),
    /// The same in the world, so that near points are larger; at least a pixel and a half.
    Metres(Metres),
}

/// Whether the colour scale is drawn in the corner of the view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// While points are coloured by a scale.
    #[default]
    Shown,
    /// As above, but further down: a row of controls stands at the top.
    BelowControls,
    /// Never, for views too small for it.
    Hidden,
}

/// What the deviations of points are, for the words beside their scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ScaleWords {
    /// Distances from the reference.
    #[default]
    Deviation,
    /// Thicknesses of a film, a thousand times as large: a set keeps whole micrometres.
    Film {
        /// In the middle of the scale.
        target: Metres,
        /// From there to its ends.
        range: Metres,
    },
}

/// Everything about the look of a view. Cheap to make anew each frame; the view is drawn again only when it differs.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewStyle {
    /// Colours of the theme.
    pub colours: ViewColours,
    /// What decides the colour of a point, for sets that do not say so themselves.
    pub colouring: Colouring,
    /// Diameter of a point, to be multiplied by its role's weight.
    pub point_size: PointSize,
    /// Strength of the eye-dome lighting, 0 (off) to 2. Raising it deepens edges and noise alike.
    pub eye_dome: f32,
    /// Deviation at the ends of the scale, above 0. Beyond it the end colour stays.
    pub deviation_range: Metres,
    /// What deviations are.
    pub scale_words: ScaleWords,
    /// Whether the colour scale is drawn.
    pub legend: Legend,
}

impl ViewStyle {
    /// The usual look in the colours of a theme.
    pub fn new(colours: ViewColours) -> Self {
        Self {
            colours,
            colouring: Colouring::default(),
            // The spacing of a depth camera's points on a part: closed surfaces at any zoom.
            point_size: PointSize::Metres(Metres::from_mm(4.0)),
            eye_dome: 1.0,
            deviation_range: Metres::from_mm(5.0),
            scale_words: ScaleWords::default(),
            legend: Legend::default(),
        }
    }
}

/// The look of one role.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoleColour {
    /// Its colour.
    pub colour: Color32,
    /// Factor on the diameter of its points; 0 hides them. For lines, their opacity.
    pub weight: f32,
}

/// The colours of a view, by role.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewColours {
    /// Behind everything.
    pub background: Color32,
    /// Text on the view.
    pub text: Color32,
    /// Less important text on the view.
    pub weak_text: Color32,
    /// One per [`Role`], in the order of their numbers.
    pub roles: [RoleColour; Role::ALL.len()],
    /// From low to high.
    pub height_scale: [Color32; SCALE_STOPS],
    /// Diverging: from below the reference over 0 in the middle to above it.
    pub deviation_scale: [Color32; SCALE_STOPS],
    /// Diverging: from a film that is too thin over the right one in the middle to one that is too thick.
    pub film_scale: [Color32; SCALE_STOPS],
}

impl ViewColours {
    /// For a dark window.
    pub fn dark() -> Self {
        let role = |rgb: u32, weight: f32| RoleColour {
            colour: hex(rgb),
            weight,
        };
        Self {
            background: hex(0x0c_0d10),
            text: hex(0xe8_eaed),
            weak_text: hex(0x9a_a0a8),
            roles: [
                role(0xa3_abb8, 1.0),
                role(0x4f_c4b2, 1.0),
                role(0x2f_3b5c, 1.2),
                role(0x5c_4728, 1.2),
                role(0x4b_3558, 1.2),
                role(0x3a_4c31, 1.2),
                role(0x8d_97a8, 1.0),
                role(0xe3_a73f, 1.0),
                role(0xe8_6a5c, 1.0),
                role(0x5b_c46c, 1.0),
                role(0x5a_97e8, 1.0),
                role(0x8b_94a3, 0.55),
                role(0xe8_eaed, 0.9),
                role(0xf0_f2f5, 1.0),
                role(0xff_d866, 1.0),
                role(0xff_9d3c, 1.3),
                role(0xb7_a6f2, 1.1),
            ],
            height_scale: [
                0x3b_3f8c, 0x3b_6fb0, 0x3a_9db0, 0x4f_c4a0, 0x93_d67c, 0xd9_e06a, 0xfb_f3a0,
            ]
            .map(hex),
            deviation_scale: [
                0x3a_62d8, 0x3f_8fdc, 0x4f_bcc9, 0xb9_c9bd, 0xdd_c565, 0xe5_9440, 0xdf_5a35,
            ]
            .map(hex),
            film_scale: [
                0x3f_5fe0, 0x3f_8fdc, 0x45_b5a8, 0x5b_c46c, 0xb5_cf5a, 0xe5_a040, 0xdf_5a35,
            ]
            .map(hex),
        }
    }

    /// For a light window.
    pub fn light() -> Self {
        let role = |rgb: u32, weight: f32| RoleColour {
            colour: hex(rgb),
            weight,
        };
        Self {
            background: hex(0xf6_f7f9),
            text: hex(0x1b_1e23),
            weak_text: hex(0x5a_616b),
            roles: [
                role(0x8d_95a3, 1.0),
                role(0x1d_a08c, 1.0),
                role(0xcc_d6ec, 1.2),
                role(0xe6_d3b4, 1.2),
                role(0xd9_c8e4, 1.2),
                role(0xc9_d9bf, 1.2),
                role(0x7c_8696, 1.0),
                role(0xd0_8a1c, 1.0),
                role(0xc9_3c2e, 1.0),
                role(0x2a_9440, 1.0),
                role(0x2b_6cc9, 1.0),
                role(0x5a_616b, 0.55),
                role(0x1b_1e23, 0.9),
                role(0x1b_1e23, 1.0),
                role(0xb3_0f6a, 1.0),
                role(0xd0_5a00, 1.3),
                role(0x6b_4fd0, 1.1),
            ],
            height_scale: [
                0x31_357d, 0x2f_62a6, 0x2a_8ca6, 0x35_ad86, 0x74_bb57, 0xb9_b93a, 0xdc_a92a,
            ]
            .map(hex),
            deviation_scale: [
                0x22_46b8, 0x2f_7cc7, 0x4f_a9b5, 0xa3_ada3, 0xcf_aa3a, 0xd6_7a22, 0xc2_3f1c,
            ]
            .map(hex),
            film_scale: [
                0x22_46b8, 0x2f_7cc7, 0x2a_9c8f, 0x2a_9440, 0x8a_a52e, 0xd6_8a22, 0xc2_3f1c,
            ]
            .map(hex),
        }
    }

    /// The colours of deviations.
    pub(super) fn deviations(&self, words: ScaleWords) -> &[Color32; SCALE_STOPS] {
        match words {
            ScaleWords::Deviation => &self.deviation_scale,
            ScaleWords::Film { .. } => &self.film_scale,
        }
    }

    /// The look of a role.
    pub fn role(&self, role: Role) -> RoleColour {
        self.roles[role as usize]
    }
}

/// A colour written as red, green, blue.
fn hex(rgb: u32) -> Color32 {
    let [_, red, green, blue] = rgb.to_be_bytes();
    Color32::from_rgb(red, green, blue)
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
