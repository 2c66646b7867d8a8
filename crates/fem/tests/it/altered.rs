//! Structs with open fields that were cut, exchanged or filled by hand, and ranges far up.

use albatross_fem::{Error, FemModel, ModelOptions, Modes, ModesOptions, ReducedModel, all_components};

use crate::support::{close, model, modes, parse};

/// What is done to a struct.
type Alter<T> = fn(&mut T);

/// Three grids on two bars, free.
const BARS: &str = "MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.3,0.\n\
                    GRID,3,,2.,0.6,0.4\nCBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nCONM2,7,2,,5.\n,1.,,1.,,,2.";

#[test]
fn regress_vectors_of_another_length_are_refused() {
    let model = model(&parse(BARS));
    let n = model.mass().order();
    for length in [0, n - 1, n + 1] {
        let x = vec![1.0; length];
        for refused in [model.expand(&x), model.mass().apply(&x)] {
            let message = refused.unwrap_err().to_string();
            assert!(
                message.contains(&format!("is {length} where the matrix has the order {n}")),
                "{message}"
            );
        }
    }
}

#[test]
fn regress_altered_reduced_models_are_refused() {
    let model = model(&parse(BARS));
    let sound = model.craig_bampton(&all_components(&[1, 3]), 3).unwrap();
    assert_eq!(model.modes_of_reduced(&sound, 4).unwrap().len(), 4);
    let cases: [(&str, Alter<ReducedModel>); 6] = [
        ("`mass` has 15 rows and 14 columns", |r| r.mass.truncate(15, 14)),
        ("`stiffness` has 14 rows and 15 columns", |r| {
            r.stiffness.truncate(14, 15)
        }),
        ("`recovery` has 17 rows", |r| r.recovery.truncate(17, 15)),
        ("`recovery` has 18 rows and 2 columns", |r| {
            r.recovery.truncate(18, 2)
        }),
        ("`mass` has a number that is not finite", |r| {
            r.mass[(2, 0)] = f64::NAN
        }),
        ("`stiffness` has a number that is not finite", |r| {
            r.stiffness[(14, 14)] = f64::INFINITY;
        }),
    ];
    for (expected, alter) in cases {
        let mut altered = sound.clone();
        alter(&mut altered);
        let message = model
            .modes_of_reduced(&altered, 4)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(message.contains(expected), "{message}");
    }
}

/// What all fields hold counts; without shapes on these freedoms there is nothing.
#[test]
fn regress_altered_modes_are_cut_to_what_is_there() {
    let model = model(&parse(BARS));
    let sound = modes(&model, 8);
    let cases: [(usize, Alter<Modes>); 6] = [
        (8, |_| {}),
        (5, |m| m.frequencies_hz.truncate(5)),
        (4, |m| m.generalized_masses.truncate(4)),
        (3, |m| m.shapes.truncate(18, 3)),
        (0, |m| m.shapes.truncate(7, 8)),
        (8, |m| m.eigenvalues.push(1.0)),
    ];
    for (left, alter) in cases {
        let mut altered = sound.clone();
        alter(&mut altered);
        let results = altered.results(&model, "altered");
        assert_eq!(results.eigenvectors.len(), left);
        assert_eq!(results.eigenvalues[0].modes.len(), left);
        assert_eq!(model.effective_masses(&altered, [0.0; 3]).len(), left);
        assert!((0..10).all(|k| altered.at(k, 2).is_some() == (k < left)));
    }
}

#[test]
fn regress_a_grid_under_another_key_is_found_by_its_number() {
    let mut deck = parse(&format!("{BARS}\nGRID,4,,3.,0.,0.\nSPOINT,9"));
    let mut grid = deck.grids.remove(&4).unwrap();
    grid.id = 9;
    deck.grids.insert(4, grid);
    let refused = FemModel::assemble(&deck, &ModelOptions::default()).map(|_| ());
    assert!(
        matches!(&refused, Err(Error::BadElement { card, .. }) if card == "SPOINT 9"),
        "{refused:?}"
    );
}

/// A chain of 800 masses: three modes above the first 600, and none above all.
#[test]
fn regress_ranges_far_up_are_found_at_once() {
    let n = 800;
    let mut bulk = format!("SPOINT,1,THRU,{n}\n");
    for k in 1..=n {
        bulk += &format!(
            "CELAS2,{k},1.+4,{},{},{k}\nCMASS2,{},1.,{k}\n",
            k - 1,
            u8::from(k > 1),
            n + k
        );
    }
    let model = model(&parse(&bulk));
    // Fixed at one end: omega = 200 sin((2k - 1) pi / (4n + 2)).
    let hz = |k: usize| {
        200.0 * ((2 * k - 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64).sin() / std::f64::consts::TAU
    };
    let above = |lower_hz: f64| {
        let options = ModesOptions {
            count: Some(3),
            lower_hz: Some(lower_hz),
            ..ModesOptions::default()
        };
        model.modes(&options).expect("modes").frequencies_hz
    };
    let found = above(0.5 * (hz(600) + hz(601)));
    assert_eq!(found.len(), 3);
    for (k, found) in (601..).zip(found) {
        close(found, hz(k), 1e-9);
    }
    assert!(above(1.0e6).is_empty());
}
