//! The neutral wing: strips and modes of a clamped wing.

use super::{NeutralError, StripArrays, complex, generalized_forces, length, parse, shapes, unwrap_key};
use albatross_numerics::{C64, eigen};
use albatross_strip::elastic::state_matrix;
use albatross_strip::flutter::{self, Flutter};
use albatross_strip::kernels::JONES;
use albatross_strip::{AeroelasticModel, Flow, Split, StripTheory, Structure};
use serde::Deserialize;
use serde_json::{Value, json};

/// Input layout.
#[derive(Debug, Clone, Deserialize)]
pub struct Wing {
    /// Strip positions \[m\].
    pub y: Vec<f64>,
    /// Strip widths \[m\].
    pub dy: Vec<f64>,
    /// Chords \[m\].
    pub c: Vec<f64>,
    /// Aerodynamic centres \[m\].
    pub x_ac: Vec<f64>,
    /// Load reference axis \[m\].
    pub x_lra: Vec<f64>,
    /// Lift slopes \[1/rad\].
    pub cl_alpha: Vec<f64>,
    /// Displacement, strips x modes, up.
    pub phi: Vec<Vec<f64>>,
    /// Rotation, strips x modes, nose up.
    pub gamma: Vec<Vec<f64>>,
    /// Modal masses.
    pub mu: Vec<f64>,
    /// Frequencies \[rad/s\].
    pub omega: Vec<f64>,
    /// Damping ratios.
    pub xi: Vec<f64>,
    /// Density \[kg/m³\].
    pub rho: f64,
    /// Speeds at which eigenvalues are wanted \[m/s\].
    #[serde(default)]
    pub speeds: Vec<f64>,
}

/// Reads a wing from JSON text: the layout itself, or an object that holds it under `neutral_case`.
///
/// # Errors
/// [`NeutralError::Json`] with the place.
pub fn read(text: &str, file: &str) -> Result<Wing, NeutralError> {
    let document = parse(text, file)?;
    let mut case = unwrap_key(document.clone(), "neutral_case");
    // A wing file may keep its density among the inputs that made it.
    if let (Value::Object(case), Some(rho)) = (&mut case, document.pointer("/inputs/rho"))
        && !case.contains_key("rho")
    {
        case.insert("rho".into(), rho.clone());
    }
    serde_json::from_value(case).map_err(|e| NeutralError::Json {
        file: file.to_owned(),
        line: 1,
        column: 1,
        message: e.to_string(),
    })
}

/// The aeroelastic model of a wing.
///
/// # Errors
/// [`NeutralError::Length`] for arrays that do not fit, [`NeutralError::Strip`] for unusable values.
pub fn model(wing: &Wing, file: &str) -> Result<AeroelasticModel, NeutralError> {
    let strips = StripArrays {
        y: &wing.y,
        width: &wing.dy,
        chord: &wing.c,
        x_ac: &wing.x_ac,
        x_lra: &wing.x_lra,
        cl_alpha: &wing.cl_alpha,
    }
    .strips(file)?;
    length(wing.omega.len(), "omega", wing.mu.len(), file)?;
    length(wing.xi.len(), "xi", wing.mu.len(), file)?;
    let shapes = shapes(&wing.phi, &wing.gamma, strips.len(), wing.mu.len(), file)?;
    let strip = |source| NeutralError::Strip {
        file: file.to_owned(),
        source,
    };
    let structure = Structure::modal(&wing.mu, &wing.omega, &wing.xi).map_err(strip)?;
    AeroelasticModel::try_new(
        structure,
        strips,
        shapes,
        &StripTheory::default(),
        Split::ApparentMass,
        &JONES,
    )
    .map_err(strip)
}

/// Everything the layout promises of a wing, as JSON.
///
/// # Errors
/// As [`model`], and what the flutter searches return.
pub fn analyse(wing: &Wing, file: &str) -> Result<Value, NeutralError> {
    if !(wing.rho.is_finite() && wing.rho >= 0.0) {
        return Err(NeutralError::Value {
            file: file.to_owned(),
            key: "rho".to_owned(),
            value: wing.rho,
            expected: "a density of zero or more",
        });
    }
    let model = model(wing, file)?;
    let strip = |source| NeutralError::Strip {
        file: file.to_owned(),
        source,
    };
    let jones = flutter::lag_flutter(&model, wing.rho).map_err(strip)?;
    let exact = flutter::exact_flutter(&model, wing.rho).map_err(strip)?;
    let divergence = flutter::divergence_speed(&model, wing.rho).map_err(strip)?;
    let eig = wing
        .speeds
        .iter()
        .map(|&speed| {
            let values = structural_eigenvalues(&model, wing.rho, speed).map_err(strip)?;
            Ok(json!({ "V": speed, "values": complex(&values) }))
        })
        .collect::<Result<Vec<_>, NeutralError>>()?;
    Ok(json!({
        "Q": generalized_forces(&model.forces, &model.downwash),
        "jones": neutral_point(jones),
        "exact": neutral_point(exact),
        "divergence_V": divergence,
        "eig": eig,
    }))
}

fn neutral_point(flutter: Option<Flutter>) -> Value {
    json!({ "V": flutter.map(|f| f.speed), "omega": flutter.map(|f| f.omega_rad_s) })
}

/// The `2 n_modes` eigenvalues of largest modulus, by modulus ascending, negative imaginary part first.
fn structural_eigenvalues(
    model: &AeroelasticModel,
    rho: f64,
    speed: f64,
) -> Result<Vec<C64>, albatross_strip::Error> {
    let a = state_matrix(model, Flow { rho, speed })?;
    let values = eigen::eigenvalues(a.as_ref())?;
    let surplus = values.len().saturating_sub(2 * model.n_modes());
    Ok(values.into_iter().skip(surplus).collect())
}
