//! Table 6: the cost of five seconds of flight.

use crate::error::Error;
use crate::validate::reference::COST_PER_SECOND;
use crate::validate::study::{Study, VARIANTS};
use albatross::report::{Cell, Column, Format, Table};

/// What the paper and the reference print.
pub(super) fn quoted(study: &Study) -> Result<Table, Error> {
    let number =
        |name: &str, unit: &str, group: &str| Column::new(name, unit, Format::Significant(4)).in_group(group);
    let mut table = Table::new(
        "Table 6: cost of 5 s of simulated flight, as quoted",
        [
            Column::text("model"),
            Column::new("states", "", Format::Fixed(0)),
            number("from", "s", "time"),
            number("to", "s", "time"),
            number("from", "", "times slower than real time"),
            number("to", "", "times slower than real time"),
        ],
    )
    .with_caption(format!(
        "None of these was measured here, nor on one machine. The paper's figures make ModSiG {:.0} to {:.0} times slower \
         than real time and {:.0} to {:.0} times quicker than CFD.",
        study.paper.recomputed.table6.real_time_factor[0],
        study.paper.recomputed.table6.real_time_factor[1],
        study.paper.recomputed.table6.speedup[0],
        study.paper.recomputed.table6.speedup[1],
    ));
    let printed = &study.paper.printed.table6;
    let flown = printed.simulated_s;
    let mut push = |name: &str, states: Cell, [from, to]: [f64; 2]| {
        table.push([
            Cell::from(name),
            states,
            from.into(),
            to.into(),
            (from / flown).into(),
            (to / flown).into(),
        ])
    };
    push(
        "paper, CFD (512 cores)",
        Cell::EMPTY,
        printed.cfd_h.map(|h| 3600.0 * h),
    )?;
    push(
        "paper, ModSiG (i7-8700)",
        Cell::missing("not printed; the equations give 444 with lags on wing, HTP and VTP"),
        printed.modsig_s,
    )?;
    for (name, states, per_second) in COST_PER_SECOND {
        push(name, states.into(), per_second.map(|s| flown * s))?;
    }
    push(
        "reference, Loads Kernel's own integrator",
        Cell::from(4630_usize),
        [30.0, 30.0],
    )?;
    Ok(table)
}

/// What this run took.
pub(super) fn measured(study: &Study) -> Result<Table, Error> {
    let number = |name: &str, unit: &str| Column::new(name, unit, Format::Significant(3));
    let mut table = Table::new(
        "Table 6: measured in this run",
        [
            Column::text("what"),
            number("time", "s"),
            number("times quicker than real time", ""),
        ],
    )
    .with_caption(
        "Wall time on the machine that wrote this page, release build; other machines and loads differ, and the check \
         leaves this table out. One thread, but for the identification, which goes on beside the two stages before it.",
    );
    for ((_, name), seconds) in VARIANTS.iter().zip(&study.measured.five_seconds) {
        table.push([
            Cell::from(format!(
                "5 s of non-linear flight at 1 kHz, {} states: {name}",
                study.measured.states
            )),
            (*seconds).into(),
            (study.paper.printed.table6.simulated_s / seconds).into(),
        ])?;
    }
    for (name, seconds) in &study.measured.stages {
        table.push([Cell::from(name.as_str()), (*seconds).into(), Cell::EMPTY])?;
    }
    table.push([
        Cell::from("all of these, from the files to the results"),
        study.measured.all.into(),
        Cell::EMPTY,
    ])?;
    Ok(table)
}
