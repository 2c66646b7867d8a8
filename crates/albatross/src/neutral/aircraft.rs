//! The neutral aircraft: a whole flexible aircraft in one JSON object.

use super::{
    NeutralError, StripArrays, complex, generalized_forces, length, parse, rows, shapes, table, unwrap_key,
};
use albatross_flight::aerodynamics::{Coefficient, Drag, RigidAerodynamics};
use albatross_flight::signal::{Edges, Signal};
use albatross_flight::simulate::{Manoeuvre, Method, simulate};
use albatross_flight::{
    Aircraft, ElasticPart, Engine, EquationsOfMotion, Fidelity, FlightPoint, ModelOptions, Quantity, Sensor,
    SensorPoint, ShapeReference, Trim, atmosphere, linearize, trim,
};
use albatross_lti::StateSpace;
use albatross_numerics::{Mat, eigen};
use albatross_strip::elastic::pi_matrices;
use albatross_strip::forces::generalized_forces as strip_forces;
use albatross_strip::kernels::JONES;
use albatross_strip::quasi_steady::{ReferenceDimensions, StripLoads, rigid_to_elastic};
use albatross_strip::{AeroelasticModel, DihedralForm, Flow, Split, StripShapes, StripTheory, Structure};
use serde::Deserialize;
use serde_json::{Map, Value, json};

/// Input layout.
#[derive(Debug, Clone, Deserialize)]
#[allow(non_snake_case, missing_docs)]
pub struct NeutralAircraft {
    pub mass: f64,
    pub J: [[f64; 3]; 3],
    pub S: f64,
    pub cbar: f64,
    pub span: f64,
    pub x_cg: f64,
    pub derivatives: Derivatives,
    pub V: f64,
    pub altitude: f64,
    pub g: f64,
    pub strips: Strips,
    pub modes: Modes,
    pub sensors: Vec<NeutralSensor>,
    #[serde(default)]
    pub bode_omega: Option<Vec<f64>>,
    #[serde(default)]
    pub runs: Option<Vec<RunRequest>>,
}

/// Rigid derivatives, per rad; lateral ones in body axes.
#[derive(Debug, Clone, Deserialize)]
#[allow(non_snake_case, missing_docs)]
pub struct Derivatives {
    pub CL0: f64,
    pub CLa: f64,
    pub CLq: f64,
    pub CLde: f64,
    pub Cm0: f64,
    pub Cma: f64,
    pub Cmq: f64,
    pub Cmde: f64,
    pub CD0: f64,
    pub k: f64,
    pub CYb: f64,
    pub CYp: f64,
    pub CYr: f64,
    pub Clb: f64,
    pub Clp: f64,
    pub Clr: f64,
    pub Cnb: f64,
    pub Cnp: f64,
    pub Cnr: f64,
}

/// Strips, one value each.
#[derive(Debug, Clone, Deserialize)]
#[allow(non_snake_case, missing_docs)]
pub struct Strips {
    pub y: Vec<f64>,
    pub dy: Vec<f64>,
    pub c: Vec<f64>,
    pub x_ac: Vec<f64>,
    pub x_lra: Vec<f64>,
    pub cl_alpha: Vec<f64>,
    pub cl0: Vec<f64>,
    pub dcl_dX_alpha_beta_p_q_r_hat: Vec<Vec<f64>>,
    pub dcl_dde: Vec<f64>,
}

/// Modes, shapes strips x modes.
#[derive(Debug, Clone, Deserialize)]
#[allow(missing_docs)]
pub struct Modes {
    pub omega: Vec<f64>,
    pub mu: Vec<f64>,
    pub xi: Vec<f64>,
    pub phi: Vec<Vec<f64>>,
    pub gamma: Vec<Vec<f64>>,
}

/// An accelerometer.
#[derive(Debug, Clone, Deserialize)]
#[allow(missing_docs)]
pub struct NeutralSensor {
    pub name: String,
    pub x: f64,
    pub y: f64,
    pub phi: Vec<f64>,
}

/// A doublet to simulate.
#[derive(Debug, Clone, Deserialize)]
#[allow(missing_docs)]
pub struct RunRequest {
    pub frequency_hz: f64,
    pub dt: f64,
    pub t_end: f64,
    pub t0: f64,
    pub amplitude_rad: f64,
}

/// Angular frequencies of the frequency response where the file names none \[rad/s\].
const DEFAULT_OMEGA: [f64; 8] = [0.05, 0.5, 1.75, 6.0, 15.0, 30.0, 60.0, 90.0];
/// Interval of the samples of time histories \[s\].
const SAMPLE_INTERVAL: f64 = 0.02;
const ELEVATOR: &str = "de";

/// Reads an aircraft from JSON text: the layout itself, or an object that holds it under `inputs`.
///
/// # Errors
/// [`NeutralError::Json`] with the place.
pub fn read(text: &str, file: &str) -> Result<NeutralAircraft, NeutralError> {
    let document = parse(text, file)?;
    serde_json::from_value(unwrap_key(document, "inputs")).map_err(|e| NeutralError::Json {
        file: file.to_owned(),
        line: 1,
        column: 1,
        message: e.to_string(),
    })
}

impl NeutralAircraft {
    fn reference(&self) -> ReferenceDimensions {
        ReferenceDimensions {
            area: self.S,
            chord: self.cbar,
            span: self.span,
        }
    }

    fn rigid(&self) -> RigidAerodynamics {
        let d = &self.derivatives;
        let longitudinal = |zero, alpha, q_hat, elevator| Coefficient {
            zero,
            alpha,
            q_hat,
            controls: vec![elevator],
            ..Coefficient::default()
        };
        let lateral = |beta, p_hat, r_hat| Coefficient {
            beta,
            p_hat,
            r_hat,
            controls: vec![0.0],
            ..Coefficient::default()
        };
        RigidAerodynamics {
            lift: longitudinal(d.CL0, d.CLa, d.CLq, d.CLde),
            drag: Drag::Polar { zero: d.CD0, k: d.k },
            pitch: longitudinal(d.Cm0, d.Cma, d.Cmq, d.Cmde),
            side: lateral(d.CYb, d.CYp, d.CYr),
            roll: lateral(d.Clb, d.Clp, d.Clr),
            yaw: lateral(d.Cnb, d.Cnp, d.Cnr),
        }
    }

    /// The aircraft as the flight crate takes it.
    ///
    /// # Errors
    /// [`NeutralError::Length`] for arrays that do not fit, [`NeutralError::Strip`] for unusable values.
    pub fn aircraft(&self, file: &str) -> Result<Aircraft, NeutralError> {
        let elastic = self.elastic(file)?;
        let n_modes = elastic.model.n_modes();
        let mut sensors = vec![
            Sensor::at_cg("alpha", Quantity::Alpha),
            Sensor::at_cg("q", Quantity::PitchRate),
            Sensor::at_cg("theta", Quantity::PitchAngle),
            Sensor::at_cg("nz", Quantity::LoadFactor),
        ];
        for sensor in &self.sensors {
            length(sensor.phi.len(), "sensors.phi", n_modes, file)?;
            sensors.push(Sensor {
                name: format!("az_{}", sensor.name.replace(' ', "_")),
                quantity: Quantity::VerticalAcceleration,
                point: Some(SensorPoint {
                    position: [self.x_cg - sensor.x, sensor.y, 0.0],
                    translation_up: sensor.phi.clone(),
                    rotation_nose_up: vec![0.0; n_modes],
                }),
            });
        }
        Ok(Aircraft {
            mass: self.mass,
            inertia: self.J,
            gravity: self.g,
            reference: self.reference(),
            controls: vec![ELEVATOR.to_owned()],
            rigid: self.rigid(),
            engines: vec![Engine::through_cg()],
            elastic: Some(elastic),
            sensors,
        })
    }

    fn elastic(&self, file: &str) -> Result<ElasticPart, NeutralError> {
        let s = &self.strips;
        let strips = StripArrays {
            y: &s.y,
            width: &s.dy,
            chord: &s.c,
            x_ac: &s.x_ac,
            x_lra: &s.x_lra,
            cl_alpha: &s.cl_alpha,
        }
        .strips(file)?;
        let n = strips.len();
        length(s.cl0.len(), "strips.cl0", n, file)?;
        length(s.dcl_dde.len(), "strips.dcl_dde", n, file)?;
        let m = &self.modes;
        length(m.omega.len(), "modes.omega", m.mu.len(), file)?;
        length(m.xi.len(), "modes.xi", m.mu.len(), file)?;
        let by_variable = table(
            &s.dcl_dX_alpha_beta_p_q_r_hat,
            "strips.dcl_dX_alpha_beta_p_q_r_hat",
            (n, 5),
            file,
        )?;
        let shapes = shapes(&m.phi, &m.gamma, n, m.mu.len(), file)?;
        let strip_error = |source| NeutralError::Strip {
            file: file.to_owned(),
            source,
        };
        let column = |values: &[f64]| Mat::from_fn(n, 1, |j, _| values.get(j).copied().unwrap_or(f64::NAN));
        let coupling = |lift: Mat<f64>| {
            rigid_to_elastic(&strips, &shapes, &StripLoads::from_lift(lift), &self.reference())
                .map_err(strip_error)
        };
        let q_0 = coupling(column(&s.cl0))?;
        let (q_x, q_u) = (coupling(by_variable)?, coupling(column(&s.dcl_dde))?);
        let theory = StripTheory::default();
        let rigid_shapes = StripShapes::rigid_body(&strips, DihedralForm::Paper, self.x_cg, 0.0);
        let rigid_rows = strip_forces(&strips, &rigid_shapes, &shapes, &theory, Split::ApparentMass)
            .map_err(strip_error)?;
        // A strip without lift slope has no incidence worth of a control.
        let worth = |(lift, slope): (&f64, &f64)| if *slope == 0.0 { 0.0 } else { lift / slope };
        let worth: Vec<f64> = s.dcl_dde.iter().zip(&s.cl_alpha).map(worth).collect();
        let control_incidence = column(&worth);
        let structure = Structure::modal(&m.mu, &m.omega, &m.xi).map_err(strip_error)?;
        let model = AeroelasticModel::try_new(
            structure,
            strips.clone(),
            shapes,
            &theory,
            Split::ApparentMass,
            &JONES,
        )
        .map_err(strip_error)?;
        let q_0 = (0..q_0.nrows()).map(|k| q_0[(k, 0)]).collect();
        Ok(ElasticPart {
            model,
            rigid_rows,
            q_x,
            q_u,
            q_0,
            control_incidence,
        })
    }
}

/// One fidelity of the model, trimmed.
struct Trimmed {
    equations: EquationsOfMotion,
    trim: Trim,
    system: StateSpace,
}

/// Everything the layout promises of an aircraft, as JSON.
///
/// # Errors
/// As [`NeutralAircraft::aircraft`], and what trim, linearisation and simulation return.
pub fn analyse(neutral: &NeutralAircraft, file: &str) -> Result<Value, NeutralError> {
    let flight = |source| NeutralError::Flight {
        file: file.to_owned(),
        source,
    };
    let aircraft = neutral.aircraft(file)?;
    let point = FlightPoint {
        speed: neutral.V,
        altitude: neutral.altitude,
        path_angle_rad: 0.0,
        control: ELEVATOR.into(),
    };
    let at = |fidelity: Fidelity| -> Result<Trimmed, NeutralError> {
        let options = ModelOptions {
            fidelity,
            shape_reference: ShapeReference::Jig,
            ..ModelOptions::default()
        };
        let (equations, trim) = trim(&aircraft, options, &point).map_err(flight)?;
        let system = linearize(&equations, &trim.state, &trim.input).map_err(flight)?;
        Ok(Trimmed {
            equations,
            trim,
            system,
        })
    };
    let (unsteady, quasi_steady, rigid) = (
        at(Fidelity::Unsteady)?,
        at(Fidelity::QuasiSteady)?,
        at(Fidelity::Rigid)?,
    );

    let mut out = Map::new();
    if let Some(part) = &aircraft.elastic {
        let density = atmosphere::standard(neutral.altitude).density;
        let flow = Flow {
            rho: density,
            speed: neutral.V,
        };
        let pi =
            pi_matrices(&part.model, flow, &neutral.reference(), &part.q_x, &part.q_u).map_err(|source| {
                NeutralError::Strip {
                    file: file.to_owned(),
                    source,
                }
            })?;
        out.insert(
            "Q".into(),
            generalized_forces(&part.model.forces, &part.model.downwash),
        );
        out.insert("FM_rows_Fz_Mx_My".into(), force_rows(part));
        out.insert("QX".into(), rows(&part.q_x));
        out.insert("Qu".into(), rows(&part.q_u));
        out.insert("Q0".into(), json!(part.q_0));
        out.insert(
            "Pi".into(),
            json!({ "Pi1": rows(&pi.pi1), "Pi2": rows(&pi.pi2), "Pi3": rows(&pi.pi3), "Pi4": rows(&pi.pi4),
                    "Pi5": rows(&pi.pi5) }),
        );
    }
    out.insert("trim".into(), trim_block(&unsteady.trim, true));
    out.insert("trim_quasi_steady".into(), trim_block(&quasi_steady.trim, true));
    out.insert("trim_rigid".into(), trim_block(&rigid.trim, false));
    out.insert(
        "n_states".into(),
        json!({ "unsteady": unsteady.system.a.nrows(), "quasi_steady": quasi_steady.system.a.nrows(),
                "rigid": rigid.system.a.nrows() }),
    );
    out.insert(
        "state_order".into(),
        json!("u v w p q r phi theta psi h | eta | etadot | lam1 | lam2"),
    );
    for (key, model) in [
        ("eig_unsteady", &unsteady),
        ("eig_quasi_steady", &quasi_steady),
        ("eig_rigid", &rigid),
    ] {
        let values =
            eigen::eigenvalues(model.system.a.as_ref()).map_err(|source| NeutralError::Numerics {
                file: file.to_owned(),
                source,
            })?;
        out.insert(key.into(), complex(&values));
    }
    out.insert("bode".into(), bode(neutral, &unsteady.system, file)?);
    if let Some(requests) = &neutral.runs {
        let mut runs = Map::new();
        for request in requests {
            runs.insert(
                format!("{:.1}", request.frequency_hz),
                run(&unsteady, request).map_err(flight)?,
            );
        }
        out.insert("runs".into(), Value::Object(runs));
    }
    Ok(Value::Object(out))
}

/// Rows F_z, M_x, M_y of the six body forces.
fn force_rows(part: &ElasticPart) -> Value {
    let pick = |a: &Mat<f64>| rows(&a.submatrix(2, 0, 3, a.ncols()).to_owned());
    let q = &part.rigid_rows;
    json!({
        "etadd_NC": pick(&q.eta_etadd_nc),
        "etad_NC": pick(&q.eta_etad_nc),
        "etad_C": pick(&q.eta_etad_c),
        "eta_NC": pick(&q.eta_eta_nc),
        "eta_C": pick(&q.eta_eta_c),
        "lambda_C": pick(&q.eta_lambda_c),
    })
}

fn trim_block(trim: &Trim, elastic: bool) -> Value {
    let mut block = json!({
        "alpha": trim.alpha_rad,
        "de": trim.controls_rad.first(),
        "thrust": trim.thrust,
    });
    if elastic && let Some(map) = block.as_object_mut() {
        map.insert("eta".into(), json!(trim.eta));
    }
    block
}

fn bode(neutral: &NeutralAircraft, system: &StateSpace, file: &str) -> Result<Value, NeutralError> {
    let omega = neutral
        .bode_omega
        .clone()
        .unwrap_or_else(|| DEFAULT_OMEGA.to_vec());
    let outputs: Vec<&str> = system.outputs.iter().map(|o| o.name.as_str()).collect();
    let response = system
        .select(&[ELEVATOR], &outputs)
        .and_then(|s| albatross_lti::frequency_response(&s, &omega))
        .map_err(|source| NeutralError::Lti {
            file: file.to_owned(),
            source,
        })?;
    let part = |f: fn(&albatross_numerics::C64) -> f64| -> Vec<Vec<f64>> {
        response
            .values
            .iter()
            .map(|h| (0..outputs.len()).map(|output| f(&h[(output, 0)])).collect())
            .collect()
    };
    Ok(json!({
        "omega": omega,
        "input": ELEVATOR,
        "response": { "re": part(|v| v.re), "im": part(|v| v.im) },
    }))
}

fn run(model: &Trimmed, request: &RunRequest) -> Result<Value, albatross_flight::Error> {
    let every = (SAMPLE_INTERVAL / request.dt).round().max(1.0);
    let doublet = Signal::Doublet {
        amplitude: request.amplitude_rad,
        start: request.t0,
        period: 1.0 / request.frequency_hz,
        edges: Edges::Square,
    };
    let manoeuvre = Manoeuvre {
        dt: request.dt,
        end: request.t_end,
        output_every: if every.is_finite() { every as usize } else { 1 },
        method: Method::Rk4,
        inputs: vec![(0, doublet)],
    };
    let history = simulate(&model.equations, &model.trim, &manoeuvre)?;
    let n_inputs = model.equations.n_inputs();
    let samples: Vec<Vec<f64>> = (0..history.time.len())
        .map(|i| {
            history
                .series
                .iter()
                .skip(n_inputs)
                .filter_map(|s| s.get(i).copied())
                .collect()
        })
        .collect();
    Ok(json!({
        "dt": request.dt,
        "t_end": request.t_end,
        "t0": request.t0,
        "amplitude_rad": request.amplitude_rad,
        "shape": "+amp for T/2 then -amp for T/2, rectangular",
        "t": history.time,
        "nonlinear": samples,
    }))
}
