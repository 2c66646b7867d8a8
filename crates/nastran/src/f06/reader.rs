//! The pass over the lines of a results file.

use std::collections::HashMap;

use crate::deck::Id;
use crate::error::{Error, Severity};
use crate::lines::Lines;
use crate::number;
use crate::remarks::Remarks;
use crate::results::{
    Dialect, EigenvalueTable, Eigenvector, EigenvectorRow, ModalResults, PointKind, RealMode,
};

use super::check;
use super::row::{self, Layout, printed_value};
use super::weight::WeightReader;

/// What the current lines belong to.
#[derive(Debug)]
enum Context {
    Outside,
    Table,
    Vector(Layout),
    Weight(Box<WeightReader>),
}

/// Values printed above a vector.
#[derive(Debug, Default, Clone, Copy)]
struct Header {
    mode: Option<u32>,
    eigenvalue: Option<f64>,
    frequency_hz: Option<f64>,
}

/// Signs of what kind of file and run this is, for the error when modes are missing.
#[derive(Debug, Default)]
pub(super) struct Evidence {
    /// Complex eigenvalue or eigenvector tables.
    pub(super) complex: bool,
    /// A buckling solution: eigenvalues are load factors.
    pub(super) buckling: bool,
    /// First fatal message.
    pub(super) fatal: Option<String>,
    /// Page headers, banners or letter-spaced headings.
    pub(super) printed: bool,
    /// BEGIN BULK or GRID at the start of a line.
    pub(super) deck: bool,
}

pub(super) struct Reader<'a> {
    source: &'a str,
    context: Context,
    subcase: Option<u32>,
    header: Header,
    /// The heading of the table or vector was just read and has no row yet.
    fresh: bool,
    /// A note on residual vectors stood at the last table.
    augmented: bool,
    line: u32,
    lines_on_page: u32,
    /// Vectors already begun for (subcase, mode).
    blocks: HashMap<(Option<u32>, u32), u32>,
    results: ModalResults,
    remarks: Remarks,
    evidence: Evidence,
    squeezed: Vec<u8>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a str) -> Self {
        Self {
            source,
            context: Context::Outside,
            subcase: None,
            header: Header::default(),
            fresh: false,
            augmented: false,
            line: 0,
            lines_on_page: 0,
            blocks: HashMap::new(),
            results: ModalResults {
                source: source.to_owned(),
                dialect: Dialect::Unknown,
                eigenvalues: Vec::new(),
                eigenvectors: Vec::new(),
                weights: Vec::new(),
                diagnostics: Vec::new(),
            },
            remarks: Remarks::default(),
            evidence: Evidence::default(),
            squeezed: Vec::with_capacity(160),
        }
    }

    pub(super) fn read(mut self, text: &[u8]) -> Result<ModalResults, Error> {
        check::is_text(text, self.source)?;
        let mut lines = Lines::new(text);
        while let Some(line) = lines.next() {
            self.line = lines.number();
            self.take(line);
        }
        self.end_weight();
        if !lines.last_was_ended() && matches!(self.context, Context::Vector(_) | Context::Table) {
            self.remark(
                Severity::Warning,
                "",
                "the file ends within a table and without a line end; it may be truncated",
            );
        }
        if let Some(fatal) = self.evidence.fatal.clone() {
            self.remark(Severity::Warning, "", format!("the run reports {fatal:?}"));
        }
        check::anything(&self.results, &self.evidence)?;
        check::complete(&self.results, &mut self.remarks);
        self.results.diagnostics = self.remarks.finish(self.source);
        Ok(self.results)
    }

    fn remark(&mut self, severity: Severity, card: impl Into<String>, message: impl Into<String>) {
        self.remarks.push(severity, self.source, self.line, card, message);
    }

    fn take(&mut self, line: &[u8]) {
        if let Context::Vector(layout) = self.context {
            match row::parse(line, layout) {
                row::Line::Row(row) => return self.vector_row(row, layout),
                row::Line::Scalars { first, values, count } => {
                    return self.scalar_points(first, &values, count);
                }
                row::Line::Malformed(problem) => {
                    let id = String::from_utf8_lossy(line.get(..15).unwrap_or_default())
                        .trim()
                        .to_owned();
                    let mode = self.header.mode.unwrap_or(0);
                    return self.remark(
                        Severity::Error,
                        format!("eigenvector {mode}"),
                        format!("the row of point {id} {problem}"),
                    );
                }
                row::Line::Other => {}
            }
        }
        if line.first() == Some(&b'1') && line.get(1).is_none_or(|b| b.is_ascii_whitespace()) {
            return self.new_page(line);
        }
        if !line.iter().all(|b| *b == b' ') {
            self.lines_on_page = self.lines_on_page.saturating_add(1);
            self.other(line);
        }
    }

    fn new_page(&mut self, line: &[u8]) {
        self.end_weight();
        self.context = Context::Outside;
        self.subcase = None;
        self.header = Header::default();
        self.lines_on_page = 0;
        self.evidence.printed = true;
        if self.results.dialect == Dialect::Unknown {
            // The program's name stands to the right of the title.
            self.results.dialect = dialect_of(line.get(60..).unwrap_or_default());
        }
    }

    /// A line that is no vector row and no page start.
    fn other(&mut self, line: &[u8]) {
        // A 0 in column 1 is carriage control.
        let text = if line.starts_with(b"0") {
            line.get(1..).unwrap_or_default()
        } else {
            line
        };
        let mut squeezed = std::mem::take(&mut self.squeezed);
        squeezed.clear();
        squeezed.extend(text.iter().filter(|b| !b.is_ascii_whitespace()));
        self.squeezed_line(line, &squeezed);
        self.squeezed = squeezed;
    }

    fn squeezed_line(&mut self, line: &[u8], squeezed: &[u8]) {
        if self.heading(line, squeezed) {
            return;
        }
        match &mut self.context {
            Context::Weight(reader) => {
                if let Err(problem) = reader.take(line, squeezed) {
                    self.remark(Severity::Error, "grid point weight", problem);
                }
            }
            Context::Table => self.table_line(line, squeezed),
            Context::Vector(Layout::Mystran) if squeezed.starts_with(b"---") => {
                self.context = Context::Outside
            }
            _ => self.notice(line, squeezed),
        }
    }

    /// Recognises headings; true if the line is one.
    fn heading(&mut self, line: &[u8], squeezed: &[u8]) -> bool {
        if contains(squeezed, b"EIGEN") {
            return self.eigen_heading(squeezed);
        }
        if contains(squeezed, b"WEIGHTGENERATOR") && contains(squeezed, b"OUTPUTFROM") {
            self.end_weight();
            self.evidence.printed = true;
            if contains(squeezed, b"OVERALLMODEL") {
                self.results.dialect = Dialect::Mystran;
            }
            self.context = Context::Weight(Box::new(WeightReader::new(self.line)));
            return true;
        }
        let label = if self.lines_on_page <= 4 {
            subcase_label(line)
        } else {
            None
        };
        if label.is_some() {
            self.subcase = label;
        }
        label.is_some()
    }

    fn eigen_heading(&mut self, squeezed: &[u8]) -> bool {
        if contains(squeezed, b"COMPLEXEIGENV") {
            self.end_weight();
            self.evidence.complex = true;
            self.evidence.printed = true;
            self.context = Context::Outside;
            return true;
        }
        if let Some(values) = squeezed.strip_prefix(b"EIGENVALUE=") {
            let (value, frequency) = split_at(values, b"(CYCLICFREQUENCY=");
            self.header.eigenvalue = number::real(value);
            self.header.frequency_hz = frequency.and_then(|f| number::real(split_at(f, b"HZ").0));
            return true;
        }
        if let (before, Some(mode)) = split_at(squeezed, b"EIGENVECTORNO.") {
            return self.typed_vector_heading(before, mode);
        }
        if let Some(mode) = squeezed.strip_prefix(b"OUTPUTFOREIGENVECTOR") {
            self.end_weight();
            self.results.dialect = Dialect::Mystran;
            self.header = Header {
                mode: unsigned(mode),
                ..Header::default()
            };
            self.context = Context::Outside;
            return true;
        }
        if squeezed == b"EIGENVECTOR" && self.header.mode.is_some() {
            self.context = Context::Vector(Layout::Mystran);
            self.fresh = true;
            return true;
        }
        if squeezed.starts_with(b"REALEIGENVALUES") {
            self.end_weight();
            self.evidence.printed = true;
            self.context = Context::Table;
            self.fresh = true;
            self.augmented |= contains(squeezed, b"AUGMENTATION");
            return true;
        }
        false
    }

    fn typed_vector_heading(&mut self, before: &[u8], mode: &[u8]) -> bool {
        self.end_weight();
        self.evidence.printed = true;
        let Some(mode) = unsigned(mode) else {
            self.context = Context::Outside;
            self.remark(
                Severity::Error,
                "eigenvector",
                "the heading has no mode number; the file may be damaged",
            );
            return true;
        };
        if let Some(cycles) = before.strip_prefix(b"CYCLES=") {
            self.header.frequency_hz = number::real(split_at(cycles, b"REAL").0);
        } else if self.header.eigenvalue.is_some() && self.header.frequency_hz.is_none() {
            // Only buckling prints an eigenvalue without a frequency.
            self.evidence.buckling = true;
        }
        self.header.mode = Some(mode);
        self.context = Context::Vector(Layout::Typed);
        self.fresh = true;
        true
    }

    fn end_weight(&mut self) {
        if !matches!(self.context, Context::Weight(_)) {
            return;
        }
        if let Context::Weight(reader) = std::mem::replace(&mut self.context, Context::Outside) {
            match reader.finish() {
                Ok(weight) => self.results.weights.push(weight),
                Err(rows) => self.remark(
                    Severity::Error,
                    "grid point weight",
                    format!(
                        "the rigid-body mass matrix has {rows} rows in place of 6; the file may be truncated"
                    ),
                ),
            }
        }
    }

    /// A line between headings that may tell something about the run.
    fn notice(&mut self, line: &[u8], squeezed: &[u8]) {
        if self.results.dialect == Dialect::Unknown && contains(squeezed, b"MYSTRANVersion") {
            self.results.dialect = Dialect::Mystran;
            self.evidence.printed = true;
        }
        if squeezed.starts_with(b"SOL105") || squeezed.starts_with(b"SOLSEBUCKL") {
            self.evidence.buckling = true;
        }
        if line.starts_with(b"BEGIN BULK") || line.starts_with(b"GRID") {
            self.evidence.deck = true;
        }
        let fatal = contains(squeezed, b"FATALMESSAGE") || squeezed.starts_with(b"*ERROR");
        if fatal && self.evidence.fatal.is_none() {
            self.evidence.fatal = Some(String::from_utf8_lossy(line).trim().to_owned());
        }
    }

    fn table_line(&mut self, line: &[u8], squeezed: &[u8]) {
        if contains(squeezed, b"AUGMENTATIONOFRESIDUALVECTORS") {
            self.augmented = true;
            return;
        }
        match table_row(line) {
            Some(Ok(mode)) => self.table_row(mode),
            Some(Err(problem)) => self.remark(Severity::Error, "eigenvalue table", problem),
            None => self.notice(line, squeezed),
        }
    }

    /// The table goes over pages with its heading repeated. A fall-back of the mode number begins another table,
    /// which replaces the last if it is the one with residual vectors.
    fn table_row(&mut self, row: RealMode) {
        let tables = &mut self.results.eigenvalues;
        if self.fresh {
            self.fresh = false;
            let same_subcase = tables.last().is_some_and(|t| t.subcase == self.subcase);
            let goes_on = same_subcase
                && tables
                    .last()
                    .and_then(|t| t.modes.last())
                    .is_some_and(|m| m.mode < row.mode);
            if !goes_on {
                if same_subcase && self.augmented {
                    tables.pop();
                }
                tables.push(EigenvalueTable {
                    subcase: self.subcase,
                    modes: Vec::new(),
                    line: self.line,
                });
            }
        }
        if let Some(table) = tables.last_mut() {
            table.modes.push(row);
        }
    }

    /// The vector to which a row of point `id` belongs.
    fn vector_for(&mut self, id: Id, layout: Layout) -> Option<&mut Eigenvector> {
        let mode = self.header.mode?;
        let vectors = &mut self.results.eigenvectors;
        let last = vectors
            .last()
            .filter(|v| v.mode == mode && v.subcase == self.subcase);
        // Pages repeat the heading; MYSTRAN has no pages, and prints points in its own order.
        let goes_on = match layout {
            Layout::Typed => last.and_then(|v| v.rows.last()).is_some_and(|r| r.id < id),
            Layout::Mystran => !self.fresh && last.is_some(),
        };
        self.fresh = false;
        if !goes_on {
            let seen = self.blocks.entry((self.subcase, mode)).or_insert(0);
            let block = *seen;
            *seen += 1;
            let size = vectors.last().map_or(0, |v| v.rows.len());
            vectors.push(Eigenvector {
                subcase: self.subcase,
                block,
                mode,
                eigenvalue: self.header.eigenvalue,
                frequency_hz: self.header.frequency_hz,
                rows: Vec::with_capacity(size),
                line: self.line,
            });
        }
        vectors.last_mut()
    }

    fn vector_row(&mut self, row: EigenvectorRow, layout: Layout) {
        if let Some(vector) = self.vector_for(row.id, layout) {
            vector.rows.push(row);
        }
    }

    /// One line holds up to six scalar points with consecutive numbers.
    fn scalar_points(&mut self, first: Id, values: &[f64; 6], count: u32) {
        let Some(vector) = self.vector_for(first, Layout::Typed) else {
            return;
        };
        for (id, &value) in (first..)
            .zip(values.iter().filter(|v| !v.is_nan()))
            .take(count as usize)
        {
            let mut values = [f64::NAN; 6];
            values[0] = value;
            vector.rows.push(EigenvectorRow {
                id,
                kind: PointKind::Scalar,
                cd: None,
                values,
            });
        }
    }
}

/// A row of the eigenvalue table: two integers and five values. `None` if the line is something else. Columns are 20
/// wide and values 13, so white space separates them; a star after a value marks a negative eigenvalue.
fn table_row(line: &[u8]) -> Option<Result<RealMode, String>> {
    let mut tokens = line.split(u8::is_ascii_whitespace).filter(|t| !t.is_empty());
    let mode = unsigned(tokens.next()?)?;
    let extraction_order = unsigned(tokens.next()?)?;
    let mut values = [0.0; 5];
    let mut found = 0;
    for (value, token) in values.iter_mut().zip(&mut tokens) {
        match printed_value(token.strip_suffix(b"*").unwrap_or(token)) {
            Ok(Some(v)) => *value = v,
            Ok(None) => break,
            Err(problem) => return Some(Err(format!("mode {mode} {problem}"))),
        }
        found += 1;
    }
    if found < 5 || tokens.next().is_some() {
        return Some(Err(format!(
            "mode {mode} has {found} values where 5 are expected (eigenvalue, radians, cycles, generalised mass and \
             stiffness); the file may be truncated"
        )));
    }
    let [
        eigenvalue,
        omega_rad_s,
        frequency_hz,
        generalized_mass,
        generalized_stiffness,
    ] = values;
    Some(Ok(RealMode {
        mode,
        extraction_order,
        eigenvalue,
        omega_rad_s,
        frequency_hz,
        generalized_mass,
        generalized_stiffness,
    }))
}

/// `SUBCASE n` at the right end of a page header line.
fn subcase_label(line: &[u8]) -> Option<u32> {
    let label = line.get(60..)?.trim_ascii();
    let digits = label.iter().rev().take_while(|b| b.is_ascii_digit()).count();
    let (words, subcase) = label.split_at_checked(label.len().checked_sub(digits)?)?;
    words
        .trim_ascii_end()
        .ends_with(b"SUBCASE")
        .then(|| unsigned(subcase))?
}

fn dialect_of(header: &[u8]) -> Dialect {
    if contains(header, b"SIMCENTER NASTRAN") {
        Dialect::Simcenter
    } else if contains(header, b"NX NASTRAN") {
        Dialect::Nx
    } else if contains(header, b"MSC.NASTRAN")
        || contains(header, b"MSC/NASTRAN")
        || contains(header, b"MSC NASTRAN")
    {
        Dialect::Msc
    } else if contains(header, b"/") && contains(header, b"NASTRAN    /") {
        Dialect::Nastran95
    } else {
        Dialect::Unknown
    }
}

fn unsigned(text: &[u8]) -> Option<u32> {
    number::integer(text).and_then(|n| u32::try_from(n).ok())
}

fn contains(text: &[u8], part: &[u8]) -> bool {
    text.windows(part.len()).any(|w| w == part)
}

/// The text before `mark`, and the text after it if it is there.
fn split_at<'t>(text: &'t [u8], mark: &[u8]) -> (&'t [u8], Option<&'t [u8]>) {
    match text.windows(mark.len()).position(|w| w == mark) {
        Some(at) => (text.get(..at).unwrap_or_default(), text.get(at + mark.len()..)),
        None => (text, None),
    }
}
