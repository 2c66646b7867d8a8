//! Manoeuvres: inputs, steps, amplitudes and signals.

use super::files::Files;
use super::{Findings, Subject, parts};
use crate::case::{ManoeuvreCase, SignalCase};
use crate::inputs::read_text;
use crate::tables::Columns;
use albatross_flight::Method;

/// Runge-Kutta of fourth order is stable on the imaginary axis up to this.
const STABLE: f64 = 2.8;
/// Steps in a radian of the fastest mode for a good history.
const ACCURATE: f64 = 1.0;
/// Deflections beyond are no longer linear \[deg\].
const LARGE_DEG: f64 = 25.0;
/// A deflection below looks like radians \[deg\].
const SMALL_DEG: f64 = 0.06;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    for (i, manoeuvre) in subject.case.manoeuvres.iter().enumerate() {
        let key = format!("manoeuvre.{i}");
        input(subject, files, manoeuvre, &key, found);
        steps(subject, files, manoeuvre, &key, found);
        signal(subject, files, manoeuvre, &key, found);
    }
}

fn input(subject: &Subject, files: &Files, manoeuvre: &ManoeuvreCase, key: &str, found: &mut Findings) {
    let Some(controls) = super::controls::names_of(files) else {
        return;
    };
    if manoeuvre.input != "thrust" && !controls.contains(&manoeuvre.input.as_str()) {
        found.error(
            &subject.at(&format!("{key}.input")),
            format!(
                "`{}` moves `{}`, which is no control",
                manoeuvre.name, manoeuvre.input
            ),
            parts::choose_input(&manoeuvre.input, &controls),
        );
    }
}

fn steps(subject: &Subject, files: &Files, manoeuvre: &ManoeuvreCase, key: &str, found: &mut Findings) {
    let place = subject.at(&format!("{key}.dt"));
    let (end, dt) = (manoeuvre.end, manoeuvre.dt);
    let positive = |v: f64| v.is_finite() && v > 0.0;
    if !(positive(end) && positive(dt)) || dt > end {
        let what = format!("`{}` goes to {end} s in steps of {dt} s", manoeuvre.name);
        return found.error(
            &place,
            what,
            "give an end and a shorter step, both positive, in s",
        );
    }
    let count = end / dt;
    if (count - count.round()).abs() > 1e-6 {
        found.error(
            &place,
            format!("`{}` ends after {count:.4} steps", manoeuvre.name),
            format!(
                "make the end a whole number of steps, such as {} s",
                count.round() * dt
            ),
        );
    }
    let fastest = fastest_mode(subject, files);
    if let Some(omega) = fastest.filter(|w| dt * w > STABLE) {
        found.error(
            &place,
            format!("a step of {dt} s is too long for the mode at {omega:.0} rad/s: the history will grow without bound"),
            format!("give dt below {:.1e} s ({STABLE} over the fastest frequency)", STABLE / omega),
        );
    } else if let Some(omega) = fastest.filter(|w| dt * w > ACCURATE) {
        found.warning(
            &place,
            format!("a step of {dt} s is coarse for the mode at {omega:.0} rad/s"),
            format!("give dt below {:.1e} s", 0.5 * ACCURATE / omega),
        );
    }
    let lag = fastest_lag(subject, files);
    if let Some(rate) = lag.filter(|r| manoeuvre.method == Method::Rk4 && dt * r > STABLE) {
        found.error(
            &place,
            format!("a step of {dt} s is too long for the fastest lag, {rate:.0} 1/s"),
            format!(
                "set method = \"exact_lags\", or give dt below {:.1e} s",
                STABLE / rate
            ),
        );
    }
}

/// The highest frequency among the modes that are kept \[rad/s\].
fn fastest_mode(subject: &Subject, files: &Files) -> Option<f64> {
    let basis = subject
        .case
        .basis(files.deck.as_ref()?, files.results.as_ref()?)
        .ok()?;
    basis.omegas_rad_s().into_iter().reduce(f64::max)
}

/// The fastest lag, `0.6 V / c` at the shortest chord \[1/s\].
fn fastest_lag(subject: &Subject, files: &Files) -> Option<f64> {
    let surfaces = &subject.case.aerodynamics.surfaces;
    let strips = files.strips[0].as_ref()?;
    let own = strips.surfaces.iter().filter(|s| {
        let name = albatross_strip::slopes::base_name(&s.name);
        surfaces.iter().any(|c| c.name.trim().eq_ignore_ascii_case(name))
    });
    let chord = own.flat_map(|s| &s.strips).map(|s| s.chord).reduce(f64::min)?;
    (chord > 0.0).then(|| 0.6 * subject.case.flight.speed() / chord)
}

fn signal(subject: &Subject, files: &Files, manoeuvre: &ManoeuvreCase, key: &str, found: &mut Findings) {
    let place = subject.at(&format!("{key}.signal"));
    let is_control = manoeuvre.input != "thrust";
    let name = &manoeuvre.name;
    let (amplitude, start) = match &manoeuvre.signal {
        SignalCase::Doublet {
            amplitude_deg, start, ..
        }
        | SignalCase::Step { amplitude_deg, start }
        | SignalCase::ThreeTwoOneOne {
            amplitude_deg, start, ..
        }
        | SignalCase::Chirp {
            amplitude_deg, start, ..
        } => (*amplitude_deg, *start),
        SignalCase::Csv {
            file,
            time_column,
            value_column,
            ..
        } => return samples(files, file, [time_column, value_column], &place, found),
    };
    if start >= manoeuvre.end {
        found.warning(
            &place,
            format!(
                "the signal of `{name}` starts at {start} s, the end is at {} s",
                manoeuvre.end
            ),
            "start it sooner, or end later",
        );
    }
    if is_control && amplitude.abs() > LARGE_DEG {
        found.warning(
            &place,
            format!("`{name}` deflects `{}` by {amplitude} deg", manoeuvre.input),
            "coefficients are linear: stay below 25 deg",
        );
    } else if is_control && amplitude != 0.0 && amplitude.abs() < SMALL_DEG {
        found.warning(
            &place,
            format!(
                "`{name}` deflects `{}` by {amplitude} deg, which looks like radians",
                manoeuvre.input
            ),
            format!(
                "give degrees: {amplitude} rad is {:.3} deg",
                amplitude.to_degrees()
            ),
        );
    } else if amplitude == 0.0 {
        found.warning(
            &place,
            format!("the amplitude of `{name}` is zero"),
            "give an amplitude",
        );
    }
    if let SignalCase::Doublet { frequency_hz, .. } = manoeuvre.signal
        && !(frequency_hz > 0.0 && frequency_hz * manoeuvre.dt < 0.1)
    {
        found.warning(
            &place,
            format!("a doublet of {frequency_hz} Hz in steps of {} s", manoeuvre.dt),
            "give a positive frequency in Hz with at least ten steps a period",
        );
    }
}

fn samples(files: &Files, file: &str, columns: [&String; 2], place: &str, found: &mut Findings) {
    let path = files.directory.join(file);
    let read = read_text(&path).and_then(|text| Columns::parse(&text, &path.display().to_string()));
    match read {
        Err(error) => found.of_error(&error.to_string(), place),
        Ok(table) => {
            for column in columns {
                if let Err(error) = table.numbers(column) {
                    found.of_error(&error.to_string(), place);
                }
            }
        }
    }
}
