//! Frequency responses of the linearised models against the identified ones: distance and peaks.

use super::Identification;
use crate::error::Error;
use crate::validate::study::{Study, Variant};
use crate::validate::tables::{Named, percent};
use albatross::analysis;
use albatross::numerics::C64;
use albatross::report::{Cell, Column, Format, Table};
use albatross::sysid::{
    Band, BodeDistance, ResponsePeak, bode_distance, match_response_peaks, response_peaks,
};

/// Lower end of the narrower band \[rad/s\]: below it no record holds a quarter of a period.
const SEEN: f64 = 0.5;
/// Least prominence of a peak \[dB\].
const PROMINENCE: f64 = 1.0;
/// Peaks further apart than this share of their frequency are not the same.
const GATE: f64 = 0.15;

/// Magnitude and phase of all over the paper's band.
struct Responses {
    grid: Vec<f64>,
    /// By output: identified at the searched order and at the paper's.
    identified: Vec<[Vec<C64>; 2]>,
    /// By output and variant.
    models: Vec<Vec<Vec<C64>>>,
}

impl Responses {
    fn of(study: &Study, identification: &Identification) -> Result<Self, Error> {
        let grid = Band::default().grid()?;
        let of_variant = |variant: &Variant| {
            let response =
                analysis::frequency_response(&variant.trimmed, &variant.model.point.control, &grid)?;
            identification
                .outputs
                .iter()
                .map(|o| {
                    let channel = response.get(o.target.shown()?.sensor, &variant.model.point.control)?;
                    Ok(channel.values)
                })
                .collect::<Result<Vec<Vec<C64>>, Error>>()
        };
        let variants = study
            .variants
            .iter()
            .map(of_variant)
            .collect::<Result<Vec<_>, Error>>()?;
        let by_output = |o: usize| {
            variants
                .iter()
                .map(|v| v.get(o).cloned().unwrap_or_default())
                .collect()
        };
        Ok(Self {
            identified: identification
                .outputs
                .iter()
                .map(|o| Ok([o.searched.response(&grid)?, o.paper.response(&grid)?]))
                .collect::<Result<_, Error>>()?,
            models: (0..identification.outputs.len()).map(by_output).collect(),
            grid,
        })
    }
}

/// The tables of distances and peaks.
pub(super) fn all(study: &Study, identification: &Identification) -> Result<Vec<Named>, Error> {
    let responses = Responses::of(study, identification)?;
    Ok(vec![
        Named::iterated("bode_distance", distances(study, identification, &responses)?),
        Named::iterated("bode_peaks", peaks(study, identification, &responses)?),
        Named::iterated("bode_peak_counts", counts(study, identification, &responses)?),
    ])
}

/// Root mean squares of the differences in dB and degrees.
fn distances(study: &Study, identification: &Identification, responses: &Responses) -> Result<Table, Error> {
    let band = Band::default();
    let groups = [
        format!("{} to {} rad/s", band.low_rad_s, band.high_rad_s),
        format!("{SEEN} to {} rad/s", band.high_rad_s),
    ];
    let mut heads = vec![Column::text("output"), Column::text("model")];
    for group in &groups {
        heads.extend([
            Column::new("rms magnitude", "dB", Format::Fixed(2)).in_group(group),
            Column::new("mean magnitude", "dB", Format::Fixed(2)).in_group(group),
            Column::new("rms phase", "deg", Format::Fixed(1)).in_group(group),
        ]);
    }
    let mut table = Table::new("Bode distance from the identified transfer functions", heads).with_caption(format!(
        "Against the transfer function identified at the searched order, over {} frequencies with equal steps of their \
         logarithm; a positive mean says that the model lies above. Below {SEEN} rad/s the longest record (10 s) holds \
         less than a period: what is identified there is extrapolated, and the wider band, the paper's, counts it. The rows \
         of the paper's order tell how far the identification agrees with itself.",
        band.points
    ));
    let weights: Vec<f64> = responses
        .grid
        .iter()
        .map(|w| if *w < SEEN { 0.0 } else { 1.0 })
        .collect();
    for (output, (identified, models)) in identification
        .outputs
        .iter()
        .zip(responses.identified.iter().zip(&responses.models))
    {
        let [searched, at_paper] = identified;
        let named = study
            .variants
            .iter()
            .map(|v| format!("Albatross, {}", v.name))
            .zip(models);
        for (name, response) in named.chain([("identified at the paper's order".to_owned(), at_paper)]) {
            let whole = bode_distance(response, searched, None)?;
            let seen = bode_distance(response, searched, Some(&weights))?;
            let mut row = vec![Cell::from(output.target.name()), name.into()];
            let cells =
                |d: BodeDistance| [d.rms_magnitude_db, d.mean_magnitude_db, d.rms_phase_deg].map(Cell::from);
            row.extend(cells(whole));
            row.extend(cells(seen));
            table.push(row)?;
        }
    }
    Ok(table)
}

fn peaks_of(responses: &Responses, response: &[C64]) -> Result<Vec<ResponsePeak>, Error> {
    Ok(response_peaks(&responses.grid, response, PROMINENCE)?)
}

/// Every peak of the identified responses and the models' peaks that belong to it.
fn peaks(study: &Study, identification: &Identification, responses: &Responses) -> Result<Table, Error> {
    let number =
        |name: &str, unit: &str, group: &str| Column::new(name, unit, Format::Fixed(2)).in_group(group);
    const IDENTIFIED: &str = "identified, searched order";
    let mut heads = vec![
        Column::text("output"),
        number("ω", "rad/s", IDENTIFIED),
        number("height", "dB", IDENTIFIED),
    ];
    for variant in &study.variants {
        let group = format!("Albatross, {}", variant.name);
        heads.push(number("difference of ω", "%", &group));
        heads.push(number("difference of height", "dB", &group));
    }
    let mut table = Table::new("Peaks of the frequency responses", heads).with_caption(format!(
        "Peaks of the magnitude that rise by at least {PROMINENCE} dB above their surroundings, 0.1 to 95 rad/s, matched \
         within {:.0} % of their frequency as poles are. A dash: the model has no such peak.",
        100.0 * GATE
    ));
    for (output, (identified, models)) in identification
        .outputs
        .iter()
        .zip(responses.identified.iter().zip(&responses.models))
    {
        let base = peaks_of(responses, &identified[0])?;
        let matchings = models
            .iter()
            .map(|m| Ok(match_response_peaks(&peaks_of(responses, m)?, &base, GATE)))
            .collect::<Result<Vec<_>, Error>>()?;
        for peak in &base {
            let mut row = vec![
                Cell::from(output.target.name()),
                peak.omega_rad_s.into(),
                peak.magnitude_db.into(),
            ];
            for matching in &matchings {
                let pair = matching.pairs.iter().find(|p| p.reference == *peak);
                row.push(
                    pair.map(|p| percent(p.response.omega_rad_s, p.reference.omega_rad_s))
                        .into(),
                );
                row.push(pair.map(|p| p.height_difference_db).into());
            }
            table.push(row)?;
        }
    }
    Ok(table)
}

/// Numbers of peaks, of pairs, and of what is left over.
fn counts(study: &Study, identification: &Identification, responses: &Responses) -> Result<Table, Error> {
    let count = |name: &str| Column::new(name, "", Format::Fixed(0));
    let mut table = Table::new(
        "Peaks of the frequency responses, counted",
        [
            Column::text("output"),
            Column::text("model"),
            count("identified").in_group("peaks"),
            count("model").in_group("peaks"),
            count("pairs").in_group("peaks"),
            Column::new("difference of ω", "%", Format::Fixed(2)).in_group("mean over pairs, without sign"),
            Column::new("difference of height", "dB", Format::Fixed(2))
                .in_group("mean over pairs, without sign"),
        ],
    );
    for (output, (identified, models)) in identification
        .outputs
        .iter()
        .zip(responses.identified.iter().zip(&responses.models))
    {
        let base = peaks_of(responses, &identified[0])?;
        for (variant, response) in study.variants.iter().zip(models) {
            let own = peaks_of(responses, response)?;
            let pairs = match_response_peaks(&own, &base, GATE).pairs;
            let mean = |of: &dyn Fn(usize) -> f64| {
                (!pairs.is_empty()).then(|| (0..pairs.len()).map(of).sum::<f64>() / pairs.len() as f64)
            };
            table.push([
                Cell::from(output.target.name()),
                format!("Albatross, {}", variant.name).into(),
                base.len().into(),
                own.len().into(),
                pairs.len().into(),
                mean(&|i| pairs.get(i).map_or(f64::NAN, |p| p.relative_percent)).into(),
                mean(&|i| pairs.get(i).map_or(f64::NAN, |p| p.height_difference_db.abs())).into(),
            ])?;
        }
    }
    Ok(table)
}
