//! The model of one variant of a case: basis, strips, aircraft, trim.

use crate::Error;
use crate::case::{Damping, SensorCase, ThrustLine, VariantCase, grid_list};
use crate::controls::control_loads;
use crate::inputs::{Inputs, mass_that_flies};
use crate::strips::{StripSet, strip_set};
use albatross_flight::derivatives::{AvlOptions, from_avl};
use albatross_flight::{
    Aircraft, ElasticPart, Engine, EquationsOfMotion, FlightPoint, ModelOptions, Sensor, SensorPoint, Trim,
    atmosphere, trim,
};
use albatross_modal::{Component, MassProperties, ModalBasis};
use albatross_numerics::{Mat, solve};
use albatross_strip::forces::{generalized_forces, generalized_forces_between};
use albatross_strip::kernels::JONES;
use albatross_strip::quasi_steady::{
    AnalyticLift, ReferenceDimensions, StripLoads, analytic_lift, rigid_to_elastic,
};
use albatross_strip::{AeroelasticModel, StripShapes, StripTheory, Structure};

/// Mach number beyond which shocks govern: neither Prandtl-Glauert nor the lags hold.
pub(crate) const HIGHEST_MACH: f64 = 0.9;

/// A model ready to be trimmed.
#[derive(Debug, Clone)]
pub struct Model {
    /// The variant.
    pub variant: VariantCase,
    /// Modal basis.
    pub basis: ModalBasis,
    /// Mass, centre of gravity and inertia that fly.
    pub mass: MassProperties,
    /// Damping ratio of each mode.
    pub damping: Vec<f64>,
    /// Strips.
    pub strips: StripSet,
    /// The aircraft.
    pub aircraft: Aircraft,
    /// Options of the equations.
    pub options: ModelOptions,
    /// Flight point.
    pub point: FlightPoint,
    /// Everything that was assumed or remarked on the way.
    pub notes: Vec<String>,
}

impl Inputs {
    /// Mach number of the flight point.
    pub fn mach(&self) -> f64 {
        self.case.flight.mach()
    }

    /// True airspeed of the flight point \[m/s\].
    pub fn speed(&self) -> f64 {
        self.case.flight.speed()
    }

    /// The modal basis of the case.
    ///
    /// # Errors
    /// As [`ModalBasis::from_nastran`].
    pub fn basis(&self) -> Result<ModalBasis, Error> {
        self.case.basis(&self.deck, &self.results)
    }
}

impl Inputs {
    /// The load reference axes of the case as components, for the shares of kinetic energy.
    ///
    /// # Errors
    /// [`Error::UnknownName`] for a range of grids that cannot be read.
    pub fn components(&self) -> Result<Vec<Component>, Error> {
        let axes = self.case.structure.lra.iter();
        axes.map(|(name, entries)| {
            Ok(Component {
                name: name.clone(),
                grids: grid_list(entries)?,
            })
        })
        .collect()
    }

    /// Damping ratio of each mode.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the case lists another number of ratios.
    pub fn damping(&self, n_modes: usize) -> Result<Vec<f64>, Error> {
        match &self.case.structure.damping_ratio {
            Damping::Uniform(xi) => Ok(vec![*xi; n_modes]),
            Damping::PerMode(list) if list.len() == n_modes => Ok(list.clone()),
            Damping::PerMode(list) => Err(Error::Mismatch {
                what: "structure.damping_ratio".into(),
                found: format!("{} ratios", list.len()),
                expected: format!("one ratio for all, or {n_modes}: one for each mode"),
            }),
        }
    }
}

impl Model {
    /// Builds the model of a variant.
    ///
    /// # Errors
    /// What the stages return; [`Error::Mismatch`] if a variant asks for corrections that the case does not name.
    pub fn build(inputs: &Inputs, variant: &VariantCase) -> Result<Self, Error> {
        if variant.corrections && inputs.slope_table.is_none() && inputs.longitudinal.is_none() {
            return Err(Error::Mismatch {
                what: format!("variant `{}`", variant.name),
                found: "corrections = true without data".into(),
                expected: "a [corrections] table with lift_slopes or derivatives".into(),
            });
        }
        let basis = inputs.basis()?;
        let mass = mass_that_flies(&basis)?;
        let damping = inputs.damping(basis.modes.len())?;
        let strips = strip_set(inputs, &basis, variant)?;
        let mut notes: Vec<String> = inputs
            .notes
            .iter()
            .chain(&basis.notes)
            .chain(&strips.notes)
            .cloned()
            .collect();
        let mach = inputs.case.flight.mach();
        if mach > HIGHEST_MACH {
            notes.push(format!(
                "Mach {mach:.3} is above the range of the method, {HIGHEST_MACH}: results lack shocks and their motion"
            ));
        }
        let aircraft = assemble(inputs, variant, &basis, &mass, &damping, &strips, &mut notes)?;
        let options = ModelOptions {
            fidelity: variant.fidelity,
            control_aerodynamics: variant
                .control_aerodynamics
                .unwrap_or(inputs.case.aerodynamics.control_aerodynamics),
            shape_reference: inputs.case.aerodynamics.shape_reference,
            attitude: inputs.case.flight.attitude,
            position: true,
        };
        let flight = &inputs.case.flight;
        let point = FlightPoint {
            speed: inputs.speed(),
            altitude: flight.altitude,
            path_angle_rad: flight.path_angle_deg.to_radians(),
            control: flight.trim_control.clone(),
        };
        Ok(Self {
            variant: variant.clone(),
            basis,
            mass,
            damping,
            strips,
            aircraft,
            options,
            point,
            notes,
        })
    }

    /// Trims the model.
    ///
    /// # Errors
    /// As [`trim()`].
    pub fn trim(&self) -> Result<(EquationsOfMotion, Trim), Error> {
        Ok(trim(&self.aircraft, self.options, &self.point)?)
    }

    /// Mach number of the flight point.
    pub fn mach(&self) -> f64 {
        self.point.speed / atmosphere::standard(self.point.altitude).speed_of_sound
    }
}

fn assemble(
    inputs: &Inputs,
    variant: &VariantCase,
    basis: &ModalBasis,
    mass: &MassProperties,
    damping: &[f64],
    set: &StripSet,
    notes: &mut Vec<String>,
) -> Result<Aircraft, Error> {
    let case = &inputs.case;
    let geometry = &inputs.geometry;
    let avl_options = AvlOptions {
        cg: mass.cg,
        moment_point: moment_point(inputs, notes),
        drag: case.aerodynamics.drag,
    };
    let (mut rigid, controls, avl_reference) = from_avl(&inputs.derivatives, &avl_options)?;
    let reference = case.reference.map_or(avl_reference, |r| ReferenceDimensions {
        area: r.area,
        chord: r.chord,
        span: r.span,
    });
    let mut aircraft_controls = controls;
    if variant.corrections
        && let Some(corrections) = &inputs.longitudinal
    {
        let source = case.corrections.as_ref();
        let elevator = source
            .and_then(|c| c.elevator.clone())
            .unwrap_or_else(|| case.flight.trim_control.clone());
        let index = aircraft_controls
            .iter()
            .position(|c| *c == elevator)
            .ok_or_else(|| Error::UnknownName {
                kind: "control",
                name: elevator.clone(),
                known: aircraft_controls.join(", "),
            })?;
        corrections.apply(&mut rigid, index);
        notes.push(format!(
            "longitudinal derivatives: {}",
            source.map_or("", |c| c.provenance.as_str())
        ));
    }

    let strips = &set.strips;
    let spread = control_loads(
        geometry,
        &aircraft_controls,
        &rigid,
        &reference,
        &set.records,
        strips,
        mass.cg,
    );
    notes.extend(spread.notes);
    let of_records = |f: &dyn Fn(&albatross_strip::slopes::StripRecord) -> f64| -> Vec<f64> {
        set.records.iter().map(f).collect()
    };
    let (alpha, cl0, sweep) = (
        of_records(&|r| r.cl_alpha),
        of_records(&|r| r.cl0),
        of_records(&|r| r.sweep_rad),
    );
    let form = case.aerodynamics.dihedral;
    let given = AnalyticLift {
        alpha: &alpha,
        cl0: &cl0,
        sweep_rad: &sweep,
        cg_xz: [mass.cg[0], mass.cg[2]],
        form,
    };
    let motion = StripLoads {
        lift: analytic_lift(strips, &given, &reference),
        moment: Mat::from_fn(strips.len(), 5, |j, x| {
            if x == 0 { set.records[j].cm_alpha } else { 0.0 }
        }),
    };
    let at_zero = StripLoads {
        lift: Mat::from_fn(strips.len(), 1, |j, _| cl0[j]),
        moment: Mat::from_fn(strips.len(), 1, |j, _| set.records[j].cm0),
    };
    let theory = StripTheory {
        downwash_point: case.aerodynamics.downwash_point,
        apparent_mass_factor: case.aerodynamics.apparent_mass_factor,
    };
    let mu = basis.generalized_masses();
    let structure = Structure::modal(&mu, &basis.omegas_rad_s(), damping)?;
    let split = case.aerodynamics.split;
    let rigid_shapes = StripShapes::rigid_body(strips, form, mass.cg[0], mass.cg[2]);
    let q_0 = rigid_to_elastic(strips, &set.shapes, &at_zero, &reference)?;
    let mut model = AeroelasticModel::try_new(
        structure,
        strips.clone(),
        set.shapes.clone(),
        &theory,
        split,
        &JONES,
    )?;
    let rigid_rows = match &set.influence {
        None => generalized_forces(strips, &rigid_shapes, &set.shapes, &theory, split)?,
        Some(influence) => {
            model = model.with_influence(influence, &theory, split)?;
            generalized_forces_between(strips, influence, &rigid_shapes, &set.shapes, &theory, split)?
        }
    };
    let elastic = ElasticPart {
        rigid_rows,
        q_x: rigid_to_elastic(strips, &set.shapes, &motion, &reference)?,
        q_u: rigid_to_elastic(strips, &set.shapes, &spread.loads, &reference)?,
        q_0: (0..q_0.nrows()).map(|k| q_0[(k, 0)]).collect(),
        control_incidence: incidence_of_equal_lift(set, spread.incidence)?,
        model,
    };
    Ok(Aircraft {
        mass: mass.mass,
        inertia: mass.inertia_body_axes(),
        gravity: case.flight.gravity,
        reference,
        controls: std::mem::take(&mut aircraft_controls),
        rigid,
        engines: engines(inputs, variant, basis, mass)?,
        elastic: Some(elastic),
        sensors: case
            .sensors
            .iter()
            .map(|s| sensor(s, basis, mass))
            .collect::<Result<_, _>>()?,
    })
}

/// Incidence of the strips that lifts them as the controls do. Where strips act on each other, the lift of a control is
/// given as it is, induced parts included: the incidence is solved for.
fn incidence_of_equal_lift(set: &StripSet, own: Mat<f64>) -> Result<Mat<f64>, Error> {
    let Some(influence) = &set.influence else {
        return Ok(own);
    };
    let lift = Mat::from_fn(own.nrows(), own.ncols(), |j, c| {
        set.strips[j].lift_factor() * own[(j, c)]
    });
    Ok(solve::solve(influence.as_ref(), lift.as_ref())?)
}

/// The moment point of the AVL run. The .st file prints it to five digits: the geometry file adds the rest where the
/// two agree so far, else the run's own (a .run file may have moved it) holds.
fn moment_point(inputs: &Inputs, notes: &mut Vec<String>) -> [f64; 3] {
    let printed = &inputs.derivatives.run.reference;
    let geometry = &inputs.geometry;
    let axes = [
        ("Xref", printed.x_ref, geometry.x_ref),
        ("Yref", printed.y_ref, geometry.y_ref),
        ("Zref", printed.z_ref, geometry.z_ref),
    ];
    axes.map(|(axis, printed, exact)| {
        if (printed - exact).abs() <= 1e-4 * exact.abs().max(1.0) {
            return exact;
        }
        notes.push(format!(
            "{axis} is {printed} in the .st file and {exact} in the geometry file; that of the .st file is used: \
             check that the two belong together"
        ));
        printed
    })
}

fn engines(
    inputs: &Inputs,
    variant: &VariantCase,
    basis: &ModalBasis,
    mass: &MassProperties,
) -> Result<Vec<Engine>, Error> {
    if variant.thrust_line == ThrustLine::ThroughCg {
        return Ok(vec![Engine::through_cg()]);
    }
    if inputs.case.engines.is_empty() {
        return Err(Error::Mismatch {
            what: format!("variant `{}`: thrust_line = \"engines\"", variant.name),
            found: "no engine in the case".into(),
            expected: "an [[engine]] with a grid, or thrust_line = \"through_cg\"".into(),
        });
    }
    let total: f64 = inputs.case.engines.iter().map(|e| e.share).sum();
    if (total - 1.0).abs() > 1e-9 {
        return Err(Error::Mismatch {
            what: "shares of the engines".into(),
            found: format!("a sum of {total}"),
            expected: "a sum of 1".into(),
        });
    }
    inputs
        .case
        .engines
        .iter()
        .map(|engine| {
            let (sin_i, cos_i) = engine.incidence_deg.to_radians().sin_cos();
            let (sin_t, cos_t) = engine.toe_deg.to_radians().sin_cos();
            let direction = [cos_i * cos_t, sin_t, -sin_i * cos_t];
            let shapes = basis.shape_at(engine.grid)?;
            // Body axes against structural axes: x and z change sign.
            let modal_work = shapes
                .iter()
                .map(|s| -direction[0] * s[0] + direction[1] * s[1] - direction[2] * s[2])
                .collect();
            Ok(Engine {
                share: engine.share,
                position: position(engine.grid, basis, mass)?,
                direction,
                modal_work,
            })
        })
        .collect()
}

/// Position of a grid in body axes from the centre of gravity.
fn position(grid: u32, basis: &ModalBasis, mass: &MassProperties) -> Result<[f64; 3], Error> {
    // An unknown grid gets the basis's own error with the nearest numbers.
    basis.shape_at(grid)?;
    let at = basis
        .grid_index(grid)
        .and_then(|i| basis.grids.get(i))
        .map_or([0.0; 3], |g| g.position);
    Ok(mass.to_body_axes(at))
}

fn sensor(case: &SensorCase, basis: &ModalBasis, mass: &MassProperties) -> Result<Sensor, Error> {
    let point = match case.grid {
        None => None,
        Some(grid) => {
            let shapes = basis.shape_at(grid)?;
            Some(SensorPoint {
                position: position(grid, basis, mass)?,
                translation_up: shapes.iter().map(|s| s[2]).collect(),
                rotation_nose_up: shapes.iter().map(|s| s[4]).collect(),
            })
        }
    };
    Ok(Sensor {
        name: case.name.clone(),
        quantity: case.quantity,
        point,
    })
}
