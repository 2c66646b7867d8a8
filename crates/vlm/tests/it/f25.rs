//! The surrogate aircraft against AVL 3.52's printed digits.

use std::collections::BTreeMap;

use albatross_avl::geometry::Geometry;
use albatross_avl::run::{RunFile, RunTarget, RunVariable};
use albatross_vlm::{Condition, Lattice, Method, Solver, Trim};

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/");

fn read(name: &str) -> String {
    std::fs::read_to_string(format!("{CASE}{name}")).unwrap()
}

pub(crate) fn lattice() -> (Geometry, Lattice) {
    let (geometry, _) = Geometry::parse(&read("f25.avl"), "f25.avl").unwrap();
    let files = |p: &str| std::fs::read_to_string(format!("{CASE}{p}")).ok();
    let (lattice, remarks) = Lattice::new(&geometry, &files).unwrap();
    assert!(remarks.is_empty(), "{remarks:?}");
    (geometry, lattice)
}

/// Numbers of two texts, line by line: those that differ, with the number of units in the last digit.
fn differences(name: &str, ours: &str, avl: &str) -> Vec<(String, f64)> {
    let mut out = Vec::new();
    let numbers = |line: &str| -> Vec<String> {
        let spaced = line.replace('=', " = ");
        spaced.split_whitespace().filter(|w| w.parse::<f64>().is_ok()).map(str::to_owned).collect()
    };
    for (k, (a, b)) in ours.lines().zip(avl.lines()).enumerate() {
        if a.contains("Run case") || b.contains("Configuration") {
            continue;
        }
        let (a, b) = (numbers(a), numbers(b));
        assert_eq!(a.len(), b.len(), "{name}:{}: {a:?} {b:?}", k + 1);
        for (x, y) in a.iter().zip(&b) {
            let digits = y.split_once('.').map_or(0, |d| d.1.len());
            let (u, v) = (x.parse::<f64>().unwrap(), y.parse::<f64>().unwrap());
            let units = (u - v).abs() * 10_f64.powi(digits as i32);
            // Where the lift prints as zero the centre of pressure is a quotient of rounding errors.
            let no_lift = b.len() == 15 && b[6].trim_start_matches('-') == "0.0000" && digits == 3;
            if units > 0.5 && !no_lift {
                out.push((format!("{name}:{}: {x} for {y} in {:?}", k + 1, b), units));
            }
        }
    }
    assert_eq!(ours.lines().count(), avl.lines().count(), "{name}");
    out
}

#[test]
fn val_digits_of_avl_352() {
    let (geometry, lattice) = lattice();
    let solver = Solver::new(&lattice, &Method::AVL_352, geometry.mach).unwrap();
    let mut found = BTreeMap::new();
    let mut report = |name: &str, ours: String| {
        let avl = read(&format!("avl_out/{name}"));
        let total = avl.split_whitespace().filter(|w| w.parse::<f64>().is_ok()).count();
        let d = differences(name, &ours, &avl);
        println!("{name}: {} of {total} numbers differ", d.len());
        for line in &d {
            println!("   {} ({:.0})", line.0, line.1);
        }
        found.insert(name.to_owned(), d);
    };
    for alpha in [0.0, 1.0, 2.0, 4.0] {
        let s = solver.solve(&Condition::at_alpha_deg(alpha, &lattice)).unwrap();
        report(&format!("alpha{alpha}.fs"), s.strip_forces().to_text().unwrap());
        if alpha == 0.0 {
            report("alpha0.ft", s.run_state(" -unnamed-").to_text().unwrap());
        }
        if alpha == 2.0 {
            report("alpha2.st", s.stability_derivatives(" -unnamed-").to_text().unwrap());
        }
    }
    let mut trim = Trim::new(&lattice);
    trim.set(&lattice, &RunVariable::Alpha, RunTarget::Lift, 0.5644).unwrap();
    trim.set(&lattice, &RunVariable::Control("elevator".into()), RunTarget::PitchMoment, 0.0).unwrap();
    let s = solver.trim(&trim).unwrap();
    report("trim.ft", s.run_state(" -unnamed-").to_text().unwrap());
    report("trim.st", s.stability_derivatives(" -unnamed-").to_text().unwrap());
    report("trim.fs", s.strip_forces().to_text().unwrap());
    println!("{:#?}", s.hinge_moments(None));
    println!("{:#?}", s.surface_forces().surfaces[5]);
    println!("{:#?}", s.body_derivatives("").u);
    println!("{:#?}", s.body_derivatives("").v);
    println!("{:#?}", s.body_derivatives("").controls[3]);
    let (run, _) = RunFile::parse(&read("f25.run"), "f25.run").unwrap();
    let t = Trim::of_run_case(&lattice, &run.cases[0]).unwrap();
    assert!((solver.trim(&t).unwrap().c_lift() - 0.564364).abs() < 1e-9);
}
