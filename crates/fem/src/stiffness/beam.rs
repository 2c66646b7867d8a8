//! CBAR and CBEAM: stiffness from the flexibility of a cantilever.
//!
//! With end A clamped, forces p = (F, M) at end B on the shear-centre line make at x the section forces
//!
//! ```text
//! N = Fx, Vy = Fy, Vz = Fz, T = Mx,  m_y = My - (L - x) Fz - n_z Fx,  m_z = Mz + (L - x) Fy + n_y Fx
//! ```
//!
//! about the neutral axis at (n_y, n_z). The flexibility `f = int(B^T C B dx)` with the section's compliance C is
//! exact for any taper (Przemieniecki, Theory of Matrix Structural Analysis, 1968, ch. 5; the integral by Gauss's rule
//! between stations), and `K_BB = f^-1`; the rest follows from rigid motion, `K = [E -1]^T K_BB [E -1]`, where E
//! carries the motion of A to B. Rigid motion therefore costs no energy, whatever the section.
//!
//! Equations: THEORY (40), (41).

use nalgebra::{DMatrix, Matrix6, SMatrix, Vector3};

use albatross_nastran::deck::Components;

use super::section::{self, Rigidity, Stations};
use super::{GridPair, Stiffness};
use crate::context::Context;
use crate::error::Error;
use crate::line::LineCard;
use crate::rigid::{rigid_transfer, rotation_blocks};

/// Points and weights of Gauss's rule on (0, 1): order 2 for uniform stretches, where the integrand is quadratic, and
/// order 8 for tapered ones.
const GAUSS_2: [(f64, f64); 2] = [(0.211_324_865_405_187_13, 0.5), (0.788_675_134_594_812_9, 0.5)];
const GAUSS_8: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_824_8, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

pub(super) fn add(context: &Context<'_>, stiffness: &mut Stiffness) -> Result<(), Error> {
    for bar in context.deck.bars.values() {
        let property = context.deck.bar_properties.get(&bar.pid);
        let property =
            property.ok_or_else(|| context.missing("CBAR", bar.id, format!("PBAR or PBARL {}", bar.pid)))?;
        let stations = section::of_bar(context, bar.id, property)?;
        let pair = line(context, &LineCard::from(bar), &stations, bar.pins)?;
        stiffness.pairs.push(pair);
    }
    let mut warping = 0_usize;
    for beam in context.deck.beams.values() {
        let property = context.deck.beam_properties.get(&beam.pid);
        let property = property
            .ok_or_else(|| context.missing("CBEAM", beam.id, format!("PBEAM or PBEAML {}", beam.pid)))?;
        if beam.bit.is_some_and(|b| b != 0.0) {
            return Err(context.bad_element(
                "CBEAM",
                beam.id,
                "built-in twist (BIT) is not modelled; leave the field blank",
            ));
        }
        warping += usize::from(beam.warping != [0; 2]);
        let stations = section::of_beam(context, beam.id, property)?;
        let pair = line(context, &LineCard::from(beam), &stations, beam.pins)?;
        stiffness.pairs.push(pair);
    }
    if warping > 0 {
        stiffness
            .remarks
            .push(format!("warping of {warping} CBEAM (SA, SB, CW) is left out"));
    }
    Ok(())
}

/// Stiffness of one element at its grids, basic axes.
fn line(
    context: &Context<'_>,
    card: &LineCard<'_>,
    stations: &Stations,
    pins: [Components; 2],
) -> Result<GridPair, Error> {
    let axis = card.axis(context)?;
    let axes = card.axes(context, axis.vector)?;
    let tip = tip_stiffness(stations, axis.length).ok_or_else(|| {
        context.bad_element(
            card.name,
            card.id,
            "its stiffness cannot be formed: a section constant vanishes at one station and not at another, or is \
             out of proportion; correct the property",
        )
    })?;
    let e = rigid_transfer(Vector3::new(axis.length, 0.0, 0.0));
    let mut blocks = [e.transpose() * tip * e, -e.transpose() * tip, tip];
    if pins.iter().any(|p| !p.is_empty()) {
        blocks = released(&blocks, pins);
    }
    let turn = rotation_blocks(&axes);
    let [ea, eb] = axis.arms.map(|arm| turn.transpose() * rigid_transfer(arm));
    let [aa, ab, bb] = blocks;
    let blocks = [
        ea.transpose() * aa * ea,
        ea.transpose() * ab * eb,
        eb.transpose() * bb * eb,
    ];
    if !blocks.iter().all(|b| b.iter().all(|k| k.is_finite())) {
        return Err(context.bad_element(
            card.name,
            card.id,
            "its stiffness is not finite; correct the numbers on its cards",
        ));
    }
    let [a, b] = card.grids;
    Ok(GridPair {
        a,
        b: Some(b),
        blocks,
    })
}

/// K_BB: forces at a free end B for its displacements, end A clamped, in element axes. Deformations whose rigidity is
/// zero all along carry no force.
fn tip_stiffness(stations: &Stations, length: f64) -> Option<Matrix6<f64>> {
    let list = &stations.0;
    let none = |value: fn(&Rigidity) -> f64| list.iter().all(|s| value(&s.1) == 0.0);
    // Force components that the section can carry: Fx, Fy, Fz, Mx, My, Mz.
    let (plane_1, plane_2) = (!none(|r| r.bending[0]), !none(|r| r.bending[1]));
    let carried = [
        !none(|r| r.axial),
        plane_1,
        plane_2,
        !none(|r| r.torsion),
        plane_2,
        plane_1,
    ];
    let mut flexibility = Matrix6::zeros();
    for pair in list.windows(2) {
        let [(xa, a), (xb, b)] = [pair[0], pair[1]];
        let rule: &[(f64, f64)] = if a == b { &GAUSS_2 } else { &GAUSS_8 };
        for &(t, weight) in rule {
            let at = between(&a, &b, t);
            let distance = (1.0 - (xa + t * (xb - xa))) * length;
            add_compliance(
                &at,
                distance,
                carried,
                weight * (xb - xa) * length,
                &mut flexibility,
            )?;
        }
    }
    for (i, is_carried) in carried.iter().enumerate() {
        if !is_carried {
            flexibility[(i, i)] = 1.0;
        }
    }
    let mut stiffness = flexibility.cholesky()?.inverse();
    for (i, is_carried) in carried.iter().enumerate() {
        if !is_carried {
            stiffness.row_mut(i).fill(0.0);
            stiffness.column_mut(i).fill(0.0);
        }
    }
    Some((stiffness + stiffness.transpose()) * 0.5)
}

/// Linear between two stations: areas and moments, not compliances.
fn between(a: &Rigidity, b: &Rigidity, t: f64) -> Rigidity {
    if a == b {
        return *a;
    }
    let mix = |p: f64, q: f64| p + t * (q - p);
    // 1/(K G A): the reciprocal is linear.
    let shear = |p: f64, q: f64| {
        if p > 0.0 && q > 0.0 {
            1.0 / mix(1.0 / p, 1.0 / q)
        } else {
            0.0
        }
    };
    Rigidity {
        axial: mix(a.axial, b.axial),
        torsion: mix(a.torsion, b.torsion),
        bending: std::array::from_fn(|i| mix(a.bending[i], b.bending[i])),
        shear: std::array::from_fn(|i| shear(a.shear[i], b.shear[i])),
        neutral_axis: std::array::from_fn(|i| mix(a.neutral_axis[i], b.neutral_axis[i])),
    }
}

/// Adds weight B^T C B. `None` if a rigidity that carries force vanishes here.
fn add_compliance(
    r: &Rigidity,
    distance: f64,
    carried: [bool; 6],
    weight: f64,
    flexibility: &mut Matrix6<f64>,
) -> Option<()> {
    let [n_y, n_z] = r.neutral_axis;
    let [ei1, ei2, ei12] = r.bending;
    // Rows of B: bending moments about the neutral axis.
    let about_y = [-n_z, 0.0, -distance, 0.0, 1.0, 0.0];
    let about_z = [n_y, distance, 0.0, 0.0, 0.0, 1.0];
    let inverse = |value: f64, is_carried: bool| {
        if !is_carried {
            Some(0.0)
        } else {
            (value > 0.0).then(|| 1.0 / value)
        }
    };
    // Curvatures for moments: [c_yy, c_yz; c_yz, c_zz] = E [I2, -I12; -I12, I1]^-1.
    let (c_yy, c_zz, c_yz) = if ei12 != 0.0 {
        let determinant = ei1 * ei2 - ei12 * ei12;
        if !(determinant > 0.0 && carried[4] && carried[5]) {
            return None;
        }
        (ei1 / determinant, ei2 / determinant, ei12 / determinant)
    } else {
        (inverse(ei2, carried[4])?, inverse(ei1, carried[5])?, 0.0)
    };
    let direct = [
        inverse(r.axial, carried[0])?,
        if carried[1] { r.shear[0] } else { 0.0 },
        if carried[2] { r.shear[1] } else { 0.0 },
        inverse(r.torsion, carried[3])?,
    ];
    for (i, c) in direct.iter().enumerate() {
        flexibility[(i, i)] += weight * c;
    }
    for i in (0..6).filter(|&i| carried[i]) {
        for j in (0..6).filter(|&j| carried[j]) {
            flexibility[(i, j)] += weight
                * (c_yy * about_y[i] * about_y[j]
                    + c_zz * about_z[i] * about_z[j]
                    + c_yz * (about_y[i] * about_z[j] + about_z[i] * about_y[j]));
        }
    }
    Some(())
}

/// Pins: the released components at the ends carry no force; they are condensed out one after the other.
fn released(blocks: &[Matrix6<f64>; 3], pins: [Components; 2]) -> [Matrix6<f64>; 3] {
    let mut k = DMatrix::zeros(12, 12);
    k.view_mut((0, 0), (6, 6)).copy_from(&blocks[0]);
    k.view_mut((0, 6), (6, 6)).copy_from(&blocks[1]);
    k.view_mut((6, 0), (6, 6)).copy_from(&blocks[1].transpose());
    k.view_mut((6, 6), (6, 6)).copy_from(&blocks[2]);
    let size = k.diagonal();
    for (end, components) in pins.into_iter().enumerate() {
        for c in components.iter() {
            let i = 6 * end + usize::from(c) - 1;
            let pivot = k[(i, i)];
            // Released before by the other end's pin: nothing is left.
            if pivot > 1e-12 * size[i] {
                let column = k.column(i).clone_owned();
                k -= &column * column.transpose() / pivot;
            }
            k.row_mut(i).fill(0.0);
            k.column_mut(i).fill(0.0);
        }
    }
    let block = |i: usize, j: usize| -> Matrix6<f64> {
        SMatrix::from_fn(|r, c| 0.5 * (k[(6 * i + r, 6 * j + c)] + k[(6 * j + c, 6 * i + r)]))
    };
    [block(0, 0), block(0, 1), block(1, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(r: Rigidity) -> Stations {
        Stations(vec![(0.0, r), (1.0, r)])
    }

    const SECTION: Rigidity = Rigidity {
        axial: 3.0e8,
        torsion: 2.0e6,
        bending: [5.0e6, 7.0e6, 0.0],
        shear: [0.0; 2],
        neutral_axis: [0.0; 2],
    };

    /// K_BB of the slender beam: E A/L, 12 E I/L^3, 6 E I/L^2, 4 E I/L.
    #[test]
    fn val_uniform_beam() {
        let l = 2.5;
        let k = tip_stiffness(&uniform(SECTION), l).expect("sound");
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} {b}");
        close(k[(0, 0)], 3.0e8 / l);
        close(k[(1, 1)], 12.0 * 5.0e6 / l.powi(3));
        close(k[(2, 2)], 12.0 * 7.0e6 / l.powi(3));
        close(k[(3, 3)], 2.0e6 / l);
        close(k[(4, 4)], 4.0 * 7.0e6 / l);
        close(k[(5, 5)], 4.0 * 5.0e6 / l);
        close(k[(1, 5)], -6.0 * 5.0e6 / l.powi(2));
        close(k[(2, 4)], 6.0 * 7.0e6 / l.powi(2));
    }

    /// Principal axes turned by an angle: I12 makes the same beam in turned axes.
    #[test]
    fn val_product_of_inertia_turns_the_section() {
        let (s, c) = 0.4_f64.sin_cos();
        let [i1, i2, _] = SECTION.bending;
        // y' = c y + s z is a principal direction with int(y'^2) = I1.
        let turned = Rigidity {
            bending: [
                c * c * i1 + s * s * i2,
                s * s * i1 + c * c * i2,
                c * s * (i1 - i2),
            ],
            ..SECTION
        };
        let axes = nalgebra::Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c);
        let turn = rotation_blocks(&axes);
        let expected = turn * tip_stiffness(&uniform(SECTION), 1.7).expect("sound") * turn.transpose();
        let got = tip_stiffness(&uniform(turned), 1.7).expect("sound");
        assert!((got - expected).amax() < 1e-12 * expected.amax());
    }

    /// A neutral axis beside the shear-centre line is the same beam (without torsion) moved by a rigid arm.
    #[test]
    fn val_neutral_axis_is_a_rigid_arm() {
        let offset = Rigidity {
            neutral_axis: [0.2, -0.3],
            torsion: 0.0,
            ..SECTION
        };
        let plain = Rigidity {
            torsion: 0.0,
            ..SECTION
        };
        let e = rigid_transfer(Vector3::new(0.0, 0.2, -0.3));
        let k = tip_stiffness(&uniform(plain), 2.0).expect("sound");
        let mut moved = e.transpose() * k * e;
        // The shear force stays on the shear centre, so only the axial force moves.
        let mut axial_arm = Matrix6::identity();
        axial_arm[(0, 4)] = -0.3;
        axial_arm[(0, 5)] = -0.2;
        moved.copy_from(&(axial_arm.transpose() * k * axial_arm));
        let got = tip_stiffness(&uniform(offset), 2.0).expect("sound");
        assert!((got - moved).amax() < 1e-11 * moved.amax(), "{got} {moved}");
    }
}
