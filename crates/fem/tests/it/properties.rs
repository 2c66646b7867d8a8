//! What holds for any placement of elements.

use albatross_fem::{FemModel, ModelOptions, rigid_shape};
use albatross_nastran::frames::Frames;
use proptest::prelude::*;

use crate::support::{close, modes, parse};

fn fields(values: &[f64]) -> String {
    values
        .iter()
        .map(|v| format!("{v:.14e}"))
        .collect::<Vec<_>>()
        .join(",")
}

/// A deck of one of each element between grids in turned systems (7 rectangular, 8 cylindrical), with offsets.
fn mixed(points: &[[f64; 3]; 4], offset: [f64; 3], cd: [u32; 4], numbers: [u32; 4]) -> String {
    let [a, b, c, d] = numbers;
    let mut bulk = String::from(
        "MAT1,1,7.+10,2.6+10,,2700.\nCORD2R,7,,0.1,0.,0.,0.3,0.2,1.\n,1.,0.,0.2\nCORD2C,8,,-9.,2.,0.,-9.3,0.2,1.\n,1.,0.,0.2\n\
         PBAR,1,1,0.005,1.-6,4.-6,2.-6,3.,,\n,\n,0.4,0.6,5.-7\nPROD,3,1,0.002,1.-6\nPBUSH,4,K,1.+6,2.+6,3.+6,4.+4,5.+4,6.+4\n\
         PBEAM,2,1,0.01,3.-6,6.-6,1.-6,2.-6\n,,,,,,,,\n,NO,1.,0.008,2.-6,5.-6,,1.-6\n,,,,,,,,\n,,,0.01,0.02,0.03,0.,0.01,-0.02\n",
    );
    for (k, id) in numbers.iter().enumerate() {
        bulk += &format!("GRID,{id},,{},{}\n", fields(&points[k]), cd[k]);
    }
    // Offsets are written in basic directions through OFFT = BGG only where CD is basic, so bars sit on grids a and b
    // with the offset in their own systems.
    bulk += &format!("CBAR,1,1,{a},{b},0.3,0.5,1.,BGG\n,,,{}\n", fields(&offset));
    bulk += &format!(
        "CBEAM,2,2,{b},{c},0.3,0.5,1.,BOO\n,,,{}\n",
        fields(&[offset[0], offset[1], offset[2], 0.1, 0.0, -0.1])
    );
    bulk += &format!("CROD,3,3,{c},{a}\nCBUSH,4,4,{c},{d},,,,0\n,0.3\n");
    bulk += &format!("CONM2,5,{d},0,12.,0.1,0.2,-0.3\n,1.,,1.5,,,2.\n");
    bulk
}

fn model(bulk: &str) -> FemModel {
    FemModel::assemble(&parse(bulk), &ModelOptions::default()).expect("a model")
}

fn position() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-3.0..3.0_f64)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Six rigid motions without force, total mass, and six modes at zero.
    #[test]
    fn prop_rigid_motion_costs_nothing(
        spread in prop::array::uniform4(position()),
        offset in prop::array::uniform3(-0.4..0.4_f64),
        cd in prop::array::uniform4(prop::sample::select(vec![0_u32, 7, 8])),
    ) {
        // Apart from each other and off each other's lines.
        let base = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 10.0]];
        let points: [[f64; 3]; 4] = std::array::from_fn(|k| std::array::from_fn(|i| base[k][i] + 0.5 * spread[k][i]));
        let bulk = mixed(&points, offset, cd, [1, 2, 3, 4]);
        let model = model(&bulk);
        let frames = Frames::resolve(&parse(&bulk)).expect("frames");
        let diagonal = model.stiffness().diagonal();
        for direction in 0..6 {
            let shape = rigid_shape(direction, [1.0, -2.0, 0.5], &points);
            let mut r = Vec::new();
            for (k, s) in shape.iter().enumerate() {
                let axes = frames.grid(k as u32 + 1).expect("grid").axes.transpose();
                r.extend((axes * nalgebra::Vector3::new(s[0], s[1], s[2])).iter());
                r.extend((axes * nalgebra::Vector3::new(s[3], s[4], s[5])).iter());
            }
            let force = model.stiffness().apply(&r).expect("a vector of the order");
            let size: f64 = diagonal.iter().zip(&r).map(|(d, r)| (d * r).abs()).fold(0.0, f64::max);
            prop_assert!(force.iter().all(|f| f.abs() < 1e-11 * size), "{direction} {force:?} {size:e}");
        }
        let modes = modes(&model, 8);
        prop_assert!(modes.eigenvalues[5].abs() < 1e-6 * modes.eigenvalues[6], "{:?}", modes.eigenvalues);
        prop_assert!(modes.residuals.iter().all(|&r| r < 1e-10));
    }

    /// Frequencies do not depend on numbers, nor on the systems in which grids move (without offsets in those).
    #[test]
    fn prop_frequencies_do_not_depend_on_numbers_or_systems(
        spread in prop::array::uniform4(position()),
        cd in prop::array::uniform4(prop::sample::select(vec![0_u32, 7, 8])),
    ) {
        let base = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 10.0]];
        let points: [[f64; 3]; 4] = std::array::from_fn(|k| std::array::from_fn(|i| base[k][i] + 0.5 * spread[k][i]));
        let plain = modes(&model(&mixed(&points, [0.0; 3], [0; 4], [1, 2, 3, 4])), 12);
        let other = modes(&model(&mixed(&points, [0.0; 3], cd, [41, 7, 3, 12])), 12);
        for k in 6..12 {
            close(other.frequencies_hz[k], plain.frequencies_hz[k], 1e-8);
        }
    }

    /// Lumped or coupled, the mass is the deck's: (rho A + nsm) L of each element, whatever the placement.
    #[test]
    fn prop_total_mass(spread in prop::array::uniform4(position())) {
        let base = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 10.0]];
        let points: [[f64; 3]; 4] = std::array::from_fn(|k| std::array::from_fn(|i| base[k][i] + 0.5 * spread[k][i]));
        let distance = |a: usize, b: usize| {
            points[a].iter().zip(points[b]).map(|(p, q)| (p - q).powi(2)).sum::<f64>().sqrt()
        };
        let bulk = mixed(&points, [0.0; 3], [0, 7, 8, 0], [1, 2, 3, 4]).replace("1.00000000000000e-1,", "0.,");
        for coupled in ["", "PARAM,COUPMASS,1\n"] {
            let model = model(&format!("{coupled}{bulk}"));
            let mass = model.properties().expect("mass").mass;
            let bar = (2700.0 * 0.005 + 3.0) * distance(0, 1);
            let rod = 2700.0 * 0.002 * distance(2, 0);
            let beam = mass - bar - rod - 12.0;
            // The beam's end offset changes its length by less than 0.15 m.
            prop_assert!((beam / (2700.0 * 0.009) - distance(1, 2)).abs() < 0.15);
        }
    }
}
