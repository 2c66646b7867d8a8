//! The page: what is compared with what, the tables and figures in order, and what they say.

use super::account::{self, Account};
use super::check::{
    END_OF_ITERATED, END_OF_MEASURED, FLOOR, FLOOR_ITERATED, ITERATED_BLOCK, Kind, MEASURED, RELATIVE,
    RELATIVE_ITERATED,
};
use super::figures::Figure;
use super::fits;
use super::identification::{Identification, search, text};
use super::reference::MANOEUVRES;
use super::solved::Solved;
use super::study::{AVL, CORRECTED, Study, VARIANTS, control_index};
use super::tables::{self, Named};
use crate::error::Error;
use albatross::report::{Cell, Column, Format, Page, Table};
use std::path::Path;

/// Files that the report is made from, with size and checksum.
pub(crate) fn inputs(root: &Path, study: &Study) -> Result<Table, Error> {
    let mut table = Table::new(
        "Inputs",
        [
            Column::text("file"),
            Column::text("what"),
            Column::new("size", "bytes", Format::Exact),
            Column::text("FNV-1a 64"),
        ],
    )
    .with_caption("The checksum tells whether a file has changed; it is no protection against intent.");
    let case = &study.inputs.case;
    let mut named = vec![
        ("f25-like/case.toml".to_owned(), "case file"),
        (in_case_folder(&case.structure.deck), "Nastran deck"),
        (in_case_folder(&case.structure.results), "SOL 103 results"),
        (in_case_folder(&case.aerodynamics.geometry), "AVL geometry"),
    ];
    if let Some((derivatives, strips)) = case.aerodynamics.files() {
        named.push((in_case_folder(derivatives), "AVL stability derivatives"));
        named.extend(
            strips
                .iter()
                .map(|s| (in_case_folder(&s.file), "AVL strip forces")),
        );
    }
    if let Some(corrections) = &case.corrections {
        named.extend(
            corrections
                .lift_slopes
                .iter()
                .map(|file| (in_case_folder(file), "corrected strip slopes")),
        );
        named.extend(
            corrections
                .derivatives
                .iter()
                .map(|file| (in_case_folder(file), "corrected derivatives")),
        );
    }
    for (name, _) in MANOEUVRES {
        named.push((
            in_case_folder(&format!("reference/{name}.csv")),
            "reference, time history",
        ));
    }
    named.push((
        in_case_folder("reference/eigenvalues.json"),
        "reference, trim and eigenvalues",
    ));
    named.push(("paper/paper_tables.json".into(), "the paper's printed tables"));
    named.push(("paper/paper_recomputed.json".into(), "the same recomputed"));
    for (file, what) in named {
        let path = root.join("fixtures").join(&file);
        let bytes = std::fs::read(&path).map_err(Error::file(&path))?;
        table.push([
            Cell::from(format!("fixtures/{file}")),
            what.into(),
            bytes.len().into(),
            format!("{:016x}", fnv1a(&bytes)).into(),
        ])?;
    }
    Ok(table)
}

fn in_case_folder(file: &str) -> String {
    format!("f25-like/{file}")
}

/// The 64-bit FNV-1a hash (Fowler, Noll & Vo).
pub(crate) fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// What the page is put together from.
struct Parts<'a> {
    page: Page,
    tables: &'a [Named],
    figures: &'a [Figure],
}

impl Parts<'_> {
    fn table(&mut self, stem: &str) -> Result<(), Error> {
        let named = self
            .tables
            .iter()
            .find(|t| t.stem == stem)
            .ok_or_else(|| missing(stem))?;
        let block = named.kind.map(|kind| match kind {
            Kind::Measured => (MEASURED, END_OF_MEASURED),
            Kind::Iterated => (ITERATED_BLOCK, END_OF_ITERATED),
        });
        if let Some((start, _)) = block {
            self.page.paragraph(start);
        }
        self.page.table(&named.table);
        self.page
            .paragraph(&format!("[CSV]({stem}.csv), [JSON]({stem}.json)"));
        if let Some((_, end)) = block {
            self.page.paragraph(end);
        }
        Ok(())
    }

    fn figure(&mut self, number: u32) -> Result<(), Error> {
        self.drawing(&format!("figure{number:02}_"))
    }

    /// The figure whose file begins so.
    fn drawing(&mut self, start: &str) -> Result<(), Error> {
        let figure = self
            .figures
            .iter()
            .find(|f| f.file.starts_with(start))
            .ok_or_else(|| missing(start))?;
        self.page
            .image(&figure.file, &figure.alternative, &figure.caption);
        Ok(())
    }
}

fn missing(what: &str) -> Error {
    Error::Mismatch {
        what: "parts of the page".into(),
        found: format!("no `{what}`"),
        expected: "a table or figure of that name".into(),
    }
}

/// The whole page.
pub(crate) fn write(
    study: &Study,
    account: &Account,
    identification: &Identification,
    solved: &Solved,
    tables: &[Named],
    figures: &[Figure],
) -> Result<String, Error> {
    let mut parts = Parts {
        page: Page::new(),
        tables,
        figures,
    };
    introduction(&mut parts, study)?;
    longitudinal(&mut parts)?;
    fitted(&mut parts, study)?;
    reasons(&mut parts, study, account)?;
    identified(&mut parts, study, identification)?;
    frequency_domain(&mut parts)?;
    modes(&mut parts, study)?;
    without_files(&mut parts, solved)?;
    cost(&mut parts)?;
    Ok(parts.page.finish())
}

fn introduction(parts: &mut Parts<'_>, study: &Study) -> Result<(), Error> {
    parts
        .page
        .heading(1, "Validation: the F25-like aircraft")
        .paragraph(
            "Written by `cargo xtask validate`. `cargo xtask validate --check` computes everything again and compares it \
             with the files here. Every table is also there as CSV and JSON, every figure is an SVG file.",
        )
        .heading(2, "What is compared with what")
        .bullets([
            "**The aircraft is an invented surrogate, not the DLR-F25**, whose model is not public. It has the published \
             global figures and, fitted, the published frequencies in vacuo. Its shapes, loads and results are its own.",
            "**The reference is not CFD.** Its time histories, trim and eigenvalues come from an independent simulation \
             of the same surrogate with the doublet lattice method (DLM), 50 modes and an unsteady elevator with hinge \
             rate. No shock, no viscosity, no fuselage; the aerodynamics is linear, and the strip slopes that it was scaled \
             to are synthetic. Agreement with it is easier than with CFD. Its description is in \
             [fixtures/f25-like/reference](../../fixtures/f25-like/reference/README.md).",
            "**The paper's columns are printed figures of another aircraft**, the DLR-F25, from CFD and from the ModSiG \
             model. They stand beside for orientation. Where a printed figure does not follow from the others, it is \
             recomputed and flagged.",
            "**Nothing is tuned** to the reference's histories, to its eigenvalues or to the paper.",
        ])
        .paragraph("Albatross runs in three variants of [the case file](../../fixtures/f25-like/case.toml):");
    let described: Vec<String> = VARIANTS
        .iter()
        .map(|(name, shown)| {
            let description = study
                .inputs
                .case
                .variant(Some(name))
                .map(|v| v.description)
                .unwrap_or_default();
            format!("**{shown}** (`{name}`): {description}")
        })
        .collect();
    parts.page.bullets(described.iter().map(String::as_str)).paragraph(
        "The correction takes the place of the paper's CFD data: the slopes of the rigid strips and the eight rigid \
         longitudinal derivatives of the reference's steady aerodynamics. (The paper takes its strip slopes from CFD of \
         the flexible aircraft and uses them for increments due to deformation, which counts the static relief twice.)",
    );
    parts.page.heading(2, "Inputs and versions");
    parts.table("inputs")?;
    parts.page.paragraph(&format!(
        "Albatross {}, Rust {} or later. Numbers agree between machines to rounding: `--check` allows {RELATIVE:.0e} of a \
         value and {FLOOR:.0e} in all, one unit of the last place on this page, {RELATIVE_ITERATED:.0e} and \
         {FLOOR_ITERATED:.0e} of what is identified, and leaves measured times out.",
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_RUST_VERSION"),
    ));
    parts.page.heading(2, "Strip lift and trim");
    parts.figure(4)?;
    parts.table("trim")
}

fn longitudinal(parts: &mut Parts<'_>) -> Result<(), Error> {
    parts.page.heading(2, "Peaks of the longitudinal motion");
    parts.table("table3_peaks")?;
    parts.figure(7)?;
    parts.table("table3_paper_differences")
}

fn fitted(parts: &mut Parts<'_>, study: &Study) -> Result<(), Error> {
    parts.page.heading(2, "Fits");
    parts.table("fits")?;
    parts.table("fits_reference_variants")?;
    parts.page.heading(2, "The main claim");
    parts.table("claim")?;
    let derivatives = |index: usize| -> Result<[f64; 2], Error> {
        let model = &study.variant(index)?.model;
        let elevator = control_index(&model.aircraft.controls, &model.point.control)?;
        let pitch = &model.aircraft.rigid.pitch;
        Ok([
            pitch.alpha,
            pitch.controls.get(elevator).copied().unwrap_or(f64::NAN),
        ])
    };
    let ([stiffness, power], [true_stiffness, true_power]) = (derivatives(AVL)?, derivatives(CORRECTED)?);
    parts.page.paragraph(&format!(
        "{} What AVL's data lack most is pitch stiffness, Cmα = {stiffness:.3} against {true_stiffness:.3} of the reference, \
         and they have too much elevator, Cmδ = {power:.3} against {true_power:.3}. The data of the correction are those of \
         the reference's own steady aerodynamics, so that this tests the method, not the quality of any CFD.",
        fits::verdict(study)?
    ));
    for number in [12, 13, 9, 10, 11] {
        parts.figure(number)?;
    }
    Ok(())
}

/// `a to b %` over the outputs of a manoeuvre.
fn span(account: &Account, name: &str, manoeuvre: usize) -> String {
    let fits = account
        .experiments
        .iter()
        .find(|e| e.name == name)
        .and_then(|e| e.fits.get(manoeuvre));
    let [low, high] = fits::range(fits.map_or(&[][..], Vec::as_slice));
    format!("{low:.0} to {high:.0} %")
}

/// Frequency and damping ratio of the short period of an experiment.
fn short_period(account: &Account, name: &str) -> String {
    let mode = account
        .experiments
        .iter()
        .find(|e| e.name == name)
        .and_then(|e| e.short_period.as_ref());
    mode.map_or_else(String::new, |m| {
        format!("{:.3} rad/s, ζ = {:.3}", m.omega_rad_s, m.damping_ratio)
    })
}

/// Largest change of a fit between two experiments, in points.
fn largest_change(account: &Account, from: &str, to: &str) -> f64 {
    let of = |name: &str| {
        account
            .experiments
            .iter()
            .find(|e| e.name == name)
            .map(|e| e.fits.concat())
    };
    let pairs = of(from)
        .unwrap_or_default()
        .into_iter()
        .zip(of(to).unwrap_or_default());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn reasons(parts: &mut Parts<'_>, study: &Study, account: &Account) -> Result<(), Error> {
    use account::{
        ALL_MODES, AS_IS, BETWEEN, BOTH, LAGGED_AS_IS, LAGGED_BETWEEN, LAGGED_BOTH, LAGGED_OWN_TAIL, LINEAR,
        OWN_TAIL, RATE, STATIC,
    };
    const SLOW: usize = 0;
    const QUICK: usize = 2;
    parts.page.heading(2, "Where Albatross lands, and why").paragraph(
        "The model is the paper's: quasi-steady derivatives for the rigid motion, strips with Wagner's lag for the elastic \
         motion, twenty modes. The experiments below give the linearised model what the reference's description says it \
         lacks, one thing after the other. None is used anywhere else; those of the tail's slopes and of lift between strips \
         are options of the case file.",
    );
    parts.table("account_experiments")?;
    parts.table("account_static_derivatives")?;
    parts.table("account_elevator_rate")?;
    let reference = study.reference.modes.short_period();
    let reference = reference.map_or_else(String::new, |m| {
        format!("{:.3} rad/s, ζ = {:.3}", m.omega_rad_s, m.zeta)
    });
    let damping = |mode: usize| -> Result<String, Error> {
        let own = study
            .ranked(&study.modes(CORRECTED)?[0])?
            .get(mode - 1)
            .copied()
            .flatten();
        let other = study.ranked_reference()?.get(mode - 1).copied().flatten();
        let [own, other] =
            [own.map(|m| m.damping_ratio), other.map(|m| m.zeta)].map(|z| z.unwrap_or(f64::NAN));
        Ok(format!("{own:.3} against {other:.3} in mode {mode}"))
    };
    let items = [
        format!(
            "**Size of the motion: no.** The linearised model fits as the non-linear one does (largest change {:.1} \
             points).",
            largest_change(account, AS_IS, LINEAR)
        ),
        format!(
            "**Unsteadiness of the rigid motion: the larger part at 0.5 Hz.** With the reference's `CLα̇` and `Cmα̇`, the \
             first term of what its wing's lag and the late downwash at its tail amount to, the corrected model goes from \
             {} to {}, and the short period from {} to {} (reference: {reference}). The paper's model has no such term \
             either.",
            span(account, AS_IS, SLOW),
            span(account, RATE, SLOW),
            short_period(account, AS_IS),
            short_period(account, RATE),
        ),
        format!(
            "**Static aeroelasticity: most of the rest at 0.5 Hz.** Strips with one slope each do not act on each other: when the wing washes \
             out, its downwash at the tail stays what it was, and the slopes of the tail's strips hold the wing's downwash \
             for the tail's own motion as well. With the reference's static derivatives alone the model reaches {}; with \
             both, {} and {}.",
            span(account, STATIC, SLOW),
            span(account, BOTH, SLOW),
            short_period(account, BOTH),
        ),
        format!(
            "**More modes: not those at hand.** All 24 elastic modes of the f06 change no fit by more than {:.2} points. \
             The reference has 50; its own variant with 20 loses 3 to 5 % at 0.5 Hz and 1 to 23 % at 10 Hz.",
            largest_change(account, AS_IS, ALL_MODES)
        ),
        format!(
            "**Tail slopes: a compromise.** Without the wing's downwash in the tail strips' slopes, fits at 0.5 Hz become \
             {} (short period {}) and, with lagged elevator, {} at 10 Hz. One half of the coupling between wing and tail is \
             not better than none throughout; the default stays the paper's.",
            span(account, OWN_TAIL, SLOW),
            short_period(account, OWN_TAIL),
            span(account, LAGGED_OWN_TAIL, QUICK),
        ),
        format!(
            "**Lift between strips: both halves of that coupling.** With the lattice's slopes between all strips \
             (`lift_slopes = \"lattice\"`, at once, without the delay of the wake) fits become {} at 0.5 Hz (short period {}) \
             and, with lagged elevator, {} at 10 Hz; the elastic modes come much nearer to the reference's \
             ([below](#without-files-of-other-programs)).",
            span(account, BETWEEN, SLOW),
            short_period(account, BETWEEN),
            span(account, LAGGED_BETWEEN, QUICK),
        ),
        format!(
            "**Elevator at 10 Hz.** The paper names the elevator's quasi-steady lift as a cause of too large peaks, and the \
             reference bears it out: lagged through the strips' Wagner states, the fits go from {} to {}. At 0.5 Hz they go \
             from {} to {}: Wagner's function is that of a wing of infinite span, and its lag at low frequency is too large \
             for a tail, as the table of rates shows; the hinge rate, which leads, is missing.",
            span(account, AS_IS, QUICK),
            span(account, LAGGED_AS_IS, QUICK),
            span(account, AS_IS, SLOW),
            span(account, LAGGED_AS_IS, SLOW),
        ),
        format!(
            "**What remains at 10 Hz** ({} with lagged elevator and both sets of derivatives) lies in the elastic modes: the \
             hinge rate (up to 17 % by the reference's own variant), modes beyond the twentieth, and damping by strips \
             instead of a lifting surface, {}, {} and {}.",
            span(account, LAGGED_BOTH, QUICK),
            damping(1)?,
            damping(4)?,
            damping(13)?,
        ),
    ];
    parts.page.bullets(items.iter().map(String::as_str));
    parts.page.paragraph(&format!(
        "So the corrected model lands at {} at 0.5 Hz and {} at 10 Hz, with lagged elevator at {} and {}. The reference's \
         own quasi-steady variant, which keeps the lifting surface and the fifty modes, reaches 86 to 90 % and 51 to 88 %.",
        span(account, AS_IS, SLOW),
        span(account, AS_IS, QUICK),
        span(account, LAGGED_AS_IS, SLOW),
        span(account, LAGGED_AS_IS, QUICK),
    ));
    Ok(())
}

/// Tables 4 and 5.
fn identified(parts: &mut Parts<'_>, study: &Study, identification: &Identification) -> Result<(), Error> {
    let [fits, truth, model] = text::outcome(study, identification)?;
    parts
        .page
        .heading(2, "Identification from the reference's histories")
        .paragraph(text::introduction())
        .paragraph("What came of it:")
        .bullets([fits.as_str(), truth.as_str(), model.as_str()])
        .paragraph("What it cannot tell:")
        .bullets(text::limits().iter().map(String::as_str));
    parts.table("table4_fits_of_identified")?;
    parts.table("table4_search")?;
    parts.page.image(
        &format!("{}/{}", search::DIRECTORY, search::DRAWING),
        "Mean fit on the three histories against the number of poles, trained on each history alone and on all",
        "**Search of the orders.** Mean fit on the three histories against the number of poles, one zero less. \
         All candidates are in [search/candidates.csv](search/candidates.csv).",
    );
    parts.table("table5_poles")?;
    let claims = &study.paper.recomputed.table5_claims;
    parts.page.paragraph(&format!(
        "The paper concludes that the difference of the modes' frequencies is very often smaller than 3.5 % and never \
         greater than 6 %. Its own table of {} rows has {} of {} elastic ones below 3.5 %, at most {:.2} %, and with the short period \
         {} rows above 6 %, at most {:.2} %.",
        claims.n_rows,
        claims.n_flex_below_3p5,
        claims.n_flexible,
        claims.max_flexible_printed,
        claims.n_all_above_6,
        claims.max_all_printed
    ));
    for stem in ["table5_matching", "table5_all_poles", "table5_unmatched"] {
        parts.table(stem)?;
    }
    Ok(())
}

/// Figure 8, and what it shows in numbers.
fn frequency_domain(parts: &mut Parts<'_>) -> Result<(), Error> {
    parts.page.heading(2, "Frequency domain");
    parts.figure(8)?;
    parts.drawing("figure08b_")?;
    for stem in ["bode_distance", "bode_peak_counts", "bode_peaks"] {
        parts.table(stem)?;
    }
    Ok(())
}

fn modes(parts: &mut Parts<'_>, study: &Study) -> Result<(), Error> {
    parts.page.heading(2, "Modes");
    for stem in [
        "table7_structural_modes",
        "table8_aeroelastic_modes",
        "table8_mean_differences",
    ] {
        parts.table(stem)?;
    }
    let differences: Vec<String> = tables::mean_differences(study)?
        .iter()
        .map(|(name, d)| {
            format!(
                "{name}: {:.2} % against the paper (worst {:+.1} %, mode {}; {:.2} % in order of frequency alone), {:.2} % \
                 against the reference (worst {:+.1} %, mode {})",
                d.paper.mean,
                d.paper.worst,
                d.paper.mode,
                d.paper_by_frequency.mean,
                d.reference.mean,
                d.reference.worst,
                d.reference.mode
            )
        })
        .collect();
    parts
        .page
        .paragraph("Mean absolute differences of the twenty frequencies:")
        .bullets(differences.iter().map(String::as_str));
    parts.table("rigid_body_modes")
}

/// The case from deck and geometry alone.
fn without_files(parts: &mut Parts<'_>, solved: &Solved) -> Result<(), Error> {
    let Solved {
        worst,
        means,
        damping_means,
        ..
    } = solved;
    parts
        .page
        .heading(2, "Without files of other programs")
        .paragraph(
            "The same case with `results = \"solve\"` for the structure and for the aerodynamics: Albatross' finite elements \
             take the deck, its vortex lattice takes the geometry.",
        );
    parts.table("solved_quantities")?;
    parts.table("solved_structural_modes")?;
    parts.table("solved_aeroelastic_modes")?;
    parts.table("solved_fits")?;
    parts.page.bullets([
        format!(
            "**The deck's modes**: all twenty frequencies within {:.1e} of MYSTRAN's and {:.1e} of NASTRAN-95's, shapes with \
             MAC above {:.7}.",
            worst.mystran,
            worst.nastran95,
            1.0 - worst.mac.max(1e-7)
        ),
        format!(
            "**The flight**: trimmed incidence within {:.0e} deg, short period within {:.4} %, modes in the flow within \
             {:.4} % of those from files.",
            worst.alpha_deg, worst.short_period_percent, worst.in_flow_percent
        ),
        format!(
            "**Lift between strips**: frequencies in the flow differ from the reference's by {:.2} % on average with one \
             slope a strip, by {:.2} % with lift between strips; damping ratios by {:.4} and {:.4}. The reference is a \
             doublet lattice, whose strips act on each other too, so that this tests the strips, not lattices.",
            means[0], means[1], damping_means[0], damping_means[1]
        ),
    ]
    .iter()
    .map(String::as_str));
    Ok(())
}

fn cost(parts: &mut Parts<'_>) -> Result<(), Error> {
    parts.page.heading(2, "Cost");
    parts.table("table6_cost")?;
    parts.table("table6_measured")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors of the authors' specification (draft-eastlake-fnv, appendix C).
    #[test]
    fn val_fnv1a() {
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }
}
