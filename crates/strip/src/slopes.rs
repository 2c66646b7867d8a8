//! Strips and their lift slopes: from two AVL strip files, from a table of higher fidelity, or from thin-airfoil
//! theory with the Prandtl-Glauert rule.
//!
//! Equations: THEORY (8), (9).

use crate::Error;
use crate::strip::Strip;
use albatross_avl::results::{StripForces, StripSurface};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A strip as the aerodynamic files describe it, before the load reference axis is known.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct StripRecord {
    /// Name of its surface, mirror images with AVL's suffix ` (YDUP)`.
    pub surface: String,
    /// Number in the file, from 1.
    pub index: usize,
    /// Leading edge at the strip's middle: x aft, y right, z up \[m\].
    pub leading_edge: [f64; 3],
    /// Chord \[m\].
    pub chord: f64,
    /// Width, area over chord \[m\].
    pub width: f64,
    /// Angle above the horizontal, positive where z grows with y \[rad\].
    pub dihedral_rad: f64,
    /// Sweep of the quarter chord, positive aft \[rad\].
    pub sweep_rad: f64,
    /// Lift slope with the aircraft's incidence \[1/rad\].
    pub cl_alpha: f64,
    /// Lift coefficient at zero incidence.
    pub cl0: f64,
    /// Slope of the quarter-chord moment with the aircraft's incidence \[1/rad\].
    pub cm_alpha: f64,
    /// Quarter-chord moment at zero incidence.
    pub cm0: f64,
}

impl StripRecord {
    /// Aerodynamic centre: quarter chord, streamwise \[m\].
    pub fn x_ac(&self) -> f64 {
        self.leading_edge[0] + 0.25 * self.chord
    }

    /// The strip with its lift slope `cl_alpha` for incremental incidence and its LRA at `x_lra`.
    pub fn strip(&self, x_lra: f64, cl_alpha: f64) -> Strip {
        Strip {
            y: self.leading_edge[1],
            z: self.leading_edge[2],
            width: self.width,
            chord: self.chord,
            x_ac: self.x_ac(),
            x_lra,
            cl_alpha,
            dihedral_rad: self.dihedral_rad,
        }
    }
}

/// Name of a surface without AVL's suffix of mirror images.
pub fn base_name(surface: &str) -> &str {
    surface
        .trim_end()
        .strip_suffix("(YDUP)")
        .unwrap_or(surface)
        .trim_end()
}

/// Strips and slopes from AVL's strip forces at two incidences \[deg\]; surfaces in the order of the file.
///
/// # Errors
/// [`Error::StripTables`] if the files do not describe the same strips, the incidences coincide, or the layout (AVL
/// 3.35 and older) has no leading-edge columns.
pub fn from_avl(
    low: &StripForces,
    low_deg: f64,
    high: &StripForces,
    high_deg: f64,
) -> Result<Vec<StripRecord>, Error> {
    let step = (high_deg - low_deg).to_radians();
    if !(step.is_finite() && step.abs() > 1e-6) {
        return Err(Error::StripTables {
            what: "incidences of the two strip files".into(),
            found: format!("{low_deg} and {high_deg} deg"),
            expected: "two different angles, for example 1 and 2 deg".into(),
        });
    }
    if low.surfaces.len() != high.surfaces.len() {
        return Err(Error::StripTables {
            what: "number of surfaces".into(),
            found: format!("{} and {}", low.surfaces.len(), high.surfaces.len()),
            expected: "two runs of the same geometry".into(),
        });
    }
    let mut records = Vec::new();
    for (a, b) in low.surfaces.iter().zip(&high.surfaces) {
        if a.name != b.name || a.strips.len() != b.strips.len() {
            return Err(Error::StripTables {
                what: format!("surface `{}`", a.name),
                found: format!(
                    "{} strips against `{}` with {}",
                    a.strips.len(),
                    b.name,
                    b.strips.len()
                ),
                expected: "two runs of the same geometry".into(),
            });
        }
        let edges = leading_edges(a)?;
        for (j, (s, t)) in a.strips.iter().zip(&b.strips).enumerate() {
            if (s.y_le - t.y_le).abs() > 1e-3 * s.chord.abs()
                || (s.chord - t.chord).abs() > 1e-3 * s.chord.abs()
            {
                return Err(Error::StripTables {
                    what: format!("strip {} of `{}`", s.index, a.name),
                    found: format!(
                        "y, chord = {}, {} against {}, {}",
                        s.y_le, s.chord, t.y_le, t.chord
                    ),
                    expected: "two runs of the same geometry".into(),
                });
            }
            if !(s.chord > 0.0 && s.area > 0.0) {
                return Err(Error::StripTables {
                    what: format!("strip {} of `{}`", s.index, a.name),
                    found: format!("chord {} and area {}", s.chord, s.area),
                    expected: "positive values".into(),
                });
            }
            let (dihedral_rad, sweep_rad) = angles(&edges, &a.strips, j);
            let slope = |low: f64, high: f64| (high - low) / step;
            let (cl_alpha, cm_alpha) = (slope(s.cl, t.cl), slope(s.cm_c4, t.cm_c4));
            let alpha = low_deg.to_radians();
            records.push(StripRecord {
                surface: a.name.trim_end().to_owned(),
                index: s.index,
                leading_edge: edges.get(j).copied().unwrap_or_default(),
                chord: s.chord,
                width: s.area / s.chord,
                dihedral_rad,
                sweep_rad,
                cl_alpha,
                cl0: s.cl - cl_alpha * alpha,
                cm_alpha,
                cm0: s.cm_c4 - cm_alpha * alpha,
            });
        }
    }
    if !records.is_empty() && records.iter().all(|r| r.cl_alpha == 0.0) {
        return Err(Error::StripTables {
            what: "lift slopes of the strips".into(),
            found: "no strip's lift changes between the two files".into(),
            expected: "runs at two incidences; is one file named twice?".into(),
        });
    }
    Ok(records)
}

fn leading_edges(surface: &StripSurface) -> Result<Vec<[f64; 3]>, Error> {
    surface
        .strips
        .iter()
        .map(|s| match (s.x_le, s.z_le) {
            (Some(x), Some(z)) => Ok([x, s.y_le, z]),
            _ => Err(Error::StripTables {
                what: format!("surface `{}`", surface.name),
                found: "no columns Xle and Zle (the layout of AVL 3.35 and older)".into(),
                expected: "strip forces of AVL 3.40 or later".into(),
            }),
        })
        .collect()
}

/// Dihedral and quarter-chord sweep at strip `j` from its neighbours (central differences).
fn angles(edges: &[[f64; 3]], strips: &[albatross_avl::results::Strip], j: usize) -> (f64, f64) {
    let last = edges.len().saturating_sub(1);
    let (before, after) = (j.saturating_sub(1), (j + 1).min(last));
    let point = |i: usize| {
        let [x, y, z] = edges.get(i).copied().unwrap_or_default();
        [x + 0.25 * strips.get(i).map_or(0.0, |s| s.chord), y, z]
    };
    let (p, q) = (point(before), point(after));
    let (dx, dy, dz) = (q[0] - p[0], q[1] - p[1], q[2] - p[2]);
    let span = dy.hypot(dz);
    if span == 0.0 {
        return (0.0, 0.0);
    }
    let mut dihedral = dz.atan2(dy);
    // A line has two directions: fold into (-90, 90] deg.
    if dihedral > FRAC_PI_2 + 1e-12 {
        dihedral -= PI;
    } else if dihedral <= -FRAC_PI_2 + 1e-12 {
        dihedral += PI;
    }
    // Outboard is away from the plane of symmetry, or up for a fin on it.
    let outboard = if dy.abs() > 1e-9 * span {
        (p[1] + q[1]).signum() * dy.signum()
    } else {
        dz.signum()
    };
    (dihedral, (outboard * dx / span).atan())
}

/// Lift slopes of higher fidelity.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SlopeTable {
    /// Where the numbers come from; kept with every result that uses them.
    pub provenance: String,
    /// Rows in any order.
    pub rows: Vec<SlopeRow>,
}

/// A row of a slope table.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SlopeRow {
    /// Surface without side, as AVL names the original.
    pub surface: String,
    /// Lateral position, negative on the left \[m\].
    pub y: f64,
    /// Lift slope \[1/rad\].
    pub cl_alpha: f64,
    /// Lift coefficient at zero incidence, if the table has it.
    pub cl0: Option<f64>,
}

/// Replaces slopes (and `cl0` where given) by those of a table, linear in y within each surface and constant beyond
/// its ends. Returns notes: surfaces that the table lacks and keep their slopes, sides filled from the other one.
///
/// # Errors
/// [`Error::StripTables`] if the table names no surface of the records or has a value that is not finite.
pub fn apply_table(records: &mut [StripRecord], table: &SlopeTable) -> Result<Vec<String>, Error> {
    if let Some(row) = table
        .rows
        .iter()
        .find(|r| !(r.y.is_finite() && r.cl_alpha.is_finite() && r.cl0.is_none_or(f64::is_finite)))
    {
        return Err(Error::StripTables {
            what: format!("slope table ({}), surface `{}`", table.provenance, row.surface),
            found: format!("y {}, cl_alpha {}, cl0 {:?}", row.y, row.cl_alpha, row.cl0),
            expected: "finite numbers".into(),
        });
    }
    let mut names: Vec<String> = records.iter().map(|r| base_name(&r.surface).to_owned()).collect();
    names.sort();
    names.dedup();
    let mut notes = Vec::new();
    let mut found_any = false;
    for name in &names {
        let of_surface: Vec<&SlopeRow> = table
            .rows
            .iter()
            .filter(|r| base_name(&r.surface) == name)
            .collect();
        if of_surface.is_empty() {
            notes.push(format!(
                "surface `{name}` is not in the slope table and keeps its own lift slopes"
            ));
            continue;
        }
        found_any = true;
        let side = |sign: f64| -> Vec<&SlopeRow> {
            let mut rows: Vec<&SlopeRow> = of_surface.iter().copied().filter(|r| r.y * sign >= 0.0).collect();
            rows.sort_by(|a, b| a.y.abs().total_cmp(&b.y.abs()));
            rows
        };
        let sides = [side(1.0), side(-1.0)];
        for record in records.iter_mut().filter(|r| base_name(&r.surface) == name) {
            let y = record.leading_edge[1];
            let [right, left] = &sides;
            let (own, other) = if y >= 0.0 { (right, left) } else { (left, right) };
            let rows = if own.is_empty() { other } else { own };
            if own.is_empty() {
                let note = format!(
                    "surface `{name}`: one side of the slope table is empty and filled from the other"
                );
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
            record.cl_alpha = linear(rows, y.abs(), |r| r.cl_alpha);
            if rows.iter().all(|r| r.cl0.is_some()) {
                record.cl0 = linear(rows, y.abs(), |r| r.cl0.unwrap_or_default());
            }
        }
    }
    if !found_any {
        return Err(Error::StripTables {
            what: format!("slope table ({})", table.provenance),
            found: "no row for any surface of the model".into(),
            expected: format!("rows whose surface is one of: {}", names.join(", ")),
        });
    }
    Ok(notes)
}

/// Linear interpolation over `|y|`, constant beyond the ends; `rows` sorted and not empty.
fn linear(rows: &[&SlopeRow], y: f64, value: impl Fn(&SlopeRow) -> f64) -> f64 {
    let after = rows.partition_point(|r| r.y.abs() < y);
    match (after.checked_sub(1).and_then(|i| rows.get(i)), rows.get(after)) {
        (Some(a), Some(b)) => {
            let width = b.y.abs() - a.y.abs();
            let share = if width > 0.0 { (y - a.y.abs()) / width } else { 0.5 };
            value(a) + share * (value(b) - value(a))
        }
        (Some(only), None) | (None, Some(only)) => value(only),
        (None, None) => 0.0,
    }
}

/// Lift slope of a thin airfoil with the Prandtl-Glauert rule on the Mach number normal to the sweep line,
/// `2 pi / sqrt(1 - M^2 cos^2 sweep)` \[1/rad\]; none where the normal flow is sonic.
pub fn prandtl_glauert_slope(mach: f64, sweep_rad: f64) -> Option<f64> {
    let beta_squared = 1.0 - (mach * sweep_rad.cos()).powi(2);
    (beta_squared > 0.0).then(|| TAU / beta_squared.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(surface: &str, y: f64) -> StripRecord {
        StripRecord {
            surface: surface.into(),
            index: 1,
            leading_edge: [0.0, y, 0.0],
            chord: 1.0,
            width: 1.0,
            dihedral_rad: 0.0,
            sweep_rad: 0.0,
            cl_alpha: 5.0,
            cl0: 0.1,
            cm_alpha: 0.0,
            cm0: 0.0,
        }
    }

    #[test]
    fn val_table_is_linear_in_y_and_notes_missing_surfaces() {
        let mut records = [
            record("Wing", 1.5),
            record("Wing (YDUP)", -1.5),
            record("HTP", 1.0),
            record("Wing", 9.0),
        ];
        let row = |y: f64, cl_alpha: f64| SlopeRow {
            surface: "Wing".into(),
            y,
            cl_alpha,
            cl0: None,
        };
        let table = SlopeTable {
            provenance: "test".into(),
            rows: vec![row(2.0, 7.0), row(1.0, 6.0)],
        };
        let notes = apply_table(&mut records, &table).unwrap();
        assert_eq!(records[0].cl_alpha, 6.5);
        assert_eq!(records[1].cl_alpha, 6.5, "the left side is filled from the right");
        assert_eq!(records[2].cl_alpha, 5.0);
        assert_eq!(records[3].cl_alpha, 7.0, "constant beyond the end");
        assert_eq!(notes.len(), 2, "{notes:?}");
        assert_eq!(records[0].cl0, 0.1);
    }

    /// beta = 0.7214 at M 0.78 and 27.4 deg, as for the paper's aircraft.
    #[test]
    fn val_prandtl_glauert() {
        let slope = prandtl_glauert_slope(0.78, 27.4_f64.to_radians()).unwrap();
        assert!((TAU / slope - 0.7214).abs() < 5e-5);
        assert_eq!(prandtl_glauert_slope(1.2, 0.0), None);
    }
}
