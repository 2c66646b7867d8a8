//! Zeros, poles and gain of one channel.
//!
//! H(s) = k (s - z_1)(s - z_2).../((s - p_1)(s - p_2)...). This is the form that says what a response is made of:
//! a flight-mechanics transfer function of low order, or which structural modes a sensor cannot see because a zero
//! lies on the pole.

use albatross_numerics::eigen::order_by_modulus;
use albatross_numerics::{C64, eigen};
use serde::{Deserialize, Serialize};

use crate::polynomial::{TransferFunction, conjugate_pairs, from_roots};
use crate::{Error, Result, Signal, StateSpace, realisation, zeros};

/// Zeros, poles and gain; complex values come in conjugate pairs, modulus ascending.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Fields", try_from = "Fields")]
pub struct Zpk {
    /// Zeros, rad/s.
    pub zeros: Vec<C64>,
    /// Poles, rad/s.
    pub poles: Vec<C64>,
    /// Ratio of the leading coefficients of numerator and denominator.
    pub gain: f64,
}

impl Zpk {
    /// Orders the values and checks that complex ones are paired.
    ///
    /// # Errors
    /// [`Error::Unpaired`]; [`Error::Domain`] for values that are not finite.
    pub fn try_new(mut zeros: Vec<C64>, mut poles: Vec<C64>, gain: f64) -> Result<Self> {
        conjugate_pairs("zeros", &zeros)?;
        conjugate_pairs("poles", &poles)?;
        if !gain.is_finite() {
            return Err(Error::Domain {
                what: "the gain",
                value: gain,
                expected: "a finite number",
            });
        }
        order_by_modulus(&mut zeros);
        order_by_modulus(&mut poles);
        Ok(Self { zeros, poles, gain })
    }

    /// Zeros, poles and gain of a system with one input and one output.
    ///
    /// Poles are the eigenvalues of the states that the input reaches and the output sees. Zeros are the
    /// transmission zeros, found by removing the infinite ones with orthogonal transformations first (after
    /// Emami-Naeini and Van Dooren, Automatica 18, 1982).
    ///
    /// # Errors
    /// [`Error::NotSiso`], [`Error::Numerics`], those of [`StateSpace::check`].
    pub fn from_state_space(system: &StateSpace) -> Result<Self> {
        system.check()?;
        check_siso("zeros and poles", system)?;
        let system = system.without_idle_states();
        let poles = eigen::eigenvalues(system.a.as_ref())?;
        let (zeros, gain) = zeros::zeros_and_gain(&system)?;
        Self::try_new(zeros, poles, gain)
    }

    /// Value at `s`; not finite at a pole.
    pub fn evaluate(&self, s: C64) -> C64 {
        // Alternating factors keep products of many large numbers in range.
        let (mut zeros, mut poles) = (self.zeros.iter(), self.poles.iter());
        let mut value = C64::new(self.gain, 0.0);
        loop {
            match (zeros.next(), poles.next()) {
                (None, None) => return value,
                (Some(z), Some(p)) => value *= (s - z) / (s - p),
                (Some(z), None) => value *= s - z,
                (None, Some(p)) => value /= s - p,
            }
        }
    }

    /// Without the poles and zeros that lie within `tolerance` times their modulus of each other.
    ///
    /// Modes that the input cannot excite or the output cannot see appear as such pairs. Real values cancel
    /// real ones, pairs cancel pairs, nearest first.
    pub fn cancelled(&self, tolerance: f64) -> Self {
        let (mut zeros, mut poles) = (self.zeros.clone(), self.poles.clone());
        loop {
            let nearest = zeros
                .iter()
                .flat_map(|&z| poles.iter().map(move |&p| (z, p)))
                .filter(|(z, p)| z.im >= 0.0 && p.im >= 0.0 && (z.im == 0.0) == (p.im == 0.0))
                .filter(|(z, p)| (z - p).norm() <= tolerance * p.norm())
                .min_by(|a, b| (a.0 - a.1).norm().total_cmp(&(b.0 - b.1).norm()));
            let Some((z, p)) = nearest else { break };
            for (list, value) in [(&mut zeros, z), (&mut poles, p)] {
                remove_nearest(list, value);
                if value.im != 0.0 {
                    remove_nearest(list, value.conj());
                }
            }
        }
        Self {
            zeros,
            poles,
            gain: self.gain,
        }
    }

    /// Numerator and denominator by descending powers.
    ///
    /// # Errors
    /// [`Error::Unpaired`] when the fields were filled without their conjugates.
    pub fn to_transfer_function(&self) -> Result<TransferFunction> {
        let numerator = from_roots(&self.zeros)?
            .into_iter()
            .map(|c| c * self.gain)
            .collect();
        Ok(TransferFunction {
            numerator,
            denominator: from_roots(&self.poles)?,
        })
    }

    /// A balanced state space with these poles and zeros: second-order sections in series, each in real-block
    /// form with the zeros nearest to its poles. Companion matrices, whose eigenvalues are ill-conditioned at
    /// high order, are not used.
    ///
    /// # Errors
    /// [`Error::Improper`] with more zeros than poles, [`Error::Unpaired`].
    pub fn to_state_space(&self, input: Signal, output: Signal) -> Result<StateSpace> {
        realisation::cascade(self, input, output)
    }
}

pub(crate) fn check_siso(what: &'static str, system: &StateSpace) -> Result<()> {
    let (inputs, outputs) = (system.inputs.len(), system.outputs.len());
    if (inputs, outputs) == (1, 1) {
        Ok(())
    } else {
        Err(Error::NotSiso {
            what,
            inputs,
            outputs,
        })
    }
}

fn remove_nearest(list: &mut Vec<C64>, value: C64) {
    let distance = |v: &C64| (v - value).norm();
    let nearest = (0..list.len()).min_by(|&p, &q| distance(&list[p]).total_cmp(&distance(&list[q])));
    if let Some(k) = nearest {
        list.remove(k);
    }
}

#[derive(Serialize, Deserialize)]
struct Fields {
    zeros: Vec<Complex>,
    poles: Vec<Complex>,
    gain: f64,
}

#[derive(Serialize, Deserialize)]
struct Complex {
    re: f64,
    im: f64,
}

impl From<Zpk> for Fields {
    fn from(zpk: Zpk) -> Self {
        let fields = |list: Vec<C64>| list.into_iter().map(|v| Complex { re: v.re, im: v.im }).collect();
        Self {
            zeros: fields(zpk.zeros),
            poles: fields(zpk.poles),
            gain: zpk.gain,
        }
    }
}

impl TryFrom<Fields> for Zpk {
    type Error = Error;

    fn try_from(fields: Fields) -> Result<Self> {
        let values = |list: Vec<Complex>| list.into_iter().map(|v| C64::new(v.re, v.im)).collect();
        Self::try_new(values(fields.zeros), values(fields.poles), fields.gain)
    }
}
