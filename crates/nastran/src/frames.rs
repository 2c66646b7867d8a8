//! Coordinate systems resolved to the basic system.
//!
//! A system is an origin and three axes: z from A to B, x in the half plane of C, y = z x x. Chains (a system
//! defined in another, a CORD1x defined by grids that lie in other systems) are followed to the basic system.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Vector3};

use crate::deck::{CoordinateDefinition, CoordinateKind, CoordinateSystem, Deck, Grid, Id};
use crate::error::Error;

/// A resolved coordinate system.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Rectangular, cylindrical or spherical.
    pub kind: CoordinateKind,
    /// Origin in the basic system, m.
    pub origin: Vector3<f64>,
    /// Columns are the unit vectors of the local rectangular axes in the basic system.
    pub axes: Matrix3<f64>,
}

impl Frame {
    /// The basic system.
    #[must_use]
    pub fn basic() -> Self {
        Self {
            kind: CoordinateKind::Rectangular,
            origin: Vector3::zeros(),
            axes: Matrix3::identity(),
        }
    }

    /// Basic position of a point with these coordinates (angles in degrees, as on the cards).
    #[must_use]
    pub fn to_basic(&self, coordinates: [f64; 3]) -> Vector3<f64> {
        let [a, b, c] = coordinates;
        let local = match self.kind {
            CoordinateKind::Rectangular => Vector3::new(a, b, c),
            CoordinateKind::Cylindrical => {
                let (sin, cos) = b.to_radians().sin_cos();
                Vector3::new(a * cos, a * sin, c)
            }
            CoordinateKind::Spherical => {
                let (sin_theta, cos_theta) = b.to_radians().sin_cos();
                let (sin_phi, cos_phi) = c.to_radians().sin_cos();
                Vector3::new(a * sin_theta * cos_phi, a * sin_theta * sin_phi, a * cos_theta)
            }
        };
        self.origin + self.axes * local
    }

    /// Directions of the displacement components at a basic position: columns are the unit vectors of components
    /// 1, 2, 3 in the basic system. In a cylindrical or spherical system they depend on the position; on the z
    /// axis, where the angle is undefined, it is taken as zero.
    #[must_use]
    pub fn displacement_axes(&self, position: Vector3<f64>) -> Matrix3<f64> {
        let local = self.axes.transpose() * (position - self.origin);
        let radius = local.x.hypot(local.y);
        let (sin_phi, cos_phi) = if radius > 1e-12 * local.norm() {
            (local.y / radius, local.x / radius)
        } else {
            (0.0, 1.0)
        };
        match self.kind {
            CoordinateKind::Rectangular => self.axes,
            CoordinateKind::Cylindrical => {
                self.axes * Matrix3::new(cos_phi, -sin_phi, 0.0, sin_phi, cos_phi, 0.0, 0.0, 0.0, 1.0)
            }
            CoordinateKind::Spherical => {
                let rho = local.norm();
                let (sin_theta, cos_theta) = if rho > 0.0 {
                    (radius / rho, local.z / rho)
                } else {
                    (0.0, 1.0)
                };
                // Columns e_rho, e_theta, e_phi.
                self.axes
                    * Matrix3::new(
                        sin_theta * cos_phi,
                        cos_theta * cos_phi,
                        -sin_phi,
                        sin_theta * sin_phi,
                        cos_theta * sin_phi,
                        cos_phi,
                        cos_theta,
                        -sin_theta,
                        0.0,
                    )
            }
        }
    }
}

/// A grid in the basic system.
#[derive(Debug, Clone, PartialEq)]
pub struct ResolvedGrid {
    /// Basic position, m.
    pub position: Vector3<f64>,
    /// Displacement system.
    pub cd: Id,
    /// Columns are the directions of displacement components 1, 2, 3 in the basic system: a printed vector u_cd
    /// is `axes * u_cd` in the basic system.
    pub axes: Matrix3<f64>,
}

/// All systems and grids of a deck in the basic system.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    systems: BTreeMap<Id, Frame>,
    grids: BTreeMap<Id, ResolvedGrid>,
}

impl Frames {
    /// Resolves every coordinate system and every grid.
    ///
    /// # Errors
    /// [`Error::Frame`] for a system that is missing, defined by itself through a chain, or degenerate (A, B, C on
    /// a line), and for a CORD1x whose grid is missing.
    pub fn resolve(deck: &Deck) -> Result<Self, Error> {
        let mut resolver = Resolver {
            deck,
            done: BTreeMap::from([(0, Frame::basic())]),
        };
        for &id in deck.coordinate_systems.keys() {
            resolver.system(id)?;
        }
        let mut grids = BTreeMap::new();
        for grid in deck.grids.values() {
            grids.insert(grid.id, resolver.grid(grid)?);
        }
        Ok(Self {
            systems: resolver.done,
            grids,
        })
    }

    /// A system by number; 0 is the basic system.
    #[must_use]
    pub fn system(&self, id: Id) -> Option<&Frame> {
        self.systems.get(&id)
    }

    /// A grid by number.
    #[must_use]
    pub fn grid(&self, id: Id) -> Option<&ResolvedGrid> {
        self.grids.get(&id)
    }

    /// All grids by number.
    #[must_use]
    pub fn grids(&self) -> &BTreeMap<Id, ResolvedGrid> {
        &self.grids
    }
}

struct Resolver<'a> {
    deck: &'a Deck,
    done: BTreeMap<Id, Frame>,
}

impl Resolver<'_> {
    /// Resolves system `id` and all that it needs. The chain is followed with a list of systems under way rather
    /// than by recursion, so that its length is not limited by the stack; meeting one again is a cycle.
    fn system(&mut self, id: Id) -> Result<(), Error> {
        let mut chain = vec![id];
        let mut under_way = BTreeSet::from([id]);
        while let Some(&id) = chain.last() {
            if self.done.contains_key(&id) {
                chain.pop();
                continue;
            }
            let Some(system) = self.deck.coordinate_systems.get(&id) else {
                return Err(self.error(
                    "",
                    id,
                    format!("coordinate system {id} is not in the deck; add its card"),
                ));
            };
            match self.first_unresolved(system)? {
                None => {
                    self.place(system)?;
                    chain.pop();
                }
                Some(needed) if under_way.insert(needed) => chain.push(needed),
                Some(needed) => {
                    let circle = chain.iter().skip_while(|&&s| s != needed).chain([&needed]);
                    let circle: Vec<_> = circle.take(20).map(ToString::to_string).collect();
                    return Err(self.error(
                        card_name(system),
                        id,
                        format!(
                            "coordinate systems define each other in a circle: {}; one of them must be given in \
                             the basic system",
                            circle.join(" -> ")
                        ),
                    ));
                }
            }
        }
        Ok(())
    }

    /// The first system that the definition needs and that is not resolved yet.
    fn first_unresolved(&self, system: &CoordinateSystem) -> Result<Option<Id>, Error> {
        let card = card_name(system);
        match &system.definition {
            CoordinateDefinition::Points { reference, .. } => {
                self.check_system(card, system.id, "RID", *reference)?;
                Ok(Some(*reference).filter(|r| !self.done.contains_key(r)))
            }
            CoordinateDefinition::Grids { grids } => {
                for &id in grids {
                    let cp = self.defining_grid(system, id)?.cp;
                    self.check_system("GRID", id, "CP", cp)?;
                    if !self.done.contains_key(&cp) {
                        return Ok(Some(cp));
                    }
                }
                Ok(None)
            }
        }
    }

    /// Places a system whose references are resolved.
    fn place(&mut self, system: &CoordinateSystem) -> Result<(), Error> {
        let [a, b, c] = match &system.definition {
            CoordinateDefinition::Points { reference, a, b, c } => {
                let frame = self.resolved(*reference)?;
                [frame.to_basic(*a), frame.to_basic(*b), frame.to_basic(*c)]
            }
            CoordinateDefinition::Grids { grids: [g1, g2, g3] } => {
                let point = |id| -> Result<Vector3<f64>, Error> {
                    let grid = self.defining_grid(system, id)?;
                    Ok(self.resolved(grid.cp)?.to_basic(grid.position))
                };
                [point(*g1)?, point(*g2)?, point(*g3)?]
            }
        };
        let axes = axes_from_points(a, b, c).ok_or_else(|| {
            self.error(
                card_name(system),
                system.id,
                "its three points do not span a plane: z runs from A to B, and C must lie off that line"
                    .into(),
            )
        })?;
        self.done.insert(
            system.id,
            Frame {
                kind: system.kind,
                origin: a,
                axes,
            },
        );
        Ok(())
    }

    fn defining_grid(&self, system: &CoordinateSystem, id: Id) -> Result<&Grid, Error> {
        self.deck.grids.get(&id).ok_or_else(|| {
            self.error(
                card_name(system),
                system.id,
                format!("is defined by grid {id}, which is not in the deck; add the GRID card"),
            )
        })
    }

    fn resolved(&self, id: Id) -> Result<&Frame, Error> {
        self.done
            .get(&id)
            .ok_or_else(|| self.error("", id, "is not resolved".into()))
    }

    fn grid(&self, grid: &Grid) -> Result<ResolvedGrid, Error> {
        let cd = if grid.fluid { 0 } else { grid.cd };
        self.check_system("GRID", grid.id, "CP", grid.cp)?;
        self.check_system("GRID", grid.id, "CD", cd)?;
        let position = self.resolved(grid.cp)?.to_basic(grid.position);
        Ok(ResolvedGrid {
            position,
            cd,
            axes: self.resolved(cd)?.displacement_axes(position),
        })
    }

    /// That the system `id`, which a field of another card names, exists.
    fn check_system(&self, card: &str, number: Id, field: &str, id: Id) -> Result<(), Error> {
        if id == 0 || self.deck.coordinate_systems.contains_key(&id) {
            return Ok(());
        }
        Err(self.error(
            card,
            number,
            format!(
                "{field} = {id}, but there is no coordinate system {id}; add its card or correct {field}"
            ),
        ))
    }

    fn error(&self, card: &str, id: Id, problem: String) -> Error {
        let name = if card.is_empty() {
            format!("coordinate system {id}")
        } else {
            format!("{card} {id}")
        };
        let location = match self.deck.origins.of(card, id) {
            Some(origin) => format!("{origin}: {name}"),
            None => name,
        };
        Error::Frame { location, problem }
    }
}

fn card_name(system: &CoordinateSystem) -> &'static str {
    use CoordinateDefinition as D;
    use CoordinateKind as K;
    match (&system.definition, system.kind) {
        (D::Grids { .. }, K::Rectangular) => "CORD1R",
        (D::Grids { .. }, K::Cylindrical) => "CORD1C",
        (D::Grids { .. }, K::Spherical) => "CORD1S",
        (D::Points { .. }, K::Rectangular) => "CORD2R",
        (D::Points { .. }, K::Cylindrical) => "CORD2C",
        (D::Points { .. }, K::Spherical) => "CORD2S",
    }
}

/// Columns x, y, z from origin a, point b on z and point c in the x-z half plane; `None` if they are collinear.
fn axes_from_points(a: Vector3<f64>, b: Vector3<f64>, c: Vector3<f64>) -> Option<Matrix3<f64>> {
    let z = (b - a).try_normalize(0.0)?;
    let towards_c = c - a;
    let y = z.cross(&towards_c);
    // Nearly collinear points leave y to rounding.
    if y.norm() <= 1e-10 * towards_c.norm() {
        return None;
    }
    let y = y.try_normalize(0.0)?;
    let axes = Matrix3::from_columns(&[y.cross(&z), y, z]);
    axes.iter().all(|v| v.is_finite()).then_some(axes)
}
