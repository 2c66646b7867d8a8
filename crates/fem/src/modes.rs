//! Normal modes, K phi = lambda M phi.
//!
//! Equations: THEORY (39).

use albatross_nastran::deck::Id;
use albatross_nastran::{
    Deck, Dialect, EigenvalueTable, Eigenvector, EigenvectorRow, ModalResults, PointKind, RealMode,
};
use albatross_numerics::Mat;
use std::borrow::Cow;
use std::f64::consts::TAU;

use crate::dofs::Freedoms;
use crate::error::Error;
use crate::lanczos::{Pairs, Wanted};
use crate::model::{FemModel, listed};
use crate::pencil::{BLOCK, Pencil, Shifted};
use crate::sparse::Symmetric;
use crate::supports::selected;

/// Modes when nothing says how many.
const DEFAULT_COUNT: usize = 20;

/// Scale of eigenvectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModeScale {
    /// Generalised mass 1.
    #[default]
    Mass,
    /// Largest component 1.
    Max,
}

/// Which modes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModesOptions {
    /// Number of modes, rigid ones included.
    pub count: Option<usize>,
    /// Lower end of the range, Hz. Zero and less keep the rigid modes.
    pub lower_hz: Option<f64>,
    /// Upper end of the range, Hz.
    pub upper_hz: Option<f64>,
    /// Scale of the vectors.
    pub scale: ModeScale,
}

impl ModesOptions {
    /// The number and range of the method that case control selects, or of the first EIGRL or EIGR of the deck.
    #[must_use]
    pub fn of_deck(deck: &Deck, subcase: Option<u32>) -> Self {
        let method = selected(deck, "METHOD", subcase);
        let positive = |n: Option<i32>| n.and_then(|n| usize::try_from(n).ok()).filter(|&n| n > 0);
        let scale = |norm: &str| {
            if norm == "MAX" {
                ModeScale::Max
            } else {
                ModeScale::Mass
            }
        };
        let lanczos = |id: Id| deck.eigrl.get(&id);
        let others = |id: Id| deck.eigr.get(&id);
        let eigrl = method.map_or_else(|| deck.eigrl.values().next(), lanczos);
        if let Some(e) = eigrl {
            return Self {
                count: positive(e.desired),
                lower_hz: e.lower_hz,
                upper_hz: e.upper_hz,
                scale: scale(&e.normalization),
            };
        }
        let eigr = method.map_or_else(|| deck.eigr.values().next(), others);
        eigr.map_or_else(Self::default, |e| Self {
            count: positive(e.desired),
            lower_hz: e.lower_hz,
            upper_hz: e.upper_hz,
            scale: scale(&e.normalization),
        })
    }

    fn check(&self) -> Result<(), Error> {
        let bad = |option, value: f64, expected| {
            Err(Error::BadOption {
                option,
                value: value.to_string(),
                expected,
            })
        };
        if self.count == Some(0) {
            return bad("the number of modes", 0.0, "at least one");
        }
        let (low, high) = (self.lower_hz.unwrap_or(0.0), self.upper_hz.unwrap_or(f64::MAX));
        if !low.is_finite() {
            return bad("the lower frequency", low, "a finite number in Hz");
        }
        if high.is_nan() || high <= low.max(0.0) {
            return bad("the upper frequency", high, "more than the lower one, in Hz");
        }
        Ok(())
    }
}

/// Modes in ascending eigenvalue.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Eigenvalues, (rad/s)^2; those of rigid modes are rounding noise about zero.
    pub eigenvalues: Vec<f64>,
    /// Frequencies, Hz, from the absolute eigenvalue.
    pub frequencies_hz: Vec<f64>,
    /// Generalised masses, kg m^2 per unit of the coordinate squared.
    pub generalized_masses: Vec<f64>,
    /// Shapes on all freedoms (rows in the order of [`FemModel::freedoms`], CD systems), one column for each mode.
    pub shapes: Mat<f64>,
    /// `|K x - lambda M x|` of each mode on free freedoms, over `|D x| + |lambda| |M x|` with D the diagonal of K.
    pub residuals: Vec<f64>,
    /// What was found on the way, such as mechanisms without mass.
    pub remarks: Vec<String>,
    /// Entries of the Cholesky factor.
    pub factor_entries: usize,
    freedoms: Freedoms,
    systems: Vec<Id>,
}

impl FemModel {
    /// The lowest normal modes, or those of a range. Rigid modes of a free structure are found without SUPORT.
    ///
    /// A motion without stiffness and mass (the spin of a rod that carries point masses only) has no frequency: one of
    /// its freedoms is held, with a remark that names it.
    ///
    /// # Errors
    /// [`Error::EmptyModel`] without mass, [`Error::BadOption`], [`Error::NotConverged`], and
    /// [`Error::Factorisation`] for numbers that are not finite.
    pub fn modes(&self, options: &ModesOptions) -> Result<Modes, Error> {
        options.check()?;
        let (model, mut remarks) = self.without_massless_motions()?;
        let pencil = model.pencil();
        let analysis = pencil.analysis()?;
        let below = |lambda| pencil.count_below(&analysis, lambda);
        let pairs = in_range(&pencil.shifted(&analysis)?, &model.mass, below, options)?;
        if pairs.exhausted && options.count.is_some_and(|n| n > pairs.eigenvalues.len()) {
            remarks.push(format!(
                "the model has {} modes, fewer than asked for",
                pairs.eigenvalues.len()
            ));
        }
        Ok(model.finish(pairs, options.scale, remarks, analysis.stored()))
    }

    /// The number of modes below a frequency, counted without computing them: K - omega^2 M has as many negative pivots
    /// (Sturm's theorem). A check that a list of modes is complete; the frequency should lie between two of them.
    ///
    /// # Errors
    /// [`Error::BadOption`] for a frequency that is not positive, [`Error::Factorisation`] when it is a mode's.
    pub fn count_below(&self, frequency_hz: f64) -> Result<usize, Error> {
        if !frequency_hz.is_finite() || frequency_hz <= 0.0 {
            return Err(Error::BadOption {
                option: "the frequency below which modes are counted",
                value: frequency_hz.to_string(),
                expected: "a positive number of Hz",
            });
        }
        let (model, _) = self.without_massless_motions()?;
        let pencil = model.pencil();
        let lambda = (TAU * frequency_hz).powi(2);
        pencil.count_below(&pencil.analysis()?, lambda)
    }

    pub(crate) fn pencil(&self) -> Pencil<'_> {
        Pencil {
            stiffness: &self.stiffness,
            mass: &self.mass,
            nodes: self.nodes(),
        }
    }

    /// Refuses a free freedom of negative mass: the mass matrix is then indefinite, and its modes are not vibrations. A
    /// negative mass that a rigid connection makes up for is in order.
    fn refuse_negative_mass(&self) -> Result<(), Error> {
        // What sums of masses leave of zero.
        const ROUNDING: f64 = 1e-12;
        let diagonal = self.mass.diagonal();
        let largest = diagonal.iter().fold(0.0_f64, |a, m| a.max(m.abs()));
        let mut free = self.constraints.free.iter().zip(&diagonal);
        match free.find(|(_, mass)| **mass < -ROUNDING * largest) {
            None => Ok(()),
            Some((freedom, mass)) => Err(Error::BadMass {
                card: self.freedoms().name(*freedom),
                problem: format!(
                    "its mass, with all that is rigidly connected to it, is {mass:.6e}; correct a negative mass, \
                     inertia, RHO or NSM there"
                ),
            }),
        }
    }

    /// The model with motions held that have neither stiffness nor mass, and remarks that name them.
    fn without_massless_motions(&self) -> Result<(Cow<'_, Self>, Vec<String>), Error> {
        self.refuse_negative_mass()?;
        let mut model = Cow::Borrowed(self);
        let mut held = Vec::new();
        loop {
            let pencil = model.pencil();
            let found = pencil.massless_motions(&pencil.analysis()?, pencil.first_shift()?)?;
            let free = &model.constraints.free;
            let freedoms: Vec<usize> = found.iter().filter_map(|&k| free.get(k).copied()).collect();
            if freedoms.is_empty() {
                break;
            }
            held.extend_from_slice(&freedoms);
            model.to_mut().hold(freedoms);
        }
        let mut remarks = Vec::new();
        if !held.is_empty() {
            remarks.push(format!(
                "{} motions have neither stiffness nor mass; held at {}",
                held.len(),
                listed(&model.freedoms, &held)
            ));
        }
        Ok((model, remarks))
    }

    /// The point of each free freedom.
    pub(crate) fn nodes(&self) -> Vec<usize> {
        let points = self.freedoms.points();
        let point = |&g: &usize| points.partition_point(|p| p.first <= g);
        self.constraints.free.iter().map(point).collect()
    }

    pub(crate) fn finish(
        &self,
        pairs: Pairs,
        scale: ModeScale,
        remarks: Vec<String>,
        factor_entries: usize,
    ) -> Modes {
        let residuals = self.residuals(&pairs);
        let count = pairs.eigenvalues.len();
        let mut shapes = Mat::zeros(self.freedoms.count(), count);
        let mut generalized_masses = vec![1.0; count];
        for (k, mass) in generalized_masses.iter_mut().enumerate() {
            let free: Vec<f64> = pairs.vectors.col(k).iter().copied().collect();
            let shape = self.constraints.expand(&free);
            // A sign that does not depend on the run: the largest component is positive.
            let largest = shape
                .iter()
                .fold(0.0_f64, |m, &v| if v.abs() > m.abs() { v } else { m });
            let factor = match scale {
                ModeScale::Mass => largest.signum(),
                ModeScale::Max if largest != 0.0 => 1.0 / largest,
                ModeScale::Max => 1.0,
            };
            *mass = factor * factor;
            for (to, from) in shapes.col_mut(k).iter_mut().zip(&shape) {
                *to = factor * from;
            }
        }
        let frequencies_hz = pairs.eigenvalues.iter().map(|l| l.abs().sqrt() / TAU).collect();
        let points = self.freedoms.points();
        Modes {
            frequencies_hz,
            eigenvalues: pairs.eigenvalues,
            generalized_masses,
            shapes,
            residuals,
            remarks,
            factor_entries,
            systems: points
                .iter()
                .map(|p| self.frames.grid(p.id).map_or(0, |g| g.cd))
                .collect(),
            freedoms: self.freedoms.clone(),
        }
    }

    fn residuals(&self, pairs: &Pairs) -> Vec<f64> {
        let diagonal = self.stiffness.diagonal();
        let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
        let of = |(k, &lambda): (usize, &f64)| {
            let x: Vec<f64> = pairs.vectors.col(k).iter().copied().collect();
            let (kx, mx) = (self.stiffness.product(&x), self.mass.product(&x));
            let difference = norm(&mut kx.iter().zip(&mx).map(|(k, m)| k - lambda * m));
            let size = norm(&mut diagonal.iter().zip(&x).map(|(d, x)| d * x))
                + lambda.abs() * norm(&mut mx.iter().copied());
            if size > 0.0 { difference / size } else { difference }
        };
        pairs.eigenvalues.iter().enumerate().map(of).collect()
    }
}

/// Modes of the range and number asked for. `count_below` tells how many are below an eigenvalue.
fn in_range(
    shifted: &Shifted<'_>,
    mass: &Symmetric,
    count_below: impl Fn(f64) -> Result<usize, Error>,
    options: &ModesOptions,
) -> Result<Pairs, Error> {
    let n = mass.order();
    let eigenvalue = |hz: f64| (TAU * hz).powi(2);
    let limit = options.upper_hz.map(eigenvalue);
    let wanted = |count: usize| match limit {
        Some(limit) => Wanted::Below(limit, count),
        None => Wanted::Count(count),
    };
    let asked = options
        .count
        .unwrap_or(if limit.is_some() { n } else { DEFAULT_COUNT })
        .min(n);
    let Some(lower) = options.lower_hz.filter(|&f| f > 0.0).map(eigenvalue) else {
        return shifted.lowest(wanted(asked));
    };
    // Modes below the range have to be found too. Mostly they are few; else they are counted.
    let mut count = asked;
    let mut counted = None;
    loop {
        let pairs = shifted.lowest(wanted(count))?;
        let below = pairs.eigenvalues.partition_point(|&l| l < lower);
        let within = pairs.eigenvalues.len() - below;
        if within >= asked || pairs.eigenvalues.len() < count || count == n {
            let taken = within.min(asked);
            return Ok(Pairs {
                eigenvalues: pairs.eigenvalues[below..below + taken].to_vec(),
                vectors: pairs.vectors.subcols(below, taken).to_owned(),
                exhausted: pairs.exhausted,
            });
        }
        let counted = *counted.get_or_insert_with(|| count_below(lower).ok());
        let massive = || mass.diagonal().iter().filter(|&&m| m > 0.0).count();
        if counted.is_some_and(|below| below >= massive()) {
            return Ok(Pairs {
                eigenvalues: Vec::new(),
                vectors: Mat::zeros(n, 0),
                exhausted: true,
            });
        }
        count = next_count(count, asked, within, counted).min(n);
    }
}

/// How many modes to find when `within` of those asked for are among `count`, and the number below the range is counted
/// or, where that fails, unknown.
fn next_count(count: usize, asked: usize, within: usize, below: Option<usize>) -> usize {
    let more = count + (asked - within) + BLOCK;
    more.max(below.map_or(2 * count, |below| below + asked))
}

impl Modes {
    /// Number of modes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.eigenvalues.is_empty()
    }

    /// Number of modes that every field holds: the fields are open, and may have been cut or exchanged.
    pub(crate) fn complete(&self) -> usize {
        if self.shapes.nrows() != self.freedoms.count() {
            return 0;
        }
        let lists = [&self.eigenvalues, &self.frequencies_hz, &self.generalized_masses];
        let lengths = lists.map(Vec::len).into_iter();
        lengths.fold(self.shapes.ncols(), usize::min)
    }

    /// T1 to R3 of a grid in mode `mode` (from 0), in its CD system; of a scalar point the first value.
    #[must_use]
    pub fn at(&self, mode: usize, id: Id) -> Option<[f64; 6]> {
        if mode >= self.complete() {
            return None;
        }
        let point = self.freedoms.point(id)?;
        let width = if point.is_scalar { 1 } else { 6 };
        let column = self.shapes.col(mode);
        Some(std::array::from_fn(|i| {
            if i < width { column[point.first + i] } else { 0.0 }
        }))
    }

    /// The modes as a results file would hold them: eigenvalue table, eigenvectors in CD systems, and the grid point
    /// weight of the model. Later stages take either. Modes are numbered from 1.
    #[must_use]
    pub fn results(&self, model: &FemModel, source: &str) -> ModalResults {
        let modes = self.complete();
        let row = |k: usize| {
            let (lambda, mass) = (self.eigenvalues[k], self.generalized_masses[k]);
            RealMode {
                mode: k as u32 + 1,
                extraction_order: k as u32 + 1,
                eigenvalue: lambda,
                omega_rad_s: lambda.abs().sqrt(),
                frequency_hz: self.frequencies_hz[k],
                generalized_mass: mass,
                generalized_stiffness: lambda * mass,
            }
        };
        ModalResults {
            source: source.to_owned(),
            dialect: Dialect::Unknown,
            eigenvalues: vec![EigenvalueTable {
                subcase: None,
                modes: (0..modes).map(row).collect(),
                line: 0,
            }],
            eigenvectors: (0..modes).map(|k| self.vector(k)).collect(),
            weights: vec![model.weight()],
            diagnostics: Vec::new(),
        }
    }

    fn vector(&self, k: usize) -> Eigenvector {
        let column = self.shapes.col(k);
        let points = self.freedoms.points().iter().zip(&self.systems);
        let rows = points.map(|(point, &cd)| {
            let mut values = [f64::NAN; 6];
            let width = if point.is_scalar { 1 } else { 6 };
            for (i, value) in values.iter_mut().enumerate().take(width) {
                *value = column[point.first + i];
            }
            EigenvectorRow {
                id: point.id,
                kind: if point.is_scalar {
                    PointKind::Scalar
                } else {
                    PointKind::Grid
                },
                cd: (!point.is_scalar).then_some(cd),
                values,
            }
        });
        Eigenvector {
            subcase: None,
            block: 0,
            mode: k as u32 + 1,
            eigenvalue: Some(self.eigenvalues[k]),
            frequency_hz: Some(self.frequencies_hz[k]),
            rows: rows.collect(),
            line: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::next_count;

    /// With the number below the range one more round does; without it the count doubles. Few below: as many as missed.
    #[test]
    fn regress_rounds_of_a_range_are_few() {
        for (count, within, below, expected) in [
            (20, 0, Some(5000), 5020),
            (20, 0, None, 48),
            (480, 0, None, 960),
            (20, 15, Some(5), 33),
        ] {
            assert_eq!(next_count(count, 20, within, below), expected);
        }
    }
}
