//! Normal modes of a deck.

use crate::args::{MassChoice, SolveModesOptions};
use crate::output::{Failure, print, print_json, remark, write};
use albatross::fem::{self, BarMass, FemModel, ModelOptions, Modes, ModesOptions};
use albatross::report::{Cell, Column, Format, ReportError, Table};
use serde_json::{Value, json};

pub(crate) fn solve_modes(options: &SolveModesOptions) -> Result<(), Failure> {
    let file = options.deck.display().to_string();
    let (deck, diagnostics) =
        albatross::nastran::bdf::read_strict(&options.deck).map_err(albatross::Error::from)?;
    let of_file = |source| Failure::Solver {
        file: file.clone(),
        source: Box::new(albatross::Error::Fem(source)),
    };
    let choice = ModelOptions {
        bar_mass: options.mass.map(|mass| match mass {
            MassChoice::Lumped => BarMass::Lumped,
            MassChoice::Coupled => BarMass::Coupled,
        }),
        leave_out_unknown: options.leave_out_unknown,
        subcase: options.subcase,
        ..ModelOptions::default()
    };
    let model = FemModel::assemble(&deck, &choice).map_err(of_file)?;
    let of_deck = ModesOptions::of_deck(&deck, options.subcase);
    // A number asked for here goes up from the lowest mode, whatever range the deck has.
    let range = if options.modes.is_some() {
        (options.from, options.to)
    } else {
        (options.from.or(of_deck.lower_hz), options.to.or(of_deck.upper_hz))
    };
    let modes = model
        .modes(&ModesOptions {
            count: options.modes.or(of_deck.count),
            lower_hz: range.0,
            upper_hz: range.1,
            scale: of_deck.scale,
        })
        .map_err(of_file)?;
    if !options.quiet {
        let diagnostics = diagnostics.iter().map(ToString::to_string);
        for note in diagnostics.chain(model.remarks.iter().chain(&modes.remarks).cloned()) {
            remark(&format!("note: {note}"));
        }
    }
    if let Some(path) = &options.f06 {
        write(
            path,
            &fem::listing(&modes.results(&model, &file), &deck_title(&file)),
        )?;
    }
    if options.json {
        print_json(&json(options, &model, &modes))
    } else {
        print(&mass_text(&model))?;
        print(&table(&modes)?.to_text())
    }
}

fn deck_title(file: &str) -> String {
    format!(
        "MODES OF {}",
        file.rsplit(['/', '\\']).next().unwrap_or(file).to_uppercase()
    )
}

fn json(options: &SolveModesOptions, model: &FemModel, modes: &Modes) -> Value {
    let mass = model.properties();
    let mut value = json!({
        "frequencies_hz": modes.frequencies_hz,
        "eigenvalues": modes.eigenvalues,
        "generalized_masses": modes.generalized_masses,
        "residuals": modes.residuals,
        "mass": mass.map(|m| m.mass),
        "cg": mass.map(|m| m.cg),
        "inertia": mass.map(|m| m.inertia),
        "freedoms": model.stiffness().order(),
        "notes": model.remarks.iter().chain(&modes.remarks).collect::<Vec<_>>(),
    });
    if options.vectors {
        let points = model.freedoms().points();
        let vectors: Vec<Value> = (0..modes.len())
            .map(|k| {
                let rows = points
                    .iter()
                    .map(|p| json!({ "grid": p.id, "values": modes.at(k, p.id) }));
                Value::Array(rows.collect())
            })
            .collect();
        if let Some(object) = value.as_object_mut() {
            object.insert("eigenvectors".into(), Value::Array(vectors));
        }
    }
    value
}

fn mass_text(model: &FemModel) -> String {
    let Some(mass) = model.properties() else {
        return "no mass".to_owned();
    };
    let [x, y, z] = mass.cg;
    let row = |r: [f64; 3]| format!("  {:>15.7e} {:>15.7e} {:>15.7e}\n", r[0], r[1], r[2]);
    let inertia: String = mass.inertia.iter().map(|r| row(*r)).collect();
    format!(
        "mass {:.7} kg, centre of gravity {x:.7}, {y:.7}, {z:.7} m, inertia about it [kg m2]\n{inertia}",
        mass.mass
    )
}

fn table(modes: &Modes) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Normal modes",
        [
            Column::new("mode", "", Format::Fixed(0)),
            Column::new("frequency", "Hz", Format::Significant(8)),
            Column::new("frequency", "rad/s", Format::Significant(8)),
            Column::new("modal mass", "kg m2", Format::Significant(6)),
            Column::new("residual", "-", Format::Scientific(1)),
        ],
    );
    for k in 0..modes.len() {
        let at = |values: &[f64]| Cell::from(values.get(k).copied());
        let f = modes.frequencies_hz.get(k).copied();
        table.push([
            Cell::from(k + 1),
            Cell::from(f),
            Cell::from(f.map(|f| std::f64::consts::TAU * f)),
            at(&modes.generalized_masses),
            at(&modes.residuals),
        ])?;
    }
    Ok(table)
}
