//! Lengths and angles formatted for the user.

/// Units shown to the user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnitSystem {
    /// Millimetres and degrees.
    #[default]
    MillimetresDegrees,
    /// Metres and radians.
    MetresRadians,
}

impl UnitSystem {
    /// Symbols of the units.
    pub fn title(self) -> &'static str {
        match self {
            Self::MillimetresDegrees => "mm · °",
            Self::MetresRadians => "m · rad",
        }
    }

    /// Returns the other system.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::MillimetresDegrees => Self::MetresRadians,
            Self::MetresRadians => Self::MillimetresDegrees,
        }
    }

    /// Formats a length given in metres.
    pub fn length(self, metres: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{} mm", minus(metres * 1000.0, 1)),
            Self::MetresRadians => format!("{} m", minus(metres, 4)),
        }
    }

    /// Formats an area given in square metres.
    pub fn area(self, square_metres: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{} cm²", minus(square_metres * 1e4, 0)),
            Self::MetresRadians => format!("{} m²", minus(square_metres, 2)),
        }
    }

    /// Factor from metres, unit symbol and decimals for lengths on an axis.
    pub fn length_axis(self) -> (f64, &'static str, usize) {
        match self {
            Self::MillimetresDegrees => (1000.0, "mm", 0),
            Self::MetresRadians => (1.0, "m", 3),
        }
    }

    /// Factor from radians, unit symbol and decimals for angles on an axis.
    pub fn angle_axis(self) -> (f64, &'static str, usize) {
        match self {
            Self::MillimetresDegrees => (1.0_f64.to_degrees(), "°", 0),
            Self::MetresRadians => (1.0, "rad", 2),
        }
    }

    /// Formats a difference of lengths given in metres, with its sign.
    pub fn signed_length(self, metres: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{} mm", signed(metres * 1000.0, 1)),
            Self::MetresRadians => format!("{} m", signed(metres, 4)),
        }
    }

    /// Formats the magnitude of an angle given in radians.
    pub fn angle(self, radians: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{:.2}°", radians.to_degrees()),
            Self::MetresRadians => format!("{radians:.4} rad"),
        }
    }

    /// Formats an angle given in radians, with its sign.
    pub fn signed_angle(self, radians: f64) -> String {
        match self {
            Self::MillimetresDegrees => format!("{}°", signed(radians.to_degrees(), 2)),
            Self::MetresRadians => format!("{} rad", signed(radians, 4)),
        }
    }
}

/// Formats a number, with a minus sign (U+2212) if it is negative.
fn minus(value: f64, decimals: usize) -> String {
    let text = signed(value, decimals);
    text.strip_prefix('+').map(str::to_owned).unwrap_or(text)
}

/// Formats a number with its sign, using U+2212 for minus; no sign if it rounds to zero.
fn signed(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    if digits.bytes().all(|b| matches!(b, b'0' | b'.')) {
        digits
    } else if value < 0.0 {
        format!("\u{2212}{digits}")
    } else {
        format!("+{digits}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_person_reads_signs_and_units() {
        let mm = UnitSystem::MillimetresDegrees;
        assert_eq!(mm.signed_length(0.0423), "+42.3 mm");
        assert_eq!(mm.signed_length(-0.0081), "\u{2212}8.1 mm");
        assert_eq!(mm.signed_length(-0.000_01), "0.0 mm");
        assert_eq!(mm.signed_angle(std::f64::consts::FRAC_PI_2), "+90.00°");
        assert_eq!(UnitSystem::MetresRadians.signed_length(0.0423), "+0.0423 m");
        assert_eq!(mm.length(-0.0481), "\u{2212}48.1 mm");
        assert_eq!(mm.length(0.15), "150.0 mm");
        assert_eq!(mm.angle(0.1), "5.73°");
        assert_eq!(mm.other().other(), mm);
    }
}
