//! Small aircraft with closed-form answers, shared by the tests.

use albatross_flight::aerodynamics::{Coefficient, Drag, RigidAerodynamics};
use albatross_flight::{
    Aircraft, ElasticPart, Engine, EquationsOfMotion, FlightPoint, ModelOptions, Quantity, Sensor,
    SensorPoint, Trim, atmosphere,
};
use albatross_numerics::Mat;
use albatross_strip::forces::generalized_forces;
use albatross_strip::kernels::{JONES, Lag};
use albatross_strip::quasi_steady::{ReferenceDimensions, StripLoads, rigid_to_elastic};
use albatross_strip::{AeroelasticModel, DihedralForm, Split, Strip, StripShapes, StripTheory, Structure};

pub(crate) const G: f64 = 9.80665;

/// A coefficient of the longitudinal motion.
pub(crate) fn longitudinal(zero: f64, alpha: f64, q_hat: f64, elevator: f64) -> Coefficient {
    Coefficient {
        zero,
        alpha,
        q_hat,
        controls: vec![elevator],
        ..Coefficient::default()
    }
}

/// A coefficient of the lateral motion, without control.
pub(crate) fn lateral(beta: f64, p_hat: f64, r_hat: f64) -> Coefficient {
    Coefficient {
        beta,
        p_hat,
        r_hat,
        controls: vec![0.0],
        ..Coefficient::default()
    }
}

/// A transport aircraft of 60 t without elastic part, control "elevator".
pub(crate) fn transport() -> Aircraft {
    Aircraft {
        mass: 60_000.0,
        inertia: [[1.2e6, 0.0, -4.0e4], [0.0, 3.0e6, 0.0], [-4.0e4, 0.0, 4.0e6]],
        gravity: G,
        reference: ReferenceDimensions {
            area: 120.0,
            chord: 4.0,
            span: 34.0,
        },
        controls: vec!["elevator".into()],
        rigid: RigidAerodynamics {
            lift: longitudinal(0.25, 5.5, 8.0, 0.4),
            drag: Drag::Polar { zero: 0.02, k: 0.045 },
            side: lateral(-0.8, 0.05, 0.3),
            roll: lateral(-0.15, -0.45, 0.12),
            pitch: longitudinal(0.05, -1.2, -22.0, -1.4),
            yaw: lateral(0.12, -0.03, -0.25),
        },
        engines: vec![Engine::through_cg()],
        elastic: None,
        sensors: vec![
            Sensor::at_cg("alpha", Quantity::Alpha),
            Sensor::at_cg("q", Quantity::PitchRate),
            Sensor::at_cg("theta", Quantity::PitchAngle),
            Sensor::at_cg("nz", Quantity::LoadFactor),
        ],
    }
}

/// An aircraft on which the air does nothing.
pub(crate) fn without_air() -> Aircraft {
    let mut aircraft = transport();
    let none = longitudinal(0.0, 0.0, 0.0, 0.0);
    aircraft.rigid = RigidAerodynamics {
        lift: none.clone(),
        drag: Drag::Polar { zero: 0.0, k: 0.0 },
        side: none.clone(),
        roll: none.clone(),
        pitch: none.clone(),
        yaw: none,
    };
    aircraft
}

/// 150 m/s at 5 km.
pub(crate) fn cruise() -> FlightPoint {
    FlightPoint {
        speed: 150.0,
        altitude: 5_000.0,
        path_angle_rad: 0.0,
        control: "elevator".into(),
    }
}

/// Strips of the two-mode aircraft: four on each wing, one on each half of the tail.
pub(crate) fn strips() -> Vec<Strip> {
    let strip = |y: f64, width: f64, chord: f64, x_ac: f64, x_lra: f64| Strip {
        y,
        z: 0.0,
        width,
        chord,
        x_ac,
        x_lra,
        cl_alpha: 5.0,
        dihedral_rad: 0.0,
    };
    let half = |side: f64| {
        let wing = (0..4).map(move |i| {
            let y = 2.0 + 4.0 * f64::from(i);
            strip(side * y, 4.0, 4.0 - 0.1 * y, 15.0 + 0.1 * y, 15.6 + 0.1 * y)
        });
        wing.chain(std::iter::once(strip(side * 3.0, 6.0, 2.5, 32.0, 32.3)))
    };
    half(1.0).chain(half(-1.0)).collect()
}

/// Longitudinal position of the centre of gravity of the two-mode aircraft, structural axes \[m\].
pub(crate) const X_CG: f64 = 15.9;

/// What changes between elastic aircraft.
pub(crate) struct Elasticity {
    pub(crate) shapes: StripShapes,
    pub(crate) omega_rad_s: Vec<f64>,
    pub(crate) damping: Vec<f64>,
    pub(crate) modal_mass: Vec<f64>,
    pub(crate) lags: Vec<Lag>,
    pub(crate) apparent_mass_factor: f64,
    pub(crate) split: Split,
}

/// Wing torsion (1 rad nose up over the wing) and antisymmetric wing bending (1 m at 14 m).
pub(crate) fn two_modes() -> Elasticity {
    let strips = strips();
    let on_wing = |s: &Strip| s.x_ac < 25.0;
    Elasticity {
        shapes: StripShapes::try_new(
            Mat::from_fn(strips.len(), 2, |j, k| {
                if k == 1 && on_wing(&strips[j]) {
                    strips[j].y / 14.0
                } else {
                    0.0
                }
            }),
            Mat::from_fn(strips.len(), 2, |j, k| {
                if k == 0 && on_wing(&strips[j]) { 1.0 } else { 0.0 }
            }),
        )
        .unwrap(),
        omega_rad_s: vec![40.0, 18.0],
        damping: vec![0.02, 0.01],
        modal_mass: vec![5_000.0, 3_000.0],
        lags: JONES.to_vec(),
        apparent_mass_factor: 1.0,
        split: Split::ApparentMass,
    }
}

/// Lift per strip in unit incidence and unit elevator (the tail alone turns), and at zero incidence.
pub(crate) fn strip_lift(strips: &[Strip]) -> [Vec<f64>; 3] {
    let tail = |s: &Strip| s.x_ac > 25.0;
    [
        strips
            .iter()
            .map(|s| s.cl_alpha * if tail(s) { 0.6 } else { 1.0 })
            .collect(),
        strips
            .iter()
            .map(|s| if tail(s) { 0.5 * s.cl_alpha } else { 0.0 })
            .collect(),
        strips.iter().map(|s| if tail(s) { 0.0 } else { 0.25 }).collect(),
    ]
}

/// The transport with an elastic part on [`strips`].
pub(crate) fn flexible(elasticity: &Elasticity) -> Aircraft {
    let mut aircraft = transport();
    let strips = strips();
    let reference = aircraft.reference;
    let n_modes = elasticity.omega_rad_s.len();
    let theory = StripTheory {
        apparent_mass_factor: elasticity.apparent_mass_factor,
        ..StripTheory::default()
    };
    let [alpha, elevator, zero] = strip_lift(&strips);
    let loads = |lift: Mat<f64>| {
        rigid_to_elastic(
            &strips,
            &elasticity.shapes,
            &StripLoads::from_lift(lift),
            &reference,
        )
        .unwrap()
    };
    let q_x = loads(Mat::from_fn(strips.len(), 5, |j, x| {
        let s = &strips[j];
        match x {
            0 => alpha[j],
            2 => s.cl_alpha * 2.0 * s.y / reference.span,
            3 => s.cl_alpha * 2.0 * (s.x_three_quarter() - X_CG) / reference.chord,
            _ => 0.0,
        }
    }));
    let q_0 = loads(Mat::from_fn(strips.len(), 1, |j, _| zero[j]));
    let rigid_shapes = StripShapes::rigid_body(&strips, DihedralForm::Paper, X_CG, 0.0);
    let structure = Structure::modal(
        &elasticity.modal_mass,
        &elasticity.omega_rad_s,
        &elasticity.damping,
    )
    .unwrap();
    aircraft.elastic = Some(ElasticPart {
        rigid_rows: generalized_forces(
            &strips,
            &rigid_shapes,
            &elasticity.shapes,
            &theory,
            elasticity.split,
        )
        .unwrap(),
        q_x,
        q_u: loads(Mat::from_fn(strips.len(), 1, |j, _| elevator[j])),
        q_0: (0..n_modes).map(|k| q_0[(k, 0)]).collect(),
        control_incidence: Mat::from_fn(strips.len(), 1, |j, _| elevator[j] / strips[j].cl_alpha),
        model: AeroelasticModel::try_new(
            structure,
            strips,
            elasticity.shapes.clone(),
            &theory,
            elasticity.split,
            &elasticity.lags,
        )
        .unwrap(),
    });
    aircraft.sensors.push(Sensor {
        name: "az_nose".into(),
        quantity: Quantity::VerticalAcceleration,
        point: Some(SensorPoint {
            position: [12.0, 0.0, -0.5],
            translation_up: (0..n_modes).map(|k| 0.1 * (k as f64 + 1.0)).collect(),
            rotation_nose_up: (0..n_modes).map(|k| 0.02 * (k as f64 + 1.0)).collect(),
        }),
    });
    aircraft
}

/// A flight state as a trim from which a simulation can start.
pub(crate) fn start(equations: &EquationsOfMotion, state: Vec<f64>, input: Vec<f64>) -> Trim {
    let altitude = state[equations.layout().altitude()];
    let density = atmosphere::standard(altitude).density;
    let speed = state[..3].iter().map(|v| v * v).sum::<f64>().sqrt();
    Trim {
        alpha_rad: (state[2] / state[0]).atan(),
        controls_rad: input[..input.len() - 1].to_vec(),
        thrust: input[input.len() - 1],
        eta: state[equations.layout().eta()].to_vec(),
        dynamic_pressure: 0.5 * density * speed * speed,
        density,
        state,
        input,
        residual: f64::NAN,
        iterations: 0,
    }
}

/// All combinations of fidelity, control aerodynamics, reference shape and attitude.
pub(crate) fn all_options() -> Vec<ModelOptions> {
    use albatross_flight::{Attitude, ControlAerodynamics, Fidelity, ShapeReference};
    let mut all = Vec::new();
    for fidelity in [Fidelity::Unsteady, Fidelity::QuasiSteady, Fidelity::Rigid] {
        for control_aerodynamics in [ControlAerodynamics::QuasiSteady, ControlAerodynamics::Lagged] {
            for shape_reference in [ShapeReference::Jig, ShapeReference::Trimmed] {
                for attitude in [Attitude::Euler, Attitude::Quaternion] {
                    let position = attitude == Attitude::Euler;
                    all.push(ModelOptions {
                        fidelity,
                        control_aerodynamics,
                        shape_reference,
                        attitude,
                        position,
                    });
                }
            }
        }
    }
    all
}

/// Index of the state of that name.
pub(crate) fn state(equations: &EquationsOfMotion, name: &str) -> usize {
    equations
        .layout()
        .signals()
        .iter()
        .position(|s| s.name == name)
        .unwrap()
}
