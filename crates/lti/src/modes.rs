//! The mode table: frequency, damping and participating states of each eigenvalue.

use std::f64::consts::{LN_2, TAU};

use albatross_numerics::eigen::{EigenBoth, eigen_both};
use albatross_numerics::{C64, MatRef};
use serde::{Deserialize, Serialize};

use crate::{Result, StateSpace};

/// Shares below this are left out of [`Mode::participation`].
const LEAST_SHARE: f64 = 0.01;
/// Most states listed per mode.
const MOST_STATES: usize = 6;

/// One mode: a real eigenvalue, or a conjugate pair represented by the member with positive imaginary part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mode {
    /// Real part of the eigenvalue, rad/s.
    pub re: f64,
    /// Imaginary part of the eigenvalue, rad/s, not negative.
    pub im: f64,
    /// Undamped circular frequency, the modulus of the eigenvalue, rad/s.
    pub omega_rad_s: f64,
    /// Undamped frequency, modulus over 2 pi, Hz.
    pub frequency_hz: f64,
    /// Damping ratio, minus the real part over the modulus: 1 for a decaying real mode, -1 for a growing one,
    /// 0 for an integrator.
    pub damping_ratio: f64,
    /// A conjugate pair.
    pub oscillatory: bool,
    /// 1/|re|, s; none without growth or decay.
    pub time_constant_s: Option<f64>,
    /// Time in which the amplitude halves (re < 0) or doubles (re > 0), s; none without growth or decay.
    pub time_to_half_or_double_s: Option<f64>,
    /// Period of the damped oscillation, 2 pi/im, s; none for a real mode.
    pub period_s: Option<f64>,
    /// States that carry the mode, largest share first; empty when only the eigenvalue is known.
    pub participation: Vec<Participation>,
}

/// Share of a state in a mode.
///
/// |l_i r_i| over the sum of that product over all states, with l and r the left and right eigenvectors
/// (participation factors: Perez-Arriaga, Verghese and Schweppe, IEEE Trans. PAS-101, 1982). The shares of a
/// mode sum to one and do not depend on the units of the states.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Participation {
    /// Name of the state.
    pub state: String,
    /// Position of the state.
    pub index: usize,
    /// Share, 0 to 1.
    pub share: f64,
}

impl Mode {
    /// The figures of an eigenvalue in rad/s, without participation.
    pub fn from_eigenvalue(value: C64) -> Self {
        let modulus = value.norm();
        let changing = (value.re != 0.0).then_some(value.re.abs());
        Self {
            re: value.re,
            im: value.im.abs(),
            omega_rad_s: modulus,
            frequency_hz: modulus / TAU,
            damping_ratio: if modulus > 0.0 { -value.re / modulus } else { 0.0 },
            oscillatory: value.im != 0.0,
            time_constant_s: changing.map(f64::recip),
            time_to_half_or_double_s: changing.map(|rate| LN_2 / rate),
            period_s: (value.im != 0.0).then(|| TAU / value.im.abs()),
            participation: Vec::new(),
        }
    }

    /// The eigenvalue (of a pair the member with positive imaginary part), rad/s.
    pub fn eigenvalue(&self) -> C64 {
        C64::new(self.re, self.im)
    }
}

/// All modes of a system, modulus ascending, with the states that carry them.
///
/// # Errors
/// [`crate::Error::Numerics`] when the eigenproblem fails, those of [`StateSpace::check`].
pub fn mode_table(system: &StateSpace) -> Result<Vec<Mode>> {
    system.check()?;
    let eigen = eigen_both(system.a.as_ref())?;
    Ok((0..eigen.values.len())
        .filter(|&k| eigen.values[k].im >= 0.0)
        .map(|k| mode_of(system, &eigen, k))
        .collect())
}

/// The modes of `system` nearest to the given eigenvalues (of tracked modes, say), in the order given.
///
/// # Errors
/// [`crate::Error::Numerics`] when the eigenproblem fails, those of [`StateSpace::check`].
pub fn mode_table_of(system: &StateSpace, values: &[C64]) -> Result<Vec<Mode>> {
    system.check()?;
    let eigen = eigen_both(system.a.as_ref())?;
    let nearest = |value: C64| {
        let value = C64::new(value.re, value.im.abs());
        (0..eigen.values.len()).min_by(|&p, &q| {
            (eigen.values[p] - value)
                .norm()
                .total_cmp(&(eigen.values[q] - value).norm())
        })
    };
    Ok(values
        .iter()
        .filter_map(|&value| nearest(value))
        .map(|k| mode_of(system, &eigen, k))
        .collect())
}

fn mode_of(system: &StateSpace, eigen: &EigenBoth, k: usize) -> Mode {
    let shares = participation(eigen.left.as_ref(), eigen.right.as_ref(), k);
    let mut order: Vec<usize> = (0..shares.len()).filter(|&i| shares[i] >= LEAST_SHARE).collect();
    // Equal shares (symmetric strips) keep the order of the states.
    order.sort_by(|&p, &q| shares[q].total_cmp(&shares[p]));
    order.truncate(MOST_STATES);
    let participation = order
        .into_iter()
        .map(|index| Participation {
            state: system.states[index].name.clone(),
            index,
            share: shares[index],
        })
        .collect();
    Mode {
        participation,
        ..Mode::from_eigenvalue(eigen.values[k])
    }
}

/// Share of every state in mode `k`, from left and right eigenvectors in columns.
pub(crate) fn participation(left: MatRef<'_, C64>, right: MatRef<'_, C64>, k: usize) -> Vec<f64> {
    let products: Vec<f64> = (0..right.nrows())
        .map(|i| (left[(i, k)].conj() * right[(i, k)]).norm())
        .collect();
    let sum: f64 = products.iter().sum();
    // Left and right vectors of a defective value may be orthogonal entry by entry: fall back on the shape.
    if sum > 0.0 {
        products.into_iter().map(|p| p / sum).collect()
    } else {
        (0..right.nrows()).map(|i| right[(i, k)].norm_sqr()).collect()
    }
}
