//! Mass of CBAR, CBEAM, CROD and CONROD.

use albatross_nastran::deck::{BeamProperty, Id};
use nalgebra::{Matrix3, Matrix6, Vector3};

use super::{BarMass, Context, DeckMass};
use crate::error::Error;
use crate::mass_matrix::rigid_block;
use crate::rigid::{rigid_transfer, skew};

/// A line element with the mass at its two ends.
struct Line {
    name: &'static str,
    id: Id,
    grids: [Id; 2],
    /// From each grid to the element's end, basic axes, m.
    arms: [Vector3<f64>; 2],
    /// Mass per length that belongs to each end, kg/m: the mass of a uniform element is split equally, that of a
    /// tapered one so that mass and centre are kept.
    per_length: [f64; 2],
    /// Inertia about the element's axis per length, kg m.
    axial_inertia: f64,
    coupled: bool,
}

pub(super) fn add(context: &Context<'_>, bar_mass: BarMass, mass: &mut DeckMass) -> Result<(), Error> {
    let coupled = bar_mass == BarMass::Coupled;
    add_bars(context, coupled, mass)?;
    add_beams(context, coupled, mass)?;
    add_rods(context, coupled, mass)
}

fn add_bars(context: &Context<'_>, coupled: bool, mass: &mut DeckMass) -> Result<(), Error> {
    for bar in context.deck.bars.values() {
        let missing = |what| context.missing("CBAR", bar.id, what);
        let property = context.deck.bar_properties.get(&bar.pid);
        let property = property.ok_or_else(|| missing(format!("PBAR or PBARL {}", bar.pid)))?;
        let rho = density(context, "CBAR", bar.id, property.mid())?;
        let Some(area) = property.area().or((rho == 0.0).then_some(0.0)) else {
            mass.other.push(format!(
                "CBAR {} (area of its PBARL section is not known)",
                bar.id
            ));
            continue;
        };
        let mu = rho * area + property.nsm();
        if mu == 0.0 {
            continue;
        }
        let Some(arms) = arms(
            context,
            "CBAR",
            bar.id,
            bar.grids,
            &bar.offset_frames,
            [bar.wa, bar.wb],
        )?
        else {
            mass.other
                .push(format!("CBAR {} (offsets in the element frame)", bar.id));
            continue;
        };
        let (name, id, grids) = ("CBAR", bar.id, bar.grids);
        let per_length = [mu / 2.0; 2];
        Line {
            name,
            id,
            grids,
            arms,
            per_length,
            axial_inertia: 0.0,
            coupled,
        }
        .add_to(context, mass)?;
    }
    Ok(())
}

fn add_beams(context: &Context<'_>, coupled: bool, mass: &mut DeckMass) -> Result<(), Error> {
    for beam in context.deck.beams.values() {
        let missing = |what| context.missing("CBEAM", beam.id, what);
        let property = context.deck.beam_properties.get(&beam.pid);
        let property = property.ok_or_else(|| missing(format!("PBEAM or PBEAML {}", beam.pid)))?;
        let rho = density(context, "CBEAM", beam.id, property.mid())?;
        let (Some(stations), Some(axial_inertia)) = (property.mass_stations(), axial_inertia(property, rho))
        else {
            mass.other.push(format!(
                "CBEAM {} (area or moments of its section are not known)",
                beam.id
            ));
            continue;
        };
        let line_mass: Vec<(f64, f64)> = stations
            .iter()
            .map(|&(x, area, nsm)| (x, rho * area + nsm))
            .collect();
        let per_length = end_shares(&line_mass);
        if per_length == [0.0; 2] && axial_inertia == 0.0 {
            continue;
        }
        let offsets = arms(
            context,
            "CBEAM",
            beam.id,
            beam.grids,
            &beam.offset_frames,
            [beam.wa, beam.wb],
        )?;
        let Some(arms) = offsets.filter(|_| !is_eccentric(property, rho, &stations)) else {
            mass.other.push(format!(
                "CBEAM {} (mass off the shear centre, or offsets in the element frame)",
                beam.id
            ));
            continue;
        };
        let (name, id, grids) = ("CBEAM", beam.id, beam.grids);
        Line {
            name,
            id,
            grids,
            arms,
            per_length,
            axial_inertia,
            coupled,
        }
        .add_to(context, mass)?;
    }
    Ok(())
}

fn add_rods(context: &Context<'_>, coupled: bool, mass: &mut DeckMass) -> Result<(), Error> {
    let mut rods = Vec::new();
    for rod in context.deck.rods.values() {
        let property = context.deck.rod_properties.get(&rod.pid);
        let property =
            property.ok_or_else(|| context.missing("CROD", rod.id, format!("PROD {}", rod.pid)))?;
        let rho = density(context, "CROD", rod.id, property.mid)?;
        rods.push(("CROD", rod.id, rod.grids, rho * property.area + property.nsm));
    }
    for rod in context.deck.conrods.values() {
        let rho = density(context, "CONROD", rod.id, rod.mid)?;
        rods.push(("CONROD", rod.id, rod.grids, rho * rod.area + rod.nsm));
    }
    rods.retain(|r| r.3 != 0.0);
    if coupled && !rods.is_empty() {
        mass.notes
            .push("rods are lumped although the deck asks for coupled mass".into());
    }
    for (name, id, grids, mu) in rods {
        let arms = [Vector3::zeros(); 2];
        let per_length = [mu / 2.0; 2];
        let line = Line {
            name,
            id,
            grids,
            arms,
            per_length,
            axial_inertia: 0.0,
            coupled: false,
        };
        line.add_to(context, mass)?;
    }
    Ok(())
}

impl Line {
    fn add_to(&self, context: &Context<'_>, mass: &mut DeckMass) -> Result<(), Error> {
        let [a, b] = self.grids;
        let at_a = context.grid(self.name, self.id, a)?.position;
        let at_b = context.grid(self.name, self.id, b)?.position;
        let axis = (at_b + self.arms[1]) - (at_a + self.arms[0]);
        let length = axis.norm();
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::BadMass {
                card: context.card(self.name, self.id),
                problem: format!(
                    "its length between grids {a} and {b} is {length} m; correct the grids or offsets"
                ),
            });
        }
        let axis = axis / length;
        let axial = axis * axis.transpose() * (self.axial_inertia * length / 2.0);
        let [ea, eb] = self.arms.map(rigid_transfer);
        let ends = if self.coupled {
            coupled_blocks(axis, length, self.per_length.iter().sum::<f64>() * length, &axial)
        } else {
            let lump = |per_length: f64| rigid_block(per_length * length, Vector3::zeros(), &axial);
            [
                lump(self.per_length[0]),
                Matrix6::zeros(),
                lump(self.per_length[1]),
            ]
        };
        let blocks = [
            ea.transpose() * ends[0] * ea,
            ea.transpose() * ends[1] * eb,
            eb.transpose() * ends[2] * eb,
        ];
        for block in &blocks {
            context.check_finite(self.name, self.id, block)?;
        }
        mass.model.add(a, at_a, &blocks[0]);
        mass.model.add(b, at_b, &blocks[2]);
        if self.coupled {
            mass.model.couple(a, b, &blocks[1]);
        }
        Ok(())
    }
}

/// Blocks (AA, AB, BB) of a uniform beam of mass `m` with cubic deflection (Przemieniecki, Theory of Matrix
/// Structural Analysis, 1968, Eq. 11.24, without rotary inertia); the axial mass is the mean of lumped and
/// consistent, 5/12 and 1/12, as in Nastran. Rigid motions do not depend on that choice. The slope at an end is
/// R x axis.
fn coupled_blocks(
    axis: Vector3<f64>,
    length: f64,
    m: f64,
    axial_inertia: &Matrix3<f64>,
) -> [Matrix6<f64>; 3] {
    let along = axis * axis.transpose();
    let across = Matrix3::identity() - along;
    let slope = -skew(axis);
    let block = |axial: f64, t: f64, t_slope: f64, slope_t: f64, slope_slope: f64, inertia: &Matrix3<f64>| {
        let mut b = Matrix6::zeros();
        b.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&((along * axial + across * (t / 420.0)) * m));
        b.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&(slope * (m * length * t_slope / 420.0)));
        b.fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&(slope.transpose() * (m * length * slope_t / 420.0)));
        b.fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(across * (m * length * length * slope_slope / 420.0) + inertia));
        b
    };
    [
        block(5.0 / 12.0, 156.0, 22.0, 22.0, 4.0, axial_inertia),
        block(1.0 / 12.0, 54.0, -13.0, 13.0, -3.0, &Matrix3::zeros()),
        block(5.0 / 12.0, 156.0, -22.0, -22.0, 4.0, axial_inertia),
    ]
}

/// Density of a bar's material. An element without a material that the deck has cannot be judged.
fn density(context: &Context<'_>, name: &str, id: Id, mid: Id) -> Result<f64, Error> {
    let material = context.deck.materials.get(&mid);
    material
        .map(|m| m.rho)
        .ok_or_else(|| context.missing(name, id, format!("MAT1 {mid}")))
}

/// Offsets of both ends in basic axes; `None` when they are given in the element's own frame.
fn arms(
    context: &Context<'_>,
    name: &str,
    id: Id,
    grids: [Id; 2],
    offset_frames: &str,
    offsets: [[f64; 3]; 2],
) -> Result<Option<[Vector3<f64>; 2]>, Error> {
    let mut arms = [Vector3::zeros(); 2];
    for (end, (arm, offset)) in arms.iter_mut().zip(offsets).enumerate() {
        if offset == [0.0; 3] {
            continue;
        }
        // OFFT: the second letter is for end A, the third for end B; G is the grid's displacement system.
        if offset_frames.chars().nth(end + 1).is_some_and(|c| c != 'G') {
            return Ok(None);
        }
        let grid = grids.get(end).copied().unwrap_or_default();
        *arm = context.grid(name, id, grid)?.axes * Vector3::from(offset);
    }
    Ok(Some(arms))
}

/// Mass per length of each end, from (x, mass per length) stations with straight lines between them: the integrals
/// of (1 - x) mu and x mu.
fn end_shares(stations: &[(f64, f64)]) -> [f64; 2] {
    let mut shares = [0.0; 2];
    for pair in stations.windows(2) {
        let [(xa, a), (xb, b)] = [pair[0], pair[1]];
        let h = xb - xa;
        let total = h * (a + b) / 2.0;
        let first_moment = h * (a * (2.0 * xa + xb) + b * (xa + 2.0 * xb)) / 6.0;
        shares[0] += total - first_moment;
        shares[1] += first_moment;
    }
    shares
}

/// Inertia of a beam about its axis per length, kg m, mean of both ends: rho (I1 + I2) and the non-structural part.
/// Nastran gives it to CBEAM and not to CBAR. `None` when the moments of a section are not known.
fn axial_inertia(property: &BeamProperty, rho: f64) -> Option<f64> {
    let polar = |(i1, i2): (f64, f64)| i1 + i2;
    let ends = match property {
        BeamProperty::Pbeam(beam) => {
            let a = beam.stations.first()?;
            let b = beam.stations.iter().find(|s| s.x == 1.0).unwrap_or(a);
            let at_a = (a.i1.unwrap_or(0.0), a.i2.unwrap_or(0.0));
            let at_b = (b.i1.unwrap_or(at_a.0), b.i2.unwrap_or(at_a.1));
            let [nsi_a, nsi_b] = beam.ends.nsi;
            let nsi_a = nsi_a.unwrap_or(0.0);
            [
                rho * polar(at_a) + nsi_a,
                rho * polar(at_b) + nsi_b.unwrap_or(nsi_a),
            ]
        }
        BeamProperty::Pbeaml(_) if rho == 0.0 => [0.0; 2],
        BeamProperty::Pbeaml(beam) => {
            let a = beam.stations.first()?;
            let b = beam.stations.iter().find(|s| s.x == 1.0).unwrap_or(a);
            [
                rho * polar(a.section.second_moments()?),
                rho * polar(b.section.second_moments()?),
            ]
        }
    };
    Some((ends[0] + ends[1]) / 2.0)
}

/// Whether some mass of a beam is not on the shear centre.
fn is_eccentric(property: &BeamProperty, rho: f64, stations: &[(f64, f64, f64)]) -> bool {
    let BeamProperty::Pbeam(beam) = property else {
        return false;
    };
    let offset = |values: &[Option<f64>; 4]| values.iter().flatten().any(|&v| v != 0.0);
    let structural = rho != 0.0 && stations.iter().any(|s| s.1 != 0.0);
    let non_structural = stations.iter().any(|s| s.2 != 0.0);
    (structural && offset(&beam.ends.neutral_axis)) || (non_structural && offset(&beam.ends.nsm_center))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass_matrix::MassModel;

    /// A uniform beam moves rigidly: the consistent matrix must give the mass, centre and inertia of a thin rod,
    /// m L^2 / 12 about its centre, exactly.
    #[test]
    fn val_coupled_bar_has_the_inertia_of_a_thin_rod() {
        let (m, length) = (12.0, 3.0);
        let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
        let [aa, ab, bb] = coupled_blocks(axis, length, m, &Matrix3::zeros());
        let start = Vector3::new(1.0, 2.0, 3.0);
        let mut model = MassModel::default();
        model.add(1, start, &aa);
        model.add(2, start + axis * length, &bb);
        model.couple(1, 2, &ab);
        let p = model.properties().expect("has mass");
        let center = start + axis * (length / 2.0);
        let j = (Matrix3::identity() - axis * axis.transpose()) * (m * length * length / 12.0);
        assert!((p.mass - m).abs() < 1e-13);
        for i in 0..3 {
            assert!((p.cg[i] - center[i]).abs() < 1e-13);
            for k in 0..3 {
                assert!((p.inertia[i][k] - j[(i, k)]).abs() < 1e-12);
            }
        }
    }

    /// mu = 2 + 6 x on a unit length: mass 5, first moment 1 + 2 = 3.
    #[test]
    fn val_taper_keeps_mass_and_centre() {
        let [a, b] = end_shares(&[(0.0, 2.0), (0.25, 3.5), (1.0, 8.0)]);
        assert!((a + b - 5.0).abs() < 1e-15 && (b - 3.0).abs() < 1e-15);
        assert_eq!(end_shares(&[(0.0, 3.0), (1.0, 3.0)]), [1.5, 1.5]);
    }
}
