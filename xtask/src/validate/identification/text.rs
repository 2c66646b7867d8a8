//! What the page says of the identification.

use super::poles::{Difference, differences};
use super::{Identification, Identified, Output};
use crate::error::Error;
use crate::validate::check::{FLOOR_ITERATED, RELATIVE_ITERATED};
use crate::validate::study::Study;

/// What is identified, from what and how.
pub(crate) fn introduction() -> &'static str {
    "The paper identifies four transfer functions from its CFD histories and compares their poles and Bode diagrams with \
     those of its linearised model. The same is done here with **the reference's histories, which are a DLM-based \
     simulation of the invented surrogate: neither CFD nor the paper's data**. Input is the elevator's deviation from \
     trim, in rad and straight between samples of 1 ms; outputs are a_z at cockpit, last passenger and right wing tip and \
     q, as deviations from the trim that precedes each doublet. Each transfer function is estimated by itself from all \
     three doublets together (10, 5 and 5 s), with a weight that lets every record count by its fit, from six starting \
     sets of poles and down to the minimum of the output error; initial states are not needed, since all records begin \
     at rest. Each is estimated at the paper's numbers of poles and zeros and at numbers searched on these histories."
}

/// What the identification cannot tell.
pub(crate) fn limits() -> [String; 5] {
    [
        "**The phugoid is not identified.** It takes 100 s, the longest record 10 s. Below 0.5 rad/s a transfer function is \
         what its poles make of the rest; real poles near zero stand for the drift."
            .into(),
        "**The reference is of higher order than any of these transfer functions**: 50 modes, and lags. What the order \
         leaves out, the poles take upon themselves: those of weak modes move, and those beyond 95 rad/s gather what \
         several modes do."
            .into(),
        "**Fits are those of the training.** All three histories are used to train; what a transfer function does on a \
         doublet that it has not seen is in [the list of candidates](search/candidates.csv), trained on one history \
         alone."
            .into(),
        "**The histories carry no noise.** Standard deviations describe the part of the response that the order leaves out, \
         as if it were noise of its colour."
            .into(),
        format!(
            "**The minimum is searched.** On one machine the same numbers come out in every run. On another, rounding may \
             end the search a little elsewhere: `--check` allows {:.0} % of these numbers and {FLOOR_ITERATED:.0e} in all, \
             and does not repeat the search of the orders.",
            100.0 * RELATIVE_ITERATED
        ),
    ]
}

fn averages(identification: &Identification, of: impl Fn(&Output) -> &Identified) -> [f64; 2] {
    let all = identification.outputs.iter().map(|o| of(o).average());
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

/// What came of it, in sentences.
pub(crate) fn outcome(study: &Study, identification: &Identification) -> Result<[String; 3], Error> {
    let [low, high] = averages(identification, |o| &o.paper);
    let [searched_low, searched_high] = averages(identification, |o| &o.searched);
    let against = |of: fn(&Output) -> &Identified| differences(study, identification, of);
    let (at_paper, searched) = (against(|o| &o.paper)?, against(|o| &o.searched)?);
    let said = |d: &Difference| {
        format!(
            "{} of {} rows have a pole, {:.1} % off the reference's eigenvalue in the mean (at most {:.1} %) and {:.1} % off \
             Albatross's corrected mode (at most {:.1} %)",
            d.found, d.rows, d.reference[0], d.reference[1], d.model[0], d.model[1]
        )
    };
    Ok([
        format!(
            "**Fits.** The averages over the three doublets are {low:.1} to {high:.1} % at the paper's orders and \
             {searched_low:.1} to {searched_high:.1} % at the searched ones; the paper has 94.8 to 97.8 %."
        ),
        format!(
            "**Poles against the truth.** Unlike CFD, the reference has known eigenvalues, so that the identification \
             itself can be judged. Of the rows of the paper's Table 5, at the paper's orders {}; at the searched orders {}.",
            said(&at_paper),
            said(&searched)
        ),
        "**Poles against Albatross.** Where the identified pole agrees with the reference's eigenvalue, its difference to \
         Albatross's mode is that of the two models, as in Table 8, and not an error of the identification."
            .into(),
    ])
}
