//! Flight condition and total forces: the `.ft` file, and the head of `.st` and `.sb`.

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::{AxisOrientation, mrf};
use crate::error::AvlError;
use crate::source::{Line, Source};

/// The content of an `.ft` file is exactly the run state.
pub type TotalForces = RunState;

/// Reference area, lengths and moment point, in the geometry file's unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Reference area.
    pub s_ref: f64,
    /// Reference chord.
    pub c_ref: f64,
    /// Reference span.
    pub b_ref: f64,
    /// Moment reference point, x aft.
    pub x_ref: f64,
    /// Moment reference point, y right.
    pub y_ref: f64,
    /// Moment reference point, z up.
    pub z_ref: f64,
}

/// A name and a number, as in `elevator = -0.01128`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedValue {
    /// Name, up to 16 characters.
    pub name: String,
    /// Value: degrees times the control's gain for controls, design units for design variables.
    pub value: f64,
}

/// Flight condition, total forces and control deflections of one AVL solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    /// Title of the geometry file (`Configuration:`).
    pub title: String,
    /// Number of surfaces, mirror images included.
    pub n_surfaces: usize,
    /// Number of strips.
    pub n_strips: usize,
    /// Number of vortices.
    pub n_vortices: usize,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Axes of the x and z forces, of the roll and yaw moments and of the rates.
    pub axes: AxisOrientation,
    /// Title of the run case.
    pub run_case: String,
    /// Angle of attack, in degrees.
    pub alpha_deg: f64,
    /// Sideslip, in degrees.
    pub beta_deg: f64,
    /// Mach number; the text layout prints 3 decimals.
    pub mach: f64,
    /// Roll rate `p b / 2V` in body axes.
    pub pb_2v: f64,
    /// Pitch rate `q c / 2V`.
    pub qc_2v: f64,
    /// Yaw rate `r b / 2V` in body axes.
    pub rb_2v: f64,
    /// Roll rate `p' b / 2V` in stability axes.
    pub pb_2v_stability: f64,
    /// Yaw rate `r' b / 2V` in stability axes.
    pub rb_2v_stability: f64,
    /// x force coefficient (`CXtot`).
    pub c_x: f64,
    /// y force coefficient (`CYtot`).
    pub c_y: f64,
    /// z force coefficient (`CZtot`).
    pub c_z: f64,
    /// Rolling moment coefficient (`Cltot`), body axes.
    pub c_roll: f64,
    /// Pitching moment coefficient (`Cmtot`).
    pub c_m: f64,
    /// Yawing moment coefficient (`Cntot`), body axes.
    pub c_n: f64,
    /// Rolling moment coefficient in stability axes (`Cl'tot`).
    pub c_roll_stability: f64,
    /// Yawing moment coefficient in stability axes (`Cn'tot`).
    pub c_n_stability: f64,
    /// Lift coefficient (`CLtot`).
    pub c_lift: f64,
    /// Drag coefficient (`CDtot`).
    pub c_drag: f64,
    /// Profile drag (`CDvis`).
    pub c_drag_viscous: f64,
    /// Induced drag from surface integration (`CDind`).
    pub c_drag_induced: f64,
    /// Lift in the Trefftz plane (`CLff`).
    pub c_lift_trefftz: f64,
    /// Induced drag in the Trefftz plane (`CDff`).
    pub c_drag_trefftz: f64,
    /// Side force in the Trefftz plane (`CYff`).
    pub c_y_trefftz: f64,
    /// Span efficiency (`e`).
    pub span_efficiency: f64,
    /// Control variables in AVL's order (d01, d02, ...), in degrees per unit gain.
    pub controls: Vec<NamedValue>,
    /// Design variables in AVL's order (g01, ...).
    pub designs: Vec<NamedValue>,
}

/// Reads `Sref =` to `Zref =`, `G12.5` or `F10.4`.
pub(crate) fn read_reference(source: &mut Source<'_>) -> Result<Reference, AvlError> {
    let [s_ref, c_ref, b_ref] = source.find_reals([("Sref", 12), ("Cref", 12), ("Bref", 12)])?;
    let [x_ref, y_ref, z_ref] = source.find_reals([("Xref", 12), ("Yref", 12), ("Zref", 12)])?;
    Ok(Reference {
        s_ref,
        c_ref,
        b_ref,
        x_ref,
        y_ref,
        z_ref,
    })
}

/// The lines of the block between its heading and the closing dashes.
struct Block<'a> {
    lines: Vec<Line<'a>>,
    source: Source<'a>,
}

impl Block<'_> {
    /// The number after a label. Titles are passed over: they may hold anything.
    fn real(&self, name: &str, width: usize) -> Result<f64, AvlError> {
        let line = self.lines.iter().find_map(|line| line.labelled_real(name, width));
        line.unwrap_or_else(|| Err(self.missing(name)))
    }

    /// The whole number after a label.
    fn count(&self, name: &str) -> Result<usize, AvlError> {
        let line = self.lines.iter().find_map(|line| line.labelled_integer(name, 4));
        line.unwrap_or_else(|| Err(self.missing(name)))
    }

    fn missing(&self, name: &str) -> AvlError {
        let line = self.lines.first().map_or(0, |l| l.number);
        AvlError::Missing {
            file: self.source.file.to_owned(),
            line,
            field: name.to_owned(),
            cure: "the block of total forces was edited or cut: write the file again",
        }
    }
}

/// Text layout, all versions: fields are found by their labels.
fn read_text(source: &mut Source<'_>) -> Result<RunState, AvlError> {
    let heading = source.find("Vortex Lattice Output")?;
    let mut state = RunState::default();
    let mut block = Block {
        lines: Vec::new(),
        source: source.clone(),
    };
    loop {
        let line = source.require("the line of dashes that ends the total forces")?;
        let text = line.text.trim_start();
        if line.is_rule() {
            break;
        } else if let Some(title) = text.strip_prefix("Configuration:") {
            state.title = title.trim().to_owned();
        } else if let Some(title) = text.strip_prefix("Run case:") {
            state.run_case = title.trim().to_owned();
        } else {
            block.lines.push(line);
        }
    }
    state.axes = (block.lines.iter().find_map(|l| AxisOrientation::of(l.text))).ok_or_else(|| {
        heading.syntax("`Standard axis orientation, ...` or `Geometric ...` below this line")
    })?;
    state.n_surfaces = block.count("# Surfaces")?;
    state.n_strips = block.count("# Strips")?;
    state.n_vortices = block.count("# Vortices")?;
    state.reference = Reference {
        s_ref: block.real("Sref", 12)?,
        c_ref: block.real("Cref", 12)?,
        b_ref: block.real("Bref", 12)?,
        x_ref: block.real("Xref", 12)?,
        y_ref: block.real("Yref", 12)?,
        z_ref: block.real("Zref", 12)?,
    };
    let labels = state.labels();
    for (label, value) in labels {
        *value = block.real(label, 10)?;
    }
    // Below the Trefftz plane's `e`: blank, controls, blank, design variables.
    let tables = block
        .lines
        .iter()
        .position(|l| l.after_label("CYff").is_some())
        .map_or(0, |i| i + 1);
    let mut groups: Vec<Vec<NamedValue>> = vec![Vec::new()];
    for line in block.lines.iter().skip(tables).skip(1) {
        if line.is_blank() {
            groups.push(Vec::new());
        } else if let Some(group) = groups.last_mut() {
            group.push(read_deflection(line)?);
        }
    }
    let mut groups = groups.into_iter();
    state.controls = groups.next().unwrap_or_default();
    state.designs = groups.flatten().collect();
    Ok(state)
}

/// `   elevator        =  -0.01128`.
fn read_deflection(line: &Line<'_>) -> Result<NamedValue, AvlError> {
    let Some(equals) = line.text.rfind('=') else {
        return Err(line.syntax("a control and its deflection, as in `   elevator        =   0.00000`"));
    };
    let name = line.text.get(..equals).unwrap_or("").trim().to_owned();
    let value = line.parse_real(line.text.get(equals + 1..).unwrap_or(""), equals + 1, &name)?;
    Ok(NamedValue { name, value })
}

/// Machine-readable form.
fn read_mrf(source: &mut Source<'_>) -> Result<RunState, AvlError> {
    mrf::opening(source)?;
    source.require("`Vortex Lattice Output -- Total Forces`")?;
    let mut state = RunState {
        title: source.require("the title")?.text.trim().to_owned(),
        ..Default::default()
    };
    state.n_surfaces = mrf::count(source, "# surfaces")?;
    state.n_strips = mrf::count(source, "# strips")?;
    state.n_vortices = mrf::count(source, "# vortices")?;
    while source.peek().is_some_and(|l| l.text.contains("Symmetry:")) {
        source.read();
    }
    state.reference = mrf::reference(source)?;
    state.axes = mrf::axes(source)?;
    state.run_case = source.require("the run case")?.text.trim().to_owned();
    let mut read = |label, names: &[&'static str]| -> Result<(), AvlError> {
        let line = mrf::labelled(source, label)?;
        for (k, name) in names.iter().enumerate() {
            let value = mrf::real(&line, 23 * k, name)?;
            for (label, target) in state.labels() {
                if label == *name {
                    *target = value;
                }
            }
        }
        Ok(())
    };
    read("Alpha, pb/2V, p'b/2V", &["Alpha", "pb/2V", "p'b/2V"])?;
    read("Beta, qc/2V", &["Beta", "qc/2V"])?;
    read("Mach, rb/2V, r'b/2V", &["Mach", "rb/2V", "r'b/2V"])?;
    read("CXtot, Cltot, Cl'tot", &["CXtot", "Cltot", "Cl'tot"])?;
    read("CYtot, Cmtot", &["CYtot", "Cmtot"])?;
    read("CZtot, Cntot, Cn'tot", &["CZtot", "Cntot", "Cn'tot"])?;
    read("CLtot", &["CLtot"])?;
    read("CDtot", &["CDtot"])?;
    read("CDvis, CDind", &["CDvis", "CDind"])?;
    read("CLff, CDff, CYff, e", &["CLff", "CDff", "CYff", "e"])?;
    state.controls = read_mrf_values(source, "CONTROL")?;
    state.designs = read_mrf_values(source, "DESIGN")?;
    Ok(state)
}

/// `CONTROL`, their number, then value and name of each.
fn read_mrf_values(source: &mut Source<'_>, heading: &str) -> Result<Vec<NamedValue>, AvlError> {
    mrf::word(source, heading)?;
    let line = source.require("the number of controls")?;
    let count = line.parse_integer(line.text, 0, heading)?;
    let mut out = Vec::new();
    for _ in 0..count {
        let line = source.require("a control and its deflection")?;
        let name = crate::source::columns(line.text, 23, 256).trim().to_owned();
        out.push(NamedValue {
            value: mrf::real(&line, 0, &name)?,
            name,
        });
    }
    Ok(out)
}

impl RunState {
    /// AVL's labels of the condition and the totals, each with its place here.
    fn labels(&mut self) -> [(&'static str, &mut f64); 24] {
        [
            ("Alpha", &mut self.alpha_deg),
            ("pb/2V", &mut self.pb_2v),
            ("p'b/2V", &mut self.pb_2v_stability),
            ("Beta", &mut self.beta_deg),
            ("qc/2V", &mut self.qc_2v),
            ("Mach", &mut self.mach),
            ("rb/2V", &mut self.rb_2v),
            ("r'b/2V", &mut self.rb_2v_stability),
            ("CXtot", &mut self.c_x),
            ("Cltot", &mut self.c_roll),
            ("Cl'tot", &mut self.c_roll_stability),
            ("CYtot", &mut self.c_y),
            ("Cmtot", &mut self.c_m),
            ("CZtot", &mut self.c_z),
            ("Cntot", &mut self.c_n),
            ("Cn'tot", &mut self.c_n_stability),
            ("CLtot", &mut self.c_lift),
            ("CDtot", &mut self.c_drag),
            ("CDvis", &mut self.c_drag_viscous),
            ("CDind", &mut self.c_drag_induced),
            ("CLff", &mut self.c_lift_trefftz),
            ("CDff", &mut self.c_drag_trefftz),
            ("CYff", &mut self.c_y_trefftz),
            ("e", &mut self.span_efficiency),
        ]
    }

    /// Reads an `.ft` file.
    ///
    /// # Errors
    /// [`AvlError::WrongKind`] for another kind of file; [`AvlError::Truncated`], [`AvlError::Number`],
    /// [`AvlError::Overflow`], [`AvlError::NotFinite`], [`AvlError::Syntax`] for a damaged one.
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::TotalForces)?;
        Self::read(&mut source, layout)
    }

    /// Reads the block that also heads `.st` and `.sb`, and leaves the source just behind it.
    pub(crate) fn read(source: &mut Source<'_>, layout: Layout) -> Result<Self, AvlError> {
        match layout {
            Layout::Text => read_text(source),
            Layout::Mrf => read_mrf(source),
        }
    }

    /// Value of the control variable of this name (degrees where the gain is 1).
    pub fn control(&self, name: &str) -> Option<f64> {
        self.controls.iter().find(|c| c.name == name).map(|c| c.value)
    }
}
