//! Mass of CBAR, CBEAM, CROD and CONROD.

use albatross_nastran::deck::{BeamProperty, Id};
use nalgebra::{Matrix3, Matrix6, Vector3};

use super::{BarMass, DeckMass, check_finite};
use crate::context::Context;
use crate::error::Error;
use crate::line::{LineAxis, LineCard};
use crate::mass_model::rigid_block;
use crate::rigid::{rigid_transfer, skew};

/// A line element with the mass at its two ends.
struct Line {
    name: &'static str,
    id: Id,
    grids: [Id; 2],
    /// From each grid to the mass at the element's end, basic axes, m.
    arms: [Vector3<f64>; 2],
    /// From end A to end B of the element, m.
    vector: Vector3<f64>,
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
        let rho = context.material("CBAR", bar.id, property.mid())?.rho;
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
        let LineAxis { arms, vector, .. } = LineCard::from(bar).axis(context)?;
        Line {
            name: "CBAR",
            id: bar.id,
            grids: bar.grids,
            arms,
            vector,
            per_length: [mu / 2.0; 2],
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
        let rho = context.material("CBEAM", beam.id, property.mid())?.rho;
        let (Some(stations), Some([axial, nsi])) = (property.mass_stations(), axial_inertia(property, rho))
        else {
            mass.other.push(format!(
                "CBEAM {} (area or moments of its section are not known)",
                beam.id
            ));
            continue;
        };
        let structural = stations.iter().map(|&(x, area, _)| (x, rho * area));
        let nonstructural = stations.iter().map(|&(x, _, nsm)| (x, nsm));
        let total = stations.iter().map(|&(x, area, nsm)| (x, rho * area + nsm));
        let card = LineCard::from(beam);
        let add = |shares: [f64; 2], axial_inertia, eccentricity: Option<[f64; 4]>, mass: &mut DeckMass| {
            if shares == [0.0; 2] && axial_inertia == 0.0 {
                return Ok(());
            }
            let LineAxis { mut arms, vector, .. } = card.axis(context)?;
            if let Some([ya, za, yb, zb]) = eccentricity {
                let axes = card.axes(context, vector)?;
                arms[0] += axes * Vector3::new(0.0, ya, za);
                arms[1] += axes * Vector3::new(0.0, yb, zb);
            }
            Line {
                name: "CBEAM",
                id: beam.id,
                grids: beam.grids,
                arms,
                vector,
                per_length: shares,
                axial_inertia,
                coupled,
            }
            .add_to(context, mass)
        };
        let (on_axis, at_nsm) = match property {
            BeamProperty::Pbeam(p) => (end_offsets(&p.ends.neutral_axis), end_offsets(&p.ends.nsm_center)),
            BeamProperty::Pbeaml(_) => (None, None),
        };
        if on_axis == at_nsm {
            add(end_shares(&total.collect::<Vec<_>>()), axial + nsi, on_axis, mass)?;
        } else {
            add(end_shares(&structural.collect::<Vec<_>>()), axial, on_axis, mass)?;
            add(end_shares(&nonstructural.collect::<Vec<_>>()), nsi, at_nsm, mass)?;
        }
    }
    Ok(())
}

fn add_rods(context: &Context<'_>, coupled: bool, mass: &mut DeckMass) -> Result<(), Error> {
    let mut rods = Vec::new();
    for rod in context.deck.rods.values() {
        let property = context.deck.rod_properties.get(&rod.pid);
        let property =
            property.ok_or_else(|| context.missing("CROD", rod.id, format!("PROD {}", rod.pid)))?;
        let rho = context.material("CROD", rod.id, property.mid)?.rho;
        rods.push(("CROD", rod.id, rod.grids, rho * property.area + property.nsm));
    }
    for rod in context.deck.conrods.values() {
        let rho = context.material("CONROD", rod.id, rod.mid)?.rho;
        rods.push(("CONROD", rod.id, rod.grids, rho * rod.area + rod.nsm));
    }
    rods.retain(|r| r.3 != 0.0);
    if coupled && !rods.is_empty() {
        mass.notes
            .push("rods are lumped although the deck asks for coupled mass".into());
    }
    for (name, id, grids, mu) in rods {
        let [a, b] = grids;
        let vector = context.grid(name, id, b)?.position - context.grid(name, id, a)?.position;
        let arms = [Vector3::zeros(); 2];
        let per_length = [mu / 2.0; 2];
        let line = Line {
            name,
            id,
            grids,
            arms,
            vector,
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
        let axis = self.vector;
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
            check_finite(context, self.name, self.id, block)?;
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

/// (y, z) at A, then at B; those of B are as at A when blank. `None` on the shear centre.
pub(crate) fn end_offsets(values: &[Option<f64>; 4]) -> Option<[f64; 4]> {
    let [ya, za, yb, zb] = *values;
    let (ya, za) = (ya.unwrap_or(0.0), za.unwrap_or(0.0));
    let offsets = [ya, za, yb.unwrap_or(ya), zb.unwrap_or(za)];
    (offsets != [0.0; 4]).then_some(offsets)
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

/// Inertia of a beam about its axis per length, kg m, mean of both ends: the structural part rho (I1 + I2), and the
/// non-structural part. Nastran gives it to CBEAM and not to CBAR. `None` when the moments of a section are not known.
fn axial_inertia(property: &BeamProperty, rho: f64) -> Option<[f64; 2]> {
    let polar = |(i1, i2): (f64, f64)| i1 + i2;
    match property {
        BeamProperty::Pbeam(beam) => {
            let a = beam.stations.first()?;
            let b = beam.stations.iter().find(|s| s.x == 1.0).unwrap_or(a);
            let at_a = (a.i1.unwrap_or(0.0), a.i2.unwrap_or(0.0));
            let at_b = (b.i1.unwrap_or(at_a.0), b.i2.unwrap_or(at_a.1));
            let [nsi_a, nsi_b] = beam.ends.nsi;
            let nsi_a = nsi_a.unwrap_or(0.0);
            Some([
                rho * (polar(at_a) + polar(at_b)) / 2.0,
                (nsi_a + nsi_b.unwrap_or(nsi_a)) / 2.0,
            ])
        }
        BeamProperty::Pbeaml(_) if rho == 0.0 => Some([0.0; 2]),
        BeamProperty::Pbeaml(beam) => {
            let a = beam.stations.first()?;
            let b = beam.stations.iter().find(|s| s.x == 1.0).unwrap_or(a);
            let sum = polar(a.section.second_moments()?) + polar(b.section.second_moments()?);
            Some([rho * sum / 2.0, 0.0])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass_model::MassModel;

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
