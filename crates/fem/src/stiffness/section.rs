//! Section constants of bars and beams along their length.

use albatross_nastran::deck::{BarProperty, BeamProperty, Id, Pbar, Pbeam, Pbeaml, Section, SectionShape};
use albatross_numerics::ShortNumber;

use crate::context::Context;
use crate::error::Error;
use crate::mass::end_offsets;

/// Elastic constants of a section. Planes: 1 is local x-y, 2 is local x-z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rigidity {
    /// E A, N.
    pub(crate) axial: f64,
    /// G J, N m^2.
    pub(crate) torsion: f64,
    /// E I1, E I2, E I12, N m^2.
    pub(crate) bending: [f64; 3],
    /// Shear compliance 1/(K G A) in planes 1 and 2, 1/N; 0 is rigid.
    pub(crate) shear: [f64; 2],
    /// Neutral axis (y, z) from the shear centre, m.
    pub(crate) neutral_axis: [f64; 2],
}

/// Rigidity at stations x = 0 ... 1, linear between.
#[derive(Debug, Clone)]
pub(crate) struct Stations(pub(crate) Vec<(f64, Rigidity)>);

/// E and G of an isotropic material; of E, G and nu two give the third, `E = 2 (1 + nu) G`.
pub(super) fn moduli(context: &Context<'_>, name: &str, id: Id, mid: Id) -> Result<(f64, f64), Error> {
    let m = context.material(name, id, mid)?;
    let (e, g) = match (m.e, m.g, m.nu) {
        (Some(e), Some(g), _) => (e, g),
        (Some(e), None, Some(nu)) => (e, e / (2.0 * (1.0 + nu))),
        (None, Some(g), Some(nu)) => (2.0 * (1.0 + nu) * g, g),
        // With one modulus alone Nastran takes nu and the other as zero.
        (Some(e), None, None) => (e, 0.0),
        (None, Some(g), None) => (0.0, g),
        (None, None, _) => {
            return Err(context.bad_element("MAT1", mid, "it has neither E nor G; give one of them"));
        }
    };
    if e.is_finite() && g.is_finite() && e >= 0.0 && g >= 0.0 {
        return Ok((e, g));
    }
    Err(context.bad_element(
        "MAT1",
        mid,
        format!(
            "its moduli are E = {}, G = {}; expected numbers that are not negative",
            ShortNumber(e),
            ShortNumber(g)
        ),
    ))
}

/// Shear compliance from the factor on the card; `None` or 0 is rigid in shear.
fn shear_compliance(factor: Option<f64>, g: f64, area: f64) -> f64 {
    match factor {
        Some(k) if k > 0.0 && g * area > 0.0 => 1.0 / (k * g * area),
        _ => 0.0,
    }
}

struct Constants {
    area: f64,
    i1: f64,
    i2: f64,
    i12: f64,
    torsion: f64,
    shear_factors: [Option<f64>; 2],
}

impl Constants {
    fn rigidity(&self, (e, g): (f64, f64), neutral_axis: [f64; 2]) -> Rigidity {
        Rigidity {
            axial: e * self.area,
            torsion: g * self.torsion,
            bending: [e * self.i1, e * self.i2, e * self.i12],
            shear: self.shear_factors.map(|k| shear_compliance(k, g, self.area)),
            neutral_axis,
        }
    }
}

pub(super) fn of_bar(context: &Context<'_>, id: Id, property: &BarProperty) -> Result<Stations, Error> {
    let elastic = moduli(context, "CBAR", id, property.mid())?;
    let constants = match property {
        BarProperty::Pbar(p) => of_pbar(p),
        BarProperty::Pbarl(p) => of_section(context, "PBARL", p.id, &p.section)?,
    };
    let rigidity = constants.rigidity(elastic, [0.0; 2]);
    check(context, property_name(property), property.id(), &rigidity)?;
    Ok(Stations(vec![(0.0, rigidity), (1.0, rigidity)]))
}

fn property_name(property: &BarProperty) -> &'static str {
    match property {
        BarProperty::Pbar(_) => "PBAR",
        BarProperty::Pbarl(_) => "PBARL",
    }
}

fn of_pbar(p: &Pbar) -> Constants {
    Constants {
        area: p.area,
        i1: p.i1,
        i2: p.i2,
        i12: p.i12,
        torsion: p.torsion_constant,
        shear_factors: [p.k1, p.k2],
    }
}

pub(super) fn of_beam(context: &Context<'_>, id: Id, property: &BeamProperty) -> Result<Stations, Error> {
    let elastic = moduli(context, "CBEAM", id, property.mid())?;
    let (name, stations) = match property {
        BeamProperty::Pbeam(p) => ("PBEAM", of_pbeam(context, p, elastic)?),
        BeamProperty::Pbeaml(p) => ("PBEAML", of_pbeaml(context, p, elastic)?),
    };
    for (_, rigidity) in &stations {
        check(context, name, property.id(), rigidity)?;
    }
    Ok(Stations(stations))
}

/// Stations of a PBEAM, blanks resolved: end B as end A, intermediate ones linear between the ends.
fn of_pbeam(context: &Context<'_>, p: &Pbeam, elastic: (f64, f64)) -> Result<Vec<(f64, Rigidity)>, Error> {
    let bad = |problem: &str| context.bad_element("PBEAM", p.id, problem);
    let a = p
        .stations
        .first()
        .ok_or_else(|| bad("it has no station; give A, I1 and I2"))?;
    let b = p.stations.iter().skip(1).find(|s| s.x == 1.0);
    let [k1, k2] = p.ends.shear_factors.map(|k| Some(k.unwrap_or(1.0)));
    if p.ends.shear_relief.iter().flatten().any(|&s| s != 0.0) {
        return Err(bad(
            "shear relief (S1, S2) is not modelled; set it to zero, or use elements short enough to be uniform",
        ));
    }
    let at_a = [
        a.area.unwrap_or(0.0),
        a.i1.unwrap_or(0.0),
        a.i2.unwrap_or(0.0),
        a.i12.unwrap_or(0.0),
        a.torsion_constant.unwrap_or(0.0),
    ];
    let own = |s: &albatross_nastran::deck::BeamStation| [s.area, s.i1, s.i2, s.i12, s.torsion_constant];
    let fill = |given: [Option<f64>; 5], default: [f64; 5]| {
        let mut values = default;
        for (value, given) in values.iter_mut().zip(given) {
            *value = given.unwrap_or(*value);
        }
        values
    };
    let at_b = b.map_or(at_a, |b| fill(own(b), at_a));
    let mut table = vec![(0.0, at_a), (1.0, at_b)];
    for s in p.stations.iter().skip(1).filter(|s| s.x > 0.0 && s.x < 1.0) {
        let mut between = at_a;
        for (v, b) in between.iter_mut().zip(at_b) {
            *v += s.x * (b - *v);
        }
        table.push((s.x, fill(own(s), between)));
    }
    table.sort_by(|p, q| p.0.total_cmp(&q.0));
    let [ya, za, yb, zb] = end_offsets(&p.ends.neutral_axis).unwrap_or_default();
    Ok(table
        .into_iter()
        .map(|(x, [area, i1, i2, i12, torsion])| {
            let constants = Constants {
                area,
                i1,
                i2,
                i12,
                torsion,
                shear_factors: [k1, k2],
            };
            let axis = [ya + x * (yb - ya), za + x * (zb - za)];
            (x, constants.rigidity(elastic, axis))
        })
        .collect())
}

fn of_pbeaml(context: &Context<'_>, p: &Pbeaml, elastic: (f64, f64)) -> Result<Vec<(f64, Rigidity)>, Error> {
    let mut table = Vec::with_capacity(p.stations.len() + 1);
    for s in &p.stations {
        use SectionShape as S;
        let centred = matches!(
            s.section.shape,
            S::Rod | S::Tube | S::Tube2 | S::Bar | S::Box | S::H | S::Cross | S::I1 | S::Z
        ) || is_symmetric_i(&s.section);
        if !centred {
            return Err(context.bad_element(
                "PBEAML",
                p.id,
                format!(
                    "the shear centre of a {} is not known here; give the constants on a PBEAM, with N1 and N2",
                    s.section.shape
                ),
            ));
        }
        let constants = of_section(context, "PBEAML", p.id, &s.section)?;
        table.push((s.x, constants.rigidity(elastic, [0.0; 2])));
    }
    table.sort_by(|p, q| p.0.total_cmp(&q.0));
    let first = table
        .first()
        .copied()
        .ok_or_else(|| context.bad_element("PBEAML", p.id, "it has no station; give its dimensions"))?;
    if table.last().is_some_and(|s| s.0 < 1.0) {
        table.push((1.0, first.1));
    }
    Ok(table)
}

/// An I with equal flanges: its shear centre is its centroid.
fn is_symmetric_i(section: &Section) -> bool {
    section.shape == SectionShape::I
        && matches!(section.dims.as_slice(), &[_, b, t, _, tb, tt] if b == t && tb == tt)
}

/// Constants of a standard section. Shear factors are those of the manual where they are plain: 0.9 for ROD, 0.5 for
/// tubes, 5/6 for BAR, and the area of the walls along the load for BOX; the others are rigid in shear.
fn of_section(context: &Context<'_>, name: &str, id: Id, section: &Section) -> Result<Constants, Error> {
    use SectionShape as S;
    let unknown = |what: &str| {
        context.bad_element(
            name,
            id,
            format!(
                "the {what} of a {} is not known here; give the constants on a {}",
                section.shape,
                if name == "PBARL" { "PBAR" } else { "PBEAM" }
            ),
        )
    };
    let area = section.area().ok_or_else(|| unknown("area"))?;
    let (i1, i2) = section.second_moments().ok_or_else(|| unknown("second moment"))?;
    let i12 = product_moment(section).ok_or_else(|| unknown("product of inertia"))?;
    let torsion = section
        .torsion_constant()
        .or_else(|| open_torsion(section))
        .ok_or_else(|| unknown("torsion constant"))?;
    let shear_factors = match (section.shape, section.dims.as_slice()) {
        (S::Rod, _) => [Some(0.9); 2],
        (S::Tube | S::Tube2, _) => [Some(0.5); 2],
        (S::Bar, _) => [Some(5.0 / 6.0); 2],
        (S::Box, &[w, h, t_flange, t_web]) => [Some(2.0 * h * t_web / area), Some(2.0 * w * t_flange / area)],
        _ => [None; 2],
    };
    Ok(Constants {
        area,
        i1,
        i2,
        i12,
        torsion,
        shear_factors,
    })
}

/// int(y z dA) about the centroid: zero for sections with an axis of symmetry, the sum over the walls for the two
/// without.
fn product_moment(section: &Section) -> Option<f64> {
    use SectionShape as S;
    match (section.shape, section.dims.as_slice()) {
        // The flanges lie to opposite sides, each at +-(h - t)/2 by +-(t_web + beyond)/2.
        (S::Z, &[beyond, t_web, inner, h]) => {
            let t = (h - inner) / 2.0;
            Some(2.0 * beyond * t * ((t_web + beyond) / 2.0) * ((h - t) / 2.0))
        }
        (S::L, &[w, h, t_foot, t_leg]) => {
            let walls = [
                (w * t_foot, w / 2.0, t_foot / 2.0),
                (t_leg * (h - t_foot), t_leg / 2.0, (h + t_foot) / 2.0),
            ];
            let area: f64 = walls.iter().map(|w| w.0).sum();
            let z_c = walls.iter().map(|w| w.0 * w.1).sum::<f64>() / area;
            let y_c = walls.iter().map(|w| w.0 * w.2).sum::<f64>() / area;
            Some(walls.iter().map(|w| w.0 * (w.1 - z_c) * (w.2 - y_c)).sum())
        }
        (S::Box1, &[_, _, t_top, t_bottom, t_left, t_right]) if t_top != t_bottom && t_left != t_right => {
            None
        }
        (S::Hexa | S::Hat | S::Hat1 | S::Dbox, _) => None,
        _ => Some(0.0),
    }
}

/// Torsion constant of an open section of thin walls, sum of b t^3 / 3 (Saint-Venant).
fn open_torsion(section: &Section) -> Option<f64> {
    use SectionShape as S;
    let wall = |b: f64, t: f64| b * t.powi(3) / 3.0;
    Some(match (section.shape, section.dims.as_slice()) {
        (S::I, &[h, w_bottom, w_top, t_web, t_bottom, t_top]) => {
            wall(w_bottom, t_bottom) + wall(w_top, t_top) + wall(h - (t_bottom + t_top) / 2.0, t_web)
        }
        (S::I1 | S::Z, &[beyond, t_web, inner, h]) => {
            let t = (h - inner) / 2.0;
            let flange = if section.shape == S::I1 {
                beyond + t_web
            } else {
                beyond + t_web / 2.0
            };
            2.0 * wall(flange, t) + wall(h - t, t_web)
        }
        (S::T | S::T2, &[w, h, t_flange, t_web]) => wall(w, t_flange) + wall(h - t_flange / 2.0, t_web),
        (S::T1, &[h, stem, t_flange, t_stem]) => wall(h, t_flange) + wall(stem + t_flange / 2.0, t_stem),
        (S::L, &[w, h, t_foot, t_leg]) => wall(w - t_leg / 2.0, t_foot) + wall(h - t_foot / 2.0, t_leg),
        (S::Chan, &[w, h, t_web, t_flange]) => {
            2.0 * wall(w - t_web / 2.0, t_flange) + wall(h - t_flange, t_web)
        }
        (S::Chan1, &[beyond, t_web, inner, h]) => {
            let t = (h - inner) / 2.0;
            2.0 * wall(beyond + t_web / 2.0, t) + wall(h - t, t_web)
        }
        (S::Chan2, &[t_leg, t_web, h, w]) => 2.0 * wall(h - t_web / 2.0, t_leg) + wall(w - t_leg, t_web),
        (S::H, &[gap, t_sides, h, t_cross]) => 2.0 * wall(h, t_sides / 2.0) + wall(gap, t_cross),
        (S::Cross, &[beyond, t_upright, h, t_arm]) => wall(h, t_upright) + wall(beyond, t_arm),
        _ => return None,
    })
}

/// No negative rigidity, and a bending matrix that is not indefinite.
fn check(context: &Context<'_>, name: &str, id: Id, r: &Rigidity) -> Result<(), Error> {
    let [ei1, ei2, ei12] = r.bending;
    let values = [r.axial, r.torsion, ei1, ei2, r.shear[0], r.shear[1]];
    let sound = values.iter().all(|v| v.is_finite() && *v >= 0.0) && ei12.is_finite();
    if sound && (ei12 == 0.0 || ei1 * ei2 > ei12 * ei12) {
        return Ok(());
    }
    Err(context.bad_element(
        name,
        id,
        format!(
            "its section has E A = {}, G J = {}, E I1 = {ei1}, E I2 = {ei2}, E I12 = {ei12}; expected numbers that are \
             not negative, with I1 I2 > I12^2",
            r.axial, r.torsion
        ),
    ))
}
