//! The mass matrix of decks against the definition sums of mechanics.

use albatross_modal::{BarMass, DeckMass, MassProperties};
use albatross_nastran::frames::Frames;
use albatross_nastran::{Deck, bdf, refuse_errors};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

fn assemble(bulk: &str) -> DeckMass {
    assemble_as(bulk, BarMass::Lumped).expect("a valid mass model")
}

fn assemble_as(bulk: &str, bars: BarMass) -> Result<DeckMass, albatross_modal::Error> {
    let deck = parse(bulk);
    let frames = Frames::resolve(&deck)?;
    Ok(DeckMass::assemble(&deck, &frames, bars)?)
}

fn parse(bulk: &str) -> Deck {
    let text = format!("SOL 103\nCEND\nBEGIN BULK\n{bulk}\nENDDATA\n");
    refuse_errors(bdf::parse(text.as_bytes(), "test.bdf"))
        .expect("a valid deck")
        .0
}

fn properties(bulk: &str) -> MassProperties {
    let mass = assemble(bulk);
    assert_eq!(mass.other, Vec::<String>::new());
    mass.model.properties().expect("has mass")
}

/// A body by its mass, centre and inertia about that centre, in basic axes.
struct Body(f64, Vector3<f64>, Matrix3<f64>);

/// Mass, centre and inertia of several bodies by Steiner's theorem.
fn together(bodies: &[Body]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let mass: f64 = bodies.iter().map(|b| b.0).sum();
    let center = bodies.iter().map(|b| b.1 * b.0).sum::<Vector3<f64>>() / mass;
    let inertia = bodies.iter().map(|Body(m, c, j)| {
        let r = c - center;
        j + (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * *m
    });
    (mass, center, inertia.sum())
}

fn assert_same(
    got: &MassProperties,
    (mass, center, inertia): (f64, Vector3<f64>, Matrix3<f64>),
    tolerance: f64,
) {
    assert!(
        (got.mass - mass).abs() <= tolerance * mass,
        "mass {} {mass}",
        got.mass
    );
    let size = inertia.amax().max(mass * center.norm_squared());
    for i in 0..3 {
        let length = center.norm().max(1.0);
        assert!(
            (got.cg[i] - center[i]).abs() <= tolerance * length,
            "cg {:?} {center:?}",
            got.cg
        );
        for k in 0..3 {
            assert!(
                (got.inertia[i][k] - inertia[(i, k)]).abs() <= tolerance * size,
                "{:?} {inertia}",
                got.inertia
            );
        }
    }
}

fn free_field(values: &[f64]) -> String {
    values
        .iter()
        .map(|v| format!("{v:.15e}"))
        .collect::<Vec<_>>()
        .join(",")
}

proptest! {
    /// CONM2 with offset and inertia in a turned frame at a grid off the origin, with a second mass: Steiner. The
    /// card's products are +int(x y dm), the tensor's are negative.
    #[test]
    fn prop_conm2_follows_the_parallel_axis_theorem(
        grid in prop::array::uniform3(-20.0..20.0_f64),
        offset in prop::array::uniform3(-2.0..2.0_f64),
        angle in -3.0..3.0_f64,
        m in 1.0..100.0_f64,
        moments in prop::array::uniform6(1.0..9.0_f64),
    ) {
        let [ixx, iyx, iyy, izx, izy, izz] = moments;
        let (s, c) = angle.sin_cos();
        // Frame 7: turned by the angle about basic x.
        let axes = Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c);
        let bulk = format!(
            "CORD2R,7,0,0.,0.,0.,{}\n,{}\nGRID,1,,{}\nGRID,2,,0.,0.,0.\nCONM2,11,1,7,{m:.15e},{}\n,{}\nCONM2,12,2,,50.",
            free_field(&[0.0, -s, c]),
            free_field(&[1.0, 0.0, 0.0]),
            free_field(&grid),
            free_field(&offset),
            free_field(&[ixx, iyx, iyy, izx, izy, izz]),
        );
        let tensor = Matrix3::new(ixx, -iyx, -izx, -iyx, iyy, -izy, -izx, -izy, izz);
        let first = Body(m, Vector3::from(grid) + axes * Vector3::from(offset), axes * tensor * axes.transpose());
        let second = Body(50.0, Vector3::zeros(), Matrix3::zeros());
        assert_same(&properties(&bulk), together(&[first, second]), 1e-12);
    }
}

/// CID = -1: the "offset" is the centre's basic position, and the inertia is in basic directions, whatever CP and CD.
#[test]
fn val_conm2_with_cid_minus_one_is_placed_in_basic() {
    let got = properties(
        "CORD2R,5,0,1.,0.,0.,1.,0.,1.\n,1.,1.,0.\nGRID,1,5,4.,3.,2.,5\nCONM2,9,1,-1,10.,7.,-2.,1.5\n,3.,0.5,4.,0.2,0.1,5.",
    );
    let tensor = Matrix3::new(3.0, -0.5, -0.2, -0.5, 4.0, -0.1, -0.2, -0.1, 5.0);
    assert_same(
        &got,
        together(&[Body(10.0, Vector3::new(7.0, -2.0, 1.5), tensor)]),
        1e-14,
    );
}

/// A CONM1 that holds the matrix of an offset mass, in a frame turned by 90 degrees about z, is that mass.
#[test]
fn val_conm1_in_a_turned_frame() {
    // Frame 3: local x = basic y, local y = basic -x. Local offset (2, 0, 0) is basic (0, 2, 0).
    // M22 = M33 = 6, M62 = 6 * 2, M53 = -12, M55 = 24 + 2, M66 = 24 + 3, M44 = 1.
    let got = properties(
        "CORD2R,3,0,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nGRID,1,,1.,1.,1.\n\
         CONM1,8,1,3,6.,,6.,,\n,6.,,,,1.,,,-12.\n,,26.,,12.,,,,27.",
    );
    let tensor = Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 3.0));
    assert_same(
        &got,
        together(&[Body(6.0, Vector3::new(1.0, 3.0, 1.0), tensor)]),
        1e-14,
    );
}

const BEAM: &str =
    "MAT1,1,7.+10,,0.3,2700.\nPBAR,1,1,0.01,1.-6,1.-6,1.-6,0.5\nGRID,1,,0.,0.,0.\nGRID,2,,0.,4.,0.\n";

/// 27.5 kg/m over 4 m, half at each end; offsets move both halves.
#[test]
fn val_bar_lumps_half_at_each_end() {
    let plain = properties(&format!("{BEAM}CBAR,1,1,1,2,0.,0.,1."));
    let half = |y: f64, x: f64| Body(55.0, Vector3::new(x, y, 0.0), Matrix3::zeros());
    assert_same(&plain, together(&[half(0.0, 0.0), half(4.0, 0.0)]), 1e-14);

    let offset = properties(&format!("{BEAM}CBAR,1,1,1,2,0.,0.,1.\n,,,0.3,0.,0.,0.3,0.,0."));
    assert_same(&offset, together(&[half(0.0, 0.3), half(4.0, 0.3)]), 1e-14);
}

/// Offsets are in the displacement system of each grid.
#[test]
fn val_bar_offsets_follow_the_displacement_system() {
    let bulk = "MAT1,1,7.+10,,0.3,2700.\nPBAR,1,1,0.01,1.-6,1.-6,1.-6,0.5\nCORD2R,4,0,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n\
                GRID,1,,0.,0.,0.,4\nGRID,2,,0.,4.,0.\nCBAR,1,1,1,2,0.,0.,1.\n,,,0.,-0.3,0.,0.3,0.,0.";
    let half = |y: f64| Body(55.0, Vector3::new(0.3, y, 0.0), Matrix3::zeros());
    assert_same(&properties(bulk), together(&[half(0.0), half(4.0)]), 1e-14);
}

/// With coupled mass a bar is a thin rod with inertia m L^2 / 12.
#[test]
fn val_coupled_bar_is_a_thin_rod() {
    let mass = assemble_as(&format!("{BEAM}CBAR,1,1,1,2,0.,0.,1."), BarMass::Coupled).expect("valid");
    let rod = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0)) * (110.0 * 16.0 / 12.0);
    let got = mass.model.properties().expect("has mass");
    assert_same(
        &got,
        together(&[Body(110.0, Vector3::new(0.0, 2.0, 0.0), rod)]),
        1e-13,
    );
}

#[test]
fn val_rods_and_weight_to_mass() {
    let got = properties(
        "PARAM,WTMASS,0.5\nMAT1,1,7.+10,,0.3,1000.\nPROD,1,1,0.02,,,2.\nGRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\n\
         CROD,1,1,1,2\nCONROD,2,1,2,1,0.01,,,4.\nCONM2,3,1,,7.",
    );
    // CROD 22 kg/m, CONROD 14 kg/m over 3 m, 7 kg: 115, halved.
    assert!((got.mass - 57.5).abs() < 1e-13);
    assert!((got.cg[0] - 108.0 * 1.5 / 115.0).abs() < 1e-14);
}

#[test]
fn other_mass_is_named() {
    let mass = assemble(
        "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nMAT1,1,7.+10,,0.3,2700.\n\
         MAT1,2,7.+10,,0.3\nPSHELL,1,1,0.01\nPSHELL,2,2,0.01\nPSHELL,3,2,0.01,,,,,5.\nCQUAD4,1,1,1,2,3,4\n\
         CQUAD4,2,2,1,2,3,4\nCTRIA3,3,3,1,2,3\nCMASS2,4,100.,1,3\nCONM2,5,1,,3.",
    );
    assert_eq!(mass.other, ["1 CMASSi scalar masses (4)", "1 CQUAD4", "1 CTRIA3"]);
    let reason = mass.incomplete().expect("incomplete");
    assert!(
        reason.contains("mass that is not in the mass matrix: 1 CMASSi"),
        "{reason}"
    );
}

#[test]
fn missing_cards_are_named_with_their_place() {
    let message = |bulk: &str| {
        let text = format!("SOL 103\nCEND\nBEGIN BULK\n{bulk}\nENDDATA\n");
        let (deck, _) = bdf::parse(text.as_bytes(), "wing.bdf");
        let frames = Frames::resolve(&deck).expect("frames");
        DeckMass::assemble(&deck, &frames, BarMass::Lumped)
            .unwrap_err()
            .to_string()
    };
    let grid = message("CONM2,5,77,,3.");
    assert_eq!(
        grid,
        "wing.bdf:4: CONM2 5: GRID 77 is not in the deck; add the card or correct the number"
    );
    let property = message("GRID,1\nGRID,2,,1.,0.,0.\nCBAR,6,3,1,2,0.,0.,1.");
    assert!(
        property.contains("CBAR 6: PBAR or PBARL 3 is not in the deck"),
        "{property}"
    );
    let length = message("MAT1,1,1.,,.3,5.\nPBAR,3,1,1.\nGRID,1\nGRID,2\nCBAR,6,3,1,2,0.,0.,1.");
    assert!(
        length.contains("its length between grids 1 and 2 is 0 m"),
        "{length}"
    );
}
