//! Every liberty of the input format, and what is said about mistakes.

use std::path::Path;

use albatross_nastran::deck::{Components, Deck, Orientation, SectionShape};
use albatross_nastran::{Diagnostic, Error, Severity, bdf, refuse_errors};
use approx::assert_relative_eq;

fn read(text: &str) -> (Deck, Vec<Diagnostic>) {
    bdf::parse(text.as_bytes(), "wing.bdf")
}

/// The deck, with no remark of severity error.
fn clean(text: &str) -> Deck {
    refuse_errors(read(text)).unwrap().0
}

fn errors(text: &str) -> Vec<String> {
    let (_, remarks) = read(text);
    remarks
        .iter()
        .filter(|r| r.severity == Severity::Error)
        .map(ToString::to_string)
        .collect()
}

#[test]
fn sections_are_kept_apart() {
    let deck = clean(
        "$ comment\nassign output2='x.op2'\nSOL 103 $ modes\nCEND\nTITLE = 'cost in $' $ remark\nsubti = abc\nSPC = 1\n\
         PARAM,WTMASS,0.5\nBEGIN BULK\ngrid,1\nBEGIN BULK\nGRID,2\nENDDATA\nGRID,3\n",
    );
    assert_eq!(deck.executive, ["assign output2='x.op2'", "SOL 103"]);
    assert_eq!(
        deck.case_control,
        [
            "TITLE = 'cost in $'",
            "subti = abc",
            "SPC = 1",
            "PARAM,WTMASS,0.5"
        ]
    );
    assert_eq!(deck.grids.keys().copied().collect::<Vec<_>>(), [1, 2]);
    assert_eq!(deck.weight_to_mass(), 0.5);
    // Bulk data alone, and a deck without executive control.
    assert_eq!(clean("GRID,1\n").grids.len(), 1);
    assert_eq!(clean("SPC = 1\nBEGIN BULK\nGRID,1\n").case_control, ["SPC = 1"]);
    assert!(errors("SOL 103\nCEND\nGRID,1\n")[0].contains("BEGIN BULK: is missing"));
}

#[test]
fn tabs_line_ends_and_case() {
    let deck = clean(
        "grid\t1\t\t1.5\t-2.5\t3.5\r\nGRID    2               4.5     \r\nparam,post,-1\r\nENDDATA\r\n\x1a",
    );
    assert_eq!(deck.grids[&1].position, [1.5, -2.5, 3.5]);
    assert_eq!(deck.grids[&2].position, [4.5, 0.0, 0.0]);
    assert_eq!(deck.param("POST").unwrap().as_integer(), Some(-1));
}

#[test]
fn touching_fields_and_short_exponents() {
    let deck = clean(
        "GRID           1        27.11325+5.     -.001134\n\
         MAT1           1  1.44+9            1.-3   2.9+7\n\
         GRID           2        .0011338.0113376-.5\n",
    );
    assert_eq!(deck.grids[&1].position, [27.11325, 5.0, -0.001_134]);
    assert_eq!(deck.grids[&2].position, [0.001_133_8, 0.011_337_6, -0.5]);
    let mat = &deck.materials[&1];
    assert_eq!((mat.e, mat.nu, mat.rho), (Some(1.44e9), Some(1e-3), 2.9e7));
}

#[test]
fn continuations_of_all_styles_and_places() {
    let expected = clean("SPC1,9,123,1,2,3,4,5,6,7,8,9,10,11,12,13,14").spc1s[0]
        .points
        .clone();
    assert_eq!(expected, (1..=14).collect::<Vec<_>>());
    for text in [
        // Blank first field, bare plus, marks.
        "SPC1           9     123       1       2       3       4       5       6\n               7       8       9      10      11      12      13      14\n",
        "SPC1           9     123       1       2       3       4       5       6+\n+              7       8       9      10      11      12      13      14\n",
        "SPC1           9     123       1       2       3       4       5       6+PB1F   \n+PB1F          7       8       9      10      11      12      13      14\n",
        // The continuation before its card, and after another card.
        "+PB1F          7       8       9      10      11      12      13      14\nGRID           1\nSPC1           9     123       1       2       3       4       5       6+PB1F   \n",
        "SPC1           9     123       1       2       3       4       5       6+PB1F   \nGRID           1\n+PB1F          7       8       9      10      11      12      13      14\n",
        // Large field, free field with marks, free field over the end of the line.
        "SPC1*                  9             123               1               2*A\n*A                     3               4               5               6*B\n*B                     7               8               9              10*C\n*C                    11              12              13              14\n",
        "SPC1,9,123,1,2,3,4,5,6,+A\n+A,7,8,9,10,11,12,13,14\n",
        "spc1,9,123,1,2,3,4,5,6\n,7,8,9,10,11,12,13,14\n",
        "SPC1,9,123,1,thru,14\n",
        // Sequence numbers in columns 73 to 80 are no marks.
        "SPC1           9     123       1       2       3       4       5       600000010\n               7       8       9      10      11      12      13      1400000020\n",
    ] {
        let deck = read(text).0;
        assert_eq!(deck.spc1s.len(), 1, "{text}");
        assert_eq!(deck.spc1s[0].points, expected, "{text}");
    }
    assert!(errors("GRID,1\n+LOST,1,2\n").is_empty());
    assert!(
        errors(
            "GRID           1                                                        +A\n+LOST          1\n"
        )[0]
        .contains("no card has the mark \"LOST\"")
    );
    assert!(errors("+A,1\n")[0].contains("no card has the mark"));
    assert!(errors(",1\n")[0].contains("continues no card"));
}

#[test]
fn replication_repeats_and_increments() {
    let deck = clean("GRID,101,,1.0,10.5,,,123\n=,*(1),=,*(0.25),==\n=(3)\nGRID,9,,7.\n=,*1,==\n");
    assert_eq!(
        deck.grids.keys().copied().collect::<Vec<_>>(),
        [9, 10, 101, 102, 103, 104, 105]
    );
    assert_eq!(deck.grids[&105].position, [2.0, 10.5, 0.0]);
    assert_eq!(deck.grids[&105].ps, Components::TRANSLATIONS);
    assert_eq!(deck.grids[&10].position, [7.0, 0.0, 0.0]);
    assert!(errors("=,1\n")[0].contains("no card before it"));
    assert!(errors("GRID,1\n=(3)\n")[0].contains("must follow a line that begins with ="));
}

#[test]
fn defaults_of_grdset_and_baror_wherever_they_stand() {
    let deck = clean(
        "CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1\nGRID,2,0,,,,0,0\nGRDSET,,5,,,,5,345\n\
         CBAR,1,,1,2\nCBAR,2,7,1,2,0.,1.,0.\nBAROR,,8,,,0.,0.,1.,GOO\nPBAR,7,1\nPBAR,8,1\nMAT1,1,7.+10\n",
    );
    let (with, without) = (&deck.grids[&1], &deck.grids[&2]);
    assert_eq!((with.cp, with.cd, with.ps.to_string().as_str()), (5, 5, "345"));
    assert_eq!((without.cp, without.cd, without.ps), (0, 0, Components::NONE));
    let bar = &deck.bars[&1];
    assert_eq!((bar.pid, bar.offset_frames.as_ref()), (8, "GOO"));
    assert_eq!(bar.orientation, Some(Orientation::Vector([0.0, 0.0, 1.0])));
    assert_eq!(
        (deck.bars[&2].pid, deck.bars[&2].orientation.clone()),
        (7, Some(Orientation::Vector([0.0, 1.0, 0.0])))
    );
}

#[test]
fn bars_of_both_generations() {
    let deck = clean(
        "GRID,1\nGRID,2,,1.\nGRID,3,,,1.\nPBAR,7,1,.1\nMAT1,1,7.+10\n\
         CBAR,1,7,1,2,3\nCBAR,2,7,1,2,0.,1.,0.,1\nCBAR,3,7,1,2,3,,,2\n\
         CBAR,4,7,1,2,0.,1.,0.,GGO\n,45,,.1,.2,.3,.4,.5,.6\n",
    );
    assert_eq!(deck.bars[&1].orientation, Some(Orientation::Grid(3)));
    assert_eq!(
        deck.bars[&2].orientation,
        Some(Orientation::Vector([0.0, 1.0, 0.0]))
    );
    assert_eq!(deck.bars[&3].orientation, Some(Orientation::Grid(3)));
    let bar = &deck.bars[&4];
    assert_eq!(
        (bar.pins[0].to_string().as_str(), bar.wa, bar.wb),
        ("45", [0.1, 0.2, 0.3], [0.4, 0.5, 0.6])
    );
}

#[test]
fn sections_and_tapered_beams() {
    let deck = clean(
        "MAT1,1,7.+10\nPBARL,1,1,,BOX\n,.4,.2,.01,.02,3.5\n\
         PBEAML,2,1,,ROD\n,.1,2.,YES,.5,.2,3.,NO,1.,.3,4.\n\
         PBEAM,3,1,.10,1.-4,2.-4,,3.-4,5.\n,.1,.2,.3,.4\n,NO,.5,.08\n,YES,1.,.04,,,,,1.\n,.5,.6\n,.9,.8\n",
    );
    let box_beam = &deck.bar_properties[&1];
    // Outer minus inner rectangle.
    assert_relative_eq!(
        box_beam.area().unwrap(),
        0.4 * 0.2 - 0.36 * 0.18,
        max_relative = 1e-14
    );
    assert_eq!(box_beam.nsm(), 3.5);
    let stations = deck.beam_properties[&2].mass_stations().unwrap();
    let area = |r: f64| std::f64::consts::PI * r * r;
    for (found, expected) in stations.iter().zip([
        (0.0, area(0.1), 2.0),
        (0.5, area(0.2), 3.0),
        (1.0, area(0.3), 4.0),
    ]) {
        assert_eq!((found.0, found.2), (expected.0, expected.2));
        assert_relative_eq!(found.1, expected.1, max_relative = 1e-14);
    }
    // A blank at the middle station is interpolated: nsm between 5 and 1.
    assert_eq!(
        deck.beam_properties[&3].mass_stations().unwrap(),
        [(0.0, 0.10, 5.0), (0.5, 0.08, 3.0), (1.0, 0.04, 1.0)]
    );
    assert_eq!(SectionShape::from_name("CHAN1").unwrap().dimension_count(), 4);
}

#[test]
fn rigid_elements_and_constraints() {
    let deck = clean(
        "GRID,1\nGRID,2\nGRID,3\nGRID,4\nGRID,5\nSPOINT,11,THRU,13\n\
         RBE2,1,1,123456,2,3,4,1.2-5\n\
         RBE3,2,,5,123456,1.0,123,1,2,+\n+,3,2.5,12,4\n,UM,1,123,2,12\n,ALPHA,6.5-6\n\
         RBAR,3,1,2,123456\n\
         MPC,7,1,1,1.,2,1,-1.,,+\n+,,11,0,.5\n\
         SPC,1,1,123,.1,2,456\nSUPORT,1,12,2,3\nSUPORT1,4,3,123456\n\
         ASET,1,123,2,456\nASET1,123456,1,THRU,3\nOMIT1,1,4\nSET1,1,SKIN,1,thru,4\n",
    );
    let rbe2 = &deck.rbe2[&1];
    assert_eq!(
        (rbe2.dependents.as_slice(), rbe2.expansion),
        (&[2, 3, 4][..], Some(1.2e-5))
    );
    let rbe3 = &deck.rbe3[&2];
    assert_eq!(rbe3.groups.len(), 2);
    assert_eq!(
        (rbe3.groups[0].grids.as_slice(), rbe3.groups[1].weight),
        (&[1, 2, 3][..], 2.5)
    );
    assert_eq!((rbe3.um.len(), rbe3.expansion), (2, Some(6.5e-6)));
    assert_eq!(deck.rbars[&3].independent, [Components::ALL, Components::NONE]);
    assert_eq!(
        deck.mpcs[0]
            .terms
            .iter()
            .map(|t| t.coefficient)
            .collect::<Vec<_>>(),
        [1.0, -1.0, 0.5]
    );
    assert_eq!(deck.spcs.len(), 2);
    assert_eq!(
        deck.suports.iter().map(|s| (s.sid, s.point)).collect::<Vec<_>>(),
        [(None, 1), (None, 2), (Some(4), 3)]
    );
    assert_eq!(deck.asets.len(), 3);
    assert_eq!((deck.sets[&1].skin, deck.sets[&1].members.len()), (true, 4));
}

#[test]
fn other_cards_are_kept_with_their_place() {
    let deck = clean("GRID,1\nCAERO1,1001,1,,8,4,,,1\n,0.,0.,0.,1.,.2,1.,0.,1.\n");
    let card = &deck.raw[0];
    assert_eq!((card.name.as_str(), card.fields.len()), ("CAERO1", 16));
    assert_eq!(card.fields[12], ".2");
    assert_eq!(card.origin.as_ref().unwrap().to_string(), "wing.bdf:2");
}

#[test]
fn mistakes_name_file_line_card_and_cure() {
    let cases = [
        (
            "GRID,1,,1.2.3\n",
            "error: wing.bdf:1: GRID 1: field 4 (X1) is \"1.2.3\"; expected a real number such as 1.5, 1.5E-3 or 1.5-3",
        ),
        (
            "\nGRID,,,1.\n",
            "error: wing.bdf:2: GRID: field 2 (ID) is blank; expected a positive integer",
        ),
        (
            "GRID,1\nCONM2,7,2,,5.\n",
            "error: wing.bdf:2: CONM2 7: G is grid 2, which is not in the deck; add its GRID card or correct G",
        ),
        (
            "GRID,1\nGRID,1,,5.\n",
            "error: wing.bdf:2: GRID 1: the number is given 2 times, different; renumber or remove one (wing.bdf:1, wing.bdf:2)",
        ),
        (
            "GRID,1,,,,,,127\n",
            "field 8 (PS) is \"127\"; expected components as digits 1 to 6",
        ),
        (
            "RBE2,1,1,123456\nGRID,1\n",
            "expected at least one dependent grid",
        ),
        (
            "CBAR,1,2,1,2,0.,0.,0.\nGRID,1\nGRID,2\n",
            "the orientation vector is zero",
        ),
        (
            "CBAR,1,2,1,2,0.,0.,1.\nGRID,1\nGRID,2\n",
            "names property PBAR or PBARL 2, which is not in the deck",
        ),
        ("PBAR,1,4\n", "names material MAT1 4"),
        ("SPC1,1,12A,1\n", "components as digits 1 to 6"),
        ("INCLUDE 'a.bdf'\n", "error: wing.bdf:1: INCLUDE: \"a.bdf\""),
    ];
    for (text, expected) in cases {
        let found = errors(text);
        assert!(found.iter().any(|e| e.contains(expected)), "{text}: {found:?}");
    }
    // An integer for a real is read, with a warning.
    let (deck, remarks) = read("GRID,1,,5\n");
    assert_eq!(deck.grids[&1].position[0], 5.0);
    assert!(
        remarks[0].severity == Severity::Warning && remarks[0].message.contains("read as the real 5."),
        "{remarks:?}"
    );
    // Identical copies are harmless.
    assert!(errors("GRID,1\nGRID,1\n").is_empty());
}

#[test]
fn a_deck_in_error_is_refused_when_asked() {
    let Err(Error::Deck { errors }) = refuse_errors(read("GRID,1,,x\nGRID,2,,y\n")) else {
        panic!("not refused")
    };
    assert_eq!(errors.len(), 2);
    let many: String = (1..=2000).map(|id| format!("GRID,{id},,x\n")).collect();
    let (_, remarks) = read(&many);
    assert!(
        remarks.len() < 1000 && remarks.last().unwrap().message.contains("further"),
        "{}",
        remarks.len()
    );
}

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

#[test]
fn included_files_are_found_and_circles_are_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(
        at,
        "main.bdf",
        "SOL 103\nCEND\ninclude 'parts/case.inc'\nBEGIN BULK\nGRID,1\n  INCLUDE parts/a.bdf $ remark\n\
         INCLUDE 'parts/with\n         space/b.bdf'\nINCLUDE \"parts\\c.bdf\"\nINCLUDE 'none.bdf'\nSPC1,1,123,1,2,3,4,5,6\nENDDATA\n",
    );
    write(at, "parts/case.inc", "SPC = 1\n");
    // Relative to the including file, then to the main file; the second one closes a circle.
    write(
        at,
        "parts/a.bdf",
        "GRID,2\nINCLUDE 'd.bdf'\nINCLUDE 'parts/d.bdf'\nINCLUDE '../main.bdf'\n",
    );
    write(at, "parts/withspace/b.bdf", "GRID,3\n");
    write(at, "parts/c.bdf", "GRID,4,,wrong\nGRID,5\n");
    write(at, "parts/d.bdf", "GRID,6\nINCLUDE 'a.bdf'\n");
    let (deck, remarks) = bdf::read(at.join("main.bdf")).unwrap();
    assert_eq!(deck.case_control, ["SPC = 1"]);
    assert_eq!(deck.grids.keys().copied().collect::<Vec<_>>(), [1, 2, 3, 5, 6]);
    let errors: Vec<_> = remarks.iter().filter(|r| r.severity == Severity::Error).collect();
    let has = |file: &str, line: u32, text: &str| {
        errors
            .iter()
            .any(|e| Path::new(&e.file).ends_with(file) && e.line == line && e.message.contains(text))
    };
    assert!(has("parts/c.bdf", 1, "wrong"), "{errors:?}");
    assert!(has("main.bdf", 10, "no such file"), "{errors:?}");
    assert!(has("parts/d.bdf", 2, "circle"), "{errors:?}");
    assert!(has("parts/a.bdf", 4, "circle"), "{errors:?}");
    assert_eq!(deck.origins.of("GRID", 6).unwrap().line, 1);
    assert!(
        bdf::read(at.join("absent.bdf"))
            .unwrap_err()
            .to_string()
            .contains("absent.bdf")
    );
}
