//! Beams against closed forms.

use albatross_fem::{BarMass, FemModel, ModelOptions, ModesOptions, NodalLoad};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use crate::support::{close, model, modes, parse};

const E: f64 = 7.0e10;
const RHO: f64 = 2700.0;
const AREA: f64 = 0.005;
const I1: f64 = 1.0e-6;
const I2: f64 = 4.0e-6;
const LENGTH: f64 = 2.0;

/// `n` bars along x; `extra` holds supports (PS of grids is left to it).
fn bars(n: usize, pbar: &str, extra: &str) -> String {
    let mut bulk = format!("MAT1,1,{E:e},2.6+10,,{RHO}\n{pbar}\n{extra}\n");
    for k in 0..=n {
        let _ = writeln!(bulk, "GRID,{},,{:.12},0.,0.", k + 1, LENGTH * k as f64 / n as f64);
    }
    for k in 1..=n {
        let _ = writeln!(bulk, "CBAR,{k},1,{k},{},0.,1.,0.", k + 1);
    }
    bulk
}

fn pbar() -> String {
    format!("PBAR,1,1,{AREA},{I1:e},{I2:e},2.-6")
}

fn coupled(bulk: &str, case: &str) -> FemModel {
    let options = ModelOptions {
        bar_mass: Some(BarMass::Coupled),
        ..ModelOptions::default()
    };
    FemModel::assemble(&crate::support::with_case(case, bulk), &options).expect("a model")
}

/// Frequency of Euler's beam for a root beta L, Hz.
fn euler(root: f64, i: f64) -> f64 {
    (root / LENGTH).powi(2) * (E * i / (RHO * AREA)).sqrt() / TAU
}

/// The nearest frequency of a model.
fn nearest(frequencies: &[f64], wanted: f64) -> f64 {
    let distance = |f: &&f64| (**f - wanted).abs();
    *frequencies
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("a mode")
}

/// Consistent mass: the error falls with the fourth power of the element's length (Blevins, Formulas for Natural
/// Frequency and Mode Shape, Table 8-1, for the roots).
#[test]
fn val_coupled_mass_converges_at_fourth_order() {
    for (case, extra, root) in [
        ("SPC = 1", "SPC1,1,123456,1", 4.694_091_132_974),
        ("SPC = 1", "SPC1,1,123456,1", 7.854_757_438_237),
        ("", "", 4.730_040_744_863),
        ("", "", 7.853_204_624_096),
    ] {
        let error = |n: usize| {
            let modes = modes(&coupled(&bars(n, &pbar(), extra), case), 20);
            let exact = euler(root, I1);
            nearest(&modes.frequencies_hz, exact) / exact - 1.0
        };
        let (coarse, fine) = (error(8), error(16));
        let order = (coarse / fine).log2();
        println!("{root}: {coarse:.1e} {fine:.1e} order {order:.2}");
        assert!(
            fine > 0.0 && fine < 2e-4 && (3.8..4.2).contains(&order),
            "{coarse:e} {fine:e}"
        );
    }
}

/// A simply supported beam that shears, without rotary inertia (which bars do not have):
/// omega^2 = (E I k^4 / mu) / (1 + E I k^2 / (K G A)), k = n pi / L (Timoshenko, Vibration Problems in Engineering).
#[test]
fn val_shear_factors() {
    let (g, k_shear) = (2.6e10, 0.02);
    let property = format!("{}\n,\n,{k_shear},{k_shear}", pbar());
    let modes = modes(
        &coupled(&bars(60, &property, "SPC1,1,1234,1\nSPC1,1,234,61"), "SPC = 1"),
        20,
    );
    for n in 1..4 {
        let k = f64::from(n) * PI / LENGTH;
        let slender = E * I1 * k.powi(4) / (RHO * AREA);
        let omega2 = slender / (1.0 + E * I1 * k * k / (k_shear * g * AREA));
        let exact = omega2.sqrt() / TAU;
        assert!(exact < 0.99 * slender.sqrt() / TAU);
        close(nearest(&modes.frequencies_hz, exact), exact, 5e-4);
    }
}

/// Tip load on a cantilever: bending and shear deflection, slope, reactions.
#[test]
fn val_cantilever_under_a_tip_load() {
    let k1 = 0.3;
    let property = format!("{}\n,\n,{k1},0.5", pbar());
    let model = model(&crate::support::with_case(
        "SPC = 1",
        &bars(3, &property, "SPC1,1,123456,1"),
    ));
    let p = 1000.0;
    let load = NodalLoad {
        point: 4,
        load: [0.0, p, 0.0, 0.0, 0.0, 0.0],
    };
    let solution = model.static_solution(&[load], [0.0; 3]).expect("a solution");
    let tip = solution.at(4).expect("the tip");
    let deflection = p * LENGTH.powi(3) / (3.0 * E * I1) + p * LENGTH / (k1 * 2.6e10 * AREA);
    close(tip[1], deflection, 1e-11);
    close(tip[5], p * LENGTH.powi(2) / (2.0 * E * I1), 1e-11);
    close(solution.strain_energy, 0.5 * p * deflection, 1e-11);
    let root = solution.reaction_at(1).expect("the root");
    close(root[1], -p, 1e-9);
    close(root[5], -p * LENGTH, 1e-9);

    // The support carries the whole weight.
    let solution = model.static_solution(&[], [0.0, 0.0, -9.81]).expect("a solution");
    close(
        solution.reaction_at(1).expect("the root")[2],
        9.81 * RHO * AREA * LENGTH,
        1e-9,
    );
}

/// A pin at end B lets the bar turn against a held grid: 3 E I/L^3 in place of 12 E I/L^3.
#[test]
fn val_pins_release_moments() {
    let deck = |pins: &str| {
        crate::support::with_case(
            "SPC = 1",
            &format!(
                "MAT1,1,{E:e},2.6+10,,{RHO}\n{}\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\n{pins}\n\
                 SPC1,1,123456,1\nSPC1,1,13456,2",
                pbar()
            ),
        )
    };
    for (pins, factor) in [("", 12.0), (",,6", 3.0)] {
        let load = NodalLoad {
            point: 2,
            load: [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        };
        let solution = model(&deck(pins))
            .static_solution(&[load], [0.0; 3])
            .expect("a solution");
        close(solution.at(2).expect("tip")[1], 8.0 / (factor * E * I1), 1e-12);
    }
}

/// One CBEAM whose moments fall linearly to a third: P/E int(t^2/(a + b t) dt) in closed form; the same in torsion,
/// int(dx/(G J)) = L ln(J_0/J_1)/(G (J_0 - J_1)).
#[test]
fn val_tapered_beam_statics() {
    let bulk = "MAT1,1,7.+10,2.6+10,,2700.\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBEAM,1,1,1,2,0.,1.,0.\nSPC1,1,123456,1\n\
                PBEAM,1,1,0.01,3.-6,6.-6,,6.-6\n,,,,,,,,\n,NO,1.,0.005,1.-6,2.-6,,2.-6\n,0.,0.";
    let model = model(&crate::support::with_case("SPC = 1", bulk));
    let load = NodalLoad {
        point: 2,
        load: [0.0, 1.0, 1.0, 1.0, 0.0, 0.0],
    };
    let tip = model
        .static_solution(&[load], [0.0; 3])
        .expect("a solution")
        .at(2)
        .expect("tip");
    let bending = |i0: f64, i1: f64| {
        let (a, b, l) = (i1, (i0 - i1) / 2.0, 2.0_f64);
        (l * l / (2.0 * b) - a * l / (b * b) + a * a / b.powi(3) * ((a + b * l) / a).ln()) / E
    };
    // The integrand is rational: Gauss of order 8 leaves 1e-9.
    close(tip[1], bending(3e-6, 1e-6), 3e-9);
    close(tip[2], bending(6e-6, 2e-6), 3e-9);
    close(tip[3], 2.0 * 3.0_f64.ln() / (2.6e10 * 4e-6), 3e-9);
}

/// Kirchhoff's wedge, a cantilever of constant width whose depth falls linearly to nothing: z J1(z) I2(z) + I1(z) J2(z)
/// = 0 with omega = z^2/4 sqrt(E I0 / (mu0 L^4)); z = 4.61090, 7.79927 (the roots of the clamped circular plate with one
/// nodal diameter, Leissa, Vibration of Plates, Table 2.1).
#[test]
fn val_wedge_of_tapered_beams() {
    let (n, width, depth) = (80, 0.1, 0.08);
    let mut bulk = format!("MAT1,1,{E:e},2.6+10,,{RHO}\nSPC1,1,123456,1\n");
    let section = |x: f64| {
        let h = depth * (1.0 - x).max(1e-4);
        (width * h, width * h.powi(3) / 12.0, h * width.powi(3) / 12.0)
    };
    for k in 0..=n {
        let x = k as f64 / n as f64;
        let _ = writeln!(bulk, "GRID,{},,{:.12},0.,0.", k + 1, LENGTH * x);
        if k < n {
            let (a, i1, i2) = section(x);
            let (b, j1, j2) = section(x + 1.0 / n as f64);
            let id = k + 1;
            let _ = writeln!(bulk, "CBEAM,{id},{id},{id},{},0.,1.,0.", k + 2);
            let _ = writeln!(bulk, "PBEAM,{id},1,{a:.8e},{i1:.8e},{i2:.8e},,{i1:.8e}\n,,,,,,,,");
            let _ = writeln!(bulk, ",NO,1.,{b:.8e},{j1:.8e},{j2:.8e},,{j1:.8e}\n,0.,0.");
        }
    }
    let modes = modes(&model(&crate::support::with_case("SPC = 1", &bulk)), 12);
    let unit = (E * depth.powi(2) / 12.0 / RHO).sqrt() / LENGTH.powi(2) / TAU;
    for z in [4.610_90_f64, 7.799_27] {
        let exact = z * z / 4.0 * unit;
        let got = nearest(&modes.frequencies_hz, exact);
        println!("wedge {:.1e}", got / exact - 1.0);
        close(got, exact, 2e-3);
    }
}

/// CBAR and a uniform CBEAM without shear are the same element; the beam has rotary inertia about its axis beside.
#[test]
fn val_beam_equals_bar() {
    let of = |element: &str| {
        parse(&format!(
            "MAT1,1,{E:e},2.6+10,,0.\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.5,0.2\nCONM2,8,1,,10.,,,,\n,1.,,2.,,,3.\n\
             CONM2,9,2,,5.,0.2,,,\n,1.,,2.,,,3.\n{element}"
        ))
    };
    let bar =
        of("PBAR,1,1,0.01,3.-6,6.-6,2.-6,,,\n,\n,,,1.-6\nCBAR,1,1,1,2,0.,1.,0.\n,,,0.1,0.2,0.3,0.,0.,-0.1");
    let beam = of(
        "PBEAM,1,1,0.01,3.-6,6.-6,1.-6,2.-6\n,,,,,,,,\n,0.,0.\nCBEAM,1,1,1,2,0.,1.,0.\n,,,0.1,0.2,0.3,0.,0.,-0.1",
    );
    let (bar, beam) = (modes(&model(&bar), 12), modes(&model(&beam), 12));
    for k in 6..12 {
        close(bar.frequencies_hz[k], beam.frequencies_hz[k], 1e-11);
    }
}

/// A range by EIGRL: V1 and V2 cut, and a lower end above zero leaves the modes below out.
#[test]
fn val_ranges_select_the_same_modes() {
    let bulk = bars(20, &pbar(), "");
    let model = model(&parse(&bulk));
    let all = modes(&model, 30).frequencies_hz;
    let (low, high) = (0.5 * (all[7] + all[8]), 0.5 * (all[14] + all[15]));
    let options = ModesOptions {
        lower_hz: Some(low),
        upper_hz: Some(high),
        ..ModesOptions::default()
    };
    let cut = model.modes(&options).expect("modes").frequencies_hz;
    assert_eq!(cut.len(), 7);
    for (a, b) in cut.iter().zip(&all[8..]) {
        close(*a, *b, 1e-9);
    }
    let three = model
        .modes(&ModesOptions {
            count: Some(3),
            ..options
        })
        .expect("modes");
    close(three.frequencies_hz[2], all[10], 1e-9);
}

/// Standard sections are the constants on the card: a rectangle with shear factors 5/6 and Saint-Venant's torsion, a
/// channel of thin walls, and a box beam.
#[test]
fn val_standard_sections() {
    let of = |property: &str, element: &str| {
        let deck = parse(&format!(
            "MAT1,1,{E:e},2.6+10,,{RHO}\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.5,0.2\nCONM2,8,1,,10.,,,,\n,1.,,2.,,,3.\n\
             CONM2,9,2,,5.,0.2,,,\n,1.,,2.,,,3.\n{property}\n{element},1,1,1,2,0.,1.,0."
        ));
        modes(&model(&deck), 12).frequencies_hz
    };
    // 0.1 wide, 0.2 high: I1 = w h^3/12; J = 0.2287 h w^3 for h/w = 2 (Timoshenko and Goodier, Table 7).
    let rectangle = of("PBARL,1,1,,BAR\n,0.1,0.2", "CBAR");
    let constants = of(
        "PBAR,1,1,0.02,6.666666667-5,1.666666667-5,4.574-5\n,\n,0.8333333333,0.8333333333",
        "CBAR",
    );
    for k in 6..12 {
        close(rectangle[k], constants[k], 1e-3);
    }
    let box_beam = of("PBEAML,1,1,,BOX\n,0.1,0.2,0.01,0.01", "CBEAM");
    let box_bar = of("PBARL,1,1,,BOX\n,0.1,0.2,0.01,0.01", "CBAR");
    for k in 6..12 {
        // The beam has the inertia of its sections about its axis beside.
        close(box_beam[k], box_bar[k], 2e-2);
    }
    let refused = parse(&format!(
        "MAT1,1,{E:e},2.6+10,,{RHO}\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.5,0.2\nPBEAML,1,1,,CHAN\n,0.1,0.2,0.01,0.01\n\
         CBEAM,1,1,1,2,0.,1.,0."
    ));
    let error = FemModel::assemble(&refused, &ModelOptions::default())
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("PBEAML 1: the shear centre of a CHAN is not known"),
        "{error}"
    );
}
