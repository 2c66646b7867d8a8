//! Tables 7 and 8 and the rigid-body modes.

use super::percent;
use crate::error::Error;
use crate::validate::study::{AVL, CORRECTED, Study};
use albatross::analysis::{ModeTable, structural_modes};
use albatross::lti::Mode;
use albatross::modal::Symmetry;
use albatross::report::{Cell, Column, Format, Table};

/// Table 7: structural modes.
pub(super) fn structural(study: &Study) -> Result<Table, Error> {
    let number = |name: &str, unit: &str, decimals, group: &str| {
        Column::new(name, unit, Format::Fixed(decimals)).in_group(group)
    };
    let mut table = Table::new(
        "Table 7: structural modes",
        [
            Column::new("mode", "", Format::Fixed(0)),
            number("f", "Hz", 2, "paper"),
            number("ω", "rad/s", 2, "paper"),
            number("f", "Hz", 4, "surrogate"),
            number("ω", "rad/s", 3, "surrogate"),
            number("difference", "%", 3, "surrogate"),
            Column::text("symmetry").in_group("surrogate"),
            Column::text("kinetic energy").in_group("surrogate"),
            Column::text("description").in_group("paper"),
        ],
    )
    .with_caption(
        "The surrogate's beam properties were fitted to the paper's frequencies, so that agreement here is no result. \
         Its shapes are its own: kinetic energy by load reference axis and direction, from the f06 and the deck's mass \
         matrix.",
    );
    let own = structural_modes(&study.inputs, &study.variant(AVL)?.model)?;
    let rows = study
        .paper
        .printed
        .table7
        .rows
        .iter()
        .zip(&study.paper.recomputed.table7);
    for (k, (printed, again)) in rows.enumerate() {
        let mode = own.get(k);
        let omega = Cell::from(printed.omega_rad_s);
        table.push([
            Cell::from(printed.mode),
            printed.frequency_hz.into(),
            if again.within_rounding {
                omega
            } else {
                omega.flagged("does not follow from the printed Hz")
            },
            mode.map(|m| m.frequency_hz).into(),
            mode.map(|m| m.omega_rad_s).into(),
            mode.map(|m| percent(m.frequency_hz, printed.frequency_hz)).into(),
            mode.map(|m| symmetry(m.symmetry)).into(),
            mode.map(|m| m.description.clone()).into(),
            printed.description.as_str().into(),
        ])?;
    }
    Ok(table)
}

fn symmetry(class: Symmetry) -> &'static str {
    match class {
        Symmetry::Symmetric => "symmetric",
        Symmetry::Antisymmetric => "antisymmetric",
        _ => "mixed",
    }
}

/// The mode tables of Albatross that Table 8 shows: name, group, table.
fn columns(study: &Study) -> Result<[(&'static str, &ModeTable); 4], Error> {
    let ([avl, avl_quasi], [corrected, corrected_quasi]) = (study.modes(AVL)?, study.modes(CORRECTED)?);
    Ok([
        ("AVL only", avl),
        ("AVL only, quasi-steady", avl_quasi),
        ("corrected", corrected),
        ("corrected, quasi-steady", corrected_quasi),
    ])
}

/// Table 8: aeroelastic modes.
pub(super) fn aeroelastic(study: &Study) -> Result<Table, Error> {
    let omega = |group: &str| Column::new("ω", "rad/s", Format::Fixed(2)).in_group(group);
    let zeta = |group: &str| Column::new("ζ", "", Format::Fixed(4)).in_group(group);
    let own = columns(study)?;
    let mut heads = vec![
        Column::new("mode", "", Format::Fixed(0)),
        Column::text("symmetry"),
        omega("paper"),
        omega("in vacuo"),
        omega("reference"),
        zeta("reference"),
    ];
    for (name, _) in &own {
        heads.push(omega(name));
        heads.push(zeta(name));
    }
    let mut table = Table::new("Table 8: aeroelastic modes without lag roots", heads).with_caption(
        "ω is the modulus of the eigenvalue. Modes of Albatross are told from lag roots by following them from the \
         structure in vacuo and the rigid aircraft as the aerodynamic coupling is turned on. Rows are ranks: within each \
         symmetry, the n-th frequency in the flow stands beside the n-th in vacuo, in every column. Structural damping \
         is 1 % of critical; the paper prints no damping.",
    );
    let basis = &study.variant(AVL)?.model.basis;
    let reference = study.ranked_reference()?;
    let own = own.map(|(_, table)| study.ranked(table));
    for (k, (mode, printed)) in basis
        .modes
        .iter()
        .zip(&study.paper.printed.table8.omega_rad_s)
        .enumerate()
    {
        let other = reference.get(k).copied().flatten();
        let mut row = vec![
            Cell::from(k + 1),
            symmetry(mode.symmetry).into(),
            (*printed).into(),
            mode.omega_rad_s.into(),
            match other {
                Some(e) if e.dominant_elastic_mode != k + 1 => Cell::from(e.omega_rad_s).flagged(format!(
                    "dominated by structural mode {}",
                    e.dominant_elastic_mode
                )),
                other => other.map(|e| e.omega_rad_s).into(),
            },
            other.map(|e| e.zeta).into(),
        ];
        for ranked in &own {
            let found = ranked.as_ref().ok().and_then(|r| r.get(k).copied().flatten());
            row.push(match found {
                Some(m) if m.mode != k + 1 => {
                    Cell::from(m.omega_rad_s).flagged(format!("followed from structural mode {}", m.mode))
                }
                found => found.map(|m| m.omega_rad_s).into(),
            });
            row.push(found.map(|m| m.damping_ratio).into());
        }
        table.push(row)?;
    }
    Ok(table)
}

/// Differences of frequencies over the twenty modes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Difference {
    /// Mean of the absolute differences \[%\].
    pub(crate) mean: f64,
    /// The largest \[%\], with its sign.
    pub(crate) worst: f64,
    /// Its mode.
    pub(crate) mode: usize,
}

impl Difference {
    fn of(pairs: impl Iterator<Item = (usize, f64, f64)>) -> Self {
        let differences: Vec<(usize, f64)> = pairs
            .map(|(mode, value, base)| (mode, percent(value, base)))
            .collect();
        let worst = differences
            .iter()
            .copied()
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
            .unwrap_or((0, f64::NAN));
        Self {
            mean: differences.iter().map(|d| d.1.abs()).sum::<f64>() / differences.len() as f64,
            worst: worst.1,
            mode: worst.0,
        }
    }
}

/// Differences of one column of Table 8.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Differences {
    /// Against the paper, by rank within each symmetry.
    pub(crate) paper: Difference,
    /// Against the paper, whose table does not name symmetries, in order of frequency alone.
    pub(crate) paper_by_frequency: Difference,
    /// Against the reference, by rank within each symmetry.
    pub(crate) reference: Difference,
}

/// Name of each column of Table 8 with its differences.
pub(crate) fn mean_differences(study: &Study) -> Result<Vec<(&'static str, Differences)>, Error> {
    let printed = &study.paper.printed.table8.omega_rad_s;
    let reference = study.ranked_reference()?;
    columns(study)?
        .into_iter()
        .map(|(name, table)| {
            let ranked = study.ranked(table)?;
            let own = || {
                ranked
                    .iter()
                    .enumerate()
                    .filter_map(|(k, m)| Some((k, m.as_ref()?.omega_rad_s)))
            };
            let other = own().filter_map(|(k, w)| Some((k + 1, w, reference.get(k)?.as_ref()?.omega_rad_s)));
            let differences = Differences {
                paper: Difference::of(against_list(own(), printed)),
                paper_by_frequency: Difference::of(against_list(ascending(own()), printed)),
                reference: Difference::of(other),
            };
            Ok((name, differences))
        })
        .collect()
}

/// Ranks (from 0) and values beside the list's entries: mode (from 1), value, base.
fn against_list(
    own: impl Iterator<Item = (usize, f64)>,
    list: &[f64],
) -> impl Iterator<Item = (usize, f64, f64)> {
    own.filter_map(|(k, w)| Some((k + 1, w, *list.get(k)?)))
}

/// The values in ascending order with new ranks.
fn ascending(own: impl Iterator<Item = (usize, f64)>) -> impl Iterator<Item = (usize, f64)> {
    let mut values: Vec<f64> = own.map(|(_, w)| w).collect();
    values.sort_by(f64::total_cmp);
    values.into_iter().enumerate()
}

/// Mean and worst difference of each column of Table 8.
pub(super) fn summary(study: &Study) -> Result<Table, Error> {
    let number = |name: &str, group: &str| Column::new(name, "%", Format::Fixed(2)).in_group(group);
    let against = |group: &str| {
        [
            number("mean of absolute differences", group),
            number("worst", group),
            Column::new("in mode", "", Format::Fixed(0)).in_group(group),
        ]
    };
    let mut heads = vec![Column::text("frequencies")];
    heads.extend(against("against the paper's Table 8"));
    heads.extend(against("the same, both in order of frequency alone"));
    heads.extend(against("against the reference"));
    let mut table = Table::new("Table 8: differences of frequency", heads).with_caption(
        "Nothing was fitted to the paper's Table 8. The reference's own difference against it shows how far two \
         aircraft with the same frequencies in vacuo may differ.",
    );
    let cells = |d: Difference| [d.mean.into(), d.worst.into(), Cell::from(d.mode)];
    for (name, d) in mean_differences(study)? {
        let mut row = vec![Cell::from(format!("Albatross, {name}"))];
        row.extend(cells(d.paper));
        row.extend(cells(d.paper_by_frequency));
        row.extend(cells(d.reference));
        table.push(row)?;
    }
    let printed = &study.paper.printed.table8.omega_rad_s;
    let reference = study.ranked_reference()?;
    let own = || {
        reference
            .iter()
            .enumerate()
            .filter_map(|(k, e)| Some((k, e.as_ref()?.omega_rad_s)))
    };
    let mut row = vec![Cell::from("reference")];
    row.extend(cells(Difference::of(against_list(own(), printed))));
    row.extend(cells(Difference::of(against_list(ascending(own()), printed))));
    row.resize(table.columns().len(), Cell::EMPTY);
    table.push(row)?;
    Ok(table)
}

/// Short period, phugoid, Dutch roll, roll and spiral of the rigid and the flexible aircraft.
pub(super) fn rigid_body(study: &Study) -> Result<Table, Error> {
    let pair = |group: &str| {
        [
            Column::new("ω", "rad/s", Format::Fixed(4)).in_group(group),
            Column::new("ζ", "", Format::Fixed(4)).in_group(group),
        ]
    };
    let mut heads = vec![Column::text("mode")];
    heads.extend(pair("reference, flexible"));
    for variant in ["AVL only", "corrected"] {
        heads.extend(pair(&format!("{variant}, rigid")));
        heads.extend(pair(&format!("{variant}, flexible")));
    }
    let mut table = Table::new("Rigid-body modes", heads).with_caption(
        "Modes without oscillation are given by their eigenvalue in 1/s instead of ω; they have no ζ. The correction \
         changes longitudinal derivatives only; no lateral motion is compared, and AVL, like the reference, has no \
         fuselage. In the paper, the short period is at 1.65 rad/s (ModSiG) and 1.74 to \
         1.77 rad/s (identified from CFD) and the phugoid at about 0.07 rad/s.",
    );
    let modes = &study.reference.modes;
    let (avl, corrected) = (&study.modes(AVL)?[0], &study.modes(CORRECTED)?[0]);
    for mode in &avl.rigid_body {
        let oscillation = |e: Option<&crate::validate::reference::Eigenvalue>| {
            [
                Cell::from(e.map(|e| e.omega_rad_s)),
                Cell::from(e.map(|e| e.zeta)),
            ]
        };
        let real = |index: usize| {
            [
                Cell::from(modes.slow_real_eigenvalues.get(index).copied()),
                Cell::EMPTY,
            ]
        };
        let mut row = vec![Cell::from(mode.name)];
        row.extend(match mode.name {
            "short period" => oscillation(modes.short_period()),
            "phugoid" => oscillation(modes.phugoid()),
            "Dutch roll" => oscillation(modes.dutch_roll()),
            "roll subsidence" => real(0),
            "spiral" => real(1),
            _ => [Cell::EMPTY, Cell::EMPTY],
        });
        let corrected = corrected.rigid_body.iter().find(|m| m.name == mode.name);
        for found in [Some(mode), corrected] {
            row.extend(own(found.map(|m| &m.rigid)));
            row.extend(own(found.and_then(|m| m.flexible.as_ref())));
        }
        table.push(row)?;
    }
    Ok(table)
}

fn own(mode: Option<&Mode>) -> [Cell; 2] {
    match mode {
        Some(m) if m.oscillatory => [m.omega_rad_s.into(), m.damping_ratio.into()],
        Some(m) => [m.re.into(), Cell::EMPTY],
        None => [Cell::EMPTY, Cell::EMPTY],
    }
}
