//! Writers of `.ft`, `.st` and `.fs` in the text layout of AVL 3.52, column for column.
//!
//! A file that AVL 3.52 wrote is reproduced byte for byte, but for what is not stored: the leading blanks of
//! titles (AVL's own `-unnamed-` keeps its one). Titles and surface names longer than AVL's fields are cut, as
//! AVL does.

use std::fmt::Write as _;

use super::{
    AxisOrientation, Coefficient, NamedColumn, NamedValue, Reference, RunState, StabilityColumn,
    StabilityDerivatives, Strip, StripForces, StripSurface,
};
use crate::error::AvlError;
use crate::fortran::{fixed, general, integer};

const CURE: &str = "check the reference area, the lengths and the units: AVL would print stars here";

/// `Fw.d`, with the format's name for the error.
fn f(field: &str, value: f64, width: usize, decimals: usize) -> Result<String, AvlError> {
    let format = match (width, decimals) {
        (10, 3) => "F10.3",
        (10, 4) => "F10.4",
        (10, 5) => "F10.5",
        (10, 7) => "F10.7",
        (11, 6) => "F11.6",
        (12, 6) => "F12.6",
        (8, 3) => "F8.3",
        _ => "F8.4",
    };
    let text = fixed(value, width, decimals);
    text.ok_or_else(|| AvlError::DoesNotFit {
        field: field.to_owned(),
        value,
        format,
        cure: CURE,
    })
}

/// `G12.5`.
fn g(field: &str, value: f64) -> Result<String, AvlError> {
    let text = general(value, 12, 5);
    text.ok_or_else(|| AvlError::DoesNotFit {
        field: field.to_owned(),
        value,
        format: "G12.5",
        cure: CURE,
    })
}

/// `Iw`.
fn i(field: &str, value: usize, width: usize) -> Result<String, AvlError> {
    let format = match width {
        2 => "I2",
        3 => "I3",
        _ => "I4",
    };
    integer(value, width).ok_or_else(|| AvlError::DoesNotFit {
        field: field.to_owned(),
        value: value as f64,
        format,
        cure: "AVL's own field is no wider",
    })
}

/// A text cut and filled to its field.
fn a(field: &str, text: &str, width: usize) -> Result<String, AvlError> {
    if text.contains(['\n', '\r']) {
        let (field, text) = (field.to_owned(), text.to_owned());
        return Err(AvlError::BadText {
            field,
            text,
            reason: "contains a line end",
        });
    }
    let cut: String = text.chars().take(width).collect();
    Ok(format!("{cut:<width$}"))
}

/// Line of dashes.
fn rule(out: &mut String) {
    let _ = writeln!(out, " {}", "-".repeat(63));
}

impl AxisOrientation {
    /// As AVL prints it, in 50 columns.
    fn text(self) -> String {
        let text = match self {
            Self::Standard => "Standard axis orientation,  X fwd, Z down",
            Self::Geometric => "Geometric axis orientation,  X aft, Z up",
        };
        format!("{text:<50}")
    }
}

/// The two lines of reference lengths and moment point.
fn write_reference(out: &mut String, r: &Reference) -> Result<(), AvlError> {
    let (s_ref, c_ref, b_ref) = (g("Sref", r.s_ref)?, g("Cref", r.c_ref)?, g("Bref", r.b_ref)?);
    let _ = writeln!(out, "\n  Sref ={s_ref}   Cref ={c_ref}   Bref ={b_ref}");
    let (x_ref, y_ref, z_ref) = (g("Xref", r.x_ref)?, g("Yref", r.y_ref)?, g("Zref", r.z_ref)?);
    let _ = writeln!(out, "  Xref ={x_ref}   Yref ={y_ref}   Zref ={z_ref}");
    Ok(())
}

impl RunState {
    /// The text of an `.ft` file, as AVL 3.52 writes it.
    ///
    /// # Errors
    /// [`AvlError::DoesNotFit`] where AVL would print stars; [`AvlError::BadText`] for a title with a line end.
    pub fn to_text(&self) -> Result<String, AvlError> {
        let mut out = String::new();
        rule(&mut out);
        let _ = writeln!(out, " Vortex Lattice Output -- Total Forces");
        let _ = writeln!(out, "\n Configuration: {}", a("Configuration", &self.title, 60)?);
        let _ = writeln!(out, "     # Surfaces ={}", i("# Surfaces", self.n_surfaces, 4)?);
        let _ = writeln!(out, "     # Strips   ={}", i("# Strips", self.n_strips, 4)?);
        let _ = writeln!(out, "     # Vortices ={}", i("# Vortices", self.n_vortices, 4)?);
        write_reference(&mut out, &self.reference)?;
        let _ = writeln!(out, "\n {}", self.axes.text());
        // AVL's own title of a run case without one starts with a blank.
        let blank = if self.run_case.starts_with("-unnamed-") {
            " "
        } else {
            ""
        };
        let _ = writeln!(
            out,
            "\n Run case: {}",
            a("Run case", &format!("{blank}{}", self.run_case), 40)?
        );
        self.write_condition(&mut out)?;
        self.write_forces(&mut out)?;
        for values in [&self.controls, &self.designs] {
            out.push('\n');
            for NamedValue { name, value } in values {
                if name.chars().count() > 16 {
                    let (field, text) = ("control".to_owned(), name.clone());
                    return Err(AvlError::BadText {
                        field,
                        text,
                        reason: "is longer than 16 characters",
                    });
                }
                let _ = writeln!(out, "   {}={}", a("control", name, 16)?, f(name, *value, 10, 5)?);
            }
        }
        rule(&mut out);
        Ok(out)
    }

    fn write_condition(&self, out: &mut String) -> Result<(), AvlError> {
        let five = |name, value| f(name, value, 10, 5);
        let (alpha, p, p_s) = (
            five("Alpha", self.alpha_deg)?,
            five("pb/2V", self.pb_2v)?,
            five("p'b/2V", self.pb_2v_stability)?,
        );
        let _ = writeln!(out, "\n  Alpha ={alpha}     pb/2V ={p}     p'b/2V ={p_s}");
        let _ = writeln!(
            out,
            "  Beta  ={}     qc/2V ={}",
            five("Beta", self.beta_deg)?,
            five("qc/2V", self.qc_2v)?
        );
        let (mach, r, r_s) = (
            f("Mach", self.mach, 10, 3)?,
            five("rb/2V", self.rb_2v)?,
            five("r'b/2V", self.rb_2v_stability)?,
        );
        let _ = writeln!(out, "  Mach  ={mach}     rb/2V ={r}     r'b/2V ={r_s}");
        Ok(())
    }

    fn write_forces(&self, out: &mut String) -> Result<(), AvlError> {
        let five = |name, value| f(name, value, 10, 5);
        let seven = |name, value| f(name, value, 10, 7);
        let (x, l, l_s) = (
            five("CXtot", self.c_x)?,
            five("Cltot", self.c_roll)?,
            five("Cl'tot", self.c_roll_stability)?,
        );
        let _ = writeln!(out, "\n  CXtot ={x}     Cltot ={l}     Cl'tot ={l_s}");
        let _ = writeln!(
            out,
            "  CYtot ={}     Cmtot ={}",
            five("CYtot", self.c_y)?,
            five("Cmtot", self.c_m)?
        );
        let (z, n, n_s) = (
            five("CZtot", self.c_z)?,
            five("Cntot", self.c_n)?,
            five("Cn'tot", self.c_n_stability)?,
        );
        let _ = writeln!(out, "  CZtot ={z}     Cntot ={n}     Cn'tot ={n_s}");
        let _ = writeln!(out, "\n  CLtot ={}", five("CLtot", self.c_lift)?);
        let _ = writeln!(out, "  CDtot ={}", five("CDtot", self.c_drag)?);
        let (viscous, induced) = (
            five("CDvis", self.c_drag_viscous)?,
            seven("CDind", self.c_drag_induced)?,
        );
        let _ = writeln!(out, "  CDvis ={viscous}     CDind ={induced}");
        let (lift, drag) = (
            five("CLff", self.c_lift_trefftz)?,
            seven("CDff", self.c_drag_trefftz)?,
        );
        let _ = writeln!(out, "  CLff  ={lift}     CDff  ={drag}    | Trefftz");
        let (side, e) = (
            five("CYff", self.c_y_trefftz)?,
            f("e", self.span_efficiency, 10, 4)?,
        );
        let _ = writeln!(out, "  CYff  ={side}         e ={e}    | Plane  ");
        Ok(())
    }
}

/// Rows of the `.st` table: label, coefficient, prefix of its names.
const ROWS: [(&str, Coefficient, &str); 8] = [
    (" z' force CL |", Coefficient::Lift, "CL"),
    (" y  force CY |", Coefficient::SideForce, "CY"),
    (" x  force CD |", Coefficient::Drag, "CD"),
    (" x' mom.  Cl'|", Coefficient::Roll, "Cl"),
    (" y  mom.  Cm |", Coefficient::Pitch, "Cm"),
    (" z' mom.  Cn'|", Coefficient::Yaw, "Cn"),
    (" Trefftz drag|", Coefficient::TrefftzDrag, "CDff"),
    (" span eff.   |", Coefficient::SpanEfficiency, "e"),
];

impl StabilityDerivatives {
    /// The text of an `.st` file, as AVL 3.52 writes it. A row that a column lacks is left out in its set.
    ///
    /// # Errors
    /// As [`RunState::to_text`]; [`AvlError::BadText`] when the columns do not belong to the controls and design
    /// variables of [`StabilityDerivatives::run`].
    pub fn to_text(&self) -> Result<String, AvlError> {
        check_names(&self.run.controls, &self.controls)?;
        check_names(&self.run.designs, &self.designs)?;
        let mut out = self.run.to_text()?;
        let _ = writeln!(out, "\n Stability-axis derivatives...");
        let dashes = "    ----------------";
        let indent = " ".repeat(14);
        let angles = [("a", &self.alpha), ("b", &self.beta)];
        let _ = writeln!(
            out,
            "\n{indent}               alpha                beta\n{indent}{dashes}{dashes}"
        );
        write_rows(&mut out, &angles.map(|(s, c)| (s.to_owned(), c)))?;
        let rates = [
            ("p", &self.roll_rate),
            ("q", &self.pitch_rate),
            ("r", &self.yaw_rate),
        ];
        let _ = writeln!(
            out,
            "\n{indent}       roll rate  p'      pitch rate  q'        yaw rate  r'\n{indent}{dashes}{dashes}{dashes}"
        );
        write_rows(&mut out, &rates.map(|(s, c)| (s.to_owned(), c)))?;
        for (columns, letter) in [(&self.controls, 'd'), (&self.designs, 'g')] {
            if columns.is_empty() {
                continue;
            }
            let _ = write!(out, "\n{indent}");
            for (k, column) in columns.iter().enumerate() {
                let _ = write!(
                    out,
                    "    {} {letter}{:02} ",
                    a("control", &column.name, 12)?,
                    k + 1
                );
            }
            let _ = writeln!(out, "\n{indent}{}", dashes.repeat(columns.len()));
            let columns: Vec<(String, &StabilityColumn)> = columns
                .iter()
                .enumerate()
                .map(|(k, c)| (format!("{letter}{:02}", k + 1), &c.column))
                .collect();
            write_rows(&mut out, &columns)?;
            out.push_str("\n\n");
        }
        if let Some(x) = self.neutral_point_x {
            let _ = writeln!(out, "\n Neutral point  Xnp ={}", f("Xnp", x, 11, 6)?);
        }
        if let Some(ratio) = self.spiral_ratio {
            let ratio = f("Clb Cnr / Clr Cnb", ratio, 11, 6)?;
            let _ = writeln!(
                out,
                "\n Clb Cnr / Clr Cnb  ={ratio}    (  > 1 if spirally stable )"
            );
        }
        Ok(out)
    }
}

/// The reader names columns by the block of totals: both must agree.
fn check_names(values: &[NamedValue], columns: &[NamedColumn<StabilityColumn>]) -> Result<(), AvlError> {
    let values: Vec<&str> = values.iter().map(|v| v.name.as_str()).collect();
    let columns: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    if values == columns {
        return Ok(());
    }
    Err(AvlError::BadText {
        field: "controls".to_owned(),
        text: columns.join(" "),
        reason: "are not the controls or design variables of the run state",
    })
}

/// One set of columns, each with the last letters of its names. Only full rows are written.
fn write_rows(out: &mut String, columns: &[(String, &StabilityColumn)]) -> Result<(), AvlError> {
    for (label, coefficient, prefix) in ROWS {
        let values: Option<Vec<f64>> = columns.iter().map(|(_, c)| c.get(coefficient)).collect();
        let Some(values) = values else { continue };
        out.push_str(label);
        for ((suffix, _), value) in columns.iter().zip(values) {
            let name = format!("{prefix}{suffix}");
            // Names end in column 8 of their field.
            let _ = write!(
                out,
                "{name:>width$} ={}",
                f(&name, value, 11, 6)?,
                width = if suffix.len() == 1 { 7 } else { 8 }
            );
        }
        out.push('\n');
    }
    Ok(())
}

impl StripForces {
    /// The text of an `.fs` file, as AVL 3.52 writes it.
    ///
    /// # Errors
    /// As [`RunState::to_text`]. Files of AVL up to 3.35 lack reference lengths, x and z: they are refused with
    /// [`AvlError::BadText`].
    pub fn to_text(&self) -> Result<String, AvlError> {
        let Some(reference) = &self.reference else {
            return Err(lacks("Sref"));
        };
        let mut out = String::new();
        rule(&mut out);
        let _ = writeln!(out, " Surface and Strip Forces by surface");
        write_reference(&mut out, reference)?;
        for surface in &self.surfaces {
            surface.write(&mut out, self.axes)?;
        }
        rule(&mut out);
        Ok(out)
    }
}

/// A value that the layout needs and the data lack.
fn lacks(field: &str) -> AvlError {
    AvlError::BadText {
        field: field.to_owned(),
        text: String::new(),
        reason: "is not known, but this layout needs it",
    }
}

impl StripSurface {
    fn write(&self, out: &mut String, axes: AxisOrientation) -> Result<(), AvlError> {
        let index = i("Surface #", self.index, 2)?;
        let _ = writeln!(out, "\n  Surface #{index}     {}", a("Surface", &self.name, 40)?);
        let (n_chord, n_span) = (
            i("# Chordwise", self.n_chord, 3)?,
            i("# Spanwise", self.n_span, 3)?,
        );
        let first = i("First strip", self.first_strip, 3)?;
        let _ = writeln!(
            out,
            "     # Chordwise ={n_chord}   # Spanwise ={n_span}     First strip ={first}"
        );
        let (area, chord) = (
            f("Surface area Ssurf", self.area, 12, 6)?,
            f("Ave. chord Cave", self.average_chord, 12, 6)?,
        );
        let _ = writeln!(
            out,
            "     Surface area Ssurf ={area}     Ave. chord Cave ={chord}"
        );
        let _ = writeln!(
            out,
            "\n Forces referred to Sref, Cref, Bref about Xref, Yref, Zref\n {}",
            axes.text()
        );
        let c = &self.coefficients;
        let pairs = [
            ("CLsurf  ", c.c_lift, "Clsurf  ", c.c_roll),
            ("CYsurf  ", c.c_y, "Cmsurf  ", c.c_m),
            ("CDsurf  ", c.c_drag, "Cnsurf  ", c.c_n),
            ("CDisurf ", c.c_drag_induced, "CDvsurf ", c.c_drag_viscous),
        ];
        for (left, x, right, y) in pairs {
            let _ = writeln!(
                out,
                "     {left}={}     {right}={}",
                f(left, x, 10, 5)?,
                f(right, y, 10, 5)?
            );
        }
        let (cl, cd) = (f("CLsurf", c.cl_local, 10, 5)?, f("CDsurf", c.cd_local, 10, 5)?);
        let _ = writeln!(
            out,
            "\n Forces referred to Ssurf, Cave \n     CLsurf  ={cl}     CDsurf  ={cd}"
        );
        out.push_str("\n Strip Forces referred to Strip Area, Chord\n");
        out.push_str(
            "    j     Xle      Yle      Zle      Chord    Area     c_cl     ai     cl_norm    cl       cd       cdv    \
             cm_c/4     cm_LE   C.P.x/c\n",
        );
        self.strips.iter().try_for_each(|strip| strip.write(out))
    }
}

impl Strip {
    fn write(&self, out: &mut String) -> Result<(), AvlError> {
        let _ = write!(out, "  {}", i("j", self.index, 4)?);
        let values = [
            ("Xle", self.x_le.ok_or_else(|| lacks("Xle"))?),
            ("Yle", self.y_le),
            ("Zle", self.z_le.ok_or_else(|| lacks("Zle"))?),
            ("Chord", self.chord),
            ("Area", self.area),
            ("c_cl", self.c_cl),
            ("ai", self.ai),
            ("cl_norm", self.cl_norm),
            ("cl", self.cl),
            ("cd", self.cd),
            ("cdv", self.cdv),
            ("cm_c/4", self.cm_c4),
            ("cm_LE", self.cm_le.ok_or_else(|| lacks("cm_LE"))?),
        ];
        for (name, value) in values {
            let _ = write!(out, " {}", f(name, value, 8, 4)?);
        }
        // AVL prints 999 where the centre of pressure is not defined.
        let xcp = f("C.P.x/c", self.xcp.unwrap_or(999.0), 8, 3)?;
        let _ = writeln!(out, " {xcp}");
        Ok(())
    }
}
