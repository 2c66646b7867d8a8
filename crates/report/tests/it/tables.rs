//! Tables: a form like the paper's, and renderings that cannot be broken by what is in the cells.

use albatross_report::{Cell, Column, Format, Page, Table};
use proptest::prelude::*;

/// The layout of the paper's Table 3: one row per model, peaks in groups of three quantities.
fn peaks() -> Table {
    let number =
        |name: &str, unit: &str, group: &str| Column::new(name, unit, Format::Fixed(2)).in_group(group);
    let mut columns = vec![Column::text("model"), number("α", "deg", "0 s")];
    for group in ["first peak", "second peak"] {
        columns.extend([
            number("n_z", "", group),
            number("q", "deg/s", group),
            number("α", "deg", group),
        ]);
    }
    let mut table = Table::new("Longitudinal motion", columns).with_caption("Peaks after a 0.5 Hz doublet.");
    let row = |name: &str, values: [f64; 7]| -> Vec<Cell> {
        std::iter::once(Cell::from(name))
            .chain(values.map(Cell::from))
            .collect()
    };
    table
        .push(row("CFD", [1.32, 0.73, -1.51, 0.38, 1.24, 2.23, 2.25]))
        .unwrap();
    let mut printed = row("printed difference", [0.02, 0.02, 0.17, 0.04, 0.03, 0.21, 0.1]);
    printed[4] = Cell::from(0.04).flagged("relative difference printed as 12.67 %");
    table.push(printed).unwrap();
    table
}

#[test]
fn golden_terminal_table_in_the_form_of_the_paper() {
    let expected = "\
Longitudinal motion
                    0 s   ──── first peak ─────  ── second peak ──
model                  α   n_z      q         α   n_z      q     α
                     deg        deg/s       deg        deg/s   deg
──────────────────────────────────────────────────────────────────
CFD                 1.32  0.73  -1.51  0.38      1.24   2.23  2.25
printed difference  0.02  0.02   0.17  0.04 (a)  0.03   0.21  0.10
Peaks after a 0.5 Hz doublet.
(a) relative difference printed as 12.67 %
";
    assert_eq!(peaks().to_text(), expected);
}

#[test]
fn repeated_names_stay_apart_in_every_rendering() {
    let table = peaks();
    assert_eq!(
        table.to_csv().lines().next().unwrap(),
        "model,0 s: α [deg],first peak: n_z,first peak: q [deg/s],first peak: α [deg],second peak: n_z,\
         second peak: q [deg/s],second peak: α [deg],notes"
    );
    let json = table.to_json();
    assert_eq!(json["rows"][0]["second peak: α"], 2.25);
    assert_eq!(json["columns"][4]["group"], "first peak");
    assert_eq!(json["notes"][0]["row"], 1);
}

#[test]
fn a_page_holds_the_table_as_it_is() {
    let mut page = Page::new();
    page.heading(1, "Validation").table(&peaks());
    let page = page.finish();
    assert!(page.starts_with("# Validation\n\n**Longitudinal motion**\n\n| model "));
    assert!(page.ends_with("\n- (a) relative difference printed as 12.67 %\n"));
}

/// Reads comma-separated values by the grammar of RFC 4180, section 2.
fn parse_csv(text: &str) -> Vec<Vec<String>> {
    let mut records = vec![vec![String::new()]];
    let mut quoted = false;
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        let record = records.last_mut().unwrap();
        let field = record.last_mut().unwrap();
        match c {
            '"' if quoted && characters.peek() == Some(&'"') => field.push(characters.next().unwrap()),
            '"' => quoted = !quoted,
            ',' if !quoted => record.push(String::new()),
            '\n' if !quoted => records.push(vec![String::new()]),
            c => field.push(c),
        }
    }
    records.pop();
    records
}

proptest! {
    #[test]
    fn prop_csv_reads_back_to_the_same_values(
        rows in proptest::collection::vec(("[a-c,\"\n\r é|]{0,8}", proptest::num::f64::NORMAL, any::<i64>()), 0..8),
    ) {
        let mut table = Table::new("T", [Column::text("a,\"b"), Column::new("x", "m", Format::Fixed(1)), Column::text("n")]);
        for (text, x, n) in &rows {
            table.push([text.as_str().into(), (*x).into(), (*n).into()]).unwrap();
        }
        let records = parse_csv(&table.to_csv());
        prop_assert_eq!(&records[0], &vec!["a,\"b".to_owned(), "x [m]".to_owned(), "n".to_owned()]);
        prop_assert_eq!(records.len(), rows.len() + 1);
        for (record, (text, x, n)) in records[1..].iter().zip(&rows) {
            prop_assert_eq!(&record[0], text);
            prop_assert_eq!(record[1].parse::<f64>().unwrap(), *x);
            prop_assert_eq!(record[2].parse::<i64>().unwrap(), *n);
        }
    }

    #[test]
    fn prop_every_markdown_row_has_one_cell_per_column(
        cells in proptest::collection::vec("\\PC{0,12}", 6), x in proptest::num::f64::ANY, note in "\\PC{0,12}",
    ) {
        let mut table = Table::new("T", [Column::text(&*cells[0]), Column::new(&*cells[1], &*cells[2], Format::Significant(3))]);
        table.push([cells[3].as_str().into(), Cell::from(x).flagged(&*note)]).unwrap();
        table.push([cells[4].as_str().into(), Cell::missing(&*cells[5])]).unwrap();
        let markdown = table.to_markdown();
        let rows: Vec<&str> = markdown.lines().filter(|line| line.starts_with('|')).collect();
        prop_assert_eq!(rows.len(), 4);
        for row in rows {
            let bare = row.replace("\\\\", "").replace("\\|", "");
            prop_assert_eq!(bare.matches('|').count(), 3, "{}", row);
        }
        let json = table.to_json().to_string();
        prop_assert!(serde_json::from_str::<serde_json::Value>(&json).is_ok());
        prop_assert!(!table.to_text().is_empty());
    }
}
