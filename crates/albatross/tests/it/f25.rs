//! The F25-like surrogate through all stages.

use albatross::{Inputs, Model};
use std::path::PathBuf;

fn case_file() -> PathBuf {
    PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/f25-like/case.toml"
    ))
}

#[test]
fn probe() {
    let inputs = Inputs::read(&case_file()).unwrap();
    for name in ["avl", "corrected", "corrected_lagged", "engines_in_place"] {
        let model = Model::build(&inputs, &inputs.case.variant(Some(name)).unwrap()).unwrap();
        println!("== {name} {} {:?}", model.mass.mass, model.mass.cg);
        for n in &model.notes {
            println!("   {n}");
        }
        let t0 = std::time::Instant::now();
        let (equations, trim) = model.trim().unwrap();
        println!(
            "alpha {:.5} de {:.5} T {:.1} res {:.2e} it {} eta {:.3e}",
            trim.alpha_rad.to_degrees(),
            trim.controls_rad[2].to_degrees(),
            trim.thrust,
            trim.residual,
            trim.iterations,
            trim.eta[0]
        );
        let system = albatross::flight::linearize(&equations, &trim.state, &trim.input).unwrap();
        println!("linearised {} states in {:?}", system.a.nrows(), t0.elapsed());
        let values = albatross::numerics::eigen::eigenvalues(system.a.as_ref()).unwrap();
        for v in values.iter().filter(|v| v.im > 0.0 && v.norm() < 100.0) {
            println!("   {:8.4} zeta {:.4}", v.norm(), -v.re / v.norm());
        }
    }
}
