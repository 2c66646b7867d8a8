//! Reader of the geometry file: header, surfaces and bodies.

use super::records::{Record, Records, Style};
use super::{Airfoil, Body, CoreRadii, DragPolar, Geometry, Section, Spacing, Surface};
use crate::error::{AvlError, Diagnostic};
use crate::fortran::is_not_finite;
use crate::source::Line;
use std::collections::BTreeMap;

/// What the keywords now refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Active {
    Nothing,
    Surface,
    Body,
}

/// State of the reader.
pub(super) struct Reader<'a> {
    pub(super) records: Records<'a>,
    pub(super) geometry: Geometry,
    active: Active,
    /// Where each surface starts.
    headings: Vec<Line<'a>>,
    /// Names of all controls, with their places in the order in which they first come.
    pub(super) control_names: BTreeMap<String, usize>,
}

impl Geometry {
    /// Reads a geometry file as AVL does, and more: what AVL would refuse for its form alone, and what its
    /// versions treat differently, is accepted with a remark.
    ///
    /// Keywords are known by their first four letters, in either case. Lines that are no keyword are ignored
    /// with a remark, as AVL does.
    ///
    /// # Errors
    /// [`AvlError::Empty`], [`AvlError::Truncated`] for a file that ends early; [`AvlError::Number`],
    /// [`AvlError::NotFinite`], [`AvlError::Syntax`] for a line that cannot be read, a surface with fewer than
    /// two sections, or both `iYsym` and `YDUPLICATE 0`.
    pub fn parse(text: &str, file: &str) -> Result<(Self, Vec<Diagnostic>), AvlError> {
        let mut records = Records::new(text, file);
        let Some(title) = records.read() else {
            let expected = "the title of an AVL geometry file".to_owned();
            return Err(AvlError::Empty {
                file: file.to_owned(),
                expected,
            });
        };
        let geometry = read_header(&mut records, &title)?;
        let mut reader = Reader {
            records,
            geometry,
            active: Active::Nothing,
            headings: Vec::new(),
            control_names: BTreeMap::new(),
        };
        // The line behind the header is the profile drag if it is a number.
        let mut pending = reader.records.read();
        if let Some(record) = &pending
            && let Some(crate::fortran::Item::Number { value, .. }) =
                crate::fortran::items(record.text).first()
        {
            reader.geometry.cd_p = Some(*value);
            pending = None;
        }
        while let Some(record) = pending.take().or_else(|| reader.records.read()) {
            pending = reader.keyword(&record)?;
        }
        reader.finish()
    }
}

/// Five header lines.
fn read_header(records: &mut Records<'_>, title: &Record<'_>) -> Result<Geometry, AvlError> {
    let mach_line = records.data("header", "the Mach number")?;
    let mach = records.numbers(&mach_line, mach_line.text, "Mach", (1, 1), Style::List)?;
    let mach = mach.first().copied().unwrap_or(0.0);
    if mach != 0.0 {
        let message = "AVL up to 3.35 prints this Mach number and never uses it; set it in OPER > M or in the .run \
                       file";
        records.remark(&mach_line, "Mach", message);
    }
    let symmetry = records.data("header", "iYsym, iZsym, Zsym")?;
    let numbers = records.numbers(&symmetry, symmetry.text, "iYsym iZsym Zsym", (3, 3), Style::List)?;
    let [i_ysym, i_zsym, z_sym] = triple(&numbers);
    if symmetry
        .text
        .split(|c: char| c.is_whitespace() || c == ',')
        .take(2)
        .any(|t| t.contains('.'))
    {
        records.remark(
            &symmetry,
            "iYsym",
            "a decimal point in iYsym or iZsym: AVL stops here with `Read error`",
        );
    }
    let i_ysym = records.whole(&symmetry, "iYsym", i_ysym)?.signum();
    let i_zsym = records.whole(&symmetry, "iZsym", i_zsym)?.signum();
    let lengths = records.data("header", "Sref, Cref, Bref")?;
    let numbers = records.numbers(&lengths, lengths.text, "Sref Cref Bref", (3, 3), Style::List)?;
    let mut reference = triple(&numbers);
    for (value, name) in reference.iter_mut().zip(["Sref", "Cref", "Bref"]) {
        if *value <= 0.0 {
            records.remark(
                &lengths,
                name,
                format!("{name} = {value} is not positive: AVL takes 1, and so do we"),
            );
            *value = 1.0;
        }
    }
    let [s_ref, c_ref, b_ref] = reference;
    let [x_ref, y_ref, z_ref] = records.reals("header", "Xref Yref Zref")?;
    Ok(Geometry {
        title: title.text.to_owned(),
        mach,
        i_ysym,
        i_zsym,
        z_sym,
        s_ref,
        c_ref,
        b_ref,
        x_ref,
        y_ref,
        z_ref,
        cd_p: None,
        core: None,
        surfaces: Vec::new(),
        bodies: Vec::new(),
    })
}

/// The first three of a list that holds three.
fn triple(numbers: &[f64]) -> [f64; 3] {
    match *numbers {
        [a, b, c, ..] => [a, b, c],
        _ => [0.0; 3],
    }
}

impl<'a> Reader<'a> {
    /// Treats one keyword line. Gives back a line that was read too far.
    fn keyword(&mut self, record: &Record<'a>) -> Result<Option<Record<'a>>, AvlError> {
        let keyword: String = record
            .text
            .chars()
            .take(4)
            .collect::<String>()
            .to_ascii_uppercase();
        if record.line.text.starts_with('\t') && keyword.chars().all(|c| c.is_ascii_uppercase()) {
            self.records.remark(
                record,
                &keyword,
                "a tab before the keyword: AVL would ignore the line",
            );
        }
        match keyword.as_str() {
            "SURF" => self.surface(record)?,
            "BODY" => self.body()?,
            "CORE" => self.core(record)?,
            "COMP" | "INDE" | "NOWA" | "NOAL" | "NOLO" | "SECT" | "CDCL"
                if self.active != Active::Surface =>
            {
                self.misplaced(record, &keyword, "no surface is open");
            }
            "YDUP" | "SCAL" | "TRAN" | "ANGL" if self.active == Active::Nothing => {
                self.misplaced(record, &keyword, "no surface or body is open");
            }
            "BFIL" | "BSEC" if self.active != Active::Body => {
                self.misplaced(record, &keyword, "no body is open");
            }
            "NACA" | "AIRF" | "AFIL" | "CLAF" | "CONT" | "DESI" if self.section().is_none() => {
                self.misplaced(record, &keyword, "no section is open");
            }
            "YDUP" => self.y_duplicate(record)?,
            "SCAL" => self.vector(&keyword)?,
            "TRAN" => self.vector(&keyword)?,
            "ANGL" => self.angle(record)?,
            "COMP" | "INDE" => self.component()?,
            "NOWA" | "NOAL" | "NOLO" => self.flag(&keyword),
            "SECT" => self.new_section()?,
            "CDCL" => self.drag_polar(record)?,
            "NACA" => self.naca(record)?,
            "AIRF" => return self.inline_airfoil(record),
            "AFIL" => self.airfoil_file(record)?,
            "CLAF" => self.claf(record)?,
            "CONT" => self.control(record)?,
            "DESI" => self.design(record)?,
            "BFIL" => self.body_file()?,
            "BSEC" => self.body_section(record)?,
            _ => {
                let first = record.text.split_whitespace().next().unwrap_or_default();
                if is_not_finite(first) {
                    let expected = "a keyword, or the number CDp at the end of the header";
                    return Err(record.line.bad_number(first, 0, "line", expected));
                }
                let message = format!(
                    "`{}` is no keyword: ignored, as AVL does",
                    crate::source::excerpt(record.text)
                );
                self.records.remark(record, "line", message);
            }
        }
        Ok(None)
    }

    fn misplaced(&mut self, record: &Record<'a>, keyword: &str, why: &str) {
        self.records.remark(
            record,
            keyword,
            format!("misplaced: {why}; the line is ignored, as AVL does"),
        );
    }

    /// The open surface.
    fn open_surface(&mut self) -> Option<&mut Surface> {
        if self.active == Active::Surface {
            self.geometry.surfaces.last_mut()
        } else {
            None
        }
    }

    /// The open body.
    fn open_body(&mut self) -> Option<&mut Body> {
        if self.active == Active::Body {
            self.geometry.bodies.last_mut()
        } else {
            None
        }
    }

    /// The open section.
    pub(super) fn section(&mut self) -> Option<&mut Section> {
        self.open_surface()?.sections.last_mut()
    }

    /// `SURFACE`: name; `Nchord Cspace [Nspan Sspace]`.
    fn surface(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let name = self.records.require("the surface's name")?;
        if name.text.contains('#') {
            self.records.remark(
                &name,
                "SURFACE",
                "what follows `#` is part of the name: only `!` starts a comment",
            );
        }
        let line = self.records.data("SURFACE", "Nchord Cspace [Nspan Sspace]")?;
        let numbers = self.records.numbers(
            &line,
            line.text,
            "Nchord Cspace Nspan Sspace",
            (2, 4),
            Style::Words,
        )?;
        let [n_chord, c_space] = [0, 1].map(|i| numbers.get(i).copied().unwrap_or(0.0));
        let spanwise = match (numbers.get(2), numbers.get(3)) {
            (Some(&n), Some(&distribution)) => {
                let count = Records::count(&line, "Nspan", n)?;
                // Zero is how some tools say "from the sections".
                (count > 0).then_some(Spacing { count, distribution })
            }
            (Some(_), None) => {
                self.records
                    .remark(&line, "SURFACE", "Nspan without Sspace: AVL takes neither");
                None
            }
            _ => None,
        };
        self.geometry.surfaces.push(Surface {
            name: name.text.to_owned(),
            n_chord: Records::count(&line, "Nchord", n_chord)?,
            c_space,
            spanwise,
            component: None,
            y_duplicate: None,
            scale: [1.0; 3],
            translate: [0.0; 3],
            angle_deg: 0.0,
            no_wake: false,
            no_albe: false,
            no_load: false,
            cdcl: None,
            sections: Vec::new(),
        });
        self.headings.push(record.line);
        self.active = Active::Surface;
        Ok(())
    }

    /// `BODY`: name; `Nbody Bspace`.
    fn body(&mut self) -> Result<(), AvlError> {
        let name = self.records.require("the body's name")?;
        let line = self.records.data("BODY", "Nbody Bspace")?;
        let numbers = self
            .records
            .numbers(&line, line.text, "Nbody Bspace", (2, 2), Style::List)?;
        let [count, distribution] = [0, 1].map(|i| numbers.get(i).copied().unwrap_or(0.0));
        let spacing = Spacing {
            count: Records::count(&line, "Nbody", count)?,
            distribution,
        };
        self.geometry.bodies.push(Body {
            name: name.text.to_owned(),
            spacing,
            y_duplicate: None,
            scale: [1.0; 3],
            translate: [0.0; 3],
            file: None,
            sections: Vec::new(),
        });
        self.active = Active::Body;
        Ok(())
    }

    /// `CORE`: core radii of AVL 3.5x.
    fn core(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let [chord_fraction, width_fraction, source_fraction] =
            self.records.reals("CORE", "VRCOREC VRCOREW SRCORE")?;
        self.geometry.core = Some(CoreRadii {
            chord_fraction,
            width_fraction,
            source_fraction,
        });
        self.records.remark(
            record,
            "CORE",
            "AVL before 3.5x ignores this keyword and the line of numbers below it",
        );
        Ok(())
    }

    fn y_duplicate(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let [y] = self.records.reals("YDUPLICATE", "Ydupl")?;
        if self.geometry.i_ysym != 0 && y == 0.0 {
            return Err(record
                .line
                .syntax("either iYsym or YDUPLICATE at y = 0, not both: AVL stops here"));
        }
        if let Some(surface) = self.open_surface() {
            surface.y_duplicate = Some(y);
        } else if let Some(body) = self.open_body() {
            body.y_duplicate = Some(y);
        }
        Ok(())
    }

    /// `SCALE` or `TRANSLATE` of a surface or body.
    fn vector(&mut self, keyword: &str) -> Result<(), AvlError> {
        let is_scale = keyword == "SCAL";
        let (name, numbers) = if is_scale {
            ("SCALE", "Xscale Yscale Zscale")
        } else {
            ("TRANSLATE", "dX dY dZ")
        };
        let vector = self.records.reals(name, numbers)?;
        if let Some(surface) = self.open_surface() {
            *(if is_scale {
                &mut surface.scale
            } else {
                &mut surface.translate
            }) = vector;
        } else if let Some(body) = self.open_body() {
            *(if is_scale {
                &mut body.scale
            } else {
                &mut body.translate
            }) = vector;
        }
        Ok(())
    }

    fn angle(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let [angle_deg] = self.records.reals("ANGLE", "dAinc")?;
        match self.open_surface() {
            Some(surface) => surface.angle_deg = angle_deg,
            None => self
                .records
                .remark(record, "ANGLE", "bodies have no incidence: ignored"),
        }
        Ok(())
    }

    fn component(&mut self) -> Result<(), AvlError> {
        let line = self.records.data("COMPONENT", "Lcomp")?;
        let numbers = self
            .records
            .numbers(&line, line.text, "Lcomp", (1, 1), Style::List)?;
        let value = numbers.first().copied().unwrap_or(0.0);
        let component = self.records.whole(&line, "Lcomp", value)?;
        if let Some(surface) = self.open_surface() {
            surface.component = Some(component);
        }
        Ok(())
    }

    fn flag(&mut self, keyword: &str) {
        if let Some(surface) = self.open_surface() {
            match keyword {
                "NOWA" => surface.no_wake = true,
                "NOAL" => surface.no_albe = true,
                _ => surface.no_load = true,
            }
        }
    }

    /// `SECTION`: `Xle Yle Zle Chord Ainc [Nspan Sspace]`. It starts as a flat plate without controls.
    fn new_section(&mut self) -> Result<(), AvlError> {
        const NAMES: &str = "Xle Yle Zle Chord Ainc Nspan Sspace";
        let line = self.records.data("SECTION", NAMES)?;
        let numbers = self
            .records
            .numbers(&line, line.text, NAMES, (5, 7), Style::Words)?;
        let value = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
        let spanwise = match (numbers.get(5), numbers.get(6)) {
            (Some(&n), Some(&distribution)) => {
                let count = Records::count(&line, "Nspan", n)?;
                (count > 0).then_some(Spacing { count, distribution })
            }
            (Some(_), None) => {
                self.records
                    .remark(&line, "SECTION", "Nspan without Sspace: AVL takes neither");
                None
            }
            _ => None,
        };
        let section = Section {
            x_le: value(0),
            y_le: value(1),
            z_le: value(2),
            chord: value(3),
            a_inc_deg: value(4),
            spanwise,
            airfoil: Airfoil::Flat,
            claf: 1.0,
            cdcl: None,
            controls: Vec::new(),
            designs: Vec::new(),
        };
        if let Some(surface) = self.open_surface() {
            surface.sections.push(section);
        }
        Ok(())
    }

    /// `CDCL` of the open section, or of the whole surface before its first section.
    fn drag_polar(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let [cl1, cd1, cl2, cd2, cl3, cd3] = self.records.reals("CDCL", "CL1 CD1 CL2 CD2 CL3 CD3")?;
        let mut points = [(cl1, cd1), (cl2, cd2), (cl3, cd3)];
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let polar = Some(DragPolar {
            cl: points.map(|p| p.0),
            cd: points.map(|p| p.1),
        });
        if let Some(section) = self.section() {
            section.cdcl = polar;
        } else if let Some(surface) = self.open_surface() {
            surface.cdcl = polar;
            let message = "CDCL before the first SECTION holds for the whole surface since AVL 3.40; before, AVL \
                           ignored it and its line of numbers";
            self.records.remark(record, "CDCL", message);
        }
        Ok(())
    }

    fn body_file(&mut self) -> Result<(), AvlError> {
        let line = self.records.require("the name of the body's shape file")?;
        let name = super::section::unquoted(&line, line.text)?.0;
        if let Some(body) = self.open_body() {
            body.file = Some(name);
        }
        Ok(())
    }

    /// `BSECTION`: centre, radius, and the half-height where the section is an ellipse.
    fn body_section(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let line = self.records.data("BSECTION", "Xc Yc Zc Radius")?;
        let numbers = self
            .records
            .numbers(&line, line.text, "Xc Yc Zc Radius", (4, 5), Style::Words)?;
        if let [x, y, z, radius_y, ref rest @ ..] = *numbers.as_slice() {
            let radius_z = rest.first().copied().unwrap_or(radius_y);
            if let Some(body) = self.open_body() {
                body.sections.push(super::BodySection {
                    centre: [x, y, z],
                    radius_y,
                    radius_z,
                });
            }
        }
        let message = "body sections are for AVL 3.5x; older versions take the shape from BFILE";
        self.records.remark(record, "BSECTION", message);
        Ok(())
    }

    /// Checks that need the whole file.
    fn finish(mut self) -> Result<(Geometry, Vec<Diagnostic>), AvlError> {
        for (surface, heading) in self.geometry.surfaces.iter().zip(&self.headings) {
            if surface.sections.len() < 2 {
                let found = surface.sections.len();
                return Err(heading.syntax(format!(
                    "two sections or more in surface `{}`, found {found}: AVL stops here",
                    surface.name
                )));
            }
            let inner = surface.sections.iter().rev().skip(1);
            if surface.spanwise.is_none() && inner.clone().any(|s| s.spanwise.is_none()) {
                let message = format!(
                    "surface `{}` gives no spanwise spacing, and neither do all its sections but the last",
                    surface.name
                );
                self.records
                    .diagnostics
                    .push(heading.diagnostic("SURFACE", message));
            }
            for (i, section) in surface.sections.iter().enumerate() {
                for control in &section.controls {
                    let declares = |k: Option<usize>| {
                        k.and_then(|k| surface.sections.get(k))
                            .is_some_and(|s| s.controls.iter().any(|c| c.name == control.name))
                    };
                    if !declares(i.checked_sub(1)) && !declares(Some(i + 1)) {
                        let message = format!(
                            "control `{}` of section {} of surface `{}` moves nothing: the section before or \
                             behind must declare it too",
                            control.name,
                            i + 1,
                            surface.name
                        );
                        self.records
                            .diagnostics
                            .push(heading.diagnostic("CONTROL", message));
                    }
                }
            }
        }
        let mut diagnostics = self.records.diagnostics;
        diagnostics.sort_by_key(|d| d.at.line);
        Ok((self.geometry, diagnostics))
    }
}
