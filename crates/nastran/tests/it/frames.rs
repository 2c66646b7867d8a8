//! Coordinate systems against positions and directions worked out by hand.

use albatross_nastran::deck::Deck;
use albatross_nastran::frames::Frames;
use albatross_nastran::{bdf, f06};
use approx::assert_relative_eq;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

fn deck(text: &str) -> Deck {
    bdf::parse(text.as_bytes(), "systems.bdf").0
}

fn frames(text: &str) -> Frames {
    Frames::resolve(&deck(text)).unwrap()
}

fn position(frames: &Frames, id: u32) -> Vector3<f64> {
    frames.grid(id).unwrap().position
}

#[test]
fn val_one_point_in_three_kinds_of_system() {
    // Origin (1, 2, 3), z along basic x, x along basic y, so that y is along basic z.
    let abc = "0,1.,2.,3.,2.,2.,3.\n,1.,3.,3.";
    let f = frames(&format!(
        "CORD2R,1,{abc}\nCORD2C,2,{abc}\nCORD2S,3,{abc}\n\
         GRID,1,1,1.,2.,5.\n\
         GRID,2,2,2.,90.,5.\n\
         GRID,3,3,2.,90.,30.\n"
    ));
    assert_relative_eq!(position(&f, 1), Vector3::new(6.0, 3.0, 5.0), epsilon = 1e-14);
    // r = 2 at 90 degrees is 2 along y.
    assert_relative_eq!(position(&f, 2), Vector3::new(6.0, 2.0, 5.0), epsilon = 1e-14);
    // theta is from the z axis: 90 degrees lies in the x-y plane; phi = 30 degrees from x.
    let (s, c) = 30_f64.to_radians().sin_cos();
    assert_relative_eq!(
        position(&f, 3),
        Vector3::new(1.0, 2.0 + 2.0 * c, 3.0 + 2.0 * s),
        epsilon = 1e-14
    );
}

#[test]
fn val_chains_through_systems_and_grids() {
    // System 1 is turned by 90 degrees about z; system 2 by another 90 degrees within it; system 3 has its origin and
    // axes from grids that lie in system 2.
    let f = frames(
        "CORD2R,2,1,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n\
         CORD2R,1,0,1.,0.,0.,1.,0.,1.\n,1.,1.,0.\n\
         CORD1R,3,11,12,13\n\
         GRID,11,2,1.,0.,0.\nGRID,12,2,1.,0.,1.\nGRID,13,2,2.,0.,0.\n\
         GRID,20,3,4.,0.,0.\n",
    );
    // x of system 2 points to -x of the basic system.
    assert_relative_eq!(
        f.system(2).unwrap().axes,
        Matrix3::new(-1., 0., 0., 0., -1., 0., 0., 0., 1.),
        epsilon = 1e-15
    );
    assert_relative_eq!(position(&f, 11), Vector3::new(0.0, 0.0, 0.0), epsilon = 1e-15);
    assert_relative_eq!(position(&f, 20), Vector3::new(-4.0, 0.0, 0.0), epsilon = 1e-15);
}

#[test]
fn val_displacement_directions_are_taken_at_the_grid() {
    let f = frames(
        "CORD2C,7,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2S,8,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n\
         GRID,1,0,0.,3.,4.,7\nGRID,2,0,0.,3.,4.,8\nGRID,3,0,0.,0.,4.,7\n",
    );
    let axes = |id| f.grid(id).unwrap().axes;
    // At 90 degrees: radial is y, tangential is -x.
    assert_relative_eq!(
        axes(1),
        Matrix3::new(0., -1., 0., 1., 0., 0., 0., 0., 1.),
        epsilon = 1e-15
    );
    // rho is (0, 0.6, 0.8), theta grows away from z: (0, 0.8, -0.6), phi is -x.
    assert_relative_eq!(
        axes(2),
        Matrix3::new(0., 0., -1., 0.6, 0.8, 0., 0.8, -0.6, 0.),
        epsilon = 1e-15
    );
    // On the axis the angle is taken as zero.
    assert_relative_eq!(axes(3), Matrix3::identity(), epsilon = 1e-15);
}

proptest! {
    /// Displacement directions are derivatives of the position: moving a little along component k of a curved system
    /// moves the point along column k.
    #[test]
    fn prop_directions_are_derivatives_of_positions(
        kind in prop::sample::select(vec!["CORD2C", "CORD2S"]),
        a in [-5.0..5.0, -5.0..5.0, -5.0..5.0],
        r in 0.5_f64..9.0, u in 10.0_f64..170.0, v in 5.0_f64..80.0,
    ) {
        let text = |c: [f64; 3]| format!(
            "{kind},4,0,{:?},{:?},{:?},{:?},{:?},{:?}\n,{:?},{:?},{:?}\nGRID,1,4,{:?},{:?},{:?},4\n",
            a[0], a[1], a[2], a[0] + 1.0, a[1] + 2.0, a[2] + 3.0, a[0] - 2.0, a[1] + 1.0, a[2] + 0.5, c[0], c[1], c[2]
        );
        let at = [r, u, v];
        let f = frames(&text(at));
        let axes = f.grid(1).unwrap().axes;
        prop_assert!((axes.transpose() * axes - Matrix3::identity()).norm() < 1e-12);
        prop_assert!((axes.determinant() - 1.0).abs() < 1e-12);
        for k in 0..3 {
            // Numbers of 8 digits are not enough for a small step.
            let h = 1e-4;
            let mut moved = at;
            moved[k] += h;
            let mut back = at;
            back[k] -= h;
            let step = position(&frames(&text(moved)), 1) - position(&frames(&text(back)), 1);
            let direction = step.normalize();
            prop_assert!((direction - axes.column(k)).norm() < 1e-8, "component {}", k + 1);
        }
    }
}

fn refusal(text: &str) -> String {
    Frames::resolve(&deck(text)).unwrap_err().to_string()
}

#[test]
fn unresolvable_systems_name_their_card_and_line() {
    let circle = refusal(
        "CORD2R,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n\
         CORD2R,2,3,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n\
         CORD1R,3,10,11,12\nGRID,10,1,0.,0.,0.\nGRID,11,0,0.,0.,1.\nGRID,12,0,1.,0.,0.\n",
    );
    assert!(
        circle.contains("systems.bdf:5: CORD1R 3") && circle.contains("1 -> 2 -> 3 -> 1"),
        "{circle}"
    );
    let missing = refusal("\nGRID,1,9,0.,0.,0.\n");
    assert!(
        missing.contains("systems.bdf:2: GRID 1") && missing.contains("CP = 9"),
        "{missing}"
    );
    let missing = refusal("CORD1R,3,10,11,12\n");
    assert!(
        missing.contains("CORD1R 3") && missing.contains("grid 10"),
        "{missing}"
    );
    let flat = refusal("CORD2R,1,0,0.,0.,0.,0.,0.,1.\n,0.,0.,5.\n");
    assert!(flat.contains("do not span a plane"), "{flat}");
}

#[test]
fn val_eigenvectors_are_rotated_from_cd_to_basic() {
    let deck =
        deck("CORD2C,7,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,0,0.,3.,4.,7\nGRID,2,0,0.,3.,4.\nSPOINT,5\n");
    let page = "1    WING                                                                  MARCH   3, 2012  MSC.NASTRAN  4/ 3/07   PAGE     1\n\n0\n\
                \u{20}     EIGENVALUE =  4.000000E+00\n          CYCLES =  3.183099E-01         R E A L   E I G E N V E C T O R   N O .          1\n\n";
    let text = format!(
        "{page}{:14}      G      1.000000E+00   2.000000E+00   3.000000E+00   4.000000E+00   5.000000E+00   6.000000E+00\n\
         {:14}      G      1.000000E+00   2.000000E+00   3.000000E+00\n\
         {:14}      S      7.000000E+00\n",
        1, 2, 5
    );
    let results = f06::parse(text.as_bytes(), "wing.f06").unwrap();
    let frames = Frames::resolve(&deck).unwrap();
    let basic = results.eigenvectors_in_basic(&frames).unwrap();
    let rows = &basic[0].rows;
    // Radial is y and tangential -x at grid 1.
    assert_relative_eq!(
        rows[0].translation().unwrap(),
        Vector3::new(-2.0, 1.0, 3.0),
        epsilon = 1e-15
    );
    assert_relative_eq!(
        rows[0].rotation().unwrap(),
        Vector3::new(-5.0, 4.0, 6.0),
        epsilon = 1e-15
    );
    assert_eq!(rows[1].translation(), Some(Vector3::new(1.0, 2.0, 3.0)));
    assert_eq!(rows[1].rotation(), None);
    assert_eq!(rows[2].values[0], 7.0);
}
