//! Vortex lattice of an AVL geometry.

use crate::args::{CoreChoice, VlmOptions};
use crate::output::{Failure, print, print_json, read_text, remark, write};
use albatross::avl::results::{
    NamedColumn, RunState, StabilityColumn, StabilityDerivatives, StripForces, StripSurface,
};
use albatross::avl::run::{Parameter, RunCase, RunFile, RunTarget, RunVariable};
use albatross::lattice::{self, LatticeInput};
use albatross::vlm::{Lattice, Method, Solver, Trim};
use serde_json::{Map, Value, json};
use std::path::Path;

pub(crate) fn vlm(options: &VlmOptions) -> Result<(), Failure> {
    let LatticeInput {
        mut lattice,
        mut notes,
        ..
    } = lattice::read(&options.geometry)?;
    let of_file = |source| Failure::from(lattice::of_file(&options.geometry)(source));
    let case = run_case(options, &mut notes)?;
    if let Some(case) = &case {
        take_parameters(&mut lattice, case);
    }
    if let Some([x, y, z]) = options.reference_point.as_deref() {
        let r = &mut lattice.reference;
        (r.x_ref, r.y_ref, r.z_ref) = (*x, *y, *z);
    }
    let mach = options.mach.unwrap_or(lattice.mach);
    let trim = targets(options, &lattice, case.as_ref())?;
    let title = case.as_ref().map_or("", |c| c.title.as_str());

    let solver = Solver::new(&lattice, &method(options, &lattice), mach).map_err(of_file)?;
    let solution = solver.trim(&trim).map_err(of_file)?;
    let derivatives = solution.stability_derivatives(title);
    let strips = solution.strip_forces();
    if !options.quiet {
        notes.iter().for_each(|note| remark(&format!("note: {note}")));
    }
    if let Some(prefix) = &options.write {
        let file = |ending: &str| {
            let mut name = prefix.as_os_str().to_owned();
            name.push(ending);
            name
        };
        let text = |text: Result<String, albatross::avl::AvlError>| text.map_err(albatross::Error::from);
        write(Path::new(&file(".ft")), &text(derivatives.run.to_text())?)?;
        write(Path::new(&file(".st")), &text(derivatives.to_text())?)?;
        write(Path::new(&file(".fs")), &text(strips.to_text())?)?;
    }
    if options.json {
        print_json(&json(&derivatives, &strips, &notes))
    } else {
        print(&derivatives.to_text().map_err(albatross::Error::from)?)
    }
}

fn method(options: &VlmOptions, lattice: &Lattice) -> Method {
    let method = match options.core {
        CoreChoice::Avl332 => Method::AVL_332,
        CoreChoice::Avl352 => Method::AVL_352,
    };
    let method = Method {
        leg_forces: options.leg_forces.unwrap_or(method.leg_forces),
        threads: options.threads,
        ..method
    };
    method.with_core_of(lattice)
}

/// The run case asked for.
fn run_case(options: &VlmOptions, notes: &mut Vec<String>) -> Result<Option<RunCase>, Failure> {
    let Some(path) = &options.run else {
        return Ok(None);
    };
    let file = path.display().to_string();
    let (cases, remarks) = RunFile::parse(&read_text(path)?, &file).map_err(albatross::Error::from)?;
    notes.extend(remarks.iter().map(ToString::to_string));
    let known: Vec<String> = cases.cases.iter().map(|c| c.index.to_string()).collect();
    let found = cases.cases.into_iter().find(|c| c.index == options.case);
    found.map(Some).ok_or_else(|| {
        Failure::Other(format!(
            "{file}: there is no run case {}; there is: {}",
            options.case,
            known.join(", ")
        ))
    })
}

/// Profile drag, Mach number and moment point of a run case, which AVL takes from it rather than from the geometry.
fn take_parameters(lattice: &mut Lattice, case: &RunCase) {
    for p in &case.parameters {
        match p.parameter {
            Parameter::ProfileDrag => lattice.cd_p = p.value,
            Parameter::Mach => lattice.mach = p.value,
            Parameter::XCg => lattice.reference.x_ref = p.value,
            Parameter::YCg => lattice.reference.y_ref = p.value,
            Parameter::ZCg => lattice.reference.z_ref = p.value,
            _ => {}
        }
    }
}

/// What every variable is to reach: the run case first, then the options.
fn targets(options: &VlmOptions, lattice: &Lattice, case: Option<&RunCase>) -> Result<Trim, Failure> {
    let of_file = |source| Failure::from(lattice::of_file(&options.geometry)(source));
    let mut trim = match case {
        Some(case) => Trim::of_run_case(lattice, case).map_err(of_file)?,
        None => Trim::new(lattice),
    };
    let given = [
        (RunVariable::Alpha, RunTarget::Alpha, options.alpha),
        (RunVariable::Alpha, RunTarget::Lift, options.cl),
        (RunVariable::Beta, RunTarget::Beta, options.beta),
        (RunVariable::RollRate, RunTarget::RollRate, options.pb2v),
        (RunVariable::PitchRate, RunTarget::PitchRate, options.qc2v),
        (RunVariable::YawRate, RunTarget::YawRate, options.rb2v),
    ];
    for (variable, target, value) in given {
        if let Some(value) = value {
            trim.set(lattice, &variable, target, value).map_err(of_file)?;
        }
    }
    for text in &options.set {
        let parts: Vec<&str> = text.split('=').collect();
        let (name, value) = match parts[..] {
            [name, value] => (name.trim(), number("--set", text, value)?),
            _ => return Err(malformed("--set", text, "CONTROL=DEG, such as elevator=-2.5")),
        };
        let target = RunTarget::Control(name.to_owned());
        trim.set(lattice, &RunVariable::Control(name.to_owned()), target, value)
            .map_err(of_file)?;
    }
    for text in &options.trim {
        let parts: Vec<&str> = text.split('=').map(str::trim).collect();
        let (name, coefficient, value) = match parts[..] {
            [name, coefficient] => (name, coefficient, 0.0),
            [name, coefficient, value] => (name, coefficient, number("--trim", text, value)?),
            _ => {
                return Err(malformed(
                    "--trim",
                    text,
                    "VARIABLE=COEFFICIENT, such as elevator=Cm",
                ));
            }
        };
        let target = coefficient_of(coefficient)
            .ok_or_else(|| malformed("--trim", text, "one of the coefficients CL, CY, Cl, Cm, Cn"))?;
        trim.set(lattice, &variable_of(name), target, value)
            .map_err(of_file)?;
    }
    Ok(trim)
}

fn malformed(option: &str, text: &str, expected: &str) -> Failure {
    Failure::Other(format!("{option} {text}: expected {expected}"))
}

fn number(option: &str, text: &str, value: &str) -> Result<f64, Failure> {
    value
        .trim()
        .parse()
        .map_err(|_| malformed(option, text, "a number after the last `=`"))
}

fn coefficient_of(name: &str) -> Option<RunTarget> {
    Some(match name {
        "CL" | "CLtot" => RunTarget::Lift,
        "CY" | "CYtot" => RunTarget::SideForce,
        "Cl" | "Cltot" => RunTarget::RollMoment,
        "Cm" | "Cmtot" => RunTarget::PitchMoment,
        "Cn" | "Cntot" => RunTarget::YawMoment,
        _ => return None,
    })
}

fn variable_of(name: &str) -> RunVariable {
    match name.to_ascii_lowercase().as_str() {
        "alpha" => RunVariable::Alpha,
        "beta" => RunVariable::Beta,
        "pb2v" | "pb/2v" => RunVariable::RollRate,
        "qc2v" | "qc/2v" => RunVariable::PitchRate,
        "rb2v" | "rb/2v" => RunVariable::YawRate,
        _ => RunVariable::Control(name.to_owned()),
    }
}

/// All results under AVL's own names.
fn json(derivatives: &StabilityDerivatives, strips: &StripForces, notes: &[String]) -> Value {
    let mut all = totals(&derivatives.run);
    let d = derivatives;
    let own = [
        ("a", &d.alpha),
        ("b", &d.beta),
        ("p", &d.roll_rate),
        ("q", &d.pitch_rate),
        ("r", &d.yaw_rate),
    ];
    own.iter()
        .for_each(|(suffix, column)| put(&mut all, column, suffix));
    let mut numbered = |letter: char, columns: &[NamedColumn<StabilityColumn>]| {
        for (k, named) in columns.iter().enumerate() {
            put(&mut all, &named.column, &format!("{letter}{:02}", k + 1));
        }
    };
    numbered('d', &d.controls);
    numbered('g', &d.designs);
    all.insert("Xnp".into(), json!(d.neutral_point_x));
    all.insert("Clb Cnr / Clr Cnb".into(), json!(d.spiral_ratio));
    all.insert("surfaces".into(), strips.surfaces.iter().map(surface).collect());
    all.insert(
        "strips".into(),
        strips.surfaces.iter().flat_map(strip_rows).collect(),
    );
    all.insert("notes".into(), json!(notes));
    Value::Object(all)
}

fn put(all: &mut Map<String, Value>, column: &StabilityColumn, suffix: &str) {
    let entries = [
        ("CL", Some(column.lift)),
        ("CY", Some(column.side_force)),
        ("CD", column.drag),
        ("Cl", Some(column.roll)),
        ("Cm", Some(column.pitch)),
        ("Cn", Some(column.yaw)),
        ("CDff", column.trefftz_drag),
        ("e", column.span_efficiency),
    ];
    for (name, value) in entries {
        if let Some(value) = value {
            all.insert(format!("{name}{suffix}"), json!(value));
        }
    }
}

fn totals(run: &RunState) -> Map<String, Value> {
    let r = &run.reference;
    let numbers = [
        ("Sref", r.s_ref),
        ("Cref", r.c_ref),
        ("Bref", r.b_ref),
        ("Xref", r.x_ref),
        ("Yref", r.y_ref),
        ("Zref", r.z_ref),
        ("Alpha", run.alpha_deg),
        ("Beta", run.beta_deg),
        ("Mach", run.mach),
        ("pb/2V", run.pb_2v),
        ("qc/2V", run.qc_2v),
        ("rb/2V", run.rb_2v),
        ("p'b/2V", run.pb_2v_stability),
        ("r'b/2V", run.rb_2v_stability),
        ("CXtot", run.c_x),
        ("CYtot", run.c_y),
        ("CZtot", run.c_z),
        ("Cltot", run.c_roll),
        ("Cmtot", run.c_m),
        ("Cntot", run.c_n),
        ("Cl'tot", run.c_roll_stability),
        ("Cn'tot", run.c_n_stability),
        ("CLtot", run.c_lift),
        ("CDtot", run.c_drag),
        ("CDvis", run.c_drag_viscous),
        ("CDind", run.c_drag_induced),
        ("CLff", run.c_lift_trefftz),
        ("CDff", run.c_drag_trefftz),
        ("CYff", run.c_y_trefftz),
        ("e", run.span_efficiency),
    ];
    let mut all = Map::new();
    all.insert("Configuration".into(), json!(run.title));
    all.insert("# Surfaces".into(), json!(run.n_surfaces));
    all.insert("# Strips".into(), json!(run.n_strips));
    all.insert("# Vortices".into(), json!(run.n_vortices));
    all.extend(numbers.map(|(name, value)| (name.to_owned(), json!(value))));
    let named = |list: &[albatross::avl::results::NamedValue]| -> Map<String, Value> {
        list.iter()
            .map(|v| (v.name.trim().to_owned(), json!(v.value)))
            .collect()
    };
    all.insert("controls".into(), Value::Object(named(&run.controls)));
    all.insert("designs".into(), Value::Object(named(&run.designs)));
    all
}

fn surface(surface: &StripSurface) -> Value {
    let c = &surface.coefficients;
    json!({
        "index": surface.index,
        "name": surface.name,
        "n_chord": surface.n_chord,
        "n_span": surface.n_span,
        "Ssurf": surface.area,
        "Cave": surface.average_chord,
        "CLsurf": c.c_lift,
        "CDsurf": c.c_drag,
        "CYsurf": c.c_y,
        "Clsurf": c.c_roll,
        "Cmsurf": c.c_m,
        "Cnsurf": c.c_n,
        "CDisurf": c.c_drag_induced,
        "CDvsurf": c.c_drag_viscous,
        "cl_local": c.cl_local,
        "cd_local": c.cd_local,
    })
}

fn strip_rows(surface: &StripSurface) -> Vec<Value> {
    let row = |s: &albatross::avl::results::Strip| {
        json!({
            "surface": surface.name,
            "j": s.index,
            "Xle": s.x_le,
            "Yle": s.y_le,
            "Zle": s.z_le,
            "Chord": s.chord,
            "Area": s.area,
            "c_cl": s.c_cl,
            "ai": s.ai,
            "cl_norm": s.cl_norm,
            "cl": s.cl,
            "cd": s.cd,
            "cdv": s.cdv,
            "cm_c/4": s.cm_c4,
            "cm_LE": s.cm_le,
            "C.P.x/c": s.xcp,
        })
    };
    surface.strips.iter().map(row).collect()
}
