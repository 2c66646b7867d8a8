//! Flight condition: onset flow and settings, and the derivatives' variables.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::lattice::{Lattice, V3};

/// Angles, rates and settings at which the flow is evaluated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// Angle of attack, in rad.
    pub alpha_rad: f64,
    /// Sideslip, in rad.
    pub beta_rad: f64,
    /// Roll rate `p b / 2V` in body axes (x forward).
    pub pb_2v: f64,
    /// Pitch rate `q c / 2V`.
    pub qc_2v: f64,
    /// Yaw rate `r b / 2V` in body axes (z down).
    pub rb_2v: f64,
    /// Control variables in AVL's order, in degrees per unit gain.
    pub controls: Vec<f64>,
    /// Design variables in AVL's order.
    pub designs: Vec<f64>,
}

impl Condition {
    /// No sideslip, no rates, no deflections.
    pub fn at_alpha_deg(alpha_deg: f64, lattice: &Lattice) -> Self {
        Self {
            alpha_rad: alpha_deg.to_radians(),
            controls: vec![0.0; lattice.controls.len()],
            designs: vec![0.0; lattice.designs.len()],
            ..Self::default()
        }
    }

    /// Sets a control by name, in degrees per unit gain.
    ///
    /// # Errors
    /// [`Error::UnknownControl`].
    pub fn set_control(&mut self, lattice: &Lattice, name: &str, value: f64) -> Result<()> {
        let index = control_index(lattice, name)?;
        self.controls.resize(lattice.controls.len(), 0.0);
        self.controls[index] = value;
        Ok(())
    }

    /// Checks lengths and finiteness.
    pub(crate) fn check(&self, lattice: &Lattice) -> Result<()> {
        let lists = [
            (
                "control variables of the flight condition",
                self.controls.len(),
                lattice.controls.len(),
            ),
            (
                "design variables of the flight condition",
                self.designs.len(),
                lattice.designs.len(),
            ),
        ];
        for (what, found, expected) in lists {
            if found != expected {
                return Err(Error::Length {
                    what,
                    found,
                    expected,
                });
            }
        }
        let numbers = [self.alpha_rad, self.beta_rad, self.pb_2v, self.qc_2v, self.rb_2v];
        let all = numbers.iter().chain(&self.controls).chain(&self.designs);
        match all.copied().find(|v| !v.is_finite()) {
            Some(value) => Err(Error::Value {
                what: "a number of the flight condition".to_owned(),
                value,
                expected: "it must be finite",
            }),
            None => Ok(()),
        }
    }

    /// Wind over V in geometry axes: (ca cb, -sb, sa cb).
    pub(crate) fn wind(&self) -> V3 {
        let ((sa, ca), (sb, cb)) = (self.alpha_rad.sin_cos(), self.beta_rad.sin_cos());
        V3::new(ca * cb, -sb, sa * cb)
    }

    /// d wind / d alpha.
    pub(crate) fn wind_alpha(&self) -> V3 {
        let ((sa, ca), cb) = (self.alpha_rad.sin_cos(), self.beta_rad.cos());
        V3::new(-sa * cb, 0.0, ca * cb)
    }

    /// d wind / d beta.
    pub(crate) fn wind_beta(&self) -> V3 {
        let ((sa, ca), (sb, cb)) = (self.alpha_rad.sin_cos(), self.beta_rad.sin_cos());
        V3::new(-ca * sb, -cb, -sa * sb)
    }

    /// Rotation over V in geometry axes (x aft, z up), from rates in body axes.
    pub(crate) fn rotation(&self, lattice: &Lattice) -> V3 {
        let scale = rate_scale(lattice);
        V3::new(self.pb_2v * scale.x, self.qc_2v * scale.y, self.rb_2v * scale.z)
    }

    /// Onset as one array: wind, rotation.
    pub(crate) fn onset(&self, lattice: &Lattice) -> [f64; 6] {
        let (v, w) = (self.wind(), self.rotation(lattice));
        [v.x, v.y, v.z, w.x, w.y, w.z]
    }

    /// Settings as one list: controls, design variables.
    pub(crate) fn settings(&self) -> impl Iterator<Item = f64> {
        self.controls.iter().chain(&self.designs).copied()
    }
}

/// Rotation in geometry axes per unit `pb/2V`, `qc/2V`, `rb/2V` of body axes.
pub(crate) fn rate_scale(lattice: &Lattice) -> V3 {
    let r = &lattice.reference;
    V3::new(-2.0 / r.b_ref, 2.0 / r.c_ref, -2.0 / r.b_ref)
}

/// Index of a control.
pub(crate) fn control_index(lattice: &Lattice, name: &str) -> Result<usize> {
    let names: Vec<&str> = lattice.control_names().collect();
    albatross_avl::run::find_control(name, &names).ok_or_else(|| Error::UnknownControl {
        name: name.to_owned(),
        known: names.join(", "),
    })
}
