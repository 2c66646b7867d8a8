//! `compare`: a model against another one, and against records.

use super::args::{CompareOptions, InitialChoice};
use super::system::{SeenPole, System, conversion, names};
use super::{figures, json, records, tables};
use crate::gathered::Gathered;
use crate::output::{Failure, print, print_json, remark};
use albatross::lti::Signal;
use albatross::numerics::C64;
use albatross::report::plot::{Axis, BodeChannel, BodeCurve, BodePlot, Marker, ScatterPlot, Series, Style};
use albatross::report::{Cell, Column, Format, ReportError, Table};
use albatross::sysid::estimate::InitialCondition;
use albatross::sysid::response_peaks::ResponsePeakMatching;
use albatross::sysid::{
    Band, BodeDistance, DataSet, MatchOptions, PoleMatching, Simulated, bode_distance, match_poles,
    match_response_peaks, response_peaks,
};
use serde_json::{Map, Value, json};

/// Of the response at its own frequency, a mode of a state space must make this much to count.
const LEAST_SHARE: f64 = 1e-3;
/// Pairs with more damping are lags, or motions that do not oscillate.
const MOST_DAMPING: f64 = 0.7;

pub(crate) fn compare(options: &CompareOptions) -> Result<(), Failure> {
    if options.reference.is_none() && options.files.is_empty() {
        return Err(Failure::Other(
            "nothing to compare with: give records, or another model with --reference".into(),
        ));
    }
    let model = System::read(&options.model)?;
    let input = model.input_name(options.input.as_deref())?;
    let outputs: Vec<String> = if options.output.is_empty() {
        model.outputs().iter().map(|s| s.name.clone()).collect()
    } else {
        options.output.clone()
    };
    let model = model.select(&input, &outputs)?;
    let with_records = if options.files.is_empty() {
        None
    } else {
        Some(OnRecords::new(options, &model, &input, &outputs)?)
    };
    let with_reference = match &options.reference {
        Some(file) => {
            let reference = System::read(file)?;
            let nyquist = with_records.as_ref().map(|r| std::f64::consts::PI / r.data.dt());
            Some(WithReference::new(
                options,
                &model,
                &reference,
                (&input, &outputs),
                nyquist,
            )?)
        }
        None => None,
    };
    if !options.result.quiet {
        for note in with_reference.iter().flat_map(|r| &r.notes) {
            remark(&format!("note: {note}"));
        }
    }
    let value = result(options, &model, with_reference.as_ref(), with_records.as_ref())?;
    if let Some(out) = &options.result.out {
        let files = Gathered::beside(out)?;
        files.add_json("compare.json", &value)?;
        if let Some(found) = &with_reference {
            found.write(&files, &model)?;
        }
        if let Some(found) = &with_records {
            let table = tables::scores(&found.data.outputs, &found.simulated)?;
            files.add("fits.csv", &table.to_csv())?;
            let title = format!("Records and {}", model.name);
            files.add("fit.svg", &figures::fits(&title, &found.data, &found.simulated)?)?;
        }
        files.move_to(out)?;
    }
    if options.result.json {
        return print_json(&value);
    }
    let mut parts = Vec::new();
    if let Some(found) = &with_reference {
        parts.extend(found.text()?);
    }
    if let Some(found) = &with_records {
        parts.push(tables::scores(&found.data.outputs, &found.simulated)?.to_text());
    }
    print(&parts.join("\n"))
}

/// A model simulated on records.
struct OnRecords {
    /// In the units of the model.
    data: DataSet,
    simulated: Vec<Simulated>,
}

impl OnRecords {
    fn new(
        options: &CompareOptions,
        model: &System,
        input: &str,
        outputs: &[String],
    ) -> Result<Self, Failure> {
        let quiet = options.result.quiet;
        let records = records::read_files(&options.files, input, outputs, &options.sampling, quiet)?;
        let data = in_units_of(records.data, model)?;
        let estimated = match options.initial {
            Some(InitialChoice::Estimate) => true,
            Some(_) => false,
            None => model.initial == Some(InitialCondition::Estimate),
        };
        Ok(Self {
            simulated: model.simulate(&data, estimated)?,
            data,
        })
    }
}

/// The records in the units of the model.
pub(crate) fn in_units_of(mut data: DataSet, model: &System) -> Result<DataSet, Failure> {
    let factor = |from: &Signal, to: &Signal| {
        conversion(from, to).ok_or_else(|| {
            Failure::Other(format!(
                "{} has the unit {} in the records and {} in {}: convert the records",
                from.name, from.unit, to.unit, model.name
            ))
        })
    };
    for signal in model.inputs() {
        let by = factor(&data.input, signal)?;
        for experiment in &mut data.experiments {
            experiment.input.iter_mut().for_each(|v| *v *= by);
        }
        data.input = signal.clone();
    }
    for (o, signal) in model.outputs().iter().enumerate() {
        let Some(of_data) = data.outputs.get_mut(o) else {
            continue;
        };
        let by = factor(of_data, signal)?;
        *of_data = signal.clone();
        for experiment in &mut data.experiments {
            for output in experiment.outputs.iter_mut().skip(o).take(1) {
                output.iter_mut().for_each(|v| *v *= by);
            }
        }
    }
    Ok(data)
}

/// How many poles were left out of the comparison, and why.
#[derive(Debug, Clone, Copy, Default, serde::Serialize)]
struct LeftOut {
    /// On the real axis.
    real: usize,
    /// Damped more than an oscillation.
    overdamped: usize,
    /// Slower or faster than the band.
    out_of_band: usize,
    /// Not seen in the outputs, or not driven by the input.
    unseen: usize,
}

/// Sorts out what cannot be compared.
fn comparable(poles: Vec<SeenPole>, band: &Band, all: bool) -> (Vec<C64>, LeftOut) {
    let mut left_out = LeftOut::default();
    let kept = poles
        .into_iter()
        .filter(|p| {
            let modulus = p.value.norm();
            let count = if all {
                None
            } else if p.value.im == 0.0 {
                Some(&mut left_out.real)
            } else if !(band.low_rad_s..=band.high_rad_s).contains(&modulus) {
                Some(&mut left_out.out_of_band)
            } else if -p.value.re > MOST_DAMPING * modulus {
                Some(&mut left_out.overdamped)
            } else if p.share < LEAST_SHARE {
                Some(&mut left_out.unseen)
            } else {
                None
            };
            match count {
                Some(count) => {
                    *count += 1;
                    false
                }
                None => true,
            }
        })
        .map(|p| p.value)
        .collect();
    (kept, left_out)
}

/// A model beside a reference.
struct WithReference {
    name: String,
    band: Band,
    outputs: Vec<Signal>,
    input: Signal,
    matching: PoleMatching,
    left_out: [LeftOut; 2],
    omega: Vec<f64>,
    /// By output, in the units of the reference: model, reference.
    responses: Vec<(Vec<C64>, Vec<C64>)>,
    distances: Vec<BodeDistance>,
    peaks: Vec<ResponsePeakMatching>,
    notes: Vec<String>,
}

impl WithReference {
    fn new(
        options: &CompareOptions,
        model: &System,
        reference: &System,
        (input, outputs): (&str, &[String]),
        nyquist: Option<f64>,
    ) -> Result<Self, Failure> {
        let input = options.reference_input.as_deref().unwrap_or(input);
        let outputs = if options.reference_output.is_empty() {
            outputs
        } else {
            &options.reference_output
        };
        if outputs.len() != model.outputs().len() {
            return Err(Failure::Other(format!(
                "--reference-output names {} outputs, the model has {} ({}): give as many",
                outputs.len(),
                model.outputs().len(),
                names(model.outputs())
            )));
        }
        let reference = reference.select(input, outputs)?;
        let [low, high] = options.band;
        let band = Band {
            low_rad_s: low,
            high_rad_s: nyquist.map_or(high, |n| high.min(n)),
            ..Band::default()
        };
        let omega = band.grid()?;
        let mut notes = Vec::new();
        let mut factor = |from: &Signal, to: &Signal| {
            conversion(from, to).unwrap_or_else(|| {
                notes.push(format!(
                    "{} has the unit {}, its reference {} has {}: compared as they are",
                    from.name, from.unit, to.name, to.unit
                ));
                1.0
            })
        };
        let (from, to) = (model.inputs(), reference.inputs());
        let per_input = match (from.first(), to.first()) {
            (Some(from), Some(to)) => factor(from, to),
            _ => 1.0,
        };
        let factors: Vec<f64> = model
            .outputs()
            .iter()
            .zip(reference.outputs())
            .map(|(from, to)| factor(from, to) / per_input)
            .collect();
        let responses: Vec<(Vec<C64>, Vec<C64>)> = model
            .response(&omega)?
            .into_iter()
            .zip(&factors)
            .map(|(of_model, factor)| of_model.into_iter().map(|h| h * *factor).collect())
            .zip(reference.response(&omega)?)
            .collect();
        let gate = options.gate / 100.0;
        let mut distances = Vec::new();
        let mut peaks = Vec::new();
        for (of_model, of_reference) in &responses {
            distances.push(bode_distance(of_model, of_reference, None)?);
            let of_model = response_peaks(&omega, of_model, options.prominence)?;
            let of_reference = response_peaks(&omega, of_reference, options.prominence)?;
            peaks.push(match_response_peaks(&of_model, &of_reference, gate));
        }
        let (of_model, out_of_model) = comparable(model.poles()?, &band, options.all_poles);
        let (of_reference, out_of_reference) = comparable(reference.poles()?, &band, options.all_poles);
        let choice = MatchOptions {
            gate,
            ..MatchOptions::default()
        };
        Ok(Self {
            name: reference.name.clone(),
            band,
            outputs: reference.outputs().to_vec(),
            input: reference
                .inputs()
                .first()
                .cloned()
                .unwrap_or_else(|| Signal::new(input, "1")),
            matching: match_poles(&of_model, &of_reference, &choice),
            left_out: [out_of_model, out_of_reference],
            omega,
            responses,
            distances,
            peaks,
            notes,
        })
    }

    fn json(&self, model: &mut Map<String, Value>) -> Result<(), Failure> {
        let [of_model, of_reference] = self.left_out;
        let mut add = |key: &str, value: Value| model.insert(key.to_owned(), value);
        add("reference", json!(self.name));
        add("band_rad_s", json!([self.band.low_rad_s, self.band.high_rad_s]));
        add("matched", json!(self.matching.pairs));
        add(
            "mean_relative_percent",
            json!(self.matching.mean_relative_percent()),
        );
        add("unmatched_model", json!(self.matching.unmatched_identified));
        add("unmatched_reference", json!(self.matching.unmatched_reference));
        add(
            "left_out",
            json!({ "model": of_model, "reference": of_reference }),
        );
        add(
            "bode",
            json::by_output(&self.outputs, |o| Ok(json!(self.distances.get(o))))?,
        );
        add(
            "peaks",
            json::by_output(&self.outputs, |o| Ok(json!(self.peaks.get(o))))?,
        );
        add("notes", json!(self.notes));
        Ok(())
    }

    fn poles(&self) -> Result<Table, ReportError> {
        let mut table = Table::new(
            format!(
                "Poles, {:.3} to {:.3} rad/s",
                self.band.low_rad_s, self.band.high_rad_s
            ),
            [
                Column::new("frequency", "rad/s", Format::Fixed(3)).in_group("reference"),
                Column::new("damping", "-", Format::Fixed(4)).in_group("reference"),
                Column::new("frequency", "rad/s", Format::Fixed(3)).in_group("model"),
                Column::new("damping", "-", Format::Fixed(4)).in_group("model"),
                Column::new("difference", "%", Format::Fixed(2)),
            ],
        );
        let mut rows: Vec<(f64, [Cell; 5])> = Vec::new();
        for pair in &self.matching.pairs {
            let (r, m) = (pair.reference, pair.identified);
            let row = [
                r.omega_rad_s,
                r.damping_ratio,
                m.omega_rad_s,
                m.damping_ratio,
                pair.relative_percent,
            ];
            rows.push((r.omega_rad_s, row.map(Cell::from)));
        }
        for r in &self.matching.unmatched_reference {
            let row = [
                Cell::from(r.omega_rad_s),
                Cell::from(r.damping_ratio),
                Cell::EMPTY,
                Cell::EMPTY,
                Cell::EMPTY,
            ];
            rows.push((r.omega_rad_s, row));
        }
        for m in &self.matching.unmatched_identified {
            let row = [
                Cell::EMPTY,
                Cell::EMPTY,
                Cell::from(m.omega_rad_s),
                Cell::from(m.damping_ratio),
                Cell::EMPTY,
            ];
            rows.push((m.omega_rad_s, row));
        }
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, row) in rows {
            table.push(row)?;
        }
        Ok(table)
    }

    fn peaks(&self) -> Result<Table, ReportError> {
        let mut table = Table::new(
            "Peaks of the magnitude",
            [
                Column::text("output"),
                Column::new("frequency", "rad/s", Format::Fixed(3)).in_group("reference"),
                Column::new("height", "dB", Format::Fixed(2)).in_group("reference"),
                Column::new("frequency", "rad/s", Format::Fixed(3)).in_group("model"),
                Column::new("height", "dB", Format::Fixed(2)).in_group("model"),
                Column::new("difference", "%", Format::Fixed(2)),
                Column::new("difference", "dB", Format::Fixed(2)),
            ],
        );
        for (output, peaks) in self.outputs.iter().zip(&self.peaks) {
            let mut rows: Vec<(f64, [Option<f64>; 6])> = Vec::new();
            for pair in &peaks.pairs {
                let (r, m) = (pair.reference, pair.response);
                rows.push((
                    r.omega_rad_s,
                    [
                        Some(r.omega_rad_s),
                        Some(r.magnitude_db),
                        Some(m.omega_rad_s),
                        Some(m.magnitude_db),
                        Some(pair.relative_percent),
                        Some(pair.height_difference_db),
                    ],
                ));
            }
            for r in &peaks.unmatched_reference {
                let row = [Some(r.omega_rad_s), Some(r.magnitude_db), None, None, None, None];
                rows.push((r.omega_rad_s, row));
            }
            for m in &peaks.unmatched_response {
                let row = [None, None, Some(m.omega_rad_s), Some(m.magnitude_db), None, None];
                rows.push((m.omega_rad_s, row));
            }
            rows.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (_, row) in rows {
                table.push(std::iter::once(Cell::from(output.name.as_str())).chain(row.map(Cell::from)))?;
            }
        }
        Ok(table)
    }

    fn distances(&self) -> Result<Table, ReportError> {
        let mut table = Table::new(
            format!(
                "Distance of the Bode plots, {:.3} to {:.3} rad/s",
                self.band.low_rad_s, self.band.high_rad_s
            ),
            [
                Column::text("output"),
                Column::new("magnitude, rms", "dB", Format::Fixed(3)),
                Column::new("magnitude, mean", "dB", Format::Fixed(3)),
                Column::new("phase, rms", "deg", Format::Fixed(3)),
            ],
        );
        for (output, distance) in self.outputs.iter().zip(&self.distances) {
            table.push([
                Cell::from(output.name.as_str()),
                Cell::from(distance.rms_magnitude_db),
                Cell::from(distance.mean_magnitude_db),
                Cell::from(distance.rms_phase_deg),
            ])?;
        }
        Ok(table)
    }

    fn text(&self) -> Result<Vec<String>, ReportError> {
        let mean = self
            .matching
            .mean_relative_percent()
            .map_or(String::new(), |m| format!(", on average {m:.2} % apart"));
        let words = |left_out: LeftOut| {
            format!(
                "{} real, {} overdamped, {} out of the band, {} not seen",
                left_out.real, left_out.overdamped, left_out.out_of_band, left_out.unseen
            )
        };
        let [of_model, of_reference] = self.left_out;
        let summary = format!(
            "{} pairs{mean}; {} poles of the model and {} of the reference stay alone\n\
             left out of the model: {}; of the reference: {}\n",
            self.matching.pairs.len(),
            self.matching.unmatched_identified.len(),
            self.matching.unmatched_reference.len(),
            words(of_model),
            words(of_reference)
        );
        Ok(vec![
            self.poles()?.to_text() + &summary,
            self.distances()?.to_text(),
            self.peaks()?.to_text(),
        ])
    }

    fn write(&self, files: &Gathered, model: &System) -> Result<(), Failure> {
        files.add("poles.csv", &self.poles()?.to_csv())?;
        files.add("peaks.csv", &self.peaks()?.to_csv())?;
        files.add("bode.svg", &self.bode(model)?)?;
        files.add("poles.svg", &self.pole_map(model)?)
    }

    fn bode(&self, model: &System) -> Result<String, ReportError> {
        let short = figures::short_pair([&self.name, &model.name]);
        let mut plot = BodePlot::new(
            format!("Response to {}", self.input.name),
            Axis::log("Frequency", "rad/s"),
        );
        for (output, (of_model, of_reference)) in self.outputs.iter().zip(&self.responses) {
            let curve = |name: &str, style: Style, response: &[C64]| {
                BodeCurve::new(
                    name,
                    style,
                    self.omega.clone(),
                    figures::magnitude_db(response),
                    figures::phase_deg(response),
                )
            };
            plot = plot.with(
                BodeChannel::new(&output.name)
                    .with_reference(figures::ratio(output, &self.input))
                    .with(curve(short[0], Style::reference(), of_reference))
                    .with(curve(short[1], Style::model(0), of_model)),
            );
        }
        Ok(plot.render()?.markup)
    }

    /// Both sets of poles; matched ones are joined by a line.
    fn pole_map(&self, model: &System) -> Result<String, ReportError> {
        let short = figures::short_pair([&self.name, &model.name]);
        let matching = &self.matching;
        let pairs = matching.pairs.iter();
        let mut reference: Vec<(f64, f64)> =
            pairs.clone().map(|p| (p.reference.re, p.reference.im)).collect();
        reference.extend(matching.unmatched_reference.iter().map(|p| (p.re, p.im)));
        let mut own: Vec<(f64, f64)> = pairs
            .clone()
            .map(|p| (p.identified.re, p.identified.im))
            .collect();
        own.extend(matching.unmatched_identified.iter().map(|p| (p.re, p.im)));
        let mut plot =
            ScatterPlot::pole_map("Poles", "rad/s").with_damping_rays([0.02, 0.05, 0.1, 0.2, 0.4, 0.7]);
        plot.x = Axis::new("Real part", "1/s");
        plot.height = 520.0;
        for pair in pairs {
            let (p, q) = (pair.reference, pair.identified);
            plot = plot.with(Series::new(
                "matched",
                Style::background().with_width(1.0),
                [p.re, q.re],
                [p.im, q.im],
            ));
        }
        let set = |name: &str, style: Style, points: &[(f64, f64)]| {
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
            Series::new(name, style, x, y)
        };
        let black = Style {
            line: None,
            ..Style::reference().with_width(1.5).with_marker(Marker::Circle)
        };
        plot = plot.with(set(short[0], black, &reference)).with(set(
            short[1],
            Style::points(0).with_marker(Marker::Cross),
            &own,
        ));
        Ok(plot.render()?.markup)
    }
}

fn result(
    options: &CompareOptions,
    model: &System,
    with_reference: Option<&WithReference>,
    with_records: Option<&OnRecords>,
) -> Result<Value, Failure> {
    let mut map = Map::new();
    map.insert("model".into(), json!(model.name));
    map.insert("input".into(), json!(model.inputs().first()));
    map.insert("outputs".into(), json!(model.outputs()));
    if let Some(found) = with_reference {
        map.insert("gate_percent".into(), json!(options.gate));
        found.json(&mut map)?;
    }
    if let Some(found) = with_records {
        map.insert("intersample".into(), json!(found.data.intersample));
        map.insert("fits".into(), json::fits(&found.data.outputs, &found.simulated)?);
    }
    Ok(Value::Object(map))
}
