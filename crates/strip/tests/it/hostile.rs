//! Input that makes no sense gives an error that says why.

use crate::models::invented;
use albatross_numerics::C64;
use albatross_numerics::Mat;
use albatross_strip::elastic::{compact_state_matrix, pi_matrices, quasi_steady_state_matrix, state_matrix};
use albatross_strip::flutter::{divergence_speed, exact_flutter, harmonic_operator, lag_flutter};
use albatross_strip::forces::{Downwash, downwash, generalized_forces};
use albatross_strip::kernels::Kernel;
use albatross_strip::kernels::{JONES, Lag};
use albatross_strip::neutral::{divergence_points, neutral_points};
use albatross_strip::quasi_steady::{ReferenceDimensions, StripLoads, rigid_to_elastic};
use albatross_strip::section::TypicalSection;
use albatross_strip::sweep::{Method, sweep};
use albatross_strip::{
    AeroelasticModel, DihedralForm, Error, Flow, GeneralizedForces, Split, Strip, StripShapes, StripTheory,
    Structure,
};

fn strip() -> Strip {
    Strip {
        y: 1.0,
        z: 0.0,
        width: 1.0,
        chord: 1.0,
        x_ac: 0.25,
        x_lra: 0.4,
        cl_alpha: 6.0,
        dihedral_rad: 0.0,
    }
}

fn shapes(strips: usize, modes: usize) -> StripShapes {
    let ones = Mat::from_fn(strips, modes, |j, k| 1.0 + (j + k) as f64);
    StripShapes::try_new(ones.clone(), ones).unwrap()
}

fn model(strips: Vec<Strip>, shapes: StripShapes, lags: &[Lag]) -> Result<AeroelasticModel, Error> {
    let n = shapes.n_shapes();
    AeroelasticModel::try_new(
        Structure::modal(&vec![1.0; n], &vec![10.0; n], &vec![0.0; n])?,
        strips,
        shapes,
        &StripTheory::default(),
        Split::default(),
        lags,
    )
}

#[test]
fn prop_bad_strips_are_named() {
    type Set = fn(&mut Strip, f64);
    let bad: [(&str, Set); 8] = [
        ("y", |s, v| s.y = v),
        ("z", |s, v| s.z = v),
        ("width", |s, v| s.width = v),
        ("chord", |s, v| s.chord = v),
        ("x_ac", |s, v| s.x_ac = v),
        ("x_lra", |s, v| s.x_lra = v),
        ("cl_alpha", |s, v| s.cl_alpha = v),
        ("dihedral_rad", |s, v| s.dihedral_rad = v),
    ];
    for (quantity, set) in bad {
        for value in [f64::NAN, f64::INFINITY] {
            let mut second = strip();
            set(&mut second, value);
            let found = model(vec![strip(), second], shapes(2, 1), &JONES);
            assert!(
                matches!(found, Err(Error::BadStrip { index: 1, quantity: q, .. }) if q == quantity),
                "{quantity}"
            );
        }
    }
    for value in [0.0, -1.0] {
        let thin = Strip {
            chord: value,
            ..strip()
        };
        let error = model(vec![thin], shapes(1, 1), &JONES).unwrap_err();
        assert!(error.to_string().contains("strip 1: chord is"), "{error}");
    }
}

#[test]
fn prop_sizes_that_differ() {
    let theory = StripTheory::default();
    let three = shapes(3, 2);
    assert!(matches!(
        model(vec![strip(); 2], three.clone(), &JONES),
        Err(Error::Shape { .. })
    ));
    assert!(matches!(
        model(vec![], shapes(0, 2), &JONES),
        Err(Error::Empty { what: "strips" })
    ));
    assert!(matches!(
        model(vec![strip()], shapes(1, 0), &JONES),
        Err(Error::Empty { .. })
    ));
    let uneven = StripShapes {
        gamma: Mat::zeros(1, 2),
        ..three.clone()
    };
    assert!(matches!(
        downwash(&[strip(); 3], &uneven, &theory),
        Err(Error::Shape { what: "gamma", .. })
    ));
    let with_nan = StripShapes {
        phi: Mat::from_fn(3, 2, |_, _| f64::NAN),
        ..three.clone()
    };
    let found = generalized_forces(&[strip(); 3], &three, &with_nan, &theory, Split::default());
    assert_eq!(
        found.unwrap_err(),
        Error::NotFinite {
            what: "phi",
            row: 0,
            column: 0
        }
    );
    let square = Mat::<f64>::identity(2, 2);
    let structure = Structure {
        mass: square.clone(),
        damping: Mat::zeros(3, 2),
        stiffness: square,
    };
    let found = AeroelasticModel::try_new(
        structure,
        vec![strip(); 3],
        three.clone(),
        &theory,
        Split::default(),
        &[],
    );
    assert!(matches!(
        found,
        Err(Error::Shape {
            what: "the damping matrix",
            ..
        })
    ));
    let components = StripShapes::from_components(
        &[strip(); 3],
        DihedralForm::Paper,
        [&three.phi, &Mat::zeros(3, 1)],
        [&three.phi, &three.phi],
    );
    assert!(matches!(
        components,
        Err(Error::Shape {
            what: "translation z",
            ..
        })
    ));
    let loads = StripLoads {
        lift: Mat::zeros(3, 2),
        moment: Mat::zeros(3, 1),
    };
    let reference = ReferenceDimensions {
        area: 1.0,
        chord: 1.0,
        span: 1.0,
    };
    let found = rigid_to_elastic(&[strip(); 3], &three, &loads, &reference);
    assert!(matches!(
        found,
        Err(Error::Shape {
            what: "strip moment",
            ..
        })
    ));
    let flat = ReferenceDimensions {
        area: 0.0,
        ..reference
    };
    let found = rigid_to_elastic(
        &[strip(); 3],
        &three,
        &StripLoads::from_lift(Mat::zeros(3, 2)),
        &flat,
    );
    assert!(matches!(found, Err(Error::BadOption { .. })));
}

#[test]
fn prop_bad_options() {
    let growing = Lag {
        rate: 0.1,
        gain: -0.2,
    };
    assert!(matches!(
        model(vec![strip()], shapes(1, 1), &[JONES[0], growing]),
        Err(Error::BadLag {
            index: 1,
            quantity: "rate",
            ..
        })
    ));
    let theory = StripTheory {
        apparent_mass_factor: f64::NAN,
        ..StripTheory::default()
    };
    let found = generalized_forces(
        &[strip()],
        &shapes(1, 1),
        &shapes(1, 1),
        &theory,
        Split::default(),
    );
    assert!(matches!(found, Err(Error::BadOption { .. })));
    for (mu, omega, xi) in [
        (0.0, 1.0, 0.0),
        (1.0, -1.0, 0.0),
        (1.0, 1.0, f64::NAN),
        (f64::INFINITY, 1.0, 0.0),
    ] {
        assert!(matches!(
            Structure::modal(&[mu], &[omega], &[xi]),
            Err(Error::BadMode { .. })
        ));
    }
    assert!(matches!(
        Structure::modal(&[1.0], &[], &[0.0]),
        Err(Error::Shape { .. })
    ));
    let section = TypicalSection {
        mass: f64::NAN,
        static_moment: 0.0,
        inertia: 1.0,
        plunge_stiffness: 1.0,
        pitch_stiffness: 1.0,
        semi_chord: 1.0,
        axis: 0.0,
        cl_alpha: 6.0,
    };
    assert!(matches!(section.model(&[]), Err(Error::NotFinite { .. })));
}

#[test]
fn prop_bad_flow() {
    let model = invented(0, 3, 2, 0.0);
    let reference = ReferenceDimensions {
        area: 1.0,
        chord: 1.0,
        span: 1.0,
    };
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        for flow in [Flow { rho: bad, speed: 1.0 }, Flow { rho: 1.0, speed: bad }] {
            assert!(matches!(state_matrix(&model, flow), Err(Error::BadFlow { .. })));
            assert!(matches!(
                quasi_steady_state_matrix(&model, flow),
                Err(Error::BadFlow { .. })
            ));
            let q = Mat::zeros(2, 1);
            assert!(matches!(
                pi_matrices(&model, flow, &reference, &q, &q),
                Err(Error::BadFlow { .. })
            ));
        }
        assert!(matches!(lag_flutter(&model, bad), Err(Error::BadFlow { .. })));
        assert!(matches!(exact_flutter(&model, bad), Err(Error::BadFlow { .. })));
        assert!(matches!(
            divergence_speed(&model, bad),
            Err(Error::BadFlow { .. })
        ));
    }
}

/// Numbers whose products overflow are errors too.
#[test]
fn prop_overflow_is_an_error() {
    let huge = Strip {
        chord: 1e200,
        ..strip()
    };
    let found = model(vec![huge], shapes(1, 2), &JONES).and_then(|m| lag_flutter(&m, 1.0));
    assert!(found.is_err(), "{found:?}");
    let unstable = Structure {
        mass: Mat::identity(1, 1),
        damping: Mat::zeros(1, 1),
        stiffness: Mat::from_fn(1, 1, |_, _| -4.0),
    };
    let theory = StripTheory::default();
    let model = AeroelasticModel::try_new(
        unstable,
        vec![strip()],
        shapes(1, 1),
        &theory,
        Split::default(),
        &JONES,
    )
    .unwrap();
    assert!(matches!(lag_flutter(&model, 1.0), Err(Error::BadMode { .. })));
}

/// Wave numbers beyond all numbers once made a grid without an end.
#[test]
fn regress_chords_of_no_scale_are_refused() {
    for chords in [[1e-308, 1.0], [1.0, 1e300], [1e-300, 1e-300], [1e-5, 10.0]] {
        let strips = chords.map(|chord| Strip { chord, ..strip() }).to_vec();
        let found = model(strips, shapes(2, 2), &JONES).and_then(|m| lag_flutter(&m, 1.0));
        assert!(!matches!(found, Ok(Some(_))), "{chords:?}: {found:?}");
    }
    let strips = [1e-9, 1.0].map(|chord| Strip { chord, ..strip() }).to_vec();
    let found = model(strips, shapes(2, 2), &JONES).and_then(|m| lag_flutter(&m, 1.0));
    assert!(matches!(found, Err(Error::BadOption { .. })), "{found:?}");
}

/// The answers of all functions that take a model, without what they answer.
fn answers(model: &AeroelasticModel) -> Vec<(&'static str, Result<(), Error>)> {
    let (rho, speed) = (1.2, 30.0);
    let flow = Flow { rho, speed };
    let reference = ReferenceDimensions {
        area: 1.0,
        chord: 1.0,
        span: 1.0,
    };
    let q = Mat::zeros(model.n_modes(), 1);
    vec![
        ("check", model.check()),
        ("mass", model.mass(rho).map(drop)),
        ("static_stiffness", model.static_stiffness(flow).map(drop)),
        ("state_matrix", state_matrix(model, flow).map(drop)),
        (
            "compact_state_matrix",
            compact_state_matrix(model, flow).map(drop),
        ),
        ("quasi_steady", quasi_steady_state_matrix(model, flow).map(drop)),
        (
            "pi_matrices",
            pi_matrices(model, flow, &reference, &q, &q).map(drop),
        ),
        (
            "harmonic_operator",
            harmonic_operator(model, rho, C64::new(0.0, 5.0), speed).map(drop),
        ),
        ("divergence_speed", divergence_speed(model, rho).map(drop)),
        (
            "divergence_points",
            divergence_points(model, rho, Kernel::Theodorsen).map(drop),
        ),
        ("lag_flutter", lag_flutter(model, rho).map(drop)),
        ("exact_flutter", exact_flutter(model, rho).map(drop)),
        (
            "neutral_points",
            neutral_points(model, rho, Kernel::Theodorsen).map(drop),
        ),
        ("sweep", sweep(model, rho, &[speed], Method::StateSpace).map(drop)),
        ("sweep, p-k", sweep(model, rho, &[speed], Method::PK).map(drop)),
    ]
}

/// The fields of a model are public: one that was altered is refused by every function that takes it.
#[test]
fn regress_altered_models_are_refused() {
    type Alter = fn(&mut AeroelasticModel);
    let alterations: [Alter; 14] = [
        |m| m.structure.mass = Mat::identity(2, 2),
        |m| m.structure.damping = Mat::zeros(3, 2),
        |m| m.structure.stiffness = Mat::zeros(0, 0),
        |m| m.structure.mass[(1, 1)] = f64::NAN,
        |m| m.forces.eta_etadd_nc = Mat::zeros(2, 3),
        |m| m.forces.eta_etad_nc = Mat::zeros(3, 4),
        |m| m.forces.eta_etad_c = Mat::zeros(4, 4),
        |m| m.forces.eta_eta_nc = Mat::zeros(1, 1),
        |m| m.forces.eta_eta_c = Mat::zeros(3, 0),
        |m| m.forces.eta_lambda_c = Mat::zeros(3, 4),
        |m| m.downwash.w_eta = Mat::zeros(4, 3),
        |m| m.downwash.w_etad = Mat::zeros(5, 2),
        |m| m.strips.clear(),
        |m| m.strips.push(m.strips[0]),
    ];
    let sound = invented(0, 5, 3, 0.01);
    for (what, answer) in answers(&sound) {
        assert_eq!(answer, Ok(()), "{what}");
    }
    for (number, alter) in alterations.into_iter().enumerate() {
        let mut altered = sound.clone();
        alter(&mut altered);
        for (what, answer) in answers(&altered) {
            assert!(
                matches!(answer, Err(Error::Shape { .. } | Error::NotFinite { .. })),
                "alteration {number}, {what}: {answer:?}"
            );
        }
    }
    // Nothing at all fits together; what comes of it may be an error, but no panic.
    for (n, strips) in [(0, 0), (0, 2), (2, 0)] {
        let mut empty = sound.clone();
        let (square, lift, w) = (Mat::zeros(n, n), Mat::zeros(n, strips), Mat::zeros(strips, n));
        empty.structure = Structure {
            mass: Mat::identity(n, n),
            damping: square.clone(),
            stiffness: Mat::identity(n, n),
        };
        empty.strips.truncate(strips);
        empty.forces = GeneralizedForces {
            eta_etadd_nc: square.clone(),
            eta_etad_nc: square.clone(),
            eta_etad_c: square.clone(),
            eta_eta_nc: square.clone(),
            eta_eta_c: square,
            eta_lambda_c: lift,
        };
        empty.downwash = Downwash {
            w_eta: w.clone(),
            w_etad: w,
        };
        for (what, answer) in answers(&empty) {
            if !what.starts_with("sweep") && !what.ends_with("flutter") && what != "neutral_points" {
                assert_eq!(answer, Ok(()), "{n} modes, {strips} strips, {what}");
            }
        }
    }
}

/// Lags or strips without number would ask for more memory than there is.
#[test]
fn regress_orders_without_bound_are_refused() {
    let mut model = invented(0, 5, 3, 0.01);
    model.lags = vec![JONES[0]; 4000];
    for what in ["state_matrix", "compact_state_matrix", "sweep"] {
        let found = answers(&model).into_iter().find(|(name, _)| *name == what);
        assert!(
            matches!(
                found,
                Some((
                    _,
                    Err(Error::BadOption {
                        option: "the number of states",
                        ..
                    })
                ))
            ),
            "{what}: {found:?}"
        );
    }
}

#[test]
fn regress_shapes_of_two_sizes_do_not_panic() {
    let uneven = StripShapes {
        phi: Mat::zeros(3, 2),
        gamma: Mat::zeros(2, 1),
    };
    let found = uneven.at(&[strip(); 3], |s| s.x_ac);
    assert_eq!((found.nrows(), found.ncols()), (2, 1));
}
