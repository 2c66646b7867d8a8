//! Findings about a case.

use crate::args::CheckOptions;
use crate::excerpt;
use crate::output::{Failure, Style, print, print_json};
use albatross::check::{Finding, Report, Severity};
use serde_json::json;
use std::fmt::Write as _;

pub(crate) fn check(options: &CheckOptions) -> Result<(), Failure> {
    let report = albatross::check::check(&options.case);
    if options.json {
        print_json(&json!({
            "case": options.case,
            "errors": report.count(Severity::Error),
            "warnings": report.count(Severity::Warning),
            "notes": report.count(Severity::Note),
            "facts": report.facts,
            "findings": report.findings,
        }))?;
    } else {
        print(&text(options, &report, Style::of(&std::io::stdout())))?;
    }
    let refused = if options.strict {
        Severity::Warning
    } else {
        Severity::Error
    };
    if report.worst() >= Some(refused) {
        return Err(Failure::Found);
    }
    Ok(())
}

fn text(options: &CheckOptions, report: &Report, style: Style) -> String {
    let mut text = String::new();
    if !options.quiet {
        for fact in &report.facts {
            text.push_str(fact);
            text.push('\n');
        }
        if !report.facts.is_empty() && !report.findings.is_empty() {
            text.push('\n');
        }
    }
    let shown = report.findings.iter();
    for finding in shown.filter(|f| !options.quiet || f.severity > Severity::Note) {
        text.push_str(&one(finding, style));
    }
    let count = |severity, one: &str| match report.count(severity) {
        1 => format!("1 {one}"),
        n => format!("{n} {one}s"),
    };
    if !options.quiet {
        let _ = write!(
            text,
            "\n{}, {}, {}: ",
            count(Severity::Error, "error"),
            count(Severity::Warning, "warning"),
            count(Severity::Note, "note"),
        );
        text.push_str(match report.worst() {
            Some(Severity::Error) => "the case cannot be used as it is",
            Some(Severity::Warning) => "the case runs; look at the warnings",
            _ => "the case runs",
        });
        text.push('\n');
    }
    text
}

fn one(finding: &Finding, style: Style) -> String {
    let colour = match finding.severity {
        Severity::Error => 31,
        Severity::Warning => 33,
        Severity::Note => 36,
    };
    let label = style.paint(colour, &finding.severity.to_string());
    let mut text = format!("{label}: {}: {}\n", finding.place, finding.what);
    if style.terminal
        && finding.severity > Severity::Note
        && let Some(excerpt) = excerpt::of_place(&finding.place, &finding.what, style.colour)
    {
        text.push_str(&excerpt);
        text.push('\n');
    }
    if !finding.cure.is_empty() {
        let _ = writeln!(text, "    cure: {}", finding.cure);
    }
    text
}
