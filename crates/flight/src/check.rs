//! What an aircraft must satisfy before its equations can be assembled: sizes that fit, numbers that are finite,
//! names that tell outputs apart.

use crate::Error;
use crate::aerodynamics::{Coefficient, Drag};
use crate::aircraft::{Aircraft, ElasticPart, Engine};
use crate::equations::ensure_size;
use crate::sensor::Sensor;
use albatross_numerics::Mat;
use albatross_strip::GeneralizedForces;
use nalgebra::Matrix3;

/// Largest difference of two opposite products of inertia, and of a direction's length from one.
const ROUNDING_OF_INPUT: f64 = 1e-6;

impl Aircraft {
    /// Checks what the equations divide by, the sizes of all arrays, and that all numbers are finite.
    ///
    /// # Errors
    /// [`Error::BadQuantity`] names the quantity, [`Error::Sizes`] the array that does not fit,
    /// [`Error::DuplicateName`] a name that two controls or two sensors have.
    pub fn check(&self) -> Result<(), Error> {
        for (quantity, value) in [
            ("mass", self.mass),
            ("gravity", self.gravity),
            ("reference area", self.reference.area),
            ("reference chord", self.reference.chord),
            ("reference span", self.reference.span),
        ] {
            ensure_positive(quantity, value)?;
        }
        check_inertia(&self.inertia)?;
        self.check_names()?;
        self.check_coefficients()?;
        let n_modes = self.elastic.as_ref().map_or(0, |e| e.model.n_modes());
        if let Some(elastic) = &self.elastic {
            check_elastic(elastic, self.controls.len())?;
        }
        self.engines.iter().try_for_each(|e| check_engine(e, n_modes))?;
        self.sensors.iter().try_for_each(|s| check_sensor(s, n_modes))
    }

    /// A history holds controls, thrust and sensors side by side: their names must differ.
    fn check_names(&self) -> Result<(), Error> {
        let sensors = self.sensors.iter().map(|s| &s.name);
        let mut names: Vec<&str> = self.controls.iter().chain(sensors).map(String::as_str).collect();
        names.push(crate::THRUST);
        names.sort_unstable();
        match names.iter().zip(names.iter().skip(1)).find(|(a, b)| a == b) {
            Some((name, _)) => Err(Error::DuplicateName {
                name: (*name).to_owned(),
            }),
            None => Ok(()),
        }
    }

    fn check_coefficients(&self) -> Result<(), Error> {
        let rigid = &self.rigid;
        let mut coefficients = vec![
            ("lift coefficient", &rigid.lift),
            ("side-force coefficient", &rigid.side),
            ("rolling-moment coefficient", &rigid.roll),
            ("pitching-moment coefficient", &rigid.pitch),
            ("yawing-moment coefficient", &rigid.yaw),
        ];
        match &rigid.drag {
            Drag::Linear(drag) => coefficients.push(("drag coefficient", drag)),
            Drag::Polar { zero, k } => {
                ensure_finite("drag coefficient at zero lift", &[*zero])?;
                ensure_finite("induced-drag factor", &[*k])?;
            }
        }
        for (what, coefficient) in coefficients {
            let Coefficient {
                zero,
                alpha,
                beta,
                p_hat,
                q_hat,
                r_hat,
                controls,
            } = coefficient;
            ensure_size(what, controls.len(), self.controls.len())?;
            ensure_finite(what, &[*zero, *alpha, *beta, *p_hat, *q_hat, *r_hat])?;
            ensure_finite(what, controls)?;
        }
        Ok(())
    }
}

fn check_inertia(inertia: &[[f64; 3]; 3]) -> Result<(), Error> {
    let refuse = |quantity, value, expected| {
        Err(Error::BadQuantity {
            quantity,
            value,
            expected,
        })
    };
    ensure_finite("inertia", inertia.as_flattened())?;
    let tensor = Matrix3::from_fn(|i, j| inertia[i][j]);
    let skew = (tensor - tensor.transpose()).amax();
    if skew > ROUNDING_OF_INPUT * tensor.amax() {
        return refuse(
            "difference of opposite products of inertia",
            skew,
            "zero: the tensor is symmetric, with minus the products of inertia off its diagonal",
        );
    }
    if tensor.cholesky().is_none() {
        let least = tensor.symmetric_eigenvalues().min();
        return refuse("least principal moment of inertia", least, "a positive number");
    }
    Ok(())
}

fn check_engine(engine: &Engine, n_modes: usize) -> Result<(), Error> {
    ensure_finite("engine's share", &[engine.share])?;
    ensure_finite("engine's position", &engine.position)?;
    ensure_finite("engine's direction", &engine.direction)?;
    ensure_finite("engine's modal work", &engine.modal_work)?;
    let length = engine.direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    if (length - 1.0).abs() > ROUNDING_OF_INPUT {
        return Err(Error::BadQuantity {
            quantity: "length of the engine's direction",
            value: length,
            expected: "1: a unit vector in body axes",
        });
    }
    if engine.modal_work.is_empty() {
        return Ok(());
    }
    ensure_size("engine's modal work (modes)", engine.modal_work.len(), n_modes)
}

fn check_sensor(sensor: &Sensor, n_modes: usize) -> Result<(), Error> {
    let Some(point) = &sensor.point else { return Ok(()) };
    ensure_finite("sensor's position", &point.position)?;
    for shape in [&point.translation_up, &point.rotation_nose_up] {
        ensure_size("sensor's mode shape (modes)", shape.len(), n_modes)?;
        ensure_finite("sensor's mode shape", shape)?;
    }
    Ok(())
}

fn check_elastic(part: &ElasticPart, n_controls: usize) -> Result<(), Error> {
    let (model, structure) = (&part.model, &part.model.structure);
    let (n, n_strips) = (model.n_modes(), model.strips.len());
    for (what, matrix, rows, columns) in [
        ("structural mass (modes x modes)", &structure.mass, n, n),
        ("structural damping (modes x modes)", &structure.damping, n, n),
        ("structural stiffness (modes x modes)", &structure.stiffness, n, n),
        (
            "downwash of eta (strips x modes)",
            &model.downwash.w_eta,
            n_strips,
            n,
        ),
        (
            "downwash of etad (strips x modes)",
            &model.downwash.w_etad,
            n_strips,
            n,
        ),
        ("q_x (modes x 5 variables)", &part.q_x, n, 5),
        ("q_u (modes x controls)", &part.q_u, n, n_controls),
        (
            "control_incidence (strips x controls)",
            &part.control_incidence,
            n_strips,
            n_controls,
        ),
    ] {
        ensure_matrix(what, matrix, rows, columns)?;
    }
    ensure_forces("generalised forces on the modes", &model.forces, n, n, n_strips)?;
    ensure_forces("rigid_rows (6 x modes)", &part.rigid_rows, 6, n, n_strips)?;
    ensure_size("q_0 (modes)", part.q_0.len(), n)?;
    ensure_finite("q_0", &part.q_0)?;
    for (index, strip) in model.strips.iter().enumerate() {
        strip.check(index)?;
    }
    model
        .lags
        .iter()
        .try_for_each(|lag| ensure_finite("rate or gain of a lag", &[lag.rate, lag.gain]))
}

fn ensure_forces(
    what: &'static str,
    forces: &GeneralizedForces,
    rows: usize,
    n_modes: usize,
    n_strips: usize,
) -> Result<(), Error> {
    for matrix in [
        &forces.eta_etadd_nc,
        &forces.eta_etad_nc,
        &forces.eta_etad_c,
        &forces.eta_eta_nc,
        &forces.eta_eta_c,
    ] {
        ensure_matrix(what, matrix, rows, n_modes)?;
    }
    ensure_matrix(what, &forces.eta_lambda_c, rows, n_strips)
}

fn ensure_matrix(what: &'static str, matrix: &Mat<f64>, rows: usize, columns: usize) -> Result<(), Error> {
    ensure_size(what, matrix.nrows(), rows)?;
    ensure_size(what, matrix.ncols(), columns)?;
    matrix
        .col_iter()
        .flat_map(|column| column.iter())
        .try_for_each(|value| ensure_finite(what, &[*value]))
}

fn ensure_positive(quantity: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(Error::BadQuantity {
        quantity,
        value,
        expected: "a positive number",
    })
}

fn ensure_finite(quantity: &'static str, values: &[f64]) -> Result<(), Error> {
    match values.iter().find(|v| !v.is_finite()) {
        Some(&value) => Err(Error::BadQuantity {
            quantity,
            value,
            expected: "a finite number",
        }),
        None => Ok(()),
    }
}
