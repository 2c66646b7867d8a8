//! Rigid elements, springs, supports and what is refused.

use albatross_fem::{FemModel, ModelOptions, ModesOptions, NodalLoad};

use crate::support::{close, model, modes, parse, with_case};

const BEAM: &str = "MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.3,0.\n\
                    GRID,3,,2.,0.6,0.4\nCBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nSPC1,1,123456,1";

fn frequencies(bulk: &str, count: usize) -> Vec<f64> {
    modes(&model(&with_case("SPC = 1", bulk)), count).frequencies_hz
}

fn same(a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).for_each(|(a, b)| close(*a, *b, tolerance));
}

fn push(point: u32, load: [f64; 6]) -> NodalLoad {
    NodalLoad { point, load }
}

/// A mass at the end of a rigid arm is an offset mass: by CONM2 offset, RBE2, RBAR, RBE3 with one grid, and MPCs in a
/// turned frame.
#[test]
fn val_rigid_arms() {
    let inertia = "\n,1.,,2.,,,3.";
    let offset = frequencies(&format!("{BEAM}\nCONM2,9,3,,20.,0.1,-0.2,0.3{inertia}"), 9);
    let far = format!(
        "{BEAM}\nCORD2R,5,,1.,0.,0.,2.,1.,0.\n,1.,1.,1.\nGRID,4,,2.1,0.4,0.7,5\nCONM2,9,4,,20.{inertia}"
    );
    for joint in [
        "RBE2,7,3,123456,4",
        "RBAR,7,3,4,123456,,,123456",
        "RBAR,7,3,4,123,456",
        "RBE3,7,,4,123456,1.,123456,3",
    ] {
        same(&frequencies(&format!("{far}\n{joint}"), 9), &offset, 1e-9);
    }
    // A chain: 3 carries 5, 5 carries 4.
    let chain = format!("{far}\nGRID,5,,2.5,0.,0.\nRBE2,8,5,123456,4\nRBE2,7,3,123456,5");
    same(&frequencies(&chain, 9), &offset, 1e-9);
}

/// The force on the reference grid of an RBE3 goes to the averaged grids like the bolts of a pattern: with weights w_i,
/// F_i = w_i (F/sum(w) + (M x r_i) / sum(w r^2)) for a moment about the weighted centre. Springs of 1000 N/m show it.
#[test]
fn val_rbe3_distributes_like_a_bolt_pattern() {
    let mut bulk = String::from("GRID,9,,0.5,0.,0.\nRBE3,1,,9,123456,1.,123,1,2\n,2.,123,3,4\n");
    let corners = [(1, 1.0, 1.0), (2, -1.0, 1.0), (3, -1.0, -2.0), (4, 1.0, -2.0)];
    for (id, x, y) in corners {
        bulk += &format!("GRID,{id},,{x},{y},0.,,456\n");
        for c in 1..4 {
            bulk += &format!("CELAS2,{},1000.,{id},{c}\n", 10 * id + c);
        }
    }
    let model = model(&parse(&bulk));
    let solution = model
        .static_solution(&[push(9, [0.0, 0.0, 12.0, 0.0, 0.0, 7.0])], [0.0; 3])
        .expect("a solution");
    // Weighted centre: x = 0, y = (2 * 1 - 4 * 2)/6 = -1. Force 12 at (0.5, 0): Mx = 12 * 1, My = -12 * 0.5 about it.
    let weights = [1.0, 1.0, 2.0, 2.0];
    let (sxx, syy): (f64, f64) = (6.0, 2.0 * 4.0 + 4.0 * 1.0);
    for ((id, x, y), w) in corners.into_iter().zip(weights) {
        let (rx, ry) = (x, y + 1.0);
        let fz = w * (12.0 / 6.0 + 12.0 * ry / syy + 6.0 * rx / sxx);
        let polar = sxx + syy;
        let (fx, fy) = (-w * 7.0 * ry / polar, w * 7.0 * rx / polar);
        let u = solution.at(id).expect("a corner");
        for (got, force) in u.iter().zip([fx, fy, fz]) {
            assert!((got * 1000.0 - force).abs() < 1e-11, "{id} {got} {force}");
        }
    }
}

/// UM makes components of the averaged grids dependent: the relation is the same, so are the frequencies.
#[test]
fn val_rbe3_with_um_is_the_same_relation() {
    let base = "MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\n\
                GRID,4,,0.,1.,0.5\nGRID,9,,0.5,0.5,0.5\nCBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nCBAR,3,1,3,4,0.,0.,1.\n\
                CONM2,9,9,,30.\n,1.,,1.,,,1.\nSPC1,1,123456,1";
    let plain = frequencies(&format!("{base}\nRBE3,5,,9,123456,1.,123,2,3,4"), 10);
    let um = frequencies(
        &format!("{base}\nRBE3,5,,9,123456,1.,123,2,3,4\n,UM,2,123,3,13,4,3"),
        10,
    );
    same(&um, &plain, 1e-8);
}

/// A bush off its grids is two rigid arms with springs between coincident ends.
#[test]
fn val_bush_at_an_offset() {
    let two = format!("{BEAM}\nGRID,4,,2.5,0.9,0.\nCONM2,9,4,,20.\n,1.,,2.,,,3.");
    let k = [1e6, 2e6, 3e6, 4e4, 5e4, 6e4];
    let bush = frequencies(
        &format!(
            "{two}\nCORD2R,6,,0.,0.,0.,0.3,0.2,1.\n,1.,0.,0.\nPBUSH,1,K,1.+6,2.+6,3.+6,4.+4,5.+4,6.+4\n\
             CBUSH,5,1,3,4,,,,6\n,,0,0.4,-0.2,0.1"
        ),
        12,
    );
    let mut springs = format!(
        "{two}\nCORD2R,6,,0.,0.,0.,0.3,0.2,1.\n,1.,0.,0.\nGRID,13,,2.4,0.4,0.5,6\nGRID,14,,2.4,0.4,0.5,6\n\
         RBE2,7,3,123456,13\nRBE2,8,4,123456,14\n"
    );
    for (c, k) in k.iter().enumerate() {
        springs += &format!("CELAS2,{},{k:e},13,{},14,{}\n", 20 + c, c + 1, c + 1);
    }
    // The highest mode is 400 times the lowest: 1e-8 of it is rounding of the shift.
    same(&bush, &frequencies(&springs, 12), 1e-8);
}

/// A truss of rods has no rotational stiffness: AUTOSPC holds 9 rotations and says so. Two bars of length sqrt(2) at 45
/// degrees: deflection P L / (2 E A cos^2).
#[test]
fn val_truss_is_held_where_it_has_no_stiffness() {
    let bulk = "MAT1,1,7.+10,2.6+10\nPROD,1,1,0.001,0.\nGRID,1,,-1.,0.,0.,,123\nGRID,2,,1.,0.,0.,,123\nGRID,3,,0.,1.,0.\n\
                CROD,1,1,1,3\nCROD,2,1,2,3\nCONM2,3,3,,1.";
    let model = model(&parse(bulk));
    assert!(
        model.remarks[0].starts_with("10 freedoms without stiffness"),
        "{:?}",
        model.remarks
    );
    assert!(
        model.remarks[1].starts_with("1 of the held freedoms carry mass"),
        "{:?}",
        model.remarks
    );
    let solution = model
        .static_solution(&[push(3, [0.0, -1e4, 0.0, 0.0, 0.0, 0.0])], [0.0; 3])
        .expect("a solution");
    let deflection = 1e4 * 2.0_f64.sqrt() / (2.0 * 7e10 * 1e-3 * 0.5);
    close(solution.at(3).expect("node")[1], -deflection, 1e-12);
    close(solution.reaction_at(1).expect("support")[1], 5e3, 1e-12);
    let expected = (2.0 * 7e10 * 1e-3 / 2.0_f64.sqrt() * 0.5).sqrt() / std::f64::consts::TAU;
    close(modes(&model, 2).frequencies_hz[0], expected, 1e-12);
}

/// Scalar points, CELAS1 and CMASS: two masses in a row, omega^2 = k/m (3 -+ sqrt(5))/2.
#[test]
fn val_scalar_chain() {
    let bulk =
        "SPOINT,1,2\nPELAS,1,400.\nCELAS1,1,1,1,0\nCELAS1,2,1,1,0,2,0\nCMASS2,3,4.,1,0\nCMASS2,4,4.,2,0";
    let modes = modes(&model(&parse(bulk)), 2);
    for (k, sign) in [(0, -1.0), (1, 1.0)] {
        close(
            modes.eigenvalues[k],
            100.0 * (3.0 + sign * 5.0_f64.sqrt()) / 2.0,
            1e-13,
        );
    }
}

#[test]
fn mechanisms_are_named() {
    let free = parse(
        "MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.3,0.\nCBAR,1,1,1,2,0.,0.,1.",
    );
    let error = model(&free)
        .static_solution(&[push(2, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0])], [0.0; 3])
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("the structure is a mechanism: grid "),
        "{error}"
    );
    // A hundred bars with ill-conditioned bending: the rigid motions are still seen.
    let aircraft = model(&crate::support::read("f25-like/f25.bdf"));
    let error = aircraft
        .static_solution(&[push(1025, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0])], [0.0; 3])
        .map(|_| ())
        .unwrap_err();
    assert!(matches!(error, albatross_fem::Error::Mechanism { .. }), "{error}");
}

#[test]
fn unknown_elements_stop_the_run_unless_told() {
    let deck = with_case(
        "SPC = 1",
        &format!(
            "{BEAM}\nGRID,7,,0.,1.,0.\nGRID,8,,1.,1.,0.\nPSHELL,1,1,.001\nCQUAD4,7,1,1,2,8,7\nCQUAD4,8,1,1,2,8,7\nCGAP,9,1,1,2"
        ),
    );
    let error = FemModel::assemble(&deck, &ModelOptions::default())
        .map(|_| ())
        .unwrap_err();
    assert!(error.to_string().contains("1 CGAP, 2 CQUAD4"), "{error}");
    let options = ModelOptions {
        leave_out_unknown: true,
        ..ModelOptions::default()
    };
    let model = FemModel::assemble(&deck, &options).expect("a model");
    assert!(
        model
            .remarks
            .iter()
            .any(|r| r.contains("left out, as asked: 1 CGAP, 2 CQUAD4"))
    );
}

#[test]
fn contradicting_constraints_are_refused() {
    let refusal = |extra: &str| {
        let deck = with_case("SPC = 1", &format!("{BEAM}\nGRID,4,,2.,1.,0.\n{extra}"));
        FemModel::assemble(&deck, &ModelOptions::default())
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    let twice = refusal("RBE2,7,3,123456,4\nRBE2,8,2,123,4");
    assert!(
        twice.contains("RBE2 8: grid 4 T1 is dependent here and in RBE2 7"),
        "{twice}"
    );
    let circle = refusal("RBE2,7,3,123456,4\nRBE2,8,4,123456,3");
    assert!(circle.contains("depends on itself"), "{circle}");
    let held = refusal("RBE2,7,3,123456,4\nSPC1,1,3,4");
    assert!(held.contains("grid 4 T3 is held"), "{held}");
    let line = refusal("RBE3,7,,4,123456,1.,1,1,2,3");
    assert!(line.contains("do not determine the motion"), "{line}");
}

#[test]
fn bad_options_are_refused() {
    let model = model(&with_case("SPC = 1", BEAM));
    for options in [
        ModesOptions {
            count: Some(0),
            ..ModesOptions::default()
        },
        ModesOptions {
            upper_hz: Some(-1.0),
            ..ModesOptions::default()
        },
        ModesOptions {
            lower_hz: Some(f64::NAN),
            ..ModesOptions::default()
        },
    ] {
        assert!(model.modes(&options).is_err(), "{options:?}");
    }
    let massless = model_without_mass();
    let error = massless.modes(&ModesOptions::default()).map(|_| ()).unwrap_err();
    assert!(
        error.to_string().contains("no free freedom carries mass"),
        "{error}"
    );
}

fn model_without_mass() -> FemModel {
    model(&with_case("SPC = 1", &BEAM.replace("2700.", "0.")))
}

/// A slender cantilever of 2,000 bars is no mechanism, although its smallest scaled eigenvalue is (1.9/2000)^4 = 8e-13;
/// rounding of the stiffness, 1e-16, is then 2e-4 of the deflection.
#[test]
fn long_chains_are_not_taken_for_mechanisms() {
    let n = 2000;
    let mut bulk =
        String::from("MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\nSPC1,1,123456,1\n");
    for k in 0..=n {
        bulk += &format!("GRID,{},,{:.6},0.,0.\n", k + 1, f64::from(k) * 0.05);
        if k < n {
            bulk += &format!("CBAR,{},1,{},{},0.,1.,0.\n", k + 1, k + 1, k + 2);
        }
    }
    let model = model(&with_case("SPC = 1", &bulk));
    let tip = n as u32 + 1;
    let solution = model
        .static_solution(&[push(tip, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0])], [0.0; 3])
        .expect("a solution");
    close(solution.at(tip).expect("tip")[1], 1e6 / (3.0 * 7e10 * 1e-6), 2e-3);
    let modes = modes(&model, 4);
    assert!(modes.remarks.is_empty(), "{:?}", modes.remarks);
    let exact = (1.875_104_07_f64 / 100.0).powi(2) * (7e10_f64 * 1e-6 / 13.5).sqrt() / std::f64::consts::TAU;
    close(modes.frequencies_hz[0], exact, 2e-3);
}
