//! Typed access to the fields of a card. A field that cannot be read is remarked upon once, with what was found and
//! what was expected, and the card is dropped by whoever built it.

use crate::deck::{Components, Id, ScalarEnd};
use crate::error::Severity;
use crate::number;
use crate::remarks::Remarks;

use super::card::Card;

pub(super) struct Fields<'a> {
    pub(super) card: &'a Card,
    file: &'a str,
    remarks: &'a mut Remarks,
    /// How many members ranges may still have in this deck.
    pub(super) ranges_left: &'a mut usize,
    /// A field could not be read.
    pub(super) failed: bool,
}

impl<'a> Fields<'a> {
    pub(super) fn new(
        card: &'a Card,
        file: &'a str,
        remarks: &'a mut Remarks,
        ranges_left: &'a mut usize,
    ) -> Self {
        Self {
            card,
            file,
            remarks,
            ranges_left,
            failed: false,
        }
    }

    pub(super) fn text(&self, n: usize) -> &'a [u8] {
        self.card.field(n)
    }

    pub(super) fn is_blank(&self, n: usize) -> bool {
        self.text(n).is_empty()
    }

    /// Upper-case text of a field.
    pub(super) fn word(&self, n: usize) -> String {
        String::from_utf8_lossy(self.text(n)).to_uppercase()
    }

    pub(super) fn word_or(&self, n: usize, default: &str) -> String {
        if self.is_blank(n) {
            default.to_owned()
        } else {
            self.word(n)
        }
    }

    /// Card name and number for remarks.
    fn title(&self) -> String {
        let name = String::from_utf8_lossy(self.card.name());
        match number::integer(self.text(1)) {
            Some(id) => format!("{name} {id}"),
            None => name.into_owned(),
        }
    }

    pub(super) fn remark(&mut self, severity: Severity, message: impl Into<String>) {
        self.failed |= severity == Severity::Error;
        let title = self.title();
        self.remarks
            .push(severity, self.file, self.card.line, title, message);
    }

    #[cold]
    pub(super) fn wrong(&mut self, n: usize, what: &str, expected: &str) {
        let found = String::from_utf8_lossy(self.text(n)).into_owned();
        let found = if found.is_empty() {
            "is blank".to_owned()
        } else {
            format!("is {found:?}")
        };
        self.remark(
            Severity::Error,
            format!("field {} ({what}) {found}; expected {expected}", n + 1),
        );
    }

    fn positive(&mut self, n: usize, what: &str) -> Id {
        let id = number::integer(self.text(n))
            .and_then(|i| Id::try_from(i).ok())
            .filter(|&i| i > 0);
        id.unwrap_or_else(|| {
            self.wrong(n, what, "a positive integer");
            0
        })
    }

    /// A required number above 0.
    pub(super) fn id(&mut self, n: usize, what: &str) -> Id {
        self.positive(n, what)
    }

    /// A number above 0, or blank.
    pub(super) fn optional_id(&mut self, n: usize, what: &str) -> Option<Id> {
        if self.is_blank(n) {
            None
        } else {
            Some(self.positive(n, what))
        }
    }

    /// A number that may be 0 or blank: coordinate system, superelement, ground.
    pub(super) fn id_or_zero(&mut self, n: usize, what: &str) -> Option<Id> {
        if self.is_blank(n) {
            return None;
        }
        let id = number::integer(self.text(n)).and_then(|i| Id::try_from(i).ok());
        if id.is_none() {
            self.wrong(n, what, "an integer of 0 or more");
        }
        id
    }

    pub(super) fn integer(&mut self, n: usize, what: &str) -> Option<i32> {
        if self.is_blank(n) {
            return None;
        }
        let value = number::integer(self.text(n)).and_then(|i| i32::try_from(i).ok());
        if value.is_none() {
            self.wrong(n, what, "an integer");
        }
        value
    }

    /// A real, or blank. An integer is taken for a real, with a warning: solvers refuse it.
    pub(super) fn real(&mut self, n: usize, what: &str) -> Option<f64> {
        let text = self.text(n);
        if text.is_empty() {
            return None;
        }
        let value = number::real(text);
        match value {
            None => self.wrong(n, what, "a real number such as 1.5, 1.5E-3 or 1.5-3"),
            // No point and no exponent: an integer.
            Some(_)
                if text
                    .iter()
                    .all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-')) =>
            {
                self.integer_as_real(n, what)
            }
            Some(_) => {}
        }
        value
    }

    #[cold]
    fn integer_as_real(&mut self, n: usize, what: &str) {
        if number::integer(self.text(n)).is_some() {
            let shown = String::from_utf8_lossy(self.text(n)).into_owned();
            self.remark(
                Severity::Warning,
                format!(
                    "field {} ({what}) is the integer {shown}; read as the real {shown}., which solvers require",
                    n + 1
                ),
            );
        }
    }

    pub(super) fn real_or(&mut self, n: usize, what: &str, default: f64) -> f64 {
        self.real(n, what).unwrap_or(default)
    }

    /// A real that may not be blank.
    pub(super) fn required_real(&mut self, n: usize, what: &str) -> f64 {
        if self.is_blank(n) {
            self.wrong(n, what, "a real number such as 1.5, 1.5E-3 or 1.5-3");
        }
        self.real_or(n, what, 0.0)
    }

    /// Three consecutive reals, blanks 0.
    pub(super) fn vector(&mut self, n: usize, what: &str) -> [f64; 3] {
        [0, 1, 2].map(|k| self.real_or(n + k, what, 0.0))
    }

    pub(super) fn components(&mut self, n: usize, what: &str) -> Components {
        Components::parse(self.text(n)).unwrap_or_else(|| {
            self.wrong(n, what, "components as digits 1 to 6, such as 123456");
            Components::NONE
        })
    }

    /// One component 0 to 6, blank 0.
    pub(super) fn component(&mut self, n: usize, what: &str) -> u8 {
        match self.text(n) {
            b"" => 0,
            [digit @ b'0'..=b'6'] => digit - b'0',
            _ => {
                self.wrong(n, what, "one component, 0 to 6");
                0
            }
        }
    }

    /// Point and component of a scalar element's end.
    pub(super) fn scalar_end(&mut self, n: usize) -> ScalarEnd {
        ScalarEnd {
            point: self.id_or_zero(n, "G").unwrap_or(0),
            component: self.component(n + 1, "C"),
        }
    }

    /// Remarks on data after the last field of the card's layout.
    pub(super) fn ends_at(&mut self, n: usize) {
        if self.card.len() > n && self.card.last() > n {
            let extra = String::from_utf8_lossy(self.text(self.card.last())).into_owned();
            self.remark(
                Severity::Warning,
                format!("has {extra:?} after the last field that the card has; it is not read"),
            );
        }
    }
}
