//! From modes and strips of any finite numbers to matrices, flutter and divergence.

use albatross::modal::{
    BasisGrid, BasisMass, BasisOptions, LoadReferenceAxis, ModalBasis, ModeInput, Normalisation, Station,
    interpolate,
};
use albatross::numerics::eigen;
use albatross::numerics::interp::Method;
use albatross::strip::elastic::{compact_state_matrix, quasi_steady_state_matrix, state_matrix};
use albatross::strip::flutter::{divergence_speed, exact_flutter, lag_flutter};
use albatross::strip::kernels::JONES;
use albatross::strip::sweep::{self, sweep};
use albatross::strip::{
    AeroelasticModel, DihedralForm, DownwashPoint, Flow, Split, Strip, StripShapes, StripTheory, Structure,
};
use arbitrary::{Arbitrary, Result, Unstructured};

/// A finite number: of any size, or one of those that aircraft have.
#[derive(Debug, Clone, Copy)]
pub struct Finite(f64);

impl<'a> Arbitrary<'a> for Finite {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let any = if u.ratio(1_u8, 8_u8)? {
            f64::from_bits(u.arbitrary()?)
        } else {
            f64::from(u.arbitrary::<i16>()?) / 256.0
        };
        Ok(Self(if any.is_finite() { any } else { 0.0 }))
    }
}

/// A grid, and its six motions in each mode.
#[derive(Debug, Arbitrary)]
struct Grid {
    position: [Finite; 3],
    motion: [[Finite; 6]; 2],
}

#[derive(Debug, Arbitrary)]
struct ArbitraryStrip {
    place: [Finite; 3],
    width: Finite,
    chord: Finite,
    cl_alpha: Finite,
    dihedral: Finite,
}

/// A structure of a few grids and two modes, a few strips, the choices of the theory and a flow.
#[derive(Debug, Arbitrary)]
pub struct Case {
    interpolation: u8,
    choices: [bool; 5],
    frequency: [Finite; 2],
    mass: [Finite; 2],
    damping: [Finite; 2],
    rho: Finite,
    speeds: [Finite; 3],
    grids: [Grid; 3],
    grid_count: u8,
    strips: [ArbitraryStrip; 3],
    strip_count: u8,
}

/// Runs the chain; errors are right, panics are not.
pub fn run(case: &Case) {
    let Some(model) = model(case) else { return };
    let [rho, speed] = [case.rho.0, case.speeds[0].0];
    let flow = Flow { rho, speed };
    if let Ok(matrix) = state_matrix(&model, flow) {
        drop(eigen::eigenvalues(matrix.as_ref()));
    }
    drop(compact_state_matrix(&model, flow));
    drop(quasi_steady_state_matrix(&model, flow));
    drop(divergence_speed(&model, rho));
    drop(lag_flutter(&model, rho));
    if case.choices[4] {
        drop(exact_flutter(&model, rho));
        let mut speeds = case.speeds.map(|s| s.0.abs());
        speeds.sort_by(f64::total_cmp);
        for method in [sweep::Method::StateSpace, sweep::Method::PK] {
            drop(sweep(&model, rho, &speeds, method));
        }
    }
}

fn model(case: &Case) -> Option<AeroelasticModel> {
    let [general, theodorsen, yates, unit_mass, _] = case.choices;
    let grids = || case.grids.iter().take(1 + usize::from(case.grid_count % 3));
    let modes = (0..2)
        .map(|k| ModeInput {
            number: k + 7,
            omega_rad_s: case.frequency[k].0.abs(),
            generalized_mass: case.mass[k].0.abs(),
            shape: grids().map(|g| g.motion[k].map(|m| m.0)).collect(),
        })
        .collect();
    let options = BasisOptions {
        normalisation: if unit_mass {
            Normalisation::UnitMass
        } else {
            Normalisation::AsGiven
        },
        ..BasisOptions::default()
    };
    let basis_grids: Vec<BasisGrid> = (1..)
        .zip(grids())
        .map(|(id, g)| BasisGrid {
            id,
            position: g.position.map(|x| x.0),
        })
        .collect();
    let axis = LoadReferenceAxis {
        name: "axis".into(),
        grids: basis_grids.iter().map(|g| g.id).collect(),
    };
    let basis = ModalBasis::try_new(basis_grids, modes, BasisMass::unknown(), &options).ok()?;

    let arbitrary = || case.strips.iter().take(1 + usize::from(case.strip_count % 3));
    let stations: Vec<Station> = arbitrary()
        .map(|s| {
            let [x, y, z] = s.place.map(|x| x.0);
            Station { x, y, z }
        })
        .collect();
    let method =
        [Method::Linear, Method::Pchip, Method::Cubic, Method::Akima][usize::from(case.interpolation % 4)];
    let on_axis = interpolate(&basis, &axis, &stations, method).ok()?;
    let strips: Vec<Strip> = arbitrary()
        .zip(&stations)
        .zip(&on_axis.x_lra)
        .map(|((s, at), &x_lra)| Strip {
            y: at.y,
            z: at.z,
            width: s.width.0.abs(),
            chord: s.chord.0.abs(),
            x_ac: at.x,
            x_lra,
            cl_alpha: s.cl_alpha.0,
            dihedral_rad: s.dihedral.0,
        })
        .collect();
    let form = if general {
        DihedralForm::General
    } else {
        DihedralForm::Paper
    };
    let [_, t_y, t_z] = &on_axis.translation;
    let [_, r_y, r_z] = &on_axis.rotation;
    let shapes = StripShapes::from_components(&strips, form, [t_y, t_z], [r_y, r_z]).ok()?;

    let omega: Vec<f64> = basis.modes.iter().map(|m| m.omega_rad_s).collect();
    let structure = Structure::modal(&basis.generalized_masses(), &omega, &case.damping.map(|x| x.0)).ok()?;
    let theory = StripTheory {
        downwash_point: if yates {
            DownwashPoint::Yates
        } else {
            DownwashPoint::ThreeQuarter
        },
        ..StripTheory::default()
    };
    let split = if theodorsen {
        Split::Theodorsen
    } else {
        Split::ApparentMass
    };
    AeroelasticModel::try_new(structure, strips, shapes, &theory, split, &JONES).ok()
}
