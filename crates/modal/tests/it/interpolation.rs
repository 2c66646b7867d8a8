//! Interpolation along axes against closed forms.

use albatross_modal::{LoadReferenceAxis, Station, interpolate, rigid_shape};
use albatross_numerics::interp::Method;
use proptest::prelude::*;

use crate::support::basis_of;

fn axis(n: u32) -> LoadReferenceAxis {
    LoadReferenceAxis {
        name: "wing".into(),
        grids: (1..=n).collect(),
    }
}

/// A swept wing with dihedral, a kink at 30 % span and uneven grids.
fn wing() -> Vec<[f64; 3]> {
    let place = |y: f64| {
        [
            0.5 * y + 0.9 * (y - 6.0).max(0.0),
            y,
            0.05 * y - 0.02 * (y - 6.0).max(0.0),
        ]
    };
    [
        0.0, 1.1, 2.0, 3.3, 4.7, 6.0, 7.1, 9.0, 11.4, 13.0, 16.2, 18.0, 20.0,
    ]
    .map(place)
    .to_vec()
}

fn stations() -> Vec<Station> {
    (0..40)
        .map(|j| {
            let y = 0.2 + 0.5 * f64::from(j) * 0.99;
            Station {
                x: 0.3 + 0.7 * y,
                y,
                z: 0.4 - 0.03 * y,
            }
        })
        .collect()
}

/// A straight wing along y with stations on it: each component is a cubic of y and comes back to rounding.
#[test]
fn val_cubic_shapes_are_exact_with_the_cubic_method() {
    let cubic =
        |c: usize, y: f64| 0.3 + c as f64 - (0.2 + 0.1 * c as f64) * y + 0.03 * y * y - 0.001 * y.powi(3);
    let ys = [0.0, 1.5, 2.0, 4.0, 5.5, 8.0, 8.5, 10.0];
    let positions = ys.map(|y| [2.0, y, 0.0]);
    let shape = ys.map(|y| std::array::from_fn(|c| cubic(c, y))).to_vec();
    let basis = basis_of(&positions, vec![shape]);
    let stations: Vec<_> = (0..101)
        .map(|j| Station {
            x: 1.0,
            y: 0.1 * f64::from(j),
            z: 0.0,
        })
        .collect();
    let got = interpolate(&basis, &axis(8), &stations, Method::Cubic).expect("stations lie on the axis");
    for (j, station) in stations.iter().enumerate() {
        for d in 0..3 {
            assert!((got.translation[d][(j, 0)] - cubic(d, station.y)).abs() < 1e-13);
            assert!((got.rotation[d][(j, 0)] - cubic(d + 3, station.y)).abs() < 1e-13);
        }
        assert!((got.x_lra[j] - 2.0).abs() < 1e-14);
    }
}

/// Linear interpolation halfway between two grids is their mean.
#[test]
fn val_linear_takes_the_mean_halfway() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [4.0, 6.0, 0.0]];
    let shape = vec![
        [1.0, 2.0, 3.0, 0.1, 0.2, 0.3],
        [3.0, 2.0, 1.0, 0.3, 0.4, 0.1],
        [0.0; 6],
    ];
    let basis = basis_of(&positions, vec![shape]);
    let station = [Station {
        x: 9.0,
        y: 4.0,
        z: 0.0,
    }];
    let got = interpolate(&basis, &axis(3), &station, Method::Linear).expect("inside");
    assert_eq!(got.x_lra, [2.5]);
    let t = [1.5, 1.0, 0.5];
    let r = [0.15, 0.2, 0.05];
    for d in 0..3 {
        assert!((got.translation[d][(0, 0)] - t[d]).abs() < 1e-15);
        assert!((got.rotation[d][(0, 0)] - r[d]).abs() < 1e-15);
    }
    assert_eq!(got.phi_z()[(0, 0)], got.translation[2][(0, 0)]);
    assert_eq!(got.gamma_y()[(0, 0)], got.rotation[1][(0, 0)]);
}

/// A fin along z and a left wing along -y go through the same code.
#[test]
fn val_fin_and_left_wing_follow_their_own_span() {
    for (positions, station) in [
        (
            [[5.0, 0.0, 1.0], [6.0, 0.0, 3.0], [7.0, 0.0, 5.0]],
            Station {
                x: 6.0,
                y: 0.0,
                z: 2.0,
            },
        ),
        (
            [[5.0, 0.0, 1.0], [6.0, -2.0, 1.0], [7.0, -4.0, 1.0]],
            Station {
                x: 6.0,
                y: -1.0,
                z: 1.0,
            },
        ),
    ] {
        let shape = vec![[0.0; 6], [2.0; 6], [4.0; 6]];
        let basis = basis_of(&positions, vec![shape]);
        let got = interpolate(&basis, &axis(3), &[station], Method::Cubic).expect("inside");
        assert!((got.x_lra[0] - 5.5).abs() < 1e-14);
        for d in 0..3 {
            assert!((got.translation[d][(0, 0)] - 1.0).abs() < 1e-14);
        }
    }
}

/// One grid stands for a rigid body: every station moves with it.
#[test]
fn val_single_grid_carries_stations_rigidly() {
    let basis = basis_of(&[[10.0, 6.5, -2.0]], vec![vec![[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]]]);
    let station = Station {
        x: 8.0,
        y: 7.5,
        z: -1.5,
    };
    let got = interpolate(&basis, &axis(1), &[station], Method::Cubic).expect("one grid");
    // T + R x (0, 1, 0.5)
    let expected = [0.1 + 0.5 * 0.5 - 0.6, 0.2 - 0.4 * 0.5, 0.3 + 0.4];
    for (t, e) in got.translation.iter().zip(expected) {
        assert!((t[(0, 0)] - e).abs() < 1e-15);
    }
    assert_eq!(got.x_lra, [10.0]);
}

/// The strip's own kinematics, phi(x) = T3 - (x - x_lra) R2 and the like, complete the rigid motion.
fn check_rigid(direction_sum: [f64; 6], method: Method) -> f64 {
    let positions = wing();
    let mut shape = vec![[0.0; 6]; positions.len()];
    let center = [3.0, -1.0, 0.5];
    for (direction, amount) in direction_sum.iter().enumerate() {
        for (s, r) in shape.iter_mut().zip(rigid_shape(direction, center, &positions)) {
            s.iter_mut().zip(r).for_each(|(s, r)| *s += amount * r);
        }
    }
    let basis = basis_of(&positions, vec![shape]);
    let stations = stations();
    let got = interpolate(&basis, &axis(13), &stations, method).expect("inside");
    let [u, v, w, p, q, r] = direction_sum;
    let mut worst = 0.0_f64;
    for (j, station) in stations.iter().enumerate() {
        let arm = [
            station.x - center[0],
            station.y - center[1],
            station.z - center[2],
        ];
        let exact = [
            u + q * arm[2] - r * arm[1],
            v + r * arm[0] - p * arm[2],
            w + p * arm[1] - q * arm[0],
        ];
        let streamwise = station.x - got.x_lra[j];
        let at = |d: usize| got.translation[d][(j, 0)];
        let strip = [
            at(0),
            at(1) + streamwise * got.rotation[2][(j, 0)],
            at(2) - streamwise * got.rotation[1][(j, 0)],
        ];
        for d in 0..3 {
            worst = worst.max((strip[d] - exact[d]).abs());
            worst = worst.max((got.rotation[d][(j, 0)] - [p, q, r][d]).abs());
        }
    }
    worst
}

proptest! {
    /// Any rigid motion is exact at stations off the axis, on a kinked axis.
    #[test]
    fn prop_rigid_motion_is_exact(motion in prop::array::uniform6(-1.0..1.0_f64)) {
        // Amplitudes of 1 on arms of 30 m: 1e-12 is a few tens of roundings.
        prop_assert!(check_rigid(motion, Method::Cubic) < 1e-12);
        prop_assert!(check_rigid(motion, Method::Linear) < 1e-12);
    }
}

/// PCHIP is not linear in the data, but scales and shifts: each rigid direction alone is exact.
#[test]
fn val_each_rigid_direction_is_exact_with_pchip() {
    for direction in 0..6 {
        let mut motion = [0.0; 6];
        motion[direction] = 1.0;
        let worst = check_rigid(motion, Method::Pchip);
        // Rotations about x mix y and z, both on the same straight or kinked line: y + a z bends where z does.
        assert!(worst < 1e-12, "direction {direction}: {worst:e}");
    }
}

/// Bending of a cantilever, w = y^2 (3 L - y) / (2 L^3) with twist y / L, on ten grids: exact for the cubic, and a
/// station behind the axis sees w - (x - x_lra) theta.
#[test]
fn val_cantilever_bending_and_twist() {
    let l = 10.0;
    let w = |y: f64| y * y * (3.0 * l - y) / (2.0 * l.powi(3));
    let slope = |y: f64| (6.0 * l * y - 3.0 * y * y) / (2.0 * l.powi(3));
    let ys: Vec<f64> = (0..10).map(|i| l * f64::from(i) / 9.0).collect();
    let positions: Vec<_> = ys.iter().map(|&y| [0.4, y, 0.0]).collect();
    let shape: Vec<_> = ys
        .iter()
        .map(|&y| [0.0, 0.0, w(y), slope(y), y / l, 0.0])
        .collect();
    let basis = basis_of(&positions, vec![shape]);
    let stations: Vec<_> = (0..25)
        .map(|j| Station {
            x: 1.4,
            y: l * (f64::from(j) + 0.5) / 25.0,
            z: 0.0,
        })
        .collect();
    let got = interpolate(&basis, &axis(10), &stations, Method::Cubic).expect("inside");
    for (j, s) in stations.iter().enumerate() {
        let at_station = got.phi_z()[(j, 0)] - (s.x - got.x_lra[j]) * got.gamma_y()[(j, 0)];
        assert!((at_station - (w(s.y) - s.y / l)).abs() < 1e-13);
        assert!((got.rotation[0][(j, 0)] - slope(s.y)).abs() < 1e-13);
    }
}

/// Up to 5 % beyond the ends the tangent continues, with a note; further is an error.
#[test]
fn val_short_overhang_follows_the_tangent() {
    let ys = [0.0, 2.0, 5.0, 10.0];
    let positions = ys.map(|y| [1.0 + 0.1 * y, y, 0.0]);
    let parabola = |y: f64| [0.0, 0.0, y * y, 0.0, 2.0 * y, 0.0];
    let basis = basis_of(&positions, vec![ys.map(parabola).to_vec()]);
    let station = |y| Station { x: 0.0, y, z: 0.0 };
    let got = interpolate(
        &basis,
        &axis(4),
        &[station(10.4), station(-0.3), station(5.0)],
        Method::Cubic,
    )
    .expect("4 % beyond");
    assert!((got.phi_z()[(0, 0)] - (100.0 + 20.0 * 0.4)).abs() < 1e-12);
    assert!(got.phi_z()[(1, 0)].abs() < 1e-12);
    assert!((got.gamma_y()[(1, 0)] + 0.6).abs() < 1e-12);
    assert!((got.x_lra[0] - 2.04).abs() < 1e-13);
    assert_eq!(got.notes.len(), 1, "{:?}", got.notes);
    assert!(got.notes[0].contains("2 stations lie up to 0.4000 m beyond"));

    let error = interpolate(&basis, &axis(4), &[station(3.0), station(11.0)], Method::Cubic).unwrap_err();
    assert_eq!(
        error.to_string(),
        "station 1 (y = 11, z = 0) of load reference axis \"wing\" lies 1.0000 m beyond its last grid 4; at most \
         0.5000 m (5 % of the axis) are extrapolated. Assign the strip to another axis, or extend this one"
    );
}

#[test]
fn wrong_axes_are_refused_by_name() {
    let basis = basis_of(&wing(), vec![vec![[0.0; 6]; 13]]);
    let refuse = |grids: &[u32]| {
        let axis = LoadReferenceAxis {
            name: "right wing".into(),
            grids: grids.to_vec(),
        };
        interpolate(&basis, &axis, &stations(), Method::Cubic)
            .unwrap_err()
            .to_string()
    };
    let folded = refuse(&[1, 2, 4, 3, 5]);
    assert!(
        folded.contains("grid 3 is at") && folded.contains("after grid 4 at"),
        "{folded}"
    );
    let repeated = refuse(&[1, 2, 2, 3]);
    assert!(
        repeated.contains("grid 2 is at") && repeated.contains("after grid 2 at"),
        "{repeated}"
    );
    let unknown = refuse(&[1, 2, 30]);
    assert!(
        unknown.contains("grid 30 (load reference axis \"right wing\")"),
        "{unknown}"
    );
    assert!(
        unknown.contains("nearest numbers are 10, 11, 12, 13"),
        "{unknown}"
    );
    assert!(refuse(&[]).contains("it has no grids"));

    let fuselage = basis_of(
        &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        vec![vec![[0.0; 6]; 3]],
    );
    let error = interpolate(&fuselage, &axis(3), &stations(), Method::Cubic)
        .unwrap_err()
        .to_string();
    assert!(error.contains("same y and z"), "{error}");
    let at_nan = [Station {
        x: f64::NAN,
        y: 1.0,
        z: 0.0,
    }];
    let error = interpolate(&basis, &axis(13), &at_nan, Method::Cubic)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("station 0 has a coordinate that is not finite"),
        "{error}"
    );
}
