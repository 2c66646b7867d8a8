//! From the geometry file to the lattice.

use albatross_avl::geometry::{Airfoil, Geometry, Surface};
use albatross_avl::results::Reference;

use super::span::{Interval, intervals};
use super::station::{Bay, Rib, moved_fraction};
use super::{Lattice, LatticeStrip, LatticeSurface, NormalChange, PanelChange, V3, Vortex};
use crate::airfoil::CamberSlope;
use crate::body::LatticeBody;
use crate::error::{Error, Result};
use crate::spacing::{ChordStation, chord_stations};

/// Most vortices of a lattice; AVL's own limit is 5000 or 6000. The influence matrix of as many takes 3.2 GB.
const MOST_VORTICES: usize = 20_000;
/// Most nodes of a body.
const MOST_NODES: usize = 10_000;
/// Most nodes of all bodies, images included: every one of them acts on every vortex.
const MOST_NODES_OF_ALL: usize = 2 * MOST_NODES;
/// Most controls and design variables; AVL's own limit is 30 of each. Every strip asks for every one.
const MOST_VARIABLES: usize = 1000;

/// Text of files that the geometry names: path as written in, text out; `None` where there is no such file.
pub type Files<'f> = dyn Fn(&str) -> Option<String> + 'f;

impl Lattice {
    /// The lattice of a geometry, and remarks on what was passed over.
    ///
    /// `files` gives the text of each `AFILE` and `BFILE`. As in AVL, an aerofoil file that is not there means no
    /// camber, and a remark.
    ///
    /// # Errors
    /// [`Error::NoSurfaces`]; [`Error::Surface`] for sections without chord or distance, or too few strips;
    /// [`Error::Airfoil`]; [`Error::Body`]; [`Error::Value`] for reference lengths that are not positive and for more than
    /// 20 000 vortices, 10 000 nodes of a body, 20 000 of all bodies, or 1000 controls and design variables.
    pub fn new(geometry: &Geometry, files: &Files<'_>) -> Result<(Self, Vec<String>)> {
        check_header(geometry)?;
        check_size(geometry)?;
        let mut remarks = Vec::new();
        let mut lattice = Self {
            title: geometry.title.trim().to_owned(),
            reference: Reference {
                s_ref: geometry.s_ref,
                c_ref: geometry.c_ref,
                b_ref: geometry.b_ref,
                x_ref: geometry.x_ref,
                y_ref: geometry.y_ref,
                z_ref: geometry.z_ref,
            },
            cd_p: geometry.cd_p.unwrap_or(0.0),
            mach: geometry.mach,
            i_ysym: geometry.i_ysym.signum(),
            i_zsym: geometry.i_zsym.signum(),
            z_sym: geometry.z_sym,
            core: geometry.core,
            surfaces: Vec::new(),
            strips: Vec::new(),
            vortices: Vec::new(),
            controls: empty(geometry.control_names()),
            designs: empty(geometry.design_names()),
            bodies: Vec::new(),
        };
        for surface in &geometry.surfaces {
            lattice.add_surface(surface, files, &mut remarks)?;
            match surface.y_duplicate {
                Some(y) if geometry.i_ysym == 0 => lattice.add_image(y, surface),
                Some(_) => remarks.push(format!(
                    "surface \"{}\": YDUPLICATE is passed over, the flow has a plane of symmetry (iYsym)",
                    surface.name.trim()
                )),
                None => {}
            }
        }
        if lattice.vortices.is_empty() {
            return Err(Error::NoSurfaces { title: lattice.title });
        }
        for body in &geometry.bodies {
            if let Some(own) = LatticeBody::new(body, geometry.core, files, &mut remarks)? {
                let image = body.y_duplicate.filter(|_| geometry.i_ysym == 0);
                let image = image.map(|y| own.mirrored(y));
                lattice.bodies.push(own);
                lattice.bodies.extend(image);
            }
        }
        Ok((lattice, remarks))
    }

    fn add_surface(&mut self, surface: &Surface, files: &Files<'_>, remarks: &mut Vec<String>) -> Result<()> {
        let name = surface.name.trim().to_owned();
        let ribs = ribs(surface, files, remarks)?;
        let leading_edges: Vec<V3> = ribs.iter().map(|r| r.leading_edge).collect();
        let first_strip = self.strips.len();
        for interval in intervals(surface, &leading_edges)? {
            let bay = Bay {
                left: &ribs[interval.section],
                right: &ribs[interval.section + 1],
            };
            self.add_strip(surface, &bay, interval);
        }
        let index = self.surfaces.len();
        let strips = first_strip..self.strips.len();
        let area: f64 = self.strips[strips.clone()].iter().map(LatticeStrip::area).sum();
        let width: f64 = self.strips[strips.clone()].iter().map(|s| s.width).sum();
        self.surfaces.push(LatticeSurface {
            name,
            component: surface.component.filter(|&c| c != 0).unwrap_or(index as i32 + 1),
            n_chord: surface.n_chord,
            strips,
            is_image: false,
            no_wake: surface.no_wake,
            no_albe: surface.no_albe,
            no_load: surface.no_load,
            area,
            average_chord: area / width,
        });
        Ok(())
    }

    fn add_strip(&mut self, surface: &Surface, bay: &Bay<'_, '_>, interval: Interval) {
        let Interval {
            from, to, station: f, ..
        } = interval;
        let edges = [bay.leading_edge(from), bay.leading_edge(to)];
        let edge_chords = [bay.chord(from), bay.chord(to)];
        let (leading_edge, chord) = (bay.leading_edge(f), bay.chord(f));
        let along = bay.right.leading_edge - bay.left.leading_edge;
        let span = along.y.hypot(along.z);
        let normal = V3::new(0.0, -along.z / span, along.y / span);
        let incidence_rad = bay.incidence(f);
        let first = self.vortices.len();
        let stations = chord_stations(surface.n_chord, surface.c_space, bay.claf(f));
        for station in &stations {
            let ends = [0, 1].map(|k| edges[k] + V3::new(station.x_vortex * edge_chords[k], 0.0, 0.0));
            let slope = bay.slope(f, station.x_control);
            let (panel_normal, normal_incidence) =
                panel_normal(incidence_rad - slope.atan(), &normal, &(ends[1] - ends[0]));
            self.vortices.push(Vortex {
                strip: self.strips.len(),
                ends,
                force_point: leading_edge + V3::new(station.x_vortex * chord, 0.0, 0.0),
                control_point: leading_edge + V3::new(station.x_control * chord, 0.0, 0.0),
                normal: panel_normal,
                normal_incidence,
                dx: (station.x_rear - station.x_front) * chord,
                slope: bay.slope(f, station.x_vortex),
            });
        }
        self.add_controls(bay, f, first, &stations);
        self.add_designs(bay, f, first);
        self.strips.push(LatticeStrip {
            surface: self.surfaces.len(),
            vortices: first..self.vortices.len(),
            edges,
            edge_chords,
            leading_edge,
            chord,
            width: (to - from).abs() * span,
            incidence_rad,
            normal,
            polar: bay.polar(f),
        });
    }

    fn add_controls(&mut self, bay: &Bay<'_, '_>, f: f64, first: usize, stations: &[ChordStation]) {
        for flap in bay.flaps(f) {
            let Some(change) = self.controls.iter_mut().find(|c| c.name == flap.control.name) else {
                continue;
            };
            for (k, station) in stations.iter().enumerate() {
                let moved = moved_fraction(flap.x_hinge, station.x_front, station.x_rear);
                let fraction = flap.gain * moved;
                if fraction != 0.0 {
                    // The first-order change by a rotation about the hinge; its part along the hinge does not turn.
                    let turned = flap.hinge_axis.cross(&self.vortices[first + k].normal);
                    change.panels.push(PanelChange {
                        vortex: first + k,
                        normal: turned * fraction.to_radians(),
                        fraction,
                        hinge_point: flap.hinge_point,
                        hinge_axis: flap.hinge_axis,
                    });
                }
            }
        }
    }

    fn add_designs(&mut self, bay: &Bay<'_, '_>, f: f64, first: usize) {
        for change in &mut self.designs {
            let rate = bay.incidence_of_design(f, &change.name);
            if rate != 0.0 {
                for (k, vortex) in self.vortices.iter().enumerate().skip(first) {
                    change.panels.push(PanelChange {
                        vortex: k,
                        normal: vortex.normal_incidence * rate,
                        fraction: 0.0,
                        hinge_point: V3::zeros(),
                        hinge_axis: V3::zeros(),
                    });
                }
            }
        }
    }

    /// Mirrors the last surface in the plane y = `y_plane`. Bound vortices keep their direction from left to
    /// right, so equal circulation is symmetric flow.
    fn add_image(&mut self, y_plane: f64, surface: &Surface) {
        let Some(own) = self.surfaces.last().cloned() else {
            return;
        };
        let strip_shift = self.strips.len() - own.strips.start;
        let first_vortex = self.strips[own.strips.start].vortices.start;
        let vortex_shift = self.vortices.len() - first_vortex;
        let point = |p: &V3| V3::new(p.x, 2.0 * y_plane - p.y, p.z);
        let vector = |v: &V3| V3::new(v.x, -v.y, v.z);
        for k in first_vortex..self.vortices.len() {
            let v = self.vortices[k];
            self.vortices.push(Vortex {
                strip: v.strip + strip_shift,
                ends: [point(&v.ends[1]), point(&v.ends[0])],
                force_point: point(&v.force_point),
                control_point: point(&v.control_point),
                normal: vector(&v.normal),
                normal_incidence: vector(&v.normal_incidence),
                ..v
            });
        }
        for k in own.strips.clone() {
            let s = self.strips[k].clone();
            self.strips.push(LatticeStrip {
                surface: s.surface + 1,
                vortices: s.vortices.start + vortex_shift..s.vortices.end + vortex_shift,
                edges: [point(&s.edges[1]), point(&s.edges[0])],
                edge_chords: [s.edge_chords[1], s.edge_chords[0]],
                leading_edge: point(&s.leading_edge),
                normal: vector(&s.normal),
                ..s
            });
        }
        for (is_control, change) in self
            .controls
            .iter_mut()
            .map(|c| (true, c))
            .chain(self.designs.iter_mut().map(|c| (false, c)))
        {
            let sign = if is_control {
                image_sign(surface, &change.name)
            } else {
                1.0
            };
            let own_panels: Vec<PanelChange> = change
                .panels
                .iter()
                .filter(|p| p.vortex >= first_vortex)
                .copied()
                .collect();
            change.panels.extend(own_panels.iter().map(|p| PanelChange {
                vortex: p.vortex + vortex_shift,
                normal: vector(&p.normal) * sign,
                // A mirrored hinge turns the other way.
                fraction: -sign * p.fraction,
                hinge_point: point(&p.hinge_point),
                hinge_axis: vector(&p.hinge_axis),
            }));
        }
        self.surfaces.push(LatticeSurface {
            name: format!("{} (YDUP)", own.name),
            strips: own.strips.start + strip_shift..own.strips.end + strip_shift,
            is_image: true,
            ..own
        });
    }
}

/// Sign of a control's deflection on the image of its surface.
fn image_sign(surface: &Surface, name: &str) -> f64 {
    let controls = surface.sections.iter().flat_map(|s| &s.controls);
    let mut own = controls.filter(|c| c.name == name);
    own.next().map_or(1.0, |c| c.sgn_dup)
}

/// Variables that move nothing yet.
fn empty(names: Vec<&str>) -> Vec<NormalChange> {
    let new = |name: &str| NormalChange {
        name: name.to_owned(),
        panels: Vec::new(),
    };
    names.into_iter().map(new).collect()
}

/// Unit normal of an element whose chord is turned nose up by `angle` about a strip with this normal in the y-z
/// plane, and its derivative with respect to the angle.
fn panel_normal(angle: f64, strip_normal: &V3, bound: &V3) -> (V3, V3) {
    let (s, c) = angle.sin_cos();
    let chordwise = V3::new(c, 0.0, 0.0) - strip_normal * s;
    let d_chordwise = V3::new(-s, 0.0, 0.0) - strip_normal * c;
    let (n, dn) = (chordwise.cross(bound), d_chordwise.cross(bound));
    let length = n.norm();
    let unit = n / length;
    (unit, (dn - unit * unit.dot(&dn)) / length)
}

fn check_header(geometry: &Geometry) -> Result<()> {
    let positive = [
        ("reference area Sref", geometry.s_ref),
        ("reference chord Cref", geometry.c_ref),
        ("reference span Bref", geometry.b_ref),
    ];
    for (what, value) in positive {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::Value {
                what: what.to_owned(),
                value,
                expected: "give a positive one in the header of the geometry file",
            });
        }
    }
    Ok(())
}

/// Refuses numbers of vortices and nodes that no machine could work with, before anything is made of them.
fn check_size(geometry: &Geometry) -> Result<()> {
    let mut total = 0_usize;
    for surface in &geometry.surfaces {
        let by_section = || {
            // The last section has no next one.
            let last = surface.sections.len().saturating_sub(1);
            let counts = surface.sections.iter().take(last).filter_map(|s| s.spanwise);
            counts.fold(0_usize, |sum, s| sum.saturating_add(s.count))
        };
        let strips = surface.spanwise.map_or_else(by_section, |s| s.count);
        let sides = if surface.y_duplicate.is_some() { 2 } else { 1 };
        let own = strips
            .max(1)
            .saturating_mul(surface.n_chord)
            .saturating_mul(sides);
        total = total.saturating_add(own);
        if total > MOST_VORTICES {
            return Err(Error::Value {
                what: format!("the number of vortices up to surface \"{}\"", surface.name.trim()),
                value: total as f64,
                expected: "at most 20000: lower its Nchord or Nspan",
            });
        }
    }
    let variables = geometry.control_names().len() + geometry.design_names().len();
    if variables > MOST_VARIABLES {
        return Err(Error::Value {
            what: "the number of controls and design variables".to_owned(),
            value: variables as f64,
            expected: "at most 1000: give those that move together one name",
        });
    }
    for surface in &geometry.surfaces {
        for (k, section) in surface.sections.iter().enumerate() {
            // Lines that repeat a name are looked through for every strip.
            for (keyword, count) in [
                ("CONTROL", section.controls.len()),
                ("DESIGN", section.designs.len()),
            ] {
                if count > MOST_VARIABLES {
                    return Err(Error::Value {
                        what: format!(
                            "the number of {keyword} lines of surface \"{}\", section {},",
                            surface.name.trim(),
                            k + 1
                        ),
                        value: count as f64,
                        expected: "at most 1000: give each variable one line",
                    });
                }
            }
        }
    }
    let mut nodes = 0_usize;
    for body in &geometry.bodies {
        let own = body.spacing.count;
        if own > MOST_NODES {
            return Err(Error::Value {
                what: format!("Nbody of body \"{}\"", body.name.trim()),
                value: own as f64,
                expected: "at most 10000",
            });
        }
        let sides = if body.y_duplicate.is_some() { 2 } else { 1 };
        nodes = nodes.saturating_add(own.saturating_mul(sides));
        if nodes > MOST_NODES_OF_ALL {
            return Err(Error::Value {
                what: format!("the number of nodes up to body \"{}\"", body.name.trim()),
                value: nodes as f64,
                expected: "at most 20000 of all bodies and images: lower its Nbody",
            });
        }
    }
    Ok(())
}

/// Sections of a surface with scale, translation, incidence, camber and drag polar worked in.
fn ribs<'g>(surface: &'g Surface, files: &Files<'_>, remarks: &mut Vec<String>) -> Result<Vec<Rib<'g>>> {
    let name = surface.name.trim();
    let refuse = |section: usize, problem: String| Error::Surface {
        surface: name.to_owned(),
        section,
        problem,
    };
    if surface.sections.len() < 2 {
        return Err(refuse(
            surface.sections.len(),
            format!(
                "the surface has {} sections: give two or more",
                surface.sections.len()
            ),
        ));
    }
    if surface.n_chord == 0 {
        return Err(refuse(
            1,
            "the surface has no chordwise vortices: give Nchord of 1 or more".to_owned(),
        ));
    }
    let mut out = Vec::new();
    for (k, section) in surface.sections.iter().enumerate() {
        let chord = section.chord * surface.scale[0];
        let place = [section.x_le, section.y_le, section.z_le];
        let leading_edge = V3::from_fn(|i, _| place[i] * surface.scale[i] + surface.translate[i]);
        if !(chord > 0.0 && chord.is_finite() && leading_edge.iter().all(|v| v.is_finite())) {
            return Err(refuse(
                k + 1,
                format!("its chord is {chord}: give a positive one"),
            ));
        }
        let camber = camber(&section.airfoil, files, |what| {
            remarks.push(format!("surface \"{name}\", section {}: {what}", k + 1));
        });
        let camber = camber.map_err(|(airfoil, problem)| Error::Airfoil {
            surface: name.to_owned(),
            section: k + 1,
            airfoil,
            problem,
        })?;
        out.push(Rib {
            section,
            leading_edge,
            chord,
            incidence_rad: (section.a_inc_deg + surface.angle_deg).to_radians(),
            camber,
            polar: section.cdcl.or(surface.cdcl),
        });
    }
    Ok(out)
}

/// Camber of a section; a file that is not there is a remark.
fn camber(
    airfoil: &Airfoil,
    files: &Files<'_>,
    mut remark: impl FnMut(String),
) -> std::result::Result<CamberSlope, (String, String)> {
    let (name, text) = match airfoil {
        Airfoil::File { path, .. } => {
            let text = files(path);
            if text.is_none() {
                remark(format!(
                    "there is no aerofoil file {path}: taken as a flat plate, as AVL does"
                ));
            }
            (path.clone(), text)
        }
        Airfoil::Naca { digits, .. } => (format!("NACA {digits}"), None),
        _ => ("AIRFOIL".to_owned(), None),
    };
    CamberSlope::of(airfoil, text.as_deref()).map_err(|e| (name, e.0))
}
