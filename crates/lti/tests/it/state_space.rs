use albatross_lti::{Error, FrequencySolver, Method, Signal, SignalKind, StateSpace};
use albatross_numerics::{C64, Mat};

use crate::models::{aeroelastic, double_integrator, mat, named, oscillator};

fn at(system: &StateSpace, s: C64) -> Mat<C64> {
    FrequencySolver::new(system, Method::Lu)
        .unwrap()
        .evaluate(s)
        .unwrap()
}

const S: C64 = C64::new(0.3, 1.7);

#[test]
fn val_connections_follow_block_algebra() {
    let (g, k) = (oscillator(2.0, 0.1), oscillator(5.0, 0.4));
    let (hg, hk) = (at(&g, S)[(0, 0)], at(&k, S)[(0, 0)]);
    let close = |system: StateSpace, expected: C64| {
        let found = at(&system, S)[(0, 0)];
        assert!(
            (found - expected).norm() < 1e-14 * expected.norm(),
            "{found} {expected}"
        );
    };
    close(g.series(&k).unwrap(), hg * hk);
    close(g.parallel(&k).unwrap(), hg + hk);
    close(g.feedback(&k).unwrap(), hg / (1.0 + hg * hk));
    assert_eq!(g.series(&k).unwrap().states[2].name, "x_2");

    // Direct paths in both systems: (1 + 2 d)^-1 enters everywhere.
    let mut with_d = g.clone();
    with_d.d[(0, 0)] = 0.7;
    let mut k_with_d = k.clone();
    k_with_d.d[(0, 0)] = -0.2;
    close(
        with_d.feedback(&k_with_d).unwrap(),
        (hg + 0.7) / (1.0 + (hg + 0.7) * (hk - 0.2)),
    );
}

#[test]
fn val_matrix_feedback_against_the_resolvent() {
    let g = aeroelastic(2, 6, 4).select(&["u1", "u2"], &["y1", "y3"]).unwrap();
    let k = aeroelastic(1, 2, 5).select(&["u1", "u2"], &["y1", "y2"]).unwrap();
    let (hg, hk) = (at(&g, S), at(&k, S));
    let closed = at(&g.feedback(&k).unwrap(), S);
    // (I + G K) H = G.
    let residual = &closed + &hg * &hk * &closed - &hg;
    for i in 0..2 {
        for j in 0..2 {
            assert!(residual[(i, j)].norm() < 1e-12, "{:?}", residual[(i, j)]);
        }
    }
}

#[test]
fn val_ill_posed_loop_and_mismatches_are_refused() {
    let mut g = oscillator(2.0, 0.1);
    g.d[(0, 0)] = 1.0;
    let mut k = oscillator(3.0, 0.1);
    k.d[(0, 0)] = -1.0;
    assert!(matches!(
        g.feedback(&k),
        Err(Error::Numerics(albatross_numerics::Error::Singular { .. }))
    ));
    let wide = aeroelastic(1, 2, 1);
    assert!(matches!(
        g.series(&wide),
        Err(Error::Mismatch {
            left: 1,
            right: 2,
            ..
        })
    ));
    assert!(matches!(
        g.parallel(&wide),
        Err(Error::Mismatch {
            left: 1,
            right: 2,
            ..
        })
    ));
}

#[test]
fn val_names_find_and_select() {
    let system = aeroelastic(2, 4, 7);
    assert_eq!(system.output_index("y2"), Ok(1));
    let part = system.select(&["u2"], &["y3", "y1"]).unwrap();
    assert_eq!(part.outputs[0].name, "y3");
    let (whole, part) = (at(&system, S), at(&part, S));
    assert!((part[(0, 0)] - whole[(2, 1)]).norm() < 1e-14);
    assert!((part[(1, 0)] - whole[(0, 1)]).norm() < 1e-14);
    let missing = system.select(&["elevator"], &["y1"]).unwrap_err();
    assert_eq!(
        missing.to_string(),
        "there is no input \"elevator\"; the inputs are: u1, u2"
    );
    assert!(matches!(
        system.select(&["u1", "u1"], &["y1"]),
        Err(Error::DuplicateName {
            kind: SignalKind::Input,
            ..
        })
    ));
}

#[test]
fn val_wrong_shapes_and_values_are_refused() {
    let build = |b: Mat<f64>| {
        StateSpace::try_new(
            (mat(&[&[-1.0]]), b, mat(&[&[1.0]]), mat(&[&[0.0]])),
            named("x", 1),
            named("u", 1),
            named("y", 1),
        )
    };
    assert!(build(mat(&[&[1.0]])).is_ok());
    assert!(matches!(
        build(mat(&[&[1.0, 2.0]])),
        Err(Error::Shape {
            matrix: "B",
            expected: (1, 1),
            found: (1, 2),
            ..
        })
    ));
    assert!(matches!(
        build(mat(&[&[f64::NAN]])),
        Err(Error::Numerics(albatross_numerics::Error::NonFinite {
            what: "B",
            ..
        }))
    ));
}

#[test]
fn val_stability() {
    assert_eq!(oscillator(2.0, 0.01).is_stable(), Ok(true));
    assert_eq!(oscillator(2.0, -0.01).is_stable(), Ok(false));
    assert_eq!(double_integrator().is_stable(), Ok(false));
}

#[test]
fn val_idle_states_are_dropped_without_a_trace() {
    let system = aeroelastic(2, 4, 3);
    let without = system.without_idle_states();
    assert_eq!(system.states.len(), 9);
    assert_eq!(without.states.len(), 8);
    assert!((at(&system, S)[(1, 1)] - at(&without, S)[(1, 1)]).norm() < 1e-14);
}

#[test]
fn val_json_keeps_every_bit_and_checks_shapes() {
    let system = aeroelastic(2, 3, 11);
    let text = serde_json::to_string(&system).unwrap();
    assert_eq!(serde_json::from_str::<StateSpace>(&text).unwrap(), system);

    let gain = StateSpace::try_new(
        (
            Mat::zeros(0, 0),
            Mat::zeros(0, 1),
            Mat::zeros(1, 0),
            mat(&[&[3.0]]),
        ),
        vec![],
        vec![Signal::new("u", "rad")],
        vec![Signal::new("y", "1")],
    )
    .unwrap();
    let text = serde_json::to_string(&gain).unwrap();
    assert_eq!(serde_json::from_str::<StateSpace>(&text).unwrap(), gain);
    let broken = text.replace("\"d\":[[3.0]]", "\"d\":[[3.0,4.0]]");
    let message = serde_json::from_str::<StateSpace>(&broken)
        .unwrap_err()
        .to_string();
    assert!(message.contains("matrix D is 1 x 2"), "{message}");
}
