//! Collects diagnostics, bounded so that a damaged file of millions of lines does not fill memory with remarks.

use crate::error::{Diagnostic, Severity};

/// Remarks kept of each severity; the rest are counted.
const KEPT: usize = 500;

#[derive(Debug, Default)]
pub(crate) struct Remarks {
    list: Vec<Diagnostic>,
    counts: [usize; 3],
}

impl Remarks {
    pub(crate) fn push(
        &mut self,
        severity: Severity,
        file: &str,
        line: u32,
        card: impl Into<String>,
        message: impl Into<String>,
    ) {
        let count = self.count(severity);
        *count += 1;
        if *count <= KEPT {
            self.list.push(Diagnostic {
                severity,
                file: file.to_owned(),
                line,
                card: card.into(),
                message: message.into(),
            });
        }
    }

    fn count(&mut self, severity: Severity) -> &mut usize {
        let [notes, warnings, errors] = &mut self.counts;
        match severity {
            Severity::Note => notes,
            Severity::Warning => warnings,
            Severity::Error => errors,
        }
    }

    /// All remarks, with one more for each severity that had too many.
    pub(crate) fn finish(mut self, file: &str) -> Vec<Diagnostic> {
        for severity in [Severity::Note, Severity::Warning, Severity::Error] {
            let more = self.count(severity).saturating_sub(KEPT);
            if more > 0 {
                self.list.push(Diagnostic {
                    severity,
                    file: file.to_owned(),
                    line: 0,
                    card: String::new(),
                    message: format!("{more} further remarks of severity {severity} are not listed"),
                });
            }
        }
        self.list
    }
}
