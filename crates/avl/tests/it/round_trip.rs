//! What is written reads back the same.

use albatross_avl::geometry::Geometry;
use albatross_avl::mass::MassFile;
use albatross_avl::results::*;
use albatross_avl::run::RunFile;

use crate::support::{fixture_text, third_party};

#[test]
fn val_written_outputs_are_avls_own_byte_for_byte() {
    let text = fixture_text("f25-like/avl_out/trim.st");
    assert_eq!(
        StabilityDerivatives::parse(&text, "trim.st")
            .unwrap()
            .to_text()
            .unwrap(),
        text
    );
    let text = fixture_text("f25-like/avl_out/alpha2.st");
    assert_eq!(
        StabilityDerivatives::parse(&text, "alpha2.st")
            .unwrap()
            .to_text()
            .unwrap(),
        text
    );
    for name in ["trim.ft", "alpha0.ft"] {
        let text = fixture_text(&format!("f25-like/avl_out/{name}"));
        assert_eq!(RunState::parse(&text, name).unwrap().to_text().unwrap(), text);
    }
    for name in ["alpha0.fs", "alpha1.fs", "alpha2.fs", "alpha4.fs", "trim.fs"] {
        let text = fixture_text(&format!("f25-like/avl_out/{name}"));
        assert_eq!(
            StripForces::parse(&text, name).unwrap().to_text().unwrap(),
            text,
            "{name}"
        );
    }
    let Some(text) = third_party("avl/overflow_out/hershey_overflow.fs") else {
        return;
    };
    assert_eq!(
        StripForces::parse(&text, "hershey.fs")
            .unwrap()
            .to_text()
            .unwrap(),
        text
    );
}

#[test]
fn val_a_written_run_file_is_avls_own_byte_for_byte() {
    let Some(text) = third_party("avl/overflow_out/hershey_overflow.run") else {
        return;
    };
    let (run, remarks) = RunFile::parse(&text, "hershey.run").unwrap();
    assert!(remarks.is_empty());
    assert_eq!(run.to_text().unwrap(), text);
}

#[test]
fn input_files_of_the_surrogate_read_back_the_same() {
    let (geometry, _) = Geometry::parse(&fixture_text("f25-like/f25.avl"), "f25.avl").unwrap();
    let (again, _) = Geometry::parse(&geometry.to_text().unwrap(), "again.avl").unwrap();
    assert_eq!(again, geometry);
    let (mass, _) = MassFile::parse(&fixture_text("f25-like/f25.mass"), "f25.mass").unwrap();
    let (again, _) = MassFile::parse(&mass.to_text().unwrap(), "again.mass").unwrap();
    assert_eq!(again, mass);
}
