//! The International Standard Atmosphere (ISO 2533:1975; ICAO Doc 7488) up to 32 km of geopotential altitude.
//!
//! Equations: THEORY (18a).

use num_dual::DualNum;
use std::ops::RangeInclusive;

/// Specific gas constant of air \[J/(kg K)\].
pub const GAS_CONSTANT: f64 = 287.05287;
/// Standard gravity \[m/s²\].
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// Ratio of specific heats of air.
pub const HEAT_RATIO: f64 = 1.4;

/// Geopotential altitudes at which the model holds \[m\].
pub const ALTITUDES: RangeInclusive<f64> = -2_000.0..=32_000.0;

/// A layer of constant lapse rate: base altitude \[m\], temperature \[K\], pressure \[Pa\], lapse rate \[K/m\].
struct Layer {
    base: f64,
    temperature: f64,
    pressure: f64,
    lapse: f64,
}

/// Troposphere, lower and middle stratosphere. The pressures at the bases follow from the layer below.
const LAYERS: [Layer; 3] = [
    Layer {
        base: 0.0,
        temperature: 288.15,
        pressure: 101_325.0,
        lapse: -0.0065,
    },
    Layer {
        base: 11_000.0,
        temperature: 216.65,
        pressure: 22_632.040_095_007_81,
        lapse: 0.0,
    },
    Layer {
        base: 20_000.0,
        temperature: 216.65,
        pressure: 5_474.877_424_281_06,
        lapse: 0.001,
    },
];

/// State of the air at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air<T> {
    /// Temperature \[K\].
    pub temperature: T,
    /// Pressure \[Pa\].
    pub pressure: T,
    /// Density \[kg/m³\].
    pub density: T,
    /// Speed of sound \[m/s\].
    pub speed_of_sound: T,
}

/// The standard atmosphere at geopotential altitude `altitude` \[m\].
///
/// Valid for [`ALTITUDES`]; beyond, the outermost layers are continued. Differentiable within each layer: with dual
/// numbers the derivative with altitude is exact.
pub fn standard<T: DualNum<Primitive = f64> + Copy>(altitude: T) -> Air<T> {
    let [troposphere, lower, middle] = &LAYERS;
    let layer = match altitude.re() {
        h if h <= lower.base => troposphere,
        h if h <= middle.base => lower,
        _ => middle,
    };
    let above = altitude - layer.base;
    let temperature = above * layer.lapse + layer.temperature;
    let pressure = if layer.lapse == 0.0 {
        (above * (-STANDARD_GRAVITY / (GAS_CONSTANT * layer.temperature))).exp() * layer.pressure
    } else {
        (temperature / layer.temperature).powf(-STANDARD_GRAVITY / (layer.lapse * GAS_CONSTANT))
            * layer.pressure
    };
    Air {
        temperature,
        pressure,
        density: pressure / (temperature * GAS_CONSTANT),
        speed_of_sound: (temperature * (HEAT_RATIO * GAS_CONSTANT)).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;

    /// ICAO Doc 7488 tables: 11 km 0.36391 kg/m3 and 295.07 m/s, 20 km 0.088035 kg/m3, 32 km 868.02 Pa.
    #[test]
    fn val_icao_tables() {
        assert!((standard(0.0_f64).density - 1.225).abs() < 1e-4);
        assert!((standard(11_000.0_f64).density - 0.36391).abs() < 1e-5);
        assert!((standard(11_000.0_f64).speed_of_sound - 295.07).abs() < 5e-3);
        assert!((standard(20_000.0_f64).density - 0.088035).abs() < 5e-7);
        assert!((standard(32_000.0_f64).pressure - 868.02).abs() < 0.01);
    }

    /// Layers join: the printed base pressures are those of the layer below.
    #[test]
    fn prop_pressure_is_continuous() {
        for base in [11_000.0, 20_000.0] {
            let (below, above) = (standard::<f64>(base), standard::<f64>(base + 1e-6));
            assert!((below.pressure / above.pressure - 1.0).abs() < 1e-9);
        }
    }

    /// Hydrostatics, dp/dh = -rho g, with the derivative by dual numbers.
    #[test]
    fn prop_hydrostatic() {
        for h in [500.0, 10_258.0, 15_000.0, 25_000.0] {
            let air = standard(Dual64::new(h, 1.0));
            assert!((air.pressure.eps / (-air.density.re * STANDARD_GRAVITY) - 1.0).abs() < 1e-13);
        }
    }
}
