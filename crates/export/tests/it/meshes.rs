//! Meshes: points, cells and displacements of a small aircraft, and their XML.

use albatross_export::mesh::CellKind;
use albatross_export::{Error, Mesh, vtu};
use albatross_modal::{BasisGrid, BasisMass, BasisOptions, ModalBasis, ModeInput};
use albatross_nastran::bdf;
use albatross_nastran::deck::Deck;
use albatross_numerics::Mat;
use albatross_strip::slopes::StripRecord;
use albatross_strip::{Strip, StripShapes};

/// Three grids along a wing, the last held by a rigid element; a spring to the ground is not drawn.
const DECK: &str = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,5.,0.\nGRID,3,,2.,5.,0.\nGRID,9,,0.,0.,9.\n\
CBAR,10,1,1,2,0.,0.,1.\nRBE2,20,2,123456,3\nCONM2,30,3,,5.\nCELAS2,40,1.,1,1\nCROD,50,1,1,9\nPBAR,1,1,1.,1.,1.,1.\nPROD,1,1,1.\n\
MAT1,1,7.+10,,.3\nENDDATA\n";

fn basis() -> ModalBasis {
    let positions = [[0.0; 3], [1.0, 5.0, 0.0], [2.0, 5.0, 0.0]];
    let grids = (1..)
        .zip(positions)
        .map(|(id, position)| BasisGrid { id, position });
    let mode = ModeInput {
        number: 7,
        omega_rad_s: std::f64::consts::TAU * 2.5,
        generalized_mass: 1.0,
        // Plunge with the square of y, nose up by 0.2 at the tip.
        shape: vec![
            [0.0; 6],
            [0.0, 0.1, 1.0, 0.0, 0.2, 0.0],
            [0.0, 0.1, 0.8, 0.0, 0.2, 0.0],
        ],
    };
    ModalBasis::try_new(
        grids.collect(),
        vec![mode],
        BasisMass::unknown(),
        &BasisOptions::default(),
    )
    .unwrap()
}

fn strips() -> (Vec<StripRecord>, Vec<Strip>, StripShapes) {
    let record = |side: f64| StripRecord {
        surface: "Wing".into(),
        index: 1,
        leading_edge: [1.0, side * 4.0, 0.5],
        chord: 2.0,
        width: 2.0,
        dihedral_rad: side * 0.1,
        sweep_rad: 0.3,
        cl_alpha: 6.0,
        cl0: 0.0,
        cm_alpha: 0.0,
        cm0: 0.0,
    };
    let records = vec![record(1.0), record(-1.0)];
    let strips: Vec<Strip> = records.iter().map(|r| r.strip(1.8, 6.0)).collect();
    let shapes =
        StripShapes::try_new(Mat::from_fn(2, 1, |_, _| 0.7), Mat::from_fn(2, 1, |_, _| 0.2)).unwrap();
    (records, strips, shapes)
}

fn mesh() -> Mesh {
    let (deck, _) = bdf::parse(DECK.as_bytes(), "wing.bdf");
    let mut mesh = Mesh::of_structure(&basis(), &deck);
    let (records, strips, shapes) = strips();
    mesh.add_strips(&records, &strips, &shapes).unwrap();
    mesh
}

#[test]
fn val_cells_join_what_the_deck_joins() {
    let mesh = mesh();
    let cells: Vec<_> = mesh
        .cells
        .iter()
        .map(|c| (c.kind, c.number, c.points.clone()))
        .collect();
    assert_eq!(
        cells,
        [
            (CellKind::Beam, 10, vec![0, 1]),
            (CellKind::Mass, 30, vec![2]),
            (CellKind::Rigid, 20, vec![1, 2]),
            (CellKind::Strip, 1, vec![3, 4, 5, 6]),
            (CellKind::Strip, 2, vec![7, 8, 9, 10]),
        ]
    );
    assert_eq!(mesh.grids[..4], [1, 2, 3, 0]);
    // The rod goes to a grid without results.
    assert!(
        mesh.notes[0].starts_with("1 elements are not drawn"),
        "{:?}",
        mesh.notes
    );
}

/// The chord stays rigid, both sides mirror each other, and the strip has its area.
#[test]
fn val_strips_move_as_the_aerodynamics_sees_them() {
    let mesh = mesh();
    let (right, left) = (&mesh.points[3..7], &mesh.points[7..11]);
    for (k, p) in right.iter().enumerate() {
        // The left side is walked from its tip.
        let q = left[[3, 2, 1, 0][k]];
        assert!(
            (p[0] - q[0]).abs() + (p[1] + q[1]).abs() + (p[2] - q[2]).abs() < 1e-14,
            "{p:?} {q:?}"
        );
    }
    let [inner, outer] = [right[0], right[3]];
    assert!((outer[0] - inner[0] - 2.0 * 0.3_f64.tan()).abs() < 1e-14 && outer[1] > inner[1]);
    assert!((right[1][0] - inner[0] - 2.0).abs() < 1e-14);
    let moved = &mesh.modes[0].displacement;
    assert_eq!(moved[1], [0.0, 0.1, 1.0]);
    for (at, d) in right.iter().zip(&moved[3..7]) {
        let along = 0.7 - (at[0] - 1.8) * 0.2;
        assert!((d[2] - along * 0.1_f64.cos()).abs() < 1e-14 && (d[1] + along * 0.1_f64.sin()).abs() < 1e-14);
    }
}

/// Two strips of one surface with a common end: it moves by the mean of both, the other ends as before.
#[test]
fn val_neighbours_meet() {
    let (records, _, _) = strips();
    let record = |y: f64, surface: &str| StripRecord {
        surface: surface.into(),
        leading_edge: [1.0 + 0.5 * y, y, 0.0],
        dihedral_rad: 0.0,
        sweep_rad: 0.5_f64.atan(),
        ..records[0].clone()
    };
    let drawn = |surfaces: [&str; 2]| {
        let records = [record(3.0, surfaces[0]), record(5.0, surfaces[1])];
        let strips = records.clone().map(|r| r.strip(2.0, 6.0));
        let plunge = Mat::from_fn(2, 1, |j, _| 1.0 + j as f64);
        let shapes = StripShapes::try_new(plunge, Mat::zeros(2, 1)).unwrap();
        let mut mesh = Mesh::of_structure(&basis(), &Deck::default());
        mesh.add_strips(&records, &strips, &shapes).unwrap();
        let up: Vec<f64> = mesh.modes[0].displacement[3..].iter().map(|d| d[2]).collect();
        (mesh, up)
    };
    let (mesh, up) = drawn(["Wing", "Wing"]);
    assert_eq!(up, [1.0, 1.0, 1.5, 1.5, 1.5, 1.5, 2.0, 2.0]);
    let (inner, outer) = (mesh.points[6], mesh.points[7]);
    assert!((0..3).all(|i| (inner[i] - outer[i]).abs() < 1e-14) && (inner[1] - 4.0).abs() < 1e-14);
    let (_, up) = drawn(["Wing", "Tail"]);
    assert_eq!(up, [1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
}

#[test]
fn val_strips_must_fit_the_modes() {
    let (deck, _) = bdf::parse(DECK.as_bytes(), "wing.bdf");
    let mut mesh = Mesh::of_structure(&basis(), &deck);
    let (records, strips, _) = strips();
    let two_modes = StripShapes::try_new(Mat::zeros(2, 2), Mat::zeros(2, 2)).unwrap();
    let refused = mesh.add_strips(&records, &strips, &two_modes).unwrap_err();
    assert!(
        matches!(
            refused,
            Error::Mismatch {
                found: 2,
                expected: 1,
                ..
            }
        ),
        "{refused}"
    );
    assert!(mesh.add_strips(&records[..1], &strips, &two_modes).is_err());
}

#[test]
fn regress_parts_that_do_not_fit_are_refused() {
    type Case = (&'static str, fn(&mut Mesh, &mut StripShapes));
    let (deck, _) = bdf::parse(DECK.as_bytes(), "wing.bdf");
    let cases: [Case; 4] = [
        ("strips with rotations: found 1, expected 2", |_, s| {
            s.gamma.truncate(1, 1)
        }),
        ("rotations on the strips: found 0, expected 1", |_, s| {
            s.gamma.truncate(2, 0)
        }),
        ("displacements of mode 1: found 2, expected 3", |m, _| {
            m.modes[0].displacement.truncate(2)
        }),
        ("displacements of mode 1: found 3, expected 1", |m, _| {
            m.points.truncate(1)
        }),
    ];
    for (expected, alter) in cases {
        let mut mesh = Mesh::of_structure(&basis(), &deck);
        let (records, strips, mut shapes) = strips();
        alter(&mut mesh, &mut shapes);
        let refused = mesh.add_strips(&records, &strips, &shapes).unwrap_err();
        assert_eq!(refused.to_string(), expected);
    }
}

/// Numbers of a data array.
fn array(text: &str, name: &str) -> Vec<f64> {
    let start = text
        .find(&format!("Name=\"{name}\""))
        .unwrap_or_else(|| panic!("no {name}"));
    let body = &text[start + text[start..].find('>').unwrap() + 1..];
    let body = &body[..body.find("</DataArray>").unwrap()];
    body.split_whitespace().map(|n| n.parse().unwrap()).collect()
}

#[test]
fn val_the_xml_reads_back_equal() {
    let mesh = mesh();
    let text = vtu::write(&mesh);
    assert_eq!(array(&text, "position"), mesh.points.concat());
    assert_eq!(
        array(&text, "mode_01_2.500_Hz"),
        mesh.modes[0].displacement.concat()
    );
    assert_eq!(
        array(&text, "connectivity"),
        (0..2)
            .chain([2, 1, 2])
            .chain(3..11)
            .map(f64::from)
            .collect::<Vec<_>>()
    );
    assert_eq!(array(&text, "offsets"), [2.0, 3.0, 5.0, 9.0, 13.0]);
    assert_eq!(array(&text, "types"), [3.0, 1.0, 3.0, 9.0, 9.0]);
    assert_eq!(array(&text, "kind"), [1.0, 0.0, 4.0, 5.0, 5.0]);
    assert_eq!(array(&text, "frequency_hz"), [mesh.modes[0].frequency_hz]);
    assert!(text.contains("NumberOfPoints=\"11\" NumberOfCells=\"5\""));
}
