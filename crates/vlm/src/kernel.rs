//! Velocity that horseshoe vortices induce at a point, vectorised over the vortices.
//!
//! For a horseshoe of unit circulation with bound leg from 1 to 2, trailing legs along +x, and `a`, `b` the vectors
//! from its ends to the point (Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed., sec. 10.4.5; Drela, Flight Vehicle
//! Aerodynamics, eq. 6.33), without core
//!
//! ```text
//! 4 pi V = a x b ((b.b - a.b)/|b| + (a.a - a.b)/|a|) / |a x b|^2
//!        + a x X (1 + a_x/|a|) / (a_y^2 + a_z^2) - b x X (1 + b_x/|b|) / (b_y^2 + b_z^2)
//! ```
//!
//! A core of radius r_c replaces squared distances d^2 from a leg by d^2 + r_c^2 ([`CoreModel::Scully`], AVL up to
//! 3.40) or by sqrt(d^4 + r_c^4) ([`CoreModel::Leishman`], AVL 3.52; J. G. Leishman, Principles of Helicopter
//! Aerodynamics, sec. 10.6; Vatistas' n = 2).
//!
//! Compressibility is Prandtl and Glauert's: coordinates x/beta, and the x velocity divided by beta.
//!
//! Equations: THEORY (47).

use pulp::Arch;
use serde::{Deserialize, Serialize};

use crate::lattice::{Lattice, V3};

/// 1/(4 pi) to eight digits: AVL's results carry its excess of 5.7e-9, and so do ours.
pub(crate) const INVERSE_4_PI: f64 = 0.079577472;

/// How a vortex' core smooths its velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CoreModel {
    /// d^2 + r_c^2: AVL up to 3.40.
    Scully,
    /// sqrt(d^4 + r_c^4): AVL 3.52.
    Leishman,
}

/// Core radii of vortices of other components; within a component it is [`CoreRadii::WITHIN`] of the width.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoreRadii {
    /// Model.
    pub model: CoreModel,
    /// Over the chord of the emitting strip.
    pub chord_fraction: f64,
    /// Over the width of the emitting vortex.
    pub width_fraction: f64,
}

impl CoreRadii {
    /// Radius over width for a point on the same component.
    pub const WITHIN: f64 = 1e-4;

    /// AVL up to 3.40: the larger of a quarter chord and half the width.
    pub const AVL_332: Self = Self {
        model: CoreModel::Scully,
        chord_fraction: 0.25,
        width_fraction: 0.5,
    };

    /// AVL 3.52: twice the width.
    pub const AVL_352: Self = Self {
        model: CoreModel::Leishman,
        chord_fraction: 0.0,
        width_fraction: 2.0,
    };
}

/// Velocities at one point by each vortex, per unit circulation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Velocities {
    pub(crate) u: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) w: Vec<f64>,
}

impl Velocities {
    pub(crate) fn new(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Self {
            u: zeros(),
            v: zeros(),
            w: zeros(),
        }
    }
}

/// Ends and cores of all vortices, one array for each coordinate.
#[derive(Clone, Debug)]
pub(crate) struct Horseshoes {
    beta: f64,
    model: CoreModel,
    ends: [[Vec<f64>; 3]; 2],
    /// For each component: the power of the core radius that the model needs.
    cores: Vec<Vec<f64>>,
    /// Plane of symmetry and its sign, for each of y and z.
    images: [Option<(f64, f64)>; 2],
}

impl Horseshoes {
    /// The vortices of a lattice at a Mach number below 1. `components` numbers the component of each vortex.
    pub(crate) fn new(lattice: &Lattice, mach: f64, radii: &CoreRadii, components: &[usize]) -> Self {
        let beta = (1.0 - mach * mach).sqrt();
        let coordinate = |end: usize, axis: usize| {
            let scale = if axis == 0 { 1.0 / beta } else { 1.0 };
            lattice
                .vortices
                .iter()
                .map(|v| v.ends[end][axis] * scale)
                .collect()
        };
        let ends = [0, 1].map(|end| [0, 1, 2].map(|axis| coordinate(end, axis)));
        let power = match radii.model {
            CoreModel::Scully => 2,
            CoreModel::Leishman => 4,
        };
        let core = |target: usize| {
            let radius = |(v, &own): (&crate::lattice::Vortex, &usize)| {
                let bound = v.bound();
                let width = bound.y.hypot(bound.z);
                let radius = if own == target {
                    CoreRadii::WITHIN * width
                } else {
                    let chord = lattice.strips[v.strip].chord;
                    (radii.chord_fraction * chord).max(radii.width_fraction * width)
                };
                radius.powi(power)
            };
            lattice.vortices.iter().zip(components).map(radius).collect()
        };
        let n_components = components.iter().max().map_or(0, |m| m + 1);
        let image = |sign: i32, plane: f64| (sign != 0).then_some((f64::from(sign), plane));
        Self {
            beta,
            model: radii.model,
            ends,
            cores: (0..n_components).map(core).collect(),
            images: [image(lattice.i_ysym, 0.0), image(lattice.i_zsym, lattice.z_sym)],
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.ends[0][0].len()
    }

    /// Velocities at a point of a component. `scratch` is of the same length.
    pub(crate) fn at(&self, point: &V3, component: usize, out: &mut Velocities, scratch: &mut Velocities) {
        self.direct(point, component, out);
        let y = self.images[0];
        let z = self.images[1];
        if let Some((sign, plane)) = y {
            let at = V3::new(point.x, 2.0 * plane - point.y, point.z);
            self.direct(&at, component, scratch);
            add(out, scratch, [sign, -sign, sign]);
        }
        if let Some((sign, plane)) = z {
            let at = V3::new(point.x, point.y, 2.0 * plane - point.z);
            self.direct(&at, component, scratch);
            add(out, scratch, [sign, sign, -sign]);
        }
        if let (Some((sign_y, y)), Some((sign_z, z))) = (y, z) {
            let at = V3::new(point.x, 2.0 * y - point.y, 2.0 * z - point.z);
            let sign = sign_y * sign_z;
            self.direct(&at, component, scratch);
            add(out, scratch, [sign, -sign, -sign]);
        }
    }

    fn direct(&self, point: &V3, component: usize, out: &mut Velocities) {
        let rows = Rows {
            point: [point.x / self.beta, point.y, point.z],
            inverse_beta: 1.0 / self.beta,
            ends: &self.ends,
            core: &self.cores[component],
            out,
        };
        match self.model {
            CoreModel::Scully => Arch::new().dispatch(Pass(rows, Scully)),
            CoreModel::Leishman => Arch::new().dispatch(Pass(rows, Leishman)),
        }
    }

    /// Velocity at a point by the bound leg of vortex `k` alone: what a vortex must not do to itself.
    pub(crate) fn bound_leg(&self, k: usize, point: &V3, component: usize) -> V3 {
        let p = [point.x / self.beta, point.y, point.z];
        let to = |end: usize| [0, 1, 2].map(|axis| p[axis] - self.ends[end][axis][k]);
        let core = self.cores[component][k];
        let v = match self.model {
            CoreModel::Scully => bound(to(0), to(1), core, Scully),
            CoreModel::Leishman => bound(to(0), to(1), core, Leishman),
        };
        V3::new(v[0] / self.beta, v[1], v[2]) * INVERSE_4_PI
    }
}

/// out += signs * other, component by component.
fn add(out: &mut Velocities, other: &Velocities, signs: [f64; 3]) {
    let pairs = [
        (&mut out.u, &other.u),
        (&mut out.v, &other.v),
        (&mut out.w, &other.w),
    ];
    for ((to, from), sign) in pairs.into_iter().zip(signs) {
        for (t, f) in to.iter_mut().zip(from) {
            *t += sign * f;
        }
    }
}

/// Two powers of a distance, smoothed by a core.
trait Smoothing: Copy {
    /// Distance from its square.
    fn distance(self, squared: f64, core: f64) -> f64;
    /// Square of a distance times `length_squared`, from the square of distance and length.
    fn squared(self, squared: f64, length_squared: f64, core: f64) -> f64;
}

#[derive(Clone, Copy)]
struct Scully;

impl Smoothing for Scully {
    #[inline(always)]
    fn distance(self, squared: f64, core: f64) -> f64 {
        (squared + core).sqrt()
    }
    #[inline(always)]
    fn squared(self, squared: f64, length_squared: f64, core: f64) -> f64 {
        squared + length_squared * core
    }
}

#[derive(Clone, Copy)]
struct Leishman;

impl Smoothing for Leishman {
    #[inline(always)]
    fn distance(self, squared: f64, core: f64) -> f64 {
        (squared * squared + core).sqrt().sqrt()
    }
    #[inline(always)]
    fn squared(self, squared: f64, length_squared: f64, core: f64) -> f64 {
        (squared * squared + length_squared * length_squared * core).sqrt()
    }
}

/// 4 pi V of the bound leg.
#[inline(always)]
fn bound(a: [f64; 3], b: [f64; 3], core: f64, smooth: impl Smoothing) -> [f64; 3] {
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let leg = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
    let along = (bb - ab) / smooth.distance(bb, core) + (aa - ab) / smooth.distance(aa, core);
    let t = along / smooth.squared(dot(cross, cross), dot(leg, leg), core);
    [cross[0] * t, cross[1] * t, cross[2] * t]
}

/// Factor of a trailing leg from the vector `a` to the point: 4 pi V = (0, a_z, -a_y) factor.
#[inline(always)]
fn trailing(a: [f64; 3], core: f64, smooth: impl Smoothing) -> f64 {
    let axis = a[1] * a[1] + a[2] * a[2];
    (1.0 + a[0] / (a[0] * a[0] + axis).sqrt()) / smooth.squared(axis, 1.0, core)
}

/// Arguments of one pass over all vortices.
struct Rows<'r> {
    point: [f64; 3],
    inverse_beta: f64,
    ends: &'r [[Vec<f64>; 3]; 2],
    core: &'r [f64],
    out: &'r mut Velocities,
}

struct Pass<'r, S>(Rows<'r>, S);

impl<S: Smoothing> pulp::WithSimd for Pass<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<A: pulp::Simd>(self, _: A) {
        let Rows {
            point: p,
            inverse_beta,
            ends: [from, to],
            core,
            out,
        } = self.0;
        let smooth = self.1;
        let n = core.len();
        let cut = |x: &'_ [f64]| x.len() == n;
        // One length for all slices lets the loop run without checks.
        let ([x1, y1, z1], [x2, y2, z2]) = (from, to);
        if ![x1, y1, z1, x2, y2, z2].iter().all(|x| cut(x)) || !cut(&out.u) || !cut(&out.v) || !cut(&out.w) {
            return;
        }
        let (x1, y1, z1) = (&x1[..n], &y1[..n], &z1[..n]);
        let (x2, y2, z2) = (&x2[..n], &y2[..n], &z2[..n]);
        let (u, v, w) = (&mut out.u[..n], &mut out.v[..n], &mut out.w[..n]);
        let scale = INVERSE_4_PI;
        for k in 0..n {
            let a = [p[0] - x1[k], p[1] - y1[k], p[2] - z1[k]];
            let b = [p[0] - x2[k], p[1] - y2[k], p[2] - z2[k]];
            let leg = bound(a, b, core[k], smooth);
            let (ta, tb) = (trailing(a, core[k], smooth), trailing(b, core[k], smooth));
            u[k] = leg[0] * scale * inverse_beta;
            v[k] = (leg[1] + a[2] * ta - b[2] * tb) * scale;
            w[k] = (leg[2] - a[1] * ta + b[1] * tb) * scale;
        }
    }
}
