//! Reductions, effective masses and the listing.

use albatross_fem::{BarMass, FemModel, ModelOptions, ModesOptions, all_components, analysis_set, listing};
use albatross_nastran::f06;

use crate::support::{close, model, modes, parse, read};

/// The surrogate on its wing, fuselage and tail lines: with interior modes the reduced frequencies are the full ones.
#[test]
fn val_craig_bampton_of_the_f25() {
    let model = model(&read("f25-like/f25.bdf"));
    let full = modes(&model, 16);
    let lra: Vec<u32> = (1000..1026)
        .step_by(5)
        .chain((2005..2026).step_by(5))
        .chain([3001, 3032])
        .collect();
    let set = all_components(&lra);
    let guyan = model.guyan(&set).expect("reduced");
    let rough = model.modes_of_reduced(&guyan, 16).expect("modes");
    let reduced = model.craig_bampton(&set, 60).expect("reduced");
    assert_eq!(reduced.interior.len(), 60);
    let fine = model.modes_of_reduced(&reduced, 16).expect("modes");
    let worst = |m: &albatross_fem::Modes| {
        (6..16)
            .map(|k| (m.frequencies_hz[k] / full.frequencies_hz[k] - 1.0).abs())
            .fold(0.0, f64::max)
    };
    println!("guyan {:.1e}, craig-bampton {:.1e}", worst(&rough), worst(&fine));
    assert!(worst(&fine) < 1e-3 && worst(&rough) < 0.5);
    // Rayleigh-Ritz: from above.
    assert!((6..16).all(|k| rough.frequencies_hz[k] > full.frequencies_hz[k] * (1.0 - 1e-9)));
}

/// All interior modes: the reduction is a change of coordinates.
#[test]
fn val_complete_craig_bampton_is_exact() {
    let deck = parse(
        "MAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.3,0.\nGRID,3,,2.,0.6,0.4\n\
         CBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nASET1,123456,1,3\nCONM2,7,2,,5.\n,1.,,1.,,,2.",
    );
    let options = ModelOptions {
        bar_mass: Some(BarMass::Coupled),
        ..ModelOptions::default()
    };
    let model = FemModel::assemble(&deck, &options).expect("a model");
    assert!(model.remarks.iter().any(|r| r.contains("ASET")));
    let reduced = model.craig_bampton(&analysis_set(&deck), 6).expect("reduced");
    let (full, own) = (
        modes(&model, 18),
        model.modes_of_reduced(&reduced, 18).expect("modes"),
    );
    assert_eq!(reduced.boundary.len(), 12);
    for k in 6..16 {
        close(own.frequencies_hz[k], full.frequencies_hz[k], 1e-11);
    }
}

/// Over all modes of a clamped beam the effective masses sum to the mass that is not on the support.
#[test]
fn val_effective_masses_are_complete() {
    let deck = read("nastran/cant.bdf");
    let options = ModelOptions {
        bar_mass: Some(BarMass::Lumped),
        ..ModelOptions::default()
    };
    let model = FemModel::assemble(&deck, &options).expect("a model");
    let all = model
        .modes(&ModesOptions {
            count: Some(240),
            ..ModesOptions::default()
        })
        .expect("modes");
    assert_eq!(all.len(), 120);
    let masses = model.effective_masses(&all, [0.0; 3]);
    let sum: [f64; 6] = std::array::from_fn(|j| masses.iter().map(|m| m.effective[j]).sum());
    // 40 bars of 0.675 kg, half a bar stays on the support.
    for total in &sum[..3] {
        close(*total, 27.0 - 0.3375, 1e-9);
    }
    // sum(m x^2) of the lumps about the support.
    close(sum[5], 36.01125, 1e-9);
    // Clough and Penzien: the first bending mode has 61.3 % of the mass.
    assert!((masses[0].effective[1..3].iter().sum::<f64>() / 27.0 - 0.613).abs() < 0.01);
}

/// What is printed is read back to the digits that are printed.
#[test]
fn val_listing_is_read_by_our_own_reader() {
    let deck = parse(
        "PARAM,GRDPNT,2\nPARAM,WTMASS,0.1\nMAT1,1,7.+10,2.6+10,,2700.\nPBAR,1,1,0.005,1.-6,4.-6,2.-6\n\
         CORD2C,5,,1.,0.,0.,2.,1.,0.\n,1.,1.,1.\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.3,0.,5\nGRID,3,,2.,0.6,0.4\n\
         CBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\nSPOINT,101,102\nCELAS2,5,100.,3,1,101,0\nCELAS2,6,100.,101,0,102,0\n\
         CMASS2,7,3.,101\nCMASS2,8,3.,102\nCONM2,9,3,,50.,,0.2",
    );
    let model = model(&deck);
    let results = modes(&model, 12).results(&model, "own");
    let text = listing(&results, "two bars");
    let back = f06::parse(text.as_bytes(), "own").expect("readable");
    assert_eq!(back.diagnostics, []);
    let near = |a: f64, b: f64| (a.is_nan() && b.is_nan()) || (a - b).abs() <= 6e-7 * b.abs();
    assert_eq!(back.eigenvalues[0].modes.len(), 12);
    for (a, b) in back.eigenvalues[0]
        .modes
        .iter()
        .zip(&results.eigenvalues[0].modes)
    {
        assert_eq!(a.mode, b.mode);
        assert!(near(a.eigenvalue, b.eigenvalue) && near(a.generalized_mass, b.generalized_mass));
        assert!(near(a.frequency_hz, b.frequency_hz));
    }
    assert_eq!(back.eigenvectors.len(), 12);
    for (a, b) in back.eigenvectors.iter().zip(&results.eigenvectors) {
        assert_eq!((a.mode, a.rows.len()), (b.mode, b.rows.len()));
        for (p, q) in a.rows.iter().zip(&b.rows) {
            assert_eq!((p.id, p.kind), (q.id, q.kind));
            assert!(
                p.values.iter().zip(q.values).all(|(&x, y)| near(x, y)),
                "{p:?} {q:?}"
            );
        }
    }
    let (a, b) = (&back.weights[0], &results.weights[0]);
    assert_eq!(a.reference_point, 2);
    assert!(
        a.mo.iter()
            .flatten()
            .zip(b.mo.iter().flatten())
            .all(|(&x, &y)| near(x, y))
    );
    assert!(a.inertia_s.is_some() && a.principal_inertia.is_some() && a.cg_rows.is_some());
    // The table is before WTMASS, the modes after.
    close(
        a.mass().expect("mass"),
        10.0 * model.properties().expect("mass").mass,
        1e-6,
    );
}

/// Largest component 1.
#[test]
fn val_scale_by_the_largest_component() {
    let model = model(&read("nastran/cant.bdf"));
    let options = ModesOptions {
        count: Some(4),
        scale: albatross_fem::ModeScale::Max,
        ..ModesOptions::default()
    };
    let scaled = model.modes(&options).expect("modes");
    let plain = modes(&model, 4);
    for k in 0..4 {
        let largest = scaled.shapes.col(k).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        close(largest, 1.0, 1e-14);
        let ratio = scaled.at(k, 41).unwrap()[1] / plain.at(k, 41).unwrap()[1];
        if ratio.is_finite() {
            close(scaled.generalized_masses[k], ratio * ratio, 1e-9);
        }
    }
}
