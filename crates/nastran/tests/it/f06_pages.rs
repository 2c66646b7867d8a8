//! Pages in the layouts of MSC and NX, written here after the formats' description: page breaks, repeated headings,
//! subcases, scalar points, notes and damage.

use albatross_nastran::{Dialect, ModalResults, PointKind, Severity, f06};

fn page(program: &str, subcase: &str) -> String {
    format!(
        "1    WING                                                                  MARCH   3, 2012  {program}   PAGE    11\n\
         {:132}\n0{:>130}\n",
        "", subcase
    )
}

fn msc_page(subcase: &str) -> String {
    page("MSC.NASTRAN  4/ 3/07", subcase)
}

const TABLE: &str = "                                              R E A L   E I G E N V A L U E S\n   MODE    EXTRACTION      EIGENVALUE            RADIANS             CYCLES            GENERALIZED         GENERALIZED\n    NO.       ORDER                                                                       MASS              STIFFNESS\n";

fn table_row(mode: u32, eigenvalue: f64, mass: f64) -> String {
    let omega = eigenvalue.abs().sqrt();
    format!(
        "{mode:9}{:10}    {}    {}    {}    {}    {}\n",
        mode + 1,
        e16(eigenvalue),
        e16(omega),
        e16(omega / std::f64::consts::TAU),
        e16(mass),
        e16(mass * eigenvalue)
    )
}

/// Fortran's 1PE16.6.
fn e16(value: f64) -> String {
    format!("{:>16}", e(value))
}

fn e(value: f64) -> String {
    let text = format!("{value:.6E}");
    let (mantissa, exponent) = text.split_once('E').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    format!(
        "{mantissa}E{}{:02}",
        if exponent < 0 { '-' } else { '+' },
        exponent.abs()
    )
}

fn vector_heading(mode: u32, eigenvalue: f64) -> String {
    format!(
        "      EIGENVALUE = {}\n          CYCLES = {}         R E A L   E I G E N V E C T O R   N O . {mode:10}\n \n      POINT ID.   TYPE          T1             T2             T3             R1             R2             R3\n",
        e(eigenvalue),
        e(eigenvalue.abs().sqrt() / std::f64::consts::TAU)
    )
}

/// Sign and twelve characters from column 27 on, then two blanks, six times.
fn grid_row(id: u32, values: [f64; 6]) -> String {
    let mut line = format!("{id:14}      G     ");
    for value in values {
        let text = if value == 0.0 {
            " 0.0".to_owned()
        } else {
            format!("{:>13}", e(value))
        };
        line.push_str(&format!("{text:15}"));
    }
    line.push('\n');
    line
}

fn parse(text: &str) -> ModalResults {
    f06::parse(text.as_bytes(), "wing.f06").unwrap()
}

fn errors(r: &ModalResults) -> Vec<String> {
    r.diagnostics
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .map(ToString::to_string)
        .collect()
}

fn values(k: u32) -> [f64; 6] {
    let k = f64::from(k);
    [k, -k / 3.0, 0.0, k * 1e-12, -k * 1e11, 0.25]
}

#[test]
fn grid_rows_of_this_test_are_in_the_columns_of_real_files() {
    let real = "             2      G      1.500483E-18  -3.315288E-03   1.857573E-02   5.360878E-18  -3.055872E-02  -5.453943E-03";
    let own = grid_row(
        2,
        [
            1.500_483e-18,
            -3.315_288e-3,
            1.857_573e-2,
            5.360_878e-18,
            -3.055_872e-2,
            -5.453_943e-3,
        ],
    );
    assert_eq!(own.trim_end(), real);
    let real = "             1      G      0.0            0.0            0.0            0.0            0.0            0.0";
    assert_eq!(grid_row(1, [0.0; 6]).trim_end(), real);
}

#[test]
fn pages_are_merged_and_subcases_are_kept_apart() {
    let mut text = String::new();
    for subcase in [1, 2] {
        let label = format!("SUBCASE {subcase}");
        let lambda = |mode: u32| f64::from(100 * mode * subcase);
        // The table breaks after mode 2, with an empty page between.
        text += &(msc_page(&label)
            + " \n"
            + TABLE
            + &table_row(1, lambda(1), 1.0)
            + &table_row(2, lambda(2), 1.0));
        text += &msc_page(&label);
        text += &(msc_page(&label) + " \n" + TABLE + &table_row(3, lambda(3), 0.0));
        for mode in [1, 2] {
            for grids in [1..=50, 51..=70] {
                text += &(msc_page(&label) + &vector_heading(mode, lambda(mode)));
                for id in grids {
                    text += &grid_row(id, values(id + 100 * mode + 1000 * subcase));
                }
            }
        }
    }
    let r = parse(&text);
    assert_eq!(r.dialect, Dialect::Msc);
    assert!(r.diagnostics.is_empty(), "{:?}", r.diagnostics);
    assert_eq!(r.eigenvalues.len(), 2);
    assert!(r.eigenvalues.iter().all(|t| t.modes.len() == 3));
    assert_eq!(r.eigenvalues[1].subcase, Some(2));
    assert!(!r.eigenvalues[1].mode(3).unwrap().has_vector());
    assert_eq!(r.eigenvectors.len(), 4);
    for (v, (subcase, mode)) in r.eigenvectors.iter().zip([(1, 1), (1, 2), (2, 1), (2, 2)]) {
        assert_eq!(
            (v.subcase, v.mode, v.block, v.rows.len()),
            (Some(subcase), mode, 0, 70)
        );
        assert_eq!(r.table_for(v).unwrap().subcase, Some(subcase));
        for row in &v.rows {
            for (read, printed) in row
                .values
                .iter()
                .zip(values(row.id + 100 * mode + 1000 * subcase))
            {
                assert!((read - printed).abs() <= 5.1e-7 * printed.abs(), "{row:?}");
            }
        }
    }
}

/// The same modes printed for the structure and then for an aerodynamic mesh.
#[test]
fn restart_of_point_numbers_begins_a_block() {
    let mut text = msc_page("") + TABLE + &table_row(1, 4.0, 1.0) + &table_row(2, 9.0, 1.0);
    for grids in [1..=5, 3..=9] {
        for (mode, lambda) in [(1, 4.0), (2, 9.0)] {
            text += &(msc_page("") + &vector_heading(mode, lambda));
            grids.clone().for_each(|id| text += &grid_row(id, values(id)));
        }
    }
    // On the next page of the same mode numbers fall back.
    let r = parse(&text);
    let shapes: Vec<_> = r
        .eigenvectors
        .iter()
        .map(|v| (v.mode, v.block, v.rows.len()))
        .collect();
    assert_eq!(shapes, [(1, 0, 5), (2, 0, 5), (1, 1, 7), (2, 1, 7)]);
    assert!(errors(&r).is_empty(), "{:?}", r.diagnostics);
}

#[test]
fn restart_within_the_same_mode_begins_a_block_too() {
    let mut text = msc_page("") + TABLE + &table_row(1, 4.0, 1.0);
    for grids in [1..=3, 2..=4] {
        text += &(msc_page("") + &vector_heading(1, 4.0));
        grids.for_each(|id| text += &grid_row(id, values(id)));
    }
    let blocks: Vec<_> = parse(&text)
        .eigenvectors
        .iter()
        .map(|v| (v.block, v.rows.len()))
        .collect();
    assert_eq!(blocks, [(0, 3), (1, 3)]);
}

#[test]
fn scalar_points_are_six_on_a_line() {
    let mut text = msc_page("") + TABLE + &table_row(1, 4.0, 1.0) + &msc_page("") + &vector_heading(1, 4.0);
    text += &grid_row(7, values(7));
    text += &grid_row(101, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).replace("   G  ", "   S  ");
    text += "           107      S      7.000000E+00   0.0\n";
    let r = parse(&text);
    let rows = &r.eigenvectors[0].rows;
    assert_eq!(
        rows.iter().map(|row| row.id).collect::<Vec<_>>(),
        [7, 101, 102, 103, 104, 105, 106, 107, 108]
    );
    assert_eq!(
        rows.iter().skip(1).map(|row| row.values[0]).collect::<Vec<_>>(),
        [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.0]
    );
    assert!(
        rows.iter()
            .skip(1)
            .all(|row| row.kind == PointKind::Scalar && row.values[1].is_nan())
    );
}

#[test]
fn missing_rotations_are_known_as_missing() {
    let text = msc_page("")
        + TABLE
        + &table_row(1, 4.0, 1.0)
        + &msc_page("")
        + &vector_heading(1, 4.0)
        + "             1      G      1.000000E+00   2.000000E+00   3.000000E+00\n";
    let row = parse(&text).eigenvectors[0].rows[0];
    assert_eq!(row.translation().map(|t| t.z), Some(3.0));
    assert_eq!(row.rotation(), None);
}

/// The table is printed before and after residual vectors are added; the vectors belong to the second.
#[test]
fn table_after_augmentation_replaces_the_one_before() {
    let note = |when| {
        format!("                                          ({when} AUGMENTATION OF RESIDUAL VECTORS)\n")
    };
    let heading = TABLE.split_inclusive('\n').collect::<Vec<_>>();
    let table = |when| heading[0].to_owned() + &note(when) + heading[1] + heading[2];
    let text = msc_page("")
        + &table("BEFORE")
        + &table_row(1, 4.0, 1.0)
        + &msc_page("")
        + &table("AFTER")
        + &table_row(1, 4.0, 1.0)
        + &table_row(2, 900.0, 1.0);
    let r = parse(&text);
    assert_eq!(r.eigenvalues.len(), 1);
    assert_eq!(r.eigenvalues[0].modes.len(), 2);
}

#[test]
fn boxed_messages_stars_and_negative_eigenvalues() {
    let text = msc_page("")
        + TABLE
        + "\n *** USER WARNING MESSAGE 3307\n     *****************************\n     * 1 EIGENVALUE IS NEGATIVE  *\n     *****************************\n"
        + "        1         3       -1.939822E-14        1.392775E-07        2.216670E-08        1.000000E+00       -1.939822E-14\n"
        + "        2         1       -4.126273E-10*       2.031323E-05        3.232951E-06        1.000000E+00       -4.126273E-10\n"
        + "        3         2        0.0                 0.0                 0.0                 1.000000E+00        0.0\n";
    let r = parse(&text);
    let modes = &r.eigenvalues[0].modes;
    assert_eq!(
        modes.iter().map(|m| m.eigenvalue).collect::<Vec<_>>(),
        [-1.939_822e-14, -4.126_273e-10, 0.0]
    );
    assert_eq!(modes[0].extraction_order, 3);
    assert!(errors(&r).is_empty());
    assert!(
        r.diagnostics
            .iter()
            .any(|d| d.message.contains("DISPLACEMENT(PRINT) = ALL")),
        "{:?}",
        r.diagnostics
    );
}

#[test]
fn programs_are_told_by_their_page_headers() {
    let body = TABLE.to_owned() + &table_row(1, 4.0, 1.0);
    for (program, dialect) in [
        ("MSC.NASTRAN  4/ 3/07", Dialect::Msc),
        ("MSC/NASTRAN  9/ 1/97", Dialect::Msc),
        ("NX NASTRAN  8/11/12", Dialect::Nx),
        ("SIMCENTER NASTRAN  5/ 9/19", Dialect::Simcenter),
        (
            "/    95 SUN SOLARIS NASTRAN    / MAY 17, 95 /",
            Dialect::Nastran95,
        ),
        ("SOMETHING ELSE", Dialect::Unknown),
    ] {
        assert_eq!(parse(&(page(program, "") + &body)).dialect, dialect, "{program}");
    }
}

#[test]
fn results_without_vectors_or_weight_say_what_to_request() {
    let r = parse(&(msc_page("") + TABLE + &table_row(1, 4.0, 1.0)));
    let error = r.require_eigenvectors().unwrap_err().to_string();
    assert!(
        error.contains("wing.f06") && error.contains("DISPLACEMENT(PRINT) = ALL"),
        "{error}"
    );
    let error = r.require_weight().unwrap_err().to_string();
    assert!(error.contains("PARAM,GRDPNT,0"), "{error}");
}

fn refusal(text: &str) -> String {
    f06::parse(text.as_bytes(), "wing.f06").unwrap_err().to_string()
}

#[test]
fn other_solutions_are_refused_with_the_cure() {
    let complex = msc_page("")
        + "                                        C O M P L E X   E I G E N V A L U E   S U M M A R Y\n"
        + "0                ROOT     EXTRACTION                  EIGENVALUE                     FREQUENCY              DAMPING\n"
        + "                    1           1          -1.000000E-02      6.283185E+00        1.000000E+00         3.183099E-03\n"
        + &msc_page("")
        + "      COMPLEX EIGENVALUE = -1.000000E-02,  6.283185E+00\n"
        + "                                      C O M P L E X   E I G E N V E C T O R   NO.          1\n"
        + "0            1      G      1.000000E+00   2.000000E+00   3.000000E+00   1.000000E+00   2.000000E+00   3.000000E+00\n"
        + "                           1.000000E+00   2.000000E+00   3.000000E+00   1.000000E+00   2.000000E+00   3.000000E+00\n";
    let error = refusal(&complex);
    assert!(
        error.contains("complex eigenvalues only") && error.contains("SOL 103"),
        "{error}"
    );

    // Buckling prints no CYCLES.
    let buckling = msc_page("SUBCASE 2")
        + TABLE
        + &table_row(1, 4.0, 1.0)
        + &msc_page("SUBCASE 2")
        + "      EIGENVALUE =  4.000000E+00\n                                         R E A L   E I G E N V E C T O R   N O .          1\n \n"
        + &grid_row(1, values(1));
    let error = refusal(&buckling);
    assert!(
        error.contains("buckling load factors") && error.contains("SOL 103"),
        "{error}"
    );

    let fatal =
        msc_page("") + "0*** USER FATAL MESSAGE 316 (IFPDRV)\n     ILLEGAL DATA ON BULK DATA ENTRY GRID\n";
    let error = refusal(&fatal);
    assert!(error.contains("USER FATAL MESSAGE 316"), "{error}");

    let statics = msc_page("")
        + "                                             D I S P L A C E M E N T   V E C T O R\n"
        + &grid_row(1, values(1));
    let error = refusal(&statics);
    assert!(
        error.contains("no real eigenvalues") && error.contains("METHOD"),
        "{error}"
    );

    assert!(refusal("once upon a time\n").contains("no page or heading of Nastran"));
    assert!(refusal(" \n\n").contains("empty"));
    assert!(refusal("op2\0\0\0").contains("binary"));
}

#[test]
fn truncated_and_damaged_rows_are_errors_with_their_line() {
    let mut text = msc_page("") + TABLE + &table_row(1, 4.0, 1.0) + &table_row(2, 9.0, 1.0);
    for mode in [1, 2] {
        text += &(msc_page("") + &vector_heading(mode, f64::from((mode + 1) * (mode + 1))));
        (1..=4).for_each(|id| text += &grid_row(id, values(id)));
    }
    assert!(parse(&text).diagnostics.is_empty());

    // Cut within a number of the last row.
    let cut = &text[..text.len() - 6];
    let found = errors(&parse(cut));
    assert!(
        found
            .iter()
            .any(|e| e.contains("the row of point 4") && e.contains("truncated")),
        "{found:?}"
    );
    assert!(
        found
            .iter()
            .any(|e| e.contains("has 3 rows where others of the same output have 4")),
        "{found:?}"
    );
    assert!(found[0].contains("wing.f06:30: eigenvector 2"), "{found:?}");

    // Cut between modes: the table knows better.
    let one_mode = &text[..text.rfind("1    WING").unwrap()];
    let r = parse(one_mode);
    assert!(r.diagnostics.iter().any(|d| {
        d.message
            .contains("1 modes have a generalised mass but no printed vector (2)")
    }));

    // Overflow stars and a wrong letter.
    let stars = text.replacen(" 2.500000E-01", "*************", 1);
    assert!(errors(&parse(&stars)).iter().any(|e| e.contains("overflow mark")));
    let letter = text.replacen("2.500000E-01", "2.5O0000E-01", 1);
    assert!(errors(&parse(&letter)).iter().any(|e| e.contains("2.5O0000E-01")));
}

#[test]
fn mystran_systems_and_scalar_rows() {
    let text = " MYSTRAN Version 17.0.0\n                                            R E A L   E I G E N V A L U E S\n\
        \u{20}       1       1        2.332849E+02        1.527367E+01        2.430880E+00        1.000000E+00        2.332849E+02\n\n\
        \u{20}OUTPUT FOR EIGENVECTOR        1\n TITLE\n\n                                                         E I G E N V E C T O R\n\
        \u{20}          GRID     COORD      T1            T2            T3            R1            R2            R3\n\
        \u{20}                    SYS\n\
        \u{20}          1001        3 -2.718976E-19 -4.178813E-04  3.007306E-17  0.0          -1.252470E-15 -1.661829E-02\n\
        \u{20}           900       12  1.000000E+00  0.0           0.0           0.0           0.0           0.0\n\
        \u{20}                        ------------- ------------- ------------- ------------- ------------- -------------\n\
        \u{20}               MAX* :    6.957909E-03  4.502167E-03  1.456839E-03  4.351228E-05 -1.154566E-05 -1.826483E-04\n";
    let r = parse(text);
    assert_eq!(r.dialect, Dialect::Mystran);
    assert!(errors(&r).is_empty(), "{:?}", r.diagnostics);
    let rows = &r.eigenvectors[0].rows;
    // Points stand in the program's own order.
    assert_eq!(
        rows.iter().map(|row| (row.id, row.cd)).collect::<Vec<_>>(),
        [(1001, Some(3)), (900, Some(12))]
    );
    assert_eq!(rows[0].values[5], -1.661_829e-2);
}
