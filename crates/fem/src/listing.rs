//! A listing of modes in the layout of a Nastran results file, which the reader of this project takes.

use albatross_nastran::deck::Id;
use albatross_nastran::{Eigenvector, GridPointWeight, ModalResults, PointKind};
use nalgebra::Matrix3;
use std::fmt::Write;

/// Rows of an eigenvector on a page.
const ROWS_PER_PAGE: usize = 50;

/// Text of eigenvalue tables, eigenvectors and grid point weight: seven digits, 50 rows to a page. `title` stands at
/// the top of each page.
#[must_use]
pub fn listing(results: &ModalResults, title: &str) -> String {
    let mut pages = Pages {
        text: String::new(),
        title: title.chars().filter(|c| !c.is_control()).take(60).collect(),
        count: 0,
    };
    for weight in &results.weights {
        pages.weight(weight);
    }
    for table in &results.eigenvalues {
        pages.table(table);
    }
    for vector in &results.eigenvectors {
        pages.vector(vector);
    }
    pages.text
}

struct Pages {
    text: String,
    title: String,
    count: u32,
}

impl Pages {
    fn line(&mut self, line: &str) {
        self.text.push_str(line.trim_end());
        self.text.push('\n');
    }

    fn page(&mut self, subcase: Option<u32>) {
        self.count += 1;
        let head = format!("1    {:<90} ALBATROSS      PAGE {:>6}", self.title, self.count);
        self.line(&head);
        self.line("");
        let label = subcase.map_or_else(String::new, |n| format!("0{:>98} {n}", "SUBCASE"));
        self.line(&label);
        self.line("");
    }

    fn table(&mut self, table: &albatross_nastran::EigenvalueTable) {
        for modes in table.modes.chunks(ROWS_PER_PAGE) {
            self.page(table.subcase);
            self.line(&format!("{:46}R E A L   E I G E N V A L U E S", ""));
            self.line(
                "   MODE    EXTRACTION      EIGENVALUE            RADIANS             CYCLES            GENERALIZED         \
                 GENERALIZED",
            );
            self.line(
                "    NO.       ORDER                                                                       MASS              \
                 STIFFNESS",
            );
            for m in modes {
                let mut row = format!("{:>9}{:>10}", m.mode, m.extraction_order);
                for value in [
                    m.eigenvalue,
                    m.omega_rad_s,
                    m.frequency_hz,
                    m.generalized_mass,
                    m.generalized_stiffness,
                ] {
                    let _ = write!(row, "{:>20}", number(value));
                }
                self.line(&row);
            }
        }
    }

    fn vector(&mut self, vector: &Eigenvector) {
        for rows in vector.rows.chunks(ROWS_PER_PAGE) {
            self.page(vector.subcase);
            if let Some(eigenvalue) = vector.eigenvalue {
                self.line(&format!("      EIGENVALUE = {:>14}", number(eigenvalue)));
            }
            let cycles = number(vector.frequency_hz.unwrap_or(0.0));
            self.line(&format!(
                "          CYCLES = {cycles:>14}         R E A L   E I G E N V E C T O R   N O . {:>10}",
                vector.mode
            ));
            self.line("");
            self.line(
                "      POINT ID.   TYPE          T1             T2             T3             R1             R2             R3",
            );
            for row in rows {
                let letter = match row.kind {
                    PointKind::Grid => 'G',
                    PointKind::Scalar => 'S',
                    PointKind::Other(c) => c,
                };
                let mut line = format!("{:>14}      {letter}     ", row.id);
                for value in row.values {
                    let shown = if value.is_nan() {
                        String::new()
                    } else {
                        number(value)
                    };
                    let _ = write!(line, "{shown:>15}");
                }
                self.line(&line);
            }
        }
    }

    fn weight(&mut self, w: &GridPointWeight) {
        self.page(None);
        self.line(&format!(
            "{:27}O U T P U T   F R O M   G R I D   P O I N T   W E I G H T   G E N E R A T O R",
            ""
        ));
        self.line(&format!("0{:53}REFERENCE POINT = {:>8}", "", w.reference_point));
        self.line(&format!("{:61}M O", ""));
        for row in &w.mo {
            self.bordered(17, row);
        }
        self.line(&format!("{:62}S", ""));
        for row in w.s.iter().flatten() {
            self.bordered(38, row);
        }
        self.line(&format!("{:31}DIRECTION", ""));
        self.line(&format!(
            "{:26}MASS AXIS SYSTEM (S)     MASS              X-C.G.        Y-C.G.        Z-C.G.",
            ""
        ));
        if let (Some(masses), Some(rows)) = (w.masses, w.cg_rows) {
            for ((axis, mass), [x, y, z]) in ["X", "Y", "Z"].iter().zip(masses).zip(rows) {
                self.line(&format!(
                    "{:36}{axis}{:>20}{:>16}{:>14}{:>14}",
                    "",
                    number(mass),
                    number(x),
                    number(y),
                    number(z)
                ));
            }
        }
        self.line(&format!("{:60}I(S)", ""));
        for row in w.inertia_s.iter().flatten() {
            self.bordered(38, row);
        }
        self.line(&format!("{:60}I(Q)", ""));
        for value in w.principal_inertia.iter().flatten() {
            self.bordered(38, &[*value]);
        }
    }

    fn bordered(&mut self, indent: usize, values: &[f64]) {
        let mut line = format!("{:indent$}*", "");
        for v in values {
            let _ = write!(line, " {:>13}", number(*v));
        }
        line.push_str(" *");
        self.line(&line);
    }
}

/// `-1.234567E-02`; zero is `0.0`.
fn number(value: f64) -> String {
    if value == 0.0 {
        return "0.0".into();
    }
    let text = format!("{value:.6e}");
    let Some((mantissa, exponent)) = text.split_once('e') else {
        return text;
    };
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    format!("{mantissa}E{sign}{digits:0>2}")
}

/// The weight generator's block from its 6x6 matrix. The axes S are the basic axes: masses of a complete model are
/// equal in all directions.
pub(crate) fn weight(reference_point: Id, mo: [[f64; 6]; 6]) -> GridPointWeight {
    let masses: [f64; 3] = std::array::from_fn(|i| mo[i][i]);
    let over = |value: f64, mass: f64| if mass == 0.0 { 0.0 } else { value / mass };
    let [mx, my, mz] = masses;
    let cg_rows = [
        [over(mo[0][3], mx), over(-mo[0][5], mx), over(mo[0][4], mx)],
        [over(mo[1][5], my), over(mo[1][4], my), over(-mo[1][3], my)],
        [over(-mo[2][4], mz), over(mo[2][3], mz), over(mo[2][5], mz)],
    ];
    let mut block = GridPointWeight {
        reference_point,
        mo,
        masses: Some(masses),
        cg_rows: Some(cg_rows),
        s: Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        inertia_s: None,
        principal_inertia: None,
        line: 0,
    };
    let inertia = block.inertia_about_cg();
    // Nastran prints products as +int(x y dm), the tensor has them negative.
    let printed = |i: usize, j: usize| if i == j { inertia[(i, j)] } else { -inertia[(i, j)] };
    block.inertia_s = Some(std::array::from_fn(|i| std::array::from_fn(|j| printed(i, j))));
    let symmetric = (inertia + inertia.transpose()) * 0.5;
    block.principal_inertia = principal(symmetric);
    block
}

fn principal(inertia: Matrix3<f64>) -> Option<[f64; 3]> {
    if !inertia.iter().all(|v| v.is_finite()) {
        return None;
    }
    let mut values: [f64; 3] = inertia.symmetric_eigenvalues().into();
    values.sort_by(f64::total_cmp);
    Some(values)
}
