//! Table 5: identified poles beside the reference's eigenvalues and the modes of the linearised model.
//!
//! Poles and modes are paired by frequency alone, which says nothing of shape: antisymmetric modes, which an elevator
//! does not move, are left out of both lists, or they would take the place of their neighbours.

use super::{Identification, Identified, Output, Target};
use crate::error::Error;
use crate::validate::reference::Eigenvalue;
use crate::validate::study::{AVL, CORRECTED, Study};
use crate::validate::tables::{Named, percent};
use albatross::analysis::{AeroelasticMode, ModeTable};
use albatross::modal::Symmetry;
use albatross::numerics::C64;
use albatross::report::{Cell, Column, Format, Table};
use albatross::sysid::{MatchOptions, PoleEstimate, PoleMatching, match_poles};

/// Modes above this frequency \[rad/s\] are not missed: the paper's band ends there.
const BAND: f64 = 95.0;

/// The tables of poles.
pub(super) fn all(study: &Study, identification: &Identification) -> Result<Vec<Named>, Error> {
    let lists = Lists::of(study)?;
    Ok(vec![
        Named::iterated("table5_poles", table5(study, identification, &lists)?),
        Named::iterated("table5_matching", matching(identification, &lists)?),
        Named::iterated("table5_all_poles", identified(identification, &lists)?),
        Named::iterated("table5_unmatched", unmatched(identification, &lists)?),
    ])
}

/// A mode that an elevator moves.
#[derive(Debug, Clone)]
struct Listed {
    /// What it is called.
    name: String,
    pole: C64,
}

impl Listed {
    fn new(name: impl Into<String>, omega: f64, damping_ratio: f64) -> Self {
        let root = (1.0 - damping_ratio * damping_ratio).max(0.0).sqrt();
        Self {
            name: name.into(),
            pole: C64::new(-damping_ratio * omega, omega * root),
        }
    }
}

/// The symmetric modes of both, slowest first.
struct Lists {
    reference: Vec<Listed>,
    model: Vec<Listed>,
}

impl Lists {
    fn of(study: &Study) -> Result<Self, Error> {
        let modes = &study.reference.modes;
        let mut reference: Vec<Listed> = [
            ("phugoid", modes.phugoid()),
            ("short period", modes.short_period()),
        ]
        .into_iter()
        .filter_map(|(name, e)| e.map(|e| Listed::new(name, e.omega_rad_s, e.zeta)))
        .collect();
        let ranked = study.ranked_reference()?;
        for eigenvalue in modes.elastic(true) {
            let same = |e: Option<&Eigenvalue>| e.is_some_and(|e| std::ptr::eq(e, eigenvalue));
            // Beyond the modes of the case, the reference counts its own.
            let number = ranked
                .iter()
                .position(|e| same(*e))
                .map_or(eigenvalue.dominant_elastic_mode, |k| k + 1);
            reference.push(Listed::new(
                format!("mode {number}"),
                eigenvalue.omega_rad_s,
                eigenvalue.zeta,
            ));
        }
        let corrected = &study.modes(CORRECTED)?[0];
        let mut model: Vec<Listed> = corrected
            .rigid_body
            .iter()
            .filter(|m| matches!(m.name, "phugoid" | "short period"))
            .filter_map(|m| {
                let flexible = m.flexible.as_ref()?;
                Some(Listed::new(m.name, flexible.omega_rad_s, flexible.damping_ratio))
            })
            .collect();
        let basis = &study.variant(CORRECTED)?.model.basis.modes;
        for (k, mode) in study.ranked(corrected)?.into_iter().enumerate() {
            let symmetric = basis
                .get(k)
                .is_some_and(|m| m.symmetry != Symmetry::Antisymmetric);
            if let Some(mode) = mode.filter(|_| symmetric) {
                model.push(Listed::new(
                    format!("mode {}", k + 1),
                    mode.omega_rad_s,
                    mode.damping_ratio,
                ));
            }
        }
        let slowest_first = |a: &Listed, b: &Listed| a.pole.norm().total_cmp(&b.pole.norm());
        reference.sort_by(slowest_first);
        model.sort_by(slowest_first);
        Ok(Self { reference, model })
    }
}

fn matched(found: &Identified, list: &[Listed]) -> PoleMatching {
    let modes: Vec<C64> = list.iter().map(|l| l.pole).collect();
    match_poles(&found.poles(), &modes, &MatchOptions::default())
}

/// The pole that a matching gives to a mode of a list.
fn pole_of<'a>(found: &'a Identified, list: &[Listed], name: &str) -> Option<&'a PoleEstimate> {
    let place = list.iter().position(|l| l.name == name)?;
    let pairs = matched(found, list).pairs;
    let pair = pairs.iter().find(|p| p.reference.index == place)?;
    found.modes.get(pair.identified.index)
}

const NO_POLE: &str =
    "no pole of this transfer function within 15 % of the eigenvalue, or a nearer one has it";
const DOUBTFUL: &str = "not certain: standard deviation of the frequency above 10 %, or residue below two";

fn frequency(pole: Option<&PoleEstimate>) -> Cell {
    match pole {
        Some(pole) if pole.identified => pole.frequency_rad_s.into(),
        Some(pole) => Cell::from(pole.frequency_rad_s).flagged(DOUBTFUL),
        None => Cell::missing(NO_POLE),
    }
}

/// Table 5: the paper's poles, those identified here, the reference's eigenvalues and the linearised models' modes.
fn table5(study: &Study, identification: &Identification, lists: &Lists) -> Result<Table, Error> {
    let number =
        |name: &str, unit: &str, group: &str| Column::new(name, unit, Format::Fixed(2)).in_group(group);
    const IDENTIFIED: &str = "identified from the reference's histories";
    const AGAINST: &str = "identified, searched order, against";
    let mut table = Table::new(
        "Table 5: poles seen in the transfer functions",
        [
            Column::text("output"),
            Column::text("mode"),
            number("identified", "rad/s", "paper"),
            number("ModSiG", "rad/s", "paper"),
            number("printed difference", "%", "paper"),
            number("recomputed against ModSiG", "%", "paper"),
            number("recomputed against identified", "%", "paper"),
            number("eigenvalue", "rad/s", "reference"),
            number("paper's order", "rad/s", IDENTIFIED),
            number("searched order", "rad/s", IDENTIFIED),
            number("reference's eigenvalue", "%", AGAINST),
            number("Albatross, corrected", "%", AGAINST),
            number("AVL only", "rad/s", "Albatross"),
            number("corrected", "rad/s", "Albatross"),
            number("AVL only", "%", "against the reference's eigenvalue"),
            number("corrected", "%", "against the reference's eigenvalue"),
        ],
    )
    .with_caption(
        "Rows are those of the paper. All modes that it identified are symmetric: an elevator moves no others. Modes of \
         the reference and of Albatross are matched as in Table 8, identified poles to the reference's symmetric \
         eigenvalues by the assignment with the least sum of |ln ω/ω'| among pairs within 15 %. The surrogate's modes \
         are numbered as the paper's but are its own.",
    );
    let (avl, corrected) = (&study.modes(AVL)?[0], &study.modes(CORRECTED)?[0]);
    let reference = study.ranked_reference()?;
    let (ranked_avl, ranked_corrected) = (study.ranked(avl)?, study.ranked(corrected)?);
    let rows = study
        .paper
        .printed
        .table5
        .rows
        .iter()
        .zip(&study.paper.recomputed.table5);
    for (row, again) in rows {
        let printed = Cell::from(row.relative_percent);
        let printed = match (again.possible_vs_cfd, again.possible_vs_modsig) {
            (true, true) => printed,
            (false, true) => printed.flagged("not possible with the identified pole as the base"),
            (true, false) => printed.flagged("not possible with ModSiG as the base"),
            (false, false) => printed.flagged("not possible with either base"),
        };
        let modsig = Cell::from(row.modsig);
        // Mode 0 is the short period.
        let own = |table: &ModeTable, ranked: &[Option<&AeroelasticMode>]| match row.mode.checked_sub(1) {
            None => short_period(table),
            Some(k) => ranked.get(k).copied().flatten().map(|m| m.omega_rad_s),
        };
        let (avl, corrected) = (own(avl, &ranked_avl), own(corrected, &ranked_corrected));
        let eigenvalue = match row.mode.checked_sub(1) {
            None => study.reference.modes.short_period(),
            Some(k) => reference.get(k).copied().flatten(),
        }
        .map(|e| e.omega_rad_s);
        let name = mode_name(row.mode);
        let output = Target::of_code(&row.output).and_then(|i| identification.outputs.get(i));
        let pole = |of: &dyn Fn(&'_ Output) -> &'_ Identified| {
            output.and_then(|o| pole_of(of(o), &lists.reference, &name))
        };
        let (at_paper, searched) = (pole(&|o| &o.paper), pole(&|o| &o.searched));
        let against = |value: Option<f64>, base: Option<f64>| {
            Cell::from(value.zip(base).map(|(value, base)| percent(value, base)))
        };
        let omega = searched.map(|p| p.frequency_rad_s);
        table.push([
            Cell::from(output.map_or(row.output.as_str(), |o| o.target.name())),
            if row.mode == 0 {
                Cell::from("short period")
            } else {
                Cell::from(row.mode)
            },
            row.identified.into(),
            if again.table8_match {
                modsig
            } else {
                modsig.flagged("18.95 in Table 8 and in the other rows")
            },
            printed,
            again.rel_vs_modsig.into(),
            again.rel_vs_cfd.into(),
            eigenvalue.into(),
            frequency(at_paper),
            frequency(searched),
            against(omega, eigenvalue),
            against(omega, corrected),
            avl.into(),
            corrected.into(),
            against(avl, eigenvalue),
            against(corrected, eigenvalue),
        ])?;
    }
    Ok(table)
}

/// Frequency of the short period of the flexible aircraft.
fn short_period(table: &ModeTable) -> Option<f64> {
    let mode = table.rigid_body.iter().find(|m| m.name == "short period")?;
    Some(mode.flexible.as_ref()?.omega_rad_s)
}

/// Differences over the rows of the paper's Table 5, without sign \[%\]: mean and greatest.
pub(super) struct Difference {
    pub(super) rows: usize,
    /// Rows whose mode has a pole.
    pub(super) found: usize,
    pub(super) reference: [f64; 2],
    pub(super) model: [f64; 2],
}

/// How far the poles are off in the rows of Table 5.
pub(super) fn differences(
    study: &Study,
    identification: &Identification,
    of: fn(&Output) -> &Identified,
) -> Result<Difference, Error> {
    let lists = Lists::of(study)?;
    let rows = &study.paper.printed.table5.rows;
    let (mut reference, mut model) = (Vec::new(), Vec::new());
    for row in rows {
        let name = mode_name(row.mode);
        let output = Target::of_code(&row.output).and_then(|i| identification.outputs.get(i));
        let Some(pole) = output.and_then(|o| pole_of(of(o), &lists.reference, &name)) else {
            continue;
        };
        for (list, all) in [(&lists.reference, &mut reference), (&lists.model, &mut model)] {
            if let Some(mode) = list.iter().find(|l| l.name == name) {
                all.push(percent(pole.frequency_rad_s, mode.pole.norm()).abs());
            }
        }
    }
    let summary = |all: &[f64]| {
        [
            all.iter().sum::<f64>() / all.len() as f64,
            all.iter().copied().fold(0.0, f64::max),
        ]
    };
    Ok(Difference {
        rows: rows.len(),
        found: reference.len(),
        reference: summary(&reference),
        model: summary(&model),
    })
}

/// Name of a mode of the paper: 0 is the short period.
fn mode_name(mode: usize) -> String {
    match mode {
        0 => "short period".to_owned(),
        n => format!("mode {n}"),
    }
}

/// How many poles have found a mode, and how near.
fn matching(identification: &Identification, lists: &Lists) -> Result<Table, Error> {
    let count = |name: &str| Column::new(name, "", Format::Fixed(0));
    let against = |group: &str| {
        [
            count("pairs").in_group(group),
            Column::new("mean difference", "%", Format::Fixed(2)).in_group(group),
            Column::new("greatest", "%", Format::Fixed(2)).in_group(group),
        ]
    };
    let mut heads = vec![
        Column::text("output"),
        Column::text("order"),
        count("oscillatory").in_group("poles"),
        count("real").in_group("poles"),
        count("not certain").in_group("poles"),
    ];
    heads.extend(against("against the reference's eigenvalues"));
    heads.extend(against("against Albatross, corrected"));
    let mut table = Table::new("Table 5: identified poles and modes matched", heads).with_caption(format!(
        "Pairs of oscillatory poles with symmetric modes, frequencies within 15 %; differences without sign, referred to \
         the mode. Up to {BAND} rad/s, the reference has {} symmetric oscillatory modes and the linearised model {}. \
         Not certain: {DOUBTFUL}.",
        below(&lists.reference),
        below(&lists.model),
        DOUBTFUL = DOUBTFUL.trim_start_matches("not certain: ")
    ));
    for output in &identification.outputs {
        for (order, found) in [("paper's", &output.paper), ("searched", &output.searched)] {
            let real = found.modes.iter().filter(|m| m.im == 0.0).count();
            let mut row = vec![
                Cell::from(output.target.name()),
                format!("{order}: {} and {}", found.poles, found.zeros).into(),
                (found.modes.len() - real).into(),
                real.into(),
                found.modes.iter().filter(|m| !m.identified).count().into(),
            ];
            for list in [&lists.reference, &lists.model] {
                let pairs = matched(found, list);
                let greatest = pairs.pairs.iter().map(|p| p.relative_percent).fold(0.0, f64::max);
                row.extend([
                    Cell::from(pairs.pairs.len()),
                    pairs.mean_relative_percent().into(),
                    greatest.into(),
                ]);
            }
            table.push(row)?;
        }
    }
    Ok(table)
}

fn below(list: &[Listed]) -> usize {
    list.iter().filter(|l| l.pole.norm() <= BAND).count()
}

/// Every pole at the searched orders, and the modes that it stands for.
fn identified(identification: &Identification, lists: &Lists) -> Result<Table, Error> {
    let number = |name: &str, unit: &str, decimals: u8| Column::new(name, unit, Format::Fixed(decimals));
    let against = |group: &str| {
        [
            Column::text("mode").in_group(group),
            number("ω", "rad/s", 2).in_group(group),
            number("ζ", "", 4).in_group(group),
            number("difference of ω", "%", 2).in_group(group),
        ]
    };
    let mut heads = vec![
        Column::text("output"),
        number("ω", "rad/s", 2).in_group("identified"),
        Column::new("sd of ω", "rad/s", Format::Significant(2)).in_group("identified"),
        number("ζ", "", 4).in_group("identified"),
    ];
    heads.extend(against("reference"));
    heads.extend(against("Albatross, corrected"));
    let mut table = Table::new("Table 5: all poles at the searched orders", heads).with_caption(
        "Standard deviations hold for residuals as coloured as they are. The histories carry no noise: what the standard \
         deviation describes is the part of the response that the order leaves out, not what a repeated experiment \
         would give. ζ = 1 is a real pole, which is matched with none.",
    );
    for output in &identification.outputs {
        let found = &output.searched;
        let (reference, model) = (matched(found, &lists.reference), matched(found, &lists.model));
        for (index, pole) in found.modes.iter().enumerate() {
            let mut row = vec![
                Cell::from(output.target.name()),
                if pole.identified {
                    pole.frequency_rad_s.into()
                } else {
                    Cell::from(pole.frequency_rad_s).flagged(DOUBTFUL)
                },
                pole.sd_frequency_coloured_rad_s.into(),
                pole.damping_ratio.into(),
            ];
            for (pairs, list) in [(&reference, &lists.reference), (&model, &lists.model)] {
                let pair = pairs.pairs.iter().find(|p| p.identified.index == index);
                row.extend([
                    Cell::from(
                        pair.and_then(|p| list.get(p.reference.index))
                            .map(|l| l.name.as_str()),
                    ),
                    pair.map(|p| p.reference.omega_rad_s).into(),
                    pair.map(|p| p.reference.damping_ratio).into(),
                    pair.map(|p| percent(p.identified.omega_rad_s, p.reference.omega_rad_s))
                        .into(),
                ]);
            }
            table.push(row)?;
        }
    }
    Ok(table)
}

/// What the matchings at the searched orders leave alone, on both sides.
fn unmatched(identification: &Identification, lists: &Lists) -> Result<Table, Error> {
    let pair = |group: &str| {
        [
            Column::new("ω", "rad/s", Format::Fixed(2)).in_group(group),
            Column::new("ζ", "", Format::Fixed(4)).in_group(group),
        ]
    };
    let mut heads = vec![Column::text("output"), Column::text("matched with")];
    heads.extend(pair("identified pole without a mode"));
    heads.push(Column::text("mode without a pole"));
    heads.extend(pair("mode without a pole"));
    let mut table = Table::new("Table 5: what is left unmatched", heads).with_caption(format!(
        "At the searched orders. Modes above {BAND} rad/s are left out. The phugoid (0.06 rad/s, 100 s) cannot be seen in \
         records of 5 and 10 s."
    ));
    for output in &identification.outputs {
        for (with, list) in [
            ("reference", &lists.reference),
            ("Albatross, corrected", &lists.model),
        ] {
            let found = matched(&output.searched, list);
            for pole in &found.unmatched_identified {
                table.push([
                    Cell::from(output.target.name()),
                    with.into(),
                    pole.omega_rad_s.into(),
                    pole.damping_ratio.into(),
                    Cell::EMPTY,
                    Cell::EMPTY,
                    Cell::EMPTY,
                ])?;
            }
            for mode in found.unmatched_reference.iter().filter(|m| m.omega_rad_s <= BAND) {
                table.push([
                    Cell::from(output.target.name()),
                    with.into(),
                    Cell::EMPTY,
                    Cell::EMPTY,
                    list.get(mode.index).map(|l| l.name.as_str()).into(),
                    mode.omega_rad_s.into(),
                    mode.damping_ratio.into(),
                ])?;
            }
        }
    }
    Ok(table)
}
