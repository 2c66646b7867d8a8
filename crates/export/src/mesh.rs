//! The shape of an aircraft in points and cells, with its modes: what a viewer draws.

use crate::Result;
use crate::error::fit;
use albatross_modal::ModalBasis;
use albatross_nastran::deck::{Deck, Id};
use albatross_strip::slopes::StripRecord;
use albatross_strip::{Strip, StripShapes};

/// What a cell stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// A concentrated mass: CONM1, CONM2.
    Mass = 0,
    /// A bar or beam: CBAR, CBEAM.
    Beam = 1,
    /// A rod: CROD, CONROD.
    Rod = 2,
    /// A spring between two grids: CELAS1, CELAS2, CBUSH.
    Spring = 3,
    /// From the independent grid to each dependent one, and from the reference grid to each averaged one: RBE2, RBE3,
    /// RBAR.
    Rigid = 4,
    /// An aerodynamic strip.
    Strip = 5,
}

/// A cell: one, two or four points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// What it stands for.
    pub kind: CellKind,
    /// Number of the element in the deck, or of the strip from 1.
    pub number: u32,
    /// Indices of its points.
    pub points: Vec<usize>,
}

/// A mode shape on the points.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshMode {
    /// Rank in the basis, from 1.
    pub rank: usize,
    /// Frequency in vacuo \[Hz\].
    pub frequency_hz: f64,
    /// Displacement of each point for a unit generalised coordinate \[m\].
    pub displacement: Vec<[f64; 3]>,
}

/// Points, cells and modes, all in structural axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Positions \[m\].
    pub points: Vec<[f64; 3]>,
    /// Number of the grid at each point, 0 for corners of strips.
    pub grids: Vec<Id>,
    /// Cells.
    pub cells: Vec<Cell>,
    /// Modes.
    pub modes: Vec<MeshMode>,
    /// What could not be drawn.
    pub notes: Vec<String>,
}

impl Mesh {
    /// The grids of a basis, joined as the elements of the deck join them. Offsets of beams are not drawn.
    #[must_use]
    pub fn of_structure(basis: &ModalBasis, deck: &Deck) -> Self {
        let modes = basis.modes.iter().enumerate();
        let mut mesh = Self {
            points: basis.grids.iter().map(|g| g.position).collect(),
            grids: basis.grids.iter().map(|g| g.id).collect(),
            modes: modes
                .map(|(k, mode)| MeshMode {
                    rank: k + 1,
                    frequency_hz: mode.frequency_hz,
                    displacement: mode.shape.iter().map(|[x, y, z, ..]| [*x, *y, *z]).collect(),
                })
                .collect(),
            ..Self::default()
        };
        let mut absent = 0;
        for (kind, number, grids) in connections(deck) {
            let points: Vec<usize> = grids.iter().filter_map(|id| basis.grid_index(*id)).collect();
            if points.len() == grids.len() {
                mesh.cells.push(Cell { kind, number, points });
            } else {
                absent += 1;
            }
        }
        if absent > 0 {
            mesh.notes.push(format!(
                "{absent} elements are not drawn: the results hold no displacement of one of their grids"
            ));
        }
        mesh
    }

    /// Adds the strips: each a parallelogram along the sweep of its quarter chord, moving along its own normal as the
    /// aerodynamics has it, `phi - (x - x_lra) gamma`. Where neighbours of a surface meet, both take the mean.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) unless there are as many records and shapes as strips, as many shapes
    /// as modes, and as many displacements of each mode as points.
    pub fn add_strips(
        &mut self,
        records: &[StripRecord],
        strips: &[Strip],
        shapes: &StripShapes,
    ) -> Result<()> {
        fit("records of strips", records.len(), strips.len())?;
        fit("strips with shapes", shapes.n_strips(), strips.len())?;
        fit("shapes on the strips", shapes.n_shapes(), self.modes.len())?;
        fit("strips with rotations", shapes.gamma.nrows(), strips.len())?;
        fit("rotations on the strips", shapes.gamma.ncols(), self.modes.len())?;
        for mode in &self.modes {
            let what = format!("displacements of mode {}", mode.rank);
            fit(&what, mode.displacement.len(), self.points.len())?;
        }
        for (j, (record, strip)) in records.iter().zip(strips).enumerate() {
            let first = self.points.len();
            let (sin, cos) = strip.dihedral_rad.sin_cos();
            for [x, y, z] in corners(record, strip) {
                self.points.push([x, y, z]);
                self.grids.push(0);
                for (k, mode) in self.modes.iter_mut().enumerate() {
                    let along = shapes.phi[(j, k)] - (x - strip.x_lra) * shapes.gamma[(j, k)];
                    mode.displacement.push([0.0, -along * sin, along * cos]);
                }
            }
            self.cells.push(Cell {
                kind: CellKind::Strip,
                number: u32::try_from(j + 1).unwrap_or(u32::MAX),
                points: (first..first + 4).collect(),
            });
        }
        let first = self.points.len() - 4 * strips.len();
        for (j, (pair, two)) in records.windows(2).zip(strips.windows(2)).enumerate() {
            if let ([a, b], [s, t]) = (pair, two)
                && a.surface == b.surface
            {
                self.join(first + 4 * j, 0.5 * s.width.min(t.width));
            }
        }
        Ok(())
    }

    /// Joins the strip whose corners begin at `first` with the next one where their ends meet within `near`: position
    /// and displacement of both become the mean.
    fn join(&mut self, first: usize, near: f64) {
        // Leading and trailing edge of both ends of a strip.
        let ends = |first: usize| [[first, first + 1], [first + 3, first + 2]];
        let apart = |p: usize, q: usize| {
            let ([_, y, z], [_, v, w]) = (self.points[p], self.points[q]);
            (y - v).hypot(z - w)
        };
        let pairs = ends(first)
            .into_iter()
            .flat_map(|a| ends(first + 4).map(|b| (a, b)));
        let nearest = pairs.min_by(|(a, b), (c, d)| apart(a[0], b[0]).total_cmp(&apart(c[0], d[0])));
        let Some((a, b)) = nearest.filter(|(a, b)| apart(a[0], b[0]) <= near) else {
            return;
        };
        let fields = self.modes.iter_mut().map(|mode| &mut mode.displacement);
        for field in std::iter::once(&mut self.points).chain(fields) {
            for (p, q) in a.into_iter().zip(b) {
                let mean = std::array::from_fn(|i| 0.5 * (field[p][i] + field[q][i]));
                (field[p], field[q]) = (mean, mean);
            }
        }
    }
}

/// Every element of a deck that joins grids or stands at one: kind, number, grids.
fn connections(deck: &Deck) -> Vec<(CellKind, Id, Vec<Id>)> {
    let mut all = Vec::new();
    let mut add = |kind: CellKind, number: Id, grids: &[Id]| all.push((kind, number, grids.to_vec()));
    deck.bars
        .values()
        .for_each(|e| add(CellKind::Beam, e.id, &e.grids));
    deck.beams
        .values()
        .for_each(|e| add(CellKind::Beam, e.id, &e.grids));
    deck.rods
        .values()
        .for_each(|e| add(CellKind::Rod, e.id, &e.grids));
    deck.conrods
        .values()
        .for_each(|e| add(CellKind::Rod, e.id, &e.grids));
    deck.conm1
        .values()
        .for_each(|e| add(CellKind::Mass, e.id, &[e.grid]));
    deck.conm2
        .values()
        .for_each(|e| add(CellKind::Mass, e.id, &[e.grid]));
    for spring in deck.springs.values() {
        let [a, b] = spring.ends.map(|end| end.point);
        // A spring to the ground or between components of one grid joins nothing.
        if a != b && a != 0 && b != 0 && !deck.scalar_points.contains(&a) && !deck.scalar_points.contains(&b)
        {
            add(CellKind::Spring, spring.id, &[a, b]);
        }
    }
    let grounded = |grids: &[Id; 2]| grids.contains(&0);
    let bushes = deck.bushes.values().filter(|e| !grounded(&e.grids));
    bushes.for_each(|e| add(CellKind::Spring, e.id, &e.grids));
    deck.rbars
        .values()
        .for_each(|e| add(CellKind::Rigid, e.id, &e.grids));
    for rigid in deck.rbe2.values() {
        let ends = rigid.dependents.iter();
        ends.for_each(|end| add(CellKind::Rigid, rigid.id, &[rigid.independent, *end]));
    }
    for mean in deck.rbe3.values() {
        let ends = mean.groups.iter().flat_map(|group| &group.grids);
        ends.for_each(|end| add(CellKind::Rigid, mean.id, &[mean.reference, *end]));
    }
    all
}

/// Leading and trailing edge at one end, then trailing and leading edge at the other.
fn corners(record: &StripRecord, strip: &Strip) -> [[f64; 3]; 4] {
    let (sin, cos) = strip.dihedral_rad.sin_cos();
    // Sweep counts outboard: away from the plane of symmetry, or up for a fin on it.
    let outboard = if cos.abs() > 1e-9 {
        strip.y.signum() * cos.signum()
    } else {
        sin.signum()
    };
    let (leading, half) = (strip.x_ac - 0.25 * strip.chord, 0.5 * strip.width);
    let at = |along: f64, aft: f64| {
        [
            leading + aft * strip.chord + along * outboard * record.sweep_rad.tan(),
            strip.y + along * cos,
            strip.z + along * sin,
        ]
    };
    [at(-half, 0.0), at(-half, 1.0), at(half, 1.0), at(half, 0.0)]
}
