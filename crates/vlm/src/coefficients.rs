//! Total coefficients and their derivatives in stability and body axes.

use crate::condition::{Condition, rate_scale};
use crate::flow::{Flow, Solver};
use crate::forces::{Load, Loads};
use crate::lattice::{Lattice, V3};
use crate::units::ONSETS;

/// Force coefficients over `q Sref` and moment coefficients over `q Sref` (`Bref`, `Cref`, `Bref`), geometry axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Coefficients {
    pub(crate) force: V3,
    pub(crate) moment: V3,
}

/// Coefficients in the axes of the printed tables.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Stability {
    pub(crate) lift: f64,
    pub(crate) side: f64,
    pub(crate) drag: f64,
    /// Roll, pitch, yaw.
    pub(crate) moment: V3,
}

/// All that the tables need: coefficients, and derivatives by onsets and settings.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// Of surfaces and bodies, without the header's profile drag.
    value: Coefficients,
    changes: Vec<Coefficients>,
    condition: Condition,
    rate_scale: V3,
    rotation: V3,
    /// Profile drag of the header, along the wind.
    cd_p: f64,
}

impl Coefficients {
    pub(crate) fn of(load: &Load, lattice: &Lattice) -> Self {
        let r = &lattice.reference;
        let lengths = V3::new(r.b_ref, r.c_ref, r.b_ref);
        Self {
            force: load.force / r.s_ref,
            moment: load.moment.component_div(&lengths) / r.s_ref,
        }
    }

    fn scaled(&self, factor: f64) -> Self {
        Self {
            force: self.force * factor,
            moment: self.moment * factor,
        }
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            force: self.force + other.force,
            moment: self.moment + other.moment,
        }
    }

    /// Force and moment in body axes: x forward, z down.
    pub(crate) fn body(&self) -> (V3, V3) {
        let turn = |v: &V3| V3::new(-v.x, v.y, -v.z);
        (turn(&self.force), turn(&self.moment))
    }

    /// Resolved along stability axes at an angle of attack.
    pub(crate) fn stability(&self, alpha_rad: f64) -> Stability {
        let (s, c) = alpha_rad.sin_cos();
        let (f, (_, m)) = (self.force, self.body());
        Stability {
            lift: f.z * c - f.x * s,
            side: f.y,
            drag: f.x * c + f.z * s,
            moment: V3::new(m.x * c + m.z * s, m.y, m.z * c - m.x * s),
        }
    }

    /// d stability / d alpha of the axes' turn alone.
    fn stability_turn(&self, alpha_rad: f64) -> Stability {
        let v = self.stability(alpha_rad);
        Stability {
            lift: -v.drag,
            side: 0.0,
            drag: v.lift,
            moment: V3::new(v.moment.z, 0.0, -v.moment.x),
        }
    }
}

impl Stability {
    fn plus(&self, other: &Self) -> Self {
        Self {
            lift: self.lift + other.lift,
            side: self.side + other.side,
            drag: self.drag + other.drag,
            moment: self.moment + other.moment,
        }
    }
}

impl Table {
    pub(crate) fn new(solver: &Solver<'_>, flow: &Flow, loads: &Loads) -> Self {
        let lattice = solver.lattice();
        Self {
            value: Coefficients::of(&loads.total, lattice),
            changes: loads
                .changes
                .iter()
                .map(|c| Coefficients::of(c, lattice))
                .collect(),
            condition: flow.condition.clone(),
            rate_scale: rate_scale(lattice),
            rotation: flow.condition.rotation(lattice),
            cd_p: lattice.cd_p,
        }
    }

    /// All coefficients: the header's profile drag acts along the wind at the reference point.
    pub(crate) fn total(&self) -> Coefficients {
        let wind = self.condition.wind();
        Coefficients {
            force: self.value.force + wind * (self.cd_p * wind.norm()),
            moment: self.value.moment,
        }
    }

    /// Derivative of the side force of the header's profile drag by sideslip, which AVL leaves out of `CYb`.
    pub(crate) fn profile_side_force_beta(&self) -> f64 {
        -self.cd_p * self.condition.beta_rad.cos()
    }

    /// Along a change of the wind and of the rotation in geometry axes.
    fn along(&self, wind: &V3, rotation: &V3) -> Coefficients {
        let factors = [wind.x, wind.y, wind.z, rotation.x, rotation.y, rotation.z];
        let mut sum = Coefficients::default();
        for (change, factor) in self.changes.iter().zip(factors) {
            sum = sum.plus(&change.scaled(factor));
        }
        sum
    }

    /// Change of rotation per unit rate in body axes.
    fn rate(&self, rates: [f64; 3]) -> V3 {
        V3::from(rates).component_mul(&self.rate_scale)
    }

    /// By alpha with the rates in body axes held, for the trim.
    pub(crate) fn alpha_body_rates(&self) -> Coefficients {
        self.along(&self.condition.wind_alpha(), &V3::zeros())
    }

    pub(crate) fn beta(&self) -> Coefficients {
        self.along(&self.condition.wind_beta(), &V3::zeros())
    }

    /// By `pb/2V`, `qc/2V` and `rb/2V` in body axes.
    pub(crate) fn body_rate(&self, axis: usize) -> Coefficients {
        let mut rates = [0.0; 3];
        rates[axis] = 1.0;
        self.along(&V3::zeros(), &self.rate(rates))
    }

    /// By wind u, v, w in body axes.
    pub(crate) fn body_wind(&self, axis: usize) -> Coefficients {
        let mut wind = V3::zeros();
        wind[axis] = if axis == 1 { -1.0 } else { 1.0 };
        let now = self.condition.wind();
        let speed = now.norm();
        let mut change = self.along(&wind, &V3::zeros());
        change.force += (wind * speed + now * (now.dot(&wind) / speed)) * self.cd_p;
        change
    }

    pub(crate) fn setting(&self, k: usize) -> Coefficients {
        self.changes.get(ONSETS + k).copied().unwrap_or_default()
    }

    /// Totals. As AVL has it, the drag of the header counts whole in `CDtot` with sideslip too, and in `CYtot` as
    /// the wind's component.
    pub(crate) fn stability(&self) -> Stability {
        let own = self.value.stability(self.condition.alpha_rad);
        let wind = self.condition.wind();
        Stability {
            drag: own.drag + self.cd_p * wind.norm_squared(),
            side: own.side + self.cd_p * wind.y * wind.norm(),
            ..own
        }
    }

    pub(crate) fn resolved(&self, change: &Coefficients) -> Stability {
        change.stability(self.condition.alpha_rad)
    }

    /// By alpha with the rates in stability axes held; `as_avl` with the rotation turned the wrong way, as AVL does.
    pub(crate) fn stability_alpha(&self, as_avl: bool) -> Stability {
        // The rotation vector turns with the stability axes about y.
        let turn = V3::new(-self.rotation.z, 0.0, self.rotation.x) * if as_avl { -1.0 } else { 1.0 };
        let change = self.along(&self.condition.wind_alpha(), &turn);
        self.resolved(&change)
            .plus(&self.value.stability_turn(self.condition.alpha_rad))
    }

    /// By alpha with the rates in body axes held.
    pub(crate) fn stability_alpha_body_rates(&self) -> Stability {
        let change = self.alpha_body_rates();
        self.resolved(&change)
            .plus(&self.value.stability_turn(self.condition.alpha_rad))
    }

    /// By `p'b/2V` (0), `qc/2V` (1), `r'b/2V` (2) in stability axes.
    pub(crate) fn stability_rate(&self, axis: usize) -> Stability {
        let (s, c) = self.condition.alpha_rad.sin_cos();
        let rates = match axis {
            0 => [c, 0.0, s],
            1 => [0.0, 1.0, 0.0],
            _ => [-s, 0.0, c],
        };
        self.resolved(&self.along(&V3::zeros(), &self.rate(rates)))
    }
}
