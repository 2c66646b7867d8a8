//! Run-case file (`.run`): constraints on the variables, and parameters, of each run case.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::error::{AvlError, Diagnostic};
use crate::fortran::{Item, general, items};
use crate::source::{Line, Source, excerpt};

/// Content of a `.run` file.
///
/// AVL reads `NAME.run` beside `NAME.avl` at start-up without being asked, and then takes CDp, Mach number and
/// moment reference point (`X_cg`, `Y_cg`, `Z_cg`) from it instead of from the geometry file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunFile {
    /// Run cases, in the order of the file.
    pub cases: Vec<RunCase>,
}

/// One run case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunCase {
    /// Number after `Run case`, from 1.
    pub index: usize,
    /// Text after the colon.
    pub title: String,
    /// `variable -> target = value`, in the order of the file.
    pub constraints: Vec<Constraint>,
    /// `name = value unit`, in the order of the file.
    pub parameters: Vec<ParameterValue>,
}

/// What one variable is driven by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Constraint {
    /// What AVL varies.
    pub variable: RunVariable,
    /// What it is to reach.
    pub target: RunTarget,
    /// Value of the target: degrees for angles and controls.
    pub value: f64,
}

/// A variable of a run case.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum RunVariable {
    /// Angle of attack.
    Alpha,
    /// Sideslip.
    Beta,
    /// Roll rate `pb/2V`.
    RollRate,
    /// Pitch rate `qc/2V`.
    PitchRate,
    /// Yaw rate `rb/2V`.
    YawRate,
    /// A control, as written: AVL keeps 12 characters and looks for them in the names of the geometry file.
    Control(String),
}

/// A constraint of a run case.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum RunTarget {
    /// Angle of attack, in degrees.
    Alpha,
    /// Sideslip, in degrees.
    Beta,
    /// Roll rate `pb/2V`.
    RollRate,
    /// Pitch rate `qc/2V`.
    PitchRate,
    /// Yaw rate `rb/2V`.
    YawRate,
    /// Lift coefficient `CL`.
    Lift,
    /// Side force coefficient `CY`.
    SideForce,
    /// Rolling moment coefficient `Cl`.
    RollMoment,
    /// Pitching moment coefficient `Cm`.
    PitchMoment,
    /// Yawing moment coefficient `Cn`.
    YawMoment,
    /// A control's deflection in degrees, as written.
    Control(String),
}

/// One parameter of a run case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterValue {
    /// Which.
    pub parameter: Parameter,
    /// Value, in the unit printed after it.
    pub value: f64,
    /// Unit as printed; may be empty.
    pub unit: String,
}

/// The parameters of a run case, in AVL's order. Units are those of the `.mass` file unless said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Parameter {
    /// `alpha`, degrees: result of the last run.
    Alpha,
    /// `beta`, degrees: result of the last run.
    Beta,
    /// `pb/2V`: result of the last run, in geometry axes (x aft).
    RollRate,
    /// `qc/2V`: result of the last run.
    PitchRate,
    /// `rb/2V`: result of the last run, in geometry axes (z up).
    YawRate,
    /// `CL`.
    Lift,
    /// `CDo`: profile drag.
    ProfileDrag,
    /// `bank`, degrees.
    Bank,
    /// `elevation`, degrees.
    Elevation,
    /// `heading`, degrees.
    Heading,
    /// `Mach`.
    Mach,
    /// `velocity`.
    Velocity,
    /// `density`.
    Density,
    /// `grav.acc.`.
    Gravity,
    /// `turn_rad.`.
    TurnRadius,
    /// `load_fac.`.
    LoadFactor,
    /// `X_cg`, in the unit of the geometry file.
    XCg,
    /// `Y_cg`, in the unit of the geometry file.
    YCg,
    /// `Z_cg`, in the unit of the geometry file.
    ZCg,
    /// `mass`.
    Mass,
    /// `Ixx`.
    Ixx,
    /// `Iyy`.
    Iyy,
    /// `Izz`.
    Izz,
    /// `Ixy`: entry of the inertia tensor, the negative of the product of inertia.
    Ixy,
    /// `Iyz`: entry of the inertia tensor.
    Iyz,
    /// `Izx`: entry of the inertia tensor.
    Izx,
    /// `visc CL_a`: viscous addition to the lift slope.
    ViscousLiftAlpha,
    /// `visc CL_u`.
    ViscousLiftSpeed,
    /// `visc CM_a`.
    ViscousMomentAlpha,
    /// `visc CM_u`.
    ViscousMomentSpeed,
}

/// AVL's names of the variables, in its order.
const VARIABLES: [(&str, RunVariable, RunTarget); 5] = [
    ("alpha", RunVariable::Alpha, RunTarget::Alpha),
    ("beta", RunVariable::Beta, RunTarget::Beta),
    ("pb/2V", RunVariable::RollRate, RunTarget::RollRate),
    ("qc/2V", RunVariable::PitchRate, RunTarget::PitchRate),
    ("rb/2V", RunVariable::YawRate, RunTarget::YawRate),
];

/// AVL's names of the coefficients, behind those of the variables.
const COEFFICIENTS: [(&str, RunTarget); 5] = [
    ("CL", RunTarget::Lift),
    ("CY", RunTarget::SideForce),
    ("Cl roll mom", RunTarget::RollMoment),
    ("Cm pitchmom", RunTarget::PitchMoment),
    ("Cn yaw  mom", RunTarget::YawMoment),
];

/// AVL's names of the parameters, in its order.
const PARAMETERS: [(&str, Parameter); 30] = [
    ("alpha", Parameter::Alpha),
    ("beta", Parameter::Beta),
    ("pb/2V", Parameter::RollRate),
    ("qc/2V", Parameter::PitchRate),
    ("rb/2V", Parameter::YawRate),
    ("CL", Parameter::Lift),
    ("CDo", Parameter::ProfileDrag),
    ("bank", Parameter::Bank),
    ("elevation", Parameter::Elevation),
    ("heading", Parameter::Heading),
    ("Mach", Parameter::Mach),
    ("velocity", Parameter::Velocity),
    ("density", Parameter::Density),
    ("grav.acc.", Parameter::Gravity),
    ("turn_rad.", Parameter::TurnRadius),
    ("load_fac.", Parameter::LoadFactor),
    ("X_cg", Parameter::XCg),
    ("Y_cg", Parameter::YCg),
    ("Z_cg", Parameter::ZCg),
    ("mass", Parameter::Mass),
    ("Ixx", Parameter::Ixx),
    ("Iyy", Parameter::Iyy),
    ("Izz", Parameter::Izz),
    ("Ixy", Parameter::Ixy),
    ("Iyz", Parameter::Iyz),
    ("Izx", Parameter::Izx),
    ("visc CL_a", Parameter::ViscousLiftAlpha),
    ("visc CL_u", Parameter::ViscousLiftSpeed),
    ("visc CM_a", Parameter::ViscousMomentAlpha),
    ("visc CM_u", Parameter::ViscousMomentSpeed),
];

impl Parameter {
    /// AVL's name.
    pub fn name(self) -> &'static str {
        PARAMETERS.iter().find(|p| p.1 == self).map_or("", |p| p.0)
    }

    /// What AVL takes when a run file has no such line: 1 for mass, moments of inertia, density and gravity,
    /// else 0. (AVL takes CG, CDp and Mach from the geometry file and masses from the mass file if it has them.)
    pub fn default_value(self) -> f64 {
        match self {
            Self::Density | Self::Gravity | Self::Mass | Self::Ixx | Self::Iyy | Self::Izz => 1.0,
            _ => 0.0,
        }
    }
}

impl RunVariable {
    /// As AVL prints it.
    pub fn name(&self) -> &str {
        match self {
            Self::Control(name) => name,
            _ => VARIABLES.iter().find(|v| v.1 == *self).map_or("", |v| v.0),
        }
    }
}

impl RunTarget {
    /// As AVL prints it.
    pub fn name(&self) -> &str {
        if let Self::Control(name) = self {
            return name;
        }
        let variable = VARIABLES.iter().find(|v| v.2 == *self).map(|v| v.0);
        variable
            .or(COEFFICIENTS.iter().find(|c| c.1 == *self).map(|c| c.0))
            .unwrap_or("")
    }
}

/// Which control of the geometry file a name of a `.run` file stands for: the one of this name, else, as AVL
/// does, the first whose name contains the written one (of which it keeps 12 columns with the blanks before it:
/// ten letters of a target).
pub fn find_control(written: &str, controls: &[&str]) -> Option<usize> {
    let written = written.trim();
    let cut: String = written.chars().take(10).collect();
    let exact = controls.iter().position(|&c| c == written);
    exact.or_else(|| {
        controls
            .iter()
            .position(|c| !cut.is_empty() && c.contains(cut.trim_end()))
    })
}

impl RunCase {
    /// Value of a parameter; `None` when the file has no such line (see [`Parameter::default_value`]).
    pub fn parameter(&self, parameter: Parameter) -> Option<f64> {
        self.parameters
            .iter()
            .rev()
            .find(|p| p.parameter == parameter)
            .map(|p| p.value)
    }

    /// The constraint of a variable; the last one counts.
    pub fn constraint(&self, variable: &RunVariable) -> Option<&Constraint> {
        self.constraints.iter().rev().find(|c| c.variable == *variable)
    }
}

impl RunFile {
    /// Reads a `.run` file as AVL does: a line with a colon starts a run case, a line with `->` and `=` is a
    /// constraint, another line with `=` a parameter; names are looked for within AVL's names and the first
    /// that contains them is taken; all else is passed over.
    ///
    /// # Errors
    /// [`AvlError::Empty`]; [`AvlError::Number`] and [`AvlError::Syntax`] for a line that cannot be read;
    /// [`AvlError::Missing`] when there is no run case.
    pub fn parse(text: &str, file: &str) -> Result<(Self, Vec<Diagnostic>), AvlError> {
        let mut source = Source::new(text, file);
        let mut out = Self::default();
        let mut diagnostics = Vec::new();
        while let Some(line) = source.read() {
            if let Some((head, title)) = line.text.split_once(':') {
                out.cases.push(RunCase {
                    index: case_number(&line, head)?,
                    title: title.trim().to_owned(),
                    ..Default::default()
                });
            } else if let Some(case) = out.cases.last_mut()
                && let Some((name, value)) = line.text.split_once('=')
            {
                case.read_line(&line, name, value, &mut diagnostics)?;
            }
        }
        if text.trim().is_empty() {
            let expected = "an AVL run-case file".to_owned();
            return Err(AvlError::Empty {
                file: file.to_owned(),
                expected,
            });
        }
        if out.cases.is_empty() {
            return Err(AvlError::Missing {
                file: file.to_owned(),
                line: 1,
                field: "Run case  1:".to_owned(),
                cure: "start each run case with such a line",
            });
        }
        Ok((out, diagnostics))
    }

    /// The text of a `.run` file as AVL writes it (OPER > S). Numbers have six digits (`G14.6`).
    ///
    /// # Errors
    /// [`AvlError::DoesNotFit`] for a number that is not finite or a case number above 999;
    /// [`AvlError::BadText`] for a title or name that would not read back.
    pub fn to_text(&self) -> Result<String, AvlError> {
        let mut out = String::new();
        for case in &self.cases {
            let index = crate::fortran::integer(case.index, 3).filter(|_| case.index > 0);
            let index = index.ok_or_else(|| AvlError::DoesNotFit {
                field: "Run case".to_owned(),
                value: case.index as f64,
                format: "I3",
                cure: "number the run cases from 1 to 999",
            })?;
            let title = writable("Run case", &case.title, &[])?;
            // AVL's own title of a case without one starts with a blank.
            let blank = if title.starts_with("-unnamed-") { " " } else { "" };
            let title = format!("{blank}{title}");
            let _ = write!(
                out,
                "\n ---------------------------------------------\n Run case{index}:  {title:<40}\n\n"
            );
            for constraint in &case.constraints {
                let variable = writable("variable", constraint.variable.name(), &[':', '=', '>'])?;
                let target = writable("constraint", constraint.target.name(), &[':', '=', '>'])?;
                let value = g14("constraint", constraint.value)?;
                let _ = writeln!(out, " {variable:<12} ->  {target:<12}={value}");
            }
            out.push('\n');
            for parameter in &case.parameters {
                let name = parameter.parameter.name();
                let value = g14(name, parameter.value)?;
                let unit = writable(name, &parameter.unit, &[':', '='])?;
                let _ = writeln!(out, " {name:<10}={value} {unit:<32}");
            }
        }
        Ok(out)
    }
}

/// The number before the colon. AVL reads the three columns before it and fails where they hold a letter.
fn case_number(line: &Line<'_>, head: &str) -> Result<usize, AvlError> {
    let word = head.split_whitespace().next_back().unwrap_or("");
    let index = line.parse_integer(word, head.trim_end().len().saturating_sub(word.len()), "Run case")?;
    if index == 0 {
        return Err(line.syntax("run cases numbered from 1"));
    }
    Ok(index)
}

/// The first name of AVL's that contains the written one.
fn first_containing<'n, T>(names: impl IntoIterator<Item = (&'n str, T)>, written: &str) -> Option<T> {
    names
        .into_iter()
        .find(|(name, _)| name.contains(written))
        .map(|(_, what)| what)
}

impl RunCase {
    /// `variable -> target = value` or `name = value unit`.
    fn read_line(
        &mut self,
        line: &Line<'_>,
        name: &str,
        value: &str,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Result<(), AvlError> {
        let column = name.len() + 1;
        if let Some((variable, target)) = name.split_once("->") {
            if variable.trim().is_empty() || target.trim().is_empty() {
                return Err(line.syntax("`variable -> constraint = value`"));
            }
            let (value, _) = first_number(line, value, column, target.trim())?;
            self.constraints.push(Constraint {
                variable: run_variable(variable),
                target: run_target(target),
                value,
            });
            return Ok(());
        }
        let written = name;
        let name = name.trim();
        match find_parameter(written) {
            None => {
                let message = format!("`{}` is no parameter: ignored, as AVL does", excerpt(name));
                diagnostics.push(line.diagnostic("run", message));
            }
            Some(parameter) => {
                let (value, unit) = first_number(line, value, column, name)?;
                let shadowed = matches!(
                    parameter,
                    Parameter::ViscousLiftSpeed | Parameter::ViscousMomentSpeed
                );
                if shadowed && value != 0.0 {
                    let message = format!(
                        "AVL compares 8 columns and takes `{name}` for its sister in `_a`: keep it zero"
                    );
                    diagnostics.push(line.diagnostic("run", message));
                }
                self.parameters.push(ParameterValue {
                    parameter,
                    value,
                    unit: unit.to_owned(),
                });
            }
        }
        Ok(())
    }
}

/// The first columns of a name, without the blanks around it: what AVL compares.
fn cut(written: &str, columns: usize) -> &str {
    crate::source::columns(written, 0, columns).trim()
}

/// The parameter that a name stands for: itself, or the first that contains its first 8 columns.
fn find_parameter(written: &str) -> Option<Parameter> {
    if let Some(&(_, parameter)) = PARAMETERS.iter().find(|p| p.0 == written.trim()) {
        return Some(parameter);
    }
    let name = cut(written, 8);
    if name.is_empty() {
        None
    } else {
        first_containing(PARAMETERS, name)
    }
}

/// The variable whose name contains the first 12 columns, else a control.
fn run_variable(written: &str) -> RunVariable {
    let names = VARIABLES.map(|(name, variable, _)| (name, variable));
    first_containing(names, cut(written, 12))
        .unwrap_or_else(|| RunVariable::Control(written.trim().to_owned()))
}

/// The variable or coefficient whose name contains the first 12 columns, else a control.
fn run_target(written: &str) -> RunTarget {
    let names = VARIABLES
        .map(|(name, _, target)| (name, target))
        .into_iter()
        .chain(COEFFICIENTS);
    first_containing(names, cut(written, 12)).unwrap_or_else(|| RunTarget::Control(written.trim().to_owned()))
}

/// First number of a text, and what follows it.
fn first_number<'t>(
    line: &Line<'_>,
    text: &'t str,
    column: usize,
    field: &str,
) -> Result<(f64, &'t str), AvlError> {
    match items(text).first() {
        Some(Item::Number {
            value, text: number, ..
        }) => {
            let end = text.find(number).map_or(text.len(), |i| i + number.len());
            Ok((*value, text.get(end..).unwrap_or("").trim()))
        }
        Some(Item::Word(word)) => Err(line.bad_number(word, column, field, "a number")),
        None => Err(line.bad_number("", column, field, "a number")),
    }
}

/// `G14.6`.
fn g14(field: &str, value: f64) -> Result<String, AvlError> {
    general(value, 14, 6).ok_or_else(|| AvlError::DoesNotFit {
        field: field.to_owned(),
        value,
        format: "G14.6",
        cure: "give a finite number",
    })
}

/// A text without line ends and without characters that the reader looks for.
fn writable<'t>(field: &str, text: &'t str, forbidden: &[char]) -> Result<&'t str, AvlError> {
    let reason = if text.contains(['\n', '\r']) {
        "contains a line end"
    } else if text.contains(forbidden) {
        "contains `:`, `=` or `>`, which the reader looks for"
    } else if text.trim() != text {
        "begins or ends with a blank"
    } else {
        return Ok(text);
    };
    Err(AvlError::BadText {
        field: field.to_owned(),
        text: text.to_owned(),
        reason,
    })
}
