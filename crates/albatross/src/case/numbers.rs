//! Ranges of the numbers of a case.
//!
//! TOML has `nan` and `inf`, and a slip of a power of ten is as legal. Both are refused here, where the key is known;
//! the stages see quantities that they have no name of the case for.

use super::{Case, Damping, SignalCase};
use albatross_flight::atmosphere::ALTITUDES;
use albatross_numerics::ShortNumber;
use std::fmt;

/// Beyond it a number of a case is a mistake, and products of such numbers overflow.
const LARGEST: f64 = 1e15;
/// Below it a quantity that must be positive is a mistake, and quotients overflow.
const LEAST: f64 = 1e-12;

/// What a number may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Range {
    /// Any finite number.
    Finite,
    /// A positive number.
    Positive,
    /// Zero or more.
    NotNegative,
    /// From a number to another.
    Within(f64, f64),
    /// From a number to below another.
    Below(f64, f64),
    /// Between two numbers.
    Between(f64, f64),
    /// Where the standard atmosphere holds, m.
    Altitude,
}

impl Range {
    fn holds(self, v: f64) -> bool {
        v.abs() <= LARGEST
            && match self {
                Self::Finite => true,
                Self::Positive => v >= LEAST,
                Self::NotNegative => v >= 0.0,
                Self::Within(low, high) => (low..=high).contains(&v),
                Self::Below(low, high) => (low..high).contains(&v),
                Self::Between(low, high) => low < v && v < high,
                Self::Altitude => ALTITUDES.contains(&v),
            }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(f, "a finite number, at most {LARGEST:e} in size"),
            Self::Positive => write!(f, "a positive number, {LEAST:e} to {LARGEST:e}"),
            Self::NotNegative => write!(f, "a number from 0 to {LARGEST:e}"),
            Self::Within(low, high) => write!(f, "a number from {low} to {high}"),
            Self::Below(low, high) => write!(f, "a number from {low} to below {high}"),
            Self::Between(low, high) => write!(f, "a number between {low} and {high}"),
            Self::Altitude => {
                let (low, high) = (ALTITUDES.start(), ALTITUDES.end());
                write!(
                    f,
                    "an altitude from {low} to {high} m, where the model of the atmosphere holds"
                )
            }
        }
    }
}

/// A number of the case: its table, its key, the number, what it may be.
type Number = (String, &'static str, f64, Range);

impl Case {
    /// The first number out of its range: what was found, and the cure.
    pub(super) fn number_out_of_range(&self) -> Option<(String, String)> {
        self.numbers()
            .into_iter()
            .find(|(.., value, range)| !range.holds(*value))
            .map(|(table, key, value, range)| {
                (
                    format!("{table} {key} is {}", ShortNumber(value)),
                    format!("give {range}"),
                )
            })
    }

    fn numbers(&self) -> Vec<Number> {
        use Range::{Below, Between, Finite, NotNegative, Positive, Within};
        let mut list: Vec<Number> = Vec::new();
        let mut add = |table: &str, key, value, range| list.push((table.to_owned(), key, value, range));

        let structure = &self.structure;
        let dampings = match &structure.damping_ratio {
            Damping::Uniform(xi) => std::slice::from_ref(xi),
            Damping::PerMode(ratios) => ratios.as_slice(),
        };
        for ratio in dampings {
            add("[structure]", "damping_ratio", *ratio, Below(0.0, 1.0));
        }
        add(
            "[structure]",
            "mean_axes_tolerance",
            structure.mean_axes_tolerance,
            Positive,
        );

        let aerodynamics = &self.aerodynamics;
        let factor = aerodynamics.apparent_mass_factor;
        add(
            "[aerodynamics]",
            "apparent_mass_factor",
            factor,
            Within(0.0, 1000.0),
        );
        for strips in aerodynamics.strips.iter().flatten() {
            add(
                "[aerodynamics] strips:",
                "alpha_deg",
                strips.alpha_deg,
                Within(-90.0, 90.0),
            );
        }
        if let Some(lattice) = &aerodynamics.lattice {
            if let Some(mach) = lattice.mach {
                add("[aerodynamics.lattice]", "mach", mach, Below(0.0, 1.0));
            }
            for alpha in lattice.alphas_deg {
                add("[aerodynamics.lattice]", "alphas_deg", alpha, Within(-90.0, 90.0));
            }
        }
        for surface in &aerodynamics.surfaces {
            let table = format!("surface `{}`:", surface.name);
            add(
                &table,
                "downwash_gradient",
                surface.downwash_gradient,
                Below(-1000.0, 1.0),
            );
        }

        if let Some(reference) = &self.reference {
            add("[reference]", "area", reference.area, Positive);
            add("[reference]", "chord", reference.chord, Positive);
            add("[reference]", "span", reference.span, Positive);
        }

        let flight = &self.flight;
        if let Some(mach) = flight.mach {
            add("[flight]", "mach", mach, Positive);
        }
        if let Some(speed) = flight.speed {
            add("[flight]", "speed", speed, Positive);
        }
        add("[flight]", "altitude", flight.altitude, Range::Altitude);
        add(
            "[flight]",
            "path_angle_deg",
            flight.path_angle_deg,
            Between(-90.0, 90.0),
        );
        add("[flight]", "gravity", flight.gravity, Positive);

        for engine in &self.engines {
            let table = format!("engine `{}`:", engine.name);
            add(&table, "share", engine.share, Within(-1000.0, 1000.0));
            add(
                &table,
                "incidence_deg",
                engine.incidence_deg,
                Within(-360.0, 360.0),
            );
            add(&table, "toe_deg", engine.toe_deg, Within(-360.0, 360.0));
        }

        for manoeuvre in &self.manoeuvres {
            let table = format!("manoeuvre `{}`:", manoeuvre.name);
            let mut add = |key, value, range| add(&table, key, value, range);
            add("end", manoeuvre.end, Positive);
            add("dt", manoeuvre.dt, Positive);
            // A step longer than the manoeuvre leaves nothing to simulate; a hair of rounding is not a step.
            add("dt", manoeuvre.dt, Within(LEAST, manoeuvre.end * (1.0 + 1e-9)));
            match &manoeuvre.signal {
                SignalCase::Doublet {
                    amplitude_deg,
                    start,
                    frequency_hz,
                    ..
                } => {
                    add("amplitude", *amplitude_deg, Finite);
                    add("start", *start, Finite);
                    add("frequency_hz", *frequency_hz, Positive);
                }
                SignalCase::Step { amplitude_deg, start } => {
                    add("amplitude", *amplitude_deg, Finite);
                    add("start", *start, Finite);
                }
                SignalCase::ThreeTwoOneOne {
                    amplitude_deg,
                    start,
                    unit,
                } => {
                    add("amplitude", *amplitude_deg, Finite);
                    add("start", *start, Finite);
                    add("unit", *unit, Positive);
                }
                SignalCase::Chirp {
                    amplitude_deg,
                    start,
                    duration,
                    from_hz,
                    to_hz,
                } => {
                    add("amplitude", *amplitude_deg, Finite);
                    add("start", *start, Finite);
                    add("duration", *duration, Positive);
                    add("from_hz", *from_hz, NotNegative);
                    add("to_hz", *to_hz, NotNegative);
                }
                SignalCase::Csv { .. } => {}
            }
        }
        list
    }
}
