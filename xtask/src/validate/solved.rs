//! The case from its deck and geometry alone, against the same case from the files of Nastran and AVL; and with lift
//! between strips.

use super::reference::{MANOEUVRES, QUANTITIES};
use super::study::{AVL, Flight, Study};
use super::tables::Named;
use crate::error::Error;
use albatross::analysis::{self, ModeTable, RigidBodyMode, Trimmed};
use albatross::case::{LiftSlopes, SOLVE};
use albatross::inputs::read_results;
use albatross::lti::Mode;
use albatross::modal::{ModalBasis, mac};
use albatross::numerics::Mat;
use albatross::report::{Cell, Column, Format, Table};
use albatross::{Inputs, Model};
use std::path::Path;

/// A model without files of other programs.
struct Run {
    model: Model,
    trimmed: Trimmed,
    modes: ModeTable,
    flights: Vec<Flight>,
}

impl Run {
    fn of(study: &Study, inputs: &Inputs, variant: &str) -> Result<Self, Error> {
        let model = Model::build(inputs, &inputs.case.variant(Some(variant))?)?;
        let trimmed = analysis::trimmed(&model)?;
        let modes = analysis::mode_table_without_lags(&model, &trimmed)?;
        let flights = Flight::all(&trimmed, &model.point.control, &study.reference)?;
        Ok(Self {
            model,
            trimmed,
            modes,
            flights,
        })
    }
}

/// What is shown of it.
pub(crate) struct Solved {
    pub(crate) tables: Vec<Named>,
    /// Lift slopes between all strips.
    pub(crate) slopes: Option<Mat<f64>>,
    /// Greatest differences: of the twenty frequencies against each printed solution, of 1 - MAC, of the trimmed
    /// incidence \[deg\], of the frequencies in the flow.
    pub(crate) worst: Worst,
    /// Mean difference of the frequencies in the flow to the reference \[%\], of own slopes and of lift between strips.
    pub(crate) means: [f64; 2],
    /// Mean difference of the damping ratios, likewise.
    pub(crate) damping_means: [f64; 2],
}

/// Greatest differences between the two ways.
#[derive(Default)]
pub(crate) struct Worst {
    pub(crate) mystran: f64,
    pub(crate) nastran95: f64,
    pub(crate) mac: f64,
    pub(crate) alpha_deg: f64,
    pub(crate) in_flow_percent: f64,
    pub(crate) short_period_percent: f64,
}

/// Solves and compares.
pub(crate) fn run(root: &Path, study: &Study) -> Result<Solved, Error> {
    let directory = root.join("fixtures/f25-like");
    let mut case = study.inputs.case.clone();
    case.structure.results = SOLVE.into();
    let aerodynamics = &mut case.aerodynamics;
    aerodynamics.results = Some(SOLVE.into());
    (aerodynamics.derivatives, aerodynamics.strips) = (None, None);
    aerodynamics.lift_slopes = LiftSlopes::Lattice;
    let between = Inputs::of_case(case, &directory)?;
    let mut own = between.clone();
    own.case.aerodynamics.lift_slopes = LiftSlopes::Avl;
    own.slopes_between = None;

    let solved = Run::of(study, &own, "avl")?;
    let coupled = Run::of(study, &between, "avl")?;
    let others = [
        study.inputs.basis()?,
        study.inputs.case.basis(
            &study.inputs.deck,
            &read_results(&directory.join("f25_nastran95.f06"))?,
        )?,
    ];
    let mut worst = Worst::default();
    let vacuo = vacuo(&solved.model.basis, &others, &mut worst)?;
    let quantities = quantities(study, &solved, &mut worst)?;
    let (in_flow, means, damping_means) = in_flow(study, &solved, &coupled, &mut worst)?;
    Ok(Solved {
        tables: vec![
            Named::new("solved_quantities", quantities),
            Named::new("solved_structural_modes", vacuo),
            Named::new("solved_aeroelastic_modes", in_flow),
            Named::new("solved_fits", fits(study, &solved, &coupled)?),
        ],
        slopes: between.slopes_between,
        worst,
        means,
        damping_means,
    })
}

fn percent(value: f64, of: f64) -> f64 {
    100.0 * (value / of - 1.0)
}

/// Frequencies and shapes against two other solvers of the same deck.
fn vacuo(own: &ModalBasis, others: &[ModalBasis; 2], worst: &mut Worst) -> Result<Table, Error> {
    let hertz = |group: &str| Column::new("f", "Hz", Format::Fixed(6)).in_group(group);
    let relative = |group: &str| Column::new("difference", "1e-6", Format::Fixed(2)).in_group(group);
    let alike = |group: &str| Column::new("1 - MAC", "1e-9", Format::Fixed(3)).in_group(group);
    let mut table = Table::new(
        "The deck's modes by Albatross, MYSTRAN and NASTRAN-95",
        [
            Column::new("mode", "", Format::Fixed(0)),
            hertz("Albatross"),
            hertz("MYSTRAN 17"),
            relative("MYSTRAN 17"),
            alike("MYSTRAN 17"),
            hertz("NASTRAN-95"),
            relative("NASTRAN-95"),
            alike("NASTRAN-95"),
        ],
    )
    .with_caption("Both print seven digits of the frequencies. MAC with the deck's mass matrix.");
    let assurance = |other: &ModalBasis| mac(own, other).map_err(albatross::Error::from);
    let assurance = [assurance(&others[0])?, assurance(&others[1])?];
    for (k, mode) in own.modes.iter().enumerate() {
        let f = mode.frequency_hz;
        let mut row = vec![Cell::from(k + 1), f.into()];
        for (other, (assurance, worst_of)) in others
            .iter()
            .zip(assurance.iter().zip([&mut worst.mystran, &mut worst.nastran95]))
        {
            let theirs = other.modes.get(k).map_or(f64::NAN, |m| m.frequency_hz);
            let difference = f / theirs - 1.0;
            let unlike = 1.0 - assurance[(k, k)];
            *worst_of = worst_of.max(difference.abs());
            worst.mac = worst.mac.max(unlike);
            // Rounding of the printed vectors leaves less than this.
            let unlike = (unlike * 1e12).round() / 1e12;
            row.extend([theirs.into(), (1e6 * difference).into(), (1e9 * unlike).into()]);
        }
        table.push(row)?;
    }
    Ok(table)
}

/// Trim, derivatives and rigid-body modes from files and from the deck and the geometry.
fn quantities(study: &Study, solved: &Run, worst: &mut Worst) -> Result<Table, Error> {
    let files = study.variant(AVL)?;
    let column = |name: &str| Column::new(name, "", Format::Significant(7));
    let mut table = Table::new(
        "The case from deck and geometry alone",
        [
            Column::text("quantity"),
            Column::text("unit"),
            column("from files"),
            column("from deck and geometry"),
            Column::new("difference", "%", Format::Fixed(4)),
        ],
    )
    .with_caption(
        "Variant `avl`. The files: MYSTRAN's f06 with seven digits, AVL 3.52's .st with six decimals and .fs with four. AVL \
         stops its trim at 2e-5 of the pitching moment, which is what the elevator differs by. AVL leaves the side force of \
         the header's profile drag out of CYβ; so does Albatross.",
    );
    let mut push = |name: &str, unit: &str, a: f64, b: f64| -> Result<(), Error> {
        let difference = if a == 0.0 {
            Cell::EMPTY
        } else {
            percent(b, a).into()
        };
        let row = [Cell::from(name), unit.into(), a.into(), b.into(), difference];
        Ok(table.push(row)?)
    };
    let (a, b) = (&files.model, &solved.model);
    push("mass", "kg", a.mass.mass, b.mass.mass)?;
    push("centre of gravity, x", "m", a.mass.cg[0], b.mass.cg[0])?;
    push("centre of gravity, z", "m", a.mass.cg[2], b.mass.cg[2])?;
    let (ta, tb) = (&files.trimmed.trim, &solved.trimmed.trim);
    let alpha = [ta, tb].map(|t| t.alpha_rad.to_degrees());
    worst.alpha_deg = (alpha[0] - alpha[1]).abs();
    push("trimmed incidence", "deg", alpha[0], alpha[1])?;
    let elevator = |run: &Model, trim: &albatross::flight::Trim| {
        let place = run.aircraft.controls.iter().position(|c| *c == run.point.control);
        let found = place.and_then(|c| trim.controls_rad.get(c));
        found.map_or(f64::NAN, |d| d.to_degrees())
    };
    push("trimmed elevator", "deg", elevator(a, ta), elevator(b, tb))?;
    push("thrust", "N", ta.thrust, tb.thrust)?;
    let rows = |model: &Model| {
        let (lift, pitch) = (&model.aircraft.rigid.lift, &model.aircraft.rigid.pitch);
        [
            ("CLα", lift.alpha),
            ("Cmα", pitch.alpha),
            ("CLq", lift.q_hat),
            ("Cmq", pitch.q_hat),
            ("Clp", model.aircraft.rigid.roll.p_hat),
            ("Cnβ", model.aircraft.rigid.yaw.beta),
            ("CYβ", model.aircraft.rigid.side.beta),
        ]
    };
    for ((name, x), (_, y)) in rows(a).into_iter().zip(rows(b)) {
        push(name, "1/rad, body axes", x, y)?;
    }
    let flexible = |m: &RigidBodyMode| m.flexible.clone();
    let pairs = study.modes(AVL)?[0]
        .rigid_body
        .iter()
        .zip(&solved.modes.rigid_body);
    for (x, y) in pairs {
        let both: Vec<(String, Option<Mode>, Option<Mode>)> = vec![
            (
                format!("{}, rigid", x.name),
                Some(x.rigid.clone()),
                Some(y.rigid.clone()),
            ),
            (format!("{}, flexible", x.name), flexible(x), flexible(y)),
        ];
        for (name, p, q) in both {
            let (Some(p), Some(q)) = (p, q) else { continue };
            if x.name == "short period" {
                let difference = percent(q.omega_rad_s, p.omega_rad_s).abs();
                worst.short_period_percent = worst.short_period_percent.max(difference);
            }
            push(&format!("{name}: ω"), "rad/s", p.omega_rad_s, q.omega_rad_s)?;
            if p.damping_ratio.abs() < 1.0 {
                push(&format!("{name}: ζ"), "", p.damping_ratio, q.damping_ratio)?;
            }
        }
    }
    Ok(table)
}

type InFlow = (Table, [f64; 2], [f64; 2]);

/// Aeroelastic modes from files, from the deck and the geometry, with lift between strips, and of the reference.
fn in_flow(study: &Study, solved: &Run, coupled: &Run, worst: &mut Worst) -> Result<InFlow, Error> {
    let files = study.ranked(&study.modes(AVL)?[0])?;
    let own = study.ranked(&solved.modes)?;
    let between = study.ranked(&coupled.modes)?;
    let reference = study.ranked_reference()?;
    let omega = |group: &str| Column::new("ω", "rad/s", Format::Fixed(3)).in_group(group);
    let zeta = |group: &str| Column::new("ζ", "", Format::Fixed(4)).in_group(group);
    let groups = [
        "from files",
        "deck and geometry",
        "lift between strips",
        "reference",
    ];
    let mut heads = vec![Column::new("mode", "", Format::Fixed(0))];
    for group in groups {
        heads.extend([omega(group), zeta(group)]);
    }
    let mut table = Table::new("Modes in the flow without files of other programs", heads).with_caption(
        "AVL's data or the lattice's, no correction. Lift between strips (`lift_slopes = \"lattice\"`): the lattice's own \
         lift slopes between all strips in the place of one slope a strip. The reference is a doublet lattice with 50 \
         modes. Rows are ranks, as in Table 8.",
    );
    let (mut sums, mut damping) = ([0.0; 2], [0.0; 2]);
    let mut count = 0.0;
    for k in 0..files.len() {
        let at = |list: &[Option<&analysis::AeroelasticMode>]| {
            let mode = list.get(k).copied().flatten();
            mode.map_or([f64::NAN; 2], |m| [m.omega_rad_s, m.damping_ratio])
        };
        let other = reference.get(k).copied().flatten();
        let other = other.map_or([f64::NAN; 2], |m| [m.omega_rad_s, m.zeta]);
        let [f, o, b] = [at(&files), at(&own), at(&between)];
        worst.in_flow_percent = worst.in_flow_percent.max(percent(o[0], f[0]).abs());
        if other[0].is_finite() {
            count += 1.0;
            for (i, mode) in [o, b].into_iter().enumerate() {
                sums[i] += percent(mode[0], other[0]).abs();
                damping[i] += (mode[1] - other[1]).abs();
            }
        }
        let mut row = vec![Cell::from(k + 1)];
        row.extend([f, o, b, other].into_iter().flatten().map(Cell::from));
        table.push(row)?;
    }
    Ok((table, sums.map(|s| s / count), damping.map(|s| s / count)))
}

/// Fits of the three ways to the reference's histories.
fn fits(study: &Study, solved: &Run, coupled: &Run) -> Result<Table, Error> {
    let mut heads = vec![Column::text("model"), Column::text("doublet")];
    heads.extend(QUANTITIES.iter().map(|q| super::fits::percent_column(q.name)));
    let mut table = Table::new("Fits without files of other programs", heads)
        .with_caption("As the fits above, to the reference's histories; no correction.");
    let models = [
        ("from files", &study.variant(AVL)?.flights),
        ("deck and geometry", &solved.flights),
        ("lift between strips", &coupled.flights),
    ];
    for (name, flights) in models {
        for ((_, doublet), flight) in MANOEUVRES.iter().zip(flights) {
            let mut row = vec![Cell::from(name), (*doublet).into()];
            row.extend(flight.fits.iter().map(|f| Cell::from(*f)));
            table.push(row)?;
        }
    }
    Ok(table)
}
