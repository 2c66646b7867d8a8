//! What is measured: quantities of the mean axes, or of a point of the structure with its elastic motion.

/// A named output.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Name in every table and file.
    pub name: String,
    /// What is measured.
    pub quantity: Quantity,
    /// Where; none for the mean axes at the centre of gravity.
    pub point: Option<SensorPoint>,
}

/// A point of the structure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SensorPoint {
    /// Body axes from the centre of gravity \[m\].
    pub position: [f64; 3],
    /// Upward displacement per unit of each mode (T3 in structural axes) \[m per unit\].
    pub translation_up: Vec<f64>,
    /// Nose-up rotation per unit of each mode (R2) \[rad per unit\].
    pub rotation_nose_up: Vec<f64>,
}

/// A measured quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Incidence `atan(w/u)`; at a point with the point's own velocity and elastic rotation \[rad\].
    Alpha,
    /// Sideslip `asin(v/V)` \[rad\].
    Beta,
    /// Airspeed \[m/s\].
    Airspeed,
    /// Altitude \[m\].
    Altitude,
    /// Roll rate p \[rad/s\].
    RollRate,
    /// Pitch rate q; at a point with the elastic rotation rate \[rad/s\].
    PitchRate,
    /// Yaw rate r \[rad/s\].
    YawRate,
    /// Bank angle \[rad\].
    BankAngle,
    /// Pitch attitude \[rad\].
    PitchAngle,
    /// Load factor along minus body z, `-(a_z - g cos theta cos phi)/g`: 1 in level flight.
    LoadFactor,
    /// Acceleration along body z, positive down, gravity not included \[m/s²\].
    VerticalAcceleration,
}

impl Quantity {
    /// Unit of the value.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Alpha | Self::Beta | Self::BankAngle | Self::PitchAngle => "rad",
            Self::Airspeed => "m/s",
            Self::Altitude => "m",
            Self::RollRate | Self::PitchRate | Self::YawRate => "rad/s",
            Self::LoadFactor => "-",
            Self::VerticalAcceleration => "m/s2",
        }
    }
}

impl Sensor {
    /// A quantity of the mean axes at the centre of gravity.
    pub fn at_cg(name: &str, quantity: Quantity) -> Self {
        Self {
            name: name.to_owned(),
            quantity,
            point: None,
        }
    }
}
