//! Fits against the reference's histories, and the paper's main claim put to the test.

use super::reference::{MANOEUVRES, OWN_VARIANTS, QUANTITIES};
use super::study::{AVL, CORRECTED, Study};
use super::tables::Named;
use crate::error::Error;
use albatross::report::{Cell, Column, Format, Table};

/// A column of fits in percent.
pub(crate) fn percent_column(name: &str) -> Column {
    Column::new(name, "%", Format::Fixed(1))
}

/// The fit tables.
pub(crate) fn all(study: &Study) -> Result<Vec<Named>, Error> {
    Ok(vec![
        Named::new("fits", fits(study)?),
        Named::new("claim", claim(study)?),
        Named::new("fits_reference_variants", beside_own_variants(study)?),
    ])
}

/// A row for each manoeuvre and variant, a column for each output.
fn fits(study: &Study) -> Result<Table, Error> {
    let mut heads = vec![Column::text("doublet"), Column::text("Albatross")];
    heads.extend(QUANTITIES.iter().map(|q| percent_column(q.name)));
    heads.push(percent_column("mean"));
    let mut table = Table::new("NRMSE fit against the reference's histories", heads).with_caption(
        "Eq. 13 of the paper: 100 (1 - |y - ŷ| / |y - mean y|), 100 is equality, 0 as good as the mean. Non-linear \
         simulation over the whole record (10, 5 and 5 s at 1 kHz), driven by the reference's own elevator signal. Inputs \
         and outputs are deviations, each from its own trim.",
    );
    for (index, (_, shown)) in MANOEUVRES.iter().enumerate() {
        for variant in &study.variants {
            let Some(flight) = variant.flights.get(index) else {
                continue;
            };
            let mut row = vec![Cell::from(*shown), Cell::from(variant.name)];
            row.extend(flight.fits.iter().map(|f| Cell::from(*f)));
            row.push((flight.fits.iter().sum::<f64>() / flight.fits.len() as f64).into());
            table.push(row)?;
        }
    }
    Ok(table)
}

/// One output of one manoeuvre: fit with AVL data and fit corrected.
#[derive(Debug, Clone, Copy)]
struct Tested {
    manoeuvre: &'static str,
    output: &'static str,
    avl: f64,
    corrected: f64,
}

fn tested(study: &Study) -> Result<Vec<Tested>, Error> {
    let (avl, corrected) = (study.variant(AVL)?, study.variant(CORRECTED)?);
    let mut all = Vec::new();
    for ((_, manoeuvre), (a, c)) in MANOEUVRES.iter().zip(avl.flights.iter().zip(&corrected.flights)) {
        for (quantity, (avl, corrected)) in QUANTITIES.iter().zip(a.fits.iter().zip(&c.fits)) {
            all.push(Tested {
                manoeuvre,
                output: quantity.name,
                avl: *avl,
                corrected: *corrected,
            });
        }
    }
    Ok(all)
}

/// The paper's main claim: the correction improves the agreement. A line for each output.
fn claim(study: &Study) -> Result<Table, Error> {
    let mut table = Table::new(
        "The main claim: the correction improves the agreement",
        [
            Column::text("doublet"),
            Column::text("output"),
            percent_column("fit, AVL only"),
            percent_column("fit, corrected"),
            Column::new("gain", "points", Format::Fixed(1)),
            Column::text("holds"),
        ],
    );
    for t in tested(study)? {
        table.push([
            Cell::from(t.manoeuvre),
            t.output.into(),
            t.avl.into(),
            t.corrected.into(),
            (t.corrected - t.avl).into(),
            if t.corrected > t.avl { "yes" } else { "no" }.into(),
        ])?;
    }
    Ok(table)
}

/// The outcome of the claim in a sentence.
pub(crate) fn verdict(study: &Study) -> Result<String, Error> {
    let all = tested(study)?;
    let gains = || all.iter().map(|t| t.corrected - t.avl);
    let held = gains().filter(|g| *g > 0.0).count();
    let (least, most) = gains().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), g| {
        (l.min(g), m.max(g))
    });
    Ok(format!(
        "The claim holds for {held} of {} outputs; the fit changes by {least:+.1} to {most:+.1} points.",
        all.len()
    ))
}

/// Least and largest fit over the outputs of one manoeuvre.
pub(crate) fn range(fits: &[f64]) -> [f64; 2] {
    fits.iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], f| {
            [low.min(*f), high.max(*f)]
        })
}

/// Ranges over the outputs, beside those of the reference's own reduced variants.
fn beside_own_variants(study: &Study) -> Result<Table, Error> {
    let mut table = Table::new(
        "Range of the fits beside the reference's own reduced variants",
        [
            Column::text("model"),
            percent_column("from").in_group("0.5 Hz"),
            percent_column("to").in_group("0.5 Hz"),
            percent_column("from").in_group("10 Hz"),
            percent_column("to").in_group("10 Hz"),
        ],
    )
    .with_caption(
        "The reference's rows are printed in its description: the same DLM model with one thing left out, over the same \
         outputs and the acceleration of the centre of gravity. They bound what a tool without the thing can reach.",
    );
    for (name, slow, quick) in OWN_VARIANTS {
        let row = [Cell::from(format!("reference, {name}"))];
        table.push(
            row.into_iter()
                .chain(slow.map(Cell::from))
                .chain(quick.map(Cell::from)),
        )?;
    }
    for variant in &study.variants {
        let of = |index: usize| {
            variant
                .flights
                .get(index)
                .map_or([f64::NAN; 2], |f| range(&f.fits))
        };
        let row = [Cell::from(format!("Albatross, {}", variant.name))];
        table.push(
            row.into_iter()
                .chain(of(0).map(Cell::from))
                .chain(of(2).map(Cell::from)),
        )?;
    }
    Ok(table)
}
