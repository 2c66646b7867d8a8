//! Systems whose open fields were changed after they were checked, and numbers that overflow: typed errors.

use albatross_lti::exponential::exponential;
use albatross_lti::frequency::{FrequencySolver, Method, Response};
use albatross_lti::lags::{LagForm, follow};
use albatross_lti::simulation::{Hold, discretise, simulate_rk4};
use albatross_lti::track::{TrackOptions, Tracker};
use albatross_lti::zpk::Zpk;
use albatross_lti::{Error, Signal, StateSpace, mode_table, mode_table_of};
use albatross_numerics::{C64, Mat};

fn diagonal(n: usize) -> Mat<f64> {
    Mat::from_fn(n, n, |i, j| if i == j { -1.0 - i as f64 } else { 0.0 })
}

fn system() -> StateSpace {
    let ones = |r, c| Mat::from_fn(r, c, |_, _| 1.0);
    StateSpace::unnamed(diagonal(2), ones(2, 1), ones(1, 2), Mat::zeros(1, 1)).unwrap()
}

#[test]
fn regress_altered_systems_are_refused() {
    let damages: [fn(&mut StateSpace); 7] = [
        |s| drop(s.states.pop()),
        |s| s.states.push(Signal::new("z", "1")),
        |s| s.inputs.push(Signal::new("z", "1")),
        |s| s.outputs.clear(),
        |s| s.b = Mat::zeros(3, 1),
        |s| s.c = Mat::zeros(1, 0),
        |s| s.d[(0, 0)] = f64::NAN,
    ];
    for (k, damage) in damages.into_iter().enumerate() {
        let mut altered = system();
        damage(&mut altered);
        let (s, whole) = (&altered, system());
        let refused = [
            s.select(&["u1"], &["y1"]).is_err(),
            s.series(&whole).is_err(),
            whole.series(s).is_err(),
            s.parallel(&whole).is_err(),
            whole.feedback(s).is_err(),
            FrequencySolver::new(s, Method::Auto).is_err(),
            FrequencySolver::with_lags(s, &["x1"]).is_err(),
            mode_table(s).is_err(),
            mode_table_of(s, &[C64::new(-1.0, 0.0)]).is_err(),
            discretise(s, 0.1, Hold::First).is_err(),
            simulate_rk4(s, 0.1, 10, None, |_, _, u| u.fill(0.0)).is_err(),
            Zpk::from_state_space(s).is_err(),
        ];
        assert_eq!(refused, [true; 12], "damage {k}");
        assert_eq!(s.without_idle_states().states.len(), s.states.len());
    }
}

#[test]
fn regress_what_belongs_to_another_system_is_refused() {
    let small = LagForm::new(diagonal(2).as_ref(), &[]).unwrap();
    let large = LagForm::new(diagonal(3).as_ref(), &[]).unwrap();
    let root = small.root(C64::new(-1.0, 0.0)).unwrap();
    let options = TrackOptions::default();
    assert!(follow(&large, &large, std::slice::from_ref(&root), options).is_err());
    assert!(follow(&small, &small, &[root], options).is_ok());

    let mut tracker = Tracker::new(diagonal(2).as_ref(), &[C64::new(-1.0, 0.0)], options).unwrap();
    assert!(tracker.follow_path(|_| Ok(Mat::zeros(3, 3))).is_err());

    let signal = |name| vec![Signal::new(name, "1")];
    let response = Response {
        omega_rad_s: vec![1.0],
        inputs: signal("u"),
        outputs: signal("y"),
        values: vec![Mat::zeros(0, 0)],
    };
    assert!(response.get("y", "u").is_err());
}

/// A path of steps so small that the time does not change would never end.
#[test]
fn regress_steps_reach_the_end_of_a_path() {
    let options = TrackOptions {
        largest_step: 1e-20,
        least_step: 1e-20,
        ..TrackOptions::default()
    };
    let form = LagForm::new(diagonal(2).as_ref(), &[]).unwrap();
    let error = follow(&form, &form, &[], options).unwrap_err();
    assert!(
        matches!(error, Error::Domain { value, .. } if value < 1.0),
        "{error}"
    );
}

#[test]
fn regress_numbers_that_overflow_are_refused() {
    // The norm of a matrix of finite numbers, which counted the squarings.
    let huge = Mat::from_fn(2, 2, |_, _| 1.2e308);
    assert!(matches!(exponential(huge.as_ref()), Err(Error::Domain { .. })));
    // More steps than memory.
    for steps in [usize::MAX, 1 << 40] {
        let run = simulate_rk4(&system(), 1e-3, steps, None, |_, _, u| u.fill(0.0));
        assert!(matches!(run, Err(Error::Domain { .. })), "{steps}");
    }
    // Infinities that cancel: the phase of no number was halved for ever.
    let b = Mat::from_fn(2, 1, |_, _| 1e200);
    let c = Mat::from_fn(1, 2, |_, j| if j == 0 { 1e200 } else { -1e200 });
    let cancels = StateSpace::unnamed(diagonal(2), b, c, Mat::zeros(1, 1)).unwrap();
    for method in [Method::Auto, Method::Lu] {
        let solver = FrequencySolver::new(&cancels, method).unwrap();
        let phase = solver.phase_deg("y1", "u1", &[1.0, 2.0]);
        assert!(phase.is_err(), "{phase:?}");
    }
}

/// A channel that is zero but for rounding has a phase of noise; halving it further never helps.
#[test]
fn regress_phase_of_rounding_ends() {
    let a = Mat::from_fn(2, 2, |i, j| if i == j { -1.0 } else { 0.0 });
    let b = Mat::from_fn(2, 1, |i, _| [1.0, 0.1][i]);
    let c = Mat::from_fn(1, 2, |_, j| [1.0, -10.0][j]);
    let noise = StateSpace::unnamed(a, b, c, Mat::zeros(1, 1)).unwrap();
    let solver = FrequencySolver::new(&noise, Method::Lu).unwrap();
    let phase = solver.phase_deg("y1", "u1", &[1.0, 2.0, 3.0]).unwrap();
    assert_eq!(phase.len(), 3);
}

/// Every mode has a rate of its own and meets its amplitude alone: as lags they would ask for the cube of their number.
#[test]
fn regress_modes_of_a_structure_are_not_taken_for_lags() {
    let n = 450;
    let a = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, false) if i + n == j => 1.0,
        (false, true) if i == j + n => -f64::powi(1.0 + j as f64, 2),
        (false, false) if i == j => -0.02 * (1.0 + (i - n) as f64),
        _ => 0.0,
    });
    let b = Mat::from_fn(2 * n, 1, |i, _| if i < n { 0.0 } else { 1.0 });
    let c = Mat::from_fn(1, 2 * n, |_, j| if j < n { 1.0 } else { 0.0 });
    let structure = StateSpace::unnamed(a, b, c, Mat::zeros(1, 1)).unwrap();
    let refused = FrequencySolver::new(&structure, Method::LagReduced);
    assert!(matches!(refused, Err(Error::Method { .. })));
    let h = FrequencySolver::new(&structure, Method::Auto)
        .unwrap()
        .evaluate(C64::new(0.0, 0.5))
        .unwrap();
    let exact: C64 = (1..=n)
        .map(|k| {
            let w = k as f64;
            C64::new(w * w - 0.25, 0.01 * w).inv()
        })
        .sum();
    assert!((h[(0, 0)] - exact).norm() < 1e-12 * exact.norm());
}
