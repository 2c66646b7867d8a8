//! Derivatives: `.st` (stability axes) and `.sb` (body axes).
//!
//! Units: per rad for alpha and beta; per unit of `p b/2V`, `q c/2V`, `r b/2V` for the rates; per unit of the
//! control variable, which is a degree where the control's gain is 1; per unit of the design variable.

use serde::{Deserialize, Serialize};

use super::RunState;
use super::kind::{FileKind, Layout, open};
use super::mrf;
use super::table::{Suffix, Table};
use crate::error::AvlError;
use crate::source::Source;

/// A coefficient of the `.st` table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Coefficient {
    /// `CL`, lift (z' force). Not the rolling moment `Cl`.
    Lift,
    /// `CY`, side force.
    SideForce,
    /// `CD`, drag (x force); printed by AVL 3.5x and by 3.5x MRF only.
    Drag,
    /// `Cl'`, rolling moment in stability axes. Not the lift `CL`.
    Roll,
    /// `Cm`, pitching moment.
    Pitch,
    /// `Cn'`, yawing moment in stability axes.
    Yaw,
    /// `CDff`, induced drag in the Trefftz plane; controls and design variables only.
    TrefftzDrag,
    /// `e`, span efficiency; controls and design variables only.
    SpanEfficiency,
}

/// What a stability derivative is taken with respect to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Variable {
    /// Angle of attack, per rad.
    Alpha,
    /// Sideslip, per rad.
    Beta,
    /// Roll rate in stability axes, per unit `p' b / 2V`.
    RollRate,
    /// Pitch rate, per unit `q c / 2V`.
    PitchRate,
    /// Yaw rate in stability axes, per unit `r' b / 2V`.
    YawRate,
    /// Control variable by index from 0 (d01 is 0), per control unit (degree times gain).
    Control(usize),
    /// Design variable by index from 0 (g01 is 0).
    Design(usize),
}

/// Derivatives of all coefficients with respect to one variable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityColumn {
    /// `CL`, lift.
    pub lift: f64,
    /// `CY`, side force.
    pub side_force: f64,
    /// `CD`, drag; absent before AVL 3.5x.
    pub drag: Option<f64>,
    /// `Cl'`, rolling moment.
    pub roll: f64,
    /// `Cm`, pitching moment.
    pub pitch: f64,
    /// `Cn'`, yawing moment.
    pub yaw: f64,
    /// `CDff`, Trefftz-plane drag; controls and design variables only.
    pub trefftz_drag: Option<f64>,
    /// `e`, span efficiency; controls and design variables only.
    pub span_efficiency: Option<f64>,
}

impl StabilityColumn {
    /// One entry; `None` where AVL does not print it.
    pub fn get(&self, coefficient: Coefficient) -> Option<f64> {
        match coefficient {
            Coefficient::Lift => Some(self.lift),
            Coefficient::SideForce => Some(self.side_force),
            Coefficient::Drag => self.drag,
            Coefficient::Roll => Some(self.roll),
            Coefficient::Pitch => Some(self.pitch),
            Coefficient::Yaw => Some(self.yaw),
            Coefficient::TrefftzDrag => self.trefftz_drag,
            Coefficient::SpanEfficiency => self.span_efficiency,
        }
    }
}

/// A column with the name of its control or design variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedColumn<C> {
    /// Name, up to 16 characters.
    pub name: String,
    /// Derivatives.
    pub column: C,
}

/// Content of an `.st` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityDerivatives {
    /// Flight condition and totals about which the derivatives are taken.
    pub run: RunState,
    /// Per rad of alpha.
    pub alpha: StabilityColumn,
    /// Per rad of beta.
    pub beta: StabilityColumn,
    /// Per unit `p' b / 2V`.
    pub roll_rate: StabilityColumn,
    /// Per unit `q c / 2V`.
    pub pitch_rate: StabilityColumn,
    /// Per unit `r' b / 2V`.
    pub yaw_rate: StabilityColumn,
    /// Per unit of each control variable (degree times gain), in AVL's order (d01, d02, ...).
    pub controls: Vec<NamedColumn<StabilityColumn>>,
    /// Per unit of each design variable, in AVL's order (g01, ...).
    pub designs: Vec<NamedColumn<StabilityColumn>>,
    /// Neutral point `Xnp`, x aft, in the geometry file's unit; absent when `CLa` is zero.
    pub neutral_point_x: Option<f64>,
    /// `Clb Cnr / Clr Cnb`, above 1 when spirally stable; absent when the denominator is below 1e-4.
    pub spiral_ratio: Option<f64>,
}

/// Prefixes of the names in an `.st` table. Upper and lower case differ: `CLa` is lift, `Cla` roll.
const STABILITY: [(&str, Coefficient); 8] = [
    ("CDff", Coefficient::TrefftzDrag),
    ("CL", Coefficient::Lift),
    ("CY", Coefficient::SideForce),
    ("CD", Coefficient::Drag),
    ("Cl", Coefficient::Roll),
    ("Cm", Coefficient::Pitch),
    ("Cn", Coefficient::Yaw),
    ("e", Coefficient::SpanEfficiency),
];

/// The column of one variable.
fn stability_column(table: &Table<Coefficient>, suffix: Suffix) -> Result<StabilityColumn, AvlError> {
    Ok(StabilityColumn {
        lift: table.require(Coefficient::Lift, suffix, "CL")?,
        side_force: table.require(Coefficient::SideForce, suffix, "CY")?,
        drag: table.get(Coefficient::Drag, suffix),
        roll: table.require(Coefficient::Roll, suffix, "Cl")?,
        pitch: table.require(Coefficient::Pitch, suffix, "Cm")?,
        yaw: table.require(Coefficient::Yaw, suffix, "Cn")?,
        trefftz_drag: table.get(Coefficient::TrefftzDrag, suffix),
        span_efficiency: table.get(Coefficient::SpanEfficiency, suffix),
    })
}

/// Neutral point and spiral ratio, where they are defined.
fn read_footer(source: &mut Source<'_>, layout: Layout) -> Result<(Option<f64>, Option<f64>), AvlError> {
    if layout == Layout::Mrf {
        let neutral_point = mrf::labelled(source, "Neutral point  Xnp")?;
        let neutral_point = mrf::real(&neutral_point, 0, "Xnp")?;
        let spiral = mrf::labelled(source, "Clb Cnr / Clr Cnb")?;
        let spiral = mrf::real(&spiral, 0, "Clb Cnr / Clr Cnb")?;
        return Ok((mrf::defined(neutral_point), mrf::defined(spiral)));
    }
    let (mut neutral_point, mut spiral) = (None, None);
    while let Some(line) = source.read() {
        neutral_point = neutral_point.or(line.labelled_real("Xnp", 11).transpose()?);
        spiral = spiral.or(line.labelled_real("Clb Cnr / Clr Cnb", 11).transpose()?);
        if let Some(equals) = line.text.find('=') {
            source.refuse_cut(
                &line,
                equals + 12,
                "the end of the neutral point or of the spiral ratio",
            )?;
        }
    }
    Ok((neutral_point, spiral))
}

impl StabilityDerivatives {
    /// Reads an `.st` file.
    ///
    /// # Errors
    /// [`AvlError::WrongKind`] for another kind of file; [`AvlError::Missing`] for an absent row;
    /// [`AvlError::Truncated`], [`AvlError::Number`], [`AvlError::Overflow`], [`AvlError::NotFinite`],
    /// [`AvlError::Count`], [`AvlError::Syntax`] for a damaged file.
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::StabilityDerivatives)?;
        let run = RunState::read(&mut source, layout)?;
        source.find("Stability-axis derivatives")?;
        let table = Table::read(&mut source, layout, &STABILITY, "abpqr")?;
        let (neutral_point_x, spiral_ratio) = read_footer(&mut source, layout)?;
        Ok(Self {
            alpha: stability_column(&table, Suffix::Axis('a'))?,
            beta: stability_column(&table, Suffix::Axis('b'))?,
            roll_rate: stability_column(&table, Suffix::Axis('p'))?,
            pitch_rate: stability_column(&table, Suffix::Axis('q'))?,
            yaw_rate: stability_column(&table, Suffix::Axis('r'))?,
            controls: table.named(&run.controls, Suffix::Control, stability_column)?,
            designs: table.named(&run.designs, Suffix::Design, stability_column)?,
            neutral_point_x,
            spiral_ratio,
            run,
        })
    }

    /// All derivatives with respect to one variable.
    pub fn column(&self, variable: Variable) -> Option<&StabilityColumn> {
        match variable {
            Variable::Alpha => Some(&self.alpha),
            Variable::Beta => Some(&self.beta),
            Variable::RollRate => Some(&self.roll_rate),
            Variable::PitchRate => Some(&self.pitch_rate),
            Variable::YawRate => Some(&self.yaw_rate),
            Variable::Control(k) => self.controls.get(k).map(|c| &c.column),
            Variable::Design(k) => self.designs.get(k).map(|c| &c.column),
        }
    }

    /// One derivative; `None` where AVL does not print it.
    pub fn get(&self, coefficient: Coefficient, variable: Variable) -> Option<f64> {
        self.column(variable)?.get(coefficient)
    }

    /// Derivatives with respect to the control of this name, per control unit (degree times gain).
    pub fn control(&self, name: &str) -> Option<&StabilityColumn> {
        self.controls.iter().find(|c| c.name == name).map(|c| &c.column)
    }

    /// Derivatives with respect to the design variable of this name.
    pub fn design(&self, name: &str) -> Option<&StabilityColumn> {
        self.designs.iter().find(|c| c.name == name).map(|c| &c.column)
    }
}

/// A coefficient of the `.sb` table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum BodyCoefficient {
    /// `CX`.
    X,
    /// `CY`.
    Y,
    /// `CZ`.
    Z,
    /// `Cl`, rolling moment.
    Roll,
    /// `Cm`, pitching moment.
    Pitch,
    /// `Cn`, yawing moment.
    Yaw,
}

/// What a body-axis derivative is taken with respect to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum BodyVariable {
    /// Axial velocity over V.
    U,
    /// Side velocity over V.
    V,
    /// Normal velocity over V.
    W,
    /// `p b / 2V`.
    P,
    /// `q c / 2V`.
    Q,
    /// `r b / 2V`.
    R,
    /// Control variable by index from 0, per control unit (degree times gain).
    Control(usize),
    /// Design variable by index from 0.
    Design(usize),
}

/// Body-axis derivatives of all coefficients with respect to one variable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyColumn {
    /// `CX`.
    pub x: f64,
    /// `CY`.
    pub y: f64,
    /// `CZ`.
    pub z: f64,
    /// `Cl`, rolling moment.
    pub roll: f64,
    /// `Cm`, pitching moment.
    pub pitch: f64,
    /// `Cn`, yawing moment.
    pub yaw: f64,
}

impl BodyColumn {
    /// One entry.
    pub fn get(&self, coefficient: BodyCoefficient) -> f64 {
        match coefficient {
            BodyCoefficient::X => self.x,
            BodyCoefficient::Y => self.y,
            BodyCoefficient::Z => self.z,
            BodyCoefficient::Roll => self.roll,
            BodyCoefficient::Pitch => self.pitch,
            BodyCoefficient::Yaw => self.yaw,
        }
    }
}

/// Content of an `.sb` file: body axes, x forward, z down (`CXw > 0`, `CZw < 0`) in the standard orientation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyDerivatives {
    /// Flight condition and totals about which the derivatives are taken.
    pub run: RunState,
    /// Per u/V.
    pub u: BodyColumn,
    /// Per v/V.
    pub v: BodyColumn,
    /// Per w/V.
    pub w: BodyColumn,
    /// Per `p b / 2V`.
    pub p: BodyColumn,
    /// Per `q c / 2V`.
    pub q: BodyColumn,
    /// Per `r b / 2V`.
    pub r: BodyColumn,
    /// Per unit of each control variable (degree times gain).
    pub controls: Vec<NamedColumn<BodyColumn>>,
    /// Per unit of each design variable.
    pub designs: Vec<NamedColumn<BodyColumn>>,
}

/// Prefixes of the names in an `.sb` table.
const BODY: [(&str, BodyCoefficient); 6] = [
    ("CX", BodyCoefficient::X),
    ("CY", BodyCoefficient::Y),
    ("CZ", BodyCoefficient::Z),
    ("Cl", BodyCoefficient::Roll),
    ("Cm", BodyCoefficient::Pitch),
    ("Cn", BodyCoefficient::Yaw),
];

/// The column of one variable.
fn body_column(table: &Table<BodyCoefficient>, suffix: Suffix) -> Result<BodyColumn, AvlError> {
    Ok(BodyColumn {
        x: table.require(BodyCoefficient::X, suffix, "CX")?,
        y: table.require(BodyCoefficient::Y, suffix, "CY")?,
        z: table.require(BodyCoefficient::Z, suffix, "CZ")?,
        roll: table.require(BodyCoefficient::Roll, suffix, "Cl")?,
        pitch: table.require(BodyCoefficient::Pitch, suffix, "Cm")?,
        yaw: table.require(BodyCoefficient::Yaw, suffix, "Cn")?,
    })
}

impl BodyDerivatives {
    /// Reads an `.sb` file.
    ///
    /// # Errors
    /// As [`StabilityDerivatives::parse`].
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::BodyDerivatives)?;
        let run = RunState::read(&mut source, layout)?;
        source.find("-axis derivatives")?;
        let table = Table::read(&mut source, layout, &BODY, "uvwpqr")?;
        Ok(Self {
            u: body_column(&table, Suffix::Axis('u'))?,
            v: body_column(&table, Suffix::Axis('v'))?,
            w: body_column(&table, Suffix::Axis('w'))?,
            p: body_column(&table, Suffix::Axis('p'))?,
            q: body_column(&table, Suffix::Axis('q'))?,
            r: body_column(&table, Suffix::Axis('r'))?,
            controls: table.named(&run.controls, Suffix::Control, body_column)?,
            designs: table.named(&run.designs, Suffix::Design, body_column)?,
            run,
        })
    }

    /// All derivatives with respect to one variable.
    pub fn column(&self, variable: BodyVariable) -> Option<&BodyColumn> {
        match variable {
            BodyVariable::U => Some(&self.u),
            BodyVariable::V => Some(&self.v),
            BodyVariable::W => Some(&self.w),
            BodyVariable::P => Some(&self.p),
            BodyVariable::Q => Some(&self.q),
            BodyVariable::R => Some(&self.r),
            BodyVariable::Control(k) => self.controls.get(k).map(|c| &c.column),
            BodyVariable::Design(k) => self.designs.get(k).map(|c| &c.column),
        }
    }

    /// One derivative; `None` for a control or design variable that is not there.
    pub fn get(&self, coefficient: BodyCoefficient, variable: BodyVariable) -> Option<f64> {
        Some(self.column(variable)?.get(coefficient))
    }

    /// Derivatives with respect to the control of this name, per control unit (degree times gain).
    pub fn control(&self, name: &str) -> Option<&BodyColumn> {
        self.controls.iter().find(|c| c.name == name).map(|c| &c.column)
    }
}
