//! From AVL's strips and the modal basis to the strips of the model with their shapes.

use crate::Error;
use crate::case::{LiftSlopes, SurfaceCase, VariantCase, grid_list};
use crate::inputs::Inputs;
use albatross_modal::{LoadReferenceAxis, ModalBasis, Station, StationShapes, interpolate};
use albatross_numerics::Mat;
use albatross_strip::forces::influence_of;
use albatross_strip::slopes::{self, StripRecord, base_name};
use albatross_strip::{Strip, StripShapes};

/// The strips of a model.
#[derive(Debug, Clone)]
pub struct StripSet {
    /// As the aerodynamic files describe them, corrections applied.
    pub records: Vec<StripRecord>,
    /// As the aerodynamics takes them; `cl_alpha` is the slope for the strip's own motion.
    pub strips: Vec<Strip>,
    /// Mode shapes on the strips.
    pub shapes: StripShapes,
    /// Name of the load reference axis of each strip.
    pub lra: Vec<String>,
    /// Lift of each strip (rows) per `rho V w` of each (columns) \[m²\], where strips act on each other.
    pub influence: Option<Mat<f64>>,
    /// What was assumed on the way.
    pub notes: Vec<String>,
}

/// Builds the strips of the case's surfaces.
///
/// # Errors
/// [`Error::UnknownName`] for a surface that the AVL files lack or an image without axis; errors of the readers'
/// tables, of the interpolation and of the corrections.
pub fn strip_set(inputs: &Inputs, basis: &ModalBasis, variant: &VariantCase) -> Result<StripSet, Error> {
    let aerodynamics = &inputs.case.aerodynamics;
    let ([low, high], [low_deg, high_deg]) = (&inputs.strips, inputs.strip_alphas_deg);
    let all = slopes::from_avl(low, low_deg, high, high_deg)?;
    if let Some(slopes) = &inputs.slopes_between
        && (slopes.nrows(), slopes.ncols()) != (all.len(), all.len())
    {
        return Err(Error::Mismatch {
            what: "lift slopes between strips".into(),
            found: format!("{} x {}", slopes.nrows(), slopes.ncols()),
            expected: format!("{0} x {0}, one for each pair of the strips", all.len()),
        });
    }
    let source = aerodynamics
        .files()
        .map_or(&aerodynamics.geometry, |(_, strips)| &strips[0].file);
    let mut notes = Vec::new();
    let mut records = Vec::new();
    let mut lra = Vec::new();
    let mut gradients = Vec::new();
    // Among all strips of the files.
    let mut places = Vec::new();
    for surface in &aerodynamics.surfaces {
        let own: Vec<(usize, &StripRecord)> = all
            .iter()
            .enumerate()
            .filter(|(_, r)| base_name(&r.surface).eq_ignore_ascii_case(surface.name.trim()))
            .collect();
        if own.is_empty() {
            let mut known: Vec<&str> = all.iter().map(|r| base_name(&r.surface)).collect();
            known.dedup();
            return Err(Error::UnknownName {
                kind: "surface",
                name: surface.name.clone(),
                known: format!("{} (in {})", known.join(", "), source),
            });
        }
        for (place, record) in own {
            lra.push(axis_of(surface, record)?.to_owned());
            gradients.push(surface.downwash_gradient);
            records.push(record.clone());
            places.push(place);
        }
    }
    refuse_coincident(&records, source)?;
    let computed: Vec<f64> = records.iter().map(|r| r.cl_alpha).collect();
    if variant.corrections
        && let Some(table) = &inputs.slope_table
    {
        notes.push(format!("lift slopes: {}", table.provenance));
        notes.extend(slopes::apply_table(&mut records, table)?);
    }
    let own_slopes = own_slopes(inputs, &records, &gradients, &mut notes)?;

    let (stations, x_lra) = shapes_on_axes(inputs, basis, &records, &lra, &mut notes)?;
    let strips: Vec<Strip> = records
        .iter()
        .zip(&x_lra)
        .zip(&own_slopes)
        .map(|((record, &x_lra), &cl_alpha)| record.strip(x_lra, cl_alpha))
        .collect();
    let shapes = StripShapes::from_components(
        &strips,
        aerodynamics.dihedral,
        [&stations.translation[1], &stations.translation[2]],
        [&stations.rotation[1], &stations.rotation[2]],
    )?;
    let influence = inputs
        .slopes_between
        .as_ref()
        .map(|slopes| influence(slopes, &places, &records, &computed, &strips));
    Ok(StripSet {
        influence,
        records,
        strips,
        shapes,
        lra,
        notes,
    })
}

/// Refuses two strips in one place: their lift would count twice, and no case means that.
fn refuse_coincident(records: &[StripRecord], source: &str) -> Result<(), Error> {
    for (j, second) in records.iter().enumerate() {
        let near =
            |a: [f64; 3], b: [f64; 3], size: f64| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-6 * size);
        let same = |first: &&StripRecord| {
            near(first.leading_edge, second.leading_edge, second.chord)
                && (first.chord - second.chord).abs() <= 1e-6 * second.chord
                && (first.dihedral_rad - second.dihedral_rad).abs() <= 1e-6
        };
        let Some(first) = records.iter().take(j).find(same) else {
            continue;
        };
        let [x, y, z] = second.leading_edge;
        return Err(Error::Mismatch {
            what: format!("strips of {source}"),
            found: format!(
                "strip {} of `{}` and strip {} of `{}` in one place, leading edge at {x}, {y}, {z} m",
                first.index,
                first.surface.trim(),
                second.index,
                second.surface.trim()
            ),
            expected: "one strip a place: remove the surface that is there twice".into(),
        });
    }
    Ok(())
}

/// Influence of the strips on each other; rows follow the correction of the strip's lift slope.
fn influence(
    slopes: &Mat<f64>,
    places: &[usize],
    records: &[StripRecord],
    computed: &[f64],
    strips: &[Strip],
) -> Mat<f64> {
    let chosen = Mat::from_fn(records.len(), records.len(), |j, i| {
        let correction = if computed[j] == 0.0 {
            1.0
        } else {
            records[j].cl_alpha / computed[j]
        };
        correction * slopes[(places[j], places[i])]
    });
    influence_of(strips, &chosen)
}

/// The load reference axis that a strip belongs to.
fn axis_of<'a>(surface: &'a SurfaceCase, record: &StripRecord) -> Result<&'a str, Error> {
    if base_name(&record.surface).len() == record.surface.trim_end().len() {
        return Ok(&surface.lra);
    }
    surface.image_lra.as_deref().ok_or_else(|| Error::UnknownName {
        kind: "image_lra for surface",
        name: surface.name.clone(),
        known: format!(
            "`lra = \"{}\"` only; add `image_lra` for AVL's mirror image",
            surface.lra
        ),
    })
}

/// Lift slopes for the strips' own motion.
fn own_slopes(
    inputs: &Inputs,
    records: &[StripRecord],
    gradients: &[f64],
    notes: &mut Vec<String>,
) -> Result<Vec<f64>, Error> {
    match inputs.case.aerodynamics.lift_slopes {
        // Between strips, the slopes of the surfaces in the aircraft's incidence serve the rigid loads only.
        LiftSlopes::Avl | LiftSlopes::Lattice => Ok(records
            .iter()
            .zip(gradients)
            .map(|(r, e)| r.cl_alpha / (1.0 - e))
            .collect()),
        LiftSlopes::PrandtlGlauert => {
            let mach = inputs.mach();
            notes.push(format!(
                "lift slopes: 2 pi with the Prandtl-Glauert rule at M {mach:.4} cos(sweep)"
            ));
            records
                .iter()
                .map(|r| {
                    slopes::prandtl_glauert_slope(mach, r.sweep_rad).ok_or_else(|| Error::Mismatch {
                        what: format!("Mach number normal to strip {} of `{}`", r.index, r.surface),
                        found: format!("{:.3}", mach * r.sweep_rad.cos()),
                        expected: "less than 1 for the Prandtl-Glauert rule".into(),
                    })
                })
                .collect()
        }
    }
}

/// Mode shapes of all strips and the position of the axis at each.
fn shapes_on_axes(
    inputs: &Inputs,
    basis: &ModalBasis,
    records: &[StripRecord],
    lra: &[String],
    notes: &mut Vec<String>,
) -> Result<(StationShapes, Vec<f64>), Error> {
    let n_modes = basis.modes.len();
    let zeros = || std::array::from_fn(|_| Mat::zeros(records.len(), n_modes));
    let mut all = StationShapes {
        translation: zeros(),
        rotation: zeros(),
        x_lra: vec![0.0; records.len()],
        notes: Vec::new(),
    };
    let mut names: Vec<&String> = lra.iter().collect();
    names.sort();
    names.dedup();
    for name in names {
        let entries = inputs.case.structure.lra.get(name).map_or(&[][..], Vec::as_slice);
        let axis = LoadReferenceAxis {
            name: name.clone(),
            grids: grid_list(entries)?,
        };
        let members: Vec<usize> = (0..records.len()).filter(|&j| &lra[j] == name).collect();
        let stations: Vec<Station> = members
            .iter()
            .map(|&j| Station {
                x: records[j].x_ac(),
                y: records[j].leading_edge[1],
                z: records[j].leading_edge[2],
            })
            .collect();
        let found = interpolate(basis, &axis, &stations, inputs.case.structure.interpolation)?;
        notes.extend(found.notes.iter().cloned());
        for (row, &j) in members.iter().enumerate() {
            all.x_lra[j] = found.x_lra[row];
            for component in 0..3 {
                for k in 0..n_modes {
                    all.translation[component][(j, k)] = found.translation[component][(row, k)];
                    all.rotation[component][(j, k)] = found.rotation[component][(row, k)];
                }
            }
        }
    }
    let x_lra = all.x_lra.clone();
    Ok((all, x_lra))
}
