//! Small geometries as AVL text.

use albatross_avl::geometry::Geometry;
use albatross_vlm::{Condition, Lattice, Method, Solution, Solver};

/// Header with reference area, chord, span; planes of symmetry; moment point x.
pub(crate) fn header(symmetry: &str, s: f64, c: f64, b: f64, x: f64) -> String {
    format!("model\n0.0\n{symmetry}\n{s} {c} {b}\n{x} 0 0\n")
}

/// A surface: name, chordwise and spanwise counts and spacings, keywords, sections.
pub(crate) fn surface(name: &str, mesh: &str, keywords: &str, sections: &[&str]) -> String {
    let sections: String = sections.iter().map(|s| format!("SECTION\n{s}\n")).collect();
    format!("SURFACE\n{name}\n{mesh}\n{keywords}\n{sections}")
}

pub(crate) fn lattice(text: &str) -> Lattice {
    let (geometry, _) = Geometry::parse(text, "model.avl").unwrap();
    let (lattice, remarks) = Lattice::new(&geometry, &|_| None).unwrap();
    assert!(remarks.is_empty(), "{remarks:?}");
    lattice
}

/// Evaluates at an angle of attack, at Mach 0, in the method of AVL 3.52.
pub(crate) fn at_alpha<R>(lattice: &Lattice, alpha_deg: f64, f: impl FnOnce(&Solution<'_>) -> R) -> R {
    let solver = Solver::new(lattice, &Method::AVL_352, 0.0).unwrap();
    f(&solver
        .solve(&Condition::at_alpha_deg(alpha_deg, lattice))
        .unwrap())
}

/// Swept wing with dihedral, flaps and ailerons, tail and fin.
pub(crate) fn aircraft() -> String {
    let wing = surface(
        "wing",
        "4 1.0 7 -1.5",
        "YDUPLICATE\n0\nANGLE\n2\nCOMPONENT\n1",
        &[
            "0 0 0 1.2 1\nNACA\n2412\nCONTROL\nflap 1.0 0.7 0 0 0 1\nDESIGN\ntwist 0.0",
            "0.6 3 0.3 0.8 0\nNACA\n2412\nCONTROL\nflap 1.0 0.7 0 0 0 1\nCONTROL\naileron -1.0 0.75 0 0 0 -1",
            "1.0 4.5 0.45 0.6 -1\nNACA\n2410\nCONTROL\naileron -1.0 0.75 0 0 0 -1\nDESIGN\ntwist 1.0",
        ],
    );
    let tail = surface(
        "tail",
        "3 1.0 5 1.0",
        "YDUPLICATE\n0\nTRANSLATE\n5 0 0.4",
        &[
            "0 0 0 0.8 0\nCLAF\n1.05\nCONTROL\nelevator 1.0 0.6 0 1 0 1",
            "0.2 1.4 0 0.5 0\nCLAF\n1.05\nCONTROL\nelevator 1.0 0.6 0 1 0 1",
        ],
    );
    let fin = surface(
        "fin",
        "3 1.0 4 0.0",
        "TRANSLATE\n5 0 0.4",
        &[
            "0 0 0 0.9 0\nCONTROL\nrudder 1.0 0.6 0 0 1 1",
            "0.4 0 1.2 0.5 0\nCONTROL\nrudder 1.0 0.6 0 0 1 1",
        ],
    );
    header("0 0 0", 8.0, 0.9, 9.0, 0.5) + &wing + &tail + &fin
}
