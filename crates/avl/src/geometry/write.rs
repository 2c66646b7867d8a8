//! Writer of the geometry file.

use std::fmt::Write as _;

use super::{Airfoil, Body, DragPolar, Geometry, Section, Spacing, Surface};
use crate::error::AvlError;

/// A name, title or path that stands alone on its line.
fn line<'t>(field: &str, text: &'t str) -> Result<&'t str, AvlError> {
    let reason = if text.is_empty() {
        "is empty: AVL would read the next line in its place"
    } else if text.trim() != text {
        "begins or ends with a blank, which AVL drops"
    } else if text.contains('!') {
        "contains `!`, which starts a comment"
    } else if text.starts_with('#') {
        "begins with `#`, which starts a comment"
    } else if text.contains(['\n', '\r']) {
        "contains a line end"
    } else {
        return Ok(text);
    };
    Err(AvlError::BadText {
        field: field.to_owned(),
        text: text.to_owned(),
        reason,
    })
}

/// A control's or design variable's name: one word.
fn word<'t>(field: &str, text: &'t str) -> Result<&'t str, AvlError> {
    if text.contains(char::is_whitespace) {
        let (field, text) = (field.to_owned(), text.to_owned());
        return Err(AvlError::BadText {
            field,
            text,
            reason: "contains a blank, which ends a name",
        });
    }
    if text.chars().count() > 16 {
        let (field, text) = (field.to_owned(), text.to_owned());
        return Err(AvlError::BadText {
            field,
            text,
            reason: "is longer than 16 characters",
        });
    }
    line(field, text)
}

/// A file name, in quotes if it has blanks.
fn path(field: &str, text: &str) -> Result<String, AvlError> {
    let text = line(field, text)?;
    if text.contains('"') {
        let (field, text) = (field.to_owned(), text.to_owned());
        return Err(AvlError::BadText {
            field,
            text,
            reason: "contains a double quote",
        });
    }
    Ok(if text.contains(char::is_whitespace) {
        format!("\"{text}\"")
    } else {
        text.to_owned()
    })
}

/// Numbers in the shortest form that reads back the same.
fn numbers(field: &'static str, values: &[f64]) -> Result<String, AvlError> {
    let mut out = String::new();
    for &value in values {
        if !value.is_finite() {
            return Err(AvlError::DoesNotFit {
                field: field.to_owned(),
                value,
                format: "list-directed",
                cure: "give a finite number",
            });
        }
        if !out.is_empty() {
            out.push(' ');
        }
        let _ = write!(out, "{value:?}");
    }
    Ok(out)
}

/// Collects the lines.
struct Writer {
    out: String,
}

impl Writer {
    fn line(&mut self, text: impl AsRef<str>) {
        self.out.push_str(text.as_ref());
        self.out.push('\n');
    }
}

impl Geometry {
    /// The text of an `.avl` file that reads back as this geometry. What AVL takes by default is not written.
    ///
    /// # Errors
    /// [`AvlError::BadText`] for a name that AVL would read differently; [`AvlError::DoesNotFit`] for a number
    /// that is not finite.
    pub fn to_text(&self) -> Result<String, AvlError> {
        let mut w = Writer { out: String::new() };
        w.line(line("title", &self.title)?);
        w.line(format!("{}   ! Mach", numbers("Mach", &[self.mach])?));
        let z_sym = numbers("Zsym", &[self.z_sym])?;
        w.line(format!(
            "{} {} {z_sym}   ! iYsym iZsym Zsym",
            self.i_ysym, self.i_zsym
        ));
        w.line(format!(
            "{}   ! Sref Cref Bref",
            numbers("Sref", &[self.s_ref, self.c_ref, self.b_ref])?
        ));
        w.line(format!(
            "{}   ! Xref Yref Zref",
            numbers("Xref", &[self.x_ref, self.y_ref, self.z_ref])?
        ));
        if let Some(cd_p) = self.cd_p {
            w.line(format!("{}   ! CDp", numbers("CDp", &[cd_p])?));
        }
        if let Some(core) = self.core {
            w.line("CORE");
            w.line(numbers(
                "CORE",
                &[core.chord_fraction, core.width_fraction, core.source_fraction],
            )?);
        }
        for surface in &self.surfaces {
            write_surface(&mut w, surface)?;
        }
        for body in &self.bodies {
            write_body(&mut w, body)?;
        }
        Ok(w.out)
    }
}

/// ` 12 1.0`, or nothing.
fn spacing(spacing: Option<Spacing>) -> Result<String, AvlError> {
    spacing.map_or(Ok(String::new()), |s| {
        Ok(format!(" {} {}", s.count, numbers("Sspace", &[s.distribution])?))
    })
}

/// `SCALE`, `TRANSLATE` and `YDUPLICATE` of a surface or body.
fn write_placement(
    w: &mut Writer,
    y_duplicate: Option<f64>,
    scale: [f64; 3],
    translate: [f64; 3],
) -> Result<(), AvlError> {
    if let Some(y) = y_duplicate {
        w.line("YDUPLICATE");
        w.line(numbers("YDUPLICATE", &[y])?);
    }
    if scale != [1.0; 3] {
        w.line("SCALE");
        w.line(numbers("SCALE", &scale)?);
    }
    if translate != [0.0; 3] {
        w.line("TRANSLATE");
        w.line(numbers("TRANSLATE", &translate)?);
    }
    Ok(())
}

fn write_surface(w: &mut Writer, surface: &Surface) -> Result<(), AvlError> {
    w.line("#---------------------------------------");
    w.line("SURFACE");
    w.line(line("SURFACE", &surface.name)?);
    let c_space = numbers("Cspace", &[surface.c_space])?;
    w.line(format!(
        "{} {c_space}{}",
        surface.n_chord,
        spacing(surface.spanwise)?
    ));
    if let Some(component) = surface.component {
        w.line("COMPONENT");
        w.line(component.to_string());
    }
    write_placement(w, surface.y_duplicate, surface.scale, surface.translate)?;
    if surface.angle_deg != 0.0 {
        w.line("ANGLE");
        w.line(numbers("ANGLE", &[surface.angle_deg])?);
    }
    for (flag, keyword) in [
        (surface.no_wake, "NOWAKE"),
        (surface.no_albe, "NOALBE"),
        (surface.no_load, "NOLOAD"),
    ] {
        if flag {
            w.line(keyword);
        }
    }
    write_polar(w, surface.cdcl)?;
    for section in &surface.sections {
        write_section(w, section)?;
    }
    Ok(())
}

fn write_polar(w: &mut Writer, polar: Option<DragPolar>) -> Result<(), AvlError> {
    if let Some(DragPolar {
        cl: [cl1, cl2, cl3],
        cd: [cd1, cd2, cd3],
    }) = polar
    {
        w.line("CDCL");
        w.line(numbers("CDCL", &[cl1, cd1, cl2, cd2, cl3, cd3])?);
    }
    Ok(())
}

/// The keyword, with the x/c range behind it as AVL 3.40 on reads it.
fn with_range(keyword: &str, x_range: Option<[f64; 2]>) -> Result<String, AvlError> {
    x_range.map_or(Ok(keyword.to_owned()), |range| {
        Ok(format!("{keyword} {}", numbers("x/c", &range)?))
    })
}

fn write_section(w: &mut Writer, section: &Section) -> Result<(), AvlError> {
    w.line("SECTION");
    let place = [
        section.x_le,
        section.y_le,
        section.z_le,
        section.chord,
        section.a_inc_deg,
    ];
    w.line(format!(
        "{}{}",
        numbers("SECTION", &place)?,
        spacing(section.spanwise)?
    ));
    match &section.airfoil {
        Airfoil::Flat => {}
        Airfoil::Naca { digits, x_range } => {
            w.line(with_range("NACA", *x_range)?);
            w.line(word("NACA", digits)?);
        }
        Airfoil::Inline { points, x_range } => {
            w.line(with_range("AIRFOIL", *x_range)?);
            for point in points {
                w.line(numbers("AIRFOIL", point)?);
            }
        }
        Airfoil::File { path: name, x_range } => {
            w.line(with_range("AFILE", *x_range)?);
            w.line(path("AFILE", name)?);
        }
    }
    if section.claf != 1.0 {
        w.line("CLAF");
        w.line(numbers("CLAF", &[section.claf])?);
    }
    write_polar(w, section.cdcl)?;
    for control in &section.controls {
        let [x, y, z] = control.hinge_axis;
        w.line("CONTROL");
        let values = numbers(
            "CONTROL",
            &[control.gain, control.x_hinge, x, y, z, control.sgn_dup],
        )?;
        w.line(format!("{} {values}", word("CONTROL", &control.name)?));
    }
    for design in &section.designs {
        w.line("DESIGN");
        w.line(format!(
            "{} {}",
            word("DESIGN", &design.name)?,
            numbers("DESIGN", &[design.weight])?
        ));
    }
    Ok(())
}

fn write_body(w: &mut Writer, body: &Body) -> Result<(), AvlError> {
    w.line("#---------------------------------------");
    w.line("BODY");
    w.line(line("BODY", &body.name)?);
    w.line(spacing(Some(body.spacing))?.trim_start());
    write_placement(w, body.y_duplicate, body.scale, body.translate)?;
    if let Some(name) = &body.file {
        w.line("BFILE");
        w.line(path("BFILE", name)?);
    }
    for section in &body.sections {
        let [x, y, z] = section.centre;
        w.line("BSECTION");
        w.line(numbers(
            "BSECTION",
            &[x, y, z, section.radius_y, section.radius_z],
        )?);
    }
    Ok(())
}
